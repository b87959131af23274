"""Every named failure of this floor; each says what is accepted or what to do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import date, time
from difflib import get_close_matches
from numbers import Number
from pathlib import Path
from typing import ClassVar

SHOWN_FAULTS = 20  # work: faults that one refusal lists at most
SHOWN_CHARACTERS = 60  # of a value or a key that is told back
SHOWN_OF_A_LINE = 300  # of a file's name, or of another line that holds what the user wrote


class FeContactError(Exception):
    """Base of every failure with a name; `exit_code` is what a command returns for it."""

    exit_code: ClassVar[int]

    def __reduce__(self) -> tuple[object, ...]:
        """Another process gets what it says, not what it was made of: kinds differ in their arguments."""
        return type(self).__new__, (type(self), *self.args), self.__dict__


@dataclass(frozen=True)
class Fault:
    """One thing wrong with the input: where it came from, which (dotted) key, what is accepted.

    `source` is a file or an option; or the name of a part that knows neither, as "layer": see :func:`addressed`.
    """

    source: str
    key: str
    message: str

    def at(self, source: str, places: Mapping[str, str]) -> Fault:
        """The fault of a part at its place, the table "target" of the file `source`, or the option "--depths"."""
        place = places.get(self.source)
        if place is None:
            return self
        if place.startswith("-"):
            return replace(self, source=place)
        inside = self.key if "." in self.key else ".".join(part for part in (place, self.key) if part)
        return Fault(source, inside, self.message)

    def is_of(self, key: str) -> bool:
        """Whether it is of a dotted key, of one inside it, or of the table around it."""
        return any(f"{own}.".startswith(f"{key}.") or f"{key}.".startswith(f"{own}.") for own in self.key.split(", "))

    def __str__(self) -> str:
        source, key = shortened(printable(self.source), SHOWN_OF_A_LINE), shortened(printable(self.key))
        return ": ".join(part for part in (source, key, printable(self.message)) if part)


class BadInput(FeContactError):
    """The input cannot be used. `faults` holds every reason found, at most 20."""

    exit_code = 2

    def __init__(self, faults: Fault | Iterable[Fault]) -> None:
        found = (faults,) if isinstance(faults, Fault) else tuple(faults)
        self.faults: tuple[Fault, ...] = found[:SHOWN_FAULTS]
        super().__init__("\n".join(str(fault) for fault in self.faults))

    def told_of(self, option: str, keys: Iterable[str]) -> BadInput:
        """The same, where each fault of one of the keys is the option's, which gave its value in place of a file."""
        given = [key for key in keys if key]
        return BadInput(
            replace(fault, source=option) if any(fault.is_of(key) for key in given) else fault for fault in self.faults
        )


class CannotWrite(FeContactError):
    """A folder of results could not be written; what was in it stays as it was."""

    exit_code = 2

    def __init__(self, folder: Path, reason: str) -> None:
        cure = "accepted: a folder with room in it that can be written; what was there is untouched"
        super().__init__(str(Fault(str(folder), "", f"{reason}; {cure}")))


@contextmanager
def addressed(source: str, places: Mapping[str, str]) -> Iterator[None]:
    """Inside, what a part refuses is said of the file `source`; `places` maps names of parts to tables or options."""
    try:
        yield
    except BadInput as bad:
        raise BadInput(fault.at(source, places) for fault in bad.faults) from bad


class PackageMissing(FeContactError):
    """A package that only this call needs is not installed."""

    exit_code = 2

    def __init__(self, package: str) -> None:
        super().__init__(f"{package} is missing; cure: pip install {package}")


class NotReached(FeContactError):
    """The tolerance was not reached, or a solve did not converge: the ``reason``, and the ``cure`` if one is known."""

    exit_code = 3

    def __init__(self, reason: str, cure: str = "") -> None:
        self.reason, self.cure = reason, cure
        super().__init__(f"{reason}; cure: {cure}" if cure else reason)


class TooManySteps(NotReached):
    """An integration used up its steps before the contact ended."""


def printable(text: str) -> str:
    """The text in one line that no terminal obeys: what cannot be printed stands as its escape."""
    line = " ".join(text.split())
    return line if line.isprintable() else "".join(c if c.isprintable() else ascii(c)[1:-1] for c in line)


def shortened(text: str, most: int = SHOWN_CHARACTERS) -> str:
    """The text, the end of a long one left out."""
    return text if len(text) <= most else text[: most - 3] + "..."


def as_number(value: object) -> object:
    """A number of numpy's, as scripts have them, as one of Python's; else the value itself."""
    item = getattr(value, "item", None)
    return item() if isinstance(value, Number) and callable(item) else value


def shown(value: object) -> str:
    """A value as the user wrote it, about, and not at length."""
    own = as_number(value)
    if isinstance(own, dict):
        return shortened(f"{{ {', '.join(f'{key} = {shown(one)}' for key, one in own.items())} }}")
    if isinstance(own, list) and any(isinstance(one, dict) for one in own):
        return shortened(f"[{', '.join(map(shown, own))}]")
    try:
        written_so = str(own) if isinstance(own, date | time) else repr(own)
        return shortened(written_so.lower() if isinstance(own, bool) else written_so)
    except ValueError:  # Python prints no number of more than 4300 digits
        return "a number of thousands of digits"


def nearest(name: str, accepted: Sequence[str] | Mapping[str, str]) -> str:
    """`; did you mean radius?` when one accepted name resembles `name`, else an empty string.

    What a mapping's names are shown as are its values.
    """
    tried = dict.fromkeys((name[:SHOWN_CHARACTERS], name[:SHOWN_CHARACTERS].lower()))
    close = [found for one in tried for found in get_close_matches(one, list(accepted), n=1, cutoff=0.5)]
    shown_as = accepted if isinstance(accepted, Mapping) else {found: found for found in close}
    return f"; did you mean {shown_as[close[0]]}?" if close else ""
