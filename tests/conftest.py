"""What the tests share: the root of the repository, the book built once a session, and a browser."""

from __future__ import annotations

import os
import subprocess
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from browsers import browser, pytest_runtest_protocol
from building import build_book
from filelock import FileLock
from hypothesis import settings
from serve import server
from sources import book_of_one_page, copy_sources

__all__ = ["browser", "pytest_runtest_protocol"]

ROOT = Path(__file__).parent.parent

# Copies of the book are built elsewhere, and find numpy for the browser where the book itself finds it.
if (WHEELS := ROOT.parent / "shared" / "wasm").is_dir():
    os.environ.setdefault("DHBOOK_WHEELS", str(WHEELS))

# No test measures time, so none of Hypothesis does.
settings.register_profile("untimed", deadline=None)
settings.load_profile("untimed")


@pytest.fixture(scope="session")
def root() -> Path:
    """The root of the repository."""
    return ROOT


@pytest.fixture(scope="session")
def built_once(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> Callable[..., Path]:
    """Build a site under a name, once, whatever the number of test processes; returns its folder."""
    base = tmp_path_factory.getbasetemp()
    base = base if worker_id == "master" else base.parent

    def build(name: str, work: Callable[[Path], subprocess.CompletedProcess[str]]) -> Path:
        shared = base / name
        shared.mkdir(exist_ok=True)
        with FileLock(shared / "lock"):
            done = shared / "built"
            if not done.exists():
                built = work(shared)
                done.write_text(built.stdout if built.returncode else "")
        if failure := done.read_text():
            pytest.fail(f"The book does not build:\n{failure}")
        return shared / "_build" / "html"

    return build


@pytest.fixture(scope="session")
def site(built_once: Callable[..., Path]) -> Path:
    """The folder of the built site."""
    return built_once("book", lambda into: build_book(ROOT, into))


@pytest.fixture(scope="session")
def address(site: Path) -> Iterator[str]:
    """Where the site is served."""
    httpd = server(site)
    threading.Thread(target=httpd.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{httpd.server_address[1]}"
    httpd.shutdown()


@pytest.fixture(scope="session")
def questions_site(built_once: Callable[..., Path]) -> Path:
    """The folder of a site of one page, with one question of each kind."""

    def build(into: Path) -> subprocess.CompletedProcess[str]:
        page = (ROOT / "tests/book/pages/questions.md").read_text("utf-8")
        copy = book_of_one_page(into / "copy", page, "questions")
        return build_book(copy, into, environment={"PYTHONPATH": str(copy)})

    return built_once("questions", build)


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of what the book is built from, to be changed by a test."""
    return copy_sources(tmp_path / "copy")
