"""The references have an outside witness: an error in dhlib cannot grade itself right."""

import json
from pathlib import Path

import numpy as np
import pytest

from dhlib import Chain, Revolute
from dhlib.grading.answers import read_answer
from dhlib.grading.forms import Numbers
from dhlib.grading.marking import mark
from dhlib.grading.misconceptions import Valued  # the forms judged by value
from dhlib.mechanism import same_mechanism
from dhlib.transforms import inverse

WITNESS = json.loads((Path(__file__).parents[1] / "dhlib" / "fk_cases.json").read_text(encoding="utf-8"))
QUICKSHOT = WITNESS["robots"]["quickshot_classic"]


@pytest.fixture(scope="module")
def poses():
    return [(np.array(case["q"]), np.array(case["T"])) for case in QUICKSHOT["cases"]]


def product_of(exercise, arm, q):
    """T4 at any q, by the quantity of the exercise itself."""
    return np.asarray(exercise.part("T4").asks.quantity(arm, q), dtype=float)


@pytest.mark.parametrize("part", ["T4", "T4_quarter", "T4_sym"])
def test_products_agree_with_the_witness(exercise, poses, part):
    asked = exercise.part(part)
    for q, T in poses:
        assert np.abs(asked.asks.quantity(asked.chain, q) - T).max() < 1e-9


def test_links_and_functions_multiply_to_the_witness(exercise, poses):
    for q, T in poses:
        for names in (("A1", "A2", "A3", "A4"), ("A1_sym", "A2_sym", "A3_sym", "A4_sym")):
            parts = [exercise.part(name) for name in names]
            assert np.abs(np.linalg.multi_dot([p.asks.quantity(p.chain, q) for p in parts]) - T).max() < 1e-9
        link = exercise.part("link")
        assert (
            np.abs(np.linalg.multi_dot([link.asks.quantity(link.chain, i, q) for i in (1, 2, 3, 4)]) - T).max() < 1e-9
        )


def test_the_entry_agrees_with_the_witness(exercise, poses):
    part = exercise.part("mended")
    for q, T in poses:
        assert abs(part.asks.quantity(part.chain, q) - T[1, 0]) < 1e-12


def test_base_and_tool_by_hand(exercise, poses):
    """Z and E of the page, written down as numbers, around the poses of the witness."""
    Z = np.array([[0, -1, 0, 300], [1, 0, 0, -150], [0, 0, 1, 720], [0, 0, 0, 1]])
    h = np.sqrt(3) / 2
    E = np.array([[0, -h, -0.5, 0], [1, 0, 0, 0], [0, -0.5, h, 90], [0, 0, 0, 1]])
    part = exercise.part("X")
    for q, T in poses:
        assert np.abs(part.asks.quantity(part.chain, q) - Z @ T @ E).max() < 1e-9
    back = exercise.part("T4_back")
    hidden = back.asks.values(back.chain)[0]
    (q,) = back.asks.probes[0]
    assert np.abs(hidden - product_of(exercise, back.chain, q)).max() < 1e-4


def test_the_table_and_the_frames_agree_with_the_witness(exercise, poses):
    rows = QUICKSHOT["dh"]
    witness = Chain([Revolute(d=r["d"], a=r["a"], alpha=r["alpha"], offset=r["theta_offset"]) for r in rows], "classic")
    assert same_mechanism(witness, exercise.part("table").chain, free=())
    part = exercise.part("frames")
    at_zero = [T for q, T in poses if not q.any()]
    assert at_zero
    assert np.abs(part.chain.frames(np.zeros(4))[-1] - at_zero[0]).max() < 1e-9


def test_an_error_in_the_library_would_be_seen(exercise, poses, monkeypatch):
    """Negative control: with a wrong sign in the link matrix the witness disagrees, though the exercise agrees."""
    import dhlib.chain

    def wrong(theta, d, a, alpha):
        return dhlib.conventions.classic(theta, d, a, -np.asarray(alpha, dtype=float).item())

    monkeypatch.setattr(dhlib.chain, "classic", wrong)
    part = exercise.part("T4")
    q, T = next((q, T) for q, T in poses if np.abs(np.sin(q)).min() > 0.1)
    told = part.asks.quantity(part.chain, q)
    assert np.abs(told - T).max() > 1
    own = Numbers(part.asks.quantity, at=tuple(q))
    assert np.abs(own.values(part.chain)[0] - told).max() == 0


def test_the_witness_marks_right_and_its_neighbour_wrong(exercise, poses):
    """The whole way, from an outside answer to a mark."""
    part = exercise.part("X")
    for q, T in poses[:5]:
        asked = Numbers(lambda arm, q: arm.T(0, 4, q), at=tuple(q))
        changed = type(part)("T", "T", 1, asked, arm=part.chain)
        assert mark(changed, read_answer(asked.request(), T)).verdict == "right"
        beside = T @ np.array([[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        assert mark(changed, read_answer(asked.request(), beside)).verdict != "right"


def test_the_slides_have_the_slip_where_the_exercise_says(exercise):
    part = exercise.part("mended")
    printed = part.traps[0].quantity
    q = np.array([0.3, 0.5, 0.7, 0.2])
    column = part.chain.T(0, 4, q)[:3, 0]
    assert np.isclose(column @ column, 1)
    column[1] = printed(part.chain, q)
    assert round(float(column @ column), 3) == 1.124


def test_the_page_gives_the_pose_that_is_marked(exercise, solved):
    back = exercise.part("T4_back")
    right = back.asks.values(back.chain)[0]
    Z, E = exercise.arm.base, exercise.arm.tool
    assert np.abs(solved["Z"] - Z).max() < 1e-12
    assert np.abs(solved["E"] - E).max() < 1e-12
    off = np.abs(inverse(Z) @ solved["X_measured"] @ inverse(E) - right)
    assert off[:3, :3].max() < back.asks.tolerance / 5
    assert off[:3, 3].max() < back.asks.length_tolerance / 5
    assert isinstance(back.asks, Valued)
