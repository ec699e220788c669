"""Where in the book a mistake is set right: chapters, with labels and headings of their sections."""

from __future__ import annotations

CHAPTERS = {
    "Frames and homogeneous transforms": {
        "sec-inverse": "Going back",
        "sec-pose": "Is it a pose?",
        "sec-trap-degrees": "Degrees taken for radians",
        "sec-trap-rows": "Rows taken for columns",
        "sec-trap-order": "The product in the wrong order",
    },
    "The classic convention": {
        "sec-classic-parameters": "Four parameters, measured",
        "sec-classic-product": "The four matrices and their product",
        "sec-classic-variable": "What is constant and what varies",
        "sec-classic-trap-sign": "The sign of the twist",
        "sec-classic-trap-order": "The twist too early",
        "sec-classic-trap-row": "Link and joint one row apart",
    },
    "The modified convention": {
        "sec-modified-product": "The general link matrix",
    },
    "Quickshot: a worked arm": {
        "sec-quickshot-frames": "Five frames",
        "sec-quickshot-table": "The table, row by row",
        "sec-quickshot-links": "Four link matrices",
        "sec-quickshot-product": "The product",
        "sec-quickshot-slip": "A slip in print",
        "sec-base-and-tool": "Base and tool",
        "sec-quickshot-tables": "The same arm, other tables",
    },
}


def where(label: str) -> str:
    """A pointer to a section, as a sentence; empty for an unknown label.

    Examples
    --------
    >>> where("sec-pose")
    'See ‘Is it a pose?’ in the chapter ‘Frames and homogeneous transforms’.'
    """
    for chapter, sections in CHAPTERS.items():
        if label in sections:
            return f"See ‘{sections[label]}’ in the chapter ‘{chapter}’."
    return ""
