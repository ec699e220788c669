"""The results of a class, in one SQLite file: nothing that was graded is lost, whatever happens."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import sqlite3
from collections.abc import Iterable, Iterator, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.batch.database_errors import not_a_database, sentence
from dhlib.grading.batch.rows import Certainty, Event, Grounds, MarkRow, Problem, Student, Submission
from dhlib.grading.batch.schema import APPLICATION_ID, MIGRATIONS

__all__ = ["FILE", "Certainty", "Event", "Grounds", "MarkRow", "Problem", "Store", "Student", "Submission", "now"]

#: What the file is called in the folder of the results.
FILE = "results.sqlite"
#: How long to wait for somebody else who writes, such as `dhlib adjust` beside a run.
PATIENCE = 10.0
#: How every file of SQLite begins.
HEADER = b"SQLite format 3\0"

#: The status of a file that is no notebook: it does not take the place of one that is.
UNREADABLE = "unreadable"
_NOT_WRITTEN = {"id", "attempt", "counts"}
_GROUNDS = [field.name for field in dataclasses.fields(Grounds)]
_IDENTITY = ["student", "name", "certainty", "place", "sequence", "submitted", "late", "late_seconds"]
_COLUMNS = [field.name for field in dataclasses.fields(Submission)]
_WRITTEN = [name for name in _COLUMNS if name not in _NOT_WRITTEN]
_MARK = [field.name for field in dataclasses.fields(MarkRow)]


def now() -> str:
    """The present moment, as the store writes it: ISO 8601 in UTC."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


class Store:
    """The results of a class.

    Parameters
    ----------
    path : path
        The file, or the folder that holds it.
    create : bool
        Whether to make the file if it is missing.

    Raises
    ------
    DHError
        If there is no such file, or it is not one of ours, or a newer dhlib wrote it, or the disk is full: always a
        sentence, and what is in the file stays as it is.

    Examples
    --------
    >>> import tempfile
    >>> folder = tempfile.mkdtemp()
    >>> ada = Submission(exercise="quickshot", student="ada", name="Ada", certainty=Certainty.PLACE, place="ada",
    ...                  source="ada/quickshot.ipynb", sha256="…", status="graded", points=1, out_of=3)
    >>> with Store(folder, create=True) as store:
    ...     number = store.add(ada, [MarkRow(part="A1", points=1, out_of=1, verdict="right")])
    ...     [(mark.part, mark.points) for mark in store.marks(number)]
    [('A1', 1.0)]
    """

    def __init__(self, path: str | Path, create: bool = False) -> None:
        path = Path(path)
        self.path = path / FILE if path.is_dir() else path
        if not create and not self.path.is_file():
            raise DHError(f"there are no results in {path}: {FILE} is missing. `dhlib grade … --out {path}` makes it.")
        with self._said():
            if self.path.is_file() and not _begins_like_a_database(self.path):
                raise DHError(not_a_database(self.path))
            self._db = sqlite3.connect(self.path, timeout=PATIENCE, isolation_level=None)
            self._db.row_factory = sqlite3.Row
            try:
                self._open()
            except BaseException:
                self._db.close()
                raise

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        with self._said():
            self._db.close()

    def _open(self) -> None:
        version, ours = self._number("user_version"), self._number("application_id")
        if version == 0 and ours == 0 and self._db.execute("SELECT count(*) FROM sqlite_master").fetchone()[0] == 0:
            with self.transaction():
                self._db.execute(f"PRAGMA application_id = {APPLICATION_ID}")
        elif ours != APPLICATION_ID:
            raise DHError(f"{self.path} was not written by dhlib; name another folder with --out.")
        if version > len(MIGRATIONS):
            raise DHError(
                f"{self.path} was written by a newer dhlib (version {version} of its tables; this one knows "
                f"{len(MIGRATIONS)}): update dhlib."
            )
        self._db.execute("PRAGMA journal_mode = WAL")
        self._db.execute("PRAGMA synchronous = FULL")
        self._db.execute("PRAGMA foreign_keys = ON")
        self._migrate()

    def _migrate(self) -> None:
        if self._number("user_version") >= len(MIGRATIONS):
            return
        with self.transaction():
            # Read again: somebody else may have done it meanwhile.
            for version in range(self._number("user_version"), len(MIGRATIONS)):
                for statement in _statements(MIGRATIONS[version]):
                    self._db.execute(statement)
                self._db.execute(f"PRAGMA user_version = {version + 1}")
            self._db.execute("INSERT OR IGNORE INTO meta VALUES ('created', ?)", (now(),))

    def _number(self, pragma: str) -> int:
        return int(self._db.execute(f"PRAGMA {pragma}").fetchone()[0])

    @contextlib.contextmanager
    def _said(self) -> Iterator[None]:
        """Say in a sentence what SQLite says in a code."""
        try:
            yield
        except (sqlite3.Error, OSError) as error:
            raise DHError(sentence(self.path, error)) from None

    @contextlib.contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """All of what is done inside, or nothing of it; transactions do not nest."""
        with self._said():
            self._db.execute("BEGIN IMMEDIATE")
            try:
                yield self._db
                self._db.execute("COMMIT")
            except BaseException:
                with contextlib.suppress(sqlite3.Error):
                    self._db.execute("ROLLBACK")
                raise

    def query(self, sql: str, values: Sequence[Any] = ()) -> list[sqlite3.Row]:
        """All rows of a question."""
        with self._said():
            return self._db.execute(sql, values).fetchall()

    # ── what is known of the run ──

    def meta(self, key: str, default: str = "") -> str:
        """A value that was kept by `set_meta`."""
        rows = self.query("SELECT value FROM meta WHERE key = ?", (key,))
        return str(rows[0]["value"]) if rows else default

    def set_meta(self, key: str, value: str) -> None:
        """Keep a value under a key."""
        with self.transaction() as db:
            db.execute("INSERT OR REPLACE INTO meta VALUES (?, ?)", (key, value))

    # ── submissions ──

    def add(self, submission: Submission, marks: Iterable[MarkRow] = (), problems: Iterable[Problem] = ()) -> int:
        """Keep a graded submission, in one transaction, and return its number.

        If the same file was graded before, its marks are replaced, its number stays, and the audit trail says so. Which
        of a student's attempts counts is settled anew.
        """
        with self.transaction() as db:
            old = db.execute(
                "SELECT * FROM submission WHERE source = ? AND sha256 = ?", (submission.source, submission.sha256)
            ).fetchone()
            values = [getattr(submission, name) for name in _WRITTEN]
            if old is None:
                number = _inserted(
                    db.execute(
                        f"INSERT INTO submission ({', '.join(_WRITTEN)}) VALUES ({_places(len(values))})", values
                    )
                )
            else:
                number = old["id"]
                db.execute(
                    f"UPDATE submission SET {', '.join(f'{name} = ?' for name in _WRITTEN)} WHERE id = ?",
                    [*values, number],
                )
                db.execute("DELETE FROM mark WHERE submission = ?", (number,))
                db.execute("DELETE FROM problem WHERE submission = ?", (number,))
                before = f"{old['points']:g} of {old['out_of']:g} points"
                details = f"{submission.source}: {submission.points:g} of {submission.out_of:g}, was {before}"
                _log(db, "graded again", submission.student, details)
                _settle(db, old["student"])
            db.executemany(
                f"INSERT INTO mark (submission, position, {', '.join(_MARK)}) VALUES ({_places(len(_MARK) + 2)})",
                [[number, k, *(getattr(mark, name) for name in _MARK)] for k, mark in enumerate(marks)],
            )
            _insert_problems(db, (dataclasses.replace(problem, submission=number) for problem in problems))
            _settle(db, submission.student)
        return number

    def submissions(self, counting: bool = False) -> list[Submission]:
        """All submissions, by source; or only those that count."""
        rows = self.query(f"SELECT * FROM submission {'WHERE counts' if counting else ''} ORDER BY source, id")
        return [_submission(row) for row in rows]

    def submission(self, number: int) -> Submission:
        """The submission of this number; raises DHError if there is none."""
        rows = self.query("SELECT * FROM submission WHERE id = ?", (number,))
        if not rows:
            raise DHError(f"{self.path} holds no submission {number}.")
        return _submission(rows[0])

    def graded(self) -> dict[tuple[str, str], Grounds]:
        """What was graded: source and hash of each file, and upon which grounds."""
        rows = self.query("SELECT source, sha256, exercise, exercise_sha256, dhlib, status, graded_at FROM submission")
        return {(row[0], row[1]): Grounds(**{name: row[name] for name in _GROUNDS}) for row in rows}

    def identify(self, submission: Submission) -> None:
        """Keep anew who handed something in, without its marks: somebody looked it up in a roster, for instance."""
        with self.transaction() as db:
            (old,) = db.execute("SELECT * FROM submission WHERE id = ?", (submission.id,)).fetchall()
            if all(old[name] == getattr(submission, name) for name in _IDENTITY):
                return
            db.execute(
                f"UPDATE submission SET {', '.join(f'{name} = ?' for name in _IDENTITY)} WHERE id = ?",
                [*(getattr(submission, name) for name in _IDENTITY), submission.id],
            )
            if old["student"] != submission.student:
                _log(db, "told anew", submission.student, f"{submission.source}: was {old['student'] or 'nobody'!s}")
            _settle(db, old["student"])
            _settle(db, submission.student)

    def marks(self, number: int) -> list[MarkRow]:
        """The marks of a submission, part by part."""
        rows = self.query(f"SELECT {', '.join(_MARK)} FROM mark WHERE submission = ? ORDER BY position", (number,))
        return [MarkRow(**dict(row)) for row in rows]

    def students(self) -> list[Student]:
        """Everybody who handed something in and is known, by name."""
        rows = self.query(
            "SELECT student, max(name) AS name, count(*) AS submissions FROM submission WHERE student != '' "
            "GROUP BY student ORDER BY name, student"
        )
        return [Student(**dict(row)) for row in rows]

    # ── what the instructor should look at, and what was done ──

    def problems(self) -> list[Problem]:
        """What could not be placed, and who is claimed twice."""
        rows = self.query("SELECT source, what, students, submission FROM problem ORDER BY source, id")
        return [Problem(row[0], row[1], tuple(json.loads(row[2])), row[3]) for row in rows]

    def replace_problems(self, problems: Iterable[Problem]) -> None:
        """Forget what stood in no submission, and keep these instead."""
        with self.transaction() as db:
            db.execute("DELETE FROM problem WHERE submission IS NULL")
            _insert_problems(db, problems)

    def events(self) -> list[Event]:
        """The audit trail, oldest first."""
        return [
            Event(**dict(row)) for row in self.query("SELECT at, what, student, details, id FROM event ORDER BY id")
        ]

    def log(self, what: str, student: str = "", details: str = "") -> None:
        """Add a line to the audit trail."""
        with self.transaction() as db:
            _log(db, what, student, details)


def _begins_like_a_database(path: Path) -> bool:
    """Whether SQLite wrote it; of an empty or very short file SQLite would make one without asking."""
    with path.open("rb") as file:
        return file.read(len(HEADER)) in (HEADER, b"")


def _settle(db: sqlite3.Connection, student: str) -> None:
    """Number a student's attempts at each exercise, and say which one counts.

    It is the last that can be read, of those that are told most surely. Files whose notebooks alone say whose they are
    count for nobody if there are several: anybody could have written that.
    """
    if not student:
        return
    rows = db.execute(
        "SELECT id, exercise, certainty, source, status, sequence, submitted FROM submission WHERE student = ?",
        (student,),
    ).fetchall()
    # Which was graded first is chance, and says nothing; "x-2.ipynb" comes after "x.ipynb".
    rows.sort(key=lambda row: (row["sequence"], row["submitted"], os.path.splitext(row["source"])[0], row["id"]))
    exercises = {row["exercise"] for row in rows}
    for exercise in exercises:
        attempts = [row for row in rows if row["exercise"] == exercise]
        counts = None if exercise == "" and len(exercises) > 1 else _counts(attempts)
        db.executemany(
            "UPDATE submission SET attempt = ?, counts = ? WHERE id = ?",
            [(attempt, row["id"] == counts, row["id"]) for attempt, row in enumerate(attempts, 1)],
        )


def _counts(attempts: Sequence[sqlite3.Row]) -> int | None:
    """Which of the attempts at one exercise counts, if any."""
    surest = max(row["certainty"] for row in attempts)
    attempts = [row for row in attempts if row["certainty"] == surest]
    if surest == Certainty.METADATA and len({row["source"] for row in attempts}) > 1:
        return None
    readable = [row for row in attempts if row["status"] != UNREADABLE]
    return int((readable or attempts)[-1]["id"])


def _log(db: sqlite3.Connection, what: str, student: str, details: str) -> None:
    db.execute("INSERT INTO event (at, what, student, details) VALUES (?, ?, ?, ?)", (now(), what, student, details))


def _insert_problems(db: sqlite3.Connection, problems: Iterable[Problem]) -> None:
    db.executemany(
        "INSERT INTO problem (submission, source, what, students) VALUES (?, ?, ?, ?)",
        [
            (problem.submission, problem.source, problem.what, json.dumps(problem.students, ensure_ascii=False))
            for problem in problems
        ],
    )


def _submission(row: sqlite3.Row) -> Submission:
    values = {name: row[name] for name in _COLUMNS}
    return Submission(
        **values
        | {
            "certainty": Certainty(row["certainty"]),
            "late": bool(row["late"]),
            "counts": bool(row["counts"]),
        }
    )


def _inserted(cursor: sqlite3.Cursor) -> int:
    assert cursor.lastrowid is not None
    return cursor.lastrowid


def _places(count: int) -> str:
    return ", ".join("?" * count)


def _statements(script: str) -> Iterator[str]:
    """The statements of a script, one by one: `executescript` would commit between them."""
    statement = ""
    for line in script.splitlines():
        statement += f"{line}\n"
        if sqlite3.complete_statement(statement):
            yield statement
            statement = ""
