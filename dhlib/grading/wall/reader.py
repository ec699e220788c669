"""The trusted reader of what comes from behind the wall: JSON of bounded size, depth and numbers, and nothing else.

Never pickle, never `eval`. What an honest box would not send is refused, not mended.
"""

from __future__ import annotations

import json
import math
from typing import Any

MOST_NODES = 50_000
DEEPEST = 10
LONGEST_TEXT = 1000
LARGEST_NUMBER = 1e12
LONGEST_NUMBER = 40


class Refused(ValueError):
    """It is nothing that an honest box sends."""


def read_json(data: bytes) -> Any:
    """Read one message.

    Raises
    ------
    Refused
        If it is no JSON, too deep, too long, or holds NaN, infinity or a huge number.

    Examples
    --------
    >>> read_json(b'{"part": "A", "reading": {"values": [1.5, null]}}')
    {'part': 'A', 'reading': {'values': [1.5, None]}}
    """
    try:
        value = json.loads(data.decode("utf-8"), parse_int=_integer, parse_float=_float, parse_constant=_refuse)
    except Refused:
        raise
    except (ValueError, RecursionError, MemoryError) as error:
        raise Refused(type(error).__name__) from None
    _measure(value)
    return value


def _measure(value: Any) -> None:
    """Refuse what is too large, too deep, or text too long; without recursion."""
    waiting = [(value, 0)]
    nodes = 0
    while waiting:
        item, depth = waiting.pop()
        nodes += 1
        if nodes > MOST_NODES or depth > DEEPEST:
            raise Refused("too large")
        if isinstance(item, dict):
            waiting += [(part, depth + 1) for pair in item.items() for part in pair]
        elif isinstance(item, list):
            waiting += [(part, depth + 1) for part in item]
        elif isinstance(item, str) and (len(item) > LONGEST_TEXT or any(0xD800 <= ord(c) < 0xE000 for c in item)):
            raise Refused("no text")


def _integer(text: str) -> int:
    if len(text) > LONGEST_NUMBER or abs(number := int(text)) > LARGEST_NUMBER:
        raise Refused("a huge number")
    return number


def _float(text: str) -> float:
    number = float(text)
    if len(text) > LONGEST_NUMBER or not math.isfinite(number) or abs(number) > LARGEST_NUMBER:
        raise Refused("a huge number")
    return number


def _refuse(text: str) -> Any:
    raise Refused(text)
