"""What robots.py says of each arm, and how the tables of one arm hang together."""

import numpy as np
import pytest
from arms import EVERY_ROBOT
from numpy.testing import assert_allclose, assert_array_equal

from dhlib import Chain, Tz, robots

Q = np.random.default_rng(4).uniform(-2, 2, (6, 6))


def with_lengths(chain, **lengths):
    """The chain with parameters such as d3 or a2 (of row 3, row 2) replaced."""
    joints = list(chain.joints)
    for name, value in lengths.items():
        row = int(name[1:]) - 1
        joints[row] = joints[row].replace(**{name[0]: value})
    return Chain(joints, chain.convention, base=chain.base, tool=chain.tool)


def turned(*degrees):
    return np.deg2rad(degrees)


def test_corke_and_craig():
    corke = robots.puma560("classic", "corke")
    assert_allclose(corke.fk(Q), robots.puma560().fk(Q + turned(180, 180, 0, 0, 0, 0)), atol=1e-14)


def test_fu_gonzalez_lee_and_craig():
    craig = with_lengths(robots.puma560(), a4=0.02032, d3=0.14909, d4=0.43307)
    other = craig.fk(Q + turned(0, 0, -180, 0, 0, 180)) @ Tz(0.05625)
    assert_allclose(robots.puma560("classic", "fgl").fk(Q), other, atol=1e-14)


def test_armstrong_khatib_burdick_and_craig():
    craig = with_lengths(robots.puma560(), a4=0.0203, d3=0.2435 - 0.0934, d4=0.4331)
    assert_allclose(robots.puma560(source="akb").fk(Q), craig.fk(Q + turned(0, 0, -180, 0, 0, 180)), atol=1e-14)


def test_the_relations_can_fail():
    craig = robots.puma560()
    assert not np.allclose(robots.puma560("classic", "corke").fk(Q), craig.fk(Q))


def test_pa10_6c_is_the_7c_with_s3_locked():
    seven = robots.pa10_7c().fk(np.insert(Q, 2, 0.0, axis=1))
    assert_allclose(robots.pa10_6c().fk(Q), seven, atol=1e-14)


@pytest.mark.parametrize(("lengths", "height"), [("A", 1.317), ("B", 1.345), ("B2", 1.350)])
def test_pa10_stands_straight_up(lengths, height):
    assert_allclose(robots.pa10_7c(lengths=lengths).fk([0] * 7)[:3, 3], [0, 0, height], atol=1e-15)


def test_quickshot_of_the_lecture():
    arm = robots.quickshot()
    assert_array_equal(arm.fk([0, 0, 0, 0])[:3, 3], [180, 28, 350])
    assert_array_equal(arm.fk([0, -np.pi / 2, np.pi / 2, 0])[:3, 3], [20, 28, 510])


@pytest.mark.parametrize("make", [getattr(robots, name) for name in robots.__all__], ids=list(robots.__all__))
def test_both_conventions_describe_the_same_poses(make):
    one, other = make(convention="classic"), make(convention="modified")
    assert (one.convention, other.convention) == ("classic", "modified")
    q = np.random.default_rng(9).uniform(-2, 2, (5, one.n))
    assert_allclose(one.fk(q), other.fk(q), atol=1e-12 * one.reach)


def test_limits_follow_the_zeros_of_the_source():
    """A pose at a limit is the same pose in every source's table, up to the lengths."""
    corke = [joint.limits for joint in robots.puma560("classic", "corke").joints]
    assert_allclose(np.rad2deg(corke[1]), [-45, 225])
    craig = [joint.limits for joint in robots.puma560().joints]
    shift = turned(180, 180, 0, 0, 0, 0)
    for (low, high), (own_low, own_high), by in zip(corke, craig, shift, strict=True):
        assert_allclose(own_high - own_low, high - low)
        assert_allclose(np.cos(own_low), np.cos(low + by), atol=1e-12)
        assert_allclose(np.sin(own_low), np.sin(low + by), atol=1e-12)


@pytest.mark.parametrize("name", EVERY_ROBOT)
def test_docstrings_name_a_source(name):
    for make in (getattr(robots, name) for name in robots.__all__):
        assert "Notes" in make.__doc__
        assert "Parameters" in make.__doc__
