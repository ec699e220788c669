"""The rows of ``results.sqlite``, as Python sees them."""

from __future__ import annotations

import json
from dataclasses import dataclass
from enum import IntEnum
from typing import Any


class Certainty(IntEnum):
    """Who says whose work it is; a higher one is never overruled by a lower one."""

    NOBODY = 0
    #: The notebook itself, which its author can make say anything.
    METADATA = 1
    #: A file name that its author chose.
    FILE_NAME = 2
    #: A folder, or a name that a platform gave.
    PLACE = 3


@dataclass(frozen=True, kw_only=True)
class Submission:
    """A notebook that was graded, and who handed it in.

    Parameters
    ----------
    exercise : str
        Its name, or ``""`` if nobody knows.
    student : str
        A name that stays: that of the roster, the number in the platform, or the name of the folder. ``""`` if nobody
        knows.
    name : str
        What the student is called.
    certainty : Certainty
    source : str
        Where the file was found, relative to what was graded.
    place : str
        The folder, or entry of the platform, that stands for the student.
    claims : str
        Whose it is by its own metadata, which proves nothing; ``""`` if that is silent.
    sequence : int
        The number that the platform gave; 0 if it gave none.
    submitted : str
        ISO 8601 in UTC, or ``""``.
    late : bool
        Whether the platform says that it was late.
    late_seconds : float, optional
    sha256 : str
        Of the file.
    status : {"graded", "stopped", "unreadable", "failed"}
    message : str
    points, out_of : float
    seconds : float
        That grading took.
    graded_at : str
    dhlib, python, numpy, sympy : str
        Versions.
    seed : str
    exercise_sha256 : str
        Of what was asked.
    id : int
        0 until it is stored.
    attempt : int
        From 1, among those of this student for this exercise.
    counts : bool
        Whether this attempt is the one that counts.
    """

    exercise: str
    student: str
    name: str
    certainty: Certainty
    source: str
    place: str
    claims: str = ""
    sequence: int = 0
    submitted: str = ""
    late: bool = False
    late_seconds: float | None = None
    sha256: str
    status: str
    message: str = ""
    points: float = 0.0
    out_of: float = 0.0
    seconds: float = 0.0
    graded_at: str = ""
    dhlib: str = ""
    python: str = ""
    numpy: str = ""
    sympy: str = ""
    seed: str = ""
    exercise_sha256: str = ""
    id: int = 0
    attempt: int = 1
    counts: bool = True


@dataclass(frozen=True, kw_only=True)
class Grounds:
    """What decides whether a submission has to be graded again.

    Parameters
    ----------
    exercise, exercise_sha256 : str
        What was asked.
    dhlib : str
        Version.
    status : str
    graded_at : str
    """

    exercise: str
    exercise_sha256: str
    dhlib: str
    status: str
    graded_at: str


@dataclass(frozen=True, kw_only=True)
class MarkRow:
    """The mark of one part, with the answer it was given for."""

    part: str
    title: str = ""
    points: float
    out_of: float
    verdict: str
    message: str = ""
    misconception: str = ""
    section: str = ""
    answer: str = "null"

    @property
    def reading(self) -> Any:
        """The answer as it came out of the box: plain JSON, not validated."""
        return json.loads(self.answer)


@dataclass(frozen=True)
class Student:
    """Somebody who handed something in."""

    student: str
    name: str
    submissions: int


@dataclass(frozen=True)
class Problem:
    """Something for the instructor to look at: what could not be placed, and who is claimed twice.

    Parameters
    ----------
    source : str
        Where it was found.
    what : str
        A sentence.
    students : sequence of str
        Whom it concerns.
    submission : int, optional
        None for what never became one.
    """

    source: str
    what: str
    students: tuple[str, ...] = ()
    submission: int | None = None


@dataclass(frozen=True)
class Event:
    """A line of the audit trail."""

    at: str
    what: str
    student: str
    details: str
    id: int = 0
