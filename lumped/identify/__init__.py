"""Identifying a material, or any number of a scene, from measured histories: how well each is known, and by what law.

Through Ting's exact law on the scene's load curve: half-space, layer or ring. Touch is found for every curve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from lumped.errors import BadInput, Fault
from lumped.identify.record import RECORD as RECORD
from lumped.identify.record import FittedCurve as FittedCurve
from lumped.identify.record import Identified as Identified
from lumped.identify.record import Interval as Interval
from lumped.schema import Table

if TYPE_CHECKING:
    from lumped.identify.search import Reference
    from lumped.result.score import Curve

HIGHEST = 1e12  # safety: Hz, beyond any instrument's


def identify(
    curves: Mapping[str, Curve],
    scene: str | Path | Table,
    free: Sequence[str],
    own: Mapping[str, Mapping[str, object]] | None = None,
    overrides: Mapping[str, object] | None = None,
    corner: float | None = None,
    each: bool = False,
    sample: int = 0,
    reference: Reference | None = None,
    low_pass: float | None = None,
) -> Identified:
    """The free keys of a scene, as `target.material.E0`, from one or several curves, by their names, together.

    Every curve's touch is sought too, whether `free` names `touch` or not. `scene`: a file, a packaged name, or the
    tables; `overrides`: keys set in it. `own`: by a curve's name the keys that its impact has of its own, as
    {"striker.velocity": 0.3}. `corner`: of the instrument's low pass of first order, Hz, where no silence tells the
    noise's colour; `low_pass`: the same, where the force has passed it too, of rows in equal steps. `each`: every curve
    alone too. `sample`: how many draws of the posterior, see :mod:`lumped.identify.certainty`. `reference`: the history
    of a scene by another method, as finite elements, which corrects the law near the most likely place, see
    :mod:`lumped.identify.search`. Raises BadInput, and NotReached where no impact of the scene comes near the
    curves.
    """
    # what a search needs is imported with the first one: most work needs none
    from lumped.fit.space import TOUCH
    from lumped.identify.answer import answer
    from lumped.identify.keys import SceneFile
    from lumped.identify.search import correct, search

    if not curves:
        raise BadInput(Fault("curves", "", "none; accepted: at least one measured history"))
    faults = [
        Fault(name, "", f"{frequency:g}: accepted a frequency above zero, Hz")
        for name, frequency in (("corner", corner), ("low_pass", low_pass))
        if frequency is not None and not 0.0 < frequency < HIGHEST
    ]
    if corner is not None and low_pass is not None:
        faults.append(Fault("low_pass", "", "beside a corner; accepted: one of them"))
    if faults:
        raise BadInput(faults)
    free = [name for name in free if name != TOUCH]
    file, theirs = SceneFile.of(scene, overrides or {}).named_by(free), own or {}

    def found(some: Mapping[str, Curve]) -> Identified:
        histories, valleys = search(some, file, free, theirs, corner or low_pass, low_pass is not None)
        if reference is None:
            return answer(histories, valleys, tuple(some), sample)
        corrected = correct(histories, valleys, corner or low_pass, reference)
        return answer(corrected.histories, (corrected.valley,), tuple(some), sample, corrected.told)

    together = found(curves)
    if not each or len(curves) == 1:
        return together
    return replace(together, each={name: found({name: curve}) for name, curve in curves.items()})
