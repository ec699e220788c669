"""The file of results: what is in it stays, and whatever goes wrong is said in a sentence."""

import collections
import dataclasses
import sqlite3

import pytest

from dhlib.errors import DHError
from dhlib.grading.batch import schema
from dhlib.grading.batch.store import FILE, Certainty, MarkRow, Problem, Store, Submission

ADA = Submission(
    exercise="quickshot",
    student="1815",
    name="Ada Lovelace",
    certainty=Certainty.PLACE,
    place="Ada Lovelace_1815_assignsubmission_file_",
    source="Ada Lovelace_1815_assignsubmission_file_/quickshot.ipynb",
    sha256="aa",
    status="graded",
    points=3,
    out_of=30,
    submitted="2026-11-02T10:00:00+00:00",
)
MARKS = [
    MarkRow(part="A1", title="First link", points=1, out_of=1, verdict="right", answer='{"values": [1.5]}'),
    MarkRow(part="T4", points=0, out_of=2, verdict="wrong", message="Twist the other way.", misconception="twist_sign"),
]


@pytest.fixture
def store(tmp_path):
    with Store(tmp_path, create=True) as opened:
        yield opened


def test_what_was_kept_comes_back(store, tmp_path):
    number = store.add(ADA, MARKS, [Problem(ADA.source, "Its metadata names somebody else.", ("ada", "bob"))])
    store.set_meta("seed", "7")
    store.log("adjusted", "1815", "one point more")
    store.close()
    with Store(tmp_path) as again:
        assert again.submission(number) == dataclasses.replace(ADA, id=number)
        assert again.submissions(counting=True) == again.submissions() == [again.submission(number)]
        assert again.marks(number) == MARKS
        assert again.marks(number)[0].reading == {"values": [1.5]}
        assert [(s.student, s.name, s.submissions) for s in again.students()] == [("1815", "Ada Lovelace", 1)]
        assert again.problems() == [
            Problem(ADA.source, "Its metadata names somebody else.", ("ada", "bob"), number),
        ]
        assert again.meta("seed") == "7"
        assert again.meta("nothing", "else") == "else"
        assert [(e.what, e.student, e.details) for e in again.events()] == [("adjusted", "1815", "one point more")]


def test_a_submission_that_is_not_there_is_said(store):
    number = store.add(ADA)
    with pytest.raises(DHError, match=f"holds no submission {number + 1}"):
        store.submission(number + 1)


def test_what_is_known_already_is_not_put_on_record(store):
    number = store.add(ADA)
    store.identify(store.submission(number))
    store.identify(dataclasses.replace(store.submission(number), name="Ada King"))
    assert store.submission(number).name == "Ada King"
    assert store.events() == []
    store.identify(dataclasses.replace(store.submission(number), student="s1"))
    (event,) = store.events()
    assert (event.what, event.student, event.details) == ("told anew", "s1", f"{ADA.source}: was 1815")


def test_the_last_attempt_counts_in_whatever_order_they_are_graded(store):
    late = dataclasses.replace(ADA, source="b.ipynb", sha256="bb", submitted="2026-11-03T10:00:00+00:00")
    store.add(late)
    store.add(ADA)
    assert [(s.sha256, s.attempt, s.counts) for s in store.submissions()] == [("aa", 1, False), ("bb", 2, True)]


def test_numbers_of_the_platform_come_before_dates(store):
    store.add(dataclasses.replace(ADA, sha256="aa", sequence=2))
    store.add(dataclasses.replace(ADA, sha256="bb", sequence=1, submitted="2026-12-01T00:00:00+00:00"))
    assert {s.sha256: s.counts for s in store.submissions()} == {"aa": True, "bb": False}


def test_metadata_never_outranks_a_folder(store):
    impostor = dataclasses.replace(
        ADA, certainty=Certainty.METADATA, source="x.ipynb", place="x.ipynb", sha256="bb", submitted="2027"
    )
    store.add(ADA)
    store.add(impostor)
    assert [s.sha256 for s in store.submissions(counting=True)] == ["aa"]


def test_two_files_that_only_say_so_themselves_count_for_nobody(store):
    claim = dataclasses.replace(ADA, certainty=Certainty.METADATA, source="x.ipynb")
    store.add(claim)
    assert len(store.submissions(counting=True)) == 1
    store.add(dataclasses.replace(claim, source="y.ipynb"))
    assert store.submissions(counting=True) == []
    assert len(store.submissions()) == 2


def test_unknown_students_all_count(store):
    nobody = dataclasses.replace(ADA, student="", certainty=Certainty.NOBODY)
    store.add(dataclasses.replace(nobody, source="x.ipynb"))
    store.add(dataclasses.replace(nobody, source="y.ipynb"))
    assert len(store.submissions(counting=True)) == 2
    assert store.students() == []


def test_grading_again_keeps_the_number_and_is_on_record(store):
    number = store.add(ADA, MARKS, [Problem("x", "something")])
    assert store.add(dataclasses.replace(ADA, points=5), MARKS[:1]) == number
    assert store.submission(number).points == 5
    assert store.marks(number) == MARKS[:1]
    assert store.problems() == []
    assert store.events()[0].details == f"{ADA.source}: 5 of 30, was 3 of 30 points"


def test_a_failing_transaction_leaves_nothing(store):
    doubled = [*MARKS, dataclasses.replace(MARKS[0], part=None)]
    with pytest.raises(DHError):
        store.add(ADA, doubled)
    assert store.submissions() == []
    store.add(ADA, MARKS)
    assert len(store.submissions()) == 1


def test_a_full_disk_is_said_and_nothing_is_lost(store, tmp_path):
    store.add(ADA, MARKS)
    store.query("PRAGMA max_page_count = 20")
    large = (dataclasses.replace(ADA, sha256=f"{k}", message="x" * 1000) for k in range(1000))
    with pytest.raises(DHError, match=r"disk is full.*same command again"):
        collections.deque((store.add(submission, MARKS) for submission in large), maxlen=0)
    kept = store.submissions()
    store.close()
    with Store(tmp_path) as again:
        assert again.submissions() == kept
        assert again.marks(1) == MARKS


def test_a_missing_file_is_said(tmp_path):
    with pytest.raises(DHError, match=r"no results in .*dhlib grade"):
        Store(tmp_path)


def test_a_folder_that_may_not_be_written_or_is_not_there_is_said(tmp_path):
    with pytest.raises(DHError, match="cannot be opened"):
        Store(tmp_path / "nowhere" / FILE, create=True)


@pytest.mark.parametrize("content", [b"%PDF-1.7 and so on, longer than a header of SQLite would be " * 20, b"x"])
def test_a_file_that_is_no_database_is_left_alone(tmp_path, content):
    (tmp_path / FILE).write_bytes(content)
    with pytest.raises(DHError, match="no file of results"):
        Store(tmp_path, create=True)
    assert (tmp_path / FILE).read_bytes() == content


def test_the_database_of_another_program_is_left_alone(tmp_path):
    with sqlite3.connect(tmp_path / FILE) as other:
        other.execute("CREATE TABLE songs (title)")
    with pytest.raises(DHError, match="not written by dhlib"):
        Store(tmp_path, create=True)
    assert sqlite3.connect(tmp_path / FILE).execute("SELECT name FROM sqlite_master").fetchall() == [("songs",)]


def test_a_newer_file_is_said(store, tmp_path):
    store.query("PRAGMA user_version = 99")
    store.close()
    with pytest.raises(DHError, match=r"newer dhlib \(version 99 .*update dhlib"):
        Store(tmp_path)


def test_an_older_file_is_brought_up_to_date(store, tmp_path, monkeypatch):
    store.add(ADA, MARKS)
    store.close()
    more = (*schema.MIGRATIONS, "CREATE TABLE note (text TEXT);\nINSERT INTO note VALUES ('a;b');\n")
    monkeypatch.setattr("dhlib.grading.batch.store.MIGRATIONS", more)
    with Store(tmp_path) as again:
        assert again.query("SELECT text FROM note")[0][0] == "a;b"
        assert again.submissions()[0].points == 3


def test_a_migration_that_fails_leaves_the_old_file(store, tmp_path, monkeypatch):
    store.add(ADA, MARKS)
    store.close()
    before = sqlite3.connect(tmp_path / FILE).execute("PRAGMA user_version").fetchone()
    monkeypatch.setattr("dhlib.grading.batch.store.MIGRATIONS", (*schema.MIGRATIONS, "CREATE TABLE a (x);\nNONSENSE;"))
    with pytest.raises(DHError, match="cannot be used"):
        Store(tmp_path)
    db = sqlite3.connect(tmp_path / FILE)
    assert db.execute("PRAGMA user_version").fetchone() == before
    assert db.execute("SELECT count(*) FROM sqlite_master WHERE name = 'a'").fetchone() == (0,)


def test_somebody_else_who_writes_is_said(store, tmp_path, monkeypatch):
    monkeypatch.setattr("dhlib.grading.batch.store.PATIENCE", 0.05)
    with Store(tmp_path) as second, store.transaction(), pytest.raises(DHError, match="another program writes"):
        second.add(ADA)


def test_removing_a_submission_removes_all_of_it(store):
    number = store.add(ADA, MARKS, [Problem("x", "something")])
    with store.transaction() as db:
        db.execute("DELETE FROM submission WHERE id = ?", (number,))
    assert store.query("SELECT * FROM mark") == store.problems() == []
