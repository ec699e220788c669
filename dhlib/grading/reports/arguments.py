"""Arguments that several commands share."""

from __future__ import annotations

import argparse
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.course.keys import read_key
from dhlib.grading.reports.book_links import read_address
from dhlib.grading.reports.settings import Settings, change_settings


def add_results(parser: argparse.ArgumentParser) -> None:
    """Add the folder of the results."""
    parser.add_argument("results", type=Path, metavar="RESULTS", help="the folder that `dhlib grade --out` filled")


def add_wishes(parser: argparse.ArgumentParser) -> None:
    """Add what the pages should be like."""
    parser.add_argument("--book", metavar="URL", help="where your students read the book: pages link to its sections")
    parser.add_argument(
        "--reveal",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="show what would have been right (not unless asked for)",
    )
    parser.add_argument(
        "--pseudonyms",
        action=argparse.BooleanOptionalAction,
        default=None,
        help="keep names out of everything that is written",
    )
    parser.add_argument("--exercises", type=Path, metavar="DIR", help="where to look for exercises first")
    parser.add_argument("--key", type=Path, metavar="FILE", help="of the course, for notebooks that were assigned")


def keep_wishes(store: Store, options: argparse.Namespace) -> Settings:
    """Keep what was said, and return what holds."""
    if options.exercises and not options.exercises.is_dir():
        raise DHError(f"there is no folder {options.exercises}; --exercises names the folder that holds NAME.py.")
    if options.key:
        read_key(options.key)  # refused now rather than when it is used
    return change_settings(
        store,
        book=read_address(options.book) if options.book else options.book,
        reveal=options.reveal,
        pseudonyms=options.pseudonyms,
        exercises=str(options.exercises.resolve()) if options.exercises else None,
        key=str(options.key.resolve()) if options.key else None,
    )
