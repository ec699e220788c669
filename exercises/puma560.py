"""What the PUMA 560 exercise asks, and how it is marked."""

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Ty, Tz, robots
from dhlib.grading.asking import EXACT, METRES, link_function, pose, with_gripper
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, Table

bare = robots.puma560("modified", "craig")
a2, d3 = bare.joints[2].a, bare.joints[2].d
a3, d4 = bare.joints[3].a, bare.joints[3].d
#: Z and E as the page gives them.
Z = Tx(0.4) @ Ty(-0.25) @ Tz(0.66) @ Rz(np.pi / 2)
E = Tz(0.16) @ Rz(np.pi / 4) @ Rx(-np.pi / 6)
ARM = Chain(bare.joints, "modified", base=Z, tool=E, name="PUMA 560")

SYMBOLS = [f"theta{i}" for i in range(1, 7)]
JOINTS = np.deg2rad([30, -50, 70, 40, -60, 100])
QUARTERS = np.deg2rad([90, -90, 180, 90, -90, 180])
#: The pose of the last part, as the page gives it, comes from these joints; the page does not say so.
HIDDEN = np.deg2rad([-35, 20, -75, 110, 50, -25])


def letters(q):
    """C_i, S_i, C23 and S23, counted as the slides count them."""
    c, s = np.cos([0, *q]), np.sin([0, *q])
    return c, s, np.cos(q[1] + q[2]), np.sin(q[1] + q[2])


def n_printed(row, slip4, sign):
    """Entries n_x and n_y of the slides, with S4 S5 or S4 S6 in the first bracket and a sign before the second."""

    def entry(arm, q):
        c, s, c23, s23 = letters(q)
        bracket = c23 * (c[4] * c[5] * c[6] - s[4] * s[slip4]) - s23 * s[5] * c[6]
        first, second = (c[1], s[1]) if row == 0 else (s[1], c[1])
        return first * bracket + sign * second * (s[4] * c[5] * c[6] + c[4] * s[6])

    return entry


def wrist(lift, aside=1):
    """The wrist centre, with another cosine and sine for C23 and S23, or with d3 to the other side."""

    def p(arm, q):
        c, s, *_ = letters(q)
        c23, s23 = lift(q)
        out = a2 * c[2] + a3 * c23 - d4 * s23
        return [
            c[1] * out - aside * d3 * s[1],
            s[1] * out + aside * d3 * c[1],
            -a3 * s23 - a2 * s[2] - d4 * c23,
        ]

    return p


def link_4_5_printed(arm, q):
    """Link matrix 5 as the slides print it."""
    c, s = np.cos(q[4]), np.sin(q[4])
    return [[c, -s, 0, 0], [0, 0, -1, 0], [-s, -c, 0, 0], [0, 0, 0, 1]]


def n_traps(row):
    """What becomes of the printed n_x or n_y when it is mended in part, or not at all."""
    other = "It belongs to a wrist whose three twists have the other signs, and not to the p beside it."
    if row == 1:
        says = f"This is the entry as it is printed. {other} Look at the sign before C1."
        return [Trap(says, n_printed(1, 6, +1))]
    as_it_is = "This is the entry as it is printed. An index is wrong in its first bracket, and then a sign."
    return [
        Trap(as_it_is, n_printed(0, 5, -1)),
        Trap(f"S4 S6 is right. One slip is left. {other} Look at the sign before S1.", n_printed(0, 6, -1)),
        Trap("The sign before S1 is right. One slip is left: an index in the first bracket.", n_printed(0, 5, +1)),
    ]


EXERCISE = Exercise(
    name="puma560",
    title="The PUMA 560",
    arm=ARM,
    parts=[
        Part(
            "frames",
            "Place the frames",
            3,
            Frames("modified", count=7, length_tolerance=1e-3),
            section="sec-puma560-frames",
            arm=bare,
        ),
        Part("table", "The modified table", 4, Table("modified"), section="sec-puma560-rows", arm=bare),
        *(
            Part(
                f"A{i}",
                f"A{i} in symbols",
                1,
                Formula(lambda arm, q, i=i: arm.A(i, q), symbols=SYMBOLS, **EXACT),
                section="sec-puma560-links",
                arm=bare,
                kinematics=False,
            )
            for i in range(1, 5)
        ),
        Part(
            "slip",
            "Which matrix is printed wrongly",
            1,
            Choice(
                {
                    "first": "its determinant is -1, so it is a mirror and no link of any arm.",
                    "second": "the second has determinant +1 and is a link of the arm: only its label is wrong.",
                    "both": "one of the two has determinant +1, and is a link of the arm.",
                },
                right="first",
            ),
            section="sec-puma560-links",
        ),
        Part(
            "A5",
            "Mend A5",
            1,
            Formula(pose(4, 5), symbols=SYMBOLS, **EXACT),
            section="sec-puma560-links",
            arm=bare,
            traps=[
                Trap(
                    "This is the matrix as it is printed. Its determinant is -1: which row has the wrong sign?",
                    link_4_5_printed,
                ),
                Trap(
                    "Its determinant is +1, but its twist is -90°. Which turn about x leads from z_4 to z_5?",
                    lambda arm, q: Rx(-np.pi / 2) @ Rz(q[4]),
                ),
            ],
            kinematics=False,
        ),
        Part(
            "A6",
            "A6 in symbols",
            1,
            Formula(pose(5, 6), symbols=SYMBOLS, **EXACT),
            section="sec-puma560-links",
            arm=bare,
            kinematics=False,
        ),
        Part(
            "link",
            "Any link, as a function",
            2,
            link_function(6, seed=6),
            section="sec-modified-product",
            arm=bare,
            kinematics=False,
        ),
        Part(
            "T03",
            "The arm, in symbols",
            2,
            Formula(pose(0, 3), symbols=SYMBOLS, **EXACT),
            section="sec-puma560-first-half",
            arm=bare,
            follows=Follows(["A1", "A2", "A3"], lambda A1, A2, A3: A1 @ A2 @ A3),
            kinematics=False,
        ),
        Part(
            "T36",
            "The wrist, in symbols",
            2,
            Formula(pose(3, 6), symbols=SYMBOLS, **EXACT),
            section="sec-puma560-second-half",
            arm=bare,
            follows=Follows(["A4", "A5", "A6"], lambda A4, A5, A6: A4 @ A5 @ A6),
            kinematics=False,
        ),
        Part(
            "T06",
            "All twelve entries",
            4,
            Formula(pose(0, 6), symbols=SYMBOLS, **EXACT),
            section="sec-puma560-entries",
            arm=bare,
            follows=Follows(["T03", "T36"], lambda T03, T36: T03 @ T36),
            kinematics=False,
        ),
        Part(
            "p",
            "The wrist centre",
            2,
            Formula(lambda arm, q: arm.T(0, 6, q)[:3, 3], shape=(3,), symbols=SYMBOLS, tolerance=1e-5),
            section="sec-puma560-reading",
            arm=bare,
            follows=Follows(["T06"], lambda T06: T06[:3, 3]),
            traps=[
                Trap(
                    "C23 is the cosine of the sum θ2 + θ3, and not the sum of the two cosines.",
                    wrist(lambda q: (np.cos(q[1]) + np.cos(q[2]), np.sin(q[1]) + np.sin(q[2]))),
                ),
                Trap(
                    "Not θ3 alone turns the forearm, but θ2 too: axes 2 and 3 are parallel, so the angles add.",
                    wrist(lambda q: (np.cos(q[2]), np.sin(q[2]))),
                ),
                Trap(
                    "The bracket is C23 with a plus sign: C23 is the cosine of θ2 + θ3.",
                    wrist(lambda q: (np.cos(q[1] - q[2]), np.sin(q[1] - q[2]))),
                ),
                Trap(
                    "d3 stands on the other side of the shoulder: at θ1 = 0 it leads to the left, along +y.",
                    wrist(lambda q: (np.cos(q[1] + q[2]), np.sin(q[1] + q[2])), aside=-1),
                ),
            ],
            kinematics=False,
        ),
        Part(
            "fine",
            "Which entry is right as printed",
            1,
            Choice(
                {
                    "n_x": "n_x holds two slips: mending one of them is not enough.",
                    "n_y": "in n_y a sign is wrong: compare it with the entry (2,1) of your product.",
                    "n_z": "n_z is the entry (3,1) of the product, sign for sign.",
                },
                right="n_z",
            ),
            section="sec-puma560-entries",
        ),
        Part(
            "n_x",
            "Mend n_x",
            2,
            Formula(lambda arm, q: arm.T(0, 6, q)[0, 0], shape=(), symbols=SYMBOLS),
            section="sec-puma560-entries",
            arm=bare,
            traps=n_traps(0),
            kinematics=False,
        ),
        Part(
            "n_y",
            "Mend n_y",
            2,
            Formula(lambda arm, q: arm.T(0, 6, q)[1, 0], shape=(), symbols=SYMBOLS),
            section="sec-puma560-entries",
            arm=bare,
            traps=n_traps(1),
            kinematics=False,
        ),
        Part(
            "classic_table",
            "The classic table of the same arm",
            3,
            Table("classic"),
            section="sec-puma560-row-down",
            arm=bare,
        ),
        Part(
            "mirror",
            "Which sign makes another arm",
            1,
            Choice(
                {
                    "a_2": "the sign of a_2 may change alone: it is x_2 reversed, θ2 and θ3 half a turn on.",
                    "alpha_4": "the sign of alpha_4 may change alone: it is x_4 reversed, θ4 and θ5 half a turn on.",
                    "d_3": "it makes the mirror image: the forearm stands on the other side of the shoulder.",
                    "d_3 and d_4": "these two may change together: each alone is a mirror, and two undo each other.",
                },
                right="d_3",
            ),
            section="sec-puma560-parity",
        ),
        Part(
            "zeros",
            "Another book's zeros",
            1,
            Choice(
                {
                    "none": "at his zeros the forearm points up; at yours it hangs down.",
                    "1": "joint 1 alone leaves the forearm hanging; at his zeros it points up.",
                    "1 and 2": "he has reversed x_1: α_1 changes its sign, and joints 1 and 2 gain half a turn.",
                    "3 and 6": "that would reverse x_3 and x_6; but Corke's third row is like yours.",
                },
                right="1 and 2",
            ),
            section="sec-puma560-corke",
        ),
        Part(
            "T6",
            "T6 in numbers",
            2,
            Numbers(pose(0, 6), at=JOINTS, **METRES),
            section="sec-puma560-product",
            kinematics=False,
        ),
        Part(
            "T6_quarter",
            "T6 at quarter turns",
            1,
            Numbers(pose(0, 6), at=QUARTERS, **METRES),
            section="sec-puma560-poses",
            kinematics=False,
        ),
        *with_gripper(ARM, "T6", ("With a gripper", "Back from X"), JOINTS, HIDDEN, **METRES),
    ],
)
