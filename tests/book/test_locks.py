"""Locks hold hashes and no addresses, and agree with what they lock."""

from __future__ import annotations

import json
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

ADDRESS = re.compile(r"https?://|\bfile:|index-url|(?<![\w.])[\w-]+(\.[\w-]+)*\.(org|com|io|net|dev|local)\b(?!\w)")


def python_locks(root: Path) -> list[Path]:
    return sorted([*(root / "requirements").glob("*.lock"), *(root / "bench" / "peers").glob("*.lock")])


def locks(root: Path) -> list[Path]:
    return [*python_locks(root), root / "package-lock.json"]


def without_funding(npm_lock: str) -> str:
    """Drop where authors ask for support: npm copies it into its lock, and nothing is fetched from there."""
    lock = json.loads(npm_lock)
    for package in lock["packages"].values():
        package.pop("funding", None)
    return json.dumps(lock, indent=1)


def test_locks_hold_no_address(root: Path) -> None:
    for lock in locks(root):
        text = lock.read_text("utf-8")
        for number, line in enumerate((without_funding(text) if lock.suffix == ".json" else text).splitlines(), 1):
            assert not ADDRESS.search(line), f"{lock.name}:{number}: {line}"


@pytest.mark.parametrize(
    "line",
    [
        "--index-url https://mirror.example.org/simple",
        '"resolved": "https://registry.example.net/mathjax.tgz",',
        "sphinx @ file:///srv/sphinx.whl",
    ],
)
def test_an_address_would_be_found(line: str) -> None:
    assert ADDRESS.search(line)


def test_every_pin_has_hashes(root: Path) -> None:
    for lock in python_locks(root):
        text = lock.read_text("utf-8").replace("\\\n", " ")
        pins = [line for line in text.splitlines() if re.match(r"[a-z0-9]", line)]
        assert pins
        for pin in pins:
            assert re.match(r"[a-z0-9._-]+==\S+ .*--hash=sha256:[0-9a-f]{64}", pin), pin


def test_npm_lock_has_integrity(root: Path) -> None:
    packages = json.loads((root / "package-lock.json").read_text())["packages"]
    for name, entry in packages.items():
        assert name == "" or entry["integrity"].startswith("sha512-"), name


def test_what_is_asked_for_by_version_is_locked_so(root: Path) -> None:
    groups = tomllib.loads((root / "pyproject.toml").read_text("utf-8"))["dependency-groups"]
    pinned = [name for name in groups["book"] if "==" in name]
    lock = (root / "requirements" / "dev.lock").read_text("utf-8")
    assert "jupyter-book==1.0.4.post1" in pinned
    assert "sphinx-book-theme==1.2.0" in pinned
    for pin in pinned:
        assert re.search(rf"^{re.escape(pin)} ", lock, re.MULTILINE), pin


def test_no_tracked_file_names_a_registry(root: Path) -> None:
    """Which index serves the packages is the user's choice: no file of ours may take it from them."""
    tracked = subprocess.run(["git", "ls-files", "-z"], cwd=root, capture_output=True, check=False, text=True).stdout
    if not tracked:
        pytest.skip("not a git clone")
    registry = re.compile(r"pypi\.(org|python)|pythonhosted|registry\.(npmjs|yarnpkg)|PIP_INDEX|extra-index" + "-url")
    for name in tracked.strip("\0").split("\0"):
        path = root / name
        if path.is_file() and path.suffix not in {".png", ".whl"} and path != Path(__file__):
            found = registry.search(path.read_text("utf-8", errors="ignore"))
            assert not found, f"{name}: {found}"
