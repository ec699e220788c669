"""Who handed something in, as far as the place tells where it was found."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass

from dhlib.grading.batch.rows import Certainty

#: ``Ada Lovelace_1815_assignsubmission_file_``, as a folder or in front of the name of a file.
MOODLE = re.compile(r"(?P<name>.+?)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)_(?P<rest>.*)", re.DOTALL)
#: ``lovelaceada_LATE_1815_4711_quickshot-1.ipynb``: the student's number, then that of what was handed in.
CANVAS = re.compile(r"(?P<name>[^_]+)(?P<late>_late)?_(?P<id>\d+)_(?P<number>\d+)_(?P<rest>.+)", re.DOTALL | re.I)
LONGEST_NAME = 500
#: What is added to a name when there is one already, or when somebody saves once more.
COPY = re.compile(r"[\s_-]*(?:\(\d+\)|copy|kopie|final|new|v?\d+)", re.IGNORECASE)
#: What GitHub Classroom calls the folder of the clones.
CLONES = "-submissions"
ENDINGS = re.compile(r"(?:\.(?:ipynb|json|txt|zip))+$", re.IGNORECASE)


@dataclass(frozen=True)
class Origin:
    """What a place says.

    Parameters
    ----------
    place : str
        What stands for the student: a folder, or the part of a name that a platform gave.
    student, name : str
        Both ``""`` where the place says nothing.
    certainty : Certainty
    sequence : int
        Number that the platform gave.
    late : bool
        Whether the platform says that it was late.
    """

    place: str
    student: str = ""
    name: str = ""
    certainty: Certainty = Certainty.NOBODY
    sequence: int = 0
    late: bool = False


def from_platform(first: str) -> Origin | None:
    """What Moodle or Canvas put into the name of a folder or a file.

    Examples
    --------
    >>> from_platform("Ada Lovelace_1815_assignsubmission_file_").student
    '1815'
    >>> from_platform("lovelaceada_LATE_1815_4711_quickshot.ipynb").late
    True
    >>> from_platform("Ada Lovelace")
    """
    if len(first) > LONGEST_NAME:
        return None
    if found := MOODLE.fullmatch(first):
        place = first[: found.start("kind")]
        return Origin(place, found["id"], found["name"], Certainty.PLACE)
    if found := CANVAS.fullmatch(first):
        place = f"{found['name']}_{found['id']}"
        number = min(int(found["number"]), 2**62)
        return Origin(place, found["id"], found["name"], Certainty.PLACE, number, bool(found["late"]))
    return None


def from_clone(folder: str, beside: Collection[str], parent: str, exercises: Collection[str]) -> Origin:
    """Whose clone a folder is: what GitHub Classroom put behind the name of the assignment.

    Examples
    --------
    >>> from_clone("quickshot-ada-l", ["quickshot-ada-l", "quickshot-ada-m"], "", ["quickshot"]).student
    'ada-l'
    >>> from_clone("dh-1-ada", ["dh-1-ada", "dh-1-bob"], "week", []).student
    'ada'
    """
    prefixes = [f"{parent.removesuffix(CLONES)}-"] if parent.endswith(CLONES) else []
    prefixes += [f"{name}-" for exercise in exercises for name in (exercise, exercise.replace("_", "-"))]
    if len(beside) > 1:
        prefixes.append(_common(sorted(beside)))
    for prefix in prefixes:
        if prefix and folder.startswith(prefix) and folder != prefix:
            return Origin(folder, folder[len(prefix) :], folder[len(prefix) :], Certainty.PLACE)
    return Origin(folder, folder, folder, Certainty.PLACE)


def from_folder(folder: str) -> Origin:
    """A folder, or an archive, that is called like the student."""
    name = ENDINGS.sub("", folder).strip() or folder
    return Origin(folder, name, name, Certainty.PLACE)


def from_file_name(file: str, exercises: Collection[str]) -> Origin:
    """A file that lies among others: its name says who, unless it is only that of the exercise.

    Examples
    --------
    >>> from_file_name("quickshot_ada.ipynb", ["quickshot"]).student
    'ada'
    >>> from_file_name("quickshot (2).ipynb", ["quickshot"]).certainty.name
    'NOBODY'
    """
    stem = ENDINGS.sub("", file).strip() or file
    for exercise in sorted(exercises, key=len, reverse=True):
        pattern = re.escape(exercise).replace("_", "[_ -]")
        rest = re.sub(rf"(?<![^\W_]){pattern}(?![^\W_])", "", stem, count=1, flags=re.IGNORECASE)
        if rest != stem:
            stem = COPY.sub("", rest, count=1) if COPY.fullmatch(rest) else rest
            stem = stem.strip(" _-.,")
            break
    if not stem:
        return Origin(file)
    return Origin(file, stem, stem, Certainty.FILE_NAME)


def _common(names: Sequence[str]) -> str:
    """What all names begin with, up to its last hyphen."""
    first, last = names[0], names[-1]
    length = next((k for k, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), min(len(first), len(last)))
    return first[: first.rfind("-", 0, length) + 1]
