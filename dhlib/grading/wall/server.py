"""Inside the outer wall: a process that has imported what notebooks use, and forks for each submission.

Started as the only program behind the outer wall. It reads nothing of any submission: the files through which a job
comes and answers go are handed on to the child unread, so that no memory of it holds what one student wrote when the
next is forked.
"""

from __future__ import annotations

import base64
import contextlib
import gc
import io
import json
import os
import select
import signal
import socket
import sys
import time
import traceback
from typing import Any

from dhlib.grading.wall import inner
from dhlib.grading.wall.cells import Keeper, channel
from dhlib.grading.wall.shell import make_shell

LONGEST_MESSAGE = 1 << 18
FILES = 3
READY = json.dumps({"ready": True}).encode()
#: The order to end a job, before its number.
END = b"end "
#: More than a server ever has open.
MOST_FILES = 1 << 16
LARGEST_JOB = 16_000_000


def preload() -> Any:
    """Import what every notebook uses and do each thing once, so that no submission pays for it; return a shell."""
    import numpy as np

    import dhlib.grading.answers
    import dhlib.robots  # noqa: F401

    shell = make_shell()
    shell.run_cell("1 + 1", store_history=False)
    np.linalg.inv(np.eye(4) + 0.1)
    shell.reset(new_session=True)
    return shell


def _warm_sympy(_shell: Any) -> None:
    import numpy as np
    import sympy

    t = sympy.symbols("theta_1")
    matrix = sympy.Matrix([[sympy.cos(t), -sympy.sin(t)], [sympy.sin(t), sympy.cos(t)]])
    sympy.lambdify([t], list(sympy.simplify(matrix * matrix.T)), modules="numpy", cse=True)(np.zeros(2))
    str(matrix.subs(t, sympy.pi / 2))


def _warm_matplotlib(shell: Any) -> None:
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    import dhlib.plot  # noqa: F401

    shell.run_cell("%matplotlib inline", store_history=False)
    figure = plt.figure()
    figure.gca().plot([0, 1], label="a")
    figure.gca().legend()
    figure.savefig(io.BytesIO(), format="png")
    plt.close("all")


#: What takes long to import, and not every class uses: each is imported and used once when the first notebook needs it.
WARM = {"sympy": _warm_sympy, "matplotlib": _warm_matplotlib}


class Server:
    """Forks for each job that comes through a socket."""

    def __init__(self, control: socket.socket) -> None:
        self.control = control
        self.config = json.loads(control.recv(LONGEST_MESSAGE))
        self.filter = base64.b64decode(self.config["filter"])
        inner.become(self.config["user"])
        self.shell = preload()
        self._settle()

    def serve(self) -> None:
        """Serve until the other side closes."""
        self.control.send(READY)
        while True:
            message, files, _, _ = socket.recv_fds(self.control, LONGEST_MESSAGE, FILES)
            if not message:
                return
            if len(files) == FILES:
                self._serve_one(json.loads(message), files)
            else:
                WARM[json.loads(message)["warm"]](self.shell)
                self._settle()
                self.control.send(READY)

    def _settle(self) -> None:
        """Leave to no child the work of collecting what is here."""
        gc.collect()
        gc.freeze()

    def _serve_one(self, limits: dict[str, Any], files: list[int]) -> None:
        alive, held = os.pipe()
        told, tell = os.pipe()
        if os.fork() == 0:
            # Nothing here may return into the loop of the server.
            try:
                _keep_open({0, 1, 2, held, tell, *files})  # above all not the socket to the controller
                self._enter(limits, files, held, tell)
            finally:
                os._exit(1)
        for fd in (held, tell, *files):
            os.close(fd)
        with os.fdopen(told) as heard:
            first = int(heard.read() or 0)
        while True:
            ready, _, _ = select.select([alive, self.control.fileno()], [], [])
            if alive in ready and not os.read(alive, LONGEST_MESSAGE):
                break
            if self.control.fileno() not in ready:
                continue
            order = self.control.recv(LONGEST_MESSAGE)
            if not order:
                os._exit(0)  # and with this process all others behind the wall
            # An order for an earlier job may have come just as that one ended by itself.
            if first and order == END + str(limits["job"]).encode():
                with contextlib.suppress(ProcessLookupError):
                    os.kill(first, signal.SIGKILL)
        os.close(alive)
        with contextlib.suppress(ChildProcessError):
            while True:
                os.waitpid(-1, 0)
        self.control.send(json.dumps({"ended": limits["job"]}).encode())

    def _enter(self, limits: dict[str, Any], files: list[int], held: int, tell: int) -> None:
        """In a child of the server: go behind the second wall, and keep a notebook there."""
        job_file, answers, notices = files
        try:
            nowhere = os.open(os.devnull, os.O_RDWR)
            for stream in (0, 1, 2):
                os.dup2(nowhere, stream)
            inner.own_spaces()
            first = os.fork()
            if first:
                os.write(tell, str(first).encode())
                os._exit(0)
            os.close(tell)
            os.setpgid(0, 0)
            inner.own_files(int(limits["disk_bytes"]))
            with os.fdopen(job_file, "rb") as file:
                job = json.loads(file.read(LARGEST_JOB))
            ends = channel()
            inner.bound(limits)
            inner.drop_rights()
            inner.landlock()
            inner.filter_calls(self.filter)
            Keeper(job, limits, self.shell, answers, (notices, held)).run(ends)
        except Exception:
            os.write(notices, json.dumps({"failed": traceback.format_exc()[-900:]}).encode() + b"\n")
            os._exit(1)
        os._exit(0)


def _keep_open(files: set[int]) -> None:
    """Close all files but these."""
    first = 0
    for fd in sorted(files):
        if first < fd:  # an empty range is taken for all there are
            os.closerange(first, fd)
        first = fd + 1
    os.closerange(first, MOST_FILES)


def main() -> None:
    """Serve on standard input, which is a socket."""
    control = socket.socket(fileno=os.dup(0))
    nowhere = os.open(os.devnull, os.O_RDWR)
    os.dup2(nowhere, 0)
    os.dup2(nowhere, 1)
    started = time.monotonic()
    server = Server(control)
    print(f"ready after {time.monotonic() - started:.2f} s", file=sys.stderr)
    server.serve()


if __name__ == "__main__":
    main()
