"""Grade one notebook: the pristine exercise with its answers, run in a box, marked here."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.asked import Asked, Catalogue
from dhlib.grading.closing import close_parts
from dhlib.grading.course.papers import NotAssigned, Tag, check_tag, read_tag
from dhlib.grading.exercise import Exercise
from dhlib.grading.marking import Marker
from dhlib.grading.marks import OPEN, Mark, stopped_with
from dhlib.grading.notebook import Cell, damage, merge, parse_notebook, read_bytes, read_cells
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
    catalogue = Catalogue(Path(exercises) if exercises is not None else None, key)
    try:
        data = read_bytes(path)
    except DHError as error:
        return Result(path, UNREADABLE, str(error))
    try:
        ready = prepare(data, path.name, catalogue, name)
    except CannotGrade as error:
        return Result(path, UNREADABLE, str(error))
    with contextlib.ExitStack() as stack:
        sandbox = sandbox or stack.enter_context(Sandbox())
        outcome = sandbox.run(ready.cells, ready.asked.requests, limits)
    message = " ".join(filter(None, (ready.damage, outcome.note)))
    return Result(path, INCOMPLETE if outcome.note else GRADED, message, ready.asked.exercise, mark(ready, outcome))


class CannotGrade(DHError):
    """What was handed in cannot be graded; the text says why, `claims` whose it is by its own word."""

    def __init__(self, why: str, claims: str = "") -> None:
        super().__init__(why)
        self.claims = claims


@dataclass(frozen=True, eq=False)
class Ready:
    """The pristine exercise with somebody's answers in it: ready for the box.

    Parameters
    ----------
    asked : Asked
    claims : str
        Whose it is by its own metadata, or ``""``.
    cells : sequence of Cell
    damage : str
        What is missing from the notebook, as a sentence, or ``""``.
    """

    asked: Asked
    claims: str
    cells: Sequence[Cell]
    damage: str = ""


def prepare(data: bytes, file: str, catalogue: Catalogue, name: str = "") -> Ready:
    """Read what was handed in, and put its answers into the pristine exercise.

    Parameters
    ----------
    data : bytes
        Content of the file.
    file : str
        Its name.
    catalogue : Catalogue
        With the key of the course, only notebooks that were assigned with it are graded: their seal, which nobody can
        make without the key, says whose numbers they hold. Whose work they are it does not say.
    name : str, optional
        The exercise; by default what the notebook's metadata says, else its file name.

    Raises
    ------
    CannotGrade
        If that is not possible, for what the student handed in.
    DHError
        If the exercise itself is missing or broken, which is the grader's to mend.
    """
    try:
        notebook = parse_notebook(data, file)
        cells = read_cells(notebook)
        tag = read_tag(notebook)
        if catalogue.key is not None:
            check_tag(tag, catalogue.key)
        elif tag.seal:
            raise NotAssigned(f"it was assigned to {tag.student!r}: grade it with --key.")
    except NotAssigned as error:
        raise CannotGrade(f"{file} cannot be graded: {error}") from None
    except DHError as error:
        raise CannotGrade(str(error)) from None
    claims = "".join(letter for letter in tag.student if letter.isprintable()).strip()
    name = _exercise(tag, file, catalogue, name)
    if not name:
        raise CannotGrade(f"{file} does not say which exercise it is; name it with --exercise NAME.", claims)
    asked = catalogue.asked(name, tag.student)
    wrong = damage(notebook)
    if tag.exercise not in ("", name):
        wrong = f"{file} says that it is of the exercise {tag.exercise}; it was graded as {name}. {wrong}".rstrip()
    return Ready(asked, claims, close_parts(merge(asked.pristine, cells), asked.exercise), wrong)


def _exercise(tag: Tag, file: str, catalogue: Catalogue, name: str) -> str:
    """Which exercise it is: what the seal or the instructor says, else the notebook, else the name of its file."""
    if catalogue.key is not None:
        return tag.exercise
    return name or next((name for name in (tag.exercise, Path(file).stem) if name and catalogue.has(name)), "")


def mark(ready: Ready, outcome: Outcome) -> list[Mark]:
    """Mark what came out of the box: one mark for each part."""
    marks = Marker(ready.asked.exercise).mark_all(outcome.readings)
    return [_with_error(mark, ready.cells, outcome) for mark in marks]


def _with_error(mark: Mark, cells: Sequence[Cell], outcome: Outcome) -> Mark:
    """A mark that says why there is no answer, where its cell stopped."""
    if mark.verdict != OPEN:
        return mark
    for k, cell in enumerate(cells):
        if cell.role == "answer" and cell.part == mark.part:
            if k in outcome.killers:
                says = "Its cell ended the whole program or never ended, so it was left out."
            elif k in outcome.errors:
                says = stopped_with(outcome.errors[k])
            elif outcome.note and mark.part not in outcome.readings:
                says = "The run of the notebook ended before it came to this part."
            else:
                continue
            return Mark(mark.part, mark.points, mark.out_of, mark.verdict, says, "", mark.section)
    return mark
