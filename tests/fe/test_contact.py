"""The contact Newton on random problems: the conditions of contact, any start, and honest failure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.optimize import minimize

from fe_contact.bodies.pressing import _place, contact_end
from fe_contact.contact import problem as contact
from fe_contact.contact.enforcement.base import ENFORCEMENTS, Enforcement
from fe_contact.contact.problem import ContactProblem, ContactSolution, PressedSurface, moved, solve

augmented, corrected, exact, penalty = (
    ENFORCEMENTS.get(name) for name in ("augmented", "corrected", "exact", "penalty")
)

SEEDS = st.integers(0, 2**32 - 1)


def random_problem(seed: int) -> ContactProblem:
    """Positive definite stiffness of any condition to 1e6, some points open, penalty over six decades."""
    rng = np.random.default_rng(seed)
    unknowns, points = int(rng.integers(1, 12)), int(rng.integers(1, 40))
    basis, _ = np.linalg.qr(rng.normal(size=(unknowns, unknowns)))
    stiffness = basis * 10 ** rng.uniform(-3, 3, unknowns) @ basis.T
    return ContactProblem(
        surface=PressedSurface(
            stiffness=(stiffness + stiffness.T) / 2,
            trace=rng.normal(size=(points, unknowns)),
            weights=10 ** rng.uniform(-2, 1, points),
        ),
        overlap=rng.normal(size=points) + rng.uniform(-1, 1),
        penalty=float(10 ** rng.uniform(-2, 4)),
    )


def displacement(surface: PressedSurface, pressure: np.ndarray) -> np.ndarray:
    """Of the surface under a pressure."""
    return np.asarray(np.linalg.solve(surface.stiffness, surface.trace.T @ (surface.weights * pressure)))


def energy(problem: ContactProblem, displacement: np.ndarray, retreat: float = 0.0) -> float:
    """What contact minimises: strain of the body, spring that stands for the striker's mass, penalty."""
    surface = problem.surface
    pressed = np.maximum(problem.overlap - surface.trace @ displacement - retreat, 0)
    strain = displacement @ surface.stiffness @ displacement + (retreat and retreat**2 / problem.yielding)
    return 0.5 * float(strain + problem.penalty * (surface.weights @ pressed**2))


def starts(seed: int, problem: ContactProblem) -> list[np.ndarray]:
    """Empty, full and random active sets."""
    rng = np.random.default_rng(seed)
    points = len(problem.overlap)
    return [np.zeros(points, bool), np.ones(points, bool), *(rng.random((4, points)) < 0.5)]


@pytest.mark.parametrize("yielding", [0.0, 0.3])
@given(seed=SEEDS)
def test_the_energy_on_the_way_is_what_contact_minimises_and_half_of_force_times_overlap(
    seed: int, yielding: float
) -> None:
    """Of forces and the displacement that belongs to them; the half where the contact is found (Clapeyron)."""
    problem = replace(random_problem(seed), yielding=yielding)
    p = solve(problem, np.ones(len(problem.overlap), bool)).pressure
    forces = problem.surface.weights * p
    point = contact._Point(forces, yielding * float(forces.sum()), p / problem.penalty)
    found, size = point.energy(problem), 1e-9 * float(np.abs(forces) @ np.abs(problem.overlap))
    assert found == pytest.approx(energy(problem, displacement(problem.surface, p), point.retreat), abs=size)
    assert found == pytest.approx(0.5 * float(forces @ problem.overlap), abs=size)


@given(SEEDS)
def test_a_pressure_found_exactly_is_one_that_both_bodies_can_follow(seed: int) -> None:
    """Of some of the shape functions, where two bodies have no others in common."""
    problem = random_problem(seed)
    some = problem.surface.trace[:, : max(1, min(problem.surface.trace.shape) // 2)]
    problem = replace(problem, surface=replace(problem.surface, carriers=some))
    found = exact.enforce(problem, np.ones(len(problem.overlap), bool)).signed_pressure
    left = found - some @ np.linalg.lstsq(some, found, rcond=None)[0]
    assert np.abs(left).max() <= 1e-9 * max(np.abs(found).max(), 1e-300)


@given(SEEDS)
def test_the_solution_meets_the_conditions_of_contact(seed: int) -> None:
    """Balance of the body; pressure where it touches, gap where it does not, never both."""
    problem = random_problem(seed)
    for start in starts(seed, problem):
        solution = solve(problem, start)
        assert solution.converged
        surface, p = problem.surface, solution.pressure
        x = displacement(surface, p)
        load = surface.trace.T @ (surface.weights * p)
        size = np.abs(surface.trace.T) @ (surface.weights * p) + np.abs(surface.stiffness) @ np.abs(x)
        assert np.all(np.abs(surface.stiffness @ x - load) <= 1e-9 * size.max(initial=1e-300))
        left = problem.overlap - surface.trace @ x
        scale = np.abs(problem.overlap).max() + (np.abs(surface.trace) @ np.abs(x)).max()
        assert np.all(p >= 0)
        np.testing.assert_allclose(p / problem.penalty, np.maximum(left, 0), atol=1e-8 * scale)


@given(SEEDS, st.floats(4.0, 12.0))
def test_what_claims_to_have_converged_balances_whatever_the_penalty(seed: int, decades: float) -> None:
    """Beyond the digits there are, an answer is refused: never one that its own pressure does not leave."""
    problem = replace(random_problem(seed), penalty=10.0**decades)
    for start in starts(seed, problem):
        solution = solve(problem, start)
        if not solution.converged or not solution.pressure.any():
            continue
        left = problem.overlap - problem.surface.trace @ displacement(problem.surface, solution.pressure)
        pressing = np.abs(problem.overlap[solution.pressure > 0.0]).max()
        assert np.abs(left - solution.signed_pressure / problem.penalty).max() <= 1e-5 * pressing


@pytest.mark.parametrize(("off", "balances"), [(1e-7, True), (1e-4, False)])
def test_whether_an_answer_balances_is_a_question_of_what_presses_whatever_stands_open(
    off: float, balances: bool
) -> None:
    """Two springs of stiffness 2, pressed in by one: a penalty of 3 leaves 2/5. Past a rim points are far away."""
    surface = PressedSurface(2.0 * np.eye(3), np.eye(3), np.ones(3))
    problem = ContactProblem(surface, np.array([1.0, 1.0, -1e3]), 3.0)
    assert contact._balances(problem, np.array([0.4, 0.4 + off, -1e3])) == balances


def test_a_penalty_beyond_all_digits_is_refused() -> None:
    """All random surfaces answer where digits are left, few without."""
    problems = [random_problem(seed) for seed in range(60)]
    share = {}
    for stiffness in (1e4, 1e12):
        stiff = [replace(problem, penalty=stiffness) for problem in problems]
        share[stiffness] = np.mean([solve(one, np.ones(len(one.overlap), bool)).converged for one in stiff])
    assert share[1e4] == 1.0
    assert share[1e12] < 0.3


@given(SEEDS)
def test_every_cold_start_reaches_the_same_answer(seed: int) -> None:
    problem = random_problem(seed)
    found = [solve(problem, start) for start in starts(seed, problem)]
    reference = displacement(problem.surface, found[0].pressure)
    scale = np.sqrt(reference @ problem.surface.stiffness @ reference) + 1e-12
    for other in found[1:]:
        away = displacement(problem.surface, other.pressure) - reference
        assert np.sqrt(max(away @ problem.surface.stiffness @ away, 0.0)) <= 1e-7 * scale


@given(SEEDS)
def test_points_and_nodes_tell_the_same(seed: int) -> None:
    """The forces of the springs found from the compliance of the points, or from the stiffness of the nodes."""
    rng = np.random.default_rng(seed)
    problem = replace(random_problem(seed), yielding=float(rng.choice([0.0, 0.7])))
    surface = replace(problem.surface, recurring=False)
    yields = surface.trace @ np.linalg.solve(surface.stiffness, surface.trace.T)
    by_points = replace(surface, compliance=(yields + yields.T) / 2)
    start = rng.random(surface.weights.size) < 0.5
    for guarded in (contact.UNGUARDED, 1):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(contact, "UNGUARDED", guarded)
            one, other = (solve(replace(problem, surface=seen), start) for seen in (surface, by_points))
        assert one.converged == other.converged
        scale = np.abs(one.signed_pressure).max()
        np.testing.assert_allclose(other.signed_pressure, one.signed_pressure, atol=1e-7 * scale)


@given(SEEDS)
def test_the_line_search_reaches_the_same_answer_as_plain_newton(seed: int) -> None:
    problem = random_problem(seed)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(contact, "UNGUARDED", 1)
        guarded = [solve(problem, start) for start in starts(seed, problem)]
    reference = solve(problem, np.ones(len(problem.overlap), bool)).pressure
    for solution in guarded:
        assert solution.converged
        np.testing.assert_allclose(solution.pressure, reference, atol=1e-7 * reference.max(initial=1e-12))


@given(SEEDS)
def test_the_solution_is_the_least_energy_that_a_general_minimiser_finds(seed: int) -> None:
    problem = random_problem(seed)
    solution = solve(problem, np.zeros(len(problem.overlap), bool))
    found = displacement(problem.surface, solution.pressure)
    lowest = energy(problem, found)
    rng = np.random.default_rng(seed)
    guess = minimize(lambda x: energy(problem, x), found + rng.normal(size=len(found)), method="BFGS")
    assert lowest <= guess.fun * (1 + 1e-9) + 1e-15
    nearby = found + 1e-3 * rng.normal(size=(10, len(found)))
    assert all(energy(problem, x) >= lowest * (1 - 1e-12) for x in nearby)


@given(SEEDS)
def test_a_yielding_striker_is_one_more_spring(seed: int) -> None:
    """Two routes: the striker's retreat in closed form, and as one more unknown of the surface."""
    problem = random_problem(seed)
    yielding = float(10 ** np.random.default_rng(seed).uniform(-3, 2))
    size = len(problem.surface.stiffness)
    bordered = np.zeros((size + 1, size + 1))
    bordered[:size, :size], bordered[size, size] = problem.surface.stiffness, 1 / yielding
    trace = np.column_stack([problem.surface.trace, np.ones(len(problem.overlap))])
    whole = replace(problem, surface=PressedSurface(bordered, trace, problem.surface.weights))
    start = np.zeros(len(problem.overlap), bool)
    found, wanted = solve(replace(problem, yielding=yielding), start), solve(whole, start)
    scale = wanted.pressure.max(initial=1e-12)
    np.testing.assert_allclose(found.pressure, wanted.pressure, atol=1e-8 * scale)
    retreat = yielding * float(problem.surface.weights @ found.pressure)
    moved = displacement(problem.surface, found.pressure)
    stored = energy(replace(problem, yielding=yielding), moved, retreat)
    assert stored == pytest.approx(energy(whole, np.append(moved, retreat)), rel=1e-9, abs=1e-15)


@given(SEEDS)
def test_forces_that_count_by_their_place_move_the_striker(seed: int) -> None:
    """A place that comes up by so much per force at each point: the same as a striker moved by what it came up.

    Forces that count nearly alike, as those of a small contact do, are found from any start.
    """
    problem, rng = random_problem(seed), np.random.default_rng(seed)
    problem = replace(problem, surface=replace(problem.surface, recurring=False))
    unlike = float(10 ** rng.uniform(-9, -1))
    per_force = float(10 ** rng.uniform(-3, 0)) * rng.uniform(1 - unlike, 1 + unlike, len(problem.overlap))
    several = [solve(replace(problem, yielding=per_force), start) for start in starts(seed, problem)]
    found = several[-1]
    assert unlike > 1e-6 or all(one.converged for one in several)
    assume(found.converged)  # what counts so unlike has no energy: Newton may cycle, and says so
    retreat = float((per_force * problem.surface.weights) @ found.pressure)
    wanted = solve(replace(problem, overlap=problem.overlap - retreat), found.pressure > 0.0)
    scale = wanted.pressure.max(initial=1e-12)
    np.testing.assert_allclose(found.pressure, wanted.pressure, atol=1e-7 * scale)


@given(SEEDS)
def test_pushing_deeper_never_lowers_the_total_response(seed: int) -> None:
    """More free overlap everywhere: the energy that contact stores cannot fall."""
    problem = random_problem(seed)
    deeper = replace(problem, overlap=problem.overlap + 0.3)
    start = np.ones(len(problem.overlap), bool)
    stored = [energy(p, displacement(p.surface, solve(p, start).pressure)) for p in (problem, deeper)]
    assert stored[1] >= stored[0]


def test_an_exhausted_budget_is_flagged(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact, "MAX_ITERATIONS", 1)
    flagged = 0
    for seed in range(50):
        problem = random_problem(seed)
        solution = solve(problem, np.zeros(len(problem.overlap), bool))
        settled = not np.any(problem.overlap > 0)  # the empty set was the answer
        assert solution.converged == settled
        flagged += not solution.converged
    assert flagged > 25


@pytest.mark.parametrize("name", ENFORCEMENTS.names)
def test_every_enforcement_passes_the_flag_on(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = random_problem(3)
    touching = np.zeros(len(problem.overlap), bool)
    assert ENFORCEMENTS.get(name).enforce(problem, touching).converged
    monkeypatch.setattr(contact, "MAX_ITERATIONS", 1)
    assert not ENFORCEMENTS.get(name).enforce(problem, touching).converged


@pytest.mark.parametrize("enforcement", [penalty, exact])
def test_a_contact_that_loses_one_node_at_a_time_is_found_however_many_it_has_to_lose(enforcement: Enforcement) -> None:
    """A string held far away over a parabola: while it clings to the flank, the outermost node alone is pulled off."""
    nodes, far = 50, 1e3
    stiffness = 2.0 * np.eye(nodes) - np.eye(nodes, k=1) - np.eye(nodes, k=-1)
    stiffness[0, 0], stiffness[-1, -1] = 1.0, 1.0 + 1.0 / far
    surface = PressedSurface(stiffness, np.eye(nodes), np.ones(nodes))
    parabola = 1.0 - (np.arange(nodes) / nodes) ** 2
    found = enforcement.enforce(ContactProblem(surface, parabola, 1e6), np.ones(nodes, bool))
    assert found.converged
    assert found.iterations == 1 + nodes - np.count_nonzero(found.pressure)


@pytest.mark.parametrize("name", ENFORCEMENTS.names)
def test_every_enforcement_counts_its_contact_problems(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    member, calls = ENFORCEMENTS.get(name), []

    def counted(problem: ContactProblem, touching: np.ndarray) -> ContactSolution:
        calls.append(solve(problem, touching))
        return calls[-1]

    module = f"fe_contact.contact.enforcement.{name}.solve"
    monkeypatch.setattr(module, counted, raising=name != "exact")  # which has a solver of its own
    problem = random_problem(3)
    solution = member.enforce(problem, np.zeros(len(problem.overlap), bool))
    assert solution.converged
    assert len(calls) <= member.solves
    if name in ("penalty", "corrected"):
        assert len(calls) == member.solves
    if name != "exact":
        assert solution.iterations == sum(call.iterations for call in calls)


@given(SEEDS)
def test_one_augmented_update_is_closer_to_rigid_contact_than_the_raw_penalty(seed: int) -> None:
    """Rigid contact is the limit of the penalty: here ten thousand times stiffer.

    Only where there are no more points than unknowns: else rigid contact at every point is over-determined.
    """
    rng = np.random.default_rng(seed)
    unknowns = int(rng.integers(2, 10))
    points = int(rng.integers(1, unknowns + 1))
    basis, _ = np.linalg.qr(rng.normal(size=(unknowns, unknowns)))
    surface = PressedSurface(
        stiffness=basis * rng.uniform(1, 3, unknowns) @ basis.T,
        trace=np.eye(unknowns)[:points],
        weights=rng.uniform(0.5, 2, points),
    )
    problem = ContactProblem(surface, rng.uniform(0.1, 1, points), float(10 ** rng.uniform(2, 3)))
    everywhere = np.ones(points, bool)
    rigid = solve(replace(problem, penalty=1e4 * problem.penalty), everywhere).pressure
    raw = np.abs(penalty.enforce(problem, everywhere).pressure - rigid).max()
    mended = np.abs(corrected.enforce(problem, everywhere).pressure - rigid).max()
    assert mended < 0.2 * raw


@given(SEEDS)
def test_exact_contact_is_the_limit_of_the_augmented_lagrangian(seed: int) -> None:
    """Two routes to a surface that nothing enters, and its conditions: no overlap, no tension, never both."""
    rng = np.random.default_rng(seed)
    unknowns, points = (int(n) for n in np.sort(rng.integers(1, 10, 2))[::-1])
    chain = np.diag(rng.uniform(1, 3, unknowns)) - 0.4 * (np.eye(unknowns, k=1) + np.eye(unknowns, k=-1))
    surface = PressedSurface(chain, np.eye(unknowns)[:points], rng.uniform(0.5, 2, points))
    problem = ContactProblem(surface, rng.uniform(-1, 1, points), float(10 ** rng.uniform(1, 2)))
    for start in starts(seed, problem):
        found, wanted = exact.enforce(problem, start), augmented.enforce(problem, start)
        assert found.converged
        assert wanted.converged
        left = problem.overlap - surface.trace @ displacement(surface, found.pressure)
        np.testing.assert_allclose(found.pressure, wanted.pressure, atol=1e-7)
        np.testing.assert_allclose(np.where(found.pressure > 0.0, left, np.maximum(left, 0.0)), 0.0, atol=1e-10)


@given(SEEDS)
def test_more_points_than_nodes_end_without_overlap_in_the_mean_or_with_a_flag(seed: int) -> None:
    """Rigid contact at every point is over-determined: the overlap left is what no shape feels."""
    problem = random_problem(seed)
    surface, found = problem.surface, augmented.enforce(problem, np.zeros(len(problem.overlap), bool))
    left = problem.overlap - surface.trace @ displacement(surface, found.pressure)
    beyond = found.signed_pressure - surface.in_shapes(found.pressure)
    penalty = float(beyond @ left) / float(left @ left)
    scale = np.abs(found.signed_pressure).max() + penalty * np.abs(problem.overlap).max()
    assert not found.converged or np.abs(beyond - penalty * left).max() <= 1e-6 * scale


@given(SEEDS)
def test_the_shapes_of_a_pressure_lose_no_force_on_the_surface(seed: int) -> None:
    surface, rng = random_problem(seed).surface, np.random.default_rng(seed)
    pressure = rng.normal(size=surface.weights.size)
    shaped = surface.in_shapes(pressure)
    forces, wanted = (surface.trace.T @ (surface.weights * p) for p in (shaped, pressure))
    np.testing.assert_allclose(forces, wanted, atol=1e-10 * np.abs(wanted).max())
    np.testing.assert_allclose(surface.in_shapes(shaped), shaped, atol=1e-10 * np.abs(shaped).max())


def test_exact_contact_knows_that_a_rigid_striker_is_no_shape_of_the_pressure() -> None:
    """One more column, the same everywhere, is a second body's retreat: the same as that retreat in closed form."""
    size = 4
    surface = PressedSurface(np.eye(size) * 3.0, np.eye(size), np.ones(size))
    problem = ContactProblem(surface, np.array([1.0, 0.5, 0.2, -1.0]), 1.0, yielding=0.3)
    bordered = np.diag([*np.full(size, 3.0), 1 / 0.3])
    whole = PressedSurface(bordered, np.column_stack([np.eye(size), np.ones(size)]), surface.weights)
    start = problem.overlap > 0.0
    found = exact.enforce(replace(problem, surface=whole, yielding=0.0), start)
    np.testing.assert_allclose(found.pressure, exact.enforce(problem, start).pressure, atol=1e-12)


def test_the_edge_lies_where_the_pressure_returns_to_zero() -> None:
    points = np.array([0.1, 0.5, 0.9, 1.3])

    def edge(*pressure: float) -> float:
        return ContactSolution(np.array(pressure), 1, True, ()).edge(points)

    assert edge(3, 2, 1, -1) == pytest.approx(1.1)
    assert edge(3, 2, 3, -1) == pytest.approx(1.2)
    assert edge(-1, -2, -3, -4) == 0
    assert edge(1, 1, 1, 1) == np.inf
    assert edge(-1, 2, -2, -3) == pytest.approx(0.7), "a hole at the axis does not hide the edge"


@pytest.mark.parametrize("failing", [0, 1])
def test_one_solve_of_two_that_fails_fails_the_correction(failing: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A multiplier that no contact left would be taken for the softness of the penalty."""
    calls: list[ContactSolution] = []

    def fails_once(problem: ContactProblem, touching: np.ndarray) -> ContactSolution:
        calls.append(replace(solve(problem, touching), converged=len(calls) != failing))
        return calls[-1]

    monkeypatch.setattr("fe_contact.contact.enforcement.corrected.solve", fails_once)
    problem = random_problem(3)
    assert not corrected.enforce(problem, np.ones(len(problem.overlap), bool)).converged


@pytest.mark.parametrize("name", ENFORCEMENTS.names)
@given(SEEDS)
def test_a_stiffer_body_presses_as_much_harder_over_the_same_contact(name: str, seed: int) -> None:
    """Nor has it a modulus of its own, where surfaces part neither: what is missing to touch counts in one unit."""
    rng, enforce = np.random.default_rng(seed), ENFORCEMENTS.get(name).enforce
    unknowns = int(rng.integers(2, 10))
    chain = np.diag(rng.uniform(1, 3, unknowns)) - 0.4 * (np.eye(unknowns, k=1) + np.eye(unknowns, k=-1))
    surface, start = PressedSurface(chain, np.eye(unknowns), rng.uniform(0.5, 2, unknowns)), np.ones(unknowns, bool)
    problem = ContactProblem(surface, rng.uniform(-1, 1, unknowns), 1e3)
    stiffer = ContactProblem(replace(surface, stiffness=1e6 * chain), problem.overlap, 1e9)
    one, other = (enforce(which, start).signed_pressure for which in (problem, stiffer))
    np.testing.assert_allclose(other / 1e6, one, atol=1e-9 * np.abs(one).max())


@pytest.mark.parametrize("name", ENFORCEMENTS.names)
@given(SEEDS)
def test_a_larger_overlap_of_the_same_form_presses_as_much_harder(name: str, seed: int) -> None:
    """No threshold decides what touches: contact without adhesion has no size of its own, at any number of metres."""
    rng, enforce = np.random.default_rng(seed), ENFORCEMENTS.get(name).enforce
    unknowns, points = (int(n) for n in np.sort(rng.integers(1, 10, 2))[::-1])
    chain = np.diag(rng.uniform(1, 3, unknowns)) - 0.4 * (np.eye(unknowns, k=1) + np.eye(unknowns, k=-1))
    surface = PressedSurface(chain, np.eye(unknowns)[:points], rng.uniform(0.5, 2, points))
    problem = ContactProblem(surface, rng.uniform(-1, 1, points), 1e3)
    start = np.ones(points, bool)
    one = enforce(problem, start).pressure
    for size in (1e-9, 1e9):
        pressed = enforce(replace(problem, overlap=size * problem.overlap), start)
        assert pressed.converged
        np.testing.assert_allclose(pressed.pressure / size, one, atol=1e-9 * np.abs(one).max())


@given(SEEDS)
def test_the_set_where_one_solve_ends_and_the_next_begins_is_factorised_once(seed: int) -> None:
    """No more factorisations than sets were tried, less the one that both solves share."""
    problem = random_problem(seed)
    problem, factorised = replace(problem, surface=replace(problem.surface, recurring=False)), list[int]()

    def counted(matrix: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        factorised.append(len(matrix))
        return original(matrix)

    original = contact.factorised
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(contact, "factorised", counted)
        solution = corrected.enforce(problem, problem.overlap > 0.0)
    assert solution.converged
    assert len(factorised) < solution.iterations


@given(st.floats(0.2, 0.7), st.floats(-0.5, 0.5), st.floats(0.0, 1.0))
def test_a_gap_tells_where_the_surfaces_part(edge: float, bend: float, guess: float) -> None:
    """A gap like the 3/2 power of the distance from the edge, and a term more, from a pressure that ends nearby."""
    points = (np.arange(200) + 0.5) / 200
    distance = np.maximum(points - edge, 0.0)
    gap = (distance + bend * distance**2) ** 1.5
    assert contact_end(points, edge * (1.0 + 0.02 * guess), gap, points**2) == pytest.approx(edge, rel=1e-9)


@given(SEEDS)
def test_a_guess_that_gains_or_loses_points_stays_where_the_contact_is(seed: int) -> None:
    """From the axis outwards, or on both sides of a middle that a crown has: by as many points here as there."""
    rng = np.random.default_rng(seed)
    points = int(rng.integers(20, 60))
    start, end = (int(one) for one in np.sort(rng.choice(np.arange(6, points - 6), 2, replace=False)))
    by = int(rng.integers(start - end + 1, 6))
    places = np.arange(points)
    around = np.flatnonzero(moved((places >= start) & (places < end), by))
    np.testing.assert_array_equal(np.diff(around), 1)
    assert around.size == end - start + by
    assert abs((around[0] + around[-1]) - (start + end - 1)) <= 1
    np.testing.assert_array_equal(np.flatnonzero(moved(places < end, by)), np.arange(end + by))


@pytest.mark.parametrize("power", [0.5, 1.5, 4.0])
def test_a_place_is_found_again_from_the_rise_of_a_profile_there(power: float) -> None:
    """Exact for any power of the radius, from the first point to the last; none beyond, where nothing is known."""
    points = (np.arange(20) + 0.5) / 20
    rise = points**power
    for place in np.linspace(points[0], points[-1], 100):
        assert _place(points, rise, place**power) == pytest.approx(place, rel=1e-12)
    assert _place(points, rise, 0.5 * rise[0]) == points[0]
    assert _place(points, rise, 2.0 * rise[-1]) == points[-1]


@given(st.floats(0.01, 1.0))
def test_beside_a_flat_end_a_place_is_found_along_a_line(share: float) -> None:
    points = (np.arange(20) + 0.5) / 20
    rise = np.maximum(points - points[9], 0.0)
    value = points[9] + share * (points[10] - points[9])
    assert _place(points, rise, value - points[9]) == pytest.approx(value, rel=1e-12)
