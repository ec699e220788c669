"""The untrusted half: read what a student handed in, into plain JSON.

`read_answer` runs beside the student's code, so it knows the request and nothing of the solution. It never raises:
what cannot be read becomes a *fault*, ``{"fault": kind, …}``, for which `faults` has the words.

A reading is one of

* ``{"values": [array, …]}``, one nested list of numbers per probe (null where a formula has no finite value);
* ``{"table": {"rows": [[cell, …], …], "columns": …, "joints": …, "convention": …, "base": …, "tool": …}}``;
* ``{"choice": text}``, or ``{"choices": [text, …]}`` with reasons.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

Reading = dict[str, Any]
Request = dict[str, Any]

#: Beyond these nothing is an answer.
LARGEST_NUMBER = 1e9
LONGEST_TEXT = 200
MOST_ENTRIES = 400
MOST_NAMES = 6
MOST_CHOICES = 20
DEEPEST = 4
MOST_OPERATIONS = 20_000

#: Other ways to write the symbol of joint i.
JOINT_SYMBOL = re.compile(r"^(?:theta|θ|th|t|q|d)_?\{?(\d+)\}?$")
#: Plain symbols for cosines and sines of joint angles and of their sums: C1, s23.
SHORT_SYMBOL = re.compile(r"^([CScs])_?\{?(\d+)\}?$")


class _Fault(Exception):
    """Carries a fault out of nested readers."""

    def __init__(self, kind: str, **details: Any) -> None:
        super().__init__(kind)
        self.reading: Reading = {"fault": kind, **details}


class _Missing:
    """Stands for a variable that does not exist."""

    def __repr__(self) -> str:
        return "MISSING"


MISSING = _Missing()


def read_answer(request: Request, value: Any) -> Reading:
    """Read an answer.

    Parameters
    ----------
    request : dict
        What a part asks for: ``part.asks.request()``, or the same through JSON.
    value
        Whatever the student's variable holds; `MISSING` if there is none.

    Returns
    -------
    dict
        Plain JSON of bounded size, a reading or a fault.

    Examples
    --------
    >>> read_answer({"form": "numbers", "shape": [2]}, (1, 2.5))
    {'values': [[1.0, 2.5]]}
    >>> read_answer({"form": "numbers", "shape": [2]}, ...)
    {'fault': 'missing'}
    """
    try:
        if value is MISSING:
            raise _Fault("undefined")
        if value is None or value is Ellipsis:
            raise _Fault("missing")
        return _READERS[request["form"]](request, value)
    except _Fault as fault:
        return fault.reading
    except Exception as error:  # the student's own objects may raise anything
        return {"fault": "unreadable", "type": _name(error), "text": _text(error)}


def _read_numbers(request: Request, value: Any) -> Reading:
    return {"values": [_numbers(value, tuple(request["shape"]))]}


def _read_formula(request: Request, value: Any) -> Reading:
    shape = tuple(request["shape"])
    entries = _entries(value, shape)
    if not any(_is_sympy(entry) for entry in entries):
        entries = [_number(entry, shape) for entry in entries]
        return {"values": [_nested(entries, shape)] * len(request["points"])}
    import sympy

    formulas = [entry if _is_sympy(entry) else sympy.Float(_number(entry, shape)) for entry in entries]
    if sum(formula.count_ops(visual=False) for formula in formulas) > MOST_OPERATIONS:
        raise _Fault("long")
    symbols = [sympy.Symbol(name) for name in request["symbols"]]
    formulas = _in_known_symbols(formulas, symbols)
    values = _evaluate(formulas, symbols, request["points"])
    if any(all(entry is None for entry in entries) for entries in zip(*values, strict=True)):
        raise _Fault("nan")
    return {"values": [_nested(entries, shape) for entries in values]}


def _read_function(request: Request, value: Any) -> Reading:
    if not callable(value):
        raise _Fault("no_function", type=_name(value))
    values = []
    for k, call in enumerate(request["calls"]):
        arguments = [np.array(argument, dtype=float) if isinstance(argument, list) else argument for argument in call]
        try:
            result = value(*arguments)
        except Exception as error:
            return {"fault": "raised", "type": _name(error), "text": _text(error), "call": k}
        if result is Ellipsis:
            raise _Fault("missing")
        if result is None:
            raise _Fault("returns_nothing", call=k)
        values.append(_numbers(result, tuple(request["shape"])))
    return {"values": values}


def _read_frames(request: Request, value: Any) -> Reading:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, (list, tuple)):
        value = [_as_nested(frame, DEEPEST) for frame in value[:MOST_ENTRIES]]
    return {"values": [_numbers(value, tuple(request["shape"]))]}


def _read_choice(request: Request, value: Any) -> Reading:
    if isinstance(value, (list, tuple, set, frozenset)) and len(value) == 1:
        (value,) = value
    if _is_sympy(value) or isinstance(value, (int, np.integer)):
        value = str(value)
    if not isinstance(value, str):
        raise _Fault("no_choice", type=_name(value))
    return {"choice": str(value).strip()[:LONGEST_TEXT]}


def _read_reasoned(request: Request, value: Any) -> Reading:
    """An option and letters of reasons, in whatever list or set they come."""
    texts: list[str] = []
    for item in _flat(value, DEEPEST):
        if item is None or item is Ellipsis:
            raise _Fault("missing")
        texts.append(_read_choice(request, item)["choice"])
    if len(texts) > MOST_CHOICES:
        raise _Fault("size")
    return {"choices": texts}


def _flat(value: Any, depth: int) -> Iterator[Any]:
    if isinstance(value, dict):
        value = [*value, *value.values()]
    if isinstance(value, (list, tuple, set, frozenset, np.ndarray)) and depth and len(value) <= MOST_ENTRIES:
        for item in sorted(value, key=str) if isinstance(value, (set, frozenset)) else value:
            yield from _flat(item, depth - 1)
    else:
        yield value


def _read_table(request: Request, value: Any) -> Reading:
    """Cells as numbers or text; what they mean is for the marker to read."""
    from dhlib.chain import Chain

    if isinstance(value, Chain):
        return {"table": _chain_as_table(value)}
    if isinstance(value, str):
        raise _Fault("text")
    columns = None
    if hasattr(value, "columns") and hasattr(value, "to_numpy"):
        columns = [_text(name) for name in list(value.columns)[: 2 * DEEPEST]]
        value = value.to_numpy()
    if isinstance(value, dict):
        columns = [_text(name) for name in list(value)[: 2 * DEEPEST]]
        listed = [_as_nested(column, 1) for column in value.values()]
        if not all(isinstance(column, list) for column in listed) or len(set(map(len, listed))) != 1:
            raise _Fault("ragged")
        value = list(zip(*listed, strict=True))
    rows = _as_nested(value, 2)
    if not isinstance(rows, list):
        raise _Fault("no_table", type=_name(value))
    cells = [[_cell(cell) for cell in row] if isinstance(row, list) else [_cell(row)] for row in rows]
    return {"table": {"rows": cells, "columns": columns}}


def _cell(value: Any) -> float | str:
    if value is None or value is Ellipsis:
        raise _Fault("missing")
    if _is_sympy(value) and getattr(value, "free_symbols", None):
        return str(value)[: 2 * LONGEST_TEXT]
    if isinstance(value, str):
        return str(value)[: 2 * LONGEST_TEXT]
    return _number(value, ())


def _chain_as_table(chain: Any) -> dict[str, Any]:
    rows = []
    for i, joint in enumerate(chain.joints, 1):
        row = {name: _number(getattr(joint, name), ()) for name in ("theta", "d", "a", "alpha")}
        variable = f"{'-' if joint.sign < 0 else ''}q{i} + ({row[joint.variable]!r})"
        rows.append(list((row | {joint.variable: variable}).values()))
    return {
        "rows": rows,
        "columns": ["theta", "d", "a", "alpha"],
        "convention": _text(chain.convention),
        "base": _numbers(chain.base, (4, 4)),
        "tool": _numbers(chain.tool, (4, 4)),
    }


_READERS: dict[str, Callable[[Request, Any], Reading]] = {
    "numbers": _read_numbers,
    "formula": _read_formula,
    "function": _read_function,
    "frames": _read_frames,
    "table": _read_table,
    "choice": _read_choice,
    "reasoned": _read_reasoned,
}


# Arrays of numbers, in whatever dress they come


def _numbers(value: Any, shape: tuple[int, ...]) -> Any:
    return _nested([_number(entry, shape) for entry in _entries(value, shape)], shape)


def _entries(value: Any, shape: tuple[int, ...]) -> list[Any]:
    """The entries of an array row by row, with its shape checked."""
    if isinstance(value, (str, bytes)):
        raise _Fault("text")
    if callable(value) and not _is_sympy(value):
        raise _Fault("function")
    if isinstance(value, (set, frozenset)):
        raise _Fault("kind", type=_name(value))
    nested = _as_nested(value, DEEPEST)
    got = _shape(nested)
    if got is None:
        raise _Fault("ragged")
    entries = list(_leaves(nested))
    if got != shape and not _same_up_to_ones(got, shape):
        if any(entry is None or entry is Ellipsis for entry in entries):
            raise _Fault("missing")
        if got == () and not _is_numberlike(nested):
            raise _Fault("kind", type=_name(value))
        raise _Fault("shape", shape=list(got))
    return entries


def _as_nested(value: Any, depth: int) -> Any:
    """Lists of lists from whatever holds entries: arrays, sympy matrices, data frames, tuples."""
    if hasattr(value, "to_numpy") and not isinstance(value, np.ndarray):
        value = value.to_numpy()
    if hasattr(value, "tolist"):
        if isinstance(value, np.ndarray) and value.size > MOST_ENTRIES:
            raise _Fault("shape", shape=[int(size) for size in value.shape[:DEEPEST]])
        value = value.tolist()
    if not isinstance(value, (list, tuple)):
        return value
    if depth == 0 or len(value) > MOST_ENTRIES:
        raise _Fault("size")
    return [_as_nested(item, depth - 1) for item in value]


def _shape(nested: Any) -> tuple[int, ...] | None:
    """The shape of nested lists, None if they are ragged."""
    if not isinstance(nested, list):
        return ()
    shapes = {_shape(item) for item in nested}
    if len(shapes) != 1:
        return (0,) if not nested else None
    inner = shapes.pop()
    return None if inner is None else (len(nested), *inner)


def _leaves(nested: Any) -> Iterator[Any]:
    if isinstance(nested, list):
        for item in nested:
            yield from _leaves(item)
    else:
        yield nested


def _nested(entries: list[Any], shape: tuple[int, ...]) -> Any:
    if not shape:
        return entries[0]
    if len(shape) == 1:
        return entries
    step = math.prod(shape[1:])
    return [_nested(entries[k * step : (k + 1) * step], shape[1:]) for k in range(shape[0])]


def _same_up_to_ones(got: tuple[int, ...], shape: tuple[int, ...]) -> bool:
    """A row or a column is a vector, and one number in brackets is a number."""
    return len(shape) < 2 and [size for size in got if size != 1] == [size for size in shape if size != 1]


def _number(entry: Any, shape: tuple[int, ...]) -> float:
    """One entry as a finite float of bounded size."""
    if entry is None or entry is Ellipsis:
        raise _Fault("missing")
    if isinstance(entry, (bool, np.bool_)):
        raise _Fault("bool")
    if isinstance(entry, (str, bytes)):
        raise _Fault("text")
    if _is_sympy(entry):
        names = sorted(str(symbol) for symbol in entry.free_symbols)
        if names:
            raise _Fault("symbols", names=[name[:LONGEST_TEXT] for name in names[:MOST_NAMES]])
        entry = complex(entry)
    if isinstance(entry, (complex, np.complexfloating)):
        whole = complex(entry)
        if abs(whole.imag) > 1e-9 * max(1.0, abs(whole.real)):
            raise _Fault("complex")
        entry = whole.real
    try:
        number = float(entry)
    except OverflowError:
        raise _Fault("large") from None
    except (TypeError, ValueError):
        raise _Fault("kind", type=_name(entry)) from None
    if not math.isfinite(number):
        raise _Fault("nan")
    if abs(number) > LARGEST_NUMBER:
        raise _Fault("large")
    return number + 0.0


def _is_numberlike(entry: Any) -> bool:
    return _is_sympy(entry) or isinstance(entry, (int, float, complex, np.number)) or hasattr(entry, "__float__")


def _is_sympy(value: Any) -> bool:
    sympy = sys.modules.get("sympy")
    return sympy is not None and isinstance(value, sympy.Basic)


# Formulas


def _in_known_symbols(formulas: list[Any], symbols: list[Any]) -> list[Any]:
    """Replace other spellings of the joint symbols, and C1, S23 … by what they stand for."""
    import sympy

    known = {symbol.name: symbol for symbol in symbols}
    numbered = {m[1]: symbol for symbol in symbols if (m := JOINT_SYMBOL.match(symbol.name))}
    replaced: dict[Any, Any] = {}
    unknown = []
    for symbol in sorted(set().union(*(formula.free_symbols for formula in formulas)), key=str):
        name = str(symbol)
        joint, short = JOINT_SYMBOL.match(name), SHORT_SYMBOL.match(name)
        if name in known:
            replaced[symbol] = known[name]
        elif joint and joint[1] in numbered:
            replaced[symbol] = numbered[joint[1]]
        elif short and all(digit in numbered for digit in short[2]):
            angle = sum(numbered[digit] for digit in short[2])
            replaced[symbol] = sympy.cos(angle) if short[1] in "Cc" else sympy.sin(angle)
        else:
            unknown.append(name[:LONGEST_TEXT])
    if unknown:
        raise _Fault("unknown_symbols", names=unknown[:MOST_NAMES], known=list(known))
    return [formula.xreplace(replaced) for formula in formulas]


def _evaluate(formulas: list[Any], symbols: list[Any], points: list[list[float]]) -> list[list[float | None]]:
    """Values of the formulas at each point; complex arithmetic, since Euler's form passes through it."""
    import sympy

    columns = [np.array(column, dtype=complex) for column in zip(*points, strict=True)]
    with np.errstate(all="ignore"):
        try:
            compiled = sympy.lambdify(symbols, formulas, modules="numpy", cse=True)
            values = np.array([np.broadcast_to(entry, len(points)) for entry in compiled(*columns)], dtype=complex).T
        except Exception:  # a function that numpy does not know, or not for complex numbers
            values = np.array([_evaluate_slowly(formulas, symbols, point) for point in points], dtype=complex)
    return [[_real_or_none(value) for value in row] for row in values]


def _evaluate_slowly(formulas: list[Any], symbols: list[Any], point: list[float]) -> list[complex]:
    values = dict(zip(symbols, point, strict=True))
    evaluated = []
    for formula in formulas:
        number = formula.subs(values).evalf()
        try:
            evaluated.append(complex(number))
        except TypeError:
            raise _Fault("no_value", text=_text(number)) from None
    return evaluated


def _real_or_none(value: complex) -> float | None:
    if not (math.isfinite(value.real) and math.isfinite(value.imag)):
        return None
    if abs(value.imag) > 1e-6 * max(1.0, abs(value.real)):
        raise _Fault("complex")
    if abs(value.real) > LARGEST_NUMBER:
        return None
    return float(value.real) + 0.0


# Words for the marker, never longer than a line


def _name(value: Any) -> str:
    return _line(type(value).__name__)


def _text(value: Any) -> str:
    try:
        return _line(str(value))
    except Exception:
        return ""


def _line(text: str) -> str:
    printable = "".join(c if c.isprintable() and not 0xD800 <= ord(c) < 0xE000 else " " for c in text[:LONGEST_TEXT])
    return " ".join(printable.split())
