"""Marking: right answers by any route, kind words for the rest, and no trust in what comes from the box."""

import json
from itertools import islice

import numpy as np
import pandas as pd
import pytest
import sympy as sp

from dhlib import Chain, Revolute, Rz, Tz, robots
from dhlib.errors import DHError
from dhlib.grading import checker, form_checker, page
from dhlib.grading.answers import read_answer
from dhlib.grading.asking import number, reasoned
from dhlib.grading.exercise import Exercise, Follows, Part, Trap, load_exercise
from dhlib.grading.forms import Choice, Function, Numbers, Reason, Valued
from dhlib.grading.marking import Marker, mark

pytestmark = pytest.mark.filterwarnings("ignore:the matrix subclass:PendingDeprecationWarning")
theta = sp.symbols("theta1:5")


def test_the_solution_gets_full_marks(every, results):
    marks = Marker(every).mark_all({p.id: read_answer(p.asks.request(), results[p.id]) for p in every.parts})
    assert [(m.part, m.verdict) for m in marks if m.verdict != "right"] == []
    assert sum(m.points for m in marks) == every.points > 0


def test_every_page_says_how_many_points(every, worked):
    """The points of each part, as the headings of the page sum them up."""
    text = "\n".join("".join(cell["source"]) for cell in worked["cells"] if cell["cell_type"] == "markdown")
    assert f", {every.points:g} points.**" in text


def test_the_untouched_exercise_gets_none(every):
    marks = Marker(every).mark_all({p.id: read_answer(p.asks.request(), ...) for p in every.parts})
    assert {m.verdict for m in marks} == {"open"}
    assert sum(m.points for m in marks) == 0


@pytest.mark.parametrize(
    "dress",
    [
        np.asarray, np.ndarray.tolist, np.matrix, sp.Matrix, pd.DataFrame,
        lambda a: tuple(map(tuple, a)), lambda a: a.round(3), lambda a: sp.Matrix(a.round(3)).tolist(),
        lambda a: a.astype(object), lambda a: a.astype(complex), lambda a: [[str(x) and x for x in row] for row in a],
    ],
)  # fmt: skip
@pytest.mark.parametrize("part", ["A1", "T4", "X", "T4_back"])
def test_numbers_in_any_dress(judge, solved, part, dress):
    assert judge(part, dress(np.asarray(solved[part]))).verdict == "right"


@pytest.mark.parametrize(
    "form",
    [
        sp.expand, sp.trigsimp, sp.ImmutableMatrix, lambda m: m.tolist(), lambda m: np.array(m.tolist(), dtype=object),
        lambda m: m.applyfunc(lambda e: e.rewrite(sp.exp)), lambda m: m.applyfunc(lambda e: e.rewrite(sp.tan)),
        lambda m: m.applyfunc(sp.expand_trig), lambda m: m.evalf(),
        lambda m: m.subs(dict(zip(theta, sp.symbols("q1:5", real=True), strict=True))), pd.DataFrame,
    ],
)  # fmt: skip
@pytest.mark.parametrize("part", ["A3_sym", "T4_sym"])
def test_formulas_in_any_form(judge, solved, part, form):
    if form is pd.DataFrame:
        assert judge(part, pd.DataFrame(solved[part].tolist())).verdict == "right"
    else:
        assert judge(part, form(solved[part])).verdict == "right"


def test_the_short_form_of_the_library_is_right(judge, arm):
    assert judge("T4_sym", arm.symbolic()).verdict == "right"
    assert judge("T4_sym", arm.symbolic(short=True)).verdict == "right"
    assert judge("mended", arm.symbolic(short=True)[1, 0]).verdict == "right"


def test_a_function_may_return_anything_that_is_a_matrix(judge, arm):
    assert judge("link", lambda i, q: arm.A(i, q).tolist()).verdict == "right"
    assert judge("link", lambda i, q: sp.Matrix(arm.A(i, q))).verdict == "right"
    assert judge("link", arm.A).verdict == "right"


@pytest.mark.parametrize("choice", ["n_y", "N_y", " ny ", ["n_y"], sp.Symbol("n_y")])
def test_a_choice_in_any_spelling(judge, choice):
    assert judge("slip", choice).verdict == "right"


def test_a_choice_that_is_none_of_them(judge):
    assert judge("slip", "n_w").verdict == "unreadable"
    assert "n_x, n_y, n_z" in judge("slip", "n_w").message


def test_missing_shape_text_and_nan_each_get_a_kind_sentence(every):
    for part in every.parts:
        answers = (..., "text", np.full((4, 4), np.nan), np.eye(3))
        said = {str(mark(part, read_answer(part.asks.request(), answer))) for answer in answers}
        assert len(said) >= (3 if part.asks.kind not in ("function", "choice") else 2), part.id
        for words in said:
            assert words.startswith(f"{part.id}: ")
            assert "None" not in words
            assert "{" not in words
            assert len(words) < 220


# Each reference against its own wrong self: what no answer may pass as


def mutations(values):
    """Small changes of a right answer, each larger than the tolerance."""
    for k in np.ndindex(values.shape[1:]):
        for by in (0.2, -0.2):
            changed = values.copy()
            changed[(slice(None), *k)] += by
            yield changed


def test_no_changed_answer_passes(every):
    for part in every.parts:
        if isinstance(part.asks, Valued):
            right = part.asks.values(part.chain)
            for changed in islice(mutations(right), 0, None, 5):
                if np.allclose(part.asks.meaning(changed), part.asks.meaning(right), atol=1e-9):
                    continue  # such as another point of the same line
                assert not mark(part, {"values": changed.tolist()}).passed, part.id


def test_a_formula_right_at_zero_only_does_not_pass(judge, arm):
    constant = sp.Matrix(arm.T(0, 4, [0, 0, 0, 0]))
    got = judge("T4_sym", constant)
    assert got.verdict == "wrong"
    assert "leave theta1, theta2, theta3, theta4 as symbols" in got.message


def test_close_values_are_told_to_round_later(judge, solved):
    got = judge("T4", np.round(solved["T4"], 2))
    assert got.verdict == "nearly"
    assert got.points == 1
    assert "(lengths: " in got.message
    assert "Round only at the end" in got.message


def test_only_a_pose_has_a_tolerance_of_its_own_for_lengths():
    hand = Part(
        "p", "Hand", 1, Numbers(lambda arm, q: arm.fk(q)[:3, 3], shape=(3,), at=(0.5, 1.0)), arm=robots.planar(2)
    )
    close = robots.planar(2).fk([0.5, 1.0])[:3, 3] + 3 * hand.asks.tolerance
    got = mark(hand, read_answer(hand.asks.request(), close))
    assert got.verdict == "nearly"
    assert "lengths" not in got.message


# What is wrong with a matrix, before it is compared


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda m: m.__setitem__((3, 0), 0.5), "last row"),
        (lambda m: m.__setitem__((slice(3), 1), 2 * m[:3, 1]), "Column o has length 2"),
        (lambda m: m.__setitem__((slice(3), 1), m[:3, 0]), "not at right angles"),
        (lambda m: m.__setitem__((slice(3), 2), -m[:3, 2]), "determinant of the rotation is −1"),
        (lambda m: m.__setitem__((slice(3), 3), m[:3, 3] + [3, 0, 4]), "5 mm away"),
        (lambda m: m.__setitem__(slice(3), (m @ Rz(1.0))[:3]), "p is right; the rotation is not: see columns n and o"),
    ],
)
def test_the_first_thing_that_is_wrong(judge, solved, change, words):
    matrix = np.array(solved["T4_quarter"])
    change(matrix)
    got = judge("T4_quarter", matrix)
    assert words in got.message
    assert got.verdict == "wrong"


# Errors that follow


def readings(exercise, values):
    return {p: read_answer(exercise.part(p).asks.request(), v) for p, v in values.items()}


def marks_of(exercise, values):
    return {m.part: m for m in Marker(exercise).mark_all(readings(exercise, values))}


def test_a_right_product_of_a_wrong_link_is_not_punished_again(exercise, solved):
    wrong = dict(solved, A2=solved["A2"] @ Rz(0.3))
    values = {k: wrong[k] for k in ("A1", "A2", "A3", "A4")}
    product = values["A1"] @ values["A2"] @ values["A3"] @ values["A4"]
    marks = marks_of(exercise, values | {"T4": product, "X": solved["Z"] @ product @ solved["E"]})
    assert marks["A2"].verdict == "wrong"
    assert (marks["T4"].verdict, marks["T4"].points) == ("follows", 2)
    assert "A2" in marks["T4"].message
    assert (marks["X"].verdict, marks["X"].points) == ("follows", 2)


def test_the_same_product_alone_is_wrong(exercise, solved):
    product = solved["A1"] @ solved["A2"] @ Rz(0.3) @ solved["A3"] @ solved["A4"]
    assert marks_of(exercise, {"T4": product})["T4"].verdict == "wrong"


def test_nothing_follows_from_a_link_that_is_not_there(exercise, solved):
    links = {name: solved[name] for name in ("A2", "A3", "A4")}
    product = links["A2"] @ links["A3"] @ links["A4"]
    assert marks_of(exercise, links | {"T4": product})["T4"].verdict == "wrong"


def test_all_links_wrong_without_a_reason_carry_nothing(exercise):
    values = dict.fromkeys(("A1", "A2", "A3", "A4", "T4"), np.eye(4))
    assert marks_of(exercise, values)["T4"].verdict == "wrong"
    assert marks_of(exercise, {"T4": np.eye(4), "X": exercise.arm.base @ exercise.arm.tool})["X"].verdict == "wrong"


def test_a_convention_confused_throughout_is_punished_in_the_links_alone(exercise, arm, solved):
    told = Chain(arm.joints, "modified", unit="mm")
    q = solved["q"]
    values = {f"A{i}": told.A(i, q) for i in (1, 2, 3, 4)} | {"T4": told.T(0, 4, q)}
    marks = marks_of(exercise, values)
    assert marks["A1"].misconception == "convention"
    assert marks["T4"].verdict == "follows"


# The page asks for one part


def test_the_page_is_told_what_the_notebook_is_told(solved):
    names = {"check": checker("quickshot"), "A1": solved["A1"], "slip": "n_y"}
    assert page.check(names, "A1")["passed"]
    stopped = page.check(names, "A1", "NameError: name 'q' is not defined")
    assert (stopped["passed"], stopped["points"]) == (False, 0)
    assert "NameError: name 'q' is not defined" in stopped["says"]
    assert not page.check(names, "A2")["passed"]
    assert page.check(names | {"check": 3}, "A1") == {"passed": False, "says": page.GONE, "points": None}


def test_the_page_does_not_punish_an_error_that_follows(exercise, solved):
    links = {name: solved[name] for name in ("A1", "A2", "A3", "A4")} | {"A2": solved["A2"] @ Rz(0.3)}
    product = links["A1"] @ links["A2"] @ links["A3"] @ links["A4"]
    names = {"check": checker("quickshot"), **links, "T4": product, "X": solved["Z"] @ product @ solved["E"]}
    told = {part: page.check(names, part) for part in ("X", "T4", "A2")}
    assert [told[part]["points"] for part in ("X", "T4")] == [exercise.part(part).points for part in ("X", "T4")]
    assert "A2" in told["T4"]["says"]
    assert not told["A2"]["passed"]
    assert page.check({**names, "A2": solved["A2"]}, "X")["points"] == 0


def test_the_page_of_a_closed_course_is_told_of_the_form_alone(solved):
    forms = {part: {"form": "numbers", "shape": [4, 4]} for part in ("A1", "A2", "A3")}
    names = {"check": form_checker("quickshot", forms), "A1": np.eye(4), "A2": np.eye(3)}
    good, bad, none = (page.check(names, part) for part in ("A1", "A2", "A3"))
    assert good["passed"]
    assert not bad["passed"]
    assert "A2 has 3 rows and 3 columns" in bad["says"]
    assert not none["passed"]
    assert {told["points"] for told in (good, bad, none)} == {None}


# Nothing from the box is trusted


@pytest.mark.parametrize(
    "reading",
    [
        None, 3, "right", [], {}, {"values": None}, {"values": []}, {"values": [1]}, {"values": "x" * 10},
        {"values": [[[1, 0, 0, 0]] * 3]}, {"values": [[[True] * 4] * 4]}, {"values": [[["1"] * 4] * 4]},
        {"values": [[[1, 0, 0, 0]] * 4] * 99},
        {"values": [[[None] * 4] * 4]}, {"values": [[[1e300] * 4] * 4]}, {"values": [[[10**400] * 4] * 4]},
        {"values": [[[float("nan")] * 4] * 4]}, {"values": [[[float("inf")] * 4] * 4]},
        {"values": {"0": 1}}, {"verdict": "right", "points": 30}, {"fault": 3}, {"fault": None},
        {"fault": {"a": 1}}, {"fault": "shape", "shape": "x"}, {"fault": "shape", "shape": [[1]]},
        {"fault": "symbols", "names": 3}, {"fault": "raised", "type": ["x"], "text": {"y": 2}},
        {"fault": "raised", "type": "{part.__class__}", "text": "{0}"}, {"choice": 3}, {"table": 3},
        {"table": {"rows": [[{}]]}}, {"table": {"rows": [["9" * 10_000] * 4]}}, {"table": {"rows": [[0] * 4] * 9_999}},
        {"table": {"rows": [["q1", 0, 0, 0]], "columns": 3}}, {"table": {"rows": [["q1", 0, 0, 0]], "base": 3}},
        {"table": {"rows": [["q1", 0, 0, 0]], "convention": "x"}},
        {"table": {"rows": [["q1*" * 60 + "q1", 0, 0, 0]] * 4, "columns": None}},
        {"table": {"rows": [["__import__('os')", 0, 0, 0]] * 4, "columns": None}},
        {"table": {"rows": [["q1", 0, 0, 0], [], [1], ["q1"] * 9], "columns": ["theta"] * 4}},
    ],
    ids=lambda r: str(r)[:60],
)  # fmt: skip
def test_a_forged_reading_earns_nothing_and_breaks_nothing(every, reading):
    for part in every.parts:
        got = mark(part, reading)
        assert got.points == 0
        assert not got.passed
        assert len(got.message) < 2_000


@pytest.mark.parametrize(("lost", "right"), [(2, True), (12, False), (24, False)])
def test_a_formula_may_lack_a_value_at_a_few_points_only(exercise, lost, right):
    part = exercise.part("A1_sym")
    values = part.asks.values(part.chain).tolist()
    assert len(values) == 24
    values[:lost] = [[[None] * 4] * 4] * lost
    got = mark(part, {"values": values})
    assert got.passed == right
    assert (f"no value at {lost} of the 24 sets" in got.message) == (not right)


def test_of_a_formula_without_a_value_here_and_there_the_others_are_looked_at(exercise):
    part = exercise.part("A1_sym")
    values = part.asks.values(part.chain).copy()
    values[:, 1, 3] += 7
    listed = values.tolist()
    listed[:2] = [[[None] * 4] * 4] * 2
    assert mark(part, {"values": listed}).message == mark(part, {"values": values.tolist()}).message


def test_a_part_that_is_not_there_is_told_which_are(exercise):
    with pytest.raises(DHError, match="its parts are frames, table, A1"):
        Marker(exercise).mark("B7", {})


# Exercises that are wrong themselves


def test_an_exercise_with_a_doubled_part_is_refused(arm):
    part = Part("A", "A", 1, Choice({"x": "yes"}, "x"))
    with pytest.raises(DHError, match="twice"):
        Exercise("e", "E", arm, [part, part])


def test_an_exercise_that_could_not_be_answered_is_refused(arm, tmp_path):
    with pytest.raises(DHError, match="'A 1' should be a name of a variable"):
        Exercise("e", "E", arm, [Part("A 1", "A", 1, Choice({"x": "yes"}, "x"))])
    with pytest.raises(DHError, match="part A has no arm"):
        _ = Part("A", "A", 1, Choice({"x": "yes"}, "x")).chain
    (tmp_path / "empty.py").write_text("EXERCISE = 3\n", "utf-8")
    with pytest.raises(DHError, match=r"should end with EXERCISE = Exercise"):
        load_exercise("empty", tmp_path)


def test_a_part_can_only_follow_from_earlier_ones(arm):
    part = Part("A", "A", 1, Choice({"x": "yes"}, "x"), follows=Follows(["B"], lambda b: b))
    with pytest.raises(DHError, match="no earlier part"):
        Exercise("e", "E", arm, [part])


def test_a_choice_without_its_right_option_or_a_reason_without_words_is_refused():
    with pytest.raises(ValueError, match=r"the right option 'z' is not among \['x', 'y'\]"):
        Choice({"x": "yes", "y": "no"}, "z")
    with pytest.raises(ValueError, match="a reason that does not hold should say why"):
        Reason(holds=False)


@pytest.mark.parametrize("name", ["../secret", "nothing", "", "A", 3])
def test_an_unknown_exercise_is_named(name):
    with pytest.raises(DHError, match="exercise"):
        load_exercise(name)


def test_an_exercise_of_ones_own(tmp_path):
    (tmp_path / "mine.py").write_text(
        "from dhlib import robots\n"
        "from dhlib.grading.exercise import Exercise, Part\n"
        "from dhlib.grading.forms import Numbers\n"
        "EXERCISE = Exercise('mine', 'Mine', robots.planar(2),"
        " [Part('p', 'Hand', 1, Numbers(lambda arm, q: arm.fk(q)[:3, 3], shape=(3,), at=(0.5, 1.0)))])\n"
    )
    part = load_exercise("mine", tmp_path).part("p")
    right = robots.planar(2).fk([0.5, 1.0])[:3, 3]
    assert mark(part, read_answer(part.asks.request(), right)).verdict == "right"
    assert "wrong sign" not in mark(part, read_answer(part.asks.request(), right + 1)).message
    assert (
        mark(part, read_answer(part.asks.request(), robots.planar(2).fk([-0.5, 1.0])[:3, 3])).misconception == "sense"
    )


def test_prismatic_joints_and_the_modified_convention_are_diagnosed_too():
    arm = robots.stanford().to_modified()
    q = (0.4, -0.9, 0.3, 1.2, 0.7, -0.5)
    part = Part("T", "T", 1, Numbers(lambda arm, q: arm.fk(q), at=q, length_tolerance=1e-3), arm=arm)
    joints = [*arm.joints]
    joints[2] = Revolute(d=joints[2].d, a=joints[2].a, alpha=joints[2].alpha, offset=joints[2].theta)
    told = Chain(joints, "modified", base=arm.base, tool=arm.tool)
    assert mark(part, read_answer(part.asks.request(), told.fk(q))).misconception == "joint_kind"
    got = mark(part, read_answer(part.asks.request(), Chain(arm.joints, "classic", arm.base, arm.tool).fk(q)))
    assert got.misconception == "convention"
    assert "Here it is Rx Tx Rz Tz" in got.message


def test_requests_hold_nothing_of_the_solution(every):
    for part in every.parts:
        request = part.asks.request()
        assert set(request) <= {"form", "shape", "symbols", "points", "calls", "convention", "options", "reasons"}
        assert json.loads(json.dumps(request)) == request


def test_what_stands_for_the_same_is_as_right():
    """Joint values are compared by the pose that they lead to, and wrong ones are named by it, too."""
    arm = Chain([Revolute(a=0.5), Revolute(a=0.3)], "classic")
    asks = Function(
        lambda arm, x, y: [x, y], shape=(2,), calls=[(0.4, 1.1), (-2.0, 0.7)], signature="f(x, y)", means=arm.fk
    )
    part = Part("f", "f", 1, asks, arm=arm, traps=[Trap("Joint 2 turns the wrong way.", lambda arm, x, y: [x, -y])])

    def judged(f):
        return mark(part, read_answer(asks.request(), f))

    assert judged(lambda x, y: [x, y + 2 * np.pi]).passed
    assert judged(lambda x, y: [x - 2 * np.pi, 2 * np.pi - y]).message == "Joint 2 turns the wrong way."
    assert judged(lambda x, y: [x, y + 1e-3]).message == "These values do not lead where they should."
    assert judged(lambda x, y: [1e9, 1e9]).verdict == "wrong"


def test_a_wrong_single_number_earns_nothing_unless_its_unit_alone_is_wrong():
    """One of a few options is soon guessed; a whole matrix is not."""
    told = [(0.3, "That is radians.", "degrees"), (3.0, "That is the other one.")]
    single = number("x", "X", 17.19, "", told, points=2, tolerance=0.01)
    single = Exercise("e", "E", robots.planar(2), [single]).parts[0]
    earned = {value: mark(single, {"values": [value]}).points for value in (17.19, 0.3, 3.0, 17.25, 5.0)}
    assert earned == {17.19: 2, 0.3: 1, 3.0: 0, 17.25: 0, 5.0: 0}
    whole = Part("m", "M", 2, Numbers(lambda arm, q: arm.fk(q), at=(0.3, 0.5)), arm=robots.planar(2),
                 traps=[Trap("That is the elbow.", lambda arm, q: arm.T(0, 1, q))])  # fmt: skip
    assert mark(whole, {"values": [robots.planar(2).T(0, 1, [0.3, 0.5]).tolist()]}).points == 0.5


WHY = reasoned(
    "w", "W", "no", {"yes": "look again.", "no": "a and c say why."},
    {"a": "", "b": "it is not longer.", "c": "", "d": "it is not red."}, "", points=4,
)  # fmt: skip


@pytest.mark.parametrize(
    ("answer", "verdict", "points", "words"),
    [
        (("no", "a", "c"), "right", 4, "A and c say why."),
        (["c", "a", "No"], "right", 4, ""),
        (("no", ["a", "c"]), "right", 4, ""),
        (("no", {"a", "c"}), "right", 4, ""),
        ({"no": ["a", "c"]}, "right", 4, ""),
        (("no", "ac"), "right", 4, ""),
        (("no", [[["a", "c"]]]), "right", 4, ""),
        ("no", "nearly", 0, "now say why: which of the reasons a b c d hold?"),
        (("no", "a"), "nearly", 1.5, "there are more"),
        (("no", "a", "b", "c"), "nearly", 1.5, "reason b is none: it is not longer."),
        (("no", "b"), "nearly", 0, "reason b is none"),
        (("yes", "a", "c"), "wrong", 0, "Look again."),
        (("yes", "d", "b"), "wrong", 0, "And reason b does not hold: it is not longer."),
        (("yes", "no", "a"), "unreadable", 0, "one of yes, no and then letters from a to d"),
        (("no", "x"), "unreadable", 0, "letters from a to d"),
        ("a", "unreadable", 0, ""),
        (("no", 3.5), "unreadable", 0, ""),
        (("no", ...), "open", 0, ""),
        (["no"] * 30, "unreadable", 0, ""),
    ],
)
def test_a_choice_with_reasons(answer, verdict, points, words):
    """The option alone is soon guessed: its points are for the reasons."""
    reading = json.loads(json.dumps(read_answer(WHY.asks.request(), answer)))
    got = mark(WHY, reading)
    assert (got.verdict, got.points) == (verdict, points), got
    assert words in got.message


def test_a_choice_with_bad_reasons_is_refused():
    for reasons in ({"a": "no."}, {"no": ""}, {}):
        with pytest.raises(ValueError, match="reason"):
            reasoned("w", "W", "no", {"no": "so."}, reasons, "")


@pytest.mark.parametrize(
    ("part", "slip", "words"),
    [
        ("T4", lambda v: v["T4"].round(2), "Round only at the end"),
        ("T4", lambda v: np.round(v["T4"]), "the columns of a rotation are unit vectors"),
        ("link", lambda v: lambda i, q: v["link"](i, v["q"]), "It gives the same whatever values it is called with"),
        ("link", lambda v: lambda i, q: v["link"](i % 4 + 1, q), "all four columns differ"),
        ("link", lambda v: lambda i, q: [v["A1"], v["A2"], v["A3"], v["A4"]][i], "the items of a list from 0"),
        ("link", lambda v: lambda i, q: v["link"](i, q) * (1 if i != 3 else [[0.5], [1], [1], [1]]), "Column n"),
        (
            "link",
            lambda v: lambda i, q: v["link"](i, q) if i != 3 else v["link"](2, q),
            "It is right for i = 1, 2 and 4, but not for i = 3.",
        ),
        ("frames", lambda v: v["frames"][:4], "frames has 4 matrices of 4 by 4; a list of 5"),
    ],
)
def test_what_students_do(judge, solved, part, slip, words):
    got = judge(part, slip(solved))
    assert words in got.message, got


def test_a_function_that_is_right_now_and_then_is_told_so():
    part = load_exercise("transforms").part("invert")

    def good(T):
        return bool(np.asarray(T)[0, 3] > 0)

    right = [good(T) for (T,) in part.asks.calls]
    assert 0 < sum(right) < len(right)
    got = mark(part, read_answer(part.asks.request(), lambda T: np.linalg.inv(T) if good(T) else np.eye(4)))
    assert f"In {sum(right)} of {len(right)} calls it is right" in got.message


def test_a_function_that_fails_once_for_each_number_is_told_how_often_it_is_right(judge, arm):
    seen = []

    def right_at_first(i, q):
        seen.append(i)
        return arm.A(i, q) if seen.count(i) == 1 else np.eye(4)

    assert "In 4 of 8 calls it is right, in the others it is not." in judge("link", right_at_first).message


def test_a_single_number_of_the_other_sign_is_told_so():
    part = Part("x", "X", 1, Numbers(lambda arm, q: 7.5, shape=(), at=(0.3, 0.5)), arm=robots.planar(2))
    assert mark(part, {"values": [-7.5]}).message == "The value is right but for its sign."
    assert mark(part, {"values": [7.0]}).message == "The value differs from the right one."


def test_entries_are_named_in_the_plural():
    part = load_exercise("puma560").part("p")
    got = mark(part, read_answer(part.asks.request(), [0, 0, sp.Symbol("S1")]))
    assert got.message == "Entries 1, 2 and 3 differ from what is asked for."


@pytest.mark.parametrize(("part", "n"), [("table2_modified", 2), ("table3_modified", 3)])
def test_a_length_left_in_its_row_is_named(part, n):
    part = load_exercise("planar").part(part)
    got = mark(part, read_answer(part.asks.request(), [[0, length, f"theta{i}", 0] for i, length in
                                                      enumerate((260, 190, 110)[:n], 1)]))  # fmt: skip
    assert (got.misconception, got.section) == ("row", "sec-modified-trap-row")
    assert got.message.startswith("Row i holds the length of link i")


@pytest.mark.parametrize(
    ("count", "says"), [(4, "{4} stands where the last link ends. One is missing."), (7, "Two are too many.")]
)
def test_how_many_frames_there_should_be_is_said(judge, count, says):
    got = judge("frames", [np.eye(4)] * count)
    assert got.verdict == "unreadable"
    assert "The frames are {0} to {4}: {0}, the base, counts too" in got.message
    assert says in got.message


def test_frames_of_another_shape_are_not_counted(judge):
    """Negative control."""
    assert "The frames are" not in judge("frames", [np.eye(3)] * 5).message


@pytest.mark.parametrize(
    ("k", "moved", "words"),
    [(0, Rz(1.0) @ Tz(5.0), "frame 0 is not the one given."), (4, Tz(5.0), "the origin of frame 4 is not where")],
)
def test_frames_that_obey_and_stand_at_another_end_are_nearly_right(judge, arm, k, moved, words):
    frames = arm.frames(np.zeros(4))
    frames[k] = frames[k] @ moved
    got = judge("frames", frames)
    assert got.message.startswith(f"Every link obeys DH1 and DH2, but {words}")
    assert (got.verdict, got.points) == ("nearly", 0.75 * got.out_of)
