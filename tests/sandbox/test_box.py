"""The box itself: what is seen in it, how it starts anew, and what holds where a machine has less to offer."""

import io
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from dhlib.errors import DHError
from dhlib.grading.notebook import Cell
from dhlib.grading.wall import Limits, Sandbox, doctor, inner, outer, plain, sandbox, view
from dhlib.grading.wall import cells as keeping
from dhlib.grading.wall.sandbox import HOW, STARVED, descendants

REQUESTS = {"A": {"form": "numbers", "shape": []}}


def cells(source):
    return [Cell(source, role="answer", part="A"), Cell("", role="check", part="A")]


def value(outcome):
    return outcome.readings["A"].get("values", outcome.readings["A"])


@pytest.mark.sandbox
def test_a_box_that_was_killed_starts_anew(walls):
    assert value(walls.run(cells("A = 1"), REQUESTS)) == [1.0]
    server = descendants(walls._box.process.pid)[1]
    os.kill(server, signal.SIGKILL)
    assert value(walls.run(cells("A = 2"), REQUESTS)) == [2.0]
    assert server not in descendants(walls._box.process.pid)


@pytest.mark.sandbox
def test_nothing_is_left_when_a_sandbox_is_closed():
    with Sandbox() as sandbox_:
        sandbox_.run(cells("A = 1"), REQUESTS)
        pids, folders = descendants(sandbox_._box.process.pid), sandbox_._box.group.folders
    for _ in range(100):
        if not any(os.path.exists(f"/proc/{pid}") for pid in pids):
            break
        time.sleep(0.1)
    assert not any(os.path.exists(f"/proc/{pid}") for pid in pids)
    assert not any(folder.exists() for folder in folders)


#: Whether a library was there before the cell came, and whether it works.
THERE = {
    "sympy": "import sys\nA = 2.0 * ('sympy' in sys.modules)\nimport {spelt}\nA = A + float({spelt}.sqrt(1))",
    "matplotlib": "import sys\nA = 2.0 * ('matplotlib.pyplot' in sys.modules)\n"
    "plt = __import__('{spelt}.pyplot').pyplot\nplt.plot([0, 1]); A = A + len(plt.gcf().axes)",
}


@pytest.mark.sandbox
@pytest.mark.parametrize("name", THERE)
def test_a_box_imports_what_a_notebook_needs_before_its_time_begins(name):
    with Sandbox() as sandbox_:
        asked = "import sys; A = len({'sym' + 'py', 'matp' + 'lotlib'} & {*sys.modules})"  # which does not name them
        assert value(sandbox_.run(cells(asked), REQUESTS)) == [0.0]
        assert sandbox_._box.warmed == set()
        assert value(sandbox_.run(cells(THERE[name].format(spelt=name)), REQUESTS)) == [3.0]
        assert sandbox_._box.warmed == {name}
        assert value(sandbox_.run(cells(asked), REQUESTS)) == [1.0]  # and keeps it


@pytest.mark.sandbox
def test_what_is_needed_in_other_words_is_imported_within_the_time():
    hidden = "A = float(__import__('sym' + 'py').sqrt(4)) + __import__('matp' + 'lotlib').cm.viridis(0.0)[3]"
    with Sandbox(Limits(60.0, 120.0)) as sandbox_:
        outcome = sandbox_.run(cells(hidden), REQUESTS)
        assert value(outcome) == [3.0], outcome
        assert sandbox_._box.warmed == set()


@pytest.mark.sandbox
def test_a_box_that_ends_while_it_imports_starts_anew(monkeypatch):
    """Killed from without, once: the notebook is run in another box."""
    warm, killed = sandbox.Box.warm, []

    def warm_and_kill(box, libraries):
        if not killed:
            killed.append(box)
            os.kill(descendants(box.process.pid)[1], signal.SIGKILL)
        warm(box, libraries)

    monkeypatch.setattr(sandbox.Box, "warm", warm_and_kill)
    with Sandbox() as sandbox_:
        assert value(sandbox_.run(cells("import sympy\nA = sympy.Integer(1)"), REQUESTS)) == [1.0]
        assert sandbox_._box not in killed


GREEDY = {
    "children": "import os, time\nfor _ in range(8):\n    if os.fork() == 0:\n"
    "        kept = bytearray(b'x' * 120_000_000); time.sleep(60); os._exit(0)\ntime.sleep(60)",
    "shared": "import mmap, time\nkept = []\nfor _ in range(80):\n"
    "    m = mmap.mmap(-1, 100_000_000); m.write(bytes(100_000_000)); kept.append(m); time.sleep(0.02)",
}


@pytest.mark.sandbox
@pytest.mark.parametrize("way", GREEDY)
def test_the_sum_of_memory_is_watched_where_no_control_group_does(walls, monkeypatch, way):
    """What takes it is ended, and nothing else."""
    monkeypatch.setattr(sandbox.ControlGroup, "_make", lambda *_: False)
    notebook = [*cells("A = 1"), *cells(f"A = 2\n{GREEDY[way]}\nA = 3"), *cells("A")]
    seconds = 3.0 if way == "children" else 60.0
    with Sandbox(Limits(seconds, 120.0, memory=256 << 20)) as sandbox_:
        outcome = sandbox_.run(notebook, REQUESTS)
    assert outcome.note == ""
    if way == "children":  # the cell that made them goes on, and sleeps too long
        assert value(outcome) in ([2.0], [1.0])  # by how busy it is here
        assert {*outcome.errors, *outcome.killers} == {2}
    else:
        assert value(outcome) == [1.0]
        assert outcome.killers == {2: HOW["died"]}


@pytest.mark.sandbox
def test_a_cell_that_leaves_no_memory_is_left_out(walls):
    full = "kept, size = [], 1 << 27\nwhile size > 1000:\n    try: kept.append(bytes(size))\n"
    full += "    except MemoryError: size //= 2"
    outcome = walls.run([*cells("A = 1"), *cells(f"A = 2\n{full}"), *cells("B = A")], REQUESTS)
    assert (value(outcome), outcome.note) == ([1.0], "")
    assert outcome.killers == {2: HOW["died"]}


@pytest.mark.sandbox
def test_memory_that_cannot_be_freed_ends_the_notebook(walls, monkeypatch):
    monkeypatch.setattr(sandbox.ControlGroup, "_make", lambda *_: False)
    monkeypatch.setattr(sandbox.os, "pidfd_open", refuse)
    with Sandbox(Limits(60.0, 120.0, memory=256 << 20)) as sandbox_:
        assert sandbox_.run(cells(f"{GREEDY['shared']}\nA = 1"), REQUESTS).note == STARVED
        assert value(sandbox_.run(cells("A = 1"), REQUESTS)) == [1.0]


def refuse(*_):
    raise PermissionError


#: Root as in a container: it may change users, and not mount.
LESS_THAN_ROOT = ("setpriv", "--bounding-set", "-sys_admin", sys.executable)


@pytest.fixture
def less_than_root(walls):
    """Runs Python as root without the right to build walls by itself."""
    if os.geteuid() or not shutil.which("setpriv"):
        pytest.skip("not root, or no setpriv")
    return lambda *words: subprocess.run([*LESS_THAN_ROOT, *words], capture_output=True, text=True, check=False)


@pytest.mark.sandbox
def test_who_has_not_the_rights_of_root_has_the_same_walls(less_than_root):
    said = less_than_root("-m", "dhlib.cli", "grade", "--doctor")
    assert said.returncode == 0, said.stdout + said.stderr
    assert "✘" not in said.stdout


@pytest.mark.sandbox
def test_root_without_its_rights_becomes_root_of_a_namespace_and_nobody_in_the_box(less_than_root):
    """As itself it would meet no limit of processes: the kernel holds none for the machine's root."""
    tried = less_than_root(
        "-c",
        "from dhlib.grading.wall import outer\n"
        "print(outer.find_outer().user)\n"
        "for how in (outer.AS_ROOT, outer.AS_OWN_ROOT, outer.AS_ANYBODY): print(outer._why_not_bubblewrap(how))",
    )
    user, as_root, as_own_root, as_anybody = tried.stdout.splitlines()
    assert user == "65534"
    assert "does not run here" in as_root
    assert as_own_root == ""
    assert as_anybody.startswith(outer.UNBOUNDED)


@pytest.mark.sandbox
def test_walls_that_anybody_may_build_hold_as_well(walls, monkeypatch):
    monkeypatch.setattr(sandbox, "find_outer", outer.AS_ANYBODY.outer)
    if os.geteuid() == 0:  # which is why root does not build them this way
        held = [probe for probe in doctor.PROBES if probe.wall != "processes are bounded"]
        monkeypatch.setattr(doctor, "PROBES", held)
    said = io.StringIO()
    assert doctor.look(said), said.getvalue()


def test_what_says_what_is_right_is_not_in_view(tmp_path, monkeypatch):
    package = tmp_path / "site-packages" / "dhlib"
    (package / "_exercises").mkdir(parents=True)
    (package / "__init__.py").touch()
    monkeypatch.setattr(view.dhlib, "__file__", str(package / "__init__.py"))
    monkeypatch.syspath_prepend(str(package.parent))
    seen = view.view()
    hidden = str(package / "_exercises")
    assert {hidden, view._place(hidden), f"{view.LIBRARY}/_exercises"} <= set(seen.emptied)
    command = " ".join(outer.bubblewrap(seen, True))
    assert all(f" --tmpfs {place} --remount-ro {place} " in command for place in seen.emptied)
    shown = [source for source, _ in seen.shown]
    assert not any(str(path).startswith(os.path.expanduser("~") + "/.ssh") for path in shown)
    assert os.getcwd() not in shown
    assert "/" not in shown


@pytest.mark.sandbox
def test_libraries_below_the_folder_of_the_notebook_can_be_imported_late(monkeypatch):
    with tempfile.TemporaryDirectory(dir=inner.HOME) as folder:
        packages = Path(folder, "site-packages")
        packages.mkdir(mode=0o755)
        Path(folder).chmod(0o755)
        (packages / "lately.py").write_text("VALUE = 3.0", "utf-8")
        monkeypatch.syspath_prepend(str(packages))
        with Sandbox() as sandbox_:
            outcome = sandbox_.run(cells("import lately; A = lately.VALUE"), REQUESTS)
            assert value(outcome) == [3.0], outcome
            hidden = f"import os; A = float(os.path.exists({str(packages)!r}))"
            assert value(sandbox_.run(cells(hidden), REQUESTS)) == [0.0]


@pytest.mark.parametrize("problem", ["missing", "blocked", "switched off", "no Linux"])
def test_a_machine_where_no_wall_can_be_built_refuses(monkeypatch, tmp_path, problem):
    if problem in ("blocked", "switched off"):
        (tmp_path / "bwrap").write_text("#!/bin/sh\necho 'bwrap: No permissions to create new namespace' >&2; exit 1\n")
        (tmp_path / "bwrap").chmod(0o755)
    if problem == "switched off":
        monkeypatch.setattr(outer, "open", lambda *_, **__: io.StringIO("0\n"), raising=False)
    if problem == "no Linux":
        monkeypatch.setattr(outer, "sys", SimpleNamespace(platform="darwin"))
    monkeypatch.setenv("PATH", str(tmp_path))
    outer.find_outer.cache_clear()
    try:
        with pytest.raises(DHError, match="need a sandbox") as refused:
            Sandbox()
    finally:
        monkeypatch.undo()
        outer.find_outer.cache_clear()
    words = {
        "missing": "is not installed",
        "blocked": "No permissions to create new namespace",
        "switched off": "User namespaces are switched off: as root, sysctl kernel.unprivileged_userns_clone=1.",
        "no Linux": "bubblewrap is for Linux: here, run dhlib in a container.",
    }
    assert words[problem] in str(refused.value)
    assert "--unsafe-no-sandbox" in str(refused.value)


@pytest.mark.parametrize(("said", "words"), [("echo no room >&2", "no room"), (":", "it said nothing")])
def test_a_box_that_does_not_start_is_said(said, words):
    behind = Sandbox(unsafe=True)
    behind._outer = outer.Outer("played", lambda _: ["sh", "-c", f"{said}; exit 1"])
    with pytest.raises(
        DHError, match=f"the box for notebooks could not be started: {words}\\. Is dhlib installed with"
    ):
        behind.run(cells("A = 1"), REQUESTS)


def test_a_notebook_that_is_too_long_to_be_run_is_said(monkeypatch):
    behind = Sandbox(unsafe=True)
    behind._outer = outer.Outer("played", lambda _: ["false"])
    long = f"A = '{'x' * sandbox.LARGEST_JOB}'"
    assert behind.run(cells(long), REQUESTS).note == "The code of the notebook is too long to be run."


@pytest.mark.parametrize(
    ("release", "count"), [("5.10.0-8-amd64", 4096), ("5.14.0", 0), ("6.1.0-rc1+", 0), ("4.19", 4096), ("odd", 4096)]
)
def test_processes_outside_count_where_the_kernel_is_old(monkeypatch, release, count):
    monkeypatch.setattr(sandbox.os, "uname", lambda: SimpleNamespace(release=release))
    assert sandbox.processes_that_count() == count


def test_a_long_job_is_sent_in_pieces_and_closed_at_its_end():
    class Kept(io.BytesIO):
        def close(self):
            self.sent = self.getvalue()
            super().close()

    job = os.urandom(2 * sandbox.CHUNK + 3)
    left, to_box, lengths = memoryview(job), Kept(), []
    while left:
        assert not to_box.closed
        left = sandbox._send_some(left, to_box)
        lengths.append(len(left))
    assert lengths == [sandbox.CHUNK + 3, 3, 0]
    assert to_box.closed
    assert to_box.sent == job


# Without walls, in a box that is played


@pytest.mark.parametrize(
    ("lines", "note", "killers", "readings"),
    [
        ([], "No Python with IPython could be started for it: install dhlib[grade].", {}, {}),
        ([{"begin": 0}], "The notebook ended its own program.", {0: "ended the program"}, {}),
        ([{"end": 0}], "The notebook ended its own program.", {}, {}),
        ([3, [], "{", {"x": 1}, {"part": "A", "reading": {}}, {"done": True}], "", {}, {"A": {}}),
    ],
    ids=["no Python", "ends in a cell", "ends between cells", "says more than messages"],
)
def test_what_a_box_without_walls_says_is_heeded(no_walls, monkeypatch, tmp_path, lines, note, killers, readings):
    said = "".join(f"{line if isinstance(line, str) else json.dumps(line)}\n" for line in lines)
    played = tmp_path / "python"
    played.write_text(f"#!/bin/sh\ncat <<'END'\n{said}END\n")
    played.chmod(0o755)
    monkeypatch.setattr(plain, "sys", SimpleNamespace(executable=str(played)))
    outcome = no_walls.run(cells("A = 1"), REQUESTS)
    assert (outcome.note, outcome.killers, outcome.readings) == (note, killers, readings)


def test_whatever_a_keeper_meets_costs_its_notebook_and_not_the_class(monkeypatch):
    def meet(*_):
        raise RuntimeError("something new")

    monkeypatch.setattr(keeping.os, "fork", lambda: 1)
    monkeypatch.setattr(keeping.Keeper, "_step", meet)
    notices, own = os.pipe()
    job = {"cells": [{"source": "", "role": "answer", "part": "A"}], "requests": {}}
    keeping.Keeper(job, {"cell_seconds": 1, "swift": 0, "hung": None}, None, 0, (own, 0)).run(keeping.channel())
    os.close(own)
    with os.fdopen(notices) as heard:
        assert json.loads(heard.read()) == {"lost": "its keeper met RuntimeError('something new')"}
