"""References of the exercise on axes and tables, against files, matrices and programs that know nothing of them."""

import io
import json
from pathlib import Path

import numpy as np
import pytest
from yourdfpy import URDF

from dhlib import robots
from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import load_exercise
from dhlib.grading.forms import Frames, Table
from dhlib.grading.marking import mark
from dhlib.grading.retelling import altered
from dhlib.mechanism import same_mechanism

ROOT = Path(__file__).parents[2]
WITNESS = json.loads((ROOT / "tests" / "dhlib" / "fk_cases.json").read_text(encoding="utf-8"))["robots"]
RANDOM = np.random.default_rng(3)


@pytest.fixture(scope="module")
def exercise():
    return load_exercise("axes_to_table", ROOT / "exercises")


@pytest.fixture(scope="module")
def given():
    """What the page gives."""
    notebook = json.loads((ROOT / "solutions" / "axes_to_table.ipynb").read_text(encoding="utf-8"))
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code" and cell["metadata"]["dh"]["role"] in ("setup", "given"):
            exec("".join(cell["source"]), names)  # our own notebook
    return names


@pytest.fixture(scope="module")
def file(given):
    return URDF.load(io.StringIO(given["urdf"]), load_meshes=False, build_scene_graph=True)


def right(exercise, part):
    part = exercise.part(part)
    return part.asks.values(part.chain)


def screw(point, direction, angle):
    """The motion about a line, as the exponential of its twist, by its series."""
    u = np.asarray(direction, dtype=float)
    twist = np.zeros((4, 4))
    twist[:3, :3] = [[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]]
    twist[:3, 3] = np.cross(point, u)
    term, total = np.eye(4), np.eye(4)
    for k in range(1, 40):
        term = term @ twist * angle / k
        total = total + term
    return total


def hand_of_k(given, q):
    x, z = np.array([0.28, 0, -0.96]), np.array(given["axes"][4][1])
    M = np.eye(4)
    M[:3] = np.column_stack([x, np.cross(z, x), z, given["O5"]])
    return np.linalg.multi_dot([*(screw(*line, angle) for line, angle in zip(given["axes"], q, strict=True)), M])


def test_k_moves_as_its_axes_do(exercise, given):
    (q,) = exercise.part("T5").asks.probes[0]
    assert np.abs(right(exercise, "T5")[0] - hand_of_k(given, q)).max() < 1e-9
    for part in ("table", "modified_table", "frames"):
        chain = exercise.part(part).chain
        for q in RANDOM.uniform(-3, 3, (10, 5)):
            assert np.abs(chain.fk(q) - hand_of_k(given, q)).max() < 1e-9
            wrong = altered(chain, 3, alpha=lambda joint: joint.alpha + 0.1)
            assert np.abs(wrong.fk(q) - hand_of_k(given, q)).max() > 1


def test_frames_are_those_of_k(exercise, given):
    part = exercise.part("frames")
    assert isinstance(part.asks, Frames)
    assert np.abs(part.chain.frames(np.zeros(5))[-1] - hand_of_k(given, np.zeros(5))).max() < 1e-9


def test_the_lines_and_the_end_are_those_of_the_file(exercise, file):
    """By a reader of URDF that other people wrote."""
    lines = right(exercise, "lines")[0]
    moving = [joint for joint in file.robot.joints if joint.type != "fixed"]
    for row, joint in zip(lines, moving, strict=True):
        pose = file.get_transform(joint.child, "base")
        assert np.abs(row - [*pose[:3, 3], *(pose[:3, :3] @ joint.axis)]).max() < 1e-9
    assert np.abs(right(exercise, "end")[0] - file.get_transform("tool", "base")).max() < 1e-9


def test_the_tables_move_as_the_file_does(exercise, file):
    for part in ("urdf_table", "urdf_modified"):
        chain = exercise.part(part).chain
        for q in RANDOM.uniform(-2, 2, (10, 5)):
            file.update_cfg(q)
            pose = file.get_transform("tool", "base")
            assert np.abs(chain.fk(q) - pose).max() < 1e-9
            assert np.abs(altered(chain, 2, sign=-1).fk(q) - pose).max() > 1e-3
        file.update_cfg(np.zeros(5))


@pytest.mark.parametrize("name", ["puma560_craig_classic", "stanford_classic", "pa10_6c_A_classic"])
def test_the_function_reads_lengths_and_twists_of_the_witness(exercise, name):
    """The axes of a published table, laid out here; sizes, since the senses of its x axes are the table's choice."""
    part = exercise.part("link_of")
    T, poses = np.eye(4), [np.eye(4)]
    rows = WITNESS[name]["dh"]
    for row in rows:
        theta = 0.4 + (row["theta_offset"] if row["joint"] == "R" else row["theta"])
        d = row["d"] if row["joint"] == "R" else 0.3
        c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(row["alpha"]), np.sin(row["alpha"])
        a = row["a"]
        T = T @ [[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]]
        poses.append(T)
    for row, before, after in zip(rows, poses, poses[1:], strict=False):
        a, alpha = part.asks.quantity(part.chain, before[:3, 3], before[:3, 2], after[:3, 3], after[:3, 2])
        assert np.isclose(a, abs(row["a"]))
        assert np.isclose(np.cos(alpha), np.cos(row["alpha"]))
        if row["a"] > 0:
            assert np.isclose(np.sin(alpha), np.sin(row["alpha"]))


def test_what_the_page_gives_is_what_is_marked(exercise, given):
    for k in (1, 2, 3, 4):
        assert tuple(map(tuple, given["pairs"][k].tolist())) in {
            tuple(tuple(map(float, line)) for line in call) for call in exercise.part("link_of").asks.calls[:4]
        }
    chain = exercise.part("table").chain
    for axis, (point, direction) in zip(chain.axes(), given["axes"], strict=True):
        assert np.abs(np.cross(axis.direction, direction)).max() < 1e-12
        assert axis.direction @ direction > 0
        assert np.abs(np.cross(axis.point - point, direction)).max() < 1e-9


def test_any_point_of_a_line_is_right_and_no_other(exercise):
    part = exercise.part("lines")
    lines = right(exercise, "lines")[0]
    along = lines.copy()
    along[:, :3] += [[t] for t in (1, -2, 0.3, 4, 5)] * lines[:, 3:]
    along[:, 3:] *= 7
    along[3, :3] = [9, 9, 9]  # a slide stands anywhere
    assert mark(part, read_answer(part.asks.request(), along)).passed
    along[1, :3] += [0.05, 0, 0]
    assert mark(part, read_answer(part.asks.request(), along)).message == "Line 2 is not right yet."


def test_tables_of_other_people_are_right(exercise):
    """Another normal between the parallel axes, another sense, a slide that stands elsewhere."""
    table, file_table = exercise.part("table"), exercise.part("urdf_table")
    for part, changes in ((table, {2: {"d": 10.0}, 3: {"d": -15.0}}), (file_table, {2: {"d": 0.02}, 3: {"d": -0.06}})):
        chain = part.chain
        for i, change in changes.items():
            chain = altered(chain, i, **change)
        assert same_mechanism(chain, part.chain)
        assert mark(part, read_answer(part.asks.request(), chain)).passed
    assert not mark(table, read_answer(table.asks.request(), robots.quickshot())).passed
    assert all(isinstance(part.asks, Table) for part in (table, file_table))


def test_the_depth_of_the_normal_by_hand(exercise):
    far = float(right(exercise, "far")[0])
    assert np.isclose(0.2 - far * np.cos(1.57) / np.sin(1.57), 0)


def test_the_converter_does_what_the_page_says(exercise):
    """Up to frame 2 the origins agree; what comes after does not, and no zero or sense of joint 3 mends it."""
    right_arm = exercise.part("table").chain
    wrong = altered(right_arm, 2, alpha=0.0)
    here, there = right_arm.frames(np.zeros(5)), wrong.frames(np.zeros(5))
    assert np.abs(here[:3, :3, 3] - there[:3, :3, 3]).max() < 1e-9
    assert np.abs(here[3:, :3, 3] - there[3:, :3, 3]).max(axis=1).min() > 20
    assert not same_mechanism(wrong, right_arm, free=("zeros", "senses", "tool"))
