"""One row of a DH table: a joint, and the link beside it.

Of the four parameters a and α describe the link and are constant. One of θ and d is the joint's variable; the
other is constant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from dhlib.errors import DHError
from dhlib.scalars import Scalar, is_symbolic, read_scalar

Limits = tuple[float, float]


@dataclass(frozen=True, init=False, repr=False)
class Joint:
    """What revolute and prismatic joints have in common; make a :class:`Revolute` or a :class:`Prismatic`.

    ``theta`` and ``d`` are the joint parameters at q = 0. ``a`` and ``alpha`` stand in the row of the joint: a_i
    and α_i in a classic chain, a_{i-1} and α_{i-1} in a modified one.
    """

    kind: ClassVar[str]
    variable: ClassVar[str]

    theta: Scalar
    d: Scalar
    a: Scalar
    alpha: Scalar
    limits: Limits | None
    sign: int

    def _fill(self, names: dict[str, str], unknown: dict[str, Any], **values: Any) -> None:
        """Check the values and keep them; `names` tells under which keyword the user gave θ and d."""
        here = f"{type(self).__name__}(…)"
        if unknown:
            self._refuse(here, next(iter(unknown)), names)
        values["theta"] = read_angle(values["theta"], f"{names['theta']} of {here}")
        values["alpha"] = read_angle(values["alpha"], f"alpha of {here}")
        values["d"] = read_scalar(values["d"], f"{names['d']} of {here}")
        values["a"] = read_scalar(values["a"], f"a of {here}")
        values["limits"] = read_limits(values["limits"], here)
        if values["sign"] not in (1, -1):
            raise DHError(f"sign of {here} is {values['sign']!r}; it should be 1, or -1 for a joint that counts down.")
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def _refuse(self, here: str, name: str, names: dict[str, str]) -> None:
        if name == self.variable:
            other = "Prismatic" if self.kind == "R" else "Revolute"
            raise DHError(
                f"{here} was given {name}, but {name} is the variable of this joint. "
                f"Give its zero as offset=…, or use {other} if {name} is constant."
            )
        constant = "d" if self.kind == "R" else "theta"
        raise DHError(f"{here} has no parameter {name!r}; it takes {constant}, a, alpha, offset, limits and sign.")

    @property
    def offset(self) -> Scalar:
        """What the variable is at q = 0: θ of a revolute joint, d of a prismatic one."""
        return self.theta if self.kind == "R" else self.d

    def at(self, q: Scalar) -> tuple[Scalar, Scalar]:
        """Return θ and d at q: one of them is ``sign * q + offset``.

        Examples
        --------
        >>> Revolute(d=2.0, offset=0.5, sign=-1).at(0.25)
        (0.25, 2.0)
        """
        varied = self.sign * q + self.offset
        return (varied, self.d) if self.kind == "R" else (self.theta, varied)

    def replace(self, **changes: Any) -> Joint:
        """Return the joint with some of theta, d, a, alpha, limits, sign and offset changed.

        Examples
        --------
        >>> Revolute(d=2, a=1).replace(a=3)
        Revolute(d=2, a=3)
        """
        new = {name: getattr(self, name) for name in ("theta", "d", "a", "alpha", "limits", "sign")}
        new["offset"] = new.pop(self.variable)
        if self.variable in changes:
            changes["offset"] = changes.pop(self.variable)
        return type(self)(**new | changes)

    def __repr__(self) -> str:
        from dhlib.show import joint_text

        return joint_text(self)


class Revolute(Joint):
    """A joint that turns about its axis: θ = q + offset, d constant.

    Parameters
    ----------
    d : float or sympy expression
        Link offset.
    a, alpha : float or sympy expression
        Link length, and link twist in radians, of this row: (a_i, α_i) in a classic chain, (a_{i-1}, α_{i-1})
        in a modified one.
    offset : float or sympy expression
        θ at q = 0, in radians.
    limits : (float, float), optional
        Smallest and largest q, in radians.
    sign : {1, -1}
        -1 for a joint whose q counts the other way: θ = -q + offset.

    Raises
    ------
    DHError
        If a parameter is unknown, not a finite number or a symbol, or an angle beyond a whole turn.

    Examples
    --------
    >>> import numpy as np
    >>> Revolute(d=100, a=20, alpha=-np.pi / 2)
    Revolute(d=100, a=20, alpha=-90°)
    """

    kind = "R"
    variable = "theta"

    def __init__(
        self,
        d: Scalar = 0.0,
        a: Scalar = 0.0,
        alpha: Scalar = 0.0,
        offset: Scalar = 0.0,
        limits: Limits | None = None,
        sign: int = 1,
        **unknown: Any,
    ) -> None:
        names = {"theta": "offset", "d": "d"}
        self._fill(names, unknown, theta=offset, d=d, a=a, alpha=alpha, limits=limits, sign=sign)


class Prismatic(Joint):
    """A joint that slides along its axis: d = q + offset, θ constant.

    Parameters
    ----------
    theta : float or sympy expression
        Joint angle in radians.
    a, alpha : float or sympy expression
        Link length, and link twist in radians, of this row, as for :class:`Revolute`.
    offset : float or sympy expression
        d at q = 0.
    limits : (float, float), optional
        Smallest and largest q, in the unit of length.
    sign : {1, -1}
        -1 for a joint whose q counts the other way: d = -q + offset.

    Raises
    ------
    DHError
        As for :class:`Revolute`.

    Examples
    --------
    >>> import numpy as np
    >>> Prismatic(theta=-np.pi / 2)
    Prismatic(theta=-90°)
    """

    kind = "P"
    variable = "d"

    def __init__(
        self,
        theta: Scalar = 0.0,
        a: Scalar = 0.0,
        alpha: Scalar = 0.0,
        offset: Scalar = 0.0,
        limits: Limits | None = None,
        sign: int = 1,
        **unknown: Any,
    ) -> None:
        names = {"theta": "theta", "d": "offset"}
        self._fill(names, unknown, theta=theta, d=offset, a=a, alpha=alpha, limits=limits, sign=sign)


def read_angle(value: Any, what: str) -> Scalar:
    """Return an angle that is part of a robot's build, refusing one beyond a whole turn."""
    angle = read_scalar(value, what)
    if (not is_symbolic(angle) or angle.is_number) and abs(float(angle)) > 2 * math.pi + 1e-9:
        raise DHError(
            f"{what} is {float(angle):g} rad, more than a whole turn. Are these degrees? "
            "Give radians, for example numpy.deg2rad(90), or use Chain.from_table(…, degrees=True)."
        )
    return angle


def read_limits(limits: Any, here: str) -> Limits | None:
    """Return limits as a pair of floats, refusing anything that is no interval."""
    if limits is None:
        return None
    try:
        low, high = (float(limit) for limit in limits)
    except (TypeError, ValueError):
        raise DHError(f"limits of {here} are {limits!r}; they should be two numbers (low, high).") from None
    if not low <= high:
        raise DHError(f"limits of {here} are ({low:g}, {high:g}); the first should not be above the second.")
    return low, high
