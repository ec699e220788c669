"""Reading answers: every right form is read, everything else becomes a fault, and nothing raises."""

import json
import math
import re
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from dhlib import robots
from dhlib.grading import answers
from dhlib.grading.answers import MISSING, read_answer
from dhlib.grading.faults import SENTENCES, sentence

pytestmark = pytest.mark.filterwarnings("ignore:the matrix subclass:PendingDeprecationWarning")
MATRIX = {"form": "numbers", "shape": [2, 2]}
VECTOR = {"form": "numbers", "shape": [3]}
NUMBER = {"form": "numbers", "shape": []}
FORMULA = {"form": "formula", "shape": [], "symbols": ["theta1", "theta2"], "points": [[0.5, 0.25], [1.0, -2.0]]}
FUNCTION = {"form": "function", "shape": [], "calls": [[1, [0.5, 1.5]], [2, [0.5, 1.5]]]}
CHOICE = {"form": "choice", "options": ["x", "y"]}
TABLE = {"form": "table", "convention": "classic"}
REQUESTS = [MATRIX, VECTOR, NUMBER, FORMULA, FUNCTION, CHOICE, TABLE, {"form": "frames", "shape": [2, 4, 4]}]
t1, t2 = sp.symbols("theta1 theta2")


@pytest.mark.parametrize(
    "value",
    [
        [[1, 2], [3, 4]],
        ((1, 2), (3, 4)),
        np.array([[1, 2], [3, 4]]),
        np.array([[1, 2], [3, 4]], dtype=object),
        np.matrix([[1, 2], [3, 4]]),
        [np.array([1, 2]), np.array([3.0, 4.0])],
        sp.Matrix([[1, 2], [3, 4]]),
        sp.ImmutableMatrix([[1, 2], [3, sp.sqrt(16)]]),
        sp.Matrix([[sp.sin(sp.pi / 2), 2], [sp.Rational(6, 2), sp.pi * 4 / sp.pi]]),
        pd.DataFrame([[1, 2], [3, 4]]),
        [[Fraction(1), Decimal(2)], [np.float32(3), 4 + 0j]],
    ],
    ids=str,
)
def test_every_dress_of_a_matrix(value):
    assert read_answer(MATRIX, value) == {"values": [[[1.0, 2.0], [3.0, 4.0]]]}


@pytest.mark.parametrize(
    "value", [[1, 2, 3], [[1, 2, 3]], [[1], [2], [3]], sp.Matrix([1, 2, 3]), pd.Series([1, 2, 3])], ids=str
)
def test_rows_and_columns_are_vectors(value):
    assert read_answer(VECTOR, value) == {"values": [[1.0, 2.0, 3.0]]}


@pytest.mark.parametrize("value", [2, 2.0, [2], np.array(2), np.array([[2]]), sp.Integer(2), np.int64(2)], ids=str)
def test_one_number(value):
    assert read_answer(NUMBER, value) == {"values": [2.0]}


@pytest.mark.parametrize(
    ("request_", "value", "fault"),
    [
        (MATRIX, MISSING, "undefined"),
        (MATRIX, ..., "missing"),
        (MATRIX, None, "missing"),
        (MATRIX, [[1, 2], [3, ...]], "missing"),
        (MATRIX, "[[1, 2], [3, 4]]", "text"),
        (MATRIX, [["1", 2], [3, 4]], "text"),
        (MATRIX, [[1, 2], [3, float("nan")]], "nan"),
        (MATRIX, np.full((2, 2), np.inf), "nan"),
        (MATRIX, np.eye(3), "shape"),
        (MATRIX, 5, "shape"),
        (MATRIX, [], "shape"),
        (MATRIX, np.zeros((1000, 1000)), "shape"),
        (MATRIX, [[0] * 1000] * 1000, "size"),
        (MATRIX, [[[[[[1]]]]]], "size"),
        (MATRIX, [[1, 2], [3]], "ragged"),
        (MATRIX, [[1, 2], [3, 1j]], "complex"),
        (MATRIX, [[1, 2], [3, sp.I]], "complex"),
        (MATRIX, [[True, 2], [3, 4]], "bool"),
        (MATRIX, [[1, 2], [3, 1e30]], "large"),
        (MATRIX, [[1, 2], [3, 10**400]], "large"),
        (MATRIX, sp.Matrix([[1, 2], [3, t1]]), "symbols"),
        (MATRIX, lambda: 1, "function"),
        (MATRIX, {1, 2}, "kind"),
        (MATRIX, object(), "kind"),
        (MATRIX, [[1, 2], [3, object()]], "kind"),
        (FORMULA, sp.Symbol("r"), "unknown_symbols"),
        (FORMULA, "cos(theta1)", "text"),
        (FORMULA, sp.Function("f")(t1), "no_value"),
        (FORMULA, sp.I * t1, "complex"),
        (FORMULA, t1 + sp.nan, "nan"),
        (FORMULA, lambda q: q, "function"),
        (FORMULA, sp.Add(*((t1 + k) ** 2 for k in range(8_000))), "long"),
        (FUNCTION, 3, "no_function"),
        (FUNCTION, lambda i, q: None, "returns_nothing"),
        (FUNCTION, lambda i, q: ..., "missing"),
        (FUNCTION, lambda q: 1, "raised"),
        (FUNCTION, lambda i, q: [1, 2], "shape"),
        (CHOICE, 2.5, "no_choice"),
        (TABLE, 3, "no_table"),
        (TABLE, "q1 0 0 0", "text"),
        (TABLE, [[..., 0, 0, 0]], "missing"),
        (TABLE, [[float("nan"), 0, 0, 0]], "nan"),
        (TABLE, {"theta": [0, 1], "d": [0]}, "ragged"),
        (TABLE, {"theta": 0, "d": 1}, "ragged"),
        (TABLE, {"theta": [0], "d": 1}, "ragged"),
        (TABLE, [[0, 0, 0, 0]] * 1000, "size"),
        (TABLE, [[0] * 1000], "size"),
    ],
)  # fmt: skip
def test_what_is_no_answer_has_a_fault_and_a_sentence(request_, value, fault):
    reading = read_answer(request_, value)
    assert reading["fault"] == fault
    assert json.loads(json.dumps(reading, allow_nan=False)) == reading
    words = sentence(reading, "A1", "a matrix", "x, y")
    assert "{" not in words
    assert words.endswith((".", "?"))


def test_every_fault_that_can_be_made_has_words():
    source = Path(answers.__file__).read_text(encoding="utf-8")
    made = set(re.findall(r'_Fault\("(\w+)"', source)) | set(re.findall(r'"fault": "(\w+)"', source))
    assert made <= set(SENTENCES)
    assert made


@pytest.mark.parametrize(
    "value",
    [
        sp.cos(t1 + t2),
        sp.cos(t1) * sp.cos(t2) - sp.sin(t1) * sp.sin(t2),
        ((sp.exp(sp.I * (t1 + t2)) + sp.exp(-sp.I * (t1 + t2))) / 2),
        sp.cos(t1 + t2).rewrite(sp.tan),
        sp.cos(sp.Symbol("theta1", real=True) + sp.Symbol("q2")),
        sp.cos(sp.Symbol("θ1") + sp.Symbol("theta_2")),
        sp.Symbol("C12"),
        sp.Symbol("c1") * sp.Symbol("c2") - sp.Symbol("S1") * sp.Symbol("s2"),
        np.array(sp.cos(t1 + t2), dtype=object),
        [sp.cos(t1 + t2)],
        sp.Piecewise((sp.cos(t1 + t2), t1 > -100), (0, True)),
    ],
    ids=str,
)
def test_a_formula_counts_by_its_values(value):
    (first, second) = read_answer(FORMULA, value)["values"]
    assert (first, second) == pytest.approx((np.cos(0.75), np.cos(-1.0)), abs=1e-9)


def test_where_a_formula_has_no_value_there_is_none():
    assert read_answer(FORMULA, 1 / (t1 - 0.5)) == {"values": [None, 2.0]}
    assert read_answer(FORMULA, 10 ** (60 * (t1 - 0.5))) == {"values": [1.0, None]}


def test_a_formula_with_a_function_that_numpy_does_not_have_counts_by_its_values():
    assert read_answer(FORMULA, sp.erf(t1))["values"] == pytest.approx([math.erf(0.5), math.erf(1.0)])


def test_a_shape_of_many_dimensions_is_named():
    words = sentence(read_answer(MATRIX, np.zeros((2, 2, 2, 2))), "A1", "a matrix")
    assert words == "A1 has shape 2 × 2 × 2 × 2; a matrix is asked for."


@pytest.mark.parametrize("value", [complex("nan"), complex("inf"), complex("nanj"), complex("infj"), 1e300 + 0j])
def test_a_number_without_an_end_is_no_value(value):
    assert answers._real_or_none(value) is None
    assert answers._real_or_none(2 + 1e-9j) == 2.0


def test_a_formula_of_numbers_is_constant():
    assert read_answer(FORMULA, 0.5) == {"values": [0.5, 0.5]}


def test_a_function_is_called_with_arrays():
    assert read_answer(FUNCTION, lambda i, q: i * (q + 1)[0]) == {"values": [1.5, 3.0]}


def test_a_chain_is_a_table_with_its_convention_and_ends():
    table = read_answer(TABLE, robots.puma560(source="corke"))["table"]
    assert table["convention"] == "modified"
    assert np.shape(table["base"]) == (4, 4)
    assert len(table["rows"]) == 6


class Liar:
    """Everything that can be asked of it raises."""

    def __getattr__(self, name):
        raise RuntimeError("no")

    def __str__(self):
        raise RuntimeError("no")

    __repr__ = __float__ = __len__ = __iter__ = __eq__ = __bool__ = __array__ = __str__
    __hash__ = object.__hash__


@pytest.mark.parametrize("request_", REQUESTS, ids=lambda r: r["form"])
def test_an_object_that_raises_costs_its_own_answer_only(request_):
    assert "fault" in read_answer(request_, Liar())
    assert "fault" in read_answer(request_, [[Liar(), 1], [2, 3]])


@given(
    st.sampled_from(REQUESTS),
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text() | st.complex_numbers() | st.binary(),
        lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner) | st.tuples(inner, inner),
    ),
)
def test_nothing_makes_the_reader_raise(request_, value):
    reading = read_answer(request_, value)
    assert len(json.dumps(reading, allow_nan=False)) < 100_000
