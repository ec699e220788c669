"""Print ``x_{i-1}`` in a docstring as x with an index: a terminal shows the one, the reference the other."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

#: Code stays as it is: what stands in backquotes, and examples up to the next empty line.
CODE = re.compile(r"(``.+?``|`[^`]+`|^\s*>>>.*?(?:^\s*$|\Z))", re.DOTALL | re.MULTILINE)
SYMBOL = re.compile(r"(?<![a-zα-ω0-9_])([a-zα-ω])_(?:\{([^}]+)\}|([a-z0-9]))(?![a-z0-9_])", re.IGNORECASE)


def with_indices(text: str) -> str:
    r"""Return the reStructuredText of a docstring with its indices marked.

    >>> print(with_indices("from α_{i-1} to T_n, by ``x_i``"))
    from \ *α*\ :sub:`i-1` to \ *T*\ :sub:`n`, by ``x_i``
    """
    parts = CODE.split(text)
    parts[::2] = [
        SYMBOL.sub(lambda found: rf"\ *{found[1]}*\ :sub:`{found[2] or found[3]}`", part) for part in parts[::2]
    ]
    return "".join(parts)


def mark_indices(_app: Sphinx, _what: str, _name: str, _object: Any, _options: Any, lines: list[str]) -> None:
    """Mark the indices of a docstring that numpydoc has read."""
    lines[:] = with_indices("\n".join(lines)).split("\n")


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("autodoc-process-docstring", mark_indices, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
