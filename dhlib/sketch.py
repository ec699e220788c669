"""The figures of the book, ready made: an arm, one link and its four steps, a pose, two lines in space, DH1 and DH2.

Frame i-1 is dashed, frame i is solid. Angles and lengths about and along z carry the colour of z, those about and
along x the colour of x.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from dhlib.axes import Axis
from dhlib.drawing import NOTHING, SYMBOL_LENGTH, SYMBOL_RADIUS, Drawing, draw
from dhlib.errors import DHError
from dhlib.labels import indexed
from dhlib.normals import common_normal
from dhlib.preconditions import check_frames
from dhlib.scene import WIDTH, Scene, Sketch, beside_each_other
from dhlib.show import number_text
from dhlib.transforms import Rx, Ry, Rz, Tx, Ty, Tz, read_pose
from dhlib.view import VIEW

if TYPE_CHECKING:
    from dhlib.chain import Chain

PARTS = ("links", "joints", "frames", "lengths", "axes", "angles")
ViewAngles = tuple[float, float]


def sketch(
    chain: Chain,
    q: Any,
    *,
    show: Sequence[str] = ("links", "joints", "frames", "lengths"),
    axes: str = "xz",
    view: ViewAngles = VIEW,
    width: float = WIDTH,
    title: str = "",
    alt: str = "",
) -> Sketch:
    """Draw an arm at one joint vector, with every frame.

    Parameters
    ----------
    chain : Chain
    q : array_like (n,)
    show : sequence of {"links", "joints", "frames", "lengths", "axes", "angles"}
        Parts of the figure: the arm as grey bars; cylinders (revolute) and blocks (prismatic); the frames; the
        symbols a and d of the lengths that are not zero; the joint axes as lines; the angles θ and α.
    axes : str
        Which axes of the frames; y follows from x and z, and is left out to keep the picture clear.
    view : (float, float)
        Azimuth and elevation of the eye in degrees.
    width : float
        Of the view box.
    title, alt : str
        The arm's name, and a description, if left out.

    Returns
    -------
    Sketch

    Raises
    ------
    DHError
        If q is not one joint vector of numbers that fits the chain, or a part is unknown.

    Examples
    --------
    >>> from dhlib import robots
    >>> drawing = sketch(robots.quickshot(), [0, 0, 0, 0])
    >>> drawing
    <Sketch 'Quickshot'>
    >>> drawing.svg().startswith("<svg")
    True
    """
    unknown = [part for part in show if part not in PARTS]
    if unknown:
        raise DHError(f"show holds {unknown[0]!r}; it may hold {', '.join(map(repr, PARTS))}.")
    if not axes or any(letter not in "xyz" for letter in axes):
        raise DHError(f"axes={axes!r} is unknown; it should be some of the letters x, y and z.")
    figure = draw(chain, q)
    scene = Scene(axis_length=0.17 * figure.size)
    if "links" in show:
        add_arm(scene, figure)
    if "joints" in show:
        for joint in figure.joints:
            scene.add_joint(joint, SYMBOL_LENGTH * figure.size, SYMBOL_RADIUS * figure.size)
    if "lengths" in show:
        for segment in (*figure.offsets, *figure.normals):
            if segment.length > NOTHING * figure.size:
                scene.add_segment(segment.start, segment.end, segment.label, "bare" if "links" in show else "length")
    if "axes" in show:
        for joint in figure.joints:
            reach = 0.3 * figure.size
            scene.add_line(joint.foot, joint.axis, str(joint.index), reach, reach)
    if "angles" in show:
        for arcs, colour in ((figure.angles, "z"), (figure.twists, "x")):
            for arc in arcs:
                scene.add_arc(arc.centre, arc.axis, arc.start, arc.angle, arc.label, colour=colour)
    if "frames" in show:
        for frame in figure.frames:
            scene.add_frame(frame.pose, frame.name, axes=axes)
    return scene.sketch(title or chain.name or f"An arm {chain.kinds}", alt or describe(chain, q), view, width)


def describe(chain: Chain, q: Any) -> str:
    """What a drawing of the chain shows, in words, for those who do not see it.

    Examples
    --------
    >>> from dhlib import robots
    >>> describe(robots.planar(2), [0, 0])
    'Planar 2R with its frames 0 to 2 in the classic convention, at q = (0, 0). At one point: none. Lengths: a_1, a_2.'
    """
    figure = draw(chain, q)
    together: list[list[str]] = []
    for frame in figure.frames:
        for group in together:
            if np.linalg.norm(figure.frames[int(group[0])].origin - frame.origin) < 1e-6 * figure.size:
                group.append(frame.name)
                break
        else:
            together.append([frame.name])
    shared = "; ".join(" and ".join(group) for group in together if len(group) > 1) or "none"
    lengths = [
        segment.label for segment in (*figure.offsets, *figure.normals) if segment.length > NOTHING * figure.size
    ]
    values = ", ".join(number_text(round(float(value), 4)) for value in q)
    return (
        f"{chain.name or 'An arm'} with its frames 0 to {chain.n} in the {chain.convention} convention, "
        f"at q = ({values}). At one point: {shared}. Lengths: {', '.join(sorted(lengths)) or 'none'}."
    )


def link(
    chain: Chain,
    i: int,
    q: Any,
    *,
    names: tuple[str, str] | None = None,
    view: ViewAngles | None = None,
    width: float = WIDTH,
    title: str = "",
    alt: str = "",
) -> Sketch:
    """Draw one link: frame i-1 dashed, frame i, and the four parameters between them.

    Parameters
    ----------
    chain : Chain
    i : int
        Number of the link, from 1 to n.
    q : array_like (n,)
    names : (str, str), optional
        What the frames are called: ``("i-1", "i")`` for a link in general; their numbers if left out.
    view, width, title, alt
        As for :func:`sketch`; the view is the clearest one if left out.

    Returns
    -------
    Sketch

    Raises
    ------
    DHError
        If there is no link i, or q does not fit.

    Examples
    --------
    >>> from dhlib import robots
    >>> [label.text for label in link(robots.quickshot(), 1, [0.5, 0, 0, 0]).labels]
    ['axis 1', 'axis 2', 'd_1', 'a_1', 'θ_1', 'α_1', 'x_0', 'y_0', 'z_0', 'x_1', 'y_1', 'z_1']
    """
    scene, text = _link_scene(chain, i, q, names)
    return scene.sketch(title or f"Link {text['i']}", alt or _link_alt(chain, text), view, width)


def _link_scene(chain: Chain, i: int, q: Any, names: tuple[str, str] | None) -> tuple[Scene, dict[str, str]]:
    chain._check_index(i, 1, "link")
    figure = draw(chain, q)
    before, after = figure.frames[i - 1], figure.frames[i]
    offset, normal = figure.offsets[i - 1], figure.normals[i - 1]
    angle, twist = figure.angles[i - 1], figure.twists[i - 1]
    text = _indices(chain.convention, names or (before.name, after.name))
    size = max(offset.length, normal.length) or 1.0
    scene = Scene(axis_length=0.5 * size)
    reach = 0.62 * size
    for frame, axis in ((before, text["axis before"]), (after, text["axis after"])):
        origin = frame.origin
        back = max(reach, float((origin - offset.end) @ frame.axis("z")) + 0.3 * size)
        onward = max(reach, float((offset.end - origin) @ frame.axis("z")) + 0.3 * size)
        scene.add_line(origin, frame.axis("z"), f"axis {axis}", back, onward)
    if offset.length > NOTHING * size:
        scene.add_segment(offset.start, offset.end, indexed("d", text["joint"]), colour="z")
    if normal.length > NOTHING * size:
        scene.add_segment(normal.start, normal.end, indexed("a", text["link"]), colour="x")
    for arc, symbol, colour in ((angle, indexed("θ", text["joint"]), "z"), (twist, indexed("α", text["link"]), "x")):
        if abs(arc.angle) > np.deg2rad(1):
            scene.add_segment(arc.centre, arc.centre + 0.45 * size * arc.start, kind="guide", colour="muted")
            turned = arc.points(0.45 * size)[-1]
            scene.add_segment(arc.centre, turned, kind="guide", colour="muted")
            scene.add_arc(arc.centre, arc.axis, arc.start, arc.angle, symbol, 0.33 * size, colour)
    scene.add_frame(before.pose, text["before"], dashed=True)
    scene.add_frame(after.pose, text["i"])
    return scene, text


def _indices(convention: str, names: tuple[str, str]) -> dict[str, str]:
    """Which index stands at which symbol. ``i+1`` is the axis after frame i of a classic link."""
    before, after = names
    onward = str(int(after) + 1) if after.isdigit() else f"{after}+1"
    classic = convention == "classic"
    return {
        "before": before,
        "i": after,
        "joint": after,
        "link": after if classic else before,
        "axis before": after if classic else before,
        "axis after": onward if classic else after,
    }


def _link_alt(chain: Chain, text: dict[str, str]) -> str:
    first, then = (
        (f"along z_{text['before']} by d_{text['joint']}", f"along x_{text['i']} by a_{text['link']}")
        if chain.convention == "classic"
        else (f"along x_{text['before']} by a_{text['link']}", f"along z_{text['i']} by d_{text['joint']}")
    )
    return (
        f"Frame {text['before']} (dashed) and frame {text['i']} of a link in the {chain.convention} convention: "
        f"from one to the other {first}, then {then}. θ_{text['joint']} is the angle "
        f"from x_{text['before']} to x_{text['i']}, "
        f"α_{text['link']} the angle from z_{text['before']} to z_{text['i']}."
    )


def steps(
    chain: Chain,
    i: int,
    q: Any,
    *,
    names: tuple[str, str] | None = None,
    columns: int = 2,
    view: ViewAngles | None = None,
    width: float = WIDTH,
    title: str = "",
    alt: str = "",
) -> Sketch:
    """Draw the four steps of one link in four small pictures: frame i-1 stays, dashed, and a copy of it moves.

    Parameters
    ----------
    chain, i, q, names, view, width, title, alt
        As for :func:`link`; the width is that of the whole.
    columns : int
        Pictures in a row: 2 can be read on a phone, 4 need twice the width.

    Returns
    -------
    Sketch

    Raises
    ------
    DHError
        As for :func:`link`.

    Examples
    --------
    >>> from dhlib import robots
    >>> drawing = steps(robots.quickshot(), 1, [0.5, 0, 0, 0])
    >>> [label.text for label in drawing.labels if "(" in label.text]
    ['R_z(θ_1)', 'T_z(d_1)', 'T_x(a_1)', 'R_x(α_1)']
    """
    chain._check_index(i, 1, "link")
    figure = draw(chain, q)
    text = _indices(chain.convention, names or (str(i - 1), str(i)))
    offset, normal = figure.offsets[i - 1], figure.normals[i - 1]
    start = figure.frames[i - 1].pose
    theta, alpha = figure.angles[i - 1].angle, figure.twists[i - 1].angle
    d = float((offset.end - offset.start) @ figure.angles[i - 1].axis)
    a = float((normal.end - normal.start) @ figure.twists[i - 1].axis)
    size = max(offset.length, normal.length) or 1.0
    joint, own = text["joint"], text["link"]
    about_z = [("z", Rz(theta), indexed("θ", joint), theta), ("z", Tz(d), indexed("d", joint), None)]
    about_x = [("x", Tx(a), indexed("a", own), None), ("x", Rx(alpha), indexed("α", own), alpha)]
    moves = about_z + about_x if chain.convention == "classic" else [*reversed(about_x), *about_z]
    poses = [start]
    for _, motion, *_ in moves:
        poses.append(poses[-1] @ motion)
    corners = [pose[:3, 3] + 0.62 * size * pose[:3, k] for pose in poses for k in range(3)]
    view = view or _link_scene(chain, i, q, names)[0].best_view()
    pictures = []
    for step, (axis, _, symbol, angle) in enumerate(moves, 1):
        scene = Scene(axis_length=0.62 * size)
        scene.add_room(*corners)
        for k in range(step - 1):
            if np.linalg.norm(poses[k + 1][:3, 3] - poses[k][:3, 3]) > NOTHING * size:
                scene.add_segment(poses[k][:3, 3], poses[k + 1][:3, 3], kind="guide", colour="muted")
        was, now = poses[step - 1], poses[step]
        along = was[:3, "xyz".index(axis)]
        if angle is None and np.linalg.norm(now[:3, 3] - was[:3, 3]) > NOTHING * size:
            scene.add_segment(was[:3, 3], now[:3, 3], symbol, colour=axis)
        elif angle is not None and abs(angle) > np.deg2rad(1):
            zero = was[:3, 0 if axis == "z" else 2]
            if step > 1:
                scene.add_segment(was[:3, 3], was[:3, 3] + 0.5 * size * zero, kind="guide", colour="muted")
            scene.add_arc(was[:3, 3], along, zero, angle, symbol, 0.42 * size, axis)
        scene.add_frame(start, text["before"], dashed=True)
        primes = "′" * step
        last = step == len(moves)
        scene.add_frame(now, text["i"] if last else "", letters="xyz" if last else [f"{x}{primes}" for x in "xyz"])
        operation = "T" if angle is None else "R"
        pictures.append(scene.sketch(view=view, width=width / columns - 4, caption=f"{operation}_{axis}({symbol})"))
    order = ", ".join(f"{'T' if angle is None else 'R'}_{axis} by {symbol}" for axis, _, symbol, angle in moves)
    order = order.replace("{", "").replace("}", "")
    return beside_each_other(
        pictures,
        title or f"The four steps of link {text['i']}",
        alt or f"Four pictures. Frame {text['before']} is dashed; a copy of it moves to frame {text['i']}: {order}.",
        columns,
    )


def right_handed(*, view: ViewAngles = VIEW, width: float = WIDTH, title: str = "", alt: str = "") -> Sketch:
    """Draw the three right-handed configurations: one frame with z, x or y upwards.

    Examples
    --------
    >>> len(right_handed().labels)
    9
    """
    pictures = []
    for turn in range(3):
        pose = np.eye(4)
        pose[:3, :3] = np.roll(np.eye(3), turn, axis=1)
        scene = Scene()
        scene.add_frame(pose)
        pictures.append(scene.sketch(view=view, width=width / 3 - 3))
    return beside_each_other(
        pictures,
        title or "Right-handed frames",
        alt or "Three right-handed frames, with z, x and y pointing up: one frame turned, so x × y = z in all.",
        3,
    )


def pose(
    pose: Any,
    *,
    view: ViewAngles | None = None,
    width: float = WIDTH,
    title: str = "",
    alt: str = "",
) -> Sketch:
    """Draw a pose: frame 0, the position p of the tool, and the tool's axes n, o, a.

    Parameters
    ----------
    pose : array_like (4, 4)
    view, width, title, alt
        As for :func:`sketch`; the view is the clearest one if left out.

    Returns
    -------
    Sketch

    Examples
    --------
    >>> from dhlib import Tx
    >>> [label.text for label in globals()["pose"](Tx(2)).labels]
    ['p', 'x_0', 'y_0', 'z_0', 'n', 'o', 'a']
    """
    there = read_pose(pose, "the pose")
    distance = float(np.linalg.norm(there[:3, 3])) or 1.0
    scene = Scene(axis_length=0.36 * distance)
    scene.add_segment([0, 0, 0], there[:3, 3], "p", "arrow")
    scene.add_gripper(there, 0.14 * distance)
    scene.add_frame(np.eye(4), "0")
    scene.add_frame(there, letters="noa")
    return scene.sketch(
        title or "A pose",
        alt
        or "Frame 0 and a gripper. An arrow p goes from the origin to the point between its fingers. There stand n, o "
        "and a: a points where the gripper approaches, o where its fingers close, and n = o × a.",
        view,
        width,
    )


def two_lines(
    one: Axis,
    other: Axis,
    *,
    labels: tuple[str, str] = ("axis i", "axis i+1"),
    index: str = "i",
    view: ViewAngles | None = None,
    width: float = WIDTH,
    title: str = "",
    alt: str = "",
) -> Sketch:
    """Draw two lines in space, their common normal of length a, and the twist α between them.

    Parameters
    ----------
    one, other : Axis
    labels : (str, str)
        What the lines are called.
    index : str
        Index of a and α.
    view, width, title, alt
        As for :func:`sketch`; the view is the clearest one if left out.

    Returns
    -------
    Sketch

    Examples
    --------
    >>> from dhlib import Axis
    >>> drawing = two_lines(Axis([0, 0, 0], [0, 0, 1]), Axis([1, 0, 0], [0, 1, 1]))
    >>> [label.text for label in drawing.labels]
    ['axis i', 'axis i+1', 'a_i', 'α_i']
    """
    normal = common_normal(one, other)
    size = normal.length or 1.0
    scene = Scene(axis_length=0.7 * size)
    for axis, foot, label in ((one, normal.before, labels[0]), (other, normal.after, labels[1])):
        scene.add_line(foot, axis.direction, label, 0.8 * size, 1.0 * size, "z")
    if normal.length > 0:
        scene.add_segment(normal.before, normal.after, indexed("a", index), colour="x")
        scene.add_right_angle(normal.before, one.direction, normal.x, "muted")
        scene.add_right_angle(normal.after, other.direction, -normal.x, "muted")
    sine = float(np.cross(one.direction, other.direction) @ normal.x)
    twist = float(np.arctan2(sine, one.direction @ other.direction))
    if abs(sine) > NOTHING:
        scene.add_segment(normal.after, normal.after + 0.9 * size * one.direction, kind="guide", colour="muted")
        scene.add_arc(normal.after, normal.x, one.direction, twist, indexed("α", index), 0.55 * size, "x")
    for foot in (normal.before, normal.after):
        scene.add_point(foot)
    lie = {
        "skew": "that do not meet. Their common normal is at right angles to both; its length is a.",
        "intersecting": "that meet: a is 0, and the common normal goes through their point, at right angles to both.",
        "parallel": "that are parallel. One of their many common normals is drawn; each has the length a.",
        "antiparallel": "that are parallel and point opposite ways. One of their common normals is drawn.",
        "coincident": "that coincide: a is 0.",
    }[normal.kind]
    angle = f" Seen along it, the angle from the first to the second is α, {number_text(round(np.rad2deg(twist), 1))}°."
    return scene.sketch(
        title or "Two lines in space",
        alt
        or f"Two lines, {labels[0]} and {labels[1]}, {lie}{angle if normal.kind in ('skew', 'intersecting') else ''}",
        view,
        width,
    )


def conditions(
    before: Any,
    after: Any,
    convention: str = "classic",
    *,
    names: tuple[str, str] = ("i-1", "i"),
    caption: str = "",
    view: ViewAngles | None = None,
    width: float = WIDTH,
    title: str = "",
    alt: str = "",
) -> Sketch:
    """Draw two frames, and whether the x and z that the conditions bind are at right angles (DH1) and meet (DH2).

    Parameters
    ----------
    before, after : array_like (4, 4)
        Poses of frames i-1 and i, seen from one frame.
    convention : {"classic", "modified"}
        Classic: x_i and z_{i-1}. Modified: x_{i-1} and z_i.
    names : (str, str)
        What the frames are called.
    caption : str
        A line below.
    view, width, title, alt
        As for :func:`sketch`; the view is the clearest one if left out.

    Returns
    -------
    Sketch

    Raises
    ------
    DHError
        If a frame is no pose, or the convention unknown.

    Examples
    --------
    >>> from dhlib import classic
    >>> conditions(np.eye(4), classic(0.5, 1, 1, 0.7)).alt
    'Frames i-1 (dashed) and i. DH1 holds: x_i is at right angles to z_i-1. DH2 holds: the line of x_i meets z_i-1.'
    """
    scene, told = _conditions_scene(before, after, convention, names)
    return scene.sketch(title or "DH1 and DH2", alt or told, view, width, caption=caption)


def _conditions_scene(before: Any, after: Any, convention: str, names: tuple[str, str]) -> tuple[Scene, str]:
    report = check_frames([before, after], convention).links[0]
    first, then = (np.asarray(pose, dtype=np.float64) for pose in (before, after))
    (with_z, of_z), (with_x, of_x) = (first, names[0]), (then, names[1])
    if convention == "modified":
        (with_z, of_z), (with_x, of_x) = (with_x, of_x), (with_z, of_z)
    z, x = Axis(with_z[:3, 3], with_z[:3, 2]), Axis(with_x[:3, 3], with_x[:3, 0])
    normal = common_normal(z, x)
    size = float(np.linalg.norm(then[:3, 3] - first[:3, 3])) or 1.0
    scene = Scene(axis_length=0.42 * size)
    height = float((normal.before - z.point) @ z.direction)
    scene.add_line(
        z.point, z.direction, "", max(0.25 * size, 0.3 * size - height), max(0.7 * size, height + 0.3 * size)
    )
    mark = "right" if report else "wrong"
    scene.add_segment(normal.after, x.point, kind="guide", colour=mark)
    if not report.dh2:
        scene.add_segment(normal.before, normal.after, "gap", "line", "wrong")
    outward = x.point - normal.after
    outward = outward / np.linalg.norm(outward) if np.linalg.norm(outward) > 1e-9 * size else x.direction
    if report.dh1:
        scene.add_right_angle(normal.after, z.direction, outward, mark if report.dh2 else "muted")
    else:
        angle = float(np.arccos(np.clip(outward @ z.direction, -1, 1)))
        degrees = f"{number_text(round(float(np.rad2deg(angle)), 1))}°"
        about = np.cross(z.direction, outward)
        if np.linalg.norm(about) > NOTHING:
            scene.add_arc(normal.after, about, z.direction, angle, degrees, 0.26 * size, "wrong")
    if not (report.dh1 and report.dh2):  # a parallel to z through the foot, where the angle is measured
        scene.add_segment(normal.after, normal.after + 0.36 * size * z.direction, kind="guide", colour="muted")
    scene.add_frame(first, names[0], dashed=True, axes="xz")
    scene.add_frame(then, names[1], axes="xz")
    dh1, dh2 = ("holds" if holds else "fails" for holds in (report.dh1, report.dh2))
    told = (
        f"Frames {names[0]} (dashed) and {names[1]}. DH1 {dh1}: x_{of_x} is {'' if report.dh1 else 'not '}"
        f"at right angles to z_{of_z}. DH2 {dh2}: the line of x_{of_x} {'meets' if report.dh2 else 'misses'} z_{of_z}."
    )
    return scene, told


def right_and_wrong(*, view: ViewAngles | None = None, width: float = WIDTH, title: str = "", alt: str = "") -> Sketch:
    """Draw three pairs of frames: both classic conditions hold; DH1 fails; DH2 fails. See :func:`conditions`.

    Examples
    --------
    >>> [label.text for label in right_and_wrong().labels if "DH" in label.text]
    ['DH1 and DH2 hold', 'DH1 fails', 'DH2 fails']
    """
    onto_axis, onward = Rz(0.6) @ Tz(0.7), Tx(1.0) @ Rx(0.7)
    cases = {
        "DH1 and DH2 hold": onto_axis @ onward,
        "DH1 fails": onto_axis @ Ry(-0.5) @ onward,
        "DH2 fails": onto_axis @ Ty(0.4) @ onward,
    }
    scenes = [_conditions_scene(np.eye(4), after, "classic", ("i-1", "i")) for after in cases.values()]
    view = view or scenes[-1][0].best_view()
    corners = [after[:3, 3] + 0.5 * after[:3, k] for after in cases.values() for k in (0, 2)]
    for scene, _ in scenes:
        scene.add_room(*corners)
    return beside_each_other(
        [
            scene.sketch(view=view, width=width / 2 - 4, caption=caption)
            for (scene, _), caption in zip(scenes, cases, strict=True)
        ],
        title or "DH1 and DH2",
        alt or " ".join(f"Picture {k}: {told}" for k, (_, told) in enumerate(scenes, 1)),
    )


def add_arm(scene: Scene, figure: Drawing) -> None:
    """The bars of the arm, and a gripper where the tool stands clear of the last joint's symbol."""
    for start, end in figure.links:
        scene.add_segment(start, end, kind="body")
    last = figure.joints[-1].centre
    if np.linalg.norm(figure.tool[:3, 3] - last) > 1.3 * SYMBOL_LENGTH * figure.size:
        scene.add_gripper(figure.tool, 0.08 * figure.size)


__all__ = [
    "Scene",
    "Sketch",
    "beside_each_other",
    "conditions",
    "describe",
    "link",
    "pose",
    "right_and_wrong",
    "right_handed",
    "sketch",
    "steps",
    "two_lines",
]
