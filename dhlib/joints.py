"""One row of a DH table: a joint, and the link beside it.

Of the four parameters a and α describe the link and are constant. One of θ and d is the joint's variable q;
the other is constant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from dhlib.errors import DHError
from dhlib.scalars import Scalar, is_symbolic, read_scalar

Limits = tuple[float, float]


@dataclass(frozen=True, init=False)
class Joint:
    """What revolute and prismatic joints have in common; make a :class:`Revolute` or a :class:`Prismatic`.

    ``a`` and ``alpha`` stand in the row of the joint: a_i and α_i in a classic chain, a_{i-1} and α_{i-1} in a
    modified one. ``constant`` is the other joint parameter: d of a revolute joint, θ of a prismatic one. The
    variable one is ``sign * q + offset``.
    """

    kind: ClassVar[str]
    variable: ClassVar[str]

    constant: Scalar
    a: Scalar
    alpha: Scalar
    offset: Scalar
    limits: Limits | None
    sign: int

    def _set(self, *, constant: Any, a: Any, alpha: Any, offset: Any, limits: Any, sign: Any, unknown: Any) -> None:
        here = f"{type(self).__name__}(…)"
        angle, length = ("offset", "d") if self.kind == "R" else ("theta", "offset")
        if unknown:
            self._refuse_keywords(here, unknown)
        values = {
            "constant": read_scalar(constant, f"{length if self.kind == 'R' else angle} of {here}"),
            "a": read_scalar(a, f"a of {here}"),
            "alpha": read_angle(alpha, f"alpha of {here}"),
            "offset": read_scalar(offset, f"offset of {here}"),
            "limits": read_limits(limits, here),
            "sign": sign,
        }
        read_angle(values["offset"] if self.kind == "R" else values["constant"], f"{angle} of {here}")
        if sign not in (1, -1):
            raise DHError(f"sign of {here} is {sign!r}; it should be 1, or -1 for a joint that turns the other way.")
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def _refuse_keywords(self, here: str, unknown: dict[str, Any]) -> None:
        name = next(iter(unknown))
        if name == self.variable:
            raise DHError(
                f"{here} was given {name}, but {name} is the variable of this joint; give its zero as offset=…, "
                f"or use {'Prismatic' if self.kind == 'R' else 'Revolute'} if {name} is constant."
            )
        other = "d" if self.kind == "R" else "theta"
        raise DHError(f"{here} has no parameter {name!r}; it takes {other}, a, alpha, offset, limits and sign.")

    def value(self, q: Scalar) -> Scalar:
        """The joint parameter that varies, at q: ``sign * q + offset``."""
        return self.sign * q + self.offset

    def with_link(self, a: Scalar, alpha: Scalar) -> Joint:
        """The same joint with another link in its row."""
        return replace_joint(self, a=a, alpha=alpha)

    @property
    def theta(self) -> Scalar:
        """Joint angle θ at q = 0."""
        return self.offset if self.kind == "R" else self.constant

    @property
    def d(self) -> Scalar:
        """Link offset d at q = 0."""
        return self.constant if self.kind == "R" else self.offset


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
        self._set(constant=d, a=a, alpha=alpha, offset=offset, limits=limits, sign=sign, unknown=unknown)

    def __repr__(self) -> str:
        return describe(self)


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
        self._set(constant=theta, a=a, alpha=alpha, offset=offset, limits=limits, sign=sign, unknown=unknown)

    def __repr__(self) -> str:
        return describe(self)


def replace_joint(joint: Joint, **changes: Any) -> Joint:
    """The joint with some of its fields changed: ``constant``, ``a``, ``alpha``, ``offset``, ``limits``, ``sign``."""
    fields = {
        "a": joint.a,
        "alpha": joint.alpha,
        "offset": joint.offset,
        "limits": joint.limits,
        "sign": joint.sign,
    }
    constant = changes.pop("constant", joint.constant)
    if joint.kind == "R":
        return Revolute(d=constant, **{**fields, **changes})
    return Prismatic(theta=constant, **{**fields, **changes})


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


def describe(joint: Joint) -> str:
    """A joint in one line, leaving out what is zero."""
    from dhlib.show import angle_text, number_text

    angle = {"R": "offset", "P": "theta"}[joint.kind]
    length = {"R": "d", "P": "offset"}[joint.kind]
    shown = {
        angle: angle_text(joint.theta) if joint.theta != 0 else "",
        length: number_text(joint.d) if joint.d != 0 else "",
        "a": number_text(joint.a) if joint.a != 0 else "",
        "alpha": angle_text(joint.alpha) if joint.alpha != 0 else "",
        "sign": "-1" if joint.sign == -1 else "",
    }
    order = ("d", "theta", "a", "alpha", "offset", "sign")
    return f"{type(joint).__name__}({', '.join(f'{name}={shown[name]}' for name in order if shown.get(name))})"
