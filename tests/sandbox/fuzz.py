"""Fuzz the reader of notebooks and the reader of answers: nothing that is handed in may break them.

In the suite by Hypothesis (``test_fuzz.py``). For hours, led by coverage, in an environment of its own with dhlib's
dependencies and atheris:

    python tests/sandbox/fuzz.py notebooks CORPUS_FOLDER -max_total_time=3600
    python tests/sandbox/fuzz.py answers CORPUS_FOLDER -max_total_time=3600

The shortest of what it finds goes into ``tests/sandbox/found.json`` and so into the suite.
"""

from __future__ import annotations

import json
import sys
import warnings
from pathlib import Path

ROOT = Path(__file__).parents[2]


def targets():
    """What is fuzzed, by name: each takes bytes and raises only if something is wrong."""
    from dhlib.errors import DHError
    from dhlib.grading.course.papers import read_tag
    from dhlib.grading.exercise import load_exercise
    from dhlib.grading.marking import Marker
    from dhlib.grading.notebook import damage, load_notebook, merge, parse_notebook, read_cells
    from dhlib.grading.wall.reader import Refused, read_json

    pristine = read_cells(load_notebook(ROOT / "exercises" / "quickshot.ipynb"))
    exercise = load_exercise("quickshot", ROOT / "exercises")
    parts = {part.id for part in exercise.parts}

    def notebooks(data: bytes) -> None:
        try:
            notebook = parse_notebook(data, "fuzz.ipynb")
        except DHError:
            return
        assert isinstance(damage(notebook), str)
        cells = read_cells(notebook)
        json.dumps([cell.source for cell in merge(pristine, cells)]).encode()
        try:
            read_tag(notebook)
        except DHError:
            return

    def answers(data: bytes) -> None:
        readings = {}
        for line in data.split(b"\n"):
            try:
                message = read_json(line)
            except Refused:
                continue
            match message:
                case {"part": str(part), "reading": dict(reading)} if part in parts:
                    readings[part] = reading
        marks = Marker(exercise).mark_all(readings)
        for mark in marks:
            assert 0 <= mark.points <= mark.out_of
            mark.message.encode()

    return {"notebooks": notebooks, "answers": answers}


def main() -> None:
    """Fuzz one of them with atheris."""
    import atheris

    name = sys.argv.pop(1)
    warnings.simplefilter("ignore")
    with atheris.instrument_imports(include=["dhlib", "json"]):
        chosen = targets()[name]
    atheris.Setup(sys.argv, chosen)
    atheris.Fuzz()


if __name__ == "__main__":
    main()
