"""``check("A1", A1)`` in a notebook: says right, or raises one sentence without a traceback.

Where answers are graded by a course it says of the form alone whether that is right, and knows nothing more itself.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import load_exercise
from dhlib.grading.formal import fault_of, wanted
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
        mark = self.mark(part_id, _one(part_id, answer))
        if not mark.passed:
            raise CheckFailed(tell(mark))
        print(tell(mark))

    def mark(self, part_id: str, answer: Any) -> Mark:
        """The mark of an answer; DHError if there is no such part."""
        part = self._marker.exercise.part(part_id)
        return self._marker.mark(part_id, read_answer(part.asks.request(), answer))

    def leads_to(self, part_id: str) -> list[str]:
        """The earlier parts that a part follows from, and those that they follow from, in their order."""
        exercise = self._marker.exercise
        needed, waiting = set(), [part_id]
        while waiting:
            follows = exercise.part(waiting.pop()).follows
            for earlier in follows.parts if follows else ():
                if earlier not in needed:
                    needed.add(earlier)
                    waiting.append(earlier)
        return [part.id for part in exercise.parts if part.id in needed]


class FormChecker:
    """Check the form of answers, for a notebook whose answers a course grades.

    Parameters
    ----------
    name : str
        Of the exercise.
    forms : mapping
        Part to its form, plain JSON as `formal.form_of` makes it: all that there is to know here.

    Examples
    --------
    >>> check = FormChecker("quickshot", {"A1": {"form": "numbers", "shape": [2]}})
    >>> check("A1", [1, 2])
    A1: the form is right, a vector of 2 numbers. The course will say whether the answer is.
    """

    def __init__(self, name: str, forms: Mapping[str, Mapping[str, Any]]) -> None:
        self._name, self._forms = name, dict(forms)

    def __repr__(self) -> str:
        return f"check(part, answer) of the form of answers to the exercise {self._name}"

    def __call__(self, part_id: str, *answer: Any) -> None:
        """Print that the form of an answer is right.

        Raises
        ------
        CheckFailed
            If it is not, with one or two sentences that say in what respect.
        DHError
            If there is no such part.
        """
        print(self.says(part_id, _one(part_id, answer)))

    def says(self, part_id: str, answer: Any) -> str:
        """The words for an answer whose form is right; raises what a call raises."""
        form = self._forms.get(part_id)
        if form is None:
            known = ", ".join(self._forms)
            raise DHError(f"the exercise {self._name} has no part {part_id!r}; its parts are {known}.")
        headline, message = fault_of(part_id, form, answer)
        if headline:
            raise CheckFailed(f"{part_id}: {headline}. {message}")
        return f"{part_id}: the form is right, {wanted(form)}. The course will say whether the answer is."


def _one(part_id: str, answer: tuple[Any, ...]) -> Any:
    if len(answer) != 1:
        raise CheckFailed(f'{part_id}: check takes a part and one answer: check("{part_id}", {part_id}).')
    return answer[0]


def tell(mark: Mark) -> str:
    """A mark as a notebook and a test report tell it."""
    return f"{mark} {where(mark.section)}".rstrip()
