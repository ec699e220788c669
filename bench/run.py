"""``make bench``: every workload, ours beside its peers, into bench/results and bench/RESULTS.md.

``python bench/run.py NAME …`` runs only those; without a name, all. What one run measured is kept in
``bench/results/NAME.json`` until that workload runs again.
"""

from __future__ import annotations

import datetime
import json
import os
import platform
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from environment import BENCH, ROOT, NotToBeHad, environment_variables, python_of, version_of
from report import write_report

RESULTS = BENCH / "results"

#: Peers of the kinematics: environment, and the distribution whose version is told.
KINEMATICS = {
    "roboticstoolbox": "roboticstoolbox-python",
    "pinocchio": "pin",
    "modern_robotics": "modern_robotics",
    "pybotics": "pybotics",
    "ikpy": "ikpy",
    "visual_kinematics": "visual-kinematics",
    "kinpy": "kinpy",
}
LIMITS = {"numba": "numba", "memory": "numpy"}
#: What is on no package index, and so can be compared with by nobody who runs this.
NOT_ON_AN_INDEX = {
    "placing": {"urdf_to_dh": "a ROS package, not on the Python package index"},
    "symbolic": {"sympybotics": "not on the Python package index"},
}


def ask(peer: str, program: str, *arguments: str, minutes: float = 30) -> dict[str, Any]:
    """Run a workload in a peer's environment; return what it prints.

    Raises
    ------
    NotToBeHad
        If the peer cannot be installed or its part fails; nothing is left out silently.
    """
    python = python_of(peer)
    said = subprocess.run(
        [python, BENCH / program, *arguments],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=environment_variables(),
        timeout=60 * minutes,
        check=False,
    )
    if said.returncode != 0:
        raise NotToBeHad(
            f"failed: {said.stderr.strip().splitlines()[-1][:300] if said.stderr.strip() else said.returncode}"
        )
    found: dict[str, Any] = json.loads(said.stdout[said.stdout.index("{") :])
    return found


def over_peers(name: str, peers: dict[str, str], program: str, home: dict[str, str] | None = None) -> dict[str, Any]:
    """Run one workload against every peer; what cannot be had is named."""
    result: dict[str, Any] = {"rows": [], "versions": {}, "missing": dict(NOT_ON_AN_INDEX.get(name, {}))}
    for peer, distribution in peers.items():
        print(f"  {name}: {peer}", flush=True)
        environment = (home or {}).get(peer, peer)
        try:
            result["rows"] += ask(environment, program, peer)["rows"]
            result["versions"][peer] = version_of(python_of(environment), distribution)
        except (NotToBeHad, subprocess.TimeoutExpired) as why:
            result["missing"][peer] = str(why)
    return result


def forward() -> dict[str, Any]:
    """Forward kinematics: one call and many."""
    return over_peers("forward", KINEMATICS | LIMITS, "kinematics/forward.py", {"memory": "numba"})


def accuracy() -> dict[str, Any]:
    """Against 50 digits."""
    return over_peers("accuracy", KINEMATICS, "kinematics/accuracy.py")


def symbolic() -> dict[str, Any]:
    """T_6 in symbols."""
    peers = {"sympy_trigsimp": "sympy", "sympy_simplify": "sympy", "roboticstoolbox": "roboticstoolbox-python"}
    return over_peers("symbolic", peers, "kinematics/symbolic.py", dict.fromkeys(peers, "roboticstoolbox"))


def placing() -> dict[str, Any]:
    """Axes to tables."""
    return over_peers("placing", {"idyntree": "idyntree"}, "kinematics/placing.py")


def imports() -> dict[str, Any]:
    """What importing costs."""
    return over_peers("imports", KINEMATICS, "kinematics/imports.py")


def in_the_book(program: str, minutes: float) -> dict[str, Any]:
    """Run a workload in the book's own environment, which holds dhlib with its grader."""
    said = subprocess.run(
        [sys.executable, BENCH / program], stdout=subprocess.PIPE, text=True, cwd=ROOT, timeout=60 * minutes, check=True
    )
    found: dict[str, Any] = json.loads(said.stdout)
    return found


def grading() -> dict[str, Any]:
    """The same thirty notebooks."""
    return in_the_book("grading/compare.py", 120)


def hostile() -> dict[str, Any]:
    """One hostile notebook among honest ones."""
    return in_the_book("grading/hostile.py", 120)


WORKLOADS: dict[str, Callable[[], dict[str, Any]]] = {
    "forward": forward,
    "accuracy": accuracy,
    "symbolic": symbolic,
    "placing": placing,
    "imports": imports,
    "grading": grading,
    "hostile": hostile,
}


def machine() -> dict[str, Any]:
    """What it ran on."""
    model = platform.processor()
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), model)
    return {
        "processor": model,
        "cores": os.cpu_count(),
        "system": platform.system(),
        "python": platform.python_version(),
    }


def main() -> int:
    """Run what was named."""
    names = sys.argv[1:] or list(WORKLOADS)
    if unknown := [name for name in names if name not in WORKLOADS]:
        print(f"There is no workload {unknown[0]!r}; there are {', '.join(WORKLOADS)}.", file=sys.stderr)
        return 2
    RESULTS.mkdir(exist_ok=True)
    for name in names:
        print(f"── {name} ──", flush=True)
        result = WORKLOADS[name]()
        about = {"date": datetime.date.today().isoformat(), "machine": machine()}
        text = json.dumps(about | result, indent=1, ensure_ascii=False, sort_keys=True)
        (RESULTS / f"{name}.json").write_text(text + "\n", encoding="utf-8")
    write_report(RESULTS, BENCH / "RESULTS.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
