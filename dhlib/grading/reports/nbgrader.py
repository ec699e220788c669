"""The table that ``nbgrader export`` writes, for whatever a course has built upon it."""

from __future__ import annotations

from collections.abc import Sequence

from dhlib.grading.reports.cells import table
from dhlib.grading.reports.formats import Files, Wishes, known
from dhlib.grading.reports.records import Record

HEADER = [
    "assignment",
    "duedate",
    "timestamp",
    "student_id",
    "last_name",
    "first_name",
    "email",
    "raw_score",
    "late_submission_penalty",
    "score",
    "max_score",
]


def write(records: Sequence[Record], wishes: Wishes) -> Files:
    """One row for each student and exercise."""
    return {"nbgrader-grades.csv": table(HEADER, map(_row, known(records)))}


def _row(record: Record) -> list[str]:
    due = record.timing.due
    first, last = split_name(record.name)
    return [
        record.exercise,
        due.strftime("%Y-%m-%d %H:%M:%S") if due else "",
        record.submission.submitted.replace("T", " ")[:19],
        record.student,
        last,
        first,
        record.student if "@" in record.student else "",
        str(record.earned),
        str(record.deducted),
        str(record.points),
        str(record.out_of),
    ]


def split_name(name: str) -> tuple[str, str]:
    """First and last name, as far as one can tell: ``Last, First``, else the last word is the last name.

    Examples
    --------
    >>> split_name("Ada King Lovelace"), split_name("Lovelace, Ada"), split_name("Plato")
    (('Ada King', 'Lovelace'), ('Ada', 'Lovelace'), ('', 'Plato'))
    """
    if "," in name:
        last, _, first = name.partition(",")
        return first.strip(), last.strip()
    first, _, last = name.rpartition(" ")
    return first, last
