"""Let a page show itself soon: one style sheet instead of eleven, and scripts that wait until the text is there.

The theme and the extensions each bring their own files, one imports another, and every one is a journey to the server
before the first word is shown. The sheets of a page are joined in their order, without the rules that no page needs
(see `needed_rules`); scripts in the head are deferred, which keeps theirs. Bootstrap's watch over the contents, which
lays out all that was left for later, gives way to ours.
"""

from __future__ import annotations

import hashlib
import posixpath
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import needed_rules
from formulas import ROOT
from keeping import Keeper
from needed_rules import pruned, vocabulary

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.config import Config

SHEET = re.compile(r'[ \t]*<link (?=[^>]*rel="stylesheet")[^>]*href="([^"?]+\.css)(?:\?[^"]*)?"[^>]*/?>\n?')
JOINED = re.compile(r'<link rel="stylesheet"[^>]* data-joined="([^"]*)"')
IMPORT = re.compile(r'@import (?:url\()?["\']?([^"\')]+)["\']?\)?;')
ADDRESS = re.compile(r"url\((?![\"']?data:)[\"']?([^\"')]+)[\"']?\)")
IN_HEAD = re.compile(r'<script(?![^>]*\b(?:defer|async|type)\b)([^>]*\bsrc="[^"]+")')
PRELOADED = re.compile(r'[ \t]*<link rel="preload" as="script"[^>]*/?>\n?')
DUMMY = re.compile(r'[ \t]*<script[^>]*src="[^"]*/fontawesome\.js[^"]*"></script>\n?')
SPY = re.compile(r' data-(?:bs-spy|bs-target|offset|bs-root-margin)="[^"]*"')
BODY = re.compile(r"<body[^>]*>")
#: Scripts that may add classes; so may the Python of a page, which writes HTML.
RUNNING = ("_static/**/*.js", "live/*.js", "run/*.js", "run/*.mjs")
PAGE_NAME = re.compile(r"<script>(DOCUMENTATION_OPTIONS\.\w+ = '[^']*';)</script>")


def joined(paths: list[Path], into: Path) -> str:
    """Return style sheets as one that stands in the folder `into`: imports filled in, addresses led from there."""

    def read(path: Path) -> str:
        text = IMPORT.sub(lambda found: read((path.parent / found[1]).resolve()), path.read_text("utf-8"))

        def lead(found: re.Match[str]) -> str:
            target = (path.parent / found[1].split("?")[0]).resolve()
            return f"url({posixpath.relpath(target.as_posix(), into.as_posix())})" if target.exists() else found[0]

        return ADDRESS.sub(lead, text)

    return "\n".join(read(path.resolve()) for path in paths)


def quickened(page: str, link: str) -> str:
    """Return a page with one `link` instead of those to its sheets, and its scripts deferred.

    >>> page = '<link rel="stylesheet" href="a.css"><script src="a.js"></script></head><script src="b.js"></script>'
    >>> quickened(page, '<link rel="stylesheet" href="b.css" />')
    '<link rel="stylesheet" href="b.css" /><script defer src="a.js"></script></head><script src="b.js"></script>'
    """
    head, mark, rest = page.partition("</head>")
    head = DUMMY.sub("", PRELOADED.sub("", head))
    if found := SHEET.search(head):
        head = head[: found.start()] + link + SHEET.sub("", head[found.start() :])
    head = IN_HEAD.sub(r"<script defer\1", head)
    head = PAGE_NAME.sub(r'<script>addEventListener("DOMContentLoaded", () => { \1 });</script>', head)
    return head + mark + BODY.sub(lambda found: SPY.sub("", found[0]), rest, count=1)


def sheets_of(page: str, folder: Path, site: Path) -> tuple[Path, ...]:
    """Return the style sheets of a page, also of one whose sheets an earlier build has joined."""
    head = page.partition("</head>")[0]
    if found := JOINED.search(head):
        return tuple(site / name for name in found[1].split())
    return tuple((folder / one[1]).resolve() for one in SHEET.finditer(head))


def pruned_once(keeper: Keeper, sheet: str, words: set[str]) -> str:
    """Return a style sheet without the rules that no page needs."""

    def make(folder: Path) -> None:
        (folder / "pruned.css").write_text(pruned(sheet, words), "utf-8")

    parts = (sheet, " ".join(sorted(words)), Path(needed_rules.__file__))
    return (keeper.made("sheet", make, *parts) / "pruned.css").read_text("utf-8")


def quicken_pages(app: Sphinx, exception: Exception | None) -> None:
    """Join the style sheets of each page and defer its scripts."""
    if exception is not None or app.builder.name != "html":
        return
    site = Path(app.outdir).resolve()
    into = site / "_static" / "styles"
    written: dict[tuple[Path, ...], str] = {}
    running = [path for pattern in RUNNING for path in site.glob(pattern)]
    running += [path for folder in ("dhlib", "book") for path in (ROOT / folder).rglob("*.py")]
    words = vocabulary(site.rglob("*.html"), running)
    for path in site.rglob("*.html"):
        page = path.read_text("utf-8")
        sheets = sheets_of(page, path.parent, site)
        if not sheets or not all(sheet.is_file() for sheet in sheets):
            continue
        if sheets not in written:
            text = pruned_once(app.keeper, joined(list(sheets), into), words)  # type: ignore[attr-defined]
            written[sheets] = f"page-{hashlib.sha256(text.encode()).hexdigest()[:10]}.css"
            (into / written[sheets]).write_text(text, "utf-8")
        address = posixpath.relpath((into / written[sheets]).as_posix(), path.parent.as_posix())
        names = " ".join(sheet.relative_to(site).as_posix() for sheet in sheets)
        link = f'<link rel="stylesheet" type="text/css" href="{address}" data-joined="{names}" />\n'
        path.write_text(quickened(page, link), "utf-8")
    for old in into.glob("page-*.css"):
        if old.name not in written.values():
            old.unlink()


def add_script(app: Sphinx, _config: Config) -> None:
    """Give every page the scripts that let links find their section, and contents follow the reader."""
    for name in ("sections", "contents"):
        app.add_js_file(None, body=(ROOT / "book" / "web" / f"{name}.js").read_text("utf-8"))


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("config-inited", add_script)
    app.connect("build-finished", quicken_pages, priority=660)  # when the scripts are written
    return {"parallel_read_safe": True, "parallel_write_safe": True}
