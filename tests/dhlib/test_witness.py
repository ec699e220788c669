"""Poses that others computed: `fk_cases.json` (roboticstoolbox-python, confirmed by pybotics and visual-kinematics).

The file is a witness. It is never regenerated with dhlib.
"""

import json
from pathlib import Path

import numpy as np
import pytest

from dhlib import Chain, Prismatic, Revolute

ROBOTS = json.loads((Path(__file__).parent / "fk_cases.json").read_text(encoding="utf-8"))["robots"]


def chain_of(entry):
    joints = [
        Revolute(d=row["d"], a=row["a"], alpha=row["alpha"], offset=row["theta_offset"])
        if row["joint"] == "R"
        else Prismatic(theta=row["theta"], a=row["a"], alpha=row["alpha"], offset=row["d_offset"])
        for row in entry["dh"]
    ]
    return Chain(joints, entry["convention"], base=entry["base"], tool=entry["tool"])


def worst(chain, entry):
    return max(
        np.abs(chain.fk(case["q"]) - np.array(case["T"])).max() / max(1.0, np.abs(np.array(case["T"])).max())
        for case in entry["cases"]
    )


@pytest.mark.parametrize("name", ROBOTS)
def test_pose(name):
    assert worst(chain_of(ROBOTS[name]), ROBOTS[name]) < 1e-11


@pytest.mark.parametrize("name", ROBOTS)
def test_pose_after_conversion(name):
    chain = chain_of(ROBOTS[name])
    assert worst(chain.to_classic(), ROBOTS[name]) < 1e-11
    assert worst(chain.to_modified(), ROBOTS[name]) < 1e-11


@pytest.mark.parametrize("name", ROBOTS)
def test_wrong_length_is_seen(name):
    entry = ROBOTS[name]
    k = next(i for i, row in enumerate(entry["dh"]) if row["a"] or row.get("d", row.get("d_offset")))
    changed = json.loads(json.dumps(entry))
    field = "a" if changed["dh"][k]["a"] else "d"
    changed["dh"][k][field] *= 1 + 1e-6
    assert worst(chain_of(changed), entry) > 1e-9
