"""The tables of ``results.sqlite``, as the steps that led to them."""

from __future__ import annotations

#: Tells our files from other SQLite files: "DHLB".
APPLICATION_ID = 0x44484C42

#: One script for each version of the schema. Files of older versions are brought up to date when they are opened; so a
#: step is never changed once it has been used: whoever needs another table or column adds a step.
MIGRATIONS: tuple[str, ...] = (
    """
    CREATE TABLE meta (
        key TEXT PRIMARY KEY,
        value TEXT NOT NULL
    );
    CREATE TABLE submission (
        id INTEGER PRIMARY KEY,
        exercise TEXT NOT NULL,          -- '' where the notebook does not say and nobody else does
        student TEXT NOT NULL,           -- '' where nobody knows
        name TEXT NOT NULL,
        certainty INTEGER NOT NULL,      -- who says that it is this student: see store.Certainty
        source TEXT NOT NULL,            -- where the file was found
        place TEXT NOT NULL,             -- the folder, or entry of the platform, that stands for the student
        claims TEXT NOT NULL,            -- whose it is by its own metadata, or ''
        attempt INTEGER NOT NULL DEFAULT 1,
        counts INTEGER NOT NULL DEFAULT 1,
        sequence INTEGER NOT NULL,       -- number that the platform gave it; later ones are larger
        submitted TEXT NOT NULL,         -- ISO 8601 in UTC, or ''
        late INTEGER NOT NULL,           -- 1 where the platform says so
        late_seconds REAL,               -- NULL where nobody knows
        sha256 TEXT NOT NULL,            -- of the file
        status TEXT NOT NULL,
        message TEXT NOT NULL,
        points REAL NOT NULL,
        out_of REAL NOT NULL,
        seconds REAL NOT NULL,           -- that grading took
        graded_at TEXT NOT NULL,
        dhlib TEXT NOT NULL,
        python TEXT NOT NULL,
        numpy TEXT NOT NULL,
        sympy TEXT NOT NULL,
        seed TEXT NOT NULL,
        exercise_sha256 TEXT NOT NULL,   -- of what was asked: the exercise's files, the key, the seed
        UNIQUE (source, sha256)
    );
    CREATE INDEX submission_student ON submission (student, exercise);
    CREATE TABLE mark (
        submission INTEGER NOT NULL REFERENCES submission ON DELETE CASCADE,
        position INTEGER NOT NULL,
        part TEXT NOT NULL,
        title TEXT NOT NULL,
        points REAL NOT NULL,
        out_of REAL NOT NULL,
        verdict TEXT NOT NULL,
        message TEXT NOT NULL,
        misconception TEXT NOT NULL,
        section TEXT NOT NULL,
        answer TEXT NOT NULL,            -- JSON, as it came out of the box
        PRIMARY KEY (submission, position)
    );
    CREATE TABLE problem (
        id INTEGER PRIMARY KEY,
        submission INTEGER REFERENCES submission ON DELETE CASCADE,  -- NULL for what never became one
        source TEXT NOT NULL,
        what TEXT NOT NULL,
        students TEXT NOT NULL
    );
    CREATE INDEX problem_submission ON problem (submission);
    CREATE TABLE event (
        id INTEGER PRIMARY KEY,
        at TEXT NOT NULL,
        what TEXT NOT NULL,
        student TEXT NOT NULL,
        details TEXT NOT NULL
    );
    """,
    # What the instructor decides stands beside what was marked, and names no submission: grading again leaves it alone.
    """
    CREATE TABLE adjustment (
        id INTEGER PRIMARY KEY,
        exercise TEXT NOT NULL,
        student TEXT NOT NULL,
        part TEXT NOT NULL,              -- '' for points beside the parts
        points REAL NOT NULL,            -- of the part, or added beside the parts
        reason TEXT NOT NULL,
        at TEXT NOT NULL,
        by TEXT NOT NULL,
        revoked_at TEXT NOT NULL,        -- '' while it holds
        revoked_by TEXT NOT NULL
    );
    CREATE INDEX adjustment_student ON adjustment (student, exercise);
    CREATE TABLE rule (
        id INTEGER PRIMARY KEY,
        exercise TEXT NOT NULL,          -- '' for all
        student TEXT NOT NULL,           -- '' for all
        due TEXT NOT NULL,               -- ISO 8601 in UTC, or '' to leave the due time as it is
        late TEXT NOT NULL,              -- what being late costs, or '' to leave that as it is
        grace TEXT NOT NULL,
        reason TEXT NOT NULL,
        at TEXT NOT NULL,
        by TEXT NOT NULL,
        revoked_at TEXT NOT NULL,
        revoked_by TEXT NOT NULL
    );
    """,
)
