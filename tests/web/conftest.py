"""A page with every live figure, built as the book is, for the tests alone."""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from building import build_book
from serve import server
from sources import book_of_one_page

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


@pytest.fixture(scope="session")
def figures(built_once: Callable[..., Path]) -> Path:
    """The folder of the built page."""

    def build(into: Path) -> subprocess.CompletedProcess[str]:
        copy = book_of_one_page(into / "copy", PAGE)
        return build_book(copy, into, environment={"PYTHONPATH": str(copy)})

    return built_once("figures", build)


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
