"""The references of the first exercises have an outside witness too: an error in dhlib cannot grade itself right."""

import json
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from dhlib.grading.exercise import load_exercise

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
