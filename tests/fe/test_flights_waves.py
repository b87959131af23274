"""Flights between contacts on what still moves: every touch found, when it comes, in few steps."""

from __future__ import annotations

import math
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.optimize import brentq

from fe_contact.budget.plan import EARLY_PEAK
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics.body import BodyWithMass, Part, Pressing, state_of, undeformed
from fe_contact.dynamics.march import MOST_WORK, Energies, Moment, Motion, Sample, Steppers, account_at_start
from fe_contact.dynamics.stepping import Enforced, ImplicitStepper
from fe_contact.errors import MemoryTooSmall, TooManySteps
from fe_contact.march.impacts import Grounded
from fe_contact.settings import WaveNumerics
from fe_contact.steppers.steps import Strike
from fe_contact.waves import impact
from fe_contact.waves.impact import Flights, WaveBouncer, choices_of
from fe_contact.waves.plan import DEFAULTS, MARCHES
from lumped.materials import Relaxation

penalty = ENFORCEMENTS.get("penalty")

STEP, PATIENCE = 0.02, 32
RELAXATION = Relaxation(1.0, (0.7,), (5.0,))
DRAWS = 30
HARD: Any = SimpleNamespace(flowed=None)  # the end of what has not yielded


class Case:
    """A ball rises from a plate of mass one on a standard linear solid and a dashpot, which still swings."""

    def __init__(self, rng: np.random.Generator) -> None:
        self.speed, self.dashpot = rng.uniform(0.2, 1.0), rng.uniform(0.2, 2.0)
        self.gravity = 2.0 * self.speed / 10 ** rng.uniform(0.3, 3.5)  # flights of 2 to 3000 radians
        self.place = rng.uniform(-0.3, 0.3) * self.speed
        self.branch = rng.uniform(-0.3, 0.3) * self.speed
        self.rising = rng.uniform(-1.0, 0.95) * self.speed  # of the plate, slower than the ball

    @property
    def flight(self) -> float:
        """Over a plate at rest, s."""
        return 2.0 * self.speed / self.gravity

    @property
    def body(self) -> BodyWithMass:
        plate = sparse.csc_matrix(np.diag([1.0, 0.0]))
        pressing = Pressing(-sparse.eye(2, format="csc"), np.ones((1, 2)), np.ones(1), np.zeros(1))
        rigid, gravity = np.array([0.0, 1.0]), np.array([0.0, self.gravity])
        return BodyWithMass(plate, rigid, (Part(plate, RELAXATION),), self.dashpot * plate, gravity, pressing)

    @property
    def parted(self) -> Moment:
        body, at_rest = self.body, undeformed(self.body, np.zeros(2))
        displacement, branches = np.array([self.place, -self.place]), (np.array([[self.branch, 0.0]]),)
        force = self.place + RELAXATION.moduli[0] * self.branch
        velocity = np.array([self.rising, -self.speed])
        acceleration = np.array([-force - self.dashpot * self.rising, self.gravity])
        motion = np.array([displacement, velocity, acceleration])
        state = state_of(body, 0.0, motion, branches, at_rest.signed_pressure)
        return Moment(state, account_at_start(body, state))

    def touch(self) -> float:
        """The first zero of the gap after the separation, s, by the eigenvalues of the plate's motion."""
        (modulus,), (tau,) = RELAXATION.moduli, RELAXATION.times
        rates = np.array([[0.0, 1.0, 0.0], [-1.0, -self.dashpot, -modulus], [0.0, 1.0, -1.0 / tau]])
        values, vectors = np.linalg.eig(rates)
        swings = vectors[0] * np.linalg.solve(vectors, [self.place, self.rising, self.branch])

        def gap(time: float | np.ndarray) -> np.ndarray:
            risen = self.place + self.speed * time - 0.5 * self.gravity * np.square(time)
            return risen - (np.exp(np.multiply.outer(time, values)) @ swings).real

        times = np.concatenate([np.linspace(1e-3, 60.0, 6000), np.linspace(60.0, 2.0 * self.flight + 60.0, 200)])
        first = int(np.argmax(gap(times) <= 0.0))
        return float(brentq(gap, times[first - 1], times[first], xtol=1e-13))


def landed(case: Case, step: float, patience: int) -> tuple[Moment, Flights]:
    flights = Flights(Steppers(case.body, Enforced(penalty, 1.0)), step, patience)
    found = flights.landing(case.parted, math.inf)
    assert found is not None
    return found, flights


def late(case: Case, steps: int) -> float:
    """How much later than it comes a touch is found with so many steps before they double, s."""
    return landed(case, STEP * PATIENCE / steps, steps)[0].state.time - case.touch()


@pytest.fixture(scope="module")
def cases() -> list[Case]:
    rng = np.random.default_rng(8)
    return [Case(rng) for _ in range(DRAWS)]


@pytest.mark.tenth
def test_no_touch_is_missed_and_finer_steps_find_it_when_it_comes(cases: list[Case]) -> None:
    """Though the plate swings: within a twelfth of its period by the coarsest steps; of order two."""
    coarsest, coarse, fine = (np.abs([late(case, steps) for case in cases]) for steps in (2, 16, PATIENCE))
    assert coarsest.max() < 2.0 * math.pi / 12.0
    assert fine.max() < 0.01
    assert np.sum(coarse) / np.sum(fine) > 3.0


@pytest.mark.tenth
def test_a_flight_takes_as_many_steps_as_the_logarithm_of_its_length(cases: list[Case]) -> None:
    for case in cases:
        _, flights = landed(case, STEP, PATIENCE)
        doublings = math.log2(1.0 + case.flight / STEP / PATIENCE)
        assert flights.steps < (PATIENCE + 2.0) * (doublings + 2.0)


@pytest.mark.tenth
def test_the_ball_falls_freely_and_the_ledger_closes(cases: list[Case]) -> None:
    for case in cases:
        touch = landed(case, STEP, PATIENCE)[0]
        state, energies = touch.state, touch.energies
        fallen = state.time * (0.5 * case.gravity * state.time - case.speed)
        assert state.displacement[1] == pytest.approx(fallen - case.place, abs=1e-9 * case.speed * case.flight)
        assert state.velocity[1] == pytest.approx(case.gravity * state.time - case.speed, abs=1e-9 * case.speed)
        assert abs(energies.residual) < 1e-9 * energies.work
        assert not (state.signed_pressure > 0.0).any()


@pytest.mark.parametrize("number", range(4))
def test_a_touch_is_where_the_surfaces_meet_and_not_where_the_step_before_it_ends(
    cases: list[Case], number: int
) -> None:
    """Located within its step, and nothing presses yet. From there on it is now: nothing flies any more."""
    touch, flights = landed(cases[number], 0.1, 8)
    apart = touch.state.displacement.sum()
    closing = touch.state.velocity.sum() * 0.1
    assert closing > 0.0
    assert abs(apart) < 2e-3 * closing
    assert touch.state.signed_pressure.max() <= 0.0
    flown, body, parted = flights.steps, cases[number].body, cases[number].parted
    motion = np.array([[0.0, 0.0], [0.1, 0.3], [0.0, 0.0]])
    meeting = Moment(state_of(body, 1.0, motion, (np.zeros((1, 2)),), touch.state.signed_pressure), parted.energies)
    assert flights._touched(meeting) is meeting
    assert flights.steps == flown


def test_a_touch_after_the_end_is_none(cases: list[Case]) -> None:
    flights = Flights(Steppers(cases[0].body, Enforced(penalty, 1.0)), STEP, PATIENCE)
    assert flights.landing(cases[0].parted, 0.5 * cases[0].touch()) is None


@pytest.mark.parametrize(("ends", "why"), [(0.5, Grounded.LATE), (1e-9, Grounded.LATE), (math.inf, Grounded.MANY)])
def test_where_no_touch_follows_it_is_said_why(cases: list[Case], ends: float, why: Grounded) -> None:
    """Time ends before it, by a share of the flight or at once; or so many steps are not to be afforded."""
    case, nothing = cases[0], cast(Any, None)
    flights = Flights(Steppers(case.body, Enforced(penalty, 1.0)), STEP, PATIENCE)
    scene = SimpleNamespace(gravity=case.gravity, end_time=ends * case.touch())
    if math.isinf(ends):
        flights._most = 3.0
    bouncer: Any = SimpleNamespace(
        _scene=scene, _moving=SimpleNamespace(body=case.body), flights=flights, _steps=0, _moment=case.parted
    )
    assert WaveBouncer.touch(bouncer, nothing, nothing) is why
    scene.gravity = 0.0
    assert WaveBouncer.touch(bouncer, nothing, nothing) is Grounded.NO_GRAVITY


def test_a_touch_begins_the_next_strike_where_when_and_as_fast_as_the_surfaces_meet(cases: list[Case]) -> None:
    """By the clock of all contacts; unless these and the flights have taken all the work that one march may be."""
    case, nothing = cases[0], cast("Any", None)
    watch = sparse.csr_matrix(np.array([[1.0, 1.0]]))

    def bouncer(steps: float) -> Any:
        flights = Flights(Steppers(case.body, Enforced(penalty, 1.0)), 0.1, 8)
        scene = SimpleNamespace(gravity=case.gravity, end_time=math.inf)
        moving = SimpleNamespace(body=case.body, watch=watch)
        return SimpleNamespace(_scene=scene, _moving=moving, flights=flights, _steps=steps, _moment=case.parted)

    before = Strike(lambda r: r**2, 1.0, 9.0, case.gravity, RELAXATION, 1e9, touched_at=-7.0)
    flown = bouncer(0)
    found = WaveBouncer.touch(flown, before, nothing)
    assert isinstance(found, Strike)
    state = flown._moment.state
    assert state.time == pytest.approx(case.touch(), rel=1e-2)
    assert found.touched_at == pytest.approx(state.time)
    assert found.end_time == pytest.approx(1e9 - state.time - 7.0)
    assert found.depth == pytest.approx(state.displacement.sum())
    assert found.velocity == pytest.approx(state.velocity.sum())
    most = MOST_WORK / MARCHES / case.body.size
    assert isinstance(WaveBouncer.touch(bouncer(0.999 * most), before, nothing), Strike)
    assert WaveBouncer.touch(bouncer(1.001 * most), before, nothing) is Grounded.MANY


@pytest.mark.parametrize(("steps", "patience"), [(200, 20), (12, 2)])
def test_contacts_and_flights_take_the_steps_and_the_penalty_of_their_settings(
    cases: list[Case], steps: int, patience: int
) -> None:
    """The penalty over the stiffness until the force peaks, a dashpot too; flights wait a tenth of a contact.

    A contact may last some ten times as long as planned, but not a hundred times.
    """
    given = {"elements_per_contact": 4.0, "penalty": 100.0, "far_radius": 20.0, "peak_share": 0.125, "steps": steps}
    numerics = WaveNumerics(**DEFAULTS | given | {"tolerance": 3e-3, "contact_radius": 2e-3, "contact_time": 4e-3})
    body, modulus = cases[0].body, Relaxation(2.0, (3.0,), (1.0,), 0.4)
    moving: Any = SimpleNamespace(body=body, velocity=np.array([0.0, 0.6]))
    bouncer = WaveBouncer(moving, cast("Any", SimpleNamespace(contact_modulus=modulus)), numerics)
    chosen = bouncer._choices
    assert chosen.enforced.penalty == pytest.approx(100.0 * (2.0 + 3.0 + 0.4 / (0.125 * 4e-3)) / 2e-3)
    assert chosen.step * 2 ** len(chosen.doubled) == pytest.approx(4e-3 / steps)
    assert chosen.doubled[0] / 2.0 < 0.125 * 4e-3 < chosen.doubled[0] or not chosen.doubled
    assert np.diff(np.log2(chosen.doubled)) == pytest.approx(np.ones(len(chosen.doubled) - 1))
    assert chosen.doubled[-1] == pytest.approx(EARLY_PEAK * 4e-3)
    assert (bouncer.flights._step, bouncer.flights._patience) == (chosen.step, patience)
    assert 5.0 * 4e-3 < bouncer._longest < 50.0 * 4e-3
    assert bouncer._moment.state.velocity == pytest.approx([0.0, 0.6])
    assert bouncer._moment.energies == account_at_start(body, bouncer._moment.state)
    assert bouncer._steps == 0
    late = choices_of(cast("Any", SimpleNamespace(contact_modulus=modulus)), numerics.varied(peak_share=0.5))
    assert (late.step, late.doubled) == (4e-3 / steps, ())


class Clocked(Flights):
    """Flights of which the clock alone is told: surfaces meet from ``touch``, s, on."""

    def __init__(self, touch: float, patience: int) -> None:
        steppers: Any = SimpleNamespace(body=SimpleNamespace(size=1), of=lambda scheme, step: step)
        super().__init__(steppers, 1.0, patience)
        self.touch, self.lengths = touch, list[float]()

    def _flown(self, moment: Any, stepper: Any) -> Any:
        self.steps += 1
        self.lengths.append(stepper)
        assert stepper <= 1.0 + moment.state.time / self._patience, "no longer than a share of the flight so far"
        time = moment.state.time + stepper
        return SimpleNamespace(time=time, signed_pressure=np.array([1.0 if time >= self.touch else -1.0]))

    def _touched(self, moment: Any) -> Any:
        return moment


@pytest.mark.parametrize("flight", [3.5, 40.5, 1000.5, 54321.5])
@pytest.mark.parametrize("patience", [2, 5])
def test_steps_of_a_flight_double_and_shrink_until_the_touch_is_within_the_shortest(
    monkeypatch: pytest.MonkeyPatch, flight: float, patience: int
) -> None:
    monkeypatch.setattr(impact, "_entered", lambda moment, stepper, state: SimpleNamespace(state=state))
    flights = Clocked(flight, patience)
    still: Any = SimpleNamespace(state=SimpleNamespace(time=0.0))
    found = flights.landing(still, math.inf)
    assert found is not None
    assert flight - 1.0 < found.state.time < flight
    assert flights.steps < (patience + 3.0) * (math.log2(1.0 + flight / patience) + 2.0)
    assert min(flights.lengths) == 1.0


@pytest.mark.parametrize("patience", [2, 5])
@pytest.mark.parametrize("flight", [0.5, 1.5, 9.5, 60.5, 777.5])
def test_a_flight_takes_as_many_steps_of_each_length_as_it_waits_and_then_halves_them(
    monkeypatch: pytest.MonkeyPatch, flight: float, patience: int
) -> None:
    """Doubled after so many each, until one would meet the surface; then the binary digits of what is left."""
    monkeypatch.setattr(impact, "_entered", lambda moment, stepper, state: SimpleNamespace(state=state))
    flights = Clocked(flight, patience)
    still: Any = SimpleNamespace(state=SimpleNamespace(time=0.0))
    assert flights.landing(still, math.inf) is not None
    growing, time = list[float](), 0.0
    while time + (length := 2.0 ** (len(growing) // patience)) < flight:
        growing.append(length)
        time += length
    left, halving = flight - time, [length]
    while length > 1.0:
        length *= 0.5
        halving += [length] * (1 + int(left // length))  # the last of them would meet the surface
        left %= length
    assert flights.lengths == growing + halving
    assert flights.landing(still, 0.0) is None


@pytest.mark.parametrize("size", [1, 4])
def test_flights_end_with_the_work_that_one_march_may_be(monkeypatch: pytest.MonkeyPatch, size: int) -> None:
    """Steps times unknowns: of a body four times as large a quarter of the steps."""
    monkeypatch.setattr(impact, "MOST_WORK", 12.0)
    steppers: Any = SimpleNamespace(body=SimpleNamespace(size=size))
    flights, counted = Flights(steppers, 1.0, 2), list[float]()
    flights._counted = counted.append
    stepper: Any = object.__new__(ImplicitStepper)
    monkeypatch.setattr(ImplicitStepper, "flown", lambda self, state: "a step later")
    moment: Any = SimpleNamespace(state=SimpleNamespace(time=0.5))
    for _ in range(12 // size):
        assert flights._flown(moment, stepper) == "a step later"
    with pytest.raises(TooManySteps):
        flights._flown(moment, stepper)
    assert flights.steps == 12 // size
    assert counted == [1.0] * (12 // size)


@pytest.mark.parametrize(
    ("force", "velocity", "closing", "gone"),
    [
        (0.0, -0.3, [-0.5, 0.9], True),  # it moves back, whatever the surface does elsewhere
        (-1e-9, -0.3, [0.9, 0.9], True),
        (1e-9, -0.3, [-0.5, -0.9], False),  # something presses
        (0.0, 0.3, [-0.05, -0.9], True),  # the surface moves on everywhere
        (0.0, 0.3, [0.05, -0.9], False),  # not everywhere
        (0.0, 0.0, [0.0, -0.9], False),
    ],
)
def test_a_striker_has_left_where_nothing_presses_and_it_moves_back_or_the_surface_moves_on(
    force: float, velocity: float, closing: list[float], gone: bool
) -> None:
    none, energies = np.zeros(1), Energies(*8 * [0.0])
    rates = np.array(closing)
    sample = Sample(1.0, force, force, none, rates, none, none, np.array([velocity, 5.0]), energies, 1)
    assert impact.left(sample) == gone
    assert impact.left(sample, 0.04) == gone
    assert not impact.left(sample, 0.4)


def bounced(mass: float, velocity: float, gravity: float, step: float) -> tuple[Motion, float]:
    """A mass that meets a spring of one, in equal steps up to the first after it has left, and when it does, s."""
    pace = math.sqrt(1.0 / mass)
    rest, speed = gravity / pace**2, velocity / pace

    def depth(time: float) -> float:
        return rest * (1.0 - math.cos(pace * time)) + speed * math.sin(pace * time)

    def rate(time: float) -> float:
        return velocity * math.cos(pace * time) + gravity / pace * math.sin(pace * time)

    end = (math.pi + 2.0 * math.atan(rest / speed)) / pace

    def at(time: float) -> Sample:
        flown = max(time - end, 0.0)
        deep = depth(time) if not flown else rate(end) * flown + 0.5 * gravity * flown**2
        fast = rate(min(time, end)) + gravity * flown
        force, here = max(deep, 0.0), np.array([deep])
        energies = Energies(
            0.5 * mass * velocity**2 + mass * gravity * deep, 0.5 * mass * fast**2, 0.0, 0.5 * force**2, *4 * [0.0]
        )
        signed = np.array([-1.0, deep, deep, -1.0])
        return Sample(time, force, force * step, here, np.array([fast]), signed, here, np.array([fast]), energies, 1)

    samples = tuple(at(step * n) for n in range(math.ceil(end / step) + 1))
    return Motion(samples, HARD, 1), end


def test_a_striker_that_leaves_between_two_steps_has_left_where_and_as_fast_as_it_did() -> None:
    """A mass on a spring, under gravity: all that it has is its motion again, and its path ends at the surface."""
    mass, velocity, gravity, step = 2.0, 0.7, 0.2, 0.1
    found, end = bounced(mass, velocity, gravity, step)
    assert found.time[-1] - end > 0.3 * step
    scene: Any = SimpleNamespace(
        profile=SimpleNamespace(exponent_of_force=1.0), reduced_mass=mass, velocity=velocity, gravity=gravity
    )
    moving: Any = SimpleNamespace(endless=False, places=np.array([-2.0, -1.0, 1.0, 2.0]))
    march = impact.record(moving, found, scene)
    assert march.separated
    assert march.time[-1] == pytest.approx(end, rel=1e-4)
    assert march.depth[-1] == pytest.approx(-velocity * (march.time[-1] - end), abs=1e-7)
    assert march.impulse[-1] == pytest.approx(mass * (2.0 * velocity + gravity * end), rel=1e-3)
    energy = march.energy
    assert energy["out"] == pytest.approx(0.5 * mass * velocity**2 + mass * gravity * march.depth[-1])
    assert energy["in"] == pytest.approx(energy["out"])
    rest = {name: value for name, value in energy.items() if name not in ("in", "out")}
    assert np.array(list(rest.values())) == pytest.approx(0.0, abs=1e-12)


def test_a_striker_that_still_presses_at_the_end_is_told_up_to_there() -> None:
    """Row for row: depths, the momentum that the force took, half widths where it presses, and how many problems."""
    mass, velocity, gravity, step = 2.0, 0.7, 0.2, 0.1
    whole, _ = bounced(mass, velocity, gravity, step)
    found = Motion(whole.samples[:12], whole.final, 1)
    scene: Any = SimpleNamespace(
        profile=SimpleNamespace(exponent_of_force=1.0), reduced_mass=mass, velocity=velocity, gravity=gravity
    )
    moving: Any = SimpleNamespace(endless=False, places=np.array([-2.0, -1.0, 1.0, 2.0]))
    march = impact.record(moving, found, scene)
    assert not march.separated
    assert march.end_spread == march.first_force == 0.0
    assert march.time == pytest.approx(step * np.arange(12))
    assert march.depth == pytest.approx([float(sample.displacement[0]) for sample in found.samples])
    speed = np.array([float(sample.velocity[0]) for sample in found.samples])
    assert march.impulse == pytest.approx(mass * (velocity - speed) + mass * gravity * march.time)
    assert march.radius_time == pytest.approx(march.time[1:]), "at touch nothing presses yet"
    assert march.work == (11, 11, 12)


def test_a_contact_is_as_wide_as_pressures_change_their_sign_and_none_may_leave_the_fine_mesh() -> None:
    found, _ = bounced(2.0, 0.7, 0.0, 0.1)
    places = np.array([0.1, 0.2, 0.3, 0.4])
    moving: Any = SimpleNamespace(places=places)
    sample = found.samples[5]._replace(signed_pressure=(0.26 - places) * 3.0)
    assert impact._radius(moving, sample) == pytest.approx(0.26, abs=0.02)
    with pytest.raises(MemoryTooSmall, match=r"0\.4"):
        impact._radius(moving, sample._replace(signed_pressure=(0.46 - places) * 3.0))


@dataclass(frozen=True)
class Thrown:
    """What a contact asks of a scene."""

    reduced_mass: float
    velocity: float
    gravity: float
    profile: Any
    motion: Any


@pytest.mark.parametrize("impacts", [1, 2])
@pytest.mark.parametrize("ends", [12, 40])
@pytest.mark.parametrize("longest", [8, 100])
def test_one_of_several_contacts_that_swings_for_long_is_given_up_and_any_other_told_by_its_own_clock(
    monkeypatch: pytest.MonkeyPatch, impacts: int, ends: int, longest: int
) -> None:
    """A mass on a spring that leaves after some thirty steps: a lone contact may take all the time that there is."""
    mass, velocity, gravity, step, touched = 2.0, 0.7, 0.2, 0.15, 1.5
    whole, _ = bounced(mass, velocity, gravity, step)
    given = list[float]()

    def onwards(steppers: Any, moment: Any, choices: Any, until: float, watch: Any, ending: Any) -> Motion:
        given.append(until)
        samples = tuple(one._replace(time=one.time + touched) for one in whole.samples if one.time <= until + 1e-9)
        assert [ending(one) for one in samples] == [impact.left(one) for one in samples]
        final: Any = SimpleNamespace(time=samples[-1].time, flowed=None)
        return Motion(samples, final, 1)

    monkeypatch.setattr(impact, "onwards", onwards)
    bouncer, counted = object.__new__(WaveBouncer), list[float]()
    profile, nothing = SimpleNamespace(exponent_of_force=1.0), cast("Any", None)
    bouncer._scene = cast("Any", Thrown(mass, 99.0, gravity, profile, SimpleNamespace(impacts=impacts)))
    bouncer._moving = cast("Any", SimpleNamespace(endless=False, places=np.array([-2.0, -1.0, 1.0, 2.0]), watch=None))
    bouncer._counted, bouncer._longest, bouncer._steps = counted.append, longest * step, 70
    bouncer._choices = bouncer.steppers = bouncer._moment = nothing
    strike: Any = SimpleNamespace(velocity=velocity, touched_at=touched, end_time=ends * step)
    several_for_long = impacts > 1 and longest < min(ends, len(whole.samples) - 1)
    if several_for_long:
        with pytest.raises(TooManySteps):
            bouncer.contact(strike)
        assert given == [longest * step]
        return
    march = bouncer.contact(strike)
    assert given == [pytest.approx(step * (min(longest, ends) if impacts > 1 else ends))]
    steps = min(ends, len(whole.samples) - 1)
    assert march.separated == (ends > steps)
    assert march.time[:-1] == pytest.approx(step * np.arange(steps), abs=1e-12)
    assert march.impulse[0] == pytest.approx(0.0, abs=1e-12), "it came as fast as the strike says"
    assert len(counted) == steps + 1
    assert bouncer._steps == 70 + steps
    assert bouncer._moment.state.time == pytest.approx(touched + steps * step)
    assert bouncer._moment.energies == whole.samples[steps].energies


def test_energy_at_the_end_is_what_goes_in_less_what_is_told_and_nothing_is_radiated_that_no_wave_takes() -> None:
    """Of 2 J: what a mass of 3 kg at 0.5 m/s has, what else moves and is strained, heat, and what is lost."""
    here, none = np.array([-0.5]), np.zeros(1)
    held = Energies(2.0, 0.4, 0.03, 0.2, 0.01, 0.05, 0.1, 0.002)
    last = Sample(1.0, 0.0, 0.0, none, here, none, none, here, held, 1)
    first = last._replace(velocity=np.array([7.0]), energies=Energies(*8 * [9.0]))
    found = Motion((first, last), HARD, 1)
    lost = {name: getattr(held, name) for name in ("viscous", "radiated", "contact", "numerical")}
    out = 0.5 * 3.0 * 0.5**2
    stored = held.rigid + held.deformable + held.strain - out
    residual = held.work - out - stored - sum(lost.values())
    assert impact.account(found, 3.0) == pytest.approx(
        {"in": 2.0, "out": out, "stored": stored, "residual": residual} | lost
    )


@pytest.mark.parametrize("endless", [True, False])
@pytest.mark.parametrize("elastic", [True, False])
@pytest.mark.parametrize("gone", [True, False])
def test_what_moves_in_an_endless_body_is_radiated_and_its_strain_with_it_once_nothing_else_can_take_it(
    endless: bool, elastic: bool, gone: bool
) -> None:
    """Neither while the striker presses, nor where it still relaxes: of what has left since the touch half is strain.

    A striker that yields keeps what it holds.
    """
    mass, out, swinging, springs, moving_on, strained = 2.0, 0.81, 0.07, 0.03, 0.4, 0.2
    held = Energies(2.0, out, swinging + moving_on, springs + strained, 0.01, 0.05, 0.1, 0.002)
    here, none = np.array([-0.9 if gone else 0.9]), np.zeros(1)
    last = Sample(1.0, 0.0 if gone else 3.0, 0.0, none, -here, none, none, here, held, 1)
    body: Any = SimpleNamespace(endless=endless, in_striker=lambda state: (out + swinging, springs))
    found = Motion((last._replace(energies=held._replace(radiated=0.04)), last), HARD, 1)
    material = SimpleNamespace(young=SimpleNamespace(is_elastic=elastic))
    scene: Any = SimpleNamespace(reduced_mass=mass, geometry=SimpleNamespace(material=material))
    energy = impact.energies(body, found, scene)
    lost = (moving_on + (strained if elastic and gone else -0.5 * (0.1 - 0.04))) if endless else 0.0
    assert energy["radiated"] == pytest.approx(0.1 + lost)
    assert energy["stored"] == pytest.approx(swinging + springs + moving_on + strained - lost)
    assert energy["out"] == pytest.approx(out)
    assert energy["residual"] == pytest.approx(held.residual)
