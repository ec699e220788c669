"""T_6 of the PUMA 560 in symbols: how long it takes, and how many operations are left.

``python symbolic.py PEER`` prints one JSON object; the peers are ways to get there with sympy.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import sympy
from sympy.core.cache import clear_cache

sys.path.insert(0, str(Path(__file__).parents[1]))

from environment import size

from dhlib import Chain, robots

ROUNDS = size(5, 1)


def product(arm: Chain) -> Any:
    """The product of the link matrices, with exact twists, as anybody writes it."""
    pose = sympy.eye(4)
    for i, joint in enumerate(arm.joints, 1):
        theta = sympy.Symbol(f"theta{i}")
        alpha = sympy.pi / 2 * round(2 * joint.alpha / np.pi)
        c, s, ca, sa = sympy.cos(theta), sympy.sin(theta), sympy.cos(alpha), sympy.sin(alpha)
        a, d = joint.a, joint.d
        pose *= sympy.Matrix(
            [[c, -s, 0, a], [s * ca, c * ca, -sa, -d * sa], [s * sa, c * sa, ca, d * ca], [0, 0, 0, 1]]
        )
    return pose


def sympy_trigsimp(arm: Chain) -> dict[str, Callable[[], Any]]:
    """Plain sympy: multiply, then `trigsimp`."""
    return {"product, then trigsimp": lambda: product(arm).applyfunc(sympy.trigsimp)}


def sympy_simplify(arm: Chain) -> dict[str, Callable[[], Any]]:
    """Plain sympy: multiply, then `simplify`."""
    return {"product, then simplify": lambda: product(arm).applyfunc(sympy.simplify)}


def roboticstoolbox(arm: Chain) -> dict[str, Callable[[], Any]]:
    """Documented: symbolic links, `fkine` of symbols, then `simplify` of what comes out."""
    import roboticstoolbox as rtb

    joints = sympy.symbols(f"theta1:{arm.n + 1}")

    def make() -> Any:
        links = [rtb.RevoluteMDH(alpha=sympy.pi / 2 * round(2 * j.alpha / np.pi), a=j.a, d=j.d) for j in arm.joints]
        robot = rtb.DHRobot(links, symbolic=True)
        return sympy.Matrix(robot.fkine(joints).A).applyfunc(sympy.simplify)

    return {"robot.fkine(symbols), then simplify": make}


PEERS = {"sympy_trigsimp": sympy_trigsimp, "sympy_simplify": sympy_simplify, "roboticstoolbox": roboticstoolbox}


def timed(make: Callable[[], Any]) -> tuple[float, Any]:
    """Time one making from a cold cache: sympy remembers what it simplified."""
    clear_cache()
    begin = time.perf_counter()
    made = make()
    return time.perf_counter() - begin, made


def off(matrix: Any, arm: Chain) -> float:
    """How far the formula is from the numbers at a few joint vectors."""
    joints = sympy.symbols(f"theta1:{arm.n + 1}")
    value = sympy.lambdify(joints, matrix, modules="numpy")
    qs = np.random.default_rng(1).uniform(-3, 3, (5, arm.n))
    return max(float(np.abs(np.array(value(*q), dtype=float) - arm.fk(q)).max()) for q in qs)


def shared_operations(matrix: Any) -> int:
    """How many operations are left when what occurs twice is computed once."""
    steps, entries = sympy.cse(list(matrix))
    return int(sum(sympy.count_ops(formula) for _, formula in steps) + sum(map(sympy.count_ops, entries)))


def main() -> None:
    """Time ours and the peer's by turns."""
    peer = sys.argv[1]
    arm = robots.puma560("modified", source="craig")
    ways = {"arm.symbolic()": arm.symbolic, **PEERS[peer](arm)}
    arm.symbolic()
    times: dict[str, list[float]] = {call: [] for call in ways}
    made: dict[str, Any] = {}
    for _ in range(ROUNDS):
        for call, make in ways.items():
            taken, made[call] = timed(make)
            times[call].append(taken)
    rows = [
        {
            "peer": peer if call != "arm.symbolic()" else "dhlib",
            "call": call,
            "seconds": median(times[call]),
            "ratio": median(b / a for a, b in zip(times["arm.symbolic()"], times[call], strict=True)),
            "operations": int(sum(sympy.count_ops(entry) for entry in made[call])),
            "shared": shared_operations(made[call]),
            "off": off(made[call], arm),
        }
        for call in ways
    ]
    json.dump({"sympy": sympy.__version__, "rows": rows}, sys.stdout)


if __name__ == "__main__":
    main()
