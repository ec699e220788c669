"""Results of several machines, brought together."""

import dataclasses

import pytest

from dhlib.cli import main
from dhlib.errors import DHError
from dhlib.grading.batch.merge import merge
from dhlib.grading.batch.store import Certainty, MarkRow, Problem, Store, Submission

ADA = Submission(
    exercise="quickshot",
    student="ada",
    name="Ada",
    certainty=Certainty.PLACE,
    place="class/ada",
    source="ada/quickshot.ipynb",
    sha256="aa",
    status="graded",
    points=1,
    out_of=2,
    graded_at="2026-11-02",
)
BOB = dataclasses.replace(ADA, student="bob", name="Bob", place="class/bob", source="bob/quickshot.ipynb")
MARKS = [MarkRow(part="A1", points=1, out_of=2, verdict="nearly")]


@pytest.fixture
def parts(tmp_path):
    for name, submissions in (("one", [ADA]), ("two", [BOB])):
        (tmp_path / name).mkdir()
        with Store(tmp_path / name, create=True) as store:
            for submission in submissions:
                store.add(submission, MARKS)
            store.replace_problems([Problem("dora", "The folder is empty.", ("dora",))])
            store.log("adjusted", "ada", "one point more")
    return [tmp_path / "one", tmp_path / "two"]


def test_all_of_both_is_there_and_twice_is_as_once(parts, tmp_path):
    assert merge(parts, tmp_path / "all") == 2
    assert merge(parts, tmp_path / "all") == 0
    with Store(tmp_path / "all") as store:
        assert [s.source for s in store.submissions()] == [ADA.source, BOB.source]
        assert [store.marks(s.id) for s in store.submissions()] == [MARKS, MARKS]
        assert store.problems() == [Problem("dora", "The folder is empty.", ("dora",))]
        assert len(store.events()) == 2  # one of each part, and no more after the second time


def test_the_mark_that_was_given_last_stays(parts, tmp_path):
    merge(parts, tmp_path / "all")
    with Store(parts[0]) as store:
        store.add(dataclasses.replace(ADA, points=2, graded_at="2026-11-03"))
    with Store(parts[1]) as store:
        store.add(dataclasses.replace(ADA, points=0, graded_at="2026-11-01"))
    assert merge(parts, tmp_path / "all") == 1
    with Store(tmp_path / "all") as store:
        assert store.submissions()[0].points == 2


def test_who_is_claimed_twice_shows_when_all_are_together(parts, tmp_path):
    with Store(parts[1]) as store:
        store.add(dataclasses.replace(ADA, source="x/quickshot.ipynb", place="other/ada", sha256="bb"))
    merge(parts, tmp_path / "all")
    with Store(tmp_path / "all") as store:
        assert any("are all said to be of ada" in problem.what for problem in store.problems())


def test_results_may_be_merged_into_one_of_the_parts(parts):
    assert merge(parts, parts[0]) == 1
    with Store(parts[0]) as store:
        assert [s.source for s in store.submissions()] == [ADA.source, BOB.source]


def test_a_part_that_is_none_changes_nothing(parts, tmp_path):
    with pytest.raises(DHError, match="no results in"):
        merge([*parts, tmp_path], tmp_path / "all")
    assert not (tmp_path / "all").exists()


def test_the_command(parts, tmp_path, capsys):
    assert main(["merge", *map(str, parts), "--out", str(tmp_path / "all")]) == 0
    assert "2 taken, 2 in all" in capsys.readouterr().out
    assert (tmp_path / "all" / "grades.csv").is_file()
    assert main(["merge", str(tmp_path / "nothing"), "--out", str(tmp_path / "all")]) == 2
    (tmp_path / "file").write_text("x")
    assert main(["merge", *map(str, parts), "--out", str(tmp_path / "file")]) == 2
    assert "file is a file; --out names a folder." in capsys.readouterr().err
