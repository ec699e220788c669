"""How the reports of a class are written: said once, kept with the results, and used by every command after."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

from dhlib.grading.batch.store import Store

KEY = "reports"


@dataclass(frozen=True)
class Settings:
    """How reports are written.

    Parameters
    ----------
    book : str
        Address of the book, for links.
    reveal : bool
        Whether feedback shows what would have been right.
    pseudonyms : bool
        Whether names stay out.
    exercises : str
        Where exercises are looked for first.
    key : str
        Where the key of the course is, if students have numbers of their own; the key itself is not kept.
    """

    book: str = ""
    reveal: bool = False
    pseudonyms: bool = False
    exercises: str = ""
    key: str = ""

    @property
    def folder(self) -> Path | None:
        """Where exercises are looked for first."""
        return Path(self.exercises) if self.exercises else None

    def read_key(self) -> bytes | None:
        """The key of the course; None if there is none, or it is not there any more."""
        from dhlib.grading.course.keys import read_key

        return read_key(self.key) if self.key and Path(self.key).exists() else None


def read_settings(store: Store) -> Settings:
    """The settings that were kept."""
    try:
        kept: dict[str, Any] = json.loads(store.meta(KEY, "{}"))
    except ValueError:
        kept = {}
    known = asdict(Settings())
    return replace(Settings(), **{name: value for name, value in kept.items() if name in known})


def change_settings(store: Store, **said: Any) -> Settings:
    """Keep what was said; None leaves a setting as it is."""
    settings = replace(read_settings(store), **{name: value for name, value in said.items() if value is not None})
    store.set_meta(KEY, json.dumps(asdict(settings)))
    return settings
