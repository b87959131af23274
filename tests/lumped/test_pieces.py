"""The pieces of the laws with memory: their polynomials, and what every law says of the force alone."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest
from numpy.polynomial import chebyshev as reference

from lumped import Scene
from lumped.laws import correspondence, ting
from lumped.laws._hereditary import once
from lumped.solvers.hereditary.path import Path, chebyshev


def test_polynomials_are_chebyshev_s_of_few_places_and_of_many() -> None:
    rng = np.random.default_rng(4)
    for count in (2, 3, 13, 19, 32):
        for places in (np.array([-1.0, 0.0, 1.0]), rng.uniform(-1.0, 1.0, 300)):
            exact = reference.chebvander(places, count - 1).T
            assert chebyshev(places, count) == pytest.approx(exact, rel=0.0, abs=1e-13)


def test_a_path_says_the_same_of_one_place_and_of_many() -> None:
    rng = np.random.default_rng(5)
    path = Path(np.cumsum(rng.uniform(0.1, 1.0, 6)), rng.normal(size=(5, 4, 13)), 2.0)
    places = np.sort(rng.uniform(path.breaks[0], path.breaks[-1], 200))
    whole = path.at(places)
    for field in range(4):
        assert path.value(field, places) == pytest.approx(whole[field], rel=0.0, abs=1e-12)
        assert path.samples(field) == pytest.approx(path.at(path.places)[field], rel=0.0, abs=1e-12)
    for i in (0, 77, 199):
        assert path.state(places[i]) == pytest.approx(whole[:, i], rel=0.0, abs=1e-12)


@pytest.mark.parametrize("law", [ting, correspondence])
def test_the_force_alone_is_that_of_the_columns(law: ModuleType, impact: Callable[..., Scene]) -> None:
    """Also where the striker has come to rest, after the last piece."""
    for scene in (impact(0.5, (0.5,), (0.3,)), impact(0.0, viscosity=1.0, profile="parabola")):
        answer = once(scene, 1e-6, law.solve)
        times = np.union1d(answer.rows(scene), np.linspace(0.0, 1.1 * answer.times[-1], 300))
        assert answer.columns.force(times) == pytest.approx(answer.columns(times)[2], rel=1e-12)
