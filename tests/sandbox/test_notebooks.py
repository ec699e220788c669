"""Honest and careless notebooks: with walls and without, what goes wrong in a cell costs as little as possible."""

import json

import numpy as np
import pytest

from dhlib.grading.notebook import Cell
from dhlib.grading.wall import Limits
from dhlib.grading.wall import sandbox as trusted
from dhlib.grading.wall.shell import reads_plainly


@pytest.fixture
def runs(monkeypatch):
    """Run a notebook of two parts; ``runs.cared`` says of each of its runs whether that was with care."""

    class Noted(trusted.Run):
        def __init__(self, box, cells, limits, care, hung):
            super().__init__(box, cells, limits, care, hung)
            runs.cared.append(care)
            runs.hung.append(hung)

    def runs(sandbox, first, second="B = 2", limits=None):
        cells = [
            Cell("import math", role="setup"),
            Cell(first, role="answer", part="A"), Cell("", role="check", part="A"),
            Cell(second, role="answer", part="B"), Cell("", role="check", part="B"),
        ]  # fmt: skip
        return sandbox.run(cells, {part: {"form": "numbers", "shape": []} for part in "AB"}, limits)

    runs.cared, runs.hung = [], []
    monkeypatch.setattr(trusted, "Run", Noted)
    monkeypatch.setattr(trusted, "SWIFT_SECONDS", 60.0)  # however busy the machine is
    return runs


def test_answers_come_back(run):
    outcome = run("A = 1")
    assert outcome.readings == {"A": {"values": [1.0]}, "B": {"values": [2.0]}}
    assert (outcome.errors, outcome.killers, outcome.note) == ({}, {}, "")


def test_cells_run_in_a_notebook_shell(run):
    outcome = run("%matplotlib inline\nfrom IPython.display import display\ndisplay(3)\nA = 1; A")
    assert outcome.readings["A"] == {"values": [1.0]}


def test_an_error_costs_its_cell_and_is_told(run):
    outcome = run("A = 1 / 0")
    assert outcome.readings == {"A": {"fault": "undefined"}, "B": {"values": [2.0]}}
    assert outcome.errors == {1: "ZeroDivisionError: division by zero"}
    assert "SyntaxError" in run("A = = 1").errors[1]


@pytest.mark.parametrize("end", ["import os; os._exit(0)", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)"])
def test_a_cell_that_ends_the_program_costs_that_cell(run, end):
    outcome = run(end)
    assert outcome.readings["B"] == {"values": [2.0]}
    assert list(outcome.killers) == [1]
    assert outcome.note == ""


@pytest.mark.parametrize("stop", ["raise SystemExit", "exit()", "raise KeyboardInterrupt"])
def test_leaving_politely_does_not_end_the_notebook(run, stop):
    assert run(stop).readings["B"] == {"values": [2.0]}


def test_a_loop_is_stopped_after_its_time(run):
    outcome = run("while True: pass", cell_seconds=1.0)
    assert outcome.readings["B"] == {"values": [2.0]}
    assert "OutOfTime" in outcome.errors.get(1, "") or outcome.killers[1] == "never ended"  # by how busy it is here


def test_a_loop_that_swallows_interrupts_is_stopped_too(run):
    stubborn = (
        "import time\nwhile True:\n    try:\n        while True: time.sleep(0.01)\n    except BaseException: pass"
    )
    outcome = run(stubborn, cell_seconds=1.0)
    assert outcome.readings["B"] == {"values": [2.0]}
    assert list(outcome.killers) == [1]


def test_the_notebook_as_a_whole_is_stopped_and_keeps_what_it_has(run):
    stubborn = "while True:\n    try:\n        while True: pass\n    except BaseException: pass"
    outcome = run("A = 1", stubborn, seconds=3.0, cell_seconds=100.0)
    assert outcome.readings == {"A": {"values": [1.0]}}
    assert outcome.note == "The notebook was stopped after 3 s."


def test_a_function_that_never_returns_costs_its_part(run):
    requests = {"A": {"form": "function", "shape": [], "calls": [[1], [2], [3]]}, "B": {"form": "numbers", "shape": []}}
    third = "def A(i):\n    while i == 3: pass\n    return i"
    outcome = run(third, requests=requests, cell_seconds=1)
    assert outcome.readings == {"A": {"fault": "timeout"}, "B": {"values": [2.0]}}
    stubborn = (
        "import signal\ndef A(i):\n    while True:\n        try:\n"
        "            while True: signal.setitimer(signal.ITIMER_REAL, 0)\n        except BaseException: pass"
    )
    outcome = run(stubborn, requests=requests, cell_seconds=1)
    assert outcome.readings == {"A": {"fault": "timeout"}, "B": {"values": [2.0]}}


@pytest.mark.sandbox
def test_reading_an_answer_changes_nothing(walls):
    cells = [
        Cell("class Odd:\n    def __float__(self):\n        global B\n        B = 3\n        return 1.0", role="setup"),
        Cell("A, B = Odd(), 2", role="answer", part="A"),
        Cell("", role="check", part="A"),
        Cell("", role="check", part="B"),
    ]
    outcome = walls.run(cells, {part: {"form": "numbers", "shape": []} for part in "AB"})
    assert outcome.readings == {"A": {"values": [1.0]}, "B": {"values": [2.0]}}


def test_printing_without_end_does_no_harm(run):
    outcome = run("import sys\nfor _ in range(200_000): print('x' * 100)\nA = 1")
    assert outcome.readings["A"] == {"values": [1.0]}


def test_lines_on_standard_output_are_no_answers(run):
    forged = json.dumps({"part": "A", "reading": {"values": [42.0]}})
    writes = f"import os, sys\nprint({forged!r})\nsys.__stdout__.write({forged!r})\n"
    assert run(f"{writes}os.write(1, {forged.encode()!r} + b'\\n')\nA = 1").readings["A"] == {"values": [1.0]}


@pytest.mark.parametrize("source", ["checker('quickshot')", "form_checker('quickshot', {})"])
def test_check_in_the_box_says_handed_in(run, source):
    setup = f"from dhlib.grading import checker, form_checker\ncheck = {source}"
    first = (
        "import io, contextlib\nwith contextlib.redirect_stdout(io.StringIO()) as said:\n    check('A', 3)\n"
        "A = float(said.getvalue() == 'A: handed in.\\n')"
    )
    assert run(first, setup=setup).readings["A"] == {"values": [1.0]}


def test_no_reference_and_no_marking_is_loaded_in_the_box(run):
    loaded = (
        "import sys\n"
        "A = sum(name in sys.modules for name in ('dhlib.grading.marking', 'dhlib.grading.exercise',"
        " 'dhlib.grading.misconceptions', 'dhlib.grading.check', 'dhlib_exercise_quickshot'))"
    )
    assert run(loaded).readings["A"] == {"values": [0.0]}


COUNTS_ITSELF = "import os\nos.mkdir('mine')\nA = len(os.listdir('.'))"


@pytest.mark.sandbox
def test_a_notebook_that_needs_no_care_runs_once(walls, runs):
    runs(walls, "A = 1")
    assert runs.cared == [False]


@pytest.mark.sandbox
@pytest.mark.parametrize(
    "second",
    [
        "import os; os._exit(0)",
        "import threading, time; threading.Thread(target=time.sleep, args=(60,), daemon=True).start(); B = 2",
    ],
    ids=["dies", "leaves a thread"],
)
def test_care_starts_from_nothing(walls, runs, second):
    outcome = runs(walls, COUNTS_ITSELF, second)
    assert runs.cared == [False, True]
    assert outcome.readings["A"] == {"values": [1.0]}, "a folder of the first run was still there"
    assert (list(outcome.killers) == [3]) == ("_exit" in second)
    assert outcome.note == ""


@pytest.mark.sandbox
def test_what_ran_for_longer_than_a_moment_is_kept(walls, runs, monkeypatch):
    monkeypatch.setattr(trusted, "SWIFT_SECONDS", 1.0)
    outcome = runs(walls, "import time; time.sleep(1); A = 1", "import os; os._exit(0)")
    assert runs.cared == [False]
    assert outcome.readings == {"A": {"values": [1.0]}, "B": {"fault": "undefined"}}
    assert (outcome.killers, outcome.note) == ({3: "ended the program"}, "")


@pytest.mark.sandbox
def test_what_never_ended_is_not_tried_again(walls, runs):
    deaf = "import signal; signal.signal(signal.SIGALRM, signal.SIG_IGN)\nwhile True: pass"
    outcome = runs(walls, "A = 1", deaf, Limits(cell_seconds=1.0, notebook_seconds=30.0))
    assert (runs.cared, runs.hung) == ([False, True], [None, 3])
    assert outcome.readings == {"A": {"values": [1.0]}, "B": {"fault": "undefined"}}
    assert (outcome.killers, outcome.note) == ({3: "never ended"}, "")


@pytest.mark.sandbox
@pytest.mark.parametrize(
    "answer",
    ["class List(list):\n    {}\nA = List([1])", "class A:\n    def __float__(self): pass\n    {}\nA = A()"],
    ids=["list", "number"],
)
def test_reading_what_is_no_plain_data_changes_nothing(walls, answer):
    """Its own code runs when it is read, in a process that ends afterwards."""
    spy = "def __getattribute__(self, name):\n        global seen\n        seen = 1\n        raise ValueError"
    cells = [
        Cell("seen = 0\n" + answer.format(spy), role="answer", part="A"), Cell("", role="check", part="A"),
        Cell("B = seen", role="answer", part="B"), Cell("", role="check", part="B"),
    ]  # fmt: skip
    outcome = walls.run(cells, {"A": {"form": "numbers", "shape": [1]}, "B": {"form": "numbers", "shape": []}})
    assert outcome.readings["A"].get("fault") == "unreadable"
    assert outcome.readings["B"] == {"values": [0.0]}


@pytest.mark.parametrize(
    ("value", "plain"),
    [
        (1, True), (2.5, True), ("b", True), (None, True), (np.eye(4), True), ([[1, 2], (3, np.float64(4))], True),
        (True, True), (np.array([object()]), False), (type("L", (list,), {})(), False),
        (np.zeros(1).view(type("A", (np.ndarray,), {})), False),
        ({"a": 1}, False), (len, False), ([[[[1]]]], False), ([print], False), ([0] * 1000, False),
    ],
)  # fmt: skip
def test_plain_data_is_known_by_its_very_type(value, plain):
    assert reads_plainly({"form": "numbers"}, value) == plain
    assert not reads_plainly({"form": "function", "calls": []}, value)
    assert not reads_plainly({"form": "formula", "points": []}, value)
