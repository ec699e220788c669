"""The untrusted process: run one notebook's cells, read its answers, send them home as JSON.

Started by `plain` as ``python -m dhlib.grading.wall.plain_box`` with a job on standard input:

    {"cells": [{"source": …, "role": …, "part": …}, …], "requests": {part: request, …}, "skip": […], "cell_seconds": …}

It answers on what was its standard output, which the student's code never sees, one JSON object a line:
``{"begin": k}`` before cell k, ``{"end": k, "error": text or null}`` after it, ``{"part": …, "reading": …}`` for each
answer, and ``{"done": true}``.

No reference and no marking code is loaded here. This is a process of its own with a time limit and bounded output,
and *not* a sandbox: the student's code may do whatever its user may do.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
from collections.abc import Iterator
from typing import Any, TextIO

LONGEST_ERROR = 300


class OutOfTime(BaseException):
    """A cell or a function took too long. Not an Exception, so that `except Exception` does not swallow it."""


@contextlib.contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Interrupt what runs after so many seconds, where the system has alarms; `plain` has a limit of its own."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def stop(*_: Any) -> None:
        raise OutOfTime(f"stopped after {seconds:g} s")

    signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)


def handing_in(name: str, exercises: str | None = None) -> Any:
    """In the box `checker` gives this: no verdict, since no solution is here."""

    def check(part_id: str, answer: Any = None) -> None:
        print(f"{part_id}: handed in.")

    return check


def make_shell() -> Any:
    """An IPython shell without history, colours or a screen."""
    os.environ["MPLBACKEND"] = "Agg"
    from IPython.core.interactiveshell import InteractiveShell
    from traitlets.config import Config

    config = Config()
    config.HistoryManager.enabled = False
    config.InteractiveShell.colors = "nocolor"

    class Shell(InteractiveShell):  # type: ignore[misc, unused-ignore]
        """A shell for which ``%matplotlib`` of any kind is fine: there is no window to open."""

        def enable_gui(self, gui: Any = None) -> None:
            """Do nothing."""

    return Shell.instance(config=config)


def run(job: dict[str, Any], out: TextIO) -> None:
    """Run a job."""
    import dhlib.grading
    from dhlib.grading.answers import MISSING, read_answer

    def send(**message: Any) -> None:
        out.write(json.dumps(message, allow_nan=False) + "\n")
        out.flush()

    shell = make_shell()
    dhlib.grading.checker = handing_in
    seconds = float(job["cell_seconds"])
    for k, cell in enumerate(job["cells"]):
        if k in job["skip"]:
            if cell["role"] == "check":
                send(part=cell["part"], reading={"fault": "timeout"})
            continue
        send(begin=k)
        if cell["role"] == "check":
            part = cell["part"]
            try:
                with time_limit(seconds):
                    reading = read_answer(job["requests"][part], shell.user_ns.get(part, MISSING))
            except OutOfTime:
                reading = {"fault": "timeout"}
            send(part=part, reading=reading)
            send(end=k, error=None)
            continue
        try:
            with time_limit(seconds):
                result = shell.run_cell(cell["source"], store_history=False)
            error = result.error_before_exec or result.error_in_exec
        except BaseException as stopped:  # SystemExit, KeyboardInterrupt, OutOfTime between two lines
            error = stopped
        send(end=k, error=None if error is None else f"{type(error).__name__}: {error}"[:LONGEST_ERROR])
    send(done=True)


def main() -> None:
    """Run the job on standard input, with standard output kept for the answers."""
    job = json.load(sys.stdin)
    out = os.fdopen(os.dup(1), "w", encoding="utf-8", errors="replace")
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)
    run(job, out)
    out.flush()
    os._exit(0)  # threads that a cell started do not keep us


if __name__ == "__main__":
    main()
