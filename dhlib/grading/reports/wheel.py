"""The wheel of this very dhlib, made of what is installed: so that it grades elsewhere as it does here."""

from __future__ import annotations

import base64
import hashlib
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

import dhlib
from dhlib.errors import DHError
from dhlib.grading.reports.zips import packed

#: Of the metadata that pip keeps, what a wheel begins with.
KEPT = ("METADATA", "entry_points.txt")


def wheel() -> tuple[str, bytes]:
    """Name and content of the wheel.

    Returns
    -------
    (str, bytes)

    Raises
    ------
    DHError
        If dhlib runs without being installed.
    """
    try:
        installed = distribution("dhlib")
    except PackageNotFoundError:
        raise DHError("dhlib runs here without being installed; install it, and export again.") from None
    package = Path(dhlib.__file__).parent
    files = {
        f"dhlib/{path.relative_to(package).as_posix()}": path.read_bytes()
        for path in sorted(package.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    }
    option = package.parent / "pytest_dhlib.py"
    files[option.name] = option.read_bytes()
    source = package.parent / "exercises"  # in a wheel they stand within the package
    if not (package / "_exercises").is_dir():
        files |= {
            f"dhlib/_exercises/{path.name}": path.read_bytes()
            for path in sorted(source.glob("*"))
            if path.suffix in (".py", ".ipynb")
        }
    about = f"dhlib-{installed.version}.dist-info"
    for name in KEPT:
        files[f"{about}/{name}"] = (installed.read_text(name) or "").encode()
    files[f"{about}/WHEEL"] = b"Wheel-Version: 1.0\nGenerator: dhlib\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
    record = f"{about}/RECORD"
    files[record] = "".join([*(_line(name, content) for name, content in files.items()), f"{record},,\n"]).encode()
    return f"dhlib-{installed.version}-py3-none-any.whl", packed(files)


def _line(name: str, content: bytes) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"
