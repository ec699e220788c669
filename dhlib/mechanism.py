"""Whether two DH tables describe the same mechanism, and how they then differ.

A table is one of many for an arm. What is physical are the joint axes as lines in space (of a prismatic joint only the
direction). What is chosen: base and tool, the zero of each joint, the sense in which it counts; whether x points one
way or the other; where along parallel axes an offset stands. So the question is not whether numbers are equal but
whether there are G, H, σ, δ with ``T_reference(q) = G · T_answer(δ + σ q) · H`` for all q.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.normals import NEARLY_PARALLEL, PARALLEL, ROUNDING, common_normal, extent, without_rounding
from dhlib.overlay import Fit, Freedom, Search, Tolerance, near_points
from dhlib.scalars import FloatArray, is_number
from dhlib.show import angle_text, number_text
from dhlib.transforms import inverse

FREEDOMS = ("base", "tool", "zeros", "senses")
#: What stands in a reason before the number of the reference.
_EXPECTED = ", expected "
#: Which freedoms are tried, one after the other, and with other joint zeros if they do not do.
ENDS: tuple[tuple[str, ...], ...] = ((), ("tool",), ("base",), ("base", "tool"))
ZEROS = tuple((*ends, "zeros") for ends in ENDS)

#: How many joint vectors a certificate is checked at, and how large the angles are.
PROBES, WIDEST = 6, 2.8
#: An offset d this many times the size of the arm, beside nearly parallel axes, is a symptom.
FAR = 10.0


@dataclass(frozen=True, eq=False)
class Sameness:
    """What :func:`same_mechanism` found: true if the two are the same mechanism.

    Attributes
    ----------
    same : bool
    base, tool : ndarray (4, 4)
        G and H; NaN where the two are not the same.
    signs : tuple of int
        σ: for each joint 1, or -1 if it counts the other way; empty where the two are not the same.
    offsets : ndarray (n,)
        δ, in radians or lengths.
    joint : int or None
        Where the two are not the same: the first joint, from 1, whose axis finds no counterpart. None if all do
        and only the end does not, or if the numbers of joints differ.
    reason : str
        The same in words.
    mirror : bool
        Whether the two are not the same, but the mirror image of one is the other.
    notes : tuple of str
        What else is worth saying: other units, nearly parallel axes.
    certificate_error : float
        By how much ``G · T_answer(δ + σ q) · H`` misses ``T_reference(q)`` at worst, at several random q: in radians,
        or in lengths relative to the reach. Infinite where the two are not the same.
    kinds : str
        One letter per joint, R or P: what the offsets are measured in.

    Examples
    --------
    >>> from dhlib import Chain, Revolute
    >>> answer = Chain([Revolute(a=1), Revolute(a=1, offset=0.5)], "classic")
    >>> verdict = same_mechanism(answer, Chain([Revolute(a=1), Revolute(a=2)], "classic"))
    >>> verdict.same_base, verdict.same_tool, verdict.same_zeros, verdict.same_senses
    (True, False, True, True)
    >>> print(verdict)
    The same mechanism, with another tool.
    """

    same: bool
    base: FloatArray
    tool: FloatArray
    signs: tuple[int, ...]
    offsets: FloatArray
    joint: int | None = None
    reason: str = ""
    mirror: bool = False
    notes: tuple[str, ...] = ()
    certificate_error: float = math.inf
    kinds: str = ""

    def __bool__(self) -> bool:
        return self.same

    def __str__(self) -> str:
        return self.message

    @property
    def same_base(self) -> bool:
        """Whether no other base is needed: G is the identity."""
        return self.same and bool(np.array_equal(self.base, np.eye(4)))

    @property
    def same_tool(self) -> bool:
        """Whether no other tool is needed: H is the identity."""
        return self.same and bool(np.array_equal(self.tool, np.eye(4)))

    @property
    def same_ends(self) -> bool:
        """Whether neither another base nor another tool is needed."""
        return self.same_base and self.same_tool

    @property
    def same_zeros(self) -> bool:
        """Whether every joint counts from the same zero: δ is 0."""
        return self.same and not self.offsets.any()

    @property
    def same_senses(self) -> bool:
        """Whether every joint counts the same way: σ is +1."""
        return self.same and all(sign == 1 for sign in self.signs)

    @property
    def finding(self) -> str:
        """The reason without the number that was expected, for whoever should find it.

        Examples
        --------
        >>> from dhlib import Chain, Revolute
        >>> arms = [Chain([Revolute(a=a), Revolute(a=1)], "classic") for a in (1, 2)]
        >>> same_mechanism(*arms).reason
        'distance between axes 1 and 2 is 1, expected 2'
        >>> same_mechanism(*arms).finding
        'distance between axes 1 and 2 is 1'
        """
        return self.reason.partition(_EXPECTED)[0]

    @property
    def message(self) -> str:
        """The verdict for people: a sentence or two."""
        sentences = [self._same_in_words() if self.same else f"Not the same mechanism: {self.reason}."]
        if self.mirror:
            sentences.append("It is the mirror image.")
        return " ".join([*sentences, *self.notes])

    def _same_in_words(self) -> str:
        others = []
        if not self.same_ends:
            ends = [f"another {end}" for end, kept in (("base", self.same_base), ("tool", self.same_tool)) if not kept]
            others.append(f"with {' and '.join(ends)}")
        moved = [
            f"joint {i} by {angle_text(offset) if kind == 'R' else number_text(offset)}"
            for i, (kind, offset) in enumerate(zip(self.kinds, self.offsets, strict=True), 1)
            if offset
        ]
        if moved:
            others.append(f"with other joint zeros ({', '.join(moved)})")
        turned = [str(i) for i, sign in enumerate(self.signs, 1) if sign < 0]
        if turned:
            joints = f"joint {turned[0]} counts" if len(turned) == 1 else f"joints {_and(turned)} count"
            others.append(f"where {joints} the other way")
        if not others:
            return "The same mechanism, and the same pose at every q."
        return f"The same mechanism, {', '.join(others)}."


def same_mechanism(
    answer: Chain, reference: Chain, tol: float = 1e-6, *, free: str | tuple[str, ...] | list[str] = FREEDOMS
) -> Sameness:
    """Decide whether two chains are the same mechanism.

    They are if ``T_reference(q) = G · T_answer(δ + σ q) · H`` for all q, with a base G, a tool H, joint offsets δ and
    joint senses σ = ±1, T being ``fk`` with base and tool.

    Parameters
    ----------
    answer, reference : Chain
        In either convention, of numbers only.
    tol : float
        What counts as equal: in radians for angles, relative to the reach of the reference for lengths (as they
        are, where the reference has none).
    free : sequence of {"base", "tool", "zeros", "senses"}
        What may differ: G, H, δ, σ; what is left out must be the identity, 0 or +1. Left out itself, all may.

    Returns
    -------
    Sameness
        True or false; with G, H, δ and σ, or with the first joint that fails and why.

    Raises
    ------
    DHError
        If something else than a chain is given, a chain holds symbols, `tol` is no positive number, or `free` names
        something else.

    Notes
    -----
    G, H, δ and σ are not unique. Of several the simplest is given: that in which the fewest joints count the other
    way; of these one in which no joint zero differs, if there is one; of these the first in which nothing else differs,
    only the tool, only the base, or both. What base or tool can do, no joint zero does. So a wrist joint that counts
    the other way is said to be two zeros half a turn away, which is the same; ask with ``free="senses"`` whether
    senses alone explain it.

    The axes of the answer are laid on those of the reference one by one, by rigid motions only; see
    ``dhlib.overlay``. What comes out is checked by ``fk`` at random q, so that 'same' is verified, not inferred. There
    errors of all joints add up, so up to n times `tol` passes. Chains of different ``unit`` are compared as numbers.

    Examples
    --------
    >>> from dhlib import robots
    >>> corke, craig = robots.puma560("classic", "corke"), robots.puma560("modified", "craig")
    >>> verdict = same_mechanism(craig, corke)
    >>> bool(verdict), verdict.same_zeros
    (True, False)
    >>> print(same_mechanism(robots.pa10_7c(lengths="B"), robots.pa10_7c()))
    Not the same mechanism: offset along axis 5, between the common normals with axes 4 and 6, is 0.5, expected 0.48.
    """
    _check(answer, reference, tol)
    allowed = _read_free(free)
    notes = _notes(answer, reference)
    fault = _count_fault(answer, reference)
    if fault:
        joint, reason = fault
        return _different(joint, reason, False, notes)

    pair = _Pair(answer, reference, tol)
    simplest, search = _decide(pair, allowed)
    if simplest is not None:
        return replace(simplest, notes=notes)
    mirrored, _ = _Pair(mirror_image(answer), reference, tol).search(_freedom(FREEDOMS), reference.n)
    return _different(*_why(pair, search), mirrored is not None, notes)


def mirror_image(chain: Chain) -> Chain:
    """The chain in a mirror: every θ and α the other way, every length as it is.

    The mirror is the plane of x and z. No rigid motion makes one of the other, unless the arm has a plane of symmetry.

    Parameters
    ----------
    chain : Chain

    Returns
    -------
    Chain

    Examples
    --------
    >>> from dhlib import robots
    >>> mirror_image(robots.puma560()).fk([0, 0, 0, 0, 0, 0])[:3, 3]
    array([ 0.4521 , -0.15005, -0.4318 ])
    """
    reflection = np.diag([1.0, -1.0, 1.0, 1.0])
    joints = [
        joint.replace(theta=-joint.theta, alpha=-joint.alpha, sign=-joint.sign if joint.kind == "R" else joint.sign)
        for joint in chain.joints
    ]
    base, tool = (reflection @ end @ reflection for end in (chain.base, chain.tool))
    return Chain(joints, chain.convention, base, tool, chain.name, chain.unit)


# The decision


class _Pair:
    """The two arms as lines in space, and the certificate."""

    def __init__(self, answer: Chain, reference: Chain, tol: float) -> None:
        zero = np.zeros(reference.n)
        self.answer, self.reference = answer, reference
        self.own, self.goal = near_points(answer.axes()), near_points(reference.axes())
        self.ends = (answer.fk(zero), reference.fk(zero))
        points = [axis.point for axis in (*self.own, *self.goal)] + [end[:3, 3] for end in self.ends]
        self.reach = reference.reach or 1.0
        self.rounding = 10 * ROUNDING * extent(*points)
        self.tol = Tolerance(tol, tol * self.reach + self.rounding)

    @cached_property
    def probes(self) -> FloatArray:
        """Random joint vectors, (PROBES, n); slides as long as the arm."""
        units = [1.0 if kind == "R" else self.reach / WIDEST for kind in self.reference.kinds]
        rng = np.random.default_rng(1955)
        return rng.uniform(-WIDEST, WIDEST, (PROBES, self.reference.n)) * units

    @cached_property
    def expected(self) -> FloatArray:
        """Poses of the reference there."""
        return np.asarray(self.reference.fk(self.probes))

    def search(self, free: Freedom, turned: int) -> tuple[Sameness | None, Search]:
        """A verified mapping with these freedoms and at most so many joints counting the other way."""
        found: list[Sameness] = []

        def accept(fit: Fit) -> bool:
            certificate = self.certify(fit, free)
            if certificate is not None:
                found.append(certificate)
            return bool(found)

        search = Search(self.own, self.goal, self.ends, free, turned, self.tol, accept)
        search.run()
        return (found[0] if found else None), search

    def certify(self, fit: Fit, free: Freedom) -> Sameness | None:
        """The mapping that a fit stands for, if it holds at the probes."""
        signs = np.array(fit.signs, dtype=np.float64)
        offsets = np.array([self._tidy_offset(*each) for each in zip(self.reference.kinds, fit.offsets, strict=True)])
        base = self._tidy_pose(fit.base)
        tool = np.eye(4)
        if free.tool:
            tool = self._tidy_pose(inverse(base @ self.answer.fk(offsets)) @ self.ends[1])
        poses = base @ self.answer.fk(offsets + signs * self.probes) @ tool
        missed = poses - self.expected
        turned = float(np.sqrt((missed[:, :3, :3] ** 2).sum(axis=(1, 2)).max() / 2))  # of a small angle: the angle
        moved = float(np.sqrt((missed[:, :3, 3] ** 2).sum(axis=1).max()))
        n = self.reference.n
        if turned > n * self.tol.angle or moved > n * self.tol.length:
            return None
        error = max(turned, moved / self.reach)
        return Sameness(True, base, tool, fit.signs, offsets, certificate_error=error, kinds=self.reference.kinds)

    def _tidy_offset(self, kind: str, offset: float) -> float:
        """An offset as it should be read: within half a turn, and 0 where it counts as 0."""
        if kind == "P":
            return 0.0 if abs(offset) <= self.tol.length else float(offset)
        turned = math.remainder(offset, 2 * math.pi)
        if abs(turned) <= self.tol.angle:
            return 0.0
        return math.pi if turned <= ROUNDING - math.pi else turned

    def _tidy_pose(self, pose: FloatArray) -> FloatArray:
        tidy = np.where(np.abs(pose - np.round(pose)) <= ROUNDING, np.round(pose), pose)
        tidy[:3, 3] = without_rounding(pose[:3, 3], self.reach)
        return tidy + 0.0


def _decide(pair: _Pair, allowed: Freedom) -> tuple[Sameness | None, Search]:
    """The simplest mapping within what is allowed; and the last search, which shows where there is none."""
    found, search = _simplest(pair, ENDS, allowed, 0)
    if found is not None or not (allowed.zeros or allowed.senses):
        return found, search
    found, search = pair.search(allowed, pair.reference.n if allowed.senses else 0)
    if found is None:
        return None, search
    for fewer in range(found.signs.count(-1)):
        with_fewer, _ = pair.search(allowed, fewer)
        if with_fewer is not None:
            found = with_fewer
            break
    turned = found.signs.count(-1)
    simpler, _ = _simplest(pair, (*ENDS, *ZEROS) if turned else ZEROS, allowed, turned)
    return simpler or found, search


def _simplest(
    pair: _Pair, sets: tuple[tuple[str, ...], ...], allowed: Freedom, turned: int
) -> tuple[Sameness | None, Search]:
    """The first mapping that some of these freedoms allow, with so many joints counting the other way."""
    for names in sets:
        free = _freedom(names)
        if all(may or not needed for needed, may in zip(free, allowed, strict=True)):
            found, search = pair.search(free, turned)
            if found is not None:
                break
    return found, search


def _freedom(names: Sequence[str]) -> Freedom:
    return Freedom(*(name in names for name in FREEDOMS))


# Why not, in words


def _different(joint: int | None, reason: str, mirror: bool, notes: tuple[str, ...]) -> Sameness:
    nowhere = np.full((4, 4), np.nan)
    return Sameness(False, nowhere, nowhere, (), np.zeros(0), joint, reason, mirror, notes)


def _count_fault(answer: Chain, reference: Chain) -> tuple[int | None, str] | None:
    """A different number of joints, or kind of a joint."""
    if answer.n != reference.n:
        return None, f"it has {answer.n} joint{'s' if answer.n != 1 else ''}, expected {reference.n}"
    words = {"R": "revolute", "P": "prismatic"}
    for i, (kind, expected) in enumerate(zip(answer.kinds, reference.kinds, strict=True), 1):
        if kind != expected:
            return i, f"joint {i} is {words[kind]}, expected {words[expected]}"
    return None


def _why(pair: _Pair, search: Search) -> tuple[int | None, str]:
    """The first joint that fails, and what is different there."""
    angle, length = search.misfit
    i = search.reached
    if i == pair.reference.n:
        if search.free.tool:
            return None, "each axis lies right within the tolerance, but their errors add up to more"
        turned = f"turned by {angle_text(angle)}" if angle > pair.tol.angle else ""
        moved = f"{number_text(length)} away" if length > pair.tol.length else ""
        return None, f"the axes agree, but the end is {' and '.join(filter(None, (moved, turned)))} from where expected"
    between = _difference(pair, i)
    if between:
        return i + 1, between
    missed = f"is {angle_text(angle)} off its direction" if angle else f"misses its place by {number_text(length)}"
    laid = ("", " once axis 1 is in place")[i] if i < 2 else f" once axes 1 to {i} are in place"
    return i + 1, f"axis {i + 1} {missed}{laid}"


def _difference(pair: _Pair, i: int) -> str:
    """What is different between axis i (from 0) and the one or two before: angle, distance or offset."""
    if i == 0:
        return ""
    kinds = pair.reference.kinds
    own, goal = (common_normal(axes[i - 1], axes[i]) for axes in (pair.own, pair.goal))
    if abs(own.angle - goal.angle) > pair.tol.angle:
        return _expected(f"angle between axes {i} and {i + 1}", angle_text(own.angle), angle_text(goal.angle))
    if kinds[i - 1 : i + 1] != "RR":
        return ""
    if abs(own.length - goal.length) > pair.tol.length:
        return _expected(f"distance between axes {i} and {i + 1}", number_text(own.length), number_text(goal.length))
    start = i - 1  # of the run of parallel axes that ends with axis i - 1: only their offsets together count
    while start and common_normal(pair.goal[start - 1], pair.goal[start]).angle < NEARLY_PARALLEL:
        start -= 1
    if start == 0 or "P" in kinds[start - 1 : i] or goal.angle < NEARLY_PARALLEL:
        return ""
    offsets = []
    for axes, after in ((pair.own, own), (pair.goal, goal)):
        before = common_normal(axes[start - 1], axes[start])
        offsets.append(abs(float((after.before - before.after) @ axes[start].direction)))
    if abs(offsets[0] - offsets[1]) <= pair.tol.length:
        return ""
    run = f"axis {i}" if start == i - 1 else f"axes {start + 1} to {i}"
    normals = f"common normals with axes {start} and {i + 1}"
    return _expected(f"offset along {run}, between the {normals},", *map(number_text, offsets))


def _expected(what: str, found: str, expected: str) -> str:
    return f"{what} is {found}{_EXPECTED}{expected}"


# What else is worth saying


def _notes(answer: Chain, reference: Chain) -> tuple[str, ...]:
    notes = []
    if answer.unit != reference.unit:
        notes.append(
            f"Lengths are compared as numbers, though one arm is in {answer.unit} and the other in {reference.unit}."
        )
    notes += [note for chain in (answer, reference) if (note := _nearly_parallel(chain))]
    return tuple(dict.fromkeys(notes))


def _nearly_parallel(chain: Chain) -> str:
    """A warning where axes are nearly parallel and, for that, an offset is far larger than the arm."""
    farthest = max(abs(float(joint.d)) for joint in chain.joints)
    end = chain.fk(np.zeros(chain.n))[:3, 3] - chain.base[:3, 3]
    size = math.fsum(abs(float(joint.a)) for joint in chain.joints) + float(np.linalg.norm(end))
    if farthest <= FAR * size:
        return ""
    for i, (first, second) in enumerate(pairwise(chain.axes()), 1):
        angle = common_normal(first, second).angle
        if PARALLEL < angle < NEARLY_PARALLEL:
            return (
                f"Axes {i} and {i + 1} are nearly parallel ({angle:.2g} rad), and an offset d of "
                f"{number_text(farthest)} lies far beyond the arm: there the table jumps for the least turn of an axis."
            )
    return ""


# Reading arguments


def _check(answer: Chain, reference: Chain, tol: float) -> None:
    for what, chain in (("answer", answer), ("reference", reference)):
        if not isinstance(chain, Chain):
            raise DHError(f"the {what} is {chain!r}; same_mechanism compares two Chains. See Chain.from_table.")
        if chain.is_symbolic:
            raise DHError(f"the {what} holds symbols; same_mechanism needs numbers. Give the symbols values first.")
    if not is_number(tol) or not 0 < tol < 1:
        raise DHError(f"tol is {tol!r}; it should be a number between 0 and 1, such as 1e-6.")


def _read_free(free: str | tuple[str, ...] | list[str]) -> Freedom:
    names = [free] if isinstance(free, str) else list(free)
    for name in names:
        if name not in FREEDOMS:
            raise DHError(f"free holds {name!r}; it should hold some of {', '.join(map(repr, FREEDOMS))}.")
    return _freedom(names)


def _and(words: list[str]) -> str:
    return f"{', '.join(words[:-1])} and {words[-1]}"
