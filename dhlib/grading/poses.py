"""What is wrong with a pose, in words that do not give the right one away."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from dhlib.grading.forms import Formula, Function, Valued
from dhlib.scalars import FloatArray

COLUMNS = ("n", "o", "a", "p")
#: Entries rounded to three decimals still make a rotation to this.
ROUNDED = 5e-3
#: A right formula has values at so many of the joint angles tried: tan(θ/2) has none at half turns.
MOST = 0.7


def improper(poses: FloatArray) -> str:
    """Say in what respect matrices (…, 4, 4) are no poses; empty if they are.

    Examples
    --------
    >>> improper(np.diag([1.0, 1.0, -1.0, 1.0])[None])
    'The determinant of the rotation is -1: this is a mirror image, its axes are left-handed. In a pose n × o = a.'
    """
    poses = poses[np.isfinite(poses).all(axis=(-1, -2))]
    if not len(poses):
        return ""
    if np.any(np.abs(poses[:, 3] - [0, 0, 0, 1]) > ROUNDED):
        return "The last row of a pose is 0 0 0 1."
    rotations = poses[:, :3, :3]
    lengths = np.linalg.norm(rotations, axis=1)
    for k, name in enumerate(COLUMNS[:3]):
        off = lengths[np.argmax(np.abs(lengths[:, k] - 1)), k]
        if abs(off - 1) > ROUNDED:
            length = off if off > ROUNDED else 0
            return f"Column {name} has length {length:.3g}: the columns of a rotation are unit vectors."
    for j, k in ((0, 1), (1, 2), (0, 2)):
        if np.any(np.abs(np.sum(rotations[:, :, j] * rotations[:, :, k], axis=-1)) > ROUNDED):
            return f"Columns {COLUMNS[j]} and {COLUMNS[k]} are not at right angles, as the axes of a frame should be."
    if np.any(np.linalg.det(rotations) < 0):
        return (
            "The determinant of the rotation is -1: this is a mirror image, its axes are left-handed. "
            "In a pose n × o = a."
        )
    return ""


def describe(asks: Valued, values: FloatArray, right: FloatArray, unit: str) -> str:
    """Say the first thing that is wrong with values, without the right ones."""
    tolerances = asks.tolerances
    if isinstance(asks, Formula):
        there = np.isfinite(values).reshape(len(values), -1).all(axis=1)
        if there.sum() < max(1, MOST * len(values)):
            return (
                f"This has no value at {np.sum(~there)} of the {len(values)} sets of joint angles tried. "
                "Does it divide by something that may be 0, or take the root of something negative?"
            )
        values, right = values[there], right[there]
    off = np.where(np.isfinite(values), np.abs(values - right), np.inf) > tolerances
    if isinstance(asks, Formula) and np.all(np.ptp(values, axis=0) == 0) and np.any(np.ptp(right, axis=0) > 0):
        return f"This holds no joint angle: leave {', '.join(asks.symbols)} as symbols."
    where = _where(asks, [not at.any() for at in off]) if len(values) > 1 else ""
    if isinstance(asks, Function) and _deaf(asks, values, right):
        return "It gives the same whatever values it is called with. Does it use its own arguments, and all of them?"
    if asks.each:
        rows = [str(k + 1) for k in np.flatnonzero(off.reshape(len(off), off.shape[1], -1).any(axis=(0, 2)))]
        return f"{asks.each.capitalize()} {listed(rows)} {'is' if len(rows) == 1 else 'are'} not right yet.{where}"
    if isinstance(asks, Function) and asks.kinds:
        return f"Not all that it returns is right.{where}"
    if asks.means is not None:
        return f"These values do not lead where they should.{where}"
    if asks.shape == (4, 4):
        return _describe_pose(values, right, off, unit) + where
    if asks.shape == ():
        if np.all(np.abs(values + right) <= tolerances):
            return "The value is right but for its sign."
        return f"The value differs from the right one.{where}"
    wrong = [str(k + 1) for k in np.flatnonzero(off.reshape(len(off), len(off[0]), -1).any(axis=(0, 2)))]
    entries = f"Entries {listed(wrong)} differ" if len(wrong) > 1 else f"Entry {wrong[0]} differs"
    return f"{entries} from what is asked for.{where}"


def _where(asks: Valued, fine: list[bool]) -> str:
    """Say at which of several probes values are right, if they are at some."""
    if not any(fine):
        return ""
    if not isinstance(asks, Function):
        return f" At {sum(fine)} of {len(fine)} sets of joint angles tried it is right, at the others it is not."
    if asks.kinds:
        wrong_kinds = {kind for kind, right in zip(asks.kinds, fine, strict=True) if not right}
        kinds = list(dict.fromkeys(asks.kinds))
        good = [kind for kind in kinds if kind not in wrong_kinds]
        known = f" It is right for {listed(good)}, but not for" if good else " See"
        return f"{known} {listed([kind for kind in kinds if kind in wrong_kinds])}."
    numbers = [call[0] for call in asks.calls if isinstance(call[0], int)]
    if len(numbers) == len(fine):
        wrong = sorted({i for i, right in zip(numbers, fine, strict=True) if not right})
        if good := [str(i) for i in sorted(set(numbers)) if i not in wrong]:
            name = asks.signature.partition("(")[2].partition(",")[0].rstrip(")")
            return f" It is right for {name} = {listed(good)}, but not for {name} = {listed(list(map(str, wrong)))}."
    return f" In {sum(fine)} of {len(fine)} calls it is right, in the others it is not."


def _deaf(asks: Function, values: FloatArray, right: FloatArray) -> bool:
    """Whether calls that differ in their arrays only give the same, while they should not."""
    groups: dict[tuple[object, ...], list[int]] = {}
    for k, call in enumerate(asks.calls):
        groups.setdefault(tuple(argument for argument in call if np.ndim(argument) == 0), []).append(k)
    several = [group for group in groups.values() if len(group) > 1]
    same = all(np.all(np.ptp(values[group], axis=0) <= 1e-9) for group in several)
    return bool(several) and same and any(np.any(np.ptp(right[group], axis=0) > 1e-6) for group in several)


def _describe_pose(values: FloatArray, right: FloatArray, off: NDArray[np.bool_], unit: str) -> str:
    wrong = [name for name, column in zip(COLUMNS, np.moveaxis(off[:, :3], -1, 0), strict=True) if column.any()]
    if wrong == ["p"]:
        distance = np.nanmax(np.linalg.norm((values - right)[:, :3, 3], axis=-1))
        return f"The rotation is right; the position p is {distance:.3g} {unit} away from where it should be."
    if "p" not in wrong:
        return (
            f"The position p is right; the rotation is not: see column{'s' if len(wrong) > 1 else ''} {listed(wrong)}."
        )
    fine = [name for name in COLUMNS if name not in wrong]
    if fine:
        right_ones = f"Column{'s' if len(fine) > 1 else ''} {listed(fine)} {'are' if len(fine) > 1 else 'is'} right"
        return f"{right_ones}; {listed(wrong)} {'are' if len(wrong) > 1 else 'is'} not."
    return (
        "This is a pose, but not the one asked for: all four columns differ. Multiply its factors one at a time, from "
        "the left: which is the first whose result you cannot explain?"
    )


def listed(names: list[str]) -> str:
    """Names in a sentence.

    Examples
    --------
    >>> listed(["n", "o", "p"])
    'n, o and p'
    """
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
