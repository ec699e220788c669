"""Every misconception that shows in a part is caught there, and named."""

import numpy as np
import pytest

from dhlib import Chain
from dhlib.grading.answers import read_answer
from dhlib.grading.forms import Table, Valued
from dhlib.grading.marking import agree, mark
from dhlib.grading.misconceptions import KNOWN, would_have_given
from dhlib.grading.sections import CHAPTERS
from dhlib.grading.tables import _told_chains

#: At least this share of wrong answers is named exactly, over all parts. The rest cannot be told apart: a link matrix
#: without p is transposed by turning the other way, and one entry tells less than a matrix.
NAMED = 0.95


def wrong_answers(part):
    """Each distinct wrong answer that a known misconception leads to, with the keys of all that lead to it."""
    asks = part.asks
    right = asks.values(part.chain)
    found = []
    for slip, values in would_have_given(part):
        if agree(values, right, asks.tolerances) or np.abs(values).max() > 1e9:
            continue
        for others, keys in found:
            if agree(values, others, asks.tolerances):
                keys.append(slip.misconception.key)
                break
        else:
            found.append((values, [slip.misconception.key]))
    return found


def test_every_misconception_that_shows_is_caught_and_named(every):
    named = shown = 0
    for part in every.parts:
        if not isinstance(part.asks, Valued):
            continue
        for values, keys in wrong_answers(part):
            got = mark(part, {"values": values.tolist()})
            assert not got.passed, (part.id, keys)
            assert got.misconception, (part.id, keys, got.message)
            assert set(got.misconception.split("+")) & set(keys), (part.id, keys, got.message)
            shown += 1
            named += "+" not in got.misconception
    assert shown > 3 * len([part for part in every.parts if isinstance(part.asks, Valued)])
    print(f"{every.name}: {named} of {shown} named exactly: {named / shown:.1%}")
    assert named / shown >= NAMED


def test_which_misconceptions_show_in_the_exercise(exercise):
    """No part of the Quickshot has an offset or a prismatic joint to be forgotten; all others are met."""
    met = set()
    for part in exercise.parts:
        if isinstance(part.asks, Valued):
            for _, keys in wrong_answers(part):
                met.update(keys)
    assert set(KNOWN) - met == {"offset", "parallel", "improper"}


def test_a_misconception_of_one_part_is_named_exactly(judge, arm, solved, exercise):
    q = solved["q"]
    other = Chain(arm.joints, "modified", unit="mm")
    cases = {
        "convention": ("A1", arm.to_modified().A(1, q), "right for the modified convention; this part asks for"),
        "row": ("T4", _rolled(arm).T(0, 4, q), "one row too far"),
        "sense": ("A3", arm.A(3, -q), "joint 3 turns the wrong way"),
        "sign": ("A3", arm.A(3, q) * _sign_of_alpha(), "α_3 has the wrong sign"),
        "ends": ("X", solved["T4"], "leaves out base and tool"),
        "degrees": ("A2", arm.A(2, np.deg2rad(q)), "wrong unit"),
        "unit": ("A1", _metres(solved["A1"]), "1000 times too small"),
        "reverse": ("T4", solved["A4"] @ solved["A3"] @ solved["A2"] @ solved["A1"], "reverse order"),
        "entrywise": ("T4", solved["A1"] * solved["A2"] * solved["A3"] * solved["A4"], "entry by entry"),
        "transpose": ("T4", solved["T4"].T, "transposed"),
    }
    for key, (part, value, words) in cases.items():
        got = judge(part, value)
        assert (got.misconception, words in got.message) == (key, True), got
        assert got.section
        assert got.points < got.out_of
    got = judge("T4", other.T(0, 4, q))
    assert got.misconception == "convention"
    assert "Here it is Rz Tz Tx Rx" in got.message


def _rolled(arm):
    links = [(j.a, j.alpha) for j in arm.joints]
    rolled = [*links[1:], links[0]]
    return Chain([j.replace(a=a, alpha=alpha) for j, (a, alpha) in zip(arm.joints, rolled, strict=True)], "classic")


def _sign_of_alpha():
    """A3 has sin α = 1 in its third column and its third row; with -1 these turn."""
    signs = np.ones((4, 4))
    signs[:2, 2] = signs[2, 1] = -1
    return signs


def _metres(matrix):
    changed = matrix.copy()
    changed[:3, 3] /= 1000
    return changed


@pytest.mark.parametrize("key", ["slip", "n_y"])
def test_traps_of_the_task_come_first(judge, solved, key):
    if key == "slip":
        assert "right as printed" in judge("slip", "n_z").message
    else:
        got = judge("n_y", solved["n"][1])
        assert got.misconception == "trap"
        assert "as it is printed" in got.message


def test_where_two_fit_both_are_said(judge, arm, solved):
    got = judge("A4", arm.A(4, -solved["q"]))
    assert got.misconception == "sense+transpose"
    assert got.message.startswith("More than one slip leads to this very answer. Check")


def test_wrong_tables_are_named(every):
    for part in every.parts:
        if not isinstance(part.asks, Table):
            continue
        named = 0
        for slip, told in _told_chains(part.chain):
            reading = read_answer(part.asks.request(), told)
            got = mark(part, reading)
            if got.passed:  # one of the false friends: the same arm after all
                continue
            # What the ladder says first, of the same arm with something else about it, is as good a name.
            keys = {slip.misconception.key, "convention", "sign", "ends", "offset", "sense"}
            assert set(got.misconception.split("+")) & keys, (part.id, slip, got)
            named += 1
        assert named > part.chain.n, part.id


def test_every_sentence_points_into_the_book(every):
    labels = {label for sections in CHAPTERS.values() for label in sections}
    assert {known.where(of) for known in KNOWN.values() for of in ("classic", "modified")} <= labels
    assert {part.section for part in every.parts} <= labels
    keys = {trap.key for part in every.parts for trap in part.traps}
    assert keys <= {*KNOWN, "trap"}
