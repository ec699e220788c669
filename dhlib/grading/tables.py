"""Judge a DH table by the mechanism it describes: every table of the same arm is right, whatever its numbers.

The ladder, from the top: the same T for every q; the same arm with another base or tool, with other joint zeros, with
joints that count the other way; its mirror image; the wrong unit; a known misconception; the first axis that fails.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.grading.exercise import Part
from dhlib.grading.forms import Table
from dhlib.grading.marks import NEARLY, RIGHT, UNREADABLE, WRONG, Mark, make_mark
from dhlib.grading.misconceptions import KNOWN, Slip, name_one, retellings
from dhlib.grading.retelling import scaled
from dhlib.mechanism import Verdict, same_mechanism
from dhlib.scalars import FloatArray

Rows = Mapping[str, Any]

#: What an answer on each rung of the ladder earns, where the task does not leave that choice free.
CREDIT = {"ends": 0.75, "zeros": 0.75, "senses": 0.5, "mirror": 0.25}
#: Angles in rad, and lengths relative to the reach, that count as equal.
TOLERANCE = 1e-3
FACTORS = {1000.0: "a thousand times too small", 0.001: "a thousand times too large",
           10.0: "ten times too small", 0.1: "ten times too large"}  # fmt: skip


def judge_table(part: Part, asks: Table, table: Rows) -> Mark:
    """Judge rows that were validated as numbers and text.

    Parameters
    ----------
    part : Part
    asks : Table
    table : mapping
        rows, columns (or None), convention (or ``""``), and base and tool where the answer brought them.
    """
    reference = part.chain.to_classic() if asks.convention == "classic" else part.chain.to_modified()
    degrees = False
    try:
        answer = read_chain(table, asks, reference)
    except DHError as error:
        try:
            answer, degrees = read_chain(table, asks, reference, degrees=True), True
        except DHError:
            return make_mark(part, UNREADABLE, _sentence(str(error)))
    if answer.n != reference.n:
        rows = f"{answer.n} row{'s' if answer.n != 1 else ''}"
        return make_mark(part, WRONG, f"The table has {rows}; the arm has {reference.n} joints, and each needs one.")
    if answer.kinds != reference.kinds:
        i = next(i for i, (x, y) in enumerate(zip(answer.kinds, reference.kinds, strict=True), 1) if x != y)
        right = {"R": "revolute: θ varies and d is constant", "P": "prismatic: d varies and θ is constant"}
        known = KNOWN["joint_kind"]
        return make_mark(part, WRONG, f"Joint {i} is {right[reference.kinds[i - 1]]}.", known.credit, known)
    if degrees:
        return _with_degrees(part, answer, reference)
    if answer.convention != asks.convention:
        return _other_convention(part, asks, answer, reference)
    return climb_down(part, asks, answer, reference)


def read_chain(table: Rows, asks: Table, reference: Chain, degrees: bool = False) -> Chain:
    """The chain that validated rows describe; with plain numbers for θ and d the joints are those of the arm."""
    rows = table["rows"]
    convention = table["convention"] or asks.convention
    plain = not any(isinstance(cell, str) for row in rows for cell in row)
    letters = reference.kinds if plain and len(rows) == reference.n else ""
    ends = {end: table[end] for end in ("base", "tool") if end in table}
    chain = Chain.from_table(
        rows, table["columns"] or "", letters, convention, degrees=degrees, unit=reference.unit, **ends
    )
    if chain.is_symbolic:
        raise DHError("the table holds symbols that are no joint variables; give its lengths and angles as numbers.")
    return chain


def climb_down(part: Part, asks: Table, answer: Chain, reference: Chain) -> Mark:
    """Rung by rung, what the answer is to the reference."""
    if _same_pose(answer, reference):
        return make_mark(part, RIGHT)
    verdict = same_mechanism(answer, reference, tol=TOLERANCE)
    if verdict:
        return _same_arm(part, asks, verdict, reference)
    slip = name_one([slip for slip, told in _told_chains(part, reference) if _is(answer, told)])
    if verdict.mirror:
        says = "This is the mirror image of the arm: the sign of an a, an α or a d is turned."
        known = slip.misconception if slip else KNOWN["sign"]
        return make_mark(part, WRONG, f"{slip.says} {says}" if slip else says, CREDIT["mirror"], known)
    for factor, size in FACTORS.items():
        if same_mechanism(scaled(answer, factor), reference, tol=TOLERANCE):
            known = KNOWN["unit"]
            says = f"The arm is right, but its lengths are {size}: they are asked for in {reference.unit}."
            return make_mark(part, NEARLY, says, known.credit, known)
    if slip:
        return make_mark(part, WRONG, slip.says, slip.misconception.credit, slip.misconception)
    return make_mark(part, WRONG, _sentence(verdict.reason))


def _same_arm(part: Part, asks: Table, verdict: Verdict, reference: Chain) -> Mark:
    """The same arm, with other ends, zeros or senses: right where the task leaves them free."""
    turned = [i for i, sign in enumerate(verdict.signs, 1) if sign < 0]
    shifted = [
        i for i, (kind, offset) in enumerate(zip(reference.kinds, verdict.offsets, strict=True), 1)
        if not _is_zero(kind, float(offset), reference)
    ]  # fmt: skip
    moved = [
        (name, end)
        for name, end in (("base", verdict.base), ("tool", verdict.tool))
        if not _stays(end, asks, reference)
    ]
    if moved:
        name, end = moved[0]
        distance = float(np.linalg.norm(end[:3, 3]))
        frame = "frame 0" if name == "base" else f"frame {reference.n}"
        how = (
            f"its origin is {distance:.4g} {reference.unit} away"
            if distance > TOLERANCE * reference.reach
            else "it is turned"
        )
        says = f"This is the right arm, but {frame} is not the one that the task gives: {how}."
        return make_mark(part, NEARLY, says, CREDIT["ends"], KNOWN["ends"])
    joints = f"joint{'s' if len(turned) > 1 else ''} {_and(turned)}"
    if turned and "senses" not in asks.free:
        q = f"q{turned[0]}"
        says = f"This is the right arm, but {joints} would have to turn the other way: write -{q} for {q}."
        return make_mark(part, NEARLY, says, CREDIT["senses"], KNOWN["sense"])
    zeros = f"joint{'s' if len(shifted) > 1 else ''} {_and(shifted)}"
    if shifted and "zeros" not in asks.free:
        says = (
            f"This is the right arm, but {zeros} would have to count from another zero: add an offset to q{shifted[0]}."
        )
        return make_mark(part, NEARLY, says, CREDIT["zeros"], KNOWN["offset"])
    remarks = [f"{joints} counting the other way"] if turned else []
    remarks += [f"{zeros} counting from another zero"] if shifted else []
    if not remarks:
        return make_mark(part, RIGHT, "It is not the table of the book, but one of the same arm.")
    return make_mark(
        part, RIGHT, f"It is the same arm as in the book, with {' and '.join(remarks)}: choices that are yours."
    )


def _with_degrees(part: Part, answer: Chain, reference: Chain) -> Mark:
    known = KNOWN["degrees"]
    if same_mechanism(answer, reference, tol=TOLERANCE):
        says = "The table is right in degrees; angles are asked for in radians, such as pi/2 or numpy.deg2rad(90)."
        return make_mark(part, NEARLY, says, 0.75, known)
    says = "Angles seem to be in degrees, while radians are asked for; and with degrees the arm would not be right yet."
    return make_mark(part, WRONG, says, 0.0, known)


def _other_convention(part: Part, asks: Table, answer: Chain, reference: Chain) -> Mark:
    known = KNOWN["convention"]
    if same_mechanism(answer, reference, tol=TOLERANCE):
        says = f"This chain is right, in the {answer.convention} convention; asked for is a {asks.convention} table."
        return make_mark(part, NEARLY, says, known.credit, known)
    says = f"This chain is in the {answer.convention} convention; asked for is a {asks.convention} table."
    return make_mark(part, WRONG, says, 0.0, known)


def _told_chains(part: Part, reference: Chain) -> list[tuple[Slip, Chain]]:
    """Tables that known misconceptions lead to, without those that describe the right arm after all."""
    told: list[tuple[Slip, Chain]] = []
    for key, says, arm in retellings(reference):
        if isinstance(arm, Chain) and arm.kinds == reference.kinds and key not in ("ends", "unit"):
            # A table is told by its rows: what is read in the other convention is written down in this one.
            rows = Chain(arm.joints, reference.convention, reference.base, reference.tool, unit=reference.unit)
            told.append((Slip(KNOWN[key], says.format(part="your table")), rows))
    return told


def _is(answer: Chain, told: Chain) -> bool:
    """Whether these are the same rows."""
    rows = [
        np.array([[float(j.theta), float(j.d), float(j.a), float(j.alpha)] for j in arm.joints])
        for arm in (answer, told)
    ]
    angles = np.abs(np.remainder(rows[0] - rows[1] + np.pi, 2 * np.pi) - np.pi)[:, [0, 3]]
    lengths = np.abs(rows[0] - rows[1])[:, [1, 2]]
    senses = [joint.sign for joint in answer.joints] == [joint.sign for joint in told.joints]
    return senses and bool(np.all(angles <= TOLERANCE) and np.all(lengths <= TOLERANCE * max(told.reach, 1e-9)))


def _same_pose(answer: Chain, reference: Chain) -> bool:
    q = np.random.default_rng(11).uniform(-2.5, 2.5, (8, reference.n))
    off = np.abs(answer.fk(q) - reference.fk(q))
    return bool(off[:, :3, :3].max() <= TOLERANCE and off[:, :3, 3].max() <= TOLERANCE * reference.reach)


def _is_zero(kind: str, offset: float, reference: Chain) -> bool:
    if kind == "P":
        return abs(offset) <= TOLERANCE * reference.reach
    return abs(math.remainder(offset, 2 * math.pi)) <= 2 * TOLERANCE


def _stays(end: FloatArray, asks: Table, reference: Chain) -> bool:
    """Whether base or tool of the verdict is what the task leaves free."""
    if "ends" in asks.free:
        return True
    if np.abs(end[:3, 3]).max() > TOLERANCE * reference.reach:
        return False
    return "turns" in asks.free or bool(np.abs(end[:3, :3] - np.eye(3)).max() <= 2 * TOLERANCE)


def _and(numbers: list[int]) -> str:
    words = [str(number) for number in numbers]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}" if words else ""


def _sentence(text: str) -> str:
    text = text.strip()
    return f"{text[:1].upper()}{text[1:]}" + ("" if text.endswith((".", "?", "!")) else ".")
