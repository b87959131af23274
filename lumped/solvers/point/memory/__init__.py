"""What happens to a material's memory between two contacts: one rule a file (the paper's Fig. 15)."""

from __future__ import annotations

from typing import Any

from lumped.schema import members as _members


def available() -> tuple[str, ...]:
    """Names of the rules."""
    return _members.available(__name__)


def get(name: str) -> Any:
    """The rule's module, which has `returned(load, bodies, last)`; raises BadInput with the nearest name."""
    return _members.get(__name__, name, source="law", key="memory")
