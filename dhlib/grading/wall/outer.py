"""The outer wall: what stands between the box of a worker and the machine.

bubblewrap where it runs, on this machine or in a container of podman or docker (see the Containerfile); else a refusal
that says what to install.
"""

from __future__ import annotations

import functools
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from dhlib.errors import DHError
from dhlib.grading.wall import inner
from dhlib.grading.wall.inner import HOME, NOBODY
from dhlib.grading.wall.view import DEVICES, View, view

SERVER = "dhlib.grading.wall.server"
PROBE_SECONDS = 30.0
UNBOUNDED = "No limit of processes holds for root here."

WITHOUT = "--unsafe-no-sandbox grades without it, which is for your own notebooks only."
REMEDY = (
    "strangers' notebooks need a sandbox, and none can be built here. {why} "
    "What helps: bubblewrap (Debian and Ubuntu: apt install bubblewrap; Fedora: dnf install bubblewrap), or podman or "
    f"docker with the Containerfile of the repository. {WITHOUT}"
)

#: What a container has to be started with, so that walls can be built in it.
CONTAINER = " ".join(
    f"--security-opt {option}"
    for option in ("seccomp=unconfined", "systempaths=unconfined", "apparmor=unconfined", "label=disable")
)


@dataclass(frozen=True)
class Outer:
    """An outer wall that was seen to stand.

    Parameters
    ----------
    name : str
    command : callable
        A view to the command that starts the server behind this wall; its standard input is the socket.
    user : int
        Which user the server becomes; 0 to stay.
    """

    name: str
    command: Callable[[View], list[str]]
    user: int = 0


def start_python(seen: View) -> list[str]:
    """The interpreter, without the user's settings; what it can import is named, not found."""
    code = f"import sys; sys.path[:] = {seen.path!r}; import runpy; runpy.run_module({SERVER!r}, run_name='__main__')"
    return [seen.python, "-I", "-S", "-c", code]


def environment() -> dict[str, str]:
    """All that the server knows of the environment."""
    return {
        "PATH": "/nowhere",
        "HOME": HOME,
        "TMPDIR": HOME,
        "IPYTHONDIR": f"{HOME}/ipython",
        "MPLCONFIGDIR": f"{HOME}/matplotlib",
        "MPLBACKEND": "Agg",
        "LANG": "C.UTF-8",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "MKL_NUM_THREADS": "1",
        "PYTHONHASHSEED": "0",
        "PYTHONDONTWRITEBYTECODE": "1",
    }


def bubblewrap(seen: View, root: bool) -> list[str]:
    """The command line of bubblewrap, up to the program that it starts."""
    words = ["bwrap", "--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try"]
    if root:  # a real root builds the wall itself, and the server becomes nobody
        words += ["--cap-drop", "ALL", "--cap-add", "CAP_SETUID", "--cap-add", "CAP_SETGID"]
    else:
        words += ["--unshare-user"]
    words += ["--die-with-parent", "--new-session", "--as-pid-1", "--hostname", "box", "--clearenv"]
    for name, value in environment().items():
        words += ["--setenv", name, value]
    words += ["--perms", "1777", "--tmpfs", HOME]  # of the server; no notebook sees it
    for folder in sorted({str(parent) for _, place in seen.shown for parent in Path(place).parents} - {"/"} | {"/dev"}):
        words += ["--perms", "0755", "--dir", folder]
    for name in DEVICES:
        words += ["--dev-bind", f"/dev/{name}", f"/dev/{name}"]
    for source, place in seen.shown:
        words += ["--ro-bind", source, place]
    for place in seen.emptied:
        words += ["--tmpfs", place, "--remount-ro", place]
    return [*words, "--proc", "/proc", "--remount-ro", "/", "--chdir", HOME, "--"]


def as_own_root(command: list[str]) -> list[str]:
    """The command, started by root of a namespace of its own."""
    code = f"import os, sys; sys.path.append({str(Path(inner.__file__).parent)!r}); import inner; "
    return [sys.executable, "-I", "-S", "-c", f"{code}inner.own_root(); os.execvp(sys.argv[1], sys.argv[1:])", *command]


@dataclass(frozen=True)
class Way:
    """A way to start bubblewrap.

    Parameters
    ----------
    started : callable
        The command to the command that starts it.
    root : bool
        Whether it is root there.
    """

    started: Callable[[list[str]], list[str]]
    root: bool

    def outer(self) -> Outer:
        """The wall that is built this way."""
        user = NOBODY if self.root else 0
        return Outer("bubblewrap", lambda seen: self.command(seen, start_python(seen)), user)

    def command(self, seen: View, program: list[str]) -> list[str]:
        """Start a program behind the wall."""
        return self.started([*bubblewrap(seen, self.root), *program])


AS_ROOT, AS_OWN_ROOT, AS_ANYBODY = Way(list, True), Way(as_own_root, True), Way(list, False)


@functools.cache
def find_outer() -> Outer:
    """The best outer wall that stands on this machine; tried once.

    Raises
    ------
    DHError
        If there is none; the message says what to install.
    """
    if sys.platform != "linux":
        raise DHError(REMEDY.format(why="bubblewrap is for Linux: here, run dhlib in a container."))
    # In a container root lacks the right to build walls by itself. It may have it in a namespace of its own, and else
    # it builds them as anybody does.
    for way in (AS_ROOT, AS_OWN_ROOT, AS_ANYBODY) if os.geteuid() == 0 else (AS_ANYBODY,):
        why = _why_not_bubblewrap(way)
        if not why:
            return way.outer()
    raise DHError(REMEDY.format(why=why))


def _why_not_bubblewrap(way: Way) -> str:
    """Empty if bubblewrap really runs here and namespaces can be made within it, else what is in the way."""
    if not shutil.which("bwrap"):
        return "bubblewrap is not installed."
    seen = view()
    code = f"import sys; sys.path[:] = {seen.path!r}; from dhlib.grading.wall import inner; "
    code += f"inner.become({way.outer().user}); inner.own_spaces(); inner.bounded() or sys.exit({UNBOUNDED!r})"
    try:
        tried = subprocess.run(
            way.command(seen, [seen.python, "-I", "-S", "-c", code]),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=PROBE_SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "bubblewrap does not answer."
    if tried.returncode == 0:
        return ""
    said = tried.stderr.decode(errors="replace").strip().splitlines()
    if said and said[-1] == UNBOUNDED:
        return f"{UNBOUNDED} Run dhlib as an ordinary user; in a container, with --user 1000:1000."
    return f"bubblewrap is installed and does not run here ({said[-1] if said else tried.returncode}). {_blocked()}"


def _blocked() -> str:
    """Which setting of the kernel is in the way, if it is one of the usual ones."""
    for path, bad, remedy in (
        ("/proc/sys/kernel/unprivileged_userns_clone", "0", "sysctl kernel.unprivileged_userns_clone=1"),
        ("/proc/sys/user/max_user_namespaces", "0", "sysctl user.max_user_namespaces=10000"),
        (
            "/proc/sys/kernel/apparmor_restrict_unprivileged_userns",
            "1",
            "sysctl kernel.apparmor_restrict_unprivileged_userns=0, or an AppArmor profile for bwrap",
        ),
    ):
        try:
            with open(path, encoding="ascii") as file:
                if file.read().strip() == bad:
                    return f"User namespaces are switched off: as root, {remedy}."
        except OSError:
            continue
    return f"In a container, start it with {CONTAINER}."
