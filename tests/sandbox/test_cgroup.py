"""Control groups of version 2, in a kernel that is played; the real one is asked for its rules where it can be."""

import errno
import os
import subprocess
from pathlib import Path

import pytest

from dhlib.grading.notebook import Cell
from dhlib.grading.wall import Limits, Sandbox, cgroup
from dhlib.grading.wall.cgroup import SERVER_MEMORY, SERVER_PROCESSES, ControlGroup

LIMITS = Limits(memory=1000, processes=10)
FILES = {"memory": ("memory.max", "memory.swap.max"), "pids": ("pids.max",)}


class Kernel:
    """Keeps the files of groups in plain folders, by the rules of the kernel that matter here."""

    def __init__(self, root, controllers):
        self.root = root
        self.fill(root, controllers)
        self.closed = set()

    def fill(self, folder, controllers):
        (folder / "cgroup.controllers").write_text(" ".join(controllers))
        for name in ("cgroup.subtree_control", "cgroup.procs", *(f for c in controllers for f in FILES[c])):
            (folder / name).write_text("")

    def make(self, folder):
        if folder.parent in self.closed:
            raise PermissionError
        folder.mkdir()
        self.fill(folder, (folder.parent / "cgroup.subtree_control").read_text().split())

    def write(self, file, text):
        if file.parent in self.closed:
            raise PermissionError
        if not file.exists():
            raise FileNotFoundError
        if file.name == "cgroup.subtree_control":
            text = self.handed_on(file, text.removeprefix("+"))
        file.write_text(text)

    def handed_on(self, file, controller):
        folder = file.parent
        if controller not in (folder / "cgroup.controllers").read_text().split():
            raise FileNotFoundError
        if folder != self.root and (folder / "cgroup.procs").read_text():
            raise OSError(errno.EBUSY, "no internal processes")
        return " ".join(sorted({*file.read_text().split(), controller}))


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """``machine(controllers, group)``: this process is in a group of a machine with these controllers."""
    monkeypatch.setattr(cgroup, "ROOT", tmp_path)

    def machine(controllers, group="/"):
        kernel = Kernel(tmp_path, controllers)
        monkeypatch.setattr(cgroup, "make", kernel.make)
        monkeypatch.setattr(cgroup, "write", kernel.write)
        monkeypatch.setattr(cgroup, "_own_groups", lambda: {"": group})
        folder = tmp_path
        for name in group.strip("/").split("/") if group != "/" else ():
            for controller in (folder / "cgroup.controllers").read_text().split():
                kernel.write(folder / "cgroup.subtree_control", f"+{controller}")
            folder = folder / name
            kernel.make(folder)
        (folder / "cgroup.procs").write_text("1\n")
        return kernel, folder

    return machine


def found(group):
    return {file.name: file.read_text() for folder in group.folders for file in folder.glob("*.max")}


FULL = {
    "memory.max": str(LIMITS.memory + SERVER_MEMORY),
    "memory.swap.max": "0",
    "pids.max": str(LIMITS.processes + SERVER_PROCESSES),
}


def test_beside_our_own_group_since_one_with_processes_hands_nothing_on(machine):
    _, own = machine(["memory", "pids"], "/user.slice/app.slice/run.scope")
    group = ControlGroup(LIMITS)
    assert [folder.parent for folder in group.folders] == [own.parent]
    assert (group.memory, group.processes) == (True, True)
    assert found(group) == FULL
    assert (own / "cgroup.subtree_control").read_text() == ""


def test_below_the_root_which_may_have_processes(machine):
    _, own = machine(["memory", "pids"])
    group = ControlGroup(LIMITS)
    assert [folder.parent for folder in group.folders] == [own]
    assert found(group) == FULL


def test_what_the_machine_has_not_is_not_claimed(machine):
    machine(["pids"], "/a.slice/b.scope")
    group = ControlGroup(LIMITS)
    assert (group.memory, group.processes) == (False, True)
    assert found(group) == {"pids.max": FULL["pids.max"]}


@pytest.mark.parametrize("controllers", [[], ["memory", "pids"]], ids=["no controllers", "not ours"])
def test_no_group_where_none_can_be_had(machine, controllers):
    kernel, own = machine(controllers, "/a.slice/b.scope")
    kernel.closed = {own, own.parent} if controllers else set()
    group = ControlGroup(LIMITS)
    assert (group.memory, group.processes, group.folders) == (False, False, [])
    assert [folder.name for folder in own.parent.glob("dhlib-*")] == []


def test_a_group_that_the_box_is_not_in_bounds_nothing(machine):
    machine(["memory", "pids"], "/a.slice/b.scope")
    group = ControlGroup(LIMITS)
    (group.folders[0] / "cgroup.procs").write_text("17\n23\n")
    group.holds(23)
    assert (group.memory, group.processes) == (True, True)
    group.holds(2)
    assert (group.memory, group.processes) == (False, False)


def test_a_group_that_cannot_be_removed_is_left_behind(machine, monkeypatch):
    monkeypatch.setattr(cgroup, "REMOVE_SECONDS", 0.03)
    machine(["memory", "pids"], "/a.slice/b.scope")
    group = ControlGroup(LIMITS)
    (folder,) = group.folders
    group.close()  # its files are in it, as processes that have not ended would be
    assert folder.is_dir()
    assert group.entrances == []


@pytest.mark.sandbox
def test_a_box_that_could_not_go_into_its_group_is_watched(walls, monkeypatch):
    monkeypatch.setattr(ControlGroup, "entrances", ["/proc/nowhere"])
    monkeypatch.setattr(ControlGroup, "_make", lambda self, *_: self.folders.append(Path("/proc/nowhere")) or True)
    monkeypatch.setattr(ControlGroup, "close", lambda _: None)
    with Sandbox(Limits.of(60)) as sandbox:
        cells = [Cell("A = 1", role="answer", part="A"), Cell("", role="check", part="A")]
        assert sandbox.run(cells, {"A": {"form": "numbers", "shape": []}}).readings == {"A": {"values": [1.0]}}
        assert sandbox._box.watched


def real_root():
    """Where the kernel here shows groups of version 2 with a controller that we may hand on."""
    for line in Path("/proc/self/mounts").read_text().splitlines():
        _, place, kind, *_ = line.split()
        controllers = Path(place, "cgroup.controllers") if kind == "cgroup2" else None
        if controllers and os.access(place, os.W_OK) and controllers.read_text().split():
            return Path(place), controllers.read_text().split()[0]
    pytest.skip("no control groups of version 2 that are ours to make")


def test_the_kernel_has_the_rules_that_are_played():
    root, controller = real_root()
    above = root / f"rules-{os.getpid()}"
    below = above / "below"
    cgroup.make(above)
    cgroup.make(below)
    started = subprocess.Popen(["sleep", "600"])
    handed = controller in (root / "cgroup.subtree_control").read_text().split()
    try:
        if not handed:
            cgroup.write(root / "cgroup.subtree_control", f"+{controller}")
        cgroup.write(above / "cgroup.procs", str(started.pid))
        with pytest.raises(OSError, match="busy"):
            cgroup.write(above / "cgroup.subtree_control", f"+{controller}")
        cgroup.write(below / "cgroup.procs", str(started.pid))
        assert str(started.pid) in (below / "cgroup.procs").read_text().split()
        cgroup.write(above / "cgroup.subtree_control", f"+{controller}")
        assert list(below.glob(f"{controller}.*"))
        there = (above / "cgroup.controllers").read_text().split()
        if lacking := [name for name in ("memory", "pids", "io") if name not in there]:
            with pytest.raises(FileNotFoundError):
                cgroup.write(above / "cgroup.subtree_control", f"+{lacking[0]}")
        with pytest.raises(FileNotFoundError):
            cgroup.write(above / "nothing.max", "1")
    except PermissionError:
        pytest.skip("these control groups are another's")
    finally:
        started.kill()
        started.wait()
        for folder in (below, above):
            remove(folder)
        if not handed:
            cgroup.write(root / "cgroup.subtree_control", f"-{controller}")


def remove(folder):
    """Remove a group, as soon as the kernel has seen that its process ended."""
    for _ in range(1000):
        try:
            return folder.rmdir()
        except OSError as error:
            if error.errno != errno.EBUSY:
                raise
            os.sched_yield()
