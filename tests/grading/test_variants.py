"""Every student their own numbers: drawn again by whoever has the key, all of equal difficulty, and stored nowhere."""

import copy
import json
import re
from pathlib import Path

import numpy as np
import pytest
from sampling import FULL, some

from dhlib.errors import DHError
from dhlib.grading import asked
from dhlib.grading.answers import read_answer
from dhlib.grading.course.editions import HOW, for_course
from dhlib.grading.course.lots import Lots
from dhlib.grading.course.papers import NotAssigned, as_metadata, check_tag, load_paper, make_tag, read_tag
from dhlib.grading.course.variants import Variants, fill, load_variant
from dhlib.grading.forms import Choice, Valued
from dhlib.grading.marking import Marker, agree

ROOT = Path(__file__).parents[2]
KEY = bytes(range(32))
NAMES = sorted(path.stem for path in (ROOT / "solutions").glob("*.ipynb"))
STUDENTS = ["s1", "Müller-Lüdenscheidt", "0815", *(f"student {k}" for k in range(47 if FULL else 0))]
VARYING = [name for name in NAMES if Variants(name, ROOT / "exercises").vary]


@pytest.fixture(scope="session")
def variants():
    return {name: Variants(name, ROOT / "exercises") for name in VARYING}


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


def solution_of(name, variant):
    notebook = load(ROOT / "solutions" / f"{name}.ipynb")
    fill(notebook, variant.given)
    return without_checks(notebook)


def without_checks(notebook):
    """Checks know the numbers of the book alone."""
    cells = [cell for cell in notebook["cells"] if cell["metadata"]["dh"]["role"] != "check"]
    return {**notebook, "cells": cells}


def marks_of(exercise, names):
    readings = {part.id: read_answer(part.asks.request(), names.get(part.id)) for part in exercise.parts}
    return {mark.part: mark for mark in Marker(exercise).mark_all(json.loads(json.dumps(readings)))}


@pytest.mark.parametrize("name", NAMES)
def test_the_stored_notebook_holds_what_its_file_says(name):
    for folder in ("solutions", "exercises"):
        notebook = load(ROOT / folder / f"{name}.ipynb")
        filled = copy.deepcopy(notebook)
        fill(filled, Variants(name, ROOT / "exercises").of().cells())
        assert filled == notebook, "run make exercises"


@pytest.mark.parametrize("name", VARYING)
@pytest.mark.parametrize("student", STUDENTS)
def test_the_solution_solves_every_students_numbers(name, student, variants, variables):
    variant = variants[name].of(KEY, student)
    marks = marks_of(variant.exercise, variables(solution_of(name, variant)))
    assert {part: str(mark) for part, mark in marks.items() if mark.points < mark.out_of} == {}


@pytest.mark.parametrize("name", some(VARYING, 4, "public"))
def test_the_public_solution_earns_next_to_nothing_of_what_has_numbers(name, variants, variables):
    """Negative control of the above, and the reason for it all."""
    public = variables(without_checks(load(ROOT / "solutions" / f"{name}.ipynb")))
    book = variants[name].of()
    for student in STUDENTS:
        variant = variants[name].of(KEY, student)
        marks = marks_of(variant.exercise, public)
        other = [part.id for part in variant.exercise.parts if differs(part, book.exercise.part(part.id))]
        assert other
        assert {part for part in other if marks[part].verdict == "right"} == set()


@pytest.mark.parametrize("name", VARYING)
def test_every_answer_is_the_students_own_but_for_a_short_list(name, variants):
    """Each part either varies within a dozen students, or stands in the list of its exercise's file, which says why."""
    answers = {}
    for k in range(12):
        for part in variants[name].of(KEY, f"student {k}").exercise.parts:
            answers.setdefault(part.id, set()).add(answer_of(part))
    assert sorted(part for part, told in answers.items() if len(told) == 1) == sorted(variants[name].same_for_all)
    exercise = variants[name].of().exercise
    assert not [part for part in variants[name].same_for_all if isinstance(exercise.part(part).asks, Choice)]


def answer_of(part):
    """The right answer to a part, as something to compare."""
    match part.asks:
        case Valued():
            return np.round(part.asks.values(part.chain), 9).tobytes()
        case Choice():
            return part.asks.right, *sorted(getattr(part.asks, "needed", ()))
    return part.chain.joints


def test_a_part_that_does_not_vary_is_seen():
    """Negative control of the above."""
    formula, table = (load_variant("puma560").exercise.part(name) for name in ("A1", "table"))
    other = load_variant("puma560", None, KEY, "s1").exercise
    assert answer_of(formula) == answer_of(other.part("A1"))
    assert answer_of(table) != answer_of(other.part("table"))


def differs(part, of_the_book):
    """Whether a part has another answer than in the book."""
    if isinstance(part.asks, Valued):
        mine, theirs = (asked.asks.values(asked.chain) for asked in (part, of_the_book))
        return not agree(theirs, mine, part.asks.tolerances)
    return getattr(part.asks, "right", None) != getattr(of_the_book.asks, "right", None)


@pytest.mark.parametrize("name", VARYING)
def test_no_variant_is_luckier_than_the_book(name, variants):
    """What differs from the right answer in the book differs from it for every student: no zero hides a mistake."""
    book = variants[name].of().exercise
    for k in range(3):
        variant = variants[name].of(KEY, f"student {k}")
        assert [part.id for part in variant.exercise.parts] == [part.id for part in book.parts]
        assert variant.exercise.points == book.points
        for part, default in zip(variant.exercise.parts, book.parts, strict=True):
            if not isinstance(part.asks, Valued):
                continue
            assert part.asks.shape == default.asks.shape
            right, theirs = part.asks.values(part.chain), default.asks.values(default.chain)
            assert always_zero(right) <= always_zero(theirs), part.id
            for trap, same in zip(part.traps, default.traps, strict=True):
                told, known = told_by(trap, part), told_by(same, default)
                if not agree(known, theirs, default.asks.tolerances):
                    assert not agree(told, right, part.asks.tolerances), (part.id, trap.says)


def always_zero(values):
    """How many entries are zero at every probe."""
    return np.sum(np.all(np.abs(values) < 1e-9, axis=0))


def told_by(trap, part):
    return np.array([np.asarray(trap.quantity(part.chain, *probe), dtype=float) for probe in part.asks.probes])


@pytest.mark.parametrize("name", VARYING)
def test_numbers_are_the_students_own_and_readable(name, variants):
    book, *drawn = (
        {part: source for part, source in variant.given.items() if part != HOW}
        for variant in [variants[name].of(), *(variants[name].of(KEY, f"student {k}") for k in range(40))]
    )
    for part, source in book.items():
        assert all(given[part] != source for given in drawn), f"{part} stands in the book"
    texts = ["".join(given.values()) for given in drawn]
    assert len(set(texts)) == len(texts)
    assert max(len(number) for text in texts for number in re.findall(r"\d+\.?\d*", text)) <= 9


def test_what_is_drawn_depends_on_the_key_the_student_the_exercise_and_the_name_alone():
    def drawn(key=KEY, student="s1", exercise="quickshot", name="height"):
        return Lots(key, student, exercise).some(name, range(1000), 5)

    assert drawn() == drawn()
    assert drawn(student=" S1") == drawn()
    changed = [drawn(key=KEY[::-1]), drawn(student="s2"), drawn(exercise="planar"), drawn(name="ahead")]
    assert len({tuple(numbers) for numbers in [drawn(), *changed]}) == 5


def test_what_is_drawn_is_written_down_here():
    """Whoever changes how lots are drawn changes the numbers of notebooks that are out."""
    assert Lots(KEY, "s1", "quickshot").some("height", range(1000), 4) == [91, 901, 602, 507]


def test_more_than_there_are_cannot_be_drawn():
    assert sorted(Lots(KEY, "s1", "x").some("die", range(6), 6)) == list(range(6))
    with pytest.raises(ValueError, match="die: 7 are to be drawn out of 6"):
        Lots(KEY, "s1", "x").some("die", range(6), 7)


def test_draws_are_even():
    counts = np.bincount([Lots(KEY, f"s{k}", "x").one("die", range(6)) for k in range(3000)], minlength=6)
    assert np.sum((counts - 500) ** 2 / 500) < 20.5  # chi squared, five degrees of freedom, one in a thousand


def test_papers_hold_the_numbers_of_their_student():
    mine, yours, book = (
        load_paper("quickshot", ROOT / "exercises", key, student)
        for key, student in ((KEY, "s1"), (KEY, "s2"), (None, None))
    )
    sources = [
        {cell.part: cell.source for cell in paper.cells if cell.role == "given"} for paper in (mine, yours, book)
    ]
    assert sources[0] != sources[1] != sources[2] != sources[0]
    assert [(cell.role, cell.part) for cell in mine.cells] == [(cell.role, cell.part) for cell in book.cells]
    arms = [paper.exercise.part("table").chain for paper in (mine, yours, book)]
    assert len({arm.joints[0].d for arm in arms} | {arm.joints[1].a for arm in arms}) > 3


def test_an_exercise_without_numbers_of_its_own_says_so(tmp_path):
    (tmp_path / "plain.py").write_text(
        "from dhlib import robots\nfrom dhlib.grading.exercise import Exercise\n"
        'EXERCISE = Exercise("plain", "Plain", robots.planar(2))\n'
    )
    assert set(Variants("plain", tmp_path).of().given) == {HOW}
    with pytest.raises(DHError, match=r"has no numbers to draw: .*plain\.py should offer draw"):
        Variants("plain", tmp_path).of(KEY, "s1")


def test_a_file_without_an_exercise_is_named(tmp_path):
    (tmp_path / "empty.py").write_text("EXERCISE = 3\n")
    with pytest.raises(DHError, match=r"empty\.py should end with EXERCISE = Exercise"):
        Variants("empty", tmp_path)


def test_a_notebook_whose_setup_makes_no_check_is_named(variants):
    exercise = variants["quickshot"].of().exercise
    notebook = load(ROOT / "exercises" / "quickshot.ipynb")
    assert "form_checker" in json.dumps(for_course(notebook, exercise))
    notebook["cells"] = [cell for cell in notebook["cells"] if cell["metadata"]["dh"]["role"] != "setup"]
    with pytest.raises(DHError, match="quickshot: one setup cell should hold the lines"):
        for_course(notebook, exercise)


def test_a_class_larger_than_is_kept_is_asked_the_same_again(monkeypatch):
    monkeypatch.setattr(asked, "MOST_KEPT", 1)
    catalogue = asked.Catalogue(ROOT / "exercises", KEY)
    first, other, again = (catalogue.asked("quickshot", student) for student in ("s1", "s2", "s1"))
    assert first is not again
    assert first.pristine == again.pristine != other.pristine
    assert first.sha256 == again.sha256 == catalogue.sha256("quickshot") != asked.Catalogue().sha256("quickshot")


def test_cells_and_sources_belong_together():
    notebook = load(ROOT / "solutions" / "quickshot.ipynb")
    given = dict(Variants("quickshot", ROOT / "exercises").of().given)
    with pytest.raises(DHError, match="no given cell for more"):
        fill(copy.deepcopy(notebook), {**given, "more": "x = 1"})
    del given["angles"]
    with pytest.raises(DHError, match="'angles' has no source"):
        fill(copy.deepcopy(notebook), given)


def test_the_tag_of_a_notebook_is_read_whatever_it_holds():
    assert read_tag({"metadata": {"dh": {"exercise": "quickshot"}}}).exercise == "quickshot"
    for metadata in ({}, {"dh": 3}, {"dh": {"exercise": ["x"]}}, {"dh": {"exercise": "x" * 1000}}, None):
        assert read_tag({"metadata": metadata}).exercise == ""
    assert read_tag({}).student == ""


def test_a_tag_that_was_altered_or_made_with_another_key_is_not_believed():
    tag = make_tag(KEY, "quickshot", "s1", "2030-01-31")
    notebook = {"metadata": {"dh": as_metadata(tag)}}
    check_tag(read_tag(notebook), KEY)
    assert KEY.hex() not in json.dumps(notebook)
    with pytest.raises(NotAssigned, match="another key"):
        check_tag(tag, KEY[::-1])
    for field, value in {"student": "s2", "due": "2031-01-31", "exercise": "planar", "seal": "ä"}.items():
        altered = {"metadata": {"dh": {**as_metadata(tag), field: value}}}
        with pytest.raises(NotAssigned, match="altered"):
            check_tag(read_tag(altered), KEY)
    with pytest.raises(NotAssigned, match="no notebook that was assigned"):
        check_tag(read_tag({"metadata": {"dh": {"exercise": "quickshot"}}}), KEY)
