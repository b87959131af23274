"""Which body stands for a target in an impact: one whose surface remembers where that is all, else its bulk."""

from __future__ import annotations

from fe_contact.bodies.bulk_memory import Moduli, relaxing
from fe_contact.bodies.offer import Deformable
from fe_contact.numerics import TARGETS, Numerics
from lumped.materials import Relaxation
from lumped.members import get
from lumped.scene import Geometry


def struck(geometry: Geometry, numerics: Numerics) -> Deformable:
    """The target with these settings; it has to be one that :func:`fe_contact.reference.check_target` lets pass."""
    target = get(TARGETS, geometry.target.name)
    if geometry.surface_remembers:
        body: Deformable = target.struck(geometry, numerics)
        return body
    material, length = geometry.material, geometry.shape.total
    moduli = Moduli(Relaxation(material.bulk).scaled(length), material.shear.scaled(length))
    return relaxing(target.meshed(geometry, numerics), moduli, numerics)
