"""What Python seals, JavaScript opens: with the right answer, with each foreseen one, and with nothing else."""

from __future__ import annotations

import base64
import json
import math
import random
import subprocess
from pathlib import Path
from typing import Any

import pytest
import sealing
from formulas import node_program

HERE = Path(__file__).parent
WEB = HERE.parent.parent / "book/web"
NO_SUBTLE = None
BY_BROWSER = "browser"


def ask(module: str, calls: list[list[Any]]) -> list[Any]:
    asked = subprocess.run(
        [node_program(), str(HERE / "answer.mjs"), str(WEB / module)],
        input=json.dumps(calls),
        stdout=subprocess.PIPE,
        encoding="utf-8",
        check=True,
    )
    answers: list[Any] = json.loads(asked.stdout)
    return answers


def numbers(right: list[float], *wrong: list[float], decimals: int = 3, periods: Any = None) -> dict[str, Any]:
    answers = [{"right": k == 0, "value": list(value), "says": f"words {k}"} for k, value in enumerate([right, *wrong])]
    return {
        "kind": "number",
        "decimals": decimals,
        "unit": "",
        "periods": periods or [None] * len(right),
        "answers": answers,
    }


QUESTIONS = {
    "number": numbers([0.4318], [0.1501], [431.8], [-0.4318]),
    "on a rounding border": numbers([0.1235], [0.0005]),
    "zero and whole": numbers([0.0, 1.0, -1.0], [1.0, 0.0, -1.0], decimals=0),
    "large": numbers([123456.789], [-123456.789], decimals=3),
    "matrix": numbers(
        [math.cos(0.3), -math.sin(0.3), math.sin(0.3), math.cos(0.3)],
        [math.cos(0.3), math.sin(0.3), -math.sin(0.3), math.cos(0.3)],
    ),
    "angle": numbers([-179.8, 20.0], [90.0, 20.0], decimals=1, periods=[360, None]),
    "neighbours": numbers([0.500], [0.502], [0.504], [0.506]),
}


@pytest.fixture(scope="module", autouse=True)
def quick() -> Any:
    """Fewer rounds than the book has: what is tested here does not depend on them."""
    rounds, sealing.ROUNDS = sealing.ROUNDS, 1000
    yield
    sealing.ROUNDS = rounds


@pytest.mark.parametrize("name", QUESTIONS)
@pytest.mark.parametrize("subtle", [{}, {"subtle": NO_SUBTLE}], ids=["browser", "library"])
def test_each_foreseen_answer_opens_its_record(name: str, subtle: dict[str, Any]) -> None:
    question = QUESTIONS[name]
    sealed = sealing.seal(question, f"page {name}")
    within = sealing.tolerance(question["decimals"])
    turns = [0 if period is None else period for period in question["periods"]]
    calls, expected = [], []
    rng = random.Random(1955)
    for answer in question["answers"]:
        exact = answer["value"]
        rounded = [round(value, question["decimals"]) for value in exact]
        edges = [[value + side * 0.99999 * within for value in exact] for side in (-1, 1)]
        turned = [value + rng.choice([-2, -1, 1]) * turn for value, turn in zip(exact, turns, strict=True)]
        for entered in (exact, rounded, *edges, turned):
            calls.append(["foreseen", sealed, entered, *subtle.values()])
            expected.append({"right": answer["right"], "says": answer["says"]})
    assert ask("sealing.js", calls) == expected


@pytest.mark.parametrize("name", QUESTIONS)
def test_nothing_else_opens_one(name: str) -> None:
    question = QUESTIONS[name]
    sealed = sealing.seal(question, f"page {name}")
    within = sealing.tolerance(question["decimals"])
    right = question["answers"][0]["value"]
    beyond = [[value + side * 1.001 * within for value in right] for side in (-1, 1)]
    far = [[value + 57.0 * within * 2 for value in right], [-value - 3.3 for value in right]]
    answers = ask("sealing.js", [["foreseen", sealed, entered] for entered in beyond + far])
    known = [answer["value"] for answer in question["answers"]]
    assert all(entered not in known for entered in far)
    assert answers[2:] == [None, None]
    assert all(answer in (None, {"near": True}) for answer in answers[:2]), "one step beyond the digits is not right"


def test_choices() -> None:
    answers = [
        {"right": True, "value": [1, 3], "says": "both"},
        {"right": False, "value": [1], "says": "one more"},
    ]
    sealed = sealing.seal({"kind": "choice", "several": True, "answers": answers}, "page")
    calls = [["foreseen", sealed, chosen] for chosen in ([1, 3], [1], [3], [1, 2, 3])]
    told = ask("sealing.js", calls)
    assert told == [{"right": True, "says": "both"}, {"right": False, "says": "one more"}, None, None]


def test_records_tell_nothing_by_length_or_order() -> None:
    question = numbers([1.0], [2.0], [3.0])
    question["answers"][0]["says"] = "much longer than what the others say"
    records = sealing.seal(question, "page")["records"]
    assert len({len(base64.b64decode(record)) for record in records}) == 1
    assert records == sorted(records)


def test_the_same_question_is_sealed_in_the_same_way() -> None:
    question = QUESTIONS["matrix"]
    assert sealing.seal(question, "page") == sealing.seal(question, "page")
    assert sealing.seal(question, "page")["salt"] != sealing.seal(question, "other")["salt"]


def test_cuts_stand_clear() -> None:
    rng = random.Random(7)
    for _ in range(200):
        values = [rng.choice([rng.uniform(-2, 2), rng.uniform(-1e4, 1e4)]) for _ in range(12)]
        lines = sealing.cuts([values], 3, [None], "seed")
        within = sealing.tolerance(3)
        assert all(sealing.is_clear(v, lines["starts"][0], lines["width"], None, within) for v in values)


def test_a_cut_through_an_answer_would_be_found() -> None:
    assert not sealing.is_clear(0.5, 0.5, 1.0, None, 0.001)


def test_the_book_takes_its_time() -> None:
    source = (HERE.parent.parent / "book/extensions/sealing.py").read_text("utf-8")
    assert "ROUNDS = 20_000" in source


def test_keys_are_the_same_whenever_they_were_begun(tmp_path: Path) -> None:
    words, salt = ["1,2", "3", "4"], b"salt"
    at_once = sealing.Keys(tmp_path / "keys.json")
    early = sealing.Keys()
    early.begin(words, salt)
    assert early.of(words, salt) == at_once.of(words, salt) == [sealing.derive(word, salt) for word in words]
    assert early.of(["1,2"], b"other") != early.of(["1,2"], salt)
    at_once.save()
    later = sealing.Keys(tmp_path / "keys.json")
    later.begin(words, salt)
    assert not later.begun
    assert later.of(words, salt) == early.of(words, salt)


READ = {
    ("0.25", ""): 0.25,
    ("0,25", ""): 0.25,
    (" .5 ", ""): 0.5,
    ("−3/4", ""): -0.75,
    ("-3", ""): -3,
    ("1e-3", ""): 0.001,
    ("2π/3", "rad"): 2 * math.pi / 3,
    ("2*pi", "rad"): 2 * math.pi,
    ("√3/2", ""): math.sqrt(3) / 2,
    ("sqrt(3)/2", ""): math.sqrt(3) / 2,
    ("-sqrt(1/2)", ""): -math.sqrt(0.5),
    ("cos(30°)", ""): math.cos(math.pi / 6),
    ("cos(pi/6)", "m"): math.cos(math.pi / 6),
    ("90°", "°"): 90,
    ("-90 degrees", "°"): -90,
    ("90°", "rad"): math.pi / 2,
    ("0.4 m", "m"): 0.4,
    ("160mm", "mm"): 160,
    ("3(1 + 2)", ""): 9,
}


def test_numbers_are_read_as_people_write_them() -> None:
    read = ask("entries.js", [["read", *given] for given in READ])
    for given, value, expected in zip(READ, read, READ.values(), strict=True):
        assert value == pytest.approx(expected, abs=1e-15), given


@pytest.mark.parametrize(
    ("text", "unit", "said"),
    [
        ("", "", "Nothing stands here"),
        ("about two", "", "Write a number"),
        ("1/0", "", "no finite number"),
        ("(1 + 2", "", "does not read"),
        ("1 2", "", "does not read"),
        ("3/", "", "does not read"),
        ("1.234,5", "", "one decimal point"),
        ("90°", "m", "asked for in m"),
        ("90°", "", "no angle"),
        ("432 mm", "m", "asked for in m"),
        ("constructor", "", "Write a number"),
    ],
)
def test_what_is_no_number_is_said_to_be_none(text: str, unit: str, said: str) -> None:
    script = f"""
        import {{ read }} from {json.dumps((WEB / "entries.js").as_uri())};
        try {{ console.log("read", read({json.dumps(text)}, {json.dumps(unit)})); }}
        catch (fault) {{ console.log(fault.constructor.name, fault.message); }}"""
    done = subprocess.run(
        [node_program(), "--input-type=module", "-e", script], capture_output=True, encoding="utf-8", check=True
    )
    assert done.stdout.startswith("NoNumber ")
    assert said in done.stdout
