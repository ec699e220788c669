"""What a gradebook has room for: the marks of a student in a few lines of text."""

from __future__ import annotations

from dhlib.grading.marks import HEADLINES, OPEN
from dhlib.grading.reports.cells import number
from dhlib.grading.reports.records import Answer, Record
from dhlib.grading.sections import where


def lines(record: Record) -> list[str]:
    """The result, what was changed by hand, and what to mend."""
    told = [f"{number(record.points)} of {number(record.out_of)} points." if record.marked else "No marks."]
    told += [text for text in (record.submission.message, record.about_time) if text]
    told += [f"{signed(bonus.points)} points: {bonus.reason}" for bonus in record.bonuses]
    told += [line(answer) for answer in record.answers if not answer.passed or answer.adjustment]
    return told


def line(answer: Answer) -> str:
    """One part: its points, and why."""
    row = answer.row
    told = f"{row.part} ({number(answer.points)} of {number(row.out_of)}): {HEADLINES[row.verdict]}"
    if row.verdict == OPEN and not row.message:
        return f"{told}."
    pieces = [f"{told}.", row.message, where(row.section)]
    if answer.adjustment:
        pieces.append(f"Changed by hand from {number(row.points)} points: {answer.adjustment.reason}")
    return " ".join(piece for piece in pieces if piece)


def signed(points: float) -> str:
    """Points with a sign.

    Examples
    --------
    >>> signed(2), signed(-0.5)
    ('+2', '-0.5')
    """
    return f"{'+' if points >= 0 else '-'}{number(abs(points))}"
