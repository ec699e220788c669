"""Scripts of the pages: bundled from ``book/web`` and ``book/cells``, and named by their content."""

from __future__ import annotations

import hashlib
import json
import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from formulas import ROOT, node_program
from sphinx.errors import ExtensionError

WEB = ROOT / "book" / "web"
CELLS = ROOT / "book" / "cells"


def edition(files: Iterable[Path]) -> str:
    """Return a short hash of files and of the packages that go with them, so that no browser keeps old ones."""
    digest = hashlib.sha256((ROOT / "package-lock.json").read_bytes())
    for path in sorted(files):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:10]


def bundle(into: Path, names: Iterable[str]) -> None:
    """Bundle scripts, named by their paths within ``book/`` without the suffix, into a folder.

    Raises
    ------
    ExtensionError
        If there is nothing to bundle with, or a script cannot be bundled.
    """
    if not (ROOT / "node_modules" / "esbuild").is_dir():
        raise ExtensionError("esbuild is missing: run `make book`, or `npm ci`.")
    done = subprocess.run(
        [node_program(), str(WEB / "bundle.mjs"), str(into), *sorted(names)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )
    if done.returncode:
        raise ExtensionError(f"The scripts of the pages cannot be bundled:\n{done.stdout}")


def inline_data(name: str, data: Any) -> str:
    """Return data as an element of the page, for its script to read."""
    written = json.dumps(data, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")
    return f'<script type="application/json" id="{name}">{written}</script>\n'
