"""Send the theme's icons as the few glyphs that are used, instead of all of Font Awesome.

The theme brings Font Awesome twice: as a script of 541 kB compressed that draws icons as SVG, and as fonts with a style
sheet. The fonts alone do it. They are cut down to the icons that the pages and style sheets name, with their rules.
"""

from __future__ import annotations

import re
import shutil
from logging import getLogger
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pydata_sphinx_theme
from fontTools import subset
from sphinx.util import logging

if TYPE_CHECKING:
    from sphinx.application import Sphinx

logger = logging.getLogger(__name__)
getLogger("fontTools").setLevel("WARNING")

THEME = Path(pydata_sphinx_theme.__file__).parent / "theme" / "pydata_sphinx_theme" / "static"
FONTS = "vendor/fontawesome/webfonts"
SHEET = "styles/pydata-sphinx-theme.css"

NAMED = re.compile(r"\bfa-([a-z0-9-]+)")
RULE = re.compile(r'((?:\.fa-[a-z0-9-]+:before,?)+)\{content:"\\([0-9a-f]+)"\}')
DRAWN = re.compile(r'"\\([ef][0-9a-f]{3})\s*"|"([\ue000-\uf8ff])"')
NO_ICON = {"solid", "regular", "brands", "fw", "lg", "sm", "xs", "xl", "2x"}


def prune(sheet: str, asked: set[str]) -> tuple[str, set[str]]:
    """Return Font Awesome's style sheet without the rules of icons that are not `asked` for, and the names found."""
    found: set[str] = set()

    def keep(rule: re.Match[str]) -> str:
        names = asked & set(NAMED.findall(rule[1]))
        found.update(names)
        return rule[0] if names else ""

    return RULE.sub(keep, sheet), found


def cut_font(source: Path, glyphs: set[int], target: Path) -> None:
    """Write the font `source` with `glyphs` alone."""
    options = subset.Options(flavor="woff2", notdef_outline=True)
    font = subset.load_font(str(source), options)
    cutter = subset.Subsetter(options)
    cutter.populate(unicodes=glyphs)
    cutter.subset(font)
    subset.save_font(font, str(target), options)


def slim_icons(app: Sphinx, exception: Exception | None) -> None:
    """Cut Font Awesome down in the built site."""
    static = Path(app.outdir) / "_static"
    if exception is not None or not (static / SHEET).exists():
        return
    asked: set[str] = set()
    for path in [*static.parent.rglob("*.html"), static / "scripts" / "sphinx-book-theme.js"]:
        asked.update(NAMED.findall(path.read_text("utf-8")))
    sheet, found = prune((THEME / SHEET).read_text("utf-8"), asked)
    if missing := asked - found - NO_ICON:
        logger.warning("icons that Font Awesome does not have: %s", ", ".join(sorted(missing)))
    (static / SHEET).write_text(sheet, "utf-8")
    sheets = "".join(path.read_text("utf-8") for path in static.rglob("*.css"))
    glyphs = {int(code, 16) if code else ord(letter) for code, letter in DRAWN.findall(sheets)}
    for font in (THEME / FONTS).glob("*.woff2"):
        made = app.keeper.made(  # type: ignore[attr-defined]
            "font",
            lambda into, font=font: cut_font(font, glyphs, into / font.name),
            font,
            str(sorted(glyphs)),
            Path(__file__),
        )
        shutil.copyfile(made / font.name, static / FONTS / font.name)
        (static / FONTS / font.with_suffix(".ttf").name).unlink(missing_ok=True)
    (static / "scripts" / "fontawesome.js").write_text(
        "// Icons come from a font: see book/extensions/icons.py.\n", "utf-8"
    )


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("build-finished", slim_icons, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
