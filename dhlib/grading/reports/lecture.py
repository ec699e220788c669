"""What to say in the next lecture: the misconceptions that cost the class most."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

from dhlib.grading.misconceptions import KNOWN
from dhlib.grading.reports.records import Record, parts_of

#: A wrong answer that the exercise itself knows, and the parts in which more than one slip fits.
TRAP = "trap"


@dataclass(frozen=True)
class Cost:
    """A misconception, and what it cost the class.

    Parameters
    ----------
    key : str
    brief : str
        What to check, in a few words.
    says : str
        What the page told most of those who have it.
    section : str
        Where it is set right.
    students : int
    points : float
        Lost by all of them together.
    parts : sequence of str
        Where it showed, most often first.
    """

    key: str
    brief: str
    says: str
    section: str
    students: int
    points: float
    parts: Sequence[str]


def costs(records: Sequence[Record]) -> list[Cost]:
    """All misconceptions of the class, the dearest first."""
    lost: dict[str, float] = defaultdict(float)
    students: dict[str, set[int]] = defaultdict(set)
    said: dict[str, Counter[str]] = defaultdict(Counter)
    parts: dict[str, Counter[str]] = defaultdict(Counter)
    sections: dict[str, Counter[str]] = defaultdict(Counter)
    for record in records:
        for answer in record.answers:
            row = answer.row
            if not row.misconception or answer.passed:
                continue
            key = _key(row.misconception, row.part)
            lost[key] += max(row.out_of - answer.points, 0.0)
            students[key].add(record.submission.id)
            said[key][row.message] += 1
            parts[key][row.part] += 1
            sections[key][row.section] += 1
    found = []
    for key, points in lost.items():
        section = sections[key].most_common(1)[0][0]
        known = KNOWN.get(key)
        found.append(
            Cost(
                key,
                known.brief if known else key.partition(" ")[2] or "several slips that lead to the same answer",
                said[key].most_common(1)[0][0],
                section,
                len(students[key]),
                round(points, 2),
                [part for part, _ in parts[key].most_common()],
            )
        )
    return sorted(found, key=lambda cost: (-cost.points, -cost.students, cost.key))


def heat(records: Sequence[Record]) -> tuple[list[str], list[str], list[list[int]]]:
    """Misconceptions (rows), parts (columns), and how many students showed the one in the other."""
    counts: Counter[tuple[str, str]] = Counter()
    for record in records:
        for answer in record.answers:
            if answer.row.misconception and not answer.passed:
                for key in answer.row.misconception.split("+"):
                    counts[key if key in KNOWN else TRAP, answer.row.part] += 1
    keys = [key for key in (*KNOWN, TRAP) if any(row == key for row, _ in counts)]
    parts = [part for part in parts_of(records) if any(column == part for _, column in counts)]
    return keys, parts, [[counts[key, part] for part in parts] for key in keys]


def label(key: str) -> str:
    """A misconception in a few words.

    Examples
    --------
    >>> label("degrees"), label("trap")
    ('degrees and radians', 'slip that this part invites')
    """
    return KNOWN[key].brief if key in KNOWN else "slip that this part invites"


def _key(misconception: str, part: str) -> str:
    """One that the exercise itself knows is another in each part."""
    return misconception if misconception in KNOWN or "+" in misconception else f"{TRAP} a slip that {part} invites"
