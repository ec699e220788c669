"""Questions as readers answer them: right, wrong, wrong in other ways, by keyboard, without cryptography."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

pytestmark = [pytest.mark.book, pytest.mark.browser]

NO_SUBTLE = "Object.defineProperty(globalThis, 'crypto', {value: {}})"


@pytest.fixture
def page(browser: Any, questions_site: Path) -> Iterator[Any]:
    """The page, from the disk."""
    page = browser.new_page(viewport={"width": 390, "height": 800})
    page.goto(f"{questions_site.as_uri()}/book/questions.html")
    page.keyboard.press("Shift")  # at any sign of a reader all fields come
    yield page
    page.close()


def answer(page: Any, name: str, *entries: str) -> str:
    """Fill in and check; return what the page says."""
    form = page.locator(f"#question-{name}")
    for field, entry in zip(form.locator("input[type=text]").all(), entries, strict=True):
        field.fill(entry)
    return check(page, name)


def check(page: Any, name: str) -> str:
    form = page.locator(f"#question-{name}")
    form.get_by_role("button", name="Check").click()
    page.wait_for_selector(f"#question-{name}:is([data-state=right], [data-state=wrong], [data-state=unread])")
    return str(form.locator("output").inner_text())


@pytest.mark.parametrize("entry", ["0.432", "0,432", "0.4318", " .4318 m", "4318/10000"])
def test_the_right_number(page: Any, entry: str) -> None:
    assert answer(page, "reach", entry).startswith("Right. The upper arm")


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("0.15", "Not yet. That is the other link"),
        ("0,15005", "Not yet. That is the other link"),
        ("431.8", "Not yet. That is in mm."),
        ("7", "Not yet. Look at the table."),
        ("", "Nothing stands here yet."),
        ("about half", "Write a number"),
        ("25°", "The answer is asked for in m."),
        ("0.4.3", "one decimal point"),
    ],
)
def test_what_is_not_right_is_told_why(page: Any, entry: str, said: str) -> None:
    assert said in answer(page, "reach", entry)


def test_a_matrix(page: Any) -> None:
    assert answer(page, "turn", "sqrt(3)/2", "-1/2", "0,5", "0.866").startswith("Right.")
    assert "the other way" in answer(page, "turn", "0.866", "0.5", "-0.5", "cos(30°)")
    assert answer(page, "turn", "1", "0", "0", "1") == "Not yet."
    said = answer(page, "turn", "1", "", "0", "1")
    assert said == "Row 1, column 2: Nothing stands here yet."
    assert page.evaluate("document.activeElement.getAttribute('aria-label')") == "Row 1, column 2"


def test_a_row_with_an_angle(page: Any) -> None:
    assert answer(page, "row", "-90°", "20 mm").startswith("Right.")
    assert answer(page, "row", "270", "20").startswith("Right.")
    assert answer(page, "row", "90", "20") == "Not yet."


def test_choices(page: Any) -> None:
    mirror, valid = page.locator("#question-mirror input"), page.locator("#question-valid input")
    assert "Choose" in check(page, "mirror")
    mirror.nth(0).check()
    assert "is a rotation" in check(page, "mirror")
    mirror.nth(1).check()
    assert check(page, "mirror").startswith("Right.")
    valid.nth(0).check()
    assert "One is missing" in check(page, "valid")
    valid.nth(2).check()
    assert check(page, "valid") == "Right. Both of them."


def test_fields_come_when_they_are_near_or_the_reader_does_anything(browser: Any, address: str) -> None:
    """Until then the browser would have all laid out that is far, to ask whether they are seen."""
    page = browser.new_page(viewport={"width": 390, "height": 800})
    left = "document.querySelectorAll('.dh-field').length"
    page.goto(f"{address}/book/classic.html")
    every = page.evaluate(left)
    assert every > 20
    page.locator("form.dh-question").first.scroll_into_view_if_needed()
    page.locator("form.dh-question input").first.wait_for()
    assert 0 < page.evaluate(left) < every
    page.keyboard.press("Shift")
    page.wait_for_function(f"{left} === 0")
    assert page.evaluate("document.querySelectorAll('form.dh-question input').length") == every
    page.close()


def test_by_keyboard_alone(page: Any) -> None:
    page.locator("#question-reach input").focus()
    page.keyboard.type("0.432")
    page.keyboard.press("Enter")
    page.wait_for_selector("#question-reach[data-state=right]")
    page.keyboard.type("1")
    page.wait_for_selector("#question-reach[data-state=open]")
    output = page.locator("#question-reach output")
    assert output.inner_text() == "", "a changed answer is no longer judged"
    assert output.get_attribute("aria-live") == "polite"


def test_formulas_in_what_is_said_are_drawn(page: Any) -> None:
    answer(page, "reach", "0.432")
    missing = """() => [...document.querySelectorAll('output use')]
        .filter(use => !document.querySelector(use.getAttribute('href'))).length"""
    assert page.locator("#question-reach output use").count() > 0
    assert page.evaluate(missing) == 0


def test_where_the_browser_has_no_cryptography(browser: Any, questions_site: Path) -> None:
    page = browser.new_page()
    page.add_init_script(NO_SUBTLE)
    page.goto(f"{questions_site.as_uri()}/book/questions.html")
    page.keyboard.press("Shift")  # at any sign of a reader all fields come
    assert page.evaluate("globalThis.crypto.subtle === undefined")
    assert answer(page, "reach", "0.432").startswith("Right.")
    assert "other link" in answer(page, "reach", "0.15")
    page.close()


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_axe_finds_nothing(browser: Any, questions_site: Path, root: Path, theme: str) -> None:
    page = browser.new_page(color_scheme=theme)
    page.goto(f"{questions_site.as_uri()}/book/questions.html")
    page.keyboard.press("Shift")  # at any sign of a reader all fields come
    answer(page, "reach", "7")
    answer(page, "row", "-90", "20")
    page.add_script_tag(path=str(root / "node_modules/axe-core/axe.min.js"))
    find = "async () => (await axe.run('.dh-question')).violations.map(v => `${v.id}: ${v.nodes[0].html}`)"
    assert page.evaluate(find) == []
    page.locator("#question-reach input").evaluate("field => field.removeAttribute('aria-label')")
    assert page.evaluate(find), "a field without a name would be found"
    page.close()


def test_print_shows_the_question_alone(page: Any) -> None:
    answer(page, "reach", "0.432")
    page.emulate_media(media="print")
    form = page.locator("#question-reach")
    assert form.get_by_text("How long is").is_visible()
    assert not form.get_by_role("button").is_visible()
    assert "upper arm" not in form.inner_text()


# What stands in the page


def secrets(site: Path) -> dict[str, list[str]]:
    """Return, for each question, what must not stand in the site: all that it says."""
    (kept,) = (site.parent / "jupyter_execute" / "book").glob("*.glue.json")
    found = {}
    for name, glued in json.loads(kept.read_text("utf-8")).items():
        if name.startswith("question "):
            question = json.loads(glued["data"]["text/question"])
            found[name.removeprefix("question ")] = [
                re.split(r"[$*`\[]", answer["says"])[0].strip() for answer in question["answers"]
            ]
    return found


def told(text: str, says: dict[str, list[str]]) -> list[str]:
    """Return the secrets that a text tells."""
    return [words for all_words in says.values() for words in all_words if len(words) > 6 and words in text]


def test_no_feedback_stands_in_the_site(questions_site: Path) -> None:
    says = secrets(questions_site)
    assert len(says) == 5
    for path in questions_site.rglob("*"):
        if path.is_file() and path.suffix in {".html", ".js", ".json", ".md", ".ipynb", ".txt", ".inv"}:
            assert told(html.unescape(path.read_text("utf-8", errors="ignore")), says) == [], path


def test_feedback_in_the_site_would_be_found(questions_site: Path) -> None:
    page = (questions_site / "book" / "questions.html").read_text("utf-8")
    assert told(page + "That is in `mm`.", secrets(questions_site)) == ["That is in"]


def numbers_in(page: str, name: str) -> set[str]:
    """Return the numbers that stand in a question, what is sealed left out."""
    (form,) = re.findall(rf'<form class="dh-question" id="question-{name}".*?</form>', page, re.DOTALL)
    form = re.sub(r'"records": \[[^]]*\]|<svg.*?</svg>', "", form, flags=re.DOTALL)
    return set(re.findall(r"(?<![\w.])-?\d*\.?\d+(?![\w.])", form))


def test_no_answer_stands_in_the_page(questions_site: Path) -> None:
    page = (questions_site / "book" / "questions.html").read_text("utf-8")
    answer = {"0.432", "0.4318", "431.8", "0.15", "0.15005", "0.150"}
    assert not numbers_in(page, "reach") & answer
    planted = page.replace('id="question-reach"', 'id="question-reach" data-hint="0.4318"')
    assert numbers_in(planted, "reach") & answer == {"0.4318"}
