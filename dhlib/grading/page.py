"""The page's check: the very marker of the notebook, asked for one part by the book's page of an exercise.

The page runs the cells of the exercise, whose first makes ``check``, and then asks here about one of the answers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from dhlib.grading.answers import MISSING
from dhlib.grading.check import Checker, CheckFailed, FormChecker, tell
from dhlib.grading.marks import stopped_with

GONE = "The name check no longer stands for what the first cell made of it. Reset that cell, run it, and check again."


def check(names: Mapping[str, Any], part_id: str, error: str = "") -> dict[str, Any]:
    """Say what the notebook's ``check(part, answer)`` says, and what the answer earns.

    Parameters
    ----------
    names : mapping
        The variables of the exercise: its ``check``, and the answers.
    part_id : str
        Id of the part, which is the name of its answer too.
    error : str
        What the cell of the answer stopped with; what its variable still holds from before is then no answer.

    Returns
    -------
    dict
        ``passed``; ``says``, in the words of the notebook; ``points``, which is None where only the form is checked.

    Examples
    --------
    >>> from dhlib.grading import checker
    >>> check({"check": checker("quickshot"), "slip": "n_z"}, "slip")["says"][:14]
    'slip: not yet.'
    """
    checker = names.get("check")
    if isinstance(checker, FormChecker):
        return _form(checker, part_id, ... if error else names.get(part_id, ...))
    if not isinstance(checker, Checker):
        return {"passed": False, "says": GONE, "points": None}
    for earlier in checker.leads_to(part_id):
        checker.mark(earlier, names.get(earlier, MISSING))
    mark = checker.mark(part_id, MISSING if error else names.get(part_id, MISSING))
    if error:
        mark = replace(mark, message=stopped_with(error))
    return {"passed": mark.passed, "says": tell(mark), "points": mark.points}


def _form(checker: FormChecker, part_id: str, answer: Any) -> dict[str, Any]:
    try:
        return {"passed": True, "says": checker.says(part_id, answer), "points": None}
    except CheckFailed as failed:
        return {"passed": False, "says": str(failed), "points": None}
