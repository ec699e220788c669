"""Draw lots: choices that a key, a student and an exercise decide, the same on every machine and every day."""

from __future__ import annotations

import hashlib
import hmac
import json
import unicodedata
from collections.abc import Iterable, Sequence
from typing import TypeVar

Item = TypeVar("Item")


def who(student: str) -> str:
    r"""A student's ID as it is compared: however its letters are composed or capitalised, it is the same student.

    Examples
    --------
    >>> who(" Mu\u0308ller ") == who("MÜLLER")
    True
    """
    return unicodedata.normalize("NFC", unicodedata.normalize("NFC", student).strip().casefold())


def digest(key: bytes, *about: str) -> bytes:
    """HMAC-SHA256 of some words; where one word ends and the next begins is part of it.

    Examples
    --------
    >>> digest(b"k", "ab", "c") == digest(b"k", "a", "bc")
    False
    """
    return hmac.new(key, json.dumps(about).encode(), hashlib.sha256).digest()


class Lots:
    """The draws of one student in one exercise.

    Every draw has a name, that of the part or of the quantity, and depends on nothing but it: what is drawn under
    another name may come and go.

    Parameters
    ----------
    key : bytes
    student : str
    exercise : str

    Examples
    --------
    >>> lots = Lots(b"key", "s1", "quickshot")
    >>> lots.one("height", range(100, 200, 10)) == Lots(b"key", "S1 ", "quickshot").one("height", range(100, 200, 10))
    True
    >>> sorted(lots.some("angles", [20, 30, 40], 3))
    [20, 30, 40]
    """

    def __init__(self, key: bytes, student: str, exercise: str) -> None:
        self._key, self._student, self._exercise = key, who(student), exercise

    def one(self, name: str, options: Iterable[Item]) -> Item:
        """One of some options, each as likely as any other."""
        return self.some(name, options, 1)[0]

    def some(self, name: str, options: Iterable[Item], count: int) -> list[Item]:
        """So many different ones of some options, in the order drawn.

        Raises
        ------
        ValueError
            If there are not so many.
        """
        left = list(options)
        if count > len(left):
            raise ValueError(f"{name}: {count} are to be drawn out of {len(left)}.")
        drawn = []
        for k in range(count):
            number = int.from_bytes(digest(self._key, self._student, self._exercise, name, str(k)), "big")
            drawn.append(left.pop(number % len(left)))
        return drawn

    def one_right(self, name: str, right: Sequence[Item], wrong: Sequence[Item], count: int = 4) -> tuple[Item, ...]:
        """Options for a choice, in any order: one of the right ones, and wrong ones.

        Examples
        --------
        >>> options = Lots(b"key", "s1", "planar").one_right("trial", ["right", "too"], ["wrong", "false", "no"], 3)
        >>> len(options), len({"right", "too"} & set(options))
        (3, 1)
        """
        drawn = [self.one(f"{name}, right", right), *self.some(f"{name}, wrong", wrong, count - 1)]
        return tuple(self.shuffled(f"{name}, order", drawn))

    def shuffled(self, name: str, options: Sequence[Item]) -> list[Item]:
        """All of some options, in another order."""
        return self.some(name, options, len(options))
