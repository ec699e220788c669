"""Sentences that are put together from what others say."""

from __future__ import annotations

import re

#: A letter that means the same only as it stands: x_1, n · o, A3.
SYMBOL = re.compile(r"[A-Za-z]{1,2}(_|\d)|[nopxyz]\b|a ·")


def begun(text: str) -> str:
    """A text as the beginning of a sentence: with a capital, unless it begins with a symbol.

    Examples
    --------
    >>> begun("the table is empty"), begun("x_1 is reversed"), begun("n · o is 0.36"), begun("a row is missing")
    ('The table is empty', 'x_1 is reversed', 'n · o is 0.36', 'A row is missing')
    """
    return text if SYMBOL.match(text) else text[:1].upper() + text[1:]
