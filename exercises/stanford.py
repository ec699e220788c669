"""What the exercise on the Stanford arm asks, and how it is marked."""

import numpy as np

from dhlib import robots
from dhlib.grading.asking import EXACT, METRES, joint_values, link_function, pose
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, Table
from dhlib.grading.retelling import altered

CLASSIC = robots.stanford("classic")
MODIFIED = robots.stanford("modified")
d1, d2 = CLASSIC.joints[0].d, CLASSIC.joints[1].d

SYMBOLS = ["theta1", "theta2", "d3", "theta4", "theta5", "theta6"]
JOINTS = joint_values(CLASSIC.kinds, [30, 60, 0.5, 40, -50, 70])
QUARTERS = joint_values(CLASSIC.kinds, [90, 90, 0.5, 90, -90, 180])
STEP = 0.1


def all_converted(arm, q):
    """T6 of somebody who converts the whole joint vector to radians, the slide too."""
    return arm.T(0, 6, [*q[:2], np.deg2rad(q[2]), *q[3:]])


def pushed(arm, q):
    """How the hand moves when joint 3 goes on by a step."""
    further = [*q[:2], q[2] + STEP, *q[3:]]
    return arm.T(0, 6, further)[:3, 3] - arm.T(0, 6, q)[:3, 3]


def fixed_angle(i, j):
    """What becomes of frame j in frame i without the fixed angle of the slide, or with its other sign."""
    x = "x_2 points forward and x_3 to the right"
    return [
        Trap(
            f"The fixed angle θ3 is missing: {x}.", lambda arm, q: altered(CLASSIC, 3, theta=0.0).T(i, j, q), "offset"
        ),
        Trap(
            f"The fixed angle θ3 has the wrong sign: {x}.",
            lambda arm, q: altered(CLASSIC, 3, theta=np.pi / 2).T(i, j, q),
            "offset",
        ),
    ]


def wrist(d2_sign=1, cosine_for_sine=False, foot=d1):
    """The wrist centre with something done differently."""

    def p(arm, q):
        c1, s1, c2, s2 = np.cos(q[0]), np.sin(q[0]), np.cos(q[1]), np.sin(q[1])
        out, up = (c2, s2) if cosine_for_sine else (s2, c2)
        aside = d2_sign * d2
        return [q[2] * c1 * out - aside * s1, q[2] * s1 * out + aside * c1, q[2] * up + foot]

    return p


EXERCISE = Exercise(
    name="stanford",
    title="The Stanford arm",
    arm=CLASSIC,
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
        Part(
            "axis",
            "Along which axis it slides",
            1,
            Choice(
                {
                    "z_2 in both": "in the modified convention the slide comes last in a row, along the new z."
                    " Here that is z_3.",
                    "z_3 in both": "in the classic convention the slide comes first in a row, along the old z."
                    " Here that is z_2.",
                    "classic z_2, modified z_3": "a classic row begins with the turn and the slide, and a "
                    "modified row ends with them.",
                    "classic z_3, modified z_2": "it is the other way round: see where the slide stands among "
                    "the four steps.",
                },
                right="classic z_2, modified z_3",
            ),
            section="sec-prismatic-row",
        ),
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
            arm=MODIFIED,
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
                Trap("d2 stands on the wrong side: at θ1 = 0 the boom is to the left of axis 1, at +y.", wrist(-1)),
                Trap(
                    "Sine and cosine of θ2 are exchanged: at θ2 = 0 the boom points up.",
                    wrist(cosine_for_sine=True),
                ),
                Trap("The height of the shoulder above the floor is missing.", wrist(foot=0.0)),
                Trap("The boom is aside of axis 1 by d2, which is missing.", wrist(0)),
            ],
            kinematics=False,
        ),
        Part(
            "T6",
            "T6 in numbers",
            2,
            Numbers(pose(0, 6), at=JOINTS, **METRES),
            section="sec-prismatic-stanford",
            traps=[
                Trap(
                    "The third joint was converted to radians too. It slides: 0.5 m stays 0.5 m.",
                    all_converted,
                    "degrees",
                ),
                *fixed_angle(0, 6),
            ],
            kinematics=False,
        ),
        Part(
            "T6_quarter",
            "T6 at quarter turns",
            1,
            Numbers(pose(0, 6), at=QUARTERS, **METRES),
            section="sec-prismatic-stanford",
            kinematics=False,
        ),
        Part(
            "push",
            "What the slide does",
            2,
            Numbers(pushed, shape=(3,), at=JOINTS, tolerance=1e-3),
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
                    "This is where the hand is after the step; how far did it move?",
                    lambda arm, q: arm.T(0, 6, [*q[:2], q[2] + STEP, *q[3:]])[:3, 3],
                ),
            ],
            kinematics=False,
        ),
        Part(
            "shoulder",
            "The shoulder on the other side",
            1,
            Choice(
                {
                    "the same arm": "joint 2 counts the other way, and joints 1 and 4 count from half a turn further.",
                    "the mirror image": "it is that, but this arm is its own mirror image: there is a turn that "
                    "makes the one into the other.",
                    "another arm": "try it: turn joint 1 by half a turn, and let joint 2 count the other way.",
                },
                right="the same arm",
            ),
            section="sec-prismatic-mirror",
        ),
        Part(
            "place",
            "The place of the slide",
            1,
            Choice(
                {
                    "another arm": "all points of the boom move along parallel lines, and none of these is "
                    "marked in the metal.",
                    "the same arm, another table": "only the direction of a sliding axis is physical; "
                    "the wrist behind it stands where it stood.",
                    "the same arm, the same table": "its normals with axes 2 and 4 change, and with them a and d.",
                },
                right="the same arm, another table",
            ),
            section="sec-prismatic-direction",
        ),
    ],
)
