"""``make mutants``: change the code in one place at a time, and see whether a test notices.

cosmic-ray makes every change it knows; a seeded sample of each module's is tried, in a copy of the repository, with the
quickest tests that concern the module. A change that no test notices has survived: it is listed in
``bench/results/mutation.json``, and ``bench/mutants.md`` says of each that was looked at what came of it.

    python bench/mutation.py --each 20 --seed 1 --only conventions
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import random
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from environment import BENCH, ROOT, machine, python_of, version_of
from report import write_report

#: Modules, and the tests that must notice a change in them, the quickest first.
CONVENTIONS = "tests/dhlib/test_conventions.py tests/dhlib/test_transforms.py tests/dhlib/test_convert.py"
MARKER = (
    "tests/grading/test_answers.py tests/grading/test_tables.py tests/grading/test_marking.py "
    "tests/grading/test_misconceptions.py tests/grading/test_references_basics.py"
)
SUBJECTS = {
    "conventions": ("dhlib/conventions.py", f"{CONVENTIONS} dhlib/conventions.py"),
    "transforms": ("dhlib/transforms.py", f"{CONVENTIONS} dhlib/transforms.py"),
    "convert": ("dhlib/convert.py", f"{CONVENTIONS} dhlib/convert.py dhlib/chain.py"),
    "scalars": ("dhlib/scalars.py", f"{CONVENTIONS} dhlib/scalars.py tests/dhlib/test_symbolic.py"),
    "answers": ("dhlib/grading/answers.py", f"dhlib/grading/answers.py {MARKER}"),
    "marking": ("dhlib/grading/marking.py", f"dhlib/grading/marking.py {MARKER}"),
    "misconceptions": ("dhlib/grading/misconceptions.py", f"dhlib/grading/misconceptions.py {MARKER}"),
}
#: Exercises in whose tests a change of the marker must show; the tests of the others take minutes.
OTHERS = ["transforms", "one_link", "quickshot", "puma560", "pa10", "scara", "axes_to_table", "convert", "same_arm"]
#: Longer than this, and the change is a loop without end.
PATIENCE = 900
CHANGED_LINE = re.compile(r"[+-](?![+-]{2})")


def sampled(module: str, tests: str, each: int, seed: int) -> list[dict[str, Any]]:
    """Try a sample of the changes of one module."""
    home = python_of("cosmic_ray").parent
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "copy"
        ignore = shutil.ignore_patterns("__pycache__", ".*", "node_modules", "_build", "dist")
        shutil.copytree(ROOT, folder, ignore=ignore)
        quickest = f"-k 'not ({' or '.join(OTHERS)})'" if "grading" in module else ""
        command = f"{sys.executable} -m pytest -q -x -n0 -p no:cacheprovider {tests} {quickest}"
        (folder / "mutation.toml").write_text(
            f'[cosmic-ray]\nmodule-path = "{module}"\ntimeout = {PATIENCE}\nexcluded-modules = []\n'
            f"test-command = {json.dumps(command)}\n"
            '[cosmic-ray.distributor]\nname = "local"\n'
        )
        surroundings = os.environ | {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}

        def ray(*words: str) -> str:
            said = subprocess.run(
                [home / "cosmic-ray", *words], cwd=folder, env=surroundings, capture_output=True, text=True, check=False
            )
            if said.returncode:
                raise SystemExit(f"cosmic-ray {words[0]}: {(said.stdout + said.stderr)[-2000:]}")
            return said.stdout

        ray("init", "mutation.toml", "session.sqlite")
        ray("baseline", "mutation.toml")  # the tests pass as things are
        total = keep_some(folder / "session.sqlite", each, seed)
        ray("exec", "mutation.toml", "session.sqlite")
        rows = []
        for line in ray("dump", "session.sqlite").splitlines():
            item, result = json.loads(line)
            (change,) = item["mutations"]
            rows.append(
                {
                    "line": change["start_pos"][0],
                    "operator": change["operator_name"].removeprefix("core/"),
                    # A test that had to be stopped noticed too, but on a busy machine perhaps for another reason.
                    "outcome": "stopped" if result["output"] == "timeout" else result["test_outcome"],
                    "diff": [row for row in result["diff"].splitlines() if CHANGED_LINE.match(row)],
                }
            )
    print(f"  {module}: {sum(row['outcome'] == 'survived' for row in rows)} of {len(rows)} survived", file=sys.stderr)
    return [{"module": module, "changes": total, **row} for row in rows]


def keep_some(session: Path, each: int, seed: int) -> int:
    """Leave a sample in cosmic-ray's list of work; return how many changes there were."""
    with sqlite3.connect(session) as database:
        # A changed annotation is no changed program, and | between types is the annotation's.
        database.execute("DELETE FROM mutation_specs WHERE operator_name LIKE '%BinaryOperator_BitOr%'")
        database.execute("DELETE FROM work_items WHERE job_id NOT IN (SELECT job_id FROM mutation_specs)")
        order = "module_path, start_pos_row, start_pos_col, operator_name, occurrence"
        jobs = [job for (job,) in database.execute(f"SELECT job_id FROM mutation_specs ORDER BY {order}")]
        kept = set(random.Random(seed).sample(jobs, min(each, len(jobs))))
        for job in jobs:
            if job not in kept:
                database.execute("DELETE FROM mutation_specs WHERE job_id = ?", (job,))
                database.execute("DELETE FROM work_items WHERE job_id = ?", (job,))
    return len(jobs)


def main() -> None:
    """Try, and keep what survived."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", type=int, default=20, help="changes of each module (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1955)
    parser.add_argument("--only", nargs="*", default=list(SUBJECTS), choices=list(SUBJECTS))
    chosen = parser.parse_args()
    target = BENCH / "results" / "mutation.json"
    for name in chosen.only:
        module, tests = SUBJECTS[name]
        rows = sampled(module, tests, chosen.each, chosen.seed)
        stored = json.loads(target.read_text("utf-8"))["rows"] if target.exists() else []
        kept = [row for row in stored if row["module"] != module] + rows
        about = {"date": datetime.date.today().isoformat(), "machine": machine(), "seed": chosen.seed}
        about["versions"] = {"cosmic-ray": version_of(python_of("cosmic_ray"), "cosmic-ray")}
        for row in rows:
            if row["outcome"] == "survived":
                print(f"{module}:{row['line']} {row['operator']}", *row["diff"], sep="\n    ")
        text = json.dumps(about | {"rows": kept}, indent=1, ensure_ascii=False, sort_keys=True)
        target.write_text(text + "\n", encoding="utf-8")
    write_report(BENCH / "results", BENCH / "RESULTS.md")


if __name__ == "__main__":
    main()
