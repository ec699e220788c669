"""How far each library is from arithmetic with 50 digits, and what it leaves of a zero at quarter turns.

``python accuracy.py PEER`` in the environment of that peer prints one JSON object. `mpmath` comes with sympy.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import mpmath
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from environment import size
from kinematics.contenders import CONTENDERS

from dhlib import Chain, robots

mpmath.mp.dps = 50
RANDOM, QUARTERS = size(500, 20), size(200, 20)
#: What is smaller is a zero with rounding left on it.
CRUMB = 1e-12


def exact_pose(arm: Chain, q: Any) -> Any:
    """The pose with 50 digits; twists that are quarter turns are meant exactly."""
    pose = mpmath.eye(4)
    for joint, angle in zip(arm.joints, q, strict=True):
        alpha = mpmath.pi / 2 * round(2 * joint.alpha / np.pi)
        c, s, ca, sa = mpmath.cos(angle), mpmath.sin(angle), mpmath.cos(alpha), mpmath.sin(alpha)
        a, d = mpmath.mpf(joint.a), mpmath.mpf(joint.d)
        about_x = mpmath.matrix([[1, 0, 0, a], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1]])
        about_z = mpmath.matrix([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])
        pose *= about_x * about_z
    return pose


def errors(poses: Any, exact: list[Any], reach: float) -> tuple[float, float]:
    """Largest error of a rotation entry, and of a position as a part of the reach."""
    off = np.array(
        [
            [[float(abs(mpmath.mpf(float(pose[i, j])) - want[i, j])) for j in range(4)] for i in range(3)]
            for pose, want in zip(poses, exact, strict=True)
        ]
    )
    return float(off[:, :, :3].max()), float(off[:, :, 3].max() / reach)


def crumbs(poses: Any) -> int:
    """How many entries print as something like 6e-17."""
    return int(((np.abs(poses) > 0) & (np.abs(poses) < CRUMB)).sum())


def main() -> None:
    """Compare both with the exact poses."""
    peer = sys.argv[1]
    arm = robots.puma560("modified", source="craig")
    random = np.random.default_rng(50)
    qs = random.uniform(-np.pi, np.pi, (RANDOM, arm.n))
    quarters = random.integers(-4, 5, (QUARTERS, arm.n)) * (np.pi / 2)
    exact = [exact_pose(arm, q) for q in qs]

    def row(who: str, call: str, many: Any) -> dict[str, Any]:
        rotation, position = errors(many(qs), exact, arm.reach)
        return {"peer": who, "call": call, "rotation": rotation, "position": position, "crumbs": crumbs(many(quarters))}

    rows = [row("dhlib", "arm.fk(q)", arm.fk), row("dhlib", "arm.compiled()(q)", arm.compiled())]
    rows += [row(peer, contender.call, contender.many) for contender in CONTENDERS[peer](arm)]
    json.dump({"numpy": np.__version__, "quarter_turns": QUARTERS, "rows": rows}, sys.stdout)


if __name__ == "__main__":
    main()
