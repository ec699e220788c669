"""The figure of an exercise: what the text describes, and no frame that is asked for.

The file of an exercise draws it: ``figure(given)`` returns a `dhlib.scene.Sketch`, whose title is the caption. It
stands in a given cell of the notebook, so that every edition has it, with nothing to fetch and nothing to run. The
book's page shows the same drawing in its own colours.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from html import escape, unescape
from typing import Any

import numpy as np

from dhlib.chain import Chain
from dhlib.drawing import NOTHING, SYMBOL_LENGTH, SYMBOL_RADIUS, JointSymbol, draw
from dhlib.errors import DHError
from dhlib.scene import WIDTH, Scene, Sketch
from dhlib.sketch import add_arm
from dhlib.view import VIEW

#: The part of the given cell that holds the figure.
FIGURE = "figure"
CELL = re.compile(r'<img alt="([^"]+)" src="data:image/svg\+xml;base64,([^"]+)">\n\n\*(.+)\*')


def same_for_all(drawing: Callable[[], Sketch]) -> Callable[[Any], Sketch]:
    """Make ``figure(given)`` of a drawing that no number of the task changes: it is drawn once for a whole class.

    Examples
    --------
    >>> @same_for_all
    ... def figure():
    ...     return Scene().sketch("Nothing", "Nothing to see.")
    >>> figure("anything") is figure("another thing")
    True
    """
    drawn = cache(drawing)
    return lambda given: drawn()


def described(
    chain: Chain,
    title: str,
    alt: str,
    *,
    q: Sequence[float] | None = None,
    lengths: Mapping[str, str] | None = None,
    view: tuple[float, float] = VIEW,
    width: float = WIDTH,
    show: Sequence[str] = ("links", "joints"),
) -> Sketch:
    """Draw an arm as a text describes it: its joint axes with their senses, its lengths, and of its frames {0} alone.

    Parameters
    ----------
    chain : Chain
        The frames after {0} are not drawn.
    title, alt : str
        The caption, and what there is to see for those who do not see it.
    q : sequence of float, optional
        The pose; zeros if left out.
    lengths : mapping of str to str, optional
        Which lengths of the chain's table are lettered, and what the text calls them: ``{"d_1": "height"}``.
    view, width
        As of `dhlib.sketch.sketch`.
    show : sequence of {"links", "joints"}
        Whether to draw the metal, or the axes alone.

    Raises
    ------
    DHError
        If the chain has no such length.

    Examples
    --------
    >>> from dhlib import robots
    >>> drawing = described(robots.quickshot(), "The arm", "An arm.", lengths={"a_2": "upper_arm"})
    >>> [label.text for label in drawing.labels]
    ['axis 1', 'axis 2', 'axis 3', 'axis 4', 'upper_arm', 'x_0', 'y_0', 'z_0']
    """
    figure = draw(chain, np.zeros(chain.n) if q is None else q)
    size = figure.size
    scene = Scene(axis_length=0.2 * size)
    if "links" in show:
        add_arm(scene, figure)
    if "joints" in show:
        for joint in figure.joints:
            scene.add_joint(joint, SYMBOL_LENGTH * size, SYMBOL_RADIUS * size)
    for joints in _on_one_line(figure.joints, 1e-6 * size):
        _add_axis(scene, joints, size)
    letters = dict(lengths or {})
    for segment in (*figure.offsets, *figure.normals):
        if segment.length > NOTHING * size and segment.label in letters:
            scene.add_segment(
                segment.start, segment.end, letters.pop(segment.label), "bare" if "links" in show else "guide"
            )
    if letters:
        raise DHError(f"{chain.name or 'the arm'} shows no length {next(iter(letters))} at this q.")
    scene.add_frame(figure.frames[0].pose, "0")
    return scene.sketch(title, alt, view, width)


def _on_one_line(joints: Sequence[JointSymbol], near: float) -> list[list[JointSymbol]]:
    """Joints whose axes are one line in one sense, together."""
    groups: list[list[JointSymbol]] = []
    for joint in joints:
        for group in groups:
            first = group[0]
            aside = np.cross(joint.foot - first.foot, first.axis)
            if np.linalg.norm(joint.axis - first.axis) < 1e-6 and np.linalg.norm(aside) < near:
                group.append(joint)
                break
        else:
            groups.append([joint])
    return groups


def _add_axis(scene: Scene, joints: Sequence[JointSymbol], size: float) -> None:
    """One line for the axes that lie on it."""
    foot, along = joints[0].foot, joints[0].axis
    heights = [float((point - foot) @ along) for joint in joints for point in (joint.foot, joint.centre)]
    name = "axis" if len(joints) == 1 else "axes"
    label = f"{name} {', '.join(str(joint.index) for joint in joints)}"
    add_axis(scene, foot, along, label, 0.2 * size - min(heights), 0.3 * size + max(heights))


def add_axis(scene: Scene, point: Any, along: Any, label: str, back: float, onward: float) -> None:
    """Add the line of a joint axis, with an arrow for its sense; `along` is a unit vector."""
    point, along = np.asarray(point, dtype=float), np.asarray(along, dtype=float)
    scene.add_line(point, along, label, back, onward)
    tip = point + onward * along
    scene.add_segment(tip - 0.14 * (back + onward) * along, tip, kind="arrow", colour="muted")


def as_cell(sketch: Sketch) -> str:
    """A drawing as the Markdown of a notebook's cell: it needs no other file, and says what it shows.

    Raises
    ------
    DHError
        If it has no title or no alt text.
    """
    if not sketch.title.strip() or not sketch.alt.strip():
        raise DHError("the figure of an exercise should have a title, its caption, and alt text: what there is to see.")
    data = base64.b64encode(sketch.svg("light").encode()).decode()
    return f'<img alt="{escape(sketch.alt)}" src="data:image/svg+xml;base64,{data}">\n\n*{sketch.title}*'


def read_cell(source: str) -> tuple[str, str, str]:
    """The drawing of such a cell: its SVG, its alt text and its caption.

    Raises
    ------
    DHError
        If there is none.

    Examples
    --------
    >>> svg, alt, caption = read_cell(as_cell(Scene().sketch("Nothing", "Nothing to see.")))
    >>> svg[:4], alt, caption
    ('<svg', 'Nothing to see.', 'Nothing')
    """
    found = CELL.fullmatch(source)
    if not found:
        raise DHError("the cell of the figure holds no drawing: run make exercises.")
    alt, data, caption = found.groups()
    return base64.b64decode(data).decode(), unescape(alt), caption
