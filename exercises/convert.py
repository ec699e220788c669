"""What the exercise on converting between the conventions asks, and how it is marked."""

import numpy as np

from dhlib import Chain, Rx, Rz, Tx, Tz
from dhlib.grading.asking import choice, constant, pose, reasoned
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Function, Numbers, Table

quarter = np.pi / 2
#: Tables as the page gives them, in millimetres: theta, d, a, alpha of W; alpha, a, theta, d of V.
W = Chain.from_table(
    [
        ["q1", 120, 50, -quarter],
        ["q2", 30, 200, quarter],
        [quarter, "q3", 40, -quarter],
        ["q4", 80, 60, quarter],
    ],
    convention="classic",
    tool=Tz(90) @ Rz(np.pi / 4),
    unit="mm",
)
V = Chain.from_table(
    [
        [quarter, 45, "q1", 130],
        [-quarter, 25, "q2", 60],
        [np.pi / 3, 180, "q3", -35],
        [quarter, 70, "q4", 95],
    ],
    convention="modified",
    base=Tx(200) @ Tz(300) @ Rz(quarter),
    unit="mm",
)
#: A table without a heading, in millimetres and degrees.
UNKNOWN = [[0, 150, 30, 90], [0, 40, 0, -90], [0, 25, 120, 90], [0, 70, 50, -90]]
JOINTS = np.deg2rad([20, -40, 65, 110])

#: Five rows of any table, for functions that rearrange them.
random = np.random.default_rng(8)
TABLES = [np.round(random.uniform(-3, 3, (5, 4)) * [1, 100, 100, 1], 2) for _ in range(4)]
MODIFIED_TABLES = [table[:, [3, 2, 0, 1]] for table in TABLES]


def read_as(convention):
    return Chain.from_table(UNKNOWN, "theta d a alpha", "RRRR", convention, degrees=True, unit="mm")


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


def poses(part, title, points, right, section, wrong):
    """A pose that is given by the task, and what else is handed in for it."""
    traps = [Trap(says, constant(value)) for says, value in wrong]
    asks = Numbers(constant(right), at=())
    return Part(part, title, points, asks, section=section, arm=bare(W), traps=traps)


def rearranged(part, title, points, rule, calls, traps):
    asks = Function(lambda _, rows: rule(rows), shape=(5, 4), calls=[(c,) for c in calls], signature=f"{part}(rows)")
    traps = [Trap(says, lambda _, rows, wrong=wrong: wrong(rows)) for says, wrong in traps]
    return Part(part, title, points, asks, section="sec-both-columns", traps=traps, kinematics=False)


X2, X4, X0 = link(W, 2), link(W, 4), Tx(V.joints[0].a) @ Rx(V.joints[0].alpha)
E, Z = W.tool, V.base

EXERCISE = Exercise(
    name="convert",
    title="From one convention to the other",
    arm=read_as("classic"),
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
            [
                ("This is what is left over, without the gripper that was there before.", X4),
                ("This is the gripper alone; the last link of the classic table is not in the modified one.", E),
                ("The last link comes before the gripper: what is left over stands in front of what is there.", E @ X4),
                ("Both a and α of the last link are left over: α is missing here.", Tx(60) @ E),
                ("Both a and α of the last link are left over: a is missing here.", Rx(quarter) @ E),
                ("The twist of the last link has the wrong sign here.", Tx(60) @ Rx(-quarter) @ E),
                ("The last link is taken back here; it should be added to the tool.", np.linalg.inv(X4) @ E),
                ("θ and d stay in their row: d4 is no part of the tool.", Tz(80) @ X4 @ E),
                ("This is link 3, which stands in row 4 of the modified table. Left over is link 4.", link(W, 3) @ E),
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
            [
                ("This is what is left over, without the base that was there before.", X0),
                ("This is the base alone; a_0 and α_0 have no place in the classic table.", Z),
                ("The base comes first: what is left over stands behind what is there.", X0 @ Z),
                ("Both a_0 and α_0 are left over: α_0 is missing here.", Z @ Tx(45)),
                ("Both a_0 and α_0 are left over: a_0 is missing here.", Z @ Rx(quarter)),
                ("The twist α_0 has the wrong sign here.", Z @ Tx(45) @ Rx(-quarter)),
                ("The first link is taken back here; it should be added to the base.", Z @ np.linalg.inv(X0)),
                ("θ and d stay in their row: d1 is no part of the base.", Z @ X0 @ Tz(130)),
                (
                    "This is link 1, which stands in row 1 of the classic table. Left over is a_0 and α_0.",
                    Z @ Tx(25) @ Rx(-quarter),
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
            [
                ("This is link 1: frames 1 of both conventions stand so to each other.", link(W, 1)),
                ("This is link 3: frames 3 of both conventions stand so to each other.", link(W, 3)),
                ("A turn about x is missing: frame 2 is turned by α_2, too.", Tx(200)),
                ("A slide along x is missing: the frames stand at both ends of the normal.", Rx(quarter)),
                ("The twist has the wrong sign here.", Tx(200) @ Rx(-quarter)),
                (
                    "The joint does not stand between them: both frames 2 belong to link 2, and d2 leads to it.",
                    Tz(30) @ X2,
                ),
            ],
        ),
        choice(
            "stays",
            "What is the same",
            "x_2",
            {
                "x_2": "both x_2 point along the common normal of axes 2 and 3.",
                "y_2": "y_2 is turned by α_2, as z_2 is.",
                "z_2": "z_2 lies on axis 3 in the classic convention, and on axis 2 in the modified one.",
                "O_2": "O_2 is at the far end of the normal in the classic convention, at the near one in the other.",
            },
            "sec-both-frames",
        ),
        choice(
            "axis",
            "Whose axis",
            "z_3",
            {
                "z_1": "classic z_2 lies on axis 3; modified z_1 lies on axis 1.",
                "z_2": "classic z_2 lies on axis 3; modified z_2 lies on axis 2.",
                "z_3": "both lie on axis 3: it is that of joint 3.",
            },
            "sec-both-frames",
        ),
        Part("T_classic", "Read as classic", 2, Numbers(pose(0, 4), at=JOINTS), section="sec-classic-product"),
        Part(
            "T_modified",
            "Read as modified",
            2,
            Numbers(pose(0, 4), at=JOINTS),
            section="sec-modified-product",
            arm=read_as("modified"),
        ),
        reasoned(
            "label_1",
            "By one known pose",
            "modified",
            {
                "classic": "look at p of your T_classic: it is not where the hand was measured.",
                "modified": "the hand was measured where T_modified says.",
                "cannot tell": "the two readings put the hand in different places, and one of them was measured.",
            },
            {
                "a": "",
                "b": "nothing is said of parallel axes here.",
                "c": "these rows differ from each other.",
                "d": "columns can be printed in any order: that proves nothing.",
            },
            "sec-both-tell-pose",
        ),
        reasoned(
            "label_2",
            "By the upper arm",
            "classic",
            {
                "classic": "the link between axes 2 and 3 is link 2, and it stands in row 2.",
                "modified": "in a modified table row 2 holds the link between axes 1 and 2, and they are not parallel.",
                "cannot tell": "the link between axes 2 and 3 is known: in which row does it stand?",
            },
            {
                "a": "no pose of this arm is known.",
                "b": "",
                "c": "these rows differ from each other.",
                "d": "columns can be printed in any order: that proves nothing.",
            },
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
            {
                "a": "no pose of this arm is known.",
                "b": "the links of all rows lie between parallel axes: none of them stands out.",
                "c": "",
                "d": "columns can be printed in any order: that proves nothing.",
            },
            "sec-both-tell-never",
        ),
    ],
)
