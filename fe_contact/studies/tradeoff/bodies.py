"""What differs from scene to scene in a trade-off: settings to try, the truth, what a run counts, the lumped methods.

Without inertia a point is a certified impact with every setting fixed, and the exact impact is the row of springs far
beyond any tolerance, and Ting's solution for the row of springs itself. A block and a rod with waves are elements that
a wave crosses in a step, exact where they are elastic; of a body meshed whole nothing exact is known.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from functools import partial
from itertools import product
from typing import Any

import numpy as np

from fe_contact.assembly.disk_cache import without_disk
from fe_contact.budget.certify import certify
from fe_contact.budget.runs import operations
from fe_contact.reference import check_target, fe
from fe_contact.settings import KEYS, Given, Numerics
from fe_contact.steppers.steps import Strike
from fe_contact.studies.tradeoff.point import MEASURED, Answer, Truth
from fe_contact.targets import half_space
from fe_contact.waves.balls import unit_ball
from fe_contact.waves.targets._block import bar_of
from fe_contact.waves.targets.half_space import unit_body
from fe_contact.waves.targets.layer import unit_layer
from lumped import laws, simulate
from lumped.errors import BadInput, Fault
from lumped.laws import mdr
from lumped.scene.scene import Scene
from lumped.schema import Table
from lumped.schema.members import unavailable
from lumped.shapes._block import Block
from lumped.solvers.bar import Bounces, StraightBar, bounces

EXACT_TOLERANCE = 1e-8  # of the laws that stand for the truth
# A law by name, and the springs of its row, each a point of the chart.
ROW, ROW_ELEMENTS = "mdr row", (25, 50, 100, 200, 400)
LAW_TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)  # for which laws are asked, each a point of the chart
MODELS = ("hertz", "correspondence")  # which err however finely they are integrated
WITHOUT_INERTIA = ("rod_waves", "mdr", "hertz")  # exact waves, and what is without any
BEFORE = 1.0 - 1e-12  # of a time: what comes just before it

Settings = Table
Lumped = tuple[str, Settings]  # a method and what it is asked for


@dataclass(frozen=True)
class TriedBody:
    """``run(scene, numerics)``: an impact with all settings fixed, every operator built again;
    ``planned(scene, given)``: with what a user gives, refined to the tolerance, None where plans are measured as such;
    ``variations(base, quick)``: settings around the default's; ``exact(scene)``: the truth in closed form, or None;
    ``lumped(quick)``: methods beside finite elements; ``others``: the truth for those of them that ``exact`` follows.
    """

    run: Callable[[Scene, Numerics], Answer]
    planned: Callable[[Scene, Given], Answer] | None
    variations: Callable[[Numerics, bool], Iterator[Settings]]
    exact: Callable[[Scene], Truth | None]
    lumped: Callable[[bool], tuple[Lumped, ...]]
    others: Mapping[str, Callable[[Scene], Truth]] = field(default_factory=dict)


def tried(scene: Scene) -> TriedBody:
    """What is tried of a scene; raises BadInput for one that has no trade-off."""
    if not scene.model.inertia:
        scene.check_single("tradeoff")
        check_target(scene)
        return STILL
    name = scene.target.name
    if name not in MOVING:
        raise BadInput(Fault(scene.source, "target.shape", unavailable(tuple(MOVING), name)))
    return MOVING[name](scene)


def grid(**choices: tuple[Any, ...]) -> Iterator[Settings]:
    """Every combination of the values of some settings."""
    for values in product(*choices.values()):
        yield dict(zip(choices, values, strict=True))


def lumped(scene: Scene, method: str, settings: Settings) -> Answer:
    """A law to a tolerance, or the row of springs of so many elements: one march, no bar, no history."""
    if method != ROW:
        return Answer.of(simulate(laws.get(method).of(scene), scene, settings["tolerance"]))
    scales = vars(mdr.estimate(scene, elements=settings["elements"]))
    return Answer(settings, {name: scales[name] for name in MEASURED}, None, settings)


# without inertia


def _certified(scene: Scene, numerics: Numerics) -> Answer:
    """The history with its error bars, from nothing but loaded modules."""
    half_space._surface.cache_clear()
    with without_disk():
        found = certify(Strike.of(scene), scene.geometry, numerics)
    curve = found.curve
    values = {name: curve.quantities[name] for name in MEASURED}
    bars = [found.total("history_l2"), found.total("restitution") if values["restitution"] is not None else 0.0]
    bars += [found.total(name) / abs(values[name] or np.inf) for name in ("peak_force", "duration")]
    work = asdict(found.work) | {"operations": operations(found.work, found.surface)}
    return Answer(numerics.as_dict(), values, max(bars), work, curve.dense_time, curve.dense_force)


def _by_law(name: str, scene: Scene) -> Truth:
    """The impact by an exact law."""
    return Truth.of(lumped(scene, name, {"tolerance": EXACT_TOLERANCE}), smooth=True)


def _still_lumped(quick: bool) -> tuple[Lumped, ...]:
    """The row of springs, exact laws at several tolerances with their bars, the models."""
    asked = [(name, one) for name in ("mdr", "ting") for one in (LAW_TOLERANCES[::2] if quick else LAW_TOLERANCES)]
    asked += [(name, LAW_TOLERANCES[-2]) for name in MODELS]
    rows = ((ROW, {"elements": count}) for count in ROW_ELEMENTS)
    return (*rows, *((name, {"tolerance": tolerance}) for name, tolerance in asked))


def still_variations(base: Numerics, quick: bool) -> Iterator[Settings]:
    """A few settings varied at a time."""
    return _few(base) if quick else _many(base)


def _few(base: Numerics) -> Iterator[Settings]:
    yield from grid(order=(2, 3), elements_per_contact=(base.elements_per_contact,))
    yield from grid(elements_per_contact=(1, 2, 8))
    yield from grid(steps=(16, 64, 128))
    yield from grid(enforcement=("penalty",), penalty=(1e2, base.penalty, 1e4))
    yield from grid(enforcement=("corrected",), penalty=(1e2, 1e4))


def _many(base: Numerics) -> Iterator[Settings]:
    yield from grid(order=(2, 3, 4), elements_per_contact=(1, 2, 4, 8))
    yield from grid(order=(3, 4), steps=(16, 24, 32, 48, 64, 96, 128))
    yield from grid(order=(4,), elements_per_contact=(1, 2, 8), steps=(16, 32, 96))
    yield from grid(order=(2,), elements_per_contact=(8,), steps=(16, 64, 128))
    yield from grid(enforcement=("penalty", "corrected"), penalty=(1e1, 1e2, 1e3, 1e4, 1e5))
    yield from grid(enforcement=("penalty", "corrected"), penalty=(1e4,), steps=(64, 128))
    yield from grid(elements_per_contact=(4, 8), far_radius=(10.0, 40.0), steps=(base.steps, 96))


STILL = TriedBody(
    _certified, None, still_variations, partial(_by_law, "mdr"), _still_lumped, {"mdr": partial(_by_law, "ting")}
)


# with inertia


def _moving(
    variations: Callable[[Numerics, bool], Iterator[Settings]],
    exact: Callable[[Scene], Truth | None],
    counted: Callable[[Mapping[str, float]], float],
    forget: Callable[[], None] = lambda: None,
) -> TriedBody:
    """``counted``: the leading terms of the arithmetic behind the work; ``forget()`` drops what impacts share."""

    def planned(scene: Scene, given: Given) -> Answer:
        forget()
        result = fe(scene, given)
        return Answer.of(result, operations=counted(result.work))

    def run(scene: Scene, numerics: Numerics) -> Answer:
        return planned(scene, {key: value for key, value in numerics.as_dict().items() if key in KEYS})

    asked = tuple((name, {"tolerance": LAW_TOLERANCES[-2]}) for name in WITHOUT_INERTIA)
    return TriedBody(run, planned, variations, exact, lambda quick: asked)


def _forget_meshes() -> None:
    """All matrices of unit bodies."""
    for made in (unit_body, unit_layer, unit_ball):
        made.cache_clear()


def meshed_variations(base: Numerics, quick: bool) -> Iterator[Settings]:
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


def _meshed_operations(work: Mapping[str, float]) -> float:
    """N unknowns in the plane: N^(3/2) a factorisation, N log2 N a step's back-substitution.

    George 1973, doi:10.1137/0710032.
    """
    unknowns = work["degrees_of_freedom"]
    return float(work["factorizations"] * unknowns**1.5 + work["solves"] * unknowns * np.log2(unknowns))


MESHED = _moving(meshed_variations, lambda scene: None, _meshed_operations, _forget_meshes)


def rod_exact(scene: Scene) -> Truth | None:
    """By the waves' own law; None of a rod whose waves disperse."""
    try:
        law = laws.get("rod_waves").of(scene)
    except BadInput:
        return None
    return Truth.of(Answer.of(law.simulate(scene, EXACT_TOLERANCE)))


def rod_variations(base: Numerics, quick: bool) -> Iterator[Settings]:
    """A striker that dents the rod presses by a law of its own: enforcement changes nothing then."""
    yield from grid(steps=tuple(base.steps * 2**power // 8 for power in range(2 if quick else 0, 6)))
    yield from grid(scheme=("generalised_alpha",), rho=(0.5,), mass=("consistent", "redistributed"))
    yield from grid(scheme=("staged", "fully_implicit"))
    if not quick:
        yield from grid(scheme=("hht", "trapezoidal"), mass=("redistributed", "spread"))
        yield from grid(enforcement=("penalty", "corrected"), penalty=(1.0, 1e2))


def _line_operations(work: Mapping[str, float]) -> float:
    """A line of elements: every step some operations an unknown."""
    return work["steps"] * work["degrees_of_freedom"]


ROD = _moving(rod_variations, rod_exact, _line_operations)


def block_exact(scene: Scene) -> Truth | None:
    """By characteristics; None of a viscoelastic bar, or one with a mass behind it."""
    bar = bar_of(scene)
    if not bar.relaxation.is_elastic or bar.end_mass > 0.0:
        return None
    speed = math.sqrt(bar.relaxation.glassy / bar.density)
    straight = StraightBar(bar.length, speed, bar.density * bar.area * speed)
    motion = bounces(straight, scene.velocity, scene.gravity, 0.0, scene.end_time)
    return _first_contact(motion, scene.motion.impacts)


def _first_contact(motion: Bounces, impacts: int) -> Truth:
    """The first contact's quantities; the force of so many."""
    bar, contacts = motion.bar, motion.contacts[:impacts]
    _, parted = contacts[0]
    starts = np.array([piece.start for piece in motion.pieces])
    knots = np.unique(np.concatenate([starts, starts + bar.echo, np.ravel(contacts)]))
    knots = knots[knots <= contacts[-1][1]]
    inside = knots[knots <= parted]
    values = {
        "peak_force": float(motion.force(np.append(inside, inside * BEFORE)).max()),
        "duration": parted,
        "restitution": motion.momentum(parted) / (bar.mass * motion.velocity),
    }
    return Truth(values, knots, lambda times: np.where(times <= contacts[-1][1], motion.force(times), 0.0))


def block_variations(base: Numerics, quick: bool) -> Iterator[Settings]:
    """Schemes with the masses on which they are stable or known to fail; penalties in units of modulus/element."""
    yield from grid(steps=tuple(base.steps * 2**power // 8 for power in range(1 if quick else 0, 5)))
    yield from grid(scheme=("staged", "generalised_alpha"), rho=(0.8,), mass=("redistributed",))
    yield from grid(scheme=("fully_implicit",))
    if not quick:
        yield from grid(scheme=("generalised_alpha", "trapezoidal"), rho=(0.8,), mass=("consistent", "spread"))
        yield from grid(scheme=("hht",), rho=(0.8,), mass=("redistributed", "spread"))
        yield from grid(enforcement=("penalty", "corrected", "augmented"), penalty=(1.0, 1e2))


BLOCK = _moving(block_variations, block_exact, _line_operations)
MOVING: dict[str, Callable[[Scene], TriedBody]] = {  # by target
    "half_space": lambda scene: MESHED,
    "layer": lambda scene: MESHED,
    "plane": lambda scene: BLOCK if isinstance(scene.geometry.shape, Block) else MESHED,
    "rod": lambda scene: ROD,
    "sphere": lambda scene: MESHED,
}
