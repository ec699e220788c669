"""What the exercise on the PA10-6C asks, and how it is marked."""

import numpy as np

from dhlib import Chain, robots
from dhlib.grading.asking import EXACT, METRES, link_function, pose
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, Table

ARM = robots.pa10_6c("classic", lengths="A")
b, l1, l2, f = (robots.pa10_7c(lengths="A").joints[k].d for k in (0, 2, 4, 6))

SYMBOLS = [f"theta{i}" for i in range(1, 7)]
JOINTS = np.deg2rad([30, 40, 70, -50, 60, 20])
QUARTERS = np.deg2rad([90, 90, -90, 90, 90, 180])
#: Where the arm of the last part stood, as the page says, and the set of lengths it has, which the page does not say.
CALIBRATED = np.deg2rad([20, 35, 60, 0, -45, 0])
ITS_SET = "B"


def wrist(lean, bend, foot=b):
    """The wrist centre, with the upper arm leaning by one angle and the forearm by another."""

    def p(arm, q):
        up, fore = lean(q), bend(q)
        out = l1 * np.sin(up) + l2 * np.sin(fore)
        return [out * np.cos(q[0]), out * np.sin(q[0]), foot + l1 * np.cos(up) + l2 * np.cos(fore)]

    return p


def struck_out(arm, q):
    """T6 by the table of the 7C with row 3 left out."""
    rows = robots.pa10_7c(lengths="A").joints
    return Chain([*rows[:2], *rows[3:]], "classic").fk(q)


EXERCISE = Exercise(
    name="pa10_6c",
    title="The PA10-6C",
    arm=ARM,
    parts=[
        Part(
            "frames",
            "Place the frames",
            3,
            Frames("classic", count=7, length_tolerance=1e-3),
            section="sec-pa10-6c",
        ),
        Part("table", "The classic table", 4, Table("classic", free=()), section="sec-pa10-6c"),
        Part("modified_table", "The modified table", 3, Table("modified", free=()), section="sec-both-columns"),
        *(
            Part(
                f"A{i}",
                f"A{i} in symbols",
                1,
                Formula(pose(i - 1, i), symbols=SYMBOLS, **EXACT),
                section="sec-pa10-6c",
                kinematics=False,
            )
            for i in (2, 3)
        ),
        Part(
            "link",
            "Any link, as a function",
            2,
            link_function(6, seed=7),
            section="sec-pa10-6c",
            kinematics=False,
        ),
        Part(
            "wrist",
            "The wrist centre",
            2,
            Formula(lambda arm, q: arm.T(0, 5, q)[:3, 3], shape=(3,), symbols=SYMBOLS, tolerance=1e-5),
            section="sec-pa10-6c",
            traps=[
                Trap(
                    "At the zero pose the arm stands upright; this one lies forward: sine and cosine are exchanged.",
                    wrist(lambda q: np.pi / 2 - q[1], lambda q: np.pi / 2 - q[1] - q[2]),
                ),
                Trap(
                    "The forearm leans by the angles of shoulder and elbow together: axes 2 and 3 are parallel.",
                    wrist(lambda q: q[1], lambda q: q[2]),
                ),
                Trap(
                    "The two angles add: both axes point to the left, and both joints lean the arm forward.",
                    wrist(lambda q: q[1], lambda q: q[1] - q[2]),
                ),
                Trap(
                    "The shoulder stands above the foot; that height is missing.",
                    wrist(lambda q: q[1], lambda q: q[1] + q[2], foot=0.0),
                ),
            ],
            kinematics=False,
        ),
        Part(
            "T6",
            "T6 in numbers",
            2,
            Numbers(pose(0, 6), at=JOINTS, **METRES),
            section="sec-pa10-6c",
            traps=[
                Trap(
                    "This is the table of the 7C with a row struck out, and the upper arm went with it.",
                    struck_out,
                )
            ],
            kinematics=False,
        ),
        Part(
            "T6_quarter",
            "T6 at quarter turns",
            1,
            Numbers(pose(0, 6), at=QUARTERS, **METRES),
            section="sec-pa10-6c",
            kinematics=False,
        ),
        Part(
            "upper_arm",
            "Where the upper arm went",
            1,
            Choice(
                {
                    "d_2": "d_2 is measured along axis 2, which runs across the arm.",
                    "d_3": "d_3 is measured along axis 3, which is the elbow now and runs across the arm.",
                    "a_2": "axes 2 and 3 are parallel here, and the upper arm is the distance between them.",
                },
                right="a_2",
            ),
            section="sec-pa10-6c",
        ),
        Part(
            "why",
            "Why the 6C is the 7C at q3 = 0",
            1,
            Choice(
                {
                    "row 3 of the 7C is the identity": "at q3 = 0 it still holds the upper arm and a twist.",
                    "S3 at 0 turns nothing": "the links on both sides of S3 are one rigid piece then, and that is the "
                    "upper arm of the 6C.",
                    "both have the same table": "the 6C has a length a and two offsets; no row of the 7C has.",
                },
                right="S3 at 0 turns nothing",
            ),
            section="sec-pa10-6c",
        ),
        Part(
            "lengths",
            "Which set of lengths",
            2,
            Choice(
                {
                    "A": "with set A the flange is 28 mm from where it was measured.",
                    "B": "the pose by set B agrees with the measured one to the last digit.",
                    "B2": "set B2 comes near, but its flange is 5 mm too long.",
                },
                right=ITS_SET,
            ),
            section="sec-pa10-lengths",
        ),
        Part(
            "plate",
            "What a ruler says",
            1,
            Choice(
                {
                    "A": "its 70 mm are nearest to 70.6 mm.",
                    "B": "its 80 mm are 9.4 mm off; one of the sets is nearer.",
                    "B2": "its 85 mm are 14.4 mm off; one of the sets is nearer.",
                },
                right="A",
            ),
            section="sec-pa10-lengths",
        ),
    ],
)
