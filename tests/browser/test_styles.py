"""The one style sheet of the pages has every rule that a browser would use of the whole sheets of the theme."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from building import pages_of
from needed_rules import pruned
from quick_start import JOINED, joined
from sampling import some

pytestmark = [pytest.mark.book, pytest.mark.browser]

#: Selectors that mean something on this page, whatever is hovered, pressed or open now.
USED = """sheets => sheets.map((sheet) => {
    const found = new Set();
    const ask = (rules) => {
        for (const rule of rules) {
            if (rule.cssRules?.length && !rule.selectorText) ask(rule.cssRules);
            if (!rule.selectorText) continue;
            for (const selector of rule.selectorText.split(/,(?![^(]*\\))/).map((one) => one.trim())) {
                const resting = selector
                    .replace(/::?(before|after|marker|placeholder|selection|backdrop|-(webkit|moz)-[\\w-]+)/g, "")
                    .replace(/:(hover|focus(-visible|-within)?|active|checked|disabled|target|visited)\\b/g, "");
                try {
                    if (document.querySelector(resting || "*")) found.add(selector);
                } catch { /* another browser's selector */ }
            }
        }
    };
    const read = new CSSStyleSheet();
    read.replaceSync(sheet);
    ask(read.cssRules);
    return [...found];
})"""
OPEN_ALL = """() => {
    document.querySelectorAll("details").forEach((fold) => { fold.open = true; });
    document.querySelectorAll("dialog").forEach((dialog) => dialog.showModal());
    document.querySelector("[data-bs-toggle=dropdown]")?.click();
    document.documentElement.dataset.theme = "dark";
}"""
KINDS = ("book/index.html", "book/classic.html", "book/progress.html", "exercises/quickshot.html", "search.html")


def whole(site: Path, name: str) -> str:
    """The sheets that a page names, joined, with all their rules."""
    found = JOINED.search((site / name).read_text("utf-8"))
    assert found
    return joined([site / sheet for sheet in found[1].split()], site / "_static" / "styles")


def kept(site: Path, name: str) -> str:
    """The one sheet of a page."""
    found = re.search(r'<link rel="stylesheet"[^>]* href="([^"]+)"', (site / name).read_text("utf-8"))
    assert found
    return ((site / name).parent / found[1]).read_text("utf-8")


def used(page: Any, *sheets: str) -> tuple[set[str], ...]:
    """What each sheet has for this page; asked at one moment, since figures come while a page stands open."""
    return tuple(map(set, page.evaluate(USED, list(sheets))))


def test_every_rule_that_is_used_is_kept(browser: Any, site: Path, address: str) -> None:
    others = [name for name in pages_of(site) if name not in {"index.html", *KINDS}]
    page = browser.new_page(viewport={"width": 390, "height": 800})
    for name in (*KINDS, *some(others, 3, "styles")):
        page.goto(f"{address}/{name}")
        page.evaluate(OPEN_ALL)
        page.wait_for_timeout(200)
        asked, found = used(page, whole(site, name), kept(site, name))
        assert len(asked) > 100, name
        missing = sorted(asked - found)
        assert not missing, name
    page.close()


def test_a_rule_that_is_missing_would_be_found(browser: Any, site: Path, address: str) -> None:
    page = browser.new_page()
    page.goto(f"{address}/book/index.html")
    words = set(re.findall(r"[\w-]+", (site / "book/index.html").read_text("utf-8"))) - {"bd-main"}
    sheet = whole(site, "book/index.html")
    asked, found = used(page, sheet, pruned(sheet, words))
    assert any(".bd-main" in selector for selector in asked - found)
    page.close()


def test_the_sheet_is_small(site: Path) -> None:
    assert len(kept(site, "book/classic.html")) < len(whole(site, "book/classic.html")) / 2
