"""Refuse files that are too large for git: ``python large_files.py FILE …``, as pre-commit calls it."""

from __future__ import annotations

import sys
from pathlib import Path

#: What is larger is built, or fetched by a lock.
LARGEST = 1_000_000


def main() -> int:
    """Name the files that are too large."""
    large = [path for path in map(Path, sys.argv[1:]) if path.is_file() and path.stat().st_size > LARGEST]
    for path in large:
        print(f"{path} has {path.stat().st_size / 1e6:.1f} MB; git holds files up to {LARGEST / 1e6:.0f} MB.")
    return 1 if large else 0


if __name__ == "__main__":
    sys.exit(main())
