"""An impact whose waves run along a line: its record, and its bars by half the steps and a quarter of them.

Steps and elements are one, and doubled together until the bars meet the tolerance. The method that a target with waves
takes by itself is a witness of any other: two methods have one limit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from typing import ClassVar

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.budget.budget import Contacts, Solution
from fe_contact.budget.curve import PEAK_SHARE
from fe_contact.budget.plan import Plan
from fe_contact.budget.refine import Finer
from fe_contact.budget.variation import SAFETY, largest_around
from fe_contact.progress import Count, Counted, Progress
from fe_contact.settings import Given, Numerics, WaveNumerics
from fe_contact.waves.line_reading import DENT, DEPTH, FORCE, ROUNDING, TIME, VELOCITY, RodReading
from lumped.result.history import LEAST_ROWS, History
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import RULED_ABSOLUTE, UNITS, LedgerEntry, Quantity, largest_bar, meets
from lumped.result.score import distance
from lumped.scene.scene import Scene

COMPARED = 2001  # places along the contact at which two histories are compared
# Where no order shows, in place of SAFETY: Oberkampf and Roy, Verification and Validation in Scientific Computing,
# table 8.1 (ISBN 978-0-521-11360-1), after Roache.
UNSHOWN = 3.0
LATE = 0.75  # of the contact, from where on motion counts for that at the end
BEHIND = 0.002  # of the contact, that a front has to arrive before its end
AWAY = 0.02  # share of the contact within which a change counts as the error of its neighbours
ROUNDS = 5  # refinements before giving up, each of half the steps: the work has a bound of its own
STILL = 0.9  # of the largest bar of four times fewer steps: what falls as a root of the step is a half by then
STEP = 2_000  # unknowns whose share of a step takes as long as all the rest of it
# Settings that tell nothing of line elements, or what a step's own length says already.
LINE: Given = {"elements_per_contact": 1.0, "order": 1, "penalty": 1.0, "peak_share": 0.5, "rho": 1.0}
MOST_WORK = 1e8  # unknowns, and those of a step itself, times steps, of all marches: some fifteen seconds


@dataclass(frozen=True, eq=False)
class Run:
    """One march: what was read off it, its energies, J, its steps and unknowns; every contact, where several may be."""

    reading: RodReading
    energy: Mapping[str, float]
    steps: int
    unknowns: int
    contacts: Contacts = ()


@dataclass(frozen=True, eq=False)
class Line(Solution):
    """A march, the same with one cause of error varied, by cause, half the steps among them; a ``quarter`` of them.

    ``runs``: all marches made so far, with other settings too. The tolerance rules what all contacts tell together; no
    bars of the energies are known.
    """

    scene: Scene
    numerics: Numerics
    fine: Run
    others: Mapping[str, Run]
    quarter: Run
    runs: tuple[Run, ...] = ()

    @property
    def separated(self) -> bool:
        """Whether the last contact ended."""
        return self.fine.reading.separated

    @cached_property
    def contacts(self) -> Contacts:
        """Every contact, where there may be several; of several what each tells with its bar."""
        if self._alone:
            return self.fine.contacts
        band = self.history()
        return tuple(self._contact(number, band) for number in range(len(self.fine.contacts)))

    def _contact(self, number: int, band: History) -> dict[str, float | None]:
        """One of several contacts, with bars; None: the steps do not agree that there is such a thing."""
        own, found = self.fine.contacts[number], dict[str, float | None]()
        errors = self._first_errors if number == 0 else self._later_errors(number, band)
        for name, value in own.items():
            found |= {name: value, f"{name}_error": None if value is None else errors[name]}
        return found

    @property
    def _first_errors(self) -> dict[str, float | None]:
        """Bars of the first contact, whose touch is what the scene says, by name."""
        return {"start": 0.0, "velocity": 0.0} | {name: known.error for name, known in self.quantities.items()}

    def _later_errors(self, number: int, band: History) -> dict[str, float | None]:
        """Bars of one that follows, by name: what the steps change of it, and what a touch as late as may be does.

        A front that rings makes peaks of its own: the peak of the force is as well known as the ``band`` about the
        force of the contact, and lies anywhere within it.
        """
        own, moved, late = self.fine.contacts[number], self._moved(number), self.safety * self.moved
        if moved is None:
            return dict.fromkeys(own)
        start, came = own["start"] or 0.0, abs(own["velocity"] or 1.0)
        end = start + (own["duration"] if own["duration"] is not None else np.inf)
        inside = (band.time >= start - late) & (band.time <= end + late)
        time, force, error = band.time[inside], band.force[inside], band.force_error[inside]
        when = own["peak_time"] or 0.0
        as_high = time[force + error >= (force - error).max()]
        turned = abs(self.scene.gravity) * late
        least = {
            "start": late,
            "duration": late,
            "velocity": turned,
            "restitution": turned / came,
            "peak_force": float(error.max(initial=0.0)),
            "peak_time": late + float(np.abs(as_high - when).max(initial=0.0)),
            "peak_depth": came * late,
        }
        return {name: max(self.safety * moved[name], least[name]) for name in own}

    def _moved(self, number: int) -> dict[str, float] | None:
        """What the steps, or half of what twice the steps, change of a contact, and other methods; None: not all have
        it.
        """
        half = self.others["time_step"]
        pairs = [(1.0, self.fine, other) for other in self.others.values()] + [(0.5, half, self.quarter)]
        if any(len(other.contacts) <= number for _, _, other in pairs):
            return None
        found = dict[str, float]()
        for name in self.fine.contacts[number]:
            both = [(share, one.contacts[number][name], other.contacts[number][name]) for share, one, other in pairs]
            found[name] = max(share * _between(one, other) for share, one, other in both)
        return found

    @property
    def energy(self) -> Mapping[str, float]:
        """The account at the end, J."""
        return self.fine.energy

    @property
    def counted(self) -> Mapping[str, int]:
        """Unknowns of the finest march, marches and steps of all."""
        steps = sum(one.steps for one in self.runs)
        return {"degrees_of_freedom": self.fine.unknowns, "marches": len(self.runs), "steps": steps}

    def error(self, name: str, cause: str) -> float:
        """Error of a quantity by one cause, in its unit; steps and elements are one."""
        return (self.by_cause[cause][name].error or 0.0) if cause in self.by_cause else 0.0

    def history(self) -> History:
        """The rows, at least as many as a history has, with the force's error band.

        That is the largest change around a time, or half of what doubling the steps before changed there; beside it,
        where the force is but a line, what the line missed of the relaxation at touch.
        """
        fine, coarse, coarser = (one.reading for one in (self.fine, self.others["time_step"], self.quarter))
        rows = fine.rows
        if rows.shape[1] < LEAST_ROWS:
            between = np.linspace(rows[TIME, 0], rows[TIME, -1], LEAST_ROWS)[1:-1]
            more = np.array([np.interp(between, rows[TIME], row) for row in rows])
            rows = np.hstack([rows, more])[:, np.argsort(np.append(rows[TIME], between), kind="stable")]
        change = np.maximum(_largest(fine, coarse), 0.5 * _largest(coarse, coarser))
        width = int(COMPARED * min(max(AWAY, self.safety * self.moved / rows[TIME, -1]), 1.0))
        error = self.safety * np.interp(rows[TIME], _places(fine), largest_around(change, width))
        for begin, end in fine.blurred:
            error[(rows[TIME] >= begin) & (rows[TIME] <= end)] += UNSHOWN * fine.relaxed
        flat, curve = self.scene.profile.fixed_radius, self.scene.profile.load_curve
        radius = np.full(rows.shape[1], flat) if flat is not None else curve.contact_radius(rows[DENT])
        return History(rows[TIME], rows[DEPTH], rows[VELOCITY], rows[FORCE], np.asarray(radius), error)

    @property
    def safety(self) -> float:
        """Times a change: of several contacts no order shows, as touches fall anywhere in a step."""
        return SAFETY if self._alone else UNSHOWN

    @property
    def _alone(self) -> bool:
        """Whether there was one contact only."""
        return len(self.fine.contacts) < 2

    @property
    def moved(self) -> float:
        """Most by which half the steps move a contact, or half of what a quarter of them do, s."""
        coarse, coarser = self.others["time_step"], self.quarter
        return max(_apart(self.fine, coarse), 0.5 * _apart(coarse, coarser))

    @cached_property
    def by_cause(self) -> dict[str, dict[str, Quantity]]:
        """The quantities with the bars of each cause."""
        fine, found = self.fine.reading, {}
        for cause, other in self.others.items():
            least = _nearby(fine, other.reading) if self._alone else _ended_later(self.fine, other)
            if self.scene.profile.fixed_radius is not None:  # it jumps, and may stay at its peak
                least["peak_time"] = max(_as_high(fine, other.reading, self.safety), _beside_peak(fine))
                least["duration"] = max(least.get("duration", 0.0), fine.lingers if self._alone else 0.0)
            else:
                least["duration"] = _lost_in_rounding(fine)
            if cause == "time_step":
                halved = _halved(other.reading, self.quarter.reading)
                if not self._alone:  # touches fall anywhere in a step: by chance two lengths of it agree on them
                    halved["history_l2"] = math.sqrt(0.5) * _distance(other.reading, self.quarter.reading)
                least = {name: max(halved.get(name, 0.0), least.get(name, 0.0)) for name in halved | least}
            found[cause] = bars(fine, other.reading, least, self.safety)
        return found

    @cached_property
    def quantities(self) -> Mapping[str, Quantity]:
        """With the bars of all causes together."""
        found = dict(self.by_cause["time_step"])
        for name, quantity in found.items():
            errors = [own[name].error for own in self.by_cause.values()]
            error = None if None in errors else sum(error for error in errors if error is not None)
            found[name] = replace(quantity, error=error)
        return found


def bars(fine: RodReading, coarse: RodReading, least: Mapping[str, float], safety: float) -> dict[str, Quantity]:
    """Quantities with ``safety`` times what twice the steps change as bars: order one, as at the fronts.

    At the ``least`` so much changes: at one instant two histories may cross, and by chance two steps may agree. A norm
    does not cross zero, and knows a jump by the root of how far it is displaced.
    """
    found, changed = {}, _changes(fine, coarse)
    for name, unit in UNITS.items():
        value, error = fine.quantities[name], None
        if name == "history_l2":
            error = max(SAFETY, math.sqrt(safety)) * max(_distance(fine, coarse), least.get(name, 0.0))
        elif value is not None:
            error = safety * max(changed[name], least.get(name, 0.0))
            error += ROUNDING * (1.0 if name in RULED_ABSOLUTE else abs(value))
        found[name] = Quantity(value, error, unit)
    return found


def _changes(fine: RodReading, coarse: RodReading) -> dict[str, float]:
    """How far two marches are apart, by quantity that the fine one has, infinite where the coarse one has it not.

    The impulse has the striker's momentum and its weight to answer for: both count, as by chance they may cancel.
    """
    found = {}
    for name, value in fine.quantities.items():
        other = coarse.quantities[name]
        if value is not None:
            found[name] = np.inf if other is None else abs(value - other)
    turned = fine.mass * float(fine.rows[VELOCITY, -1] - coarse.rows[VELOCITY, -1])
    pressed = (fine.quantities["impulse"] or 0.0) - (coarse.quantities["impulse"] or 0.0)
    return found | {"impulse": abs(turned) + abs(pressed + turned)}


def _between(one: float | None, other: float | None) -> float:
    """How far two values are apart; infinitely where only one of them is known."""
    if one is None or other is None:
        return 0.0 if one is other else np.inf
    return abs(one - other)


def _halved(coarse: RodReading, coarser: RodReading) -> dict[str, float]:
    """At least half of what doubling the steps before changed, by quantity that both have: order one."""
    return {name: 0.5 * change for name, change in _changes(coarse, coarser).items() if np.isfinite(change)}


def _nearby(fine: RodReading, coarse: RodReading) -> dict[str, float]:
    """The largest changes of force and depth near their peaks, of motion late in the contact; at times of both."""
    force, change = _compared(fine, coarse)
    end, start = fine.rows[TIME, -1], abs(fine.rows[VELOCITY, 0])
    both = coarse.rows[:, coarse.rows[TIME] < end]
    depth, speed = (np.interp(both[TIME], fine.rows[TIME], fine.rows[row]) for row in (DEPTH, VELOCITY))
    late, deep = both[TIME] > _lately(fine), depth > PEAK_SHARE * depth.max()
    slower = float(np.abs(speed - both[VELOCITY])[late].max(initial=0.0))
    return {
        "peak_force": float(change[force > PEAK_SHARE * force.max()].max()),
        "peak_depth": float(np.abs(depth - both[DEPTH])[deep].max(initial=0.0)) + _between_rows(fine),
        "restitution": slower / start,
        "impulse": fine.mass * slower,
    }


def _as_high(fine: RodReading, coarse: RodReading, safety: float) -> float:
    """How far from its peak, s, the force of the first contact may be as high, for all that the steps change there and
    at the peak; without more ``safety`` than of those changes.
    """
    end, when = fine.quantities["duration"] or np.inf, fine.quantities["peak_time"] or 0.0
    sides = when + ROUNDING * fine.rows[TIME, -1] * np.array([-1.0, 1.0])  # one of them is that of the peak
    time = np.append(_places(fine), sides[fine.force_at(sides).argmax()])
    force = fine.force_at(time)
    change = coarse.force_at(time) - force
    tied = time[(force + safety * np.abs(change - change[-1]) >= (1.0 - ROUNDING) * force[-1]) & (time <= end)]
    return float(np.abs(tied - when).max()) / safety


def _beside_peak(fine: RodReading) -> float:
    """How far the rows beside the peak's lie, s: a smooth force is highest anywhere between them. At a jump, and at
    touch, it is there.
    """
    time, when = fine.rows[TIME], fine.quantities["peak_time"] or 0.0
    place = int(np.searchsorted(time, when))
    if place == 0 or np.count_nonzero(time == when) > 1 or place + 1 >= time.size:
        return 0.0
    return float(np.diff(time[place - 1 : place + 2]).max())


def _lost_in_rounding(fine: RodReading) -> float:
    """How long before its end, s, a dent has been smaller than what all steps may have rounded off the paths.

    Of a striker that the waves have all but stopped it fades so slowly that no change of steps tells when it is over.
    """
    time, dent = fine.rows[TIME], fine.rows[DENT]
    rounded = np.finfo(float).eps * dent.size * float(np.abs(fine.rows[DEPTH]).max())
    last = int(np.flatnonzero(dent[:-1] > rounded).max(initial=0))
    faded = np.interp(rounded, dent[[last + 1, last]], time[[last + 1, last]])
    return float(time[-1] - faded)


def _apart(fine: Run, coarse: Run) -> float:
    """Most by which contacts of two marches start apart, or may faintly press before that or after their end, s."""
    pairs = zip(fine.contacts, coarse.contacts, strict=False)
    starts = [abs((one["start"] or 0.0) - (other["start"] or 0.0)) for one, other in pairs]
    return max((*starts, *(time for pair in _faintly(fine, coarse) for time in pair)), default=0.0)


def _faintly(fine: Run, coarse: Run) -> list[tuple[float, float]]:
    """How long after each contact and before the next one both may faintly press, s.

    They may while the gap is smaller than its error, by what the steps change of it.
    """
    other, found = coarse.reading.rows, list[tuple[float, float]]()
    for one, then in pairwise(fine.contacts):
        end, start = (one["start"] or 0.0) + (one["duration"] or 0.0), then["start"] or 0.0
        time, dent = (_free(fine, end, start)[row] for row in (TIME, DENT))
        near = time[-dent < SAFETY * np.abs(dent - np.interp(time, other[TIME], other[DENT]))]
        highest = time[np.argmin(dent)]
        left, touching = near[near <= highest], near[near > highest]
        found.append((float(left.max(initial=end)) - end, start - float(touching.min(initial=start))))
    return found


def _free(fine: Run, end: float, start: float) -> Array:
    """Rows between a contact's end and the next one's start, s."""
    rows = fine.reading.rows
    return rows[:, (rows[TIME] >= end) & (rows[TIME] <= start)]


def _ended_later(fine: Run, coarse: Run) -> dict[str, float]:
    """Time, s, by which the first contact may faintly go on, and the share of the velocity that gravity changes till
    then, or in the time by which the steps change the end: that change is the error, without more safety.
    """
    one, then = fine.contacts[:2]
    free = _free(fine, (one["start"] or 0.0) + (one["duration"] or 0.0), then["start"] or 0.0)
    later, moved = _faintly(fine, coarse)[0][0], (one["duration"] or 0.0) - (coarse.contacts[0]["duration"] or 0.0)
    faster = np.ptp(free[VELOCITY]) / np.ptp(free[TIME]) / abs(fine.reading.rows[VELOCITY, 0])
    return {"duration": later, "restitution": float(faster * max(later, abs(moved) / UNSHOWN))}


def _lately(fine: RodReading) -> float:
    """From when on motion counts for that at the end, s: the last of it; but not a front's arrival, if enough follows.

    There velocities turn so fast that those of two marches differ by half a step's.
    """
    time, end = fine.rows[TIME], float(fine.rows[TIME, -1])
    fronts = time[1:][np.diff(time) == 0.0]
    behind = fronts[fronts < (1.0 - BEHIND) * end].max(initial=0.0)
    return max(LATE * end, float(behind))


def _between_rows(fine: RodReading) -> float:
    """How much deeper than its deepest row a motion that turns may have been, m: half a step at that row's speed."""
    deepest = int(np.argmax(fine.rows[DEPTH]))
    if deepest in (0, fine.rows.shape[1] - 1):
        return 0.0
    around = fine.rows[TIME, deepest - 1 : deepest + 2]
    return float(0.5 * np.diff(around).max() * abs(fine.rows[VELOCITY, deepest]))


def _distance(fine: RodReading, coarse: RodReading) -> float:
    """Norm of the change of the force over that of the force, until both have ended."""
    return distance(fine.force_at, coarse.force_at, np.union1d(fine.rows[TIME], coarse.rows[TIME]))


def _compared(fine: RodReading, coarse: RodReading) -> tuple[Array, Array]:
    places = _places(fine)
    force = fine.force_at(places)
    return force, np.abs(force - coarse.force_at(places))


def _largest(fine: RodReading, coarse: RodReading) -> Array:
    """The largest change of the force about each of the places, N, at the last one also of what follows.

    Between two rows of either both forces are straight lines: their ends tell, however little a jump is displaced.
    """
    end = fine.rows[TIME, -1]
    knots = np.unique(np.concatenate([fine.rows[TIME], coarse.rows[TIME], _places(fine)]))
    begun = np.flatnonzero(np.diff(knots) > 2.0 * ROUNDING * end)
    inside = ROUNDING * end * np.array([[1.0], [-1.0]])
    times = (np.stack([knots[begun], knots[begun + 1]]) + inside).ravel()
    found = np.zeros(COMPARED)
    place = np.minimum(np.round(times / end * (COMPARED - 1)).astype(np.intp), COMPARED - 1)
    np.maximum.at(found, place, np.abs(fine.force_at(times) - coarse.force_at(times)))
    return found


def _places(fine: RodReading) -> Array:
    """Times up to just before the end of contact, s, where a force may jump to zero."""
    return np.linspace(0.0, fine.rows[TIME, -1] * (1.0 - ROUNDING), COMPARED)


@dataclass(frozen=True, eq=False)
class Doubling:
    """``march`` of a scene with settings, its steps counted, which raises NotReached where it does not end; those with
    one cause of error ``varied`` at a time; ``most_steps``.

    ``dented``: whether what was found, a dent, says more of what the model leaves out than the plan. Each march is made
    once: with twice the steps, the one before is what half of them give. ``bars``: the largest one by steps.
    """

    scene: Scene
    chosen: Plan
    march: Callable[[WaveNumerics, Counted], Run]
    varied: Callable[[WaveNumerics], Mapping[str, WaveNumerics]]
    most_steps: float
    dented: bool
    progress: Progress
    runs: dict[WaveNumerics, Run] = field(default_factory=dict)
    bars: dict[int, float] = field(default_factory=dict)
    rounds: ClassVar[int] = ROUNDS

    def certified(self, numerics: Numerics) -> Line:
        """The march and its variations. Raises NotReached where one does not end."""
        assert isinstance(numerics, WaveNumerics)
        others = self.varied(numerics)
        quarter = self._marched(self.varied(others["time_step"])["time_step"])
        fine, varied = self._marched(numerics), {cause: self._marched(other) for cause, other in others.items()}
        found = Line(self.scene, numerics, fine, varied, quarter, tuple(self.runs.values()))
        self.bars[numerics.steps] = largest_bar(found.quantities)
        return found

    def finer(self, found: Line) -> Finer:
        """Twice the steps, ``most_steps`` at most, where a bar is too wide and the work allows it."""
        twice = 2 * found.numerics.steps
        dear = _work(2 * found.fine.steps, 2 * found.fine.unknowns) + self._spent > MOST_WORK
        if "steps" in self.chosen.pinned or twice > self.most_steps or dear:
            return Finer(None)
        if meets(found.quantities, found.numerics.tolerance):
            return Finer(None)
        few, steps = found.numerics.steps // 4, found.numerics.steps
        if few in self.bars and self.bars[steps] > STILL * self.bars[few]:
            return Finer(None, f"{steps} steps do no better than {few}")
        return Finer(found.numerics.varied(steps=twice))

    def ledger(self, found: Line) -> Sequence[LedgerEntry]:
        """What the model leaves out."""
        if not self.dented:
            return self.chosen.ledger
        return model_ledger(self.scene, Peak.of(found.quantities, found.history()))

    def _marched(self, numerics: WaveNumerics) -> Run:
        if numerics not in self.runs:
            message = f"steps of waves along a line (numerics.steps = {numerics.steps})"
            self.runs[numerics] = self.march(numerics, Count.of(self.progress, message, 0.0))
        return self.runs[numerics]

    @property
    def _spent(self) -> float:
        """Work of all marches so far."""
        return sum(_work(one.steps, one.unknowns) for one in self.runs.values())


def _work(steps: int, unknowns: int) -> float:
    """Of a march."""
    return float(steps) * (unknowns + STEP)


def witness(numerics: WaveNumerics, usual: Mapping[str, str]) -> dict[str, WaveNumerics]:
    """The same impact by the ``usual`` scheme, mass and enforcement, by the cause that errs where another is chosen.

    Half the steps alone do not tell: a method that chatters loses contact at once however short they are.
    """
    other = [key for key, name in usual.items() if getattr(numerics, key) != name]
    if not other:
        return {}
    return {"penalty" if "enforcement" in other else "mesh": numerics.varied(**usual)}
