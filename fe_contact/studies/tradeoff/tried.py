"""What a trade-off tries of a scene: settings of finite elements around the default's, and every law that answers it.

A few settings are varied at a time, the most telling ones first. Without inertia they are those of the contact and of
its mesh; a line of elements, of which a wave crosses one in a step, has its steps, its scheme and where its mass
stands; a body meshed whole has all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

import numpy as np

from fe_contact.assembly.cache import forget
from fe_contact.assembly.disk_cache import without_disk
from fe_contact.budget.runs import operations
from fe_contact.methods import exact_laws
from fe_contact.reference import fe, result_of, solve
from fe_contact.settings import KEYS, Given, Numerics
from fe_contact.studies.tradeoff.point import MEASURED, Answer
from lumped import laws, simulate
from lumped.errors import FeContactError, NotReached
from lumped.laws import mdr
from lumped.result.result import unmet
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.shapes._block import Block
from lumped.targets.rod import Rod

# A law by name, and the springs of its row, each a point of the chart.
ROW, ROW_ELEMENTS = "mdr row", (25, 50, 100, 200, 400)
LAW_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)  # for which exact laws are asked, each a point of the chart
MODEL_TOLERANCE = LAW_TOLERANCES[-2]  # for which the others are, which err however finely they are integrated
LIGHTLY_VISCOUS = 0.8  # spectral radius of schemes that have one, on a line

Settings = Table
Asked = tuple[str, Settings]  # a law and what it is asked for


def by_elements(scene: Scene, given: Given) -> Answer:
    """The impact by finite elements from nothing but loaded modules: every operator is built again.

    Raises NotReached, and BadInput for a scene that they refuse.
    """
    forget()
    with without_disk():
        if scene.model.inertia:
            result = fe(scene, given)
            return Answer.of(result, operations=_of_waves(result.work))
        solved = solve(scene, given)
        found = solved.certified
        return Answer.of(result_of(scene, solved), operations=operations(found.work, found.surface))


def fixed(numerics: Numerics) -> Given:
    """All that may be chosen, as a user would give it: nothing is refined then."""
    return {key: value for key, value in numerics.as_dict().items() if key in KEYS}


def _of_waves(work: Mapping[str, float]) -> float:
    """N unknowns in the plane: N^(3/2) a factorisation, N log2 N a step's back-substitution; on a line N a step.

    George 1973, doi:10.1137/0710032.
    """
    unknowns = work["degrees_of_freedom"]
    if "factorizations" not in work:
        return work["steps"] * unknowns
    return float(work["factorizations"] * unknowns**1.5 + work["solves"] * unknowns * np.log2(unknowns))


def by_law(scene: Scene, method: str, settings: Settings) -> Answer:
    """A law to a tolerance, or the row of springs of so many elements: one march, no bar, no history.

    Raises NotReached, also where the law does not follow the impact to its end.
    """
    if method != ROW:
        found = simulate(laws.get(method).of(scene), scene, settings["tolerance"])
        if not (found.converged or unmet(found.quantities, found.tolerance)):
            raise NotReached(found.message)
        return Answer.of(found)
    scales = vars(mdr.estimate(scene, elements=settings["elements"]))
    return Answer(settings, {name: scales[name] for name in MEASURED}, None, settings)


def asked_laws(scene: Scene, quick: bool) -> tuple[Asked, ...]:
    """Exact laws at several tolerances, the row of springs where that is one, every other law that answers once.

    A scene without a geometry is one of its own law's.
    """
    exact = exact_laws(scene)
    tolerances = LAW_TOLERANCES[::2] if quick else LAW_TOLERANCES
    found: list[Asked] = [(ROW, {"elements": count}) for count in ROW_ELEMENTS if mdr.SpringRow.name in exact]
    found += [(name, {"tolerance": tolerance}) for name in exact for tolerance in tolerances]
    others = (name for name in laws.available() if scene.has_geometry and name not in exact and answers(scene, name))
    return (*found, *((name, {"tolerance": MODEL_TOLERANCE}) for name in others))


def answers(scene: Scene, name: str) -> bool:
    """Whether a law can be made for the scene."""
    try:
        laws.get(name).of(scene)
    except FeContactError:
        return False
    return True


def variations(scene: Scene, base: Numerics, quick: bool) -> Iterator[Settings]:
    """A few settings varied at a time around those of the default."""
    if not scene.model.inertia:
        return _few(base) if quick else _many(base)
    on_a_line = isinstance(scene.target, Rod) or isinstance(scene.shape, Block)
    return line_variations(base, quick) if on_a_line else meshed_variations(base, quick)


def grid(**choices: tuple[Any, ...]) -> Iterator[Settings]:
    """Every combination of the values of some settings."""
    for values in product(*choices.values()):
        yield dict(zip(choices, values, strict=True))


def _few(base: Numerics) -> Iterator[Settings]:
    elements, penalty = base.elements_per_contact, base.penalty
    fewer, more = (4 * round(base.steps * share / 4) for share in (0.6, 1.6))
    yield from grid(elements_per_contact=(max(elements / 2, 1.0),))
    yield from grid(steps=(fewer, more))
    yield from grid(order=(3, 2))
    yield from grid(enforcement=("penalty",), penalty=(penalty, 10 * penalty))
    yield from grid(enforcement=("corrected",), penalty=(penalty / 10, 10 * penalty))
    yield from grid(elements_per_contact=(1.0,), steps=(fewer,))


def _many(base: Numerics) -> Iterator[Settings]:
    yield from _few(base)
    yield from grid(order=(4, 3, 2), elements_per_contact=(1, 2, 4, 8))
    yield from grid(order=(4, 3), steps=(16, 24, 32, 48, 64, 96, 128))
    yield from grid(order=(4,), elements_per_contact=(1, 2, 8), steps=(16, 32, 96))
    yield from grid(order=(2,), elements_per_contact=(8,), steps=(16, 64, 128))
    yield from grid(enforcement=("penalty", "corrected"), penalty=(1e1, 1e2, 1e3, 1e4, 1e5))
    yield from grid(enforcement=("penalty", "corrected"), penalty=(1e4,), steps=(64, 128))
    yield from grid(elements_per_contact=(4, 8), far_radius=(10.0, 40.0), steps=(base.steps, 96))


def meshed_variations(base: Numerics, quick: bool) -> Iterator[Settings]:
    """Coarser alone and together; what else could have been chosen."""
    elements, steps, penalty = base.elements_per_contact, base.steps, base.penalty
    coarse = tuple(elements * share for share in (1 / 3, 1 / 2, 2 / 3))
    fewer = tuple(4 * round(steps * share / 4) for share in (1 / 8, 1 / 4, 1 / 2))
    yield from grid(elements_per_contact=coarse[1:2], steps=fewer[1:], penalty=(penalty / 2,))
    yield from grid(elements_per_contact=coarse[1:])
    yield from grid(steps=fewer[1:])
    yield from grid(penalty=(penalty / 4, penalty * 4))
    yield from grid(scheme=("trapezoidal",), mass=("consistent", "redistributed"), steps=fewer[2:])
    if not quick:
        yield from grid(elements_per_contact=coarse[:2], steps=fewer[:2])
        yield from grid(mass=("lumped", "redistributed"), steps=fewer[1:])
        yield from grid(scheme=("hht", "fully_implicit"), steps=fewer[1:])
        yield from grid(enforcement=("penalty", "exact", "augmented"), steps=fewer[1:2])
        yield from grid(order=(1, 2), steps=fewer[1:2])


def line_variations(base: Numerics, quick: bool) -> Iterator[Settings]:
    """Fewer steps and more; schemes with the masses on which they are stable or known to fail; other enforcements."""
    yield from grid(steps=tuple(base.steps * 2**power // 8 for power in range(2 if quick else 0, 6)))
    yield from grid(scheme=("generalised_alpha",), rho=(LIGHTLY_VISCOUS,), mass=("redistributed", "consistent"))
    yield from grid(scheme=("staged", "fully_implicit"))
    if not quick:
        yield from grid(scheme=("trapezoidal", "hht"), rho=(LIGHTLY_VISCOUS,), mass=("redistributed", "spread"))
        yield from grid(enforcement=("penalty", "corrected", "augmented"), penalty=(1.0, 1e2))
