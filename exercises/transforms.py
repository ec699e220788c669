"""What the exercise on transforms asks, and how it is marked."""

import numpy as np

from dhlib import Chain, Revolute, Rx, Ry, Rz, Tx, Ty, Tz, inverse
from dhlib.grading.asking import constant, reasoned
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Choice, Formula, Function, Numbers

#: Poses in the room of the hand and of the camera, and of the cube in the camera, as the page gives them.
HAND = np.array([[0.8, 0.36, 0.48, 420], [0.6, -0.48, -0.64, -150], [0, 0.8, -0.6, 260], [0, 0, 0, 1]])
CAMERA = np.array([[1, 0, 0, 300], [0, -1, 0, 40], [0, 0, -1, 900], [0, 0, 0, 1]], dtype=float)
CUBE = np.array([[0.6, -0.8, 0, 150], [0.8, 0.6, 0, 90], [0, 0, 1, 850], [0, 0, 0, 1]])
#: Columns o and a of a hand whose n was lost.
O_LEFT, A_LEFT = np.array([-2, 2, 1]) / 3, np.array([-1, -2, 2]) / 3

TURN, WAY = np.deg2rad(40), 300
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


def product(part, title, points, *steps):
    """A product of steps (matrix, at) in numbers: ``at(turn)`` is the matrix, for a turn in radians."""

    def at(turn, reverse=False):
        matrices = [step(turn) for step in steps]
        return np.linalg.multi_dot(matrices[::-1] if reverse else matrices)

    traps = [
        Trap("The factors of {part} stand in reverse order.", constant(at(TURN, reverse=True)), "reverse"),
        Trap("np.cos and np.sin take radians: 40° is np.deg2rad(40).", constant(at(np.rad2deg(TURN))), "degrees"),
        Trap(
            "It turns the wrong way: seen from the tip of z, positive is anticlockwise.", constant(at(-TURN)), "sense"
        ),
    ]
    return Part(part, title, points, Numbers(constant(at(TURN)), at=()), section="sec-composition", traps=traps)


def vector(part, title, value, section, traps, tolerance=1e-3):
    asks = Numbers(constant(value), shape=(3,), at=(), tolerance=tolerance)
    return Part(part, title, 1, asks, section=section, traps=[Trap(says, constant(wrong)) for says, wrong in traps])


def read_off(part, title, column, tolerance=1e-3):
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


in_hand = Numbers(constant(inverse(HAND) @ CAMERA @ CUBE), at=())

EXERCISE = Exercise(
    name="transforms",
    title="Transforms",
    arm=Chain([Revolute()], "classic", unit="mm"),
    parts=[
        atomic("Rz", Rz, "theta", [("x", Rx), ("y", Ry)]),
        atomic("Tz", Tz, "d", [("x", Tx), ("y", Ty)]),
        atomic("Tx", Tx, "a", [("y", Ty), ("z", Tz)]),
        atomic("Rx", Rx, "alpha", [("y", Ry), ("z", Rz)]),
        product("go_turn", "Go, then turn", 1, lambda turn: Tx(WAY), Rz),
        product("turn_go", "Turn, then go", 1, Rz, lambda turn: Tx(WAY)),
        Part(
            "pair",
            "Which two may change places",
            1,
            Choice(
                {
                    "Rz Tx": "turning and then going leads elsewhere than going and then turning.",
                    "Rx Rz": "two turns about different axes do not commute: try both by quarter turns, with a book.",
                    "Rz Tz": "a screw may be turned and then pushed, or pushed and then turned.",
                    "Tz Rx": "the turn about x bends the way along z aside, if it comes first.",
                },
                right="Rz Tz",
            ),
            section="sec-atomic",
        ),
        product("fixed", "About fixed axes", 2, lambda turn: Tx(WAY), Rz, lambda turn: Rx(np.pi / 2)),
        read_off("approach", "Where the hand points", 2),
        read_off("fingers", "From finger to finger", 1),
        read_off("position", "Where the hand is", 3, tolerance=0.1),
        vector(
            "normal",
            "A lost column",
            np.cross(O_LEFT, A_LEFT),
            "sec-noap",
            [
                (
                    "This is a × o: it makes the frame left-handed. In n, o, a the order goes round: n × o = a.",
                    np.cross(A_LEFT, O_LEFT),
                ),
                ("This is not at right angles to o and a.", O_LEFT + A_LEFT),
                ("This is o multiplied by a entry by entry; asked for is their cross product.", O_LEFT * A_LEFT),
            ],
        ),
        vector(
            "tip",
            "In front of the hand",
            (HAND @ [0, 0, 80, 1])[:3],
            "sec-homogeneous",
            [
                ("This is a direction: a point carries a 1 below, and feels p.", (HAND @ [0, 0, 80, 0])[:3]),
                (
                    "These 80 mm go along z of the room; they should go along a, the third axis of the hand.",
                    HAND[:3, 3] + [0, 0, 80],
                ),
                ("This is 80 mm behind the hand.", (HAND @ [0, 0, -80, 1])[:3]),
                ("These 80 mm go along n, the first axis of the hand.", (HAND @ [80, 0, 0, 1])[:3]),
                ("These 80 mm go along o, the second axis of the hand.", (HAND @ [0, 80, 0, 1])[:3]),
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
                    "This is the cube in the room; from there one more step leads to the hand.", constant(CAMERA @ CUBE)
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
                    "The hand is transposed; the inverse of a pose is more than that.", constant(HAND.T @ CAMERA @ CUBE)
                ),
                Trap(
                    "{part} is multiplied entry by entry: the product of matrices is @.",
                    constant(inverse(HAND) * CAMERA * CUBE),
                    "entrywise",
                ),
            ],
        ),
        law(1, "pose", "e", "all four questions are passed: last row, lengths, right angles, determinant."),
        law(2, "no pose", "d", "its determinant is -1: this is a mirror image, which no turn can make."),
        law(
            3,
            "no pose",
            "b",
            "column n is too long and o too short, though the determinant is +1: it does not see that.",
        ),
        law(
            4,
            "no pose",
            "cd",
            "n · o is 0.36 and o · a is -0.48; and with slanting axes the determinant falls below 1.",
        ),
    ],
)
