"""Mend what the theme's markup says to those who listen or use the keyboard.

Docutils gives literature a role that WAI-ARIA has given up; the theme names its search button, and MyST-NB what it
folds, by other words than those that can be read on them, so that nobody who speaks to the computer can choose them.
Regions that scroll get a place in the order of Tab, by ``book/web/scrolling.js``; buttons that are pressed by keys keep
the focus, by ``book/web/focus.js``. Who reads in the dark sees no light page first, by ``book/web/theme.js``.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from formulas import ROOT
from sphinx.util import logging

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.config import Config

logger = logging.getLogger(__name__)

#: What to look for, and what to write instead.
MENDS = (
    (re.compile(r'(<div class="citation" id="[^"]*") role="doc-biblioentry"'), r'\1 role="listitem"'),
    (re.compile(r'(<button class="[^"]*search-button-field[^"]*") title="Search" aria-label="Search"'), r"\1"),
    (re.compile(r'<summary aria-label="Toggle hidden content">'), "<summary>"),
)
#: The theme asks at once of every listing whether it scrolls, and so has the whole page laid out; scrolling.js waits.
THEME = "_static/scripts/pydata-sphinx-theme.js"
ASKS = re.compile(r"\b(\w+)\.tabIndex=\1\.scrollWidth>\1\.clientWidth\|\|\1\.scrollHeight>\1\.clientHeight\?0:-1")
LEADS_ON = re.compile(r'<meta http-equiv="Refresh" content="0; url=([^"]+)" */?>', re.IGNORECASE)


def mended(page: str) -> str:
    """Return a page with its markup mended.

    >>> mended('<summary aria-label="Toggle hidden content">Show</summary>')
    '<summary>Show</summary>'
    """
    for wrong, right in MENDS:
        page = wrong.sub(right, page)
    return page


def first_page(address: str, title: str) -> str:
    """Return a page that leads on to another one at once, and says so where that is not followed."""
    return (
        f'<!DOCTYPE html>\n<html lang="en-GB">\n<head>\n<meta charset="utf-8">\n<title>{title}</title>\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta http-equiv="Refresh" content="0; url={address}">\n</head>\n'
        f'<body><main><h1>{title}</h1><p><a href="{address}">Read the book</a></p></main></body>\n</html>\n'
    )


def mend_pages(app: Sphinx, exception: Exception | None) -> None:
    """Mend the pages of the built site."""
    if exception is not None or app.builder.format != "html":
        return
    site = Path(app.outdir)
    for path in site.rglob("*.html"):
        page = path.read_text("utf-8")
        if (better := mended(page)) != page:
            path.write_text(better, "utf-8")
    start = site / "index.html"
    if start.exists() and (found := LEADS_ON.search(start.read_text("utf-8"))):
        start.write_text(first_page(found[1], str(app.config.html_title or app.config.project)), "utf-8")


def leave_tabs_to_us(app: Sphinx, exception: Exception | None) -> None:
    """Take out of the theme's script what `scrolling.js` does."""
    path = Path(app.outdir) / THEME
    if exception is not None or app.builder.name != "html":
        return
    script, found = ASKS.subn("0/* scrolling.js */", path.read_text("utf-8"))
    if not found and "scrolling.js" not in script:
        logger.warning("%s no longer asks what scrolls in the way that is known: see accessible.py", THEME)
    path.write_text(script, "utf-8")


def add_scripts(app: Sphinx, _config: Config) -> None:
    """Give every page its scripts."""
    for name in ("theme.js", "scrolling.js", "focus.js"):
        app.add_js_file(None, body=(ROOT / "book" / "web" / name).read_text("utf-8"))


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("config-inited", add_scripts)
    app.connect("build-finished", mend_pages, priority=650)
    app.connect("build-finished", leave_tabs_to_us, priority=650)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
