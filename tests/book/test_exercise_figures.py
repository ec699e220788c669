"""Each exercise is a page with a figure, drawn into the page, that says what to see."""

from __future__ import annotations

import html
import json
import re
from pathlib import Path

import pytest

from dhlib.grading.pictures import FIGURE, read_cell

pytestmark = pytest.mark.book

NAMES = sorted(path.stem for path in Path(__file__).parents[2].glob("exercises/*.ipynb"))


def figures(page: str) -> list[tuple[str, str]]:
    """What each figure of a page says in place of its picture, and its caption."""
    found = re.findall(r"<figure\b[^>]*>\s*(<svg.*?</svg>)\s*<figcaption>(.*?)</figcaption>", page, re.DOTALL)
    told = []
    for svg, caption in found:
        label = re.match(r'<svg[^>]* role="img"[^>]* aria-label="([^"]+)"', svg)
        if label and "var(--dh-x)" in svg and "var(--dh-ink)" in svg and not re.search(r"#[0-9a-f]{6}\b", svg):
            told.append((html.unescape(label[1]), html.unescape(re.sub(r"<[^>]*>", "", caption))))
    return told


def figure_of(path: Path) -> tuple[str, str]:
    """The words of the figure in a notebook."""
    cells = json.loads(path.read_text("utf-8"))["cells"]
    source = next("".join(cell["source"]) for cell in cells if cell["metadata"]["dh"].get("part") == FIGURE)
    return read_cell(source)[1:]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("folder", ["exercises", "solutions"])
def test_the_page_has_the_figure_of_its_notebook(site: Path, root: Path, folder: str, name: str) -> None:
    page = (site / folder / f"{name}.html").read_text("utf-8")
    assert figures(page) == [figure_of(root / "exercises" / f"{name}.ipynb")]
    assert "data:image/svg" not in page
    assert figure_of(site / "notebooks" / "exercises" / f"{name}.ipynb") == figure_of(
        root / "exercises" / f"{name}.ipynb"
    )


def test_a_page_without_its_figure_or_its_words_would_be_seen(site: Path) -> None:
    """Negative control."""
    page = (site / "exercises" / "stanford.html").read_text("utf-8")
    assert len(figures(page)) == 1
    assert figures(re.sub(r"<figure\b.*?</figure>", "", page, flags=re.DOTALL)) == []
    assert figures(page.replace("aria-label=", "title=")) == []
    assert figures(page.replace("var(--dh-x)", "#c43c00")) == []
