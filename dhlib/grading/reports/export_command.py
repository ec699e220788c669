"""``dhlib export``: files for other systems."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.course.variants import Variants
from dhlib.grading.reports import autograder, classroom
from dhlib.grading.reports.arguments import add_wishes, keep_wishes
from dhlib.grading.reports.formats import Files, Wishes, formats
from dhlib.grading.reports.write import EXPORTS, feedback_pages, records_to_show, replace_file

#: What grades elsewhere, and needs no results.
ELSEWHERE = {
    "gradescope-autograder": (autograder.write, "a zip with which Gradescope grades by itself"),
    "github-classroom": (classroom.write, "a workflow with which GitHub grades each push"),
}
#: What they cannot do: a key in a container is a key in the hands of whoever's notebook runs there.
NO_KEY = (
    "It marks by the numbers of the book. Notebooks with numbers of a student's own are refused there, since no key of "
    "a course belongs where students' code runs: collect them, and grade them here with `dhlib grade --key`."
)
#: These find a student by what a platform calls them.
BY_NAME = ("moodle", "canvas")


def add_export(commands: Any) -> None:
    """Add ``export`` to the commands of the parser."""
    listed = {
        **{each.name: each.says for each in formats().values()},
        **{n: says for n, (_, says) in ELSEWHERE.items()},
    }
    width = max(map(len, listed))
    parser = commands.add_parser(
        "export",
        help="write files for Moodle, Canvas, Gradescope and others",
        description="Write what another system reads.\n\n"
        + "\n".join(f"  {name:{width}}  {says}" for name, says in listed.items()),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("results", type=Path, nargs="?", metavar="RESULTS", help="the folder that `dhlib grade` filled")
    parser.add_argument("--format", required=True, choices=list(listed), metavar="FORMAT", help="one of the above")
    parser.add_argument("--out", type=Path, metavar="DIR", help="where it goes; RESULTS/exports if left out")
    parser.add_argument("--exercise", default="", metavar="NAME", help="which exercise, if there are several")
    parser.add_argument("--title", default="", metavar="TEXT", help="what the assignment is called in Canvas")
    parser.add_argument(
        "--worksheet", type=Path, metavar="FILE", help="the table as Moodle or Canvas gave it, to be filled in"
    )
    add_wishes(parser)
    parser.set_defaults(run=export)


def export(options: argparse.Namespace) -> int:
    """Write the files, and say where they are."""
    if options.format in ELSEWHERE:
        if not options.exercise:
            raise DHError(f"{options.format} grades one exercise: say which with --exercise NAME.")
        write, _ = ELSEWHERE[options.format]
        files: Files = write(options.exercise, options.exercises)
        folder = options.out or (options.results or Path()) / EXPORTS
    else:
        if options.results is None:
            raise DHError("export what? Name the folder of the results.")
        files = _of_results(options)
        folder = options.out or (options.results if options.results.is_dir() else options.results.parent) / EXPORTS
    for name, content in files.items():
        path = folder / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            replace_file(path, content)
        except OSError as error:
            raise DHError(f"{path} cannot be written: {error.strerror}.") from None
    shown = sorted({name.split("/")[0] for name in files if not name.startswith(".")} or {""})
    print("\n".join(f"Written: {folder / name}" for name in shown))
    if options.format in ELSEWHERE and Variants(options.exercise, options.exercises).vary:
        print(NO_KEY)
    return 0


def _of_results(options: argparse.Namespace) -> Files:
    chosen = formats()[options.format]
    with Store(options.results) as store:
        settings = keep_wishes(store, options)
        if settings.pseudonyms and chosen.name in BY_NAME:
            raise DHError(f"{chosen.name} knows students by name; say --no-pseudonyms to write names into its files.")
        records = [
            record
            for record in records_to_show(store, settings)
            if not options.exercise or record.exercise == options.exercise
        ]
        if not records:
            what = f" of {options.exercise}" if options.exercise else ""
            raise DHError(f"there are no results{what} in {options.results}.")
        pages = feedback_pages(store, records, settings) if chosen.needs_pages else None
    return chosen.write(records, Wishes(options.title, options.worksheet, settings.folder, pages))
