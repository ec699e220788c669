"""Make again only what is made of something new.

What the end of a build makes for the whole site takes seconds, and is mostly what it was: the wheel of the library, the
pruned style sheets, the cut fonts, the icons. Each is kept in ``_build/.kept``, named by what it is made of. What a
build has not asked for is removed at its end.
"""

from __future__ import annotations

import hashlib
import shutil
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sphinx.application import Sphinx

FOLDER = ".kept"


def digest(*parts: bytes | str | Path) -> str:
    """Return a hash over parts, in their order; of a path, over its name and content."""
    found = hashlib.sha256()
    for part in parts:
        content = part.read_bytes() if isinstance(part, Path) else part if isinstance(part, bytes) else part.encode()
        found.update(f"{part.name if isinstance(part, Path) else ''} {len(content)}\n".encode() + content)
    return found.hexdigest()[:20]


class Keeper:
    """What earlier builds made, below a folder, and what this one asks for."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.asked: set[str] = set()

    def made(self, name: str, make: Callable[[Path], object], *parts: bytes | str | Path) -> Path:
        """Return a folder with what `make` writes into it: as an earlier build did of the same `parts`, or anew.

        Parameters
        ----------
        name : str
            What it is.
        make : callable
            Writes into the folder that it is given.
        *parts : bytes, str or Path
            All that the result hangs on, the code that makes it among it.
        """
        entry = f"{name}-{digest(*parts)}"
        self.asked.add(entry)
        path = self.folder / entry
        if not path.is_dir():
            self.folder.mkdir(parents=True, exist_ok=True)
            # A folder that has its name is whole: it is filled under another one.
            draft = Path(tempfile.mkdtemp(prefix="draft-", dir=self.folder))
            try:
                make(draft)
                draft.rename(path)
            except OSError:
                if not path.is_dir():  # else another build was faster
                    raise
            finally:
                shutil.rmtree(draft, ignore_errors=True)
        return path

    def forget_the_rest(self) -> None:
        """Remove what this build did not ask for."""
        for path in self.folder.glob("*"):
            if path.name not in self.asked:
                shutil.rmtree(path, ignore_errors=True)


def begin(app: Sphinx) -> None:
    """Get a keeper ready."""
    app.keeper = Keeper(Path(app.outdir).parent / FOLDER)  # type: ignore[attr-defined]


def end(app: Sphinx, exception: Exception | None) -> None:
    """Forget what a whole build of the site has not asked for."""
    if exception is None and app.builder.name == "html":
        app.keeper.forget_the_rest()  # type: ignore[attr-defined]


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("builder-inited", begin, priority=100)
    app.connect("build-finished", end, priority=990)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
