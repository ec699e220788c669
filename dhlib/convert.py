"""From one convention to the other: the link columns move one row.

Both conventions write the same word ``X_0 Z_1 X_1 Z_2 … Z_n X_n`` and differ only in the brackets. The classic
table has no place for X_0, the modified one none for X_n: what is left over goes to the base, or to the tool.
"""

from __future__ import annotations

from collections.abc import Sequence

from dhlib.chain import Chain
from dhlib.scalars import Scalar

Link = tuple[Scalar, Scalar]
"""a and α of one screw about x."""


def to_modified(chain: Chain) -> Chain:
    """The same arm in the modified convention; see :meth:`Chain.to_modified`."""
    if chain.convention == "modified":
        return chain
    *links, last = [chain._left_over, *((joint.a, joint.alpha) for joint in chain.joints)]
    return _rebracketed(chain, "modified", links, last)


def to_classic(chain: Chain) -> Chain:
    """The same arm in the classic convention; see :meth:`Chain.to_classic`."""
    if chain.convention == "classic":
        return chain
    first, *links = [*((joint.a, joint.alpha) for joint in chain.joints), chain._left_over]
    return _rebracketed(chain, "classic", links, first)


def _rebracketed(chain: Chain, convention: str, links: Sequence[Link], left_over: Link) -> Chain:
    joints = [joint.replace(a=a, alpha=alpha) for joint, (a, alpha) in zip(chain.joints, links, strict=True)]
    converted = Chain(joints, convention, chain._own_base, chain._own_tool, chain.name, chain.unit)
    converted._left_over = left_over
    return converted
