"""What strikes what: the bodies that finite elements and the laws of the half-space need."""

from __future__ import annotations

from dataclasses import dataclass

from lumped.materials import Material
from lumped.shapes import Shape
from lumped.shapes._block import Block
from lumped.targets import Target


@dataclass(frozen=True)
class Geometry:
    """What finite elements and the laws of the half-space need: striker's shape, target, its material.

    `striker_material`: of a striker which yields as the target does, None: rigid.
    """

    shape: Shape
    target: Target
    material: Material
    striker_material: Material | None = None

    @property
    def striking(self) -> Material | None:
        """The striker's material, None where it is rigid."""
        return self.striker_material if self.target.deformable else self.material

    @property
    def yielding(self) -> list[tuple[str, Material]]:
        """The bodies that have a material, by the table that gives it."""
        found = [("striker", self.striking), ("target", self.material if self.target.deformable else None)]
        return [(part, material) for part, material in found if material is not None]

    @property
    def surface_remembers(self) -> bool:
        """Whether elastic bodies and E*(t) tell all: of a body with lengths, where nu stays or strain is uniform."""
        materials = [self.material] if self.striker_material is None else [self.material, self.striker_material]
        steady = all(one.constant == "poisson" or one.young.is_elastic for one in materials)
        uniform = isinstance(self.shape, Block) and self.shape.uniform
        return steady or uniform or not self.target.has_length
