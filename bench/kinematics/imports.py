"""What it costs to import each library: CPU time and memory over a bare Python.

``python imports.py PEER …`` prints one JSON object. A fresh process for each, by turns.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[1]))

from environment import size

ROUNDS = size(9, 1)
#: What one imports to compute a pose, where that is not the name of the library.
MODULES = {"pybotics": "pybotics.robot", "ikpy": "ikpy.chain", "visual_kinematics": "visual_kinematics.RobotSerial"}


def cost(statement: str) -> tuple[float, float]:
    """CPU milliseconds and peak memory in MB of a fresh Python that runs one statement."""
    program = (
        f"{statement}\nimport resource as r; u = r.getrusage(r.RUSAGE_SELF); "
        "print(1e3 * (u.ru_utime + u.ru_stime), u.ru_maxrss / 1024)"
    )
    said = subprocess.run([sys.executable, "-W", "ignore", "-c", program], capture_output=True, text=True, check=True)
    milliseconds, megabytes = said.stdout.split()[-2:]
    return float(milliseconds), float(megabytes)


def main() -> None:
    """Measure bare Python, numpy, dhlib and the peers, by turns."""
    statements = {"bare Python": "pass", "numpy": "import numpy", "dhlib": "import dhlib"}
    statements |= {name: f"import {MODULES.get(name, name)}" for name in sys.argv[1:]}
    runs: dict[str, list[tuple[float, float]]] = {name: [] for name in statements}
    for statement in statements.values():
        cost(statement)
    for _ in range(ROUNDS):
        for name, statement in statements.items():
            runs[name].append(cost(statement))
    bare = [median(column) for column in zip(*runs["bare Python"], strict=True)]
    rows = [
        {
            "peer": name,
            "cpu_ms": median(ms for ms, _ in taken) - bare[0],
            "memory_mb": median(mb for _, mb in taken) - bare[1],
        }
        for name, taken in runs.items()
        if name != "bare Python"
    ]
    json.dump({"python": sys.version.split()[0], "rows": rows}, sys.stdout)


if __name__ == "__main__":
    main()
