"""Pack the built site into one zip that reads from the disk, the wheel of the library beside it."""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
MOMENT = (2026, 1, 1, 0, 0, 0)
"""The date of every file in the zip: the same book gives the same zip."""

NOTE = """The DH book, to read offline.

Open index.html in a browser. Nothing is fetched from the network.

To run the notebooks (folder notebooks/), install the library into an environment of your own:

    python -m pip install --find-links . "dhlib[notebook]"
"""


def build_wheel(into: Path) -> Path:
    """Build the wheel of dhlib into a folder and return its path."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(into)]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = into.glob("*.whl")
    return wheel


def pack(site: Path, target: Path, extra: list[Path]) -> None:
    """Write the files of a site and some others into a zip, in one folder, in order."""
    files = {path.relative_to(site).as_posix(): path for path in site.rglob("*") if path.is_file()}
    files |= {path.name: path for path in extra}
    target.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in [("README.txt", NOTE.encode()), *((n, files[n].read_bytes()) for n in sorted(files))]:
            entry = zipfile.ZipInfo(f"dh-book/{name}", MOMENT)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, content)


def main() -> None:
    """Pack."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("site", type=Path)
    parser.add_argument("target", type=Path)
    choice = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        pack(choice.site, choice.target, [build_wheel(Path(folder))])
    print(f"{choice.target}: {choice.target.stat().st_size / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
