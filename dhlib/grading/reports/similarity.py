"""Answers that are alike though they are wrong, and in which hardly anybody else agrees.

The same right answer means nothing, and neither does a wrong one that many give or that a known misconception leads
to: those come from the same misunderstanding. What is left is worth a look, and no more: it is no proof of anything.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from dhlib.grading.marks import NEARLY, OPEN, RIGHT, WRONG
from dhlib.grading.reports.records import Answer, Record

#: A wrong answer that more students share is common, and tells nothing.
RARE = 3
#: Misconceptions that say what is wrong, but not what it would have given.
UNEXPLAINED = ("", "improper")
#: Digits to which numbers are compared: those of two different hands differ before.
DIGITS = 6
#: Pairs that are shown.
MOST = 12
#: How many rare wrong answers a pair must share.
FEWEST = 2


@dataclass(frozen=True)
class Shared:
    """A wrong answer that two students have in common."""

    part: str
    first: Answer
    second: Answer
    students: int


@dataclass(frozen=True)
class Alike:
    """Two students whose rare wrong answers are the same.

    Parameters
    ----------
    first, second : Record
    shared : sequence of Shared
        Part by part.
    wrong : int
        Wrong answers of the one who has fewer.
    """

    first: Record
    second: Record
    shared: Sequence[Shared]
    wrong: int


def alike(records: Sequence[Record]) -> list[Alike]:
    """Pairs of students that share the most rare wrong answers."""
    owners: dict[tuple[str, str], list[tuple[int, Answer]]] = defaultdict(list)
    wrong: dict[int, int] = defaultdict(int)
    for k, record in enumerate(records):
        for answer in record.answers:
            if answer.row.verdict not in (WRONG, NEARLY):
                continue
            wrong[k] += 1
            if answer.row.misconception in UNEXPLAINED and (told := fingerprint(answer.row.reading)):
                owners[answer.row.part, told].append((k, answer))
    shared: dict[tuple[int, int], list[Shared]] = defaultdict(list)
    for (part, _), given in owners.items():
        if 2 <= len(given) <= RARE:
            for (i, first), (j, second) in combinations(given, 2):
                shared[i, j].append(Shared(part, first, second, len(given)))
    pairs = [
        Alike(records[i], records[j], found, min(wrong[i], wrong[j]))
        for (i, j), found in shared.items()
        if len(found) >= FEWEST
    ]
    return sorted(pairs, key=lambda pair: (-len(pair.shared), -len(pair.shared) / pair.wrong))[:MOST]


def same_files(records: Sequence[Record]) -> list[list[Record]]:
    """Students who handed in the same file, byte for byte; but for files in which all is right, which say nothing."""
    owners: dict[str, list[Record]] = defaultdict(list)
    for record in records:
        verdicts = {answer.row.verdict for answer in record.answers}
        if verdicts - {OPEN} and verdicts != {RIGHT}:
            owners[record.submission.sha256].append(record)
    return [owned for owned in owners.values() if len({record.student for record in owned}) > 1]


def fingerprint(reading: Any) -> str:
    """What two answers have in common that are the same; empty where they may easily be so by chance.

    Examples
    --------
    >>> fingerprint({"values": [[1.00000000001, 0.333333333333]]}) == fingerprint({"values": [[1, 1 / 3]]})
    True
    >>> fingerprint({"choice": "n_x"}), fingerprint({"values": [2.0]})
    ('', '')
    """
    if not isinstance(reading, dict) or "fault" in reading or "choice" in reading:
        return ""
    content = reading.get("values") or (reading.get("table") or {}).get("rows")
    entries = list(_entries(content))
    if len(set(entries)) < 4:  # a few numbers only: 0, 1 and a length, say
        return ""
    return "|".join(entries)


def _entries(value: Any) -> Sequence[str]:
    if isinstance(value, list):
        return [entry for item in value for entry in _entries(item)]
    if isinstance(value, bool) or not isinstance(value, int | float):
        return [" ".join(str(value).split())]
    if not math.isfinite(value):
        return ["nan"]
    return [f"{value + 0.0:.{DIGITS}g}" if abs(value) > 1e-9 else "0"]
