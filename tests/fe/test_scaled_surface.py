"""Slow indentation, its mesh following the contact, against Hertz and Sneddon: force, pressure, rates, penalty bias."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import lumped
from fe_contact.assembly.far_field import boussinesq
from fe_contact.bodies.memory import area_weights, graded
from fe_contact.bodies.pressing import EDGE_WINDOW
from fe_contact.budget.plan import plan
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem, ContactSolution
from fe_contact.errors import ContactLost
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface, Stepper, _missed
from fe_contact.steppers.steps import Strike
from fe_contact.targets import half_space
from lumped import Relaxation
from lumped.shapes import Parabola, Shape, Sphere

corrected, penalty = ENFORCEMENTS.get("corrected"), ENFORCEMENTS.get("penalty")

RNG = np.random.default_rng(2)
POISSON = (0.0, 0.3, 0.49, 0.4999)
PROFILES: list[tuple[Shape, float]] = [(Parabola(1.0), 0.2), (Sphere(1.0), 0.05), (Sphere(1.0), 0.3)]
IN_WINDOW = RNG.uniform(1 - EDGE_WINDOW, 1 + EDGE_WINDOW, 16)
BIAS = -3 / (2 * np.pi)  # of the force, relative, times the penalty in units of modulus over contact radius


@dataclass(frozen=True)
class Indentation:
    """One static contact for E* = 1: relative force error, solution, and the radii of its points."""

    error: float
    solution: ContactSolution
    radii: np.ndarray
    pressure: np.ndarray


def surface(nu: float, elements: float = 4.0, order: int = 4, far_radius: float = 20.0) -> ScaledSurface:
    return ScaledSurface(half_space._whole(nu, elements, order, far_radius).operator)


def indent(
    body: ScaledSurface,
    profile: Shape,
    contact: float,
    phase: float,
    stiffness: float = 1000.0,
    enforcement: ModuleType = corrected,
) -> Indentation:
    """Indent so that the exact edge lies at ``phase`` of the unit mesh."""
    scale, points, curve = contact / phase, body.operator.points, profile.load_curve
    height = np.minimum(profile.height(scale * points), 1e3)
    problem = ContactProblem(body.pressed, float(curve.depth(contact)) - height, stiffness)
    solution = enforcement.enforce(problem, points < phase)
    assert solution.converged
    force = scale * float(body.operator.weights @ solution.pressure)
    error = force / float(curve.force(curve.depth(contact))) - 1
    return Indentation(error, solution, scale * points, solution.pressure / scale)


def worst(body: ScaledSurface, profile: Shape, contact: float, stiffness: float = 1000.0) -> float:
    return max(abs(indent(body, profile, contact, phase, stiffness).error) for phase in IN_WINDOW)


@pytest.fixture(scope="module", params=POISSON)
def body(request: pytest.FixtureRequest) -> ScaledSurface:
    return surface(request.param)


@pytest.mark.parametrize(("profile", "contact"), PROFILES)
def test_the_force_is_exact_wherever_the_edge_lies_in_its_window(
    body: ScaledSurface, profile: Shape, contact: float
) -> None:
    assert worst(body, profile, contact) < (1e-5 if body.operator.poisson <= 0.49 else 3e-5)


def test_a_finer_mesh_gives_nearly_incompressible_bodies_the_same_digits() -> None:
    assert worst(surface(0.4999, elements=8.0), Parabola(1.0), 0.2) < 1e-5


@pytest.mark.parametrize(("profile", "contact"), PROFILES)
def test_edge_and_pressure_are_exact(body: ScaledSurface, profile: Shape, contact: float) -> None:
    for phase in IN_WINDOW[:4]:
        found = indent(body, profile, contact, phase)
        assert found.solution.edge(body.operator.points) == pytest.approx(phase, abs=3e-3)
        exact = profile.load_curve.pressure(found.radii, contact)
        inside = found.radii < 0.7 * contact
        ripple = np.abs(found.pressure - exact)[inside].max() / exact.max()
        assert ripple < 1e-3, "a tenth of the promised one per cent"


def test_an_edge_far_from_the_finest_elements_still_gives_three_digits(body: ScaledSurface) -> None:
    phases = np.random.default_rng(4).uniform(0.3, 0.8, 30)
    errors = [abs(indent(body, Sphere(1.0), 0.2, phase).error) for phase in phases]
    assert np.median(errors) < 1e-3
    assert max(errors) < 3e-3


@pytest.mark.parametrize("order", [2, 3])
def test_the_force_converges_with_the_mesh(order: int) -> None:
    sizes = (2.0, 4.0, 8.0)
    errors = [worst(surface(0.3, n, order, 40.0), Sphere(1.0), 0.3, 1e4) for n in sizes]
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert rates.min() > 2, errors


def test_a_higher_order_is_better_on_the_same_mesh() -> None:
    errors = [worst(surface(0.3, 4.0, order, 40.0), Sphere(1.0), 0.3, 1e4) for order in (1, 2, 3, 4)]
    assert np.all(np.divide(errors[1:], errors[:-1]) < 0.3), errors


@pytest.mark.parametrize(("profile", "contact"), [*PROFILES[:2]])
def test_the_bias_of_the_raw_penalty_is_the_predicted_one(profile: Shape, contact: float) -> None:
    """Elastic layer of compliance 1/penalty under Hertz pressure, to first order; a sphere this small is one."""
    fine = surface(0.3, 8.0, 4, 40.0)
    for phase in IN_WINDOW[:4]:
        for stiffness in (100.0, 400.0):
            error = indent(fine, profile, contact, phase, stiffness, penalty).error
            assert error * stiffness * phase == pytest.approx(BIAS, rel=0.02)


def test_the_raw_penalty_is_of_order_one_and_the_corrected_of_more() -> None:
    fine = surface(0.3, 8.0, 4, 40.0)
    stiffnesses = (50.0, 100.0, 200.0, 400.0, 800.0)
    for phase in IN_WINDOW[:3]:
        raw, mended = (
            np.array([indent(fine, Parabola(1.0), 0.2, phase, k, by).error for k in stiffnesses])
            for by in (penalty, corrected)
        )
        np.testing.assert_allclose(np.log2(raw[:-1] / raw[1:]), 1, atol=0.05)
        observed = np.log2(mended[0] / mended[-1]) / np.log2(stiffnesses[-1] / stiffnesses[0])
        assert observed > 1.2, mended
        assert np.all(np.abs(mended) < 0.1 * np.abs(raw))


@pytest.mark.parametrize("yielding", [0.01, 0.3, 3.0])
def test_a_yielding_striker_is_a_striker_pushed_in_less(body: ScaledSurface, yielding: float) -> None:
    """Two routes: the striker as one more unknown, and held where its own force has put it."""
    points = body.operator.points
    free = 0.04 - Parabola(1.0).height(0.15 * points)
    together = penalty.enforce(ContactProblem(body.pressed, free, 1000.0, yielding), points < 1)
    force = float(body.operator.weights @ together.pressure)
    held = penalty.enforce(ContactProblem(body.pressed, free - yielding * force, 1000.0), points < 1)
    assert force > 0
    np.testing.assert_allclose(together.pressure, held.pressure, atol=1e-8 * held.pressure.max())


def test_the_surface_far_away_moves_as_under_a_point_force(body: ScaledSurface) -> None:
    points = body.operator.points
    pressure = np.sqrt(np.maximum(1 - points**2, 0.0))
    nodal = body.response(pressure)
    force = float(body.operator.weights @ pressure)
    radii = np.array([10.0, 15.0, 19.9, 20.1, 40.0, 300.0])
    found = body.sample(nodal, radii)
    surface_points = np.stack([radii, 0 * radii])
    exact = -boussinesq(surface_points, surface_points, body.operator.poisson)[0][1] * force
    np.testing.assert_allclose(found, exact, rtol=5e-3)
    np.testing.assert_allclose(body.sample(nodal, body.operator.nodes), nodal, atol=1e-12 * nodal.max())


def test_hertz_pressure_gives_the_paraboloid_of_hertz(body: ScaledSurface) -> None:
    """u = (pi/4) p0 (2 - r^2) inside and the arcsine outside, for a = 1 and E* = 1 (Johnson, 3.41-3.42)."""
    points = body.operator.points
    nodal = body.response(np.sqrt(np.maximum(1 - points**2, 0.0)))
    inside, outside = np.linspace(0, 0.99, 30), np.linspace(1.01, 6, 30)
    np.testing.assert_allclose(body.sample(nodal, inside), np.pi / 4 * (2 - inside**2), rtol=5e-4)
    arcs = (2 - outside**2) * np.arcsin(1 / outside) + np.sqrt(outside**2 - 1)
    np.testing.assert_allclose(body.sample(nodal, outside), 0.5 * arcs, rtol=1e-3)


def test_scaling_the_mesh_scales_force_and_pressure_as_the_half_space_does(body: ScaledSurface) -> None:
    """The same contact a thousand times larger: force per squared length, pressure, and edge are the same."""
    small = indent(body, Sphere(1.0), 0.2, 1.01)
    large = indent(body, Sphere(1000.0), 200.0, 1.01)
    assert large.error == pytest.approx(small.error, abs=1e-12)
    np.testing.assert_allclose(large.pressure, small.pressure, atol=1e-9 * small.pressure.max())


def test_a_contact_of_a_few_points_on_a_half_plane_is_found_from_any_guess() -> None:
    """Where a strongly damped contact begins: dents of the step before, and a datum that comes up by more than these.

    Newton's steps alone may go round between three points and four.
    """
    scene = lumped.Scene.load("polymer-half-plane")
    body = half_space.struck(scene.geometry, plan(scene, {"elements_per_contact": 2.0}).numerics)
    points, yielding, rng = body.operator.points, body.operator.yielding, np.random.default_rng(1126)
    for _ in range(40):
        few = int(rng.integers(2, 15))
        overlap = 1.0 - 10 ** rng.uniform(-3, -1) * (points / points[few]) ** 2
        overlap[:few] -= 10 ** rng.uniform(-5, -2) * rng.random(few)
        problem = ContactProblem(body.pressed, overlap, 1e3 / points[few], yielding)
        assert corrected.enforce(problem, points < points[int(rng.integers(1, 40))]).converged


@pytest.mark.parametrize("ratios", [(0.03, 0.4), (3.0, 20.0)])
def test_what_a_straight_line_misses_is_the_faded_rest_of_how_a_gap_closes(ratios: tuple[float, ...]) -> None:
    """As the power 3/2 of the time left: to the arrival, (r^2 - edge^2)/(radius^2 - edge^2) of the step, or beyond."""
    length, edge, radius, radii = 0.7, 0.2, 0.35, np.linspace(0.0, 0.6, 61)
    wide = np.where(radii > edge, 0.5 * radii**2 - 0.019, 0.0)
    narrow = np.where(radii > radius, wide * (0.1 + 0.5 * radii), 0.0)
    before, after = (
        SimpleNamespace(depth=depth, memory=SimpleNamespace(strain=np.stack([gap + depth - 0.5 * radii**2, gap])))
        for depth, gap in ((0.02, wide), (0.06, narrow))
    )
    relaxation = Relaxation(1.0, (1.0, 2.0), tuple(length / ratio for ratio in ratios))
    stepper = SimpleNamespace(radii=radii, heights=0.5 * radii**2, relaxation=relaxation)
    made_up: Any = (stepper, before, SimpleNamespace(state=after, length=length, radius=radius))
    found = _missed(*made_up, edge)
    shares = (np.arange(4000) + 0.5) / 4000.0
    for place, first, last, missed in zip(radii, wide, narrow, found.T, strict=True):
        if place <= edge:
            assert not missed.any()
            continue
        reached = (place**2 - edge**2) / (radius**2 - edge**2)
        arrival = reached if place < radius else 1.0 / (1.0 - (last / first) ** (2.0 / 3.0))
        detour = first * np.maximum(1.0 - shares / arrival, 0.0) ** 1.5 - (first + shares * (last - first))
        for ratio, one in zip(ratios, missed, strict=True):
            exact = -ratio * np.mean(np.exp(-ratio * (1.0 - shares)) * detour)
            assert one == pytest.approx(exact, abs=5e-3 * ratio * first), (place, ratio)


class Settling:
    """A mesh scaled until the contact found on it ends where it is finest: what is found there is made up.

    ``edges``: of the contact, on the unit mesh, attempt after attempt.
    """

    def __init__(self, edges: Iterator[float], steps: int = 1) -> None:
        self.tried = list[float]()
        scale = 0.1
        points = np.linspace(0.05, 4.0, 80)

        def enforce(problem: Any, *guesses: Any) -> Any:
            self.tried.append(next(edges))
            edge = self.tried[-1]
            return SimpleNamespace(converged=True, iterations=3, sets=(points < edge,), edge=lambda at: edge)

        stepper: Any = SimpleNamespace(
            surface=SimpleNamespace(operator=SimpleNamespace(points=points), pressed=None),
            radii=np.array([0.0, 1e3]),
            strike=SimpleNamespace(height=lambda radii: 0.5 * radii**2),
            numerics=SimpleNamespace(penalty=1.0, contact_radius=scale),
            enforcement=SimpleNamespace(enforce=enforce, solves=2, nodewise=False),
            _expected_radius=lambda *of: scale,
            _guesses=lambda steps: (),
            _centred=lambda solution: (),
        )
        stepper._problem, stepper._solved = partial(Stepper._problem, stepper), partial(Stepper._solved, stepper)
        inertia: Any = SimpleNamespace(state=SimpleNamespace(time=0.0), free_depth=0.01, give=0.0, length=1.0)
        law: Any = SimpleNamespace(now=1.0)
        before: Any = [SimpleNamespace(radius=scale)] * steps
        self.run = lambda: Stepper._settle(stepper, inertia, before, law, np.zeros(2))


@pytest.mark.parametrize("off", [0.019, -0.019])
def test_a_contact_that_ends_within_two_hundredths_of_the_finest_place_is_settled(off: float) -> None:
    """At once; one a little further off once more, on a mesh that is as much wider or narrower."""
    settled = Settling(iter([1.0 + off]))
    scale, edge, _, work = settled.run()
    assert (scale, edge) == (0.1, 1.0 + off)
    assert (work.contact_problems, work.steps, work.iterations) == (2, 1, 3)
    settled = Settling(iter([1.0 + 1.2 * off, 1.0]))
    scale, edge, _, work = settled.run()
    assert scale == pytest.approx(0.1 * (1.0 + 1.2 * off))
    assert (edge, work.contact_problems, work.iterations) == (1.0, 4, 6)


def test_an_edge_that_jitters_is_settled_once_it_does_so_by_a_little_more_than_it_may() -> None:
    """From the ninth rescaling on the window widens by half each time: what jitters less and less is not hurried."""
    settled = Settling(1.0 + 0.5 * 0.8**number * (-1) ** number for number in range(60))
    _, edge, _, _ = settled.run()
    assert 9 < len(settled.tried) <= 13
    assert abs(edge - 1.0) < 0.05
    settled = Settling(itertools.cycle([1.1, 1.0 / 1.1]))
    settled.run()
    assert len(settled.tried) <= 14, "one that does not cease is settled too"


@pytest.mark.parametrize(("steps", "smallest"), [(1, 1e-4), (0, 1e-8)])
def test_a_contact_that_only_shrinks_is_lost(steps: int, smallest: float) -> None:
    """By three tenths at once at most: at a ten thousandth of its last radius; a first one, hardly known, later."""
    settled = Settling(itertools.repeat(0.1), steps)
    with pytest.raises(ContactLost):
        settled.run()
    assert 0.3 ** len(settled.tried) < smallest <= 0.3 ** (len(settled.tried) - 1)


def test_a_surface_remembers_a_pressure_with_all_of_its_force_and_none_beyond_its_points() -> None:
    """Hertz's on a unit mesh that is scaled: 1/scale of it a place, scale times of the force."""
    scale, points = 0.2, np.linspace(0.01, 3.0, 300)
    pressure = np.sqrt(np.maximum(1.0 - points**2, 0.0))
    weights = 2.0 * np.pi * points * np.gradient(points)
    radii = graded(1.0, 400)
    stepper: Any = SimpleNamespace(
        surface=SimpleNamespace(operator=SimpleNamespace(points=points, weights=weights)),
        radii=radii,
        areas=area_weights(radii),
    )
    spread = Stepper._spread(stepper, pressure, scale)
    assert stepper.areas @ spread == pytest.approx(scale * weights @ pressure, rel=1e-12)
    inside = radii < 0.95 * scale
    assert spread[inside] == pytest.approx(np.sqrt(1.0 - (radii[inside] / scale) ** 2) / scale, rel=0.02)
    assert not spread[radii > 3.0 * scale].any()
    assert not Stepper._spread(stepper, np.zeros(300), scale).any()
    stepper.radii = np.array([0.0, 5.0])
    stepper.areas = np.array([0.0, 1.0])
    assert Stepper._spread(stepper, pressure, scale) == pytest.approx([1.0 / scale, 0.0], rel=0.01), "no area sees it"


def test_a_step_expects_its_contact_as_a_like_march_has_told_or_its_square_to_go_on_as_it_did() -> None:
    """a^2 = t (1 - t/2), a parabola from the touch on; at least a twentieth of the last area is left."""

    def after(*times: float) -> Any:
        return [SimpleNamespace(radius_time=time, radius=np.sqrt(time * (1.0 - 0.5 * time))) for time in times]

    def expected(told: Sequence[float], steps: Any, time: float, velocity: float, length: float) -> float:
        stepper: Any = SimpleNamespace(expected=told, scheme=SimpleNamespace(sample=0.25))
        state: Any = SimpleNamespace(velocity=velocity, time=time)
        return Stepper._expected_radius(stepper, state, steps, length)

    assert expected((), [], 0.0, 1.0, 0.1) == 0.0
    assert expected((0.3, 0.4), [], 0.0, 1.0, 0.1) == 0.3
    assert expected((0.3, 0.4), after(0.1), 0.1, 1.0, 0.1) == 0.4
    for steps in (after(0.1, 0.2), after(0.1, 0.25, 0.4)):
        last = steps[-1].radius_time
        growing, receding = (expected((0.3, 0.4), steps, last, velocity, 0.2) for velocity in (1.0, -1.0))
        for found, time in ((growing, last + 0.2), (receding, last + 0.05)):
            assert found == pytest.approx(np.sqrt(time * (1.0 - 0.5 * time)))
    vanishing = after(1.0, 1.5, 1.9)
    assert expected((), vanishing, 1.9, 1.0, 1.0) == pytest.approx(np.sqrt(0.05) * vanishing[-1].radius)


def test_the_surfaces_part_by_the_gap_between_what_is_remembered_and_the_striker() -> None:
    """And what the striker does on the way there it does not do on the body: force x way less pressure x dent."""
    stepper: Any = SimpleNamespace(heights=np.array([0.0, 0.3, 0.9]), areas=np.array([1.0, 2.0, 3.0]))
    surface: Any = SimpleNamespace(strain=np.array([[0.5, 0.2, 0.0], [9.0, 9.0, 9.0]]))
    assert Stepper.clearance(stepper, surface, 0.4) == pytest.approx([0.1, 0.1, 0.5])
    stepper._spread = lambda pressure, scale: scale * pressure
    later = SimpleNamespace(depth=0.7, memory=SimpleNamespace(strain=surface.strain + np.array([[0.1], [5.0]])))
    solution = SimpleNamespace(pressure=np.array([4.0, 2.0, 0.0]))
    before: Any = SimpleNamespace(depth=0.4, memory=surface)
    step: Any = SimpleNamespace(state=later, solution=solution, scale=0.5, force=6.0)
    assert Stepper.between(stepper, before, step) == pytest.approx(6.0 * 0.3 - 0.5 * (4.0 * 1.0 + 2.0 * 2.0) * 0.1)


@pytest.mark.parametrize("steps", [40, 4000])
def test_a_memory_reaches_beyond_the_largest_contact_and_has_places_for_every_step(
    steps: int, hertz_strike: Callable[..., Strike], settings_of: Callable[..., Numerics]
) -> None:
    """A third farther than that at most, or it would be coarser than it says, and no fewer than five places a step."""
    strike = hertz_strike()
    numerics = settings_of(strike, steps=steps)
    stepper = Stepper(strike, surface(0.3), numerics)
    assert 1.1 < stepper.radii[-1] / numerics.contact_radius < 1.0 + 1.0 / 3.0
    assert max(500, 5 * steps) < stepper.radii.size <= max(1000, 10 * steps)
    assert stepper.heights == pytest.approx(0.5 * stepper.radii**2)
    assert stepper.areas.sum() == pytest.approx(np.pi * stepper.radii[-1] ** 2, rel=1e-2)
    later = replace(strike, memory=stepper.at_rest())
    again = Stepper(later, surface(0.3), numerics.varied(steps=8 * steps))
    assert again.radii == pytest.approx(stepper.radii), "of a contact before"
