"""Tables that spreadsheets open, without running what a student wrote into them."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Sequence

#: A cell that begins with one of these is taken for a formula; so are their full-width siblings.
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")

#: What looks like one and is none.
HARMLESS = re.compile(r"-|-?[0-9]+(\.[0-9]*)?")


def safe(cell: str) -> str:
    r"""A cell that no spreadsheet takes for a formula, on one line.

    Examples
    --------
    >>> safe("=1+1"), safe("2.5"), safe("-2.5"), safe("Müller,\nAda")
    ("'=1+1", '2.5', '-2.5', 'Müller, Ada')
    """
    cell = "".join(c if c.isprintable() and not 0xD800 <= ord(c) < 0xE000 else " " for c in cell)
    return f"'{cell}" if cell.lstrip().startswith(FORMULA) and not HARMLESS.fullmatch(cell) else cell


def number(value: float) -> str:
    """Points as people write them: no trailing zeros, at most two decimals.

    Examples
    --------
    >>> number(2.0), number(1 / 3), number(-0.001)
    ('2', '0.33', '0')
    """
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def table(header: Sequence[str], rows: Iterable[Sequence[str]], mark: bool = False) -> bytes:
    """A CSV file whose cells are safe.

    Parameters
    ----------
    header : sequence of str
    rows : iterable of sequence of str
    mark : bool
        Whether it begins with a mark that tells spreadsheets that it is UTF-8. Other systems may stumble on it.
    """
    file = io.StringIO(newline="")
    writer = csv.writer(file)
    writer.writerows([safe(cell) for cell in row] for row in (header, *rows))
    return file.getvalue().encode("utf-8-sig" if mark else "utf-8")
