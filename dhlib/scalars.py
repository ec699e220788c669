"""Angles and lengths, as numbers or as symbols.

Everything above this module is written once, in terms of ``+``, ``*`` and :func:`cos_sin`. Here is the only
place that knows whether a value is a number, an array of numbers or a sympy expression.
"""

from __future__ import annotations

import math
import sys
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import NDArray

from dhlib.errors import DHError

Scalar = Any
"""A float, an array of floats or a sympy expression."""

FloatArray = NDArray[np.float64]

QUARTER = math.pi / 2
#: A cosine or sine below this is the rounding of a quarter turn, of up to two whole turns, and is taken as 0.
#: (``math.sin(4 * math.pi)`` is -4.9e-16.)
ROUNDING = 5e-16


def is_symbolic(value: object) -> bool:
    """Tell whether `value` is a sympy object, without importing sympy.

    Examples
    --------
    >>> is_symbolic(1.5)
    False
    >>> import sympy
    >>> is_symbolic(sympy.Symbol("theta1"))
    True
    """
    sympy = sys.modules.get("sympy")
    if sympy is None:
        return False
    try:
        return isinstance(value, (sympy.Basic, sympy.MatrixBase))
    except AttributeError:  # another thread is importing sympy right now, so nothing can be of it yet
        return False


def has_symbols(values: Any) -> bool:
    """Tell whether a value, or a nested list or array of values, holds a sympy object."""
    if "sympy" not in sys.modules or isinstance(values, (int, float, str)):
        return False
    if is_symbolic(values):
        return True
    if isinstance(values, np.ndarray):
        return values.dtype == object and any(is_symbolic(value) for value in values.flat)
    if isinstance(values, (list, tuple)):
        return any(type(value) is not float and has_symbols(value) for value in values)
    return False


def is_number(value: object) -> TypeGuard[float]:
    """Tell whether `value` is one real number: a Python, numpy or sympy number, but no bool and no symbol."""
    if isinstance(value, bool | np.bool_):
        return False
    if isinstance(value, int | float | np.integer | np.floating):
        return True
    return is_symbolic(value) and bool(getattr(value, "is_number", False)) and bool(value.is_real)  # type: ignore[attr-defined]


def read_scalar(value: Any, what: str) -> Scalar:
    """Return `value` as a float or a sympy expression; `what` names it in the message of a refusal.

    Raises
    ------
    DHError
        If `value` is no real finite number and no sympy expression.
    """
    if is_symbolic(value):
        if not hasattr(value, "free_symbols") or getattr(value, "is_Matrix", False):
            raise DHError(f"{what} is {value!r}; it should be one number or one symbol.")
        if value.is_number and not value.is_finite:
            raise DHError(f"{what} is {value}; it should be finite.")
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if not is_number(value):
        raise DHError(f"{what} is {value!r}; it should be a number.")
    number = float(value)
    if not math.isfinite(number):
        raise DHError(f"{what} is {number}; it should be a finite number.")
    return number


def read_array(value: Any, what: str) -> FloatArray:
    """Return numbers of any shape as an array of floats.

    Raises
    ------
    DHError
        If anything in `value` is not a finite real number.
    """
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf":
            if array.dtype.kind != "O":
                raise TypeError
            array = np.array([float(number) for number in array.flat]).reshape(array.shape)
        array = array.astype(np.float64)
    except (TypeError, ValueError):
        shown = repr(value) if len(repr(value)) < 80 else repr(value)[:77] + "..."
        raise DHError(f"{what} is {shown}; it should hold numbers only.") from None
    if not np.all(np.isfinite(array)):
        raise DHError(f"{what} holds NaN or infinity; every entry should be a finite number.")
    return array


def quarter_turns(angle: Scalar) -> int | None:
    """Return k where `angle` is k quarter turns (k π/2), else None.

    One unit in the last place is allowed, so that ``np.deg2rad(270)`` counts as three quarter turns.

    Examples
    --------
    >>> quarter_turns(-math.pi / 2)
    -1
    >>> quarter_turns(1.0) is None
    True
    """
    if is_symbolic(angle):
        turns = 2 * angle / sys.modules["sympy"].pi
        return int(turns) if turns.is_Integer else None
    turns = round(angle / QUARTER)
    return turns if abs(angle - turns * QUARTER) <= 2.3e-16 * abs(angle) else None


def cos_sin(angle: Scalar) -> tuple[Scalar, Scalar]:
    """Return the cosine and the sine, exactly 0 and ±1 at quarter turns.

    Parameters
    ----------
    angle : float, array or sympy expression
        In radians. An array gives two arrays of its shape.

    Examples
    --------
    >>> cos_sin(math.pi / 2)
    (0.0, 1.0)
    """
    if type(angle) is not float:  # asked first, since one pose asks it for every joint
        if is_symbolic(angle):
            sympy = sys.modules["sympy"]
            return sympy.cos(angle), sympy.sin(angle)
        if isinstance(angle, np.ndarray):
            return _cos_sin_of_array(angle)
    c, s = math.cos(angle), math.sin(angle)
    return (0.0 if -ROUNDING < c < ROUNDING else c, 0.0 if -ROUNDING < s < ROUNDING else s)


def _cos_sin_of_array(angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """From the tangent of half the angle: one function in place of two, and one that processors are quicker at."""
    t = np.tan(0.5 * angle)
    square = t * t
    cosine, sine = (1 - square) / (1 + square), 2 * t / (1 + square)
    return _without_rounding(cosine), _without_rounding(sine)


def _without_rounding(values: FloatArray) -> FloatArray:
    """Set to 0, in place, what is only the rounding of a quarter turn in an array of cosines or sines."""
    values[np.abs(values) < ROUNDING] = 0.0
    return values


def turn_by_quarters(cosine: Scalar, sine: Scalar, quarters: int) -> tuple[Scalar, Scalar]:
    """Return cosine and sine of an angle that is `quarters` quarter turns further on, without rounding."""
    match quarters % 4:
        case 0:
            return cosine, sine
        case 1:
            return -sine, cosine
        case 2:
            return -cosine, -sine
        case _:
            return sine, -cosine


def exact(value: Scalar, *, angle: bool = False) -> Scalar:
    """Return a number as sympy shows it best: integers as integers, multiples of 15° as multiples of π.

    Examples
    --------
    >>> exact(-math.pi / 2, angle=True), exact(160.0), exact(0.5)
    (-pi/2, 160, 0.500000000000000)
    """
    import sympy

    if is_symbolic(value):
        return value
    number = float(value)
    if angle:
        twelfths = round(12 * number / math.pi)
        if abs(number - twelfths * math.pi / 12) <= 4.5e-16 * abs(number):
            return twelfths * sympy.pi / 12
    return sympy.Integer(int(number)) if number.is_integer() else sympy.Float(repr(number))


def to_float(value: Scalar) -> float | None:
    """Return the value as a float, or None where it holds a free symbol."""
    if is_symbolic(value):
        return None if value.free_symbols else float(value)
    return float(value)
