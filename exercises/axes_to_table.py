"""What the exercise on the way from axes to a table asks, and how it is marked."""

from dataclasses import dataclass
from functools import cache
from itertools import permutations

import numpy as np

from dhlib import Axis, Rx, Ry, Rz, place_frames
from dhlib.grading.asking import METRES, constant, holding, number, reasoned
from dhlib.grading.course.sources import lettered, matrix, row
from dhlib.grading.course.sources import number as number_as_source
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Frames, Function, Numbers, Table
from dhlib.grading.pictures import add_axis
from dhlib.grading.retelling import altered
from dhlib.scene import Scene

#: What leads from one axis to the next, and is not measured by every right placing; and what is.
PLACED = {
    "the size of a_1": "",
    "d_2": "axes 2 and 3 are parallel: their normal may stand anywhere, and d_2 and d_3 share one sum.",
    "the size of d_4": "",
    "the offset between q_3 and theta_3": "an x axis that is turned round moves two zeros by half a turn.",
    "the size of a_4": "",
}
#: Statements about a converter that takes antiparallel axes for parallel ones, and what to say where they are false.
CLAIMS = {
    "the size of u x v is the same for parallel and for antiparallel axes": (True, ""),
    "with alpha_2 = 0 the offset d_3 leads to the other side": (True, ""),
    "with alpha_2 = 0 axis 3 points the other way": (True, ""),
    "the sign of u . v tells parallel from antiparallel axes": (True, ""),
    "the size of u . v tells parallel from antiparallel axes": (
        False,
        "the cosine of 0 is 1 and that of half a turn is −1: their sizes are equal.",
    ),
    "with alpha_2 = 0 the length a_2 comes out wrong, too": (
        False,
        "a_2 is the distance of two lines, whatever their senses are.",
    ),
    "with alpha_2 = 0 axis 2 points the other way": (False, "α_2 stands behind axis 2, and turns what comes after it."),
    "with another sign of q_3 the table would be right": (
        False,
        "the rows behind axis 3 are read from a z that points the other way, whatever q_3 is.",
    ),
}


@dataclass(frozen=True)
class Given:
    """The numbers of the task: of K in mm and degrees, of the file in m."""

    #: Pairs of lines: a point and a direction of the one, and of the other. The third is skew.
    pairs: tuple[tuple[tuple[float, ...], ...], ...] = (
        ((30, -10, 50), (2, 2, 1), (90, 20, 90), (2, -1, 2)),
        ((0, 50, 0), (3, 0, 4), (100, 50, 0), (-6, 0, -8)),
        ((120, -30, 0), (0, 0, 5), (197.6, -18.2, 132), (12, 16, 15)),
        ((0, 0, 0), (2, -1, 2), (50, 20, -10), (4, -2, 4)),
    )
    #: The joint axes of K at its zero pose, and where its last origin is.
    axes: tuple[tuple[tuple[float, ...], ...], ...] = (
        ((0, 0, 0), (0, 0, 1)),
        ((60, 0, 180), (0, 1, 0)),
        ((60, 40, 400), (0, -1, 0)),
        ((60, 25, 400), (0.6, 0, 0.8)),
        ((150, 55, 520), (0.96, 0, 0.28)),
    )
    hand_at: tuple[float, ...] = (246, 55, 548)
    joints: tuple[float, ...] = (40, -25, 60, 110, -70)
    #: In which order five numbers of a table are asked for.
    order: tuple[str, ...] = tuple(PLACED)
    #: Four statements about a converter that takes antiparallel axes for parallel ones.
    claims: tuple[str, ...] = (
        "the size of u x v is the same for parallel and for antiparallel axes",
        "the size of u . v tells parallel from antiparallel axes",
        "with alpha_2 = 0 the offset d_3 leads to the other side",
        "with alpha_2 = 0 the length a_2 comes out wrong, too",
    )
    #: The origins of the file, and how the last axis is tilted: its sine and its cosine.
    column: float = 0.3
    lift: tuple[float, ...] = (0.1, 0.05, 0.2)
    elbow: tuple[float, ...] = (-0.4, 0.03)
    ahead: float = 0.05
    reach: float = 0.25
    tilt: tuple[float, ...] = (0.6, 0.8)
    tool: float = 0.12
    #: Where the second axis of a nearly parallel pair stands.
    stands: tuple[float, ...] = (0.2, 0.1)

    @property
    def K(self):
        return arm_of([Axis(point, direction) for point, direction in self.axes], self.hand, "mm", "K")

    @property
    def hand(self):
        """The last frame of K at its zero pose."""
        return upright(self.hand_at, self.axes[-1][1])

    @property
    def file(self):
        """The joints of the file: type, xyz, rpy, axis."""
        sine, cosine = self.tilt
        return [
            ("continuous", (0, 0, self.column), (0, 0, 0), (0, 0, 1)),
            ("revolute", self.lift, (-quarter, 0, 0), (0, 0, 1)),
            ("revolute", (0, *self.elbow), (0, 0, 0), (0, 0, -1)),
            ("prismatic", (self.ahead, 0, 0), (quarter, 0, quarter), (0, 0, 1)),
            ("revolute", (0, 0, self.reach), (0, 0, 0), (0, sine, cosine)),
            ("fixed", (0, self.tool * sine, self.tool * cosine), (-np.arctan2(sine, cosine), 0, 0), (1, 0, 0)),
        ]

    @property
    def U(self):
        """The arm of the file."""
        lines, end = walk(self)
        axes = [
            Axis(line[:3], line[3:], "P" if kind == "prismatic" else "R")
            for line, kind in zip(lines, KINDS, strict=True)
        ]
        return arm_of(axes, end, "m", "U")


DEFAULT = Given()
quarter = np.pi / 2
#: What the joints of the file that move are.
KINDS = ("continuous", "revolute", "revolute", "prismatic", "revolute")
#: A quarter turn of three digits.
SLOPPY = 1.57

#: Directions of two lines that are neither parallel nor at right angles, each of length 3.
CROSSING = [
    ((2, 1, 2), (1, -2, 2)),
    ((1, 2, 2), (2, 2, 1)),
    ((2, 1, -2), (1, 2, 2)),
    ((-1, 2, 2), (2, 2, -1)),
    ((2, -2, 1), (1, -2, 2)),
    ((2, -1, -2), (-1, 2, -2)),
]
ALONG = [(4, 0, 3), (2, 1, -2), (1, 2, 2), (2, -2, 1), (0, 3, -4), (-1, 2, 2)]
#: Sine and cosine of angles that have few digits.
SLOPES = [(0.6, 0.8), (0.8, 0.6), (0.28, 0.96), (0.96, 0.28)]


def moved(point, *ways):
    """A point, moved along some directions by so much each."""
    total = np.array(point, dtype=float) + sum(far * np.asarray(way, dtype=float) for far, way in ways)
    return tuple(map(float, np.round(total, 6) + 0.0))


def draw_pairs(lots):
    """Four pairs of lines: the third is skew, and the others are of one kind each, in any order."""
    meets = tuple(lots.one(f"meets {x}", range(24, 78, 6)) for x in "xyz")
    u, v = lots.one("crossing", CROSSING)
    s, t = lots.some("meets at", [-25, -20, -15, 15, 20, 25], 2)
    drawn = [(moved(meets, (s, u)), u, moved(meets, (t, v)), v)]
    for along, factors in zip(lots.some("along", ALONG, 2), ([2, 3], [-2, -3]), strict=True):
        name = f"beside {factors[0]}"
        start = tuple(lots.one(f"{name} {x}", [-20, -10, 10, 20, 30, 40]) for x in "xyz")
        beside = lots.one(name, [(70, 40, 20), (20, 80, 30), (40, 20, 90), (50, 30, 110)])
        drawn.append(
            (start, along, moved(start, (1, beside)), moved((0, 0, 0), (lots.one(f"{name} k", factors), along)))
        )
    # The skew pair: one line is upright, and both ends of the normal are on one level.
    c, s = lots.one("level", [(-0.6, 0.8), (0.8, 0.6), (0.8, -0.6), (-0.8, 0.6), (0.6, -0.8)])
    across, up = lots.one("steep", [(20, 15), (15, 20), (20, -15), (15, -20)])
    direction = moved((0, 0, 0), (across, (c, s, 0)), (up, (0, 0, 1)))
    level, below = lots.one("height", range(70, 130, 10)), lots.one("below", [15, 25, 35, 45])
    foot = (lots.one("x", range(102, 150, 6)), -lots.one("y", range(104, 150, 6)), level)
    far, on = lots.one("far", range(35, 80, 10)), lots.one("on", [2, 3, 4])
    other = moved(foot, (far, (s, -c, 0)), (on, direction))
    first, *rest = lots.shuffled("kinds", drawn)
    return (
        first,
        rest[0],
        ((*foot[:2], level - below), (0, 0, lots.one("size", [2, 3, 4])), other, direction),
        rest[1],
    )


#: Parts with one answer for everybody: a function for any two lines, called with many.
SAME_FOR_ALL = ("link_of",)


def draw(lots):
    """Other lines, another K, another file and another order: no length and no angle is that of the book."""
    ahead, height = lots.one("ahead", range(42, 90, 4)), lots.one("K height", range(152, 212, 8))
    elbow = height + lots.one("upper arm", range(192, 264, 6))
    (s4, c4), (s5, c5) = lots.some("slopes", SLOPES, 2)
    fourth = (ahead, lots.one("aside", range(16, 34, 2)), elbow)
    fifth = moved(
        fourth, (lots.one("along", [100, 125, 175, 200]), (s4, 0, c4)), (lots.one("off", [24, 28, 32, 36]), (0, 1, 0))
    )
    sizes = lots.some("angles", range(21, 82, 5), 5)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, -1, 1, 1, -1), (-1, 1, 1, -1, 1), (1, 1, -1, -1, 1), (-1, -1, 1, 1, 1)])
    return Given(
        pairs=draw_pairs(lots),
        axes=(
            ((0, 0, 0), (0, 0, 1)),
            ((ahead, 0, height), (0, 1, 0)),
            ((ahead, lots.one("out", range(36, 60, 3)), elbow), (0, -1, 0)),
            (fourth, (s4, 0, c4)),
            (fifth, (s5, 0, c5)),
        ),
        hand_at=moved(fifth, (lots.one("hand", [75, 125, 150]), (s5, 0, c5))),
        joints=tuple(sign * size for sign, size in zip(signs, sizes, strict=True)),
        order=tuple(lots.one("order", list(permutations(PLACED))[1:])),
        claims=tuple(
            lots.shuffled(
                "claims",
                [*lots.some("true claims", holding(CLAIMS), 2), *lots.some("false claims", holding(CLAIMS, False), 2)],
            )
        ),
        column=lots.one("column", [0.24, 0.26, 0.28, 0.32, 0.34, 0.36]),
        lift=(
            lots.one("lift x", [0.07, 0.08, 0.09, 0.11, 0.12, 0.13]),
            lots.one("lift y", [0.03, 0.04, 0.06, 0.07]),
            lots.one("lift z", [0.16, 0.18, 0.22, 0.24]),
        ),
        elbow=(
            -lots.one("file upper arm", [0.36, 0.38, 0.42, 0.44, 0.46]),
            lots.one("file out", [0.02, 0.05, 0.08]),
        ),
        ahead=lots.one("file ahead", [0.04, 0.06, 0.07, 0.09]),
        reach=lots.one("reach", [0.22, 0.23, 0.27, 0.28, 0.31]),
        tilt=lots.one("tilt", SLOPES[1:]),
        tool=lots.one("tool", [0.1, 0.15, 0.175, 0.2]),
        stands=(lots.one("stands x", [0.15, 0.18, 0.22, 0.24, 0.26]), lots.one("stands y", [0.12, 0.14, 0.16])),
    )


def figure(given):
    """The axes of K in the directions that the page has, but for their distances."""
    return outline(given.axes[3][1], given.axes[4][1])


@cache
def outline(fourth, fifth):
    """The axes of an arm like K, drawn once for all in which axes 4 and 5 slope like this."""
    first, second, third, (point, _), _ = DEFAULT.axes
    beyond = moved(point, (150, fourth), (30, (0, 1, 0)))
    size = 550
    scene = Scene(axis_length=0.2 * size)
    scene.add_frame(np.eye(4), "0")
    for i, (at, along) in enumerate((first, second, third, (point, fourth), (beyond, fifth)), 1):
        add_axis(scene, at, along, f"axis {i}", 0.12 * size, 0.28 * size)
        scene.add_point(at)
    scene.add_point(moved(beyond, (100, fifth)), "O_5")
    return scene.sketch(
        "The joint axes of K at its zero pose, not to scale, the points that they are given by, O5, and the world",
        "Five lines with arrows, and the world frame at the foot of axis 1, which points up. Axis 2 points to the left "
        "and axis 3, above it, to the right. Axis 4 meets axis 3 and slopes upwards and forward. Axis 5 slopes "
        "forward too, and passes axis 4 at a distance. O5 lies on it.",
        view=(-60, 22),
    )


def words(values):
    """Numbers as a URDF has them."""
    return " ".join(number_as_source(value) for value in values)


def cells(given):
    """The given cells of the notebook."""
    pairs = [f"    {k}: np.array([{', '.join(row(part) for part in pair)}])," for k, pair in enumerate(given.pairs, 1)]
    axes = [f"    ({row(point)}, {row(direction)})," for point, direction in given.axes]
    asked = [f'    "{letter}": "{what}",' for letter, what in zip("abcde", given.order, strict=True)]
    (_, column, *_), (_, lift, *_), (_, elbow, *_), (_, reach, *_), (_, hand, _, tilted), (_, tool, *_) = given.file
    x, y = given.stands
    return {
        "pairs": "\n".join(["pairs = {", *pairs, "}"]),
        "axes": "\n".join(["axes = [", *axes, "]", f"O5 = {row(given.hand_at)}"]),
        "hand": f"{matrix('M', given.hand)}\nq = np.deg2rad({row(given.joints)})",
        "claims": lettered("claims", given.claims),
        "asked": "\n".join(["asked = {", *asked, "}"]),
        "file": f"""\
quarter, tilt = np.pi / 2, np.arctan2({number_as_source(given.tilt[0])}, {number_as_source(given.tilt[1])})
urdf = f\"""<robot name="U">
  <link name="base"/> <link name="column"/> <link name="upper"/> <link name="boom"/>
  <link name="slider"/> <link name="hand"/> <link name="tool"/>
  <joint name="turn" type="continuous">
    <parent link="base"/> <child link="column"/>
    <origin xyz="{words(column)}"/> <axis xyz="0 0 1"/>
  </joint>
  <joint name="lift" type="revolute">
    <parent link="column"/> <child link="upper"/>
    <origin xyz="{words(lift)}" rpy="{{-quarter}} 0 0"/> <axis xyz="0 0 1"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="upper"/> <child link="boom"/>
    <origin xyz="{words(elbow)}"/> <axis xyz="0 0 -1"/>
  </joint>
  <joint name="reach" type="prismatic">
    <parent link="boom"/> <child link="slider"/>
    <origin xyz="{words(reach)}" rpy="{{quarter}} 0 {{quarter}}"/> <axis xyz="0 0 1"/>
  </joint>
  <joint name="roll" type="revolute">
    <parent link="slider"/> <child link="hand"/>
    <origin xyz="{words(hand)}"/> <axis xyz="{words(tilted)}"/>
  </joint>
  <joint name="mount" type="fixed">
    <parent link="hand"/> <child link="tool"/>
    <origin xyz="{words(tool)}" rpy="{{-tilt}} 0 0"/>
  </joint>
</robot>\"""
print(urdf)""",
        "leaning": f"P2 = [{number_as_source(x)}, {number_as_source(y)}, 0]",
    }


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
    calls = [tuple(tuple(map(float, line)) for line in pair) for pair in DEFAULT.pairs]
    for _ in range(4):
        calls.append(tuple(tuple(map(float, random.integers(-9, 10, 3) + 0.5)) for _ in range(4)))
    P, u = random.uniform(-100, 100, 3), random.uniform(-1, 1, 3)
    beside = np.cross(u, [1, 2, 3])
    calls += [(P, u, P + 3 * u + 40 * beside, v) for v in (2 * u, -u)]
    return calls


LINES = lines_tried()


def standing(P, u, Q, v):
    """How two lines stand to each other."""
    turn = np.cross(unit(u), unit(v))
    if np.linalg.norm(turn) < 1e-9:
        return "antiparallel" if np.dot(u, v) < 0 else "parallel"
    return "intersecting" if np.isclose(np.subtract(Q, P) @ turn, 0) else "skew"


def kind_of_pair(k, P, u, Q, v):
    """What two lines are to each other, and what shows it."""
    turn = np.cross(u, v)
    flat, along = bool(np.isclose(np.subtract(Q, P) @ turn, 0)), not turn.any()
    facts = {"a": along, "b": np.dot(u, v) < 0, "c": flat, "d": not flat}
    right = standing(P, u, Q, v)
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
    held = {letter: "" if facts[letter] else reason for letter, reason in reasons.items()}
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


def moved_by_axes(given, q, reverse=False, senses=(1,) * 5):
    """The hand of K, by turns about its axes in space: the witness that knows no table."""
    turns = [turn_about(*line, s * angle) for line, angle, s in zip(given.axes, q, senses, strict=True)]
    return np.linalg.multi_dot([*(turns[::-1] if reverse else turns), given.hand])


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


def walk(given, rpy=lambda r, p, y: Rz(y) @ Ry(p) @ Rx(r), turned=True, senses=True, last=True):
    """Lines (point, direction) of the moving joints of the file, and the pose of its last link."""
    at, lines = np.eye(4), []
    for kind, xyz, angles, axis in given.file if last else given.file[:-1]:
        step = rpy(*angles)
        step[:3, 3] = xyz
        at = at @ step
        if kind != "fixed":
            seen = np.array(axis) if senses else np.abs(axis)
            lines.append([*at[:3, 3], *(at[:3, :3] @ seen if turned else seen)])
    return np.array(lines), at


def unwalked(given):
    """The lines with origins as they stand in the file, and right directions."""
    return np.array([[*xyz, *line[3:]] for (_, xyz, *_), line in zip(given.file, walk(given)[0], strict=False)])


def turned_about_own(roll, pitch, yaw):
    return Rx(roll) @ Ry(pitch) @ Rz(yaw)


def as_lines(rows):
    """What lines stand for: the direction and, for an axis that turns, the moment, the same at every point of it."""
    meant = []
    for line, kind in zip(rows, KINDS, strict=True):
        u = line[3:] / (np.linalg.norm(line[3:]) or 1.0)
        meant.append([*u, *(np.zeros(3) if kind == "prismatic" else np.cross(line[:3], u))])
    return np.array(meant)


def exercise(given):
    """The exercise with these numbers."""
    skew, K, U, (lines, end), (aside, _) = given.pairs[2], given.K, given.U, walk(given), given.stands
    return Exercise(
        name="axes_to_table",
        title="From axes to a table",
        arm=K,
        parts=[
            *(kind_of_pair(k, *pair) for k, pair in enumerate(given.pairs, 1)),
            Part(
                "normal",
                "Both ends of the normal",
                2,
                Numbers(constant(feet(*skew)), shape=(2, 3), at=(), tolerance=0.1, each="end"),
                section="sec-placing-two-axes",
                traps=[
                    Trap(
                        "These are the two points that were given; the normal meets the lines elsewhere.",
                        constant([skew[0], skew[2]]),
                    ),
                    Trap("The two ends are exchanged: first that on the first line.", constant(feet(*skew)[::-1])),
                    Trap(
                        "This is upright on one of the two lines only: the normal is upright on both.",
                        constant([skew[0], foot_of(skew[0], *skew[2:])]),
                    ),
                    Trap(
                        "This is upright on one of the two lines only: the normal is upright on both.",
                        constant([foot_of(skew[2], *skew[:2]), skew[2]]),
                    ),
                ],
            ),
            Part(
                "skew",
                "The link between them",
                2,
                Numbers(constant(link_between(*skew)), shape=(2,), at=(), tolerance=1e-3),
                section="sec-placing-two-axes",
                traps=[
                    Trap(
                        "An angle from arccos is never negative: about x, which leads from the first line to the "
                        "second, which way does u turn into v?",
                        constant(link_between(*skew) * [1, -1]),
                        "sign",
                    ),
                    Trap(
                        "α is in degrees; radians are asked for.",
                        constant(link_between(*skew) * [1, 180 / np.pi]),
                        "degrees",
                    ),
                    *(
                        Trap(
                            "This α is between the lines; u and v have senses, and one of them is reversed here.",
                            constant([link_between(*skew)[0], sign * (np.pi - abs(link_between(*skew)[1]))]),
                        )
                        for sign in (1, -1)
                    ),
                    Trap("First a, and then alpha.", constant(link_between(*skew)[::-1])),
                    Trap(
                        "This a is the distance of the two points; the lines come closer to each other.",
                        constant([np.linalg.norm(np.subtract(skew[2], skew[0])), link_between(*skew)[1]]),
                    ),
                    Trap(
                        "With x from the first line to the second a is positive.",
                        constant(-link_between(*skew)),
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
                    kinds=[f"{standing(*line)} lines" for line in LINES],
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
                        "The sine alone cannot tell an angle from 180° less it: antiparallel axes come out as "
                        "parallel. Take arctan2 of sine and cosine.",
                        link_with(angle=lambda u, v, alpha: np.arcsin(np.sin(alpha))),
                    ),
                    Trap(
                        "Antiparallel axes are taken for parallel ones: "
                        "their senses are opposite, so α is half a turn.",
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
                arm=K.to_modified(),
                traps=as_parallel(3),
                kinematics=False,
            ),
            Part(
                "T5",
                "The hand, by axes or by table",
                2,
                Numbers(lambda arm, q: moved_by_axes(given, q), at=np.deg2rad(given.joints)),
                section="sec-placing-step-product",
                traps=[
                    Trap(
                        "The turns stand in reverse order: that of axis 1 acts last, and stands first.",
                        lambda arm, q: moved_by_axes(given, q, reverse=True),
                        "reverse",
                    ),
                    Trap(
                        "Joint 3 turns the wrong way: its axis points to the right.",
                        lambda arm, q: moved_by_axes(given, q, senses=(1, 1, -1, 1, 1)),
                        "sense",
                    ),
                    Trap(
                        "cos and sin take radians: 40° is np.deg2rad(40).",
                        lambda arm, q: moved_by_axes(given, np.rad2deg(q)),
                        "degrees",
                    ),
                    Trap(
                        "All joints turn the wrong way: positive is by the right-hand rule about the axis.",
                        lambda arm, q: moved_by_axes(given, -np.asarray(q)),
                        "sense",
                    ),
                    Trap("This is the hand at the zero pose.", constant(given.hand)),
                    Trap(
                        "The turns carry the hand: the pose of the hand at zero belongs behind them.",
                        lambda arm, q: moved_by_axes(given, q) @ np.linalg.inv(given.hand),
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
                    letter: "" if CLAIMS[claim][0] else CLAIMS[claim][1]
                    for letter, claim in zip("abcd", given.claims, strict=True)
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
                {letter: PLACED[what] for letter, what in zip("abcde", given.order, strict=True)},
                "sec-placing-physical",
                points=2,
            ),
            Part(
                "lines",
                "The axes of the file",
                3,
                Numbers(constant(lines), shape=(5, 6), at=(), means=as_lines, each="line"),
                section="sec-data-sheet-axes",
                kinematics=False,
                traps=[
                    Trap(
                        "The directions are as they stand in the file, where each is seen from its joint's own frame.",
                        constant(walk(given, turned=False)[0]),
                    ),
                    Trap(
                        "The three angles of rpy are multiplied in reverse order: "
                        "it is yaw, pitch, roll, from the left.",
                        constant(walk(given, rpy=turned_about_own)[0]),
                    ),
                    Trap(
                        "One axis of the file has a minus sign, which is missing here.",
                        constant(walk(given, senses=False)[0]),
                    ),
                    Trap(
                        "The origins are as they stand in the file: each is seen from the frame before, so multiply.",
                        constant(unwalked(given)),
                    ),
                    Trap(
                        "The angles of rpy are in radians already.",
                        constant(
                            walk(
                                given, rpy=lambda *a: Rz(np.deg2rad(a[2])) @ Ry(np.deg2rad(a[1])) @ Rx(np.deg2rad(a[0]))
                            )[0]
                        ),
                        "degrees",
                    ),
                ],
            ),
            Part(
                "end",
                "The tool at zero",
                2,
                Numbers(constant(end), at=(), **METRES),
                section="sec-data-sheet-axes",
                kinematics=False,
                traps=[
                    Trap(
                        "The last joint is fixed and moves nothing, but its origin counts.",
                        constant(walk(given, last=False)[1]),
                    ),
                    Trap(
                        "The three angles of rpy are multiplied in reverse order: "
                        "it is yaw, pitch, roll, from the left.",
                        constant(walk(given, rpy=turned_about_own)[1]),
                    ),
                    Trap(
                        "The turns of the origins are missing: each has xyz and rpy.",
                        constant(walk(given, rpy=lambda *angles: np.eye(4))[1]),
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
                U.to_modified(),
                as_parallel(3),
                kinematics=False,
            ),
            number(
                "far",
                "A quarter turn with three digits",
                aside * np.tan(SLOPPY),
                "sec-placing-nearly-parallel",
                [
                    (0.0, "There one would draw it for parallel axes; these are not, so it has one place only."),
                    (aside, "This is how far apart the axes are at the floor. Where is axis 2 straight beside axis 1?"),
                    (aside / np.tan(SLOPPY), "The depth is the distance divided by the small slope, not multiplied."),
                    (aside * np.tan(np.deg2rad(SLOPPY)), "1.57 is in radians.", "degrees"),
                    (1000 * aside * np.tan(SLOPPY), "It is asked for in metres.", "unit"),
                    (-aside * np.tan(SLOPPY), "The depth is asked for as a positive number."),
                ],
                points=2,
                tolerance=0.1,
            ),
        ],
    )


EXERCISE = exercise(DEFAULT)
