"""BLAS on one thread where finite elements run.

Their dense systems have some 70 unknowns: a second thread only waits, and processor time doubles or worse. With one
thread every sum is also taken in one order, so the same scene gives the same bytes on any number of processors. An
environment variable would come too late where numpy was imported first; a process that is started for us has it from
the beginning, and need not load every BLAS at once to hold it back.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import ContextDecorator, contextmanager
from functools import cache
from threading import Lock
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from threadpoolctl import ThreadpoolController


LIMITS = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "OMP_NUM_THREADS")
STARTED = "FE_CONTACT_ONE_THREAD"  # tells a process that all of these were set when it was started
_started_so = STARTED in os.environ


@contextmanager
def starting() -> Iterator[None]:
    """A process that is started meanwhile has one thread for as long as it lives."""
    before = {name: os.environ.get(name) for name in (STARTED, *LIMITS)}
    os.environ.update(dict.fromkeys(before, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@cache
def _libraries() -> ThreadpoolController:
    """The BLAS of numpy and that of scipy, which comes with scipy.linalg: once both are there no import adds another.

    Kept, because finding them takes longer than a lumped law.
    """
    import numpy as np
    from scipy.linalg import blas
    from threadpoolctl import ThreadpoolController

    one = np.ones((1, 1))
    blas.dgemv(1.0, one, one[0])  # takes its work space now: with no memory left it would ask for it for ever
    return ThreadpoolController().select(user_api="blas")


def blas() -> list[str]:
    """Every BLAS at hand: its version, and the processor whose kernels it runs. They decide the last bits of a sum."""
    return sorted(f"{one['internal_api']} {one['version']} {one.get('architecture')}" for one in _libraries().info())


def _limit(threads: int | list[dict[str, Any]]) -> None:
    """Set one number, or what `info` found before, from whatever thread of the process.

    From 3.7 on threadpoolctl lets only the thread that set a limit last set another, until it leaves a `with`.
    """
    _libraries().limit(limits=threads)
    with _libraries().limit(limits=None):
        pass


class _OneThread(ContextDecorator):
    """Holds while anyone is inside, in any thread of the process; the last one out restores what was set before."""

    def __init__(self) -> None:
        self._lock, self._inside = Lock(), 0
        self._before: list[dict[str, Any]] = []

    def __enter__(self) -> None:
        if _started_so:
            return
        with self._lock:
            if self._inside == 0:
                self._before = _libraries().info()
                _limit(1)
            self._inside += 1

    def __exit__(self, *_: object) -> None:
        if _started_so:
            return
        with self._lock:
            self._inside -= 1
            if self._inside == 0:
                _limit(self._before)


one_thread = _OneThread()
