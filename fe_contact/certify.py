"""The error budget: the impact again with one setting varied at a time, by finite elements alone.

Time steps in the ratio 1 : 2 : 4 give a value (extrapolated from the two finest) and its change from the
pair before. Mesh and penalty are varied on the coarsest of them, where a march is cheapest: what they change does
not depend on the step. The far field of a mesh that breathes with the contact takes no march. A change
between settings in the ratio 1 : 2 bounds the error by

    SAFETY / (2^order - 1) x change ,

with the lowest order that theory or the scheme promises, not the higher one that is usually seen (Roache's
grid convergence index, doi:10.1115/1.2910291). Extrapolation leaves the order after the scheme's own, if the
three step lengths show that order; where they do not, order one is all that is trusted. What steps do not
cure, the jitter that rounding and mesh leave in the force of a viscous contact, shows when every other step
is left out of one march.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_contact.bodies.chosen import struck
from fe_contact.bodies.flat_end import FlatEnd
from fe_contact.bodies.struck import Deformable, Struck
from fe_contact.change import Change
from fe_contact.curve import Curve, extrapolated
from fe_contact.forms import Array
from fe_contact.impact import march
from fe_contact.march import March, Strike
from fe_contact.numerics import SCHEMES, Numerics
from fe_contact.plan import SETTING
from fe_contact.softening import Softening, compliance_change
from fe_contact.trusted_order import trusted_orders
from lumped.errors import NotReached
from lumped.geometry import Geometry
from lumped.members import get

SAFETY = 1.25
LEAST_ORDER = {"penalty": 1, "far_field": 2}
MESH_ORDER = {1: 0.5, 2: 1, 3: 1, 4: 2}  # by element order: the edge allows three in the force, locking takes from it
MESH_ORDER_ANYWHERE = 1  # where the edge falls anywhere in an element: 1.6 is what is seen
LEAST_HALVED = 40  # steps below which halving them twice would leave too few to tell anything
LEAST_HALVED_SETTING = {"elements_per_contact": 2.0, "penalty": 20.0, "far_radius": 5.0}
CAUSES = ("mesh", "penalty", "time_step", "far_field")
ROUNDING = 1e-9  # of a solve of nearly incompressible bodies


@dataclass(frozen=True)
class TotalWork:
    """Counted work of a certified impact: unknowns of the finest mesh; factorisations and back-substitutions
    of all meshes; marches, time steps, contact problems and Newton iterations of all runs.
    """

    degrees_of_freedom: int
    factorizations: int
    solves: int
    marches: int
    steps: int
    contact_problems: int
    iterations: int


@dataclass(frozen=True)
class Budget:
    """A curve with what each setting contributes to its error.

    ``march`` is the finest run behind it, ``work`` that of all runs together.
    """

    curve: Curve
    march: March
    changes: Mapping[str, tuple[Change | Softening | None, ...]]
    work: TotalWork

    def error(self, name: str, cause: str) -> float:
        """Error of a quantity by one cause, in its unit; infinite where a variation failed."""
        reading = self.curve.end_spread if (name, cause) == ("duration", "time_step") else 0.0
        return reading + sum(_error(change, name) for change in self.changes[cause])

    def total(self, name: str) -> float:
        """Error bar of a quantity, in its unit."""
        return sum(self.error(name, cause) for cause in CAUSES)

    def force_error(self, time: Array) -> Array:
        """Half-width of the force's error band, N."""
        known = [c.force(time) for changes in self.changes.values() for c in changes if c is not None]
        return np.sum(known, axis=0) if known else np.zeros_like(time)


@dataclass(frozen=True)
class Certified(Budget):
    """The same with the ``surface`` that the finest run was on."""

    surface: Struck


def certify(strike: Strike, geometry: Geometry, numerics: Numerics) -> Certified:
    """March with ``numerics`` and with each setting varied; raises where the march itself fails."""
    runs = _Runs(strike, geometry)
    finest = runs.march(numerics)
    steps = _time_steps(runs, Curve.of(finest, strike), numerics)
    cheap = numerics.varied(steps=steps.cheap)
    surface = runs.surface(numerics)
    if isinstance(surface, FlatEnd):
        held = _by_stiffness(runs, steps.value, surface, numerics)
        changes = held | {"time_step": (steps.change, *steps.jitter)}
        return Certified(steps.value, finest, changes, runs.work(surface), surface)
    base = runs.curve(cheap)
    mesh, finer_mesh = _other(cheap, "elements_per_contact")
    penalty, stiffer = _other(cheap, "penalty")
    order = MESH_ORDER[numerics.order] if surface.breathes else MESH_ORDER_ANYWHERE
    changes = {
        "mesh": (_change(base, runs.curve(mesh), order, finer_mesh), *steps.jitter),
        "penalty": (_change(base, runs.curve(penalty), LEAST_ORDER["penalty"], stiffer),),
        "time_step": (steps.change,),
        "far_field": (_far_field(runs, steps.value, cheap, mesh),),
    }
    return Certified(steps.value, finest, changes, runs.work(surface), surface)


def _by_stiffness(
    runs: _Runs, value: Curve, end: FlatEnd, numerics: Numerics
) -> dict[str, tuple[Change | Softening | None, ...]]:
    """What the other causes change of the one stiffness under a flat end, without a march."""
    orders = {"mesh": min(MESH_ORDER[numerics.order], end.mesh_order)} | LEAST_ORDER
    found: dict[str, tuple[Change | Softening | None, ...]] = {}
    for cause, order in orders.items():
        settings, finer = _other(numerics, SETTING[cause])
        other = runs.surface(settings)
        assert isinstance(other, FlatEnd)
        share = _factor(order, finer) * abs(other.stiffness / end.stiffness - 1.0)
        found[cause] = (Softening(value, share + ROUNDING),)
    return found


def _far_field(runs: _Runs, value: Curve, cheap: Numerics, mesh: Numerics) -> Change | Softening | None:
    """By one press of either surface where they breathe with the contact; else by a march more, on the varied mesh.

    Bodies that end have none.
    """
    order = LEAST_ORDER["far_field"]
    far, farther = _other(cheap, "far_radius")
    surface, other = runs.surface(cheap), runs.surface(far)
    if other is surface:
        return Softening(value, 0.0)
    if surface.breathes:
        assert isinstance(surface, Deformable)
        assert isinstance(other, Deformable)
        return Softening(value, _factor(order, farther) * compliance_change(surface, other))
    return _change(runs.curve(mesh), runs.curve(mesh.varied(far_radius=far.far_radius)), order, farther)


@dataclass(frozen=True)
class _TimeSteps:
    """What the variation of the step length yields: value, its change, jitter, and steps for other variations."""

    value: Curve
    change: Change | None
    jitter: tuple[Change, ...]
    cheap: int


def _time_steps(runs: _Runs, fine: Curve, numerics: Numerics) -> _TimeSteps:
    """Halve the number of steps twice and extrapolate; double it twice where it is too small for that."""
    order = get(SCHEMES, numerics.scheme).ORDER
    if numerics.steps < LEAST_HALVED:
        double = runs.curve(numerics.varied(steps=2 * numerics.steps))
        fourfold = runs.curve(numerics.varied(steps=4 * numerics.steps))
        if double is None or fourfold is None or fourfold.separated != double.separated:
            return _TimeSteps(fine, None, (), 4 * numerics.steps)
        best = extrapolated(fourfold, double, order)
        return _TimeSteps(fine, Change(fine, best, SAFETY), (), 4 * numerics.steps)
    half = runs.curve(numerics.varied(steps=numerics.steps // 2))
    quarter = runs.curve(numerics.varied(steps=numerics.steps // 4))
    if half is None or quarter is None or not fine.separated == half.separated == quarter.separated:
        return _TimeSteps(fine, None, (), numerics.steps)
    value, before = extrapolated(fine, half, order), extrapolated(half, quarter, order)
    orders = trusted_orders((fine, half, quarter), order, runs.step_in_relaxations(numerics))
    least = SAFETY / (2 ** orders.pop("force") - 1)
    weights = {name: SAFETY / (2**trusted - 1) / least for name, trusted in orders.items()}
    change = Change(value, before, least, weights)
    jitter = Change(fine, fine.thinned(), 1.0)
    return _TimeSteps(value, change, (jitter,), numerics.steps // 4)


class _Runs:
    """Marches of one strike with different settings, and a count of what they cost."""

    def __init__(self, strike: Strike, geometry: Geometry) -> None:
        self._strike, self._geometry = strike, geometry
        self._marches: list[March] = []
        self._radii: dict[int, Array] = {}
        self._surfaces: dict[int, Struck] = {}
        self._curves: dict[Numerics, Curve | None] = {}

    def march(self, settings: Numerics) -> March:
        """One run, its contact radii expected to be those of the first with as many steps; raises where it fails."""
        surface = self.surface(settings)
        expected = self._radii.get(settings.steps, ())
        self._marches.append(march(self._strike, surface, settings, not self._marches, expected))
        self._radii.setdefault(settings.steps, self._marches[-1].radius)
        return self._marches[-1]

    def step_in_relaxations(self, settings: Numerics) -> Array:
        """Length of a step over every relaxation time."""
        return settings.contact_time / settings.steps / np.asarray(self._strike.relaxation.times)

    def surface(self, settings: Numerics) -> Struck:
        """What contact sees of the struck body."""
        surface = struck(self._geometry, settings)
        self._surfaces[id(surface)] = surface
        return surface

    def curve(self, settings: Numerics) -> Curve | None:
        """One run as a curve, None where it fails: its cause of error is then unknown.

        Settings asked for again are not run again: the fewest steps serve every other variation as base.
        """
        if settings not in self._curves:
            try:
                self._curves[settings] = Curve.of(self.march(settings), self._strike)
            except NotReached:
                self._curves[settings] = None
        return self._curves[settings]

    def work(self, finest: Struck) -> TotalWork:
        """What all runs cost together."""
        works = [m.work for m in self._marches]
        return TotalWork(
            degrees_of_freedom=finest.degrees_of_freedom,
            factorizations=sum(s.factorizations for s in self._surfaces.values()),
            solves=sum(s.solves for s in self._surfaces.values()),
            marches=len(works),
            steps=sum(w.steps for w in works),
            contact_problems=sum(w.contact_problems for w in works),
            iterations=sum(w.iterations for w in works),
        )


def _error(change: Change | Softening | None, name: str) -> float:
    """Error of a quantity by one change; infinite where the variation failed."""
    return np.inf if change is None else change.errors[name]


def _change(first: Curve | None, second: Curve | None, order: float, finer: bool = False) -> Change | None:
    """Change between settings in the ratio 1 : 2; ``finer`` if it is the second that is the better one."""
    return None if first is None or second is None else Change(first, second, _factor(order, finer))


def _factor(order: float, finer: bool) -> float:
    """Error over change, by the module's formula; of the first setting, ``finer`` if the second is the better one."""
    return SAFETY * (2**order if finer else 1) / (2**order - 1)


def _other(numerics: Numerics, key: str) -> tuple[Numerics, bool]:
    """One setting halved; doubled, and True, where it is too coarse for half of it to tell anything."""
    value = getattr(numerics, key)
    finer = value < LEAST_HALVED_SETTING[key]
    return numerics.varied(**{key: value * 2 if finer else value / 2}), finer
