r"""What chapters use to put executed values into their text: numbers, formulas, tables and figures.

A cell glues a value under a name, and the text quotes the name:

    glue_number("reach", arm_reach, unit="m")      {glue:text}`reach`
    glue_math("A1", A1, lhs=r"{}^{0}\!A_1")          ```{glue:math} A1        (:label: gives a number)
                                                   {glue}`A1`              within a line
    glue_table("rows", rows, header)               ```{glue} rows
    glue_figure("frames", drawing, alt="…")        ```{glue:figure} frames
                                                   :name: fig-frames
    question("reach", arm_reach, decimals=2, …)    ```{dh-question} reach
"""

from bookkit.figures import glue_figure, inline_svg, show_figure
from bookkit.glue import glue_math, glue_number, glue_table
from bookkit.questions import choice, question
from bookkit.values import latex, text

__all__ = [
    "choice",
    "glue_figure",
    "glue_math",
    "glue_number",
    "glue_table",
    "inline_svg",
    "latex",
    "question",
    "show_figure",
    "text",
]
