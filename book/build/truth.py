"""Find what a chapter states without code that proves it, and figures that say nothing to who cannot see them."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from typing import NamedTuple


class Finding(NamedTuple):
    """A line of a chapter, and what is wrong with it."""

    line: int
    what: str
    text: str


FENCE = re.compile(r"^\s*(`{3,}|~{3,}|:{3,})\s*(\{[^}]*\})?(.*)$")
MATRIX = re.compile(r"\\begin\{([bpvBV]?(?:small)?matrix|array)\*?\}|\\(?:[bp]?matrix|array)\s*\{")
DECIMAL = re.compile(r"(?<![\w.§-])[-−+]?\d+[.]\d+(?![\w.]*\d*\.)(?!\w)")
TABLE_NUMBER = re.compile(
    r"[-−+]?(\d+([.,]\d+)?|\d*\\?(pi|π)(/\d+)?|\\[dt]?frac\{\w+\}\{\d+\})(\s*(°|mm|m|rad|\\degree))?"
)
QUOTED = re.compile(r"CC BY \d\.\d|\{[a-z:]+\}`[^`]*`|`[^`]*`|\]\([^)]*\)|<https?:[^>]*>|https?:\S+")


def prose(chapter: str) -> list[tuple[int, str]]:
    """Return the numbered lines of a MyST chapter that are its text: no header, code, or options of directives."""
    lines = chapter.split("\n")
    kept: list[tuple[int, str]] = []
    inside: list[tuple[str, bool]] = []  # open fences, and whether each holds code
    start = 0
    if lines and lines[0] == "---":
        start = lines.index("---", 1) + 1
    for number, line in enumerate(lines[start:], start + 1):
        fence = FENCE.match(line)
        if fence and inside and fence[1].startswith(inside[-1][0]) and not fence[2] and not fence[3].strip():
            inside.pop()
        elif fence and not (inside and inside[-1][1]):
            directive = (fence[2] or "").strip("{}")
            is_text = fence[1][0] == ":" or directive in TEXT_DIRECTIVES
            inside.append((fence[1], not is_text))
        elif not (inside and inside[-1][1]) and not re.match(r"^\s*:[a-z-]+:", line):
            kept.append((number, line))
    return kept


TEXT_DIRECTIVES = {
    "admonition", "attention", "caution", "danger", "dropdown", "error", "figure", "glue:figure", "hint", "important",
    "list-table", "margin", "math", "note", "prf:theorem", "seealso", "sidebar", "table", "tip", "topic", "warning",
}  # fmt: skip


def hand_typed(chapter: str) -> list[Finding]:
    r"""Return the matrices, number tables and decimals that stand in a chapter's text as typed.

    A matrix typed in LaTeX, of numbers or of symbols, is a statement that no code has checked, and so is a
    table with two or more numbers in a row and a decimal in a sentence. They are quoted instead: glue them
    (see `bookkit`). Whole numbers in a sentence and names such as ``{glue:text}`reach` `` pass.

    Parameters
    ----------
    chapter : str
        MyST Markdown.

    Returns
    -------
    list of Finding
    """
    found = []
    for number, line in prose(chapter):
        bare = QUOTED.sub("", line)
        cells = [cell.strip().strip("$").strip() for cell in bare.strip().strip("|").split("|")]
        if MATRIX.search(line):
            found.append(Finding(number, "a matrix typed by hand", line.strip()))
        elif "|" in bare and sum(TABLE_NUMBER.fullmatch(cell) is not None for cell in cells) > 1:
            found.append(Finding(number, "a row of numbers typed by hand", line.strip()))
        elif DECIMAL.search(bare):
            found.append(Finding(number, "a decimal typed by hand", line.strip()))
    return found


class _Figures(HTMLParser):
    """Collects pictures that no words stand for."""

    def __init__(self) -> None:
        super().__init__()
        self.silent: list[str] = []
        self.drawings = 0  # open <svg>: what is drawn within a drawing is spoken for by the outer one
        self.unnamed = ""  # the outer drawing, while nothing has said what it shows
        self.describing = False

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        self.handle_endtag(tag)

    def handle_endtag(self, tag: str) -> None:
        self.drawings -= tag == "svg"
        if tag == "svg" and not self.drawings and self.unnamed:
            self.silent.append(self.unnamed)
            self.unnamed = ""
        self.describing = False

    def handle_data(self, data: str) -> None:
        if self.describing and data.strip():
            self.unnamed = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = dict(attrs)
        words = (named.get("alt") or named.get("aria-label") or "").strip()
        decoration = named.get("aria-hidden") == "true"
        looks_generated = re.fullmatch(r"(\.\./)*(_images/)?[0-9a-f]{32,}\S*|\S+\.(png|svg|jpe?g)", words)
        inner = self.drawings > 0
        self.drawings += tag == "svg"
        self.describing = tag == "desc" and self.drawings == 1
        if tag in {"img", "svg", "canvas"} and not inner and not decoration and (not words or looks_generated):
            if tag == "svg":
                self.unnamed = self.get_starttag_text() or tag
            else:
                self.silent.append(self.get_starttag_text() or tag)


def silent_figures(page: str) -> list[str]:
    """Return the start tags of images and drawings of an HTML page that have no words: no alt text, or a file's name.

    A drawing may say in its ``<desc>`` what it shows. Decoration that is marked ``aria-hidden`` passes.
    """
    parser = _Figures()
    parser.feed(page)
    return parser.silent
