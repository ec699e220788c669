"""Figures that live in the page: ``{dh-link}``, ``{dh-robot}`` and ``{dh-place}``.

Each is a custom element with its data inline, and within it a still picture, made by dhlib, for print and for readers
without scripts. The script of a figure is one classic file, so that it runs from ``file://`` too; it is bundled from
``book/web`` into ``live/`` of the site when a page has such a figure, and stands right before the first one, so that
nothing shifts when the figure comes alive.
"""

from __future__ import annotations

import html
import math
import posixpath
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from formulas import ROOT
from scripts import WEB, bundle, edition
from sphinx.util.docutils import SphinxDirective

from dhlib import Chain, DHError, Revolute, robots
from dhlib.export import bodies, chain_json, figure_data, to_json
from dhlib.sketch import link, sketch, steps

sys.path.append(str(ROOT / "book"))
from bookkit.figures import inline_svg

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

#: The scripts of a kind of figure: its own first, then what that one loads when it is needed.
SCRIPTS = {"link": ("link",), "robot": ("robot", "space"), "place": ("place",)}
FIGURE = re.compile(r"<dh-([a-z]+) ")


class live_figure(nodes.General, nodes.Element):  # type: ignore[misc]
    """Has the ``kind`` of figure, the ``data`` of its element, its ``still`` picture as SVG, and ``alt`` for it."""


class LiveFigure(SphinxDirective):
    """What the three directives share: the caption is their content."""

    has_content = True
    kind: ClassVar[str]

    def data(self) -> dict[str, str]:
        """Return the attributes of the element."""
        raise NotImplementedError

    def still(self) -> tuple[str, str]:
        """Return the still picture as SVG source, and what it shows."""
        raise NotImplementedError

    def run(self) -> list[nodes.Node]:
        """Return a figure with the element and the caption."""
        figure = nodes.figure("", classes=["live-figure"])
        self.set_source_info(figure)
        for path in WEB.iterdir():  # the page names the edition of its scripts
            self.env.note_dependency(str(path))
        serial = self.env.new_serialno(f"dh-{self.kind}") + 1
        try:
            data, (svg, alt) = self.data(), self.still()
        except (DHError, ValueError) as fault:
            raise self.error(f"{self.name}: {fault}") from fault
        alt = self.options.get("alt", alt)
        name = f"live-{self.options['name']}" if "name" in self.options else f"live-{self.kind}-{serial}"
        element = live_figure(kind=self.kind, data={"id": name} | data, still=inline_svg(svg, alt, name), alt=alt)
        figure += element
        if self.content:
            caption, *more = self.parse_content_to_nodes()
            figure += nodes.caption(caption.rawsource, "", *caption.children)
            if more:
                figure += nodes.legend("", *more)
        self.add_name(figure)
        return [figure]


def convention(argument: str) -> str:
    """Read the name of a convention."""
    return str(directives.choice(argument, ("classic", "modified")))


class DhLink(LiveFigure):
    """Two frames and the link between them, four parameters to drag, four steps to play."""

    kind = "link"
    option_spec: ClassVar[dict[str, Callable[[str], Any]]] = {
        "name": directives.unchanged_required,
        "alt": directives.unchanged_required,
        "convention": convention,
        "theta": float,
        "d": float,
        "a": float,
        "alpha": float,
        "reach": float,
        "unit": directives.unchanged_required,
        "index": directives.unchanged_required,
        "still": lambda argument: directives.choice(argument, ("link", "steps")),
    }

    def values(self) -> dict[str, Any]:
        """Return the options; lengths that were left out are parts of the reach."""
        reach = self.options.get("reach", 2.0)
        values: dict[str, Any] = {
            "convention": "classic",
            "theta": 70.0,
            "d": 0.5 * reach,
            "a": 0.8 * reach,
            "alpha": -55.0,
            "reach": reach,
            "unit": "",
            "index": "i",
        }
        values |= {name: self.options[name] for name in values if name in self.options}
        for name in ("d", "a"):
            if abs(values[name]) > reach:
                raise ValueError(f"{name} is {values[name]:g}, beyond the reach of {reach:g}; give :reach: too.")
        for name in ("theta", "alpha"):
            if abs(values[name]) > 180:
                raise ValueError(f"{name} is {values[name]:g}°; it should be within ±180°.")
        return values

    def data(self) -> dict[str, str]:
        """Return the attributes of the element."""
        return {name: f"{value:g}" if isinstance(value, float) else value for name, value in self.values().items()}

    def still(self) -> tuple[str, str]:
        """Return the link at its first values, or its four steps."""
        values = self.values()
        joint = Revolute(
            d=values["d"], a=values["a"], alpha=math.radians(values["alpha"]), offset=math.radians(values["theta"])
        )
        index = values["index"]
        before = str(int(index) - 1) if index.isdigit() else f"{index}-1"
        chain = Chain([joint], values["convention"])
        if self.options.get("still") == "steps":
            drawing = steps(chain, 1, [0.0], names=(before, index), width=460)
        else:
            drawing = link(chain, 1, [0.0], names=(before, index))
        return drawing.svg(), drawing.alt


class DhRobot(LiveFigure):
    """A whole arm of ``dhlib.robots``: its joints to move, its frames in both conventions, tables and T."""

    kind = "robot"
    required_arguments = 1
    option_spec: ClassVar[dict[str, Callable[[str], Any]]] = {
        "name": directives.unchanged_required,
        "alt": directives.unchanged_required,
        "convention": lambda argument: directives.choice(argument, ("classic", "modified", "both")),
        "arguments": directives.unchanged_required,
        "q": directives.unchanged_required,
        "elbow": directives.flag,
    }

    def chain(self) -> Chain:
        """Return the arm that is asked for."""
        return read_robot(self.arguments[0], self.options.get("arguments", ""))

    def pose(self, chain: Chain) -> list[float]:
        """Return q, as asked for in degrees and lengths, or zeros."""
        if "q" not in self.options:
            return [0.0] * chain.n
        given = [float(value) for value in re.split(r"[,\s]+", self.options["q"].strip())]
        if len(given) != chain.n:
            raise ValueError(f"q has {len(given)} values; {chain.name} has {chain.n} joints.")
        return [math.radians(value) if kind == "R" else value for value, kind in zip(given, chain.kinds, strict=True)]

    def data(self) -> dict[str, str]:
        """Return the attributes of the element: the arm in both conventions."""
        chain = self.chain()
        data = figure_data(chain)
        if "elbow" in self.options and not data["elbow"]:
            raise ValueError(
                f"{chain.name} has no elbow circle: that takes seven revolute joints, of which 1, 2, 3 meet in the "
                "shoulder and 5, 6, 7 in the wrist, each at right angles to the next."
            )
        data["elbow"] = "elbow" in self.options
        return {
            "convention": self.options.get("convention", chain.convention),
            "figure": to_json(data),
            "q": to_json(self.pose(chain)),
        }

    def still(self) -> tuple[str, str]:
        """Return the arm at its first q."""
        chain = self.chain()
        wanted = self.options.get("convention", chain.convention)
        shown = chain.to_modified() if wanted == "modified" else chain.to_classic()
        drawing = sketch(shown, self.pose(chain))
        return drawing.svg(), drawing.alt


class DhPlace(LiveFigure):
    """Joint axes in space, on which the reader places the frames."""

    kind = "place"
    required_arguments = 1
    option_spec: ClassVar[dict[str, Callable[[str], Any]]] = {
        "name": directives.unchanged_required,
        "alt": directives.unchanged_required,
        "convention": convention,
        "arguments": directives.unchanged_required,
    }

    def chain(self) -> Chain:
        """Return the arm that is asked for, in the convention that is asked for."""
        chain = read_robot(self.arguments[0], self.options.get("arguments", ""))
        return chain.to_modified() if self.options.get("convention", "classic") == "modified" else chain.to_classic()

    def data(self) -> dict[str, str]:
        """Return the attributes of the element: the arm, of which the figure shows the axes alone."""
        chain = self.chain()
        return {"chain": chain_json(chain)} | {name: to_json(value) for name, value in bodies(chain).items()}

    def still(self) -> tuple[str, str]:
        """Return the arm with its axes, without frames."""
        chain = self.chain()
        drawing = sketch(
            chain,
            [0.0] * chain.n,
            show=("links", "joints", "axes"),
            alt=f"{chain.name} with its joint axes 1 to {chain.n}, at q = 0. No frames are placed yet.",
        )
        return drawing.svg(), drawing.alt


def read_robot(name: str, arguments: str = "") -> Chain:
    """Return a robot of the library by name; arguments are written as ``lengths=A, source=craig``."""
    if name not in robots.__all__:
        raise ValueError(f"there is no robot {name!r}; it should be one of {', '.join(robots.__all__)}.")
    pairs = [pair.partition("=") for pair in arguments.split(",") if pair.strip()]
    given: dict[str, Any] = {key.strip(): value.strip() for key, _, value in pairs}
    if "n" in given:
        given["n"] = int(given["n"])
    chain: Chain = getattr(robots, name)(**given)
    return chain


def visit_html(translator: HTML5Translator, node: live_figure) -> None:
    """Write the element, and its script before the first one of a page."""
    page = translator.builder.current_docname
    written = translator.__dict__.setdefault("live_figures", set())
    if (page, node["kind"]) not in written:
        written.add((page, node["kind"]))
        here = posixpath.dirname(translator.builder.get_target_uri(page))
        address = posixpath.relpath(f"live/{node['kind']}.js", here or ".")
        translator.body.append(f'<script src="{address}?v={edition(WEB.iterdir())}"></script>\n')
    attributes = "".join(f' {key}="{html.escape(str(value), quote=True)}"' for key, value in node["data"].items())
    translator.body.append(f"<dh-{node['kind']}{attributes}>{node['still']}</dh-{node['kind']}>\n")
    raise nodes.SkipNode


def visit_latex(translator: Any, node: live_figure) -> None:
    """Write what the figure shows: LaTeX draws no SVG."""
    translator.body.append(translator.encode(node["alt"]))
    raise nodes.SkipNode


def bundle_what_is_used(app: Sphinx, exception: Exception | None) -> None:
    """Bundle the scripts of the figures that stand in the site."""
    if exception is not None or app.builder.format != "html":
        return
    site = Path(app.outdir)
    kinds = {kind for page in site.rglob("*.html") for kind in FIGURE.findall(page.read_text("utf-8"))}
    for old in site.glob("live/*"):
        old.unlink()
    if kinds:
        bundle(site / "live", {f"web/{name}" for kind in kinds for name in SCRIPTS[kind]})


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.add_node(live_figure, html=(visit_html, None), latex=(visit_latex, None))
    for directive in (DhLink, DhRobot, DhPlace):
        app.add_directive(f"dh-{directive.kind}", directive)
    app.connect("build-finished", bundle_what_is_used)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
