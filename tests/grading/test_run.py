"""A run: nothing is lost and nothing graded twice, whenever it is stopped and whatever dies."""

import dataclasses
import json
import os
import random
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest
from sampling import FULL

from dhlib.errors import DHError
from dhlib.grading.asked import Catalogue
from dhlib.grading.batch.lock import Lock
from dhlib.grading.batch.pool import Pool
from dhlib.grading.batch.run import Shard, grade_class
from dhlib.grading.batch.store import Certainty, Store
from dhlib.grading.batch.versions import versions
from dhlib.grading.batch.work import Grader, Settings, Work, grade
from dhlib.grading.grade import mark, prepare
from dhlib.grading.wall import Outcome

RUN = Path(__file__).with_name("quick_run.py")
KILLS = 50 if FULL else 6
EXERCISE = """
from dhlib import robots
from dhlib.grading.exercise import Exercise, Part
from dhlib.grading.forms import Choice

ASKED = Choice({"a": "Yes.", "b": "No.", "die": "No."}, "a")
EXERCISE = Exercise("tiny", "Tiny", robots.planar(2), [Part("pick", "Pick one", 2, ASKED)])
"""


def notebook(answer=None, **about):
    cells = [
        ("setup", "", "x = 1"),
        ("answer", "pick", f"pick = '{answer}'" if answer else "pick = ..."),
        ("check", "pick", 'check("pick", pick)'),
    ]
    return {
        "cells": [
            {"cell_type": "code", "source": source, "metadata": {"dh": {"role": role, "part": part}}}
            for role, part, source in cells
        ],
        "metadata": {"dh": {"exercise": "tiny", **about}},
        "nbformat": 4,
        "nbformat_minor": 5,
    }


@pytest.fixture
def exercises(tmp_path):
    folder = tmp_path / "exercises"
    folder.mkdir()
    (folder / "tiny.py").write_text(EXERCISE)
    (folder / "tiny.ipynb").write_text(json.dumps(notebook()))
    return folder


@pytest.fixture
def hand_in(tmp_path):
    """``hand_in(path, answer, **about)`` into the class."""

    def put(path, answer, **about):
        file = tmp_path / "class" / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(answer if "\n" in answer else json.dumps(notebook(answer, **about)), "utf-8")
        return tmp_path / "class"

    return put


class Here:
    """Grades in this process, in a box that costs nothing, and remembers whom."""

    def __init__(self, settings, stop_after=None):
        self.settings, self.stop_after, self.graded = settings, stop_after, []

    def grade(self, works):
        grader = Grader(self.settings)
        for work in works:
            if self.stop_after is not None and len(self.graded) >= self.stop_after:
                raise KeyboardInterrupt
            self.graded.append(work.student or work.name)
            yield grade(grader, self, work)

    def run(self, cells, requests):
        answer = next(cell.source for cell in cells if cell.role == "answer").split("'")[1]
        if answer == "bug":
            raise ZeroDivisionError
        return Outcome({"pick": {"choice": answer}})


@pytest.fixture
def run(tmp_path, exercises):
    """``run(**options)``: grade the class; returns whom, and the results."""

    def go(stop_after=None, exercise="", **options):
        settings = Settings(exercise, exercises)
        here = Here(settings, stop_after)
        try:
            grade_class([tmp_path / "class"], tmp_path / "out", settings, here, **options)
        except KeyboardInterrupt:
            assert stop_after is not None
        with Store(tmp_path / "out") as store:
            return here.graded, store.submissions(), store.problems()

    return go


def by_source(submissions):
    return {s.source: s for s in submissions}


def test_answers_are_marked_and_kept(hand_in, run, tmp_path):
    hand_in("ada/tiny.ipynb", "a")
    hand_in("bob/tiny.ipynb", "b")
    _, submissions, problems = run()
    assert [(s.student, s.points, s.out_of, s.status, s.exercise) for s in submissions] == [
        ("ada", 2, 2, "graded", "tiny"),
        ("bob", 0, 2, "graded", "tiny"),
    ]
    assert problems == []
    assert all(s.sha256 and s.graded_at and s.python and s.numpy and s.exercise_sha256 for s in submissions)
    with Store(tmp_path / "out") as store:
        assert [mark.reading for mark in store.marks(1)] == [{"choice": "a"}]


def test_what_is_graded_is_left_alone_and_what_is_new_is_added(hand_in, run):
    hand_in("ada/tiny.ipynb", "b")
    assert run()[0] == ["ada"]
    assert run()[0] == []
    hand_in("bob/tiny.ipynb", "a")
    assert run()[0] == ["bob"]
    hand_in("ada/tiny.ipynb", "a")  # handed in once more, under the same name
    graded, submissions, _ = run()
    assert graded == ["ada"]
    assert [(s.student, s.attempt, s.counts, s.points) for s in submissions] == [
        ("ada", 1, False, 0),
        ("ada", 2, True, 2),
        ("bob", 1, True, 2),
    ]


def test_a_run_that_was_interrupted_goes_on(hand_in, run):
    for k in range(5):
        hand_in(f"s{k}/tiny.ipynb", "a")
    assert run(stop_after=2)[0] == ["s0", "s1"]
    graded, submissions, _ = run()
    assert graded == ["s2", "s3", "s4"]
    assert len(submissions) == 5


def test_regrading_takes_what_was_asked_differently(hand_in, run, exercises, monkeypatch):
    hand_in("ada/tiny.ipynb", "a")
    run()
    assert run(regrade="changed")[0] == []
    text = (exercises / "tiny.py").read_text()
    (exercises / "tiny.py").write_text(text.replace('"a")', '"b")'))
    assert run()[0] == []
    graded, submissions, _ = run(regrade="changed")
    assert (graded, submissions[0].points, len(submissions)) == (["ada"], 0, 1)
    assert run(regrade="changed")[0] == []
    monkeypatch.setattr("dhlib.grading.batch.run.versions", lambda: versions() | {"dhlib": "9"})
    assert run(regrade="changed")[0] == ["ada"]


def test_what_did_not_say_which_exercise_it_is_is_graded_once_somebody_says(hand_in, run):
    hand_in("ada/tiny.ipynb", "a")
    hand_in("bob/final (3).ipynb", "a", exercise="")
    hand_in("eve/tiny.ipynb", "no notebook\n")
    _, submissions, _ = run()
    assert [(s.student, s.status) for s in submissions] == [
        ("ada", "graded"), ("bob", "unreadable"), ("eve", "unreadable")
    ]  # fmt: skip
    assert "--exercise NAME" in submissions[1].message
    hand_in("zoe/tiny.ipynb", "b", exercise="huge")
    graded, submissions, _ = run(exercise="tiny")
    assert graded == ["bob", "eve", "zoe"]
    assert submissions.pop().message == "tiny.ipynb says that it is of the exercise huge; it was graded as tiny."
    assert [(s.student, s.points) for s in submissions] == [("ada", 2), ("bob", 2), ("eve", 0)]
    assert run(exercise="tiny")[0] == []


def test_regrading_all_is_resumed_too(hand_in, run):
    for k in range(4):
        hand_in(f"s{k}/tiny.ipynb", "a")
    run()
    time.sleep(0.002)  # times are kept to the millisecond
    assert run(regrade="all", stop_after=1)[0] == ["s0"]
    assert run(regrade="all")[0] == ["s1", "s2", "s3"]
    time.sleep(0.002)
    assert run(regrade="all")[0] == ["s0", "s1", "s2", "s3"]


def test_a_broken_exercise_ends_the_run_in_a_sentence(hand_in, run, exercises):
    hand_in("ada/tiny.ipynb", "a")
    (exercises / "tiny.py").write_text("1 / 0")
    with pytest.raises(DHError, match=r"exercise 'tiny' is broken: ZeroDivisionError"):
        run()


def test_a_bug_of_ours_costs_one_submission_and_is_tried_again(hand_in, run):
    hand_in("ada/tiny.ipynb", "bug")
    hand_in("bob/tiny.ipynb", "a")
    _, submissions, _ = run()
    assert [(s.student, s.status) for s in submissions] == [("ada", "failed"), ("bob", "graded")]
    assert "ZeroDivisionError" in submissions[0].message
    assert run()[0] == ["ada"]


# ── who is who ──


def test_metadata_tells_only_where_the_place_does_not(hand_in, run):
    hand_in("tiny.ipynb", "a", student="carl")
    hand_in("ada/tiny.ipynb", "b", student="carl")
    hand_in("bob/tiny.ipynb", "b")
    _, submissions, problems = run()
    found = by_source(submissions)
    assert found["tiny.ipynb"].student == "carl"
    assert found["tiny.ipynb"].certainty == Certainty.METADATA
    assert found["ada/tiny.ipynb"].student == "ada"
    (problem,) = problems
    assert problem.what == "It says that it is of carl, but it was found where ada's work is."
    assert problem.students == ("ada", "carl")


def test_the_work_of_somebody_who_handed_in_nothing_is_told_by_the_roster(hand_in, run):
    class Carl:
        id, name = "s3", "Carl"

    hand_in("ada/tiny.ipynb", "a", student="carl")
    assert run()[2] == []
    problems = run(roster=lambda names: Carl() if "carl" in names else None)[2]
    (problem,) = (problem for problem in problems if "roster" not in problem.what)
    assert problem.what == "It says that it is of s3, but it was found where ada's work is."


def test_who_says_that_it_is_themselves_is_not_listed(hand_in, run):
    hand_in("ada/tiny.ipynb", "a", student="Ada ")
    assert run()[2] == []


def test_two_who_say_that_they_are_the_same_stranger_are_listed(hand_in, run):
    hand_in("ada/tiny.ipynb", "a", student="zoe")
    hand_in("bob/tiny.ipynb", "a", student="zoe")
    hand_in("carl/tiny.ipynb", "a", student="dora")
    _, _, problems = run()
    assert {problem.source: problem.what for problem in problems} == {
        "ada/tiny.ipynb": "It says that it is of 'zoe', and so do notebooks of bob.",
        "bob/tiny.ipynb": "It says that it is of 'zoe', and so do notebooks of ada.",
    }


def test_whom_the_metadata_told_is_known_when_the_run_is_repeated(hand_in, run):
    hand_in("tiny.ipynb", "a", student="carl")
    first = run()[1]
    graded, again, _ = run()
    assert graded == []
    assert again == first
    assert (again[0].student, again[0].certainty) == ("carl", Certainty.METADATA)


def test_what_cannot_be_unpacked_is_unreadable_and_says_why(hand_in, run, tmp_path):
    hand_in("bob/tiny.ipynb", "a")
    (tmp_path / "class" / "ada").mkdir()
    with zipfile.ZipFile(tmp_path / "class" / "ada" / "work.zip", "w") as archive:
        archive.writestr("../tiny.ipynb", "x")
    _, submissions, _ = run()
    ada = next(submission for submission in submissions if submission.student == "ada")
    assert (ada.status, ada.points) == ("unreadable", 0)
    assert "outside of its folder" in ada.message


def test_two_places_that_claim_one_student_are_listed_and_both_kept(hand_in, run):
    hand_in("ada/tiny.ipynb", "b")
    hand_in("x.ipynb", "a")
    hand_in("tiny.ipynb", "a", student="ada")
    hand_in("tiny (1).ipynb", "a", student="x")
    _, submissions, problems = run()
    counting = {s.source for s in submissions if s.counts}
    assert len(submissions) == 4
    assert counting == {"ada/tiny.ipynb", "x.ipynb"}
    assert len([p for p in problems if "are all said to be of" in p.what]) == 2


def test_what_nobody_can_place_is_listed(hand_in, run):
    hand_in("tiny.ipynb", "a")
    hand_in("tiny (2).ipynb", "a")
    _, submissions, problems = run()
    assert [s.student for s in submissions] == ["", ""]
    assert all("Nothing says whose it is" in problem.what for problem in problems)
    assert len(problems) == 2


def test_of_two_notebooks_that_came_at_once_the_last_by_name_counts_whichever_was_graded_first(hand_in, run):
    for student, names in (("ada", ["tiny", "tiny-2"]), ("bob", ["tiny-2", "tiny"])):
        for name in names:
            folder = hand_in(f"{student}/{name}.ipynb", "a" if name == "tiny-2" else "b")
            os.utime(folder / f"{student}/{name}.ipynb", (1e9, 1e9))
            _, submissions, problems = run()
    assert {s.source: s.points for s in submissions if s.counts} == {"ada/tiny-2.ipynb": 2, "bob/tiny-2.ipynb": 2}
    assert [p.students for p in problems] == [("ada",), ("bob",)]
    assert problems[0].what == (
        "ada/tiny-2.ipynb and ada/tiny.ipynb came together, for tiny. ada/tiny-2.ipynb counts, as the last by its name."
    )
    os.utime(folder / "bob/tiny.ipynb", (2e9, 2e9))  # as a matter of fact one came later: nothing is left to look at
    _, submissions, problems = run()
    assert [s.source for s in submissions if s.student == "bob" and s.counts] == ["bob/tiny.ipynb"]
    assert [p.students for p in problems] == [("ada",)]


def test_an_exercise_that_hardly_anybody_handed_in_is_listed(hand_in, run, exercises):
    for suffix in (".py", ".ipynb"):
        text = (exercises / f"tiny{suffix}").read_text()
        (exercises / f"other{suffix}").write_text(text.replace('"tiny"', '"other"'))
    for k in range(20):
        hand_in(f"s{k:02}/tiny.ipynb", "a")
    hand_in("eve/other.ipynb", "a", exercise="other")
    assert run()[2] == []
    hand_in("zoe/tiny.ipynb", "a")
    (problem,) = run()[2]
    assert (problem.source, problem.students) == ("eve/other.ipynb", ("eve",))
    assert "dhlib export --exercise tiny" in problem.what


def test_what_a_run_did_not_reach_is_said_to_be_that(exercises):
    ready = prepare(json.dumps(notebook("a")).encode(), "tiny.ipynb", Catalogue(exercises))
    stopped, finished = mark(ready, Outcome(note="It was stopped.")), mark(ready, Outcome())
    assert "ended before it came to this part" in stopped[0].message
    assert "ended before" not in finished[0].message
    assert (stopped[0].verdict, stopped[0].points) == ("open", 0)


def test_a_last_attempt_that_cannot_be_read_does_not_count(hand_in, run):
    hand_in("ada/1.ipynb", "a")
    folder = hand_in("ada/2.ipynb", "no notebook\n")
    os.utime(folder / "ada/1.ipynb", (1e9, 1e9))
    _, submissions, problems = run()
    assert [(s.source, s.counts) for s in submissions] == [("ada/1.ipynb", True), ("ada/2.ipynb", False)]
    assert [p.what for p in problems] == ["It cannot be read; ada/1.ipynb counts instead."]


def test_a_roster_that_comes_later_renames_without_grading(hand_in, run):
    class Person:
        id, name = "s1", "Ada Lovelace"

    hand_in("ada/tiny.ipynb", "a")
    run()
    graded, submissions, _ = run(roster=lambda names: Person() if "ada" in names else None)
    assert graded == []
    assert (submissions[0].student, submissions[0].name, submissions[0].points) == ("s1", "Ada Lovelace", 2)


def test_names_may_stay_out_of_what_is_printed(hand_in, run, capsys):
    hand_in("Lovelace/Ada Lovelace.ipynb", "no notebook\n")
    run(quiet=True)
    assert "number 1: unreadable." in (said := capsys.readouterr().err)
    assert "Lovelace" not in said
    run(regrade="all")
    assert "Lovelace" in capsys.readouterr().err


# ── shares ──


def test_shares_are_disjoint_and_complete(hand_in, tmp_path, exercises):
    for k in range(30):
        hand_in(f"s{k}/tiny.ipynb", "a")
    settings = Settings(exercises=exercises)
    graded = []
    for index in (1, 2, 3):
        here = Here(settings)
        grade_class([tmp_path / "class"], tmp_path / f"out{index}", settings, here, shard=Shard(index, 3))
        assert 0 < len(here.graded) < 30
        graded += here.graded
    assert sorted(graded) == sorted(f"s{k}" for k in range(30))


# ── two graders, dying workers, kill -9 ──


def test_two_graders_on_one_folder(hand_in, run, tmp_path):
    hand_in("ada/tiny.ipynb", "a")
    run()
    hand_in("bob/tiny.ipynb", "a")
    with Lock(tmp_path / "out"), pytest.raises(DHError, match=r"another grader is filling .*--out"):
        run()
    assert run()[0] == ["bob"]


@pytest.mark.parametrize(
    "fill", [lambda file: file.mkdir(), lambda file: file.write_text("no database " * 99, "utf-8")]
)
def test_a_folder_that_cannot_be_locked_is_named(hand_in, run, tmp_path, fill):
    hand_in("ada/tiny.ipynb", "a")
    (tmp_path / "out").mkdir()
    fill(tmp_path / "out" / "results.lock")
    with pytest.raises(DHError, match=r"results\.lock cannot be written to"):
        run()


def command(tmp_path, workers, *more):
    return [
        sys.executable,
        str(RUN),
        *(str(tmp_path / name) for name in ("class", "out", "exercises", "log")),
        str(workers),
        *more,
    ]


def log(tmp_path):
    path = tmp_path / "log"
    return [line.split() for line in path.read_text().splitlines()] if path.exists() else []


def alive(process):
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_a_worker_that_dies_is_replaced_and_a_poisonous_notebook_is_given_up(hand_in, exercises, tmp_path):
    for k in range(8):
        hand_in(f"s{k}/tiny.ipynb", "die" if k == 3 else "a")
    done = subprocess.run(command(tmp_path, 2), capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    with Store(tmp_path / "out") as store:
        status = {s.student: s.status for s in store.submissions()}
    assert status == {f"s{k}": "failed" if k == 3 else "graded" for k in range(8)}
    tried = [student for _, student in log(tmp_path)]
    assert sorted(tried) == sorted([f"s{k}" for k in range(8)] + ["s3"])


def test_workers_that_end_as_soon_as_they_start_end_the_run(exercises):
    works = [Work(k, f"{k}.ipynb", "x", json.dumps(notebook("a")).encode()) for k in range(9)]
    graded = []
    with pytest.raises(DHError, match="end as soon as they start"), Pool(Settings(), 1, sys.exit) as pool:
        graded.extend(pool.grade(works))
    assert [each.status for each in graded] == ["failed"]


def test_a_worker_that_takes_too_long_is_ended_and_its_notebook_given_up(exercises, monkeypatch):
    monkeypatch.setattr("dhlib.grading.batch.pool.EXTRA_SECONDS", -1e6)
    work = Work(7, "tiny.ipynb", "x", json.dumps(notebook("a")).encode())
    with Pool(Settings(exercises=exercises, unsafe=True), 1) as pool:
        (given_up,) = pool.grade([work])
    assert (given_up.number, given_up.status) == (7, "failed")
    assert "The process that graded it ended, 2 times." in given_up.message


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks into /proc")
def test_killed_again_and_again_nothing_is_lost_and_nothing_graded_twice(hand_in, exercises, tmp_path):
    students = {f"s{k:02}" for k in range(KILLS + 10)}
    for student in students:
        hand_in(f"{student}/tiny.ipynb", "a")
    draw = random.Random(5)
    deaths_at_work = 0
    stored = {}
    for _ in range(KILLS):
        before, noted = dict(stored), len(log(tmp_path))
        process = subprocess.Popen(command(tmp_path, 1), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        started, begun = time.monotonic(), draw.choice([0, 1, 1, 2])
        while len(log(tmp_path)) < noted + begun and time.monotonic() < started + 30:
            time.sleep(0.003)
        time.sleep(draw.uniform(0.0, 0.03 if begun else 0.5))
        process.send_signal(signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
        if (tmp_path / "out" / "results.sqlite").exists():
            with Store(tmp_path / "out", create=True) as store:
                submissions = store.submissions()
                assert all(len(store.marks(s.id)) == 1 for s in submissions)
            stored = {s.student: dataclasses.astuple(s) for s in submissions}
        assert before.items() <= stored.items()  # nothing that was there changed or went
        now = [student for _, student in log(tmp_path)[noted:]]
        assert not before.keys() & set(now)  # nothing that was there was graded again
        deaths_at_work += bool(now)
    assert deaths_at_work > KILLS * 0.4
    assert len(stored) < len(students)
    done = subprocess.run(command(tmp_path, 2), capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    with Store(tmp_path / "out") as store:
        final = store.submissions()
    assert {s.student for s in final} == students
    assert len(final) == len(students)
    assert all(s.points == 2 for s in final)
    end = time.monotonic() + 20
    while (left := {pid for pid, _ in log(tmp_path) if alive(pid)}) and time.monotonic() < end:
        time.sleep(0.1)
    assert not left  # workers go when their controller is killed
