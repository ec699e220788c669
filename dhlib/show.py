"""DH tables as text, HTML and LaTeX, with angles in degrees and the joint variables where they vary."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from dhlib.joints import Joint
from dhlib.scalars import Scalar, is_symbolic

if TYPE_CHECKING:
    from dhlib.chain import Chain

#: The columns of each convention in the order of the operations, as (symbol, index).
COLUMNS = {
    "classic": (("θ", "i"), ("d", "i"), ("a", "i"), ("α", "i")),
    "modified": (("α", "i-1"), ("a", "i-1"), ("θ", "i"), ("d", "i")),
}
LATEX = {"θ": r"\theta", "α": r"\alpha", "d": "d", "a": "a"}


def number_text(value: Scalar) -> str:
    """A length to read: at most six significant digits, no trailing zeros, never -0.

    Examples
    --------
    >>> number_text(160.0), number_text(-0.0), number_text(0.15005)
    ('160', '0', '0.15005')
    """
    return str(value) if is_symbolic(value) else f"{float(value) + 0.0:.6g}"


def angle_text(value: Scalar) -> str:
    """An angle in degrees; a symbol as it is.

    Examples
    --------
    >>> import numpy as np
    >>> angle_text(-np.pi / 2)
    '-90°'
    """
    if is_symbolic(value) and value.free_symbols:
        return str(value)
    return f"{float(f'{np.rad2deg(float(value)):.10g}') + 0.0:.6g}°"


def variable_text(joint: Joint, i: int) -> str:
    """The joint parameter that varies, as in ``q2 - 90°``."""
    variable = f"{'-' if joint.sign < 0 else ''}q{i}"
    if joint.offset == 0:
        return variable
    offset = angle_text(joint.offset) if joint.kind == "R" else number_text(joint.offset)
    return f"{variable} - {offset[1:]}" if offset.startswith("-") else f"{variable} + {offset}"


def joint_text(joint: Joint) -> str:
    """A joint in one line, leaving out what is zero.

    Examples
    --------
    >>> from dhlib import Prismatic
    >>> joint_text(Prismatic(offset=0.5))
    'Prismatic(offset=0.5)'
    """
    theta, d = ("offset", "d") if joint.kind == "R" else ("theta", "offset")
    parts = [(d, joint.d, number_text), (theta, joint.theta, angle_text)]
    if joint.kind == "P":
        parts.reverse()
    parts[1:1] = [("a", joint.a, number_text), ("alpha", joint.alpha, angle_text)]
    shown = [f"{name}={text(value)}" for name, value, text in parts if value != 0]
    return f"{type(joint).__name__}({', '.join(shown + ['sign=-1'] * (joint.sign < 0))})"


def table_rows(chain: Chain) -> list[list[str]]:
    """The table as text, row by row, in the order of :data:`COLUMNS`."""
    rows = []
    for i, joint in enumerate(chain.joints, 1):
        theta = variable_text(joint, i) if joint.kind == "R" else angle_text(joint.theta)
        d = number_text(joint.d) if joint.kind == "R" else variable_text(joint, i)
        a, alpha = number_text(joint.a), angle_text(joint.alpha)
        rows.append([theta, d, a, alpha] if chain.convention == "classic" else [alpha, a, theta, d])
    return rows


def caption(chain: Chain) -> str:
    """What the table is, in a line: name, convention, unit, and whether base or tool are there."""
    ends = [end for end in ("base", "tool") if not np.array_equal(getattr(chain, end), np.eye(4))]
    named = f"{chain.name}: " if chain.name else ""
    return f"{named}{chain.convention} DH table, lengths in {chain.unit}" + (
        f", with {' and '.join(ends)}" if ends else ""
    )


def table_text(chain: Chain) -> str:
    """The table in plain text, columns aligned.

    Examples
    --------
    >>> from dhlib import robots
    >>> print(table_text(robots.quickshot()))
    Quickshot: classic DH table, lengths in mm
     i | θ_i | d_i | a_i |  α_i
     1 |  q1 | 100 |  20 | -90°
     2 |  q2 |   0 | 160 |   0°
     3 |  q3 |  28 |   0 |  90°
     4 |  q4 | 250 |   0 |   0°
    """
    headings = [
        f"{symbol}_{index}" if index == "i" else f"{symbol}_{{{index}}}" for symbol, index in COLUMNS[chain.convention]
    ]
    rows = [["i", *headings], *([str(i), *row] for i, row in enumerate(table_rows(chain), 1))]
    widths = [max(len(row[k]) for row in rows) for k in range(5)]
    lines = [" " + " | ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join([caption(chain), *lines])


def table_html(chain: Chain) -> str:
    """The table as HTML, as a notebook shows it.

    Examples
    --------
    >>> from dhlib import robots
    >>> table_html(robots.quickshot()).count("<tr>")
    5
    """
    from html import escape

    headings = "".join(
        f'<th scope="col"><i>{symbol}<sub>{escape(index)}</sub></i></th>' for symbol, index in COLUMNS[chain.convention]
    )
    rows = "".join(
        f'<tr><th scope="row">{i}</th>'
        + "".join(f"<td>{escape(cell).replace('-', '−')}</td>" for cell in row)
        + "</tr>"
        for i, row in enumerate(table_rows(chain), 1)
    )
    return (
        f'<table class="dh-table"><caption>{escape(caption(chain))}</caption>'
        f'<thead><tr><th scope="col"><i>i</i></th>{headings}</tr></thead><tbody>{rows}</tbody></table>'
    )


def table_latex(chain: Chain) -> str:
    r"""The table as a LaTeX array, between dollars as a notebook expects it.

    Examples
    --------
    >>> from dhlib import robots
    >>> print(table_latex(robots.planar(1)))
    $\begin{array}{c|cccc}i & \theta_{i} & d_{i} & a_{i} & \alpha_{i} \\ \hline 1 & q_{1} & 0 & 1 &
    0^\circ\end{array}$
    """
    headings = " & ".join(f"{LATEX[symbol]}_{{{index}}}" for symbol, index in COLUMNS[chain.convention])
    rows = r" \\ ".join(
        " & ".join([str(i), *(_latex_cell(cell, i) for cell in row)]) for i, row in enumerate(table_rows(chain), 1)
    )
    return rf"$\begin{{array}}{{c|cccc}}i & {headings} \\ \hline {rows}\end{{array}}$"


def _latex_cell(cell: str, i: int) -> str:
    return cell.replace(f"q{i}", f"q_{{{i}}}").replace("°", r"^\circ")
