"""What it costs to be late: a rule in words, such as ``10%/day, max 50%``."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from datetime import UTC, datetime

from dhlib.errors import DHError
from dhlib.grading.reports.cells import number

PERIODS = {"hour": 3600.0, "day": 86400.0, "week": 604800.0}
SPANS = {"s": 1.0, "min": 60.0, "h": 3600.0, "d": 86400.0}

_RATE = re.compile(r"(\d+(?:\.\d+)?) ?% ?(?:/|per) ?(hour|day|week)")
_MOST = re.compile(r"max(?:imum)? ?(\d+(?:\.\d+)?) ?%")
_SPAN = re.compile(r"(\d+(?:\.\d+)?) ?(s|min|h|d)")

WANTED = "it should read like '10%/day, max 50%', with hour, day or week"


@dataclass(frozen=True)
class LateRule:
    """A part of the points that could be earned is taken away, for each period begun after the due time.

    Parameters
    ----------
    percent : float
        Of the points that could be earned, for each period.
    period : {"hour", "day", "week"}
    most : float
        Percent that are taken away at most.
    grace : float
        Seconds after the due time that count as in time.

    Examples
    --------
    >>> rule = LateRule.read("10%/day, max 50%", grace="15min")
    >>> rule.percent_off(600), rule.percent_off(3600), rule.percent_off(86400 + 901), rule.percent_off(1e9)
    (0.0, 10.0, 20.0, 50.0)
    """

    percent: float
    period: str
    most: float = 100.0
    grace: float = 0.0

    @classmethod
    def read(cls, text: str, grace: str = "") -> LateRule:
        """Read a rule.

        Raises
        ------
        DHError
            If it is none; the message says how one reads.
        """
        rate, *rest = [piece.strip() for piece in text.casefold().split(",")]
        given = _RATE.fullmatch(rate)
        most = _MOST.fullmatch(rest[0]) if rest else None
        if not given or len(rest) > 1 or (rest and not most):
            raise DHError(f"{text!r} is no rule for late work; {WANTED}.")
        percent, limit = float(given[1]), float(most[1]) if most else 100.0
        if percent > 100 or limit > 100:
            raise DHError(f"{text!r} takes more than 100 %; {WANTED}.")
        return cls(percent, given[2], limit, read_span(grace) if grace else 0.0)

    def percent_off(self, seconds: float) -> float:
        """Percent that are taken away from whoever is late by some seconds."""
        if seconds <= self.grace:
            return 0.0
        periods = math.ceil((seconds - self.grace) / PERIODS[self.period])
        return min(self.percent * periods, self.most)

    def __str__(self) -> str:
        text = f"{number(self.percent)} % of all points for each {self.period} begun"
        text += f", at most {number(self.most)} %" if self.most < 100 else ""
        return text + (f"; the first {span_text(self.grace)} are free" if self.grace else "")


def read_span(text: str) -> float:
    """Seconds of a span of time.

    Examples
    --------
    >>> read_span("15min"), read_span("1.5 h")
    (900.0, 5400.0)
    """
    found = _SPAN.fullmatch(text.strip().casefold())
    if not found:
        raise DHError(f"{text!r} is no span of time; it should read like 15min, 2h or 1d.")
    return float(found[1]) * SPANS[found[2]]


def span_text(seconds: float) -> str:
    """A span of time in words, in its two largest units.

    Examples
    --------
    >>> span_text(59), span_text(3600), span_text(2 * 86400 + 3 * 3600 + 5), span_text(61)
    ('59 seconds', '1 hour', '2 days and 3 hours', '1 minute and 1 second')
    """
    left, words = round(seconds), []
    for name, size in (("day", 86400), ("hour", 3600), ("minute", 60), ("second", 1)):
        count, left = divmod(left, size)
        if count:
            words.append(f"{count} {name}{'s' if count != 1 else ''}")
    return " and ".join(words[:2]) or "0 seconds"


def read_time(text: str) -> datetime:
    """A moment, in UTC; without a zone it is meant in that of this machine.

    Raises
    ------
    DHError
        If it is none.

    Examples
    --------
    >>> read_time("2026-11-20T23:59+01:00").isoformat()
    '2026-11-20T22:59:00+00:00'
    """
    try:
        return datetime.fromisoformat(text.strip()).astimezone(UTC)
    except ValueError:
        raise DHError(f"{text!r} is no moment; it should read like 2026-11-20T23:59 or '2026-11-20 23:59'.") from None
