"""``make bench``: every workload, ours beside its peers, into bench/results and bench/RESULTS.md.

``python bench/run.py NAME …`` runs only those; without a name, all. What one run measured is kept in
``bench/results/NAME.json`` until that workload runs again. With ``--small`` each does a little of its work, into
``.bench/small``: that shows that it runs, and is no measurement.
"""

from __future__ import annotations

import argparse
import compileall
import datetime
import json
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from environment import BENCH, ENVIRONMENTS, ROOT, NotToBeHad, environment_variables, machine, python_of, version_of
from report import write_report

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
WITH_SYMPY = {"sympy_trigsimp": "sympy", "sympy_simplify": "sympy", "roboticstoolbox": "roboticstoolbox-python"}


@dataclass(frozen=True)
class Workload:
    """A program that prints what it measured, as one JSON object.

    Parameters
    ----------
    program : str
        In this folder.
    peers : mapping
        Each is measured in an environment of its own, by a run of the program with its name; the value is the
        distribution whose version is told. Without peers the program runs once, in the book's own environment, and
        sets up what it compares with by itself.
    homes : mapping
        The environments of peers that live in another's.
    missing : mapping
        What cannot be had by anybody who runs this, and why.
    minutes : float
        Longer than this it is given up.
    """

    program: str
    peers: Mapping[str, str] = field(default_factory=dict)
    homes: Mapping[str, str] = field(default_factory=dict)
    missing: Mapping[str, str] = field(default_factory=dict)
    minutes: float = 30


WORKLOADS = {
    "forward": Workload("kinematics/forward.py", KINEMATICS | LIMITS, {"memory": "numba"}),
    "accuracy": Workload("kinematics/accuracy.py", KINEMATICS),
    "symbolic": Workload(
        "kinematics/symbolic.py",
        WITH_SYMPY,
        dict.fromkeys(WITH_SYMPY, "roboticstoolbox"),
        missing={"sympybotics": "not on the Python package index"},
    ),
    "placing": Workload(
        "kinematics/placing.py",
        {"idyntree": "idyntree"},
        missing={"urdf_to_dh": "a ROS package, not on the Python package index"},
    ),
    "sameness": Workload("kinematics/sameness.py"),
    "imports": Workload("kinematics/imports.py", KINEMATICS),
    "grading": Workload("grading/compare.py", minutes=240),
    "many": Workload("grading/many.py", minutes=240),
    "hostile": Workload("grading/hostile.py", minutes=240),
    "building": Workload("book/building.py", minutes=120),
    "pages": Workload("book/pages.py", minutes=120),
    "live": Workload("book/live.py", minutes=60),
}


def said_by(python: str | Path, program: str, *arguments: str, minutes: float, small: bool) -> dict[str, Any]:
    """Run a program in an environment; return what it prints.

    Raises
    ------
    NotToBeHad
        If it fails; nothing is left out silently.
    """
    try:
        said = subprocess.run(
            [python, BENCH / program, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE if arguments else None,  # what runs once says how far it is
            text=True,
            cwd=ROOT,
            env=environment_variables(small),
            timeout=60 * minutes,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise NotToBeHad(f"not ready after {minutes:g} minutes") from None
    if said.returncode != 0:
        last = (said.stderr or "").strip().splitlines()[-1:] or [f"ended with {said.returncode}"]
        raise NotToBeHad(f"failed: {last[0][:300]}")
    found: dict[str, Any] = json.loads(said.stdout[said.stdout.index("{") :])
    return found


def measured(name: str, small: bool) -> dict[str, Any]:
    """Run one workload against every peer; what cannot be had is named."""
    work = WORKLOADS[name]
    if not work.peers:
        return said_by(sys.executable, work.program, minutes=work.minutes, small=small)
    result: dict[str, Any] = {"rows": [], "versions": {}, "missing": dict(work.missing)}
    for peer, distribution in work.peers.items():
        print(f"  {name}: {peer}", flush=True)
        try:
            python = python_of(work.homes.get(peer, peer))
            result["rows"] += said_by(python, work.program, peer, minutes=work.minutes, small=small)["rows"]
            result["versions"][peer] = version_of(python, distribution)
        except NotToBeHad as why:
            result["missing"][peer] = str(why)
    return result


def main() -> int:
    """Run what was named."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(WORKLOADS)}; all if none")
    parser.add_argument("--small", action="store_true", help="a little of each, to see that it runs")
    chosen = parser.parse_args()
    if unknown := [name for name in chosen.names if name not in WORKLOADS]:
        parser.error(f"There is no workload {unknown[0]!r}; there are {', '.join(WORKLOADS)}.")
    results = ENVIRONMENTS / "small" if chosen.small else BENCH / "results"
    results.mkdir(parents=True, exist_ok=True)
    compileall.compile_dir(ROOT / "dhlib", quiet=1)  # as whatever is installed is, and the peers are
    failed = 0
    for name in chosen.names or WORKLOADS:
        print(f"── {name} ──", flush=True)
        about = {"date": datetime.date.today().isoformat(), "machine": machine()}
        try:
            result = measured(name, chosen.small)
        except NotToBeHad as why:
            print(f"{name}: {why}", file=sys.stderr)
            failed += 1
            continue
        text = json.dumps(about | result, indent=1, ensure_ascii=False, sort_keys=True)
        (results / f"{name}.json").write_text(text + "\n", encoding="utf-8")
    write_report(results, results / "RESULTS.md" if chosen.small else BENCH / "RESULTS.md")
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main())
