"""What is seen behind the outer wall: an interpreter, the libraries, dhlib, and nothing else.

No home folder, no exercise, no solution, no result, no submission.
"""

from __future__ import annotations

import os
import sys
import sysconfig
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import dhlib
from dhlib.grading.wall.inner import HOME

#: Where dhlib stands behind the wall, wherever it stands outside.
LIBRARY = "/dhlib/dhlib"
#: Where libraries stand behind the wall that stand in the folder which is the notebook's own there.
MOVED = "/moved"
SYSTEM = ("/lib", "/lib64", "/usr/lib", "/usr/lib64", "/etc/ld.so.cache")
DEVICES = ("null", "zero", "full", "random", "urandom")
#: Parts of dhlib that say what is right.
HIDDEN = ("_exercises",)


@dataclass(frozen=True)
class View:
    """Files to show, read-only, as pairs of where they are and where they are seen; and folders to empty."""

    shown: list[tuple[str, str]]
    emptied: list[str]
    python: str
    path: list[str]


def view() -> View:
    """What the interpreter that runs this needs."""
    python = os.path.realpath(sys.executable)
    package = Path(dhlib.__file__).resolve().parent
    folders = [folder for folder in _folders() if os.path.isdir(folder)]
    shown = [
        (folder, place)
        for folder in _outermost([*SYSTEM, *folders])
        if os.path.exists(folder)
        for place in sorted({folder, _place(folder)})  # an interpreter starts from where it was built for
    ]
    shown.append((python, python))
    shown.append((str(package), LIBRARY))
    keys = [
        place
        for folder in folders
        for name in HIDDEN
        for pattern in (f"dhlib/{name}", f"*-packages/dhlib/{name}", f"python3*/*-packages/dhlib/{name}")
        for found in Path(folder).glob(pattern)
        for place in (str(found), _place(str(found)))
    ]
    keys += [f"{LIBRARY}/{name}" for name in HIDDEN if (package / name).is_dir()]
    return View(shown, sorted(set(keys)), python, [str(Path(LIBRARY).parent), *map(_place, _search_path())])


def _place(path: str) -> str:
    """Where a path is seen when a notebook runs: its own folder hides what was there."""
    return f"{MOVED}{path}" if path.startswith(f"{HOME}/") else path


def _search_path() -> list[str]:
    """Where modules are looked for: the standard library and the folders of packages, no working folder."""
    dynamic = [path for path in sys.path if path.endswith(("lib-dynload", ".zip"))]
    return [*dict.fromkeys([sysconfig.get_path("stdlib"), *dynamic, *_packages()])]


def _packages() -> Iterator[str]:
    return (path for path in sys.path if Path(path).name in ("site-packages", "dist-packages"))


def _folders() -> list[str]:
    base = Path(sys.base_prefix)
    libraries = [str(base / name) for name in ("lib", "lib64")] if base not in (Path("/"), Path("/usr")) else []
    return [*libraries, *_search_path()]


def _outermost(paths: list[str]) -> list[str]:
    """Leave out what lies within another."""
    paths = [*dict.fromkeys(os.path.normpath(path) for path in paths)]
    return [path for path in paths if not any(path.startswith(f"{other}/") for other in paths)]
