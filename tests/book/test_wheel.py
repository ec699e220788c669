"""The wheel holds the library, its pytest option and the exercises as students get them, and nothing else."""

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
    for name in ("pyproject.toml", "README.md", "LICENSE", "pytest_dhlib.py"):
        shutil.copy(root / name, source)
    for name in ("exercises/arm.py", "exercises/arm.ipynb", "solutions/arm.ipynb", "book/arm.md"):
        (source / name).parent.mkdir(exist_ok=True)
        (source / name).write_text("")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel"]
    subprocess.run(build, cwd=source, check=True, capture_output=True)
    (wheel,) = (source / "dist").glob("*.whl")
    names = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    library = {path.relative_to(root).as_posix() for path in (root / "dhlib").rglob("*.py")}
    assert {name for name in names if name.endswith(".py")} == library | {"dhlib/_exercises/arm.py", "pytest_dhlib.py"}
    assert all(name.startswith("dhlib/") for name in names - {"pytest_dhlib.py"})
    assert {name for name in names if name.endswith(".ipynb")} == {"dhlib/_exercises/arm.ipynb"}
