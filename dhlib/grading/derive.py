"""Student editions: ``python -m dhlib.grading.derive`` makes exercises/NAME.ipynb from solutions/NAME.ipynb.

A solution notebook is the only source. In its code cells a region

    ### solution
    A1 = classic(…)
    ### yours
    # A1 = ...
    ### end

becomes ``A1 = ...``. Markdown cells with the role ``solution`` fall away. Nothing else of a cell is kept than its id,
its kind, its source and its role, so that no output, attachment or metadata can carry a solution along.

Cells with the role ``given`` state the numbers of the task. What stands in them is written by the exercise's own file
(see `course.variants`): first the solution gets what its file says today, and then the exercise is derived.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.variants import fill, load_variant
from dhlib.grading.notebook import CHECK_CALL, load_notebook

MARKS = ("### solution", "### yours", "### end")
ROLES = ("setup", "text", "given", "answer", "check", "solution")
CELL_ID = re.compile(r"[a-zA-Z0-9_-]{1,64}")
KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}


def derive(solution: dict[str, Any], name: str) -> dict[str, Any]:
    """The student edition of a solution notebook, as plain JSON.

    Parameters
    ----------
    solution : dict
        The notebook, as JSON.
    name : str
        Of the exercise; it goes into the metadata.

    Raises
    ------
    DHError
        If a cell has no role or a doubled id, or a region is not closed; the message names the cell.
    """
    cells: list[dict[str, Any]] = []
    ids: set[str] = set()
    places: set[tuple[str, str | None]] = set()
    for k, cell in enumerate(solution["cells"], 1):
        here = f"{name}, cell {k} ({cell.get('id', 'without id')})"
        about = cell.get("metadata", {}).get("dh", {})
        role, part = about.get("role"), about.get("part")
        cell_id = cell.get("id", "")
        if role not in ROLES:
            raise DHError(f'{here}: metadata "dh" should have a role, one of {", ".join(ROLES)}.')
        if not CELL_ID.fullmatch(cell_id) or cell_id in ids:
            raise DHError(f"{here}: the id should be there, and once only.")
        ids.add(cell_id)
        if role == "given" and not part:
            raise DHError(f"{here}: a given cell should name its part, as cells(given) in {name}.py does.")
        if (cell["cell_type"] == "code" or role == "given") and (role, part) in places:
            raise DHError(f"{here}: there is a cell of this role and part already; give it a part of its own.")
        places.add((role, part))
        if role == "solution":
            continue
        source = "".join(cell["source"])
        if cell["cell_type"] == "code":
            source = open_regions(source, here)
        if role == "check" and (not (call := CHECK_CALL.fullmatch(source)) or call[1] != part or call[2] != part):
            raise DHError(f'{here}: the check cell of {part} should be: check("{part}", {part}).')
        cells.append(_bare_cell(cell["cell_type"], cell_id, {"role": role, **({"part": part} if part else {})}, source))
    return {
        "cells": cells,
        "metadata": {"dh": {"exercise": name}, "kernelspec": KERNEL, "language_info": {"name": "python"}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }


def _bare_cell(kind: str, cell_id: str, about: dict[str, str], source: str) -> dict[str, Any]:
    cell: dict[str, Any] = {
        "cell_type": kind,
        "id": cell_id,
        "metadata": {"dh": about},
        "source": source.splitlines(keepends=True),
    }
    return cell | {"execution_count": None, "outputs": []} if kind == "code" else cell


def open_regions(source: str, here: str = "the cell") -> str:
    r"""Source with every solution region replaced by its stub.

    Examples
    --------
    >>> open_regions("x = 1\n### solution\nA = x + 1\n### yours\n# A = ...\n### end")
    'x = 1\nA = ...'
    """
    lines: list[str] = []
    state = MARKS[2]
    for line in source.splitlines():
        mark = line.strip()
        if mark in MARKS:
            before = MARKS[MARKS.index(mark) - 1]
            if state != before:
                raise DHError(f"{here}: {mark!r} stands where {before!r} should come first.")
            state = mark
        elif state == MARKS[2]:
            lines.append(line)
        elif state == MARKS[1]:
            stub = re.fullmatch(r"(\s*)# ?(.*)", line)
            if not stub:
                raise DHError(f"{here}: the stub {line!r} should be a comment.")
            lines.append(stub[1] + stub[2])
    if state != MARKS[2]:
        raise DHError(f"{here}: the region is not closed by {MARKS[2]!r}.")
    return "\n".join(lines)


def close_regions(source: str) -> str:
    r"""Source with every solution region replaced by its answer: what a page of the solution shows.

    Examples
    --------
    >>> close_regions("x = 1\n### solution\nA = x + 1\n### yours\n# A = ...\n### end")
    'x = 1\nA = x + 1'
    """
    lines, state = [], MARKS[2]
    for line in source.splitlines():
        if line.strip() in MARKS:
            state = line.strip()
        elif state != MARKS[1]:
            lines.append(line)
    return "\n".join(lines).rstrip()


def as_text(notebook: dict[str, Any]) -> str:
    """A notebook as it is stored."""
    return json.dumps(notebook, indent=1, ensure_ascii=False, sort_keys=True) + "\n"


def main(arguments: list[str] | None = None) -> int:
    """Derive all student editions, or say which have drifted from their source."""
    parser = argparse.ArgumentParser(prog="python -m dhlib.grading.derive", description=str(__doc__).split("\n\n")[0])
    parser.add_argument("--solutions", type=Path, default=Path("solutions"), help="where the solutions are")
    parser.add_argument("--exercises", type=Path, default=Path("exercises"), help="where the exercises go")
    parser.add_argument("--check", action="store_true", help="write nothing; fail where an exercise has drifted")
    options = parser.parse_args(arguments)
    sources = sorted(options.solutions.glob("*.ipynb"))
    if not sources:
        print(f"There is no notebook in {options.solutions}.", file=sys.stderr)
        return 2
    drifted = []
    for source in sources:
        target = options.exercises / source.name
        try:
            solution = load_notebook(source)
            stored = as_text(solution)
            fill(solution, load_variant(source.stem, options.exercises).cells())
            derived = as_text(derive(solution, source.stem))
        except DHError as error:
            print(error, file=sys.stderr)
            return 2
        written = [(target, derived)] if not target.is_file() or target.read_text(encoding="utf-8") != derived else []
        if as_text(solution) != stored:
            written.append((source, as_text(solution)))
        for path, text in written:
            if options.check:
                drifted.append(path)
            else:
                path.write_text(text, encoding="utf-8")
                print(
                    f"derived {path}"
                    if path == target
                    else f"wrote the given cells of {path}: make solutions runs it again"
                )
    for path in drifted:
        why = "what its solution gives" if path.parent == options.exercises else "what its exercise's file gives"
        print(f"{path} is not {why}: run make exercises.", file=sys.stderr)
    return 1 if drifted else 0


if __name__ == "__main__":
    sys.exit(main())
