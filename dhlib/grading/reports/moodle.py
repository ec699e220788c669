"""Moodle: the grading worksheet of an assignment, and the zip of feedback files.

The importer finds its columns by their headings, a student by ``Participant 123`` under ``Identifier``, and takes the
comment for HTML. A grade counts only if it lies within the assignment's range. The number is the one that Moodle put
into the folder names of the download, and into these folders it wants the feedback files back.
"""

from __future__ import annotations

import csv
import html
import io
import re
from collections.abc import Sequence
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.reports import comments
from dhlib.grading.reports.cells import number, safe, table
from dhlib.grading.reports.formats import Files, Wishes, known, one_exercise
from dhlib.grading.reports.platforms import moodle_seat
from dhlib.grading.reports.records import Record
from dhlib.grading.reports.zips import packed

HEADER = ["Identifier", "Full name", "Status", "Grade", "Maximum Grade", "Last modified (grade)", "Feedback comments"]
#: Headings of a worksheet in the languages that can be filled in.
IDENTIFIER = ("Identifier", "ID")
GRADE = ("Grade", "Bewertung")
MAXIMUM = ("Maximum Grade", "Maximum grade", "Bestwertung")
COMMENTS = ("Feedback comments", "Feedback als Kommentar")  # codespell:ignore als

FEEDBACK = "feedback.html"


def write(records: Sequence[Record], wishes: Wishes) -> Files:
    """The worksheet, and the feedback files where there are any."""
    records = [record for record in known(records) if moodle_seat(record.submission)]
    one_exercise(records, "a grading worksheet")
    if not records:
        raise DHError(
            "none of these came from Moodle: its folders are called Name_12345_assignsubmission_file_, and the number "
            "in them is what Moodle knows a student by. Grade the zip as Moodle gave it."
        )
    filled = _filled(wishes.worksheet, records) if wishes.worksheet else table(HEADER, map(_row, records))
    return {"moodle-grades.csv": filled, "moodle-feedback.zip": packed(feedback(records, wishes))}


def feedback(records: Sequence[Record], wishes: Wishes) -> dict[str, bytes]:
    """Each student's page, in the folder that Moodle made."""
    files = {}
    for record in records:
        seat = moodle_seat(record.submission)
        page = (wishes.pages or {}).get(record.submission.id)
        if seat and page is not None:
            files[f"{seat.place}/{FEEDBACK}"] = page
    return files


def comment(record: Record) -> str:
    """The feedback as Moodle's editor holds it: HTML in which nothing of the student's is markup."""
    return "<br>".join(html.escape(line) for line in comments.lines(record))


def _row(record: Record) -> list[str]:
    seat = moodle_seat(record.submission)
    assert seat is not None
    # "-" is what Moodle itself writes where nothing was graded yet
    status = "Submitted for grading"
    marks = (number(record.points), number(record.out_of)) if record.marked else ("", "")
    return [f"Participant {seat.number}", record.name, status, *marks, "-", comment(record)]


def _filled(worksheet: Path, records: Sequence[Record]) -> bytes:
    """A worksheet as it was downloaded, with grades and comments: everything else in it stays."""
    try:
        text = worksheet.read_text("utf-8-sig")
    except (OSError, UnicodeDecodeError):
        raise DHError(
            f"{worksheet} cannot be read; --worksheet names the grading worksheet as Moodle gave it."
        ) from None
    rows = list(csv.reader(io.StringIO(text, newline="")))
    columns = [_column(rows, names) for names in (IDENTIFIER, GRADE)]
    if not rows or None in columns:
        raise DHError(
            f"{worksheet} has no columns {IDENTIFIER[0]} and {GRADE[0]}: is it the grading worksheet? Download it with "
            "Moodle in English."
        )
    identifier, grade = (column for column in columns if column is not None)
    maximum, said = _column(rows, MAXIMUM), _column(rows, COMMENTS)
    by_number = {seat.number: record for record in records if (seat := moodle_seat(record.submission))}
    for row in rows[1:]:
        found = re.search(r"(\d+)$", row[identifier]) if len(row) > identifier else None
        record = by_number.get(found[1]) if found else None
        if record is None or len(row) < len(rows[0]):
            continue
        scale = 1.0
        if maximum is not None and (most := _decimal(row[maximum])) and record.out_of:
            scale = most / record.out_of  # the assignment may be worth more or less than the notebook
        row[grade] = number(record.points * scale) if record.marked else row[grade]
        if said is not None:
            row[said] = comment(record)
    file = io.StringIO(newline="")
    csv.writer(file).writerows([safe(cell) if k else cell for k, cell in enumerate(row)] for row in rows)
    return file.getvalue().encode()


def _column(rows: Sequence[Sequence[str]], names: Sequence[str]) -> int | None:
    return next((k for k, heading in enumerate(rows[0]) if heading.strip() in names), None) if rows else None


def _decimal(text: str) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError:
        return 0.0
