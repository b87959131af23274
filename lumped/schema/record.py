"""A table is checked against its keys, every fault at once; a frozen record has its keys beside its fields."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from inspect import Parameter, signature
from itertools import islice
from pathlib import Path
from typing import ClassVar, Generic, Protocol, TypeVar, get_args, get_type_hints

from lumped.errors import SHOWN_FAULTS, BadInput, Fault, nearest, shown
from lumped.schema import Table
from lumped.schema.keys import Key, Kind

T = TypeVar("T")
Made = TypeVar("Made", covariant=True)
Sets = tuple[Mapping[str, Key], ...]


def read_table(
    source: str, path: str, table: Mapping[str, object], keys: Mapping[str, Key]
) -> tuple[Table, list[Fault]]:
    """Check a table against its keys: the accepted values, and every fault (unknown, missing, refused)."""
    values: Table = {}
    strange = islice((name for name in table if name not in keys), SHOWN_FAULTS)
    faults = [Fault(source, _join(path, name), unknown_key(name, keys)) for name in strange]
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


def unknown_key(name: str, names: Iterable[str]) -> str:
    """What to say of a key which is none of `names`."""
    names = sorted(names)
    return f"unknown key; accepted: {', '.join(names)}{nearest(name, names)}"


def _join(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _refused(kind: Kind, value: object) -> str:
    return f"{shown(value)} is not accepted; accepted: {kind.accepted}"


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
    return {name: value for name, value in values.items() if value is not None}


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
