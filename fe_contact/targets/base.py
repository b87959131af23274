"""What finite elements know of a target."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fe_contact.assembly.cache import Recipe
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import ElasticBody, SolidMesh, WholeBody
from fe_contact.bodies.bulk_memory import Moduli
from fe_contact.bodies.pressing import Still
from fe_contact.settings import Numerics
from fe_contact.steppers import bulk_surface
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.steppers.scaled_surface import on_mesh
from fe_contact.steppers.struck import Deformable, Struck
from lumped.scene.geometry import Geometry
from lumped.scene.indenter import Indenter
from lumped.schema.members import Folder


@dataclass(frozen=True)
class MeshedTarget:
    """``still(indenter, radii, numerics)``: the target pressed slowly, ``radii``, m, those of the contacts expected.

    ``struck(geometry, numerics)``: the target in an impact, whose surface alone remembers; ``relaxing``: the same of a
    bulk that relaxes. None where there is no such impact in this version. ``whole``: with its inside what ``struck``
    knows by its surface, None where no fields are written. ``solid``: as ``still``, mesh and supports for large
    strains; None where there is none in this version. ``seconds``: processor time, s, of an impact to
    1e-3, as measured of the packaged scenes: it tells what to expect, no more. ``paired``: whether the bodies, where
    they are finite, are pressed on two surfaces, each with a memory of its own.
    """

    still: Callable[[Indenter, Array, Numerics], Still]
    struck: Callable[[Geometry, Numerics], Deformable] | None = None
    relaxing: Callable[[Geometry, Numerics], Deformable] | None = None
    whole: Callable[[Geometry, Numerics], WholeBody] | None = None
    seconds: float = 0.8
    paired: bool = False
    solid: Callable[[Indenter, Array, Numerics], SolidMesh] | None = None

    @classmethod
    def meshed(
        cls,
        still: Callable[[Indenter, Array, Numerics], Still],
        meshed: Callable[[Geometry, Numerics], Recipe[ElasticBody]],
        solid: Callable[[Indenter, Array, Numerics], SolidMesh] | None = None,
    ) -> MeshedTarget:
        """One that is ``meshed`` for an impact alike whatever it is made of."""

        def struck(geometry: Geometry, numerics: Numerics) -> Deformable:
            return on_mesh(meshed(geometry, numerics), geometry.material.nu)

        def relaxing(geometry: Geometry, numerics: Numerics) -> Deformable:
            moduli = Moduli.of(geometry.material, geometry.shape.total)
            return bulk_surface.relaxing(meshed(geometry, numerics), moduli, bulk_surface.Pace.of(numerics))

        def whole(geometry: Geometry, numerics: Numerics) -> WholeBody:
            return meshed(geometry, numerics).follow().condensed(geometry.material.nu)

        return cls(still, struck, relaxing, whole, solid=solid)


FLAT_SECONDS = 0.05  # the same where an end is flat: one stiffness is enough
TARGETS = Folder[MeshedTarget]("fe_contact.targets", "numerics", "target")


def struck(geometry: Geometry, numerics: Numerics) -> Struck:
    """The body that stands for a target in an impact, one that :func:`fe_contact.reference.check_target` lets pass.

    One whose surface remembers where that is all, else its bulk. Under an end that no depth widens one stiffness is
    enough.
    """
    target, flat = TARGETS.get(geometry.target.name), geometry.target.fixed_radius(geometry.shape)
    if not geometry.surface_remembers:
        assert target.relaxing is not None
        return target.relaxing(geometry, numerics)
    if flat is not None:
        return FlatEnd.of(geometry, flat, numerics, target.still)
    assert target.struck is not None
    return target.struck(geometry, numerics)


def recovers_in_flight(geometry: Geometry) -> bool:
    """Whether one surface remembers all: what nothing presses is then known at any time, and contacts can follow."""
    flat = geometry.target.fixed_radius(geometry.shape) is not None
    two = TARGETS.get(geometry.target.name).paired and geometry.target.has_length and not flat
    return geometry.surface_remembers and not two


def seconds_of_impact(geometry: Geometry) -> float:
    """Processor time of an impact to 1e-3, s, about."""
    flat = geometry.surface_remembers and geometry.target.fixed_radius(geometry.shape) is not None
    return FLAT_SECONDS if flat else TARGETS.get(geometry.target.name).seconds
