"""Joint axes as lines in space: what is physical about an arm, whatever its table."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from dhlib.errors import DHError
from dhlib.scalars import FloatArray, read_array


@dataclass(frozen=True, eq=False)
class Axis:
    """The axis of a joint: a line in the world.

    Parameters
    ----------
    point : array_like (3,)
        Any point on the line.
    direction : array_like (3,)
        Where the joint slides, or about what it turns by the right-hand rule, for growing q. Its length does
        not matter; it is stored as a unit vector.
    kind : {"R", "P"}
        Revolute or prismatic. Of a prismatic axis only the direction is physical.

    Raises
    ------
    DHError
        If point or direction are not three finite numbers, the direction is zero, or the kind unknown.

    Examples
    --------
    >>> Axis([0, 0, 1], [0, 2, 0], "R").direction
    array([0., 1., 0.])
    """

    point: FloatArray
    direction: FloatArray
    kind: str = "R"

    def __post_init__(self) -> None:
        point = read_array(self.point, "the point of an axis")
        direction = read_array(self.direction, "the direction of an axis")
        for name, vector in (("point", point), ("direction", direction)):
            if vector.shape != (3,):
                raise DHError(f"the {name} of an axis has shape {vector.shape}; it should be three numbers.")
        length = float(np.linalg.norm(direction))
        if length < 1e-12:
            raise DHError("the direction of an axis is (0, 0, 0); it should point along the axis.")
        if self.kind not in ("R", "P"):
            raise DHError(f"the kind of an axis is {self.kind!r}; it should be 'R' (revolute) or 'P' (prismatic).")
        object.__setattr__(self, "point", point)
        object.__setattr__(self, "direction", direction / length)

    def motion(self, q: float) -> FloatArray:
        """The rigid motion of everything behind this joint when it moves by q, (4, 4).

        A turn by q about the line (Rodrigues' formula), or a slide by q along it.

        Examples
        --------
        >>> import numpy as np
        >>> Axis([1, 0, 0], [0, 0, 1], "R").motion(np.pi / 2)[:3, 3].round(12)
        array([ 1., -1.,  0.])
        """
        motion = np.eye(4)
        if self.kind == "P":
            motion[:3, 3] = q * self.direction
            return motion
        x, y, z = self.direction
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        motion[:3, :3] += np.sin(q) * cross + (1 - np.cos(q)) * cross @ cross
        motion[:3, 3] = self.point - motion[:3, :3] @ self.point
        return motion


def product_of_exponentials(axes: list[Axis], end: Any, q: Any) -> FloatArray:
    """Pose of the end when every joint moves its part of the arm, (4, 4).

    Parameters
    ----------
    axes : list of Axis
        At q = 0, from the base on.
    end : array_like (4, 4)
        Pose of the end at q = 0.
    q : array_like (n,)

    Notes
    -----
    R. W. Brockett, 1984; K. M. Lynch and F. C. Park, *Modern Robotics*, 2017, chapter 4.

    Examples
    --------
    >>> from dhlib import robots
    >>> arm = robots.quickshot()
    >>> q = [0.3, 0.5, 0.7, 0.2]
    >>> end = product_of_exponentials(arm.axes(), arm.fk([0, 0, 0, 0]), q)
    >>> bool(abs(end - arm.fk(q)).max() < 1e-12)
    True
    """
    pose = np.asarray(end, dtype=np.float64)
    for axis, value in zip(reversed(axes), reversed(list(q)), strict=True):
        pose = axis.motion(float(value)) @ pose
    return pose
