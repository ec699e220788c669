import numpy as np
import pytest
import sympy
from arms import EVERY_ROBOT, random_chain
from numpy.testing import assert_allclose

from dhlib import Chain, DHError, Prismatic, Revolute, robots
from dhlib.symbolic import joint_symbols, short_names

CHAINS = {
    **EVERY_ROBOT,
    **{f"{c}{k}": random_chain(np.random.default_rng([k, 5]), c) for c in ("classic", "modified") for k in range(20)},
}


def bare(chain):
    return Chain(chain.joints, chain.convention)


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("convention", ["classic", "modified"])
def test_equals_the_product(name, convention):
    chain = CHAINS[name].to_classic() if convention == "classic" else CHAINS[name].to_modified()
    q = np.random.default_rng(2).uniform(-3, 3, chain.n)
    varied = [joint.sign * value + joint.offset for joint, value in zip(chain.joints, q, strict=True)]
    values = sympy.lambdify([joint_symbols(chain)], chain.symbolic())(varied)
    assert_allclose(values, bare(chain).fk(q), atol=1e-12 * max(1, chain.reach))


def terms(chain):
    T = chain.symbolic(short=True)
    return {str(symbol) for symbol in T.free_symbols}


def test_parallel_neighbours_only_appear_as_sums():
    assert {"C2", "S2", "C23", "S23"} <= terms(robots.puma560())
    assert not {"C3", "S3"} & terms(robots.puma560())
    assert terms(robots.planar(3)) >= {"C123", "S123"}


def test_antiparallel_neighbours_appear_as_differences():
    assert {"C12m4", "S12m4"} <= terms(robots.cobra600())


def test_an_angle_that_is_no_sum_of_joint_angles_keeps_its_name():
    slide = Chain([Prismatic(theta=0.5, a=1), Revolute(a=1)], "classic")
    assert sympy.cos(sympy.Symbol("theta2") + 0.5) in slide.symbolic(short=True).atoms(sympy.cos)
    assert terms(slide) == {"d1", "theta2"}
    theta1 = sympy.Symbol("theta1")
    assert {str(short) for short in short_names(sympy.cos(2 * theta1) + sympy.sin(theta1)).values()} == {"S1"}


def test_puma_in_the_form_of_the_books():
    """The entries that Craig (1986) prints, with the lengths as symbols."""
    a2, a3, d3, d4 = sympy.symbols("a2 a3 d3 d4")
    C1, S1, C2, S2, C23, S23, C4, S4, C5, S5, C6, S6 = sympy.symbols("C1 S1 C2 S2 C23 S23 C4 S4 C5 S5 C6 S6")
    quarter = sympy.pi / 2
    arm = Chain(
        [
            Revolute(),
            Revolute(alpha=-quarter),
            Revolute(a=a2, d=d3),
            Revolute(a=a3, alpha=-quarter, d=d4),
            Revolute(alpha=quarter),
            Revolute(alpha=-quarter),
        ],
        "modified",
    )
    T = arm.symbolic(short=True)
    assert T[0, 0] == C1 * (C23 * (C4 * C5 * C6 - S4 * S6) - S23 * S5 * C6) + S1 * (S4 * C5 * C6 + C4 * S6)
    assert T[2, 0] == -S23 * (C4 * C5 * C6 - S4 * S6) - C23 * S5 * C6
    assert T[0, 3] == C1 * (a2 * C2 + a3 * C23 - d4 * S23) - d3 * S1
    assert T[1, 3] == S1 * (a2 * C2 + a3 * C23 - d4 * S23) + d3 * C1
    assert T[2, 3] == -a3 * S23 - a2 * S2 - d4 * C23


def test_quickshot_entry_of_the_slides_is_mended():
    C1, S1, C23, C4, S4 = sympy.symbols("C1 S1 C23 C4 S4")
    assert robots.quickshot().symbolic(short=True)[1, 0] == S1 * C23 * C4 + C1 * S4


def test_prismatic_joints_are_lengths():
    arm = Chain([Prismatic(theta=np.pi / 2, a=2), Revolute(d=1)], "classic")
    d1, theta2 = sympy.symbols("d1 theta2")
    T = arm.symbolic()
    assert T[2, 3] == d1 + 1
    assert T[1, 3] == 2
    assert T[0, 0] == -sympy.sin(theta2)


def test_the_offset_is_in_theta():
    arm = Chain([Revolute(a=1, offset=np.pi / 2, sign=-1)], "classic")
    assert arm.symbolic()[0, 3] == sympy.cos(sympy.Symbol("theta1"))
    assert_allclose(arm.compiled()([0.0])[:3, 3], [0, 1, 0], atol=1e-15)


def test_a_chain_with_symbols_is_not_compiled():
    with pytest.raises(DHError, match="needs numbers"):
        Chain([Revolute(a=sympy.Symbol("a1"))], "classic").compiled()


def test_half_angles_are_exact_too():
    arm = Chain([Revolute(alpha=np.pi / 4), Revolute(alpha=np.pi / 3)], "classic")
    assert arm.symbolic().atoms(sympy.Float) == set()
