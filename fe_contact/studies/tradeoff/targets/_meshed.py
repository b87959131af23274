"""A body meshed whole: mesh, steps, penalty, mass and scheme each on its own; nothing exact is known."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from fe_contact.settings import WaveNumerics
from fe_contact.studies.tradeoff.design import Settings, grid
from fe_contact.studies.tradeoff.tried import TriedBody
from fe_contact.studies.tradeoff.truth import Truth
from fe_contact.waves.ball_body import unit_ball
from fe_contact.waves.half_space_body import unit_body
from fe_contact.waves.layer_body import unit_layer
from lumped.scene.scene import Scene


def forget() -> None:
    """All matrices of unit bodies."""
    for made in (unit_body, unit_layer, unit_ball):
        made.cache_clear()


def exact(scene: Scene) -> Truth | None:
    """None is known."""
    return None


def variations(base: WaveNumerics, quick: bool) -> Iterator[Settings]:
    """Coarser alone and together, finer a little; what else could have been chosen."""
    elements, steps, penalty = base.elements_per_contact, base.steps, base.penalty
    coarse = tuple(elements * share for share in (1 / 3, 1 / 2, 2 / 3))
    fewer = tuple(4 * round(steps * share / 4) for share in (1 / 8, 1 / 4, 1 / 2))
    yield from grid(elements_per_contact=coarse[1:])
    yield from grid(steps=fewer[1:])
    yield from grid(penalty=(penalty / 4, penalty * 4))
    yield from grid(elements_per_contact=coarse[1:2], steps=fewer[1:], penalty=(penalty / 2,))
    yield from grid(scheme=("trapezoidal",), mass=("consistent", "redistributed"), steps=fewer[2:])
    if not quick:
        yield from grid(elements_per_contact=coarse[:2], steps=fewer[:2])
        yield from grid(mass=("lumped", "redistributed"), steps=fewer[1:])
        yield from grid(scheme=("hht", "fully_implicit"), steps=fewer[1:])
        yield from grid(enforcement=("penalty", "exact", "augmented"), steps=fewer[1:2])
        yield from grid(order=(1, 2), steps=fewer[1:2])


def operations(work: Mapping[str, float]) -> float:
    """N unknowns in the plane: N^(3/2) a factorisation, N log2 N a step's back-substitution.

    George 1973, doi:10.1137/0710032.
    """
    unknowns = work["degrees_of_freedom"]
    return float(work["factorizations"] * unknowns**1.5 + work["solves"] * unknowns * np.log2(unknowns))


MESHED = TriedBody(variations, exact, operations, forget)
