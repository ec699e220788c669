"""Graded elsewhere: Gradescope's autograder is run as Gradescope runs it, and the workflow keeps to its rules."""

import io
import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
import yaml

from dhlib.cli import main
from dhlib.grading.course.assign import Assigning
from dhlib.grading.reports import autograder, classroom
from dhlib.grading.reports.wheel import wheel

from .conftest import ROOT
from .test_exports import check_gradescope


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory):
    """The zip, as Gradescope unpacks it into /autograder/source."""
    folder = tmp_path_factory.mktemp("autograder")
    archive = zipfile.ZipFile(io.BytesIO(autograder.write("quickshot", ROOT / "exercises")[autograder.NAME]))
    for entry in archive.infolist():
        path = folder / "source" / entry.filename
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(archive.read(entry))
        path.chmod(entry.external_attr >> 16 & 0o777)
    return folder


def graded(unpacked, folder, *notebooks):
    """The results.json of some files handed in."""
    shutil.copytree(unpacked, folder, dirs_exist_ok=True)
    shutil.copy(folder / "source" / "run_autograder", folder)  # as Gradescope does when it builds the image
    (folder / "submission").mkdir()
    for notebook in notebooks:
        shutil.copy(notebook, folder / "submission")
    environment = os.environ | {"AUTOGRADER": str(folder), "DHLIB_VENV": sys.prefix}
    command = [str(folder / "run_autograder")]
    done = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300, check=False
    )
    result = folder / "results" / "results.json"
    assert result.exists(), done.stdout + done.stderr
    return json.loads(result.read_text("utf-8"))


def test_the_scripts_may_be_run_and_stand_at_the_root(unpacked):
    for name in ("setup.sh", "run_autograder"):
        script = unpacked / "source" / name
        assert os.access(script, os.X_OK)
        assert script.read_text("utf-8").startswith("#!/usr/bin/env bash\n")
        assert subprocess.run(["bash", "-n", script], check=False).returncode == 0
        assert "@EXERCISE@" not in script.read_text("utf-8")
    assert list((unpacked / "source").glob("dhlib-*.whl"))
    assert "[grade]" in (unpacked / "source" / "setup.sh").read_text("utf-8")


def test_an_exercise_of_the_library_is_not_packed_twice():
    def packed(folder):
        return zipfile.ZipFile(io.BytesIO(autograder.write("quickshot", folder)[autograder.NAME])).namelist()

    own = {"exercises/quickshot.py", "exercises/quickshot.ipynb"}
    assert set(packed(ROOT / "exercises")) - set(packed(None)) == own


@pytest.mark.notebooks
@pytest.mark.sandbox
def test_gradescope_gives_a_solution_all_points(unpacked, tmp_path):
    result = graded(unpacked, tmp_path / "autograder", ROOT / "solutions" / "quickshot.ipynb")
    check_gradescope(result)
    assert (result["score"], len(result["tests"])) == (30, 18)
    assert {test["status"] for test in result["tests"]} == {"passed"}


@pytest.mark.notebooks
@pytest.mark.sandbox
def test_gradescope_gives_an_open_notebook_none(unpacked, tmp_path):
    result = graded(unpacked, tmp_path / "autograder", ROOT / "exercises" / "quickshot.ipynb")
    check_gradescope(result)
    assert result["score"] == 0


@pytest.mark.notebooks
def test_gradescope_is_told_that_nothing_was_handed_in(unpacked, tmp_path):
    result = graded(unpacked, tmp_path / "autograder")
    assert result["score"] == 0
    assert "No notebook was handed in" in result["output"]


def test_the_wheel_is_that_of_this_library(tmp_path):
    name, content = wheel()
    assert content == wheel()[1]
    (tmp_path / name).write_bytes(content)
    target = tmp_path / "site"
    pip = [sys.executable, "-m", "zipfile", "-e", str(tmp_path / name), str(target)]
    subprocess.run(pip, check=True)
    probe = (
        "import dhlib; from dhlib.grading.exercise import load_exercise as l; print(dhlib.__file__, l('planar').title)"
    )
    command = [sys.executable, "-S", "-c", f"import sys; sys.path[:0] = [{str(target)!r}, *{sys.path!r}]\n{probe}"]
    said = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert said.startswith(str(target))
    records = {line.split(",")[0] for line in _record(content).splitlines()}
    assert records == set(zipfile.ZipFile(io.BytesIO(content)).namelist())
    assert not [file for file in records if "solutions" in file or "tests" in file]


def _record(content):
    archive = zipfile.ZipFile(io.BytesIO(content))
    (name,) = [name for name in archive.namelist() if name.endswith("RECORD")]
    return archive.read(name).decode()


def test_the_workflow_keeps_to_the_rules_of_the_classroom():
    files = classroom.write("quickshot", ROOT / "exercises")
    workflow = yaml.safe_load(files[".github/workflows/classroom.yml"])
    assert workflow["name"] == "Autograding Tests"
    assert list(workflow["jobs"]) == ["run-autograding-tests"]
    assert workflow["permissions"] == {"contents": "read"}
    steps = workflow["jobs"]["run-autograding-tests"]["steps"]
    assert all(step.get("uses", "actions/").startswith("actions/") for step in steps)
    for step in steps:
        script = step.get("run", "")
        assert subprocess.run(["bash", "-n", "-c", script], check=False).returncode == 0
        assert "@EXERCISE@" not in script
    assert any(name.startswith(".github/dhlib/dhlib-") for name in files)


@pytest.mark.parametrize("kind", ["gradescope-autograder", "github-classroom"])
def test_what_is_graded_elsewhere_has_no_numbers_of_a_students_own_and_says_so(kind, tmp_path, capsys):
    command = ["export", "--format", kind, "--out", str(tmp_path / "out")]
    assert main([*command, "--exercise", "quickshot", "--exercises", str(ROOT / "exercises")]) == 0
    assert "numbers of the book" in capsys.readouterr().out
    for suffix in (".py", ".ipynb"):  # one that cannot vary, of which there is nothing to say
        shutil.copy(ROOT / "exercises" / f"quickshot{suffix}", tmp_path / f"fixed{suffix}")
    source = (tmp_path / "fixed.py").read_text("utf-8").replace("def draw(", "def no_draw(")
    (tmp_path / "fixed.py").write_text(source, "utf-8")
    assert main([*command, "--exercise", "fixed", "--exercises", str(tmp_path)]) == 0
    assert "numbers of the book" not in capsys.readouterr().out


@pytest.mark.notebooks
@pytest.mark.sandbox
def test_gradescope_refuses_an_assigned_notebook_with_a_sentence(unpacked, tmp_path):
    notebook = Assigning("quickshot", b"key", ROOT / "exercises").notebook("a1")
    (tmp_path / "quickshot.ipynb").write_text(json.dumps(notebook), "utf-8")
    result = graded(unpacked, tmp_path / "autograder", tmp_path / "quickshot.ipynb")
    assert result["score"] == 0
    assert "assigned to 'a1'" in result["output"]


@pytest.mark.parametrize("name", ["nothing", "../x", "a; rm -rf /", "$(x)"])
def test_only_an_exercise_gets_into_a_script(name, tmp_path, capsys):
    for kind in ("gradescope-autograder", "github-classroom"):
        assert main(["export", "--format", kind, "--exercise", name, "--out", str(tmp_path)]) == 2
        assert "exercise" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_what_is_missing_is_said(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["export", "--format", "github-classroom"]) == 2
    assert "--exercise NAME" in capsys.readouterr().err
    assert main(["export", "--format", "moodle"]) == 2
    assert "Name the folder" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["export", "--format", "excel", "x"])
    assert not list(Path().iterdir())
