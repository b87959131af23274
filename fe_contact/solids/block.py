"""A block strained alike everywhere: what one point answers is what the block answers, whatever the mesh."""

from __future__ import annotations

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.bodies.pressing import PressedDepths
from fe_contact.solids.base import elliptic
from fe_contact.solids.newton import BeyondRange, EquilibriumLost
from lumped.materials.energies.base import Strained, energy_of, strained
from lumped.scene.indenter import Indenter
from lumped.shapes._block import Block

ITERATIONS = 40  # work: of Newton's method for the stretch across
ROUNDING = 1e-13  # of the stretch across


def press(indenter: Indenter, block: Block, depth: Array) -> PressedDepths:
    """Every depth, m, on the ``block`` of an ``indenter``, exactly. Raises EquilibriumLost."""
    along, material = 1.0 - depth / block.thickness, indenter.material
    across = np.ones_like(along)
    answer = _answered(indenter, along, across)
    for _ in range(ITERATIONS if block.sides == "free" else 0):
        change = -answer.stress[0] / (answer.tangent[0, 0] + answer.tangent[0, 4])
        across = across + np.maximum(change, 0.5 * (np.min(along) - 1.0))
        answer = _answered(indenter, along, across)
        if np.abs(change).max() < ROUNDING:
            break
    else:
        if block.sides == "free":
            raise EquilibriumLost(f"a block pressed by {depth.max():.3g} m has no stress across it that is zero")
    bearing = [elliptic(answer.tangent[..., i]) for i in range(depth.size)]
    if not all(bearing):
        raise BeyondRange(float(depth[np.logical_not(bearing)].min()))
    force = -block.area * answer.stress[3] / block.modulus(material).relaxed
    if not np.all(force > 0.0):
        raise EquilibriumLost(f"a block pressed by {depth.max():.3g} m does not press back")
    work = {"degrees_of_freedom": 1, "contact_problems": depth.size, "iterations": ITERATIONS}
    return PressedDepths(force, block.fixed_radius * across, work, np.inf, True)


def _answered(indenter: Indenter, along: Array, across: Array) -> Strained:
    """Of points stretched so, each (n,)."""
    material, none = indenter.material, np.zeros_like(along)
    shear = material.shear.relaxed
    lame = 2.0 * shear * material.nu / (1.0 - 2.0 * material.nu)
    gradient = np.stack([across - 1.0, none, none, along - 1.0, across - 1.0])
    return strained(energy_of(material.hyperelastic), gradient, shear, lame)
