"""The trusted side: start a box, send it notebooks one after the other, hear their answers, end them in time."""

from __future__ import annotations

import base64
import contextlib
import json
import math
import os
import re
import select
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from dhlib.errors import DHError
from dhlib.grading.notebook import Cell
from dhlib.grading.wall.cgroup import SERVER_MEMORY, ControlGroup
from dhlib.grading.wall.filter import compile_filter
from dhlib.grading.wall.inner import landlock_version
from dhlib.grading.wall.limits import LONGEST_ERROR, Limits, Outcome
from dhlib.grading.wall.outer import Outer, find_outer
from dhlib.grading.wall.plain import run_notebook
from dhlib.grading.wall.reader import Refused, read_json
from dhlib.grading.wall.view import view

LONGEST_MESSAGE = 1 << 18
START_SECONDS = 120.0
#: How long a notebook is given to end after its time, and its box after it was told to end it.
GRACE = 0.25
END_SECONDS = 0.5
#: How long a notebook runs before it is worth a fork to keep what it has.
SWIFT_SECONDS = 2.0
#: How often memory is watched where no control group does.
WATCH_SECONDS = 0.2
CHUNK = 1 << 16
#: What stands in a notebook, or in what is asked of it, that needs such a library. A box imports it outside the time
#: of any notebook; where one needs it in other words, it imports it within its own.
NEEDS = {
    "sympy": re.compile(rb"sympy|symb|compiled|formula|from_table"),
    "matplotlib": re.compile(rb"matplotlib|pylab|plt|plot"),
}
#: More than this is no notebook.
LARGEST_JOB = 12_000_000

STOPPED = "The notebook was stopped after {seconds:g} s."
FLOODED = "The notebook was stopped: it sent answers without end."
STARVED = "The notebook was stopped: it took more memory than it may."
BROKEN = "The notebook broke the box that it ran in."
LOST = "The notebook could not be run to its end: {why}."
HOW = {"time": "never ended", "died": "ended the program"}


class Crashed(Exception):
    """The box itself ended."""


class Sandbox:
    """Runs notebooks, one after the other; one for each worker, not shared between threads.

    Its box starts with the first notebook, which takes a second or two, and starts anew after a crash.

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
        self._box: Box | None = None
        self._outer = None if unsafe else find_outer()
        self._filter = b"" if unsafe else compile_filter()

    @property
    def walls(self) -> str:
        """What stands around the notebooks, in a word."""
        return self._outer.name if self._outer else "none"

    def extras(self) -> list[tuple[str, bool, str]]:
        """Walls that not every machine has: their name, whether it stands, and what holds otherwise."""
        group = self._box.group if self._box else None
        return [
            ("a control group bounds memory", bool(group and group.memory), "the controller watches the sum"),
            ("a control group bounds processes", bool(group and group.processes), "a limit of the user does"),
            ("Landlock", landlock_version() > 0, "this kernel has none; mounts alone keep files apart"),
        ]

    def run(self, cells: Sequence[Cell], requests: Mapping[str, Any], limits: Limits | None = None) -> Outcome:
        """Run the cells of a merged notebook and return its answers; never raises for what the cells do.

        Parameters
        ----------
        cells : sequence of Cell
            As `merge` gives them.
        requests : mapping
            Part to request; nothing of the solution goes behind the wall.
        limits : Limits, optional
            For this notebook. More memory or processes than the sandbox was made for are not to be had.

        Raises
        ------
        DHError
            If the box cannot be started.
        """
        limits = limits or self.limits
        if self._outer is None:
            return run_notebook(cells, requests, limits)
        job = {
            "cells": [{"source": cell.source, "role": cell.role, "part": cell.part} for cell in cells],
            "requests": dict(requests),
        }
        data = json.dumps(job).encode()
        if len(data) > LARGEST_JOB:
            return Outcome(note="The code of the notebook is too long to be run.")
        needs = {name for name, words in NEEDS.items() if words.search(data)}
        care, hung, broken = False, None, False
        deadline = time.monotonic() + limits.notebook_seconds
        while True:
            started = time.monotonic()
            if self._box is None:
                self._box = Box(self._outer, self._filter, self.limits)
            run = Run(self._box, cells, limits, care, hung)
            outcome = run.outcome
            try:
                self._box.warm(needs)
                deadline += time.monotonic() - started  # the time is the notebook's
                run.run(data, deadline)
            except Crashed:
                self.close()
                outcome.note = outcome.note or BROKEN
                # A box that was broken, perhaps from without, is built anew once, within the notebook's time.
                if broken or outcome.note != BROKEN or time.monotonic() > deadline:
                    return outcome
                broken = True
            else:
                if not run.again or outcome.note:
                    return outcome
                care, hung = True, run.hung  # nothing is kept of a swift run in which a cell died

    def close(self) -> None:
        """End the box and all that runs in it; the next `run` would start one anew."""
        if self._box is not None:
            self._box.close()
            self._box = None

    def __enter__(self) -> Sandbox:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class Box:
    """A server behind the outer wall."""

    def __init__(self, outer: Outer, filter_: bytes, limits: Limits) -> None:
        self.group = ControlGroup(limits)
        self.control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.jobs = 0
        self.warmed: set[str] = set()
        self.others = processes_that_count()
        said = tempfile.TemporaryFile()  # noqa: SIM115
        self.process = subprocess.Popen(
            [*_going_in(self.group), *outer.command(view())],
            stdin=theirs.fileno(),
            stdout=subprocess.DEVNULL,
            stderr=said,
            cwd="/",
            env={"PATH": os.environ.get("PATH", os.defpath)},
        )
        theirs.close()
        config = {"filter": base64.b64encode(filter_).decode(), "user": outer.user}
        try:
            self.control.send(json.dumps(config).encode())
            self.control.settimeout(START_SECONDS)
            ready = bool(self.control.recv(LONGEST_MESSAGE))
        except OSError:
            ready = False
        if not ready:
            said.seek(0)
            lines = said.read().decode(errors="replace").strip().splitlines()
            self.close()
            raise DHError(
                f"the box for notebooks could not be started: {lines[-1][:500] if lines else 'it said nothing'}. "
                'Is dhlib installed with its extra, pip install "dhlib[grade]"? `dhlib grade --doctor` looks closer.'
            )
        said.close()
        self.control.settimeout(None)
        self.group.holds(self.process.pid)

    def warm(self, libraries: set[str]) -> None:
        """Have it import libraries, unless it has; raises Crashed if it ends over that."""
        for name in sorted(libraries - self.warmed):
            self.control.settimeout(START_SECONDS)
            try:
                self.control.send(json.dumps({"warm": name}).encode())
                if not self.control.recv(LONGEST_MESSAGE):
                    raise Crashed
            except OSError:
                raise Crashed from None
            self.control.settimeout(None)
            self.warmed.add(name)

    @property
    def watched(self) -> bool:
        """Whether the controller has to watch the memory, since no control group does."""
        return not self.group.memory

    def relieve(self, limit: int) -> bool:
        """End what takes most, as a control group would, until all together take no more bytes; whether that went."""
        taken = {pid: _proportional(pid) for pid in descendants(self.process.pid)}
        over = sum(taken.values()) - limit
        students = set(self._of_the_notebook())
        for pid in sorted(taken, key=lambda pid: -taken[pid]):
            if over <= 0:
                break
            if pid in students and self._end(pid):
                over -= taken[pid]
        return over <= 0

    def _of_the_notebook(self) -> Iterator[int]:
        """The processes that run the student's code: the server has a keeper, and the keeper has them."""
        for server in _children(self.process.pid):
            for keeper in _children(server):
                yield from descendants(keeper)[1:]

    def _end(self, pid: int) -> bool:
        """End a process of the notebook; false if it cannot be done. By now another may have its number."""
        try:
            handle = os.pidfd_open(pid)
        except ProcessLookupError:
            return True
        except OSError:
            return False
        try:
            if pid in self._of_the_notebook():
                signal.pidfd_send_signal(handle, signal.SIGKILL)
        except ProcessLookupError:
            pass
        except OSError:
            return False
        finally:
            os.close(handle)
        return True

    def close(self) -> None:
        """End it."""
        self.control.close()  # which ends the server, and with it all that is behind the wall
        try:
            self.process.wait(END_SECONDS)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.group.close()


class Run:
    """One notebook in a box, swiftly at first or with care throughout."""

    def __init__(self, box: Box, cells: Sequence[Cell], limits: Limits, care: bool, hung: int | None = None) -> None:
        self.box, self.cells, self.limits, self.care, self.hung = box, cells, limits, care, hung
        self.outcome = Outcome()
        self.again = False  # whether it needs care
        self.parts = {cell.part for cell in cells if cell.role == "check"}
        self.budget = limits.output_bytes
        self.finished = False
        self.ended = 0.0  # when the box was told to end it
        self.heard: dict[int, bytes] = {}  # pipe to what came through it behind the last whole line

    def run(self, job: bytes, deadline: float) -> None:
        """Run it to its end; raises Crashed if the box ended."""
        with contextlib.ExitStack() as ours:
            (job_out, job_in), (self.answers, answers_in), (self.notices, notices_in) = (os.pipe() for _ in range(3))
            for fd in (self.answers, self.notices):
                ours.callback(os.close, fd)
            to_box = open(job_in, "wb", buffering=0)  # noqa: SIM115
            ours.callback(to_box.close)
            theirs = [job_out, answers_in, notices_in]
            self.box.jobs += 1
            limits = asdict(self.limits)
            limits |= {"others": self.box.others, "base": SERVER_MEMORY, "job": self.box.jobs}
            limits |= {"swift": 0.0 if self.care else SWIFT_SECONDS, "hung": self.hung}
            try:
                socket.send_fds(self.box.control, [json.dumps(limits).encode()], theirs)
            except OSError:
                raise Crashed from None
            finally:
                for fd in theirs:
                    os.close(fd)
            for fd in (job_in, self.answers, self.notices):
                os.set_blocking(fd, False)
            self.heard = {self.answers: b"", self.notices: b""}
            self._converse(memoryview(job), to_box, deadline)
        if not (self.finished or self.again or self.outcome.note):
            self.outcome.note = LOST.format(why="its program ended")

    def _converse(self, job: memoryview, to_box: IO[bytes], deadline: float) -> None:
        """Send the job and hear what comes back, until the box says that all of it has ended."""
        control = self.box.control
        watch = time.monotonic() + WATCH_SECONDS if self.box.watched else math.inf
        while True:
            now = time.monotonic()
            if not self.ended and now > deadline + GRACE:
                self._end(STOPPED.format(seconds=self.limits.notebook_seconds))
            if self.ended and now > self.ended + END_SECONDS:
                raise Crashed
            if now > watch:
                watch = now + WATCH_SECONDS
                if not self.box.relieve(self.limits.memory + SERVER_MEMORY):
                    self._end(STARVED)
            until = min(watch, self.ended + END_SECONDS if self.ended else deadline + GRACE)
            reading = [control.fileno(), *self.heard]
            writing = [] if to_box.closed else [to_box]
            ready, writable, _ = select.select(reading, writing, [], max(0.0, until - now) + 0.001)
            if writable:
                job = _send_some(job, to_box)
            for fd in (fd for fd in ready if fd in self.heard):
                self._hear(fd)
            if control.fileno() in ready:
                try:
                    said = control.recv(LONGEST_MESSAGE)
                except OSError:  # the box is gone
                    raise Crashed from None
                if said != json.dumps({"ended": self.box.jobs}).encode():
                    raise Crashed
                for fd in [*self.heard]:  # nobody is left who could write, so what is there is all there will be
                    while self._hear(fd):
                        pass
                return

    def _hear(self, fd: int) -> bool:
        """Read what there is, and heed whole lines; whether there may be more."""
        if fd not in self.heard:
            return False
        try:
            data = os.read(fd, CHUNK)
        except BlockingIOError:
            return False
        if fd == self.answers:
            self.budget -= len(data)
        if not data or self.budget < 0:
            del self.heard[fd]
            if self.budget < 0:
                self._end(FLOODED)
            return False
        *lines, self.heard[fd] = (self.heard[fd] + data).split(b"\n")
        for line in lines:
            with contextlib.suppress(Refused):
                (self._notice if fd == self.notices else self._answer)(read_json(line))
        return True

    def _end(self, note: str) -> None:
        """Tell the box to end the notebook."""
        if not self.ended:
            self.ended = time.monotonic()
            self.outcome.note = note
            with contextlib.suppress(OSError):
                self.box.control.send(f"end {self.box.jobs}".encode())

    def _answer(self, message: Any) -> None:
        """What a student's process says: of its own answers, and nothing else."""
        match message:
            case {"part": str(part), "reading": dict(reading)} if part in self.parts:
                self.outcome.readings[part] = reading
            case {"cell": int(k), "error": str(error)} if 0 <= k < len(self.cells):
                self.outcome.errors[k] = error[:LONGEST_ERROR]

    def _notice(self, message: Any) -> None:
        """What the keeper says, which runs nothing of the student."""
        match message:
            case {"killed": int(k), "how": str(how)} if 0 <= k < len(self.cells):
                cell = self.cells[k]
                if cell.role == "check":
                    self.outcome.readings[cell.part] = {"fault": "timeout" if how == "time" else "skipped"}
                else:
                    self.outcome.killers[k] = HOW.get(how, how)
            case {"lost": str(why)}:
                self.outcome.note = self.outcome.note or LOST.format(why=why)
            case {"failed": str(why)}:
                raise DHError(f"a box for the notebook could not be set up: {why}")
            case {"again": True, "hung": int() | None as hung} if not self.care:
                self.again, self.hung = True, hung
            case {"done": True}:
                self.finished = True


def _send_some(job: memoryview, to_box: IO[bytes]) -> memoryview:
    """Send as much of the job as goes; close when it is sent, or when nobody reads it."""
    try:
        job = job[to_box.write(job[:CHUNK]) or 0 :]
    except BrokenPipeError:
        job = job[:0]
    if not job:
        to_box.close()
    return job


def _going_in(group: ControlGroup) -> list[str]:
    """A command that goes into a control group, offers itself first when memory runs out, and starts another."""
    shell = shutil.which("sh")
    if not shell:
        return []
    steps = [f"{{ echo $$ > '{entrance}'; }} 2>/dev/null" for entrance in group.entrances]
    steps.append("{ echo 1000 > /proc/self/oom_score_adj; } 2>/dev/null")
    return [shell, "-c", f'{"; ".join(steps)}; exec "$@"', "sh"]


def processes_that_count() -> int:
    """How many processes of this user count against the limit behind the wall: none where namespaces count alone."""
    release = os.uname().release.split(".")
    with contextlib.suppress(ValueError, IndexError):
        if (int(release[0]), int(release[1].split("-")[0])) >= (5, 14):
            return 0
    return 4096


def descendants(pid: int) -> list[int]:
    """The process and all that it started, directly or not."""
    found, waiting = [], [pid]
    while waiting:
        pid = waiting.pop()
        found.append(pid)
        waiting += _children(pid)
    return found


def _children(pid: int) -> list[int]:
    found: list[int] = []
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            found += map(int, children.read_text().split())
    return found


def _proportional(pid: int) -> int:
    """Memory of a process in bytes, its share of what is in common; what is read from files counts for nobody."""
    found = {"Pss:": 0, "Pss_File:": 0}
    with contextlib.suppress(OSError), Path(f"/proc/{pid}/smaps_rollup").open() as file:
        for line in file:
            name, *values = line.split()
            if name in found:
                found[name] = int(values[0]) * 1024
    return found["Pss:"] - found["Pss_File:"]
