"""What exercises ask for again and again, with the wrong answers that it invites."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from string import ascii_lowercase
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.grading.exercise import Follows, Part, Trap
from dhlib.grading.forms import Arm, Choice, Function, Numbers, Probe, Quantity, Reason, ReasonedChoice
from dhlib.scalars import FloatArray
from dhlib.transforms import inverse

#: Tolerances of numbers that the page asks for to three decimals, of metres too.
METRES = {"tolerance": 1e-3, "length_tolerance": 1e-3}
#: Tolerances of formulas, in metres.
EXACT = {"length_tolerance": 1e-5}


# Quantities


def pose(i: int, j: int) -> Quantity:
    """Frame j in frame i.

    Examples
    --------
    >>> from dhlib import robots
    >>> pose(0, 2)(robots.planar(2), [0, 0])[:3, 3]
    array([2., 0., 0.])
    """
    return lambda arm, q: arm.T(i, j, q)


def constant(value: Any) -> Quantity:
    """A value that depends on no arm and no joint angles, since the page gives all it takes."""
    return lambda arm, *probe: value


def joint_values(kinds: str, values: Sequence[float]) -> tuple[float, ...]:
    """A joint vector of angles in degrees and slides in the arm's unit.

    Examples
    --------
    >>> joint_values("RP", [180, 0.5])
    (3.141592653589793, 0.5)
    """
    return tuple(float(np.deg2rad(v) if kind == "R" else v) for kind, v in zip(kinds, values, strict=True))


def link_calls(n: int, seed: int, rounds: int = 2) -> list[Probe]:
    """Calls ``(i, q)`` of a function for any link: every link, at joint values without any pattern."""
    q = np.random.default_rng(seed).uniform(-3, 3, (rounds * n, n))
    return [(i, tuple(map(float, at))) for i, at in zip([*range(1, n + 1)] * rounds, q, strict=True)]


def link_function(n: int, seed: int, rounds: int = 2, length_tolerance: float = 1e-5, name: str = "link") -> Function:
    """Any link of an arm, as a function of its number and the joint vector."""
    return Function(
        lambda arm, i, q: arm.A(i, q),
        calls=link_calls(n, seed, rounds),
        signature=f"{name}(i, q)",
        length_tolerance=length_tolerance,
    )


def slide_converted(n: int, slide: int) -> Trap:
    """The last pose of somebody who converts the whole joint vector to radians, the slide too."""

    def all_converted(arm: Arm, q: Probe) -> Any:
        return arm.T(0, n, [np.deg2rad(value) if i == slide else value for i, value in enumerate(q, 1)])

    says = f"Joint {slide} was converted to radians too. It slides: metres stay metres."
    return Trap(says, all_converted, "degrees")


# Parts


def last_pose(
    n: int,
    at: Sequence[float],
    quarters: Sequence[float],
    section: str,
    arm: Chain | None = None,
    traps: Sequence[Trap] = (),
    at_quarters: str = "",
) -> list[Part]:
    """Two parts: the pose of frame n in numbers, in metres, at the joint values of the page and at quarter turns.

    Parameters
    ----------
    n : int
        Of the last frame; the parts are called after it, ``T6`` and ``T6_quarter``.
    at, quarters : sequence of float
    section : str
    arm : Chain, optional
    traps : sequence of Trap
        Of the first part.
    at_quarters : str, optional
        The section of the second part, if it is another.
    """

    def asked(part: str, title: str, points: float, values: Sequence[float], **more: Any) -> Part:
        asks = Numbers(
            pose(0, n), at=values, tolerance=METRES["tolerance"], length_tolerance=METRES["length_tolerance"]
        )
        return Part(part, title, points, asks, arm=arm, kinematics=False, **more)

    return [
        asked(f"T{n}", f"T{n} in numbers", 2, at, section=section, traps=traps),
        asked(f"T{n}_quarter", f"T{n} at quarter turns", 1, quarters, section=at_quarters or section),
    ]


def which_lengths(found: Callable[[str], FloatArray], sets: Sequence[str], right: str, section: str) -> Part:
    """Which set of lengths an arm has whose position was measured.

    Parameters
    ----------
    found : callable
        Where the flange would be with each set, in metres.
    sets : sequence of str
    right : str
    section : str
    """
    off = {each: 1000 * float(np.linalg.norm(found(each) - found(right))) for each in sets}
    because = {
        each: f"the position by set {each} agrees with the measured one to the last digit."
        if each == right
        else f"with set {each} the flange is {away:.0f} mm from where it was measured."
        for each, away in off.items()
    }
    return choice("lengths", "Which set of lengths", right, because, section, points=2)


def choice(part: str, title: str, right: str, because: Mapping[str, str], section: str, points: float = 1) -> Part:
    """One of several options; the words say why, or what to look at."""
    return Part(part, title, points, Choice(because, right), section=section)


Claims = Mapping[str, tuple[bool, str]]
"""Statements: whether each holds, and what to say to whoever chose it."""


def holding(claims: Claims, holds: bool = True) -> list[str]:
    """The statements that hold, or those that do not.

    Examples
    --------
    >>> holding({"it turns": (True, "Yes."), "it slides": (False, "No.")}, False)
    ['it slides']
    """
    return [claim for claim, (right, _) in claims.items() if right is holds]


def which_holds(part: str, title: str, shown: Sequence[str], claims: Claims, section: str, points: float = 1) -> Part:
    """Which one of the statements shown holds, by its letter."""
    letters = dict(zip(ascii_lowercase, shown, strict=False))
    (right,) = (letter for letter, claim in letters.items() if claims[claim][0])
    return choice(part, title, right, {letter: claims[claim][1] for letter, claim in letters.items()}, section, points)


def reasons_by_letter(order: Sequence[str], says: Mapping[str, str]) -> dict[str, str]:
    """What to say of each reason, by the letter under which the page lists it."""
    return {letter: says[reason] for letter, reason in zip(ascii_lowercase, order, strict=False)}


def reasoned(
    part: str,
    title: str,
    right: str,
    because: Mapping[str, str],
    reasons: Mapping[str, str],
    section: str,
    points: float = 1,
) -> Part:
    """One of several options, and the letters of the reasons that hold.

    Parameters
    ----------
    reasons : mapping of str to str
        By letter, what to say to whoever gives it; empty if it holds.
    """
    letters = {letter: Reason(not says, says) for letter, says in reasons.items()}
    return Part(part, title, points, ReasonedChoice(because, right, letters), section=section)


def number(
    part: str,
    title: str,
    right: float,
    section: str,
    traps: Sequence[tuple[float, str] | tuple[float, str, str]],
    points: float = 1,
    tolerance: float = 1e-3,
) -> Part:
    """One number, with the wrong ones that a slip leads to: each with its words, and its key if it is a known slip."""
    told = [Trap(says, constant(wrong), *key) for wrong, says, *key in traps]
    asks = Numbers(constant(right), shape=(), at=(), tolerance=tolerance)
    return Part(part, title, points, asks, section=section, traps=told)


def with_gripper(
    arm: Chain,
    of: str,
    titles: tuple[str, str],
    joints: Sequence[float],
    hidden: Sequence[float],
    tolerance: float = 1e-3,
    length_tolerance: float = 0.1,
) -> list[Part]:
    """Two parts about X = Z T E: ``X`` at some joint values, and T from an X that was measured.

    Parameters
    ----------
    arm : Chain
        With base Z and tool E.
    of : str
        The part that asks for T at `joints`; the second part is called after it, such as ``T4_back``.
    titles : pair of str
    joints, hidden : sequence of float
        Where X is asked for, and where it was measured, which the page does not say.
    tolerance, length_tolerance : float
        As of `Numbers`.
    """
    Z, E = arm.base, arm.tool
    measured = measured_at(arm, hidden)
    traps = [
        Trap(
            "Z and E are transposed here; the inverse of a pose is more than that, since p is turned too.",
            constant(Z.T @ measured @ E.T),
        ),
        Trap(
            "The two inverses have changed places: Z⁻¹ stands on the left, E⁻¹ on the right.",
            constant(inverse(E) @ measured @ inverse(Z)),
        ),
    ]

    def forth(arm: Arm, q: Probe) -> FloatArray:
        pose: FloatArray = arm.fk(q)
        return pose

    def back(arm: Arm, q: Probe) -> FloatArray:
        pose: FloatArray = inverse(arm.base) @ measured @ inverse(arm.tool)
        return pose

    def numbers(quantity: Quantity, at: Sequence[float]) -> Numbers:
        return Numbers(quantity, at=at, tolerance=tolerance, length_tolerance=length_tolerance)

    follows = Follows([of], lambda T: Z @ T @ E)
    section = "sec-base-and-tool"
    return [
        Part("X", titles[0], 2, numbers(forth, joints), section, arm, follows=follows),
        Part(f"{of}_back", titles[1], 2, numbers(back, hidden), section, arm, traps),
    ]


def measured_at(arm: Chain, hidden: Sequence[float]) -> FloatArray:
    """The pose of the tool as somebody measured it."""
    return np.asarray(arm.fk(hidden), dtype=float).round(6)
