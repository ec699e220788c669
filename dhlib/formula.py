"""Reading formulas that people type: numbers, pi, names, + - * / and brackets, and nothing that could run."""

from __future__ import annotations

import ast
from typing import Any

from dhlib.errors import DHError
from dhlib.scalars import Scalar

#: Longer text than this is no cell of a table.
LONGEST = 200


def parse_formula(text: str) -> Scalar:
    """Return a typed formula as a float, or as a sympy expression where it holds a name.

    The text is read, never run: only numbers, ``pi`` (or π), names, ``+ - * /`` and brackets are known.

    Parameters
    ----------
    text : str

    Raises
    ------
    DHError
        If the text holds anything else.

    Examples
    --------
    >>> parse_formula("-pi/2")
    -1.5707963267948966
    >>> parse_formula("q1 + π/2")
    q1 + pi/2
    """
    import sympy

    plain = text.strip().replace("−", "-").replace("π", " pi ").replace("θ", "theta").replace("{", "").replace("}", "")
    if not plain or len(plain) > LONGEST:
        raise DHError("it should be a number or a formula such as q1 + pi/2.")
    try:
        tree = ast.parse(plain.strip(), mode="eval")
        value = _value(tree.body)
    except (SyntaxError, ValueError, RecursionError, MemoryError, ZeroDivisionError, OverflowError):
        raise DHError("it should be a number or a formula such as q1 + pi/2.") from None
    if value.has(sympy.zoo, sympy.nan, sympy.oo):
        raise DHError("it divides by zero.")
    return value if value.free_symbols else float(value)


def _value(node: ast.AST) -> Any:
    import sympy

    match node:
        case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
            return sympy.Integer(number) if isinstance(number, int) else sympy.Float(repr(number))
        case ast.Name(id="pi"):
            return sympy.pi
        case ast.Name(id=name):
            return sympy.Symbol(name)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _value(operand)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return _value(left) + _value(right)
        case ast.BinOp(left=left, op=ast.Sub(), right=right):
            return _value(left) - _value(right)
        case ast.BinOp(left=left, op=ast.Mult(), right=right):
            return _value(left) * _value(right)
        case ast.BinOp(left=left, op=ast.Div(), right=right):
            return _value(left) / _value(right)
    raise ValueError(node)
