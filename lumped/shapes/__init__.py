"""Striker profiles, one a file: `KEYS`, the keys of the scene file, and `of(**values)`, the Shape."""

from lumped.schema.members import available as _available
from lumped.shapes._parabola import Parabola as Parabola
from lumped.shapes.base import Shape as Shape
from lumped.shapes.sphere import Sphere as Sphere


def available() -> tuple[str, ...]:
    """Names of the shapes."""
    return _available(__name__)
