"""Where in the book a mistake is set right: chapters, with labels and headings of their sections."""

from __future__ import annotations

CHAPTERS = {
    "Frames and homogeneous transforms": {
        "sec-homogeneous": "Position and orientation in one matrix",
        "sec-noap": "Reading a pose",
        "sec-atomic": "Six atomic transforms",
        "sec-composition": "Composition: from the right, from the left",
        "sec-inverse": "Going back",
        "sec-chain-product": "Chains and their indices",
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
    "PUMA 560: one arm, five tables": {
        "sec-puma560-frames": "Six axes, six frames",
        "sec-puma560-rows": "The table, row by row",
        "sec-puma560-links": "Six link matrices",
        "sec-puma560-product": "The product in two halves",
        "sec-puma560-first-half": "The arm: sum of angles",
        "sec-puma560-second-half": "The wrist",
        "sec-puma560-entries": "All twelve entries",
        "sec-puma560-reading": "Reading it",
        "sec-puma560-poses": "Is it right?",
        "sec-puma560-row-down": "The links move a row",
        "sec-puma560-corke": "Corke's table: x1 reversed",
        "sec-puma560-parity": "The rule",
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
