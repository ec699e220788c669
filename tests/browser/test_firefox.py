"""A second browser: each kind of page in Firefox, each figure and a question used by keys, served and from the disk."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import chromium
import numpy as np
import pytest
from formulas import node_program

from dhlib import robots

pytestmark = [pytest.mark.book, pytest.mark.browser]

PROGRAM = Path(__file__).with_name("firefox.mjs")
ADVICE = "Debian: apt install firefox-esr"


@pytest.fixture(scope="session")
def firefox() -> str:
    """The Firefox of this machine; skipped where there is none, and a failure in CI."""
    path = shutil.which("firefox-esr") or shutil.which("firefox")
    if path is None:
        if chromium.in_ci():
            pytest.fail(f"No Firefox, and CI must not skip. {ADVICE}")
        pytest.skip(f"no Firefox: the tests in a second browser are not run. {ADVICE}")
    return path


@pytest.fixture(scope="session")
def drive(firefox: str, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], dict[str, Any]]:
    """Drive a site in Firefox; returns what was seen on each page."""
    seen: dict[str, dict[str, Any]] = {}

    def report(site: str) -> dict[str, Any]:
        if site not in seen:
            home = tmp_path_factory.mktemp("firefox")
            done = subprocess.run(
                [node_program(), str(PROGRAM), firefox, site],
                env=os.environ | {"HOME": str(home)},
                capture_output=True,
                encoding="utf-8",
                timeout=280,
                check=False,
            )
            assert done.returncode == 0, done.stderr
            seen[site] = json.loads(done.stdout)
        return seen[site]

    return report


@pytest.fixture(params=["http", "file"])
def report(
    request: pytest.FixtureRequest, drive: Callable[[str], dict[str, Any]], site: Path, address: str
) -> dict[str, Any]:
    return drive(address if request.param == "http" else site.as_uri())


@pytest.mark.timeout(300)
def test_firefox_reads_and_drives_each_kind_of_page(report: dict[str, Any]) -> None:
    pages = {name: seen for name, seen in report.items() if name != "control"}
    assert {name: seen["complaints"] for name, seen in pages.items() if seen["complaints"]} == {}
    assert pages["book/index.html"]["heading"].startswith("The DH book")
    assert pages["book/cheatsheet.html"]["formulas"] > 10
    if "search.html?q=twist" in pages:
        assert pages["search.html?q=twist"]["found"] > 3
    for name in ("book/classic.html", "book/pa10.html", "book/placing.html"):
        for moment in pages[name].values():
            if isinstance(moment, dict):
                assert moment["broken"] == 0, name
                assert moment["arrows"] >= 4, name
                assert moment["height"] > 300, name

    link = pages["book/classic.html"]
    assert link["turned"]["state"]["theta"] == 180
    assert link["turned"]["matrix"] != link["first"]["matrix"]
    assert "Step 1 of 4" in link["step"]["sentence"]
    assert link["verdict"].startswith(("Right.", "Not yet."))

    robot, arm = pages["book/pa10.html"], robots.pa10_7c()
    hand = arm.fk(robot["first"]["state"])
    assert "Joint 2 is at its limit" in robot["round"]["sentence"]
    assert np.abs(arm.fk(robot["round"]["state"]) - hand).max() < 1e-9
    shown = np.array([float(entry.replace("−", "-")) for entry in robot["moved"]["matrix"]]).reshape(4, 4)
    assert np.abs(shown - arm.fk(robot["moved"]["state"])).max() < 6e-4
    assert robot["moved"]["state"][3] == pytest.approx(arm.joints[3].limits[0], abs=0.02)

    place = pages["book/placing.html"]
    assert place["slid"]["state"][0]["s"] != place["first"]["state"][0]["s"]
    assert place["over"]["state"][0]["sense"] == -place["slid"]["state"][0]["sense"]


def test_what_firefox_complains_of_would_be_heard(report: dict[str, Any]) -> None:
    assert any("planted" in text for text in report["control"])
    assert any("thrown" in text for text in report["control"])
