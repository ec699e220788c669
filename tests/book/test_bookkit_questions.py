"""What a chapter says of its questions is refused where the reader could not be told right from wrong."""

from __future__ import annotations

import json
from typing import Any

import bookkit.questions
import numpy as np
import pytest
from bookkit import choice, question


@pytest.fixture
def kept(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    found: dict[str, Any] = {}
    monkeypatch.setattr(
        bookkit.questions, "publish", lambda name, **forms: found.update({name: json.loads(forms["question"])})
    )
    return found


def test_a_matrix_is_kept_row_by_row(kept: dict[str, Any]) -> None:
    question("A", np.array([[0, -1], [1, 0.0]]), decimals=0, wrong={"transposed": [[0, 1], [-1, 0]]}, right="yes")
    assert kept["question A"]["shape"] == [2, 2]
    assert [answer["value"] for answer in kept["question A"]["answers"]] == [[0, -1, 1, 0], [0, 1, -1, 0]]


def test_a_negative_zero_is_zero(kept: dict[str, Any]) -> None:
    question("A", -0.0, decimals=1)
    assert str(kept["question A"]["answers"][0]["value"]) == "[0.0]"


@pytest.mark.parametrize(
    ("answer", "more", "said"),
    [
        (0.5, {"wrong": {"the same": 0.5001}}, "cannot be told"),
        (0.5, {"wrong": {"one": 0.7, "two": 0.7}}, "cannot be told"),
        (180.0, {"wrong": {"turned": -180.0}, "period": 360}, "cannot be told"),
        (0.5, {"wrong": {"a vector": [0.5, 1]}}, "another shape"),
        (float("nan"), {}, "finite"),
        (np.zeros((2, 2, 2)), {}, "number, vector or matrix"),
        ([1, 2], {"labels": ["one"]}, "as many"),
        (1, {"decimals": 9}, "decimals"),
    ],
)
def test_what_could_not_be_judged_is_refused(
    kept: dict[str, Any], answer: Any, more: dict[str, Any], said: str
) -> None:
    with pytest.raises(ValueError, match=said):
        question("A", answer, **({"decimals": 3} | more))


def test_choices(kept: dict[str, Any]) -> None:
    choice("one", 2, wrong={1: "no", 3: "nor this"}, why="so")
    choice("several", {3, 1}, wrong={2: "no", (1, 2): "half"})
    assert [kept[f"question {name}"]["several"] for name in ("one", "several")] == [False, True]
    assert kept["question several"]["answers"][0]["value"] == [1, 3]
    with pytest.raises(ValueError, match="right and wrong"):
        choice("both", 2, wrong={2: "no"})
