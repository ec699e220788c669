"""A control group that bounds memory and processes of a whole box, where one can be made; version 1 and 2.

Without one the limits of each process still hold, and the controller watches the sum.
"""

from __future__ import annotations

import contextlib
import os
import time
import uuid
from collections.abc import Mapping
from pathlib import Path

from dhlib.grading.wall.limits import Limits

ROOT = Path("/sys/fs/cgroup")
CONTROLLERS = ("memory", "pids")
#: What the server itself takes, in bytes and processes.
SERVER_MEMORY = 512 << 20
SERVER_PROCESSES = 16
#: How long the kernel may take to see that they have ended.
REMOVE_SECONDS = 5.0


class ControlGroup:
    """A control group, or as much of one as this machine lets us make.

    Parameters
    ----------
    limits : Limits

    Attributes
    ----------
    memory, processes : bool
        Whether it bounds them. It does when the box is in it: see `holds`.
    """

    def __init__(self, limits: Limits) -> None:
        memory, processes = limits.memory + SERVER_MEMORY, limits.processes + SERVER_PROCESSES
        self.folders: list[Path] = []
        self.memory = self.processes = False
        own = _own_groups()
        name = f"dhlib-{os.getpid()}-{uuid.uuid4().hex[:8]}"
        if "" in own and not ROOT.joinpath("memory").is_dir():
            self._make_unified(ROOT / own[""].lstrip("/"), name, {"memory.max": memory, "pids.max": processes})
        else:
            self.memory = self._make(
                ROOT / "memory" / own.get("memory", "/").lstrip("/") / name,
                {"memory.limit_in_bytes": memory},
                {"memory.memsw.limit_in_bytes": memory},
            )
            self.processes = self._make(
                ROOT / "pids" / own.get("pids", "/").lstrip("/") / name, {"pids.max": processes}
            )

    def _make_unified(self, own: Path, name: str, values: dict[str, int]) -> None:
        """Make a group of version 2 where it has controllers.

        A group that has processes hands no controller on, unless it is the root. So ours seldom fits below our own:
        then it is made beside it, where whoever manages the groups has given us the one above.
        """
        for controller in CONTROLLERS:
            with contextlib.suppress(OSError):
                write(own / "cgroup.subtree_control", f"+{controller}")
        for parent in (own, own.parent) if own != ROOT else (own,):
            handed = [
                controller for controller in CONTROLLERS if controller in _words(parent / "cgroup.subtree_control")
            ]
            limits = {file: value for file, value in values.items() if file.removesuffix(".max") in handed}
            if limits and self._make(parent / name, limits, {"memory.swap.max": 0}):
                self.memory, self.processes = "memory.max" in limits, "pids.max" in limits
                return

    def _make(self, folder: Path, values: dict[str, int], others: Mapping[str, int] | None = None) -> bool:
        """Make a group with limits, others where the kernel counts swap; False if that is not ours to do."""
        _remove_left(folder.parent)
        try:
            make(folder)
        except OSError:
            return False
        try:
            for file, value in values.items():
                write(folder / file, str(value))
        except OSError:
            with contextlib.suppress(OSError):
                folder.rmdir()
            return False
        for file, value in (others or {}).items():
            with contextlib.suppress(OSError):
                write(folder / file, str(value))
        self.folders.append(folder)
        return True

    def holds(self, pid: int) -> None:
        """See whether a process really went in; without it the group bounds nothing, and says so."""
        if not all(str(pid) in _words(folder / "cgroup.procs") for folder in self.folders):
            self.memory = self.processes = False

    @property
    def entrances(self) -> list[str]:
        """Files that a process writes its number to, to go in."""
        return [str(folder / "cgroup.procs") for folder in self.folders]

    def close(self) -> None:
        """Remove the group; its processes have ended, or are about to."""
        deadline = time.monotonic() + REMOVE_SECONDS
        for folder in self.folders:
            while folder.exists():
                try:
                    folder.rmdir()
                except OSError:
                    if time.monotonic() > deadline:
                        break
                    time.sleep(0.01)
        self.folders = []


def make(folder: Path) -> None:
    """Make a group; the kernel puts its files in."""
    folder.mkdir()


def write(file: Path, text: str) -> None:
    """Write to a file of a group, which is there or not to be had."""
    with open(os.open(file, os.O_WRONLY), "w", encoding="ascii") as opened:
        opened.write(text)


def _words(file: Path) -> list[str]:
    with contextlib.suppress(OSError):
        return file.read_text().split()
    return []


def _remove_left(parent: Path) -> None:
    """Remove groups of graders that were killed before they could."""
    for left in parent.glob("dhlib-*-*"):
        if not Path("/proc", left.name.split("-")[1]).exists():
            with contextlib.suppress(OSError):
                left.rmdir()


def _own_groups() -> dict[str, str]:
    """Our own group of each controller; ``""`` is that of version 2."""
    groups = {}
    with contextlib.suppress(OSError):
        for line in Path(f"/proc/{os.getpid()}/cgroup").read_text().splitlines():
            _, controllers, path = line.split(":", 2)
            for controller in controllers.split(","):
                groups[controller] = path
    return groups
