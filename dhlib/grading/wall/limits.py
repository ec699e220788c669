"""What a stranger's notebook may use, and what comes back of it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

MIB = 1 << 20
#: How much of an error is kept.
LONGEST_ERROR = 300
#: Said wherever notebooks run without walls.
UNSAFE = "no sandbox: these notebooks run with all that you may do. Grade only your own this way."


@dataclass(frozen=True)
class Limits:
    """What one notebook may use.

    Parameters
    ----------
    cell_seconds : float
        For each cell, and for reading each answer.
    notebook_seconds : float
        For all of them together.
    memory : int
        In bytes, beyond what Python with its libraries takes.
    processes : int
        Processes and threads at a time.
    output_bytes : int
        What it may send back.
    disk_bytes : int
        Files of its own, in memory, gone when it ends.

    Examples
    --------
    >>> Limits.of(6.0).cell_seconds
    2.0
    """

    cell_seconds: float = 20.0
    notebook_seconds: float = 60.0
    memory: int = 1024 * MIB
    processes: int = 64
    output_bytes: int = 4_000_000
    disk_bytes: int = 32 * MIB

    @classmethod
    def of(cls, seconds: float) -> Limits:
        """The usual limits, with so many seconds for a notebook and a third of them for a cell."""
        return replace(cls(), notebook_seconds=seconds, cell_seconds=seconds / 3)


@dataclass
class Outcome:
    """What came back of a notebook.

    Parameters
    ----------
    readings : dict
        Part to reading; not validated.
    errors : dict
        Number of a cell to the error it stopped with.
    killers : dict
        Number of a cell that ended the whole process, or never ended, to how.
    note : str
        What to say about the run as a whole; empty if all went well.
    """

    readings: dict[str, Any] = field(default_factory=dict)
    errors: dict[int, str] = field(default_factory=dict)
    killers: dict[int, str] = field(default_factory=dict)
    note: str = ""
