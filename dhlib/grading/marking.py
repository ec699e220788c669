"""The trusted half: judge a reading.

One function, `mark`, serves every face: the page, the notebook's check, pytest and the class. It trusts nothing in
a reading but what it has validated itself, and it judges by meaning: by value, or as a mechanism.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from dhlib.grading import formal
from dhlib.grading.exercise import Exercise, Part
from dhlib.grading.faults import MISSING, sentence
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, ReasonedChoice, Table, Valued
from dhlib.grading.frames import judge_frames
from dhlib.grading.marks import COARSE, FOLLOWS, NEARLY, OPEN, REASONED, RIGHT, UNREADABLE, WRONG, Mark, make_mark
from dhlib.grading.misconceptions import KNOWN, name_one, would_have_given
from dhlib.grading.poses import MOST, describe, improper, listed
from dhlib.grading.sentences import begun
from dhlib.grading.tables import judge_table
from dhlib.grading.terms import slip_in_a_term
from dhlib.scalars import FloatArray

Reading = Mapping[str, Any]

#: A number that no answer holds; beyond it arithmetic would overflow.
LARGEST_NUMBER = 1e9
LONGEST_TEXT = 500
MOST_CHOICES = 20


@dataclass(frozen=True)
class Earlier:
    """An answer that was judged before, for parts that follow from it."""

    mark: Mark
    values: FloatArray | None


class Refused(Exception):
    """A reading is not what an honest reader of answers makes."""


def mark(part: Part, reading: Any, earlier: Mapping[str, Earlier] | None = None) -> Mark:
    """Judge a reading of one part.

    Parameters
    ----------
    part : Part
    reading : dict
        What `answers.read_answer` made; anything else is refused in words.
    earlier : mapping of str to Earlier, optional
        Answers to earlier parts: what follows from a wrong one is not punished again.

    Returns
    -------
    Mark

    Examples
    --------
    >>> from dhlib.grading.exercise import load_exercise
    >>> part = load_exercise("quickshot").part("slip")
    >>> print(mark(part, {"choice": "p_z"}))
    slip: cannot be read. It should be one of n_x, n_y, n_z, in quotation marks.
    """
    return judge(part, reading, earlier or {}).mark


def judge(part: Part, reading: Any, earlier: Mapping[str, Earlier]) -> Earlier:
    """Judge a reading, and keep its values for the parts that follow from it."""
    if not isinstance(reading, dict):
        reading = {"fault": "refused"}
    if "fault" in reading:
        verdict = OPEN if reading["fault"] in MISSING else UNREADABLE
        options = ", ".join(part.asks.options) if isinstance(part.asks, Choice) else ""
        says = sentence(reading, part.id, wanted(part), options)
        if isinstance(part.asks, Frames) and (more := formal.count_of_frames(formal.outline(part), reading)):
            says = f"{says} {more}"
        return Earlier(make_mark(part, verdict, says), None)
    try:
        match part.asks:
            case ReasonedChoice():
                return Earlier(_judge_reasoned(part, part.asks, reading), None)
            case Choice():
                return Earlier(_judge_choice(part, part.asks, reading), None)
            case Table():
                return Earlier(judge_table(part, part.asks, _table(reading)), None)
            case Frames():
                (frames,) = _values(reading, 1, (part.asks.count, 4, 4))
                return Earlier(judge_frames(part, part.asks, frames), None)
            case Valued():
                values = _values(reading, len(part.asks.probes), part.asks.shape, isinstance(part.asks, Formula))
                return Earlier(_judge_values(part, part.asks, values, earlier), values)
    except Refused:
        return Earlier(make_mark(part, UNREADABLE, sentence({"fault": "refused"}, part.id, wanted(part))), None)


class Marker:
    """Marks the answers of one notebook in their order.

    Parameters
    ----------
    exercise : Exercise

    Examples
    --------
    >>> from dhlib.grading.exercise import load_exercise
    >>> Marker(load_exercise("quickshot")).mark("A1", {"fault": "missing"}).message
    'Put your answer in place of the three dots.'
    """

    def __init__(self, exercise: Exercise) -> None:
        self.exercise = exercise
        self._earlier: dict[str, Earlier] = {}

    def mark(self, part_id: str, reading: Any) -> Mark:
        """Mark one answer; raises DHError if there is no such part."""
        part = self.exercise.part(part_id)
        judged = judge(part, reading, self._earlier)
        self._earlier[part.id] = judged
        return judged.mark

    def mark_all(self, readings: Mapping[str, Any]) -> list[Mark]:
        """Mark every part; one that is not among the readings is open."""
        return [self.mark(part.id, readings.get(part.id, {"fault": "undefined"})) for part in self.exercise.parts]


def wanted(part: Part) -> str:
    """What a part asks for, in words.

    Examples
    --------
    >>> from dhlib.grading.exercise import load_exercise
    >>> wanted(load_exercise("quickshot").part("A1"))
    'a matrix of 4 rows and 4 columns'
    """
    return formal.wanted(formal.outline(part))


# Validating


def _values(reading: Mapping[str, Any], count: int, shape: tuple[int, ...], holes: bool = False) -> FloatArray:
    """The values of a reading, (count, *shape); NaN where a formula has none."""
    values = reading.get("values")
    if not isinstance(values, list) or len(values) != count:
        raise Refused
    flat: list[float] = []
    for value in values:
        _collect(value, shape, holes, flat)
    return np.array(flat, dtype=float).reshape(count, *shape)


def _collect(value: Any, shape: tuple[int, ...], holes: bool, into: list[float]) -> None:
    if shape:
        if not isinstance(value, list) or len(value) != shape[0]:
            raise Refused
        for item in value:
            _collect(item, shape[1:], holes, into)
    elif value is None and holes:
        into.append(math.nan)
    elif isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST_NUMBER:
        into.append(float(value))
    else:
        raise Refused


def _table(reading: Mapping[str, Any]) -> Mapping[str, Any]:
    table = reading.get("table")
    if not isinstance(table, dict):
        raise Refused
    rows, columns = table.get("rows"), table.get("columns")
    if not isinstance(rows, list) or not all(isinstance(row, list) for row in rows) or len(rows) > 50:
        raise Refused
    for cell in (cell for row in rows for cell in row[:50]):
        if isinstance(cell, str):
            if len(cell) > LONGEST_TEXT:
                raise Refused
        elif isinstance(cell, bool) or not isinstance(cell, int | float) or not abs(cell) <= LARGEST_NUMBER:
            raise Refused
    if columns is not None and not (isinstance(columns, list) and all(isinstance(name, str) for name in columns)):
        raise Refused
    ends = {end: _values({"values": [table[end]]}, 1, (4, 4))[0] for end in ("base", "tool") if end in table}
    convention = table.get("convention", "")
    if convention not in ("", "classic", "modified"):
        raise Refused
    return {"rows": rows, "columns": columns, "convention": convention, **ends}


# Judging


def _judge_choice(part: Part, asks: Choice, reading: Mapping[str, Any]) -> Mark:
    choice = reading.get("choice")
    if not isinstance(choice, str):
        raise Refused
    spelled = {_plain(option): option for option in asks.options}
    chosen = spelled.get(_plain(choice))
    if chosen is None:
        options = ", ".join(asks.options)
        return make_mark(part, UNREADABLE, f"It should be one of {options}, in quotation marks.")
    if chosen == asks.right:
        return make_mark(part, RIGHT, begun(asks.options[chosen]))
    return make_mark(part, WRONG, begun(asks.options[chosen]))


def _judge_reasoned(part: Part, asks: ReasonedChoice, reading: Mapping[str, Any]) -> Mark:
    """The option first; its points are for the reasons, since one of two options is soon guessed."""
    texts = reading.get("choices")
    if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts) or len(texts) > MOST_CHOICES:
        raise Refused
    spelled = {_plain(option): option for option in asks.options}
    chosen = {spelled[_plain(text)] for text in texts if _plain(text) in spelled}
    words = {word for text in texts if _plain(text) not in spelled for word in re.findall(r"\w+", text.casefold())}
    letters = {letter for word in words for letter in ([word] if word in asks.reasons else word)}
    if len(chosen) != 1 or not letters <= asks.reasons.keys():
        return make_mark(
            part, UNREADABLE, f"It should be {wanted(part)}, each in quotation marks, with commas between."
        )
    (option,) = chosen
    false, missing = sorted(letters - asks.needed), asks.needed - letters
    if option != asks.right:
        says = begun(asks.options[option])
        if false:
            says += f" And reason {false[0]} does not hold: {asks.reasons[false[0]].says}"
        elif not letters:
            says += f" Go through the reasons {' '.join(asks.reasons)} first: the choice follows from those that hold."
        return make_mark(part, WRONG, says)
    if not false and not missing:
        return make_mark(part, RIGHT, begun(asks.options[option]))
    earned = REASONED * max(0, len(letters & asks.needed) - len(false)) / len(asks.needed)
    says = f"The choice {option} is right"
    if not letters:
        return make_mark(part, NEARLY, f"{says}; now say why: which of the reasons {' '.join(asks.reasons)} hold?")
    if false:
        return make_mark(part, NEARLY, f"{says}, but reason {false[0]} is none: {asks.reasons[false[0]].says}", earned)
    return make_mark(part, NEARLY, f"{says}, and so are the reasons that you give; there are more.", earned)


def _plain(text: str) -> str:
    return "".join(c for c in text.casefold() if c.isalnum())


def _judge_values(part: Part, asks: Valued, values: FloatArray, earlier: Mapping[str, Earlier]) -> Mark:
    values, right = asks.meaning(values), asks.meaning(asks.values(part.chain))
    if agree(values, right, asks.tolerances):
        return make_mark(part, RIGHT)
    if follows := _follows(part, asks, values, earlier):
        return follows
    slip = name_one([slip for slip, told in would_have_given(part) if _explains(told, values, right, asks)])
    if slip:
        return make_mark(part, WRONG, slip.says, slip.misconception.credit, slip.misconception)
    if isinstance(asks, Numbers) and agree(values, right, 10 * asks.tolerances):
        says = f"The values are close, but further off than {asks.tolerance:g}"
        says += f" (lengths: {asks.length_tolerance:g})" if asks.shape == (4, 4) else ""
        return make_mark(part, NEARLY, f"{says}. Round only at the end.", COARSE)
    if isinstance(asks, Formula) and (says := slip_in_a_term(part, asks, values, right)):
        return make_mark(part, WRONG, says)
    if asks.shape == (4, 4) and (fault := improper(values)):
        return make_mark(part, WRONG, fault, known=KNOWN["improper"])
    return make_mark(part, WRONG, describe(asks, values, right, part.chain.unit))


def agree(values: FloatArray, right: FloatArray, tolerances: FloatArray) -> bool:
    """Whether values are right to the tolerance, at every probe where a formula has a value.

    A right formula may have none at a few points, such as tan(θ/2) at half turns.
    """
    there = np.isfinite(values).reshape(len(values), -1).all(axis=1)
    if there.sum() < max(1, MOST * len(values)):
        return False
    return bool(np.all(np.abs(values - right)[there] <= np.broadcast_to(tolerances, values.shape)[there]))


def _explains(told: FloatArray, values: FloatArray, right: FloatArray, asks: Valued) -> bool:
    told = asks.meaning(told)
    return agree(values, told, asks.tolerances) and not agree(told, right, asks.tolerances)


def _follows(part: Part, asks: Valued, values: FloatArray, earlier: Mapping[str, Earlier]) -> Mark | None:
    """A right step from a wrong start: at least half of the starts are right, or all that are wrong are explained."""
    rule = part.follows
    starts = [earlier[name] for name in rule.parts if name in earlier] if rule else []
    if rule is None or len(starts) < len(rule.parts):
        return None
    arrays = [start.values for start in starts if start.values is not None and len(start.values) == len(values)]
    wrong = [start.mark for start in starts if not start.mark.passed]
    explained = all(mark.misconception for mark in wrong)
    if len(arrays) < len(starts) or (2 * len(wrong) > len(starts) and not explained):
        return None
    followed = asks.meaning(np.array([rule.rule(*at_probe) for at_probe in zip(*arrays, strict=True)]))
    if not agree(values, followed, asks.tolerances):
        return None
    names = [start.mark.part for start in starts if start.mark.verdict != RIGHT]
    return make_mark(part, FOLLOWS, f"It follows from your {listed(names)}, not right yet: mend that, and then this.")
