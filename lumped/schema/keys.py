"""A key of a table: the kind of its values, what it means, and its default; one kind of value a class.

Ranges are generous but finite: inside them no product of a scene's scales leaves double precision.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Protocol


class Kind(Protocol):
    """A kind of value: says what it accepts, and turns a raw value into a checked one."""

    @property
    def accepted(self) -> str:
        """What is accepted, in words, with the range and the unit."""

    def read(self, value: object) -> object:
        """The checked value; raises ValueError when it is refused, its text what to say instead of `accepted`."""


@dataclass(frozen=True)
class Key:
    """A key of a table: its `kind` of values, what it means, in words, and whether a table has to have it.

    It stands beside the dataclass field, or the argument of a function, which it fills, and is written once:
    `thickness: Annotated[float, Key(Number(1e-9, 1e6, "m"), "thickness of the layer")]`. Required is what has no
    default there; `name` is only said where the table has another name for it than the field. See
    :func:`lumped.schema.record.keys_of`.
    """

    kind: Kind
    meaning: str = ""
    required: bool = True
    default: object = None
    name: str = ""
    field: str = ""


@dataclass(frozen=True)
class Number:
    """A real number in `[low, high]`, or in `(low, high]` when `above`. Truth values are no numbers."""

    low: float
    high: float
    unit: str = ""
    above: bool = False

    @property
    def accepted(self) -> str:
        end = f", {self.low:g} excluded" if self.above else ""
        return f"a number from {self.low:g} to {self.high:g} {self.unit}".rstrip() + end

    def read(self, value: object) -> float:
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise ValueError
        # Compared before conversion: an integer beyond 1e308 has no float.
        if not self.low <= value <= self.high or (self.above and value == self.low):
            raise ValueError
        return float(value)


@dataclass(frozen=True)
class Count:
    """A whole number in `[low, high]`."""

    low: int
    high: int

    @property
    def accepted(self) -> str:
        return f"a whole number from {self.low} to {self.high}"

    def read(self, value: object) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or not self.low <= value <= self.high:
            raise ValueError
        return value


@dataclass(frozen=True)
class Numbers:
    """A list of 1 to `most` numbers, each accepted by `each`."""

    each: Number
    most: int = 100

    @property
    def accepted(self) -> str:
        return f"a list of 1 to {self.most} values, each {self.each.accepted}"

    def read(self, value: object) -> tuple[float, ...]:
        if not isinstance(value, (list, tuple)) or not 1 <= len(value) <= self.most:
            raise ValueError
        return tuple(self.each.read(item) for item in value)


@dataclass(frozen=True)
class Choice:
    """One of a few words."""

    options: tuple[str, ...]

    @property
    def accepted(self) -> str:
        return "one of " + ", ".join(self.options)

    def read(self, value: object) -> str:
        if not isinstance(value, str) or value not in self.options:
            raise ValueError
        return value


@dataclass(frozen=True)
class Flag:
    """true or false."""

    accepted: str = "true or false"

    def read(self, value: object) -> bool:
        if not isinstance(value, bool):
            raise ValueError
        return value


@dataclass(frozen=True)
class Text:
    """A printable text of one to 200 characters that may be part of a file's name."""

    accepted: str = "a printable text of 1 to 200 characters without / and \\"

    def read(self, value: object) -> str:
        if not isinstance(value, str) or not 1 <= len(value.strip()) <= 200:
            raise ValueError
        if not value.isprintable() or set(value) & set("/\\") or value.startswith("."):
            raise ValueError
        return value


@dataclass(frozen=True)
class File:
    """A file's name, maybe with folders before it; it reads as a path, which `placed` puts where it belongs."""

    accepted: str = "the name of a file, from the folder of the scene file"

    def read(self, value: object) -> Path:
        if not isinstance(value, str | Path) or not str(value).strip() or not str(value).isprintable():
            raise ValueError
        return Path(value)
