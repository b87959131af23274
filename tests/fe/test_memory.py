"""Memory of the surface against the hereditary integral written out, and the balance of its energies."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_contact.bodies.memory import SurfaceMemory, area_weights, graded, interpolate, product, step_law
from fe_contact.schemes.base import SCHEMES, MemoryScheme
from lumped.materials import Relaxation

backward_euler, galerkin = SCHEMES.get("backward_euler"), SCHEMES.get("galerkin")

SEEDS = st.integers(0, 2**32 - 1)
RADII = np.linspace(0.0, 2.0, 7)
AREA = area_weights(RADII)


def random_relaxation(rng: np.random.Generator) -> Relaxation:
    """Zero to four branches, relaxation times from far below to far above the steps, perhaps a viscosity."""
    branches = int(rng.integers(0, 5))
    return Relaxation(
        float(rng.uniform(0.1, 1)),
        tuple(rng.uniform(0, 3, branches)),
        tuple(10 ** rng.uniform(-3, 2, branches)),
        float(rng.choice([0.0, rng.uniform(0, 2)])),
    )


def random_path(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Lengths of steps (n,), some a hundred times longer than others, and strains (n, 2, r) at their ends."""
    steps = 10 ** rng.uniform(-2, 0, int(rng.integers(1, 25)))
    return steps, rng.normal(size=(len(steps), 2, RADII.size)).cumsum(axis=0)


def hereditary(relaxation: Relaxation, steps: np.ndarray, strains: np.ndarray, average: bool) -> np.ndarray:
    """Stress of every step by the O(n^2) sum over all ramps before it: at the step's end, or its average.

    A ramp of length s that ended at time e leaves E tau (1 - exp(-s/tau)) exp(-(t - e)/tau) in a branch; within
    the step itself the branch grows as a ramp does. Every term is positive: nothing cancels.
    """
    increments = np.diff(strains, axis=0, prepend=0)
    share = 0.5 if average else 1.0
    now = strains - (1 - share) * increments
    stress = relaxation.equilibrium * now + relaxation.viscosity * increments / steps[:, None, None]
    for modulus, tau in zip(relaxation.moduli, relaxation.times, strict=True):
        x = steps / tau
        left = -np.expm1(-x) / x  # of a unit increment, at its ramp's end
        since = np.array([[sum(steps[j + 1 : n]) for j in range(len(steps))] for n in range(len(steps))])
        fade = np.exp(-since / tau) * (left if average else np.exp(-x))[:, None]
        weights = np.tril(left * fade, k=-1)
        series = 1 / 2 - x * (1 / 6 - x * (1 / 24 - x * (1 / 120 - x / 720)))
        within = np.where(x < 1e-2, series, (1 - left) / x) if average else left
        stress = stress + modulus * np.tensordot(weights + np.diag(within), increments, axes=1)
    return stress


def recursion(
    relaxation: Relaxation, scheme: MemoryScheme, steps: np.ndarray, strains: np.ndarray
) -> tuple[np.ndarray, list[SurfaceMemory]]:
    """Stress of every step as the march finds it, and the states between the steps."""
    states, stresses = [SurfaceMemory.at_rest(AREA, relaxation, fields=2)], []
    for step, strain in zip(steps, strains, strict=True):
        law = step_law(relaxation, scheme, step)
        stresses.append(law.now * strain + states[-1].carried(law))
        states.append(states[-1].advanced(law, strain))
    return np.array(stresses), states


@pytest.mark.parametrize("scheme", [galerkin, backward_euler])
@given(seed=SEEDS)
def test_the_recursion_equals_the_hereditary_integral(scheme: MemoryScheme, seed: int) -> None:
    rng = np.random.default_rng(seed)
    relaxation, (steps, strains) = random_relaxation(rng), random_path(rng)
    found, states = recursion(relaxation, scheme, steps, strains)
    exact = hereditary(relaxation, steps, strains, average=scheme is galerkin)
    assert np.abs(found - exact).max() <= 1e-12 * np.abs(exact).max()
    np.testing.assert_allclose([s.strain for s in states[1:]], strains, atol=1e-10 * np.abs(strains).max())


@given(SEEDS)
def test_a_memory_without_energies_remembers_the_same_displacement(seed: int) -> None:
    rng = np.random.default_rng(seed)
    relaxation, (steps, strains) = random_relaxation(rng), random_path(rng)
    full = SurfaceMemory.at_rest(AREA, relaxation, fields=2)
    lean = SurfaceMemory.at_rest(AREA, relaxation, fields=1)
    for step, strain in zip(steps, strains, strict=True):
        law = step_law(relaxation, galerkin, step)
        carried = full.carried(law)[0]
        np.testing.assert_allclose(lean.carried(law)[0], carried, atol=1e-13 * np.abs(carried).max())
        full, lean = full.advanced(law, strain), lean.advanced(law, strain[:1])


@given(SEEDS)
def test_work_is_stored_or_turned_into_heat_in_every_step(seed: int) -> None:
    """The Petrov-Galerkin step: mean stress on the change of displacement, to rounding, whatever the step."""
    rng = np.random.default_rng(seed)
    relaxation, (steps, strains) = random_relaxation(rng), random_path(rng)
    stresses, states = recursion(relaxation, galerkin, steps, strains)
    for step, stress, before, after in zip(steps, stresses, states[:-1], states[1:], strict=True):
        work = product(AREA, stress, after.strain - before.strain)
        change = after.stored(relaxation) - before.stored(relaxation)
        heat = before.dissipated(after, relaxation, step)
        size = sum(np.abs(part).max() for part in (stress, before.strain, after.strain)) ** 2
        assert abs(work - change - heat) <= 1e-10 * max(size, abs(change), abs(heat))


@given(SEEDS)
def test_dashpots_only_ever_heat(seed: int) -> None:
    """On fields whose pressure follows from their displacement by a positive operator."""
    rng = np.random.default_rng(seed)
    relaxation, (steps, strains) = random_relaxation(rng), random_path(rng)
    strains[:, 1] = 3 * strains[:, 0]
    _, states = recursion(relaxation, galerkin, steps, strains)
    pairs = zip(steps, states[:-1], states[1:], strict=True)
    heats = [before.dissipated(after, relaxation, step) for step, before, after in pairs]
    assert min(heats) >= -1e-12 * max(max(heats), 1.0)
    assert all(state.stored(relaxation) >= 0 for state in states)


@given(SEEDS)
def test_an_elastic_surface_forgets_nothing_and_heats_nothing(seed: int) -> None:
    rng = np.random.default_rng(seed)
    steps, strains = random_path(rng)
    elastic = Relaxation(2.0)
    stresses, states = recursion(elastic, galerkin, steps, strains)
    middles = (strains + np.concatenate([np.zeros((1, 2, RADII.size)), strains[:-1]])) / 2
    np.testing.assert_allclose(stresses, 2.0 * middles, atol=1e-12 * np.abs(strains).max())
    assert all(a.dissipated(b, elastic, 1.0) == 0 for a, b in pairwise(states))


@pytest.mark.parametrize("scheme", [galerkin, backward_euler])
def test_a_fast_branch_is_a_dashpot_and_a_slow_one_a_spring(scheme: MemoryScheme) -> None:
    rng = np.random.default_rng(0)
    steps, strains = random_path(rng)
    fast = Relaxation(1.0, (1e9 * 0.7,), (1e-9,)), Relaxation(1.0, viscosity=0.7)
    slow = Relaxation(1.0, (0.7,), (1e9,)), Relaxation(1.7)
    for branch, limit in (fast, slow):
        found, _ = recursion(branch, scheme, steps, strains)
        exact, _ = recursion(limit, scheme, steps, strains)
        np.testing.assert_allclose(found, exact, atol=1e-6 * np.abs(exact).max())


@given(SEEDS)
def test_interpolation_reproduces_cubics_between_the_points(seed: int) -> None:
    """Of the root of the radius, among them a cone's straight line."""
    rng = np.random.default_rng(seed)
    reach = float(10 ** rng.uniform(-3, 1))
    cubic = np.polynomial.Polynomial(rng.normal(size=4) / np.sqrt(reach) ** np.arange(4))
    known = graded(reach, 12)
    wanted = np.append(rng.uniform(0, known[-1], 30), [0.0, known[-1]])
    found = interpolate(cubic(np.sqrt(known)), reach, wanted)
    np.testing.assert_allclose(found, cubic(np.sqrt(wanted)), atol=1e-11 * np.abs(cubic(np.sqrt(known))).max())


def test_interpolation_is_of_order_four() -> None:
    wanted = np.linspace(0.11, 0.93, 77)
    errors = []
    for points in (21, 41, 81):
        known = graded(1.0, points)
        errors.append(np.abs(interpolate(np.exp(3 * known), 1.0, wanted) - np.exp(3 * wanted)).max())
    assert np.log2(np.divide(errors[:-1], errors[1:])).min() > 3.5


@given(SEEDS)
def test_the_product_is_symmetric_and_bilinear(seed: int) -> None:
    first, second, third = np.random.default_rng(seed).normal(size=(3, 2, RADII.size))
    assert product(AREA, first, second) == pytest.approx(product(AREA, second, first), rel=1e-14)
    together = product(AREA, first + 2 * third, second)
    assert together == pytest.approx(product(AREA, first, second) + 2 * product(AREA, third, second), abs=1e-12)


def test_the_area_weights_integrate_over_the_surface() -> None:
    """The area of the disc exactly; a smooth field with the square of the spacing."""
    assert area_weights(np.linspace(0, 3.0, 11)).sum() == pytest.approx(9 * np.pi, rel=1e-14)
    errors = []
    for points in (41, 81, 161):
        radii = np.linspace(0, 3, points)
        errors.append(abs(area_weights(radii) @ np.exp(-(radii**2)) / (np.pi * -np.expm1(-9)) - 1))
    assert np.log2(np.divide(errors[:-1], errors[1:])).min() > 1.9
