"""What becomes of a class in which one notebook is hostile: ``python hostile.py`` in the book's own environment.

Each attack stands in the answer to one part; the other parts are right. It deserves no point for that part, and the two
honest students beside it deserve all of theirs. Nothing stands around a grader but what it puts there itself, so no
attack is here that would harm the machine where nothing stops it: no bomb, no filler of memory or disk, no killer of
everything, nothing that changes a library, a file of the system or what a kernel keeps. Files are planted for them, and
what they start is ended.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

import compare
import work
from environment import ROOT, NotToBeHad, python_of, size

#: Longer than this nobody waits for three notebooks.
PATIENCE = 75
#: So many are tried side by side: most of their time they wait.
LANES = 2
#: The corpus that tests the walls of dhlib. Its attacks answer A, or f where they say so.
CORPUS = ROOT / "tests" / "sandbox" / "attacks"
SECRET = "1.019768"


@dataclass(frozen=True)
class Attack:
    """An attack, in the answer to a part.

    Parameters
    ----------
    tries : str
        What it tries to do.
    source : str
        With names for what it is after: see `Watch.placed`.
    part : str
    """

    tries: str
    source: str
    part: str = "p"


#: Made for what any grader does.
OWN = (
    Attack("patch allclose", "np.allclose = lambda *a, **k: True\np = np.zeros(2)"),
    Attack(
        "hand in an array that equals everything",
        "class Yes(np.ndarray):\n    def __array_ufunc__(self, *a, **k):\n        return np.array([True, True])\n"
        "    def __array_function__(self, *a, **k):\n        return True\np = np.zeros(2).view(Yes)",
    ),
    Attack(
        "look for the reference in the files around",
        "import os\np = np.zeros(2)\nfor top in ('../../..', os.environ.get('HOME', '/root'), '/tmp'):\n"
        "    for folder, _, names in os.walk(top):\n        for name in names:\n            try:\n"
        "                text = open(os.path.join(folder, name)).read(200_000)\n            except Exception:\n"
        f"                continue\n            if name.endswith(('.py', '.ipynb', '.json')) and '{SECRET}' in text:\n"
        f"                p = np.array([{SECRET}, 0.015096])",
    ),
    Attack("kill the process above", "import os, signal\nos.kill(os.getppid(), signal.SIGKILL)\np = np.zeros(2)"),
    Attack(
        "leave a process behind",
        "import subprocess\nsubprocess.Popen(['sleep', SLEEP], start_new_session=True)\np = np.zeros(2)",
    ),
)
#: Of the corpus: how its A or f becomes an answer here, and the files.
OF_THE_CORPUS = {
    "": """
        loop_plain loop_swallowing exit_at_once exit_politely abort segfault close_all_files exhaust_files evil_error
        markup_error patch_system patch_shell results_overwritten leave_a_file
    """,
    "\np = A": """
        exit_at_reading equals_everything lying_array lying_class lying_float nan infinite huge_number endless_list
        million_entries patch_numpy patch_builtins patch_json socket_loopback socket_udp socket_unix socket_abstract
    """,
    "\np = np.array([A, 0.015096])": "read_results",
    "\nfk = f": "function_exits function_raises_exit function_lies function_returns_million",
}
#: Of the corpus: what nothing but a limit of time ends. Only dhlib is given these, which has a wall for them.
ENDLESS = "loop_in_c loop_plain loop_signals_off loop_swallowing sleep_for_ever output_endless fork_bomb thread_bomb"
LIMIT = 4.0
#: The same as another that is tried, but for the order of their work.
NOT_TRIED = ("pytest --nbval-lax, one by one", "pytest --nbval-lax -n 2 --dist loadscope")


def attacks() -> list[Attack]:
    """All that are tried."""
    found = list(OWN)
    for name, more in ((name, more) for more, names in OF_THE_CORPUS.items() for name in names.split()):
        text = (CORPUS / f"{name}.cell").read_text(encoding="utf-8")
        tries = re.match(r"# Tries: to (.*)\.", text)
        if tries is None:
            raise NotToBeHad(f"{name}.cell does not say what it tries")
        found.append(Attack(tries[1], text + more, "fk" if "fk" in more else "p"))
    return found


class Watch:
    """What is planted for an attack, and what it achieved: a connection, a file, a process that stayed."""

    def __init__(self, folder: Path) -> None:
        self.planted = folder / "planted.txt"
        self.text = f"secret = {SECRET}"  # what is right, as another student's notebook would hold it
        self.planted.write_text(self.text)
        self.connected = False
        self.stack = [socket.create_server(("127.0.0.1", 0))]
        port = self.stack[0].getsockname()[1]
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        udp.bind(("127.0.0.1", port))
        self.placed = {
            "RESULTS_FILE": str(self.planted),
            "PORT": port,
            "SOCKET_FILE": str(folder / "socket"),
            "ABSTRACT": f"\0bench-hostile-{port}",
            "SLEEP": f"347.{port}",
            "/left-behind": f"/left-behind-{port}",
        }
        for address in (self.placed["SOCKET_FILE"], self.placed["ABSTRACT"]):
            server = socket.socket(socket.AF_UNIX)
            server.bind(address)
            server.listen()
            self.stack.append(server)
        for server in self.stack:
            threading.Thread(target=self._listen, args=(server.accept,), daemon=True).start()
        threading.Thread(target=self._listen, args=(lambda: udp.recv(10),), daemon=True).start()
        self.stack.append(udp)

    def _listen(self, wait: Any) -> None:
        try:
            while wait():
                self.connected = True
        except OSError:
            pass

    def place(self, source: str) -> str:
        """Fill in what an attack is after."""
        for name, value in self.placed.items():
            if name.startswith("/"):
                source = source.replace(name, str(value))
            else:
                source = re.sub(rf"\b{name}\b", lambda _, value=value: repr(value), source)
        return source

    def __enter__(self) -> Watch:
        return self

    def __exit__(self, *_: Any) -> None:
        for each in self.stack:
            with contextlib.suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)  # or the thread that waits would keep it
            each.close()

    def harm(self) -> list[str]:
        """Say what was achieved, and clear it away."""
        found = []
        if self.connected:
            found.append("connected")
        if self.planted.read_text() != self.text:
            found.append("wrote outside")
        left = [
            Path(folder + self.placed["/left-behind"]) for folder in ("/tmp", "/dev/shm", "/var/tmp", str(Path.home()))
        ]
        if any(path.exists() for path in left):
            found.append("left a file")
        for path in left:
            path.unlink(missing_ok=True)
        pattern = f"^sleep {self.placed['SLEEP']}$"
        said = subprocess.run(["pgrep", "-f", pattern], capture_output=True, text=True, check=False).stdout
        for pid in map(int, said.split()):
            found.append("left a process")
            os.kill(pid, signal.SIGKILL)
        return found


def tried(grader: compare.Grader, attack: Attack) -> dict[str, Any]:
    """Grade two honest students and the attack; say what came of it."""
    right = work.answers(dict.fromkeys(work.PARTS, True))
    begin = time.perf_counter()
    with (
        tempfile.TemporaryDirectory() as outside,
        Watch(Path(outside)) as watch,
        tempfile.TemporaryDirectory() as folder,
    ):
        hostile = right | {attack.part: watch.place(attack.source)}
        try:
            marks = grader.grade(Path(folder), {"student00": right, "student01": hostile, "student02": right}) or {}
            ended = ""
        except (NotToBeHad, OSError, KeyError, ValueError) as why:
            marks, ended = {}, f"ended: {why}"[:120]
        harm = watch.harm()
    own = marks.get("student01", {})
    return {
        "ended": ended,
        "undeserved": bool(own.get(attack.part)),
        "others": all(all(marks.get(who, {"": False}).values()) for who in ("student00", "student02")),
        "other_parts": bool(own) and all(own.get(part, False) for part in work.PARTS if part != attack.part),
        "harm": harm,
        "seconds": time.perf_counter() - begin,
    }


def beyond() -> dict[str, Any]:
    """How long the worst of the notebooks that never end takes beyond its limit, with dhlib, and which it is."""
    from dhlib.grading.notebook import Cell
    from dhlib.grading.wall import Limits, Sandbox

    limits = Limits(cell_seconds=LIMIT, notebook_seconds=LIMIT)
    taken = {}
    with Sandbox(limits) as sandbox:
        for name in ENDLESS.split()[: size(8, 1)]:
            source = (CORPUS / f"{name}.cell").read_text(encoding="utf-8")
            cells = [Cell(source, role="answer", part="A"), Cell("", role="check", part="A")]
            sandbox.run([], {})  # the box starts, if the one before broke it
            begin = time.perf_counter()
            sandbox.run(cells, {"A": {"form": "numbers", "shape": []}})
            taken[name] = time.perf_counter() - begin - LIMIT
    worst = max(taken, key=lambda name: taken[name])
    return {"seconds": taken[worst], "attack": worst, "of": len(taken)}


def rows() -> Iterator[dict[str, Any]]:
    """Yield what each grader made of each attack."""
    graders = [grader for grader in compare.GRADERS[:-1] if grader.call not in NOT_TRIED]
    for peer in {grader.peer for grader in graders} - {"dhlib"}:
        python_of(peer)  # each is made once, not by two lanes at a time
    pairs = [(grader, attack) for attack in chosen() for grader in graders]

    def row(pair: tuple[compare.Grader, Attack]) -> dict[str, Any]:
        grader, attack = pair
        print(f"  hostile: {grader.call}, to {attack.tries}", file=sys.stderr, flush=True)
        return {"peer": grader.peer, "call": grader.call, "attack": attack.tries, **tried(grader, attack)}

    with ThreadPoolExecutor(LANES) as lanes:
        yield from lanes.map(row, pairs)


def chosen() -> list[Attack]:
    """All attacks, or a few where the bench is only tried."""
    found = attacks()
    return found[: size(len(found), 2)]


def main() -> None:
    """Print one JSON object."""
    compare.patience = PATIENCE
    corpus = len(list(CORPUS.glob("*.cell")))
    tries = [each.tries for each in chosen()]
    json.dump({"beyond": beyond(), "rows": list(rows()), "attacks": tries, "corpus": corpus}, sys.stdout)


if __name__ == "__main__":
    main()
