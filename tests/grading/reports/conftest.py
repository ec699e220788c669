"""A class whose marks come from the real checker, put into real results; nothing is run for it."""

from __future__ import annotations

import hashlib
import json
import random
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from dhlib.grading.answers import read_answer
from dhlib.grading.batch.rows import Certainty, MarkRow, Submission
from dhlib.grading.batch.store import Store
from dhlib.grading.exercise import load_exercise
from dhlib.grading.forms import Choice, Formula, Frames, Function, Table, Valued
from dhlib.grading.marking import Marker
from dhlib.grading.misconceptions import would_have_given

ROOT = Path(__file__).parents[3]
FIRST = ("Ada", "Björn", "Chloé", "Dmitri", "Emil", "Fatima", "Gül", "Hanna", "Inge", "Jörg", "Kim", "Léa", "Mia")
LAST = ("Lovelace", "Müller", "Nguyễn", "O'Brien", "Pérez", "Qureshi", "Rößler", "Sato", "Tóth", "Ünal", "Zając")


@cache
def exercise():
    return load_exercise("quickshot", ROOT / "exercises")


@cache
def right(part_id):
    """A right reading of each part."""
    part = exercise().part(part_id)
    match part.asks:
        case Choice(right=choice):
            return {"choice": choice}
        case Table():
            value = part.chain
        case Frames():
            value = part.chain.frames(np.zeros(part.chain.n))
        case Formula() | Function():
            return {"values": part.asks.values(part.chain).tolist()}
        case Valued():
            value = part.asks.values(part.chain)[0]
    return read_answer(part.asks.request(), value)


@cache
def slips(part_id):
    """Readings that known misconceptions lead to, each once."""
    return [{"values": told.tolist()} for _, told in would_have_given(exercise().part(part_id))]


def odd(part_id, chance):
    """A reading that is wrong in a way of its own."""
    part = exercise().part(part_id)
    if isinstance(part.asks, Choice):
        return {"choice": chance.choice([option for option in part.asks.options if option != part.asks.right])}
    reading = json.loads(json.dumps(right(part_id)))
    if "table" in reading:
        row = chance.randrange(len(reading["table"]["rows"]))
        reading["table"]["rows"][row][2] = round(chance.uniform(1, 90), 2)
        return reading
    values = np.array(reading["values"], dtype=float)
    flat = values.reshape(len(values), -1)
    flat[:, chance.randrange(flat.shape[1])] += round(chance.uniform(0.1, 3), 3)
    return {"values": values.tolist()}


def marked(readings):
    """The rows of the marks that the checker gives to some readings."""
    marks = Marker(exercise()).mark_all(readings)
    titles = {part.id: part.title for part in exercise().parts}
    return [
        MarkRow(
            part=m.part,
            title=titles[m.part],
            points=m.points,
            out_of=m.out_of,
            verdict=m.verdict,
            message=m.message,
            misconception=m.misconception,
            section=m.section,
            answer=json.dumps(readings.get(m.part, {"fault": "undefined"})),
        )
        for m in marks
    ]


def submission(student, name, source, rows=(), **other):
    """A submission with marks."""
    place = source.split("/")[0]
    values = {
        "exercise": "quickshot",
        "student": student,
        "name": name,
        "certainty": Certainty.PLACE,
        "source": source,
        "place": place,
        "sha256": hashlib.sha256(source.encode()).hexdigest(),
        "status": "graded",
        "points": sum(row.points for row in rows),
        "out_of": exercise().points,
        "graded_at": "2026-11-21T08:00:00+00:00",
        "submitted": "2026-11-20T21:00:00+00:00",
        "dhlib": "0.1",
        "seconds": 0.2,
    }
    return Submission(**values | other)


def hand_in(chance, skill):
    """Readings of somebody of some skill, 0 to 1."""
    favourite = chance.randrange(40)
    readings = {}
    for k, part in enumerate(exercise().parts):
        luck = chance.random() + 0.02 * k
        if luck < 0.25 + 0.75 * skill:
            readings[part.id] = right(part.id)
        elif luck > 1.05:
            readings[part.id] = {"fault": "missing"}
        elif (known := slips(part.id)) and chance.random() < 0.65:
            readings[part.id] = known[favourite % len(known)] if chance.random() < 0.5 else chance.choice(known)
        else:
            readings[part.id] = odd(part.id, chance)
    return readings


def fill(store, count, seed=7):
    """Put a class into some results: names, skills and slips come from the seed."""
    chance = random.Random(seed)
    for k in range(count):
        name = f"{FIRST[k % len(FIRST)]} {LAST[(3 * k) % len(LAST)]}"
        rows = marked(hand_in(chance, chance.betavariate(4, 2.5)))
        place = f"{name}_{1000 + k}_assignsubmission_file_"
        store.add(submission(str(1000 + k), name, f"{place}/quickshot.ipynb", rows), rows)


@pytest.fixture
def results(tmp_path):
    """Empty results."""
    with Store(tmp_path, create=True) as store:
        yield store


@pytest.fixture(scope="session")
def class_folder(tmp_path_factory):
    """The results of a class of 24, for tests that only read them."""
    folder = tmp_path_factory.mktemp("class")
    with Store(folder, create=True) as store:
        fill(store, 24)
    return folder
