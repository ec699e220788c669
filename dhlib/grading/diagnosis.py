"""How well wrong answers are named and right ones known: ``python -m dhlib.grading.diagnosis``, or ``make diagnosis``.

For every part the known misconceptions are applied to the reference, and what they give is marked as if somebody had
handed it in; and the answers of the worked solution are handed in in many dresses. The tallies go into
``book/diagnosis.csv``, which the instructors' page shows.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import io
import json
import math
import re
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import Exercise, Part, load_exercise
from dhlib.grading.forms import Choice, Formula, Frames, Function, Numbers, ReasonedChoice, Table, Valued
from dhlib.grading.marking import LARGEST_NUMBER, agree, mark
from dhlib.grading.marks import Mark
from dhlib.grading.misconceptions import retellings, told_frames, would_have_given
from dhlib.grading.notebook import load_notebook
from dhlib.grading.retelling import altered
from dhlib.joints import Joint
from dhlib.mechanism import same_mechanism
from dhlib.scalars import FloatArray
from dhlib.table import DEFAULT_COLUMNS

#: Keys of what the ladder of a table says of the same arm with something else about it: as exact as any name.
LADDER = frozenset({"ends", "offset", "sense"})
HALF = math.pi


@dataclass
class Tally:
    """How many answers were marked how.

    Attributes
    ----------
    parts : int
    named : int
        Wrong answers told by the one misconception that leads to them.
    common : int
        Wrong answers to which more than one leads, told what these have in common.
    other : int
        Wrong answers of which something else was said.
    accepted : int
        Wrong answers that passed.
    right : int
        Right answers that were known as right.
    refused : int
        Right answers that were not.
    """

    parts: int = 0
    named: int = 0
    common: int = 0
    other: int = 0
    accepted: int = 0
    right: int = 0
    refused: int = 0

    def __add__(self, more: Tally) -> Tally:
        return Tally(*(getattr(self, f.name) + getattr(more, f.name) for f in fields(self)))

    def __str__(self) -> str:
        return (
            f"{self.named} of {self.wrong} wrong answers named exactly ({self.share:.1%}), {self.accepted} accepted; "
            f"{self.refused} of {self.right + self.refused} right ones refused"
        )

    @property
    def wrong(self) -> int:
        """How many wrong answers there were."""
        return self.named + self.common + self.other + self.accepted

    @property
    def share(self) -> float:
        """Which part of the wrong answers was named exactly."""
        return self.named / self.wrong if self.wrong else 1.0


@dataclass(frozen=True)
class Case:
    """An answer that was handed in for a trial: to which part, what leads to it, and the mark."""

    part: Part
    answer: str
    keys: frozenset[str]
    mark: Mark

    @property
    def how(self) -> str:
        """Of which attribute of a `Tally` it is one."""
        if not self.keys:
            return "right" if self.mark.verdict == "right" else "refused"
        if self.mark.passed:
            return "accepted"
        told = set(self.mark.misconception.split("+")) - {""}
        if not told & self.keys:
            return "other"
        return "named" if len(told) == 1 else "common"


def cases(exercise: Exercise, solved: dict[str, Any]) -> Iterator[Case]:
    """Every answer that is tried, and how it was marked.

    Parameters
    ----------
    exercise : Exercise
    solved : dict
        The variables of the worked solution.
    """
    for part in exercise.parts:
        for keys, reading in wrong_readings(part):
            yield Case(part, "", keys, mark(part, reading))
        for dress, answer in right_answers(part, solved[part.id]):
            reading = json.loads(json.dumps(read_answer(part.asks.request(), answer), allow_nan=False))
            yield Case(part, dress, frozenset(), mark(part, reading))


# Wrong answers


def wrong_readings(part: Part) -> Iterator[tuple[frozenset[str], dict[str, Any]]]:
    """Each distinct wrong answer that a known misconception leads to, with the keys of all that lead to it."""
    match part.asks:
        case Table():
            yield from _wrong_tables(part, part.asks)
        case Frames():
            yield from _wrong_frames(part, part.asks)
        case Valued():
            yield from _wrong_values(part, part.asks)


def _wrong_values(part: Part, asks: Valued) -> Iterator[tuple[frozenset[str], dict[str, Any]]]:
    right = asks.values(part.chain)
    found: list[tuple[FloatArray, set[str]]] = []
    for slip, values in would_have_given(part):
        meant = asks.meaning(values)
        if agree(meant, asks.meaning(right), asks.tolerances) or np.abs(values).max() > LARGEST_NUMBER:
            continue
        for others, keys in found:
            if agree(meant, asks.meaning(others), asks.tolerances):
                keys.add(slip.misconception.key)
                break
        else:
            found.append((values, {slip.misconception.key}))
    for values, keys in found:
        yield frozenset(keys), {"values": values.tolist()}


def _wrong_frames(part: Part, asks: Frames) -> Iterator[tuple[frozenset[str], dict[str, Any]]]:
    chain = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    right = chain.frames(np.zeros(chain.n))
    for slip, frames in told_frames(part.chain, asks.convention):
        if np.abs(frames - right).max() > asks.length_tolerance and np.abs(frames).max() < LARGEST_NUMBER:
            yield frozenset({slip.misconception.key}), {"values": [frames.tolist()]}


def _wrong_tables(part: Part, asks: Table) -> Iterator[tuple[frozenset[str], dict[str, Any]]]:
    reference = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    told = [(trap.key, trap.quantity(part.chain)) for trap in part.traps]
    told += [(key, arm) for key, _, arm in retellings(reference) if isinstance(arm, Chain)]
    found: list[tuple[Chain, set[str]]] = []
    for key, arm in told:
        # A table is its rows: base and tool of a retelling, and what was read in the other convention, are not in it.
        rows = Chain(arm.joints, asks.convention, reference.base, reference.tool, unit=reference.unit)
        ladder: set[str] = set()
        if rows.kinds == reference.kinds:
            if _same_rows(rows, reference):
                continue
            if same := same_mechanism(rows, reference, tol=1e-3):
                if _is_right(part, asks, rows, reference):
                    continue
                ladder = {*LADDER} if same else ladder
        for others, keys in found:
            if others.kinds == rows.kinds and _same_rows(others, rows):
                keys.add(key)
                break
        else:
            found.append((rows, {key} | ladder))
    for rows, keys in found:
        yield frozenset(keys), {"table": {"rows": _cells(rows), "columns": None}}


def _same_rows(one: Chain, other: Chain) -> bool:
    rows = [np.array([[j.theta, j.d, j.a, j.alpha, j.sign] for j in arm.joints], dtype=float) for arm in (one, other)]
    return bool(np.abs(rows[0] - rows[1]).max() < 1e-6)


def _is_right(part: Part, asks: Table, rows: Chain, reference: Chain) -> bool:
    """Whether rows are the right arm after all, by freedoms that the task leaves: a false friend of a slip."""
    free = tuple(name for name in ("zeros", "senses") if name in asks.free)
    ends = ("base", "tool") if "ends" in asks.free else ()
    if same_mechanism(rows, reference, tol=1e-3, free=(*free, *ends)):
        return True
    if "turns" not in asks.free:
        return False
    verdict = same_mechanism(rows, reference, tol=1e-3, free=(*free, "base", "tool"))
    return bool(verdict) and all(
        np.abs(end[:3, 3]).max() < 1e-3 * reference.reach for end in (verdict.base, verdict.tool)
    )


def _cells(chain: Chain) -> list[list[float | str]]:
    """Rows as a student writes them, in the order of the convention."""
    rows = []
    for i, joint in enumerate(chain.joints, 1):
        row: dict[str, float | str] = {name: float(getattr(joint, name)) for name in ("theta", "d", "a", "alpha")}
        row[joint.variable] = f"{'-' if joint.sign < 0 else ''}q{i} + ({row[joint.variable]!r})"
        rows.append([row[name] for name in DEFAULT_COLUMNS[chain.convention]])
    return rows


# Right answers


def right_answers(part: Part, answer: Any) -> Iterator[tuple[str, Any]]:
    """The worked answer to a part in many dresses, and other answers that are as right."""
    yield "as it is", answer
    match part.asks:
        case ReasonedChoice():
            option, *letters = answer
            yield from {"a set": {option, *letters}, "a list": [option, letters], "letters": (option, "".join(letters)),
                        "backwards": [*letters[::-1], option.upper()]}.items()  # fmt: skip
        case Choice():
            yield from {"capitals": answer.upper(), "in a list": [answer], "with blanks": f" {answer} "}.items()
        case Table():
            yield from _right_tables(part, part.asks, answer)
        case Frames():
            yield from _right_frames(part, part.asks, answer)
        case Function():
            yield from _right_functions(answer)
        case Formula():
            yield from _right_formulas(answer)
        case Numbers():
            yield from _right_numbers(part.asks, np.asarray(answer, dtype=float))


def _right_numbers(asks: Numbers, right: FloatArray) -> Iterator[tuple[str, Any]]:
    import sympy

    yield "a list", right.tolist()
    yield "an array of objects", right.astype(object)
    rounded = np.array(right)
    if asks.means is None:
        tolerances = np.broadcast_to(asks.tolerances, right.shape)
        for place in np.ndindex(right.shape):
            rounded[place] = round(float(right[place]), math.floor(-math.log10(2 * tolerances[place]) + 1e-9) + 1)
        yield "rounded", rounded.tolist()
    if right.ndim:
        yield "sympy", sympy.Matrix(right)
    if right.ndim == 2:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PendingDeprecationWarning)
            yield "np.matrix", np.matrix(right)
        yield "a data frame", _frame(right)


def _frame(rows: Any) -> Any:
    import pandas

    return pandas.DataFrame(rows)


def _right_formulas(right: Any) -> Iterator[tuple[str, Any]]:
    import sympy

    matrix = sympy.Matrix(right) if isinstance(right, list | tuple) else sympy.sympify(right)

    def each(change: Callable[[Any], Any]) -> Any:
        return matrix.applyfunc(change) if isinstance(matrix, sympy.MatrixBase) else change(matrix)

    yield "expanded", each(sympy.expand)
    yield "as exponentials", each(lambda entry: entry.rewrite(sympy.exp))
    yield "by half tangents", each(lambda entry: entry.rewrite(sympy.tan))
    yield "in decimals", each(sympy.N)
    renamed = {
        symbol: sympy.Symbol(f"q{m[1]}")
        for symbol in matrix.free_symbols
        if (m := re.fullmatch(r"theta(\d+)", symbol.name))
    }
    yield "with q for theta", each(lambda entry: entry.subs(renamed))
    if isinstance(matrix, sympy.MatrixBase):
        yield "a list", matrix.tolist()
        yield "immutable", sympy.ImmutableMatrix(matrix)
        yield "an array of objects", np.array(matrix.tolist(), dtype=object)


def _right_functions(right: Any) -> Iterator[tuple[str, Any]]:
    import sympy

    def returning(dress: Callable[[Any], Any]) -> Callable[..., Any]:
        return lambda *arguments: dress(np.asarray(right(*arguments), dtype=float))

    yield "returns lists", returning(lambda value: value.tolist())
    yield "returns sympy", returning(lambda value: sympy.Matrix(value) if value.ndim else sympy.Float(float(value)))
    yield "returns objects", returning(lambda value: value.astype(object))


def _right_frames(part: Part, asks: Frames, answer: Any) -> Iterator[tuple[str, Any]]:
    frames = np.array([np.asarray(frame, dtype=float) for frame in answer])
    yield "an array", frames
    yield "a dictionary", dict(enumerate(frames))
    yield "rounded", frames.round(4).tolist()
    chain = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    for name, told in other_chains(chain):
        yield name, told.frames(_zero(told, chain))


def _zero(told: Chain, chain: Chain) -> FloatArray:
    """Joint values at which another table of an arm stands as the arm does at zero: the same."""
    return np.zeros(chain.n)


def _right_tables(part: Part, asks: Table, answer: Any) -> Iterator[tuple[str, Any]]:
    import sympy

    reference = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    columns = list(DEFAULT_COLUMNS[asks.convention])
    rows = [list(row) for row in answer]
    yield "tuples", tuple(map(tuple, rows))
    yield "an array of objects", np.array(rows, dtype=object)
    yield "sympy", sympy.Matrix(rows)
    frame = _frame(rows)
    frame.columns = columns
    yield "a data frame", frame
    yield "columns in another order", frame[columns[::-1]]
    yield "a dictionary", {name: [row[k] for row in rows] for k, name in enumerate(columns)}
    yield "numbered rows", [[i, *row] for i, row in enumerate(rows, 1)]
    yield "text", [[str(cell) for cell in row] for row in rows]
    yield "a chain", Chain(reference.joints, asks.convention, unit=reference.unit)
    for name, told in other_chains(reference):
        yield name, _cells(told)
    if "zeros" in asks.free:
        kinds = {"R": 0.5, "P": 0.1 * reference.reach}
        for i, joint in enumerate(reference.joints, 1):
            shifted = {joint.variable: getattr(joint, joint.variable) + kinds[joint.kind]}
            yield f"zero of joint {i}", _cells(altered(reference, i, **shifted))
    if "senses" in asks.free:
        for i, joint in enumerate(reference.joints, 1):
            yield f"sense of joint {i}", _cells(altered(reference, i, sign=-joint.sign))


def other_chains(chain: Chain) -> Iterator[tuple[str, Chain]]:
    """Other tables of the same arm with the same pose at the same joint values, by the choices that DH leaves."""
    # x_i reversed: joint i and joint i+1 gain half a turn, and the link beside x_i changes its signs.
    shift = 0 if chain.convention == "classic" else 1
    for i in range(1, chain.n):
        link = i + shift
        told = altered(chain, i, theta=lambda joint: joint.theta + HALF)
        told = altered(told, i + 1, theta=lambda joint: joint.theta + HALF)
        yield f"x_{i} reversed", altered(told, link, a=lambda joint: -joint.a, alpha=lambda joint: -joint.alpha)
    # Axis i reversed: the twists on both sides gain half a turn, and joint i counts the other way.
    for i in range(2, chain.n + 1 - shift):
        told = altered(chain, i, theta=lambda joint: -joint.theta, d=lambda joint: -joint.d,
                       sign=lambda joint: -joint.sign)  # fmt: skip
        for link in (i - 1 + shift, i + shift):
            told = altered(told, link, alpha=lambda joint: joint.alpha + HALF)
        yield f"axis {i} reversed", told
    # Along parallel axes only the sum of the offsets counts.
    for i in range(1, chain.n):
        joints: Sequence[Joint] = chain.joints
        alpha = float(joints[i - 1 + shift].alpha)
        if abs(math.sin(alpha)) < 1e-9:
            by = 0.1 * chain.reach
            told = altered(chain, i, d=lambda joint, by=by: joint.d + by)
            back = by * math.cos(alpha)
            yield f"d_{i} moved on", altered(told, i + 1, d=lambda joint, back=back: joint.d - back)


# The table of the book


def solve(notebook: Path) -> dict[str, Any]:
    """The variables of a worked solution of our own, which runs here."""
    names: dict[str, Any] = {"__name__": "__main__"}
    with contextlib.redirect_stdout(io.StringIO()):
        for cell in load_notebook(notebook)["cells"]:
            if cell["cell_type"] == "code":
                exec("".join(cell["source"]), names)
    return names


HEADER = (
    "exercise", "parts", "wrong answers tried", "named exactly", "common part told", "something else told", "accepted",
    "right answers tried", "refused",
)  # fmt: skip


def as_row(tally: Tally) -> list[int]:
    """A tally as the table of the book has it, without the name."""
    wrong = (tally.wrong, tally.named, tally.common, tally.other, tally.accepted)
    return [tally.parts, *wrong, tally.right + tally.refused, tally.refused]


def as_text(tallies: dict[str, Tally]) -> str:
    """The tallies as they are stored: CSV, a row for each exercise and one for all."""
    whole = sum(tallies.values(), Tally())
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEADER)
    writer.writerows([name, *as_row(tally)] for name, tally in tallies.items())
    writer.writerow(["all", *as_row(whole)])
    return text.getvalue()


def read(path: Path) -> dict[str, list[int]]:
    """The rows that are stored, by the name of the exercise."""
    with path.open(encoding="utf-8", newline="") as file:
        return {name: [int(count) for count in counts] for name, *counts in list(csv.reader(file))[1:]}


def main(arguments: list[str] | None = None) -> int:
    """Try every exercise, say what was found, and write the tallies."""
    parser = argparse.ArgumentParser(
        prog="python -m dhlib.grading.diagnosis", description=str(__doc__).split("\n\n")[0]
    )
    parser.add_argument("names", nargs="*", help="exercises to look at closely; nothing is written then")
    parser.add_argument("--solutions", type=Path, default=Path("solutions"), help="where the solutions are")
    parser.add_argument("--exercises", type=Path, default=Path("exercises"), help="where the exercises are")
    parser.add_argument("--out", type=Path, default=Path("book/diagnosis.csv"), help="where the tallies go")
    options = parser.parse_args(arguments)
    try:
        names = options.names or sorted(path.stem for path in options.solutions.glob("*.ipynb"))
        tallies = {}
        for name in names:
            exercise = load_exercise(name, options.exercises)
            solved = solve(options.solutions / f"{name}.ipynb")
            tallies[name] = tally = Tally(len(exercise.parts))
            for case in cases(exercise, solved):
                setattr(tally, case.how, getattr(tally, case.how) + 1)
                if options.names and case.how in ("common", "other", "accepted", "refused"):
                    print(f"  {case.how}: {'+'.join(sorted(case.keys))}{case.answer} → {case.mark}")
            print(f"{name}: {tally}")
    except DHError as error:
        print(error, file=sys.stderr)
        return 2
    if not options.names:
        options.out.write_text(as_text(tallies), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
