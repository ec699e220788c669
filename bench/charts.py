"""What was measured, as a picture: bars of very different length, in the colours of the page."""

from __future__ import annotations

import html
import math
from collections.abc import Sequence

from report import Bar, Table

WIDTH, MARGIN = 460, 6
ROW, BAR, TOP, FOOT = 38, 12, 8, 30


def chart(table: Table) -> str:
    """Return the bars of a table as SVG, which takes the page's colours.

    >>> from report import Bar
    >>> bars = [Bar("one", 10, "10"), Bar("other", 1000, "1000", ours=True)]
    >>> chart(Table("Title", "", (), (), bars=bars, axis="pieces")).count("<rect")
    2
    """
    low, high = decades([bar.value for bar in table.bars if bar.value > 0])
    width = WIDTH - 2 * MARGIN
    foot = TOP + ROW * len(table.bars)
    parts = [_grid(low, high, width, foot)]
    for k, bar in enumerate(table.bars):
        top = TOP + ROW * k
        share = (math.log10(bar.value) - low) / (high - low) if bar.value > 0 else 0
        weight, colour = ("bold", "z") if bar.ours else ("normal", "body")
        label, shown = html.escape(bar.label), html.escape(bar.shown)
        parts.append(
            f'<text x="{MARGIN}" y="{top + 14}" font-weight="{weight}" fill="var(--dh-ink)">{label}</text>'
            f'<text x="{WIDTH - MARGIN}" y="{top + 14}" text-anchor="end" fill="var(--dh-ink)">{shown}</text>'
            f'<rect x="{MARGIN}" y="{top + 19}" width="{max(2.0, share * width):.1f}" height="{BAR}" rx="2" '
            f'fill="var(--dh-{colour})"/>'
        )
    parts.append(
        f'<text x="{MARGIN}" y="{foot + 22}" fill="var(--dh-muted)">{html.escape(table.axis)}; '
        "from line to line ten times as much</text>"
    )
    size = f'viewBox="0 0 {WIDTH} {foot + FOOT}" width="{WIDTH}" height="{foot + FOOT}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-size="13">{"".join(parts)}</svg>'


def words(table: Table) -> str:
    """Return the picture in words, from the longest bar to the shortest.

    >>> from report import Bar
    >>> words(Table("Speed", "", (), (), bars=[Bar("one", 1, "1"), Bar("other", 2, "2")], axis="pieces"))
    'Speed, pieces: other 2; one 1.'
    """
    ordered = sorted(table.bars, key=lambda bar: -bar.value)
    return f"{table.title}, {table.axis}: " + "; ".join(f"{bar.label} {bar.shown}" for bar in ordered) + "."


def decades(values: Sequence[float]) -> tuple[int, int]:
    """Return the powers of ten between which the values lie, with room for the shortest bar.

    >>> decades([3e-6, 0.2])
    (-6, 0)
    >>> decades([10.0])
    (0, 1)
    """
    low, high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))
    if math.log10(min(values)) == low:
        low -= 1
    return low, max(high, low + 1)


def _grid(low: int, high: int, width: int, foot: int) -> str:
    lines = (MARGIN + width * k / (high - low) for k in range(high - low + 1))
    return "".join(f'<path d="M{x:.1f} {TOP}V{foot + 4}" stroke="var(--dh-faint)" fill="none"/>' for x in lines)


__all__ = ["Bar", "chart", "decades", "words"]
