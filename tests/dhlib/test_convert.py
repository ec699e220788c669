import numpy as np
import pytest
from arms import EVERY_ROBOT, random_chain
from numpy.testing import assert_allclose

from dhlib import robots

CHAINS = {
    **EVERY_ROBOT,
    **{f"{c}{k}": random_chain(np.random.default_rng([k, 11]), c) for c in ("classic", "modified") for k in range(20)},
}


@pytest.mark.parametrize("name", CHAINS)
def test_same_pose_for_the_same_q(name):
    chain = CHAINS[name]
    q = np.random.default_rng(1).uniform(-3, 3, (20, chain.n))
    for other in (chain.to_classic(), chain.to_modified()):
        assert_allclose(other.fk(q), chain.fk(q), atol=1e-12 * max(1, chain.reach))
        assert_allclose(other.frames(q)[:, -1] @ other.tool, chain.fk(q), atol=1e-12 * max(1, chain.reach))


@pytest.mark.parametrize("name", CHAINS)
def test_and_back_to_the_very_same_rows(name):
    chain = CHAINS[name]
    back = chain.to_modified().to_classic() if chain.convention == "classic" else chain.to_classic().to_modified()
    assert back == chain
    assert back.joints == chain.joints
    assert np.array_equal(back.base, chain.base)
    assert np.array_equal(back.tool, chain.tool)
    twice = back.to_modified().to_classic().to_modified()
    assert twice == chain.to_modified()


def test_columns_move_down_and_the_last_link_goes_to_the_tool():
    other = robots.planar(2).to_modified()
    assert [joint.a for joint in other.joints] == [0, 1]
    assert other.tool[0, 3] == 1


def test_what_stands_before_the_first_joint_goes_to_the_base():
    chain = CHAINS["modified3"]
    first = chain.joints[0]
    assert (first.a, first.alpha) != (0, 0), "the example needs a first link"
    assert not np.allclose(chain.to_classic().base, chain.base)


def test_the_same_table_in_the_other_convention_is_another_arm():
    """The check can fail: exchanging the word 'classic' for 'modified' is not converting."""
    from dhlib import Chain

    chain = robots.quickshot()
    q = [0.3, 0.5, 0.7, 0.2]
    assert not np.allclose(Chain(chain.joints, "modified").fk(q), chain.fk(q))
