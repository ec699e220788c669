"""What a figure of an arm consists of: frames, axes, normals, offsets, angles, links, as points in space.

Nothing is drawn here. `scene` turns these shapes into SVG, and `plot` into a matplotlib figure, so both show the
same thing. All points are in the world, in the chain's unit of length.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from dhlib.errors import DHError
from dhlib.scalars import FloatArray

if TYPE_CHECKING:
    from dhlib.chain import Chain

#: Relative to the size of the arm: a length below this is drawn as nothing.
NOTHING = 1e-9
#: An offset that is longer than this part of the arm has its joint's symbol in the middle.
LONG = 0.15
#: Length and radius of a joint's symbol as parts of the arm's size.
SYMBOL_LENGTH, SYMBOL_RADIUS = 0.09, 0.032


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame to draw: its pose (4, 4) and what its axes carry as index."""

    pose: FloatArray
    name: str = ""

    @property
    def origin(self) -> FloatArray:
        """The origin, (3,)."""
        return self.pose[:3, 3]

    def axis(self, letter: str) -> FloatArray:
        """Unit vector of the axis ``"x"``, ``"y"`` or ``"z"``, (3,)."""
        return self.pose[:3, "xyz".index(letter)]


@dataclass(frozen=True, eq=False)
class Segment:
    """A straight piece from `start` to `end`, with the symbol of its length."""

    start: FloatArray
    end: FloatArray
    label: str = ""

    @property
    def length(self) -> float:
        """Distance of the ends."""
        return float(np.linalg.norm(self.end - self.start))


@dataclass(frozen=True, eq=False)
class Arc:
    """An angle: a turn from the direction `start` about `axis`, by the right-hand rule."""

    centre: FloatArray
    axis: FloatArray
    start: FloatArray
    angle: float
    label: str = ""

    def points(self, radius: float) -> FloatArray:
        """Points along the arc, about one every ten degrees, (m, 3).

        Examples
        --------
        >>> import numpy as np
        >>> quarter = Arc(np.zeros(3), np.array([0, 0, 1.0]), np.array([1.0, 0, 0]), np.pi / 2)
        >>> quarter.points(2)[-1].round(12)
        array([0., 2., 0.])
        """
        turns = np.linspace(0, self.angle, max(3, int(abs(self.angle) / 0.17) + 2))[:, None]
        across = np.cross(self.axis, self.start)
        return self.centre + radius * (np.cos(turns) * self.start + np.sin(turns) * across)


@dataclass(frozen=True, eq=False)
class JointSymbol:
    """Where joint `index` is shown: a cylinder (R) or a block (P) along `axis`, joined to the arm at `foot`."""

    index: int
    kind: str
    centre: FloatArray
    axis: FloatArray
    foot: FloatArray


@dataclass(frozen=True, eq=False)
class Drawing:
    """A chain at one joint vector, as shapes in space.

    Attributes
    ----------
    frames : tuple of Frame
        0 to n.
    joints : tuple of JointSymbol
        1 to n; each axis is the joint's z axis.
    offsets : tuple of Segment
        d_1 to d_n, along the joint axes.
    normals : tuple of Segment
        The links' lengths along the common normals: a_1 to a_n of a classic, a_0 to a_{n-1} of a modified chain.
    angles, twists : tuple of Arc
        θ_i about the joint axes, and α about the common normals, in the order of the rows.
    links : tuple of ndarray (2, 3)
        The arm as straight pieces from frame 0 to the tool.
    tool : ndarray (4, 4)
    size : float
        The largest extent of the arm at this q; 1 if all origins coincide.
    """

    frames: tuple[Frame, ...]
    joints: tuple[JointSymbol, ...]
    offsets: tuple[Segment, ...]
    normals: tuple[Segment, ...]
    angles: tuple[Arc, ...]
    twists: tuple[Arc, ...]
    links: tuple[FloatArray, ...]
    tool: FloatArray
    size: float


def draw(chain: Chain, q: Any) -> Drawing:
    """Return the figure of a chain at one joint vector, as shapes in space.

    Parameters
    ----------
    chain : Chain
    q : array_like (n,)

    Returns
    -------
    Drawing

    Raises
    ------
    DHError
        If the chain or q holds symbols, q is not one joint vector, or does not fit the chain.

    Examples
    --------
    >>> from dhlib import robots
    >>> figure = draw(robots.quickshot(), [0, 0, 0, 0])
    >>> figure.normals[0].label, figure.normals[0].end
    ('a_1', array([ 20.,   0., 100.]))
    """
    poses = chain.frames(q)
    if isinstance(poses, list):
        raise DHError("a drawing needs numbers; this chain or q holds symbols. Give them values first.")
    if poses.ndim != 3:
        raise DHError(f"a drawing shows one joint vector; q has shape {np.shape(q)}. Draw q[0], say.")
    tool = np.asarray(poses[-1] @ chain.tool, dtype=np.float64)
    frames = tuple(Frame(pose, str(i)) for i, pose in enumerate(poses))
    offsets: list[Segment] = []
    normals: list[Segment] = []
    angles: list[Arc] = []
    twists: list[Arc] = []
    axes: list[FloatArray] = []
    for i, (joint, value) in enumerate(zip(chain.joints, q, strict=True), 1):
        before, after = frames[i - 1], frames[i]
        theta, d = (float(part) for part in joint.at(value))
        a, alpha = float(joint.a), float(joint.alpha)
        if chain.convention == "classic":
            z, x = before.axis("z"), after.axis("x")
            foot = before.origin + d * z
            offsets.append(Segment(before.origin, foot, f"d_{i}"))
            normals.append(Segment(foot, after.origin, f"a_{i}"))
            angles.append(Arc(foot, z, before.axis("x"), theta, f"θ_{i}"))
            twists.append(Arc(after.origin, x, z, alpha, f"α_{i}"))
        else:
            z, x = after.axis("z"), before.axis("x")
            foot = before.origin + a * x
            normals.append(Segment(before.origin, foot, f"a_{i - 1}"))
            offsets.append(Segment(foot, after.origin, f"d_{i}"))
            twists.append(Arc(foot, x, before.axis("z"), alpha, f"α_{i - 1}"))
            angles.append(Arc(after.origin, z, x, theta, f"θ_{i}"))
        axes.append(z)
    size = _size([frame.origin for frame in frames] + [tool[:3, 3]] + [segment.start for segment in normals])
    first, second = (offsets, normals) if chain.convention == "classic" else (normals, offsets)
    corners = [frames[0].origin]
    for one, other in zip(first, second, strict=True):
        corners += [one.end, other.end]
    corners.append(tool[:3, 3])
    links = tuple(np.stack(ends) for ends in pairwise(corners) if np.linalg.norm(ends[1] - ends[0]) > NOTHING * size)
    joints = _place_symbols(chain.kinds, offsets, axes, size)
    return Drawing(frames, joints, tuple(offsets), tuple(normals), tuple(angles), tuple(twists), links, tool, size)


def _size(points: Sequence[FloatArray]) -> float:
    extent = float(np.ptp(np.array(points), axis=0).max())
    return extent if extent > 0 else 1.0


def _place_symbols(
    kinds: str, offsets: Sequence[Segment], axes: Sequence[FloatArray], size: float
) -> tuple[JointSymbol, ...]:
    """Put each joint's symbol somewhere on its axis, no two on top of one another.

    Any point of the axis is right. A long offset carries it in its middle; else it stands where the offset ends,
    and gives way to its neighbours along its axis: the first joints towards the base, the last towards the tool.
    """
    n = len(kinds)
    step = 1.25 * SYMBOL_LENGTH * size
    placed: dict[int, FloatArray] = {}
    for i in sorted(range(n), key=lambda i: (offsets[i].length <= LONG * size, abs(i - (n - 1) / 2))):
        home = (offsets[i].start + offsets[i].end) / 2 if offsets[i].length > LONG * size else offsets[i].end
        onward = 1 if 2 * i >= n else -1
        places = [home + slide * step * axes[i] for slide in (0, onward, -onward, 2 * onward, -2 * onward)]
        free = [
            place for place in places if all(np.linalg.norm(place - other) > 0.9 * step for other in placed.values())
        ]
        placed[i] = free[0] if free else home
    return tuple(JointSymbol(i + 1, kinds[i], placed[i], axes[i], offsets[i].end) for i in range(n))
