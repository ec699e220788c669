"""The pictures of the class page: drawn by matplotlib, coloured by the page."""

from __future__ import annotations

import io
import re
from collections.abc import Sequence
from typing import Any

from markupsafe import Markup

from dhlib.grading.reports.statistics import PartFigures
from dhlib.palette import LIGHT

WIDTH = 7.4
#: What matplotlib would draw in black.
INKED = ("text.color", "axes.labelcolor", "xtick.color", "ytick.color")
#: How dark the darkest cell of a heat map is.
DARKEST = 0.85

_NUMBER = re.compile(r"\s(?:width|height)=\"[\d.]+pt\"")
_STYLE = re.compile(r' style="([^"]*)"')
_DEFS_STYLE = re.compile(r"<style type=\"text/css\">.*?</style>", re.DOTALL)
_PROLOGUE = re.compile(r"^.*?(?=<svg)", re.DOTALL)
_METADATA = re.compile(r"<metadata>.*?</metadata>", re.DOTALL)
#: What matplotlib writes as style may stand as attributes of the same names, and an attribute needs no policy.
_ATTRIBUTES = re.compile(r"(?:fill|stroke|opacity|font|text)[\w-]*")


def marks(points: Sequence[float], out_of: float) -> Markup:
    """How the results are spread."""
    figure, axes = _figure(2.3)
    bins = [out_of * k / 10 for k in range(11)]
    counts, _, _ = axes.hist(points, bins=bins, color=LIGHT["z"], edgecolor=LIGHT["ground"])
    axes.set_xlabel("points")
    axes.set_ylabel("students")
    axes.set_xlim(0, out_of)
    axes.yaxis.get_major_locator().set_params(integer=True)
    highest = int(max(counts)) if len(counts) else 0
    return _svg(figure, f"Histogram of {len(points)} results, 0 to {out_of:g} points; the highest bar has {highest}.")


def parts(figures: Sequence[PartFigures]) -> Markup:
    """How much of each part's points the class earned, and how well the part tells who understood the rest."""
    import numpy as np

    figure, (left, right) = _figure(0.9 + 0.26 * len(figures), columns=2)
    rows = np.arange(len(figures))
    left.barh(rows, [100 * each.mean for each in figures], color=LIGHT["z"], height=0.7)
    left.set_yticks(rows, [each.part for each in figures])
    left.set_xlim(0, 100)
    left.set_xlabel("mean, % of the points")
    tells = [each.discrimination if each.discrimination is not None else 0.0 for each in figures]
    colours = [LIGHT["right"] if value >= 0.2 else LIGHT["muted"] if value >= 0 else LIGHT["wrong"] for value in tells]
    right.barh(rows, tells, color=colours, height=0.7)
    right.set_yticks(rows, [])
    right.set_xlim(min(-0.2, *tells), 1)
    right.axvline(0, color=LIGHT["muted"], linewidth=0.8)
    right.set_xlabel("correlation with the rest")
    for axes in (left, right):
        axes.invert_yaxis()
        axes.tick_params(axis="y", length=0)
    hardest = min(figures, key=lambda each: each.mean)
    return _svg(
        figure, f"Mean and correlation of each part; the hardest is {hardest.part}, {100 * hardest.mean:.0f} %."
    )


def heat(names: Sequence[str], columns: Sequence[str], counts: Sequence[Sequence[int]]) -> Markup:
    """How many students showed which misconception in which part."""
    figure, axes = _figure(1.4 + 0.3 * len(names))
    most = max((count for row in counts for count in row), default=1) or 1
    for i, row in enumerate(counts):
        for j, count in enumerate(row):
            if not count:
                continue
            strength = DARKEST * count / most
            axes.add_patch(_square(j, i, strength))
            axes.text(j, i, str(count), ha="center", va="center", color=LIGHT["ink"], fontsize=9)
    axes.set_xlim(-0.5, len(columns) - 0.5)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xticks(range(len(columns)), columns, rotation=60, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(names)), names)
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(True)
    return _svg(figure, "Students by misconception (rows) and part (columns); the table below has the same in words.")


def _square(column: int, row: int, strength: float) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle((column - 0.48, row - 0.48), 0.96, 0.96, facecolor=LIGHT["x"], alpha=strength, linewidth=0)


def _figure(height: float, columns: int = 1) -> Any:
    """A figure without a window, in the ink of the page."""
    import matplotlib as mpl
    from matplotlib.figure import Figure

    look: dict[Any, Any] = dict.fromkeys(INKED, LIGHT["ink"])
    look |= {"axes.edgecolor": LIGHT["muted"], "axes.spines.top": False, "axes.spines.right": False}
    look |= {"font.size": 10, "text.parse_math": False, "axes.facecolor": "none"}
    with mpl.rc_context(look):
        figure = Figure(figsize=(WIDTH, height), layout="constrained")
        axes = figure.subplots(1, columns, sharey=False)
    figure.patch.set_alpha(0.0)
    return figure, axes


def _svg(figure: Any, alt: str) -> Markup:
    """A figure as SVG whose colours are those of the page, and whose text is text."""
    import matplotlib as mpl

    buffer = io.StringIO()
    with mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": alt, "text.parse_math": False}):
        figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    svg = _PROLOGUE.sub("", buffer.getvalue())
    for pattern in (_METADATA, _DEFS_STYLE):
        svg = pattern.sub("", svg)
    svg = _STYLE.sub(_attributes, svg)
    svg = _NUMBER.sub("", svg, count=2)
    for name, colour in LIGHT.items():
        svg = re.sub(rf'"{colour}"', f'"var(--dh-{name})"', svg, flags=re.IGNORECASE)
    title = Markup.escape(alt)
    return Markup(svg.replace(">", f' role="img"><title>{title}</title>', 1))


def _attributes(found: re.Match[str]) -> str:
    """A style as attributes; a font is left to the page."""
    said = []
    for rule in found[1].split(";"):
        name, _, value = rule.partition(":")
        name, value = name.strip(), value.strip()
        if name == "font":
            size = re.search(r"(\d+(?:\.\d+)?)px", value)
            said.append(f'font-size="{size[1]}"' if size else "")
        elif _ATTRIBUTES.fullmatch(name) and name != "font-family":
            said.append(f'{name}="{value}"')
    return " " + " ".join(each for each in said if each) if any(said) else ""
