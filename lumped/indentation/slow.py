"""Slow indentation by the target's own load curve, exact to its stated accuracy, or by Hertz's."""

from __future__ import annotations

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.indentation.indentation import Indentation
from lumped.numbers.clock import Clock
from lumped.scene.indenter import Indenter

HALF_SPACE_ALONE = ("mdr", "hertz")


def indent(
    indenter: Indenter, depths: tuple[float, ...], method: str, instant: bool = False, tolerance: float = 1e-3
) -> Indentation:
    """Force and contact radius at every depth, m, by the load curve of the profile; Hertz's is the parabola's.

    Raises BadInput for depths and materials that cannot be, NotReached where the load curve ends.
    """
    if method in HALF_SPACE_ALONE and indenter.target.has_length:
        reason = f"{method} knows the half-space alone; accepted: another method, or half_space without a datum"
        raise BadInput(Fault(indenter.source, "target.shape", reason))
    clock = Clock()
    depth, modulus = np.array(indenter.checked(depths)), indenter.modulus(instant)
    shape = indenter.shape.resolved("parabola") if method == "hertz" else indenter.profile
    with indenter.addressed():
        curve = indenter.target.load_curve(shape, indenter.elastic(instant).material.nu)
        force = modulus * shape.total * np.asarray(curve.force(depth))
    return Indentation(
        indenter=indenter,
        method=method,
        modulus=modulus,
        tolerance=tolerance,
        depth=depth,
        force=force,
        contact_radius=np.asarray(curve.contact_radius(depth)),
        force_error=curve.accuracy * force,
        timing=clock.read(),
    )
