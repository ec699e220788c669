"""The references of the first exercises have an outside witness too: an error in dhlib cannot grade itself right."""

import json
from functools import reduce
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from dhlib import Chain, Revolute
from dhlib.grading.exercise import load_exercise
from dhlib.mechanism import same_mechanism

ROOT = Path(__file__).parents[2]
WITNESS = json.loads((ROOT / "tests" / "dhlib" / "fk_cases.json").read_text(encoding="utf-8"))["robots"]


def part_of(name, part_id):
    part = load_exercise(name, ROOT / "exercises").part(part_id)
    return lambda *probe: np.asarray(part.asks.quantity(part.chain, *probe), dtype=float)


def cases(convention):
    """Rows (theta, d, a, alpha) at some q, base, tool and the pose of the witness, for every arm of a convention."""
    for name, robot in WITNESS.items():
        if robot["convention"] == convention:
            for case in robot["cases"]:
                rows = []
                for row, q in zip(robot["dh"], case["q"], strict=True):
                    theta, d = row.get("theta_offset", row.get("theta", 0.0)), row.get("d", 0.0)
                    theta, d = (theta + q, d) if row["joint"] == "R" else (row.get("theta", 0.0), q)
                    rows.append((theta, d, row["a"], row["alpha"]))
                yield name, rows, np.array(robot["base"]), np.array(robot["tool"]), np.array(case["T"])


def furthest(link, convention):
    """How far products of links are from the witness, over every arm."""
    return max(
        np.abs(reduce(np.matmul, (link(*row) for row in rows), base) @ tool - T).max() / max(1, np.abs(T).max())
        for _, rows, base, tool, T in cases(convention)
    )


@pytest.fixture
def atomic():
    return {name: part_of("transforms", f"{name}_sym") for name in ("Rz", "Tz", "Tx", "Rx")}


def test_the_atomic_matrices_multiply_to_every_arm_of_the_witness(atomic):
    Rz, Tz, Tx, Rx = (atomic[name] for name in ("Rz", "Tz", "Tx", "Rx"))
    assert furthest(lambda t, d, a, alpha: Rz([t]) @ Tz([d]) @ Tx([a]) @ Rx([alpha]), "classic") < 1e-9
    assert furthest(lambda t, d, a, alpha: Rx([alpha]) @ Tx([a]) @ Rz([t]) @ Tz([d]), "modified") < 1e-9


def test_a_wrong_atomic_matrix_would_be_seen(atomic):
    """Negative control: each of the four, the wrong way."""
    for name in atomic:
        Rz, Tz, Tx, Rx = ((lambda q, f=f, s=-1 if n == name else 1: f([s * q[0]])) for n, f in atomic.items())
        assert furthest(lambda t, d, a, alpha: Rz([t]) @ Tz([d]) @ Tx([a]) @ Rx([alpha]), "classic") > 0.1  # noqa: B023


def test_inverses_undo_the_poses_of_the_witness():
    invert = part_of("transforms", "invert")
    for convention in ("classic", "modified"):
        for *_, T in cases(convention):
            assert np.abs(invert(T) @ T - np.eye(4)).max() < 1e-9
            assert np.abs(invert(T).T @ T - np.eye(4)).max() > 1e-3 or np.abs(T - np.eye(4)).max() < 1e-9


def test_the_page_of_the_transforms_by_hand():
    """Numbers worked out without dhlib."""
    c, s = np.cos(np.deg2rad(40)), np.sin(np.deg2rad(40))
    by_hand = {
        "go_turn": [[c, -s, 0, 300], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
        "turn_go": [[c, -s, 0, 300 * c], [s, c, 0, 300 * s], [0, 0, 1, 0], [0, 0, 0, 1]],
        "fixed": [[c, 0, s, 300], [s, 0, -c, 0], [0, 1, 0, 0], [0, 0, 0, 1]],
        "normal": [2 / 3, 1 / 3, 2 / 3],
        "tip": [458.4, -201.2, 212],
        "hand_back": [[0.8, 0.6, 0, -246], [0.36, -0.48, 0.8, -431.2], [0.48, -0.64, -0.6, -141.6], [0, 0, 0, 1]],
    }
    for part, value in by_hand.items():
        assert np.abs(part_of("transforms", part)(()) - value).max() < 1e-9, part
    hand, cube = np.linalg.inv(by_hand["hand_back"]), part_of("transforms", "cube_in_hand")(())
    assert np.allclose((hand @ cube)[:3, 3], [450, -50, 50])


def test_links_multiply_to_every_arm_of_the_witness():
    A, B = (part_of("one_link", f"{name}_sym") for name in "AB")
    by_classic, by_modified = (part_of("one_link", f"{name}_link") for name in ("classic", "modified"))
    assert furthest(by_classic, "classic") < 1e-9
    assert furthest(lambda *row: A(row), "classic") < 1e-9
    assert furthest(lambda t, d, a, alpha: by_modified(alpha, a, t, d), "modified") < 1e-9
    assert furthest(lambda t, d, a, alpha: B((alpha, a, t, d)), "modified") < 1e-9


def test_a_link_of_the_other_convention_would_be_seen():
    """Negative control."""
    by_classic, by_modified = (part_of("one_link", f"{name}_link") for name in ("classic", "modified"))
    assert furthest(by_classic, "modified") > 0.1
    assert furthest(lambda t, d, a, alpha: by_modified(alpha, a, t, d), "classic") > 0.1


def test_the_mended_origin_is_that_of_the_modified_link():
    origin, by_modified = part_of("one_link", "origin"), part_of("one_link", "modified_link")
    row = (0.3, -0.8, 1.1, 0.6)
    assert np.allclose(origin(row), [-0.8, -0.6 * np.sin(0.3), 0.6 * np.cos(0.3)])
    assert np.allclose(origin(row), by_modified(*row)[:3, 3])


def test_the_orders_are_the_five_of_the_book():
    five = {"Rz Tz Tx Rx", "Rz Tz Rx Tx", "Rz Tx Tz Rx", "Tz Rz Tx Rx", "Tz Rz Rx Tx"}
    orders = [" ".join(order) for order in permutations(["Rz", "Tz", "Tx", "Rx"])]
    assert [float(order in five) for order in orders] == part_of("one_link", "obeys")(()).tolist()


def test_the_page_of_one_link_shows_what_is_marked():
    """The matrices that the page prints, rounded, are those that the answers come from."""
    notebook = json.loads((ROOT / "solutions" / "one_link.ipynb").read_text(encoding="utf-8"))
    shown = {"np": np}
    for cell in notebook["cells"]:
        if cell["id"] in ("given-link", "given-frames"):
            exec("".join(cell["source"]), shown)  # our own notebook
    theta, alpha = part_of("one_link", "angles")(())
    d, a = part_of("one_link", "lengths")(())
    by_classic = part_of("one_link", "classic_link")
    assert np.abs(by_classic(theta, d, a, alpha) - shown["A"]).max() < 6e-5
    tilted, pushed = shown["F3"], shown["F2"]
    assert abs(np.rad2deg(np.arcsin(tilted[2, 0])) - part_of("one_link", "tilt")(())) < 0.005
    miss = abs(pushed[1, 0] * pushed[0, 3] - pushed[0, 0] * pushed[1, 3])
    assert abs(miss - part_of("one_link", "miss")(())) < 0.01
    holds = {
        str(k): (abs(F[2, 0]) < 1e-3, abs(F[1, 0] * F[0, 3] - F[0, 0] * F[1, 3]) < 0.1)
        for k, F in shown.items()
        if k[0] == "F"
    }
    assert holds == {"F1": (True, True), "F2": (True, False), "F3": (False, True), "F4": (False, False)}


def test_the_orders_are_counted_in_symbols():
    """Eight different matrices, by algebra and without dhlib."""
    t, d, a, al = sp.symbols("t d a al", real=True)
    turn_z = sp.Matrix([[sp.cos(t), -sp.sin(t), 0, 0], [sp.sin(t), sp.cos(t), 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    turn_x = sp.Matrix([[1, 0, 0, 0], [0, sp.cos(al), -sp.sin(al), 0], [0, sp.sin(al), sp.cos(al), 0], [0, 0, 0, 1]])
    slide_z, slide_x = (sp.eye(4).copy() for _ in range(2))
    slide_z[2, 3], slide_x[0, 3] = d, a
    made = {
        sp.ImmutableMatrix((A * B * C * D).expand()) for A, B, C, D in permutations([turn_z, slide_z, slide_x, turn_x])
    }
    assert len(made) == part_of("one_link", "products")(())


# Planar arms: the witness has links of length 1; with those of the page the same is worked out by hand.


def planar_witness(n, convention):
    robot = WITNESS.get(f"planar{n}r_{convention}")
    joints = [Revolute(a=row["a"], alpha=row["alpha"], d=row["d"], offset=row["theta_offset"]) for row in robot["dh"]]
    return Chain(joints, convention), np.array(robot["tool"]), [(c["q"], np.array(c["T"])) for c in robot["cases"]]


@pytest.mark.parametrize(("part_id", "n"), [("T2", 2), ("T2_sym", 2), ("T3", 3), ("T3_sym", 3)])
def test_planar_products_agree_with_the_witness(part_id, n):
    quantity = load_exercise("planar", ROOT / "exercises").part(part_id).asks.quantity
    chain, tool, poses = planar_witness(n, "classic")
    for q, T in poses:
        assert np.abs(quantity(chain, q) @ tool - T).max() < 1e-12
    bent = next(q for q, _ in poses if np.abs(np.sin(q)).min() > 0.1)
    other = Chain(chain.joints, "modified")  # negative control
    assert np.abs(quantity(other, bent) - quantity(chain, bent)).max() > 0.1


def test_modified_planar_products_agree_with_the_witness():
    quantity = load_exercise("planar", ROOT / "exercises").part("T2_modified").asks.quantity
    chain, tool, poses = planar_witness(2, "modified")
    for q, T in poses:
        assert np.abs(quantity(chain, q) @ tool - T).max() < 1e-12
        assert np.abs(quantity(chain, q) - T).max() > 0.1  # negative control: without the tool


def by_hand(q, lengths):
    turned = np.cumsum(q)
    T = np.eye(4)
    T[0, :2], T[1, :2] = [np.cos(turned[-1]), -np.sin(turned[-1])], [np.sin(turned[-1]), np.cos(turned[-1])]
    T[:2, 3] = np.cos(turned) @ lengths, np.sin(turned) @ lengths
    return T


def test_the_lengths_of_the_planar_page():
    for n in (2, 3):  # the way by hand has the same witness
        for q, T in planar_witness(n, "classic")[2]:
            assert np.abs(by_hand(q, np.ones(n)) - T).max() < 1e-12
    q = np.deg2rad([35, -70, 50])
    right = {"T2": by_hand(q[:2], [260, 190]), "T3": by_hand(q, [260, 190, 110])}
    assert np.allclose(part_of("planar", "T2")(q[:2]), right["T2"])
    assert np.allclose(part_of("planar", "T3")(q), right["T3"])
    assert np.allclose(part_of("planar", "T3_with_tool")(q), right["T3"])
    assert np.allclose(part_of("planar", "T2_modified")(q[:2]) @ part_of("planar", "E2")(()), right["T2"])
    link = part_of("planar", "link3")
    hand = np.eye(4)
    hand[0, 3] = 110
    assert np.allclose(np.linalg.multi_dot([*(link(i, q) for i in (1, 2, 3)), hand]), right["T3"])
    exercise = load_exercise("planar", ROOT / "exercises")
    for part_id, lengths in {"table2": [260, 190], "table3": [260, 190, 110]}.items():
        drawn = Chain([Revolute(a=length) for length in lengths], "classic")
        assert same_mechanism(drawn, exercise.part(part_id).chain, free=())
        exchanged = Chain([Revolute(a=length) for length in lengths[::-1]], "classic")
        assert not same_mechanism(exchanged, exercise.part(part_id).chain)  # negative control
