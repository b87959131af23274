"""The rigid plane and what strikes it: half of a block, pressed from its middle plane, or a whole ball."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
import scipy.sparse.linalg as linalg

import meshes
from fe_contact.assembly.cache import cached
from fe_contact.assembly.disk_cache import on_disk
from fe_contact.assembly.forms import Array, isotropic, stiffness
from fe_contact.assembly.operators import ElasticBody, SolidMesh, basis_on, made
from fe_contact.assembly.surface import face
from fe_contact.bodies.pressing import SHARP_REFINEMENT, Pressed, Still, held
from fe_contact.settings import Numerics
from fe_contact.targets import _round
from fe_contact.targets.base import MeshedTarget
from lumped.scene.indenter import Indenter
from lumped.shapes._block import Block

FEWER = 0.75  # elements along the block's shorter side, of those along a contact radius: no edge of contact moves


@dataclass(frozen=True)
class BlockStill:
    """A block between two planes that touch the whole of its faces: its force is in proportion to the depth.

    ``stiffness``: force per depth and modulus, m; ``radius`` of its face, m.
    """

    stiffness: float
    radius: float
    degrees_of_freedom: int
    mesh_order: ClassVar[float] = np.inf  # that of the elements: nothing moves over the mesh
    ends: ClassVar[bool] = True
    operator: ClassVar[None] = None

    def press(self, depth: float, guess: float) -> Pressed:
        """Press to a depth, m."""
        return Pressed(self.stiffness * depth, self.radius, 1, 1)


def still(indenter: Indenter, radii: Array, numerics: Numerics) -> Still:
    """A block at rest, whose area touches at once, or a ball; ``radii``, m, where its surface overlaps the plane."""
    block = indenter.shape
    if not isinstance(block, Block):
        return _round.still(indenter, radii, numerics)
    radius = block.fixed_radius
    unit = _unit_block(
        indenter.material.nu,
        FEWER * numerics.elements_per_contact,
        numerics.order,
        0.5 * block.thickness / radius,
        block.sides,
        block.faces,
    )
    return replace(unit, stiffness=radius * unit.stiffness, radius=radius)


def solid(indenter: Indenter, radii: Array, numerics: Numerics) -> SolidMesh:
    """The upper half of a block for large strains; of one that is strained alike few elements are all."""
    block = indenter.shape
    assert isinstance(block, Block)
    elements, radius = SHARP_REFINEMENT * FEWER * numerics.elements_per_contact, block.fixed_radius
    half = 0.5 * block.thickness / radius
    body = _solid_block(1.0 if block.uniform else elements, numerics.order, half, block.sides, block.faces)
    return SolidMesh(body, radius, covered=True, ends=True, lead=0.5, sharp=not block.uniform)


@cached
@on_disk
def _unit_block(poisson: float, elements: float, order: int, half_height: float, sides: str, faces: str) -> BlockStill:
    """A block of unit radius and unit modulus, that of its sides, by one half of it."""
    free = sides == "free"
    basis = basis_on(made(meshes.prism, elements, half_height, free and faces == "bonded"), order)
    young = 1.0 if free else (1.0 + poisson) * (1.0 - 2.0 * poisson) / (1.0 - poisson)
    matrix = stiffness(basis, isotropic(young, poisson)).tocsc()
    fixed = held(basis, along=_still_radially(sides, faces), across=("surface", "base"))
    moved = 2 * basis.get_dofs("surface").flatten() + 1
    displacement = np.zeros(2 * basis.N)
    displacement[moved] = -0.5  # half of a unit depth
    loose = np.setdiff1d(np.arange(displacement.size), fixed)
    displacement[loose] = linalg.spsolve(matrix[loose][:, loose], -(matrix @ displacement)[loose])
    return BlockStill(2.0 * float(displacement @ (matrix @ displacement)), 1.0, displacement.size)


@cached
def _solid_block(elements: float, order: int, half_height: float, sides: str, faces: str) -> ElasticBody:
    """Of unit radius, no finer at its corners, where stresses are infinite."""
    basis = basis_on(made(meshes.prism, elements, half_height, False), order)
    fixed = held(basis, along=_still_radially(sides, faces), across=("base",))
    return ElasticBody.alone(basis, fixed, face(basis, 1.0))


def _still_radially(sides: str, faces: str) -> tuple[str, ...]:
    """Boundaries that do not move sideways."""
    return ("inside", *(("surface",) if faces == "bonded" else ()), *(() if sides == "free" else ("outside",)))


MEMBER = MeshedTarget(still, struck=_round.struck, relaxing=_round.relaxing, paired=True, solid=solid)
