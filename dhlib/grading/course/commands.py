"""The commands of a course: ``key``, ``assign``, ``solution`` and ``new-exercise``."""

from __future__ import annotations

from typing import Any

from dhlib.grading.course.assign import add_assign
from dhlib.grading.course.keys import add_key
from dhlib.grading.course.new import add_new_exercise
from dhlib.grading.course.solution import add_solution


def add_course(commands: Any) -> None:
    """Add them to the commands of the parser."""
    for add in (add_key, add_assign, add_solution, add_new_exercise):
        add(commands)
