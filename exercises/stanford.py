"""What the exercise on the Stanford arm asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, robots
from dhlib.grading.asking import EXACT, joint_values, last_pose, link_function, pose, slide_converted
from dhlib.grading.course.sources import lengths, number, row
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, Table
from dhlib.grading.pictures import described, same_for_all
from dhlib.grading.retelling import altered

STANFORD = robots.stanford("classic")
KINDS = STANFORD.kinds


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in m, angles in degrees."""

    d1: float = STANFORD.joints[0].d
    d2: float = STANFORD.joints[1].d
    d6: float = STANFORD.joints[5].d
    #: Joint values, of which the third is a slide.
    values: tuple[float, ...] = (30, 60, 0.5, 40, -50, 70)

    @property
    def arm(self):
        first, second, *rest, last = STANFORD.joints
        joints = [first.replace(d=self.d1), second.replace(d=self.d2), *rest, last.replace(d=self.d6)]
        return Chain(joints, "classic", name=STANFORD.name)


DEFAULT = Given()


def draw(lots):
    """Another arm of this kind: no length and no angle is that of the book."""
    sizes = lots.some("angles", range(21, 77, 5), 5)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, 1, 1, -1, 1), (-1, 1, 1, -1, 1), (1, -1, -1, 1, 1), (-1, 1, -1, 1, -1)])
    first, second, *wrist = (sign * size for sign, size in zip(signs, sizes, strict=True))
    return Given(
        d1=lots.one("d1", [0.364, 0.376, 0.388, 0.4, 0.424, 0.436, 0.448]),
        d2=lots.one("d2", [0.127, 0.133, 0.139, 0.145, 0.163, 0.169, 0.175]),
        d6=lots.one("d6", [0.217, 0.224, 0.231, 0.238, 0.245, 0.252]),
        values=(first, second, lots.one("slide", [0.43, 0.44, 0.46, 0.47, 0.53, 0.54, 0.56]), *wrist),
    )


def cells(given):
    """The given cells of the notebook."""
    first, second, slide, *wrist = given.values
    return {
        "arm": lengths("metres", d1=given.d1, d2=given.d2, d6=given.d6),
        "joints": f"""\
# The joint vector: angles in radians, the slide in metres
q = np.deg2rad({row((first, second, 0, *wrist))})
q[2] = {number(slide)}""",
    }


@same_for_all
def figure():
    """The arm that the page describes, with its boom pushed out, so that its axes are apart."""
    return described(
        STANFORD,
        "The arm with its boom pushed out, all angles zero, not to scale: its joint axes, and the base frame {0}",
        "Axis 1 rises from the origin of frame 0. At the height d1 axis 2 points to the left; d2 leads along it to the "
        "boom. The boom slides upwards along axis 3, with which axes 4 and 6 coincide. Axis 5 points forward through "
        "the wrist centre, and the hand is d6 above it.",
        q=(0, 0, 0.45, 0, 0, 0),
        lengths={"d_1": "d1", "d_2": "d2", "d_6": "d6"},
    )


SYMBOLS = ["theta1", "theta2", "d3", "theta4", "theta5", "theta6"]
QUARTERS = joint_values(KINDS, [90, 90, 0.5, 90, -90, 180])
STEP = 0.1


def pushed(arm, q):
    """How the hand moves when joint 3 goes on by a step."""
    further = [*q[:2], q[2] + STEP, *q[3:]]
    return arm.T(0, 6, further)[:3, 3] - arm.T(0, 6, q)[:3, 3]


def fixed_angle(i, j):
    """What becomes of frame j in frame i without the fixed angle of the slide, or with its other sign."""
    x = "x_2 points forward and x_3 to the right"
    return [
        Trap(f"The fixed angle θ3 is missing: {x}.", lambda arm, q: altered(arm, 3, theta=0.0).T(i, j, q), "offset"),
        Trap(
            f"The fixed angle θ3 has the wrong sign: {x}.",
            lambda arm, q: altered(arm, 3, theta=np.pi / 2).T(i, j, q),
            "offset",
        ),
    ]


def wrist(given, d2_sign=1, cosine_for_sine=False, with_foot=True):
    """The wrist centre with something done differently."""

    def p(arm, q):
        c1, s1, c2, s2 = np.cos(q[0]), np.sin(q[0]), np.cos(q[1]), np.sin(q[1])
        out, up = (c2, s2) if cosine_for_sine else (s2, c2)
        aside, foot = d2_sign * given.d2, with_foot * given.d1
        return [q[2] * c1 * out - aside * s1, q[2] * s1 * out + aside * c1, q[2] * up + foot]

    return p


def exercise(given):
    """The exercise with these numbers."""
    arm, at = given.arm, joint_values(KINDS, given.values)
    return Exercise(
        name="stanford",
        title="The Stanford arm",
        arm=arm,
        parts=[
            Part(
                "frames",
                "Place the frames",
                3,
                Frames("classic", count=7, length_tolerance=1e-3),
                section="sec-prismatic-stanford",
            ),
            Part("table", "The classic table", 4, Table("classic"), section="sec-prismatic-row"),
            Part("modified_table", "The modified table", 3, Table("modified"), section="sec-both-columns"),
            Part(
                "axis",
                "Along which axis it slides",
                1,
                Choice(
                    {
                        "z_2 in both": "in the modified convention the slide comes last in a row, along the new z."
                        " Here that is z_3.",
                        "z_3 in both": "in the classic convention the slide comes first in a row, along the old z."
                        " Here that is z_2.",
                        "classic z_2, modified z_3": "a classic row begins with the turn and the slide, and a "
                        "modified row ends with them.",
                        "classic z_3, modified z_2": "it is the other way round: see where the slide stands among "
                        "the four steps.",
                    },
                    right="classic z_2, modified z_3",
                ),
                section="sec-prismatic-row",
            ),
            Part(
                "A3",
                "The slide, classic",
                1,
                Formula(pose(2, 3), symbols=SYMBOLS, **EXACT),
                section="sec-prismatic-row",
                traps=fixed_angle(2, 3),
                kinematics=False,
            ),
            Part(
                "A3_modified",
                "The slide, modified",
                1,
                Formula(pose(2, 3), symbols=SYMBOLS, **EXACT),
                section="sec-prismatic-row",
                arm=arm.to_modified(),
                kinematics=False,
            ),
            Part(
                "link",
                "Any link, as a function",
                2,
                link_function(6, seed=3),
                section="sec-prismatic-row",
                kinematics=False,
            ),
            Part(
                "T03",
                "The boom, in symbols",
                2,
                Formula(pose(0, 3), symbols=SYMBOLS, **EXACT),
                traps=fixed_angle(0, 3),
                section="sec-prismatic-stanford",
                kinematics=False,
            ),
            Part(
                "wrist",
                "The wrist centre",
                2,
                Formula(lambda arm, q: arm.T(0, 3, q)[:3, 3], shape=(3,), symbols=SYMBOLS, tolerance=1e-5),
                section="sec-prismatic-stanford-check",
                follows=Follows(["T03"], lambda T03: T03[:3, 3]),
                traps=[
                    Trap(
                        "d2 stands on the wrong side: at θ1 = 0 the boom is to the left of axis 1, at +y.",
                        wrist(given, -1),
                    ),
                    Trap(
                        "Sine and cosine of θ2 are exchanged: at θ2 = 0 the boom points up.",
                        wrist(given, cosine_for_sine=True),
                    ),
                    Trap("The height of the shoulder above the floor is missing.", wrist(given, with_foot=False)),
                    Trap("The boom is aside of axis 1 by d2, which is missing.", wrist(given, 0)),
                ],
                kinematics=False,
            ),
            *last_pose(
                6,
                at,
                QUARTERS,
                "sec-prismatic-stanford",
                traps=[slide_converted(6, 3), *fixed_angle(0, 6)],
            ),
            Part(
                "push",
                "What the slide does",
                2,
                Numbers(pushed, shape=(3,), at=at, tolerance=1e-3),
                section="sec-prismatic-row",
                traps=[
                    Trap(
                        "This is the axis of the slide, a vector of length 1; the hand moves by 0.1 m along it.",
                        lambda arm, q: arm.T(0, 2, q)[:3, 2],
                    ),
                    Trap(
                        "The slide pushes along the boom, z_2. This is along the axis of the hand, z_5.",
                        lambda arm, q: STEP * arm.T(0, 5, q)[:3, 2],
                    ),
                    Trap(
                        "This goes straight up. Joint 2 has tilted the boom, and the slide pushes along it.",
                        lambda arm, q: [0, 0, STEP],
                    ),
                    Trap(
                        "The line is right, but this goes backwards along it: the boom moves out.",
                        lambda arm, q: -STEP * arm.T(0, 2, q)[:3, 2],
                    ),
                    Trap(
                        "This is where the wrist is, a place; asked for is the way from one place to the next.",
                        lambda arm, q: arm.T(0, 3, q)[:3, 3],
                    ),
                    Trap(
                        "This is where the hand is after the step; how far did it move?",
                        lambda arm, q: arm.T(0, 6, [*q[:2], q[2] + STEP, *q[3:]])[:3, 3],
                    ),
                ],
                kinematics=False,
            ),
            Part(
                "shoulder",
                "The shoulder on the other side",
                1,
                Choice(
                    {
                        "the same arm": "joint 2 counts the other way, joints 1 and 4 from half a turn further.",
                        "the mirror image": "it is that, but this arm is its own mirror image: there is a turn that "
                        "makes the one into the other.",
                        "another arm": "try it: turn joint 1 by half a turn, and let joint 2 count the other way.",
                    },
                    right="the same arm",
                ),
                section="sec-prismatic-mirror",
            ),
            Part(
                "place",
                "The place of the slide",
                1,
                Choice(
                    {
                        "another arm": "all points of the boom move along parallel lines, and none of these is "
                        "marked in the metal.",
                        "the same arm, another table": "only the direction of a sliding axis is physical; "
                        "the wrist behind it stands where it stood.",
                        "the same arm, the same table": "its normals with axes 2 and 4 change, and with them a and d.",
                    },
                    right="the same arm, another table",
                ),
                section="sec-prismatic-direction",
            ),
        ],
    )


EXERCISE = exercise(DEFAULT)
