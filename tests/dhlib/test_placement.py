"""place_frames: from axes in space to a table that moves as they do.

The witness is the product of exponentials, which knows axes and no DH.
"""

import math
import warnings

import numpy as np
import pytest
from sampling import FULL

from dhlib import (
    Axis,
    Chain,
    DHError,
    DHWarning,
    Revolute,
    Rx,
    Ry,
    Rz,
    Tx,
    Ty,
    Tz,
    check_frames,
    classic,
    inverse,
    modified,
    place_frames,
    read_parameters,
    robots,
)
from dhlib.axes import product_of_exponentials
from dhlib.normals import PARALLEL

CONVENTIONS = ("classic", "modified")
NEIGHBOURS = ("skew", "intersecting", "parallel", "antiparallel", "coincident")
ROBOTS = (
    "quickshot",
    "puma560",
    "pa10_7c",
    "pa10_6c",
    "planar",
    "stanford",
    "cobra600",
    "ur5",
    "panda",
    "iiwa14",
    "irb140",
)
CHAINS = 20_000 if FULL else 1000
N = 4
X, Y, Z = np.eye(3)


def unit(vector):
    return vector / np.linalg.norm(vector)


def across(rng, direction):
    return unit(np.cross(direction, rng.normal(size=3)))


def random_pose(rng):
    x, y, z = rng.uniform(-2, 2, 3)
    return Tx(x) @ Ty(y) @ Tz(z) @ Rz(rng.uniform(-3, 3)) @ Ry(rng.uniform(-3, 3)) @ Rx(rng.uniform(-3, 3))


def neighbour(rng, axis, how):
    """An axis that lies to another as asked; points stand anywhere on the lines, directions have any length."""
    z, on_line = axis.direction, axis.point + rng.uniform(-2, 2) * axis.direction
    side = across(rng, z)
    angle = rng.uniform(0.2, math.pi - 0.2)
    slanted = math.cos(angle) * z + math.sin(angle) * np.cross(side, z)
    point, direction = {
        "skew": (on_line + rng.choice([-1, 1]) * rng.uniform(0.1, 2) * side, slanted),
        "intersecting": (on_line, slanted),
        "parallel": (on_line + rng.uniform(0.1, 2) * side, z),
        "antiparallel": (on_line + rng.uniform(0.1, 2) * side, -z),
        "coincident": (on_line, rng.choice([-1, 1]) * z),
    }[how]
    return Axis(point + rng.uniform(-2, 2) * direction, rng.uniform(0.5, 3) * direction)


def random_arm(rng, how, kinds="R" * N):
    """Axes with one pair of neighbours as asked, somewhere in the arm, and any others; and how all of them lie."""
    lie = list(rng.choice(NEIGHBOURS, N - 1))
    lie[rng.integers(N - 1)] = how
    axes = [Axis(rng.uniform(-2, 2, 3), rng.normal(size=3))]
    for each in lie:
        axes.append(neighbour(rng, axes[-1], each))
    return [Axis(axis.point, axis.direction, kind) for axis, kind in zip(axes, kinds, strict=True)], lie


def error(chain, axes, end, q):
    """How far a chain is from the product of exponentials, relative to the lengths in play."""
    return np.abs(chain.fk(q) - product_of_exponentials(axes, end, q)).max() / max(1, chain.reach)


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("how", [*NEIGHBOURS, "prismatic"])
def test_moves_as_its_axes(how, convention):
    rng = np.random.default_rng([*how.encode(), *convention.encode()])
    worst = 0.0
    for _ in range(CHAINS):
        kinds = "R" * N
        if how == "prismatic":
            kinds = rng.permutation(["P", *rng.choice(["R", "P"], N - 1)])
        axes, lie = random_arm(rng, rng.choice(NEIGHBOURS) if how == "prismatic" else how, kinds)
        end = random_pose(rng)
        chain, choices = place_frames(axes, convention, end=end)
        worst = max(worst, error(chain, axes, end, rng.uniform(-3, 3, N)))
        assert chain.kinds == "".join(kinds)
        found = {choice.number: choice.kind for choice in choices if choice.kind in NEIGHBOURS}
        assert [found.get(i, "skew") for i in range(1, N)] == lie
        for i, each in enumerate(lie, 1):
            link = chain.joints[i - 1] if convention == "classic" else chain.joints[i]
            assert (link.a == 0) == (each in ("intersecting", "coincident"))
            assert link.a >= 0
            assert (link.alpha in (0, math.pi)) == (each not in ("skew", "intersecting"))
            if each in ("parallel", "antiparallel", "coincident"):
                assert chain.joints[i - 1].d == 0
            if each == "coincident" and (i > 1 or convention == "modified"):
                assert chain.joints[i - 1].theta == 0
    assert worst < 2e-14


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_frames_obey_the_rules(convention):
    rng = np.random.default_rng(7)
    for how in NEIGHBOURS:
        for _ in range(20):
            axes, _ = random_arm(rng, how)
            chain, _ = place_frames(axes, convention, end=random_pose(rng))
            frames = chain.frames(np.zeros(N))
            report = check_frames(frames, convention, axes)
            assert report, report
            on_axis = frames[:-1] if convention == "classic" else frames[1:]
            for frame, axis in zip(on_axis, axes, strict=True):
                assert frame[:3, 2] == pytest.approx(axis.direction, abs=1e-14)  # in the sense of q
            assert all(-math.pi < joint.alpha <= math.pi for joint in chain.joints)
            assert all(-math.pi < joint.theta <= math.pi for joint in chain.joints)


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_a_changed_axis_is_seen(convention):
    """The negative control: the comparison fails for an arm that is a little different."""
    rng = np.random.default_rng(8)
    for how in NEIGHBOURS:
        axes, _ = random_arm(rng, how)
        end = random_pose(rng)
        chain, _ = place_frames(axes, convention, end=end)
        q = rng.uniform(0.5, 2, N)
        assert error(chain, axes, end, q) < 1e-13
        for i in range(N):
            moved = list(axes)
            moved[i] = Axis(axes[i].point + 1e-6 * across(rng, axes[i].direction), axes[i].direction)
            assert error(chain, moved, end, q) > 1e-9
            moved[i] = Axis(axes[i].point, -axes[i].direction)
            assert error(chain, moved, end, q) > 1e-3


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("name", ROBOTS)
def test_robots(name, convention):
    arm = getattr(robots, name)(convention=convention)
    chain, _ = place_frames(arm.axes(), convention, end=arm.fk(np.zeros(arm.n)))
    q = np.random.default_rng(9).uniform(-3, 3, (50, arm.n))
    assert np.abs(chain.fk(q) - arm.fk(q)).max() < 5e-15 * max(1, arm.reach)
    assert chain.convention == convention
    assert chain.kinds == arm.kinds
    quarters = [2 * angle / math.pi for joint in chain.joints for angle in (joint.alpha, joint.theta)]
    assert all(turn == round(turn) for turn in quarters)  # exactly
    lengths = [length for joint in chain.joints for length in (joint.a, joint.d)]
    assert all(length == 0 or abs(length) > 1e-3 for length in lengths)


def test_the_quickshot_comes_out_as_printed():
    arm = robots.quickshot()
    chain, choices = place_frames(arm.axes(), end=arm.fk([0, 0, 0, 0]))
    assert chain == arm
    assert [(choice.kind, choice.number) for choice in choices] == [
        ("first frame", 0),
        ("parallel", 2),
        ("intersecting", 3),
        ("last frame", 4),
    ]


def test_the_quickshot_comes_out_as_printed_in_the_other_convention():
    arm = robots.quickshot("modified")
    chain, _ = place_frames(arm.axes(), "modified", end=arm.fk([0, 0, 0, 0]), base=np.eye(4))
    assert chain == arm


def test_a_turned_base_leaves_no_rounding_in_the_table():
    arm = robots.puma560()
    placed = Tx(1.3) @ Ty(-0.7) @ Rz(0.3) @ Rx(1.1) @ Ry(-0.2)
    stood = Chain(arm.joints, arm.convention, base=placed)
    chain, _ = place_frames(stood.axes(), "modified", end=stood.fk(np.zeros(6)))
    for joint, own in zip(chain.joints, arm.joints, strict=True):
        assert (joint.alpha, joint.offset) == (own.alpha, own.offset)
        assert (joint.a, joint.d) == pytest.approx((own.a, own.d), abs=1e-15)
        assert (joint.a == 0) == (own.a == 0)
        assert (joint.d == 0) == (own.d == 0)


# Ends


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_without_an_end_the_last_frame_is_moved_by_its_joint_alone(convention):
    rng = np.random.default_rng(10)
    for kind in "RP":
        axes, _ = random_arm(rng, "skew", "RRR" + kind)
        chain, choices = place_frames(axes, convention)
        frames = chain.frames(np.zeros(N))
        if convention == "classic":
            assert frames[N] == pytest.approx(frames[N - 1], abs=1e-14)
        assert (chain.joints[-1].theta, chain.joints[-1].d) == (0, 0)
        assert np.array_equal(chain.tool, np.eye(4))
        assert choices[-1].kind == "last frame"
        q = rng.uniform(-3, 3, N)
        assert error(chain, axes, chain.fk(np.zeros(N)), q) < 1e-14


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_a_tool_alone_stands_behind_the_last_frame(convention):
    rng = np.random.default_rng(11)
    axes, _ = random_arm(rng, "skew")
    tool = random_pose(rng)
    bare, _ = place_frames(axes, convention)
    chain, _ = place_frames(axes, convention, tool=tool)
    assert np.array_equal(chain.tool, tool)
    assert chain.joints == bare.joints


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_an_end_that_can_be_frame_n_is_frame_n(convention):
    rng = np.random.default_rng(12)
    for _ in range(100):
        axes, _ = random_arm(rng, "skew")
        bare, _ = place_frames(axes, convention)
        theta, d, alpha = rng.uniform(-3, 3, 3)
        a = rng.choice([-1.3, 0, 0.7])
        alpha = rng.choice([alpha, 0, math.pi])
        before = bare.frames(np.zeros(N))[N - 1 if convention == "classic" else N]
        end = before @ (classic(theta, d, a, alpha) if convention == "classic" else modified(0, 0, theta, d))
        chain, choices = place_frames(axes, convention, end=end)
        assert np.array_equal(chain.tool, np.eye(4)), (a, alpha, chain.tool)
        assert str(choices[-1]).endswith("so the tool is the identity.")
        assert error(chain, axes, end, rng.uniform(-3, 3, N)) < 1e-14


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_an_end_and_a_tool(convention):
    rng = np.random.default_rng(13)
    axes, _ = random_arm(rng, "skew")
    bare, _ = place_frames(axes, convention)
    last = bare.frames(np.zeros(N))[N] @ (classic(1, 2, 3, 0.4) if convention == "classic" else Rz(1) @ Tz(2))
    tool = random_pose(rng)
    end = last @ tool
    chain, choices = place_frames(axes, convention, end=end, tool=tool)
    assert np.array_equal(chain.tool, tool)
    assert "last frame" not in {choice.kind for choice in choices}
    assert error(chain, axes, end, rng.uniform(-3, 3, N)) < 1e-14

    reason = "DH1 fails: x_4 .*DH2 fails: x_4 passes z_3" if convention == "classic" else "z_4 is .* off the direction"
    with pytest.raises(DHError, match=f"frame 4 would have to be end · tool⁻¹.*{reason}"):
        place_frames(axes, convention, end=end @ random_pose(rng), tool=tool)


def test_a_base():
    rng = np.random.default_rng(14)
    axes, _ = random_arm(rng, "skew")
    end = random_pose(rng)
    q = rng.uniform(-3, 3, N)
    for convention in CONVENTIONS:
        free = place_frames(axes, convention, end=end).chain
        base = free.base @ (Rz(0.4) @ Tz(-1) if convention == "classic" else inverse(modified(0.3, 0.2, 0.5, -0.7)))
        chain, choices = place_frames(axes, convention, end=end, base=base)
        assert np.array_equal(chain.base, base)
        assert "first frame" not in {choice.kind for choice in choices}
        assert error(chain, axes, end, q) < 1e-14
    assert (chain.joints[0].alpha, chain.joints[0].a) == pytest.approx((0.3, 0.2))

    off = {"classic": "z_0 is .* off the direction of axis 1", "modified": "link 1: DH1 fails: x_0 .* z_1"}
    for convention, reason in off.items():
        with pytest.raises(DHError, match=f"the base cannot be frame 0 of a {convention} table.*{reason}"):
            place_frames(axes, convention, base=random_pose(rng))


def test_a_base_that_points_or_stands_wrong():
    axes = [Axis([0, 0, 0], [0, 0, 1])]
    with pytest.raises(DHError, match="z_0 points against axis 1"):
        place_frames(axes, base=Rx(math.pi))
    with pytest.raises(DHError, match="z_0 passes axis 1 at a distance of 3"):
        place_frames(axes, base=Tx(3))
    assert place_frames(axes, base=Tz(3)).chain.joints[0].d == 0  # frame 1 is frame 0, moved by the joint alone


# One by one


def test_axis_one_along_the_x_axis_of_the_world():
    chain, _ = place_frames([Axis([0, 2, 0], [1, 0, 0])])
    assert np.array_equal(chain.base[:3, :3], np.column_stack([Y, Z, X]))
    assert np.array_equal(chain.base[:3, 3], [0, 2, 0])


def test_antiparallel_twist_is_plus_pi():
    chain, _ = place_frames([Axis([0, 0, 0], [0, 0, 1]), Axis([1, 0, 0], [0, 0, -1])], end=Tx(2))
    assert chain.joints[0].alpha == math.pi
    assert chain.joints[0].a == 1


def test_which_way_x_points_where_axes_intersect():
    axes = [Axis([0, 0, 0], [0, 0, 1]), Axis([0, 0, 1], [0, 1, 0])]
    chain, choices = place_frames(axes)
    assert chain.frames([0, 0])[1, :3, 0] == pytest.approx(X)  # z_0 × z_1 is -x, which is farther from x_0
    assert str(choices[1]).endswith("It is the one nearer to x_0.")
    axes[1] = Axis([0, 0, 1], [1, 0, 0])
    chain, choices = place_frames(axes)
    assert chain.frames([0, 0])[1, :3, 0] == pytest.approx(Y)  # z_0 × z_1
    assert str(choices[1]).endswith("Both turn x_0 by 90°. It is the vector product of the two axes.")


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_nearly_parallel_axes_are_warned_of(convention):
    def pair(angle):
        return [Axis([0, 0, 0], [0, 0, 1]), Axis([1, 0, 0], [0, math.sin(angle), math.cos(angle)], "R")]

    for angle in (1e-4, math.pi - 1e-4):
        with pytest.warns(DHWarning, match="Axes 1 and 2 are nearly parallel: 0.0001 rad apart"):
            _, choices = place_frames(pair(angle), convention)
        assert "nearly parallel" in {choice.kind for choice in choices}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for angle in (0, 2e-3, 1e-9, math.pi / 2, math.pi):
            place_frames(pair(angle), convention)


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.filterwarnings("ignore::dhlib.DHWarning")
def test_what_the_bound_of_parallel_costs(convention):
    """Some √ε at worst, where the rounding of a far foot meets the error of taking axes as parallel.

    Axes that intersect at a small angle cost nothing: their foot is near.
    """
    rng = np.random.default_rng(15)
    for angle in np.logspace(-14, -1, 40):
        for meets in (False, True) * 5:
            first = Axis(rng.uniform(-1, 1, 3), rng.normal(size=3))
            direction = first.direction + math.tan(angle) * across(rng, first.direction)
            through = first.point + rng.uniform(-1, 1) * first.direction if meets else rng.uniform(-1, 1, 3)
            axes = [first, Axis(through + rng.uniform(-1, 1) * direction, rng.choice([-1, 1]) * direction)]
            end = random_pose(rng)
            chain, _ = place_frames(axes, convention, end=end)
            q = rng.uniform(-3, 3, 2)
            worst = np.abs(chain.fk(q) - product_of_exponentials(axes, end, q)).max()
            if angle < PARALLEL:
                assert worst < 50 * angle + 1e-14
            else:
                assert worst < (1e-13 if meets else 5e-14 / angle)


def test_axes_near_the_world_origin_or_far_from_it():
    """What is rounding is judged against the arm, not against 1."""
    rng = np.random.default_rng(16)
    axes, _ = random_arm(rng, "intersecting")
    q = rng.uniform(-3, 3, N)
    for scale in (1e-9, 1e9):
        scaled = [Axis(scale * axis.point, axis.direction) for axis in axes]
        end = random_pose(rng)
        end[:3, 3] *= scale
        chain, _ = place_frames(scaled, end=end)
        wrong = np.abs(chain.fk(q) - product_of_exponentials(scaled, end, q))
        assert wrong[:3, 3].max() < 1e-14 * chain.reach
        assert wrong[:3, :3].max() < 1e-14


# Reading parameters


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_parameters_are_read_back(convention):
    rng = np.random.default_rng(17)
    for _ in range(300):
        theta, alpha = rng.uniform(-math.pi, math.pi, 2)
        d, a = rng.uniform(-2, 2, 2)
        before = random_pose(rng)
        link = classic(theta, d, a, alpha) if convention == "classic" else modified(alpha, a, theta, d)
        assert read_parameters(before, before @ link, convention) == pytest.approx((theta, d, a, alpha), abs=1e-13)


def test_quarter_turns_are_read_exactly():
    half = math.pi / 2
    for theta in (-half, 0.0, half, math.pi):
        for alpha in (-half, 0.0, half, math.pi):
            before = Rx(0.3) @ Rz(0.7)
            assert read_parameters(before, before @ classic(theta, 0, 0, alpha), "classic") == (theta, 0, 0, alpha)
            assert read_parameters(before, before @ modified(alpha, 0, theta, 0), "modified") == (theta, 0, 0, alpha)


def test_frames_without_parameters_are_refused():
    with pytest.raises(DHError, match=r"no four classic parameters.*x_1 passes z_0 at a distance of 3"):
        read_parameters(np.eye(4), Ty(3))
    with pytest.raises(DHError, match=r"x_1 is 17\.19° off the perpendicular to z_0"):
        read_parameters(np.eye(4), Ry(0.3))
    with pytest.raises(DHError, match=r"no four modified parameters.*x_0 is 17\.19° off the perpendicular to z_1"):
        read_parameters(np.eye(4), Ry(0.3), "modified")


# Misuse


@pytest.mark.parametrize(
    ("axes", "options", "message"),
    [
        ([], {}, "at least one axis"),
        ([[0, 0, 1]], {}, r"axis 1 is \[0, 0, 1\]; it should be an Axis"),
        ("zz", {}, "it should be a list of Axis"),
        ([Axis(X, Z)], {"convention": "standard"}, "convention='standard' is unknown"),
        ([Axis(X, Z)], {"end": np.diag([1, 1, -1, 1])}, "end is no pose: its determinant is -1"),
        ([Axis(X, Z)], {"tool": np.zeros((3, 3))}, r"tool has shape \(3, 3\)"),
        ([Axis(X, Z)], {"base": np.full((4, 4), np.nan)}, "base holds NaN"),
    ],
)
def test_misuse(axes, options, message):
    with pytest.raises(DHError, match=message):
        place_frames(axes, **options)


def test_symbols_are_refused():
    sympy = pytest.importorskip("sympy")
    with pytest.raises(DHError, match="end holds symbols"):
        place_frames([Axis(X, Z)], end=Rx(sympy.Symbol("a")))
    assert place_frames([Axis(X, Z)], end=sympy.Matrix(Rx(0).tolist())).chain.n == 1


def test_a_single_revolute():
    assert place_frames([Axis([0, 0, 0], [0, 0, 1])]).chain == Chain([Revolute()], "classic")
