"""Pages that need nothing else, and in which nothing can run.

Templates escape whatever is put into them. Beyond that, the policy of each page allows one thing, the style sheet that
stands in it, by its hash: no script, no other style, no image, no form and no address to fetch from, wherever it may
come from.
"""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from markupsafe import Markup

from dhlib.grading.reports.cells import number
from dhlib.grading.reports.shape import number_text
from dhlib.grading.sentences import begun
from dhlib.palette import DARK, LIGHT
from dhlib.scene import Sketch

#: Of an answer that is quoted.
LONGEST = 90

_STYLE = re.compile(r"<style>(.*?)</style>", re.DOTALL)
#: z_1, a_{i-1}: one letter and its index, and no part of a longer name.
_SYMBOL = re.compile(r"(?<![\w&#])([A-Za-zα-ω])_(?:\{([^{}]*)\}|(\w))(?!\w)")


def render(template: str, drawings_style: str = "", **values: Any) -> str:
    """A page of a template.

    Parameters
    ----------
    template : str
        Name of its file.
    drawings_style : str
        The style sheet of the drawings in it.
    values
        What it is filled with; only `Markup` is taken as it is: our drawings, and sentences that `lettered` escaped.
    """
    style = f"{_sheet()}{drawings_style}"
    return str(_environment().get_template(template).render(style=Markup(style), policy=policy(style), **values))


def policy(style: str) -> str:
    """The content security policy of a page with one style sheet.

    Examples
    --------
    >>> policy("p {}").split("; ")[0], policy("p {}").split("; ")[2:]
    ("default-src 'none'", ["base-uri 'none'", "form-action 'none'"])
    """
    digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
    return f"default-src 'none'; style-src 'sha256-{digest}'; base-uri 'none'; form-action 'none'"


def drawn(sketch: Sketch) -> tuple[Markup, str]:
    """A drawing for a page, and the style sheet that it needs there: the policy allows none within it."""
    svg = sketch.svg()
    style = _STYLE.search(svg)
    without = _STYLE.sub("", svg).replace(' style="max-width:100%;height:auto"', "")
    return Markup(without), style[1] if style else ""


def brief(reading: Any) -> str:
    """The beginning of an answer, on a line.

    Examples
    --------
    >>> brief({"values": [[1.0, 0.25]]}), brief({"choice": "n_x"})
    ('1  0.25', 'n_x')
    """
    if not isinstance(reading, dict):
        return ""
    if isinstance(reading.get("choice"), str):
        return str(reading["choice"])[:LONGEST]
    table = reading.get("table")
    content = table.get("rows") if isinstance(table, dict) else (reading.get("values") or [None])[0]
    words = "  ".join(_leaves(content))
    return words if len(words) <= LONGEST else f"{words[:LONGEST]}…"


def lettered(text: str) -> Markup:
    """A sentence with its symbols as they are printed.

    Examples
    --------
    >>> lettered("z_1 is reversed, a_{i-1} < 0, my_1st is none")
    Markup('<i>z</i><sub>1</sub> is reversed, <i>a</i><sub>i−1</sub> &lt; 0, my_1st is none')
    """

    def symbol(found: re.Match[str]) -> str:
        index = (found[2] or found[3]).replace("-", "−")
        return f"<i>{found[1]}</i><sub>{index}</sub>"

    return Markup(_SYMBOL.sub(symbol, str(Markup.escape(text))))


def _leaves(value: Any) -> Iterator[str]:
    if isinstance(value, list):
        for item in value:
            yield from _leaves(item)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield number_text(float(value))
    elif value is not None:
        yield str(value)


@lru_cache(maxsize=1)
def _environment() -> Any:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    pages = Environment(
        loader=PackageLoader("dhlib.grading.reports", "templates"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    pages.filters |= {"number": number, "brief": brief, "begun": begun, "lettered": lettered}
    return pages


@lru_cache(maxsize=1)
def _sheet() -> str:
    """The style sheet, with the colours of the figures: dark where the reader likes it so, light on paper."""

    def colours(theme: dict[str, str]) -> str:
        return "".join(f"--dh-{name}:{colour};" for name, colour in theme.items())

    environment = _environment()
    rules, _, _ = environment.loader.get_source(environment, "style.css")
    return (
        f":root{{color-scheme:light dark;{colours(LIGHT)}}}"
        f"@media screen and (prefers-color-scheme:dark){{:root{{{colours(DARK)}}}}}\n{rules}"
    )
