"""Questions at the end of a chapter: what is right and what is typically wrong comes from the chapter's own code.

The directive ``{dh-question}`` asks; the build seals the answers (see ``book/extensions/sealing.py``).
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from bookkit.glue import publish

MOST_DECIMALS = 6


def question(
    name: str,
    answer: Any,
    *,
    decimals: int,
    unit: str = "",
    labels: Sequence[str] = (),
    period: float | Sequence[float | None] | None = None,
    wrong: Mapping[str, Any] | None = None,
    right: str = "",
    hint: str = "",
) -> None:
    r"""Keep what is right and wrong about a number, a vector or a matrix, for ``{dh-question}`` of this name.

    Feedback may hold ``$formulas$``, ``*emphasis*``, code between backticks and links, ``[words](#sec-label)``.

    Parameters
    ----------
    name : str
        What the directive calls it.
    answer : number or array_like, at most two dimensions
        What is right, computed by the chapter.
    decimals : int
        How many decimals are asked for; the page says so. What is right when rounded to them is right.
    unit : str
        Unit of every entry: ``"m"``, ``"mm"``, ``"°"`` or ``"rad"``. The page says so.
    labels : sequence of str
        A label for each entry of a vector, in place of `unit`.
    period : float or sequence, optional
        What may be added without a change, as 360 for an angle in degrees; for each entry, or for all.
    wrong : mapping of str to answers, optional
        What to say, and the wrong answer to say it to: an answer that a typical mistake gives, computed too.
    right : str
        What to say to the right answer: why it is right.
    hint : str
        What to say to an answer that nobody foresaw. Unlike the rest it can be read in the page's source.

    Raises
    ------
    ValueError
        If an answer is not finite or too deep, a wrong one has another shape, or two answers are the same in
        the decimals asked for.
    """
    if not 0 <= decimals <= MOST_DECIMALS:
        raise ValueError(f"Ask for 0 to {MOST_DECIMALS} decimals, not {decimals}.")
    value = _array(name, answer)
    periods = list(period) if isinstance(period, Sequence) else [period] * value.size
    if len(periods) != value.size or (labels and len(labels) != value.size):
        raise ValueError(f"Question {name!r} has {value.size} entries: labels and periods must be as many.")
    answers = [{"right": True, "value": value.ravel().tolist(), "says": right}]
    for says, mistaken in (wrong or {}).items():
        other = _array(name, mistaken)
        if other.shape != value.shape:
            raise ValueError(f"Question {name!r}: the wrong answer {mistaken!r} has another shape than the right one.")
        answers.append({"right": False, "value": other.ravel().tolist(), "says": says})
    _all_different(name, answers, decimals, periods)
    _publish(
        name,
        kind="number",
        shape=list(value.shape),
        decimals=decimals,
        unit=unit,
        labels=list(labels),
        periods=periods,
        answers=answers,
        hint=hint,
    )


def choice(
    name: str,
    right: int | Iterable[int],
    *,
    wrong: Mapping[Any, str] | None = None,
    why: str = "",
    hint: str = "",
) -> None:
    """Keep which options are right, for ``{dh-question}`` of this name, whose text ends in the list of options.

    Parameters
    ----------
    name : str
        What the directive calls it.
    right : int or iterable of int
        The number of the right option, counted from 1; or all that are right, where several may be.
    wrong : mapping, optional
        For a wrong option, or a tuple of options, what to say.
    why : str
        What to say to the right answer.
    hint : str
        What to say to any other. Unlike the rest it can be read in the page's source.

    Raises
    ------
    ValueError
        If a wrong choice is the right one.
    """
    several = not isinstance(right, int | np.integer)
    answers = [{"right": True, "value": _options(right), "says": why}]
    for options, says in (wrong or {}).items():
        if _options(options) == answers[0]["value"]:
            raise ValueError(f"Question {name!r}: option {options!r} is right and wrong.")
        answers.append({"right": False, "value": _options(options), "says": says})
    _publish(name, kind="choice", several=several, answers=answers, hint=hint)


def _options(options: Any) -> list[int]:
    return [int(options)] if isinstance(options, int | np.integer) else sorted(int(option) for option in options)


def _array(name: str, answer: Any) -> np.ndarray[Any, Any]:
    value = np.array(answer.tolist() if hasattr(answer, "tolist") else answer, dtype=float) + 0.0
    if value.ndim > 2 or not np.isfinite(value).all():
        raise ValueError(f"Question {name!r}: an answer is a finite number, vector or matrix, not {answer!r}.")
    return value


def _all_different(
    name: str, answers: Sequence[Mapping[str, Any]], decimals: int, periods: Sequence[float | None]
) -> None:
    for k, one in enumerate(answers):
        for other in answers[:k]:
            apart = [
                abs(a - b if period is None else (a - b + period / 2) % period - period / 2)
                for a, b, period in zip(one["value"], other["value"], periods, strict=True)
            ]
            if max(apart) <= 1.01 * 10**-decimals:
                raise ValueError(
                    f"Question {name!r}: in {decimals} decimals the answer to {one['says']!r} cannot be told from "
                    f"the answer to {other['says']!r}. Ask where the mistake shows."
                )


def _publish(name: str, **data: Any) -> None:
    publish(f"question {name}", question=json.dumps(data))
