"""Error bars of the row of springs over profiles, networks and decades of relaxation, judged by Ting's integrals."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lumped import Quantity, Result, Scene, laws, simulate

CASES = 250
EXACT = 1e-8
# The bar of the peak may be this much too wide in the median.
WIDE = 100.0


def striker(rng: np.random.Generator) -> dict[str, Any]:
    """Any profile up to r^6, light or heavy, slow or fast."""
    exponent = float(rng.uniform(1.0, 6.0))
    profiles: list[dict[str, Any]] = [
        {"shape": "sphere", "radius": 10.0 ** rng.uniform(-2.5, -1.5)},
        {"shape": "cone", "angle": rng.uniform(5.0, 40.0)},
        {"shape": "power", "exponent": exponent, "coefficient": rng.uniform(0.3, 3.0) * 0.01 ** (1.0 - exponent)},
    ]
    motion = {"mass": 10.0 ** rng.uniform(-2.0, 0.0), "velocity": 10.0 ** rng.uniform(-2.0, -0.5)}
    return profiles[rng.integers(3)] | motion


def material(rng: np.random.Generator) -> dict[str, Any]:
    """Solids of every network, relaxing within a thousandth of a contact or long after it."""
    E, time, branches = 10.0 ** rng.uniform(5.5, 7.0), 10.0 ** rng.uniform(-3.5, 0.3), rng.integers(1, 5)
    laws_: list[dict[str, Any]] = [
        {"law": "elastic", "E": E},
        {"law": "sls", "E1": E, "E2": E * 10.0 ** rng.uniform(-1.0, 1.0), "C1": E * time},
        {"law": "kelvin_voigt", "E": E, "eta": 0.1 * E * time},
        {
            "law": "prony",
            "E_inf": E,
            "E": [float(E * 10.0 ** rng.uniform(-1.0, 0.7)) for _ in range(branches)],
            "tau": [float(time * 10.0 ** rng.uniform(-1.5, 1.0)) for _ in range(branches)],
        },
    ]
    return laws_[rng.integers(4)] | {"nu": rng.uniform(0.0, 0.49)}


def force_over_bars(found: Result, exact: Result) -> float:
    """Largest error of the force in a row over the bars that should cover it."""
    rows, bar = found.history, exact.history.force_error.max()
    return float(np.max(np.abs(rows.force - exact.history.force_at(rows.time)) / (rows.force_error + bar)))


@pytest.mark.tenth
@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_every_bar_covers(
    tolerance: float, campaign_size: Callable[[int], int], uncovered: Callable[..., dict[str, float]]
) -> None:
    rng = np.random.default_rng(41)
    converged, wide = [], []
    for _ in range(campaign_size(CASES)):
        target = {"shape": "half_space", "material": material(rng)}
        scene = Scene.from_dict({"name": "row", "striker": striker(rng), "target": target})
        found = simulate(laws.mdr.of(scene), scene, tolerance)
        converged.append(found.converged)
        exact = simulate(laws.ting.of(scene), scene, EXACT)
        assert not uncovered(found, exact), scene
        assert force_over_bars(found, exact) <= 1.0, scene
        peak, true = found.quantities["peak_force"], exact.quantities["peak_force"]
        wide.append(peak.error / max(abs(peak.value - true.value), true.error))
    assert np.mean(converged) >= 0.95
    assert np.median(wide) < WIDE


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
def test_a_peak_which_two_limits_tell_alike_by_chance_has_a_true_bar(
    tolerance: float, uncovered: Callable[..., dict[str, float]]
) -> None:
    """It lies between two rows of three coarse marches, which err by no power of their steps there."""
    branches = {"E": [1.64128e8, 1.2266e6, 8.8332e6], "tau": [1.46509e-4, 9.65383e-4, 2.918918e-3]}
    profile = {"shape": "power", "coefficient": 1.50978, "exponent": 1.5}
    relaxing = {"law": "prony", "E_inf": 2.7084e7, **branches, "nu": 0.248947}
    scene = Scene.from_dict(
        {
            "name": "chance",
            "striker": profile | {"mass": 15.577, "velocity": 0.43163},
            "target": {"shape": "half_space", "material": relaxing},
            "motion": {"end_time": 8.937016e-3},
        }
    )
    found, exact = simulate(laws.mdr.of(scene), scene, tolerance), simulate(laws.ting.of(scene), scene, EXACT)
    assert not uncovered(found, exact)


@pytest.mark.parametrize(
    ("errors", "off"),
    [((16.0, 4.0, 1.0), 0.0), ((4.5, 1.5, 0.5), 0.25), ((-3.0, 1.0, 1.0), 1.0), ((7.0, 1.0, -1.0), 0.25)],
)
def test_marches_which_err_by_h2_add_nothing_to_a_bar_and_others_what_they_still_lack(
    errors: tuple[float, float, float], off: float
) -> None:
    """Squared, the share by which their differences are off four to one; all of it at most."""
    told = Quantity(5.0, 1e-9, "N")
    marches = [{"peak_force": 5.0 + error, "duration": None} for error in errors]
    found = laws.mdr._without_order({"peak_force": told, "duration": Quantity(None, None, "s")}, marches)
    finest = max(abs(errors[2]), 0.25 * abs(errors[1]))
    assert found["peak_force"].error == pytest.approx(laws.mdr.SAFETY * off**2 * finest, abs=1e-15)
    assert found["duration"].error is None


@pytest.mark.tenth
def test_a_looser_tolerance_never_takes_more_steps() -> None:
    rng = np.random.default_rng(5)
    for _ in range(8):
        body = {"striker": striker(rng), "target": {"shape": "half_space", "material": material(rng)}}
        scene = Scene.from_dict({"name": "row", **body})
        steps = [simulate(laws.mdr.of(scene), scene, 10.0**-power).work["steps"] for power in range(1, 7)]
        assert steps == sorted(steps), scene


def test_an_edge_at_rest_before_the_end_is_followed_to_it(uncovered: Callable[..., dict[str, float]]) -> None:
    """Its weight holds it: no whole step of the rebound leads past the end, and nothing may be read beyond the last."""
    stiff = {"law": "prony", "E_inf": 3736956.2539848974, "E": [51579672165.44953], "tau": [3.448556051893759e-05]}
    profile = {"shape": "power", "coefficient": 1652908924909.687, "exponent": 5.296514328496658}
    scene = Scene.from_dict(
        {
            "name": "held",
            "striker": profile | {"mass": 0.5087043173736171, "velocity": 0.004822098829175621},
            "target": {"shape": "half_space", "material": stiff | {"nu": 0.4999}},
            "model": {"gravity": 0.008115824784660967, "profile": "parabola"},
            "motion": {"end_time": 0.005310696524236301},
        }
    )
    found, exact = simulate(laws.mdr.of(scene), scene, 1e-3), simulate(laws.ting.of(scene), scene, EXACT)
    assert not uncovered(found, exact)
