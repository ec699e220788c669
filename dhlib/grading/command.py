"""``dhlib grade``: several notebooks, each in a process of its own."""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.keys import read_key
from dhlib.grading.grade import FAILED, GRADED, Result, grade_notebook
from dhlib.grading.wall import Limits, Sandbox
from dhlib.grading.wall.limits import UNSAFE

DESCRIPTION = """\
Grade notebooks: put the answers of each into the pristine exercise, run it in a process of its own, mark the answers,
and write grades.csv and a feedback page for each notebook into a folder.

Notebooks run in a sandbox: no network, no files but their own, bounded time, memory and processes, and never beside the
reference. `dhlib grade --doctor` says which walls stand on this machine, and tries each."""

EPILOG = """\
Exit code: 0 if every notebook was graded; 1 if some could not be read or were stopped (grades.csv says which and why);
2 if the command itself was wrong."""


def add_grade(commands: Any) -> None:
    """Add ``grade`` to the commands of the parser."""
    parser = commands.add_parser(
        "grade",
        help="grade notebooks",
        description=DESCRIPTION,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("path", type=Path, metavar="FILE_OR_FOLDER", help="a notebook, or a folder of notebooks")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR", help="where results go")
    parser.add_argument(
        "--exercise", default="", metavar="NAME", help="which exercise it is, if the notebooks do not say"
    )
    parser.add_argument("--exercises", type=Path, metavar="DIR", help="where to look for exercises first")
    parser.add_argument("--key", type=Path, metavar="FILE", help="of the course, for notebooks that were assigned")
    parser.add_argument("--timeout", type=_positive, default=60.0, metavar="S", help="seconds for a notebook (60)")
    parser.add_argument("--workers", type=_count, default=os.cpu_count() or 1, metavar="N", help="notebooks at a time")
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
    from dhlib.grading.report import write_reports

    paths = find_notebooks(options.path)
    if options.exercises and not options.exercises.is_dir():
        raise DHError(f"there is no folder {options.exercises}; --exercises names the folder that holds NAME.py.")
    if options.out.exists() and not options.out.is_dir():
        raise DHError(f"{options.out} is a file; --out names a folder.")
    try:
        options.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DHError(f"the folder {options.out} cannot be made: {error.strerror}.") from None
    results = []
    for k, result in enumerate(_grade_all(paths, options), 1):
        score = f"{result.points:g} of {result.out_of:g}" if result.exercise else "–"
        print(
            f"[{k}/{len(paths)}] {result.path.name}: {result.status}, {score}  {result.message}".rstrip(),
            file=sys.stderr,
        )
        results.append(result)
    table = write_reports(results, options.out, options.path)
    print(f"Grades: {table}")
    return 0 if all(result.status == GRADED for result in results) else 1


def find_notebooks(path: Path) -> list[Path]:
    """The notebooks that a path stands for, in order.

    Raises
    ------
    DHError
        If there is none.
    """
    if path.is_file():
        return [path]
    if not path.is_dir():
        raise DHError(f"there is no file or folder {path}.")
    hidden = {".ipynb_checkpoints", "__MACOSX"}
    found = sorted(p for p in path.rglob("*.ipynb") if p.is_file() and not hidden & set(p.relative_to(path).parts))
    if not found:
        raise DHError(f"there is no notebook (*.ipynb) in {path}.")
    return found


def _grade_all(paths: Sequence[Path], options: argparse.Namespace) -> Iterator[Result]:
    key = read_key(options.key) if options.key else None
    import sympy  # noqa: F401  before the threads: one that finds it half imported would fail

    if options.unsafe:
        print(f"dhlib: {UNSAFE}", file=sys.stderr)
    boxes: SimpleQueue[Sandbox] = SimpleQueue()  # one for each worker

    def grade_one(path: Path) -> Result:
        box = boxes.get()
        try:
            return grade_notebook(path, options.exercise, options.exercises, sandbox=box, key=key)
        except DHError:
            raise
        except Exception as error:  # ours to mend; the others should not suffer
            return Result(
                path, FAILED, f"The grader failed on it ({type(error).__name__}: {error}). Please report this."
            )
        finally:
            boxes.put(box)

    with contextlib.ExitStack() as stack, ThreadPoolExecutor(options.workers) as pool:
        for _ in range(options.workers):
            boxes.put(stack.enter_context(Sandbox(Limits.of(options.timeout), unsafe=options.unsafe)))
        yield from pool.map(grade_one, paths)


def _positive(text: str) -> float:
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError("should be more than 0")
    return value


def _count(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("should be 1 or more")
    return value
