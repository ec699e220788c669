"""Reading DH tables as people write them: lists, arrays, data frames; numbers, symbols, text."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np

from dhlib.errors import DHError
from dhlib.joints import Joint, Prismatic, Revolute
from dhlib.scalars import Scalar, is_number, is_symbolic

DEFAULT_COLUMNS = {"classic": ("theta", "d", "a", "alpha"), "modified": ("alpha", "a", "theta", "d")}
ALIASES = {
    "θ": "theta", "theta_i": "theta", "θ_i": "theta",
    "α": "alpha", "alpha_i": "alpha", "α_i": "alpha", "alpha_i-1": "alpha", "alpha_{i-1}": "alpha", "α_{i-1}": "alpha",
    "d_i": "d", "a_i": "a", "a_i-1": "a", "a_{i-1}": "a",
}  # fmt: skip
#: A joint variable: a letter or a Greek name, an index, nothing else.
VARIABLE = re.compile(r"^(q|theta|θ|d)_?\{?(\d+)\}?$")


def read_table(rows: Any, columns: str | Any, joints: str, convention: str, degrees: bool) -> list[Joint]:
    """Return the joints of a table; see :meth:`dhlib.Chain.from_table`."""
    cells, names = _cells_and_columns(rows, columns, convention)
    if joints and (not isinstance(joints, str) or set(joints) - set("RP") or len(joints) != len(cells)):
        raise DHError(
            f"joints={joints!r} does not fit; it should be one letter per row, R or P: {len(cells)} letters here."
        )
    return [
        _read_row(dict(zip(names, row, strict=True)), i, joints[i - 1] if joints else "", degrees)
        for i, row in enumerate(cells, 1)
    ]


def _cells_and_columns(rows: Any, columns: Any, convention: str) -> tuple[list[list[Any]], list[str]]:
    if hasattr(rows, "columns") and hasattr(rows, "to_numpy"):  # a data frame brings its column names
        columns = columns or [str(name) for name in rows.columns]
        rows = rows.to_numpy().tolist()
    if hasattr(rows, "tolist"):
        rows = rows.tolist()
    names = columns.replace(",", " ").split() if isinstance(columns, str) else [str(name) for name in columns]
    names = [ALIASES.get(name, name) for name in names] or list(DEFAULT_COLUMNS[convention])
    if sorted(names) != ["a", "alpha", "d", "theta"]:
        raise DHError(
            f"columns are {' '.join(names)!r}; they should be theta, d, a and alpha, each once, in any order."
        )
    if not isinstance(rows, list | tuple) or not rows:
        raise DHError("the table is empty or no table; give a list of rows with four entries each.")
    cells = []
    for i, row in enumerate(rows, 1):
        row = row.tolist() if hasattr(row, "tolist") else row
        if not isinstance(row, list | tuple) or len(row) != 4:
            size = f"{len(row)} entries" if isinstance(row, list | tuple) else "no entries"
            raise DHError(f"row {i} of the table has {size}; it should have four: {', '.join(names)}.")
        cells.append(list(row))
    return cells, names


def _read_row(row: dict[str, Any], i: int, letter: str, degrees: bool) -> Joint:
    values: dict[str, Scalar] = {}
    signs: dict[str, int] = {}
    for name, cell in row.items():
        angle = name in ("theta", "alpha")
        value = _read_cell(cell, f"{name} in row {i}")
        sign, rest = _split_variable(value, i) if name in ("theta", "d") else (0, value)
        if sign:
            signs[name] = sign
        values[name] = _in_radians(rest, cell, degrees) if angle else rest
    if len(signs) == 2:
        raise DHError(
            f"row {i}: both theta and d are variable; exactly one should be: "
            "theta of a revolute joint, d of a prismatic one."
        )
    kind = {"theta": "R", "d": "P"}[next(iter(signs))] if signs else letter
    if not kind:
        raise DHError(
            f"row {i}: neither theta nor d is variable. Write the joint variable, such as q{i}, or give joints='RRP…', "
            "one letter per row; then the number is the zero of the joint."
        )
    if letter and letter != kind:
        raise DHError(f"row {i}: joints says {letter}, but {next(iter(signs))} is variable, which makes it {kind}.")
    sign = next(iter(signs.values()), 1)
    try:
        if kind == "R":
            return Revolute(d=values["d"], a=values["a"], alpha=values["alpha"], offset=values["theta"], sign=sign)
        return Prismatic(theta=values["theta"], a=values["a"], alpha=values["alpha"], offset=values["d"], sign=sign)
    except DHError as error:
        raise DHError(f"row {i}: {error}") from None


def _read_cell(cell: Any, what: str) -> Scalar:
    if isinstance(cell, str):
        return _parse(cell, what)
    if is_symbolic(cell) and getattr(cell, "free_symbols", None):
        return cell
    if isinstance(cell, np.ndarray) and cell.ndim == 0:
        cell = cell.item()
    if not is_number(cell):
        raise DHError(f"{what} is {cell!r}; it should be a number or a joint variable such as q1 + pi/2.")
    if not math.isfinite(cell):
        raise DHError(f"{what} is {cell}; it should be a finite number.")
    return float(cell)


def _parse(text: str, what: str) -> Scalar:
    """Read a cell of text without ever evaluating it as Python."""
    from dhlib.formula import parse_formula

    try:
        return parse_formula(text)
    except DHError as error:
        raise DHError(f"{what} is {text!r}: {error}") from None


def _split_variable(value: Scalar, i: int) -> tuple[int, Scalar]:
    """Sign of the joint variable in a cell (0 if there is none) and what is left without it."""
    if not is_symbolic(value):
        return 0, value
    variables = [symbol for symbol in value.free_symbols if (m := VARIABLE.match(symbol.name)) and int(m[2]) == i]
    if not variables:
        return 0, value
    variable = variables[0]
    sign = value.coeff(variable)
    rest = value - sign * variable
    if sign not in (1, -1) or rest.has(variable):
        raise DHError(
            f"row {i}: {value} is no joint variable; it should be {variable} or -{variable}, "
            "with a constant added at most."
        )
    return int(sign), rest if rest.free_symbols else float(rest)


def _in_radians(value: Scalar, cell: Any, degrees: bool) -> Scalar:
    if not degrees or (isinstance(cell, str) and "pi" in cell.replace("π", "pi")):
        return value
    if is_symbolic(value):
        import sympy

        return value if value.has(sympy.pi) else value * sympy.pi / 180
    return math.radians(value)
