"""Adding a thing is adding a file: the modules of a folder, found by their names."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType

from lumped.errors import BadInput, Fault, nearest, shown

NOT_MEMBERS = ("base",)


@cache
def available(package: str) -> tuple[str, ...]:
    """Names of the members of `package`, sorted: not `base`, nor modules that start with `_`."""
    found = iter_modules(import_module(package).__path__)
    return tuple(sorted(m.name for m in found if m.name not in NOT_MEMBERS and not m.name.startswith("_")))


def unavailable(package: str, name: str) -> str:
    """What to say of a name which is no member of `package`."""
    names = available(package)
    return f"{shown(name)} is not available in this version; accepted: {', '.join(names)}{nearest(name, names)}"


def get(package: str, name: str, source: str = "lumped", key: str = "name") -> ModuleType:
    """The member module called `name`; raises BadInput, with the nearest name, when there is none."""
    if name not in available(package):
        raise BadInput(Fault(source, key, unavailable(package, name)))
    return import_module(f"{package}.{name}")


@dataclass(frozen=True)
class Member:
    """A key of a scene file whose value names a member of `package`; it reads as the module."""

    package: str
    required: bool = True

    @property
    def accepted(self) -> str:
        return "one of " + ", ".join(available(self.package))

    def read(self, value: object) -> ModuleType:
        if not isinstance(value, str):
            raise ValueError
        if value not in available(self.package):
            raise ValueError(unavailable(self.package, value))
        return import_module(f"{self.package}.{value}")
