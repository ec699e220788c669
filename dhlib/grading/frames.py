"""Judge frames: each a pose, each z on its joint axis, DH1 and DH2 at every link."""

from __future__ import annotations

import numpy as np

from dhlib.errors import DHError
from dhlib.grading.exercise import Part
from dhlib.grading.forms import Frames
from dhlib.grading.marks import NEARLY, RIGHT, WRONG, Mark, make_mark
from dhlib.grading.misconceptions import KNOWN, name_one, told_frames
from dhlib.grading.poses import improper
from dhlib.grading.sentences import begun
from dhlib.preconditions import check_frames
from dhlib.scalars import FloatArray

#: What frames earn that obey everything but stand at another end than the task says.
OTHER_ENDS = 0.75
#: What the links that are right earn, together, where not all are.
LINKS = 0.5


def judge_frames(part: Part, asks: Frames, frames: FloatArray) -> Mark:
    """Judge poses (n+1, 4, 4) of the frames at q = 0.

    Whatever obeys DH1 and DH2 with its z axes on the joint axes is right, in either sense of every axis.
    """
    for k, frame in enumerate(frames):
        if fault := improper(frame[None]):
            return make_mark(part, WRONG, f"Frame {k}: {fault}", known=KNOWN["improper"])
    chain = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    try:
        report = check_frames(frames, asks.convention, axes=part.chain, tol=2 * asks.tolerance)
    except DHError as error:
        return make_mark(part, WRONG, begun(str(error)))
    n = part.chain.n
    if not report:
        fits = [slip for slip, told in told_frames(part.chain, asks.convention) if _same(frames, told, asks)]
        fine = sum(map(bool, report.links))
        credit = LINKS * fine / n
        if slip := name_one(fits):
            known = slip.misconception
            return make_mark(part, WRONG, slip.says.format(part=part.id), max(credit, known.credit), known)
        says = f"{begun(report.faults[0])}."
        return make_mark(part, NEARLY if fine == n - 1 else WRONG, says, credit)
    right = chain.frames(np.zeros(n))
    if not _same(frames[:1], right[:1], asks):
        return make_mark(part, NEARLY, "Every link obeys DH1 and DH2, but frame 0 is not the one given.", OTHER_ENDS)
    if np.any(np.abs(frames[-1, :3, 3] - right[-1, :3, 3]) > asks.length_tolerance):
        says = f"Every link obeys DH1 and DH2, but the origin of frame {n} is not where the task puts it."
        return make_mark(part, NEARLY, says, OTHER_ENDS)
    return make_mark(part, RIGHT, "Every link obeys DH1 and DH2, and every z lies on its axis.")


def _same(frames: FloatArray, others: FloatArray, asks: Frames) -> bool:
    off = np.abs(frames - others)
    return bool(np.all(off[:, :3, 3] <= asks.length_tolerance) and np.all(off[:, :3, :3] <= asks.tolerance))
