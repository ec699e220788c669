"""Tables: any table of the arm is right; the rest is placed on the ladder."""

import numpy as np
import pandas as pd
import pytest
import sympy as sp

from dhlib import Chain, Revolute, Tz, place_frames, robots
from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import Part
from dhlib.grading.forms import Table
from dhlib.grading.marking import mark

t = sp.symbols("theta1:5")
pi = sp.pi
RIGHT = [[t[0], 100, 20, -pi / 2], [t[1], 0, 160, 0], [t[2], 28, 0, pi / 2], [t[3], 250, 0, 0]]
COLUMNS = ["theta", "d", "a", "alpha"]


def with_cells(*changes):
    rows = [list(row) for row in RIGHT]
    for i, name, value in changes:
        rows[i - 1][COLUMNS.index(name)] = value
    return rows


@pytest.mark.parametrize(
    "table",
    [
        RIGHT,
        tuple(map(tuple, RIGHT)),
        np.array(RIGHT, dtype=object),
        sp.Matrix(RIGHT),
        pd.DataFrame(RIGHT, columns=COLUMNS),
        pd.DataFrame(RIGHT, columns=COLUMNS)[["alpha", "a", "theta", "d"]],
        {name: [row[k] for row in RIGHT] for k, name in enumerate(["θ", "d", "a", "α"])},
        [[i, *row] for i, row in enumerate(RIGHT, 1)],
        [["q1", 100, 20, "-pi/2"], ["q2", 0, 160, 0], ["q3", 28, 0, "π/2"], ["q4", "250", 0, 0]],
        [[0, 100, 20, -np.pi / 2], [0, 0, 160, 0], [0, 28, 0, np.pi / 2], [0, 250, 0, 0]],
        np.array([[0, 100, 20, -1.5708], [0, 0, 160, 0], [0, 28, 0, 1.5708], [0, 250, 0, 0]]),
        robots.quickshot(),
    ],
    ids=lambda v: type(v).__name__,
)
def test_the_table_of_the_book_in_any_dress(judge, table):
    got = judge("table", table)
    assert (got.verdict, got.points, got.message) == ("right", 4, "")


@pytest.mark.parametrize(
    "table",
    [
        with_cells((1, "a", -20), (1, "alpha", pi / 2)),  # x1 turned round, with other zeros
        with_cells((1, "a", -20), (1, "alpha", pi / 2), (1, "theta", t[0] + pi), (2, "theta", t[1] - pi)),
        with_cells((2, "a", -160)),
        with_cells((3, "alpha", -pi / 2)),
        with_cells((3, "d", 0), (2, "d", 28)),  # d elsewhere along the parallel axes
        with_cells((3, "d", 20), (2, "d", 8)),
        with_cells((1, "alpha", pi / 2), (2, "theta", -t[1]), (2, "alpha", pi)),  # z1 turned round
        with_cells((1, "alpha", pi / 2), (3, "alpha", -pi / 2), (3, "d", -28)),  # z1 and z2 turned round
        with_cells((3, "alpha", -pi / 2), (4, "d", -250)),  # z3 turned round
    ],
)
def test_every_valid_table_gets_full_marks(judge, table):
    got = judge("table", table)
    assert (got.verdict, got.points) == ("right", 4), got


def test_what_the_library_places_itself_is_right(judge, arm):
    end = arm.fk([0, 0, 0, 0])
    placed = place_frames(arm.axes(), convention="classic", end=end)
    chain = placed[0] if isinstance(placed, tuple) else placed
    assert judge("table", chain).verdict == "right"


@pytest.mark.parametrize(
    ("table", "points", "key", "words"),
    [
        (with_cells((1, "d", 0)), 3, "ends", "frame 0 would not be where"),
        (with_cells((4, "d", 0)), 3, "ends", "its origin is 250 mm away"),
        (with_cells((1, "alpha", pi / 2)), 3, "sign", "α_1 has the wrong sign"),
        (with_cells((3, "d", -28)), 3, "length_sign", "d_3 has the wrong sign"),
        ([[r[0], r[1] / 1000, r[2] / 1000, r[3]] for r in RIGHT], 3, "unit", "a thousand times too small"),
        ([[r[0], r[1], r[2], r[3] * 180 / pi] for r in RIGHT], 3, "degrees", "in radians"),
        (robots.quickshot("modified"), 2, "convention", "modified convention; asked for is a classic"),
        ([[r[0], r[1], *link] for r, link in zip(RIGHT, [(0, 0), (20, -pi / 2), (160, 0), (0, pi / 2)], strict=True)],
         2, "convention", "right for the modified convention"),
        ([[r[0], r[1], *link] for r, link in zip(RIGHT, [(160, 0), (0, pi / 2), (0, 0), (20, -pi / 2)], strict=True)],
         1, "row", "one row too far up"),
        ([[r[0], r[2], r[1], r[3]] for r in RIGHT], 1, "a_and_d", "a and d are exchanged"),
        (with_cells((2, "d", 160), (2, "a", 0)), 1, "a_and_d", "a_2 and d_2 are exchanged"),
        (with_cells((3, "theta", 0), (3, "d", t[2])), 1, "joint_kind", "Joint 3 is revolute"),
        (with_cells((2, "a", 150)), 0, "", "axes 2 and 3"),
        ([[x, 0, 100, 0] for x in t], 0, "", "axes 1 and 2"),
        (RIGHT[:3], 0, "", "3 rows; the arm has 4 joints"),
        ([[r[0], r[1], r[2] - 10, r[3] * 180 / pi] for r in RIGHT], 0, "degrees", "with degrees the arm would not be"),
        (Chain([joint.replace(a=7) for joint in robots.quickshot("modified").joints], "modified"), 0, "convention",
         "This chain is in the modified convention; asked for is a classic table."),
    ],
)  # fmt: skip
def test_the_ladder(judge, table, points, key, words):
    got = judge("table", table)
    assert not got.passed
    assert (got.points, got.misconception) == (points, key), got
    assert words in got.message, got


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ([[r[3], r[2], r[0], r[1]] for r in RIGHT], "stand as alpha, a, theta, d"),
        ([[r[3], r[2], r[1], r[0]] for r in RIGHT], "variables stand in column 4, which is that of alpha"),
        (with_cells((1, "d", sp.Symbol("L"))), "Row 1 holds L: besides the variable of its own joint, q1,"),
        (with_cells((2, "theta", t[0])), "Row 2 holds theta1: besides"),
        (with_cells((2, "theta", t[0] + t[1])), "no other symbol"),
        (with_cells((1, "d", t[0])), "both theta and d are variable"),
        (with_cells((2, "theta", 2 * t[1])), "no joint variable"),
        ([], "empty"),
        ([1, 2, 3, 4], "four"),
        ([row[:3] for row in RIGHT], "four"),
        (with_cells((1, "d", float("nan"))), "NaN"),
        ("my table", "quotation marks"),
        (pd.DataFrame(RIGHT, columns=["u", "v", "w", "x"]), "Columns are"),
    ],
)
def test_tables_that_cannot_be_read(judge, table, words):
    got = judge("table", table)
    assert (got.verdict, got.points) == ("unreadable", 0)
    assert words in got.message, got


def ask(arm, **options):
    return Part("table", "T", 4, Table(arm.convention, **options), arm=arm)


def test_where_zeros_and_senses_are_given_they_count():
    arm = robots.puma560("classic", "corke")
    strict = ask(arm, free=())
    zeros = Chain([j.replace(theta=0.5) if i == 2 else j for i, j in enumerate(arm.joints)], "classic", arm.base)
    senses = Chain([j.replace(sign=-1) if i == 2 else j for i, j in enumerate(arm.joints)], "classic", arm.base)
    for told, key, words in ((zeros, "offset", "another zero"), (senses, "sense", "the other way: write -q3 for q3")):
        got = mark(strict, read_answer(strict.asks.request(), told))
        assert (got.verdict, got.misconception) == ("nearly", key), got
        assert words in got.message
        free = ask(arm, free=("zeros", "senses"))
        assert mark(free, read_answer(free.asks.request(), told)).verdict == "right"


def test_ends_that_are_free_may_be_anywhere():
    arm = robots.quickshot()
    moved = Chain(arm.joints, "classic", base=Tz(5.0))
    for free, verdict in ((("ends",), "right"), ((), "nearly")):
        part = ask(arm, free=free)
        assert mark(part, read_answer(part.asks.request(), moved)).verdict == verdict


@pytest.mark.parametrize(("row", "field"), [(3, "alpha"), (3, "a"), (3, "d"), (4, "d")])
def test_mirror_images_are_told(row, field):
    """False friends of the PUMA 560: each of these signs alone gives the mirror image."""
    arm = robots.puma560("classic", "corke")
    part = ask(arm)
    joint = arm.joints[row - 1]
    joints = [*arm.joints[: row - 1], joint.replace(**{field: -getattr(joint, field)}), *arm.joints[row:]]
    got = mark(part, read_answer(part.asks.request(), Chain(joints, "classic", arm.base, arm.tool)))
    assert (got.verdict, got.points) == ("wrong", 1)
    assert "mirror image" in got.message
    assert f"_{row} has the wrong sign" in got.message


def test_a_revolute_joint_taken_for_a_prismatic_one_is_told():
    arm = robots.stanford()
    part = ask(arm)
    joints = [*arm.joints]
    joints[2] = Revolute(d=0.3, a=joints[2].a, alpha=joints[2].alpha)
    got = mark(part, read_answer(part.asks.request(), Chain(joints, "classic")))
    assert got.message == "Joint 3 is prismatic: d varies and θ is constant."


def test_columns_of_the_other_convention_are_told_even_where_they_can_be_read():
    """A θ in the place of a reads as a link that varies, unless one looks again."""
    part = Part("t", "T", 2, Table("classic"), arm=robots.planar(2))
    got = mark(part, read_answer(part.asks.request(), [[0, 0, q, 0] for q in sp.symbols("theta1:3")]))
    assert got.verdict == "unreadable"
    assert "seem to stand as alpha, a, theta, d" in got.message


def test_a_right_row_is_no_slip():
    """With α = 0 a wrong sign of α is no other table: what is wrong here is the end alone."""
    arm = robots.planar(2, "modified")
    part = Part("t", "T", 2, Table("modified"), arm=Chain(arm.joints, "modified"))
    got = mark(part, read_answer(part.asks.request(), arm))
    assert (got.verdict, got.misconception) == ("nearly", "ends")
    assert "frame 2 would not be where the task puts it" in got.message


def test_the_number_that_is_expected_is_kept_back(exercise):
    part = exercise.part("table")

    def said(*changes):
        return mark(part, read_answer(part.asks.request(), with_cells(*changes))).message

    off = "All else fits: it is the a in row 2 that is off."
    assert said((2, "a", 150)) == f"Distance between axes 2 and 3 is 150; by the task it is not. {off}"
    assert "its origin is 250 mm away" in said((4, "d", 0))


def test_a_hint_on_a_modified_table_points_to_its_own_chapter():
    arm = robots.puma560("modified")
    arm = Chain(arm.joints, "modified")
    part = Part("t", "T", 4, Table("modified"), arm=arm)
    links = [(j.a, j.alpha) for j in arm.joints]
    moved = {"row": [*links[-1:], *links[:-1]], "convention": [*links[1:], (0, 0)]}
    for key, section in (("row", "sec-modified-trap-row"), ("convention", "sec-modified-trap-formula")):
        rows = [j.replace(a=a, alpha=alpha) for j, (a, alpha) in zip(arm.joints, moved[key], strict=True)]
        got = mark(part, read_answer(part.asks.request(), Chain(rows, "modified")))
        assert (got.misconception, got.section) == (key, section)


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        ([*RIGHT[:2], *RIGHT[3:]], "The table has 3 rows; the arm has 4 joints, and each needs one. No row holds the "
         "variable of joint 3."),
        ([*RIGHT[:2], *RIGHT[1:]], "More than one row holds the variable of joint 2."),
        ([["q1", 100, 20, -pi / 2], ["q2", 28, 0, pi / 2], ["q3", 250, 0, 0]], "Row 2 seems to be missing"),
        ([[0, 100, 20, -pi / 2], [0, 0, 160, 0], [0, 28, 0, pi / 2], [0, 7, 5, 1.0], [0, 250, 0, 0]],
         "Row 4 seems to be one too many: the others fit."),
    ],
)  # fmt: skip
def test_a_row_too_few_or_too_many_is_named(judge, rows, says):
    got = judge("table", rows)
    assert got.verdict == "wrong"
    assert says in got.message


@pytest.mark.parametrize("rows", [RIGHT[:2], [["q1", 100, 25, 0], ["q2", 1, 2, 1.0], ["q3", 250, 3, 0]]])
def test_no_row_is_named_where_the_others_do_not_fit(judge, rows):
    """Negative control."""
    message = judge("table", rows).message
    assert "each needs one" in message
    assert "missing" not in message
    assert "No row" not in message


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        (with_cells((2, "d", 61)), "All else fits: it is the d in row 2 or the d in row 3 that is off."),
        (with_cells((3, "a", 33)), "All else fits: it is the a in row 3 that is off."),
        (with_cells((2, "alpha", 0.7)), "All else fits: it is the α in row 2 that is off."),
        (with_cells((1, "a", -20), (1, "alpha", pi / 2), (3, "a", 33)), "it is the a in row 3 that is off."),
    ],
)
def test_the_one_number_that_is_off_is_named_and_not_told(judge, rows, says):
    message = judge("table", rows).message
    assert says in message
    assert not any(number in message.partition("All else fits")[2] for number in ("28", "160", "90"))


@pytest.mark.parametrize("rows", [with_cells((2, "a", 150), (3, "a", 33)), with_cells((2, "alpha", 0.7), (3, "d", 9))])
def test_no_number_is_named_where_two_are_off(judge, rows):
    """Negative control."""
    message = judge("table", rows).message
    assert message
    assert "All else fits" not in message
