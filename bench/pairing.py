"""Time two ways to do the same work: turn and turn about, in one process, so that noise hits both alike."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from statistics import median
from typing import Any

#: A single timing shorter than this is repeated within the round.
SHORTEST = 0.02


@dataclass(frozen=True)
class Pair:
    """Medians over all rounds, in seconds for one piece of work, and the median of the ratios round by round."""

    ours: float
    peer: float
    ratio: float
    rounds: int

    def as_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        return asdict(self)


def side_by_side(
    ours: Callable[[], Any],
    peer: Callable[[], Any],
    *,
    rounds: int = 9,
    our_pieces: int = 1,
    peer_pieces: int = 1,
) -> Pair:
    """Compare the time for one piece of work.

    Parameters
    ----------
    ours, peer : callable
        Each does its work once per call.
    rounds : int
        How often each is timed, by turns.
    our_pieces, peer_pieces : int
        How many pieces of work a call does, where a slow peer is given fewer of the same.

    Returns
    -------
    Pair
    """
    calls = _warmed_up(ours), _warmed_up(peer)
    times: list[tuple[float, float]] = []
    gc.collect()
    gc.disable()
    try:
        for k in range(rounds):
            first, second = (0, 1) if k % 2 == 0 else (1, 0)
            taken = [0.0, 0.0]
            for which in (first, second):
                work, repeat = ((ours, calls[0]), (peer, calls[1]))[which]
                taken[which] = _time(work, repeat)
            times.append((taken[0] / our_pieces, taken[1] / peer_pieces))
    finally:
        gc.enable()
    return Pair(median(a for a, _ in times), median(b for _, b in times), median(b / a for a, b in times), rounds)


def _warmed_up(work: Callable[[], Any]) -> int:
    """Run once for warmth, then find how often it must run to be timed."""
    work()
    taken = _time(work, 1)
    return max(1, int(SHORTEST / max(taken, 1e-9)))


def _time(work: Callable[[], Any], repeat: int) -> float:
    begin = time.perf_counter()
    for _ in range(repeat):
        work()
    return (time.perf_counter() - begin) / repeat
