"""Every misuse gets a DHError (a ValueError) that says what is wrong and what would be right."""

import warnings

import numpy as np
import pytest
import sympy

from dhlib import Axis, Chain, DHError, DHWarning, Prismatic, Revolute, robots

ARM = robots.puma560()
Q = [0.1] * 6


@pytest.mark.parametrize(
    ("misuse", "words"),
    [
        (lambda: ARM.fk([0, 0, 0]), "3 values, but this chain has 6 joints"),
        (lambda: ARM.fk(0.5), "one number"),
        (lambda: ARM.fk([0, 0, 0, 0, 0, np.nan]), "NaN or infinity"),
        (lambda: ARM.fk(np.full((3, 6), np.inf)), "NaN or infinity"),
        (lambda: ARM.fk([np.inf, -np.inf, 0, 0, 0, 0]), "NaN or infinity"),
        (lambda: ARM.fk("home"), "numbers only"),
        (lambda: ARM.fk(["0"] * 6), "numbers only"),
        (lambda: ARM.fk([0j] * 6), "numbers only"),
        (lambda: ARM.fk(None), "numbers only"),
        (lambda: ARM.fk([[0] * 6, [0] * 5]), "numbers only"),
        (lambda: ARM.fk([sympy.Symbol("q1")]), "1 values, but this chain has 6"),
        (lambda: ARM.fk([sympy.nan] * 6), "finite"),
        (lambda: ARM.fk([sympy.Symbol("q"), "x", 0, 0, 0, 0]), "q2 is 'x'"),
        (lambda: ARM.A(0, Q), "no link 0; this chain has links 1 to 6"),
        (lambda: ARM.A(7, Q), "no link 7"),
        (lambda: ARM.A(1.0, Q), "no link 1.0"),
        (lambda: ARM.T(0, 7, Q), "no frame 7; this chain has frames 0 to 6"),
        (lambda: ARM.T(-1, 2, Q), "no frame -1"),
        (lambda: Revolute(alpha=90), "Are these degrees"),
        (lambda: Revolute(offset=-90), "Are these degrees"),
        (lambda: Prismatic(theta=180), "Are these degrees"),
        (lambda: Revolute(theta=0.1), "theta is the variable of this joint"),
        (lambda: Prismatic(d=0.1), "d is the variable of this joint"),
        (lambda: Revolute(twist=1), "no parameter 'twist'"),
        (lambda: Revolute(a="1"), "a of Revolute"),
        (lambda: Revolute(d=float("nan")), "finite"),
        (lambda: Revolute(d=sympy.Matrix([1])), "one number or one symbol"),
        (lambda: Revolute(sign=2), "sign of Revolute"),
        (lambda: Revolute(limits=(1, -1)), "should not be above"),
        (lambda: Revolute(limits=3), "two numbers"),
        (lambda: Chain([Revolute()], "proximal"), "'classic' or 'modified'"),
        (lambda: Chain([Revolute()]), "needs convention="),
        (lambda: Chain.from_table([[0, 1, 2, 3]], joints="R"), "is needed: a table alone does not say which"),
        (lambda: Chain([], "classic"), "at least one joint"),
        (lambda: Chain([[0, 0, 0, 0]], "classic"), "joint 1 is"),
        (lambda: Chain(3, "classic"), "should be a list"),
        (lambda: Chain([Revolute()], "classic", tools=1), "no argument 'tools'"),
        (lambda: Chain([Revolute()], "classic", tool=np.diag([1, 1, -1, 1])), "left-handed"),
        (lambda: Chain([Revolute()], "classic", base=[1, 2]), "4×4"),
        (lambda: Chain([Revolute(a=sympy.Symbol("a"))], "classic").axes(), "needs numbers"),
        (lambda: Chain([Revolute(a=sympy.Symbol("a"))], "classic").fk([[0.0]]), "one joint vector at a time"),
        (lambda: robots.puma560(source="wrong"), "'craig', 'corke', 'akb', 'fgl'"),
        (lambda: robots.puma560("distal"), "unknown"),
        (lambda: robots.pa10_7c(lengths="C"), "'A', 'B', 'B2'"),
        (lambda: robots.planar(0), "1 or more"),
        (lambda: Axis([0, 0, 0], [0, 0, 0]), "point along the axis"),
        (lambda: Axis([0, 0], [0, 0, 1]), "three numbers"),
        (lambda: Axis([0, 0, 0], [0, 0, 1], "X"), "revolute"),
    ],
)  # fmt: skip
def test_misuse(misuse, words):
    with pytest.raises(DHError, match=words) as caught:
        misuse()
    assert isinstance(caught.value, ValueError)
    assert len(str(caught.value)) < 300


@pytest.mark.parametrize("q", [[30, 45, 0, 0, 0, 0], np.full((4, 6), 90.0)])
def test_degrees_draw_a_warning(q):
    with pytest.warns(DHWarning, match="Are these degrees"):
        ARM.fk(q)


def test_lengths_and_two_turns_draw_none():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ARM.fk([4 * np.pi, -4 * np.pi, 0, 0, 0, 0])
        robots.stanford().fk([0, 0, 300, 0, 0, 0])
        Revolute(alpha=2 * np.pi, offset=-2 * np.pi)


def test_a_warning_points_to_the_caller():
    with pytest.warns(DHWarning) as caught:
        ARM.fk([90, 0, 0, 0, 0, 0])
    assert caught[0].filename == __file__
