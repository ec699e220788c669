"""What the exercise on tables of the same mechanism asks, and how it is marked."""

from dataclasses import dataclass
from itertools import chain, combinations, permutations, product

import numpy as np

from dhlib import Chain, Tx, Ty, Tz, robots
from dhlib.grading.asking import choice, reasoned
from dhlib.grading.course.sources import number, row
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Function, Numbers, Table
from dhlib.grading.pictures import described, same_for_all
from dhlib.scene import beside_each_other

#: Numbers of the PUMA's table that are not zero: row and column.
NUMBERS = {
    "alpha1": (0, 3), "alpha3": (2, 3), "alpha4": (3, 3), "alpha5": (4, 3),
    "a2": (1, 2), "a3": (2, 2), "d3": (2, 1), "d4": (3, 1),
}  # fmt: skip
FGL = robots.puma560("classic", "fgl")
HAND = ("alpha3", "a3", "d3", "d4")
#: What changes its sign in the PUMA's table if an x axis is reversed, or axes are.
X_REVERSED = {1: ("alpha1",), 2: ("a2",), 3: ("alpha3", "a3"), 4: ("alpha4",), 5: ("alpha5",)}
AXES_REVERSED = {(4,): ("alpha3", "alpha4", "d4"), (5,): ("alpha4", "alpha5"), (2, 3): ("alpha1", "alpha3", "d3")}


@dataclass(frozen=True)
class Given:
    """The numbers of the task, in m, and what is changed in the tables."""

    links: tuple[float, ...] = (0.5, 0.3, 0.2)
    last: float = 0.05
    #: Which links stand in the first table, with their signs.
    first: tuple[int, int, int] = (2, 1, 3)
    #: Which link of C is turned back, and which axis of D is turned over.
    back: int = 2
    over: int = 2
    #: Lengths d1, d2, d6 of the Stanford arm, and a3 in the row of its slide.
    stanford: tuple[float, ...] = (0.412, 0.154, 0.263)
    beside: float = 0.02
    #: Lengths a2, a3, d3, d4 of the PUMA.
    puma: tuple[float, ...] = (0.4318, 0.0203, 0.15, 0.4318)
    #: In which order four tables stand; which sign is changed alone, which two are, and how d2 + d3 is shared.
    tables: tuple[str, ...] = ("alone", "two", "shared", "modified")
    alone: str = "d3"
    two: tuple[str, str] = ("d3", "d4")
    shared: float = 0.25
    #: The x axis that is reversed in P, the first of three in Q, and the axes that are in R.
    x_of_p: int = 1
    x_of_q: int = 3
    axes_of_r: tuple[int, ...] = (4,)
    #: In which order the signs are given.
    order: tuple[str, ...] = tuple(NUMBERS)
    #: Lengths d2, a2, a3, d4, d6 in the manner of Fu, Gonzalez and Lee.
    fgl: tuple[float, ...] = (0.14909, 0.4318, -0.02032, 0.43307, 0.05625)

    @property
    def planar_rows(self):
        return [[0, 0, a, 0] for a in self.links]

    @property
    def first_links(self):
        """The lengths in the first table."""
        return [np.sign(link) * self.links[abs(link) - 1] for link in self.first]

    @property
    def stanford_rows(self):
        d1, d2, d6 = self.stanford
        return [[0, d1, 0, -90], [0, d2, 0, 90], [-90, 0, 0, 0], [0, 0, 0, -90], [0, 0, 0, 90], [0, d6, 0, 0]]

    @property
    def puma_rows(self):
        a2, a3, d3, d4 = self.puma
        return [[0, 0, 0, -90], [0, 0, a2, 0], [0, d3, a3, -90], [0, d4, 0, 90], [0, 0, 0, -90], [0, 0, 0, 0]]

    @property
    def fgl_rows(self):
        d2, a2, a3, d4, d6 = self.fgl
        return [[0, 0, 0, -90], [0, d2, a2, 0], [0, 0, a3, 90], [0, d4, 0, -90], [0, 0, 0, 90], [0, d6, 0, 0]]

    @property
    def signs(self):
        """Which numbers of the PUMA have another sign in P, Q and R."""
        three = (X_REVERSED[x] for x in range(self.x_of_q, self.x_of_q + 3))
        return X_REVERSED[self.x_of_p], tuple(chain.from_iterable(three)), AXES_REVERSED[self.axes_of_r]

    def with_signs(self, names):
        """The numbers of the PUMA of these names, with the other sign."""
        return {name: -self.puma_rows[NUMBERS[name][0]][NUMBERS[name][1]] for name in names}

    def flipped(self, names):
        """The PUMA's table with some signs changed."""
        return changed(self.puma_rows, *((*NUMBERS[name], value) for name, value in self.with_signs(names).items()))


DEFAULT = Given()


#: Parts with one answer for everybody: zeros and senses that no length changes.
SAME_FOR_ALL = ("to_stanford",)


def draw(lots):
    """Other arms of these kinds, and other changes: no length is that of the book."""
    d3 = lots.one("d3", [0.12, 0.13, 0.14, 0.16, 0.17, 0.18])
    two = lots.one("two", list(combinations(HAND, 2)))
    return Given(
        links=(
            lots.one("first link", [0.42, 0.44, 0.46, 0.54, 0.56]),
            lots.one("second link", [0.32, 0.33, 0.34, 0.36, 0.37]),
            lots.one("third link", [0.21, 0.22, 0.23, 0.24]),
        ),
        last=lots.one("last", [0.06, 0.07, 0.08, 0.09]),
        first=lots.one("first", [(2, 1, 3), (3, 2, 1), (1, 3, 2), (-1, -2, 3), (-1, 2, -3), (1, -2, -3)]),
        back=lots.one("back", [1, 2]),
        over=lots.one("over", [2, 3]),
        stanford=(
            lots.one("column", [0.38, 0.39, 0.43, 0.44, 0.46]),
            lots.one("shoulder", [0.132, 0.138, 0.146, 0.162, 0.168, 0.174]),
            lots.one("hand", [0.23, 0.24, 0.25, 0.27, 0.28]),
        ),
        beside=lots.one("beside", [0.015, 0.025, 0.03, 0.035]),
        puma=(
            lots.one("a2", [0.41, 0.42, 0.44, 0.45, 0.46]),
            lots.one("a3", [0.022, 0.024, 0.026, 0.028]),
            d3,
            lots.one("d4", [0.405, 0.415, 0.425, 0.435, 0.445]),
        ),
        tables=tuple(lots.one("tables", list(permutations(DEFAULT.tables))[1:])),
        alone=lots.one("alone", HAND),
        two=two,
        shared=lots.one("shared", [0.21, 0.22, 0.23, 0.24, 0.26, 0.27]),
        x_of_p=lots.one("P", [2, 4, 5]),
        x_of_q=lots.one("Q", [1, 2]),
        axes_of_r=lots.one("R", [(5,), (2, 3)]),
        order=tuple(lots.shuffled("order", list(NUMBERS))),
        fgl=(
            lots.one("fgl d2", [0.125, 0.135, 0.145, 0.155, 0.165]),
            lots.one("fgl a2", [0.412, 0.418, 0.424, 0.438, 0.444]),
            -lots.one("fgl a3", [0.021, 0.023, 0.025, 0.027]),
            lots.one("fgl d4", [0.402, 0.408, 0.428, 0.446, 0.452]),
            lots.one("fgl d6", [0.052, 0.054, 0.058, 0.062]),
        ),
    )


@same_for_all
def figure():
    """Two of the arms that others are compared with."""
    arms = (
        described(robots.stanford("classic"), "S", "S", q=(0, 0, 0.45, 0, 0, 0), width=PAIR),
        described(robots.puma560("classic"), "PUMA", "PUMA", width=PAIR),
    )
    return beside_each_other(
        arms,
        "The arms S, its boom pushed out, and PUMA, with all angles zero, not to scale: joint axes, and frame {0}",
        "Two arms with their joint axes. In S axis 2 leads aside from axis 1 to the boom, along which axes 3, 4 and 6 "
        "run; axis 5 crosses them. In PUMA axes 1 and 2 meet, axis 3 is parallel to axis 2, and the forearm hangs "
        "down aside of axis 1; axes 4, 5 and 6 meet in the wrist.",
    )


#: Width of one drawing of two.
PAIR = 225


def listed(name, rows, then=""):
    """A table as source, row by row."""
    return "\n".join([f"{name}[", *(f"    {row(each)}," for each in rows), f"]{then}"])


def as_call(**numbers):
    """A call of the page's ``puma``, with these numbers."""
    return f"puma({', '.join(f'{name}={number(value)}' for name, value in numbers.items())})"


def cells(given):
    """The given cells of the notebook."""
    l1, l2, _ = given.links
    planar = {
        "A": given.planar_rows,
        "first": [[0, 0, a, 0] for a in given.first_links],
        "B": [[0, 0, a, 0] for a in (l1, l2, given.last)],
        "C": turned_back(given),
        "D": turned_over(given),
    }
    rows = [f"[{', '.join(row(each) for each in table)}]" for table in planar.values()]
    d1, d2, d6 = map(number, given.stanford)
    a2, a3, d3, d4 = given.puma
    twists = "alpha1=-90, alpha3=-90, alpha4=90, alpha5=-90"
    modified = [(0, 0, 0, 0), (0, 0, 0, -90), (0, d3, a2, 0), (0, d4, a3, -90), (0, 0, 0, 90), (0, 0, 0, -90)]
    tables = {
        "alone": as_call(**given.with_signs([given.alone])),
        "two": as_call(**given.with_signs(given.two)),
        "shared": as_call(d2=given.shared, d3=d3 - given.shared),
        "modified": listed("arm(", modified, ', "RRRRRR")'),
    }
    return {
        "planar": "\n".join(f'{name} = arm({table}, "RRR")' for name, table in zip(planar, rows, strict=True)),
        "stanford": f"""\
def stanford(d2, a3):
    rows = [[0, {d1}, 0, -90], [0, d2, 0, 90], [-90, 0, a3, 0], [0, 0, 0, -90], [0, 0, 0, 90], [0, {d6}, 0, 0]]
    return arm(rows, "RRPRRR")


S = stanford({d2}, 0)
F = stanford({d2}, {number(given.beside)})
G = stanford(-{d2}, 0)""",
        "puma": "\n".join(
            [
                f"""\
def puma(
    {twists}, a2={number(a2)}, a3={number(a3)}, d2=0, d3={number(d3)}, d4={number(d4)}
):
    rows = [[0, 0, 0, alpha1], [0, d2, a2, 0], [0, d3, a3, alpha3], [0, d4, 0, alpha4], [0, 0, 0, alpha5], [0, 0, 0, 0]]
    return arm(rows, "RRRRRR")


PUMA = puma()""",
                *(f"table_{k} = {tables[kind]}" for k, kind in enumerate(given.tables, 1)),
                *(
                    f"{name} = {as_call(**given.with_signs(signs))}"
                    for name, signs in zip("PQR", given.signs, strict=True)
                ),
            ]
        ),
        "order": "\n".join(["order = [", *(f'    "{name}",' for name in given.order), "]"]),
        "fgl": listed("FGL = ", given.fgl_rows),
    }


def arm(rows):
    """A classic arm from such a table; the Stanford arm is the one that slides."""
    return Chain.from_table(rows, "theta d a alpha", "RRPRRR" if rows[2][0] else "R" * len(rows), "classic", True)


def changed(rows, *changes):
    """A table with some numbers changed: (row, column, value)."""
    rows = [list(each) for each in rows]
    for i, column, value in changes:
        rows[i][column] = value
    return rows


def turned_back(given):
    """The table C."""
    return changed(given.planar_rows, (given.back - 1, 2, -given.links[given.back - 1]))


def turned_over(given):
    """The table D: the twists on both sides of the axis."""
    return changed(given.planar_rows, (given.over - 2, 3, 180), (given.over - 1, 3, 180))


def half_turns(*joints, n=6):
    """Half a turn for these joints."""
    return [180 if i in joints else 0 for i in range(1, n + 1)]


def counting(*joints, n=6):
    """The senses, if these joints count the other way."""
    return [-1 if i in joints else 1 for i in range(1, n + 1)]


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


#: What is changed in a table of the PUMA: what it is, what tells, where it is told, and what to say.
TABLES = {
    "alone": (
        "mirror",
        "d",
        "sec-puma560-hand",
        {
            "same": "no choice of frames changes this sign and nothing else.",
            "mirror": "every length and every angle fits, but no choice of frames takes back the one sign.",
            "another": "all distances and all angles between the axes are as they were: the sizes have not changed.",
        },
    ),
    "two": (
        "same",
        "c",
        "sec-puma560-parity",
        {
            "same": "two signs that are each wrong alone undo each other.",
            "mirror": "the sign of each alone makes the mirror image. And both?",
            "another": "all distances and all angles between the axes are as they were: the sizes have not changed.",
        },
    ),
    "shared": (
        "same",
        "b",
        "sec-placing-parallel",
        {
            "same": "axes 2 and 3 are parallel: only the sum of d2 and d3 counts, and it is that of PUMA.",
            "mirror": "in a mirror the sum of d2 and d3 would be negative. What is it here?",
            "another": "axes 2 and 3 are parallel. What counts of d2 and d3?",
        },
    ),
    "modified": (
        "another",
        "a",
        "sec-puma560-trap-bracket",
        {
            "same": "compare the angle between axes 1 and 2, in a classic table that of row 1.",
            "mirror": "a mirror keeps the size of each angle. Compare that between axes 1 and 2.",
            "another": "axes 1 and 2 lie on one line here: these are modified rows under a classic heading.",
        },
    ),
}


def exercise(given):
    """The exercise with these numbers."""
    (l1, l2, l3), (_, d2, _), a3 = given.links, given.stanford, given.beside
    a1, a2, _ = map(abs, given.first_links)
    back, over, x, first, axes = given.back, given.over, given.x_of_p, given.x_of_q, given.axes_of_r
    planar, stanford, puma = given.planar_rows, given.stanford_rows, given.puma_rows
    P, Q, R = map(given.flipped, given.signs)
    missing, low, high = l3 - given.last, axes[0], axes[-1]

    def hand(signs, letters=HAND):
        """+1 if the PUMA with these signs is the PUMA, -1 if it is its mirror image."""
        by_name = dict(zip(given.order, signs, strict=True))
        return np.prod([by_name[name] for name in letters])

    def hand_trap(says, of):
        return Trap(says, lambda _, signs: of(signs))

    beyond = x + 1 if x < 5 else x - 1
    # Names and limits are those of the published arm, the lengths are given.
    joints = [joint.replace(d=d, a=a) for joint, (_, d, a, _) in zip(FGL.joints, given.fgl_rows, strict=True)]
    fgl = Chain(joints, "classic", name=FGL.name)
    return Exercise(
        name="same_arm",
        title="The same arm?",
        arm=arm(puma),
        parts=[
            kind_of(
                "exchanged",
                "Other lengths, other signs",
                "same" if (a1, a2) == (l1, l2) else "another",
                "sec-placing-physical",
                same="x axes are turned round, and the distances between the axes are what they were."
                if (a1, a2) == (l1, l2)
                else "the distances between the axes belong to the arm: no choice of frames changes them.",
                mirror="in a mirror the distances stay, and axes that are all parallel look the same in it.",
                another="the distances between the axes are what makes this arm. Are they others?"
                if (a1, a2) == (l1, l2)
                else f"the distances between the axes are {a1:g} and {a2:g}, in place of {l1:g} and {l2:g}.",
            ),
            Part(
                "H",
                "Another last link",
                1,
                Numbers(lambda _, q: Tx(missing), at=(), length_tolerance=1e-3),
                section="sec-placing-last",
                arm=arm(planar),
                traps=[
                    Trap(
                        "This is the last link of B. H is what is missing from it to that of A.",
                        lambda _, q: Tx(given.last),
                    ),
                    Trap("This is the whole last link of A; part of it is in B already.", lambda _, q: Tx(l3)),
                    Trap("The two last links differ in length; they are not added.", lambda _, q: Tx(l3 + given.last)),
                    Trap("With this H nothing is added; but A reaches further than B.", lambda _, q: np.eye(4)),
                    Trap("Lengths are in metres on this page.", lambda _, q: Tx(1000 * missing), "unit"),
                    Trap("The last link lies along x3, and so does what is missing from it.", lambda _, q: Ty(missing)),
                    Trap("The last link lies along x3, and so does what is missing from it.", lambda _, q: Tz(missing)),
                ],
            ),
            translation(
                "to_C",
                "A link turned back",
                2,
                planar,
                turned_back(given),
                half_turns(back, back + 1, n=3),
                section="sec-puma560-flip",
                traps=[
                    (
                        f"Joint {back} is right. The next joint has to take its half turn back.",
                        half_turns(back, n=3),
                        1,
                        "trap",
                    ),
                    (
                        f"Joint {back + 1} is right. The link before it still points backwards.",
                        half_turns(back + 1, n=3),
                        1,
                        "trap",
                    ),
                    (
                        f"This is x{3 - back} reversed; the sign of a{back} is that of x{back}.",
                        half_turns(3 - back, 4 - back, n=3),
                        1,
                        "trap",
                    ),
                    (
                        "Reversing an x axis gives half a turn to two joints; no joint counts otherwise.",
                        0,
                        counting(back, n=3),
                        "sense",
                    ),
                    (
                        f"Only two joints gain half a turn: those on both sides of x{back}.",
                        half_turns(1, 2, 3, n=3),
                        1,
                        "trap",
                    ),
                ],
            ),
            translation(
                "to_D",
                "An axis turned over",
                2,
                planar,
                turned_over(given),
                [0, 0, 0],
                counting(over, n=3),
                section="sec-placing-sense",
                traps=[
                    (
                        f"Joint {over} is right. Axis {5 - over} points up: count the half turns before it.",
                        [0, 0, 0],
                        counting(2, 3, n=3),
                        "sense",
                    ),
                    (f"Axis {over} is the one that is turned over.", [0, 0, 0], counting(5 - over, n=3), "sense"),
                    ("Axis 1 is as it was: row 1 begins with it.", [0, 0, 0], counting(1, n=3), "sense"),
                    (
                        "An axis that is turned over changes a sense and no zero.",
                        [0, 180, 180],
                        counting(over, n=3),
                        "offset",
                    ),
                    ("Not all joints count the other way: which axes point down?", [0, 0, 0], [-1, -1, -1], "sense"),
                ],
            ),
            Part(
                "d2",
                "A length in the row of the slide",
                2,
                Numbers(lambda _, q: d2 + a3, shape=(), at=(), tolerance=5e-4),
                section="sec-prismatic-trap-published",
                arm=arm(stanford),
                traps=[
                    Trap("The sign: with a3 alone, which way has the wrist gone?", lambda _, q: d2 - a3),
                    Trap("With d2 as it is the wrist stands aside by a3.", lambda _, q: d2),
                    Trap("Lengths are in metres on this page.", lambda _, q: 1000 * (d2 + a3), "unit"),
                    Trap("That is a3. How far should the wrist be from axis 1, and how far is it?", lambda _, q: a3),
                    Trap("The wrist would be on the other side of the shoulder.", lambda _, q: -d2 - a3),
                    Trap(
                        "a3 is along axis 2 as d2 is, so no right-angled triangle stands here.",
                        lambda _, q: np.hypot(d2, a3),
                    ),
                ],
            ),
            translation(
                "to_stanford",
                "The shoulder on the other side",
                3,
                stanford,
                changed(stanford, (1, 1, -d2)),
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
            *(
                told_by(f"puma_{k}", f"Table {k}", right, letters, section, **because)
                for k, (right, letters, section, because) in enumerate((TABLES[kind] for kind in given.tables), 1)
            ),
            translation(
                "to_P",
                "Another book's zeros",
                2,
                puma,
                P,
                half_turns(x, x + 1),
                section="sec-puma560-corke",
                traps=[
                    (
                        f"Joint {x} is right; reversing x{x} concerns the joints on both its sides.",
                        half_turns(x),
                        1,
                        "offset",
                    ),
                    (
                        f"Joint {x + 1} is right; joint {x} is on the other side of x{x}, and has to do its part.",
                        half_turns(x + 1),
                        1,
                        "offset",
                    ),
                    (
                        f"The sign that is changed is that of x{x}, and not of x{beyond}.",
                        half_turns(beyond, beyond + 1),
                        1,
                        "offset",
                    ),
                    ("The axes point as before: no joint counts the other way.", [0] * 6, counting(x), "sense"),
                ],
            ),
            translation(
                "to_Q",
                "Three x axes",
                2,
                puma,
                Q,
                half_turns(first, first + 3),
                section="sec-puma560-fgl",
                traps=[
                    (
                        f"Joints {first + 1} and {first + 2} lie between two reversed x axes, "
                        "and gain two half turns: none.",
                        half_turns(first, first + 1, first + 2, first + 3),
                        1,
                        "offset",
                    ),
                    (
                        f"The first is right; x{first + 2} is reversed, and joint {first + 3} comes after it.",
                        half_turns(first),
                        1,
                        "offset",
                    ),
                    (
                        f"The last is right; x{first} is reversed, and joint {first} comes before it.",
                        half_turns(first + 3),
                        1,
                        "offset",
                    ),
                    (
                        f"Half turns of joints {first}, {first + 1} and {first + 2} alone: "
                        "each reversed x concerns the joint after it, too.",
                        half_turns(first, first + 1, first + 2),
                        1,
                        "offset",
                    ),
                    (f"That is x{first} alone.", half_turns(first, first + 1), 1, "offset"),
                ],
            ),
            translation(
                "to_R",
                "An axis reversed",
                2,
                puma,
                R,
                [0] * 6,
                counting(*axes),
                section="sec-puma560-parity",
                traps=[
                    (
                        f"The twists α{low - 1} and α{high} have changed. "
                        f"What lies between links {low - 1} and {high}?",
                        [0] * 6,
                        counting(low - 1),
                        "sense",
                    ),
                    (
                        f"The twists α{low - 1} and α{high} have changed. "
                        f"What lies between links {low - 1} and {high}?",
                        [0] * 6,
                        counting(high + 1),
                        "sense",
                    ),
                    (
                        f"Joint {low - 1} counts as before: its axis comes before the first twist that has changed.",
                        [0] * 6,
                        counting(low - 1, *axes),
                        "sense",
                    ),
                    (
                        "The senses are right; no x axis is reversed, so every zero stays.",
                        half_turns(low, low + 1),
                        counting(*axes),
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
                    hand_trap(
                        "It is the other way round: with no sign changed it is the arm.", lambda signs: -hand(signs)
                    ),
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
            Part("table", "From one book to another", 3, Table("modified"), section="sec-puma560-tables", arm=fgl),
        ],
    )


EXERCISE = exercise(DEFAULT)
