"""An arm as somebody computes it who does one thing differently from the book.

It answers the same questions as a `Chain`, so that any quantity may be asked of it. Where the difference is one of
the table (a row exchanged, a sign turned) an ordinary chain serves: `altered` and `scaled` make those.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.joints import Joint
from dhlib.scalars import FloatArray
from dhlib.transforms import Rx, Rz, Tx, Tz, inverse

#: The four steps of a link matrix, in the order of each convention.
ORDER = {"classic": ("Rz", "Tz", "Tx", "Rx"), "modified": ("Rx", "Tx", "Rz", "Tz")}


@dataclass(frozen=True)
class Retelling:
    """A chain with something done differently.

    Parameters
    ----------
    chain : Chain
    steps : tuple of str, optional
        The four steps of each link, in another order.
    reverse : bool
        The link matrices multiplied in reverse order.
    entrywise : bool
        The link matrices multiplied entry by entry.
    without : int
        The link whose matrix is left out of products; 0 for none.
    joint_scale, twist_scale : float
        Joint angles and twists taken in a wrong unit.
    """

    chain: Chain
    steps: tuple[str, ...] = ()
    reverse: bool = False
    entrywise: bool = False
    without: int = 0
    joint_scale: float = 1.0
    twist_scale: float = 1.0

    @property
    def n(self) -> int:
        """Number of joints."""
        return self.chain.n

    @property
    def base(self) -> Any:
        """Pose of frame 0 in the world."""
        return self.chain.base

    @property
    def tool(self) -> Any:
        """Pose of the tool in frame n."""
        return self.chain.tool

    def A(self, i: int, q: Any) -> FloatArray:
        """Link matrix i, as told."""
        joint = self.chain.joints[i - 1]
        theta, d = joint.at((self.joint_scale if joint.kind == "R" else 1.0) * q[i - 1])
        matrices = {
            "Rz": Rz(theta),
            "Tz": Tz(d),
            "Tx": Tx(joint.a),
            "Rx": Rx(self.twist_scale * joint.alpha),
        }
        steps = self.steps or ORDER[self.chain.convention]
        product: FloatArray = reduce(np.matmul, (matrices[step] for step in steps))
        return product

    def T(self, i: int, j: int, q: Any) -> FloatArray:
        """Frame j in frame i, as told."""
        if i == j:
            return np.eye(4)
        if i > j:
            back: FloatArray = inverse(self.T(j, i, q))
            return back
        links = range(i + 1, j + 1)
        matrices = [self.A(k, q) for k in links if k != self.without or len(links) == 1]
        if self.entrywise:
            entries: FloatArray = np.prod(matrices, axis=0)
            return entries
        product: FloatArray = reduce(np.matmul, reversed(matrices) if self.reverse else matrices, np.eye(4))
        return product

    def fk(self, q: Any) -> FloatArray:
        """Tool in world, as told."""
        if self.entrywise:
            entries: FloatArray = np.prod([self.base, self.T(0, self.n, q), self.tool], axis=0)
            return entries
        pose: FloatArray = self.base @ self.T(0, self.n, q) @ self.tool
        return pose


def with_joints(chain: Chain, joints: Sequence[Joint], convention: str = "") -> Chain:
    """The chain with other rows, read in its own or in another convention."""
    return Chain(joints, convention or chain.convention, chain.base, chain.tool, chain.name, chain.unit)


def altered(chain: Chain, i: int | None = None, **changes: Any) -> Chain:
    """The chain with some of theta, d, a, alpha and sign changed in row i, or in all rows.

    A change may be a function of the joint.
    """

    def changed(joint: Joint) -> Joint:
        return joint.replace(**{name: new(joint) if callable(new) else new for name, new in changes.items()})

    return with_joints(chain, [changed(j) if i in (None, k) else j for k, j in enumerate(chain.joints, 1)])


def with_ends(chain: Chain, base: Any = None, tool: Any = None) -> Chain:
    """The chain with another base and tool; none if left out."""
    return Chain(chain.joints, chain.convention, base, tool, chain.name, chain.unit)


def scaled(chain: Chain, factor: float) -> Chain:
    """The chain with all its lengths multiplied."""

    def longer(pose: Any) -> FloatArray:
        moved = np.array(pose, dtype=float)
        moved[:3, 3] *= factor
        return moved

    joints = [joint.replace(a=factor * joint.a, d=factor * joint.d) for joint in chain.joints]
    return Chain(joints, chain.convention, longer(chain.base), longer(chain.tool), chain.name, chain.unit)


def in_degrees(chain: Chain) -> list[Retelling]:
    """The chain with angles in a wrong unit: all of them, those of the joints, or the twists."""
    told = Retelling(chain)
    factors = (180 / math.pi, math.pi / 180)
    return [
        replace(told, joint_scale=joints, twist_scale=twists)
        for factor in factors
        for joints, twists in ((factor, factor), (factor, 1.0), (1.0, factor))
    ]
