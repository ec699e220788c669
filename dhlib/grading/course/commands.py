"""The commands of a course: ``key``, ``assign`` and ``solution``."""

from __future__ import annotations

from typing import Any

from dhlib.grading.course.assign import add_assign
from dhlib.grading.course.keys import add_key
from dhlib.grading.course.solution import add_solution


def add_course(commands: Any) -> None:
    """Add them to the commands of the parser."""
    for add in (add_key, add_assign, add_solution):
        add(commands)
