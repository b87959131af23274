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
    from lumped.result.score import Curve


def identify(
    curves: Mapping[str, Curve],
    scene: str | Path | Table,
    free: Sequence[str],
    own: Mapping[str, Mapping[str, object]] | None = None,
    overrides: Mapping[str, object] | None = None,
    corner: float | None = None,
    each: bool = False,
) -> Identified:
    """The free keys of a scene, as `target.material.E0`, from one or several curves, by their names, together.

    `scene`: a file, a packaged name, or the tables; `overrides`: keys set in it. `own`: by a curve's name the keys that
    its impact has of its own, as {"striker.velocity": 0.3}. `corner`: of the instrument's low pass of first order, Hz,
    where no silence tells the noise's colour. `each`: every curve alone too. Raises BadInput, and NotReached where no
    impact of the scene comes near the curves.
    """
    # what a search needs is imported with the first one: most work needs none
    from lumped.identify.keys import SceneFile
    from lumped.identify.search import search

    if not curves:
        raise BadInput(Fault("curves", "", "none; accepted: at least one measured history"))
    file, theirs = SceneFile.of(scene, overrides or {}), own or {}
    together = search(curves, file, free, theirs, corner)
    if not each or len(curves) == 1:
        return together
    alone = {name: search({name: curve}, file, free, theirs, corner) for name, curve in curves.items()}
    return replace(together, each=alone)
