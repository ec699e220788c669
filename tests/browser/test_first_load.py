"""What a first visit costs: bytes, nothing that shifts, and a page that reads without scripts."""

from __future__ import annotations

import gzip
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from building import pages_of
from sampling import some

pytestmark = [pytest.mark.book, pytest.mark.browser]

MOST = 500_000
"""Bytes that a first load may take, compressed as a host of static pages does."""
PACKED = {".woff2", ".png", ".zip"}

WATCH_SHIFTS = """window.shifts = [];
new PerformanceObserver(list => list.getEntries().forEach(entry => {
    const moved = entry.sources.map(source => source.node?.outerHTML?.slice(0, 80)).join();
    if (!entry.hadRecentInput) shifts.push([entry.value, moved]);
})).observe({type: 'layout-shift', buffered: true});"""
SCROLL = """async () => {
    await document.fonts.ready;
    const frame = () => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
    for (let y = 0; y < document.documentElement.scrollHeight; y += 700) { scrollTo(0, y); await frame(); }
    await frame();
}"""


@cache
def weight(site: Path, path: str) -> int:
    """How many bytes a file takes on its way."""
    content = (site / path).read_bytes()
    return len(content) if Path(path).suffix in PACKED else len(gzip.compress(content, 6))


def pages(site: Path) -> list[str]:
    return [name for name in pages_of(site) if name != "index.html"]


def half(site: Path, seed: str) -> list[str]:
    """Every second page, by chance; ``FULL=1`` gives all."""
    return some(pages(site), len(pages(site)) // 2, seed)


def test_the_first_load_of_every_page_is_light(browser: Any, site: Path, address: str) -> None:
    heavy = {}
    for name in half(site, "light"):
        context = browser.new_context(viewport={"width": 390, "height": 800}, service_workers="block")
        page = context.new_page()
        asked: set[str] = set()
        page.on("request", lambda request, asked=asked: asked.add(urlsplit(request.url).path.lstrip("/")))
        page.goto(f"{address}/{name}")
        page.wait_for_timeout(100)
        context.close()
        assert name in asked
        if (total := sum(weight(site, path) for path in asked if (site / path).is_file())) > MOST:
            heavy[name] = total
    assert heavy == {}


def test_the_weight_of_a_file_is_what_a_host_sends(site: Path) -> None:
    assert weight(site, "book/classic.html") < (site / "book/classic.html").stat().st_size / 2
    assert sum(weight(site, path.relative_to(site).as_posix()) for path in site.rglob("*.html")) > MOST


def shifts(page: Any) -> float:
    """By how much a page shifts from its first picture on, while it is read from top to end."""
    page.evaluate(SCROLL)
    return float(sum(value for value, _ in page.evaluate("shifts")))


@pytest.mark.parametrize("width", [1280, 390])
def test_nothing_shifts(browser: Any, site: Path, address: str, width: int) -> None:
    """Every second page in one of the two widths; ``FULL=1`` looks at all in both."""
    restless = {}
    context = browser.new_context(viewport={"width": width, "height": 800}, service_workers="block")
    context.add_init_script(WATCH_SHIFTS)
    page = context.new_page()
    for name in (name for name in half(site, "shifts") if width in some((1280, 390), 1, name)):
        page.goto(f"{address}/{name}")
        if (moved := shifts(page)) >= 0.05:
            restless[name] = (moved, page.evaluate("shifts"))
    context.close()
    assert restless == {}


def test_a_shift_would_be_found(browser: Any, address: str) -> None:
    context = browser.new_context(viewport={"width": 390, "height": 800})
    context.add_init_script(WATCH_SHIFTS)
    page = context.new_page()
    page.goto(f"{address}/book/why.html")
    page.evaluate(
        """() => { const late = document.createElement('div'); late.style.height = '500px';
            document.querySelector('article').prepend(late); }"""
    )
    assert shifts(page) > 0.05
    context.close()


@pytest.mark.parametrize("width", [1280, 390])
def test_links_lead_to_their_section(browser: Any, address: str, width: int) -> None:
    """Though what is far from the screen is not laid out: by an address, by a click, and on coming back."""
    page = browser.new_page(viewport={"width": width, "height": 800})
    top = "id => document.getElementById(id).getBoundingClientRect().top"
    arrived = f"id => {{ const top = ({top})(id); return top > -5 && top < 500; }}"
    for target in ("traps", "numbers-first"):
        page.goto("about:blank")
        page.goto(f"{address}/book/classic.html#{target}")
        page.wait_for_function(arrived, arg=target)
    page.goto(f"{address}/book/classic.html")
    page.evaluate("document.querySelector('.bd-sidebar-secondary a[href=\"#traps\"]').click()")
    page.wait_for_function(arrived, arg="traps")
    page.wait_for_timeout(1000)
    page.reload()
    page.wait_for_function(arrived, arg="traps")
    page.close()


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_without_scripts_every_page_reads(browser: Any, site: Path, address: str, theme: str) -> None:
    context = browser.new_context(viewport={"width": 390, "height": 800}, java_script_enabled=False, color_scheme=theme)
    page = context.new_page()
    for name in half(site, theme):
        page.goto(f"{address}/{name}")
        if name.startswith(("book/", "exercises/")):
            assert page.locator("article h1").first.is_visible(), name
            # not its inner text, which leaves out what is not laid out yet
            assert len(page.locator("article").text_content()) > 300, name
            for still in page.locator(":is(dh-link, dh-robot, dh-place) > svg").all():
                assert still.is_visible(), name
            formulas = page.locator("article p .math svg")
            assert formulas.count() == 0 or formulas.first.is_visible(), name
            assert page.locator(".prev-next-footer a").count() >= 1, name
    page.goto(f"{address}/index.html")
    page.wait_for_url("**/book/index.html")
    context.close()
