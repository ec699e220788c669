"""Read a class list as spreadsheets and learning platforms write it."""

from __future__ import annotations

import codecs
import csv
import io
import unicodedata
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.course.lots import who

#: Headings under which IDs stand, as they are compared: small letters and digits alone.
HEADINGS = (
    "id", "studentid", "idnumber", "matriculationnumber", "matrikelnummer", "matrnr", "matnr", "matrikel",
    "sisuserid", "sisloginid", "loginid", "login", "username", "userid", "user", "kennung", "kuerzel",
    "emailaddress", "email", "mail", "emailadresse", "student",
)  # fmt: skip
DELIMITERS = ";,\t"
LONGEST_ID = 100
LARGEST_FILE = 20_000_000
#: How many rows an error names.
NAMED = 5


def read_roster(path: str | Path, column: str = "") -> list[str]:
    r"""The IDs of a class, in the order of the list.

    Parameters
    ----------
    path : path
        Comma, semicolon or tab separated; UTF-8 with or without a mark at its start, Excel's UTF-16, or the older
        encoding of Western Europe.
    column : str, optional
        Heading of the column of IDs; one that is usual for them if left out.

    Raises
    ------
    DHError
        If the file cannot be read, has no such column, or an ID is empty, there twice, or no ID; the message names
        the rows.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     roster = Path(folder) / "roster.csv"
    ...     _ = roster.write_text('Name;Student ID\n"Müller; Ada";a1\nBohr;b2\n', encoding="utf-16")
    ...     read_roster(roster)
    ['a1', 'b2']
    """
    path = Path(path)
    rows = read_rows(path)
    if not rows:
        raise DHError(f"{path} is empty; its first row should hold the headings, such as id and name.")
    (_, headings), *students = rows
    place = _place(path, headings, column)
    ids: list[str] = []
    empty, long, odd = [], [], []
    for line, row in students:
        if len(row) > len(headings):
            raise DHError(
                f"{path}, line {line}: {len(row)} cells under {len(headings)} headings. A cell with a comma or a "
                "semicolon in it should stand in quotation marks."
            )
        student = unicodedata.normalize("NFC", row[place].strip()) if place < len(row) else ""
        if not student:
            empty.append(line)
        elif len(student) > LONGEST_ID:
            long.append(line)
        elif not student.isprintable():
            odd.append(line)
        ids.append(student)
    for lines, what in ((empty, "there is no ID"), (long, "the ID is too long"), (odd, "the ID cannot be printed")):
        if lines:
            raise DHError(f"{path}: {what} in {_lines(lines)}. Nothing was written.")
    first: dict[str, int] = {}
    for (line, _), student in zip(students, ids, strict=True):
        if (before := first.setdefault(who(student), line)) != line:
            raise DHError(f"{path}: {student!r} is there twice, in lines {before} and {line}. Nothing was written.")
    if not ids:
        raise DHError(f"{path} holds headings and no student.")
    return ids


def read_rows(path: Path) -> list[tuple[int, list[str]]]:
    """The rows that are not blank, each with the number of its last line."""
    text = _text(path)
    lines = text.split("\n", 1)
    delimiter = ""
    if lines[0].strip().casefold().startswith("sep="):  # Excel's own way to say so
        delimiter, text = lines[0].strip()[4:5], lines[1] if len(lines) > 1 else ""
    skipped = 1 if delimiter else 0
    delimiter = delimiter or _delimiter(text)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    try:
        return [(reader.line_num + skipped, row) for row in reader if any(cell.strip() for cell in row)]
    except csv.Error as error:
        raise DHError(f"{path}, line {reader.line_num + skipped}: {error}. Is a quotation mark left open?") from None


def _text(path: Path) -> str:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise DHError(f"{path} is larger than {LARGEST_FILE // 1_000_000} MB, which is no class list.")
        data = path.read_bytes()
    except OSError as error:
        raise DHError(f"the roster {path} cannot be opened: {error.strerror}.") from None
    if data.startswith((b"PK\x03\x04", b"\xd0\xcf\x11\xe0")):
        raise DHError(f"{path} is a workbook; save it as CSV.")
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encodings = ["utf-16"]
    elif data[1:2] == b"\0":
        encodings = ["utf-16-le"]
    else:
        encodings = ["utf-8-sig", "cp1252"]
    for encoding in encodings:
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    raise DHError(f"{path} is no text; save the class list as CSV, in UTF-8.")


def _delimiter(text: str) -> str:
    """The one that stands most often in the headings, outside quotation marks."""
    heading = next((line for line in text.splitlines() if line.strip()), "")
    outside = "".join(heading.split('"')[::2])
    return max(DELIMITERS, key=outside.count)


def _place(path: Path, headings: list[str], column: str) -> int:
    plain = [_plain(heading) for heading in headings]
    if column:
        found = [k for k, heading in enumerate(plain) if heading == _plain(column)]
    else:
        found = next(([plain.index(usual)] for usual in HEADINGS if plain.count(usual) == 1), [])
    if len(found) != 1:
        what = f"{'no' if not found else 'more than one'} column {column!r}" if column else "no column of IDs"
        known = ", ".join(repr(heading.strip()) for heading in headings)
        raise DHError(
            f"{path} has {what}; its first row is {known}. Name the column with --column, or give it the heading id."
        )
    return found[0]


def _plain(heading: str) -> str:
    return "".join(c for c in heading.casefold() if c.isalnum())


def _lines(lines: list[int]) -> str:
    more = f" and {len(lines) - NAMED} more" if len(lines) > NAMED else ""
    return f"line{'s' if len(lines) > 1 else ''} {', '.join(map(str, lines[:NAMED]))}{more}"
