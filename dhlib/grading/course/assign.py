"""``dhlib assign``: one notebook for each student of a class, with numbers of their own."""

from __future__ import annotations

import argparse
import csv
import hashlib
import shutil
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.editions import for_course
from dhlib.grading.course.keys import read_key
from dhlib.grading.course.lots import who
from dhlib.grading.course.papers import as_metadata, make_tag
from dhlib.grading.course.roster import read_roster
from dhlib.grading.course.variants import Variants, fill
from dhlib.grading.derive import as_text
from dhlib.grading.exercise import find_exercise
from dhlib.grading.notebook import load_notebook
from dhlib.grading.reports.cells import safe

#: What may stand in a file name on every system, besides letters and digits.
HARMLESS = "-_.@+"
LONGEST_NAME = 60
LIST = "assigned.csv"


class Assigning:
    """Makes the notebooks of one exercise.

    Parameters
    ----------
    name : str
    key : bytes
    folder : path, optional
        Where to look for the exercise first.
    due : str, optional
    """

    def __init__(self, name: str, key: bytes, folder: str | Path | None = None, due: str = "") -> None:
        self._variants = Variants(name, folder)
        self._pristine = load_notebook(find_exercise(name, ".ipynb", folder))
        self._key, self._due = key, due

    def notebook(self, student: str, source: dict[str, Any] | None = None) -> dict[str, Any]:
        """The notebook of one student: of the pristine one, or of another that has the same given cells."""
        source = source or self._pristine
        variant = self._variants.of(self._key, student)
        notebook = {**source, "cells": [dict(cell) for cell in source["cells"]]}
        fill(notebook, variant.cells())
        notebook = for_course(notebook, variant.exercise)
        tag = make_tag(self._key, self._variants.name, student, self._due)
        return {**notebook, "metadata": {**notebook["metadata"], "dh": as_metadata(tag)}}


def file_name(exercise: str, student: str) -> str:
    """The name of a student's file: safe on every system, and no other student's.

    Examples
    --------
    >>> file_name("quickshot", "ada.byron@example.org")
    'quickshot-ada.byron@example.org.ipynb'
    >>> file_name("quickshot", "../../etc/passwd")
    'quickshot-.._.._etc_passwd-3754d6cb.ipynb'
    """
    safe = "".join(c if c.isalnum() or c in HARMLESS else "_" for c in student)[:LONGEST_NAME]
    if safe != who(student):  # what was changed could be another's name: tell them apart
        safe += "-" + hashlib.sha256(who(student).encode()).hexdigest()[:8]
    return f"{exercise}-{safe}.ipynb"


def assign(
    name: str, students: Sequence[str], key: bytes, out: Path, folder: Path | None = None, due: str = ""
) -> list[Path]:
    """Write the notebooks of a class into a new folder: all of them, or none.

    Returns
    -------
    list of Path
        The notebooks, in the order of the students.

    Raises
    ------
    DHError
        If something is in the way, or the exercise has no numbers to draw.
    """
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise DHError(
            f"{out} is there already, and nothing is written over what was handed out. Choose another folder."
        )
    assigning = Assigning(name, key, folder, due)
    names = [file_name(name, student) for student in students]
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{out.name}-", dir=out.parent) as working:
            whole = Path(working) / "whole"
            whole.mkdir()
            for file, student in zip(names, _with_bar(students), strict=True):
                (whole / file).write_text(as_text(assigning.notebook(student)), encoding="utf-8")
            with (whole / LIST).open("w", encoding="utf-8-sig", newline="") as stream:
                writer = csv.writer(stream)
                writer.writerow(["student", "notebook"])
                writer.writerows((safe(student), file) for student, file in zip(students, names, strict=True))
            if out.exists():
                out.rmdir()
            shutil.move(whole, out)
    except OSError as error:
        raise DHError(f"{out} cannot be written: {error.strerror}.") from None
    return [out / file for file in names]


def read_due(text: str) -> str:
    """A date, perhaps with a time, as it is stored.

    Raises
    ------
    DHError
        If it is none.

    Examples
    --------
    >>> read_due("2030-01-31"), read_due("2030-01-31 23:59")
    ('2030-01-31', '2030-01-31T23:59:00')
    """
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise DHError(f"--due {text!r} is no date; write it like 2030-01-31, or '2030-01-31 23:59'.") from None
    return text if len(text) == len("2030-01-31") else moment.isoformat()


def add_assign(commands: Any) -> None:
    """Add ``assign`` to the commands of the parser."""
    parser = commands.add_parser(
        "assign",
        help="write a notebook for each student of a class, with numbers of their own",
        description="Write a notebook for each student of a class list, with numbers that the key and the student's ID "
        "decide. Nothing is stored: `dhlib grade --key` draws the same numbers again.",
    )
    parser.add_argument("name", metavar="NAME", help="of the exercise")
    parser.add_argument("--roster", type=Path, required=True, metavar="CSV", help="class list, with a column of IDs")
    parser.add_argument("--column", default="", metavar="HEADING", help="which column holds the IDs")
    parser.add_argument("--key", type=Path, required=True, metavar="FILE", help="of the course: see `dhlib key`")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="a new folder for the notebooks")
    parser.add_argument("--due", type=str, default="", metavar="DATE", help="such as 2030-01-31, kept in the notebooks")
    parser.add_argument("--exercises", type=Path, metavar="DIR", help="where to look for exercises first")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    due = read_due(options.due) if options.due else ""
    key, students = read_key(options.key), read_roster(options.roster, options.column)
    paths = assign(options.name, students, key, options.out, options.exercises, due)
    print(f"{len(paths)} notebooks in {options.out}; {options.out / LIST} says whose is which.")
    return 0


def _with_bar(students: Sequence[str]) -> Iterator[str]:
    """The students, with a bar where somebody looks on."""
    bar: Iterable[str] = students
    if sys.stderr.isatty():
        try:
            from tqdm import tqdm
        except ImportError:
            pass
        else:
            bar = tqdm(students, unit="notebook")
    yield from bar
