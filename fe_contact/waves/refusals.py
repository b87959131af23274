"""Scenes that waves are not for, each with its reason."""

from __future__ import annotations

import math

from lumped.errors import Fault
from lumped.materials.radiation import shear_speed
from lumped.scene.scene import Scene

FASTEST = 0.3  # of the speed of shear waves: beyond, strains are not small anywhere


def too_fast(scene: Scene) -> list[Fault]:
    """Nearer to the speed of shear waves than small displacements reach."""
    speeds = [speed for _, material in scene.geometry.yielding if (speed := shear_speed(material)) is not None]
    speed = min(speeds, default=math.inf)
    if scene.velocity < FASTEST * speed:
        return []
    reason = f"{scene.velocity:g} m/s: accepted below {FASTEST:g} of the speed of shear waves, {speed:.3g} m/s"
    return [Fault(scene.source, "striker.velocity", reason)]


def changing(scene: Scene) -> list[Fault]:
    """A Poisson's ratio that changes in time."""
    reason = '"bulk" changes nu in time, which no far field follows in this version; accepted: "poisson"'
    return [
        Fault(scene.source, f"{part}.material.constant", reason)
        for part, material in scene.geometry.yielding
        if material.constant == "bulk" and not material.young.is_elastic
    ]
