"""dhlib's kinematics, closed where a part is to be one's own work."""

import json
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import dhlib
from dhlib import Chain, DHError, robots
from dhlib.grading.answers import read_answer
from dhlib.grading.closing import close, reopen
from dhlib.grading.exercise import load_exercise
from dhlib.grading.grade import grade_notebook

ROOT = Path(__file__).parents[2]
ARM = robots.quickshot()
Q = [0.3, 0.5, 0.7, 0.2]
ALIASES = {
    "a function": lambda: dhlib.classic(0, 1, 2, 0),
    "a function under another name": partial(dhlib.modified, 0, 1, 2, 0),
    "a transform": lambda: dhlib.Tx(1),
    "a robot": robots.puma560,
    "a new chain": lambda: Chain(ARM.joints, "classic"),
    "a table": lambda: Chain.from_table([[0, 1, 2, 3]], "theta d a alpha", "R", "classic"),
    "a chain made before": lambda: ARM.fk(Q),
    "its links": lambda: ARM.A(1, Q),
    "a method kept before": partial(ARM.T, 0, 4, Q),
    "formulas": ARM.symbolic,
    "the other convention": ARM.to_modified,
    "an inverse": lambda: dhlib.inverse(np.eye(4)),
    "frames that are placed": lambda: dhlib.place_frames(AXES, convention="classic"),
}
AXES = ARM.axes()


@pytest.fixture
def closed():
    close("A1")
    yield
    reopen()


@pytest.mark.parametrize("way", ALIASES)
def test_every_way_is_closed(way, closed):
    with pytest.raises(DHError, match=r"A1 is your own work: .* are closed here"):
        ALIASES[way]()


@pytest.mark.parametrize("way", ALIASES)
def test_every_way_is_open_again(way):
    close("A1")
    close("A2")
    reopen()
    reopen()
    assert ALIASES[way]() is not None


def test_answers_are_read_while_it_is_closed(closed):
    chain = {"form": "table", "convention": "classic"}
    assert len(read_answer(chain, ARM)["table"]["rows"]) == 4
    assert read_answer({"form": "numbers", "shape": [2]}, np.eye(2)[0]) == {"values": [[1.0, 0.0]]}


def graded(tmp_path, notebook):
    path = tmp_path / "n.ipynb"
    path.write_text(json.dumps(notebook), encoding="utf-8")
    return {mark.part: mark for mark in grade_notebook(path, exercises=ROOT / "exercises").marks}


def test_a_graded_run_closes_it_for_the_parts_that_say_so_and_for_no_others(tmp_path, notebook_with):
    own = {part.id for part in load_exercise("quickshot", ROOT / "exercises").parts if not part.kinematics}
    assert {"A1", "link", "T4"} <= own
    assert not {"table", "X"} & own
    notebook = notebook_with(
        {
            "table": "from dhlib import Chain as C, robots as r\nmine = r.quickshot()\ntable = mine",
            "A1": "A1 = mine.A(1, q)",
            "A2": "A2 = r.quickshot().A(2, q)",
            "A3": "c, s = np.cos(q[2]), np.sin(q[2])\nA3 = [[c, 0, s, 0], [s, 0, -c, 0], [0, 1, 0, 28], [0, 0, 0, 1]]",
            "link": "def link(i, q):\n    return mine.A(i, q)",
            "X": "from dhlib import *\nX = Tx(300) @ Ty(-150) @ Tz(720) @ Rz(np.pi/2) @ mine.fk(q)"
            " @ Tz(90) @ Rz(np.pi/2) @ Rx(-np.pi/6)",
        }
    )
    marks = graded(tmp_path, notebook)
    assert {part for part, mark in marks.items() if mark.passed} == {"table", "A3", "X"}
    for part in ("A1", "A2", "link"):
        assert f"{part} is your own work" in marks[part].message, marks[part]


def test_an_imported_name_alone_does_no_harm(tmp_path, notebook_with):
    notebook = notebook_with({"A4": "from dhlib import Chain, classic\nA4 = np.diag([1, 1, 1, 1.0])\nA4[2, 3] = 250"})
    message = graded(tmp_path, notebook)["A4"].message
    assert "your own work" not in message
