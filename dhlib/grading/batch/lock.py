"""One grader for each folder of results: the lock goes when its holder goes, however it ends."""

from __future__ import annotations

import sqlite3
from pathlib import Path

from dhlib.errors import DHError

FILE = "results.lock"


class Lock:
    """Held by the grader that fills a folder.

    SQLite locks a file of its own, since it knows how on every system; and the system lets go of it even after
    ``kill -9``. Readers of the results, such as `dhlib export`, do not ask for it.

    Raises
    ------
    DHError
        If another grader holds it, or the folder cannot be written to.
    """

    def __init__(self, folder: Path) -> None:
        self._db: sqlite3.Connection | None = None
        try:
            self._db = sqlite3.connect(folder / FILE, timeout=0, isolation_level=None)
            self._db.execute("BEGIN EXCLUSIVE")
        except sqlite3.Error as error:
            self.__exit__()
            if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY:
                raise DHError(f"{folder / FILE} cannot be written to: {error}.") from None
            raise DHError(
                f"another grader is filling {folder}; wait until it is done, or name another folder with --out."
            ) from None

    def __enter__(self) -> Lock:
        return self

    def __exit__(self, *_: object) -> None:
        if self._db is not None:
            self._db.close()
