"""What the exercise on a SCARA asks, and how it is marked."""

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Ty, Tz, robots
from dhlib.grading.asking import EXACT, METRES, joint_values, link_function, pose, with_gripper
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, Table

CLASSIC = robots.cobra600("classic")
MODIFIED = robots.cobra600("modified")
#: Z and E as the page gives them.
Z = Tx(0.8) @ Ty(0.3) @ Tz(0.5) @ Rz(np.pi / 2)
E = Tx(0.04) @ Tz(0.12) @ Rx(np.pi / 6)
ARM = Chain(CLASSIC.joints, "classic", base=Z, tool=E, name=CLASSIC.name)

SYMBOLS = ["theta1", "theta2", "d3", "theta4"]
JOINTS = joint_values(CLASSIC.kinds, [30, -70, 0.15, 40])
QUARTERS = joint_values(CLASSIC.kinds, [90, -90, 0.2, 90])
#: The pose of the last part, as the page gives it, comes from these joints; the page does not say so.
HIDDEN = joint_values(CLASSIC.kinds, [-25, 65, 0.08, 50])


def all_converted(arm, q):
    """T4 of somebody who converts the whole joint vector to radians, the slide too."""
    return arm.T(0, 4, [*q[:2], np.deg2rad(q[2]), q[3]])


def heading(sign2=1, sign4=-1):
    return lambda arm, q: q[0] + sign2 * q[1] + sign4 * q[3]


EXERCISE = Exercise(
    name="scara",
    title="A SCARA",
    arm=ARM,
    parts=[
        Part(
            "frames",
            "Place the frames",
            3,
            Frames("classic", count=5, length_tolerance=1e-3),
            section="sec-prismatic-scara",
            arm=CLASSIC,
        ),
        Part("table", "The classic table", 4, Table("classic"), section="sec-prismatic-scara", arm=CLASSIC),
        Part("modified_table", "The modified table", 3, Table("modified"), section="sec-both-columns", arm=CLASSIC),
        Part(
            "A2",
            "The turn-over, classic",
            1,
            Formula(pose(1, 2), symbols=SYMBOLS, **EXACT),
            section="sec-prismatic-scara",
            arm=CLASSIC,
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
            "Any modified link, as a function",
            2,
            link_function(4, seed=2),
            section="sec-prismatic-row",
            arm=MODIFIED,
            kinematics=False,
        ),
        Part(
            "T04",
            "The whole arm, in symbols",
            3,
            Formula(pose(0, 4), symbols=SYMBOLS, **EXACT),
            section="sec-prismatic-scara",
            arm=CLASSIC,
            kinematics=False,
        ),
        Part(
            "heading",
            "How far the hand has turned",
            1,
            Formula(heading(), shape=(), symbols=SYMBOLS),
            section="sec-prismatic-scara",
            arm=CLASSIC,
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
        Part(
            "T4",
            "T4 in numbers",
            2,
            Numbers(pose(0, 4), at=JOINTS, **METRES),
            section="sec-prismatic-scara",
            arm=CLASSIC,
            traps=[
                Trap(
                    "The third joint was converted to radians too. It slides: 0.15 m stays 0.15 m.",
                    all_converted,
                    "degrees",
                )
            ],
            kinematics=False,
        ),
        Part(
            "T4_quarter",
            "T4 at quarter turns",
            1,
            Numbers(pose(0, 4), at=QUARTERS, **METRES),
            section="sec-prismatic-scara",
            arm=CLASSIC,
            kinematics=False,
        ),
        Part(
            "heights",
            "Heights that wander",
            1,
            Choice(
                {
                    "d_2": "both axes point up: 0.3 and 0.087 add up to the height.",
                    "d_3": "axis 3 points down, so 0.087 there is taken off the height: it would have to be -0.087.",
                    "d_4": "axis 4 points down, so 0.087 there is taken off the height: it would have to be -0.087.",
                },
                right="d_2",
            ),
            section="sec-prismatic-wander",
        ),
        Part(
            "treated",
            "What went wrong",
            1,
            Choice(
                {
                    "angles in degrees": "only q3 was changed, and it is no angle.",
                    "joint 3 revolute": "the hand turned and stayed at its height; where a joint slides, it is the "
                    "other way round.",
                    "alpha_2 = 0": "then the hand would rise where it should sink, but it would not turn.",
                },
                right="joint 3 revolute",
            ),
            section="sec-prismatic-trap-revolute",
        ),
        *with_gripper(ARM, "T4", ("Base and tool", "Back from X"), JOINTS, HIDDEN, **METRES),
    ],
)
