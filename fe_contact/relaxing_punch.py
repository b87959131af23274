"""An impact with large strains by a punch, whose rim is sharp, on what relaxes: the limit of ever narrower edges.

Three impacts by edges are certified, each by itself. At equal shares of their contacts, and in all that is read of them,
they differ by the power of the edge's radius by which edges add to a force: see :mod:`fe_contact.solids.sharp_rim`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import ClassVar, NamedTuple

import numpy as np

from fe_contact.budget import plan as statics
from fe_contact.budget.budget import Budget, Causes, TotalWork, shares_of
from fe_contact.budget.curve import beyond
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import DOMINANT, Finer, dominant
from fe_contact.budget.solved import ImpactModel, record, solved
from fe_contact.budget.variation import Variation
from fe_contact.large_strains import check_impact
from fe_contact.progress import Progress, silent
from fe_contact.relaxing_impact import ROUNDS, SECONDS, Marcher, RelaxingStrikes
from fe_contact.relaxing_impact import plan as plan_rounded
from fe_contact.settings import EdgedNumerics, Given, Numerics, tolerance_of
from fe_contact.solids.newton import EquilibriumLost
from fe_contact.solids.pressing import exhausted
from fe_contact.solids.sharp_rim import FEWEST, ONWARDS, ORDERS, SHARE, edges_of, power_of, rounded_shapes, unsure_of
from lumped.result.history import History
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import LedgerEntry, Result, meets
from lumped.scene.scene import Scene

FALLING = ("peak_force", "peak_depth", "duration")  # quantities that show the power; all else falls in less


@dataclass(frozen=True)
class PunchBudget(Budget):
    """The budget of a contact that ends at the ``rim``, m, throughout."""

    rim: float

    def history(self) -> History:
        """Rows dense enough for linear interpolation, with the force's error band."""
        found = super().history()
        return replace(found, contact_radius=np.full_like(found.time, self.rim))


def limit(edges: Sequence[Budget], numerics: Numerics, rim: float) -> PunchBudget:
    """What three edges, the widest first, tell of none, midway between what both powers say, as far off as these are.

    Raises EquilibriumLost where they tell of no limit.
    """
    wide, _, narrow = edges
    changes: dict[str, Causes] = {
        cause: (*narrow.changes[cause], *_share(narrow.changes[cause]), *_share(wide.changes[cause]))
        for cause in narrow.causes
    }
    curve = beyond(narrow.curve, wide.curve, ONWARDS).with_peak_spread()
    changes["edge"] = (None,)  # where some contacts are over and others not
    if len({one.separated for one in edges}) == 1:
        farther = beyond(narrow.curve, wide.curve, ONWARDS + _unsure(edges))
        changes["edge"] = (Variation(curve, farther, 1.0),)
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
    power = power_of(np.sign(falls) * values, errors)
    clearest = int(np.argmax(np.abs(falls) / np.maximum(errors.sum(axis=0), np.finfo(float).tiny)))
    return float(unsure_of(power)[clearest])


@dataclass(frozen=True)
class PunchStrikes:
    """The way of a punch: three edges around it, each the way of an impact by itself."""

    scene: Scene
    chosen: Plan
    progress: Progress
    rounds: ClassVar[int] = ROUNDS

    @cached_property
    def edged(self) -> tuple[Scene, ...]:
        """With each of the edges, the widest first."""
        return edged(self.scene)

    @cached_property
    def radii(self) -> tuple[float, ...]:
        """Of the contacts that are expected under them, m."""
        return tuple(one.contact_radius for one in expected_contacts(self.scene))

    def certified(self, numerics: Numerics) -> PunchBudget:
        """The contact and its bars. Raises NotReached."""
        narrowest, found = self._narrowest(numerics), list[Budget]()
        for place in range(narrowest + 1 - FEWEST, narrowest + 1):
            radius = self.radii[place] / self.radii[narrowest] * numerics.contact_radius
            way = RelaxingStrikes(self.edged[place], self.chosen, self.progress)
            found.append(way.certified(numerics.varied(contact_radius=radius)))
        return limit(found, numerics, self.scene.geometry.shape.flat_radius)

    def _narrowest(self, numerics: Numerics) -> int:
        """Place of the narrowest edge that is struck with."""
        assert isinstance(numerics, EdgedNumerics)
        return edges_of(self.scene.geometry).index(numerics.edge_radius)

    def finer(self, found: PunchBudget) -> Finer:
        """Less of the causes that stand in the way, narrower edges among it."""
        if meets(found.quantities, found.numerics.tolerance):
            return Finer(None)
        excess = {cause: float(shares_of(found, cause).max()) for cause in found.causes}
        bound = DOMINANT * min(max(excess.values()), 1.0)
        settings, narrower = found.numerics, self._narrowest(found.numerics) + 1
        edges = edges_of(self.scene.geometry)
        if excess.pop("edge") >= bound and narrower < len(edges):
            settings = settings.varied(edge_radius=edges[narrower], contact_radius=self.radii[narrower])
        standing = {cause: share for cause, share in excess.items() if share >= bound}
        kept = self.chosen.pinned | exhausted(self._mesh_order(settings), settings)
        finer = dominant(standing, settings, kept, least=1.0) if standing else None
        return Finer(finer or (None if settings == found.numerics else settings))

    def _mesh_order(self, numerics: Numerics) -> float:
        return Marcher.of(self.edged[self._narrowest(numerics)], numerics).solid.mesh_order

    def ledger(self, found: PunchBudget) -> tuple[LedgerEntry, ...]:
        """What the model leaves out of the impact that was found."""
        return model_ledger(self.scene, Peak.of(found.quantities, found.history()))


def edged(scene: Scene) -> tuple[Scene, ...]:
    """The scene with each of the edges around its punch, the widest first."""
    return tuple(replace(scene, shape=shape) for shape in rounded_shapes(scene.geometry))


def plan(scene: Scene, given: Given) -> Plan:
    """Settings and ledger; scales are those of small strains. Raises NotReached."""
    return _plan(0, scene, given)


def _plan(wider: int, scene: Scene, given: Given) -> Plan:
    """The same with edges as many places ``wider`` than small strains say. Raises NotReached."""
    check_impact(scene, given)
    contacts = expected_contacts(scene)
    place = max(_narrow_enough([one.force for one in contacts], tolerance_of(given)) - wider, FEWEST - 1)
    rounded = plan_rounded(edged(scene)[place], given)
    sizes = {"contact_radius": contacts[place].contact_radius, "edge_radius": edges_of(scene.geometry)[place]}
    numerics = EdgedNumerics(**rounded.numerics.as_dict() | sizes)
    return Plan(numerics, rounded.pinned, statics.plan(scene, {}).ledger)


class Pressed(NamedTuple):
    """Force over modulus, m^2, and contact radius, m, under an edge."""

    force: float
    contact_radius: float


def expected_contacts(scene: Scene) -> list[Pressed]:
    """Under the edges, the widest first, at the depth that small strains have under none. Raises NotReached."""
    depth = statics.scales(scene, statics.plan(scene, {}).numerics).peak_depth
    target, nu = scene.geometry.target, scene.geometry.material.nu
    curves = [target.load_curve(shape, nu) for shape in rounded_shapes(scene.geometry)]
    return [Pressed(float(curve.force(depth)), float(curve.contact_radius(depth))) for curve in curves]


def _narrow_enough(force: Sequence[float], tolerance: float) -> int:
    """Place of the narrowest of three edges of which these forces, (n,), leave no more than a share of the tolerance;
    the last where none do.
    """
    unsure = float(unsure_of(np.array(ORDERS[0])))
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
    places = range(len(edges_of(scene.geometry)))
    for wider in places:
        try:
            return record(scene, solved(scene, given, progress, partial(_plan, wider), PunchStrikes))
        except EquilibriumLost as lost:
            pass
    raise lost


PUNCHED = ImpactModel(check_impact, plan, expected, fe)
