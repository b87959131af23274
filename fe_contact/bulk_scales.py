"""A scene of constant Poisson's ratio much like one of constant bulk modulus, of which the plan takes its scales."""

from __future__ import annotations

from dataclasses import replace

from lumped.materials import Material, Relaxation
from lumped.scales import stiffest_impact
from lumped.scene import Scene


def with_constant_nu(scene: Scene) -> Scene:
    """As stiff as the scene at once and, if it is a solid, in the end: both by the target's own load curve.

    What lies between is the network's, and the viscosity counts as a spring does.
    """
    material = scene.geometry.material
    sudden = material.elastic(instant=True)
    slow = material.elastic(instant=False) if material.young.relaxed > 0.0 else None
    nu = sudden.nu if slow is None else slow.nu
    springs = material.young.glassy - material.young.relaxed
    wanted = _stiffness(scene, sudden) / _stiffness(scene, Material(Relaxation(1.0), nu))
    share = (wanted - material.young.relaxed) / springs if springs > 0.0 else 1.0
    young = material.young
    network = Relaxation(
        young.equilibrium, tuple(share * modulus for modulus in young.moduli), young.times, share * young.viscosity
    )
    return replace(scene, material=replace(material, young=network, nu=nu, constant="poisson", bulk_modulus=None))


def _stiffness(scene: Scene, elastic: Material) -> float:
    """Force of an elastic target at about the depth of the impact, N."""
    shape, stiffest = scene.geometry.shape, scene.contact_modulus
    depth = stiffest_impact(shape, stiffest, scene.reduced_mass, scene.velocity).depth
    curve = scene.target.load_curve(scene.profile, elastic.nu)
    return elastic.contact_modulus().glassy * float(curve.force(depth))
