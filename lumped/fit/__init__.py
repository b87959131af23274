"""Fitting a law to a history: what its parameters are, how well they are known, and how far it still errs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from lumped.fit.record import RECORD as RECORD
from lumped.fit.record import Estimate as Estimate
from lumped.fit.record import Fit as Fit
from lumped.fit.record import write_failure as write_failure
from lumped.progress import Progress, silent

if TYPE_CHECKING:
    from lumped.fit.space import Bounds
    from lumped.result.history import History
    from lumped.result.score import Curve
    from lumped.scene.scene import Scene


def fit(
    curve: History | Curve,
    law: str,
    scene: Scene,
    free: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    bounds: Bounds | None = None,
    peak: bool = False,
    progress: Progress = silent,
) -> Fit:
    """Fit the law of this name to a force over time; mass, velocity and geometry are the scene's.

    `free`: names of the parameters to find, the law's own (`k`, `alpha`, `xi`, `e` ...), those of the material
    (`E0`, `R1`, `R2`; `E1`, `E2`, `C1`; `E`, `eta`) or `touch`, when the bodies meet on the curve's clock, s. By
    default stiffness and damping, or R1 and R2. `fixed`: values held; the rest is the scene's. `bounds`: name ->
    (low, high). `peak`: least error at equal peak force, as "(26)". `progress` is told how many impacts were
    computed. Raises BadInput, and NotReached where no search converges.
    """
    # what a search needs is imported with the first one: most work needs none
    from lumped.fit.search import search

    return search(curve, law, scene, free, fixed, bounds, peak, progress)
