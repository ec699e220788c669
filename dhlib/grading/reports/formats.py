"""The files that other systems read: what there is, and who writes it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.reports.records import Record


@dataclass(frozen=True)
class Wishes:
    """What whoever exports may ask for.

    Parameters
    ----------
    title : str
        What the assignment is called in the other system; that of the exercise if left out.
    worksheet : Path, optional
        A table that the other system gave, to be filled in.
    exercises : Path, optional
        Where exercises are looked for first.
    pages : mapping of int to bytes, optional
        Number of a submission to its feedback page, for the formats that give those back.
    """

    title: str = ""
    worksheet: Path | None = None
    exercises: Path | None = None
    pages: Mapping[int, bytes] | None = None


Files = Mapping[str, bytes]
"""Names of files, relative to where they are put, and what stands in them."""


@dataclass(frozen=True)
class Format:
    """A way to export.

    Parameters
    ----------
    name : str
    says : str
        What it is for, in a line.
    write : callable
        Records and wishes to files.
    needs_pages : bool
        Whether it gives feedback pages back.
    """

    name: str
    says: str
    write: Callable[[Sequence[Record], Wishes], Files]
    needs_pages: bool = False


def formats() -> dict[str, Format]:
    """All formats that need results, by name."""
    from dhlib.grading.reports import canvas, classroom, gradescope, junit, moodle, nbgrader, whole

    listed = (
        Format("moodle", "grading worksheet, and the feedback files as a zip", moodle.write, needs_pages=True),
        Format("canvas", "gradebook, and the submissions' comments as a zip", canvas.write, needs_pages=True),
        Format("gradescope", "a results.json for each student", gradescope.write),
        Format("junit", "a test report, one suite a student", junit.write),
        Format("nbgrader", "the table that nbgrader exports", nbgrader.write),
        Format("github", "points and a summary for a workflow on GitHub", classroom.report),
        Format("json", "everything, for programs of your own", whole.write),
    )
    return {each.name: each for each in listed}


def one_exercise(records: Sequence[Record], what: str) -> str:
    """The exercise of the records, where a format holds one only.

    Raises
    ------
    DHError
        If they are of several.
    """
    names = sorted({record.exercise for record in records if record.exercise})
    if len(names) > 1:
        raise DHError(
            f"{what} is of one exercise; these results are of {', '.join(names)}: choose with --exercise NAME."
        )
    return names[0] if names else ""


def known(records: Sequence[Record]) -> list[Record]:
    """The records of students that somebody knows; the others belong into no gradebook."""
    return [record for record in records if record.student]
