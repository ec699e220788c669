"""Each item of the lecture and each slip of its slides has its place in the book."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from building import pages_of

ROWS = {"outline": 23, "errata": 19}


@pytest.fixture
def coverage(root: Path) -> dict[str, dict[int, Any]]:
    found: dict[str, dict[int, Any]] = yaml.safe_load((root / "book" / "coverage.yml").read_text("utf-8"))
    return found


def faults(coverage: dict[str, dict[int, Any]], labels: set[str]) -> list[str]:
    """Return the rows that are missing, and those that lead nowhere."""
    found = []
    for name, count in ROWS.items():
        rows = coverage.get(name, {})
        found += [f"{name} {number}: missing" for number in range(1, count + 1) if number not in rows]
        found += [f"{name} {number}: there is no such row" for number in rows if not 1 <= number <= count]
        for number, row in rows.items():
            sections = row["sections"]
            found += [] if sections and row["what"] else [f"{name} {number}: says nothing"]
            found += [f"{name} {number}: no section {label}" for label in sections if label not in labels]
    return found


@pytest.mark.book
def test_every_row_is_taught(site: Path, coverage: dict[str, dict[int, Any]]) -> None:
    labels = {
        label for page in pages_of(site) for label in re.findall(r' id="(sec-[\w-]+)"', (site / page).read_text())
    }
    assert faults(coverage, labels) == []


def test_what_is_missing_would_be_found(coverage: dict[str, dict[int, Any]]) -> None:
    labels = {label for rows in coverage.values() for row in rows.values() for label in row["sections"]}
    assert faults(coverage, labels) == []
    assert faults(coverage, labels - {"sec-quickshot"}) == ["outline 19: no section sec-quickshot"]
    del coverage["errata"][8]
    coverage["outline"][24] = {"what": "more", "sections": ["sec-why"]}
    coverage["outline"][5]["sections"] = []
    found = faults(coverage, labels | {"sec-why"})
    assert found == ["outline 24: there is no such row", "outline 5: says nothing", "errata 8: missing"]
