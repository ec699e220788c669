"""Make the site an app that can be installed and read without the network: manifest, icons and service worker.

The worker (``book/web/sw.js``) gets the list of all files with the hashes of their content. Pages, styles, scripts and
figures are kept at the first visit; large files and downloads when a page asked for them. Each page also says in its
head what it is about.
"""

from __future__ import annotations

import hashlib
import html
import json
import posixpath
import re
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

from docutils import nodes
from formulas import ROOT

from dhlib import palette
from dhlib.palette import LIGHT

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.config import Config

WEB = ROOT / "book" / "web"
WORKER = "sw.js"
MANIFEST = "manifest.webmanifest"
ICON = "icons/icon.svg"
#: Name, size in pixels, and which part of it the drawing takes; a masked icon may lose its rim.
PICTURES = (("icon-192.png", 192, 1.0), ("icon-512.png", 512, 1.0), ("icon-masked-512.png", 512, 0.7))

PAGES = ("*.html", "book/**/*", "exercises/**/*", "solutions/**/*")
SCRIPTS = ("run/cells.js", "run/exercise.js", "run/progress.js")
KEPT = (*PAGES, *SCRIPTS, "*.js", MANIFEST, "_static/**/*", "_images/**/*", "live/*", "icons/*")
LARGEST = 1_000_000
"""Files beyond this many bytes are kept only when they were used."""
DESCRIPTION = 155
"""A search engine shows about as many characters."""

#: The icon: a frame, its axes as they are coloured everywhere; on a square of 100, y upwards.
AXES = {"x": ((40, 36), (88, 36)), "y": ((40, 36), (16, 14)), "z": ((40, 36), (40, 88))}
SHAFT, HEAD, LONG = 4.5, 11.0, 19.0


def arrow(start: tuple[float, float], end: tuple[float, float]) -> list[tuple[float, float]]:
    """Return the outline of an arrow."""
    (x, y), (u, v) = start, end
    length = ((u - x) ** 2 + (v - y) ** 2) ** 0.5
    along, across = ((u - x) / length, (v - y) / length), (-(v - y) / length, (u - x) / length)
    neck = length - LONG
    outline = [(0, SHAFT), (neck, SHAFT), (neck, HEAD), (length, 0), (neck, -HEAD), (neck, -SHAFT), (0, -SHAFT)]
    return [(x + s * along[0] + t * across[0], y + s * along[1] + t * across[1]) for s, t in outline]


def icon_svg() -> str:
    """Return the icon as SVG."""
    arrows = "".join(
        f'<path fill="{LIGHT[name]}" d="M{"L".join(f"{x:.1f} {100 - y:.1f}" for x, y in arrow(*ends))}Z"/>'
        for name, ends in AXES.items()
    )
    (x, y), _ = AXES["x"]
    dot = f'<circle cx="{x}" cy="{100 - y}" r="8" fill="{LIGHT["ink"]}"/>'
    ground = f'<rect width="100" height="100" rx="18" fill="{LIGHT["ground"]}"/>'
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{ground}{arrows}{dot}</svg>\n'


def write_picture(path: Path, size: int, part: float) -> None:
    """Write the icon as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Polygon

    figure = Figure(figsize=(size / 100, size / 100), dpi=100, facecolor=LIGHT["ground"])
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0, 0, 1, 1))
    rim = 50 / part - 50
    axes.set(xlim=(-rim, 100 + rim), ylim=(-rim, 100 + rim))
    axes.axis("off")
    for name, ends in AXES.items():
        axes.add_patch(Polygon(arrow(*ends), color=LIGHT[name], linewidth=0))
    axes.add_patch(Circle(AXES["x"][0], 8, color=LIGHT["ink"], linewidth=0))
    figure.savefig(path, metadata={"Software": None})


def write_pictures(folder: Path) -> None:
    """Write the icon as PNG in all its sizes."""
    for name, size, part in PICTURES:
        write_picture(folder / name, size, part)


def manifest(title: str, start: str) -> str:
    """Return the manifest of the app."""
    icons: list[dict[str, str]] = [{"src": ICON, "sizes": "any", "type": "image/svg+xml"}]
    for name, size, part in PICTURES:
        purpose = "any" if part == 1 else "maskable"
        icons.append({"src": f"icons/{name}", "sizes": f"{size}x{size}", "type": "image/png", "purpose": purpose})
    about = {
        "name": title,
        "short_name": title.removeprefix("The "),
        "id": "./",
        "start_url": start,
        "scope": "./",
        "display": "minimal-ui",
        "background_color": LIGHT["ground"],
        "theme_color": LIGHT["ground"],
        "icons": icons,
    }
    return json.dumps(about, indent=1) + "\n"


def files_to_keep(site: Path) -> tuple[dict[str, str], dict[str, str]]:
    """Return the files of a site with hashes of their content: those kept at once, and those kept when used."""
    at_once = {path for pattern in KEPT for path in site.glob(pattern)}
    kept: dict[str, str] = {}
    when_used: dict[str, str] = {}
    for path in sorted(site.rglob("*")):
        name = path.relative_to(site).as_posix()
        if not path.is_file() or name == WORKER or path.name.startswith("."):
            continue
        content = path.read_bytes()
        chosen = kept if path in at_once and len(content) <= LARGEST else when_used
        chosen[name] = hashlib.sha256(content).hexdigest()[:16]
    return kept, when_used


def write_worker(site: Path) -> None:
    """Write the service worker for what is in a site now."""
    kept, when_used = files_to_keep(site)
    data = json.dumps({"kept": kept, "whenUsed": when_used}, separators=(",", ":"))
    (site / WORKER).write_text(f"const SITE = {data};\n{(WEB / WORKER).read_text('utf-8')}", "utf-8")


def description(title: str, doctree: nodes.document | None) -> str:
    """Return what a page is about: its first paragraph that needs no formula, as far as a search engine shows it."""
    for paragraph in doctree.findall(nodes.paragraph) if doctree else ():
        text = re.sub(r"\s+", " ", paragraph.astext()).strip()
        if len(text) < 50 or next(paragraph.findall(nodes.math), None) is not None:
            continue
        if len(text) > DESCRIPTION:
            text = text[:DESCRIPTION].rsplit(" ", 1)[0].rstrip(",;:") + " …"
        return text
    return f"{title}: a page of the DH book, on the Denavit-Hartenberg conventions for robot arms."


def add_to_head(
    app: Sphinx, page: str, _template: str, context: dict[str, Any], doctree: nodes.document | None
) -> None:
    """Name the manifest and the icons in the head of a page, and what the page is about."""
    here = posixpath.dirname(app.builder.get_target_uri(page)) or "."

    def address(name: str) -> str:
        return posixpath.relpath(name, here)

    tags = f'<link rel="manifest" href="{address(MANIFEST)}">'
    tags += f'\n<link rel="icon" type="image/svg+xml" href="{address(ICON)}">'
    tags += f'\n<link rel="apple-touch-icon" href="{address("icons/icon-192.png")}">'
    metatags = context.get("metatags", "")
    if 'name="description"' not in metatags:
        title = re.sub(r"<[^>]+>", "", context.get("title", ""))
        tags += f'\n<meta name="description" content="{html.escape(description(html.unescape(title), doctree))}">'
    context["metatags"] = f"{metatags}\n{tags}\n"


def write_app(app: Sphinx, exception: Exception | None) -> None:
    """Write manifest, icons and worker, when all else of the site is written."""
    if exception is not None or app.builder.name != "html":
        return
    site = Path(app.outdir)
    (site / "icons").mkdir(exist_ok=True)
    (site / ICON).write_text(icon_svg(), "utf-8")
    pictures = app.keeper.made(  # type: ignore[attr-defined]
        "icons", write_pictures, Path(__file__), Path(palette.__file__)
    )
    for name, _size, _part in PICTURES:
        shutil.copyfile(pictures / name, site / "icons" / name)
    start = app.builder.get_target_uri(app.config.root_doc)
    (site / MANIFEST).write_text(manifest(str(app.config.html_title or app.config.project), start), "utf-8")
    write_worker(site)


def add_script(app: Sphinx, _config: Config) -> None:
    """Give every page the script that installs the worker."""
    app.add_js_file(None, body=(WEB / "offline.js").read_text("utf-8"))


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("config-inited", add_script)
    app.connect("html-page-context", add_to_head)
    app.connect("build-finished", write_app, priority=950)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
