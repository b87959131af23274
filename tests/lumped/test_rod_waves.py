"""A mass on an elastic rod: St Venant's published numbers, the balance of energy, limits, two routes to one force."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from lumped import BadInput, Result, Scene, laws, simulate
from lumped.errors import NotReached
from lumped.solvers import rod
from lumped.solvers.rod import FlatImpact, RodPiece, TippedImpact, Waves

# Mass over that of the rod, contact time over the transit of a wave: Timoshenko and Goodier, Theory of Elasticity,
# art. 169, after St Venant.
PUBLISHED = [(1.0, 3.068), (2.0, 4.708), (4.0, 5.900)]
CYLINDER = {"shape": "cylinder", "radius": 0.01, "length": 0.1, "mass": 1.0, "velocity": 1.0}
FLUID = {"law": "maxwell", "E": 1e9, "eta": 1e9, "nu": 0.3, "density": 1e3}
RNG = np.random.default_rng(11)
ECHOES = [-1.0, 1.0, 0.0]
CASES = [(echo, *10 ** RNG.uniform(-1.0, 1.0, 2), RNG.uniform(-0.1, 0.5)) for echo in ECHOES for _ in range(3)]


def flat(echo: float, mass: float, gravity: float = 0.0, until: float = 50.0) -> FlatImpact:
    """On a rod of mass, impedance and transit one."""
    return FlatImpact(Waves(1.0, echo, 1.0), mass, 1.0, gravity, until)


def tipped(
    echo: float, mass: float, stiffness: float, gravity: float = 0.0, rtol: float = 1e-10, power: float = 1.5
) -> TippedImpact:
    depth = (0.5 * (power + 1.0) * mass / stiffness) ** (1.0 / (power + 1.0))
    force = lambda dent: stiffness * dent**power  # noqa: E731  # a law of one line
    return TippedImpact(Waves(1.0, echo, 1.0), force, mass, 1.0, gravity, 8.0, depth, depth, rtol)


def run(scene: Scene, tolerance: float = 1e-6) -> Result:
    return simulate(laws.get("rod_waves").of(scene), scene, tolerance)


def value(result: Result, name: str) -> float:
    found = result.quantities[name].value
    assert found is not None
    return found


@pytest.mark.parametrize(("ratio", "duration"), PUBLISHED)
def test_contact_lasts_as_st_venant_found(ratio: float, duration: float) -> None:
    _, end, separated = flat(-1.0, ratio).pieces
    assert separated
    assert end == pytest.approx(duration, abs=6e-4)


@pytest.mark.parametrize("mass", [1e-3, 1e-4])
def test_what_is_light_stays_until_the_first_echo_however_little_it_presses_then(mass: float) -> None:
    """Its force is exp(-2/mass) by then, which no number holds. The first echo is 1 - 2 s + ... of a fixed end."""
    pieces, end, separated = flat(1.0, mass).pieces
    assert (len(pieces), end, separated) == (2, pytest.approx(2.0, rel=1e-12), True)
    _, end, separated = flat(-1.0, mass).pieces
    assert separated
    assert end == pytest.approx(2.0 + mass, rel=1e-6)


def test_forces_between_echoes_are_the_textbook_ones() -> None:
    """exp(-t), then exp(-2) + 2 at the first echo on a rod as heavy as the mass."""
    impact = flat(-1.0, 1.0)
    times = np.array([0.0, 0.7, 1.9999999, 2.0])
    expected = [1.0, math.exp(-0.7), math.exp(-1.9999999), math.exp(-2.0) + 2.0]
    assert impact.columns(times)[2] == pytest.approx(expected, rel=1e-12)


def test_a_heavy_mass_finds_a_spring_and_every_echo_is_evaluated_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """k = Z/T, a third of the rod moves along; its depth by the impulse is that by the velocity; work as the echoes."""
    impact, mass, read = flat(-1.0, 3000.0, until=1e3), 3000.0 + 1.0 / 3.0, list[object]()
    pieces, end, separated = impact.pieces
    times = np.linspace(0.0, end, 40 * len(pieces) + 1)
    called = RodPiece.__call__
    monkeypatch.setattr(RodPiece, "__call__", lambda self, s: read.append(self) or called(self, s))
    depth, velocity, _, _ = impact.columns(times)
    assert separated
    assert len(pieces) > 80
    assert len(read) <= 4 * len(pieces)
    assert end == pytest.approx(math.pi * math.sqrt(mass), rel=0.01)
    assert depth.max() == pytest.approx(math.sqrt(mass), rel=1e-3)
    assert np.abs(depth - np.append(0.0, cumulative_trapezoid(velocity, times))).max() < 1e-3 * depth.max()


def test_a_free_rod_throws_no_mass_back_before_its_echo() -> None:
    for mass in (0.1, 1.0, 30.0):
        impact = flat(1.0, mass)
        _, end, separated = impact.pieces
        assert separated
        assert end == pytest.approx(2.0, rel=1e-15)
        assert impact.columns(np.array([end - 1e-12]))[1, 0] == pytest.approx(math.exp(-2.0 / mass), rel=1e-9)


@pytest.mark.family
@pytest.mark.parametrize("echo", ECHOES)
def test_a_stiff_linear_dent_comes_to_the_flat_end(echo: float) -> None:
    """Series and integrator share nothing; away from fronts they differ by the dent, as its inverse stiffness."""
    mass, gravity = 10 ** RNG.uniform(-0.3, 0.7), RNG.uniform(0.0, 0.1)
    series = flat(echo, mass, gravity, until=4.5)
    end = series.pieces[1]
    differences = []
    for hard in (400.0, 800.0):
        dented = tipped(echo, mass, hard, gravity, rtol=1e-9, power=1.0)
        times = np.linspace(0.0, min(end, dented.pieces[1]), 400)[1:-1]
        away = times[np.abs(times[:, None] - np.arange(0.0, 50.0, 2.0)).min(axis=1) > 0.1]
        differences.append(np.abs(series.columns(away) - dented.columns(away))[1:3].max(axis=1))
    assert differences[1].max() < 0.02
    assert np.allclose(differences[0] / differences[1], 2.0, rtol=0.1)


@pytest.mark.parametrize(("echo", "mass", "stiffness", "gravity"), CASES)
def test_what_the_striker_loses_is_in_the_waves(echo: float, mass: float, stiffness: float, gravity: float) -> None:
    for impact in (flat(echo, mass, gravity, until=8.0), tipped(echo, mass, stiffness, gravity)):
        _, end, _ = impact.pieces
        rows = np.unique(np.concatenate([impact.starts, np.linspace(0.0, end, 400)]))
        depth, speed, _, _ = impact.columns(rows)
        held, gone = impact.waves.energies(lambda t, impact=impact: impact.columns(t)[3], rows)
        dent = 0.0 if isinstance(impact, FlatImpact) else 0.4 * stiffness * float(impact.dents(rows[-1:])[0]) ** 2.5
        given = 0.5 * mass * (1.0 - speed[-1] ** 2) + mass * gravity * depth[-1]
        assert given == pytest.approx(held + gone + dent, abs=1e-7 * mass)
        fine = np.linspace(0.0, end, 4001)
        columns = impact.columns(fine)
        assert depth[-1] == pytest.approx(np.trapezoid(columns[1], fine), abs=1e-4)
        lost = mass * (1.0 - speed[-1] + gravity * end)
        assert np.trapezoid(columns[2], fine) == pytest.approx(lost, rel=2e-3)


@pytest.mark.parametrize("echo", ECHOES)
def test_a_flat_impact_is_the_same_in_all_units(echo: float) -> None:
    """Of velocity, of mass and of time: depth, velocity, force and what leaves grow with them as their units do."""
    speed, heavier, longer = 3.0, 5.0, 0.25
    one = flat(echo, 1.5, gravity=0.1, until=8.0)
    waves = Waves(heavier / longer, echo, longer)
    other = FlatImpact(waves, heavier * 1.5, speed, 0.1 * speed / longer, 8.0 * longer)
    (_, end, parted), times = one.pieces, np.linspace(0.0, one.pieces[1] * 0.999, 50)
    assert other.pieces[1:] == (pytest.approx(end * longer, rel=1e-12), parted)
    units = np.array([speed * longer, speed, heavier * speed / longer, speed])[:, None]
    assert other.columns(times * longer) == pytest.approx(units * one.columns(times), rel=1e-10)
    rows = np.linspace(0.0, end, 200)
    carried = [impact.waves.energies(lambda t, impact=impact: impact.columns(t)[3], at) for impact, at in
               ((one, rows), (other, rows * longer))]  # fmt: skip
    assert carried[1] == pytest.approx([heavier * speed**2 * energy for energy in carried[0]], rel=1e-9)


@pytest.mark.parametrize("echo", ECHOES)
def test_a_dent_s_impact_is_the_same_in_all_units(echo: float) -> None:
    """Steps, tolerances and all: of velocity, of mass and of time."""
    speed, heavier, longer, length = 3.0, 5.0, 0.25, 0.75
    one = tipped(echo, 1.5, 2.0, gravity=0.1, rtol=1e-8)
    waves, scales = Waves(heavier / longer, echo, longer), (length * one.depth, longer * one.time)
    unit = heavier * speed / longer
    force = lambda dent: unit * one.force(dent / length)  # noqa: E731  # a law of one line
    gravity, until = 0.1 * speed / longer, 8.0 * longer
    other = TippedImpact(waves, force, heavier * 1.5, speed, gravity, until, *scales, one.rtol)
    assert other.pieces[1:] == (pytest.approx(one.pieces[1] * longer, rel=1e-9), one.pieces[2])
    times, units = np.linspace(0.0, one.pieces[1] * 0.999, 50), np.array([length, speed, unit, speed])[:, None]
    scaled, known = other.columns(times * longer), units * one.columns(times)
    assert np.all(np.abs(scaled - known).max(axis=1) <= 1e-9 * np.abs(known).max(axis=1))
    assert other.dents(times * longer) == pytest.approx(length * one.dents(times), abs=1e-9 * length)


def test_a_stiff_rod_is_the_half_space_it_is_dented_like() -> None:
    """Hertz's impact as the impedance grows; the loss falls as its inverse."""
    losses = []
    for impedance in (1e3, 1e4):
        waves = Waves(impedance, 0.0, 1.0)
        impact = TippedImpact(waves, lambda d: d**1.5, 1.0, 1.0, 0.0, 50.0, 1.0, 1.0, 1e-11)
        _, end, _ = impact.pieces
        columns = impact.columns(np.linspace(0.0, end, 2001))
        assert end == pytest.approx(2.943275 * 1.25**0.4, rel=3.0 / impedance)
        assert columns[2].max() == pytest.approx(1.25**0.6, rel=3.0 / impedance)
        losses.append(1.0 - columns[1, -1] ** 2)
    assert losses[0] / losses[1] == pytest.approx(10.0, rel=1e-2)


def test_the_law_reports_what_its_solution_says() -> None:
    for name in ("rod", "rod-free", "concrete-pole"):
        result = run(Scene.load(name))
        assert result.converged
        assert result.separated
        history = result.history
        assert value(result, "peak_force") >= history.force.max() * (1.0 - 1e-12)
        assert value(result, "impulse") == pytest.approx(np.trapezoid(history.force, history.time), rel=1e-5)
        assert value(result, "duration") == history.time[-1]
        assert abs(result.energy["residual"]) < 1e-9 * result.energy["in"]
        assert history.force[-1] == 0.0
        (inertia,) = [entry for entry in result.model_ledger if entry.effect == "target inertia"]
        assert inertia.treated == "included"
        flat_end = result.scene.profile.fixed_radius is not None
        assert result.numerics == ({"series": "exact"} if flat_end else {"rtol": 1e-9})


def test_the_pole_takes_what_the_audit_says() -> None:
    # audit 4b: peak 187.7 kN, 1.40 ms, e = 0.655 for R = 0.1 m, and 239.9, 1.04, 0.560 for R = 0.5 m; on 0.4 m square
    for side, radius, peak, duration, e in (
        (0.25, 0.1, 187.7e3, 1.40e-3, 0.655),
        (0.25, 0.5, 239.9e3, 1.04e-3, 0.560),
        (0.4, 0.1, 215.1e3, 1.35e-3, 0.845),
        (0.4, 0.5, 286.6e3, 0.99e-3, 0.794),
    ):
        result = run(Scene.load("concrete-pole", {"striker.radius": radius, "target.area": side**2}))
        assert value(result, "peak_force") == pytest.approx(peak, abs=60.0)
        assert value(result, "duration") == pytest.approx(duration, abs=6e-6)
        assert value(result, "restitution") == pytest.approx(e, abs=6e-4)


def test_a_mass_on_an_endless_rod_stays() -> None:
    result = run(Scene.load("rod-absorbing"))
    assert not result.separated
    assert value(result, "peak_force") == pytest.approx(math.sqrt(2.06e11 * 7850.0) * 3.1415927e-4, rel=1e-12)
    # exp(-t Z/m) is left after ten m/Z, and of the energy its square
    assert result.energy["radiated"] == pytest.approx(result.energy["in"], rel=1e-7)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"model.inertia": False}, "model.inertia"),
        ({"target.end": "loose"}, "target.end"),
        ({"target.area": 0.0}, "target.area"),
        ({"striker": CYLINDER}, "striker.shape"),
    ],
)
def test_a_rod_that_cannot_be_is_refused_with_its_key(changes: dict[str, Any], key: str) -> None:
    with pytest.raises(BadInput, match=key):
        Scene.load("rod", changes)


@pytest.mark.parametrize(
    ("name", "changes", "key"),
    [
        ("polymer-sphere", {}, "target.shape"),
        ("rod", {"motion.impacts": 2}, "motion.impacts"),
        ("rod", {"target.material": FLUID}, "material.law"),
    ],
)
def test_the_law_refuses_what_it_does_not_follow(name: str, changes: dict[str, Any], key: str) -> None:
    with pytest.raises(BadInput, match=key):
        laws.get("rod_waves").of(Scene.load(name, changes))


def test_laws_without_waves_say_what_the_rod_would_take() -> None:
    with pytest.raises(BadInput, match=r"target.shape"):
        laws.get("mdr").of(Scene.load("concrete-pole"))


def test_the_greatest_force_is_that_behind_the_echo_wherever_it_rounds_to() -> None:
    """On a fixed rod no lighter than the striker: Z v (2 + exp(-2 Z T/m)), T the transit; it jumps from far below."""
    rng = np.random.default_rng(99)
    for _ in range(40):
        scene = Scene.load(
            "rod", {"target.length": rng.uniform(0.2, 3.0), "target.material.E": 10 ** rng.uniform(9.0, 11.3)}
        )
        waves, ratio = Waves.of(scene), rng.uniform(1.0, 3.0)
        scene = replace(scene, mass=waves.impedance * 0.5 * waves.delay / ratio)
        known = waves.impedance * scene.velocity * (2.0 + math.exp(-2.0 * ratio))
        assert value(run(scene), "peak_force") == pytest.approx(known, rel=1e-9)


@pytest.mark.tenth
def test_the_bars_of_a_pointed_rod_are_no_accident_of_equal_steps(uncovered: Callable[..., dict[str, float]]) -> None:
    """Where no tolerance bound a step the two marches were one, and every bar was rounding."""
    material = {"law": "elastic", "E": 3295614110.4212503, "nu": 0.3, "density": 1719.9281559131443}
    rod = {"shape": "rod", "area": 0.002896930618616404, "length": 2.0275655062074494, "end": "free"}
    striker = {"shape": "cone", "angle": 25.618922408795303, "mass": 918.8594354568752, "velocity": 0.01189803681214736}
    model = {"inertia": True, "gravity": 0.517083345930173}
    target = rod | {"material": material}
    scene = Scene.from_dict({"name": "cone", "striker": striker, "target": target, "model": model})
    assert not uncovered(run(scene, 3e-2), run(scene, 1e-9))


def test_a_rod_so_thin_that_it_hardly_slows_the_striker_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Steps are no longer than the dent's own time: a contact that lasts m/Z has a bound of them."""
    scene = Scene.load("concrete-pole", {"target.area": 2.4e-10, "model.profile": "parabola"})
    monkeypatch.setattr(rod, "MOST_STEPS", 200)
    with pytest.raises(NotReached, match="more than 200 steps; accepted: a heavier rod"):
        laws.rod_waves.of(scene).simulate(scene, 1e-3)
