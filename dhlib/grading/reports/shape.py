"""An answer beside the shape of its mistake: which entries differ, but not what they should be."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from dhlib.errors import DHError
from dhlib.grading.exercise import Part
from dhlib.grading.forms import Choice, Formula, Frames, Function, Numbers, Table, Valued
from dhlib.grading.poses import COLUMNS
from dhlib.preconditions import check_frames
from dhlib.scalars import FloatArray
from dhlib.table import DEFAULT_COLUMNS

#: More rows or columns are no table that anybody reads.
MOST = 24
LONGEST_CELL = 60
#: Parts of which the right values are kept.
KEPT = 256
#: What a chain that was handed in as a table says of a joint without an offset.
NO_OFFSET = " + (0.0)"
SAME, DIFFERS = "same", "differs"


@dataclass(frozen=True)
class Cell:
    """An entry: its text, and whether it is right (``"same"``), not (``"differs"``), or nobody says (``""``)."""

    text: str
    verdict: str = ""


@dataclass(frozen=True)
class Grid:
    """A table of entries.

    Parameters
    ----------
    caption : str
    rows : sequence of sequence of Cell
    headings : sequence of str
        Of the columns; empty for none.
    names : sequence of str
        Of the rows; empty for none.
    """

    caption: str
    rows: Sequence[Sequence[Cell]]
    headings: Sequence[str] = ()
    names: Sequence[str] = ()

    @property
    def differing(self) -> int:
        """How many entries differ."""
        return sum(cell.verdict == DIFFERS for row in self.rows for cell in row)


@dataclass(frozen=True)
class Shown:
    """What a page shows of an answer.

    Parameters
    ----------
    answer : Grid
    right : Grid, optional
        What would have been right: only for pages that reveal it.
    """

    answer: Grid
    right: Grid | None = None


def show(part: Part, reading: Any, reveal: bool = False) -> Shown | None:
    """An answer to show; None if there is nothing that can be shown.

    Parameters
    ----------
    part : Part
    reading : dict
        As it came out of the box: nothing in it is trusted.
    reveal : bool
        Whether to show what would have been right.

    Returns
    -------
    Shown or None

    Examples
    --------
    >>> from dhlib.grading.exercise import load_exercise
    >>> shown = show(load_exercise("quickshot").part("A1"), {"values": [[[1, 2, 3, 4]] * 4]})
    >>> shown.answer.differing, shown.answer.headings
    (16, ('n', 'o', 'a', 'p'))
    """
    if not isinstance(reading, dict):
        return None
    match part.asks:
        case Choice():
            return _choice(part.asks, reading, reveal)
        case Table():
            return _table(part, part.asks, reading, reveal)
        case Frames():
            return _frames(part, part.asks, reading, reveal)
        case Valued():
            return _values(part, part.asks, reading, reveal)
    return None


def read_values(reading: Mapping[str, Any], shape: tuple[int, ...]) -> FloatArray | None:
    """The numbers of a reading; None if they are not of this shape."""
    try:
        values = np.array(reading.get("values"), dtype=float)
    except (TypeError, ValueError, OverflowError):
        return None
    return values if values.shape == shape else None


def number_text(value: float) -> str:
    """A number as a table shows it: four digits, a true minus sign, and no rubbish for zero.

    Examples
    --------
    >>> number_text(-0.50001), number_text(1e-17), number_text(123456.0), number_text(float("nan"))
    ('−0.5', '0', '1.235e+05', '–')
    """
    if not math.isfinite(value):
        return "–"
    if abs(value) < 1e-12:
        return "0"
    return f"{value:.4g}".replace("-", "−", 1) if value < 0 else f"{value:.4g}"


def _values(part: Part, asks: Valued, reading: Mapping[str, Any], reveal: bool) -> Shown | None:
    probes = asks.probes
    values = read_values(reading, (len(probes), *asks.shape))
    if values is None:
        return None
    right = _right(part)
    k, where = 0, ""
    differs: Any = None
    if asks.means is None:  # else different values may mean the same
        off = ~(np.abs(values - right) <= np.broadcast_to(asks.tolerances, values.shape))
        wrong = np.flatnonzero(off.reshape(len(off), -1).any(axis=1))
        k = int(wrong[0]) if len(wrong) else 0
        where = _where(asks, k, len(wrong), len(probes))
        differs = off.any(axis=0)
    caption = f"Your {part.id}{where}"
    answer = _grid(caption, values[k], differs)
    return Shown(answer, _grid("What it should be", right[k]) if reveal else None)


@lru_cache(maxsize=KEPT)
def _right(part: Part) -> FloatArray:
    """What is right; not to be changed, since it is kept for the next student."""
    assert isinstance(part.asks, Valued)
    return part.asks.values(part.chain)


def _where(asks: Valued, k: int, wrong: int, count: int) -> str:
    """For which joint values or arguments an answer is shown, in words."""
    probe = asks.probes[k]
    if isinstance(asks, Numbers):
        return ""
    if isinstance(asks, Formula):
        said = ", ".join(
            f"{name.replace('theta', 'θ')} = {number_text(v)}" for name, v in zip(asks.symbols, probe[0], strict=True)
        )
        place = f" at {said}"
    elif isinstance(asks, Function):
        name = asks.signature.partition("(")[0]
        place = f" for {name}({', '.join(_argument(argument) for argument in probe)})"
    else:
        place = ""
    return f"{place} (it differs at {wrong} of {count} places tried)" if 0 < wrong < count else place


def _argument(argument: Any) -> str:
    array = np.asarray(argument, dtype=float)
    if array.ndim == 0:
        return number_text(float(array))
    if array.size > 8:
        return "…"
    return f"[{', '.join(number_text(float(entry)) for entry in array.ravel())}]"


def _grid(caption: str, values: FloatArray, off: Any = None) -> Grid:
    """Numbers as a table, with the entries marked that differ."""
    array = np.atleast_2d(values)
    marks = np.atleast_2d(off) if off is not None else None
    if array.ndim > 2:
        array = array.reshape(-1, array.shape[-1])
        marks = marks.reshape(array.shape) if marks is not None else None

    def cell(i: int, j: int) -> Cell:
        verdict = "" if marks is None else DIFFERS if marks[i, j] else SAME
        return Cell(number_text(float(array[i, j])), verdict)

    rows = [[cell(i, j) for j in range(min(array.shape[1], MOST))] for i in range(min(len(array), MOST))]
    return Grid(caption, rows, COLUMNS if values.shape == (4, 4) else ())


def _choice(asks: Choice, reading: Mapping[str, Any], reveal: bool) -> Shown | None:
    choice = reading.get("choice")
    if not isinstance(choice, str):
        return None
    answer = Grid("Your choice", [[Cell(choice[:LONGEST_CELL], SAME if choice == asks.right else DIFFERS)]])
    return Shown(answer, Grid("What it should be", [[Cell(asks.right)]]) if reveal else None)


def _table(part: Part, asks: Table, reading: Mapping[str, Any], reveal: bool) -> Shown | None:
    table = reading.get("table")
    if not isinstance(table, dict) or not isinstance(table.get("rows"), list):
        return None
    rows = [row for row in table["rows"] if isinstance(row, list)][:MOST]
    columns = table.get("columns")
    named = isinstance(columns, list) and all(isinstance(name, str) for name in columns)
    headings = columns if named and columns else DEFAULT_COLUMNS[asks.convention]
    answer = Grid(
        f"Your {part.id}",
        [[Cell(_cell(cell)) for cell in row[:MOST]] for row in rows],
        [str(name)[:LONGEST_CELL] for name in headings[:MOST]],
        [str(i) for i in range(1, len(rows) + 1)],
    )
    return Shown(answer, _right_table(part, asks) if reveal else None)


def _cell(value: Any) -> str:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)[:LONGEST_CELL].removesuffix(NO_OFFSET)
    return number_text(float(value)) if abs(value) < 1e300 else "–"


def _right_table(part: Part, asks: Table) -> Grid:
    chain = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    columns = DEFAULT_COLUMNS[asks.convention]
    rows = []
    for i, joint in enumerate(chain.joints, 1):
        texts = {name: number_text(float(getattr(joint, name))) for name in ("theta", "d", "a", "alpha")}
        zero = float(getattr(joint, joint.variable))
        sign = "−" if joint.sign < 0 else ""
        texts[joint.variable] = f"{sign}q{i}" + (f" + {number_text(zero)}" if abs(zero) > 1e-12 else "")
        rows.append([Cell(texts[name]) for name in columns])
    return Grid("One of the tables that are right", rows, columns, [str(i) for i in range(1, chain.n + 1)])


def _frames(part: Part, asks: Frames, reading: Mapping[str, Any], reveal: bool) -> Shown | None:
    values = read_values(reading, (1, asks.count, 4, 4))
    if values is None:
        return None
    try:
        report = check_frames(values[0], asks.convention, axes=part.chain, tol=2 * asks.tolerance)
    except DHError:  # what is no frame obeys nothing; the sentence of the mark says so
        return None

    def told(holds: bool | None) -> Cell:
        return Cell("–") if holds is None else Cell("yes" if holds else "no", SAME if holds else DIFFERS)

    rows = [[told(link.dh1), told(link.dh2), told(link.on_axis)] for link in report.links]
    names = [f"link {link.link}" for link in report.links]
    answer = Grid("Your frames, link by link", rows, ("DH1", "DH2", "z on its joint axis"), names)
    if not reveal:
        return Shown(answer)
    chain = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    origins = chain.frames(np.zeros(chain.n))[:, :3, 3]
    right = [[Cell(number_text(float(x))) for x in origin] for origin in origins]
    heads = tuple(f"{letter} in {part.chain.unit}" if part.chain.unit else letter for letter in "xyz")
    return Shown(
        answer, Grid("Origins of one placing that is right", right, heads, [f"frame {i}" for i in range(len(right))])
    )
