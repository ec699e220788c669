"""The matplotlib figure: every frame lettered, nothing global changed."""

from __future__ import annotations

import itertools
import re
import subprocess
import sys
import xml.etree.ElementTree as ET
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import proj3d

from dhlib import Chain, DHError, palette, robots
from dhlib.plot import plot, svg
from dhlib.view import VIEW, View

GENERIC = (0.4, -0.5, 0.9, 0.3, 0.7, 0.2, -0.6)
ARMS = [
    pytest.param(getattr(robots, name)(convention=convention), id=f"{name}-{convention}")
    for name in robots.__all__
    for convention in ("classic", "modified")
]


def words(ax: Any) -> list[str]:
    found = [re.sub(r"[${}]", "", word) for text in ax.texts for word in text.get_text().split(", ")]
    return [word for word in found if word]


@pytest.mark.parametrize("chain", ARMS)
def test_every_frame_and_length_is_lettered(chain: Chain) -> None:
    seen = words(plot(chain, GENERIC[: chain.n]))
    expected = [f"{letter}_{i}" for letter in "xyz" for i in range(chain.n + 1)]
    assert sorted(word for word in seen if word[0] in "xyz") == sorted(expected)
    first = 0 if chain.convention == "modified" else 1
    lengths = [f"a_{i}" for i, joint in enumerate(chain.joints, first) if joint.a]
    assert sorted(word for word in seen if word[0] == "a") == sorted(lengths)


def hits(ax: Any) -> list[tuple[str, str]]:
    """Labels of which one covers more than a tenth of another, as matplotlib sets them."""
    renderer = FigureCanvasAgg(ax.figure).get_renderer()
    boxes = []
    for text in ax.texts:
        x, y, _ = proj3d.proj_transform(*text.get_position_3d(), ax.get_proj())
        size = text.get_window_extent(renderer)
        centre, half = ax.transData.transform((x, y)), np.array([size.width, size.height]) / 2
        boxes.append((text.get_text(), centre - half, centre + half))
    found = []
    for (one, low, high), (other, lower, higher) in itertools.combinations(boxes, 2):
        shared = np.minimum(high, higher) - np.maximum(low, lower)
        smaller = min(np.prod(high - low), np.prod(higher - lower))
        if shared.min() > 0 and shared.prod() > 0.1 * smaller:
            found.append((one, other))
    return found


@pytest.mark.parametrize("q", [[0.0] * 7, GENERIC], ids=["zero", "generic"])
@pytest.mark.parametrize("chain", ARMS)
def test_labels_stand_apart(chain: Chain, q: list[float]) -> None:
    assert not hits(plot(chain, q[: chain.n]))


def test_labels_that_collide_would_be_found() -> None:
    ax = plot(robots.planar(2), [0, 0])
    one, other = ax.texts[:2]
    one.set_position_3d(other.get_position_3d())
    assert hits(ax) == [(one.get_text(), other.get_text())]


def test_parts_can_be_left_out() -> None:
    arm, q = robots.quickshot(), [0.0] * 4
    assert words(plot(arm, q, show=("links",))) == []
    assert {word[0] for word in words(plot(arm, q, show=("normals",)))} == {"a"}
    assert {word[0] for word in words(plot(arm, q, show=("offsets", "axes")))} == {"d"}


def test_the_arm_is_where_it_should_be() -> None:
    arm, q = robots.quickshot(), [0.4, -0.5, 0.9, 0.3]
    ax = plot(arm, q, show=("links",))
    ends = np.array([np.array(line.get_data_3d())[:, -1] for line in ax.lines])
    assert np.linalg.norm(ends - arm.fk(q)[:3, 3], axis=1).min() < 1e-9
    assert np.linalg.norm(ends - arm.fk([0.0] * 4)[:3, 3], axis=1).min() > 1


def test_one_scale_in_all_directions() -> None:
    arm, q = robots.puma560(), [0.2] * 6
    ax = plot(arm, q)
    ends = np.array([*np.eye(3), np.zeros(3)]) * 0.1
    seen = np.array([proj3d.proj_transform(*end, ax.get_proj())[:2] for end in ends])
    pixels = ax.transData.transform(seen)
    lengths = np.hypot(*(pixels[:3] - pixels[3]).T)
    shown = np.hypot(*View(*VIEW).project(np.eye(3))[:, :2].T)
    assert np.ptp(lengths / shown) < 1e-9 * lengths.max()


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_themes(theme: str) -> None:
    values = palette.colours(theme)
    ax = plot(robots.planar(2), [0.3, 0.4], theme=theme)
    assert mpl.colors.to_hex(ax.figure.get_facecolor()) == values["ground"]
    assert {text.get_color() for text in ax.texts if text.get_text()} == {values[k] for k in ("x", "y", "z", "ink")}


def test_it_draws_into_axes_that_are_given() -> None:
    figure = Figure()
    ax = figure.add_subplot(projection="3d")
    assert plot(robots.planar(2), [0, 0], ax) is ax


def test_svg_is_text_and_the_same_on_every_run() -> None:
    one, other = (svg(plot(robots.quickshot(), [0.3] * 4)) for _ in range(2))
    assert one == other
    root = ET.fromstring(one)
    assert root.tag.endswith("svg")
    assert "<text" in one


def test_nothing_global_is_changed() -> None:
    code = (
        "import matplotlib as mpl; before = dict(mpl.rcParams); from dhlib import robots; "
        "from dhlib.plot import plot, svg; svg(plot(robots.quickshot(), [0] * 4)); "
        "from matplotlib import pyplot; print(dict(mpl.rcParams) == before, pyplot.get_fignums())"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "True []\n"


def test_misuse_is_explained() -> None:
    arm = robots.planar(2)
    with pytest.raises(DHError, match="'skin'"):
        plot(arm, [0, 0], show=("skin",))
    with pytest.raises(DHError, match="theme='blue'"):
        plot(arm, [0, 0], theme="blue")
    with pytest.raises(DHError, match="projection='3d'"):
        plot(arm, [0, 0], Figure().add_subplot())
