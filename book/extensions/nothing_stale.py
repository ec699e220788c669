"""After a build with warnings, the next one starts from the sources again.

Sphinx remembers pages it has read, also those that drew a warning, and does not repeat the warning: a build
that failed would pass the second time. Executed outputs stay cached, so that starting again costs seconds.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from sphinx.application import ENV_PICKLE_FILENAME

if TYPE_CHECKING:
    from sphinx.application import Sphinx


def forget_after_failure(app: Sphinx, exception: Exception | None) -> None:
    """Remove what Sphinx remembers if this build warned or broke off."""
    if exception is not None or app._warncount:
        (Path(app.doctreedir) / ENV_PICKLE_FILENAME).unlink(missing_ok=True)


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("build-finished", forget_after_failure, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
