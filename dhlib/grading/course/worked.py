"""Run a worked notebook and keep its outputs: ``python -m dhlib.grading.course.worked solutions/NAME.ipynb …``."""

from __future__ import annotations

import argparse
import copy
import json
import sys
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.notebook import load_notebook

SECONDS = 120


def execute(notebook: dict[str, Any], folder: str | Path = ".") -> dict[str, Any]:
    """The notebook with the outputs that its cells have today.

    Parameters
    ----------
    notebook : dict
        As plain JSON; it is left as it is.
    folder : path
        Where it runs.

    Raises
    ------
    DHError
        If a cell stops with an error, or the packages that run notebooks are missing.
    """
    try:
        import nbclient
        import nbformat
    except ImportError:
        raise DHError('running a notebook needs more packages: pip install "dhlib[grade]".') from None
    running = nbformat.reads(json.dumps(notebook), as_version=4)
    client = nbclient.NotebookClient(
        running,
        timeout=SECONDS,
        kernel_name="python3",
        record_timing=False,
        coalesce_streams=True,
        extra_arguments=["--log-level=ERROR"],  # what it warns of is nothing that its user can change
        resources={"metadata": {"path": str(folder)}},
    )
    try:
        client.execute()
    except nbclient.exceptions.CellExecutionError as error:
        raise DHError(f"a cell stopped with {error.ename}: {error.evalue}") from None
    done = copy.deepcopy(notebook)
    for cell, ran in zip(done["cells"], running.cells, strict=True):
        if cell["cell_type"] == "code":
            cell["execution_count"] = ran.execution_count
            cell["outputs"] = [_plain(output) for output in ran.outputs]
    return done


def _plain(output: Any) -> dict[str, Any]:
    """An output as it is stored: text as lines."""
    plain = dict(output)
    if "text" in plain:
        plain["text"] = plain["text"].splitlines(keepends=True)
    if "data" in plain:
        plain["data"] = {
            kind: value.splitlines(keepends=True) if isinstance(value, str) and kind != "image/png" else value
            for kind, value in plain["data"].items()
        }
        plain["metadata"] = dict(plain.get("metadata", {}))
    return plain


def main(arguments: list[str] | None = None) -> int:
    """Run worked notebooks where they are, and store their outputs."""
    from dhlib.grading.derive import as_text

    parser = argparse.ArgumentParser(prog="python -m dhlib.grading.course.worked", description=str(__doc__))
    parser.add_argument("notebooks", type=Path, nargs="+")
    for path in parser.parse_args(arguments).notebooks:
        try:
            path.write_text(as_text(execute(load_notebook(path))), encoding="utf-8")
        except DHError as error:
            print(f"{path}: {error}", file=sys.stderr)
            return 1
        print(f"ran {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
