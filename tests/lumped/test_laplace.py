"""Inversion of Laplace transforms: analytic pairs, and a stated error that covers the true one."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.special import erfcx, gamma

from lumped import BadInput, Relaxation
from lumped.materials import laplace
from lumped.materials.laplace import Complex, Inverse, inverse, relaxation_modulus

Array = NDArray[np.float64]
TIMES = np.logspace(-6, 6, 121)


def covered(found: Inverse, truth: Array) -> bool:
    """The stated error covers the true one, up to the rounding of the truth itself."""
    return bool(np.all(np.abs(found.value - truth) <= found.error + 1e-15 * np.abs(truth)))


def mittag_leffler(alpha: float, time: float) -> float:
    """E_alpha(-t^alpha) from its spectrum of relaxation, int sin(pi a)/(2 pi (cosh(a u) + cos(pi a))) exp(-t e^u) du.

    Gorenflo and Mainardi 1997, doi 10.1007/978-3-7091-2664-6_5, with the rate e^u.
    """

    def integrand(u: float) -> float:
        spectrum = math.sin(math.pi * alpha) / (math.cosh(alpha * u) + math.cos(math.pi * alpha))
        return spectrum / (2.0 * math.pi) * math.exp(-time * math.exp(u))

    low, high = -40.0 / alpha, math.log(750.0 / time)
    knots = [0.0, -math.log(time)]
    inner = sorted(knot for knot in knots if low < knot < high)
    edges = [low, *inner, high]
    parts = (quad(integrand, a, b, epsabs=1e-15, epsrel=1e-13, limit=400)[0] for a, b in pairwise(edges))
    return float(sum(parts))


@pytest.mark.parametrize("exponent", [0.1, 0.5, 0.9])
def test_power_law(exponent: float) -> None:
    found = relaxation_modulus(lambda s: gamma(1.0 - exponent) * s**exponent, TIMES)
    truth = TIMES**-exponent
    np.testing.assert_allclose(found.value, truth, rtol=1e-12)
    assert covered(found, truth)
    assert np.all(found.error <= 1e-10 * truth)


def test_three_parameter_solid() -> None:
    solid = Relaxation(0.6e6, (0.3e6,), (0.02 / 3.0,))
    found = relaxation_modulus(solid.operational, TIMES)
    np.testing.assert_allclose(found.value, solid(TIMES), rtol=1e-12)
    assert covered(found, solid(TIMES))


def test_stated_error_covers_that_of_random_series() -> None:
    rng = np.random.default_rng(1)
    for _ in range(100):
        count = rng.integers(1, 8)
        series = Relaxation(
            rng.uniform(), tuple(10.0 ** rng.uniform(-3, 3, count)), tuple(10.0 ** rng.uniform(-8, 8, count))
        )
        found = relaxation_modulus(series.operational, TIMES)
        assert covered(found, series(TIMES))
        assert np.all(found.error <= 1e-10 * series.glassy)


def test_viscosity_is_taken_away_before() -> None:
    """Kelvin-Voigt in parallel with a Maxwell element: with eta/t 1e12 times E(t), rounding alone may show."""
    solid = Relaxation(2.0, (3.0,), (0.1,), 10.0)
    found = relaxation_modulus(solid.operational, TIMES, solid.viscosity)
    assert covered(found, solid(TIMES))
    assert np.all(found.error <= 1e-10 * solid.glassy + 1e-12 * solid.viscosity / TIMES)
    voigt = relaxation_modulus(Relaxation(2.0, viscosity=1e-3).operational, TIMES[TIMES > 1e-3], 1e-3)
    np.testing.assert_allclose(voigt.value, 2.0, rtol=1e-11)


def test_half_order_solid_is_an_error_function() -> None:
    found = relaxation_modulus(lambda s: s**0.5 / (1.0 + s**0.5), TIMES)
    truth = erfcx(np.sqrt(TIMES))
    np.testing.assert_allclose(found.value, truth, rtol=1e-12)
    assert covered(found, truth)


@pytest.mark.parametrize("alpha", [0.2, 0.35, 0.6, 0.9])
def test_fractional_solid_is_a_mittag_leffler_function(alpha: float) -> None:
    times = np.logspace(-5, 4, 10)
    found = relaxation_modulus(lambda s: s**alpha / (1.0 + s**alpha), times)
    np.testing.assert_allclose(found.value, [mittag_leffler(alpha, float(t)) for t in times], rtol=1e-11)


def test_error_falls_by_the_published_rate(monkeypatch: pytest.MonkeyPatch) -> None:
    """3.89^-N: 15.1 for each pair of nodes (Trefethen, Weideman and Schmelzer 2006)."""

    def worst(order: int) -> float:
        monkeypatch.setattr(laplace, "FINE", order)
        return float(np.abs(inverse(lambda s: 1.0 / (1.0 + s), TIMES).value - np.exp(-TIMES)).max())

    errors = [worst(order) for order in (8, 12, 16, 20)]
    rate = (errors[0] / errors[-1]) ** (1.0 / 12.0)
    assert rate == pytest.approx(3.89, rel=0.05)


def test_the_transform_is_asked_once_an_order() -> None:
    asked: list[int] = []

    def counted(s: Complex) -> Complex:
        asked.append(s.size)
        return np.asarray(1.0 / (1.0 + s))

    inverse(counted, TIMES)
    assert asked == [TIMES.size * laplace.FINE // 2, TIMES.size * laplace.COARSE // 2]


def test_shape_is_that_of_the_times() -> None:
    assert inverse(lambda s: 1.0 / s, 2.0).value.shape == ()
    assert inverse(lambda s: 1.0 / s, np.ones((3, 4))).error.shape == (3, 4)


@pytest.mark.parametrize("times", [0.0, -1.0, [1.0, math.inf], math.nan])
def test_times_that_have_no_inverse_are_refused(times: object) -> None:
    with pytest.raises(BadInput, match="times"):
        inverse(lambda s: 1.0 / s, times)  # type: ignore[arg-type]
