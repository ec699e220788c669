"""Read a robot from a table or a URDF file."""

from __future__ import annotations

import csv
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from dhlib.axes import Axis
from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.placement import place_frames
from dhlib.scalars import FloatArray
from dhlib.transforms import Rx, Ry, Rz, Tx, Ty, Tz

MOVING = {"revolute": "R", "continuous": "R", "prismatic": "P"}
KIND = ("joint", "kind", "type")
LARGEST_FILE = 20_000_000


def read_robot(path: str | Path, convention: str = "classic", degrees: bool = False) -> Chain:
    """The arm of a file: a CSV table with the headings theta, d, a, alpha, or a URDF.

    Parameters
    ----------
    path : path
        In a table the row holds a joint variable, such as q1, or a column `joint` says R or P.
    convention : {"classic", "modified"}
        That of the table, or the one in which the frames of a URDF are placed.
    degrees : bool
        Whether the angles of a table are in degrees.

    Raises
    ------
    DHError
        If it cannot be read.
    """
    path = Path(path)
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise DHError(f"{path} is larger than {LARGEST_FILE // 1_000_000} MB, which is no robot.")
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise DHError(
            f"the robot {path} cannot be read: {getattr(error, 'strerror', '') or 'it is no text'}."
        ) from None
    if text.lstrip().startswith("<"):
        return _of_urdf(text, path, convention)
    return _of_table(text, path, convention, degrees)


def _of_table(text: str, path: Path, convention: str, degrees: bool) -> Chain:
    first = text.splitlines()[0] if text.strip() else ""
    rows = [row for row in csv.reader(text.splitlines(), delimiter=max(",;\t", key=first.count)) if any(row)]
    headings = [heading.strip().casefold() for heading in rows[0]] if rows else []
    columns = [heading for heading in headings if heading not in KIND]
    if sorted(columns) != ["a", "alpha", "d", "theta"]:
        raise DHError(f"{path} should have the headings theta, d, a and alpha, and may have joint; it has {headings}.")
    if any(len(row) != len(headings) for row in rows):
        raise DHError(f"{path}: every row should have {len(headings)} cells, as the headings have.")
    letters = "".join(
        cell.strip()[:1].upper()
        for row in rows[1:]
        for heading, cell in zip(headings, row, strict=True)
        if heading in KIND
    )
    cells = [
        [cell.strip() for heading, cell in zip(headings, row, strict=True) if heading not in KIND] for row in rows[1:]
    ]
    return Chain.from_table(cells, " ".join(columns), letters, convention, degrees=degrees, name=path.stem)


def _of_urdf(text: str, path: Path, convention: str) -> Chain:
    """The first chain of a URDF: from the root along the first moving joints to its end."""
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise DHError(f"{path} is no URDF: {error}.") from None
    joints: dict[str | None, list[tuple[ElementTree.Element, str | None]]] = {}
    children = set()
    for joint in root.findall("joint"):
        parent, child = joint.find("parent"), joint.find("child")
        if parent is None or child is None:
            raise DHError(f"{path}: the joint {joint.get('name')!r} has no parent or no child.")
        joints.setdefault(parent.get("link"), []).append((joint, child.get("link")))
        children.add(child.get("link"))
    starts = [link for link in joints if link not in children]
    if len(starts) != 1:
        raise DHError(f"{path}: one link should be the root; there are {len(starts)}.")
    here: FloatArray = np.eye(4)
    axes = []
    link, passed = starts[0], set()
    while link in joints:
        if link in passed:
            raise DHError(f"{path} is no serial arm: its joints lead in a circle, back to the link {link!r}.")
        passed.add(link)
        branches = joints[link]
        moving = [branch for branch in branches if branch[0].get("type") in MOVING]
        joint, link = (moving or branches)[0]
        here = here @ _origin(joint, path)
        if (kind := joint.get("type")) in MOVING:
            axis = joint.find("axis")
            direction = _numbers(axis.get("xyz") if axis is not None else None, (1, 0, 0), path)
            axes.append(Axis(here[:3, 3], here[:3, :3] @ direction, MOVING[kind]))
    if not axes:
        raise DHError(f"{path} has no joint that moves.")
    placed = place_frames(axes, convention=convention, end=here)
    return Chain(
        placed.chain.joints, convention, placed.chain.base, placed.chain.tool, name=root.get("name") or path.stem
    )


def _origin(joint: ElementTree.Element, path: Path) -> FloatArray:
    origin = joint.find("origin")
    if origin is None:
        return np.eye(4)
    x, y, z = _numbers(origin.get("xyz"), (0, 0, 0), path)
    roll, pitch, yaw = _numbers(origin.get("rpy"), (0, 0, 0), path)
    pose: FloatArray = np.asarray(Tx(x) @ Ty(y) @ Tz(z) @ Rz(yaw) @ Ry(pitch) @ Rx(roll), dtype=float)
    return pose


def _numbers(text: str | None, usual: tuple[float, float, float], path: Path) -> FloatArray:
    try:
        numbers = np.array([float(word) for word in text.split()] if text else usual, dtype=float)
    except ValueError:
        raise DHError(f"{path}: {text!r} should be three numbers.") from None
    if numbers.shape != (3,):
        raise DHError(f"{path}: {text!r} should be three numbers.")
    return numbers
