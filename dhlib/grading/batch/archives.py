"""Reading ZIP files that strangers made: in memory, within bounds, and never into the file system."""

from __future__ import annotations

import io
import stat
import struct
import unicodedata
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import BinaryIO

from dhlib.errors import DHError
from dhlib.grading.notebook import LARGEST_FILE

#: Entries of one archive: a class of ten thousand with a few files each.
MOST_ENTRIES = 100_000
#: What all entries of one archive may come to, unpacked: of a class, and of what one student packed.
MOST_BYTES = 8_000_000_000
MOST_BYTES_OF_ONE = 10 * LARGEST_FILE
#: Archives in archives: what a platform packs may hold what a student has packed, and no more.
DEEPEST = 2

_END = struct.Struct("<4s4H2LH")
_LONGEST_COMMENT = 65_535
_ENCRYPTED = 0x1
_NAMES_ARE_UTF8 = 0x800


@dataclass(frozen=True)
class Member:
    """An entry of an archive.

    Parameters
    ----------
    parts : tuple of str
        Its path in the archive.
    position : int
        Where it stands in the list of the archive; two entries may have the same name.
    size : int
        As the archive says.
    date : tuple of int
        Year to second, of the clock of whoever packed it.
    fault : str
        Why it is not read, or ``""``.
    """

    parts: tuple[str, ...]
    position: int
    size: int
    date: tuple[int, int, int, int, int, int]
    fault: str = ""


class Archive:
    """A ZIP file, open for reading.

    Parameters
    ----------
    file : path or bytes
        Bytes: what a student packed.
    name : str
        What to call it in messages.

    Raises
    ------
    DHError
        If it is damaged, too large, or no ZIP file.
    """

    def __init__(self, file: Path | bytes, name: str) -> None:
        self.name = name
        stream: BinaryIO | None = None
        try:
            stream = io.BytesIO(file) if isinstance(file, bytes) else file.open("rb")
            _check_list(stream, name)
            self._zip = zipfile.ZipFile(stream)
        except DHError:
            _close(stream)
            raise
        except OSError as error:
            _close(stream)
            raise DHError(f"{name} cannot be opened: {error.strerror or type(error).__name__}.") from None
        except (zipfile.BadZipFile, ValueError, NotImplementedError, struct.error):
            _close(stream)
            raise DHError(f"{name} is damaged, or no ZIP file: it cannot be unpacked.") from None
        self._stream = stream
        self._infos = self._zip.infolist()
        most = MOST_BYTES_OF_ONE if isinstance(file, bytes) else MOST_BYTES
        if sum(info.file_size for info in self._infos) > most:
            self.close()
            raise DHError(f"{name} would unpack to more than {most // 1_000_000:,} MB, so it is left alone.")

    def close(self) -> None:
        """Close it."""
        self._zip.close()
        self._stream.close()

    def members(self) -> Iterator[Member]:
        """Its files, in its own order; folders and what macOS adds are left out."""
        for position, info in enumerate(self._infos):
            if info.is_dir():
                continue
            name = _name(info)
            parts = PurePosixPath(name).parts
            yield Member(parts or (name,), position, info.file_size, info.date_time, _fault(info, name))

    def folders(self) -> Iterator[tuple[str, ...]]:
        """Its folders, as far as it lists them."""
        for info in self._infos:
            name = _name(info)
            if info.is_dir() and not _leads_out(name):
                yield PurePosixPath(name).parts

    def read(self, position: int) -> bytes:
        """The content of an entry.

        Raises
        ------
        DHError
            If it is damaged, encrypted, or larger than a notebook may be.
        """
        info = self._infos[position]
        name = _name(info)
        if fault := _fault(info, name):
            raise DHError(fault)
        try:
            with self._zip.open(info) as file:
                content = file.read(LARGEST_FILE + 1)
        except (
            zipfile.BadZipFile,
            zlib.error,
            EOFError,
            NotImplementedError,
            RuntimeError,
            ValueError,
            OSError,
            struct.error,
        ):
            raise DHError(f"{name} is damaged in the archive {self.name}: it cannot be unpacked.") from None
        if len(content) > LARGEST_FILE:
            raise DHError(too_large(name))
        return content


def too_large(name: str) -> str:
    """What to say of a file that is larger than any notebook."""
    return f"{name} is larger than {LARGEST_FILE // 1_000_000} MB; clear its outputs and save it again."


def _close(stream: BinaryIO | None) -> None:
    if stream is not None:
        stream.close()


def _check_list(stream: BinaryIO, name: str) -> None:
    """Look at the end of the archive before its list is read: the list alone may be too large for memory."""
    end = stream.seek(0, io.SEEK_END)
    start = max(0, end - _LONGEST_COMMENT - _END.size)
    stream.seek(start)
    tail = stream.read()
    found = tail.rfind(b"PK\x05\x06")
    if found >= 0 and len(tail) >= found + _END.size:
        entries = _END.unpack_from(tail, found)[4]
        list_bytes = _END.unpack_from(tail, found)[5]
        if entries > MOST_ENTRIES or (list_bytes != 0xFFFFFFFF and list_bytes > 500 * MOST_ENTRIES):
            raise DHError(f"{name} holds more than {MOST_ENTRIES:,} entries, so it is left alone.")
        # each entry takes 46 bytes of the list, so that a small file with a long list is nothing honest
        if list_bytes != 0xFFFFFFFF and list_bytes // 46 > MOST_ENTRIES and end < LARGEST_FILE:
            raise DHError(f"{name} holds more than {MOST_ENTRIES:,} entries, so it is left alone.")
    stream.seek(0)


def _name(info: zipfile.ZipInfo) -> str:
    """The name of an entry; archives made on a Mac hold UTF-8 and do not say so."""
    name = info.filename
    if not info.flag_bits & _NAMES_ARE_UTF8:
        try:
            name = name.encode("cp437").decode("utf-8")
        except UnicodeError:
            name = info.filename
    return unicodedata.normalize("NFC", name)


def _leads_out(name: str) -> bool:
    return name.startswith(("/", "\\")) or ":" in name[:2] or ".." in name.replace("\\", "/").split("/")


def _fault(info: zipfile.ZipInfo, name: str) -> str:
    """Why an entry is not read, or ``""``."""
    if _leads_out(name):
        return f"{name!r} would be unpacked outside of its folder, so it is left alone."
    if stat.S_ISLNK(info.external_attr >> 16):
        return f"{name} is a link, and links are not followed."
    if info.flag_bits & _ENCRYPTED:
        return f"{name} is encrypted; hand it in without a password."
    if info.file_size > LARGEST_FILE:
        return too_large(name)
    return ""
