"""What earlier builds made is taken again where it is made of the same, and only there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from keeping import Keeper, digest

pytestmark = pytest.mark.book


@pytest.fixture
def work() -> tuple[list[str], Callable[[str], Callable[[Path], object]]]:
    """What was made, and how to make it."""
    done: list[str] = []

    def of(text: str) -> Callable[[Path], object]:
        def make(folder: Path) -> None:
            done.append(text)
            (folder / "made.txt").write_text(text, "utf-8")

        return make

    return done, of


def test_the_same_is_made_once(tmp_path, work):
    done, of = work
    first = Keeper(tmp_path).made("thing", of("one"), "a", b"b")
    again = Keeper(tmp_path).made("thing", of("two"), "a", b"b")
    assert first == again
    assert (again / "made.txt").read_text("utf-8") == "one"
    assert done == ["one"]


def test_what_is_made_of_something_else_is_made_anew(tmp_path, work):
    done, of = work
    source = tmp_path / "source.txt"
    for text in ("one", "two"):
        source.write_text(text, "utf-8")
        folder = Keeper(tmp_path / "kept").made("thing", of(text), source)
        assert (folder / "made.txt").read_text("utf-8") == text
    assert done == ["one", "two"]


def test_where_one_part_ends_counts():
    assert digest("ab", "c") != digest("a", "bc")
    assert digest("ab") != digest("ab", "")


def test_what_broke_off_is_not_kept(tmp_path, work):
    _, of = work

    def breaks(folder: Path) -> None:
        (folder / "made.txt").write_text("half", "utf-8")
        raise OSError("no space left")

    with pytest.raises(OSError, match="no space left"):
        Keeper(tmp_path).made("thing", breaks, "a")
    assert list(tmp_path.iterdir()) == []
    assert (Keeper(tmp_path).made("thing", of("whole"), "a") / "made.txt").read_text("utf-8") == "whole"


def test_what_nobody_asked_for_is_forgotten(tmp_path, work):
    _, of = work
    old = Keeper(tmp_path).made("thing", of("old"), "old")
    keeper = Keeper(tmp_path)
    new = keeper.made("thing", of("new"), "new")
    keeper.forget_the_rest()
    assert not old.exists()
    assert new.exists()
