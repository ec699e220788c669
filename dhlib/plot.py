"""An arm with all its frames as a matplotlib figure in space. This is the only module that imports matplotlib."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, cast

import matplotlib as mpl
import matplotlib.patheffects
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D, proj3d  # type: ignore[import-untyped]

from dhlib.drawing import NOTHING, Drawing, draw
from dhlib.errors import DHError
from dhlib.labels import Label, around, beside, indexed, place
from dhlib.palette import colours
from dhlib.scalars import FloatArray
from dhlib.view import VIEW, View

if TYPE_CHECKING:
    from dhlib.chain import Chain

PARTS = ("links", "frames", "normals", "offsets", "axes")
#: Of the frames' axes, as a part of the arm's size.
AXIS_LENGTH = 0.16
LETTER_SIZE = 11.0


def plot(
    chain: Chain,
    q: Any,
    ax: Axes | None = None,
    *,
    show: Sequence[str] = ("links", "frames", "normals", "offsets"),
    theme: str = "light",
    view: tuple[float, float] = VIEW,
    size: tuple[float, float] = (6.0, 6.0),
) -> Axes:
    """Draw an arm at one joint vector into axes in space.

    Parameters
    ----------
    chain : Chain
    q : array_like (n,)
    ax : matplotlib Axes3D, optional
        Where to draw; a new figure if left out. It is not registered with pyplot, so nothing need be closed.
    show : sequence of {"links", "frames", "normals", "offsets", "axes"}
        Parts: the arm as grey bars; the frames, red x, green y, blue z, each lettered; the link lengths a and the
        link offsets d that are not zero; the joint axes as lines.
    theme : {"light", "dark"}
    view : (float, float)
        Azimuth and elevation of the eye in degrees.
    size : (float, float)
        Of a new figure, in inches.

    Returns
    -------
    matplotlib Axes
        Its figure is ``ax.figure``.

    Raises
    ------
    DHError
        If q is not one joint vector of numbers that fits the chain, a part or the theme is unknown, or `ax` is flat.

    Examples
    --------
    >>> from dhlib import robots
    >>> ax = plot(robots.quickshot(), [0, 0, 0, 0])
    >>> sorted(text.get_text() for text in ax.texts)[:4]
    ['$a_{1}$', '$a_{2}$', '$d_{1}$', '$d_{3}$']
    """
    unknown = [part for part in show if part not in PARTS]
    if unknown:
        raise DHError(f"show holds {unknown[0]!r}; it may hold {', '.join(map(repr, PARTS))}.")
    colour = colours(theme)
    figure = draw(chain, q)
    if ax is None:
        canvas = FigureCanvasAgg(Figure(figsize=size))
        ax = canvas.figure.add_axes((0, 0, 1, 1), projection="3d")
    if not isinstance(ax, Axes3D):
        raise DHError("ax is flat; it should be made with projection='3d'.")
    _prepare(ax, colour, view, chain.unit)
    _fit(ax, figure)
    letters = _Letters(ax, View(*view))
    if "axes" in show:
        for joint in figure.joints:
            reach = 0.25 * figure.size * joint.axis
            _line(ax, [joint.foot - reach, joint.foot + reach], colour["muted"], linewidth=0.8, linestyle="-.")
    if "links" in show:
        for ends in figure.links:
            _line(ax, ends, colour["body"], linewidth=6, solid_capstyle="round", zorder=1)
            letters.keep_free(ends[0], ends[1], 8)
    for part, segments, hue in (("normals", figure.normals, "x"), ("offsets", figure.offsets, "z")):
        for segment in segments if part in show else ():
            if segment.length > NOTHING * figure.size:
                _line(ax, [segment.start, segment.end], colour[hue], linewidth=1.2, linestyle=":", zorder=2)
                letters.beside(segment.start, segment.end, segment.label)
    if "frames" in show:
        for origin, direction, letter, label in _arrows(figure):
            tip = AXIS_LENGTH * figure.size * direction
            ax.quiver(*origin, *tip, color=colour[letter], linewidth=1.6, arrow_length_ratio=0.22, zorder=3)
            letters.at_tip(origin, origin + tip, label, letter)
    letters.write(colour)
    return cast(Axes, ax)


def svg(ax: Axes) -> str:
    """The figure of some axes as SVG whose text is text, the same on every run.

    Examples
    --------
    >>> from dhlib import robots
    >>> "<text" in svg(plot(robots.planar(2), [0, 0]))
    True
    """
    buffer = io.StringIO()
    with mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": "dh"}):
        cast(Figure, ax.figure).savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    return buffer.getvalue()


def _prepare(ax: Axes3D, colour: dict[str, str], view: tuple[float, float], unit: str) -> None:
    """A ground without panes, thin ticks, and nothing that distracts."""
    ax.view_init(elev=view[1], azim=view[0])
    ax.set_proj_type("ortho")
    for part in (ax.figure.patch, ax.patch):
        part.set_facecolor(colour["ground"])
    for letter, axis in zip("xyz", (ax.xaxis, ax.yaxis, ax.zaxis), strict=True):
        axis.set_pane_color((0, 0, 0, 0))
        axis.line.set_color(colour["muted"])
        axis._axinfo["grid"].update(color=colour["faint"], linewidth=0.6)
        axis.set_label_text(f"{letter} in {unit}", color=colour["muted"])
        ax.tick_params(axis=letter, colors=colour["muted"], labelsize=8)
        ax.locator_params(axis=letter, nbins=4)


def _fit(ax: Axes3D, figure: Drawing) -> None:
    """Limits around the arm and its frames, with the same scale in all directions."""
    points = [frame.origin for frame in figure.frames] + [end for ends in figure.links for end in ends]
    margin = 1.25 * AXIS_LENGTH * figure.size
    low, high = np.min(points, axis=0) - margin, np.max(points, axis=0) + margin
    for set_limits, *limits in zip((ax.set_xlim, ax.set_ylim, ax.set_zlim), low, high, strict=True):
        set_limits(*limits)
    ax.set_box_aspect(high - low, zoom=0.9)  # room for the names of the axes


def _arrows(figure: Drawing) -> list[tuple[FloatArray, FloatArray, str, str]]:
    """Origin, direction, letter and label of all axes of all frames; those that coincide share an arrow."""
    arrows: list[tuple[FloatArray, FloatArray, str, list[str]]] = []
    for frame in figure.frames:
        for letter in "xyz":
            direction, label = frame.axis(letter), indexed(letter, frame.name)
            for origin, known, name, labels in arrows:
                here = np.linalg.norm(origin - frame.origin) < 1e-6 * figure.size
                if here and name == letter and np.linalg.norm(known - direction) < 1e-6:
                    labels.append(label)
                    break
            else:
                arrows.append((frame.origin, direction, letter, [label]))
    return [(origin, direction, letter, ", ".join(labels)) for origin, direction, letter, labels in arrows]


class _Letters:
    """Labels that find their places as in a `sketch`, in the plane of the picture as it is first seen."""

    def __init__(self, ax: Axes3D, view: View) -> None:
        self.ax, self.view = ax, view
        self.labels: list[Label] = []
        self.lines: list[FloatArray] = []
        self.points: list[FloatArray] = []  # a point in space for each label: it keeps that depth
        right = view.directions[0]
        self.scale = float(np.linalg.norm(self._pixels(right) - self._pixels(0 * right)))  # per unit of length

    def _pixels(self, point: FloatArray) -> FloatArray:
        """Where a point is seen in the figure, in points of 1/72 inch: right and down."""
        x, y, _ = proj3d.proj_transform(*point, self.ax.get_proj())
        pixel = self.ax.transData.transform((x, y)) * 72 / self.ax.figure.dpi
        return np.array([pixel[0], -pixel[1]])

    def keep_free(self, start: FloatArray, end: FloatArray, width: float) -> None:
        self.lines.append(np.array([*self._pixels(start), *self._pixels(end), width / 2]))

    def beside(self, start: FloatArray, end: FloatArray, label: str) -> None:
        self._add(label, "ink", beside(self._pixels(start), self._pixels(end)), (start + end) / 2)

    def at_tip(self, start: FloatArray, end: FloatArray, label: str, colour: str) -> None:
        self.keep_free(start, end, 2)
        tip = self._pixels(end)
        along = tip - self._pixels(start)
        length = float(np.hypot(*along))
        self._add(label, colour, around(tip, along / length if length > 1 else np.array([-0.7, 0.7])), end)

    def _add(self, label: str, colour: str, places: list[tuple[FloatArray, FloatArray, float]], at: FloatArray) -> None:
        self.labels.append(Label(label, colour, places, LETTER_SIZE))
        self.points.append(at)

    def write(self, colour: dict[str, str]) -> None:
        left, bottom, right, top = np.array(self.ax.get_window_extent().extents) * 72 / self.ax.figure.dpi
        place(self.labels, np.array(self.lines).reshape(-1, 5), (left, -top, right, -bottom))
        halo = [mpl.patheffects.withStroke(linewidth=2.5, foreground=colour["ground"])]
        for label, point in zip(self.labels, self.points, strict=True):
            aside = (label.centre - self._pixels(point)) / self.scale
            at = point + aside @ self.view.directions[:2]
            text = ", ".join(map(_math, label.text.split(", ")))
            style = {"color": colour[label.colour], "fontsize": LETTER_SIZE, "path_effects": halo, "zorder": 10}
            self.ax.text(*at, text, ha="center", va="center", **style)


def _line(ax: Axes3D, ends: Any, colour: str, **style: Any) -> None:
    ax.plot(*np.transpose(ends), color=colour, **style)


def _math(label: str) -> str:
    """A label as mathematics: ``x_1`` to ``$x_{1}$``."""
    symbol, _, index = label.partition("_")
    return f"${symbol}_{{{index.strip('{}')}}}$"
