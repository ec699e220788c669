"""A workflow with which GitHub grades each push, and the points as its classroom reads them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

from dhlib.grading.exercise import find_exercise
from dhlib.grading.marks import HEADLINES
from dhlib.grading.reports.autograder import template
from dhlib.grading.reports.cells import number
from dhlib.grading.reports.formats import Files, Wishes, known
from dhlib.grading.reports.records import Record
from dhlib.grading.reports.wheel import wheel


def write(exercise: str, folder: Path | None = None) -> Files:
    """The workflow, and the wheel that it installs: for the repository that students start from."""
    find_exercise(exercise, ".py", folder)
    name, content = wheel()
    return {
        ".github/workflows/classroom.yml": template("classroom.yml", exercise),
        f".github/dhlib/{name}": content,
    }


def report(records: Sequence[Record], wishes: Wishes) -> Files:
    """A summary for people, and the two notices by which a classroom knows the points."""
    records = known(records)
    points = round(sum(record.points for record in records), 2)
    out_of = round(sum(record.out_of for record in records), 2)
    notices = [
        f"::notice title=Autograding complete::Points {number(points)}/{number(out_of)}",
        f"::notice title=Autograding report::{json.dumps({'totalPoints': points, 'maxPoints': out_of})}",
    ]
    lines = []
    for record in records:
        lines += [f"## {plain(record.exercise)}: {number(record.points)} of {number(record.out_of)} points", ""]
        if record.submission.message:
            lines += [plain(record.submission.message), ""]
        lines += ["| part | points | | |", "| --- | ---: | --- | --- |"]
        lines += [
            f"| {plain(a.row.part)} | {number(a.points)} of {number(a.row.out_of)} | {HEADLINES[a.row.verdict]} | "
            f"{plain(a.row.message)} |"
            for a in record.answers
        ]
        lines.append("")
    return {"github.txt": ("\n".join(notices) + "\n").encode(), "github.md": "\n".join(lines).encode()}


def plain(text: str) -> str:
    """Text in which Markdown sees no markup, on one line.

    Examples
    --------
    >>> plain("<b>x|y</b>")
    '&#60;b&#62;x&#124;y&#60;/b&#62;'
    """
    line = " ".join(text.split())
    return "".join(f"&#{ord(c)};" if c in "<>|&`*_[]!#\\@~$" else c for c in line)
