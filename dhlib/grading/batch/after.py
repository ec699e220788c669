"""What is written beside the store after a run: the reports, and the list of what the instructor should look at."""

from __future__ import annotations

from pathlib import Path

from dhlib.grading.batch.store import Store
from dhlib.grading.reports.cells import table
from dhlib.grading.reports.settings import KEY
from dhlib.grading.reports.write import replace_file, write_reports

PROBLEMS = "problems.csv"


def write_views(store: Store, like: Store | None = None) -> Path:
    """Write all reports of some results, with the settings of others if they are given; return the table of marks."""
    if like is not None and not store.meta(KEY):
        store.set_meta(KEY, like.meta(KEY, "{}"))
    written = write_reports(store)
    write_problems(store, store.path.parent / PROBLEMS)
    return written.grades


def write_problems(store: Store, path: Path) -> None:
    """One row for each problem; no file if there is none."""
    problems = store.problems()
    if not problems:
        path.unlink(missing_ok=True)
        return
    rows = ([problem.source, problem.what, ", ".join(problem.students)] for problem in problems)
    replace_file(path, table(["where", "what", "students"], rows, mark=True))
