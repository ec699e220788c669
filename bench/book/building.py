"""How long the chapters take to build, ours beside a plain Jupyter Book: ``python building.py`` prints one JSON object.

Each is built from nothing, again without a change, and again after a word in one chapter was changed.
"""

from __future__ import annotations

import importlib.metadata
import json
import re
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

import books
from environment import size

ROUNDS = size(3, 1)
#: The chapter of which a word is changed, and where.
CHANGED = "book/why"
EXECUTED = re.compile(r"Executed notebook in ([\d.]+) seconds")


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """Return seconds and result."""
    begin = time.perf_counter()
    result = work()
    return time.perf_counter() - begin, result


def one_round(lay_out: Callable[[], Path]) -> dict[str, float]:
    """Build three times."""
    folder = lay_out()
    first, said = timed(lambda: books.build(folder))
    again, _ = timed(lambda: books.build(folder))
    chapter = folder / f"{CHANGED}.md"
    chapter.write_text(chapter.read_text("utf-8") + "\nOne more sentence.\n", encoding="utf-8")
    changed, _ = timed(lambda: books.build(folder))
    return {"first": first, "again": again, "changed": changed, "executing": sum(map(float, EXECUTED.findall(said)))}


def main() -> None:
    """Build by turns."""
    runs: dict[str, list[dict[str, float]]] = {"dhlib": [], "plain": []}
    for k in range(ROUNDS):
        for who, lay_out in (("dhlib", books.ours), ("plain", books.plain)):
            print(f"  building: {who}, round {k + 1}", file=sys.stderr, flush=True)
            runs[who].append(one_round(lay_out))
    rows = [
        {
            "peer": who,
            **{what: median(run[what] for run in taken) for what in ("first", "again", "changed", "executing")},
        }
        for who, taken in runs.items()
    ]
    serial = median(run["executing"] for run in runs["plain"])
    json.dump(
        {
            "rows": rows,
            "chapters": len(books.chapters()),
            "serial": serial,
            "first_of_serial": median(run["first"] for run in runs["dhlib"]) / serial if serial else None,
            "versions": {"jupyter-book": importlib.metadata.version("jupyter-book")},
        },
        sys.stdout,
    )


if __name__ == "__main__":
    main()
