"""Code that runs in the page: ours beside JupyterLite with the same cell, from opening the page to its output.

``python live.py`` in the book's own environment prints one JSON object. Both are served from this machine to a browser
with an empty cache, and both get the same interpreter: Pyodide as npm has it, with the same wheels of numpy, sympy and
dhlib. What JupyterLite's kernel needs besides is fetched from the package index, in the versions of Pyodide's lock.
"""

from __future__ import annotations

import functools
import gzip
import hashlib
import http.server
import json
import re
import shutil
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "book" / "build"))

import books
import chromium
from environment import NotToBeHad, python_of, size, version_of
from playwright.sync_api import Page, sync_playwright
from serve import Quiet

ROUNDS = size(3, 1)
PATIENCE = 300_000
CELL = (
    "import numpy as np\nfrom dhlib import robots\n\n"
    "hand = robots.puma560().fk(np.zeros(6))[:3, 3]\n"
    "print('hand at', *np.round(hand, 3), 'once' if 'seen' not in globals() else 'again')\n"
    "seen = True"
)
ONCE, AGAIN = "once", "again"
PAGE = f"""---
file_format: mystnb
kernelspec: {{name: python3, display_name: Python 3}}
---
# A cell

```{{code-cell}}
{CELL}
```
"""
#: What JupyterLite's kernel loads before it runs anything, and what that needs.
KERNEL = [
    "micropip", "packaging", "ipython", "jedi", "parso", "traitlets", "decorator", "pygments", "prompt_toolkit",
    "wcwidth", "matplotlib-inline", "stack-data", "executing", "asttokens", "pure-eval", "six", "pyodide-http",
    "typing-extensions", "ipython-pygments-lexers",
]  # fmt: skip

#: The same, of what is not in Pyodide's distribution.
BESIDES = {"comm": "0.2.3"}


class Counting(http.server.ThreadingHTTPServer):
    """Counts what it sends: a browser does not tell what its workers fetch."""

    sent = 0


class Compressing(Quiet):
    """Serves as a host of static pages does: compressed."""

    server: Counting

    def do_GET(self) -> None:
        """Send a file."""
        path = Path(self.translate_path(self.path))
        path = path / "index.html" if path.is_dir() else path
        if not path.is_file():
            self.send_error(404)
            return
        content = gzip.compress(path.read_bytes(), 6)
        self.send_response(200)
        for name, value in {
            "Content-Type": self.guess_type(str(path)),
            "Content-Encoding": "gzip",
            "Content-Length": str(len(content)),
        }.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)
        self.server.sent += len(content)


@contextmanager
def served(folder: Path) -> Iterator[Counting]:
    """Serve a folder."""
    httpd = Counting(("127.0.0.1", 0), functools.partial(Compressing, directory=str(folder)))
    threading.Thread(target=httpd.serve_forever, daemon=True).start()
    yield httpd
    httpd.shutdown()


def our_site() -> Path:
    """Build a page with the cell."""
    folder = books.ours("live")
    (folder / "book" / "cell.md").write_text(PAGE, encoding="utf-8")
    (folder / "_toc.yml").write_text("format: jb-book\nroot: book/cell\n", encoding="utf-8")
    books.build(folder)
    return books.site_of(folder)


def lite_site(ours: Path) -> Path:
    """Build JupyterLite with a notebook of the cell, and our interpreter.

    Raises
    ------
    NotToBeHad
        If it cannot be built.
    """
    home = python_of("jupyterlite").parent
    folder = books.fresh("lite")
    interpreter = folder / "files" / "pyodide"
    (source,) = (ours / "run").glob("pyodide-*/")
    shutil.copytree(source, interpreter)
    for wheel in (ours / "run").rglob("*.whl"):
        shutil.copy(wheel, interpreter)
    (lock,) = (ours / "run").glob("lock-*.json")
    packages = lite_packages(json.loads(lock.read_text("utf-8")), interpreter)
    (interpreter / "pyodide-lock.json").write_text(json.dumps(packages), encoding="utf-8")
    kernel = {"pyodideUrl": "./files/pyodide/pyodide.mjs"}
    settings = {"litePluginSettings": {"@jupyterlite/pyodide-kernel-extension:kernel": kernel}}
    (folder / "jupyter-lite.json").write_text(
        json.dumps({"jupyter-lite-schema-version": 0, "jupyter-config-data": settings})
    )
    cell = {"cell_type": "code", "id": "one", "metadata": {}, "execution_count": None, "outputs": [], "source": CELL}
    spec = {"name": "python", "display_name": "Python (Pyodide)", "language": "python"}
    notebook = {"cells": [cell], "metadata": {"kernelspec": spec}, "nbformat": 4, "nbformat_minor": 5}
    contents = folder / "contents"
    contents.mkdir()
    (contents / "cell.ipynb").write_text(json.dumps(notebook))
    words = ["lite", "build", "--contents", "contents", "--output-dir", "site", "--apps", "notebooks", "--apps", "lab"]
    said = subprocess.run([home / "jupyter", *words], cwd=folder, capture_output=True, text=True, check=False)
    if said.returncode:
        raise NotToBeHad(f"jupyter lite build: {said.stderr.strip().splitlines()[-1][:200]}")
    shutil.copytree(interpreter, folder / "site" / "files" / "pyodide", dirs_exist_ok=True)
    return folder / "site"


def lite_packages(ours: dict[str, Any], into: Path) -> dict[str, Any]:
    """Fetch what the kernel needs, in Pyodide's versions; return the lock of all.

    Raises
    ------
    NotToBeHad
        If a package is not on the index in that version.
    """
    lock = json.loads((books.ROOT / "node_modules" / "pyodide" / "pyodide-lock.json").read_text("utf-8"))
    theirs = {canonical(name): entry for name, entry in lock["packages"].items()}
    packages = {name: entry for name, entry in ours["packages"].items() if "/" not in entry["file_name"]}
    for name, version in BESIDES.items():
        entry = {"name": name, "version": version, "depends": [], "imports": [name], "install_dir": "site"}
        theirs[name] = entry | {"package_type": "package", "unvendored_tests": False}
    waiting = [name for name in map(canonical, [*KERNEL, *BESIDES]) if name in theirs]
    while waiting:
        name = canonical(waiting.pop())
        if name in packages:
            continue
        entry = dict(theirs[name])
        waiting += entry["depends"]
        before = set(into.iterdir())
        words = ["download", "--quiet", "--no-deps", "--only-binary", ":all:", "--python-version", "3.14"]
        said = subprocess.run(
            [
                python_of("jupyterlite"),
                "-m",
                "pip",
                *words,
                "--dest",
                str(into),
                f"{entry['name']}=={entry['version']}",
            ],
            capture_output=True,
            text=True,
            check=False,
        )
        new = set(into.iterdir()) - before
        if said.returncode or len(new) != 1:
            raise NotToBeHad(f"{name} {entry['version']} is not on the package index")
        (file,) = new
        entry |= {"file_name": file.name, "sha256": hashlib.sha256(file.read_bytes()).hexdigest()}
        packages[name] = entry
    return {"info": ours["info"], "packages": packages}


def canonical(name: str) -> str:
    """The name of a distribution as indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def run_ours(page: Page, again: bool) -> None:
    """Press Run."""
    page.get_by_role("button", name="Run cell 1", exact=True).click()
    wait_for(page, ".dh-fresh", AGAIN if again else ONCE)


def run_lite(page: Page, again: bool) -> None:
    """Select the cell and run it, as its menu and its keys do."""
    cell = page.locator(".jp-CodeCell").first
    cell.locator(".cm-content").click()
    page.keyboard.press("Control+Enter")
    wait_for(page, ".jp-OutputArea-output", AGAIN if again else ONCE)


def wait_for(page: Page, selector: str, word: str) -> None:
    """Wait for an output that ends with a word."""
    page.wait_for_function(
        "([selector, word]) => [...document.querySelectorAll(selector)].some(e => e.innerText.trim().endsWith(word))",
        arg=[selector, word],
        timeout=PATIENCE,
    )


def opened(browser: Any, server: Counting, path: str, run: Callable[[Page, bool], None]) -> dict[str, float]:
    """Open a page with an empty cache, run the cell, and run it again."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    page = context.new_page()
    page.set_default_timeout(PATIENCE)
    begin = time.perf_counter()
    page.goto(f"http://127.0.0.1:{server.server_address[1]}{path}")
    run(page, False)
    first, sent = time.perf_counter() - begin, server.sent
    begin = time.perf_counter()
    run(page, True)
    following = time.perf_counter() - begin
    context.close()
    return {"first": first, "next": following, "bytes": sent}


def main() -> None:
    """Open both by turns."""
    missing, ways = {}, {}
    ours = our_site()
    ways["dhlib"] = ("a page of the book", ours, "/book/cell.html", run_ours)
    versions = {}
    try:
        ways["jupyterlite"] = (
            "a notebook of its own",
            lite_site(ours),
            "/notebooks/index.html?path=cell.ipynb",
            run_lite,
        )
        versions["jupyterlite"] = version_of(python_of("jupyterlite"), "jupyterlite-core")
    except NotToBeHad as why:
        missing["jupyterlite"] = str(why)
    runs: dict[str, list[dict[str, float]]] = {who: [] for who in ways}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium.find(), args=["--no-sandbox"])
        for _ in range(ROUNDS):
            for who, (_, folder, path, run) in ways.items():
                if who in missing:
                    continue
                print(f"  live: {who}", file=sys.stderr, flush=True)
                with served(folder) as server:
                    try:
                        runs[who].append(opened(browser, server, path, run))
                    except Exception as why:  # whatever a peer's page does must not lose ours
                        if who == "dhlib":
                            raise
                        missing[who] = f"its cell gave no output: {str(why).splitlines()[0][:150]}"
        browser.close()
    rows = [
        {"peer": who, "call": ways[who][0], **{what: median(run[what] for run in taken) for what in taken[0]}}
        for who, taken in runs.items()
        if taken and who not in missing
    ]
    json.dump({"rows": rows, "missing": missing, "versions": versions}, sys.stdout)


if __name__ == "__main__":
    main()
