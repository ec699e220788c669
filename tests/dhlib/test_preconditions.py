"""check_frames: which of DH1 and DH2 holds at each link, and by how much they fail."""

import math

import numpy as np
import pytest

from dhlib import Axis, Chain, DHError, Rx, Ry, Rz, Tx, Ty, Tz, check_frames, robots

CONVENTIONS = ("classic", "modified")
ROBOTS = ("quickshot", "puma560", "pa10_7c", "planar", "stanford", "cobra600", "ur5", "panda", "irb140")


@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("name", ROBOTS)
def test_the_frames_of_a_chain_obey_in_every_pose(name, convention):
    arm = getattr(robots, name)(convention=convention)
    arm = Chain(arm.joints, convention, base=Tx(0.3) @ Ry(1.0))
    for q in np.random.default_rng(1).uniform(-3, 3, (20, arm.n)):
        report = check_frames(arm.frames(q), convention)
        assert report, report
        assert len(report.links) == arm.n
        assert report.faults == []
        assert max(link.angle for link in report.links) < 1e-12
        assert max(link.distance for link in report.links) < 1e-12 * arm.reach
    assert check_frames(arm.frames(np.zeros(arm.n)), convention, axes=arm)


@pytest.mark.parametrize("name", ["puma560", "panda", "stanford"])
def test_the_frames_of_the_other_convention_do_not(name):
    arm = getattr(robots, name)(convention="modified")
    q = np.random.default_rng(2).uniform(0.5, 1, arm.n)
    assert check_frames(arm.frames(q), "modified")
    assert not check_frames(arm.frames(q), "classic")


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_each_fault_is_measured(convention):
    """A frame is turned or moved by a known amount, and the report says which condition fails, where, by how much."""
    arm = robots.quickshot(convention)
    q = [0.3, 0.5, 0.7, 0.2]
    right = arm.frames(q)

    # Of link 2, the frame with the x in question, and the one with the z.
    k, x, z = (2, "x_2", "z_1") if convention == "classic" else (1, "x_1", "z_2")
    z_direction = right[3 - k][:3, 2]

    normal = np.cross(right[k][:3, 0], z_direction)
    frames = right.copy()
    frames[k][:3, 3] += 12.3 * normal
    link = check_frames(frames, convention).links[1]
    assert (link.dh1, link.dh2) == (True, False)
    assert link.distance == pytest.approx(12.3)
    assert str(link) == f"link 2: DH2 fails: {x} passes {z} at a distance of 12.3"
    assert not link

    frames = right.copy()
    tilt = np.eye(4)
    tilt[:3, :3] = rotation_about(normal, 0.1)
    origin = frames[k][:3, 3].copy()
    frames[k] = tilt @ frames[k]
    frames[k][:3, 3] = origin
    link = check_frames(frames, convention).links[1]
    assert (link.dh1, link.dh2) == (False, True)
    assert link.angle == pytest.approx(math.degrees(0.1))
    assert str(link) == f"link 2: DH1 fails: {x} is 5.73° off the perpendicular to {z}"


def rotation_about(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def test_the_sentence_of_dh2():
    report = check_frames([np.eye(4), Tx(160), Tx(160) @ Ty(12.3)])
    assert [str(link) for link in report.links] == [
        "link 1: DH1 and DH2 hold",
        "link 2: DH2 fails: x_2 passes z_1 at a distance of 12.3",
    ]
    assert str(report).splitlines() == [str(link) for link in report.links]
    assert report.faults == [str(report.links[1])]
    assert not report


def test_both_fail_in_one_link():
    report = check_frames([np.eye(4), Tz(3), Tz(3) @ Ty(2) @ Ry(0.5)])
    assert [fault.split(":")[:2] for fault in report.faults] == [["link 2", " DH1 fails"], ["link 2", " DH2 fails"]]


def test_x_along_z():
    """DH1 fails by a right angle; the distance of the lines is still told."""
    link = check_frames([np.eye(4), Tx(3) @ Ty(4) @ Tz(7) @ Ry(math.pi / 2)]).links[0]
    assert (link.angle, link.distance) == (pytest.approx(90), pytest.approx(5))
    link = check_frames([np.eye(4), Tz(7) @ Ry(math.pi / 2)]).links[0]
    assert (link.angle, link.distance, link.dh2) == (pytest.approx(90), 0, True)


def test_frames_at_one_point():
    assert check_frames([np.eye(4), Rx(1), Rx(1) @ Rz(2)])
    assert not check_frames([np.eye(4), Ry(1)])


def test_what_binds_the_first_and_the_last_frame():
    """Classic: x_0 is bound by nothing, x_n is. Modified: x_n is bound by nothing, x_0 is."""
    arm = robots.quickshot()
    frames = arm.frames([0.3, 0.5, 0.7, 0.2])
    for convention, free, bound in (("classic", 0, 4), ("modified", 4, 0)):
        frames = robots.quickshot(convention).frames([0.3, 0.5, 0.7, 0.2])
        turned = frames.copy()
        turned[free] = turned[free] @ Rz(1) @ Tz(5)
        assert check_frames(turned, convention)
        turned = frames.copy()
        turned[bound] = turned[bound] @ Ty(5)
        faults = check_frames(turned, convention).faults
        assert len(faults) == 1
        assert faults[0].startswith(f"link {4 if convention == 'classic' else 1}: DH2 fails")


# Axes


@pytest.mark.parametrize("convention", CONVENTIONS)
def test_z_lies_on_its_axis_in_either_sense(convention):
    arm = robots.quickshot(convention)
    frames = arm.frames(np.zeros(4))
    assert check_frames(frames, convention, arm)
    assert check_frames(frames, convention, [Axis(axis.point, -axis.direction) for axis in arm.axes()])

    axes = arm.axes()
    number = 1 if convention == "classic" else 2
    axes[1] = Axis(axes[1].point + [0, 0, 7], axes[1].direction)
    report = check_frames(frames, convention, axes)
    assert [link.on_axis for link in report.links] == [True, False, True, True]
    assert report.faults == [f"link 2: z_{number} is not on joint axis 2: its origin is at a distance of 7 from it"]
    assert report.links[1].dh1
    assert report.links[1].dh2

    axes[1] = Axis(frames[number][:3, 3], [0.1, 1, 0])
    assert check_frames(frames, convention, axes).faults == [
        f"link 2: z_{number} is 5.711° off the direction of joint axis 2"
    ]


def test_of_a_prismatic_axis_only_the_direction_counts():
    arm = robots.stanford()
    frames = arm.frames(np.zeros(6))
    axes = arm.axes()
    axes[2] = Axis(axes[2].point + [1, 2, 3], axes[2].direction, "P")
    assert check_frames(frames, axes=axes)
    axes[2] = Axis(axes[2].point, [0, 1, 1], "P")
    assert not check_frames(frames, axes=axes)


def test_a_chain_as_witness_lends_its_unit():
    arm = robots.quickshot()
    frames = arm.frames(np.zeros(4))
    frames[1:] = Tx(7) @ frames[1:]
    assert "a distance of 7 mm" in str(check_frames(frames, axes=arm).faults)
    assert "z lies on the joint axis" in str(check_frames(arm.frames(np.zeros(4)), axes=arm))


# Forms of input, tolerance, misuse


def test_lists_and_sympy_matrices_of_numbers():
    sympy = pytest.importorskip("sympy")
    frames = robots.quickshot().frames(np.zeros(4))
    assert check_frames(frames.tolist())
    exact = [sympy.Matrix(4, 4, [sympy.nsimplify(entry) for entry in frame.ravel()]) for frame in frames]
    assert check_frames(exact)
    exact[2] = exact[2] * sympy.Matrix(Ty(5).tolist())
    assert not check_frames(exact)


def test_the_tolerance():
    frames = robots.puma560().frames([0.3, -0.4, 0.5, 0.7, -0.6, 0.9]).round(4)
    with pytest.raises(DHError, match="is no pose"):
        check_frames(frames, "modified")
    assert check_frames(frames, "modified", tol=1e-3)
    for size in (1e-6, 1.0, 1e6):
        assert check_frames([np.eye(4), Tx(size), Tx(size) @ Ty(1e-7 * size)])
        assert not check_frames([np.eye(4), Tx(size), Tx(size) @ Ty(1e-5 * size)])


FRAMES = robots.quickshot().frames(np.zeros(4))


def spoilt(i, pose):
    frames = FRAMES.copy()
    frames[i] = pose
    return frames


@pytest.mark.parametrize(
    ("frames", "options", "message"),
    [
        (spoilt(2, np.full((4, 4), np.nan)), {}, "frame 2 holds NaN"),
        (
            spoilt(2, np.diag([1.0, 1, -1, 1])),
            {},
            "frame 2 is no pose: its determinant is -1, so its axes are left-handed",
        ),
        (spoilt(3, np.diag([2.0, 1, 1, 1])), {}, "frame 3 is no pose: its column n has length 2, not 1"),
        (spoilt(1, Tx(3).T), {}, "frame 1 is no pose: .* transposed"),
        (FRAMES[:, :3, :3], {}, r"frame 0 has shape \(3, 3\); a pose is a 4×4 matrix"),
        (np.eye(4), {}, "at least two frames"),
        ([np.eye(4)], {}, "at least two frames"),
        ("frames", {}, "should be a list of 4×4 matrices"),
        (None, {}, "should be a list of 4×4 matrices"),
        (FRAMES, {"convention": "Craig"}, "convention='Craig' is unknown"),
        (FRAMES, {"axes": robots.puma560()}, "there are 5 frames and 6 axes; 5 frames, 0 to 4, need 4 axes"),
        (FRAMES, {"axes": [1, 2, 3, 4]}, "axis 1 is 1; it should be an Axis"),
        (FRAMES, {"axes": 3}, "axes is 3; it should be a list of Axis"),
    ],
)
def test_misuse(frames, options, message):
    with pytest.raises(DHError, match=message):
        check_frames(frames, **options)


def test_symbols_are_refused():
    sympy = pytest.importorskip("sympy")
    with pytest.raises(DHError, match="frame 1 holds symbols"):
        check_frames([np.eye(4), Rz(sympy.Symbol("theta"))])
