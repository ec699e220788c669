"""A class list says who is who, and nobody is taken for somebody else."""

import pytest

from dhlib.grading.batch.people import People


@pytest.fixture
def people(tmp_path):
    def made(text, column=""):
        (tmp_path / "roster.csv").write_text(text, "utf-8")
        return People(tmp_path / "roster.csv", column)

    return made


LISTS = {
    "own": "id;last name;first name;github\ns1;Lovelace;Ada;ada-l\ns2;Müller;Bob;bobm\n",
    "moodle": "Identifier,Full name,Email address,ID number\n"
    "Participant 1815,Ada Lovelace,ada@example.org,s1\nParticipant 42,Bob Müller,bob@example.org,s2\n",
    "canvas": 'Student,ID,SIS Login ID,Section\n"Lovelace, Ada",1815,s1,A\n"Müller, Bob",42,s2,A\n',
}


@pytest.mark.parametrize("kind", LISTS)
@pytest.mark.parametrize("name", ["Ada Lovelace", "Lovelace, Ada", "LOVELACE ADA", "lovelaceada", "s1"])
def test_people_are_found_by_their_names(people, kind, name):
    found = people(LISTS[kind]).find([name])
    assert found is not None
    assert {word.strip(",") for word in found.name.split()} == {"Ada", "Lovelace"}


@pytest.mark.parametrize(("kind", "name"), [("own", "ada-l"), ("moodle", "1815"), ("canvas", "1815")])
def test_and_by_what_platforms_call_them(people, kind, name):
    assert "Ada" in people(LISTS[kind]).find([name]).name


def test_umlauts_are_compared_as_platforms_write_them(people):
    assert [people(LISTS["own"]).find([name]).id for name in ("mullerbob", "Mu\u0308ller Bob")] == ["s2", "s2"]


@pytest.mark.parametrize("name", ["Ada", "Mallory", "", "7", "A"])
def test_strangers_are_nobody(people, name):
    assert people("id,name,section,points\ns1,Ada Lovelace,A,7\ns2,Bob,A,8\n").find([name]) is None


def test_two_of_a_name_are_nobody_and_the_next_name_is_tried(people):
    roster = people("id,name\ns1,Ada Lovelace\ns2,Ada Lovelace\n")
    assert roster.find(["Ada Lovelace"]) is None
    assert roster.find(["Ada Lovelace", "s2"]).id == "s2"
