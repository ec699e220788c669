"""Forward kinematics by columns.

A DH table, classic or modified, is a word of screws: ``Z_1 X_1 Z_2 X_2 … Z_n X_n`` with
``Z_i = R_z(θ_i) T_z(d_i)`` and ``X_i = T_x(a_i) R_x(α_i)``. Only the brackets differ: the classic convention
reads ``(Z_1 X_1)(Z_2 X_2)…``, the modified one ``(X_0 Z_1)(X_1 Z_2)…``.

A screw from the right turns two columns of the pose ``[n o a p]`` and moves p along the third:

* Z: ``n' = c n + s o``, ``o' = c o - s n``, ``p' = p + d a``
* X: ``o' = c o + s a``, ``a' = c a - s o``, ``p' = p + a_i n``

The entries may be floats, arrays of floats or sympy expressions: the code is the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from dhlib.scalars import FloatArray, Scalar

ScrewZ = tuple[Scalar, Scalar, Scalar]
"""cos θ, sin θ and d; None for a d that is 0."""

ScrewX = tuple[Scalar, Scalar, Scalar]
"""cos α, sin α and a; None for an a that is 0."""

Columns = tuple[Scalar, ...]
"""The twelve entries of a pose, column by column: n, o, a, p."""


def walk(screws: Iterable[tuple[ScrewZ, ScrewX]]) -> Iterator[tuple[Columns, Columns]]:
    """Yield, for each pair Z_i X_i, the pose after Z_i and the pose after X_i."""
    nx, ny, nz = 1, 0, 0
    ox, oy, oz = 0, 1, 0
    ax, ay, az = 0, 0, 1
    px, py, pz = 0, 0, 0
    for (c, s, d), (ca, sa, a) in screws:
        nx, ny, nz, ox, oy, oz = (
            c * nx + s * ox, c * ny + s * oy, c * nz + s * oz,
            c * ox - s * nx, c * oy - s * ny, c * oz - s * nz,
        )  # fmt: skip
        if d is not None:
            px, py, pz = px + d * ax, py + d * ay, pz + d * az
        after_z = nx, ny, nz, ox, oy, oz, ax, ay, az, px, py, pz
        if a is not None:
            px, py, pz = px + a * nx, py + a * ny, pz + a * nz
        if ca == 0:  # a quarter turn only swaps columns
            if sa == 1:
                ox, oy, oz, ax, ay, az = ax, ay, az, -ox, -oy, -oz
            else:
                ox, oy, oz, ax, ay, az = -ax, -ay, -az, ox, oy, oz
        elif sa != 0 or ca != 1:
            ox, oy, oz, ax, ay, az = (
                ca * ox + sa * ax, ca * oy + sa * ay, ca * oz + sa * az,
                ca * ax - sa * ox, ca * ay - sa * oy, ca * az - sa * oz,
            )  # fmt: skip
        yield after_z, (nx, ny, nz, ox, oy, oz, ax, ay, az, px, py, pz)


def to_rows(columns: Columns) -> list[list[Scalar]]:
    """The twelve entries as the rows of a 4×4 matrix."""
    nx, ny, nz, ox, oy, oz, ax, ay, az, px, py, pz = columns
    return [[nx, ox, ax, px], [ny, oy, ay, py], [nz, oz, az, pz], [0, 0, 0, 1]]


def to_pose(columns: Columns) -> FloatArray:
    """The twelve entries, floats, as an array (4, 4)."""
    nx, ny, nz, ox, oy, oz, ax, ay, az, px, py, pz = columns
    pose: FloatArray = np.array([nx, ox, ax, px, ny, oy, ay, py, nz, oz, az, pz, 0.0, 0.0, 0.0, 1.0]).reshape(4, 4)
    return np.add(pose, 0.0, out=pose)  # turns -0.0 into 0.0


def write(columns: Columns, out: FloatArray | Any) -> None:
    """Write the twelve entries, floats or arrays (N,), into a block (N, 4, 4)."""
    for k, entry in enumerate(columns):
        out[:, k % 3, k // 3] = entry
    out[:, 3] = 0, 0, 0, 1
    np.add(out, 0.0, out=out)  # turns -0.0 into 0.0
