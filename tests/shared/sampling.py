"""Long tests take a sample, the same one each time; ``make test FULL=1`` takes all."""

from __future__ import annotations

import os
import random
from collections.abc import Sequence
from typing import TypeVar

Item = TypeVar("Item")

FULL = bool(os.environ.get("DHBOOK_FULL"))


def some(items: Sequence[Item], count: int, seed: str = "") -> list[Item]:
    """Return so many of the items, in their order, drawn by a seed; all of them if the long parts run whole."""
    if FULL or count >= len(items):
        return list(items)
    chosen = sorted(random.Random(seed).sample(range(len(items)), count))
    return [items[k] for k in chosen]
