"""The keys that a member of a folder of modules accepts, and those of a member which is not known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType

from lumped.schema.key_table import optional
from lumped.schema.keys import Key
from lumped.schema.members import available, get


@dataclass(frozen=True)
class Anything:
    """A key of which nothing is known but its name."""

    required: bool = False
    accepted: str = "any value"

    def read(self, value: object) -> object:
        return value


def alternatives(package: str, name: object) -> tuple[Mapping[str, Key], ...]:
    """The sets of keys of the member called `name`; of an unknown member the keys of all, none required.

    What two members mean by one key may differ: then an unknown one may mean anything.
    """
    if isinstance(name, str) and name in available(package):
        return _sets(get(package, name))
    every: dict[str, Key] = {}
    for member in available(package):
        for keys in _sets(get(package, member)):
            for key, kind in optional(keys).items():
                every[key] = kind if every.get(key, kind) == kind else Anything()
    return (every,)


def _sets(module: ModuleType) -> tuple[Mapping[str, Key], ...]:
    return module.KEYS if isinstance(module.KEYS, tuple) else (module.KEYS,)
