"""Keep executed outputs under a key made of everything a chapter's code can depend on.

Jupyter Book's cache knows a chapter's own cells alone: after an edit of the library it would go on showing
old numbers. Here the cache lives in a folder named by the content of the library, the exercises, the book's
helpers and extensions and the locks. The folder's name is a setting of MyST-NB, and Sphinx reads every page
anew when such a setting changes.
"""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.config import Config

DEPENDS_ON = (
    "dhlib/**/*.py",
    "exercises/*.py",
    "book/bookkit/**/*",
    "book/extensions/**/*",
    "book/style/colours.css",
    "requirements/*.lock",
    "package-lock.json",
)


def content_key(root: Path) -> str:
    """Return a short hash over what executed outputs depend on: files under `root`, and the Python."""
    digest = hashlib.sha256(f"{sys.version_info[:2]}".encode())
    for pattern in DEPENDS_ON:
        for path in sorted(root.glob(pattern)):
            if path.is_file() and path.suffix != ".pyc":
                content = path.read_bytes()
                digest.update(f"\n{path.relative_to(root).as_posix()} {len(content)}\n".encode())
                digest.update(content)
    return digest.hexdigest()[:16]


def set_cache_path(app: Sphinx, config: Config) -> None:
    """Name the folder of executed outputs; all editions of the book share it."""
    root = Path(app.srcdir)
    config["nb_execution_cache_path"] = str(root / "_build" / ".jupyter_cache" / content_key(root))


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("config-inited", set_cache_path)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
