"""The colours of every figure: axes x, y and z (always lettered too), ink, and what stands behind.

They are those of the book's style sheet, book/style/colours.css; a test keeps the two equal.
"""

from __future__ import annotations

from dhlib.errors import DHError

LIGHT = {
    "x": "#c43c00",
    "y": "#007a4d",
    "z": "#1f4fd8",
    "ink": "#1d232b",
    "muted": "#5b6675",
    "faint": "#d5dbe3",
    "body": "#c3cbd6",
    "accent": "#8a2f8f",
    "right": "#00704a",
    "wrong": "#b3261e",
    "ground": "#ffffff",
}
DARK = {
    "x": "#ff8a4c",
    "y": "#3fd69b",
    "z": "#8fa8ff",
    "ink": "#e6eaf0",
    "muted": "#a3afbf",
    "faint": "#39434f",
    "body": "#4a5462",
    "accent": "#e39ae8",
    "right": "#4fd6a0",
    "wrong": "#ff8f86",
    "ground": "#121212",
}
#: Between the two, for a page whose ground is not known: each is mixed with the colour of the text around it.
BETWEEN = {
    "x": "#e8621f",
    "y": "#12a06c",
    "z": "#5478f0",
    "muted": "#7f8a99",
    "accent": "#b560ba",
    "right": "#12a06c",
    "wrong": "#e0584f",
}


def colours(theme: str) -> dict[str, str]:
    """Return the colours of a theme by name.

    Parameters
    ----------
    theme : {"light", "dark"}

    Raises
    ------
    DHError
        If there is no such theme.

    Examples
    --------
    >>> colours("light")["ground"]
    '#ffffff'
    """
    themes = {"light": LIGHT, "dark": DARK}
    if theme not in themes:
        raise DHError(f"theme={theme!r} is unknown; it should be 'light' or 'dark'.")
    return themes[theme]
