"""What kind of slip makes a formula wrong in one term: a sign, a sine for a cosine, another index, a term left out.

The answer is known by its values alone, and the right formula as a quantity of the arm. So the right one is taken
apart first, by values too: in the variables of the formula it is a sum of products of 1, cos and sin, or of 1 and the
variable where that is a length. Where joint axes are parallel it is so in the sums of their angles. Then each slip is
tried in each term. What is said is the kind of the slip and the entry, and never the term.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from dhlib.grading.exercise import Part
from dhlib.grading.forms import Formula
from dhlib.grading.poses import listed
from dhlib.grading.sentences import begun
from dhlib.scalars import FloatArray

#: A variable as it stands in a term: not at all, as itself or its cosine, as its sine.
NOTHING, EVEN, ODD = 0, 1, 2
#: Beyond these it would take too long, and no reader would see what is meant.
MOST_VALUES = 2500
MOST_TERMS = 60
MOST_ENTRIES = 4
ROUNDING = 1e-9

#: What is said of each kind of slip.
SAYS = {
    "whole sign": "{entry} is right but for its sign.",
    "sign": "In {entry} all is right but for the sign of one term.",
    "bracket": "In {entry} all is right but for the sign before one bracket.",
    "missing": "In {entry} one term is missing; the rest is right.",
    "bracket missing": "In {entry} the terms of one bracket are missing; the rest is right.",
    "twice": "In {entry} one term is there twice; the rest is right.",
    "sine": "In {entry} a sine stands for a cosine, or a cosine for a sine, in one place; the rest is right.",
    "sines": "In {entry} the sine and the cosine of one angle have changed places; the rest is right.",
    "index": "In {entry} one factor belongs to another joint: see the indices. The rest is right.",
    "factor": "In {entry} one term lacks a factor; the rest is right.",
    "number": "In {entry} one term has a wrong length or number before it; the rest is right.",
}


@dataclass(frozen=True, eq=False)
class Taken:
    """A formula taken apart.

    Attributes
    ----------
    variables : ndarray (probes, variables)
        At the probes of the part: sums of angles where axes are parallel.
    angles : tuple of bool
        Which of the variables are angles.
    terms : list of (ndarray, tuple)
        Coefficients, of the shape of the answer, and how each variable stands in the term.
    """

    variables: FloatArray
    angles: tuple[bool, ...]
    terms: list[tuple[FloatArray, tuple[int, ...]]]

    def factor(self, variable: int, how: int) -> FloatArray:
        """A factor at the probes."""
        x = self.variables[:, variable]
        if how == NOTHING:
            return np.ones(len(x))
        if not self.angles[variable]:
            return x
        return np.asarray(np.cos(x) if how == EVEN else np.sin(x), dtype=float)

    def without(self, held: tuple[int, ...], variable: int) -> FloatArray:
        """A term at the probes, without its coefficient and one of its factors."""
        factors = [self.factor(k, how) for k, how in enumerate(held) if k != variable]
        return np.asarray(np.prod(factors, axis=0) if factors else np.ones(len(self.variables)), dtype=float)

    def value(self, held: tuple[int, ...]) -> FloatArray:
        """A term at the probes, without its coefficient."""
        return self.without(held, -1)


def slip_in_a_term(part: Part, asks: Formula, values: FloatArray, right: FloatArray) -> str:
    """Say what is amiss in each entry that one slip in one term explains; empty if that is none of them.

    Parameters
    ----------
    part : Part
    asks : Formula
    values, right : ndarray (probes, *shape)
        NaN where a formula has no value.
    """
    there: NDArray[np.bool_] = np.asarray(np.isfinite(values).reshape(len(values), -1).all(axis=1))
    tolerances = np.broadcast_to(asks.tolerances, right.shape[1:])
    off: NDArray[np.bool_] = np.asarray(np.any(np.abs(values - right)[there] > tolerances, axis=0))
    places = [tuple(map(int, place)) for place in np.argwhere(off)]
    if asks.shape == (4, 4) and any(place[0] == 3 for place in places):
        return ""  # the last row of a pose holds no formula
    if not 1 <= len(places) <= MOST_ENTRIES or there.sum() < len(values) / 2:
        return ""
    told: OrderedDict[str, list[tuple[int, ...]]] = OrderedDict()
    for place in places:
        for taken in taken_apart(part, asks):
            difference = np.array([value[place] for value in (values - right)[there]])
            if kind := _kind(taken, place, there, difference, float(tolerances[place])):
                told.setdefault(kind, []).append(place)
                break
    says = [SAYS[kind].format(entry=_entries(asks.shape, explained)) for kind, explained in told.items()]
    unexplained = len(places) - sum(map(len, told.values()))
    if says and unexplained:
        says = [each.replace("; the rest is right", "").replace(" The rest is right.", "") for each in says]
        says.append(f"{unexplained} other {'entry differs' if unexplained == 1 else 'entries differ'}, too.")
    return " ".join(map(begun, says))


def _entries(shape: tuple[int, ...], places: list[tuple[int, ...]]) -> str:
    """Names of entries, in a sentence."""
    if not shape:
        return "it"
    if len(shape) == 1:
        names = [str(place[0] + 1) for place in places]
    elif shape == (4, 4):
        names = [f"{'noap'[column]}_{'xyz'[row]}" for row, column in places]
    else:
        names = [f"({', '.join(str(k + 1) for k in place)})" for place in places]
    return f"entry {names[0]}" if len(names) == 1 else f"each of the entries {listed(names)}"


def _kind(
    taken: Taken, place: tuple[int, ...], there: NDArray[np.bool_], off: FloatArray, tolerance: float
) -> str | None:
    """Which kind of slip makes this difference."""
    terms = [(float(c[place]), held) for c, held in taken.terms if abs(c[place]) > ROUNDING]
    if not terms or len(terms) > MOST_TERMS:
        return None
    values = [c * taken.value(held) for c, held in terms]
    for kind, change in _slips(taken, terms, values):
        if np.all(np.abs(change[there] - off) <= 2 * tolerance):
            return kind
    for value in values:
        held = value[there]
        scale = float(held @ off) / float(held @ held) if held @ held else 0.0
        if scale and np.all(np.abs(scale * held - off) <= 2 * tolerance):
            return "number"
    return None


def _slips(
    taken: Taken, terms: list[tuple[float, tuple[int, ...]]], values: list[FloatArray]
) -> Iterator[tuple[str, FloatArray]]:
    """What each slip adds to an entry, the simple ones first."""
    yield "whole sign", -2 * np.sum(values, axis=0)
    for value in values:
        yield "sign", -2 * value
        yield "missing", -value
        yield "twice", value
    n = taken.variables.shape[1]
    for (c, held), value in zip(terms, values, strict=True):
        for k, how in enumerate(held):
            if how != NOTHING and taken.angles[k]:
                rest = c * taken.without(held, k)
                yield "sine", rest * taken.factor(k, ODD + EVEN - how) - value
                for other in range(n):
                    if other != k and taken.angles[other]:
                        yield "index", rest * taken.factor(other, how) - value
    for k, how in product(range(n), (EVEN, ODD)):
        group = [j for j, (_, held) in enumerate(terms) if held[k] == how]
        if 1 < len(group) < len(terms):
            bracket = np.sum([values[j] for j in group], axis=0)
            yield "bracket", -2 * bracket
            yield "bracket missing", -bracket
    for k in range(n):
        if taken.angles[k]:
            swapped = [
                c * taken.without(held, k) * taken.factor(k, ODD + EVEN - held[k]) - value
                for (c, held), value in zip(terms, values, strict=True)
                if held[k] != NOTHING
            ]
            if len(swapped) > 1:
                yield "sines", np.sum(swapped, axis=0)
    for (c, held), value in zip(terms, values, strict=True):
        for k, how in enumerate(held):
            if how != NOTHING:
                yield "factor", c * taken.without(held, k) - value


def taken_apart(part: Part, asks: Formula) -> Iterator[Taken]:
    """The right formula of a part, taken apart in the sums of parallel angles, and in the angles themselves."""
    for k in range(len(_ways(part, len(asks.symbols)))):
        if taken := _in_one_way(part, k):
            yield taken


@lru_cache(maxsize=64)
def _in_one_way(part: Part, k: int) -> Taken | None:
    asks = part.asks
    assert isinstance(asks, Formula)

    def value(point: FloatArray) -> FloatArray:
        return np.asarray(asks.quantity(part.chain, tuple(map(float, point))), dtype=float)

    points = np.array([list(point) for (point,) in asks.probes])
    return _take(value, points, asks.values(part.chain), _ways(part, len(asks.symbols))[k])


def _ways(part: Part, n: int) -> list[FloatArray]:
    """Matrices that make the variables of a formula out of the joint variables."""
    ways = [np.eye(n)]
    joints = part.chain.joints
    if len(joints) == n and set(part.chain.kinds) == {"R"}:
        sums = np.eye(n)
        first = 0 if part.chain.convention == "classic" else 1  # the twist between joint i and the next stands there
        for i in range(1, n):
            twist = joints[i - 1 + first].alpha
            if abs(np.sin(float(twist))) < ROUNDING:
                sums[i] += np.cos(float(twist)).round() * sums[i - 1]
        if not np.array_equal(sums, np.eye(n)):
            ways.insert(0, sums)
    return ways


def _take(
    value: Callable[[FloatArray], FloatArray], points: FloatArray, right: FloatArray, sums: FloatArray
) -> Taken | None:
    """Take a formula apart by its values on a grid; None if it is no such sum of products."""
    back = np.linalg.inv(sums)
    start = sums @ points[-1]

    def at(variables: FloatArray) -> FloatArray:
        return value(back @ variables)

    kinds = [_kind_of_variable(at, start, k) for k in range(len(start))]
    if "other" in kinds:
        return None
    grids = {"angle": (0.0, np.pi / 2, np.pi), "length": (0.0, 1.0), "none": (float("nan"),)}
    nodes = [(start[k],) if kind == "none" else grids[kind] for k, kind in enumerate(kinds)]
    if np.prod([len(each) for each in nodes]) > MOST_VALUES:
        return None
    shape = tuple(len(each) for each in nodes)
    table = np.array([at(np.array(node)) for node in product(*nodes)]).reshape(*shape, *right.shape[1:])
    for k, kind in enumerate(kinds):
        table = np.moveaxis(table, k, 0)
        if kind == "angle":
            zero, quarter, half = table
            mean = (zero + half) / 2
            table = np.stack([mean, (zero - half) / 2, quarter - mean])
        elif kind == "length":
            table = np.stack([table[0], table[1] - table[0]])
        table = np.moveaxis(table, 0, k)
    largest = max(float(np.abs(table).max()), 1e-12)
    terms = [
        (table[held], held)
        for held in product(*(range(size) for size in shape))
        if np.abs(table[held]).max() > ROUNDING * largest
    ]
    variables = points @ sums.T
    taken = Taken(variables, tuple(kind == "angle" for kind in kinds), terms)
    again = sum(
        (np.multiply.outer(taken.value(held), c) for c, held in terms), start=np.zeros((len(points), *right.shape[1:]))
    )
    return taken if np.abs(again - right).max() <= 1e-6 * largest else None


def _kind_of_variable(at: Callable[[FloatArray], FloatArray], start: FloatArray, k: int) -> str:
    """Whether a formula depends on a variable as on an angle, as on a length, or not at all."""

    def moved(by: float) -> FloatArray:
        point = start.copy()
        point[k] += by
        return at(point)

    here = at(start)
    scale = 1e-9 * max(1.0, float(np.abs(here).max()))
    steps = [moved(by) - here for by in (0.7, 1.4, 2 * np.pi)]
    if all(np.abs(step).max() <= scale for step in steps):
        return "none"
    if np.abs(steps[2]).max() <= 10 * scale:
        return "angle"
    return "length" if np.abs(steps[1] - 2 * steps[0]).max() <= 10 * scale else "other"
