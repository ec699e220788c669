"""What the instructor decided, beside what was marked: points changed by hand, due times and rules for late work.

Decisions stand in tables of their own and name exercise, student and part, so that grading again touches none of them.
Nothing is written over: a decision that no longer holds is revoked, and stays to be read.
"""

from __future__ import annotations

import contextlib
import getpass
from collections.abc import Iterable
from dataclasses import dataclass, fields
from datetime import datetime

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store, now
from dhlib.grading.reports.cells import number
from dhlib.grading.reports.late import LateRule, read_time


@dataclass(frozen=True, kw_only=True)
class Adjustment:
    """Points that somebody gave by hand.

    Parameters
    ----------
    exercise, student : str
    part : str
        Of which it sets the points; ``""`` where it adds points beside the parts.
    points : float
    reason : str
        The student reads it.
    """

    id: int = 0
    exercise: str
    student: str
    part: str
    points: float
    reason: str
    at: str = ""
    by: str = ""
    revoked_at: str = ""
    revoked_by: str = ""


@dataclass(frozen=True, kw_only=True)
class Rule:
    """A due time, or what being late costs, for all or for some.

    Parameters
    ----------
    exercise, student : str
        ``""`` for all.
    due : str
        ISO 8601 in UTC; ``""`` leaves the due time to a wider rule.
    late : str
        As `LateRule.read` reads it; ``""`` leaves that to a wider rule.
    grace : str
    reason : str
    """

    id: int = 0
    exercise: str = ""
    student: str = ""
    due: str = ""
    late: str = ""
    grace: str = ""
    reason: str = ""
    at: str = ""
    by: str = ""
    revoked_at: str = ""
    revoked_by: str = ""


@dataclass(frozen=True)
class Timing:
    """What holds for one student and one exercise."""

    due: datetime | None
    late: LateRule | None
    reason: str = ""


def somebody() -> str:
    """The name under which decisions are kept: that of the account."""
    with contextlib.suppress(Exception):  # an account without a name, as in a container
        return getpass.getuser()
    return "unknown"


def adjustments(store: Store, all_of_them: bool = False) -> list[Adjustment]:
    """Adjustments, oldest first; those that were revoked only where all are asked for."""
    where = "" if all_of_them else "WHERE revoked_at = ''"
    return [Adjustment(**dict(row)) for row in store.query(f"SELECT * FROM adjustment {where} ORDER BY id")]


def rules(store: Store, all_of_them: bool = False) -> list[Rule]:
    """Rules, oldest first; those that were revoked only where all are asked for."""
    where = "" if all_of_them else "WHERE revoked_at = ''"
    return [Rule(**dict(row)) for row in store.query(f"SELECT * FROM rule {where} ORDER BY id")]


def adjust(store: Store, adjustment: Adjustment) -> int:
    """Keep an adjustment, in place of one of the same part, and return its number."""
    same = {"exercise": adjustment.exercise, "student": adjustment.student, "part": adjustment.part}
    what = f"{adjustment.part}: {number(adjustment.points)} points" if adjustment.part else _bonus(adjustment)
    return _keep(store, "adjustment", adjustment, same if adjustment.part else {}, f"{what}. {adjustment.reason}")


def set_rule(store: Store, rule: Rule) -> int:
    """Keep a rule, in place of one for the same students and exercises, and return its number."""
    before = [r for r in rules(store) if (r.exercise, r.student) == (rule.exercise, rule.student)]
    for old in before:  # what the new one leaves open stays as it was
        rule = Rule(
            **{f.name: getattr(rule, f.name) for f in fields(Rule)}
            | {name: getattr(rule, name) or getattr(old, name) for name in ("due", "late", "grace")}
        )
    due = f"due {rule.due}" if rule.due else ""
    late = f"late: {LateRule.read(rule.late, rule.grace)}" if rule.late else ""
    same = {"exercise": rule.exercise, "student": rule.student}
    return _keep(store, "rule", rule, same, ". ".join(filter(None, (due, late, rule.reason))))


def revoke(store: Store, table: str, number: int, by: str = "") -> None:
    """Let a decision hold no longer.

    Parameters
    ----------
    store : Store
    table : {"adjustment", "rule"}
    number : int
    by : str, optional

    Raises
    ------
    DHError
        If there is none of this number that holds.
    """
    rows = store.query(f"SELECT student FROM {table} WHERE id = ? AND revoked_at = ''", (number,))
    if not rows:
        raise DHError(f"there is no {table} {number} that holds; `dhlib adjust … --list` shows all.")
    with store.transaction() as db:
        db.execute(f"UPDATE {table} SET revoked_at = ?, revoked_by = ? WHERE id = ?", (now(), by or somebody(), number))
        db.execute(
            "INSERT INTO event (at, what, student, details) VALUES (?, ?, ?, ?)",
            (now(), f"{table} revoked", rows[0]["student"], f"number {number}, by {by or somebody()}"),
        )


def timing(all_rules: Iterable[Rule], student: str, exercise: str) -> Timing:
    """What holds for a student and an exercise: each time the narrowest rule that says something."""
    fitting = sorted(
        (r for r in all_rules if r.student in ("", student) and r.exercise in ("", exercise)),
        key=lambda r: (bool(r.student), bool(r.exercise)),
    )
    due = next((r for r in reversed(fitting) if r.due), None)
    late = next((r for r in reversed(fitting) if r.late), None)
    return Timing(
        read_time(due.due) if due else None,
        LateRule.read(late.late, late.grace) if late else None,
        due.reason if due and due.student else "",
    )


def _bonus(adjustment: Adjustment) -> str:
    return f"{'+' if adjustment.points >= 0 else '-'}{number(abs(adjustment.points))} points beside the parts"


def _keep(store: Store, table: str, row: Adjustment | Rule, replaces: dict[str, str], details: str) -> int:
    """Insert a row, revoke the one it replaces, and write both down, in one transaction."""
    by, at = row.by or somebody(), row.at or now()
    values = {f.name: getattr(row, f.name) for f in fields(row) if f.name != "id"} | {"at": at, "by": by}
    with store.transaction() as db:
        if replaces:
            same = " AND ".join(f"{name} = ?" for name in replaces)
            db.execute(
                f"UPDATE {table} SET revoked_at = ?, revoked_by = ? WHERE revoked_at = '' AND {same}",
                [at, by, *replaces.values()],
            )
        columns, places = ", ".join(values), ", ".join("?" * len(values))
        kept = db.execute(f"INSERT INTO {table} ({columns}) VALUES ({places})", list(values.values())).lastrowid
        what = "adjusted" if table == "adjustment" else "rule set"
        db.execute(
            "INSERT INTO event (at, what, student, details) VALUES (?, ?, ?, ?)",
            (at, what, row.student, f"{row.exercise or 'all exercises'}: {details} (number {kept}, by {by})"),
        )
    return int(kept or 0)
