"""What the exercise on tables of the same mechanism asks, and how it is marked."""

from itertools import product

import numpy as np

from dhlib import Chain, Tx, Ty, Tz, robots
from dhlib.grading.asking import choice, reasoned
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Function, Numbers, Table

#: Tables as the page gives them: theta, d, a, alpha in metres and degrees.
PLANAR = [[0, 0, 0.5, 0], [0, 0, 0.3, 0], [0, 0, 0.2, 0]]
STANFORD = [[0, 0.412, 0, -90], [0, 0.154, 0, 90], [-90, 0, 0, 0], [0, 0, 0, -90], [0, 0, 0, 90], [0, 0.263, 0, 0]]
PUMA = [[0, 0, 0, -90], [0, 0, 0.4318, 0], [0, 0.15, 0.0203, -90], [0, 0.4318, 0, 90], [0, 0, 0, -90], [0, 0, 0, 0]]
#: The eight numbers of the PUMA that are not zero: row and column.
NUMBERS = {
    "alpha1": (0, 3), "alpha3": (2, 3), "alpha4": (3, 3), "alpha5": (4, 3),
    "a2": (1, 2), "a3": (2, 2), "d3": (2, 1), "d4": (3, 1),
}  # fmt: skip
#: How far the boom passes beside the column.
D2 = STANFORD[1][1]
FGL = robots.puma560("classic", "fgl")
HAND = ("alpha3", "a3", "d3", "d4")


def arm(rows):
    """A classic arm from such a table; the Stanford arm is the one that slides."""
    return Chain.from_table(rows, "theta d a alpha", "RRPRRR" if rows[2][0] else "R" * len(rows), "classic", True)


def changed(rows, *changes):
    """A table with some numbers changed: (row, column, value)."""
    rows = [list(row) for row in rows]
    for row, column, value in changes:
        rows[row][column] = value
    return rows


def flipped(*names):
    """The PUMA's table with some signs changed."""
    return changed(PUMA, *((*NUMBERS[name], -PUMA[NUMBERS[name][0]][NUMBERS[name][1]]) for name in names))


def joint_values(rows):
    """Eight sets of them; a slide is pulled out by 0.2 to 0.9 m."""
    random = np.random.default_rng(5)
    q = random.uniform(-2.8, 2.8, (8, len(rows)))
    if rows[2][0]:
        q[:, 2] = random.uniform(0.2, 0.9, 8)
    return [(tuple(each),) for each in q]


def translation(part, title, points, rows, other, zeros, senses=1, *, section, traps):
    """``part(q)``: joint values of another table, for the pose that the first has at q."""
    other, zeros = arm(other), np.deg2rad(zeros)

    def at(zeros, senses, scale=1.0):
        return lambda _, q: scale * np.asarray(zeros) + np.asarray(senses) * np.asarray(q)

    known = [
        Trap(
            "Half a turn is pi here, and not 180: joint angles are in radians.",
            at(np.rad2deg(zeros), senses),
            "degrees",
        )
    ]
    known.append(Trap("With the same joint values the two tables lead to different poses: try one.", at(0, 1)))
    if np.any(np.asarray(senses) != 1):
        known.append(Trap("The zeros are right, but one joint counts the other way.", at(zeros, 1), "sense"))
        if zeros.any():
            known.append(Trap("The senses are right; some joints count from another zero.", at(0, senses), "offset"))
    known += [Trap(says, at(np.deg2rad(d), s), key) for says, d, s, key in traps]
    asks = Function(
        at(zeros, senses),
        shape=(len(rows),),
        calls=joint_values(rows),
        signature=f"{part}(q)",
        means=other.fk,
    )
    return Part(part, title, points, asks, section=section, arm=arm(rows), traps=known)


def kind_of(part, title, right, section, **because):
    """Which of three an arm is; the words say why, or what to look at."""
    return choice(part, title, right, because, section)


#: What tells, by the letters of the page, and what to say where it does not hold.
TELLS = {
    "a": "every angle between neighbouring axes has the size that it has in PUMA.",
    "b": "here that sum is another, or the two axes are not parallel.",
    "c": "count the changes of sign, and what each of them does alone.",
    "d": "more than one sign is changed, or a size with it.",
}


def told_by(part, title, right, letters, section, **because):
    """Which of three an arm is, and what tells."""
    reasons = {letter: "" if letter in letters else says for letter, says in TELLS.items()}
    return reasoned(part, title, right, because, reasons, section)


def hand(signs, letters=HAND):
    """+1 if the PUMA with these signs is the PUMA, -1 if it is its mirror image."""
    by_name = dict(zip(NUMBERS, signs, strict=True))
    return np.prod([by_name[name] for name in letters])


def hand_trap(says, of):
    return Trap(says, lambda _, signs: of(signs))


EXERCISE = Exercise(
    name="same_arm",
    title="The same arm?",
    arm=arm(PUMA),
    parts=[
        kind_of(
            "exchanged",
            "Two links exchanged",
            "another",
            "sec-placing-physical",
            same="the distance between axes 1 and 2 belongs to the arm: no choice of frames changes it.",
            mirror="in a mirror lengths stay as they are, and here the first distance is another.",
            another="the distances between the axes are 0.3 and 0.5, in place of 0.5 and 0.3.",
        ),
        Part(
            "H",
            "Another last link",
            1,
            Numbers(lambda _, q: Tx(PLANAR[2][2] - 0.05), at=(), length_tolerance=1e-3),
            section="sec-placing-last",
            arm=arm(PLANAR),
            traps=[
                Trap("This is the last link of B. H is what is missing from it to that of A.", lambda _, q: Tx(0.05)),
                Trap("This is the whole last link of A; part of it is in B already.", lambda _, q: Tx(0.2)),
                Trap("The two last links differ in length; they are not added.", lambda _, q: Tx(0.25)),
                Trap("With this H nothing is added; but A reaches further than B.", lambda _, q: np.eye(4)),
                Trap("Lengths are in metres on this page.", lambda _, q: Tx(150), "unit"),
                Trap("The last link lies along x3, and so does what is missing from it.", lambda _, q: Ty(0.15)),
                Trap("The last link lies along x3, and so does what is missing from it.", lambda _, q: Tz(0.15)),
            ],
        ),
        translation(
            "to_C",
            "A link turned back",
            2,
            PLANAR,
            changed(PLANAR, (1, 2, -0.3)),
            [0, 180, 180],
            section="sec-puma560-flip",
            traps=[
                ("Joint 2 is right. The next joint has to take its half turn back.", [0, 180, 0], 1, "trap"),
                ("Joint 3 is right. The link before it still points backwards.", [0, 0, 180], 1, "trap"),
                ("This is x1 reversed; the sign of a2 is that of x2.", [180, 180, 0], 1, "trap"),
                (
                    "Reversing an x axis gives half a turn to two joints; no joint counts otherwise.",
                    0,
                    [1, -1, 1],
                    "sense",
                ),
                ("Only two joints gain half a turn: those on both sides of x2.", [180, 180, 180], 1, "trap"),
            ],
        ),
        translation(
            "to_D",
            "An axis turned over",
            2,
            PLANAR,
            changed(PLANAR, (0, 3, 180), (1, 3, 180)),
            [0, 0, 0],
            [1, -1, 1],
            section="sec-placing-sense",
            traps=[
                (
                    "Joint 2 is right. Axis 3 points up again: two half turns are a whole one.",
                    [0, 0, 0],
                    [1, -1, -1],
                    "sense",
                ),
                ("Axis 2 is the one that is turned over.", [0, 0, 0], [1, 1, -1], "sense"),
                ("Axis 1 is as it was: row 1 begins with it.", [0, 0, 0], [-1, 1, 1], "sense"),
                ("An axis that is turned over changes a sense and no zero.", [0, 180, 180], [1, -1, 1], "offset"),
                ("Not all joints count the other way: which axes point down?", [0, 0, 0], [-1, -1, -1], "sense"),
            ],
        ),
        Part(
            "d2",
            "A length in the row of the slide",
            2,
            Numbers(lambda _, q: D2 + 0.02, shape=(), at=(), tolerance=5e-4),
            section="sec-prismatic-trap-published",
            arm=arm(STANFORD),
            traps=[
                Trap("The sign: with a3 alone, which way has the wrist gone?", lambda _, q: D2 - 0.02),
                Trap("With d2 as it is the wrist stands 0.02 m aside.", lambda _, q: D2),
                Trap("Lengths are in metres on this page.", lambda _, q: 1000 * (D2 + 0.02), "unit"),
                Trap("That is a3. How far should the wrist be from axis 1, and how far is it?", lambda _, q: 0.02),
                Trap("The wrist would be on the other side of the shoulder.", lambda _, q: -D2 - 0.02),
                Trap(
                    "a3 is along axis 2 as d2 is, so no right-angled triangle stands here.",
                    lambda _, q: np.hypot(D2, 0.02),
                ),
            ],
        ),
        translation(
            "to_stanford",
            "The shoulder on the other side",
            3,
            STANFORD,
            changed(STANFORD, (1, 1, -0.154)),
            [180, 0, 0, 180, 0, 0],
            [1, -1, 1, 1, 1, 1],
            section="sec-prismatic-mirror",
            traps=[
                (
                    "The waist is right; now axis 2 points the other way, and the wrist has turned.",
                    [180, 0, 0, 0, 0, 0],
                    1,
                    "trap",
                ),
                (
                    "The arm is right; the wrist has to take back half a turn.",
                    [180, 0, 0, 0, 0, 0],
                    [1, -1, 1, 1, 1, 1],
                    "offset",
                ),
                (
                    "The wrist is right; the waist has to turn, or the shoulder stays on the wrong side.",
                    [0, 0, 0, 180, 0, 0],
                    [1, -1, 1, 1, 1, 1],
                    "offset",
                ),
                (
                    "The wrist has to take back half a turn about the boom: that is joint 4.",
                    [180, 0, 0, 0, 0, 180],
                    [1, -1, 1, 1, 1, 1],
                    "offset",
                ),
                (
                    "The slide may not go backwards: which joint counts the other way?",
                    [180, 0, 0, 180, 0, 0],
                    [1, 1, -1, 1, 1, 1],
                    "sense",
                ),
            ],
        ),
        told_by(
            "puma_1",
            "Table 1",
            "mirror",
            "d",
            "sec-puma560-hand",
            same="no choice of frames changes the sign of d3 and nothing else.",
            mirror="every length and every angle fits, but the forearm is on the other side of the shoulder.",
            another="all distances and all angles between the axes are as they were: the sizes have not changed.",
        ),
        told_by(
            "puma_2",
            "Table 2",
            "same",
            "c",
            "sec-puma560-parity",
            same="two signs that are each wrong alone undo each other; some joints count otherwise.",
            mirror="the sign of each alone makes the mirror image. And both?",
            another="all distances and all angles between the axes are as they were: the sizes have not changed.",
        ),
        told_by(
            "puma_3",
            "Table 3",
            "same",
            "b",
            "sec-placing-parallel",
            same="axes 2 and 3 are parallel: only the sum of d2 and d3 counts, and it is 0.15.",
            mirror="in a mirror the sum of d2 and d3 would be negative. What is it here?",
            another="axes 2 and 3 are parallel. What counts of d2 and d3?",
        ),
        told_by(
            "puma_4",
            "Table 4",
            "another",
            "a",
            "sec-puma560-trap-bracket",
            same="compare the angle between axes 1 and 2, in a classic table that of row 1.",
            mirror="a mirror keeps the size of each angle. Compare that between axes 1 and 2.",
            another="axes 1 and 2 lie on one line here: these are modified rows under a classic heading.",
        ),
        translation(
            "to_P",
            "Another book's zeros",
            2,
            PUMA,
            flipped("alpha1"),
            [180, 180, 0, 0, 0, 0],
            section="sec-puma560-corke",
            traps=[
                (
                    "Joint 1 is right; reversing x1 concerns the joints on both its sides.",
                    [180, 0, 0, 0, 0, 0],
                    1,
                    "offset",
                ),
                (
                    "Joint 2 is right; the base stays where it is, so joint 1 has to do its part.",
                    [0, 180, 0, 0, 0, 0],
                    1,
                    "offset",
                ),
                ("The sign of α1 is that of x1, and not of x2.", [0, 180, 180, 0, 0, 0], 1, "offset"),
                (
                    "The axes point as before: no joint counts the other way.",
                    [0, 0, 0, 0, 0, 0],
                    [-1, 1, 1, 1, 1, 1],
                    "sense",
                ),
            ],
        ),
        translation(
            "to_Q",
            "Three x axes",
            2,
            PUMA,
            flipped("alpha3", "alpha4", "alpha5", "a3"),
            [0, 0, 180, 0, 0, 180],
            section="sec-puma560-fgl",
            traps=[
                (
                    "Joints 4 and 5 lie between two reversed x axes, and gain two half turns: none.",
                    [0, 0, 180, 180, 180, 180],
                    1,
                    "offset",
                ),
                ("The first is right; x5 is reversed, and joint 6 comes after it.", [0, 0, 180, 0, 0, 0], 1, "offset"),
                ("The last is right; x3 is reversed, and joint 3 comes before it.", [0, 0, 0, 0, 0, 180], 1, "offset"),
                (
                    "Half turns of joints 3, 4 and 5 alone: each reversed x concerns the joint after it, too.",
                    [0, 0, 180, 180, 180, 0],
                    1,
                    "offset",
                ),
                ("That is x3 alone.", [0, 0, 180, 180, 0, 0], 1, "offset"),
            ],
        ),
        translation(
            "to_R",
            "An axis reversed",
            2,
            PUMA,
            flipped("alpha3", "alpha4", "d4"),
            [0] * 6,
            [1, 1, 1, -1, 1, 1],
            section="sec-puma560-parity",
            traps=[
                (
                    "The twists on both sides of an axis have changed. Which axis lies between links 3 and 4?",
                    [0] * 6,
                    [1, 1, -1, 1, 1, 1],
                    "sense",
                ),
                (
                    "The twists on both sides of an axis have changed. Which one lies between links 3 and 4?",
                    [0] * 6,
                    [1, 1, 1, 1, -1, 1],
                    "sense",
                ),
                ("One axis is reversed, and one joint counts the other way.", [0] * 6, [1, 1, -1, -1, 1, 1], "sense"),
                (
                    "Joint 4 is right; no x axis is reversed, so every zero stays.",
                    [0, 0, 0, 180, 180, 0],
                    [1, 1, 1, -1, 1, 1],
                    "offset",
                ),
                ("Not all joints count the other way.", [0] * 6, [-1] * 6, "sense"),
            ],
        ),
        Part(
            "hand",
            "Which signs keep the arm",
            3,
            Function(
                lambda _, signs: hand(signs),
                shape=(),
                calls=[(signs,) for signs in product((1, -1), repeat=len(NUMBERS))],
                signature="hand(signs)",
            ),
            section="sec-puma560-parity",
            traps=[
                hand_trap("Some signs may be changed alone: α1, for one. It is not all eight that count.", np.prod),
                hand_trap("Some changes of sign do make the mirror image.", lambda signs: 1),
                hand_trap("It is the other way round: with no sign changed it is the arm.", lambda signs: -hand(signs)),
                hand_trap(
                    "Two signs that are each wrong alone undo each other.",
                    lambda signs: min(hand(signs, [name]) for name in HAND),
                ),
                hand_trap("Not every change of sign makes another arm.", min),
                *(
                    hand_trap(
                        f"Change the sign of {name} alone, and see what becomes of the arm.",
                        lambda signs, name=name: hand(signs, [*HAND, name]),
                    )
                    for name in NUMBERS
                    if name not in HAND
                ),
                *(
                    hand_trap(
                        f"Change the sign of {name} alone, and see what becomes of the arm.",
                        lambda signs, name=name: hand(signs, [each for each in HAND if each != name]),
                    )
                    for name in HAND
                ),
                hand_trap("The twist α3 belongs to it, too.", lambda signs: hand(signs, ["a2", "a3", "d3", "d4"])),
            ],
        ),
        Part("table", "From one book to another", 3, Table("modified"), section="sec-puma560-tables", arm=FGL),
    ],
)
