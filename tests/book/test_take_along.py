"""The whole book to take along: one PDF, and one zip that reads from the disk."""

from __future__ import annotations

import hashlib
import re
import zipfile
from pathlib import Path
from typing import Any

import chromium
import pdf
import pytest
import yaml
from building import pages_of
from offline import build_wheel, pack
from pypdf import PdfReader

pytestmark = [pytest.mark.book, pytest.mark.slow]


@pytest.fixture(scope="module")
def pages(root: Path) -> list[str]:
    return pdf.reading_order(yaml.safe_load((root / "_toc.yml").read_text("utf-8")))


def test_reading_order_holds_every_page(site: Path, pages: list[str]) -> None:
    of_sphinx = {"index.html", "search.html", "genindex.html", "py-modindex.html"}
    assert {f"{page}.html" for page in pages} == set(pages_of(site)) - of_sphinx
    assert pages[0] == "book/index"


def test_pdf(site: Path, pages: list[str], tmp_path: Path) -> None:
    """Contents lead to where the chapters begin, formulas and figures are drawn, answers come last."""
    if chromium.find() is None and not chromium.in_ci():
        pytest.skip(f"no Chromium. {chromium.ADVICE}")
    some = [page for page in pages if page.split("/")[1] in {"index", "why", "modified", "cheatsheet"}]
    target = tmp_path / "book.pdf"
    pdf.print_book(site, some, target)
    reader = PdfReader(target)
    begins = pdf.where_chapters_begin(target)
    contents = reader.pages[1].extract_text()
    for page in some:
        number = begins[pdf.identity(page)]
        title = re.search(r"<h1>(.*?)<", (site / f"{page}.html").read_text("utf-8"))
        assert title is not None
        assert title[1].strip() in " ".join(reader.pages[number - 1].extract_text().split())
        assert re.search(rf"{re.escape(title[1].strip())}\s+{number}\b", " ".join(contents.split()))
    assert "Answers to the questions" in reader.pages[begins["answers"] - 1].extract_text()
    assert reader.pages[4].extract_text().strip().endswith("5"), "every page has its number"
    assert len(reader.outline) >= len(some)


def test_joined_links_lead_somewhere(site: Path, pages: list[str]) -> None:
    joined = pdf.join(site, pages, {})
    assert dead_links(joined) == []
    assert dead_links(joined.replace("</main>", '<a href="#nowhere">x</a></main>')) == ["nowhere"]
    assert "<script" not in joined


def dead_links(joined: str) -> list[str]:
    ids = set(re.findall(r'\bid="([^"]+)"', joined))
    return sorted(set(re.findall(r'<a [^>]*href="#([^"]+)"', joined)) - ids)


def test_zip_reads_from_the_disk(site: Path, browser: Any, tmp_path: Path) -> None:
    wheel = build_wheel(tmp_path)
    pack(site, tmp_path / "book.zip", [wheel])
    with zipfile.ZipFile(tmp_path / "book.zip") as archive:
        names = set(archive.namelist())
        archive.extractall(tmp_path / "unpacked")
    files = {path.relative_to(site).as_posix() for path in site.rglob("*") if path.is_file()}
    assert names == {f"dh-book/{name}" for name in files | {"README.txt", wheel.name}}
    page = browser.new_page()
    strangers: list[str] = []
    page.on("request", lambda asked: strangers.append(asked.url) if asked.url.startswith("http") else None)
    page.goto((tmp_path / "unpacked/dh-book/index.html").as_uri())
    page.wait_for_selector("article h1")
    assert page.url.endswith("/book/index.html")
    page.close()
    assert strangers == []


def test_the_same_site_gives_the_same_zip(questions_site: Path, tmp_path: Path) -> None:
    sums = set()
    for name in ("one.zip", "two.zip"):
        pack(questions_site, tmp_path / name, [])
        sums.add(hashlib.sha256((tmp_path / name).read_bytes()).hexdigest())
    assert len(sums) == 1
