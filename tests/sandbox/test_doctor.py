"""``dhlib grade --doctor``: all that should fail fails behind the walls, and does not without them."""

import io
from dataclasses import replace
from types import SimpleNamespace

import pytest

from dhlib.cli import main
from dhlib.errors import DHError
from dhlib.grading.wall import Limits, Outcome, Sandbox, doctor

#: Probes that change nothing on this machine where no wall stops them. The others would take memory and processes.
HARMLESS_WITHOUT_WALLS = (
    "a secret file of yours cannot be read",
    "nothing is written outside",
    "no network: loopback",
    "no network: UDP",
    "no socket of this machine: abstract names",
    "no socket of this machine: files",
    "no process outside is seen",
    "no process outside is signalled",
    "no other program is started",
    "no other identity than nobody's",
)


@pytest.mark.sandbox
def test_every_wall_stands_here(walls, capsys):
    with pytest.raises(SystemExit) as left:
        main(["grade", "--doctor"])
    said = capsys.readouterr().out
    assert left.value.code == 0, said
    assert "✘" not in said
    assert said.count("✔") > len(doctor.PROBES)
    assert "Strangers' notebooks may be graded here." in said


def test_the_same_probes_come_through_where_there_is_no_wall(monkeypatch):
    """Negative control."""
    probes = [probe for probe in doctor.PROBES if probe.wall in HARMLESS_WITHOUT_WALLS]
    assert len(probes) == len(HARMLESS_WITHOUT_WALLS)
    monkeypatch.setattr(doctor, "PROBES", probes)
    with Sandbox(Limits.of(60), unsafe=True) as sandbox:
        found = {wall: held for wall, held, _ in doctor.probe(sandbox)}
    assert [wall for wall in HARMLESS_WITHOUT_WALLS if found[wall]] == []


@pytest.mark.sandbox
def test_what_only_ran_out_of_time_or_met_no_limit_is_not_called_stopped(walls, monkeypatch):
    """Negative control: a limit of processes that is too wide, and an attack that gets nowhere and is not refused."""
    bounded = next(probe for probe in doctor.PROBES if probe.wall == "processes are bounded")
    slow = doctor.Probe("slow", "while True: pass")
    monkeypatch.setattr(doctor, "PROBES", (bounded, slow, replace(slow, wall="time", endless=True)))
    with Sandbox(replace(doctor.LIMITS, processes=3 * doctor.LIMITS.processes, cell_seconds=2.0)) as sandbox:
        found = {wall: (held, says) for wall, held, says in doctor.probe(sandbox)}
    assert found["processes are bounded"] == (False, "it came through ({'values': [1.0]})")
    assert found["slow"] == (False, doctor.LATE)
    assert found["time"] == (True, "")


class Played:
    """A sandbox that gives every notebook the same answer, after some time."""

    walls = "played"

    def __init__(self, answer, seconds=0.0):
        self.answer, self.seconds, self.now = answer, seconds, 0.0

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def run(self, cells, requests):
        self.now += self.seconds
        return Outcome({"A": {"values": [self.answer]}})

    def extras(self):
        return [("Landlock", False, "mounts alone keep files apart")]


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (7.0, "✘ an honest cell does not run: {'A': {'values': [7.0]}}\n"),
        (2.0, "✘ A wall does not hold: do not grade strangers' notebooks here, and report this, please.\n"),
    ],
)
def test_a_wall_that_does_not_hold_is_said_at_the_end(monkeypatch, answer, words):
    monkeypatch.setattr(doctor, "Sandbox", lambda _: Played(answer))
    out = io.StringIO()
    assert doctor.look(out) is False
    assert out.getvalue().endswith(words)
    assert "may be graded here" not in out.getvalue()
    if answer == 2.0:
        assert "– Landlock: mounts alone keep files apart" in out.getvalue()


def test_what_takes_longer_than_it_may_is_not_called_stopped(monkeypatch):
    slow = Played(0.0, seconds=doctor.LIMITS.notebook_seconds + 2)
    monkeypatch.setattr(doctor, "time", SimpleNamespace(monotonic=lambda: slow.now))
    monkeypatch.setattr(doctor, "PROBES", doctor.PROBES[:1])
    (_, held, says), _ = doctor.probe(slow)
    assert (held, says) == (False, f"it took {slow.seconds:.1f} s")


def test_a_machine_without_walls_is_told_what_to_install(monkeypatch):
    def none():
        raise DHError("install bubblewrap.")

    monkeypatch.setattr("dhlib.grading.wall.sandbox.find_outer", none)
    out = io.StringIO()
    assert doctor.look(out) is False
    assert "✘ no sandbox. install bubblewrap." in out.getvalue()
