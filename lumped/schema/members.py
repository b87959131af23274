"""Adding a thing is adding a file: the members of a folder, one frozen instance a module, found by their names."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import ClassVar, Generic, TypeVar

from lumped.errors import BadInput, Fault, nearest, shown
from lumped.schema import Table
from lumped.schema.keys import Described, Key, Sets, optional

NOT_MEMBERS = ("base",)
M = TypeVar("M", covariant=True)
D = TypeVar("D", bound=Described)


@dataclass(frozen=True)
class Folder(Generic[M]):
    """The modules of `package`, each of which exports its member, of the contract `M`, as `MEMBER`.

    A folder is declared once, where its contract is known: `LAWS = Folder[LawKind]("lumped.laws")`. `source` and
    `key` are those of a fault which a strange name is, unless :meth:`get` is told others.
    """

    package: str
    source: str = "lumped"
    key: str = "name"

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the members, sorted."""
        return available(self.package)

    @property
    def members(self) -> dict[str, M]:
        """All members by their names, sorted."""
        return {name: self.get(name) for name in self.names}

    def get(self, name: str, source: str = "", key: str = "") -> M:
        """The member called `name`; raises BadInput, with the nearest name, when there is none."""
        if name not in self.names:
            raise BadInput(Fault(source or self.source, key or self.key, unavailable(self.names, name)))
        member: M = import_module(f"{self.package}.{name}").MEMBER
        return member


@cache
def available(package: str) -> tuple[str, ...]:
    """Names of the members of `package`, sorted: not `base`, nor modules that start with `_`."""
    found = iter_modules(import_module(package).__path__)
    return tuple(sorted(m.name for m in found if m.name not in NOT_MEMBERS and not m.name.startswith("_")))


def unavailable(names: tuple[str, ...], name: str) -> str:
    """What to say of a name which is none of `names`."""
    return f"{shown(name)} is not known; accepted: {', '.join(names)}{nearest(name, names)}"


@dataclass(frozen=True)
class Member:
    """A name of a member of `package`."""

    package: str

    @property
    def accepted(self) -> str:
        return "one of " + ", ".join(available(self.package))

    @property
    def schema(self) -> Table:
        return {"enum": list(available(self.package))}

    def read(self, value: object) -> str:
        if not isinstance(value, str):
            raise ValueError
        if value not in available(self.package):
            raise ValueError(unavailable(available(self.package), value))
        return value


@dataclass(frozen=True)
class Anything:
    """A key of which nothing is known but its name."""

    accepted: ClassVar[str] = "any value"
    schema: ClassVar[Table] = {}

    def read(self, value: object) -> object:
        return value


def alternatives(folder: Folder[D], name: object) -> Sets:
    """The sets of keys of the member called `name`; of an unknown member the keys of all, none required.

    What two members mean by one key may differ: then an unknown one may mean anything.
    """
    if isinstance(name, str) and name in folder.names:
        return folder.get(name).sets
    every: dict[str, Key] = {}
    for member in folder.members.values():
        for keys in member.sets:
            for key, own in optional(keys).items():
                known = every.get(key, own)
                every[key] = own if known.kind == own.kind else Key(Anything(), required=False)
    return (every,)
