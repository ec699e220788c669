"""``dhlib forget``: remove a student from the results."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.reports.arguments import add_results
from dhlib.grading.reports.forgetting import clean, forget
from dhlib.grading.reports.people import find_student


def add_forget(commands: Any) -> None:
    """Add ``forget`` to the commands of the parser."""
    parser = commands.add_parser(
        "forget",
        help="remove a student from the results",
        description="Remove everything of one student: marks, answers, feedback, decisions and lines of the audit "
        "trail. The file is written anew, so that their bytes are gone. What was handed in, backups, and exports that "
        "lie elsewhere are yours to delete.",
    )
    add_results(parser)
    parser.add_argument("student", metavar="STUDENT", help="name, or the first column of grades.csv")
    parser.add_argument("--yes", action="store_true", help="do not ask")
    parser.set_defaults(run=forget_student)


def forget_student(options: argparse.Namespace) -> int:
    """Ask, remove, and say what is left to do."""
    with Store(options.results) as store:
        try:
            student = find_student(store, options.student)
        except DHError:
            if not clean(store):
                raise
            print("What an earlier `dhlib forget` had to leave in the file is gone now.")
            return 0
        if not options.yes and not _agreed(student):
            print("Nothing was removed.")
            return 0
        done = forget(store, student)
    print(
        f"Removed: {done.submissions} submission{'s' if done.submissions != 1 else ''} and all that was made of them."
    )
    if done.exports:
        print("The exports held them too and are deleted: make them again with dhlib export.")
    if done.left:
        print(f"These still hold the name, and are yours to look at: {', '.join(map(str, done.left))}.")
    print("What was handed in, backups, and what you sent elsewhere are yours to delete.")
    return 0


def _agreed(student: str) -> bool:
    if not sys.stdin.isatty():
        raise DHError("this cannot be undone; say --yes if you mean it.")
    return input(f"Remove everything of {student}? This cannot be undone. [y/N] ").strip().casefold() in ("y", "yes")
