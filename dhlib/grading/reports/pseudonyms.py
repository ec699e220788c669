"""Other names for students, where names should not be read."""

from __future__ import annotations

import hashlib
import hmac
import secrets
from collections.abc import Callable

from dhlib.grading.batch.store import Store

#: Under which the results keep the secret that the names are made with.
KEY = "pseudonym_key"


def pseudonyms(store: Store) -> Callable[[str], str]:
    """A function that gives each student another name: the same each time, and not to be guessed from the real one.

    It is made with a secret that stays in the file of the results.
    """
    key = store.meta(KEY)
    if not key:
        key = secrets.token_hex(32)
        store.set_meta(KEY, key)
    return lambda student: pseudonym(student, key)


def pseudonym(student: str, key: str) -> str:
    """The other name of one student.

    Examples
    --------
    >>> pseudonym("ada", "secret"), pseudonym("ada", "another")
    ('student-3c304861', 'student-e8a74b63')
    """
    return f"student-{hmac.new(key.encode(), student.encode(), hashlib.sha256).hexdigest()[:8]}"
