"""What the exercise on planar arms asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, Revolute, Rz, Tx
from dhlib.grading.asking import choice, link_function, number
from dhlib.grading.course.sources import number as number_text
from dhlib.grading.course.sources import row
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Formula, Numbers, Table
from dhlib.grading.pictures import same_for_all
from dhlib.scene import Scene


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in mm, angles in degrees."""

    lengths: tuple[float, ...] = (260, 190, 110)
    angles: tuple[float, ...] = (35, -70, 50)
    #: Of a draughtsman's table.
    offsets: tuple[float, ...] = (40, -25, 60)

    def arm(self, n, convention="classic"):
        """The first n links; in the modified convention frame {n} stands on axis n, and the tool has the last one."""
        lengths = self.lengths[:n] if convention == "classic" else (0.0, *self.lengths[: n - 1])
        return Chain([Revolute(a=a) for a in lengths], convention, name=f"Planar {n}R", unit="mm")


DEFAULT = Given()


def draw(lots):
    """Other lengths, the longest first; angles without any pattern; offsets of which the middle one goes down."""
    sizes = lots.some("angles", range(21, 77, 5), 3)  # all different, so that no sum is zero
    signs = lots.one("signs", [(1, -1, 1), (-1, 1, -1), (1, 1, -1), (-1, -1, 1)])
    return Given(
        lengths=(
            lots.one("l1", range(225, 300, 20)),
            lots.one("l2", range(155, 215, 10)),
            lots.one("l3", range(85, 130, 15)),
        ),
        angles=tuple(sign * size for sign, size in zip(signs, sizes, strict=True)),
        offsets=(
            lots.one("d1", range(46, 70, 4)),
            -lots.one("d2", range(21, 40, 3)),
            lots.one("d3", range(71, 95, 4)),
        ),
    )


def cells(given):
    """The given cells of the notebook."""
    l1, l2, l3 = map(number_text, given.lengths)
    return {
        "lengths": f"l1, l2, l3 = {l1}, {l2}, {l3}  # millimetres",
        "angles": f"q = np.deg2rad({row(given.angles)})",
        "offsets": f"d = {row(given.offsets)}  # millimetres",
    }


@same_for_all
def figure():
    """The 3R arm from above, bent."""
    turns, lengths = np.deg2rad([35, 40, -60]), (1.3, 1.0, 0.6)
    scene = Scene(axis_length=0.5)
    scene.add_frame(np.eye(4), "0", axes="xy")
    place = np.eye(4)
    for i, (turn, length) in enumerate(zip(turns, lengths, strict=True), 1):
        scene.add_segment(place[:3, 3], place[:3, 3] + 0.62 * place[:3, 0], kind="guide", colour="muted")
        scene.add_arc(place[:3, 3], [0, 0, 1], place[:3, 0], turn, f"θ_{i}", 0.42, "z")
        onward = place @ Rz(turn) @ Tx(length)
        scene.add_segment(place[:3, 3], onward[:3, 3], f"l{i}", "body")
        place = onward
    for i, at in enumerate(np.cumsum([[0, 0], *steps(turns, lengths)], axis=0), 1):
        scene.add_point([*at, 0], "hand" if i > len(turns) else f"axis {i}")
    return scene.sketch(
        "The 3R arm from above, not to scale; 2R ends with its second link",
        "Seen from above, all axes upright: axis 1 stands in the origin of frame 0, from where the link l1 leads to "
        "axis 2, l2 to axis 3, and l3 to the hand. Each joint angle is measured anticlockwise from the direction of "
        "the link before, the first from x0; the third is drawn negative.",
        view=(-90, 90),
    )


def steps(turns, lengths):
    """From each joint to the next, in the plane."""
    for heading, length in zip(np.cumsum(turns), lengths, strict=True):
        yield length * np.cos(heading), length * np.sin(heading)


SYMBOLS = ["theta1", "theta2", "theta3"]


def last(chain, q):
    """The pose of the last frame in frame {0}."""
    return chain.T(0, chain.n, q)


#: A link that is turned by its own angle and by all before it.
SUMMED = [
    Trap(
        "Each link is seen from the one before: its matrix holds its own angle alone, and the product makes the sums.",
        lambda chain, q: last(chain, np.cumsum(q)),
    )
]


def one_of(part, title, section, right, **options):
    """One of several; keys with _ stand for words."""
    options = {key.replace("_", " "): says for key, says in options.items()}
    return choice(part, title, right, options, section)


def own_link(classic):
    """The lengths of a classic table, each left in its row."""
    return Trap(
        "Row i holds the length of link i, as in the classic convention. In the modified one it holds the link before "
        "joint i, and before joint 1 there is none.",
        lambda chain: Chain(classic.joints, chain.convention),
        "row",
    )


def exercise(given):
    """The exercise with these numbers."""
    l1, l2, l3 = given.lengths
    two, three = given.arm(2), given.arm(3)
    two_modified, three_modified = given.arm(2, "modified"), given.arm(3, "modified")
    angles, offsets = np.deg2rad(given.angles), given.offsets
    return Exercise(
        name="planar",
        title="Planar arms",
        arm=three,
        parts=[
            Part("table2", "2R: the classic table", 2, Table("classic"), section="sec-classic-parameters", arm=two),
            Part(
                "T2",
                "2R in numbers",
                1,
                Numbers(last, at=angles[:2]),
                section="sec-classic-product",
                arm=two,
                traps=SUMMED,
                kinematics=False,
            ),
            Part(
                "T2_sym",
                "2R in symbols",
                2,
                Formula(last, symbols=SYMBOLS[:2]),
                section="sec-quickshot-parallel",
                arm=two,
                traps=SUMMED,
                kinematics=False,
            ),
            Part(
                "table2_modified",
                "2R: the modified table",
                2,
                Table("modified"),
                section="sec-both-columns",
                arm=two_modified,
                traps=[own_link(two)],
            ),
            Part(
                "T2_modified",
                "2R: the modified frame {2}",
                2,
                Formula(last, symbols=SYMBOLS[:2]),
                section="sec-modified-product",
                arm=two_modified,
                traps=[
                    Trap(
                        "This is the pose of the hand; frame {2} of the modified convention stands at the elbow.",
                        lambda _, q: two.fk(q),
                    ),
                ],
                kinematics=False,
            ),
            Part(
                "E2",
                "2R: what is left over",
                1,
                Numbers(lambda _, q: Tx(l2), at=()),
                section="sec-both-tool",
                traps=[
                    Trap("This is the first link; that one stands in row 2 already.", lambda _, q: Tx(l1)),
                    Trap(
                        "This is the whole arm; the first link is in the table.",
                        lambda _, q: Tx(l1 + l2),
                    ),
                    Trap("With no tool the hand would be at the elbow.", lambda _, q: np.eye(4)),
                ],
            ),
            Part("table3", "3R: the classic table", 2, Table("classic"), section="sec-classic-parameters"),
            Part(
                "T3",
                "3R in numbers",
                1,
                Numbers(last, at=angles),
                section="sec-classic-product",
                traps=SUMMED,
                kinematics=False,
            ),
            Part(
                "T3_sym",
                "3R in symbols",
                2,
                Formula(last, symbols=SYMBOLS),
                section="sec-quickshot-parallel",
                traps=SUMMED,
                kinematics=False,
            ),
            Part(
                "table3_modified",
                "3R: the modified table",
                2,
                Table("modified"),
                section="sec-both-columns",
                arm=three_modified,
                traps=[own_link(three)],
            ),
            Part(
                "link3",
                "3R: any modified link, as a function",
                2,
                link_function(3, seed=6, length_tolerance=1e-3, name="link3"),
                section="sec-modified-product",
                arm=three_modified,
                traps=[
                    Trap(
                        "These are the classic link matrices: they lead to the far end of link i. The modified ones go "
                        "along the link before joint i, and then turn.",
                        lambda _, i, q: three.A(i, q),
                        "convention",
                    )
                ],
                kinematics=False,
            ),
            Part(
                "T3_with_tool",
                "3R: the hand by the modified table",
                2,
                Numbers(lambda chain, q: last(chain, q) @ Tx(l3), at=angles),
                section="sec-both-tool",
                arm=three_modified,
                traps=[
                    Trap("This is frame {3} of the modified convention: the tool is missing.", last, "ends"),
                    Trap(
                        "The tool stands on the wrong side: it belongs to the last frame, on the right.",
                        lambda chain, q: Tx(l3) @ last(chain, q),
                        "ends",
                    ),
                    Trap("The last link is there twice.", lambda _, q: last(three, q) @ Tx(l3)),
                ],
                kinematics=False,
            ),
            one_of(
                "stays",
                "Which origin stays",
                "sec-modified-product",
                "modified",
                classic="there O1 lies on axis 2, at the end of the link that turns.",
                modified="there O1 lies on axis 1, and turning about that axis leaves it where it is.",
                both="follow the end of link 1 as joint 1 turns: which frame has its origin there?",
                neither="a point on axis 1 does not move as joint 1 turns: which frame has its origin there?",
            ),
            number(
                "orders",
                "Orders that pass on a planar link",
                12,
                "sec-classic-orders",
                [
                    (5, "That many are right for every link; on a planar one more of them pass."),
                    (24, "Rz and Tx do not commute: half a turn here makes a difference."),
                    (6, "Tz and Rx are the identity here, so they may stand anywhere, and in either order."),
                    (2, "Tz and Rx are the identity here, so they may stand anywhere."),
                    (8, "That is how many matrices the 24 orders give for a link in space."),
                ],
            ),
            number(
                "height",
                "Three offsets",
                sum(offsets),
                "sec-quickshot-tables",
                [
                    (float(np.abs(offsets).sum()), "The middle offset goes down: offsets have signs."),
                    (offsets[0], "This is the first offset alone; all three go along the same direction."),
                    (offsets[-1], "This is the last offset alone; all three go along the same direction."),
                    (0.0, "The arm moves in a plane, but it is not that of the table."),
                    (-sum(offsets), "The right size, upside down: a positive offset goes along z, towards you."),
                    (float(np.linalg.norm(offsets)), "These lengths are parallel, not at right angles: they add up."),
                ],
            ),
            one_of(
                "unseen",
                "A mistake that passes",
                "sec-classic-trap-sign",
                "sign of alpha1",
                sign_of_alpha1="the twist is 0, and -0 is 0: no planar arm can show that you would have got it wrong.",
                sign_of_a2="with a2 reversed the hand is on the other side of the elbow: that shows at any angles.",
                sense_of_joint_2="then the arm bends the other way: that shows unless θ2 is 0 or 180°.",
                links_exchanged="with the links exchanged the elbow is elsewhere: that shows unless it is straight.",
            ),
            one_of(
                "exchanged",
                "Two links exchanged",
                "sec-quickshot-tables",
                "same reach",
                same_arm=f"the axes of joints 1 and 2 are {l1} mm apart in the one and {l2} mm in the other.",
                same_reach=f"both reach from {l1 - l2} to {l1 + l2} mm, but the axes stand elsewhere: two arms.",
                other_reach="the hand is furthest with the arm straight and nearest with it folded: work out both.",
            ),
            one_of(
                "longer",
                "A longer last link",
                "sec-both-tool",
                "another tool",
                another_arm="the three joint axes are where they were: what has changed lies behind all of them.",
                another_tool="the axes are where they were; what lies behind the last of them is for the tool to say.",
                mirror_image="nothing was reflected: no length has changed its sign.",
            ),
            one_of(
                "trial",
                "Where to test",
                "sec-trap-zero-only",
                "Quickshot at random angles",
                planar_3R_at_zero="no angle and no twist: nearly every mistake passes there.",
                planar_3R_at_random_angles="no twist and no offset: a mistake in α or d passes at any angles.",
                Quickshot_at_zero="at zero every sine of a joint angle is 0, and so many a sign passes.",
                Quickshot_at_random_angles="twists, lengths, offsets and angles are all alive there.",
            ),
        ],
    )


EXERCISE = exercise(DEFAULT)
