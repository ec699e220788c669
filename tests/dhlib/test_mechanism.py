"""same_mechanism: every disguise of an arm is seen through, and no other arm passes for it.

Two witnesses know nothing of how it decides: ``fk``, which checks each mapping at joint vectors of the test's own, and
`Fingerprint`, which compares how joint axes lie to one another over whole turns of the joints between them.
"""

import itertools
import math
import warnings
from dataclasses import FrozenInstanceError

import numpy as np
import pytest
from arms import EVERY_ROBOT, random_pose
from sampling import FULL

from dhlib import (
    Axis,
    Chain,
    DHError,
    Prismatic,
    Revolute,
    Rx,
    Rz,
    Tx,
    Tz,
    mirror_image,
    place_frames,
    robots,
    same_mechanism,
)
from dhlib.mechanism import _Pair
from dhlib.overlay import Fit, Freedom

DISGUISED = 20_000 if FULL else 2000
CHANGED = 4000 if FULL else 400
PI = math.pi
CRAIG_CLASSIC = robots.puma560("classic", "craig")
CORKE = robots.puma560("classic", "corke")
CRAIG = robots.puma560("modified", "craig")


# Witness 1: the mapping itself


def certificate_error(verdict, answer, reference, seed=0):
    rng = np.random.default_rng(seed)
    q = rng.uniform(-2, 2, (5, reference.n))
    mapped = verdict.base @ answer.fk(verdict.offsets + np.array(verdict.signs) * q) @ verdict.tool
    return np.abs(mapped - reference.fk(q)).max() / max(1, reference.reach)


def assert_same(answer, reference, tol=1e-6, accuracy=1e-9, **options):
    verdict = same_mechanism(answer, reference, tol, **options)
    assert verdict, verdict.message
    assert certificate_error(verdict, answer, reference) < accuracy
    assert verdict.certificate_error < accuracy
    assert set(verdict.signs) <= {1, -1}
    for end in (verdict.base, verdict.tool):
        assert end[:3, :3] @ end[:3, :3].T == pytest.approx(np.eye(3), abs=1e-9)
        assert np.linalg.det(end) == pytest.approx(1)
    assert verdict.joint is None
    assert not verdict.reason
    assert not verdict.mirror
    return verdict


def assert_not_same(answer, reference, tol=1e-6, **options):
    verdict = same_mechanism(answer, reference, tol, **options)
    assert not verdict, verdict.message
    assert verdict.reason in verdict.message
    assert verdict.certificate_error == math.inf
    return verdict


# Witness 2: how the axes lie to one another


class Fingerprint:
    """What base, tool and joint zeros cannot change, taken from the axes as screws.

    For axis i and a later axis j the products w_i·w_j and (p_j - p_i)·(w_j × w_i) depend on the joints between them
    alone, and on each revolute one as a trigonometric polynomial of degree 1. Other zeros turn the phases of the
    Fourier coefficients, the same for both products; a joint that counts the other way swaps a frequency with its
    negative.
    """

    def __init__(self, chain, between=2):
        self.n, self.kinds = chain.n, chain.kinds
        self.spectra = {}
        for i in range(chain.n):
            for j in range(i + 1, min(chain.n, i + between + 2)):
                self.spectra[i, j] = self._spectra(chain, i, j)

    def _spectra(self, chain, i, j):
        turning = [k for k in range(i + 1, j) if self.kinds[k] == "R"]
        samples = 3 ** len(turning)
        q = np.zeros((samples, self.n))
        q[:, turning] = list(itertools.product(2 * PI * np.arange(3) / 3, repeat=len(turning)))
        frames = chain.frames(q)
        (wi, pi), (wj, pj) = (self._line(chain, frames, k) for k in (i, j))
        shape = (3,) * len(turning)
        heading = np.fft.fftn((wi * wj).sum(axis=1).reshape(shape)) / samples
        if "P" in self.kinds[i : j + 1]:
            return heading, np.zeros_like(heading), turning
        moment = ((pj - pi) * np.cross(wj, wi)).sum(axis=1)
        return heading, np.fft.fftn(moment.reshape(shape)) / samples, turning

    def _line(self, chain, frames, k):
        frame = frames[:, k if chain.convention == "classic" else k + 1]
        return chain.joints[k].sign * frame[:, :3, 2], frame[:, :3, 3]

    def distance(self, other):
        """By how much two arms differ for the best choice of senses; 0 does not prove them the same."""
        best = math.inf
        for signs in itertools.product((1, -1), repeat=self.n):
            best = min(best, self._distance(other, signs, best))
        return best

    def _distance(self, other, signs, enough):
        worst = 0.0
        for (i, j), (heading, moment, turning) in self.spectra.items():
            heading_, moment_, _ = other.spectra[i, j]
            swapped = tuple(axis for axis, k in enumerate(turning) if signs[k] < 0)
            for axis in swapped:
                heading_, moment_ = (np.roll(np.flip(part, axis), 1, axis) for part in (heading_, moment_))
            both = signs[i] * signs[j]
            parts = (
                np.abs(heading) - np.abs(heading_),
                np.abs(moment) - np.abs(moment_),
                moment * heading.conj() - moment_ * heading_.conj(),
                heading.flat[0] - both * heading_.flat[0],
                moment.flat[0] - both * moment_.flat[0],
            )
            worst = max(worst, *(float(np.abs(part).max()) for part in parts))
            if worst >= enough:
                break
        return worst

    @property
    def decides(self):
        """Whether arms with equal fingerprints are the same: revolute, and no two neighbours parallel."""
        neighbours = [abs(self.spectra[i, i + 1][0].item().real) for i in range(self.n - 1)]
        return "P" not in self.kinds and all(cosine < 0.999 for cosine in neighbours)


# Arms and their disguises


def random_arm(rng):
    """A classic chain of one to six joints, of which many are parallel, coincident, intersecting or prismatic."""
    sliding = rng.choice([0, 0.25])
    joints = []
    for _ in range(rng.integers(1, 7)):
        alpha = rng.choice([0, 0, PI, PI / 2, -PI / 2, rng.uniform(0.2, 2.9), rng.uniform(-2.9, -0.2)])
        a, d = rng.choice([-1, 0, 1], 2) * rng.uniform(0.02, 1, 2)  # rounding is told through no shorter lever
        theta = rng.choice([0, PI / 2, rng.uniform(-3, 3)])
        sign = int(rng.choice([1, -1]))
        if rng.random() < sliding:
            joints.append(Prismatic(theta=theta, a=a, alpha=alpha, offset=d, sign=sign))
        else:
            joints.append(Revolute(d=d, a=a, alpha=alpha, offset=theta, sign=sign))
    return Chain(joints, "classic", base=random_pose(rng), tool=random_pose(rng))


def wrapped(angle):
    return math.remainder(angle, 2 * PI)


class Rows:
    """A classic table to be rewritten in place. Each method leaves the mechanism as it is."""

    def __init__(self, chain, rng):
        chain = chain.to_classic()
        self.theta, self.d, self.a, self.alpha = (
            [getattr(joint, name) for joint in chain.joints] for name in ("theta", "d", "a", "alpha")
        )
        self.signs = [joint.sign for joint in chain.joints]
        self.kinds, self.base, self.tool, self.rng = chain.kinds, chain.base, chain.tool, rng
        self.n = chain.n

    def chain(self):
        joints = []
        for kind, theta, d, a, alpha, sign in zip(
            self.kinds, self.theta, self.d, self.a, self.alpha, self.signs, strict=True
        ):
            angles = {"alpha": wrapped(alpha), "a": a, "sign": sign}
            if kind == "R":
                joints.append(Revolute(d=d, offset=wrapped(theta), **angles))
            else:
                joints.append(Prismatic(theta=wrapped(theta), offset=d, **angles))
        return Chain(joints, "classic", self.base, self.tool)

    def flip_x(self, i):
        """x_i the other way."""
        self.theta[i] += PI
        self.a[i], self.alpha[i] = -self.a[i], -self.alpha[i]
        self._turn_next(i, PI)

    def reverse_z(self, i):
        """The axis of joint i the other way; with it θ and d, but not how q is written."""
        if i:
            self.alpha[i - 1] += PI
        else:
            self.base = self.base @ Rx(PI)
        self.theta[i], self.d[i] = -self.theta[i], -self.d[i]
        self.alpha[i] -= PI

    def shift_d(self, i):
        """Along parallel axes only the sum of the d counts; along the first and the last, base and tool take it."""
        by = self.rng.uniform(-1, 1)
        if i < 0:
            self.base = self.base @ Tz(-by)
            self.d[0] += by
        elif abs(math.sin(self.alpha[i])) < 1e-12:
            self.d[i] += by
            self._slide_next(i, -by * round(math.cos(self.alpha[i])))

    def turn_coincident(self, i):
        """Along coincident axes only the sum of the θ counts."""
        if self.a[i] == 0 and abs(math.sin(self.alpha[i])) < 1e-12:
            by = self.rng.uniform(-3, 3)
            self.theta[i] += by
            self._turn_next(i, -by * round(math.cos(self.alpha[i])))

    def move_zero(self, i):
        if self.kinds[i] == "R":
            self.theta[i] += self.rng.choice([PI / 2, PI, self.rng.uniform(-3, 3)])
        else:
            self.d[i] += self.rng.uniform(-1, 1)

    def count_back(self, i):
        self.signs[i] = -self.signs[i]

    def other_ends(self, _):
        self.base, self.tool = random_pose(self.rng), random_pose(self.rng)

    def round_off(self, i):
        for column in (self.theta, self.d, self.a, self.alpha):
            column[i] += self.rng.uniform(-1e-12, 1e-12)

    def _turn_next(self, i, by):
        if i + 1 < self.n:
            self.theta[i + 1] += by
        else:
            self.tool = Rz(by) @ self.tool

    def _slide_next(self, i, by):
        if i + 1 < self.n:
            self.d[i + 1] += by
        else:
            self.tool = Tz(by) @ self.tool


KEEP_T = (Rows.flip_x, Rows.shift_d, Rows.turn_coincident)
KEEP_ARM = (*KEEP_T, Rows.reverse_z, Rows.move_zero, Rows.count_back, Rows.other_ends)


def moved_axes(chain, rng):
    """The arm with points anywhere on its axes, and prismatic axes anywhere parallel: tables from scratch."""
    axes = []
    for axis in chain.axes():
        point = axis.point + rng.uniform(-2, 2) * axis.direction
        if axis.kind == "P":
            point = point + rng.uniform(-2, 2, 3)
        axes.append(Axis(point, axis.direction, axis.kind))
    return place_frames(axes, end=chain.fk(np.zeros(chain.n))).chain


def disguised(chain, rng, ways=KEEP_ARM, rounding=True):
    """The same arm in another table."""
    if rng.random() < 0.4:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            chain = moved_axes(chain, rng)
    rows = Rows(chain, rng)
    for way in rng.choice(ways, rng.integers(1, 9)):
        way(rows, int(rng.integers(-1 if way is Rows.shift_d else 0, rows.n)))
    if rounding and rng.random() < 0.3:
        for i in range(rows.n):
            rows.round_off(i)
    result = rows.chain()
    return result if rng.random() < 0.5 else result.to_modified()


def test_disguised_arms_are_seen_through():
    rng = np.random.default_rng(1)
    kinds = set()
    for k in range(DISGUISED):
        reference = random_arm(rng)
        answer = disguised(reference, rng)
        if rng.random() < 0.3:
            answer, reference = reference, answer
        kinds.add(reference.kinds)
        verdict = same_mechanism(answer, reference)
        assert verdict, f"pair {k}: {verdict.message}\n{reference}\n{answer}"
        assert verdict.certificate_error < 1e-9
        assert certificate_error(verdict, answer, reference) < 1e-9
        if k % 20 == 0:
            assert Fingerprint(answer).distance(Fingerprint(reference)) < 1e-9
    assert {"R", "P", "PR", "RP", "PP"} <= kinds
    assert any("PPP" in each for each in kinds)


def test_a_table_of_the_same_pose_differs_in_nothing():
    """The simplest mapping is found: where T is the same at every q, it is the identity."""
    rng = np.random.default_rng(2)
    for _ in range(DISGUISED // 10):
        reference = random_arm(rng)
        answer = disguised(reference, rng, KEEP_T, rounding=False)
        q = rng.uniform(-2, 2, (3, reference.n))
        assert answer.fk(q) == pytest.approx(reference.fk(q), abs=1e-12)
        verdict = assert_same(answer, reference)
        assert verdict.same_ends
        assert verdict.same_zeros
        assert verdict.same_senses
        assert verdict.message == "The same mechanism, and the same pose at every q."
        assert same_mechanism(answer, reference, free=())


def test_changed_arms_are_refused():
    rng = np.random.default_rng(3)
    refused = mirrored = unchanged = 0
    while refused < CHANGED:
        reference = random_arm(rng)
        rows = Rows(reference, rng)
        i = rng.integers(max(1, rows.n - 1))  # what the last row holds is mostly the tool's
        column = [rows.theta, rows.d, rows.a, rows.alpha][rng.choice(4, p=[0.1, 0.3, 0.3, 0.3])]
        if rng.random() < 0.3:
            column[i] = -column[i]
        else:
            column[i] += rng.choice([-1, 1]) * 10 ** rng.uniform(-3, 0)
        answer = disguised(rows.chain(), rng)
        verdict = same_mechanism(answer, reference)
        witness = Fingerprint(reference)
        difference = witness.distance(Fingerprint(answer))
        if difference > 1e-7:
            assert not verdict, f"differ by {difference}:\n{reference}\n{answer}"
            assert verdict.joint is not None
            assert verdict.reason
            mirrored += verdict.mirror
            refused += 1
            if verdict.mirror:
                assert witness.distance(Fingerprint(mirror_image(answer))) < 1e-7
        elif witness.decides:
            assert difference < 1e-9
            assert verdict, f"{verdict.message}\n{reference}\n{answer}"
            unchanged += 1
        elif verdict:
            assert certificate_error(verdict, answer, reference) < 1e-6
    assert mirrored > CHANGED / 50
    assert unchanged > CHANGED / 20


def test_the_witness_sees_each_kind_of_change():
    """Negative control: the fingerprint of a PUMA changes with every length and twist, and with nothing else."""
    witness = Fingerprint(CORKE)
    for i, name in ((2, "a"), (3, "a"), (3, "d"), (4, "d"), (1, "alpha"), (2, "alpha"), (5, "alpha")):
        assert witness.distance(Fingerprint(changed(CORKE, i, **{name: 0.3}))) > 1e-3
    assert witness.distance(Fingerprint(changed(CORKE, 2, d=0.3))) > 1e-3
    assert witness.distance(Fingerprint(changed(CORKE, 1, d=0.3))) < 1e-15
    assert witness.distance(Fingerprint(changed(CORKE, 6, d=0.3, a=1, alpha=1))) < 1e-15
    assert witness.distance(Fingerprint(CRAIG)) < 1e-15


def changed(chain, i, **parameters):
    """The chain with some parameters of row i replaced; a callable gets the old value."""
    joints = list(chain.joints)
    row = joints[i - 1]
    joints[i - 1] = row.replace(**{k: new(getattr(row, k)) if callable(new) else new for k, new in parameters.items()})
    return Chain(joints, chain.convention, chain.base, chain.tool, unit=chain.unit)


def minus(value):
    return -value


def test_a_wrong_mapping_gets_no_certificate():
    """Whatever the search proposes: each part of a mapping is checked by fk."""
    free = Freedom(base=True, tool=False, zeros=True, senses=True)
    arm = robots.puma560()
    right = Fit(np.eye(4), (1,) * 6, np.zeros(6))
    assert _Pair(arm, arm, 1e-6).certify(right, free)
    wrong = [right._replace(base=Tx(1e-4)), right._replace(offsets=np.full(6, 1e-4))]
    wrong += [right._replace(signs=(1,) * i + (-1,) + (1,) * (5 - i)) for i in range(6)]
    for fit in wrong:
        assert _Pair(arm, arm, 1e-6).certify(fit, free) is None
    for i, name in ((2, "a"), (4, "d"), (1, "alpha")):
        near = changed(arm, i + 1, **{name: lambda value: value + 1e-4})
        assert _Pair(near, arm, 1e-6).certify(right, free) is None


# Tolerance


@pytest.mark.parametrize("name", EVERY_ROBOT)
def test_a_thousandth_is_seen_and_rounding_is_not(name):
    arm = EVERY_ROBOT[name].to_classic()
    rng = np.random.default_rng(4)
    for i, joint in enumerate(arm.joints, 1):
        for parameter, by in (("a", 1e-3 * arm.reach), ("alpha", 1e-3)):
            if i == arm.n:
                continue  # the last link is the tool's
            answer = changed(arm, i, **{parameter: getattr(joint, parameter) + by})
            answer = Chain(answer.joints, "classic", random_pose(rng), random_pose(rng))
            assert_not_same(answer, arm)
            answer = changed(arm, i, **{parameter: getattr(joint, parameter) + 1e-6 * by})
            assert_same(answer, arm, accuracy=1e-6)
            assert_not_same(answer, arm, tol=1e-12)


def test_tolerance_goes_with_the_reach():
    for scale in (1e-6, 1, 1e6):
        arm = Chain([Revolute(a=3 * scale, alpha=1, d=scale), Revolute(a=scale), Revolute()], "classic")
        assert_same(changed(arm, 1, a=lambda a: a * (1 + 1e-7)), arm, accuracy=1e-5)
        assert_not_same(changed(arm, 1, a=lambda a: a * (1 + 1e-5)), arm)


def test_an_arm_without_lengths():
    wrist = Chain([Revolute(alpha=-PI / 2), Revolute(alpha=PI / 2), Revolute()], "classic")
    assert_same(wrist, wrist)
    assert_same(changed(wrist, 1, d=0.3), wrist)
    assert_same(changed(wrist, 1, d=1e-17, a=1e-17), wrist)
    assert_not_same(changed(wrist, 2, d=1e-3), wrist)
    assert_not_same(changed(wrist, 1, a=1e-3), wrist)
    far = Chain(wrist.joints, "classic", base=Tx(10))
    verdict = assert_same(wrist, far)
    assert verdict.same_zeros
    assert verdict.same_senses


# False friends


@pytest.mark.parametrize("arm", [CORKE, CRAIG_CLASSIC], ids=["corke", "craig"])
def test_a_puma_with_signs_turned(arm):
    for i, name in ((3, "alpha"), (3, "a"), (3, "d"), (4, "d")):
        verdict = assert_not_same(changed(arm, i, **{name: minus}), arm)
        assert verdict.mirror, (i, name)
        assert verdict.message.endswith("It is the mirror image.")
    flip_d3 = changed(arm, 3, d=minus)
    assert_same(changed(flip_d3, 4, d=minus), arm)
    assert_same(changed(flip_d3, 3, a=minus), arm)
    for i, name in ((4, "alpha"), (5, "alpha"), (1, "alpha"), (2, "a")):
        assert_same(changed(arm, i, **{name: minus}), arm)


def test_the_puma_of_fgl_with_signs_turned():
    arm = robots.puma560("classic", "fgl")
    for i, name in ((3, "alpha"), (3, "a"), (2, "d"), (4, "d")):
        assert assert_not_same(changed(arm, i, **{name: minus}), arm).mirror
    flip_d2 = changed(arm, 2, d=minus)
    assert_same(changed(flip_d2, 4, d=minus), arm)
    assert_same(changed(flip_d2, 3, a=minus), arm)
    for i, name in ((4, "alpha"), (5, "alpha"), (1, "alpha"), (2, "a")):
        assert_same(changed(arm, i, **{name: minus}), arm)


def planar(*lengths):
    return Chain([Revolute(a=a) for a in lengths], "classic")


def test_planar_arms():
    arm = planar(1, 0.7, 0.3)
    assert_not_same(planar(0.7, 1, 0.3), arm)
    verdict = assert_same(planar(1, 0.7, 0.5), arm)
    assert verdict.tool == pytest.approx(Tx(-0.2))
    assert verdict.same_base
    assert verdict.same_zeros
    assert verdict.same_senses
    assert not verdict.same_tool
    assert verdict.message == "The same mechanism, with another tool."
    verdict = assert_not_same(planar(1, 0.7, 0.5), arm, free=("base", "zeros", "senses"))
    assert verdict.reason == "the axes agree, but the end is 0.2 away from where expected"
    assert verdict.joint is None
    assert_not_same(planar(1, 0.6, 0.3), arm)
    assert_not_same(planar(1, 0, 0.3), arm)
    assert not assert_not_same(planar(1, 0.6, 0.3), arm).mirror


def test_the_stanford_arm_with_d2_turned():
    arm = robots.stanford()
    verdict = assert_same(changed(arm, 2, d=minus), arm)
    assert verdict.signs == (1, -1, 1, 1, 1, 1)  # of several mappings that with the fewest joints turned
    assert verdict.offsets == pytest.approx([PI, 0, 0, PI, 0, 0])
    assert verdict.same_ends
    verdict = assert_same(changed(arm, 2, d=minus), arm, free=("base", "tool", "senses"))
    assert verdict.signs == (1, -1, 1, 1, -1, 1)
    assert verdict.base == pytest.approx(Rz(PI))
    assert_not_same(changed(arm, 2, d=0.2), arm)
    assert_not_same(changed(arm, 2, d=minus), arm, free=("base", "tool", "zeros"))


def test_the_length_of_a_prismatic_link_may_stand_elsewhere():
    """But not off a revolute one: a_3 = 0.0203, as a toolbox has it, moves the wrist of the Stanford arm."""
    arm = robots.stanford()
    assert_not_same(changed(arm, 3, a=0.0203), arm)
    slider = Chain([Prismatic(alpha=PI / 2), Prismatic()], "classic")
    assert_same(changed(slider, 1, a=0.3), slider)
    assert_not_same(changed(slider, 1, alpha=1.0), slider)


def test_nearly_parallel_axes_are_noted():
    def arm(alpha):
        return Chain([Revolute(a=0.3), Revolute(d=0.1 / alpha, alpha=alpha, a=1), Revolute(d=-0.1 / alpha)], "classic")

    verdict = same_mechanism(arm(1e-4), robots.planar(3))
    assert [note[:33] for note in verdict.notes] == ["Axes 2 and 3 are nearly parallel "]
    assert verdict.notes[0] in verdict.message
    assert_same(arm(1e-4), arm(1e-4))
    assert_not_same(arm(1e-4), arm(2e-4))
    assert not same_mechanism(arm(0.5), robots.planar(3)).notes
    calibrated = changed(robots.planar(3), 1, alpha=1e-4)
    assert not same_mechanism(calibrated, robots.planar(3)).notes  # without the symptom, no word


def test_nearly_parallel_axes_in_disguise():
    """Three in a row. About where the slant is the tolerance itself, rounding over its square is as large."""
    rng = np.random.default_rng(5)
    for alpha in 10 ** np.append(rng.uniform(-10, -6.5, 100), rng.uniform(-5, -2, 100)):
        joints = [
            Revolute(a=a, alpha=alpha, d=d, offset=1) for a, d in zip((0.4, 0.3, 0), (0.1, 0.2, 0.3), strict=True)
        ]
        arm = Chain([*joints, Revolute(alpha=1), Revolute()], "classic")
        rows = Rows(arm, rng)
        for way in (Rows.flip_x, Rows.move_zero, Rows.other_ends, Rows.reverse_z):
            way(rows, int(rng.integers(arm.n)))
        assert_same(rows.chain(), arm, accuracy=5e-6)


def test_a_slant_within_the_tolerance_may_be_meant_or_not():
    slant = 5e-4
    calibrated = Chain([Revolute(a=0.4, alpha=slant), Revolute(a=0.3, alpha=1, d=0.2), Revolute()], "classic")
    straight = changed(calibrated, 1, alpha=0.0)
    turned = changed(changed(calibrated, 1, theta=1.0), 2, theta=-0.5)
    assert_not_same(turned, straight)
    assert_same(turned, calibrated, tol=1e-3, accuracy=1e-9)  # meant: the slants are laid on one another
    verdict = assert_same(turned, straight, tol=1e-3, accuracy=1e-3)  # an error: the distance decides
    assert verdict.certificate_error > 1e-5
    meeting, turned = (changed(arm, 1, a=0.0) for arm in (calibrated, turned))
    verdict = assert_same(turned, meeting, tol=1e-3, free="zeros")  # no distance: the slants alone say how far
    assert verdict.offsets == pytest.approx([-1, 0.5, 0])


# Known pairs


def test_pumas_in_four_tables():
    """Relations 1 to 4 of the tables that circulate, with the lengths made equal where the sources differ."""
    d1 = 0.67183
    verdict = assert_same(CRAIG, Chain(CORKE.joints, "classic", base=Tz(d1)))
    assert verdict.same_tool
    assert_same(changed(CORKE, 1, d=d1), CRAIG, free=("base", "zeros"))
    assert np.abs(np.abs(assert_same(CRAIG, CORKE).offsets) - [PI, PI, 0, 0, 0, 0]).max() < 1e-12

    a3, d3, d4 = -0.02032, 0.14909, 0.43307
    fgl = robots.puma560("classic", "fgl")
    craig = changed(changed(CRAIG, 4, a=-a3, d=d4), 3, d=d3)
    verdict = assert_same(craig, fgl)
    assert verdict.same_senses
    assert_not_same(CRAIG, fgl)

    akb = robots.puma560("modified", "akb")
    craig = changed(changed(CRAIG, 4, d=0.4331), 3, d=0.2435 - 0.0934)
    verdict = assert_same(craig, akb, free=("zeros",))
    assert np.abs(np.abs(verdict.offsets) - [0, 0, PI, 0, 0, PI]).max() < 1e-12
    reason = "offset along axes 2 to 3, between the common normals with axes 1 and 4, is 0.15005, expected 0.1501"
    assert assert_not_same(changed(CRAIG, 4, d=0.4331), akb).reason == reason

    assert same_mechanism(CRAIG, CRAIG_CLASSIC, free=()).same_zeros


@pytest.mark.parametrize("name", EVERY_ROBOT)
def test_every_robot_in_both_conventions_and_turned_around(name):
    arm = EVERY_ROBOT[name]
    rng = np.random.default_rng(6)
    assert same_mechanism(arm.to_classic(), arm.to_modified(), free=())
    for _ in range(5):
        assert_same(disguised(arm, rng), arm)


def test_no_two_robots_are_the_same():
    arms = {name: arm for name, arm in EVERY_ROBOT.items() if name not in ("puma_corke", "pa10_7c_B2")}
    for one, other in itertools.permutations(arms, 2):
        assert_not_same(arms[one], arms[other])
    assert_same(EVERY_ROBOT["pa10_7c_B"], EVERY_ROBOT["pa10_7c_B2"])  # only the flange differs
    assert_not_same(EVERY_ROBOT["pa10_7c_A"], EVERY_ROBOT["pa10_7c_B"])


def test_the_scara_upside_down():
    arm = robots.cobra600()
    straight = Chain(
        [Revolute(d=0.387, a=0.325), Revolute(a=0.275), Prismatic(sign=-1), Revolute(sign=-1)], "classic", tool=Rx(PI)
    )
    verdict = assert_same(straight, arm)
    assert verdict.same_ends
    assert verdict.same_zeros
    assert verdict.same_senses
    other = Chain([Revolute(a=0.325), Revolute(a=0.275), Prismatic(), Revolute()], "classic")
    verdict = assert_same(other, arm)
    assert verdict.signs == (1, 1, -1, -1)
    assert_not_same(changed(arm, 1, a=0.3), arm)
    assert not assert_not_same(changed(arm, 1, a=0.3), arm).mirror


def test_arms_of_one_joint():
    rng = np.random.default_rng(7)
    for joint in (Revolute(a=1, d=2, alpha=1), Prismatic(theta=1, a=2, alpha=0.3)):
        arm = Chain([joint], "classic")
        other = Chain([type(joint)(a=0.3, alpha=-2)], "modified", random_pose(rng), random_pose(rng))
        verdict = assert_same(other, arm)
        assert verdict.same_zeros
        assert verdict.same_senses
        assert_not_same(other, arm, free=("zeros", "senses"))
        assert_same(changed(arm, 1, sign=-1), arm)
        assert assert_same(changed(arm, 1, sign=-1), arm, free=("senses",)).signs == (-1,)


@pytest.mark.parametrize("kinds", ["PPP", "PPR", "PRP", "RPP", "PRPR", "PPRR", "RPRP", "PPPP", "RPPPR"])
def test_several_prismatic_joints(kinds):
    rng = np.random.default_rng(8)
    for _ in range(40):
        joints = []
        for kind in kinds:
            link = {"a": rng.uniform(-1, 1), "alpha": rng.choice([0, PI / 2, rng.uniform(0.3, 2.8)])}
            joints.append(
                Revolute(d=rng.uniform(), offset=1, **link) if kind == "R" else Prismatic(theta=rng.uniform(), **link)
            )
        arm = Chain(joints, "classic")
        assert_same(disguised(arm, rng), arm)


def test_prismatic_joints_take_up_what_they_can():
    """Two slides span a plane: an axis may be shifted in it, by joint zeros, and not across it."""
    slides = [Prismatic(alpha=PI / 2), Prismatic(alpha=PI / 2)]
    arm = Chain([Revolute(), *slides, Revolute(a=1, alpha=1), Revolute()], "classic")
    moved = changed(arm, 3, d=0.4)
    verdict = assert_same(moved, arm)
    assert verdict.offsets == pytest.approx([0, 0, -0.4, 0, 0])
    assert assert_same(moved, arm, free="zeros").same_ends
    assert_not_same(moved, arm, free=("base", "tool"))


# The simplest mapping


def test_only_what_differs_is_named():
    rng = np.random.default_rng(9)
    base, tool = random_pose(rng), random_pose(rng)
    for arm in EVERY_ROBOT.values():
        joints = arm.joints
        standing = Chain(joints, arm.convention, base @ arm.base, arm.tool)
        holding = Chain(joints, arm.convention, arm.base, arm.tool @ tool)
        both = Chain(joints, arm.convention, base @ arm.base, arm.tool @ tool)
        middle = arm.n // 2
        shifted = changed(arm, middle + 1, **{joints[middle].variable: 0.5})
        turned = changed(arm, middle + 1, sign=-1)

        verdict = assert_same(arm, holding)
        assert (verdict.same_base, verdict.same_tool, verdict.same_zeros, verdict.same_senses) == (1, 0, 1, 1)
        assert verdict.tool == pytest.approx(tool)
        verdict = assert_same(arm, standing)
        assert verdict.same_zeros
        assert verdict.same_senses
        assert verdict.same_base != verdict.same_tool  # on a slide, the tool can make up for the base
        verdict = assert_same(arm, both)
        assert verdict.same_zeros
        assert verdict.same_senses
        assert same_mechanism(shifted, arm, free="zeros").same_ends
        assert assert_same(turned, arm, free="senses").signs[middle] == -1
        verdict = assert_same(turned, arm)
        if verdict.same_senses:  # a wrist: half a turn before and after does the same
            assert np.abs(verdict.offsets[verdict.offsets != 0]) == pytest.approx(PI)


def test_what_is_not_free_stays():
    arm = robots.puma560()
    cases = {
        "base": Chain(arm.joints, "modified", base=Tx(0.1) @ Rx(0.2)),
        "tool": Chain(arm.joints, "modified", tool=Tx(0.1) @ Rx(0.2)),
        "zeros": changed(arm, 3, theta=0.3),
        "senses": changed(arm, 3, sign=-1),
    }
    for differs, answer in cases.items():
        assert_same(answer, arm)
        for count in range(4):
            for free in itertools.combinations(cases, count):
                verdict = same_mechanism(answer, arm, free=free)
                assert bool(verdict) == (differs in free), (differs, free, verdict.message)
                assert bool(verdict.reason) != bool(verdict)
    assert "axis 1" in assert_not_same(cases["base"], arm, free=("tool", "zeros", "senses")).reason
    assert "axis 4" in assert_not_same(cases["zeros"], arm, free=("base", "tool", "senses")).reason
    ends = assert_not_same(cases["tool"], arm, free=("base", "zeros", "senses"))
    assert ends.reason == "the axes agree, but the end is 0.1 away and turned by 11.4592° from where expected"


def test_base_and_tool_do_what_they_can():
    """The zeros of the first and the last joint are base and tool; alone they are zeros."""
    arm = robots.puma560()
    answer = changed(changed(arm, 1, theta=0.3), 6, theta=0.4)
    verdict = assert_same(answer, arm)
    assert verdict.same_zeros
    verdict = assert_same(answer, arm, free=("zeros",))
    assert verdict.offsets == pytest.approx([-0.3, 0, 0, 0, 0, -0.4])


# Words


@pytest.mark.parametrize(
    ("i", "change", "joint", "reason"),
    [
        (2, {"a": 0}, 3, "distance between axes 2 and 3 is 0, expected 0.4318"),
        (1, {"alpha": 0}, 2, "angle between axes 1 and 2 is 0°, expected 90°"),
        (4, {"d": 0}, 5, "offset along axis 4, between the common normals with axes 3 and 5, is 0, expected 0.4318"),
    ],
)
def test_the_first_axis_that_fails_is_named(i, change, joint, reason):
    verdict = assert_not_same(changed(CORKE, i, **change), CORKE)
    assert (verdict.joint, verdict.reason) == (joint, reason)
    assert str(verdict) == f"Not the same mechanism: {reason}."
    assert np.isnan(verdict.base).all()
    assert np.isnan(verdict.tool).all()
    assert verdict.signs == ()
    assert verdict.offsets.size == 0
    assert not any((verdict.same_ends, verdict.same_zeros, verdict.same_senses))


def test_a_wrong_side_is_said_in_lengths():
    verdict = assert_not_same(changed(CORKE, 4, d=minus), CORKE)
    assert (verdict.joint, verdict.reason) == (5, "axis 5 misses its place by 0.8636 once axes 1 to 4 are in place")


def test_other_joints():
    verdict = assert_not_same(robots.planar(2), robots.planar(3))
    assert (verdict.joint, verdict.reason) == (None, "it has 2 joints, expected 3")
    assert assert_not_same(robots.planar(1), robots.planar(3)).reason == "it has 1 joint, expected 3"
    slide = Chain([Revolute(a=1), Prismatic()], "classic")
    verdict = assert_not_same(slide, robots.planar(2))
    assert (verdict.joint, verdict.reason) == (2, "joint 2 is prismatic, expected revolute")


def test_other_units_are_compared_as_numbers():
    arm = robots.quickshot()
    metres = Chain(arm.joints, "classic", unit="m")
    verdict = assert_same(metres, arm)
    assert verdict.notes == ("Lengths are compared as numbers, though one arm is in m and the other in mm.",)
    scaled = Chain([joint.replace(a=joint.a / 1000, d=joint.d / 1000) for joint in arm.joints], "classic", unit="m")
    assert assert_not_same(scaled, arm).notes == verdict.notes
    assert not same_mechanism(arm, arm).notes


def test_what_differs_is_said():
    arm = robots.puma560()
    answer = changed(changed(changed(arm, 2, sign=-1), 3, sign=-1), 4, theta=PI / 2)
    message = same_mechanism(answer, arm).message
    assert message == (
        "The same mechanism, with other joint zeros (joint 4 by -90°), where joints 2 and 3 count the other way."
    )
    assert same_mechanism(changed(arm, 2, sign=-1), arm).message.endswith("where joint 2 counts the other way.")
    both = same_mechanism(Chain(arm.joints, "modified", Tx(1), Tx(2)), arm)
    assert both.message == "The same mechanism, with another base and another tool."


def test_a_verdict_cannot_be_changed():
    verdict = same_mechanism(robots.planar(2), robots.planar(2))
    with pytest.raises(FrozenInstanceError):
        verdict.same = False


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((robots.planar(2), [[1, 2, 3, 4]]), "the reference is .* compares two Chains"),
        (("arm", robots.planar(2)), "the answer is 'arm'"),
        ((robots.planar(2), robots.planar(2), 0), "tol is 0; it should be a number between 0 and 1"),
        ((robots.planar(2), robots.planar(2), math.nan), "tol is nan"),
        ((robots.planar(2), robots.planar(2), "small"), "tol is 'small'"),
    ],
)
def test_misuse(arguments, message):
    with pytest.raises(DHError, match=message):
        same_mechanism(*arguments)


def test_more_misuse():
    sympy = pytest.importorskip("sympy")
    arm = Chain([Revolute(a=sympy.Symbol("l"))], "classic")
    with pytest.raises(DHError, match="the answer holds symbols"):
        same_mechanism(arm, robots.planar(1))
    with pytest.raises(DHError, match="free holds 'flange'"):
        same_mechanism(robots.planar(1), robots.planar(1), free=("flange",))
    assert same_mechanism(robots.planar(1), Chain([Revolute(a=sympy.Integer(1))], "classic"))


# Mirrors


def test_mirror_images():
    rng = np.random.default_rng(10)
    reflection = np.diag([1, -1, 1, 1])
    for _ in range(50):
        arm = random_arm(rng)
        for each in (arm, arm.to_modified()):
            image = mirror_image(each)
            q = rng.uniform(-2, 2, (3, arm.n))
            assert image.fk(q) == pytest.approx(reflection @ each.fk(q) @ reflection, abs=1e-12)
        verdict = same_mechanism(disguised(mirror_image(arm), rng), arm)
        assert verdict or verdict.mirror
    assert not same_mechanism(mirror_image(CORKE), CORKE)
    assert same_mechanism(mirror_image(robots.planar(3)), robots.planar(3))
