import sys
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from dhlib import DHError, Rx, Ry, Rz, Tx, Ty, Tz, inverse
from dhlib.scalars import cos_sin, has_symbols, is_symbolic, quarter_turns, read_array, read_scalar, to_float
from dhlib.transforms import pose_fault, read_pose

ROTATIONS = {"x": Rx, "y": Ry, "z": Rz}
TRANSLATIONS = {"x": Tx, "y": Ty, "z": Tz}
ANGLES = st.floats(-12, 12)
SYMBOL = sympy.Symbol("theta")


@pytest.mark.parametrize("k", range(-4, 5))
@pytest.mark.parametrize("name", "xyz")
def test_quarter_turns_are_exact(name, k):
    turned = ROTATIONS[name](k * np.pi / 2)
    assert set(np.unique(turned)) <= {-1.0, 0.0, 1.0}
    assert not np.any(np.signbit(turned) & (turned == 0)), "no -0"
    assert_array_equal(turned, np.linalg.matrix_power(ROTATIONS[name](np.pi / 2), k % 4))


def test_positive_turns_follow_the_right_hand():
    x, y, z = np.eye(3)
    assert_array_equal(Rz(np.pi / 2)[:3, :3] @ x, y)
    assert_array_equal(Rx(np.pi / 2)[:3, :3] @ y, z)
    assert_array_equal(Ry(np.pi / 2)[:3, :3] @ z, x)


@given(ANGLES, ANGLES)
def test_turns_about_one_axis_add(one, other):
    for rotation in ROTATIONS.values():
        assert_allclose(rotation(one) @ rotation(other), rotation(one + other), atol=3e-15)


@given(ANGLES, ANGLES, ANGLES, st.floats(-9, 9))
def test_products_are_poses(alpha, beta, gamma, length):
    pose = Rx(alpha) @ Tx(length) @ Ry(beta) @ Ty(length) @ Rz(gamma) @ Tz(length)
    assert pose_fault(pose) == ""
    assert_allclose(inverse(pose) @ pose, np.eye(4), atol=1e-13)
    assert_allclose(inverse(pose), np.linalg.inv(pose), atol=1e-13)


def test_arrays_of_any_shape():
    angles = np.linspace(-3, 3, 6).reshape(2, 3)
    turned = Rz(angles)
    assert turned.shape == (2, 3, 4, 4)
    assert_allclose(turned[1, 2], Rz(angles[1, 2]), rtol=0, atol=5e-16)
    assert Tx([1, 2, 3]).shape == (3, 4, 4)
    assert inverse(turned).shape == (2, 3, 4, 4)


def test_symbols_stay_symbols():
    theta, length = sympy.symbols("theta l")
    assert Rz(theta)[0, 1] == -sympy.sin(theta)
    assert Rx(sympy.pi / 2) == sympy.Matrix([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    product = Tx(length) * Rz(theta)
    assert sympy.simplify(inverse(product) * product) == sympy.eye(4)


NO_NUMBERS = [
    *("1", None, float("nan"), float("inf"), 1j, True, [1, "x"], ["1", "2"], [True, False]),
    *(sympy.nan, sympy.oo, sympy.Matrix([1])),
]


@pytest.mark.parametrize("wrong", NO_NUMBERS)
@pytest.mark.parametrize("transform", [*ROTATIONS.values(), *TRANSLATIONS.values()])
def test_no_number_is_refused(transform, wrong):
    with pytest.raises(DHError, match=f"of {transform.__name__}"):
        transform(wrong)


def test_numbers_of_any_kind_are_read():
    lengths = np.array([1, Fraction(1, 2), np.float32(0.25)], dtype=object)
    assert_array_equal(Tx(lengths)[:, 0, 3], [1, 0.5, 0.25])


def test_an_array_without_axes_is_one_number():
    assert repr(read_scalar(np.array(0.5), "a")) == "0.5"
    with pytest.raises(DHError, match="a is nan; it should be a finite number"):
        read_scalar(np.array(np.nan), "a")


@pytest.mark.parametrize("one", [1, np.int64(1), np.float64(1.0)])
def test_cosine_and_sine_of_a_number_are_numbers_whatever_its_type(one):
    assert cos_sin(one) == cos_sin(1.0)
    assert cos_sin(one * 0) == (1.0, 0.0)


@pytest.mark.parametrize(("letters", "end"), [(3, "'xxx'"), (200, "x...")])
def test_a_refusal_shows_what_was_given_in_no_more_than_a_line(letters, end):
    with pytest.raises(DHError) as refused:
        read_array("x" * letters, "q")
    shown = str(refused.value).split("; ")[0]
    assert shown.endswith(end)
    assert len(shown) <= 90


@pytest.mark.parametrize("k", [k for k in range(-8, 9) if k])
def test_a_quarter_turn_may_be_off_by_its_last_digit(k):
    """As np.deg2rad(270) is, on either side."""
    for toward in (-np.inf, np.inf):
        assert quarter_turns(float(np.nextafter(k * np.pi / 2, toward))) == k
    assert quarter_turns(k * np.pi / 2 * (1 + 1e-15)) is None


def test_nothing_is_a_symbol_while_sympy_is_being_imported(monkeypatch):
    monkeypatch.setitem(sys.modules, "sympy", SimpleNamespace())
    assert not is_symbolic(1.0)
    assert not has_symbols([1.0, "theta"])


@pytest.mark.parametrize(
    ("value", "number"), [(2, 2.0), (sympy.pi, np.pi), (sympy.Rational(1, 4), 0.25), (SYMBOL, None)]
)
def test_a_scalar_is_a_float_where_it_can_be(value, number):
    assert to_float(value) == number


def test_a_pose_of_symbols_is_taken_as_it_is():
    pose = Rz(SYMBOL) * Tx(2)
    assert read_pose(pose, "base") == pose


@pytest.mark.parametrize(
    ("spoilt", "words"),
    [
        (np.eye(3), "shape"),
        (sympy.eye(3), "shape"),
        (sympy.diag(SYMBOL, 1, 1), "shape"),
        (np.diag([1, 1, -1, 1]), "left-handed"),
        (np.diag([2, 1, 1, 1]), "column n has length 2"),
        (Tx(3).T, "transposed"),
        (np.diag([1, 1, 1, 2]), "last row"),
        (np.array([[1, 0.6, 0, 0], [0, 0.8, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]), "columns n and o"),
        ([[1, 2], "x"], "numbers only"),
        (np.full((4, 4), np.nan), "NaN"),
    ],
)
def test_what_is_no_pose_is_said(spoilt, words):
    with pytest.raises(DHError, match=words):
        read_pose(spoilt, "base")


@pytest.mark.parametrize(
    "values",
    [SYMBOL, [1.0, SYMBOL], (0, [SYMBOL]), np.array([1.0, SYMBOL]), np.array([[0, SYMBOL]]), sympy.Matrix([SYMBOL])],
    ids=lambda values: type(values).__name__,
)
def test_symbols_are_seen_in_any_container(values):
    assert has_symbols(values)


@pytest.mark.parametrize("values", [1.0, "theta", [1, 2], np.array([1.0]), np.array([1, 2], dtype=object), None])
def test_numbers_are_no_symbols(values):
    assert not has_symbols(values)
