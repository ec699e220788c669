"""From joint axes to a DH table: 600 random arms, in which neighbouring axes lie to each other in every way.

``python placing.py idyntree`` in the environment of iDynTree prints one JSON object. Both get the same axes: ours as
lines in space, iDynTree's as the model that its documentation builds from a URDF. What comes out is right if it gives
the same poses as the product of exponentials, which knows no table.
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

sys.path.insert(0, str(Path(__file__).parents[1]))

from environment import size

from dhlib import Axis, place_frames
from dhlib.axes import product_of_exponentials

KINDS = ("skew", "intersecting", "parallel", "antiparallel", "coincident", "mixed")
ARMS = size(100, 5)
N = 6
RIGHT = 1e-6


def unit(vector: Any) -> Any:
    """A vector of length 1."""
    return vector / np.linalg.norm(vector)


def neighbour(random: Any, axis: Axis, kind: str) -> Axis:
    """An axis that lies to another as asked."""
    z = axis.direction
    side = unit(np.cross(z, random.normal(size=3)))
    angle = random.uniform(0.3, np.pi - 0.3)
    slanted = np.cos(angle) * z + np.sin(angle) * np.cross(side, z)
    here = axis.point + random.uniform(-1, 1) * z
    away = here + random.uniform(0.2, 1) * side
    point, direction = {
        "skew": (away, slanted),
        "intersecting": (here, slanted),
        "parallel": (away, z),
        "antiparallel": (away, -z),
        "coincident": (here, z),
    }[kind]
    return Axis(point, direction, "R")


def arms() -> list[tuple[str, list[Axis], Any]]:
    """A kind, the axes, and the end pose at q = 0. One pair of neighbours is of that kind, the others are skew."""
    random = np.random.default_rng(600)
    made = []
    for kind in KINDS:
        for _ in range(ARMS):
            axes = [Axis(random.normal(size=3), unit(random.normal(size=3)), "R")]
            special = random.integers(N - 1)
            for k in range(N - 1):
                how = random.choice(KINDS[:-1]) if kind == "mixed" else kind if k == special else "skew"
                axes.append(neighbour(random, axes[-1], how))
            end = np.eye(4)
            end[:3, :3] = np.linalg.qr(random.normal(size=(3, 3)))[0]
            end[:3, 0] *= np.linalg.det(end[:3, :3])
            end[:3, 3] = random.normal(size=3)
            made.append((kind, axes, end))
    return made


def ours(axes: list[Axis], end: Any) -> Callable[[Any], Any]:
    """Place the frames; give the forward kinematics of the table."""
    return place_frames(axes, convention="classic", end=end).chain.fk


def idyntree(axes: list[Axis], end: Any) -> Callable[[Any], Any]:
    """Documented: `ExtractDHChainFromModel` of a model read from a URDF; H0, links and HN give the pose."""
    import idyntree.bindings as tree

    loader = tree.ModelLoader()
    if not loader.loadModelFromString(urdf(axes, end)):
        raise RuntimeError("the URDF was not read")
    chain = tree.DHChain()
    if not tree.ExtractDHChainFromModel(loader.model(), "base", "end", chain, 1e-6):
        raise RuntimeError("no chain was extracted")
    first, last = (pose.asHomogeneousTransform().toNumPy() for pose in (chain.getH0(), chain.getHN()))
    # Numbers, not links: those die with the chain.
    rows = [(r.A, r.Alpha, r.D, r.Offset) for r in map(chain, range(chain.getNrOfDOFs()))]

    def fk(q: Any) -> Any:
        pose = first
        for (a, alpha, d, offset), angle in zip(rows, q, strict=True):
            pose = pose @ tree.TransformFromDH(a, alpha, d, angle + offset).asHomogeneousTransform().toNumPy()
        return pose @ last

    return fk


def urdf(axes: list[Axis], end: Any) -> str:
    """The arm as a URDF: a frame with the world's directions on each axis, at q = 0."""
    parts = ['<robot name="arm">', link("base")]
    before, at = "base", np.zeros(3)
    for k, axis in enumerate(axes, 1):
        xyz, z = words(axis.point - at), words(axis.direction)
        parts.append(link(f"link{k}") + joint(f"joint{k}", "revolute", before, f"link{k}", xyz, "0 0 0", z))
        before, at = f"link{k}", axis.point
    r = end[:3, :3]
    rpy = np.arctan2(r[2, 1], r[2, 2]), np.arctan2(-r[2, 0], np.hypot(r[0, 0], r[1, 0])), np.arctan2(r[1, 0], r[0, 0])
    parts.append(link("end") + joint("flange", "fixed", before, "end", words(end[:3, 3] - at), words(rpy), "0 0 1"))
    return "".join(parts) + "</robot>"


def link(name: str) -> str:
    """A link with a mass: without one its frame is not a link for iDynTree."""
    inertia = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    return f'<link name="{name}"><inertial><mass value="1"/>{inertia}</inertial></link>'


def joint(name: str, kind: str, parent: str, child: str, xyz: str, rpy: str, axis: str) -> str:
    """A joint; revolute ones want limits."""
    limit = '<limit lower="-3.2" upper="3.2" effort="1" velocity="1"/>' if kind == "revolute" else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{limit}</joint>'
    )


def words(numbers: Any) -> str:
    """Numbers as XML has them."""
    return " ".join(f"{float(number):.17g}" for number in numbers)


def judge(place: Callable[[list[Axis], Any], Callable[[Any], Any]]) -> tuple[dict[str, int], list[float]]:
    """How many arms of each kind are right, and the time for each."""
    right = dict.fromkeys(KINDS, 0)
    times = []
    random = np.random.default_rng(601)
    for kind, axes, end in arms():
        qs = random.uniform(-3, 3, (4, N))
        begin = time.perf_counter()
        try:
            fk = place(axes, end)
        except Exception:
            times.append(time.perf_counter() - begin)
            continue
        times.append(time.perf_counter() - begin)
        # A tool that is only turned or shifted would be another end: compare the poses themselves.
        off = max(np.abs(fk(q) - product_of_exponentials(axes, end, q)).max() for q in qs)
        right[kind] += bool(off < RIGHT)
    return right, times


def main() -> None:
    """Judge both."""
    rows = []
    for name, call, place in (
        ("dhlib", "place_frames(axes, end=…)", ours),
        ("idyntree", "ExtractDHChainFromModel(model, …)", idyntree),
    ):
        right, times = judge(place)
        rows.append({"peer": name, "call": call, "right": right, "of": ARMS, "median_ms": 1e3 * median(times)})
    json.dump({"rows": rows}, sys.stdout)


if __name__ == "__main__":
    main()
