"""The pieces of the laws with memory: their polynomials, and what every law says of the force alone."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import chebyshev as reference
from numpy.polynomial import legendre

from lumped import Scene, simulate
from lumped.errors import FeContactError, NotReached
from lumped.laws import correspondence, ting
from lumped.laws._hereditary import FEW, MORE, once, problem_of
from lumped.laws.base import simulation
from lumped.numbers import Array
from lumped.result.result import Result
from lumped.solvers.hereditary.march import HereditaryMarch, Settings, Stretch, tail
from lumped.solvers.hereditary.path import ByField, Path, chebyshev
from lumped.solvers.hereditary.pieces import (
    FORCE,
    Followed,
    HereditaryPiece,
    PieceAsked,
    Pieces,
    alone,
    over_root,
    together,
)
from lumped.solvers.hereditary.rebound import Rebound
from lumped.solvers.radau import (
    CAUTION,
    LONGEST,
    SHORTEST,
    STAGES,
    chebyshev_through_zero,
    place_of,
    radau,
    through_zero,
)


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


@pytest.mark.parametrize("level", [-1.7, 0.0, 0.6])
def test_a_field_falls_to_a_level_where_its_last_piece_first_reaches_it(level: float) -> None:
    """1 - s^2, s from the start of that piece to 2, which the piece before falls to as well; at its end it is -3."""
    before, last = np.array([0.0, -2.0, 0.0]), reference.poly2cheb([0.0, -2.0, -1.0])
    path = Path(np.array([0.0, 1.0, 3.0]), np.array([before, last])[:, None], 3.0)
    assert path.fall(0, level) == pytest.approx(1.0 + np.sqrt(1.0 - level), rel=1e-14)
    assert path.fall(0, -3.1) is None


@pytest.mark.parametrize("count", [1, 2, 3, 8, 12, 16, 18])
def test_the_nodes_integrate_polynomials_as_well_as_rounding_tells(count: int) -> None:
    """Over the step up to the power 2 s - 2, to every node up to s - 1; s of two and of three are in every table."""
    nodes, powers, root = radau(count), np.arange(count), 6.0**0.5
    known = {2: [1.0 / 3.0, 1.0], 3: [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0]}.get(count, nodes.points)
    assert nodes.points == pytest.approx(known, rel=2e-16, abs=0.0)
    assert (nodes.points[-1], nodes.power, nodes.begun, nodes.mirrored) == (1.0, 1, 0.0, False)
    whole = np.arange(2 * count - 1)
    assert nodes.weights @ nodes.points[:, None] ** whole == pytest.approx(1.0 / (whole + 1.0), rel=0.0, abs=1e-15)
    values, risen = (nodes.points[:, None] ** (powers + more) for more in (0, 1))
    assert nodes.once @ values == pytest.approx(risen / (powers + 1), rel=0.0, abs=2e-15)
    assert nodes.twice @ values == pytest.approx(nodes.once @ (nodes.once @ values), rel=0.0, abs=1e-14)
    assert nodes.leaving @ values == pytest.approx(powers, rel=0.0, abs=1e-11)
    place = np.linspace(-1.0, 1.0, 7)
    of_values, of_integral = nodes.series @ values, values.T @ nodes.series.T @ nodes.first
    at = 0.5 * (place[:, None] + 1.0)
    found, integrals = legendre.legval(place, of_values).T, legendre.legval(place, of_integral.T).T
    assert found == pytest.approx(at**powers, rel=0.0, abs=1e-11)
    assert integrals == pytest.approx(at ** (powers + 1) / (powers + 1), rel=0.0, abs=1e-11)
    through = through_zero(at[:, 0], count) @ np.append(0.0, nodes.points)[:, None] ** np.arange(count + 1)
    assert through == pytest.approx(at ** np.arange(count + 1), rel=0.0, abs=1e-11)
    whole = np.append(0.0, nodes.points)[:, None] ** np.arange(count + 1)
    by_chebyshev = reference.chebval(place, chebyshev_through_zero(count) @ whole).T
    assert by_chebyshev == pytest.approx(at ** np.arange(count + 1), rel=0.0, abs=1e-11)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize(("power", "begun"), [(2, 0.0), (2, 0.7), (5, 0.3), (1, 0.4)])
def test_graded_nodes_run_through_a_root_of_the_time(power: int, begun: float, mirrored: bool) -> None:
    """(share + begun)^(1/p) goes evenly with the place, from the end where mirrored: integrals are exact."""
    nodes = radau(12).graded(power, begun, mirrored)
    share = 1.0 - nodes.points if mirrored else nodes.points
    place = 1.0 - nodes.places if mirrored else nodes.places
    low, high = begun ** (1.0 / power), (1.0 + begun) ** (1.0 / power)
    assert nodes.roots == (low, high)
    assert (share + begun) ** (1.0 / power) == pytest.approx(low + (high - low) * place, rel=1e-13)
    assert nodes.weights @ nodes.pace == pytest.approx(1.0, rel=1e-13)
    assert nodes.weights @ (nodes.pace * nodes.points) == pytest.approx(0.5, rel=1e-12)
    assert nodes.once @ nodes.pace == pytest.approx(nodes.points, rel=1e-11)
    assert nodes.twice @ nodes.pace == pytest.approx(0.5 * nodes.points**2, rel=1e-9)
    ones = np.ones(nodes.points.size)
    found = place_of(nodes.points, power * ones, begun * ones, np.full(ones.size, mirrored))
    assert found == pytest.approx(nodes.places, rel=1e-12)


@pytest.mark.parametrize(("power", "begun"), [(2, 0.0), (3, 0.7)])
def test_steps_of_the_same_root_follow_and_are_tried_again(power: int, begun: float) -> None:
    """Of a step from time 2 to 5 with its root begun before: half its root's length again, or as much after it.

    What is rougher by the eighth power asks for as much a shorter root, less what is left to chance; none is free.
    """
    nodes, length = radau(8).graded(power, begun), 3.0

    def rooted(share: float) -> float:
        return float((begun + share) ** (1.0 / power))

    whole = rooted(1.0) - rooted(0.0)
    for ratio in (0.5, 1.0, 1.5):
        rough = (CAUTION / ratio) ** STAGES
        assert rooted(nodes.again(rough)) - rooted(0.0) == pytest.approx(ratio * whole, rel=1e-12)
        assert rooted(1.0 + nodes.following(rough)) - rooted(1.0) == pytest.approx(ratio * whole, rel=1e-12)
        other = radau(8).graded(power, begun, mirrored=True).again(rough)
        assert other == pytest.approx(1.0 - nodes.again(rough), rel=1e-12, abs=1e-12)
    assert nodes.again(CAUTION**STAGES) * length == pytest.approx(length, rel=1e-14)
    for rough, longest in ((0.0, LONGEST), (1e30, SHORTEST)):
        after = rooted(1.0 + nodes.following(rough)) - rooted(1.0)
        assert after == pytest.approx(longest ** (1.0 / power) * whole, rel=1e-12)


def marched(force: Callable[[Array], Array], span: tuple[float, float], first: float, **more: Any) -> HereditaryMarch:
    """Through a known force, its only field, that ends with the span; every piece takes two of Newton's steps."""

    def attempt(place: float, length: float, state: Array) -> Followed[HereditaryPiece | None]:
        yield from ()
        places = place + length * np.append(0.0, settings.table.points)
        return HereditaryPiece(force(places)[None], 2)

    settings = Settings(1e-9, 8)
    stretch = Stretch(attempt, 0, lambda values: False)
    return alone(stretch.march(span, force(np.array([span[0]])), first, settings, **more))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_pieces_are_as_long_as_a_share_of_the_largest_force_so_far_allows(sign: float) -> None:
    """Of a force that rises to 50 and falls to a thousandth: short pieces are made where it bends, long ones then."""

    def force(places: Array) -> Array:
        return np.asarray(sign * (50.0 * np.exp(-((places - 3.0) ** 2)) + 1e-3))

    found = marched(force, (0.0, 9.0), 1e-3)
    assert (found.over, found.stuck, found.steps) == (False, False, 2 * len(found.path.coefficients))
    assert found.path.breaks[[0, -1]].tolist() == [0.0, 9.0]
    nodes = np.append(0.0, radau(8).points)
    places = found.path.breaks[:-1, None] + np.diff(found.path.breaks)[:, None] * nodes
    heights = np.maximum.accumulate(np.abs(force(places)).max(axis=1))
    assert found.largest == heights[-1]
    errors = np.array([tail(row) for row in force(places)]) / heights
    assert np.all(errors <= 1e-9), "none is longer"
    lengths = np.diff(found.path.breaks)
    assert lengths[1] <= lengths[0], "little is known of what begins"
    assert np.all(lengths[1:] <= 3.0 * lengths[:-1] * (1.0 + 1e-9)), "no leaps"
    lengths = lengths[1:-1]
    allowed = np.clip(0.8 * (errors[1:-2] / 1e-9) ** (-1.0 / 8.0), 0.15, 3.0) * lengths[:-1]
    tried = np.array([np.abs(np.log(length / (guess * 0.8 ** np.arange(3)))).min() for length, guess in
                      zip(lengths[1:], allowed, strict=True)])  # fmt: skip
    assert np.count_nonzero(tried[allowed > 0.0] < 1e-9) > 0.5 * tried.size, "and most are as long as the last one says"
    assert found.largest == pytest.approx(50.001, rel=1e-3)


@pytest.mark.parametrize("bent", [0, 1])
def test_pieces_are_as_short_as_the_time_asks_where_that_is_sought_too(bent: int) -> None:
    """Of two fields, the force and the time, of which one is straight: each by its own largest of the piece."""

    def fields(places: Array) -> Array:
        curved, straight = np.exp(-((places - 3.0) ** 2)) + 0.1, 0.01 * places + 0.1
        return np.array([curved, straight] if bent == 0 else [straight, curved])

    def attempt(place: float, length: float, state: Array) -> Followed[HereditaryPiece | None]:
        yield from ()
        return HereditaryPiece(fields(place + length * np.append(0.0, radau(8).points)), 1)

    stretch = Stretch(attempt, 0, lambda values: False, 1)
    found = alone(stretch.march((0.0, 9.0), fields(np.zeros(1))[:, 0], 0.1, Settings(1e-6, 8))).path
    nodes = np.append(0.0, radau(8).points)
    curves = [fields(begin + (end - begin) * nodes)[bent] for begin, end in pairwise(found.breaks)]
    heights = [row[-1] for row in curves] if bent else np.maximum.accumulate([row.max() for row in curves])
    errors = np.array([tail(row) for row in curves]) / heights
    assert errors.max() <= 1e-6
    assert np.median(errors) > 1e-8, "and hardly shorter"


@pytest.mark.parametrize("longest", [0.3, 0.011])
def test_a_piece_without_a_solution_is_tried_at_a_quarter_of_its_length(longest: float) -> None:
    """And where none has one, however short, the march is stuck there, or has not begun."""
    tried = list[float]()

    def attempt(place: float, length: float, state: Array) -> Followed[HereditaryPiece | None]:
        yield from ()
        tried.append(length)
        solved = length < longest and place + length < 4.0
        return HereditaryPiece(np.ones((1, 9)), 1) if solved else None

    stretch = Stretch(attempt, 0, lambda values: False)
    found = alone(stretch.march((0.0, 9.0), np.ones(1), 1.0, Settings(1e-6, 8)))
    assert found.stuck
    assert found.path.breaks[-1] == pytest.approx(4.0, abs=1e-9)
    quarters = 4.0 ** -np.ceil(np.log(1.0 / longest) / np.log(4.0))
    assert found.path.breaks[1] == pytest.approx(quarters, rel=1e-12)
    failed = [later / length for length, later in pairwise(tried) if later < length and length > 1e-6]
    assert set(np.round(failed, 9)) == {0.25}
    with pytest.raises(NotReached, match="from its very start"):
        alone(stretch.march((5.0, 9.0), np.ones(1), 1.0, Settings(1e-6, 8)))


def test_the_breaks_of_a_path_found_before_are_kept() -> None:
    """Whatever its own errors would ask for."""
    before = marched(np.cos, (0.0, 9.0), 0.1).path
    again = marched(lambda places: np.cos(0.1 * places), (0.0, 9.0), 0.1, before=before)
    assert np.array_equal(again.path.breaks, before.breaks)


def test_a_largest_force_so_far_is_what_errors_are_shares_of() -> None:
    """Of a force that was a thousand before: pieces are longer, and it is still the largest."""
    force = np.cos
    alone_, after = (marched(force, (0.0, 9.0), 0.1, largest=known) for known in (0.0, 1e3))
    assert len(after.path.coefficients) < len(alone_.path.coefficients)
    assert (alone_.largest, after.largest) == (1.0, 1e3)


def test_one_more_of_newton_s_steps_would_change_a_solved_piece_by_rounding() -> None:
    """From guesses that are nothing, near and far."""
    problem, table = problem_of(Scene.load(SPHERE)), radau(12)
    asked = PieceAsked(problem, table, over_root, 0.0, 0.4, problem.early(np.zeros(1))[:, 0])
    pieces = Pieces.of([asked])
    for guess in (0.0, 0.3, 5.0):
        (found,) = pieces.solved(np.full((1, 12), guess))
        assert found is not None
        a = problem.gravity - found.values[FORCE, 1:]
        assert np.abs(pieces.iterate(a[None]).change).max() < 1e-12 * np.abs(a).max()


def test_pieces_solved_together_are_those_solved_alone_to_the_bit() -> None:
    """Whoever needs more of Newton's steps: the others are left as they were, and say how many they took."""
    asked, guesses = list[PieceAsked](), (0.0, 0.3, 5.0, 40.0)
    for k, velocity in enumerate((0.01, 0.013, 0.031, 0.02)):
        problem = problem_of(Scene.load(SPHERE, {"striker.velocity": velocity, "striker.radius": 0.01 * (k + 1)}))
        start = problem.early(np.array([1e-4]))[:, 0]
        asked.append(PieceAsked(problem, radau(8), over_root, 0.01, 0.3 * (k + 1), start))
    forces = np.array([np.full(8, guess) for guess in guesses])
    company = Pieces.of(asked).solved(forces)
    single = [Pieces.of([one]).solved(force[None])[0] for one, force in zip(asked, forces, strict=True)]
    assert [one is None for one in company] == [one is None for one in single]
    taken = list[int]()
    for one, other in zip(company, single, strict=True):
        if one is not None and other is not None:
            assert np.array_equal(one.values, other.values)
            assert one.steps == other.steps
            taken.append(one.steps)
    assert len(set(taken)) > 1, "not all alike"


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


@pytest.mark.family
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
