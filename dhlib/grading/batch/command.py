"""``dhlib grade``: grade a class."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from dhlib.errors import DHError
from dhlib.grading.batch.after import write_views
from dhlib.grading.batch.run import Shard, Summary

if TYPE_CHECKING:
    from dhlib.grading.batch.cluster import Cluster
    from dhlib.grading.batch.pool import Pool
    from dhlib.grading.batch.work import Settings

DESCRIPTION = """\
Grade what a class handed in: put the answers of each notebook into the pristine exercise, run it in a box, mark the
answers, and keep everything in DIR/results.sqlite. What is graded already is left alone, so that a run which was
stopped goes on where it was, and new submissions are added.

SOURCES are files, folders or ZIP archives: downloads from Moodle or Canvas as they are, nbgrader's folder `submitted`,
clones of GitHub Classroom, or a folder with a subfolder or a file for each student."""

EPILOG = """\
Exit code: 0 if every notebook was graded; 1 if some could not be read or were stopped (grades.csv says which and why);
2 if the command itself was wrong, or nothing could be graded; 130 if it was interrupted."""


def add_grade(commands: Any) -> None:
    """Add ``grade`` to the commands of the parser."""
    parser = commands.add_parser(
        "grade",
        help="grade a class",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("sources", type=Path, nargs="+", metavar="SOURCES", help="what was handed in")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="where results go")
    parser.add_argument("--exercise", default="", metavar="NAME", help="which exercise it is, if notebooks do not say")
    parser.add_argument("--exercises", type=Path, metavar="DIR", help="where to look for exercises first")
    parser.add_argument("--roster", type=Path, metavar="CSV", help="class list, which says who is who")
    parser.add_argument(
        "--column", default="", metavar="HEADING", help="of the IDs in the class list, if it is unusual"
    )
    parser.add_argument("--key", type=Path, metavar="FILE", help="of the course, for notebooks that were assigned")
    parser.add_argument("--timeout", type=positive, default=60.0, metavar="S", help="seconds for a notebook (60)")
    parser.add_argument("--workers", type=count, metavar="N", help="notebooks at a time (one for each core)")
    parser.add_argument(
        "--regrade",
        nargs="?",
        const="changed",
        default="",
        choices=("changed", "all"),
        help="grade again what was graded with another exercise or another dhlib (changed, if nothing is said), or all",
    )
    parser.add_argument(
        "--shard", type=shard, metavar="I/N", help="only share I of N; `dhlib merge` brings them together"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="grade on a cluster of dask.distributed: tls://HOST:PORT"
    )
    parser.add_argument("--tls-ca", type=Path, metavar="FILE", help="certificate of the authority of the cluster")
    parser.add_argument("--tls-cert", type=Path, metavar="FILE", help="your certificate for the cluster")
    parser.add_argument("--tls-key", type=Path, metavar="FILE", help="its private key")
    parser.add_argument("--pseudonyms", action="store_true", help="print no names, and send none to a cluster")
    add_walls(parser)
    parser.set_defaults(run=grade)


def add_walls(parser: argparse.ArgumentParser) -> None:
    """Add what concerns the sandbox."""
    parser.add_argument(
        "--unsafe-no-sandbox",
        dest="unsafe",
        action="store_true",
        help="run notebooks as yourself, with all that you may do: for your own notebooks only",
    )
    parser.add_argument("--doctor", action=Doctor, nargs=0, help="say which walls stand on this machine, and try each")


class Doctor(argparse.Action):
    """Look at the walls, and leave."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        """Print the findings; the exit code is 1 if a wall that strangers need does not stand."""
        from dhlib.grading.wall.doctor import look

        parser.exit(0 if look(sys.stdout) else 1)


def grade(options: argparse.Namespace) -> int:
    """Grade, write and sum up."""
    from dhlib.grading.batch.people import People
    from dhlib.grading.batch.run import grade_class
    from dhlib.grading.batch.store import Store
    from dhlib.grading.batch.work import Settings
    from dhlib.grading.course.keys import read_key
    from dhlib.grading.exercise import find_exercise
    from dhlib.grading.reports.settings import change_settings
    from dhlib.grading.wall import Limits
    from dhlib.grading.wall.limits import UNSAFE

    if options.exercises and not options.exercises.is_dir():
        raise DHError(f"there is no folder {options.exercises}; --exercises names the folder that holds NAME.py.")
    if options.out.exists() and not options.out.is_dir():
        raise DHError(f"{options.out} is a file; --out names a folder.")
    if options.exercise:
        find_exercise(options.exercise, ".py", options.exercises)
    if options.unsafe:
        print(f"dhlib: {UNSAFE}", file=sys.stderr)
    settings = Settings(
        options.exercise,
        options.exercises,
        Limits.of(options.timeout),
        unsafe=options.unsafe,
        key=read_key(options.key) if options.key else None,
    )
    people = People(options.roster, options.column) if options.roster else None
    try:
        with workers_of(options, settings) as workers:
            summary = grade_class(
                options.sources,
                options.out,
                settings,
                workers,
                regrade=options.regrade,
                roster=people.find if people else None,
                shard=options.shard,
                quiet=options.pseudonyms,
            )
    except KeyboardInterrupt:
        print("\nStopped. What was graded is kept; the same command goes on where it was.", file=sys.stderr)
        return 130
    print(in_words(summary))
    with Store(options.out) as store:
        if people is not None and options.shard is None:
            here = {student.student for student in store.students()}
            missing = sum(person.id not in here for person in people.people)
            print(f"{missing} of the {len(people.people)} on the roster handed nothing in.")
        change_settings(
            store,
            pseudonyms=options.pseudonyms or None,
            exercises=str(options.exercises.resolve()) if options.exercises else None,
        )
        print(f"Grades: {write_views(store)}")
    return 0 if set(summary.status) <= {"graded"} else 1


def workers_of(options: argparse.Namespace, settings: Settings) -> Pool | Cluster:
    """Who grades: processes here, or a cluster."""
    from dhlib.grading.batch.pool import Pool

    if not options.scheduler:
        return Pool(settings, options.workers or cores())
    from dhlib.grading.batch.cluster import Certificates, Cluster

    for path in (options.tls_ca, options.tls_cert, options.tls_key):
        if path is not None and not path.is_file():
            raise DHError(f"there is no file {path}.")
    return Cluster(settings, options.scheduler, Certificates(options.tls_ca, options.tls_cert, options.tls_key))


def in_words(summary: Summary) -> str:
    """What a run did."""
    lines = [f"{summary.done} graded now, {summary.kept} before."] if summary.kept else [f"{summary.done} graded."]
    others = [f"{count} {status}" for status, count in summary.status.items() if status != "graded"]
    if others:
        lines.append(f"Look at: {', '.join(others)}.")
    if summary.problems:
        lines.append(f"{summary.problems} more to look at: problems.csv lists them.")
    return "\n".join(lines)


def cores() -> int:
    """The processors that this program may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def positive(text: str) -> float:
    """An option that is a number above 0."""
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError("should be more than 0")
    return value


def count(text: str) -> int:
    """An option that is a whole number from 1."""
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("should be 1 or more")
    return value


def shard(text: str) -> Shard:
    """An option such as 2/5; both counts from 0 and counts from 1 reach every share once."""
    index, _, total = text.partition("/")
    if not (index.isdecimal() and total.isdecimal() and int(total) >= 1 and int(index) <= int(total)):
        raise argparse.ArgumentTypeError("should be such as 2/5: number 2 of 5 shares")
    return Shard(int(index), int(total))
