"""Letters and lines of the figures can be seen: by the colours as rendered, against what lies behind them.

``tests/book/test_colours.py`` holds the palette itself to its ground. Here it is what the drawings make of it: opacity,
mixtures, and lines across links and joints; still figures, and those to move.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sampling import some

pytestmark = [pytest.mark.book, pytest.mark.browser]

ROOT = Path(__file__).parents[2]
LETTERS, LINES = 4.5, 3.0
#: What needs not stand out, by words of its class, and why.
EXEMPT = {
    "b": "the inside of a link, whose edge is drawn",
    "flesh": "the inside of a link, whose edge is drawn",
    "lg": "the ground within the edges of a length",
    "l": "the tint within the edges of a length",
    "wedge": "the tint of an angle, whose arc is drawn",
    "casing": "the ground around a line that crosses others",
    "cap": "the end of a body; it is of the colour of its side, and its rim is drawn",
    "grip": "where a handle can be taken, which is drawn",
    "faint": "where a frame will be, while its ghost is on the way",
    "dull": "the axes of frames that are not being placed",
}
LIVE = ["classic", "placing", "quickshot"]
WITH_FIGURES = sorted(
    path.stem
    for path in (ROOT / "book").glob("*.md")
    if re.search(r"glue_figure|show_figure|\{dh-(link|place|robot)\}", path.read_text("utf-8"))
)
CHOSEN = [*LIVE, *some([name for name in WITH_FIGURES if name not in LIVE], 1)]

MEASURE = """() => {
    const roots = [document, ...[...document.querySelectorAll("dh-link, dh-place, dh-robot")].map(e => e.shadowRoot)];
    const which = root => (root === document ? "svg.dh-figure" : ".stage svg");
    const drawings = roots.flatMap(root => [...root.querySelectorAll(which(root))]);
    return drawings.filter(svg => svg.getClientRects().length).flatMap(svg => contrasts(svg));
}"""
STILL = """.bd-article > section > section { content-visibility: visible !important; }
* { transition: none !important; }"""


@pytest.fixture(scope="module")
def page(browser: Any) -> Iterator[Any]:
    context = browser.new_context(viewport={"width": 1280, "height": 900}, reduced_motion="reduce")
    yield context.new_page()
    context.close()


def open_chapter(page: Any, address: str, chapter: str, theme: str) -> None:
    page.goto(f"{address}/book/{chapter}.html")
    page.add_style_tag(content=STILL)
    page.add_script_tag(path=str(Path(__file__).with_name("contrast.js")))
    page.evaluate("theme => { document.documentElement.dataset.theme = theme; }", theme)
    page.evaluate("dispatchEvent(new HashChangeEvent('hashchange'))")  # and so every figure is alive (near.js)
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def pale(pieces: list[dict[str, Any]]) -> dict[str, float]:
    """What does not stand out enough, and by how little."""
    found = {}
    for piece in pieces:
        exempt = not piece["letters"] and EXEMPT.keys() & set(re.split(r"[. ]", piece["what"]))
        if piece["value"] < (LETTERS if piece["letters"] else LINES) and not exempt:
            found[piece["what"]] = round(piece["value"], 2)
    return found


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("chapter", CHOSEN)
def test_what_is_drawn_stands_out(page: Any, address: str, chapter: str, theme: str) -> None:
    open_chapter(page, address, chapter, theme)
    pieces = page.evaluate(MEASURE)
    assert sum(piece["letters"] for piece in pieces) > 5
    assert sum(not piece["letters"] for piece in pieces) > 10
    assert pale(pieces) == {}


def test_what_does_not_would_be_found(page: Any, address: str) -> None:
    open_chapter(page, address, "classic", "dark")
    page.add_style_tag(content=".dh-figure text { opacity: 0.4; } .dh-figure path.x { stroke-opacity: 0.3; }")
    found = pale(page.evaluate(MEASURE))
    assert "path.x" in found
    assert any(not what.startswith("path") for what in found)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_arm_in_space_stands_out(page: Any, address: str, theme: str) -> None:
    """Half of what three.js draws, at least, by the pixels."""
    open_chapter(page, address, "quickshot", theme)
    arrived = "() => { const arm = document.querySelector('dh-robot'); arm.scrollIntoView(); return arm.space; }"
    page.wait_for_function(arrived, timeout=180_000)
    page.evaluate("document.querySelector('dh-robot').picture.style.visibility = 'hidden'")
    values = arm_against_ground(page.locator("dh-robot .stage").screenshot())
    assert len(values) > 2000
    assert np.median(values) >= LINES
    assert np.median(arm_against_ground(page.locator("dh-robot .matrix").screenshot())) > 1, "any drawing is measured"


def arm_against_ground(picture: bytes) -> np.ndarray:
    """The contrast of each pixel that is not ground, the ground being what there is most of."""
    from matplotlib.image import imread

    pixels = imread(io.BytesIO(picture), format="png")[..., :3].reshape(-1, 3).astype(float)
    linear = np.where(pixels <= 0.04045, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    bright = linear @ [0.2126, 0.7152, 0.0722]
    ground = np.median(bright)
    arm = bright[np.abs(bright - ground) > 0.01]
    high, low = np.maximum(arm, ground), np.minimum(arm, ground)
    return np.asarray((high + 0.05) / (low + 0.05))
