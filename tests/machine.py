"""What the tests want of the machine: two browsers, and a sandbox to grade in.

Prints what was found. What is missing is installed where that needs no question: by apt-get, as root, on a Debian.
Where it cannot be had, a line says how to get it and which tests are skipped; with ``CI=true`` that is an error.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass

import chromium


@dataclass(frozen=True)
class Program:
    """A program that the tests want."""

    name: str
    package: str
    serves: str
    find: Callable[[], str | None]
    advice: str


WANTED = (
    Program("Chromium", "chromium", "browser tests", chromium.find, chromium.ADVICE),
    Program(
        "Firefox",
        "firefox-esr",
        "tests in a second browser",
        lambda: shutil.which("firefox-esr") or shutil.which("firefox"),
        "Debian: apt install firefox-esr",
    ),
    Program(
        "bubblewrap",
        "bubblewrap",
        "tests of the grader's sandbox",
        lambda: shutil.which("bwrap"),
        "Debian and Ubuntu: apt install bubblewrap",
    ),
)


def install(packages: list[str]) -> None:
    """Install packages by apt-get, if this is a Debian and we are root; say nothing otherwise."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or not shutil.which("apt-get"):
        return
    print(f"── {', '.join(packages)}, by apt-get ──", flush=True)
    quietly = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    for words in (["update", "-qq"], ["install", "-qq", "-y", "--no-install-recommends", *packages]):
        if subprocess.run(["apt-get", *words], env=quietly, stdout=subprocess.DEVNULL, check=False).returncode != 0:
            return


def main() -> int:
    """Find or install, and report."""
    wanted = [program for program in WANTED if sys.platform == "linux" or program.name != "bubblewrap"]
    if missing := [program.package for program in wanted if program.find() is None]:
        install(missing)
    lacking = False
    for program in wanted:
        if path := program.find():
            print(f"{program.serves}: {path}")
        else:
            lacking = True
            print(
                f"\n*** NO {program.name.upper()}: {program.serves} are skipped. {program.advice} ***\n",
                file=sys.stderr,
            )
    return 1 if lacking and chromium.in_ci() else 0


if __name__ == "__main__":
    sys.exit(main())
