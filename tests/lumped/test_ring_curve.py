"""The cylinder inside a ring: the annulus against Ritz, the contact against elements of pressure, layers and facts."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import nnls
from scipy.special import j1

from lumped import Material, Relaxation, Scene, laws, simulate
from lumped.errors import BadInput, NotReached
from lumped.load_curves import CylinderProfile, LineLayer, PointLayer, RodInRing
from lumped.load_curves.plane_contact import collocation
from lumped.load_curves.ring import compliances, hole, ring_compliance
from lumped.numbers import gauss
from lumped.shapes.cylinder import Cylinder
from lumped.targets.ring import Ring

RINGS = [
    RodInRing(0.006, 0.010, 0.003, 0.3),
    RodInRing(0.0099, 0.010, 0.003, 0.49),
    RodInRing(0.006, 0.010, 0.003, 0.5),
]
SHARES = np.array([1e-9, 1e-3, 0.04, 0.2, 0.49])

# Facts on finite elements, section 4: R = 6, inner radius 10, thickness 3; F/((pi/4) E* depth) at depths 0.001, 0.01.
ELEMENTS = {0.3: (0.48, 0.70), 0.4: (0.50, 0.76), 0.45: (0.52, 0.81), 0.49: (0.55, 0.88), 0.4999: (0.56, 0.91)}


def ritz(nu: float, ratio: float, n: int, terms: int = 24) -> float:
    """c_n from the least energy of u_r = U(r) cos(n theta), u_theta = V(r) sin(n theta), polynomials; E* = 1."""
    shear = 0.5 * (1.0 - nu)
    lame = 2.0 * shear * nu / (1.0 - 2.0 * nu)
    nodes, weights = gauss(60)
    depth = 1.0 / ratio - 1.0
    r, w = 1.0 + depth * nodes, depth * weights * (1.0 + depth * nodes)
    basis = [
        np.polynomial.Legendre.basis(k, (0.0, 1.0))
        * np.polynomial.Polynomial([1.0, -1.0])(np.polynomial.Legendre.identity((0.0, 1.0)))
        for k in range(terms)
    ]
    value, slope = (np.array([f(nodes) for f in fs]) for fs in (basis, [f.deriv() / depth for f in basis]))
    zero = np.zeros_like(value)
    radial, hoop = np.concatenate([slope, zero]), np.concatenate([value, n * value]) / r
    sheared = np.concatenate([-n * value / r, slope - value / r])
    stiff = (lame + 2.0 * shear) * (radial * w @ radial.T + hoop * w @ hoop.T)
    stiff += lame * (radial * w @ hoop.T + hoop * w @ radial.T) + (shear * sheared * w @ sheared.T if n else 0.0)
    load = np.concatenate([[f(0.0) for f in basis], np.zeros(terms)])
    used = slice(None) if n else slice(terms)
    return float(load[used] @ np.linalg.solve(stiff[used, used], load[used]))


@pytest.mark.parametrize("nu", [-0.3, 0.0, 0.3, 0.49])
def test_compliances_are_those_of_least_energy(nu: float) -> None:
    for ratio in (10.0 / 13.0, 0.5):
        own = compliances(nu, ratio)
        assert [ritz(nu, ratio, n) for n in (0, 1, 2, 3, 8)] == pytest.approx(own[[0, 1, 2, 3, 8]], rel=1e-10)


def test_short_waves_see_a_hole_the_sooner_the_thicker_the_annulus() -> None:
    for ratio in (0.5, 0.8):
        own = compliances(0.3, ratio)
        gaps = np.abs(own[2:] / hole(0.3, np.arange(2.0, own.size)) - 1.0)
        assert gaps[-1] < 1e-14
        # the image in the outer circle: ratio^(2n), times a square of n
        halves = np.arange(8, 17)
        slope = np.diff(np.log(gaps[halves] / (halves + 2.0) ** 2))
        assert slope == pytest.approx(np.full(8, 2.0 * np.log(ratio)), abs=0.07)


def test_kernel_is_the_series_it_sums() -> None:
    nu, ratio, angle = 0.3, 10.0 / 13.0, 1.1
    rule = collocation(60)
    theta = angle * rule.nodes
    q = 1.0 - rule.nodes**2
    own = compliances(nu, ratio)
    orders = np.arange(200000)
    coefficients = np.concatenate([own, hole(nu, orders[own.size :].astype(float))])
    # p = sqrt(1 - y^2): its cosine transform is Bessel's J1
    at = np.maximum(orders * angle, 1e-9)
    waves = np.where(orders == 0, 0.5, 1.0) * angle * j1(at) / at
    series = [float(coefficients @ (waves * np.cos(orders * place))) for place in theta[::20]]
    assert (ring_compliance(nu, ratio, rule, angle) @ q)[::20] == pytest.approx(series, abs=1e-7)


@pytest.mark.family
@pytest.mark.parametrize("ring", RINGS, ids=repr)
def test_slopes_energy_and_inverse(ring: RodInRing) -> None:
    depths = ring.depth_limit * SHARES
    step = 1e-5 * depths
    force, slope = ring.force_and_slope(depths)
    np.testing.assert_allclose((ring.force(depths + step) - ring.force(depths - step)) / (2.0 * step), slope, rtol=1e-8)
    np.testing.assert_allclose(
        (ring.energy(depths + step) - ring.energy(depths - step)) / (2.0 * step), force, rtol=1e-7
    )
    np.testing.assert_allclose(ring.depth(ring.contact_radius(depths)), depths, rtol=2e-8)
    # the deepest of the conforming ring is where the half-angle ends to grow
    radii = ring.contact_radius(depths[1:4])
    change = (ring.depth(radii * (1 + 1e-6)) - ring.depth(radii * (1 - 1e-6))) / (2e-6 * radii)
    np.testing.assert_allclose(ring.depth_slope(radii), change, rtol=2e-4)
    assert float(ring.force(0.0)) == float(ring.contact_radius(-1.0)) == float(ring.depth(0.0)) == 0.0


@pytest.mark.parametrize("ring", RINGS, ids=repr)
def test_what_bends_is_what_a_held_arc_presses_beyond_its_slope(ring: RodInRing) -> None:
    """The second difference of the force on one arc, over circles that overlap as they do."""
    depth = 0.2 * ring.thickness
    angle = float(ring.contact_radius(depth)) / ring.inner_radius
    rule = collocation(100)
    theta, ratio = angle * rule.nodes, ring.inner_radius / (ring.inner_radius + ring.thickness)
    matrix = ring.inner_radius * ring_compliance(ring.nu, ratio, rule, angle)

    def held(distance: float) -> float:
        leaves = distance * np.cos(theta) + np.sqrt(ring.radius**2 - (distance * np.sin(theta)) ** 2)
        pressed = np.linalg.solve(matrix, leaves - ring.inner_radius)
        return ring.inner_radius * angle * float(rule.total(np.asarray(pressed * np.cos(theta))))

    here, step = ring.clearance + depth, 1e-2 * depth
    second = (held(here + step) - 2.0 * held(here) + held(here - step)) / step**2
    assert ring.bending(depth) == pytest.approx(second, rel=1e-3)


def test_the_bars_of_ting_in_a_ring_grow_as_the_square_of_the_depth() -> None:
    """Twice as fast, about twice as deep, four times what the overlaps bend by; none where nothing relaxes."""
    slow, fast = (bars_in_a_ring(speed, Relaxation(6e5, (6e5,), (2e-3,))) for speed in (0.02, 0.04))
    for name in ("duration", "restitution", "impulse", "history_l2"):
        assert fast[name] == pytest.approx(4.0 * slow[name], rel=0.2)
    assert max(bars_in_a_ring(0.04, Relaxation(6e5)).values()) < 0.1 * min(slow.values())


def bars_in_a_ring(speed: float, young: Relaxation) -> dict[str, float]:
    """Relative, of what the rebound alone decides."""
    scene = Scene(Cylinder(0.006, 0.03), 0.05, speed, Material(young, 0.3), target=Ring(0.0068, 0.005))
    result = simulate(laws.ting.of(scene), scene, 1e-8)
    assert result.method == "ting"
    found = result.quantities
    return {
        n: (found[n].error or 0.0) / (found[n].value or 1.0)
        for n in ("duration", "restitution", "impulse", "history_l2")
    }


@pytest.mark.parametrize("ring", RINGS, ids=repr)
def test_pressure_carries_the_force_and_fits_the_surface_to_the_cylinder(ring: RodInRing) -> None:
    depth = 0.2 * ring.thickness
    half = float(ring.contact_radius(depth)) / ring.inner_radius
    nodes, weights = gauss(400)
    turn = 0.5 * np.pi * nodes
    theta = half * np.sin(turn)
    pressure = ring.pressure_at(ring.inner_radius * theta, depth)
    measure = np.pi * ring.inner_radius * half * weights * np.cos(turn)
    assert measure @ (pressure * np.cos(theta)) == pytest.approx(float(ring.force(depth)), rel=1e-8)
    own = compliances(ring.nu, ring.inner_radius / (ring.inner_radius + ring.thickness))
    orders = np.arange(400)
    coefficients = np.concatenate([own, hole(ring.nu, orders[own.size :].astype(float))])[:400]
    waves = np.where(orders == 0, 0.5, 1.0) / np.pi * (np.cos(np.outer(orders, theta)) @ (pressure * measure))
    distance = ring.clearance + depth

    def gap(place: np.ndarray) -> np.ndarray:
        moved = np.cos(np.outer(place, orders)) @ (coefficients * waves)
        arc = np.sqrt(ring.radius**2 - (distance * np.sin(place)) ** 2)
        return np.asarray(moved - (distance * np.cos(place) + arc - ring.inner_radius))

    # 400 waves leave the tail of a root at the edge: n^(-5/2)
    assert np.abs(gap(half * np.array([0.0, 0.4, 0.8]))).max() < 3e-5 * depth
    assert np.all(gap(half * np.array([1.05, 1.2, 1.4])) > 1e-3 * depth)


def elements(ring: RodInRing, depth: float, count: int) -> float:
    """F/E* with constant pressure on equal arcs, none of it negative, by the Fourier series at their middles."""
    widest = 1.6 * float(ring.contact_radius(depth)) / ring.inner_radius
    theta, width = widest * (np.arange(count) + 0.5) / count, widest / count
    orders = np.arange(4 * int(np.pi / width))
    own = compliances(ring.nu, ring.inner_radius / (ring.inner_radius + ring.thickness))
    coefficients = np.concatenate([own, hole(ring.nu, orders[own.size :].astype(float))])[: orders.size]
    cosines = np.cos(np.outer(theta, orders))
    strip = np.where(orders == 0, 0.5, 1.0) * coefficients * 2.0 * width / np.pi * np.sinc(0.5 * orders * width / np.pi)
    matrix = (cosines * strip) @ cosines.T
    distance = ring.clearance + depth
    overlap = distance * np.cos(theta) + np.sqrt(ring.radius**2 - (distance * np.sin(theta)) ** 2) - ring.inner_radius
    # pressure >= 0, gap >= 0, one of them 0: the least of p K p/2 - p overlap over p >= 0
    root = np.linalg.cholesky(matrix)
    pressure, _ = nnls(root.T, np.linalg.solve(root, overlap))
    return float(2.0 * width * (pressure @ np.cos(theta)))


@pytest.mark.parametrize("ring", RINGS, ids=repr)
def test_elements_of_pressure_carry_the_same_force(ring: RodInRing) -> None:
    depth = 0.1 * ring.thickness
    errors = [abs(elements(ring, depth, count) / float(ring.force(depth)) - 1.0) for count in (60, 120, 240)]
    assert errors[-1] < 2e-3
    assert errors[0] / errors[-1] > 3.0


def test_ring_of_little_curvature_is_a_layer() -> None:
    depth, gaps = 2e-5, []
    for inner in (0.01, 0.03, 0.09):
        ring = RodInRing(0.0006, inner, 0.0003, 0.4)
        effective = ring.radius * inner / ring.clearance
        gaps.append(
            float(ring.force(depth) / LineLayer(CylinderProfile(effective), PointLayer(0.0003, 0.4)).force(depth)) - 1.0
        )
    assert np.diff(np.log10(np.abs(gaps))) == pytest.approx([-np.log10(3.0)] * 2, abs=0.05)


@pytest.mark.parametrize("nu", ELEMENTS)
def test_shallow_contacts_agree_with_the_finite_elements_of_the_facts(nu: float) -> None:
    depths = np.array([1e-3, 1e-2])
    ratios = RodInRing(6.0, 10.0, 3.0, nu).force(depths) / (np.pi / 4.0 * depths)
    assert ratios == pytest.approx(ELEMENTS[nu], abs=6e-3)


def test_force_grows_with_nu_and_as_the_clearance_closes() -> None:
    by_nu = [float(RodInRing(6.0, 10.0, 3.0, nu).force(0.1)) for nu in (0.0, 0.3, 0.45, 0.49, 0.5)]
    assert np.all(np.diff(by_nu) > 0.0)
    by_radius = [float(RodInRing(radius, 10.0, 3.0, 0.3).force(0.1)) for radius in (3.0, 6.0, 9.0, 9.9)]
    assert np.all(np.diff(by_radius) > 0.0)


def test_a_rod_pulled_away_at_once_turns_where_a_free_body_would() -> None:
    """Its load is lost in the rounding of the clearance where it begins."""
    scene = Scene.load("rod-in-ring", {"model.gravity": -1e5})
    found = laws.correspondence.estimate(scene)
    assert found.peak_depth == pytest.approx(scene.velocity**2 / 2e5, rel=1e-3)
    assert found.duration == pytest.approx(2.0 * scene.velocity / 1e5, rel=1e-3)


def test_impossible_rings_are_named() -> None:
    for sizes, key in (
        ((10.0, 10.0, 3.0), "inner_radius"),
        ((-1.0, 10.0, 3.0), "radius"),
        ((6.0, 10.0, 0.0), "thickness"),
    ):
        with pytest.raises(BadInput) as caught:
            RodInRing(*sizes, nu=0.3)
        assert [fault.key for fault in caught.value.faults] == [key]
    with pytest.raises(BadInput, match="nu"):
        RodInRing(6.0, 10.0, 3.0, 0.6)
    with pytest.raises(BadInput, match="thickness"):
        RINGS[0].force(0.003)
    with pytest.raises(NotReached, match="no end"):
        RodInRing(9.99, 10.0, 3.0, 0.5).force(2.0)
