"""The pytest option ``--dh-grade``: a module of its own, so that pytest does not import dhlib before it is needed."""

from __future__ import annotations

from pathlib import Path

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options."""
    group = parser.getgroup("dhlib", "exercises of the DH book")
    group.addoption(
        "--dh-grade",
        action="append",
        default=[],
        metavar="NOTEBOOK",
        help="grade a notebook: one test per part, with points",
    )
    group.addoption(
        "--dh-exercise", default="", metavar="NAME", help="which exercise it is, if the notebook does not say"
    )
    group.addoption("--dh-exercises", default=None, metavar="DIR", help="where to look for exercises first")
    group.addoption("--dh-key", default=None, metavar="FILE", help="of the course, for notebooks that were assigned")
    group.addoption("--dh-timeout", type=float, default=60.0, metavar="S", help="seconds for a notebook (60)")


@pytest.hookimpl(tryfirst=True)
def pytest_load_initial_conftests(early_config: pytest.Config) -> None:
    """Take the folders of the notebooks for those of the tests, so that no other folder's conftest is loaded."""
    named = early_config.known_args_namespace
    named.file_or_dir = [*named.file_or_dir, *named.dh_grade]


def pytest_configure(config: pytest.Config) -> None:
    """Grade what was named, and nothing else unless that was named too."""
    named = config.option.dh_grade
    if not named:
        return
    paths = [Path(name).absolute() for name in named]
    for path in paths:
        if not path.is_file():
            raise pytest.UsageError(f"--dh-grade: there is no file {path}.")
    from dhlib.errors import DHError
    from dhlib.grading.course.keys import read_key
    from dhlib.grading.plugin import Grading

    try:
        config.option.dh_key = read_key(config.option.dh_key) if config.option.dh_key else None
    except DHError as error:
        raise pytest.UsageError(f"--dh-key: {error}") from None
    if config.args_source is not pytest.Config.ArgsSource.ARGS:
        config.args = []
    config.args += [str(path) for path in paths]
    config.pluginmanager.register(Grading(paths), "dhlib-grading")
