"""What an error of SQLite means to whoever grades."""

from __future__ import annotations

import sqlite3
from pathlib import Path

_AGAIN = "What was graded before is kept: {mend}, and give the same command again."
_SENTENCES = {
    sqlite3.SQLITE_FULL: "the disk is full, so {path} cannot grow. " + _AGAIN.format(mend="make room"),
    sqlite3.SQLITE_IOERR: "{path} cannot be read or written (the disk may be full, or gone). "
    + _AGAIN.format(mend="mend that"),
    sqlite3.SQLITE_BUSY: "another program writes to {path}; wait until it is done, and give the same command again.",
    sqlite3.SQLITE_NOTADB: "{path} is no file of results: it was not written by dhlib, or it is damaged. Name another "
    "folder with --out.",
    sqlite3.SQLITE_CORRUPT: "{path} is damaged. Keep a copy of it, move it away, and grade again.",
    sqlite3.SQLITE_READONLY: "{path} may not be written by you.",
    sqlite3.SQLITE_PERM: "{path} may not be written by you.",
    sqlite3.SQLITE_CANTOPEN: "{path} cannot be opened: is there such a folder, and may you write there?",
}


def sentence(path: Path, error: sqlite3.Error | OSError) -> str:
    """An error in words.

    Examples
    --------
    >>> sentence(Path("results.sqlite"), sqlite3.OperationalError("no such table: mark"))
    'results.sqlite cannot be used: no such table: mark.'
    """
    code = getattr(error, "sqlite_errorcode", None)
    kind = code & 0xFF if isinstance(code, int) else sqlite3.SQLITE_ERROR
    kind = sqlite3.SQLITE_BUSY if kind == sqlite3.SQLITE_LOCKED else kind
    return _SENTENCES.get(kind, "{path} cannot be used: {error}.").format(path=path, error=error)


def not_a_database(path: Path) -> str:
    """What to say of a file that SQLite did not write."""
    return _SENTENCES[sqlite3.SQLITE_NOTADB].format(path=path)
