"""The key of a course: a file that nobody but the instructor can read."""

from __future__ import annotations

import argparse
import os
import re
import secrets
import stat
import subprocess
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.course.lots import digest

SIZE = 32
HEADING = "# The key of a course, for `dhlib assign` and `dhlib grade`. Keep it secret, and keep a copy."
LOOKS = re.compile(rf"[0-9a-f]{{{2 * SIZE}}}")


def make_key(path: str | Path) -> Path:
    """Write a new key that nobody else can read.

    Parameters
    ----------
    path : path
        Where; nothing may be there.

    Raises
    ------
    DHError
        If something is there already, or the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     len(read_key(make_key(Path(folder) / "course.key")))
    32
    """
    path = Path(path)
    try:
        file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise DHError(
            f"{path} is there already, and no key is written over another: notebooks that were assigned with a lost "
            "key cannot be graded any more. Choose another name."
        ) from None
    except OSError as error:
        raise DHError(f"{path} cannot be written: {error.strerror}.") from None
    with os.fdopen(file, "w", encoding="ascii") as stream:
        stream.write(f"{HEADING}\n{secrets.token_hex(SIZE)}\n")
    return path


def read_key(path: str | Path) -> bytes:
    """Read a key.

    Raises
    ------
    DHError
        If there is none, if others can read it, or if git keeps it: then it is no secret any more.
    """
    path = Path(path)
    try:
        mode = path.stat().st_mode
        text = path.read_text(encoding="utf-8") if stat.S_ISREG(mode) else ""
    except FileNotFoundError:
        raise DHError(f"there is no key {path}; `dhlib key {path}` makes one.") from None
    except (OSError, UnicodeDecodeError) as error:
        raise DHError(f"{path} cannot be read as a key: {getattr(error, 'strerror', '') or 'it is no text'}.") from None
    if os.name == "posix" and mode & 0o077:
        others = "everybody" if mode & 0o007 else "your group"
        raise DHError(f"{path} can be read or changed by {others} on this machine: `chmod 600 {path}`, then try again.")
    if _in_git(path):
        raise DHError(
            f"{path} is tracked by git, so whoever has the repository has the key. Remove it from git, make a new one "
            "with `dhlib key`, and assign anew."
        )
    lines = [line.strip() for line in text.splitlines() if line.strip() and not line.startswith("#")]
    if len(lines) != 1 or not LOOKS.fullmatch(lines[0]):
        raise DHError(f"{path} holds no key; it should be a file that `dhlib key` made.")
    return bytes.fromhex(lines[0])


def fingerprint(key: bytes) -> str:
    """What tells keys apart and says nothing of them; it stands in assigned notebooks."""
    return digest(key, "fingerprint").hex()[:8]


def _in_git(path: Path) -> bool:
    """Whether git tracks a file; where there is no git, none does."""
    path = path.resolve()
    quiet = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    try:
        done = subprocess.run(
            ["git", "ls-files", "--error-unmatch", "--", path.name],
            cwd=path.parent,
            env=quiet,
            capture_output=True,
            check=False,
        )
    except OSError:
        return False
    return done.returncode == 0


def add_key(commands: Any) -> None:
    """Add ``key`` to the commands of the parser."""
    parser = commands.add_parser(
        "key",
        help="make the key of a course",
        description="Make the key of a course: it decides which student gets which numbers. Keep a copy where only you "
        "can read it. Who has the key can compute all answers; without it no notebook that was assigned with it can be "
        "graded.",
    )
    parser.add_argument("path", type=Path, metavar="NEW", help="the file to write, such as course.key")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    path = make_key(options.path)
    print(f"{path}: the key of the course. Keep a copy where only you can read it, and out of git.")
    return 0
