"""A chain as plain data, for programs that are not Python: the figures of the book read it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.joints import Prismatic, Revolute
from dhlib.normals import common_normal


def chain_data(chain: Chain) -> dict[str, Any]:
    """Return what a chain is, as plain lists, numbers and strings.

    Parameters
    ----------
    chain : Chain
        With numbers throughout.

    Returns
    -------
    dict
        ``name``, ``unit``, ``convention``; ``joints``, each with ``kind`` (R or P), ``theta`` and ``d`` at q = 0,
        ``a``, ``alpha``, ``sign`` and ``limits`` (null where none is known), angles in radians; ``base`` and
        ``tool`` as four rows of four.

    Raises
    ------
    DHError
        If the chain holds symbols.

    Examples
    --------
    >>> from dhlib import robots
    >>> chain_data(robots.planar(1))["joints"]
    [{'kind': 'R', 'theta': 0.0, 'd': 0.0, 'a': 1.0, 'alpha': 0.0, 'sign': 1, 'limits': None}]
    """
    if chain.is_symbolic:
        raise DHError("this chain holds symbols, which cannot be exported. Give them values first.")
    joints = [
        {
            "kind": joint.kind,
            "theta": float(joint.theta),
            "d": float(joint.d),
            "a": float(joint.a),
            "alpha": float(joint.alpha),
            "sign": joint.sign,
            "limits": None if joint.limits is None else list(joint.limits),
        }
        for joint in chain.joints
    ]
    return {
        "name": chain.name,
        "unit": chain.unit,
        "convention": chain.convention,
        "joints": joints,
        "base": np.asarray(chain.base, dtype=np.float64).tolist(),
        "tool": np.asarray(chain.tool, dtype=np.float64).tolist(),
    }


def chain_json(chain: Chain) -> str:
    """Return :func:`chain_data` as JSON text; numbers keep all their digits.

    Parameters
    ----------
    chain : Chain

    Returns
    -------
    str

    Raises
    ------
    DHError
        If the chain holds symbols.

    Examples
    --------
    >>> from dhlib import robots
    >>> chain_json(robots.planar(1))[:42]
    '{"name":"Planar 1R","unit":"m","convention'
    """
    return to_json(chain_data(chain))


def to_json(data: Any) -> str:
    """Return plain data as JSON text, as short as it goes.

    Parameters
    ----------
    data : dict, list, number or string

    Returns
    -------
    str

    Examples
    --------
    >>> to_json({"q": [0.1, None]})
    '{"q":[0.1,null]}'
    """
    return json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))


def read_chain(data: Mapping[str, Any]) -> Chain:
    """Return the chain that :func:`chain_data` has written.

    Parameters
    ----------
    data : mapping

    Returns
    -------
    Chain

    Examples
    --------
    >>> from dhlib import robots
    >>> read_chain(chain_data(robots.stanford())) == robots.stanford()
    True
    """
    joints = []
    for entry in data["joints"]:
        turns = entry["kind"] == "R"
        zero, constant = ("theta", "d") if turns else ("d", "theta")
        joints.append(
            (Revolute if turns else Prismatic)(
                **{constant: entry[constant]},
                a=entry["a"],
                alpha=entry["alpha"],
                offset=entry[zero],
                sign=entry["sign"],
                limits=None if entry["limits"] is None else tuple(entry["limits"]),
            )
        )
    return Chain(joints, data["convention"], base=data["base"], tool=data["tool"], name=data["name"], unit=data["unit"])


def bodies(chain: Chain) -> dict[str, Any]:
    """Return how large an arm is drawn, and where the body of each joint sits on its axis, at q = 0.

    Parameters
    ----------
    chain : Chain
        With numbers throughout.

    Returns
    -------
    dict
        ``size``; ``heights`` (n), from the point that ``chain.axes()`` names, in the sense of the axis.

    Examples
    --------
    >>> from dhlib import robots
    >>> sorted(bodies(robots.planar(2)))
    ['heights', 'size']
    """
    from dhlib.drawing import draw

    drawing = draw(chain, [0.0] * chain.n)
    heights = [
        float((joint.centre - axis.point) @ axis.direction)
        for joint, axis in zip(drawing.joints, chain.axes(), strict=True)
    ]
    return {"heights": heights, "size": drawing.size}


def figure_data(chain: Chain) -> dict[str, Any]:
    """Return what a live figure shows of an arm.

    Parameters
    ----------
    chain : Chain
        With numbers throughout.

    Returns
    -------
    dict
        The arm as ``classic`` and as ``modified`` chain; the `bodies` of the classic one; whether it has an ``elbow``
        circle.

    Examples
    --------
    >>> from dhlib import robots
    >>> data = figure_data(robots.pa10_7c())
    >>> data["elbow"], data["modified"]["convention"], len(data["heights"])
    (True, 'modified', 7)
    """
    classic = chain.to_classic()
    return {
        "classic": chain_data(classic),
        "modified": chain_data(chain.to_modified()),
        **bodies(classic),
        "elbow": has_elbow_circle(chain),
    }


def has_elbow_circle(chain: Chain) -> bool:
    """Say whether the elbow of an arm can go round while its hand rests.

    Parameters
    ----------
    chain : Chain

    Returns
    -------
    bool
        True for seven revolute joints, of which 1, 2, 3 meet in the shoulder and 5, 6, 7 in the wrist, each at right
        angles to the next.

    Examples
    --------
    >>> from dhlib import robots
    >>> has_elbow_circle(robots.pa10_7c()), has_elbow_circle(robots.panda())
    (True, False)
    """
    if chain.kinds != "RRRRRRR":
        return False
    axes = chain.axes()
    normals = [common_normal(axes[k], axes[k + 1]) for k in (0, 1, 4, 5)]
    crossed = all(n.kind == "intersecting" and abs(n.angle - math.pi / 2) < 1e-9 for n in normals)
    meet = all(np.allclose(normals[k].after, normals[k + 1].before, atol=1e-9 * chain.reach) for k in (0, 2))
    return crossed and meet
