"""What to say about an answer that cannot be read as an answer."""

from __future__ import annotations

from typing import Any

#: Faults of a part that was not begun. A tuple, since a forged fault may not be hashable.
MISSING = ("missing", "undefined")

SENTENCES = {
    "missing": "Put your answer in place of the three dots.",
    "undefined": "There is no variable {part}: keep its name, and let its cell run without an error.",
    "text": "{part} is text in quotation marks; {wanted} is asked for.",
    "nan": "{part} holds NaN or infinity, which no answer does. Was something divided by zero, or a value left empty?",
    "shape": "{part} has {shape}; {wanted} is asked for.",
    "ragged": "The rows of {part} differ in length; {wanted} is asked for.",
    "complex": "{part} has an imaginary part; all of its entries should be real.",
    "bool": "{part} is True or False where a number is asked for. Was == written for =?",
    "large": "{part} holds a number beyond 1e9. Was a bracket or a decimal point lost?",
    "size": "{part} is far larger than {wanted}, which is asked for.",
    "symbols": "{part} still holds {names}; put the numbers in, for example with .subs(…).",
    "unknown_symbols": "{part} holds {names}; only {known} should be left, and numbers.",
    "no_value": "{part} has no value when numbers are put in for its symbols: {text}.",
    "long": "{part} is longer than any formula for it needs to be: was it expanded again and again?",
    "function": "{part} is a function; {wanted} is asked for. Call it, and hand in the result.",
    "kind": "{part} holds an object of type {type}; {wanted} is asked for.",
    "no_function": "{part} is an object of type {type}; a function is asked for, defined with def {part}(…).",
    "returns_nothing": "{part} returns nothing. Does it end with return?",
    "raised": "{part} stopped with {type}: {text}.",
    "index": "{part} stopped with {type}: {text}. Links and joints count from 1, the items of a list from 0.",
    "no_table": "{part} is an object of type {type}; a table is asked for: a list of rows, one per joint.",
    "no_choice": "{part} is an object of type {type}; one of {options} is asked for, in quotation marks.",
    "timeout": "{part} took too long and was stopped. Is there a loop without an end?",
    "skipped": "{part} could not be read: its cell ended the whole program.",
    "unreadable": "{part} could not be read ({type}: {text}); {wanted} is asked for.",
    "refused": "{part} did not arrive as an answer; {wanted} is asked for.",
}


def shape_text(shape: list[int]) -> str:
    """A shape in words.

    Examples
    --------
    >>> shape_text([3, 4]), shape_text([]), shape_text([3])
    ('3 rows and 4 columns', 'only one number', '3 numbers')
    >>> shape_text([4, 4, 4])
    '4 matrices of 4 by 4'
    """
    if not shape:
        return "only one number"
    if len(shape) == 1:
        return f"{shape[0]} number{'s' if shape[0] != 1 else ''}"
    if len(shape) == 2:
        rows, columns = shape
        return f"{rows} row{'s' if rows != 1 else ''} and {columns} column{'s' if columns != 1 else ''}"
    if len(shape) == 3:
        count, rows, columns = shape
        return f"{count} {'matrix' if count == 1 else 'matrices'} of {rows} by {columns}"
    return f"shape {' × '.join(map(str, shape))}"


def sentence(fault: dict[str, Any], part: str, wanted: str, options: str = "") -> str:
    """The sentence for a fault; what it quotes was written by the student, is bounded, and is only ever text.

    Parameters
    ----------
    fault : dict
        As `answers.read_answer` makes it, or anything else that came back from a box.
    part, wanted, options : str
        Name of the part, its form in words, and its options if it has some.
    """

    def quoted(value: Any) -> str:
        line = " ".join("".join(c if c.isprintable() else " " for c in str(value)[:200]).split())
        return line.rstrip(".") or "without a message"

    shape = fault.get("shape")
    names, known = (", ".join(quoted(name) for name in _list(fault.get(key))[:6]) for key in ("names", "known"))
    kind = fault.get("fault")
    if kind == "raised" and fault.get("type") == "IndexError":
        kind = "index"
    template = SENTENCES.get(kind if isinstance(kind, str) else "refused", SENTENCES["refused"])
    return template.format(
        part=part,
        wanted=wanted,
        options=options,
        shape=shape_text([int(size) for size in _list(shape)[:6] if isinstance(size, int)]),
        names=names,
        known=known,
        type=quoted(fault.get("type", "?")),
        text=quoted(fault.get("text", "")),
    )


def _list(value: Any) -> list[Any]:
    return value if isinstance(value, list) else []
