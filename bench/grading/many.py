"""How `dhlib grade` grows with the class: time for each notebook, and the memory of what watches over them.

``python many.py --sizes 30 1000 10000`` in the book's own environment prints one JSON object. Every notebook is graded
behind its walls, and every mark is compared with what was planned.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

import compare
import work
from environment import size


class Memory:
    """Watches a process and what it started: the largest part of memory that is theirs alone or shared among them."""

    def __init__(self, pid: int) -> None:
        self.pid, self.controller, self.tree = pid, 0.0, 0.0
        self._over = threading.Event()
        self._watching = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> Memory:
        self._watching.start()
        return self

    def __exit__(self, *_: Any) -> None:
        self._over.set()
        self._watching.join()

    def _watch(self) -> None:
        while not self._over.wait(0.5):
            self.controller = max(self.controller, megabytes(self.pid))
            self.tree = max(self.tree, sum(map(megabytes, family(self.pid))))


def family(pid: int) -> list[int]:
    """A process and all that descend from it."""
    children: dict[int, list[int]] = {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            parent = int(Path("/proc", entry, "stat").read_text().rpartition(")")[2].split()[1])
        except OSError:
            continue
        children.setdefault(parent, []).append(int(entry))
    found = [pid]
    for each in found:
        found += children.get(each, [])
    return found


def megabytes(pid: int) -> float:
    """Memory of a process, with its share of what it has in common with others."""
    try:
        lines = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0.0
    return sum(float(line.split()[1]) for line in lines if line.startswith("Pss:")) / 1024


def graded(count: int) -> dict[str, Any]:
    """Grade a class of that size."""
    planned = compare.students(count)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        compare.dhlib_class(folder, {who: work.answers(right) for who, right in planned.items()})
        before = os.times()
        begin = time.perf_counter()
        words = ("grade", "handed-in", "--out", "marks", "--exercises", "exercises")
        process = subprocess.Popen(
            [Path(sys.executable).parent / "dhlib", *words], cwd=folder, stdout=subprocess.DEVNULL
        )
        with Memory(process.pid) as memory:
            code = process.wait()
        seconds = time.perf_counter() - begin
        after = os.times()
        if code != 0:
            raise SystemExit(f"dhlib grade ended with {code}")
        if compare.marks_of_dhlib(folder) != planned:
            raise SystemExit("other marks than planned")
    return {
        "count": count,
        "seconds": seconds,
        "cpu_each": (after.children_user - before.children_user + after.children_system - before.children_system)
        / count,
        "controller_mb": memory.controller,
        "tree_mb": memory.tree,
    }


def main() -> None:
    """Grade a class of each size."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="*", default=[30, size(1000, 60), size(10_000, 90)])
    rows = []
    for count in parser.parse_args().sizes:
        print(f"  many: {count}", file=sys.stderr, flush=True)
        rows.append(graded(count))
    json.dump({"rows": rows, "cores": os.cpu_count()}, sys.stdout)


if __name__ == "__main__":
    main()
