"""What the instructor decides by hand, rules for late work, the audit trail, and being forgotten."""

import sqlite3
import subprocess
import sys

import pytest

from dhlib.cli import main
from dhlib.errors import DHError
from dhlib.grading.batch.rows import Problem
from dhlib.grading.batch.store import Store
from dhlib.grading.reports.audit import audit
from dhlib.grading.reports.decisions import Rule, rules, set_rule, timing
from dhlib.grading.reports.forgetting import leftovers
from dhlib.grading.reports.late import LateRule, read_span, read_time
from dhlib.grading.reports.pseudonyms import pseudonyms
from dhlib.grading.reports.records import read_results

from .conftest import ROOT, marked, right, submission


@pytest.fixture(scope="module")
def rows():
    """Marks of somebody who found the slip, 1 of 30 points."""
    return marked({"slip": right("slip")})


@pytest.fixture
def class_of_three(tmp_path, rows, monkeypatch):
    """A folder with the results of three."""
    monkeypatch.chdir(ROOT)
    with Store(tmp_path, create=True) as store:
        for student, name, hour in (("ada", "Ada Müller", 20), ("bob", "Bob", 22), ("cleo", "Cleopatra VII", 23)):
            at = f"2026-11-20T{hour}:30:00+00:00"
            store.add(submission(student, name, f"{name}/quickshot.ipynb", rows, submitted=at), rows)
    assert main(["report", str(tmp_path)]) == 0
    return tmp_path


def points(folder):
    with Store(folder) as store:
        return {record.student: record.points for record in read_results(store)}


def run(folder, *arguments):
    return main([arguments[0], str(folder), *arguments[1:]])


def test_points_are_changed_and_taken_back(class_of_three, capsys):
    change = ("adjust", "--student", "Ada Müller", "--part", "A1", "--points", "0.5", "--reason", "The sign was ours.")
    assert run(class_of_three, *change) == 0
    assert points(class_of_three) == {"ada": 1.5, "bob": 1, "cleo": 1}
    assert "The sign was ours." in (class_of_three / "feedback" / "Ada_Müller.html").read_text("utf-8")
    assert ",1.5," in (class_of_three / "grades.csv").read_text("utf-8-sig")
    assert run(class_of_three, "adjust", "--list") == 0
    assert "adjustment 1  ada, quickshot, A1: 0.5 points. The sign was ours." in capsys.readouterr().out
    assert run(class_of_three, "adjust", "--revoke", "1") == 0
    assert points(class_of_three)["ada"] == 1
    assert "The sign was ours." not in (class_of_three / "feedback" / "Ada_Müller.html").read_text("utf-8")
    assert run(class_of_three, "adjust", "--revoke", "1") == 2
    run(class_of_three, "adjust", "--list")
    assert "revoked" in capsys.readouterr().out


def test_a_second_decision_takes_the_place_of_the_first(class_of_three):
    for value in ("0.25", "0.75"):
        run(class_of_three, "adjust", "--student", "ada", "--part", "A1", "--points", value, "--reason", "Look.")
    assert points(class_of_three)["ada"] == 1.75
    for _ in range(2):
        run(class_of_three, "adjust", "--student", "ada", "--bonus", "-0.5", "--reason", "Twice.")
    assert points(class_of_three)["ada"] == 0.75


def test_grading_again_loses_no_decision(class_of_three, rows):
    run(class_of_three, "adjust", "--student", "ada", "--part", "A1", "--points", "1", "--reason", "By hand.")
    better = marked({"slip": right("slip"), "A2": right("A2")})
    with Store(class_of_three) as store:
        again = next(each for each in store.submissions() if each.student == "ada")
        store.add(submission("ada", "Ada Müller", again.source, better), better)  # the same file
        later = submission("ada", "Ada Müller", "Ada Müller/quickshot.ipynb", better, sha256="new", sequence=9)
        store.add(later, better)  # another attempt
    assert points(class_of_three)["ada"] == 3


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--student", "Bobby", "--part", "A1", "--points", "1", "--reason", "x"], "nobody is called 'Bobby'"),
        (["--student", "Cleo", "--part", "A1", "--points", "1", "--reason", "x"], None),
        (["--student", "Cleopatra", "--part", "A1", "--points", "1", "--reason", "x"], "there is cleo (Cleopatra VII)"),
        (["--student", "bob", "--part", "A9", "--points", "1", "--reason", "x"], "no part 'A9'; its parts are frames"),
        (["--student", "bob", "--part", "A1", "--points", "7", "--reason", "x"], "worth 0 to 1 points"),
        (["--student", "bob", "--part", "A1", "--points", "nan", "--reason", "x"], "worth 0 to 1 points"),
        (["--student", "bob", "--part", "A1", "--points", "1"], "say why, with --reason"),
        (["--student", "bob", "--points", "1", "--reason", "x"], "--part and --points belong together"),
        (["--part", "A1", "--points", "1", "--reason", "x"], "Say --student"),
        (["--late", "10 points"], "it should read like '10%/day, max 50%'"),
        (["--late", "200%/day"], "more than 100 %"),
        (["--due", "tomorrow"], "should read like 2026-11-20T23:59"),
        (["--grace", "1h"], "--grace belongs to a rule"),
        ([], "say what to change"),
        (["--list", "--revoke", "1"], "one thing at a time"),
        (["--student", "bob", "--exercise", "planar", "--bonus", "1", "--reason", "x"], "no exercise 'planar'"),
        (["--student", "bob", "--exercise", "quickshot", "--bonus", "1", "--reason", "x"], None),
        (["--student", "bob", "--bonus", "nan", "--reason", "x"], "--bonus should be a number"),
    ],
)
def test_mistakes_are_said_in_a_sentence(class_of_three, capsys, arguments, words):
    code = run(class_of_three, "adjust", *arguments)
    assert (code == 0) == (words is None)
    if words:
        said = capsys.readouterr().err
        assert words in said
        assert said.startswith("dhlib: ")
        assert points(class_of_three) == {"ada": 1, "bob": 1, "cleo": 1}


def test_who_or_what_may_be_meant_is_listed(class_of_three, rows, capsys):
    with Store(class_of_three) as store:
        store.add(submission("b2", "Bob", "Bob/2.ipynb", rows), rows)
        store.add(submission("ada", "Ada Müller", "Ada/planar.ipynb", rows, exercise="planar"), rows)
    bonus = ("--bonus", "1", "--reason", "x")
    assert run(class_of_three, "adjust", "--student", "Bob", *bonus) == 2
    assert "'Bob' may be b2 (Bob), bob (Bob): say which by the first of the two." in capsys.readouterr().err
    assert run(class_of_three, "adjust", "--student", "ada", *bonus) == 2
    assert "there are several exercises: planar, quickshot. Say which with --exercise NAME." in capsys.readouterr().err
    assert run(class_of_three, "adjust", "--student", "ada", "--exercise", "quickshot", *bonus) == 0
    with Store(class_of_three) as store:
        gained = {(record.student, record.exercise): record.points for record in read_results(store)}
    assert (gained["ada", "quickshot"], gained["ada", "planar"]) == (2, 1)


@pytest.mark.parametrize(
    ("option", "words"), [("--exercises", "--exercises names the folder that holds NAME.py"), ("--key", "dhlib key")]
)
def test_a_folder_or_a_key_that_is_not_there_is_said_and_not_kept(class_of_three, capsys, option, words):
    assert run(class_of_three, "report", option, "nowhere") == 2
    assert words in capsys.readouterr().err
    assert run(class_of_three, "report") == 0


@pytest.mark.parametrize("command", ["report", "adjust", "export"])
def test_a_folder_without_results_is_said(tmp_path, capsys, command):
    more = {"adjust": ["--list"], "export": ["--format", "json"]}.get(command, [])
    assert main([command, str(tmp_path), *more]) == 2
    assert "there are no results" in capsys.readouterr().err


# Late


def test_a_due_time_costs_whoever_missed_it(class_of_three):
    assert (
        run(class_of_three, "adjust", "--due", "2026-11-20T22:00+00:00", "--late", "1%/hour", "--grace", "31min") == 0
    )
    with Store(class_of_three) as store:
        records = {record.student: record for record in read_results(store)}
    assert (records["ada"].late_seconds, records["ada"].about_time) == (0, "")
    assert (records["bob"].deducted, records["cleo"].deducted) == (0, 0.3)
    assert "Nothing is taken away" in records["bob"].about_time
    page = (class_of_three / "feedback" / "Cleopatra_VII.html").read_text("utf-8")
    assert "handed in 1 hour and 30 minutes late" in page
    assert "0.7 of 30 points" in page


def test_one_may_have_more_time_than_others(class_of_three):
    run(class_of_three, "adjust", "--due", "2026-11-20T20:00+00:00", "--late", "1%/day")
    more = ("adjust", "--student", "bob", "--due", "2026-11-27T20:00+00:00", "--reason", "was ill")
    assert run(class_of_three, *more) == 0
    assert points(class_of_three) == {"ada": 0.7, "bob": 1, "cleo": 0.7}
    assert "was ill" in (class_of_three / "feedback" / "Bob.html").read_text("utf-8")
    assert run(class_of_three, "adjust", "--revoke-rule", "2") == 0
    assert points(class_of_three)["bob"] == 0.7


def test_a_due_time_without_a_rule_costs_nothing(class_of_three, capsys):
    run(class_of_three, "adjust", "--due", "2026-11-20T20:00+00:00")
    assert "All: due 2026-11-20 20:00:00 UTC" in capsys.readouterr().out
    assert points(class_of_three)["ada"] == 1
    assert "30 minutes late" in (class_of_three / "feedback" / "Ada_Müller.html").read_text("utf-8")
    run(class_of_three, "adjust", "--late", "2%/day")  # the due time stays
    assert points(class_of_three)["ada"] == 0.4


def test_who_is_late_by_an_unknown_time_loses_nothing(results, rows):
    results.add(submission("ada", "Ada", "ada/x.ipynb", rows, submitted="", late=True), rows)
    set_rule(results, Rule(due="2026-11-20T20:00:00+00:00", late="10%/day"))
    (record,) = read_results(results)
    assert record.points == 1
    assert "by how much is not known" in record.about_time


@pytest.mark.parametrize(("seconds", "percent"), [(0, 0), (1, 10), (86400, 10), (86401, 20), (10**9, 50)])
def test_a_rule_counts_periods_begun(seconds, percent):
    assert LateRule.read("10%/day, max 50%").percent_off(seconds) == percent


@pytest.mark.parametrize(
    "rule", ["10", "10%", "10%/month", "10%/day,", "10%/day, min 5%", "ten%/day", "10%/day, max 50%, x"]
)
def test_what_is_no_rule_is_refused(rule):
    with pytest.raises(DHError, match="should read like"):
        LateRule.read(rule)


def test_times_without_a_zone_are_those_of_this_machine():
    assert read_time("2026-11-20 23:59").utcoffset().total_seconds() == 0
    with pytest.raises(DHError):
        read_span("soon")


def test_the_narrowest_rule_holds():
    listed = [
        Rule(due="2026-01-01T00:00:00+00:00", late="10%/day"),
        Rule(exercise="planar", due="2026-01-02T00:00:00+00:00"),
        Rule(student="ada", exercise="planar", due="2026-01-03T00:00:00+00:00"),
    ]
    days = [timing(listed, *who).due.day for who in (("ada", "planar"), ("bob", "planar"), ("ada", "x"))]
    assert days == [3, 2, 1]
    assert all(timing(listed, *who).late for who in (("ada", "planar"), ("bob", "x")))


# The audit trail


def test_who_changed_what_is_written_down(class_of_three, capsys):
    run(class_of_three, "adjust", "--student", "ada", "--part", "A1", "--points", "1", "--reason", "By hand.")
    run(class_of_three, "adjust", "--due", "2026-11-20T20:00+00:00", "--late", "1%/day")
    run(class_of_three, "adjust", "--revoke", "1")
    capsys.readouterr()
    assert run(class_of_three, "report", "--audit") == 0
    said = capsys.readouterr().out
    for line in ("graded  ada", "adjusted  ada  quickshot: A1: 1 points. By hand.", "rule set", "adjustment revoked"):
        assert line in said
    with Store(class_of_three) as store:
        hidden = "\n".join(audit(store, pseudonyms(store)))
        assert not [name for name in ("Ada", "ada", "Bob", "bob", "Cleo") if name in hidden]
        assert len(hidden.splitlines()) == len(audit(store))
        assert rules(store)


# Names


def test_pseudonyms_keep_names_out_of_all_that_is_written(class_of_three):
    names = ["Müller", "Cleopatra", "cleo", "Bob"]
    assert len(leftovers(class_of_three, names)) > 4
    assert run(class_of_three, "report", "--pseudonyms") == 0
    assert run(class_of_three, "export", "--format", "json") == 0
    assert run(class_of_three, "export", "--format", "junit") == 0
    left = {path.name for path in leftovers(class_of_three, names)}
    assert left <= {"results.sqlite", "results.sqlite-wal", "results.sqlite-shm"}
    assert run(class_of_three, "export", "--format", "moodle") == 2
    with Store(class_of_three) as store:
        alias = pseudonyms(store)("ada")
    assert run(class_of_three, "adjust", "--student", alias, "--bonus", "1", "--reason", "Good.") == 0
    assert points(class_of_three)["ada"] == 2
    assert run(class_of_three, "report", "--no-pseudonyms") == 0
    assert "Müller" in (class_of_three / "grades.csv").read_text("utf-8-sig")


# Forgetting


def test_nothing_is_left_of_who_is_forgotten(class_of_three, capsys):
    secret = "Zarathustra Unmistakable"
    told = marked({"slip": {"choice": "unmistakableanswer"}, "A1": {"fault": "raised", "type": "E", "text": secret}})
    with Store(class_of_three) as store:
        for k in range(40):  # enough to fill pages of the file
            store.add(submission("zara", secret, f"{secret}/{k}.ipynb", told, sha256=str(k), sequence=k), told)
        store.replace_problems(
            [Problem("zip", f"{secret} is claimed twice.", ("zara",)), Problem("x", "Other.", ("bob",))]
        )
        store.log("graded again", "zara", f"{secret}/3.ipynb: 1 before")
        store.log("seen", "", f"beside {secret}/3.ipynb")
    run(class_of_three, "adjust", "--student", "zara", "--bonus", "1", "--reason", f"{secret} came by")
    run(class_of_three, "adjust", "--student", "zara", "--due", "2026-11-20T20:00+00:00", "--reason", secret)
    run(class_of_three, "export", "--format", "json")
    (class_of_three / "problems.csv").write_text(f"where,what,students\n{secret},claimed twice,zara\n", "utf-8")
    words = [secret, "Zarathustra", "Unmistakable", "unmistakableanswer", "zara"]
    assert len(leftovers(class_of_three, words)) >= 4
    with Store(class_of_three) as reader:  # the results are open elsewhere while it happens
        assert reader.students()
    assert run(class_of_three, "forget", "zara", "--yes") == 0
    assert "40 submissions" in capsys.readouterr().out
    assert leftovers(class_of_three, words) == []
    assert points(class_of_three) == {"ada": 1, "bob": 1, "cleo": 1}
    with Store(class_of_three) as store:
        assert [problem.what for problem in store.problems()] == ["Other."]
        assert store.events()[-1].what == "forgotten"
    assert "Cleopatra" in (class_of_three / "grades.csv").read_text("utf-8-sig")


def test_other_files_that_hold_the_name_are_listed(class_of_three, capsys):
    (class_of_three / "notes.txt").write_text("Cleopatra VII asked about A1", "utf-8")
    run(class_of_three, "forget", "cleo", "--yes")
    assert "notes.txt" in capsys.readouterr().out
    assert (class_of_three / "notes.txt").exists()


def test_deleting_rows_alone_would_leave_traces(class_of_three):
    with Store(class_of_three) as store, store.transaction() as db:
        db.execute("PRAGMA secure_delete = OFF")
        db.execute("DELETE FROM submission WHERE student = 'cleo'")
    assert leftovers(class_of_three, ["Cleopatra VII/quickshot"])


def test_forgetting_one_leaves_namesakes_alone(class_of_three, rows):
    with Store(class_of_three) as store:
        store.add(submission("li", "Li", "Li/x.ipynb", rows), rows)
        store.log("note", "bob", "Linda, Lisa and Bob")
    run(class_of_three, "forget", "li", "--yes")
    with Store(class_of_three) as store:
        assert "Linda, Lisa and Bob" in [event.details for event in store.events()]


def test_decisions_about_time_are_listed_with_their_numbers(class_of_three, capsys):
    run(class_of_three, "adjust", "--due", "2026-11-20T20:00+00:00", "--late", "1%/day")
    run(class_of_three, "adjust", "--student", "bob", "--due", "2026-11-27T20:00+00:00", "--reason", "was ill")
    run(class_of_three, "adjust", "--revoke-rule", "1")
    capsys.readouterr()
    assert run(class_of_three, "adjust", "--list") == 0
    first, second = capsys.readouterr().out.splitlines()
    assert first.startswith("rule 1  all, all exercises: due 2026-11-20T20:00:00+00:00; 1 %")
    assert "; revoked " in first
    assert second.startswith("rule 2  bob, all exercises: due 2026-11-27T20:00:00+00:00. was ill  (")
    assert second.endswith("; holds)")


def test_who_is_forgotten_before_any_report_gets_none(tmp_path, rows):
    with Store(tmp_path, create=True) as store:
        store.add(submission("ada", "Ada", "Ada/x.ipynb", rows), rows)
        store.add(submission("bob", "Bob", "Bob/x.ipynb", rows), rows)
    assert main(["forget", str(tmp_path), "ada", "--yes"]) == 0
    assert points(tmp_path) == {"bob": 1}
    assert not (tmp_path / "grades.csv").exists()


@pytest.mark.parametrize(("answer", "left"), [("", {"ada", "bob", "cleo"}), (" Yes ", {"ada", "cleo"})])
def test_whoever_is_asked_decides(class_of_three, monkeypatch, capsys, answer, left):
    asked = []
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("builtins.input", lambda question: asked.append(question) or answer)
    assert run(class_of_three, "forget", "bob") == 0
    assert asked == ["Remove everything of bob? This cannot be undone. [y/N] "]
    assert ("Nothing was removed." in capsys.readouterr().out) == ("bob" in left)
    assert points(class_of_three).keys() == left


def test_traces_that_another_program_keeps_are_said(class_of_three, monkeypatch, capsys):
    monkeypatch.setattr("dhlib.grading.batch.store.PATIENCE", 0.05)
    other = sqlite3.connect(class_of_three / "results.sqlite", isolation_level=None)
    other.execute("BEGIN")
    other.execute("SELECT * FROM submission").fetchall()
    assert run(class_of_three, "forget", "cleo", "--yes") == 2
    assert "another program has it open, so traces may be left in its bytes" in capsys.readouterr().err
    assert "cleo" not in (class_of_three / "grades.csv").read_text("utf-8")
    other.close()
    assert run(class_of_three, "forget", "cleo", "--yes") == 0
    assert "is gone now" in capsys.readouterr().out
    assert not leftovers(class_of_three, ["cleo", "Cleopatra"])
    assert run(class_of_three, "forget", "cleo", "--yes") == 2
    assert "cleo" in capsys.readouterr().err


def test_forgetting_asks_first(class_of_three):
    command = [sys.executable, "-m", "dhlib.cli", "forget", str(class_of_three), "bob"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, stdin=subprocess.DEVNULL, check=False)
    assert done.returncode == 2
    assert "say --yes" in done.stderr
    assert "bob" in points(class_of_three)
