"""Glue a value under a name, in every form that the text may ask for."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from bookkit.values import latex, text

PREFIX = "application/papermill.record/"
"""Marks an output as kept for the text and not shown below the cell."""


def publish(name: str, **forms: str) -> None:
    """Keep a value for the text of this page.

    Parameters
    ----------
    name : str
        What the text calls it.
    **forms : str
        The value as ``plain``, ``latex``, ``markdown`` or ``html``.
    """
    from IPython.display import display

    display(  # type: ignore[no-untyped-call]
        {f"{PREFIX}text/{form}": value for form, value in forms.items()},
        raw=True,
        metadata={"scrapbook": {"name": name, "mime_prefix": PREFIX}},
    )


def glue_number(name: str, value: Any, digits: int = 4, unit: str = "") -> None:
    r"""Keep a number for ``{glue:text}`name` ``.

    Parameters
    ----------
    name : str
        What the text calls it.
    value : number
        A Python, numpy or sympy number.
    digits : int
        Significant digits.
    unit : str
        Put behind the number.
    """
    shown = text(value, digits, unit)
    publish(name, plain=shown, markdown=shown, latex=f"${latex(value, digits)}$")


def glue_math(name: str, value: Any, lhs: str = "", digits: int = 4) -> None:
    r"""Keep a formula: an expression, a vector or a matrix, of numbers or symbols.

    Parameters
    ----------
    name : str
        What the text calls it, by a ``{glue:math}`` block or, within a line, ``{glue}``.
    value : number, sympy expression or matrix, array_like
        The value.
    lhs : str
        LaTeX of what it is the value of; an equals sign is put between.
    digits : int
        Significant digits of floats.
    """
    formula = (f"{lhs} = " if lhs else "") + latex(value, digits)
    publish(name, plain=formula, latex=f"$${formula}$$", markdown=f"${formula}$")


def glue_table(name: str, rows: Iterable[Sequence[Any]], header: Sequence[str], digits: int = 4) -> None:
    r"""Keep a table for a ``{glue}`` block.

    Parameters
    ----------
    name : str
        What the text calls it.
    rows : iterable of sequences
        Strings stand as they are (Markdown, formulas between dollar signs); numbers and sympy expressions are
        set.
    header : sequence of str
        A title for each column.
    digits : int
        Significant digits of floats.

    Raises
    ------
    ValueError
        If a row is longer or shorter than the header.
    """

    def cell(entry: Any) -> str:
        if isinstance(entry, str):
            return entry
        return f"${latex(entry, digits)}$" if hasattr(entry, "free_symbols") else text(entry, digits)

    lines = [list(header), [":---:"] * len(header)]
    for number, row in enumerate(rows):
        if len(row) != len(header):
            raise ValueError(f"Row {number} of the table has {len(row)} entries, the header {len(header)}.")
        lines.append([cell(entry) for entry in row])
    table = "\n".join("| " + " | ".join(line) + " |" for line in lines)
    publish(name, plain=table, markdown=table)
