"""The common normal of two lines, and how they lie."""

import math

import numpy as np
import pytest

from dhlib import Axis
from dhlib.normals import across, common_normal, foot


def random_line(rng):
    return Axis(rng.uniform(-2, 2, 3), rng.normal(size=3))


def test_nothing_is_shorter():
    rng = np.random.default_rng(1)
    for _ in range(200):
        first, second = random_line(rng), random_line(rng)
        normal = common_normal(first, second)
        assert normal.kind == "skew"
        assert abs(normal.x @ first.direction) < 1e-13
        assert abs(normal.x @ second.direction) < 1e-13
        assert normal.after - normal.before == pytest.approx(normal.length * normal.x, abs=1e-12)
        assert foot(first, normal.before) == pytest.approx(normal.before, abs=1e-12)
        assert foot(second, normal.after) == pytest.approx(normal.after, abs=1e-12)
        s, t = rng.normal(size=(2, 50, 1))
        others = (first.point + s * first.direction) - (second.point + t * second.direction)
        assert np.linalg.norm(others, axis=1).min() >= normal.length - 1e-12


@pytest.mark.parametrize(
    ("point", "direction", "kind", "length"),
    [
        ([0, 3, 7], [1, 0, 0], "skew", 3),
        ([0, 0, 7], [1, 0, 1], "intersecting", 0),
        ([3, 4, 7], [0, 0, 2], "parallel", 5),
        ([3, 4, 7], [0, 0, -2], "antiparallel", 5),
        ([0, 0, 7], [0, 0, 2], "coincident", 0),
        ([0, 0, 7], [0, 0, -2], "coincident", 0),
    ],
)
def test_how_lines_lie(point, direction, kind, length):
    normal = common_normal(Axis([0, 0, 1], [0, 0, 1]), Axis(point, direction))
    assert (normal.kind, normal.length) == (kind, length)
    assert normal.x[2] == 0
    assert np.linalg.norm(normal.x) == pytest.approx(1)


def test_how_lines_lie_is_seen_through_rounding():
    """Where a line is given from does not change how it lies."""
    rng = np.random.default_rng(2)
    for _ in range(200):
        first = random_line(rng)
        side = across(first.direction)
        slanted = Axis(first.point + 3 * (first.direction + side), first.direction + side)
        assert common_normal(first, slanted).kind == "intersecting"
        moved = Axis(first.point + 3 * first.direction, -0.7 * first.direction)
        assert common_normal(first, moved).kind == "coincident"
        abreast = Axis(moved.point + side, moved.direction)
        assert common_normal(first, abreast).kind == "antiparallel"
        assert (
            common_normal(first, Axis(slanted.point + 1e-9 * np.cross(first.direction, side), slanted.direction)).kind
            == "skew"
        )
        assert common_normal(first, Axis(first.point, first.direction + 1e-7 * side)).kind == "intersecting"
        assert common_normal(first, Axis(abreast.point, first.direction + 1e-9 * side)).kind == "parallel"


def test_angle_has_no_sense():
    for angle in (0.3, math.pi - 0.3):
        line = Axis([1, 0, 0], [0, math.sin(angle), math.cos(angle)])
        assert common_normal(Axis([0, 0, 0], [0, 0, 1]), line).angle == pytest.approx(0.3)
