"""A printed page has no controls: nothing to press, to open or to fill in but the fields of questions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from building import pages_of
from sampling import some

pytestmark = [pytest.mark.book, pytest.mark.browser]

CONTROLS = """() => {
    const found = [];
    const seen = element => element.checkVisibility({ visibilityProperty: true, opacityProperty: true }) &&
        element.getBoundingClientRect().width > 1 && element.getBoundingClientRect().height > 1;
    const look = (root) => {
        for (const element of root.querySelectorAll("*")) {
            if (element.shadowRoot) look(element.shadowRoot);
            const control = element.matches("button, input, select, textarea, summary, .btn, [role=button]");
            const answered = element.closest(".dh-question") && element.matches("input");
            const titled = element.matches("details[open] > summary");
            if (control && !answered && !titled && seen(element)) found.push(element.outerHTML.slice(0, 120));
        }
    };
    look(document);
    return found;
}"""
#: One of each kind of page; of the rest some. The first only leads on, and nobody prints where to search.
NOT_PRINTED = {"index.html", "search.html"}
KINDS = (
    "book/index.html",
    "book/cheatsheet.html",
    "book/placing.html",
    "book/progress.html",
    "book/quickshot.html",
    "exercises/one_link.html",
)


def controls(browser: Any, address: str, name: str, medium: str) -> list[str]:
    """The controls that a page shows on paper or on a screen, all that starts late included."""
    page = browser.new_page(viewport={"width": 800, "height": 1100})
    page.goto(f"{address}/{name}")
    page.evaluate("document.documentElement.classList.add('whole')")
    page.evaluate("window.scrollTo(0, document.body.scrollHeight)")
    page.wait_for_timeout(200)
    page.emulate_media(media=medium)
    found = page.evaluate(CONTROLS)
    page.close()
    return list(found)


def test_paper_has_no_controls(browser: Any, site: Path, address: str) -> None:
    others = [name for name in pages_of(site) if name not in {*NOT_PRINTED, *KINDS}]
    names = [*KINDS, *some(others, 1, "print")]
    assert {name: found for name in names if (found := controls(browser, address, name, "print"))} == {}


@pytest.mark.parametrize("name", ["book/progress.html", "exercises/one_link.html"])
def test_a_control_would_be_found(browser: Any, address: str, name: str) -> None:
    assert len(controls(browser, address, name, "screen")) > 2
