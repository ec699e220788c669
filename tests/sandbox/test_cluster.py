"""Two workers, one worker and a cluster of processes give the same marks; a cluster loses workers and nothing else."""

import dataclasses
import json
import os
import signal
import threading
import time
from pathlib import Path

import pytest
from sampling import FULL

from dhlib.errors import DHError
from dhlib.grading.batch import cluster
from dhlib.grading.batch.cluster import Certificates, Cluster, check_address, job_of, run_in_box
from dhlib.grading.batch.pool import Pool
from dhlib.grading.batch.run import grade_class
from dhlib.grading.batch.store import Store
from dhlib.grading.batch.work import Grader, Settings, Work
from dhlib.grading.wall import Limits

from .conftest import walls_or_skip

EXERCISE = """
from dhlib import robots
from dhlib.grading.exercise import Exercise, Part
from dhlib.grading.forms import Choice

ASKED = Choice({"a": "Yes.", "b": "No."}, "a")
EXERCISE = Exercise("tiny", "Tiny", robots.planar(2), [Part(p, "Pick", 1, ASKED) for p in ("p", "q")])
"""
ANSWERS = [
    "'a'",
    "'b'",
    "chr(97)",
    "...",
    "1 / 0",
    "'aa'[np.random.default_rng(3).integers(2)]",
    "float('nan')",
    "['a'] * 3",
    "__import__('os')._exit(1)",
    "'a' if __import__('os').getpid() else ''",
]


def notebook(first, second):
    cells = [
        ("setup", "", "import numpy as np"),
        ("answer", "p", f"p = {first}"),
        ("check", "p", 'check("p", p)'),
        ("answer", "q", f"q = {second}"),
        ("check", "q", 'check("q", q)'),
    ]
    return json.dumps(
        {
            "cells": [
                {"cell_type": "code", "source": source, "metadata": {"dh": {"role": role, "part": part}}}
                for role, part, source in cells
            ],
            "metadata": {"dh": {"exercise": "tiny"}},
            "nbformat": 4,
        }
    )


@pytest.fixture(scope="module")
def exercises(tmp_path_factory):
    folder = tmp_path_factory.mktemp("exercises")
    (folder / "tiny.py").write_text(EXERCISE)
    (folder / "tiny.ipynb").write_text(notebook("...", "..."))
    return folder


@pytest.fixture(scope="module")
def class_(tmp_path_factory):
    """Many notebooks: right, wrong, broken, deadly, and some that are none."""
    folder = tmp_path_factory.mktemp("class")
    for k in range(200 if FULL else 40):
        (folder / f"s{k:03}").mkdir()
        first, second = ANSWERS[k % 10] if k % 50 == 8 or k % 10 != 8 else "'a'", ANSWERS[(k // 10) % 8]
        content = "{" if k % 25 == 7 else notebook(first, second)
        (folder / f"s{k:03}" / "tiny.ipynb").write_text(content)
    return folder


@pytest.fixture(scope="module")
def settings(exercises, walls):
    return Settings(exercises=exercises, limits=Limits.of(30))


@pytest.fixture(scope="module")
def local():
    """A scheduler and two workers, each a process of its own."""
    from distributed import LocalCluster

    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, memory_limit=0
    ) as cluster:
        yield cluster


def dying():
    """What a worker does instead: one of the students ends its process."""

    def run(student):  # inside, so that it is sent as it is: the workers cannot import this module
        import os

        if student == "deadly":
            os._exit(1)
        return {"readings": {"p": {"choice": "a"}}}

    return run


def rows(out):
    """Every row, but for what a clock says."""
    unlike = {"id": 0, "seconds": 0.0, "graded_at": ""}
    with Store(out) as store:
        return {
            s.source: (dataclasses.replace(s, **unlike), [dataclasses.astuple(mark) for mark in store.marks(s.id)])
            for s in store.submissions()
        }


@pytest.mark.sandbox
def test_many_notebooks_get_the_same_marks_everywhere(class_, settings, local, tmp_path):
    for name, workers in (
        ("one", Pool(settings, 1)),
        ("two", Pool(settings, 2)),
        ("cluster", Cluster(settings, local.scheduler_address)),
    ):
        with workers:
            grade_class([class_], tmp_path / name, settings, workers)
    one, two, cluster = (rows(tmp_path / name) for name in ("one", "two", "cluster"))
    assert len(one) == len(list(class_.iterdir()))
    assert one == two
    assert one == cluster
    assert {row[0].status for row in one.values()} == {"graded", "unreadable"}
    assert len({row[0].points for row in one.values()}) == 3


@pytest.mark.sandbox
def test_a_worker_of_the_cluster_that_is_killed_costs_nothing(class_, settings, local, tmp_path):
    victims = [worker.process.process.pid for worker in local.workers.values()][:1]
    killed = threading.Event()

    def kill():
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            time.sleep(0.02)
            file = tmp_path / "out" / "results.sqlite"
            if file.exists() and file.stat().st_size:
                with Store(tmp_path / "out", create=True) as store:
                    if len(store.submissions()) >= 3:
                        break
        for victim in victims:
            os.kill(victim, signal.SIGKILL)
        killed.set()

    small = [folder for k, folder in enumerate(sorted(class_.iterdir())) if k < 40]
    thread = threading.Thread(target=kill)
    thread.start()
    with Cluster(settings, local.scheduler_address) as workers:
        summary = grade_class(small, tmp_path / "out", settings, workers)
    thread.join()
    assert killed.is_set()
    assert summary.status.get("failed", 0) == 0
    with Store(tmp_path / "out") as store:
        assert len(store.submissions()) == 40


def test_a_notebook_that_kills_workers_is_given_up(local, exercises, monkeypatch):
    monkeypatch.setattr("dhlib.grading.batch.cluster.run_in_box", dying())
    monkeypatch.setattr("dhlib.grading.batch.cluster.job_of", lambda prepared, limits: prepared.work.student)
    works = [Work(k, "tiny.ipynb", name, notebook("'a'", "'b'").encode()) for k, name in enumerate(["x", "deadly"])]
    with Cluster(Settings(exercises=exercises), local.scheduler_address) as workers:
        graded = {one.number: one for one in workers.grade(works)}
    assert graded[0].status == "graded"
    assert graded[1].status == "failed"
    assert "2 times" in graded[1].message


@pytest.mark.sandbox
def test_a_worker_of_the_cluster_keeps_its_box_for_notebooks_of_the_same_limits(exercises):
    walls_or_skip()
    work = Work(0, "tiny.ipynb", "x", notebook("'a'", "'b'").encode())
    prepared = Grader(Settings(exercises=exercises)).prepare(work)
    jobs = [json.loads(json.dumps(job_of(prepared, Limits.of(seconds)))) for seconds in (60, 60, 90)]
    done, boxes = [], []

    def work_through():
        for job in jobs:
            done.append(run_in_box(job)["readings"])
            boxes.append(cluster._here.sandbox)
        boxes[-1].close()

    worker = threading.Thread(target=work_through)
    worker.start()
    worker.join()
    assert done == [{"p": {"choice": "a"}, "q": {"choice": "b"}}] * 3
    assert boxes[0] is boxes[1] is not boxes[2]
    assert boxes[0]._box is None


def test_a_worker_of_the_cluster_with_another_dhlib_refuses():
    with pytest.raises(DHError, match=r"it has dhlib \S+, and here it is 0\.0\.1\."):
        run_in_box({"dhlib": "0.0.1"})


def test_messages_name_nobody(exercises):
    about = json.loads(notebook("'a'", "'b'"))
    about["metadata"]["dh"]["student"] = "Ada Lovelace"
    work = Work(0, "Ada Lovelace.ipynb", "Ada Lovelace", json.dumps(about).encode())
    prepared = Grader(Settings(exercises=exercises)).prepare(work)
    sent = repr(job_of(prepared, Limits()))
    assert "p = 'a'" in sent
    assert "Ada" not in sent
    assert "Yes." not in sent


@pytest.mark.parametrize(
    "address", ["tcp://10.0.0.1:8786", "tcp://example.org:8786", "ucx://127.0.0.1:1", "127.0.0.1:8786", "tls://x", "x"]
)
def test_addresses_that_are_refused(address):
    with pytest.raises(DHError, match="tls://"):
        check_address(address)


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:8786", "tcp://[::1]:8786", "tcp://localhost:1", "tls://x:8786"])
def test_addresses_that_are_allowed(address):
    check_address(address)


def test_a_scheduler_that_is_not_there_is_said(exercises, monkeypatch):
    monkeypatch.setattr("dhlib.grading.batch.cluster.PATIENCE", 0.2)
    with pytest.raises(DHError, match="does not answer"):
        list(Cluster(Settings(exercises=exercises), "tcp://127.0.0.1:9").grade([]))


def test_no_cluster_without_boxes(exercises):
    with pytest.raises(DHError, match="this machine only"):
        Cluster(Settings(exercises=exercises, unsafe=True), "tcp://127.0.0.1:9")


def test_the_cluster_may_be_reached_by_tls(tmp_path, exercises, monkeypatch):
    from distributed import LocalCluster
    from distributed.security import Security

    monkeypatch.setattr("dhlib.grading.batch.cluster.run_in_box", dying())
    monkeypatch.setattr("dhlib.grading.batch.cluster.job_of", lambda prepared, limits: prepared.work.student)
    monkeypatch.setattr("dhlib.grading.batch.cluster.PATIENCE", 10)
    security = Security.temporary()
    files = {}
    for name, text in (
        ("ca", security.tls_ca_file),
        ("cert", security.tls_client_cert),
        ("key", security.tls_client_key),
    ):
        files[name] = Path(tmp_path / name)
        files[name].write_text(text)
    work = Work(0, "tiny.ipynb", "x", notebook("'a'", "'b'").encode())
    with LocalCluster(
        n_workers=1, processes=False, dashboard_address=None, security=security, protocol="tls://"
    ) as cluster:
        address = cluster.scheduler_address
        assert address.startswith("tls://")
        with Cluster(Settings(exercises=exercises), address, Certificates(**files)) as workers:
            assert [graded.status for graded in workers.grade([work])] == ["graded"]
        with pytest.raises(DHError, match="does not answer"):
            list(Cluster(Settings(exercises=exercises), address.replace("tls", "tcp")).grade([work]))
