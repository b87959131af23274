"""Two independent exact answers agree: Ting's integrals by collocation, and a row of springs by its own march."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lumped import Result, Scene, laws, simulate
from lumped.ending import End
from lumped.laws._assembly import Answer
from lumped.spring_row.coarse import coarse, problem_of
from lumped.spring_row.nest import Nest, predicted_ends

CASES: dict[str, dict[str, Any]] = {
    "elastic": {},
    "parabola": {"profile": "parabola", "moduli": (0.5,), "times": (0.3,)},
    "sls": {"relaxed": 0.5, "moduli": (0.5,), "times": (1.0,)},
    "fast sls": {"relaxed": 0.09, "moduli": (0.91,), "times": (0.01,)},
    "slow sls": {"relaxed": 0.09, "moduli": (0.91,), "times": (10.0,)},
    "three terms": {"relaxed": 0.2, "moduli": (0.3, 0.3, 0.2), "times": (0.05, 0.5, 5.0)},
    "kelvin-voigt": {"viscosity": 0.1},
    "stiff kelvin-voigt": {"viscosity": 10.0},
    "maxwell": {"relaxed": 0.0, "moduli": (1.0,), "times": (0.5,)},
    "all at once": {
        "relaxed": 0.3,
        "moduli": (0.7,),
        "times": (0.4,),
        "viscosity": 0.05,
        "gravity": 9.81,
        "velocity": 1.0,
    },
    "constant bulk": {"relaxed": 0.3, "moduli": (0.7,), "times": (0.4,), "constant": "bulk", "nu": 0.2},
    "deep": {"relaxed": 0.5, "moduli": (0.5,), "times": (1.0,), "velocity": 1.5},
}


def both(scene: Scene, tolerance: float = 1e-6) -> tuple[Result, Result]:
    return simulate(laws.ting.of(scene), scene, tolerance), simulate(laws.mdr.of(scene), scene, tolerance)


def agree(exact: Result, row: Result, tolerance: float = 1e-6) -> None:
    assert exact.converged
    assert row.converged
    assert exact.separated == row.separated
    for name in ("peak_force", "peak_depth", "duration", "restitution", "impulse"):
        one, other = exact.quantities[name], row.quantities[name]
        if one.value is None or other.value is None:
            assert one.value == other.value
            continue
        apart = abs(one.value - other.value)
        assert apart <= tolerance * (1.0 if name == "restitution" else abs(one.value)), name
        assert apart <= (one.error or 0.0) + (other.error or 0.0), f"{name}: the bars do not cover the difference"
    times = np.union1d(exact.history.time, row.history.time)
    force = exact.history.force_at(times)
    apart = np.sqrt(np.trapezoid((row.history.force_at(times) - force) ** 2, times))
    assert apart <= 1.5 * tolerance * np.sqrt(np.trapezoid(force**2, times))


@pytest.mark.parametrize("case", CASES)
def test_ting_and_the_spring_row_agree(case: str, impact: Callable[..., Scene]) -> None:
    agree(*both(impact(**CASES[case])))


def test_ting_and_the_spring_row_agree_on_random_impacts(
    impact: Callable[..., Scene], campaign_size: Callable[[int], int]
) -> None:
    random = np.random.default_rng(20161)
    for _ in range(campaign_size(60)):
        terms = int(random.integers(0, 4))
        moduli, times = random.uniform(0.1, 3.0, terms), 10.0 ** random.uniform(-2.0, 1.0, terms)
        scene = impact(
            1.0,
            tuple(moduli.tolist()),
            tuple(times.tolist()),
            0.0 if terms else float(10.0 ** random.uniform(-2.0, 1.0)),
            nu=float(random.uniform(-0.5, 0.4999)),
            constant=str(random.choice(["poisson", "bulk"])),
            velocity=float(10.0 ** random.uniform(-3.0, 0.0)),
        )
        agree(*both(scene))


@pytest.mark.parametrize("case", ["sls", "fast sls", "kelvin-voigt"])
def test_contact_radius_of_both_agrees(case: str, impact: Callable[..., Scene]) -> None:
    exact, row = both(impact(**CASES[case]))
    times = np.linspace(0.0, 0.98 * (exact.quantities["duration"].value or 0.0), 200)
    one, other = exact.history.resampled(times).contact_radius, row.history.resampled(times).contact_radius
    assert np.abs(one - other).max() < 1e-4 * one.max()


@pytest.mark.parametrize("case", ["elastic", "sls", "kelvin-voigt"])
def test_spring_row_errs_by_the_square_of_its_steps(case: str, impact: Callable[..., Scene]) -> None:
    scene = impact(**CASES[case])
    problem = problem_of(scene)
    track = coarse(problem, scene.end_time, 32)
    nest = Nest.around(problem, scene.end_time, track, 32)
    levels = [nest.level(1, (track.approach[-1].time, track.rebound[-1].time))]
    for parts in (2, 4, 8):
        levels.append(nest.level(parts, predicted_ends(levels)))
    duration = np.array([level.ends[1] for level in levels])
    depth = np.array([level.approach[1, -1] for level in levels])
    for values in (duration, depth):
        differences = np.abs(np.diff(values))
        rates = np.log2(differences[:-1] / differences[1:])
        assert np.all(np.abs(rates - 2.0) < 0.1)


@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
@pytest.mark.parametrize("case", ["three terms", "kelvin-voigt", "constant bulk"])
def test_bars_cover_the_error_at_every_tolerance(law: str, case: str, impact: Callable[..., Scene]) -> None:
    scene = impact(**CASES[case])
    model = laws.get(law).of(scene)
    truth = simulate(model, scene, 1e-8)
    for tolerance in (1e-3, 1e-5):
        result = simulate(model, scene, tolerance)
        for name, quantity in result.quantities.items():
            exact = truth.quantities[name]
            if name != "history_l2" and quantity.value is not None and exact.value is not None:
                assert abs(quantity.value - exact.value) <= (quantity.error or 0.0) + (exact.error or 0.0), name


def test_work_grows_gently_with_the_tolerance(impact: Callable[..., Scene]) -> None:
    scene = impact(**CASES["sls"])
    steps = [simulate(laws.mdr.of(scene), scene, tol).work["steps"] for tol in (1e-4, 1e-6)]
    assert steps[0] < 1200
    assert steps[1] < 3000
    calls = [simulate(laws.ting.of(scene), scene, tol).work["force_evaluations"] for tol in (1e-4, 1e-6)]
    assert calls[0] < 1500
    assert calls[1] < 2500


def test_energy_of_the_spring_row_closes_term_by_term(impact: Callable[..., Scene]) -> None:
    for case in ("elastic", "sls", "stiff kelvin-voigt", "maxwell", "all at once"):
        scene = impact(**CASES[case])
        energy = simulate(laws.mdr.of(scene), scene, 1e-5).energy
        assert energy["residual"] == pytest.approx(0.0, abs=5e-6 * (energy["in"] or 0.0)), case
        assert (energy["viscous"] or 0.0) >= -1e-9
        assert (energy["stored"] or 0.0) >= -1e-9


def test_energy_of_the_spring_row_closes_where_gravity_does_most_of_the_work() -> None:
    """Two coarse levels alone would leave 1.6 % of the energy over."""
    material = {"law": "maxwell", "E": 2.559e8, "eta": 3.349e9, "nu": 0.18}
    striker = {"shape": "power", "coefficient": 1373.6, "exponent": 5.66, "mass": 95.2, "velocity": 0.00257}
    target = {"shape": "half_space", "material": material}
    scene = Scene.from_dict({"striker": striker, "target": target, "model": {"gravity": 9.81}})
    energy = simulate(laws.mdr.of(scene), scene, 1e-3).energy
    assert energy["residual"] == pytest.approx(0.0, abs=2e-4 * (energy["in"] or 0.0))


def test_a_law_that_cannot_go_on_says_so(impact: Callable[..., Scene]) -> None:
    scene = impact(0.2, (0.8,), (0.1,), gravity=9.81)
    for result in both(scene):
        assert not result.converged
        assert not result.separated
        assert End.SECOND_APPROACH.value in result.message
        assert result.quantities["duration"].value is None


def test_bars_never_rest_on_one_chance_agreement() -> None:
    from lumped.laws._assembly import bars

    def answer(shift: float) -> Answer:
        values = dict.fromkeys(["peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse"], 1.0)
        times = np.linspace(0.0, 1.0, 101)
        return Answer(times, lambda t: np.array([t, t, np.sin(np.pi * t) + shift * t, t]), values, End.SEPARATED)

    quantities, _ = bars(answer(0.0), answer(1e-3), 1.5)
    assert quantities["peak_depth"].error == pytest.approx(0.1 * (quantities["history_l2"].error or 0.0), rel=1e-6)


@pytest.mark.parametrize("law", ["ting", "mdr", "correspondence"])
@pytest.mark.parametrize("case", ["elastic", "three terms", "kelvin-voigt", "all at once"])
def test_the_first_row_is_the_touch(law: str, case: str, impact: Callable[..., Scene]) -> None:
    scene = impact(**CASES[case])
    history = simulate(laws.get(law).of(scene), scene, 1e-3).history
    assert (history.time[0], history.depth[0], history.velocity[0]) == (0.0, 0.0, scene.velocity)
