"""An exercise: its arm and its parts; and where exercises are found."""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType

import dhlib
from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.grading.forms import Form, Frames, Quantity, Table

NAME = re.compile(r"[a-z][a-z0-9_]*")
#: What the statement says of the parts for which dhlib's kinematics is closed.
OWN_WORK = "*Your own work:* where a course grades this page, `dhlib` is closed for {parts}."


@dataclass(frozen=True)
class Trap:
    """A wrong answer that this very task invites.

    Parameters
    ----------
    says : str
        What to tell the student.
    quantity : callable
        What such a student hands in: ``quantity(arm, *probe)``.
    key : str
        Key of the known misconception that it is, if it is one.
    """

    says: str
    quantity: Quantity
    key: str = "trap"


@dataclass(frozen=True)
class Follows:
    """How a part follows from earlier ones, so that an error is punished once.

    Parameters
    ----------
    parts : sequence of str
        The earlier parts.
    rule : callable
        Their values, one array each, to the value of this part.
    """

    parts: Sequence[str]
    rule: Callable[..., object]


@dataclass(frozen=True, eq=False)
class Part:
    """One question; two parts are equal only if they are the same one.

    Parameters
    ----------
    id : str
        Also the name of the variable that holds the answer.
    title : str
    points : float
    asks : Form
        The form of the answer, with the quantity asked for, its probes and its tolerance.
    section : str
        Label of the section of the book that explains it.
    arm : Chain, optional
        The arm in question; that of the exercise if left out.
    traps : sequence of Trap
    follows : Follows, optional
    kinematics : bool
        Whether dhlib's kinematics (arms, chains, link matrices, transforms) may be used to answer it. False where the
        point is to build the thing oneself; the statement then says so, as `OWN_WORK` has it.
    """

    id: str
    title: str
    points: float
    asks: Form
    section: str = ""
    arm: Chain | None = None
    traps: Sequence[Trap] = ()
    follows: Follows | None = None
    kinematics: bool = True

    @property
    def chain(self) -> Chain:
        """The arm in question."""
        if self.arm is None:
            raise DHError(f"part {self.id} has no arm: give it one, or put it into an exercise that has.")
        return self.arm

    @property
    def convention(self) -> str:
        """The convention that the part is about: that of the table or frames asked for, else that of its arm."""
        if isinstance(self.asks, Table | Frames):
            return self.asks.convention
        return self.arm.convention if self.arm else "classic"


@dataclass(frozen=True)
class Exercise:
    """An exercise: a name, an arm, and parts in the order of the page."""

    name: str
    title: str
    arm: Chain
    parts: Sequence[Part] = field(default_factory=tuple)

    def __post_init__(self) -> None:
        ids = [part.id for part in self.parts]
        if doubled := sorted({id_ for id_ in ids if ids.count(id_) > 1}):
            raise DHError(f"exercise {self.name}: part {doubled[0]} is there twice; ids should differ.")
        for part in self.parts:
            if not part.id.isidentifier():
                raise DHError(f"exercise {self.name}: {part.id!r} should be a name of a variable, such as A1.")
            for needed in part.follows.parts if part.follows else ():
                if needed not in ids[: ids.index(part.id)]:
                    raise DHError(
                        f"exercise {self.name}: part {part.id} follows from {needed}, which is no earlier part."
                    )
        parts = tuple(part if part.arm else replace(part, arm=self.arm) for part in self.parts)
        object.__setattr__(self, "parts", parts)

    @property
    def points(self) -> float:
        """The sum of all points."""
        return sum(part.points for part in self.parts)

    def part(self, part_id: object) -> Part:
        """The part of this id.

        Raises
        ------
        DHError
            If there is none; the message lists those there are.
        """
        for part in self.parts:
            if part.id == part_id:
                return part
        known = ", ".join(part.id for part in self.parts)
        raise DHError(f"the exercise {self.name} has no part {part_id!r}; its parts are {known}.")


def exercise_folders(folder: str | Path | None = None) -> list[Path]:
    """Where exercises are looked for, in this order: `folder`, ``./exercises``, what comes with dhlib."""
    package = Path(dhlib.__file__).parent
    asked = [Path(folder)] if folder else []
    return [*asked, Path("exercises"), package / "_exercises", package.parent / "exercises"]


def find_exercise(name: str, suffix: str, folder: str | Path | None = None) -> Path:
    """The file ``NAME.suffix`` of an exercise.

    Raises
    ------
    DHError
        If the name is none, or there is no such file; the message says where was looked.
    """
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise DHError(f"{name!r} is no name of an exercise; it should be a word such as 'quickshot'.")
    if folder and not Path(folder).is_dir():
        raise DHError(f"there is no folder {folder}; give the folder that holds {name}{suffix}.")
    folders = exercise_folders(folder)
    for candidate in folders:
        if (candidate / f"{name}{suffix}").is_file():
            return candidate / f"{name}{suffix}"
    known = sorted({path.stem for candidate in folders for path in candidate.glob(f"*{suffix}")})
    here = f"There are: {', '.join(known)}." if known else f"Looked in {', '.join(map(str, folders[:2]))}."
    raise DHError(f"there is no exercise {name!r}. {here}")


def load_exercise(name: str, folder: str | Path | None = None) -> Exercise:
    """Load an exercise by its name.

    Parameters
    ----------
    name : str
    folder : path, optional
        Where to look first; then in ``./exercises``, then among those that come with dhlib.

    Returns
    -------
    Exercise

    Raises
    ------
    DHError
        If there is no such exercise, or its file holds none.

    Examples
    --------
    >>> load_exercise("quickshot").title
    'The Quickshot'
    """
    path = find_exercise(name, ".py", folder)
    exercise = getattr(load_module(path), "EXERCISE", None)
    if not isinstance(exercise, Exercise):
        raise DHError(f"{path} should end with EXERCISE = Exercise(…).")
    return exercise


def load_module(path: Path) -> ModuleType:
    """The file of an exercise, as a module of its own."""
    spec = importlib.util.spec_from_file_location(f"dhlib_exercise_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise DHError(f"{path} cannot be read as Python.")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
