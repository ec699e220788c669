"""The corpus of attacks (no modules, lest anything import them): each earns what it deserves and harms nobody else.

An attack stands in the answer to part A (or f) of a notebook whose other answers are right. Its file says what it tries
and which parts deserve their points. A is never right: its reference is a number drawn for this session, which stands
in three files outside the box and nowhere in it.
"""

import json
import os
import random
import re
import socket
import threading
import time
from pathlib import Path

import pytest

from dhlib.grading.grade import GRADED, grade_notebook
from dhlib.grading.wall import Limits
from dhlib.grading.wall.sandbox import HOW, STOPPED, descendants

ATTACKS = sorted((Path(__file__).parent / "attacks").glob("*.cell"))
LIMITS = Limits(cell_seconds=2.0, notebook_seconds=9.0, memory=256 << 20, processes=40, output_bytes=300_000)
POINTS = {"A": 3.0, "B": 2.0, "f": 5.0}
HONEST = {"A": "A = 3.0", "B": "B = 2.0", "f": "def f(i):\n    return i * i + 1"}
EXERCISE = """
from dhlib import robots
from dhlib.grading.exercise import Exercise, Part
from dhlib.grading.forms import Function, Numbers
secret = {secret}
EXERCISE = Exercise("victim", "The victim", robots.planar(1), [
    Part("A", "Secret", 3, Numbers(lambda arm, q: secret, shape=(), at=(0.0,))),
    Part("B", "Two", 2, Numbers(lambda arm, q: 2.0, shape=(), at=(0.0,))),
    Part("f", "Square", 5, Function(lambda arm, i: i * i + 1, shape=(), calls=[(k,) for k in (3, -7, 11, 19, 23)])),
])
"""
#: Attacks that do no harm to the machine where no wall stops them, and what each then achieves.
SUCCEED_WITHOUT_WALLS = {
    "read_reference": "A",
    "read_results": "A",
    "read_neighbour": "A",
    "read_modules": "A",
    "results_overwritten": "results",
    "socket_loopback": "packet",
    "socket_udp": "packet",
    "socket_unix": "packet",
    "socket_abstract": "packet",
}

#: Attacks that nothing ends but their limit of time.
ENDLESS = {
    "endless_iterator",
    "loop_in_c",
    "loop_plain",
    "loop_signals_off",
    "loop_swallowing",
    "output_endless",
    "regex_bomb",
    "sleep_for_ever",
    "third_probe_hangs",
    "third_probe_hangs_stubbornly",
}


class Heard:
    """A sandbox, and what came of its last notebook under which limits."""

    def __init__(self, sandbox):
        self.sandbox = sandbox

    def run(self, cells, requests, limits=None):
        self.limits = limits
        self.outcome = self.sandbox.run(cells, requests, limits)
        return self.outcome


class World:
    """What stands outside: the exercise with its secret, results, another student's notebook, servers that listen."""

    def __init__(self, folder, sandbox):
        self.sandbox = sandbox
        self.heard = Heard(sandbox)
        self.folder = folder
        self.secret = round(random.SystemRandom().uniform(0.6, 0.9), 12)
        self.exercises = folder / "exercises"
        self.exercises.mkdir()
        (self.exercises / "victim.py").write_text(EXERCISE.format(secret=self.secret), encoding="utf-8")
        (self.exercises / "victim.ipynb").write_text(json.dumps(notebook({})), encoding="utf-8")
        self.results, self.neighbour = folder / "results", folder / "neighbour.ipynb"
        self.neighbour.write_text(f"# secret = {self.secret}", encoding="utf-8")
        self.packets = []
        self.sockets = []
        self.placed = {
            "REFERENCE_FILE": str(self.exercises / "victim.py"),
            "RESULTS_FILE": str(self.results),
            "NEIGHBOUR_FILE": str(self.neighbour),
            "SOCKET_FILE": str(folder / "socket"),
            "ABSTRACT": f"\0dhlib-attacks-{os.getpid()}-{id(self)}",
            "SERVER_PID": os.getpid(),
            "PORT": self.listen(socket.AF_INET, ("127.0.0.1", 0)),
        }
        self.listen(socket.AF_UNIX, self.placed["SOCKET_FILE"])
        self.listen(socket.AF_UNIX, self.placed["ABSTRACT"])
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        udp.bind(("127.0.0.1", self.placed["PORT"]))
        self.watch(udp, lambda: udp.recv(10))
        for path in [folder, *folder.rglob("*")]:  # readable for anybody: only walls keep them from being read
            path.chmod(0o777)
        self.reset()

    def listen(self, family, address):
        server = socket.socket(family)
        server.bind(address)
        server.listen()
        self.watch(server, server.accept)
        return server.getsockname()[1] if family == socket.AF_INET else None

    def watch(self, server, wait):
        def run():
            while True:
                try:
                    self.packets.append(wait())
                except OSError:
                    return

        self.sockets.append(server)
        threading.Thread(target=run, daemon=True).start()

    def reset(self):
        self.packets.clear()
        self.results.write_text(f"# secret = {self.secret}", encoding="utf-8")

    def grade(self, answers, limits=None, name="submission"):
        """Grade a notebook of a student who is called `name`."""
        path = self.folder / f"{name}.ipynb"
        path.write_text(json.dumps(notebook(answers)), encoding="utf-8")
        return grade_notebook(path, "victim", self.exercises, limits, sandbox=self.heard)

    def attack(self, path, limits=LIMITS):
        """Grade a notebook with an attack in it, and otherwise honest answers."""
        source = path.read_text(encoding="utf-8")
        for name, value in self.placed.items():
            source = re.sub(rf"\b{name}\b", lambda _, value=value: repr(value), source)
        part = re.search(r"^# In the answer to: (\w)", source, re.MULTILINE)
        return self.grade(HONEST | {part[1] if part else "A": source}, limits)

    def achieved(self, result):
        """What an attack may not achieve and did."""
        time.sleep(0.05)  # a packet takes a moment
        harm = set()
        if earned(result).get("A"):
            harm.add("A")
        if self.packets:
            harm.add("packet")
        if self.results.read_text(encoding="utf-8") != f"# secret = {self.secret}":
            harm.add("results")
        return harm

    def close(self):
        for server in self.sockets:
            server.close()


def notebook(answers):
    setup = "from dhlib.grading import checker\ncheck = checker('victim')"
    cells = [cell("setup", "", setup)]
    for part in POINTS:
        cells += [
            cell("answer", part, answers.get(part, f"{part} = ...")),
            cell("check", part, f'check("{part}", {part})'),
        ]
    return {"cells": cells, "metadata": {"dh": {"exercise": "victim"}}, "nbformat": 4, "nbformat_minor": 5}


def cell(role, part, source):
    about = {"role": role, "part": part}
    return {"cell_type": "code", "source": source, "metadata": {"dh": about}, "outputs": [], "execution_count": None}


def earned(result):
    return {mark.part: mark.points for mark in result.marks if mark.points}


def deserved(source):
    """The parts that an attack deserves, and whether it may also get less."""
    at_most = re.search(r"^# Deserves at most: (.+)$", source, re.MULTILINE)
    exactly = re.search(r"^# Deserves: (.+)$", source, re.MULTILINE)
    words = (at_most or exactly or [None, "B f"])[1]
    return {part: POINTS[part] for part in words.split() if part in POINTS}, bool(at_most)


def ended_by_its_limit(outcome):
    """Whether a limit of time is what ended a cell, the reading of an answer, or all of it; no clock is asked."""
    return (
        HOW["time"] in outcome.killers.values()
        or any(error.startswith("OutOfTime: ") for error in outcome.errors.values())
        or {"fault": "timeout"} in outcome.readings.values()
        or outcome.note == STOPPED.format(seconds=LIMITS.notebook_seconds)
    )


@pytest.fixture(scope="session")
def world(walls, tmp_path_factory):
    """The world of this process, with walls."""
    world = World(tmp_path_factory.mktemp("world"), walls)
    assert earned(world.grade(HONEST)) == {"B": 2.0, "f": 5.0}
    world.idle = len(descendants(walls._box.process.pid))
    yield world
    world.close()


@pytest.mark.sandbox
@pytest.mark.parametrize("path", ATTACKS, ids=lambda path: path.stem)
def test_an_attack_earns_what_it_deserves_and_costs_nobody_anything(world, path):
    world.reset()
    source = path.read_text(encoding="utf-8")
    before = sorted(p.name for p in world.folder.iterdir())
    result = world.attack(path)
    parts, or_less = deserved(source)
    got = earned(result)
    assert got == parts or (or_less and got.items() <= parts.items()), (got, result.message, result.marks)
    assert world.achieved(result) == set()
    assert world.heard.limits == LIMITS
    assert path.stem not in ENDLESS or ended_by_its_limit(world.heard.outcome), world.heard.outcome
    assert len(json.dumps([mark.message for mark in result.marks])) < 5000
    if box := world.sandbox._box:
        assert len(descendants(box.process.pid)) == world.idle, "a process is left"
    assert sorted({p.name for p in world.folder.iterdir()} - {"submission.ipynb"}) == sorted(
        set(before) - {"submission.ipynb"}
    )
    neighbour = world.grade(HONEST | {"A": f"A = 3.0  # NEIGHBOUR-WAS-HERE-{world.secret}"}, name="submission")
    assert (neighbour.status, earned(neighbour)) == (GRADED, {"B": 2.0, "f": 5.0})
    assert world.achieved(neighbour) == set()


@pytest.mark.sandbox
def test_memory_of_the_box_stayed_within_its_limit(world):
    """After the attacks that ran in this process, where a control group counts."""
    files = [folder / "memory.max_usage_in_bytes" for folder in world.sandbox._box.group.folders]
    for file in files:
        if file.exists():
            assert int(file.read_text()) <= world.sandbox.limits.memory + (512 << 20)


@pytest.mark.parametrize("name", SUCCEED_WITHOUT_WALLS)
def test_without_walls_an_attack_succeeds(no_walls, tmp_path, name):
    """Negative control: what the walls stop is not stopped by anything else."""
    world = World(tmp_path, no_walls)
    result = world.attack(Path(__file__).parent / "attacks" / f"{name}.cell", Limits.of(60))
    if name == "read_modules":  # the reference is where the student's code finds it, if it knows where to look
        result = world.grade({"A": f"import os\nos.chdir({str(tmp_path)!r})\n" + (
            Path(__file__).parent / "attacks" / f"{name}.cell").read_text(encoding="utf-8")})  # fmt: skip
    assert SUCCEED_WITHOUT_WALLS[name] in world.achieved(result)
    world.close()


@pytest.mark.sandbox
@pytest.mark.parametrize("name", ["abort", "exit_at_once", "evil_error", "nan"])
def test_what_ends_otherwise_is_not_taken_for_ended_by_its_limit(world, name):
    """Negative control."""
    world.attack(Path(__file__).parent / "attacks" / f"{name}.cell")
    assert not ended_by_its_limit(world.heard.outcome)


def test_the_corpus_is_as_large_as_it_says():
    assert len(ATTACKS) >= 100
    assert {path.stem for path in ATTACKS} >= ENDLESS
    assert {"loop_swallowing", "memory_list", "fork_bomb", "kill_parent", "read_results", "guess_probes"} <= {
        path.stem for path in ATTACKS
    }
    for path in ATTACKS:
        assert path.read_text(encoding="utf-8").startswith("# Tries: to ")
