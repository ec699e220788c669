"""``dhlib new-exercise``: a worked notebook and its file, to fill in, which work as they are."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from dhlib import robots
from dhlib.chain import Chain
from dhlib.errors import DHError
from dhlib.grading.course.editions import HOW
from dhlib.grading.course.robot_files import read_robot
from dhlib.grading.course.variants import fill, load_variant
from dhlib.grading.derive import KERNEL, as_text, derive
from dhlib.grading.exercise import NAME

TEMPLATE = Path(__file__).parent / "templates"


def new_exercise(name: str, out: Path, robot: Chain | None = None) -> list[Path]:
    """Write an exercise on an arm: its file, the worked notebook, and the student's.

    Returns
    -------
    list of Path
        The three files.

    Raises
    ------
    DHError
        If the name is none, or a file is there already.
    """
    if not NAME.fullmatch(name):
        raise DHError(f"{name!r} should be a word of small letters, digits and _, such as our_arm.")
    arm = robot or robots.quickshot()
    exercises, solutions = out / "exercises", out / "solutions"
    paths = [exercises / f"{name}.py", solutions / f"{name}.ipynb", exercises / f"{name}.ipynb"]
    for path in paths:
        if path.exists():
            raise DHError(f"{path} is there already, and nothing is written over it.")
    words = {"NAME": name, "TITLE": arm.name or name, "ARM": _source(arm)}
    try:
        for folder in (exercises, solutions):
            folder.mkdir(parents=True, exist_ok=True)
        paths[0].write_text(_filled("exercise.txt", words), encoding="utf-8")
        notebook = _notebook(name, arm, words)
        fill(notebook, load_variant(name, exercises).cells())
        paths[1].write_text(as_text(notebook), encoding="utf-8")
        paths[2].write_text(as_text(derive(notebook, name)), encoding="utf-8")
    except OSError as error:
        raise DHError(f"{error.filename} cannot be written: {error.strerror}.") from None
    return paths


def _filled(template: str, words: dict[str, str]) -> str:
    text = (TEMPLATE / template).read_text(encoding="utf-8")
    for word, value in words.items():
        text = text.replace(f"<<{word}>>", value)
    return text


def _source(arm: Chain) -> str:
    """A chain as Python source, exact."""
    lines = []
    for joint in arm.joints:
        kind, fixed = ("Revolute", "d") if joint.variable == "theta" else ("Prismatic", "theta")
        values = {fixed: getattr(joint, fixed), "a": joint.a, "alpha": joint.alpha, "offset": joint.offset}
        given = [f"{key}={float(value)!r}" for key, value in values.items() if float(value) != 0]
        given += ["sign=-1"] if joint.sign < 0 else []
        lines.append(f"        {kind}({', '.join(given)}),\n")
    ends = "".join(
        f"    {end}=np.array({np.asarray(pose, dtype=float).tolist()!r}),\n"
        for end, pose in (("base", arm.base), ("tool", arm.tool))
        if not np.allclose(np.asarray(pose, dtype=float), np.eye(4), atol=1e-12)
    )
    return (
        f"Chain(\n    [\n{''.join(lines)}    ],\n    {arm.convention!r},\n{ends}"
        f"    name={(arm.name or '')!r},\n    unit={arm.unit!r},\n)"
    )


def _notebook(name: str, arm: Chain, words: dict[str, str]) -> dict[str, Any]:
    """The worked notebook: the template, cell by cell, each headed by its kind, role and part."""
    cells: list[dict[str, Any]] = []
    steps = {
        "classic": "turn_z(theta) @ shift(z=d) @ shift(x=a) @ turn_x(alpha)",
        "modified": "turn_x(alpha) @ shift(x=a) @ turn_z(theta) @ shift(z=d)",
    }[arm.convention]
    text = _filled("solution.txt", words | {"STEPS": steps, "CONVENTION": arm.convention, "HOW": HOW})
    for block in text.split("%% ")[1:]:
        head, source = block.split("\n", 1)
        kind, role, *part = head.split()
        about = {"role": role, **({"part": part[0]} if part else {})}
        cell: dict[str, Any] = {
            "cell_type": "code" if kind == "code" else "markdown",
            "id": "-".join([role, *part]) if part else f"{role}-{len(cells)}",
            "metadata": {"dh": about},
            "source": source.strip("\n").splitlines(keepends=True),
        }
        cells.append(cell | ({"execution_count": None, "outputs": []} if kind == "code" else {}))
    metadata = {"dh": {"exercise": name}, "kernelspec": KERNEL, "language_info": {"name": "python"}}
    return {"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5}


def add_new_exercise(commands: Any) -> None:
    """Add ``new-exercise`` to the commands of the parser."""
    parser = commands.add_parser(
        "new-exercise",
        help="write an exercise of your own, to fill in",
        description="Write a worked notebook and the file that says what it asks, on a robot of your own. They work as "
        "they are: check, grade and assign them, then change what you like.",
    )
    parser.add_argument("name", metavar="NAME", help="a word of small letters, digits and _")
    parser.add_argument("--robot", type=Path, metavar="FILE", help="a table (CSV) or a URDF; else the Quickshot")
    parser.add_argument("--convention", choices=("classic", "modified"), default="classic", help="of the table")
    parser.add_argument("--degrees", action="store_true", help="the angles of the table are in degrees")
    parser.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="where exercises/ and solutions/ are")
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    robot = read_robot(options.robot, options.convention, options.degrees) if options.robot else None
    for path in new_exercise(options.name, options.out, robot):
        print(f"wrote {path}")
    return 0
