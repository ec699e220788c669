"""What the files of a built site may be."""

from __future__ import annotations

import re
from pathlib import Path

import yaml

import dhlib

OF_SPHINX = {"index.html", "search.html", "genindex.html", "py-modindex.html"}
EXTRAS = {".buildinfo", ".nojekyll", "objects.inv", "searchindex.js", "manifest.webmanifest", "sw.js"}


def listed(root: Path) -> dict[str, Path]:
    """Return the pages in the table of contents, each with its source."""
    names: list[str] = []

    def collect(node: object) -> None:
        if isinstance(node, dict):
            names.extend(value for key, value in node.items() if key in {"root", "file"})
            for value in node.values():
                collect(value)
        elif isinstance(node, list):
            for value in node:
                collect(value)

    collect(yaml.safe_load((root / "_toc.yml").read_text("utf-8")))
    return {name: next(p for p in (root / f"{name}.md", root / f"{name}.ipynb") if p.exists()) for name in names}


def unexpected(files: set[str], pages: dict[str, Path]) -> set[str]:
    """Return the files of a site that nothing accounts for."""
    allowed = {f"{name}.html" for name in pages} | OF_SPHINX | EXTRAS
    allowed |= {f"notebooks/{source.stem}.ipynb" for source in pages.values() if source.parent.name == "book"}
    allowed |= {f"notebooks/{name}.ipynb" for name in pages if name.startswith("exercises/")}
    allowed.add(f"library/dhlib-{dhlib.__version__}-py3-none-any.whl")
    static = re.compile(
        r"_static/.*\.(css|js|svg|png|woff2|LICENSE\.txt)|_images/[\w.-]+\.(svg|png)|_downloads/[0-9a-f]{32}/[\w.-]+"
        r"|live/(link|robot|place|space)\.js|icons/icon(-192\.png|-512\.png|-masked-512\.png|\.svg)"
        r"|run/(cells|editor|exercise|progress)\.js|run/worker\.mjs|run/book\.zip|run/mathjax/[\w/-]+\.js|run/lock-\w+\.json"
        r"|run/(numpy|sympy|mpmath|dhlib)-[\w.-]+\.whl|run/pyodide-[\d.]+/(pyodide\S*\.(mjs|wasm)|python_stdlib\.zip)"
        r"|run/exercises/\w+\.(ipynb|py)"
    )
    return {name for name in files - allowed if not static.fullmatch(name)}


def files_of(site: Path) -> set[str]:
    return {path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()}
