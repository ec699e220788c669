"""Names for files, made of names of people."""

from __future__ import annotations

import re
from collections.abc import Sequence


def file_names(titles: Sequence[str]) -> list[str]:
    """A name for each, plain and different from all others, whatever the file system.

    Examples
    --------
    >>> file_names(["a/quick shot", "a_quick_shot", "../..", "Ä"])
    ['a_quick_shot', 'a_quick_shot-2', 'student', 'Ä']
    """
    names: list[str] = []
    taken: set[str] = set()
    for title in titles:
        # byte counts matter to file systems: a hundred letters of any script stay below 255 bytes in most
        stem = re.sub(r"[^\w-]+", "_", title).strip("_-")[:60] or "student"
        name, k = stem, 2
        while name.casefold() in taken:
            name, k = f"{stem}-{k}", k + 1
        taken.add(name.casefold())
        names.append(name)
    return names
