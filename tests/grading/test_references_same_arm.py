"""References of the exercise on tables of the same arm, against poses that other programs computed."""

import json
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from dhlib import Chain
from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import load_exercise
from dhlib.grading.forms import Function
from dhlib.grading.marking import mark
from dhlib.mechanism import same_mechanism

ROOT = Path(__file__).parents[2]
WITNESS = json.loads((ROOT / "tests" / "dhlib" / "fk_cases.json").read_text(encoding="utf-8"))["robots"]
STEPS = ("theta", "d", "a", "alpha")


@pytest.fixture(scope="module")
def same_arm():
    return load_exercise("same_arm", ROOT / "exercises")


@pytest.fixture(scope="module")
def tables():
    """The chains that the page defines."""
    notebook = json.loads((ROOT / "solutions" / "same_arm.ipynb").read_text(encoding="utf-8"))
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code" and cell["metadata"]["dh"]["role"] in ("setup", "given"):
            exec("".join(cell["source"]), names)  # our own notebook
    return names


def classic_product(rows, q, letters):
    """The pose of a classic table, with matrices written out here."""
    T = np.eye(4)
    for (theta, d, a, alpha), value, letter in zip(rows, q, letters, strict=True):
        theta, d = (theta + value, d) if letter == "R" else (theta, d + value)
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
        T = T @ [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
    return T


def rows_of(chain):
    return [[float(getattr(joint, name)) for name in STEPS] for joint in chain.joints]


def test_the_arms_of_the_page_are_those_that_are_marked(same_arm, tables):
    for part, name in {"to_C": "A", "to_stanford": "S", "to_P": "PUMA"}.items():
        assert same_arm.part(part).chain == tables[name]


def test_the_arms_of_the_page_are_those_of_the_witness(tables):
    """Corke's d3 is rounded on the page, and nothing else."""
    for name, witness, rounded in (("S", "stanford_classic", 0), ("PUMA", "puma560_craig_classic", 5e-5)):
        for case in WITNESS[witness]["cases"]:
            mine = classic_product(rows_of(tables[name]), case["q"], tables[name].kinds)
            assert np.abs(mine - case["T"]).max() < rounded + 1e-9


TRANSLATED = {"to_C": ("A", "C"), "to_D": ("A", "D"), "to_stanford": ("S", "G")} | {
    f"to_{name}": ("PUMA", name) for name in "PQR"
}


@pytest.mark.parametrize("part", TRANSLATED)
def test_translated_joint_values_lead_to_the_same_pose(same_arm, tables, part):
    """By matrices of this test; with any other half turn or sense they lead elsewhere, but for the wrist's twin."""
    own, other = (tables[name] for name in TRANSLATED[part])
    asked = same_arm.part(part)
    for (q,) in asked.asks.probes:
        to = asked.asks.quantity(asked.chain, q)
        here, there = (classic_product(rows_of(a), v, own.kinds) for a, v in ((own, q), (other, to)))
        assert np.abs(here - there).max() < 1e-9
        for k in range(own.n):
            for wrong in (to + np.pi * np.eye(own.n)[k], to * (1 - 2 * np.eye(own.n)[k])):
                if np.abs(classic_product(rows_of(other), wrong, own.kinds) - here).max() < 1e-6:
                    assert abs(to[k]) < 1e-12


def test_every_translation_is_one_of_the_part(same_arm, tables):
    """The functions are marked by the chains of the page, and accept the twin of the wrist."""
    part = same_arm.part("to_Q")
    for (q,) in part.asks.probes:
        assert np.abs(part.asks.means(np.array(q)) - tables["Q"].fk(q)).max() < 1e-12
    twin = Function(part.asks.quantity, shape=(6,), calls=part.asks.calls, means=part.asks.means)
    answer = read_answer(
        twin.request(), lambda q: np.array(q) * [1, 1, 1, 1, -1, 1] + np.pi * np.array([0, 0, 1, 1, 0, 2])
    )
    assert mark(part, answer).passed
    answer = read_answer(
        twin.request(), lambda q: np.array(q) * [1, 1, 1, 1, -1, 1] + np.pi * np.array([0, 0, 1, 1, 0, 1])
    )
    assert not mark(part, answer).passed


def test_the_hand_of_all_tables(same_arm, tables):
    part = same_arm.part("hand")
    values = {
        "alpha1": -90,
        "alpha3": -90,
        "alpha4": 90,
        "alpha5": -90,
        "a2": 0.4318,
        "a3": 0.0203,
        "d3": 0.15,
        "d4": 0.4318,
    }
    for signs in list(product((1, -1), repeat=8))[::5]:
        table = tables["puma"](**{name: s * v for s, (name, v) in zip(signs, values.items(), strict=True)})
        verdict = same_mechanism(table, tables["PUMA"])
        assert bool(verdict) == (part.asks.quantity(part.chain, signs) == 1)
        assert verdict.mirror == (part.asks.quantity(part.chain, signs) == -1)


def test_choices_are_what_the_library_finds(same_arm, tables):
    pairs = {"exchanged": ("first", "A")} | {f"puma_{k}": (f"table_{k}", "PUMA") for k in (1, 2, 3, 4)}
    for part, (name, reference) in pairs.items():
        verdict = same_mechanism(tables[name], tables[reference])
        found = "same" if verdict else "mirror" if verdict.mirror else "another"
        assert same_arm.part(part).asks.right == found


def test_numbers_by_hand(same_arm, tables):
    q = np.array([0.4, -1.1, 0.6, 0.3, 0.8, -2.0])
    H, d2 = (same_arm.part(name).asks.values(same_arm.part(name).chain)[0] for name in ("H", "d2"))
    assert np.abs(tables["A"].fk(q[:3]) - tables["B"].fk(q[:3]) @ H).max() < 1e-12
    assert np.abs(H @ tables["B"].fk(q[:3]) - tables["A"].fk(q[:3])).max() > 1e-2
    assert np.abs(tables["stanford"](float(d2), 0.02).fk(q) - tables["S"].fk(q)).max() < 1e-12
    assert not same_mechanism(tables["F"], tables["S"])


def test_the_table_is_that_of_the_witness(same_arm):
    part = same_arm.part("table")
    rows = WITNESS["puma560_fgl_classic"]
    for case in rows["cases"]:
        assert np.abs(part.chain.to_modified().fk(case["q"]) - case["T"]).max() < 1e-9
    craig = [
        [0, 0, "q1", 0],
        [-np.pi / 2, 0, "q2", 0],
        [0, 0.4318, "q3", 0.14909],
        [-np.pi / 2, 0.02032, "q4", 0.43307],
        [np.pi / 2, 0, "q5", 0],
        [-np.pi / 2, 0, "q6", 0.05625],
    ]
    assert mark(part, read_answer(part.asks.request(), craig)).passed
    craig[3][1] = -0.02032
    assert mark(part, read_answer(part.asks.request(), craig)).points < part.points / 2
    as_printed = Chain(part.chain.joints, "modified")
    assert not mark(part, read_answer(part.asks.request(), as_printed)).passed
