"""Values as the reader sees them, and drawings as the page needs them."""

from __future__ import annotations

from fractions import Fraction

import matplotlib.figure
import numpy as np
import pytest
import sympy
from bookkit import inline_svg, latex, text
from bookkit.figures import palette


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (np.float64(0.4318), "0.4318"),
        (np.float32(0.5), "0.5"),
        (np.int64(-7), "−7"),
        (6.123233995736766e-17, "0"),
        (-0.0, "0"),
        (1.0, "1"),
        (0.70710678, "0.7071"),
        (2.0e-7, "2·10⁻⁰⁷".replace("⁰", "")),
        (Fraction(1, 4), "0.25"),
        (sympy.Rational(1, 8), "0.125"),
    ],
)
def test_numbers_read_as_numbers(value: object, shown: str) -> None:
    assert text(value) == shown


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "0.5", True])
def test_what_is_no_number_is_refused(value: object) -> None:
    with pytest.raises(ValueError, match="number"):
        text(value)


def test_a_quarter_turn_is_exact_on_the_page() -> None:
    c, s = np.cos(np.pi / 2), np.sin(np.pi / 2)
    assert latex(np.array([[c, -s], [s, c]])) == r"\begin{bmatrix}0 & -1 \\ 1 & 0\end{bmatrix}"
    assert latex(np.array([c, s])) == r"\begin{bmatrix}0 \\ 1\end{bmatrix}"


def test_symbols_and_floats_mix_without_noise() -> None:
    theta, d = sympy.symbols("theta_1 d_2")
    shown = latex(sympy.Matrix([[sympy.cos(theta), (0.1 + 0.2) * d], [6e-17 * d, sympy.pi / 2]]))
    assert shown == r"\begin{bmatrix}\cos {\theta_{1}} & 0.3 d_{2} \\ 0 & \frac{\pi}{2}\end{bmatrix}"


def test_a_batch_is_refused() -> None:
    with pytest.raises(ValueError, match="one matrix"):
        latex(np.zeros((2, 4, 4)))


SVG = '<?xml version="1.0"?><svg width="72pt" viewBox="0 0 9 9"><g id="a" fill="#C43C00"/><use xlink:href="#a"/></svg>'


def test_a_drawing_takes_the_colours_of_the_page() -> None:
    svg = inline_svg(SVG, 'the "x" axis', name="one")
    assert 'fill="var(--dh-x)"' in svg
    assert 'aria-label="the &quot;x&quot; axis"' in svg
    assert 'id="one-a"' in svg
    assert 'href="#one-a"' in svg
    assert "max-width:96px" in svg
    assert svg.startswith("<svg ")


def test_a_matplotlib_figure_will_do() -> None:
    figure = matplotlib.figure.Figure()
    figure.subplots().plot([0, 1], color=palette()["z"])
    svg = inline_svg(figure, "a line")
    assert "var(--dh-z)" in svg
    assert svg == inline_svg(figure, "a line"), "the same drawing gives the same page"


@pytest.mark.parametrize(("drawing", "alt"), [(SVG, " "), ("<p>no drawing</p>", "words"), (7, "words")])
def test_a_drawing_without_words_or_lines_is_refused(drawing: object, alt: str) -> None:
    with pytest.raises(ValueError, match=r"alt text|svg|SVG"):
        inline_svg(drawing, alt)
