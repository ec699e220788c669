"""What was asked of a student: the exercise, its pristine notebook, and the numbers that were theirs."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.exercise import Exercise, exercise_folders, find_exercise, load_exercise
from dhlib.grading.notebook import Cell, load_notebook, read_cells

#: Exercises kept at a time; with numbers of one's own each student has another one.
MOST_KEPT = 32


@dataclass(frozen=True, eq=False)
class Asked:
    """An exercise, as it was asked.

    Parameters
    ----------
    exercise : Exercise
    pristine : sequence of Cell
    requests : dict
        Part to what is sent into the box: probe points and forms, and nothing of the solution.
    sha256 : str
        Of all that the marks depend on, apart from dhlib itself.
    """

    exercise: Exercise
    pristine: Sequence[Cell]
    requests: dict[str, Any]
    sha256: str


class Catalogue:
    """Exercises by name, each read once.

    Parameters
    ----------
    folder : path, optional
        Where to look first.

    Examples
    --------
    >>> Catalogue().asked("quickshot", "ada").exercise.title
    'The Quickshot'
    """

    def __init__(self, folder: Path | None = None) -> None:
        self.folder = folder
        self._kept: OrderedDict[tuple[str, str], Asked] = OrderedDict()

    def has(self, name: str) -> bool:
        """Whether there is such an exercise."""
        try:
            find_exercise(name, ".py", self.folder)
        except DHError:
            return False
        return True

    def asked(self, name: str, student: str) -> Asked:
        """What this student was asked; raises DHError if there is no such exercise, or its files are broken."""
        key = (name, "")
        if key not in self._kept:
            self._kept[key] = self._load(name)
            if len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]

    def sha256(self, name: str) -> str:
        """Of the files of an exercise; ``""`` if it is not there."""
        digest = hashlib.sha256()
        try:
            for suffix in (".py", ".ipynb"):
                digest.update(find_exercise(name, suffix, self.folder).read_bytes())
        except (DHError, OSError):
            return ""
        return digest.hexdigest()

    def _load(self, name: str) -> Asked:
        exercise = load_exercise(name, self.folder)
        pristine = read_cells(load_notebook(find_exercise(name, ".ipynb", self.folder)))
        requests = {part.id: part.asks.request() for part in exercise.parts}
        return Asked(exercise, pristine, requests, self.sha256(name))


def names(folder: Path | None = None) -> list[str]:
    """The names of all exercises that can be found."""
    return sorted({path.stem for place in exercise_folders(folder) for path in place.glob("*.py")})
