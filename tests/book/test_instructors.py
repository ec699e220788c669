"""The page for instructors: each of its commands runs, and does what the page says."""

from __future__ import annotations

import csv
import os
import re
import shlex
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
#: What follows once a class is graded: each is run on results of its own.
AFTERWARDS = {
    "dhlib report marks --book https://example.org/dh": Outcome(0, r"marks/class\.html"),
    "dhlib export marks --format moodle": Outcome(0, r"marks/exports/moodle-feedback\.zip"),
    "dhlib export marks --format canvas": Outcome(0, r"marks/exports/canvas-comments\.zip"),
    "dhlib export marks --format moodle --worksheet worksheet.csv": Outcome(0, r"marks/exports/moodle-grades\.csv"),
    "dhlib export --format gradescope-autograder --exercise quickshot --out elsewhere": Outcome(
        0, r"elsewhere/gradescope-autograder\.zip"
    ),
    "dhlib export --format github-classroom --exercise quickshot --out elsewhere": Outcome(0, r"elsewhere"),
    'dhlib adjust marks --student "Ada Lovelace" --part A1 --points 0.5 --reason "Right, but for a slip of ours."': (
        Outcome(0, r"A1 has 0\.5 points")
    ),
    'dhlib adjust marks --student "Ada Lovelace" --bonus 1 --reason "Found an erratum."': Outcome(0, r"\+1 points"),
    "dhlib adjust marks --list": Outcome(0, r"adjustment 1 "),
    "dhlib adjust marks --revoke 1": Outcome(0, r"holds no longer"),
    "dhlib report marks --audit": Outcome(0, r"adjusted  .*Seen in class"),
    'dhlib adjust marks --due "2030-01-31 23:59" --late "10%/day, max 50%" --grace 15min': Outcome(0, r"10 % of all"),
    'dhlib adjust marks --student "Ada Lovelace" --due "2030-02-07 23:59" --reason "Was ill."': Outcome(0, r"due 2030"),
    "dhlib report marks --pseudonyms": Outcome(0, r"marks/grades\.csv"),
    'dhlib forget marks "Ada Lovelace" --yes': Outcome(0, r"Removed: 1 submission"),
}
GRADED_FROM_MOODLE = {"dhlib grade moodle.zip --exercise quickshot --out marks": Outcome(0, r"marks/grades\.csv")}
SEEN = '--student "Ada Lovelace" --part slip --points 1 --reason "Seen in class."'
EVERY = COMMANDS.keys() | CLOSED_COURSE.keys() | GRADED_FROM_MOODLE.keys() | AFTERWARDS.keys()
#: What Moodle and Canvas call what they give: Moodle a folder, Canvas a file.
FROM_MOODLE = "Ada Lovelace_4711_assignsubmission_file_/quickshot.ipynb"
FROM_CANVAS = "boolegeorge_77_901_quickshot.ipynb"
WORKSHEET = """\
Identifier,Full name,Status,Grade,Maximum Grade,Last modified (grade),Feedback comments
Participant 4711,Ada Lovelace,Submitted for grading,,100,-,
"""


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
    blocks = re.findall(r"^ *```sh\n(.*?)^ *```", text, re.DOTALL | re.MULTILINE)
    return {line.strip() for block in blocks for line in block.splitlines() if line.strip()}


def run(command: str, folder: Path) -> tuple[int, str]:
    tools = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    inherited = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST", "COV_"))}
    done = subprocess.run(
        shlex.split(command), cwd=folder, env={**inherited, "PATH": tools}, capture_output=True, text=True, timeout=300
    )
    return done.returncode, done.stdout + done.stderr


def test_every_command_of_the_page_is_tested(page: str) -> None:
    assert commands_of(page) == EVERY | TESTED_ELSEWHERE


def test_an_untested_command_would_be_found(page: str) -> None:
    assert commands_of(page + "\n```sh\ndhlib conjure\n```\n") - EVERY == {"dhlib conjure", *TESTED_ELSEWHERE}


@pytest.mark.notebooks
@pytest.mark.parametrize("command", COMMANDS)
def test_the_command_does_what_the_page_says(command: str, course: Path) -> None:
    code, output = run(command, course)
    assert code == COMMANDS[command].code, output
    assert re.search(COMMANDS[command].says, output), output


@pytest.fixture(scope="session")
def graded_once(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a download from Moodle, graded, and something decided by hand."""
    folder = tmp_path_factory.mktemp("graded")
    shutil.copytree(root / "exercises", folder / "exercises", ignore=shutil.ignore_patterns("__pycache__"))
    with zipfile.ZipFile(folder / "moodle.zip", "w") as archive:
        archive.write(root / "solutions" / "quickshot.ipynb", FROM_MOODLE)
    (folder / "canvas").mkdir()
    shutil.copy(root / "exercises" / "quickshot.ipynb", folder / "canvas" / FROM_CANVAS)
    (folder / "worksheet.csv").write_text(WORKSHEET, "utf-8")
    for command in ("dhlib grade moodle.zip canvas --out marks", f"dhlib adjust marks {SEEN}"):
        code, output = run(command, folder)
        assert code == 0, output
    return folder


@pytest.fixture
def graded(graded_once: Path, tmp_path: Path) -> Path:
    """A copy of that folder, to be changed."""
    return Path(shutil.copytree(graded_once, tmp_path / "copy"))


@pytest.mark.notebooks
@pytest.mark.parametrize("command", AFTERWARDS)
def test_what_follows_does_what_the_page_says(command: str, graded: Path) -> None:
    code, output = run(command, graded)
    assert code == AFTERWARDS[command].code, output
    assert re.search(AFTERWARDS[command].says, output), output


@pytest.mark.notebooks
def test_from_adopting_to_the_gradebook(page: str, graded: Path) -> None:
    walk = page[page.index("(sec-instructors-walk)=") :]
    walk = walk[: walk.index("\n(sec-", 1)]
    shutil.rmtree(graded / "marks")
    commands = re.findall(r"^ +(dhlib .*)$", walk, re.MULTILINE)
    assert len(commands) == 3
    for command in commands:
        code, output = run(command, graded)
        assert code == 0, output
    with (graded / "marks/exports/moodle-grades.csv").open(encoding="utf-8", newline="") as file:
        (row,) = csv.DictReader(file)
    assert (row["Identifier"], row["Full name"], row["Grade"]) == ("Participant 4711", "Ada Lovelace", "30")
    with zipfile.ZipFile(graded / "marks/exports/moodle-feedback.zip") as archive:
        (name,) = archive.namelist()
        assert name.startswith(FROM_MOODLE.split("/")[0] + "/")
        assert "https://example.org/dh" not in archive.read(name).decode()  # all is right: nothing to read up
        assert "30 of 30 points" in archive.read(name).decode()


def test_every_format_of_the_page_exists(page: str, course: Path) -> None:
    _, usage = run("dhlib export --help", course)
    formats = set(re.findall(r"^\| `([a-z]+)` \|", page, re.MULTILINE)) | set(re.findall(r"--format ([\w-]+)", page))
    assert formats == set(re.findall(r"^  ([a-z]+(?:-[a-z]+)?)  +\w", usage.split("positional")[0], re.MULTILINE))


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
