"""axe-core on every page, folded parts opened: no violation of WCAG 2.2 A and AA, wide and phone, light and dark.

Every second page is looked at, in one of the two widths; ``FULL=1`` looks at all in both.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from building import pages_of
from sampling import some

pytestmark = [pytest.mark.book, pytest.mark.browser]

ROOT = Path(__file__).parent.parent.parent
AXE = ROOT / "node_modules/axe-core/axe.min.js"

OPEN_FOLDS = """() => {
    document.querySelectorAll('details').forEach(fold => { fold.open = true; });
    document.querySelectorAll('button.toggle-button-hidden').forEach(button => button.click());
}"""
STILL = "*, *::before, *::after { transition: none !important; animation: none !important; }"
#: The theme changes colours alone: in dark the rules of colour are asked, in light all.
RUN = """async theme => {
    const {violations} = await axe.run(document, {
        resultTypes: ['violations'],
        runOnly: theme === 'dark'
            ? {type: 'rule', values: ['color-contrast', 'link-in-text-block']}
            : {type: 'tag', values: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22a', 'wcag22aa']},
    });
    return violations.flatMap(v => v.nodes.map(n => `${v.id}: ${n.html.slice(0, 160)} ${n.failureSummary}`));
}"""


def violations(page: Any, theme: str) -> list[str]:
    """What axe-core finds on a page that is open."""
    page.evaluate("theme => { document.documentElement.dataset.theme = theme; }", theme)
    found: list[str] = page.evaluate(RUN, theme)
    return found


def open_page(browser: Any, address: str, width: int) -> Any:
    """Open a page in a window of its own, its folds opened, with axe-core in it."""
    context = browser.new_context(viewport={"width": width, "height": 800}, reduced_motion="reduce")
    page = context.new_page()
    page.goto(address)
    page.add_style_tag(content=STILL)
    page.add_script_tag(path=str(AXE))
    page.evaluate(OPEN_FOLDS)
    # Sections and figures wait for a reader (sections.js, near.js); who goes to a place in the page has all of them.
    page.evaluate("dispatchEvent(new HashChangeEvent('hashchange')); scrollTo(0, document.body.scrollHeight)")
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return page


#: Pages are dealt into hands, so that processes share the work.
HANDS = 8


@pytest.mark.parametrize("hand", range(HANDS))
def test_no_page_has_a_violation(browser: Any, site: Path, address: str, hand: int) -> None:
    faults = []
    pages = pages_of(site)
    for name in some(pages, len(pages) // 2, "axe")[hand::HANDS]:
        if name == "index.html":  # leads on to the first page
            continue
        for width in some((1280, 390), 1, name):
            page = open_page(browser, f"{address}/{name}", width)
            for theme in ("light", "dark"):
                faults += [f"{name}, {width} px, {theme}: {found}" for found in violations(page, theme)]
            page.context.close()
    assert not faults


@pytest.mark.parametrize(
    ("rule", "spoil"),
    [
        ("image-alt", "document.querySelector('article').append(new Image())"),
        ("color-contrast", "document.querySelector('article p').style.color = '#888'"),
        ("button-name", "document.querySelector('article').append(document.createElement('button'))"),
        ("scrollable-region-focusable", "document.querySelectorAll('[tabindex]').forEach(e => { e.tabIndex = -1; })"),
    ],
)
def test_a_violation_would_be_found(browser: Any, address: str, rule: str, spoil: str) -> None:
    page = open_page(browser, f"{address}/book/why.html", 390)
    page.evaluate(spoil)
    assert any(found.startswith(rule) for found in violations(page, "light"))
    page.context.close()


def test_a_pale_word_in_the_dark_would_be_found(browser: Any, address: str) -> None:
    page = open_page(browser, f"{address}/book/index.html", 1280)
    assert violations(page, "dark") == []
    page.evaluate("document.querySelector('article p').style.color = '#555'")
    assert any(found.startswith("color-contrast") for found in violations(page, "dark"))
    page.context.close()
