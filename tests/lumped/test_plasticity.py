"""J2 plasticity: its tangent, exact curves, what it dissipates, and the first yield under a sphere."""

from __future__ import annotations

import numpy as np
import pytest
from first_yield import first_yield
from hypothesis import given
from hypothesis import strategies as st

from lumped.materials.plasticity import ROOT, Yielding
from lumped.numbers import Array

YOUNG, NU, STRENGTH = 200.0, 0.3, 0.4
BULK, SHEAR = YOUNG / (3.0 * (1.0 - 2.0 * NU)), YOUNG / (2.0 * (1.0 + NU))
POINTS = 60


def material(hardening: float = 0.0) -> Yielding:
    return Yielding(BULK, SHEAR, STRENGTH, hardening)


def at_rest(shape: tuple[int, ...] = ()) -> tuple[Array, Array]:
    return np.zeros((4, *shape)), np.zeros(shape)


def drawn(seed: int) -> tuple[Array, Array, Array]:
    """A gradient of some times the yield strain, and what points remember of another one."""
    rng, size = np.random.default_rng(seed), 3.0 * STRENGTH / YOUNG
    before = material(20.0).flowed(size * rng.normal(size=(5, POINTS)), *at_rest((POINTS,)))
    return size * rng.normal(size=(5, POINTS)), before.strain, before.amount


@given(st.integers(0, 10**6), st.sampled_from([0.0, 1.0, 50.0]))
def test_stress_and_tangent_are_derivatives_of_the_potential(seed: int, hardening: float) -> None:
    (gradient, *state), law, step = drawn(seed), material(hardening), 1e-7
    found = law.flowed(gradient, *state)
    for component in range(5):
        moved = np.zeros((5, 1))
        moved[component] = step
        more, less = law.flowed(gradient + moved, *state), law.flowed(gradient - moved, *state)
        slope = (more.energy - less.energy) / (2.0 * step)
        assert slope == pytest.approx(found.stress[component], abs=1e-6 * YOUNG)
        kinks = (more.amount > state[1]) != (less.amount > state[1])  # yields between the two
        bend = ((more.stress - less.stress) / (2.0 * step))[:, ~kinks]
        assert bend == pytest.approx(found.tangent[:, component, ~kinks], abs=1e-5 * YOUNG)
    assert found.tangent == pytest.approx(found.tangent.swapaxes(0, 1))


@given(st.integers(0, 10**6))
def test_stress_ends_at_yield_keeps_volume_and_dissipates(seed: int) -> None:
    law, (gradient, *state) = material(20.0), drawn(seed)
    found = law.flowed(gradient, *state)
    mean = (found.stress[0] + found.stress[3] + found.stress[4]) / 3.0
    parts = found.stress[[0, 1, 2, 3, 4]] - np.outer([1, 0, 0, 1, 1], mean)
    mises, limit = ROOT * np.sqrt((parts**2).sum(axis=0)), STRENGTH + 20.0 * found.amount
    flows = found.amount > state[1]
    assert flows.any()
    assert mises[flows] == pytest.approx(limit[flows])
    assert np.all(mises <= limit * (1.0 + 1e-12))
    assert found.strain[[0, 2, 3]].sum(axis=0) == pytest.approx(0.0, abs=1e-15)
    assert np.all(law.worked(found.amount) >= law.worked(state[1]))


def test_a_rotation_strains_nothing() -> None:
    found = material().flowed(np.array([0.0, 0.5, -0.5, 0.0, 0.0]), *at_rest())
    assert float(found.energy) == 0.0
    assert not found.stress.any()


@pytest.mark.parametrize("hardening", [0.0, 10.0])
def test_uniaxial_stress_and_its_release(hardening: float) -> None:
    """sigma = Y + E H/(E + H) (eps - Y/E), and back along E."""
    law, state, strain = material(hardening), at_rest(), 5.0 * STRENGTH / YOUNG
    for axial, stress in (
        (strain, STRENGTH + YOUNG * hardening / (YOUNG + hardening) * (strain - STRENGTH / YOUNG)),
        (strain - STRENGTH / YOUNG, hardening * YOUNG / (YOUNG + hardening) * (strain - STRENGTH / YOUNG)),
    ):
        side = -NU * axial
        for _ in range(30):
            found = law.flowed(np.array([side, 0.0, 0.0, axial, side]), *state)
            side -= found.stress[0] / (found.tangent[0, 0] + found.tangent[0, 4])
        assert found.stress[0] == pytest.approx(0.0, abs=1e-12)
        assert found.stress[3] == pytest.approx(stress, rel=1e-10)
        state = found.strain, found.amount


def test_confined_compression() -> None:
    """Beyond yield its slope is K + 4 G H/(3 (3G + H)); a release follows K + 4G/3."""
    hardening, law = 10.0, material(10.0)
    yields = STRENGTH / (2.0 * SHEAR)
    gradient = np.array([0.0, 0.0, 0.0, -1.0, 0.0])
    loaded = law.flowed(3.0 * yields * gradient, *at_rest())
    elastic, plastic = BULK + 4.0 * SHEAR / 3.0, BULK + 4.0 * SHEAR * hardening / (3.0 * (3.0 * SHEAR + hardening))
    assert -loaded.stress[3] == pytest.approx(elastic * yields + plastic * 2.0 * yields, rel=1e-12)
    back = law.flowed(2.5 * yields * gradient, loaded.strain, loaded.amount)
    assert back.stress[3] - loaded.stress[3] == pytest.approx(0.5 * elastic * yields, rel=1e-12)
    assert float(back.amount) == float(loaded.amount)


def test_work_is_stored_or_plastic() -> None:
    """Along a straight path: the work of the stress, in many steps, is what is stored and what was worked."""
    law, path = material(10.0), np.linspace(0.0, 4.0 * STRENGTH / YOUNG, 4001)
    direction = np.array([0.3, 0.8, 0.1, -1.0, 0.4])
    state, before, work, gradient = at_rest(), np.zeros(5), 0.0, np.zeros(5)
    for step in np.diff(path):
        gradient = gradient + step * direction
        found = law.flowed(gradient, *state)
        work += 0.5 * float((before + found.stress) @ direction) * step
        state, before = (found.strain, found.amount), found.stress
    assert work == pytest.approx(float(law.stored(gradient, state[0]) + law.worked(state[1])), rel=1e-6)


@pytest.mark.parametrize(("poisson", "published"), [(0.2, 1.49), (0.3, 1.61), (0.4, 1.74)])
def test_first_yield_under_a_sphere(poisson: float, published: float) -> None:
    """Jackson and Green 2005 (doi 10.1115/1.1866166): C = 1.295 exp(0.736 nu); Johnson: 0.48 a deep at nu = 0.3."""
    pressure, depth = first_yield(poisson)
    assert pressure == pytest.approx(published, rel=0.01)
    assert pressure == pytest.approx(1.295 * np.exp(0.736 * poisson), rel=0.005)
    assert 0.4 < depth < 0.55
    assert first_yield(0.3)[1] == pytest.approx(0.48, abs=0.005)
