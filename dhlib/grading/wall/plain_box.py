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

import json
import os
import sys
from typing import Any, TextIO

from dhlib.grading.wall.shell import make_shell, read_part, run_cell


def run(job: dict[str, Any], out: TextIO) -> None:
    """Run a job."""

    def send(**message: Any) -> None:
        out.write(json.dumps(message, allow_nan=False) + "\n")
        out.flush()

    shell = make_shell()
    seconds = float(job["cell_seconds"])
    for k, cell in enumerate(job["cells"]):
        part = cell["part"]
        if k in job["skip"]:
            if cell["role"] == "check":
                send(part=part, reading={"fault": "timeout"})
            continue
        send(begin=k)
        error = None
        if cell["role"] == "check":
            send(part=part, reading=read_part(shell, part, job["requests"][part], seconds))
        else:
            error = run_cell(shell, cell["source"], seconds)
        send(end=k, error=error)
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
