"""The arm of two links, as dhlib's graders are asked to mark it."""

import numpy as np

from dhlib import Chain, Revolute
from dhlib.grading.exercise import Exercise, Part
from dhlib.grading.forms import Function, Numbers

ARM = Chain([Revolute(a=0.7), Revolute(a=0.4)], "classic", name="Two links")
Q = (0.3, -0.8)
CALLS = [(tuple(q),) for q in np.random.default_rng(2).uniform(-3, 3, (5, 2))]


def hand(arm, q):
    """Where the hand is."""
    return arm.fk(q)[:2, 3]


EXERCISE = Exercise(
    name="two_links",
    title="Two links",
    arm=ARM,
    parts=[
        Part("p", "Where is the hand?", 1, Numbers(hand, at=Q, shape=(2,), tolerance=1e-3)),
        Part("A1", "The first link matrix", 1, Numbers(lambda arm, q: arm.A(1, q), at=Q, length_tolerance=1e-3)),
        Part("T", "The product", 1, Numbers(lambda arm, q: arm.T(0, 2, q), at=Q, length_tolerance=1e-3)),
        Part("fk", "As a function", 1, Function(hand, calls=CALLS, shape=(2,), signature="fk(q)")),
    ],
)
