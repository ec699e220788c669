import numpy as np
import pytest
import sympy
from arms import EVERY_ROBOT, random_chain
from numpy.testing import assert_allclose, assert_array_equal

from dhlib import Chain, Prismatic, Revolute, Tz, inverse, robots
from dhlib.axes import product_of_exponentials

CHAINS = [
    random_chain(np.random.default_rng([seed, k]), convention)
    for k, convention in enumerate(("classic", "modified"))
    for seed in range(25)
]


def repr_name(chain):
    return f"{chain.convention}-{chain.kinds}"


def some_q(chain, *shape, seed=0):
    return np.random.default_rng(seed).uniform(-3, 3, (*shape, chain.n))


@pytest.mark.parametrize("chain", CHAINS, ids=repr_name)
def test_all_ways_to_the_end_agree(chain):
    q = some_q(chain)
    product = chain.base
    for i in range(1, chain.n + 1):
        product = product @ chain.A(i, q)
    end = product @ chain.tool
    assert_allclose(chain.fk(q), end, atol=1e-13)
    assert_allclose(chain.fk(q[None])[0], end, atol=1e-13)
    assert_allclose(chain.base @ chain.T(0, chain.n, q) @ chain.tool, end, atol=1e-13)
    assert_allclose(chain.frames(q)[-1] @ chain.tool, end, atol=1e-13)
    assert_allclose(chain.compiled()(q), end, atol=1e-13)
    assert_allclose(product_of_exponentials(chain.axes(), chain.fk(np.zeros(chain.n)), q), end, atol=1e-12)
    symbols = list(sympy.symbols(f"q1:{chain.n + 1}"))
    in_symbols = sympy.lambdify([symbols], chain.fk(symbols), cse=True)(q)
    assert_allclose(in_symbols, end, atol=1e-12)


@pytest.mark.parametrize("chain", CHAINS[::4], ids=repr_name)
def test_frames_are_the_partial_products(chain):
    q = some_q(chain, 3)
    frames = chain.frames(q)
    assert frames.shape == (3, chain.n + 1, 4, 4)
    assert_array_equal(frames[:, 0], np.broadcast_to(chain.base, (3, 4, 4)))
    for i in range(chain.n):
        assert_allclose(frames[:, i] @ chain.A(i + 1, q), frames[:, i + 1], atol=1e-13)
        assert_allclose(inverse(chain.base) @ frames[:, i], chain.T(0, i, q), atol=1e-13)


def test_any_leading_shape():
    arm = robots.puma560()
    q = some_q(arm, 2, 3)
    assert arm.fk(q).shape == (2, 3, 4, 4)
    assert arm.frames(q).shape == (2, 3, 7, 4, 4)
    assert arm.A(2, q).shape == arm.T(1, 4, q).shape == arm.T(2, 2, q).shape == (2, 3, 4, 4)
    assert arm.fk(np.empty((0, 6))).shape == (0, 4, 4)
    for index in np.ndindex(2, 3):
        assert_allclose(arm.fk(q)[index], arm.fk(q[index]), atol=1e-15)


def test_large_batches_are_the_same_as_single_calls():
    arm = robots.puma560(source="corke")
    q = some_q(arm, 9000)
    poses = arm.fk(q)
    for k in (0, 4095, 4096, 8999):
        assert_allclose(poses[k], arm.fk(q[k]), atol=1e-15)


def test_relative_poses_run_both_ways():
    arm = robots.puma560()
    q = some_q(arm)
    assert_allclose(arm.T(1, 5, q) @ arm.T(5, 1, q), np.eye(4), atol=1e-14)
    assert_array_equal(arm.T(3, 3, q), np.eye(4))


def test_axes_point_where_the_joint_turns():
    arm = Chain([Revolute(alpha=np.pi / 2, sign=-1), Prismatic(offset=1)], "classic", base=Tz(2))
    first, second = arm.axes()
    assert_array_equal(first.direction, [0, 0, -1])
    assert_array_equal(first.point, [0, 0, 2])
    assert (first.kind, second.kind) == ("R", "P")
    assert_array_equal(second.direction, [0, -1, 0])


def test_symbolic_parameters():
    a1, a2, q1, q2 = sympy.symbols("a1 a2 q1 q2")
    arm = Chain([Revolute(a=a1), Revolute(a=a2)], "classic")
    end = arm.fk([q1, q2])
    assert sympy.simplify(end[0, 3] - a1 * sympy.cos(q1) - a2 * sympy.cos(q1 + q2)) == 0
    assert arm.fk([0, sympy.pi / 2])[1, 3] == a2
    assert arm.fk([0.0, 0.0])[0, 3] == a1 + a2
    assert len(arm.frames([q1, q2])) == 3
    assert arm.T(0, 0, [q1, q2]) == sympy.eye(4)


def test_exact_numbers_among_symbols():
    arm = robots.quickshot()
    theta = sympy.Symbol("theta")
    end = arm.fk([theta, 0, 0, 0])
    assert end[0, 3] == 180 * sympy.cos(theta) - 28 * sympy.sin(theta)
    assert all(entry.atoms(sympy.Float) == set() for entry in end)


def test_ends_are_not_shared():
    arm = robots.panda()
    arm.tool[:] = 0
    assert arm.tool[2, 3] == 0.107


def test_equality_is_of_rows_and_ends():
    assert robots.quickshot() == robots.quickshot()
    assert robots.quickshot() != robots.quickshot("modified")
    assert robots.panda() != Chain(robots.panda().joints, "modified")
    assert (robots.planar(2) == "planar") is False


@pytest.mark.parametrize("name", EVERY_ROBOT)
def test_reach_bounds_the_arm(name):
    chain = EVERY_ROBOT[name]
    q = some_q(chain, 200) * [1 if kind == "R" else 0 for kind in chain.kinds]
    assert np.linalg.norm(chain.fk(q)[:, :3, 3], axis=1).max() <= chain.reach * (1 + 1e-12)
