"""What the tests share: the root of the repository, the book built once a session, and a browser."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import chromium
import pytest
from building import build_book
from filelock import FileLock

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="session")
def root() -> Path:
    """The root of the repository."""
    return ROOT


@pytest.fixture(scope="session")
def site(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Path:
    """The folder of the built site: built once, whatever the number of test processes."""
    base = tmp_path_factory.getbasetemp()
    shared = (base if worker_id == "master" else base.parent) / "book"
    shared.mkdir(exist_ok=True)
    with FileLock(shared / "lock"):
        done = shared / "built"
        if not done.exists():
            built = build_book(ROOT, shared)
            if built.returncode != 0:
                done.write_text(built.stdout)
            else:
                done.touch()
    if failure := done.read_text():
        pytest.fail(f"The book does not build:\n{failure}")
    return shared / "_build" / "html"


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of what the book is built from, to be changed by a test."""
    copy = tmp_path / "copy"
    copy.mkdir()
    ignore = shutil.ignore_patterns("__pycache__", ".ipynb_checkpoints", "*.png")
    for name in ("dhlib", "book", "exercises", "requirements"):
        if (ROOT / name).exists():
            shutil.copytree(ROOT / name, copy / name, ignore=ignore)
    for name in ("_config.yml", "_toc.yml", "package-lock.json"):
        shutil.copy(ROOT / name, copy)
    for name in ("node_modules", ".tools"):
        if (ROOT / name).exists():
            (copy / name).symlink_to(ROOT / name)
    return copy


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium, without a window; skipped where there is none, and a failure in CI."""
    path = chromium.find()
    if path is None:
        if chromium.in_ci():
            pytest.fail(f"No Chromium, and CI must not skip. {chromium.ADVICE}")
        pytest.skip(f"no Chromium. {chromium.ADVICE}")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=path,
            args=["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-background-networking"],
        )
        yield started
        started.close()
