"""Grade the same 30 notebooks with every grader, by turns: ``python compare.py`` in the book's own environment.

What the graders' documentation recommends: `nbgrader autograde`; `otter run` for each notebook without a container, and
its call from Python; `pytest --nbval-lax`; nbclient, which only executes. Ours: `dhlib grade`, with its sandbox.
All must give the marks that were planned.
"""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

import work
from environment import NotToBeHad, python_of, size, version_of

COUNT = size(30, 2)
ROUNDS = size(3, 1)
#: A large class, in which a start does not count; once, since it takes a peer many minutes.
CLASS = size(300, 3)
#: How long a command may take, in seconds; None is for ever.
patience: float | None = None
HUNG = "hung"
#: Student to part to source, and student to part to whether it is marked right.
Class = dict[str, dict[str, str]]
Marks = dict[str, dict[str, bool]]


@dataclass(frozen=True)
class Grader:
    """One way to grade the class.

    Parameters
    ----------
    peer, call : str
    grade : callable
        Grade a class in a folder made for it; return who is right in what, or nothing if it gives no marks.
    sandbox : bool
        Whether what strangers wrote is shut in while it runs.
    """

    peer: str
    call: str
    grade: Callable[[Path, Class], Marks | None]
    sandbox: bool = False


def run(*words: Any, folder: Path, failing: bool = False) -> str:
    """Run a command; a grader that ends with an error has not graded.

    Raises
    ------
    NotToBeHad
        If it ends with an error, or is not ready when patience is at its end.
    """
    process = subprocess.Popen(
        [str(word) for word in words],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=surroundings(Path(words[0])),
        start_new_session=True,
    )
    try:
        said, complained = process.communicate(timeout=patience)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # its kernels too, in so far as they stayed in its group
        process.communicate()
        raise NotToBeHad(HUNG) from None
    if process.returncode != 0 and not failing:
        last = (complained or said).strip().splitlines()[-1:] or [f"ended with {process.returncode}"]
        raise NotToBeHad(f"{Path(words[0]).name}: {last[0][:200]}")
    return said


def surroundings(program: Path) -> dict[str, str]:
    """Return the environment of a grader: its own programs and packages, and nothing of this repository."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return kept | {"PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}", "PYTHONWARNINGS": "ignore"}


def students(count: int) -> dict[str, dict[str, bool]]:
    """Who hands in, and what is right of it."""
    return {f"student{k:0{max(2, len(str(count - 1)))}d}": right for k, right in enumerate(work.plan(count))}


def student_in(text: str) -> str:
    """Return the student whom a line is about."""
    found = re.search(r"student\d\d+", text)
    if found is None:
        raise NotToBeHad(f"names no student in {text[:80]!r}")
    return found[0]


def with_dhlib(folder: Path, hand_ins: Class) -> Marks:
    """`dhlib grade`, with its sandbox."""
    dhlib_class(folder, hand_ins)
    words = ("grade", "handed-in", "--out", "marks", "--exercises", "exercises")
    timed_run(folder, Path(sys.executable).parent / "dhlib", *words)
    return marks_of_dhlib(folder)


def dhlib_class(folder: Path, hand_ins: Class) -> None:
    """Write the class for dhlib, and the exercise."""
    for name, sources in hand_ins.items():
        work.write(folder / "handed-in" / name / "two_links.ipynb", work.for_dhlib(sources))
    shutil.copy(Path(__file__).parent / "two_links.py", ensured(folder / "exercises") / "two_links.py")
    pristine = work.for_dhlib(dict.fromkeys(work.PARTS, "..."))
    for cell in pristine["cells"]:
        if cell["metadata"]["dh"]["role"] == "answer":
            cell["source"] = [f"{cell['metadata']['dh']['part']} = ..."]
    work.write(folder / "exercises" / "two_links.ipynb", pristine)


def marks_of_dhlib(folder: Path) -> Marks:
    """Read the table that `dhlib grade` wrote."""
    marks = {}
    with (folder / "marks" / "grades.csv").open(encoding="utf-8-sig") as file:
        for row in csv.DictReader(file):
            name = student_in(" ".join(map(str, row.values())))
            marks[name] = {part: float(row[part]) == 1 for part in work.PARTS}
    return marks


def with_nbgrader(folder: Path, hand_ins: Class) -> Marks:
    """`nbgrader autograde`, one notebook after another, as it does."""
    home = python_of("nbgrader").parent
    (folder / "nbgrader_config.py").write_text("c = get_config()\nc.CourseDirectory.course_id = 'bench'\n")
    solution = work.answers(dict.fromkeys(work.PARTS, True))
    work.write(folder / "source" / "ps1" / "two_links.ipynb", work.for_nbgrader(solution))
    run(home / "nbgrader", "generate_assignment", "ps1", "--force", folder=folder)
    for name, sources in hand_ins.items():
        work.write(folder / "submitted" / name / "ps1" / "two_links.ipynb", work.for_nbgrader(sources))
    timed_run(folder, home / "nbgrader", "autograde", "ps1", "--force")
    marks: Marks = {}
    program = (
        "from nbgrader.api import Gradebook\nimport json\n"
        "with Gradebook('sqlite:///gradebook.db') as book:\n"
        "    print(json.dumps({s.student.id: {g.name: g.score for n in s.notebooks for g in n.grades}"
        " for s in book.assignment_submissions('ps1')}))"
    )
    for name, scores in json.loads(run(home / "python", "-c", program, folder=folder).splitlines()[-1]).items():
        marks[name] = {part: scores[f"test-{part}"] == 1 for part in work.PARTS}
    return marks


def otter_class(folder: Path, hand_ins: Class) -> Path:
    """Write the class for otter, and make its autograder as `otter assign` would: tests in a zip."""
    import zipfile

    for name, sources in hand_ins.items():
        work.write(folder / "submitted" / f"{name}.ipynb", work.for_otter(sources))
    with zipfile.ZipFile(folder / "autograder.zip", "w") as archive:
        settings = {"assignment_name": "two_links", "lang": "python", "points_possible": 4, "score_threshold": None}
        archive.writestr("otter_config.json", json.dumps(settings))
        for part, (_, _, test) in work.PARTS.items():
            lines = "".join(f">>> {line}\n" for line in test.splitlines())
            case = {"code": lines, "hidden": False, "locked": False}
            suite = {"name": part, "points": 1, "suites": [{"cases": [case], "scored": True, "type": "doctest"}]}
            archive.writestr(f"tests/{part}.py", f"OK_FORMAT = True\n\ntest = {suite!r}\n")
    return folder / "autograder.zip"


def with_otter(folder: Path, hand_ins: Class) -> Marks:
    """`otter run`, which starts a process for every notebook."""
    home = python_of("otter").parent
    otter_class(folder, hand_ins)
    marks: Marks = {}
    for name in hand_ins:
        ensured(folder / name)
        timed_run(
            folder, home / "otter", "run", "--no-logo", "-a", "autograder.zip", "-o", name, f"submitted/{name}.ipynb"
        )
        tests = json.loads((folder / name / "results.json").read_text())["tests"]
        scores = {test["name"].split()[0].removesuffix(".py"): test["score"] for test in tests if "score" in test}
        marks[name] = {part: scores.get(part, 0) == 1 for part in work.PARTS}
    return marks


def with_otter_in_python(folder: Path, hand_ins: Class) -> Marks:
    """`otter.api.grade_submission` in one process."""
    home = python_of("otter").parent
    otter_class(folder, hand_ins)
    program = (
        "import json, otter.api\nfrom pathlib import Path\nmarks = {}\n"
        "for path in sorted(Path('submitted').glob('*.ipynb')):\n"
        "    graded = otter.api.grade_submission(str(path), 'autograder.zip', quiet=True)\n"
        "    marks[path.stem] = {name: result.score for name, result in graded.results.items()}\n"
        "Path('marks.json').write_text(json.dumps(marks))\n"
    )
    timed_run(folder, home / "python", "-c", program)
    marks = json.loads((folder / "marks.json").read_text())
    return {name: {part: scores[part] == 1 for part in work.PARTS} for name, scores in marks.items()}


def nbval(*options: str, one_by_one: bool = False) -> Callable[[Path, Class], Marks]:
    """`pytest --nbval-lax`."""

    def grade(folder: Path, hand_ins: Class) -> Marks:
        home = python_of("nbval").parent
        names = list(hand_ins)
        for name, sources in hand_ins.items():
            work.write(folder / f"{name}.ipynb", work.plain(sources))
        groups = [[name] for name in names] if one_by_one else [names]
        marks: Marks = {}
        cells = [part for name in work.PARTS for part in ("", name)]
        for k, group in enumerate(groups):
            files = [f"{name}.ipynb" for name in group]
            report = f"report{k}.xml"
            timed_run(
                folder, home / "python", "-m", "pytest", "-q", "-p", "no:cacheprovider", "--nbval-lax", *options,
                f"--junitxml={report}", *files, failing=True,
            )  # fmt: skip
            for case in ET.parse(folder / report).getroot().iter("testcase"):
                name = student_in(f"{case.get('classname')} {case.get('name')}")
                cell = int(re.search(r"Cell (\d+)", case.get("name"))[1])
                part = cells[cell - 1] if cell else ""
                if part:
                    marks.setdefault(name, {})[part] = case.find("failure") is None and case.find("error") is None
        return marks

    return grade


def with_nbclient(folder: Path, hand_ins: Class) -> None:
    """nbclient, in one process: it executes and marks nothing."""
    home = python_of("nbval").parent
    for name, sources in hand_ins.items():
        work.write(folder / f"{name}.ipynb", work.plain(sources))
    program = (
        "import nbformat, nbclient\nfrom pathlib import Path\n"
        "for path in sorted(Path('.').glob('*.ipynb')):\n"
        "    book = nbformat.read(path, as_version=4)\n"
        "    nbclient.NotebookClient(book, allow_errors=True, kernel_name='python3').execute()\n"
    )
    timed_run(folder, home / "python", "-c", program)


GRADERS = (
    Grader("dhlib", "dhlib grade FOLDER", with_dhlib, sandbox=True),
    Grader("nbgrader", "nbgrader autograde", with_nbgrader),
    Grader("otter", "otter run, for each", with_otter),
    Grader("otter", "otter.api.grade_submission", with_otter_in_python),
    Grader("nbval", "pytest --nbval-lax, one by one", nbval(one_by_one=True)),
    Grader("nbval", "pytest --nbval-lax, one process", nbval()),
    Grader("nbval", "pytest --nbval-lax -n 2 --dist loadscope", nbval("-n", "2", "--dist", "loadscope")),
    Grader("nbclient", "NotebookClient.execute, no marks", with_nbclient),
)

#: Seconds of the commands that grade, without what prepares the class.
_taken: list[float] = []


def timed_run(folder: Path, *words: Any, failing: bool = False) -> None:
    """Run a command that grades, and count its time."""
    begin = time.perf_counter()
    run(*words, folder=folder, failing=failing)
    _taken.append(time.perf_counter() - begin)


def ensured(folder: Path) -> Path:
    """Return a folder that exists."""
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def timed(grader: Grader, count: int = COUNT) -> float:
    """Grade a class once; check the marks; return the seconds."""
    _taken.clear()
    planned = students(count)
    with tempfile.TemporaryDirectory() as name:
        marks = grader.grade(Path(name), {who: work.answers(right) for who, right in planned.items()})
    if marks is not None and marks != planned:
        wrong = {who: what for who, what in marks.items() if what != planned.get(who)}
        raise NotToBeHad(f"gives other marks than planned, for instance {next(iter(wrong.items()), 'none at all')}")
    return sum(_taken)


def rows() -> Iterator[dict[str, Any]]:
    """Yield what each grader takes, with ours timed beside it every time."""
    ours = GRADERS[0]
    timed(ours)
    for grader in GRADERS[1:]:
        pairs = []
        print(f"  grading: {grader.call}", file=sys.stderr, flush=True)
        try:
            for _ in range(ROUNDS):
                pairs.append((timed(ours), timed(grader)))
        except NotToBeHad as why:
            yield {"peer": grader.peer, "call": grader.call, "why": str(why)}
            continue
        ratio = median(b / a for a, b in pairs)
        print(f"    {ratio:.3g} times as long as ours", file=sys.stderr, flush=True)
        yield {
            "peer": grader.peer,
            "call": grader.call,
            "ours": median(a for a, _ in pairs) / COUNT,
            "each": median(b for _, b in pairs) / COUNT,
            "ratio": ratio,
            "marks": grader.call != GRADERS[-1].call,
        }


def large_class() -> dict[str, Any]:
    """Time a large class, ours before and after the grader that most courses use."""
    ours, grader = GRADERS[:2]
    print(f"  grading: {grader.call}, {CLASS} notebooks", file=sys.stderr, flush=True)
    before, peer, after = timed(ours, CLASS), timed(grader, CLASS), timed(ours, CLASS)
    mine = median((before, after))
    print(f"    {peer / mine:.3g} times as long as ours", file=sys.stderr, flush=True)
    about = {"peer": grader.peer, "call": grader.call, "count": CLASS}
    return about | {"ours": mine / CLASS, "each": peer / CLASS, "ratio": peer / mine}


def main() -> None:
    """Print one JSON object."""
    found = list(rows())
    versions = {}
    for peer, distribution in {"nbgrader": "nbgrader", "otter": "otter-grader", "nbval": "nbval"}.items():
        versions[peer] = version_of(python_of(peer), distribution)
    json.dump(
        {
            "rows": [row for row in found if "why" not in row],
            "missing": {row["call"]: row["why"] for row in found if "why" in row},
            "versions": versions,
            "count": COUNT,
            "large": large_class(),
            "cores": os.cpu_count(),
        },
        sys.stdout,
    )


if __name__ == "__main__":
    main()
