"""Find what was handed in, and whose it is.

The place decides: the folder or the file name that a platform gave, and the roster. What a notebook says of itself is
heard only where the place says nothing (see `grading`), and what cannot be told is listed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Protocol

from dhlib.errors import DHError
from dhlib.grading.batch.origins import Origin, from_clone, from_file_name, from_folder, from_platform
from dhlib.grading.batch.rows import Certainty, Problem
from dhlib.grading.batch.trees import ARCHIVE, Entry, Tree, look_into, read_file

NOTEBOOK = ".ipynb"
#: nbgrader collects into this folder: submitted/STUDENT/ASSIGNMENT/…
NBGRADER = "submitted"
#: nbgrader writes into a file beside the notebook when it was handed in.
TIMESTAMP = "timestamp.txt"
#: What may lie beside a notebook and is no work of anybody.
BESIDE = {"readme.md", "license", "license.md", TIMESTAMP, "requirements.txt", "onlinetext.html"}


class Person(Protocol):
    """Somebody on a roster."""

    @property
    def id(self) -> str:
        """The name that stays."""

    @property
    def name(self) -> str:
        """What they are called."""


#: Who on the roster goes by one of these names, if exactly one does.
Lookup = Callable[[Sequence[str]], Person | None]


@dataclass(frozen=True)
class HandedIn:
    """Something that was handed in, and whose it is by the place where it was found.

    Parameters
    ----------
    entry : Entry
    source : str
        Where it was found, as the results name it.
    origin : Origin
    submitted : datetime, optional
    """

    entry: Entry
    source: str
    origin: Origin
    submitted: datetime | None = None


@dataclass
class Intake:
    """All that was handed in, in the order of the sources.

    Parameters
    ----------
    found : list of HandedIn
    problems : list of Problem
        What could not be placed or read.
    """

    found: list[HandedIn] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)


def collect(sources: Sequence[Path], exercises: Collection[str] = (), roster: Lookup | None = None) -> Intake:
    """Look into all sources.

    Parameters
    ----------
    sources : sequence of Path
        Files, folders and ZIP archives.
    exercises : collection of str
        Names of exercises, which are no names of students.
    roster : callable, optional
        Finds somebody on the roster by the names that a place gives.

    Raises
    ------
    DHError
        If a source is not there, or nothing was handed in at all.
    """
    intake = Intake()
    taken: set[str] = set()
    for source in sources:
        one = _Source(look_into(source), exercises, roster)
        for handed_in in one.collect():
            name = handed_in.source
            if name in taken:  # the same path in two sources: the later one is told by its source
                name = f"{source.resolve().name}/{name}"
            k = 2
            while name in taken:
                name, k = f"{source}/{handed_in.source} ({k})", k + 1
            taken.add(name)
            intake.found.append(replace(handed_in, source=name))
        intake.problems += one.problems
    if not intake.found:
        where = ", ".join(str(source) for source in sources)
        why = f" {intake.problems[0].what}" if intake.problems else ""
        raise DHError(f"there is no notebook (*{NOTEBOOK}) in {where}.{why}")
    return intake


class _Source:
    """One source: which of its parts stands for the student, and what lies in each."""

    def __init__(self, tree: Tree, exercises: Collection[str], roster: Lookup | None) -> None:
        self.tree = tree
        self.exercises = exercises
        self.roster = roster
        self.problems: list[Problem] = []
        #: So many folders around everything say nothing.
        self.depth = _wrappers(tree)
        #: Clones that lie side by side at this depth.
        self.clones = sorted(path[-1] for path in tree.clones if len(path) == self.depth + 1)
        self.stamps = {entry.path for entry in tree.entries if entry.name == TIMESTAMP and not entry.fault}

    def collect(self) -> Iterator[HandedIn]:
        groups: dict[Origin, list[Entry]] = defaultdict(list)
        for entry in self.tree.entries:
            groups[self._origin(entry)].append(entry)
        # Canvas numbers each file, so that whoever handed in a notebook and a picture is in two groups
        served = {origin.place for origin, entries in groups.items() if any(map(_is_notebook, entries))}
        for origin, entries in groups.items():
            if origin.place in served and not any(entry.fault or _is_notebook(entry) for entry in entries):
                continue
            yield from self._chosen(self._on_roster(origin), entries)
        self._say_what_is_empty()

    def _origin(self, entry: Entry) -> Origin:
        parts = entry.parts[self.depth :]
        first, is_file = parts[0], len(parts) == 1
        platform = from_platform(first)
        if platform and (is_file or first.lower().endswith(ARCHIVE) or "_assignsubmission_" in first):
            return self._placed(platform)
        if is_file:
            return self._placed(from_file_name(first, self.exercises))
        wrapping = entry.parts[: self.depth]
        if (*wrapping, first) in self.tree.clones:
            parent = wrapping[-1] if wrapping else self.tree.root.resolve().name
            return self._placed(from_clone(first, self.clones, parent, self.exercises))
        return self._placed(from_folder(first))

    def _placed(self, origin: Origin) -> Origin:
        return replace(origin, place=f"{self.tree.root.resolve().name}/{origin.place}")

    def _on_roster(self, origin: Origin) -> Origin:
        """Whoever on the roster is meant."""
        if self.roster is None or not origin.student:
            return origin
        person = self.roster([origin.student, origin.name])
        if person is not None:
            return replace(origin, student=person.id, name=person.name)
        if origin.certainty == Certainty.FILE_NAME:  # such as final.ipynb: it says nothing after all
            return replace(origin, student="", name="", certainty=Certainty.NOBODY)
        self.problems.append(Problem(origin.place, f"{origin.name} is not on the roster.", (origin.student,)))
        return origin

    def _chosen(self, origin: Origin, entries: Sequence[Entry]) -> Iterator[HandedIn]:
        """What of somebody's files is graded: the notebooks; without any, the file that was handed in instead."""
        inside = self._of_platform(origin, entries)
        notebooks = [entry for entry in inside if _is_notebook(entry)]
        faulty = [entry for entry in inside if entry.fault]
        self.problems += [
            Problem(entry.shown, _sentence(entry.fault), (origin.student,) if origin.student else ())
            for entry in faulty
        ]
        chosen = notebooks
        if not notebooks and origin.certainty == Certainty.PLACE:
            others = [entry for entry in inside if entry.name.lower() not in BESIDE]
            chosen = sorted(others, key=lambda entry: (not _may_be_renamed(entry.name), entry.parts))[:1]
            if not chosen and inside:
                self.problems.append(
                    Problem(inside[0].shown, f"{origin.name} handed in no notebook.", (origin.student,))
                )
        elif not notebooks and len(self.tree.entries) == 1:
            chosen = list(inside)  # this very file was asked for
        elif not notebooks:
            self.problems += [
                Problem(entry.shown, "It is no notebook, and nothing says whose it is.")
                for entry in inside
                if not entry.fault and entry.name.lower() not in BESIDE
            ]
        for entry in chosen:
            yield HandedIn(entry, entry.shown, origin, self._submitted(entry))

    def _of_platform(self, origin: Origin, entries: Sequence[Entry]) -> Sequence[Entry]:
        """Leave out an archive that is itself the download of a whole class: it is nobody's."""
        archive = next(
            (e.parts[: self.depth + 1] for e in entries if e.parts[self.depth].lower().endswith(ARCHIVE)), None
        )
        if archive is None or from_platform(archive[-1]):
            return entries
        inner = {
            found.place
            for e in entries
            if len(e.parts) > len(archive)
            if (found := from_platform(e.parts[len(archive)]))
        }
        if len(inner) < 2:
            return entries
        self.problems.append(
            Problem(
                "/".join(archive),
                "It looks like the download of a whole class; give it as a source of its own, beside the others.",
            )
        )
        return [entry for entry in entries if entry.parts[: self.depth + 1] != archive]

    def _submitted(self, entry: Entry) -> datetime | None:
        """When it was handed in, where that can be told: the files of a clone carry the date of the download."""
        if any(entry.parts[:k] in self.tree.clones for k in range(len(entry.parts))):
            return None
        return self._stamp(entry) or entry.modified

    def _stamp(self, entry: Entry) -> datetime | None:
        path = entry.path.parent / TIMESTAMP
        if entry.members or path not in self.stamps:
            return None
        try:
            text = read_file(path)[:100].decode("utf-8", "replace").strip()
            return datetime.fromisoformat(text.replace(" UTC", "+00:00")).astimezone(UTC)
        except (DHError, ValueError, OverflowError):
            return None

    def _say_what_is_empty(self) -> None:
        """List the folders of students who handed nothing in."""
        full = {entry.parts[: self.depth + 1] for entry in self.tree.entries}
        for folder in sorted(self.tree.folders):
            if len(folder) == self.depth + 1 and folder not in full:
                origin = self._on_roster(from_platform(folder[-1]) or from_folder(folder[-1]))
                self.problems.append(Problem("/".join(folder), "The folder is empty.", (origin.student,)))


def _is_notebook(entry: Entry) -> bool:
    return entry.name.lower().endswith(NOTEBOOK)


def _wrappers(tree: Tree) -> int:
    """How many folders around everything stand for nobody, such as the one that an archive was unpacked into."""
    depth = 0
    if tree.root.name == NBGRADER:
        return 0
    while True:
        firsts = {entry.parts[depth] for entry in tree.entries if len(entry.parts) > depth}
        if len(firsts) != 1 or any(len(entry.parts) == depth + 1 for entry in tree.entries):
            return depth
        (first,) = firsts
        if first == NBGRADER:
            return depth + 1
        here = tree.entries[0].parts[: depth + 1]
        below = {entry.parts[depth + 1] for entry in tree.entries}
        loose = {entry.parts[depth + 1] for entry in tree.entries if len(entry.parts) == depth + 2}
        if here in tree.clones or from_platform(first) or len(below) < 2:
            return depth
        if any(name.lower().endswith(NOTEBOOK) and not from_platform(name) for name in loose):
            return depth
        depth += 1


def _may_be_renamed(name: str) -> bool:
    """Whether a name looks as if a notebook had been given another ending."""
    return NOTEBOOK in name.lower() or name.lower().endswith(".json")


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] if text.startswith("the ") else text
