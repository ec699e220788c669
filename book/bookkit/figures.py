"""Put a drawing into the page itself: it takes the page's colours, in light, dark and print."""

from __future__ import annotations

import html
import io
import re
from functools import cache
from pathlib import Path
from typing import Any

from bookkit.glue import publish

COLOURS = Path(__file__).parent.parent / "style" / "colours.css"


@cache
def palette() -> dict[str, str]:
    """Return the figure colours on a light ground by name: ``x``, ``y``, ``z``, ``ink`` and the others.

    Draw with these where the drawing program wants a colour as a number, as matplotlib does: `inline_svg`
    turns each into the variable of the style sheet.
    """
    light = COLOURS.read_text("utf-8").split("}")[0]
    return dict(re.findall(r"--dh-([a-z]+): (#[0-9a-f]{6});", light))


def inline_svg(drawing: Any, alt: str, name: str = "") -> str:
    """Return a drawing as SVG to stand in a page.

    Parameters
    ----------
    drawing : str or matplotlib figure
        SVG source, or what has a ``savefig``. Colours of `palette` become variables of the style sheet; SVG
        source may also write ``var(--dh-x)`` itself.
    alt : str
        What the figure shows, for those who do not see it: what to notice, not how it is drawn.
    name : str
        Put before the ids in the drawing, so that two drawings of a page cannot mix them up.

    Returns
    -------
    str
        An ``<svg>`` element.

    Raises
    ------
    ValueError
        If `alt` is empty, or `drawing` holds no ``<svg>``.
    """
    if not alt.strip():
        raise ValueError("A figure needs alt text: say what a reader should see in it.")
    source = _source(drawing)
    found = re.search(r"<svg\b([^>]*)>(.*)</svg>", source, re.DOTALL)
    if not found:
        raise ValueError("This drawing holds no <svg> element.")
    attributes, body = found.groups()
    kept = " ".join(re.findall(r'\b(?:viewBox|preserveAspectRatio)="[^"]*"', attributes))
    if width := re.search(r'\bwidth="([\d.]+)(px|pt|)"', attributes):
        pixels = float(width[1]) * (4 / 3 if width[2] == "pt" else 1)
        kept += f' style="max-width:{pixels:.0f}px"'
    label = html.escape(alt, quote=True)
    opening = f'<svg xmlns="http://www.w3.org/2000/svg" class="dh-figure" role="img" aria-label="{label}" {kept}>'
    svg = f"{opening}{body}</svg>"
    svg = re.sub(r"<(metadata|title|desc)\b.*?</\1>", "", svg, flags=re.DOTALL)
    svg = svg.replace("xlink:href=", "href=")
    if name:
        svg = re.sub(r'\bid="([^"]+)"', rf'id="{name}-\1"', svg)
        svg = re.sub(r'(url\(#|href="#)', rf"\1{name}-", svg)
    for colour, value in [*palette().items(), ("ink", "#000000")]:
        svg = re.sub(re.escape(value), f"var(--dh-{colour})", svg, flags=re.IGNORECASE)
    return re.sub(r"\n\s*\n+", "\n", svg)


def glue_figure(name: str, drawing: Any, alt: str) -> None:
    """Keep a drawing for a ``{glue:figure}`` block, which gives it a caption and a number.

    Parameters
    ----------
    name : str
        What the text calls it.
    drawing : str or matplotlib figure
        See `inline_svg`.
    alt : str
        What the figure shows, for those who do not see it.
    """
    publish(name, plain=alt, html=inline_svg(drawing, alt, name))


def show_figure(drawing: Any, alt: str, name: str = "figure") -> None:
    """Show a drawing below the cell, without caption and number.

    Parameters
    ----------
    drawing : str or matplotlib figure
        See `inline_svg`.
    alt : str
        What the figure shows, for those who do not see it.
    name : str
        Put before the ids in the drawing; needed where a page shows two drawings with ids.
    """
    from IPython.display import display

    display(  # type: ignore[no-untyped-call]
        {"text/html": inline_svg(drawing, alt, name), "text/plain": alt}, raw=True
    )


def _source(drawing: Any) -> str:
    if isinstance(drawing, str):
        return drawing
    if not hasattr(drawing, "savefig"):
        raise ValueError(f"A drawing is SVG source or a matplotlib figure, not {type(drawing).__name__}.")
    import matplotlib as mpl

    buffer = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "dh", "svg.fonttype": "path"}):
        drawing.savefig(buffer, format="svg", transparent=True, bbox_inches="tight", metadata={"Date": None})
    return buffer.getvalue()
