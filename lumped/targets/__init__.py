"""Targets, one a file: a member is the class that a target's table describes."""

from lumped.schema.keys import Part
from lumped.schema.members import Folder
from lumped.targets.base import Target as Target
from lumped.targets.half_space import HalfSpace as HalfSpace

TARGETS = Folder[Part[Target]](__name__)
