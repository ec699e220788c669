"""Grade one notebook: the pristine exercise with its answers, run in a box, marked here."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.closing import close_parts
from dhlib.grading.course.papers import NotAssigned, Paper, check_tag, load_paper, read_tag
from dhlib.grading.exercise import Exercise, find_exercise
from dhlib.grading.marking import Marker
from dhlib.grading.marks import OPEN, Mark, stopped_with
from dhlib.grading.notebook import Cell, damage, load_notebook, merge, read_cells
from dhlib.grading.wall import Limits, Outcome, Sandbox

GRADED, INCOMPLETE, UNREADABLE, FAILED = "graded", "stopped", "unreadable", "failed"


@dataclass(frozen=True)
class Result:
    """What came of one notebook.

    Parameters
    ----------
    path : Path
    status : {"graded", "stopped", "unreadable", "failed"}
        Stopped: the run ended early, and what was handed in until then is marked. Failed: the grader failed, not the
        student.
    message : str
        A sentence where the status is not "graded".
    exercise : Exercise, optional
    marks : sequence of Mark
    """

    path: Path
    status: str
    message: str = ""
    exercise: Exercise | None = None
    marks: Sequence[Mark] = field(default_factory=tuple)

    @property
    def points(self) -> float:
        """Points earned."""
        return round(sum(mark.points for mark in self.marks), 2)

    @property
    def out_of(self) -> float:
        """Points that could be earned."""
        return self.exercise.points if self.exercise else 0.0


def grade_notebook(
    path: str | Path,
    name: str = "",
    exercises: str | Path | None = None,
    limits: Limits | None = None,
    *,
    sandbox: Sandbox | None = None,
    key: bytes | None = None,
) -> Result:
    """Grade one notebook.

    Parameters
    ----------
    path : path
    name : str, optional
        The exercise; by default what the notebook's metadata says, else its file name.
    exercises : path, optional
        Where to look for exercises first.
    limits : Limits, optional
        What it may use; by default those of the sandbox.
    sandbox : Sandbox, optional
        Where it runs; one is started for it if left out, which takes a second.
    key : bytes, optional
        Of the course: then only notebooks that were assigned with it are graded, each by its own numbers.

    Returns
    -------
    Result
        Also for a file that is no notebook: it never raises for what a student handed in.

    Raises
    ------
    DHError
        If the exercise itself is missing or broken, which is the grader's to mend.
    """
    path = Path(path)
    try:
        notebook = load_notebook(path)
        submission = read_cells(notebook)
        tag = read_tag(notebook)
        if key is not None:
            check_tag(tag, key)
        elif tag.student:
            raise NotAssigned(f"it was assigned to {tag.student!r}: grade it with --key.")
    except NotAssigned as error:
        return Result(path, UNREADABLE, f"{path.name} cannot be graded: {error}")
    except DHError as error:
        return Result(path, UNREADABLE, str(error))
    name, given = (tag.exercise, False) if key is not None else (name or tag.exercise or path.stem, bool(name))
    paper = _paper(name, exercises, key, tag.student or None, given)
    if paper is None:
        return Result(path, UNREADABLE, f"{path.name} does not say which exercise it is; name it with --exercise NAME.")
    exercise = paper.exercise
    cells = close_parts(merge(paper.cells, submission), exercise)
    requests = {part.id: part.asks.request() for part in exercise.parts}
    with contextlib.ExitStack() as stack:
        sandbox = sandbox or stack.enter_context(Sandbox())
        outcome = sandbox.run(cells, requests, limits)
    marks = [with_error(mark, cells, outcome) for mark in Marker(exercise).mark_all(outcome.readings)]
    message = " ".join(filter(None, (damage(notebook), outcome.note)))
    return Result(path, INCOMPLETE if outcome.note else GRADED, message, exercise, marks)


def _paper(
    name: str, exercises: str | Path | None, key: bytes | None, student: str | None, given: bool
) -> Paper | None:
    """What the student was given; none if a submission names an exercise that is not there."""
    try:
        find_exercise(name, ".py", exercises)
    except DHError:
        if given:
            raise
        return None
    return load_paper(name, exercises, key, student)


def with_error(mark: Mark, cells: Sequence[Cell], outcome: Outcome) -> Mark:
    """A mark that says why there is no answer, where its cell stopped."""
    if mark.verdict != OPEN:
        return mark
    for k, cell in enumerate(cells):
        if cell.role == "answer" and cell.part == mark.part:
            if k in outcome.killers:
                says = "Its cell ended the whole program or never ended, so it was left out."
            elif k in outcome.errors:
                says = stopped_with(outcome.errors[k])
            else:
                continue
            return Mark(mark.part, mark.points, mark.out_of, mark.verdict, says, "", mark.section)
    return mark
