"""Files for other systems, each read as that system reads it."""

import csv
import io
import json
import random
import re
import zipfile
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from dhlib.cli import main
from dhlib.errors import DHError
from dhlib.grading.reports import canvas, classroom, gradescope, junit, moodle, nbgrader, whole
from dhlib.grading.reports.cells import FORMULA, safe, table
from dhlib.grading.reports.decisions import Adjustment, Rule, adjust, set_rule
from dhlib.grading.reports.formats import Wishes
from dhlib.grading.reports.grades import grades
from dhlib.grading.reports.records import read_results

from .conftest import hand_in, marked, submission

HOSTILE = '=HYPERLINK("http://evil")\n<script>alert(1)</script>,"q" ünïcode ]]> \x07'


PEOPLE = (
    ("123", "Ada Müller", "Ada Müller_123_assignsubmission_file_/quickshot.ipynb"),
    ("77", "Björn", "bjoern_late_77_901_quickshot.ipynb"),
    ("124", HOSTILE, f"{HOSTILE.replace('/', '')}_124_assignsubmission_file_/=x.ipynb"),
)


@pytest.fixture(scope="module")
def three_marked():
    chance = random.Random(3)
    return [marked(hand_in(chance, 0.6)) for _ in PEOPLE]


@pytest.fixture
def records(results, three_marked):
    """Ada from Moodle, Björn from Canvas, and somebody who means harm; Ada was late, and was given points."""
    for (number, name, source), rows in zip(PEOPLE, three_marked, strict=True):
        results.add(submission(number, name, source, rows, message=HOSTILE if number == "124" else ""), rows)
    set_rule(results, Rule(due="2026-11-20T20:00:00+00:00", late="10%/day"))
    adjust(results, Adjustment(exercise="quickshot", student="123", part="slip", points=1, reason="=seen in class"))
    return {record.student: record for record in read_results(results)}


def rows_of(content):
    return list(csv.reader(io.StringIO(content.decode("utf-8-sig"), newline="")))


def harmless(rows):
    """No cell that a spreadsheet would run; numbers and a lone hyphen are none."""
    cells = [cell for row in rows for cell in row if cell.lstrip().startswith(FORMULA)]
    return [cell for cell in cells if not re.match(r"-(\d|$)", cell)]


@pytest.mark.parametrize("cell", ["=1+1", "+1", "-x", "@x", "\t=1", " =1", "\r=1", "\n=1", "＝1", "-1+1"])
def test_formulas_are_quoted(cell):
    assert safe(cell).startswith("'")


def test_what_is_no_formula_stays():
    for cell in ("plain -1", "-2.5", "-", 'Müller "Max"'):
        assert safe(cell) == cell


def test_a_formula_would_be_found():
    assert harmless([["=1+1"]]) == ["=1+1"]
    assert rows_of(table(["a"], [["=1+1"]]))[1] == ["'=1+1"]


def test_grades_open_in_a_spreadsheet(records):
    content = grades(list(records.values()), {1: "feedback/ada.html"})
    assert content.startswith(b"\xef\xbb\xbf")
    rows = rows_of(content)
    assert {len(row) for row in rows} == {len(rows[0])}
    assert not harmless(rows)
    ada = next(dict(zip(rows[0], row, strict=True)) for row in rows if row[0] == "123")
    assert ada["name"] == "Ada Müller"
    assert ada["slip"] == "1"
    assert float(ada["points"]) == records["123"].points
    assert sum(float(ada[a.row.part]) for a in records["123"].answers) - float(ada["deducted"]) == pytest.approx(
        float(ada["points"])
    )


# Moodle: importgradeslib.php finds columns by heading and the participant by the number after 'Participant '


def moodle_reads(content):
    """What Moodle's importer makes of a worksheet: participant to grade and comment."""
    header, *rows = rows_of(content)
    where = {name: header.index(name) for name in ("Identifier", "Grade", "Last modified (grade)", "Feedback comments")}
    read = {}
    for row in rows:
        number = row[where["Identifier"]][len("Participant ") :]
        assert number.isdigit()
        read[int(number)] = (float(row[where["Grade"]]), row[where["Feedback comments"]])
    return read


def test_moodle_reads_its_worksheet(records):
    files = moodle.write(list(records.values()), Wishes())
    read = moodle_reads(files["moodle-grades.csv"])
    assert {number: grade for number, (grade, _) in read.items()} == {
        123: records["123"].points,
        124: records["124"].points,
    }
    assert all(0 <= grade <= 30 for grade, _ in read.values())
    assert not harmless(rows_of(files["moodle-grades.csv"]))
    assert "<script" not in read[124][1]
    assert "&lt;script&gt;" in read[124][1]
    assert "Changed by hand" in read[123][1]
    assert "late" in read[123][1]


def test_moodle_gets_its_own_worksheet_back_filled_in(records, tmp_path):
    header = "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed,"
    header += "Last modified (submission),Last modified (grade),Feedback comments"
    given = [
        'Participant 123,"Müller, Ada",ada@example.org,Submitted,,60.00,Yes,"Friday, 20 November 2026, 9:00 PM",-,',
        "Participant 999,Somebody Else,else@example.org,No submission,,60.00,Yes,-,-,",
    ]
    worksheet = tmp_path / "Grades.csv"
    worksheet.write_text("\n".join([header, *given]), "utf-8-sig")
    content = moodle.write(list(records.values()), Wishes(worksheet=worksheet))["moodle-grades.csv"]
    rows = rows_of(content)
    assert rows[0] == header.split(",")
    assert rows[1][1:3] == ["Müller, Ada", "ada@example.org"]
    assert float(rows[1][4]) == pytest.approx(2 * records["123"].points)  # the assignment is worth 60
    assert rows[2] == given[1].split(",")
    assert rows[1][8] == "-"


def test_moodle_finds_the_folders_it_made(records):
    pages = {record.submission.id: b"page of " + record.student.encode() for record in records.values()}
    content = moodle.write(list(records.values()), Wishes(pages=pages))["moodle-feedback.zip"]
    archive = zipfile.ZipFile(io.BytesIO(content))
    for name in archive.namelist():
        folder, file = name.rsplit("/", 1)
        info = folder.split("_", 4)  # as importziplib.php takes it apart
        assert info[2:4] == ["assignsubmission", "file"]
        assert file[0] not in ".~"
        assert archive.read(name) == b"page of " + info[1].encode()
    assert len(archive.namelist()) == 2


def test_a_worksheet_without_maximum_and_comments_gets_its_grades(records, tmp_path):
    worksheet = tmp_path / "Grades.csv"
    worksheet.write_text("Identifier,Full name,Grade\nParticipant 123,Ada,\nParticipant 999,Else,\n", "utf-8")
    rows = rows_of(moodle.write(list(records.values()), Wishes(worksheet=worksheet))["moodle-grades.csv"])
    assert rows[1][:2] == ["Participant 123", "Ada"]
    assert float(rows[1][2]) == records["123"].points
    assert rows[2] == ["Participant 999", "Else", ""]


def test_moodle_says_what_is_missing(records, tmp_path):
    with pytest.raises(DHError, match="none of these came from Moodle"):
        moodle.write([records["77"]], Wishes())
    for text in ("", "Name,Points\nAda,3\n"):
        (tmp_path / "other.csv").write_text(text, "utf-8")
        with pytest.raises(
            DHError, match=r"other\.csv has no columns Identifier and Grade: is it the grading worksheet"
        ):
            moodle.write(list(records.values()), Wishes(worksheet=tmp_path / "other.csv"))


def test_a_part_that_nobody_touched_needs_no_more_words(results):
    rows = [replace(row, message="") for row in marked({})]
    results.add(submission("123", "Ada", PEOPLE[0][2], rows), rows)
    (record,) = read_results(results)
    said = moodle.write([record], Wishes())["moodle-grades.csv"].decode()
    assert "A1 (0 of 1): still open.<br>" in said


# Canvas: gradebook_importer.rb wants Student, ID, …, Section, and then assignments


def test_canvas_reads_its_gradebook(records):
    files = canvas.write(list(records.values()), Wishes(title="Quickshot (4711)"))
    header, possible, *rows = rows_of(files["canvas-grades.csv"])
    assert "Student" in header[0]
    assert "ID" in header[1]
    assert header[2:5] == ["SIS User ID", "SIS Login ID", "Section"]
    assert "Points Possible" in possible[0]
    assert (header[5], possible[5]) == ("Quickshot (4711)", "30")
    assert [row[1] for row in rows] == ["77"]
    assert float(rows[0][5]) == records["77"].points


def test_canvas_attaches_what_comes_back(records):
    pages = {record.submission.id: b"page" for record in records.values()}
    content = canvas.write(list(records.values()), Wishes(pages=pages))["canvas-comments.zip"]
    (name,) = zipfile.ZipFile(io.BytesIO(content)).namelist()
    numbers = [piece for piece in name.split("_") if re.fullmatch(r"\d+", piece)][:2]  # as assignment.rb does
    assert numbers == ["77", "901"]
    assert not name.split("_")[-1].startswith("link")


def test_canvas_says_what_is_missing(records, tmp_path):
    (tmp_path / "book.csv").write_text("Student,ID,Section,Quickshot\nBorg,77,A,\n", "utf-8")
    for wishes in (Wishes(), Wishes(title="Quickshot", worksheet=tmp_path / "book.csv")):
        with pytest.raises(DHError, match="none of these came from Canvas: its files are called name_123_456_file"):
            canvas.write([records["123"]], wishes)
    for text, words in (
        ("", "has no columns Student, ID and Section: is it the exported gradebook"),
        ("Student,ID\nBorg,77\n", "has no columns Student, ID and Section"),
        ("Student,ID,Section,Homework (12)\nBorg,77,A,\n", "has no assignment 'Quickshot'; name it with --title"),
    ):
        (tmp_path / "book.csv").write_text(text, "utf-8")
        with pytest.raises(DHError, match=words):
            canvas.write(list(records.values()), Wishes(title="Quickshot", worksheet=tmp_path / "book.csv"))


def test_canvas_takes_names_and_sections_from_its_own_export(records, tmp_path):
    gradebook = tmp_path / "book.csv"
    gradebook.write_text(
        "Student,ID,SIS User ID,SIS Login ID,Section,Quickshot (4711),Final Score\n"
        "    Points Possible,,,,,30,(read only)\n"
        '"Borg, Björn",77,b77,borg,Group A,,\n',
        "utf-8",
    )
    files = canvas.write(list(records.values()), Wishes(title="Quickshot", worksheet=gradebook))
    rows = rows_of(files["canvas-grades.csv"])
    assert rows[0][5] == "Quickshot (4711)"
    assert rows[2][:5] == ["Borg, Björn", "77", "b77", "borg", "Group A"]


# Gradescope: https://gradescope-autograders.readthedocs.io/en/latest/specs/

FORMATS = {"text", "html", "simple_format", "md", "ansi"}
VISIBILITY = {"hidden", "after_due_date", "after_published", "visible"}
RESULT = {
    "score", "execution_time", "output", "output_format", "test_output_format", "test_name_format", "visibility",
    "stdout_visibility", "extra_data", "tests", "leaderboard",
}  # fmt: skip
TEST = {
    "score", "max_score", "status", "name", "name_format", "number", "output", "output_format", "tags", "visibility",
    "extra_data",
}  # fmt: skip


def check_gradescope(result):
    assert result.keys() <= RESULT
    assert isinstance(result["score"], int | float)
    assert {result["output_format"], result["test_output_format"], result["test_name_format"]} <= FORMATS
    assert result["stdout_visibility"] in VISIBILITY
    for test in result["tests"]:
        assert test.keys() <= TEST
        assert 0 <= test["score"] <= test["max_score"]
        assert test["status"] in ("passed", "failed")
        assert test["visibility"] in VISIBILITY
        assert all(isinstance(test[key], str) for key in ("name", "number", "output"))


def test_gradescope_reads_each_result(records):
    files = gradescope.write(list(records.values()), Wishes())
    assert len(files) == 3
    for content in files.values():
        check_gradescope(json.loads(content))
    ada = gradescope.result(records["123"])
    assert ada["score"] == records["123"].points
    assert sum(test["score"] for test in ada["tests"]) == pytest.approx(records["123"].earned)


def test_a_gradescope_result_of_another_shape_would_be_found(records):
    result = gradescope.result(records["123"])
    with pytest.raises(AssertionError):
        check_gradescope(result | {"points": 3})
    result["tests"][0]["status"] = "wrong"
    with pytest.raises(AssertionError):
        check_gradescope(result)


# JUnit: the elements and attributes of junit-10.xsd, which Jenkins' xUnit plugin checks against

ATTRIBUTES = {
    "testsuites": (set(), {"name", "time", "tests", "failures", "errors"}),
    "testsuite": (
        {"name", "tests", "failures", "errors"},
        {"group", "time", "skipped", "timestamp", "hostname", "id", "package", "file", "log", "url"},
    ),
    "properties": (set(), set()),
    "property": ({"name", "value"}, set()),
    "testcase": ({"name"}, {"time", "classname", "group"}),
    "failure": (set(), {"type", "message"}),
    "error": (set(), {"type", "message"}),
}
CHILDREN = {
    "testsuites": {"testsuite"},
    "testsuite": {"testsuite", "properties", "testcase", "system-out", "system-err"},
    "properties": {"property"},
    "testcase": {"skipped", "error", "failure", "system-out", "system-err"},
}


def check_junit(element):
    needed, allowed = ATTRIBUTES[element.tag]
    assert needed <= set(element.keys())
    assert set(element.keys()) <= needed | allowed
    for child in element:
        assert child.tag in CHILDREN.get(element.tag, set())
        check_junit(child)


def test_junit_keeps_to_its_schema(records, results):
    message = "x.ipynb is \x00 no notebook"
    results.add(submission("5", "Eve", "eve/x.ipynb", status="unreadable", message=message, out_of=0))
    everybody = read_results(results)
    root = ElementTree.fromstring(junit.write(everybody, Wishes())["junit.xml"])
    check_junit(root)
    for suite in root:
        assert int(suite.get("tests")) == len(suite.findall("testcase"))
        assert int(suite.get("failures")) == len(suite.findall("testcase/failure"))
        assert re.fullmatch(r"[0-9]{0,3}(\.[0-9]*)?", suite.get("time"))
    assert int(root.get("errors")) == len(root.findall("*/testcase/error")) == 1


def test_another_element_would_be_found():
    with pytest.raises(AssertionError):
        check_junit(ElementTree.fromstring('<testsuites><testcase name="x"/></testsuites>'))


# nbgrader: the columns of plugins/export.py


def test_nbgrader_has_its_columns(records):
    content = nbgrader.write(list(records.values()), Wishes())["nbgrader-grades.csv"]
    rows = list(csv.DictReader(io.StringIO(content.decode())))
    columns = "assignment,duedate,timestamp,student_id,last_name,first_name,email,raw_score,late_submission_penalty"
    assert list(rows[0]) == [*columns.split(","), "score", "max_score"]
    for row in rows:
        score = max(0.0, float(row["raw_score"]) - float(row["late_submission_penalty"]))
        assert float(row["score"]) == pytest.approx(score)
    assert not harmless(rows_of(content))


def test_json_holds_everything(records):
    content = json.loads(whole.write(list(records.values()), Wishes())["results.json"])
    ada = next(result for result in content["results"] if result["student"] == "123")
    slip = next(part for part in ada["parts"] if part["part"] == "slip")
    assert slip["reason"] == "=seen in class"
    assert slip["answer"]
    assert ada["late_seconds"] == 3600


def test_github_reads_the_points(records):
    files = classroom.report([records["123"], records["124"]], Wishes())
    _, report = files["github.txt"].decode().splitlines()
    points = json.loads(report.removeprefix("::notice title=Autograding report::"))
    assert points == {"totalPoints": records["123"].points + records["124"].points, "maxPoints": 60}
    summary = files["github.md"].decode()
    assert "<script" not in summary
    assert summary.count("\n") < 60  # no line of a student's breaks the tables


def test_several_exercises_are_refused_where_one_is_wanted(records, results):
    rows = marked({})
    source = "Ada Müller_123_assignsubmission_file_/planar.ipynb"
    results.add(submission("123", "Ada Müller", source, rows, exercise="planar"), rows)
    with pytest.raises(DHError, match="planar, quickshot"):
        moodle.write(read_results(results), Wishes())


def test_an_exercise_without_results_is_said(results, records, capsys):
    folder = str(results.path.parent)
    assert main(["export", folder, "--format", "json", "--exercise", "planar"]) == 2
    assert f"there are no results of planar in {folder}." in capsys.readouterr().err
    assert main(["export", folder, "--format", "json", "--exercise", "quickshot"]) == 0


def test_what_could_not_be_marked_gets_no_grade(records, results):
    message = "x.ipynb is no notebook."
    for number, source in (("9", "Eve_9_assignsubmission_file_/x.ipynb"), ("78", "eve_78_902_x.ipynb")):
        results.add(submission(number, "Eve", source, status="unreadable", message=message, exercise="", out_of=0))
    everybody = read_results(results)
    rows = rows_of(moodle.write(everybody, Wishes())["moodle-grades.csv"])
    (eve,) = (row for row in rows if row[0] == "Participant 9")
    assert eve[3] == ""
    assert message in eve[6]
    (eve,) = (row for row in rows_of(canvas.write(everybody, Wishes())["canvas-grades.csv"]) if row[1] == "78")
    assert eve[5] == ""
    assert ("9", "") in [(row[0], row[5]) for row in rows_of(grades(everybody, {}))]
