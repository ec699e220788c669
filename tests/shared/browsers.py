"""The browser of the tests, started anew where it died.

Chromium itself crashes now and then, in a thread of its own. That says nothing about the book, but would fail the test
at hand and each one after it that shares the browser. So such a test gets a second browser, once; nothing else is ever
run again.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import chromium
import pytest
from _pytest.runner import runtestprotocol

running: list[Any] = []


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
        running[:] = [started]
        yield started
        running.clear()
        if started.is_connected():
            started.close()


def pytest_runtest_protocol(item: pytest.Item, nextitem: pytest.Item | None) -> bool:
    """Run a test; where its browser died, take down all that was set up with it, and run the test once more."""
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    reports = runtestprotocol(item, log=False, nextitem=nextitem)
    if died():
        # What pages say when they are closed in a dead browser is no news.
        with suppress(Exception):
            item.session._setupstate.teardown_exact(None)
        if any(report.failed for report in reports):
            warnings.warn(f"The browser died in {item.nodeid}, which ran again in another.", stacklevel=1)
            reports = runtestprotocol(item, log=False, nextitem=nextitem)
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


def died() -> bool:
    """Say whether the browser is gone, though nobody closed it."""
    return any(not started.is_connected() for started in running)
