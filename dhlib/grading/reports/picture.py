"""A student's frames, drawn beside the joint axes of the arm."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.drawing import draw
from dhlib.errors import DHError, DHWarning
from dhlib.grading.exercise import Part
from dhlib.grading.forms import Frames, Table
from dhlib.grading.reports.shape import read_values
from dhlib.grading.tables import read_chain
from dhlib.scalars import FloatArray
from dhlib.scene import Scene, Sketch

#: A frame farther from the arm than this many times its size is left out: the rest would shrink to a dot.
FAR = 4.0
AXIS_LENGTH = 0.17


def picture(part: Part, reading: Any) -> Sketch | None:
    """The frames of an answer at q = 0 and the joint axes of the arm, in one drawing.

    Parameters
    ----------
    part : Part
        One that asks for frames or for a table.
    reading : dict
        The answer as it came out of the box: nothing in it is trusted.

    Returns
    -------
    Sketch or None
        None where the answer gives no frames, or none near the arm.
    """
    if not isinstance(reading, dict):
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DHWarning)
            frames = _frames(part, reading)
            return None if frames is None else _drawn(part, frames)
    except (DHError, ArithmeticError, np.linalg.LinAlgError):
        return None


def _frames(part: Part, reading: Mapping[str, Any]) -> FloatArray | None:
    match part.asks:
        case Frames(count=count):
            values = read_values(reading, (1, count, 4, 4))
            return None if values is None else values[0]
        case Table() as asks:
            chain = _chain(part, asks, reading)
            if chain is None or chain.n != part.chain.n:
                return None
            frames = chain.frames(np.zeros(chain.n))
            return frames if isinstance(frames, np.ndarray) else None
    return None


def _chain(part: Part, asks: Table, reading: Mapping[str, Any]) -> Chain | None:
    """The chain of a table, based where the arm is, so that both can stand in one picture."""
    table = reading.get("table")
    if not isinstance(table, dict) or not isinstance(table.get("rows"), list):
        return None
    reference = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    told = {"rows": table["rows"], "columns": table.get("columns"), "convention": table.get("convention", "")}
    try:
        chain = read_chain(told, asks, reference)
    except (DHError, TypeError, KeyError, ValueError):
        return None
    return Chain(chain.joints, chain.convention, base=reference.base, unit=chain.unit)


def _drawn(part: Part, frames: FloatArray) -> Sketch | None:
    arm = draw(part.chain, np.zeros(part.chain.n))
    middle = np.mean([frame.origin for frame in arm.frames], axis=0)
    near = [k for k, frame in enumerate(frames) if np.linalg.norm(frame[:3, 3] - middle) <= FAR * arm.size]
    if not near:
        return None
    scene = Scene(AXIS_LENGTH * arm.size)
    reach = 0.3 * arm.size
    for joint in arm.joints:
        scene.add_line(joint.foot, joint.axis, str(joint.index), reach, reach)
    for k in near:
        scene.add_frame(frames[k], str(k), axes="xz")
    far = [str(k) for k in range(len(frames)) if k not in near]
    left_out = f" Frame {', '.join(far)}: too far away to be drawn." if far else ""
    told = f"The frames 0 to {len(frames) - 1} of {part.id} at q = 0, with x and z."
    alt = f"{told} The dash-dotted lines are the joint axes 1 to {part.chain.n} of the arm.{left_out}"
    return scene.sketch(f"Your {part.id} beside the joint axes", alt)
