"""What the exercise on converting between the conventions asks, and how it is marked."""

from dataclasses import dataclass, replace
from functools import cache
from itertools import permutations

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Tz
from dhlib.grading.asking import choice, constant, pose, reasoned, reasons_by_letter
from dhlib.grading.course.sources import lettered, number, row
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Function, Numbers, Table
from dhlib.grading.pictures import described

#: What may tell the convention of a table.
REASONS = {
    "pose": "a pose of the arm was measured, and it agrees with one reading only",
    "parallel": "two axes are known to be parallel, and the row of the link between them shows the convention",
    "equal": "all rows are equal, so that moving columns changes nothing between the axes",
    "columns": "the columns stand in the order of one convention",
}
#: What to say to whoever gives it where it does not hold.
NO_REASON = {
    "pose": "no pose of this arm is known.",
    "parallel": "nothing is said of parallel axes here.",
    "equal": "these rows differ from each other.",
    "columns": "columns can be printed in any order: that proves nothing.",
}


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in mm, angles in degrees."""

    #: Of W: joint 3 slides, so it has an angle and no d.
    w_turn: float = 90
    w_d: tuple[float, ...] = (120, 30, 80)
    w_a: tuple[float, ...] = (50, 200, 40, 60)
    w_alpha: tuple[float, ...] = (-90, 90, -90, 90)
    gripper: tuple[float, ...] = (90, 45)
    v_d: tuple[float, ...] = (130, 60, -35, 95)
    v_a: tuple[float, ...] = (45, 25, 180, 70)
    v_alpha: tuple[float, ...] = (90, -90, 60, 90)
    corner: tuple[float, ...] = (200, 300)
    #: Of which frame it is asked what stays.
    m: int = 2
    #: Rows d, a, alpha of a table without a heading, where somebody measured, and what the table is.
    unknown: tuple[tuple[float, ...], ...] = ((150, 30, 90), (40, 0, -90), (25, 120, 90), (70, 50, -90))
    angles: tuple[float, ...] = (20, -40, 65, 110)
    measured_as: str = "modified"
    #: Rows of another, with the upper arm among them, and the length of three equal links.
    first: tuple[tuple[float, ...], ...] = ((200, 30, -90), (0, 250, 0), (30, 40, 90), (60, 20, 90))
    equal: float = 150
    #: In which order the reasons are listed.
    reasons: tuple[str, ...] = ("pose", "parallel", "equal", "columns")

    @property
    def W(self):
        """Rows theta, d, a, alpha."""
        d1, d2, d4 = self.w_d
        joints = [("q1", d1), ("q2", d2), (np.deg2rad(self.w_turn), "q3"), ("q4", d4)]
        rows = [[*joint, a, np.deg2rad(alpha)] for joint, a, alpha in zip(joints, self.w_a, self.w_alpha, strict=True)]
        length, turn = self.gripper
        return Chain.from_table(rows, convention="classic", tool=Tz(length) @ Rz(np.deg2rad(turn)), unit="mm")

    @property
    def V(self):
        """Rows alpha, a, theta, d."""
        links = zip(self.v_alpha, self.v_a, self.v_d, strict=True)
        rows = [[np.deg2rad(alpha), a, f"q{i}", d] for i, (alpha, a, d) in enumerate(links, 1)]
        x, z = self.corner
        return Chain.from_table(rows, convention="modified", base=Tx(x) @ Tz(z) @ Rz(np.pi / 2), unit="mm")

    def read_as(self, convention):
        """The table without a heading, in one convention or the other."""
        rows = [[0, *row] for row in self.unknown]
        return Chain.from_table(rows, "theta d a alpha", "RRRR", convention, degrees=True, unit="mm")

    @property
    def measured(self):
        return self.read_as(self.measured_as).fk(np.deg2rad(self.angles))[:3, 3]

    @property
    def upper_arm(self):
        return max(a for _, a, _ in self.first)

    @property
    def upper_arm_row(self):
        return [a for _, a, _ in self.first].index(self.upper_arm) + 1


DEFAULT = Given()

QUARTERS = [(90, -90, 90, -90), (-90, -90, 90, 90), (90, 90, -90, -90), (-90, 90, 90, -90)]


#: Parts with one answer for everybody: functions for any table, called with many.
SAME_FOR_ALL = ("to_modified", "to_classic")


def draw(lots):
    """Other arms of the same kinds: no length, and no angle but a quarter turn, is that of the book."""
    # Lengths of one arm are all different, so that one that was moved to a wrong place is seen.
    w1, w2, w4, w5, w6, w7 = lots.some("W", range(32, 118, 6), 6)
    v1, v2, v3, v4, v5, v6 = lots.some("V", range(28, 124, 6), 6)
    u1, u2, u3, u4, u5 = lots.some("unknown", range(26, 92, 6), 5)
    f1, f2, f3, f4, f5 = lots.some("first", range(24, 72, 6), 5)
    turns = lots.one("V turns", [turns for turns in QUARTERS if turns[1] != turns[3]])
    sign, other, last = lots.one("signs", [(-1, 1, 1), (1, 1, -1), (-1, -1, 1), (1, -1, -1)])
    sizes = lots.some("angles", range(21, 77, 5), 4)  # all different, so that no sum of two is zero
    signs = lots.one("senses", [(-1, 1, 1, 1), (1, 1, -1, 1), (1, -1, -1, 1), (-1, -1, 1, -1)])
    upper, fore = (0, lots.one("upper arm", range(212, 246, 4)), 0), (f4, f5, lots.one("fore", [90, -90]))
    middle = lots.one("row of the upper arm", [(upper, fore), (fore, upper)])
    return Given(
        w_turn=lots.one("W turn", [90, -90]),
        w_d=(w1, w2, w4),
        w_a=(w5, lots.one("W link", range(166, 236, 4)), w6, w7),
        w_alpha=lots.one("W turns", QUARTERS),
        gripper=(lots.one("gripper", range(121, 159, 4)), lots.one("gripper turn", [30, 60, -30, -45, -60])),
        v_d=(lots.one("V height", range(126, 152, 4)), v1, -v2, v3),
        v_a=(v4, v5, lots.one("V link", range(161, 211, 6)), v6),
        v_alpha=(*turns[:2], lots.one("V twist", [30, 45, -30, -45, -60]), turns[3]),
        corner=(lots.one("x", range(210, 400, 20)), lots.one("z", range(250, 450, 20))),
        m=lots.one("frame", [3, 4, 5]),
        unknown=(
            (lots.one("unknown height", range(132, 178, 4)), u1, 90 * sign),
            (u2, 0, -90 * sign),
            (u3, lots.one("unknown link", range(102, 138, 4)), 90 * other),
            (u4, u5, 90 * last),
        ),
        angles=tuple(sense * size for sense, size in zip(signs, sizes, strict=True)),
        measured_as=lots.one("measured", ["classic", "modified"]),
        first=((lots.one("first height", range(172, 228, 8)), f1, 90), *middle, (f2, f3, lots.one("end", [90, -90]))),
        equal=lots.one("equal", range(110, 190, 20)) + 5,
        reasons=lots.one("reasons", list(permutations(REASONS))[1:]),
    )


def figure(given):
    """Arm W, as its table has it, but for its lengths."""
    return outline(given.w_turn, given.w_alpha)


@cache
def outline(turn, twists):
    """An arm like W, drawn once for all that have these angles."""
    return described(
        replace(DEFAULT, w_turn=turn, w_alpha=twists).W,
        "Arm W, joint 3 pushed out and all angles zero, not to scale: its joint axes, and its frame {0}",
        "Arm W: axis 1 is vertical. A link of the table leads from each of the four axes to the next. Joint 3 slides, "
        "and is drawn as a block; the gripper is behind axis 4. Only frame 0 is drawn.",
        q=(0, 0, 90, 0),
    )


def turn(degrees):
    """A fraction of half a turn, as source."""
    return f"{'-' if degrees < 0 else ''}pi / {180 // abs(degrees)}" if degrees else "0"


def listed(name, rows):
    """A table as source, row by row."""
    return "\n".join([f"{name} = [", *(f"    [{', '.join(row)}]," for row in rows), "]"])


def cells(given):
    """The given cells of the notebook."""
    w_d = [number(d) for d in given.w_d]
    joints = [('"q1"', w_d[0]), ('"q2"', w_d[1]), (turn(given.w_turn), '"q3"'), ('"q4"', w_d[2])]
    W = [[*joint, number(a), turn(alpha)] for joint, a, alpha in zip(joints, given.w_a, given.w_alpha, strict=True)]
    links = zip(given.v_alpha, given.v_a, given.v_d, strict=True)
    V = [[turn(alpha), number(a), f'"q{i}"', number(d)] for i, (alpha, a, d) in enumerate(links, 1)]
    length, tilt = given.gripper
    x, z = given.corner

    def unlabelled(rows):
        return [[number(d), number(a), turn(alpha)] for d, a, alpha in rows]

    return {
        "tables": f"""\
{listed("W", W)}
E = Tz({number(length)}) @ Rz({turn(tilt)})

{listed("V", V)}
Z = Tx({number(x)}) @ Tz({number(z)}) @ Rz(pi / 2)""",
        "frame": f"m = {given.m}",
        "unlabelled": f"""\
# Row i: d_i and a in millimetres, alpha in radians
{listed("rows", unlabelled(given.unknown))}
q = np.deg2rad({row(given.angles)})
p_measured = {row(given.measured, decimals=1)}  # millimetres""",
        "reasons": lettered("reasons", [REASONS[reason] for reason in given.reasons]),
        "two_more": f"""\
# Rows d_i, a, alpha, and the distance of axes 2 and 3 of the first arm
{listed("first", unlabelled(given.first))}
upper_arm = {number(given.upper_arm)}

{listed("second", unlabelled([(0, given.equal, 0)] * 3))}""",
    }


#: Five rows of any table, for functions that rearrange them.
random = np.random.default_rng(8)
TABLES = [np.round(random.uniform(-3, 3, (5, 4)) * [1, 100, 100, 1], 2) for _ in range(4)]
MODIFIED_TABLES = [table[:, [3, 2, 0, 1]] for table in TABLES]


def bare(chain):
    """The rows alone, without what is left over at the ends."""
    return Chain(chain.joints, chain.convention, unit=chain.unit)


def rows_not_moved(given, down):
    """Tables in which a and α stay in their row, move the wrong way, or come back at the other end."""
    way, end = ("down", "top") if down else ("up", "bottom")
    links = [(joint.a, joint.alpha) for joint in given.joints]
    back, zero = (links[-1:], [(0, 0)]) if down else (links[:1], [(0, 0)])
    wrong = {
        f"In your table a and α are still in the row where they were: they move {way} by one.": links,
        f"In this direction a and α move {way}; here they move the other way.": links[1:] + zero
        if down
        else zero + links[:-1],
        f"What is left over goes to an end of the arm: it does not come back at the {end}.": (
            back + links[:-1] if down else links[1:] + back
        ),
    }

    def told(moved):
        joints = [joint.replace(a=a, alpha=alpha) for joint, (a, alpha) in zip(given.joints, moved, strict=True)]
        return lambda arm: Chain(joints, arm.convention, unit=arm.unit)

    return [Trap(says, told(moved), "row") for says, moved in wrong.items()]


def link(chain, i):
    """X_i of a classic chain."""
    joint = chain.joints[i - 1]
    return Tx(joint.a) @ Rx(joint.alpha)


def to_modified(rows, top=None, roll=1):
    """Rows alpha, a, theta, d of rows theta, d, a, alpha."""
    rows = np.asarray(rows, dtype=float)
    links = np.roll(rows[:, [3, 2]], roll, axis=0)
    if roll:
        links[0 if roll > 0 else -1] = 0 if top is None else top
    return np.hstack([links, rows[:, :2]])


def to_classic(rows, last=None, roll=-1):
    """Rows theta, d, a, alpha of rows alpha, a, theta, d."""
    rows = np.asarray(rows, dtype=float)
    links = np.roll(rows[:, [1, 0]], roll, axis=0)
    if roll:
        links[-1 if roll < 0 else 0] = 0 if last is None else last
    return np.hstack([rows[:, 2:], links])


def poses(part, title, points, right, section, arm, wrong):
    """A pose that is given by the task, and what else is handed in for it."""
    traps = [Trap(says, constant(value)) for says, value in wrong]
    asks = Numbers(constant(right), at=())
    return Part(part, title, points, asks, section=section, arm=bare(arm), traps=traps)


def rearranged(part, title, points, rule, calls, traps):
    asks = Function(lambda _, rows: rule(rows), shape=(5, 4), calls=[(c,) for c in calls], signature=f"{part}(rows)")
    traps = [Trap(says, lambda _, rows, wrong=wrong: wrong(rows)) for says, wrong in traps]
    return Part(part, title, points, asks, section="sec-both-columns", traps=traps, kinematics=False)


#: What to say of each reading, by the row that holds the link between axes 2 and 3.
UPPER_ARM_IN = {
    2: {
        "classic": "the link between axes 2 and 3 is link 2, and it stands in row 2.",
        "modified": "in a modified table row 2 holds the link between axes 1 and 2, and they are not parallel.",
    },
    3: {
        "classic": "in a classic table row 3 holds the link between axes 3 and 4, and they are not parallel.",
        "modified": "the link between axes 2 and 3 is link 2, and it stands in row 3.",
    },
}


def exercise(given):
    """The exercise with these numbers."""
    W, V, m, at = given.W, given.V, given.m, np.deg2rad(given.angles)
    E, Z = W.tool, V.base
    X2, X4, X0 = link(W, 2), link(W, 4), Tx(V.joints[0].a) @ Rx(V.joints[0].alpha)
    (a2, alpha2), (a4, alpha4) = ((joint.a, joint.alpha) for joint in (W.joints[1], W.joints[3]))
    a0, alpha0 = V.joints[0].a, V.joints[0].alpha
    return Exercise(
        name="convert",
        title="From one convention to the other",
        arm=given.read_as("classic"),
        parts=[
            Part(
                "modified_table",
                "Classic to modified",
                3,
                Table("modified"),
                section="sec-both-columns",
                arm=bare(W.to_modified()),
                traps=rows_not_moved(W, down=True),
                kinematics=False,
            ),
            poses(
                "tool",
                "What is left over at the hand",
                2,
                X4 @ E,
                "sec-both-tool",
                W,
                [
                    ("This is what is left over, without the gripper that was there before.", X4),
                    ("This is the gripper alone; the last link of the classic table is not in the modified one.", E),
                    (
                        "The last link comes before the gripper: what is left over stands in front of what is there.",
                        E @ X4,
                    ),
                    ("Both a and α of the last link are left over: α is missing here.", Tx(a4) @ E),
                    ("Both a and α of the last link are left over: a is missing here.", Rx(alpha4) @ E),
                    ("The twist of the last link has the wrong sign here.", Tx(a4) @ Rx(-alpha4) @ E),
                    ("The last link is taken back here; it should be added to the tool.", np.linalg.inv(X4) @ E),
                    ("θ and d stay in their row: d4 is no part of the tool.", Tz(given.w_d[2]) @ X4 @ E),
                    (
                        "This is link 3, which stands in row 4 of the modified table. Left over is link 4.",
                        link(W, 3) @ E,
                    ),
                ],
            ),
            Part(
                "classic_table",
                "Modified to classic",
                3,
                Table("classic"),
                section="sec-both-columns",
                arm=bare(V.to_classic()),
                traps=rows_not_moved(V, down=False),
                kinematics=False,
            ),
            poses(
                "base",
                "What is left over at the base",
                2,
                Z @ X0,
                "sec-both-base",
                W,
                [
                    ("This is what is left over, without the base that was there before.", X0),
                    ("This is the base alone; a_0 and α_0 have no place in the classic table.", Z),
                    ("The base comes first: what is left over stands behind what is there.", X0 @ Z),
                    ("Both a_0 and α_0 are left over: α_0 is missing here.", Z @ Tx(a0)),
                    ("Both a_0 and α_0 are left over: a_0 is missing here.", Z @ Rx(alpha0)),
                    ("The twist α_0 has the wrong sign here.", Z @ Tx(a0) @ Rx(-alpha0)),
                    ("The first link is taken back here; it should be added to the base.", Z @ np.linalg.inv(X0)),
                    ("θ and d stay in their row: d1 is no part of the base.", Z @ X0 @ Tz(given.v_d[0])),
                    (
                        "This is link 1, which stands in row 1 of the classic table. Left over is a_0 and α_0.",
                        Z @ Tx(V.joints[1].a) @ Rx(V.joints[1].alpha),
                    ),
                ],
            ),
            rearranged(
                "to_modified",
                "Any table, classic to modified",
                3,
                to_modified,
                TABLES,
                [
                    ("The columns a and α should move down one row; here they stay.", lambda r: to_modified(r, roll=0)),
                    ("The columns a and α move down, and here they move up.", lambda r: to_modified(r, roll=-1)),
                    (
                        "What falls off at the bottom goes to the tool: it does not come back at the top.",
                        lambda r: to_modified(r, top=r[-1][[3, 2]]),
                    ),
                    (
                        "The rows are right; their columns are asked for as alpha, a, theta, d.",
                        lambda r: to_modified(r)[:, [2, 3, 1, 0]],
                    ),
                    ("In each row alpha comes first, and then a.", lambda r: to_modified(r)[:, [1, 0, 2, 3]]),
                    (
                        "In each row theta comes first of the last two, and then d.",
                        lambda r: to_modified(r)[:, [0, 1, 3, 2]],
                    ),
                    (
                        "θ and d stay in their rows; only a and α move.",
                        lambda r: np.vstack([np.zeros(4), to_modified(r, roll=0)[:-1]]),
                    ),
                ],
            ),
            rearranged(
                "to_classic",
                "Any table, modified to classic",
                2,
                to_classic,
                MODIFIED_TABLES,
                [
                    ("The columns a and α should move up one row; here they stay.", lambda r: to_classic(r, roll=0)),
                    ("The columns a and α move up, and here they move down.", lambda r: to_classic(r, roll=1)),
                    (
                        "What falls off at the top goes to the base: it does not come back at the bottom.",
                        lambda r: to_classic(r, last=r[0][[1, 0]]),
                    ),
                    (
                        "The rows are right; their columns are asked for as theta, d, a, alpha.",
                        lambda r: to_classic(r)[:, [3, 2, 0, 1]],
                    ),
                    ("In each row a comes before alpha.", lambda r: to_classic(r)[:, [0, 1, 3, 2]]),
                    ("In each row theta comes before d.", lambda r: to_classic(r)[:, [1, 0, 2, 3]]),
                    (
                        "θ and d stay in their rows; only a and α move.",
                        lambda r: np.vstack([to_classic(r, roll=0)[1:], np.zeros(4)]),
                    ),
                ],
            ),
            poses(
                "between",
                "One frame 2 and the other",
                2,
                X2,
                "sec-both-frames",
                W,
                [
                    ("This is link 1: frames 1 of both conventions stand so to each other.", link(W, 1)),
                    ("This is link 3: frames 3 of both conventions stand so to each other.", link(W, 3)),
                    ("A turn about x is missing: frame 2 is turned by α_2, too.", Tx(a2)),
                    ("A slide along x is missing: the frames stand at both ends of the normal.", Rx(alpha2)),
                    ("The twist has the wrong sign here.", Tx(a2) @ Rx(-alpha2)),
                    (
                        "The joint does not stand between them: both frames 2 belong to link 2, and d2 leads to it.",
                        Tz(given.w_d[1]) @ X2,
                    ),
                ],
            ),
            choice(
                "stays",
                "What is the same",
                f"x_{m}",
                {
                    f"x_{m}": f"both x_{m} point along the common normal of axes {m} and {m + 1}.",
                    f"y_{m}": f"y_{m} is turned by α_{m}, as z_{m} is.",
                    f"z_{m}": f"z_{m} lies on axis {m + 1} in the classic convention, "
                    f"and on axis {m} in the modified one.",
                    f"O_{m}": f"O_{m} is at the far end of the normal in the classic convention, "
                    "at the near one in the other.",
                },
                "sec-both-frames",
            ),
            choice(
                "axis",
                "Whose axis",
                f"z_{m + 1}",
                {
                    f"z_{m - 1}": f"classic z_{m} lies on axis {m + 1}; modified z_{m - 1} lies on axis {m - 1}.",
                    f"z_{m}": f"classic z_{m} lies on axis {m + 1}; modified z_{m} lies on axis {m}.",
                    f"z_{m + 1}": f"both lie on axis {m + 1}: it is that of joint {m + 1}.",
                },
                "sec-both-frames",
            ),
            Part("T_classic", "Read as classic", 2, Numbers(pose(0, 4), at=at), section="sec-classic-product"),
            Part(
                "T_modified",
                "Read as modified",
                2,
                Numbers(pose(0, 4), at=at),
                section="sec-modified-product",
                arm=given.read_as("modified"),
            ),
            reasoned(
                "label_1",
                "By one known pose",
                given.measured_as,
                {
                    reading: f"the hand was measured where T_{reading} says."
                    if reading == given.measured_as
                    else f"look at p of your T_{reading}: it is not where the hand was measured."
                    for reading in ("classic", "modified")
                }
                | {
                    "cannot tell": "the two readings put the hand in different places, and one of them was measured.",
                },
                reasons_by_letter(given.reasons, NO_REASON | {"pose": ""}),
                "sec-both-tell-pose",
            ),
            reasoned(
                "label_2",
                "By the upper arm",
                {2: "classic", 3: "modified"}[given.upper_arm_row],
                UPPER_ARM_IN[given.upper_arm_row]
                | {
                    "cannot tell": "the link between axes 2 and 3 is known: in which row does it stand?",
                },
                reasons_by_letter(given.reasons, NO_REASON | {"parallel": ""}),
                "sec-both-tell-parallel",
            ),
            reasoned(
                "label_3",
                "Three equal rows",
                "cannot tell",
                {
                    "classic": "moved down by a row, would the columns look different?",
                    "modified": "moved up by a row, would the columns look different?",
                    "cannot tell": "all rows are equal: read either way it is the same arm, with another base or tool.",
                },
                reasons_by_letter(
                    given.reasons,
                    NO_REASON
                    | {"parallel": "the links of all rows lie between parallel axes: none stands out.", "equal": ""},
                ),
                "sec-both-tell-never",
            ),
        ],
    )


EXERCISE = exercise(DEFAULT)
