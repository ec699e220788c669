"""Student editions: solution minus bodies, without a trace of them, and never adrift."""

import copy
import json
import re
import shutil
from pathlib import Path

import pytest

from dhlib.errors import DHError
from dhlib.grading.derive import as_text, derive, main, open_regions

ROOT = Path(__file__).parents[2]
SOLUTION = ROOT / "solutions" / "quickshot.ipynb"
MARKER = "MARKER-7f3a"


@pytest.fixture
def solution():
    return json.loads(SOLUTION.read_text(encoding="utf-8"))


def test_every_exercise_is_whole():
    stems = [
        {path.stem for path in ROOT.glob(files)}
        for files in ("solutions/*.ipynb", "exercises/*.ipynb", "exercises/*.py")
    ]
    assert stems[0] == stems[1] == stems[2]


def test_the_exercise_is_what_its_solution_gives(name, worked):
    pristine = (ROOT / "exercises" / f"{name}.ipynb").read_text(encoding="utf-8")
    assert pristine == as_text(derive(worked, name)), "run make exercises"


def test_exercise_is_solution_minus_bodies_cell_by_cell(name, worked):
    derived = {cell["id"]: cell for cell in derive(worked, name)["cells"]}
    kept = [cell for cell in worked["cells"] if cell["metadata"]["dh"]["role"] != "solution"]
    assert list(derived) == [cell["id"] for cell in kept]
    for cell in kept:
        source = "".join(cell["source"])
        mine = "".join(derived[cell["id"]]["source"])
        if cell["metadata"]["dh"]["role"] == "answer":
            assert mine != source
            assert "..." in mine
        else:
            assert mine == source


def test_markers_planted_everywhere_are_gone(name, worked):
    planted = copy.deepcopy(worked)
    planted["metadata"][MARKER] = MARKER
    planted["metadata"]["kernelspec"]["display_name"] = MARKER
    for cell in planted["cells"]:
        cell["metadata"][MARKER] = {"x": MARKER}
        cell["metadata"]["tags"] = [MARKER]
        cell["metadata"]["dh"]["note"] = MARKER
        cell["attachments"] = {f"{MARKER}.png": {"image/png": MARKER}}
        cell[MARKER] = MARKER
        if cell["cell_type"] == "code":
            cell["execution_count"] = 7
            cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": [MARKER]}]
            source = "".join(cell["source"])
            cell["source"] = source.replace("### solution\n", f"### solution\n# {MARKER}\nx = '{MARKER}'\n")
        elif cell["metadata"]["dh"]["role"] == "solution":
            cell["source"] = [MARKER]
    assert as_text(planted).count(MARKER) > 5 * len(planted["cells"])
    text = as_text(derive(planted, name))
    assert MARKER not in text
    assert '"execution_count": 7' not in text
    assert text == as_text(derive(worked, name))


def test_no_line_of_a_solution_is_left(name, worked):
    text = as_text(derive(worked, name))
    lines = set()
    for cell in worked["cells"]:
        source = "".join(cell["source"])
        if "### solution" in source:
            body = source.split("### solution\n")[1].split("### yours")[0]
            stub = source.split("### yours")[1]
            lines.update(line.strip() for line in body.splitlines() if len(line.strip()) > 12 and line not in stub)
    assert len(lines) > 10
    assert [line for line in lines if json.dumps(line)[1:-1] in text] == []


def test_stubs_never_raise_by_themselves(name, worked, every):
    names = {}
    for cell in derive(worked, name)["cells"]:
        if cell["metadata"]["dh"]["role"] in ("setup", "answer"):
            exec("".join(cell["source"]), names)
    assert {part.id for part in every.parts} <= set(names)
    assert any(names[part.id] is ... for part in every.parts)


def unhelpful(notebook, parts):
    """Each part of a solution notebook that lacks points in its heading, a hint in its task or a why after it."""
    found, headings, waiting, task, heading = [], {}, [], "", ""
    for cell in notebook["cells"]:
        role, source = cell["metadata"]["dh"]["role"], "".join(cell["source"])
        if role == "text":
            task = source
            heading = source.splitlines()[0] if source.startswith("## ") else heading
            if source.startswith("## "):
                found += [f"{part}: no why" for part in waiting]
                waiting = []
        elif role == "answer":
            part = cell["metadata"]["dh"]["part"]
            headings.setdefault(heading, []).append(part)
            waiting.append(part)
            if not re.search(r"<details><summary>Hint</summary>\n\n.+?\n\n</details>", task, re.DOTALL):
                found.append(f"{part}: no hint")
        elif role == "solution" and source.startswith("**Why"):
            waiting = []
    found += [f"{part}: no why" for part in waiting]
    for heading, ids in headings.items():
        said = re.search(r"\((\d.*?) points?( each)?\)$", heading)
        numbers = [int(number) for number in re.findall(r"\d+", said[1])] if said else []
        worth = [part.points for part in parts if part.id in ids]
        if (numbers * len(ids) if said and said[2] else numbers) != worth:
            found.append(f"{', '.join(ids)}: no points")
    return found


def test_every_part_says_its_points_and_has_a_hint_and_a_why(worked, every):
    assert unhelpful(worked, every.parts) == []


@pytest.mark.parametrize(
    ("cell_id", "old", "new", "lacking"),
    [
        ("link-task", "<details>", "", ["link: no hint"]),
        ("link-why", "**Why.**", "", ["link: no why"]),
        ("ends-why", "**Why.**", "", ["X: no why", "T4_back: no why"]),
        ("T4-task", "(2 and 1 points)", "(1 and 2 points)", ["T4, T4_quarter: no points"]),
        ("links-task", " (1 point each)", "", ["A1, A2, A3, A4: no points"]),
    ],
)
def test_a_part_without_help_is_named(solution, exercise, cell_id, old, new, lacking):
    cell = the(solution["cells"], cell_id)
    cell["source"] = "".join(cell["source"]).replace(old, new)
    assert unhelpful(solution, exercise.parts) == lacking


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("### solution\nx = 1", "not closed"),
        ("### solution\nx = 1\n### end", "'### yours' should come first"),
        ("### yours\n# x\n### end", "'### solution' should come first"),
        ("### solution\n### solution", "should come first"),
        ("### solution\nx = 1\n### yours\nx = ...\n### end", "should be a comment"),
    ],
)
def test_a_broken_region_is_named(source, words):
    with pytest.raises(DHError, match=words):
        open_regions(source)


def test_indented_regions_keep_their_place():
    source = "def f():\n    ### solution\n    return 1\n    ### yours\n    # return ...\n    ### end\n"
    assert open_regions(source) == "def f():\n    return ..."


def the(cells, cell_id):
    return next(cell for cell in cells if cell["id"] == cell_id)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda cells: cells[1]["metadata"].clear(), "should have a role"),
        (lambda cells: cells[2].update(id=cells[1]["id"]), "once only"),
        (
            lambda cells: the(cells, "check-frames").update(source='check("A1", 1)'),
            "the check cell of frames should be",
        ),
        (lambda cells: the(cells, "answer-A1").update(metadata=the(cells, "answer-frames")["metadata"]), "already"),
        (lambda cells: the(cells, "given-arm")["metadata"]["dh"].pop("part"), "should name its part"),
    ],
)
def test_a_broken_solution_is_named(solution, change, words):
    code = solution["cells"]
    change(code)
    with pytest.raises(DHError, match=words):
        derive(solution, "quickshot")


def test_drift_is_reported_and_mended(tmp_path, capsys):
    folders = ["--solutions", str(SOLUTION.parent), "--exercises", str(tmp_path)]
    assert main([*folders, "--check"]) == 1
    assert "run make exercises" in capsys.readouterr().err
    assert main(folders) == 0
    assert main([*folders, "--check"]) == 0
    changed = tmp_path / "quickshot.ipynb"
    changed.write_text(changed.read_text(encoding="utf-8").replace("A1 = ...", "A1 = 1"), encoding="utf-8")
    assert main([*folders, "--check"]) == 1


def test_a_folder_without_solutions_is_said(tmp_path, capsys):
    assert main(["--solutions", str(tmp_path), "--exercises", str(tmp_path)]) == 2
    assert f"There is no notebook in {tmp_path}." in capsys.readouterr().err


def test_what_is_given_in_a_solution_is_mended_too(tmp_path, capsys):
    for suffix in (".py", ".ipynb"):
        shutil.copy(ROOT / "exercises" / f"quickshot{suffix}", tmp_path)
    (tmp_path / "solutions").mkdir()
    stale = tmp_path / "solutions" / "quickshot.ipynb"
    right = SOLUTION.read_text(encoding="utf-8")
    assert '"upper_arm = 160' in right
    stale.write_text(right.replace('"upper_arm = 160', '"upper_arm = 170'), encoding="utf-8")
    folders = ["--solutions", str(stale.parent), "--exercises", str(tmp_path)]
    assert main([*folders, "--check"]) == 1
    assert str(stale) in capsys.readouterr().err
    assert main(folders) == 0
    assert stale.read_text(encoding="utf-8") == right


def test_the_stored_outputs_of_the_solution_say_right(worked, every):
    checks = [cell for cell in worked["cells"] if cell["metadata"]["dh"]["role"] == "check"]
    assert [cell["metadata"]["dh"]["part"] for cell in checks] == [part.id for part in every.parts]
    for cell in checks:
        (output,) = cell["outputs"]
        assert "".join(output["text"]).startswith(f"{cell['metadata']['dh']['part']}: right.")
