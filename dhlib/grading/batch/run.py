"""Grade a class: go through what was handed in, and keep what comes out."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from datetime import UTC
from pathlib import Path
from typing import Any, Literal, Protocol

from dhlib.errors import DHError
from dhlib.grading.asked import Catalogue, names
from dhlib.grading.batch.conflicts import conflicts
from dhlib.grading.batch.intake import HandedIn, Intake, Lookup, collect
from dhlib.grading.batch.lock import Lock
from dhlib.grading.batch.progress import Progress
from dhlib.grading.batch.rows import Certainty, Grounds, Submission
from dhlib.grading.batch.store import FILE, Store, now
from dhlib.grading.batch.trees import Reader
from dhlib.grading.batch.versions import versions
from dhlib.grading.batch.work import Graded, Settings, Work
from dhlib.grading.grade import FAILED, GRADED

Regrade = Literal["", "changed", "all"]
#: Since when a run grades everything again: it is kept until the run is done, so that it can be resumed.
_SINCE = "grading all since"


class Workers(Protocol):
    """Whoever grades: processes on this machine, or a cluster."""

    def grade(self, works: Iterator[Work]) -> Iterator[Graded]:
        """Grade all, in any order, reading no more of them than is needed."""


@dataclass
class Summary:
    """What a run did.

    Parameters
    ----------
    found : int
        Files that were handed in.
    done : int
        Graded in this run.
    kept : int
        Graded before.
    status : dict of str to int
        How many there are of each, in all.
    problems : int
        Listed for the instructor.
    """

    found: int = 0
    done: int = 0
    kept: int = 0
    status: dict[str, int] = field(default_factory=dict)
    problems: int = 0


@dataclass(frozen=True)
class Shard:
    """A share of the work: number i of n.

    Examples
    --------
    >>> shares = [Shard(i, 3) for i in range(3)]
    >>> sum(share.takes("class/ada") for share in shares)
    1
    >>> Shard(0, 3).takes("class/ada") == Shard(3, 3).takes("class/ada")
    True
    """

    index: int = 0
    count: int = 1

    def takes(self, place: str) -> bool:
        """Whether all that lies in this place is graded in this share."""
        drawn = int.from_bytes(hashlib.sha256(place.encode("utf-8", "backslashreplace")).digest()[:8], "big")
        return drawn % self.count == self.index % self.count


def grade_class(
    sources: Sequence[Path],
    out: Path,
    settings: Settings,
    workers: Workers,
    *,
    regrade: Regrade = "",
    roster: Lookup | None = None,
    shard: Shard | None = None,
    quiet: bool = False,
) -> Summary:
    """Grade all that was handed in and not graded yet, and keep it in the folder `out`.

    Stopped at any moment, the same call goes on where it was.

    Parameters
    ----------
    sources : sequence of Path
        Files, folders, ZIP archives.
    out : Path
        Folder of the results; made where it is missing.
    settings : Settings
    workers : Workers
    regrade : {"", "changed", "all"}
        Grade again: nothing, what was graded with another exercise or another dhlib, or everything.
    roster : callable, optional
    shard : Shard, optional
    quiet : bool
        Name nobody in what is printed.

    Raises
    ------
    DHError
        If the results cannot be written, another grader writes them, there is nothing to grade, or nothing can be
        graded. What was graded before is kept.
    """
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise DHError(f"the folder {out} cannot be made: {error.strerror}.") from None
    with Lock(out), Store(out / FILE, create=True) as store:
        run = _Run(store, settings, regrade, quiet)
        intake = _share(collect(sources, names(settings.exercises), roster), shard)
        run.go(intake, workers)
        store.replace_problems([*intake.problems, *conflicts(store.submissions(), roster)])
        return run.summary(intake)


class _Run:
    def __init__(self, store: Store, settings: Settings, regrade: Regrade, quiet: bool) -> None:
        self.store, self.settings, self.regrade, self.quiet = store, settings, regrade, quiet
        self.catalogue = Catalogue(settings.exercises, settings.key)
        self.before = store.graded()
        self.known = {(s.source, s.sha256): s for s in store.submissions()} if self.before else {}
        self.since = self._since()
        self.under_way: dict[int, tuple[HandedIn, str]] = {}
        self.done = 0

    def go(self, intake: Intake, workers: Workers) -> None:
        with Progress(len(intake.found)) as progress:
            for graded in workers.grade(self._works(intake, progress)):
                handed_in, sha256 = self.under_way.pop(graded.number)
                self.store.add(self._submission(handed_in, sha256, graded), graded.marks)
                self.done += 1
                if graded.status != GRADED:
                    # the message may hold the name of the file, and that the name of the student
                    named = f"{handed_in.source}: {graded.status}. {graded.message}".rstrip()
                    progress.say(f"number {graded.number + 1}: {graded.status}." if self.quiet else named)
                progress.advance()
        if self.since:
            self.store.set_meta(_SINCE, "")

    def summary(self, intake: Intake) -> Summary:
        rows = self.store.query("SELECT status, count(*) FROM submission GROUP BY status ORDER BY status")
        return Summary(
            found=len(intake.found),
            done=self.done,
            kept=len(intake.found) - self.done,
            status={row[0]: row[1] for row in rows},
            problems=len(self.store.problems()),
        )

    def _works(self, intake: Intake, progress: Progress) -> Iterator[Work]:
        """What is still to be graded, read one by one as it is asked for."""
        with Reader() as reader:
            for number, handed_in in enumerate(intake.found):
                data, fault = b"", ""
                try:
                    data = reader.read(handed_in.entry)
                except DHError as error:
                    fault = str(error)
                sha256 = hashlib.sha256(data).hexdigest() if not fault else f"unreadable: {fault}"
                grounds = self.before.get((handed_in.source, sha256))
                if grounds is not None and not self._again(grounds):
                    self._told_anew(handed_in, sha256)
                    progress.advance()
                    continue
                self.under_way[number] = (handed_in, sha256)
                yield Work(number, handed_in.entry.name, handed_in.origin.student, data, fault)

    def _since(self) -> str:
        if self.regrade != "all":
            return ""
        since = self.store.meta(_SINCE) or now()
        self.store.set_meta(_SINCE, since)
        return since

    def _again(self, grounds: Grounds) -> bool:
        """Whether something that was graded is graded again."""
        if self.regrade == "all":
            return grounds.graded_at < self.since
        if grounds.status == FAILED:
            return True
        if not grounds.exercise and self.settings.exercise:  # nobody knew which exercise it was, and now somebody says
            return True
        exercise = self.settings.exercise or grounds.exercise
        return self.regrade == "changed" and (
            grounds.exercise != exercise
            or grounds.dhlib != versions()["dhlib"]
            or (exercise != "" and grounds.exercise_sha256 != self.catalogue.sha256(exercise))
        )

    def _told_anew(self, handed_in: HandedIn, sha256: str) -> None:
        """Keep who it is by what is known today, such as by another roster."""
        submission = self.known[handed_in.source, sha256]
        origin = handed_in.origin
        if origin.certainty == Certainty.NOBODY and submission.certainty == Certainty.METADATA:
            return
        today = _identity(handed_in, submission.claims)
        if any(getattr(submission, name) != value for name, value in today.items()):
            self.store.identify(Submission(**{**vars(submission), **today}))

    def _submission(self, handed_in: HandedIn, sha256: str, graded: Graded) -> Submission:
        return Submission(
            exercise=graded.exercise,
            **_identity(handed_in, graded.claims),
            source=handed_in.source,
            claims=graded.claims,
            sha256=sha256,
            status=graded.status,
            message=graded.message,
            points=graded.points,
            out_of=graded.out_of,
            seconds=graded.seconds,
            graded_at=now(),
            exercise_sha256=graded.exercise_sha256,
            **versions(),
        )


def _identity(handed_in: HandedIn, claims: str) -> dict[str, Any]:
    """Who handed something in: by its place, and only where that is silent by what the notebook says."""
    origin = handed_in.origin
    student, name, certainty = origin.student, origin.name, origin.certainty
    if certainty == Certainty.NOBODY and claims:
        student, name, certainty = claims, claims, Certainty.METADATA
    submitted = handed_in.submitted
    return {
        "student": student,
        "name": name,
        "certainty": certainty,
        "place": origin.place,
        "sequence": origin.sequence,
        "submitted": submitted.astimezone(UTC).isoformat(timespec="seconds") if submitted else "",
        "late": origin.late,
    }


def _share(intake: Intake, shard: Shard | None) -> Intake:
    if shard is None:
        return intake
    # what could not be placed is listed once, by the first share
    first = shard.index % shard.count == 1 % shard.count
    found = [handed_in for handed_in in intake.found if shard.takes(handed_in.origin.place)]
    return Intake(found, intake.problems if first else [])
