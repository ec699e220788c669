"""Write the reports of a class into the folder of its results."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.batch.store import Store
from dhlib.grading.reports.feedback import feedback_page, finder
from dhlib.grading.reports.grades import grades
from dhlib.grading.reports.names import file_names
from dhlib.grading.reports.pseudonyms import pseudonyms
from dhlib.grading.reports.records import Record, read_results, renamed
from dhlib.grading.reports.settings import Settings, read_settings

GRADES, FEEDBACK, CLASS, EXPORTS = "grades.csv", "feedback", "class.html", "exports"


@dataclass(frozen=True)
class Written:
    """What was written, and of how many."""

    grades: Path
    class_page: Path
    feedback: Path
    students: int


def write_reports(store: Store, folder: Path | None = None, only: Collection[str] | None = None) -> Written:
    """Write grades.csv, class.html and a feedback page for each student.

    Parameters
    ----------
    store : Store
    folder : Path, optional
        The folder of the results if left out.
    only : collection of str, optional
        Students whose pages are written anew; all if left out. The tables are of all in any case.

    Raises
    ------
    DHError
        If a file cannot be written.
    """
    from dhlib.grading.reports.class_page import class_page

    folder = folder or store.path.parent
    settings = read_settings(store)
    records = records_to_show(store, settings)
    names = page_names(records)
    submissions = store.submissions()
    mine = None if only is None else {each.id for each in submissions if each.student in only}
    pages = folder / FEEDBACK
    find = finder(settings, {each.id: each.student for each in submissions})
    with _said(folder):
        pages.mkdir(parents=True, exist_ok=True)
        for record in records:
            page = pages / names[record.submission.id]
            if mine is None or record.submission.id in mine or not page.exists():
                replace_file(page, feedback_page(record, find, settings.book, settings.reveal).encode())
        for page in set(pages.glob("*.html")) - {pages / name for name in names.values()}:
            page.unlink()
        table = grades(records, {number: f"{FEEDBACK}/{name}" for number, name in names.items()})
        replace_file(folder / GRADES, table)
        replace_file(folder / CLASS, class_page(records, find, settings.book).encode())
    return Written(folder / GRADES, folder / CLASS, pages, len(records))


def records_to_show(store: Store, settings: Settings) -> list[Record]:
    """What counts, with names or without them."""
    records = read_results(store)
    return renamed(records, pseudonyms(store)) if settings.pseudonyms else records


def page_names(records: Sequence[Record]) -> dict[int, str]:
    """Number of each submission to the name of its feedback page."""
    exercises = {record.exercise for record in records if record.exercise}
    titles = []
    for record in records:
        who = record.name if record.student else Path(record.submission.source or "unknown").stem
        titles.append(f"{who}-{record.exercise}" if len(exercises) > 1 and record.exercise else who)
    names = file_names(titles)
    return {record.submission.id: f"{name}.html" for record, name in zip(records, names, strict=True)}


def feedback_pages(store: Store, records: Sequence[Record], settings: Settings) -> Mapping[int, bytes]:
    """The feedback page of each submission, by its number."""
    find = finder(settings, {each.id: each.student for each in store.submissions()})
    return {
        record.submission.id: feedback_page(record, find, settings.book, settings.reveal).encode() for record in records
    }


def replace_file(path: Path, content: bytes) -> None:
    """Write a file whole or not at all."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=".dhlib-")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(name, 0o666 & ~mask)  # as any other file of this user
        os.replace(name, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(name)
        raise


@contextlib.contextmanager
def _said(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        where = error.filename or folder
        raise DHError(f"{where} cannot be written: {error.strerror}. The results themselves are kept.") from None
