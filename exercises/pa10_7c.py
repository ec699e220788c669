"""What the exercise on the PA10-7C asks, and how it is marked."""

import numpy as np

from dhlib import robots
from dhlib.grading.asking import EXACT, METRES, constant, link_function, pose
from dhlib.grading.exercise import Exercise, Part, Trap
from dhlib.grading.forms import Choice, Formula, Frames, Numbers, Table

ARM = robots.pa10_7c("classic", lengths="A")
b, l1, l2, f = (ARM.joints[k].d for k in (0, 2, 4, 6))

SYMBOLS = [f"theta{i}" for i in range(1, 8)]
JOINTS = np.deg2rad([30, 40, -50, 70, 20, 60, -80])
QUARTERS = np.deg2rad([90, 90, 90, -90, 0, 90, 180])
#: The pose whose elbows are asked for, as the page gives it, comes from these joints; the page does not say so.
HIDDEN = np.deg2rad([25, 40, 30, 75, -20, 50, 10])
GIVEN = np.round(ARM.fk(HIDDEN), 6)

S = np.array([0, 0, b])


def wrist(flange=f, column=2):
    """The wrist centre of the given pose: behind the flange, along a column of it."""
    return GIVEN[:3, 3] - flange * GIVEN[:3, column]


def circle(centre=None, shoulder=S, upper=l1, fore=l2):
    """Distance of the circle's plane from the shoulder, and the circle's radius."""
    distance = np.linalg.norm((wrist() if centre is None else centre) - shoulder)
    along = (distance**2 + upper**2 - fore**2) / (2 * distance)
    return along, np.sqrt(max(upper**2 - along**2, 0))


def highest(sign=1):
    """The highest elbow, or the lowest."""
    w = (wrist() - S) / np.linalg.norm(wrist() - S)
    up = np.array([0, 0, 1]) - w[2] * w
    along, radius = circle()
    return S + along * w + sign * radius * up / np.linalg.norm(up)


EXERCISE = Exercise(
    name="pa10_7c",
    title="The PA10-7C",
    arm=ARM,
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
        Part(
            "T7",
            "T7 in numbers",
            2,
            Numbers(pose(0, 7), at=JOINTS, **METRES),
            section="sec-pa10-product",
            kinematics=False,
        ),
        Part(
            "T7_quarter",
            "T7 at quarter turns",
            1,
            Numbers(pose(0, 7), at=QUARTERS, **METRES),
            section="sec-pa10-product",
            kinematics=False,
        ),
        Part(
            "T04",
            "Shoulder and elbow, in symbols",
            2,
            Formula(pose(0, 4), symbols=SYMBOLS, **EXACT),
            section="sec-pa10-product",
            kinematics=False,
        ),
        Part(
            "upper_arm",
            "Which angles turn the upper arm",
            1,
            Choice(
                {
                    "theta1, theta2": "S3 runs along the upper arm and only rolls it.",
                    "theta1, theta2, theta3": "S3 runs along the upper arm: it rolls it, and its direction stays.",
                    "theta2, theta3": "S1 turns the whole arm, and the upper arm with it.",
                },
                right="theta1, theta2",
            ),
            section="sec-pa10-product",
        ),
        Part(
            "W",
            "The wrist of a given hand",
            1,
            Numbers(constant(wrist()), shape=(3,), at=HIDDEN, tolerance=1e-3),
            section="sec-pa10-redundancy",
            traps=[
                Trap("The wrist lies behind the flange, against the approach vector a.", constant(wrist(-f))),
                Trap("The way back is along a, the third column, and not along n.", constant(wrist(column=0))),
                Trap("The way back is along a, the third column, and not along o.", constant(wrist(column=1))),
                Trap("This is the position of the flange; the wrist lies f behind it.", constant(wrist(0.0))),
            ],
        ),
        Part(
            "radius",
            "The elbow circle",
            2,
            Numbers(constant(circle()[1]), shape=(), at=HIDDEN, tolerance=1e-3),
            section="sec-pa10-redundancy",
            traps=[
                Trap("This is how far the plane of the circle is from the shoulder.", constant(circle()[0])),
                Trap("This is the diameter; the radius is asked for.", constant(2 * circle()[1])),
                Trap(
                    "This is how far the plane of the circle is from the wrist.",
                    constant(circle(upper=l2, fore=l1)[0]),
                ),
                Trap(
                    "The triangle stands on the shoulder, which is b above the foot.",
                    constant(circle(shoulder=0 * S)[1]),
                ),
                Trap(
                    "The triangle ends at the wrist, and not at the flange.", constant(circle(centre=GIVEN[:3, 3])[1])
                ),
            ],
        ),
        Part(
            "E",
            "The highest elbow",
            2,
            Numbers(constant(highest()), shape=(3,), at=HIDDEN, tolerance=1e-3),
            section="sec-pa10-redundancy",
            traps=[
                Trap("This is the lowest elbow on the circle.", constant(highest(-1))),
                Trap("This is the centre of the circle; the elbow is one radius away from it.", constant(highest(0))),
                Trap("The circle is found from the shoulder: its height b is missing.", constant(highest() - S)),
            ],
        ),
        Part(
            "redundant",
            "What is left over",
            1,
            Choice(
                {
                    "S3 alone can turn": "turning S3 alone moves the forearm, and the hand with it.",
                    "all joints turn together": "one keeps its angle: it sets the distance from shoulder to wrist.",
                    "all but E1 turn together": "E1 sets the distance from shoulder to wrist, and that stays.",
                },
                right="all but E1 turn together",
            ),
            section="sec-pa10-redundancy",
        ),
        Part(
            "lengths",
            "Which set of lengths",
            2,
            Choice(
                {
                    "A": "with set A the flange is 32 mm from where it was measured.",
                    "B": "set B comes near, but its flange is 5 mm too short.",
                    "B2": "the position by set B2 agrees with the measured one to the last digit.",
                },
                right="B2",
            ),
            section="sec-pa10-lengths",
        ),
    ],
)
