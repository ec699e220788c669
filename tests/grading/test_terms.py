"""A formula that is wrong in one term: what kind of slip it is is said, and nothing that gives the right one away."""

import numpy as np
import pytest
import sympy as sp
from sympy import cos, sin

from dhlib import robots
from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import Part, load_exercise
from dhlib.grading.forms import Formula
from dhlib.grading.marking import mark
from dhlib.grading.terms import SAYS, slip_in_a_term, taken_apart

t1, t2, t3, t4 = sp.symbols("theta1:5")
A2, A3, D3, D4 = 0.4318, 0.0203, 0.15005, 0.4318


LOWER = cos(t2 + t3)


def wrist(out=0, aside=1, up=0, lower=LOWER):
    """The wrist centre of the PUMA, with something added to an entry or put in place of a factor."""
    reach = A2 * cos(t2) + A3 * cos(t2 + t3) - D4 * sin(t2 + t3) + out
    return [
        cos(t1) * reach - aside * D3 * sin(t1),
        sin(t1) * reach + D3 * cos(t1),
        -A3 * sin(t2 + t3) - A2 * sin(t2) - D4 * lower + up,
    ]


def say(name, part_id, answer):
    part = load_exercise(name).part(part_id)
    return mark(part, read_answer(part.asks.request(), answer))


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (wrist(lower=-cos(t2 + t3)), "In entry 3 all is right but for the sign of one term."),
        (wrist(aside=0), "In entry 1 one term is missing; the rest is right."),
        (wrist(lower=2 * cos(t2 + t3)), "In entry 3 one term is there twice; the rest is right."),
        (wrist(lower=sin(t2 + t3)), "In entry 3 a sine stands for a cosine, or a cosine for a sine, in one place"),
        (wrist(lower=cos(t2)), "In entry 3 one factor belongs to another joint: see the indices."),
        (wrist(lower=1), "In entry 3 one term lacks a factor; the rest is right."),
        (wrist(lower=1.3 * cos(t2 + t3)), "In entry 3 one term has a wrong length or number before it"),
        (wrist(lower=cos(t2) * cos(t3) + sin(t2) * sin(t3)), "In entry 3 all is right but for the sign of one term."),
        (wrist(out=-2 * A2 * cos(t2)), "In each of the entries 1 and 2 all is right but for the sign of one term."),
        ([-wrist()[0], *wrist()[1:]], "Entry 1 is right but for its sign."),
        (
            [wrist(aside=0)[0], wrist()[1], t1**2],
            "In entry 1 one term is missing. 1 other entry differs, too.",
        ),
    ],
)
def test_the_kind_of_slip_is_said(answer, says):
    got = say("puma560", "p", answer)
    assert says in got.message
    assert got.verdict == "wrong"


@pytest.mark.parametrize("answer", [wrist(up=t1**2), wrist(lower=cos(t2 + t3) ** 2), [1, 2, 3], [t1, t2, t3]])
def test_nothing_is_said_where_no_one_slip_explains_it(answer):
    """Negative control."""
    message = say("puma560", "p", answer).message
    assert message
    assert not any(kept in message for kept in ("one term", "bracket", "factor", "sine", "but for"))


def test_the_right_formula_has_no_slip():
    assert say("puma560", "p", wrist()).verdict == "right"


def test_a_slip_in_the_rotation_comes_before_the_length_of_its_column():
    part = load_exercise("puma560").part("T03")
    T = part.chain.T(0, 3, list(sp.symbols("theta1:7")))
    T[0, 0] = cos(t1) * cos(t2 - t3)
    assert say("puma560", "T03", T).message == "In entry n_x all is right but for the sign of one term."
    T[0, 0] = cos(t1) * cos(t2) + cos(t3)
    assert say("puma560", "T03", T).message.startswith("Column n has length")


def test_every_formula_can_be_taken_apart_and_a_sign_in_it_is_told(every):
    """For each term of each formula of the exercise."""
    for part in every.parts:
        asks = part.asks
        if not isinstance(asks, Formula):
            continue
        right = asks.values(part.chain)
        taken = next(iter(taken_apart(part, asks)))
        for coefficients, held in taken.terms:
            places = [place for place in np.ndindex(asks.shape) if abs(coefficients[place]) > 1e-9]
            if asks.shape == (4, 4):
                places = [place for place in places if place[0] < 3]
            for place in places[:1]:
                values = right.copy()
                values[(slice(None), *place)] -= 2 * coefficients[place] * taken.value(held)
                assert "sign" in slip_in_a_term(part, asks, values, right), (part.id, place, held)
        assert slip_in_a_term(part, asks, right, right) == ""


def test_sentences_hold_no_formula():
    assert all(says.count("{entry}") == 1 for says in SAYS.values())


def formula(quantity, n, shape=()):
    symbols = [f"theta{i}" for i in range(1, n + 1)]
    return Part("f", "F", 1, Formula(quantity, shape=shape, symbols=symbols), arm=robots.planar(n))


def judged(part, answer):
    return mark(part, read_answer(part.asks.request(), answer)).message


def test_the_entries_of_a_small_matrix_are_named_by_row_and_column():
    part = formula(lambda arm, q: arm.fk(q)[:2, :2], 2, (2, 2))
    right = sp.Matrix([[cos(t1 + t2), -sin(t1 + t2)], [sin(t1 + t2), cos(t1 + t2)]])
    assert mark(part, read_answer(part.asks.request(), right)).passed
    right[0, 1] = -right[0, 1]
    assert judged(part, right) == "Entry (1, 2) is right but for its sign."


def test_no_slip_is_looked_for_in_what_is_no_sum_of_products():
    part = formula(lambda arm, q: q[0] ** 2 + q[1], 2)
    assert mark(part, read_answer(part.asks.request(), t1**2 + t2)).passed
    assert list(taken_apart(part, part.asks)) == []
    assert "term" not in judged(part, t1**2 - t2)


@pytest.mark.parametrize(("n", "kind"), [(7, "In it all is right but for the sign of one term."), (8, "")])
def test_no_slip_is_looked_for_in_a_formula_of_very_many_angles(n, kind):
    angles = sp.symbols(f"theta1:{n + 1}")
    part = formula(lambda arm, q: np.cos(q).sum(), n)
    assert mark(part, read_answer(part.asks.request(), sum(map(cos, angles)))).passed
    message = judged(part, sum(map(cos, angles[1:])) - cos(t1))
    assert message == kind if kind else "term" not in message
