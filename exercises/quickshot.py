"""What the Quickshot exercise asks, and how it is marked."""

from dataclasses import dataclass

import numpy as np

from dhlib import Chain, Revolute, Rx, Rz, Tx, Ty, Tz
from dhlib.grading.asking import choice, link_function, measured_at, pose, with_gripper
from dhlib.grading.course.sources import lengths, matrix, number, row
from dhlib.grading.exercise import Exercise, Follows, Part, Trap
from dhlib.grading.forms import Formula, Frames, Numbers, Table
from dhlib.grading.pictures import described, same_for_all

#: The first column of T4, with its bracket left out, and the bracket that belongs there.
PRINTED = {
    "n_x": "cos(theta1) * cos(theta4) * {} - sin(theta1) * sin(theta4)",
    "n_y": "sin(theta1) * cos(theta4) * {} + cos(theta1) * sin(theta4)",
    "n_z": "-cos(theta4) * {}",
}
BRACKETS = {"n_x": "C23", "n_y": "C23", "n_z": "S23"}


def other(bracket):
    """The sine for the cosine, and the other way round."""
    return {"C23": "S23", "S23": "C23"}[bracket]


@dataclass(frozen=True)
class Given:
    """The numbers of the task: lengths in mm, angles in degrees."""

    height: float = 100
    ahead: float = 20
    upper_arm: float = 160
    aside: float = 28
    forearm: float = 250
    angles: tuple[float, ...] = (30, -50, 70, 20)
    corner: tuple[float, ...] = (300, -150, 720)
    gripper: float = 90
    tilt: float = -30
    #: The pose of the last part comes from these joints; the page does not say so.
    hidden: tuple[float, ...] = (40, 25, -65, 110)
    #: Which entry of the printed column holds the bracket of another.
    wrong: str = "n_y"

    @property
    def arm(self):
        joints = [
            Revolute(d=self.height, a=self.ahead, alpha=-np.pi / 2),
            Revolute(a=self.upper_arm),
            Revolute(d=self.aside, alpha=np.pi / 2),
            Revolute(d=self.forearm),
        ]
        return Chain(joints, "classic", name="Quickshot", unit="mm")

    @property
    def brackets(self):
        """The bracket of each entry as it is printed."""
        return {name: other(right) if name == self.wrong else right for name, right in BRACKETS.items()}

    @property
    def in_the_workshop(self):
        """The arm with Z and E as the page gives them."""
        x, y, z = self.corner
        Z = Tx(x) @ Ty(y) @ Tz(z) @ Rz(np.pi / 2)
        E = Tz(self.gripper) @ Rz(np.pi / 2) @ Rx(np.deg2rad(self.tilt))
        return Chain(self.arm.joints, "classic", base=Z, tool=E, name="Quickshot", unit="mm")


DEFAULT = Given()


def draw(lots):
    """Another arm of this kind in another workshop: no length and no angle is that of the book."""
    sizes = lots.some("angles", range(21, 77, 5), 4)  # all different, so that no sum of two is zero
    signs = lots.one("signs", [(1, -1, 1, 1), (-1, -1, 1, 1), (1, 1, -1, -1), (-1, 1, -1, 1), (1, -1, 1, -1)])
    return Given(
        height=lots.one("height", range(82, 140, 4)),
        ahead=lots.one("ahead", range(22, 39, 2)),
        upper_arm=lots.one("upper arm", range(142, 200, 6)),
        aside=lots.one("aside", range(31, 48, 2)),
        forearm=lots.one("forearm", range(212, 290, 6)),
        angles=tuple(sign * size for sign, size in zip(signs, sizes, strict=True)),
        corner=(
            lots.one("x", range(210, 400, 20)),
            -lots.one("y", range(110, 200, 20)),
            lots.one("z", range(670, 800, 20)),
        ),
        gripper=lots.one("gripper", range(64, 120, 8)),
        tilt=lots.one("tilt", [-55, -50, -40, -35, -25, -20]),
        # No sum of theta2 and theta3 is a multiple of 5: no quarter turn hides in it.
        hidden=tuple(
            lots.one(f"hidden {i}", [*range(-last - 100, -last, 10), *range(10 + last, 110 + last, 10)])
            for i, last in enumerate((6, 1, 7, 4), 1)
        ),
        wrong=lots.one("wrong", [name for name in BRACKETS if name != DEFAULT.wrong]),
    )


def cells(given):
    """The given cells of the notebook."""
    measured = measured_at(given.in_the_workshop, np.deg2rad(given.hidden))
    return {
        "arm": lengths(
            "millimetres",
            height=given.height,
            ahead=given.ahead,
            upper_arm=given.upper_arm,
            aside=given.aside,
            forearm=given.forearm,
        ),
        "angles": f"q = np.deg2rad({row(given.angles)})",
        "printed": "\n".join(
            [
                "# The brackets of the slides: cos(theta2 + theta3) and sin(theta2 + theta3), written out",
                "C23 = cos(theta2) * cos(theta3) - sin(theta2) * sin(theta3)",
                "S23 = sin(theta2) * cos(theta3) + cos(theta2) * sin(theta3)",
                "printed = {",
                *(f'    "{name}": {PRINTED[name].format(bracket)},' for name, bracket in given.brackets.items()),
                "}",
            ]
        ),
        "ends": f"""\
# Lengths in millimetres, the tilt in radians
corner = {row(given.corner)}
gripper = {number(given.gripper)}
tilt = np.deg2rad({number(given.tilt)})""",
        "measured": matrix("X_measured", measured, decimals=(4, 4, 4, 2)),
    }


@same_for_all
def figure():
    """The arm that the page describes."""
    outline = Given(height=110, ahead=45, upper_arm=170, aside=70, forearm=200)
    return described(
        outline.arm,
        "The arm at its zero pose, not to scale: its joint axes, and the base frame {0}",
        "Axis 1 rises from the origin of frame 0. Axes 2 and 3 point to the left, along y0: axis 2 at the height of "
        "the shoulder, a little ahead of axis 1, axis 3 further forward by the upper arm. From there the forearm rises "
        "along axis 4, to the left of the middle plane, and carries the gripper.",
        lengths={"d_1": "height", "a_1": "ahead", "a_2": "upper arm", "d_3": "aside", "d_4": "forearm"},
    )


SYMBOLS = ["theta1", "theta2", "theta3", "theta4"]
QUARTERS = np.deg2rad([90, -90, 180, -90])

LINKS = ("A1", "A2", "A3", "A4")
PRODUCT = Follows(LINKS, lambda A1, A2, A3, A4: A1 @ A2 @ A3 @ A4)
FORMULAS = Follows([f"{link}_sym" for link in LINKS], lambda A1, A2, A3, A4: A1 @ A2 @ A3 @ A4)


def entry(name, bracket):
    """An entry of the first column, with one bracket or the other of some sum of angles."""

    def quantity(arm, q):
        s, c, held = np.sin(q), np.cos(q), bracket(q)
        return {
            "n_x": c[0] * c[3] * held - s[0] * s[3],
            "n_y": s[0] * c[3] * held + c[0] * s[3],
            "n_z": -c[3] * held,
        }[name]

    return quantity


def mending(name):
    """The part that asks for the entry that is printed wrongly."""
    right = BRACKETS[name]
    of, wave = {
        "C23": (np.cos, "cos(α + β) = cos α cos β − sin α sin β"),
        "S23": (np.sin, "sin(α + β) = sin α cos β + cos α sin β"),
    }[right]
    misprint = np.sin if of is np.cos else np.cos
    mate = {"n_x": "n_y", "n_y": "n_x"}.get(name)
    if mate:
        says = f"This is {mate}: turning the base by a quarter turn makes the one into the other."
        confused = Trap(says, entry(mate, lambda q: of(q[1] + q[2])))
    else:
        confused = Trap("n_z has the other sign: θ2 and θ3 lower the arm.", entry(name, lambda q: -of(q[1] + q[2])))
    return Part(
        "mended",
        "Mend the slip",
        2,
        Formula(lambda arm, q: arm.T(0, 4, q)["xyz".index(name[-1]), 0], shape=(), symbols=SYMBOLS),
        section="sec-quickshot-slip",
        traps=[
            Trap(
                f"This is the entry as it is printed. Its bracket is {other(right)}; which sum belongs there?",
                entry(name, lambda q: misprint(q[1] + q[2])),
            ),
            confused,
            Trap(
                f"The bracket is {right} with a plus sign between the angles; {wave}.",
                entry(name, lambda q: of(q[1] - q[2])),
            ),
        ],
        kinematics=False,
    )


def slip(name):
    """The part that asks which entry it is."""
    because = {
        each: "the printed n has not the length 1, and the other two entries agree with the product."
        if each == name
        else f"{each} is right as printed: compare it with your own T4, entry by entry."
        for each in BRACKETS
    }
    return choice("slip", "Find the slip", name, because, "sec-quickshot-slip")


def exercise(given):
    """The exercise with these numbers."""
    bare, arm, at = given.arm, given.in_the_workshop, np.deg2rad(given.angles)
    return Exercise(
        name="quickshot",
        title="The Quickshot",
        arm=arm,
        parts=[
            Part("frames", "Place the frames", 3, Frames("classic", count=5), section="sec-quickshot-frames", arm=bare),
            Part("table", "Write the table", 4, Table("classic"), section="sec-quickshot-table", arm=bare),
            *(
                Part(
                    link,
                    f"{link} in numbers",
                    1,
                    Numbers(pose(i - 1, i), at=at),
                    section="sec-quickshot-links",
                    kinematics=False,
                )
                for i, link in enumerate(LINKS, 1)
            ),
            *(
                Part(
                    f"{link}_sym",
                    f"{link} in symbols",
                    1,
                    Formula(pose(i - 1, i), symbols=SYMBOLS),
                    section="sec-quickshot-links",
                    kinematics=False,
                )
                for i, link in enumerate(LINKS, 1)
            ),
            Part(
                "link",
                "Any link, as a function",
                2,
                link_function(4, seed=4, length_tolerance=1e-3),
                section="sec-classic-product",
                kinematics=False,
            ),
            Part(
                "T4",
                "T4 in numbers",
                2,
                Numbers(pose(0, 4), at=at),
                section="sec-quickshot-product",
                follows=PRODUCT,
                kinematics=False,
            ),
            Part(
                "T4_quarter",
                "T4 at quarter turns",
                1,
                Numbers(pose(0, 4), at=QUARTERS),
                section="sec-quickshot-product",
                kinematics=False,
            ),
            Part(
                "T4_sym",
                "T4 in symbols",
                3,
                Formula(pose(0, 4), symbols=SYMBOLS),
                section="sec-quickshot-product",
                follows=FORMULAS,
                kinematics=False,
            ),
            slip(given.wrong),
            mending(given.wrong),
            *with_gripper(arm, "T4", ("Base and tool", "Back from X"), at, np.deg2rad(given.hidden)),
        ],
    )


EXERCISE = exercise(DEFAULT)
