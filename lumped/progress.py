"""How long work tells what it is doing and how much of it is done, to whoever listens; by default nobody does."""

from __future__ import annotations

from typing import Protocol


class Progress(Protocol):
    """Told what is being done and, where it is known, how much of the ``total`` of it is ``done``, in any unit.

    It may be told as often as it is done: a word more costs a look at the clock.
    """

    def __call__(self, message: str, done: float = 0, total: float = 0) -> None: ...


def silent(message: str, done: float = 0, total: float = 0) -> None:
    """Nobody listens."""
