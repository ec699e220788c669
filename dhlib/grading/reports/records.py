"""What the results say of each student, with what the instructor decided: everything else here is a view of this."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from functools import cached_property
from typing import Any

from dhlib.grading.batch.rows import MarkRow, Submission
from dhlib.grading.batch.store import Store
from dhlib.grading.marks import FOLLOWS, RIGHT
from dhlib.grading.reports.cells import number
from dhlib.grading.reports.decisions import Adjustment, Timing, adjustments, rules, timing
from dhlib.grading.reports.late import span_text


@dataclass(frozen=True)
class Answer:
    """The mark of one part, and what was changed about it by hand."""

    row: MarkRow
    adjustment: Adjustment | None = None

    @property
    def points(self) -> float:
        """Points, as they count."""
        return self.adjustment.points if self.adjustment else self.row.points

    @property
    def passed(self) -> bool:
        """Whether nothing was left to do."""
        return self.row.verdict in (RIGHT, FOLLOWS)

    @property
    def part_of(self) -> float:
        """Points as a part of what could be earned, 0 to 1."""
        return self.points / self.row.out_of if self.row.out_of else 0.0


#: Where the instructor set no due time.
NO_TIMING = Timing(None, None)


@dataclass(frozen=True)
class Record:
    """What counts for one student and one exercise.

    Parameters
    ----------
    submission : Submission
        The attempt that counts.
    answers : sequence of Answer
        Part by part.
    bonuses : sequence of Adjustment
        Points beside the parts.
    timing : Timing
        When it was due, and what being late costs.
    attempts : int
        How many the student made.
    """

    submission: Submission
    answers: Sequence[Answer]
    bonuses: Sequence[Adjustment] = ()
    timing: Timing = NO_TIMING
    attempts: int = 1

    @property
    def student(self) -> str:
        """The name that stays."""
        return self.submission.student

    @property
    def name(self) -> str:
        """What the student is called; where nobody knows, where the file was found."""
        return self.submission.name or self.student or self.submission.source

    @property
    def exercise(self) -> str:
        """Its name."""
        return self.submission.exercise

    @property
    def marked(self) -> bool:
        """Whether there was anything to mark: a file that cannot be read has no points, not even 0."""
        return bool(self.answers)

    @property
    def out_of(self) -> float:
        """Points that could be earned."""
        return self.submission.out_of

    @property
    def earned(self) -> float:
        """Points earned, before anything is taken away for being late."""
        given = sum(answer.points for answer in self.answers) + sum(bonus.points for bonus in self.bonuses)
        return round(given, 2)

    @property
    def late_seconds(self) -> float | None:
        """How late it was; 0 if in time, None if that cannot be said."""
        if self.timing.due and self.submission.submitted:
            return max(0.0, (datetime.fromisoformat(self.submission.submitted) - self.timing.due).total_seconds())
        return self.submission.late_seconds

    @property
    def deducted(self) -> float:
        """Points taken away for being late: never more than were earned."""
        rule, seconds = self.timing.late, self.late_seconds
        if rule is None or not seconds:
            return 0.0
        return round(min(self.out_of * rule.percent_off(seconds) / 100, max(self.earned, 0.0)), 2)

    @property
    def points(self) -> float:
        """What counts."""
        return round(max(self.earned - self.deducted, 0.0), 2)

    @cached_property
    def about_time(self) -> str:
        """When it came, and what that costs, in a sentence; empty where there is nothing to say."""
        rule, seconds = self.timing.late, self.late_seconds
        if seconds is None:
            if not self.submission.late:
                return ""
            return "It was handed in late; by how much is not known, so nothing is taken away."
        if not seconds:
            return ""
        says = f"It was handed in {span_text(seconds)} late."
        if rule is None:
            return says
        if not self.deducted:
            return f"{says} Nothing is taken away ({rule})."
        percent = number(rule.percent_off(seconds))
        return f"{says} {number(self.deducted)} points are taken away: {percent} % ({rule})."


def read_results(store: Store) -> list[Record]:
    """What counts, of every student and exercise, by exercise and name."""
    given = adjustments(store)
    in_force = rules(store)
    attempts: dict[tuple[str, str], int] = {}
    submissions = store.submissions()
    for each in submissions:
        attempts[each.exercise, each.student] = attempts.get((each.exercise, each.student), 0) + 1
    marks: dict[int, list[MarkRow]] = {}
    names = "part, title, points, out_of, verdict, message, misconception, section, answer"
    for row in store.query(f"SELECT submission, {names} FROM mark ORDER BY submission, position"):
        values = dict(row)
        marks.setdefault(values.pop("submission"), []).append(MarkRow(**values))
    records = []
    for submission in submissions:
        if not submission.counts:
            continue
        mine = [a for a in given if submission.student and _about(a) == (submission.exercise, submission.student)]
        by_part = {a.part: a for a in mine if a.part}
        records.append(
            Record(
                submission,
                tuple(Answer(row, by_part.get(row.part)) for row in marks.get(submission.id, [])),
                tuple(a for a in mine if not a.part),
                timing(in_force, submission.student, submission.exercise),
                attempts[submission.exercise, submission.student] if submission.student else 1,
            )
        )
    return sorted(records, key=lambda record: (record.exercise, record.name.casefold(), record.submission.id))


def _about(adjustment: Adjustment) -> tuple[str, str]:
    return adjustment.exercise, adjustment.student


def renamed(records: Sequence[Record], rename: Callable[[str], str]) -> list[Record]:
    """The records without names: `rename` gives each student another one.

    Where a file was found, and sentences that quote its name, are left out too, since both hold names.
    """

    def hidden(record: Record) -> Record:
        submission = record.submission
        alias = rename(submission.student or submission.source)
        told = _without(submission.message, submission)
        return replace(
            record,
            submission=replace(submission, student=alias, name=alias, source="", place="", message=told),
            answers=tuple(
                replace(
                    answer,
                    row=replace(answer.row, message=_without(answer.row.message, submission)),
                    adjustment=answer.adjustment and _hidden(answer.adjustment, alias, submission),
                )
                for answer in record.answers
            ),
            bonuses=tuple(_hidden(bonus, alias, submission) for bonus in record.bonuses),
            timing=replace(record.timing, reason=_without(record.timing.reason, submission)),
        )

    return sorted(map(hidden, records), key=lambda record: (record.exercise, record.name))


def _hidden(adjustment: Adjustment, alias: str, submission: Submission) -> Adjustment:
    return replace(adjustment, student=alias, reason=_without(adjustment.reason, submission), by="")


def _without(text: str, submission: Submission) -> str:
    """A sentence without the names of its student."""
    said = [submission.source, *submission.source.split("/"), submission.place, submission.name, submission.student]
    words = {word for word in re.split(r"[\s,_/.-]+", submission.name) if len(word) > 2}
    for each in sorted({*said, *words} - {""}, key=len, reverse=True):
        text = re.sub(rf"(?<!\w){re.escape(each)}(?!\w)", "…", text, flags=re.IGNORECASE)
    return text


def parts_of(records: Sequence[Record]) -> list[str]:
    """All parts of some records, in the order of the exercise."""
    return list(dict.fromkeys(answer.row.part for record in records for answer in record.answers))


def exercises_of(records: Sequence[Record]) -> list[str]:
    """All exercises of some records."""
    return list(dict.fromkeys(record.exercise for record in records))


def as_plain(record: Record) -> dict[str, Any]:
    """A record as plain JSON."""
    submission = record.submission
    return {
        "student": record.student,
        "name": submission.name,
        "exercise": record.exercise,
        "source": submission.source,
        "attempt": submission.attempt,
        "attempts": record.attempts,
        "submitted": submission.submitted,
        "late_seconds": record.late_seconds,
        "status": submission.status,
        "message": submission.message,
        "earned": record.earned,
        "deducted": record.deducted,
        "points": record.points,
        "out_of": record.out_of,
        "late_rule": str(record.timing.late) if record.timing.late else "",
        "bonuses": [{"points": bonus.points, "reason": bonus.reason} for bonus in record.bonuses],
        "parts": [
            {
                "part": answer.row.part,
                "title": answer.row.title,
                "points": answer.points,
                "out_of": answer.row.out_of,
                "verdict": answer.row.verdict,
                "message": answer.row.message,
                "misconception": answer.row.misconception,
                "section": answer.row.section,
                "answer": answer.row.reading,
            }
            | ({"marked": answer.row.points, "reason": answer.adjustment.reason} if answer.adjustment else {})
            for answer in record.answers
        ],
        "graded_at": submission.graded_at,
        "sha256": submission.sha256,
        "dhlib": submission.dhlib,
    }
