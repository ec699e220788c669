"""What the exercise on the way from axes to a table asks, and how it is marked."""

import numpy as np

from dhlib import Axis, Rx, Ry, Rz, Tx, Ty, Tz, place_frames
from dhlib.grading.asking import METRES, constant, number, reasoned
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Frames, Function, Numbers, Table
from dhlib.grading.retelling import altered

#: Pairs of lines as the page gives them: a point and a direction of the one, and of the other.
PAIRS = {
    1: [(30, -10, 50), (2, 2, 1), (90, 20, 90), (2, -1, 2)],
    2: [(0, 50, 0), (3, 0, 4), (100, 50, 0), (-6, 0, -8)],
    3: [(120, -30, 0), (0, 0, 5), (197.6, -18.2, 132), (12, 16, 15)],
    4: [(0, 0, 0), (2, -1, 2), (50, 20, -10), (4, -2, 4)],
}

#: The joint axes of K at its zero pose: points and directions, in millimetres; and where its last origin is.
K_AXES = [
    ((0, 0, 0), (0, 0, 1)),
    ((60, 0, 180), (0, 1, 0)),
    ((60, 40, 400), (0, -1, 0)),
    ((60, 25, 400), (0.6, 0, 0.8)),
    ((150, 55, 520), (0.96, 0, 0.28)),
]
K_END = (246, 55, 548)
K_JOINTS = np.deg2rad([40, -25, 60, 110, -70])

#: The joints of the file, as the page has them: type, xyz, rpy, axis.
quarter = np.pi / 2
URDF = [
    ("continuous", (0, 0, 0.3), (0, 0, 0), (0, 0, 1)),
    ("revolute", (0.1, 0.05, 0.2), (-quarter, 0, 0), (0, 0, 1)),
    ("revolute", (0, -0.4, 0.03), (0, 0, 0), (0, 0, -1)),
    ("prismatic", (0.05, 0, 0), (quarter, 0, quarter), (0, 0, 1)),
    ("revolute", (0, 0, 0.25), (0, 0, 0), (0, 0.6, 0.8)),
    ("fixed", (0, 0.072, 0.096), (-np.arctan2(3, 4), 0, 0), (1, 0, 0)),
]
#: What a nearly parallel pair does: how far aside the second axis stands, and the quarter turn of three digits.
ASIDE, SLOPPY = 0.2, 1.57


# Lines in space


def unit(vector):
    return np.asarray(vector, dtype=float) / np.linalg.norm(vector)


def feet(P, u, Q, v):
    """Both ends of the common normal of two skew lines."""
    u, v = unit(u), unit(v)
    s, t = np.linalg.lstsq(np.column_stack([u, -v]), np.subtract(Q, P), rcond=None)[0]
    return np.array([P + s * u, Q + t * v])


def foot_of(point, Q, v):
    """The point of a line that is nearest to a point."""
    return Q + (np.subtract(point, Q) @ unit(v)) * unit(v)


def link_between(P, u, Q, v):
    """a and α between two lines, with x from the first to the second, or along u × v where they meet."""
    u, v = unit(u), unit(v)
    first, second = feet(P, u, Q, v)
    x, a = second - first, np.linalg.norm(second - first)
    turn = np.cross(u, v)
    sign = 1.0 if a < 1e-9 or turn @ x >= 0 else -1.0
    return np.array([a, sign * np.arctan2(np.linalg.norm(turn), u @ v)])


def length_and_turn(value):
    """A length, and an angle by its cosine and sine: half a turn is the same either way."""
    a, alpha = value
    return np.array([a, np.cos(alpha), np.sin(alpha)])


def link_with(angle=None, length=None):
    """`link_between` with one of its two numbers found in another way."""

    def quantity(arm, P, u, Q, v):
        a, alpha = link_between(P, u, Q, v)
        return np.array([a if length is None else length(P, u, Q, v), alpha if angle is None else angle(u, v, alpha)])

    return quantity


def only_if_skew(P, u, Q, v):
    turn = np.cross(unit(u), unit(v))
    size = np.linalg.norm(turn)
    return 0.0 if size < 1e-9 else abs(np.subtract(Q, P) @ turn) / size


def lines_tried():
    """Pairs of lines for the function: skew ones, and each special case."""
    random = np.random.default_rng(12)
    calls = [tuple(tuple(map(float, line)) for line in pair) for pair in PAIRS.values()]
    for _ in range(4):
        calls.append(tuple(tuple(map(float, random.integers(-9, 10, 3) + 0.5)) for _ in range(4)))
    P, u = random.uniform(-100, 100, 3), random.uniform(-1, 1, 3)
    beside = np.cross(u, [1, 2, 3])
    calls += [(P, u, P + 3 * u + 40 * beside, v) for v in (2 * u, -u)]
    return calls


LINES = lines_tried()


def kind_of_pair(k, right, letters):
    """What two lines are to each other, and what shows it."""
    u, v = PAIRS[k][1], PAIRS[k][3]
    reasons = {
        "a": "u × v is another vector than zero: work it out.",
        "b": f"u · v is {np.dot(u, v):g}.",
        "c": "(Q - P) · (u × v) is not zero: the lines pass each other.",
        "d": "(Q - P) · (u × v) is zero.",
    }
    because = {
        "skew": "skew lines pass each other, and are not parallel: try (Q - P) · (u × v).",
        "intersecting": "lines that meet span one plane, and u × v is not zero there.",
        "parallel": "see whether u × v is zero, and in which sense each of the two directions points.",
        "antiparallel": "see whether u × v is zero, and in which sense each of the two directions points.",
    }
    says = {
        "skew": "they pass each other at a distance, each in a direction of its own.",
        "intersecting": "they lie in one plane and are not parallel, so they meet.",
        "parallel": "as directions they are the same; the size of each does not matter.",
        "antiparallel": "as lines they are parallel, and their senses are opposite.",
    }
    held = {letter: "" if letter in letters else reason for letter, reason in reasons.items()}
    return reasoned(f"pair_{k}", f"Pair {k}", right, because | {right: says[right]}, held, "sec-placing-two-axes")


# Arm K


def arm_of(axes, end, unit, name):
    """The arm with these axes, and with its last origin there; `end` is a pose whose z is the last axis."""
    return place_frames(axes, "classic", end=end, unit=unit, name=name).chain


def upright(origin, z):
    """A pose with this z; its x is as level as it can be."""
    z = unit(z)
    x = unit(np.cross([0, 1, 0] if abs(z[1]) < 0.9 else [0, 0, 1], z))
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = x, np.cross(z, x), z, origin
    return matrix


K_LINES = [Axis(point, direction) for point, direction in K_AXES]
K_HAND = upright(K_END, K_AXES[-1][1])
K = arm_of(K_LINES, K_HAND, "mm", "K")
K_MODIFIED = K.to_modified()


def moved_by_axes(arm, q, reverse=False, senses=(1,) * 5):
    """The hand of K, by turns about its axes in space: the witness that knows no table."""
    turns = [turn_about(*line, s * angle) for line, angle, s in zip(K_AXES, q, senses, strict=True)]
    return np.linalg.multi_dot([*(turns[::-1] if reverse else turns), K_HAND])


def turn_about(point, direction, angle):
    u = unit(direction)
    skew = np.cross(np.eye(3), u)
    matrix = np.eye(4)
    matrix[:3, :3] = np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * skew @ skew
    matrix[:3, 3] = point - matrix[:3, :3] @ np.array(point, dtype=float)
    return matrix


def as_parallel(i):
    """The table of somebody whose converter takes antiparallel axes for parallel ones; the twist is in row i."""
    says = "The axes 2 and 3 are parallel as lines, but they point in opposite senses: their twist is half a turn."
    return [Trap(says, lambda arm: altered(arm, i, alpha=0.0))]


# The file


def walk(rpy=lambda r, p, y: Rz(y) @ Ry(p) @ Rx(r), turned=True, senses=True, last=True):
    """Lines (point, direction) of the moving joints of the file, and the pose of its last link."""
    at, lines = np.eye(4), []
    for kind, xyz, angles, axis in URDF if last else URDF[:-1]:
        at = at @ Tx(xyz[0]) @ Ty(xyz[1]) @ Tz(xyz[2]) @ rpy(*angles)
        if kind != "fixed":
            seen = np.array(axis) if senses else np.abs(axis)
            lines.append([*at[:3, 3], *(at[:3, :3] @ seen if turned else seen)])
    return np.array(lines), at


def unwalked():
    """The lines with origins as they stand in the file, and right directions."""
    return np.array([[*xyz, *row[3:]] for (_, xyz, *_), row in zip(URDF, walk()[0], strict=False)])


def turned_about_own(roll, pitch, yaw):
    return Rx(roll) @ Ry(pitch) @ Rz(yaw)


def as_lines(rows):
    """What lines stand for: the direction and, for an axis that turns, the moment, the same at every point of it."""
    meant = []
    for row, (kind, *_) in zip(rows, URDF, strict=False):
        u = row[3:] / (np.linalg.norm(row[3:]) or 1.0)
        meant.append([*u, *(np.zeros(3) if kind == "prismatic" else np.cross(row[:3], u))])
    return np.array(meant)


RIGHT_LINES, U_END = walk()
U_LINES = [
    Axis(row[:3], row[3:], "P" if kind == "prismatic" else "R")
    for row, (kind, *_) in zip(RIGHT_LINES, URDF, strict=False)
]
U = arm_of(U_LINES, U_END, "m", "U")
U_MODIFIED = U.to_modified()

EXERCISE = Exercise(
    name="axes_to_table",
    title="From axes to a table",
    arm=K,
    parts=[
        kind_of_pair(1, "intersecting", "c"),
        kind_of_pair(2, "antiparallel", "abc"),
        kind_of_pair(3, "skew", "d"),
        kind_of_pair(4, "parallel", "ac"),
        Part(
            "normal",
            "Both ends of the normal",
            2,
            Numbers(constant(feet(*PAIRS[3])), shape=(2, 3), at=(), tolerance=0.1, each="end"),
            section="sec-placing-two-axes",
            traps=[
                Trap(
                    "These are the two points that were given; the normal meets the lines elsewhere.",
                    constant([PAIRS[3][0], PAIRS[3][2]]),
                ),
                Trap("The two ends are exchanged: first that on the first line.", constant(feet(*PAIRS[3])[::-1])),
                Trap(
                    "This is upright on one of the two lines only: the normal is upright on both.",
                    constant([PAIRS[3][0], foot_of(PAIRS[3][0], *PAIRS[3][2:])]),
                ),
                Trap(
                    "This is upright on one of the two lines only: the normal is upright on both.",
                    constant([foot_of(PAIRS[3][2], *PAIRS[3][:2]), PAIRS[3][2]]),
                ),
            ],
        ),
        Part(
            "skew",
            "The link between them",
            2,
            Numbers(constant(link_between(*PAIRS[3])), shape=(2,), at=(), tolerance=1e-3),
            section="sec-placing-two-axes",
            traps=[
                Trap(
                    "An angle from arccos is never negative: about x, which leads from the first line to the second, "
                    "which way does u turn into v?",
                    constant(link_between(*PAIRS[3]) * [1, -1]),
                    "sign",
                ),
                Trap(
                    "α is in degrees; radians are asked for.",
                    constant(link_between(*PAIRS[3]) * [1, 180 / np.pi]),
                    "degrees",
                ),
                Trap("First a, and then alpha.", constant(link_between(*PAIRS[3])[::-1])),
                Trap(
                    "This a is the distance of the two points; the lines come closer to each other.",
                    constant([np.linalg.norm(np.subtract(PAIRS[3][2], PAIRS[3][0])), link_between(*PAIRS[3])[1]]),
                ),
                Trap(
                    "With x from the first line to the second a is positive.",
                    constant(-link_between(*PAIRS[3])),
                    "sign",
                ),
            ],
        ),
        Part(
            "link_of",
            "Any two lines, as a function",
            3,
            Function(
                lambda arm, P, u, Q, v: link_between(P, u, Q, v),
                shape=(2,),
                calls=LINES,
                signature="link_of(P, u, Q, v)",
                means=length_and_turn,
            ),
            section="sec-placing-trap-cross",
            kinematics=False,
            traps=[
                Trap(
                    "An angle from arccos is never negative; α has the sign of the turn about x.",
                    link_with(angle=lambda u, v, alpha: abs(alpha)),
                ),
                Trap(
                    "α has the wrong sign: by the right-hand rule about x it turns u into v.",
                    link_with(angle=lambda u, v, alpha: -alpha),
                    "sign",
                ),
                Trap(
                    "The sine alone cannot tell an angle from 180° less it: antiparallel axes come out as parallel. "
                    "Take arctan2 of sine and cosine.",
                    link_with(angle=lambda u, v, alpha: np.arcsin(np.sin(alpha))),
                ),
                Trap(
                    "Antiparallel axes are taken for parallel ones: their senses are opposite, so α is half a turn.",
                    link_with(angle=lambda u, v, alpha: 0.0 if abs(np.sin(alpha)) < 1e-9 else alpha),
                ),
                Trap(
                    "a is the distance of the two points; the lines come closer to each other.",
                    link_with(length=lambda P, u, Q, v: np.linalg.norm(np.subtract(Q, P))),
                ),
                Trap(
                    "For parallel lines u × v is zero and says nothing: their distance takes another formula.",
                    link_with(length=only_if_skew),
                ),
                Trap(
                    "u and v may have any length: make unit vectors of them first.",
                    lambda arm, P, u, Q, v: np.array(
                        [
                            abs(np.subtract(Q, P) @ np.cross(u, v)) or link_between(P, u, Q, v)[0],
                            link_between(P, u, Q, v)[1],
                        ]
                    ),
                ),
                Trap(
                    "a and alpha are exchanged: first a, and then alpha.",
                    lambda arm, P, u, Q, v: link_between(P, u, Q, v)[::-1],
                ),
                Trap(
                    "α is in degrees; radians are asked for.",
                    link_with(angle=lambda u, v, alpha: np.rad2deg(alpha)),
                    "degrees",
                ),
            ],
        ),
        Part(
            "frames",
            "Place the frames",
            3,
            Frames("classic", count=6),
            section="sec-placing-algorithm",
            kinematics=False,
        ),
        Part(
            "table",
            "The classic table",
            4,
            Table("classic"),
            "sec-placing-step-table",
            traps=as_parallel(2),
            kinematics=False,
        ),
        Part(
            "modified_table",
            "The modified table",
            3,
            Table("modified"),
            "sec-modified-construction",
            arm=K_MODIFIED,
            traps=as_parallel(3),
            kinematics=False,
        ),
        Part(
            "T5",
            "The hand, by axes or by table",
            2,
            Numbers(moved_by_axes, at=K_JOINTS),
            section="sec-placing-step-product",
            traps=[
                Trap(
                    "The turns stand in reverse order: that of axis 1 acts last, and stands first.",
                    lambda arm, q: moved_by_axes(arm, q, reverse=True),
                    "reverse",
                ),
                Trap(
                    "Joint 3 turns the wrong way: its axis points to the right.",
                    lambda arm, q: moved_by_axes(arm, q, senses=(1, 1, -1, 1, 1)),
                    "sense",
                ),
                Trap(
                    "cos and sin take radians: 40° is np.deg2rad(40).",
                    lambda arm, q: moved_by_axes(arm, np.rad2deg(q)),
                    "degrees",
                ),
                Trap(
                    "All joints turn the wrong way: positive is by the right-hand rule about the axis.",
                    lambda arm, q: moved_by_axes(arm, -np.asarray(q)),
                    "sense",
                ),
                Trap("This is the hand at the zero pose.", constant(K_HAND)),
                Trap(
                    "The turns carry the hand: the pose of the hand at zero belongs behind them.",
                    lambda arm, q: moved_by_axes(arm, q) @ np.linalg.inv(K_HAND),
                ),
            ],
            kinematics=False,
        ),
        reasoned(
            "converter",
            "A converter and its sine",
            "all behind axis 3",
            {
                "the sense of joint 3": "its axis is turned over, but all that hangs on it is turned with it.",
                "the zero of joint 3": "no zero can mend it: compare axis 4 in both, at the zero pose.",
                "all behind axis 3": "axis 3 points the other way, and the rows after it are read from there.",
            },
            {
                "a": "",
                "b": "the cosine of 0 is 1 and that of half a turn is -1.",
                "c": "",
                "d": "a_2 is the distance of two lines, whatever their senses are.",
            },
            "sec-placing-trap-sense",
            points=2,
        ),
        reasoned(
            "physical",
            "What two people must agree on",
            "some",
            {
                "all": "a normal of parallel axes may stand anywhere, and an x axis may point either way.",
                "some": "what lies between one axis and the next is the arm; where zero is and where a normal of "
                "parallel axes stands is choice.",
                "none": "the distance between two axes is in the metal, whoever draws the frames.",
            },
            {
                "a": "",
                "b": "axes 2 and 3 are parallel: their normal may stand anywhere, and d_2 and d_3 share one sum.",
                "c": "",
                "d": "an x axis that is turned round moves two zeros by half a turn.",
                "e": "",
            },
            "sec-placing-physical",
            points=2,
        ),
        Part(
            "lines",
            "The axes of the file",
            3,
            Numbers(constant(RIGHT_LINES), shape=(5, 6), at=(), means=as_lines, each="line"),
            section="sec-data-sheet-axes",
            kinematics=False,
            traps=[
                Trap(
                    "The directions are as they stand in the file, where each is seen from its joint's own frame.",
                    constant(walk(turned=False)[0]),
                ),
                Trap(
                    "The three angles of rpy are multiplied in reverse order: it is yaw, pitch, roll, from the left.",
                    constant(walk(rpy=turned_about_own)[0]),
                ),
                Trap("One axis of the file has a minus sign, which is missing here.", constant(walk(senses=False)[0])),
                Trap(
                    "The origins are as they stand in the file: each is seen from the frame before, so multiply.",
                    constant(unwalked()),
                ),
                Trap(
                    "The angles of rpy are in radians already.",
                    constant(
                        walk(rpy=lambda *a: Rz(np.deg2rad(a[2])) @ Ry(np.deg2rad(a[1])) @ Rx(np.deg2rad(a[0])))[0]
                    ),
                    "degrees",
                ),
            ],
        ),
        Part(
            "end",
            "The tool at zero",
            2,
            Numbers(constant(U_END), at=(), **METRES),
            section="sec-data-sheet-axes",
            kinematics=False,
            traps=[
                Trap(
                    "The last joint is fixed and moves nothing, but its origin counts.", constant(walk(last=False)[1])
                ),
                Trap(
                    "The three angles of rpy are multiplied in reverse order: it is yaw, pitch, roll, from the left.",
                    constant(walk(rpy=turned_about_own)[1]),
                ),
                Trap(
                    "The turns of the origins are missing: each has xyz and rpy.",
                    constant(walk(rpy=lambda *angles: np.eye(4))[1]),
                ),
            ],
        ),
        Part(
            "urdf_table",
            "The classic table of the file",
            4,
            Table("classic"),
            "sec-data-sheet-table",
            U,
            as_parallel(2),
            kinematics=False,
        ),
        Part(
            "urdf_modified",
            "The modified table of the file",
            3,
            Table("modified"),
            "sec-both-columns",
            U_MODIFIED,
            as_parallel(3),
            kinematics=False,
        ),
        number(
            "far",
            "A quarter turn with three digits",
            ASIDE * np.tan(SLOPPY),
            "sec-placing-nearly-parallel",
            [
                (0.0, "There one would draw it for parallel axes; these are not, so it has one place only."),
                (ASIDE, "This is how far apart the axes are at the floor. Where is axis 2 straight beside axis 1?"),
                (ASIDE / np.tan(SLOPPY), "The depth is the distance divided by the small slope, not multiplied."),
                (ASIDE * np.tan(np.deg2rad(SLOPPY)), "1.57 is in radians.", "degrees"),
                (1000 * ASIDE * np.tan(SLOPPY), "It is asked for in metres.", "unit"),
                (-ASIDE * np.tan(SLOPPY), "The depth is asked for as a positive number."),
            ],
            points=2,
            tolerance=0.1,
        ),
    ],
)
