"""Worker processes on this machine: each grades one submission at a time, in a box of its own."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import Connection, wait
from typing import Any

from dhlib.errors import DHError
from dhlib.grading.batch.work import Graded, Grader, Settings, Work, failed, grade

#: How often a submission is tried whose worker died.
TRIES = 2
#: So many workers may die before their first result until there is no point in starting more.
MOST_DEAD_ON_ARRIVAL = 3
#: What a worker may take beyond the limit of a notebook, for starting its box and for marking.
EXTRA_SECONDS = 120.0

#: Ready, then one `Graded` for each `Work`; or a sentence that ends the whole run.
Answer = Graded | str | None
#: What a worker does with its submissions; others are for tests.
Job = Callable[[Settings], contextlib.AbstractContextManager[Callable[[Work], Graded]]]


@contextlib.contextmanager
def in_a_box(settings: Settings) -> Iterator[Callable[[Work], Graded]]:
    """Grade in a box that serves all submissions of this worker."""
    from dhlib.grading.wall import Sandbox

    grader = Grader(settings)
    with Sandbox(settings.limits, unsafe=settings.unsafe) as sandbox:
        yield lambda work: grade(grader, sandbox, work)


class Pool:
    """Some workers.

    A worker that dies is replaced, and its submission is tried once more; if that kills another one it is given up,
    with the status "failed".

    Parameters
    ----------
    settings : Settings
    workers : int
    job : callable
    """

    def __init__(self, settings: Settings, workers: int, job: Job = in_a_box) -> None:
        self._settings, self._job = settings, job
        # a fresh interpreter each: forking would take along locks of threads, and the store
        self._context = multiprocessing.get_context("spawn")
        self._size = workers
        self._workers: list[_Worker] = []
        self._dead_on_arrival = 0

    def __enter__(self) -> Pool:
        return self

    def __exit__(self, *_: object) -> None:
        for worker in self._workers:
            worker.end()

    def grade(self, works: Iterable[Work]) -> Iterator[Graded]:
        """Grade all, and give each as soon as it is done; no more are read from `works` than there are workers.

        Raises
        ------
        DHError
            If nothing can be graded: the exercise is broken, or no box can be built on this machine.
        """
        source = iter(works)
        again: deque[Work] = deque()
        tries: dict[int, int] = {}
        exhausted = False
        while True:
            while not exhausted or again:
                worker = self._idle(wanted=True)
                if worker is None:
                    break
                work = again.popleft() if again else next(source, None)
                if work is None:
                    exhausted = True
                    break
                worker.send(work)
            busy = [worker for worker in self._workers if worker.work is not None]
            if not busy:
                return
            for worker in self._ready(busy):
                work = worker.work
                assert work is not None
                answer = worker.receive()
                if isinstance(answer, str):
                    raise DHError(answer)
                if isinstance(answer, Graded):
                    tries.pop(answer.number, None)
                    yield answer
                    continue
                self._bury(worker)
                tries[work.number] = tries.get(work.number, 0) + 1
                if tries[work.number] < TRIES:
                    again.append(work)
                else:
                    tries.pop(work.number)
                    yield failed(work.number, f"The process that graded it ended, {TRIES} times. Please report this.")

    def _idle(self, wanted: bool) -> _Worker | None:
        for worker in self._workers:
            if worker.work is None:
                return worker
        if wanted and len(self._workers) < self._size:
            self._workers.append(_Worker(self._context, self._settings, self._job))
            return self._workers[-1]
        return None

    def _ready(self, busy: list[_Worker]) -> list[_Worker]:
        """Workers that answered, died, or take too long."""
        patience = self._settings.limits.notebook_seconds + EXTRA_SECONDS
        while True:
            ready = wait([worker.connection for worker in busy], timeout=1.0)
            late = [worker for worker in busy if time.monotonic() - worker.since > patience]
            for worker in late:
                worker.kill()
            if ready or late:
                return [worker for worker in busy if worker.connection in ready or worker in late]

    def _bury(self, worker: _Worker) -> None:
        worker.kill()
        self._workers.remove(worker)
        self._dead_on_arrival = 0 if worker.proved else self._dead_on_arrival + 1
        if self._dead_on_arrival >= MOST_DEAD_ON_ARRIVAL * self._size:
            raise DHError("the processes that grade end as soon as they start; is there enough memory?")


class _Worker:
    """A process, and the pipe to it."""

    def __init__(self, context: Any, settings: Settings, job: Job) -> None:
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs, settings, job), daemon=False)
        self.process.start()
        theirs.close()
        self.work: Work | None = None
        self.since = 0.0
        self.proved = False

    def send(self, work: Work) -> None:
        self.work, self.since = work, time.monotonic()
        with contextlib.suppress(OSError):  # it died: the pipe says so when it is read
            self.connection.send(work)

    def receive(self) -> Answer:
        try:
            answer: Answer = self.connection.recv()
        except (EOFError, OSError):
            return None
        self.work, self.proved = None, True
        return answer

    def end(self) -> None:
        """Let it end; what still runs is cut off."""
        if self.work is not None:
            self.process.terminate()
        self.connection.close()
        self.process.join(5.0)
        self.kill()

    def kill(self) -> None:
        self.process.kill()
        self.process.join()
        self.connection.close()


def _serve(connection: Connection, settings: Settings, job: Job) -> None:
    """Work until the other end of the pipe is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the controller ends us
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    _end_with_parent()
    with contextlib.suppress(EOFError, OSError):
        try:
            with job(settings) as grade_one:
                while True:
                    connection.send(grade_one(connection.recv()))
        except DHError as error:
            connection.send(str(error))


def _end_with_parent() -> None:
    """A controller that was killed cannot end its workers."""
    parent = multiprocessing.parent_process()
    if parent is not None:

        def watch() -> None:
            parent.join()
            os._exit(1)

        threading.Thread(target=watch, daemon=True).start()
