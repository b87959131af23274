"""Every time integrator on a mass and a viscoelastic spring with an exact answer: the order it claims."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm

from fe_contact.bodies.memory import step_law
from fe_contact.schemes.base import SCHEMES, MemoryScheme
from fe_contact.schemes.galerkin import SERIES_BELOW
from lumped.materials import Relaxation

galerkin = SCHEMES.get("galerkin")

MATERIALS = {
    "elastic": Relaxation(1.0),
    "two branches": Relaxation(0.6, (1.5, 0.8), (0.3, 2.0)),
    "pure viscosity": Relaxation(0.5, viscosity=0.4),
    "fluid": Relaxation(0.0, (2.0,), (0.7,)),
}
END = 2.0


def exact(relaxation: Relaxation, time: float) -> np.ndarray:
    """Displacement and velocity of a unit mass that touches with unit velocity: linear equations, solved exactly."""
    branches = len(relaxation.moduli)
    system = np.zeros((2 + branches, 2 + branches))
    system[0, 1] = 1.0
    system[1, 0], system[1, 1] = -relaxation.equilibrium, -relaxation.viscosity
    system[1, 2:] = -np.array(relaxation.moduli)
    system[2:, 1] = 1.0
    system[2:, 2:] = -np.diag(1 / np.array(relaxation.times)) if branches else system[2:, 2:]
    return (expm(system * time) @ np.append([0.0, 1.0], np.zeros(branches)))[:2]


def integrated(relaxation: Relaxation, scheme: MemoryScheme, steps: int) -> np.ndarray:
    """The march's step on one degree of freedom: u = free - lever F/m and F = now u + past."""
    step = END / steps
    law = step_law(relaxation, scheme, step)
    lever = scheme.lever * step**2
    u, velocity, branches = 0.0, 1.0, np.zeros(len(relaxation.moduli))
    for _ in range(steps):
        past = law.past_strain * u + law.past_branches @ branches
        moved = (u + step * velocity - lever * past) / (1 + lever * law.now)
        force = law.now * moved + past
        branches = law.decay * branches + law.gain * (moved - u)
        u, velocity = moved, velocity - step * force
    return np.array([u, velocity])


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("name", SCHEMES.names)
def test_the_observed_order_is_the_claimed_one(name: str, material: str) -> None:
    scheme, relaxation = SCHEMES.get(name), MATERIALS[material]
    steps = np.array([64, 128, 256, 512])
    errors = [np.abs(integrated(relaxation, scheme, int(n)) - exact(relaxation, END)).max() for n in steps]
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(rates, scheme.order, atol=0.15, err_msg=str(errors))


@pytest.mark.parametrize("stiff", [1e-3, 1e-5])
def test_the_galerkin_scheme_keeps_order_two_where_the_steps_are_far_longer_than_a_time_constant(stiff: float) -> None:
    relaxation = Relaxation(1.0, (0.4 / stiff,), (stiff,))
    errors = [np.abs(integrated(relaxation, galerkin, n) - exact(relaxation, END)).max() for n in (8, 16, 32)]
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert 50 * stiff < END / 32
    np.testing.assert_allclose(rates, 2, atol=0.25, err_msg=str(errors))


@pytest.mark.parametrize("name", SCHEMES.names)
def test_the_weights_of_a_scheme_are_those_of_its_sample(name: str) -> None:
    """A force that belongs to the share SAMPLE of the step: a spring feels that share of the increment.

    And for branches of every speed, past plus increment must hold a steady rate of strain exactly.
    """
    scheme = SCHEMES.get(name)
    assert scheme.sample == scheme.sample
    ratios = 10.0 ** np.arange(-8, 9)
    moduli = np.ones_like(ratios)
    per_increment, of_past = scheme.weights(moduli, ratios)
    slow = ratios < 1e-6
    np.testing.assert_allclose(per_increment[slow], scheme.sample, rtol=1e-5)
    np.testing.assert_allclose(of_past[slow], 1, rtol=1e-5)
    np.testing.assert_allclose(per_increment + of_past / ratios, 1 / ratios, rtol=1e-7)


def test_the_galerkin_weights_are_exact_to_rounding_whatever_the_step() -> None:
    """Against their whole series, added up without rounding: short of where it takes over a difference cancels."""
    ratios = np.concatenate([np.geomspace(1e-8, 5.0, 400), SERIES_BELOW * np.array([1.0 - 1e-9, 1.0 + 1e-9])])
    for weights, first in zip(galerkin.weights(np.ones_like(ratios), ratios), (2, 1), strict=True):
        series = [math.fsum((-x) ** k / math.factorial(k + first) for k in range(60)) for x in ratios.tolist()]
        assert weights == pytest.approx(series, rel=1e-13, abs=0.0)
