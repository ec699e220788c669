"""The trusted side: a place where strangers' notebooks run, one after the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import TracebackType
from typing import Any

from dhlib.grading.notebook import Cell
from dhlib.grading.wall.limits import Limits, Outcome
from dhlib.grading.wall.plain import run_notebook


class Sandbox:
    """Runs notebooks, one after the other; one for each worker, not shared between threads.

    Parameters
    ----------
    limits : Limits, optional
        For each notebook.
    unsafe : bool
        Run without walls: for one's own notebooks only.

    Raises
    ------
    DHError
        If no wall can be built on this machine; the message says what to install.

    Examples
    --------
    >>> with Sandbox(unsafe=True) as sandbox:
    ...     sandbox.run([], {}).readings
    {}
    """

    def __init__(self, limits: Limits | None = None, *, unsafe: bool = False) -> None:
        self.limits = limits or Limits()
        self.unsafe = unsafe

    def run(self, cells: Sequence[Cell], requests: Mapping[str, Any], limits: Limits | None = None) -> Outcome:
        """Run the cells of a merged notebook and return its answers; never raises for what the cells do.

        Parameters
        ----------
        cells : sequence of Cell
            As `merge` gives them.
        requests : mapping
            Part to request; nothing of the solution goes behind the wall.
        limits : Limits, optional
            For this notebook.
        """
        return run_notebook(cells, requests, limits or self.limits)

    def close(self) -> None:
        """End whatever still runs; the next `run` would start anew."""

    def __enter__(self) -> Sandbox:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
