"""A page with every live figure, built as the book is, for the tests alone."""

from __future__ import annotations

import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from building import build_book
from filelock import FileLock
from serve import server

ROOT = Path(__file__).parent.parent.parent

PAGE = """# Live figures

See {numref}`fig-live-link`, {numref}`fig-pa10` and {numref}`fig-quickshot`.

```{dh-link}
:name: fig-live-link
Two frames and the link between them.
```

```{dh-link}
:convention: modified
:index: 2
:reach: 400
:unit: mm
:theta: 30
:d: 120
:a: 250
:alpha: -90
A link of the modified convention, in millimetres.
```

```{dh-robot} pa10_7c
:name: fig-pa10
:elbow:
:q: 0 40 0 70 0 50 0
An arm with seven joints, and its elbow circle.
```

```{dh-robot} stanford
:convention: both
An arm with a prismatic joint, in both conventions.
```

```{dh-place} quickshot
:name: fig-quickshot
Four axes to place frames on.
```

```{dh-place} puma560
:convention: modified
Six axes to place frames on.
```
"""


def lay_out(folder: Path, text: str) -> Path:
    """Lay out a book of one page in a folder, with the extensions and scripts of the book."""
    ignore = shutil.ignore_patterns("__pycache__", ".ipynb_checkpoints", "node_modules")
    for name in ("dhlib", "book", "requirements", "bench"):
        shutil.copytree(ROOT / name, folder / name, ignore=ignore)
    for name in ("_config.yml", "package-lock.json"):
        shutil.copy(ROOT / name, folder)
    for name in ("node_modules", ".tools"):
        if (ROOT / name).exists():
            (folder / name).symlink_to(ROOT / name)
    (folder / "book" / "page.md").write_text(text, "utf-8")
    (folder / "_toc.yml").write_text("format: jb-book\nroot: book/page\n", "utf-8")
    return folder


@pytest.fixture(scope="session")
def figures(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """The folder of the built page: built once, whatever the number of test processes."""
    base = tmp_path_factory.getbasetemp()
    shared = (base if worker_id == "master" else base.parent) / "figures"
    with FileLock(f"{shared}.lock"):
        done = shared / "done"
        if not done.exists():
            shared.mkdir()
            lay_out(shared, PAGE)
            built = build_book(shared, shared, environment={"PYTHONPATH": str(shared)})
            done.write_text(built.stdout if built.returncode else "")
    if failure := done.read_text():
        pytest.fail(f"The page of the figures does not build:\n{failure}")
    return shared / "_build" / "html"


@pytest.fixture(scope="session")
def home(figures: Path) -> Iterator[str]:
    """Where the page is served."""
    httpd = server(figures)
    threading.Thread(target=httpd.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{httpd.server_address[1]}"
    httpd.shutdown()


@pytest.fixture
def page(browser: Any, home: str) -> Iterator[Any]:
    """The page of the figures, in a window of its own where nothing moves by itself."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    page = context.new_page()
    page.goto(f"{home}/book/page.html")
    yield page
    context.close()
