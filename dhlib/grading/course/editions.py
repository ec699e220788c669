"""Editions of a student's notebook: for self-study, where `check` gives the verdict, and for a course.

In a course `check` says of the form alone whether it is right. So that it works wherever the notebook goes, and without
the exercise's file, the notebook itself states the forms.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

import dhlib
from dhlib.errors import DHError
from dhlib.grading.exercise import Exercise
from dhlib.grading.formal import form_of

#: The part of the given cell that says how the page is worked with; its text is written here, for every exercise.
HOW = "how"
IMPORT = re.compile(r"^from dhlib\.grading import checker$", re.MULTILINE)
CALL = re.compile(r"^check = checker\(\"(\w+)\"\)$", re.MULTILINE)


def how_to(exercise: Exercise, *, course: bool = False) -> str:
    """How a notebook is worked with, as Markdown."""
    says = (
        "it says whether the *form* of your answer is right, such as the size of a matrix. Whether the answer is, your "
        "course will tell"
        if course
        else "it says whether you are right, and if not, what to look at"
    )
    wheel = f"dhlib-{dhlib.__version__}-py3-none-any.whl"
    return "\n".join(
        [
            f"**{len(exercise.parts)} parts, {exercise.points:g} points.** Replace each `...` by your answer, keep the "
            f"names of the variables, and run the cell below it: {says}.",
            "Add cells of your own wherever you like; cells that call `check` are best left as they are.",
            "",
            f"*To run this page* on your own machine, put the notebook beside the library, `{wheel}`, which the "
            "book's page of this exercise offers too; then",
            f'`python -m pip install "./{wheel}[notebook]" jupyterlab` and `jupyter lab {exercise.name}.ipynb`.',
        ]
    )


def for_course(notebook: dict[str, Any], exercise: Exercise) -> dict[str, Any]:
    """A student's notebook whose `check` looks at the form alone.

    Parameters
    ----------
    notebook : dict
        Derived from the solution, as plain JSON.
    exercise : Exercise

    Raises
    ------
    DHError
        If no setup cell makes `check` in the usual two lines.
    """
    cells = []
    changed = 0
    for cell in notebook["cells"]:
        about = cell["metadata"]["dh"]
        source = "".join(cell["source"])
        if about["role"] == "setup" and (call := CALL.search(source)) and IMPORT.search(source):
            source = IMPORT.sub("from dhlib.grading import form_checker", source)
            source = CALL.sub(lambda _: _statement(exercise), source)
            changed += call[1] == exercise.name
        elif about["role"] == "given" and about.get("part") == HOW:
            source = how_to(exercise, course=True)
        cells.append({**cell, "source": source.splitlines(keepends=True)})
    if changed != 1:
        raise DHError(
            f"{exercise.name}: one setup cell should hold the lines 'from dhlib.grading import checker' and "
            f"'check = checker(\"{exercise.name}\")'."
        )
    return {**notebook, "cells": cells}


def _statement(exercise: Exercise) -> str:
    forms: Mapping[str, Any] = {part.id: form_of(part) for part in exercise.parts}
    lines = "".join(f"        {json.dumps(part)}: {json.dumps(form)},\n" for part, form in forms.items())
    return f'check = form_checker(\n    "{exercise.name}",\n    {{\n{lines}    }},\n)'
