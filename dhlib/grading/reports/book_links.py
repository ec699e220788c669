"""Links into the book, wherever it is published."""

from __future__ import annotations

from urllib.parse import urlsplit

from dhlib.errors import DHError
from dhlib.grading.sections import CHAPTERS

#: The page of each chapter; a test looks for each section in its source.
PAGES = {
    "Frames and homogeneous transforms": "transforms",
    "The classic convention": "classic",
    "Placing frames": "placing",
    "The modified convention": "modified",
    "Both side by side": "both",
    "Quickshot: a worked arm": "quickshot",
    "PUMA 560: one arm, five tables": "puma560",
    "Mitsubishi PA10: seven joints and six": "pa10",
    "Prismatic joints": "prismatic",
    "From a data sheet or a URDF to a DH table": "data_sheet",
}


def read_address(book: str) -> str:
    """The address of a book, without a slash at its end.

    Raises
    ------
    DHError
        If it is no address of a page: a link should not run anything.

    Examples
    --------
    >>> read_address("https://example.org/dh/")
    'https://example.org/dh'
    """
    parts = urlsplit(book.strip())
    if parts.scheme not in ("http", "https", "file") or not (parts.netloc or parts.scheme == "file"):
        raise DHError(f"{book!r} is no address of the book; it should read like https://example.org/dh.")
    return book.strip().removesuffix("index.html").rstrip("/")


def link(book: str, section: str) -> str:
    """The address of a section; empty where there is none.

    Examples
    --------
    >>> link("https://example.org/dh", "sec-pose")
    'https://example.org/dh/book/transforms.html#sec-pose'
    >>> link("", "sec-pose")
    ''
    """
    if not book:
        return ""
    for chapter, sections in CHAPTERS.items():
        if section in sections and chapter in PAGES:
            return f"{book}/book/{PAGES[chapter]}.html#{section}"
    return ""


def named(section: str) -> tuple[str, str]:
    """Heading of a section and title of its chapter; both empty for an unknown label."""
    for chapter, sections in CHAPTERS.items():
        if section in sections:
            return sections[section], chapter
    return "", ""
