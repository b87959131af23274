"""Profiles and load curves: force against energy, stiffness against edge, and the one-dimensional profile between."""

from __future__ import annotations

from decimal import Decimal, localcontext

import numpy as np
import pytest

from lumped import Material, Relaxation, Scene, laws, simulate
from lumped.load_curves import ConeCurve, Hertz, LoadCurve, Power, SneddonSphere
from lumped.load_curves.fixed_area import Column, PunchCurve
from lumped.load_curves.sampled import SampledCurve
from lumped.load_curves.sneddon_sphere import SHALLOW
from lumped.scene.scene import Answered
from lumped.shapes import Parabola, Shape, Sphere
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace

RADIUS = 0.006
SHAPES = [Sphere(RADIUS), Parabola(RADIUS)]
CURVES = [Hertz(RADIUS), SneddonSphere(RADIUS), ConeCurve(35.0), Power(40.0, 1.7), Power(5e4, 3.5)]
DEPTHS = RADIUS * np.array([1e-12, 1e-6, 1e-3, 0.01, 0.1, 0.4, 1.0])


def gauss(n: int = 200) -> tuple[np.ndarray, np.ndarray]:
    nodes, weights = np.polynomial.legendre.leggauss(n)
    return 0.5 * (nodes + 1.0), 0.5 * weights


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_contact_radius_and_depth_are_inverse(curve: LoadCurve) -> None:
    np.testing.assert_allclose(curve.depth(curve.contact_radius(DEPTHS)), DEPTHS, rtol=1e-13)
    scalars = [curve.contact_radius(float(depth)) for depth in DEPTHS]
    np.testing.assert_allclose(scalars, curve.contact_radius(DEPTHS), rtol=1e-14)


@pytest.mark.parametrize("curve", [*CURVES, PunchCurve(RADIUS), Column(RADIUS, RADIUS)], ids=lambda c: type(c).__name__)
def test_a_closed_form_answers_a_row_of_depths_the_same_in_any_company(curve: LoadCurve) -> None:
    rng = np.random.default_rng(8)
    rows = RADIUS * 10.0 ** rng.uniform(-12.0, 0.0, (9, 13))
    rows[4:] *= 1e-3  # shallow ones beside deep ones
    assert curve.closed
    together, apart = curve.force_and_slope(rows), [curve.force_and_slope(row) for row in rows]
    for i in range(2):
        assert np.array_equal(together[i], np.array([one[i] for one in apart]))


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_stiffness_is_twice_the_contact_radius(curve: LoadCurve) -> None:
    step = 1e-5 * DEPTHS
    slope = (curve.force(DEPTHS + step) - curve.force(DEPTHS - step)) / (2.0 * step)
    np.testing.assert_allclose(slope, curve.force_and_slope(DEPTHS)[1], rtol=1e-9)
    np.testing.assert_allclose(slope, 2.0 * curve.contact_radius(DEPTHS), rtol=1e-9)


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_force_is_the_slope_of_energy(curve: LoadCurve) -> None:
    step = 1e-4 * DEPTHS
    slope = (curve.energy(DEPTHS + step) - curve.energy(DEPTHS - step)) / (2.0 * step)
    np.testing.assert_allclose(slope, curve.force(DEPTHS), rtol=1e-7)


@pytest.mark.parametrize("curve", CURVES, ids=lambda c: type(c).__name__)
def test_pressure_integrates_to_the_force(curve: LoadCurve) -> None:
    depth = 0.1 * RADIUS
    a = float(curve.contact_radius(depth))
    nodes, weights = gauss()
    # r = a cos(angle) takes the root out of the pressure at the edge
    angle = 0.5 * np.pi * nodes
    force = (
        0.5
        * np.pi
        * weights
        @ (2.0 * np.pi * curve.pressure(a * np.cos(angle), a) * a**2 * np.sin(angle) * np.cos(angle))
    )
    assert force == pytest.approx(curve.force(depth), rel=1e-8)
    assert curve.pressure(np.array([a, 2 * a]), a) == pytest.approx([0.0, 0.0])


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: s.name)
def test_one_dimensional_profile_carries_the_force(shape: Shape) -> None:
    nodes, weights = gauss()
    for depth in (1e-3 * RADIUS, 0.1 * RADIUS):
        a = float(shape.load_curve.contact_radius(depth))
        assert shape.load_curve.depth(a) == pytest.approx(depth, rel=1e-12)
        row = 2.0 * a * (weights @ (depth - shape.load_curve.depth(a * nodes)))
        assert row == pytest.approx(float(shape.load_curve.force(depth)), rel=1e-12)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: s.name)
def test_one_dimensional_profile_is_abels_transform_of_the_slope(shape: Shape) -> None:
    nodes, weights = gauss()
    for x in (1e-3 * RADIUS, 0.5 * RADIUS):
        angle = 0.5 * np.pi * nodes
        transform = x * 0.5 * np.pi * (weights @ shape.slope(x * np.sin(angle)))
        assert shape.load_curve.depth(x) == pytest.approx(transform, rel=1e-10)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: s.name)
def test_slope_is_that_of_the_height(shape: Shape) -> None:
    r = RADIUS * np.array([1e-3, 0.1, 0.5, 0.9])
    slope = (shape.height(r * (1 + 1e-6)) - shape.height(r * (1 - 1e-6))) / (2e-6 * r)
    np.testing.assert_allclose(slope, shape.slope(r), rtol=1e-8)


def test_height_of_a_sphere_cancels_no_digit_and_ends() -> None:
    sphere = Sphere(RADIUS)
    assert float(sphere.height(1e-9 * RADIUS)) == pytest.approx(0.5e-18 * RADIUS, rel=1e-15)
    assert float(sphere.height(RADIUS)) == pytest.approx(RADIUS, rel=1e-15)
    assert float(sphere.height(1.01 * RADIUS)) == np.inf


def test_sphere_becomes_hertz_when_small() -> None:
    depth = 1e-9 * RADIUS
    assert SneddonSphere(RADIUS).force(depth) == pytest.approx(float(Hertz(RADIUS).force(depth)), rel=1e-9)
    # facts on finite elements: the parabola errs by 0.1 % in force at a/R = 0.1 and by 1.7 % at 0.4
    for ratio, error in [(0.1, 0.001), (0.4, 0.017)]:
        depth = float(Hertz(RADIUS).depth(ratio * RADIUS))
        assert Hertz(RADIUS).force(depth) / SneddonSphere(RADIUS).force(depth) - 1.0 == pytest.approx(error, rel=0.1)


def exact_sphere(ratio: float) -> tuple[float, float]:
    """F/(E* R^2) and a/R at a depth over R, of 50 digits: u tanh u is halved in between until it is the ratio."""
    with localcontext() as context:
        context.prec = 50
        low, high = Decimal(0), Decimal(ratio).sqrt() + Decimal(ratio)
        for _ in range(200):
            u = (low + high) / 2
            t = 1 - 2 / ((2 * u).exp() + 1)
            low, high = (u, high) if u * t < Decimal(ratio) else (low, u)
        return float((1 + t * t) * u - t), float(t)


def test_a_sphere_keeps_its_digits_at_every_depth() -> None:
    ratios = np.array([1e-12, 1e-6, 1e-3, 0.02, np.nextafter(SHALLOW, 0.0), SHALLOW, 0.1, 0.9, 3.0])
    exact = np.array([exact_sphere(float(ratio)) for ratio in ratios]).T
    curve = SneddonSphere(1.0)
    together, alone = (
        curve.force_and_slope(ratios),
        [curve.force_and_slope(one) for one in np.split(ratios, ratios.size)],
    )
    for found in (np.array(together), np.concatenate(alone, axis=-1)):
        np.testing.assert_allclose(found, [exact[0], 2.0 * exact[1]], rtol=1e-14)
    np.testing.assert_allclose([curve.contact_radius(float(ratio)) for ratio in ratios], exact[1], rtol=1e-15)


def test_overlap_with_a_half_space_is_depth_less_height() -> None:
    overlap = HalfSpace().overlap(Sphere(RADIUS), np.array([0.0, RADIUS / 2]), 1e-4)
    np.testing.assert_allclose(overlap, 1e-4 - Sphere(RADIUS).height(np.array([0.0, RADIUS / 2])))


def test_what_lies_between_sampled_depths_has_order_three_to_the_last_of_them() -> None:
    """A curve that stiffens, 0.35 m deep: half the distance, an eighth of the error, in the last interval too."""
    errors = []
    for count in (9, 17, 33):
        depths = np.geomspace(1e-3, 0.35, count)
        curve = SampledCurve(*(tuple(values) for values in (depths, stiffening(depths), depths**0.5)))
        between = np.geomspace(depths[-2], depths[-1], 15)
        errors.append(np.abs(np.asarray(curve.force(between)) / stiffening(between) - 1.0).max())
    assert errors[1] < errors[0] / 6.0
    assert errors[2] < errors[1] / 6.0


def test_a_flat_end_known_by_samples_is_struck_like_the_flat_end_itself() -> None:
    """A dashpot answers at once with its damping times the stiffness at touch, which no sample holds."""
    damped = Material(Relaxation(1e6, viscosity=500.0), 0.3)
    scene = Scene(Punch(2e-3), 0.05, 0.05, damped)
    depths = np.geomspace(1e-7, 1e-5, 5)
    exact = scene.load_curve
    sampled = SampledCurve(
        *(tuple(np.asarray(values)) for values in (depths, exact.force(depths), 2e-3 + 0.0 * depths))
    )
    ours, known = (simulate(laws.ting.of(one), one).quantities for one in (Answered.by(scene, sampled), scene))
    for name in ("peak_force", "peak_time", "duration", "restitution"):
        assert ours[name].value == pytest.approx(known[name].value, rel=1e-6)


def stiffening(depth: np.ndarray) -> np.ndarray:
    return np.asarray(depth**1.2 * (1.0 + 3.0 * depth**2))
