"""Every misconception that shows in a part is caught there, and named."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from sampling import FULL, some

from dhlib import Chain, robots
from dhlib.grading.course.variants import Variants
from dhlib.grading.diagnosis import Case, Tally, as_row, cases, other_chains, read, wrong_readings
from dhlib.grading.exercise import load_exercise
from dhlib.grading.forms import Choice, Valued
from dhlib.grading.marking import mark
from dhlib.grading.marks import Mark
from dhlib.grading.misconceptions import KNOWN, told_frames
from dhlib.grading.sections import CHAPTERS

#: At least this share of wrong answers is named exactly, over all parts. The rest cannot be told apart: a link matrix
#: without p is transposed by turning the other way, and one entry tells less than a matrix.
NAMED = 0.95
ROOT = Path(__file__).parents[2]
VALUED = ("axes_to_table", "convert", "pa10_6c", "pa10_7c", "puma560", "quickshot", "same_arm", "scara", "stanford")
FIGURES = read(ROOT / "book" / "diagnosis.csv")


def test_every_misconception_is_named_and_every_right_answer_known(every, results):
    """And the figures in the instructors' page are those of today: after a change run make diagnosis."""
    tally = Tally(len(every.parts))
    for case in cases(every, results):
        assert case.how not in ("accepted", "refused"), (case.answer, case.keys, str(case.mark))
        setattr(tally, case.how, getattr(tally, case.how) + 1)
    assert tally.share >= NAMED, str(tally)
    assert tally.wrong > 2 * len([part for part in every.parts if not isinstance(part.asks, Choice)])
    assert tally.right > 3 * len(every.parts)
    assert as_row(tally) == FIGURES[every.name], "run make diagnosis"


@pytest.mark.parametrize("name", some(VALUED, 4, "own numbers"))
def test_misconceptions_are_named_with_a_students_own_numbers_too(name):
    """By value, since that is what other numbers change: none passes, and as many are told exactly."""
    variants = Variants(name, ROOT / "exercises")
    for student in [f"student {k}" for k in range(20 if FULL else 1)]:
        tally = Tally()
        for part in variants.of(bytes(range(32)), student).exercise.parts:
            if isinstance(part.asks, Valued):
                for keys, reading in wrong_readings(part):
                    case = Case(part, "", keys, mark(part, reading))
                    assert case.how != "accepted", (keys, str(case.mark))
                    setattr(tally, case.how, getattr(tally, case.how) + 1)
        assert tally.share >= NAMED, str(tally)


def test_the_figures_add_up():
    exercises = {name: row for name, row in FIGURES.items() if name != "all"}
    assert [sum(column) for column in zip(*exercises.values(), strict=True)] == FIGURES["all"]
    assert sorted(exercises) == sorted(path.stem for path in (ROOT / "solutions").glob("*.ipynb"))
    assert FIGURES["all"][0] >= 80


@pytest.mark.parametrize(
    ("keys", "verdict", "misconception", "how"),
    [
        ({"sign"}, "wrong", "sign", "named"),
        ({"sign", "row"}, "wrong", "row", "named"),
        ({"sign"}, "wrong", "row+sign", "common"),
        ({"sign"}, "wrong", "row", "other"),
        ({"sign"}, "wrong", "", "other"),
        ({"sign"}, "right", "", "accepted"),
        ({"sign"}, "follows", "", "accepted"),
        (set(), "right", "", "right"),
        (set(), "nearly", "", "refused"),
        (set(), "unreadable", "", "refused"),
    ],
)
def test_a_tally_counts_what_it_says(exercise, keys, verdict, misconception, how):
    """Negative control: an answer that passes though it is wrong would be counted, and so would a right one refused."""
    marked = Mark("A1", 0, 1, verdict, "", misconception)
    assert Case(exercise.part("A1"), "", frozenset(keys), marked).how == how


def test_other_tables_of_an_arm_are_that_arm():
    """The dresses that the trial takes for right are so: the same pose, at the same joint values."""
    random = np.random.default_rng(2)
    for arm in (robots.quickshot(), robots.stanford(), robots.puma560("modified"), robots.pa10_6c()):
        others = dict(other_chains(arm))
        assert len(others) >= 2 * (arm.n - 2)
        for q in random.uniform(-2, 2, (3, arm.n)):
            for name, other in others.items():
                assert np.abs(other.fk(q) - arm.fk(q)).max() < 1e-9 * max(1, arm.reach), name


def test_which_misconceptions_show_in_the_exercise(exercise):
    """No part of the Quickshot has an offset or a prismatic joint to be forgotten; all others are met."""
    met = set()
    for part in exercise.parts:
        if isinstance(part.asks, Valued):
            for keys, _ in wrong_readings(part):
                met.update(keys)
    assert set(KNOWN) - met == {"offset", "parallel", "improper"}


def test_a_misconception_of_one_part_is_named_exactly(judge, arm, solved, exercise):
    q = solved["q"]
    other = Chain(arm.joints, "modified", unit="mm")
    cases = {
        "convention": ("A1", arm.to_modified().A(1, q), "right for the modified convention; this part asks for"),
        "row": ("T4", _rolled(arm).T(0, 4, q), "one row too far"),
        "sense": ("A3", arm.A(3, -q), "joint 3 turns the wrong way"),
        "sign": ("A3", arm.A(3, q) * _sign_of_alpha(), "α_3 has the wrong sign"),
        "ends": ("X", solved["T4"], "leaves out base and tool"),
        "degrees": ("A2", arm.A(2, np.deg2rad(q)), "wrong unit"),
        "unit": ("A1", _metres(solved["A1"]), "1000 times too small"),
        "reverse": ("T4", solved["A4"] @ solved["A3"] @ solved["A2"] @ solved["A1"], "reverse order"),
        "entrywise": ("T4", solved["A1"] * solved["A2"] * solved["A3"] * solved["A4"], "entry by entry"),
        "transpose": ("T4", solved["T4"].T, "transposed"),
    }
    for key, (part, value, words) in cases.items():
        got = judge(part, value)
        assert (got.misconception, words in got.message) == (key, True), got
        assert got.section
        assert got.points < got.out_of
    got = judge("T4", other.T(0, 4, q))
    assert got.misconception == "convention"
    assert "Here it is Rz Tz Tx Rx" in got.message


def _rolled(arm):
    links = [(j.a, j.alpha) for j in arm.joints]
    rolled = [*links[1:], links[0]]
    return Chain([j.replace(a=a, alpha=alpha) for j, (a, alpha) in zip(arm.joints, rolled, strict=True)], "classic")


def _sign_of_alpha():
    """A3 has sin α = 1 in its third column and its third row; with -1 these turn."""
    signs = np.ones((4, 4))
    signs[:2, 2] = signs[2, 1] = -1
    return signs


def _metres(matrix):
    changed = matrix.copy()
    changed[:3, 3] /= 1000
    return changed


@pytest.mark.parametrize("key", ["slip", "mended"])
def test_traps_of_the_task_come_first(judge, solved, key):
    if key == "slip":
        assert "right as printed" in judge("slip", "n_z").message
    else:
        got = judge("mended", solved["n"][1])
        assert got.misconception == "trap"
        assert "as it is printed" in got.message


def test_where_two_fit_both_are_said(judge, arm, solved):
    got = judge("A4", arm.A(4, -solved["q"]))
    assert got.misconception == "sense+transpose"
    assert got.message == (
        "Two slips lead to this very answer: joint 4 turns the wrong way, or the rotation is transposed. Either way a "
        "turn goes backwards."
    )


def test_the_joint_that_several_slips_share_is_said(judge, arm, solved):
    got = judge("mended", sp.cos(sp.Symbol("theta1")) * sp.Symbol("theta1"))
    assert "Either way" not in got.message
    part = load_exercise("quickshot").part("mended")
    missing = [mark(part, reading) for keys, reading in wrong_readings(part) if keys == {"joint_kind", "missing"}]
    assert [each.message.partition(" Either way ")[2] for each in missing] == ["it is joint 2.", "it is joint 4."]


def test_every_sentence_points_into_the_book(every):
    labels = {label for chapter in CHAPTERS for label in chapter.sections}
    assert {known.where(of) for known in KNOWN.values() for of in ("classic", "modified")} <= labels
    assert {part.section for part in every.parts} <= labels
    keys = {trap.key for part in every.parts for trap in part.traps}
    assert keys <= {*KNOWN, "trap"}


@pytest.mark.parametrize(("asked", "words"), [("classic", "frame i stands on axis i."), ("modified", "on axis i + 1.")])
def test_frames_of_the_other_convention_are_said_to_stand_on_its_axes(asked, words):
    """A modified frame i stands on axis i, a classic one on axis i + 1: what is told is of the other one."""
    slip, _ = next(iter(told_frames(robots.quickshot(), asked)))
    assert slip.misconception.key == "convention"
    assert words in slip.says
