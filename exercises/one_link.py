"""What the exercise on one link asks, and how it is marked."""

from dataclasses import dataclass, replace
from functools import cache, reduce
from itertools import permutations

import numpy as np

from dhlib import Chain, Revolute, Rx, Ry, Rz, Tx, Ty, Tz, classic
from dhlib.grading.asking import choice, constant, number
from dhlib.grading.course.sources import matrix as matrix_text
from dhlib.grading.course.sources import strings
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Choice, Formula, Function, Numbers
from dhlib.grading.misconceptions import retold
from dhlib.grading.pictures import same_for_all
from dhlib.scene import beside_each_other
from dhlib.sketch import link as drawn_link

CLASSIC, MODIFIED = ("theta", "d", "a", "alpha"), ("alpha", "a", "theta", "d")
CALLS = [tuple(map(float, row)) for row in np.random.default_rng(5).uniform(-2.5, 2.5, (8, 4))]


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in mm, angles in degrees or, of the frames, in radians."""

    theta: float = -130
    d: float = 85.0
    a: float = 140.0
    alpha: float = 55
    turn: float = 0.6
    up: float = 70
    out: float = 120
    twist: float = -0.8
    aside: float = 35
    lean: float = 0.3
    #: Which step of the printed product is wrong, counted from 0.
    wrong: int = 3
    #: What the four pairs of frames obey, and what the last kind obeys by the conditions of the modified convention.
    order: tuple[str, ...] = ("both hold", "DH2 fails", "DH1 fails", "both fail")
    modified: str = "both hold"
    #: In which order the four steps are permuted, and four orders of them, one of which obeys just one condition.
    steps: tuple[str, ...] = ("Rz", "Tz", "Tx", "Rx")
    four: tuple[str, ...] = ("Tz Rx Rz Tx", "Rx Tz Rz Tx", "Tz Tx Rx Rz", "Rx Tx Rz Tz")

    @property
    def LINK(self):
        """The link whose parameters are to be read off its matrix."""
        return {"theta": np.deg2rad(self.theta), "d": self.d, "a": self.a, "alpha": np.deg2rad(self.alpha)}

    @property
    def frames(self):
        """Frames {1} as seen from {0}: what each obeys is asked."""
        up, out = Tz(self.up), Tx(self.out) @ Rx(self.twist)
        pairs = {
            "both hold": Rz(self.turn) @ up @ out,
            "DH2 fails": Rz(self.turn) @ Ty(self.aside) @ up @ out,
            "DH1 fails": Rz(self.turn) @ up @ Ry(-self.lean) @ out,
            "both fail": Rx(self.twist) @ Tx(self.out) @ self.amiss @ Rz(self.turn) @ up,
        }
        return [pairs[kind] for kind in self.order]

    @property
    def amiss(self):
        """What stands in the midst of the modified link of the last kind."""
        return {
            "both hold": np.eye(4),
            "DH2 fails": Ty(self.aside),
            "DH1 fails": Ry(-np.sign(self.twist) * self.lean),
        }[self.modified]


DEFAULT = Given()


#: Parts with one answer for everybody: the general link matrix, and a number that is a fact about the four steps.
SAME_FOR_ALL = ("A_sym", "classic_link", "B_sym", "modified_link", "origin", "products")


def draw(lots):
    """Another link, with theta beyond a quarter turn; other frames, in another order; other orders of the steps."""
    orders = [tuple(order) for order in permutations(DEFAULT.order) if tuple(order) != DEFAULT.order]
    return Given(
        theta=lots.one("theta", [-155, -145, -125, -115, -110, 110, 115, 125, 145, 155]),
        d=lots.one("d", range(61, 81, 2)),
        a=lots.one("a", range(112, 138, 3)),
        alpha=lots.one("alpha", [-75, -65, -40, -35, -25, 25, 35, 40, 65, 75]),
        turn=lots.one("turn", [0.35, 0.45, 0.5, 0.7, 0.75, 0.85]),
        up=lots.one("up", range(44, 68, 4)),
        out=lots.one("out", range(92, 119, 5)),
        twist=lots.one("twist", [-0.95, -0.7, -0.6, 0.55, 0.65, 0.9]),
        aside=lots.one("aside", [22, 24, 26, 28, 31, 33]),
        lean=lots.one("lean", [0.16, 0.18, 0.22, 0.24, 0.26, 0.28]),
        wrong=lots.one("wrong", [0, 1, 2]),
        order=lots.one("order", orders),
        modified=lots.one("modified", ["both hold", "DH1 fails", "DH2 fails"]),
        steps=lots.one("steps", list(permutations(STEPS))[1:]),
        four=lots.one_right("four", [*ONE_OF_TWO], [*NEITHER]),
    )


def cells(given):
    """The given cells of the notebook."""
    A = link("classic", CLASSIC)(*given.LINK.values()).A(1, [given.LINK["theta"]])
    return {
        "link": matrix_text("A", A, 4),
        "printed": "printed = [" + ", ".join(f'"{step}({symbol})"' for step, symbol in printed(given.wrong)) + "]",
        "frames": "\n".join(
            [
                *(matrix_text(f"F{k}", frame, 4) for k, frame in enumerate(given.frames, 1)),
                f"again = F{given.order.index('both fail') + 1}",
            ]
        ),
        "orders": "orders = list(permutations([{}]))".format(", ".join(f'"{step}"' for step in given.steps)),
        "four": strings("four", given.four),
    }


#: The four factors of a modified link matrix by their places, and what to say of each as it is printed.
PLACES = ("first", "second", "third", "fourth")
STANDS = (
    "Rx(α) is right: the modified link begins with the twist about x of the frame before.",
    "Tx(a) is right: the link length goes along the same x as the twist.",
    "Rz(θ) is right: the joint turns about the new z.",
    "Tz(d) is right: the offset goes along the axis of the joint.",
)
AMISS = (
    "the twist α is about x, the axis of the link: the factor is Rx(α).",
    "the length a goes along x, the axis of the link: the factor is Tx(a).",
    "the joint turns by θ about z, its axis: the factor is Rz(θ).",
    "the offset d goes along z, the axis of the joint: the factor is Tz(d).",
)


def printed(wrong):
    """The steps of a modified link with their symbols, one of them about or along the other axis."""
    steps = ["Rx", "Tx", "Rz", "Tz"]
    steps[wrong] = steps[wrong][0] + {"x": "z", "z": "x"}[steps[wrong][1]]
    return list(zip(steps, ("alpha", "a", "theta", "d"), strict=True))


def link(convention, names):
    """The arm of one link, from parameters in the order of `names`."""

    def chain_at(*parameters):
        row = dict(zip(names, parameters, strict=True))
        return Chain([Revolute(d=row["d"], a=row["a"], alpha=row["alpha"])], convention, unit="mm")

    return chain_at


@same_for_all
def figure():
    """One link by each convention, and what its four parameters measure."""
    joint = Revolute(d=1.0, a=1.6, alpha=np.deg2rad(-55), offset=np.deg2rad(60))
    pictures = [
        drawn_link(Chain([joint], convention), 1, [0.0], names=("i-1", "i"), width=230)
        for convention in ("classic", "modified")
    ]
    return beside_each_other(
        pictures,
        "A link by the classic convention and one by the modified: frames {i-1}, dashed, and {i}, and four parameters",
        "Two pictures of frame i-1, dashed, frame i, and the way between them. On the left, classic: d along z of "
        "frame i-1, then a along x of frame i. On the right, modified: a along x of frame i-1, then d along z of "
        "frame i. Theta is the angle about that z axis, alpha the one about that x axis.",
    )


def matrix(names, position=False):
    """The link matrix of such an arm, or its position alone."""
    entries = (slice(3), 3) if position else ...
    return lambda arm, *parameters: arm.A(1, [dict(zip(names, parameters, strict=True))["theta"]])[entries]


@cache
def formula(part, title, points, convention, names, section, position=False):
    """The link matrix in symbols, or its position alone: the same part for every student."""
    make, take = link(convention, names), matrix(names, position)
    asks = Formula(lambda arm, q: take(make(*q), *q), shape=(3,) if position else (4, 4), symbols=names)
    told = retold(lambda q: make(*q), lambda arm, q: take(arm, *q), ((0.3, 0.4, 0.5, 0.6),))
    arm = link(convention, CLASSIC)(*DEFAULT.LINK.values())
    return Part(part, title, points, asks, section=section, arm=arm, traps=told, kinematics=False)


@cache
def function(part, title, points, convention, names, section):
    """The link matrix as a function: the same part for every student."""
    make, take = link(convention, names), matrix(names)
    asks = Function(lambda arm, *p: take(make(*p), *p), calls=CALLS, signature=f"{part}({', '.join(names)})")
    arm = link(convention, CLASSIC)(*DEFAULT.LINK.values())
    return Part(
        part, title, points, asks, section=section, arm=arm, traps=retold(make, take, CALLS[0]), kinematics=False
    )


def origin(wrong):
    """The position of the modified link matrix, of which one factor is printed wrongly."""
    part = formula("origin", "The position, mended", 1, "modified", MODIFIED, "sec-modified-slip", position=True)
    traps = [
        Trap(
            "This is the position of the printed product, with its wrong factor.",
            lambda arm, q: reduce(
                np.matmul, (STEPS[step](value) for (step, _), value in zip(printed(wrong), q, strict=True))
            )[:3, 3],
        ),
        Trap(
            "This is the position of the classic convention, a cos θ, a sin θ, d.",
            lambda arm, q: classic(q[2], q[3], q[1], q[0])[:3, 3],
            "convention",
        ),
    ]
    return replace(part, traps=[*traps, *part.traps])


def measured(LINK, part, title, names, tolerance, traps):
    """Two parameters of LINK, read off its matrix."""
    asks = Numbers(lambda arm, _: [LINK[name] for name in names], shape=(2,), at=(), tolerance=tolerance)
    return Part(part, title, 2, asks, section="sec-classic-measure", traps=traps)


def conditions(part, title, right, because, section="sec-classic-check"):
    """Which of DH1 and DH2 two frames obey."""
    fails = {"both hold": (), "DH1 fails": ("DH1",), "DH2 fails": ("DH2",), "both fail": ("DH1", "DH2")}
    options = {}
    for option, blamed in fails.items():
        unjust = [condition for condition in blamed if condition not in fails[right]]
        options[option] = (
            f"{unjust[0]} holds here: test it again." if unjust else "not all that fails is named: test both."
        )
    return choice(part, title, right, options | {right: because}, section)


# The 24 orders

STEPS = {"Rz": Rz, "Tz": Tz, "Tx": Tx, "Rx": Rx}
VALUES = {"Rz": 0.7, "Tz": 1.3, "Tx": 1.9, "Rx": -0.4}


@cache
def product(order):
    return reduce(np.matmul, (STEPS[step](VALUES[step]) for step in order))


def dh1(A):
    return abs(A[2, 0]) < 1e-9


def dh2(A):
    return abs(A[1, 0] * A[0, 3] - A[0, 0] * A[1, 3]) < 1e-9


def ones(holds, orders):
    return np.array([float(holds(product(order))) for order in orders])


def both(A):
    return dh1(A) and dh2(A)


def modified_both(A):
    return abs(A[0, 2]) < 1e-9 and abs(A[1, 2] * A[2, 3] - A[2, 2] * A[1, 3]) < 1e-9


PAIRS = {
    "both hold": "the line of x1 meets z0 at a right angle.",
    "DH2 fails": "the line of x1 is level, but it passes z0 at a distance.",
    "DH1 fails": "the line of x1 meets z0, but at a slant.",
    "both fail": "the line of x1 is slanted, and it passes z0 at a distance.",
}
#: The same by the conditions of the modified convention.
MODIFIED_PAIRS = {
    "both hold": "the line of x0 meets z1 at a right angle: these are modified frames.",
    "DH2 fails": "z1 is at right angles to x0, but passes it at a distance.",
    "DH1 fails": "the line of z1 meets x0, but at a slant.",
}

# Orders by what they obey of the classic convention: one condition of the two, or neither.
ONE_OF_TWO = {
    " ".join(order): "DH1 holds, and x1 passes z0 at a distance: one condition alone is no comfort."
    if dh1(product(order))
    else "its line of x1 still meets z0, though at a slant: DH2 alone is no comfort."
    for order in permutations(STEPS)
    if dh1(product(order)) != dh2(product(order))
}
NEITHER = {
    " ".join(order): "here both conditions fail: x1 is slanted, and passes z0 at a distance."
    for order in permutations(STEPS)
    if not dh1(product(order)) and not dh2(product(order))
}


def exercise(given):
    """The exercise with these numbers."""
    LINK, lean, orders = given.LINK, given.lean, list(permutations(given.steps))
    pushed = given.frames[given.order.index("DH2 fails")]
    return Exercise(
        name="one_link",
        title="One link",
        arm=link("classic", CLASSIC)(*LINK.values()),
        parts=[
            formula("A_sym", "The classic link matrix", 2, "classic", CLASSIC, "sec-classic-product"),
            function("classic_link", "The same as a function", 2, "classic", CLASSIC, "sec-classic-product"),
            formula("B_sym", "The modified link matrix", 2, "modified", MODIFIED, "sec-modified-product"),
            function("modified_link", "The same as a function", 2, "modified", MODIFIED, "sec-modified-product"),
            Part(
                "factor",
                "A wrong factor",
                1,
                Choice(
                    {place: STANDS[k] if k != given.wrong else AMISS[k] for k, place in enumerate(PLACES)},
                    right=PLACES[given.wrong],
                ),
                section="sec-modified-slip",
            ),
            origin(given.wrong),
            measured(
                LINK,
                "angles",
                "Two angles, read off",
                ("theta", "alpha"),
                2e-3,
                [
                    Trap(
                        "These are degrees; radians are asked for.",
                        constant(np.rad2deg([LINK["theta"], LINK["alpha"]])),
                        "degrees",
                    ),
                    Trap("The two angles are exchanged: θ first, then α.", constant([LINK["alpha"], LINK["theta"]])),
                    Trap(
                        "θ lies in the wrong quadrant: arctan of a quotient cannot tell, arctan2(sine, cosine) can.",
                        constant([LINK["theta"] + np.pi, LINK["alpha"]]),
                    ),
                    Trap(
                        "A cosine alone does not tell the sign of an angle: take its sine too, with arctan2.",
                        constant([-LINK["theta"], LINK["alpha"]]),
                    ),
                    Trap(
                        "A sine alone does not tell an angle: take the cosine too, with arctan2.",
                        constant([-np.pi - LINK["theta"], LINK["alpha"]]),
                    ),
                    Trap(
                        "α has the wrong sign: its sine stands in row 3.",
                        constant([LINK["theta"], -LINK["alpha"]]),
                        "sign",
                    ),
                    Trap("Both angles have the wrong sign.", constant([-LINK["theta"], -LINK["alpha"]])),
                ],
            ),
            measured(
                LINK,
                "lengths",
                "Two lengths, read off",
                ("d", "a"),
                0.1,
                [
                    Trap(
                        "The two lengths are exchanged: d goes along z, a along x.",
                        constant([LINK["a"], LINK["d"]]),
                        "a_and_d",
                    ),
                    Trap(
                        "a has the wrong sign: the position is (a cos θ, a sin θ, d), with the θ of the rotation.",
                        constant([LINK["d"], -LINK["a"]]),
                        "sign",
                    ),
                    Trap(
                        "This a is the x coordinate of the origin; a is measured along the new x.",
                        constant([LINK["d"], LINK["a"] * np.cos(LINK["theta"])]),
                    ),
                    Trap(
                        "This a is the y coordinate of the origin; a is measured along the new x.",
                        constant([LINK["d"], LINK["a"] * np.sin(LINK["theta"])]),
                    ),
                    Trap(
                        "This a is the distance of the origins; the part of it along z is d.",
                        constant([LINK["d"], np.hypot(LINK["a"], LINK["d"])]),
                    ),
                ],
            ),
            *(
                conditions(f"pair_{k}", f"Frames, {word} pair", kind, PAIRS[kind])
                for k, (word, kind) in enumerate(
                    zip(("first", "second", "third", "fourth"), given.order, strict=True), 1
                )
            ),
            conditions(
                "again_modified",
                "One pair once more",
                given.modified,
                MODIFIED_PAIRS[given.modified],
                section="sec-modified-check",
            ),
            number(
                "tilt",
                "By how much DH1 fails",
                np.rad2deg(lean),
                "sec-classic-dh1",
                [
                    (lean, "This is in radians; degrees are asked for.", "degrees"),
                    (np.sin(lean), "This is the entry r31, the sine of the angle; asked for is the angle, in degrees."),
                    (
                        90 + np.rad2deg(lean),
                        "This is the angle between x1 and z0; asked for is by how much it is off 90°.",
                    ),
                    (
                        90 - np.rad2deg(lean),
                        "This is the angle between x1 and z0; asked for is by how much it is off 90°.",
                    ),
                ],
                tolerance=0.05,
            ),
            number(
                "miss",
                "By how much DH2 fails",
                given.aside,
                "sec-classic-dh2",
                [
                    (
                        np.hypot(given.aside, given.out),
                        "This is how far the origin of {1} is from z0; x1 as a line comes closer to it.",
                    ),
                    (
                        float(np.linalg.norm(pushed[:3, 3])),
                        "This is the distance of the origins; asked for is that of the lines.",
                    ),
                    (
                        given.up,
                        "This is the height of the origin; asked for is the distance of the lines of x1 and z0.",
                    ),
                    (
                        given.out,
                        "This is how far the origin is from the normal, along x1; asked for is the normal itself.",
                    ),
                ],
                tolerance=0.1,
            ),
            Part(
                "obeys",
                "Which of the 24 orders",
                3,
                Numbers(constant(ones(both, orders)), shape=(24,), at=()),
                section="sec-classic-orders",
                traps=[
                    Trap("Here DH1 alone is tested; DH2 has to hold too.", constant(ones(dh1, orders))),
                    Trap("Here DH2 alone is tested; DH1 has to hold too.", constant(ones(dh2, orders))),
                    Trap(
                        "One condition is enough here; both have to hold.",
                        constant(ones(lambda A: dh1(A) or dh2(A), orders)),
                    ),
                    Trap(
                        "Here 1 and 0 are exchanged: 1 stands for an order that obeys both.",
                        constant(1 - ones(both, orders)),
                    ),
                    Trap(
                        "These are the orders that obey the conditions of the modified convention.",
                        constant(ones(modified_both, orders)),
                        "convention",
                    ),
                    Trap(
                        "Only one order is found, and some steps may change places without changing the product.",
                        constant(np.array([float(order == ("Rz", "Tz", "Tx", "Rx")) for order in orders])),
                    ),
                    Trap(
                        "One order is missing: Tx and Tz may change places too, where no turn stands between them.",
                        constant(np.array([float({*order[:2]} == {"Rz", "Tz"}) for order in orders])),
                    ),
                ],
            ),
            number(
                "products",
                "How many matrices",
                8,
                "sec-classic-orders",
                [
                    (24, "That is how many orders there are: many of them give the same matrix."),
                    (5, "That is how many orders give the classic link matrix; now count different matrices."),
                    (20, "Only the classic five are counted as one here: other orders have equal products too."),
                    (12, "Neighbours about one axis may change places, and so may Tx and Tz when they are neighbours."),
                    (2, "There are more than the two conventions: compare all products at random values."),
                ],
            ),
            choice(
                "exception",
                "One condition alone",
                next(order for order in given.four if order in ONE_OF_TWO),
                {order: (ONE_OF_TWO | NEITHER)[order] for order in given.four},
                "sec-classic-orders",
            ),
        ],
    )


EXERCISE = exercise(DEFAULT)
