"""A control group that bounds memory and processes of a whole box, where one can be made; version 1 and 2.

Without one the limits of each process still hold, and the controller watches the sum.
"""

from __future__ import annotations

import contextlib
import os
import time
import uuid
from pathlib import Path

from dhlib.grading.wall.limits import Limits

ROOT = Path("/sys/fs/cgroup")
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
    """

    def __init__(self, limits: Limits) -> None:
        memory, processes = limits.memory + SERVER_MEMORY, limits.processes + SERVER_PROCESSES
        self.folders: list[Path] = []
        own = _own_groups()
        name = f"dhlib-{os.getpid()}-{uuid.uuid4().hex[:8]}"
        if "" in own and not ROOT.joinpath("memory").is_dir():
            self.memory = self.processes = self._make(
                ROOT / own[""].lstrip("/") / name, {"memory.max": memory, "pids.max": processes}
            )
        else:
            self.memory = self._make(
                ROOT / "memory" / own.get("memory", "/").lstrip("/") / name, {"memory.limit_in_bytes": memory}
            )
            self.processes = self._make(
                ROOT / "pids" / own.get("pids", "/").lstrip("/") / name, {"pids.max": processes}
            )

    def _make(self, folder: Path, values: dict[str, int]) -> bool:
        """Make a group with limits; False if that is not ours to do."""
        _remove_left(folder.parent)
        try:
            folder.mkdir()
        except OSError:
            return False
        try:
            for file, value in values.items():
                (folder / file).write_text(str(value))
        except OSError:
            with contextlib.suppress(OSError):
                folder.rmdir()
            return False
        self.folders.append(folder)
        return True

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
