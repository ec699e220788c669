"""``check("A1", A1)`` in a notebook: says right, or raises one sentence without a traceback."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import load_exercise
from dhlib.grading.marking import Marker
from dhlib.grading.marks import Mark
from dhlib.grading.sections import where


class CheckFailed(Exception):
    """An answer that is not right yet; its text is what to tell the student."""

    def _render_traceback_(self) -> list[str]:
        """What a notebook shows: the sentence alone."""
        return [str(self)]


class Checker:
    """Check the answers of one notebook, in their order.

    Parameters
    ----------
    name : str
        Of the exercise.
    exercises : path, optional
        Folder to look in first.
    """

    def __init__(self, name: str, exercises: str | Path | None = None) -> None:
        self._marker = Marker(load_exercise(name, exercises))

    def __repr__(self) -> str:
        return f"check(part, answer) of the exercise {self._marker.exercise.name}"

    def __call__(self, part_id: str, *answer: Any) -> None:
        """Print that an answer is right.

        Parameters
        ----------
        part_id : str
            Id of the part, such as ``"A1"``.
        answer
            What is handed in.

        Raises
        ------
        CheckFailed
            If it is not right, with one or two sentences that say what is wrong.
        DHError
            If there is no such part.
        """
        part = self._marker.exercise.part(part_id)
        if len(answer) != 1:
            raise CheckFailed(f'{part_id}: check takes a part and one answer: check("{part_id}", {part_id}).')
        mark = self._marker.mark(part_id, read_answer(part.asks.request(), answer[0]))
        if not mark.passed:
            raise CheckFailed(tell(mark))
        print(tell(mark))


def tell(mark: Mark) -> str:
    """A mark as a notebook and a test report tell it."""
    return f"{mark} {where(mark.section)}".rstrip()
