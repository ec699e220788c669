"""The spell checker reads the text, in British English, and leaves code and formulas alone."""

from __future__ import annotations

from pathlib import Path

import pytest
from spelling import misspelt


@pytest.mark.parametrize(("text", "word"), [("The matix turns.", "matix"), ("The color of axes.", "color")])
def test_a_slip_would_be_found(tmp_path: Path, text: str, word: str) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"# A page\n\n{text}\n", "utf-8")
    assert word in misspelt(page, folder=tmp_path)


def test_code_formulas_and_terms_pass(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text(
        "# Denavit and Hartenberg\n\nThe colour of $thetaq$ and `qwert`, {ref}`sec-xyzzy`, (*Gelenkwinkel*).\n\n"
        "```{code-cell}\nzzyx = 1\n```\n",
        "utf-8",
    )
    assert misspelt(page, folder=tmp_path) == ""
