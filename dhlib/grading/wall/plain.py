"""Without walls: a notebook in a process of its own, with limits of time and output and nothing more.

For one's own notebooks, and where `dhlib grade --unsafe-no-sandbox` was asked for.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from typing import Any

from dhlib.grading.notebook import Cell
from dhlib.grading.wall.limits import LONGEST_ERROR, Limits, Outcome

#: How often a box that died is started anew without the cell that killed it.
RESTARTS = 4
#: How long after its alarm a cell may take to stop before it is stopped.
GRACE = 1.0


def run_notebook(cells: Sequence[Cell], requests: Mapping[str, Any], limits: Limits) -> Outcome:
    """Run the cells of a merged notebook in a process of its own, and return the answers.

    A cell that ends the process, or never ends, costs its own answers: the rest runs again without it, within the
    same time.

    Parameters
    ----------
    cells : sequence of Cell
    requests : mapping
        Part to request; nothing of the solution goes into the box.
    limits : Limits
        Those of time and output; the others are for walls to hold.
    """
    outcome = Outcome()
    deadline = time.monotonic() + limits.notebook_seconds
    heard = False
    for _ in range(RESTARTS + 1):
        job = {
            "cells": [{"source": cell.source, "role": cell.role, "part": cell.part} for cell in cells],
            "requests": dict(requests),
            "skip": sorted(outcome.killers),
            "cell_seconds": limits.cell_seconds,
        }
        state = _run_once(job, outcome, deadline, limits.output_bytes)
        heard = heard or state["heard"]
        if state["done"]:
            return outcome
        last = state["cell"]
        left = deadline - time.monotonic()
        if last is None or left <= 0:
            break
        outcome.killers[last] = "ended the program"
    if time.monotonic() >= deadline:
        outcome.note = f"The notebook was stopped after {limits.notebook_seconds:g} s."
    elif heard:
        outcome.note = "The notebook ended its own program."
    else:
        outcome.note = "No Python with IPython could be started for it: install dhlib[grade]."
    return outcome


def _run_once(job: dict[str, Any], outcome: Outcome, deadline: float, budget: int) -> dict[str, Any]:
    """Run the box once; return in which cell it ended, if in one, and whether it came to its end."""
    state: dict[str, Any] = {"cell": None, "since": 0.0, "done": False, "heard": False}
    with tempfile.TemporaryDirectory(prefix="dhlib-") as folder:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "dhlib.grading.wall.plain_box"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            cwd=folder,
            env=_environment(folder),
            start_new_session=True,
        )
        listener = threading.Thread(target=_listen, args=(process, outcome, state, budget), daemon=True)
        listener.start()
        with contextlib.suppress(OSError):
            assert process.stdin is not None
            process.stdin.write(json.dumps(job).encode())
            process.stdin.close()
        while process.poll() is None and not _late(state, job["cell_seconds"], deadline):
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(0.05)
        _end(process)
        listener.join(1.0)
    return state


def _late(state: dict[str, Any], cell_seconds: float, deadline: float) -> bool:
    """Whether the notebook has had its time, or a cell did not stop when it was told to."""
    now = time.monotonic()
    return now > deadline or (state["cell"] is not None and now > state["since"] + cell_seconds + GRACE)


def _environment(folder: str) -> dict[str, str]:
    """What the box needs of the environment, and no more."""
    kept = {
        name: os.environ[name] for name in ("PATH", "LANG", "LC_ALL", "SYSTEMROOT", "VIRTUAL_ENV") if name in os.environ
    }
    return kept | {
        "HOME": folder,
        "IPYTHONDIR": folder,
        "MPLCONFIGDIR": folder,
        "TMPDIR": folder,
        "OMP_NUM_THREADS": "1",
    }


def _listen(process: subprocess.Popen[bytes], outcome: Outcome, state: dict[str, Any], budget: int) -> None:
    """Read messages line by line; what is not one is left out."""
    assert process.stdout is not None
    while budget > 0 and (line := process.stdout.readline(budget)):
        budget -= len(line)
        try:
            message = json.loads(line)
        except (ValueError, RecursionError):
            continue
        if not isinstance(message, dict):
            continue
        state["heard"] = True
        match message:
            case {"begin": int(cell)}:
                state["cell"], state["since"] = cell, time.monotonic()
            case {"end": int(cell)}:
                state["cell"] = None
                if isinstance(message.get("error"), str):
                    outcome.errors[cell] = message["error"][:LONGEST_ERROR]
            case {"part": str(part), "reading": reading}:
                outcome.readings[part] = reading
            case {"done": True}:
                state["done"] = True
                return
    _end(process)


def _end(process: subprocess.Popen[bytes]) -> None:
    """End the box and whatever it started and left in its group."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        if hasattr(os, "killpg"):
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(2.0)
