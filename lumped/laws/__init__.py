"""Force laws, one a file, found by their names."""

from typing import Any

from lumped.laws.base import Law as Law
from lumped.schema import members as _members


def available() -> tuple[str, ...]:
    """Names of the laws."""
    return _members.available(__name__)


def get(name: str) -> Any:
    """The law's module, which has `of(scene)`; raises BadInput with the nearest name."""
    return _members.get(__name__, name, source="law", key="")


def __getattr__(name: str) -> Any:
    """The law's module, imported when it is first asked for: `lumped.laws.ting`."""
    if name in available():
        return get(name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
