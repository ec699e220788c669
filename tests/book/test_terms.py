"""The book uses the standard names, and quotes those of the slides only where it says that they are slips."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

SLIPS = re.compile(r"joint (?:length|twist)s?\b|shear (?:axis|axes|joints?)\b", re.IGNORECASE)
STANDARD = ("link length", "link twist", "link offset", "joint angle", "prismatic joint")
#: Where the slides are quoted, and said to be wrong.
QUOTING = {"book/classic.md", "book/proofreading.md"}


def slips(text: str) -> list[str]:
    """Return the names for lengths, twists and axes that are the slides' own."""
    return SLIPS.findall(text)


@pytest.fixture(scope="module")
def pages(root: Path) -> dict[str, str]:
    """Return what readers read: chapters, exercises and the library's docstrings."""
    found = [
        *root.glob("book/*.md"),
        *root.glob("exercises/*.py"),
        *root.glob("solutions/*.ipynb"),
        *root.glob("dhlib/**/*.py"),
    ]
    return {path.relative_to(root).as_posix(): path.read_text("utf-8") for path in found}


def test_nobody_speaks_of_joint_length(pages: dict[str, str]) -> None:
    assert {name: slips(text) for name, text in pages.items() if name not in QUOTING and slips(text)} == {}


def test_the_slips_are_quoted_where_they_are_taught(pages: dict[str, str]) -> None:
    for name in QUOTING:
        assert len(set(map(str.lower, slips(pages[name])))) == 3, name


def test_a_slip_would_be_found() -> None:
    assert slips("the joint twist of a shear joint") == ["joint twist", "shear joint"]
    assert not slips("the joint angle, and the link twist")


def test_the_standard_names_are_in_the_glossary(pages: dict[str, str]) -> None:
    glossary = pages["book/notation.md"].partition("```{glossary}")[2]
    entries = [line for line in glossary.splitlines() if line and not line.startswith((" ", "`"))]
    assert set(STANDARD) <= set(entries)
