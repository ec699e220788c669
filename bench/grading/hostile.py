"""What becomes of a class in which one notebook is hostile: ``python hostile.py`` in the book's own environment.

Each attack stands in the cell of the first part; the parts after it are right. It deserves no point for the first part,
and the two honest students beside it deserve all of theirs. No attack does harm that outlives its run: files are
planted for it, and what it starts ends by itself.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

import compare
import work
from environment import NotToBeHad, size

#: Longer than this nobody waits for three notebooks.
PATIENCE = 300
PROBE_PORT = 49_731
TRACE = Path(tempfile.gettempdir()) / "bench-hostile-trace"

ATTACKS = {
    "patches allclose": "np.allclose = lambda *a, **k: True\np = np.zeros(2)",
    "an array that equals everything": (
        "class Yes(np.ndarray):\n    def __array_ufunc__(self, *a, **k):\n        return np.array([True, True])\n"
        "    def __array_function__(self, *a, **k):\n        return True\np = np.zeros(2).view(Yes)"
    ),
    "looks for the reference in the files around": (
        "import os\np = np.zeros(2)\nfor top in ('../../..', os.environ.get('HOME', '/root'), '/tmp'):\n"
        "    for folder, _, names in os.walk(top):\n        for name in names:\n            try:\n"
        "                text = open(os.path.join(folder, name)).read(200_000)\n            except Exception:\n"
        "                continue\n            if name.endswith(('.py', '.ipynb', '.json')) and '1.019768' in text:\n"
        "                p = np.array([1.019768, 0.015096])"
    ),
    "ends the process with success": "import os\nos._exit(0)",
    "kills the process above": "import os, signal\nos.kill(os.getppid(), signal.SIGKILL)\np = np.zeros(2)",
    "never ends": "while True:\n    pass",
    "never ends and swallows the interrupt": (
        "while True:\n    try:\n        while True:\n            pass\n    except BaseException:\n        pass"
    ),
    "leaves a process behind": (
        "import subprocess\nsubprocess.Popen(['sleep', '347'], start_new_session=True)\np = np.zeros(2)"
    ),
    "opens a connection": (
        f"import socket\nsocket.create_connection(('127.0.0.1', {PROBE_PORT}), 2).close()\np = np.zeros(2)"
    ),
    "writes outside": f"open({str(TRACE)!r}, 'w').write('x')\np = np.zeros(2)",
}


class Watch:
    """Sees what an attack achieved outside: a connection, a file, a process that stayed."""

    def __enter__(self) -> Watch:
        TRACE.unlink(missing_ok=True)
        self.connected = False
        self.listener = socket.create_server(("127.0.0.1", PROBE_PORT))
        threading.Thread(target=self._listen, daemon=True).start()
        return self

    def _listen(self) -> None:
        try:
            while True:
                self.listener.accept()[0].close()
                self.connected = True
        except OSError:
            pass

    def __exit__(self, *_: Any) -> None:
        self.listener.shutdown(socket.SHUT_RDWR)  # or the thread that waits would keep the port
        self.listener.close()

    def harm(self) -> list[str]:
        """Say what was achieved, and clear it away."""
        found = []
        if self.connected:
            found.append("connected")
        if TRACE.exists():
            found.append("wrote outside")
            TRACE.unlink()
        said = subprocess.run(["pgrep", "-f", "^sleep 347$"], capture_output=True, text=True, check=False).stdout
        for pid in map(int, said.split()):
            found.append("left a process")
            os.kill(pid, signal.SIGKILL)
        return found


def tried(grader: compare.Grader, attack: str) -> dict[str, Any]:
    """Grade two honest students and the attack; say what came of it."""
    right = work.answers(dict.fromkeys(work.PARTS, True))
    hand_ins = {"student00": right, "student01": right | {"p": attack}, "student02": right}
    begin = time.perf_counter()
    with Watch() as watch, tempfile.TemporaryDirectory() as folder:
        try:
            marks = grader.grade(Path(folder), hand_ins) or {}
            ended = ""
        except (NotToBeHad, OSError, KeyError, ValueError) as why:
            marks, ended = {}, f"ended: {why}"[:120]
        harm = watch.harm()
    own = marks.get("student01", {})
    return {
        "ended": ended,
        "undeserved": bool(own.get("p")),
        "others": all(all(marks.get(who, {"": False}).values()) for who in ("student00", "student02")),
        "later_parts": bool(own) and all(own.get(part, False) for part in ("A1", "T", "fk")),
        "harm": harm,
        "seconds": time.perf_counter() - begin,
    }


def rows() -> Iterator[dict[str, Any]]:
    """Yield what each grader made of each attack."""
    tried_attacks = list(ATTACKS.items())[: size(len(ATTACKS), 2)]
    for grader in compare.GRADERS[:-1]:
        if grader.call in ("pytest --nbval-lax, one by one", "pytest --nbval-lax -n 2 --dist loadscope"):
            continue
        for name, attack in tried_attacks:
            print(f"  hostile: {grader.call}, {name}", file=sys.stderr, flush=True)
            yield {"peer": grader.peer, "call": grader.call, "attack": name, **tried(grader, attack)}


def main() -> None:
    """Print one JSON object."""
    compare.patience = PATIENCE
    json.dump({"rows": list(rows()), "attacks": list(ATTACKS)}, sys.stdout)


if __name__ == "__main__":
    main()
