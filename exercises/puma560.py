"""What the PUMA 560 exercise asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Ty, Tz, robots
from dhlib.grading.asking import EXACT, METRES, last_pose, link_function, measured_at, pose, with_gripper
from dhlib.grading.course.sources import lengths, matrix, number, row
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Table
from dhlib.grading.pictures import described, same_for_all

CRAIG = robots.puma560("modified", "craig")


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in m, angles in degrees."""

    a2: float = CRAIG.joints[2].a
    a3: float = CRAIG.joints[3].a
    d3: float = CRAIG.joints[2].d
    d4: float = CRAIG.joints[3].d
    angles: tuple[float, ...] = (30, -50, 70, 40, -60, 100)
    corner: tuple[float, ...] = (0.4, -0.25, 0.66)
    gripper: tuple[float, ...] = (0.16, 45, -30)
    #: The pose of the last part comes from these joints; the page does not say so.
    hidden: tuple[float, ...] = (-35, 20, -75, 110, 50, -25)

    @property
    def arm(self):
        first, second, third, fourth, *wrist = CRAIG.joints
        joints = [first, second, third.replace(a=self.a2, d=self.d3), fourth.replace(a=self.a3, d=self.d4), *wrist]
        return Chain(joints, "modified", name="PUMA 560")

    @property
    def in_the_workshop(self):
        """The arm with Z and E as the page gives them."""
        x, y, z = self.corner
        length, turn, tilt = self.gripper
        Z = Tx(x) @ Ty(y) @ Tz(z) @ Rz(np.pi / 2)
        E = Tz(length) @ Rz(np.deg2rad(turn)) @ Rx(np.deg2rad(tilt))
        return Chain(self.arm.joints, "modified", base=Z, tool=E, name="PUMA 560")


DEFAULT = Given()


def draw(lots):
    """Another arm of this kind in another workshop: no length and no angle is that of the book."""
    sizes = lots.some("angles", range(21, 82, 5), 6)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, -1, 1, 1, -1, 1), (-1, -1, 1, 1, 1, -1), (1, 1, -1, 1, -1, -1)])
    return Given(
        a2=lots.one("a2", [0.388, 0.396, 0.404, 0.412, 0.444, 0.452, 0.46, 0.468]),
        a3=lots.one("a3", [0.026, 0.029, 0.032, 0.035, 0.038]),
        d3=lots.one("d3", [0.114, 0.121, 0.128, 0.135, 0.163, 0.17, 0.177]),
        d4=lots.one("d4", [0.371, 0.379, 0.387, 0.479, 0.487, 0.495]),
        angles=tuple(sign * size for sign, size in zip(signs, sizes, strict=True)),
        corner=(
            lots.one("x", [0.31, 0.34, 0.37, 0.43, 0.46, 0.49]),
            -lots.one("y", [0.16, 0.19, 0.22, 0.28, 0.31]),
            lots.one("z", [0.57, 0.6, 0.63, 0.69, 0.72]),
        ),
        gripper=(
            lots.one("gripper", [0.11, 0.12, 0.13, 0.14, 0.18, 0.19]),
            lots.one("turn", [25, 35, 40, 50, 55, 65]),
            lots.one("tilt", [-55, -50, -40, -35, -25, -20]),
        ),
        # No sum of two neighbours is a multiple of 5: no quarter turn hides in it.
        hidden=tuple(
            lots.one(f"hidden {i}", [*range(-last - 100, -last, 10), *range(10 + last, 110 + last, 10)])
            for i, last in enumerate((6, 1, 7, 4, 8, 3), 1)
        ),
    )


def cells(given):
    """The given cells of the notebook."""
    measured = measured_at(given.in_the_workshop, np.deg2rad(given.hidden))
    length, turn, tilt = given.gripper
    return {
        "arm": lengths("metres", a2=given.a2, a3=given.a3, d3=given.d3, d4=given.d4),
        "angles": f"q = np.deg2rad({row(given.angles)})",
        "ends": f"""\
# Lengths in metres, turn and tilt in radians
corner = {row(given.corner)}
gripper = {number(length)}
turn = np.deg2rad({number(turn)})
tilt = np.deg2rad({number(tilt)})""",
        "measured": matrix("X_measured", measured, decimals=(4, 4, 4, 5)),
    }


@same_for_all
def figure():
    """The arm that the page describes; a3 and d3 are drawn larger than they are."""
    outline = Given(a2=0.44, a3=0.12, d3=0.24, d4=0.42)
    return described(
        outline.arm,
        "The arm at its zero pose, not to scale: its joint axes, and the base frame {0}",
        "Frame 0 stands in the shoulder, where axis 1, upwards, and axis 2, to the left, meet. The upper arm a2 points "
        "forward. Axis 3 is parallel to axis 2; d3 leads along it to the left, then a3 forward. There the forearm "
        "hangs down by d4, along axes 4 and 6, to the wrist centre, where axis 5 points to the left.",
        lengths={"a_2": "a2", "a_3": "a3", "d_3": "d3", "d_4": "d4"},
    )


SYMBOLS = [f"theta{i}" for i in range(1, 7)]
QUARTERS = np.deg2rad([90, -90, 180, 90, -90, 180])


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


def wrist(given, lift, aside=1):
    """The wrist centre, with another cosine and sine for C23 and S23, or with d3 to the other side."""

    def p(arm, q):
        c, s, *_ = letters(q)
        c23, s23 = lift(q)
        a2, a3, d3, d4 = given.a2, given.a3, given.d3, given.d4
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


def exercise(given):
    """The exercise with these numbers."""
    bare, arm, at = given.arm, given.in_the_workshop, np.deg2rad(given.angles)
    return Exercise(
        name="puma560",
        title="The PUMA 560",
        arm=arm,
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
                        wrist(given, lambda q: (np.cos(q[1]) + np.cos(q[2]), np.sin(q[1]) + np.sin(q[2]))),
                    ),
                    Trap(
                        "Not θ3 alone turns the forearm, but θ2 too: axes 2 and 3 are parallel, so the angles add.",
                        wrist(given, lambda q: (np.cos(q[2]), np.sin(q[2]))),
                    ),
                    Trap(
                        "The bracket is C23 with a plus sign: C23 is the cosine of θ2 + θ3.",
                        wrist(given, lambda q: (np.cos(q[1] - q[2]), np.sin(q[1] - q[2]))),
                    ),
                    Trap(
                        "d3 stands on the other side of the shoulder: at θ1 = 0 it leads to the left, along +y.",
                        wrist(given, lambda q: (np.cos(q[1] + q[2]), np.sin(q[1] + q[2])), aside=-1),
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
                        "a_2": "the sign of a_2 may change alone: that is x_2 reversed.",
                        "alpha_4": "the sign of alpha_4 may change alone: that is x_4 reversed.",
                        "d_3": "it makes the mirror image: the forearm stands on the other side of the shoulder.",
                        "d_3 and d_4": "they may change together: each alone is a mirror, and two undo each other.",
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
            *last_pose(6, at, QUARTERS, "sec-puma560-product", at_quarters="sec-puma560-poses"),
            *with_gripper(arm, "T6", ("With a gripper", "Back from X"), at, np.deg2rad(given.hidden), **METRES),
        ],
    )


EXERCISE = exercise(DEFAULT)
