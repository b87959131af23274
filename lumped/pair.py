"""Two bodies that touch: which of them has a material, and the modulus of both together."""

from __future__ import annotations

from typing import Any

from lumped.errors import BadInput, Fault
from lumped.materials import Creep, Material, Relaxation
from lumped.shapes import Shape
from lumped.targets import Target


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


def check_striker_material(source: str, target: Target, striker: Material | None) -> None:
    """Raise BadInput for a second material on a target whose striker is rigid, or on a rigid target."""
    if striker is not None and not (target.deformable and target.yielding_strikers):
        raise BadInput(striker_material_faults(source, target))


def striker_material_faults(source: str, target: Target) -> list[Fault]:
    """What is wrong with a second material here."""
    reason = f"a {target.name} is struck by a rigid body in this version; leave it out"
    return [Fault(source, "striker.material", reason)]


def tables(
    shape: Shape, target: Target, material: Material, striker: Material | None
) -> tuple[dict[str, Any], dict[str, Any]]:
    """The striker's and the target's table of a scene file that gives them back."""
    own, held = shape.to_dict(), target.to_dict()
    if not target.deformable:
        return own | {"material": material.to_dict()}, held
    first = {} if striker is None else {"material": striker.to_dict()}
    return own | first, held | {"material": material.to_dict()}
