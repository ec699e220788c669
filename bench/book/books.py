"""The chapters of the book twice: as we build them, and as a plain Jupyter Book of the same text and code.

The plain one has the default theme and configuration: chapters executed one after the other and cached, MathJax and
other scripts from the hosts that Jupyter Book names. What it does not know, our questions and live figures, is taken
out of its text, and so it has less to show.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).parents[1]))

from environment import ENVIRONMENTS, ROOT, size

BOOKS = ENVIRONMENTS / "books"
#: A block of a directive of ours, from fence to fence.
OURS_ONLY = re.compile(r"^(`{3,})\{dh-[a-z]+\}.*?^\1[ \t]*$\n?", re.DOTALL | re.MULTILINE)
PLAIN_CONFIG = {
    "title": "The DH book, plain",
    "only_build_toc_files": True,
    "execute": {"execute_notebooks": "cache", "timeout": 120},
    "parse": {
        "myst_enable_extensions": ["amsmath", "attrs_block", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
    },
    "bibtex_bibfiles": ["book/references.bib"],
}


def chapters() -> list[str]:
    """Return the front page and the chapters, as the table of contents lists them."""
    toc = yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))
    (part,) = (part for part in toc["parts"] if part["caption"] == "Chapters")
    found = [toc["root"], *(chapter["file"] for chapter in part["chapters"])]
    return found[: size(len(found), 3)]


def contents() -> str:
    """Return a table of contents of the chapters alone."""
    root, *others = chapters()
    return yaml.safe_dump({"format": "jb-book", "root": root, "chapters": [{"file": name} for name in others]})


def ours(name: str = "ours") -> Path:
    """Lay out our book of the chapters alone."""
    folder = fresh(name)
    ignore = shutil.ignore_patterns("__pycache__", "node_modules")
    for name in ("dhlib", "book", "exercises", "solutions", "requirements", "bench"):
        shutil.copytree(ROOT / name, folder / name, ignore=ignore)
    shutil.copy(ROOT / "package-lock.json", folder)
    config = yaml.safe_load((ROOT / "_config.yml").read_text("utf-8"))
    # Links out of the chapters draw warnings here, after which our own builds start from the sources again.
    config["sphinx"]["config"]["extensions"].remove("nothing_stale")
    (folder / "_config.yml").write_text(yaml.safe_dump(config, allow_unicode=True), encoding="utf-8")
    for name in ("node_modules", ".tools"):
        (folder / name).symlink_to((ROOT / name).resolve())
    (folder / "_toc.yml").write_text(contents(), encoding="utf-8")
    return folder


def plain() -> Path:
    """Lay out the plain book."""
    folder = fresh("plain")
    for name in chapters():
        target = folder / f"{name}.md"
        target.parent.mkdir(exist_ok=True)
        target.write_text(OURS_ONLY.sub("", (ROOT / f"{name}.md").read_text("utf-8")), encoding="utf-8")
    for name in ("references.bib", "images"):
        source = ROOT / "book" / name
        (shutil.copytree if source.is_dir() else shutil.copy)(source, folder / "book" / name)
    (folder / "_config.yml").write_text(yaml.safe_dump(PLAIN_CONFIG), encoding="utf-8")
    (folder / "_toc.yml").write_text(contents(), encoding="utf-8")
    return folder


def fresh(name: str) -> Path:
    """Return an empty folder."""
    folder = BOOKS / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


def build(folder: Path) -> str:
    """Build a book with `jupyter-book build`; return what it says.

    Raises
    ------
    SystemExit
        If it cannot be built.
    """
    words = [sys.executable, "-c", "from jupyter_book.cli.main import main; main()", "build", str(folder)]
    # Chapters import what the book brings along; nothing else of ours is on the path of the plain one.
    surroundings = os.environ | {"NO_COLOR": "1", "PYTHONPATH": os.pathsep.join([str(ROOT / "book"), str(ROOT)])}
    if (wheels := ROOT.parent / "shared" / "wasm").is_dir():  # where the book itself finds numpy for the browser
        surroundings.setdefault("DHBOOK_WHEELS", str(wheels))
    said = subprocess.run(
        words,
        cwd=folder,
        env=surroundings,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )
    if said.returncode:
        raise SystemExit(f"{folder} does not build:\n{said.stdout[-3000:]}")
    return said.stdout


def site_of(folder: Path) -> Path:
    """Return where the pages are."""
    return folder / "_build" / "html"
