"""Three routes to one force: internal variables, Q/P as a transfer function, the hereditary sum with E(s) inverted."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import convolution
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.special import gamma
from transfer_function import TransferFunction, polynomials

from lumped import BadInput, Relaxation, Scene, laws, simulate
from lumped.materials.networks import fractional_zener, kelvin_voigt, operators, sls
from lumped.numbers import local

Array = NDArray[np.float64]
Build = Callable[..., Scene]
TIMES = np.linspace(0.0, 2.0, 1001)
STEP = float(TIMES[1])


def history(scene: Scene, count: int) -> tuple[float, Array, Array, Array]:
    """Step, load over the modulus, its rate and the force of the correspondence law at equal steps of an impact."""
    rows = simulate(laws.correspondence.of(scene), scene, 1e-8).history
    places, first = np.unique(rows.time, return_index=True)
    times = np.linspace(0.0, places[-1], count)
    depth, velocity, force = (local(places, column[first], times) for column in (rows.depth, rows.velocity, rows.force))
    depth[0] = 0.0
    curve = scene.profile.load_curve
    return float(times[1]), curve.force(depth), curve.force_and_slope(depth)[1] * velocity, force


def routes(scene: Scene, count: int) -> tuple[float, float]:
    """Largest distance of the second and of the third route from the law, relative to the peak force."""
    step, load, rate, force = history(scene, count)
    modulus = scene.contact_modulus
    second = TransferFunction(*polynomials(modulus)).force(step, load, rate)
    springs = replace(modulus, viscosity=0.0)
    third = convolution.force(springs.operational, step, load) + modulus.viscosity * rate
    return tuple(float(np.abs(route - force).max() / force.max()) for route in (second, third))  # type: ignore[return-value]


def random_scene(impact: Build, seed: int) -> Scene:
    """A solid of up to four terms, half of them with a viscosity in parallel."""
    rng = np.random.default_rng(seed)
    count = rng.integers(1, 5)
    moduli, times = tuple(rng.uniform(0.1, 2.0, count)), tuple(10.0 ** rng.uniform(-1.5, 1.0, count))
    return impact(1.0, moduli, times, 0.05 * (seed % 2), nu=0.3, constant=("poisson", "bulk")[seed // 2 % 2])


@pytest.mark.family
@pytest.mark.parametrize("seed", range(8))
def test_all_routes_lead_to_the_force_of_the_correspondence_law(impact: Build, seed: int) -> None:
    scene = random_scene(impact, seed)
    coarse, fine = routes(scene, 1001), routes(scene, 4001)
    assert max(fine) <= 1e-6
    for far, near in zip(coarse, fine, strict=True):
        assert near <= 0.1 * far or near <= 1e-7  # second order: a sixteenth


def test_two_routes_are_one_whatever_the_step(impact: Build) -> None:
    """Both are exact for a load linear between the samples: coarse steps part them from the law alone."""
    scene = random_scene(impact, 2)
    step, load, _, _ = history(scene, 41)
    modulus = scene.contact_modulus
    second = TransferFunction(*polynomials(modulus)).force(step, load)
    np.testing.assert_allclose(second, convolution.force(modulus.operational, step, load), atol=1e-10 * second.max())


def test_ramp_on_the_three_parameter_solid() -> None:
    """int_0^t E: E0 t + E0 R1 tau (1 - exp(-t/tau)), whatever the step."""
    solid = sls.of_ratios(E0=2.0, R1=3.0, R2=0.4)
    exact = 2.0 * TIMES - 6.0 * 0.1 * np.expm1(-TIMES / 0.1)
    network = TransferFunction(*polynomials(solid)).force(STEP, TIMES)
    np.testing.assert_allclose(network, exact, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(convolution.force(solid.operational, STEP, TIMES), exact, rtol=1e-11, atol=1e-13)


def test_rate_is_answered_exactly() -> None:
    """Kelvin-Voigt has no memory: F = E y + eta y' at every sample, from operators of unequal degree."""
    load, rate = np.sin(TIMES) ** 2, np.sin(2.0 * TIMES)
    solid = kelvin_voigt.of(3.0, 0.2)
    found = TransferFunction(*polynomials(solid)).force(STEP, load, rate)
    np.testing.assert_allclose(found, 3.0 * load + 0.2 * rate, rtol=1e-14, atol=1e-15)


def test_power_law_answers_a_ramp_by_a_power() -> None:
    """E = t^-a, infinite at first: F = t^(1-a)/(1-a)."""
    for exponent in (0.2, 0.7):
        found = convolution.force(lambda s, a=exponent: gamma(1.0 - a) * s**a, STEP, TIMES)  # type: ignore[misc]
        np.testing.assert_allclose(found, TIMES ** (1.0 - exponent) / (1.0 - exponent), rtol=1e-10)


def test_power_law_answers_a_curved_load_to_order_two_minus_its_exponent() -> None:
    """y = t^3: F = 3 int (t-s)^-a s^2 ds = 6 Gamma(1-a)/Gamma(4-a) t^(3-a); the last step meets E = inf."""
    exact = 6.0 * gamma(0.5) / gamma(3.5) * 2.0**2.5
    errors = []
    for count in (251, 501, 1001):
        times = np.linspace(0.0, 2.0, count)
        found = convolution.force(lambda s: gamma(0.5) * s**0.5, float(times[1]), times**3)
        errors.append(abs(found[-1] / exact - 1.0))
    assert errors[0] / errors[1] == pytest.approx(2.0**1.5, rel=0.02)
    assert errors[1] / errors[2] == pytest.approx(2.0**1.5, rel=0.02)


def test_fractional_solid_needs_no_series() -> None:
    """The series that the laws take against E(s) itself: closer than its fidelity says of the force."""
    load = np.sin(0.5 * math.pi * TIMES) ** 1.5
    for accuracy in (1e-3, 1e-5):
        series = fractional_zener.of(1.0, 10.0, 1.0, 0.5, accuracy=accuracy)
        itself = convolution.force(lambda s: 1.0 + 9.0 * s**0.5 / (1.0 + s**0.5), STEP, load)
        through = convolution.force(series.operational, STEP, load)
        assert series.fidelity is not None
        assert np.abs(through - itself).max() <= series.fidelity.of_force(2.0) * itself.max()


def test_hereditary_sum_agrees_with_quadrature() -> None:
    """One term, y = t^1.5: F(1) = 1.5 int s^0.5 exp(-(1-s)/tau) ds."""
    tau = 0.3
    by_quadrature = quad(lambda s: 1.5 * math.sqrt(s) * math.exp(-(1.0 - s) / tau), 0.0, 1.0, epsabs=1e-13)[0]
    times = np.linspace(0.0, 1.0, 4001)
    found = convolution.force(Relaxation(0.0, (1.0,), (tau,)).operational, float(times[1]), times**1.5)[-1]
    assert found == pytest.approx(by_quadrature, rel=1e-6)


def test_polynomials_are_those_of_the_network() -> None:
    first, second, dashpot = 1.8e6, 0.9e6, 1.8e4
    p, q = polynomials(sls.of_springs(E1=first, E2=second, C1=dashpot))
    scale = first + second
    assert p == pytest.approx((1.0, dashpot / scale), rel=1e-14)  # "(12)", divided by E1 + E2
    assert q == pytest.approx((first * second / scale, second * dashpot / scale), rel=1e-14)
    assert polynomials(Relaxation(3.0)) == ((1.0,), (3.0,))


def test_polynomials_give_the_series_back() -> None:
    rng = np.random.default_rng(5)
    for count in range(1, 6):
        times = np.sort(10.0 ** (np.arange(count) - 2.0 + rng.uniform(-0.2, 0.2, count)))
        series = Relaxation(rng.uniform(), tuple(rng.uniform(0.1, 2.0, count)), tuple(times), rng.uniform())
        again = operators.of(*polynomials(series))
        assert sorted(again.times) == pytest.approx(series.times, rel=1e-9)
        assert again(TIMES) == pytest.approx(series(TIMES), rel=1e-9)
        assert again.viscosity == pytest.approx(series.viscosity, rel=1e-12)


@pytest.mark.parametrize(
    ("p", "q", "key"),
    [((1.0,), (1.0, 1.0, 1.0), "q"), ((), (1.0,), "p"), ((1.0, 0.0), (1.0,), "p"), ((1.0,), (math.inf,), "q")],
)
def test_what_is_no_transfer_function_is_refused(p: tuple[float, ...], q: tuple[float, ...], key: str) -> None:
    with pytest.raises(BadInput) as refused:
        TransferFunction(p, q)
    assert [fault.key for fault in refused.value.faults] == [key]


def test_histories_that_cannot_drive_are_refused() -> None:
    solid = TransferFunction((1.0,), (2.0, 1.0))
    with pytest.raises(BadInput, match="rate: missing"):
        solid.force(0.1, [0.0, 1.0])
    for step, load, rate, key in [
        (0.0, [0.0, 1.0], [0.0, 0.0], "step"),
        (0.1, [0.0], [0.0], "load"),
        (0.1, [0.0, 1.0], [0.0], "load"),
        (0.1, [0.0, math.nan], [0.0, 0.0], "load"),
    ]:
        with pytest.raises(BadInput, match=key):
            solid.force(step, load, rate)
    for step, load, key in [(0.1, [1.0, 2.0], "load"), (math.inf, [0.0, 1.0], "step"), (0.1, [0.0], "load")]:
        with pytest.raises(BadInput, match=key):
            convolution.force(Relaxation(1.0).operational, step, load)
