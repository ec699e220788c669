"""References of the exercises on whole arms, against poses that other programs computed, part by part."""

import json
from functools import reduce
from pathlib import Path

import numpy as np
import pytest

from dhlib import Chain, Prismatic, Revolute, robots
from dhlib.grading.exercise import load_exercise
from dhlib.grading.forms import Frames, Table
from dhlib.grading.retelling import altered
from dhlib.mechanism import same_mechanism

ROOT = Path(__file__).parents[2]
WITNESS = json.loads((ROOT / "tests" / "dhlib" / "fk_cases.json").read_text(encoding="utf-8"))["robots"]

#: The witness of each exercise.
ARMS = {
    "puma560": "puma560_craig_classic",
    "stanford": "stanford_classic",
    "scara": "scara_cobra600_classic",
    "pa10_6c": "pa10_6c_A_classic",
    "pa10_7c": "pa10_7c_A_classic",
}
#: Parts, each with what it should be of the pose T of the last frame.
WHOLE = {
    "puma560": {
        "T06": lambda T: T,
        "T6": lambda T: T,
        "T6_quarter": lambda T: T,
        "p": lambda T: T[:3, 3],
        "mended_1": lambda T: T[0, 0],
        "mended_2": lambda T: T[1, 0],
    },
    "stanford": {
        "T6": lambda T: T,
        "T6_quarter": lambda T: T,
        "wrist": lambda T: T[:3, 3] - 0.263 * T[:3, 2],
    },
    "pa10_6c": {
        "T6": lambda T: T,
        "T6_quarter": lambda T: T,
        "wrist": lambda T: T[:3, 3] - 0.07 * T[:3, 2],
    },
    "pa10_7c": {"T7": lambda T: T, "T7_quarter": lambda T: T},
    "scara": {"T04": lambda T: T, "T4": lambda T: T, "T4_quarter": lambda T: T},
}
#: Parts whose product should be T.
PRODUCTS = {
    "puma560": [[f"A{i}" for i in range(1, 7)], ["T03", "T36"]],
    "stanford": [],
    "scara": [],
    "pa10_6c": [],
    "pa10_7c": [],
}
#: A function of i and q, whose product over the links should be T.
LINKS = {"puma560": "link", "stanford": "link", "scara": "link", "pa10_6c": "link", "pa10_7c": "link"}
#: Z and E of the page, by hand.
h, r = np.sqrt(3) / 2, np.sqrt(0.5)
ENDS = {
    "puma560": (
        [[0, -1, 0, 0.4], [1, 0, 0, -0.25], [0, 0, 1, 0.66], [0, 0, 0, 1]],
        [[r, -r * h, -r / 2, 0], [r, r * h, r / 2, 0], [0, -0.5, h, 0.16], [0, 0, 0, 1]],
    ),
    "scara": (
        [[0, -1, 0, 0.8], [1, 0, 0, 0.3], [0, 0, 1, 0.5], [0, 0, 0, 1]],
        [[1, 0, 0, 0.04], [0, h, -0.5, 0], [0, 0.5, h, 0.12], [0, 0, 0, 1]],
    ),
}


def with_witness(name):
    """An exercise on a whole arm, and the poses of its witness."""
    poses = [(np.array(case["q"]), np.array(case["T"])) for case in WITNESS[ARMS[name]]["cases"]]
    return load_exercise(name, ROOT / "exercises"), poses


@pytest.fixture(params=sorted(ARMS))
def about(request):
    return with_witness(request.param)


def value(part, chain, *probe):
    return np.asarray(part.asks.quantity(chain, *probe), dtype=float)


def off_by(exercise, q, T, chain):
    """How far every reference of an exercise is off, if its arm is this chain."""

    def told(part_id, *probe):
        part = exercise.part(part_id)
        own = chain.to_modified() if part.chain.convention == "modified" else chain.to_classic()
        return value(part, own, *probe)

    for each, of in WHOLE[exercise.name].items():
        yield each, np.abs(told(each, q) - of(T)).max()
    for names in PRODUCTS[exercise.name]:
        yield "·".join(names), np.abs(reduce(np.matmul, [told(each, q) for each in names]) - T).max()
    link = LINKS[exercise.name]
    yield link, np.abs(reduce(np.matmul, [told(link, i, q) for i in range(1, chain.n + 1)]) - T).max()


def bare(exercise):
    """The arm of the products."""
    return exercise.part(next(iter(WHOLE[exercise.name]))).chain


def test_every_exercise_on_an_arm_of_the_witness_is_here():
    assert set(ARMS) == set(WHOLE) == set(PRODUCTS) == set(LINKS)


def test_references_agree_with_the_witness(about):
    exercise, poses = about
    for q, T in poses:
        for each, off in off_by(exercise, q, T, bare(exercise)):
            assert off < 1e-9, each


def test_a_wrong_arm_would_be_seen(about):
    """Negative control: with other twists every reference disagrees with the witness."""
    exercise, poses = about
    q, T = poses[-1]
    wrong = dict(off_by(exercise, q, T, altered(bare(exercise), alpha=lambda joint: joint.alpha + 0.3)))
    assert min(wrong.values()) > 1e-3, wrong


def test_tables_are_the_mechanism_of_the_witness(about):
    exercise, _ = about
    rows = WITNESS[ARMS[exercise.name]]["dh"]
    joints = [
        Revolute(d=row["d"], a=row["a"], alpha=row["alpha"], offset=row["theta_offset"])
        if row["joint"] == "R"
        else Prismatic(theta=row["theta"], a=row["a"], alpha=row["alpha"], offset=row["d_offset"])
        for row in rows
    ]
    witness = Chain(joints, WITNESS[ARMS[exercise.name]]["convention"])
    parts = [part for part in exercise.parts if isinstance(part.asks, Table)]
    assert {part.asks.convention for part in parts} == {"classic", "modified"}
    for part in parts:
        assert same_mechanism(part.chain, witness, free=())
        longer = altered(part.chain, 2, d=lambda joint: joint.d + 0.01, a=lambda joint: joint.a + 0.01)
        assert not same_mechanism(longer, witness, free=())


def test_frames_end_where_the_witness_ends(about):
    exercise, poses = about
    parts = [part for part in exercise.parts if isinstance(part.asks, Frames)]
    assert parts
    for part in parts:
        assert part.asks.count == part.chain.n + 1
        for q, T in poses:
            assert np.abs(part.chain.frames(q)[-1] - T).max() < 1e-9


@pytest.mark.parametrize("name", sorted(ENDS))
def test_base_and_tool_by_hand(name):
    """Z and E of the page, written down as numbers, around the poses of the witness."""
    exercise, poses = with_witness(name)
    Z, E = map(np.array, ENDS[name])
    part = exercise.part("X")
    for q, T in poses:
        assert np.abs(value(part, part.chain, q) - Z @ T @ E).max() < 1e-9
    back = exercise.parts[-1]
    ((q,),) = back.asks.probes
    assert np.abs(value(back, back.chain, q) - back.chain.T(0, back.chain.n, q)).max() < 1e-5


def test_what_the_slides_print_of_the_puma():
    """The slips are where the exercise says, and a column of length 1 is not enough."""
    exercise = load_exercise("puma560", ROOT / "exercises")
    q = np.array([0.3, -0.4, 0.5, 0.7, -0.6, 0.9])
    n = bare(exercise).T(0, 6, q)[:3, 0]
    x, y = (exercise.part(name).traps for name in ("mended_1", "mended_2"))
    printed = [float(trap.quantity(exercise.arm, q)) for trap in (x[0], y[1])]
    assert round(float(np.linalg.norm([*printed, n[2]])), 3) == 1.052
    half_mended = [float(x[1].quantity(exercise.arm, q)), printed[1], n[2]]
    assert np.isclose(np.linalg.norm(half_mended), 1)
    assert np.abs(half_mended - n).max() > 0.1
    (mirror, _) = exercise.part("A5").traps
    assert np.isclose(np.linalg.det(np.array(mirror.quantity(exercise.arm, q))), -1)


@pytest.mark.parametrize("name", sorted(ENDS))
def test_the_page_gives_the_pose_that_is_marked(name):
    notebook = json.loads((ROOT / "solutions" / f"{name}.ipynb").read_text(encoding="utf-8"))
    names = {"np": np}
    exec("".join(next(cell["source"] for cell in notebook["cells"] if cell["id"] == "measured")), names)
    back = load_exercise(name, ROOT / "exercises").parts[-1]
    Z, E = map(np.array, ENDS[name])
    off = np.abs(np.linalg.inv(Z) @ names["X_measured"] @ np.linalg.inv(E) - back.asks.values(back.chain)[0])
    assert off.max() < back.asks.tolerance / 5


def test_the_boom_of_the_stanford_arm():
    """The parts that end before the hand, by the links that multiply to the witness, and by school geometry."""
    exercise, poses = with_witness("stanford")
    part = exercise.part
    for q, _ in poses:
        link = [value(part("link"), part("link").chain, i, q) for i in (1, 2, 3)]
        assert np.abs(value(part("T03"), part("T03").chain, q) - reduce(np.matmul, link)).max() < 1e-9
        assert np.abs(value(part("A3"), part("A3").chain, q) - link[2]).max() < 1e-12
        about_x = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
        assert np.abs(value(part("A3_modified"), part("A3_modified").chain, q) - about_x @ link[2]).max() < 1e-12
        boom = [np.cos(q[0]) * np.sin(q[1]), np.sin(q[0]) * np.sin(q[1]), np.cos(q[1])]
        assert np.abs(value(part("push"), part("push").chain, q) - 0.1 * np.array(boom)).max() < 1e-9


def test_two_links_and_the_heading_of_the_scara():
    exercise, poses = with_witness("scara")
    part = exercise.part
    for q, T in poses:
        c, s = np.cos(q[1]), np.sin(q[1])
        over = [[c, s, 0, 0.275 * c], [s, -c, 0, 0.275 * s], [0, 0, -1, 0], [0, 0, 0, 1]]
        assert np.abs(value(part("A2"), part("A2").chain, q) - over).max() < 1e-12
        slide = [[1, 0, 0, 0.275], [0, -1, 0, 0], [0, 0, -1, -q[2]], [0, 0, 0, 1]]
        assert np.abs(value(part("A3_modified"), part("A3_modified").chain, q) - slide).max() < 1e-12
        assert np.isclose(value(part("heading"), part("heading").chain, q), np.arctan2(T[1, 0], T[0, 0]))


def test_the_scara_that_went_wrong_does_what_its_page_says():
    joints = list(bare(load_exercise("scara", ROOT / "exercises")).joints)
    joints[2] = Revolute()
    for q3 in (0.1, 0.2):
        T = Chain(joints, "classic").fk([0, 0, q3, 0])
        assert np.allclose(T[:3, 3], [0.6, 0, 0.387])
        assert np.isclose(np.arctan2(T[1, 0], T[0, 0]), -q3)


def test_the_links_of_the_pa10_with_offsets():
    exercise, poses = with_witness("pa10_6c")
    link = exercise.part("link")
    for q, _ in poses:
        for i in (2, 3):
            part = exercise.part(f"A{i}")
            assert np.abs(value(part, part.chain, q) - value(link, link.chain, i, q)).max() < 1e-12


@pytest.mark.parametrize(
    ("name", "arm", "degrees"),
    [
        ("pa10_6c", robots.pa10_6c, [20, 35, 60, 0, -45, 0]),
        ("pa10_7c", robots.pa10_7c, [20, 35, -40, 60, 10, -45, 0]),
    ],
)
def test_one_set_of_lengths_fits_the_calibration(name, arm, degrees):
    exercise, _ = with_witness(name)
    page = (ROOT / "exercises" / f"{name}.ipynb").read_text(encoding="utf-8")
    places = {each: arm(lengths=each).fk(np.deg2rad(degrees))[:3, 3] for each in ("A", "B", "B2")}
    on_page = {each for each, p in places.items() if "[{:.4f}, {:.4f}, {:.4f}]".format(*p) in page}
    right = exercise.part("lengths").asks.right
    assert on_page == {right}
    assert all(np.linalg.norm(p - places[right]) > 0.004 for each, p in places.items() if each != right)


def test_elbow_and_wrist_of_the_given_hand():
    """The lengths of the arm, and the plane through the vertical; the page has the pose of the marker."""
    exercise, _ = with_witness("pa10_7c")
    W, E, radius = (value(exercise.part(part), exercise.arm, None) for part in ("W", "E", "radius"))
    S = np.array([0, 0, 0.317])
    assert np.isclose(np.linalg.norm(E - S), 0.45, atol=1e-5)
    assert np.isclose(np.linalg.norm(E - W), 0.48, atol=1e-5)
    w = (W - S) / np.linalg.norm(W - S)
    assert np.isclose(np.linalg.norm(np.cross(E - S, w)), radius, atol=1e-5)
    assert abs(np.cross(E - S, w) @ [0, 0, 1]) < 1e-9
    assert E[2] > (S + ((E - S) @ w) * w)[2]
    notebook = json.loads((ROOT / "solutions" / "pa10_7c.ipynb").read_text(encoding="utf-8"))
    names = {"np": np}
    exec("".join(next(cell["source"] for cell in notebook["cells"] if cell["id"] == "given")), names)
    T = names["T_given"]
    assert np.abs(T[:3, 3] - 0.07 * T[:3, 2] - W).max() < exercise.part("W").asks.tolerance / 5


def test_shoulder_and_elbow_of_the_pa10_by_the_links():
    exercise, poses = with_witness("pa10_7c")
    link, part = exercise.part("link"), exercise.part("T04")
    for q, _ in poses:
        product = reduce(np.matmul, [value(link, link.chain, i, q) for i in range(1, 5)])
        assert np.abs(value(part, part.chain, q) - product).max() < 1e-12
