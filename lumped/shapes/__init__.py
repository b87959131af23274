"""Striker profiles, one a file: a member is the class that a striker's table describes."""

from lumped.schema.keys import Part
from lumped.schema.members import Folder
from lumped.shapes.base import Shape as Shape
from lumped.shapes.sphere import Parabola as Parabola
from lumped.shapes.sphere import Sphere as Sphere

SHAPES = Folder[Part[Shape]](__name__)
