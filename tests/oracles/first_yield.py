"""Where a body under Hertz' pressure begins to yield."""

from __future__ import annotations

import numpy as np

DEEPEST = 2.0  # contact radii: below them the axis' shear stress only falls


def first_yield(poisson: float) -> tuple[float, float]:
    """C = p_0/Y of Hertz' contact as it begins to yield, and at which depth under the axis, in contact radii.

    Of the exact stresses on the axis, Johnson, Contact Mechanics (1985), (3.45); 1.613 and 0.48 at nu = 0.3.
    """
    depth = np.linspace(0.0, DEEPEST, 20_001)
    safe = np.maximum(depth, 1e-12)
    side = 1.0 / (1.0 + depth**2)
    radial = -(1.0 + poisson) * (1.0 - depth * np.arctan(1.0 / safe)) + 0.5 * side
    shear = np.abs(radial + side)
    deepest = int(shear.argmax())
    return 1.0 / float(shear[deepest]), float(depth[deepest])
