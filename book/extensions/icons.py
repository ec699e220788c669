"""Send the theme's icons as the few that are used, instead of a script that holds all of Font Awesome.

The theme loads ``_static/scripts/fontawesome.js`` on every page: 541 kB compressed. The outlines of the icons that the
built site names are read from it, and a style sheet of a few kilobytes, put in by the same script, draws them.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from sphinx.util import logging

if TYPE_CHECKING:
    from sphinx.application import Sphinx

logger = logging.getLogger(__name__)

NAMED = re.compile(r"\bfa-([a-z0-9-]+)")
OUTLINE = re.compile(
    r'(?:"([a-z0-9-]+)"|([a-z][a-z0-9]*)):\[(\d+),(\d+),\[([^\]]*)\],"[0-9a-f]*",(?:"([^"]*)"|\[("[^\]]*")\])\]'
)
NOT_ICONS = {"solid", "regular", "brands", "fw", "lg", "sm", "xs", "xl", "stack", "spin", "inverse"}

RULES = """
.fa-solid,.fas,.fa-regular,.far,.fa-brands,.fab{display:inline-block;width:1.25em;height:1em;vertical-align:-.125em;\
background:currentColor;mask:var(--icon) center/contain no-repeat;-webkit-mask:var(--icon) center/contain no-repeat}
.fa-lg{font-size:1.25em;vertical-align:-.075em}
"""


def outlines(script: str) -> dict[str, tuple[str, str, str]]:
    """Return width, height and path of every icon in Font Awesome's script, by name and by former name."""
    icons: dict[str, tuple[str, str, str]] = {}
    for quoted, bare, width, height, aliases, path, paths in OUTLINE.findall(script):
        outline = (width, height, path or "".join(json.loads(f"[{paths}]")))
        for name in (quoted or bare, *re.findall(r'"([a-z0-9-]+)"', aliases)):
            icons.setdefault(name, outline)
    return icons


def style_sheet(names: set[str], icons: dict[str, tuple[str, str, str]]) -> str:
    """Return the rules that draw the icons `names`."""
    rules = []
    for name in sorted(names):
        width, height, path = icons[name]
        svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}"><path d="{path}"/></svg>'
        rules.append(f'.fa-{name}{{--icon:url("data:image/svg+xml,{quote(svg, safe=" /:=")}")}}')
    return RULES + "\n".join(rules)


def slim_icons(app: Sphinx, exception: Exception | None) -> None:
    """Replace Font Awesome's script in the built site."""
    site = Path(app.outdir)
    script = site / "_static" / "scripts" / "fontawesome.js"
    if exception is not None or not script.exists():
        return
    from pydata_sphinx_theme import __file__ as theme

    source = Path(theme).parent / "theme/pydata_sphinx_theme/static/scripts/fontawesome.js"
    icons = outlines(source.read_text("utf-8"))
    asked: set[str] = set()
    for path in [*site.rglob("*.html"), site / "_static/scripts/sphinx-book-theme.js"]:
        asked.update(NAMED.findall(path.read_text("utf-8")))
    asked -= NOT_ICONS
    if missing := asked - icons.keys():
        logger.warning("icons not found in Font Awesome: %s", ", ".join(sorted(missing)))
    css = json.dumps(style_sheet(asked & icons.keys(), icons))
    script.write_text(
        "// The icons of Font Awesome Free 6 (CC BY 4.0, fontawesome.com/license/free) that these pages use.\n"
        f'document.head.appendChild(document.createElement("style")).textContent = {css};\n',
        "utf-8",
    )
    (site / "_static" / "scripts" / "fontawesome.js.map").unlink(missing_ok=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("build-finished", slim_icons, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
