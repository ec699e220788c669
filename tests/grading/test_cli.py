"""``dhlib grade`` as its user meets it."""

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from dhlib.cli import main
from dhlib.grading.batch import command, run
from dhlib.grading.batch.intake import collect
from dhlib.grading.batch.progress import Progress
from dhlib.grading.batch.run import Summary
from dhlib.grading.reports.cells import safe
from dhlib.grading.wall.limits import UNSAFE

ROOT = Path(__file__).parents[2]


@pytest.fixture
def folder(tmp_path, notebook_with):
    """A class: a good notebook, one with an error, a loop, and three broken files."""
    class_ = tmp_path / "class"
    (class_ / "Müller, Ada").mkdir(parents=True)
    write(class_ / "Müller, Ada" / "quickshot.ipynb", notebook_with({"slip": "slip = 'n_y'"}))
    write(class_ / "=cmd.ipynb", notebook_with({"slip": "slip = 'n_y'", "A1": "A1 = 1 / 0"}))
    write(class_ / "loop.ipynb", notebook_with({"A1": "while True: pass", "slip": "slip = 'n_y'"}))
    (class_ / "pdf.ipynb").write_bytes(b"%PDF-1.7 \xff")
    (class_ / "cut.ipynb").write_text('{"cells": [{"source"')
    write(class_ / "other.ipynb", {"cells": [{"cell_type": "code", "source": "x = 1"}], "nbformat": 4})
    return class_


def write(path, notebook):
    path.write_text(json.dumps(notebook), encoding="utf-8")


def grades(out):
    with (out / "grades.csv").open(encoding="utf-8-sig", newline="") as file:
        return {row["notebook"]: row for row in csv.DictReader(file)}


@pytest.mark.notebooks
def test_a_class_is_graded(folder, tmp_path, capsys):
    out = tmp_path / "out"
    code = main(["grade", str(folder), "--out", str(out), "--timeout", "6", "--workers", "2"])
    said = capsys.readouterr()
    assert code == 1
    assert "Traceback" not in said.err + said.out
    rows = grades(out)
    assert len(rows) == 6
    good = rows["Müller, Ada/quickshot.ipynb"]
    assert (good["status"], good["points"], good["out_of"], good["slip"], good["A1"]) == ("graded", "1", "30", "1", "0")
    assert (rows["'=cmd.ipynb"]["points"], rows["loop.ipynb"]["points"]) == ("1", "1")
    assert rows["pdf.ipynb"]["status"] == rows["cut.ipynb"]["status"] == rows["other.ipynb"]["status"] == "unreadable"
    assert "does not say which exercise" in rows["other.ipynb"]["message"]
    for row in rows.values():
        page = (out / row["feedback"]).read_text(encoding="utf-8")
        assert "<script" not in page
        assert "http://" not in page.replace("http-equiv", "")
    assert "ZeroDivisionError: division by zero" in (out / rows["'=cmd.ipynb"]["feedback"]).read_text(encoding="utf-8")
    assert "3 unreadable" in said.out
    assert not (out / "problems.csv").exists()


def test_the_order_is_that_of_the_paths(folder):
    found = [handed_in.source for handed_in in collect([folder]).found]
    assert found == ["=cmd.ipynb", "Müller, Ada/quickshot.ipynb", "cut.ipynb", "loop.ipynb", "other.ipynb", "pdf.ipynb"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere", "--out", "out"], "there is no file or folder nowhere"),
        ([".", "--out", "out"], "no notebook"),
        ([str(ROOT / "exercises"), "--out", "out", "--exercise", "unknown"], "no exercise 'unknown'"),
        ([str(ROOT / "exercises"), "--out", "out", "--exercises", "nowhere"], "no folder nowhere"),
    ],
)
def test_misuse_is_said_in_a_sentence(tmp_path, monkeypatch, capsys, arguments, words):
    monkeypatch.chdir(tmp_path)
    assert main(["grade", *arguments]) == 2
    said = capsys.readouterr().err
    assert words in said
    assert "Traceback" not in said
    assert said.startswith("dhlib: ")


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["grade"],
        ["grade", ".", "--out", "x", "--timeout", "-1"],
        ["grade", ".", "--out", "x", "--workers", "0"],
        ["grade", ".", "--out", "x", "--timeout", "soon"],
        ["grade", ".", "--out", "x", "--shard", "6/5"],
        ["grade", ".", "--out", "x", "--shard", "two"],
    ],
)
def test_wrong_arguments_show_the_usage(capsys, arguments):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 2
    assert "usage: dhlib" in capsys.readouterr().err


def test_out_that_is_a_file_is_said(tmp_path, capsys):
    (tmp_path / "out").write_text("x")
    assert main(["grade", str(ROOT / "exercises"), "--out", str(tmp_path / "out")]) == 2
    assert "is a file" in capsys.readouterr().err


def test_whoever_stops_it_is_told_that_nothing_is_lost(tmp_path, monkeypatch, capsys):
    def stopped(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(run, "grade_class", stopped)
    assert main(["grade", str(tmp_path), "--out", str(tmp_path / "out"), "--shard", "2/5"]) == 130
    assert "the same command goes on where it was" in capsys.readouterr().err


def test_who_handed_nothing_in_is_counted_and_the_missing_wall_is_said(tmp_path, capsys):
    (tmp_path / "class" / "ada").mkdir(parents=True)
    (tmp_path / "class" / "ada" / "x.ipynb").write_bytes(b"%PDF-1.7")
    (tmp_path / "roster.csv").write_text("id,name\nada,Ada Lovelace\nbob,Bob\ncarl,Carl\n", "utf-8")
    command = ["grade", str(tmp_path / "class"), "--out", str(tmp_path / "out"), "--workers", "1"]
    assert main([*command, "--roster", str(tmp_path / "roster.csv"), "--unsafe-no-sandbox"]) == 1
    said = capsys.readouterr()
    assert "2 of the 3 on the roster handed nothing in." in said.out
    assert UNSAFE in said.err


def test_where_no_box_can_be_built_the_run_ends_in_a_sentence(folder, tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PATH", str(tmp_path / "nothing"))
    assert main(["grade", str(folder), "--out", str(tmp_path / "out"), "--workers", "2"]) == 2
    said = capsys.readouterr().err
    assert "need a sandbox" in said
    assert "Traceback" not in said


def test_a_certificate_that_is_not_there_is_named(tmp_path, capsys):
    (tmp_path / "ca.pem").write_text("x")
    command = ["grade", str(tmp_path), "--out", str(tmp_path / "out"), "--scheduler", "tls://example.org:8786"]
    certificates = ["--tls-ca", str(tmp_path / "ca.pem"), "--tls-key", str(tmp_path / "key.pem")]
    assert main([*command, *certificates]) == 2
    assert f"there is no file {tmp_path / 'key.pem'}." in capsys.readouterr().err
    assert main([*command[:-1], "tcp://example.org:8786", *certificates[:2]]) == 2
    assert "tls://" in capsys.readouterr().err


def test_where_nothing_says_which_processors_are_free_all_are_used(monkeypatch):
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 7)
    assert command.cores() == 7


@pytest.mark.parametrize(
    ("summary", "words"),
    [
        (Summary(found=3, done=3, status={"graded": 3}), "3 graded."),
        (Summary(found=3, done=1, kept=2, status={"graded": 3}), "1 graded now, 2 before."),
        (
            Summary(found=3, done=3, status={"graded": 1, "unreadable": 2}, problems=4),
            "3 graded.\nLook at: 2 unreadable.\n4 more to look at: problems.csv lists them.",
        ),
    ],
)
def test_what_a_run_did_is_said(summary, words):
    assert command.in_words(summary) == words


class Terminal(io.StringIO):
    """What is written to somebody's screen."""

    encoding = "ascii"

    def isatty(self):
        return True


def test_on_a_screen_there_is_a_bar_and_lines_stand_above_it():
    screen = Terminal()
    with Progress(2, screen) as progress:
        progress.advance()
        progress.say("Müller: \x1b[31mstopped")
        progress.advance()
    shown = screen.getvalue()
    assert "M\\xfcller:  [31mstopped\n" in shown
    assert "2/2" in shown
    assert "\x1b[31m" not in shown


def test_in_a_file_there_are_lines_alone():
    written = io.StringIO()
    with Progress(1000, written) as progress:
        for _ in range(1000):
            progress.advance()
    lines = written.getvalue().splitlines()
    assert lines[-1] == "1000 of 1000 notebooks"
    assert 1 < len(lines) <= 40


def test_what_the_system_refuses_is_said(tmp_path, capsys):
    assert main(["grade", str(tmp_path), "--out", str(tmp_path / ("x" * 300))]) == 2
    assert capsys.readouterr().err.endswith("x: File name too long.\n")


@pytest.mark.parametrize("cell", ["=1+1", "+1", "-x", "@x", "\t=1", " =1", "\r=1"])
def test_formulas_are_quoted(cell):
    assert safe(cell).startswith("'")
    assert safe("plain -1") == "plain -1"


def test_pytest_says_what_is_wrong_with_its_option(tmp_path):
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-n0", "--dh-grade"]
    missing = subprocess.run(
        [*command, str(tmp_path / "x.ipynb")], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert "there is no file" in missing.stderr
    assert missing.returncode == 4
    (tmp_path / "y.ipynb").write_text("no notebook")
    broken = subprocess.run(
        [*command, str(tmp_path / "y.ipynb")], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert "y.ipynb is no notebook" in broken.stdout
    assert "Traceback" not in broken.stdout


def test_pytest_elsewhere_does_not_load_the_library():
    probe = "import sys, pytest_dhlib; print('dhlib' in sys.modules, 'numpy' in sys.modules)"
    said = subprocess.run([sys.executable, "-c", probe], capture_output=True, text=True, check=True)
    assert said.stdout.split() == ["False", "False"]


def test_a_reader_who_leaves_is_no_error():
    """As `dhlib grade --doctor | head` leaves."""
    command = [sys.executable, "-m", "dhlib.cli", "grade", "--doctor"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        process.stdout.close()
        assert process.stderr.read() == ""
    assert process.returncode == 130
