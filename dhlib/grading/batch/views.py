"""What a run writes beside the store: the table, a page for each submission, and what to look at."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.exercise import Exercise, load_exercise
from dhlib.grading.grade import Result
from dhlib.grading.marks import Mark
from dhlib.grading.report import safe
from dhlib.grading.report import write_reports as write_results

PROBLEMS = "problems.csv"


@dataclass
class _Exercises:
    folder: Path | None
    loaded: dict[str, Exercise | None]

    def get(self, name: str) -> Exercise | None:
        if name not in self.loaded:
            try:
                self.loaded[name] = load_exercise(name, self.folder) if name else None
            except DHError:
                self.loaded[name] = None
        return self.loaded[name]


def write_reports(store: Store, out: Path, exercises: Path | None = None) -> Path:
    """Write all views, and return the table."""
    known = _Exercises(exercises, {})
    results = [
        Result(
            Path(submission.source),
            submission.status,
            submission.message,
            known.get(submission.exercise),
            [
                Mark(mark.part, mark.points, mark.out_of, mark.verdict, mark.message, mark.misconception, mark.section)
                for mark in store.marks(submission.id)
            ],
        )
        for submission in store.submissions()
    ]
    write_problems(store, out / PROBLEMS)
    return write_results(results, out, Path())


def write_problems(store: Store, table: Path) -> None:
    """One row for each thing that the instructor should look at; no file if there is none."""
    problems = store.problems()
    if not problems:
        table.unlink(missing_ok=True)
        return
    with table.open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.writer(file)
        writer.writerow(["where", "what", "students"])
        writer.writerows([safe(p.source), safe(p.what), safe(", ".join(p.students))] for p in problems)
