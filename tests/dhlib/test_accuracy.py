"""Against arithmetic with 50 digits, written independently of dhlib."""

import mpmath
import numpy as np
import pytest
from arms import EVERY_ROBOT

from dhlib.scalars import quarter_turns

mpmath.mp.dps = 50


def angle(value):
    """The angle that is meant: a multiple of π/2 where the float is one."""
    quarters = quarter_turns(value)
    return mpmath.mpf(value) if quarters is None else quarters * mpmath.pi / 2


def link(theta, d, a, alpha, convention):
    c, s, ca, sa = mpmath.cos(theta), mpmath.sin(theta), mpmath.cos(alpha), mpmath.sin(alpha)
    about_z = mpmath.matrix([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])
    about_x = mpmath.matrix([[1, 0, 0, a], [0, ca, -sa, 0], [0, sa, ca, 0], [0, 0, 0, 1]])
    return about_z * about_x if convention == "classic" else about_x * about_z


def pose(chain, q):
    product = mpmath.matrix(chain.base.tolist())
    for joint, value in zip(chain.joints, q, strict=True):
        turn, slide = (mpmath.mpf(value), 0) if joint.kind == "R" else (0, mpmath.mpf(value))
        theta, d = angle(joint.theta) + joint.sign * turn, mpmath.mpf(joint.d) + joint.sign * slide
        product *= link(theta, d, mpmath.mpf(joint.a), angle(joint.alpha), chain.convention)
    return product * mpmath.matrix(chain.tool.tolist())


def worst(chain, q, computed):
    exact = pose(chain, q)
    errors = np.array([[abs(float(computed[i, j] - exact[i, j])) for j in range(4)] for i in range(3)])
    return errors[:, :3].max(), errors[:, 3].max() / chain.reach


@pytest.mark.parametrize("name", EVERY_ROBOT)
def test_fifty_digits(name):
    chain = EVERY_ROBOT[name]
    rng = np.random.default_rng(7)
    several = rng.uniform(-np.pi, np.pi, (40, chain.n))
    compiled = chain.compiled()
    for q, computed, fast in zip(several, chain.fk(several), compiled(several), strict=True):
        for result in (computed, chain.fk(q), fast, compiled(q)):
            rotation, position = worst(chain, q, result)
            assert rotation <= 2e-15
            assert position <= 2e-15


def test_the_check_can_fail():
    chain = EVERY_ROBOT["puma_craig"]
    q = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    rotation, _ = worst(chain, q, chain.fk(q + 1e-14))
    assert rotation > 2e-15


@pytest.mark.parametrize("name", EVERY_ROBOT)
def test_quarter_turns_leave_no_crumbs(name):
    """At quarter turns every rotation entry is 0 or ±1, and no position is a rounding of 0."""
    chain = EVERY_ROBOT[name]
    q = np.random.default_rng(3).integers(-4, 5, (200, chain.n)) * (np.pi / 2)
    compiled = chain.compiled()
    one_by_one = (np.array([fk(row) for row in q]) for fk in (chain.fk, compiled))
    for poses in (chain.fk(q), chain.frames(q), compiled(q), *one_by_one):
        assert np.all(np.isin(poses[..., :3, :3], [-1, 0, 1]))
        positions = np.abs(poses[..., :3, 3])
        assert not np.any((positions > 0) & (positions < 1e-12))
        assert not np.any(np.signbit(poses) & (poses == 0))
