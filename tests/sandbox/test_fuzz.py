"""Nothing handed in breaks the reader of notebooks, and nothing that comes out of a box the reader of answers."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dhlib.grading.wall.reader import Refused, read_json

#: What a long run led by coverage found, as text of one byte a letter.
FOUND = json.loads((Path(__file__).parent / "found.json").read_text(encoding="utf-8"))
SETTINGS = settings(max_examples=150, derandomize=True, deadline=None, database=None)

TEXT = st.text(max_size=30) | st.sampled_from(
    ["answer", "check", "A1", "q1", "check('A1', A1)", "\ud800", "=1+1", "nan"]
)
SCALAR = st.none() | st.booleans() | st.integers() | st.floats() | TEXT
KEYS = st.sampled_from(
    ["cells", "metadata", "dh", "role", "part", "source", "cell_type", "worksheets", "input", "kernelspec", "exercise"]
) | st.text(max_size=5)
ANYTHING = st.recursive(SCALAR, lambda inner: st.lists(inner, max_size=5) | st.dictionaries(KEYS, inner, max_size=5))
CELL = st.fixed_dictionaries(
    {"cell_type": st.sampled_from(["code", "markdown", 3]), "source": TEXT | st.lists(TEXT | ANYTHING, max_size=4)},
    optional={
        "metadata": ANYTHING | st.fixed_dictionaries({"dh": st.fixed_dictionaries({"role": TEXT, "part": TEXT})})
    },
)
NOTEBOOK = st.fixed_dictionaries({"cells": st.lists(CELL | ANYTHING, max_size=6)}, optional={"metadata": ANYTHING})

PART = st.sampled_from(["A1", "A2", "T_3_0", "table", "slip", "fk", "tool"])
NUMBERS = st.recursive(
    st.floats() | st.integers() | st.none(), lambda inner: st.lists(inner, max_size=4), max_leaves=40
)
READING = st.one_of(
    st.fixed_dictionaries({"values": NUMBERS | st.lists(st.just([[0.0] * 4] * 4), max_size=30)}),
    st.fixed_dictionaries(
        {
            "table": st.dictionaries(
                st.sampled_from(["rows", "columns", "convention", "base", "tool"]), NUMBERS | ANYTHING
            )
        }
    ),
    st.fixed_dictionaries({"choice": SCALAR | ANYTHING}),
    st.fixed_dictionaries(
        {"fault": TEXT | ANYTHING}, optional={"shape": ANYTHING, "names": ANYTHING, "text": ANYTHING}
    ),
    ANYTHING,
)


@pytest.fixture(scope="module")
def targets():
    """The targets of the long run."""
    import importlib.util

    spec = importlib.util.spec_from_file_location("fuzz", Path(__file__).parent / "fuzz.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.targets()


@given(value=NOTEBOOK | ANYTHING, cut=st.integers(0, 400), byte=st.binary(max_size=3))
@SETTINGS
def test_notebooks(targets, value, cut, byte):
    text = json.dumps(value).encode()
    for data in (text, text[:-cut], text[:cut] + byte + text[cut:], byte):
        targets["notebooks"](data)


@given(
    messages=st.lists(st.fixed_dictionaries({"part": PART, "reading": READING}) | ANYTHING, max_size=4),
    cut=st.integers(0, 50),
)
@SETTINGS
def test_answers(targets, messages, cut):
    lines = [json.dumps(message).encode() for message in messages]
    targets["answers"](b"\n".join([*lines, *(line[:-cut] for line in lines)]))


@pytest.mark.parametrize("name", FOUND)
def test_what_a_long_run_found_breaks_nothing(targets, name):
    assert len(FOUND[name]) > 20
    for text in FOUND[name]:
        targets[name](text.encode("latin-1"))


@pytest.mark.parametrize(
    "data",
    [
        b"", b"{", b"NaN", b"-Infinity", b"1e999", b"9" * 41, b"1" + b"0" * 5000, b"[" * 100_000, b'{"a":' * 100_000,
        b"[" * 12 + b"]" * 12, b'"\\ud800"', b"\xff", b'"' + b"x" * 1001 + b'"', b"[" + b"0," * 60_000 + b"0]", b"1e13",
    ],
    ids=lambda data: data[:12].decode("latin-1"),
)  # fmt: skip
def test_what_no_honest_box_sends_is_refused(data):
    with pytest.raises(Refused):
        read_json(data)


def test_an_honest_answer_is_read():
    """Negative control."""
    answer = {"part": "A", "reading": {"values": [[[1.5, -2e9, None]] * 40] * 24}}
    assert read_json(json.dumps(answer).encode()) == answer
