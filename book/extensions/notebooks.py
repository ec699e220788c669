"""Give each chapter as a notebook: executed, in plain Markdown, with nothing in it that only the book understands.

A reader who has `dhlib` can run it anywhere. So the book's own helper is taken out of the code: values it put into
the text stand there, figures are attached, and cells that did nothing else are gone. Questions stay, answers do not.
"""

from __future__ import annotations

import ast
import base64
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import nbformat
from nbformat import NotebookNode
from pybtex.database import parse_file
from sphinx.util import logging

from dhlib.palette import LIGHT

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.environment import BuildEnvironment

logger = logging.getLogger(__name__)

HELPER = "bookkit"
FENCE = re.compile(r"^(?P<indent>\s*)(?P<marks>`{3,}|:{3,}|~{3,})(?P<rest>.*)$")
DIRECTIVE = re.compile(r"^\{(?P<name>[\w:-]+)\}\s*(?P<argument>.*)$")
ROLE = re.compile(r"\{(?P<role>[a-z:-]+)\}`(?P<text>[^`]+)`")
LIVE = {"dh-link", "dh-robot", "dh-place"}


# Code


def names_of_helper(trees: list[ast.Module]) -> set[str]:
    """Return the names that cells import from the helper, and of their own functions that use them."""
    nodes = [node for tree in trees for node in ast.walk(tree)]
    names = {
        alias.asname or alias.name
        for node in nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == HELPER
        for alias in node.names
    }
    for node in nodes:
        if isinstance(node, ast.FunctionDef) and loaded(node) & names:
            names.add(node.name)
    return names


class WithoutHelper(ast.NodeTransformer):
    """Takes out the statements that only feed the book's text; blocks that held nothing else go with them."""

    def __init__(self, helpers: set[str]) -> None:
        self.helpers = helpers
        self.gone: list[ast.stmt] = []

    def visit_ImportFrom(self, node: ast.ImportFrom) -> ast.stmt | None:
        """Take out the import of the helper."""
        if (node.module or "").split(".")[0] != HELPER:
            return node
        self.gone.append(node)
        return None

    def visit_Expr(self, node: ast.Expr) -> ast.stmt | None:
        """Take out a call of the helper."""
        call = node.value
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id in self.helpers:
            self.gone.append(node)
            return None
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.stmt | None:
        """Take out a function that uses the helper."""
        if node.name not in self.helpers:
            return node
        self.gone.append(node)
        return None

    def visit_For(self, node: ast.For) -> ast.stmt | None:
        """Take out a loop that is left with nothing to do."""
        before = len(self.gone)
        self.generic_visit(node)
        if node.body:
            return node
        del self.gone[before:]
        self.gone.append(node)
        return None

    visit_If = visit_With = visit_For  # type: ignore[assignment]


def without_lines(source: str, gone: list[ast.stmt]) -> str:
    """Return source without the lines of some statements; comments and blank lines of the rest stay."""
    if not gone:
        return source
    lines: list[str | None] = list(source.split("\n"))
    for node in gone:
        lines[node.lineno - 1 : node.end_lineno] = [None] * (node.end_lineno - node.lineno + 1)  # type: ignore[operator]
    kept = "\n".join(line for line in lines if line is not None)
    return re.sub(r"\n{4,}", "\n\n\n", kept).strip("\n")


def loaded(tree: ast.AST) -> set[str]:
    """Return the names that code reads from around it: a function's own names are its own."""
    if isinstance(tree, ast.FunctionDef | ast.Lambda):
        own = {argument.arg for argument in ast.walk(tree.args) if isinstance(argument, ast.arg)}
        body = tree.body if isinstance(tree, ast.FunctionDef) else [tree.body]
        own |= {name for part in body for name in bound(part)}
        return {name for part in body for name in loaded(part)} - own | loaded(tree.args)
    if isinstance(tree, ast.AugAssign):  # x += 1 reads x too
        return {node.id for node in ast.walk(tree.target) if isinstance(node, ast.Name)} | loaded(tree.value)
    if isinstance(tree, ast.Name):
        return {tree.id} if isinstance(tree.ctx, ast.Load) else set()
    return {name for part in ast.iter_child_nodes(tree) for name in loaded(part)}


def bound(tree: ast.AST) -> set[str]:
    """Return the names that code gives a meaning: by assignment, definition or import."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.alias):
            names.add((node.asname or node.name).split(".")[0])
    return names


def defines(statement: ast.stmt) -> set[str]:
    """Return the names to which a statement gives a new meaning in any case, whatever they meant before."""
    targets = statement.targets if isinstance(statement, ast.Assign) else []
    names = {target.id for target in targets if isinstance(target, ast.Name)}
    return names | (bound(statement) if isinstance(statement, ast.Import | ast.ImportFrom) else set())


def changes(statement: ast.stmt) -> set[str]:
    """Return the names whose objects a statement may change, by a call: ``scene.add_line(…)``, ``draw(scene)``."""
    called = [node for node in ast.walk(statement) if isinstance(node, ast.Call)]
    given = [part for call in called for part in (call.func, *call.args)]
    return {name for part in given if not isinstance(part, ast.Constant) for name in loaded(part)}


def needed_before(statements: list[ast.stmt], needed: set[str]) -> set[str]:
    """Return the names that must have a meaning before some statements, given those needed after them."""
    for statement in reversed(statements):
        needed = (needed - defines(statement)) | loaded(statement)
    return needed


def unneeded(statements: list[ast.stmt], needed: set[str]) -> list[ast.stmt]:
    """Return the statements that nobody below makes use of."""
    gone = []
    for statement in reversed(statements):
        is_call = isinstance(statement, ast.Expr | ast.For | ast.If | ast.With)
        if bound(statement) & needed or (is_call and changes(statement) & needed):
            needed = (needed - defines(statement)) | loaded(statement)
        else:
            gone.append(statement)
    return gone


def plain_sources(cells: list[tuple[str, bool]]) -> list[str]:
    """Return the source of code cells without the helper; empty where a cell is to go.

    Parameters
    ----------
    cells : list of (str, bool)
        The source of each cell, and whether the book hides it altogether. Of a hidden cell only that stays
        which a later one needs.
    """
    trees = [ast.parse(source) for source, _ in cells]
    helpers = names_of_helper(trees)
    plain = []
    for (source, _), tree in zip(cells, trees, strict=True):
        cleaner = WithoutHelper(helpers)
        cleaner.visit(tree)
        plain.append(without_lines(source, cleaner.gone))
    needed: set[str] = set()
    for k in reversed(range(len(cells))):
        if cells[k][1]:
            plain[k] = without_lines(plain[k], unneeded(ast.parse(plain[k]).body, needed))
        tree = ast.parse(plain[k])
        if not tree.body:
            plain[k] = ""
        needed = needed_before(tree.body, needed)
        if left := needed & helpers:
            raise ValueError(f"a downloaded notebook has no {', '.join(sorted(left))}:\n{plain[k]}")
    return plain


# Text


class Text:
    """The text of one chapter in plain Markdown."""

    def __init__(self, env: BuildEnvironment, page: str, glued: dict[str, dict[str, str]]) -> None:
        self.env, self.page, self.glued = env, page, glued
        self.attachments: dict[str, dict[str, str]] = {}
        self.questions = 0
        self.cited: list[str] = []

    def convert(self, source: str) -> str:
        """Return Markdown that needs no directive and no role."""
        return re.sub(r"\n{3,}", "\n\n", "\n".join(self.blocks(source.split("\n")))).strip()

    def blocks(self, lines: list[str]) -> Iterator[str]:
        """Yield the lines, each directive replaced."""
        rest = iter(lines)
        for line in rest:
            fence = FENCE.match(line)
            if not fence:
                if not re.fullmatch(r"\([\w-]+\)=\s*", line):
                    yield self.inline(line)
                continue
            marks, inside = fence["marks"], []
            for below in rest:
                end = FENCE.match(below)
                if end and end["marks"].startswith(marks) and not end["rest"].strip():
                    break
                inside.append(below)
            directive = DIRECTIVE.match(fence["rest"].strip())
            if directive:
                yield from ("", *self.directive(directive["name"], directive["argument"].strip(), inside), "")
            else:
                yield from (line, *inside, fence["indent"] + marks)

    def directive(self, name: str, argument: str, inside: list[str]) -> list[str]:
        """Return what stands for a directive."""
        options = {}
        while inside and (option := re.match(r"^\s*:([\w-]+):\s*(.*)$", inside[0])):
            options[option[1]] = option[2]
            inside = inside[1:]
        if name == "glue:math":
            return self.equation(self.glued[argument]["latex"].strip("$"), options.get("label", ""))
        if name == "math":
            return self.equation("\n".join(inside), options.get("label", ""))
        if name == "glue":
            kept = self.glued[argument]
            return [self.inline(line) for line in kept.get("markdown", kept["plain"]).split("\n")]
        if name == "glue:figure":
            return self.figure(argument, options.get("name", ""), self.convert("\n".join(inside)))
        if name == "bibliography":
            return [f"- {self.work(key)}" for key in sorted(set(self.cited))]
        if name == "dh-question":
            self.questions += 1
            return [f"**Question {self.questions}.** {self.convert(chr(10).join(inside))}"]
        if name in LIVE:
            return ["*(A live figure stands here in the book.)*", "", self.convert("\n".join(inside))]
        text = self.convert("\n".join(inside)).split("\n")
        title = [f"**{self.inline(argument)}**", ""] if argument else []
        return ["> " + line if line else ">" for line in title + text]

    def equation(self, tex: str, label: str) -> list[str]:
        """Return a formula of its own, with its number."""
        tag = rf" \tag{{{self.equation_number(label)}}}" if label else ""
        return ["$$", tex.strip() + tag, "$$"]

    def figure(self, name: str, label: str, caption: str) -> list[str]:
        """Attach a figure; it is drawn in the colours of paper."""
        svg = plain_colours(self.glued[name]["html"])
        file = re.sub(r"\W+", "-", name) + ".svg"
        self.attachments[file] = {"image/svg+xml": base64.b64encode(svg.encode()).decode()}
        alt = re.sub(r"[\[\]\n]", " ", self.glued[name]["plain"])
        number = f"**{self.number('figure', label)}.** " if label else ""
        return [f"![{alt}](attachment:{file})", "", number + caption]

    def inline(self, line: str) -> str:
        """Return a line with each role replaced."""
        line = re.sub(
            r"^\$\$\s*\((?P<label>[\w-]+)\)\s*$",
            lambda m: rf"\tag{{{self.equation_number(m['label'])}}}" + "\n$$",
            line,
        )
        return ROLE.sub(lambda found: self.role(found["role"], found["text"]), line)

    def role(self, role: str, text: str) -> str:
        """Return what stands for a role."""
        titled = re.fullmatch(r"(.*?)\s*<([^>]+)>", text, re.DOTALL)
        words, target = (titled[1], titled[2]) if titled else ("", text)
        answers: dict[str, Callable[[], str]] = {
            "glue:text": lambda: self.glued[text.split(":")[0]]["plain"],
            "glue": lambda: self.glued[text].get("markdown", self.glued[text]["plain"]),
            "eq": lambda: f"({self.equation_number(text)})",
            "numref": lambda: self.number("", target),
            "ref": lambda: words or self.env.domaindata["std"]["labels"][target][2],
            "doc": lambda: words or self.env.titles[str(Path(self.page).parent / target)].astext(),
            "cite:t": lambda: self.cite(text, parenthesised=False),
            "cite:p": lambda: self.cite(text, parenthesised=True),
        }
        return answers[role]() if role in answers else (words or text.lstrip("~"))

    def equation_number(self, label: str) -> str:
        """Return the number of an equation."""
        page, number = self.env.domaindata["math"]["objects"][label]
        of_page = self.env.toc_fignumbers.get(page, {}).get("displaymath", {})
        return ".".join(map(str, of_page.get(f"equation-{label}", (number,))))

    def number(self, kind: str, label: str) -> str:
        """Return a figure's name and number, as in ``Figure 3.1``."""
        page, identity = self.env.domaindata["std"]["anonlabels"][label]
        numbers = self.env.toc_fignumbers.get(page, {})
        for found in [kind] if kind else numbers:
            if identity in numbers.get(found, {}):
                return str(self.env.config.numfig_format[found]) % ".".join(map(str, numbers[found][identity]))
        return str(self.env.domaindata["std"]["labels"].get(label, ("", "", label))[2])

    def cite(self, keys: str, *, parenthesised: bool) -> str:
        """Return authors and year."""
        shown = []
        for key in (key.strip() for key in keys.split(",")):
            self.cited.append(key)
            names = [" ".join(person.last_names) for person in self.works[key].persons["author"]]
            who = names[0] + (" et al." if len(names) > 2 else f" and {names[1]}" if len(names) == 2 else "")
            year = self.works[key].fields.get("year", "n.d.")
            shown.append(f"{who} {year}" if parenthesised else f"{who} ({year})")
        return f"({'; '.join(shown)})" if parenthesised else ", ".join(shown)

    def work(self, key: str) -> str:
        """Return a line of the bibliography."""
        entry = self.works[key]
        names = ", ".join(str(person).replace(",", "") for person in entry.persons.get("author", []))
        where = entry.fields.get("journal") or entry.fields.get("booktitle") or entry.fields.get("publisher", "")
        title, where = (re.sub(r"[{}]", "", words) for words in (entry.fields["title"], where))
        return f"{names} ({entry.fields.get('year', 'n.d.')}). *{title}*. {where}."

    @property
    def works(self) -> Any:
        """The works that the book cites, by key."""
        if not hasattr(self.env.app, "works"):
            (path,) = self.env.config.bibtex_bibfiles
            self.env.app.works = parse_file(str(Path(self.env.srcdir) / path)).entries  # type: ignore[attr-defined]
        return self.env.app.works  # type: ignore[attr-defined]


def plain_colours(svg: str) -> str:
    """Return a drawing that needs no style sheet: in the colours of paper, and with a size."""
    svg = re.sub(r"var\(--dh-([a-z]+)(?:,[^()]*)?\)", lambda found: LIGHT[found[1]], svg)
    return re.sub(r' style="max-width:(\d+)px"', r' width="\1"', svg, count=1)


# Notebooks


def glued_values(path: Path) -> dict[str, dict[str, str]]:
    """Return what the helper kept, by name: its forms ``plain``, ``latex``, ``markdown``, ``html``."""
    kept = json.loads(path.read_text("utf-8")) if path.exists() else {}
    return {
        name: {mime.removeprefix("text/"): value for mime, value in output["data"].items()}
        for name, output in kept.items()
    }


def plain_notebook(notebook: NotebookNode, text: Text) -> NotebookNode:
    """Return a chapter's notebook as a reader may have it."""
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    sources = iter(plain_sources([(cell.source, "remove-cell" in cell.metadata.get("tags", [])) for cell in code]))
    cells: list[NotebookNode] = []
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            source = text.convert(cell.source)
            if source:
                cells.append(nbformat.v4.new_markdown_cell(source))
                if text.attachments:
                    cells[-1].attachments, text.attachments = text.attachments, {}
        elif source := next(sources) if cell.cell_type == "code" else "":
            hidden = {"remove-cell", "remove-input", "hide-input", "hide-cell"} & set(cell.metadata.get("tags", []))
            folded = {"jupyter": {"source_hidden": True}} if hidden else {}
            # What the helper showed is no output of what is left.
            outputs = [o for o in cell.outputs if cell.source == source or o.output_type != "display_data"]
            cells.append(
                nbformat.v4.new_code_cell(
                    source, outputs=outputs, metadata=folded, execution_count=cell.execution_count
                )
            )
    for number, cell in enumerate(cells):
        cell.id = f"cell-{number}"
    metadata = {
        "kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"},
        "language_info": {"name": "python"},
    }
    return nbformat.v4.new_notebook(cells=cells, metadata=metadata)


def address_of(page: str) -> str:
    """Return where the notebook of a page is, in the site."""
    return f"notebooks/{page.rsplit('/', 1)[-1]}.ipynb"


def has_notebook(app: Sphinx, page: str) -> bool:
    """Say whether a page was executed by the book."""
    return bool(app.env.nb_metadata.get(page, {}).get("exec_data"))  # type: ignore[attr-defined]


def offer(app: Sphinx, page: str, _template: str, context: dict[str, Any], _doctree: Any) -> None:
    """Let the download button offer the notebook in place of the source."""
    for button in context.get("header_buttons", []):
        if button["label"] == "download-buttons":
            sources = [b for b in button["buttons"] if b["label"] == "download-source-button"]
            for source in sources:
                if has_notebook(app, page):
                    source.update(
                        url=context["pathto"](address_of(page), 1), text=".ipynb", tooltip="Download this as a notebook"
                    )
                else:
                    button["buttons"].remove(source)


def write_notebooks(app: Sphinx, exception: Exception | None) -> None:
    """Write the notebooks of all chapters into the site."""
    if exception is not None or app.builder.name != "html":
        return
    executed = Path(app.outdir).parent / "jupyter_execute"
    works = max(Path(app.srcdir, name).stat().st_mtime for name in app.config.bibtex_bibfiles)
    wanted = set()
    for page in sorted(page for page in app.env.found_docs if has_notebook(app, page)):
        path = Path(app.outdir) / address_of(page)
        wanted.add(path)
        # Sphinx writes a page again whenever its text, or a number that it names, has changed.
        if page not in app.written_pages and path.exists() and path.stat().st_mtime > works:  # type: ignore[attr-defined]
            continue
        notebook = nbformat.read(executed / f"{page}.ipynb", as_version=4)
        try:
            plain = plain_notebook(notebook, Text(app.env, page, glued_values(executed / f"{page}.glue.json")))
        except (ValueError, KeyError) as fault:
            logger.warning("no notebook to download: %s", fault, location=page)
            wanted.remove(path)
            continue
        path.parent.mkdir(exist_ok=True)
        path.write_text(nbformat.writes(plain), "utf-8")
    for old in set((Path(app.outdir) / "notebooks").glob("*.ipynb")) - wanted:
        old.unlink()


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("html-page-context", offer, priority=900)
    app.connect("build-finished", write_notebooks)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
