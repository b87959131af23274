"""The surface between two contacts: without force, and what it remembers, against a matrix exponential."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from lumped import Relaxation, Sphere
from lumped.solvers.point.bodies import State
from lumped.solvers.point.memory import FreeSurface, HereditaryLoad

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
