"""A reader without a pointer: Tab goes through every control of a page, once, in order, in sight, and out again."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import pytest

pytestmark = [pytest.mark.book, pytest.mark.browser]

#: In the page: what Tab should visit, in order; the radio buttons of a group are one stop.
HELPERS = """
window.stops = root => [...root.querySelectorAll('*')].flatMap(element => {
    if (element.shadowRoot) return stops(element.shadowRoot);
    if (!element.matches('a[href], button, input, select, textarea, summary, [tabindex]')) return [];
    if (element.tabIndex < 0 || element.disabled || !element.checkVisibility({visibilityProperty: true})) return [];
    const box = element.getBoundingClientRect();
    if (box.width === 0 || box.height === 0 || element.closest('[inert], dialog:not([open])')) return [];
    if (element.type === 'radio') {
        const group = [...element.getRootNode().querySelectorAll(`input[type=radio][name="${element.name}"]`)]
            .filter(one => one.form === element.form);
        if (element !== (group.find(one => one.checked) ?? group[0])) return [];
    }
    return [element];
});
window.focused = () => {
    let element = document.activeElement;
    while (element?.shadowRoot?.activeElement) element = element.shadowRoot.activeElement;
    return element;
};
window.look = element => {
    const shown = ['outlineStyle', 'outlineWidth', 'boxShadow', 'borderColor', 'backgroundColor', 'textDecoration'];
    const of = one => { const style = getComputedStyle(one); return shown.map(name => style[name]).join(); };
    return of(element) + (element.parentElement ? of(element.parentElement) : '');
};
window.named = element => {
    const words = element.getAttribute('aria-label') ?? element.textContent ?? '';
    return `${element.localName}#${element.id}.${element.className} ${words.trim().slice(0, 40)}`;
};
"""


@pytest.fixture
def page(browser: Any) -> Iterator[Any]:
    context = browser.new_context(
        viewport={"width": 1280, "height": 900}, reduced_motion="reduce", service_workers="block"
    )
    context.add_init_script(HELPERS)
    yield context.new_page()
    context.close()


def walk(page: Any) -> list[str]:
    """Press Tab from the top of the page until it is left; returns what went wrong on the way."""
    page.add_style_tag(
        content="*, *::before, *::after { transition: none !important; scroll-behavior: auto !important; }"
    )
    # The first Tab has what is far from the screen laid out, and gives what scrolls there its stop (scrolling.js).
    page.evaluate("dispatchEvent(new KeyboardEvent('keydown', {key: 'Tab'}))")
    page.evaluate("() => { window.expected = stops(document.body); window.at = []; scrollTo(0, 0); }")
    page.evaluate("expected.forEach(element => { element.plain = look(element); })")
    faults: list[str] = []
    count = page.evaluate("expected.length")
    for _ in range(count + 5):
        page.keyboard.press("Tab")
        found = page.evaluate(
            """() => {
                const element = focused();
                if (!element || element === document.body) return {left: true};
                const box = element.getBoundingClientRect(), k = expected.indexOf(element);
                return {
                    k, name: named(element), plain: look(element) === element.plain,
                    hidden: box.bottom < 1 || box.top > innerHeight - 1 || box.right < 1 || box.left > innerWidth - 1,
                };
            }"""
        )
        if found.get("left"):
            break
        page.evaluate("k => at.push(k)", found["k"])
        if found["k"] >= 0 and found["plain"]:
            faults.append(f"focus cannot be seen on {found['name']}")
        if found["hidden"]:
            faults.append(f"out of sight: {found['name']}")
        if found["k"] < 0:
            faults.append(f"no stop: {found['name']}")
    else:
        faults.append("Tab does not leave the page")
    visited = [k for k in page.evaluate("at") if k >= 0]
    names = page.evaluate("expected.map(named)")
    if visited != sorted(set(visited)):
        faults.append(f"not in order: {[names[k] for a, k in pairwise(visited) if k <= a]}")
    faults += [f"not reached: {names[k]}" for k in range(count) if k not in visited]
    return faults


@pytest.mark.parametrize("name", ["book/index", "book/classic", "book/placing", "book/pa10", "exercises/quickshot"])
def test_tab_visits_every_control_once_in_order_and_in_sight(page: Any, address: str, name: str) -> None:
    page.goto(f"{address}/{name}.html")
    page.wait_for_load_state("networkidle")
    page.evaluate("document.querySelectorAll('article details').forEach(fold => { fold.open = true; })")
    page.wait_for_timeout(300)
    assert walk(page) == []


def test_a_bad_path_would_be_found(page: Any, address: str) -> None:
    page.goto(f"{address}/book/why.html")
    page.wait_for_load_state("networkidle")
    page.evaluate(
        """() => {
            const style = document.createElement('style');
            style.textContent = '* { outline: none !important; box-shadow: none !important; '
                + 'background: none !important; ' + 'border-color: red !important; text-decoration: none !important; }';
            document.head.append(style);
            const first = document.querySelector('article h1, article p');
            first.insertAdjacentHTML('afterend', '<button tabindex="5">early</button>'
                + '<button onkeydown="event.preventDefault()">trap</button>');
        }"""
    )
    faults = walk(page)
    assert any(fault.startswith("focus cannot be seen") for fault in faults)
    assert any(fault.startswith("not in order") for fault in faults)
    assert "Tab does not leave the page" in faults


def test_keys_open_a_fold_answer_a_question_and_change_the_theme(page: Any, address: str) -> None:
    page.goto(f"{address}/book/classic.html")
    page.locator("article details > summary").first.focus()
    was = page.evaluate("document.querySelector('article details').open")
    page.keyboard.press("Enter")
    assert page.evaluate("document.querySelector('article details').open") != was

    page.keyboard.press("Tab")  # who goes on by Tab finds every field in its place (near.js)
    form = page.locator("form.dh-question", has=page.locator("input[type=text]")).first
    for entry in form.locator("input[type=text]").all():
        entry.focus()
        page.keyboard.type("12345")
    page.keyboard.press("Enter")
    page.wait_for_selector("form.dh-question:is([data-state=right], [data-state=wrong])")
    assert form.locator("output").inner_text().strip()

    page.locator(".theme-switch-button:visible").first.focus()
    themes = set()
    for _ in range(3):
        page.keyboard.press("Enter")
        themes.add(page.evaluate("document.documentElement.dataset.theme"))
    assert themes == {"light", "dark"}


def test_keys_open_and_close_search_and_the_menus_of_a_phone(page: Any, address: str) -> None:
    page.goto(f"{address}/book/why.html")
    page.keyboard.press("Control+k")
    page.keyboard.type("twist")
    assert page.evaluate("focused().value") == "twist"
    page.keyboard.press("Escape")
    page.wait_for_function("!document.querySelector('dialog[open]')")
    page.set_viewport_size({"width": 390, "height": 800})
    for button in (".primary-toggle", ".secondary-toggle"):
        toggle = page.locator(f"{button}:visible").first
        toggle.focus()
        page.keyboard.press("Enter")
        page.wait_for_selector("dialog[open]")
        page.keyboard.press("Tab")
        assert page.evaluate("Boolean(focused().closest('dialog[open]'))")
        page.keyboard.press("Escape")
        page.wait_for_function("!document.querySelector('dialog[open]')")
        assert toggle.evaluate("button => button === focused()"), "Escape leads back to the button"
