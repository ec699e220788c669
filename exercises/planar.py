"""What the exercise on planar arms asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, Revolute, Rz, Tx
from dhlib.grading.asking import choice, holding, link_function, number, which_holds
from dhlib.grading.course.sources import lettered, row, strings
from dhlib.grading.course.sources import number as number_text
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Formula, Numbers, Table
from dhlib.grading.pictures import same_for_all
from dhlib.scene import Scene

#: Mistakes in the classic table of a planar arm: whether each passes unseen, and what to say of it.
MISTAKES = {
    "sign of alpha1": (True, "the twist is 0, and -0 is 0: no planar arm can show that you would have got it wrong."),
    "sign of alpha2": (True, "the twist is 0, and -0 is 0: no planar arm can show that you would have got it wrong."),
    "sign of d1": (
        True,
        "the offset is 0, and -0 is 0: no arm without offsets shows that you would have got it wrong.",
    ),
    "sign of d2": (
        True,
        "the offset is 0, and -0 is 0: no arm without offsets shows that you would have got it wrong.",
    ),
    "sign of a1": (False, "with a1 reversed the elbow is on the other side of axis 1: that shows at any angles."),
    "sign of a2": (False, "with a2 reversed the hand is on the other side of the elbow: that shows at any angles."),
    "sense of joint 1": (False, "then the arm turns the other way: that shows unless θ1 is 0 or 180°."),
    "sense of joint 2": (False, "then the arm bends the other way: that shows unless θ2 is 0 or 180°."),
    "links exchanged": (False, "with the links exchanged the elbow is elsewhere: that shows unless it is straight."),
}
#: What somebody may have changed in the 3R arm, and what has become of it.
CHANGES = {
    "the last link is longer": "another tool",
    "the hand is turned in its mount": "another tool",
    "the first link is longer": "another arm",
    "the second link is shorter": "another arm",
    "the whole arm stands higher": "another base",
    "the whole arm stands further to the left": "another base",
}
#: Where a function for link matrices may be tried.
TRIALS = {
    "the Quickshot at random angles": (True, "twists, lengths, offsets and angles are all alive there."),
    "the PUMA 560 at random angles": (True, "twists, lengths, offsets and angles are all alive there."),
    "the Quickshot at zero": (False, "at zero every sine of a joint angle is 0, and so many a sign passes."),
    "the PUMA 560 at zero": (False, "at zero every sine of a joint angle is 0, and so many a sign passes."),
    "the planar 3R at zero": (False, "no angle and no twist: nearly every mistake passes there."),
    "the planar 3R at random angles": (False, "no twist and no offset: a mistake in α or d passes at any angles."),
    "the planar 2R at random angles": (False, "no twist and no offset: a mistake in α or d passes at any angles."),
}


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in mm, angles in degrees."""

    lengths: tuple[float, ...] = (260, 190, 110)
    angles: tuple[float, ...] = (35, -70, 50)
    #: Of a draughtsman's table.
    offsets: tuple[float, ...] = (40, -25, 60)
    #: Which joint turns alone, and of which frame the origin is watched.
    turned: tuple[int, int] = (1, 1)
    mistakes: tuple[str, ...] = ("sign of alpha1", "sign of a2", "sense of joint 2", "links exchanged")
    #: How the links of another 2R arm are made of ours.
    built: str = "exchanged"
    change: str = "the last link is longer"
    trials: tuple[str, ...] = (
        "the planar 3R at zero",
        "the planar 3R at random angles",
        "the Quickshot at zero",
        "the Quickshot at random angles",
    )

    @property
    def others(self):
        """The lengths a1 and a2 of the other 2R arm."""
        l1, l2, _ = self.lengths
        return {
            "exchanged": (l2, l1),
            "x reversed": (-l1, l2),
            "elbow moved": (l1 - 20, l2 + 20),
            "both longer": (l1 + 20, l2 + 20),
        }[self.built]

    def arm(self, n, convention="classic"):
        """The first n links; in the modified convention frame {n} stands on axis n, and the tool has the last one."""
        lengths = self.lengths[:n] if convention == "classic" else (0.0, *self.lengths[: n - 1])
        return Chain([Revolute(a=a) for a in lengths], convention, name=f"Planar {n}R", unit="mm")


DEFAULT = Given()


#: Parts with one answer for everybody: a number that is a fact about the four steps.
SAME_FOR_ALL = ("orders",)


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
        turned=lots.one("turned", [(2, 2), (3, 3), (2, 1), (3, 1), (3, 2), (1, 2), (1, 3), (2, 3)]),
        mistakes=lots.one_right("mistakes", holding(MISTAKES), holding(MISTAKES, False)),
        built=lots.one("built", ["exchanged", "x reversed", "elbow moved", "both longer"]),
        change=lots.one("change", list(CHANGES)[1:]),
        trials=lots.one_right("trials", holding(TRIALS), holding(TRIALS, False)),
    )


def cells(given):
    """The given cells of the notebook."""
    l1, l2, l3 = map(number_text, given.lengths)
    return {
        "lengths": f"l1, l2, l3 = {l1}, {l2}, {l3}  # millimetres",
        "angles": f"q = np.deg2rad({row(given.angles)})",
        "offsets": f"d = {row(given.offsets)}  # millimetres",
        "turned": "joint, origin = {}, {}".format(*given.turned),
        "mistakes": strings("mistakes", given.mistakes),
        "friends": f'others = {row(given.others)}  # millimetres\nchange = "{given.change}"',
        "trials": lettered("trials", given.trials),
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


def stays(joint, origin):
    """In which convention an origin stays: a modified one lies on its own axis, a classic one on the next."""
    moves = {"classic": origin >= joint, "modified": origin > joint}
    there = {"classic": f"at the far end of link {origin}", "modified": f"on axis {origin}"}
    right = {(True, True): "neither", (True, False): "modified", (False, False): "both"}[*moves.values()]
    facts = "; ".join(
        f"the {name} O{origin} lies {there[name]}, which joint {joint} {'moves' if moved else 'leaves where it is'}"
        for name, moved in moves.items()
    )
    follow = f"follow what joint {joint} moves: are the far end of link {origin} and axis {origin} among it?"
    because = dict.fromkeys(("classic", "modified", "both", "neither"), follow)
    return choice("stays", "Which origin stays", right, because | {right: f"{facts}."}, "sec-modified-product")


def exchanged(given):
    """What another 2R arm is, compared with ours."""
    l1, l2, _ = given.lengths
    a1, a2 = map(abs, given.others)
    same_reach = (abs(a1 - a2), a1 + a2) == (l1 - l2, l1 + l2)
    right = "same arm" if a1 == l1 and a2 == l2 else "same reach" if same_reach else "other reach"
    span = f"ours reaches from {l1 - l2} to {l1 + l2} mm, the other from {abs(a1 - a2)} to {a1 + a2} mm"
    because = {
        "same arm": "x1 was turned round: with other zeros of both joints every pose is the same."
        if right == "same arm"
        else f"the axes of joints 1 and 2 are {l1} mm apart in the one and {a1} mm in the other.",
        "same reach": f"{span}; but the axes stand elsewhere: two arms."
        if right == "same reach"
        else "compare the distances from axis to axis, and how far the arm reaches straight, and folded.",
        "other reach": f"{span}."
        if right == "other reach"
        else "the hand is furthest with the arm straight and nearest with it folded: work out both.",
    }
    return choice("exchanged", "Another 2R arm", right, because, "sec-quickshot-tables")


def changed(change):
    """What became of the 3R arm."""
    right = CHANGES[change]
    because = {
        "another arm": "the distances between the joint axes are what makes the arm, and one of them is another."
        if right == "another arm"
        else "the three joint axes stand to each other as before: it is something else that has changed.",
        "another tool": "the axes are where they were; what lies behind the last of them is for the tool to say."
        if right == "another tool"
        else "behind the last axis all is as it was.",
        "another base": "the axes stand to each other as before, but elsewhere in the room: that is the base."
        if right == "another base"
        else "axis 1 stands where it stood.",
    }
    return choice("longer", "What has changed", right, because, "sec-both-tool")


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
            stays(*given.turned),
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
            choice(
                "unseen",
                "A mistake that passes",
                next(mistake for mistake in given.mistakes if MISTAKES[mistake][0]),
                {mistake: MISTAKES[mistake][1] for mistake in given.mistakes},
                "sec-classic-trap-sign",
            ),
            exchanged(given),
            changed(given.change),
            which_holds("trial", "Where to test", given.trials, TRIALS, "sec-trap-zero-only"),
        ],
    )


EXERCISE = exercise(DEFAULT)
