"""The wheel holds the library and what the exercises ask, and nothing else."""

from __future__ import annotations

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path


def test_wheel(root: Path, tmp_path: Path) -> None:
    source = tmp_path / "source"
    ignore = shutil.ignore_patterns("__pycache__")
    for name in ("dhlib", "tests"):
        shutil.copytree(root / name, source / name, ignore=ignore)
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(root / name, source)
    (source / "exercises").mkdir()
    for name in ("arm.py", "arm.ipynb"):
        (source / "exercises" / name).write_text("")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel"]
    subprocess.run(build, cwd=source, check=True, capture_output=True)
    (wheel,) = (source / "dist").glob("*.whl")
    names = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    library = {path.relative_to(root).as_posix() for path in (root / "dhlib").rglob("*.py")}
    assert {name for name in names if name.endswith(".py")} == library | {"dhlib/_exercises/arm.py"}
    assert all(name.startswith("dhlib/") for name in names)
    assert "dhlib/_exercises/arm.ipynb" not in names
