"""What a part may ask for: a matrix, a formula, a function, a table, frames, a choice.

A form knows two things: the *request*, plain JSON that tells the reader of answers what to look for and holds
nothing of the solution, and, for the forms that are judged by value, the values that an arm gives.
"""

from __future__ import annotations

import warnings
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Protocol

import numpy as np

from dhlib.errors import DHWarning
from dhlib.scalars import FloatArray

Request = dict[str, Any]


class Arm(Protocol):
    """What a quantity may ask of an arm: a `Chain`, or an arm as somebody with a misconception sees it."""

    @property
    def n(self) -> int:
        """Number of joints."""

    @property
    def base(self) -> Any:
        """Pose of frame 0 in the world."""

    @property
    def tool(self) -> Any:
        """Pose of the tool in frame n."""

    def A(self, i: int, q: Any) -> Any:
        """Link matrix i."""

    def T(self, i: int, j: int, q: Any) -> Any:
        """Frame j in frame i."""

    def fk(self, q: Any) -> Any:
        """Tool in the world."""


Quantity = Callable[..., Any]
"""What is asked for, of an arm and at a probe: ``quantity(arm, *probe)`` gives an array of numbers."""

Probe = tuple[Any, ...]


@dataclass(frozen=True)
class Valued:
    """A form that is judged by its values at probes.

    Parameters
    ----------
    quantity : callable
        ``quantity(arm, *probe)``, an array of the shape asked for.
    shape : tuple of int
    tolerance : float
        How far a pure number may be off, as the task states it.
    length_tolerance : float
        How far a length may be off, in the arm's unit: in a pose that is the upper part of its last column.
    means : callable, optional
        What one value stands for, where different values stand for the same: of joint values, the pose that they
        lead to. What is meant is then compared, to `tolerance`.
    each : str
        What a row is, such as ``"line"``, so that a wrong one can be named.
    """

    quantity: Quantity
    shape: tuple[int, ...] = (4, 4)
    tolerance: float = 1e-6
    length_tolerance: float = 1e-3
    means: Callable[[FloatArray], FloatArray] | None = None
    each: str = ""

    kind: ClassVar[str] = ""

    @property
    def probes(self) -> Sequence[Probe]:
        """Where the quantity is compared."""
        raise NotImplementedError

    def values(self, arm: Arm) -> FloatArray:
        """The quantity at every probe, (probes, *shape)."""
        return np.array([np.asarray(self.quantity(arm, *probe), dtype=float) for probe in self.probes])

    def meaning(self, values: FloatArray) -> FloatArray:
        """What values (probes, *shape) stand for."""
        if self.means is None:
            return values
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DHWarning)  # these are another's joint values, and may be in degrees
            return np.array([self.means(value) for value in values])

    @property
    def tolerances(self) -> FloatArray:
        """The tolerance of each entry that is compared."""
        if self.means is not None:
            return np.array(self.tolerance)
        tolerances = np.full(self.shape, self.tolerance)
        if self.shape == (4, 4):
            tolerances[:3, 3] = self.length_tolerance
        return tolerances


@dataclass(frozen=True, kw_only=True)
class Numbers(Valued):
    """A matrix, a vector or one number, at the joint angles that the task states."""

    at: Sequence[float]
    tolerance: float = 1e-3
    length_tolerance: float = 0.1

    kind = "numbers"

    @property
    def probes(self) -> Sequence[Probe]:
        """The one joint vector of the task."""
        return [(tuple(self.at),)]

    def request(self) -> Request:
        """See the module."""
        return {"form": self.kind, "shape": list(self.shape)}


@dataclass(frozen=True, kw_only=True)
class Formula(Valued):
    """A matrix or a single entry in symbols; any form of it is right that has the right values."""

    symbols: Sequence[str]
    count: int = 24

    kind = "formula"

    @property
    def probes(self) -> Sequence[Probe]:
        """Quarter turns, where zeros and signs show, and angles without any pattern."""
        n = len(self.symbols)
        seed = zlib.crc32(" ".join(self.symbols).encode())
        random = np.random.default_rng(seed)
        turns = random.integers(-1, 3, (self.count // 4, n)) * (np.pi / 2)
        angles = random.uniform(-np.pi, np.pi, (self.count - len(turns), n))
        return [(tuple(map(float, point)),) for point in (*turns, *angles)]

    def request(self) -> Request:
        """See the module."""
        points = [list(point) for (point,) in self.probes]
        return {"form": self.kind, "shape": list(self.shape), "symbols": list(self.symbols), "points": points}


@dataclass(frozen=True, kw_only=True)
class Function(Valued):
    """A function; it is called with the arguments of each probe.

    Parameters
    ----------
    calls : sequence of tuple
    signature : str
        As the task has it.
    kinds : sequence of str
        What each call is about, such as ``"parallel lines"``, so that it can be said where a function fails.
    """

    calls: Sequence[Probe]
    signature: str = "f(q)"
    kinds: Sequence[str] = ()

    kind = "function"

    @property
    def probes(self) -> Sequence[Probe]:
        """The calls."""
        return list(self.calls)

    def request(self) -> Request:
        """See the module."""
        return {
            "form": self.kind,
            "shape": list(self.shape),
            "calls": [[_plain(argument) for argument in call] for call in self.calls],
        }


def _plain(argument: Any) -> Any:
    """An argument as JSON has it: a number, or nested lists of floats."""
    return argument if np.ndim(argument) == 0 else np.asarray(argument, dtype=float).tolist()


@dataclass(frozen=True)
class Table:
    """A DH table of the arm; every table of the same mechanism is right.

    Parameters
    ----------
    convention : {"classic", "modified"}
    free : tuple of str
        What the task leaves to the student: ``"zeros"`` and ``"senses"`` of the joints; ``"turns"``: frame 0 and
        frame n may be turned, but their origins are given; ``"ends"``: they may be anywhere.
    """

    convention: str = "classic"
    free: tuple[str, ...] = ("zeros", "senses", "turns")

    kind: ClassVar[str] = "table"

    def request(self) -> Request:
        """See the module."""
        return {"form": self.kind, "convention": self.convention}


@dataclass(frozen=True)
class Frames:
    """Poses of frames 0 to n of the arm at q = 0, in the world; every placing that obeys the convention is right.

    Frame 0 and the origin of frame n are given by the task.
    """

    convention: str = "classic"
    count: int = 0
    tolerance: float = 1e-3
    length_tolerance: float = 0.1

    kind: ClassVar[str] = "frames"

    def request(self) -> Request:
        """See the module."""
        return {"form": self.kind, "shape": [self.count, 4, 4]}


@dataclass(frozen=True)
class Choice:
    """One of several options.

    Parameters
    ----------
    options : mapping of str to str
        What to say to whoever chose it; the right option says why it is right.
    right : str
    """

    options: Mapping[str, str] = field(default_factory=dict)
    right: str = ""

    kind: ClassVar[str] = "choice"

    def __post_init__(self) -> None:
        if self.right not in self.options:
            raise ValueError(f"the right option {self.right!r} is not among {list(self.options)}.")

    def request(self) -> Request:
        """See the module."""
        return {"form": self.kind, "options": list(self.options)}


@dataclass(frozen=True)
class Reason:
    """A statement that may be a reason for a choice.

    Parameters
    ----------
    holds : bool
        Whether it is true, and a reason.
    says : str
        What to say to whoever gives it though it does not hold.
    """

    holds: bool
    says: str = ""

    def __post_init__(self) -> None:
        if not self.holds and not self.says:
            raise ValueError("a reason that does not hold should say why, to whoever gives it.")


@dataclass(frozen=True)
class ReasonedChoice(Choice):
    """One of several options, and all the reasons that hold for it.

    The student hands in the option, and then the letters of the reasons: ``"no pose", "c", "d"``.

    Parameters
    ----------
    options, right
        As of `Choice`.
    reasons : mapping of str to Reason
        By letter, as the page lists them.
    """

    reasons: Mapping[str, Reason] = field(default_factory=dict)

    kind: ClassVar[str] = "reasoned"

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.needed:
            raise ValueError("at least one of the reasons should hold.")
        if clash := {letter for letter in self.reasons if letter in self.options or len(letter) != 1}:
            raise ValueError(f"a reason should go by a letter that is no option, and not by {min(clash)!r}.")

    @property
    def needed(self) -> set[str]:
        """The letters of the reasons that hold."""
        return {letter for letter, reason in self.reasons.items() if reason.holds}

    def request(self) -> Request:
        """See the module."""
        return {**super().request(), "reasons": list(self.reasons)}


Form = Numbers | Formula | Function | Table | Frames | Choice | ReasonedChoice
