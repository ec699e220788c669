"""The page on exercises of one's own: its commands run, on a robot from a URDF and from a table."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from dhlib import DHError, robots
from dhlib.cli import main
from dhlib.grading.check import Checker, CheckFailed
from dhlib.grading.course.robot_files import read_robot

URDF = """<robot name="Our arm">
<joint name="a" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.3"/>
<axis xyz="0 0 1"/></joint>
<joint name="b" type="continuous"><parent link="l1"/><child link="l2"/><origin xyz="0.05 0 0.1" rpy="0 0.3 0"/>
<axis xyz="0 1 0"/></joint>
<joint name="c" type="prismatic"><parent link="l2"/><child link="l3"/><origin xyz="0.2 0 0"/><axis xyz="1 0 0"/></joint>
<joint name="f" type="fixed"><parent link="l3"/><child link="hand"/><origin xyz="0.1 0 0.02" rpy="0.1 0 0"/></joint>
</robot>
"""
TABLE = "joint;theta;d;a;alpha\nR;0;0.4;0.025;-90\nR;-90;0;0.455;0\nP;0;0.1;0.035;-90\n"


@pytest.mark.notebooks
def test_the_commands_of_the_page_run_one_after_the_other(root: Path, tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "our_arm.urdf").write_text(URDF, "utf-8")
    (tmp_path / "roster.csv").write_text("id,name\na1,Ada\nb2,Bo\n", "utf-8")
    page = (root / "book" / "own_exercise.md").read_text("utf-8")
    commands = [line for block in re.findall(r"^```sh\n(.*?)^```", page, re.S | re.M) for line in block.splitlines()]
    assert len(commands) == 6
    said = {}
    for command in commands:
        program, *words = command.split()
        if program == "dhlib":
            assert main(words) == 0, (command, capsys.readouterr())
            said[words[0]] = capsys.readouterr().out
        else:
            done = subprocess.run([sys.executable, *words], cwd=tmp_path, capture_output=True, text=True, check=False)
            assert done.returncode == 0, done.stderr
    assert ",5,5," in (tmp_path / "marks" / "grades.csv").read_text("utf-8-sig")
    assert "5 of 5 points" in said["solution"]
    assert len(list((tmp_path / "week-1").glob("*.ipynb"))) == 2


def test_a_new_exercise_is_checked_and_shows_nothing_of_its_solution(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "t.csv").write_text(TABLE, "utf-8")
    assert main(["new-exercise", "ours", "--robot", "t.csv", "--degrees", "--convention", "modified"]) == 0
    arm = read_robot("t.csv", "modified", degrees=True)
    check = Checker("ours")
    exercise = check._marker.exercise
    (q,) = exercise.part("T").asks.probes[0]
    check("T", arm.T(0, 3, q))
    with pytest.raises(CheckFailed):
        check("A1", arm.A(2, q))
    student = json.loads((tmp_path / "exercises" / "ours.ipynb").read_text("utf-8"))
    assert "turn_x" not in json.dumps(student)
    assert main(["new-exercise", "ours"]) == 2
    assert main(["new-exercise", "../ours"]) == 2


def test_a_urdf_is_read_as_its_joints_say(tmp_path: Path) -> None:
    """By hand, without dhlib: down the chain, joint by joint."""
    (tmp_path / "r.urdf").write_text(URDF, "utf-8")
    arm = read_robot(tmp_path / "r.urdf")
    assert arm.kinds == "RRP"
    q = np.array([0.4, -0.7, 0.15])

    def moved(x, z, turn):
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = turn, (x, 0, z)
        return T

    def about(axis, angle):
        c, s = np.cos(angle), np.sin(angle)
        j, k = {0: (1, 2), 1: (2, 0), 2: (0, 1)}[axis]
        R = np.eye(3)
        R[[j, j, k, k], [j, k, j, k]] = c, -s, s, c
        return R

    T = moved(0, 0.3, about(2, q[0])) @ moved(0.05, 0.1, about(1, 0.3) @ about(1, q[1]))
    T = T @ moved(0.2 + q[2], 0, np.eye(3)) @ moved(0.1, 0.02, about(0, 0.1))
    assert np.abs(arm.fk(q) - T).max() < 1e-9
    assert np.abs(arm.fk(-q) - T).max() > 0.01  # negative control


def test_a_joint_without_a_place_stands_where_the_one_before_does(tmp_path: Path) -> None:
    for name, origin in (("said", '<origin xyz="0 0 0"/>'), ("left out", "")):
        (tmp_path / name).write_text(URDF.replace('<origin xyz="0 0 0.3"/>', origin), "utf-8")
    said, left_out = (read_robot(tmp_path / name) for name in ("said", "left out"))
    assert np.array_equal(left_out.fk([0.4, -0.7, 0.15]), said.fk([0.4, -0.7, 0.15]))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "should have the headings"),
        ("a,b\n1,2\n", "should have the headings theta, d, a and alpha"),
        ("theta,d,a,alpha\n1,2\n", "should have 4 cells"),
        ("<robot>", "is no URDF"),
        ("<robot/>", "one link should be the root"),
        ('<robot><joint name="j" type="fixed"/></robot>', "'j' has no parent"),
        (URDF.replace('"0 0 0.3"', '"0 0"'), "should be three numbers"),
        (URDF.replace('child link="hand"', 'child link="l1"'), "lead in a circle, back to the link 'l1'"),
        (URDF.replace("revolute", "fixed").replace("continuous", "fixed").replace("prismatic", "fixed"), "no joint"),
    ],
)
def test_a_robot_that_cannot_be_read_is_named(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "r").write_text(text, "utf-8")
    with pytest.raises(DHError, match=words):
        read_robot(tmp_path / "r")


def test_a_file_that_is_too_large_for_a_robot_is_not_read(tmp_path: Path) -> None:
    with (tmp_path / "r").open("wb") as file:
        file.truncate(20_000_001)
    with pytest.raises(DHError, match="r is larger than 20 MB, which is no robot"):
        read_robot(tmp_path / "r")


def test_the_quickshot_is_taken_without_a_robot(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new-exercise", "first"]) == 0
    chain = Checker("first")._marker.exercise.arm
    q = [0.1, 0.2, 0.3, 0.4]
    assert np.abs(chain.fk(q) - robots.quickshot().fk(q)).max() < 1e-12
