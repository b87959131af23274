"""An impact with large strains by a punch, whose rim is sharp, on what relaxes: the limit of ever narrower edges.

Three impacts by edges are certified, each by itself. At equal shares of their contacts they differ by the power of the
edge's radius by which edges add to a force: see :mod:`fe_contact.solids.sharp_rim`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from fe_contact.budget import plan as statics
from fe_contact.budget.budget import Budget, Causes, TotalWork, shares_of
from fe_contact.budget.curve import beyond
from fe_contact.budget.plan import FLAT_STEPS, Plan
from fe_contact.budget.refine import DOMINANT, Finer, dominant
from fe_contact.budget.solved import ImpactModel, record, solved
from fe_contact.budget.variation import Variation
from fe_contact.large_strains import check_impact
from fe_contact.progress import Progress, silent
from fe_contact.relaxing_impact import (
    SECONDS,
    ExpectedContact,
    RelaxingStrikes,
    expected_contacts,
    settings,
)
from fe_contact.settings import EdgedNumerics, Given, Numerics, tolerance_of
from fe_contact.solids.newton import EquilibriumLost
from fe_contact.solids.sharp_rim import (
    FEWEST,
    ONWARDS,
    ONWARDS_ONCE,
    ORDERS,
    SHARE,
    edges_of,
    power_of,
    rounded_shapes,
    unsure_of,
)
from lumped.result.history import History
from lumped.result.result import Result, meets
from lumped.scene.scene import Scene

# What a term of twice the power leaves of the way from the widest edge, over what that differs from the way from the
# middle one: 1 + (1 - 16)/3 = -4 over it less 1 + (1 - 4) = -2, where an edge adds half as much as the one before.
SECOND_ORDER = 2.0
FALLING = ("peak_force", "peak_depth", "duration")  # quantities that show the power; all else falls in less


@dataclass(frozen=True)
class PunchBudget(Budget):
    """The budget of a contact that ends at the ``rim``, m, throughout."""

    rim: float

    def energy_error(self, name: str) -> float:
        """Error bar of a term of the energy account, J; infinite where a variation failed.

        What does not leave with the striker stays or is lost: either by chance hardly differs from edge to edge.
        """
        told = super().energy_error(name)
        return max(told, super().energy_error("out")) if name in ("stored", "viscous") else told

    def history(self) -> History:
        """Rows dense enough for linear interpolation, with the force's error band."""
        found = super().history()
        return replace(found, contact_radius=np.full_like(found.time, self.rim))


def limit(edges: Sequence[Budget], numerics: Numerics, rim: float) -> PunchBudget:
    """What three edges, the widest first, tell of none, midway between what both powers say, as far off as these are.

    And farther off by what the way from the middle edge, half as far, leads elsewhere. Raises EquilibriumLost where
    edges tell of no limit.
    """
    wide, middle, narrow = edges
    changes: dict[str, Causes] = {
        cause: (*narrow.changes[cause], *_share(narrow.changes[cause]), *_share(wide.changes[cause]))
        for cause in narrow.causes
    }
    curve = beyond(narrow.curve, wide.curve, ONWARDS).with_peak_spread()
    changes["edge"] = (None,)  # where some contacts are over and others not
    if len({one.separated for one in edges}) == 1:
        farther = beyond(narrow.curve, wide.curve, ONWARDS + _unsure(edges))
        shorter = beyond(narrow.curve, middle.curve, ONWARDS_ONCE)
        changes["edge"] = (Variation(curve, farther, 1.0), Variation(curve, shorter, SECOND_ORDER))
    counted = [one.counted for one in edges]
    work = {key: sum(one[key] for one in counted) for key in counted[0]}
    total = TotalWork(**work | {"degrees_of_freedom": max(one["degrees_of_freedom"] for one in counted)})
    return PunchBudget(curve, narrow.march, changes, total, numerics, rim)


def _share(changes: Causes) -> Causes:
    """What errors of an edge change of the way onwards."""
    known = [one for one in changes if isinstance(one, Variation)]
    return tuple(replace(one, factor=ONWARDS * one.factor) for one in known)


def _unsure(edges: Sequence[Budget]) -> float:
    """How far off the way onwards may be, by the power of the quantity that shows it most clearly."""
    told = [[one.quantities[name] for name in FALLING] for one in edges]
    values = np.array([[one.value or 0.0 for one in row] for row in told])  # what has no end has no duration
    errors = np.array([[one.error or 0.0 for one in row] for row in told])
    falls = values[0] - values[-1]
    power = power_of(list(np.sign(falls) * values), list(errors))
    rounding = np.finfo(float).eps * np.abs(values).max(axis=0) + np.finfo(float).tiny
    clearest = int(np.argmax(np.abs(falls) / (errors.sum(axis=0) + rounding)))
    return float(unsure_of(power)[clearest])


@dataclass(frozen=True)
class PunchStrikes(RelaxingStrikes):
    """The way of a punch: three edges around it, each the way of an impact by itself."""

    @cached_property
    def radii(self) -> tuple[float, ...]:
        """Of the contacts that are expected under them, m."""
        return tuple(one.contact_radius for one in _expected(self.scene))

    def certified(self, numerics: Numerics) -> PunchBudget:
        """The contact and its bars. Raises NotReached."""
        assert isinstance(numerics, EdgedNumerics)
        scenes, narrowest, found = edged(self.scene), self._narrowest(numerics), list[Budget]()
        for place in range(narrowest + 1 - FEWEST, narrowest + 1):
            strikes = RelaxingStrikes(scenes[place], self.chosen, self.progress)
            found.append(strikes.certified(self._under(place, numerics)))
        return limit(found, numerics, self.scene.geometry.shape.flat_radius)

    def _under(self, place: int, numerics: EdgedNumerics) -> EdgedNumerics:
        """The same settings under the edge of another place."""
        wider = self.radii[place] / self.radii[self._narrowest(numerics)]
        edge = edges_of(self.scene.geometry)[place]
        return numerics.varied(edge_radius=edge, contact_radius=wider * numerics.contact_radius)

    def _narrowest(self, numerics: EdgedNumerics) -> int:
        """Place of the narrowest edge that is struck with."""
        return edges_of(self.scene.geometry).index(numerics.edge_radius)

    def finer(self, found: Budget) -> Finer:
        """Less of the causes that stand in the way, narrower edges among it."""
        if meets(found.quantities, found.numerics.tolerance):
            return Finer(None)
        excess = {cause: float(shares_of(found, cause).max()) for cause in found.causes}
        bound = DOMINANT * min(max(excess.values()), 1.0)
        numerics = found.numerics
        assert isinstance(numerics, EdgedNumerics)
        narrower = self._narrowest(numerics) + 1
        if excess.pop("edge") >= bound and narrower < len(self.radii):
            numerics = self._under(narrower, numerics)
        standing = {cause: share for cause, share in excess.items() if share >= bound}
        finer = dominant(standing, numerics, self.chosen.pinned, least=1.0) if standing else None
        return Finer(finer or (None if numerics == found.numerics else numerics))


def edged(scene: Scene) -> tuple[Scene, ...]:
    """The scene with each of the edges around its punch, the widest first."""
    return tuple(replace(scene, shape=shape) for shape in rounded_shapes(scene.geometry))


def plan(scene: Scene, given: Given) -> Plan:
    """Settings and ledger; scales are those of small strains. Raises NotReached."""
    check_impact(scene, given)
    return _plan(_narrow_enough(scene, tolerance_of(given)), scene, given)


def _plan(place: int, scene: Scene, given: Given) -> Plan:
    """With the narrowest edge of a place. Raises NotReached."""
    known, radius = statics.plan(scene, {}), _expected(scene)[place].contact_radius
    edge = {"contact_radius": radius, "edge_radius": edges_of(scene.geometry)[place]}
    steps = {"steps": known.numerics.steps // FLAT_STEPS}  # which no edge asks for
    numerics = EdgedNumerics(**known.numerics.as_dict() | steps | settings(given) | edge)
    return Plan(numerics, frozenset(given) - {"tolerance"}, known.ledger)


def _expected(scene: Scene) -> list[ExpectedContact]:
    """Contacts under the edges, the widest first. Raises NotReached."""
    return expected_contacts(scene, rounded_shapes(scene.geometry))


def _narrow_enough(scene: Scene, tolerance: float) -> int:
    """Place of the narrowest of three edges that at small strains leave no more than a share of the tolerance; the last
    where none do. Raises NotReached.
    """
    unsure, force = float(unsure_of(np.array(ORDERS[0]))), [one.force for one in _expected(scene)]
    for place in range(FEWEST - 1, len(force)):
        if unsure * (force[place + 1 - FEWEST] / force[place] - 1.0) <= SHARE * tolerance:
            return place
    return len(force) - 1


def expected(scene: Scene, given: Given) -> tuple[float, float]:
    """Tolerance, and processor time, s, about. Raises BadInput."""
    check_impact(scene, given)
    return tolerance_of(given), FEWEST * SECONDS


def fe(scene: Scene, given: Given, progress: Progress = silent) -> Result:
    """Force history and error bars. Raises NotReached where an equilibrium is lost under the widest edges too."""
    place = _narrow_enough(scene, tolerance_of(given))
    while True:
        try:
            found = solved(scene, given, progress, partial(_plan, place), PunchStrikes)
        except EquilibriumLost:
            if place < FEWEST:
                raise
            place -= 1
        else:
            return record(scene, found)


PUNCHED = ImpactModel(check_impact, plan, expected, fe)
