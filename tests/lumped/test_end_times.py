"""The row of springs stopped by time near the turn, where finer marches turn elsewhere: a number with a true bar."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from lumped import Motion, Scene, laws, simulate
from lumped.result.history import End

QUANTITIES = ("peak_force", "peak_depth", "impulse")


def test_an_end_near_the_turn_is_a_number_with_a_true_bar(
    impact: Callable[..., Scene], campaign_size: Callable[[int], int], uncovered: Callable[..., dict[str, float]]
) -> None:
    rng = np.random.default_rng(53)
    for _ in range(campaign_size(60)):
        terms = int(rng.integers(1, 3))
        scene = impact(
            float(rng.uniform(0.3, 1.0)),
            tuple(rng.uniform(0.1, 1.0, terms).tolist()),
            tuple((10.0 ** rng.uniform(-1.5, 1.0, terms)).tolist()),
            velocity=float(10.0 ** rng.uniform(-3.0, -0.5)),
        )
        whole = simulate(laws.ting.of(scene), scene, 1e-6).history
        turn = float(whole.time[whole.depth.argmax()])
        for away in rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-9.0, -1.5, 2):
            stopped = replace(scene, motion=Motion(end_time=turn * (1.0 + float(away))))
            exact = simulate(laws.ting.of(stopped), stopped, 1e-9)
            found = simulate(laws.mdr.of(stopped), stopped, 1e-5)
            assert found.message == End.TIME.value
            assert found.history.time[-1] == stopped.end_time
            assert abs(found.energy["residual"] or 0.0) < 1e-9 * (found.energy["in"] or 0.0)
            assert not uncovered(found, exact, QUANTITIES)


@pytest.mark.parametrize("later", [1e-4, 3e-4, 1e-3, 4e-3])
def test_an_end_just_behind_the_separation_cuts_nothing(
    later: float, uncovered: Callable[..., dict[str, float]]
) -> None:
    """Coarse steps have the contact last longer than that: they are left out."""
    network = {"E_inf": 2.14e7, "E": [3.36e7, 3.23e6], "tau": [2.02e-3, 1.99e-2], "nu": 0.125}
    striker = {"shape": "power", "coefficient": 0.0557, "exponent": 2.0, "mass": 950.0, "velocity": 5.03}
    target = {"shape": "half_space", "material": {"law": "prony", **network}}
    whole = Scene.from_dict({"striker": striker, "target": target})
    exact = simulate(laws.ting.of(whole), whole, 1e-9)
    ended = replace(whole, motion=Motion(end_time=(1.0 + later) * (exact.quantities["duration"].value or 0.0)))
    found = simulate(laws.mdr.of(ended), ended, 1e-5)
    assert not uncovered(found, exact, (*QUANTITIES, "duration", "restitution"))
