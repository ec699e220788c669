"""The page for the lecturer: what the class understood, and what not."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dhlib.grading.reports import charts
from dhlib.grading.reports.book_links import link
from dhlib.grading.reports.feedback import Find
from dhlib.grading.reports.lecture import Cost, costs, heat, label
from dhlib.grading.reports.pages import render
from dhlib.grading.reports.records import Record, exercises_of
from dhlib.grading.reports.similarity import RARE, alike, same_files
from dhlib.grading.reports.statistics import FEW_FOR_CORRELATION, FEWEST, part_figures, unusual
from dhlib.grading.sections import named

#: Misconceptions that the next lecture should be about: more are not remembered.
TO_SAY = 3
#: A part of which the class earned less than this is named beside them.
HARD = 0.4


@dataclass(frozen=True)
class Said:
    """A misconception as the page tells it."""

    brief: str
    says: str
    students: int
    points: float
    parts: Sequence[str]
    heading: str
    chapter: str
    link: str


def class_page(records: Sequence[Record], find: Find, book: str = "") -> str:
    """A page for the lecturer, which needs nothing else: one section for each exercise.

    Parameters
    ----------
    records : sequence of Record
    find : callable
        Finds the exercise of a record, for its title.
    book : str
        Address of the book, for links.
    """
    names = [name for name in exercises_of(records) if name]
    pages = []
    for name in names or [""]:
        # what cannot be read often does not say which exercise it is: where there is one only, it is that
        mine = [r for r in records if r.exercise == name or (not r.exercise and len(names) < 2)]
        if mine:
            pages.append(_page(mine, find, book))
    pages.sort(key=lambda page: -page["students"])
    if len(names) > 1 and (unknown := [record for record in records if not record.exercise]):
        pages.append(_page(unknown, find, book))
    return render("class.html", pages=pages, fewest=FEWEST, rare=RARE)


def _page(records: Sequence[Record], find: Find, book: str) -> dict[str, Any]:
    named_one = next((record for record in records if record.exercise), records[0])
    exercise = find(named_one)
    marked = [record for record in records if record.marked]
    page: dict[str, Any] = {
        "title": exercise.title if exercise else named_one.exercise or "Which exercise is not known",
        "students": len(records),
        "marked": len(marked),
        "date": max(record.submission.graded_at[:10] for record in records),
        "few": len(marked) < FEWEST,
        "unmarked": [record for record in records if not record.marked],
    }
    if page["few"]:
        return page
    points = np.array([record.points for record in marked])
    out_of = max(record.out_of for record in marked)
    figures = part_figures(marked)
    dear = costs(marked)
    names, columns, counts = heat(marked)
    low, median, high = np.percentile(points, [25, 50, 75])
    return page | {
        "median": float(median),
        "low": float(low),
        "high": float(high),
        "least": float(points.min()),
        "most": float(points.max()),
        "out_of": out_of,
        "late": sum(bool(record.late_seconds) or record.submission.late for record in marked),
        "marks_chart": charts.marks([float(p) for p in points], out_of),
        "lecture": [_said(cost, book) for cost in dear[:TO_SAY]],
        "hard": [part for part in figures if part.mean < HARD],
        "figures": figures,
        "few_for_correlation": len(marked) < FEW_FOR_CORRELATION,
        "uncertain": f"{1 / math.sqrt(len(marked) - 1):.1f}",
        "parts_chart": charts.parts(figures),
        "heat_chart": charts.heat([label(name) for name in names], columns, counts) if names else "",
        "unusual": unusual(marked),
        "alike": alike(marked),
        "same_files": same_files(marked),
    }


def _said(cost: Cost, book: str) -> Said:
    heading, chapter = named(cost.section)
    return Said(
        cost.brief,
        cost.says,
        cost.students,
        cost.points,
        cost.parts,
        heading,
        chapter,
        link(book, cost.section),
    )
