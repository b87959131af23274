"""Profiles whose face bends: a table of heights, a rounded flat end, a cone with a sphere at its tip."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, trapezoid

from lumped import BadInput, Scene, laws, simulate
from lumped.load_curves import ConeCurve, Hertz, LayerCurve, LayerPunch, PointLayer, SneddonSphere
from lumped.load_curves.bent import BentCurve
from lumped.load_curves.half_space import KnownByRadius
from lumped.load_curves.layer import deficit
from lumped.numbers import gauss
from lumped.shapes import Shape, Sphere
from lumped.shapes.profile import Profile, read
from lumped.shapes.rounded_punch import RoundedPunch
from lumped.shapes.sphere_cone import SphereCone
from lumped.targets.layer import Layer

RADIUS = 0.006
TABLE = Profile((0.0, 1e-3, 1.5e-3, 2.5e-3, 4e-3), (0.0, 2e-5, 6e-5, 2e-4, 9e-4))
PLATEAU = Profile((0.0, 1e-3, 2e-3, 3e-3), (0.0, 0.0, 1e-4, 4e-4))
BENT: list[Shape] = [SphereCone(RADIUS, 19.7), SphereCone(RADIUS, 80.0), RoundedPunch(2e-3, RADIUS), TABLE, PLATEAU]
WIDER = np.array([1.0 + 1e-6, 1.03, 1.3, 2.1, 7.0])


def curve_of(shape: Shape) -> KnownByRadius:
    curve = shape.load_curve
    assert isinstance(curve, KnownByRadius)
    return curve


def widths(curve: KnownByRadius) -> np.ndarray:
    """Contact radii between the bends and beyond, each side of every bend, m."""
    places = [place for place in curve.breaks if place > curve.least_radius] or [curve.breaks[-1]]
    found = np.unique(np.concatenate([np.multiply.outer(places, WIDER).ravel(), 0.9 * np.array(places)]))
    return found[found > curve.least_radius]


def abel(shape: Shape, a: float) -> float:
    """a int_0^a h'(r)/sqrt(a^2 - r^2) dr, from bend to bend."""
    curve = curve_of(shape)
    ends = np.arcsin(np.array([0.0, *(place for place in curve.breaks if 0.0 < place < a), a]) / a)
    parts = [
        quad(lambda angle: float(shape.slope(a * np.sin(angle))), low, high, epsabs=0.0, epsrel=1e-12)[0]
        for low, high in pairwise(ends)
        if float(shape.slope(a * np.sin(high))) > 0.0
    ]
    return a * sum(parts)


@pytest.mark.parametrize("shape", BENT, ids=lambda shape: shape.name)
def test_a_few_looks_find_the_contact_radius_of_any_depth(shape: Shape, monkeypatch: pytest.MonkeyPatch) -> None:
    """Laws ask for it at every trial of a step, under much gravity at depths that are hardly any."""
    curve, looks = curve_of(shape), list[int]()
    asked = type(curve).depth_and_slope

    def counted(curve: KnownByRadius, radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        looks.append(radius.size)
        return asked(curve, radius)

    monkeypatch.setattr(type(curve), "depth_and_slope", counted)
    depths = 10.0 ** np.arange(-150.0, -2.0)
    found = curve.contact_radius(depths)
    assert len(looks) <= 8
    assert np.all(np.diff(found) >= 0.0)
    flat = curve.least_radius  # beside which hardly any depth makes no difference
    seen = depths > 1e-9 * flat
    assert curve.depth(found[seen]) == pytest.approx(depths[seen], rel=1e-9 if flat else 1e-13)
    assert found[~seen] == pytest.approx(flat, rel=1e-4)


def test_a_profile_that_turns_steep_at_once_has_the_contact_radius_of_its_depth() -> None:
    """Newton's steps alone go to and fro across such a turn for ever, and the force was a hundred times too large."""
    slopes, radii = np.array([0.01, 0.02, 0.2, 0.5, 0.6, 0.8, 1.2]), np.array([0, 0.1, 0.3, 0.305, 0.31, 0.5, 1, 3])
    curve = Profile(tuple(radii), (0.0, *np.cumsum(slopes * np.diff(radii)))).load_curve
    wide = np.linspace(0.05, 1.0, 40)
    for depths in (curve.depth(wide), *curve.depth(wide)[:, np.newaxis]):
        assert curve.depth(curve.contact_radius(depths)) == pytest.approx(depths, rel=1e-10)
    # F = int 2 a dd
    depths = np.linspace(0.005, 0.01, 2001)
    assert np.diff(curve.force(depths[[0, -1]])) == pytest.approx(2.0 * trapezoid(curve.contact_radius(depths), depths))


@pytest.mark.parametrize("shape", BENT, ids=lambda shape: shape.name)
def test_the_depth_is_abels_transform_of_the_slope(shape: Shape) -> None:
    for a in widths(curve_of(shape)):
        assert float(curve_of(shape).depth(a)) == pytest.approx(abel(shape, float(a)), rel=1e-10)


@pytest.mark.parametrize("shape", BENT, ids=lambda shape: shape.name)
def test_depth_radius_force_slope_and_energy_belong_together(shape: Shape) -> None:
    curve, a = curve_of(shape), widths(curve_of(shape))
    depth, step = curve.depth(a), 1e-6
    np.testing.assert_allclose(curve.contact_radius(depth), a, rtol=1e-12)
    assert float(curve.contact_radius(float(depth[-1]))) == pytest.approx(a[-1], rel=1e-13), "of a number too"
    rise = (curve.depth(a * (1.0 + step)) - curve.depth(a * (1.0 - step))) / (2.0 * step * a)
    inside = (a > 1.001 * curve.least_radius) & (np.abs(np.subtract.outer(a, curve.breaks)).min(axis=-1) > 1e-4 * a)
    np.testing.assert_allclose(rise[inside], curve.depth_slope(a)[inside], rtol=1e-7)
    depth = depth[a > 1.001 * curve.least_radius]  # nearer, what radii are found to counts
    force = (curve.energy(depth * (1.0 + step)) - curve.energy(depth * (1.0 - step))) / (2.0 * step * depth)
    np.testing.assert_allclose(force, curve.force(depth), rtol=1e-7)
    np.testing.assert_allclose(curve.force(curve.depth(a)), curve.force_at(a), rtol=1e-11)
    slope = (curve.force(depth * (1.0 + step)) - curve.force(depth * (1.0 - step))) / (2.0 * step * depth)
    np.testing.assert_allclose(slope, 2.0 * a[-depth.size :], rtol=1e-7)


@pytest.mark.parametrize("shape", BENT, ids=lambda shape: shape.name)
def test_the_pressure_carries_the_force(shape: Shape) -> None:
    curve = curve_of(shape)
    a = 1.7 * curve.breaks[-1]
    circles = np.arccos(np.array([0.0, *(place for place in curve.breaks if place > 0.0), a]) / a)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    force = 0.0
    for high, low in pairwise(circles):  # r = a cos(angle) takes out the root at the edge
        angle = low + (high - low) * 0.5 * (nodes + 1.0)
        rings = 2.0 * np.pi * a**2 * np.sin(angle) * np.cos(angle)
        force += 0.5 * (high - low) * weights @ (rings * curve.pressure(a * np.cos(angle), a))
    assert force == pytest.approx(float(curve.force_at(a)), rel=1e-5 if shape.name == "profile" else 1e-6)
    assert curve.pressure(np.array([a, 2.0 * a]), a) == pytest.approx([0.0, 0.0], abs=1e-9)


def test_a_sphere_cone_is_a_sphere_when_shallow_and_a_cone_when_deep() -> None:
    curve, depth = SphereCone(RADIUS, 30.0).load_curve, 0.01 * RADIUS
    assert float(curve.force(depth)) == pytest.approx(float(SneddonSphere(RADIUS).force(depth)), rel=1e-14)
    # Deep, its tip is missing from the cone's: depths are less by a constant.
    deep, cone = 1e5 * RADIUS, ConeCurve(30.0)
    assert float(curve.force(deep)) == pytest.approx(float(cone.force(deep)), rel=1e-4)
    assert curve.contact_radius(deep) == pytest.approx(float(cone.contact_radius(deep)), rel=1e-4)


def test_a_rounded_punch_presses_as_a_flat_one_first_and_as_its_edge_alone_without_a_flat() -> None:
    punch = RoundedPunch(2e-3, RADIUS).load_curve
    assert float(punch.force(1e-12)) == pytest.approx(2.0 * 2e-3 * 1e-12, rel=1e-5)
    edge = RoundedPunch(1e-9, RADIUS).load_curve
    assert float(edge.force(1e-4)) == pytest.approx(float(Hertz(RADIUS).force(1e-4)), rel=1e-5)


convex = st.lists(st.tuples(st.floats(0.05, 1.0), st.floats(0.01, 1.0)), min_size=3, max_size=30)


@given(convex)
def test_a_table_is_met_and_stays_convex(rows: list[tuple[float, float]]) -> None:
    width, bend = np.array(rows).T
    r = np.append(0.0, np.cumsum(width))
    height = np.append(0.0, np.cumsum((1e-3 + np.cumsum(bend)) * width))
    profile = Profile(tuple(r.tolist()), tuple(height.tolist()))
    np.testing.assert_allclose(profile.height(r), height, rtol=1e-6, atol=1e-7 * height[-1])
    slope = profile.slope(np.linspace(0.0, r[-1], 1001))
    assert np.all(np.diff(slope) >= -1e-6 * slope[-1])
    assert slope[0] >= 0.0


def test_a_table_of_a_sphere_answers_as_the_sphere_to_second_order() -> None:
    def off(rows: int) -> float:
        r = np.linspace(0.0, 0.6 * RADIUS, rows)
        table = Profile(tuple(r.tolist()), tuple(Sphere(RADIUS).height(r).tolist()))
        return abs(float(table.load_curve.force(0.1 * RADIUS)) / float(SneddonSphere(RADIUS).force(0.1 * RADIUS)) - 1.0)

    assert off(41) < 1e-4
    assert off(81) < 0.35 * off(41)


@pytest.mark.family
@pytest.mark.parametrize("shape", [SphereCone(RADIUS, 19.7), TABLE], ids=lambda shape: shape.name)
def test_ting_and_the_springs_agree(shape: Shape, impact: Callable[..., Scene]) -> None:
    scene = impact(0.5, (0.5,), (1.0,), shape=shape)
    exact, row = (simulate(laws.get(law).of(scene), scene, 1e-5) for law in ("ting", "mdr"))
    for name in ("peak_force", "peak_depth", "duration", "restitution"):
        assert exact.quantities[name].value == pytest.approx(row.quantities[name].value, rel=1e-5)


THICKNESS = 4e-3
BONDED = PointLayer(THICKNESS, 0.3)


@pytest.mark.parametrize("layer", [BONDED, PointLayer(THICKNESS, 0.5), PointLayer(THICKNESS, 0.3, "sliding")], ids=str)
def test_a_bend_that_is_none_changes_nothing_on_a_layer(layer: PointLayer) -> None:
    """A parabola with a break in it: the panels that begin as a root does meet the smooth ones, which know of none."""
    depth = THICKNESS * np.array([1e-6, 1e-3, 0.02, 0.0401, 0.08, 0.3])
    broken, smooth = LayerCurve(BentCurve((0.0, 1e-3), (1.0 / RADIUS, 0.0)), layer), LayerCurve(Hertz(RADIUS), layer)
    for ours, theirs in zip(broken.force_and_slope(depth), smooth.force_and_slope(depth), strict=True):
        assert ours == pytest.approx(theirs, rel=3e-8)


@pytest.mark.family
@pytest.mark.parametrize("shape", [SphereCone(RADIUS, 19.7), RoundedPunch(1e-3, RADIUS), PLATEAU], ids=lambda s: s.name)
def test_on_a_layer_a_bend_is_met_from_both_sides(shape: Shape) -> None:
    """Radius and depth are inverse, the edge meets the surface with a flat end's stiffness, and force is work's slope;
    a layer as thick as the world is the half-space.
    """
    curve, bend = LayerCurve(curve_of(shape), BONDED), curve_of(shape).breaks[-1]
    places = bend * WIDER[:4]
    depth, force, step = np.asarray(curve.depth(places)), np.asarray(curve.force_at(places)), 1e-5
    assert curve.contact_radius(depth) == pytest.approx(places, rel=1e-9)
    around = (np.asarray(curve.force(depth * (1.0 + side * step))) for side in (1.0, -1.0))
    slope = curve.force_and_slope(depth)[1]
    assert np.subtract(*around)[1:] == pytest.approx((2.0 * step * depth * slope)[1:], rel=1e-6)
    work = quad(lambda at: float(curve.force(at)), 0.0, depth[-1], epsabs=0.0, epsrel=1e-8, points=depth[:1])[0]
    assert float(curve.energy(depth[-1])) == pytest.approx(work, rel=1e-6)
    assert np.all(force > np.asarray(curve_of(shape).force(depth))), "a foundation stiffens"
    thick = LayerCurve(curve_of(shape), PointLayer(1e5, 0.3))
    assert thick.force(depth) == pytest.approx(curve_of(shape).force(depth), rel=1e-6)


def test_a_rounded_end_of_no_width_is_a_sphere_and_of_no_edge_a_punch_on_a_layer() -> None:
    depth = 0.05 * THICKNESS
    force = [float(LayerCurve(BentCurve((b,), (1.0 / RADIUS,)), BONDED).force(depth)) for b in (1e-4, 5e-5)]
    sphere = float(LayerCurve(Hertz(RADIUS), BONDED).force(depth))
    assert (force[0] - sphere) / (force[1] - sphere) == pytest.approx(2.0, rel=0.1), "to first order"
    edges = [1e-5, 1e-6]
    force = [float(LayerCurve(BentCurve((2e-3,), (1.0 / edge,)), BONDED).force(depth)) for edge in edges]
    punch = float(LayerPunch(2e-3, BONDED).force(depth))
    assert 0.0 < force[1] / punch - 1.0 < 0.5 * (force[0] / punch - 1.0) < 0.05


def equilibrium(curve: KnownByRadius, layer: PointLayer, a: float) -> tuple[float, float]:
    """Depth and F/E* under a face with one bend, all lengths in thicknesses.

    By the integral equation, solved at once for phi and the depth, with phi(a) = 0.
    """
    nodes, weights = gauss(120)
    crowded, each = np.sin(0.5 * np.pi * nodes) ** 2, 0.5 * np.pi * np.sin(np.pi * nodes) * weights
    (b,) = (one for one in curve.breaks if one > 0.0)
    t = np.concatenate([b * crowded, b + (a - b) * crowded])
    dt = np.concatenate([b * each, (a - b) * each])
    u, du = (np.arange(25)[:, None] + gauss(24)[0]).ravel(), np.tile(gauss(24)[1], 25)
    waves = np.cos(np.outer(np.append(t, a), u))
    kernel = 2.0 / np.pi * (waves * (du * deficit(layer.nu, layer.base, u))) @ waves[:-1].T
    matrix = np.block([[np.eye(t.size) - kernel[:-1] * dt, -np.ones((t.size, 1))], [-kernel[-1:] * dt, -np.eye(1)]])
    *phi, depth = np.linalg.solve(matrix, -np.asarray(curve.depth(np.append(t, a))))
    return float(depth), float(2.0 * dt @ phi)


@pytest.mark.parametrize("thickness", [0.07, 0.1, 0.2, 1.0])
@pytest.mark.parametrize(
    "layer", [PointLayer(1.0, 0.3), PointLayer(1.0, 0.5), PointLayer(1.0, 0.3, "sliding")], ids=str
)
def test_thin_or_thick_a_layer_under_a_rounded_punch_has_its_digits(layer: PointLayer, thickness: float) -> None:
    """From the first touch to the widest contact served: a layer over the flat end's radius as thin as that."""
    punch = BentCurve((1.0 / thickness,), (30.0,))
    curve = LayerCurve(punch, layer)
    for share in (1e-3, 0.1, 0.4, 1.0):
        a = punch.least_radius + share * (20.0 - punch.least_radius)
        here = curve.at(a)
        assert (here.depth, here.force) == pytest.approx(equilibrium(punch, layer, a), rel=curve.accuracy)


def test_under_a_contact_much_wider_than_its_bend_a_layer_has_its_digits() -> None:
    cone, layer = SphereCone(40.0, 1.0).load_curve, PointLayer(1.0, 0.3)
    curve = LayerCurve(cone, layer)
    for a in (3.0, 11.0, 20.0):
        here = curve.at(a)
        assert (here.depth, here.force) == pytest.approx(equilibrium(cone, layer, a), rel=curve.accuracy)


def test_a_cone_with_a_small_sphere_at_its_tip_is_a_cone_on_a_layer() -> None:
    """The tip that is missing counts to first order in its width, a hundredth of a panel's; deeper is as much force."""
    cone, depth = LayerCurve(ConeCurve(20.0), BONDED), 0.1 * THICKNESS
    radii = (2e-5, 1e-5)
    curves = [LayerCurve(SphereCone(radius, 20.0).load_curve, BONDED) for radius in radii]
    more = [float(curve.force(depth)) / float(cone.force(depth)) - 1.0 for curve in curves]
    assert more[0] / more[1] == pytest.approx(2.0, rel=3e-3)
    assert 0.0 < more[0] < 0.01


def test_what_is_refused_says_why(tmp_path: Path, impact: Callable[..., Scene]) -> None:
    for heights in ((0.0, 2e-5, 1e-5), (1e-6, 2e-5, 4e-5), (0.0, 3e-5, 4e-5), (0.0, 1e-5)):
        with pytest.raises(BadInput, match="accepted"):
            Profile((0.0, 1e-3, 2e-3), heights)
    with pytest.raises(BadInput, match="a corner at the radius"):
        Profile((0.0, 1e-3, 2e-3, 3e-3, 4e-3), (0.0, 1e-5, 2e-5, 1e-4, 1.8e-4))
    with pytest.raises(BadInput, match=r"its flat end is 0\.3 m wide; accepted below 0\.2 m"):
        replace(impact(1.0, shape=RoundedPunch(0.3, RADIUS)), target=Layer(0.01, "bonded"))
    with pytest.raises(BadInput, match="springs touch all at once"):
        laws.get("mdr").of(impact(1.0, shape=RoundedPunch(2e-3, RADIUS)))
    assert "ends at 0.004 m" in TABLE.check_contact(0.005)
    table = tmp_path / "tip.csv"
    table.write_text("r_m,height_m\n0,0\n0.001,0.00002\n0.002,0.0001\n")
    assert read(table) == Profile((0.0, 1e-3, 2e-3), (0.0, 2e-5, 1e-4))
    scene = {
        "striker": {"shape": "profile", "file": "tip.csv", "r": [0.0], "mass": 0.05, "velocity": 0.02},
        "target": {"shape": "half_space", "material": {"law": "elastic", "E": 1e6, "nu": 0.3}},
    }
    with pytest.raises(BadInput, match="accepted: file, or r and height"):
        Scene.from_dict(scene)
