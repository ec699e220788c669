"""The page for instructors: each of its commands runs, and does what the page says."""

from __future__ import annotations

import csv
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import NamedTuple

import pytest

PAGE = "book/instructors.md"


class Outcome(NamedTuple):
    """What the page promises of a command."""

    code: int
    says: str


COMMANDS = {
    "pytest --nbval-lax exercises/quickshot.ipynb": Outcome(1, r"18 failed"),
    "pytest --nbval-lax solutions/quickshot.ipynb": Outcome(0, r"passed"),
    "pytest --dh-grade solutions/quickshot.ipynb": Outcome(0, r"30 of 30 points"),
    "dhlib grade handed-in --out marks": Outcome(0, r"marks/grades\.csv"),
    "dhlib grade moodle.zip --out from-moodle --roster roster.csv": Outcome(0, r"1 of the 2 on the roster"),
    "dhlib grade handed-in --out marks --regrade": Outcome(0, r"marks/grades\.csv"),
}
#: Run one after the other, by a test of their own.
SHARES = [
    "dhlib grade handed-in --out share-1 --shard 1/2",
    "dhlib grade handed-in --out share-2 --shard 2/2",
    "dhlib merge share-1 share-2 --out together",
]
#: Needs certificates; tests/sandbox/test_cluster.py has a scheduler with TLS, and a test below reads the options.
CLUSTER = (
    "dhlib grade handed-in --out marks --scheduler tls://cluster.example:8786 "
    "--tls-ca ca.pem --tls-cert me.pem --tls-key me.key"
)
#: Run elsewhere: by tests of their own, and by whoever builds the book.
TESTED_ELSEWHERE = {"make book EDITION=course", CLUSTER, *SHARES}
#: One after the other, in a folder of their own.
CLOSED_COURSE = {
    "dhlib key course.key": r"out of git",
    "dhlib assign quickshot --roster roster.csv --key course.key --out week-3 --due 2030-05-31": r"2 notebooks",
    "dhlib solution quickshot --student a1 --key course.key": r"30 of 30 points",
    "dhlib grade handed-in --key course.key --out week-3-marks": r"week-3-marks",
    "pytest --dh-key course.key --dh-grade handed-in/quickshot-a1.ipynb": r"30 of 30 points",
}


@pytest.fixture
def page(root: Path) -> str:
    return (root / PAGE).read_text("utf-8")


@pytest.fixture
def course(root: Path, tmp_path: Path) -> Path:
    """A folder with the exercises, the solutions, and two notebooks that were handed in: one solved, one not."""
    for folder in ("exercises", "solutions"):
        shutil.copytree(root / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "handed-in" / "group").mkdir(parents=True)
    shutil.copy(root / "solutions" / "quickshot.ipynb", tmp_path / "handed-in" / "solved.ipynb")
    shutil.copy(root / "exercises" / "quickshot.ipynb", tmp_path / "handed-in" / "group" / "open.ipynb")
    with zipfile.ZipFile(tmp_path / "moodle.zip", "w") as archive:
        archive.write(
            root / "exercises" / "quickshot.ipynb", "Ada Lovelace_1815_assignsubmission_file_/quickshot.ipynb"
        )
    (tmp_path / "roster.csv").write_text("id,name\ns1,Ada Lovelace\ns2,Bob\n", "utf-8")
    return tmp_path


def commands_of(text: str) -> set[str]:
    blocks = re.findall(r"^```sh\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    return {line for block in blocks for line in block.splitlines() if line}


def run(command: str, folder: Path) -> tuple[int, str]:
    tools = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST", "COV_"))}
    done = subprocess.run(
        command.split(), cwd=folder, env={**inherited, "PATH": tools}, capture_output=True, text=True, timeout=300
    )
    return done.returncode, done.stdout + done.stderr


def test_every_command_of_the_page_is_tested(page: str) -> None:
    assert commands_of(page) == COMMANDS.keys() | CLOSED_COURSE.keys() | TESTED_ELSEWHERE


def test_an_untested_command_would_be_found(page: str) -> None:
    tested = COMMANDS.keys() | CLOSED_COURSE.keys()
    assert commands_of(page + "\n```sh\ndhlib conjure\n```\n") - tested == {"dhlib conjure", *TESTED_ELSEWHERE}


@pytest.mark.notebooks
@pytest.mark.parametrize("command", COMMANDS)
def test_the_command_does_what_the_page_says(command: str, course: Path) -> None:
    code, output = run(command, course)
    assert code == COMMANDS[command].code, output
    assert re.search(COMMANDS[command].says, output), output


@pytest.mark.notebooks
def test_a_class_gets_the_table_and_the_pages_that_are_described(page: str, course: Path) -> None:
    run("dhlib grade handed-in --out marks", course)
    with (course / "marks" / "grades.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = {row["notebook"]: row for row in csv.DictReader(file)}
    columns = re.search(r"with the columns (.*?), one for each part, (.*?)\. ", page)
    assert columns is not None
    for column in re.findall(r"`(\w+)`", "".join(columns.groups())):
        assert column in rows["solved.ipynb"]
    assert (rows["solved.ipynb"]["points"], rows["solved.ipynb"]["out_of"]) == ("30", "30")
    assert rows["group/open.ipynb"]["points"] == "0"
    for row in rows.values():
        assert (course / "marks" / row["feedback"]).is_file()


@pytest.mark.notebooks
def test_shares_come_together(course: Path) -> None:
    for command in SHARES:
        code, output = run(command, course)
        assert code == 0, output
    with (course / "together" / "grades.csv").open(encoding="utf-8-sig", newline="") as file:
        assert {row["notebook"] for row in csv.DictReader(file)} == {"solved.ipynb", "group/open.ipynb"}


def test_the_command_for_a_cluster_is_understood(course: Path) -> None:
    code, output = run(CLUSTER, course)
    assert code == 2
    assert "there is no file ca.pem" in output


@pytest.mark.notebooks
def test_exit_codes_are_those_of_the_page(page: str, course: Path) -> None:
    assert "exit code 0 if all were graded, 1 if some were not, 2 if it was misused" in page
    (course / "handed-in" / "essay.ipynb").write_text("no notebook", "utf-8")
    assert run("dhlib grade handed-in --out marks", course)[0] == 1
    assert run("dhlib grade nowhere --out marks", course)[0] == 2


def test_every_option_of_the_page_exists(page: str, course: Path) -> None:
    code, usage = run("dhlib grade --help", course)
    assert code == 0
    options = set(re.findall(r"^\| `(--\w+) ", page, re.MULTILINE))
    assert options
    assert all(option in usage for option in options)


@pytest.mark.notebooks
def test_a_closed_course_from_its_key_to_its_solutions(page: str, course: Path) -> None:
    shutil.rmtree(course / "handed-in")
    (course / "handed-in").mkdir()
    (course / "roster.csv").write_text("Name;Student ID\nÄhre, Ada;a1\nBohr;b2\n", "utf-8")
    for command, says in CLOSED_COURSE.items():
        if command.startswith("dhlib grade"):  # the one has solved it, the other hands in what is public
            shutil.copy(course / "quickshot-a1-solution.ipynb", course / "handed-in" / "quickshot-a1.ipynb")
            shutil.copy(course / "week-3" / "quickshot-b2.ipynb", course / "handed-in")
            shutil.copy(course / "solutions" / "quickshot.ipynb", course / "handed-in" / "public.ipynb")
        code, output = run(command, course)
        assert code == (1 if command.startswith("dhlib grade") else 0), output
        assert re.search(says, output), output
    with (course / "week-3-marks" / "grades.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = {Path(row["notebook"]).stem: row for row in csv.DictReader(file)}
    assert {name: (row["status"], row["points"] or "0") for name, row in rows.items()} == {
        "quickshot-a1": ("graded", "30"),
        "quickshot-b2": ("graded", "0"),
        "public": ("unreadable", "0"),
    }
