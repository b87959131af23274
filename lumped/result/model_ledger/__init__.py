"""What a model of impact or slow indentation leaves out, each effect estimated relative to peak force."""

from __future__ import annotations

from lumped.result.model_ledger import kinematics, material, motion
from lumped.result.model_ledger.peak import Peak as Peak
from lumped.result.sufficiency import LedgerEntry
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene
from lumped.scene.tables import Model
from lumped.targets.rod import Rod


def model_ledger(scene: Scene, peak: Peak, model: Model | None = None) -> tuple[LedgerEntry, ...]:
    """The ledger of a scene under `model` (default: the scene's own), with the scales of its impact."""
    resolved = model or scene.model
    if not scene.has_geometry:
        return (motion.gravity(scene, resolved, peak.force, scene.mass),)
    dented = isinstance(scene.target, Rod) and scene.profile.fixed_radius is None
    if dented:
        peak = kinematics.of_dent(scene, peak)
    height = scene.geometry.target.pressed_height(scene.geometry.shape)
    entries = [
        motion.inertia(scene, resolved, peak),
        kinematics.profile(scene.geometry.shape, resolved, peak),
        kinematics.finite_strain(scene.geometry.material.nu, height, peak, kinematics.IN_AN_IMPACT),
        material.sideways(scene, peak),
        material.series(scene, peak),
        material.striker(scene),
        motion.gravity(scene, resolved, peak.force, scene.mass),
        material.plasticity(scene, peak),
        material.adhesion(scene, peak),
    ]
    if scene.geometry.shape.plane:
        entries.append(kinematics.ends(scene.geometry.shape, scene.geometry.target, scene.geometry.material.nu))
    if dented:
        entries.append(kinematics.rod_end(scene, peak))
    return tuple(entries)


def ledger_at_rest(indenter: Indenter, peak: Peak) -> tuple[LedgerEntry, ...]:
    """The same of a slow indentation at its deepest, which has neither inertia nor time."""
    shape, target, nu = indenter.shape, indenter.target, indenter.material.nu
    entries = [kinematics.finite_strain(nu, target.pressed_height(shape), peak)]
    if target.fixed_radius(shape) is None:
        entries.append(kinematics.profile(shape, indenter.model, peak))
    return (*entries, kinematics.ends(shape, target, nu)) if shape.plane else tuple(entries)
