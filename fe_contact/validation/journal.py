"""How a study measures its rows: in several processes that end with the study."""

from __future__ import annotations

import os
import signal
from collections.abc import Generator, Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from multiprocessing import active_children, get_context, parent_process
from multiprocessing.connection import wait
from threading import Thread
from typing import TypeVar

from fe_contact.errors import WorkerLost

R = TypeVar("R")


def measured(calls: Mapping[str, partial[R]], jobs: int) -> Generator[tuple[str, R], None, None]:
    """Names and results of calls as they come, from so many processes; from this one where one is enough.

    The processes are killed when the caller stops, fails or is interrupted: close the iterator then. They also end
    when this process is killed itself. Raises WorkerLost, and whatever a call raises.
    """
    if min(jobs, len(calls)) < 2:
        yield from ((name, call()) for name, call in calls.items())
        return
    strangers = active_children()
    pool = ProcessPoolExecutor(min(jobs, len(calls)), get_context("spawn"), _begin)
    try:
        with _signals_held():  # a process that is interrupted while it starts would print how far it came
            waiting = {pool.submit(call): name for name, call in calls.items()}
        for done in as_completed(waiting):
            yield waiting[done], done.result()
    except BrokenProcessPool:
        raise WorkerLost from None
    finally:
        with _signals_held():
            for child in active_children():
                if child not in strangers:
                    child.kill()
        pool.shutdown(cancel_futures=True)


@contextmanager
def _signals_held() -> Iterator[None]:
    """Signals that end this process come afterwards; processes started meanwhile hold them too."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin() -> None:
    """In a new process: an interrupt is its parent's to answer, and without its parent it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT, signal.SIGTERM})
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    assert parent is not None
    wait([parent.sentinel])
    os._exit(1)
