"""An environment of its own for each peer, made from its lock in bench/peers."""

from __future__ import annotations

import os
import subprocess
import sys
import zlib
from pathlib import Path

BENCH = Path(__file__).parent
ROOT = BENCH.parent
ENVIRONMENTS = ROOT / ".bench"
UV = ROOT / ".tools" / "uv" / "bin" / "uv"


class NotToBeHad(Exception):
    """A peer that cannot be installed here; its text says why."""


def python_of(peer: str) -> Path:
    """Return the Python of a peer's environment, made if its lock is new.

    Raises
    ------
    NotToBeHad
        If the lock cannot be installed.
    """
    lock = BENCH / "peers" / f"{peer}.lock"
    home = ENVIRONMENTS / peer
    python = home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    ready = home / f"ready-{zlib.crc32(lock.read_bytes()):08x}"
    if ready.exists():
        return python
    for words in (
        ["venv", "--quiet", "--clear", "--python", sys.executable, str(home)],
        ["pip", "sync", "--quiet", "--python", str(home), "--require-hashes", str(lock)],
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


def environment_variables() -> dict[str, str]:
    """Return the variables for a peer: dhlib from this repository, one thread for everybody."""
    one_thread = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    return os.environ | one_thread | {"PYTHONPATH": str(ROOT), "PYTHONWARNINGS": "ignore"}
