"""Parts for which dhlib's kinematics is closed: the page says so, and the solution does without."""

import builtins
import contextlib
import io
import re

from dhlib.grading.exercise import OWN_WORK

SENTENCE = re.compile(re.escape(OWN_WORK).replace(r"\{parts\}", r"(.+?)").replace(r"\ ", r"\s+"))


def test_the_page_says_for_which_parts_dhlib_is_closed(every, worked):
    told = set()
    for cell in worked["cells"]:
        if cell["cell_type"] == "markdown":
            for names in SENTENCE.findall("".join(cell["source"])):
                told.update(re.findall(r"`(\w+)`", names))
    assert told == {part.id for part in every.parts if not part.kinematics}


def run_closed(notebook, closed):
    """Run a notebook; in the cells of these parts nothing of dhlib is at hand."""
    names = {"__name__": "__main__"}
    true_import = builtins.__import__

    def without_dhlib(name, *args, **kwargs):
        if name.partition(".")[0] == "dhlib":
            raise ImportError("dhlib is closed")
        return true_import(name, *args, **kwargs)

    for cell in notebook["cells"]:
        if cell["cell_type"] != "code":
            continue
        shut = cell["metadata"]["dh"]["role"] == "answer" and cell["metadata"]["dh"]["part"] in closed
        hidden = {k: v for k, v in names.items() if shut and _is_of_dhlib(v)}
        for name in hidden:
            del names[name]
        names["__builtins__"] = {**vars(builtins), "__import__": without_dhlib if shut else true_import}
        with contextlib.redirect_stdout(io.StringIO()):
            exec("".join(cell["source"]), names)  # our own notebook
        names.update(hidden)
    return names


def _is_of_dhlib(value):
    return (getattr(value, "__module__", None) or type(value).__module__ or "").partition(".")[0] == "dhlib"


def test_solutions_do_without_where_dhlib_is_closed(every, worked):
    closed = {part.id for part in every.parts if not part.kinematics}
    assert {part.id for part in every.parts} <= set(run_closed(worked, closed))


def test_a_solution_that_uses_dhlib_would_be_seen():
    """Negative control."""
    about = {"dh": {"role": "answer", "part": "A"}}
    for source in ("from dhlib import Rz\nA = Rz(0.3)", "A = arm.fk([0, 0])", "A = link(0.1, 0, 1, 0)"):
        notebook = {
            "cells": [
                {
                    "cell_type": "code",
                    "metadata": {"dh": {"role": "setup"}},
                    "source": "from dhlib import robots, classic as link\narm = robots.planar(2)",
                },
                {"cell_type": "code", "metadata": about, "source": source},
            ]
        }
        run_closed(notebook, set())
        try:
            run_closed(notebook, {"A"})
        except (ImportError, NameError):
            continue
        raise AssertionError(source)
