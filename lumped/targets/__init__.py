"""Targets, one a file: `KEYS`, the keys of the scene file, and `of(**values)`, the Target."""

from lumped.schema.members import available as _available
from lumped.targets.base import Target as Target
from lumped.targets.half_space import HalfSpace as HalfSpace


def available() -> tuple[str, ...]:
    """Names of the targets."""
    return _available(__name__)
