"""Arms to test with: every robot of the library, and random chains."""

import numpy as np

from dhlib import Chain, Prismatic, Revolute, robots

EVERY_ROBOT = {
    "planar2": robots.planar(2),
    "planar3": robots.planar(3),
    "quickshot": robots.quickshot(),
    **{f"puma_{source}": robots.puma560(convention, source) for source, convention in
       {"craig": "modified", "corke": "classic", "akb": "modified", "fgl": "classic"}.items()},
    **{f"pa10_7c_{lengths}": robots.pa10_7c(lengths=lengths) for lengths in ("A", "B", "B2")},
    "pa10_6c": robots.pa10_6c(),
    "stanford": robots.stanford(),
    "cobra600": robots.cobra600(),
    "ur5": robots.ur5(),
    "panda": robots.panda(),
    "iiwa14": robots.iiwa14(),
    "irb140": robots.irb140(),
}  # fmt: skip

PLAIN_ANGLES = np.deg2rad([-180, -90, 0, 90, 180])


def random_joint(rng: np.random.Generator) -> Revolute | Prismatic:
    """A joint with generic or plain angles and lengths, that may turn the other way."""
    alpha = rng.choice(PLAIN_ANGLES) if rng.random() < 0.5 else rng.uniform(-3, 3)
    constant, offset = rng.uniform(-1, 1, 2) * (rng.random(2) < 0.7)
    link = {"a": rng.uniform(-1, 1) * (rng.random() < 0.7), "alpha": alpha, "sign": int(rng.choice([1, -1]))}
    if rng.random() < 0.7:
        return Revolute(d=constant, offset=offset, **link)
    return Prismatic(theta=constant, offset=offset, **link)


def random_pose(rng: np.random.Generator) -> np.ndarray:
    """A pose anywhere."""
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    pose = np.eye(4)
    pose[:3, :3] = rotation * np.sign(np.linalg.det(rotation))
    pose[:3, 3] = rng.uniform(-1, 1, 3)
    return pose


def random_chain(rng: np.random.Generator, convention: str) -> Chain:
    """A chain of one to seven joints, half of them with base and tool."""
    ends = {"base": random_pose(rng), "tool": random_pose(rng)} if rng.random() < 0.5 else {}
    return Chain([random_joint(rng) for _ in range(rng.integers(1, 8))], convention, **ends)
