"""What the Quickshot exercise asks, and how it is marked."""

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Ty, Tz, robots
from dhlib.grading.asking import link_function, pose, with_gripper
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, Table

bare = robots.quickshot()
#: Z and E as the page gives them.
Z = Tx(300) @ Ty(-150) @ Tz(720) @ Rz(np.pi / 2)
E = Tz(90) @ Rz(np.pi / 2) @ Rx(-np.pi / 6)
ARM = Chain(bare.joints, "classic", base=Z, tool=E, name="Quickshot", unit="mm")

SYMBOLS = ["theta1", "theta2", "theta3", "theta4"]
JOINTS = np.deg2rad([30, -50, 70, 20])
QUARTERS = np.deg2rad([90, -90, 180, -90])
#: The pose of the last part, as the page gives it, comes from these joints; the page does not say so.
HIDDEN = np.deg2rad([40, 25, -65, 110])

LINKS = ("A1", "A2", "A3", "A4")
PRODUCT = Follows(LINKS, lambda A1, A2, A3, A4: A1 @ A2 @ A3 @ A4)
FORMULAS = Follows([f"{link}_sym" for link in LINKS], lambda A1, A2, A3, A4: A1 @ A2 @ A3 @ A4)


def slides_entry(arm, q):
    """Entry (2, 1) as the slides print it."""
    s, c = np.sin(q), np.cos(q)
    return s[0] * c[3] * (s[1] * c[2] + c[1] * s[2]) + c[0] * s[3]


EXERCISE = Exercise(
    name="quickshot",
    title="The Quickshot",
    arm=ARM,
    parts=[
        Part("frames", "Place the frames", 3, Frames("classic", count=5), section="sec-quickshot-frames", arm=bare),
        Part("table", "Write the table", 4, Table("classic"), section="sec-quickshot-table", arm=bare),
        *(
            Part(
                link,
                f"{link} in numbers",
                1,
                Numbers(pose(i - 1, i), at=JOINTS),
                section="sec-quickshot-links",
                kinematics=False,
            )
            for i, link in enumerate(LINKS, 1)
        ),
        *(
            Part(
                f"{link}_sym",
                f"{link} in symbols",
                1,
                Formula(pose(i - 1, i), symbols=SYMBOLS),
                section="sec-quickshot-links",
                kinematics=False,
            )
            for i, link in enumerate(LINKS, 1)
        ),
        Part(
            "link",
            "Any link, as a function",
            2,
            link_function(4, seed=4, length_tolerance=1e-3),
            section="sec-classic-product",
            kinematics=False,
        ),
        Part(
            "T4",
            "T4 in numbers",
            2,
            Numbers(pose(0, 4), at=JOINTS),
            section="sec-quickshot-product",
            follows=PRODUCT,
            kinematics=False,
        ),
        Part(
            "T4_quarter",
            "T4 at quarter turns",
            1,
            Numbers(pose(0, 4), at=QUARTERS),
            section="sec-quickshot-product",
            kinematics=False,
        ),
        Part(
            "T4_sym",
            "T4 in symbols",
            3,
            Formula(pose(0, 4), symbols=SYMBOLS),
            section="sec-quickshot-product",
            follows=FORMULAS,
            kinematics=False,
        ),
        Part(
            "slip",
            "Find the slip",
            1,
            Choice(
                {
                    "n_x": "n_x is right as printed: compare it with your own T4, entry by entry.",
                    "n_y": "the printed n has no length of 1, and the other two entries agree with the product.",
                    "n_z": "n_z is right as printed: it is -S23 C4, written out.",
                },
                right="n_y",
            ),
            section="sec-quickshot-slip",
        ),
        Part(
            "n_y",
            "Mend the slip",
            2,
            Formula(lambda arm, q: arm.T(0, 4, q)[1, 0], shape=(), symbols=SYMBOLS),
            section="sec-quickshot-slip",
            traps=[
                Trap(
                    "This is the entry as it is printed. Its bracket is S23; which sum of angles belongs there?",
                    slides_entry,
                ),
                Trap(
                    "This is n_x: in n_y the sine of θ1 stands where n_x has the cosine.",
                    lambda arm, q: arm.T(0, 4, q)[0, 0],
                ),
                Trap(
                    "The bracket is C23 with a plus sign; cos(α + β) = cos α cos β - sin α sin β.",
                    lambda arm, q: np.sin(q[0]) * np.cos(q[3]) * np.cos(q[1] - q[2]) + np.cos(q[0]) * np.sin(q[3]),
                ),
            ],
            kinematics=False,
        ),
        *with_gripper(ARM, "T4", ("Base and tool", "Back from X"), JOINTS, HIDDEN),
    ],
)
