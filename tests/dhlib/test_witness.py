"""Poses that others computed: `fk_cases.json` (roboticstoolbox-python, confirmed by pybotics and visual-kinematics).

The file is a witness. It is never regenerated with dhlib.
"""

import json
from pathlib import Path

import numpy as np
import pytest

from dhlib import Chain, Prismatic, Revolute, Tz, robots

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


#: What dhlib.robots makes, beside the entry of the witness that it must equal.
OURS = {
    "planar2r_classic": robots.planar(2),
    "planar2r_modified": robots.planar(2, "modified"),
    "planar3r_classic": robots.planar(3),
    "quickshot_classic": robots.quickshot(),
    "quickshot_modified": robots.quickshot("modified"),
    "puma560_craig_modified": robots.puma560(),
    "puma560_craig_classic": robots.puma560("classic"),
    "puma560_corke_classic": robots.puma560("classic", "corke"),
    "puma560_akb_modified": robots.puma560(source="akb"),
    "puma560_fgl_classic": robots.puma560("classic", "fgl"),
    "pa10_7c_A_classic": robots.pa10_7c(),
    "pa10_7c_A_modified": robots.pa10_7c("modified"),
    "pa10_7c_B_classic": robots.pa10_7c(lengths="B"),
    "pa10_6c_A_classic": robots.pa10_6c(),
    "pa10_6c_A_modified": robots.pa10_6c("modified"),
    "stanford_classic": robots.stanford(),
    "stanford_modified": robots.stanford("modified"),
    "scara_cobra600_classic": robots.cobra600(),
    "ur5_classic": robots.ur5(),
    "panda_modified": robots.panda(),
    "irb140_classic": robots.irb140(),
}
#: Corke's toolbox for Python, which made the poses, stands the PUMA on d_1; dhlib puts frame 0 into the shoulder.
STAND = {"puma560_corke_classic": Tz(0.67183)}


def test_every_entry_is_met():
    assert set(OURS) == set(ROBOTS)


@pytest.mark.parametrize("name", OURS)
def test_our_robots(name):
    ours = OURS[name]
    stood = Chain(ours.joints, ours.convention, base=STAND.get(name), tool=ours.tool)
    assert worst(stood, ROBOTS[name]) < 1e-11


@pytest.mark.parametrize("name", OURS)
def test_our_robots_rows(name):
    """The frames agree too, not only the end: row by row, the witness' table is ours."""
    for joint, row in zip(OURS[name].joints, ROBOTS[name]["dh"], strict=True):
        if name in STAND and joint is OURS[name].joints[0]:
            row = {**row, "d": 0.0}
        assert (joint.kind, joint.a) == (row["joint"], row["a"])
        assert joint.alpha == pytest.approx(row["alpha"], abs=1e-15)
        assert joint.theta == pytest.approx(row.get("theta_offset", row.get("theta")), abs=1e-15)
        assert joint.d == pytest.approx(row.get("d", row.get("d_offset")), abs=1e-15)
