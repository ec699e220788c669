"""A paper: an exercise as it was given to somebody, and the tag that says to whom.

`load_paper` is what every grader calls: it draws again what was drawn when the notebook was assigned.
"""

from __future__ import annotations

import hmac
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.keys import fingerprint
from dhlib.grading.course.lots import digest, who
from dhlib.grading.course.variants import Variants, fill
from dhlib.grading.exercise import Exercise, find_exercise
from dhlib.grading.notebook import Cell, load_notebook, read_cells

LONGEST = 200


class NotAssigned(DHError):
    """A notebook whose tag is missing, altered, or made with another key; the text is one to tell the student."""


@dataclass(frozen=True)
class Tag:
    """What an assigned notebook says of itself; nothing of it is secret.

    Parameters
    ----------
    exercise, student : str
    due : str
        As the instructor wrote it, or ``""``.
    key : str
        Fingerprint of the key.
    seal : str
        Shows that nothing of the tag was altered.
    """

    exercise: str
    student: str = ""
    due: str = ""
    key: str = ""
    seal: str = ""


@dataclass(frozen=True)
class Paper:
    """What somebody was given to solve.

    Parameters
    ----------
    exercise : Exercise
        With the references of these very numbers.
    cells : list of Cell
        Of the pristine notebook, with these numbers in it.
    """

    exercise: Exercise
    cells: list[Cell]


def make_tag(key: bytes, exercise: str, student: str, due: str = "") -> Tag:
    """The tag of an assigned notebook.

    Examples
    --------
    >>> tag = make_tag(b"key", "quickshot", "s1", "2030-01-31")
    >>> tag.student, tag.due, len(tag.seal)
    ('s1', '2030-01-31', 32)
    """
    return Tag(exercise, student, due, fingerprint(key), _seal(key, exercise, student, due))


def as_metadata(tag: Tag) -> dict[str, str]:
    """A tag as a notebook's metadata keeps it."""
    return {name: value for name, value in vars(tag).items() if value}


def read_tag(notebook: dict[str, Any]) -> Tag:
    """The tag of a notebook, whatever it holds; what is no short text counts as empty."""
    about = notebook.get("metadata")
    about = about.get("dh") if isinstance(about, dict) else None
    about = about if isinstance(about, dict) else {}
    fields = (about.get(name) for name in ("exercise", "student", "due", "key", "seal"))
    return Tag(*(field if isinstance(field, str) and len(field) <= LONGEST else "" for field in fields))


def check_tag(tag: Tag, key: bytes) -> None:
    """Make sure that a tag was made with this key, and not altered since.

    Raises
    ------
    NotAssigned
        Otherwise, with a sentence that says which of these it is.
    """
    if not tag.student:
        raise NotAssigned("it does not say whose numbers it holds: it is no notebook that was assigned to a student.")
    if tag.key != fingerprint(key):
        raise NotAssigned(f"it was assigned to {tag.student!r} with another key.")
    if not hmac.compare_digest(tag.seal.encode(), _seal(key, tag.exercise, tag.student, tag.due).encode()):
        raise NotAssigned(f"its tag was altered: it was not assigned to {tag.student!r} like this.")


def load_paper(
    name: str, folder: str | Path | None = None, key: bytes | None = None, student: str | None = None
) -> Paper:
    """Load what somebody was given: the exercise, and the cells of its pristine notebook.

    A grader calls this with the key of the course and with the student who handed in, and merges the answers of the
    submission into `cells` (`notebook.merge`). Whose notebook it is stands in `read_tag`, and `check_tag` tells whether
    to believe it.

    Parameters
    ----------
    name : str
        Of the exercise.
    folder : path, optional
        Where to look first.
    key : bytes, optional
        Of the course, as `keys.read_key` gives it. Without it, the book's own numbers are taken.
    student : str, optional
        Whose numbers to draw.

    Raises
    ------
    DHError
        If the exercise is missing or broken, which is the grader's to mend.

    Examples
    --------
    >>> paper = load_paper("quickshot", key=b"key", student="s1")
    >>> paper.exercise.points
    30
    >>> [cell.part for cell in paper.cells if cell.role == "given"]
    ['how', 'figure', 'arm', 'angles', 'printed', 'ends', 'measured']
    """
    return Papers(name, folder).of(key, student)


class Papers:
    """The papers of one exercise, its files read once: for a whole class.

    Parameters
    ----------
    name : str
    folder : path, optional
    """

    def __init__(self, name: str, folder: str | Path | None = None) -> None:
        self._variants = Variants(name, folder)
        self._notebook = load_notebook(find_exercise(name, ".ipynb", folder))

    def of(self, key: bytes | None = None, student: str | None = None) -> Paper:
        """The paper of a student; without one, that of the book."""
        variant = self._variants.of(key, student)
        notebook = {**self._notebook, "cells": [dict(cell) for cell in self._notebook["cells"]]}
        fill(notebook, variant.given)
        return Paper(variant.exercise, read_cells(notebook))


def _seal(key: bytes, exercise: str, student: str, due: str) -> str:
    return digest(key, "tag", exercise, who(student), due).hex()[:32]
