"""DH1 and DH2: what two neighbouring frames must obey for four parameters to lead from one to the next.

========  =================  =====================
          classic            modified
========  =================  =====================
DH1       x_i ⟂ z_{i-1}      x_{i-1} ⟂ z_i
DH2       x_i meets z_{i-1}  x_{i-1} meets z_i
========  =================  =====================
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from dhlib.axes import Axis
from dhlib.chain import Chain
from dhlib.conventions import read_convention
from dhlib.errors import DHError
from dhlib.normals import ROUNDING, cross, extent, foot
from dhlib.scalars import FloatArray
from dhlib.show import number_text
from dhlib.transforms import read_pose


@dataclass(frozen=True)
class LinkReport:
    """How one link stands to the preconditions.

    Attributes
    ----------
    link : int
        Its number i, from 1: it leads from frame i-1 to frame i.
    angle : float
        By how many degrees x and z miss the right angle (DH1), from 0 to 90.
    distance : float
        At what distance x passes z (DH2), in the unit of the frames.
    dh1, dh2 : bool
        Whether the conditions hold.
    on_axis : bool or None
        Whether z lies on its joint axis; None where no axes were given.
    faults : tuple of str
        A sentence for each thing that fails.
    """

    link: int
    angle: float
    distance: float
    dh1: bool
    dh2: bool
    on_axis: bool | None
    faults: tuple[str, ...]

    def __bool__(self) -> bool:
        return not self.faults

    def __str__(self) -> str:
        axis = "" if self.on_axis is None else ", and z lies on the joint axis"
        return "\n".join(self.faults) or f"link {self.link}: DH1 and DH2 hold{axis}"


@dataclass(frozen=True, repr=False)
class FrameReport:
    """How the frames of an arm stand to the preconditions: true if all hold.

    Attributes
    ----------
    convention : str
    links : tuple of LinkReport
        Link 1 to n.
    """

    convention: str
    links: tuple[LinkReport, ...]

    def __bool__(self) -> bool:
        return all(self.links)

    def __repr__(self) -> str:
        return "\n".join(map(str, self.links))

    @property
    def faults(self) -> list[str]:
        """A sentence for each thing that fails, from link 1 on."""
        return [fault for link in self.links for fault in link.faults]


def check_frames(
    frames: Any,
    convention: str = "classic",
    axes: Sequence[Axis] | Chain | None = None,
    tol: float = 1e-6,
) -> FrameReport:
    """Say of each link whether its two frames obey DH1 and DH2, and by how much they fail.

    Parameters
    ----------
    frames : array_like (n+1, 4, 4)
        Poses of frame 0 to frame n, all seen from one frame; numpy arrays, lists or sympy matrices of numbers.
    convention : {"classic", "modified"}
        Classic: x_i is held against z_{i-1}. Modified: x_{i-1} against z_i; so frame 0 is bound by
        x_0 alone and x_n by nothing.
    axes : list of Axis, or Chain, optional
        The n joint axes, or an arm that has them at q = 0. Then z_{i-1} (classic) or z_i (modified) must lie on
        axis i too, in either sense; on a prismatic axis only the direction counts.
    tol : float
        What still passes: in radians for angles, relative to the distances of the origins for lengths.

    Returns
    -------
    FrameReport
        True if everything holds. Its text has a line for each link.

    Raises
    ------
    DHError
        If a frame is not 4×4, holds NaN, or is not orthonormal and right-handed, if there are fewer than two, or
        if the number of axes does not fit.

    Notes
    -----
    J. Denavit and R. S. Hartenberg, 1955; the names DH1 and DH2 are those of M. W. Spong, S. Hutchinson and
    M. Vidyasagar, *Robot Modeling and Control*, 2006, section 3.2.

    Examples
    --------
    >>> from dhlib import Rz, Tx, Ty, robots
    >>> bool(check_frames(robots.quickshot().frames([0.3, 0.5, 0.7, 0.2])))
    True
    >>> print(check_frames([Rz(0), Tx(160), Tx(160) @ Ty(12.3)]))
    link 1: DH1 and DH2 hold
    link 2: DH2 fails: x_2 passes z_1 at a distance of 12.3
    """
    convention = read_convention(convention)
    poses = _read_frames(frames, tol)
    unit = f" {axes.unit}" if isinstance(axes, Chain) else ""
    listed = None if axes is None else read_axes(axes, len(poses) - 1)
    origins = [pose[:3, 3] for pose in poses]
    spread = max(float(np.linalg.norm(origin - origins[0])) for origin in origins)
    allowed = tol * spread + ROUNDING * extent(*origins)

    links = []
    for i, (before, frame) in enumerate(pairwise(poses), 1):
        angle, distance = deviation(before, frame, convention)
        dh1, dh2 = angle <= tol, distance <= allowed
        faults = fault_sentences(i, angle if not dh1 else 0, distance if not dh2 else 0, convention, unit)
        on_axis = None
        if listed is not None:
            tilt, gap = deviation_from_axis(before if convention == "classic" else frame, listed[i - 1])
            number = i - 1 if convention == "classic" else i
            if tilt > tol:
                faults.append(f"link {i}: z_{number} is {_degrees(tilt)} off the direction of joint axis {i}")
            if gap > allowed:
                faults.append(
                    f"link {i}: z_{number} is not on joint axis {i}: "
                    f"its origin is at a distance of {number_text(gap)}{unit} from it"
                )
            on_axis = tilt <= tol and gap <= allowed
        links.append(LinkReport(i, math.degrees(angle), distance, dh1, dh2, on_axis, tuple(faults)))
    return FrameReport(convention, tuple(links))


def deviation(before: FloatArray, frame: FloatArray, convention: str) -> tuple[float, float]:
    """By how much two neighbouring frames fail DH1 and DH2.

    Parameters
    ----------
    before, frame : ndarray (4, 4)
        Frame i-1 and frame i.
    convention : {"classic", "modified"}

    Returns
    -------
    angle : float
        By which x and z miss the right angle, in radians, from 0 to π/2.
    distance : float
        Of the lines x and z from one another.

    Examples
    --------
    >>> from dhlib import Rx, Ry, Ty
    >>> deviation(Rx(0), Ty(3) @ Ry(0.25), "classic")
    (0.25, 3.0)
    """
    with_x, with_z = (frame, before) if convention == "classic" else (before, frame)
    x, z = with_x[:3, 0], with_z[:3, 2]
    between = with_x[:3, 3] - with_z[:3, 3]
    normal = cross(z, x)
    sine = float(np.linalg.norm(normal))
    angle = math.atan2(abs(float(x @ z)), sine)
    if sine < 1e-9:  # x runs along z, so every point of it is at the same distance
        return angle, float(np.linalg.norm(cross(z, between)))
    return angle, abs(float(between @ normal)) / sine


def deviation_from_axis(frame: FloatArray, axis: Axis) -> tuple[float, float]:
    """By how much the z axis of a frame fails to lie on a joint axis: angle in radians, and distance.

    The sense does not count. The distance is that of the origin; of a prismatic axis, which has no place, it is 0.
    """
    z, origin = frame[:3, 2], frame[:3, 3]
    tilt = math.atan2(float(np.linalg.norm(cross(z, axis.direction))), abs(float(z @ axis.direction)))
    return tilt, 0.0 if axis.kind == "P" else float(np.linalg.norm(origin - foot(axis, origin)))


def fault_sentences(link: int, angle: float, distance: float, convention: str, unit: str = "") -> list[str]:
    """What fails of DH1 and DH2 at a link, in words: nothing where angle and distance are 0."""
    x, z = (link, link - 1) if convention == "classic" else (link - 1, link)
    faults = []
    if angle:
        faults.append(f"link {link}: DH1 fails: x_{x} is {_degrees(angle)} off the perpendicular to z_{z}")
    if distance:
        faults.append(f"link {link}: DH2 fails: x_{x} passes z_{z} at a distance of {number_text(distance)}{unit}")
    return faults


def read_axes(axes: Any, n: int | None = None) -> list[Axis]:
    """Return joint axes as a list, refusing anything else and, if `n` is given, any other number of them."""
    listed = axes.axes() if isinstance(axes, Chain) else axes
    if not isinstance(listed, list | tuple):
        raise DHError(f"axes is {axes!r}; it should be a list of Axis(point, direction, kind), or a Chain.")
    for i, axis in enumerate(listed, 1):
        if not isinstance(axis, Axis):
            raise DHError(f"axis {i} is {axis!r}; it should be an Axis(point, direction, kind).")
    if n is not None and len(listed) != n:
        raise DHError(f"there are {n + 1} frames and {len(listed)} axes; {n + 1} frames, 0 to {n}, need {n} axes.")
    return list(listed)


def read_numeric_pose(value: Any, what: str, tol: float = 1e-9) -> FloatArray:
    """Return a pose as an array of floats, from an array, a list or a sympy matrix of numbers."""
    pose = read_pose(value, what, tol)
    if getattr(pose, "free_symbols", ()):
        raise DHError(f"{what} holds symbols; numbers are needed here. Give the symbols values first.")
    return np.array(pose.tolist(), dtype=np.float64)


def _read_frames(frames: Any, tol: float) -> list[FloatArray]:
    if isinstance(frames, str) or not hasattr(frames, "__len__") or not hasattr(frames, "__iter__"):
        raise DHError(f"frames is {frames!r}; it should be a list of 4×4 matrices, frame 0 to frame n.")
    if len(frames) < 2 or getattr(frames, "shape", ()) == (4, 4):
        raise DHError("check_frames needs frame 0 to frame n, shape (n+1, 4, 4): at least two frames.")
    return [read_numeric_pose(frame, f"frame {i}", tol) for i, frame in enumerate(frames)]


def _degrees(angle: float) -> str:
    return f"{number_text(float(f'{math.degrees(angle):.4g}'))}°"
