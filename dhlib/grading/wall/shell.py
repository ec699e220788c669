"""The shell that a notebook's cells run in, and the stub that stands for `check` there."""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Iterator
from typing import Any

import numpy as np

from dhlib.grading.answers import MOST_ENTRIES
from dhlib.grading.wall.limits import LONGEST_ERROR

#: Forms whose requests hold no probe.
PLAIN_FORMS = frozenset({"numbers", "frames", "table", "choice", "reasoned"})
PLAIN_TYPES = frozenset({type(None), type(...), bool, int, float, complex, str, np.float64, np.int64})


class OutOfTime(BaseException):
    """A cell or a function took too long. Not an Exception, so that `except Exception` does not swallow it."""


@contextlib.contextmanager
def time_limit(seconds: float) -> Iterator[None]:
    """Interrupt what runs after so many seconds, where the system has alarms.

    This is for honest code, which keeps what it had done by then; who catches it is killed from outside a moment later.
    """
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


def handing_in(*_: Any, **__: Any) -> Any:
    """In the box `checker` and `form_checker` give this: no verdict, since no solution is here."""

    def check(part_id: str, answer: Any = None) -> None:
        print(f"{part_id}: handed in.")

    return check


def make_shell() -> Any:
    """An IPython shell without history, colours or a screen, in which `check` only takes answers in."""
    os.environ["MPLBACKEND"] = "Agg"
    from IPython.core.interactiveshell import InteractiveShell
    from traitlets.config import Config

    import dhlib.grading

    config = Config()
    config.HistoryManager.enabled = False
    config.InteractiveShell.colors = "nocolor"

    class Shell(InteractiveShell):  # type: ignore[misc, unused-ignore]
        """A shell for which ``%matplotlib`` of any kind is fine, since there is no window; it shows no errors."""

        def enable_gui(self, gui: Any = None) -> None:
            """Do nothing."""

        def showtraceback(self, *_: Any, **__: Any) -> None:
            """Do nothing: what a cell stopped with is told in a line."""

        showsyntaxerror = showindentationerror = showtraceback

    shell = Shell.instance(config=config)
    dhlib.grading.checker = dhlib.grading.form_checker = handing_in
    return shell


def run_cell(shell: Any, source: str, seconds: float) -> str | None:
    """Run a cell; return the error it stopped with, if with one."""
    try:
        with time_limit(seconds):
            # Not what a cell may have put in its place on the shell itself.
            result = type(shell).run_cell(shell, source, store_history=False)
        error = result.error_before_exec or result.error_in_exec
    except BaseException as stopped:  # SystemExit, KeyboardInterrupt, OutOfTime between two lines
        error = stopped
    return None if error is None else in_words(error)


def in_words(error: BaseException) -> str:
    """Type and text of an error, in one line; its text may be anything, even an error of its own."""
    try:
        text = str(error)[:LONGEST_ERROR]
    except BaseException:
        text = "an error without words"
    return f"{type(error).__name__[:LONGEST_ERROR]}: {text}"[:LONGEST_ERROR]


def reads_plainly(request: dict[str, Any], value: Any) -> bool:
    """Whether an answer is read without running anything of the student's, and its request tells nothing."""
    return request.get("form") in PLAIN_FORMS and _is_plain(value)


def _is_plain(value: Any, depth: int = 3) -> bool:
    """Numbers and text as Python and numpy have them, in lists of lists; no subclass, which may do as it likes."""
    kind = type(value)
    if kind in (list, tuple):
        return depth > 0 and len(value) <= MOST_ENTRIES and all(_is_plain(item, depth - 1) for item in value)
    if kind is np.ndarray:
        return value.dtype.kind in "biufc"
    return kind in PLAIN_TYPES


def read_part(shell: Any, part: str, request: dict[str, Any], seconds: float) -> dict[str, Any]:
    """Read the answer to a part from the variables of the shell."""
    from dhlib.grading.answers import MISSING, read_answer

    try:
        with time_limit(seconds):
            return read_answer(request, shell.user_ns.get(part, MISSING))
    except OutOfTime:
        return {"fault": "timeout"}
    except BaseException as error:  # SystemExit from within the student's function
        return {"fault": "raised", "type": type(error).__name__[:LONGEST_ERROR], "text": in_words(error)}
