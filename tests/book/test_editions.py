"""The edition for courses: no trace of a solution and no reference, in any file of the site."""

from __future__ import annotations

import copy
import html
import io
import json
import os
import re
import subprocess
import sys
import zipfile
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from building import build_book
from course import stage, without_solutions
from site_listing import files_of, listed, unexpected

from dhlib.grading.derive import as_text, derive
from dhlib.grading.exercise import Exercise, load_exercise
from dhlib.grading.forms import Choice, Numbers, ReasonedChoice

pytestmark = pytest.mark.book

MARKER = "MARKER-7f3a"
SHOWN = sorted(path.stem for path in Path(__file__).parents[2].glob("solutions/*.ipynb"))
#: Chapters explain: what is right stands there, too.
ELSEWHERE = re.compile(r"book/|notebooks/\w+\.ipynb|run/(pyodide|numpy|sympy|mpmath|mathjax)")
#: With its chapters the edition takes minutes.
WHOLE = bool(os.environ.get("DHBOOK_FULL"))


def planted(solution: dict[str, Any]) -> dict[str, Any]:
    """A worked notebook with a marker wherever a solution could hide."""
    notebook = copy.deepcopy(solution)
    notebook["metadata"] |= {MARKER: MARKER, "title": MARKER, "authors": [{"name": MARKER}]}
    for cell in notebook["cells"]:
        about = cell["metadata"]["dh"]
        cell["metadata"] |= {MARKER: MARKER, "tags": [MARKER], "slideshow": {"notes": MARKER}}
        about["note"] = MARKER
        if cell["cell_type"] == "markdown":
            cell["attachments"] = {f"{MARKER}.png": {"image/png": MARKER}}
        else:
            cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": [MARKER]}]
            source = "".join(cell["source"])
            cell["source"] = source.replace(
                "### solution\n", f"### solution\n# {MARKER}\nx_{MARKER[-4:]} = '{MARKER}'\n"
            )
        if about["role"] == "solution":
            cell["source"] = [MARKER]
    return notebook


@pytest.fixture(scope="session")
def site_of_course(root: Path, built_once: Callable[..., Path]) -> Path:
    """The edition of all exercises, from sources with markers in every solution and every reference.

    Its chapters are among them with ``FULL=1`` only.
    """

    def build(into: Path) -> subprocess.CompletedProcess[str]:
        sources = into / "sources"
        for folder in ("exercises", "solutions"):
            (sources / folder).mkdir(parents=True)
        for entry in root.iterdir():
            if entry.name not in ("exercises", "solutions", "_build", "dist"):
                (sources / entry.name).symlink_to(entry)
        for name in SHOWN:
            worked = planted(json.loads((root / "solutions" / f"{name}.ipynb").read_text("utf-8")))
            (sources / "solutions" / f"{name}.ipynb").write_text(as_text(worked), "utf-8")
            (sources / "exercises" / f"{name}.ipynb").write_text(as_text(derive(worked, name)), "utf-8")
            told = (root / "exercises" / f"{name}.py").read_text("utf-8")
            (sources / "exercises" / f"{name}.py").write_text(f"{told}\nNOTE = '{MARKER}'\n", "utf-8")
        staged = stage(sources, into / "source")
        if not WHOLE:
            first, *others = (f"exercises/{name}" for name in SHOWN)
            contents = {"format": "jb-book", "root": first, "chapters": [{"file": other} for other in others]}
            (staged / "_toc.yml").write_text(yaml.safe_dump(contents), "utf-8")
        return build_book(staged, into, environment={"PYTHONPATH": str(staged)})

    return built_once("course", build)


def contents_of(path: Path, name: str = "") -> Iterator[tuple[str, bytes]]:
    """The content of a file, unpacked."""
    data = path.read_bytes()
    yield name or path.name, data
    if zipfile.is_zipfile(io.BytesIO(data)):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            for member in archive.namelist():
                yield f"{path.name}:{member}", archive.read(member)
    if path.name == "objects.inv":
        yield f"{path.name}:unpacked", zlib.decompress(data.split(b"zlib.\n", 1)[1])


def traces(site: Path, mark: str = MARKER) -> list[str]:
    """The files of a folder that hold a mark, or have it in their name."""
    word = mark.encode()
    return sorted(
        {
            name
            for path in site.rglob("*")
            if path.is_file()
            for name, data in contents_of(path, path.relative_to(site).as_posix())
            if word in data or mark in name
        }
    )


def test_no_marker_is_in_any_file_of_the_site(site_of_course: Path) -> None:
    assert traces(site_of_course) == []
    assert (site_of_course / "exercises" / "quickshot.html").is_file()


def test_a_marker_would_be_found_anywhere(site_of_course: Path, tmp_path: Path) -> None:
    """Negative control: the sources that were staged from hold it everywhere; and so would the site."""
    sources = site_of_course.parents[1] / "sources"
    for name in SHOWN:
        assert f"solutions/{name}.ipynb" in traces(sources)
        assert f"exercises/{name}.py" in traces(sources)
        assert f"exercises/{name}.ipynb" not in traces(sources)
    with zipfile.ZipFile(tmp_path / "x.whl", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.py", f"# {MARKER}" + " " * 1000)
    assert traces(tmp_path) == ["x.whl:a.py"]


def beyond_a_course(files: set[str], sources: Path) -> set[str]:
    """The files of an edition for courses that nothing accounts for, or that say which answers are right."""
    told = {name for name in files if re.search(r"(^|/)solutions/|^run/exercises/(?!\w+\.ipynb$)", name)}
    return unexpected(files, listed(sources)) | told


def test_only_what_a_course_may_see_is_published(site_of_course: Path) -> None:
    sources = site_of_course.parents[1] / "source"
    files = files_of(site_of_course)
    assert beyond_a_course(files, sources) == set()
    for name in SHOWN:
        assert {f"exercises/{name}.html", f"notebooks/exercises/{name}.ipynb", f"run/exercises/{name}.ipynb"} <= files
    assert [page for page in listed(sources) if page.startswith("solutions/")] == []


@pytest.mark.parametrize(
    "stray",
    [
        "solutions/quickshot.html",
        "notebooks/solutions/quickshot.ipynb",
        "run/exercises/quickshot.py",
        "run/exercises/solutions/quickshot.ipynb",
        "exercises/quickshot.py",
        "_sources/exercises/quickshot.ipynb",
        "library/exercises.zip",
    ],
)
def test_what_a_course_may_not_see_would_be_found(site_of_course: Path, stray: str) -> None:
    sources = site_of_course.parents[1] / "source"
    assert beyond_a_course({*files_of(site_of_course), stray}, sources) == {stray}


@pytest.fixture(scope="module")
def told(site_of_course: Path) -> str:
    """What the files of the site say, but for chapters and what others have written."""
    return b"\n".join(
        data
        for path in site_of_course.rglob("*")
        if path.is_file()
        and path.suffix in {".html", ".js", ".json", ".ipynb", ".whl", ".zip"}
        and not ELSEWHERE.match(path.relative_to(site_of_course).as_posix())
        for _, data in contents_of(path)
    ).decode("utf-8", "replace")


def words(exercise: Exercise, file: Path) -> set[str]:
    """What the file of an exercise says of answers, right and wrong, and no page should say of itself."""
    said = {trap.says for part in exercise.parts for trap in part.traps}
    for part in exercise.parts:
        if isinstance(part.asks, Choice):
            said |= set(part.asks.options.values())
        if isinstance(part.asks, ReasonedChoice):
            said |= {reason.says for reason in part.asks.reasons.values()}
    written = re.sub(r'"\s*\n\s*f?"', "", file.read_text("utf-8"))  # the others are dhlib's words on misconceptions
    return {sentence for sentence in said if len(sentence) > 30 and sentence in written}


def answers(exercise: Exercise, notebook: Path) -> set[str]:
    """The numbers of right answers that are like no others, as a page would print them, and not given to start from."""
    cells = json.loads(notebook.read_text("utf-8"))["cells"]
    given = "\n".join("".join(cell["source"]) for cell in cells if cell["metadata"]["dh"]["role"] == "given")
    values = [
        f"{abs(value):.4f}"
        for part in exercise.parts
        if isinstance(part.asks, Numbers)
        for value in part.asks.values(part.chain).ravel()
    ]
    unlike = {value for value in values if re.fullmatch(r"\d+\.\d\d[1-9]\d", value) and len(set(value)) > 4}
    return {value for value in unlike if value not in given}


@pytest.mark.parametrize("name", SHOWN)
def test_no_reference_is_in_any_file_of_the_site(site_of_course: Path, told: str, root: Path, name: str) -> None:
    """What says which answers are right: the files of the exercises, their sentences, and the right numbers."""
    assert [path for path in site_of_course.rglob(f"{name}.py") if path.parent.name != "dhlib"] == []
    exercise = load_exercise(name, root / "exercises")
    forms = (str, lambda text: json.dumps(text)[1:-1], html.escape)
    said = words(exercise, root / "exercises" / f"{name}.py")
    assert said
    assert [sentence for sentence in said if any(form(sentence) in told for form in forms)] == []
    pages = [
        site_of_course / file
        for file in (f"exercises/{name}.html", f"notebooks/exercises/{name}.ipynb", f"run/exercises/{name}.ipynb")
    ]
    shown = "\n".join(page.read_text("utf-8") for page in pages)
    numbers = answers(exercise, root / "exercises" / f"{name}.ipynb")
    assert [value for value in numbers if value in shown] == []


def test_right_numbers_would_be_found(root: Path) -> None:
    """Negative control: most exercises have answers that no page could print by accident."""
    folder = root / "exercises"
    found = {name: answers(load_exercise(name, folder), folder / f"{name}.ipynb") for name in SHOWN}
    assert sum(len(values) > 8 for values in found.values()) >= 8
    assert "0.3333" not in set().union(*found.values())
    assert sum(len(words(load_exercise(name, folder), folder / f"{name}.py")) for name in SHOWN) > 200


def test_the_wheel_of_a_course_holds_the_library_and_no_exercise(site_of_course: Path) -> None:
    (wheel,) = (site_of_course / "library").iterdir()
    names = set(zipfile.ZipFile(wheel).namelist())
    assert {"dhlib/__init__.py", "dhlib/grading/check.py", "dhlib/grading/formal.py", "pytest_dhlib.py"} <= names
    assert {name for name in names if "exercises" in name} <= {
        name for name in names if name.startswith("dhlib/_exercises/") and name.endswith(".ipynb")
    }


def test_the_wheel_of_a_course_checks_the_form(site_of_course: Path, tmp_path: Path) -> None:
    """The notebook that a page offers runs with the wheel beside it, and nothing else of the book."""
    (wheel,) = (site_of_course / "library").iterdir()
    zipfile.ZipFile(wheel).extractall(tmp_path)
    notebook = json.loads((site_of_course / "notebooks" / "exercises" / "quickshot.ipynb").read_text("utf-8"))
    setup = next("".join(c["source"]) for c in notebook["cells"] if c["metadata"]["dh"]["role"] == "setup")
    code = f'{setup}\ntry:\n    check("A1", 3)\nexcept Exception as error:\n    print(error)\ncheck("A1", np.eye(4))\n'
    code += 'import dhlib\nprint(dhlib.__file__)\nfrom dhlib.grading import checker\nchecker("quickshot")\n'
    done = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert "A1: cannot be read. A1 has only one number" in done.stdout, done.stderr
    assert "A1: the form is right, a matrix" in done.stdout
    assert str(tmp_path / "dhlib") in done.stdout
    assert "there is no exercise 'quickshot'" in done.stderr


def test_each_page_says_how_to_take_it_along(site_of_course: Path) -> None:
    for name in SHOWN:
        page = (site_of_course / "exercises" / f"{name}.html").read_text("utf-8")
        for target in re.findall(r'<a href="\.\./([^"]+)" download>', page):
            assert (site_of_course / target).is_file()
        assert page.count(" download>the ") == 2
        text = re.sub(r"<(script|head|style)\b.*?</\1>|<[^>]*>", "", page, flags=re.DOTALL)
        assert "python -m pip install" in text
        assert "form of your answer" in text
        assert "solution" not in text.lower()
        assert page.count('<figure class="align-default"><svg') == 1


def test_the_contents_of_a_course_are_those_of_the_book_without_solutions(root: Path) -> None:
    contents = yaml.safe_load((root / "_toc.yml").read_text("utf-8"))
    parts = {part["caption"]: part["chapters"] for part in contents["parts"]}
    left = {part["caption"]: part["chapters"] for part in without_solutions(contents)["parts"]}
    assert [entry["file"].split("/")[1] for entry in parts.pop("Solutions")] == [
        entry["file"].split("/")[1] for entry in parts["Exercises"] if entry["file"].startswith("exercises/")
    ]
    assert left == parts
