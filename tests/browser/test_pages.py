"""Every page in Chromium: wide and phone, light and dark, served and from the disk; no other host is asked."""

from __future__ import annotations

import re
from itertools import product
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from building import pages_of
from sampling import FULL

pytestmark = [pytest.mark.book, pytest.mark.browser]


class Watch:
    """What a page asks of other hosts, and what it complains of."""

    def __init__(self, page: Any, home: str) -> None:
        self.strangers: list[str] = []
        self.complaints: list[str] = []
        self.home = home
        page.route("**/*", self.guard)
        page.on("console", self.listen)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("requestfailed", lambda request: self.complaints.append(f"failed: {request.url}"))

    def listen(self, said: Any) -> None:
        """Note errors and warnings; what a graphics driver says of its own speed is not the page's."""
        if said.type in {"error", "warning"} and "GL Driver Message (OpenGL, Performance" not in said.text:
            self.complaints.append(said.text)

    def guard(self, route: Any) -> None:
        """Let only the site's own files through."""
        url = urlsplit(route.request.url)
        if url.scheme == "data" or f"{url.scheme}://{url.netloc}" == self.home:
            route.continue_()
        else:
            self.strangers.append(route.request.url)
            route.abort()


def settle(page: Any) -> None:
    """Let scripts end and scroll through the page, so that what loads late loads."""
    page.wait_for_load_state("load")
    page.evaluate("window.scrollTo(0, document.body.scrollHeight)")
    page.wait_for_timeout(100)


COMBINATIONS = list(product(("http", "file"), (1280, 390), ("light", "dark")))


def pages_in(site: Path, combination: int) -> list[str]:
    """Return the pages to open in a combination: each page in one, in all if the long parts run."""
    pages = [name for name in pages_of(site) if name != "index.html"]  # that one leads on to the first page
    return pages if FULL else pages[combination :: len(COMBINATIONS)]


def test_each_page_is_opened_and_some_in_each_way(site: Path) -> None:
    opened = [pages_in(site, k) for k in range(len(COMBINATIONS))]
    assert min(map(len, opened)) >= 5
    assert {name for names in opened for name in names} == set(pages_of(site)) - {"index.html"}


@pytest.mark.parametrize("combination", range(len(COMBINATIONS)), ids=lambda k: "-".join(map(str, COMBINATIONS[k])))
def test_pages(browser: Any, site: Path, address: str, combination: int) -> None:
    scheme, width, theme = COMBINATIONS[combination]
    home = address if scheme == "http" else "file://"
    base = address if scheme == "http" else site.as_uri()
    context = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=theme)
    page = context.new_page()
    watch = Watch(page, home)
    faults: list[str] = []
    for name in pages_in(site, combination):
        page.goto(f"{base}/{name}")
        settle(page)
        if page.evaluate("document.documentElement.dataset.theme") != theme:
            faults.append(f"{name}: not {theme}")
        if (wide := page.evaluate("document.documentElement.scrollWidth")) > width:
            faults.append(f"{name}: {wide} px wide on a screen of {width}")
        faults += [f"{name}: {text}" for text in page.evaluate(UNSET_FORMULAS)]
    context.close()
    assert not watch.strangers
    assert not watch.complaints
    assert not faults


def sheets(browser: Any, page_address: str) -> int:
    """How many sheets of A4 a page takes when it is printed."""
    page = browser.new_page()
    page.goto(page_address)
    printed = page.pdf(format="A4")
    page.close()
    return len(re.findall(rb"/Type\s*/Page\b", printed))


def test_the_summary_prints_on_one_sheet(browser: Any, site: Path) -> None:
    assert sheets(browser, (site / "book" / "cheatsheet.html").as_uri()) == 1


def test_another_page_takes_more(browser: Any, site: Path) -> None:
    assert sheets(browser, (site / "book" / "notation.html").as_uri()) > 1


# A formula is set when its drawing has a size, each glyph it uses is on the page, and no source is left over.
UNSET_FORMULAS = """() => [...document.querySelectorAll('main .math')].flatMap(math => {
  const svg = math.querySelector('svg'), size = svg?.getBoundingClientRect();
  const hidden = !math.checkVisibility();
  if (!svg || !hidden && !(size.width > 0 && size.height > 0))
    return ['formula not set: ' + math.textContent.slice(0, 60)];
  return [...svg.querySelectorAll('use')].filter(u => !document.querySelector(u.getAttribute('href')))
    .map(u => 'glyph missing: ' + u.getAttribute('href'));
})"""


def test_a_stranger_and_a_complaint_would_be_found(browser: Any, site: Path, address: str) -> None:
    page = browser.new_page()
    watch = Watch(page, address)
    page.goto(f"{address}/book/index.html")
    page.evaluate("""() => new Promise(done => {
        const image = new Image(); image.onerror = done; image.src = 'https://elsewhere.invalid/a.png'; })""")
    page.evaluate("console.error('oh')")
    page.close()
    assert watch.strangers == ["https://elsewhere.invalid/a.png"]
    assert "oh" in watch.complaints


def test_an_unset_formula_would_be_found(browser: Any, address: str) -> None:
    page = browser.new_page()
    page.goto(f"{address}/book/index.html")
    assert page.evaluate("document.querySelectorAll('main .math svg').length") > 0
    assert not page.evaluate(UNSET_FORMULAS)
    page.evaluate("document.querySelector('svg.glyphs').remove()")
    assert page.evaluate(UNSET_FORMULAS)
    page.close()


def test_the_theme_button_changes_the_ground(browser: Any, address: str) -> None:
    page = browser.new_page(color_scheme="light")
    page.goto(f"{address}/book/index.html")
    ground = "getComputedStyle(document.documentElement).getPropertyValue('--dh-ground')"
    grounds = set()
    for _ in range(3):
        page.locator(".theme-switch-button:visible").first.click()
        grounds.add(page.evaluate(ground).strip())
    page.close()
    assert grounds == {"#ffffff", "#121212"}


def test_icons_are_drawn(browser: Any, address: str) -> None:
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.goto(f"{address}/book/index.html")
    icon = page.locator(".fa-magnifying-glass:visible").first
    assert icon.evaluate("e => getComputedStyle(e, '::before').content") == '"\uf002"'
    assert page.evaluate(
        "document.fonts.ready.then(() => document.fonts.check('900 16px \"Font Awesome 6 Free\"', '\uf002'))"
    )
    assert icon.bounding_box()["width"] > 8
    page.close()


def test_the_address_of_the_site_leads_to_the_first_page(browser: Any, site: Path, address: str) -> None:
    for start in (f"{address}/", f"{site.as_uri()}/index.html"):
        page = browser.new_page()
        page.goto(start)
        page.wait_for_selector("article h1")
        assert page.url.endswith("/book/index.html")
        page.close()


def test_search_finds(browser: Any, site: Path, address: str) -> None:
    """Also from the disk, where scripts may not fetch."""
    for base in (address, site.as_uri()):
        page = browser.new_page()
        page.goto(f"{base}/search.html?q=twist")
        page.wait_for_selector("#search-results li a")
        page.close()
