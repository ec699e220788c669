"""Exercises and solutions as pages: what to take along stands at their top, and a solution shows the answers alone.

The figure, which a notebook carries as a picture of its own, stands in the page itself, in the page's colours.

The notebooks of the exercises and the wheel of the library that checks them are served beside the pages. The wheel is
built from the folder that the book is built from, so that an edition without references has a wheel without them.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tomllib
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from docutils import nodes
from formulas import ROOT
from keeping import Keeper
from sphinx.errors import ExtensionError

from dhlib.errors import DHError
from dhlib.grading.course.editions import HOW
from dhlib.grading.derive import close_regions
from dhlib.grading.pictures import FIGURE, read_cell

sys.path.append(str(ROOT / "book"))
from bookkit.figures import inline_svg

if TYPE_CHECKING:
    from sphinx.application import Sphinx

EXERCISES, SOLUTIONS = "exercises/", "solutions/"
NOTEBOOKS, LIBRARY = "notebooks/exercises", "library"


#: What goes into the wheel beside what pyproject.toml includes.
BESIDES = ("pyproject.toml", "README.md", "LICENSE")


def files_of_wheel(source: Path) -> list[Path]:
    """Return the files that the wheel of a folder is made of."""
    project = tomllib.loads((source / "pyproject.toml").read_text("utf-8"))
    included = project["tool"]["hatch"]["build"]["targets"]["wheel"]["include"]
    found = [path for pattern in (*BESIDES, *included) for path in source.glob(pattern.removeprefix("/"))]
    files = {file for path in found for file in (path.rglob("*") if path.is_dir() else [path]) if file.is_file()}
    return sorted(file for file in files if file.suffix != ".pyc")


def library_wheel(source: Path, keeper: Keeper) -> Path | None:
    """Return the wheel of the library of a folder; None where the folder holds pages alone."""
    if not (source / "pyproject.toml").is_file():
        return None
    files = files_of_wheel(source)
    names = "\n".join(path.relative_to(source).as_posix() for path in files)
    folder = keeper.made("wheel", lambda into: build_wheel(source, into), names, *files, Path(__file__))
    (wheel,) = folder.glob("*.whl")
    return wheel


def build_wheel(source: Path, into: Path) -> None:
    """Build the wheel of a folder."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(into)]
    done = subprocess.run(command, cwd=source, capture_output=True, text=True, check=False)
    if done.returncode:
        raise ExtensionError(f"the wheel of the library cannot be built: {done.stderr.strip()}")


def show_solution(app: Sphinx, docname: str, source: list[str]) -> None:
    """Leave out of a solution what is for whoever works on the exercise: the stubs, and how to hand in."""
    if not docname.startswith(SOLUTIONS):
        return
    notebook = json.loads(source[0])
    cells = [cell for cell in notebook["cells"] if cell["metadata"].get("dh", {}).get("part") != HOW]
    for cell in cells:
        text = "".join(cell["source"])
        if cell["cell_type"] == "code":
            text = close_regions(text)
        elif cell is cells[0]:
            text = re.sub(r"\A# ", "# Solution: ", text)
        cell["source"] = text.splitlines(keepends=True)
    source[0] = json.dumps({**notebook, "cells": cells})


def draw_figure(app: Sphinx, docname: str, source: list[str]) -> None:
    """Put the figure into the page: as an image of its own it would not take the colours of a dark page."""
    if not docname.startswith((EXERCISES, SOLUTIONS)):
        return
    notebook = json.loads(source[0])
    for cell in notebook["cells"]:
        if cell["cell_type"] == "markdown" and cell["metadata"].get("dh", {}).get("part") == FIGURE:
            try:
                svg, alt, caption = read_cell("".join(cell["source"]))
            except DHError as error:
                raise ExtensionError(f"{docname}: {error}") from None
            drawing = inline_svg(svg, alt)
            told = f'<figcaption><p><span class="caption-text">{escape(caption)}</span></p></figcaption>'
            cell["source"] = f'```{{raw}} html\n<figure class="align-default">{drawing}{told}</figure>\n```'
    source[0] = json.dumps(notebook)


def offer(app: Sphinx, doctree: nodes.document) -> None:
    """Put below the title what to take along, or which exercise a solution is of."""
    docname = app.env.docname
    folder, _, name = docname.rpartition("/")
    title = next(doctree.findall(nodes.title), None)
    if f"{folder}/" not in (EXERCISES, SOLUTIONS) or title is None:
        return
    if f"{folder}/" == SOLUTIONS:
        html = f'The worked solution of <a href="../{EXERCISES}{name}.html">the exercise</a>, with all that it prints.'
    else:
        wheel = getattr(app, "dh_wheel", None)
        links = [f'<a href="../{NOTEBOOKS}/{name}.ipynb" download>the notebook</a>']
        if wheel:
            links.append(f'<a href="../{LIBRARY}/{escape(wheel.name)}" download>the library</a>')
        solution = f"{SOLUTIONS}{name}"
        html = f"Take along: {' and '.join(links)}."
        if solution in app.env.found_docs:
            html += f' When you are done: <a href="../{solution}.html">the solution</a>.'
    title.parent.insert(
        title.parent.index(title) + 1, nodes.raw("", f'<p class="take-along">{html}</p>', format="html")
    )


def prepare(app: Sphinx) -> None:
    """Build the wheel before the pages that name it."""
    app.dh_wheel = library_wheel(Path(app.srcdir), app.keeper)  # type: ignore[attr-defined]


def serve(app: Sphinx, exception: Exception | None) -> None:
    """Copy notebooks and wheel into the site, and nothing of earlier builds."""
    site = Path(app.outdir)
    wheel: Path | None = getattr(app, "dh_wheel", None)
    if exception is None and app.builder.name == "html":
        for folder in (NOTEBOOKS, LIBRARY):
            shutil.rmtree(site / folder, ignore_errors=True)
        named = sorted(docname for docname in app.env.found_docs if docname.startswith(EXERCISES))
        if named:
            (site / NOTEBOOKS).mkdir(parents=True)
        for docname in named:
            shutil.copyfile(Path(app.srcdir) / f"{docname}.ipynb", site / NOTEBOOKS / f"{Path(docname).name}.ipynb")
        if wheel:
            (site / LIBRARY).mkdir()
            shutil.copyfile(wheel, site / LIBRARY / wheel.name)


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("builder-inited", prepare)
    app.connect("source-read", show_solution)
    app.connect("source-read", draw_figure)
    app.connect("doctree-read", offer, priority=400)
    app.connect("build-finished", serve, priority=650)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
