"""Exercises in the page: the same verdict in the same words, points that are kept, and the notebook to hand in."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from live import needs_numpy

from dhlib.grading.grade import grade_notebook

pytestmark = [pytest.mark.book, pytest.mark.browser]

ROOT = Path(__file__).parents[2]
NAME = "one_link"
FIVE_MINUTES = 300_000

PUT = """([part, text]) => {
    const {answer} = DhCells.parts.find(({about}) => about.id === part);
    answer.put(text);
}"""
CHECK = """async part => {
    const one = DhCells.parts.find(({about}) => about.id === part);
    await one.check();
    return {says: one.status.textContent, state: one.bar.dataset.state, points: one.points.textContent};
}"""


def answers() -> dict[str, str]:
    """The worked answers of the exercise, by part."""
    solution = json.loads((ROOT / "solutions" / f"{NAME}.ipynb").read_text("utf-8"))
    return {
        cell["metadata"]["dh"]["part"]: "".join(cell["source"])
        for cell in solution["cells"]
        if cell["metadata"].get("dh", {}).get("role") == "answer"
    }


@pytest.fixture(scope="module")
def page(browser: Any, site: Path, address: str) -> Iterator[Any]:
    """The page of the exercise, on a phone."""
    needs_numpy(site)
    context = browser.new_context(viewport={"width": 390, "height": 800})
    page = context.new_page()
    page.set_default_timeout(FIVE_MINUTES)
    page.goto(f"{address}/exercises/{NAME}.html")
    yield page
    context.close()


#: A part that is answered wrongly.
WRONG = "factor"


@pytest.fixture(scope="module")
def said(page: Any) -> dict[str, dict[str, str]]:
    """What the page says of its answers, by part: one is wrong, the next to last breaks, the last is open."""
    worked = answers()
    right = [part for part in worked if part != WRONG]
    worked[right[-2]] = "1 / 0"
    page.evaluate(PUT, [WRONG, f"{WRONG} = 'no answer'"])
    for part in right[:-1]:
        page.evaluate(PUT, [part, worked[part]])
    return {part: page.evaluate(CHECK, part) for part in worked}


def saved(page: Any, folder: Path) -> Path:
    """Save the page as a notebook; returns where."""
    with page.expect_download() as waited:
        page.get_by_role("button", name="Save as notebook").click()
    path = folder / waited.value.suggested_filename
    waited.value.save_as(path)
    return path


def test_the_page_says_and_gives_what_the_graders_say_and_give(
    page: Any, address: str, said: dict[str, dict[str, str]], tmp_path: Path
) -> None:
    """Saved as a notebook, the answers earn the same."""
    page.goto(f"{address}/exercises/{NAME}.html")
    graded = {mark.part: mark for mark in grade_notebook(saved(page, tmp_path)).marks}
    assert set(said) == set(graded)
    for part, mark in graded.items():
        assert said[part]["says"].startswith(str(mark)), part
        assert said[part]["state"] == ("good" if mark.passed else "bad"), part
        assert said[part]["points"].split(" of ")[0] == f"{mark.points:g}", part
    right = [part for part in graded if part != WRONG]
    assert not graded[WRONG].passed
    assert not graded[right[-1]].passed
    assert "ZeroDivisionError" in said[right[-2]]["says"]
    assert all(graded[part].passed for part in right[:-2])


@pytest.mark.usefixtures("said")
def test_points_are_kept_and_shown(page: Any, address: str) -> None:
    page.goto(f"{address}/exercises/{NAME}.html")
    total = page.locator(".dh-all").inner_text()
    assert " of " in total
    assert not total.startswith("0 of ")
    other = page.context.new_page()
    other.goto(f"{address}/book/progress.html")
    row = other.locator(".dh-progress tr", has_text="link").first
    assert row.locator("td").nth(1).inner_text() in total
    assert other.locator(f'.bd-sidebar-primary a[href$="exercises/{NAME}.html"] .dh-badge').count() == 1
    other.close()


@pytest.mark.usefixtures("said")
def test_progress_goes_to_another_browser_as_a_file(browser: Any, page: Any, address: str, tmp_path: Path) -> None:
    page.goto(f"{address}/book/progress.html")
    with page.expect_download() as waited:
        page.get_by_role("button", name="Save as a file").click()
    path = tmp_path / "progress.json"
    waited.value.save_as(path)
    points = page.locator(".dh-progress tbody").inner_text()
    other = browser.new_page()
    other.goto(f"{address}/book/progress.html")
    assert other.locator(".dh-progress tbody").inner_text() != points
    (tmp_path / "other.json").write_text('{"format": "something"}', "utf-8")
    other.set_input_files(".dh-file", tmp_path / "other.json")
    other.locator(".dh-progress [role=status]", has_text="no progress of this book").wait_for()
    other.set_input_files(".dh-file", path)
    other.wait_for_function("() => document.querySelector('.dh-progress [role=status]').textContent.includes('taken')")
    assert other.locator(".dh-progress tbody").inner_text() == points
    other.goto(f"{address}/exercises/{NAME}.html")
    assert other.locator(".dh-edited").count() > 0, "what was written came along"
    other.goto(f"{address}/book/progress.html")
    forget = other.locator(".dh-progress button").nth(1)
    forget.click()
    assert other.locator(".dh-progress tbody").inner_text() == points, "asked once more first"
    forget.click()
    assert other.locator(".dh-progress tbody").inner_text() != points
    assert forget.inner_text() == "Forget all"
    other.goto(f"{address}/exercises/{NAME}.html")
    assert other.locator(".dh-edited").count() == 0
    other.close()


def test_hints_stay_open(browser: Any, address: str) -> None:
    page = browser.new_context().new_page()
    page.goto(f"{address}/exercises/{NAME}.html")
    page.locator("main details > summary").first.click()
    page.reload()
    assert page.locator("main details").first.evaluate("fold => fold.open")
    assert not page.locator("main details").nth(1).evaluate("fold => fold.open")
    page.context.close()
