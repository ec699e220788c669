"""The figures' mathematics against dhlib: the same answers on random and degenerate inputs, to 1e-12."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from arms import EVERY_ROBOT, random_chain, random_pose
from formulas import node_program

from dhlib import Axis, Chain, Prismatic, Revolute, classic, inverse, modified, read_parameters, robots
from dhlib.axes import product_of_exponentials
from dhlib.errors import DHError
from dhlib.export import chain_data, chain_json
from dhlib.normals import common_normal, foot
from dhlib.preconditions import deviation, deviation_from_axis

HERE = Path(__file__).parent
MODULE = HERE.parent.parent / "book/web/kinematics.js"
TOLERANCE = 1e-12
CONVENTIONS = ("classic", "modified")


class Question(NamedTuple):
    """A call of a JavaScript function, what dhlib answers, and the size of the numbers in play."""

    call: list[Any]
    answer: Any
    size: float = 1.0


def ask(calls: list[list[Any]], module: Path = MODULE) -> list[Any]:
    """Return what the JavaScript functions answer."""
    asked = subprocess.run(
        [node_program(), str(HERE / "answer.mjs"), str(module)],
        input=json.dumps(calls),
        stdout=subprocess.PIPE,
        encoding="utf-8",
        check=True,
    )
    answers: list[Any] = json.loads(asked.stdout)
    return answers


def difference(one: Any, other: Any) -> float:
    """Return the largest difference of two answers; infinite where they differ in form, a text or a truth value."""
    if isinstance(one, dict) and isinstance(other, dict) and one.keys() == other.keys():
        return max(difference(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return max((difference(a, b) for a, b in zip(one, other, strict=True)), default=0.0)
    if isinstance(one, int | float) and isinstance(other, int | float):
        return abs(one - other)
    return 0.0 if one == other else math.inf


def disagreements(questions: list[Question], module: Path = MODULE) -> list[str]:
    answers = ask([question.call for question in questions], module)
    return [
        f"{question.call[0]}{question.call[1:]}: {answer} is not {question.answer}"
        for question, answer in zip(questions, answers, strict=True)
        if not difference(answer, question.answer) <= TOLERANCE * question.size
    ]


# Inputs

ANGLES = [k * math.pi / 2 for k in range(-4, 5)] + [1e-12, -1e-12, 1e-7, math.pi - 1e-9, math.pi / 6]
LENGTHS = [0.0, 1.0, -1.0, 1e-9, 1234.5]


def four_parameters(rng: np.random.Generator) -> list[float]:
    """θ, d, a, α: each at random, or degenerate."""

    def pick(plain: list[float], size: float) -> float:
        return float(rng.choice(plain) if rng.random() < 0.5 else rng.uniform(-size, size))

    return [pick(ANGLES, 6.3), pick(LENGTHS, 3.0), pick(LENGTHS, 3.0), pick(ANGLES, 6.3)]


def link_questions(rng: np.random.Generator) -> list[Question]:
    questions = []
    for _ in range(500):
        theta, d, a, alpha = four_parameters(rng)
        size = max(1, abs(a), abs(d))
        row = {"theta": theta, "d": d, "a": a, "alpha": alpha}
        for convention, matrix in (("classic", classic(*row.values())), ("modified", modified(alpha, a, theta, d))):
            questions.append(Question(["linkMatrix", convention, row], matrix.tolist(), size))
    return questions


def chains(rng: np.random.Generator) -> list[Chain]:
    named = [chain for arm in EVERY_ROBOT.values() for chain in (arm.to_classic(), arm.to_modified())]
    return named + [random_chain(rng, convention) for convention in CONVENTIONS for _ in range(100)]


def chain_questions(rng: np.random.Generator) -> list[Question]:
    questions = []
    for chain in chains(rng):
        data = chain_data(chain)
        lines = [line_data(axis) for axis in chain.axes()]
        for q in (np.zeros(chain.n), rng.choice(ANGLES, chain.n), rng.uniform(-3, 3, chain.n)):
            size = max(1.0, chain.reach)
            at = q.tolist()
            questions += [
                Question(["frames", data, at], chain.frames(q).tolist(), size),
                Question(["forward", data, at], chain.fk(q).tolist(), size),
            ]
            end = chain.fk(np.zeros(chain.n))
            by_axes = product_of_exponentials(chain.axes(), end, q)
            questions.append(Question(["productOfExponentials", lines, end.tolist(), at], by_axes.tolist(), 10 * size))
        questions.append(Question(["axes", data], lines, size))
    return questions


def pose_questions(rng: np.random.Generator) -> list[Question]:
    questions = []
    for _ in range(150):
        one, other = random_pose(rng), random_pose(rng)
        questions += [
            Question(["inverse", one.tolist()], inverse(one).tolist()),
            Question(["multiply", one.tolist(), other.tolist()], (one @ other).tolist(), 3),
        ]
        for convention in CONVENTIONS:
            angle, distance = deviation(one, other, convention)
            answer = {"angle": angle, "distance": distance}
            # the distance is divided by the sine of the angle, and so is its rounding
            questions.append(
                Question(["deviation", one.tolist(), other.tolist(), convention], answer, 3 / math.cos(angle))
            )
            theta, d, a, alpha = four_parameters(rng)
            link = classic(theta, d, a, alpha) if convention == "classic" else modified(alpha, a, theta, d)
            after = one @ link
            read = dict(zip(("theta", "d", "a", "alpha"), read_parameters(one, after, convention), strict=True))
            if min(math.pi - abs(read["theta"]), math.pi - abs(read["alpha"])) > 1e-10:  # no jump from π to -π
                questions.append(
                    Question(["readParameters", one.tolist(), after.tolist(), convention], read, 3 + abs(a) + abs(d))
                )
    return questions


def line_data(axis: Axis) -> dict[str, Any]:
    return {"point": axis.point.tolist(), "direction": axis.direction.tolist(), "kind": axis.kind}


def line_questions(rng: np.random.Generator) -> list[Question]:
    questions = []
    for _ in range(150):
        kind = str(rng.choice(["R", "P"]))
        first = Axis(rng.uniform(-1, 1, 3), rng.normal(size=3), kind)
        others = {
            "skew": Axis(rng.uniform(-1, 1, 3), rng.normal(size=3)),
            "parallel": Axis(rng.uniform(-1, 1, 3), first.direction),
            "antiparallel": Axis(rng.uniform(-1, 1, 3), -first.direction),
            "coincident": Axis(first.point + 2 * first.direction, -first.direction),
            "intersecting": Axis(first.point, rng.normal(size=3)),
        }
        for lie, second in others.items():
            normal = common_normal(first, second)
            assert normal.kind == lie
            answer = {
                "kind": normal.kind,
                "x": None if lie == "coincident" else normal.x.tolist(),
                "before": normal.before.tolist(),
                "after": normal.after.tolist(),
            }
            size = 10 / math.sin(normal.angle) ** 2 if lie in ("skew", "intersecting") else 10.0
            questions.append(Question(["commonNormal", line_data(first), line_data(second)], answer, size))
        point, pose, q = rng.uniform(-1, 1, 3), random_pose(rng), float(rng.choice(ANGLES))
        angle, distance = deviation_from_axis(pose, first)
        answer = {"angle": angle, "distance": distance}
        questions += [
            Question(["foot", line_data(first), point.tolist()], foot(first, point).tolist(), 3),
            Question(["motion", line_data(first), q], first.motion(q).tolist(), 10),
            Question(["deviationFromAxis", pose.tolist(), line_data(first)], answer, 3),
        ]
    return questions


TOPICS: dict[str, Callable[[np.random.Generator], list[Question]]] = {
    "links": link_questions,
    "chains": chain_questions,
    "poses": pose_questions,
    "lines": line_questions,
}


@pytest.mark.parametrize("topic", TOPICS)
def test_answers_are_those_of_dhlib(topic: str) -> None:
    questions = TOPICS[topic](np.random.default_rng(1955))
    assert len(questions) >= 500
    assert disagreements(questions) == []


#: Each of these would be a mistake, and the questions of its topic must find it.
MISTAKES = {
    "links": [
        ("[s, c, 0, 0], [0, 0, 1, d]", "[-s, c, 0, 0], [0, 0, 1, d]"),
        ("[0, c, -s, 0], [0, s, c, 0]", "[0, c, s, 0], [0, -s, c, 0]"),
        ("multiply(screwX(a, alpha), screwZ(theta, d))", "multiply(screwZ(theta, d), screwX(a, alpha))"),
        ("convention === \"classic\" ? classic(", "convention !== \"classic\" ? classic("),
        ("[1, 0, 0, a]", "[1, 0, 0, a + 1e-11]"),
    ],
    "chains": [
        ("joint.sign * q", "q"),
        ("chain.tool)", "IDENTITY)"),
        ("const poses = [chain.base]", "const poses = [IDENTITY]"),
        ("poses.slice(0, -1) : poses.slice(1);\n  return chain", "poses.slice(1) : poses.slice(1);\n  return chain"),
        ("scale(s, cross(direction, v))", "scale(s, cross(v, direction))"),
        ("scale(sign, column", "scale(1, column"),
    ],
    "poses": [
        ("-dot(column(pose, k), p)", "dot(column(pose, k), p)"),
        ("[after, before] : [before, after]", "[before, after] : [after, before]"),
        ("angleOf(-ay, az)", "angleOf(ay, az)"),
        ("a: nx * px + ny * py", "a: Math.hypot(px, py)"),
    ],
    "lines": [
        ("scale(Math.sign(side), x)", "x"),
        ('cosine > 0 ? "parallel"', 'cosine < 0 ? "parallel"'),
        ("line.kind === \"P\" ? 0", "line.kind === \"R\" ? 0"),
        ("if (kind === \"P\")", "if (kind === \"none\")"),
    ],
}  # fmt: skip


@pytest.mark.parametrize(("topic", "right", "wrong"), [(t, *pair) for t, pairs in MISTAKES.items() for pair in pairs])
def test_a_mistake_would_be_found(tmp_path: Path, topic: str, right: str, wrong: str) -> None:
    source = MODULE.read_text("utf-8")
    assert source.count(right) == 1
    spoilt = tmp_path / "kinematics.mjs"
    spoilt.write_text(source.replace(right, wrong), "utf-8")
    assert disagreements(TOPICS[topic](np.random.default_rng(1955)), spoilt)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_four_steps_lead_through_the_link(convention: str) -> None:
    row = {"theta": 0.3, "d": 2.0, "a": -1.5, "alpha": -1.1}
    (steps,) = ask([["steps", convention, row]])
    order = ["theta", "d", "a", "alpha"] if convention == "classic" else ["alpha", "a", "theta", "d"]
    assert [step["parameter"] for step in steps] == order
    product = np.linalg.multi_dot([step["matrix"] for step in steps])
    expected = classic(**row) if convention == "classic" else modified(**row)
    assert np.abs(product - expected).max() < TOLERANCE


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_frames_that_obey_spell_a_table_that_moves_like_the_arm(convention: str) -> None:
    """With z against the sense of a joint too; and a table that does not is found out."""
    arm = Chain(
        [Revolute(d=0.4, a=0.1, alpha=-1.2, sign=-1), Prismatic(theta=0.3, a=0.2, alpha=1.0), Revolute(a=0.5)],
        convention,
    )
    poses, lines = arm.frames(np.zeros(3)).tolist(), [line_data(axis) for axis in arm.axes()]
    (chain,) = ask([["chainOfFrames", poses, lines, convention]])
    assert [joint["sign"] for joint in chain["joints"]] == [-1, 1, 1]
    moved = [lines[0], lines[2], lines[1]]
    same, other = ask([["disagreement", chain, lines, poses[-1]], ["disagreement", chain, moved, poses[-1]]])
    assert same < TOLERANCE
    assert other > 0.1


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_the_elbow_circle_keeps_its_distance_from_shoulder_and_wrist(convention: str) -> None:
    """Every point of it is as far from both as the elbow is: the lengths of upper arm and forearm, from the table."""
    arm = robots.pa10_7c(convention)
    shoulder, upper, fore = 0.317, 0.45, 0.48
    rng = np.random.default_rng(7)
    for _ in range(20):
        q = rng.uniform(-2, 2, 7)
        (circle,) = ask([["elbowCircle", chain_data(arm), q.tolist()]])
        centre, axis, elbow = (np.array(circle[key]) for key in ("centre", "axis", "elbow"))
        first = (elbow - centre) / circle["radius"]
        turn = rng.uniform(-3, 3)
        point = centre + circle["radius"] * (np.cos(turn) * first + np.sin(turn) * np.cross(axis, first))
        wrist = arm.to_classic().frames(q)[5, :3, 3]  # where axes 5, 6 and 7 meet
        assert abs(np.linalg.norm(point - [0, 0, shoulder]) - upper) < TOLERANCE
        assert abs(np.linalg.norm(point - wrist) - fore) < TOLERANCE


#: Like the PA10, but counted from another pose, so that axes 1 and 3, 5 and 7 are not parallel at q = 0.
OTHER_ZEROS = Chain(
    [
        Revolute(d=0.3, alpha=-math.pi / 2, offset=0.2),
        Revolute(alpha=math.pi / 2, offset=0.7, sign=-1),
        Revolute(d=0.4, alpha=-math.pi / 2, offset=-0.4),
        Revolute(alpha=math.pi / 2, offset=0.3),
        Revolute(d=0.5, alpha=-math.pi / 2, offset=1.2),
        Revolute(alpha=math.pi / 2, offset=-0.9),
        Revolute(d=0.1, offset=0.5, sign=-1),
    ],
    "classic",
)
SHOULDER_WRIST = {
    "pa10": robots.pa10_7c(),
    "pa10 modified": robots.pa10_7c("modified"),
    "iiwa": robots.iiwa14(),
    "other zeros": OTHER_ZEROS,
}


def elbow_faults(arm: Chain, module: Path = MODULE) -> list[str]:
    """Turn the elbow at random, at singular poses too; say where dhlib finds the hand moved or the elbow not turned."""
    rng = np.random.default_rng(17)
    poses = [rng.uniform(-2, 2, 7) for _ in range(150)] + [
        rng.choice([-1.5, 0.0, 1e-9, math.pi / 2], 7) for _ in range(50)
    ]
    poses = [np.array([*q[:3], q[3] if abs(math.sin(q[3])) > 0.01 else 1.0, *q[4:]]) for q in poses]
    turns = [float(rng.choice([rng.uniform(-3, 3), 1e-4, math.pi])) for _ in poses]
    data, frames_on_axes = chain_data(arm), arm.to_modified().frames

    def elbow_of(q: Any) -> np.ndarray:
        """Where axes 3 and 4 meet."""
        poses = frames_on_axes(np.asarray(q))
        lines = [Axis(pose[:3, 3], pose[:3, 2]) for pose in poses[3:5]]
        return common_normal(*lines).before

    turned = ask([["turnElbow", data, q.tolist(), by] for q, by in zip(poses, turns, strict=True)], module)
    circles = ask([["elbowCircle", data, q.tolist()] for q in poses], module)
    faults = []
    for q, by, moved, circle in zip(poses, turns, turned, circles, strict=True):
        if (hand := np.abs(arm.fk(moved) - arm.fk(q)).max()) > 1e-9:
            faults.append(f"{q}: the hand moves by {hand}")
        here, there = elbow_of(q), elbow_of(moved)
        axis = Axis(np.array(circle["centre"]), np.array(circle["axis"]))
        if np.abs(axis.motion(by)[:3] @ [*here, 1] - there).max() > 1e-9:
            faults.append(f"{q}: the elbow is not turned by {by}")
        if by == 1e-4 and np.sin(q[[1, 5]]).min() > 0.1 and np.abs(np.array(moved) - q).max() > 0.01:
            faults.append(f"{q}: a small turn jumps to {moved}")
    return faults


@pytest.mark.parametrize("name", SHOULDER_WRIST)
def test_the_hand_rests_while_the_elbow_goes_round(name: str) -> None:
    assert elbow_faults(SHOULDER_WRIST[name]) == []


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("undone = multiply(inverse(multiply(swivel, elbow))", "undone = multiply(inverse(multiply(elbow, swivel))"),
        ("elbowCircle(chain, q).axis, angle)", "elbowCircle(chain, q).axis, -angle)"),
        ("- rest;", "+ rest;"),
        ("dot(last, cross(third, second))", "dot(last, cross(second, third))"),
        ("far(other) < far(one)", "far(other) > far(one)"),
        ("length(side) < 1e-12", "length(side) < 1e-3"),
    ],
)
def test_a_hand_that_moves_would_be_found(tmp_path: Path, right: str, wrong: str) -> None:
    source = MODULE.read_text("utf-8")
    assert source.count(right) == 1
    spoilt = tmp_path / "kinematics.mjs"
    spoilt.write_text(source.replace(right, wrong), "utf-8")
    assert elbow_faults(OTHER_ZEROS, spoilt) or elbow_faults(robots.pa10_7c(), spoilt)


def test_the_elbow_stops_where_a_joint_would_pass_its_limit() -> None:
    arm = robots.pa10_7c()
    q = np.radians([0, 40, 0, 70, 0, 50, 0])
    ((round_once, short_way),) = [
        ask([["moveElbow", chain_data(arm), q.tolist(), by] for by in (math.pi, math.radians(30))])
    ]
    assert round_once["stopped"] == 1
    assert 0 < round_once["angle"] < math.pi
    for moved in (round_once, short_way):
        assert np.abs(arm.fk(moved["q"]) - arm.fk(q)).max() < 1e-9
        for value, joint in zip(moved["q"], arm.joints, strict=True):
            assert joint.limits is not None
            assert joint.limits[0] - 1e-9 <= value <= joint.limits[1] + 1e-9
    assert short_way["stopped"] is None
    (circle,) = ask([["elbowCircle", chain_data(arm), short_way["q"]]])
    assert circle["angle"] == pytest.approx(math.radians(30), abs=1e-9)


def test_export_keeps_every_digit() -> None:
    arm = Chain([Revolute(d=1 / 3, a=0.1, alpha=0.1 + 0.2, limits=(-1, 2), sign=-1)], "modified", name="Λ")
    read = json.loads(chain_json(arm))
    assert read == chain_data(arm)
    assert read["joints"] == [
        {"kind": "R", "theta": 0.0, "d": 1 / 3, "a": 0.1, "alpha": 0.1 + 0.2, "sign": -1, "limits": [-1.0, 2.0]}
    ]
    assert read["name"] == "Λ"


def test_symbols_cannot_be_exported() -> None:
    import sympy

    with pytest.raises(DHError, match="symbols"):
        chain_data(Chain([Revolute(a=sympy.Symbol("a"))], "classic"))
