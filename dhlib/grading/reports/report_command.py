"""``dhlib report``: write the reports of a class anew, or show who changed what."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from dhlib.grading.batch.store import Store
from dhlib.grading.reports.arguments import add_results, add_wishes, keep_wishes
from dhlib.grading.reports.audit import audit
from dhlib.grading.reports.pseudonyms import pseudonyms
from dhlib.grading.reports.write import write_reports


def add_report(commands: Any) -> None:
    """Add ``report`` to the commands of the parser."""
    parser = commands.add_parser(
        "report",
        help="write grades.csv, the class page and the feedback pages",
        description="Write grades.csv, class.html and a feedback page for each student into the folder of the results. "
        "Nothing is graded again. What is said here about the pages is kept, and holds for the other commands too.",
    )
    add_results(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="where they go, if not beside the results")
    add_wishes(parser)
    parser.add_argument("--audit", action="store_true", help="only show what was graded, and who changed what and when")
    parser.set_defaults(run=report)


def report(options: argparse.Namespace) -> int:
    """Write, or show the audit trail."""
    with Store(options.results) as store:
        settings = keep_wishes(store, options)
        if options.audit:
            print("\n".join(audit(store, pseudonyms(store) if settings.pseudonyms else None)))
            return 0
        written = write_reports(store, options.out)
    print(f"Grades: {written.grades}\nClass: {written.class_page}\nFeedback: {written.feedback} ({written.students})")
    return 0
