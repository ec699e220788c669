"""Write given numbers as the source of a cell, so that they stand in one place only: the exercise's own file."""

from __future__ import annotations

from collections.abc import Sequence
from string import ascii_lowercase

import numpy as np
from numpy.typing import ArrayLike


def number(value: float, decimals: int = 6) -> str:
    """A number as one writes it: as short as it can be.

    Examples
    --------
    >>> number(250.0), number(-0.0), number(0.70710678, 4)
    ('250', '0', '0.7071')
    """
    rounded = round(float(value), decimals) + 0.0
    return str(int(rounded)) if rounded == int(rounded) else repr(rounded)


def lengths(unit: str, **values: float) -> str:
    """The cell that gives the lengths of an arm.

    Examples
    --------
    >>> print(lengths("metres", d1=0.4, d2=0.15))
    # Lengths of the arm, in metres
    d1 = 0.4
    d2 = 0.15
    """
    return "\n".join(
        [f"# Lengths of the arm, in {unit}", *(f"{name} = {number(value)}" for name, value in values.items())]
    )


def strings(name: str, texts: Sequence[str]) -> str:
    """A statement that makes a list of texts, one a line.

    Examples
    --------
    >>> print(strings("pairs", ["Rz Tz", "Rx Tz"]))
    pairs = [
        "Rz Tz",
        "Rx Tz",
    ]
    """
    return "\n".join([f"{name} = [", *(f'    "{text}",' for text in texts), "]"])


def lettered(name: str, texts: Sequence[str]) -> str:
    """A statement that makes a dictionary of texts by the letters that an answer is to name.

    Examples
    --------
    >>> print(lettered("claims", ["it turns", "it slides"]))
    claims = {
        "a": "it turns",
        "b": "it slides",
    }
    """
    pairs = zip(ascii_lowercase, texts, strict=False)
    return "\n".join([f"{name} = {{", *(f'    "{letter}": "{text}",' for letter, text in pairs), "}"])


def row(values: ArrayLike, decimals: int = 6) -> str:
    """A row of numbers, in brackets.

    Examples
    --------
    >>> row([1.0, -0.5])
    '[1, -0.5]'
    """
    return f"[{', '.join(number(value, decimals) for value in np.asarray(values, dtype=float))}]"


def matrix(name: str, values: ArrayLike, decimals: int | Sequence[int] = 6) -> str:
    """A statement that makes a matrix, as the formatter would have it: row by row.

    Parameters
    ----------
    name : str
    values : array_like, (m, n)
    decimals : int or sequence of int
        To how many decimals; one for each column, if they differ.

    Examples
    --------
    >>> print(matrix("M", [[1, 0.25], [0, 1]]))
    M = np.array(
        [
            [1, 0.25],
            [0, 1],
        ]
    )
    """
    values = np.asarray(values, dtype=float)
    places = [decimals] * values.shape[1] if isinstance(decimals, int) else list(decimals)
    rows = (
        "[" + ", ".join(number(value, digits) for value, digits in zip(line, places, strict=True)) + "]"
        for line in values
    )
    listed = "".join(f"        {line},\n" for line in rows)
    return f"{name} = np.array(\n    [\n{listed}    ]\n)"


def rounded(values: ArrayLike, decimals: int | Sequence[int]) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """The numbers that a reader of such a source has: those printed, not those behind them.

    Examples
    --------
    >>> rounded([[0.70710678, 123.456]], [4, 1]).tolist()
    [[0.7071, 123.5]]
    """
    values = np.asarray(values, dtype=float)
    places = [decimals] * values.shape[-1] if isinstance(decimals, int) else decimals
    return np.stack([np.round(values[..., k], digits) for k, digits in enumerate(places)], axis=-1) + 0.0
