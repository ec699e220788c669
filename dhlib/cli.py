"""The command ``dhlib``."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Sequence

from dhlib.errors import DHError

#: What `main` returns, and so the exit code of the command.
DONE, SOME_UNREADABLE, MISUSE, STOPPED = 0, 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Returns
    -------
    int
        0 if all went well, 1 if a notebook could not be graded, 2 if the command itself was wrong.
    """
    from dhlib.grading.batch.command import add_grade
    from dhlib.grading.batch.merge import add_merge
    from dhlib.grading.course.commands import add_course
    from dhlib.grading.reports.commands import add_reports

    parser = argparse.ArgumentParser(prog="dhlib", description="The DH book's library on the command line.")
    commands = parser.add_subparsers(metavar="COMMAND", required=True)
    add_grade(commands)
    add_merge(commands)
    add_course(commands)
    add_reports(commands)
    try:
        options = parser.parse_args(arguments)
        run: Callable[[argparse.Namespace], int] = options.run
        return run(options)
    except DHError as error:
        print(f"dhlib: {error}", file=sys.stderr)
        return MISUSE
    except BrokenPipeError:  # whoever read what is printed has seen enough, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return STOPPED
    except OSError as error:
        if error.filename is None:  # no file that somebody named
            raise
        print(f"dhlib: {error.filename}: {error.strerror}.", file=sys.stderr)
        return MISUSE
    except KeyboardInterrupt:
        print("dhlib: stopped.", file=sys.stderr)
        return STOPPED


if __name__ == "__main__":
    sys.exit(main())
