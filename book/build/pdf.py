"""Print the whole book as one PDF: the built pages in reading order, with a table of contents and page numbers.

The pages are joined into one document, printed by Chromium, searched for where each chapter begins, and printed again
with these numbers in the table of contents.
"""

from __future__ import annotations

import argparse
import html
import json
import re
import sys
import tempfile
from pathlib import Path
from typing import Any

import chromium
import yaml
from bs4 import BeautifulSoup, Tag
from pypdf import PdfReader

ROOT = Path(__file__).parent.parent.parent
TITLE, SUBTITLE = "The DH book", "The Denavit-Hartenberg conventions, classic and modified"
STYLE = """
  @page { size: A4; margin: 18mm 17mm 20mm; }
  html { font-size: 10.5pt; }
  body { margin: 0; background: white; color: black; padding: 0; }
  main { max-width: none; }
  .page { break-before: page; }
  .book-title { display: flex; flex-direction: column; justify-content: center; min-height: 235mm; text-align: center; }
  .book-title h1 { font-size: 34pt; margin: 0; }
  h1 { font-size: 21pt; } h2 { font-size: 15pt; } h3 { font-size: 12pt; }
  h1, h2, h3, h4 { break-after: avoid; }
  pre { white-space: pre-wrap; font-size: 8.5pt; break-inside: auto; orphans: 5; widows: 5; }
  .cell { break-inside: auto; }
  .cell :is(div, pre) { overflow: visible !important; }
  div.math { overflow: visible; justify-content: center; }
  div.math > .formula { max-width: 100%; }
  div.math > .formula > svg { max-width: 100%; height: auto; }
  .formula use { stroke-width: 0; }
  .bd-article svg.dh-figure { max-height: 95mm; }
  section { border: 0; box-shadow: none; background: none; }
  table { font-size: 9.5pt; break-inside: avoid; } img, svg.dh-figure { max-width: 100%; }
  #book-cheatsheet { font-size: 9pt; }
  #book-cheatsheet :is(td, th) { padding: 0.2rem 0.5rem; }
  #book-cheatsheet svg.dh-figure { max-height: 60mm; }
  .book-contents ol { list-style: none; padding: 0; }
  .book-contents li { display: flex; gap: 0.5em; margin: 0.15em 0; }
  .book-contents li::before { content: ""; order: 1; flex: 1; border-bottom: 1px dotted #999; margin-bottom: 0.3em; }
  .book-contents .number { order: 2; }
  script, .citation > .backrefs { display: none !important; }
  .citation > .label { float: left; margin-right: 0.6em; }
  .citation > p { margin: 0 0 0.4em; }
  .dh-answer .dh-field { border: 0 !important; border-bottom: 1px solid #666 !important; border-radius: 0 !important; }
  .dh-option .dh-field { border: 1px solid #666; border-radius: 0.25rem; }
  .dh-option .dh-field.radio { border-radius: 50%; }
"""
FOOTER = (
    '<div style="width:100%;font:8pt sans-serif;text-align:center;color:#555"><span class="pageNumber"></span></div>'
)


def reading_order(toc: dict[str, Any]) -> list[str]:
    """Return the pages of a table of contents, first to last."""
    pages = [toc["root"]] if "root" in toc else []
    for part in toc.get("parts", [toc]):
        for entry in part.get("chapters", []):
            pages += [entry["file"], *(section["file"] for section in entry.get("sections", []))]
    return pages


def identity(page: str, fragment: str = "") -> str:
    """Return the id of a page, or of a place in it, in the joined document."""
    return re.sub(r"\W", "-", page) + (f"--{fragment}" if fragment else "")


def article(site: Path, page: str, known: set[str]) -> Tag:
    """Return the text of a page, its ids and links made fit for the joined document."""
    soup = BeautifulSoup((site / f"{page}.html").read_text("utf-8"), "html.parser")
    found = soup.select_one("article.bd-article")
    assert found is not None
    for needless in found.select("script, .prev-next-area, noscript, template"):
        needless.decompose()
    for fold in found.select("details"):
        fold["open"] = ""
    for element in found.select("[id]"):
        if not element.find_parent("svg", class_="dh-figure") and not str(element["id"]).startswith("glyph-"):
            element["id"] = identity(page, str(element["id"]))
    for link in found.select("a[href]"):
        address = str(link["href"])
        if re.match(r"[a-z]+:", address):
            continue
        path, _, fragment = address.partition("#")
        target = page
        if path:
            target = ((site / page).parent / path).resolve().relative_to(site.resolve()).with_suffix("").as_posix()
        if target in known and (not path or path.endswith(".html")):
            link["href"] = "#" + identity(target, fragment)
        else:
            link.unwrap()
    for image in found.select("img[src]"):
        image["src"] = ((site / page).parent / str(image["src"])).resolve().as_uri()
    found["id"] = identity(page)
    found["class"] = "bd-article page"
    return found


def glyphs(site: Path, pages: list[str]) -> str:
    """Return one sheet with the outlines that the formulas of all pages use."""
    paths: dict[str, str] = {}
    for page in pages:
        text = (site / f"{page}.html").read_text("utf-8")
        paths.update(re.findall(r'<path id="(glyph-[^"]+)" d="([^"]*)"', text))
    inside = "".join(f'<path id="{name}" d="{outline}"/>' for name, outline in sorted(paths.items()))
    return f'<svg class="glyphs" width="0" height="0" aria-hidden="true"><defs>{inside}</defs></svg>'


def answers(site: Path, pages: list[str], titles: dict[str, str]) -> str:
    """Return the pages with the answers to the questions, if there are any."""
    parts = []
    for page in pages:
        kept = site.parent / "answers" / f"{page}.json"
        if kept.exists():
            rows = "".join(
                f"<li>{html.escape(one['answer'])}. {one['says']}</li>" for one in json.loads(kept.read_text("utf-8"))
            )
            parts.append(f"<h2>{html.escape(titles[page])}</h2><ol>{rows}</ol>")
    return (
        f'<article class="page" id="answers"><h1>Answers to the questions</h1>{"".join(parts)}</article>'
        if parts
        else ""
    )


def join(site: Path, pages: list[str], numbers: dict[str, int]) -> str:
    """Return the joined document; `numbers` are the pages on which each chapter begins."""
    articles = {page: article(site, page, set(pages)) for page in pages}
    titles = {page: _title(found) for page, found in articles.items()}
    extra = answers(site, pages, titles)
    entries = [(identity(page), titles[page]) for page in pages] + (
        [("answers", "Answers to the questions")] if extra else []
    )
    contents = "".join(
        f'<li><a href="#{where}">{html.escape(title)}</a><span class="number">{numbers.get(where, "")}</span></li>'
        for where, title in entries
    )
    sheets = "".join(
        f'<link rel="stylesheet" href="{path.as_uri()}">'
        for name in (
            "styles/pydata-sphinx-theme.css",
            "pygments.css",
            "colours.css",
            "book.css",
            "questions.css",
            "print.css",
        )
        if (path := (site / "_static" / name).resolve()).exists()
    ) + "".join(
        f'<link rel="stylesheet" href="{p.resolve().as_uri()}">' for p in (site / "_static").glob("mystnb.*.css")
    )
    title = f'<section class="book-title"><h1>{TITLE}</h1><p>{SUBTITLE}</p></section>'
    return (
        f'<!doctype html><html lang="en-GB" data-theme="light"><head><meta charset="utf-8"><title>{TITLE}</title>'
        f"{sheets}<style>{STYLE}</style></head><body><main>{title}"
        f'<section class="book-contents page"><h1>Contents</h1><ol>{contents}</ol></section>'
        f"{''.join(map(str, articles.values()))}{extra}</main>{glyphs(site, pages)}</body></html>"
    )


def _title(found: Tag) -> str:
    heading = found.select_one("h1")
    assert heading is not None
    for link in heading.select(".headerlink"):
        link.decompose()
    return heading.get_text().strip()


def where_chapters_begin(pdf: Path) -> dict[str, int]:
    """Return the page number of each named place of a PDF."""
    reader = PdfReader(pdf)
    found = {}
    for name, place in reader.named_destinations.items():
        number = reader.get_destination_page_number(place)
        if number is not None:
            found[name.lstrip("/")] = number + 1
    return found


def print_book(site: Path, pages: list[str], target: Path) -> None:
    """Print the pages of a site into one PDF."""
    from playwright.sync_api import sync_playwright

    path = chromium.find()
    if path is None:
        raise SystemExit(f"The PDF is printed by Chromium, and none was found. {chromium.ADVICE}")
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        joined = Path(folder) / "book.html"
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-gpu"])
        numbers: dict[str, int] = {}
        for _ in range(2):
            joined.write_text(join(site, pages, numbers), "utf-8")
            sheet = browser.new_page()
            sheet.set_default_timeout(0)  # a busy machine takes its time
            sheet.goto(joined.as_uri())
            sheet.pdf(
                path=str(target), prefer_css_page_size=True, print_background=True, outline=True, tagged=True,
                display_header_footer=True, header_template="<span></span>", footer_template=FOOTER,
            )  # fmt: skip
            sheet.close()
            numbers = where_chapters_begin(target)
        browser.close()


def main() -> int:
    """Print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("site", type=Path)
    parser.add_argument("target", type=Path)
    choice = parser.parse_args()
    toc = yaml.safe_load((ROOT / "_toc.yml").read_text("utf-8"))
    print_book(choice.site, reading_order(toc), choice.target)
    print(f"{choice.target}: {len(PdfReader(choice.target).pages)} pages")
    return 0


if __name__ == "__main__":
    sys.exit(main())
