"""Drag a handle of ``{dh-link}`` on a simulated phone, and say how many pictures a second are drawn.

Chromium runs four times slower (its CPU throttle). Beside the rate, which other work on this machine disturbs, stands
the processor time that a picture takes: 60 a second leave 16.7 ms throttled, 4.2 ms unthrottled.

    python bench/web/drag.py _build/html
"""

from __future__ import annotations

import argparse
import math
import statistics
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).parents[2] / "book" / "build"))
import chromium
from playwright.sync_api import sync_playwright

PICTURES = 180
COUNT = """() => { window.times = []; const tick = now => { times.push(now); requestAnimationFrame(tick); };
    requestAnimationFrame(tick); }"""


def busy(session: Any) -> float:
    """Return the processor time of the page so far, in seconds."""
    return float({m["name"]: m["value"] for m in session.send("Performance.getMetrics")["metrics"]}["TaskDuration"])


def drag(page: Any, session: Any, grip: str, slowed: int) -> tuple[float, float]:
    """Drag one handle round and round; returns pictures a second (median) and processor time for each, in ms."""
    session.send("Emulation.setCPUThrottlingRate", {"rate": slowed})
    page.locator("dh-link .stage").first.scroll_into_view_if_needed()
    box = page.locator(f"dh-link [data-grip={grip}]").first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.evaluate(COUNT)
    before = busy(session)
    for k in range(PICTURES):
        turn = 2 * math.pi * k / 60
        page.mouse.move(x + 40 * math.sin(turn), y + 40 * (1 - math.cos(turn)))
    spent = busy(session) - before
    page.mouse.up()
    times = page.evaluate("times")
    gaps = [later - earlier for earlier, later in pairwise(times)]
    return 1000 / statistics.median(gaps), 1000 * spent / max(1, len(times))


def main() -> None:
    """Measure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("site", type=Path)
    parser.add_argument("--page", default="book/classic.html")
    choice = parser.parse_args()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium.find(), args=["--no-sandbox"])
        for grip in ("theta", "alpha", "d", "a"):
            for slowed in (1, 4):
                context = browser.new_context(viewport={"width": 390, "height": 800}, device_scale_factor=2)
                page = context.new_page()
                session = context.new_cdp_session(page)
                session.send("Performance.enable", {"timeDomain": "threadTicks"})
                page.goto(f"{choice.site.resolve().as_uri()}/{choice.page}")
                page.wait_for_timeout(500)
                rate, cost = drag(page, session, grip, slowed)
                print(
                    f"{grip:6} slowed {slowed}x: {rate:5.1f} pictures a second, {cost:5.2f} ms of processor time each"
                )
                context.close()
        browser.close()


if __name__ == "__main__":
    main()
