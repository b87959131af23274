"""The error budget of an impact with inertia: the impact again with one setting varied at a time, by FE alone.

Mesh, penalty and time step are trusted with order one only: contact that begins and ends point by point leaves a
chatter which no order describes. The change between settings in the ratio 1 : 2 then bounds the error of the better one
by 1.25 times itself. The far field errs as the square of its distance, as without inertia: half as far, an echo comes
back within the contact.

A contact ends anywhere within a step, and a body that rings ends it sooner or later than its last forces say. Every
length of step leaves another share of itself of that, in which no order shows: the finer of two durations then errs by
less than twice their distance. Where a ball rings both may miss the same share of a step, about half of the finer one.

What a ball's far pole sends back meets at the contact all at once, in a pulse of the force so short that two settings
may miss it alike: of its band, that two of them agree there says less. Of a pulse near the end they may agree on the
end by chance alone, not on all of the fall to it.

A march with waves as a curve: through fewer rows than steps, between which the contact's chatter averages out.

Points of a mesh that stays begin and end their contact one by one, and a dashpot in parallel differentiates that. The
impulse hardly knows of it: a local cubic through the mean force since touch, as Savitzky and Golay smooth
(doi:10.1021/ac60214a047), keeps what is smooth and knows of chatter even less. It would keep as little of the echoes of
a thin layer, each of which is a pulse of the force: where they show, rows lie so close that they tell them.

A march is dear, so that no more is refined than the measured budget says is missing.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from operator import attrgetter
from typing import ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import LOST, Causes, TotalWork, shares_of
from fe_contact.budget.certify import other_mesh, other_setting
from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer, Growth, missing
from fe_contact.budget.runs import AnyRuns
from fe_contact.budget.several import Judged, Several
from fe_contact.budget.variation import SAFETY, UNORDERED, Softening, Variation, factor
from fe_contact.march.impacts import Followed, follow
from fe_contact.progress import Count, Counted, Progress, uncounted
from fe_contact.settings import Numerics, WaveNumerics
from fe_contact.steppers.steps import March, Strike
from fe_contact.waves.impact import WaveBouncer
from fe_contact.waves.moving import Moving, UnitBody
from fe_contact.waves.plan import Cost
from lumped.result.result import LedgerEntry, meets
from lumped.scene.scene import Scene

ORDER = {"mesh": 1, "penalty": 1, "time_step": 1, "far_field": 2}  # of convergence, by cause
# along the contact radius: half of fewer may err alike by chance, and are hardly larger in the bulk
LEAST_NODES = 24.0
ROWS, AT = 60, 3e-3  # along a contact, and the tolerance for which they suffice: polynomials through six of them
ROWS_ORDER = 5  # of the force between them
ROWS_ECHO = 24  # along an echo, for any tolerance: half of them, which judge them, have to show it too
TRUSTED = 2  # of that
# Times the error that order one or two tells: the front of an echo begins as the root of time, which leaves order 1/2.
FRONTS = (2.0 ** ORDER["time_step"] - 1.0) / (math.sqrt(2.0) - 1.0)
DEGREE, REACH = 3, 2  # of the polynomial through all steps so many rows to either side
MISSED = 0.5 * SAFETY  # of a step, by which a ball that rings leaves sooner or later than both lengths of step say
FALLING = (0.02, 0.03, 0.05, 0.07, 0.1)  # of the largest force: below, points that part one by one tell how it falls
HELD_BY_WAVES = ("stored", "radiated")  # terms of the energy account
ROUNDS = 3  # refinements before giving up
GROWTH = {
    "mesh": Growth(ORDER["mesh"], step=2**0.25, most=2.0, work=2.0),
    "penalty": Growth(ORDER["penalty"], step=2.0, most=8.0, work=0.1),
    "time_step": Growth(ORDER["time_step"], step=2.0, most=4.0, work=1.0),  # half of twice as many has been run
    "far_field": Growth(ORDER["far_field"], step=2.0, most=4.0, work=0.3),
}

FLOWING = 5.0  # times the work of a step in which something flows: ten solutions, most of it beside the factors

Body = Callable[[Scene, WaveNumerics], Moving]
Units = Callable[[Scene, WaveNumerics], Sequence[UnitBody]]
Costs = Callable[[Scene, WaveNumerics], Cost]
tells_of_mesh = partial(other_mesh, most=ORDER["mesh"], nodes=LEAST_NODES)


class WaveRun(NamedTuple):
    """The contacts of one run on a body of so many unknowns, steps ``flown`` between them, and ``factorizations``."""

    followed: Followed
    size: int
    flown: int
    factorizations: int

    @property
    def steps(self) -> int:
        """Of contacts and flights."""
        return self.flown + sum(one.march.work.steps for one in self.followed.contacts)


class WaveRuns(AnyRuns[WaveNumerics]):
    """Marches of one scene with different settings, each run once, and a count of what they cost.

    ``cheap``: steps of those in which another setting is varied, whose effect does not depend on the step.
    """

    def __init__(
        self, scene: Scene, strike: Strike, moving: Callable[[Scene, WaveNumerics], Moving], cheap: int
    ) -> None:
        super().__init__()
        self._scene, self._strike, self._moving, self.cheap = scene, strike, moving, cheap
        self._runs: dict[WaveNumerics, WaveRun] = {}
        self.counted: Counted = uncounted  # told of every step, as the share of one on the largest body so far
        self._largest = 1

    @property
    def rings(self) -> bool:
        """Whether waves of a ball come back to the contact from its far pole."""
        return self._scene.geometry.striking is not None

    def _count(self, unknowns: int, steps: float) -> None:
        self._largest = max(self._largest, unknowns)
        self.counted(steps * unknowns / self._largest)

    def follow(self, settings: WaveNumerics) -> Followed:
        """One run; raises where it fails."""
        if settings not in self._runs:
            body = self._moving(self._scene, settings)
            bouncer = WaveBouncer(body, self._scene, settings, partial(self._count, body.body.size))
            followed = follow(bouncer, self._strike, self._scene.motion.impacts)
            self._runs[settings] = WaveRun(followed, body.body.size, bouncer.flights.steps, bouncer.steppers.made)
            self._curves[settings] = tuple(curve_of(one.march, one.strike, settings) for one in followed.contacts)
        return self._runs[settings].followed

    @property
    def spent(self) -> float:
        """Unknowns times steps of all runs so far."""
        return float(sum(run.size * run.steps for run in self._runs.values()))

    def work(self) -> TotalWork:
        """What all runs cost together: a factorisation for every length of step, a back-substitution for every contact
        problem and every step of a flight.
        """
        runs = list(self._runs.values())
        marches = [one.march.work for run in runs for one in run.followed.contacts]
        return TotalWork.of(
            marches,
            degrees_of_freedom=max(run.size for run in runs),
            factorizations=sum(run.factorizations for run in runs),
            solves=sum(run.flown for run in runs) + sum(march.contact_problems for march in marches),
            flown=sum(run.flown for run in runs),
        )


def certify(runs: WaveRuns, numerics: WaveNumerics) -> Several:
    """March with ``numerics`` and with each setting varied; raises where the march itself fails.

    The budget is that of the first contact, those of the ``later`` ones, judged from the same runs, stand in it.
    """
    followed = runs.follow(numerics)
    judged = [_judged(runs, number, numerics) for number in range(len(followed.contacts))]
    return Several.judged(followed, judged, runs.work(), numerics)


def _judged(runs: WaveRuns, number: int, numerics: WaveNumerics) -> Judged:
    """One contact of all runs."""
    contact = runs.follow(numerics).contacts[number]
    half, curve = numerics.varied(steps=numerics.steps // 2), partial(runs.curve, number)
    cheap = half if runs.rings else numerics.varied(steps=runs.cheap)
    mesh, by_mesh = tells_of_mesh(cheap)
    penalty, stiffer = other_setting(cheap, "penalty")
    coarse = min(cheap, mesh, key=attrgetter("elements_per_contact"))  # it is fine enough to tell of the far field
    far, farther = other_setting(coarse, "far_radius")
    own, trust = curve_of(contact.march, contact.strike, numerics), FRONTS if numerics.follows_echoes else 1.0
    pulse, step = (FRONTS, _last_step(contact.march)) if runs.rings else (1.0, 0.0)
    changes: dict[str, Causes] = {
        "mesh": (
            Moved.between(curve(cheap), curve(mesh), trust * by_mesh, pulse=pulse, rings=runs.rings),
            reading(contact.march, contact.strike, numerics),
        ),
        "penalty": (Moved.between(curve(cheap), curve(penalty), factor(ORDER["penalty"], stiffer)),),
        "time_step": (
            EndMoved.between(
                curve(numerics),
                curve(half),
                trust * factor(ORDER["time_step"], False),
                pulse=pulse,
                rings=runs.rings,
                step=step,
            ),
            Swung(own, SAFETY * numerics.swing, max(numerics.echoes, 1.0)),
        ),
        "far_field": (FarMoved.between(curve(coarse), curve(far), factor(ORDER["far_field"], farther)),),
    }
    return own, changes


def _fallen(curve: Curve) -> Array:
    """When the force is the last time as large as the shares of ``FALLING``, s, (n,)."""
    time, force = curve.dense_time, np.append(curve.dense_force[:-1], 0.0)
    last = np.array([np.flatnonzero(force >= share * force.max())[-1] for share in FALLING])
    left, right = force[last], force[last + 1]
    excess = (left - force.max() * np.array(FALLING)) / (left - right)
    return np.asarray(time[last] + excess * (time[last + 1] - time[last]))


def _last_step(march: March) -> float:
    """The last whole one before the end, s."""
    return float(march.time[-2] - march.time[-3]) if len(march.time) > 2 else 0.0


@dataclass(frozen=True)
class Moved(Variation):
    """A change of the motion at equal times, not at equal shares of the contact.

    What chatters at the end of a contact moves the time at which it ends, and hardly the speed after it.
    ``pulse``: times what order one tells of the force, where it may have pulses that both settings miss, and of when it
    peaks, which the slope of a pulse moves where the force is flat; ``rings``: whether one may come near the end, where
    that counts which any of the late fall of the force tells of it.
    """

    pulse: float = 1.0
    rings: bool = False

    @cached_property
    def errors(self) -> dict[str, float]:
        """Error of every quantity, in its unit."""
        errors = super().errors
        return errors | {"duration": max(errors["duration"], self.fall), "peak_time": self.pulse * errors["peak_time"]}

    @cached_property
    def energies(self) -> dict[str, float]:
        """Error of every term of the energy account, J; what is lost of the motion of a ball that rings may ring on."""
        energies = super().energies
        if not self.rings:
            return energies
        own, other = (sum(curve.energy[term] for term in ("stored", *LOST)) for curve in (self.first, self.second))
        return energies | {"stored": max(energies["stored"], self.factor * abs(own - other))}

    @cached_property
    def fall(self) -> float:
        """Error, s, of when the force has fallen; 0: none comes near the end, or it is cut off."""
        if not self.rings or not self.first.separated or not self.second.separated:
            return 0.0
        return self.factor * float(np.abs(_fallen(self.first) - _fallen(self.second)).max())

    def force(self, time: Array) -> Array:
        """Error of the force at times, N."""
        return np.asarray(self.pulse * super().force(time))

    @cached_property
    def velocity(self) -> float:
        """Largest change of the velocity late in the contact, m/s."""
        return float(np.abs(self._late(self.first)[1] - self._late(self.second)[1]).max())

    @cached_property
    def impulse(self) -> float:
        """The same of the impulse, N s."""
        return float(np.abs(self._late(self.first)[0] - self._late(self.second)[0]).max())

    def _late(self, curve: Curve) -> tuple[Array, Array]:
        """Impulse, N s, and velocity, m/s; what has separated presses no more."""
        time = np.minimum(self.first.dense_time[self.late :], curve.duration)
        impulse = curve.read(time).impulse
        return impulse, curve.velocity(time, impulse)


@dataclass(frozen=True)
class EndMoved(Moved):
    """The same by the length of the steps, of which the end of a contact knows no order; only where it is read.

    ``step``, s: the last of the finer ones, where both lengths may miss the same share of it.
    """

    step: float = 0.0

    @cached_property
    def errors(self) -> dict[str, float]:
        """Error of every quantity, in its unit."""
        end = self._error("duration", self._duration) * UNORDERED / self.factor
        return super().errors | {"duration": max(end, self.fall, MISSED * self.step)}


@dataclass(frozen=True)
class FarMoved(Moved):
    """The same by how far the mesh reaches, near whose end waves hold as much motion as strain only on average.

    Of how much they hold of either no order tells.
    """

    @cached_property
    def energies(self) -> dict[str, float]:
        """Error of every term of the energy account, J."""
        unordered = max(UNORDERED / self.factor, 1.0)
        return {term: error * unordered if term in HELD_BY_WAVES else error for term, error in super().energies.items()}


@dataclass(frozen=True)
class Swung(Softening):
    """What so many ``echoes`` that no step follows do to the force: they swing it about what all steps agree on.

    Path and impulse average them, but for one. They may bring the peak to where the force, a half sine, is within twice
    the swing of its largest.
    """

    echoes: float

    @cached_property
    def errors(self) -> dict[str, float]:
        """Error of every quantity, in its unit."""
        whole, duration = super().errors, self.curve.duration
        return {name: error / self.echoes for name, error in whole.items()} | {
            "peak_force": whole["peak_force"],
            "peak_time": 2.0 / math.pi * math.sqrt(self.share) * duration,
            "duration": self.share * duration,
            "history_l2": self.share,
        }

    @cached_property
    def energies(self) -> dict[str, float]:
        """Error of every term of the energy account, J."""
        return {term: error / self.echoes for term, error in super().energies.items()}


def curve_of(march: March, strike: Strike, numerics: WaveNumerics, share: float = 1.0) -> Curve:
    """Rows lie closer at touch and separation, and as steps do where those differ; or a ``share`` of them."""
    curve = Curve.of(march, strike)
    rows = _rows(len(curve.x) - 1, numerics, share)
    found = replace(curve.through(rows), mean_force=_smoothed(curve.x, curve.mean_force, rows))
    if not numerics.follows_echoes:
        return found
    highest = float(found.dense_time[found.dense_force.argmax()])  # one of many peaks, which no quartic goes through
    return replace(found, peaked_at=highest)


def reading(march: March, strike: Strike, numerics: WaveNumerics) -> Variation:
    """What these rows leave, as half of them tell."""
    fine, half = (curve_of(march, strike, numerics, share) for share in (1.0, 0.5))
    return Variation(fine, half, (FRONTS if numerics.follows_echoes else 1.0) * SAFETY / (2**TRUSTED - 1))


def _rows(steps: int, numerics: WaveNumerics, share: float) -> npt.NDArray[np.intp]:
    """Those to keep of the first and so many steps; both ends."""
    echoing = ROWS_ECHO * numerics.echoes if numerics.follows_echoes else 0.0
    usual = max(ROWS * (AT / numerics.tolerance) ** (1 / ROWS_ORDER), echoing)
    count = share * usual * max(steps / numerics.steps, 1.0)
    places = np.linspace(0.0, 1.0, math.ceil(count) + 1)
    return np.unique(np.round(steps * places**2 * (3 - 2 * places)).astype(np.intp))


def _smoothed(places: Array, values: Array, rows: npt.NDArray[np.intp]) -> Array:
    """Values (n,) at rows (m,) by the polynomial through what lies around; as they are where too little does."""
    found = values[rows]
    last = len(rows) - 1
    for number, row in enumerate(rows[1:-1], start=1):
        around = slice(rows[max(number - REACH, 0)], rows[min(number + REACH, last)] + 1)
        x = places[around] - places[row]
        if len(x) > DEGREE + 1:
            found[number] = np.polyfit(x / np.abs(x).max(), values[around], DEGREE)[-1]
    return found


@dataclass(frozen=True, eq=False)
class Waves:
    """A scene and the ``cost`` of its budgets; its runs are kept, as a finer budget asks for some of them again."""

    scene: Scene
    chosen: Plan
    cost: Costs
    progress: Progress
    runs: WaveRuns
    rounds: ClassVar[int] = ROUNDS

    @classmethod
    def of(cls, scene: Scene, chosen: Plan, progress: Progress, cost: Costs, moving: Body) -> Waves:
        """Nothing is run yet; the bodies are those that ``moving`` makes."""
        runs = WaveRuns(scene, Strike.of(scene), moving, chosen.numerics.steps // 2)
        return cls(scene, chosen, cost, progress, runs)

    def certified(self, numerics: Numerics) -> Several:
        """A contact, or several, and the bars.

        Raises NotReached where no march ends or the budget costs too much, BadInput for an impact that goes deeper than
        its bodies.
        """
        assert isinstance(numerics, WaveNumerics)
        cost = self.cost(self.scene, numerics)
        cost.check(self.runs.spent)
        self.progress(f"waves, {cost}")
        self.runs.counted = Count(self.progress, f"waves, {cost.unknowns} unknowns", cost.all_steps)
        found = certify(self.runs, numerics)
        self.scene.check_sunk(max(budget.curve.quantities["peak_depth"] or 0.0 for budget in found.row))
        return found

    def finer(self, found: Several) -> Finer:
        """Settings whose bars are predicted to meet the tolerance."""
        if all(meets(part, found.numerics.tolerance) for part in found.parts):
            return Finer(None)
        shares = {cause: np.concatenate([shares_of(one, cause) for one in found.row]) for cause in GROWTH}
        finer = missing(shares, GROWTH, found.numerics, self.chosen.pinned)
        return Finer(None if finer == found.numerics else finer)

    def ledger(self, found: Several) -> Sequence[LedgerEntry]:
        """What the model leaves out, as was planned."""
        return self.chosen.ledger


def cost_of(scene: Scene, numerics: WaveNumerics, units: Units) -> Cost:
    """What one error budget costs with these settings. Raises BodyTooFine."""
    own, judging = (sum(unit.unknowns for unit in units(scene, one)) for one in (numerics, tells_of_mesh(numerics)[0]))
    found = Cost.of(own, numerics, scene.motion.impacts, judging if judging > own else 0)
    return replace(found, work=FLOWING * found.work) if scene.model.plasticity else found
