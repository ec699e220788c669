"""What the exercise on the PA10-6C asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, robots
from dhlib.grading.asking import EXACT, choice, holding, last_pose, link_function, pose, which_holds, which_lengths
from dhlib.grading.course.sources import lengths, lettered, row
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Formula, Frames, Table
from dhlib.grading.pictures import described, same_for_all

#: Rows of the table that hold a length.
ARM = robots.pa10_6c("classic", lengths="A")
SETS = ("A", "B", "B2")
#: Angles at which somebody may have calibrated an arm.
CALIBRATED = ([15, 25, 30], [25, 30, 40, 45], [50, 55, 65, 70], [0], [-55, -50, -40, -35], [0])
#: Why the 6C stands as the 7C does with S3 at 0.
REASONS = {
    "S3 at 0 turns nothing, so what it joins is one rigid piece": (True, "that piece is the upper arm of the 6C."),
    "Rx(90°) Tz(l1) Rx(-90°), between S2 and E1, is a slide and no turn": (True, "it is Ty(-l1): up the upper arm."),
    "the axes of S2 and E1 are parallel then, and l1 apart": (True, "so are axes 2 and 3 of the 6C."),
    "row 3 of the 7C is the identity then": (False, "at q3 = 0 it still holds the upper arm and a twist."),
    "both have the same table": (False, "the 6C has a length a and two offsets; no row of the 7C has."),
    "the axes of S2 and E1 are one line then": (False, "the upper arm is between them."),
    "the 7C has no upper arm then": (False, "S3 rolls the upper arm; at 0 it is as long as ever."),
}


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in m, angles in degrees."""

    b: float = 0.317
    l1: float = 0.450
    l2: float = 0.480
    f: float = 0.070
    angles: tuple[float, ...] = (30, 40, 70, -50, 60, 20)
    #: Where the arm of the question about lengths stood, and the set that it has, which the page does not say.
    calibrated: tuple[float, ...] = (20, 35, 60, 0, -45, 0)
    its_set: str = "B"
    #: Of which length and in which table the place is asked for.
    length: str = "l1"
    convention: str = "classic"
    reasons: tuple[str, ...] = (
        "row 3 of the 7C is the identity then",
        "S3 at 0 turns nothing, so what it joins is one rigid piece",
        "both have the same table",
    )
    #: From axis 5 to the tool plate of another arm, in mm.
    ruler: float = 70.6

    @property
    def arm(self):
        joints = list(ARM.joints)
        for i, change in ((1, {"d": self.b}), (2, {"a": self.l1}), (4, {"d": self.l2}), (6, {"d": self.f})):
            joints[i - 1] = joints[i - 1].replace(**change)
        return Chain(joints, "classic", name=ARM.name)

    def found(self, lengths=""):
        """Where the flange is with one of the sets of lengths, by default that of the question."""
        arm = robots.pa10_6c("classic", lengths=lengths or self.its_set)
        return arm.fk(np.deg2rad(self.calibrated))[:3, 3]


DEFAULT = Given()


#: Parts with one answer for everybody: no length of the arm stands in this link.
SAME_FOR_ALL = ("A3",)


def draw(lots):
    """Another arm of this kind: no length and no angle is that of the book."""
    sizes = lots.some("angles", range(21, 82, 5), 6)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, 1, 1, -1, 1, 1), (-1, 1, 1, 1, 1, -1), (1, 1, 1, -1, -1, 1), (-1, 1, 1, 1, -1, 1)])
    length, convention = lots.one("length", [("l1", "modified"), ("l2", "classic"), ("l2", "modified")])
    return Given(
        b=lots.one("b", [0.281, 0.29, 0.299, 0.308, 0.326, 0.335, 0.344]),
        l1=lots.one("l1", [0.415, 0.422, 0.429, 0.436, 0.464, 0.471]),
        l2=lots.one("l2", [0.446, 0.454, 0.462, 0.488, 0.496, 0.504]),
        f=lots.one("f", [0.056, 0.061, 0.066, 0.076, 0.081, 0.086]),
        angles=tuple(sign * size for sign, size in zip(signs, sizes, strict=True)),
        calibrated=tuple(lots.one(f"calibrated {i}", options) for i, options in enumerate(CALIBRATED, 1)),
        its_set=lots.one("set", SETS),
        length=length,
        convention=convention,
        reasons=lots.one_right("reasons", holding(REASONS), holding(REASONS, False)),
        ruler=lots.one("ruler", [69.5, 70.7, 79.4, 80.7, 84.4, 85.6]),
    )


def cells(given):
    """The given cells of the notebook."""
    return {
        "arm": lengths("metres", b=given.b, l1=given.l1, l2=given.l2, f=given.f),
        "angles": f"q = np.deg2rad({row(given.angles)})",
        "calibration": f"""\
q_calibrated = np.deg2rad({row(given.calibrated)})
p_calibrated = np.array({row(given.found(), decimals=4)})  # metres""",
        "place": f'length, convention = "{given.length}", "{given.convention}"',
        "reasons": lettered("reasons", given.reasons),
        "ruler": f"ruler = {given.ruler}  # millimetres",
    }


@same_for_all
def figure():
    """The arm that the page describes."""
    return described(
        Given(f=0.16).arm,
        "The arm at its zero pose, not to scale: its joint axes, and the base frame {0}",
        "The arm stands straight up from the origin of frame 0. Axes 1, 4 and 6 are one vertical line. Axes 2, 3 and 5 "
        "cross it and point to the left: in the shoulder, b above the foot, in the elbow, l1 above that, and in the "
        "wrist, l2 above that. The flange is f above the wrist.",
        lengths={"d_1": "b", "a_2": "l1", "d_4": "l2", "d_6": "f"},
    )


SYMBOLS = [f"theta{i}" for i in range(1, 7)]
QUARTERS = np.deg2rad([90, 90, -90, 90, 90, 180])


def wrist(given, lean, bend, with_foot=True):
    """The wrist centre, with the upper arm leaning by one angle and the forearm by another."""

    def p(arm, q):
        up, fore = lean(q), bend(q)
        b, l1, l2 = with_foot * given.b, given.l1, given.l2
        out = l1 * np.sin(up) + l2 * np.sin(fore)
        return [out * np.cos(q[0]), out * np.sin(q[0]), b + l1 * np.cos(up) + l2 * np.cos(fore)]

    return p


def place(length, convention):
    """The part that asks where a length stands."""
    row, way = {"l1": ({"classic": 2, "modified": 3}[convention], "a"), "l2": (4, "d")}[length]
    because = {}
    for i in (2, 3, 4):
        link = f"link {i}, behind joint {i}" if convention == "classic" else f"link {i - 1}, before joint {i}"
        because[f"a in row {i}"] = (
            f"row {i} of a {convention} table holds the a of {link}: which axes does {length} lie between?"
        )
        because[f"d in row {i}"] = f"d_{i} is measured along axis {i}. In which direction does {length} run?"
    because[f"{way} in row {row}"] = {
        "l1": "axes 2 and 3 are parallel here, and the upper arm is the distance between them.",
        "l2": "the forearm runs along axis 4, from the elbow to the wrist.",
    }[length]
    return choice("upper_arm", "Where a length went", f"{way} in row {row}", because, "sec-pa10-6c")


def plate(ruler):
    """The part that asks which set a ruler speaks for."""
    flanges = {each: 1000 * robots.pa10_6c(lengths=each).joints[5].d for each in SETS}
    right = min(SETS, key=lambda each: abs(flanges[each] - ruler))
    because = {
        each: f"its {f:.0f} mm are nearest to {ruler} mm."
        if each == right
        else f"its {f:.0f} mm are {abs(f - ruler):.1f} mm off; one of the sets is nearer."
        for each, f in flanges.items()
    }
    return choice("plate", "What a ruler says", right, because, "sec-pa10-lengths")


def struck_out(given):
    """T6 by the table of the 7C with row 3 left out."""
    first, second, _, elbow, fore, wrist, last = robots.pa10_7c(lengths="A").joints
    rows = [first.replace(d=given.b), second, elbow, fore.replace(d=given.l2), wrist, last.replace(d=given.f)]
    says = "This is the table of the 7C with a row struck out, and the upper arm went with it."
    return Trap(says, lambda arm, q: Chain(rows, "classic").fk(q))


def exercise(given):
    """The exercise with these numbers."""
    arm, at = given.arm, np.deg2rad(given.angles)
    return Exercise(
        name="pa10_6c",
        title="The PA10-6C",
        arm=arm,
        parts=[
            Part(
                "frames",
                "Place the frames",
                3,
                Frames("classic", count=7, length_tolerance=1e-3),
                section="sec-pa10-6c",
            ),
            Part("table", "The classic table", 4, Table("classic", free=()), section="sec-pa10-6c"),
            Part("modified_table", "The modified table", 3, Table("modified", free=()), section="sec-both-columns"),
            *(
                Part(
                    f"A{i}",
                    f"A{i} in symbols",
                    1,
                    Formula(pose(i - 1, i), symbols=SYMBOLS, **EXACT),
                    section="sec-pa10-6c",
                    kinematics=False,
                )
                for i in (2, 3)
            ),
            Part(
                "link",
                "Any link, as a function",
                2,
                link_function(6, seed=7),
                section="sec-pa10-6c",
                kinematics=False,
            ),
            Part(
                "wrist",
                "The wrist centre",
                2,
                Formula(lambda arm, q: arm.T(0, 5, q)[:3, 3], shape=(3,), symbols=SYMBOLS, tolerance=1e-5),
                section="sec-pa10-6c",
                traps=[
                    Trap(
                        "At the zero pose the arm is upright; this one lies forward: sine and cosine are exchanged.",
                        wrist(given, lambda q: np.pi / 2 - q[1], lambda q: np.pi / 2 - q[1] - q[2]),
                    ),
                    Trap(
                        "The forearm leans by the angles of shoulder and elbow together: axes 2 and 3 are parallel.",
                        wrist(given, lambda q: q[1], lambda q: q[2]),
                    ),
                    Trap(
                        "The two angles add: both axes point to the left, and both joints lean the arm forward.",
                        wrist(given, lambda q: q[1], lambda q: q[1] - q[2]),
                    ),
                    Trap(
                        "The shoulder stands above the foot; that height is missing.",
                        wrist(given, lambda q: q[1], lambda q: q[1] + q[2], with_foot=False),
                    ),
                ],
                kinematics=False,
            ),
            *last_pose(6, at, QUARTERS, "sec-pa10-6c", traps=[struck_out(given)]),
            place(given.length, given.convention),
            which_holds("why", "Why the 6C is the 7C at q3 = 0", given.reasons, REASONS, "sec-pa10-6c"),
            which_lengths(given.found, SETS, given.its_set, "sec-pa10-lengths"),
            plate(given.ruler),
        ],
    )


EXERCISE = exercise(DEFAULT)
