"""One impact of a rigid striker, from physics and settings to a march; knows nothing of plans and bars.

When contact will end, read from the trend of the axis' elastic response.

What a march leaves behind: histories, snapshots, and an energy account of which each term is computed on its own.

Where the time steps lie: fine at first touch and at separation, where the force is a power 3/2 of time.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fe_contact.assembly.forms import Array
from fe_contact.errors import ContactLost, ContactNotSettled, MemoryTooSmall, TooManySteps
from fe_contact.progress import Counted, uncounted
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import March, State, Step, Stepping, Strike, Work
from fe_contact.steppers.struck import Struck

Energies = Mapping[str, float]

FAILURES = (ContactLost, ContactNotSettled, MemoryTooSmall)  # of a step that may be too long
PREDICTIONS = 2  # of the separation: how far they lie apart tells how well its time can be read
NOISE = 1e-4  # share of the peak force below which a contact problem may drown in the mesh's error
AT_REST = 1e-4  # share of the velocity at touch below which a fluid has stopped the striker
# In the root of time, of rows at rest: so near, six of them tell the mean force since touch, as 1/t, to 1e-6.
REST_GROWTH = 0.03
FAINT = 1e-3  # share of the peak force below which contact may end
LONGEST = 2.0  # under gravity, of the mean step: about the largest one within an expected contact
SETTLED = 0.3  # of the tolerance: share of gravity below which force and velocity swing no more than may be missed
STEPS_ALLOWED = 30  # multiple of the settings' steps after which the march gives up: 50 contact times take 25
OVERTIME = 10.0  # past the expected end a step takes so much over the settings' steps of the time since: 1/4 of 40
MOST_OF_REST = 0.75  # largest share of the time left that a step near separation may take


def march(
    strike: Strike,
    struck: Struck,
    numerics: Numerics,
    expected: Sequence[float] | Array = (),
) -> March:
    """Integrate from first touch to separation, or to ``strike.end_time``.

    ``expected`` contact radii, m, of the first steps, known from a like march, spare a mesh that follows the contact
    the search for its scale.

    Raises the named failures of :mod:`fe_contact.errors` where a step does not converge.
    """
    return marched(struck.stepper(strike, numerics, expected))


def marched(stepper: Stepping, counted: Counted = uncounted) -> March:
    """The same with what takes its steps, each of them ``counted``."""
    return record(stepper, _Marcher(stepper, counted).run())


class Spent(NamedTuple):
    """Energies of one step, J: heat, what the scheme leaves unaccounted for, work that does not reach the body."""

    heat: float
    lost: float
    between: float

    @classmethod
    def of(cls, stepper: Stepping, before: State, step: Step) -> Spent:
        """Of a step from a state that still has its memory."""
        heat, lost = stepper.heat_and_loss(before.memory, step.state.memory, step.length)
        return cls(heat, lost, stepper.between(before, step))


@dataclass(frozen=True, eq=False)
class Passage:
    """What a march went through: its ``states``, the first at touch, ``steps`` between them, and what each ``spent``;
    ``held``: what the body stored at touch, J; whether it ``separated``, and when, to what spread, s.
    """

    states: Sequence[State]
    steps: Sequence[Step]
    spent: Sequence[Spent]
    held: float
    separated: bool
    spread: float


class _Marcher:
    """The loop: what stays the same through an impact is held here, what changes is passed and returned.

    What a body remembers is larger than all else; unless each state ``keeps`` its own, the last one alone has it.
    """

    def __init__(self, stepper: Stepping, counted: Counted, keeps: bool = False) -> None:
        self.counted, self.keeps = counted, keeps
        self.stepper, self.strike, self.numerics = stepper, stepper.strike, stepper.numerics
        self.shortest = stepper.shortest * self.numerics.contact_time

    def run(self) -> Passage:
        strike = self.strike
        states, steps, spent = [self.stepper.touch()], list[Step](), list[Spent]()
        held = self.stepper.stored(states[0].memory)
        separated = False
        free_fluid = strike.relaxation.equilibrium == 0 and strike.gravity == 0
        resting = AT_REST * strike.velocity if free_fluid else 0.0
        predicted, unseen = list[float](), 0.0
        while states[-1].time < strike.end_time * (1 - 1e-12):
            if len(steps) > STEPS_ALLOWED * self.numerics.steps:
                raise TooManySteps(len(steps), states[-1].time)
            left = self._time_left(steps)
            predicted.append(states[-1].time + (left or 0.0))
            step, lost = None, None
            if left is None or left > self.shortest:
                try:
                    step = self._advance(states[-1], steps, left)
                except FAILURES as failure:
                    if not _ends(failure, steps):
                        raise
                    lost = failure
                    if isinstance(failure, ContactLost):
                        left = min(left or 0.0, self.shortest)
                    else:  # too faint to be found: its end lies as far as the trend says, or within a step's length
                        unseen = left or steps[-1].length
            if step is None:
                if lost is not None and states[-1].velocity > resting:
                    raise lost  # a striker that still goes deeper has not left
                separated = states[-1].velocity < -resting
                states += self._flight(states[-1], left or 0.0) if separated else self._rest(states[-1])
                break
            self.counted(1.0)
            spent.append(Spent.of(self.stepper, states[-1], step))
            if not self.keeps:
                states[-1] = states[-1]._replace(memory=None)
                steps[-1:] = [last._replace(state=states[-1]) for last in steps[-1:]]
            steps.append(step)
            states.append(step.state)
        spread = float(np.ptp(predicted[-PREDICTIONS:])) + unseen if separated else 0.0
        return Passage(states, steps, spent, held, separated, spread)

    def _time_left(self, steps: Sequence[Step]) -> float | None:
        """Time to separation while the striker leaves, else None."""
        if len(steps) < 4 or steps[-1].state.velocity >= 0:
            return None
        recent = steps[-3:]
        times = [s.state.time - (1 - self.stepper.scheme.sample) * s.length for s in recent]
        left = time_left(times, [s.axis_response for s in recent], recent[-1].state.time)
        # a kink in the trend is not the end: contact ends faintly
        return None if left is None or (left <= self.shortest and not _faint(steps, FAINT)) else left

    def _advance(self, state: State, steps: Sequence[Step], left: float | None) -> Step:
        """The next step: on the grid, shorter towards separation, and again where contact was lost in it.

        Raises what the shortest step fails by.
        """
        numerics = self.numerics
        length = numerics.contact_time * step_length(len(steps), numerics.steps, numerics.peak_share)
        if left is not None:
            length = min(length, left * share_of_rest(left / numerics.contact_time, numerics.steps))
        if self.strike.gravity > 0.0 and steps:
            length = min(length, self._longest(steps[-1]))
        length = min(length, self.strike.end_time - state.time)
        while True:
            try:
                return self.stepper.step(state, steps, length)
            except FAILURES as failure:
                if self._unseen(failure, steps, length):
                    length *= 2
                    continue
                length /= 2
                if length < self.shortest or not _ends(failure, steps):
                    raise

    def _unseen(self, failure: Exception, steps: Sequence[Step], length: float) -> bool:
        """Whether a first step leads to less depth than a mesh that stays can see, and may be longer."""
        longest = self.numerics.contact_time / self.numerics.steps
        return not steps and isinstance(failure, ContactLost) and length < longest

    def _longest(self, last: Step) -> float:
        """What does not separate swings about its weight, which no long step would see, until it has settled."""
        strike, time = self.strike, self.numerics.contact_time
        swing = abs(last.force / strike.mass - strike.gravity) + abs(last.state.velocity) / time
        steps, small = self.numerics.steps, SETTLED * self.numerics.tolerance * strike.gravity
        return max(growth(steps) * last.length if swing < small else 0.0, LONGEST * time / steps)

    def _flight(self, state: State, left: float) -> list[State]:
        """The little time to separation, over which the force is below any rounding that matters."""
        if left == 0.0:
            return []
        pull = self.strike.gravity * left
        depth = state.depth + left * (state.velocity + 0.5 * pull)
        return [state._replace(time=state.time + left, depth=depth, velocity=state.velocity + pull)]

    def _rest(self, state: State) -> list[State]:
        """A striker that a fluid has stopped, up to the end time."""
        end = self.strike.end_time
        rows = math.ceil(0.5 * math.log(end / state.time) / math.log1p(REST_GROWTH))
        times = np.geomspace(state.time, end, rows + 1)[1:].tolist()
        return [state._replace(time=time) for time in times]


def _ends(failure: Exception, steps: Sequence[Step]) -> bool:
    """Whether a step may have failed because contact ends in it."""
    return bool(steps) and (isinstance(failure, ContactLost) or _faint(steps, NOISE))


def _faint(steps: Sequence[Step], share: float) -> bool:
    """Whether the force has fallen below a share of its peak."""
    return steps[-1].force <= share * max(step.force for step in steps)


def time_left(times: Sequence[float], responses: Sequence[float], now: float) -> float | None:
    """Time from ``now`` to separation, s; None while the response does not fall.

    The displacement that the pressure would cause elastically at the axis goes to zero linearly as contact
    ends, whatever the profile and the material: the parabola through its last three samples tells when.

    Parameters
    ----------
    times, responses : last three samples, s and any unit, the latest last.
    """
    first, second, third = responses
    to_second, to_first = times[2] - times[1], times[2] - times[0]
    slope = (third - second) / to_second
    if slope >= 0:
        return None
    bend = (slope - (third - first) / to_first) / (to_first - to_second)
    lean = slope + bend * to_second
    straight = -third / slope
    discriminant = lean * lean - 4 * bend * third
    curved = 2 * third / (math.sqrt(discriminant) - lean) if discriminant >= 0 and lean < 0 else straight
    return max(times[2] + min(curved, 2 * straight) - now, 0.0)


def step_length(done: int, steps: int, peak_share: float) -> float:
    """Length of the next step in units of the expected contact time.

    Both ends of the contact are graded quadratically, so that half-integer powers of the time from touch
    and of the time to separation are resolved; half the steps lie before the peak of the force.

    Parameters
    ----------
    done : steps already taken.
    steps : steps in the expected contact time.
    peak_share : expected time of the peak force over contact time.
    """
    if done < steps:
        return elapsed((done + 1) / steps, peak_share) - elapsed(done / steps, peak_share)
    last = 1 - elapsed((steps - 1) / steps, peak_share)
    return last * growth(steps) ** (done - steps + 1)


def growth(steps: int) -> float:
    """Ratio of successive steps once the expected contact time is over."""
    return 1 + OVERTIME / steps


def share_of_rest(left: float, steps: int) -> float:
    """Share of the time left, itself a share of the contact time, that the next step may take.

    As many steps are left as the grading at the end of a contact would have: the time left falls with their square.
    """
    to_go = max(steps * math.sqrt(left / 3), 1.0)
    return min((2 * to_go - 1) / to_go**2, MOST_OF_REST)


@lru_cache(maxsize=4096)
def elapsed(share: float, peak_share: float) -> float:
    """Time over contact time after a share of the steps; 0 at 0, 1 at 1, ``peak_share`` at 1/2 at most."""
    middle = _inverse_smoothstep(min(peak_share, 0.5))
    growth = 2 * math.log(1 / middle - 1)
    grown = share if growth < 1e-9 else math.expm1(growth * share) / math.expm1(growth)
    return grown * grown * (3 - 2 * grown)


def _inverse_smoothstep(value: float) -> float:
    """w with 3 w^2 - 2 w^3 = value, 0 < value <= 1/2."""
    return 0.5 - math.sin(math.asin(1 - 2 * value) / 3)


def record(stepper: Stepping, passage: Passage) -> March:
    """Gather what a march leaves behind; its snapshots are of the same march once more."""
    states, steps = passage.states, passage.steps
    works, last = [step.work for step in steps], states[len(steps)]
    return March(
        time=np.array([state.time for state in states]),
        depth=np.array([state.depth for state in states]),
        impulse=np.array([state.impulse for state in states]),
        first_force=stepper.first_force,
        radius_time=np.array([step.radius_time for step in steps]),
        radius=np.array([step.radius for step in steps]),
        separated=passage.separated,
        photograph=lambda: stepper.snapshots(_Marcher(stepper, uncounted, keeps=True).run().steps),
        energy=_energy(stepper, passage),
        end_spread=passage.spread,
        work=Work(len(steps), sum(w.contact_problems for w in works), sum(w.iterations for w in works)),
        memory=last.memory,
        memory_time=last.time,
    )


def balanced(terms: Energies) -> dict[str, float]:
    """Energies, J, with what is left of the first of them, ``in``, when all others are taken from it."""
    known = {name: value for name, value in terms.items() if name != "residual"}
    return known | {"residual": 2 * known["in"] - sum(known.values())}


def onwards(later: Energies, earlier: Energies, flight_heat: float) -> dict[str, float]:
    """The account of a contact, J, carried on from that of an ``earlier`` one over a flight."""
    spent = {name: earlier[name] + later[name] for name in ("viscous", "radiated", "contact", "numerical")}
    spent["viscous"] += flight_heat
    given = earlier["in"] - earlier["out"] - earlier["stored"] + flight_heat + later["in"]
    return balanced({**later, **spent, "in": given})


def _energy(stepper: Stepping, passage: Passage) -> dict[str, float]:
    """Terms in J, each zero where a model without inertia knows none.

    ``in``: with what the body still stored at touch. ``contact``: the striker's work that does not reach the body, none
    of it where steps are short and the penalty is stiff. ``numerical``: what scheme and mesh leave unaccounted for.
    """
    strike, scheme, states, steps = stepper.strike, stepper.scheme, passage.states, passage.steps
    ended, last = states[len(steps)], states[-1]
    jumps = np.diff([state.velocity for state in states[: len(steps) + 1]])
    heat, lost, between = (sum(terms) for terms in zip(*passage.spent, strict=True))
    stored = stepper.stored(ended.memory)
    crept = _crept(stored, passage.spent[-1].heat / steps[-1].length, last.time - ended.time)
    return balanced(
        {
            "in": 0.5 * strike.mass * strike.velocity**2
            + strike.mass * strike.gravity * (last.depth - strike.depth)
            + passage.held,
            "out": 0.5 * strike.mass * last.velocity**2,
            "stored": stored - crept,
            "viscous": heat + crept,
            "radiated": 0.0,
            "contact": between,
            "numerical": lost + (scheme.lever - 0.5) * strike.mass * float(jumps @ jumps),
        }
    )


def _crept(stored: float, rate: float, time: float) -> float:
    """Heat of a body that nothing presses over a time, s, from what it stores, J, at a rate that falls with it; J."""
    return stored * -float(np.expm1(-max(rate, 0.0) * time / stored)) if stored > 0.0 else 0.0
