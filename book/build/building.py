"""Build the book from a program, and list what was built."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path


def build_book(
    source: Path, into: Path, *, environment: dict[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Build the book of `source` as `make book` does; the site is at ``into/_build/html``."""
    jupyter_book = [sys.executable, "-c", "from jupyter_book.cli.main import main; main()"]
    return subprocess.run(
        [*jupyter_book, "build", str(source), "--path-output", str(into), "-n", "-W", "--keep-going"],
        cwd=source,
        env=os.environ | {"NO_COLOR": "1"} | (environment or {}),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )


def pages_of(site: Path) -> list[str]:
    """Return the pages of a built site, by path."""
    return sorted(page.relative_to(site).as_posix() for page in site.rglob("*.html"))
