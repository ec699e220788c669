"""Chapters quote executed values: no matrix, no row of numbers and no decimal is typed by hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from truth import hand_typed


def test_chapters_quote_their_numbers(root: Path) -> None:
    chapters = sorted((root / "book").glob("*.md"))
    assert chapters
    typed = {chapter.name: found for chapter in chapters if (found := hand_typed(chapter.read_text("utf-8")))}
    assert not typed, "\n".join(
        f"book/{name}:{line}: {what}: {text}" for name, found in typed.items() for line, what, text in found
    )


@pytest.mark.parametrize(
    "text",
    [
        "$$\n\\begin{bmatrix} 0 & -1 \\\\ 1 & 0 \\end{bmatrix}\n$$",
        "$\\begin{pmatrix} \\cos\\theta \\\\ \\sin\\theta \\end{pmatrix}$",
        "\\begin{array}{cc} 1 & 2 \\end{array}",
        "```{math}\n\\begin{bmatrix} 1 \\end{bmatrix}\n```",
        ":::{note}\nas in $\\begin{smallmatrix} 1 \\end{smallmatrix}$\n:::",
        "| 1 | $\\theta_1$ | 0.4 | 0 | 90° |",
        "| 1 | q1 | $-\\pi/2$ | $\\frac{\\pi}{2}$ |",
        "The upper arm is 0.4318 m long.",
        "- about −0.02 in x",
    ],
)
def test_a_typed_value_would_be_found(text: str) -> None:
    assert len(hand_typed(f"# Title\n\n{text}\n")) == 1


@pytest.mark.parametrize(
    "text",
    [
        "```{code-cell}\nA = [[0.4318, 1], [2, 3]]\n```",
        "````{code-cell}\n:tags: [hide-input]\nx = r'\\begin{bmatrix}'\n```\n0.5\n````",
        "```python\nd = 0.4318\n```",
        "The arm has 6 joints and reaches {glue:text}`reach`.",
        "```{glue:math} A1\n:label: eq-1.5\n```",
        "| name | what it is |\n| --- | --- |\n| $a$ | the length of link 1 |",
        "| [Paul 1981](https://example.org/1.5) | `0.5` |",
        "See {numref}`fig-1.2`, Chapter 2.",
        "Under CC BY-4.0 or Python 3.11.7.",
        "$^{i-1}A_i = R_z(\\theta_i)\\,T_z(d_i)$",
    ],
)
def test_quoted_values_and_code_pass(text: str) -> None:
    assert not hand_typed(f"---\nversion: 0.13\n---\n# Title\n\n{text}\n")
