"""Whom a platform means: the numbers in the names that Moodle and Canvas give to what they hand out."""

from __future__ import annotations

import re
from dataclasses import dataclass

from dhlib.grading.batch.rows import Submission

#: ``Name_12345_assignsubmission_file_``; newer Moodles leave out the last line.
MOODLE = re.compile(r"(?P<name>[^/_]*)_(?P<id>\d+)_assignsubmission_file_?")
#: ``name_late_123_456_file.ipynb``: the numbers are those of the user and of the file.
CANVAS = re.compile(r"(?P<prefix>[^/_]+_(?:late_)?(?P<id>\d+)_(?P<file>\d+)_)[^/]+")


@dataclass(frozen=True)
class Seat:
    """Where a platform expects what comes back.

    Parameters
    ----------
    number : str
        Of the participant or user.
    place : str
        The folder (Moodle) or the beginning of the file name (Canvas), as the platform made it.
    """

    number: str
    place: str


def moodle_seat(submission: Submission) -> Seat | None:
    """The folder that Moodle made; None if the file did not come from one.

    The outermost that looks like one counts: what a student put into it may look like anything.
    """
    for piece in _pieces(submission):
        if found := MOODLE.match(piece):
            return Seat(found["id"], found[0])
    return None


def canvas_seat(submission: Submission) -> Seat | None:
    """The beginning of the file name that Canvas made; None if the file did not come from there."""
    for piece in _pieces(submission):
        if found := CANVAS.fullmatch(piece):
            return Seat(found["id"], found["prefix"])
    return None


def _pieces(submission: Submission) -> list[str]:
    return [piece for path in (submission.source, submission.place) for piece in path.split("/") if piece]
