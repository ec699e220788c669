"""Grade on a cluster of `dask.distributed`: notebooks are read and marked here, and only their boxes run there.

What is sent is the code of a merged notebook, what to ask of it, and its limits: no name of a file or of a student, no
reference, no key. What comes back are the answers. The code runs in a box there as it would here, never in the process
of the cluster's own worker.
"""

from __future__ import annotations

import atexit
import contextlib
import importlib
import ipaddress
import threading
import time
import uuid
from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from dhlib.errors import DHError
from dhlib.grading.batch.pool import TRIES
from dhlib.grading.batch.versions import versions
from dhlib.grading.batch.work import Graded, Grader, Prepared, Settings, Work, broken, failed
from dhlib.grading.notebook import Cell
from dhlib.grading.wall import Limits, Outcome, Sandbox

#: How long to wait for the scheduler, and for its first worker.
PATIENCE = 30.0
#: Submissions under way for each thread of the cluster: one that runs, and one that waits behind it.
AHEAD = 2


@dataclass(frozen=True)
class Certificates:
    """What proves who is who to a scheduler with TLS.

    Parameters
    ----------
    ca, cert, key : Path, optional
        Certificate of the authority, certificate of the client, and its private key.
    """

    ca: Path | None = None
    cert: Path | None = None
    key: Path | None = None


class Cluster:
    """The workers of a scheduler.

    Parameters
    ----------
    settings : Settings
    scheduler : str
        Its address: ``tls://…``, or ``tcp://…`` on this very machine.
    certificates : Certificates

    Raises
    ------
    DHError
        If the address is not allowed, or `distributed` is not installed.
    """

    def __init__(self, settings: Settings, scheduler: str, certificates: Certificates | None = None) -> None:
        if settings.unsafe:
            raise DHError("--unsafe-no-sandbox is for this machine only: a cluster runs notebooks in their boxes.")
        check_address(scheduler)
        distributed()
        self._settings, self._scheduler = settings, scheduler
        self._certificates = certificates or Certificates()
        self._grader = Grader(settings)

    def __enter__(self) -> Cluster:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def grade(self, works: Iterable[Work]) -> Iterator[Graded]:
        """Grade all, and give each as soon as it is done.

        Raises
        ------
        DHError
            If the scheduler is not there, has no workers, or they cannot run a box.
        """
        with self._client() as client, _tries(client):
            source = iter(works)
            under_way: dict[str, tuple[Prepared, float]] = {}
            futures = distributed().as_completed(loop=client.loop)
            try:
                yield from self._feed(client, source, futures, under_way)
                for future in futures:
                    prepared, since = under_way.pop(future.key)
                    yield self._finish(prepared, future, since)
                    future.release()
                    yield from self._feed(client, source, futures, under_way)
            finally:
                client.cancel(list(futures.futures))

    def _feed(
        self, client: Any, source: Iterator[Work], futures: Any, under_way: dict[str, tuple[Prepared, float]]
    ) -> Iterator[Graded]:
        """Send as many as the cluster can chew; those that need no box are done at once."""
        room = max(1, sum(client.nthreads().values())) * AHEAD
        while len(under_way) < room:
            work = next(source, None)
            if work is None:
                return
            try:
                prepared = self._grader.prepare(work)
            except DHError:
                raise
            except Exception as error:  # ours to mend; the others should not suffer
                yield failed(work.number, broken(error))
                continue
            if isinstance(prepared, Graded):
                yield prepared
                continue
            key = f"dhlib-{uuid.uuid4().hex}"
            under_way[key] = (prepared, time.monotonic())
            futures.add(client.submit(run_in_box, job_of(prepared, self._settings.limits), key=key, pure=False))

    def _finish(self, prepared: Prepared, future: Any, since: float) -> Graded:
        killed = distributed().scheduler.KilledWorker
        number = prepared.work.number
        try:
            outcome = Outcome(**future.result())
            return self._grader.finish(prepared, outcome, round(time.monotonic() - since, 3))
        except killed:
            return failed(number, f"The workers that graded it ended, {TRIES} times. Please report this.")
        except DHError as error:
            raise DHError(f"a worker of the cluster cannot grade: {error}") from None
        except Exception as error:
            return failed(number, broken(error))

    def _client(self) -> Any:
        options: dict[str, Any] = {}
        if self._scheduler.startswith("tls:"):
            files = {
                name: str(path)
                for name, path in (
                    ("tls_ca_file", self._certificates.ca),
                    ("tls_client_cert", self._certificates.cert),
                    ("tls_client_key", self._certificates.key),
                )
                if path is not None
            }
            options["security"] = distributed().Security(require_encryption=True, **files)
        try:
            client = distributed().Client(
                self._scheduler, timeout=PATIENCE, name="dhlib", set_as_default=False, **options
            )
        except (OSError, TimeoutError, ValueError, TypeError) as error:
            raise DHError(
                f"the scheduler {self._scheduler} does not answer: {error or type(error).__name__}."
            ) from None
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            client.close()
            raise DHError(f"the scheduler {self._scheduler} has no workers; start some with `dask worker`.") from None
        return client


def distributed() -> Any:
    """The engine, which is an extra; raises DHError if it is not installed."""
    try:
        return importlib.import_module("distributed")
    except ImportError:
        raise DHError("--scheduler needs `distributed`: pip install 'dhlib[cluster]'.") from None


def check_address(scheduler: str) -> None:
    """Make sure that nothing goes over a network unencrypted.

    Raises
    ------
    DHError
        Unless it is ``tls://…``, or ``tcp://…`` on a loopback address.

    Examples
    --------
    >>> check_address("tls://scheduler.example:8786")
    >>> check_address("tcp://10.0.0.1:8786")
    Traceback (most recent call last):
    dhlib.errors.DHError: tcp://10.0.0.1:8786 would send students' work over the network for all to read: use tls://…
    """
    try:
        parts = urlsplit(scheduler)
        host, port = parts.hostname or "", parts.port
    except ValueError:
        host, port = "", None
    if not host or port is None or parts.scheme not in ("tls", "tcp"):
        raise DHError(f"{scheduler!r} is no address of a scheduler; it should be such as tls://host:8786.")
    if parts.scheme == "tls":
        return
    try:
        loopback = host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        loopback = False
    if not loopback:
        raise DHError(f"{scheduler} would send students' work over the network for all to read: use tls://…")


def job_of(prepared: Prepared, limits: Limits) -> dict[str, Any]:
    """All that a cluster is told of a submission."""
    return {
        "cells": [asdict(cell) for cell in prepared.ready.cells],
        "requests": prepared.ready.asked.requests,
        "limits": asdict(limits),
        "dhlib": versions()["dhlib"],
    }


_here = threading.local()


def run_in_box(job: dict[str, Any]) -> dict[str, Any]:
    """Run a notebook in a box of this thread of the cluster; this is what a worker of the cluster does.

    Raises
    ------
    DHError
        If no box can be built here, or another dhlib is installed here.
    """
    if job["dhlib"] != versions()["dhlib"]:
        raise DHError(f"it has dhlib {versions()['dhlib']}, and here it is {job['dhlib']}.")
    limits = Limits(**job["limits"])
    sandbox = getattr(_here, "sandbox", None)
    if sandbox is None or sandbox.limits != limits:
        if sandbox is not None:
            sandbox.close()
        sandbox = _here.sandbox = Sandbox(limits)
        atexit.register(sandbox.close)
    return asdict(sandbox.run([Cell(**cell) for cell in job["cells"]], job["requests"]))


@contextlib.contextmanager
def _tries(client: Any) -> Iterator[None]:
    """Have the scheduler give up what has killed as many workers as at home."""

    def allow(failures: int, dask_scheduler: Any = None) -> int:
        before: int = dask_scheduler.allowed_failures
        dask_scheduler.allowed_failures = failures
        return before

    before = client.run_on_scheduler(allow, TRIES - 1)
    try:
        yield
    finally:
        with contextlib.suppress(Exception):  # the scheduler may be gone, and then there is nothing to set back
            client.run_on_scheduler(allow, before)
