"""Stereomechanics: balances, walls, and the audit's numbers."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumped.errors import BadInput
from lumped.solvers.stereomechanics import Collision, restitution

MASSES = st.floats(1e-3, 1e3)
VELOCITIES = st.floats(-10.0, 10.0)
CLOSING = st.floats(1e-2, 10.0)
RESTITUTIONS = st.floats(0.0, 1.0)


@given(MASSES, MASSES, VELOCITIES, CLOSING, RESTITUTIONS)
def test_momentum_and_energy_balance(mass_1: float, mass_2: float, velocity: float, closing: float, e: float) -> None:
    collision = Collision(mass_1, velocity + closing, velocity, e, mass_2)
    before, after = (collision.velocity_1, collision.velocity_2), collision.velocities_after
    masses = (mass_1, mass_2)
    momentum = [sum(m * v for m, v in zip(masses, pair, strict=True)) for pair in (before, after)]
    energy = [sum(0.5 * m * v * v for m, v in zip(masses, pair, strict=True)) for pair in (before, after)]
    size = sum(m * abs(v) for m, v in zip(masses, before, strict=True))
    assert momentum[1] == pytest.approx(momentum[0], abs=1e-12 * size)
    assert energy[0] - energy[1] == pytest.approx(collision.energy_lost, abs=1e-12 * energy[0])
    lost = 0.5 * mass_1 * mass_2 / (mass_1 + mass_2) * (1.0 - e**2) * (before[0] - before[1]) ** 2
    assert collision.energy_lost == pytest.approx(lost, abs=1e-12 * energy[0])
    assert restitution(*before, *after) == pytest.approx(e, abs=1e-12)


def test_audit_example() -> None:
    # audit, misprints 1 and 2: m = 3, 2; V = 5, 1; e = 0.6
    collision = Collision(3.0, 5.0, 1.0, 0.6, 2.0)
    assert collision.velocities_after == pytest.approx((2.44, 4.84), rel=1e-14)
    assert collision.energy_lost == pytest.approx(6.144, rel=1e-14)


@given(MASSES, VELOCITIES, CLOSING, RESTITUTIONS)
def test_wall_keeps_its_velocity(mass: float, velocity: float, closing: float, e: float) -> None:
    collision = Collision(mass, velocity + closing, velocity, e)
    after, wall = collision.velocities_after
    assert wall == velocity
    assert velocity - after == pytest.approx(e * closing, abs=1e-13)
    assert collision.reduced_mass == mass
    assert collision.energy_lost == pytest.approx(0.5 * mass * (1.0 - e**2) * closing**2, abs=1e-12 * mass)


@pytest.mark.parametrize(
    ("changed", "key"),
    [
        ({"mass_1": 0.0}, "mass_1"),
        ({"mass_1": math.inf}, "mass_1"),
        ({"mass_2": -1.0}, "mass_2"),
        ({"velocity_1": math.nan}, "velocity_1"),
        ({"velocity_1": 1.0}, "velocity_1"),
        ({"e": 1.01}, "e"),
        ({"e": -0.01}, "e"),
    ],
)
def test_bad_values_are_named(changed: dict[str, float], key: str) -> None:
    good = {"mass_1": 3.0, "velocity_1": 5.0, "velocity_2": 1.0, "e": 0.6, "mass_2": 2.0}
    with pytest.raises(BadInput, match="accepted") as caught:
        Collision(**(good | changed))
    assert [fault.key for fault in caught.value.faults] == [key]


def test_bodies_that_part_have_no_restitution() -> None:
    with pytest.raises(BadInput, match="towards body 2"):
        restitution(1.0, 2.0, 1.0, 2.0)
