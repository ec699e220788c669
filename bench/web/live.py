"""Run code in a page of the built book, and say how long it takes: first Run, next Run, round trips to a figure.

A round trip sends joints from a cell to the figure, and reads them in the next cell; what a cell draws below itself is
measured alone. Beside the times stands what the reader's browser has fetched for it, as a host of static pages sends it
(compressed), and the load of this machine.

    python bench/web/live.py _build/html
"""

from __future__ import annotations

import argparse
import gzip
import os
import statistics
import sys
import threading
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

sys.path.append(str(Path(__file__).parents[2] / "book" / "build"))
import chromium
from playwright.sync_api import sync_playwright
from serve import server

PAGE, FIGURE = "book/quickshot.html", "fig-quickshot-live"
TRIPS = 41
BEGIN = f"""from dhlib import robots
from dhlib.live import live_figure
figure = live_figure({FIGURE!r}, robots.quickshot())"""
MINUTES = 600_000
RUN = """async number => {
    const began = performance.now();
    await DhCells.cells[number].start();
    return (performance.now() - began) / 1000;
}"""
TRIP = """async ([name, angle]) => {
    const figure = document.getElementById(`live-${name}`);
    const began = performance.now();
    await DhCells.session.run(`figure.move([${angle}, 0, 0, 0]);`, "there", () => {});
    const shown = performance.now();
    if (figure.joints[0] !== angle) throw new Error("the figure has not moved");
    let read = "";
    await DhCells.session.run("print(repr(float(figure.q[0])))", "back", ({text}) => { read += text ?? ""; });
    if (Number(read) !== angle) throw new Error(`read ${read} instead of ${angle}`);
    return [shown - began, performance.now() - began];
}"""

DRAW = """async () => {
    const began = performance.now();
    await DhCells.session.run("figure", "drawing", () => {});
    return performance.now() - began;
}"""


def weight(site: Path, path: str) -> int:
    """How many bytes a file takes on its way."""
    content = (site / path).read_bytes()
    packed = Path(path).suffix in {".whl", ".zip", ".woff2", ".png"}
    return len(content) if packed else len(gzip.compress(content, 6))


def measure(page: Any, site: Path, address: str) -> None:
    """Measure, and print."""
    asked: set[str] = set()
    page.set_default_timeout(MINUTES)
    page.goto(f"{address}/{PAGE}")
    page.wait_for_timeout(500)
    page.on("request", lambda request: asked.add(urlsplit(request.url).path.lstrip("/")))
    first = page.evaluate(RUN, 0)
    times = page.evaluate("DhCells.session.times")
    print(f"first Run {first:.1f} s, of which " + ", ".join(f"{name} {ms / 1000:.1f}" for name, ms in times.items()))
    print(f"next Run {1000 * page.evaluate(RUN, 0):.0f} ms")
    live = sum(weight(site, path) for path in asked if (site / path).is_file())
    print(f"fetched for it {live / 1e6:.1f} MB compressed, in {len(asked)} files")
    page.evaluate("([source]) => DhCells.session.run(source, 'begin', () => {})", [BEGIN])
    trips = [page.evaluate(TRIP, [FIGURE, k / 100]) for k in range(TRIPS)]
    there, whole = (statistics.median(trip[k] for trip in trips) for k in (0, 1))
    slowest = max(trip[1] for trip in trips)
    print(
        f"to the figure {there:.1f} ms; there and back {whole:.1f} ms (median of {TRIPS}; the slowest {slowest:.0f} ms)"
    )
    drawing = [page.evaluate(DRAW) for _ in range(5)]
    print(f"a drawing below the cell {statistics.median(drawing):.0f} ms")
    print(f"load of the machine {os.getloadavg()[0]:.1f}")


def main() -> None:
    """Serve the site and measure."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("site", type=Path)
    site = parser.parse_args().site
    httpd = server(site)
    threading.Thread(target=httpd.serve_forever, daemon=True).start()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium.find(), args=["--no-sandbox"])
        measure(browser.new_page(), site, f"http://127.0.0.1:{httpd.server_address[1]}")
        browser.close()
    httpd.shutdown()


if __name__ == "__main__":
    main()
