"""Cells as readers run them: right, wrong, edited, stopped, by keyboard, from the disk, on paper."""

from __future__ import annotations

import json
import re
import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from building import build_book
from live import needs_numpy
from serve import server
from sources import book_of_one_page

pytestmark = [pytest.mark.book, pytest.mark.browser]

#: The cells of the page, by what they show.
IMPORTS, ARRAY, MATRIX, TABLE, FIGURE, LONG, SUM, SHOW_ARM, READ_ARM, SHOW_LINK, READ_LINK, DRAW = range(1, 13)
ARM, LINK = "#live-arm", "#live-one-link"
A_MINUTE = 60_000


@pytest.fixture(scope="session")
def cells_site(built_once: Callable[..., Path], root: Path) -> Path:
    """The folder of a site of one page with cells of each kind."""

    def build(into: Path) -> subprocess.CompletedProcess[str]:
        copy = book_of_one_page(into / "copy", (root / "tests/book/pages/cells.md").read_text("utf-8"), "cells")
        return build_book(copy, into, environment={"PYTHONPATH": str(copy)})

    return built_once("cells", build)


@pytest.fixture(scope="module")
def home(cells_site: Path) -> Iterator[str]:
    """Where the site is served."""
    httpd = server(cells_site)
    threading.Thread(target=httpd.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{httpd.server_address[1]}/book/cells.html"
    httpd.shutdown()


@pytest.fixture(scope="module")
def page(browser: Any, home: str, cells_site: Path) -> Iterator[Any]:
    """The page on a phone, whose Python the tests of this module share."""
    needs_numpy(cells_site)
    context = browser.new_context(viewport={"width": 390, "height": 800}, color_scheme="light")
    page = context.new_page()
    page.set_default_timeout(A_MINUTE)
    page.goto(home)
    yield page
    context.close()


def bar(page: Any, number: int) -> Any:
    return page.locator(".dh-cell-bar").nth(number - 1)


def settled(page: Any, number: int, state: str = "good") -> str:
    """Wait until a cell has run; return what its status says."""
    page.wait_for_selector(
        f".dh-cell-bar >> nth={number - 1} >> xpath=self::*[@data-state='{state}']", state="attached"
    )
    return str(bar(page, number).locator(".dh-status").inner_text())


def run(page: Any, number: int, state: str = "good") -> str:
    bar(page, number).get_by_role("button", name=f"Run cell {number}", exact=True).click()
    return settled(page, number, state)


def fresh(page: Any, number: int) -> Any:
    """What a cell showed when it ran."""
    return bar(page, number).locator("xpath=ancestor::*[contains(@class, 'cell ')][1]").locator(".dh-fresh")


def put(page: Any, number: int, text: str) -> None:
    page.evaluate("([number, text]) => DhCells.cells[number - 1].put(text)", [number, text])


def reset(page: Any, number: int) -> None:
    bar(page, number).get_by_role("button", name="Reset").click()


def test_a_cell_runs_what_it_needs_first(page: Any) -> None:
    """Also the hidden cell between, without what it only tells the text."""
    run(page, ARRAY)
    shown = fresh(page, ARRAY).inner_text()
    assert "turns: 3" in shown
    assert "array([[3., 0.],\n       [0., 3.]])" in shown
    assert fresh(page, IMPORTS).count() == 0, "what ran unasked shows nothing"


def test_what_sympy_gives_is_typeset(page: Any) -> None:
    run(page, MATRIX)
    page.wait_for_selector(".dh-fresh .formula svg")
    formula = fresh(page, MATRIX).locator(".formula")
    assert formula.locator("svg").bounding_box()["width"] > 40
    assert "cos" in formula.locator(".spoken").inner_text()
    assert formula.locator("mtable mtr").count() == 2


def test_a_chain_is_its_table(page: Any) -> None:
    run(page, TABLE)
    assert fresh(page, TABLE).locator("table.dh-table tbody tr").count() == 2


def test_a_figure_of_a_folded_cell(page: Any) -> None:
    page.locator("details.hide summary").first.click()
    run(page, FIGURE)
    assert fresh(page, FIGURE).locator("svg.dh-figure").get_attribute("aria-label").startswith("Planar 2R")


def test_values_are_written_as_a_notebook_writes_them(page: Any) -> None:
    run(page, LONG)
    built = page.evaluate(f"() => DhCells.cells[{LONG - 1}].built.querySelector('pre').textContent")
    assert fresh(page, LONG).inner_text().strip() == built.strip()
    assert "{'a', 'm', 'z'}" in built


def test_display_needs_no_import_as_in_any_notebook(page: Any) -> None:
    put(page, SUM, "display({'a': 1})\nshow = display\nshow('two')")
    run(page, SUM)
    assert fresh(page, SUM).inner_text().split("\n") == ["{'a': 1}", "'two'"]
    reset(page, SUM)


def test_what_was_built_stands_until_a_cell_runs_and_after_reset(page: Any) -> None:
    built = page.evaluate_handle(f"() => DhCells.cells[{SUM - 1}].built")
    assert built.evaluate("e => !e.hidden")
    run(page, SUM)
    assert built.evaluate("e => e.hidden")
    assert fresh(page, SUM).inner_text().strip() == "3"
    reset(page, SUM)
    assert built.evaluate("e => !e.hidden")
    assert fresh(page, SUM).count() == 0


def test_an_error_is_told_in_a_line(page: Any) -> None:
    put(page, SUM, "a = 1\nb = aa + 1")
    run(page, SUM, "bad")
    error = fresh(page, SUM).locator(".dh-error")
    assert error.locator(".dh-said").inner_text().startswith("NameError: name 'aa' is not defined")
    assert error.locator(".dh-where").inner_text() == "In line 2 of this cell."
    assert not error.locator("pre").is_visible()
    error.locator("summary").click()
    traceback = error.locator("pre").inner_text()
    assert "b = aa + 1" in traceback
    assert "kernel.py" not in traceback
    reset(page, SUM)


def test_an_error_above_is_pointed_at(page: Any) -> None:
    put(page, ARRAY, "1 +")
    assert f"Cell {ARRAY} fails" in run(page, SUM, "bad")
    reset(page, ARRAY)
    run(page, SUM)
    reset(page, SUM)


def test_by_keyboard_alone(page: Any) -> None:
    bar(page, SUM).get_by_role("button", name=f"Edit cell {SUM}").focus()
    page.keyboard.press("Enter")
    page.wait_for_selector(".cm-content:focus")
    assert page.evaluate("document.activeElement.getAttribute('aria-label')").startswith(f"Code of cell {SUM}.")
    page.keyboard.press("Control+a")
    page.keyboard.type("for k in range(2):\nprint(k + 40)")  # the second line is indented by the editor
    page.keyboard.press("Shift+Enter")
    settled(page, SUM)
    assert fresh(page, SUM).inner_text().split() == ["40", "41"]
    assert page.locator(".cm-line span[class]").count() > 2, "the code is coloured"
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.textContent") == "Run"


def test_edits_survive_a_reload_until_reset(page: Any, home: str) -> None:
    put(page, SUM, "21 * 2")
    other = page.context.new_page()
    other.goto(home)
    cell = other.locator(".dh-edited")
    assert "21 * 2" in cell.inner_text()
    reset(other, SUM)
    assert "21 * 2" not in other.locator("main").inner_text()
    other.reload()
    assert other.locator(".dh-edited").count() == 0
    other.close()
    reset(page, SUM)


def test_run_all_above(page: Any) -> None:
    bar(page, TABLE).get_by_role("button", name="Run all above").click()
    assert f"All {TABLE - 1} cells above have run." in settled(page, TABLE)
    assert fresh(page, MATRIX).is_visible()


def test_stop_ends_python_and_says_so(page: Any) -> None:
    put(page, SUM, "while True:\n    pass")
    bar(page, SUM).get_by_role("button", name=f"Run cell {SUM}").click()
    page.wait_for_function(f"() => DhCells.cells[{SUM - 1}].status.textContent === 'Running …'")
    bar(page, SUM).get_by_role("button", name="Stop").click()
    assert "variables are gone" in settled(page, SUM, "bad")
    reset(page, SUM)
    put(page, SUM, "'np' in globals(), total")
    assert "turns" not in page.evaluate("DhCells.items.filter(item => item.ran !== null).length.toString()")
    run(page, SUM, "bad")
    assert "name 'total' is not defined" in fresh(page, SUM).inner_text()
    reset(page, SUM)


def test_what_a_cell_shows_cannot_act(page: Any) -> None:
    put(
        page,
        SUM,
        "from IPython.display import HTML\n"
        'HTML(\'<b onclick="x()">bold</b><img src=x onerror="hit=1"><script>hit=1</script>\')',
    )
    run(page, SUM)
    shown = fresh(page, SUM)
    assert shown.locator("b").inner_text() == "bold"
    assert shown.locator("[onclick], [onerror], script").count() == 0
    assert page.evaluate("globalThis.hit") is None
    reset(page, SUM)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing(page: Any, root: Path, theme: str) -> None:
    page.evaluate("theme => { document.documentElement.dataset.theme = theme; }", theme)
    put(page, SUM, "1/0")
    run(page, SUM, "bad")
    bar(page, ARRAY).get_by_role("button", name="Edit").click()
    page.wait_for_selector(".cm-content")
    page.add_script_tag(path=str(root / "node_modules/axe-core/axe.min.js"))
    cells = "{include: ['.cell'], exclude: ['summary']}"
    find = f"async () => (await axe.run({cells})).violations.map(v => `${{v.id}}: ${{v.nodes[0].html}}`)"
    assert page.evaluate(find) == []
    bar(page, ARRAY).locator("button").first.evaluate("b => { b.removeAttribute('aria-label'); b.textContent = ''; }")
    assert page.evaluate(find), "a button without a name would be found"
    page.evaluate("DhCells.cells[1].runButton.textContent = 'Run'; DhCells.cells[1].runButton.ariaLabel = 'Run cell 2'")
    reset(page, ARRAY)
    reset(page, SUM)


def test_nothing_is_wider_than_the_phone(page: Any) -> None:
    assert page.evaluate("document.documentElement.scrollWidth") <= 390


def test_print_has_no_buttons(page: Any) -> None:
    page.emulate_media(media="print")
    assert not bar(page, ARRAY).is_visible()
    page.emulate_media(media="screen")
    assert bar(page, ARRAY).is_visible()


def test_nothing_is_loaded_before_the_first_run(browser: Any, home: str) -> None:
    page = browser.new_page()
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(home)
    page.wait_for_timeout(300)
    (script,) = [url for url in asked if "/run/" in url]
    assert re.search(r"/run/cells\.js\?v=\w+$", script)
    page.locator(".dh-cell-bar button", has_text="Edit").first.click()
    page.wait_for_selector(".cm-content")
    assert [url.split("/")[-1].split("?")[0] for url in asked if "/run/" in url] == ["cells.js", "editor.js"]
    page.close()


def test_the_script_is_small(cells_site: Path) -> None:
    assert (cells_site / "run" / "cells.js").stat().st_size < 20_000


def test_from_the_disk_the_page_says_how_to_serve_it(browser: Any, cells_site: Path) -> None:
    page = browser.new_page()
    page.goto((cells_site / "book" / "cells.html").as_uri())
    bar(page, ARRAY).get_by_role("button", name="Run cell").click()
    assert "python -m http.server" in bar(page, ARRAY).locator(".dh-status").inner_text()
    bar(page, ARRAY).get_by_role("button", name="Edit").click()
    page.wait_for_selector(".cm-content")
    page.close()


def of_figure(page: Any, figure: str) -> dict[str, Any]:
    """What cells are told of a figure."""
    found: dict[str, Any] = page.locator(figure).evaluate("figure => figure.forCells")
    return found


def slide(page: Any, figure: str, number: int, key: str) -> None:
    page.locator(f"{figure} input[type=range]").nth(number).press(key)


def test_a_chain_goes_into_the_figure_and_its_joints_come_back(page: Any) -> None:
    assert page.locator(f"{ARM} input[type=range]").count() == 2
    run(page, SHOW_ARM)
    assert page.locator(f"{ARM} input[type=range]").count() == 3
    assert of_figure(page, ARM)["q"] == [0.1, 0.2, 0.3]
    assert "From a cell: Planar 3R" in page.locator(f"{ARM} .note").inner_text()
    assert fresh(page, SHOW_ARM).locator("svg").count() == 1, "and below the cell a drawing"
    run(page, READ_ARM)
    assert fresh(page, READ_ARM).inner_text().strip() == "array([0.1, 0.2, 0.3])"
    slide(page, ARM, 1, "End")
    run(page, READ_ARM)
    set_by_hand = of_figure(page, ARM)["q"]
    assert fresh(page, READ_ARM).inner_text().strip() == repr(np.array(set_by_hand))
    assert set_by_hand[1] == np.pi
    page.locator(ARM).get_by_role("button", name="Reset").click()
    assert page.locator(f"{ARM} input[type=range]").count() == 2
    assert not page.locator(f"{ARM} .note").is_visible()


def test_a_link_goes_into_its_figure_and_comes_back(page: Any) -> None:
    run(page, SHOW_LINK)
    shown = of_figure(page, LINK)
    assert (shown["convention"], shown["d"], shown["a"]) == ("modified", 0.75, 1.5)
    assert np.allclose(np.radians([shown["theta"], shown["alpha"]]), [0.5, -0.25])
    page.locator(LINK).get_by_role("radio", name="classic").check()
    slide(page, LINK, 2, "End")
    run(page, READ_LINK)
    assert fresh(page, READ_LINK).inner_text().split()[:3] == ["classic", "0.5", "2.0"]


MISTAKES = {
    "live_figure('leg', robots.planar(2))": "no live figure called 'leg'. What can be given is: 'arm', 'one-link'.",
    "link_figure.show(robots.planar(2))": "this figure shows one link, and the chain has 2 joints.",
    "link_figure.show(Chain([Revolute(a=7)], 'classic'))": "a is 7, beyond what this figure can show: 2",
    "arm_figure.move([1, 2, 3, 4])": "4",
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_with_a_figure_is_told(page: Any, mistake: str) -> None:
    run(page, READ_LINK)  # so that what stands above has run, whichever test was first
    before = of_figure(page, LINK)
    put(page, READ_LINK, mistake)
    run(page, READ_LINK, "bad")
    said = fresh(page, READ_LINK).locator(".dh-said").inner_text()
    assert said.startswith("DHError")
    assert MISTAKES[mistake] in said
    assert of_figure(page, LINK) == before
    reset(page, READ_LINK)


def test_matplotlib_is_asked_for_first(page: Any) -> None:
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    data = "JSON.parse(document.getElementById('dh-cells').textContent)"
    host = page.evaluate(f"new URL({data}.python.elsewhere).host")
    told = bar(page, DRAW).locator(".dh-status").inner_text()
    assert told == f"This cell draws with matplotlib. Run asks before it is taken from {host}."
    for number, text in ((DRAW, None), (SUM, "from dhlib.plot import plot"), (SUM, "import matplotlib.pyplot as plt")):
        if text:
            put(page, number, text)
        bar(page, number).get_by_role("button", name=f"Run cell {number}", exact=True).click()
        ask = bar(page, number).locator(".dh-ask")
        ask.wait_for()
        assert host in ask.inner_text()
        ask.get_by_role("button", name="Do not run").click()
        page.wait_for_function(f"() => DhCells.cells[{number - 1}].status.textContent === 'Not run.'")
    assert not [url for url in asked if host in url]
    reset(page, SUM)


def test_no_answer_to_a_question_stands_in_the_page(cells_site: Path) -> None:
    page = (cells_site / "book" / "cells.html").read_text("utf-8")
    data = json.loads(re.search(r'id="dh-cells">(.*?)</script>', page)[1])  # type: ignore[index]
    hidden = [cell["source"] for cell in data["cells"] if "source" in cell]
    assert hidden == ["from bookkit import show_figure", "turns = 3"]
    assert "Because it is so" not in page
