"""Chapters as notebooks: without the book's helper, with all that they need, and true to their own outputs."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from notebooks import plain_sources
from sampling import some

IMPORT = ("from bookkit import glue_number, glue_figure, question", True)


def test_what_feeds_the_text_goes() -> None:
    visible = "x = 1  # kept\n\nglue_number('x', x)\nprint(x)"
    assert plain_sources([IMPORT, (visible, False)]) == ["", "x = 1  # kept\n\nprint(x)"]


def test_a_loop_with_nothing_left_goes_too() -> None:
    code = "rows = [1]\nfor row in rows:\n    glue_number(f'r{row}', row)\nrows.append(2)"
    assert plain_sources([IMPORT, (code, False)])[1] == "rows = [1]\nrows.append(2)"


def test_of_a_hidden_cell_only_that_stays_which_is_needed() -> None:
    figure = "picture = Scene()\npicture.add(1)\nassert picture\nglue_figure('p', picture)\n"
    hidden = figure + "length = 2\ntable = []\nfill(table)"
    plain = plain_sources([IMPORT, (hidden, True), ("print(length, table)", False)])
    assert plain == ["", "length = 2\ntable = []\nfill(table)", "print(length, table)"]


def test_names_of_a_function_are_its_own() -> None:
    later = "def draw(scene):\n    scene.show()\n\nprint(draw)"
    assert plain_sources([("scene = Scene()", True), (later, False)])[0] == ""


def test_a_function_that_uses_the_helper_goes_with_its_calls() -> None:
    hidden = "def show(i):\n    glue_number(f'{i}', i)"
    assert plain_sources([IMPORT, (hidden, True), ("show(1)\nprint(2)", False)]) == ["", "", "print(2)"]


def test_an_answer_that_could_not_run_is_refused() -> None:
    with pytest.raises(ValueError, match="latex"):
        plain_sources([("from bookkit import latex", True), ("print(latex(2))", False)])


@pytest.mark.book
def test_each_chapter_can_be_had_and_needs_nothing_of_the_book(site: Path) -> None:
    notebooks = sorted((site / "notebooks").glob("*.ipynb"))
    assert len(notebooks) >= 5
    for path in notebooks:
        page = (site / "book" / f"{path.stem}.html").read_text("utf-8")
        assert f'href="../notebooks/{path.name}"' in page
        for cell in nbformat.read(path, as_version=4).cells:
            assert "bookkit" not in cell.source
            if cell.cell_type == "markdown":
                assert not leftovers(cell.source), path.name


def leftovers(text: str) -> list[str]:
    """Return what only MyST understands."""
    return re.findall(r"\{[a-z:-]+\}`[^`]*`|^\s*(?:`{3,}|:{3,})\{[^}]*\}.*$|^\([\w-]+\)=$", text, re.MULTILINE)


@pytest.mark.parametrize("text", ["see {ref}`sec-why`", "```{glue:math} A\n```", ":::{note}\n", "(sec-why)=\n"])
def test_a_leftover_would_be_found(text: str) -> None:
    assert leftovers(text)


def validate(folder: Path) -> subprocess.CompletedProcess[str]:
    """Run notebooks as somebody who has them and dhlib, and nothing else of the book."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    words = ["-m", "pytest", "-q", "-n0", "-p", "no:cacheprovider", "--rootdir", str(folder), "--nbval", str(folder)]
    return subprocess.run(
        [sys.executable, *words], cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=False
    )


@pytest.mark.book
@pytest.mark.notebooks
def test_notebooks_prove_their_own_outputs(site: Path, tmp_path: Path) -> None:
    for path in some(sorted((site / "notebooks").glob("*.ipynb")), 7, "notebooks"):
        shutil.copy(path, tmp_path)
    done = validate(tmp_path)
    assert done.returncode == 0, done.stdout


@pytest.mark.notebooks
def test_an_output_that_changed_would_be_found(tmp_path: Path) -> None:
    stored = nbformat.v4.new_output("stream", name="stdout", text="0.4318\n")
    cell = nbformat.v4.new_code_cell("print(0.4319)", outputs=[stored], execution_count=1)
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    nbformat.write(nbformat.v4.new_notebook(cells=[cell], metadata=kernel), tmp_path / "chapter.ipynb")
    assert validate(tmp_path).returncode == 1


def test_what_a_line_adds_to_is_needed() -> None:
    cells = [("short = {}\nfor k in range(3):\n    short |= {k: k}\n", True), ("print(short)", False)]
    assert plain_sources(cells)[0].startswith("short = {}")
