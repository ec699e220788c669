"""Variants of an exercise: the same questions about other numbers.

The file of an exercise that has variants offers

* ``DEFAULT``, the given numbers of the book's own edition;
* ``exercise(given)``, which makes the `Exercise`, with every reference, trap and probe computed from `given`, and
  ``EXERCISE = exercise(DEFAULT)``;
* ``cells(given)``, the source of each given cell of the notebook, by its part;
* ``draw(lots)``, which draws the given numbers of one student from `Lots`;
* ``SAME_FOR_ALL``, the parts whose answer is one for everybody, if there are such;
* ``figure(given)``, if the notebook has a given cell ``figure``: what stands in it (see `pictures`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.editions import HOW, how_to
from dhlib.grading.course.lots import Lots
from dhlib.grading.exercise import Exercise, find_exercise, load_module
from dhlib.grading.pictures import FIGURE, as_cell
from dhlib.scene import Sketch


@dataclass(frozen=True)
class Variant:
    """An exercise as one student gets it.

    Parameters
    ----------
    exercise : Exercise
        What is asked, and how it is marked.
    given : mapping of str to str
        Part of each given cell to its source, but for the figure.
    figure : callable, optional
        Draws the figure: graders need none.
    """

    exercise: Exercise
    given: Mapping[str, str] = field(default_factory=dict)
    figure: Callable[[], Sketch] | None = None

    def cells(self) -> dict[str, str]:
        """Part of each given cell to its source, the figure too."""
        return {**self.given, **({FIGURE: as_cell(self.figure())} if self.figure else {})}


def load_variant(
    name: str, folder: str | Path | None = None, key: bytes | None = None, student: str | None = None
) -> Variant:
    """Load an exercise, for one student of a course or for everybody.

    Parameters
    ----------
    name : str
    folder : path, optional
        Where to look first.
    key : bytes, optional
        Of the course.
    student : str, optional
        With a key: whose numbers to draw. Without a student the book's own numbers are taken.

    Raises
    ------
    DHError
        If there is no such exercise, or it has no variants and a student's is asked for.

    Examples
    --------
    >>> load_variant("quickshot").exercise.title
    'The Quickshot'
    """
    return Variants(name, folder).of(key, student)


class Variants:
    """The variants of one exercise, its file read once.

    Parameters
    ----------
    name : str
    folder : path, optional
    """

    def __init__(self, name: str, folder: str | Path | None = None) -> None:
        self.name = name
        self.path = find_exercise(name, ".py", folder)
        self._module: ModuleType = load_module(self.path)
        if not isinstance(getattr(self._module, "EXERCISE", None), Exercise):
            raise DHError(f"{self.path} should end with EXERCISE = Exercise(…).")

    @property
    def vary(self) -> bool:
        """Whether students can get numbers of their own."""
        return all(hasattr(self._module, function) for function in ("draw", "exercise", "cells"))

    @property
    def same_for_all(self) -> tuple[str, ...]:
        """The parts whose answer no draw changes."""
        return tuple(getattr(self._module, "SAME_FOR_ALL", ()))

    def of(self, key: bytes | None = None, student: str | None = None) -> Variant:
        """The variant of a student; without one, that of the book."""
        module: Any = self._module
        if key is None or student is None:
            drawn = getattr(module, "DEFAULT", None)
            exercise, cells = module.EXERCISE, module.cells(drawn) if hasattr(module, "cells") else {}
            return self._variant(exercise, cells, drawn)
        if not self.vary:
            raise DHError(
                f"the exercise {self.name} has no numbers to draw: {self.path} should offer draw(lots), "
                "exercise(given) and cells(given)."
            )
        drawn = module.draw(Lots(key, student, self.name))
        return self._variant(module.exercise(drawn), module.cells(drawn), drawn)

    def _variant(self, exercise: Exercise, cells: Mapping[str, str], drawn: Any) -> Variant:
        figure = getattr(self._module, "figure", None)
        return Variant(exercise, {HOW: how_to(exercise), **cells}, partial(figure, drawn) if figure else None)


def fill(notebook: dict[str, Any], given: Mapping[str, str]) -> None:
    """Write given numbers into the given cells of a notebook; without a figure among them, its cell stays.

    Raises
    ------
    DHError
        If a given cell has no source, or a source no cell.
    """
    left = dict(given)
    for cell in notebook["cells"]:
        about = cell.get("metadata", {}).get("dh", {})
        if about.get("role") != "given":
            continue
        part = about.get("part")
        if part not in left:
            if part == FIGURE:
                continue
            raise DHError(f"the given cell {part!r} has no source: cells(given) should return one under this name.")
        source = left.pop(part)
        if "".join(cell["source"]) != source:
            cell["source"] = source.splitlines(keepends=True)
    left.pop(HOW, None)
    if left:
        raise DHError(f"there is no given cell for {', '.join(left)}: add one, or take it out of cells(given).")
