"""The sphere struck by a sphere: two half-spaces under the gap of both, or finite bodies where a support is said."""

from __future__ import annotations

from fe_contact.assembly.forms import Array
from fe_contact.bodies.pressing import ScaledStill, Still
from fe_contact.settings import Numerics
from fe_contact.steppers.struck import Deformable
from fe_contact.targets import _round, half_space
from fe_contact.targets.base import MeshedTarget
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.targets.sphere import SphereTarget


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """Both bodies at rest; ``radii``, m: where their undeformed surfaces overlap.

    The surface of a half-space knows its E* alone, so one of the common modulus stands for two.
    """
    assert isinstance(indenter.target, SphereTarget)
    if indenter.target.support is not None:
        return _round.still(indenter, radii, numerics)
    return ScaledStill(half_space.surface(indenter.material.nu, numerics), indenter, numerics, float(radii.min()))


def struck(geometry: Geometry, numerics: Numerics) -> Deformable:
    """Both bodies in an impact: one half-space of the common modulus, or each of its true size."""
    assert isinstance(geometry.target, SphereTarget)
    if geometry.target.support is not None:
        return _round.struck(geometry, numerics)
    return half_space.surface(geometry.material.nu, numerics)


MEMBER = MeshedTarget(still, struck=struck, relaxing=_round.relaxing, paired=True)
