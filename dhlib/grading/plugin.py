"""``pytest --dh-grade NOTEBOOK``: one test per part, with its points.

Loaded by ``pytest_dhlib`` only when the option is given, so that pytest elsewhere pays nothing for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from dhlib.errors import DHError
from dhlib.grading.check import tell
from dhlib.grading.exercise import Part
from dhlib.grading.grade import GRADED, Result, grade_notebook
from dhlib.grading.marks import Mark
from dhlib.grading.wall import Limits, Sandbox
from dhlib.grading.wall.limits import UNSAFE


class NotYet(Exception):
    """A part that is not right yet."""


class GradedNotebook(pytest.File):
    """A notebook, graded once."""

    _result: Result | None = None
    unsafe = False

    @property
    def result(self) -> Result:
        """What came of it; graded when first asked for."""
        if self._result is None:
            option = self.config.option
            with own_box(Limits.of(option.dh_timeout)) as box:
                self.unsafe = box.unsafe
                self._result = grade_notebook(
                    self.path, option.dh_exercise, option.dh_exercises, sandbox=box, key=option.dh_key
                )
        return self._result

    def collect(self) -> Iterator[pytest.Item]:
        """Yield one test per part."""
        if self.result.exercise is None:
            raise self.CollectError(self.result.message)
        for part in self.result.exercise.parts:
            yield GradedPart.from_parent(self, name=part.id, part=part)

    def mark(self, part_id: str) -> Mark:
        """The mark of a part."""
        return next(mark for mark in self.result.marks if mark.part == part_id)


class GradedPart(pytest.Item):
    """One part of a notebook."""

    parent: GradedNotebook

    def __init__(self, part: Part, **options: Any) -> None:
        super().__init__(**options)
        self.part = part

    def runtest(self) -> None:
        """Pass if nothing is left to do."""
        mark = self.parent.mark(self.part.id)
        self.user_properties.append(("dh_unsafe", self.parent.unsafe))
        self.user_properties += [("dh_points", mark.points), ("dh_out_of", mark.out_of), ("dh_verdict", mark.verdict)]
        if not mark.passed:
            note = self.parent.result.message if self.parent.result.status != GRADED else ""
            raise NotYet(f"{tell(mark)} {note}".rstrip())

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The sentence alone."""
        return str(excinfo.value) if excinfo.errisinstance(NotYet) else super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Name the part by its title."""
        return self.path, None, f"{self.part.id}: {self.part.title} ({self.part.points:g} pt)"


def own_box(limits: Limits) -> Sandbox:
    """A sandbox where one can be built, else none: who runs pytest on a notebook may run the notebook too."""
    try:
        return Sandbox(limits)
    except DHError:
        return Sandbox(limits, unsafe=True)


class Grading:
    """The hooks of a grading run."""

    def __init__(self, paths: list[Path]) -> None:
        self.paths = paths

    def pytest_collect_file(self, file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
        """Take the notebooks that were named."""
        return GradedNotebook.from_parent(parent, path=file_path) if file_path in self.paths else None

    def pytest_terminal_summary(self, terminalreporter: Any) -> None:
        """Sum up the points."""
        points: dict[str, list[float]] = {}
        unsafe = False
        for reports in terminalreporter.stats.values():
            for report in reports:
                earned = dict(getattr(report, "user_properties", ()))
                unsafe |= bool(earned.get("dh_unsafe"))
                if getattr(report, "when", "") == "call" and "dh_points" in earned:
                    total = points.setdefault(report.nodeid.split("::")[0], [0.0, 0.0])
                    total[0] += earned["dh_points"]
                    total[1] += earned["dh_out_of"]
        for notebook, (earned_points, out_of) in points.items():
            terminalreporter.write_line(f"{notebook}: {earned_points:g} of {out_of:g} points")
        if unsafe:
            terminalreporter.write_line(UNSAFE)
