"""A notebook is over no later than a second after its time, whatever the box does: with a clock that is played."""

import io
import json
import os
import socket
from types import SimpleNamespace

import pytest

from dhlib.errors import DHError
from dhlib.grading.notebook import Cell
from dhlib.grading.wall import Limits, sandbox
from dhlib.grading.wall.sandbox import BROKEN, STOPPED, Crashed, Run

LIMITS = Limits(cell_seconds=3.0, notebook_seconds=9.0)
LATEST = LIMITS.notebook_seconds + 1
CELLS = [Cell("A = 1", role="answer", part="A"), Cell("", role="check", part="A")]


class Played:
    """A clock that only waiting moves, and a box that says what it is asked to."""

    def __init__(self, monkeypatch, says=None, obeys=False):
        self.now, self.says, self.obeys = 0.0, says, obeys
        ours, self.theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        answers, self.answers = os.pipe()
        notices, self.notices = os.pipe()
        os.set_blocking(answers, False)
        os.set_blocking(notices, False)
        self.box = SimpleNamespace(control=ours, jobs=1, watched=False)
        self.run = Run(self.box, CELLS, LIMITS, care=False)
        self.run.answers, self.run.notices = answers, notices
        self.run.heard = {answers: b"", notices: b""}
        monkeypatch.setattr(sandbox.time, "monotonic", lambda: self.now)
        monkeypatch.setattr(sandbox.select, "select", self.wait)

    def wait(self, reading, _writing, _errors, seconds):
        assert seconds >= 0
        if self.says:
            os.write(self.answers, self.says)
            self.now += min(seconds, 0.05)
            return [self.run.answers], [], []
        self.now += seconds
        if self.obeys and self.run.ended:
            os.close(self.answers)
            os.close(self.notices)
            self.theirs.send(json.dumps({"ended": 1}).encode())
            return [self.box.control.fileno()], [], []
        return [], [], []

    def converse(self):
        nothing_to_send = io.BytesIO()
        nothing_to_send.close()
        self.run._converse(memoryview(b""), nothing_to_send, LIMITS.notebook_seconds)
        return self.run.outcome.note


TOLD = STOPPED.format(seconds=LIMITS.notebook_seconds)


def test_a_box_that_obeys_is_heard_to_its_end(monkeypatch):
    played = Played(monkeypatch, obeys=True)
    assert played.converse() == TOLD
    assert played.theirs.recv(100) == b"end 1"
    assert LIMITS.notebook_seconds <= played.now <= LATEST


@pytest.mark.parametrize("says", [None, b'{"part": "A", "reading": {"values": [1]}}\n'], ids=["silent", "talking"])
def test_a_box_that_does_not_obey_is_given_up(monkeypatch, says):
    played = Played(monkeypatch, says)
    with pytest.raises(Crashed):
        played.converse()
    assert played.run.outcome.note == TOLD
    assert played.now <= LATEST


def test_a_box_that_ends_another_notebook_is_given_up(monkeypatch):
    played = Played(monkeypatch, obeys=True)
    played.box.jobs = 2
    with pytest.raises(Crashed):
        played.converse()


def test_a_box_that_cannot_be_set_up_ends_the_class_in_a_sentence(monkeypatch):
    played = Played(monkeypatch)
    os.write(played.notices, b'{"what": 3}\n{"done": true}\n{"failed": "no room"}\n')
    with pytest.raises(DHError, match="a box for the notebook could not be set up: no room"):
        played.run._hear(played.run.notices)
    assert played.run.finished


def test_more_patience_would_be_too_late(monkeypatch):
    """Negative control."""
    monkeypatch.setattr(sandbox, "END_SECONDS", 2.0)
    played = Played(monkeypatch)
    with pytest.raises(Crashed):
        played.converse()
    assert played.now > LATEST


def test_a_notebook_that_breaks_its_box_has_no_second_time(monkeypatch):
    """A box is built anew within the notebook's time, not for another time."""
    now, started = [0.0], []

    class Broken:
        def __init__(self, *_):
            started.append(now[0])

        def warm(self, libraries):
            pass

        def close(self):
            pass

    def run(_self, _job, deadline):
        now[0] = deadline + 0.1
        raise Crashed

    monkeypatch.setattr(sandbox.time, "monotonic", lambda: now[0])
    monkeypatch.setattr(sandbox, "Box", Broken)
    monkeypatch.setattr(sandbox.Run, "run", run)
    box = sandbox.Sandbox(LIMITS, unsafe=True)
    box._outer = SimpleNamespace(name="played")
    assert box.run(CELLS, {}).note == BROKEN
    assert started == [0.0]
    assert now[0] <= LATEST
