"""Energies of large strains: stress and tangent are derivatives, rotations cost nothing, exact uniform states."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from lumped.materials.energies.base import ENERGIES, energy_of, strained
from lumped.numbers import Array

NAMES = ENERGIES.names
NU = st.floats(-0.3, 0.495)
SEED = st.integers(0, 10**6)
MOST = 0.25  # of a displacement gradient's components


def moduli(nu: float) -> tuple[float, float]:
    """Of E = 1: mu and lambda."""
    return 0.5 / (1.0 + nu), nu / ((1.0 + nu) * (1.0 - 2.0 * nu))


def drawn(seed: int, size: float = MOST) -> Array:
    """Displacement gradients, (5, 4)."""
    return np.random.default_rng(seed).uniform(-size, size, (5, 4))


def uniform(along: float, across: float) -> Array:
    """The gradient of a bar along z, (5, 1)."""
    return np.array([[across - 1.0], [0.0], [0.0], [along - 1.0], [across - 1.0]])


@pytest.mark.parametrize("name", NAMES)
@given(nu=NU, seed=SEED)
def test_stress_and_tangent_are_derivatives(name: str, nu: float, seed: int) -> None:
    energy, (mu, lame), gradient, step = energy_of(name), moduli(nu), drawn(seed), 1e-5
    found = strained(energy, gradient, mu, lame)
    for i in range(5):
        shift = step * np.eye(5)[:, i, None]
        above, below = (strained(energy, gradient + sign * shift, mu, lame) for sign in (1.0, -1.0))
        scale = np.abs(found.tangent).max()
        assert (above.energy - below.energy) / (2 * step) == pytest.approx(found.stress[i], abs=1e-7 * scale)
        assert (above.stress - below.stress) / (2 * step) == pytest.approx(found.tangent[:, i], abs=1e-6 * scale)


@pytest.mark.parametrize("name", NAMES)
@given(nu=NU, seed=SEED, angle=st.floats(-3.0, 3.0))
def test_a_rotation_changes_no_energy_and_turns_the_stress(name: str, nu: float, seed: int, angle: float) -> None:
    energy, (mu, lame), gradient = energy_of(name), moduli(nu), drawn(seed)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned = gradient.copy()
    block = (gradient[:4].T + np.array([1.0, 0.0, 0.0, 1.0])).reshape(-1, 2, 2)
    turned[:4] = (turn @ block).reshape(-1, 4).T - np.array([[1.0], [0.0], [0.0], [1.0]])
    before, after = (strained(energy, one, mu, lame) for one in (gradient, turned))
    assert after.energy == pytest.approx(before.energy, rel=1e-9, abs=1e-12)
    expected = (turn @ before.stress[:4].T.reshape(-1, 2, 2)).reshape(-1, 4).T
    assert after.stress[:4] == pytest.approx(expected, abs=1e-9 * np.abs(before.tangent).max())


@pytest.mark.parametrize("name", NAMES)
@given(nu=NU)
def test_at_small_strain_all_are_the_same_isotropic_material(name: str, nu: float) -> None:
    mu, lame = moduli(nu)
    tangent = strained(energy_of(name), np.zeros((5, 1)), mu, lame).tangent[..., 0]
    normal = np.ix_([0, 3, 4], [0, 3, 4])
    assert tangent[normal] == pytest.approx(lame + 2.0 * mu * np.eye(3), abs=1e-12 * (lame + 2 * mu))
    assert tangent[1:3, 1:3] == pytest.approx(mu * np.ones((2, 2)), abs=1e-12)


def uniaxial_in_closed_form(name: str, s: float, nu: float) -> float:
    """Nominal stress with free sides, of the energies that have a form of their own for it, with E = 1."""
    mu, lame = moduli(nu)
    if name == "hencky":
        return float(np.log(s) / s)  # Kirchhoff's stress is E ln s
    if name == "st_venant_kirchhoff":
        return 0.5 * s * (s**2 - 1.0)  # second Piola-Kirchhoff's is E (s^2 - 1)/2
    across = brentq(lambda t: mu * (t**2 - 1.0) + lame * np.log(s * t**2), 0.3, 3.0, xtol=1e-15)
    return float((mu * (s**2 - 1.0) + lame * np.log(s * across**2)) / s)


@pytest.mark.parametrize("name", ["hencky", "st_venant_kirchhoff", "neo_hooke"])
@given(nu=st.floats(0.0, 0.495), s=st.floats(0.75, 1.4))
def test_uniaxial_stress(name: str, nu: float, s: float) -> None:
    energy, (mu, lame) = energy_of(name), moduli(nu)
    across = brentq(lambda t: strained(energy, uniform(s, t), mu, lame).stress[0, 0], 0.6, 1.6, xtol=1e-15)
    found = strained(energy, uniform(s, across), mu, lame).stress[3, 0]
    assert found == pytest.approx(uniaxial_in_closed_form(name, s, nu), rel=1e-8, abs=1e-12 * (1.0 + lame))


def confined_in_closed_form(name: str, s: float, mu: float, lame: float) -> float:
    """Nominal stress of uniaxial strain: W'(s), every energy written out for stretches (1, 1, s)."""
    kappa, b = lame + 2.0 * mu / 3.0, s ** (-2.0 / 3.0)
    first, second = b * (2.0 + s**2), b**2 * (1.0 + 2.0 * s**2)
    d_first = 2.0 * b * s - 2.0 / 3.0 * first / s
    d_second = 4.0 * b**2 * s - 4.0 / 3.0 * second / s
    volume = kappa * (s - 1.0)
    if name == "neo_hooke":
        return mu * (s - 1.0 / s) + lame * np.log(s) / s
    if name == "hencky":
        return float((lame + 2.0 * mu) * np.log(s) / s)
    if name == "st_venant_kirchhoff":
        return 0.5 * (lame + 2.0 * mu) * s * (s**2 - 1.0)
    if name == "neo_hooke_split":
        return 0.5 * mu * d_first + volume
    if name == "mooney_rivlin":
        return 0.4 * mu * d_first + 0.1 * mu * d_second + volume
    if name == "yeoh":
        x = first - 3.0
        return 0.5 * mu * (1.0 - 0.04 * x + 0.003 * x**2) * d_first + volume
    powers, weights = np.array([1.3, 5.0, -2.0]), np.array([6.3, 0.012, -0.1])
    weights = weights * 2.0 * mu / (weights @ powers)
    return float(2.0 / 3.0 * weights @ (s ** (2.0 * powers / 3.0) - s ** (-powers / 3.0)) / s + volume)


@pytest.mark.parametrize("name", NAMES)
@given(nu=st.floats(-0.3, 0.495), s=st.floats(0.7, 1.5))
def test_confined_compression(name: str, nu: float, s: float) -> None:
    mu, lame = moduli(nu)
    found = strained(energy_of(name), uniform(s, 1.0), mu, lame).stress[3, 0]
    assert found == pytest.approx(confined_in_closed_form(name, s, mu, lame), rel=1e-8, abs=1e-12 * (1.0 + lame))


def test_what_is_turned_inside_out_has_no_finite_energy() -> None:
    for name in NAMES:
        assert np.all(np.isinf(strained(energy_of(name), uniform(-0.1, 1.0), 1.0, 2.0).energy))
