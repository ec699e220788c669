"""Behind both walls: run a notebook cell by cell, swiftly first, and with care where something died.

Two kinds of process, both in namespaces of their own:

* the *keeper*, the first process there, runs no code of the student. It says which cell is next, kills what takes too
  long, and tells the controller. Nothing in its namespaces can signal or trace it.
* a *state* holds the variables of the notebook.

With *care*, a state forks to run a cell, and waits: the child runs the cell. If the child dies, the state goes on
without that cell; otherwise the child is the new state, and the keeper ends the old one.

But nearly all notebooks run to their end, and a fork of a process of this size costs more than most cells. So for its
first moments a notebook runs *swiftly*: one state runs the cells by itself. Should it die, hang, or be left in no
condition for the next cell, the keeper says "again", and the controller has the notebook run once more, in new walls
and with care from the beginning. Those moments and that cell are all the time that is lost by it.

Either way an answer is read in a child that ends afterwards, so that reading changes nothing; only for plain data,
where reading is none of the student's business, a swift state saves the fork.

A state has run the student's code, and all it says may be a lie. The keeper believes only what the kernel certifies,
the number of the process that speaks, and relies on it for nothing but the student's own marks.
"""

from __future__ import annotations

import array
import contextlib
import json
import mmap
import os
import select
import signal
import socket
import struct
import sys
import time
from collections.abc import Sequence
from typing import Any

from dhlib.grading.wall.shell import read_part, reads_plainly, run_cell

#: How long a cell may take beyond its time to stop by itself, and a state to say that a cell has ended.
GRACE = 0.5
#: How long the state before a cell may take to hear that the cell was killed: a machine full of its processes is slow.
KILL_SECONDS = 3.0
ENDED = "the program of the notebook ended"
LONGEST_COMMAND = 1 << 20
LONGEST_REPORT = 200
#: Memory that a cell leaves to the next, in bytes; asked for and not used.
ROOM = 16 << 20
MOST_REPORTS = 10_000
#: How often a state tries to fork.
FORKS = 20

CREDENTIALS = struct.Struct("iII")


class Lost(Exception):
    """The notebook cannot go on."""


class Again(Exception):
    """The notebook should run once more, with care; `hung` is the cell that did not end in its time, or None."""

    def __init__(self, hung: int | None = None) -> None:
        super().__init__()
        self.hung = hung


def channel() -> tuple[socket.socket, socket.socket]:
    """A pair of sockets, for the keeper and the states; the keeper's end says which process speaks."""
    keeper, states = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    keeper.setsockopt(socket.SOL_SOCKET, socket.SO_PASSCRED, 1)
    keeper.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, LONGEST_COMMAND)
    return keeper, states


class Keeper:
    """Leads the states through a job.

    Parameters
    ----------
    job : dict
        ``{"cells": [{"source", "role", "part"}, …], "requests": {part: request}}``.
    limits : dict
        With ``cell_seconds``, for how long it runs ``swift``, and which cell ``hung`` before: it is not tried again.
    shell
        Pristine; only states use it.
    answers : int
        File descriptor: what states say to the controller.
    own : tuple of int
        Those that states do not get: what the keeper says to the controller, and what shows the server that it lives.
    """

    def __init__(
        self, job: dict[str, Any], limits: dict[str, Any], shell: Any, answers: int, own: tuple[int, int]
    ) -> None:
        self.job, self.shell = job, shell
        self.seconds = float(limits["cell_seconds"])
        self.swift, self.hung = float(limits["swift"]), limits["hung"]
        self.answers, self.own = answers, own
        self.reports = 0

    def run(self, ends: tuple[socket.socket, socket.socket]) -> None:
        """Run all cells; return when there is nothing more to run."""
        self.socket, theirs = ends
        cells = self.job["cells"]
        # What is asked about the answers stays here until it is: a cell need not know.
        requests = self.job["requests"]
        self.state = os.fork()
        if self.state == 0:
            del self.job
            self.socket.close()
            for fd in self.own:
                os.close(fd)
            live(theirs, cells, self.shell, self.answers, self.seconds)
        theirs.close()
        swift_until = time.monotonic() + self.swift

        def step(run: list[int], request: Any) -> bool:
            return (self._stride if time.monotonic() < swift_until else self._step)(run, request)

        try:
            ours: list[int] = []  # cells of the exercise that wait to run with the next one
            for k, cell in enumerate(cells):
                if cell["role"] == "setup":
                    ours.append(k)
                elif cell["role"] == "check":
                    if ours:
                        step(ours, None)
                        ours = []
                    step([k], requests.get(cell["part"], {}))
                elif step([*ours, k], None):
                    ours = []
        except Again as again:
            self._notice(again=True, hung=again.hung)
        except Lost as lost:
            self._notice(lost=str(lost))
        except Exception as error:  # whatever a notebook made of it, it costs that notebook and not the class
            self._notice(lost=f"its keeper met {error!r}"[:LONGEST_REPORT])
        else:
            self._notice(done=True)

    def _stride(self, run: list[int], request: Any) -> bool:
        """Have the state itself run cells, or read an answer; anything else than success asks for care."""
        success = ["done" if request is None else "read", run[-1]]
        try:
            self._send({"run": run, "request": request, "care": False})
            deadline = time.monotonic() + self.seconds + GRACE
            while True:
                pid, said = self._hear(deadline)
                if pid == self.state and said == success:
                    return True
                if pid in (0, self.state):
                    raise Again(run[-1] if pid == 0 else None)
        except Lost:
            raise Again from None

    def _step(self, run: list[int], request: Any) -> bool:
        """Run cells from the state, or read an answer; whether there is a new state, so that no cell was lost."""
        k, state = run[-1], self.state
        if k == self.hung:
            self._notice(killed=k, how="time")
            return False
        self._send({"run": run, "request": request, "care": True})
        deadline = time.monotonic() + self.seconds + GRACE
        runner = 0
        while True:
            pid, said = self._hear(deadline)
            if pid == 0:  # time is up
                if not runner or not self._kill(runner, k, state):
                    raise Lost("a cell could not be stopped")
                self._notice(killed=k, how="time")
                return False
            if pid == state and said == ["died", k]:
                self._notice(killed=k, how="died")
                self._sweep(runner)
                return False
            if pid == state and said == ["read", k] and request is not None:
                return False
            if said == ["begin", k] and not runner and pid != state:
                runner = pid
            elif said == ["done", k] and pid == runner and request is None:
                os.kill(state, signal.SIGKILL)
                self._reap()
                self.state = runner
                return True

    def _kill(self, runner: int, k: int, state: int) -> bool:
        """End a cell; whether the state before it can go on."""
        self._sweep(runner)
        deadline = time.monotonic() + KILL_SECONDS
        while True:
            pid, said = self._hear(deadline)
            if pid == 0:
                return False
            if pid == state and said in (["died", k], ["read", k]):
                return True

    def _sweep(self, runner: int) -> None:
        """Kill a process and its group."""
        for kill in (os.kill, os.killpg):
            with contextlib.suppress(OSError):
                if runner > 1:
                    kill(runner, signal.SIGKILL)
        self._reap()

    def _reap(self) -> None:
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass

    def _send(self, command: Any) -> None:
        data = json.dumps(command).encode()
        if len(data) > LONGEST_COMMAND // 2:
            raise Lost("a question is too long")
        while True:
            if not select.select([], [self.socket], [], GRACE)[1]:
                raise Lost("a cell does not listen")
            try:
                self.socket.send(data, socket.MSG_DONTWAIT)
                return
            except BlockingIOError:
                raise Lost("a cell does not listen") from None
            except OSError:
                raise Lost(ENDED) from None

    def _hear(self, deadline: float) -> tuple[int, Any]:
        """The next report and the process it is from; (0, None) after the deadline."""
        while (left := deadline - time.monotonic()) > 0:
            if not select.select([self.socket], [], [], min(left, 1.0))[0]:
                continue
            try:
                data, extra, _, _ = self.socket.recvmsg(LONGEST_REPORT, 512, socket.MSG_DONTWAIT)
            except ConnectionResetError:  # they ended with a command unread
                raise Lost(ENDED) from None
            self.reports += 1
            if self.reports > MOST_REPORTS:
                raise Lost("it sent reports without end")
            pid = 0
            for level, kind, value in extra:
                if level == socket.SOL_SOCKET and kind == socket.SCM_CREDENTIALS:
                    pid = CREDENTIALS.unpack(value[: CREDENTIALS.size])[0]
                elif level == socket.SOL_SOCKET and kind == socket.SCM_RIGHTS:
                    received = array.array("i")
                    received.frombytes(value[: len(value) - len(value) % received.itemsize])
                    for fd in received:
                        os.close(fd)
            if not data:
                raise Lost(ENDED)
            if pid > 1:
                with contextlib.suppress(ValueError, RecursionError):
                    return pid, json.loads(data)
        return 0, None

    def _notice(self, **notice: Any) -> None:
        os.write(self.own[0], json.dumps(notice).encode() + b"\n")


def live(channel: socket.socket, cells: Sequence[dict[str, str]], shell: Any, answers: int, seconds: float) -> None:
    """A state: run the cells that the keeper names, with care each in a child that is the next state. Never returns."""
    # Names of its own for all it needs: a cell may put anything else in place of what modules hold.
    fork, wait, leave, own, group = os.fork, os.waitpid, os._exit, os.getpid, os.setpgid
    load, dump, nap, threads, space = json.loads, json.dumps, time.sleep, sys._current_frames, mmap.mmap

    def report(word: str, k: int) -> None:
        channel.send(dump([word, k]).encode())

    def answer(message: dict[str, Any]) -> None:
        data = dump(message, allow_nan=False).encode() + b"\n"
        while data:
            data = data[os.write(answers, data) :]

    def fork_soon() -> int:
        # What was killed a moment ago may still count against the limit of processes.
        for _ in range(FORKS):
            try:
                return fork()
            except OSError:
                nap(0.01)
        return fork()

    private = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS
    me = own()
    try:
        while True:
            command = channel.recv(LONGEST_COMMAND)
            if own() != me or not command:  # a copy that a cell made of itself
                leave(0)
            asked = load(command)
            k = asked["run"][-1]
            part, request, care = cells[k]["part"], asked["request"], asked["care"]
            swift = not care and (request is None or reads_plainly(request, shell.user_ns.get(part)))
            if not swift:
                if child := fork_soon():
                    status = wait(child, 0)[1]
                    report("read" if request is not None and status == 0 else "died", k)
                    continue
                me = own()
                group(0, 0)
            if care:
                report("begin", k)
            if request is not None:
                answer({"part": part, "reading": read_part(shell, part, request, seconds)})
                if not swift:
                    leave(0)
                report("read", k)
                continue
            for one in asked["run"]:
                error = run_cell(shell, cells[one]["source"], seconds)
                if own() != me:
                    leave(0)
                if error is not None:
                    answer({"cell": one, "error": error})
            if len(threads()) > 1:
                if not care:  # they would live on beside the next cell, which no fork lets them
                    leave(0)
                # so many that no process is left for the next cell? Then this cell is lost instead.
                if (probe := fork_soon()) == 0:
                    leave(0)
                wait(probe, 0)
            space(-1, ROOM, private).close()  # so full that nothing more can be run? Then, too.
            report("done", k)
    except BaseException:
        leave(1)
    finally:
        leave(1)
