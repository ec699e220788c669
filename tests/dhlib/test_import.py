"""Importing dhlib is light: neither sympy nor matplotlib, and nothing global is changed."""

import subprocess
import sys

import pytest


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()


USE = (
    "import dhlib, numpy as np; arm = dhlib.robots.puma560(); arm.fk([0]*6); arm.to_classic().frames(np.zeros((2, 6)));"
)


@pytest.mark.parametrize("heavy", ["sympy", "matplotlib", "pandas", "IPython", "dhlib.grading"])
def test_numbers_need_no_heavy_library(heavy):
    assert run(f"import sys; {USE} print({heavy!r} in sys.modules)") == "False"


def test_the_check_can_fail():
    assert run(f"import sys; {USE} dhlib.robots.planar(2).symbolic(); print('sympy' in sys.modules)") == "True"


def test_print_options_are_left_alone():
    assert (
        run(f"import numpy as np; before = np.get_printoptions(); {USE} print(before == np.get_printoptions())")
        == "True"
    )
