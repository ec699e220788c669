"""Lettering of a figure: how a label reads, how much room it takes, and where it stands free.

A label is written like ``x_1``, ``a_{i-1}`` or ``R_z(θ_i)``: what follows ``_`` is an index. Letters are in
italics, the rest upright.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from html import escape
from itertools import combinations

import numpy as np

from dhlib.scalars import FloatArray

FONT_SIZE = 16.0
INDEX_SIZE = 0.76
INDEX_DROP = 0.22
LINE_HEIGHT = 1.12

_TOKEN = re.compile(r"_\{([^}]*)\}|_(.)|([^_]+)")
_ITALIC = re.compile(r"(?<![A-Za-z])[A-Za-zα-ω]′?(?![A-Za-z])")
#: Widths of letters in em, on the generous side: the figure takes the font of the page.
_WIDTHS = {**dict.fromkeys("ijl,.'′ |:;()[]", 0.34), **dict.fromkeys("mwMW", 0.92), "−": 0.84, "=": 0.84, "+": 0.84}


def runs(text: str) -> list[tuple[str, bool]]:
    """Split a label into pieces, each with whether it is an index.

    Examples
    --------
    >>> runs("a_{i-1}, x_0")
    [('a', False), ('i−1', True), (', x', False), ('0', True)]
    """
    pieces = []
    for braced, single, plain in _TOKEN.findall(text):
        pieces.append(((braced or single or plain).replace("-", "−"), not plain))
    return pieces


def indexed(symbol: str, index: str) -> str:
    """A symbol with an index, as a label; without one if it is empty.

    Examples
    --------
    >>> indexed("x", "1"), indexed("x", "i-1"), indexed("n", "")
    ('x_1', 'x_{i-1}', 'n')
    """
    if not index:
        return symbol
    return f"{symbol}_{index}" if len(index) == 1 else f"{symbol}_{{{index}}}"


def text_width(text: str, size: float = FONT_SIZE) -> float:
    """Estimate how wide a label is.

    Examples
    --------
    >>> text_width("x_1") < text_width("x_{i-1}")
    True
    """
    width = 0.0
    for piece, index in runs(text):
        width += (INDEX_SIZE if index else 1) * sum(_letter_width(letter) for letter in piece)
    return size * width


def _letter_width(letter: str) -> float:
    return _WIDTHS.get(letter, 0.74 if letter.isupper() else 0.64)


def text_svg(text: str) -> str:
    """A label as the inside of an SVG ``<text>``.

    Examples
    --------
    >>> text_svg("x_1")
    '<tspan class="i">x</tspan><tspan class="s" dy=".22em">1</tspan>'
    """
    parts = []
    shift = 0.0
    for piece, index in runs(text):
        if index:
            # dy is in the em of its own element, so the way back up is given in the larger em of the letter
            kind = "s i" if piece[0].isalpha() else "s"
            parts.append(f'<tspan class="{kind}" dy="{_short(INDEX_DROP)}em">{escape(piece)}</tspan>')
            shift = INDEX_DROP * INDEX_SIZE
            continue
        back = f' dy="-{_short(shift)}em"' if shift else ""
        shift = 0.0
        parts.append(_plain_svg(piece, back))
    return "".join(parts)


def _plain_svg(piece: str, back: str) -> str:
    """An upright piece with its single letters in italics; `back` returns to the base line."""
    parts, end = [], 0
    for found in _ITALIC.finditer(piece):
        parts += [(piece[end : found.start()], ""), (found[0], ' class="i"')]
        end = found.end()
    parts.append((piece[end:], ""))
    svg = []
    for text, italic in parts:
        if text:
            svg.append(f"<tspan{italic}{back}>{escape(text)}</tspan>" if italic or back else escape(text))
            back = ""
    return "".join(svg)


def _short(value: float) -> str:
    return f"{value:.3f}".rstrip("0").removeprefix("0")


@dataclass
class Label:
    """A label that looks for its place.

    Attributes
    ----------
    text : str
    colour : str
        Class of its colour; empty for ink.
    places : list of (point, direction, cost)
        Where it may stand: off a point (2,) in a direction (2,), and how unwelcome that is.
    centre : ndarray (2,)
        Where it does stand.
    """

    text: str
    colour: str
    places: list[tuple[FloatArray, FloatArray, float]]
    size: float = FONT_SIZE
    centre: FloatArray = field(default_factory=lambda: np.zeros(2))

    @property
    def half(self) -> FloatArray:
        """Half its width and height, (2,)."""
        return np.array([text_width(self.text, self.size), LINE_HEIGHT * self.size]) / 2

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Left, top, right, bottom."""
        (x, y), (w, h) = self.centre, self.half
        return float(x - w), float(y - h), float(x + w), float(y + h)


def around(tip: FloatArray, outward: FloatArray) -> list[tuple[FloatArray, FloatArray, float]]:
    """Places about a tip, best straight ahead, then turning away to either side."""
    places = []
    for degrees in (0, 25, -25, 50, -50, 75, -75, 100, -100, 130, -130, 160, -160):
        turn = np.deg2rad(degrees)
        c, s = np.cos(turn), np.sin(turn)
        direction = np.array([c * outward[0] - s * outward[1], s * outward[0] + c * outward[1]])
        places.append((tip, direction, abs(degrees) / 12))
    return places


def beside(start: FloatArray, end: FloatArray) -> list[tuple[FloatArray, FloatArray, float]]:
    """Places on both sides of a line, best near its middle."""
    along = end - start
    length = float(np.hypot(*along))
    if length < 1e-6:
        return around(start, np.array([0.0, -1.0]))
    normal = np.array([along[1], -along[0]]) / length
    places = []
    for part in (0.5, 0.35, 0.65, 0.2, 0.8):
        for side in (normal, -normal):
            tilted = side + 0.35 * (part - 0.5) * along / length
            places.append((start + part * along, tilted / np.hypot(*tilted), 8 * abs(part - 0.5)))
    if length < 24:
        places += [(point, direction, cost + 2) for point, direction, cost in around((start + end) / 2, normal)]
    return places


GAPS = (3.0, 7.0, 13.0, 21.0, 31.0)


def place(labels: Sequence[Label], lines: FloatArray, bounds: tuple[float, float, float, float]) -> float:
    """Give each label the place where it least meets lines and other labels, and never leaves the bounds.

    Parameters
    ----------
    labels : sequence of Label
        Their centres are set.
    lines : ndarray (m, 5)
        What should stay free: x and y of both ends, and half the thickness.
    bounds : (left, top, right, bottom)

    Returns
    -------
    float
        How crowded it is: the cost of all places, lower is better.
    """
    if not labels:
        return 0.0
    centres, costs = zip(*(_candidates(label, lines, bounds) for label in labels), strict=True)
    halves = np.array([label.half for label in labels])
    chosen = [int(cost.argmin()) for cost in costs]
    placed: list[int] = []
    hardest_first = sorted(range(len(labels)), key=lambda k: (-float(np.partition(costs[k], 3)[3]), k))
    for rounds in range(6):
        before = list(chosen)
        for k in hardest_first:
            others = [j for j in (placed if rounds == 0 else range(len(labels))) if j != k]
            total = costs[k].copy()
            for j in others:
                total += _overlap(centres[k], halves[k], centres[j][chosen[j]], halves[j])
            chosen[k] = int(total.argmin())
            placed.append(k)
        if rounds and chosen == before:
            break
    for label, options, k in zip(labels, centres, chosen, strict=True):
        label.centre = options[k]
    crowd = sum(float(cost[k]) for cost, k in zip(costs, chosen, strict=True))
    for k, j in combinations(range(len(labels)), 2):
        crowd += float(_overlap(labels[k].centre[None], halves[k], labels[j].centre, halves[j])[0])
    return crowd


def _candidates(
    label: Label, lines: FloatArray, bounds: tuple[float, float, float, float]
) -> tuple[FloatArray, FloatArray]:
    """Centres (k, 2) of all places of a label, and what each costs by itself (k,)."""
    half = label.half
    centres, costs = [], []
    for point, direction, cost in label.places:
        room = np.abs(direction) / half
        to_edge = 1 / max(float(room.max()), 1e-9)  # from the centre of the box to its edge, along the direction
        for gap in GAPS:
            centres.append(point + (gap + to_edge) * direction)
            costs.append(cost + 0.9 * (gap - GAPS[0]))
    options, total = np.array(centres), np.array(costs)
    left, top, right, bottom = bounds
    outside = np.maximum(0, [left, top] - (options - half)).sum(-1)
    outside += np.maximum(0, (options + half) - [right, bottom]).sum(-1)
    total += 1e4 * (outside > 1e-9) + 1e3 * outside
    if len(lines):
        total += 2.5 * _covered(options, half, lines).sum(-1)
    return options, total


def _covered(centres: FloatArray, half: FloatArray, lines: FloatArray) -> FloatArray:
    """Length of each line within each box, (k, m): clipped by Liang and Barsky's method (1984)."""
    start, along = lines[:, :2], lines[:, 2:4] - lines[:, :2]
    reach = half + lines[:, 4:5]  # (m, 2)
    low = (centres[:, None] - reach) - start
    high = (centres[:, None] + reach) - start
    steep = np.where(np.abs(along) < 1e-9, 1e-9, along)
    enter = np.minimum(low / steep, high / steep).max(-1)
    leave = np.maximum(low / steep, high / steep).min(-1)
    inside = np.clip(leave, 0, 1) - np.clip(enter, 0, 1)
    length = np.hypot(along[:, 0], along[:, 1])
    met = inside > 0
    return np.where(met, 2 + inside * length, 0.0)


def _overlap(centres: FloatArray, half: FloatArray, other: FloatArray, other_half: FloatArray) -> FloatArray:
    """What it costs to stand on another label, (k,)."""
    shared = half + other_half + 1.0 - np.abs(centres - other)
    hit = (shared > 0).all(-1)
    return np.where(hit, 400 + np.clip(shared, 0, None).prod(-1) * 5, 0.0)
