"""Contacts of the correspondence law that end at depth zero, or follow one another: against direct integration."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from lumped import BadInput, Model, Motion, Scene, laws, simulate
from lumped.laws import _force_law
from lumped.laws._assembly import values_of_several
from lumped.laws.correspondence import Correspondence
from lumped.result.history import End
from lumped.result.result import Result
from lumped.scene.tables import LawChoice
from lumped.solvers.point.bodies import Bodies, State
from lumped.solvers.point.contact import contact
from lumped.solvers.point.memory import RULES, HereditaryLoad, recovering, rule_of
from lumped.solvers.point.track import Outcome

Build = Callable[..., Scene]
Array = NDArray[np.float64]
SOLID = {"relaxed": 1.0, "moduli": (0.8,), "times": (0.3,), "profile": "parabola"}


def bouncing(impact: Build, impacts: int, gravity: float = 0.3, **solid: object) -> Scene:
    """A sphere that comes back: gravity in m/s2."""
    scene = impact(**{**SOLID, **solid}, gravity=gravity)
    return replace(scene, motion=Motion(impacts=impacts, end_time=1e3))


def followed(scene: Scene, rule: str, contacts: int) -> list[tuple[float, float, float, float]]:
    """Start, s, velocity at touch, end and velocity at the end of every contact, by scipy's DOP853."""
    modulus, curve = scene.contact_modulus, scene.profile.load_curve
    (branch,), (tau,) = modulus.moduli, modulus.times

    def load(depth: float) -> float:
        return float(curve.force(max(depth, 0.0)))

    def force(state: Array) -> float:
        return modulus.glassy * load(state[0]) - branch * float(state[2])

    def pressed(_: float, state: Array) -> list[float]:
        return [state[1], scene.gravity - force(state) / scene.mass, (load(state[0]) - state[2]) / tau]

    def apart(_: float, state: Array) -> list[float]:
        # a free surface stands where the branches just balance: E_glassy y = E_1 w
        standing = {"recovering": branch * state[2] / modulus.glassy, "continuous": load(state[0]), "reset": 0.0}[rule]
        return [state[1], scene.gravity, (standing - state[2]) / tau]

    def parts(_: float, state: Array) -> float:
        return force(state) if state[1] < 0.0 else 1.0

    def meets(_: float, state: Array) -> float:
        level = {"recovering": force(state), "continuous": force(state), "reset": float(state[0])}[rule]
        return level if state[1] > 0.0 else -1.0

    for event in (parts, meets):
        event.terminal = True  # type: ignore[attr-defined] - scipy reads it off the function
    parts.direction, meets.direction = -1, 1  # type: ignore[attr-defined]
    time, state, found = 0.0, np.array([0.0, scene.velocity, 0.0]), []
    # loads and memories are of the order 1e-8 m2: atol is far below them
    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-22}
    for _ in range(contacts):
        end = solve_ivp(pressed, (time, 1e3), state, events=parts, max_step=1e-3, **options)
        found.append((time, state[1], float(end.t[-1]), float(end.y[1, -1])))
        flight = solve_ivp(apart, (end.t[-1], 1e3), end.y[:, -1], events=meets, max_step=1e-2, **options)
        time, state = float(flight.t[-1]), flight.y[:, -1]
        state[2] *= 0.0 if rule == "reset" else 1.0
    return found


@pytest.mark.family
@pytest.mark.parametrize("rule", tuple(RULES))
def test_every_memory_against_direct_integration(rule: str, impact: Build) -> None:
    scene = bouncing(impact, 3)
    result = simulate(Correspondence(memory=rule), scene, 1e-7)
    assert result.converged
    assert len(result.contacts) == 3
    for one, (start, velocity, end, leaving) in zip(result.contacts, followed(scene, rule, 3), strict=True):
        assert one["start"] == pytest.approx(start, rel=1e-8)
        assert one["velocity"] == pytest.approx(velocity, rel=1e-8)
        assert one["duration"] == pytest.approx(end - start, rel=1e-7)
        assert one["restitution"] == pytest.approx(-leaving / velocity, rel=1e-7)


@pytest.mark.tenth
def test_memories_differ_only_while_something_is_remembered(impact: Build) -> None:
    def second(rule: str, gravity: float) -> float:
        scene = bouncing(impact, 2, gravity)
        return float(simulate(Correspondence(memory=rule), scene, 1e-7).contacts[1]["restitution"] or 0.0)

    flights = {gravity: [second(rule, gravity) for rule in tuple(RULES)] for gravity in (0.05, 0.6)}
    spread = {gravity: np.ptp(values) for gravity, values in flights.items()}
    assert spread[0.05] < 1e-6  # a flight of some hundred relaxation times
    assert spread[0.6] > 1e-5


@pytest.mark.parametrize("flight", [0.01, 1.0, 30.0, 3000.0])
def test_a_surface_that_creeps_back_is_met_where_it_stands_by_then(
    flight: float, impact: Build, unit_time: float
) -> None:
    """E_glassy y = E_1 w without force: y falls in the time tau E_glassy/E_inf, of which the flight lasts so many."""
    scene = impact(**SOLID)
    modulus, depth, speed = scene.contact_modulus, 0.02 * scene.velocity * unit_time, 0.5 * scene.velocity
    load = HereditaryLoad(scene.profile.load_curve, modulus)
    dent, creeping = float(load.load(depth)), modulus.times[0] * modulus.glassy / modulus.equilibrium
    bodies = Bodies(scene.mass, scene.velocity, 2.0 * speed / (flight * creeping))
    met = recovering(load, bodies, State(depth, -speed, 0.0, (modulus.glassy / modulus.moduli[0] * dent,)))
    assert met is not None
    time, there = met
    assert time > speed / bodies.gravity
    assert load.load(there.depth) == pytest.approx(dent * np.exp(-time / creeping), rel=1e-9, abs=1e-12 * dent)
    assert there.depth == pytest.approx(depth - time * (speed - 0.5 * bodies.gravity * time), abs=1e-12 * speed * time)


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("gravity", [1e-4, 1e-2])
def test_however_light_they_meet_again_at_the_surface_as_it_was(rule: str, gravity: float, impact: Build) -> None:
    """After a flight of many relaxation times nothing is remembered: a parabola from its dent back to depth zero."""
    scene = impact(**SOLID)
    law, bodies = laws.correspondence.law_of(scene, rule=rule), Bodies(scene.mass, scene.velocity, gravity)
    assert law.time_scale(bodies) == scene.elastic_contact_time
    speed, dent = 0.4 * scene.velocity, 0.02 * scene.velocity * scene.elastic_contact_time
    last = State(dent, -speed, 0.0, (float(law.load.load(dent)),))
    met = law.returned(bodies, last)
    assert met is not None
    time, there = met
    assert time == pytest.approx((speed + (speed**2 - 2.0 * gravity * dent) ** 0.5) / gravity, rel=1e-6)
    assert there.rate == pytest.approx((speed**2 - 2.0 * gravity * dent) ** 0.5, rel=1e-6)
    assert np.abs(there.memory).max() < 1e-6 * last.memory[0]
    assert law.returned(Bodies(scene.mass, scene.velocity, 0.0), last) is None
    assert law.returned(Bodies(scene.mass, scene.velocity, -gravity), last) is None


def test_every_contact_is_damped_by_its_own_speed() -> None:
    """A law whose damping goes with the inverse of the speed at touch gives back the same share each time."""
    law = LawChoice("hertzdamp", {"k": 1e9, "e": 0.6})
    scene = Scene(None, 1.0, 2.0, law=law, model=Model(gravity=0.1), motion=Motion(impacts=3, end_time=1e3))
    contacts = simulate(laws.hertzdamp.of(scene), scene, 1e-4).contacts
    for number, one in enumerate(contacts):
        assert one["velocity"] == pytest.approx(2.0 * 0.6**number, rel=1e-4)
        assert one["restitution"] == pytest.approx(0.6, rel=1e-4)
    assert len(contacts) == 3


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_a_contact_that_begins_in_the_dent_is_deepest_where_it_begins(tolerance: float) -> None:
    """Free flight ends on the way out: k (d + 1.5 A v) = 0 in a dent deeper than the weight presses, (m g/k)^(2/3)."""
    law, damping, weight = LawChoice("kuwabara_kono", {"k": 1.0, "A": 1.5}), 1.5 * 1.5, 0.05
    scene = Scene(None, 1.0, 1.0, law=law, model=Model(gravity=weight), motion=Motion(impacts=2, end_time=200.0))
    _, again = simulate(laws.kuwabara_kono.of(scene), scene, tolerance).contacts
    assert again["velocity"] < 0.0
    met = -damping * again["velocity"]
    assert met > weight ** (2.0 / 3.0)
    assert again["peak_depth"] == pytest.approx(met, rel=1e-9)


def test_tension_to_depth_zero_as_published(impact: Build, unit_time: float) -> None:
    # the audit of the paper, section 4: contact not clipped, in units of the elastic contact time
    for moduli, tau, e, duration in (((1.0,), 0.2, 0.539, 0.974), ((5.0,), 0.1, 0.017, None)):
        scene = impact(1.0, moduli, (tau,), profile="parabola")
        result = simulate(Correspondence(exit="depth"), scene, 1e-6)
        assert result.quantities["restitution"].value == pytest.approx(e, abs=6e-4)
        if duration is not None:
            assert result.quantities["duration"].value == pytest.approx(duration * unit_time, rel=1e-3)
        assert result.history.force.min() < 0.0
        assert result.history.depth[-1] == pytest.approx(0.0, abs=1e-9 * result.history.depth.max())


def quantities(result: Result) -> dict[str, float]:
    return {name: quantity.value for name, quantity in result.quantities.items() if quantity.value is not None}


@pytest.mark.parametrize(
    ("moduli", "times", "viscosity"), [((0.8,), (0.3,), 0.0), ((2.0, 0.5), (0.02, 3.0), 0.0), ((0.5,), (1.0,), 0.05)]
)
def test_two_integrators_agree(
    moduli: tuple[float, ...], times: tuple[float, ...], viscosity: float, impact: Build
) -> None:
    """The single impact of the law by its own integrator, and the first of two by collocation."""
    scene = impact(1.0, moduli, times, viscosity)
    single = quantities(simulate(Correspondence(), scene, 1e-8))
    first = quantities(simulate(Correspondence(), replace(scene, motion=Motion(impacts=2)), 1e-8))
    for name in ("peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse"):
        assert first[name] == pytest.approx(single[name], rel=1e-6)


def test_a_dashpot_that_lets_go_at_depth_zero_alone_is_followed_until_the_scene_ends(impact: Build) -> None:
    """By default so many contact times of its spring alone; creeping back would take far longer."""
    scene = impact(viscosity=1e3, profile="parabola")
    result = simulate(Correspondence(exit="depth"), scene, 1e-4)
    assert result.message == End.TIME.value
    assert result.history.time[-1] == pytest.approx(scene.end_time, rel=1e-12)


@pytest.mark.parametrize(("viscosity", "end"), [(10.0, End.SEPARATED), (1e3, End.SEPARATED), (1e4, End.REST)])
def test_what_creeps_back_slower_than_any_number_tells_is_at_rest(viscosity: float, end: End, impact: Build) -> None:
    """What a dashpot leaves of the velocity at depth zero falls as a power of it, and below 1e-20 is none."""
    scene = impact(viscosity=viscosity, profile="parabola", end_time=1e9)
    law, bodies = laws.correspondence.law_of(scene, exit="depth"), _force_law.bodies_of(scene)
    found = contact(law, bodies, "depth", law.touch(bodies), 0.0, scene.end_time, 1e-6)
    assert found.end is end
    assert found.last.rate < 0.0
    assert (abs(found.last.rate) < 1e-20 * scene.velocity) is (end is End.REST)
    assert found.end_time < scene.end_time


def test_flights_are_shorter_than_from_a_flat_surface(impact: Build) -> None:
    scene = bouncing(impact, 4)
    result = simulate(Correspondence(), scene, 1e-7)
    leaving = [-(one["restitution"] or 0.0) * (one["velocity"] or 0.0) for one in result.contacts]
    for before, after, speed in zip(result.contacts, result.contacts[1:], leaving, strict=False):
        flight = (after["start"] or 0.0) - (before["start"] or 0.0) - (before["duration"] or 0.0)
        # up from the dent, and down to the surface, which stands higher by then
        assert 0.0 < flight < -2.0 * speed / scene.gravity
        assert 0.0 < (after["velocity"] or 0.0) < (before["velocity"] or 0.0)


def test_choices_come_from_the_scene_and_only_they(impact: Build) -> None:
    table = impact(**SOLID).to_dict() | {"law": {"name": "correspondence", "exit": "depth", "memory": "reset"}}
    assert laws.correspondence.of(Scene.from_dict(table)) == Correspondence("depth", "reset")
    with pytest.raises(BadInput, match="accepted: one of continuous, recovering, reset"):
        Scene.from_dict(table | {"law": {"name": "correspondence", "memory": "gone"}})
    with pytest.raises(BadInput, match="continuous"):
        rule_of("gone")
    with pytest.raises(BadInput, match=r"motion\.impacts"):
        laws.ting.of(replace(impact(**SOLID), motion=Motion(impacts=2)))
    with pytest.raises(BadInput, match=r"striker\.shape"):
        laws.correspondence.of(Scene(None, 1.0, 1.0, model=Model()))


def test_of_equal_peaks_the_first_is_told_and_of_others_the_highest() -> None:
    """Equal but for the rounding of a long march: a later contact may be the harder one."""
    for peaks, first in (((1.0, 2.0, 1.5), 1), ((1.0, 2.0 - 1e-12, 2.0), 1), ((1.0, 1.9, 2.0), 2)):
        outcomes = [Outcome(t, 0.5, 1.0, 0.9, force, t + 0.2, 1e-3 * t) for t, force in enumerate(peaks)]
        told = values_of_several(outcomes, 4.0)
        assert (told["peak_force"], told["peak_time"]) == (peaks[first], first + 0.2)
        assert (told["peak_depth"], told["duration"], told["restitution"], told["impulse"]) == (2e-3, 0.5, 0.9, 4.0)
