r"""T_n in symbols, in the compact form that the book prints.

Where joint axes are parallel their angles only ever appear as a sum. So neighbours are fused before anything is
multiplied: with α_i = 0,

    Z(θ_i, d_i) X(0, a_i) Z(θ_j, d_j) = Trans(a_i cos θ_i, a_i sin θ_i, d_i) Z(θ_i + θ_j, d_j),

and with α_i = π the next joint counts the other way, and the half turn is handed on to the link behind it:

    X(π, a_i) Z(θ_j, d_j) X(α_j, a_j) = T_x(a_i) Z(-θ_j, -d_j) X(α_j + π, a_j).

Then the screws are multiplied from the right, and nothing is ever expanded.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import sympy

from dhlib.chain import CHUNK, Chain
from dhlib.errors import DHError
from dhlib.scalars import Scalar, cos_sin, exact, quarter_turns
from dhlib.transforms import Pose

Fused = tuple[sympy.Expr, list[sympy.Expr], sympy.Expr, sympy.Expr]
"""Sum of angles φ, translation (x, y, z), then α and a of the link behind: Trans(x, y, z) R_z(φ) X(α, a)."""


def joint_symbols(chain: Chain) -> list[sympy.Symbol]:
    """θ_i of every revolute and d_i of every prismatic joint.

    Examples
    --------
    >>> from dhlib import robots
    >>> joint_symbols(robots.stanford())[:3]
    [theta1, theta2, d3]
    """
    names = {"R": "theta", "P": "d"}
    return [sympy.Symbol(f"{names[kind]}{i}") for i, kind in enumerate(chain.kinds, 1)]


def fused_runs(chain: Chain) -> list[Fused]:
    """The word Z_1 X_1 … Z_n X_n with parallel neighbours fused into one turn each."""
    runs: list[Fused] = []
    angle, shift = sympy.Integer(0), [sympy.Integer(0)] * 3
    half_turns = 0  # an odd number: the joints count the other way
    for joint, symbol, (a, alpha) in zip(chain.joints, joint_symbols(chain), chain._links, strict=True):
        theta = symbol if joint.kind == "R" else exact(joint.theta, angle=True)
        d = exact(joint.d) if joint.kind == "R" else symbol
        sense = -1 if half_turns % 2 else 1
        angle = angle + sense * theta
        shift = [shift[0], shift[1], shift[2] + sense * d]
        a, alpha = exact(a), exact(alpha, angle=True)
        quarters = quarter_turns(alpha)
        if quarters is not None and quarters % 2 == 0:
            shift = [shift[0] + a * sympy.cos(angle), shift[1] + a * sympy.sin(angle), shift[2]]
            half_turns += quarters // 2
        else:
            runs.append((angle, shift, alpha + half_turns * sympy.pi, a))
            angle, shift, half_turns = sympy.Integer(0), [sympy.Integer(0)] * 3, 0
    runs.append((angle, shift, half_turns * sympy.pi, sympy.Integer(0)))
    return runs


def fused_product(chain: Chain, short: bool = False) -> Pose:
    """T_n in θ_i and d_i; see :meth:`Chain.symbolic`."""
    rows = [[sympy.Integer(int(i == j)) for j in range(4)] for i in range(3)]
    for angle, shift, alpha, a in reversed(fused_runs(chain)):
        rows = _turned(rows, 1, 2, alpha)
        rows[0][3] += a
        rows = _turned(rows, 0, 1, angle)
        for row, part in zip(rows, shift, strict=True):
            row[3] += part
    if chain.convention == "modified":  # what stands before Z_1
        rows = _turned(rows, 1, 2, exact(chain.joints[0].alpha, angle=True))
        rows[0][3] += exact(chain.joints[0].a)
    product = sympy.Matrix([*rows, [0, 0, 0, 1]])
    return product.subs(short_names(product)) if short else product


def _turned(rows: list[list[sympy.Expr]], first: int, second: int, angle: sympy.Expr) -> list[list[sympy.Expr]]:
    """The rows after a rotation from the left that mixes two of them."""
    c, s = sympy.cos(angle), sympy.sin(angle)
    turned = [list(row) for row in rows]
    turned[first] = [_times(c, x) - _times(s, y) for x, y in zip(rows[first], rows[second], strict=True)]
    turned[second] = [_times(s, x) + _times(c, y) for x, y in zip(rows[first], rows[second], strict=True)]
    return turned


def _times(factor: sympy.Expr, entry: sympy.Expr) -> sympy.Expr:
    """Multiply, with the sign of an all-negative sum drawn out: C1 (-S4 - C4) becomes -C1 (S4 + C4)."""
    if factor == 0 or entry == 0:  # sympy would first find out whether the other one is finite, at great length
        return sympy.Integer(0)
    if factor.is_Function and entry.is_Add and all(term.as_coeff_Mul()[0].is_negative for term in entry.args):
        return -(factor * -entry)
    return factor * entry


def short_names(expression: Any) -> dict[sympy.Expr, sympy.Symbol]:
    """What C1, S1, C23 … stand for, for every cosine and sine of joint angles in an expression.

    Examples
    --------
    >>> theta2, theta3 = sympy.symbols("theta2 theta3")
    >>> short_names(sympy.cos(theta2 + theta3) + sympy.sin(theta2))
    {sin(theta2): S2, cos(theta2 + theta3): C23}
    """
    functions = sorted(expression.atoms(sympy.sin, sympy.cos), key=sympy.default_sort_key)
    return {function: sympy.Symbol(_short_name(function)) for function in functions if _short_name(function)}


def _short_name(function: sympy.Expr) -> str:
    """C or S and the numbers of the joints: 23 for θ2 + θ3, 2m3 for θ2 - θ3; empty for any other angle."""
    name = ""
    terms = function.args[0].as_coefficients_dict()
    for angle, factor in sorted(terms.items(), key=lambda term: str(term[0])):
        number = str(angle).removeprefix("theta")
        if factor not in (1, -1) or not number.isdigit():
            return ""
        name += ("m" if factor == -1 else "") + number
    return ("C" if isinstance(function, sympy.cos) else "S") + name


def compile_chain(chain: Chain) -> Callable[[Any], Pose]:
    """A function q → fk(q) from the symbolic form; see :meth:`Chain.compiled`."""
    if chain.is_symbolic:
        raise DHError("compiled() needs numbers; this chain holds symbols. Give them values first.")
    symbols, kinds = joint_symbols(chain), chain.kinds
    # The function takes cosine and sine of each angle, not the angle: then it knows sums and products only, and is the
    # same for floats and for arrays.
    turns = {
        symbol: (sympy.Dummy(f"c{i}"), sympy.Dummy(f"s{i}"))
        for i, (symbol, kind) in enumerate(zip(symbols, kinds, strict=True), 1)
        if kind == "R"
    }
    parameters = [name for symbol in symbols for name in turns.get(symbol, (symbol,))]
    entries = sympy.lambdify(
        parameters, list(fused_product(chain)[:3, :]), modules="math", cse=partial(_in_steps, turns)
    )

    def at(q: Any) -> list[Scalar]:
        """The twelve entries, row by row, at n floats or n arrays."""
        known: list[Scalar] = []
        for kind, ((c, s, d), _) in zip(kinds, chain._screws(q), strict=True):
            known += (c, s) if kind == "R" else (d,)
        return entries(*known)  # type: ignore[no-any-return]

    base, tool = (np.asarray(end, dtype=float) for end in (chain._own_base, chain.tool))
    base_moves, tool_moves = (not np.array_equal(end, np.eye(4)) for end in (base, tool))

    def fk(q: Any) -> Pose:
        values = np.asarray(q, dtype=float)
        if values.ndim == 1:
            poses = np.array([*at(values.tolist()), 0.0, 0.0, 0.0, 1.0]).reshape(4, 4)
        else:
            rows = values.reshape(-1, chain.n)
            poses = np.zeros((len(rows), 4, 4))
            for start in range(0, len(rows), CHUNK):
                out = poses[start : start + CHUNK]
                for k, entry in enumerate(at(np.ascontiguousarray(rows[start : start + CHUNK].T))):
                    out[:, k // 4, k % 4] = entry
            poses[:, 3, 3] = 1.0
            poses = poses.reshape(*values.shape[:-1], 4, 4)
        if base_moves:
            poses = base @ poses
        if tool_moves:
            poses = poses @ tool
        return np.add(poses, 0.0, out=poses)  # turns -0.0 into 0.0

    return fk


def _in_steps(
    turns: Mapping[sympy.Symbol, tuple[sympy.Symbol, sympy.Symbol]], entries: list[sympy.Expr]
) -> tuple[list[tuple[sympy.Symbol, sympy.Expr]], list[sympy.Expr]]:
    """What is computed first, and the entries in terms of it, as :func:`sympy.cse` gives them.

    `turns` names cosine and sine of each joint angle. Those of a sum of angles come from those of its terms: that is
    cheaper than another cosine, and where all terms are quarter turns it leaves 0 and ±1, which the cosine of a rounded
    sum does not.
    """
    steps: list[tuple[sympy.Symbol, sympy.Expr]] = []
    known: dict[sympy.Expr, tuple[sympy.Expr, sympy.Expr]] = {}

    def named(*values: sympy.Expr) -> tuple[sympy.Expr, ...]:
        names = tuple(sympy.Dummy() for _ in values)
        steps.extend(zip(names, values, strict=True))
        return names

    def cosine_sine(terms: tuple[sympy.Expr, ...]) -> tuple[sympy.Expr, ...]:
        angle = sympy.Add(*terms)
        if angle in turns:
            return turns[angle]
        if -angle in turns:  # a joint that counts the other way
            cosine, sine = turns[-angle]
            return cosine, -sine
        if len(terms) == 1:
            return tuple(exact(part) for part in cos_sin(float(angle)))
        if angle not in known:
            (c, s), (c_last, s_last) = cosine_sine(terms[:-1]), cosine_sine(terms[-1:])
            known[angle] = named(c * c_last - s * s_last, s * c_last + c * s_last)
        return known[angle]

    of_angles = {}
    for function in sorted(sympy.Tuple(*entries).atoms(sympy.cos, sympy.sin), key=sympy.default_sort_key):
        terms = sorted(sympy.Add.make_args(function.args[0]), key=sympy.default_sort_key)
        of_angles[function] = cosine_sine(tuple(terms))[isinstance(function, sympy.sin)]
    shared, short = sympy.cse([entry.xreplace(of_angles) for entry in entries])
    return steps + shared, short
