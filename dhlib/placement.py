"""Placing frames: from joint axes in space to a DH table, in the seven steps of the book.

Both conventions draw the same common normals, X_i between axis i and axis i+1; they differ in the end of the
normal on which frame i sits. The classic convention puts it on axis i+1, the modified one on axis i.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from dhlib.axes import Axis
from dhlib.chain import Chain
from dhlib.conventions import read_convention
from dhlib.errors import DHError, DHWarning
from dhlib.joints import Joint, Prismatic, Revolute
from dhlib.normals import (
    NEARLY_PARALLEL,
    ROUNDING,
    Normal,
    across,
    common_normal,
    cross,
    extent,
    foot,
    without_rounding,
)
from dhlib.preconditions import deviation, deviation_from_axis, fault_sentences, read_axes, read_numeric_pose
from dhlib.scalars import QUARTER, FloatArray
from dhlib.show import angle_text
from dhlib.transforms import inverse

#: How well a base or tool that was asked for must fit, in radians and relative to the size of the arm.
FIT = 1e-9


@dataclass(frozen=True)
class Choice:
    """Something that the rules left open, and what was chosen.

    Attributes
    ----------
    kind : str
        Why there was a choice: "first frame", "last frame", "intersecting", "parallel", "antiparallel",
        "coincident" or "prismatic". "nearly parallel" is a warning.
    number : int
        Of the frame, of the prismatic axis, or of the first of the two axes.
    sentence : str
    """

    kind: str
    number: int
    sentence: str

    def __str__(self) -> str:
        return self.sentence


class Placement(NamedTuple):
    """What :func:`place_frames` returns.

    Attributes
    ----------
    chain : Chain
    choices : list of Choice
        From the base on.
    """

    chain: Chain
    choices: list[Choice]


def place_frames(
    axes: Sequence[Axis],
    convention: str = "classic",
    *,
    end: Any = None,
    tool: Any = None,
    base: Any = None,
    name: str = "",
    unit: str = "m",
) -> Placement:
    """Place DH frames on joint axes, and read off the table.

    Parameters
    ----------
    axes : sequence of Axis
        The n joint axes in the world at q = 0, from the base on; each points where its joint turns or slides for
        growing q.
    convention : {"classic", "modified"}
    end : array_like (4, 4), optional
        Pose of the end in the world at q = 0. Frame n is laid so that the tool is the identity if the rules
        allow; otherwise the tool is what is missing. Left out, the end is frame n, and frame n is frame n-1 moved
        by joint n alone.
    tool : array_like (4, 4), optional
        Pose of the end in frame n. With `end`, it fixes frame n. Alone, it is put behind frame n.
    base : array_like (4, 4), optional
        Pose of frame 0 in the world. Left out, frame 0 is, classic, as near to the world's frame as axis 1
        allows and, modified, frame 1 at q = 0.
    name, unit : str, optional
        As for :class:`Chain`.

    Returns
    -------
    Placement
        The chain, and the choices that were free: ``chain, choices = place_frames(…)``. For all q,
        ``chain.fk(q)`` is the product of exponentials of the axes, times `end`.

    Raises
    ------
    DHError
        If there is no axis, something is no axis or no pose, or a base or tool was asked for that no DH table
        can have on these axes; the message says which condition fails, and by how much.

    Warns
    -----
    DHWarning
        If neighbouring axes are parallel to a milliradian but not to 1.5e-8 rad: their common normal, and with it
        d, jumps for a small turn. Below 1.5e-8 rad they count as parallel.

    Notes
    -----
    J. Denavit and R. S. Hartenberg, 1955. Frame 0 of the modified convention: J. J. Craig, *Introduction to
    Robotics: Mechanics and Control*, 1986, section 3.4.

    Where the rules leave a choice: intersecting axes have x along ± the product of the two z, whichever turns
    less against the x before, and the product itself where both turn as much; parallel axes get the normal with
    d = 0; coincident ones keep the x before; a prismatic axis stays where it was given, though only its direction
    counts; skew axes have a > 0.

    Examples
    --------
    >>> from dhlib import Axis
    >>> chain, choices = place_frames([Axis([0, 0, 0], [0, 0, 1]), Axis([20, 0, 100], [0, 1, 0])], unit="mm")
    >>> print(chain)
    classic DH table, lengths in mm
     i | θ_i | d_i | a_i |  α_i
     1 |  q1 | 100 |  20 | -90°
     2 |  q2 |   0 |   0 |   0°
    >>> print(choices[-1])
    Frame 2: nothing follows axis 2, so z_2, x_2 and O_2 are free. Frame 2 is frame 1 at q = 0.
    """
    # Step 1: number the axes.
    axes = read_axes(axes)
    if not axes:
        raise DHError("place_frames needs at least one axis; axes is empty.")
    n = len(axes)
    convention = read_convention(convention)
    base, tool, end = (
        None if pose is None else read_numeric_pose(pose, what)
        for pose, what in ((base, "base"), (tool, "tool"), (end, "end"))
    )
    wanted = end if end is None or tool is None else end @ inverse(tool)  # frame n, if that can be
    size = extent(*(axis.point for axis in axes), *(pose[:3, 3] for pose in (base, wanted) if pose is not None))

    # Step 2: z along the axes; before the first and behind the last that of base and end, where they are given.
    first = axes[0] if base is None else _z_line(base)
    last = axes[-1] if wanted is None else _z_line(wanted)
    lines = [*axes, last] if convention == "classic" else [first, *axes]

    # Step 3: the common normal of each axis and the next, and what the rules leave open there.
    normals, choices = _draw_normals(axes, first, last, convention, base, wanted, size)
    choices += [_prismatic_choice(i) for i, axis in enumerate(axes, 1) if axis.kind == "P"]

    # Steps 4 to 6: x along the normal, the origin at its foot, y completes.
    feet = [normal.after if convention == "classic" else normal.before for normal in normals]
    frames = [
        _frame(line.direction, normal.x, without_rounding(origin, size))
        for line, normal, origin in zip(lines, normals, feet, strict=True)
    ]
    if base is not None:
        _check_base(base, frames, axes[0], convention, size)
        frames[0] = base
    if wanted is not None and tool is not None:
        _check_last(wanted, frames, axes[-1], convention, size)
        frames[n] = wanted

    # Step 7: read off the four parameters.
    joints = [
        _joint(axis, *read_parameters(before, frame, convention))
        for axis, (before, frame) in zip(axes, pairwise(frames), strict=True)
    ]
    if end is None or tool is None:
        tool = tool if end is None else _tidy(inverse(frames[n]) @ end, size)
        choices.append(_last_choice(n, convention, None if end is None else tool))
    choices.sort(key=lambda choice: choice.number)
    return Placement(Chain(joints, convention, frames[0], tool, name, unit), choices)


def read_parameters(before: Any, frame: Any, convention: str = "classic") -> tuple[float, float, float, float]:
    """The four parameters that lead from one frame to the next.

    Parameters
    ----------
    before, frame : array_like (4, 4)
        Frame i-1 and frame i, seen from the same frame.
    convention : {"classic", "modified"}

    Returns
    -------
    theta, d, a, alpha : float
        Angles in (-π, π], quarter turns exact. Classic: θ_i, d_i, a_i, α_i. Modified: θ_i, d_i, a_{i-1}, α_{i-1}.

    Raises
    ------
    DHError
        If a frame is no pose, or the two do not obey DH1 and DH2 to one part in a million: then no four
        parameters lead from one to the other.

    Examples
    --------
    >>> import numpy as np
    >>> from dhlib import classic
    >>> read_parameters(np.eye(4), classic(0, 100, 20, -1.5))
    (0.0, 100.0, 20.0, -1.5)
    """
    convention = read_convention(convention)
    before, frame = read_numeric_pose(before, "the frame before"), read_numeric_pose(frame, "the frame")
    link = inverse(before) @ frame
    size = extent(before[:3, 3], frame[:3, 3])
    angle, distance = deviation(before, frame, convention)
    allowed = 1e-6 * float(np.linalg.norm(link[:3, 3])) + ROUNDING * size
    if angle > 1e-6 or distance > allowed:
        faults = fault_sentences(1, angle if angle > 1e-6 else 0, distance if distance > allowed else 0, convention)
        raise DHError(
            f"no four {convention} parameters lead from one frame to the other. "
            f"With the two called 0 and 1: {'; '.join(faults)}."
        )

    (nx, ox, _, px), (ny, _, ay, py), (_, oz, az, pz) = link[:3].tolist()
    if convention == "classic":  # the third row of A is (0, sin α, cos α, d), the first column (cos θ, sin θ, 0)
        theta, alpha = _angle(ny, nx), _angle(oz, az)
        d, a = pz, nx * px + ny * py
    else:  # the first row of A is (cos θ, -sin θ, 0, a), the third column (0, -sin α, cos α)
        theta, alpha = _angle(-ox, nx), _angle(-ay, az)
        d, a = ay * py + az * pz, px
    return theta, _length(d, size), _length(a, size), alpha


# Step 3: the common normals


def _draw_normals(
    axes: list[Axis],
    first: Axis,
    last: Axis,
    convention: str,
    base: FloatArray | None,
    wanted: FloatArray | None,
    size: float,
) -> tuple[list[Normal], list[Choice]]:
    """X_0, X_1, …, X_n: between the base and axis 1, each axis and the next, axis n and the end."""
    n = len(axes)
    choices: list[Choice] = []
    if base is not None:
        start = _at(base[:3, 0], base[:3, 3])
        before_first = start if convention == "classic" else _between(first, axes[0], start, size).towards(start.x)
    else:
        before_first = start = _at(across(axes[0].direction), foot(axes[0], np.zeros(3)))
        choices.append(_first_choice(convention))

    normals = [before_first]
    for i in range(1, n):
        normal = _between(axes[i - 1], axes[i], normals[-1], size)
        x_before_is_free = i == 1 and convention == "modified" and base is None
        choices += _normal_choices(i, normal, None if x_before_is_free else normals[-1])
        normals.append(normal)

    if wanted is None:
        normals.append(_at(normals[-1].x, normals[-1].after))
    else:
        like_end = _at(wanted[:3, 0], wanted[:3, 3])
        normals.append(_between(axes[-1], last, like_end, size).towards(like_end.x))

    if base is None and convention == "modified":
        normals[0] = _at(normals[1].x, normals[1].before)
    return normals, choices


def _between(line: Axis, following: Axis, model: Normal, size: float) -> Normal:
    """The common normal of two lines; where it is free, as near as can be to the model, a normal before or behind."""
    normal = common_normal(line, following, size)
    match normal.kind:
        case "intersecting":
            return normal.towards(model.x)
        case "parallel" | "antiparallel":
            return replace(normal, before=foot(line, model.after), after=foot(following, model.after))
        case "coincident":
            return replace(normal, x=model.x, before=model.after, after=model.after)
        case _:
            return normal


def _at(x: FloatArray, point: FloatArray) -> Normal:
    """A line across a single axis: a normal with both feet in one point."""
    return Normal("coincident", x, point, point, 0.0)


def _z_line(pose: FloatArray) -> Axis:
    return Axis(pose[:3, 3], pose[:3, 2])


# Steps 4 to 7: frames and parameters


def _frame(z: FloatArray, x: FloatArray, origin: FloatArray) -> FloatArray:
    """The right-handed frame with this z and, as far as it is across z, this x."""
    x = x - (x @ z) * z
    x = x / np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = x, cross(z, x), z, origin
    return _tidy(pose, 0.0)


def _tidy(pose: FloatArray, size: float) -> FloatArray:
    """The pose with 0 and ±1 for what is so but for rounding."""
    rotation, position = pose[:3, :3], pose[:3, 3]
    nearest = np.round(rotation)
    rotation[:] = np.where(np.abs(rotation - nearest) <= ROUNDING, nearest, rotation)
    position[:] = without_rounding(position, size)
    return pose + 0.0


def _angle(sine: float, cosine: float) -> float:
    """The angle in (-π, π], a quarter turn exactly where it is one but for rounding."""
    angle = float(np.arctan2(sine, cosine))
    quarters = round(angle / QUARTER)
    if abs(angle - quarters * QUARTER) > ROUNDING:
        return angle
    return 2 * QUARTER if quarters == -2 else quarters * QUARTER


def _length(length: float, size: float) -> float:
    return 0.0 if abs(length) <= ROUNDING * size else length


def _joint(axis: Axis, theta: float, d: float, a: float, alpha: float) -> Joint:
    if axis.kind == "R":
        return Revolute(d=d, a=a, alpha=alpha, offset=theta)
    return Prismatic(theta=theta, a=a, alpha=alpha, offset=d)


# The ends, where they are given


def _check_base(base: FloatArray, frames: list[FloatArray], axis: Axis, convention: str, size: float) -> None:
    """Refuse a frame 0 from which no DH row leads to axis 1."""
    if convention == "classic":
        faults = _off_axis(base, axis, 0, 1, size)
    else:
        faults = _off_conditions(base, frames[1], 1, convention, size)
    if faults:
        raise DHError(
            f"the base cannot be frame 0 of a {convention} table on these axes. {'; '.join(faults)}. "
            "Leave base out, and place_frames chooses one that can."
        )


def _check_last(wanted: FloatArray, frames: list[FloatArray], axis: Axis, convention: str, size: float) -> None:
    """Refuse a frame n to which no DH row leads from axis n."""
    n = len(frames) - 1
    if convention == "classic":
        faults = _off_conditions(frames[n - 1], wanted, n, convention, size)
    else:
        faults = _off_axis(wanted, axis, n, n, size)
    if faults:
        raise DHError(
            f"with this end and this tool, frame {n} would have to be end · tool⁻¹, which no {convention} table on "
            f"these axes has. {'; '.join(faults)}. Leave tool out, and place_frames finds the one that fits."
        )


def _off_conditions(before: FloatArray, frame: FloatArray, link: int, convention: str, size: float) -> list[str]:
    angle, distance = deviation(before, frame, convention)
    return fault_sentences(link, angle if angle > FIT else 0, distance if distance > FIT * size else 0, convention)


def _off_axis(frame: FloatArray, axis: Axis, number: int, i: int, size: float) -> list[str]:
    """What keeps z of a frame from lying on an axis, in its sense."""
    tilt, gap = deviation_from_axis(frame, axis)
    if tilt > FIT:
        return [f"z_{number} is {angle_text(tilt)} off the direction of axis {i}"]
    if gap > FIT * size:
        return [f"z_{number} passes axis {i} at a distance of {gap:.6g}"]
    if frame[:3, 2] @ axis.direction < 0:
        return [f"z_{number} points against axis {i}"]
    return []


# What was free, in words


def _first_choice(convention: str) -> Choice:
    if convention == "classic":
        sentence = (
            "Frame 0: z_0 is axis 1; O_0 may be any of its points and x_0 any direction across it. "
            "They are as near as can be to the origin and the x axis of the world."
        )
    else:
        sentence = "Frame 0 is free. It is frame 1 at q = 0, so α_0, a_0, θ_1 and d_1 are 0 there."
    return Choice("first frame", 0, sentence)


def _last_choice(n: int, convention: str, tool: FloatArray | None) -> Choice:
    """Of frame n; `tool` is what is left between it and the end, if there is an end."""
    free = f"z_{n}, x_{n} and O_{n}" if convention == "classic" else f"x_{n} and O_{n}"
    if tool is None:
        chosen = f"Frame {n} is frame {n - 1} at q = 0."
    elif np.array_equal(tool, np.eye(4)):
        chosen = f"Frame {n} is the end, so the tool is the identity."
    else:
        chosen = f"Frame {n} is as near to the end as the rules allow; the tool is the rest."
    return Choice("last frame", n, f"Frame {n}: nothing follows axis {n}, so {free} are free. {chosen}")


def _prismatic_choice(i: int) -> Choice:
    sentence = f"Axis {i} is prismatic: only its direction counts. It stays where it was given."
    return Choice("prismatic", i, sentence)


def _normal_choices(i: int, normal: Normal, before: Normal | None) -> list[Choice]:
    """What was free on the normal of axis i and axis i+1; `before` is the one before it, if there is one."""
    pair = f"Axes {i} and {i + 1}"
    match normal.kind, before:
        case "intersecting", None:
            chosen = "It is the one nearer to the x axis of the world."
        case "intersecting", Normal(x=x) if abs(x @ normal.x) <= ROUNDING:
            chosen = f"Both turn x_{i - 1} by 90°. It is the vector product of the two axes."
        case "intersecting", _:
            chosen = f"It is the one nearer to x_{i - 1}."
        case "coincident", None:
            chosen = "It is as near as can be to the x axis of the world."
        case "coincident", _:
            chosen = f"It is x_{i - 1} at q = 0."
        case _, None:
            chosen = "It is the one nearest to the origin of the world."
        case _:
            chosen = f"It is the one with d_{i} = 0 at q = 0."
    free = {
        "intersecting": f"{pair} intersect: a_{i} = 0, and x_{i} is normal to both, in either sense.",
        "coincident": f"{pair} coincide: a_{i} = 0, and x_{i} may be any direction across them.",
        "parallel": f"{pair} are parallel: any common normal will do.",
        "antiparallel": f"{pair} are antiparallel: any common normal will do.",
    }
    choices = [Choice(normal.kind, i, f"{free[normal.kind]} {chosen}")] if normal.kind in free else []
    if normal.kind in ("skew", "intersecting") and normal.angle < NEARLY_PARALLEL:
        sentence = (
            f"{pair} are nearly parallel: {normal.angle:.2g} rad apart. Their common normal jumps for a small turn of "
            "either, and lengths may be huge. If they are meant to be parallel, make them so."
        )
        warnings.warn(sentence, DHWarning, stacklevel=4)
        choices.append(Choice("nearly parallel", i, sentence))
    return choices
