"""Find Chromium, which prints the book and drives the browser tests."""

from __future__ import annotations

import os
import shutil

NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome", "chrome", "msedge")
PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)
ADVICE = "Debian and Ubuntu: apt install chromium; or name one by CHROMIUM=/path/to/chromium"


def find() -> str | None:
    """Return the path of a Chromium on this machine, or None."""
    for candidate in (os.environ.get("CHROMIUM", ""), *NAMES, *PLACES):
        if candidate and (path := shutil.which(candidate)):
            return path
    return None


def in_ci() -> bool:
    """Say whether a test that cannot run must count as failed."""
    return os.environ.get("CI", "").lower() in {"1", "true", "yes"}
