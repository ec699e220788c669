"""Homogeneous transforms: the six atomic ones, and their inverse.

A pose is a 4×4 matrix ``[n o a p; 0 0 0 1]``: where the axes of a frame point (n, o, a: its x, y and z axis)
and where its origin lies (p), seen from another frame.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from dhlib.errors import DHError
from dhlib.scalars import (
    FloatArray,
    Scalar,
    cos_sin,
    has_symbols,
    is_symbolic,
    read_array,
    read_scalar,
)

Pose = Any
"""A numpy array (…, 4, 4) or, where a symbol is in play, a sympy Matrix (4, 4)."""


def read_parameter(value: Any, what: str) -> Scalar:
    """Return one parameter of a transform as a float, an array of floats or a sympy expression."""
    if is_symbolic(value) or not isinstance(value, (np.ndarray, list, tuple)):
        return read_scalar(value, what)
    return read_array(value, what)


def matrix(rows: list[list[Scalar]]) -> Pose:
    """Put scalars together to a matrix: a sympy Matrix if any is a symbol, else an array (…, rows, columns)."""
    if any(is_symbolic(entry) for row in rows for entry in row):
        return sys.modules["sympy"].Matrix(rows)
    if any(isinstance(entry, np.ndarray) for row in rows for entry in row):
        entries = np.broadcast_arrays(*(entry for row in rows for entry in row))
        return np.stack(entries, axis=-1).reshape(*entries[0].shape, len(rows), len(rows[0]))
    return np.array(rows, dtype=np.float64) + 0.0  # + 0.0 turns -0.0 into 0.0


def Rx(alpha: Scalar) -> Pose:
    """Rotation about x.

    Parameters
    ----------
    alpha : float, array_like or sympy expression
        Angle in radians, positive by the right-hand rule.

    Returns
    -------
    ndarray (…, 4, 4) or sympy Matrix (4, 4)

    Raises
    ------
    DHError
        If `alpha` is not a finite number or a symbol.

    Examples
    --------
    >>> import numpy as np
    >>> Rx(np.pi / 2)
    array([[ 1.,  0.,  0.,  0.],
           [ 0.,  0., -1.,  0.],
           [ 0.,  1.,  0.,  0.],
           [ 0.,  0.,  0.,  1.]])
    """
    c, s = cos_sin(read_parameter(alpha, "the angle of Rx"))
    return matrix([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]])


def Ry(beta: Scalar) -> Pose:
    """Rotation about y; parameters as for :func:`Rx`.

    Examples
    --------
    >>> import numpy as np
    >>> Ry(np.pi / 2)
    array([[ 0.,  0.,  1.,  0.],
           [ 0.,  1.,  0.,  0.],
           [-1.,  0.,  0.,  0.],
           [ 0.,  0.,  0.,  1.]])
    """
    c, s = cos_sin(read_parameter(beta, "the angle of Ry"))
    return matrix([[c, 0, s, 0], [0, 1, 0, 0], [-s, 0, c, 0], [0, 0, 0, 1]])


def Rz(theta: Scalar) -> Pose:
    """Rotation about z; parameters as for :func:`Rx`.

    Examples
    --------
    >>> import numpy as np
    >>> Rz(np.pi / 2)
    array([[ 0., -1.,  0.,  0.],
           [ 1.,  0.,  0.,  0.],
           [ 0.,  0.,  1.,  0.],
           [ 0.,  0.,  0.,  1.]])
    """
    c, s = cos_sin(read_parameter(theta, "the angle of Rz"))
    return matrix([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def Tx(a: Scalar) -> Pose:
    """Translation along x.

    Parameters
    ----------
    a : float, array_like or sympy expression
        Length, in any unit.

    Returns
    -------
    ndarray (…, 4, 4) or sympy Matrix (4, 4)

    Raises
    ------
    DHError
        If `a` is not a finite number or a symbol.

    Examples
    --------
    >>> Tx(160)[:3, 3]
    array([160.,   0.,   0.])
    """
    a = read_parameter(a, "the length of Tx")
    return matrix([[1, 0, 0, a], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def Ty(b: Scalar) -> Pose:
    """Translation along y; parameters as for :func:`Tx`.

    Examples
    --------
    >>> Ty(2)[:3, 3]
    array([0., 2., 0.])
    """
    b = read_parameter(b, "the length of Ty")
    return matrix([[1, 0, 0, 0], [0, 1, 0, b], [0, 0, 1, 0], [0, 0, 0, 1]])


def Tz(d: Scalar) -> Pose:
    """Translation along z; parameters as for :func:`Tx`.

    Examples
    --------
    >>> Tz(100)[:3, 3]
    array([  0.,   0., 100.])
    """
    d = read_parameter(d, "the length of Tz")
    return matrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, d], [0, 0, 0, 1]])


def inverse(pose: Pose) -> Pose:
    """The inverse of a pose, by transposing instead of inverting: ``[Rᵀ, -Rᵀ p; 0 0 0 1]``.

    Parameters
    ----------
    pose : ndarray (…, 4, 4) or sympy Matrix (4, 4)

    Returns
    -------
    ndarray (…, 4, 4) or sympy Matrix (4, 4)

    Examples
    --------
    >>> import numpy as np
    >>> np.allclose(inverse(Rz(0.3) @ Tx(2)) @ Rz(0.3) @ Tx(2), np.eye(4))
    True
    """
    if is_symbolic(pose):
        turned = pose[:3, :3].T
        return turned.row_join(-turned * pose[:3, 3]).col_join(pose[3, :])
    pose = np.asarray(pose)
    result = np.zeros_like(pose)
    turned = np.swapaxes(pose[..., :3, :3], -1, -2)
    result[..., :3, :3] = turned
    result[..., :3, 3] = -np.einsum("...ij,...j->...i", turned, pose[..., :3, 3])
    result[..., 3, 3] = 1.0
    return result + 0.0


def read_pose(value: Any, what: str, tol: float = 1e-9) -> Pose:
    """Return `value` as a 4×4 pose.

    Raises
    ------
    DHError
        If it is not 4×4, its last row is not (0, 0, 0, 1), its axes are not orthonormal, or its determinant
        is -1. The message says which.
    """
    if has_symbols(value):
        pose = sys.modules["sympy"].Matrix(value)
        if pose.shape != (4, 4):
            raise DHError(f"{what} has shape {pose.shape}; a pose is a 4×4 matrix.")
        if pose.free_symbols:
            return pose
        read_pose(np.array(pose.tolist(), dtype=float), what, tol)
        return pose
    pose = read_array(value, what)
    if pose.shape != (4, 4):
        raise DHError(f"{what} has shape {pose.shape}; a pose is a 4×4 matrix.")
    fault = pose_fault(pose, tol)
    if fault:
        raise DHError(f"{what} is no pose: {fault}.")
    return pose


def pose_fault(pose: FloatArray, tol: float = 1e-9) -> str:
    """Say in words why a 4×4 matrix is no pose; an empty string where it is one.

    Examples
    --------
    >>> pose_fault(Rz(1.0))
    ''
    >>> import numpy as np
    >>> pose_fault(np.diag([1.0, 1.0, -1.0, 1.0]))
    'its determinant is -1, so its axes are left-handed (a mirror image)'
    """
    if not np.allclose(pose[3], [0, 0, 0, 1], atol=tol):
        if np.allclose(pose[:, 3], [0, 0, 0, 1], atol=tol):
            return "its last row is not (0, 0, 0, 1) but its last column is, so it is transposed"
        return "its last row is not (0, 0, 0, 1)"
    rotation = pose[:3, :3]
    lengths = np.sqrt((rotation**2).sum(axis=0))
    for name, length in zip("noa", lengths, strict=True):
        if abs(length - 1) > tol:
            return f"its column {name} has length {length:.4g}, not 1"
    for first, second in (("n", "o"), ("o", "a"), ("n", "a")):
        product = rotation[:, "noa".index(first)] @ rotation[:, "noa".index(second)]
        if abs(product) > tol:
            return f"its columns {first} and {second} are not perpendicular ({first}·{second} = {product:.4g})"
    if np.linalg.det(rotation) < 0:
        return "its determinant is -1, so its axes are left-handed (a mirror image)"
    return ""
