"""The form of an answer: what may be said about it without knowing the right one.

`form_of` tells it as plain JSON, which holds nothing of the solution and may stand in a student's notebook. `wanted`
says it in words, and `fault_of` says what of it an answer does not have: its shape, numbers or known symbols, and where
a pose is asked for, the last row, unit vectors at right angles and the determinant; DH1 and DH2 between frames; rows
that can be read as a table.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from dhlib.errors import DHError
from dhlib.grading.faults import MISSING, sentence, shape_text
from dhlib.grading.poses import improper, listed
from dhlib.grading.sentences import begun

if TYPE_CHECKING:
    from dhlib.chain import Chain
    from dhlib.grading.exercise import Part

Form = Mapping[str, Any]

#: How many calls of a function show the form of what it returns.
CALLS = 2


def form_of(part: Part) -> dict[str, Any]:
    """The form that a part asks for.

    Examples
    --------
    >>> from dhlib.grading.exercise import load_exercise
    >>> form_of(load_exercise("quickshot").part("A1"))
    {'form': 'numbers', 'shape': [4, 4], 'stands_for': 'pose'}
    """
    from dhlib.grading.forms import Valued

    asks, form = part.asks, outline(part)
    if isinstance(asks, Valued) and asks.shape == (4, 4):
        first = np.array([asks.quantity(part.chain, *asks.probes[0])], dtype=float)
        if not improper(first):
            form["stands_for"] = "pose"
    return form


def outline(part: Part) -> dict[str, Any]:
    """As much of the form as the request tells, with nothing computed."""
    from dhlib.grading.forms import Frames, Function, Table

    asks = part.asks
    form = {name: value for name, value in asks.request().items() if name not in ("points", "calls")}
    if isinstance(asks, Function):
        calls = asks.request()["calls"][:CALLS]  # rounded: the form is tried elsewhere than the answer is
        form |= {"signature": asks.signature, "calls": [[_coarse(argument) for argument in call] for call in calls]}
    if isinstance(asks, Table):
        form["rows"] = part.chain.n
    if isinstance(asks, Frames):
        form["convention"] = asks.convention
    return form


def wanted(form: Form) -> str:
    """A form in words.

    Examples
    --------
    >>> wanted({"form": "formula", "shape": [3], "symbols": ["theta1", "theta2"]})
    'a vector of 3 numbers in theta1, theta2'
    """
    match form["form"]:
        case "reasoned":
            letters = form["reasons"]
            return f"one of {', '.join(form['options'])} and then letters from {letters[0]} to {letters[-1]}"
        case "choice":
            return f"one of {', '.join(form['options'])}"
        case "table":
            return f"a DH table with {form['rows']} rows"
        case "frames":
            return f"a list of {form['shape'][0]} matrices of 4 by 4"
        case "function":
            return f"a function {form['signature']} that returns {_array(form['shape'])}"
        case "formula":
            return f"{_array(form['shape'], 'formula')} in {', '.join(form['symbols'])}"
        case _:
            return _array(form["shape"])


def fault_of(part_id: str, form: Form, answer: Any) -> tuple[str, str]:
    """What of its form an answer does not have.

    Returns
    -------
    headline, message : str
        Both empty if nothing is wrong with its form.

    Examples
    --------
    >>> fault_of("A1", {"form": "numbers", "shape": [4, 4], "stands_for": "pose"}, np.diag([1, 1, 1, 2]))
    ('the form is not right yet', 'The last row of a pose is 0 0 0 1.')
    """
    from dhlib.grading.answers import read_answer
    from dhlib.grading.marks import HEADLINES, OPEN, UNREADABLE, with_minus

    reading = read_answer(_request(form), answer)
    if "fault" in reading:
        headline = HEADLINES[OPEN if reading["fault"] in MISSING else UNREADABLE]
        says = sentence(reading, part_id, wanted(form), ", ".join(form.get("options", ())))
        return headline, f"{says} {count_of_frames(form, reading)}".rstrip()
    message = with_minus(_fault(form, reading))
    return ("the form is not right yet", message) if message else ("", "")


def count_of_frames(form: Form, reading: Mapping[str, Any]) -> str:
    """Which frames are asked for, if there are too few or too many of them; empty if that is not the fault.

    Examples
    --------
    >>> form = {"form": "frames", "shape": [5, 4, 4], "convention": "classic"}
    >>> count_of_frames(form, {"fault": "shape", "shape": [4, 4, 4]})
    'The frames are {0} to {4}: {0}, the base, counts too, and {4} stands where the last link ends. One is missing.'
    """
    shape = reading.get("shape")
    if form["form"] != "frames" or reading.get("fault") != "shape" or not isinstance(shape, list):
        return ""
    if len(shape) != 3 or shape[1:] != [4, 4] or not isinstance(shape[0], int):
        return ""
    count = form["shape"][0]
    n, off = count - 1, shape[0] - count
    last = "stands where the last link ends" if form["convention"] == "classic" else "stands on the last axis"
    numbers = {1: "One", 2: "Two", 3: "Three"}
    how = (
        f"{numbers.get(abs(off), abs(off))} {'is' if abs(off) == 1 else 'are'} {'missing' if off < 0 else 'too many'}."
    )
    return f"The frames are {{0}} to {{{n}}}: {{0}}, the base, counts too, and {{{n}}} {last}. {how}"


def _request(form: Form) -> dict[str, Any]:
    """What the reader of answers needs: formulas are tried at some points of our own."""
    if form["form"] != "formula":
        return dict(form)
    points = np.random.default_rng(2).uniform(-np.pi, np.pi, (6, len(form["symbols"])))
    return {**form, "points": points.tolist()}


def _fault(form: Form, reading: Mapping[str, Any]) -> str:
    match form["form"]:
        case "choice" | "reasoned":
            return _odd_choice(form, reading)
        case "table":
            return _odd_table(form, reading["table"])
        case "frames":
            return _odd_frames(form, np.array(reading["values"][0], dtype=float))
    if form.get("stands_for") == "pose":
        return improper(np.array(reading["values"], dtype=float))
    return ""


def _odd_choice(form: Form, reading: Mapping[str, Any]) -> str:
    options = {_plain(option) for option in form["options"]}
    texts = reading["choices"] if "choices" in reading else [reading["choice"]]
    chosen = {_plain(text) for text in texts} & options
    letters = set("".join(_plain(text) for text in texts if _plain(text) not in options))
    if len(chosen) != 1 or not letters <= set(form.get("reasons", ())):
        return f"It should be {wanted(form)}, in quotation marks."
    return "Say why, too: give the letters of the reasons that hold." if form.get("reasons") and not letters else ""


def other_symbols(chain: Chain) -> str:
    """Say which symbols a table holds besides the variables of its joints.

    Examples
    --------
    >>> from dhlib import Chain
    >>> other_symbols(Chain.from_table([["q1", 0, "L", 0]], convention="classic"))
    'row 1 holds L: besides the variable of its own joint, q1, it should hold numbers only, and no other symbol.'
    """
    for i, joint in enumerate(chain.joints, 1):
        cells = (joint.theta, joint.d, joint.a, joint.alpha)
        if names := sorted({str(symbol) for cell in cells for symbol in getattr(cell, "free_symbols", ())}):
            return (
                f"row {i} holds {listed(names)}: besides the variable of its own joint, q{i}, it should hold numbers "
                "only, and no other symbol."
            )
    return "base and tool should hold numbers only, and no symbol."


def _odd_table(form: Form, table: Mapping[str, Any]) -> str:
    from dhlib.chain import Chain
    from dhlib.table import DEFAULT_COLUMNS

    if len(table["rows"]) != form["rows"]:
        rows = len(table["rows"])
        return f"It has {rows} row{'s' if rows != 1 else ''}; the arm has {form['rows']} joints, and each needs one."
    convention = table.get("convention") or form["convention"]
    columns = table["columns"] or " ".join(DEFAULT_COLUMNS[convention])
    # Without symbols the numbers are the zeros of the joints; which of them slide is for the marker to know.
    letters = "" if any(isinstance(cell, str) for row in table["rows"] for cell in row) else "R" * form["rows"]
    try:
        chain = Chain.from_table(table["rows"], columns, letters, convention)
        if chain.is_symbolic:
            raise DHError(other_symbols(chain))
    except DHError as error:
        return begun(str(error))
    if convention != form["convention"]:
        return f"This chain is in the {convention} convention; asked for is a {form['convention']} table."
    return ""


def _odd_frames(form: Form, frames: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    from dhlib.preconditions import check_frames

    for k, frame in enumerate(frames):
        if fault := improper(frame[None]):
            return f"Frame {k}: {fault}"
    report = check_frames(frames, form["convention"], tol=5e-3)
    return "" if report else f"{begun(report.faults[0])}."


def _coarse(argument: Any) -> Any:
    """Numbers and vectors to two decimals; a matrix stays as it is, since it would cease to be a pose."""
    if isinstance(argument, list):
        return argument if any(isinstance(item, list) for item in argument) else [_coarse(item) for item in argument]
    return round(argument, 2) if isinstance(argument, float) else argument


def _plain(text: str) -> str:
    return "".join(c for c in str(text).casefold() if c.isalnum())


def _array(shape: list[int] | tuple[int, ...], one: str = "number") -> str:
    if not shape:
        return f"one {one}"
    return f"a {'vector' if len(shape) == 1 else 'matrix'} of {shape_text(list(shape))}"
