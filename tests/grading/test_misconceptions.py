"""Every misconception that shows in a part is caught there, and named."""

import shutil
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from sampling import FULL, some

from dhlib import Chain, Prismatic, Revolute, inverse, robots
from dhlib.grading.course.variants import Variants
from dhlib.grading.diagnosis import Case, Tally, as_row, cases, other_chains, read, wrong_readings
from dhlib.grading.diagnosis import main as diagnosis
from dhlib.grading.exercise import Part, load_exercise
from dhlib.grading.forms import Choice, Numbers, Valued
from dhlib.grading.marking import mark
from dhlib.grading.marks import Mark
from dhlib.grading.misconceptions import KNOWN, _clause, retellings, told_frames
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


def test_the_tallies_are_written_as_the_book_reads_them(tmp_path, capsys):
    solutions, out = tmp_path / "solutions", tmp_path / "diagnosis.csv"
    solutions.mkdir()
    shutil.copy(ROOT / "solutions" / "one_link.ipynb", solutions)
    folders = ["--solutions", str(solutions), "--exercises", str(ROOT / "exercises")]
    assert diagnosis([*folders, "--out", str(out)]) == 0
    assert read(out)["one_link"] == read(out)["all"] == FIGURES["one_link"]
    out.unlink()
    assert diagnosis([*folders, "one_link"]) == 0
    assert "one_link: " in capsys.readouterr().out
    assert not out.exists()
    assert diagnosis([*folders, "no_such"]) == 2
    assert "no_such" in capsys.readouterr().err


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


# Each retelling, on an arm whose every number is another one


JOINTS = (
    Revolute(d=1.0, a=2.0, alpha=0.1, offset=0.3),
    Prismatic(theta=0.2, a=3.0, alpha=0.4, offset=0.5, sign=-1),
    Revolute(d=4.0, a=5.0, alpha=0.6),
)


def told(convention, joints=JOINTS):
    """Key and sentence to the tables of the arms that are told by it, a row (kind, sign, θ, d, a, α) for each joint."""
    tables = {}
    for key, says, arm in retellings(Chain(joints, convention)):
        if isinstance(arm, Chain):
            rows = [(j.kind, j.sign, j.theta, j.d, j.a, j.alpha) for j in arm.joints]
            tables.setdefault((key, says.replace("{part}", "A")), []).append(rows)
    return tables


def changed(*changes):
    """The table with some entries (joint, column, value) that are others."""
    rows = [[j.kind, j.sign, j.theta, j.d, j.a, j.alpha] for j in JOINTS]
    for joint, column, value in changes:
        rows[joint - 1][("kind", "sign", "theta", "d", "a", "alpha").index(column)] = value
    return [tuple(row) for row in rows]


@pytest.mark.parametrize("convention", ["classic", "modified"])
def test_each_slip_is_told_as_it_is_made(convention):
    """Written by hand, once more: what the sentence says is what is changed in the table."""
    first = 1 if convention == "classic" else 0
    one, two, three = range(first, first + 3)
    expected = {
        ("offset", "In A joint 1 starts from another zero: θ is q1 plus an offset."): [
            changed((1, "theta", 0.0)), changed((1, "theta", -0.3))],
        ("offset", "In A joint 2 starts from another zero: d is q2 plus an offset."): [
            changed((2, "d", 0.0)), changed((2, "d", -0.5))],
        ("offset", "In A the offsets between q and θ are missing."): [
            changed((1, "theta", 0.0), (2, "d", 0.0), (3, "theta", 0.0))],
        ("sense", "In A joint 1 turns the wrong way: compare the sign of θ1 with the direction of its axis."): [
            changed((1, "sign", -1))],
        ("sense", "In A joint 2 slides the wrong way: compare the sign of d2 with the direction of its axis."): [
            changed((2, "sign", 1))],
        ("sense", "In A all joints turn the wrong way: positive is by the right-hand rule about z."): [
            changed((1, "sign", -1), (2, "sign", 1), (3, "sign", -1))],
        ("joint_kind", "In A the variable of joint 3 stands in d; it is revolute, so q3 belongs into θ."): [
            changed((3, "kind", "P"))],
        ("joint_kind", "In A joint 2 turns where it should slide; it is prismatic, so q2 belongs into d."): [
            changed((2, "kind", "R"))],
        ("sign", f"In A α_{one} has the wrong sign."): [changed((1, "alpha", -0.1))],
        ("sign", f"In A α_{three} has the wrong sign."): [changed((3, "alpha", -0.6))],
        ("sign", "In A every α has the wrong sign: α turns z into the next z, by the right-hand rule about x."): [
            changed((1, "alpha", -0.1), (2, "alpha", -0.4), (3, "alpha", -0.6))],
        ("length_sign", f"In A a_{two} has the wrong sign: it is measured along x_{two}, from axis to axis."): [
            changed((2, "a", -3.0))],
        ("length_sign", "In A d_3 has the wrong sign: it counts from x_2 to x_3, along joint axis 3."): [
            changed((3, "d", -4.0))],
        ("length_sign", "In A every a has the wrong sign: a is measured along x."): [
            changed((1, "a", -2.0), (2, "a", -3.0), (3, "a", -5.0))],
        ("a_and_d", f"In A a_{one} and d_1 are exchanged: d is measured along z, a along x."): [
            changed((1, "a", 1.0), (1, "d", 2.0))],
        ("lengths", f"In A a_{one} and a_{two} have changed places: a_{one} is the length of link {one}, which stands "
                    f"before joint {two}."): [changed((1, "a", 3.0), (2, "a", 2.0))],
        ("lengths", f"In A a_{two} and a_{three} have changed places: a_{two} is the length of link {two}, which "
                    f"stands before joint {three}."): [changed((2, "a", 5.0), (3, "a", 3.0))],
    }  # fmt: skip
    tables = told(convention)
    for slip, arms in expected.items():
        assert tables[slip] == arms, slip
    link = {"classic": "the link behind joint i", "modified": "the link before joint i"}[convention]
    for words, rows in (("down", (3, 1, 2)), ("up", (2, 3, 1))):
        says = f"In A the columns a and α stand one row too far {words}: in the {convention} convention row i "
        says += f"holds {link}."
        links = [(JOINTS[k - 1].a, JOINTS[k - 1].alpha) for k in rows]
        assert [row[4:] for row in tables["row", says][1]] == links
        links[0 if words == "down" else 2] = (0.0, 0.0)
        assert [row[4:] for row in tables["row", says][0]] == links


def test_what_no_slip_would_change_is_not_told():
    """No offset to forget, no length to exchange."""
    keys = {key for key, _ in told("classic", [Revolute(d=1.0, a=2.0), Revolute(alpha=0.3), Revolute(a=5.0)])}
    assert not keys & {"offset", "lengths"}
    assert {"sense", "sign", "length_sign", "row"} <= keys


def test_each_link_of_a_product_can_be_missing():
    without = [arm.without for key, _, arm in retellings(Chain(JOINTS, "classic")) if key == "missing"]
    assert without == [1, 2, 3]


def test_the_list_of_misconceptions_is_numbered_and_takes_no_points():
    assert [known.number for known in KNOWN.values()] == list(range(1, len(KNOWN) + 1))
    assert {key for key, known in KNOWN.items() if known.credit == 0.5} >= {"convention", "sign", "offset", "sense"}
    assert all(0 <= known.credit <= 1 for known in KNOWN.values())


@pytest.mark.parametrize(
    ("says", "clause"),
    [
        ("In A1 joint 3 turns the wrong way: compare signs.", "joint 3 turns the wrong way"),
        ("The factors of T stand in reverse order: look.", "the factors of T stand in reverse order"),
        ("Your A1 is right for the other convention; this asks for one.", "your A1 is right for the other convention"),
        ("DH1 fails. So look.", "DH1 fails"),
    ],
)
def test_a_sentence_becomes_a_clause(says, clause):
    assert _clause(says) == clause


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


def test_a_pose_seen_from_its_other_end_is_told_by_the_same_slips():
    arm, q = robots.planar(2), (0.3, 0.5)
    back = Part("back", "Back", 1, Numbers(lambda arm, q: arm.T(2, 0, q) @ arm.T(1, 1, q), at=q), arm=arm)
    assert mark(back, {"values": [arm.T(2, 0, q).tolist()]}).passed
    turned = inverse(arm.A(2, q) @ arm.A(1, q))
    assert mark(back, {"values": [turned.tolist()]}).misconception == "reverse"
