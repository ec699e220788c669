"""Gather what a release consists of: ``python release.py dist`` after the PDF and the zip were made there."""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
from pathlib import Path


def main() -> int:
    """Build the wheel, and write everything with its checksum into dist/release."""
    dist = Path(sys.argv[1])
    release = dist / "release"
    shutil.rmtree(release, ignore_errors=True)
    release.mkdir(parents=True)
    build = [sys.executable, "-m", "hatchling", "build", "-d", str(release.absolute())]
    subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
    for name in ("dh-book.pdf", "dh-book.zip"):
        shutil.copy(dist / name, release)
    shutil.make_archive(str(release / "dh-book-site"), "gztar", "_build/html")
    files = sorted(path for path in release.iterdir() if path.is_file())
    sums = [f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}" for path in files]
    (release / "SHA256SUMS").write_text("\n".join(sums) + "\n", encoding="utf-8")
    print("\n".join(sums))
    return 0


if __name__ == "__main__":
    sys.exit(main())
