"""The same class for every grader: notebooks of four parts on an arm of two links, each right or wrong as planned.

A student's cell and the cell that tests it are the same for all; only what each grader wants around them differs.
"""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

SETUP = "import numpy as np\n\na1, a2 = 0.7, 0.4\nq = np.array([0.3, -0.8])"

#: Of each part: what a student writes who is right, and one who is not; and the test of it.
PARTS = {
    "p": (
        "p = np.array([a1 * np.cos(q[0]) + a2 * np.cos(q[0] + q[1]), a1 * np.sin(q[0]) + a2 * np.sin(q[0] + q[1])])",
        "p = np.array([a1 * np.cos(q[0]) + a2 * np.cos(q[1]), a1 * np.sin(q[0]) + a2 * np.sin(q[1])])",
        "assert np.shape(p) == (2,)\nassert np.allclose(p, [1.019768, 0.015096], atol=1e-3)",
    ),
    "A1": (
        "c, s = np.cos(q[0]), np.sin(q[0])\n"
        "A1 = np.array([[c, -s, 0, a1 * c], [s, c, 0, a1 * s], [0, 0, 1, 0], [0, 0, 0, 1]])",
        "c, s = np.cos(q[0]), np.sin(q[0])\n"
        "A1 = np.array([[c, s, 0, a1 * c], [-s, c, 0, a1 * s], [0, 0, 1, 0], [0, 0, 0, 1]])",
        "assert np.shape(A1) == (4, 4)\n"
        "assert np.allclose(A1[:2, :2], [[0.955336, -0.295520], [0.295520, 0.955336]], atol=1e-3)\n"
        "assert np.allclose(A1[:3, 3], [0.668736, 0.206864, 0], atol=1e-3)",
    ),
    "T": (
        "def link(angle, a):\n"
        "    c, s = np.cos(angle), np.sin(angle)\n"
        "    return np.array([[c, -s, 0, a * c], [s, c, 0, a * s], [0, 0, 1, 0], [0, 0, 0, 1]])\n\n"
        "T = link(q[0], a1) @ link(q[1], a2)",
        "def link(angle, a):\n"
        "    c, s = np.cos(angle), np.sin(angle)\n"
        "    return np.array([[c, -s, 0, a * c], [s, c, 0, a * s], [0, 0, 1, 0], [0, 0, 0, 1]])\n\n"
        "T = link(q[1], a2) @ link(q[0], a1)",
        "assert np.shape(T) == (4, 4)\n"
        "assert np.allclose(T[:2, :2], [[0.877583, 0.479426], [-0.479426, 0.877583]], atol=1e-3)\n"
        "assert np.allclose(T[:3, 3], [1.019768, 0.015096, 0], atol=1e-3)",
    ),
    "fk": (
        "def fk(q):\n"
        "    x = a1 * np.cos(q[0]) + a2 * np.cos(q[0] + q[1])\n"
        "    y = a1 * np.sin(q[0]) + a2 * np.sin(q[0] + q[1])\n"
        "    return np.array([x, y])",
        "def fk(q):\n"
        "    x = a1 * np.cos(q[0]) + a2 * np.cos(q[0] - q[1])\n"
        "    y = a1 * np.sin(q[0]) + a2 * np.sin(q[0] - q[1])\n"
        "    return np.array([x, y])",
        "assert np.allclose(fk([0.0, 0.0]), [1.1, 0.0], atol=1e-6)\n"
        "assert np.allclose(fk([0.0, np.pi / 2]), [0.7, 0.4], atol=1e-6)",
    ),
}


def plan(count: int, seed: int = 30) -> list[dict[str, bool]]:
    """Who is right in which part."""
    chance = random.Random(seed)
    return [{part: chance.random() < 0.7 for part in PARTS} for _ in range(count)]


def answers(right: dict[str, bool]) -> dict[str, str]:
    """The cells of one student."""
    return {part: PARTS[part][0 if right[part] else 1] for part in PARTS}


def code(cell_id: str, source: str, metadata: dict[str, Any] | None = None) -> dict[str, Any]:
    """A code cell."""
    return {
        "cell_type": "code",
        "id": cell_id,
        "metadata": metadata or {},
        "execution_count": None,
        "outputs": [],
        "source": source.splitlines(keepends=True),
    }


def notebook(cells: list[dict[str, Any]], metadata: dict[str, Any] | None = None) -> dict[str, Any]:
    """A notebook."""
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    return {"cells": cells, "metadata": kernel | (metadata or {}), "nbformat": 4, "nbformat_minor": 5}


def write(path: Path, content: dict[str, Any]) -> None:
    """Store a notebook."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1), encoding="utf-8")


def plain(sources: dict[str, str]) -> dict[str, Any]:
    """For nbval and nbclient: each answer, and its test as a cell."""
    cells = [code("setup", SETUP)]
    for part, source in sources.items():
        cells += [code(f"answer-{part}", source), code(f"test-{part}", PARTS[part][2])]
    return notebook(cells)


def for_nbgrader(sources: dict[str, str]) -> dict[str, Any]:
    """For nbgrader: its marks in the metadata."""

    def about(cell_id: str, **what: Any) -> dict[str, Any]:
        default = {"grade": False, "grade_id": cell_id, "locked": False, "schema_version": 3, "solution": False}
        return {"nbgrader": default | {"task": False} | what}

    cells = [code("setup", SETUP, about("setup", locked=True))]
    for part, text in sources.items():
        cells.append(code(f"answer-{part}", text, about(f"answer-{part}", solution=True)))
        test = about(f"test-{part}", grade=True, locked=True, points=1)
        cells.append(code(f"test-{part}", PARTS[part][2], test))
    return notebook(cells)


def for_otter(sources: dict[str, str]) -> dict[str, Any]:
    """For otter: the tests are in its autograder, the notebook names the assignment's checks."""
    cells = [code("setup", SETUP)]
    cells += [code(f"answer-{part}", source) for part, source in sources.items()]
    return notebook(cells, {"otter": {"assignment_name": "two_links"}})


def for_dhlib(sources: dict[str, str]) -> dict[str, Any]:
    """For dhlib: its roles in the metadata."""

    def about(role: str, part: str = "") -> dict[str, Any]:
        return {"dh": {"role": role, **({"part": part} if part else {})}}

    cells = [code("setup", SETUP, about("setup"))]
    for part, source in sources.items():
        cells.append(code(f"answer-{part}", source, about("answer", part)))
        cells.append(code(f"check-{part}", f'check("{part}", {part})', about("check", part)))
    return notebook(cells, {"dh": {"exercise": "two_links"}})
