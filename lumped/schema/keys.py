"""A key of a table: the kind of its values, what it means, and its default; one kind of value a class.

A table is checked against its keys, every fault at once; a frozen record has its keys beside its fields. Ranges are
generous but finite: inside them no product of a scene's scales leaves double precision.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from inspect import Parameter, signature
from itertools import islice
from pathlib import Path
from typing import ClassVar, Generic, Protocol, TypeVar, get_args, get_type_hints

from lumped.errors import SHOWN_FAULTS, BadInput, Fault, as_number, nearest, shown
from lumped.schema import Table

UNKNOWN_KEY = "unknown key"
NUMERAL = re.compile(r"[+-]?\.?\d")  # how a text begins that may be meant as a number
T = TypeVar("T")
Made = TypeVar("Made", covariant=True)


class Kind(Protocol):
    """A kind of value: says what it accepts, to people and to editors, and turns a raw value into a checked one."""

    @property
    def accepted(self) -> str:
        """What is accepted, in words, with the range and the unit."""

    @property
    def schema(self) -> Table:
        """The same as a JSON Schema, as far as one can say it."""

    def read(self, value: object) -> object:
        """The checked value; raises ValueError when it is refused, its text what to say instead of `accepted`."""


@dataclass(frozen=True)
class Key:
    """A key of a table: its `kind` of values, what it means, in words, and whether a table has to have it.

    It stands beside the dataclass field, or the argument of a function, which it fills, and is written once:
    `thickness: Annotated[float, Key(Number(1e-9, 1e6, "m"), "thickness of the layer")]`. Required is what has no
    default there; `name` is only said where the table has another name for it than the field. See
    :func:`keys_of`.
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

    @property
    def schema(self) -> Table:
        return {"type": "number", "exclusiveMinimum" if self.above else "minimum": self.low, "maximum": self.high}

    def read(self, value: object) -> float:
        value = as_number(value)
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

    @property
    def schema(self) -> Table:
        return {"type": "integer", "minimum": self.low, "maximum": self.high}

    def read(self, value: object) -> int:
        value = as_number(value)
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

    @property
    def schema(self) -> Table:
        return {"type": "array", "items": self.each.schema, "minItems": 1, "maxItems": self.most}

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

    @property
    def schema(self) -> Table:
        return {"enum": list(self.options)}

    def read(self, value: object) -> str:
        if not isinstance(value, str) or value not in self.options:
            raise ValueError
        return value


@dataclass(frozen=True)
class Flag:
    """true or false."""

    accepted: ClassVar[str] = "true or false"
    schema: ClassVar[Table] = {"type": "boolean"}

    def read(self, value: object) -> bool:
        if not isinstance(value, bool):
            raise ValueError
        return value


@dataclass(frozen=True)
class Text:
    """A printable text of one to 200 characters that may be part of a file's name."""

    accepted: ClassVar[str] = "a printable text of 1 to 200 characters without / and \\"
    schema: ClassVar[Table] = {"type": "string", "pattern": r"^[^./\\][^/\\]*$"}

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
    schema: ClassVar[Table] = {"type": "string", "pattern": r"\S"}

    def read(self, value: object) -> Path:
        if not isinstance(value, str | Path) or not str(value).strip() or not str(value).isprintable():
            raise ValueError
        return Path(value)


Sets = tuple[Mapping[str, Key], ...]

# What users call a key; its own name resembles none of these, and some of them resemble another key.
ALSO_CALLED: Mapping[str, tuple[str, ...]] = {
    "velocity": ("speed", "v", "v0"),
    "mass": ("m", "weight"),
    "radius": ("r", "diameter"),
    "shape": ("type", "kind", "geometry"),
    "law": ("type", "kind", "model"),
    "E": (YOUNG := ("young", "young_modulus", "youngs_modulus", "elastic_modulus", "modulus")),
    "E0": YOUNG,
    "E1": YOUNG,
    "nu": ("poisson", "poisson_ratio", "poissons_ratio"),
    "density": ("rho",),
    "yield_strength": ("sigma_y",),
    "eta": ("viscosity", "damping"),
    "C1": ("viscosity", "damping"),
    "thickness": ("depth", "height"),
    "gravity": ("g",),
    "k": ("stiffness",),
    "e": ("restitution", "cor"),
}


def read_table(
    source: str, path: str, table: Mapping[str, object], keys: Mapping[str, Key], beside: tuple[str, ...] = ()
) -> tuple[Table, list[Fault]]:
    """Check a table against its keys: the accepted values, and every fault (unknown, missing, refused).

    `beside` these it may hold tables of its own, which others read.
    """
    values: Table = {}
    strange = islice((name for name in table if name not in keys), SHOWN_FAULTS)
    faults = [Fault(source, _join(path, name), unknown_key(name, keys, beside)) for name in strange]
    for name, key in keys.items():
        if name not in table:
            if key.required:
                faults.append(Fault(source, _join(path, name), f"missing; accepted: {key.kind.accepted}"))
            continue
        try:
            values[name] = key.kind.read(table[name])
        except ValueError as error:
            faults.append(Fault(source, _join(path, name), str(error) or _refused(key.kind, table[name])))
    return values, faults


def placed(values: Table, folder: Path) -> Table:
    """The same values, files from this folder on."""
    return {name: folder / value if isinstance(value, Path) else value for name, value in values.items()}


def optional(keys: Mapping[str, Key]) -> dict[str, Key]:
    """The same keys, none of them required."""
    return {name: replace(key, required=False) for name, key in keys.items()}


def unknown_key(name: str, names: Iterable[str], beside: tuple[str, ...] = ()) -> str:
    """What to say of a key which is none of `names`, nor a table `beside` them."""
    names = sorted(names)
    meant = [key for key in names if name.lower() in ALSO_CALLED.get(key, ())]
    return f"{UNKNOWN_KEY}; accepted: {', '.join(names)}{nearest(meant[0] if meant else name, [*names, *beside])}"


def _join(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _refused(kind: Kind, value: object) -> str:
    numeral = isinstance(kind, Number | Numbers) and isinstance(value, str) and NUMERAL.match(value)
    written_so = "; a number has a decimal point and no unit" if numeral else ""
    return f"{shown(value)} is not accepted; accepted: {kind.accepted}{written_so}"


def keys_of(make: Callable[..., object]) -> Mapping[str, Key]:
    """The keys beside the fields of a dataclass, or beside the arguments of a function, by their names in a table.

    In the order of the fields; what has no default is required.
    """
    return _keys_of(make)


@cache
def _keys_of(make: Callable[..., object]) -> Mapping[str, Key]:
    hints = get_type_hints(make, include_extras=True)
    found: dict[str, Key] = {}
    for field, parameter in signature(make).parameters.items():
        for key in (one for one in get_args(hints.get(field)) if isinstance(one, Key)):
            required = parameter.default is Parameter.empty
            default = None if required else parameter.default
            name = key.name or field
            found[name] = replace(key, required=required, default=default, name=name, field=field)
    return found


def made(make: Callable[..., T], values: Mapping[str, object]) -> T:
    """What a dataclass or a function makes of values by the names of its keys."""
    keys = keys_of(make)
    return make(**{keys[name].field: value for name, value in values.items()})


def check_fields(owner: str, record: object) -> None:
    """Check the fields of a record built in Python by their keys; raises BadInput naming every one that is refused."""
    _, faults = read_table(owner, "", written(record), keys_of(type(record)))
    if faults:
        raise BadInput(faults)


def written(record: object) -> dict[str, object]:
    """The values of a record by the names of its keys, as in the table that gives it back; None is left out."""
    values = {name: getattr(record, key.field) for name, key in keys_of(type(record)).items()}
    known = {name: value for name, value in values.items() if value is not None}
    return {name: list(value) if isinstance(value, tuple) else value for name, value in known.items()}


class Record:
    """Base of a frozen dataclass whose fields have keys; `name` is what a fault calls it. Raises BadInput."""

    name: ClassVar[str]

    def __post_init__(self) -> None:
        check_fields(self.name, self)


class Described(Protocol):
    """A member which a table names, and describes by one of these sets of keys."""

    @property
    def sets(self) -> Sets: ...


@dataclass(frozen=True)
class Part(Generic[Made]):
    """A member that is a class, whose instances a table describes by the keys beside its fields."""

    kind: type[Made]

    @property
    def sets(self) -> Sets:
        """One."""
        return (keys_of(self.kind),)

    def of(self, **values: object) -> Made:
        """The instance of a table's checked values. Raises BadInput."""
        return made(self.kind, values)
