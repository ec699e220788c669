"""What is said of wrong answers that once got a poor word: what it names, where it points, and what it does not say."""

import json
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from dhlib.grading.answers import read_answer
from dhlib.grading.course.variants import Variants
from dhlib.grading.exercise import load_exercise
from dhlib.grading.marking import mark
from dhlib.grading.retelling import altered

ROOT = Path(__file__).parents[2]
KEY = bytes(range(32))
quarter = sp.pi / 2


def asked(name):
    return load_exercise(name, ROOT / "exercises")


def told(exercise, part, value):
    part = exercise.part(part)
    return mark(part, json.loads(json.dumps(read_answer(part.asks.request(), value), allow_nan=False)))


@pytest.mark.parametrize(
    ("name", "part"), [("quickshot", "T4"), ("stanford", "T6"), ("pa10_7c", "T7"), ("planar", "T3")]
)
def test_a_forgotten_factor_is_named(name, part):
    exercise = asked(name)
    chain, (q,) = exercise.part(part).chain, exercise.part(part).asks.probes[0]
    q = np.array(q)
    links = [chain.A(i, q) for i in range(1, chain.n + 1)]
    for i in range(chain.n):
        product = np.linalg.multi_dot([*links[:i], np.eye(4), *links[i + 1 :]])
        got = told(exercise, part, product)
        assert (got.misconception, f"joint {i + 1} is missing" in got.message) == ("missing", True), str(got)
        assert got.section == "sec-classic-product"
    assert told(exercise, part, np.linalg.multi_dot(links)).verdict == "right"
    assert told(exercise, part, links[0]).misconception != "missing"  # negative control


def test_two_lengths_that_change_places_are_no_shifted_rows():
    exercise = asked("planar")
    got = told(exercise, "table2", [["theta1", 0, 190, 0], ["theta2", 0, 260, 0]])
    assert (got.misconception, got.section) == ("lengths", "sec-classic-parameters")
    assert "a_1 and a_2 have changed places" in got.message
    got = told(exercise, "table3", [["theta1", 0, 260, 0], ["theta2", 0, 110, 0], ["theta3", 0, 190, 0]])
    assert "a_2 and a_3 have changed places" in got.message
    shifted = told(exercise, "table3", [["theta1", 0, 110, 0], ["theta2", 0, 260, 0], ["theta3", 0, 190, 0]])
    assert shifted.misconception == "row"  # negative control: these are


def test_the_sign_of_a_length_does_not_point_to_the_twist():
    exercise = asked("quickshot")
    rows = [["theta1", 100, 20, -quarter], ["theta2", 0, 160, 0], ["theta3", 28, 0, quarter], ["theta4", 250, 0, 0]]
    assert told(exercise, "table", rows).verdict == "right"
    for i, column, what in ((0, 1, "d_1"), (1, 2, "a_2"), (2, 1, "d_3")):
        wrong = [list(row) for row in rows]
        wrong[i][column] *= -1
        got = told(exercise, "table", wrong)
        if got.verdict != "right":
            assert got.misconception == "length_sign", str(got)
            assert got.section == "sec-classic-parameters"
            assert f"{what} has the wrong sign" in got.message
    chain, (q,) = exercise.part("T4").chain, exercise.part("T4").asks.probes[0]
    assert told(exercise, "T4", altered(chain, 3, d=-28).T(0, 4, q)).section == "sec-classic-parameters"
    assert told(exercise, "T4", altered(chain, 3, alpha=-np.pi / 2).T(0, 4, q)).section == "sec-classic-trap-sign"
    puma = asked("puma560")
    chain, (q,) = puma.part("T6").chain, puma.part("T6").asks.probes[0]
    assert told(puma, "T6", altered(chain, 3, d=-0.15005).T(0, 6, q)).section == "sec-modified-parameters"


def test_a_wrong_choice_is_answered_with_its_reasons():
    exercise = asked("transforms")
    bare = told(exercise, "law_1", "no pose")
    assert (bare.verdict, bare.points) == ("wrong", 0)
    assert "Go through the reasons a b c d e" in bare.message
    given = told(exercise, "law_1", ("no pose", "b"))
    assert "reason b does not hold: " in given.message
    assert "Go through" not in given.message
    held = told(exercise, "law_1", ("no pose", "e"))
    assert "reason" not in held.message
    assert "Go through" not in told(exercise, "law_1", ("pose", "e")).message


def test_a_function_that_counts_from_0_is_told_so():
    exercise = asked("quickshot")
    chain = exercise.part("link").chain
    before = told(exercise, "link", lambda i, q: chain.A((i - 2) % 4 + 1, q))
    assert (before.misconception, "the link before" in before.message) == ("counting", True)
    late = told(exercise, "link", lambda i, q: chain.A(i, np.roll(q, 1)))
    assert (late.misconception, "the joint before" in late.message) == ("counting", True)
    assert told(exercise, "link", lambda i, q: chain.A(i, q)).verdict == "right"


def test_a_function_of_lines_is_told_for_which_lines_it_fails():
    exercise = asked("axes_to_table")

    def sine_alone(P, u, Q, v):
        u, v = np.array(u) / np.linalg.norm(u), np.array(v) / np.linalg.norm(v)
        across, between = np.cross(u, v), np.subtract(Q, P)
        size = np.linalg.norm(across)
        if size < 1e-9:
            return [np.linalg.norm(between - between @ u * u), 0.0]
        return [abs(between @ across) / size, np.arcsin(size)]

    got = told(exercise, "link_of", sine_alone)
    assert "not for antiparallel lines and skew lines" in got.message
    assert "do not lead where" not in got.message


@pytest.mark.parametrize(
    ("part", "value", "words"),
    [
        ("push", [0, 0, 0.1], "straight up"),
        ("push", "back", "backwards"),
        ("push", "place", "a place"),
    ],
)
def test_a_push_that_goes_elsewhere(part, value, words):
    exercise = asked("stanford")
    chain, (q,) = exercise.part(part).chain, exercise.part(part).asks.probes[0]
    boom = chain.T(0, 2, q)[:3, 2]
    value = (
        {"back": -0.1 * boom, "place": chain.T(0, 3, q)[:3, 3]}.get(value, value) if isinstance(value, str) else value
    )
    assert words in told(exercise, part, value).message
    assert told(exercise, part, 0.1 * boom).verdict == "right"


def test_angles_that_are_summed_twice():
    exercise = asked("planar")
    theta1, theta2 = sp.symbols("theta1 theta2")

    def link(angle, length):
        c, s = sp.cos(angle), sp.sin(angle)
        return sp.Matrix([[c, -s, 0, length * c], [s, c, 0, length * s], [0, 0, 1, 0], [0, 0, 0, 1]])

    assert "its own angle alone" in told(exercise, "T2_sym", link(theta1, 260) * link(theta1 + theta2, 190)).message
    assert told(exercise, "T2_sym", link(theta1, 260) * link(theta2, 190)).verdict == "right"


@pytest.mark.parametrize(("name", "part", "least"), [("one_link", "factor", 3), ("scara", "heights", 3)])
def test_which_of_these_is_each_students_own(name, part, least):
    """The choice differs from student to student, and so does what is printed; by hand, what is printed decides it."""
    variants = Variants(name, ROOT / "exercises")
    seen = set()
    for k in range(24):
        variant = variants.of(KEY, f"student {k}")
        names = {}
        exec(variant.given["printed" if name == "one_link" else "missing"], names)
        if name == "one_link":
            fits = [at for at, wanted in enumerate("xxzz") if names["printed"][at][1] != wanted]
            answers = [("first", "second", "third", "fourth")[at] for at in fits]
        else:
            heights = {place: (1 if place == "d_2" else -1) * value for place, value in names["tried"].items()}
            answers = [place for place, raised in heights.items() if np.isclose(raised, names["missing"])]
        assert [variant.exercise.part(part).asks.right] == answers
        seen.update(answers)
    assert len(seen) == least
