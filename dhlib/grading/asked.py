"""What was asked of a student: the exercise, its pristine notebook, and the numbers that were theirs."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.keys import fingerprint
from dhlib.grading.course.papers import Papers
from dhlib.grading.exercise import Exercise, exercise_folders, find_exercise
from dhlib.grading.notebook import Cell

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
    key : bytes, optional
        Of the course: then each student has numbers of their own.

    Examples
    --------
    >>> Catalogue().asked("quickshot", "ada").exercise.title
    'The Quickshot'
    """

    def __init__(self, folder: Path | None = None, key: bytes | None = None) -> None:
        self.folder, self.key = folder, key
        self._papers: dict[str, Papers] = {}
        self._sums: dict[str, str] = {}
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
        student = student if self.key is not None else ""
        if (name, student) not in self._kept:
            self._kept[name, student] = self._load(name, student)
            if len(self._kept) > MOST_KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end((name, student))
        return self._kept[name, student]

    def sha256(self, name: str) -> str:
        """Of the files of an exercise, and of the key; ``""`` if it is not there."""
        if name not in self._sums:
            digest = hashlib.sha256(fingerprint(self.key).encode() if self.key is not None else b"")
            try:
                for suffix in (".py", ".ipynb"):
                    digest.update(find_exercise(name, suffix, self.folder).read_bytes())
            except (DHError, OSError):
                return ""
            self._sums[name] = digest.hexdigest()
        return self._sums[name]

    def _load(self, name: str, student: str) -> Asked:
        try:
            if name not in self._papers:
                self._papers[name] = Papers(name, self.folder)
            paper = self._papers[name].of(self.key, student or None)
        except DHError:
            raise
        except Exception as error:  # whatever an exercise's own file does
            raise DHError(f"the exercise {name!r} is broken: {type(error).__name__}: {error}.") from error
        requests = {part.id: part.asks.request() for part in paper.exercise.parts}
        return Asked(paper.exercise, paper.cells, requests, self.sha256(name))


def names(folder: Path | None = None) -> list[str]:
    """The names of all exercises that can be found."""
    return sorted({path.stem for place in exercise_folders(folder) for path in place.glob("*.py")})
