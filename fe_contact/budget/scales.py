"""How large an impact will be, so that mesh, memory and time steps can be placed; nothing of it enters a value.

By the exact row of springs, by the target's exact load curve, or, where there is none, by one that a coarse mesh
answers at a few depths.

A body of constant bulk modulus has the scales of one of constant Poisson's ratio that is as stiff at once and in the
end (:func:`with_constant_nu`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from fe_contact.assembly.forms import check_compressible
from fe_contact.bodies.pressing import Still
from fe_contact.settings import Numerics
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.targets.base import TARGETS
from lumped.errors import BadInput
from lumped.laws import correspondence, mdr
from lumped.load_curves.base import LoadCurve
from lumped.load_curves.fixed_area import Column
from lumped.load_curves.sampled import SampledCurve
from lumped.materials import Material, Relaxation
from lumped.scene.geometry import Geometry, stiffest_impact
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Answered, Scene
from lumped.targets import HalfSpace

SPRINGS = 32  # along the contact radius: scales within one per cent place everything well
# Work: of the mesh that tells how large a contact will be; order of its elements.
COARSE = {"elements_per_contact": 2.0, "order": 2}
# Contact radii on a round body, over its radius, at which the coarse mesh is asked.
WIDTHS = tuple(float(share) for share in np.geomspace(5e-3, 0.6, 9))


def scales(scene: Scene, numerics: Numerics) -> mdr.ImpactScales:
    """Of a scene; ``numerics`` but for the settings that are coarse. Raises NotReached, BadInput."""
    geometry = scene.geometry
    if isinstance(geometry.target, HalfSpace) and geometry.shape.fixed_radius is None and not geometry.shape.plane:
        return mdr.estimate(scene, SPRINGS)
    coarse, curve = numerics.varied(**COARSE), has_curve(scene)
    if not (curve and geometry.surface_remembers):
        check_compressible(scene)
    if not geometry.surface_remembers:
        scene = with_constant_nu(scene, partial(_stiffness, scene, coarse))
    if not curve:
        scene = Answered.by(scene, _answer(scene, coarse))
    return correspondence.estimate(scene)


def _stiffness(scene: Scene, coarse: Numerics, elastic: Material) -> float:
    """Of an elastic target, in any unit; a round body counts as the half-space that it is near its contact."""
    geometry, modulus = replace(scene.geometry, material=elastic), half_space_stiffness(elastic)
    fixed = geometry.target.fixed_radius(geometry.shape)
    if has_curve(scene):
        stiffest = stiffest_impact(geometry.shape, scene.contact_modulus, scene.reduced_mass, scene.velocity)
        return modulus * float(geometry.target.load_curve(scene.profile, elastic.nu).force(stiffest.depth))
    return modulus if fixed is None else modulus * _flat_end(geometry, fixed, coarse).stiffness


def has_curve(scene: Scene) -> bool:
    """Whether the target's load curve is known in closed form."""
    try:
        scene.geometry.target.load_curve(scene.profile, scene.geometry.material.nu)
    except BadInput:
        return False
    return True


def _answer(scene: Scene, numerics: Numerics) -> LoadCurve:
    """By finite elements with these settings. Raises NotReached."""
    geometry = scene.geometry
    fixed = geometry.target.fixed_radius(geometry.shape)
    if fixed is not None:
        return Column(fixed, math.pi * fixed**2 / _flat_end(geometry, fixed, numerics).stiffness)
    indenter = Indenter(scene.profile, geometry.material, geometry.target, geometry.striker_material)
    radii = np.array(WIDTHS) * geometry.target.round_radius(geometry.shape)
    depths = -geometry.target.overlap(indenter.profile, radii, 0.0) / geometry.target.lead
    still: Still = TARGETS.get(geometry.target.name).still(indenter, radii, numerics)
    pressed = [still.press(float(depth), float(radius)) for depth, radius in zip(depths, radii, strict=True)]
    columns = zip(*((one.force, one.contact_radius) for one in pressed), strict=True)
    forces, widths = (tuple(float(value) for value in column) for column in columns)
    return SampledCurve(tuple(float(depth) for depth in depths), forces, widths)


def with_constant_nu(scene: Scene, stiffness: Callable[[Material], float]) -> Scene:
    """As stiff as the scene at once and, if it is a solid, in the end.

    ``stiffness`` of the target, made of an elastic material, N or any unit; a striker that relaxes counts as the
    half-space that it is near its contact.
    """
    striker = scene.striker_material
    return replace(
        scene,
        material=_alike(scene.geometry.material, stiffness),
        striker_material=None if striker is None else _alike(striker, half_space_stiffness),
    )


def half_space_stiffness(elastic: Material) -> float:
    """Contact modulus of an elastic material, Pa."""
    return elastic.contact_modulus().glassy


def _alike(material: Material, stiffness: Callable[[Material], float]) -> Material:
    """What lies between the stiffness at once and in the end is the network's, and the viscosity counts as a spring."""
    if material.constant == "poisson":
        return material
    sudden = material.elastic(instant=True)
    slow = material.elastic(instant=False) if material.young.relaxed > 0.0 else None
    nu = sudden.nu if slow is None else slow.nu
    young = material.young
    springs = young.glassy - young.relaxed
    wanted = stiffness(sudden) / stiffness(Material(Relaxation(1.0), nu))
    share = (wanted - young.relaxed) / springs if springs > 0.0 else 1.0
    network = Relaxation(
        young.equilibrium, tuple(share * modulus for modulus in young.moduli), young.times, share * young.viscosity
    )
    return replace(material, young=network, nu=nu, constant="poisson", bulk_modulus=None)


def _flat_end(geometry: Geometry, radius: float, numerics: Numerics) -> FlatEnd:
    return FlatEnd.of(geometry, radius, numerics, TARGETS.get(geometry.target.name).still)
