"""Symbols in the reference have indices, and its code stays as it is."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from indices import with_indices


def test_a_symbol_gets_its_index() -> None:
    assert with_indices("α_{i-1}, T_n") == r"\ *α*\ :sub:`i-1`, \ *T*\ :sub:`n`"


@pytest.mark.parametrize(
    "code", ["``R_x(α) = x_i``", "`x_i`", ">>> x_i = 1\n i | θ_i |\n", "max_i", "x_before", "same_mechanism", "T_12"]
)
def test_code_and_names_stay_as_they_are(code: str) -> None:
    assert with_indices(code) == code


def test_what_follows_an_example_is_prose_again() -> None:
    assert with_indices(">>> x_i\n1\n\nx_i").startswith(">>> x_i\n1\n\n\\ *x*")


@pytest.mark.book
def test_the_reference_shows_no_raw_index(site: Path) -> None:
    page = (site / "book/reference.html").read_text("utf-8")
    prose = re.sub(r"<(code|pre|script|svg)\b.*?</\1>", "", page[page.index("<article") :], flags=re.DOTALL)
    assert not re.findall(r".{20}[a-zα-ω]_(?:\{|[a-z0-9]\b).{20}", prose)
    assert "<em>α</em><sub>i-1</sub>" in prose
