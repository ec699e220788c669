"""Canvas: a file for the gradebook's import, and a zip for 'Upload submissions' that attaches feedback as comments.

The importer wants a student's name, Canvas's number and the section before the assignments, and points possible in a
row of their own. A column whose heading is ``Title (123)`` goes to assignment 123, any other makes a new one. Files
that come back are told by the two numbers in their names, of the user and of what was handed in; Canvas shows them
under the name of the latter.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence

from dhlib.errors import DHError
from dhlib.grading.reports.cells import number, table
from dhlib.grading.reports.formats import Files, Wishes, known, one_exercise
from dhlib.grading.reports.platforms import canvas_seat
from dhlib.grading.reports.records import Record
from dhlib.grading.reports.zips import packed

HEADER = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section"]
#: The row that says how much an assignment is worth; Canvas looks for these words.
POSSIBLE = "    Points Possible"
FEEDBACK = "feedback.html"


def write(records: Sequence[Record], wishes: Wishes) -> Files:
    """The gradebook, and the comments where there are any."""
    records = known(records)
    exercise = one_exercise(records, "a column of the gradebook")
    seats = {record.submission.id: canvas_seat(record.submission) for record in records}
    if not any(seats.values()):
        raise DHError(
            "none of these came from Canvas: its files are called name_123_456_file.ipynb, and the first number is "
            "what Canvas knows a student by. Grade the zip as Canvas gave it."
        )
    worth = max((record.out_of for record in records), default=0.0)
    title = wishes.title or exercise
    if wishes.worksheet:
        sections, title = _gradebook(wishes, title)
    else:
        sections = {}
    rows = [[POSSIBLE, "", "", "", "", number(worth)]]
    pages = {}
    for record in records:
        seat = seats[record.submission.id]
        if seat is None:
            continue
        about = sections.get(seat.number, [record.name, seat.number, "", "", ""])
        rows.append([*about, number(record.points) if record.marked else ""])
        page = (wishes.pages or {}).get(record.submission.id)
        if page is not None:
            pages[f"{seat.place}{FEEDBACK}"] = page
    return {"canvas-grades.csv": table([*HEADER, title], rows), "canvas-comments.zip": packed(pages)}


def _gradebook(wishes: Wishes, title: str) -> tuple[dict[str, list[str]], str]:
    """Name, numbers and section of each student as the exported gradebook has them, and the assignment's heading."""
    assert wishes.worksheet is not None
    try:
        with wishes.worksheet.open(encoding="utf-8-sig", newline="") as file:
            rows = list(csv.reader(file))
    except (OSError, UnicodeDecodeError):
        raise DHError(
            f"{wishes.worksheet} cannot be read; --worksheet names the gradebook as Canvas exports it."
        ) from None
    if not rows or not {"Student", "ID", "Section"} <= set(rows[0]):
        raise DHError(f"{wishes.worksheet} has no columns Student, ID and Section: is it the exported gradebook?")
    where = {name: rows[0].index(name) for name in HEADER if name in rows[0]}
    headings = [name for name in rows[0] if name == title or name.rsplit(" (", 1)[0] == title]
    students = {
        row[where["ID"]]: [row[where[name]] if name in where else "" for name in HEADER]
        for row in rows[1:]
        if len(row) == len(rows[0]) and row[where["ID"]].strip().isdigit()
    }
    if not headings:
        raise DHError(f"{wishes.worksheet} has no assignment {title!r}; name it with --title as Canvas writes it.")
    return students, headings[0]
