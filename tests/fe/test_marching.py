"""The loop of a march on a spring, whose steps are made up: how it ends, what it tries again, and what it counts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import BarycentricInterpolator

from fe_contact.errors import ContactLost, ContactNotSettled, TooManySteps
from fe_contact.march.impact import STEPS_ALLOWED, _Marcher, growth, marched, step_length
from fe_contact.schemes.base import SCHEMES
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import Inertia, State, Step, Strike, Work
from lumped.materials import Relaxation

MASS, STIFFNESS, VELOCITY = 2.0, 8.0, 0.3
PACE = (STIFFNESS / MASS) ** 0.5
CONTACT = np.pi / PACE
Build = Callable[..., Any]


class Spring:
    """Steps of a mass on a spring; ``fails``: what they raise, by the state they lead to and their length."""

    shortest, first_force = 3e-4, 0.25

    def __init__(self, strike: Strike, numerics: Numerics, scheme: str, fails: Callable[[State, float], None]) -> None:
        self.strike, self.numerics, self.scheme, self.fails = strike, numerics, SCHEMES.get(scheme), fails
        self.tried = list[float]()

    def touch(self) -> State:
        memory: Any = self.strike.depth  # all that it knows
        return State(0.0, self.strike.depth, self.strike.velocity, 0.0, memory)

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        self.tried.append(length)
        inertia = Inertia.of(self.strike, self.scheme, state, length)
        share = self.scheme.sample
        sampled = (1.0 - share) * state.depth + share * inertia.free_depth
        force = STIFFNESS * sampled / (1.0 + share * STIFFNESS * inertia.give)
        memory: Any = inertia.depth(force)
        after, nothing = inertia.moved(force, memory), None
        self.fails(after, length)
        found_at = state.time + length
        made_up: Any = (length, after, force, 1.0 + after.time, found_at, force, nothing, 1.0, Work(1, 2, 3))
        return Step(*made_up)

    def snapshots(self, steps: Sequence[Step]) -> Any:
        return tuple(step.state.memory for step in steps)

    def stored(self, memory: Any) -> float:
        return float(0.5 * STIFFNESS * memory**2)

    def heat_and_loss(self, before: Any, after: Any, length: float) -> tuple[float, float]:
        return 0.0, 0.0

    def between(self, before: State, step: Step) -> float:
        """What a force that belongs elsewhere in the step does beside the spring's own."""
        return step.force * (step.state.depth - before.depth) - (
            self.stored(step.state.memory) - self.stored(before.memory)
        )


@pytest.fixture
def spring(settings_of: Callable[..., Numerics], hertz_strike: Callable[..., Strike]) -> Build:
    def build(
        steps: int = 200,
        gravity: float = 0.0,
        end: float = 1e3,
        scheme: str = "galerkin",
        fails: Callable[[State, float], None] = lambda after, length: None,
        depth: float = 0.0,
        **given: Any,
    ) -> Spring:
        strike = Strike(lambda r: r**2, MASS, VELOCITY, gravity, Relaxation(1.0), end, depth=depth)
        numerics = settings_of(hertz_strike(), steps=steps).varied(contact_time=CONTACT, peak_share=0.5, **given)
        return Spring(strike, numerics, scheme, fails)

    return build


def lost(after: State, length: float) -> None:
    if after.depth <= 0.0:
        raise ContactLost(after.time)


@pytest.mark.parametrize("scheme", SCHEMES.names)
def test_a_mass_leaves_a_spring_after_half_a_swing_with_all_that_it_came_with(spring: Build, scheme: str) -> None:
    """Contact is lost in no step of finite length: the end is read from the trend, and told to be read so well."""
    off = list[np.ndarray]()
    for steps in (100, 200):
        stepper = spring(steps, scheme=scheme, fails=lost)
        march = marched(stepper)
        assert march.separated
        assert march.first_force == 0.25
        assert march.depth[-1] == pytest.approx(0.0, abs=2e-3 * VELOCITY / PACE)
        assert march.end_spread < 1e-3 * CONTACT
        assert march.time[-1] - march.time[-2] < 3e-4 * CONTACT
        taken = len(march.radius)
        assert march.work == (taken, 2 * taken, 3 * taken)
        assert march.radius == pytest.approx(1.0 + march.time[1 : taken + 1]), "one a step, and none after the last"
        assert march.memory_time == march.time[taken]
        energy = march.energy
        assert energy["in"] == pytest.approx(0.5 * MASS * VELOCITY**2)
        assert energy["stored"] == pytest.approx(0.5 * STIFFNESS * march.depth[taken] ** 2)
        assert energy["viscous"] == energy["radiated"] == 0.0
        assert energy["residual"] == pytest.approx(0.0, abs=1e-12), "step for step it is all accounted for"
        assert march.snapshots[-1] == pytest.approx(march.depth[taken])
        off.append(np.abs([march.time[-1] / CONTACT - 1.0, march.impulse[-1] / (2.0 * MASS * VELOCITY) - 1.0]))
    order = SCHEMES.get(scheme).order
    assert np.all(off[1] < 0.7 * off[0] if order == 1 else off[1] < 0.4 * off[0] + 1e-6)
    assert off[1].max() < (0.1 if order == 1 else 1e-3)


def unsettled(time: float) -> ContactNotSettled:
    return ContactNotSettled(time, "a lower numerics.penalty")


def after(cut: float, failure: Callable[[float], Exception]) -> Callable[[State, float], None]:
    """Every step past a time fails so."""

    def fails(then: State, length: float) -> None:
        if then.time > cut:
            raise failure(then.time)

    return fails


def test_contact_that_is_lost_is_looked_for_in_halves_of_a_step_until_they_are_too_short(spring: Build) -> None:
    """Where no trend tells of it, as soon after the peak of its force; the little that is left of it is flown."""
    cut = 0.51 * CONTACT
    stepper = spring(fails=after(cut, ContactLost))
    march = marched(stepper)
    assert march.separated
    shortest, last = 3e-4 * CONTACT, march.time[len(march.radius)]
    assert last <= cut < last + 2.0 * shortest
    assert march.time[-1] - last == pytest.approx(shortest, rel=1e-9) or march.time[-1] == last
    assert 0.5 * stepper.tried[-1] < shortest <= stepper.tried[-1]
    assert stepper.tried[-2] == 2.0 * stepper.tried[-1]


@pytest.mark.parametrize("share", [0.5, 1e-3])
def test_a_step_that_does_not_settle_while_much_presses_is_a_failure(spring: Build, share: float) -> None:
    with pytest.raises(ContactNotSettled):
        marched(spring(fails=after(CONTACT * (1.0 - share / np.pi), unsettled)))


def test_one_that_does_not_settle_where_hardly_anything_presses_any_more_is_the_end_and_told_less_sharply(
    spring: Build,
) -> None:
    """By what the trend says is left: a force of a ten thousandth of its peak may drown in what the mesh errs by."""
    exact = spring(fails=lost)
    exact.shortest = 1e-9
    end = marched(exact).time[-1]
    unseen = 2e-6 / np.pi * end
    stepper = spring(fails=after(end - unseen, unsettled))
    stepper.shortest = 1e-9
    blunt = marched(stepper)
    assert blunt.separated
    assert blunt.time[-1] == pytest.approx(end, abs=unseen)
    assert unseen < blunt.end_spread < 10.0 * unseen


def test_a_first_step_that_leads_to_less_than_a_mesh_can_see_is_made_longer_but_no_longer_than_a_mean_one(
    spring: Build,
) -> None:
    def unseen(deep: float) -> Callable[[State, float], None]:
        def fails(then: State, length: float) -> None:
            if then.velocity > 0.0 and then.depth < deep:
                raise ContactLost(then.time)

        return fails

    first = CONTACT * step_length(0, 200, 0.5)
    stepper = spring(fails=unseen(3.0 * VELOCITY * first))
    march = marched(stepper)
    assert stepper.tried[:3] == pytest.approx([first, 2.0 * first, 4.0 * first])
    assert march.time[1] == pytest.approx(4.0 * first)
    stepper = spring(fails=unseen(1e9))
    with pytest.raises(ContactLost):
        marched(stepper)
    assert 1.0 <= max(stepper.tried) / (CONTACT / 200) < 2.0


def test_what_swings_on_its_weight_for_ever_takes_so_many_steps_and_none_too_long_to_see_it(spring: Build) -> None:
    """None longer than twice the mean one, which is about the longest of a contact."""
    stepper = spring(steps=16, gravity=9.81, depth=MASS * 9.81 / STIFFNESS)
    with pytest.raises(TooManySteps):
        marched(stepper)
    assert len(stepper.tried) == STEPS_ALLOWED * 16 + 1
    longest = max(stepper.tried) / (CONTACT / 16)
    usual = 16.0 * max(step_length(done, 16, 0.5) for done in range(16))
    assert longest == pytest.approx(usual, rel=0.5)
    assert longest <= 2.0 + 1e-12


@pytest.mark.parametrize("calm", [0.9, 1.1])
def test_a_striker_that_has_settled_under_its_weight_is_followed_by_ever_longer_steps(
    spring: Build, calm: float
) -> None:
    """Once force and velocity swing by less than three tenths of the tolerance of the weight, together."""
    stepper = spring(steps=16, gravity=5.0, tolerance=1e-2)
    marcher = _Marcher(stepper, lambda done: None)
    swing = 0.3 * 1e-2 * 5.0 * calm
    state: Any = State(9.0, 0.0, -0.5 * swing * CONTACT, 0.0, None)
    last: Any = Step(0.4, state, MASS * (5.0 - 0.5 * swing), *6 * [0.0])
    expected = growth(16) * 0.4 if calm < 1.0 else 0.0
    assert marcher._longest(last) == pytest.approx(max(expected, 2.0 * CONTACT / 16))


def test_what_is_left_of_a_contact_is_flown_freely(spring: Build) -> None:
    marcher = _Marcher(spring(gravity=5.0), lambda done: None)
    state: Any = State(2.0, 0.1, -0.7, 3.0, None)
    (parted,) = marcher._flight(state, 0.01)
    assert parted[:4] == pytest.approx((2.01, 0.1 - 0.7 * 0.01 + 2.5 * 0.01**2, -0.65, 3.0))
    assert marcher._flight(state, 0.0) == []


def test_a_striker_that_a_fluid_has_stopped_stands_until_the_end(spring: Build) -> None:
    marcher = _Marcher(spring(end=9.0), lambda done: None)
    stopped: Any = State(1.0, 0.1, 1e-5, 3.0, None)
    rows = marcher._rest(stopped)
    assert rows[-1].time == pytest.approx(9.0)
    times = np.array([1.0, *(row.time for row in rows)])
    assert np.ptp(times[1:] / times[:-1]) < 1e-9
    assert all(row[1:] == stopped[1:] for row in rows)
    six = times[:6]
    between = np.linspace(six[0], six[-1], 101)
    off = np.abs(BarycentricInterpolator(six**0.5, 1.0 / six)(between**0.5) * between - 1.0)
    assert off.max() < 1e-6, "six of them tell 1/t"
    assert 9.0 ** (0.5 / len(rows)) <= 1.03 < 9.0 ** (0.5 / (len(rows) - 1)), "and there are no more of them"


def test_one_that_still_goes_deeper_has_not_left_and_steps_help_no_penalty(spring: Build) -> None:
    with pytest.raises(ContactLost) as lost:
        marched(spring(fails=after(0.3 * CONTACT, ContactLost)))
    assert lost.value.cure == "raise numerics.steps"


def test_an_end_time_cuts_a_contact_off_in_its_last_step(spring: Build) -> None:
    march = marched(spring(end=0.3 * CONTACT))
    assert not march.separated
    assert march.time[-1] == 0.3 * CONTACT
    assert march.end_spread == 0.0
    assert march.depth[-1] == pytest.approx(VELOCITY / PACE * np.sin(0.3 * np.pi), rel=1e-4)
    assert march.energy["stored"] == pytest.approx(0.5 * STIFFNESS * march.depth[-1] ** 2)
    assert march.energy["residual"] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("scheme", SCHEMES.names)
@pytest.mark.parametrize("end", [0.3, 0.6])
def test_weight_and_what_is_held_at_touch_are_in_the_account(spring: Build, scheme: str, end: float) -> None:
    """A mass put on a spring that is pressed already: what it brings is its speed, its way under gravity and that."""
    gravity, before = 5.0, 0.2
    march = marched(spring(gravity=gravity, depth=before, end=end * CONTACT, scheme=scheme))
    assert not march.separated
    assert march.depth[0] == before
    energy, depth = march.energy, float(march.depth[-1])
    way, held = MASS * gravity * (depth - before), 0.5 * STIFFNESS * before**2
    assert energy["in"] == pytest.approx(0.5 * MASS * VELOCITY**2 + way + held)
    assert energy["stored"] == pytest.approx(0.5 * STIFFNESS * depth**2)
    speed = VELOCITY + gravity * march.time[-1] - march.impulse[-1] / MASS
    assert energy["out"] == pytest.approx(0.5 * MASS * speed**2)
    assert energy["residual"] == pytest.approx(0.0, abs=1e-12)
    rest = MASS * gravity / STIFFNESS
    swung = rest + (before - rest) * np.cos(end * np.pi) + VELOCITY / PACE * np.sin(end * np.pi)
    assert depth == pytest.approx(swung, rel=1e-3 if SCHEMES.get(scheme).order == 2 else 0.05)


@pytest.mark.parametrize("later", [False, True])
def test_a_trend_tells_the_end_only_of_a_mass_that_leaves_after_four_steps(spring: Build, later: bool) -> None:
    """By the last three places where the scheme reads what presses, which fall along a parabola; and by no kink."""
    stepper = spring()
    marcher = _Marcher(stepper, lambda done: None)
    ends, pressing = 7.0, 1.0 if later else 1e-4

    def step(time: float, velocity: float = -1.0) -> Any:
        read = time - 0.5 * 0.1
        state: Any = State(time, 0.0, velocity, 0.0, None)
        response = (ends - read) * (1.0 + 0.02 * (ends - read))
        made_up: Any = (0.1, state, pressing, 0.0, 0.0, response, None, 1.0, Work())
        return Step(*made_up)

    first: Any = step(1.0)._replace(force=1.0)
    steps = [first, *(step(time) for time in (6.2, 6.3, 6.4))]
    assert marcher._time_left(steps) == pytest.approx(0.6)
    assert marcher._time_left(steps[1:]) is None
    assert marcher._time_left([*steps[:3], step(6.4, velocity=0.1)]) is None
    marcher.shortest = 0.7
    found = marcher._time_left(steps)
    assert found is None if later else found == pytest.approx(0.6), "a kink: contact ends faintly"
