"""After one visit the book reads without the network; another build replaces it; large files are kept when used."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from building import pages_of
from installable import files_to_keep, write_worker
from serve import server

pytestmark = [pytest.mark.book, pytest.mark.browser]

THREE_MINUTES = 180_000
KEPT = "caches.open('dh-book').then(c => c.keys()).then(keys => keys.map(k => k.url))"
#: How often the number of files that are kept may be the same, ten times a second, before the worker counts as stuck.
PATIENCE = 1200
#: Without what a page keeps when it is used, such as what runs its cells.
AT_ONCE = f"{KEPT}.then(urls => urls.filter(url => !url.includes('/run/')))"


class Site:
    """A copy of the site on a server that can be switched off, and built anew."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.httpd = server(folder)
        self.port = self.httpd.server_address[1]
        self.address = f"http://127.0.0.1:{self.port}"
        threading.Thread(target=self.httpd.serve_forever, daemon=True).start()

    def switch_off(self) -> None:
        """Refuse every connection from now on."""
        self.httpd.shutdown()
        self.httpd.server_close()

    def change(self, name: str, old: str, new: str) -> None:
        """Change a file and write the worker of this build."""
        path = self.folder / name
        text = path.read_text("utf-8")
        assert old in text
        path.write_text(text.replace(old, new), "utf-8")
        write_worker(self.folder)


@pytest.fixture
def home(site: Path, tmp_path: Path) -> Iterator[Site]:
    shutil.copytree(site, tmp_path / "site")
    served = Site(tmp_path / "site")
    yield served
    served.switch_off()


def visit(browser: Any, home: Site, path: str = "book/index.html") -> Any:
    """Visit a page for the first time, until its worker is at work."""
    page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
    page.goto(f"{home.address}/{path}")
    assert page.evaluate(f"""async () => {{
        for (let [count, patience] = [0, {PATIENCE}]; patience > 0; patience--) {{
            if (navigator.serviceWorker.controller) return true;
            await new Promise(done => setTimeout(done, 100));
            const now = (await {KEPT}).length;
            if (now !== count) [count, patience] = [now, {PATIENCE}];
        }}
        return false;
    }}"""), "nothing more was kept for a long while, and no worker is at work"
    return page


def wait_until(page: Any, holds: str) -> None:
    """Wait until something holds of the addresses that are kept."""
    assert page.evaluate(
        f"""async () => {{
            for (let k = 0; k < 400; k++) {{
                const urls = await {KEPT};
                if ({holds}) return true;
                await new Promise(done => setTimeout(done, 50));
            }}
            return false;
        }}"""
    ), holds


def test_after_one_visit_every_page_opens_without_the_network(browser: Any, home: Site) -> None:
    page = visit(browser, home)
    home.switch_off()
    failed: list[str] = []

    def note(request: Any) -> None:
        # A page that is left while it is still being read is no failure.
        if request.failure != "net::ERR_ABORTED":
            failed.append(f"{request.url}: {request.failure}")

    page.on("requestfailed", note)
    for name in [*pages_of(home.folder), "book/why.html?x=1#sec-why", ""]:
        page.goto(f"{home.address}/{name}", wait_until="commit")
        if name in ("", "index.html"):  # leads on
            page.wait_for_url("**/book/index.html")
        page.wait_for_selector("main h1", state="attached")
    page.goto(f"{home.address}/search.html?q=twist")
    page.wait_for_selector("#search-results li a")
    page.goto(f"{home.address}/book/pa10.html")
    # Sections get their sizes as they come near, so that the arm may move away once more.
    arrived = "() => { const arm = document.querySelector('dh-robot'); arm.scrollIntoView(); return arm.space; }"
    page.wait_for_function(arrived, timeout=THREE_MINUTES)
    before = page.locator("dh-robot .matrix").inner_text()
    page.locator("dh-robot input[type=range]").first.press("End")
    page.wait_for_timeout(100)
    assert page.locator("dh-robot .matrix").inner_text() != before
    page.context.close()
    assert not failed


def test_without_a_visit_nothing_opens(browser: Any, home: Site) -> None:
    home.switch_off()
    page = browser.new_context().new_page()
    with pytest.raises(Exception, match="ERR_CONNECTION_REFUSED"):
        page.goto(f"{home.address}/book/why.html")
    page.context.close()


def test_another_build_replaces_what_was_kept(browser: Any, home: Site) -> None:
    page = visit(browser, home)
    first = set(page.evaluate(AT_ONCE))
    home.change("book/why.html", "</h1>", " of the other build</h1>")
    page.goto(f"{home.address}/book/why.html")
    assert "of the other build" in page.locator("h1").first.inner_text(), "the network comes first"
    wait_until(page, f"urls.some(url => url.endsWith('{hash_of(home.folder / 'book/why.html')}'))")
    wait_until(page, f"urls.filter(url => !url.includes('/run/')).length === {len(first)}")
    second = set(page.evaluate(AT_ONCE))
    changed = {re.sub(r"\?.*", "", url) for url in first ^ second}
    assert changed == {f"{home.address}/book/why.html"}, "what did not change was not fetched again"
    home.switch_off()
    page.goto(f"{home.address}/book/why.html?again")
    assert "of the other build" in page.locator("h1").first.inner_text()
    page.context.close()


def test_a_half_published_site_is_not_kept(browser: Any, home: Site) -> None:
    """A file that is not the one the worker was written for would be stale, or ahead of the others."""
    page_file = home.folder / "book/why.html"
    page_file.write_text(page_file.read_text("utf-8") + "<!-- later -->", "utf-8")
    page = browser.new_context().new_page()
    page.goto(f"{home.address}/book/index.html")
    page.evaluate(
        """() => navigator.serviceWorker.getRegistration().then(async found => {
            for (let k = 0; k < 200 && (!found || found.installing || !found.active && k < 20); k++) {
                await new Promise(done => setTimeout(done, 50));
                found ??= await navigator.serviceWorker.getRegistration();
            } })"""
    )
    assert page.evaluate("navigator.serviceWorker.getRegistration().then(found => !found?.active)")
    page.context.close()


def test_large_files_are_kept_when_they_were_used(browser: Any, home: Site) -> None:
    large = home.folder / "live" / "large.bin"
    large.write_bytes(b"dh" * 600_000)
    write_worker(home.folder)
    page = visit(browser, home)
    address = f"{home.address}/live/large.bin"
    assert not page.evaluate(f"{KEPT}.then(urls => urls.some(url => url.includes('large.bin')))")
    assert page.evaluate(f"fetch('{address}').then(r => r.arrayBuffer()).then(b => b.byteLength)") == 1_200_000
    wait_until(page, "urls.some(url => url.includes('large.bin'))")
    home.switch_off()
    assert page.evaluate(f"fetch('{address}').then(r => r.arrayBuffer()).then(b => b.byteLength)") == 1_200_000
    page.context.close()


def test_from_the_disk_no_worker_is_asked_for(browser: Any, site: Path) -> None:
    page = browser.new_page()
    complaints: list[str] = []
    page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
    page.add_init_script(
        "Object.defineProperty(navigator, 'serviceWorker', {value: {register: () => console.error('registered')}})"
    )
    page.goto(f"{site.as_uri()}/book/index.html")
    page.wait_for_timeout(200)
    page.close()
    assert not complaints


def test_the_book_can_be_installed(site: Path) -> None:
    manifest = json.loads((site / "manifest.webmanifest").read_text("utf-8"))
    assert (site / manifest["start_url"]).is_file()
    sizes = {icon["sizes"] for icon in manifest["icons"] if icon["type"] == "image/png"}
    assert {"192x192", "512x512"} <= sizes
    for icon in manifest["icons"]:
        assert (site / icon["src"]).is_file()
    for name in pages_of(site):
        html = (site / name).read_text("utf-8")
        if name != "index.html":
            (at,) = re.findall(r'<link rel="manifest" href="([^"]+)"', html)
            assert ((site / name).parent / at).resolve() == (site / "manifest.webmanifest").resolve()
            (about,) = re.findall(r'<meta name="description" content="([^"]+)"', html)
            assert 40 <= len(about) <= 200, name


def test_every_page_and_figure_is_in_the_list(site: Path) -> None:
    kept, when_used = files_to_keep(site)
    assert set(pages_of(site)) <= set(kept)
    assert {path.relative_to(site).as_posix() for path in (site / "live").iterdir()} <= set(kept)
    assert all(name.startswith(("notebooks/", "_downloads/", "objects.inv")) or "." in name for name in when_used)
    listed = json.loads(re.match(r"const SITE = (.*);\n", (site / "sw.js").read_text("utf-8"))[1])
    assert listed == {"kept": kept, "whenUsed": when_used}


def hash_of(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()[:16]
