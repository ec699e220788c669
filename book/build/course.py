"""Build the edition for courses: without the worked solutions, and without what says which answers are right.

What it is built from is copied first, without them: so nothing can find its way into the site that is not in the copy.
The exercises are those of a course, whose `check` says of the form alone whether it is right.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import yaml

from dhlib.grading.course.editions import for_course
from dhlib.grading.derive import as_text
from dhlib.grading.exercise import load_exercise

ROOT = Path(__file__).parent.parent.parent
FOLDERS = ("book", "dhlib", "requirements", "bench")
FILES = ("_config.yml", "package-lock.json", "pyproject.toml", "pytest_dhlib.py", "README.md", "LICENSE")
LINKED = ("node_modules", ".tools")
#: What no page of this edition may come from.
LEFT_OUT = "solutions/"


def stage(root: Path, into: Path) -> Path:
    """Copy what the edition is built from; what was executed before is kept."""
    into.mkdir(parents=True, exist_ok=True)
    for old in into.iterdir():
        if old.name != "_build":
            old.unlink() if old.is_symlink() or old.is_file() else shutil.rmtree(old)
    ignore = shutil.ignore_patterns("__pycache__", ".ipynb_checkpoints", "_exercises", "node_modules")
    for folder in FOLDERS:
        shutil.copytree(root / folder, into / folder, ignore=ignore)
    for file in FILES:
        if (root / file).is_file():
            shutil.copyfile(root / file, into / file)
    for folder in LINKED:
        if (root / folder).exists():
            (into / folder).symlink_to((root / folder).resolve())
    (into / "exercises").mkdir()
    for path in sorted((root / "exercises").glob("*.ipynb")):
        exercise = load_exercise(path.stem, root / "exercises")
        notebook = for_course(json.loads(path.read_text("utf-8")), exercise)
        (into / "exercises" / path.name).write_text(as_text(notebook), "utf-8")
    contents = without_solutions(yaml.safe_load((root / "_toc.yml").read_text("utf-8")))
    (into / "_toc.yml").write_text(yaml.safe_dump(contents, sort_keys=False, allow_unicode=True), "utf-8")
    return into


def without_solutions(contents: Any) -> Any:
    """A table of contents without the pages of solutions, and without parts that are left with no page."""
    if isinstance(contents, list):
        kept = [without_solutions(item) for item in contents]
        return [item for item in kept if item is not None]
    if not isinstance(contents, dict):
        return contents
    if str(contents.get("file", "")).startswith(LEFT_OUT):
        return None
    kept_entries = {key: without_solutions(value) for key, value in contents.items()}
    return None if kept_entries.get("chapters") == [] else kept_entries


def build(source: Path, site: Path) -> int:
    """Build the book of a staged folder with the library that lies in it."""
    return subprocess.run(
        [sys.executable, "-c", "from jupyter_book.cli.main import main; main()", "build", str(source)]
        + ["--path-output", str(site), "-n", "-W", "--keep-going"],
        cwd=source,
        env=os.environ | {"PYTHONPATH": str(source)},
        check=False,
    ).returncode


def main() -> int:
    """Stage and build."""
    parser = argparse.ArgumentParser(description=str(__doc__).split("\n", 1)[0])
    parser.add_argument("into", type=Path, help="folder for the copy and the site")
    into = parser.parse_args().into.resolve()
    code = build(stage(ROOT, into / "source"), into)
    if code == 0:
        print(f"\nThe edition for courses: {(into / '_build' / 'html' / 'index.html').as_uri()}")
    return code


if __name__ == "__main__":
    sys.exit(main())
