"""Two bodies that touch: which of them has a material, and the modulus of both together."""

from __future__ import annotations

from typing import Any

from lumped.errors import BadInput, Fault
from lumped.geometry import Geometry
from lumped.materials import Creep, Material, Relaxation
from lumped.shapes import Shape
from lumped.targets import Target

SPARE_MASS = 0.01  # of a whole body with inertia, which its density gives way to


def contact_modulus(shape: Shape, material: Material, striker: Material | None) -> Relaxation:
    """The modulus E*(t) which the force is in proportion to, Pa: of one body, or of both.

    Compliances add, 1/E*(s) = 1/E1*(s) + 1/E2*(s), and the sum is inverted as a whole.
    """
    own = shape.modulus(material)
    return own if striker is None else _together(own.creep(), shape.modulus(striker).creep()).relaxation()


def _together(first: Creep, second: Creep) -> Creep:
    """Two compliances under one load."""
    return Creep(
        first.instantaneous + second.instantaneous,
        first.compliances + second.compliances,
        first.times + second.times,
        first.fluidity + second.fluidity,
    )


def check_striker_material(source: str, target: Target, shape: Shape, striker: Material | None, inertia: bool) -> None:
    """Raise BadInput for a second material on a target whose striker is rigid, or on a rigid target."""
    faults = [] if striker is None else target.yielding_faults(source, shape, inertia)
    if faults:
        raise BadInput(faults)


def flying_faults(source: str, geometry: Geometry, mass: float) -> list[Fault]:
    """What is wrong with the mass, kg, of a striker with inertia that is a whole body: its density says the same."""
    material, shape = geometry.striking, geometry.shape
    if material is None or shape.whole_mass(1.0) is None:
        return []
    if material.density is None:
        reason = "missing; model.inertia = true needs it, in kg/m3"
        return [Fault(source, "striker.material.density", reason)] if geometry.target.deformable else []
    whole = shape.whole_mass(material.density)
    if whole is None or abs(mass - whole) <= SPARE_MASS * whole:
        return []
    reason = f"{mass:g} kg: with model.inertia a {shape.name} has the mass of its density; accepted: {whole:.6g} kg"
    return [Fault(source, "striker.mass", f"{reason} within {SPARE_MASS:.0%}, or another density")]


def tables(
    shape: Shape, target: Target, material: Material, striker: Material | None
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The striker's and the target's table of a scene file that gives them back."""
    own, held = shape.to_dict(), target.to_dict()
    if not target.deformable:
        return own | {"material": material.to_dict()}, held
    first = {} if striker is None else {"material": striker.to_dict()}
    return own | first, held | {"material": material.to_dict()}
