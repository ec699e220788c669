"""Figures in space as compact SVG: put frames, lines, lengths and angles into a `Scene`, and look at it.

The projection is parallel. Far things are drawn first. Labels find their own places. The SVG takes its colours
from the page (``--dh-x`` and the others of `palette`), so that one drawing serves light, dark and print.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from dhlib.drawing import Arc, Frame, JointSymbol, Segment
from dhlib.errors import DHError
from dhlib.labels import FONT_SIZE, INDEX_SIZE, Label, around, beside, indexed, place, text_svg
from dhlib.palette import BETWEEN, colours
from dhlib.scalars import FloatArray
from dhlib.transforms import read_pose
from dhlib.view import VIEW, View

#: Width of a drawing in its own units; at this width letters are 16 px, indices 12.
WIDTH = 380.0
#: Around the shapes, for labels; the wider one is taken where it makes the labels so much less crowded.
MARGINS = (26.0, 48.0)
WORTH_A_MARGIN = 40.0
#: An arrow that is seen shorter than this points at the reader, or away.
END_ON = 7.0
#: What a segment may be.
KINDS = ("length", "line", "body", "guide", "arrow", "dashed", "bare")
DASHES = {"dashed": "5 4", "axis": "11 3 2 3", "guide": "1.5 3.5"}
THICKNESS = {"arrow": 2.2, "body": 6.0, "length": 7.0, "axis": 1.1, "guide": 1.5, "arc": 1.5, "symbol": 1.3}
#: What bars are edged with, so that they stand out from the ground and axes stand out from them.
RIM = 0.8

Point = FloatArray


@dataclass(frozen=True)
class Sketch:
    """A finished drawing. It shows itself in a notebook; `svg` and `save` give it away.

    Attributes
    ----------
    title, alt : str
        A name, and what there is to see for those who do not see it.
    width, height : float
        Of the view box.
    labels : tuple of Label
        With their places.
    body : str
        SVG without its frame.
    """

    title: str
    alt: str
    width: float
    height: float
    labels: tuple[Label, ...]
    body: str

    def svg(self, theme: str = "") -> str:
        """The drawing as SVG text.

        Parameters
        ----------
        theme : {"", "light", "dark"}
            Empty for colours that follow the page; a theme for a file that stands alone.

        Returns
        -------
        str

        Raises
        ------
        DHError
            If the theme is unknown.
        """
        ground = ""
        if theme:
            ground = f'<rect width="100%" height="100%" fill="{colours(theme)["ground"]}"/>'
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" class="dh-figure" role="img" '
            f'viewBox="0 0 {_number(self.width)} {_number(self.height)}" width="{round(1.2 * self.width)}" '
            f'style="max-width:100%;height:auto"><title>{escape(self.title)}</title><desc>{escape(self.alt)}</desc>'
            f'{ground}<g class="{_scope(theme)}"><style>{_style(theme)}</style>{self.body}</g></svg>'
        )

    def save(self, path: str | Path, theme: str = "light") -> None:
        """Write the drawing to a file, in the colours of a theme."""
        Path(path).write_text(self.svg(theme), encoding="utf-8")

    def __str__(self) -> str:
        return self.svg()

    def __repr__(self) -> str:
        return f"<Sketch {self.title!r}>"

    def _repr_html_(self) -> str:
        return self.svg()

    def _repr_svg_(self) -> str:
        return self.svg()


class Scene:
    """Shapes in space, to be looked at.

    Parameters
    ----------
    axis_length : float
        How long the axes of frames are drawn, in the scene's unit of length.

    Examples
    --------
    >>> from dhlib import Tx
    >>> scene = Scene()
    >>> scene.add_frame(np.eye(4), "0", dashed=True)
    >>> scene.add_frame(Tx(2), "1")
    >>> scene.add_segment([0, 0, 0], [2, 0, 0], "a_1")
    >>> drawing = scene.sketch(title="A step along x", alt="Frame 1 stands at a_1 in front of frame 0.")
    >>> [label.text for label in drawing.labels]
    ['a_1', 'x_0', 'y_0', 'z_0', 'x_1', 'y_1', 'z_1']
    """

    def __init__(self, axis_length: float = 1.0) -> None:
        self.axis_length = axis_length
        self._frames: list[tuple[Frame, str, tuple[str, str, str], bool, float]] = []
        self._segments: list[tuple[Segment, str, str]] = []
        self._lines: list[tuple[Segment, str]] = []
        self._arcs: list[tuple[Arc, float, str]] = []
        self._joints: list[tuple[JointSymbol, float, float]] = []
        self._dots: list[tuple[Point, str, str]] = []
        self._grippers: list[tuple[FloatArray, float]] = []
        self._squares: list[tuple[Point, FloatArray, FloatArray, str]] = []
        self._room: list[Point] = []

    def add_frame(
        self,
        pose: Any,
        name: str = "",
        *,
        dashed: bool = False,
        axes: str = "xyz",
        letters: Sequence[str] = "xyz",
        length: float | None = None,
    ) -> None:
        """Add a frame: three arrows with letters.

        Parameters
        ----------
        pose : array_like (4, 4)
        name : str
            Index of the letters: ``"0"``, ``"i-1"``.
        dashed : bool
            True for the frame before, i-1.
        axes : str
            Which axes are drawn.
        letters : sequence of str
            What x, y and z are called, for example ``"noa"``.
        length : float, optional
            Of the arrows; the scene's own if left out.
        """
        x, y, z = letters
        frame = Frame(read_pose(pose, "the pose of a frame"), name)
        self._frames.append((frame, axes, (x, y, z), dashed, length or self.axis_length))

    def add_segment(self, start: Any, end: Any, label: str = "", kind: str = "length", colour: str = "") -> None:
        """Add a straight piece.

        Parameters
        ----------
        start, end : array_like (3,)
        label : str
            Symbol of its length.
        kind : {"length", "line", "body", "guide", "arrow", "dashed", "bare"}
            A measured length (a broad band, so that an arrow along it stays visible), a plain line, a piece of the
            arm, a thin help line, a vector, a dashed line, or the label alone.
        colour : str
            Name in the palette; ink if empty.
        """
        if kind not in KINDS:
            raise DHError(f"kind={kind!r} is unknown; it should be one of {', '.join(map(repr, KINDS))}.")
        self._segments.append((Segment(_point(start), _point(end), label), kind, colour))

    def add_line(
        self, point: Any, direction: Any, label: str = "", back: float = 1.0, onward: float = 1.0, colour: str = "muted"
    ) -> None:
        """Add a line in space, dash-dotted: from `back` behind the point to `onward` ahead of it."""
        point, direction = _point(point), _unit(direction)
        self._lines.append((Segment(point - back * direction, point + onward * direction, label), colour))

    def add_arc(
        self, centre: Any, axis: Any, start: Any, angle: float, label: str = "", radius: float = 0.0, colour: str = ""
    ) -> None:
        """Add an angle: from the direction `start` about `axis` by the right-hand rule, with an arrow head.

        An angle below one degree is not drawn.
        """
        arc = Arc(_point(centre), _unit(axis), _unit(start), float(angle), label)
        self._arcs.append((arc, radius or 0.55 * self.axis_length, colour))

    def add_joint(self, joint: JointSymbol, length: float, radius: float) -> None:
        """Add the symbol of a joint: a cylinder for a revolute, a block for a prismatic one."""
        self._joints.append((joint, length, radius))

    def add_gripper(self, pose: Any, size: float) -> None:
        """Add a small gripper: it approaches along z and closes along y, the tool point between its fingers."""
        self._grippers.append((read_pose(pose, "the pose of a gripper"), size))

    def add_point(self, point: Any, label: str = "", colour: str = "") -> None:
        """Add a dot with a label."""
        self._dots.append((_point(point), label, colour))

    def add_right_angle(self, corner: Any, one: Any, other: Any, colour: str = "") -> None:
        """Add the small square of a right angle between two directions."""
        self._squares.append((_point(corner), _unit(one), _unit(other), colour))

    def add_room(self, *points: Any) -> None:
        """Keep points in the picture without drawing anything there, so that several pictures share a scale."""
        self._room += [_point(point) for point in points]

    def best_view(self) -> tuple[float, float]:
        """The view near the usual one in which directions stay apart, and none points at the reader.

        Returns
        -------
        (float, float)
            Azimuth and elevation in degrees.
        """
        frames = [frame.axis(letter) for frame, axes, *_ in self._frames for letter in axes]
        pieces = [segment.end - segment.start for segment in self._straight()]
        directions: list[FloatArray] = []
        for vector in [*frames, *(piece / (np.linalg.norm(piece) or 1.0) for piece in pieces)]:
            if all(abs(abs(float(vector @ known)) - 1) > 1e-6 for known in directions) and np.any(vector):
                directions.append(vector)
        if not directions:
            return VIEW
        lines = np.array(directions)
        apart = 1 - (lines @ lines.T) ** 2
        best, least = VIEW, np.inf
        for elevation in (24.0, 18.0, 30.0, 36.0):
            for azimuth in (VIEW[0] + step for step in range(-28, 113, 4)):
                view = View(azimuth, elevation)
                flat = view.project(lines)[:, :2]
                lengths = np.hypot(*flat.T)
                cross = np.outer(flat[:, 0], flat[:, 1])
                sines = (cross - cross.T) / np.maximum(np.outer(lengths, lengths), 1e-9)
                cost = float((1 / (lengths**2 + 0.03)).sum() + np.triu(apart / (sines**2 + 0.02), 1).sum())
                for arc, *_ in self._arcs:
                    cost += 1 / (float(view.project(arc.axis)[2]) ** 2 + 0.05)
                cost *= 1 + 0.004 * abs(azimuth - VIEW[0]) + 0.006 * abs(elevation - VIEW[1])
                if cost < least - 1e-9:
                    best, least = (azimuth, elevation), cost
        return best

    def svg(self, title: str = "", alt: str = "", view: tuple[float, float] | None = VIEW, width: float = WIDTH) -> str:
        """The scene as SVG text; parameters as for :meth:`sketch`."""
        return self.sketch(title, alt, view, width).svg()

    def sketch(
        self,
        title: str = "",
        alt: str = "",
        view: tuple[float, float] | None = VIEW,
        width: float = WIDTH,
        height: float = 0.0,
        caption: str = "",
    ) -> Sketch:
        """Look at the scene.

        Parameters
        ----------
        title, alt : str
            Name of the drawing, and what it shows.
        view : (float, float) or None
            Azimuth and elevation of the eye in degrees; None for :meth:`best_view`.
        width, height : float
            Room for the drawing, in its own units; the height is as the scene needs it if 0, and at most 1.15
            times the width.
        caption : str
            A line below the drawing.

        Returns
        -------
        Sketch
        """
        below = 1.5 * FONT_SIZE if caption else 0.0
        seen = View(*(view or self.best_view()))
        room = width, height or 1.15 * width
        narrow, wide = (self._drawn(seen, room, below, margin) for margin in MARGINS)
        crowd, easier = narrow.place_labels(), wide.place_labels()
        canvas = wide if easier < crowd - WORTH_A_MARGIN else narrow
        return canvas.finish(title, alt, caption)

    def _drawn(self, view: View, room: tuple[float, float], below: float, margin: float) -> _Canvas:
        canvas = _Canvas(view, self._points(), room, below, margin)
        for line, colour in self._lines:
            canvas.axis_line(line, colour)
        for joint, length, radius in self._joints:
            canvas.joint(joint, length, radius)
        for pose, size in self._grippers:
            canvas.gripper(pose, size)
        for segment, kind, colour in self._segments:
            canvas.segment(segment, kind, colour)
        for arc, radius, colour in self._arcs:
            canvas.arc(arc, radius, colour)
        for corner, one, other, colour in self._squares:
            canvas.right_angle(corner, one, other, colour, 0.16 * self.axis_length)
        for point, label, colour in self._dots:
            canvas.dot(point, label, colour)
        for arrow in _merged_arrows(self._frames):
            canvas.arrow(arrow)
        for frame, *_ in self._frames:
            canvas.dot(frame.origin, "", "")
        return canvas

    def _straight(self) -> list[Segment]:
        return [segment for segment, *_ in self._segments] + [line for line, _ in self._lines]

    def _points(self) -> FloatArray:
        points = list(self._room)
        for frame, axes, _, _, length in self._frames:
            points += [frame.origin, *(frame.origin + length * frame.axis(letter) for letter in axes)]
        for segment in self._straight():
            points += [segment.start, segment.end]
        for arc, radius, _ in self._arcs:
            points += list(arc.points(radius))
        points += [joint.centre for joint, *_ in self._joints] + [point for point, *_ in self._dots]
        points += [pose[:3, 3] for pose, _ in self._grippers]
        return np.array(points) if points else np.zeros((1, 3))


@dataclass(frozen=True, eq=False)
class _Arrow:
    """One or more axes that coincide, as one arrow; `shift` moves it aside from an arrow of another letter."""

    start: Point
    end: Point
    label: str
    colour: str
    dashed: bool
    shift: float = 0.0


def _merged_arrows(frames: Sequence[tuple[Frame, str, tuple[str, str, str], bool, float]]) -> list[_Arrow]:
    """The arrows of all frames, those that coincide drawn once: alike ones together, unlike ones side by side."""
    groups: list[tuple[Point, FloatArray, list[tuple[str, str, bool, float]]]] = []
    for frame, axes, letters, dashed, length in frames:
        for name, letter in zip("xyz", letters, strict=True):
            if name not in axes:
                continue
            direction = frame.axis(name)
            entry = (name, indexed(letter, frame.name), dashed, length)
            for origin, along, entries in groups:
                if np.linalg.norm(origin - frame.origin) < 1e-6 * length and np.linalg.norm(along - direction) < 1e-6:
                    entries.append(entry)
                    break
            else:
                groups.append((frame.origin, direction, [entry]))
    arrows = []
    for origin, along, entries in groups:
        names = sorted({name for name, *_ in entries})
        for k, name in enumerate(names):
            mine = [entry for entry in entries if entry[0] == name]
            arrows.append(
                _Arrow(
                    origin,
                    origin + max(entry[3] for entry in mine) * along,
                    ", ".join(entry[1] for entry in mine),
                    name,
                    all(entry[2] for entry in mine),
                    k - (len(names) - 1) / 2,
                )
            )
    return arrows


class _Canvas:
    """Where shapes become strokes and letters."""

    def __init__(self, view: View, points: FloatArray, room: tuple[float, float], below: float, margin: float) -> None:
        width, height = room
        self.view = view
        self.below = below
        flat = view.project(points)[:, :2]
        low, high = flat.min(0), flat.max(0)
        extent = np.maximum(high - low, 1e-12)
        self.scale = float(((np.array([width, height - below]) - 2 * margin) / extent).min())
        self.width = width
        self.height = min(height - below, float(extent[1] * self.scale) + 2 * margin)
        self.shift = np.array([width, self.height]) / 2 - self.scale * (low + high) / 2
        self.strokes: list[tuple[int, float, str]] = []
        self.lines: list[tuple[float, float, float, float, float]] = []
        self.labels: list[Label] = []

    def flat(self, point: Any) -> tuple[FloatArray, float]:
        """Where points are seen, (…, 2), and how near the nearest of them is."""
        seen = self.view.project(point)
        return seen[..., :2] * self.scale + self.shift, float(np.max(seen[..., 2]))

    def stroke(self, layer: int, depth: float, svg: str) -> None:
        self.strokes.append((layer, round(depth, 9), svg))

    def keep_free(self, points: FloatArray, thickness: float) -> None:
        for (x0, y0), (x1, y1) in pairwise(points):
            self.lines.append((x0, y0, x1, y1, thickness / 2))

    def axis_line(self, line: Segment, colour: str) -> None:
        ends, _ = self.flat([line.start, line.end])
        self.stroke(0, 0, f'<path class="{colour} ax" d="{_path(ends)}"/>')
        self.keep_free(ends, 1)
        if line.label:
            along = _direction(ends[1] - ends[0])
            places = around(ends[1], along) + [(p, d, c + 6) for p, d, c in around(ends[0], -along)]
            self.labels.append(Label(line.label, colour, places))

    def segment(self, segment: Segment, kind: str, colour: str) -> None:
        ends, depth = self.flat([segment.start, segment.end])
        if kind == "body":
            self._bar(ends, depth)
        elif kind == "arrow":
            self._arrow_svg(4, depth, ends, colour, dashed=False)
        elif kind == "length":
            for mark in ("le", "lg", "l"):
                self.stroke(1, depth, f'<path class="{_join(colour, mark)}" d="{_path(ends)}"/>')
        elif kind != "bare":
            mark = {"line": "", "guide": "gu", "dashed": "da"}[kind]
            self.stroke(3, depth, f'<path class="{_join(colour, mark)}" d="{_path(ends)}"/>')
        self.keep_free(ends, THICKNESS["body"] if kind in ("body", "bare", "length") else 2)
        if segment.label:
            self.labels.append(Label(segment.label, colour, beside(*ends)))

    def _bar(self, ends: FloatArray, depth: float) -> None:
        """A piece of a link; all rims lie below all bars, so that pieces that meet have one rim."""
        self.stroke(1, -math.inf, f'<path class="muted br" d="{_path(ends)}"/>')
        self.stroke(1, depth, f'<path class="body b" d="{_path(ends)}"/>')

    def arc(self, arc: Arc, radius: float, colour: str) -> None:
        if abs(arc.angle) < np.deg2rad(1):
            return
        points, depth = self.flat(arc.points(radius))
        self.stroke(3, depth, f'<path class="{_join(colour, "ar")}" d="{_path(points)}"/>')
        if np.hypot(*np.diff(points, axis=0).T).sum() > 12:
            self._head(3, depth, points[-1], _direction(points[-1] - points[-2]), colour, 7)
        self.keep_free(points, 2)
        if arc.label:
            centre, _ = self.flat(arc.centre)
            places = []
            for part, cost in ((0.5, 0), (0.35, 1), (0.65, 1), (0.2, 3), (0.8, 3)):
                at = points[round(part * (len(points) - 1))]
                places += [(p, d, c + cost) for p, d, c in around(at, _direction(at - centre))]
            self.labels.append(Label(arc.label, colour, places))

    def joint(self, joint: JointSymbol, length: float, radius: float) -> None:
        foot = joint.foot
        if np.linalg.norm(joint.centre - foot) > 1e-9 * length:
            ends, depth = self.flat([foot, joint.centre])
            self._bar(ends, depth)
            self.keep_free(ends, THICKNESS["body"])
        _, depth = self.flat(joint.centre)
        half = length / 2 * joint.axis
        near, far = (half, -half) if self.view.project(half)[2] >= 0 else (-half, half)
        caps, _ = self.flat([joint.centre + near, joint.centre + far])
        draw = self._cylinder if joint.kind == "R" else self._block
        outline = draw(joint, caps, near, far, radius, depth)
        self.keep_free(np.array(outline), 2)
        self.keep_free(caps, 2 * radius * self.scale)

    def _cylinder(
        self, joint: JointSymbol, caps: FloatArray, near: Point, far: Point, radius: float, depth: float
    ) -> FloatArray:
        r = radius * self.scale
        toward = abs(float(self.view.project(joint.axis)[2]))
        across = caps[0] - caps[1]
        turn = float(np.rad2deg(np.arctan2(across[1], across[0]))) + 90 if np.hypot(*across) > 1e-9 else 0.0
        side = _direction(np.array([-across[1], across[0]])) * r
        a, b, c, d = caps[0] + side, caps[1] + side, caps[1] - side, caps[0] - side
        ellipse = f"A{_number(r)} {_number(r * toward)} {_number(turn)}"
        hull = f"M{_xy(a)}L{_xy(b)}{ellipse} 0 1 {_xy(c)}L{_xy(d)}{ellipse} 0 1 {_xy(a)}"
        cap = f"M{_xy(a)}{ellipse} 0 0 {_xy(d)}"
        self.stroke(2, depth, f'<path class="jo" d="{hull}"/><path class="jl" d="{cap}"/>')
        return np.array([a, b, c, d, a])

    def _block(
        self, joint: JointSymbol, caps: FloatArray, near: Point, far: Point, radius: float, depth: float
    ) -> FloatArray:
        one = np.cross(joint.axis, [1.0, 0, 0] if abs(joint.axis[0]) < 0.9 else [0, 1.0, 0])
        one /= np.linalg.norm(one)
        other = np.cross(joint.axis, one)
        ends = [near, far, radius * one, -radius * one, radius * other, -radius * other]
        faces = []
        for k in range(3):
            u, v, w = ends[2 * k], ends[(2 * k + 2) % 6], ends[(2 * k + 4) % 6]
            for sign in (1, -1):
                if self.view.project(sign * u)[2] > 1e-9 * radius:
                    corners = [joint.centre + sign * u + p * v + s * w for p, s in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
                    faces.append(self.flat(corners)[0])
        svg = "".join(_path(face) + "z" for face in faces)
        self.stroke(2, depth, f'<path class="jo" d="{svg}"/>')
        return np.concatenate([np.vstack([face, face[:1]]) for face in faces])

    def gripper(self, pose: FloatArray, size: float) -> None:
        y, z, p = size * pose[:3, 1], size * pose[:3, 2], pose[:3, 3]
        points, depth = self.flat([p + 0.5 * y, p + 0.5 * y - 0.7 * z, p - 0.5 * y - 0.7 * z, p - 0.5 * y])
        self.stroke(1, depth, f'<path class="muted gr" d="{_path(points)}"/>')
        self.keep_free(points, 4)

    def right_angle(self, corner: Point, one: FloatArray, other: FloatArray, colour: str, size: float) -> None:
        points, depth = self.flat([corner + size * one, corner + size * (one + other), corner + size * other])
        self.stroke(3, depth, f'<path class="{_join(colour, "ar")}" d="{_path(points)}"/>')
        self.keep_free(points, 1)

    def dot(self, point: Point, label: str, colour: str) -> None:
        (x, y), depth = self.flat(point)
        self.stroke(5, depth, f'<circle class="{_join(colour, "h")}" cx="{_number(x)}" cy="{_number(y)}" r="2.6"/>')
        self.keep_free(np.array([[x - 2, y], [x + 2, y]]), 5)
        if label:
            places = around(np.array([x, y]), np.array([0.7, -0.7]))
            self.labels.append(Label(label, colour, places))

    def arrow(self, arrow: _Arrow) -> None:
        ends, depth = self.flat([arrow.start, arrow.end])
        along = ends[1] - ends[0]
        length = float(np.hypot(*along))
        if length < END_ON:
            toward = self.view.project(arrow.end - arrow.start)[2] > 0
            self._end_on(ends[0], depth, arrow, toward)
            return
        aside = 3.2 * arrow.shift * np.array([along[1], -along[0]]) / length
        ends = ends + aside
        self._arrow_svg(4, depth, ends, arrow.colour, arrow.dashed)
        self.keep_free(ends, THICKNESS["arrow"])
        places = around(ends[1], _direction(along))
        for part in (0.75, 0.55):
            at = ends[0] + part * along
            normal = np.array([along[1], -along[0]]) / length
            places += [(at, normal, 5 + 10 * (0.75 - part)), (at, -normal, 5 + 10 * (0.75 - part))]
        self.labels.append(Label(arrow.label, arrow.colour, places))

    def _end_on(self, at: FloatArray, depth: float, arrow: _Arrow, toward: bool) -> None:
        """An axis that points at the reader: a ring with a dot; away from the reader: a ring with a cross."""
        x, y = at
        ring = f'<circle class="ring" cx="{_number(x)}" cy="{_number(y)}" r="6"/>'
        if toward:
            ring += f'<circle class="h" cx="{_number(x)}" cy="{_number(y)}" r="2.2"/>'
        else:
            ring += f'<path d="M{_xy(at - 4.2)}l8.4 8.4M{_xy(at + [4.2, -4.2])}l-8.4 8.4"/>'
        self.stroke(6, depth, f'<g class="{arrow.colour}">{ring}</g>')
        self.keep_free(np.array([[x - 6, y], [x + 6, y]]), 12)
        self.labels.append(
            Label(arrow.label, arrow.colour, [(at + 6 * d, d, c) for _, d, c in around(at, np.array([-0.7, 0.7]))])
        )

    def _arrow_svg(self, layer: int, depth: float, ends: FloatArray, colour: str, dashed: bool) -> None:
        direction = _direction(ends[1] - ends[0])
        shaft = np.stack([ends[0], ends[1] - 6 * direction])
        self.stroke(layer, depth, f'<path class="{_join(colour, "da" if dashed else "")}" d="{_path(shaft)}"/>')
        self._head(layer, depth, ends[1], direction, colour, 10)

    def _head(self, layer: int, depth: float, tip: FloatArray, direction: FloatArray, colour: str, size: float) -> None:
        across = np.array([-direction[1], direction[0]])
        points = np.stack(
            [tip, tip - size * direction + 0.36 * size * across, tip - size * direction - 0.36 * size * across]
        )
        self.stroke(layer, depth, f'<path class="{_join(colour, "h")}" d="{_path(points)}z"/>')

    def place_labels(self) -> float:
        """Find the places of all labels; return how crowded it is."""
        lines = np.array(self.lines).reshape(-1, 5)
        return place(self.labels, lines, (2.0, 2.0, self.width - 2, self.height - 2))

    def finish(self, title: str, alt: str, caption: str) -> Sketch:
        letters = "".join(
            f'<text{_class(label.colour)} x="{_number(label.centre[0])}" '
            f'y="{_number(label.centre[1] + 0.33 * label.size)}">{text_svg(label.text)}</text>'
            for label in self.labels
        )
        if caption:
            self.labels.append(Label(caption, "", [], centre=np.array([self.width / 2, self.height + self.below / 2])))
            at = f'x="{_number(self.width / 2)}" y="{_number(self.height + 0.7 * self.below)}"'
            letters += f"<text {at}>{text_svg(caption)}</text>"
        strokes = "".join(svg for _, _, svg in sorted(self.strokes, key=lambda stroke: stroke[:2]))
        return Sketch(title, alt, self.width, self.height + self.below, tuple(self.labels), strokes + letters)


def beside_each_other(sketches: Sequence[Sketch], title: str, alt: str, columns: int = 2, gap: float = 4.0) -> Sketch:
    """Several drawings as one, row by row.

    Parameters
    ----------
    sketches : sequence of Sketch
    title, alt : str
        Of the whole.
    columns : int
        How many stand in a row. Two can be read on a phone.
    gap : float
        Between them.

    Returns
    -------
    Sketch
    """
    body, labels = [], []
    y = width = 0.0
    for first in range(0, len(sketches), columns):
        row = sketches[first : first + columns]
        x, height = 0.0, max(sketch.height for sketch in row)
        for sketch in row:
            corner = np.array([x, y + height - sketch.height])
            body.append(f'<g transform="translate({_xy(corner)})">{sketch.body}</g>')
            labels += [
                Label(label.text, label.colour, [], label.size, label.centre + corner) for label in sketch.labels
            ]
            x += sketch.width + gap
        width, y = max(width, x - gap), y + height + gap
    return Sketch(title, alt, width, y - gap, tuple(labels), "".join(body))


def _scope(theme: str) -> str:
    return f"dh-sketch-{theme}" if theme else "dh-sketch"


def _style(theme: str) -> str:
    """The style sheet of a drawing; the same for every drawing of a page, so that none disturbs another."""
    scope = f".{_scope(theme)}"
    rules = [
        f"{{fill:none;stroke:currentColor;stroke-width:{THICKNESS['arrow']};stroke-linecap:round;stroke-linejoin:round"
        + (f";color:{colours(theme)['ink']}" if theme else "")
        + "}",
        f" text{{fill:currentColor;stroke:none;font-size:{FONT_SIZE:g}px;text-anchor:middle}}",
        " .i{font-style:italic}",
        f" .s{{font-size:{INDEX_SIZE:g}em}}",
        " .h{fill:currentColor;stroke:none}",
        f" circle.h{{stroke:{_colour('ground', theme)};stroke-width:1.6;paint-order:stroke}}",
        f" .da{{stroke-dasharray:{DASHES['dashed']};stroke-linecap:butt}}",
        f" .ax{{stroke-dasharray:{DASHES['axis']};stroke-width:{THICKNESS['axis']};stroke-linecap:butt}}",
        f" .gu{{stroke-dasharray:{DASHES['guide']};stroke-width:{THICKNESS['guide']}}}",
        f" .ar{{stroke-width:{THICKNESS['arc']}}}",
        " .gr{stroke-width:2.6}",
        f" .b{{stroke-width:{THICKNESS['body']}}}",
        f" .br{{stroke-width:{THICKNESS['body'] + 2 * RIM}}}",
        f" .le{{stroke-width:{THICKNESS['length'] + 2 * RIM};stroke-linecap:butt}}",
        f" .lg{{stroke:{_colour('ground', theme)};stroke-width:{THICKNESS['length']};stroke-linecap:butt}}",
        f" .l{{stroke-width:{THICKNESS['length']};stroke-linecap:butt;opacity:.3}}",
        f" .jo{{fill:{_colour('faint', theme)};stroke:{_colour('muted', theme)};stroke-width:{THICKNESS['symbol']}}}",
        f" .jl{{stroke:{_colour('muted', theme)};stroke-width:{THICKNESS['symbol']}}}",
        f" .ring{{fill:{_colour('ground', theme)};stroke-width:1.8}}",
        *(f" .{name}{{color:{_colour(name, theme)}}}" for name in (*BETWEEN, "body")),
    ]
    return "".join(scope + rule for rule in rules)


def _colour(name: str, theme: str) -> str:
    """A colour of a theme; or the page's own, and one that suits its text where the page has none."""
    if theme:
        return colours(theme)[name]
    if name in BETWEEN:
        return f"var(--dh-{name},color-mix(in srgb,{BETWEEN[name]} 72%,currentColor))"
    other = {"ground": "none", "faint": "#a9b2bd", "body": "#8d97a5"}[name]
    return f"var(--dh-{name},{other})"


def _class(colour: str) -> str:
    return f' class="{colour}"' if colour else ""


def _join(*classes: str) -> str:
    return " ".join(name for name in classes if name)


def _number(value: float) -> str:
    """A coordinate with at most one decimal."""
    return f"{round(float(value), 1) + 0.0:.1f}".removesuffix(".0")


def _xy(point: Any) -> str:
    return f"{_number(point[0])} {_number(point[1])}"


def _path(points: FloatArray) -> str:
    return "M" + "L".join(_xy(point) for point in points)


def _direction(vector: FloatArray) -> FloatArray:
    length = float(np.hypot(*vector))
    return np.asarray(vector / length if length > 1e-9 else np.array([0.0, -1.0]))


def _point(value: Any) -> Point:
    point = np.asarray(value, dtype=np.float64)
    if point.shape != (3,) or not np.all(np.isfinite(point)):
        raise DHError(f"a point of a scene is {value!r}; it should be three finite numbers.")
    return point


def _unit(value: Any) -> FloatArray:
    vector = _point(value)
    length = float(np.linalg.norm(vector))
    if length < 1e-12:
        raise DHError("a direction in a scene is (0, 0, 0); it should point somewhere.")
    return vector / length
