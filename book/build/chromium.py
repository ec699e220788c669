"""Find Chromium for the browser tests, or get it where that needs no question.

Printed is its path. Where there is none and it cannot be had, a line says how to get it; with ``CI=true``
that is an error.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

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


def install() -> None:
    """Install Chromium by apt-get, if this is a Debian and we are root; say nothing otherwise."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or not shutil.which("apt-get"):
        return
    print("── Chromium for the browser tests, by apt-get ──", flush=True)
    quietly = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    for words in (["update", "-qq"], ["install", "-qq", "-y", "--no-install-recommends", "chromium"]):
        if subprocess.run(["apt-get", *words], env=quietly, check=False).returncode != 0:
            return


def in_ci() -> bool:
    """Say whether a test that cannot run must count as failed."""
    return os.environ.get("CI", "").lower() in {"1", "true", "yes"}


def main() -> int:
    """Find or install, and report."""
    path = find()
    if path is None:
        install()
        path = find()
    if path is None:
        print(f"\n*** NO CHROMIUM: the browser tests will be skipped. {ADVICE} ***\n", file=sys.stderr)
        return 1 if in_ci() else 0
    print(f"browser tests: {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
