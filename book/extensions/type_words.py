"""Link the types that docstrings name, where they are ours; other words of a type are plain text.

numpydoc would link every word, ``float`` and ``or`` among them, to inventories that the network would be needed for.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpydoc.numpydoc

import dhlib
import dhlib.joints
import dhlib.scene

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.config import Config


def link_our_types(_app: Sphinx, config: Config) -> None:
    """Map the public classes to where the reference describes them."""
    numpydoc.numpydoc.DEFAULT_LINKS = {}
    classes = {name: f"dhlib.{name}" for name in dhlib.__all__ if isinstance(getattr(dhlib, name), type)}
    config["numpydoc_xref_aliases"] = classes | {"Joint": "dhlib.joints.Joint", "Sketch": "dhlib.scene.Sketch"}
    config["numpydoc_xref_ignore"] = "all"
    config["numpydoc_xref_param_type"] = True


def setup(app: Sphinx) -> dict[str, Any]:
    """Tell Sphinx."""
    app.connect("config-inited", link_our_types, priority=100)  # before numpydoc adds its own
    return {"parallel_read_safe": True, "parallel_write_safe": True}
