"""Laying the axes of one arm on those of another, one joint after the other.

An arm is put to its joint zeros, a stack of lines in space, and every line carries what stands behind it. We may
move the base, and with it everything; or turn (slide) joint j, and with it everything behind line j. So after each
line that was laid on its counterpart some freedom is left: a spin about one line, slides along some directions.
Each freedom is booked to whom it belongs, the base or a joint, and is spent on the lines that follow.

===============  ==============================  ====================  ==========  ============================
before line i    revolute, not parallel          revolute, parallel    coincident  prismatic
===============  ==============================  ====================  ==========  ============================
nothing laid     line on line                    –                     –           align; it may stand anywhere
a spin,          angle equal: turn; gap within   distance equal: turn  nothing     angle equal: turn;
slides V         V: slide; V ∩ line stays free   V stays free                      V and its direction are free
no spin,         direction equal; gap within     as before             as before   direction equal;
slides V         V: slide; V ∩ line stays free                                     V and its direction are free
===============  ==============================  ====================  ==========  ============================

Behind a revolute joint there is a spin again.
Only rigid motions are used, so a mirror image does not fit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from dhlib.axes import Axis
from dhlib.normals import PARALLEL, cross, foot
from dhlib.scalars import FloatArray

BASE = -1
"""Whom a spin belongs to, where it is no joint."""

SMALL = 4.0
"""A slant of this many tolerances may be an error."""


class Tolerance(NamedTuple):
    """What counts as equal: radians, and lengths in the unit of the arm."""

    angle: float
    length: float


class Misfit(NamedTuple):
    """Why a line cannot be laid: it misses its direction by an angle, or else its place by a length."""

    angle: float
    length: float


class Freedom(NamedTuple):
    """What may be changed to lay one arm on another."""

    base: bool
    tool: bool
    zeros: bool
    senses: bool


class Spin(NamedTuple):
    """A line about which everything behind it may still be turned; ``sense`` is that of its joint."""

    line: Axis
    owner: int
    sense: int


class Fit(NamedTuple):
    """Base, joint senses and joint offsets that lay all axes."""

    base: FloatArray
    signs: tuple[int, ...]
    offsets: FloatArray


@dataclass(frozen=True, eq=False)
class Overlay:
    """How the links up to the present one are laid, and what freedom is left.

    Attributes
    ----------
    tol : Tolerance
    free_zeros : bool
        Whether the joints may be turned and slid; if not, only the base gives freedom.
    carried : ndarray (4, 4)
        The rigid motion that carries the present link, at the joint zeros, to where it is laid.
    base : ndarray (4, 4)
        That of the base.
    offsets : ndarray (n,)
        By how much the joints are turned or slid for it.
    loose : bool
        Whether nothing is laid yet and the base is free.
    spin : Spin or None
    slides : ndarray (3, k)
        Orthonormal directions in which the present link may still be shifted.
    booked : ndarray (3 + n, k)
        For each of them the shift of the base, and of each joint, that makes it.
    """

    tol: Tolerance
    free_zeros: bool
    carried: FloatArray
    base: FloatArray
    offsets: FloatArray
    loose: bool
    spin: Spin | None
    slides: FloatArray
    booked: FloatArray

    @classmethod
    def begin(cls, n: int, free: Freedom, tol: Tolerance) -> Overlay:
        """Nothing laid yet."""
        nothing = np.zeros((3 + n, 0))
        return cls(tol, free.zeros, np.eye(4), np.eye(4), np.zeros(n), free.base, None, nothing[:3], nothing)

    def lay(self, i: int, own: Axis, goal: Axis, sense: int) -> Iterator[Overlay | Misfit]:
        """Lay line i on its counterpart, pointing the same (1) or the opposite way (-1).

        There is more than one way where the line is parallel to that of the spin within the tolerance, but not
        exactly: its small slant may be meant, or may be an error.
        """
        if self.loose:
            yield self._first(own, goal, sense)
            return
        if self.spin is None:
            yield self._in_place(i, own, goal, sense)
            return
        heading = sense * (self.carried[:3, :3] @ own.direction)
        pole = self.spin.line.direction
        swing, wanted = cross(pole, heading), cross(pole, goal.direction)
        own_sine, sine = _length(swing), _length(wanted)
        off = abs(math.atan2(own_sine, pole @ heading) - math.atan2(sine, pole @ goal.direction))
        if off > self.tol.angle:
            yield Misfit(off, 0.0)
            return
        slant = max(own_sine, sine)
        if slant > PARALLEL:
            yield self._turned(_turn(swing, wanted, pole))._without_spin()._in_place(i, own, goal, sense)
        if slant <= max(PARALLEL, SMALL * self.tol.angle):
            yield self._with_slide(i, goal, sense) if goal.kind == "P" else self._parallel(i, own, goal, sense)

    def finish(self, own_end: FloatArray, goal_end: FloatArray) -> Overlay:
        """Spend what freedom is left on bringing the ends together, as well as can be."""
        laid = self
        if self.spin is not None:
            pole = self.spin.line.direction
            missing = goal_end[:3, :3] @ (self.carried[:3, :3] @ own_end[:3, :3]).T
            axial = _axial(missing)
            laid = self._turned(math.atan2(pole @ axial, np.trace(missing) - pole @ missing @ pole))
        gap = goal_end[:3, 3] - (laid.carried @ own_end)[:3, 3]
        return laid._shifted(laid.slides.T @ gap)

    def misfit(self, own_end: FloatArray, goal_end: FloatArray) -> Misfit:
        """By what the ends miss one another, as they are laid."""
        laid = self.carried @ own_end
        missing = goal_end[:3, :3] @ laid[:3, :3].T
        axial = _axial(missing)
        return Misfit(math.atan2(_length(axial), np.trace(missing) - 1), _length(goal_end[:3, 3] - laid[:3, 3]))

    # The cases

    def _first(self, own: Axis, goal: Axis, sense: int) -> Overlay:
        """The base takes the first line to its place by the smallest motion, and keeps what leaves it there."""
        motion = _shortest_turn(sense * own.direction, goal.direction)
        n = len(self.offsets)
        directions = np.eye(3) if goal.kind == "P" else goal.direction[:, None]
        if goal.kind == "R":
            carried = motion[:3, :3] @ own.point
            motion[:3, 3] = goal.point - foot(Axis(carried, goal.direction), goal.point)
        return replace(
            self,
            carried=motion,
            base=motion,
            loose=False,
            spin=Spin(Axis(goal.point, goal.direction), BASE, 1),
            slides=directions,
            booked=np.vstack([directions, np.zeros((n, directions.shape[1]))]),
        )

    def _parallel(self, i: int, own: Axis, goal: Axis, sense: int) -> Overlay | Misfit:
        """A revolute line along the line about which we may spin."""
        assert self.spin is not None
        centre = self.spin.line
        own_arm = -self._gap(own, centre.point)
        arm = foot(goal, centre.point) - centre.point
        if self.slides.shape[1] == 3:  # only prismatic joints before: they may stand anywhere
            moved = self._shifted(self.slides.T @ (arm - own_arm))
            return replace(moved._only_along(goal.direction), spin=self.spin._replace(line=goal))
        own_distance, distance = _length(own_arm), _length(arm)
        if abs(own_distance - distance) > self.tol.length:
            return Misfit(0.0, abs(own_distance - distance))
        if max(own_distance, distance) <= self.tol.length:
            return self  # coincident: two joints that do the same
        return self._turned(_turn(own_arm, arm, centre.direction))._with_spin(i, goal, sense)

    def _in_place(self, i: int, own: Axis, goal: Axis, sense: int) -> Overlay | Misfit:
        """A line whose direction cannot be turned any more."""
        off = _angle(sense * (self.carried[:3, :3] @ own.direction), goal.direction)
        if off > self.tol.angle:
            return Misfit(off, 0.0)
        if goal.kind == "P":
            return self._with_slide(i, goal, sense)
        gap = self._gap(own, goal.point)
        laid = self
        if self.slides.shape[1]:
            u = goal.direction
            across = self.slides - np.outer(u, u @ self.slides)
            amounts = _solve(across, gap, self.tol.angle)
            gap = gap - across @ amounts
            laid = self._shifted(amounts)._only_along(u)
        missed = _length(gap)
        return Misfit(0.0, missed) if missed > self.tol.length else laid._with_spin(i, goal, sense)

    def _gap(self, own: Axis, point: FloatArray) -> FloatArray:
        """From our line, as it is laid now, across to a point."""
        carried = self.carried[:3, :3] @ own.point + self.carried[:3, 3]
        gap = point - carried
        along = self.carried[:3, :3] @ own.direction
        return gap - (gap @ along) * along

    # Freedom: spent, gained and lost

    def _turned(self, angle: float) -> Overlay:
        assert self.spin is not None
        motion = self.spin.line.motion(angle)
        if self.spin.owner == BASE:
            return replace(self, carried=motion @ self.carried, base=motion @ self.base)
        offsets = self.offsets.copy()
        offsets[self.spin.owner] += self.spin.sense * angle
        return replace(self, carried=motion @ self.carried, offsets=offsets)

    def _shifted(self, amounts: FloatArray) -> Overlay:
        carried, base = self.carried.copy(), self.base.copy()
        spent = self.booked @ amounts
        carried[:3, 3] += self.slides @ amounts
        base[:3, 3] += spent[:3]
        return replace(self, carried=carried, base=base, offsets=self.offsets + spent[3:])

    def _without_spin(self) -> Overlay:
        return replace(self, spin=None)

    def _with_spin(self, i: int, goal: Axis, sense: int) -> Overlay:
        return replace(self, spin=Spin(goal, i, sense) if self.free_zeros else None)

    def _with_slide(self, i: int, goal: Axis, sense: int) -> Overlay:
        """A prismatic joint shifts all that follows along its direction, unless that is free already."""
        inside = self.slides.T @ goal.direction
        rest = goal.direction - self.slides @ inside
        length = _length(rest)
        if not self.free_zeros or length <= self.tol.angle:
            return self
        booking = -self.booked @ inside
        booking[3 + i] += sense
        return replace(
            self,
            slides=np.column_stack([self.slides, rest / length]),
            booked=np.column_stack([self.booked, booking / length]),
        )

    def _only_along(self, direction: FloatArray) -> Overlay:
        """Keep of the slides those that move a line in itself."""
        inside = self.slides.T @ direction
        if _length(direction - self.slides @ inside) > self.tol.angle:
            return replace(self, slides=self.slides[:, :0], booked=self.booked[:, :0])
        inside = inside / _length(inside)
        return replace(self, slides=(self.slides @ inside)[:, None], booked=(self.booked @ inside)[:, None])


class Search:
    """Look, depth first over the senses of the joints, for a way to lay all lines.

    Parameters
    ----------
    own, goal : sequence of Axis
        At the joint zeros. Joint by joint of the same kind.
    ends : pair of ndarray (4, 4)
        Poses of the two ends at the joint zeros, our own first.
    free : Freedom
        Of base, tool and zeros.
    turned : int
        How many joints may count the other way.
    tol : Tolerance
    accept : callable
        Is asked of each fit; the search ends with the first that it accepts.

    Attributes
    ----------
    reached : int
        Number (from 0) of the first line that could not be laid, on the way that led furthest; n, if all lines
        could be laid and no fit was accepted.
    misfit : Misfit
        By how much that line, or the end, is off.
    """

    def __init__(
        self,
        own: Sequence[Axis],
        goal: Sequence[Axis],
        ends: tuple[FloatArray, FloatArray],
        free: Freedom,
        turned: int,
        tol: Tolerance,
        accept: Callable[[Fit], bool],
    ) -> None:
        self.own, self.goal = own, goal
        self.ends = ends
        self.free, self.turned, self.tol, self.accept = free, turned, tol, accept
        self.reached = -1
        self.misfit = Misfit(math.inf, math.inf)

    def run(self) -> Fit | None:
        """The first fit that is accepted, or None."""
        return self._from(Overlay.begin(len(self.own), self.free, self.tol), ())

    def _from(self, laid: Overlay, signs: tuple[int, ...]) -> Fit | None:
        i = len(signs)
        if i == len(self.own):
            if not self.free.tool:
                laid = laid.finish(*self.ends)
            fit = Fit(laid.base, signs, laid.offsets)
            if self.accept(fit):
                return fit
            self._note(i, laid.misfit(*self.ends))
            return None
        for sense in (1, -1) if signs.count(-1) < self.turned else (1,):
            for after in laid.lay(i, self.own[i], self.goal[i], sense):
                if isinstance(after, Misfit):
                    self._note(i, after)
                    continue
                found = self._from(after, (*signs, sense))
                if found is not None:
                    return found
        return None

    def _note(self, i: int, misfit: Misfit) -> None:
        if i > self.reached or (i == self.reached and misfit < self.misfit):
            self.reached, self.misfit = i, misfit


def near_points(axes: Sequence[Axis]) -> list[Axis]:
    """The same lines, each with a point near to the line before: the feet of a table may be far away."""
    moved: list[Axis] = []
    for axis in axes:
        point = foot(axis, moved[-1].point) if moved else axis.point
        moved.append(Axis(point, axis.direction, axis.kind))
    return moved


def _length(vector: FloatArray) -> float:
    return math.sqrt(float(vector @ vector))


def _angle(u: FloatArray, v: FloatArray) -> float:
    return math.atan2(_length(cross(u, v)), float(u @ v))


def _turn(start: FloatArray, stop: FloatArray, pole: FloatArray) -> float:
    """The angle about the pole from one vector across it to another."""
    return math.atan2(float(pole @ cross(start, stop)), float(start @ stop))


def _axial(rotation: FloatArray) -> FloatArray:
    """2 sin φ times the axis of a rotation by φ."""
    return rotation[[2, 0, 1], [1, 2, 0]] - rotation[[1, 2, 0], [2, 0, 1]]


def _solve(columns: FloatArray, vector: FloatArray, negligible: float) -> FloatArray:
    """The smallest amounts of the columns that come nearest to a vector; directions below a bound are left alone."""
    left, sizes, right = np.linalg.svd(columns, full_matrices=False)
    inverted = np.divide(1.0, sizes, out=np.zeros_like(sizes), where=sizes > negligible)
    return np.asarray(right.T @ (inverted * (left.T @ vector)))


def _shortest_turn(start: FloatArray, stop: FloatArray) -> FloatArray:
    """The smallest rotation, (4, 4), that takes one unit vector to another."""
    normal = cross(start, stop)
    sine = _length(normal)
    angle = math.atan2(sine, float(start @ stop))
    if sine < 1e-9:
        if angle < 1:
            return np.eye(4)
        normal = cross(start, np.eye(3)[int(np.argmin(np.abs(start)))])
    return Axis(np.zeros(3), normal).motion(angle)
