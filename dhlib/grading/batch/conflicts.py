"""Look over all submissions: who is claimed twice, whose work nobody knows, and who names somebody else."""

from __future__ import annotations

import unicodedata
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence

from dhlib.grading.batch.intake import Lookup
from dhlib.grading.batch.rows import Certainty, Problem, Submission

UNREADABLE = "unreadable"
#: An exercise that fewer than one in so many hand in, of those who hand in the most common one, is perhaps a mistake.
HARDLY_ANYBODY = 20


def conflicts(submissions: Sequence[Submission], roster: Lookup | None = None) -> list[Problem]:
    """What an instructor should look at before handing marks back; nothing was decided but what the sentences say.

    Parameters
    ----------
    submissions : sequence of Submission
    roster : callable, optional
        Who goes by a name: also who handed in nothing else.
    """
    looks = (_unknown, _claimed_twice, _at_once, _displaced, _astray)
    return [*_contradicted(submissions, roster), *(problem for look in looks for problem in look(submissions))]


def _unknown(submissions: Sequence[Submission]) -> Iterator[Problem]:
    for submission in submissions:
        if not submission.student:
            yield Problem(
                submission.source,
                "Nothing says whose it is. Put it into a folder with the name of the student, and grade again.",
            )


def _claimed_twice(submissions: Sequence[Submission]) -> Iterator[Problem]:
    """Two places, or two files that only speak for themselves, that are said to be one student's."""
    groups: dict[tuple[str, str], list[Submission]] = defaultdict(list)
    for submission in submissions:
        if submission.student and submission.status != UNREADABLE:
            groups[submission.student, submission.exercise].append(submission)
    for (student, exercise), group in groups.items():
        places = {submission.place for submission in group}
        if len(places) < 2:
            continue
        sources = " and ".join(sorted({submission.source for submission in group}))
        counting = next((submission.source for submission in group if submission.counts), "")
        what = f"{sources} are all said to be of {student}, for {exercise}. "
        what += (
            f"{counting} counts, as the last of those whose place says so."
            if counting
            else "Nothing but the notebooks themselves says so, so none counts: put the right one into a folder "
            "with the name of the student, and grade again."
        )
        yield Problem(group[0].source, what, (student,))


def _at_once(submissions: Sequence[Submission]) -> Iterator[Problem]:
    """Several notebooks for one exercise, handed in within one minute: which is the last, only their names say."""
    groups: dict[tuple[str, ...], list[Submission]] = defaultdict(list)
    for s in submissions:
        if s.student and s.status != UNREADABLE:
            groups[s.student, s.exercise, s.place, str(s.sequence), s.submitted[:16]].append(s)
    for (student, exercise, *_), group in groups.items():
        sources = sorted({submission.source for submission in group})
        counting = next((submission.source for submission in group if submission.counts), "")
        if len(sources) > 1 and counting:
            what = f"{' and '.join(sources)} came together, for {exercise}. {counting} counts, as the last by its name."
            yield Problem(counting, what, (student,))


def _astray(submissions: Sequence[Submission]) -> Iterator[Problem]:
    """Notebooks of another exercise than nearly everybody's."""
    common = Counter(submission.exercise for submission in submissions if submission.exercise)
    for submission in submissions:
        most, count = common.most_common(1)[0] if common else ("", 0)
        if submission.exercise and common[submission.exercise] * HARDLY_ANYBODY < count:
            what = (
                f"It is of the exercise {submission.exercise}, and nearly all others are of {most}. It was graded as "
            )
            what += f"what it is; `dhlib export --exercise {most}` leaves it out."
            yield Problem(submission.source, what, (submission.student,) if submission.student else ())


def _contradicted(submissions: Sequence[Submission], roster: Lookup | None) -> Iterator[Problem]:
    """Notebooks that say that they are somebody else's."""
    known = {_plain(name): s.student for s in submissions if s.student for name in (s.student, s.name)}
    claimants: dict[str, set[str]] = defaultdict(set)
    for submission in submissions:
        if submission.claims and submission.student:
            claimants[_plain(submission.claims)].add(submission.student)
    for submission in submissions:
        claims = _plain(submission.claims)
        if not claims or submission.certainty <= Certainty.METADATA:
            continue
        person = roster([submission.claims]) if roster and claims not in known else None
        meant = person.id if person else known.get(claims)
        if meant == submission.student:
            continue
        if meant is not None:
            what = f"It says that it is of {meant}, but it was found where {submission.student}'s work is."
            yield Problem(submission.source, what, (submission.student, meant))
        elif len(claimants[claims]) > 1:
            others = sorted(claimants[claims] - {submission.student})
            what = f"It says that it is of {submission.claims!r}, and so do notebooks of {', '.join(others)}."
            yield Problem(submission.source, what, (submission.student, *others))


def _displaced(submissions: Sequence[Submission]) -> Iterator[Problem]:
    """Last attempts that cannot be read, so that an earlier one counts."""
    counting = {s.student: s for s in submissions if s.counts and s.student and s.status != UNREADABLE}
    for submission in submissions:
        if submission.status == UNREADABLE and not submission.counts and submission.student in counting:
            other = counting[submission.student]
            what = f"It cannot be read; {other.source} counts instead."
            yield Problem(submission.source, what, (submission.student,))


def _plain(name: str) -> str:
    return unicodedata.normalize("NFC", name).strip().casefold()
