"""The bouncing bar: published closed forms, and the theorems of momentum and energy on random bars."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumped import BadInput, Scene, simulate
from lumped.laws import bar_waves
from lumped.result.history import End
from lumped.solvers.bar import Bounces, StraightBar, bounces

# Doyen, Ern and Piperno 2011, doi:10.1137/100791440: L = 10, E = 900, density 1, area 1; transit time 1/3
BAR = StraightBar(length=10.0, speed=30.0, impedance=30.0)
TRANSIT = 1 / 3
SEEDS = st.integers(0, 2**32 - 1)


def random_bounces(seed: int) -> Bounces:
    rng = np.random.default_rng(seed)
    bar = StraightBar(*10 ** rng.uniform(-1, 1, 3))
    speed = 10 ** rng.uniform(-1, 1)
    gravity = rng.choice([0.0, 1.0]) * speed / bar.echo * 10 ** rng.uniform(-2, 0.5)
    return bounces(bar, speed, gravity, rng.choice([0.0, 1.0]) * rng.uniform(0, 3) * speed * bar.echo, 20 * bar.echo)


def knots(found: Bounces, start: float, end: float) -> np.ndarray:
    """Between these times force and momentum are smooth."""
    starts = np.array([piece.start for piece in found.pieces])
    every = np.concatenate([starts, starts + found.bar.echo])
    return np.unique([start, *every[(every > start) & (every < end)], end])


def integral(function: object, edges: np.ndarray) -> float:
    """By two Gauss points an interval: exact for cubics."""
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    nodes = np.concatenate([middle + half * x for x in (-(3**-0.5), 3**-0.5)])
    return float(np.tile(half, 2) @ [float(function(t)) for t in nodes])  # type: ignore[operator] # a plain callable


def far_end(found: Bounces, time: float) -> tuple[float, float]:
    """How far the bar's far end has come, and its velocity: V t and V without waves, which are half an echo old."""
    late = time - 0.5 * found.bar.echo
    travelled = integral(found.wave, knots(found, 0.0, late)) if late > 0.0 else 0.0
    fallen = found.velocity * time + 0.5 * found.gravity * time**2
    return fallen - 2.0 * travelled, float(found.fall(time) - 2.0 * found.wave(late))


def test_the_bouncing_bar_touches_every_eight_transit_times_for_two() -> None:
    """From rest 5 m above the plane: period 16 transit times, in which it touches twice."""
    contacts = bounces(BAR, 0.0, 10.0, 5.0, 160.5 * TRANSIT).contacts
    wanted = [(3 + 8 * k, 5 + 8 * k) for k in range(20)]
    np.testing.assert_allclose(np.array(contacts) / TRANSIT, wanted, rtol=1e-9)


def test_the_bouncing_bar_presses_in_a_ramp_and_in_its_mirror() -> None:
    """density c (v + g t), 300 to 500 N; the next contact runs backwards, as mechanics without loss must."""
    found = bounces(BAR, 10.0, 10.0, 0.0, 17 * TRANSIT)
    t = np.linspace(0.001, 1.999, 57) * TRANSIT
    np.testing.assert_allclose(found.force(t), 30.0 * (10.0 + 10.0 * t), rtol=1e-12)
    np.testing.assert_allclose(found.force(10 * TRANSIT - t), found.force(t), rtol=1e-11)
    np.testing.assert_allclose(found.force(16 * TRANSIT + t[:20]), found.force(t[:20]), rtol=1e-11)


def test_the_far_end_of_the_bouncing_bar_follows_the_published_series() -> None:
    """In the first contact u(L, t) = -v min(L/c, ...) + sum a_n sin(nu_n L)(1 - cos(c nu_n t))."""
    t = np.linspace(0.0, 2 * TRANSIT, 41)
    nu = (np.arange(1, 20001) - 0.5) * np.pi / 10.0
    a = -2 * 10.0 / (900.0 * 10.0 * nu**3)
    series = ((a * np.sin(10.0 * nu))[:, None] * (1 - np.cos(30.0 * np.outer(nu, t)))).sum(axis=0)
    wave = -10.0 * np.minimum(10.0 / 30.0, TRANSIT - np.abs(t - TRANSIT))
    found = bounces(BAR, 10.0, 10.0, 0.0, 1.0)
    np.testing.assert_allclose([far_end(found, time)[0] for time in t], -(series + wave), atol=1e-9)


def test_the_impact_of_a_bar_on_a_wall() -> None:
    """No gravity, 5 m away at 10 m/s: touch at 0.5 s, 300 N for two transit times, and away as it came."""
    found = bounces(BAR, 10.0, 0.0, 5.0, 3.0)
    np.testing.assert_allclose(found.contacts, [(0.5, 0.5 + 2 * TRANSIT)], rtol=1e-12)
    np.testing.assert_allclose(found.force([0.49, 0.51, 0.8, 1.16, 1.17]), [0, 300, 300, 300, 0])
    np.testing.assert_allclose([far_end(found, time)[1] for time in (0.4, 0.8, 0.9, 2.0)], [10, 10, -10, -10])
    assert far_end(found, 2.0)[0] == pytest.approx(10.0 * (0.5 + TRANSIT) - 10.0 * (1.5 - TRANSIT))


@given(SEEDS)
def test_the_force_gives_the_bar_its_momentum(seed: int) -> None:
    found = random_bounces(seed)
    end, mass = found.end * 0.9999, found.bar.mass
    impulse = integral(found.force, knots(found, 0.0, end))
    gained = found.momentum(end) + mass * found.velocity + mass * found.gravity * end
    assert impulse == pytest.approx(gained, rel=1e-9, abs=1e-9 * mass * float(found.fall(end)))


@given(SEEDS)
def test_only_gravity_works_on_the_bar(seed: int) -> None:
    found = random_bounces(seed)
    times = np.linspace(0.0, found.end * 0.9999, 7)
    for before, after in pairwise(times):
        work = -found.gravity * integral(found.momentum, knots(found, before, after))
        size = found.energy(after) + 0.5 * found.bar.mass * float(found.fall(after)) ** 2
        assert found.energy(after) - found.energy(before) == pytest.approx(work, abs=1e-9 * size)


@given(SEEDS)
def test_pressure_only_where_the_gap_is_closed_and_never_tension(seed: int) -> None:
    found = random_bounces(seed)
    rng = np.random.default_rng(seed)
    times = rng.uniform(0.0, found.end, 50)
    assert np.all(found.force(times) >= -1e-9 * found.bar.impedance * found.fall(found.end))
    assert all(piece.gap >= 0.0 and (piece.gap == 0.0 or not piece.closed) for piece in found.pieces)
    assert found.contacts


def test_no_more_contacts_are_followed_than_are_asked_for() -> None:
    """A bar that does not fall back in step with its waves meets the plane ever more often."""
    whole, two = (bounces(BAR, 8.9, 10.0, 0.0, 60 * TRANSIT, contacts) for contacts in (math.inf, 2))
    assert two.contacts == whole.contacts[:2]
    assert two.pieces == whole.pieces[: len(two.pieces)]
    assert two.contacts[-1][1] < two.end <= whole.contacts[2][0]


def test_the_law_of_a_bar_is_the_rectangle_of_one_echo() -> None:
    """density c v for 2 L/c, all of which it gives back, whatever the tolerance."""
    scene = Scene.load("bar-impact")
    found = simulate(bar_waves.of(scene), scene, 1e-3)
    values = {name: quantity.value for name, quantity in found.quantities.items()}
    assert values["peak_force"] == pytest.approx(300.0, rel=1e-12)
    assert values["duration"] == pytest.approx(2 / 3, rel=1e-12)
    assert values["restitution"] == pytest.approx(1.0, rel=1e-12)
    assert values["impulse"] == pytest.approx(200.0, rel=1e-12)
    assert values["peak_depth"] == pytest.approx(10.0 / 6.0, rel=1e-12)  # half of it under half of its momentum
    places = np.linspace(0.0, 0.66, 100)
    np.testing.assert_allclose(np.interp(places, found.history.time, found.history.force), 300.0, rtol=1e-12)


@pytest.mark.parametrize(
    ("density", "modulus", "area", "height", "velocity"),
    [(7850.0, 2.1e11, 3e-4, 0.2, 5.0), (3.0, 2e3, 1e-4, 0.05, 0.02), (1e3, 1e6, 4.0, 7.0, 1e-3)],
)
def test_the_impact_of_any_bar_is_that_of_its_density_and_wave(
    density: float, modulus: float, area: float, height: float, velocity: float
) -> None:
    """density c A v for 2 L/c, over all of its face, however faint, and nothing once it has left."""
    striker = {"area": area, "height": height, "velocity": velocity, "material.density": density, "material.E": modulus}
    scene = Scene.load("bar-impact", {f"striker.{key}": number for key, number in striker.items()})
    found, speed = simulate(bar_waves.of(scene), scene, 1e-3), math.sqrt(modulus / density)
    values = {name: quantity.value for name, quantity in found.quantities.items()}
    force, duration = density * speed * area * velocity, 2.0 * height / speed
    exact = {"peak_force": force, "duration": duration, "restitution": 1.0, "impulse": force * duration}
    assert {name: values[name] for name in exact} == pytest.approx(exact, rel=1e-12, abs=0.0)
    assert values["peak_depth"] == pytest.approx(0.25 * velocity * duration, rel=1e-12, abs=0.0)
    history = found.history
    assert (found.message, found.separated, len(found.contacts)) == ("", True, 0)
    assert np.interp(duration * (1.0 - 1e-9), history.time, history.force) == pytest.approx(force, rel=1e-2)
    assert history.force[:-1] == pytest.approx(force, rel=1e-12, abs=0.0)
    assert history.contact_radius[:-1] == pytest.approx(math.sqrt(area / math.pi), rel=1e-12, abs=0.0)
    assert (history.force[-1], history.contact_radius[-1]) == (0.0, 0.0)
    assert found.energy["in"] == pytest.approx(0.5 * density * area * height * velocity**2, rel=1e-12, abs=0.0)


def test_contacts_of_a_falling_bar_are_told_one_by_one() -> None:
    """In step with its waves the first ramp, of 300 to 500 N, is run through backwards at the next one."""
    scene = Scene.load("bar")
    found = simulate(bar_waves.of(scene), scene, 1e-3)
    first, second = found.contacts
    # the momentum changes by 400 N over 2/3 s, less the weight of 100 N
    before = {"start": 0.0, "duration": 2 / 3, "velocity": 10.0, "peak_force": 500.0, "peak_time": 2 / 3}
    before["restitution"] = 1.0
    assert {name: first[name] for name in before} == pytest.approx(before, rel=1e-9, abs=1e-9)
    after = {"start": 8 / 3, "velocity": 10.0, "peak_force": 500.0, "restitution": 1.0, "peak_time": 8 / 3}
    assert {name: second[name] for name in after} == pytest.approx(after, rel=1e-9)
    values = {name: quantity.value for name, quantity in found.quantities.items()}
    assert values["impulse"] == pytest.approx(1600 / 3, rel=1e-9)
    assert (values["peak_force"], values["peak_time"]) == pytest.approx((500.0, 2 / 3), rel=1e-9), "the first of equals"
    assert values["peak_depth"] == max(first["peak_depth"], second["peak_depth"])
    assert (found.message, found.separated) == ("", True)
    energy = found.energy
    assert (energy["out"], energy["viscous"]) == (pytest.approx(500.0, rel=1e-9), 0.0)
    assert energy["in"] == pytest.approx(500.0 + 100.0 * found.history.depth[-1], rel=1e-9)
    one = Scene.load("bar-impact", {"motion.impacts": 2, "motion.end_time": 9.0})
    told = simulate(bar_waves.of(one), one, 1e-3)
    assert told.message.startswith("1 of 2 impacts")
    assert len(told.contacts) == 1
    short = Scene.load("bar-impact", {"motion.end_time": 0.5})
    assert simulate(bar_waves.of(short), short, 1e-3).message == End.TIME.value


@pytest.mark.parametrize("gravity", [1.7, 3.0, 7.3, 25.0])
def test_the_peak_of_a_bar_is_that_of_its_hardest_contact(gravity: float) -> None:
    """Whichever that is."""
    scene = Scene.load("bar", {"model.gravity": gravity, "motion.impacts": 4, "motion.end_time": 100.0})
    found = simulate(bar_waves.of(scene), scene, 1e-3)
    hardest = max(found.contacts, key=lambda one: one["peak_force"])
    values = {name: quantity.value for name, quantity in found.quantities.items()}
    assert values["peak_force"] == pytest.approx(hardest["peak_force"], rel=1e-9)
    assert values["peak_time"] == next(
        one["peak_time"] for one in found.contacts if one["peak_force"] > (1.0 - 1e-9) * hardest["peak_force"]
    )
    for one in found.contacts:
        rows = (found.history.time >= one["start"]) & (found.history.time < one["start"] + one["duration"])
        assert found.history.force[rows].max() == pytest.approx(one["peak_force"], rel=1e-9)


@pytest.mark.parametrize("gravity", [0.0, 3.0, 10.0, 25.0])
def test_the_centre_of_a_bar_moves_by_its_force_and_no_energy_is_lost(gravity: float) -> None:
    """M dv/dt = M g - F and dx/dt = v from the rows alone, by the trapezium rule; energy from the waves themselves."""
    scene = Scene.load("bar", {"model.gravity": gravity, "motion.impacts": 3})
    found = simulate(bar_waves.of(scene), scene, 1e-4)
    time, force, mass = found.history.time, found.history.force, 10.0
    step = np.diff(time)
    passed = np.append(0.0, np.cumsum(0.5 * (force[1:] + force[:-1]) * step))
    velocity = scene.velocity + gravity * time - passed / mass
    depth = np.append(0.0, np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * step))
    np.testing.assert_allclose(found.history.velocity, velocity, atol=2e-4 * scene.velocity)
    np.testing.assert_allclose(found.history.depth, depth, atol=2e-3 * np.abs(depth).max())
    energy = {name: value or 0.0 for name, value in found.energy.items()}
    assert abs(energy["residual"]) <= 1e-10 * abs(energy["in"])
    assert energy["stored"] >= -1e-10 * abs(energy["in"])
    deepest = found.quantities["peak_depth"].value or 0.0  # between two rows, which are as dense as the force asks for
    assert found.history.depth.max() <= deepest * (1.0 + 1e-12) <= 1.005 * found.history.depth.max()


def test_the_law_of_a_bar_refuses_what_is_no_elastic_bar() -> None:
    for name, overrides, key in (
        ("bar", {"striker.mass": 0.05}, "striker.mass"),
        ("polymer-prism-waves", {}, "striker.material.law"),
        ("polymer-prism", {}, "striker.shape"),
        ("steel-ball", {}, "striker.shape"),
    ):
        with pytest.raises(BadInput, match=key):
            bar_waves.of(Scene.load(name, overrides))
