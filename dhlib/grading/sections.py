"""Where in the book a mistake is set right: chapters, with labels and headings of their sections."""

from __future__ import annotations

from typing import NamedTuple


class Chapter(NamedTuple):
    """A chapter: the name of its page, its title, and headings of sections by their labels."""

    page: str
    title: str
    sections: dict[str, str]


CHAPTERS = (
    Chapter(
        "transforms",
        "Frames and homogeneous transforms",
        {
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
    ),
    Chapter(
        "classic",
        "The classic convention",
        {
            "sec-classic-dh1": "DH1 as a formula",
            "sec-classic-dh2": "DH2 as a formula",
            "sec-classic-check": "Both as a check",
            "sec-classic-parameters": "Four parameters, measured",
            "sec-classic-measure": "The measurement",
            "sec-classic-product": "The four matrices and their product",
            "sec-classic-orders": "The order of the four steps",
            "sec-classic-variable": "What is constant and what varies",
            "sec-classic-trap-sign": "The sign of the twist",
            "sec-classic-trap-order": "The twist too early",
            "sec-classic-trap-row": "Link and joint one row apart",
        },
    ),
    Chapter(
        "placing",
        "Placing frames",
        {
            "sec-placing-two-axes": "Two axes in space",
            "sec-placing-step-table": "Step 6: the table",
            "sec-placing-step-product": "Step 7: the product",
            "sec-placing-algorithm": "The recipe as an algorithm",
            "sec-placing-nearly-parallel": "Nearly parallel axes",
            "sec-placing-trap-cross": "The cross product of parallel axes",
            "sec-placing-trap-sense": "A reversed axis, forgotten",
            "sec-placing-parallel": "Parallel axes: the offset may go anywhere",
            "sec-placing-sense": "The sense of z",
            "sec-placing-last": "The last frame",
            "sec-placing-physical": "What is physical and what is choice",
        },
    ),
    Chapter(
        "data_sheet",
        "From a data sheet or a URDF to a DH table",
        {
            "sec-data-sheet-axes": "From the file to the axes",
            "sec-data-sheet-table": "From the axes to the table",
        },
    ),
    Chapter(
        "modified",
        "The modified convention",
        {
            "sec-modified-construction": "The frames, from the axes",
            "sec-modified-check": "Both as a check",
            "sec-modified-slip": "A wrong factor on the slides",
            "sec-modified-parameters": "Four parameters, and their indices",
            "sec-modified-product": "The general link matrix",
            "sec-modified-orders": "The order of the four steps",
            "sec-modified-trap-formula": "The classic formula on a modified table",
            "sec-modified-trap-row": "Link columns off by one row",
        },
    ),
    Chapter(
        "both",
        "Both side by side",
        {
            "sec-both-columns": "The columns move one row",
            "sec-both-tool": "At the hand: into the tool",
            "sec-both-base": "At the base: into the base",
            "sec-both-frames": "What happens to the frames",
            "sec-both-trap-formula": "A classic table in the modified formula",
            "sec-both-tell-parallel": "Look for the upper arm",
            "sec-both-tell-pose": "Ask for one known pose",
            "sec-both-tell-never": "Where no table can tell",
        },
    ),
    Chapter(
        "quickshot",
        "Quickshot: a worked arm",
        {
            "sec-quickshot-frames": "Five frames",
            "sec-quickshot-table": "The table, row by row",
            "sec-quickshot-links": "Four link matrices",
            "sec-quickshot-product": "The product",
            "sec-quickshot-parallel": "Parallel axes add their angles",
            "sec-quickshot-slip": "A slip in print",
            "sec-base-and-tool": "Base and tool",
            "sec-quickshot-tables": "The same arm, other tables",
            "sec-trap-zero-only": "Tested at zero only",
        },
    ),
    Chapter(
        "base_tool",
        "Base, tool and back",
        {
            "sec-bt-trap-units": "A tool in millimetres",
        },
    ),
    Chapter(
        "puma560",
        "PUMA 560: one arm, five tables",
        {
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
            "sec-puma560-tables": "Five tables, one arm?",
            "sec-puma560-flip": "An x axis the other way round",
            "sec-puma560-fgl": "Fu, Gonzalez and Lee: three x axes, an offset, a flange",
            "sec-puma560-hand": "False friends: which signs may be changed",
            "sec-puma560-trap-bracket": "Modified rows in the classic formula",
        },
    ),
    Chapter(
        "pa10",
        "Mitsubishi PA10: seven joints and six",
        {
            "sec-pa10-frames": "Frames and table",
            "sec-pa10-product": "The product, without twists",
            "sec-pa10-lengths": "Three sets of lengths",
            "sec-pa10-6c": "The PA10-6C: one joint less",
            "sec-pa10-redundancy": "The elbow circle",
        },
    ),
    Chapter(
        "prismatic",
        "Prismatic joints",
        {
            "sec-prismatic-row": "A joint that slides",
            "sec-prismatic-stanford": "The Stanford arm",
            "sec-prismatic-stanford-check": "Reading its position",
            "sec-prismatic-scara": "A SCARA: the Adept Cobra 600",
            "sec-prismatic-direction": "Only the direction counts",
            "sec-prismatic-wander": "Heights that wander",
            "sec-prismatic-mirror": "The shoulder on the other side",
            "sec-prismatic-trap-revolute": "The slide treated as a turn",
            "sec-prismatic-trap-published": "Two published tables",
        },
    ),
)

#: Chapter and heading of each section.
_SECTIONS = {label: (chapter, heading) for chapter in CHAPTERS for label, heading in chapter.sections.items()}


def named(label: str) -> tuple[str, str]:
    """Heading of a section and title of its chapter; both empty for an unknown label.

    Examples
    --------
    >>> named("sec-pose")
    ('Is it a pose?', 'Frames and homogeneous transforms')
    """
    if label not in _SECTIONS:
        return "", ""
    chapter, heading = _SECTIONS[label]
    return heading, chapter.title


def where(label: str) -> str:
    """A pointer to a section, as a sentence; empty for an unknown label.

    Examples
    --------
    >>> where("sec-pose")
    'See ‘Is it a pose?’ in the chapter ‘Frames and homogeneous transforms’.'
    """
    heading, title = named(label)
    return f"See ‘{heading}’ in the chapter ‘{title}’." if heading else ""


def address(label: str) -> str:
    """Where a section stands in the book, from the book's root; empty for an unknown label.

    Examples
    --------
    >>> address("sec-pose")
    'book/transforms.html#sec-pose'
    """
    return f"book/{_SECTIONS[label][0].page}.html#{label}" if label in _SECTIONS else ""
