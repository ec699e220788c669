"""One checker, four faces: the notebook's check, nbval, pytest and `dhlib grade` say the same of the same answer."""

import contextlib
import io
import json
import re
import subprocess
import sys
import warnings
import xml.etree.ElementTree as ET
from pathlib import Path

import nbclient
import nbformat
import pytest
from sampling import some

from dhlib.grading.answers import read_answer
from dhlib.grading.check import Checker, CheckFailed, tell
from dhlib.grading.exercise import load_exercise
from dhlib.grading.forms import Choice, Function, ReasonedChoice, Valued
from dhlib.grading.grade import grade_notebook
from dhlib.grading.marking import Marker, agree
from dhlib.grading.misconceptions import would_have_given

ROOT = Path(__file__).parents[2]
NAMES = sorted(path.stem for path in (ROOT / "solutions").glob("*.ipynb"))


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


#: Whole hand-ins. Each part is answered in every one of them, rightly or wrongly, in many ways.
ARM = """\
from dhlib import Rx, Rz, Tx, Ty, Tz, robots
import numpy as np
import sympy as sp

arm = robots.quickshot()
q = np.deg2rad([30, -50, 70, 20])
Z = Tx(300) @ Ty(-150) @ Tz(720) @ Rz(np.pi / 2)
E = Tz(90) @ Rz(np.pi / 2) @ Rx(-np.pi / 6)
short, written = arm.symbolic(short=True), arm.symbolic()


class Own:
    # The arm built without dhlib, which is closed for most parts.

    def A(self, i, q):
        d, a, sine = ((100, 20, -1), (0, 160, 0), (28, 0, 1), (250, 0, 0))[i - 1]
        cosine, m = 1 - abs(sine), sp if any(isinstance(angle, sp.Basic) for angle in q) else np
        c, s = m.cos(q[i - 1]), m.sin(q[i - 1])
        rows = [[c, -s * cosine, s * sine, a * c], [s, c * cosine, -c * sine, a * s]]
        rows += [[0, sine, cosine, d], [0, 0, 0, 1]]
        return sp.Matrix(rows) if m is sp else np.array(rows)

    def fk(self, q):
        return self.A(1, q) @ self.A(2, q) @ self.A(3, q) @ self.A(4, q)


own = Own()
"""
HANDED_IN = [
    {  # right, by other routes
        "frames": "frames = {i: frame for i, frame in enumerate(arm.frames([0, 0, 0, 0]))}",
        "table": "table = arm",
        "A1": "A1 = own.A(1, q).tolist()",
        "A2": "A2 = sp.Matrix(own.A(2, q))",
        "A3": "A3 = np.matrix(own.A(3, q))",
        "A4": "A4 = tuple(map(tuple, own.A(4, q).round(3)))",
        "A1_sym": "A1_sym = own.A(1, [theta1, theta2, theta3, theta4]).tolist()",
        "A2_sym": "A2_sym = own.A(2, sp.symbols('q1:5', real=True)).applyfunc(lambda e: e.rewrite(sp.exp))",
        "A3_sym": "A3_sym = own.A(3, [theta1, theta2, theta3, theta4]).evalf()",
        "A4_sym": "A4_sym = own.A(4, [theta1, theta2, theta3, theta4]).applyfunc(lambda e: e.rewrite(sp.tan))",
        "link": "link = own.A",
        "T4": "T4 = own.fk(q)",
        "T4_quarter": "T4_quarter = own.fk(np.pi / 2 * np.array([1, -1, 2, -1])).round(0)",
        "T4_sym": "T4_sym = short",
        "slip": "slip = 'N_y'",
        "mended": "mended = sp.expand_trig(written[1, 0])",
        "X": "X = Z @ T4 @ E",
        "T4_back": "T4_back = own.fk(np.deg2rad([40, 25, -65, 110]))",
    },
    {  # wrong in known ways, with a link whose error is carried on
        "frames": "frames = list(robots.quickshot('modified').frames([0, 0, 0, 0]))",
        "table": "table = [[theta1, 100, 20, -90], [theta2, 0, 160, 0], [theta3, 28, 0, 90], [theta4, 250, 0, 0]]",
        "A1": "c, s = np.cos(q[0]), np.sin(q[0])\nA1 = [[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 100], [0, 0, 0, 1]]",
        "A2": "A2 = own.A(2, -q)",
        "A3": "A3 = own.A(3, q)",
        "A4": "A4 = own.A(4, q)",
        "A1_sym": "A1_sym = own.A(1, [theta1, theta2, theta3, theta4]).T",
        "A2_sym": "A2_sym = sp.Matrix(own.A(2, q))",
        "A3_sym": "A3_sym = own.A(3, [theta1, theta2, theta3, theta4]).subs(theta3, theta2)",
        "A4_sym": "A4_sym = sp.Matrix([[sp.Symbol('r')] * 4] * 4)",
        "link": "def link(i, q):\n    return own.A(i, np.rad2deg(q))",
        "T4": "T4 = A1 @ A2 @ A3 @ A4",
        "T4_quarter": "T4_quarter = own.fk([0, 0, 0, 0])",
        "T4_sym": "T4_sym = sp.Matrix(own.fk([0, 0, 0, 0]))",
        "slip": "slip = 'n_x'",
        "mended": "mended = -sp.expand_trig(written[1, 0])",
        "X": "X = T4",
        "T4_back": "T4_back = X_measured",
    },
    {  # no answers, each in another way
        "frames": "frames = arm.frames([0, 0, 0, 0])[:4]",
        "table": "table = [[theta1, 100, 20]]",
        "A1": "A1 = 'a matrix'",
        "A2": "A2 = np.full((4, 4), np.nan)",
        "A3": "A3 = np.eye(3)",
        "A4": "A4 = [[1, 2], [3]]",
        "A1_sym": "A1_sym = lambda q: q",
        "A2_sym": "A2_sym = None",
        "A3_sym": "A3_sym = 'cos(theta1)'",
        "A4_sym": "A4_sym = sp.eye(4) * sp.I",
        "link": "def link(q):\n    return q",
        "T4": "T4 = own.fk(q).round(2)",
        "T4_quarter": "T4_quarter = arm",
        "T4_sym": "T4_sym = {1: 2}",
        "slip": "slip = 'n_w'",
        "mended": "mended = True",
        "X": "X = 7",
        "T4_back": "T4_back = np.diag([1.0, 1, -1, 1])",
    },
]  # fmt: skip


#: Exercises of which one hand-in is made each, right in a third of its parts, wrong in another, unreadable in the last.
MIXED = ("axes_to_table", "convert", "one_link", "planar", "puma560", "same_arm", "scara", "stanford", "transforms")


def wrong_answer(part):
    """The source of an answer that is none, or that a known misconception leads to."""
    match part.asks:
        case ReasonedChoice():
            return f"{part.id} = {part.asks.right!r}, {next(k for k, r in part.asks.reasons.items() if not r.holds)!r}"
        case Choice():
            return f"{part.id} = {next(option for option in part.asks.options if option != part.asks.right)!r}"
        case Function():
            (*first, _), values = part.asks.shape or (1, 1), part.asks.values(part.chain)
            told = values[0].tolist() if first or part.asks.shape else float(values[0])
            return f"def {part.id}(*arguments):\n    return {told!r}"
        case Valued():
            right = part.asks.values(part.chain)
            for _, values in would_have_given(part):
                if not agree(part.asks.meaning(values), part.asks.meaning(right), part.asks.tolerances):
                    return f"{part.id} = {values[0].tolist()!r}"
    return f"{part.id} = [[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]] * {part.chain.n + 1}"


NO_ANSWERS = ("...", "None", "'a word'", "float('nan')", "[[1, 2], [3]]", "{1: 2}", "7j", "object()")


def mixed_hand_in(name):
    """The student's notebook of an exercise with all three kinds of answers."""
    exercise = load_exercise(name, ROOT / "exercises")
    notebook = load(ROOT / "exercises" / f"{name}.ipynb")
    worked = {cell["id"]: cell["source"] for cell in load(ROOT / "solutions" / f"{name}.ipynb")["cells"]}
    places = {part.id: k for k, part in enumerate(exercise.parts)}
    for cell in notebook["cells"]:
        about = cell["metadata"]["dh"]
        if about["role"] != "answer":
            continue
        part = exercise.part(about["part"])
        # What comes later may build on this cell: its own answer runs first.
        source = "".join(worked[cell["id"]])
        kind = places[part.id] % 3
        if kind:
            other = wrong_answer(part) if kind == 1 else f"{part.id} = {NO_ANSWERS[places[part.id] % len(NO_ANSWERS)]}"
            source = f"{source}\nkept_{part.id} = {part.id}\n{other}"
        cell["source"] = source
    # Cells that build on an answer find the right one, whatever was handed in before them.
    for cell in notebook["cells"]:
        if cell["metadata"]["dh"]["role"] == "answer":
            kept = [p for p, k in places.items() if k % 3 and k < places[cell["metadata"]["dh"]["part"]]]
            cell["source"] = "".join(f"{p} = kept_{p}\n" for p in kept) + cell["source"]
    return notebook


def by_page(path):
    """Face 1: the Python that the page runs, on values that went through JSON."""
    notebook = load(path)
    exercise = load_exercise(notebook["metadata"]["dh"]["exercise"], ROOT / "exercises")
    marker, names, said = Marker(exercise), {}, {}
    for cell in notebook["cells"]:
        about = cell["metadata"]["dh"]
        if cell["cell_type"] == "code" and about["role"] != "check":
            with contextlib.redirect_stdout(io.StringIO()):
                exec("".join(cell["source"]), names)  # the hand-ins above
        if about["role"] == "answer":
            part = exercise.part(about["part"])
            reading = read_answer(part.asks.request(), names[part.id])
            said[part.id] = marker.mark(part.id, json.loads(json.dumps(reading, allow_nan=False)))
    return said


@pytest.fixture(scope="module")
def notebooks(tmp_path_factory, notebook_with):
    folder = tmp_path_factory.mktemp("handed_in")
    paths = []
    for k, answers in enumerate(HANDED_IN):
        first = next(iter(answers))
        notebook = notebook_with({**answers, first: ARM + answers[first]})
        paths.append(folder / f"hand_in_{k}.ipynb")
        paths[-1].write_text(json.dumps(notebook), encoding="utf-8")
    return paths


def by_check(path):
    """Face 2: every check cell in a kernel, the sentence that it prints or raises."""
    notebook = nbformat.read(path, as_version=4)
    client = nbclient.NotebookClient(
        notebook,
        timeout=60,
        allow_errors=True,
        kernel_name="python3",
        resources={"metadata": {"path": str(path.parent)}},
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        client.execute()
    said = {}
    for cell in notebook.cells:
        if cell.metadata["dh"]["role"] == "check":
            errors = [output for output in cell.outputs if output.output_type == "error"]
            for error in errors:
                assert error.ename == "CheckFailed"
                assert error.traceback == [error.evalue]
            texts = [
                output.text for output in cell.outputs if output.output_type == "stream" and output.name == "stdout"
            ]
            said[cell.metadata["dh"]["part"]] = (not errors, errors[0].evalue if errors else "".join(texts).strip())
    return said


def pytest_on(folder, *options):
    report = folder / "report.xml"
    command = [sys.executable, "-m", "pytest", "-n0", "-q", "-p", "no:cacheprovider", f"--junitxml={report}", *options]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    return list(ET.parse(report).getroot().iter("testcase")), said


def by_nbval(path, folder):
    """Face 3a: which cells pass."""
    roles = [cell["metadata"]["dh"] for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    cases, _ = pytest_on(folder, "--nbval-lax", str(path))
    assert len(cases) == len(roles)
    passed = {}
    for case in cases:
        role = roles[int(re.search(r"Cell (\d+)", case.get("name"))[1])]
        good = case.find("failure") is None and case.find("error") is None
        if role["role"] == "check":
            passed[role["part"]] = good
        else:
            assert good, (role, ET.tostring(case))
    return passed


def by_pytest(path, folder):
    """Face 3b: the sentence of each failed test, None of each that passed."""
    said = {}
    cases, _ = pytest_on(folder, "--dh-grade", str(path))
    for case in cases:
        failure = case.find("failure")
        properties = {p.get("name"): p.get("value") for p in case.iter("property")}
        said[case.get("name")] = (
            failure is None,
            None if failure is None else failure.text,
            float(properties["dh_points"]),
        )
    return said


@pytest.mark.notebooks
@pytest.mark.parametrize("k", range(len(HANDED_IN)))
def test_all_faces_say_the_same(notebooks, tmp_path, k):
    path = notebooks[k]
    graded = {mark.part: mark for mark in grade_notebook(path).marks}
    checked, valued, tested = by_check(path), by_nbval(path, tmp_path), by_pytest(path, tmp_path)
    assert len(graded) == 18
    for part, mark in graded.items():
        assert checked[part] == (mark.passed, tell(mark)), part
        assert valued[part] == mark.passed, part
        passed, words, points = tested[part]
        assert (passed, points) == (mark.passed, mark.points), part
        assert words is None or words.strip() == tell(mark)


@pytest.mark.notebooks
@pytest.mark.parametrize("name", some(MIXED, 3, "mixed"))
def test_all_faces_say_the_same_of_every_kind_of_answer(name, tmp_path):
    path = tmp_path / f"{name}.ipynb"
    path.write_text(json.dumps(mixed_hand_in(name)), encoding="utf-8")
    graded = {mark.part: mark for mark in grade_notebook(path).marks}
    checked, tested, paged = by_check(path), by_pytest(path, tmp_path), by_page(path)
    for part, mark in graded.items():
        assert paged[part] == mark, part
        assert checked[part] == (mark.passed, tell(mark)), part
        passed, words, points = tested[part]
        assert (passed, points) == (mark.passed, mark.points), part
        assert words is None or words.strip() == tell(mark)
    verdicts = [mark.verdict for mark in graded.values()]
    assert verdicts[::3] == ["right"] * len(verdicts[::3])
    assert not {"right", "follows"} & {*verdicts[1::3], *verdicts[2::3]}


def test_two_hundred_answers_go_through_all_faces():
    """With ``FULL=1``; else those of a sample of the exercises."""
    parts = sum(len(load_exercise(name, ROOT / "exercises").parts) for name in MIXED)
    assert parts + sum(len(answers) for answers in HANDED_IN) >= 200


def test_the_hand_ins_are_what_they_are_meant_to_be(notebooks):
    first, second, third = (grade_notebook(path) for path in notebooks)
    assert (first.points, first.out_of) == (30, 30)
    verdicts = {mark.part: mark.verdict for mark in second.marks}
    assert {part for part, verdict in verdicts.items() if verdict in ("right", "follows")} == {"A3", "A4", "T4"}
    assert third.points == 1  # for T4, which was rounded too early
    assert sum(len(answers) for answers in HANDED_IN) >= 40


def test_the_solution_gets_full_marks(every):
    result = grade_notebook(ROOT / "solutions" / f"{every.name}.ipynb")
    assert (result.status, result.points, result.out_of) == ("graded", every.points, every.points)


@pytest.mark.notebooks
@pytest.mark.parametrize("some_name", some(NAMES, 3, "solutions"))
def test_the_solution_gets_full_marks_by_every_face(some_name, tmp_path):
    exercise, solution = load_exercise(some_name, ROOT / "exercises"), ROOT / "solutions" / f"{some_name}.ipynb"
    cases, _ = pytest_on(tmp_path, "--nbval", str(solution))  # all stored outputs compared
    assert [case.get("name") for case in cases if len(case)] == []
    assert len(cases) == sum(cell["cell_type"] == "code" for cell in load(solution)["cells"])
    cases, said = pytest_on(tmp_path, "--dh-grade", str(solution))
    assert len(cases) == len(exercise.parts)
    assert f"{len(exercise.parts)} passed" in said
    assert f"solutions/{some_name}.ipynb: {exercise.points:g} of {exercise.points:g} points" in said


def test_the_untouched_exercise_gets_none(name):
    assert grade_notebook(ROOT / "exercises" / f"{name}.ipynb").points == 0


@pytest.mark.notebooks
@pytest.mark.parametrize("some_name", some(NAMES, 2, "untouched"))
def test_the_untouched_exercise_gets_none_by_any_face(some_name, tmp_path):
    pristine = ROOT / "exercises" / f"{some_name}.ipynb"
    assert not any(by_nbval(pristine, tmp_path).values())
    assert not any(passed for passed, _, _ in by_pytest(pristine, tmp_path).values())


@pytest.mark.notebooks
def test_stored_outputs_prove_nothing(notebook_with, tmp_path):
    """A notebook that was run, whose outputs then were written to say right, still fails where it is wrong."""
    notebook = notebook_with({"slip": "slip = 'n_y'", "A1": "import numpy as np\nA1 = np.eye(4)"})
    for k, cell in enumerate(cell for cell in notebook["cells"] if cell["cell_type"] == "code"):
        cell["execution_count"] = k + 1
        if cell["metadata"]["dh"]["role"] == "check":
            words = f"{cell['metadata']['dh']['part']}: right.\n"
            cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": [words]}]
    path = tmp_path / "saved.ipynb"
    path.write_text(json.dumps(notebook), encoding="utf-8")
    assert [part for part, good in by_nbval(path, tmp_path).items() if good] == ["slip"]
    assert grade_notebook(path, "quickshot").points == 1


def test_changed_and_deleted_checks_count_for_nothing(notebook_with, tmp_path):
    notebook = notebook_with({"A1": "A1 = 3", "slip": "slip = 'n_y'"})
    notebook["cells"] = [cell for cell in notebook["cells"] if cell["id"] != "check-slip"]
    for cell in notebook["cells"]:
        if cell["metadata"]["dh"]["role"] in ("setup", "check"):
            cell["source"] = "check = lambda part, answer: print(part, 'right')"
    path = tmp_path / "forged.ipynb"
    path.write_text(json.dumps(notebook), encoding="utf-8")
    marks = {mark.part: mark for mark in grade_notebook(path).marks}
    assert marks["slip"].passed
    assert [part for part, mark in marks.items() if mark.passed] == ["slip"]


def test_check_without_a_kernel(capsys):
    check = Checker("quickshot", ROOT / "exercises")
    check("slip", "n_y")
    assert capsys.readouterr().out.startswith("slip: right.")
    with pytest.raises(CheckFailed, match="still open") as failed:
        check("A1", ...)
    assert failed.value._render_traceback_() == [str(failed.value)]
    with pytest.raises(CheckFailed, match="one answer"):
        check("A1")
    with pytest.raises(ValueError, match="its parts are frames, table"):
        check("A9", 1)
    assert "0x" not in repr(check)
