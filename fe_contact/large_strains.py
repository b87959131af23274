"""An elastic impact with large strains: by the body's load curve, which a few slow indentations tell.

Quasi-static and without memory, the body gives back all that it takes: the force over the depth is one curve, and the
motion one quadrature of it. ln F is smooth in ln d: a polynomial, and a straight line below the least depth.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Chebyshev

from fe_contact.assembly.forms import Array, check_compressible
from fe_contact.budget import plan as statics
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import AIM
from fe_contact.budget.solved import ImpactModel
from fe_contact.indentation import COARSEST, KEPT, indent, indenter_of, settings
from fe_contact.progress import Progress, silent
from fe_contact.settings import Given, check_kind, tolerance_of
from fe_contact.solids.newton import Equilibrium, material_of
from fe_contact.solids.pressing import CORRECTED, Solid, check_large
from fe_contact.solids.sharp_rim import rounded
from fe_contact.threads import one_thread
from lumped.errors import NotReached
from lumped.indentation import Indentation
from lumped.laws import ting
from lumped.load_curves.sampled import SampledCurve
from lumped.materials.energies.base import energy_of
from lumped.numbers import Clock
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import UNITS, Result, largest_bar, provenance, unmet
from lumped.scene.scene import Answered, Scene
from lumped.shapes._block import Block

DEPTHS = 10  # that tell the curve
SHALLOWEST = 0.0144  # the least of them over the largest; below it lies a share of 2e-5 of a sphere's work
DEGREE = 7  # of the polynomials through them
SPARE = 1.02  # largest depth over the one at which a coarse mesh has taken up the striker's energy
NEAR = 2e-3  # of that energy: what the coarse mesh has taken up
ROUNDS = 12  # work: of depths tried for it
BEGUN = 0.7  # first of them over the depth that small strains would have
SAMPLES = 160  # work: depths at which the polynomials are handed on
SECONDS = 3.0  # processor time of an impact to 1e-3, about: it ranks methods, no more
FINE_INTEGRATION = 1e-2  # of the tolerance


def check_impact(scene: Scene, given: Given) -> None:
    """Raise BadInput for an impact with large strains that is not built, and for settings that are not for it."""
    check_compressible(scene)
    check_kind(given, False, scene.source)
    enforcement = given.get("enforcement", CORRECTED)
    check_large(scene.source, scene.geometry, scene.model, enforcement, scene.motion.impacts)


def plan(scene: Scene, given: Given) -> Plan:
    """Settings and ledger as with small strains. Raises NotReached."""
    check_impact(scene, given)
    return statics.plan(scene, given)


def expected(scene: Scene, given: Given) -> tuple[float, float]:
    """Tolerance, and processor time, s, about. Raises BadInput."""
    check_impact(scene, given)
    return tolerance_of(given), SECONDS


@one_thread
def fe(scene: Scene, given: Given, progress: Progress = silent) -> Result:
    """Force history by finite elements with large strains, and error bars. Raises NotReached where contact is lost."""
    clock, tolerance = Clock(), tolerance_of(given)
    deepest, asked, best = SPARE * depth_reached(scene), tolerance, None
    for _ in range(ROUNDS):
        try:
            known = _known(scene, deepest, {**given, "tolerance": asked}, progress)
        except NotReached:
            if best is None:
                raise
            break
        found = known.impact(scene, tolerance)
        if (found.quantities["peak_depth"].value or 0.0) > deepest:
            deepest *= SPARE
            continue
        best = _result(scene, known, found, tolerance, clock)
        excess = largest_bar(best.quantities) / tolerance
        if excess <= 1.0 or known.relative > asked:  # the last: no setting is left that the depths could have finer
            break
        asked *= AIM / excess
    if best is None:
        raise NotReached(f"the striker goes deeper than {deepest:.3g} m", "a lower striker.velocity or .mass")
    return best


def depth_reached(scene: Scene) -> float:
    """Depth, m, at which the body on a coarse mesh has taken up what the striker brings. Raises EquilibriumLost.

    The energy grows as a power of the depth, force x depth / energy.
    """
    indenter, small = indenter_of(scene), statics.expected(scene)
    if isinstance(indenter.shape, Block) and indenter.shape.uniform:
        return small.peak_depth
    radius = small.contact_radius
    if scene.geometry.sharp_rim:
        indenter = rounded(indenter)
        radius = float(indenter.shape.load_curve.contact_radius(small.peak_depth))
    numerics = settings({"elements_per_contact": COARSEST}, indenter.shape, large=True)
    solid = Solid.of(indenter.elastic(False), np.array([radius]), numerics)
    joule = scene.contact_modulus.relaxed * indenter.shape.total * solid.unit ** (solid.dimension + 1) / solid.lead
    depth, reached = BEGUN * small.peak_depth, None
    for _ in range(ROUNDS):
        stiffness = numerics.penalty * solid.unit / radius
        with material_of(indenter):
            reached = solid.advanced(reached, depth, stiffness)
        balance = reached.balance
        brought = 0.5 * scene.reduced_mass * scene.velocity**2 + scene.reduced_mass * scene.gravity * depth
        more = brought / (joule * balance.taken)
        if abs(more - 1.0) < NEAR:
            break
        depth *= more ** (balance.taken / (balance.force * balance.depth))
    return depth


def at_peak(scene: Scene, result: Result) -> tuple[Solid, Equilibrium]:
    """The body of a result with its settings, at the peak depth. Raises NotReached."""
    indenter, depth = indenter_of(scene).elastic(False), result.quantities["peak_depth"].value or 0.0
    radius, given = float(result.history.contact_radius.max()), {key: result.numerics[key] for key in KEPT}
    numerics = settings(given, indenter.shape, large=True)
    solid = Solid.of(indenter, np.array([radius]), numerics)
    with material_of(scene):
        return solid, solid.advanced(None, depth, numerics.penalty * solid.unit / radius)


def check_range(scene: Scene) -> None:
    """Raise EquilibriumLost where an elastic material that softens does not take up what the striker brings.

    Where lambda is negative, with nu, most energies soften.
    """
    material = scene.geometry.material
    softens = energy_of(material.hyperelastic).softens or material.nu < 0.0
    if scene.model.finite and material.young.is_elastic and softens:
        depth_reached(scene)


@dataclass(frozen=True, eq=False)
class KnownCurve:
    """Slow ``pressed`` depths; polynomials through ln F and ln a, from 0 at the least to 1 at the ``deepest``, m."""

    pressed: Indentation
    deepest: float
    force: Chebyshev
    radius: Chebyshev

    @property
    def errors(self) -> Mapping[str, float]:
        """Relative errors of the force by cause: those of the depths, and of what lies between them."""
        lower = _fitted(self.pressed, self.deepest, DEGREE - 1)[0]
        place = np.linspace(0.0, 1.0, 2 * SAMPLES)
        between = float(np.abs(self.force(place) - lower(place)).max())
        return {cause: float(error.max()) for cause, error in self.pressed.budget.items()} | {"curve": between}

    def shallow(self, depth: Array) -> Array:
        """Relative error of the force at depths (n,), m, below the least, where a straight line stands for the curve.

        Half of the curve's bend there times the square of the way, in logarithms; the bend fades on the way to touch.
        """
        way = np.log(np.maximum(self.deepest * SHALLOWEST / np.maximum(depth, np.finfo(float).tiny), 1.0))
        lower = _fitted(self.pressed, self.deepest, DEGREE - 1)[0]
        bend = max(abs(float(curve.deriv(2)(0.0))) for curve in (self.force, lower)) / math.log(SHALLOWEST) ** 2
        return np.minimum(0.5 * bend * way**2, 1.0)

    @property
    def relative(self) -> float:
        """The largest relative bar of the depths."""
        return float((self.pressed.force_error / self.pressed.force).max())

    def impact(self, scene: Scene, tolerance: float, uniform: float = 0.0, tilted: float = 0.0) -> Result:
        """On the curve, or one that errs by these relative changes, of all alike and of shallow against deep."""
        place = np.linspace(0.0, 1.0, SAMPLES)
        depth = self.deepest * SHALLOWEST ** (1.0 - place)
        changed = 1.0 + uniform - tilted * np.cos(np.pi * place)
        unit = scene.contact_modulus.relaxed * scene.geometry.shape.total
        force = np.exp(self.force(place)) * changed / unit
        radius = np.exp(self.radius(place))
        curve = SampledCurve(tuple(depth.tolist()), tuple(force.tolist()), tuple(radius.tolist()))
        answered = Answered.by(scene, curve)
        return ting.MEMBER.of(answered).simulate(answered, FINE_INTEGRATION * tolerance)


def _known(scene: Scene, deepest: float, given: Given, progress: Progress) -> KnownCurve:
    """The curve up to a depth, m. Raises NotReached."""
    place = 0.5 - 0.5 * np.cos(np.pi * np.arange(DEPTHS) / (DEPTHS - 1))
    depths = deepest * SHALLOWEST ** (1.0 - place)
    pressed = indent(indenter_of(scene), tuple(depths.tolist()), given, progress=progress)
    return KnownCurve(pressed, deepest, *_fitted(pressed, deepest, DEGREE))


def _fitted(pressed: Indentation, deepest: float, degree: int) -> tuple[Chebyshev, Chebyshev]:
    """Polynomials in the logarithm of the depth."""
    place = 1.0 - np.log(pressed.depth / deepest) / math.log(SHALLOWEST)
    force, radius = (Chebyshev.fit(place, np.log(of), degree) for of in (pressed.force, pressed.contact_radius))
    return force, radius


def _result(scene: Scene, known: KnownCurve, found: Result, tolerance: float, clock: Clock) -> Result:
    """The record: every cause's bar is what as large an error of the curve changes, of all depths or of some."""
    budget = {"integration": {name: quantity.error or 0.0 for name, quantity in found.quantities.items()}}
    others = list[Result]()
    for cause, error in known.errors.items():
        both = [known.impact(scene, tolerance, error, 0.0), known.impact(scene, tolerance, 0.0, error)]
        budget[cause] = {name: sum(_distance(found, other, name) for other in both) for name in UNITS}
        others += both
    quantities = {
        name: replace(quantity, error=None if quantity.value is None else sum(row[name] for row in budget.values()))
        for name, quantity in found.quantities.items()
    }
    peak = quantities["peak_force"].value or math.inf
    relative = sum(known.errors.values()) + known.shallow(found.history.depth)
    band = _band(found, others, relative, quantities["duration"].error or 0.0)
    history = replace(found.history, force_error=band)
    missed = unmet(quantities, tolerance)
    return replace(
        found,
        method="fe",
        scene=scene,
        model=scene.model,
        converged=not missed and found.separated,
        tolerance=tolerance,
        history=history,
        quantities=quantities,
        numerics=known.pressed.numerics,
        error_budget={cause: row["peak_force"] / peak for cause, row in budget.items()},
        error_budget_by_quantity=budget,
        model_ledger=model_ledger(scene, Peak.of(quantities, history)),
        provenance=provenance(),
        timing=clock.read(),
        work=dict(known.pressed.work),
        message=missed,
    )


def _distance(first: Result, second: Result, name: str) -> float:
    """Of a quantity of two impacts, in its unit; of their histories, over the norm of the first."""
    if name != "history_l2":
        values = [one.quantities[name].value for one in (first, second)]
        return 0.0 if None in values else abs((values[0] or 0.0) - (values[1] or 0.0))
    time, apart = first.history.time, _apart(first, second)
    return float(math.sqrt(np.trapezoid(apart**2, time) / np.trapezoid(first.history.force**2, time)))


def _band(found: Result, others: Sequence[Result], relative: Array, later: float) -> Array:
    """Half-width of the force's bar at the rows, N: as far as the others are apart, and what the curve errs at a depth,
    ``relative`` (n,).

    A softer curve ends so much ``later``, s, as a stiffer one, whose force is zero by then, ends sooner.
    """
    time, force = found.history.time, found.history.force
    band = sum((_apart(found, other) for other in others), found.history.force_error + relative * force)
    return np.maximum(band, np.interp(time - later, time, band))


def _apart(first: Result, second: Result) -> Array:
    """How far the forces of two impacts are apart at the rows of the first, N: late in a rebound by their durations."""
    return np.abs(first.history.force - second.history.force_at(first.history.time))


ELASTIC = ImpactModel(check_impact, plan, expected, fe)
