"""A chain as plain data, for programs that are not Python: the figures of the book read it."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.errors import DHError


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
    return json.dumps(chain_data(chain), ensure_ascii=False, allow_nan=False, separators=(",", ":"))
