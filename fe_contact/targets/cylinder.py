"""The cylinder struck by a parallel one, in plane strain: finite bodies."""

from __future__ import annotations

from fe_contact.assembly.forms import Array
from fe_contact.bodies.pressing import Still
from fe_contact.settings import Numerics
from fe_contact.steppers.stacked import Stacked
from fe_contact.targets import _round
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """Both bodies at rest; ``radii``, m: half-width up to which their undeformed surfaces overlap."""
    return _round.still(indenter, radii, numerics)


def struck(geometry: Geometry, numerics: Numerics) -> Stacked:
    """Both bodies in an impact."""
    return _round.struck(geometry, numerics)


def relaxing(geometry: Geometry, numerics: Numerics) -> Stacked:
    """The same where one is of constant bulk modulus."""
    return _round.relaxing(geometry, numerics)


MEMBER = MeshedTarget(still, struck=struck, relaxing=relaxing)
