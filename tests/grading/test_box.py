"""The box: one notebook in a process of its own; what goes wrong in a cell costs as little as possible."""

import json
import subprocess
import sys
import time

import pytest

from dhlib.grading.notebook import Cell
from dhlib.grading.wall import Limits
from dhlib.grading.wall.plain import run_notebook

REQUESTS = {"A": {"form": "numbers", "shape": []}, "B": {"form": "numbers", "shape": []}}


def run(first, second="B = 2", seconds=30.0, cell_seconds=None, setup="import math"):
    cells = [
        Cell(setup, role="setup"),
        Cell(first, role="answer", part="A"), Cell("", role="check", part="A"),
        Cell(second, role="answer", part="B"), Cell("", role="check", part="B"),
    ]  # fmt: skip
    return run_notebook(cells, REQUESTS, Limits(cell_seconds or seconds / 3, seconds))


def test_answers_come_back():
    outcome = run("A = 1")
    assert outcome.readings == {"A": {"values": [1.0]}, "B": {"values": [2.0]}}
    assert (outcome.errors, outcome.killers, outcome.note) == ({}, {}, "")


def test_cells_run_in_a_notebook_shell():
    outcome = run("%matplotlib inline\nfrom IPython.display import display\ndisplay(3)\nA = 1; A")
    assert outcome.readings["A"] == {"values": [1.0]}


def test_an_error_costs_its_cell_and_is_told():
    outcome = run("A = 1 / 0")
    assert outcome.readings == {"A": {"fault": "undefined"}, "B": {"values": [2.0]}}
    assert outcome.errors == {1: "ZeroDivisionError: division by zero"}
    assert "SyntaxError" in run("A = = 1").errors[1]


@pytest.mark.parametrize("end", ["import os; os._exit(0)", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"])
def test_a_cell_that_ends_the_program_costs_that_cell(end):
    outcome = run(end)
    assert outcome.readings["B"] == {"values": [2.0]}
    assert list(outcome.killers) == [1]
    assert outcome.note == ""


@pytest.mark.parametrize("stop", ["raise SystemExit", "exit()", "raise KeyboardInterrupt"])
def test_leaving_politely_does_not_end_the_notebook(stop):
    assert run(stop).readings["B"] == {"values": [2.0]}


def test_a_loop_is_stopped_after_its_time():
    start = time.monotonic()
    outcome = run("while True: pass", cell_seconds=1.0)
    assert outcome.readings["B"] == {"values": [2.0]}
    assert "OutOfTime" in outcome.errors[1]
    assert time.monotonic() - start < 6


def test_a_loop_that_swallows_interrupts_is_stopped_too():
    stubborn = (
        "import time\nwhile True:\n    try:\n        while True: time.sleep(0.01)\n    except BaseException: pass"
    )
    outcome = run(stubborn, cell_seconds=1.0)
    assert outcome.readings["B"] == {"values": [2.0]}
    assert list(outcome.killers) == [1]


def test_the_notebook_as_a_whole_is_stopped_and_keeps_what_it_has():
    stubborn = "while True:\n    try:\n        while True: pass\n    except BaseException: pass"
    start = time.monotonic()
    outcome = run("A = 1", stubborn, seconds=3.0, cell_seconds=100.0)
    assert outcome.readings == {"A": {"values": [1.0]}}
    assert outcome.note == "The notebook was stopped after 3 s."
    assert time.monotonic() - start < 5


def test_a_function_that_never_returns_costs_its_part():
    requests = {"f": {"form": "function", "shape": [], "calls": [[1]]}, "B": REQUESTS["B"]}
    cells = [
        Cell("def f(i):\n    while True: pass", role="answer", part="f"), Cell("", role="check", part="f"),
        Cell("B = 2", role="answer", part="B"), Cell("", role="check", part="B"),
    ]  # fmt: skip
    outcome = run_notebook(cells, requests, Limits(1, 30))
    assert outcome.readings == {"f": {"fault": "timeout"}, "B": {"values": [2.0]}}


def test_printing_without_end_does_no_harm():
    outcome = run("import sys\nfor _ in range(200_000): print('x' * 100)\nA = 1")
    assert outcome.readings["A"] == {"values": [1.0]}


def test_lines_on_standard_output_are_no_answers():
    forged = json.dumps({"part": "A", "reading": {"values": [42.0]}})
    writes = f"import os, sys\nprint({forged!r})\nsys.__stdout__.write({forged!r})\n"
    assert run(f"{writes}os.write(1, {forged.encode()!r} + b'\\n')\nA = 1").readings["A"] == {"values": [1.0]}


def test_children_end_with_the_notebook(tmp_path):
    mark = tmp_path / "alive"
    child = f"import time; time.sleep(3); open({str(mark)!r}, 'w')"
    spawn = f"import subprocess, sys\nsubprocess.Popen([sys.executable, '-c', {child!r}])\nA = 1"
    assert run(spawn).readings["A"] == {"values": [1.0]}
    time.sleep(4)
    assert not mark.exists()


def test_check_in_the_box_says_handed_in():
    setup = "from dhlib.grading import checker\ncheck = checker('quickshot')"
    first = (
        "import io, contextlib\nwith contextlib.redirect_stdout(io.StringIO()) as said:\n    check('A', 3)\n"
        "A = float(said.getvalue() == 'A: handed in.\\n')"
    )
    assert run(first, setup=setup).readings["A"] == {"values": [1.0]}


def test_no_reference_and_no_marking_is_loaded_in_the_box():
    loaded = (
        "import sys\n"
        "A = sum(name in sys.modules for name in ('dhlib.grading.marking', 'dhlib.grading.exercise',"
        " 'dhlib.grading.misconceptions', 'dhlib.grading.check', 'dhlib_exercise_quickshot'))"
    )
    assert run(loaded).readings["A"] == {"values": [0.0]}


def test_the_command_is_named_as_no_sandbox():
    said = subprocess.run(
        [sys.executable, "-m", "dhlib.cli", "grade", "--help"], capture_output=True, text=True, check=True
    )
    assert "This is no sandbox" in said.stdout
    assert "Exit code" in said.stdout
