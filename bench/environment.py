"""An environment of its own for each peer, made from its lock in bench/peers."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

BENCH = Path(__file__).parent
ROOT = BENCH.parent
ENVIRONMENTS = ROOT / ".bench"
#: Set where a little of the work is enough: see `size`.
SMALL = "DHBENCH_SMALL"
UV = ROOT / ".tools" / "uv" / "bin" / "uv"


def size(whole: int, small: int) -> int:
    """How much of a workload is done: `small` where it is only tried."""
    return small if os.environ.get(SMALL) else whole


class NotToBeHad(Exception):
    """A peer that cannot be installed here; its text says why."""


def python_of(peer: str) -> Path:
    """Return the Python of a peer's environment, made if its lock is new, or if the repository was moved.

    Raises
    ------
    NotToBeHad
        If the lock cannot be installed.
    """
    lock = BENCH / "peers" / f"{peer}.lock"
    home = ENVIRONMENTS / peer
    python = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    # The commands of an environment name the folder that they were installed in.
    ready = home / f"ready-compiled-{zlib.crc32(lock.read_bytes() + bytes(home)):08x}"
    if ready.exists():
        return python
    for words in (
        ["venv", "--quiet", "--clear", "--python", sys.executable, str(home)],
        # Compiled, as ours is: else a peer would compile its modules at every start where Python writes no bytecode.
        ["pip", "sync", "--quiet", "--compile-bytecode", "--python", str(home), "--require-hashes", str(lock)],
    ):
        made = subprocess.run([UV, *words], capture_output=True, text=True, check=False)
        if made.returncode != 0:
            raise NotToBeHad(made.stderr.strip().splitlines()[-1][:300] if made.stderr.strip() else "uv failed")
    ready.touch()
    return python


def version_of(python: Path, distribution: str) -> str:
    """Return the version of what is installed there."""
    program = f"import importlib.metadata as m; print(m.version({distribution!r}))"
    return subprocess.run([python, "-c", program], capture_output=True, text=True, check=True).stdout.strip()


def environment_variables(small: bool = False) -> dict[str, str]:
    """Return the variables for a program: dhlib from this repository, one thread for everybody."""
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    told = {"PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "ignore"} | ({SMALL: "1"} if small else {})
    return os.environ | one_thread | told


def machine() -> dict[str, Any]:
    """Return what this runs on, and how busy that is at the moment."""
    model = platform.processor()
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), model)
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
        "load": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None,
    }
