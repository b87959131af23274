"""Every named failure of this floor; each says what is accepted or what to do."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, ClassVar

SHOWN_FAULTS = 20


class FeContactError(Exception):
    """Base of every failure with a name; `exit_code` is what a command returns for it."""

    exit_code: ClassVar[int]

    def __reduce__(self) -> tuple[Any, ...]:
        """Another process gets what it says, not what it was made of: kinds differ in their arguments."""
        return type(self).__new__, (type(self), *self.args), self.__dict__


@dataclass(frozen=True)
class Fault:
    """One thing wrong with the input: where it came from, which (dotted) key, what is accepted."""

    source: str
    key: str
    message: str

    def __str__(self) -> str:
        return ": ".join(" ".join(part.split()) for part in (self.source, self.key, self.message) if part)


class BadInput(FeContactError):
    """The input cannot be used. `faults` holds every reason found, at most 20."""

    exit_code = 2

    def __init__(self, faults: Fault | Iterable[Fault]) -> None:
        found = (faults,) if isinstance(faults, Fault) else tuple(faults)
        self.faults: tuple[Fault, ...] = found[:SHOWN_FAULTS]
        super().__init__("\n".join(str(fault) for fault in self.faults))


class NotReached(FeContactError):
    """The tolerance was not reached, or a solve did not converge."""

    exit_code = 3


class TooManySteps(NotReached):
    """An integration used up its steps before the contact ended."""


def nearest(name: str, accepted: Sequence[str]) -> str:
    """`; did you mean radius?` when one accepted name resembles `name`, else an empty string."""
    close = get_close_matches(name, accepted, n=1, cutoff=0.5)
    return f"; did you mean {close[0]}?" if close else ""
