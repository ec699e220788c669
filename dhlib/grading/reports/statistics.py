"""What marks of a class say: how hard each part was, and how well it tells who understood the rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dhlib.grading.marks import OPEN
from dhlib.grading.reports.records import Record, parts_of

#: Below this, numbers say more about single students than about the class.
FEWEST = 5
#: Below this many, a correlation is mostly chance: it is shown, and said so.
FEW_FOR_CORRELATION = 20
#: How far from the median, in robust standard deviations, a result is worth a look.
FAR = 3.0
#: How clearly somebody must do well where others do badly; and how many parts each of right and wrong it takes.
AGAINST, BOTH = -0.3, 3


@dataclass(frozen=True)
class PartFigures:
    """One part, over the class.

    Parameters
    ----------
    part, title : str
    out_of : float
    tried : int
        How many handed in something for it.
    passed : int
    mean : float
        Mean of the points as a part of what could be earned, 0 to 1; who left it open counts with 0.
    discrimination : float or None
        Correlation of its points with the sum of all others; None where one of the two never varies.
    """

    part: str
    title: str
    out_of: float
    students: int
    tried: int
    passed: int
    mean: float
    discrimination: float | None

    @property
    def difficulty_in_words(self) -> str:
        """How hard it was."""
        for least, words in ((0.85, "easy"), (0.6, "moderate"), (0.3, "hard")):
            if self.mean >= least:
                return words
        return "very hard"

    @property
    def discrimination_in_words(self) -> str:
        """How well it tells who understood the rest."""
        if self.discrimination is None:
            return "all did alike"
        for least, words in ((0.4, "tells well"), (0.2, "tells"), (0.0, "hardly tells")):
            if self.discrimination >= least:
                return words
        return "the wrong way round: look at this part"


def part_figures(records: Sequence[Record]) -> list[PartFigures]:
    """Each part over the class, in the order of the exercise."""
    names = parts_of(records)
    points = _points(records, names)
    figures = []
    for k, name in enumerate(names):
        answers = [answer for record in records for answer in record.answers if answer.row.part == name]
        rest = np.nansum(np.delete(points, k, axis=1), axis=1)
        figures.append(
            PartFigures(
                name,
                answers[0].row.title,
                answers[0].row.out_of,
                len(records),
                sum(answer.row.verdict != OPEN for answer in answers),
                sum(answer.passed for answer in answers),
                float(np.mean([answer.part_of for answer in answers])),
                correlation(points[:, k], rest),
            )
        )
    return figures


def _points(records: Sequence[Record], names: Sequence[str]) -> np.ndarray:
    """Points of each student (rows) for each part (columns); 0 where a part is missing."""
    by_name = [{answer.row.part: answer.points for answer in record.answers} for record in records]
    return np.array([[points.get(name, 0.0) for name in names] for points in by_name], dtype=float)


def correlation(x: np.ndarray, y: np.ndarray) -> float | None:
    """Pearson's correlation; None where one of the two never varies.

    Examples
    --------
    >>> correlation(np.array([0, 1, 2]), np.array([1.0, 3, 5])), correlation(np.zeros(3), np.arange(3.0))
    (1.0, None)
    """
    dx, dy = x - x.mean(), y - y.mean()
    size = math.sqrt(float(dx @ dx) * float(dy @ dy))
    return round(float(dx @ dy) / size, 12) if size > 1e-12 else None


@dataclass(frozen=True)
class Unusual:
    """Somebody worth a look, and why."""

    record: Record
    why: str


def unusual(records: Sequence[Record]) -> list[Unusual]:
    """Whose result stands apart: far from the others, or right where most are wrong and wrong where most are right."""
    found = []
    points = np.array([record.points for record in records])
    middle = float(np.median(points))
    spread = 1.4826 * float(np.median(np.abs(points - middle)))
    names = parts_of(records)
    by_part = _points(records, names)
    means = by_part.mean(axis=0)
    out_of = {answer.row.part: answer.row.out_of for record in records for answer in record.answers}
    worth = np.array([out_of[name] or 1.0 for name in names])
    for k, record in enumerate(records):
        if spread > 0 and abs(record.points - middle) > FAR * spread:
            side = "above" if record.points > middle else "below"
            found.append(Unusual(record, f"{record.points:g} points, far {side} the median of {middle:g}"))
        against = correlation(by_part[k] / worth, means / worth)
        passed = sum(answer.passed for answer in record.answers)
        mixed = min(passed, len(record.answers) - passed) >= BOTH
        if against is not None and against < AGAINST and mixed:
            found.append(Unusual(record, "right where most are wrong, and wrong where most are right"))
    return found
