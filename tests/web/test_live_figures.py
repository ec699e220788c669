"""The live figures, driven as readers do: by pointer, touch and keys, in light and dark, wide and narrow."""

from __future__ import annotations

import math
import re
import subprocess
import sys
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
from building import build_book
from sources import ROOT, book_of_one_page

from dhlib import Chain, Revolute, check_frames, classic, modified, place_frames, robots

sys.path.append(str(Path(__file__).parent))
from conftest import PAGE

pytestmark = [pytest.mark.book, pytest.mark.browser]

LINKS = ["#live-fig-live-link", "#live-link-2"]
ROBOTS = {"#live-fig-pa10": robots.pa10_7c(), "#live-robot-2": robots.stanford()}
PLACES = {"#live-fig-quickshot": robots.quickshot(), "#live-place-2": robots.puma560().to_modified()}
EVERY = [*LINKS, *ROBOTS, *PLACES]

THREE_MINUTES = 180_000


def wake(page: Any) -> None:
    """Scroll past every figure, so that what loads late loads."""
    for figure in EVERY:
        page.locator(figure).evaluate("figure => figure.scrollIntoView({behavior: 'instant'})")
        drawn(page)
    awake = "[...document.querySelectorAll('dh-robot')].every(r => r.space || !r.canvas.isConnected)"
    page.wait_for_function(awake, timeout=THREE_MINUTES)
    page.wait_for_timeout(100)


def drawn(page: Any) -> None:
    """Wait until what was asked for is on the screen."""
    page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


def shown_matrix(page: Any, figure: str) -> np.ndarray:
    """Return the matrix that a figure shows."""
    drawn(page)
    texts = page.locator(f"{figure} .matrix tbody td:not(.corner)").all_inner_texts()
    texts = [text for text in texts if text.strip()]
    return np.array([float(text.replace("−", "-")) for text in texts]).reshape(4, 4)


def state(page: Any, figure: str) -> dict[str, Any]:
    answer: dict[str, Any] = page.evaluate(f"document.querySelector('{figure}').state")
    return answer


def link_matrix(convention: str, theta: float, d: float, a: float, alpha: float) -> np.ndarray:
    theta, alpha = math.radians(theta), math.radians(alpha)
    return classic(theta, d, a, alpha) if convention == "classic" else modified(alpha, a, theta, d)


def broken_drawing(page: Any) -> list[str]:
    """Return what is not a number in any drawing."""
    found: list[str] = page.evaluate(
        """() => [...document.querySelectorAll('dh-link, dh-robot, dh-place')].flatMap(figure =>
            [...figure.shadowRoot.querySelectorAll('svg *')].map(e => e.outerHTML)
                .filter(t => /NaN|undefined|Infinity/.test(t)))"""
    )
    return found


# The page


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
@pytest.mark.parametrize("scheme", ["http", "file"])
def test_every_figure_lives_and_asks_no_stranger(
    browser: Any, figures: Path, home: str, scheme: str, width: int, theme: str
) -> None:
    own, base = (home, home) if scheme == "http" else ("file://", figures.as_uri())
    context = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=theme)
    page = context.new_page()
    strangers: list[str] = []
    complaints: list[str] = []

    def guard(route: Any) -> None:
        url = urlsplit(route.request.url)
        if url.scheme in {"data", "blob"} or f"{url.scheme}://{url.netloc}" == own:
            route.continue_()
        else:
            strangers.append(route.request.url)
            route.abort()

    page.route("**/*", guard)
    page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
    page.on("pageerror", lambda error: complaints.append(str(error)))
    page.goto(f"{base}/book/page.html")
    wake(page)
    assert page.evaluate("document.documentElement.dataset.theme") == theme
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    for figure in EVERY:
        assert page.locator(f"{figure} svg .arrow").count() >= 4, figure
    for figure in ROBOTS:
        assert page.evaluate(f"document.querySelector('{figure}').space.renderer.info.render.triangles") > 1000
    assert not broken_drawing(page)
    context.close()
    assert not strangers
    assert not complaints


def test_three_comes_only_when_a_robot_comes_near(browser: Any, home: str) -> None:
    page = browser.new_page(viewport={"width": 1280, "height": 400})
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(f"{home}/book/page.html")
    page.wait_for_timeout(300)
    assert not [url for url in asked if "space.js" in url]
    page.locator("dh-robot").first.scroll_into_view_if_needed()
    page.wait_for_function("document.querySelector('dh-robot').space")
    assert len([url for url in asked if "space.js" in url]) == 1
    page.close()


def test_nothing_shifts(browser: Any, home: str) -> None:
    for width in (1280, 390):
        page = browser.new_page(viewport={"width": width, "height": 800})
        page.add_init_script(
            "window.shifts = 0; new PerformanceObserver(list => list.getEntries().forEach(e => { shifts += e.value }))"
            ".observe({type: 'layout-shift', buffered: true})"
        )
        page.goto(f"{home}/book/page.html")
        wake(page)
        assert page.evaluate("shifts") < 0.05
        page.close()


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_axe_finds_nothing(browser: Any, home: str, width: int, theme: str) -> None:
    context = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=theme, reduced_motion="reduce")
    page = context.new_page()
    page.goto(f"{home}/book/page.html")
    wake(page)
    page.locator(LINKS[0]).get_by_role("button", name="One step on").click()
    assert violations(page) == []
    context.close()


def test_axe_would_find_an_input_without_a_name(page: Any) -> None:
    page.evaluate(
        f"document.querySelector('{LINKS[0]}').sliders.d.range.removeAttribute('aria-label');"
        f"document.querySelector('{LINKS[0]}').sliders.d.element.querySelector('label').remove()"
    )
    assert any(found.startswith("label") for found in violations(page))


def violations(page: Any) -> list[str]:
    """Return what axe-core finds against WCAG 2.2 A and AA within the figures."""
    page.add_script_tag(path=str(ROOT / "node_modules/axe-core/axe.min.js"))
    found: list[str] = page.evaluate(
        """async () => {
            const tags = ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22a', 'wcag22aa'];
            const {violations} = await axe.run({include: [['dh-link'], ['dh-robot'], ['dh-place']]}, {runOnly: tags});
            return violations.flatMap(v => v.nodes.map(n => `${v.id}: ${n.target.flat()} ${n.failureSummary}`));
        }"""
    )
    return found


def test_without_scripts_a_still_picture_stands_in_the_page(browser: Any, home: str) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto(f"{home}/book/page.html")
    for figure in EVERY:
        still = page.locator(f"{figure} > svg")
        assert still.is_visible()
        assert len(still.get_attribute("aria-label")) > 40
    context.close()


def test_print_shows_pictures_and_no_controls(page: Any) -> None:
    wake(page)
    page.emulate_media(media="print")
    for figure in LINKS:
        assert page.locator(f"{figure} .stage svg").is_visible()
        assert page.locator(f"{figure} .matrix").is_visible()
        assert not page.locator(f"{figure} .sliders").is_visible()
        assert not page.locator(f"{figure} > svg").is_visible()
    for figure in [*ROBOTS, *PLACES]:
        assert page.locator(f"{figure} > svg").is_visible()
        assert not page.locator(f"{figure} .live").is_visible()


def test_without_webgl_the_arm_is_drawn_flat_and_still_moves(browser: Any, home: str) -> None:
    page = browser.new_page(viewport={"width": 1280, "height": 900})
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto(f"{home}/book/page.html")
    wake(page)
    figure = "#live-fig-pa10"
    assert page.locator(f"{figure} canvas").count() == 0
    assert page.locator(f"{figure} .cylinder").count() >= 7
    before = shown_matrix(page, figure)
    page.locator(f"{figure} input[type=range]").nth(1).press("End")
    assert np.abs(shown_matrix(page, figure) - before).max() > 0.1
    page.close()
    assert not errors


def test_a_broken_drawing_would_be_found(page: Any) -> None:
    assert not broken_drawing(page)
    page.evaluate(f"document.querySelector('{LINKS[0]}').change({{d: NaN}}, false)")
    drawn(page)
    assert broken_drawing(page)


# {dh-link}


@pytest.mark.parametrize("figure", LINKS)
@pytest.mark.parametrize("convention", ["classic", "modified"])
def test_every_slider_end_shows_the_matrix_of_dhlib(page: Any, figure: str, convention: str) -> None:
    page.locator(figure).get_by_role("radio", name=convention).check()
    sliders = page.locator(f"{figure} input[type=range]")
    assert sliders.count() == 4
    for k in range(4):
        for key in ("Home", "End"):
            slider = sliders.nth(k)
            slider.press(key)
            assert slider.input_value() == slider.get_attribute("min" if key == "Home" else "max")
            expected = link_matrix(**state(page, figure))
            assert np.abs(shown_matrix(page, figure) - expected).max() < 6e-4 * max(1, np.abs(expected).max() / 10)
    assert not broken_drawing(page)


def test_all_corners_of_the_parameters_can_be_drawn(page: Any) -> None:
    """Every combination of ends and zeros, in both conventions, at every step, seen from every side."""
    page.evaluate(
        f"""() => {{
            const figure = document.querySelector('{LINKS[0]}');
            const [ends, turns] = [[-2, 0, 2], [-180, -90, 0, 180]];
            for (const convention of ['classic', 'modified'])
            for (const theta of turns) for (const d of ends) for (const a of ends) for (const alpha of turns)
            for (const progress of [0, 0.5, 2, 4]) {{
                figure.change({{convention, theta, d, a, alpha}}, true);
                figure.progress = progress;
                figure.stage.turn(37, progress === 2 ? 90 : -20);
                figure.draw();
                const drawn = figure.stage.svg.outerHTML;
                if (/NaN|undefined|Infinity/.test(drawn)) throw Error(JSON.stringify(figure.state));
            }}
        }}"""
    )


@pytest.mark.parametrize("convention", ["classic", "modified"])
def test_the_four_steps_build_the_matrix_and_mark_what_changes(page: Any, convention: str) -> None:
    figure = LINKS[0]
    page.locator(figure).get_by_role("radio", name=convention).check()
    values = state(page, figure)
    order = ["theta", "d", "a", "alpha"] if convention == "classic" else ["alpha", "a", "theta", "d"]
    done = {"convention": convention, "theta": 0.0, "d": 0.0, "a": 0.0, "alpha": 0.0}
    for k, name in enumerate(order, 1):
        before = link_matrix(**done)
        done[name] = values[name]
        after = link_matrix(**done)
        page.locator(figure).get_by_role("button", name="One step on").click()
        assert np.abs(shown_matrix(page, figure) - after).max() < 6e-4
        cells = page.locator(f"{figure} .matrix tbody td:not(.corner)")
        marked = ["changed" in (cell.get_attribute("class") or "") for cell in cells.all()]
        assert marked == (np.abs(after - before).ravel() > 1e-9).tolist()
        sentence = page.locator(f"{figure} .sentence").inner_text()
        assert (f"Step {k} of 4" in sentence) == (k < 4)
    page.locator(figure).get_by_role("button", name="One step back").click()
    drawn(page)
    assert "Step 3 of 4" in page.locator(f"{figure} .sentence").inner_text()


def test_play_moves_the_ghost_and_ends_with_the_link(browser: Any, home: str) -> None:
    page = browser.new_page(viewport={"width": 1280, "height": 900}, reduced_motion="no-preference")
    page.goto(f"{home}/book/page.html")
    page.locator(LINKS[0]).get_by_role("button", name="Play the steps").click()
    page.wait_for_timeout(400)
    part = page.evaluate(f"document.querySelector('{LINKS[0]}').progress")
    assert 0 < part < 1
    assert page.locator(f"{LINKS[0]} .ghost").count() > 0
    page.wait_for_function(f"document.querySelector('{LINKS[0]}').progress === 4", timeout=10_000)
    page.wait_for_timeout(50)
    assert page.locator(f"{LINKS[0]} .ghost").count() == 0
    page.close()


def test_without_motion_a_step_is_done_at_once(page: Any) -> None:
    page.locator(LINKS[0]).get_by_role("button", name="step 1").click()
    assert page.evaluate(f"document.querySelector('{LINKS[0]}').progress") == 1


def test_a_handle_can_be_dragged(page: Any) -> None:
    for name, key in (("d", "d"), ("a", "a"), ("theta", "theta"), ("alpha", "alpha")):
        before = state(page, LINKS[0])
        page.locator(LINKS[0]).scroll_into_view_if_needed()
        box = page.locator(f"{LINKS[0]} [data-grip={name}]").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 22, y + 30, steps=5)
        page.mouse.up()
        after = state(page, LINKS[0])
        assert [changed for changed in before if before[changed] != after[changed]] == [key]
        page.locator(LINKS[0]).get_by_role("button", name="Reset").click()


def test_the_view_turns_by_pointer_and_keys(page: Any) -> None:
    for figure in EVERY:
        ground = page.locator(f"{figure} .stage")
        ground.scroll_into_view_if_needed()
        view = f"document.querySelector('{figure}').stage.view"
        first = page.evaluate(view)
        ground.focus()
        page.keyboard.press("ArrowRight")
        page.keyboard.press("ArrowUp")
        turned = page.evaluate(view)
        assert turned["azimuth"] != first["azimuth"]
        assert turned["elevation"] != first["elevation"]
        page.keyboard.press("Home")
        assert page.evaluate(view) == first
        box = ground.bounding_box()
        page.mouse.move(box["x"] + 12, box["y"] + 12)
        page.mouse.down()
        page.mouse.move(box["x"] + 80, box["y"] + 40, steps=4)
        page.mouse.up()
        assert page.evaluate(view) != first


def test_touch_drags_a_slider_a_handle_and_the_view(browser: Any, home: str) -> None:
    context = browser.new_context(
        viewport={"width": 390, "height": 800}, has_touch=True, is_mobile=True, reduced_motion="reduce"
    )
    page = context.new_page()
    page.goto(f"{home}/book/page.html")
    touch = context.new_cdp_session(page)

    def drag(x: float, y: float, dx: float, dy: float) -> None:
        touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [{"x": x, "y": y}]})
        for k in range(1, 6):
            point = {"x": x + dx * k / 5, "y": y + dy * k / 5}
            touch.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [point]})
        touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    def middle(selector: str) -> tuple[float, float]:
        box = page.locator(selector).first.bounding_box()
        return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2

    page.locator(f"{LINKS[0]} .sliders").scroll_into_view_if_needed()
    before = state(page, LINKS[0])
    x, y = middle(f"{LINKS[0]} input[type=range]")
    drag(x, y, 50, 0)
    moved = state(page, LINKS[0])
    assert moved["theta"] != before["theta"]
    drawn(page)
    drag(*middle(f"{LINKS[0]} [data-grip=d]"), 0, -40)
    assert state(page, LINKS[0])["d"] > moved["d"]
    view = f"document.querySelector('{LINKS[0]}').stage.view.azimuth"
    first = page.evaluate(view)
    box = page.locator(f"{LINKS[0]} .stage").bounding_box()
    drag(box["x"] + 20, box["y"] + 15, 90, 0)
    assert page.evaluate(view) != first
    context.close()


def test_keys_alone_reach_everything(page: Any) -> None:
    """Tab visits each control once, in the order of the page, and each does its work by keys."""
    page.evaluate("document.querySelector('dh-link').shadowRoot.querySelector('input').focus()")
    visited = []
    for _ in range(18):
        visited.append(
            page.evaluate(
                """() => { const e = document.activeElement.shadowRoot?.activeElement;
                return e && (e.getAttribute('aria-label') || e.textContent || e.labels[0].textContent); }"""
            )
        )
        page.keyboard.press("Tab")
    assert visited[0] == "classic"
    assert visited[1:3] == ["Reset", "Copy link"]
    assert visited[3].startswith("Drawing")
    assert [re.findall(r"step \d", name) for name in visited[4:8]] == [[f"step {k}"] for k in range(1, 5)]
    assert visited[8:11] == ["One step back", "One step on", "Play the steps"]
    assert visited[11:13] == ["θi joint angle", "θ i, joint angle, degrees"]
    assert [name.split()[0] for name in visited[13::2]] == ["di", "ai", "αi"]

    figure = LINKS[0]
    page.locator(f"{figure} input[type=radio]").first.focus()
    page.keyboard.press("ArrowRight")
    assert state(page, figure)["convention"] == "modified"
    page.locator(f"{figure} input[type=range]").first.focus()
    before = state(page, figure)["alpha"]
    page.keyboard.press("ArrowRight")
    assert state(page, figure)["alpha"] == before + 1
    page.keyboard.press("Tab")
    page.keyboard.press("Control+A")
    page.keyboard.type("-37.5")
    page.keyboard.press("Enter")
    assert state(page, figure)["alpha"] == -37.5
    page.keyboard.press("Control+A")
    page.keyboard.type("999")
    page.keyboard.press("Enter")
    assert state(page, figure)["alpha"] == 180


def test_a_listener_hears_the_state_once_the_hand_rests(page: Any) -> None:
    figure = LINKS[0]
    slider = page.locator(f"{figure} input[type=range]").nth(3)
    slider.press("Home")
    assert slider.get_attribute("aria-valuetext") == "−180 degrees"
    status = page.locator(f"{figure} [role=status]")
    page.wait_for_timeout(700)
    heard = status.inner_text()
    assert "classic convention" in heard
    assert "parallel and point opposite ways, 1.6 apart" in heard
    page.locator(f"{figure} input[type=range]").nth(2).fill("0")
    page.wait_for_timeout(700)
    assert "lie on one line" in status.inner_text()


def test_a_shared_address_brings_the_values_back(page: Any, browser: Any) -> None:
    figure = LINKS[1]
    page.locator(f"{figure} input[type=range]").nth(1).press("End")
    page.locator(figure).get_by_role("radio", name="classic").check()
    page.locator(figure).get_by_role("button", name="Copy link").click()
    page.wait_for_function("location.hash.includes('?')")
    other = browser.new_page()
    other.goto(page.url)
    assert state(other, figure) == state(page, figure)
    other.goto(re.sub(r"#.*", f"#{figure[1:]}?theta=nonsense&d=1e9&convention=<b>&a=", page.url))
    other.reload()
    assert state(other, figure) == {"convention": "modified", "theta": 30, "d": 400, "a": 0, "alpha": -90} | {
        "a": state(other, figure)["a"]
    }
    other.close()


def test_reset_brings_everything_back(page: Any) -> None:
    figure = LINKS[0]
    first = state(page, figure)
    for k in range(4):
        page.locator(f"{figure} input[type=range]").nth(k).press("Home")
    page.locator(figure).get_by_role("button", name="Reset").click()
    assert state(page, figure) == first
    assert page.locator(f"{figure} input[type=range]").first.input_value() == str(first["theta"])


# {dh-robot}


@pytest.mark.parametrize(("figure", "arm"), ROBOTS.items())
def test_every_joint_end_shows_the_pose_of_dhlib(page: Any, figure: str, arm: Chain) -> None:
    wake(page)
    sliders = page.locator(f"{figure} input[type=range]")
    assert sliders.count() == arm.n + page.locator(f"{figure} .slider.elbow").count()
    for k in range(arm.n):
        for key, end in (("Home", 0), ("End", 1)):
            sliders.nth(k).press(key)
            q = page.evaluate(f"document.querySelector('{figure}').joints")
            limits = arm.joints[k].limits
            if limits:
                assert min(limits) - 1e-9 <= q[k] <= max(limits) + 1e-9
                assert abs(q[k] - limits[end]) < math.radians(1)
            assert np.abs(shown_matrix(page, figure) - arm.fk(q)).max() < 6e-4
    assert not broken_drawing(page)


def test_both_tables_are_those_of_dhlib_and_a_link_is_marked_in_both(page: Any) -> None:
    figure, arm = "#live-robot-2", robots.stanford()
    page.locator(f"{figure} select").select_option("2")
    drawn(page)
    tables = page.locator(f"{figure} table.dh")
    for k, chain in enumerate((arm.to_classic(), arm.to_modified())):
        cells = [text.replace("−", "-").rstrip("°") for text in tables.nth(k).locator("tbody td").all_inner_texts()]
        shown = np.array([float(text) for text in cells]).reshape(-1, 4)
        rows = []
        for joint in chain.joints:
            theta, d = joint.at(0.0)
            row = [math.degrees(theta), d, joint.a, math.degrees(joint.alpha)]
            rows.append(row if chain.convention == "classic" else [row[3], row[2], row[0], row[1]])
        assert np.abs(shown - np.array(rows)).max() < 1e-3
    marked = [tables.nth(k).locator("tr", has=page.locator("td.marked")).locator("th").inner_text() for k in range(2)]
    assert marked == ["2", "3"]
    assert "row 2 of the classic table, and in row 3 of the modified table" in (
        page.locator(f"{figure} .sentence").inner_text()
    )


def test_trace_and_elbow_circle_are_drawn(page: Any) -> None:
    figure = "#live-fig-pa10"
    page.locator(figure).get_by_label("path of the tool").check()
    page.locator(figure).get_by_label("elbow circle").check()
    slider = page.locator(f"{figure} input[type=range]").first
    for _ in range(5):
        slider.press("PageUp")
        page.wait_for_timeout(50)
    assert page.evaluate(f"document.querySelector('{figure}').trace.length") >= 5
    assert page.locator(f"{figure} path.trace").count() == 1
    assert page.locator(f"{figure} path.circle").count() == 1
    assert not page.locator("#live-robot-2").get_by_label("elbow circle").is_visible()


def test_the_elbow_goes_round_while_the_hand_rests(page: Any) -> None:
    """By slider and by its handle, from end to end; a joint at its limit stops it, and the page says which."""
    figure, arm = "#live-fig-pa10", robots.pa10_7c()
    wake(page)
    hand = arm.fk(page.evaluate(f"document.querySelector('{figure}').joints"))

    def rests() -> list[float]:
        q: list[float] = page.evaluate(f"document.querySelector('{figure}').joints")
        assert np.abs(arm.fk(q) - hand).max() < 1e-9
        assert np.abs(shown_matrix(page, figure) - hand).max() < 6e-4
        for value, joint in zip(q, arm.joints, strict=True):
            assert joint.limits[0] - 1e-9 <= value <= joint.limits[1] + 1e-9
        return q

    slider = page.locator(f"{figure} .slider.elbow input[type=range]")
    first = rests()
    for key in ("ArrowRight", "PageUp", "End", "Home"):
        slider.press(key)
        before, first = first, rests()
        assert np.abs(np.subtract(first, before)).max() > 0.01, key
    assert "Joint 2 is at its limit, 91°" in page.locator(f"{figure} .sentence").inner_text()
    assert abs(float(slider.input_value())) < 180
    assert page.locator(f"{figure} path.circle").count() == 1
    assert "limit" in (page.locator(f"{figure} .stage svg").get_attribute("aria-label") or "")

    page.locator(figure).get_by_role("button", name="Reset").click()
    drawn(page)
    page.locator(f"{figure} .stage").scroll_into_view_if_needed()
    box = page.locator(f"{figure} [data-grip=elbow]").bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 40, box["y"] + 40, steps=4)
    page.mouse.up()
    assert abs(page.evaluate(f"document.querySelector('{figure}').elbowAngle")) > 0.1
    rests()
    # a joint moved by itself moves the hand, and the elbow's slider follows
    page.locator(f"{figure} input[type=range]").nth(3).press("PageUp")
    q = page.evaluate(f"document.querySelector('{figure}').joints")
    assert np.abs(arm.fk(q) - hand).max() > 0.01


def test_a_cell_can_set_and_read_the_joints(page: Any) -> None:
    q = [0.1, -0.2, 0.3, 0.4, -0.5, 0.6, 0.7]
    page.evaluate(f"document.querySelector('#live-fig-pa10').take({{q: {q}}})")
    assert np.allclose(page.evaluate("document.querySelector('#live-fig-pa10').joints"), q)
    assert np.abs(shown_matrix(page, "#live-fig-pa10") - robots.pa10_7c().fk(q)).max() < 6e-4


# {dh-place}


def placed_frames(page: Any, figure: str) -> np.ndarray:
    """Return where the frames of a figure stand, worked out here from what its sliders say."""
    carriers, placed = page.evaluate(
        f"(figure => [figure.carriers, figure.placed])(document.querySelector('{figure}'))"
    )
    poses = []
    for carrier, choice in zip(carriers, placed, strict=True):
        point, direction, reference = (np.array(carrier[key]) for key in ("point", "direction", "reference"))
        phi = math.radians(choice["phi"])
        x = math.cos(phi) * reference + math.sin(phi) * np.cross(direction, reference)
        z = choice["sense"] * direction
        pose = np.eye(4)
        pose[:3, :3] = np.column_stack([x, np.cross(z, x), z])
        pose[:3, 3] = point + choice["s"] * direction
        poses.append(pose)
    return np.array(poses)


def put(page: Any, figure: str, frames: np.ndarray) -> None:
    """Place frames as a reader does, by choosing each and typing, and turning z over."""
    for i, pose in enumerate(frames):
        page.locator(f"{figure} .choice input").nth(i).check()
        carrier, now = page.evaluate(
            f"(figure => [figure.carriers[{i}], figure.placed[{i}]])(document.querySelector('{figure}'))"
        )
        point, direction, reference = (np.array(carrier[key]) for key in ("point", "direction", "reference"))
        assert abs(pose[:3, 2] @ direction) > 1 - 1e-9
        if np.sign(pose[:3, 2] @ direction) != now["sense"]:
            page.locator(figure).get_by_role("button", name="over").click()
        s = (pose[:3, 3] - point) @ direction
        phi = math.degrees(math.atan2(pose[:3, 0] @ np.cross(direction, reference), pose[:3, 0] @ reference))
        for field, value in enumerate((s, phi)):
            page.locator(f"{figure} input[type=number]").nth(field).fill(f"{value:.4f}")
            page.locator(f"{figure} input[type=number]").nth(field).press("Enter")


@pytest.mark.parametrize(("figure", "arm"), PLACES.items())
def test_a_valid_choice_is_right_whatever_it_is(page: Any, figure: str, arm: Chain) -> None:
    frames = np.array(arm.frames(np.zeros(arm.n)))
    put(page, figure, frames)
    drawn(page)
    assert "your choice is right" in page.locator(f"{figure} .sentence").inner_text()
    # the other sense of a z axis, and of an x axis, are as good
    page.locator(f"{figure} .choice input").nth(1).check()
    page.locator(figure).get_by_role("button", name="over").click()
    drawn(page)
    assert "your choice is right" in page.locator(f"{figure} .sentence").inner_text()
    assert not broken_drawing(page)


def test_what_fails_is_what_dhlib_says(page: Any) -> None:
    rng = np.random.default_rng(3)
    for figure, arm in PLACES.items():
        for _ in range(15):
            page.locator(f"{figure} .choice input").nth(int(rng.integers(arm.n + 1))).check()
            slider = page.locator(f"{figure} input[type=range]").nth(int(rng.integers(2)))
            for key in rng.choice(["ArrowRight", "ArrowLeft", "PageUp", "PageDown", "Home", "End"], 3):
                slider.press(str(key))
            drawn(page)
            report = check_frames(placed_frames(page, figure), arm.convention, tol=1e-6)
            cells = page.locator(f"{figure} .checks td").all_inner_texts()
            expected = [holds for link in report.links for holds in (link.dh1, link.dh2)]
            assert [text.startswith("✓") for text in cells] == expected


def test_sliders_stop_at_the_feet_of_the_normals(page: Any) -> None:
    """A reader finds a right placement with the arrow keys alone."""
    figure = "#live-fig-quickshot"
    frames = np.array(place_frames(robots.quickshot().axes(), "classic").chain.frames(np.zeros(4)))
    page.locator(f"{figure} .choice input").nth(1).check()
    mark = page.evaluate(f"document.querySelector('{figure}').carriers[1].landmarks.s[1]")
    slider = page.locator(f"{figure} input[type=range]").first
    slider.press("Home")
    reached = []
    for _ in range(90):
        slider.press("ArrowRight")
        reached.append(page.evaluate(f"document.querySelector('{figure}').placed[1].s"))
    assert mark in reached
    assert reached[-1] == page.evaluate(f"document.querySelector('{figure}').size")
    assert len(frames) == 5


# The directives


MISTAKES = {
    "```{dh-link}\n:a: 3\n```": "a is 3, beyond the reach of 2",
    "```{dh-link}\n:theta: 200\n```": "should be within ±180°",
    "```{dh-link}\n:convention: craig\n```": "craig",
    "```{dh-robot} quikshot\n```": "there is no robot 'quikshot'",
    "```{dh-robot} puma560\n:elbow:\n```": "no elbow circle",
    "```{dh-robot} planar\n:q: 1 2 3\n```": "q has 3 values",
    "```{dh-robot} pa10_7c\n:arguments: lengths=Z\n```": "lengths='Z'",
}


def test_each_mistake_in_a_directive_is_said(tmp_path: Path) -> None:
    copy = book_of_one_page(tmp_path / "copy", "# A page\n\n" + "\n\n".join(MISTAKES))
    built = build_book(copy, tmp_path, environment={"PYTHONPATH": str(copy)})
    assert built.returncode != 0
    assert [complaint for complaint in MISTAKES.values() if complaint not in built.stdout] == []


def test_scripts_stand_where_figures_do_and_nowhere_else(figures: Path) -> None:
    html = (figures / "book/page.html").read_text("utf-8")
    for kind in ("link", "robot", "place"):
        (at,) = [match.start() for match in re.finditer(rf'<script src="\.\./live/{kind}\.js\?v=\w+">', html)]
        assert at < html.index(f"<dh-{kind} ")
    assert {path.name for path in (figures / "live").iterdir()} == {"link.js", "robot.js", "place.js", "space.js"}
    assert "live/" not in (figures / "search.html").read_text("utf-8")


def test_latex_says_what_the_figure_shows(tmp_path: Path) -> None:
    (tmp_path / "conf.py").write_text(
        f"import sys; sys.path.append({str(ROOT / 'book/extensions')!r})\n"
        "project = 'p'; extensions = ['myst_parser', 'live_figures']; root_doc = 'index'"
    )
    (tmp_path / "index.md").write_text(PAGE, "utf-8")
    subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-b", "latex", str(tmp_path), str(tmp_path / "out")], check=True
    )
    (tex,) = (tmp_path / "out").glob("*.tex")
    assert "Frame i\\sphinxhyphen{}1 (dashed) and frame i of a link" in tex.read_text("utf-8")


def test_the_first_values_of_a_link_are_those_of_its_still_picture(figures: Path) -> None:
    """Both are made from the same options; the picture by dhlib."""
    html = (figures / "book/page.html").read_text("utf-8")
    element = re.search(r'<dh-link id="live-link-2"([^>]*)>', html)
    assert element
    given = dict(re.findall(r'([a-z]+)="([^"]*)"', element[1]))
    joint = Revolute(d=float(given["d"]), a=float(given["a"]), alpha=math.radians(float(given["alpha"])))
    assert (joint.d, joint.a, given["convention"]) == (120, 250, "modified")
