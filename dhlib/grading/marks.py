"""A mark: what one answer is worth, and why."""

from __future__ import annotations

import re
from dataclasses import dataclass

from dhlib.grading.exercise import Part
from dhlib.grading.forms import Numbers
from dhlib.grading.misconceptions import Misconception

RIGHT, FOLLOWS, NEARLY, WRONG, OPEN, UNREADABLE = "right", "follows", "nearly", "wrong", "open", "unreadable"
#: What stands before the message.
HEADLINES = {
    RIGHT: "right",
    FOLLOWS: "right, given what came before",
    NEARLY: "nearly",
    WRONG: "not yet",
    OPEN: "still open",
    UNREADABLE: "cannot be read",
}
#: Which part of the points an answer earns that is off by a little more than the tolerance.
COARSE = 0.5
#: Which part of the points a right choice earns at most whose reasons are not all given, or not all good.
REASONED = 0.75
#: A hyphen before a number or a symbol, or alone; and what stands in square brackets, which is code.
HYPHEN = re.compile(r"\[[^\]]*\]|(?<![^\s(=·×±])-(?=[\d.]|[^\W\d_q]|\s)")
#: What is wrong about a single number that still was worked out, and not guessed.
OF_DRESS = ("degrees", "unit")


@dataclass(frozen=True)
class Mark:
    """What one answer is worth, and why.

    Parameters
    ----------
    part : str
    points, out_of : float
    verdict : {"right", "follows", "nearly", "wrong", "open", "unreadable"}
    message : str
        One or two sentences; plain text, in which anything that looks like markup is text.
    misconception : str
        Key of the one that fits, or ``""``.
    section : str
        Label of the section of the book to read, or ``""``.
    """

    part: str
    points: float
    out_of: float
    verdict: str
    message: str = ""
    misconception: str = ""
    section: str = ""

    @property
    def passed(self) -> bool:
        """Whether nothing is left to do here."""
        return self.verdict in (RIGHT, FOLLOWS)

    def __str__(self) -> str:
        return f"{self.part}: {HEADLINES[self.verdict]}. {self.message}".rstrip()


def stopped_with(error: str) -> str:
    """What to say of an answer that is not there because its cell failed.

    Examples
    --------
    >>> stopped_with("NameError: name 'a' is not defined")
    "Its cell stopped with an error: NameError: name 'a' is not defined."
    """
    return f"Its cell stopped with an error: {error.rstrip('.')}."


def with_minus(text: str) -> str:
    """Text with a minus where a hyphen stands for one; what is code, in brackets or of a joint variable, stays.

    Examples
    --------
    >>> with_minus("n_z is -S23 C4, and x - y is -1; write -q1, or q[i - 1], in the right-hand frame")
    'n_z is −S23 C4, and x − y is −1; write -q1, or q[i - 1], in the right-hand frame'
    """
    return HYPHEN.sub(lambda found: found[0] if found[0].startswith("[") else "−", text)


def make_mark(
    part: Part, verdict: str, message: str = "", credit: float = 0.0, known: Misconception | None = None
) -> Mark:
    """A mark for a part.

    Parameters
    ----------
    part : Part
    verdict, message : str
    credit : float
        Which part of the points is earned, where the answer does not pass; to the nearest quarter of a point. A
        wrong single number earns nothing, unless it is right in another unit.
    known : Misconception, optional
        The one that fits.
    """
    section = (known.where(part.convention) if known else "") or part.section
    passed = verdict in (RIGHT, FOLLOWS)
    if isinstance(part.asks, Numbers) and part.asks.shape == () and (known is None or known.key not in OF_DRESS):
        credit = 0.0  # a single number may have been a guess
    return Mark(
        part.id,
        part.points if passed else round(4 * part.points * credit) / 4,
        part.points,
        verdict,
        message if verdict in (OPEN, UNREADABLE) else with_minus(message),
        known.key if known else "",
        section if verdict in (NEARLY, WRONG) else "",
    )
