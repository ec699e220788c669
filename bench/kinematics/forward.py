"""Forward kinematics of the PUMA 560: one call, and 100 000 random joint vectors, all 16 entries of each pose.

``python forward.py PEER`` in the environment of that peer prints one JSON object.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from environment import size
from kinematics.contenders import CONTENDERS
from pairing import side_by_side

from dhlib import robots

MANY = size(100_000, 4_000)
#: A loop in Python has the same rate for fewer.
MANY_FOR_LOOPS = size(5_000, 200)
SAME = 1e-9


def main() -> None:
    """Check that the peer computes the same poses, then compare."""
    peer = sys.argv[1]
    arm = robots.puma560("modified", source="craig")
    compiled = arm.compiled()
    qs = np.random.default_rng(560).uniform(-np.pi, np.pi, (MANY, arm.n))
    expected = arm.fk(qs)
    rows = []
    for contender in CONTENDERS[peer](arm):
        theirs = qs[:MANY_FOR_LOOPS] if contender.loops else qs
        if peer != "memory":
            for got, pose in zip(contender.many(theirs[:50]), expected, strict=False):
                assert np.abs(got - pose).max() < SAME, f"{peer}, {contender.call}: another pose"
            assert np.abs(contender.one(qs[7]) - expected[7]).max() < SAME
        q = qs[7].copy()
        one = side_by_side(lambda q=q: arm.fk(q), lambda c=contender, q=q: c.one(q), rounds=21)
        swift = side_by_side(lambda q=q: compiled(q), lambda c=contender, q=q: c.one(q), rounds=21)
        pieces = {"our_pieces": MANY, "peer_pieces": len(theirs)}
        many = side_by_side(lambda: arm.fk(qs), lambda c=contender, t=theirs: c.many(t), **pieces)
        fast = side_by_side(lambda: compiled(qs), lambda c=contender, t=theirs: c.many(t), **pieces)
        rows.append(
            {
                "peer": peer,
                "call": contender.call,
                "poses": len(theirs),
                "one": one.as_dict(),
                "compiled_one": swift.as_dict(),
                "many": many.as_dict(),
                "compiled": fast.as_dict(),
            }
        )
    json.dump({"numpy": np.__version__, "rows": rows}, sys.stdout)


if __name__ == "__main__":
    main()
