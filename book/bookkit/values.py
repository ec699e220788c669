"""Values as a reader wants to see them: rounded, without noise, in text or in LaTeX."""

from __future__ import annotations

import math
from collections.abc import Iterable
from fractions import Fraction
from typing import Any

import numpy as np

NOISE = 1e-12
"""Below this a float is what rounding left of zero, and is shown as 0: no page shows 6e-17."""

THIN_SPACE = "\u202f"
MINUS = "\u2212"


def text(value: Any, digits: int = 4, unit: str = "") -> str:
    """Return a number as text, in `digits` significant digits.

    Parameters
    ----------
    value : number
        A Python, numpy or sympy number.
    digits : int
        Significant digits of a float; integers are shown whole.
    unit : str
        Put behind the number.

    Returns
    -------
    str

    Examples
    --------
    >>> text(0.43180, unit="m").split()
    ['0.4318', 'm']
    >>> text(6.1e-17), text(-0.70710678), text(90.0, unit="°")
    ('0', '−0.7071', '90°')
    """
    shown = _rounded(value, digits)
    if "e" in shown:
        mantissa, exponent = shown.split("e")
        shown = f"{mantissa}·10{_superscript(int(exponent))}"
    space = "" if unit in ("", "°", "%") else THIN_SPACE
    return shown.replace("-", MINUS) + space + unit


def latex(value: Any, digits: int = 4) -> str:
    r"""Return a number, a sympy expression, a vector or a matrix as LaTeX.

    Parameters
    ----------
    value : number, sympy expression or matrix, array_like
        What to show. A vector becomes a column.
    digits : int
        Significant digits of a float.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If `value` has more than two dimensions, or is not finite.

    Examples
    --------
    >>> latex([[6.1e-17, -1.0], [0.70710678, 2]])
    '\\begin{bmatrix}0 & -1 \\\\ 0.7071 & 2\\end{bmatrix}'
    >>> import sympy
    >>> latex(sympy.cos(sympy.Symbol("theta_1")))
    '\\cos {\\theta_{1}}'
    """
    if hasattr(value, "tolist") or isinstance(value, list | tuple):
        return _matrix(value, digits)
    if hasattr(value, "free_symbols"):
        return _expression(value, digits)
    shown = _rounded(value, digits)
    if "e" in shown:
        mantissa, exponent = shown.split("e")
        return rf"{mantissa}\times 10^{{{int(exponent)}}}"
    return shown


def _matrix(value: Any, digits: int) -> str:
    rows = value.tolist() if hasattr(value, "tolist") else list(value)
    if not isinstance(rows, list):  # a numpy scalar
        return latex(rows, digits)
    columns = [row if isinstance(row, Iterable) and not isinstance(row, str) else [row] for row in rows]
    if any(isinstance(entry, list | tuple) for row in columns for entry in row):
        raise ValueError("Only vectors and matrices can be shown: take one matrix of the batch, as in T[0].")
    body = r" \\ ".join(" & ".join(latex(entry, digits) for entry in row) for row in columns)
    return rf"\begin{{bmatrix}}{body}\end{{bmatrix}}"


def _expression(value: Any, digits: int) -> str:
    import sympy

    def calm(number: Any) -> Any:
        if abs(number) < NOISE:
            return sympy.Integer(0)
        whole = round(float(number))
        return sympy.Integer(whole) if abs(number - whole) < NOISE else sympy.Float(number, digits)

    floats = {number: calm(number) for number in value.atoms(sympy.Float)}
    return str(sympy.latex(value.xreplace(floats), fold_func_brackets=True))


def _rounded(value: Any, digits: int) -> str:
    if isinstance(value, Fraction):
        value = float(value)
    if isinstance(value, bool | np.bool_ | str):
        raise ValueError(f"A number was expected, not {value!r}.")
    if isinstance(value, int | np.integer):
        return str(int(value))
    number = float(value)
    if not math.isfinite(number):
        raise ValueError(f"A page shows finite numbers, and this one is {number}.")
    if abs(number) < NOISE:
        return "0"
    return f"{number:.{digits}g}"


def _superscript(exponent: int) -> str:
    return str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
