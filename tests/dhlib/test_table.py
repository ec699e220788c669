import numpy as np
import pandas as pd
import pytest
import sympy

from dhlib import Chain, DHError, Revolute, robots
from dhlib.formula import parse_formula

ROWS = [["q1", 100, 20, -90], ["q2", 0, 160, 0], ["q3", 28, 0, 90], ["q4", 250, 0, 0]]
ZEROS = [[0, 100, 20, -90], [0, 0, 160, 0], [0, 28, 0, 90], [0, 250, 0, 0]]
READ = {"convention": "classic", "degrees": True, "unit": "mm"}


@pytest.mark.parametrize(
    "rows",
    [
        ROWS,
        tuple(map(tuple, ROWS)),
        [["q_1", *ROWS[0][1:]], ["theta2", *ROWS[1][1:]], [sympy.Symbol("q3"), *ROWS[2][1:]], ["θ_{4}", *ROWS[3][1:]]],
        np.array(ROWS, dtype=object),
        sympy.Matrix([[sympy.Symbol(row[0]), *row[1:]] for row in ROWS]),
        pd.DataFrame(ROWS, columns=["theta", "d", "a", "alpha"]),
        pd.DataFrame(ROWS, columns=["θ", "d", "a", "α"])[["α", "a", "θ", "d"]],
    ],
)
def test_whatever_people_write(rows):
    assert Chain.from_table(rows, **READ) == robots.quickshot()


@pytest.mark.parametrize("rows", [ZEROS, np.array(ZEROS), np.array(ZEROS, dtype=float)])
def test_plain_numbers_are_the_zeros(rows):
    assert Chain.from_table(rows, joints="RRRR", **READ) == robots.quickshot()


def test_columns_in_any_order_and_radians():
    rows = [[alpha * np.pi / 180, a, d, theta] for theta, d, a, alpha in ROWS]
    assert Chain.from_table(rows, columns="alpha, a, d, theta", convention="classic") == robots.quickshot()


def test_modified_columns_are_the_default_of_that_convention():
    rows = [[0, 0, "q1", 100], [-90, 20, "q2", 0], [0, 160, "q3", 28], [90, 0, "q4", 250]]
    assert Chain.from_table(rows, convention="modified", degrees=True) == robots.quickshot("modified")


def test_signs_and_offsets():
    rows = [["-q1 + pi/2", 0, 1, 0], [sympy.Symbol("q2") - sympy.pi / 2, 0, 1, 0], [0.5, "0.1 - q3", 0, 0]]
    joints = Chain.from_table(rows, convention="classic").joints
    assert (joints[0].sign, joints[0].offset) == (-1, np.pi / 2)
    assert (joints[1].sign, joints[1].offset) == (1, -np.pi / 2)
    assert (joints[2].kind, joints[2].sign, joints[2].offset, joints[2].theta) == ("P", -1, 0.1, 0.5)


def test_a_cell_may_be_an_array_of_one_number():
    row = ["q1", np.array(0.25), np.array(2), np.pi / 2]
    (joint,) = Chain.from_table([row], convention="classic").joints
    assert joint == Revolute(d=0.25, a=2, alpha=np.pi / 2)
    with pytest.raises(DHError, match="d in row 1 is nan; it should be a finite number"):
        Chain.from_table([["q1", np.array(np.nan), 0, 0]], convention="classic")


def test_degrees_beside_symbols():
    joints = Chain.from_table([["q1 + 90", 0, 1, "-90"]], convention="classic", degrees=True).joints
    assert joints[0].offset == pytest.approx(np.pi / 2)
    assert joints[0].alpha == pytest.approx(-np.pi / 2)


@pytest.mark.parametrize(
    ("rows", "options", "words"),
    [
        ([], {}, "empty"),
        (7, {}, "empty or no table"),
        ([[0, 0, 0]], {"joints": "R"}, "row 1 of the table has 3 entries"),
        ([[0, 0, 0, 0]], {}, "neither theta nor d is variable"),
        ([["q1", "q1", 0, 0]], {}, "both theta and d are variable"),
        ([["q1", 0, 0, 0]], {"joints": "P"}, "joints says P"),
        ([["q1", 0, 0, 0]], {"joints": "RR"}, "one letter per row"),
        ([["q1", 0, 0, 0]], {"joints": "X"}, "R or P"),
        ([["2*q1", 0, 0, 0]], {}, "no joint variable"),
        ([["q1", 0, 0, 0]], {"columns": "theta d a beta"}, "columns are"),
        ([["q1", 0, None, 0]], {}, "a in row 1 is None"),
        ([["q1", 0, "two", "__import__('os')"]], {}, "alpha in row 1"),
        ([["q1", 0, float("nan"), 0]], {}, "finite"),
        ([["q1", 0, 0, 90]], {}, "Are these degrees"),
        ([["q1", 0, True, 0]], {}, "a in row 1"),
    ],
)
def test_mistakes_are_said(rows, options, words):
    with pytest.raises(DHError, match=words):
        Chain.from_table(rows, convention="classic", **options)


@pytest.mark.parametrize(
    ("text", "value"),
    [("pi/2", np.pi / 2), ("−π", -np.pi), ("-(1+2)*3/4", -2.25), ("1e-3", 1e-3), (" 2 ", 2), ("+pi", np.pi)],
)
def test_formulas(text, value):
    assert parse_formula(text) == pytest.approx(value)


@pytest.mark.parametrize(
    "text",
    ["", "1/0", "q.real", "f(1)", "9**9**9", "[1]", "1 if 1 else 2", "'a'", "(" * 300, "lambda: 1", "1j", "True"],
)
def test_what_is_no_formula_is_refused(text):
    with pytest.raises(DHError):
        parse_formula(text)
