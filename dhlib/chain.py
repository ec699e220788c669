"""A serial arm as a chain of joints: the DH table that computes.

The pose of the end is ``X = Z T_n E``: the base, the product of the n link matrices, the tool.
"""

from __future__ import annotations

import math
import sys
import warnings
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from dhlib.conventions import classic, link_screw, modified, read_convention
from dhlib.errors import DHError, DHWarning
from dhlib.forward import Columns, ScrewX, ScrewZ, to_pose, to_rows, walk, write
from dhlib.joints import Joint, Limits, Prismatic, Revolute
from dhlib.scalars import (
    Scalar,
    cos_sin,
    exact,
    has_symbols,
    is_symbolic,
    quarter_turns,
    read_array,
    read_scalar,
    turn_by_quarters,
)
from dhlib.transforms import Pose, inverse, matrix, read_pose

if TYPE_CHECKING:
    from dhlib.axes import Axis

#: Joint vectors are worked through in pieces that fit the processor's cache.
CHUNK = 4096
SUSPICIOUS_ANGLE = 4 * math.pi


class Chain:
    """A serial arm, given by its DH table.

    Parameters
    ----------
    joints : sequence of Revolute and Prismatic
        One per row of the table, from the base on.
    convention : {"classic", "modified"}
        What the rows mean: row i is ``R_z(θ_i) T_z(d_i) T_x(a_i) R_x(α_i)`` in the classic convention and
        ``R_x(α_{i-1}) T_x(a_{i-1}) R_z(θ_i) T_z(d_i)`` in the modified one.
    base, tool : array_like (4, 4), optional
        Pose of frame 0 in the world (Z), and of the tool in frame n (E); the identity if left out.
    name : str, optional
    unit : str, optional
        Unit of length, for tables and messages only.

    Raises
    ------
    DHError
        If there is no joint, something else stands among them, the convention is unknown, or base or tool
        is no pose.

    Examples
    --------
    >>> import numpy as np
    >>> from dhlib import Chain, Revolute
    >>> arm = Chain([Revolute(a=1), Revolute(a=1)], convention="classic")
    >>> arm.fk([0, np.pi / 2])
    array([[ 0., -1.,  0.,  1.],
           [ 1.,  0.,  0.,  1.],
           [ 0.,  0.,  1.,  0.],
           [ 0.,  0.,  0.,  1.]])
    """

    def __init__(
        self,
        joints: Sequence[Joint],
        convention: str = "",
        base: Any = None,
        tool: Any = None,
        name: str = "",
        unit: str = "m",
        **unknown: Any,
    ) -> None:
        if unknown:
            known = "joints, convention, base, tool, name, unit"
            raise DHError(f"Chain(…) has no argument {next(iter(unknown))!r}; it takes {known}.")
        if not convention:
            raise DHError("Chain(…) needs convention='classic' or convention='modified': a table alone does not say.")
        self.convention = read_convention(convention)
        self.joints = _read_joints(joints)
        self._own_base = np.eye(4) if base is None else read_pose(base, "base")
        self._own_tool = np.eye(4) if tool is None else read_pose(tool, "tool")
        self.name = name
        self.unit = unit
        #: (a, α) that a conversion of convention left over. It stands right of the base in a classic chain and
        #: left of the tool in a modified one, and is kept apart so that converting back is exact.
        self._left_over: tuple[Scalar, Scalar] = (0.0, 0.0)

    @classmethod
    def from_table(
        cls,
        rows: Any,
        columns: str = "",
        joints: str = "",
        convention: str = "",
        degrees: bool = False,
        **options: Any,
    ) -> Chain:
        """Read a DH table as people write it.

        Parameters
        ----------
        rows : list, array or pandas data frame
            One row per joint. An entry is a number, or for the variable one a joint symbol such as ``q1``,
            ``-q1`` (the joint turns the other way) or ``q1 + pi/2`` (an offset), as sympy or as text.
        columns : str, optional
            Names of the columns in their order. The default is ``"theta d a alpha"`` for the classic and
            ``"alpha a theta d"`` for the modified convention; a data frame brings its own.
        joints : str, optional
            One letter per row, R or P. Needed where no entry is a joint symbol; then θ or d is the zero.
        convention : {"classic", "modified"}
        degrees : bool
            True if θ and α are in degrees.
        **options
            base, tool, name, unit as for :class:`Chain`.

        Returns
        -------
        Chain

        Raises
        ------
        DHError
            If the table is not of this form; the message names the row.

        Examples
        --------
        >>> arm = Chain.from_table([[0, 100, 20, -90], [0, 0, 160, 0]], joints="RR", convention="classic",
        ...                        degrees=True, unit="mm")
        >>> arm.joints[0]
        Revolute(d=100, a=20, alpha=-90°)
        """
        from dhlib.table import read_table

        return cls(read_table(rows, columns, joints, read_convention(convention), degrees), convention, **options)

    # What the chain is

    def __len__(self) -> int:
        return len(self.joints)

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @property
    def kinds(self) -> str:
        """One letter per joint, R or P."""
        return "".join(joint.kind for joint in self.joints)

    @property
    def base(self) -> Pose:
        """Pose of frame 0 in the world, (4, 4)."""
        if self.convention == "classic" and self._left_over != (0.0, 0.0):
            return self._own_base @ link_screw(*self._left_over)
        return self._own_base.copy()

    @property
    def tool(self) -> Pose:
        """Pose of the tool in frame n, (4, 4)."""
        if self.convention == "modified" and self._left_over != (0.0, 0.0):
            return link_screw(*self._left_over) @ self._own_tool
        return self._own_tool.copy()

    @property
    def limits(self) -> list[Limits | None]:
        """Limits of each joint, None where none is known."""
        return [joint.limits for joint in self.joints]

    @property
    def reach(self) -> float:
        """An upper bound for the distance from frame 0 to the tool: the sum of all lengths.

        A prismatic joint counts with the larger of its limits, if it has any.
        """
        lengths = [abs(float(part)) for joint in self.joints for part in (joint.a, joint.d)]
        slides = [max(map(abs, joint.limits)) for joint in self.joints if joint.kind == "P" and joint.limits]
        tool = float(np.linalg.norm(np.asarray(self.tool, dtype=float)[:3, 3]))
        return math.fsum(lengths) + math.fsum(slides) + tool

    @cached_property
    def is_symbolic(self) -> bool:
        """Whether a parameter, the base or the tool holds a free symbol."""
        parts = [part for joint in self.joints for part in (joint.theta, joint.d, joint.a, joint.alpha)]
        parts += [*self._left_over, self._own_base, self._own_tool]
        return any(is_symbolic(part) and bool(part.free_symbols) for part in parts)

    def __eq__(self, other: object) -> bool:
        """Same convention, rows, base and tool, entry by entry; for the same arm see `same_mechanism`."""
        if not isinstance(other, Chain):
            return NotImplemented
        return (
            (self.convention, self.joints, self._left_over) == (other.convention, other.joints, other._left_over)
            and bool(np.array_equal(self._own_base, other._own_base))
            and bool(np.array_equal(self._own_tool, other._own_tool))
        )

    __hash__ = None  # type: ignore[assignment]

    # What the chain computes

    def A(self, i: int, q: Any) -> Pose:
        """Link matrix ⁱ⁻¹A_i.

        Parameters
        ----------
        i : int
            Number of the link, from 1 to n.
        q : array_like (…, n)
            The whole joint vector; numbers or sympy symbols.

        Returns
        -------
        ndarray (…, 4, 4) or sympy Matrix (4, 4)

        Raises
        ------
        DHError
            If there is no link i, or q does not fit the chain.

        Examples
        --------
        >>> from dhlib import robots
        >>> robots.quickshot().A(2, [0, 0, 0, 0])[:3, 3]
        array([160.,   0.,   0.])
        """
        self._check_index(i, 1, "link")
        q = self._read_q(q)
        joint = self.joints[i - 1]
        value = q[i - 1] if isinstance(q, list) else q[..., i - 1]
        if self._needs_symbols(q):
            joint, value = _exact_joint(joint), exact(value)
        theta, d = joint.at(value)
        if self.convention == "classic":
            return classic(theta, d, joint.a, joint.alpha)
        return modified(joint.alpha, joint.a, theta, d)

    def T(self, i: int, j: int, q: Any) -> Pose:
        """Pose ⁱT_j of frame j in frame i, of the bare frames: without base and tool.

        Parameters
        ----------
        i, j : int
            From 0 to n, in any order.
        q : array_like (…, n)

        Returns
        -------
        ndarray (…, 4, 4) or sympy Matrix (4, 4)

        Raises
        ------
        DHError
            If there is no frame i or j, or q does not fit the chain.

        Examples
        --------
        >>> from dhlib import robots
        >>> robots.quickshot().T(0, 4, [0, 0, 0, 0])[:3, 3]
        array([180.,  28., 350.])
        """
        self._check_index(i, 0, "frame")
        self._check_index(j, 0, "frame")
        if i > j:
            return inverse(self.T(j, i, q))
        values = self._read_q(q)
        if i == j:
            if self._needs_symbols(values):
                return sys.modules["sympy"].eye(4)
            return np.broadcast_to(np.eye(4), (*np.shape(values)[:-1], 4, 4)).copy()
        product = self.A(i + 1, values)
        for k in range(i + 2, j + 1):
            product = product @ self.A(k, values)
        return product

    def fk(self, q: Any) -> Pose:
        """Forward kinematics: pose of the tool in the world, ``X = Z T_n(q) E``.

        Parameters
        ----------
        q : array_like (…, n)
            Joint vectors, of any leading shape; or a list of n numbers and sympy expressions.

        Returns
        -------
        ndarray (…, 4, 4) or sympy Matrix (4, 4)

        Raises
        ------
        DHError
            If q has another length than the chain, or holds NaN, infinity or anything that is no number.

        Warns
        -----
        DHWarning
            If an angle is beyond 4π: are these degrees?

        Examples
        --------
        >>> from dhlib import robots
        >>> robots.quickshot().fk([0, 0, 0, 0])[:3, 3]
        array([180.,  28., 350.])
        """
        q = self._read_q(q)
        if isinstance(q, list):
            if self._needs_symbols(q):
                _, end = _last(walk(self._exact_screws(q)))
                return _exact_matrix(self._prefix) * matrix(to_rows(end)) * _exact_matrix(self.tool)
            _, end = _last(walk(self._screws(q)))
            return self._between_ends(to_pose(end))
        rows = q.reshape(-1, self.n)
        poses = np.empty((len(rows), 4, 4))
        for start in range(0, len(rows), CHUNK):
            piece = slice(start, start + CHUNK)
            _, end = _last(walk(self._screws(np.ascontiguousarray(rows[piece].T))))
            write(end, poses[piece])
        return self._between_ends(poses.reshape(*q.shape[:-1], 4, 4))

    def frames(self, q: Any) -> Pose:
        """Poses of all frames, 0 to n, in the world.

        Parameters
        ----------
        q : array_like (…, n)

        Returns
        -------
        ndarray (…, n+1, 4, 4), or a list of n + 1 sympy matrices where a symbol is in play
            ``frames[0]`` is the base, and ``frames[n] @ tool`` is ``fk(q)``.

        Raises
        ------
        DHError
            As for :meth:`fk`.

        Examples
        --------
        >>> from dhlib import robots
        >>> robots.quickshot().frames([0, 0, 0, 0])[:, 2, 3]  # how high each origin stands
        array([  0., 100., 100., 100., 350.])
        """
        q = self._read_q(q)
        mine = 1 if self.convention == "classic" else 0  # frame i stands after X_i, or after Z_i
        if self._needs_symbols(q):
            prefix = _exact_matrix(self._prefix)
            moved = [prefix * matrix(to_rows(pair[mine])) for pair in walk(self._exact_screws(q))]
            return [_exact_matrix(self.base), *moved]
        q = np.asarray(q)
        rows = q.reshape(-1, self.n)
        poses = np.empty((len(rows), self.n + 1, 4, 4))
        for i, pair in enumerate(walk(self._screws(np.ascontiguousarray(rows.T))), 1):
            write(pair[mine], poses[:, i])
        if not np.array_equal(self._prefix, np.eye(4)):
            poses[:, 1:] = self._prefix @ poses[:, 1:]
        poses[:, 0] = self.base
        return poses.reshape(*q.shape[:-1], self.n + 1, 4, 4)

    def axes(self) -> list[Axis]:
        """The joint axes as lines in the world at q = 0, each pointing where its joint turns or slides.

        Returns
        -------
        list of Axis

        Examples
        --------
        >>> from dhlib import robots
        >>> robots.quickshot().axes()[1].direction
        array([0., 1., 0.])
        """
        from dhlib.axes import Axis

        frames = self.frames(np.zeros(self.n))
        if isinstance(frames, list):
            raise DHError("axes() needs numbers; this chain holds symbols. Give them values first.")
        on_axis = frames[:-1] if self.convention == "classic" else frames[1:]
        return [
            Axis(frame[:3, 3], joint.sign * frame[:3, 2], joint.kind)
            for frame, joint in zip(on_axis, self.joints, strict=True)
        ]

    def symbolic(self, short: bool = False) -> Pose:
        """T_n in symbols θ_i and d_i, without base and tool, with the angles of parallel joints added up.

        Parameters
        ----------
        short : bool
            True for plain symbols C1, S1, C23, … in place of cosines and sines.

        Returns
        -------
        sympy Matrix (4, 4)
            Its θ_i and d_i are the whole joint parameters: they include the offset.

        Examples
        --------
        >>> from dhlib import robots
        >>> robots.quickshot().symbolic(short=True)[2, 3]
        250*C23 - 160*S2 + 100
        """
        from dhlib.symbolic import fused_product

        return fused_product(self, short=short)

    def compiled(self) -> Callable[[Any], Pose]:
        """A fast function q → fk(q), made from the symbolic form.

        Returns
        -------
        callable
            Takes q (…, n), numbers only and unchecked, and returns (…, 4, 4).

        Raises
        ------
        DHError
            If the chain holds symbols.

        Examples
        --------
        >>> from dhlib import robots
        >>> robots.quickshot().compiled()([0, 0, 0, 0])[:3, 3]
        array([180.,  28., 350.])
        """
        from dhlib.symbolic import compile_chain

        return compile_chain(self)

    def to_classic(self) -> Chain:
        """The same arm in the classic convention: same q, same T.

        The columns a and α move up one row; what the first row loses goes to the base.

        Returns
        -------
        Chain

        Examples
        --------
        >>> from dhlib import robots
        >>> arm = robots.puma560()
        >>> arm.to_classic().to_modified() == arm
        True
        """
        from dhlib.convert import to_classic

        return to_classic(self)

    def to_modified(self) -> Chain:
        """The same arm in the modified convention: same q, same T.

        The columns a and α move down one row; what the last row loses goes to the tool.

        Returns
        -------
        Chain

        Examples
        --------
        >>> from dhlib import robots
        >>> arm = robots.quickshot().to_modified()
        >>> arm.joints[1]
        Revolute(a=20, alpha=-90°)
        """
        from dhlib.convert import to_modified

        return to_modified(self)

    # How the chain shows itself

    def __repr__(self) -> str:
        from dhlib.show import table_text

        return table_text(self)

    def _repr_html_(self) -> str:
        from dhlib.show import table_html

        return table_html(self)

    def _repr_latex_(self) -> str:
        from dhlib.show import table_latex

        return table_latex(self)

    # The word of screws

    @cached_property
    def _links(self) -> list[tuple[Scalar, Scalar]]:
        """(a, α) of X_1 … X_n: of its own row in a classic chain, of the next row in a modified one."""
        links = [(joint.a, joint.alpha) for joint in self.joints]
        return links if self.convention == "classic" else [*links[1:], (0.0, 0.0)]

    @cached_property
    def _prefix(self) -> Pose:
        """What stands before Z_1: the base and, in a modified chain, X_0."""
        if self.convention == "classic":
            return self.base
        return self._own_base @ link_screw(self.joints[0].a, self.joints[0].alpha)

    @cached_property
    def _steps(self) -> list[tuple[Joint, float, float, int | None, Any, ScrewX]]:
        """What the numeric walk needs of each joint, worked out once."""
        return [
            (
                joint,
                float(joint.sign),
                float(joint.offset),
                quarter_turns(joint.theta) or None,
                (float(joint.d) or None) if joint.kind == "R" else cos_sin(float(joint.theta)),
                (*cos_sin(float(alpha)), float(a) or None),
            )
            for joint, (a, alpha) in zip(self.joints, self._links, strict=True)
        ]

    def _screws(self, q: Iterable[Scalar]) -> Iterable[tuple[ScrewZ, ScrewX]]:
        """The word at q, in numbers: for each joint a float or an array of floats."""
        for value, (joint, sign, offset, quarters, constant, x) in zip(q, self._steps, strict=True):
            if joint.kind == "P":
                yield (*constant, sign * value + offset), x
            elif quarters is None:
                yield (*cos_sin(sign * value + offset), constant), x
            else:  # the offset is added without rounding
                cosine, sine = cos_sin(value)
                yield (*turn_by_quarters(cosine, sign * sine, quarters), constant), x

    def _exact_screws(self, q: Iterable[Scalar]) -> Iterable[tuple[ScrewZ, ScrewX]]:
        """The word at q, in symbols and exact numbers."""
        for value, joint, (a, alpha) in zip(q, self.joints, self._links, strict=True):
            theta, d = _exact_joint(joint).at(exact(value))
            yield (*cos_sin(theta), d), (*cos_sin(exact(alpha, angle=True)), exact(a))

    def _between_ends(self, poses: Pose) -> Pose:
        """Put poses between the prefix and the tool, leaving out what is the identity."""
        if not self._prefix_is_identity:
            poses = self._prefix @ poses
        if not self._tool_is_identity:
            poses = poses @ self.tool
        return poses

    @cached_property
    def _prefix_is_identity(self) -> bool:
        return bool(np.array_equal(self._prefix, np.eye(4)))

    @cached_property
    def _tool_is_identity(self) -> bool:
        return bool(np.array_equal(self.tool, np.eye(4)))

    # Reading arguments

    def _check_index(self, index: Any, lowest: int, what: str) -> None:
        if not isinstance(index, int | np.integer) or isinstance(index, bool) or not lowest <= index <= self.n:
            raise DHError(f"there is no {what} {index!r}; this chain has {what}s {lowest} to {self.n}.")

    def _needs_symbols(self, q: Any) -> bool:
        return self.is_symbolic or (isinstance(q, list) and has_symbols(q))

    def _read_q(self, q: Any) -> Any:
        """Return one joint vector as a list, and several as an array (…, n)."""
        if type(q) is np.ndarray and q.dtype == np.float64:  # asked first, since most of the time it is so
            array = q
        elif has_symbols(q):
            return self._read_symbols(q)
        else:
            array = read_array(q, "q")
        if array.shape[-1:] != (self.n,):
            shape = f"{array.shape[-1]} values" if array.ndim else "one number"
            raise DHError(f"q has {shape}, but this chain has {self.n} joints ({self.kinds}): give {self.n} values.")
        values = array.tolist() if array.ndim == 1 else array
        if not array.size or (array.ndim == 1 and math.hypot(*values) <= SUSPICIOUS_ANGLE):
            return values  # no entry is larger than the length of the vector, and NaN is in no order
        if not np.all(np.isfinite(array)):
            raise DHError("q holds NaN or infinity; every joint value should be a finite number.")
        if max(-array.min(), array.max()) > SUSPICIOUS_ANGLE:
            self._warn_of_degrees(array)
        if self.is_symbolic and array.ndim > 1:
            raise DHError("this chain holds symbols, so it takes one joint vector at a time.")
        return values

    def _read_symbols(self, q: Any) -> list[Scalar]:
        values = list(q)
        if len(values) != self.n or any(np.ndim(value) for value in values):
            raise DHError(f"q has {len(values)} values, but this chain has {self.n} joints ({self.kinds}).")
        for i, value in enumerate(values, 1):
            read_scalar(value, f"q{i}")
        return values

    def _warn_of_degrees(self, q: Any) -> None:
        for i, joint in enumerate(self.joints):
            largest = np.abs(q[..., i]).max()
            if joint.kind == "R" and largest > SUSPICIOUS_ANGLE:
                message = (
                    f"q{i + 1} reaches {largest:g} rad, more than two turns. Are these degrees? Use numpy.deg2rad."
                )
                warnings.warn(message, DHWarning, stacklevel=4)
                return


def _read_joints(joints: Any) -> tuple[Joint, ...]:
    if isinstance(joints, Joint):
        joints = [joints]
    try:
        listed = tuple(joints)
    except TypeError:
        raise DHError(f"joints is {joints!r}; it should be a list of Revolute(…) and Prismatic(…).") from None
    if not listed:
        raise DHError("a chain needs at least one joint; joints is empty.")
    for i, joint in enumerate(listed, 1):
        if not isinstance(joint, Revolute | Prismatic):
            raise DHError(
                f"joint {i} is {joint!r}; it should be a Revolute(…) or a Prismatic(…). "
                "For rows of numbers use Chain.from_table."
            )
    return listed


def _exact_joint(joint: Joint) -> Joint:
    """The joint with its numbers as sympy shows them best."""
    return joint.replace(
        theta=exact(joint.theta, angle=True),
        d=exact(joint.d),
        a=exact(joint.a),
        alpha=exact(joint.alpha, angle=True),
    )


def _exact_matrix(pose: Pose) -> Pose:
    sympy = sys.modules["sympy"]
    return pose if is_symbolic(pose) else sympy.Matrix(4, 4, [exact(entry) for entry in np.ravel(pose)])


def _last(items: Iterable[tuple[Columns, Columns]]) -> tuple[Columns, Columns]:
    """The last of at least one item."""
    for pair in items:
        last = pair
    return last
