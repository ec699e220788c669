"""The exercise, its solution, and notebooks with other answers in them."""

import contextlib
import copy
import io
import json
from pathlib import Path

import pytest

from dhlib.grading.answers import read_answer
from dhlib.grading.exercise import load_exercise
from dhlib.grading.marking import mark

ROOT = Path(__file__).parents[2]
SOLUTION = ROOT / "solutions" / "quickshot.ipynb"
PRISTINE = ROOT / "exercises" / "quickshot.ipynb"
#: Every exercise: a solution is its source.
NAMES = sorted(path.stem for path in (ROOT / "solutions").glob("*.ipynb"))


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def exercise():
    return load_exercise("quickshot", ROOT / "exercises")


@pytest.fixture(scope="session", params=NAMES)
def name(request):
    """Each exercise in turn."""
    return request.param


@pytest.fixture(scope="session")
def every(name):
    """What each exercise asks."""
    return load_exercise(name, ROOT / "exercises")


@pytest.fixture(scope="session")
def worked(name):
    """The solution notebook of each exercise."""
    return load(ROOT / "solutions" / f"{name}.ipynb")


@pytest.fixture(scope="session")
def results(worked):
    """The variables of each solution."""
    return run(worked)


@pytest.fixture(scope="session")
def arm(exercise):
    return exercise.part("table").chain


@pytest.fixture(scope="session")
def solved():
    """The variables of the solution."""
    return run(load(SOLUTION))


def run(notebook):
    """The variables of a notebook, after all of its cells ran here."""
    names = {}
    with contextlib.redirect_stdout(io.StringIO()):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                exec("".join(cell["source"]), names)  # our own notebook
    return names


@pytest.fixture(scope="session")
def variables():
    """``variables(notebook)``: those that a notebook of ours makes when it runs."""
    return run


@pytest.fixture(scope="session")
def judge(exercise):
    """``judge(part, value)``: the mark of a value, as every face gives it, through JSON."""

    def judged(part_id, value):
        part = exercise.part(part_id)
        request = json.loads(json.dumps(part.asks.request()))
        reading = json.loads(json.dumps(read_answer(request, value), allow_nan=False))
        return mark(part, reading)

    return judged


@pytest.fixture(scope="session")
def notebook_with():
    """``notebook_with({part: source})``: the student edition with these answers."""
    pristine = load(PRISTINE)

    def answered(answers):
        notebook = copy.deepcopy(pristine)
        for cell in notebook["cells"]:
            about = cell["metadata"]["dh"]
            if about["role"] == "answer" and about["part"] in answers:
                cell["source"] = answers[about["part"]]
        return notebook

    return answered
