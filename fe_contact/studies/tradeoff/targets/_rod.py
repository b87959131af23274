"""A rod: steps and elements are one, and its exact waves are known where it is elastic."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from fe_contact.settings import WaveNumerics
from fe_contact.studies.tradeoff.design import Settings, grid
from fe_contact.studies.tradeoff.tried import TriedBody
from fe_contact.studies.tradeoff.truth import Truth
from lumped import laws
from lumped.errors import BadInput
from lumped.scene.scene import Scene

EXACT_TOLERANCE = 1e-8


def forget() -> None:
    """Nothing is kept of a rod."""


def exact(scene: Scene) -> Truth | None:
    """By the waves' own law; None of a rod whose waves disperse."""
    try:
        law = laws.get("rod_waves").of(scene)
    except BadInput:
        return None
    return Truth.of(law.simulate(scene, EXACT_TOLERANCE))


def variations(base: WaveNumerics, quick: bool) -> Iterator[Settings]:
    """A striker that dents the rod presses by a law of its own: enforcement changes nothing then."""
    yield from grid(steps=tuple(base.steps * 2**power // 8 for power in range(2 if quick else 0, 6)))
    yield from grid(scheme=("generalised_alpha",), rho=(0.5,), mass=("consistent", "redistributed"))
    yield from grid(scheme=("staged", "fully_implicit"))
    if not quick:
        yield from grid(scheme=("hht", "trapezoidal"), mass=("redistributed", "spread"))
        yield from grid(enforcement=("penalty", "corrected"), penalty=(1.0, 1e2))


def operations(work: Mapping[str, float]) -> float:
    """A line of elements: every step some operations an unknown."""
    return work["steps"] * work["degrees_of_freedom"]


ROD = TriedBody(variations, exact, operations, forget)
