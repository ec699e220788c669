"""The container that README builds: its walls stand, and it grades as home does.

Skipped where neither podman nor docker runs containers, or the image that ours begins from cannot be had.
"""

import copy
import csv
import json
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from dhlib.cli import main
from dhlib.grading.wall.outer import CONTAINER

pytestmark = [pytest.mark.sandbox, pytest.mark.slow]

ROOT = Path(__file__).parents[2]
IMAGE = "dhlib-grade-in-test"
SECONDS = "12"
ATTACKS = ("read_everywhere", "socket_loopback", "library_changed", "exit_at_once", "kill_keeper")


def commands():
    """What README says: how to build, and how to grade."""
    block = re.search(r"^podman build.*?(?=^```)", (ROOT / "README.md").read_text("utf-8"), re.MULTILINE | re.DOTALL)[0]
    return [shlex.split(line, comments=True) for line in block.replace("\\\n", " ").splitlines()]


BUILD, GRADE = commands()


def run(words, folder=ROOT):
    """Run a command of README, with an image that is nobody else's."""
    if words[:2] == ["docker", "run"]:  # as README says
        words = [*words[:2], "--user", f"{os.getuid()}:{os.getgid()}", *words[2:]]
    words = [IMAGE if word == "dhlib-grade" else word.replace("$PWD", str(folder)) for word in words]
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)


@pytest.fixture(scope="session")
def engine():
    """The engine that runs containers here, with the image built; skipped where there is none."""
    base = re.search(r"^FROM (\S+)", (ROOT / "Containerfile").read_text("utf-8"), re.MULTILINE)[1]
    for name in ("podman", "docker"):
        if not shutil.which(name) or run([name, "info"]).returncode:
            continue
        if run([name, "image", "inspect", base]).returncode and run([name, "pull", "--quiet", base]).returncode:
            pytest.skip(f"{base} cannot be had")
        built = run([name, *BUILD[1:]])
        assert built.returncode == 0, built.stdout[-3000:] + built.stderr[-3000:]
        yield name
        run([name, "rmi", "--force", IMAGE])
        return
    pytest.skip("neither podman nor docker runs containers here")


def only_doctor(words):
    return [*words[: words.index("grade")], "grade", "--doctor"]


def test_its_walls_stand(engine):
    said = run([engine, *only_doctor(GRADE)[1:]])
    assert said.returncode == 0, said.stdout + said.stderr
    assert "✘" not in said.stdout
    assert "✔ processes are bounded" in said.stdout


def test_without_the_options_it_refuses_and_names_them(engine):
    words = [word for word in only_doctor(GRADE)[1:] if word != "--security-opt" and "=unconfined" not in word]
    words.remove("label=disable")
    said = run([engine, *words])
    assert said.returncode == 1
    assert "no sandbox" in said.stdout
    assert CONTAINER in said.stdout


def test_readme_names_the_options_that_the_refusal_does():
    assert CONTAINER in " ".join(GRADE)


def test_it_grades_as_home_does_and_what_is_hostile_costs_nobody_else(engine, walls, tmp_path):
    folder = tmp_path / "handed-in"
    right = json.loads((ROOT / "solutions" / "quickshot.ipynb").read_text("utf-8"))
    hand_in(folder, "anna", right)
    hand_in(folder, "bert", json.loads((ROOT / "exercises" / "quickshot.ipynb").read_text("utf-8")))
    for name in ATTACKS:
        source = (Path(__file__).parent / "attacks" / f"{name}.cell").read_text("utf-8").replace("PORT", "80")
        hand_in(folder, name, with_attack(right, source))
    hand_in(folder, "zoe", right)
    (tmp_path / "here").mkdir()
    try:
        main(["grade", str(folder), "--out", str(tmp_path / "here"), "--timeout", SECONDS])
        said = run([engine, *GRADE[1:], "--timeout", SECONDS], tmp_path)
        assert said.returncode == 0, said.stdout + said.stderr
        there = grades(tmp_path / "marks")
        assert there == grades(tmp_path / "here")
        assert {name: there[name]["points"] for name in ("anna", "bert", "zoe")} == {
            "anna": "30",
            "bert": "0",
            "zoe": "30",
        }
        assert {there[name]["frames"] for name in ATTACKS} == {"0"}
        assert os.stat(tmp_path / "marks" / "grades.csv").st_uid == os.geteuid()
    finally:  # whose it is depends on the engine
        run([engine, "run", "--rm", "-v", f"{tmp_path}:/work", "--entrypoint", "rm", IMAGE, "-rf", "/work/marks"])


def grades(folder):
    with (folder / "grades.csv").open(encoding="utf-8-sig") as file:
        return {row["student"]: row for row in csv.DictReader(file)}


def hand_in(folder, name, notebook):
    (folder / name).mkdir(parents=True)
    (folder / name / "quickshot.ipynb").write_text(json.dumps(notebook), encoding="utf-8")


def with_attack(notebook, source):
    """The notebook with an attack in the cell of the first part, whose answer comes to nothing after it."""
    notebook = copy.deepcopy(notebook)
    first = next(c for c in notebook["cells"] if c["metadata"].get("dh", {}).get("role") == "answer")
    first["source"] = f"{source}\n1 / 0"
    return notebook
