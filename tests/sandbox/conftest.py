"""Boxes to run notebooks in: with walls where this machine lets us build them, and without."""

import os

import pytest

from dhlib.errors import DHError
from dhlib.grading.notebook import Cell
from dhlib.grading.wall import Limits, Sandbox
from dhlib.grading.wall.outer import find_outer


def walls_or_skip():
    """Skip where no wall can be built; a failure in CI."""
    try:
        return find_outer()
    except DHError as error:
        if os.environ.get("CI") == "true":
            pytest.fail(f"No sandbox, and CI must not skip. {error}")
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def walls():
    """A sandbox with all its walls, shared by the tests of a process."""
    walls_or_skip()
    with Sandbox(Limits.of(60)) as sandbox:
        yield sandbox


@pytest.fixture(scope="session")
def no_walls():
    """None at all: a process, for the negative controls."""
    with Sandbox(Limits.of(60), unsafe=True) as sandbox:
        yield sandbox


@pytest.fixture(params=[pytest.param("walls", marks=pytest.mark.sandbox), "no_walls"])
def sandbox(request):
    """Each in turn: what an honest notebook meets is the same."""
    return request.getfixturevalue(request.param)


REQUESTS = {"A": {"form": "numbers", "shape": []}, "B": {"form": "numbers", "shape": []}}


@pytest.fixture
def run(sandbox):
    """``run(first, second)``: a notebook of two parts, A and B."""

    def run(first, second="B = 2", seconds=60.0, cell_seconds=None, setup="import math", requests=REQUESTS):
        cells = [
            Cell(setup, role="setup"),
            Cell(first, role="answer", part="A"), Cell("", role="check", part="A"),
            Cell(second, role="answer", part="B"), Cell("", role="check", part="B"),
        ]  # fmt: skip
        return sandbox.run(cells, requests, Limits(cell_seconds or seconds / 3, seconds))

    return run
