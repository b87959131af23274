"""Under a flat punch the law with memory is linear: its motion is a matrix exponential, whatever the weight."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from lumped import Material, Model, Motion, Relaxation, Scene, laws, simulate
from lumped.shapes.punch import Punch

Array = NDArray[np.float64]


def scene_of(rng: np.random.Generator) -> Scene:
    """A punch whose weight may hold it down: up to three terms, at times a dashpot, weights of all sizes."""
    terms, mass, time = int(rng.integers(1, 4)), 0.05, 0.01
    # 2 a E* of mass/time^2: an impact of about this time
    radius, unit = 0.005, mass / time**2 / 0.01
    contact = Relaxation(
        unit, tuple(unit * rng.uniform(0.05, 5.0, terms)), tuple(time * 10.0 ** rng.uniform(-3.0, 1.0, terms)),
        unit * time * float(rng.choice([0.0, 10.0 ** rng.uniform(-2.0, 0.0)])),
    )  # fmt: skip
    velocity, gravity = 0.01, 0.01 / time * float(rng.choice([0.0, 10.0 ** rng.uniform(-2.0, 1.5)]))
    nu = float(rng.uniform(-0.9, 0.49))
    material, model = Material(contact.scaled(1.0 - nu**2), nu), Model(gravity=gravity)
    return Scene(Punch(radius), mass, velocity, material, model=model, motion=Motion(end_time=20.0 * time))


def system(scene: Scene) -> tuple[Array, Array]:
    """d/dt of (depth, velocity, z_1 ... z_K, 1), z_k' = depth' - z_k/tau_k, as a matrix; and the row that gives F."""
    modulus, stiffness = scene.contact_modulus, 2.0 * 0.005
    moduli, rates = np.array(modulus.moduli), 1.0 / np.array(modulus.times)
    force = stiffness * np.array([modulus.equilibrium, modulus.viscosity, *moduli, 0.0])
    matrix = np.zeros((force.size, force.size))
    matrix[0, 1] = 1.0
    matrix[1] = -force / scene.mass
    matrix[1, -1] = scene.gravity
    matrix[2:-1, 1] = 1.0
    matrix[2:-1, 2:-1] = -np.diag(rates)
    return matrix, force


def test_a_punch_moves_as_its_matrix_says_and_parts_when_that_lets_go(campaign_size: Callable[[int], int]) -> None:
    rng, parted = np.random.default_rng(1960), 0
    for _ in range(campaign_size(200)):
        scene = scene_of(rng)
        matrix, force = system(scene)
        touch = np.array([0.0, scene.velocity, *np.zeros(matrix.shape[0] - 3), 1.0])
        result = simulate(laws.correspondence.of(scene), scene, 1e-6)
        history = result.history
        for row in rng.integers(1, len(history), 6):
            exact = expm(matrix * history.time[row]) @ touch
            off = abs(history.force[row] - max(float(force @ exact), 0.0))
            assert off <= history.force_error[row] + 1e-9 * history.force.max(), scene
            assert abs(history.depth[row] - exact[0]) <= 1e-6 * history.depth.max(), scene
        end = float(history.time[-1])
        step, state, forces = expm(matrix * end / 400.0), touch, []
        for _ in range(400):
            state = step @ state
            forces.append(float(force @ state))
        assert min(forces[:-1]) > 0.0, scene
        assert (abs(forces[-1]) < 1e-6 * max(forces)) == result.separated, scene
        parted += result.separated
    assert parted
