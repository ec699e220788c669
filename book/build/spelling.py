"""Check the spelling of the book's text: British English, and the words of ``book/words.txt``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
sys.path.append(str(ROOT / "book" / "extensions"))

from formulas import node_program  # noqa: E402

TEXTS = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "book/*.md")


def misspelt(*texts: Path, folder: Path = ROOT) -> str:
    """Return what the spell checker finds in some files of a folder; empty if nothing."""
    program = ROOT / "node_modules" / "cspell" / "bin.mjs"
    options = ["lint", "--config", str(ROOT / "cspell.json"), "--no-progress", "--no-summary", "--show-suggestions"]
    done = subprocess.run(
        [node_program(), str(program), *options, "--root", str(folder), *map(str, texts)],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
        check=False,
    )
    return done.stdout if done.returncode else ""


def main() -> int:
    """Check all texts."""
    found = misspelt(*(path for pattern in TEXTS for path in sorted(ROOT.glob(pattern))))
    if found:
        print(found + "\nA name or a term that is right goes into book/words.txt.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
