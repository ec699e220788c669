"""The list of what the instructor should look at, as a table."""

from __future__ import annotations

from pathlib import Path

from dhlib.grading.batch.store import Store
from dhlib.grading.reports.cells import table
from dhlib.grading.reports.write import replace_file

PROBLEMS = "problems.csv"


def write_problems(store: Store, path: Path) -> None:
    """One row for each problem; no file if there is none."""
    problems = store.problems()
    if not problems:
        path.unlink(missing_ok=True)
        return
    rows = ([problem.source, problem.what, ", ".join(problem.students)] for problem in problems)
    replace_file(path, table(["where", "what", "students"], rows, mark=True))
