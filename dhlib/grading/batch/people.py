"""Find somebody on a class list by whatever name a platform, a folder or a clone goes by."""

from __future__ import annotations

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from dhlib.grading.course.roster import read_roster, read_rows

#: Headings, in small letters without anything else, under which stands who somebody is.
FIRST = {"firstname", "givenname", "vorname", "first"}
LAST = {"lastname", "surname", "familyname", "nachname", "last"}
FULL = {"name", "fullname", "student", "studentname", "displayname", "sortablename", "vollständigername"}
OTHER = {
    "id", "studentid", "idnumber", "matriculationnumber", "matrikelnummer", "matrnr", "matnr", "matrikel", "kennung",
    "sisuserid", "sisloginid", "loginid", "login", "username", "userid", "user", "kürzel", "kuerzel", "identifier",
    "emailaddress", "email", "mail", "emailadresse", "github", "githubusername", "githublogin", "githubid",
}  # fmt: skip


@dataclass(frozen=True)
class Person:
    """Somebody on the list."""

    id: str
    name: str


class People:
    r"""A class list.

    Parameters
    ----------
    path : path
        As `course.roster.read_roster` takes it: CSV with a column of IDs, and columns of names, addresses or logins.
    column : str, optional
        Heading of the column of IDs.

    Raises
    ------
    DHError
        If it cannot be read, or has no IDs.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     roster = Path(folder) / "roster.csv"
    ...     _ = roster.write_text("id,first name,last name,github\ns1,Ada,Müller,ada-m\n", encoding="utf-8")
    ...     people = People(roster)
    >>> [people.find([name]).id for name in ("Müller, Ada", "ada müller", "mullerada", "ada-m", "S1")]
    ['s1', 's1', 's1', 's1', 's1']
    >>> people.find(["Mallory"])
    """

    def __init__(self, path: Path, column: str = "") -> None:
        ids = read_roster(path, column)
        (_, headings), *rows = read_rows(path)
        plain = [_squeezed(heading) for heading in headings]
        self.people: list[Person] = []
        self._known: dict[str, set[Person]] = defaultdict(set)
        for id_, (_, row) in zip(ids, rows, strict=True):
            cells = [(heading, cell.strip()) for heading, cell in zip(plain, row, strict=False) if cell.strip()]
            person = Person(id_, _full_name(dict(reversed(cells))) or id_)
            self.people.append(person)
            for name in [id_, person.name, *(cell for heading, cell in cells if heading in OTHER | FULL)]:
                for key in _keys(name.removeprefix("Participant ")):
                    self._known[key].add(person)

    def find(self, names: Sequence[str]) -> Person | None:
        """Whoever goes by one of these names, tried in this order; nobody where two do."""
        for name in names:
            for key in _keys(name):
                found = self._known.get(key, set())
                if len(found) == 1:
                    return next(iter(found))
        return None


def _full_name(cells: Mapping[str, str]) -> str:
    first = next((cell for heading, cell in cells.items() if heading in FIRST), "")
    last = next((cell for heading, cell in cells.items() if heading in LAST), "")
    full = next((cell for heading, cell in cells.items() if heading in FULL), "")
    return f"{first} {last}".strip() or full


def _keys(name: str) -> Iterator[str]:
    """What names are compared by: as they are, in any order of words, and as Canvas writes them."""
    name = unicodedata.normalize("NFC", name).casefold().strip()
    words = [word for word in re.split(r"[\s,;_]+", name) if word]
    if not words:
        return
    yield name
    yield " ".join(sorted(words))
    for order in (words, words[-1:] + words[:-1], words[1:] + words[:1]):
        squeezed = _squeezed("".join(order))
        yield squeezed
        yield "".join(letter for letter in unicodedata.normalize("NFD", squeezed) if not unicodedata.combining(letter))


def _squeezed(text: str) -> str:
    return re.sub(r"[\W_]+", "", unicodedata.normalize("NFC", text).casefold())
