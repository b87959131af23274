"""What a surface remembers: of a load, and between two contacts without force; against quadrature and exponentials."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.linalg import expm

from lumped import Relaxation, Sphere
from lumped.solvers.point.bodies import Bodies, State
from lumped.solvers.point.memory import FreeSurface, HeldSurface, HereditaryLoad, StepLoad, reset
from lumped.solvers.radau import NODES

Array = NDArray[np.float64]


def rates(modulus: Relaxation) -> Array:
    """d/dt of (y, w_1 ... w_K) with E_glassy y + eta y' = sum E_k w_k and w_k' = (y - w_k)/tau_k; eta > 0."""
    moduli, times = np.array(modulus.moduli), np.array(modulus.times)
    matrix = np.zeros((1 + moduli.size, 1 + moduli.size))
    matrix[0] = np.array([-modulus.glassy, *moduli]) / modulus.viscosity
    matrix[1:, 0], matrix[1:, 1:] = 1.0 / times, -np.diag(1.0 / times)
    return matrix


def test_a_free_surface_and_its_memories_follow_the_exponential_of_their_matrix() -> None:
    rng = np.random.default_rng(15)
    for _ in range(40):
        terms = int(rng.integers(1, 5))
        moduli, times = rng.uniform(0.05, 5.0, terms), 10.0 ** rng.uniform(-2.0, 1.0, terms)
        modulus = Relaxation(float(rng.choice([0.0, 1.0])), tuple(moduli), tuple(times), float(rng.uniform(0.1, 1.0)))
        memory = rng.uniform(0.0, 1e-7, terms)
        load = HereditaryLoad(Sphere(0.006).load_curve, modulus)
        last = State(float(rng.uniform(1e-6, 2e-5)), -0.01, 0.0, tuple(memory))
        surface = FreeSurface.of(load, last)
        start = np.array([float(load.load(last.depth)), *memory])
        for time in 10.0 ** rng.uniform(-3.0, 1.0, 3):
            exact = expm(rates(modulus) * time) @ start
            assert surface.at(time) == pytest.approx(exact, rel=0.0, abs=1e-10 * start.max()), (modulus, time)
        times = 10.0 ** rng.uniform(-3.0, 1.0, (2, 3))
        many = surface.at(times)
        assert many[:, 1, 2] == pytest.approx(surface.at(times[1, 2]), rel=1e-12)
        assert many.shape == (1 + terms, 2, 3)


def test_without_a_dashpot_beside_it_no_force_is_left_at_any_time() -> None:
    """A fluid of one term keeps its dent: its matrix has one eigenvalue, zero, with one eigenvector."""
    rng = np.random.default_rng(16)
    for terms in (1, 1, 2, 4):
        for relaxed in (0.0, 0.7):
            moduli, times = rng.uniform(0.05, 5.0, terms), 10.0 ** rng.uniform(-2.0, 1.0, terms)
            load = HereditaryLoad(Sphere(0.006).load_curve, Relaxation(relaxed, tuple(moduli), tuple(times)))
            surface = FreeSurface.of(load, State(1e-5, -0.01, 0.0, tuple(rng.uniform(0.0, 1e-7, terms))))
            for time in (0.0, 1e-3, 0.1, 20.0):
                y, *memories = surface.at(time)
                assert load.modulus.glassy * y == pytest.approx(moduli @ memories, rel=1e-9)
            if terms == 1 and relaxed == 0.0:
                assert surface.at(5.0) == pytest.approx(surface.at(0.0), rel=1e-12)


NETWORK = Relaxation(0.4, (1.5, 0.7), (0.3, 5.0), 0.2)


def test_a_load_within_a_step_is_remembered_as_its_integral_over_the_past_says() -> None:
    """w(t) = w(0) e^(-t/tau) + int y e^(-(t-s)/tau) ds/tau, y of a depth that grows evenly, by scipy's quadrature."""
    load, begun, length = HereditaryLoad(Sphere(0.006).load_curve, NETWORK), (2e-7, 1e-7), 0.5
    deep = float(load.load(1e-5))

    def depth(time: Array) -> Array:
        return 1e-5 + 2e-6 * time

    def exact(time: float, before: float, tau: float) -> float:
        fed = quad(lambda s: float(load.load(depth(s))) / deep * np.exp((s - time) / tau) / tau, 0.0, time)[0]
        return before * np.exp(-time / tau) + deep * float(fed)

    step, times = StepLoad.of(load, begun, length, NODES), length * NODES.points
    memories = [[exact(time, *of) for time in times] for of in zip(begun, NETWORK.times, strict=True)]
    assert step.memories(depth(times)) == pytest.approx(np.array(memories), rel=1e-9)
    y, slope = load.load_and_slope(depth(times))
    force = 2.6 * y - np.array([1.5, 0.7]) @ memories + 0.2 * slope * 3.0
    assert step.force(depth(times), np.full(times.size, 3.0)) == pytest.approx(force, rel=1e-9)


def test_tangents_of_a_load_are_slopes_of_its_force_by_depths_and_rates() -> None:
    """A force feels all depths of its step, and its own rate; above the surface nothing."""
    load = HereditaryLoad(Sphere(0.006).load_curve, NETWORK)
    step, small = StepLoad.of(load, (2e-7, 1e-7), 0.5, NODES), 1e-10
    depth, rate = np.linspace(1e-5, 2e-5, NODES.points.size), np.linspace(3e-5, 1e-5, NODES.points.size)
    over_depth, over_rate = step.tangents(depth, rate)
    rows = small * np.eye(depth.size)
    slopes = np.array([(step.force(depth + row, rate) - step.force(depth - row, rate)) / (2.0 * small) for row in rows])
    assert over_depth == pytest.approx(slopes.T, rel=1e-6, abs=1e-6 * np.abs(slopes).max())
    faster = (step.force(depth, rate + small) - step.force(depth, rate - small)) / (2.0 * small)
    assert over_rate == pytest.approx(faster, rel=1e-6)
    assert step.tangents(-depth, rate)[1] == pytest.approx(np.zeros(depth.size))
    assert float(load.load(-1e-5)) == 0.0


def test_what_a_surface_held_in_its_place_remembers_fades_by_the_time_of_each_branch() -> None:
    load = HereditaryLoad(Sphere(0.006).load_curve, NETWORK)
    surface = HeldSurface.of(load, State(1e-5, -0.01, 0.0, (2e-7, 1e-7)))
    times = np.array([[0.0, 0.3], [1.0, 7.0]])
    found = surface.at(times)
    assert np.all(found[0] == 0.0)
    assert found[1:] == pytest.approx(np.stack([2e-7 * np.exp(-times / 0.3), 1e-7 * np.exp(-times / 5.0)]), rel=1e-12)


@pytest.mark.parametrize("speed", [0.05, 0.5])
def test_a_surface_made_flat_again_is_met_at_depth_zero_without_memory_or_never(speed: float) -> None:
    """On a parabola from a dent 1 mm deep, which it leaves by v^2/(2 g) > 1 mm alone: of 2 m/s2 from 0.063 m/s on."""
    load, bodies = HereditaryLoad(Sphere(0.006).load_curve, NETWORK), Bodies(1.0, 0.6, 2.0)
    met = reset(load, bodies, State(1e-3, -speed, 0.3, (2e-7, 1e-7)))
    if speed < 0.0632:
        assert met is None
        return
    assert met is not None
    leaving = np.sqrt(speed**2 - 2.0 * 2.0 * 1e-3)
    assert met[0] == pytest.approx((speed + leaving) / 2.0, rel=1e-12)
    assert met[1].rate == pytest.approx(leaving, rel=1e-12)
    assert met[1].depth == 0.0
    assert met[1].memory == (0.0, 0.0)
    assert met[1].lost == 0.3
