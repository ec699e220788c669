import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from dhlib import DHError, Rx, Rz, Tx, Tz, classic, modified

NUMBER = st.floats(-6, 6)


@given(NUMBER, NUMBER, NUMBER, NUMBER)
def test_each_is_its_four_steps(theta, d, a, alpha):
    assert_allclose(classic(theta, d, a, alpha), Rz(theta) @ Tz(d) @ Tx(a) @ Rx(alpha), atol=4e-15)
    assert_allclose(modified(alpha, a, theta, d), Rx(alpha) @ Tx(a) @ Rz(theta) @ Tz(d), atol=4e-15)


def test_each_is_its_four_steps_in_symbols():
    theta, d, a, alpha = sympy.symbols("theta d a alpha")
    assert classic(theta, d, a, alpha) == Rz(theta) * Tz(d) * Tx(a) * Rx(alpha)
    assert modified(alpha, a, theta, d) == sympy.expand(Rx(alpha) * Tx(a) * Rz(theta) * Tz(d))


def test_they_differ():
    assert not np.allclose(classic(0.3, 1, 2, 0.5), modified(0.5, 2, 0.3, 1))


def test_exact_twists_beside_symbols():
    theta = sympy.Symbol("theta")
    link = classic(theta, 0, 0, sympy.pi / 2)
    assert link[1, 1] == 0
    assert link[2, 1] == 1


@pytest.mark.parametrize("link", [classic, modified])
def test_numbers_beside_a_symbol_stay_exact(link):
    theta = sympy.Symbol("theta")
    quarter = -np.pi / 2
    arm = link(theta, 100, 20, quarter) if link is classic else link(quarter, 20, theta, 100)
    assert arm.atoms(sympy.Float) == set()
    assert arm[0, 3] == (20 * sympy.cos(theta) if link is classic else 20)


def test_broadcasting():
    links = classic(np.zeros((5, 1)), 0, np.array([1.0, 2.0]), np.pi / 2)
    assert links.shape == (5, 2, 4, 4)
    assert_array_equal(links[3, 1, :3, 3], [2, 0, 0])


@pytest.mark.parametrize("link", [classic, modified])
@pytest.mark.parametrize("place", range(4))
def test_no_number_is_refused_by_name(link, place):
    arguments: list = [0.0] * 4
    arguments[place] = "90"
    name = link.__code__.co_varnames[place]
    with pytest.raises(DHError, match=rf"^{name} is '90'"):
        link(*arguments)


def test_an_array_beside_a_symbol_is_refused():
    with pytest.raises(DHError, match="d is an array"):
        classic(sympy.Symbol("theta"), [1, 2], 0, 0)
