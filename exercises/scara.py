"""What the exercise on a SCARA asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Ty, Tz, robots
from dhlib.grading.asking import (
    EXACT,
    METRES,
    choice,
    joint_values,
    last_pose,
    link_function,
    measured_at,
    pose,
    slide_converted,
    with_gripper,
)
from dhlib.grading.course.sources import lengths, matrix, number, row
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Table
from dhlib.grading.pictures import described, same_for_all

COBRA = robots.cobra600("classic")
KINDS = COBRA.kinds
#: Faults of a program that computes T4: how far the hand then goes when q3 grows by 1, along x and up, and how far it
#: turns; and what that looks like.
FAULTS = {
    "joint 3 revolute": ((0, 0, -1), "the hand turns, and stays at its height"),
    "alpha_2 = 0": ((0, 1, 0), "the hand rises where it should sink, and does not turn"),
    "q3 in a_3": ((1, 0, 0), "the hand moves outwards, and stays at its height"),
    "q3 in centimetres": ((0, -0.01, 0), "the hand sinks, but far too little"),
}


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in m, angles in degrees."""

    d1: float = COBRA.joints[0].d
    a1: float = COBRA.joints[0].a
    a2: float = COBRA.joints[1].a
    #: Joint values, of which the third is a slide.
    values: tuple[float, ...] = (30, -70, 0.15, 40)
    corner: tuple[float, ...] = (0.8, 0.3, 0.5)
    gripper: tuple[float, ...] = (0.04, 0.12, 30)
    #: What is missing in d_1, and the signs of it in d_2, d_3 and d_4, of which one is right.
    missing: float = 0.087
    tried: tuple[int, int, int] = (1, 1, 1)
    #: The pose of the last part comes from these joints; the page does not say so.
    hidden: tuple[float, ...] = (-25, 65, 0.08, 50)
    #: What is wrong in somebody's program.
    fault: str = "joint 3 revolute"

    @property
    def arm(self):
        first, second, *quill = COBRA.joints
        return Chain(
            [first.replace(d=self.d1, a=self.a1), second.replace(a=self.a2), *quill], "classic", name=COBRA.name
        )

    @property
    def in_the_workshop(self):
        """The arm with Z and E as the page gives them."""
        x, y, z = self.corner
        ahead, below, tilt = self.gripper
        Z = Tx(x) @ Ty(y) @ Tz(z) @ Rz(np.pi / 2)
        E = Tx(ahead) @ Tz(below) @ Rx(np.deg2rad(tilt))
        return Chain(self.arm.joints, "classic", base=Z, tool=E, name=COBRA.name)


DEFAULT = Given()


#: Parts with one answer for everybody: a sum of joint angles, with no length in it.
SAME_FOR_ALL = ("heading",)


def draw(lots):
    """Another arm of this kind in another workshop: no length and no angle is that of the book."""
    sizes = lots.some("angles", range(21, 77, 5), 3)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, -1, 1), (-1, 1, 1), (1, -1, -1), (-1, 1, -1)])
    first, second, last = (sign * size for sign, size in zip(signs, sizes, strict=True))
    # No sum of two of the hidden angles is a multiple of 5: no quarter turn hides in it.
    h1, h2, h4 = (
        lots.one(f"hidden {i}", [*range(-end - 100, -end, 10), *range(10 + end, 110 + end, 10)])
        for i, end in ((1, 6), (2, 1), (4, 7))
    )
    return Given(
        d1=lots.one("d1", [0.342, 0.351, 0.36, 0.369, 0.405, 0.414, 0.423]),
        a1=lots.one("a1", [0.286, 0.294, 0.302, 0.31, 0.342, 0.35, 0.358]),
        a2=lots.one("a2", [0.224, 0.232, 0.24, 0.248, 0.256, 0.264]),
        values=(first, second, lots.one("slide", [0.11, 0.12, 0.13, 0.16, 0.17, 0.18]), last),
        corner=(
            lots.one("x", [0.62, 0.66, 0.7, 0.74, 0.86, 0.9]),
            lots.one("y", [0.18, 0.22, 0.26, 0.34, 0.38]),
            lots.one("z", [0.42, 0.44, 0.46, 0.54, 0.56]),
        ),
        gripper=(
            lots.one("ahead", [0.03, 0.05, 0.06, 0.07]),
            lots.one("below", [0.09, 0.1, 0.11, 0.13, 0.14]),
            lots.one("tilt", [20, 25, 35, 40, 50, 55]),
        ),
        missing=lots.one("missing", [0.062, 0.069, 0.073, 0.078, 0.083, 0.091]),
        tried=lots.one("tried", [(1, 1, 1), (-1, -1, 1), (-1, 1, -1)]),
        hidden=(h1, h2, lots.one("hidden slide", [0.05, 0.06, 0.07, 0.09, 0.1]), h4),
        fault=lots.one("fault", [fault for fault in FAULTS if fault != DEFAULT.fault]),
    )


def cells(given):
    """The given cells of the notebook."""
    measured = measured_at(given.in_the_workshop, joint_values(KINDS, given.hidden))
    ahead, below, tilt = given.gripper
    theta1, theta2, slide, theta4 = given.values
    d_2, d_3, d_4 = ("" if sign > 0 else "-" for sign in given.tried)
    return {
        "arm": lengths("metres", d1=given.d1, a1=given.a1, a2=given.a2),
        "joints": f"""\
# The joint vector: angles in radians, the slide in metres
theta_1, theta_2, theta_4 = np.deg2rad({row((theta1, theta2, theta4))})
d_3 = {number(slide)}
q = [theta_1, theta_2, d_3, theta_4]""",
        "ends": f"""\
# Lengths in metres, the tilt in radians
corner = {row(given.corner)}
ahead = {number(ahead)}
below = {number(below)}
tilt = np.deg2rad({number(tilt)})""",
        "missing": f"""\
missing = {number(given.missing)}  # metres
tried = {{"d_2": {d_2}missing, "d_3": {d_3}missing, "d_4": {d_4}missing}}""",
        "calls": calls(given),
        "measured": matrix("X_measured", measured, decimals=(4, 4, 4, 5)),
    }


@same_for_all
def figure():
    """The arm that the page describes."""
    return described(
        COBRA,
        "The arm at its zero pose, not to scale: its joint axes, and the base frame {0}",
        "Axis 1 rises from the origin of frame 0 at the foot. At the height d1 two links point forward, a1 to axis 2, "
        "which points up, and a2 to the quill. There axes 3, a slide, and 4, a turn, are one line, and point down.",
        lengths={"d_1": "d1", "a_1": "a1", "a_2": "a2"},
    )


SYMBOLS = ["theta1", "theta2", "d3", "theta4"]
QUARTERS = joint_values(KINDS, [90, -90, 0.2, 90])


def wandering(given):
    """What to say of what is missing in d_1 as it is tried in each place, and the place where it is right."""
    up = {"d_2": 1, "d_3": -1, "d_4": -1}
    (right,) = (place for place, sign in zip(up, given.tried, strict=True) if sign == up[place])
    because = {
        place: f"axis {place[-1]} points {'up' if sense > 0 else 'down'}, so "
        + (
            "with this sign the height comes out."
            if place == right
            else f"what stands there is {'added to' if sense > 0 else 'taken off'} the height: see its sign."
        )
        for place, sense in up.items()
    }
    return because, right


def calls(given):
    """What a faulty program gives for q3 = 0.1 and 0.2, as source."""
    (out, up, turn), _ = FAULTS[given.fault]
    lines = [
        f"    ({row([given.a1 + given.a2 + out * q3, 0, given.d1 + up * q3])}, {number(turn * q3)}),  # q3 = {q3}"
        for q3 in (0.1, 0.2)
    ]
    return "\n".join(["# Position in metres, and angle about the vertical in radians", "calls = [", *lines, "]"])


def treated(fault):
    """The part that asks what went wrong."""
    because = {
        each: f"then {looks}" + (": so it does." if each == fault else ". Compare the two calls.")
        for each, (_, looks) in FAULTS.items()
    }
    return choice("treated", "What went wrong", fault, because, "sec-prismatic-trap-revolute")


def heading(sign2=1, sign4=-1):
    return lambda arm, q: q[0] + sign2 * q[1] + sign4 * q[3]


def exercise(given):
    """The exercise with these numbers."""
    bare, arm, at = given.arm, given.in_the_workshop, joint_values(KINDS, given.values)
    return Exercise(
        name="scara",
        title="A SCARA",
        arm=arm,
        parts=[
            Part(
                "frames",
                "Place the frames",
                3,
                Frames("classic", count=5, length_tolerance=1e-3),
                section="sec-prismatic-scara",
                arm=bare,
            ),
            Part("table", "The classic table", 4, Table("classic"), section="sec-prismatic-scara", arm=bare),
            Part("modified_table", "The modified table", 3, Table("modified"), section="sec-both-columns", arm=bare),
            Part(
                "A2",
                "The turn-over, classic",
                1,
                Formula(pose(1, 2), symbols=SYMBOLS, **EXACT),
                section="sec-prismatic-scara",
                arm=bare,
                kinematics=False,
            ),
            Part(
                "A3_modified",
                "The slide, modified",
                1,
                Formula(pose(2, 3), symbols=SYMBOLS, **EXACT),
                section="sec-prismatic-row",
                arm=bare.to_modified(),
                kinematics=False,
            ),
            Part(
                "link",
                "Any modified link, as a function",
                2,
                link_function(4, seed=2),
                section="sec-prismatic-row",
                arm=bare.to_modified(),
                kinematics=False,
            ),
            Part(
                "T04",
                "The whole arm, in symbols",
                3,
                Formula(pose(0, 4), symbols=SYMBOLS, **EXACT),
                section="sec-prismatic-scara",
                arm=bare,
                kinematics=False,
            ),
            Part(
                "heading",
                "How far the hand has turned",
                1,
                Formula(heading(), shape=(), symbols=SYMBOLS),
                section="sec-prismatic-scara",
                arm=bare,
                traps=[
                    Trap(
                        "Axis 4 points down: seen from above, its joint turns the other way.",
                        heading(sign4=1),
                        "sense",
                    ),
                    Trap(
                        "Axes 1 and 2 point the same way, so their angles add.",
                        heading(sign2=-1),
                        "sense",
                    ),
                    Trap("The slide does not turn the hand.", lambda arm, q: q[0] + q[1] + q[2] - q[3], "joint_kind"),
                    Trap("Axis 4 turns the hand too.", heading(sign4=0)),
                ],
                kinematics=False,
            ),
            *last_pose(4, at, QUARTERS, "sec-prismatic-scara", arm=bare, traps=[slide_converted(4, 3)]),
            Part(
                "heights",
                "Heights that wander",
                1,
                Choice(*wandering(given)),
                section="sec-prismatic-wander",
            ),
            treated(given.fault),
            *with_gripper(arm, "T4", ("Base and tool", "Back from X"), at, joint_values(KINDS, given.hidden), **METRES),
        ],
    )


EXERCISE = exercise(DEFAULT)
