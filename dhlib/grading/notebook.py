"""Notebooks: which cell plays which role, and how a submission is put into the pristine exercise.

A cell of an exercise carries ``{"dh": {"role": …, "part": …}}`` in its metadata. Roles are ``setup``, ``answer``,
``check``, and ``text`` or ``solution`` for Markdown.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dhlib.errors import DHError

#: A larger file is no exercise; what makes notebooks large is stored output, which is not read anyway.
LARGEST_FILE = 50_000_000
#: The call that every check cell holds, to find the cells of a notebook that lost its metadata.
CHECK_CALL = re.compile(r"""^\s*check\(\s*["'](\w+)["']\s*,\s*(\w+)\s*\)\s*$""", re.MULTILINE)


@dataclass(frozen=True)
class Cell:
    """A cell as far as grading reads it."""

    source: str
    code: bool = True
    role: str = ""
    part: str = ""

    @property
    def known(self) -> bool:
        """Whether it is a cell of the exercise, not one that the student added."""
        return bool(self.role)


def read_cells(notebook: dict[str, Any]) -> list[Cell]:
    """The cells of a notebook, read leniently: any version that has cells, with or without metadata."""
    return [_read_cell(cell) for cell in _raw_cells(notebook)]


def load_notebook(path: str | Path) -> dict[str, Any]:
    """A notebook as plain JSON.

    Raises
    ------
    DHError
        If the file cannot be read, or is no notebook.
    """
    path = Path(path)
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise DHError(
                f"{path.name} is larger than {LARGEST_FILE // 1_000_000} MB; clear its outputs and save it again."
            )
        data = path.read_bytes()
    except OSError as error:
        raise DHError(f"{path.name} cannot be opened: {error.strerror or type(error).__name__}.") from None
    return parse_notebook(data, path.name)


def parse_notebook(data: bytes, name: str) -> dict[str, Any]:
    """A notebook as plain JSON, out of the bytes of a file of this name.

    Raises
    ------
    DHError
        If it is no notebook.

    Examples
    --------
    >>> parse_notebook(b"%PDF", "essay.ipynb")
    Traceback (most recent call last):
    dhlib.errors.DHError: essay.ipynb is no notebook, or was cut off: it cannot be read as JSON.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise DHError(f"{name} is no notebook: it is not text. Was another file handed in?") from None
    if not text.strip():
        raise DHError(f"{name} is empty.")
    try:
        notebook = json.loads(text)
    except (ValueError, RecursionError):
        raise DHError(f"{name} is no notebook, or was cut off: it cannot be read as JSON.") from None
    if not isinstance(notebook, dict) or not _raw_cells(notebook):
        raise DHError(f"{name} holds no cells; it should be a Jupyter notebook.")
    return notebook


def merge(pristine: Iterable[Cell], submission: Iterable[Cell]) -> list[Cell]:
    """Code cells to run: the pristine exercise, with the answers and the extra cells of a submission.

    Answer cells replace those of the exercise. Extra cells keep their place behind the cell of the exercise that they
    follow. Whatever else was changed or deleted counts for nothing.

    Examples
    --------
    >>> exercise = [Cell("A = ...", role="answer", part="A"), Cell('check("A", A)', role="check", part="A")]
    >>> handed_in = [Cell("x = 1"), Cell("A = x", role="answer", part="A"), Cell("pass", role="check", part="A")]
    >>> setup = Cell("import math", role="setup")
    >>> [cell.source for cell in merge([setup, *exercise], handed_in)]
    ['import math', 'x = 1', 'A = x', 'check("A", A)']
    """
    pristine = [cell for cell in pristine if cell.code]
    places = {(cell.role, cell.part) for cell in pristine}
    answers: dict[str, list[Cell]] = {}
    extras: dict[tuple[str, str], list[Cell]] = {}
    start = ("", "")
    place = start
    for cell in recover_roles(submission):
        if cell.role == "answer" and ("answer", cell.part) in places:
            place = (cell.role, cell.part)
            answers.setdefault(cell.part, []).append(cell)
        elif (cell.role, cell.part) in places:
            place = (cell.role, cell.part)
        elif cell.code and not cell.known:
            extras.setdefault(place, []).append(cell)
    merged: list[Cell] = []
    for k, cell in enumerate(pristine):
        merged += answers.get(cell.part, [cell]) if cell.role == "answer" else [cell]
        merged += extras.get((cell.role, cell.part), ())
        if k == 0:  # cells before the first one of the exercise run after it, since it holds the imports
            merged += extras.get(start, ())
    return merged


def recover_roles(cells: Iterable[Cell]) -> list[Cell]:
    """Give cells that lost their metadata their roles back.

    A cell that calls ``check("A1", A1)`` is the check of A1, and the last code cell before it that assigns or defines
    A1 is the answer.
    """
    listed = list(cells)
    if any(cell.role == "answer" for cell in listed):
        return listed
    for k, cell in enumerate(listed):
        if cell.code and (call := CHECK_CALL.search(cell.source)):
            part = call[1]
            sets = re.compile(rf"^\s*(?:{part}\b[^=\n]*=(?!=)|def\s+{part}\b)", re.MULTILINE)
            for j in range(k, -1, -1):
                if listed[j].code and sets.search(listed[j].source):
                    listed[j] = Cell(listed[j].source, True, "answer", part)
                    break
            if listed[k].role != "answer":
                listed[k] = Cell(cell.source, True, "check", part)
    return listed


def _raw_cells(notebook: dict[str, Any]) -> list[Any]:
    cells = notebook.get("cells")
    if cells is None:  # nbformat 3 keeps them in worksheets
        sheets = notebook.get("worksheets")
        cells = (
            [cell for sheet in sheets if isinstance(sheet, dict) for cell in sheet.get("cells", ())]
            if isinstance(sheets, list)
            else []
        )
    return cells if isinstance(cells, list) else []


def _read_cell(cell: Any) -> Cell:
    cell = _dict(cell)
    about = _dict(_dict(cell.get("metadata")).get("dh"))
    source = cell.get("source", cell.get("input", ""))
    if isinstance(source, list):
        source = "".join(line for line in source if isinstance(line, str))
    role, part = about.get("role"), about.get("part")
    return Cell(
        source if isinstance(source, str) else "",
        cell.get("cell_type") == "code",
        role if isinstance(role, str) else "",
        part if isinstance(part, str) else "",
    )


def _dict(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
