"""Feedback and class pages: what stands in them, and that nothing in them can run."""

import json
import random
import re
from dataclasses import replace

import numpy as np
import pytest

from dhlib import Chain, Tx, robots
from dhlib.errors import DHError
from dhlib.grading.exercise import Part
from dhlib.grading.forms import Function, Numbers
from dhlib.grading.reports.book_links import link, read_address
from dhlib.grading.reports.class_page import class_page
from dhlib.grading.reports.decisions import Adjustment, Rule, adjust, set_rule
from dhlib.grading.reports.feedback import feedback_page
from dhlib.grading.reports.pages import brief, policy
from dhlib.grading.reports.picture import picture
from dhlib.grading.reports.records import read_results, renamed
from dhlib.grading.reports.shape import number_text, show
from dhlib.grading.reports.similarity import fingerprint
from dhlib.grading.reports.statistics import unusual
from dhlib.grading.reports.write import page_names
from dhlib.grading.sections import CHAPTERS

from .conftest import ROOT, exercise, hand_in, marked, odd, right, submission

INJECTIONS = (
    "<script>document.title = 'ran'</script>",
    "<img src=x onerror=\"document.title = 'ran'\">",
    '"><svg onload="document.title = \'ran\'">',
    "' onmouseover='document.title = 1' x='",
    "</style><style>body { display: none }</style>",
    "</title><script>document.title = 'ran'</script>",
    "<a href=\"javascript:document.title = 'ran'\">x</a>",
    '<meta http-equiv=refresh content="0;url=http://evil.invalid">',
    "<iframe srcdoc=\"<script>parent.document.title = 'ran'</script>\"></iframe>",
    "{{ 7 * 7 }}{% raw %}",
    "<!-- -->]]>\u202e\u0000&lt;",
)
ALL = " ".join(INJECTIONS)


def find(record):
    return exercise()


@pytest.fixture(scope="module")
def hostile_rows():
    """Marks of somebody who put markup everywhere a student can put text."""
    readings = hand_in(random.Random(2), 0.3)
    readings["table"] = {"table": {"rows": [[ALL[:90], 1.0, 2.0, 3.0]] * 4, "columns": [ALL[:50], "d", "a", "alpha"]}}
    readings["slip"] = {"choice": ALL[:200]}
    readings["A1"] = {"fault": "raised", "type": ALL[:200], "text": ALL}
    readings["A2"] = {"fault": "symbols", "names": [ALL[:200], "x"]}
    rows = marked(readings)
    return [replace(row, message=f"{row.message} {ALL}") for row in rows]


@pytest.fixture
def hostile(results, hostile_rows):
    source = f"{ALL.replace('/', '')}/x.ipynb"
    results.add(submission("eve", ALL, source, hostile_rows, message=ALL), hostile_rows)
    adjust(results, Adjustment(exercise="quickshot", student="eve", part="A1", points=1, reason=ALL))
    adjust(results, Adjustment(exercise="quickshot", student="eve", part="", points=-1, reason=ALL))
    set_rule(results, Rule(student="eve", due="2026-11-20T20:00:00+00:00", late="10%/day", reason=ALL))
    return read_results(results)[0]


def tags(page):
    return {tag.lower() for tag in re.findall(r"<\s*([a-zA-Z]\w*)", page)}


#: Everything that a page is made of.
HARMLESS = {
    *("html", "head", "meta", "title", "style", "body", "header", "footer", "section", "h1", "h2", "h3", "p", "span"),
    *("div", "ul", "ol", "li", "a", "table", "caption", "tr", "th", "td", "figure", "figcaption", "strong"),
    *("i", "sub", "svg", "desc", "g", "path", "circle", "text", "tspan"),
}


def test_no_tag_of_a_student_gets_into_the_page(hostile):
    page = feedback_page(hostile, find, reveal=True)
    assert tags(page) <= HARMLESS
    assert page.count("<style>") == 1
    assert not re.search(r"<[^>]*\s(on\w+|srcdoc|src)\s*=", page)
    assert "javascript:" not in re.sub(r"&[#\w]+;", " ", "".join(re.findall(r"<[^>]*>", page)))
    assert "49" not in re.findall(r"\{\{.*?\}\}|49", page)
    assert "{{ 7 * 7 }}" in page


def test_an_injection_would_be_found(hostile):
    page = feedback_page(hostile, find)
    assert not tags(page.replace("</h1>", "</h1><script>", 1)) <= HARMLESS


def test_the_policy_allows_the_style_sheet_and_nothing_else(hostile):
    page = feedback_page(hostile, find)
    (style,) = re.findall(r"<style>(.*?)</style>", page, re.DOTALL)
    (said,) = re.findall(r'Content-Security-Policy" content="([^"]*)"', page)
    assert said.replace("&#39;", "'") == policy(style)
    assert "unsafe" not in said
    assert page.index("Content-Security-Policy") < page.index("<style>")


@pytest.mark.browser
def test_nothing_runs_in_a_browser(hostile, tmp_path, browser):
    (tmp_path / "page.html").write_text(feedback_page(hostile, find, "https://example.org/dh"), "utf-8")
    planted = feedback_page(hostile, find).replace("</h1>", "</h1><script>document.title = 'ran'</script>", 1)
    (tmp_path / "planted.html").write_text(planted, "utf-8")
    for name in ("page.html", "planted.html"):  # the policy holds even where escaping would have failed
        page = browser.new_page()
        asked = []
        page.on("request", lambda request, asked=asked: asked.append(request.url))
        page.goto((tmp_path / name).as_uri())
        page.mouse.move(200, 200)
        assert page.title() == "The Quickshot: feedback"
        assert len(asked) == 1
        assert page.evaluate("getComputedStyle(document.body).display") == "block"
        assert page.evaluate("getComputedStyle(document.querySelector('.grid')).borderCollapse") == "collapse"
        page.close()


@pytest.mark.browser
def test_pages_fit_on_a_phone(class_folder, tmp_path, browser):
    from dhlib.grading.batch.store import Store

    with Store(class_folder) as store:
        records = read_results(store)
    worst = min(records, key=lambda record: record.points)
    for name, content in (("class", class_page(records, find)), ("student", feedback_page(worst, find, reveal=True))):
        (tmp_path / f"{name}.html").write_text(content, "utf-8")
        page = browser.new_page(viewport={"width": 390, "height": 800})
        page.goto((tmp_path / f"{name}.html").as_uri())
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        page.close()


def test_a_page_says_what_happened(results):
    readings = {"A1": odd("A1", random.Random(1)), "slip": right("slip")}
    rows = marked(readings)
    results.add(submission("ada", "Ada", "ada/x.ipynb", rows), rows)
    adjust(results, Adjustment(exercise="quickshot", student="ada", part="A1", points=0.5, reason="Nearly there."))
    adjust(results, Adjustment(exercise="quickshot", student="ada", part="", points=2, reason="Found an erratum."))
    set_rule(results, Rule(due="2026-11-20T20:00:00+00:00", late="10%/day, max 50%", grace="5min"))
    (record,) = read_results(results)
    assert (record.earned, record.deducted, record.points) == (3.5, 3.0, 0.5)
    page = feedback_page(record, find, "https://example.org/dh")
    for said in ("0.5 of 30 points", "Nearly there.", "Found an erratum.", "handed in 1 hour late", "at most 50 %"):
        assert said in page
    assert page.count('class="differs"') >= 1
    assert 'href="https://example.org/dh/book/' in page


def test_the_right_answer_is_shown_only_where_it_is_asked_for(results):
    part = exercise().part("A1")
    entry = f"{part.asks.values(part.chain)[0][0, 3]:.4g}"
    wrong = np.full((1, 4, 4), 7.0).tolist()
    rows = marked({"A1": {"values": wrong}})
    results.add(submission("ada", "Ada", "ada/x.ipynb", rows), rows)
    (record,) = read_results(results)
    assert entry not in feedback_page(record, find)
    assert entry in feedback_page(record, find, reveal=True)
    assert "What it should be" in feedback_page(record, find, reveal=True)


def test_only_entries_that_differ_are_marked():
    values = np.array(right("A1")["values"])
    values[0, 1, 3] += 5
    grid = show(exercise().part("A1"), {"values": values.tolist()}).answer
    differing = [[cell.verdict == "differs" for cell in row] for row in grid.rows]
    assert np.argwhere(differing).tolist() == [[1, 3]]
    assert show(exercise().part("A1"), right("A1")).answer.differing == 0


@pytest.mark.parametrize("part_id", ["frames", "table", "A1", "A1_sym", "link", "slip", "mended"])
@pytest.mark.parametrize(
    "reading",
    [
        None,
        [],
        {},
        {"values": None},
        {"values": [[["x"]]]},
        {"values": [[[10**400]]]},
        {"values": [[1e300] * 4] * 4},
        {"table": []},
        {"table": {"rows": 3}},
        {"table": {"rows": [[{}, None, True, "=1"]] * 99, "columns": [1, 2]}},
        {"table": {"rows": [[float("nan")] * 4] * 4, "columns": None}},
        {"table": {"rows": [["q1", 1e9, 1e9, 1.0]] * 4, "columns": None, "convention": "none"}},
        {"choice": 3},
        {"values": [np.full((5, 4, 4), 1e8).tolist()]},
        {"values": [np.full((5, 4, 4), float("nan")).tolist()]},
    ],
)
def test_nothing_that_comes_out_of_a_box_breaks_a_page(part_id, reading):
    show(exercise().part(part_id), reading, reveal=True)
    picture(exercise().part(part_id), reading)


@pytest.mark.parametrize(
    ("reading", "line"),
    [
        (None, ""),
        ({"fault": "missing"}, ""),
        ({"table": {"rows": [["q1", None, 0.25], [True, 2, "x"]]}}, "q1  0.25  True  2  x"),
        ({"values": [[-1.5, None]]}, "−1.5"),
    ],
)
def test_an_answer_in_brief_is_a_line(reading, line):
    assert brief(reading) == line


def test_origins_that_are_right_are_shown_where_they_are_asked_for():
    part = exercise().part("frames")
    shown = show(part, right("frames"), reveal=True)
    assert shown.right.headings == ("x in mm", "y in mm", "z in mm")
    origins = part.chain.frames(np.zeros(4))[:, :3, 3]
    assert [cell.text for cell in shown.right.rows[4]] == [number_text(x) for x in origins[4]]
    assert show(part, right("frames")).right is None
    metres = Part("f", "F", 1, part.asks, arm=Chain(part.chain.joints, "classic"))
    assert show(metres, right("frames"), reveal=True).right.headings == ("x in m", "y in m", "z in m")


def test_values_that_may_differ_and_mean_the_same_are_not_marked():
    arm = robots.planar(2)
    asks = Function(lambda arm, x, y: [x, y], shape=(2,), calls=[(0.4, 1.1)], signature="f(x, y)", means=arm.fk)
    grid = show(Part("f", "F", 1, asks, arm=arm), {"values": [[0.4, 1.1 + 2 * np.pi]]}).answer
    assert (grid.caption, grid.differing) == ("Your f", 0)


def test_a_long_argument_is_left_out_of_the_caption():
    asks = Function(lambda arm, T, k: k * T[0, 3], shape=(), calls=[(Tx(2.0), 3), (Tx(5.0), 4)], signature="f(T, k)")
    part = Part("f", "F", 1, asks, arm=robots.planar(2))
    assert show(part, {"values": [6.0, 21.0]}).answer.caption == (
        "Your f for f(…, 4) (it differs at 1 of 2 places tried)"
    )


def test_several_matrices_are_shown_below_each_other():
    asks = Numbers(lambda arm, q: [arm.A(1, q), arm.A(2, q)], shape=(2, 4, 4), at=(0.3, 0.5))
    part = Part("both", "B", 1, asks, arm=robots.planar(2))
    values = asks.values(part.chain)
    values[0, 1, 0, 3] += 5
    grid = show(part, {"values": values.tolist()}).answer
    assert [len(row) for row in grid.rows] == [4] * 8
    assert np.argwhere([[cell.verdict == "differs" for cell in row] for row in grid.rows]).tolist() == [[4, 3]]


def test_a_table_is_drawn_as_the_arm_that_it_describes():
    drawn = picture(exercise().part("table"), right("table"))
    assert {"x_4", "z_4"} <= {word for label in drawn.labels for word in label.text.split(", ")}


def test_frames_are_drawn_beside_the_axes():
    sketch = picture(exercise().part("frames"), right("frames"))
    said = {label.text for label in sketch.labels}
    assert {"x_0", "z_0", "1", "2", "3", "4"} <= {piece for text in said for piece in text.split(", ")}
    far = np.array(right("frames")["values"])
    far[0, 4, :3, 3] = 1e6
    assert "Frame 4: too far away" in picture(exercise().part("frames"), {"values": far.tolist()}).alt


def test_links_lead_into_the_book():
    for page, _, sections in CHAPTERS:
        for label in sections:
            assert link("https://x.org", label) == f"https://x.org/book/{page}.html#{label}"
            assert f"({label})=" in (ROOT / "book" / f"{page}.md").read_text("utf-8")


@pytest.mark.parametrize("address", ["javascript:alert(1)", "data:text/html,x", "example.org", "", "//x", "http:"])
def test_an_address_that_is_none_is_refused(address):
    with pytest.raises(DHError, match="no address of the book"):
        read_address(address)


# The class


@pytest.fixture(scope="module")
def records(class_folder):
    from dhlib.grading.batch.store import Store

    with Store(class_folder) as store:
        return read_results(store)


def test_the_class_page_has_all_sections(records):
    page = class_page(records, find, "https://example.org/dh")
    for heading in (
        "What to say in the next lecture",
        "Part by part",
        "Misconceptions by part",
        "Worth a look",
        "Alike",
    ):
        assert f"<h2>{heading}</h2>" in page
    assert page.count("<svg") == 3
    assert not re.search(r"<[^>]*\s(style|on\w+)=", page)
    assert "http://" not in re.sub(r'xmlns(:\w+)?="[^"]*"', "", page)
    assert len(re.findall(r"<style", page)) == 1


def test_a_small_class_gets_no_statistics(records):
    page = class_page(records[:4], find)
    assert "fewer than 5" in page
    assert "Median" not in page
    assert "<svg" not in page
    assert "Median" in class_page(records[:5], find)


def test_a_class_of_nobody_is_a_page():
    assert "Nothing was handed in yet" in class_page([], find)


def test_a_file_that_says_nothing_stands_with_its_class(results):
    rows = marked({"slip": right("slip")})
    for k in range(5):
        results.add(submission(str(k), f"S{k}", f"s{k}/x.ipynb", rows), rows)
    lost = submission(
        "9", "Eve", "eve/x.ipynb", status="unreadable", message="x.ipynb is a PDF.", exercise="", out_of=0
    )
    results.add(lost)
    page = class_page(read_results(results), find)
    assert page.count("<h1>") == 1
    assert "Eve: x.ipynb is a PDF." in page
    assert page_names(read_results(results)).keys() == {each.id for each in results.submissions()}
    assert "S0.html" in page_names(read_results(results)).values()


def test_everybody_alike_is_no_trouble(results):
    rows = marked({part.id: right(part.id) for part in exercise().parts})
    for k in range(6):
        results.add(submission(str(k), f"S{k}", f"s{k}/x.ipynb", rows), rows)
    page = class_page(read_results(results), find)
    assert "all did alike" in page
    assert "No known misconception showed" in page
    assert "<h3>" not in page  # the same right answers mean nothing


def test_the_lecture_is_about_what_cost_most(results):
    from dhlib.grading.reports.lecture import costs

    chance = random.Random(5)
    for k in range(8):
        readings = {part.id: right(part.id) for part in exercise().parts}
        if k < 5:  # five of eight turn T4 round
            value = np.array(right("T4")["values"])
            readings["T4"] = {"values": value.transpose(0, 2, 1).tolist()}
        if k == 7:
            readings["A1"] = odd("A1", chance)
        rows = marked(readings)
        results.add(submission(str(k), f"S{k}", f"s{k}/x.ipynb", rows), rows)
    records = read_results(results)
    dearest = costs(records)[0]
    assert (dearest.key, dearest.students, dearest.parts[0]) == ("transpose", 5, "T4")
    lost = sum(a.row.out_of - a.points for r in records for a in r.answers if a.row.misconception == "transpose")
    assert dearest.points == pytest.approx(lost)
    page = class_page(records, find)
    assert "5 of 8 students" in page


def test_rare_wrong_answers_are_set_side_by_side(results):
    from dhlib.grading.reports.similarity import alike, same_files

    chance = random.Random(9)
    shared = {part: odd(part, chance) for part in ("A2", "A3", "T4_quarter")}
    for k in range(8):
        readings = {part.id: right(part.id) for part in exercise().parts}
        readings |= shared if k in (2, 5) else {"A2": odd("A2", chance)}
        rows = marked(readings)
        results.add(submission(str(k), f"S{k}", f"s{k}/x.ipynb", rows, sha256="same" if k in (2, 5) else str(k)), rows)
    records = read_results(results)
    (pair,) = alike(records)
    assert {pair.first.student, pair.second.student} == {"2", "5"}
    assert {each.part for each in pair.shared} == shared.keys()
    assert all(each.students == 2 for each in pair.shared)
    assert [{record.student for record in group} for group in same_files(records)] == [{"2", "5"}]
    assert not alike([record for record in records if record.student != "5"])


def test_who_is_right_where_most_are_wrong_is_worth_a_look(results):
    parts = [part.id for part in exercise().parts]
    easy, hard = parts[:12], parts[12:]
    for k in range(8):
        answered = hard[:4] if k == 6 else easy + hard[: k % 2]
        rows = marked({part: right(part) for part in answered})
        results.add(submission(str(k), f"S{k}", f"s{k}/x.ipynb", rows), rows)
    told = {(each.record.student, each.why) for each in unusual(read_results(results))}
    against = "right where most are wrong, and wrong where most are right"
    assert [student for student, why in told if why == against] == ["6"]


def test_where_a_formula_has_no_value_answers_are_alike():
    nan = float("nan")
    one, same, other = ({"values": [[x, 1.25, 2.5, 3.75]]} for x in (nan, nan, 0.5))
    assert fingerprint(one) == fingerprint(same) != fingerprint(other)
    assert fingerprint(one).startswith("nan|")


def test_the_same_file_says_nothing_if_all_in_it_is_right(results):
    from dhlib.grading.reports.similarity import same_files

    whole = {part.id: right(part.id) for part in exercise().parts}
    for k, readings in enumerate((whole, whole, whole | {"A2": odd("A2", random.Random(3))})):
        rows = marked(readings)
        for student in (f"{k}", f"{k}b"):
            file = submission(student, student, f"{student}/x.ipynb", rows, sha256="wrong" if k == 2 else "whole")
            results.add(file, rows)
    assert [{record.student for record in group} for group in same_files(read_results(results))] == [{"2", "2b"}]


def test_names_stay_out_where_they_should(records):
    # Two who handed in the same file are named.
    first, second, *others = records
    same = [replace(record, submission=replace(record.submission, sha256="same")) for record in (first, second)]
    records = [*same, *others]
    page = class_page(renamed(records, lambda student: f"student-{student}"), find)
    words = {word for record in records for word in record.name.split()}
    assert not [word for word in words if re.search(rf"\b{re.escape(word)}\b", page)]
    named = class_page(records, find)
    assert [word for word in words if word in named]


def test_a_name_in_a_message_stays_out_too(results):
    rows = marked({})
    adjusted = "Ada came to see me"
    results.add(submission("17", "Ada Müller", "Müller_Ada/x.ipynb", rows, message="Müller_Ada/x.ipynb was odd"), rows)
    adjust(results, Adjustment(exercise="quickshot", student="17", part="A1", points=1, reason=adjusted))
    (record,) = renamed(read_results(results), lambda student: "somebody")
    page = feedback_page(record, find)
    assert not re.search("Ada|Müller", page)
    assert "came to see me" in page
    assert "Ada" not in json.dumps([record.submission.message, record.submission.source])
