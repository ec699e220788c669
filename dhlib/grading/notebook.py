"""Notebooks: which cell plays which role, and how a submission is put into the pristine exercise.

A cell of an exercise carries ``{"dh": {"role": …, "part": …}}`` in its metadata. Roles are ``setup``, ``answer``,
``check``, and ``text`` or ``solution`` for Markdown.
"""

from __future__ import annotations

import codecs
import json
import os
import re
import stat
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from dhlib.errors import DHError

#: A larger file is no exercise; what makes notebooks large is stored output, which is not read anyway.
LARGEST_FILE = 50_000_000
MOST_CELLS = 2000
#: An integer of more digits stands in no notebook that was not made to break its reader.
LONGEST_INTEGER = 20
#: Where a notebook says what is wrong with it as a file, although it can be read.
DAMAGE = "dh_damage"
#: How files begin that are handed in for notebooks.
KINDS = {
    b"%PDF": "a PDF",
    b"PK\x03\x04": "a zip archive, or an office document",
    b"\x1f\x8b": "a compressed archive",
    b"Rar!": "an archive",
    b"7z\xbc\xaf": "an archive",
    b"\x89PNG": "an image",
    b"\xff\xd8\xff": "an image",
    b"\xd0\xcf\x11\xe0": "an office document",
    b"<": "a web page",
}
BYTE_ORDERS = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
CELLS = re.compile(r'"cells"[ \t\r\n]*:[ \t\r\n]*\[')
BETWEEN = re.compile(r"[ \t\r\n]*,?[ \t\r\n]*")
#: The call that every check cell holds, to find the cells of a notebook that lost its metadata.
CHECK_CALL = re.compile(r"""^[ \t]*check\([ \t]*["'](\w+)["'][ \t]*,[ \t]*(\w+)[ \t]*\)[ \t]*$""", re.MULTILINE)


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
    return parse_notebook(read_bytes(path), path.name)


def read_bytes(path: Path) -> bytes:
    """What stands in a file that may be anything, and no more of it than a notebook could hold.

    Raises
    ------
    DHError
        If it cannot be read.
    """
    try:
        # What it is, is asked of the open file: a name may stand for another file a moment later, and a pipe waits.
        fd = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
        with open(fd, "rb") as file:
            if not stat.S_ISREG(os.fstat(fd).st_mode):
                raise DHError(f"{path.name} is no file.")
            return file.read(LARGEST_FILE + 1)
    except OSError as error:
        raise DHError(f"{path.name} cannot be opened: {error.strerror or type(error).__name__}.") from None


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
    dhlib.errors.DHError: essay.ipynb is no notebook but a PDF. Was another file handed in?
    """
    if len(data) > LARGEST_FILE:
        raise DHError(f"{name} is larger than {LARGEST_FILE // 1_000_000} MB; clear its outputs and save it again.")
    text = _decode(data, name)
    if not text.strip():
        raise DHError(f"{name} is empty.")
    wrong = ""
    try:
        notebook = json.loads(text, parse_int=_integer)
    except (ValueError, RecursionError):
        notebook = {"cells": _whole_cells(text)}
        if not notebook["cells"]:
            raise DHError(f"{name} is no notebook, or was cut off: it cannot be read as JSON.") from None
        wrong = f"{name} was cut off or damaged: only its first {len(notebook['cells'])} cells could be read."
    if not isinstance(notebook, dict) or not _raw_cells(notebook):
        raise DHError(f"{name} holds no cells; it should be a Jupyter notebook.")
    if len(_raw_cells(notebook)) > MOST_CELLS:
        raise DHError(f"{name} holds more than {MOST_CELLS} cells, which no exercise does.")
    if language := _other_language(notebook):
        wrong = f"{name} says that it is written in {language}; it was run as Python."
    notebook.pop(DAMAGE, None)
    return {**notebook, DAMAGE: wrong} if wrong else notebook


def damage(notebook: dict[str, Any]) -> str:
    """What is wrong with the file of a notebook that could be read all the same; empty if nothing is."""
    return str(notebook.get(DAMAGE, ""))


def _decode(data: bytes, name: str) -> str:
    for mark, encoding in BYTE_ORDERS.items():
        if data.startswith(mark):
            return data.decode(encoding, errors="replace")
    start = data[:4096].lstrip(codecs.BOM_UTF8).lstrip()
    if not start.startswith(b"{"):
        for magic, kind in KINDS.items():
            if start.startswith(magic):
                raise DHError(f"{name} is no notebook but {kind}. Was another file handed in?")
        if b"\0" in start:
            raise DHError(f"{name} is no notebook: it is not text. Was another file handed in?")
    # A byte that is no UTF-8 stands in an output or a comment; it costs no answer.
    return data.decode("utf-8-sig", errors="replace")


def _integer(text: str) -> int:
    return int(text) if len(text) <= LONGEST_INTEGER else 0


def _whole_cells(text: str) -> list[Any]:
    """The cells before the place where a file was cut off or damaged."""
    begin = CELLS.search(text)
    decoder = json.JSONDecoder(parse_int=_integer)
    cells: list[Any] = []
    at = begin.end() if begin else len(text)
    while len(cells) <= MOST_CELLS:
        between = BETWEEN.match(text, at)
        try:
            cell, at = decoder.raw_decode(text, between.end() if between else at)
        except (ValueError, RecursionError):
            break
        cells.append(cell)
    return cells


def _other_language(notebook: dict[str, Any]) -> str:
    """The language that the notebook says it is written in, if that is not Python."""
    metadata = _dict(notebook.get("metadata"))
    language = _dict(metadata.get("kernelspec")).get("language") or _dict(metadata.get("language_info")).get("name")
    if not isinstance(language, str) or language.lower() in ("", "python", "ipython", "python3"):
        return ""
    return "".join(c for c in language if c.isalnum() or c in "+#")[:30] or "another language"


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
        elif cell.code and not cell.known and cell.source.strip():
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
            sets = re.compile(rf"^[ \t]*(?:{part}\b[^=\n]*=(?!=)|def\s+{part}\b)", re.MULTILINE)
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
            [cell for sheet in sheets if isinstance(sheet, dict) for cell in _list(sheet.get("cells"))]
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
    if isinstance(source, str):  # half of a pair of surrogates is no text, and nothing can write it
        source = source.encode("utf-8", "replace").decode("utf-8")
    role, part = about.get("role"), about.get("part")
    return Cell(
        source if isinstance(source, str) else "",
        cell.get("cell_type") == "code",
        role if isinstance(role, str) else "",
        part if isinstance(part, str) else "",
    )


def _dict(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []
