"""References of the exercise on converting, against poses of other programs, and by matrices of this test."""

import json
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import load_exercise
from dhlib.grading.marking import mark
from dhlib.mechanism import same_mechanism

ROOT = Path(__file__).parents[2]
WITNESS = json.loads((ROOT / "tests" / "dhlib" / "fk_cases.json").read_text(encoding="utf-8"))["robots"]


@pytest.fixture(scope="module")
def convert():
    return load_exercise("convert", ROOT / "exercises")


@pytest.fixture(scope="module")
def page():
    """What the page gives."""
    notebook = json.loads((ROOT / "solutions" / "convert.ipynb").read_text(encoding="utf-8"))
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code" and cell["metadata"]["dh"]["role"] in ("setup", "given"):
            exec("".join(cell["source"]), names)  # our own notebook
    return names


def turn_z(t):
    return np.array([[np.cos(t), -np.sin(t), 0, 0], [np.sin(t), np.cos(t), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def turn_x(t):
    return np.array([[1, 0, 0, 0], [0, np.cos(t), -np.sin(t), 0], [0, np.sin(t), np.cos(t), 0], [0, 0, 0, 1]])


def move(x, z):
    T = np.eye(4)
    T[:3, 3] = x, 0, z
    return T


def joint(theta, d):
    return turn_z(theta) @ move(0, d)


def link(a, alpha):
    return move(a, 0) @ turn_x(alpha)


def classic_product(rows):
    return reduce(np.matmul, [joint(theta, d) @ link(a, alpha) for theta, d, a, alpha in rows])


def modified_product(rows):
    return reduce(np.matmul, [link(a, alpha) @ joint(theta, d) for alpha, a, theta, d in rows])


def with_values(rows, q):
    """Rows of the page with numbers for their letters."""
    return [[q[int(e[1]) - 1] if isinstance(e, str) else float(e) for e in row] for row in rows]


def witness_rows(name, q):
    """Rows theta, d, a, alpha of the witness at q, in its own convention."""
    for row, value in zip(WITNESS[name]["dh"], q, strict=True):
        turns = row["joint"] == "R"
        theta = row["theta_offset"] + value if turns else row["theta"]
        yield [theta, row["d"] if turns else row["d_offset"] + value, row["a"], row["alpha"]]


def value(exercise, part, *probe):
    asked = exercise.part(part)
    return np.asarray(asked.asks.quantity(asked.chain, *probe), dtype=float)


@pytest.mark.parametrize("name", [name for name, robot in WITNESS.items() if robot["convention"] == "classic"])
def test_a_classic_table_of_the_witness_is_converted(convert, name):
    for case in WITNESS[name]["cases"]:
        rows = np.array(list(witness_rows(name, case["q"])))
        converted = value(convert, "to_modified", rows)
        left_over = link(*rows[-1, 2:])
        assert np.abs(modified_product(converted) @ left_over @ WITNESS[name]["tool"] - case["T"]).max() < 1e-9
        there_and_back = value(convert, "to_classic", converted)
        assert np.abs(there_and_back[:-1] - rows[:-1]).max() < 1e-12


@pytest.mark.parametrize("name", [name for name, robot in WITNESS.items() if robot["convention"] == "modified"])
def test_a_modified_table_of_the_witness_is_converted(convert, name):
    for case in WITNESS[name]["cases"]:
        rows = np.array(list(witness_rows(name, case["q"])))[:, [3, 2, 0, 1]]
        converted = value(convert, "to_classic", rows)
        left_over = link(rows[0, 1], rows[0, 0])
        assert np.abs(left_over @ classic_product(converted) @ WITNESS[name]["tool"] - case["T"]).max() < 1e-9


def test_every_wrong_conversion_would_be_seen(convert):
    """Negative control: none of the traps reproduces the PUMA of the witness."""
    case = max(WITNESS["puma560_corke_classic"]["cases"], key=lambda case: np.abs(np.sin(case["q"])).min())
    rows = np.array(list(witness_rows("puma560_corke_classic", case["q"])))
    for trap in convert.part("to_modified").traps[:2]:
        wrong = modified_product(np.asarray(trap.quantity(None, rows), dtype=float))
        assert np.abs(wrong - case["T"]).max() > 1e-2, trap.says


def test_tables_and_ends_by_hand(convert, page):
    """The answers, put together to the pose of the arm of the page."""
    q = np.array([0.4, -1.1, 0.7, 2.0])
    W, V, E, Z = (page[name] for name in "WVEZ")
    tables = {part: convert.part(part).chain for part in ("modified_table", "classic_table")}
    tool, base = value(convert, "tool", ()), value(convert, "base", ())
    pose = classic_product(with_values(W, q)) @ E
    assert np.abs(tables["modified_table"].fk(q) @ tool - pose).max() < 1e-9
    assert np.abs(tables["modified_table"].fk(q) @ E - pose).max() > 1
    pose = Z @ modified_product(with_values(V, q))
    assert np.abs(base @ tables["classic_table"].fk(q) - pose).max() < 1e-9
    assert np.abs(Z @ tables["classic_table"].fk(q) - pose).max() > 1


def test_frames_2_by_hand(convert, page):
    rows = with_values(page["W"], [0.4, -1.1, 0.7, 2.0])
    classic_2 = classic_product(rows[:2])
    modified_2 = classic_product(rows[:1]) @ joint(*rows[1][:2])
    assert np.abs(modified_2 @ value(convert, "between", ()) - classic_2).max() < 1e-9
    assert np.abs(classic_2 @ value(convert, "between", ()) - modified_2).max() > 1
    assert np.allclose(classic_2[:, 0], modified_2[:, 0])
    assert not np.allclose(classic_2[:, 1:], modified_2[:, 1:])


def test_both_readings_by_hand(convert, page):
    q = page["q"]
    rows = np.column_stack([q, page["rows"]])
    assert np.abs(value(convert, "T_classic", q) - classic_product(rows)).max() < 1e-9
    assert np.abs(value(convert, "T_modified", q) - modified_product(rows[:, [3, 2, 0, 1]])).max() < 1e-9
    measured = page["p_measured"]
    assert np.abs(value(convert, "T_modified", q)[:3, 3] - measured).max() < 0.05
    assert np.abs(value(convert, "T_classic", q)[:3, 3] - measured).max() > 10


def test_tables_in_the_other_convention_are_told(convert, page):
    """The rows of the page, handed in as they are: in the order of the columns asked for, and not moved."""
    for part, rows, order in (("modified_table", page["W"], (3, 2, 0, 1)), ("classic_table", page["V"], (2, 3, 1, 0))):
        asked = convert.part(part)
        got = mark(asked, read_answer(asked.asks.request(), [[row[k] for k in order] for row in rows]))
        assert not got.passed
        assert got.misconception == "row", got
        assert "still in the row where they were" in got.message
        assert not same_mechanism(asked.chain, convert.arm)
