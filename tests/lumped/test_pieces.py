"""The pieces of the laws with memory: their polynomials, and what every law says of the force alone."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest
from numpy.polynomial import chebyshev as reference

from lumped import Scene, simulate
from lumped.errors import FeContactError
from lumped.laws import correspondence, ting
from lumped.laws._hereditary import FEW, MORE, once, problem_of
from lumped.laws.base import simulation
from lumped.numbers import Array
from lumped.result.result import Result
from lumped.solvers.hereditary.march import Settings
from lumped.solvers.hereditary.path import ByField, Path, chebyshev
from lumped.solvers.hereditary.pieces import Followed, alone, together
from lumped.solvers.hereditary.rebound import Rebound


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


@pytest.mark.parametrize("length", [1e-3, 1.0, 1e3])
def test_a_time_that_begins_and_ends_as_a_square_is_placed_as_well_as_rounding_tells(length: float) -> None:
    """t = s^2 (3 - 2 s) over the share s of the way, (2 + 3 x - x^3)/4 over x = 2 s - 1; places end at zero."""
    series = reference.poly2cheb([0.5, 0.75, 0.0, -0.25])
    clock = ByField(Path(np.array([-length, 0.0]), series[None, None], 0.0))
    near = np.geomspace(1e-7, 0.5, 400)
    share = np.concatenate([near, 1.0 - near])
    found = clock.place(share**2 * (3.0 - 2.0 * share)) / length + 1.0
    assert np.all(np.abs(found - share) < 2e-15 / (6.0 * share * (1.0 - share)))


@pytest.mark.parametrize("law", [ting, correspondence])
def test_the_force_alone_is_that_of_the_columns(law: ModuleType, impact: Callable[..., Scene]) -> None:
    """Also where the striker has come to rest, after the last piece."""
    for scene in (impact(0.5, (0.5,), (0.3,)), impact(0.0, viscosity=1.0, profile="parabola")):
        answer = once(scene, 1e-6, law.solve)
        times = np.union1d(answer.rows(scene), np.linspace(0.0, 1.1 * answer.times[-1], 300))
        assert answer.columns.force(times) == pytest.approx(answer.columns(times)[2], rel=1e-12)


SPHERE, LAYER, RING = "polymer-sphere", "polymer-layer", "rod-in-ring"
PRONY = {"law": "prony", "E_inf": 1e6, "E": [1e6, 5e5], "tau": [1e-3, 1e-2], "nu": 0.45}
SOLID = {"law": "kelvin_voigt", "E": 1e6, "eta": 2e3, "nu": 0.45}
COMPANY: list[tuple[str, dict[str, object]]] = [
    (SPHERE, {"striker.velocity": 0.01}), (SPHERE, {"striker.velocity": 0.013}), (SPHERE, {"striker.velocity": 0.031}),
    (SPHERE, {"striker.radius": 0.01}), (SPHERE, {"striker.velocity": 0.2}),
    (SPHERE, {"target.material": PRONY}), (SPHERE, {"target.material": SOLID}),
    (SPHERE, {"target.material": SOLID, "model.gravity": 9.81}), ("polymer-cone", {}), (LAYER, {}), (RING, {}),
]  # fmt: skip


@pytest.mark.parametrize("law", [ting, correspondence])
def test_an_impact_is_the_same_to_the_bit_in_any_company(law: ModuleType) -> None:
    scenes = [Scene.load(name, keys) for name, keys in COMPANY]
    found = [simulate(law.of(scene), scene, 1e-3) for scene in scenes]
    for order in (range(len(scenes)), [10, 1, 0, 3, 2, 5, 1, 7, 6, 4, 9, 8]):
        company = together(simulation(law.of(scenes[i]), scenes[i], 1e-3) for i in order)
        for i, one in zip(order, company, strict=True):
            assert one.quantities == found[i].quantities, COMPANY[i]
            assert np.array_equal(one.history.force, found[i].history.force), COMPANY[i]
            assert one.work == found[i].work


def test_impacts_of_one_kind_cost_no_more_calls_than_the_one_that_needs_most(monkeypatch: pytest.MonkeyPatch) -> None:
    scenes = [Scene.load(SPHERE, {"striker.velocity": speed}) for speed in np.linspace(0.01, 0.04, 9)]
    calls, inverse = list[int](), np.linalg.inv

    def counted(matrices: Array) -> object:
        calls.append(len(matrices))
        return inverse(matrices)

    monkeypatch.setattr(np.linalg, "inv", counted)
    apart = [once(scene, 1e-6, correspondence.solve) for scene in scenes]
    each = len(calls)
    together(simulation(correspondence.of(scene), scene, 1e-3) for scene in scenes)
    assert len(calls) - each < 0.5 * each
    assert max(calls) == len(apart)


@pytest.mark.parametrize("rtol", [1e-5, 1e-9])
@pytest.mark.parametrize(("name", "keys"), [COMPANY[0], COMPANY[5], COMPANY[6], *COMPANY[8:]])
def test_pieces_solved_again_with_more_nodes_begin_from_what_the_few_found(
    name: str, keys: dict[str, object], rtol: float
) -> None:
    """The bar costs one Newton step a piece, or two: three or more without."""
    problem = problem_of(scene := Scene.load(name, keys))
    few, more = Settings(rtol, FEW), Settings(rtol, MORE)
    first = alone(ting.solve(problem, scene.end_time / problem.scales.time, few))
    again = alone(ting.solve(problem, scene.end_time / problem.scales.time, more, first))
    assert isinstance(first.outward, Rebound)
    assert isinstance(again.outward, Rebound)
    for before, after in ((first.inward, again.inward), (first.outward, again.outward)):
        pieces = after.path.breaks.size - 1
        assert before.path.breaks.size - 1 == pieces
        assert after.steps <= 2 * pieces


def test_an_impact_that_fails_takes_none_with_it() -> None:
    """Depths beyond a load curve are tried by one of them alone."""
    scenes = [Scene.load(LAYER, {"striker.velocity": speed}) for speed in (0.01, 0.02, 2.0)]

    def asked(scene: Scene) -> Followed[Result | FeContactError]:
        try:
            return (yield from simulation(correspondence.of(scene), scene, 1e-3))
        except FeContactError as failure:
            return failure

    well, also, failed = together(map(asked, scenes))
    assert isinstance(failed, FeContactError), failed
    for scene, one in zip(scenes, (well, also), strict=False):
        assert isinstance(one, Result), one
        assert one.quantities == simulate(correspondence.of(scene), scene, 1e-3).quantities
