"""The gap behind a receding edge: what relaxes with the modulus has the edge's power, the gap itself has not."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from fe_contact.bodies.memory import step_law
from fe_contact.bodies.pressing import contact_end
from fe_contact.schemes.base import SCHEMES
from fe_contact.steppers.struck import _median, just_open, opened
from lumped.materials import Relaxation

galerkin = SCHEMES.get("galerkin")

SOLID = Relaxation(1.0, (2.0, 0.7), (0.05, 0.6))
PLACES = np.linspace(0.5, 1.2, 141)
END = 0.4


def edge(time: float) -> float:
    """Of a contact that turns at time zero, at one."""
    return 1.0 - 1.5 * time**2


def stress(time: float) -> np.ndarray:
    """Gap times modulus, as behind a smooth pressure with this edge."""
    return np.maximum(PLACES - edge(time), 0.0) ** 1.5


def gap(time: float) -> np.ndarray:
    """By the creep compliance, within where it was touched: J(0) stress + int J'(t - s) stress(s) ds."""
    creep = SOLID.creep()

    def lag(s: float, place: float) -> float:
        rates = np.array(creep.compliances) / creep.times * np.exp(-(time - s) / np.array(creep.times))
        return float(rates.sum()) * max(place - edge(s), 0.0) ** 1.5

    def late(place: float) -> float:
        start = np.sqrt(min(max((1.0 - place) / 1.5, 0.0), time**2))
        return quad(lag, start, time, args=(place,), epsabs=1e-12)[0]

    return creep.instantaneous * stress(time) + np.array([late(place) for place in PLACES])


def followed(steps: int) -> np.ndarray:
    """The stress in the last step, half of it before the end."""
    times = np.linspace(0.0, END, steps + 1)
    law = step_law(SOLID, galerkin, END / steps)
    memory = just_open(gap(0.0), len(SOLID.times))
    for time in times[1:]:
        memory, found = opened(memory, law, gap(float(time)))
    return found


def test_the_relaxed_gap_is_the_stress_that_would_close_it() -> None:
    """Where the surface was touched and the edge has left; of order two in the step."""
    left = edge(END) + 0.05
    touched = (left < PLACES) & (PLACES <= 1.0)
    errors = []
    for steps in (16, 32):
        exact = stress(END - 0.5 * END / steps)
        errors.append(np.abs(followed(steps) - exact)[touched].max() / exact[touched].max())
    assert errors[1] < 1.5e-3
    assert errors[0] > 3.5 * errors[1]


def test_it_tells_the_edge_where_the_gap_does_not() -> None:
    steps = 32
    middle = END - 0.5 * END / steps
    rough = edge(middle) - 0.01  # what the pressure tells
    found = contact_end(PLACES, rough, followed(steps), PLACES**2, touched=1.0)
    plain = contact_end(PLACES, rough, gap(middle), PLACES**2, touched=1.0)
    assert found == pytest.approx(edge(middle), abs=5e-4)
    assert abs(plain - edge(middle)) > 3.0 * abs(found - edge(middle))


def test_an_elastic_gap_is_its_own_mean() -> None:
    """Times the modulus: two springs in parallel, whose branch never relaxes within the step."""
    before, after = stress(0.1), stress(0.2)
    for modulus in (Relaxation(3.0), Relaxation(1.0, (2.0,), (1e9,))):
        memory = just_open(before, len(modulus.times))
        _, found = opened(memory, step_law(modulus, galerkin, 0.1), after)
        np.testing.assert_allclose(found, 1.5 * (before + after), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("count", [1, 2, 7, 8])
def test_the_gap_is_counted_from_the_middle_one_of_those_that_touch(count: int) -> None:
    values = np.random.default_rng(count).normal(size=count)
    assert _median(values) == pytest.approx(float(np.median(values)), rel=1e-15)
