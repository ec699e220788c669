"""The built site: what is in it, that every figure speaks, and that a failing build fails every time."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from bs4 import BeautifulSoup
from building import build_book, pages_of
from fontTools.ttLib import TTFont
from site_listing import files_of, listed, unexpected
from sources import put_page
from truth import silent_figures

pytestmark = pytest.mark.book


def test_only_what_is_listed_is_published(site: Path, root: Path) -> None:
    pages = listed(root)
    assert not unexpected(files_of(site), pages)
    assert {f"{name}.html" for name in pages} <= files_of(site)


@pytest.mark.parametrize(
    "stray",
    [
        "README.html",
        "solutions/other.html",
        "notebooks/solutions/quickshot.ipynb",
        "library/x.whl",
        "_sources/solutions/quickshot.ipynb",
        "_static/key.pem",
        "dhlib/x.py",
        "run/x.py",
    ],
)
def test_a_stray_file_would_be_found(site: Path, root: Path, stray: str) -> None:
    assert unexpected({*files_of(site), stray}, listed(root)) == {stray}


def test_every_figure_has_words(site: Path) -> None:
    silent = {page: found for page in pages_of(site) if (found := silent_figures((site / page).read_text("utf-8")))}
    assert not silent


@pytest.mark.parametrize(
    "figure",
    [
        '<img src="a.png">',
        '<img src="a.png" alt="  ">',
        '<img alt="../_images/0123456789abcdef0123456789abcdef.png" src="a.png">',
        '<img alt="frames.svg" src="frames.svg"/>',
        '<svg viewBox="0 0 1 1"><path/></svg>',
        '<svg aria-hidden="true"><svg/></svg><svg><path/></svg>',
        "<svg><title>A name alone</title><desc> </desc><path/></svg>",
        "<svg><g><svg><desc>Within</desc></svg></g></svg>",
    ],
)
def test_a_silent_figure_would_be_found(figure: str) -> None:
    assert silent_figures(f"<p>{figure}</p>")


def test_a_speaking_figure_passes() -> None:
    assert not silent_figures(
        '<img alt="Two frames" src="a.png"><svg aria-label="Two frames"></svg><svg aria-hidden="true"/>'
        '<svg aria-hidden="true"><svg viewBox="0 0 1 1"><path/></svg></svg>'
        "<svg><title>A link</title><desc>Two frames</desc><path/></svg>"
    )


def test_the_single_joint_is_stepped_and_its_four_steps_are_printed(site: Path) -> None:
    page = BeautifulSoup((site / "book" / "classic.html").read_text("utf-8"), "html.parser")
    ways = {figure["id"]: figure for figure in page.select("dh-link")}
    joint = ways["live-fig-classic-joint"]
    assert (joint["theta"], joint["alpha"], joint["index"]) == ("0", "-90", "1")
    steps = re.compile(r"[RT][zx]\([θdaα]1\)")
    assert len(steps.findall(joint.get_text())) == 4
    assert not steps.findall(ways["live-fig-classic-link"].get_text()), "the other figure shows its link"


def lone_marks(page: str) -> list[str]:
    """Return the marks that a browser may put on a line of their own, away from the formula before them."""
    formulas = BeautifulSoup(page, "html.parser").select("main span.math")
    loose = [formula.next_sibling for formula in formulas if "kept" not in (formula.parent or {}).get("class", [])]
    return [str(text)[:20] for text in loose if isinstance(text, str) and re.match(r"[.,;:!?)]", text)]


def test_a_full_stop_stays_beside_its_formula(site: Path) -> None:
    pages = {path.name: path.read_text("utf-8") for path in (site / "book").glob("*.html")}
    assert {name: marks for name, page in pages.items() if (marks := lone_marks(page))} == {}
    assert lone_marks(pages["placing.html"].replace('<span class="kept">', "<span>"))


def test_progress_is_told_in_the_order_of_the_book(site: Path, root: Path) -> None:
    page = BeautifulSoup((site / "book" / "progress.html").read_text("utf-8"), "html.parser")
    shown = [link["href"] for link in page.select(".dh-progress tr a")]
    exercises = re.findall(r"file: exercises/(\w+)", (root / "_toc.yml").read_text("utf-8"))
    assert shown == [f"../exercises/{name}.html" for name in exercises]
    assert shown != sorted(shown)


def test_icons_are_few_and_all_there(site: Path) -> None:
    """Every icon that a page names has its rule, and every rule its glyph."""
    fonts = list((site / "_static").rglob("*.woff2"))
    assert sum(font.stat().st_size for font in fonts) < 30_000
    drawn = {code for font in fonts for code in TTFont(font).getBestCmap()}
    sheet = (site / "_static/styles/pydata-sphinx-theme.css").read_text("utf-8")
    for page in pages_of(site):
        for kind, name in re.findall(
            r'class="[^"]*\b(fa[srb]?|fa-solid|fa-regular) fa-([a-z-]+)', (site / page).read_text("utf-8")
        ):
            rule = re.search(rf'\.fa-{name}:before[^{{]*\{{content:"\\([0-9a-f]+)"', sheet)
            assert rule, f"{page}: {kind} {name}"
            assert int(rule[1], 16) in drawn, f"{page}: {kind} {name}"


def test_links_of_the_book_lead_somewhere(site: Path) -> None:
    for page in pages_of(site):
        html = (site / page).read_text("utf-8")
        for target in re.findall(r'<a [^>]*href="([^"]*)"', html):
            if re.match(r"https?:|mailto:|javascript:", target):
                continue
            path, _, fragment = target.partition("#")
            file = (site / page).parent / path.split("?")[0] if path else site / page
            assert file.is_file(), f"{page}: {target}"
            if fragment:
                assert re.search(rf'(id|name)="{re.escape(fragment)}"', file.read_text("utf-8")), f"{page}: {target}"


def add_page(copy: Path, body: str) -> None:
    """Put a page into a copy of the book, and that page alone."""
    header = "---\nfile_format: mystnb\nkernelspec: {name: python3, display_name: Python 3}\n---\n# A page\n\n"
    put_page(copy, header + body)


MISTAKES = {
    "$\\nosuchmacro{x}$": "formula not understood",
    "{ref}`nowhere`": "undefined label",
    "{py:func}`dhlib.nowhere`": "py:func reference target not found: dhlib.nowhere",
    "{glue:text}`nothing`": "No key 'nothing'",
    "![](nowhere.png)": "nowhere.png",
    "```{code-cell}\nassert 1 + 1 == 3\n```": "AssertionError",
}


def test_each_mistake_fails_the_build_each_time(copy: Path) -> None:
    """Also the second time, when Sphinx could take the page for done."""
    add_page(copy, "\n\n".join(MISTAKES))
    for _ in range(2):
        built = build_book(copy, copy, environment={"PYTHONPATH": str(copy)})
        assert built.returncode != 0
        assert [complaint for complaint in MISTAKES.values() if complaint not in built.stdout] == []


def test_an_edit_of_the_library_reaches_the_page(copy: Path) -> None:
    """The chapter's text does not change, the library does: the page must show the new number."""
    add_page(
        copy,
        "```{code-cell}\nimport dhlib._measure\nfrom bookkit import glue_number\n"
        'glue_number("length", dhlib._measure.LENGTH)\n```\n\nIt is {glue:text}`length` long.\n',
    )
    constant = copy / "dhlib" / "_measure.py"
    page = copy / "_build" / "html" / "book" / "page.html"

    def build(value: str) -> str:
        constant.write_text(f"LENGTH = {value}\n")
        built = build_book(copy, copy, environment={"PYTHONPATH": str(copy)})
        assert built.returncode == 0, built.stdout
        return built.stdout

    assert "page.md: executed" in build("0.1234")
    assert "0.1234" in page.read_text("utf-8")
    assert "page.md: executed" in build("0.5678")
    assert "0.5678" in page.read_text("utf-8")
    assert "0.1234" not in page.read_text("utf-8")
    assert "page.md: executed" not in build("0.5678")
    assert "page.md: executed" not in build("0.1234"), "the outputs for the old content are still known"
    assert "0.1234" in page.read_text("utf-8")


MEETING = """```{{code-cell}}
import pathlib, time
pathlib.Path("{here}.txt").touch()
deadline = time.monotonic() + 60
while not pathlib.Path("{there}.txt").exists():
    assert time.monotonic() < deadline, "the other chapter did not run meanwhile"
    time.sleep(0.1)
```
"""


def test_a_line_that_is_printed_in_pieces_is_one_line(copy: Path) -> None:
    pieces = "import sys\nimport time\n\nprint('one', end=' ')\nsys.stdout.flush()\ntime.sleep(0.5)\nprint('two')"
    add_page(copy, f"```{{code-cell}}\n{pieces}\n```\n")
    built = build_book(copy, copy, environment={"PYTHONPATH": str(copy)})
    assert built.returncode == 0, built.stdout
    assert "one two" in (copy / "_build/html/book/page.html").read_text("utf-8")


def test_chapters_run_side_by_side(copy: Path) -> None:
    """Each of two chapters waits until the other has begun: one after the other they would never end."""
    add_page(copy, MEETING.format(here="page", there="second"))
    header = (copy / "book" / "page.md").read_text("utf-8").split("```")[0]
    (copy / "book" / "second.md").write_text(header + MEETING.format(here="second", there="page"), "utf-8")
    (copy / "_toc.yml").write_text(
        "format: jb-book\nroot: book/page\nchapters:\n  - file: book/second\n", encoding="utf-8"
    )
    built = build_book(copy, copy, environment={"PYTHONPATH": str(copy)})
    assert built.returncode == 0, built.stdout
