"""A load curve by slow indentation, for the laws, where the target has none in closed form."""

from __future__ import annotations

import numpy as np

from fe_contact.budget.scales import has_curve
from fe_contact.indentation import indent
from lumped.load_curves.sampled import SampledCurve
from lumped.scene.answered import Answered
from lumped.scene.indenter import Indenter
from lumped.scene.scene import Scene

DEPTHS = 16
SHALLOWEST, DEEPEST = 1e-2, 1.02  # over the depth of the impact
TOLERANCE = 3e-4


def known(scene: Scene, depth: float) -> tuple[Scene, float]:
    """The scene on a curve that finite elements found down to a depth, m, and the force's relative error on it.

    As it is, and 0, where the curve is known in closed form or no slow indentation is. Raises NotReached.
    """
    if scene.target.only_with_inertia or not scene.geometry.surface_remembers or has_curve(scene):
        return scene, 0.0
    asked = tuple(float(one) for one in np.geomspace(SHALLOWEST * depth, DEEPEST * depth, DEPTHS))
    slow = Indenter(scene.profile, scene.geometry.material, scene.target, scene.striker_material)
    pressed = indent(slow, asked, {"tolerance": TOLERANCE})
    forces = pressed.force / (pressed.modulus * scene.geometry.shape.total)
    curve = SampledCurve(
        asked, tuple(float(force) for force in forces), tuple(float(radius) for radius in pressed.contact_radius)
    )
    return Answered.by(scene, curve), float(np.max(pressed.force_error / pressed.force))
