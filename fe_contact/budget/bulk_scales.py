"""A scene of constant Poisson's ratio much like one of constant bulk modulus, of which the plan takes its scales."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from lumped.materials import Material, Relaxation
from lumped.scene.scene import Scene


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
