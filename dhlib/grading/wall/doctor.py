"""``dhlib grade --doctor``: which walls stand on this machine, each tried by something that should fail."""

from __future__ import annotations

import contextlib
import os
import platform
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

from dhlib.errors import DHError
from dhlib.grading.notebook import Cell
from dhlib.grading.wall.limits import MIB, Limits, Outcome
from dhlib.grading.wall.sandbox import HOW, Sandbox, processes_that_count
from dhlib.grading.wall.shell import OutOfTime

LIMITS = Limits(cell_seconds=3.0, notebook_seconds=8.0, memory=256 * MIB)
#: Readings of a cell that did not come to its end.
STOPPED = ("missing", "undefined", "skipped")
REQUEST = {"A": {"form": "numbers", "shape": []}}
HARMLESS = "A = 1 + 1"
LATE = "its time ended before anything stopped it, perhaps since the machine is busy: try again"


@dataclass(frozen=True)
class Probe:
    """Something that a notebook should not be able to do.

    Parameters
    ----------
    wall : str
        What should stop it, in words.
    source : str
        A cell that tries; it sets A to 1 where it succeeds. Names in braces are filled in from outside.
    endless : bool
        Whether the end of its time is what should stop it. For any other it shows nothing.
    """

    wall: str
    source: str
    endless: bool = False


PROBES = (
    Probe("a secret file of yours cannot be read", "A = open({secret!r}).read().count('secret')"),
    Probe("exercises and their references cannot be read", """
import os, dhlib
here = os.path.dirname(os.path.dirname(dhlib.__file__))
A = sum(os.path.exists(p) for p in (here + '/exercises/quickshot.py', here + '/dhlib/_exercises/quickshot.py'))"""),
    Probe("nothing is written outside", "open({folder!r} + '/new', 'w').write('x'); A = 1"),
    Probe("what is read cannot be changed", "import numpy; open(numpy.__file__, 'a').write('x'); A = 1"),
    Probe("no network: loopback", "import socket; socket.create_connection(('127.0.0.1', {port}), 1); A = 1"),
    Probe("no network: UDP", """
import socket
socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'x', ('127.0.0.1', {port})); A = 1"""),
    Probe("no socket of this machine: abstract names",
          "import socket; s = socket.socket(socket.AF_UNIX); s.connect({abstract!r}); A = 1"),
    Probe("no socket of this machine: files",
          "import socket; s = socket.socket(socket.AF_UNIX); s.connect({path!r}); A = 1"),
    Probe("no process outside is seen", "import os; A = len([n for n in os.listdir('/proc') if n.isdigit()])"),
    Probe("no process outside is signalled", "import os; os.kill({pid}, 0); A = 1"),
    Probe("no other program is started", "import subprocess; subprocess.run(['/bin/true']); A = 1"),
    Probe("no process is traced", """
import ctypes
A = int(ctypes.CDLL(None).ptrace(16, 1, 0, 0) == 0)"""),
    Probe("no new namespace, which would give rights", """
import ctypes
A = int(ctypes.CDLL(None).unshare(0x10000000) == 0)"""),
    Probe("no more rights than nobody's", "import os; os.setuid(0); A = 1"),
    Probe("no other identity than nobody's", "import os; A = int(os.getuid() != 65534)"),
    Probe("memory is bounded", "import numpy; A = int(numpy.ones(3 * {memory} // 8)[0])"),
    Probe("processes are bounded", """
import threading, time
threading.stack_size(1 << 16)
made = 0
try:
    while made < {processes}:
        threading.Thread(target=time.sleep, args=(1,), daemon=True).start()
        made += 1
except RuntimeError:
    pass
A = int(made >= {processes})
time.sleep(1.2)"""),
    Probe("files are bounded", "open('/tmp/x', 'wb').write(bytes(2 * {disk})); A = 1"),
    Probe("time is bounded, whatever is swallowed", """
while True:
    try:
        while True: pass
    except BaseException: pass""", endless=True),
)  # fmt: skip


def look(out: TextIO) -> bool:
    """Look at the walls, try each, and print what was found; whether strangers' notebooks may be graded here.

    Parameters
    ----------
    out : text file
    """
    print(f"System: {platform.system()} {platform.release()}, Python {platform.python_version()}, {_user()}", file=out)
    try:
        sandbox = Sandbox(LIMITS)
    except DHError as error:
        print(f"✘ no sandbox. {error}", file=out)
        return False
    with sandbox:
        try:
            outcome, seconds = _run(sandbox, HARMLESS)
        except DHError as error:
            print(f"✘ {sandbox.walls}: {error}", file=out)
            return False
        print(f"✔ outer wall: {sandbox.walls}; starts in {seconds:.1f} s", file=out)
        if outcome.readings.get("A") != {"values": [2.0]}:
            print(f"✘ an honest cell does not run: {outcome.note or outcome.errors or outcome.readings}", file=out)
            return False
        outcome, seconds = _run(sandbox, HARMLESS)
        print(f"✔ an honest cell runs; a notebook costs {1000 * seconds:.0f} ms", file=out)
        held = True
        for wall, fine, says in probe(sandbox):
            held &= fine
            print(f"{'✔' if fine else '✘'} {wall}{f': {says}' if says else ''}", file=out)
        for name, there, otherwise in sandbox.extras():
            print(f"{'✔' if there else '–'} {name}{'' if there else f': {otherwise}'}", file=out)
    if held:
        print("Strangers' notebooks may be graded here.", file=out)
    else:
        print("✘ A wall does not hold: do not grade strangers' notebooks here, and report this, please.", file=out)
    return held


def probe(sandbox: Sandbox) -> Iterator[tuple[str, bool, str]]:
    """Try everything that should fail: what should stop it, whether it was stopped, and else how it went."""
    with _planted() as there:
        for trial in PROBES:
            started = time.monotonic()
            outcome, _ = _run(sandbox, trial.source.format(**there))
            seconds = time.monotonic() - started
            reading = outcome.readings.get("A", {"fault": "missing"})
            if seconds > LIMITS.notebook_seconds + 1:
                yield trial.wall, False, f"it took {seconds:.1f} s"
            elif _out_of_time(outcome) and not trial.endless:
                yield trial.wall, False, LATE
            elif reading == {"values": [0.0]} or reading.get("fault") in STOPPED:
                yield trial.wall, True, ""
            else:
                yield trial.wall, False, f"it came through ({reading})"
        after, _ = _run(sandbox, HARMLESS)
        yield "the next notebook is as well off as the first", after.readings.get("A") == {"values": [2.0]}, after.note


def _out_of_time(outcome: Outcome) -> bool:
    return HOW["time"] in outcome.killers.values() or any(
        OutOfTime.__name__ in said for said in outcome.errors.values()
    )


def _run(sandbox: Sandbox, source: str) -> tuple[Outcome, float]:
    started = time.monotonic()
    cells = [Cell(source, role="answer", part="A"), Cell("", role="check", part="A")]
    return sandbox.run(cells, REQUEST), time.monotonic() - started


@contextlib.contextmanager
def _planted() -> Iterator[dict[str, object]]:
    """What a notebook might be after: a secret file, a folder to write to, servers that listen, a process."""
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="dhlib-doctor-")))
        folder.chmod(0o777)
        (folder / "secret").write_text("secret")
        (folder / "secret").chmod(0o644)
        network = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        abstract = f"\0dhlib-doctor-{os.getpid()}"
        for address in (abstract, str(folder / "socket")):
            server = stack.enter_context(socket.socket(socket.AF_UNIX))
            server.bind(address)
            server.listen()
        victim = stack.enter_context(subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"]))
        stack.callback(victim.kill)
        yield {
            "secret": str(folder / "secret"),
            "folder": str(folder),
            "port": network.getsockname()[1],
            "abstract": abstract,
            "path": str(folder / "socket"),
            "pid": victim.pid,
            "memory": LIMITS.memory + (512 << 20),
            "disk": LIMITS.disk_bytes,
            "processes": LIMITS.processes + processes_that_count() + 1,
        }


def _user() -> str:
    return "as root" if os.geteuid() == 0 else f"as user {os.geteuid()}"
