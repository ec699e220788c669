"""The common normal of two lines in space: what link length and link twist are measured on.

How many common normals there are depends on how the lines lie: one where they are skew or intersect, a whole
family where they are parallel, every line across them where they coincide.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from dhlib.axes import Axis
from dhlib.scalars import FloatArray

#: Lines at a smaller angle, in radians, count as parallel. It is the square root of the machine precision ε: at an
#: angle β, taking them as parallel is wrong by β, and the foot of their normal, about 1/β away, by ε/β.
PARALLEL = 1.5e-8
#: Below this angle, in radians, a common normal moves far for a small turn of an axis.
NEARLY_PARALLEL = 1e-3
#: What is this small beside its surroundings is rounding, and is taken as 0.
ROUNDING = 1e-13


@dataclass(frozen=True, eq=False)
class Normal:
    """A common normal of two lines.

    Attributes
    ----------
    kind : {"skew", "intersecting", "parallel", "antiparallel", "coincident"}
        How the lines lie. Coincident lines may point either way.
    x : ndarray (3,)
        Unit vector along the normal.
    before, after : ndarray (3,)
        Its feet on the first and on the second line.
    angle : float
        Angle between the lines in radians, from 0 to π/2: their sense does not count.
    """

    kind: str
    x: FloatArray
    before: FloatArray
    after: FloatArray
    angle: float

    @property
    def length(self) -> float:
        """Distance of the lines."""
        return float(np.linalg.norm(self.after - self.before))

    def towards(self, x: FloatArray) -> Normal:
        """The same normal, its x reversed if that is nearer to the given direction."""
        return replace(self, x=-self.x + 0.0) if self.x @ x < -ROUNDING else self


def foot(line: Axis, point: FloatArray) -> FloatArray:
    """The point of a line that is nearest to a given point, (3,).

    Examples
    --------
    >>> import numpy as np
    >>> foot(Axis([1, 0, 0], [0, 0, 1]), np.array([5.0, 5.0, 5.0]))
    array([1., 0., 5.])
    """
    return line.point + ((point - line.point) @ line.direction) * line.direction


def across(direction: FloatArray) -> FloatArray:
    """A unit vector across a direction: the world's x axis as far as it can be, or y where x is too near.

    Examples
    --------
    >>> import numpy as np
    >>> across(np.array([0.0, 0.0, 1.0])), across(np.array([-1.0, 0.0, 0.0]))
    (array([1., 0., 0.]), array([0., 1., 0.]))
    """
    for axis in np.eye(3)[:2]:
        rest = axis - (axis @ direction) * direction
        length = float(np.linalg.norm(rest))
        if length > 0.1:
            return np.asarray(rest / length)
    raise AssertionError("no direction is within six degrees of both x and y")


def extent(*points: FloatArray) -> float:
    """The largest coordinate of some points: rounding is measured against it."""
    return max(float(np.abs(point).max()) for point in points)


def common_normal(first: Axis, second: Axis, size: float | None = None) -> Normal:
    """The common normal of two lines, and how they lie.

    Parameters
    ----------
    first, second : Axis
    size : float, optional
        The largest coordinate in play; distances below 1e-13 of it count as 0. The default is that of the two
        points.

    Returns
    -------
    Normal
        Skew and parallel lines: x points from the first line to the second. Intersecting lines: x is the first
        direction × the second. Where there are many normals, one of them: for parallel lines that through the
        point of the first, for coincident ones with some x across them.

    Examples
    --------
    >>> normal = common_normal(Axis([0, 0, 5], [0, 0, 1]), Axis([3, 0, 0], [0, 1, 0]))
    >>> normal.kind, normal.x, normal.length
    ('skew', array([1., 0., 0.]), 3.0)
    >>> common_normal(Axis([0, 0, 5], [0, 0, 1]), Axis([3, 0, 0], [0, 0, -1])).kind
    'antiparallel'
    """
    size = extent(first.point, second.point) if size is None else size
    between = second.point - first.point
    turn = cross(first.direction, second.direction)
    sine, cosine = float(np.linalg.norm(turn)), float(first.direction @ second.direction)
    angle = float(np.arctan2(sine, abs(cosine)))

    if angle < PARALLEL:
        before = first.point
        after = foot(second, before)
        gap = after - before
        distance = float(np.linalg.norm(gap))
        if distance <= ROUNDING * size:
            return Normal("coincident", across(first.direction), before, before, angle)
        return Normal("parallel" if cosine > 0 else "antiparallel", gap / distance, before, after, angle)

    x = turn / sine
    before = first.point + (cross(between, second.direction) @ turn) / sine**2 * first.direction
    before = without_rounding(before, size)
    if abs(between @ turn) <= ROUNDING * size:
        return Normal("intersecting", x, before, before, angle)
    after = without_rounding(foot(second, before), size)
    return Normal("skew", x if between @ turn > 0 else -x + 0.0, before, after, angle)


def cross(u: FloatArray, v: FloatArray) -> FloatArray:
    """The vector product; for two single vectors much quicker than numpy's."""
    (a, b, c), (d, e, f) = u.tolist(), v.tolist()
    return np.array([b * f - c * e, c * d - a * f, a * e - b * d])


def without_rounding(vector: FloatArray, size: float) -> FloatArray:
    """The vector with 0 for every entry that is rounding beside `size`.

    Examples
    --------
    >>> import numpy as np
    >>> without_rounding(np.array([1e-17, 2.0, -3.0]), size=1.0)
    array([ 0.,  2., -3.])
    """
    return np.where(np.abs(vector) <= ROUNDING * size, 0.0, vector)
