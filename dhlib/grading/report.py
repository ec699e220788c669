"""What a grading run writes: grades.csv, and a feedback page for each notebook."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path

from dhlib.grading.grade import Result
from dhlib.grading.marks import HEADLINES
from dhlib.grading.sections import where

#: A cell of a spreadsheet that begins with one of these is run as a formula.
FORMULA = ("=", "+", "-", "@", "\t", "\r")


def write_reports(results: Sequence[Result], folder: Path, root: Path) -> Path:
    """Write everything into a folder; return the table.

    Parameters
    ----------
    results : sequence of Result
    folder : Path
        Made where it is missing.
    root : Path
        What was graded; names in the table are relative to it.
    """
    (folder / "feedback").mkdir(parents=True, exist_ok=True)
    names = page_names([_shown(result, root) for result in results])
    for result, name in zip(results, names, strict=True):
        (folder / "feedback" / name).write_text(feedback_page(result), encoding="utf-8")
    table = folder / "grades.csv"
    write_grades(results, names, table, root)
    return table


def write_grades(results: Sequence[Result], pages: Sequence[str], table: Path, root: Path) -> None:
    """One row for each notebook; UTF-8 with a mark, so that spreadsheets read umlauts."""
    parts = list(dict.fromkeys(mark.part for result in results for mark in result.marks))
    with table.open("w", newline="", encoding="utf-8-sig") as file:
        writer = csv.writer(file)
        writer.writerow(["notebook", "exercise", "status", "points", "out_of", *parts, "message", "feedback"])
        for result, page in zip(results, pages, strict=True):
            points = {mark.part: f"{mark.points:g}" for mark in result.marks}
            writer.writerow(
                safe(cell)
                for cell in (
                    _shown(result, root),
                    result.exercise.name if result.exercise else "",
                    result.status,
                    f"{result.points:g}" if result.exercise else "",
                    f"{result.out_of:g}" if result.exercise else "",
                    *(points.get(part, "") for part in parts),
                    result.message,
                    f"feedback/{page}",
                )
            )


def safe(cell: str) -> str:
    """A cell that no spreadsheet takes for a formula.

    Examples
    --------
    >>> safe("=1+1"), safe("2.5")
    ("'=1+1", '2.5')
    """
    cell = "".join(c if c.isprintable() and not 0xD800 <= ord(c) < 0xE000 else " " for c in cell)
    return f"'{cell}" if cell.lstrip().startswith(FORMULA) else cell


def page_names(notebooks: Sequence[str]) -> list[str]:
    """A file name for each page, plain and different from all others.

    Examples
    --------
    >>> page_names(["a/quick shot.ipynb", "a_quick_shot.ipynb"])
    ['a_quick_shot.html', 'a_quick_shot-2.html']
    """
    names: list[str] = []
    for notebook in notebooks:
        stem = re.sub(r"[^\w-]+", "_", notebook.removesuffix(".ipynb")).strip("_")[:100] or "notebook"
        name, k = f"{stem}.html", 2
        while name.casefold() in (other.casefold() for other in names):
            name, k = f"{stem}-{k}.html", k + 1
        names.append(name)
    return names


def feedback_page(result: Result) -> str:
    """A page that needs nothing else; everything in it is escaped."""
    from jinja2 import Environment, PackageLoader

    pages = Environment(
        loader=PackageLoader("dhlib.grading", "pages"), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    titles = {part.id: part.title for part in result.exercise.parts} if result.exercise else {}
    return pages.get_template("feedback.html").render(
        result=result,
        title=result.exercise.title if result.exercise else "Exercise",
        rows=[(mark, titles.get(mark.part, ""), HEADLINES[mark.verdict], where(mark.section)) for mark in result.marks],
    )


def _shown(result: Result, root: Path) -> str:
    return result.path.relative_to(root).as_posix() if root.is_dir() else result.path.name
