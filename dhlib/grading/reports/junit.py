"""JUnit XML, as continuous integration reads it: one suite a student, one case a part."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree import ElementTree

from dhlib.grading.marks import HEADLINES
from dhlib.grading.reports.cells import number
from dhlib.grading.reports.formats import Files, Wishes
from dhlib.grading.reports.records import Record

#: Nothing was handed in that could be marked.
UNMARKED = "unmarked"


def write(records: Sequence[Record], wishes: Wishes) -> Files:
    """One file for all."""
    suites = [_suite(record) for record in records]
    totals = {name: str(sum(int(suite.get(name, "0")) for suite in suites)) for name in ("tests", "failures", "errors")}
    root = ElementTree.Element("testsuites", {"name": "dhlib grade", **totals})
    root.extend(suites)
    ElementTree.indent(root)
    return {"junit.xml": ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n"}


def _suite(record: Record) -> ElementTree.Element:
    failures = sum(not answer.passed for answer in record.answers)
    errors = 0 if record.answers else 1
    suite = ElementTree.Element(
        "testsuite",
        {
            "name": xml_text(f"{record.exercise or 'unknown'}: {record.name}"),
            "tests": str(len(record.answers) or 1),
            "failures": str(failures),
            "errors": str(errors),
            "skipped": "0",
            "time": f"{record.submission.seconds:.3f}",
            "timestamp": record.submission.graded_at[:19],
        },
    )
    properties = ElementTree.SubElement(suite, "properties")
    for name, value in (("points", record.points), ("out_of", record.out_of), ("deducted", record.deducted)):
        ElementTree.SubElement(properties, "property", {"name": name, "value": number(value)})
    place = xml_text(record.exercise or "unknown")
    for answer in record.answers:
        row = answer.row
        case = ElementTree.SubElement(suite, "testcase", {"name": xml_text(row.part), "classname": place, "time": "0"})
        if not answer.passed:
            about = {"type": row.verdict, "message": xml_text(row.message or HEADLINES[row.verdict])}
            failure = ElementTree.SubElement(case, "failure", about)
            failure.text = xml_text(f"{number(answer.points)} of {number(row.out_of)} points. {row.message}")
    if not record.answers:
        case = ElementTree.SubElement(suite, "testcase", {"name": UNMARKED, "classname": place, "time": "0"})
        about = {"type": record.submission.status, "message": xml_text(record.submission.message)}
        ElementTree.SubElement(case, "error", about)
    return suite


def xml_text(text: str) -> str:
    r"""Text without the characters that no XML may hold.

    Examples
    --------
    >>> xml_text("a\x00b\ud800c\uffff")
    'a b c '
    """
    return "".join(
        c if c in "\t\n\r" or " " <= c <= "\ud7ff" or "\ue000" <= c <= "\ufffd" or c > "\uffff" else " " for c in text
    )
