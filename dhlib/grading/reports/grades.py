"""The table of marks, for a spreadsheet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from dhlib.grading.reports.cells import number, table
from dhlib.grading.reports.records import Record, exercises_of

#: What stands before the parts, and what after.
BEFORE = ("student", "name", "notebook", "exercise", "status", "points", "out_of", "deducted")
AFTER = ("message", "feedback")


def grades(records: Sequence[Record], pages: Mapping[int, str]) -> bytes:
    """One row for each student and exercise, one column for each part.

    Parameters
    ----------
    records : sequence of Record
    pages : mapping of int to str
        Number of a submission to the name of its feedback page.
    """
    several = len([name for name in exercises_of(records) if name]) > 1

    def column(record: Record, part: str) -> str:
        return f"{record.exercise}: {part}" if several else part

    parts = list(dict.fromkeys(column(record, a.row.part) for record in records for a in record.answers))

    def row(record: Record) -> list[str]:
        submission = record.submission
        points = {column(record, answer.row.part): number(answer.points) for answer in record.answers}
        return [
            record.student,
            submission.name,
            submission.source,
            record.exercise,
            submission.status,
            number(record.points) if record.marked else "",
            number(record.out_of) if record.marked else "",
            number(record.deducted) if record.deducted else "",
            *(points.get(part, "") for part in parts),
            " ".join(text for text in (submission.message, record.about_time) if text),
            pages.get(submission.id, ""),
        ]

    return table([*BEFORE, *parts, *AFTER], map(row, records), mark=True)
