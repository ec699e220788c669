"""The zip with which Gradescope grades by itself."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

from dhlib.grading.exercise import find_exercise
from dhlib.grading.reports.formats import Files
from dhlib.grading.reports.wheel import wheel
from dhlib.grading.reports.zips import packed

SCRIPTS = ("setup.sh", "run_autograder")
NAME = "gradescope-autograder.zip"


def write(exercise: str, folder: Path | None = None) -> Files:
    """One zip: two scripts at its root, the wheel, and the exercise where it is not one that comes with dhlib.

    Raises
    ------
    DHError
        If there is no such exercise.
    """
    name, content = wheel()
    inside = {script: template(script, exercise) for script in SCRIPTS}
    inside[name] = content
    for suffix in (".py", ".ipynb"):
        path = find_exercise(exercise, suffix, folder)
        if folder:
            inside[f"exercises/{path.name}"] = path.read_bytes()
    return {NAME: packed(inside, executable=SCRIPTS)}


def template(name: str, exercise: str) -> bytes:
    """A script for one exercise, whose name `find_exercise` has checked to be a plain word."""
    text = (files("dhlib.grading.reports") / "templates" / name).read_text("utf-8")
    return text.replace("@EXERCISE@", exercise).encode()
