"""What tests of live code share."""

from __future__ import annotations

import json
from pathlib import Path

import pytest


def needs_numpy(site: Path) -> None:
    """Skip a test whose page would have to fetch numpy from another host; the build has said so loudly."""
    (lock,) = (site / "run").glob("lock-*.json")
    numpy = json.loads(lock.read_text("utf-8"))["packages"]["numpy"]
    if numpy["file_name"].startswith("http"):
        pytest.skip(
            "NO NUMPY FOR THE BROWSER: no code runs in the page here. DHBOOK_WHEELS may name a folder with a wheel."
        )
