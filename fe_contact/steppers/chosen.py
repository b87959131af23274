"""Which body stands for a target in an impact: one whose surface remembers where that is all, else its bulk.

Under an end that no depth widens one stiffness is enough.
"""

from __future__ import annotations

from fe_contact.settings import TARGETS, Numerics
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.steppers.struck import Struck
from lumped.scene.geometry import Geometry
from lumped.schema.members import get


def struck(geometry: Geometry, numerics: Numerics) -> Struck:
    """The target with these settings; it has to be one that :func:`fe_contact.reference.check_target` lets pass."""
    target, flat = get(TARGETS, geometry.target.name), geometry.target.fixed_radius(geometry.shape)
    if geometry.surface_remembers:
        body: Struck = target.struck(geometry, numerics) if flat is None else FlatEnd.of(geometry, flat, numerics)
        return body
    relaxing: Struck = target.relaxing(geometry, numerics)
    return relaxing
