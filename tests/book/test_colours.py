"""The figure colours can be read on their ground, and told apart by colour-blind eyes."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pytest

# Machado, Oliveira and Fernandes (2009), severity 1.0, in linear RGB.
SEEN_BY = {
    "all cones": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
    "tritanopia": np.array(
        [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]
    ),
}
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def themes(root: Path) -> dict[str, dict[str, str]]:
    blocks = (root / "book/style/colours.css").read_text("utf-8").split("}")
    return {
        name: dict(re.findall(r"--dh-([a-z]+): (#[0-9a-f]{6});", block))
        for name, block in zip(("light", "dark", "print"), blocks, strict=False)
    }


def linear(colour: str) -> np.ndarray:
    value = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def contrast(one: str, other: str) -> float:
    bright, dark = sorted((float(TO_XYZ[1] @ linear(colour)) for colour in (one, other)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def difference(one: str, other: str, seen: np.ndarray) -> float:
    def lab(colour: str) -> np.ndarray:
        t = TO_XYZ @ np.clip(seen @ linear(colour), 0, 1) / np.array([0.9505, 1, 1.089])
        x, y, z = np.where(t > 0.008856, np.cbrt(t), 7.787 * t + 16 / 116)
        return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])

    return float(np.linalg.norm(lab(one) - lab(other)))


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("name", ["x", "y", "z", "ink", "muted", "accent", "right", "wrong"])
def test_letters_can_be_read(root: Path, theme: str, name: str) -> None:
    colours = themes(root)[theme]
    assert contrast(colours[name], colours["ground"]) >= 4.5


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("eyes", SEEN_BY)
def test_axes_can_be_told_apart(root: Path, theme: str, eyes: str) -> None:
    colours = themes(root)[theme]
    for one, other in itertools.combinations("xyz", 2):
        assert difference(colours[one], colours[other], SEEN_BY[eyes]) > 20, (one, other)


def test_colours_that_cannot_would_be_found() -> None:
    assert contrast("#ffff00", "#ffffff") < 4.5
    assert difference("#b04a4a", "#7d6b3c", SEEN_BY["deuteranopia"]) < 20


def test_each_theme_has_every_colour(root: Path) -> None:
    light, dark, print_ = themes(root).values()
    assert light.keys() == dark.keys()
    assert print_ == light
