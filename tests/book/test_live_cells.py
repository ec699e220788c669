"""What a page is told of its cells: what cannot run there, and what is drawn with matplotlib."""

from __future__ import annotations

import ast

import pytest
from live_cells import Missing, draws_with_matplotlib

CELLS = [
    ("import numpy as np\nfrom dhlib import robots\nimport io", ""),
    ("from yourdfpy import URDF\nimport numpy as np", "yourdfpy"),
    ("def load(text):\n    return URDF.load(text)", "yourdfpy"),
    ("text = 'a file'", ""),
    ("robot = load(text)", "yourdfpy"),
    ("def names(robot):\n    return [joint.name for joint in robot.joints]", ""),
    ("print(names(robot))", "yourdfpy"),
    ("robot = robots.ur5()", ""),
    ("robot", ""),
    ("np.eye(3)", "yourdfpy"),
    ("np = 3\nnp", ""),
    ("for joint in robot:\n    x, y = load(joint)", "yourdfpy"),
    ("x, y = 1, 2\nprint([joint for joint in range(x)])", ""),
    ("for y in range(3):\n    print(y)", ""),
    ("x = x + 1", ""),
]


def test_cells_without_what_the_page_lacks_can_run() -> None:
    missing = Missing()
    assert [missing.of(ast.parse(source)) for source, _ in CELLS] == [module for _, module in CELLS]


@pytest.mark.parametrize(
    ("source", "draws"),
    [
        ("import matplotlib.pyplot as plt", True),
        ("from matplotlib import pyplot", True),
        ("from dhlib.plot import plot", True),
        ("from dhlib import plot", True),
        ("import dhlib.plot", True),
        ("from dhlib.sketch import sketch", False),
        ("plot = 3", False),
    ],
)
def test_cells_that_draw_with_matplotlib_are_known(source: str, draws: bool) -> None:
    assert draws_with_matplotlib(ast.parse(source)) is draws
