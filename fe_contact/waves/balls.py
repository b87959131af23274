"""Deformable balls in flight at first touch: free, meshed whole, finest where they are touched first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import meshes
from fe_contact.assembly.cache import cached_by_unknowns
from fe_contact.assembly.forms import Array, check_compressible, isotropic, mass, stiffness
from fe_contact.assembly.operators import basis_on, made
from fe_contact.assembly.surface import crown, hats, trace_between
from fe_contact.bodies.pressing import WIDEST, held
from fe_contact.budget.plan import Plan
from fe_contact.dynamics.body import Part
from fe_contact.settings import RANGES, Given, WaveNumerics
from fe_contact.waves.moving import BEYOND, SMALLEST, Flying, UnitBody, WaveSide, together
from fe_contact.waves.plan import placed
from lumped.laws.mdr import ImpactScales
from lumped.materials import Material
from lumped.scene.scene import Scene
from lumped.shapes import Sphere


@dataclass(frozen=True)
class Ball:
    """Radius, m, material, and mass, kg: the mesh has this mass, whatever density the material has."""

    radius: float
    material: Material
    mass: float

    @classmethod
    def striking(cls, scene: Scene) -> Ball:
        """The striker of a scene that has a material."""
        shape, material = scene.geometry.shape, scene.geometry.striking
        assert isinstance(shape, Sphere)
        assert material is not None
        return cls(shape.radius, material, scene.mass)

    def points(self, numerics: WaveNumerics) -> tuple[Array, Array]:
        """Where it may be touched, m from the axis, and the areas seen along it, m2, each (q,)."""
        angles, areas, _ = self.unit(numerics).zone
        return self.radius * np.sin(angles), self.radius**2 * areas

    def side(self, numerics: WaveNumerics, places: Array) -> WaveSide:
        """In SI units, under points, m from the axis."""
        unit, modulus = self.unit(numerics), self.material.contact_modulus()
        angles = np.arcsin(np.minimum(places / self.radius, 1.0))
        trace = trace_between(unit.surface.corners(numerics.order, float(angles.max())), angles, numerics.order)
        volume, axial = float(unit.axial @ (unit.mass @ unit.axial)), unit.axial
        part = Part(self.radius * unit.stiffness[0], modulus)
        return WaveSide(self.mass / volume * unit.mass, (part,), None, unit.pushed(trace.shape[1]), trace, axial)

    def unit(self, numerics: WaveNumerics) -> UnitBody:
        """The ball of radius and contact modulus one that this is scaled from."""
        contact = min(float(np.arcsin(min(numerics.contact_radius / self.radius, 1.0))), WIDEST)
        elements = numerics.elements_per_contact * numerics.finer
        return unit_ball(self.material.nu, elements, numerics.order, contact, numerics.mass)


@cached_by_unknowns
def unit_ball(poisson: float, elements: float, order: int, contact: float, masses: str) -> UnitBody:
    """The mesh, to be assembled for radius and contact modulus one; points by their angles from the pole.

    Made once for all steps and penalties.
    """
    basis = basis_on(made(meshes.sphere, elements, SMALLEST, contact, order), order)
    return UnitBody(
        basis,
        crown(basis, contact, 0.0),
        held(basis, along=("axis",), across=()),
        masses,
        local=lambda: mass(basis),
        springs=lambda: [stiffness(basis, isotropic(1 - poisson**2, poisson))],
    )


def flying(
    scene: Scene,
    numerics: WaveNumerics,
    sides: Sequence[WaveSide],
    points: tuple[Array, Array],
    shares: Sequence[float],
    endless: bool = False,
) -> Flying:
    """The sides, the striker first, each with its share of the speed towards the others, and the common ``points``."""
    places, areas = points
    heights = np.minimum(-scene.target.overlap(scene.profile, places, 0.0), BEYOND * numerics.contact_radius)
    carriers = hats(places.size, numerics.order) if len(sides) > 1 else None
    start = [share * side.axial for share, side in zip(shares, sides, strict=True)]
    return Flying(
        together(sides, scene.gravity, areas, -heights, carriers),
        scene.velocity,
        places,
        endless,
        yielding=sides[0].size,
        start=np.concatenate(start),
        approach=np.concatenate([side.mean for side in sides]),
    )


def plan_in_flight(scene: Scene, given: Given, scales: ImpactScales, radius: float) -> Plan:
    """What ``given`` leaves open for an impact of these scales on bodies that end with a ball of this radius, m."""
    check_compressible(scene)
    low, high = RANGES["far_radius"]
    return placed(scene, given, scales, min(max(2.0 * radius / scales.contact_radius, low), high))
