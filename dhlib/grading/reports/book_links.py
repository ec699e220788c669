"""Links into the book, wherever it is published."""

from __future__ import annotations

from urllib.parse import urlsplit

from dhlib.errors import DHError
from dhlib.grading.sections import address


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
    place = address(section)
    return f"{book}/{place}" if book and place else ""
