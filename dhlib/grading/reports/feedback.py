"""The page that a student gets back."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from markupsafe import Markup

from dhlib.errors import DHError
from dhlib.grading.exercise import Exercise, Part
from dhlib.grading.marks import FOLLOWS, HEADLINES, NEARLY, OPEN, RIGHT, UNREADABLE, WRONG
from dhlib.grading.reports.book_links import link
from dhlib.grading.reports.comments import signed
from dhlib.grading.reports.pages import drawn, render
from dhlib.grading.reports.picture import picture
from dhlib.grading.reports.records import Answer, Record
from dhlib.grading.reports.settings import Settings
from dhlib.grading.reports.shape import Shown, show
from dhlib.grading.sections import named

#: Verdicts in black and white, for those who do not see the colours.
SIGNS = {RIGHT: "✓", FOLLOWS: "✓", NEARLY: "≈", WRONG: "✗", OPEN: "○", UNREADABLE: "?"}

#: Answers kept at a time: those who think alike answer alike.
ALIKE = 256
#: Exercises that are kept at a time: with numbers of their own, each student has another.
KEPT = 64

Find = Callable[[Record], Exercise | None]
"""The exercise that a record is of, as it was given to this student; None if it cannot be found."""


@dataclass(frozen=True)
class Row:
    """What the template needs of a mark."""

    id: str
    title: str
    points: float
    out_of: float
    message: str
    verdict_class: str


@dataclass(frozen=True)
class Told:
    """A part as the page tells it."""

    row: Row
    answer: Answer
    headline: str
    sign: str
    heading: str
    chapter: str
    link: str
    shown: Shown | None
    drawing: Markup | None

    @property
    def brief(self) -> bool:
        """Whether a line says all."""
        return self.answer.passed and not self.row.message


def feedback_page(record: Record, find: Find, book: str = "", reveal: bool = False) -> str:
    """A page for one student, which needs nothing else.

    Parameters
    ----------
    record : Record
    find : callable
        Finds the exercise; where it finds none, the page has the marks and no pictures.
    book : str
        Address of the book, for links to its sections.
    reveal : bool
        Whether to show what would have been right.

    Returns
    -------
    str
        HTML, in which whatever the student wrote is text.
    """
    exercise = find(record)
    styles: list[str] = []
    parts = [_told(answer, exercise, book, reveal, styles) for answer in record.answers]
    return render(
        "feedback.html",
        "".join(dict.fromkeys(styles)),
        record=record,
        title=exercise.title if exercise else record.exercise or "Exercise",
        parts=parts,
        signed=signed,
    )


def _told(answer: Answer, exercise: Exercise | None, book: str, reveal: bool, styles: list[str]) -> Told:
    row = answer.row
    part = _part(exercise, row.part)
    shown, drawing, style = _pictured(part, row.answer, reveal) if part and not answer.passed else (None, None, "")
    if style:
        styles.append(style)
    heading, chapter = named(row.section)
    verdict = row.verdict if row.verdict in HEADLINES else UNREADABLE
    return Told(
        Row(row.part, row.title, row.points, row.out_of, row.message, verdict),
        answer,
        HEADLINES[verdict],
        SIGNS[verdict],
        heading,
        chapter,
        link(book, row.section),
        shown,
        drawing,
    )


@lru_cache(maxsize=ALIKE)
def _pictured(part: Part, text: str, reveal: bool) -> tuple[Shown | None, Markup | None, str]:
    """An answer, given as JSON, as the page shows and draws it, and the style that its drawing needs."""
    reading: Any = json.loads(text)
    sketch = picture(part, reading)
    drawing, style = drawn(sketch) if sketch else (None, "")
    return show(part, reading, reveal), drawing, style


def _part(exercise: Exercise | None, name: str) -> Part | None:
    try:
        return exercise.part(name) if exercise else None
    except DHError:  # the exercise was changed since
        return None


def finder(settings: Settings, students: Mapping[int, str]) -> Find:
    """Finds exercises as students were given them.

    Parameters
    ----------
    settings : Settings
        Where exercises are looked for, and the key of the course if students have numbers of their own.
    students : mapping of int to str
        Number of a submission to whose it is: a record that is shown may have another name.
    """
    from dhlib.grading.course.papers import Papers

    key = settings.read_key()
    papers: dict[str, Papers] = {}

    @lru_cache(maxsize=KEPT)
    def load(name: str, student: str) -> Exercise | None:
        try:
            if name not in papers:
                papers[name] = Papers(name, settings.folder)
            return papers[name].of(key, student or None).exercise
        except DHError:
            return None

    return lambda record: load(record.exercise, students.get(record.submission.id, "") if key else "")
