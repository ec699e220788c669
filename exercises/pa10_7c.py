"""What the exercise on the PA10-7C asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, robots
from dhlib.grading.asking import (
    EXACT,
    choice,
    constant,
    holding,
    last_pose,
    link_function,
    measured_at,
    pose,
    which_holds,
    which_lengths,
)
from dhlib.grading.course.sources import lengths, lettered, matrix, row
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Formula, Frames, Numbers, Table
from dhlib.grading.pictures import described, same_for_all

#: Rows of the table that hold a length.
ARM = robots.pa10_7c("classic", lengths="A")
SETS = ("A", "B", "B2")
#: Angles at which somebody may have calibrated an arm, and angles at which it holds the hand of the elbow circle.
CALIBRATED = ([15, 25, 30], [25, 30, 40, 45], [-45, -35, -30], [50, 55, 65, 70], [5, 15, 20], [-55, -50, -40, -35], [0])
HIDDEN = (
    [16, 22, 34, 41],
    [31, 36, 44, 47],
    [23, 28, 34, 37],
    [64, 68, 72, 83],
    [-27, -24, -16],
    [43, 46, 54, 57],
    [14, 17],
)
#: The last joint that moves something, and why.
WATCHED = {
    "the direction of the upper arm": (2, "S3 runs along the upper arm and only rolls it."),
    "the position of the elbow": (2, "S3 runs along the upper arm, and the elbow lies on its axis."),
    "the direction of the forearm": (4, "E2 runs along the forearm and only rolls it."),
    "the position of the wrist": (4, "E2 runs along the forearm, and the wrist lies on its axis."),
    "the direction of the last axis": (6, "W2 turns about this axis, and so it stays."),
    "the position of the flange": (6, "the middle of the flange lies on the axis of W2."),
}
#: What happens when the elbow goes round and the hand stays.
CLAIMS = {
    "all joints but E1 turn": (True, "E1 sets the distance from shoulder to wrist, and that stays."),
    "E1 keeps its angle": (True, "it sets the distance from shoulder to wrist, and that stays."),
    "the angle between upper arm and forearm stays": (True, "three sides of fixed length make one triangle."),
    "the elbow turns about the line from shoulder to wrist": (True, "both ends of that line are held fast."),
    "S3 alone turns": (False, "turning S3 alone moves the forearm, and the hand with it."),
    "all joints turn": (False, "one keeps its angle: it sets the distance from shoulder to wrist."),
    "E1 alone turns": (False, "bending the elbow changes the distance from shoulder to wrist."),
    "the wrist moves with the elbow": (False, "the wrist lies f behind the flange, and the flange is held fast."),
    "the joints behind the elbow keep their angles": (False, "the forearm turns; the hand would turn with it."),
}


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in m, angles in degrees."""

    b: float = 0.317
    l1: float = 0.450
    l2: float = 0.480
    f: float = 0.070
    angles: tuple[float, ...] = (30, 40, -50, 70, 20, 60, -80)
    #: The pose whose elbows are asked for comes from these joints; the page does not say so.
    hidden: tuple[float, ...] = (25, 40, 30, 75, -20, 50, 10)
    #: Where the arm of the question about lengths stood, and the set that it has, which the page does not say.
    calibrated: tuple[float, ...] = (20, 35, -40, 60, 10, -45, 0)
    its_set: str = "B2"
    #: Of what it is asked which joint angles it depends on.
    watched: str = "the direction of the upper arm"
    claims: tuple[str, ...] = ("S3 alone turns", "all joints turn", "all joints but E1 turn")

    @property
    def arm(self):
        joints = list(ARM.joints)
        for i, change in ((1, {"d": self.b}), (3, {"d": self.l1}), (5, {"d": self.l2}), (7, {"d": self.f})):
            joints[i - 1] = joints[i - 1].replace(**change)
        return Chain(joints, "classic", name=ARM.name)

    @property
    def hand(self):
        """The pose whose elbows are asked for."""
        return measured_at(self.arm, np.deg2rad(self.hidden))

    @property
    def shoulder(self):
        """Where the shoulder is."""
        return np.array([0, 0, self.b])

    def found(self, lengths=""):
        """Where the flange is with one of the sets of lengths, by default that of the question."""
        arm = robots.pa10_7c("classic", lengths=lengths or self.its_set)
        return arm.fk(np.deg2rad(self.calibrated))[:3, 3]


DEFAULT = Given()


def draw(lots):
    """Another arm of this kind: no length and no angle is that of the book."""
    sizes = lots.some("angles", range(21, 82, 5), 7)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, 1, -1, 1, 1, 1, -1), (-1, 1, 1, 1, -1, 1, 1), (1, -1, 1, 1, 1, -1, 1)])
    return Given(
        b=lots.one("b", [0.281, 0.29, 0.299, 0.308, 0.326, 0.335, 0.344]),
        l1=lots.one("l1", [0.415, 0.422, 0.429, 0.436, 0.464, 0.471]),
        l2=lots.one("l2", [0.446, 0.454, 0.462, 0.488, 0.496, 0.504]),
        f=lots.one("f", [0.056, 0.061, 0.066, 0.076, 0.081, 0.086]),
        angles=tuple(sign * size for sign, size in zip(signs, sizes, strict=True)),
        hidden=tuple(lots.one(f"hidden {i}", options) for i, options in enumerate(HIDDEN, 1)),
        calibrated=tuple(lots.one(f"calibrated {i}", options) for i, options in enumerate(CALIBRATED, 1)),
        its_set=lots.one("set", SETS),
        watched=lots.one("watched", list(WATCHED)[1:]),
        claims=lots.one_right("claims", holding(CLAIMS), holding(CLAIMS, False)),
    )


def cells(given):
    """The given cells of the notebook."""
    return {
        "arm": lengths("metres", b=given.b, l1=given.l1, l2=given.l2, f=given.f),
        "angles": f"q = np.deg2rad({row(given.angles)})",
        "measured": matrix("T_given", given.hand, decimals=(4, 4, 4, 5)),
        "calibration": f"""\
q_calibrated = np.deg2rad({row(given.calibrated)})
p_calibrated = np.array({row(given.found(), decimals=4)})  # metres""",
        "watched": f'watched = "{given.watched}"',
        "claims": lettered("claims", given.claims),
    }


@same_for_all
def figure():
    """The arm that the page describes."""
    return described(
        Given(f=0.16).arm,
        "The arm at its zero pose, not to scale: its joint axes, and the base frame {0}",
        "The arm stands straight up from the origin of frame 0. Axes 1, 3, 5 and 7 are one vertical line. Axes 2, 4 "
        "and 6 cross it and point to the left: in the shoulder, b above the foot, in the elbow, l1 above that, and in "
        "the wrist, l2 above that. The flange is f above the wrist.",
        lengths={"d_1": "b", "d_3": "l1", "d_5": "l2", "d_7": "f"},
    )


SYMBOLS = [f"theta{i}" for i in range(1, 8)]
QUARTERS = np.deg2rad([90, 90, 90, -90, 0, 90, 180])


def wrist(given, flange=1.0, column=2):
    """The wrist centre of the given pose: behind the flange, along a column of it."""
    return given.hand[:3, 3] - flange * given.f * given.hand[:3, column]


def circle(given, centre=None, shoulder=None, upper=0.0, fore=0.0):
    """Distance of the circle's plane from the shoulder, and the circle's radius."""
    shoulder = given.shoulder if shoulder is None else shoulder
    upper, fore = upper or given.l1, fore or given.l2
    distance = np.linalg.norm((wrist(given) if centre is None else centre) - shoulder)
    along = (distance**2 + upper**2 - fore**2) / (2 * distance)
    return along, np.sqrt(max(upper**2 - along**2, 0))


def highest(given, sign=1):
    """The highest elbow, or the lowest."""
    S = given.shoulder
    w = (wrist(given) - S) / np.linalg.norm(wrist(given) - S)
    up = np.array([0, 0, 1]) - w[2] * w
    along, radius = circle(given)
    return S + along * w + sign * radius * up / np.linalg.norm(up)


def counting(watched):
    """The part that asks which joint angles something depends on."""
    last, why = WATCHED[watched]
    because = {
        f"theta1 to theta{i}": why
        if i == last
        else f"joint {last} moves it too: what does that joint carry?"
        if i < last
        else f"what does joint {i} move? Is it the axis of that joint, or a point on it, or beyond?"
        for i in range(2, 8)
    }
    return choice("upper_arm", "Which angles count", f"theta1 to theta{last}", because, "sec-pa10-product")


def exercise(given):
    """The exercise with these numbers."""
    arm, at = given.arm, np.deg2rad(given.angles)
    return Exercise(
        name="pa10_7c",
        title="The PA10-7C",
        arm=arm,
        parts=[
            Part(
                "frames",
                "Place the frames",
                3,
                Frames("classic", count=8, length_tolerance=1e-3),
                section="sec-pa10-frames",
            ),
            Part("table", "The classic table", 4, Table("classic"), section="sec-pa10-frames"),
            Part("modified_table", "The modified table", 3, Table("modified"), section="sec-both-columns"),
            Part(
                "link",
                "Any link, as a function",
                2,
                link_function(7, seed=8, rounds=1),
                section="sec-pa10-product",
                kinematics=False,
            ),
            *last_pose(7, at, QUARTERS, "sec-pa10-product"),
            Part(
                "T04",
                "Shoulder and elbow, in symbols",
                2,
                Formula(pose(0, 4), symbols=SYMBOLS, **EXACT),
                section="sec-pa10-product",
                kinematics=False,
            ),
            counting(given.watched),
            Part(
                "W",
                "The wrist of a given hand",
                1,
                Numbers(constant(wrist(given)), shape=(3,), at=at, tolerance=1e-3),
                section="sec-pa10-redundancy",
                traps=[
                    Trap(
                        "The wrist lies behind the flange, against the approach vector a.", constant(wrist(given, -1.0))
                    ),
                    Trap(
                        "The way back is along a, the third column, and not along n.", constant(wrist(given, column=0))
                    ),
                    Trap(
                        "The way back is along a, the third column, and not along o.", constant(wrist(given, column=1))
                    ),
                    Trap(
                        "This is the position of the flange; the wrist lies f behind it.", constant(wrist(given, 0.0))
                    ),
                ],
            ),
            Part(
                "radius",
                "The elbow circle",
                2,
                Numbers(constant(circle(given)[1]), shape=(), at=at, tolerance=1e-3),
                section="sec-pa10-redundancy",
                traps=[
                    Trap("This is how far the plane of the circle is from the shoulder.", constant(circle(given)[0])),
                    Trap("This is the diameter; the radius is asked for.", constant(2 * circle(given)[1])),
                    Trap(
                        "This is how far the plane of the circle is from the wrist.",
                        constant(circle(given, upper=given.l2, fore=given.l1)[0]),
                    ),
                    Trap(
                        "The triangle stands on the shoulder, which is b above the foot.",
                        constant(circle(given, shoulder=np.zeros(3))[1]),
                    ),
                    Trap(
                        "The triangle ends at the wrist, and not at the flange.",
                        constant(circle(given, centre=given.hand[:3, 3])[1]),
                    ),
                ],
            ),
            Part(
                "E",
                "The highest elbow",
                2,
                Numbers(constant(highest(given)), shape=(3,), at=at, tolerance=1e-3),
                section="sec-pa10-redundancy",
                traps=[
                    Trap("This is the lowest elbow on the circle.", constant(highest(given, -1))),
                    Trap(
                        "This is the centre of the circle; the elbow is one radius away from it.",
                        constant(highest(given, 0)),
                    ),
                    Trap(
                        "The circle is found from the shoulder: its height b is missing.",
                        constant(highest(given) - given.shoulder),
                    ),
                ],
            ),
            which_holds("redundant", "What is left over", given.claims, CLAIMS, "sec-pa10-redundancy"),
            which_lengths(given.found, SETS, given.its_set, "sec-pa10-lengths"),
        ],
    )


EXERCISE = exercise(DEFAULT)
