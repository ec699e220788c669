"""A browser that dies costs no test its result, and no test that fails gets a second chance otherwise."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.browser

TESTS = """
import pathlib

import pytest


@pytest.fixture(scope="module")
def page(browser):
    page = browser.new_page()
    yield page
    page.close()


def count(name):
    with open(name, "a") as file:
        file.write("x")
    return len(pathlib.Path(name).read_text())


def crash(browser):
    with pytest.raises(Exception):
        browser.new_browser_cdp_session().send("Browser.crash")


def works(page):
    page.set_content("<p>alive</p>")
    assert page.inner_text("p") == "alive"


def test_before(page):
    works(page)


def test_dies_once(page, browser):
    if count("once") == 1:
        crash(browser)
    works(page)


def test_after(page):
    works(page)


def test_dies_each_time(page, browser):
    count("each")
    crash(browser)
    works(page)


def test_after_that(page):
    works(page)


def test_is_wrong(page):
    count("wrong")
    assert page.inner_text("p") == "dead"


def test_without_a_browser():
    assert True
"""


def test_a_browser_that_died_is_started_again(browser: Any, root: Path, tmp_path: Path) -> None:
    (tmp_path / "conftest.py").write_text("from browsers import browser, pytest_runtest_protocol\n", "utf-8")
    (tmp_path / "test_pages.py").write_text(TESTS, "utf-8")
    paths = os.pathsep.join(str(root / folder) for folder in ("tests/shared", "book/build"))
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-v", "-p", "no:cacheprovider", "--rootdir", str(tmp_path), str(tmp_path)],
        cwd=tmp_path,
        env=os.environ | {"PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=False,
    )
    failed = {line.split("::")[1].split()[0] for line in run.stdout.splitlines() if line.startswith("FAILED")}
    assert failed == {"test_dies_each_time", "test_is_wrong"}, run.stdout
    assert "5 passed" in run.stdout
    runs = {name: len((tmp_path / name).read_text()) for name in ("once", "each", "wrong")}
    assert runs == {"once": 2, "each": 2, "wrong": 1}
