"""What the page has of ``IPython.display``: enough for the chapters, and for a reader who displays something."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def _nowhere(data: dict[str, Any], metadata: dict[str, Any]) -> None:
    """Nothing shows what is displayed before a kernel is there."""


#: Where what is displayed goes; the kernel of the page sets it.
show: Callable[[dict[str, Any], dict[str, Any]], None] = _nowhere


def display(*values: Any, raw: bool = False, metadata: dict[str, Any] | None = None, **_: Any) -> None:
    """Show values below the cell; with `raw`, a value is a dictionary of its forms."""
    from kernel import forms

    for value in values:
        show(dict(value) if raw else forms(value), metadata or {})


class _Text:
    def __init__(self, data: str) -> None:
        self.data = data


class HTML(_Text):
    """HTML to display."""

    def _repr_html_(self) -> str:
        return self.data


class SVG(_Text):
    """A drawing to display."""

    def _repr_svg_(self) -> str:
        return self.data


class Latex(_Text):
    """LaTeX to display."""

    def _repr_latex_(self) -> str:
        return self.data


class Math(_Text):
    """A formula to display."""

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self.data.strip('$')}$"


class Markdown(_Text):
    """Text to display."""

    def _repr_markdown_(self) -> str:
        return self.data
