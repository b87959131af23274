"""Line contact: the audit's and the literature's tables, strips of pressure, datum points, the curves themselves."""

from __future__ import annotations

import numpy as np
import pytest
from limits import Johnson, Popov, compressible, hertz_pressure, incompressible
from scipy.optimize import brentq

from lumped.errors import BadInput, NotReached
from lumped.load_curves import (
    CylinderProfile,
    HalfPlane,
    LineLayer,
    LoadCurve,
    ParabolaProfile,
    PointLayer,
)
from lumped.load_curves.layer import deficit
from lumped.load_curves.plane_contact import collocation
from lumped.numbers import gauss

R, DATUM = 0.006, 0.1
CURVES: list[LoadCurve] = [
    LineLayer(ParabolaProfile(R), PointLayer(0.003, 0.3)),
    LineLayer(CylinderProfile(R), PointLayer(0.003, 0.5)),
    LineLayer(CylinderProfile(R), PointLayer(0.003, 0.3, "sliding")),
    HalfPlane(ParabolaProfile(R), DATUM, 0.3),
    HalfPlane(CylinderProfile(R), DATUM, 0.5),
    Johnson(R, DATUM, 0.3),
    Popov(R),
]
RADII = R * np.array([1e-6, 1e-3, 0.03, 0.2, 0.5])

# Audit 4d: R depth/h^2, then F/((pi/4) E* depth) and dlnF/dln depth for nu = 0.30, 0.45, 0.49, 0.50.
AUDIT = {
    0.01: (0.623, 1.18, 0.695, 1.21, 0.736, 1.22, 0.749, 1.23),
    0.02: (0.715, 1.22, 0.814, 1.25, 0.872, 1.27, 0.891, 1.28),
    0.05: (0.891, 1.27, 1.058, 1.33, 1.164, 1.37, 1.200, 1.39),
    0.1: (1.096, 1.33, 1.367, 1.42, 1.558, 1.48, 1.627, 1.51),
    0.2: (1.408, 1.40, 1.886, 1.52, 2.275, 1.62, 2.428, 1.66),
    0.5: (2.095, 1.47, 3.174, 1.61, 4.307, 1.77, 4.847, 1.85),
    1.0: (2.923, 1.49, 4.909, 1.64, 7.569, 1.85, 9.143, 1.98),
    2.0: (4.125, 1.50, 7.667, 1.64, 13.911, 1.90, 18.893, 2.12),
    5.0: (6.539, 1.50, 13.645, 1.61, 31.749, 1.89, 56.374, 2.27),
}
# Facts on the literature, 3.4, by a/h: R depth/h^2 and R F/(E* h^2) for nu = 0.30, 0.45, 0.49, 0.50. Eight Chebyshev
# terms whose convergence was not studied: 5e-4 of it at the end.
LITERATURE = {
    0.1: (0.01496, 0.00791, 0.01358, 0.00792, 0.01293, 0.00793, 0.01274, 0.00793),
    0.2: (0.04694, 0.03229, 0.04156, 0.03254, 0.03898, 0.03265, 0.03822, 0.03269),
    0.5: (0.20493, 0.22889, 0.17325, 0.23878, 0.15712, 0.24345, 0.15223, 0.24485),
    1.0: (0.65382, 1.2213, 0.53284, 1.3813, 0.46126, 1.4671, 0.43823, 1.4942),
    2.0: (2.28388, 7.9087, 1.82320, 10.345, 1.46194, 12.082, 1.32882, 12.710),
    4.0: (8.52852, 57.300, 6.98021, 91.539, 5.13133, 130.93, 4.21449, 150.58),
}
NUS = (0.3, 0.45, 0.49, 0.5)
FLAT = ParabolaProfile(1e4)


@pytest.mark.parametrize("sharpness", AUDIT)
def test_layer_has_the_ratios_and_exponents_of_the_audit(sharpness: float) -> None:
    depth = sharpness / FLAT.radius
    for nu, ratio, exponent in zip(NUS, AUDIT[sharpness][::2], AUDIT[sharpness][1::2], strict=True):
        force, slope = LineLayer(FLAT, PointLayer(1.0, nu)).force_and_slope(depth)
        assert force / (np.pi / 4.0 * depth) == pytest.approx(ratio, abs=1.2e-3, rel=1e-4)
        # the audit's exponents are differences over its grid: the last digit may be off by one
        assert depth * slope / force == pytest.approx(exponent, abs=0.0085)


@pytest.mark.parametrize("ratio", LITERATURE)
def test_layer_has_the_depths_and_forces_of_the_literature(ratio: float) -> None:
    for nu, depth, force in zip(NUS, LITERATURE[ratio][::2], LITERATURE[ratio][1::2], strict=True):
        here = LineLayer(FLAT, PointLayer(1.0, nu)).at(ratio)
        assert FLAT.radius * here.depth == pytest.approx(depth, rel=6e-4)
        assert FLAT.radius * here.force == pytest.approx(force, rel=8e-4)


def test_popovs_row_meets_the_layer_at_one_depth_only() -> None:
    for nu, printed in zip(NUS, (0.075, 0.042, 0.032, 0.030), strict=True):
        curve = LineLayer(FLAT, PointLayer(1.0, nu))

        def excess(x: float, curve: LineLayer = curve) -> float:
            return float(curve.force(x / FLAT.radius) / Popov(FLAT.radius).force(x / FLAT.radius)) - 1.0

        assert brentq(excess, 1e-3, 1.0) == pytest.approx(printed, abs=6e-4)


@pytest.mark.parametrize("curve", CURVES, ids=repr)
def test_contact_radius_and_depth_are_inverse(curve: LoadCurve) -> None:
    np.testing.assert_allclose(curve.contact_radius(curve.depth(RADII)), RADII, rtol=1e-10)
    assert float(curve.contact_radius(0.0)) == float(curve.force(0.0)) == float(curve.depth(0.0)) == 0.0


@pytest.mark.parametrize("curve", CURVES, ids=repr)
def test_slopes_are_those_of_force_and_depth(curve: LoadCurve) -> None:
    depths = np.asarray(curve.depth(RADII))
    step = 1e-5 * depths
    slope = (curve.force(depths + step) - curve.force(depths - step)) / (2.0 * step)
    np.testing.assert_allclose(curve.force_and_slope(depths)[1], slope, rtol=1e-8)
    change = (curve.depth(RADII * (1 + 1e-5)) - curve.depth(RADII * (1 - 1e-5))) / (2e-5 * RADII)
    np.testing.assert_allclose(curve.depth_slope(RADII), change, rtol=1e-8)


@pytest.mark.parametrize("curve", CURVES, ids=repr)
def test_force_is_the_slope_of_energy_and_the_sum_of_pressure(curve: LoadCurve) -> None:
    depths = np.asarray(curve.depth(RADII))
    step = 1e-4 * depths
    slope = (curve.energy(depths + step) - curve.energy(depths - step)) / (2.0 * step)
    np.testing.assert_allclose(slope, curve.force(depths), rtol=2e-7)
    nodes, weights = gauss(200)
    angle = 0.5 * np.pi * nodes
    for b, force in zip(RADII, curve.force(depths), strict=True):
        pressure = curve.pressure(b * np.sin(angle), float(b))
        assert np.pi * b * weights @ (pressure * np.cos(angle)) == pytest.approx(force, rel=1e-8)
    assert list(curve.pressure(np.array([b, 2.0 * b]), float(b))) == [0.0, 0.0]


def strips(edges: np.ndarray, layer: PointLayer) -> np.ndarray:
    """Displacement (E* = 1, thickness 1) at the middles by unit pressure on mirrored pairs of strips, shape (n, n)."""
    nodes, weights = gauss(20)
    last = 30.0 / np.diff(edges).min()
    panels = int(last)
    u = (last / panels * (np.arange(panels)[:, None] + nodes)).ravel()
    transforms = 2.0 * np.diff(np.sin(np.outer(u, edges)), axis=1) / u[:, None]
    near = np.minimum(u, 30.0)
    compliance = np.where(u < 30.0, 1.0 - deficit(layer.nu, layer.base, near), 1.0)
    density = 2.0 / np.pi * compliance / u * np.tile(last / panels * weights, panels)
    return np.asarray(np.cos(np.outer(0.5 * (edges[1:] + edges[:-1]), u)) * density @ transforms)


@pytest.mark.parametrize(
    "layer", [PointLayer(1.0, 0.3), PointLayer(1.0, 0.5), PointLayer(1.0, 0.3, "sliding")], ids=repr
)
def test_strips_of_pressure_in_equilibrium_with_the_profile_carry_the_same_force(layer: PointLayer) -> None:
    curve, b, errors = LineLayer(ParabolaProfile(10.0), layer), 1.3, []
    for count in (20, 40, 80):
        edges = b * np.arange(count + 1) / count
        middles = 0.5 * (edges[1:] + edges[:-1])
        pressure = np.linalg.solve(strips(edges, layer), float(curve.depth(b)) - middles**2 / 20.0)
        errors.append(abs(2.0 * pressure @ np.diff(edges) / float(curve.force_at(b)) - 1.0))
    assert errors[-1] < 1e-3
    assert np.all(np.array(errors[:-1]) / errors[1:] > 1.9)


def test_deep_layer_presses_as_hertz_does() -> None:
    b = 1e-5
    for layer in (PointLayer(1.0, 0.3), PointLayer(1.0, 0.5), PointLayer(1.0, 0.3, "sliding")):
        curve = LineLayer(ParabolaProfile(R), layer)
        assert float(curve.force_at(b)) == pytest.approx(np.pi * b**2 / (4.0 * R), rel=1e-9)
        x = b * np.array([0.0, 0.5, 0.9, 0.999])
        assert curve.pressure(x, b) == pytest.approx(hertz_pressure(x, b, R), rel=1e-8)


def test_half_plane_has_the_closed_form_of_hertz_pressure_down_to_the_datum() -> None:
    nu, b = 0.3, np.array([1e-5, 1e-3, 0.02, 0.09])
    curve = HalfPlane(ParabolaProfile(R), DATUM, nu)
    # strain below the middle of Hertz' pressure, integrated from the surface to the datum
    side = nu / (1.0 - nu) * DATUM / b * (np.hypot(b, DATUM) - DATUM)
    exact = b / (2.0 * R) * (b * np.arcsinh(DATUM / b) - side)
    np.testing.assert_allclose(curve.depth(b), exact, rtol=1e-9)
    np.testing.assert_allclose(curve.force_at(b), np.pi * b**2 / (4.0 * R), rtol=1e-9)
    x = 0.02 * np.array([0.0, 0.3, 0.99, 1.0])
    assert curve.pressure(x, 0.02) == pytest.approx(hertz_pressure(x, 0.02, R), rel=1e-10)


def test_johnson_errs_with_the_square_of_half_width_over_datum() -> None:
    b = DATUM * np.array([1e-3, 1e-2, 1e-1])
    exact = HalfPlane(ParabolaProfile(R), DATUM, 0.45).depth(b)
    errors = np.abs(Johnson(R, DATUM, 0.45).depth(b) - exact) / b**2
    assert np.diff(np.log10(errors)) == pytest.approx([2.0, 2.0], abs=0.01)


def test_true_cylinder_differs_from_the_parabola_with_the_square_of_its_size() -> None:
    b = R * np.array([0.003, 0.03, 0.3])
    true, parabola = (
        LineLayer(shape(R), PointLayer(0.003, 0.4)).force_at(b) for shape in (CylinderProfile, ParabolaProfile)
    )
    assert np.diff(np.log10(true / parabola - 1.0)) == pytest.approx([2.0, 2.0], abs=0.06)


def test_force_grows_with_nu_on_a_bonded_layer_and_sinks_with_the_datum() -> None:
    bonded = [
        float(LineLayer(CylinderProfile(R), PointLayer(0.003, nu)).force(5e-4)) for nu in (0.0, 0.3, 0.45, 0.49, 0.5)
    ]
    assert np.all(np.diff(bonded) > 0.0)
    deep = [float(HalfPlane(CylinderProfile(R), datum, 0.3).force(5e-4)) for datum in (0.02, 0.1, 1.0)]
    assert np.all(np.diff(deep) < 0.0)


def test_thin_layers_are_winklers_or_squeezed() -> None:
    thin, curve = compressible(1e4, PointLayer(1.0, 0.3), plane=True), LineLayer(FLAT, PointLayer(1.0, 0.3))
    gaps = np.array([1.0 - float(curve.force_at(b) / thin.force(curve.depth(b))) for b in (5.0, 10.0, 20.0)])
    assert abs(gaps[-1]) < 3e-4
    assert np.all(gaps[:-1] / gaps[1:] > 3.0)
    thin, curve = incompressible(1e4, PointLayer(1.0, 0.5), plane=True), LineLayer(FLAT, PointLayer(1.0, 0.5))
    ratios = [float(curve.force_at(b) / thin.force(curve.depth(b))) for b in (2.0, 4.0)]
    assert ratios == pytest.approx([2.12, 1.40], abs=0.006)
    excess = np.array([float(curve.force_at(b) / thin.force(curve.depth(b))) - 1.0 for b in (5.0, 10.0, 20.0)])
    assert np.all(np.log2(excess[:-1] / excess[1:]) > 1.5)


@pytest.mark.parametrize("ratio", [0.1, 2.0, 20.0])
def test_collocation_converges_faster_than_any_power(ratio: float) -> None:
    curve = LineLayer(FLAT, PointLayer(1.0, 0.45))
    exact = curve.grown(ratio, 2.0)
    errors = [abs(curve.grown(ratio, refinement).force / exact.force - 1.0) for refinement in (0.3, 0.5, 1.0)]
    assert errors[2] < 1e-10
    assert errors[1] < 1e-2 * errors[0] or errors[1] < 1e-10


@pytest.mark.parametrize("order", [0, 2, 6])
def test_weights_of_the_singular_kernels_are_exact_for_polynomials(order: int) -> None:
    rule = collocation(12)
    nodes, weights = gauss(400)
    chebyshev = np.cos(order * np.arccos(np.concatenate([rule.nodes, -rule.nodes])))
    for y, logarithm, distance in zip(rule.nodes, rule.logarithm @ chebyshev, rule.distance @ chebyshev, strict=True):
        turn, log_sum, distance_sum = np.arccos(y), 0.0, 0.0
        for other in (0.0, np.pi):
            offset = (other - turn) * nodes**4
            measure = abs(other - turn) * 4.0 * nodes**3 * weights * np.cos(order * (turn + offset))
            gap = 2.0 * np.abs(np.sin(turn + 0.5 * offset) * np.sin(0.5 * offset))
            log_sum -= measure @ np.log(gap)
            distance_sum += measure @ gap
        assert (logarithm, distance) == pytest.approx((log_sum, distance_sum), abs=1e-9)


def test_impossible_line_contacts_are_named() -> None:
    with pytest.raises(BadInput, match="datum_depth"):
        HalfPlane(CylinderProfile(R), 0.0, 0.3)
    with pytest.raises(BadInput, match="nu"):
        Johnson(R, DATUM, 0.6)
    with pytest.raises(BadInput, match="radius"):
        CylinderProfile(-1.0)
    with pytest.raises(BadInput, match="thickness"):
        LineLayer(CylinderProfile(R), PointLayer(0.003, 0.3)).force(0.003)
    with pytest.raises(NotReached, match="datum"):
        Johnson(R, 0.01, 0.3).force(0.05)
    with pytest.raises(NotReached, match="grows beyond"):
        LineLayer(FLAT, PointLayer(1.0, 0.3)).force(0.9)
