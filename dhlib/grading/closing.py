"""Close dhlib's kinematics to code that is to build it itself.

Where a part says so (`Part.kinematics`), a graded run closes arms, chains, link matrices and transforms while the cell
of that part runs and while its answer is read. What is closed are the functions themselves, under whatever name the
code has got hold of them: imported before, renamed, or kept in a method. A call says in a sentence what it may not do.

This keeps honest work honest. It is no wall: code that wants to get round it in its own process can, and who computes
elsewhere and copies the numbers in is not noticed.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping, Sequence
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any

from dhlib.errors import DHError
from dhlib.grading.notebook import Cell

if TYPE_CHECKING:
    from dhlib.grading.exercise import Exercise

#: What the kinematics is, as modules of dhlib; of `Chain`, all its methods.
MODULES = ("conventions", "convert", "forward", "placement", "robots", "symbolic", "table", "transforms")

_closed: dict[FunctionType, CodeType] = {}
_part = ""


def _refuse(*arguments: Any, **named: Any) -> Any:
    # Runs as the code of other functions, with their globals: so it brings what it needs.
    from dhlib.grading.closing import refuse

    refuse()


def refuse() -> None:
    """Say what is closed, and for which part.

    Raises
    ------
    DHError
        Always.
    """
    raise DHError(
        f"{_part} is your own work: to build it, dhlib's arms, chains, link matrices and transforms are closed here. "
        "Use numpy or sympy."
    )


def close(part: str) -> None:
    """Close the kinematics for a part, until `reopen`.

    Examples
    --------
    >>> from dhlib import Rz as turn
    >>> close("A1")
    >>> try:
    ...     turn(0.3)
    ... except DHError as error:
    ...     print(str(error)[:21])
    A1 is your own work:
    >>> reopen()
    >>> turn(0).shape
    (4, 4)
    """
    global _part
    _part = part
    for function in _functions():
        if function not in _closed:
            _closed[function] = function.__code__
            function.__code__ = _refuse.__code__


def reopen() -> None:
    """Open it again."""
    while _closed:
        function, code = _closed.popitem()
        function.__code__ = code


def close_parts(cells: Sequence[Cell], exercise: Exercise) -> list[Cell]:
    """The cells of a merged notebook, with cells before and after each part that close the kinematics and open it.

    Examples
    --------
    >>> from dhlib.grading.exercise import load_exercise
    >>> cells = [Cell("A1 = 3", role="answer", part="A1"), Cell('check("A1", A1)', role="check", part="A1")]
    >>> for cell in close_parts(cells, load_exercise("quickshot")):
    ...     print(cell.source)
    import dhlib.grading.closing as _c; _c.close("A1"); del _c
    A1 = 3
    check("A1", A1)
    import dhlib.grading.closing as _c; _c.reopen(); del _c
    """
    own = {part.id for part in exercise.parts if not part.kinematics}
    closing: list[Cell] = []
    for cell in cells:
        if cell.role == "answer" and cell.part in own:
            closing.append(_call(f'close("{cell.part}")'))
        closing.append(cell)
        if cell.role == "check" and cell.part in own:
            closing.append(_call("reopen()"))
    return closing


def _call(call: str) -> Cell:
    return Cell(f"import dhlib.grading.closing as _c; _c.{call}; del _c", role="setup")


def _functions() -> Iterator[FunctionType]:
    """The functions and methods that are closed."""
    from dhlib.chain import Chain

    for name in MODULES:
        module = importlib.import_module(f"dhlib.{name}")
        yield from _plain(vars(module), module.__name__)
    yield from _plain(vars(Chain), Chain.__module__)


def _plain(names: Mapping[str, Any], module: str) -> Iterator[FunctionType]:
    for name, value in names.items():
        function = getattr(value, "__func__", value)  # of a class method
        special = name.startswith("__") and name != "__init__"
        if isinstance(function, FunctionType) and function.__module__ == module and not special:
            yield function
