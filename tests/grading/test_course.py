"""The key, the class list, the notebooks of a class, and what `check` says in them."""

import csv
import io
import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from dhlib import Chain, Revolute, robots
from dhlib.cli import main
from dhlib.errors import DHError
from dhlib.grading import form_checker
from dhlib.grading.check import CheckFailed
from dhlib.grading.course import assign as assigning
from dhlib.grading.course import worked
from dhlib.grading.course.keys import make_key, read_key
from dhlib.grading.course.papers import check_tag, read_tag
from dhlib.grading.course.roster import read_roster
from dhlib.grading.exercise import Part
from dhlib.grading.formal import form_of
from dhlib.grading.forms import Numbers
from dhlib.grading.grade import grade_notebook

ROOT = Path(__file__).parents[2]
EXERCISES = str(ROOT / "exercises")


@pytest.fixture
def key(tmp_path):
    return make_key(tmp_path / "course.key")


def write(path, text, encoding="utf-8"):
    path.write_bytes(text.encode(encoding))
    return path


# The key


def test_a_key_is_random_and_for_its_owner_alone(tmp_path):
    first, second = (make_key(tmp_path / name) for name in ("a.key", "b.key"))
    assert stat.S_IMODE(first.stat().st_mode) == 0o600
    assert read_key(first) != read_key(second)
    with pytest.raises(DHError, match="no key is written over another"):
        make_key(first)
    assert read_key(first) == read_key(first)
    with pytest.raises(DHError, match="cannot be written"):
        make_key(tmp_path / "nowhere" / "c.key")


@pytest.mark.parametrize(("mode", "words"), [(0o604, "everybody"), (0o640, "your group"), (0o622, "everybody")])
def test_a_key_that_others_can_read_is_refused(key, mode, words):
    key.chmod(mode)
    with pytest.raises(DHError, match=f"by {words}.*chmod 600"):
        read_key(key)


def test_a_key_in_git_is_refused(key, tmp_path):
    def git(*words):
        environment = {k: v for k, v in os.environ.items() if not k.startswith("GIT_")}
        subprocess.run(["git", *words], cwd=tmp_path, env=environment, check=True, capture_output=True)

    git("init")
    read_key(key)  # beside a repository's files, but not one of them
    git("add", key.name)
    with pytest.raises(DHError, match="tracked by git"):
        read_key(key)


@pytest.mark.parametrize("text", ["", "hunter2\n", "# a comment\n", "ab" * 32 + "\n" + "cd" * 32, "xy" * 32])
def test_what_is_no_key_is_refused(key, text):
    key.write_text(text)
    with pytest.raises(DHError, match="holds no key"):
        read_key(key)
    with pytest.raises(DHError, match="`dhlib key"):
        read_key(key.with_name("gone.key"))


# The class list

CLASS = 'Name;Student ID;Group\n"Müller; Ada";a1;1\nBohr, Niels;b2;2\n'


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "cp1252"])
@pytest.mark.parametrize("delimiter", [";", ",", "\t"])
@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_a_class_list_is_read_however_it_was_saved(tmp_path, encoding, delimiter, ends):
    text = CLASS.replace("Bohr, Niels", '"Bohr, Niels"').replace("; Ada", "\0").replace(";", delimiter)
    path = write(tmp_path / "r.csv", text.replace("\0", "; Ada").replace("\n", ends), encoding)
    assert read_roster(path) == ["a1", "b2"]


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        ("sep=;\nID;Name\nx;y\n", ["x"]),
        ("id\nÄhre\n\n ö2 \n", ["Ähre", "ö2"]),
        ('"id","remark"\n"x","two\nlines"\n"y",""\n', ["x", "y"]),
        ("Matrikelnummer,E-Mail\n0815,a@b.c\n", ["0815"]),
        ("SIS User ID,Student\n17,Ada\n", ["17"]),
        ("id,name\nx\ny,\n", ["x", "y"]),
    ],
)
def test_unusual_lists_just_work(tmp_path, text, ids):
    assert read_roster(write(tmp_path / "r.csv", text)) == ids


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "is empty"),
        ("id\n", "no student"),
        ("name,points\nAda,3\n", "no column of IDs; its first row is 'name', 'points'"),
        ("id,id\n1,2\n", "no column of IDs"),
        ("id,name\na,x\n,y\nb,z\n,w\n", "no ID in lines 3, 5"),
        ("id,name\na,x\nb,y\nA ,z\n", "'A' is there twice, in lines 2 and 4"),
        ("id,name\nMu\u0308ller,x\nmüller,y\n", "twice"),
        ("id,name\na,Müller, Ada\n", "line 2: 3 cells under 2 headings"),
        ('id,name\na,"x\n', "quotation mark left open"),
        ("id\n" + "a" * 101 + "\n", "too long in line 2"),
        ("id\na\x07b\n", "cannot be printed in line 2"),
        ("PK\x03\x04xl/workbook.xml", "is a workbook"),
    ],
)
def test_a_bad_list_is_named(tmp_path, text, words):
    with pytest.raises(DHError, match=words):
        read_roster(write(tmp_path / "r.csv", text))


def test_a_column_can_be_named(tmp_path):
    path = write(tmp_path / "r.csv", "Code,Name\nx7,Ada\n")
    assert read_roster(path, "code") == ["x7"]
    with pytest.raises(DHError, match="no column 'Kode'; its first row is 'Code', 'Name'"):
        read_roster(path, "Kode")
    with pytest.raises(DHError, match="cannot be opened"):
        read_roster(tmp_path / "none.csv")
    for data in (b"id\n\x00\x81\x00", b"id\nx\ny\x00\n"):
        (tmp_path / "binary.csv").write_bytes(data)
        with pytest.raises(DHError, match="is no text"):
            read_roster(tmp_path / "binary.csv")
    with (tmp_path / "large.csv").open("wb") as file:
        file.truncate(20_000_001)
    with pytest.raises(DHError, match=r"large\.csv is larger than 20 MB, which is no class list"):
        read_roster(tmp_path / "large.csv")


# The notebooks


@pytest.fixture
def roster(tmp_path):
    return write(tmp_path / "roster.csv", "id;name\nm1;Ada\n../up;Mal\nMüller;Ä\n=1+1;x\nCON;y\na/b;z\na_b;w\n")


def run_assign(tmp_path, roster, key, *more):
    command = ["assign", "quickshot", "--roster", str(roster), "--key", str(key), "--exercises", EXERCISES]
    return main([*command, "--out", str(tmp_path / "out" / "hw1"), *more])


def test_a_class_gets_its_notebooks(tmp_path, roster, key, capsys):
    assert run_assign(tmp_path, roster, key, "--due", "2030-01-31 23:59") == 0
    out = tmp_path / "out" / "hw1"
    assert "7 notebooks" in capsys.readouterr().out
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"hw1"}
    with (out / "assigned.csv").open(encoding="utf-8-sig", newline="") as file:
        listed = list(csv.DictReader(file))
    assert len({row["notebook"].casefold() for row in listed}) == 7
    assert {row["notebook"] for row in listed} == {path.name for path in out.glob("*.ipynb")}
    secret = read_key(key)
    for row, student in zip(listed, ["m1", "../up", "Müller", "=1+1", "CON", "a/b", "a_b"], strict=True):
        text = (out / row["notebook"]).read_text("utf-8")
        notebook = json.loads(text)
        tag = read_tag(notebook)
        check_tag(tag, secret)
        assert (tag.exercise, tag.student, tag.due) == ("quickshot", student, "2030-01-31T23:59:00")
        assert secret.hex() not in text
        assert set(notebook["metadata"]["dh"]) == {"exercise", "student", "due", "key", "seal"}
        for path in row["notebook"].split("/"):
            assert path not in ("", ".", "..")
    assert listed[3]["student"] == "'=1+1"


def test_nothing_is_written_over_a_class(tmp_path, roster, key, capsys):
    assert run_assign(tmp_path, roster, key) == 0
    before = {path.name: path.read_bytes() for path in (tmp_path / "out" / "hw1").iterdir()}
    assert run_assign(tmp_path, roster, key) == 2
    assert "nothing is written over" in capsys.readouterr().err
    assert {path.name: path.read_bytes() for path in (tmp_path / "out" / "hw1").iterdir()} == before


def test_an_empty_folder_may_take_a_class(tmp_path, roster, key):
    (tmp_path / "out" / "hw1").mkdir(parents=True)
    assert run_assign(tmp_path, roster, key) == 0
    assert len(list((tmp_path / "out" / "hw1").glob("*.ipynb"))) == 7


def test_on_a_screen_there_is_a_bar_of_notebooks(tmp_path, roster, key, monkeypatch):
    class Screen(io.StringIO):
        def isatty(self):
            return True

    monkeypatch.setattr(sys, "stderr", screen := Screen())
    assert run_assign(tmp_path, roster, key) == 0
    assert "7/7" in screen.getvalue()
    assert len(list((tmp_path / "out" / "hw1").glob("*.ipynb"))) == 7


def test_never_half_a_class(tmp_path, roster, key, monkeypatch):
    as_text = assigning.as_text
    count = iter(range(100))

    def failing(notebook):
        if next(count) == 4:
            raise KeyboardInterrupt
        return as_text(notebook)

    monkeypatch.setattr(assigning, "as_text", failing)
    assert run_assign(tmp_path, roster, key) == 130
    assert list((tmp_path / "out").iterdir()) == []
    monkeypatch.setattr(assigning, "as_text", as_text)
    assert run_assign(tmp_path, roster, key) == 0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--due", "tomorrow"], "is no date"),
        (["--column", "x"], "no column 'x'"),
        (["--exercises", "/nowhere"], "no folder"),
    ],
)
def test_misuse_is_said_and_leaves_nothing(tmp_path, roster, key, capsys, options, words):
    assert run_assign(tmp_path, roster, key, *options) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_missing_key_is_said(tmp_path, roster, capsys):
    assert run_assign(tmp_path, roster, tmp_path / "no.key") == 2
    assert "there is no key" in capsys.readouterr().err


def test_the_grader_draws_the_same_numbers_again(tmp_path, roster, key, variables):
    run_assign(tmp_path, roster, key)
    path = tmp_path / "out" / "hw1" / "quickshot-m1.ipynb"
    notebook = json.loads(path.read_text("utf-8"))
    for cell in notebook["cells"]:
        about = cell["metadata"]["dh"]
        if about["role"] == "answer" and about["part"] == "table":
            cell["source"] = (
                "table = [[theta1, height, ahead, -pi / 2], [theta2, 0, upper_arm, 0],"
                " [theta3, aside, 0, pi / 2], [theta4, forearm, 0, 0]]"
            )
        if about["role"] == "given" and about["part"] == "arm":
            cell["source"] = ["height = ahead = upper_arm = aside = forearm = 1"]  # a student's cell counts for nothing
    path.write_text(json.dumps(notebook), encoding="utf-8")
    marks = {mark.part: mark for mark in grade_notebook(path, exercises=EXERCISES, key=read_key(key)).marks}
    assert marks["table"].passed
    assert not marks["A1"].passed
    without = grade_notebook(path, exercises=EXERCISES)
    assert (without.status, without.exercise) == ("unreadable", None)
    assert "--key" in without.message
    notebook["metadata"]["dh"]["student"] = "m2"
    path.write_text(json.dumps(notebook), encoding="utf-8")
    assert "altered" in grade_notebook(path, exercises=EXERCISES, key=read_key(key)).message
    del notebook["metadata"]["dh"]["student"]
    path.write_text(json.dumps(notebook), encoding="utf-8")
    assert "no notebook that was assigned" in grade_notebook(path, exercises=EXERCISES, key=read_key(key)).message


@pytest.mark.notebooks
def test_the_solution_of_one_student_is_written_and_proved(tmp_path, key, capsys):
    out = tmp_path / "s.ipynb"
    command = ["solution", "quickshot", "--student", "m1", "--key", str(key), "--exercises", EXERCISES]
    assert main([*command, "--out", str(out)]) == 0
    assert "30 of 30 points" in capsys.readouterr().out
    notebook = json.loads(out.read_text("utf-8"))
    checks = [cell for cell in notebook["cells"] if cell["metadata"]["dh"]["role"] == "check"]
    assert all("the form is right" in "".join(cell["outputs"][0]["text"]) for cell in checks)
    assert main([*command, "--out", str(out)]) == 2
    assert "there already" in capsys.readouterr().err


def test_a_solution_that_does_not_solve_is_refused(tmp_path, key, capsys):
    text = (ROOT / "solutions" / "quickshot.ipynb").read_text("utf-8")
    # 161: a length that is never drawn
    (tmp_path / "quickshot.ipynb").write_text(text.replace("0, upper_arm, 0", "0, 161, 0"), encoding="utf-8")
    command = ["solution", "quickshot", "--student", "m1", "--key", str(key), "--exercises", EXERCISES]
    out = tmp_path / "s.ipynb"
    assert main([*command, "--solutions", str(tmp_path), "--out", str(out)]) == 2
    assert "does not solve the numbers of 'm1': " in capsys.readouterr().err
    assert not out.exists()
    assert main([*command, "--solutions", str(tmp_path / "none"), "--out", str(out)]) == 2
    capsys.readouterr()
    assert main(["solution", "quickshot", "--student", " ", "--key", str(key), "--out", str(out)]) == 2
    assert "--student should be an ID of the class list." in capsys.readouterr().err


# The outputs of a worked notebook


def code(*sources):
    cells = [{"cell_type": "code", "id": f"c{k}", "source": s, "metadata": {}, "outputs": [], "execution_count": None}
             for k, s in enumerate(sources)]  # fmt: skip
    return {"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}


@pytest.mark.notebooks
def test_the_outputs_of_a_worked_notebook_are_stored_as_lines(tmp_path, capsys):
    path = tmp_path / "n.ipynb"
    write(path, json.dumps(code("print('a')\nprint('b')", "'x\\ny'.upper()", "raise KeyError('gone')")))
    before = path.read_bytes()
    assert worked.main([str(path)]) == 1
    assert "n.ipynb: a cell stopped with KeyError: 'gone'" in capsys.readouterr().err
    assert path.read_bytes() == before
    write(path, json.dumps(code("print('a')\nprint('b')", "'x\\ny'.upper()")))
    assert worked.main([str(path)]) == 0
    assert capsys.readouterr().out == f"ran {path}\n"
    printed, shown = (cell["outputs"][0] for cell in json.loads(path.read_text("utf-8"))["cells"])
    assert printed["text"] == ["a\n", "b\n"]
    assert shown["data"] == {"text/plain": ["'X\\nY'"]}


# The check of the form


@pytest.fixture(scope="module")
def forms(exercise):
    return json.loads(json.dumps({part.id: form_of(part) for part in exercise.parts}))


def test_forms_hold_nothing_of_the_solution(every):
    """A form is the same whatever is right: with other numbers, another option or another arm it does not change."""
    text = json.dumps({part.id: form_of(part) for part in every.parts})
    assert "tolerance" not in text
    for part in every.parts:
        form = form_of(part)
        assert set(form) <= {
            "form", "shape", "symbols", "signature", "calls", "convention", "rows", "options", "reasons", "stands_for"
        }  # fmt: skip
        if "right" in vars(part.asks):
            assert form["options"] == list(part.asks.options)


ARM = robots.quickshot()
Q = np.deg2rad([30, -50, 70, 20])


@pytest.mark.parametrize(
    ("part", "answer", "words"),
    [
        ("A1", ..., "A1: still open. Put your answer"),
        ("A1", np.eye(3), "A1: cannot be read. A1 has 3 rows and 3 columns; a matrix of 4 rows and 4 columns is asked"),
        ("A1", ARM.A(1, Q) + 0.3 * np.eye(4), "A1: the form is not right yet. The last row of a pose is 0 0 0 1."),
        ("A1", np.diag([1, 1, -1, 1]), "The determinant of the rotation is −1"),
        ("A1", np.diag([2, 1, 1, 1]), "Column n has length 2"),
        ("A1_sym", np.array([["a"] * 4] * 4), "text in quotation marks"),
        ("link", ARM.A(1, Q), "a function is asked for"),
        ("link", lambda i, q: 3, "only one number"),
        ("slip", "n_w", "slip: the form is not right yet. It should be one of n_x, n_y, n_z, in quotation marks."),
        ("frames", [np.eye(4)] * 4, "a list of 5 matrices"),
        ("frames", [np.diag([1, 1, -1, 1])] * 5, "Frame 0: The determinant"),
        ("frames", [np.eye(4), robots.quickshot("modified").A(2, Q), *[np.eye(4)] * 3], "DH1"),
        ("table", [[0, 1, 2, 3]], "It has 1 row; the arm has 4 joints"),
        ("table", robots.quickshot("modified"), "is in the modified convention; asked for is a classic table."),
        ("table", [[0, 100, 20, -90], [0, 0, 160, 0], [0, 28, 0, 90], [0, 250, 0, 0]], "radians"),
        ("table", [[f"q{i}", "d", 20, 0] for i in (1, 2, 3, 4)], "no other symbol"),
    ],
)  # fmt: skip
def test_a_wrong_form_is_said(forms, part, answer, words):
    with pytest.raises(CheckFailed) as failed:
        form_checker("quickshot", forms)(part, answer)
    assert words in str(failed.value)


@pytest.mark.parametrize(
    ("part", "answer"),
    [
        ("A1", ARM.A(1, Q)),
        ("A1", ARM.A(2, Q)),  # another pose has the same form
        ("A1", ARM.A(1, Q).round(3)),
        ("A1_sym", ARM.to_modified().symbolic()),
        ("link", lambda i, q: np.eye(4)),
        ("slip", "n_x"),
        ("slip", "N_Z"),
        ("frames", robots.quickshot().frames([1, 2, 3, 4])),
        ("table", Chain([Revolute(a=1)] * 4, "classic")),
        ("table", [["q1", 1, 2, 3], ["q2", 1, 2, 3], ["q3", 1, 2, 3], ["q4", 1, 2, 3]]),
        ("table", [[0, 1, 2, 3]] * 4),
        ("mended", 7),
    ],
)
def test_a_right_form_says_nothing_of_the_answer(forms, part, answer, capsys):
    """Right and wrong answers of the right form are told the same."""
    form_checker("quickshot", forms)(part, answer)
    said = capsys.readouterr().out
    assert said.startswith(f"{part}: the form is right, ")
    assert said.endswith("The course will say whether the answer is.\n")


def test_a_matrix_that_is_no_pose_has_a_right_form_where_none_is_asked_for(capsys):
    twice = Part("M", "M", 1, Numbers(lambda arm, q: 2 * arm.fk(q), at=(0.3, 0.5)), arm=robots.planar(2))
    form_checker("own", {"M": form_of(twice)})("M", np.full((4, 4), 7.0))
    assert capsys.readouterr().out.startswith("M: the form is right")


def test_every_solution_has_the_right_form(every, results, capsys):
    check = form_checker(every.name, json.loads(json.dumps({part.id: form_of(part) for part in every.parts})))
    for part in every.parts:
        check(part.id, results[part.id])
    assert capsys.readouterr().out.count("the form is right") == len(every.parts)


def test_a_form_checker_that_is_called_wrongly_says_so(forms):
    check = form_checker("quickshot", forms)
    with pytest.raises(DHError, match="no part 'A9'; its parts are frames"):
        check("A9", 1)
    with pytest.raises(CheckFailed, match="one answer"):
        check("A1")
    assert "0x" not in repr(check)
