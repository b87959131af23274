"""Settings that err as theory says, made up: their entries in the budget cover that, alone, and by not much more."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.special import beta, betainc

from fe_contact import relaxing_impact
from fe_contact.budget import certify
from fe_contact.budget.budget import CAUSES, SETTING, Budget
from fe_contact.budget.curve import Curve
from fe_contact.budget.variation import Variation
from fe_contact.relaxing_impact import RelaxingStrikes
from fe_contact.settings import Numerics, WaveNumerics
from fe_contact.steppers.steps import March, Strike, Work
from fe_contact.waves import certify as waves
from lumped.materials import Relaxation

QUANTITIES = ("peak_force", "peak_depth", "impulse", "restitution")
STRIKE = Strike(lambda r: r**2, 1.0, 0.3, 0.0, Relaxation(1.0), 10.0)
STEPS, ERROR, HIGHER_ORDER = 160, 1e-3, 0.45
# By element order: linear ones that lock gain little; the edge, where the pressure is a root, limits the others.
FALLS_WITH_ELEMENTS = {1: 0.5, 2: 1.0, 3: 1.0, 4: 2.0}

Settings = Callable[..., Numerics]


def march(steps: int, error: float) -> March:
    """A force about [4 t (1 - t)]^(3/2), off by a share of its mean since touch, as is the depth."""
    time = np.linspace(0.0, 1.0, steps + 1) ** 2
    off = 1.0 + error * time * (1.5 + np.cos(2.0 * time))
    return March(
        time=time,
        depth=time * (0.3 - 0.2945 * time) * off,
        impulse=8.0 * beta(2.5, 2.5) * betainc(2.5, 2.5, time) * off,
        radius_time=time[1:-1],
        radius=np.sqrt(time[1:-1] * (1.0 - time[1:-1])),
        separated=True,
        photograph=tuple,
        energy=dict.fromkeys(("in", "out", "stored", "viscous", "contact", "numerical", "residual"), 0.0),
        first_force=0.0,
        end_spread=0.0,
        work=Work(),
    )


def off(found: Curve) -> dict[str, float]:
    true = Curve.of(march(STEPS, 0.0), STRIKE).quantities
    return {name: abs(found.quantities[name] - true[name]) for name in QUANTITIES}


def marched(cause: str, power: float, base: Numerics) -> Callable[[Any], March]:
    """What settings answer of which one errs, as a power of it, and all others are perfect.

    Elements of a higher order leave a little less than half of it.
    """
    key = SETTING[cause]

    def answer(settings: Any) -> March:
        left = HIGHER_ORDER if settings.order > base.order else 1.0
        return march(settings.steps, left * ERROR * (getattr(base, key) / getattr(settings, key)) ** power)

    return answer


@pytest.fixture
def settings(hertz_strike: Callable[..., Strike], settings_of: Settings) -> Numerics:
    return settings_of(hertz_strike(), steps=STEPS)


CASES = [
    *(("mesh", power, order, True) for order, power in FALLS_WITH_ELEMENTS.items()),
    ("mesh", 1.5, 4, False),  # the edge anywhere in an element
    ("penalty", 1.0, 4, True),
    ("far_field", 2.0, 4, True),
]


@pytest.mark.parametrize(("cause", "power", "order", "follows_contact"), CASES)
@pytest.mark.parametrize("coarse", [False, True])
def test_an_entry_covers_its_own_setting(
    cause: str, power: float, order: int, follows_contact: bool, coarse: bool, settings: Numerics
) -> None:
    """Of few elements, a soft penalty, a near boundary the finer neighbour tells, else the coarser one."""
    few = {"elements_per_contact": 1.5, "penalty": 10.0, "far_radius": 3.0}
    base = settings.varied(order=order, **(few if coarse else {}))
    answer = marched(cause, power, base)
    runs: Any = SimpleNamespace(
        curve=lambda number, given: Curve.of(answer(given), STRIKE),
        surface=lambda given: SimpleNamespace(follows_contact=follows_contact),
    )
    curve, changes = certify._judged(runs, runs.curve, 0, base, alone=False)
    nothing: Any = None
    found, errors = Budget(curve, nothing, changes, nothing, nothing), off(curve)
    for name in QUANTITIES:
        assert errors[name] <= found.error(name, cause), name
        assert found.error(name, cause) < 3.0 * errors[name], name
        assert all(found.error(name, other) < 0.2 * errors[name] for other in CAUSES if other != cause), name


@pytest.mark.parametrize(("cause", "power"), [("mesh", 1.0), ("penalty", 1.0), ("time_step", 1.0), ("far_field", 2.0)])
def test_an_entry_covers_its_own_setting_where_there_are_waves(cause: str, power: float, settings: Numerics) -> None:
    """Contact that begins and ends point by point leaves half of an error where there is half of a setting."""
    fine = {"elements_per_contact": 12.0, "steps": 640, "tolerance": 1e-4}
    base = WaveNumerics(**{**settings.as_dict(), **fine}, rho=0.5, mass="consistent")
    answer, asked = marched(cause, power, base), list[WaveNumerics]()

    def curve(number: int, given: WaveNumerics) -> Curve:
        asked.append(given)
        return Curve.of(answer(given), STRIKE)

    contact = SimpleNamespace(march=answer(base), strike=STRIKE)
    followed = SimpleNamespace(contacts=[contact])
    runs: Any = SimpleNamespace(curve=curve, cheap=320, rings=False, follow=lambda given: followed, work=lambda: None)
    found = waves.certify(runs, base)
    errors = off(curve(0, base))
    for name in QUANTITIES:
        assert errors[name] <= found.error(name, cause), name
        assert found.error(name, cause) < 3.0 * errors[name], name
    nearer = [given.elements_per_contact for given in asked if given.far_radius < base.far_radius]
    assert nearer == [min(given.elements_per_contact for given in asked)], "told by the cheaper mesh, once"


RELAXING = [("mesh", 1.5), ("penalty", 1.0), ("time_step", 3.0), ("far_field", 2.0)]


@pytest.mark.parametrize(("cause", "power"), RELAXING)
def test_an_entry_covers_its_own_setting_of_a_body_strained_much_that_relaxes(
    cause: str, power: float, settings: Numerics, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And the square of the step is extrapolated away, but for a logarithm beside it, which leaves it as it was."""
    nothing: Any = None

    def certified(answer: Callable[[Any], March]) -> Budget:
        monkeypatch.setattr(RelaxingStrikes, "_run", lambda self, given: answer(given))
        return RelaxingStrikes(nothing, nothing, nothing).certified(settings)

    monkeypatch.setattr(relaxing_impact, "Strike", SimpleNamespace(of=lambda scene: STRIKE))
    solid = SimpleNamespace(solid=SimpleNamespace(unknowns=1, mesh_order=1.5))
    monkeypatch.setattr(relaxing_impact, "Marcher", SimpleNamespace(of=lambda scene, given: solid))
    found = certified(marched(cause, power, settings))
    errors = off(found.curve)
    for name in QUANTITIES:
        assert errors[name] <= found.error(name, cause) < 4.0 * errors[name], name
        assert all(found.error(name, other) < 0.2 * errors[name] for other in CAUSES if other != cause), name
    left = off(certified(marched("time_step", 2.0, settings)).curve)
    assert max(left.values()) < 1e-2 * ERROR
    found = certified(lambda given: march(given.steps, ERROR * (STEPS / given.steps) ** 2 * math.log(given.steps)))
    for name, error in off(found.curve).items():
        assert error <= found.error(name, "time_step") < 2.0 * error, name


@pytest.mark.parametrize(
    ("separated", "gravity", "finer_mesh"), [(False, 0.05, False), (False, 0.0, True), (True, 0.05, True)]
)
def test_a_jitter_that_no_step_lessens_asks_for_a_finer_mesh_but_of_what_swings(
    separated: bool, gravity: float, finer_mesh: bool, settings: Numerics
) -> None:
    """What a weight swings for long lies between few steps, whatever the mesh."""
    rng, strike = np.random.default_rng(13), replace(STRIKE, gravity=gravity)
    noise = {STEPS // part: 1.0 + 1e-3 * rng.normal(size=STEPS // part + 1) for part in (1, 2, 4)}

    def curve(number: int, given: Any) -> Curve:
        found = march(given.steps, 0.0)
        jittering = replace(found, impulse=found.impulse * noise[given.steps], separated=separated)
        return Curve.of(jittering, strike)

    runs: Any = SimpleNamespace(curve=curve, surface=lambda given: SimpleNamespace(follows_contact=True))
    value, changes = certify._judged(runs, runs.curve, 0, settings, alone=False)
    nothing: Any = None
    found = Budget(value, nothing, changes, nothing, nothing)
    assert (found.error("impulse", "mesh") > 0.0) == finer_mesh, "two meshes jitter alike here"
    assert found.total("impulse") > Variation(value, value.thinned(), 1.0).errors["impulse"]


@pytest.mark.parametrize("steps", [20, 160])
def test_the_squared_radius_is_known_between_the_steps_up_to_both_ends(steps: int) -> None:
    """Linear beyond the last step, 2/steps long: off by its square times an eighth of the bend there."""
    times = np.linspace(0.0, 1.0, 501)
    found = Curve.of(march(steps, 0.0), STRIKE).radius_at(times) ** 2
    np.testing.assert_allclose(found, times * (1.0 - times), atol=1.1 / steps**2)


def test_chatter_at_the_end_moves_the_end_and_not_the_speed_after_it() -> None:
    """Two marches of one motion, which part a hundredth of the contact apart: what has parted presses no more."""
    early, by = march(STEPS, 0.0), 0.01
    away = -float(STRIKE.velocity - early.impulse[-1])
    later = replace(
        early,
        time=np.append(early.time, 1.0 + by),
        impulse=np.append(early.impulse, early.impulse[-1]),
        depth=np.append(early.depth, early.depth[-1] + by * away),
    )
    change = waves.Moved(Curve.of(early, STRIKE), Curve.of(later, STRIKE), 1.25)
    assert change.errors["duration"] >= by
    assert change.errors["impulse"] < 0.1 * by * float(early.impulse[-1])
    assert change.errors["restitution"] < 0.1 * by


@pytest.mark.parametrize("trusted", [0.4, 1.25, 2.5])
def test_an_end_that_longer_steps_move_errs_by_more_than_twice_that_whatever_is_trusted(trusted: float) -> None:
    """Two marches of one motion, of which the second takes a hundredth longer; all else is trusted as ever."""
    first, by = march(STEPS, 0.0), 0.01
    second = replace(first, time=first.time * (1.0 + by))
    curves = Curve.of(first, STRIKE), Curve.of(second, STRIKE)
    end, other = waves.EndMoved(*curves, trusted).errors, waves.Moved(*curves, trusted).errors
    assert 2.0 * by < end.pop("duration") < 3.0 * by
    assert other.pop("duration") == pytest.approx(trusted * by, rel=0.1)
    assert end == other


def test_two_lengths_of_step_that_agree_on_the_end_may_still_miss_half_a_step_of_it() -> None:
    curve, step = Curve.of(march(STEPS, 0.0), STRIKE), 0.01
    assert waves.EndMoved(curve, curve, 1.25).errors["duration"] == 0.0
    assert 0.5 * step < waves.EndMoved(curve, curve, 1.25, step=step).errors["duration"] < step


def pulsed(height: float) -> Curve:
    """The made-up force, of which a pulse from a far pole adds so much to the end of its fall; it ends when it did."""
    made = march(STEPS, 0.0)
    pulse = height * np.clip((made.time - 0.9) / 0.08, 0.0, 1.0) ** 2
    return Curve.of(replace(made, impulse=made.impulse + pulse), STRIKE)


@pytest.mark.parametrize("kind", [waves.Moved, waves.EndMoved])
def test_two_settings_that_agree_on_the_end_after_a_pulse_do_so_by_chance(kind: type[waves.Moved]) -> None:
    """Where a ball rings the end is known no better than when the force falls through a share of its peak."""
    first, second = pulsed(0.0), pulsed(0.002)
    fallen = []
    for curve in (first, second):
        time = np.linspace(0.9, 1.0, 10_001)
        force = curve.force(time)
        fallen.append(time[np.flatnonzero(force >= 0.05 * curve.dense_force.max())[-1]])
    apart = abs(fallen[1] - fallen[0])
    assert apart > 5e-3
    assert kind(first, second, 1.25).errors["duration"] < 0.5 * apart
    assert kind(first, second, 1.25, rings=True).errors["duration"] > apart


@pytest.mark.parametrize("trusted", [0.4, 1.25])
def test_what_waves_hold_of_motion_and_strain_near_the_end_of_the_mesh_is_trusted_with_no_order(trusted: float) -> None:
    """Two meshes that swap a hundredth of a joule: the finer may err by twice as much. Heat has the order it has."""
    first, by = Curve.of(march(STEPS, 0.0), STRIKE), 0.01
    second = replace(first, energy=first.energy | {"stored": by, "radiated": -by, "viscous": by})
    first = replace(first, energy=first.energy | {"radiated": 0.0})
    found = waves.FarMoved(first, second, trusted).energies
    assert 2.0 * by < found["stored"] == found["radiated"] < 3.0 * by
    assert found["viscous"] == pytest.approx(trusted * by)


@pytest.mark.parametrize("rings", [True, False])
def test_what_steps_take_of_the_motion_of_a_ball_may_be_what_it_rings_with(rings: bool) -> None:
    """Two lengths of step that damp all of its ringing alike, of which one takes a hundredth of a joule more."""
    first, taken = Curve.of(march(STEPS, 0.0), STRIKE), 0.01
    second = replace(first, energy=first.energy | {"numerical": taken, "out": -taken})
    change = waves.EndMoved(first, second, 1.25, rings=rings)
    assert change.energies["stored"] == pytest.approx(1.25 * taken if rings else 0.0)


def test_a_pulse_that_two_settings_miss_moves_the_peak_in_time_as_much_as_the_force_there() -> None:
    first, second = (Curve.of(march(STEPS, error), STRIKE) for error in (0.0, ERROR))
    alone, missed = (waves.Moved(first, second, 1.25, pulse=pulse) for pulse in (1.0, 3.0))
    peak = np.array([first.quantities["peak_time"]])
    assert missed.force(peak) == pytest.approx(3.0 * alone.force(peak))
    assert missed.errors == pytest.approx(alone.errors | {"peak_time": 3.0 * alone.errors["peak_time"]})


@pytest.mark.parametrize("fails", ["first", "second"])
def test_a_setting_whose_run_fails_tells_nothing(fails: str) -> None:
    known = Curve.of(march(STEPS, 0.0), STRIKE)
    runs = (None if one == fails else known for one in ("first", "second"))
    assert waves.Moved.between(*runs, 1.0) is None
