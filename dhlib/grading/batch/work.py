"""Grade one submission: the unit of work, the same in a worker process at home and on a cluster.

Three steps, of which only the second meets the student's code, in a box:

1. `Grader.prepare`: read the notebook, and put its answers into the pristine exercise;
2. `Sandbox.run`: run it, and bring home the answers;
3. `Grader.finish`: mark them.
"""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.asked import Catalogue
from dhlib.grading.batch.rows import MarkRow
from dhlib.grading.grade import FAILED, GRADED, INCOMPLETE, UNREADABLE, CannotGrade, Ready, mark, prepare
from dhlib.grading.wall import Limits, Outcome

#: A longer answer is not kept: nobody would look at it, and it says nothing of a misconception.
LONGEST_ANSWER = 100_000
LONGEST_MESSAGE = 1_000


@dataclass(frozen=True)
class Settings:
    """What holds for every submission of a run.

    Parameters
    ----------
    exercise : str
        Which one it is, where the notebooks do not say; ``""`` if they do.
    exercises : Path, optional
        Where to look for exercises first.
    limits : Limits
        For each notebook.
    unsafe : bool
        Run without walls.
    key : bytes, optional
        Of the course, for notebooks that were assigned; it stays in the processes of this machine.
    """

    exercise: str = ""
    exercises: Path | None = None
    limits: Limits = field(default_factory=Limits)
    unsafe: bool = False
    key: bytes | None = field(default=None, repr=False)


@dataclass(frozen=True)
class Work:
    """One submission to grade.

    Parameters
    ----------
    number : int
        Where it stands in the run.
    name : str
        Of the file, for messages.
    student : str
        Whose it is by its place, or ``""``.
    data : bytes
        The file.
    fault : str
        Why there is no file, or ``""``.
    """

    number: int
    name: str
    student: str
    data: bytes
    fault: str = ""


@dataclass(frozen=True, kw_only=True)
class Graded:
    """What came of one submission.

    Parameters
    ----------
    number : int
    status : {"graded", "stopped", "unreadable", "failed"}
    message : str
    exercise : str
    claims : str
        Whose it is by its own metadata, or ``""``.
    marks : sequence of MarkRow
    out_of : float
    seconds : float
    exercise_sha256 : str
    """

    number: int
    status: str
    message: str = ""
    exercise: str = ""
    claims: str = ""
    marks: Sequence[MarkRow] = ()
    out_of: float = 0.0
    seconds: float = 0.0
    exercise_sha256: str = ""

    @property
    def points(self) -> float:
        """Points earned."""
        return round(sum(mark.points for mark in self.marks), 2)


@dataclass(frozen=True, eq=False)
class Prepared:
    """A submission that is ready for the box."""

    work: Work
    ready: Ready


class Grader:
    """The trusted side of grading.

    Parameters
    ----------
    settings : Settings
    """

    def __init__(self, settings: Settings) -> None:
        self.settings = settings
        self.catalogue = Catalogue(settings.exercises, settings.key)

    def prepare(self, work: Work) -> Prepared | Graded:
        """Read a submission; one that cannot be read is graded already.

        Raises
        ------
        DHError
            If the exercise that was named on the command line is missing or broken.
        """
        if work.fault:
            return self._unreadable(work, work.fault)
        try:
            return Prepared(work, prepare(work.data, work.name, self.catalogue, self.settings.exercise))
        except CannotGrade as error:
            return self._unreadable(work, str(error), error.claims)

    def finish(self, prepared: Prepared, outcome: Outcome, seconds: float) -> Graded:
        """Mark what came out of the box."""
        ready = prepared.ready
        exercise = ready.asked.exercise
        return Graded(
            number=prepared.work.number,
            status=INCOMPLETE if outcome.note else GRADED,
            message=" ".join(filter(None, (ready.damage, outcome.note)))[:LONGEST_MESSAGE],
            exercise=exercise.name,
            claims=ready.claims,
            marks=[
                MarkRow(
                    part=one.part,
                    title=part.title,
                    points=one.points,
                    out_of=one.out_of,
                    verdict=one.verdict,
                    message=one.message,
                    misconception=one.misconception,
                    section=one.section,
                    answer=kept(outcome.readings.get(one.part)),
                )
                for one, part in zip(mark(ready, outcome), exercise.parts, strict=True)
            ],
            out_of=exercise.points,
            seconds=seconds,
            exercise_sha256=ready.asked.sha256,
        )

    def _unreadable(self, work: Work, why: str, claims: str = "") -> Graded:
        """No points, of as many as there are if the exercise is known."""
        name = self.settings.exercise
        asked = self.catalogue.asked(name, "") if name and self.settings.key is None else None
        return Graded(
            number=work.number,
            status=UNREADABLE,
            message=why[:LONGEST_MESSAGE],
            exercise=name,
            claims=claims,
            out_of=asked.exercise.points if asked else 0.0,
            exercise_sha256=asked.sha256 if asked else "",
        )


def failed(number: int, why: str) -> Graded:
    """A submission at which the grader itself failed."""
    return Graded(number=number, status=FAILED, message=why[:LONGEST_MESSAGE])


def grade(grader: Grader, sandbox: Any, work: Work) -> Graded:
    """Grade a submission in a box; whatever goes wrong with it is in what is returned.

    Raises
    ------
    DHError
        If the exercise, or this machine, does not allow to grade anything.
    """
    begun = time.monotonic()
    try:
        prepared = grader.prepare(work)
        if isinstance(prepared, Graded):
            return prepared
        outcome = sandbox.run(prepared.ready.cells, prepared.ready.asked.requests)
        return grader.finish(prepared, outcome, round(time.monotonic() - begun, 3))
    except DHError:
        raise
    except Exception as error:  # ours to mend; the others should not suffer
        return failed(work.number, broken(error))


def broken(error: BaseException) -> str:
    """What to say when the grader itself is at fault."""
    return f"The grader failed on it ({type(error).__name__}: {error}). Please report this."


def kept(reading: Any) -> str:
    """A reading as it is kept: JSON, of bounded length."""
    try:
        text = json.dumps(reading, ensure_ascii=True, allow_nan=False)
    except (ValueError, TypeError, RecursionError):
        return '{"fault": "refused"}'
    return text if len(text) <= LONGEST_ANSWER else '{"fault": "large"}'
