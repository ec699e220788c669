"""``dhlib adjust``: what the instructor decides beside what was marked."""

from __future__ import annotations

import argparse
import math
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.reports.arguments import add_results
from dhlib.grading.reports.audit import decisions
from dhlib.grading.reports.cells import number
from dhlib.grading.reports.decisions import Adjustment, Rule, adjust, revoke, set_rule
from dhlib.grading.reports.late import LateRule, read_time
from dhlib.grading.reports.people import find_exercise_of, find_student
from dhlib.grading.reports.write import write_reports

DESCRIPTION = """\
Change what counts, and say why. The marks themselves stay, grading again does not touch what was decided here, and the
student reads the reason. Reports are written anew.

  points of a part       dhlib adjust RESULTS --student S --part A1 --points 1 --reason "…"
  points beside parts    dhlib adjust RESULTS --student S --bonus -2 --reason "…"
  due time, for all      dhlib adjust RESULTS --due "2026-11-20 23:59" --late "10%/day, max 50%" --grace 15min
  due time, for one      dhlib adjust RESULTS --student S --due "2026-11-27 23:59" --reason "…"
  what was decided       dhlib adjust RESULTS --list
  taken back             dhlib adjust RESULTS --revoke 3      (a rule: --revoke-rule 1)"""


def add_adjust(commands: Any) -> None:
    """Add ``adjust`` to the commands of the parser."""
    parser = commands.add_parser(
        "adjust",
        help="change points by hand, set due times and late rules",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_results(parser)
    parser.add_argument("--student", metavar="S", help="name, or the first column of grades.csv")
    parser.add_argument("--exercise", default="", metavar="NAME", help="which exercise, if the results are of several")
    parser.add_argument("--part", metavar="P", help="the part whose points are set")
    parser.add_argument("--points", type=float, metavar="X", help="its points")
    parser.add_argument("--bonus", type=float, metavar="X", help="points added beside the parts; below 0: taken away")
    parser.add_argument("--reason", default="", metavar="TEXT", help="why; the student reads it")
    parser.add_argument("--due", default="", metavar="TIME", help="when it was due, such as '2026-11-20 23:59'")
    parser.add_argument("--late", default="", metavar="RULE", help="what being late costs: '10%%/day, max 50%%'")
    parser.add_argument("--grace", default="", metavar="SPAN", help="how long after it is still in time: 15min, 2h")
    parser.add_argument("--list", action="store_true", help="show what was decided")
    parser.add_argument("--revoke", type=int, metavar="N", help="take back adjustment N")
    parser.add_argument("--revoke-rule", type=int, metavar="N", help="take back rule N")
    parser.set_defaults(run=change)


def change(options: argparse.Namespace) -> int:
    """Do what was asked for, and write the reports anew."""
    asked = [
        name
        for name, said in (
            ("--list", options.list),
            ("--revoke", options.revoke is not None),
            ("--revoke-rule", options.revoke_rule is not None),
            ("--points", options.points is not None or options.part),
            ("--bonus", options.bonus is not None),
            ("--due, --late", options.due or options.late or options.grace),
        )
        if said
    ]
    if len(asked) != 1:
        too = f"one thing at a time, not {' and '.join(asked)}" if asked else "say what to change"
        raise DHError(f"{too}; `dhlib adjust --help` shows how.")
    with Store(options.results) as store:
        if options.list:
            print("\n".join(decisions(store)) or "Nothing was decided by hand.")
            return 0
        said, only = _done(store, options)
        written = write_reports(store, only=only)
    print(f"{said}\nGrades: {written.grades}")
    return 0


def _done(store: Store, options: argparse.Namespace) -> tuple[str, tuple[str, ...] | None]:
    """Keep a decision; return what to say, and whose pages change (None: everybody's)."""
    for table, chosen in (("adjustment", options.revoke), ("rule", options.revoke_rule)):
        if chosen is not None:
            revoke(store, table, chosen)
            return f"{table.capitalize()} {chosen} holds no longer.", None
    if options.due or options.late or options.grace:
        return _rule(store, options)
    if not options.student:
        raise DHError("whose points? Say --student S.")
    if not options.reason.strip():
        raise DHError("say why, with --reason: the student reads it.")
    student = find_student(store, options.student)
    exercise = find_exercise_of(store, student, options.exercise)
    points = options.points if options.bonus is None else options.bonus
    if options.bonus is None:
        _check_part(store, student, exercise, options)
    elif not math.isfinite(points):
        raise DHError("--bonus should be a number.")
    kept = adjust(
        store,
        Adjustment(
            exercise=exercise,
            student=student,
            part=options.part or "",
            points=points,
            reason=options.reason.strip(),
        ),
    )
    what = f"{options.part} has {number(points)} points" if options.part else f"{points:+g} points beside the parts"
    return f"{student}: {what} (adjustment {kept}).", (student,)


def _check_part(store: Store, student: str, exercise: str, options: argparse.Namespace) -> None:
    if not options.part or options.points is None:
        raise DHError("--part and --points belong together: the points that this part has.")
    rows = store.query(
        "SELECT DISTINCT part, mark.out_of FROM mark JOIN submission ON submission.id = mark.submission "
        "WHERE exercise = ? ORDER BY position",
        (exercise,),
    )
    worth = {str(row["part"]): float(row["out_of"]) for row in rows}
    if options.part not in worth:
        raise DHError(f"{exercise} has no part {options.part!r}; its parts are {', '.join(worth)}.")
    if not 0 <= options.points <= worth[options.part]:
        most = number(worth[options.part])
        raise DHError(f"{options.part} is worth 0 to {most} points; what goes beyond is a --bonus.")


def _rule(store: Store, options: argparse.Namespace) -> tuple[str, tuple[str, ...] | None]:
    student = find_student(store, options.student) if options.student else ""
    exercise = find_exercise_of(store, student, options.exercise) if options.exercise else ""
    due = read_time(options.due).isoformat(timespec="seconds") if options.due else ""
    if options.late:
        LateRule.read(options.late, options.grace)  # refused now rather than when it is used
    elif options.grace:
        raise DHError("--grace belongs to a rule: say --late too.")
    kept = set_rule(
        store,
        Rule(
            exercise=exercise,
            student=student,
            due=due,
            late=options.late,
            grace=options.grace,
            reason=options.reason.strip(),
        ),
    )
    told = [f"due {due.replace('T', ' ').replace('+00:00', ' UTC')}" if due else ""]
    told.append(str(LateRule.read(options.late, options.grace)) if options.late else "")
    return (
        f"{student or 'All'}: {'; '.join(text for text in told if text)} (rule {kept}).",
        (student,) if student else None,
    )
