"""What a model leaves out of the motion: the inertia of the target, the weight of the striker."""

from __future__ import annotations

from lumped.materials.radiation import Pulse
from lumped.result.model_ledger.peak import Peak
from lumped.result.sufficiency import LedgerEntry
from lumped.scene.scene import Scene
from lumped.scene.tables import Model

GRAVITY = 9.81
INERTIA = "model.inertia"


def inertia(scene: Scene, model: Model, peak: Peak) -> LedgerEntry:
    """As the target knows it."""
    effect = "target inertia"
    if model.inertia:
        return LedgerEntry(effect, "included", 0.0)
    mass, geometry = scene.reduced_mass, scene.geometry
    pulse = Pulse(peak.force, peak.duration, mass, 0.5 * mass * scene.velocity**2, peak.contact_radius)
    estimate, note = scene.target.inertia_left_out(geometry.shape, geometry.material, pulse)
    return LedgerEntry(effect, "neglected", estimate, note, INERTIA if scene.target.waves_under(geometry.shape) else "")


def gravity(scene: Scene, model: Model, force: float, mass: float) -> LedgerEntry:
    """The weight of a mass, kg, which presses only where the motion leads down, over the peak force, N."""
    effect, weight = "gravity", GRAVITY * mass / force
    if scene.target_mass is not None:
        return LedgerEntry(effect, "none between two free bodies", 0.0)
    if model.gravity != 0.0:
        return LedgerEntry(effect, "included", 0.0)
    if model.direction == "horizontal":
        return LedgerEntry(effect, "across the motion", 0.0)
    if model.direction == "down":
        return LedgerEntry(effect, "neglected", weight, "m g", "model.gravity")
    asked = f"model.direction: of a drop, 'down', it would be {weight:.2g}; else 'horizontal'"
    return LedgerEntry(effect, "none assumed", None, asked)
