"""Notebooks: read leniently, and put into the pristine exercise."""

import json
import os

import pytest

from dhlib.errors import DHError
from dhlib.grading.notebook import Cell, damage, load_notebook, merge, parse_notebook, read_cells, recover_roles

SETUP = Cell("import math", role="setup")
PRISTINE = [
    SETUP,
    Cell("read me", code=False, role="text"),
    Cell("A = ...", role="answer", part="A"),
    Cell('check("A", A)', role="check", part="A"),
    Cell("B = ...", role="answer", part="B"),
    Cell('check("B", B)', role="check", part="B"),
]
A, B = Cell("A = 1", role="answer", part="A"), Cell("B = 2", role="answer", part="B")
CHECK_A, CHECK_B = PRISTINE[3], PRISTINE[5]


def sources(submission):
    return [cell.source for cell in merge(PRISTINE, submission)]


def test_answers_replace_the_stubs():
    assert sources([SETUP, A, CHECK_A, B, CHECK_B]) == [
        "import math",
        "A = 1",
        'check("A", A)',
        "B = 2",
        'check("B", B)',
    ]


def test_changed_and_deleted_cells_of_the_exercise_count_for_nothing():
    forged = Cell('print("A: right.")', role="check", part="A")
    patched = Cell("check = print", role="setup")
    assert sources([patched, A, forged, B]) == sources([SETUP, A, CHECK_A, B, CHECK_B])
    assert sources([]) == [cell.source for cell in PRISTINE if cell.code]


def test_extra_cells_keep_their_place():
    x, y, z = (Cell(f"{name} = 0") for name in "xyz")
    assert sources([x, SETUP, A, CHECK_A, y, B, CHECK_B, z]) == [
        "import math", "x = 0", "A = 1", 'check("A", A)', "y = 0", "B = 2", 'check("B", B)', "z = 0",
    ]  # fmt: skip


def test_a_cell_that_was_split_is_put_together():
    assert sources([SETUP, Cell("a = 1", role="answer", part="A"), Cell("A = a", role="answer", part="A")])[1:3] == [
        "a = 1",
        "A = a",
    ]


def test_an_answer_to_no_part_is_an_extra_of_nothing():
    assert "C = 1" not in sources([SETUP, Cell("C = 1", role="answer", part="C")])


def test_roles_that_were_lost_are_found_again():
    bare = [Cell(cell.source) for cell in (SETUP, A, CHECK_A, Cell("b = 2"), Cell("def B():\n    pass"), CHECK_B)]
    merged = sources(bare)
    assert merged.count('check("A", A)') == merged.count('check("B", B)') == 1
    assert "A = 1" in merged
    assert "A = ..." not in merged
    assert "def B():\n    pass" in merged


def test_a_cell_that_answers_and_checks_at_once_is_the_answer():
    both = Cell('A = 1\ncheck("A", A)')
    assert recover_roles([both]) == [Cell(both.source, True, "answer", "A")]
    assert sources([both])[1:3] == [both.source, 'check("A", A)']


def write(path, content):
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "is empty"),
        ("%PDF-1.7", "is no notebook but a PDF"),
        ("<!DOCTYPE html>", "no notebook but a web page"),
        ("print('hello')", "cannot be read as JSON"),
        ('{"cells": [{"source": "x"', "cut off"),
        ("[" * 100_000, "is no notebook"),
        ("[]", "holds no cells"),
        ('{"cells": 3}', "holds no cells"),
        ('{"nbformat": 4}', "holds no cells"),
    ],
)
def test_what_is_no_notebook_is_said(tmp_path, content, words):
    with pytest.raises(DHError, match=words):
        load_notebook(write(tmp_path / "x.ipynb", content))


def test_bytes_that_are_no_text(tmp_path):
    for data, words in (
        (b"PK\x03\x04\xff\xfe", "a zip archive"),
        (b"\x7fELF\0\0", "not text"),
        (b"\xff\xd8\xff", "image"),
    ):
        (tmp_path / "x.ipynb").write_bytes(data)
        with pytest.raises(DHError, match=f"no notebook.*{words}"):
            load_notebook(tmp_path / "x.ipynb")
    with pytest.raises(DHError, match="cannot be opened"):
        load_notebook(tmp_path / "y.ipynb")


def test_damaged_cells_are_read_as_far_as_they_go(tmp_path):
    cells = [
        3, None, {}, {"cell_type": "code"},
        {"cell_type": "code", "source": ["a", 1, "b"], "metadata": {"dh": "x"}},
        {"cell_type": "code", "source": "c", "metadata": {"dh": {"role": 3, "part": "A"}}},
    ]  # fmt: skip
    read = read_cells(load_notebook(write(tmp_path / "x.ipynb", {"cells": cells, "nbformat": 4})))
    assert [cell.source for cell in read] == ["", "", "", "", "ab", "c"]
    assert not any(cell.role for cell in read)


def test_old_notebooks_are_read(tmp_path):
    old = {"nbformat": 3, "worksheets": [{"cells": [{"cell_type": "code", "input": ["A = 1"], "language": "python"}]}]}
    assert read_cells(load_notebook(write(tmp_path / "x.ipynb", old)))[0].source == "A = 1"


GOOD = {
    "cells": [{"cell_type": "code", "source": "A = 1", "metadata": {}, "outputs": []}],
    "nbformat": 4,
    "metadata": {},
}
TEXT = json.dumps(GOOD)


def cut(text):
    second = '{"cell_type": "code", "source": "B ='
    return text.replace('"outputs": []}]', f'"outputs": []}}, {second}').partition(second)[0] + second


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (cut(TEXT).encode(), "first 1 cells"),
        (TEXT.replace('"nbformat": 4', '"nbformat": ' + "[" * 100_000).encode(), "first 1 cells"),
        (TEXT.replace('"nbformat": 4', '"nbformat": 4, "nbformat_minor": 99').encode(), ""),
        (TEXT.replace('"nbformat": 4', f'"nbformat": {"9" * 10_000}').encode(), ""),
        (TEXT.replace('"outputs": []', f'"outputs": ["{"x" * 20_000_000}"]').encode(), ""),
        (TEXT.replace('"outputs": []', '"outputs": ["\\ud800"]').encode(), ""),
        (TEXT.replace('"outputs": []', '"outputs": ["\xe9"]').encode("latin-1"), ""),
        (TEXT.encode("utf-16"), ""),
        (b"\xef\xbb\xbf" + TEXT.encode(), ""),
        (TEXT.replace('"metadata": {}}', '"metadata": {"kernelspec": {"language": "R"}}}').encode(), "written in R"),
        (TEXT.replace('"metadata": {}}', '"dh_damage": "forged", "metadata": {}}').encode(), ""),
        (TEXT.replace('"metadata": {}, ', "").encode(), ""),
        (TEXT.replace('"cells": [', '"cells": [{"id": "a"}, {"id": "a"}, ').encode(), ""),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_can_be_read_is_read(data, words):
    notebook = parse_notebook(data, "x.ipynb")
    assert "A = 1" in [cell.source for cell in read_cells(notebook)]
    assert words in damage(notebook)
    assert bool(words) == bool(damage(notebook))


def test_a_source_that_is_no_text_can_be_written_all_the_same():
    notebook = parse_notebook(TEXT.replace("A = 1", "A = '\\ud800'").encode(), "x.ipynb")
    assert read_cells(notebook)[0].source.encode() == b"A = '?'"


def test_more_than_a_notebook_is_refused(tmp_path):
    many = {"cells": [{"cell_type": "code", "source": "x"}] * 2001}
    with pytest.raises(DHError, match="more than 2000 cells"):
        parse_notebook(json.dumps(many).encode(), "x.ipynb")
    with pytest.raises(DHError, match="more than 2000 cells"):
        parse_notebook(json.dumps({"cells": many["cells"] * 2}).encode()[:-20], "x.ipynb")  # cut off after that
    with pytest.raises(DHError, match="larger than 50 MB"):
        parse_notebook(b" " * 50_000_001, "x.ipynb")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_what_is_no_file_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.ipynb")
    with pytest.raises(DHError, match="is no file"):
        load_notebook(tmp_path / "pipe.ipynb")
    with pytest.raises(DHError, match=r"cannot be opened|is no file"):
        load_notebook(tmp_path)
    with pytest.raises(DHError, match="is no file"):
        load_notebook("/dev/zero")


def test_roles_are_found_again_in_time_that_grows_with_the_notebook():
    """A line that begins with a thousand blank lines was looked at once for each of them."""
    recover_roles([Cell("\n" * 200_000 + "x"), Cell(" " * 200_000 + "check"), CHECK_A])
