"""What the exercise on transforms asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, Revolute, Rx, Ry, Rz, Tx, Ty, Tz, inverse
from dhlib.grading.asking import choice, constant, holding, reasoned
from dhlib.grading.course.sources import matrix, number, row, strings
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Formula, Function, Numbers
from dhlib.grading.pictures import same_for_all
from dhlib.scene import Scene, beside_each_other
from dhlib.view import VIEW

#: Cosines and sines of angles that print with two digits.
QUARTER = [(0.8, 0.6), (0.6, 0.8), (0.96, 0.28), (0.28, 0.96)]
#: The matrices of the last question, without their positions; all but the first are no poses.
KINDS = {
    "thirds": [[2, -1, 2], [2, 2, -1], [-1, 2, 2]],
    "mirror": [[0.8, 0, 0.6], [0.36, 0.8, -0.48], [0.48, -0.6, -0.64]],
    "stretched": [[1.6, -0.3, 0], [1.2, 0.4, 0], [0, 0, 1]],
    "slanting": [[0.8, 0, 0.6], [0.6, 0.6, -0.8], [0, 0.8, 0]],
}

#: Pairs of atomic transforms: whether they may change places, and what to say of it.
PAIRS = {
    "Rz Tz": (True, "a screw may be turned and then pushed, or pushed and then turned."),
    "Rx Tx": (True, "a screw may be turned and then pushed, or pushed and then turned."),
    "Tz Tx": (True, "ways add up, whichever is gone first: no turn stands between them."),
    "Rz Tx": (False, "turning and then going leads elsewhere than going and then turning."),
    "Rx Rz": (False, "two turns about different axes do not commute: try quarter turns of a book."),
    "Tz Rx": (False, "the turn about x bends the way along z aside, if it comes first."),
}


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in mm, the turn in degrees."""

    turn: float = 40
    way: float = 300
    #: Cosine and sine of the turns about z and then x that the hand has made.
    hand: tuple[tuple[float, float], tuple[float, float]] = ((0.8, 0.6), (-0.6, 0.8))
    hand_at: tuple[float, ...] = (420, -150, 260)
    #: Columns o and a of a hand whose n was lost, times 3.
    columns: tuple[tuple[int, ...], tuple[int, ...]] = ((-2, 2, 1), (-1, -2, 2))
    ahead: float = 80
    camera_at: tuple[float, ...] = (300, 40, 900)
    cube: tuple[float, float] = (0.6, 0.8)
    cube_at: tuple[float, ...] = (150, 90, 850)
    order: tuple[str, ...] = tuple(KINDS)
    pairs: tuple[str, ...] = ("Rz Tx", "Rx Rz", "Rz Tz", "Tz Rx")
    places: tuple[tuple[float, ...], ...] = ((-30, 500, 75), (50, 20, 310), (75, -20, 140), (200, 0, -35))

    @property
    def HAND(self):
        (c, s), (cx, sx) = self.hand
        return pose([[c, -s * cx, s * sx], [s, c * cx, -c * sx], [0, sx, cx]], self.hand_at)

    @property
    def CAMERA(self):
        return pose(np.diag([1, -1, -1]), self.camera_at)

    @property
    def CUBE(self):
        c, s = self.cube
        return pose([[c, -s, 0], [s, c, 0], [0, 0, 1]], self.cube_at)


def pose(rotation, at):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation, at
    return np.round(T, 6)


DEFAULT = Given()


#: Parts with one answer for everybody: the general transforms, and a function for any pose.
SAME_FOR_ALL = ("Rz_sym", "Tz_sym", "Tx_sym", "Rx_sym", "invert")


def draw(lots):
    """Another hall, another hand, another camera; the four matrices in another order and at other places."""
    (c, s), (cx, sx) = lots.some("hand", QUARTER, 2)
    turns = [
        np.round(np.column_stack(axes), 6)
        for axes in ((x, y, np.cross(x, y)) for x in AXES for y in AXES if not np.dot(x, y))
    ]
    turned = lots.one("columns", [turn for turn in turns if np.trace(turn) != 3])
    return Given(
        turn=lots.one("turn", [25, 35, 50, 55, 65, 70]),
        way=lots.one("way", [220, 240, 260, 280, 320, 340, 360, 380]),
        hand=((c, s), (-cx, sx)),
        hand_at=tuple(lots.one(f"hand {k}", range(low, low + 300, 30)) for k, low in enumerate((340, -445, 135))),
        columns=tuple(tuple(round(e) for e in turned @ column) for column in DEFAULT.columns),
        ahead=lots.one("ahead", [55, 60, 65, 70, 75, 85, 90, 95]),
        camera_at=tuple(lots.one(f"camera {k}", range(low, low + 200, 20)) for k, low in enumerate((210, 50, 810))),
        cube=lots.one("cube", [(0.28, 0.96), (0.96, 0.28), (0.8, 0.6)]),
        cube_at=tuple(lots.one(f"cube {k}", range(low, low + 90, 10)) for k, low in enumerate((110, 120, 760))),
        order=tuple(lots.shuffled("order", tuple(KINDS))),
        pairs=lots.one_right("pairs", [p for p in holding(PAIRS) if p not in DEFAULT.pairs], holding(PAIRS, False)),
        places=tuple(tuple(lots.some(f"place {k}", range(-245, 250, 30), 3)) for k in range(4)),
    )


#: The six directions along the axes.
AXES = [sign * axis for axis in np.eye(3) for sign in (1, -1)]


def cells(given):
    """The given cells of the notebook."""
    o, a = (f"np.array({row(column)}) / 3" for column in given.columns)
    return {
        "way": f"turn = np.deg2rad({number(given.turn)})\nway = {number(given.way)}  # millimetres",
        "pairs": strings("pairs", given.pairs),
        "hand": matrix("hand", given.HAND),
        "columns": f"o_left = {o}\na_left = {a}",
        "ahead": f"ahead = {number(given.ahead)}  # millimetres",
        "camera": f"{matrix('camera', given.CAMERA)}\n{matrix('cube', given.CUBE)}",
        "matrices": "\n".join(map(printed, (1, 2, 3, 4), given.order, given.places)),
    }


def printed(k, kind, place):
    """One of the four matrices, in one line; that of thirds is divided at its end."""
    whole = 3 if kind == "thirds" else 1
    rows = [[*line, whole * at] for line, at in zip(KINDS[kind], place, strict=True)]
    listed = ", ".join(map(row, [*rows, [0, 0, 0, whole]]))
    return f"M{k} = np.array([{listed}])" + (" / 3" if whole == 3 else "")


@same_for_all
def figure():
    """Frame {0}, and where each of the four steps brings it."""
    steps = {"θ": (Rz(0.7), "z"), "d": (Tz(0.7), "z"), "a": (Tx(0.7), "x"), "α": (Rx(0.7), "x")}
    pictures = []
    for symbol, (step, axis) in steps.items():
        scene = Scene()
        scene.add_room([1.7, 0, 0], [0, 0, 1.7])
        scene.add_frame(np.eye(4), "0", dashed=True)
        scene.add_frame(step, letters=[f"{letter}′" for letter in "xyz"])
        along, slides = np.eye(3)["xyz".index(axis)], symbol in "da"
        if slides:
            scene.add_segment([0, 0, 0], 0.7 * along, symbol, colour=axis)
        else:
            scene.add_arc([0, 0, 0], along, np.roll(along, 1), 0.7, symbol, 0.6, axis)
        caption = f"{'T' if slides else 'R'}_{axis}({symbol})"
        pictures.append(scene.sketch(view=VIEW, width=210, caption=caption))
    return beside_each_other(
        pictures,
        "Four steps: frame {0}, dashed, and where each step brings it",
        "Four pictures of frame 0, dashed, and a frame with dashes on its letters, which a step has moved: turned "
        "about z, slid along z, slid along x, turned about x. A turn keeps the origin and one axis; a slide keeps the "
        "directions of all three.",
    )


POSES = [
    Tx(x) @ Ty(y) @ Tz(z) @ Rz(k) @ Ry(0.4 + k) @ Rx(1 - k)
    for k, (x, y, z) in enumerate([(120, -40, 80), (-70, 250, 30), (0, 0, 410), (333, 111, -90)])
]


def atomic(name, step, symbol, others):
    """One of the four atomic transforms; the traps are the steps about or along other axes."""
    traps = [
        Trap(f"This is the step about or along {axis}.", lambda arm, q, s=other: s(q[0])) for axis, other in others
    ]
    if symbol in ("theta", "alpha"):
        says = "The sines have each other's sign: for a small positive angle, where does the tip of each axis go?"
        traps.append(Trap(says, lambda arm, q: step(q[0]).T, "transpose"))
    else:
        says = "It slides backwards: a positive length goes along the axis."
        traps.append(Trap(says, lambda arm, q: step(-q[0]), "transpose"))
    asks = Formula(lambda arm, q: step(q[0]), symbols=[symbol])
    return Part(f"{name}_sym", f"{name} in symbols", 1, asks, section="sec-atomic", traps=traps, kinematics=False)


def product(part, title, points, degrees, *steps):
    """A product of steps in numbers: each step makes a matrix of the turn, in radians."""
    right = np.deg2rad(degrees)

    def at(turn, reverse=False):
        matrices = [step(turn) for step in steps]
        return np.linalg.multi_dot(matrices[::-1] if reverse else matrices)

    traps = [
        Trap("The factors of {part} stand in reverse order.", constant(at(right, reverse=True)), "reverse"),
        Trap(f"np.cos and np.sin take radians: {degrees}° is np.deg2rad({degrees}).", constant(at(degrees)), "degrees"),
        Trap(
            "It turns the wrong way: seen from the tip of z, positive is anticlockwise.", constant(at(-right)), "sense"
        ),
    ]
    return Part(part, title, points, Numbers(constant(at(right)), at=()), section="sec-composition", traps=traps)


def vector(part, title, value, section, traps, tolerance=1e-3):
    asks = Numbers(constant(value), shape=(3,), at=(), tolerance=tolerance)
    return Part(part, title, 1, asks, section=section, traps=[Trap(says, constant(wrong)) for says, wrong in traps])


def read_off(HAND, part, title, column, tolerance=1e-3):
    names = "noap"
    traps = [(f"This is column {names[k]}, of n, o, a, p.", HAND[:3, k]) for k in range(4) if k != column] + [
        ("This is a row of the matrix; the axes of the hand are its columns.", HAND[k, :3]) for k in range(3)
    ]
    return vector(part, title, HAND[:3, column], "sec-noap", traps, tolerance)


def half_inverses(of):
    """What is handed in for the inverse of `of(*probe)` by halves."""

    def taken(rotation, position):
        def quantity(arm, *probe):
            T = of(*probe)
            wrong = np.eye(4)
            wrong[:3, :3], wrong[:3, 3] = rotation(T[:3, :3]), position(T[:3, :3], T[:3, 3])
            return wrong

        return quantity

    axes = "The position is written in the axes of the wrong frame: -p has to be turned by the transposed rotation."
    return [
        Trap(
            "{part} is the whole matrix transposed: that inverts a rotation only.",
            lambda arm, *p: of(*p).T,
            "transpose",
        ),
        Trap(axes, taken(np.transpose, lambda R, p: -p)),
        Trap(
            "The rotation is right, and the position is still that of the matrix itself.",
            taken(np.transpose, lambda R, p: p),
        ),
        Trap(
            "The position lacks its minus sign: the way back is the way there, reversed.",
            taken(np.transpose, lambda R, p: R.T @ p),
        ),
        Trap(
            "The position is turned by the rotation itself; it takes the transposed one.",
            taken(np.transpose, lambda R, p: -R @ p),
        ),
    ]


#: Faults that a matrix may have, by the letters of the page.
FAULTS = {
    "a": "its last row is 0 0 0 1, as it should be.",
    "b": "all three columns n, o, a have length 1.",
    "c": "n, o and a are at right angles: each product of two columns is 0.",
    "d": "its determinant is +1.",
    "e": "at least one of the four faults is there.",
}


def law(k, right, faults, because):
    """Whether a printed matrix is a pose, and the faults that it has."""
    options = {
        "pose": "it looks like one, but one of the four questions finds a fault: put them in their order.",
        "no pose": "check it again: last row, lengths, right angles, determinant.",
    }
    reasons = {letter: "" if letter in faults else says for letter, says in FAULTS.items()}
    return reasoned(f"law_{k}", f"Matrix {k}", right, options | {right: because}, reasons, "sec-pose")


LAWS = {
    "thirds": ("pose", "e", "all four questions are passed: last row, lengths, right angles, determinant."),
    "mirror": ("no pose", "d", "its determinant is -1: this is a mirror image, which no turn can make."),
    "stretched": (
        "no pose",
        "b",
        "column n is too long and o too short, though the determinant is +1: it does not see that.",
    ),
    "slanting": (
        "no pose",
        "cd",
        "n · o is 0.36 and o · a is -0.48; and with slanting axes the determinant falls below 1.",
    ),
}


def exercise(given):
    """The exercise with these numbers."""
    HAND, CAMERA, CUBE, s = given.HAND, given.CAMERA, given.CUBE, given.ahead
    o, a = (np.array(column) / 3 for column in given.columns)
    in_hand = Numbers(constant(inverse(HAND) @ CAMERA @ CUBE), at=())

    def go(turn):
        return Tx(given.way)

    return Exercise(
        name="transforms",
        title="Transforms",
        arm=Chain([Revolute()], "classic", unit="mm"),
        parts=[
            atomic("Rz", Rz, "theta", [("x", Rx), ("y", Ry)]),
            atomic("Tz", Tz, "d", [("x", Tx), ("y", Ty)]),
            atomic("Tx", Tx, "a", [("y", Ty), ("z", Tz)]),
            atomic("Rx", Rx, "alpha", [("y", Ry), ("z", Rz)]),
            product("go_turn", "Go, then turn", 1, given.turn, go, Rz),
            product("turn_go", "Turn, then go", 1, given.turn, Rz, go),
            choice(
                "pair",
                "Which two may change places",
                next(pair for pair in given.pairs if PAIRS[pair][0]),
                {pair: PAIRS[pair][1] for pair in given.pairs},
                "sec-atomic",
            ),
            product("fixed", "About fixed axes", 2, given.turn, go, Rz, lambda turn: Rx(np.pi / 2)),
            read_off(HAND, "approach", "Where the hand points", 2),
            read_off(HAND, "fingers", "From finger to finger", 1),
            read_off(HAND, "position", "Where the hand is", 3, tolerance=0.1),
            vector(
                "normal",
                "A lost column",
                np.cross(o, a),
                "sec-noap",
                [
                    (
                        "This is a × o: it makes the frame left-handed. In n, o, a the order goes round: n × o = a.",
                        np.cross(a, o),
                    ),
                    ("This is not at right angles to o and a.", o + a),
                    ("This is o multiplied by a entry by entry; asked for is their cross product.", o * a),
                ],
            ),
            vector(
                "tip",
                "In front of the hand",
                (HAND @ [0, 0, s, 1])[:3],
                "sec-homogeneous",
                [
                    ("This is a direction: a point carries a 1 below, and feels p.", (HAND @ [0, 0, s, 0])[:3]),
                    (
                        f"These {s} mm go along z of the room; they should go along a, the third axis of the hand.",
                        HAND[:3, 3] + [0, 0, s],
                    ),
                    (f"This is {s} mm behind the hand.", (HAND @ [0, 0, -s, 1])[:3]),
                    (f"These {s} mm go along n, the first axis of the hand.", (HAND @ [s, 0, 0, 1])[:3]),
                    (f"These {s} mm go along o, the second axis of the hand.", (HAND @ [0, s, 0, 1])[:3]),
                ],
                tolerance=0.1,
            ),
            Part(
                "hand_back",
                "The room, seen from the hand",
                2,
                Numbers(constant(inverse(HAND)), at=()),
                section="sec-inverse",
                traps=half_inverses(lambda q: HAND),
                kinematics=False,
            ),
            Part(
                "invert",
                "Any pose, inverted",
                2,
                Function(lambda arm, T: inverse(T), calls=[(T,) for T in POSES], signature="invert(T)"),
                section="sec-inverse",
                traps=half_inverses(lambda T: T),
                kinematics=False,
            ),
            Part(
                "cube_in_hand",
                "The cube, seen from the hand",
                2,
                in_hand,
                section="sec-chain-product",
                follows=Follows(["hand_back"], lambda back: back @ CAMERA @ CUBE),
                traps=[
                    Trap(
                        "This is the cube in the room; from there one more step leads to the hand.",
                        constant(CAMERA @ CUBE),
                    ),
                    Trap(
                        "The hand is taken the wrong way round: from the hand to the room is the inverse.",
                        constant(HAND @ CAMERA @ CUBE),
                    ),
                    Trap("The camera is taken the wrong way round.", constant(inverse(HAND) @ inverse(CAMERA) @ CUBE)),
                    Trap("The cube is taken the wrong way round.", constant(inverse(HAND) @ CAMERA @ inverse(CUBE))),
                    Trap(
                        "The factors of {part} stand in reverse order: indices that meet cancel.",
                        constant(CUBE @ CAMERA @ inverse(HAND)),
                        "reverse",
                    ),
                    Trap(
                        "The inverse of the hand stands on the wrong side: indices that meet cancel.",
                        constant(CAMERA @ CUBE @ inverse(HAND)),
                    ),
                    Trap(
                        "The hand is transposed; the inverse of a pose is more than that.",
                        constant(HAND.T @ CAMERA @ CUBE),
                    ),
                    Trap(
                        "{part} is multiplied entry by entry: the product of matrices is @.",
                        constant(inverse(HAND) * CAMERA * CUBE),
                        "entrywise",
                    ),
                ],
            ),
            *(law(k, *LAWS[kind]) for k, kind in enumerate(given.order, 1)),
        ],
    )


EXERCISE = exercise(DEFAULT)
