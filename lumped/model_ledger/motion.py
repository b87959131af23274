"""What a model leaves out of the motion: the inertia of the target, the weight of the striker."""

from __future__ import annotations

from lumped.model_ledger.peak import Peak
from lumped.radiation import Pulse
from lumped.result import LedgerEntry
from lumped.scene import Scene
from lumped.scene_tables import Model

GRAVITY = 9.81


def inertia(scene: Scene, model: Model, peak: Peak) -> LedgerEntry:
    """As the target knows it."""
    effect = "target inertia"
    if model.inertia:
        return LedgerEntry(effect, "included", 0.0)
    mass, geometry = scene.reduced_mass, scene.geometry
    pulse = Pulse(peak.force, peak.duration, mass, 0.5 * mass * scene.velocity**2, peak.contact_radius)
    return LedgerEntry(effect, "neglected", *scene.target.inertia_left_out(geometry.shape, geometry.material, pulse))


def gravity(scene: Scene, model: Model, peak: Peak) -> LedgerEntry:
    """The weight of the striker."""
    if scene.target_mass is not None:
        return LedgerEntry("gravity", "none between two free bodies", 0.0)
    if model.gravity != 0.0:
        return LedgerEntry("gravity", "included", 0.0)
    return LedgerEntry("gravity", "neglected", GRAVITY * scene.mass / peak.force, "m g; model.gravity")
