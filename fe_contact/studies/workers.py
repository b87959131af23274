"""Several processes that answer calls, as an executor of the standard library: each call by whoever is idle.

A pool of the standard library would need semaphores, which some systems refuse to a user; its processes would outlive
one that is killed; and one of them that dies would end all.
"""

from __future__ import annotations

import logging
import os
import signal
import sys
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack, contextmanager
from functools import partial
from itertools import islice
from multiprocessing import connection, get_context, resource_tracker
from multiprocessing.process import BaseProcess
from queue import SimpleQueue
from threading import Lock
from typing import Any, NamedTuple, ParamSpec, TypeVar

from fe_contact.errors import WorkerLost, import_of
from fe_contact.progress import Progress, silent
from fe_contact.threads import one_thread, starting
from lumped.errors import BadInput, Fault, shown
from lumped.schema.keys import Count

JOBS = Count(1, 1024)  # safety: more processes than machines hold
LOCAL = "local"  # in the place of an address: Dask's own processes on this machine
ATTEMPTS = 3  # safety: of a call whose process dies; the system may have ended it for what another one took
Asked = ParamSpec("Asked")
Name = TypeVar("Name")
R = TypeVar("R")


def answers(
    executor: Executor, calls: Iterable[tuple[Name, Callable[[], R]]], ahead: int
) -> Generator[tuple[Name, R], None, None]:
    """Names and results of calls as they come; so many are asked ``ahead``, and no more are held.

    Raises whatever a call raises.
    """
    left, asked = iter(calls), dict[Future[R], Name]()
    while True:
        for name, call in islice(left, ahead - len(asked)):
            asked[executor.submit(call)] = name
        if not asked:
            return
        for done in wait(asked, return_when=FIRST_COMPLETED).done:
            yield asked.pop(done), done.result()


def checked_jobs(jobs: int | str) -> int:
    """So many processes; raises BadInput."""
    try:
        return JOBS.read(int(jobs) if isinstance(jobs, str) else jobs)
    except ValueError:
        raise BadInput(Fault("--jobs", "", f"{shown(jobs)}: accepted {JOBS.accepted}")) from None


@contextmanager
def workers(jobs: int, dask: str | None = None, heard: Progress = silent) -> Iterator[tuple[Executor, int]]:
    """Who answers, and how many they are: this process for one job, or so many processes, or the workers of ``dask``.

    That is the address of a scheduler of Dask, whose first worker is waited for, or LOCAL: so many on this machine.
    What a call in one of the processes says by :func:`tell` is ``heard``. Raises ExtraMissing, BadInput where no
    scheduler answers, WorkerLost where it gives a call up.
    """
    if dask is None:
        with Processes(jobs, heard) if jobs > 1 else Here() as executor:
            yield executor, jobs
        return
    with import_of("dask"):
        import distributed
    with ExitStack() as stack:
        try:
            local = {"n_workers": jobs, "threads_per_worker": 1, "dashboard_address": None}
            quiet = {"silence_logs": logging.ERROR}  # it warns of a busy machine, in the midst of the progress bar
            cluster = stack.enter_context(distributed.LocalCluster(**local, **quiet)) if dask == LOCAL else dask
            client = stack.enter_context(distributed.Client(cluster))
        except (OSError, ValueError) as failure:
            accepted = f"accepted: {LOCAL}, or the address of a scheduler that answers, as tcp://host:8786"
            raise BadInput(Fault("--dask", dask, f"{failure}; {accepted}")) from None
        client.wait_for_workers(1)
        try:
            yield client.get_executor(pure=False, retries=ATTEMPTS), sum(client.nthreads().values())
        except (distributed.KilledWorker, CancelledError):
            raise WorkerLost from None


class Here(Executor):
    """The process that asks, itself: what is submitted is answered at once."""

    def submit(self, fn: Callable[Asked, R], /, *args: Asked.args, **kwargs: Asked.kwargs) -> Future[R]:
        """What it gives; what it raises is raised here."""
        future = Future[R]()
        with one_thread:
            future.set_result(fn(*args, **kwargs))
        return future


def tell(message: str, done: float = 0, total: float = 0) -> None:
    """Progress of a call, to the process that asked this one for it; see :class:`Progress`."""
    if _asker is not None:
        _asker.send(_Word(message, done, total))


_asker: connection.Connection | None = None  # of this process, where it is one of several


class _Worker(NamedTuple):
    process: BaseProcess
    line: connection.Connection


class _Word(NamedTuple):
    """What a call tells before it answers."""

    message: str
    done: float
    total: float


class Processes(Executor):
    """So many processes; one that dies is replaced, and its call asked again.

    They are killed where the executor is shut down, and end when this process is killed itself. What their calls tell
    is ``heard``, from one of them at a time. A call raises WorkerLost where every process that was asked died.
    """

    def __init__(self, jobs: int, heard: Progress = silent) -> None:
        self._heard = heard
        self._asking, self._idle = ThreadPoolExecutor(jobs), SimpleQueue[_Worker | None]()
        self._known, self._lock, self._ended = set[BaseProcess](), Lock(), False
        for _ in range(jobs):
            self._idle.put(None)

    def submit(self, fn: Callable[Asked, R], /, *args: Asked.args, **kwargs: Asked.kwargs) -> Future[R]:
        """What a process gives, or raises."""
        return self._asking.submit(self._answer, partial(fn, *args, **kwargs))

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = True) -> None:
        """Kill the processes, whatever they are at."""
        with self._lock:
            self._ended = True
            for process in self._known:
                process.kill()
        self._asking.shutdown(wait, cancel_futures=True)
        for process in self._known:
            process.join()

    def _answer(self, call: partial[R]) -> R:
        worker = self._idle.get()
        try:
            for _ in range(ATTEMPTS):
                worker = worker or self._start()
                try:
                    worker.line.send(call)
                    while isinstance(said := worker.line.recv(), _Word):
                        with self._lock:
                            self._heard(*said)
                    failure, found = said
                except (EOFError, ConnectionError):
                    with self._lock:
                        self._known.discard(worker.process)
                    worker.process.join()
                    worker = None
                    continue
                if failure is not None:
                    raise failure
                answer: R = found
                return answer
            raise WorkerLost
        finally:
            self._idle.put(worker)

    def _start(self) -> _Worker:
        """A process that answers calls, and the line to it. Raises WorkerLost where no more are wanted."""
        context = get_context("spawn")
        ours, its = context.Pipe()
        with self._lock:
            if self._ended:
                raise WorkerLost
            # a process that is interrupted while it starts would print how far it came
            with starting(), signals_held():
                process = context.Process(target=_serve, args=(its,), daemon=False)  # it may ask others
                process.start()
            self._known.add(process)
        its.close()
        return _Worker(process, ours)


@contextmanager
def signals_held() -> Iterator[None]:
    """Signals that end this process come afterwards; processes started meanwhile hold them too."""
    if sys.platform == "win32":
        yield
        return
    resource_tracker.ensure_running()  # starts with the first process else, and lets signals through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _serve(line: connection.Connection) -> None:
    """In a new process: what calls give, or how they fail, until nobody asks any more, as without a parent.

    A second thread measures, so that this one hears the line's end at once. An interrupt is the parent's to answer.
    """
    global _asker
    _asker = line
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform != "win32":
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM})

    def said(done: Future[Any]) -> None:
        failure, sent = done.exception(), False
        try:
            line.send((failure, None if failure else done.result()))
            sent = True
        finally:
            if not sent:  # nothing else would be heard, and waited for without end
                os._exit(1)

    measuring = ThreadPoolExecutor(1, initializer=one_thread.__enter__)  # for as long as this process lives
    try:
        while True:
            measuring.submit(line.recv()).add_done_callback(said)
    except EOFError:
        os._exit(1)
