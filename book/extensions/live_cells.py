"""Code that runs where it stands: each code cell of a chapter gets its buttons, and the site the Python they start.

The page itself carries a script of a few kB and, as data, the sources of the cells that nobody sees and others
need, without what only feeds the book's text. All else waits under ``run/`` until a reader presses Run or Edit.
"""

from __future__ import annotations

import ast
import html
import importlib.util
import io
import posixpath
import re
import shutil
import sys
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import nbformat
from docutils import nodes
from formulas import ROOT, node_program
from notebooks import (
    HELPER,
    WithoutHelper,
    bound,
    has_notebook,
    loaded,
    names_of_helper,
    needed_before,
    unneeded,
    without_lines,
)
from scripts import CELLS, WEB, bundle, edition, inline_data
from sphinx.errors import ExtensionError
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

from dhlib.grading.exercise import load_exercise

sys.path.append(str(ROOT / "book" / "build"))
import browser_python

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.config import Config

logger = logging.getLogger(__name__)

FOLDER = "run"
HIDDEN = {"remove-cell", "remove-input"}
PROGRESS = "book/progress"
HONEST = (
    "This page carries what answers are judged by, so that your browser can check them alone. Whoever wants may look; "
    "a course that grades hands out notebooks of its own."
)
#: Modules that a cell may import in the page, beside Python's own.
IN_THE_PAGE = {"numpy", "sympy", "mpmath", "dhlib", "matplotlib", "IPython", HELPER}
#: The tag of cells that need matplotlib, which the reader's browser takes from another host if the reader agrees.
MATPLOTLIB = "mpl"
MATHJAX = ("startup.js", "core.js", "input/tex-base.js", "input/tex/extensions/ams.js", "output/svg.js")
MATHJAX_FONT = "output/svg/fonts/tex.js"


# What the page knows of its cells


def page_sources(cells: list[tuple[str, bool]]) -> tuple[str, list[str]]:
    """Return what is to be imported of the helper, and for each hidden cell what later cells need of it.

    Parameters
    ----------
    cells : list of (str, bool)
        The source of each cell, and whether the book hides its source.

    Returns
    -------
    str, list of str
        Of a cell that is seen, the source as it is; ``""`` for a hidden one that nobody needs.
    """
    trees = [ast.parse(source) for source, _ in cells]
    helpers = names_of_helper(trees)
    origins = {
        alias.asname or alias.name: alias.name
        for tree in trees
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module == HELPER
        for alias in node.names
    }
    sources = [source for source, _ in cells]
    needed: set[str] = set()
    for k in reversed(range(len(cells))):
        tree = trees[k]
        if cells[k][1]:
            # A function of the chapter's own that draws by the helper stays, if a cell that is seen calls it.
            cleaner = WithoutHelper(helpers - (needed - set(origins)))
            cleaner.visit(tree)
            sources[k] = without_lines(sources[k], cleaner.gone)
            sources[k] = without_lines(sources[k], unneeded(ast.parse(sources[k]).body, needed))
            tree = ast.parse(sources[k])
            sources[k] = sources[k] if tree.body else ""
        needed = needed_before(tree.body, needed)
    used = sorted(needed & set(origins))
    names = ", ".join(f"{origins[name]} as {name}" if origins[name] != name else name for name in used)
    return (f"from {HELPER} import {names}" if names else ""), sources


def imported(tree: ast.Module) -> list[str]:
    """Return the modules that code imports."""
    names = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    return names


def draws_with_matplotlib(tree: ast.Module) -> bool:
    """Say whether code imports matplotlib, or what draws with it."""
    return any(name.split(".")[0] == "matplotlib" or name == "dhlib.plot" for name in imported(tree))


def used(tree: ast.Module) -> set[str]:
    """Return the names that a cell reads before it gives them a meaning of its own."""
    names: set[str] = set()
    own: set[str] = set()
    for statement in tree.body:
        inner = {
            name
            for node in ast.walk(statement)
            if isinstance(node, ast.For | ast.comprehension)
            for name in bound(node.target)
        }
        names |= loaded(statement) - own - inner
        own |= bound(statement)
    return names


class Missing:
    """Follows from cell to cell what cannot run in a page: who imports such a module, and who uses what that made."""

    def __init__(self) -> None:
        self.names: dict[str, str] = {}

    def of(self, tree: ast.Module) -> str:
        """Return the module that the next cell needs and the page has not, or ``""``."""
        tops = [name.split(".")[0] for name in imported(tree)]
        absent = [top for top in tops if top not in IN_THE_PAGE and top not in sys.stdlib_module_names]
        absent += [self.names[name] for name in sorted(used(tree) & set(self.names))]
        for name in bound(tree):
            if absent:
                self.names[name] = absent[0]
            else:
                self.names.pop(name, None)
        return absent[0] if absent else ""


def cells_of(app: Sphinx, page: str) -> list[dict[str, Any]]:
    """Return what the page is told of its code cells, in their order; none if none is seen."""
    executed = Path(app.outdir).parent / "jupyter_execute" / f"{page}.ipynb"
    notebook = nbformat.read(executed, as_version=4)
    code = [(k, cell) for k, cell in enumerate(notebook.cells) if cell.cell_type == "code"]
    seen = [not HIDDEN & set(cell.metadata.get("tags", [])) for _, cell in code]
    if not any(seen):
        return []
    prelude, sources = page_sources([(cell.source, not shown) for (_, cell), shown in zip(code, seen, strict=True)])
    cells: list[dict[str, Any]] = [{"k": -1, "source": prelude}] if prelude else []
    missing = Missing()
    for (k, cell), shown, source in zip(code, seen, sources, strict=True):
        if not shown and not source:
            continue
        told: dict[str, Any] = {"k": k} | ({} if shown else {"source": source})
        tree = ast.parse(source)
        if elsewhere := missing.of(tree):
            told["elsewhere"] = elsewhere
        if MATPLOTLIB in cell.metadata.get("tags", []):
            told[MATPLOTLIB] = True
        elif draws_with_matplotlib(tree):
            logger.warning("a cell draws with matplotlib, so it should carry the tag %r:\n%s", MATPLOTLIB, source)
        cells.append(told)
    return cells


def exercise_of(app: Sphinx, page: str) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Return what the page of an exercise is told: its name, parts and points, and its code cells with their roles."""
    notebook = nbformat.read(app.env.doc2path(page), as_version=4)
    name = notebook.metadata.get("dh", {}).get("exercise", "")
    if not name:
        return {}, []
    cells: list[dict[str, Any]] = [
        {"k": k} | {key: cell.metadata["dh"][key] for key in ("role", "part") if key in cell.metadata["dh"]}
        for k, cell in enumerate(notebook.cells)
        if cell.cell_type == "code"
    ]
    told: dict[str, Any] = {"name": name, "title": heading(notebook)}
    if carries_answers(notebook):
        parts = load_exercise(name, ROOT / "exercises").parts
        told["parts"] = [{"id": part.id, "title": part.title, "points": part.points} for part in parts]
        told["honest"] = HONEST
    else:  # what a part is worth is the course's to say
        told["parts"] = [{"id": cell["part"], "points": None} for cell in cells if cell.get("role") == "check"]
    if PROGRESS in app.env.found_docs:
        here = posixpath.dirname(app.builder.get_target_uri(page))
        told["progress"] = posixpath.relpath(app.builder.get_target_uri(PROGRESS), here or ".")
    return told, cells


def heading(notebook: Any) -> str:
    """Return the first heading of a notebook, as text."""
    found = re.search(r"^# (.+)$", "".join(notebook.cells[0].source), re.MULTILINE)
    return found[1].strip() if found else ""


def is_exercise(app: Sphinx, page: str) -> bool:
    """Say whether a page is an exercise to work on."""
    return page.startswith("exercises/") and Path(app.env.doc2path(page)).suffix == ".ipynb"


def carries_answers(notebook: Any) -> bool:
    """Say whether the check of a notebook judges answers, so that the page needs what they are judged by."""
    return any("import checker" in cell.source for cell in notebook.cells if cell.cell_type == "code")


# The page


def add_bars(app: Sphinx, doctree: nodes.document, page: str) -> None:
    """Give each code cell that is seen a place for its buttons, and the page its data and script."""
    if app.builder.format != "html":
        return
    exercise: dict[str, Any] = {}
    if has_notebook(app, page):
        cells = cells_of(app, page)
    elif is_exercise(app, page):
        exercise, cells = exercise_of(app, page)
    else:
        return
    if not cells:
        return
    for container in doctree.findall(nodes.container):
        if container.get("nb_element") == "cell_code":
            index = container["cell_index"]
            place = f'<div class="dh-cell-bar" data-cell="{index}">{cannot_run(cells, index)}</div>'
            for part in list(container.findall(nodes.container)):  # a folded source lies deeper
                if part.get("nb_element") == "cell_code_source":
                    part += nodes.raw("", place, format="html")
    here = posixpath.dirname(app.builder.get_target_uri(page))
    root = posixpath.relpath(FOLDER, here or ".") + "/"
    data: dict[str, Any] = {"name": page, "root": root, "cells": cells, "python": description(app)}
    if exercise:
        data["exercise"] = exercise
        if "honest" in exercise:
            name = f"exercises/{exercise['name']}.py"
            data["python"]["files"] = {f"/home/pyodide/book/{name}": f"{root}{name}?v={app.config.live_cells_edition}"}
        title = next(iter(doctree.findall(nodes.title)), None)
        if title is not None:
            title.parent.insert(1, nodes.raw("", panel(exercise), format="html"))
    add_script(app, doctree, page, "exercise" if exercise else "cells", inline_data("dh-cells", data))


def cannot_run(cells: list[dict[str, Any]], index: int) -> str:
    """Say why a cell cannot run in its page; ``""`` if it can.

    >>> cannot_run([{"k": 3, "elsewhere": "scipy"}, {"k": 4}], 3)
    'This cell needs scipy, which does not run in a page: take the notebook.'
    """
    module = next((cell["elsewhere"] for cell in cells if cell["k"] == index and "elsewhere" in cell), "")
    return f"This cell needs {module}, which does not run in a page: take the notebook." if module else ""


def add_script(app: Sphinx, doctree: nodes.document, page: str, name: str, data: str) -> None:
    """Put a script to the end of a page, behind the data that it reads."""
    here = posixpath.dirname(app.builder.get_target_uri(page))
    address = html.escape(posixpath.relpath(f"{FOLDER}/{name}.js", here or "."))
    script = f'<script defer src="{address}?v={app.config.live_cells_edition}"></script>\n'
    doctree += nodes.raw("", data + script, format="html")


def of(points: float) -> str:
    """Say of how many points none is earned yet, as ``points.js`` says it."""
    return f"0 of {points:g} {'point' if points == 1 else 'points'}"


def panel(exercise: dict[str, Any]) -> str:
    """Return what stands above an exercise, as it is before the script of the page fills it: so nothing shifts."""
    points = [part["points"] for part in exercise["parts"]]
    earned = "" if None in points else f"{of(sum(points))} here"
    written = f'<span role="status">{earned}</span> <button type="button" disabled>Save as notebook</button>'
    if "progress" in exercise:
        written += f' <a href="{html.escape(exercise["progress"])}">All exercises</a>'
    if "honest" in exercise:
        written += f'<p class="dh-honest">{exercise["honest"]}</p>'
    return f'<div class="dh-part dh-all">{written}</div>'


class progress(nodes.General, nodes.Element):  # type: ignore[misc]
    """The reader's points in all exercises, with what to press to keep them elsewhere."""


class ProgressDirective(SphinxDirective):
    """Puts `progress` into the page; what fills it is written when all exercises are known."""

    def run(self) -> list[nodes.Node]:
        """Return the place."""
        return [progress()]


def progress_html(exercises: list[dict[str, Any]]) -> str:
    """Return the points of all exercises, none earned yet, and what to press once the script is there."""
    rows = ""
    for told in exercises:
        title, every = html.escape(told["title"]), of(points := sum(part["points"] for part in told["parts"]))
        rows += (
            f'<tr><th scope="row"><a href="{html.escape(told["address"])}">{title}</a></th>'
            f"<td>0 of {len(told['parts'])}</td><td>{every}</td>"
            f'<td><progress max="{points:g}" value="0" aria-label="{title}: {every}"></progress></td></tr>'
        )
    heads = "".join(f'<th scope="col">{text}</th>' for text in ("Exercise", "Parts done", "Points"))
    return (
        '<div class="dh-progress"><div class="pst-scrollable-table-container"><table class="table">'
        f"<thead><tr>{heads}<td></td></tr></thead><tbody>{rows}</tbody></table></div>"
        '<div class="dh-buttons"><button type="button" disabled>Save as a file</button>'
        '<label for="dh-progress-file">Take from a file:</label>'
        '<input type="file" accept="application/json,.json" id="dh-progress-file" class="dh-file" disabled>'
        '<button type="button" disabled>Forget all</button></div><p role="status"></p></div>'
    )


def add_progress(app: Sphinx, doctree: nodes.document, page: str) -> None:
    """Tell the page of progress which exercises there are."""
    places = list(doctree.findall(progress))
    if app.builder.format != "html" or not places:
        for place in places:
            place.parent.remove(place)
        return
    here = posixpath.dirname(app.builder.get_target_uri(page))
    exercises = []
    for other in app.env.collect_relations():  # in the order of the book
        if is_exercise(app, other):
            told, _ = exercise_of(app, other)
            if "honest" in told:
                address = posixpath.relpath(app.builder.get_target_uri(other), here or ".")
                exercises.append({key: told[key] for key in ("name", "title", "parts")} | {"address": address})
    for place in places:
        place.replace_self(nodes.raw("", progress_html(exercises), format="html"))
    add_script(app, doctree, page, "progress", inline_data("dh-exercises", exercises))


def add_sidebar(app: Sphinx, _config: Config) -> None:
    """Give every page the script that shows points in the sidebar."""
    app.add_js_file(None, body=(CELLS / "sidebar.js").read_text("utf-8"))


def description(app: Sphinx) -> dict[str, Any]:
    """Return what the page needs to start Python."""
    version = app.config.live_cells_edition
    return the_distribution(app).description | {
        "worker": f"worker.mjs?v={version}",
        "book": f"book.zip?v={version}",
        "elsewhere": browser_python.cdn_address(),
        "files": {},
        "imports": "import numpy, dhlib",
    }


def the_distribution(app: Sphinx) -> browser_python.Distribution:
    """Return the Python of this build, made once."""
    if not hasattr(app, "browser_python"):
        try:
            app.browser_python = browser_python.distribution(node_program())  # type: ignore[attr-defined]
        except browser_python.NoInterpreter as fault:
            raise ExtensionError(str(fault)) from fault
    return app.browser_python  # type: ignore[attr-defined,no-any-return]


def name_edition(_app: Sphinx, config: Config) -> None:
    """Name the content of all that the pages load: when it changes, every page is written anew."""
    folders = (CELLS, WEB, ROOT / "book" / "bookkit", ROOT / "dhlib", ROOT / "exercises")
    files = [path for folder in folders for path in folder.rglob("*") if path.suffix in {".js", ".mjs", ".py"}]
    config["live_cells_edition"] = edition(files)


# The site


def write_site(app: Sphinx, exception: Exception | None) -> None:
    """Write what Run and Edit load into the site."""
    if exception is not None or app.builder.name != "html":
        return
    folder = Path(app.outdir) / FOLDER
    if not any('id="dh-cells"' in page.read_text("utf-8") for page in Path(app.outdir).rglob("*.html")):
        shutil.rmtree(folder, ignore_errors=True)
        return
    folder.mkdir(exist_ok=True)
    found = the_distribution(app)
    found.write(folder)
    logger.info("── %s", found.numpy_from, color=None if "NOT SERVED" not in found.numpy_from else "red")
    (folder / "book.zip").write_bytes(book_archive())
    shutil.copyfile(CELLS / "worker.mjs", folder / "worker.mjs")
    for name in (*MATHJAX, MATHJAX_FONT):
        target = folder / "mathjax" / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / "node_modules" / "mathjax" / "es5" / name, target)
    write_exercises(app, folder / "exercises")
    bundle(folder, [f"cells/{name}" for name in ("cells", "editor", "exercise", "progress")])


def write_exercises(app: Sphinx, into: Path) -> None:
    """Write the notebooks of the exercises, to be saved with answers, and what their pages judge answers by."""
    shutil.rmtree(into, ignore_errors=True)
    for page in sorted(app.env.found_docs):
        source = Path(app.env.doc2path(page))
        if is_exercise(app, page):
            into.mkdir(exist_ok=True)
            shutil.copyfile(source, into / source.name)
            if carries_answers(nbformat.read(source, as_version=4)):
                shutil.copyfile(ROOT / "exercises" / f"{source.stem}.py", into / f"{source.stem}.py")


def book_archive() -> bytes:
    """Return what a page's Python has of the book: the chapters' helper, the kernel, and how IPython writes values."""
    found = importlib.util.find_spec("IPython.lib.pretty")
    assert found is not None
    assert found.origin is not None
    files = {f"{HELPER}/{path.name}": path for path in sorted((ROOT / "book" / HELPER).glob("*.py"))}
    files |= {
        "style/colours.css": ROOT / "book" / "style" / "colours.css",
        "live/kernel.py": CELLS / "kernel.py",
        "live/IPython/display.py": CELLS / "display.py",
        "live/IPython/lib/pretty.py": Path(found.origin),
    }
    written = io.BytesIO()
    with zipfile.ZipFile(written, "w", zipfile.ZIP_DEFLATED) as archive:
        contents = {name: path.read_bytes() for name, path in files.items()}
        for name in ("live/IPython/__init__.py", "live/IPython/lib/__init__.py"):
            contents[name] = b""
        for name in sorted(contents):
            archive.writestr(zipfile.ZipInfo(name, browser_python.MOMENT), contents[name])
    return written.getvalue()


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.add_config_value("live_cells_edition", "", "html")
    app.add_node(progress)
    app.add_directive("dh-progress", ProgressDirective)
    app.connect("config-inited", name_edition)
    app.connect("config-inited", add_sidebar)
    app.connect("doctree-resolved", add_bars)
    app.connect("doctree-resolved", add_progress)
    app.connect("build-finished", write_site)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
