"""What the PUMA 560 exercise asks, and how it is marked."""

from dataclasses import dataclass
from itertools import combinations, permutations, product

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Ty, Tz, robots
from dhlib.grading.asking import EXACT, METRES, choice, last_pose, link_function, measured_at, pose, with_gripper
from dhlib.grading.course.sources import lengths, matrix, number, row, strings
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Formula, Frames, Table
from dhlib.grading.pictures import described, same_for_all

CRAIG = robots.puma560("modified", "craig")
#: Numbers of the classic table whose sign makes the mirror image, if it is changed alone; and those that may be.
HAND = ("alpha_3", "a_3", "d_3", "d_4")
FREE = {"alpha_1": "x_1", "a_2": "x_2", "alpha_4": "x_4", "alpha_5": "x_5"}
#: How an entry of the first column is printed: right, with a wrong sign, or with a wrong index too.
SLIPS = {"right": (6, 1), "one": (6, -1), "two": (5, -1)}
ENTRIES = ("n_x", "n_y", "n_z")


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
    #: Which of links 5 and 6 is printed wrongly, in which row, and which of the two stands first.
    printed_links: tuple[int, int, int] = (5, 3, 5)
    #: How many slips there are in n_x, n_y and n_z as printed.
    slips: tuple[str, ...] = ("two", "one", "right")
    #: Four changes of sign, one of which makes the mirror image; and which x axis another book has reversed.
    signs: tuple[str, ...] = ("a_2", "alpha_4", "d_3", "d_3 and d_4")
    reversed_x: int = 1

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


#: Parts with one answer for everybody: no length of the arm stands in these links.
SAME_FOR_ALL = ("A1", "A2", "A5", "A6")


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
        printed_links=lots.one(
            "links", [case for case in product((5, 6), (2, 3), (5, 6)) if case != DEFAULT.printed_links]
        ),
        slips=lots.one("slips", list(permutations(DEFAULT.slips))[1:]),
        signs=tuple(
            lots.shuffled(
                "signs",
                [
                    lots.one("mirror", HAND),
                    " and ".join(lots.one("two signs", list(combinations(HAND, 2)))),
                    *lots.some("free signs", list(FREE), 2),
                ],
            )
        ),
        reversed_x=lots.one("reversed", [2, 3, 4, 5]),
    )


def cells(given):
    """The given cells of the notebook."""
    measured = measured_at(given.in_the_workshop, np.deg2rad(given.hidden))
    wrong_link, wrong_row, first_link = given.printed_links
    length, turn, tilt = given.gripper
    return {
        "arm": lengths("metres", a2=given.a2, a3=given.a3, d3=given.d3, d4=given.d4),
        "angles": f"q = np.deg2rad({row(given.angles)})",
        "links": "\n".join(
            f"{name} = {printed_link(i, wrong_row if i == wrong_link else 0)}"
            for name, i in (("first", first_link), ("second", 11 - first_link))
        ),
        "column": "\n".join(
            [
                "printed = {",
                *(f'    "{ENTRIES[k]}": {printed_entry(k, *SLIPS[how])},' for k, how in enumerate(given.slips)),
                "}",
            ]
        ),
        "signs": strings("signs", given.signs),
        "other_table": printed_table(given.reversed_x),
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


def n_entry(row, slip4=6, sign=1):
    """An entry of the first column; its first bracket may hold S4 S5 for S4 S6, and the sign after it may be wrong."""

    def entry(arm, q):
        c, s, c23, s23 = letters(q)
        bracket = c[4] * c[5] * c[6] - s[4] * s[slip4]
        out, aside = c23 * bracket - s23 * s[5] * c[6], sign * (s[4] * c[5] * c[6] + c[4] * s[6])
        return (c[1] * out + s[1] * aside, s[1] * out - c[1] * aside, -s23 * bracket - sign * c23 * s[5] * c[6])[row]

    return entry


def printed_entry(row, slip4, sign):
    """The same, as source in the letters of the slides."""
    bracket, plus, minus = f"(C4 * C5 * C6 - S4 * S{slip4})", *("+-" if sign > 0 else "-+")
    out, aside = f"(C23 * {bracket} - S23 * S5 * C6)", "(S4 * C5 * C6 + C4 * S6)"
    return (
        f"C1 * {out} {plus} S1 * {aside}",
        f"S1 * {out} {minus} C1 * {aside}",
        f"-S23 * {bracket} {minus} C23 * S5 * C6",
    )[row]


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


def mirrored(i, wrong_row=3):
    """Link 5 or 6 with the wrong sign in its second or third row."""
    sides = np.ones((4, 1))
    sides[wrong_row - 1] = -1
    return lambda arm, q: sides * arm.A(i, q)


def printed_link(i, wrong_row):
    """Link 5 or 6 as source, with the wrong sign in a row, or in none."""
    up, down = (
        (1 if i == 5 else -1) * (-1 if wrong_row == 3 else 1),
        (-1 if i == 5 else 1) * (-1 if wrong_row == 2 else 1),
    )
    third = f"[S{i}, C{i}, 0, 0]" if up > 0 else f"[-S{i}, -C{i}, 0, 0]"
    return f"sp.Matrix([[C{i}, -S{i}, 0, 0], [0, 0, {down}, 0], {third}, [0, 0, 0, 1]])"


def mended_link(i, wrong_row, arm, title):
    """Link 5 or 6, one of which is printed wrongly."""
    z = "down" if i == 6 else "to the left"
    turn = 90 if i == 5 else -90
    return Part(
        f"A{i}",
        title,
        1,
        Formula(pose(i - 1, i), symbols=SYMBOLS, **EXACT),
        section="sec-puma560-links",
        arm=arm,
        traps=[
            Trap(
                "Its determinant is -1, and no link of any arm has that: which row has the wrong sign?",
                mirrored(i, wrong_row),
            ),
            Trap(
                f"Its determinant is +1, but its twist is {-turn:+}°. Which turn about x leads from z_{i - 1} "
                f"to z_{i}, {z}?",
                lambda arm, q: Rx(np.deg2rad(-turn)) @ Rz(q[i - 1]),
            ),
        ],
        kinematics=False,
    )


def printed_table(reversed_x):
    """The classic table with one x axis reversed, as source."""
    rows = [
        ['"q1"', "0", "0", "-pi / 2"],
        ['"q2"', "0", "a2", "0"],
        ['"q3"', "d3", "a3", "-pi / 2"],
        ['"q4"', "d4", "0", "pi / 2"],
        ['"q5"', "0", "0", "-pi / 2"],
        ['"q6"', "0", "0", "0"],
    ]
    theta, d, *link = rows[reversed_x - 1]
    rows[reversed_x - 1] = [
        theta,
        d,
        *(each if each == "0" else each[1:] if each[0] == "-" else f"-{each}" for each in link),
    ]
    return "\n".join(["other_table = [", *(f"    [{', '.join(each)}]," for each in rows), "]"])


def mended(k, slips, arm):
    """The part that asks for the first or the second of the entries that are printed wrongly."""
    row = [row for row, how in enumerate(slips) if how != "right"][k]
    before = ("S1", "C1", "C23")[row]
    wrist = (
        " It belongs to a wrist whose three twists have the other signs, and not to the p beside it." if row < 2 else ""
    )
    sign = f"Look at the sign before {before}."
    if slips[row] == "two":
        as_printed = "This is the entry as it is printed. An index is wrong in its first bracket, and then a sign."
        says = {(5, -1): as_printed, (6, -1): f"S4 S6 is right. One slip is left.{wrist} {sign}"}
    else:
        both = f"An index is wrong here that is right as printed, in the first bracket. {sign}"
        says = {(6, -1): f"This is the entry as it is printed.{wrist} {sign}", (5, -1): both}
    says[5, 1] = f"The sign before {before} is right. One slip is left: an index in the first bracket."
    return Part(
        f"mended_{k + 1}",
        f"Mend the {('first', 'second')[k]}",
        2,
        Formula(lambda arm, q: arm.T(0, 6, q)[row, 0], shape=(), symbols=SYMBOLS),
        section="sec-puma560-entries",
        arm=arm,
        traps=[Trap(says[how], n_entry(row, *how)) for how in ((5, -1), (6, -1), (5, 1))],
        kinematics=False,
    )


def fine(slips):
    """The part that asks which entry is right as printed."""
    says = {
        "two": "{} holds two slips: mending one of them is not enough.",
        "one": "in {} a sign is wrong: compare it with the entry of your product.",
        "right": "{} is the entry of the product, sign for sign.",
    }
    because = {name: says[how].format(name) for name, how in zip(ENTRIES, slips, strict=True)}
    return choice(
        "fine", "Which entry is right as printed", ENTRIES[slips.index("right")], because, "sec-puma560-entries"
    )


def mirror(signs):
    """The part that asks which change of sign makes the mirror image."""
    because = {}
    for change in signs:
        if change in HAND:
            because[change] = "no choice of frames changes this sign alone: it makes the mirror image of the arm."
        elif change in FREE:
            because[change] = f"the sign of {change} may change alone: that is {FREE[change]} reversed."
        else:
            because[change] = "they may change together: each alone is a mirror, and two undo each other."
    (right,) = set(signs) & set(HAND)
    return choice("mirror", "Which sign makes another arm", right, because, "sec-puma560-parity")


def zeros(reversed_x):
    """The part that asks which zeros an x axis reversed has moved."""
    options = {k: f"{k} and {k + 1}" for k in range(1, 6)}
    because = {"none": "a sign in one row is not as in yours, so an x axis is reversed, and that moves zeros."}
    for k, option in options.items():
        because[option] = (
            f"x_{k} is reversed there: the signs of row {k} have changed, and joints {k} and {k + 1} gain half a turn."
            if k == reversed_x
            else f"that would reverse x_{k}, but row {k} of that table is like yours."
        )
    return choice("zeros", "Another book's zeros", options[reversed_x], because, "sec-puma560-corke")


def exercise(given):
    """The exercise with these numbers."""
    bare, arm, at = given.arm, given.in_the_workshop, np.deg2rad(given.angles)
    wrong_link, wrong_row, first_link = given.printed_links
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
            choice(
                "slip",
                "Which matrix is printed wrongly",
                "first" if first_link == wrong_link else "second",
                {
                    name: "its determinant is -1, so it is a mirror and no link of any arm."
                    if i == wrong_link
                    else f"the {name} has determinant +1 and is a link of the arm."
                    for name, i in (("first", first_link), ("second", 11 - first_link))
                }
                | {"both": "one of the two has determinant +1, and is a link of the arm."},
                "sec-puma560-links",
            ),
            mended_link(5, wrong_row, bare, "A5 in symbols"),
            mended_link(6, wrong_row, bare, "A6 in symbols"),
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
            fine(given.slips),
            mended(0, given.slips, bare),
            mended(1, given.slips, bare),
            Part(
                "classic_table",
                "The classic table of the same arm",
                3,
                Table("classic"),
                section="sec-puma560-row-down",
                arm=bare,
            ),
            mirror(given.signs),
            zeros(given.reversed_x),
            *last_pose(6, at, QUARTERS, "sec-puma560-product", at_quarters="sec-puma560-poses"),
            *with_gripper(arm, "T6", ("With a gripper", "Back from X"), at, np.deg2rad(given.hidden), **METRES),
        ],
    )


EXERCISE = exercise(DEFAULT)
