"""What is in a folder or an archive, and how to read it: links are not followed, and nothing is written."""

from __future__ import annotations

import errno
import os
import stat
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.batch.archives import DEEPEST, Archive, too_large
from dhlib.grading.notebook import LARGEST_FILE

#: Folders that hold nothing that was handed in.
SKIPPED_FOLDERS = {"__MACOSX", "__pycache__", "node_modules", "site-packages"}
SKIPPED_FILES = {"thumbs.db", "desktop.ini"}
ARCHIVE = ".zip"


@dataclass(frozen=True)
class Entry:
    """A file in a folder or an archive.

    Parameters
    ----------
    parts : tuple of str
        Its path below the source, as it is shown: normalised, and always text. An archive counts as a folder.
    path : Path
        Where it is on the disk: itself, or the archive.
    members : tuple of int
        Positions in the archive, and in archives in it.
    modified : datetime, optional
    fault : str
        Why it cannot be read, or ``""``.
    """

    parts: tuple[str, ...]
    path: Path
    members: tuple[int, ...] = ()
    modified: datetime | None = None
    fault: str = ""

    @property
    def name(self) -> str:
        """Its own name."""
        return self.parts[-1]

    @property
    def shown(self) -> str:
        """Its path, with slashes."""
        return "/".join(self.parts)


@dataclass
class Tree:
    """What a source holds.

    Parameters
    ----------
    root : Path
    entries : list of Entry
        In the order of their paths.
    folders : set of tuple of str
    clones : set of tuple of str
        Folders that are clones of a repository.
    """

    root: Path
    entries: list[Entry] = field(default_factory=list)
    folders: set[tuple[str, ...]] = field(default_factory=set)
    clones: set[tuple[str, ...]] = field(default_factory=set)


def look_into(source: Path) -> Tree:
    """All that a file, a folder or an archive holds.

    Raises
    ------
    DHError
        If there is no such file or folder.
    """
    tree = Tree(source)
    if source.is_dir():
        _walk(source, (), tree)
        tree.entries = [inner for entry in tree.entries for inner in _unpacked(entry, tree, 0)]
    elif source.is_file():
        entry = Entry((_text(source.name),), source, modified=_modified(source))
        if source.name.lower().endswith(ARCHIVE):
            with_name = [*_unpacked(entry, tree, 0)]
            if len(with_name) == 1 and with_name[0].parts == entry.parts:
                raise DHError(with_name[0].fault or f"{source} holds nothing.")
            tree.entries = [replace(inner, parts=inner.parts[1:]) for inner in with_name]
            tree.folders = {folder[1:] for folder in tree.folders if len(folder) > 1}
        else:
            tree.entries = [entry]
    else:
        raise DHError(f"there is no file or folder {source}.")
    tree.entries.sort(key=lambda entry: entry.parts)
    return tree


class Reader:
    """Reads entries; it keeps the archive open that it read from last."""

    def __init__(self) -> None:
        self._open: list[tuple[tuple[Path, tuple[int, ...]], Archive]] = []

    def __enter__(self) -> Reader:
        return self

    def __exit__(self, *_: object) -> None:
        self._close_beyond(0)

    def read(self, entry: Entry) -> bytes:
        """The content of an entry.

        Raises
        ------
        DHError
            If it cannot be read, or is larger than a notebook may be.
        """
        if entry.fault:
            raise DHError(entry.fault)
        if not entry.members:
            return read_file(entry.path)
        return self._archive(entry.path, entry.members[:-1]).read(entry.members[-1])

    def _archive(self, path: Path, members: tuple[int, ...]) -> Archive:
        depth = len(members)
        if len(self._open) <= depth or self._open[depth][0] != (path, members):
            content = self._archive(path, members[:-1]).read(members[-1]) if members else path
            self._close_beyond(depth)
            self._open.append(((path, members), Archive(content, path.name)))
        return self._open[depth][1]

    def _close_beyond(self, depth: int) -> None:
        while len(self._open) > depth:
            self._open.pop()[1].close()


def read_file(path: Path) -> bytes:
    """The content of a plain file, no larger than a notebook may be.

    Raises
    ------
    DHError
        If it cannot be read.
    """
    name = _text(path.name)
    try:
        # without waiting, since it may have become a pipe, and without following a link that it may have become
        file = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    except OSError as error:
        if error.errno == errno.ELOOP:
            raise DHError(f"{name} is a link, and links are not followed.") from None
        raise DHError(f"{name} cannot be opened: {error.strerror}.") from None
    with os.fdopen(file, "rb") as stream:
        if not stat.S_ISREG(os.fstat(file).st_mode):
            raise DHError(f"{name} is no file that can be read.")
        try:
            content = stream.read(LARGEST_FILE + 1)
        except OSError as error:
            raise DHError(f"{name} cannot be read: {error.strerror}.") from None
    if len(content) > LARGEST_FILE:
        raise DHError(too_large(name))
    return content


def _walk(folder: Path, parts: tuple[str, ...], tree: Tree) -> None:
    try:
        found = sorted(os.scandir(folder), key=lambda item: item.name)
    except OSError as error:
        tree.entries.append(
            Entry(parts or (folder.name,), folder, fault=f"the folder cannot be opened: {error.strerror}.")
        )
        return
    for item in found:
        here = (*parts, _text(item.name))
        if item.name == ".git":
            tree.clones.add(parts)
        if _skipped(item.name):
            continue
        path = Path(item.path)
        if item.is_symlink():
            tree.entries.append(Entry(here, path, fault=f"{here[-1]} is a link, and links are not followed."))
        elif item.is_dir(follow_symlinks=False):
            if item.name not in SKIPPED_FOLDERS and not (path / "pyvenv.cfg").exists():
                tree.folders.add(here)
                _walk(path, here, tree)
        elif item.is_file(follow_symlinks=False):
            tree.entries.append(Entry(here, path, modified=_modified(path)))


def _unpacked(entry: Entry, tree: Tree, depth: int) -> Iterator[Entry]:
    """An entry, or what it holds if it is an archive; an archive that cannot be read stays, with what is wrong."""
    if entry.fault or not entry.name.lower().endswith(ARCHIVE):
        yield entry
        return
    if depth == DEEPEST:
        yield replace(entry, fault=f"{entry.name} lies in an archive in an archive; unpack it first.")
        return
    try:
        with Reader() as reader:
            content = reader.read(entry) if entry.members else entry.path
        archive = Archive(content, entry.name)
    except DHError as error:
        yield replace(entry, fault=str(error))
        return
    tree.folders.add(entry.parts)
    tree.folders.update((*entry.parts, *map(_text, folder)) for folder in archive.folders())
    inside = []
    for member in archive.members():
        if any(_skipped(part) or part in SKIPPED_FOLDERS for part in member.parts) and not member.fault:
            continue
        parts = (*entry.parts, *(_text(part) for part in member.parts if part not in ("/", "..")))
        inside.append(Entry(parts, entry.path, (*entry.members, member.position), _as_date(member.date), member.fault))
    archive.close()
    for found in inside:
        yield from _unpacked(found, tree, depth + 1)


def _skipped(name: str) -> bool:
    return name.startswith((".", "~$")) or name.lower() in SKIPPED_FILES


def _text(name: str) -> str:
    """A name as text: bytes that are none are written out, and accents are one letter."""
    return unicodedata.normalize("NFC", os.fsencode(name).decode("utf-8", "backslashreplace"))


def _modified(path: Path) -> datetime | None:
    try:
        return datetime.fromtimestamp(path.stat().st_mtime, UTC)
    except (OSError, OverflowError, ValueError):
        return None


def _as_date(date: tuple[int, int, int, int, int, int]) -> datetime | None:
    """The date of an entry, in the clock of this machine: archives hold no time zone."""
    try:
        return datetime(*date).astimezone(UTC) if date[0] > 1980 else None
    except (ValueError, OverflowError, OSError):
        return None
