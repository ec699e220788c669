"""The two conventions: four parameters, one link matrix.

Both are words of two screws, one about z (θ and d: the joint) and one about x (a and α: the link):

* classic:  ``A_i = R_z(θ_i) T_z(d_i) T_x(a_i) R_x(α_i)``
* modified: ``A_i = R_x(α_{i-1}) T_x(a_{i-1}) R_z(θ_i) T_z(d_i)``
"""

from __future__ import annotations

from typing import Any

import numpy as np

from dhlib.errors import DHError
from dhlib.scalars import Scalar, cos_sin, exact, is_symbolic
from dhlib.transforms import Pose, matrix, read_parameter

CONVENTIONS = ("classic", "modified")


def classic(theta: Scalar, d: Scalar, a: Scalar, alpha: Scalar) -> Pose:
    """Link matrix ⁱ⁻¹A_i of the classic (distal) convention.

    Parameters
    ----------
    theta, d, a, alpha : float, array_like or sympy expression
        θ_i and α_i in radians, d_i and a_i in one unit of length, in the order of the operations.
        Arrays are broadcast against one another.

    Returns
    -------
    ndarray (…, 4, 4) or sympy Matrix (4, 4)
        ``R_z(θ) T_z(d) T_x(a) R_x(α)``.

    Raises
    ------
    DHError
        If an argument is not a finite number or a symbol.

    Notes
    -----
    J. Denavit and R. S. Hartenberg, *A kinematic notation for lower-pair mechanisms based on matrices*, 1955;
    in this form R. P. Paul, *Robot Manipulators*, 1981.

    Examples
    --------
    >>> import numpy as np
    >>> classic(0, 100, 20, -np.pi / 2)
    array([[  1.,   0.,   0.,  20.],
           [  0.,   0.,   1.,   0.],
           [  0.,  -1.,   0., 100.],
           [  0.,   0.,   0.,   1.]])
    """
    theta, d, a, alpha = _read(theta=theta, d=d, a=a, alpha=alpha)
    (c, s), (ca, sa) = cos_sin(theta), cos_sin(alpha)
    return matrix(
        [
            [c, -s * ca, s * sa, a * c],
            [s, c * ca, -c * sa, a * s],
            [0, sa, ca, d],
            [0, 0, 0, 1],
        ]
    )


def modified(alpha: Scalar, a: Scalar, theta: Scalar, d: Scalar) -> Pose:
    """Link matrix ⁱ⁻¹A_i of the modified (proximal) convention.

    Parameters
    ----------
    alpha, a, theta, d : float, array_like or sympy expression
        α_{i-1} and θ_i in radians, a_{i-1} and d_i in one unit of length, in the order of the operations.
        Arrays are broadcast against one another.

    Returns
    -------
    ndarray (…, 4, 4) or sympy Matrix (4, 4)
        ``R_x(α) T_x(a) R_z(θ) T_z(d)``.

    Raises
    ------
    DHError
        If an argument is not a finite number or a symbol.

    Notes
    -----
    John J. Craig, *Introduction to Robotics: Mechanics and Control*, 1986, equation 3.6.

    Examples
    --------
    >>> import numpy as np
    >>> modified(-np.pi / 2, 20, 0, 0)
    array([[ 1.,  0.,  0., 20.],
           [ 0.,  0.,  1.,  0.],
           [ 0., -1.,  0.,  0.],
           [ 0.,  0.,  0.,  1.]])
    """
    alpha, a, theta, d = _read(alpha=alpha, a=a, theta=theta, d=d)
    (ca, sa), (c, s) = cos_sin(alpha), cos_sin(theta)
    return matrix(
        [
            [c, -s, 0, a],
            [s * ca, c * ca, -sa, -sa * d],
            [s * sa, c * sa, ca, ca * d],
            [0, 0, 0, 1],
        ]
    )


def link_screw(a: Scalar, alpha: Scalar) -> Pose:
    """The screw of a link alone: ``T_x(a) R_x(α)``, which both conventions share.

    Examples
    --------
    >>> float(link_screw(20, 0)[0, 3])
    20.0
    """
    return classic(0, 0, a, alpha)


def _read(**parameters: Any) -> list[Scalar]:
    """The parameters as numbers; beside a symbol as exact numbers, so that -π/2 and 100 stay what they are."""
    values = {name: read_parameter(value, name) for name, value in parameters.items()}
    if any(is_symbolic(value) for value in values.values()):
        for name, value in values.items():
            if isinstance(value, np.ndarray):
                raise DHError(
                    f"{name} is an array, and another parameter a symbol; give numbers or symbols one by one."
                )
        return [exact(value, angle=name in ("theta", "alpha")) for name, value in values.items()]
    return list(values.values())


def read_convention(convention: object) -> str:
    """Return the name of a convention, refusing any other."""
    if convention in CONVENTIONS:
        return str(convention)
    if convention in ("", None):
        raise DHError("convention='classic' or convention='modified' is needed: a table alone does not say which.")
    raise DHError(f"convention={convention!r} is unknown; it should be 'classic' or 'modified'.")
