"""Marking exercises: what is asked, what was answered, what it is worth.

Imports run one way, and the two halves never meet in one process when strangers' notebooks are graded:

* untrusted, beside the student's code: `answers` reads an answer into plain JSON; `wall` runs a notebook;
* trusted, beside the references: `forms` and `exercise` say what is asked, `misconceptions` what goes wrong,
  `marking` judges, and `check`, `plugin` and `grade` are its faces.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

    from dhlib.grading.check import Checker, FormChecker

__all__ = ["checker", "form_checker"]


def checker(name: str, exercises: str | None = None) -> Checker:
    """The function ``check(part, answer)`` of an exercise, for its notebook.

    Parameters
    ----------
    name : str
        Such as ``"quickshot"``.
    exercises : str, optional
        Folder to look in first; else ``./exercises``, else the exercises that come with dhlib.

    Returns
    -------
    Checker

    Raises
    ------
    DHError
        If there is no such exercise.

    Examples
    --------
    >>> check = checker("quickshot")
    >>> check
    check(part, answer) of the exercise quickshot
    """
    from dhlib.grading.check import Checker

    return Checker(name, exercises)


def form_checker(name: str, forms: Mapping[str, Mapping[str, Any]]) -> FormChecker:
    """The function ``check(part, answer)`` of a notebook that a course grades: it says of the form alone what is wrong.

    Parameters
    ----------
    name : str
        Of the exercise.
    forms : mapping
        Part to its form, as the notebook states it.

    Returns
    -------
    FormChecker

    Examples
    --------
    >>> form_checker("quickshot", {"slip": {"form": "choice", "options": ["n_x", "n_y"]}})("slip", "n_y")
    slip: the form is right, one of n_x, n_y. The course will say whether the answer is.
    """
    from dhlib.grading.check import FormChecker

    return FormChecker(name, forms)
