"""What the exercise on the Stanford arm asks, and how it is marked."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from dhlib import Axis, Chain, place_frames, robots, same_mechanism
from dhlib.grading.asking import (
    EXACT,
    choice,
    holding,
    joint_values,
    last_pose,
    link_function,
    pose,
    slide_converted,
    which_holds,
)
from dhlib.grading.course.sources import lengths, lettered, number, row
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Formula, Frames, Numbers, Table
from dhlib.grading.pictures import described, same_for_all
from dhlib.grading.retelling import altered

STANFORD = robots.stanford("classic")
KINDS = STANFORD.kinds
#: Which z is which axis, by the numbering of each convention.
CLAIMS = {
    f"axis {i}{', the slide,' if i == 3 else ''} is z_{k} in the {name} frames": (
        k == right,
        "a classic row begins with the turn and the slide, about and along the old z: z_i-1 is axis i."
        if name == "classic"
        else "a modified row ends with the turn and the slide, about and along the new z: z_i is axis i.",
    )
    for i in (2, 3, 5)
    for name, right in (("classic", i - 1), ("modified", i))
    for k in (i - 1, i)
}
#: Changes in the classic table: row and column, and the new value.
CHANGES = {
    "d_2 turned round": ((2, "d"), lambda given: -given.d2),
    "alpha_1 turned round": ((1, "alpha"), lambda given: np.pi / 2),
    "alpha_2 turned round": ((2, "alpha"), lambda given: -np.pi / 2),
    "d_1 longer": ((1, "d"), lambda given: given.d1 + 0.05),
    "d_2 longer": ((2, "d"), lambda given: given.d2 + 0.05),
    "alpha_4 smaller": ((4, "alpha"), lambda given: -np.pi / 3),
    "a_1 there": ((1, "a"), lambda given: 0.05),
}
#: Which axis is drawn elsewhere, and how far away.
MOVED = [
    (3, (0.3, 0, 0)),
    (3, (0.2, 0, 0)),
    (3, (0, 0.1, 0)),
    (3, (0, 0, 0.25)),
    (2, (0, 0.2, 0)),
    (5, (0.15, 0, 0)),
    (4, (0, 0.05, 0)),
    (5, (0, 0.06, 0)),
]


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in m, angles in degrees."""

    d1: float = STANFORD.joints[0].d
    d2: float = STANFORD.joints[1].d
    d6: float = STANFORD.joints[5].d
    #: Joint values, of which the third is a slide.
    values: tuple[float, ...] = (30, 60, 0.5, 40, -50, 70)
    claims: tuple[str, ...] = (
        "axis 3, the slide, is z_3 in the classic frames",
        "axis 3, the slide, is z_2 in the modified frames",
        "axis 3, the slide, is z_2 in the classic frames",
        "axis 5 is z_4 in the modified frames",
    )
    #: What somebody changes in the classic table, and which axis somebody else draws elsewhere.
    change: str = "d_2 turned round"
    moved: tuple[int, tuple[float, ...]] = (3, (0.3, 0, 0))

    @property
    def arm(self):
        first, second, *rest, last = STANFORD.joints
        joints = [first.replace(d=self.d1), second.replace(d=self.d2), *rest, last.replace(d=self.d6)]
        return Chain(joints, "classic", name=STANFORD.name)


DEFAULT = Given()


#: Parts with one answer for everybody: the slide has no length but its variable.
SAME_FOR_ALL = ("A3", "A3_modified")


def draw(lots):
    """Another arm of this kind: no length and no angle is that of the book."""
    sizes = lots.some("angles", range(21, 77, 5), 5)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, 1, 1, -1, 1), (-1, 1, 1, -1, 1), (1, -1, -1, 1, 1), (-1, 1, -1, 1, -1)])
    first, second, *wrist = (sign * size for sign, size in zip(signs, sizes, strict=True))
    return Given(
        d1=lots.one("d1", [0.364, 0.376, 0.388, 0.4, 0.424, 0.436, 0.448]),
        d2=lots.one("d2", [0.127, 0.133, 0.139, 0.145, 0.163, 0.169, 0.175]),
        d6=lots.one("d6", [0.217, 0.224, 0.231, 0.238, 0.245, 0.252]),
        values=(first, second, lots.one("slide", [0.43, 0.44, 0.46, 0.47, 0.53, 0.54, 0.56]), *wrist),
        claims=lots.one_right("claims", holding(CLAIMS), holding(CLAIMS, False)),
        change=lots.one("change", list(CHANGES)[1:]),
        moved=lots.one("moved", list(MOVED)[1:]),
    )


def cells(given):
    """The given cells of the notebook."""
    first, second, slide, *wrist = given.values
    return {
        "arm": lengths("metres", d1=given.d1, d2=given.d2, d6=given.d6),
        "joints": f"""\
# The joint vector: angles in radians, the slide in metres
q = np.deg2rad({row((first, second, 0, *wrist))})
q[2] = {number(slide)}""",
        "claims": lettered("claims", given.claims),
        "change": changed_number(given),
        "moved": f"moved, way = {given.moved[0]}, {row(given.moved[1])}",
    }


def changed_number(given):
    """Which number of the classic table somebody writes otherwise, as source."""
    (i, column), value = CHANGES[given.change]
    quarters = {90: "pi / 2", -90: "-pi / 2", -60: "-pi / 3"}
    new = quarters[round(np.rad2deg(value(given)))] if column == "alpha" else number(value(given))
    return f'row, column, value = {i}, "{column}", {new}'


@same_for_all
def figure():
    """The arm that the page describes, with its boom pushed out, so that its axes are apart."""
    return described(
        STANFORD,
        "The arm with its boom pushed out, all angles zero, not to scale: its joint axes, and the base frame {0}",
        "Axis 1 rises from the origin of frame 0. At the height d1 axis 2 points to the left; d2 leads along it to the "
        "boom. The boom slides upwards along axis 3, with which axes 4 and 6 coincide. Axis 5 points forward through "
        "the wrist centre, and the hand is d6 above it.",
        q=(0, 0, 0.45, 0, 0, 0),
        lengths={"d_1": "d1", "d_2": "d2", "d_6": "d6"},
    )


SYMBOLS = ["theta1", "theta2", "d3", "theta4", "theta5", "theta6"]
QUARTERS = joint_values(KINDS, [90, 90, 0.5, 90, -90, 180])
STEP = 0.1


def pushed(arm, q):
    """How the hand moves when joint 3 goes on by a step."""
    further = [*q[:2], q[2] + STEP, *q[3:]]
    return arm.T(0, 6, further)[:3, 3] - arm.T(0, 6, q)[:3, 3]


def fixed_angle(i, j):
    """What becomes of frame j in frame i without the fixed angle of the slide, or with its other sign."""
    x = "x_2 points forward and x_3 to the right"
    return [
        Trap(f"The fixed angle θ3 is missing: {x}.", lambda arm, q: altered(arm, 3, theta=0.0).T(i, j, q), "offset"),
        Trap(
            f"The fixed angle θ3 has the wrong sign: {x}.",
            lambda arm, q: altered(arm, 3, theta=np.pi / 2).T(i, j, q),
            "offset",
        ),
    ]


def wrist(given, d2_sign=1, cosine_for_sine=False, with_foot=True):
    """The wrist centre with something done differently."""

    def p(arm, q):
        c1, s1, c2, s2 = np.cos(q[0]), np.sin(q[0]), np.cos(q[1]), np.sin(q[1])
        out, up = (c2, s2) if cosine_for_sine else (s2, c2)
        aside, foot = d2_sign * given.d2, with_foot * given.d1
        return [q[2] * c1 * out - aside * s1, q[2] * s1 * out + aside * c1, q[2] * up + foot]

    return p


@cache
def keeps_the_arm(change):
    """Whether a change in the table leaves the same arm: that does not depend on the lengths."""
    (i, column), value = CHANGES[change]
    return bool(same_mechanism(altered(DEFAULT.arm, i, **{column: value(DEFAULT)}), DEFAULT.arm))


def shoulder(given):
    """The part that asks what a change in the table makes of the arm."""
    same = keeps_the_arm(given.change)
    because = {
        "the same arm": "it takes nothing but another zero or sense of joints, or another base."
        if same
        else "the distances and angles between neighbouring axes: is one of them another?",
        "the mirror image": "this arm is its own mirror image: there is a turn that makes the one into the other.",
        "another arm": "try it: turn joint 1 by half a turn, let joint 2 count the other way, put the base elsewhere."
        if same
        else f"a size has changed that lies between axes: that of {given.change.split()[0]}.",
    }
    return choice(
        "shoulder", "Another number", "the same arm" if same else "another arm", because, "sec-prismatic-mirror"
    )


def drawn_axes(moved=0, way=(0, 0, 0)):
    """The table of the arm by its axes, one of which is drawn elsewhere."""
    up, left, forward = (0, 0, 1), (0, 1, 0), (1, 0, 0)
    wrist = (0, DEFAULT.d2, DEFAULT.d1)
    lines = [((0, 0, 0), up), ((0, 0, DEFAULT.d1), left), (wrist, up), (wrist, up), (wrist, forward), (wrist, up)]
    axes = [
        Axis(np.add(point, way if i == moved else 0), direction, "P" if i == 3 else "R")
        for i, (point, direction) in enumerate(lines, 1)
    ]
    placed, _ = place_frames(axes, end=DEFAULT.arm.frames(np.zeros(6))[-1])
    return placed


@cache
def drawn_elsewhere(moved, way):
    """What becomes of the table if an axis is drawn elsewhere: that does not depend on the lengths."""
    before, after = drawn_axes(), drawn_axes(moved, way)
    lengths = [np.array([[joint.d, joint.a] for joint in arm.joints], dtype=float) for arm in (before, after)]
    if not same_mechanism(after, before):
        return "another arm"
    return f"the same arm, {'the same' if np.allclose(*lengths) else 'another'} table"


def place(given):
    """The part that asks what becomes of the table if an axis is drawn elsewhere."""
    right = drawn_elsewhere(*given.moved)
    because = {
        "another arm": "an axis that turns is a line in the metal: drawn beside itself, it is another."
        if right == "another arm"
        else "is what was drawn elsewhere a line in the metal, and did it leave this line?",
        "the same arm, another table": "only the direction of a sliding axis is physical; the wrist behind it stands "
        "where it stood."
        if right == "the same arm, another table"
        else "a line pushed along itself is the same line; and one that turns, pushed aside, is another.",
        "the same arm, the same table": "a line pushed along itself is the line that it was, and so are its normals."
        if right == "the same arm, the same table"
        else "its normals with the axes beside it change, and with them a and d.",
    }
    return choice("place", "The place of an axis", right, because, "sec-prismatic-direction")


def exercise(given):
    """The exercise with these numbers."""
    arm, at = given.arm, joint_values(KINDS, given.values)
    return Exercise(
        name="stanford",
        title="The Stanford arm",
        arm=arm,
        parts=[
            Part(
                "frames",
                "Place the frames",
                3,
                Frames("classic", count=7, length_tolerance=1e-3),
                section="sec-prismatic-stanford",
            ),
            Part("table", "The classic table", 4, Table("classic"), section="sec-prismatic-row"),
            Part("modified_table", "The modified table", 3, Table("modified"), section="sec-both-columns"),
            which_holds("axis", "Which z is which axis", given.claims, CLAIMS, "sec-prismatic-row"),
            Part(
                "A3",
                "The slide, classic",
                1,
                Formula(pose(2, 3), symbols=SYMBOLS, **EXACT),
                section="sec-prismatic-row",
                traps=fixed_angle(2, 3),
                kinematics=False,
            ),
            Part(
                "A3_modified",
                "The slide, modified",
                1,
                Formula(pose(2, 3), symbols=SYMBOLS, **EXACT),
                section="sec-prismatic-row",
                arm=arm.to_modified(),
                kinematics=False,
            ),
            Part(
                "link",
                "Any link, as a function",
                2,
                link_function(6, seed=3),
                section="sec-prismatic-row",
                kinematics=False,
            ),
            Part(
                "T03",
                "The boom, in symbols",
                2,
                Formula(pose(0, 3), symbols=SYMBOLS, **EXACT),
                traps=fixed_angle(0, 3),
                section="sec-prismatic-stanford",
                kinematics=False,
            ),
            Part(
                "wrist",
                "The wrist centre",
                2,
                Formula(lambda arm, q: arm.T(0, 3, q)[:3, 3], shape=(3,), symbols=SYMBOLS, tolerance=1e-5),
                section="sec-prismatic-stanford-check",
                follows=Follows(["T03"], lambda T03: T03[:3, 3]),
                traps=[
                    Trap(
                        "d2 stands on the wrong side: at θ1 = 0 the boom is to the left of axis 1, at +y.",
                        wrist(given, -1),
                    ),
                    Trap(
                        "Sine and cosine of θ2 are exchanged: at θ2 = 0 the boom points up.",
                        wrist(given, cosine_for_sine=True),
                    ),
                    Trap("The height of the shoulder above the floor is missing.", wrist(given, with_foot=False)),
                    Trap("The boom is aside of axis 1 by d2, which is missing.", wrist(given, 0)),
                ],
                kinematics=False,
            ),
            *last_pose(
                6,
                at,
                QUARTERS,
                "sec-prismatic-stanford",
                traps=[slide_converted(6, 3), *fixed_angle(0, 6)],
            ),
            Part(
                "push",
                "What the slide does",
                2,
                Numbers(pushed, shape=(3,), at=at, tolerance=1e-3),
                section="sec-prismatic-row",
                traps=[
                    Trap(
                        "This is the axis of the slide, a vector of length 1; the hand moves by 0.1 m along it.",
                        lambda arm, q: arm.T(0, 2, q)[:3, 2],
                    ),
                    Trap(
                        "The slide pushes along the boom, z_2. This is along the axis of the hand, z_5.",
                        lambda arm, q: STEP * arm.T(0, 5, q)[:3, 2],
                    ),
                    Trap(
                        "This goes straight up. Joint 2 has tilted the boom, and the slide pushes along it.",
                        lambda arm, q: [0, 0, STEP],
                    ),
                    Trap(
                        "The line is right, but this goes backwards along it: the boom moves out.",
                        lambda arm, q: -STEP * arm.T(0, 2, q)[:3, 2],
                    ),
                    Trap(
                        "This is where the wrist is, a place; asked for is the way from one place to the next.",
                        lambda arm, q: arm.T(0, 3, q)[:3, 3],
                    ),
                    Trap(
                        "This is where the hand is after the step; how far did it move?",
                        lambda arm, q: arm.T(0, 6, [*q[:2], q[2] + STEP, *q[3:]])[:3, 3],
                    ),
                ],
                kinematics=False,
            ),
            shoulder(given),
            place(given),
        ],
    )


EXERCISE = exercise(DEFAULT)
