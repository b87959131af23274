"""Truths of shape: what every correct law of viscoelastic impact does."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter, process_time

import numpy as np
import pytest

from lumped import BadInput, Relaxation, Result, Scene, laws, simulate
from lumped.result.history import End

Build = Callable[..., Scene]


def run(law: str, scene: Scene, tolerance: float = 1e-5) -> Result:
    return simulate(laws.get(law).of(scene), scene, tolerance)


def value(result: Result, name: str) -> float:
    found = result.quantities[name].value
    assert found is not None
    return found


@pytest.mark.tenth
def test_restitution_has_a_minimum_over_the_relaxation_time(impact: Build) -> None:
    e = [value(run("mdr", impact(0.5, (0.5,), (tau,))), "restitution") for tau in np.logspace(-2.5, 2, 12)]
    lowest = int(np.argmin(e))
    assert 0 < lowest < len(e) - 1
    assert np.all(np.diff(e[: lowest + 1]) < 0.0)
    assert np.all(np.diff(e[lowest:]) > 0.0)
    assert min(e[0], e[-1]) > 0.97


@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
def test_peak_force_precedes_peak_depth(law: str, impact: Build) -> None:
    for tau in (0.05, 0.5, 5.0):
        result = run(law, impact(0.3, (0.7,), (tau,)))
        deepest = result.history.time[int(np.argmax(result.history.depth))]
        assert value(result, "peak_time") < deepest


def test_clipped_correspondence_has_the_exact_peaks_and_falls_short_in_the_rebound(impact: Build) -> None:
    for scene in (impact(0.2, (0.8,), (0.1,)), impact(viscosity=0.3), impact(0.5, (0.5,), (1.0,), constant="bulk")):
        exact, clipped = run("ting", scene, 1e-6), run("correspondence", scene, 1e-6)
        for name in ("peak_force", "peak_depth"):
            assert value(clipped, name) == pytest.approx(value(exact, name), rel=1e-8)
        assert value(clipped, "duration") < value(exact, "duration")
        assert value(clipped, "restitution") < value(exact, "restitution")


def test_loss_is_linear_in_the_loss_factor_when_small(impact: Build) -> None:
    losses = [1.0 - value(run("ting", impact(1.0, (g,), (0.3,)), 1e-7), "restitution") for g in (0.002, 0.004, 0.008)]
    np.testing.assert_allclose(np.array(losses[1:]) / losses[:-1], 2.0, rtol=0.01)
    viscous = [1.0 - value(run("ting", impact(viscosity=eta), 1e-7), "restitution") for eta in (1e-4, 2e-4, 4e-4)]
    np.testing.assert_allclose(np.array(viscous[1:]) / viscous[:-1], 2.0, rtol=0.01)


def test_limits_of_fast_and_slow_relaxation_are_elastic(impact: Build) -> None:
    soft, stiff = run("hertz", impact(1.0)), run("hertz", impact(3.0))
    fast = run("mdr", impact(1.0, (2.0,), (1e-6,), profile="parabola"))
    slow = run("mdr", impact(1.0, (2.0,), (1e6,), profile="parabola"))
    assert value(fast, "peak_force") == pytest.approx(value(soft, "peak_force"), rel=1e-4)
    assert value(slow, "peak_force") == pytest.approx(value(stiff, "peak_force"), rel=1e-4)
    assert value(fast, "restitution") == pytest.approx(1.0, abs=1e-4)
    assert value(slow, "restitution") == pytest.approx(1.0, abs=1e-4)


@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
def test_a_fluid_may_never_let_go(law: str, impact: Build, unit_time: float) -> None:
    scene = impact(0.0, (1.0,), (0.1,))
    result = run(law, scene)
    assert result.converged
    assert not result.separated
    assert (result.quantities["duration"].value, result.quantities["restitution"].value) == (None, None)
    assert result.history.time[-1] == pytest.approx(scene.end_time)
    assert result.history.depth.max() == result.history.depth[-1]
    # literature 3.5: 1.95 of the elastic depth, parabola
    elastic = scene.shape.hertz_impact(1e6, scene.mass, scene.velocity)
    assert value(result, "peak_depth") / elastic.depth == pytest.approx(1.95, abs=0.01)


@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
@pytest.mark.parametrize(("time", "end", "why"), [(0.1, 1e-3, End.TIME), (0.1, 100.0, End.REST), (1e-6, 1e6, End.REST)])
def test_a_fluid_stops_the_striker_in_its_own_time(law: str, time: float, end: float, why: End, impact: Build) -> None:
    """However thin it is, and not at once."""
    assert run(law, impact(0.0, (1.0,), (time,), end_time=end), 1e-4).message == why.value


@pytest.mark.tenth
def test_a_faint_spring_turns_what_a_fluid_has_nearly_stopped(impact: Build) -> None:
    """A millionth of the stiffness lasts: it sends the striker back, slowly."""
    scene = impact(0.0, (1.0, 1e-6), (0.05, 1e7), end_time=1e5)
    exact, row, clipped = (run(law, scene, 1e-4) for law in ("ting", "mdr", "correspondence"))
    assert 0.0 < value(clipped, "restitution") < value(exact, "restitution") < 1e-4
    assert value(row, "restitution") == pytest.approx(value(exact, "restitution"), rel=1e-3)


@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
@pytest.mark.parametrize("end", [0.2, 0.7])
def test_an_early_end_time_ends_the_history(law: str, end: float, impact: Build, unit_time: float) -> None:
    scene = impact(0.5, (0.5,), (1.0,), end_time=end)
    result = run(law, scene)
    assert result.converged
    assert not result.separated
    assert result.history.time[-1] == pytest.approx(end * unit_time, rel=1e-12)
    assert result.quantities["duration"].value is None
    whole = run(law, impact(0.5, (0.5,), (1.0,)))
    bars = result.history.force_error[-1] + np.interp(end * unit_time, whole.history.time, whole.history.force_error)
    between_rows = 1e-5 * value(whole, "peak_force")  # what straight lines may err by
    assert abs(result.history.force[-1] - whole.history.force_at(end * unit_time)) <= bars + between_rows
    assert bars <= 3e-5 * value(whole, "peak_force")
    assert max(result.work.values()) < max(whole.work.values())


def test_springs_that_leave_at_one_time_leave_one_row() -> None:
    """Polynomials run through rows, which divide by the times between them."""
    assert laws.mdr._ascending(np.array([[0.0, 1.0, 1.0, 2.0, 2.0]])).tolist() == [[0.0, 1.0, 2.0]]


def test_the_time_told_is_what_was_taken(impact: Build) -> None:
    cpu, wall = process_time(), perf_counter()
    told = run("hertz", impact()).timing
    assert 0.0 < told["cpu_s"] <= process_time() - cpu
    assert 0.0 < told["wall_s"] <= perf_counter() - wall


def test_a_dashpot_alone_stops_the_striker_where_it_should(impact: Build) -> None:
    scene = impact(0.0, viscosity=1.0, profile="parabola")
    result = run("mdr", scene)
    eta = scene.contact_modulus.viscosity
    # m v = (4/3) eta sqrt(R) depth^(3/2)
    depth = (3.0 * scene.mass * scene.velocity / (4.0 * eta * 0.006**0.5)) ** (2.0 / 3.0)
    assert not result.separated
    assert value(result, "peak_depth") == pytest.approx(depth, rel=1e-5)
    assert value(result, "impulse") == pytest.approx(scene.mass * scene.velocity, rel=1e-5)


def test_extreme_materials_end(impact: Build) -> None:
    for extra in ({"times": (1e-8,)}, {"times": (1e8,)}, {"times": (1.0,), "viscosity": 1e3}):
        result = run("mdr", impact(0.1, (0.9,), **extra), 1e-3)
        assert 0.0 <= value(result, "restitution") <= 1.0 + 1e-3
        assert result.converged


def test_a_heavier_pull_changes_the_exit(impact: Build) -> None:
    free, pulled = (run("ting", impact(0.5, (0.5,), (1.0,), velocity=0.5, gravity=g)) for g in (0.0, 9.81))
    assert value(pulled, "duration") > value(free, "duration")
    assert value(pulled, "peak_force") > value(free, "peak_force")


def test_hertz_law_refuses_a_fluid(impact: Build) -> None:
    with pytest.raises(BadInput, match="fluid"):
        laws.hertz.of(impact(0.0, (1.0,), (0.1,)))
    assert "relaxed" in laws.hertz.of(impact(0.5, (0.5,), (1.0,))).source


def test_stiffer_springs_with_the_same_relaxation_push_harder() -> None:
    base = Scene.load("polymer-sphere")
    assert isinstance(base.contact_modulus, Relaxation)
    harder = Scene.load("polymer-sphere", {"target.material.E1": 3.6e6, "target.material.E2": 1.8e6})
    assert value(run("ting", harder), "peak_force") > value(run("ting", base), "peak_force")
