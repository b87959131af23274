"""Force laws, one a file, found by their names."""

from importlib import import_module as _import_module
from types import ModuleType as _ModuleType

from lumped.laws.base import Law as Law
from lumped.laws.base import LawKind as LawKind
from lumped.schema.members import Folder as _Folder

_LAWS = _Folder[LawKind](__name__, source="law", key="")


def available() -> tuple[str, ...]:
    """Names of the laws."""
    return _LAWS.names


def get(name: str) -> LawKind:
    """The law called so, which has `of(scene)`; raises BadInput with the nearest name."""
    return _LAWS.get(name)


def __getattr__(name: str) -> _ModuleType:
    """The law's module, imported when it is first asked for, as Python itself does: `lumped.laws.ting.of(scene)`."""
    if name in available():
        return _import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
