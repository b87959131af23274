"""A strain that nothing holds any more: against its own differential equations, in the limits, and in time."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from lumped.errors import BadInput
from lumped.materials import Recovery, Relaxation

RNG = np.random.default_rng(71)
KINDS = [(1.0, 0.0), (0.0, 0.0), (1.0, 0.3), (0.0, 0.3)]  # equilibrium modulus, parallel viscosity


def integrated(relaxation: Relaxation, strain: float, dashpots: np.ndarray, times: np.ndarray) -> np.ndarray:
    """The strain at ascending times from 0 on, by the equations of springs and dashpots."""
    moduli, taus = np.array(relaxation.moduli), np.array(relaxation.times)

    def held(state: np.ndarray) -> float:
        """The strain: with a viscosity a state of its own, else where the springs are in balance."""
        return float(state[0] if relaxation.viscosity else moduli @ state[1:] / relaxation.glassy)

    def rate(_: float, state: np.ndarray) -> np.ndarray:
        now = held(state)
        pull = relaxation.equilibrium * now + moduli @ (now - state[1:])
        creeping = -pull / relaxation.viscosity if relaxation.viscosity else 0.0
        return np.concatenate([[creeping], (now - state[1:]) / taus])

    start = np.concatenate([[strain], dashpots])
    found = solve_ivp(rate, (0.0, times[-1]), start, method="Radau", t_eval=times, rtol=1e-10, atol=1e-13)
    return np.array([held(state) for state in found.y.T])


@pytest.mark.family
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("terms", [1, 3])
def test_the_recovery_solves_the_equations_of_the_network(kind: tuple[float, float], terms: int) -> None:
    moduli, taus = RNG.uniform(0.1, 3.0, terms), 10 ** RNG.uniform(-1.0, 1.0, terms)
    relaxation = Relaxation(kind[0], tuple(moduli.tolist()), tuple(taus.tolist()), kind[1])
    strain, dashpots = 1.0, RNG.uniform(0.0, 1.0, terms)
    times = np.concatenate([[0.0], np.geomspace(0.01, 30.0, 12)])
    exact = integrated(relaxation, strain, dashpots, times)
    assert Recovery.of(relaxation, strain, dashpots)(times) == pytest.approx(exact, abs=1e-9)


def test_springs_leave_nothing_a_maxwell_fluid_all_that_flowed_and_a_kelvin_solid_fades() -> None:
    times = np.array([0.0, 0.1, 3.0])
    assert np.all(Recovery.of(Relaxation(2.0), 0.7, ())(times) == 0.0)
    fluid = Recovery.of(Relaxation(0.0, (5.0,), (0.4,)), 0.7, (0.3,))
    assert fluid(times) == pytest.approx(0.3, rel=1e-14)
    assert fluid.until(0.01) == 0.0
    solid = Recovery.of(Relaxation(2.0, viscosity=3.0), 0.7, ())
    assert solid(times) == pytest.approx(0.7 * np.exp(-2.0 / 3.0 * times), rel=1e-12)


def test_a_branch_without_a_spring_is_as_good_as_none() -> None:
    with_it = Recovery.of(Relaxation(1.0, (0.0, 2.0), (0.5, 0.1)), 1.0, (0.9, 0.4))
    without = Recovery.of(Relaxation(1.0, (2.0,), (0.1,)), 1.0, (0.4,))
    assert with_it(0.05) == pytest.approx(float(without(0.05)), rel=1e-14)


def test_the_time_until_a_share_is_left_is_when_that_share_of_what_goes_is_left() -> None:
    recovery = Recovery(0.2, (0.5, 1.0, 0.1), (0.01, 1.0, 40.0))
    for share in (0.999, 0.5, 0.01):
        assert float(recovery(recovery.until(share))) == pytest.approx(0.2 + share * 1.6, rel=1e-9)
    with pytest.raises(BadInput, match="between 0 and 1"):
        recovery.until(1.0)
