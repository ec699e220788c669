"""Bring the results of several machines together."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.batch.conflicts import conflicts
from dhlib.grading.batch.lock import Lock
from dhlib.grading.batch.rows import Problem
from dhlib.grading.batch.store import FILE, Store

#: What stands beside the submissions and goes along: a row that is there already is not taken twice.
TABLES = {
    "event": "at, what, student, details",
    "adjustment": "exercise, student, part, points, reason, at, by, revoked_at, revoked_by",
    "rule": "exercise, student, due, late, grace, reason, at, by, revoked_at, revoked_by",
}


def merge(parts: Sequence[Path], out: Path) -> int:
    """Add all submissions of some results to those of a folder, and return how many are new or newer.

    Where both have the same file, the mark that was given last stays. Doing it twice changes nothing.

    Parameters
    ----------
    parts : sequence of path
        Folders of results, or files.
    out : path
        Folder; made where it is missing.

    Raises
    ------
    DHError
        If one of them holds no results.
    """
    for part in parts:  # all of them, before anything is changed
        Store(part).close()
    out.mkdir(parents=True, exist_ok=True)
    taken = 0
    with Lock(out), Store(out / FILE, create=True) as store:
        problems = [problem for problem in store.problems() if problem.submission is None]
        for part in parts:
            with Store(part) as other:
                if other.path.resolve() == store.path.resolve():
                    continue
                taken += _take(other, store)
                problems += [problem for problem in other.problems() if problem.submission is None]
        _replace_problems(store, problems)
    return taken


def _take(other: Store, store: Store) -> int:
    there = store.graded()
    taken = 0
    for submission in other.submissions():
        old = there.get((submission.source, submission.sha256))
        if old is None or old.graded_at < submission.graded_at:
            store.add(submission, other.marks(submission.id))
            taken += 1
    for table, columns in TABLES.items():
        same = " AND ".join(f"{name.strip()} = ?" for name in columns.split(","))
        marks = ", ".join("?" * len(columns.split(",")))
        with store.transaction() as db:
            for row in other.query(f"SELECT {columns} FROM {table} ORDER BY id"):
                db.execute(
                    f"INSERT INTO {table} ({columns}) SELECT {marks} "
                    f"WHERE NOT EXISTS (SELECT 1 FROM {table} WHERE {same})",
                    [*row, *row],
                )
    return taken


def _replace_problems(store: Store, problems: Sequence[Problem]) -> None:
    submissions = store.submissions()
    found = conflicts(submissions)
    # what each part found out by itself is found again, or settled, among all
    about = {submission.source for submission in submissions}
    rest = dict.fromkeys(problem for problem in problems if problem.source not in about)
    store.replace_problems([*rest, *found])


def add_merge(commands: Any) -> None:
    """Add ``merge`` to the commands of the parser."""
    parser = commands.add_parser(
        "merge",
        help="bring results of several machines together",
        description="Add the results of several folders, such as those of `dhlib grade --shard`, to one.",
    )
    parser.add_argument("parts", type=Path, nargs="+", metavar="DIR", help="folders of results")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="where they are brought together")
    parser.set_defaults(run=run_merge)


def run_merge(options: argparse.Namespace) -> int:
    """Merge, write the reports, and sum up."""
    from dhlib.grading.batch.after import write_views

    if options.out.exists() and not options.out.is_dir():
        raise DHError(f"{options.out} is a file; --out names a folder.")
    taken = merge(options.parts, options.out)
    with Store(options.out) as store:
        with Store(options.parts[0]) as first:
            table = write_views(store, like=first)
        print(f"{taken} taken, {len(store.submissions())} in all.\nGrades: {table}")
    return 0
