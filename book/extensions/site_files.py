"""Leave in the site what a reader's browser can ask for, and nothing of earlier builds.

Sphinx never removes a page that was renamed or taken out of the table of contents, and the theme brings
source maps, three formats of Font Awesome and its own translations of words that no page shows.
"""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

NEEDLESS = (
    "_static/**/*.map",
    "_static/*macros.html",
    "_static/images/logo_*",
    "_static/locales",
)


def remove_needless(app: Sphinx, exception: Exception | None) -> None:
    """Remove the theme's ballast, and pages that are no longer part of the book."""
    if exception is not None or app.builder.name != "html":
        return
    site = Path(app.outdir)
    for pattern in NEEDLESS:
        for path in list(site.glob(pattern)):
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    of_sphinx = {"index", "search", "genindex", "py-modindex"}
    for page in site.rglob("*.html"):
        name = page.relative_to(site).with_suffix("").as_posix()
        if name not in app.env.found_docs and name not in of_sphinx and not name.startswith("_"):
            page.unlink()
            for source in site.glob(f"_sources/{name}.*"):
                source.unlink()


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("build-finished", remove_needless, priority=700)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
