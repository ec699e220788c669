"""Judge a DH table by the mechanism it describes: every table of the same arm is right, whatever its numbers.

The ladder, from the top: the same T for every q; the same arm with another base or tool, with other joint zeros, with
joints that count the other way; its mirror image; the wrong unit; a known misconception; the first axis that fails.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from itertools import combinations
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.grading.exercise import Part
from dhlib.grading.formal import other_symbols
from dhlib.grading.forms import Table
from dhlib.grading.marks import NEARLY, RIGHT, UNREADABLE, WRONG, Mark, make_mark
from dhlib.grading.misconceptions import KNOWN, OTHER, TRAP, Slip, name_one, retellings
from dhlib.grading.poses import listed
from dhlib.grading.retelling import altered, scaled
from dhlib.grading.sentences import begun
from dhlib.mechanism import FREEDOMS, Sameness, same_mechanism
from dhlib.scalars import FloatArray
from dhlib.table import DEFAULT_COLUMNS

Rows = Mapping[str, Any]

#: What an answer on each rung of the ladder earns, where the task does not leave that choice free.
CREDIT = {"ends": 0.75, "zeros": 0.75, "senses": 0.5, "mirror": 0.25}
#: How the columns are called, and how many numbers may be named as the one that is off.
SYMBOLS = {"theta": "θ", "d": "d", "a": "a", "alpha": "α"}
MOST_ODD = 3
#: The variable of a joint in a cell of text.
VARIABLE = re.compile(r"(?<![A-Za-z])(?:theta|θ|th|t|q|d)_?\{?(\d+)")
#: Angles in rad, and lengths relative to the reach, that count as equal.
TOLERANCE = 1e-3
FACTORS = {1000.0: "a thousand times too small", 0.001: "a thousand times too large",
           10.0: "ten times too small", 0.1: "ten times too large",
           100.0: "a hundred times too small", 0.01: "a hundred times too large"}  # fmt: skip


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
    if says := odd_variables(_without_numbering(table)["rows"], reference.n):
        return make_mark(part, WRONG, says)
    try:
        answer = read_chain(table, asks, reference)
    except DHError as error:
        try:
            answer, degrees = read_chain(table, asks, reference, degrees=True), True
        except DHError:
            return make_mark(part, UNREADABLE, _sentence(str(error)))
    if answer.n != reference.n:
        return make_mark(part, WRONG, f"{_count(answer.n, reference.n)} {odd_row(answer, reference)}".rstrip())
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
    """The chain that validated rows describe.

    Raises
    ------
    DHError
        If they describe none; the message names the row.
    """
    table = _without_numbering(table)
    convention = table["convention"] or asks.convention
    columns = table["columns"] or " ".join(DEFAULT_COLUMNS[convention])
    ends = {end: table[end] for end in ("base", "tool") if end in table}

    def read(columns: Any, letters: str) -> Chain:
        return Chain.from_table(
            table["rows"], columns, letters, convention, degrees=degrees, unit=reference.unit, **ends
        )

    kinds = reference.kinds
    if len(table["rows"]) != reference.n and set(kinds) == {"R"}:
        kinds = "R" * len(table["rows"])
    try:
        chain = read(columns, "")
    except DHError as error:
        try:  # where no row says what varies, θ and d are the zeros of the joints of this arm
            chain = read(columns, kinds)
        except DHError:
            _refuse_other_columns(table, read, convention)
            raise error from None
    if chain.is_symbolic:
        _refuse_other_columns(table, read, convention)
        raise DHError(other_symbols(chain))
    return chain


def _without_numbering(table: Rows) -> Rows:
    """Leave out a first column that only counts the rows."""
    rows = table["rows"]
    first = [row[0] for row in rows if len(row) == 5]
    if rows and len(first) == len(rows) and first in (list(range(len(rows))), list(range(1, len(rows) + 1))):
        columns = table["columns"][1:] if table["columns"] else None
        return {**table, "rows": [row[1:] for row in rows], "columns": columns}
    return table


def _refuse_other_columns(table: Rows, read: Callable[[str, str], Chain], convention: str) -> None:
    """Say so, if the rows make sense with the columns of the other convention."""
    if not table["columns"] and _reads(read, OTHER[convention]):
        asked, other = (", ".join(DEFAULT_COLUMNS[name]) for name in (convention, OTHER[convention]))
        raise DHError(f"the columns seem to stand as {other}; asked for is {asked}.") from None
    names = DEFAULT_COLUMNS[convention]
    held = {k for row in table["rows"] for k, cell in enumerate(row) if isinstance(cell, str)}
    if not table["columns"] and len(held) == 1 and (k := held.pop()) < len(names) and names[k] not in ("theta", "d"):
        raise DHError(
            f"the joint variables stand in column {k + 1}, which is that of {names[k]}; "
            f"the columns asked for are {', '.join(names)}."
        ) from None


def _reads(read: Callable[[str, str], Chain], convention: str) -> bool:
    """Whether the rows make sense with the columns in the order of a convention."""
    try:
        read(" ".join(DEFAULT_COLUMNS[convention]), "")
    except DHError:
        return False
    return True


def climb_down(part: Part, asks: Table, answer: Chain, reference: Chain) -> Mark:
    """Rung by rung, what the answer is to the reference."""
    if _same_pose(answer, reference):
        return make_mark(part, RIGHT)
    verdict = closest(asks, answer, reference)
    told_chains = [*_trap_chains(part), *_told_chains(reference)]
    told_chains = [(slip, told) for slip, told in told_chains if not _is(reference, told)]
    slip = name_one([slip for slip, told in told_chains if _is(answer, told)])
    if verdict:
        return _same_arm(part, asks, verdict, reference, slip)
    if verdict.mirror:
        says = "This is the mirror image of the arm: the sign of an a, an α or a d is turned."
        known = slip.misconception if slip else KNOWN["sign"]
        return make_mark(
            part,
            WRONG,
            f"{slip.says} That makes the mirror image of the arm." if slip else says,
            CREDIT["mirror"],
            known,
        )
    for factor, size in FACTORS.items():
        if same_mechanism(scaled(answer, factor), reference, tol=TOLERANCE):
            known = KNOWN["unit"]
            says = f"The arm is right, but its lengths are {size}: they are asked for in {reference.unit}."
            return make_mark(part, NEARLY, says, known.credit, known)
    if slip:
        return make_mark(part, WRONG, slip.says, slip.misconception.credit, slip.misconception)
    reason = verdict.reason if verdict.finding == verdict.reason else f"{verdict.finding}; by the task it is not"
    return make_mark(part, WRONG, f"{_sentence(reason)} {odd_number(asks, answer, reference)}".rstrip())


def _count(rows: int, joints: int) -> str:
    return f"The table has {rows} row{'s' if rows != 1 else ''}; the arm has {joints} joints, and each needs one."


def odd_variables(rows: list[list[float | str]], joints: int) -> str:
    """Whose variable no row holds, or two rows hold, if there are too few or too many rows; else empty.

    Examples
    --------
    >>> odd_variables([["q1", 0, 1, 0], ["q3", 0, 1, 0]], 3)
    'The table has 2 rows; the arm has 3 joints, and each needs one. No row holds the variable of joint 2.'
    """
    held = [{int(number) for cell in row if isinstance(cell, str) for number in VARIABLE.findall(cell)} for row in rows]
    if len(rows) == joints or any(len(numbers) != 1 for numbers in held):
        return ""
    numbers = [number for (number,) in held]
    missing = [str(i) for i in range(1, joints + 1) if i not in numbers]
    twice = [str(i) for i in dict.fromkeys(numbers) if numbers.count(i) > 1]
    beyond = [str(i) for i in numbers if not 1 <= i <= joints]
    if missing == [str(joints)]:  # the rows may have been numbered anew
        return ""
    if not beyond and len(missing) == 1 and not twice:
        return f"{_count(len(rows), joints)} No row holds the variable of joint {missing[0]}."
    if not beyond and len(twice) == 1 and not missing:
        return f"{_count(len(rows), joints)} More than one row holds the variable of joint {twice[0]}."
    return ""


def odd_row(answer: Chain, reference: Chain) -> str:
    """Which row of a table is missing, or one too many, if that is all that is wrong with it; else empty."""
    short, long = sorted((answer, reference), key=lambda chain: chain.n)
    if short.n == 0 or long.n - short.n != 1 or short.convention != long.convention:
        return ""
    left = {i: without_row(long, i) for i in range(1, long.n + 1)}
    left = {i: chain for i, chain in left.items() if chain.kinds == short.kinds}
    fits = [i for i, chain in left.items() if _is(short, chain)]
    fits = fits or [i for i, chain in left.items() if same_mechanism(short, chain, tol=TOLERANCE)]
    if not fits:
        return ""
    which = f"Row {fits[0]}" if len(fits) == 1 else f"One of rows {listed(list(map(str, fits)))}"
    return f"{which} seems to be {'missing' if short is answer else 'one too many'}: the others fit."


def without_row(chain: Chain, i: int) -> Chain:
    """The chain of a table that one row was taken out of."""
    joints = [joint for k, joint in enumerate(chain.joints, 1) if k != i]
    return Chain(joints, chain.convention, chain.base, chain.tool, unit=chain.unit)


def odd_number(asks: Table, answer: Chain, reference: Chain) -> str:
    """Which one number of a table is off, if with another in its place all would be right; else empty.

    Its value is not told. Where different numbers would do, such as offsets along parallel axes, all are named.
    """
    found = []
    for i, joint in enumerate(answer.joints, 1):
        for name in ("d", "a", "alpha") if joint.kind == "R" else ("theta", "a", "alpha"):
            if any(_would_do(asks, answer, reference, i, name, v) for v in _instead(answer, reference, i, name)):
                found.append(f"{SYMBOLS[name]} in row {i}")
    if not 1 <= len(found) <= MOST_ODD:
        return ""
    return f"All else fits: it is the {' or the '.join(found)} that is off."


def _instead(answer: Chain, reference: Chain, i: int, name: str) -> list[float]:
    """What may have to stand in place of a number, in the student's own choice of frames."""
    there = float(getattr(answer.joints[i - 1], name))
    right = float(getattr(reference.joints[i - 1], name))
    if name in ("theta", "alpha"):
        values = [right, -right, right + math.pi, math.pi - right]
        return [v for v in values if abs(math.remainder(v - there, 2 * math.pi)) > TOLERANCE]
    missing = sum(float(getattr(joint, name)) for joint in reference.joints) - sum(
        float(getattr(joint, name)) for joint in answer.joints
    )
    apart = TOLERANCE * max(reference.reach, 1e-9)
    values = [right, -right, there + missing]
    return [v for k, v in enumerate(values) if abs(v - there) > apart and all(abs(v - w) > apart for w in values[:k])]


def _would_do(asks: Table, answer: Chain, reference: Chain, i: int, name: str, value: float) -> bool:
    verdict = closest(asks, altered(answer, i, **{name: value}), reference)
    return bool(verdict) and _ends_stay(verdict, asks, reference)


def closest(asks: Table, answer: Chain, reference: Chain) -> Sameness:
    """The verdict that leaves base and tool where the task puts them, if there is one.

    Turning an axis round may be told as joints that count the other way, or as another tool far away; the student who
    did the first should not be judged by the second.
    """
    verdict = same_mechanism(answer, reference, tol=TOLERANCE)
    if verdict and not _ends_stay(verdict, asks, reference):
        for size in range(len(FREEDOMS)):
            for free in combinations(FREEDOMS, size):
                other = same_mechanism(answer, reference, tol=TOLERANCE, free=free)
                if other and _ends_stay(other, asks, reference):
                    return other
    return verdict


def _same_arm(part: Part, asks: Table, verdict: Sameness, reference: Chain, slip: Slip | None) -> Mark:
    """The same arm, with other ends, zeros or senses: right where the task leaves them free."""
    turned = [i for i, sign in enumerate(verdict.signs, 1) if sign < 0]
    shifted = [
        i for i, (kind, offset) in enumerate(zip(reference.kinds, verdict.offsets, strict=True), 1)
        if not _is_zero(kind, float(offset), reference)
    ]  # fmt: skip
    ends = {"frame 0": verdict.base, f"frame {reference.n}": verdict.tool}
    moved = [frame for frame, end in ends.items() if not _stays(end, asks, reference)]
    if moved:
        distance = float(np.linalg.norm(ends[moved[0]][:3, 3]))
        far = distance > TOLERANCE * reference.reach
        how = f"its origin is {distance:.4g} {reference.unit} away" if far else "it is turned"
        them = "it" if len(moved) == 1 else "them"
        where = f"would not be where the task puts {them}"
        says = f"The axes fit, but with this table {' and '.join(moved)} {where}: {how}."
        if slip:
            says = f"{slip.says} As it stands, {' and '.join(moved)} {where}; the rest fits."
        return make_mark(part, NEARLY, says, CREDIT["ends"], slip.misconception if slip else KNOWN["ends"])
    if turned and "senses" not in asks.free:
        q = f"q{turned[0]}"
        says = f"The axes fit, but {_joints(turned)} would have to count the other way: write -{q} for {q}."
        return make_mark(part, NEARLY, says, CREDIT["senses"], KNOWN["sense"])
    if shifted and "zeros" not in asks.free:
        q = f"q{shifted[0]}"
        says = f"The axes fit, but {_joints(shifted)} would have to count from another zero: add an offset to {q}."
        return make_mark(part, NEARLY, says, CREDIT["zeros"], KNOWN["offset"])
    remarks = [f"{_joints(turned)} counting the other way"] if turned else []
    remarks += [f"{_joints(shifted)} counting from another zero"] if shifted else []
    if not remarks:
        return make_mark(part, RIGHT, "Your numbers differ from ours; the arm is the same.")
    return make_mark(part, RIGHT, f"It is this arm, with {' and '.join(remarks)}: choices that are yours.")


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


def _trap_chains(part: Part) -> list[tuple[Slip, Chain]]:
    """Tables that this very task invites: the quantity of a trap is a chain, and its rows are what is compared."""
    return [(Slip(KNOWN.get(trap.key, TRAP), trap.says), trap.quantity(part.chain)) for trap in part.traps]


def _told_chains(reference: Chain) -> list[tuple[Slip, Chain]]:
    """Tables that known misconceptions lead to, without those that describe the right arm after all."""
    told: list[tuple[Slip, Chain]] = []
    for key, says, arm in retellings(reference):
        if isinstance(arm, Chain) and arm.kinds == reference.kinds and key not in ("ends", "unit"):
            # A table is told by its rows: what is read in the other convention is written down in this one.
            rows = Chain(arm.joints, reference.convention, reference.base, reference.tool, unit=reference.unit)
            told.append((Slip(KNOWN[key], says.replace("Your {part}", "Your table").format(part="your table")), rows))
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


def _ends_stay(verdict: Sameness, asks: Table, reference: Chain) -> bool:
    return _stays(verdict.base, asks, reference) and _stays(verdict.tool, asks, reference)


def _stays(end: FloatArray, asks: Table, reference: Chain) -> bool:
    """Whether base or tool of the verdict is what the task leaves free."""
    if "ends" in asks.free:
        return True
    if np.abs(end[:3, 3]).max() > TOLERANCE * reference.reach:
        return False
    return "turns" in asks.free or bool(np.abs(end[:3, :3] - np.eye(3)).max() <= 2 * TOLERANCE)


def _joints(numbers: list[int]) -> str:
    return f"joint{'s' if len(numbers) > 1 else ''} {listed([str(number) for number in numbers])}"


def _sentence(text: str) -> str:
    text = text.strip()
    return begun(text) + ("" if text.endswith((".", "?", "!")) else ".")
