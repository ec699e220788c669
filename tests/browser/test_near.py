"""What waits for a reader, figures and fields of questions, is there whenever one could want it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

pytestmark = [pytest.mark.book, pytest.mark.browser]

PAGE = "book/classic.html"
FIGURE = "#live-fig-classic-link"
ALIVE = f"document.querySelector('{FIGURE}').shadowRoot !== null"
FIELDS = "document.querySelectorAll('form.dh-question input').length"
PLACES = "document.querySelectorAll('form.dh-question .dh-field').length"


def opened(browser: Any, address: str, script: str = "") -> Any:
    """A long chapter, just opened; its figures and its questions are far below."""
    context = browser.new_context(viewport={"width": 390, "height": 800}, service_workers="block")
    context.add_init_script(script)
    page = context.new_page()
    page.goto(f"{address}/{PAGE}")
    page.wait_for_timeout(300)
    return page


@pytest.fixture
def page(browser: Any, address: str) -> Iterator[Any]:
    page = opened(browser, address)
    yield page
    page.context.close()


@pytest.fixture
def busy_page(browser: Any, address: str) -> Iterator[Any]:
    """A page of a browser that is never idle, so that nothing comes by itself."""
    page = opened(browser, address, "window.requestIdleCallback = () => {};")
    yield page
    page.context.close()


def test_at_first_there_is_a_picture_and_no_field(busy_page: Any) -> None:
    assert not busy_page.evaluate(ALIVE)
    assert busy_page.locator(f"{FIGURE} > svg").count() == 1
    assert busy_page.evaluate(FIELDS) == 0
    assert busy_page.evaluate(PLACES) > 3


def test_who_scrolls_finds_a_figure_before_it_is_seen(busy_page: Any) -> None:
    for _ in range(200):
        if busy_page.evaluate(ALIVE):
            break
        busy_page.evaluate("scrollBy({top: 200, behavior: 'instant'})")
        busy_page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert busy_page.evaluate(ALIVE)
    assert busy_page.evaluate(f"document.querySelector('{FIGURE}').getBoundingClientRect().top > innerHeight")
    assert busy_page.evaluate(FIELDS) == 0, "what is still far waits on"


def test_tab_misses_nothing(busy_page: Any) -> None:
    busy_page.keyboard.press("Tab")
    assert busy_page.evaluate(ALIVE)
    assert busy_page.evaluate(PLACES) == 0


def test_a_place_in_the_page_is_not_moved_by_what_comes_late(busy_page: Any) -> None:
    busy_page.evaluate("location.hash = 'traps'")
    busy_page.wait_for_function(ALIVE)
    assert busy_page.evaluate(PLACES) == 0


def test_a_shared_link_opens_its_figure(busy_page: Any, address: str) -> None:
    busy_page.goto("about:blank")
    busy_page.goto(f"{address}/{PAGE}{FIGURE}?theta=12&d=0.5&a=1&alpha=30&convention=classic")
    assert busy_page.evaluate(f"document.querySelector('{FIGURE}').state.theta") == 12


def test_who_is_left_in_peace_has_all_in_the_end(page: Any) -> None:
    page.wait_for_function(f"{ALIVE} && {PLACES} === 0", timeout=60_000)


def test_any_key_is_enough(browser: Any, address: str) -> None:
    page = opened(
        browser, address, "const wait = setTimeout; setTimeout = (act, time) => time < 5000 && wait(act, time);"
    )
    page.wait_for_timeout(6_000)
    assert not page.evaluate(ALIVE), "no peace in this browser"
    page.keyboard.press("Shift")
    page.wait_for_function(f"{ALIVE} && {PLACES} === 0")
    page.context.close()


#: A browser so busy that, each time it tells what is seen, it first tells of a moment before.
LATE = """
const Observer = IntersectionObserver;
window.IntersectionObserver = class extends Observer {
    constructor(act, options) {
        const before = (target) => ({ target, isIntersecting: false });
        super((entries, self) => act([before(entries[0].target), ...entries], self), options);
    }
};
"""


def test_a_busy_browser_gets_its_arm_in_space(browser: Any, address: str) -> None:
    page = opened(browser, address, LATE)
    page.goto(f"{address}/book/pa10.html")
    page.wait_for_function(
        "() => { const arm = document.querySelector('dh-robot'); arm.scrollIntoView(); return arm.space; }"
    )
    page.context.close()
