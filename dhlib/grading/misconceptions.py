"""What students are known to get wrong, and what each of them would have got for the very task in hand.

`would_have_given` yields, for a part that is judged by value, every wrong answer that a known misconception leads
to, with the words for it. All words about misconceptions stand here and nowhere else.
"""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise, permutations
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError, DHWarning
from dhlib.grading.exercise import Part, Trap
from dhlib.grading.forms import Arm, Function, Probe, Quantity, Valued
from dhlib.grading.retelling import ORDER, Retelling, altered, in_degrees, scaled, with_ends, with_joints
from dhlib.joints import Joint, Prismatic, Revolute
from dhlib.scalars import FloatArray
from dhlib.transforms import inverse

OTHER = {"classic": "modified", "modified": "classic"}


@dataclass(frozen=True)
class Misconception:
    """A known misconception.

    Parameters
    ----------
    number : int
    key : str
    brief : str
        What to check, in a few words: for when more than one fits.
    section : str
        Label of the section of the book that sets it right.
    credit : float
        Which part of the points such an answer still earns.
    modified : str
        Label of the section for arms of the modified convention, where that is another one.
    """

    number: int
    key: str
    brief: str
    section: str
    credit: float = 0.25
    modified: str = ""

    def where(self, convention: str = "classic") -> str:
        """Label of the section of the book for arms of a convention."""
        return self.modified if convention == "modified" and self.modified else self.section


@dataclass(frozen=True)
class Slip:
    """A misconception as it shows in one answer: the sentence says where."""

    misconception: Misconception
    says: str


# fmt: off
KNOWN = {
    known.key: known
    for known in (
        Misconception(1, "convention", "the convention: classic or modified", "sec-both-trap-formula", 0.5,
                      "sec-modified-trap-formula"),
        Misconception(2, "row", "the row in which a and α stand", "sec-classic-trap-row",
                      modified="sec-modified-trap-row"),
        Misconception(3, "offset", "the offset between q and θ", "sec-classic-variable", 0.5,
                      "sec-modified-parameters"),
        Misconception(4, "sense", "the sense in which a joint turns", "sec-classic-variable", 0.5,
                      "sec-modified-parameters"),
        Misconception(5, "parallel", "where d stands along parallel axes", "sec-placing-parallel", 1.0),
        Misconception(6, "a_and_d", "which length is a and which is d", "sec-classic-parameters",
                      modified="sec-modified-parameters"),
        Misconception(7, "sign", "the sign of α", "sec-classic-trap-sign", 0.5, "sec-modified-parameters"),
        Misconception(8, "ends", "base and tool, and on which side they stand", "sec-base-and-tool", 0.5),
        Misconception(9, "degrees", "degrees and radians", "sec-trap-degrees", 0.5),
        Misconception(10, "unit", "the unit of length", "sec-bt-trap-units", 0.75),
        Misconception(11, "reverse", "the order of the product", "sec-trap-order"),
        Misconception(12, "transpose", "rows and columns, and which frame is seen from which", "sec-trap-rows", 0.5),
        Misconception(13, "joint_kind", "which parameter the joint moves", "sec-prismatic-row"),
        Misconception(14, "steps", "the order of the four steps", "sec-classic-trap-order",
                      modified="sec-modified-orders"),
        Misconception(15, "improper", "whether the matrix is a rotation at all", "sec-pose", 0.0),
        Misconception(16, "entrywise", "* and @", "sec-trap-order"),
        Misconception(17, "length_sign", "the sign of a or d", "sec-classic-parameters", 0.5,
                      "sec-modified-parameters"),
        Misconception(18, "lengths", "which length belongs to which link", "sec-classic-parameters", 0.5,
                      "sec-modified-parameters"),
        Misconception(19, "missing", "whether each link matrix is in the product, once", "sec-classic-product",
                      modified="sec-modified-product"),
        Misconception(20, "counting", "counting from 0 or from 1", "sec-classic-product",
                      modified="sec-modified-product"),
    )
}
# fmt: on
#: A wrong answer that one exercise knows of itself.
TRAP = Misconception(0, "trap", "the task itself", "")


#: Where the first fits, the others are the same mistake in part: the other convention is another order of the steps,
#: and its first row stands one row off.
COVERS = {
    "trap": frozenset(KNOWN),
    "convention": frozenset({"steps", "row"}),
    "row": frozenset({"sign", "length_sign", "lengths", "a_and_d"}),
}

Told = Iterator[tuple[str, str, Arm]]
"""Key of a misconception, what to say, and the arm as it is then told."""


def retellings(chain: Chain) -> Told:
    """The arm as each known misconception would have it.

    In the sentences ``{part}`` is the name of the part.
    """
    yield from _conventions(chain)
    yield from _rows(chain)
    yield from _joints(chain)
    yield from _parameters(chain)
    yield from _ends(chain)
    yield from _units(chain)
    yield from _products(chain)
    says = "{part} is multiplied entry by entry: for arrays the product of matrices is @, and * is another thing."
    yield "entrywise", says, Retelling(chain, entrywise=True)
    yield from _orders(chain)


def _conventions(chain: Chain) -> Told:
    asked, other = chain.convention, OTHER[chain.convention]
    converted = chain.to_modified() if other == "modified" else chain.to_classic()
    yield (
        "convention",
        f"Your {{part}} is right for the {other} convention; this part asks for the {asked} one.",
        converted,
    )
    yield (
        "convention",
        f"Your numbers are right, but {{part}} takes its four steps in the order of the {other} convention: "
        f"{' '.join(ORDER[other])}. Here it is {' '.join(ORDER[asked])}.",
        with_joints(chain, chain.joints, other),
    )


def _rows(chain: Chain) -> Told:
    links = [(joint.a, joint.alpha) for joint in chain.joints]
    shifted = [("down", [(0.0, 0.0), *links[:-1]]), ("up", [*links[1:], (0.0, 0.0)])]
    if len(links) != 2 or any(alpha for _, alpha in links):  # two lengths that change places are another slip
        shifted += [("down", [links[-1], *links[:-1]]), ("up", [*links[1:], links[0]])]
    for words, moved in shifted:
        joints = [joint.replace(a=a, alpha=alpha) for joint, (a, alpha) in zip(chain.joints, moved, strict=True)]
        yield (
            "row",
            f"In {{part}} the columns a and α stand one row too far {words}: "
            + (
                "in the classic convention row i holds the link behind joint i."
                if chain.convention == "classic"
                else "in the modified convention row i holds the link before joint i."
            ),
            with_joints(chain, joints),
        )


def _joints(chain: Chain) -> Told:
    for i, joint in enumerate(chain.joints, 1):
        if joint.offset != 0:
            says = f"In {{part}} joint {i} starts from another zero: {_variable(joint)} is q{i} plus an offset."
            yield "offset", says, altered(chain, i, **{joint.variable: 0.0})
            yield "offset", says, altered(chain, i, **{joint.variable: -joint.offset})
    if any(joint.offset != 0 for joint in chain.joints):
        yield (
            "offset",
            "In {part} the offsets between q and θ are missing.",
            with_joints(chain, [joint.replace(**{joint.variable: 0.0}) for joint in chain.joints]),
        )
    for i, joint in enumerate(chain.joints, 1):
        yield (
            "sense",
            f"In {{part}} joint {i} {'turns' if joint.kind == 'R' else 'slides'} the wrong way: compare the sign of "
            f"{_variable(joint)}{i} with the direction of its axis.",
            altered(chain, i, sign=-joint.sign),
        )
        yield "joint_kind", _kind_sentence(i, joint), _other_kind(chain, i)
    yield (
        "sense",
        "In {part} all joints turn the wrong way: positive is by the right-hand rule about z.",
        altered(chain, sign=lambda joint: -joint.sign),
    )


def _variable(joint: Joint) -> str:
    return "θ" if joint.kind == "R" else "d"


def _kind_sentence(i: int, joint: Joint) -> str:
    if joint.kind == "R":
        return f"In {{part}} the variable of joint {i} stands in d; it is revolute, so q{i} belongs into θ."
    return f"In {{part}} joint {i} turns where it should slide; it is prismatic, so q{i} belongs into d."


def _other_kind(chain: Chain, i: int) -> Chain:
    joint = chain.joints[i - 1]
    link: dict[str, Any] = {"a": joint.a, "alpha": joint.alpha, "sign": joint.sign}
    if joint.kind == "R":
        other: Joint = Prismatic(theta=joint.theta, offset=joint.d, **link)
    else:
        other = Revolute(d=joint.d, offset=joint.theta, **link)
    return with_joints(chain, [*chain.joints[: i - 1], other, *chain.joints[i:]])


def _parameters(chain: Chain) -> Told:
    classic = chain.convention == "classic"
    for i, joint in enumerate(chain.joints, 1):
        k = i if classic else i - 1
        yield "sign", f"In {{part}} α_{k} has the wrong sign.", altered(chain, i, alpha=-joint.alpha)
        yield (
            "length_sign",
            f"In {{part}} a_{k} has the wrong sign: it is measured along x_{k}, from axis to axis.",
            altered(chain, i, a=-joint.a),
        )
        if joint.kind == "R":
            yield (
                "length_sign",
                f"In {{part}} d_{i} has the wrong sign: it counts from x_{i - 1} to x_{i}, along joint axis {i}.",
                altered(chain, i, d=-joint.d),
            )
            exchanged = altered(chain, i, a=joint.d, d=joint.a)
            yield "a_and_d", f"In {{part}} a_{k} and d_{i} are exchanged: d is measured along z, a along x.", exchanged
    yield (
        "sign",
        "In {part} every α has the wrong sign: α turns z into the next z, by the right-hand rule about x.",
        altered(chain, alpha=lambda joint: -joint.alpha),
    )
    for i, (joint, after) in enumerate(pairwise(chain.joints), 1):
        k = i if classic else i - 1
        if joint.a != 0 and after.a != 0:
            yield (
                "lengths",
                f"In {{part}} a_{k} and a_{k + 1} have changed places: a_{k} is the length of link {k}, which stands "
                f"before joint {k + 1}.",
                altered(altered(chain, i, a=after.a), i + 1, a=joint.a),
            )
    yield (
        "length_sign",
        "In {part} every a has the wrong sign: a is measured along x.",
        altered(chain, a=lambda joint: -joint.a),
    )
    if set(chain.kinds) == {"R"}:
        exchanged = altered(chain, a=lambda joint: joint.d, d=lambda joint: joint.a)
        yield "a_and_d", "In {part} a and d are exchanged: d is measured along z, a along x.", exchanged


def _products(chain: Chain) -> Told:
    says = "The factors of {part} stand in reverse order: the link nearest the base comes first."
    yield "reverse", says, Retelling(chain, reverse=True)
    for i in range(1, chain.n + 1):
        says = f"In {{part}} the link matrix of joint {i} is missing: each joint on the way has one factor."
        yield "missing", says, Retelling(chain, without=i)


def _ends(chain: Chain) -> Told:
    Z, E = chain.base, chain.tool
    for says, base, tool in (
        ("{part} leaves out the base: X = Z T E.", None, E),
        ("{part} leaves out the tool: X = Z T E.", Z, None),
        ("{part} leaves out base and tool: X = Z T E.", None, None),
        ("In {part} base and tool have changed places: the base Z stands on the left, the tool E on the right.", E, Z),
        (
            "In {part} the tool stands before the arm: it belongs to the last frame, so E stands on the right.",
            Z @ E,
            None,
        ),
        (
            "In {part} the tool stands before the arm: it belongs to the last frame, so E stands on the right.",
            E @ Z,
            None,
        ),
        ("In {part} the base stands behind the arm: it carries the arm, so Z stands on the left.", None, Z @ E),
        ("In {part} the base stands behind the arm: it carries the arm, so Z stands on the left.", None, E @ Z),
        ("In {part} the base is the wrong way round: Z and its inverse are exchanged.", inverse(Z), E),
        ("In {part} the tool is the wrong way round: E and its inverse are exchanged.", Z, inverse(E)),
        (
            "In {part} base and tool are the wrong way round: each is exchanged with its inverse.",
            inverse(Z),
            inverse(E),
        ),
    ):
        yield "ends", says, with_ends(chain, base, tool)


def _units(chain: Chain) -> Told:
    says = {
        (True, True): "In {part} angles are taken in the wrong unit: cos, sin and dhlib take radians.",
        (True, False): "In {part} joint angles are taken in the wrong unit: cos and sin take radians, so 30° is pi/6.",
        (False, True): "In {part} α is taken in the wrong unit: cos and sin take radians, so 90° is pi/2.",
    }
    for told in in_degrees(chain):
        yield "degrees", says[told.joint_scale != 1, told.twist_scale != 1], told
    for factor in (1000, 0.001, 10, 0.1, 100, 0.01):
        size = f"{factor:g} times too large" if factor > 1 else f"{1 / factor:g} times too small"
        yield "unit", f"In {{part}} lengths are {size}: they are asked for in {chain.unit}.", scaled(chain, factor)


def _orders(chain: Chain) -> Told:
    order = ORDER[chain.convention]
    other = ORDER[OTHER[chain.convention]]
    for steps in permutations(order):
        if set(steps[:2]) != set(other[:2]):  # that is the other convention, since both steps of a screw commute
            yield (
                "steps",
                f"The four steps of {{part}} come in another order than {' '.join(order)}.",
                Retelling(chain, steps=steps),
            )


def retold(chain_at: Callable[..., Chain], quantity: Quantity, example: Probe) -> list[Trap]:
    """Traps for a quantity whose arm is made from the probe itself, such as a link matrix as a function.

    Parameters
    ----------
    chain_at : callable
        ``chain_at(*probe)``, the arm of a probe.
    quantity : callable
        ``quantity(arm, *probe)``, as for a part; it is asked of every retelling of that arm.
    example : tuple
        Any probe: which retellings there are must not depend on it.
    """

    @lru_cache(maxsize=64)
    def at(*probe: Any) -> list[tuple[str, str, Any]]:
        # Each trap asks for one of them, at each probe: made anew for each, they would take seconds a part.
        return list(retellings(chain_at(*probe)))

    def told(k: int) -> Quantity:
        return lambda _, *probe: quantity(at(*probe)[k][2], *probe)

    return [Trap(says, told(k), key) for k, (key, says, _) in enumerate(at(*example))]


def finishings(values: FloatArray) -> Iterator[tuple[str, str, FloatArray]]:
    """Right poses (…, 4, 4), handed in as something else."""
    rotated = values.copy()
    rotated[..., :3, :3] = np.swapaxes(values[..., :3, :3], -1, -2)
    for says, told in (
        (
            "{part} is transposed: the axes of the frame are the columns, and the last row is 0 0 0 1.",
            np.swapaxes(values, -1, -2),
        ),
        ("{part} is the inverse of what is asked: it sees the first frame from the second.", inverse(values)),
        ("In {part} the rotation is transposed: the columns are the axes of the moved frame.", rotated),
    ):
        yield "transpose", says, told


def ends_too_many(chain: Chain, values: FloatArray) -> Iterator[tuple[str, str, FloatArray]]:
    """Right poses with base or tool multiplied on, where they do not belong."""
    Z, E = chain.base, chain.tool
    for says, told in (
        ("{part} includes the base, which is not asked for here.", Z @ values),
        ("{part} includes the tool, which is not asked for here.", values @ E),
        ("{part} includes base and tool, which are not asked for here.", Z @ values @ E),
    ):
        yield "ends", says, told


def miscounted(part: Part, asks: Function) -> Iterator[tuple[str, str, FloatArray]]:
    """What a function of a link's number and the joint values gives that counts wrongly."""

    def told(link: int, value: int) -> FloatArray:
        calls = [((i - 1 + link) % part.chain.n + 1, np.roll(q, value)) for i, q in asks.calls]
        return np.array([np.asarray(asks.quantity(part.chain, *call), dtype=float) for call in calls])

    says = "{part} gives the link before the one asked for: links count from 1, so link i is in row i - 1 of a list."
    yield "counting", says, told(-1, 0)
    says = "{part} takes the value of the joint before: joints count from 1, so that of joint i is q[i - 1]."
    yield "counting", says, told(0, 1)


@lru_cache(maxsize=256)
def would_have_given(part: Part) -> tuple[tuple[Slip, FloatArray], ...]:
    """Every answer to a part that a known misconception leads to, with the words for it.

    Worked out once for each part, since a class hands in many answers to it.

    Returns
    -------
    tuple of (Slip, ndarray (probes, *shape))
    """
    return tuple(_would_have_given(part))


def _would_have_given(part: Part) -> Iterator[tuple[Slip, FloatArray]]:
    asks = part.asks
    if not isinstance(asks, Valued):
        return
    for trap in part.traps:
        yield (
            Slip(KNOWN.get(trap.key, TRAP), trap.says.replace("{part}", part.id)),
            np.array([np.asarray(trap.quantity(part.chain, *p), dtype=float) for p in asks.probes]),
        )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DHWarning)
        right = asks.values(part.chain)
        if isinstance(asks, Function) and asks.signature.endswith("(i, q)"):
            for key, says, values in miscounted(part, asks):
                yield Slip(KNOWN[key], says.format(part=part.id)), values
        if asks.shape == (4, 4):
            for key, says, values in (*finishings(right), *ends_too_many(part.chain, right)):
                yield Slip(KNOWN[key], says.format(part=part.id)), values
        for key, says, arm in retellings(part.chain):
            try:
                values = asks.values(arm)
            except DHError:  # a quantity that this retelling cannot give
                continue
            yield Slip(KNOWN[key], says.format(part=part.id)), values


def name_one(fitting: list[Slip]) -> Slip | None:
    """The one misconception that fits, or what those that fit have in common; None if none does.

    The first slip of a misconception speaks for it, since wider ones come first.
    """
    by_key = {slip.misconception.key: slip for slip in reversed(fitting)}
    for key, narrower in COVERS.items():
        if key in by_key:
            by_key = {k: slip for k, slip in by_key.items() if k not in narrower}
    if len(by_key) <= 1:
        return next(iter(by_key.values()), None)
    slips = sorted(by_key.values(), key=lambda slip: slip.misconception.number)
    known = [slip.misconception for slip in slips]
    checks = ", or ".join(each.brief for each in known[:3])
    key = "+".join(each.key for each in known)
    several = replace(known[0], number=0, key=key, brief=checks, credit=min(each.credit for each in known))
    count = {2: "Two", 3: "Three"}.get(len(slips), "Several")
    told = ", or ".join(_clause(slip.says) for slip in slips[:3])
    return Slip(several, f"{count} slips lead to this very answer: {told}. {_common(slips)}".rstrip())


#: What two slips have in common that lead to one answer.
COMMON = {
    frozenset({"sense", "sign"}): "Either way it is a sign.",
    frozenset({"sense", "transpose"}): "Either way a turn goes backwards.",
    frozenset({"sense", "steps"}): "Either way a turn or a slide stands on the wrong side of a twist.",
    frozenset({"sign", "transpose"}): "Either way a twist goes backwards.",
    frozenset({"sign", "length_sign"}): "Either way it is a sign.",
    frozenset({"sense", "length_sign"}): "Either way it is a sign.",
    frozenset({"transpose", "length_sign"}): "Either way the link leads backwards.",
    frozenset({"length_sign", "lengths"}): "Either way it is the column of a.",
    frozenset({"convention", "reverse"}): "Either way the factors come in another order.",
    frozenset({"offset", "transpose"}): "Either way a fixed angle goes backwards.",
}
#: Numbers of joints in what is said of a slip.
JOINT = re.compile(r"\bjoint (\d+)|\b[θd]_?(\d+)")
FIRST_WORDS = ("The", "It", "This", "Your", "These", "Each", "All", "Lengths")


def _clause(says: str) -> str:
    """What is said of a slip, without where and without why: so that two of them make one sentence."""
    clause = re.sub(r"^In \w+ ", "", re.split(r"[:;.]", says, maxsplit=1)[0])
    first = clause.partition(" ")[0]
    return f"{clause[:1].lower()}{clause[1:]}" if first in FIRST_WORDS else clause


def _common(slips: list[Slip]) -> str:
    """What slips have in common: one joint, or one kind of thing."""
    joints = [{number for found in JOINT.findall(_clause(slip.says)) for number in found if number} for slip in slips]
    if len(shared := set.intersection(*joints)) == 1:
        return f"Either way it is joint {shared.pop()}."
    return COMMON.get(frozenset(slip.misconception.key for slip in slips), "")


def told_frames(chain: Chain, convention: str) -> Iterator[tuple[Slip, FloatArray]]:
    """Frames of a chain at q = 0, as the known misconceptions place them."""
    right, other = chain.to_classic(), chain.to_modified()
    if convention == "modified":
        right, other = other, right
    zero = np.zeros(chain.n)
    frames = right.frames(zero)
    name = OTHER[convention]
    yield (
        Slip(
            KNOWN["convention"],
            f"These are the frames of the {name} convention: there frame i stands on axis "
            f"{'i' if name == 'modified' else 'i + 1'}. This part asks for the {convention} one.",
        ),
        other.frames(zero),
    )
    links = np.array([inverse(before) @ after for before, after in pairwise(frames)])
    yield (
        Slip(
            KNOWN["transpose"],
            "Each frame is given in the one before it; all are asked for in the base frame: multiply them up.",
        ),
        np.concatenate([frames[:1], links]),
    )
    yield (
        Slip(
            KNOWN["transpose"],
            "Each frame is inverted: this is the base seen from frame i; asked for is frame i seen from the base.",
        ),
        inverse(frames),
    )
    for factor in (1000, 0.001, 10, 0.1, 100, 0.01):
        size = f"{factor:g} times too large" if factor > 1 else f"{1 / factor:g} times too small"
        longer = frames.copy()
        longer[:, :3, 3] *= factor
        yield Slip(KNOWN["unit"], f"Lengths are {size}: they are asked for in {chain.unit}."), longer
