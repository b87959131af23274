"""How long work tells what it is doing and how much of it is done, to whoever listens; by default nobody does."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Protocol


class Progress(Protocol):
    """Told what is being done and, where it is known, how much of the ``total`` of it is ``done``, in any unit.

    It may be told as often as it is done: a word more costs a look at the clock.
    """

    def __call__(self, message: str, done: float = 0, total: float = 0) -> None: ...


def silent(message: str, done: float = 0, total: float = 0) -> None:
    """Nobody listens."""


Counted = Callable[[float], None]  # told that so many parts of a work are done


def uncounted(parts: float = 1.0) -> None:
    """Nobody counts."""


_steps: ContextVar[Counted] = ContextVar("steps", default=uncounted)


@contextmanager
def counting_steps(counted: Counted) -> Iterator[None]:
    """Meanwhile every step that is marched, or tried, is told to `counted`, however deep it lies."""
    before = _steps.set(counted)
    try:
        yield
    finally:
        _steps.reset(before)


def step_done(parts: float = 1.0) -> None:
    """A law, or a coarse run, has marched a step, or tried one."""
    _steps.get()(parts)
