"""What the exercise on a SCARA asks, and how it is marked."""

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Ty, Tz, inverse, robots
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Function, Numbers, Table

CLASSIC = robots.cobra600("classic")
MODIFIED = robots.cobra600("modified")
#: Z and E as the page gives them.
Z = Tx(0.8) @ Ty(0.3) @ Tz(0.5) @ Rz(np.pi / 2)
E = Tx(0.04) @ Tz(0.12) @ Rx(np.pi / 6)
ARM = Chain(CLASSIC.joints, "classic", base=Z, tool=E, name=CLASSIC.name)

SYMBOLS = ["theta1", "theta2", "d3", "theta4"]


def joints(theta1, theta2, d3, theta4):
    """A joint vector from angles in degrees and the slide in metres."""
    return (np.deg2rad(theta1), np.deg2rad(theta2), d3, np.deg2rad(theta4))


JOINTS = joints(30, -70, 0.15, 40)
QUARTERS = joints(90, -90, 0.2, 90)
#: The pose of the last part, as the page gives it, comes from these joints; the page does not say so.
HIDDEN = joints(-25, 65, 0.08, 50)
X_GIVEN = np.round(ARM.fk(HIDDEN), 6)
CALLS = [(i, tuple(q)) for i, q in zip((1, 2, 3, 4) * 2, np.random.default_rng(2).uniform(-3, 3, (8, 4)), strict=True)]

#: The page asks for three decimals, of metres too.
METRES = {"tolerance": 1e-3, "length_tolerance": 1e-3}
EXACT = {"length_tolerance": 1e-5}


def pose(i, j):
    return lambda arm, q: arm.T(i, j, q)


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
        ),
        Part(
            "A3_modified",
            "The slide, modified",
            1,
            Formula(pose(2, 3), symbols=SYMBOLS, **EXACT),
            section="sec-prismatic-row",
            arm=MODIFIED,
        ),
        Part(
            "link",
            "Any modified link, as a function",
            2,
            Function(lambda arm, i, q: arm.A(i, q), calls=CALLS, signature="link(i, q)", length_tolerance=1e-5),
            section="sec-prismatic-row",
            arm=MODIFIED,
        ),
        Part(
            "T04",
            "The whole arm, in symbols",
            3,
            Formula(pose(0, 4), symbols=SYMBOLS, **EXACT),
            section="sec-prismatic-scara",
            arm=CLASSIC,
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
        ),
        Part(
            "T4_quarter",
            "T4 at quarter turns",
            1,
            Numbers(pose(0, 4), at=QUARTERS, **METRES),
            section="sec-prismatic-scara",
            arm=CLASSIC,
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
        Part(
            "X",
            "Base and tool",
            2,
            Numbers(lambda arm, q: arm.fk(q), at=JOINTS, **METRES),
            section="sec-base-and-tool",
            follows=Follows(["T4"], lambda T4: Z @ T4 @ E),
        ),
        Part(
            "T4_back",
            "Back from X",
            2,
            Numbers(lambda arm, q: inverse(arm.base) @ X_GIVEN @ inverse(arm.tool), at=HIDDEN, **METRES),
            section="sec-base-and-tool",
            traps=[
                Trap(
                    "Z and E are transposed here; the inverse of a pose is more than that, since p is turned too.",
                    lambda arm, q: arm.base.T @ X_GIVEN @ arm.tool.T,
                ),
                Trap(
                    "The two inverses have changed places: Z⁻¹ stands on the left, E⁻¹ on the right.",
                    lambda arm, q: inverse(arm.tool) @ X_GIVEN @ inverse(arm.base),
                ),
            ],
        ),
    ],
)
