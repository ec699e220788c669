"""``make coverage``, second half: read what the tests ran of dhlib, keep it, and fail below what is asked.

    python bench/covered.py --lines 95 --branches 92

Lists the files below that, and writes ``bench/results/coverage.json``, by parts of the library.
"""

from __future__ import annotations

import argparse
import datetime
import importlib.metadata
import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from environment import BENCH, ROOT, machine
from report import write_report

#: What a part of the library is called, and the folder it stands in; the whole comes first.
PARTS = {
    "dhlib": "dhlib/",
    "marker": "dhlib/grading/",
    "class": "dhlib/grading/batch/",
    "course": "dhlib/grading/course/",
    "reports": "dhlib/grading/reports/",
    "sandbox": "dhlib/grading/wall/",
}
COUNTS = {"lines": ("covered_lines", "num_statements"), "branches": ("covered_branches", "num_branches")}


def summaries() -> dict[str, dict[str, int]]:
    """Return coverage's counts for each file."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "coverage.json"
        words = [sys.executable, "-m", "coverage", "json", "-q", "-o", str(path)]
        subprocess.run(words, cwd=ROOT, check=True)
        files = json.loads(path.read_text("utf-8"))["files"]
    return {name: about["summary"] for name, about in files.items()}


def percent(files: list[dict[str, int]], what: str) -> float:
    """Return the part that was run, in percent; all of it where there is nothing.

    >>> percent([{"covered_lines": 3, "num_statements": 4}], "lines")
    75.0
    """
    run, there = (sum(each[count] for each in files) for count in COUNTS[what])
    return 100 * run / there if there else 100.0


def main() -> int:
    """Keep, and judge."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for what in COUNTS:
        parser.add_argument(f"--{what}", type=float, default=95, help="percent, at least (default: %(default)g)")
    least = vars(parser.parse_args())
    files = summaries()
    for name, about in sorted(files.items()):
        found = {what: percent([about], what) for what in COUNTS}
        if any(found[what] < least[what] for what in COUNTS):
            print(f"{name}: lines {found['lines']:.1f} %, branches {found['branches']:.1f} %")
    rows: list[dict[str, Any]] = []
    for part, folder in PARTS.items():
        inner = [other for other in PARTS.values() if part != "dhlib" and other != folder and other.startswith(folder)]
        here = [about for name, about in files.items() if name.startswith(folder) and not name.startswith(tuple(inner))]
        rows.append({"part": part, **{what: percent(here, what) for what in COUNTS}})
    about = {"date": datetime.date.today().isoformat(), "machine": machine()}
    versions = {name: importlib.metadata.version(name) for name in ("coverage", "pytest")}
    text = json.dumps(about | {"rows": rows, "versions": versions}, indent=1, sort_keys=True)
    (BENCH / "results" / "coverage.json").write_text(text + "\n", encoding="utf-8")
    write_report(BENCH / "results", BENCH / "RESULTS.md")
    whole = rows[0]
    for what in COUNTS:
        print(f"dhlib: {what} {whole[what]:.1f} %; at least {least[what]:g} % are asked for.")
    return int(any(whole[what] < least[what] for what in COUNTS))


if __name__ == "__main__":
    sys.exit(main())
