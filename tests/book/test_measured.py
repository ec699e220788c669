"""The page on speed and bench/RESULTS.md say what is stored in bench/results, and nothing else."""

from __future__ import annotations

import doctest
import html
import json
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import measured
import pytest
from docutils import nodes
from docutils.utils import new_document

sys.path.append(str(Path(__file__).parents[2] / "bench"))

import charts
import covered
import report
import run

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "bench" / "results"
STORED = sorted(path.stem for path in RESULTS.glob("*.json"))
NAMES = [make.__name__ for make in report.REPORTED]


def plain(text: str) -> str:
    """Words alone: no markup of Markdown or HTML, and no white space, which browsers fold."""
    text = html.unescape(re.sub(r"<[^>]*>", "", text))
    return re.sub(r"[\s`*‘’'\"…]|\.\.\.", "", text)


@pytest.mark.parametrize("module", [charts, covered, report], ids=lambda module: module.__name__)
def test_examples(module: Any) -> None:
    assert doctest.testmod(module).failed == 0


def test_there_is_something_to_show() -> None:
    assert {"accuracy", "placing", "imports"} <= set(STORED) <= set(NAMES)


def test_every_workload_is_reported() -> None:
    assert set(run.WORKLOADS) <= set(NAMES)


@pytest.mark.parametrize("name", run.WORKLOADS)
def test_every_workload_can_be_set_up(name: str) -> None:
    work = run.WORKLOADS[name]
    assert (ROOT / "bench" / work.program).is_file()
    for peer in work.peers:
        lock = ROOT / "bench/peers" / f"{work.homes.get(peer, peer)}.lock"
        assert "--hash=sha256:" in lock.read_text("utf-8")


def test_every_workload_has_its_place_on_the_page() -> None:
    assert re.findall(r"\{dh-measured\} (\w+)", (ROOT / "book/how_fast.md").read_text("utf-8")) == NAMES


def test_the_report_is_a_view_of_what_is_stored() -> None:
    assert (ROOT / "bench/RESULTS.md").read_text("utf-8") == report.report(RESULTS)


def test_another_result_would_be_another_report(tmp_path: Path) -> None:
    stored = shutil.copytree(RESULTS, tmp_path / "results")
    accuracy = json.loads((stored / "accuracy.json").read_text("utf-8"))
    accuracy["rows"][-1]["rotation"] = 9.9e-16
    (stored / "accuracy.json").write_text(json.dumps(accuracy), "utf-8")
    assert "9.9e-16" in report.report(stored)
    assert report.report(stored) != report.report(RESULTS)


def test_what_was_not_measured_is_not_shown(tmp_path: Path) -> None:
    assert report.tables(tmp_path, "forward") == ([], "")
    assert "##" not in report.report(tmp_path)
    with pytest.raises(KeyError):
        report.tables(tmp_path, "fast")


@pytest.mark.book
@pytest.mark.parametrize("name", STORED)
def test_the_page_shows_what_is_stored(site: Path, name: str) -> None:
    page = (site / "book/how_fast.html").read_text("utf-8")
    shown = plain(page)
    tables, where = report.tables(RESULTS, name)
    assert tables
    assert plain(where) in shown
    for table in tables:
        for words in (table.title, table.says, *report.sentences(table)):
            assert plain(words) in shown, words
        assert plain("".join(table.header)) + plain("".join(map("".join, table.rows))) in shown
        if table.bars:
            assert html.escape(charts.words(table)) in page


@pytest.mark.book
def test_the_page_shows_nothing_else(site: Path) -> None:
    page = (site / "book/how_fast.html").read_text("utf-8")
    shown = set(re.findall(r'id="measured-(\w+)-\d+"', page))
    assert shown == set(STORED)


def test_a_heading_without_results_goes_too() -> None:
    document = new_document("page")
    for name, content in (("measured", nodes.paragraph("", "so much")), ("not measured", measured.NotMeasured())):
        document += nodes.section("", nodes.title("", name), content, measured.NotMeasured())
    measured.leave_out(None, document)
    assert [section[0].astext() for section in document.findall(nodes.section)] == ["measured"]
    assert not list(document.findall(measured.NotMeasured))


def test_a_missing_peer_is_named_with_the_reason() -> None:
    table = report.Table("Title", "", (), (), missing=["peer: no wheel"], aims=[report.Aim("fast", "slow", False)])
    assert report.sentences(table) == ["**Not reached**: fast; found slow.", "Not to be had: peer: no wheel."]


@pytest.mark.parametrize(("ours", "reached"), [(0.01, True), (0.2, False)])
def test_an_aim_is_judged_by_what_was_found(ours: float, reached: bool) -> None:
    def row(peer: str, seconds: float, ratio: float) -> dict[str, Any]:
        return {"peer": peer, "call": peer, "seconds": seconds, "ratio": ratio, "operations": 9, "shared": 9}

    result = {"rows": [row("dhlib", ours, 1.0), row("roboticstoolbox", 2.0, 2.0 / ours)]}
    (table,) = report.symbolic(result)
    assert [aim.reached for aim in table.aims] == [reached, reached, True]
