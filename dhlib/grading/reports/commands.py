"""The commands that come after grading."""

from __future__ import annotations

from typing import Any

from dhlib.grading.reports.adjust_command import add_adjust
from dhlib.grading.reports.export_command import add_export
from dhlib.grading.reports.forget_command import add_forget
from dhlib.grading.reports.report_command import add_report


def add_reports(commands: Any) -> None:
    """Add them to the commands of the parser."""
    for add in (add_report, add_export, add_adjust, add_forget):
        add(commands)
