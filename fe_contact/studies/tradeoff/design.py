"""Which settings a trade-off tries: the planned defaults, and around them a few settings varied at a time."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

from fe_contact.budget.plan import plan
from fe_contact.settings import Given, Numerics
from lumped.scene.scene import Scene
from lumped.schema import Table

MARKED = (1e-3, 1e-4)  # tolerances whose defaults are marked

Settings = Table


def defaults(scene: Scene, given: Given) -> dict[float, Numerics]:
    """The planned settings of the marked tolerances, and of the one given. Raises NotReached."""
    asked = dict.fromkeys((*MARKED, float(given.get("tolerance", MARKED[0]))))
    return {tolerance: plan(scene, {**given, "tolerance": tolerance}).numerics for tolerance in asked}


def variations(base: Numerics, given: Given, quick: bool) -> tuple[Numerics, ...]:
    """Settings around ``base``, each once; those the user gave stay as they are."""
    chosen = _quick(base) if quick else _full(base)
    kept = [{key: value for key, value in change.items() if key not in given} for change in chosen]
    return tuple(dict.fromkeys(base.varied(**change) for change in kept))


def _quick(base: Numerics) -> Iterator[Settings]:
    yield from grid(order=(2, 3), elements_per_contact=(base.elements_per_contact,))
    yield from grid(elements_per_contact=(1, 2, 8))
    yield from grid(steps=(16, 64, 128))
    yield from grid(enforcement=("penalty",), penalty=(1e2, base.penalty, 1e4))
    yield from grid(enforcement=("corrected",), penalty=(1e2, 1e4))


def _full(base: Numerics) -> Iterator[Settings]:
    yield from grid(order=(2, 3, 4), elements_per_contact=(1, 2, 4, 8))
    yield from grid(order=(3, 4), steps=(16, 24, 32, 48, 64, 96, 128))
    yield from grid(order=(4,), elements_per_contact=(1, 2, 8), steps=(16, 32, 96))
    yield from grid(order=(2,), elements_per_contact=(8,), steps=(16, 64, 128))
    yield from grid(enforcement=("penalty", "corrected"), penalty=(1e1, 1e2, 1e3, 1e4, 1e5))
    yield from grid(enforcement=("penalty", "corrected"), penalty=(1e4,), steps=(64, 128))
    yield from grid(elements_per_contact=(4, 8), far_radius=(10.0, 40.0), steps=(base.steps, 96))


def grid(**choices: tuple[Any, ...]) -> Iterator[Settings]:
    """Every combination of the values of some settings."""
    for values in product(*choices.values()):
        yield dict(zip(choices, values, strict=True))
