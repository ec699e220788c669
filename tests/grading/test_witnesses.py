"""For every arm that others computed too, each kind of reference leads to their poses, and not with a sign changed.

`fk_cases.json` was made by roboticstoolbox-python. Where a reference is a part of the way, the links that are missing
are multiplied here from the rows of that file, step by step and without dhlib.
"""

import json
from dataclasses import dataclass, replace
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from dhlib import Chain
from dhlib.grading.exercise import load_exercise, load_module
from dhlib.grading.forms import Formula, Frames, Function, Numbers, Table
from dhlib.grading.retelling import altered

ROOT = Path(__file__).parents[2]
ROBOTS = json.loads((ROOT / "tests" / "dhlib" / "fk_cases.json").read_text("utf-8"))["robots"]
NEAR, FAR = 1e-9, 1e-3
NAMES = sorted(path.stem for path in (ROOT / "solutions").glob("*.ipynb"))


@dataclass(frozen=True)
class Witness:
    """References of one kind, and how they lead to the pose that the witness has.

    Parameters
    ----------
    exercise, entry : str
        The entry of the witness.
    kind, convention : str
    way : tuple
        Factors of the pose of the last frame: parts by name; a number is a link of the witness; a matrix is itself. A
        part that is a function of a link's number is taken at ``(name, number)``, a table as the product of its rows.
    """

    exercise: str
    entry: str
    kind: str
    convention: str
    way: tuple

    def __str__(self):
        return f"{self.exercise}-{self.kind}-{self.convention}-{self.entry}"

    @property
    def links(self):
        """The links, by number, that are the exercise's own."""
        left = {factor for factor in self.way if isinstance(factor, int)}
        return [i for i in range(1, len(ROBOTS[self.entry]["dh"]) + 1) if i not in left]


def along(x=0.0, z=0.0):
    matrix = np.eye(4)
    matrix[0, 3], matrix[2, 3] = x, z
    return matrix


def every(name, n):
    return tuple((name, i) for i in range(1, n + 1))


WITNESSES = [
    Witness("planar", "planar2r_classic", "table", "classic", ("table2",)),
    Witness("planar", "planar2r_classic", "table", "modified", ("table2_modified", along(x=1))),
    Witness("planar", "planar2r_classic", "numbers", "classic", ("T2",)),
    Witness("planar", "planar2r_classic", "formula", "classic", ("T2_sym",)),
    Witness("planar", "planar2r_classic", "formula", "modified", ("T2_modified", along(x=1))),
    Witness("planar", "planar2r_modified", "numbers", "classic", (1, 2, "E2")),
    Witness("planar", "planar3r_classic", "table", "classic", ("table3",)),
    Witness("planar", "planar3r_classic", "table", "modified", ("table3_modified", along(x=1))),
    Witness("planar", "planar3r_classic", "numbers", "classic", ("T3",)),
    Witness("planar", "planar3r_classic", "numbers", "modified", ("T3_with_tool",)),
    Witness("planar", "planar3r_classic", "formula", "classic", ("T3_sym",)),
    Witness("planar", "planar3r_classic", "function", "modified", (*every("link3", 3), along(x=1))),
    Witness("quickshot", "quickshot_classic", "frames", "classic", ("frames",)),
    Witness("quickshot", "quickshot_classic", "table", "classic", ("table",)),
    Witness("quickshot", "quickshot_classic", "numbers", "classic", ("T4",)),
    Witness("quickshot", "quickshot_classic", "numbers", "classic", ("A1", "A2", "A3", "A4")),
    Witness("quickshot", "quickshot_classic", "formula", "classic", ("T4_sym",)),
    Witness("quickshot", "quickshot_classic", "formula", "classic", ("A1_sym", "A2_sym", "A3_sym", "A4_sym")),
    Witness("quickshot", "quickshot_classic", "function", "classic", every("link", 4)),
    Witness("puma560", "puma560_craig_modified", "frames", "modified", ("frames",)),
    Witness("puma560", "puma560_craig_modified", "table", "modified", ("table",)),
    Witness("puma560", "puma560_craig_classic", "table", "classic", ("classic_table",)),
    Witness("puma560", "puma560_craig_modified", "numbers", "modified", ("T6",)),
    Witness("puma560", "puma560_craig_modified", "formula", "modified", ("T06",)),
    Witness("puma560", "puma560_craig_modified", "formula", "modified", ("T03", "T36")),
    Witness("puma560", "puma560_craig_modified", "formula", "modified", ("A1", "A2", "A3", "A4", "A5", "A6")),
    Witness("puma560", "puma560_craig_modified", "function", "modified", every("link", 6)),
    Witness("pa10_7c", "pa10_7c_A_classic", "frames", "classic", ("frames",)),
    Witness("pa10_7c", "pa10_7c_A_classic", "table", "classic", ("table",)),
    Witness("pa10_7c", "pa10_7c_A_modified", "table", "modified", ("modified_table",)),
    Witness("pa10_7c", "pa10_7c_A_classic", "numbers", "classic", ("T7",)),
    Witness("pa10_7c", "pa10_7c_A_classic", "formula", "classic", ("T04", 5, 6, 7)),
    Witness("pa10_7c", "pa10_7c_A_classic", "function", "classic", every("link", 7)),
    Witness("pa10_6c", "pa10_6c_A_classic", "frames", "classic", ("frames",)),
    Witness("pa10_6c", "pa10_6c_A_classic", "table", "classic", ("table",)),
    Witness("pa10_6c", "pa10_6c_A_modified", "table", "modified", ("modified_table",)),
    Witness("pa10_6c", "pa10_6c_A_classic", "numbers", "classic", ("T6",)),
    Witness("pa10_6c", "pa10_6c_A_classic", "formula", "classic", (1, "A2", "A3", 4, 5, 6)),
    Witness("pa10_6c", "pa10_6c_A_classic", "function", "classic", every("link", 6)),
    Witness("stanford", "stanford_classic", "frames", "classic", ("frames",)),
    Witness("stanford", "stanford_classic", "table", "classic", ("table",)),
    Witness("stanford", "stanford_modified", "table", "modified", ("modified_table",)),
    Witness("stanford", "stanford_classic", "numbers", "classic", ("T6",)),
    Witness("stanford", "stanford_classic", "formula", "classic", ("T03", 4, 5, 6)),
    Witness("stanford", "stanford_classic", "formula", "classic", (1, 2, "A3", 4, 5, 6)),
    Witness("stanford", "stanford_modified", "formula", "modified", (1, 2, "A3_modified", 4, 5, 6)),
    Witness("stanford", "stanford_classic", "function", "classic", every("link", 6)),
    Witness("scara", "scara_cobra600_classic", "frames", "classic", ("frames",)),
    Witness("scara", "scara_cobra600_classic", "table", "classic", ("table",)),
    Witness("scara", "scara_cobra600_classic", "table", "modified", ("modified_table",)),
    Witness("scara", "scara_cobra600_classic", "numbers", "classic", ("T4",)),
    Witness("scara", "scara_cobra600_classic", "formula", "classic", ("T04",)),
    Witness("scara", "scara_cobra600_classic", "formula", "classic", (1, "A2", 3, 4)),
    Witness("scara", "scara_cobra600_classic", "function", "modified", every("link", 4)),
    Witness("same_arm", "puma560_fgl_classic", "table", "modified", ("table",)),
    Witness("same_arm", "planar3r_classic", "numbers", "classic", (1, 2, 3, along(x=0.05 - 1), "H")),
    Witness("same_arm", "planar3r_classic", "function", "classic", ("to_C",)),
    Witness("same_arm", "planar3r_classic", "function", "classic", ("to_D",)),
    Witness("same_arm", "stanford_classic", "function", "classic", ("to_stanford",)),
    Witness("same_arm", "puma560_craig_classic", "function", "classic", ("to_P",)),
    Witness("same_arm", "puma560_craig_classic", "function", "classic", ("to_Q",)),
    Witness("same_arm", "puma560_craig_classic", "function", "classic", ("to_R",)),
]
#: Exercises whose arms the witness does not have: their references have witnesses of their own, in test_references_*.
OWN_ARMS = {
    "transforms": "no arm: single steps and poses",
    "one_link": "one link with parameters of its own",
    "convert": "the arms W and V and tables without a heading, of this exercise",
    "axes_to_table": "the arms K and U, of this exercise",
}
#: Kinds that lead to no pose of the last frame of an arm of the witness.
NO_POSE = {
    ("scara", "formula", "modified"): "A3_modified alone; the witness has no modified table of this arm, and "
    "test_references_arms multiplies it out by hand",
}
#: Numbers of an exercise as the witness has them, where the page has others.
AS_THE_WITNESS = {
    "planar": {"lengths": (1, 1, 1)},
    "same_arm": {"links": (1, 1, 1), "puma": (0.4318, 0.0203, 0.15005, 0.4318)},
}
#: A step between two frames, which is asked for without the arm before it.
STEPS_ALONE = {"E2", "H"}
FORMS = {Numbers: "numbers", Formula: "formula", Function: "function", Table: "table", Frames: "frames"}


def asked(name):
    """What an exercise asks, with the lengths of the witness."""
    module = load_module(ROOT / "exercises" / f"{name}.py")
    return module.exercise(replace(module.DEFAULT, **AS_THE_WITNESS.get(name, {})))


def kind_of(part):
    """The form of a part and the convention that its reference is in; None for choices and for what is no pose."""
    kind = FORMS.get(type(part.asks))
    if kind is None or (kind not in ("table", "frames") and part.asks.shape != (4, 4) and not part.asks.means):
        return None
    return kind, part.convention if kind in ("table", "frames") else part.chain.convention


def product_of_steps(rows, convention, q):
    """Rows theta, d, a, alpha and kind, multiplied out by hand."""
    T = np.eye(4)
    for (theta, d, a, alpha, kind), value in zip(rows, q, strict=True):
        theta, d = (theta + value, d) if kind == "R" else (theta, d + value)
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
        joint = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])
        link = np.array([[1, 0, 0, a], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1]])
        T = T @ joint @ link if convention == "classic" else T @ link @ joint
    return T


def rows_of(chain):
    return [tuple(float(x) for x in (j.theta, j.d, j.a, j.alpha)) + (j.kind,) for j in chain.joints]


def witness_rows(entry):
    return [
        (
            (row["theta_offset"], row["d"], row["a"], row["alpha"], "R")
            if row["joint"] == "R"
            else (row["theta"], row["d_offset"], row["a"], row["alpha"], "P")
        )
        for row in ROBOTS[entry]["dh"]
    ]


def told(witness, exercise, q, change):
    """The pose of the last frame by the references; `change` makes another arm or other values."""
    entry = ROBOTS[witness.entry]
    for factor in witness.way:
        if isinstance(factor, np.ndarray):
            yield factor
        elif isinstance(factor, int):
            yield product_of_steps(
                witness_rows(witness.entry)[factor - 1 : factor], entry["convention"], [q[factor - 1]]
            )
        else:
            name, *number = factor if isinstance(factor, tuple) else (factor,)
            part = exercise.part(name)
            if witness.kind in ("table", "frames"):
                chain = part.chain.to_modified() if part.convention == "modified" else part.chain.to_classic()
                chain = change(Chain(chain.joints, chain.convention))
                yield (
                    product_of_steps(rows_of(chain), chain.convention, q)
                    if witness.kind == "table"
                    else chain.frames(q)[-1]
                )
            elif getattr(part.asks, "means", None):  # joint values of another table of the same arm
                yield part.asks.means(change(np.asarray(part.asks.quantity(part.chain, q), dtype=float)))
            else:
                yield np.asarray(part.asks.quantity(change(part.chain), *number, q), dtype=float)


def off(witness, exercise, change=lambda chain: chain):
    """How far the references are off the poses of the witness, at most."""
    cases = [(np.array(case["q"]), np.array(case["T"])) for case in ROBOTS[witness.entry]["cases"]]
    return max(np.abs(reduce(np.matmul, told(witness, exercise, q, change)) - T).max() for q, T in cases)


def changes(chain, links):
    """The arm of a reference with one sign changed, for each number that has one and is in the reference."""
    for i in links:
        joint = chain.joints[i - 1]
        for name in ("a", "alpha", "d", "theta"):
            if name == ("theta" if joint.kind == "R" else "d") and joint.offset == 0:
                continue
            value = float(getattr(joint, name))
            if abs(value) > 1e-9 and abs(abs(value) - np.pi) > 1e-9:
                yield f"{name}{i}", lambda own, i=i, name=name, value=value: altered(own, i, **{name: -value})


def signs_of_values(entry):
    """Joint values with one sign changed, for each joint that the witness moves."""
    joints = np.array([case["q"] for case in ROBOTS[entry]["cases"]])
    n = joints.shape[1]
    for i in np.flatnonzero(np.abs(np.sin(joints)).max(axis=0) > FAR):
        yield f"q{i + 1}", lambda values, i=i: np.where(np.arange(n) == i, -values, values)


def first_part(witness, exercise):
    names = [factor[0] if isinstance(factor, tuple) else factor for factor in witness.way]
    return exercise.part(next(name for name in names if isinstance(name, str)))


@pytest.fixture(scope="module", params=WITNESSES, ids=str)
def witness(request):
    return request.param


def test_the_reference_leads_to_the_pose_of_the_witness(witness):
    exercise = asked(witness.exercise)
    assert kind_of(first_part(witness, exercise)) == (witness.kind, witness.convention)
    assert off(witness, exercise) < NEAR


def test_one_sign_changed_does_not(witness):
    """Negative control, sign by sign: each is seen by itself."""
    exercise = asked(witness.exercise)
    part = first_part(witness, exercise)
    if part.id in STEPS_ALONE:
        (step,) = told(replace(witness, way=(part.id,)), exercise, [], lambda chain: chain)
        back = replace(witness, way=(*witness.way[:-1], np.linalg.inv(step)))
        assert off(back, exercise) > FAR
        return
    chain = part.chain
    if witness.kind in ("table", "frames"):
        chain = chain.to_modified() if part.convention == "modified" else chain.to_classic()
    changed = signs_of_values(witness.entry) if getattr(part.asks, "means", None) else changes(chain, witness.links)
    seen = {what: off(witness, exercise, change) > FAR for what, change in changed}
    assert seen
    assert [what for what, found in seen.items() if not found] == []


def lacking(witnesses, names=NAMES):
    """The kinds of references, of arms that the witness has, without a witness."""
    there = {(witness.exercise, witness.kind, witness.convention) for witness in witnesses}
    needed = {
        (name, *kind) for name in names if name not in OWN_ARMS for part in asked(name).parts if (kind := kind_of(part))
    }
    return needed - there - set(NO_POSE)


def test_every_kind_of_every_arm_has_a_witness():
    assert lacking(WITNESSES) == set()
    needless = [kind for kind in NO_POSE if kind in {(w.exercise, w.kind, w.convention) for w in WITNESSES}]
    assert needless == []
    assert set(OWN_ARMS) | {witness.exercise for witness in WITNESSES} == set(NAMES)


def test_a_kind_without_a_witness_would_be_seen():
    for witness in WITNESSES:
        others = [each for each in WITNESSES if str(each).rpartition("-")[0] != str(witness).rpartition("-")[0]]
        assert lacking(others, [witness.exercise]) == {(witness.exercise, witness.kind, witness.convention)}


@pytest.mark.parametrize("name", sorted(OWN_ARMS))
def test_an_arm_that_the_witness_has_is_not_left_out(name):
    """The exception holds for arms of the exercise's own alone: none of its chains has the rows of the witness."""
    known = [witness_rows(entry) for entry in ROBOTS]
    for part in load_exercise(name, ROOT / "exercises").parts:
        for chain in (part.chain.to_classic(), part.chain.to_modified()):
            rows = rows_of(chain)
            for entry in known:
                same = [row[4] for row in rows] == [row[4] for row in entry] and np.allclose(
                    [row[:4] for row in rows], [row[:4] for row in entry]
                )
                assert not same, part.id
