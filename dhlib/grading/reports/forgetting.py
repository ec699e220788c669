"""Remove a student from the results, so that nothing of them is left in the bytes of any file."""

from __future__ import annotations

import json
import re
import shutil
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.reports.write import CLASS, EXPORTS, FEEDBACK, GRADES, write_reports

#: What `dhlib grade` writes for the instructor to look at; the next run writes it anew.
PROBLEMS = "problems.csv"
#: Names that are shorter stand in many a file by chance.
SHORTEST = 4
#: Set from when rows are deleted until their bytes are gone.
_TRACES = "traces of a student may be left"


@dataclass(frozen=True)
class Forgotten:
    """What was removed, and which other files of the folder still hold the student."""

    submissions: int
    exports: bool
    left: list[Path]


def forget(store: Store, student: str) -> Forgotten:
    """Remove all of a student: rows, answers, decisions, lines of the audit trail, pages and tables.

    The reports are written anew without them. Exports that lie in the folder of the results are deleted, since they
    hold the student too; make them again.

    Raises
    ------
    DHError
        If the file cannot be written; or if another program has it open, so that it still holds the bytes of what was
        deleted, and `clean` has to be called again.
    """
    folder = store.path.parent
    rows = store.query("SELECT id, name, source, place FROM submission WHERE student = ?", (student,))
    said = {student, *(str(row[key]) for row in rows for key in ("name", "source", "place"))} - {""}
    whole = [re.compile(rf"(?<!\w){re.escape(text)}(?!\w)") for text in said]

    def names(*texts: str) -> Iterator[bool]:
        return (bool(pattern.search(text)) for pattern in whole for text in texts)

    with store.transaction() as db:
        db.execute("PRAGMA secure_delete = ON")  # deleted rows are written over, and not only marked as free
        numbers = [row["id"] for row in rows]
        for number in numbers:
            db.execute("DELETE FROM mark WHERE submission = ?", (number,))
            db.execute("DELETE FROM problem WHERE submission = ?", (number,))
            db.execute("DELETE FROM submission WHERE id = ?", (number,))
        for table in ("adjustment", "rule", "event"):
            db.execute(f"DELETE FROM {table} WHERE student = ?", (student,))
        for row in db.execute("SELECT id, source, what, students FROM problem").fetchall():
            if student in json.loads(row["students"]) or any(names(row["source"], row["what"])):
                db.execute("DELETE FROM problem WHERE id = ?", (row["id"],))
        for row in db.execute("SELECT id, details FROM event").fetchall():
            if any(names(row["details"])):
                db.execute("DELETE FROM event WHERE id = ?", (row["id"],))
        db.execute("INSERT OR REPLACE INTO meta VALUES (?, ?)", (_TRACES, "yes"))
    store.log("forgotten", details=f"one student, {len(rows)} submissions")
    exports = folder / EXPORTS
    had_exports = exports.is_dir()
    if had_exports:
        shutil.rmtree(exports)
    if any((folder / name).exists() for name in (GRADES, CLASS, FEEDBACK)):
        write_reports(store, only=())
    words = [text for text in said if len(text) >= SHORTEST]
    if folder / PROBLEMS in leftovers(folder, sorted(said)):
        (folder / PROBLEMS).unlink()
    clean(store)
    ours = (store.path.name, GRADES, CLASS, FEEDBACK)
    left = [path for path in leftovers(folder, words) if not path.relative_to(folder).parts[0].startswith(ours)]
    return Forgotten(len(rows), had_exports, left)


def clean(store: Store) -> bool:
    """Write the file anew without what was deleted, and empty the log beside it; False if nothing was left to do.

    Raises
    ------
    DHError
        If another program has the file open.
    """
    if not store.meta(_TRACES):
        return False
    try:
        store.query("VACUUM")
        busy = store.query("PRAGMA wal_checkpoint(TRUNCATE)")[0][0]
    except sqlite3.Error as error:  # pragma: no cover  the store says most of them itself
        raise DHError(f"{store.path} cannot be cleaned: {error}.") from None
    if busy:
        raise DHError(
            f"{store.path.name} was cleared of the student, but another program has it open, so traces may be left in "
            "its bytes: end that program, and give the same command again."
        )
    store.set_meta(_TRACES, "")
    return True


def leftovers(folder: Path, words: list[str]) -> list[Path]:
    """Files of a folder that still hold one of some words."""
    needles = [word.encode() for word in words if word]
    return [
        path
        for path in sorted(folder.rglob("*"))
        if path.is_file() and any(needle in path.read_bytes() or needle in path.name.encode() for needle in needles)
    ]
