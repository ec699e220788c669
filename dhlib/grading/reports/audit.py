"""The audit trail: what was graded, and who changed what, and when."""

from __future__ import annotations

from collections.abc import Callable

from dhlib.grading.batch.store import Store
from dhlib.grading.reports.cells import number
from dhlib.grading.reports.decisions import adjustments, rules
from dhlib.grading.reports.late import LateRule


def audit(store: Store, rename: Callable[[str], str] | None = None) -> list[str]:
    """Lines, oldest first.

    Parameters
    ----------
    store : Store
    rename : callable, optional
        Gives each student another name; then sentences that may hold a name are left out.
    """

    def who(student: str) -> str:
        return (rename(student) if rename else student) if student else ""

    entries: list[tuple[str, str, str, str]] = []
    for each in store.submissions():
        about = "" if rename else f"{each.source}; "
        about += f"{each.exercise or 'no exercise'}, attempt {each.attempt}{'' if each.counts else ', does not count'}"
        about += f": {each.status}, {number(each.points)} of {number(each.out_of)}; sha256 {each.sha256[:12]}"
        entries.append((each.graded_at, "graded", who(each.student), f"{about}; dhlib {each.dhlib}"))
    for event in store.events():
        entries.append((event.at, event.what, who(event.student), "" if rename else event.details))
    entries.sort(key=lambda entry: entry[0])
    return ["  ".join(part for part in entry if part) for entry in entries]


def decisions(store: Store) -> list[str]:
    """Everything that was decided by hand, with its number, whether it holds or not."""
    lines = []
    for a in adjustments(store, all_of_them=True):
        what = f"{a.part}: {number(a.points)} points" if a.part else f"{a.points:+g} points beside the parts"
        held = f"revoked {a.revoked_at} by {a.revoked_by}" if a.revoked_at else "holds"
        lines.append(f"adjustment {a.id}  {a.student}, {a.exercise}, {what}. {a.reason}  ({a.by}, {a.at}; {held})")
    for r in rules(store, all_of_them=True):
        what = "; ".join(
            text for text in (r.due and f"due {r.due}", r.late and str(LateRule.read(r.late, r.grace))) if text
        )
        held = f"revoked {r.revoked_at} by {r.revoked_by}" if r.revoked_at else "holds"
        whom = f"{r.student or 'all'}, {r.exercise or 'all exercises'}"
        lines.append(f"rule {r.id}  {whom}: {what}. {r.reason}  ({r.by}, {r.at}; {held})".replace(". .", "."))
    return lines
