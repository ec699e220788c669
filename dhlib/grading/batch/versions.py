"""What marks depend on, beside the exercise."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from typing import Any


@cache
def versions() -> dict[str, Any]:
    """The versions of Python and of what computes marks."""
    return {"python": platform.python_version(), **{name: _version(name) for name in ("dhlib", "numpy", "sympy")}}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "unknown"
