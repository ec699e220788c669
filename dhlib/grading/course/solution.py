"""``dhlib solution``: the worked notebook of one student's numbers, run and proved right."""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.assign import Assigning, file_name
from dhlib.grading.course.keys import read_key
from dhlib.grading.course.worked import execute
from dhlib.grading.derive import as_text
from dhlib.grading.exercise import exercise_folders
from dhlib.grading.grade import GRADED, grade_notebook
from dhlib.grading.notebook import load_notebook


def solve(
    name: str,
    student: str,
    key: bytes,
    *,
    exercises: Path | None = None,
    solutions: Path | None = None,
    due: str = "",
) -> tuple[dict[str, Any], float]:
    """The worked notebook of a student, with its outputs, and the points that it earns: all of them.

    Raises
    ------
    DHError
        If there is no worked notebook, or it does not solve these numbers.
    """
    path = find_solution(name, exercises, solutions)
    notebook = Assigning(name, key, exercises, due).notebook(student, load_notebook(path))
    with tempfile.TemporaryDirectory() as folder:
        notebook = execute(notebook, folder)
        written = Path(folder) / path.name
        written.write_text(as_text(notebook), encoding="utf-8")
        result = grade_notebook(written, exercises=exercises, key=key)
    wrong = [mark for mark in result.marks if mark.points < mark.out_of]
    if result.status != GRADED or wrong:
        why = "; ".join(map(str, wrong)) or result.message
        raise DHError(f"{path} does not solve the numbers of {student!r}: {why}")
    return notebook, result.points


def find_solution(name: str, exercises: Path | None = None, solutions: Path | None = None) -> Path:
    """The worked notebook of an exercise: in the folder named, or in ``solutions`` beside that of the exercises.

    Raises
    ------
    DHError
        If there is none.
    """
    folders = [solutions] if solutions else [folder.parent / "solutions" for folder in exercise_folders(exercises)]
    for folder in folders:
        if (folder / f"{name}.ipynb").is_file():
            return folder / f"{name}.ipynb"
    looked = ", ".join(dict.fromkeys(str(folder) for folder in folders))
    raise DHError(f"there is no worked notebook {name}.ipynb in {looked}; name its folder with --solutions.")


def add_solution(commands: Any) -> None:
    """Add ``solution`` to the commands of the parser."""
    parser = commands.add_parser(
        "solution",
        help="write the worked notebook of one student's numbers",
        description="Write the worked notebook with one student's numbers, run it, and grade it: it is written only if "
        "every part is right.",
    )
    parser.add_argument("name", metavar="NAME", help="of the exercise")
    parser.add_argument("--student", required=True, metavar="ID", help="as in the class list")
    parser.add_argument("--key", type=Path, required=True, metavar="FILE", help="of the course")
    parser.add_argument("--out", type=Path, metavar="FILE", help="the notebook to write; NAME-ID-solution.ipynb")
    parser.add_argument("--exercises", type=Path, metavar="DIR", help="where to look for exercises first")
    parser.add_argument("--solutions", type=Path, metavar="DIR", help="where the worked notebooks are")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    usual = Path(file_name(options.name, options.student))
    out = options.out or usual.with_name(f"{usual.stem}-solution.ipynb")
    if out.exists():
        raise DHError(f"{out} is there already; name another file with --out.")
    if not options.student.strip():
        raise DHError("--student should be an ID of the class list.")
    notebook, points = solve(
        options.name,
        options.student,
        read_key(options.key),
        exercises=options.exercises,
        solutions=options.solutions,
    )
    try:
        out.write_text(as_text(notebook), encoding="utf-8")
    except OSError as error:
        raise DHError(f"{out} cannot be written: {error.strerror}.") from None
    print(f"{out}: the numbers of {options.student}, {points:g} of {points:g} points")
    return 0
