"""Do two tables describe the same arm? ``python sameness.py`` in the book's own environment prints one JSON object.

Nobody among the peers decides this, so it is put to the test against two simpler ways that people use: comparing the
tables entry by entry, and comparing the poses at some joint vectors. The pairs are those of the tests: the same arm in
disguise, another arm as a witness that knows nothing of the decision sees it, and the false friends.
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "shared"))
sys.path.insert(0, str(Path(__file__).parents[2] / "tests" / "dhlib"))

import test_mechanism as pairs
from environment import size

from dhlib import Chain, same_mechanism

DISGUISED, CHANGED = size(5000, 50), size(1000, 20)
DIFFERENT = 1e-7
Judge = Callable[[Chain, Chain], bool]


def entry_by_entry(answer: Chain, reference: Chain) -> bool:
    """The tables, in one convention, number by number; angles up to whole turns."""
    if answer.kinds != reference.kinds:
        return False
    for one, other in zip(answer.to_classic().joints, reference.to_classic().joints, strict=True):
        turned = [pairs.wrapped(one.theta - other.theta), pairs.wrapped(one.alpha - other.alpha)]
        turned.append(one.offset - other.offset if one.kind == "P" else pairs.wrapped(one.offset - other.offset))
        if max(map(abs, [*turned, one.d - other.d, one.a - other.a])) > 1e-6 or one.sign != other.sign:
            return False
    return True


def up_to_signs(answer: Chain, reference: Chain) -> bool:
    """The lengths and twists of the tables without their signs."""
    if answer.kinds != reference.kinds:
        return False
    for one, other in zip(answer.to_classic().joints, reference.to_classic().joints, strict=True):
        if abs(abs(one.a) - abs(other.a)) > 1e-6 or abs(abs(one.d) - abs(other.d)) > 1e-6:
            return False
        if abs(abs(pairs.wrapped(one.alpha)) - abs(pairs.wrapped(other.alpha))) > 1e-6:
            return False
    return True


def poses(answer: Chain, reference: Chain) -> bool:
    """The poses at ten joint vectors."""
    if answer.kinds != reference.kinds:
        return False
    qs = np.random.default_rng(10).uniform(-2, 2, (10, reference.n))
    return bool(np.abs(answer.fk(qs) - reference.fk(qs)).max() < 1e-6)


JUDGES: dict[str, tuple[str, Judge]] = {
    "dhlib": ("same_mechanism(answer, reference)", lambda a, b: bool(same_mechanism(a, b))),
    "by hand": ("entries compared", entry_by_entry),
    "by hand, signs": ("entries compared up to signs", up_to_signs),
    "by poses": ("poses compared", poses),
}


def same_arms() -> Iterator[tuple[Chain, Chain]]:
    """Yield pairs that are the same arm, in another table."""
    random = np.random.default_rng(20)
    for _ in range(DISGUISED):
        reference = pairs.random_arm(random)
        yield pairs.disguised(reference, random), reference


def other_arms() -> Iterator[tuple[Chain, Chain]]:
    """Yield pairs that are not: one entry was changed, and the witness sees it."""
    random = np.random.default_rng(21)
    found = 0
    while found < CHANGED:
        reference = pairs.random_arm(random)
        rows = pairs.Rows(reference, random)
        i = random.integers(max(1, rows.n - 1))
        column = [rows.theta, rows.d, rows.a, rows.alpha][random.choice(4, p=[0.1, 0.3, 0.3, 0.3])]
        by = random.choice([-1, 1]) * 10 ** random.uniform(-3, 0)
        column[i] = -column[i] if random.random() < 0.3 else column[i] + by
        answer = pairs.disguised(rows.chain(), random)
        if pairs.Fingerprint(reference).distance(pairs.Fingerprint(answer)) > DIFFERENT:
            found += 1
            yield answer, reference


def false_friends() -> Iterator[tuple[Chain, Chain, bool]]:
    """Yield PUMAs with signs turned, and whether each is the same arm: four mirror images, and four that are."""
    mirrored = ([(3, "alpha")], [(3, "a")], [(3, "d")], [(4, "d")])
    equal = ([(3, "d"), (4, "d")], [(3, "d"), (3, "a")], [(4, "alpha")], [(5, "alpha")])
    for turned in mirrored + equal:
        other = pairs.CORKE
        for row, name in turned:
            other = pairs.changed(other, row, **{name: pairs.minus})
        yield other, pairs.CORKE, turned in equal


def main() -> None:
    """Put all pairs to every judge."""
    warnings.simplefilter("ignore")
    same, other, friends = list(same_arms()), list(other_arms()), list(false_friends())
    rows = []
    for who, (call, judge) in JUDGES.items():
        times = []

        def timed(answer: Chain, reference: Chain, judge: Judge = judge, times: list[float] = times) -> bool:
            begin = time.perf_counter()
            verdict = judge(answer, reference)
            times.append(time.perf_counter() - begin)
            return verdict

        row: dict[str, Any] = {
            "peer": who,
            "call": call,
            "same_found": sum(timed(*pair) for pair in same),
            "others_refused": sum(not timed(*pair) for pair in other),
            "friends_right": sum(timed(answer, arm) == expected for answer, arm, expected in friends),
            "median_seconds": median(times),
        }
        rows.append(row)
    json.dump({"rows": rows, "same": len(same), "others": len(other), "friends": len(friends)}, sys.stdout)


if __name__ == "__main__":
    main()
