"""The layer under axisymmetric profiles: limits, published values, a second route, and the curve against itself."""

from __future__ import annotations

import math

import numpy as np
import pytest
from limits import compressible, incompressible
from scipy.special import ellipe, ellipk, j0, j1

from lumped.errors import BadInput, NotReached
from lumped.load_curves import (
    ConeCurve,
    FixedArea,
    HalfSpaceCurve,
    Hertz,
    LayerCurve,
    LayerPunch,
    PointLayer,
    Power,
    PunchCurve,
    SneddonSphere,
)
from lumped.load_curves.layer import DualEquation, deficit
from lumped.numbers import gauss

H = 0.002
LAYERS = [PointLayer(H, 0.3), PointLayer(H, 0.5), PointLayer(H, 0.3, "sliding")]
PROFILES = [
    Hertz(0.006),
    SneddonSphere(0.006),
    SneddonSphere(0.001),
    ConeCurve(20.0),
    Power(30.0, 1.6),
    Power(1e5, 3.5),
]
CURVES = [LayerCurve(profile, layer) for profile in PROFILES for layer in LAYERS]
DEPTHS = H * np.array([1e-9, 1e-4, 0.01, 0.09, 0.31])

# Hayes' kappa by a/h (rows) and nu (columns), facts on the literature, section 3.4.
NUS = (0.0, 0.3, 0.35, 0.4, 0.45, 0.5)
HAYES = {
    0.1: (1.0831, 1.0954, 1.1001, 1.1063, 1.1146, 1.1260),
    0.2: (1.1780, 1.2066, 1.2176, 1.2323, 1.2523, 1.2806),
    0.4: (1.4004, 1.4726, 1.5019, 1.5422, 1.5993, 1.6837),
    0.6: (1.6567, 1.7848, 1.8398, 1.9178, 2.0328, 2.2129),
    0.8: (1.9350, 2.1260, 2.2131, 2.3402, 2.5354, 2.8602),
    1.0: (2.2261, 2.4835, 2.6075, 2.7938, 3.0914, 3.6187),
    1.5: (2.9806, 3.4090, 3.6403, 4.0100, 4.6576, 6.0030),
    2.0: (3.7513, 4.3532, 4.7062, 5.2985, 6.4206, 9.1495),
    3.0: (5.3087, 6.2613, 6.8803, 7.9916, 10.3654, 18.1574),
}
# a/h: sqrt(R depth)/h and F/F_Hertz for nu = 0.5, the same for nu = 0.3; the same section.
SPHERE = {
    0.05: (0.0491, 1.0590, 0.0493, 1.0454),
    0.1: (0.0962, 1.1235, 0.0971, 1.0940),
    0.2: (0.1851, 1.2698, 0.1884, 1.2007),
    0.4: (0.3444, 1.6355, 0.3568, 1.4500),
    0.6: (0.4869, 2.1056, 0.5120, 1.7414),
    1.0: (0.7479, 3.3711, 0.8047, 2.4156),
    2.0: (1.3489, 8.4680, 1.5139, 4.3319),
}


def name(curve: object) -> str:
    return str(curve).replace("LayerCurve", "")


@pytest.mark.parametrize("profile", PROFILES, ids=name)
def test_deep_layer_is_the_half_space_and_approaches_it_at_first_order(profile: HalfSpaceCurve) -> None:
    depth = 1e-6
    own = float(profile.force(depth))
    excess = [float(LayerCurve(profile, PointLayer(h, 0.3)).force(depth)) / own - 1.0 for h in (1e6, 0.1, 1.0, 10.0)]
    assert abs(excess[0]) < 1e-8
    assert np.diff(np.log10(excess[1:])) == pytest.approx([-1.0, -1.0], abs=0.01)


def test_punch_on_a_deep_layer_is_boussinesqs() -> None:
    stiffness = [
        LayerPunch(1e-3, PointLayer(h, 0.3)).stiffness / PunchCurve(1e-3).stiffness - 1.0 for h in (1e7, 0.1, 1.0, 10.0)
    ]
    assert abs(stiffness[0]) < 1e-9
    assert np.diff(np.log10(stiffness[1:])) == pytest.approx([-1.0, -1.0], abs=0.01)


@pytest.mark.parametrize("ratio", HAYES)
def test_punch_has_hayes_kappa(ratio: float) -> None:
    kappas = [LayerPunch(ratio, PointLayer(1.0, nu)).stiffness / (2.0 * ratio) for nu in NUS]
    assert kappas == pytest.approx(HAYES[ratio], abs=0.6e-4)


@pytest.mark.parametrize("ratio", SPHERE)
def test_sphere_has_the_values_of_the_literature(ratio: float) -> None:
    hertz = Hertz(1e3)
    for nu, chi, excess in ((0.5, *SPHERE[ratio][:2]), (0.3, *SPHERE[ratio][2:])):
        here = LayerCurve(hertz, PointLayer(1.0, nu)).at(ratio)
        assert math.sqrt(1e3 * here.depth) == pytest.approx(chi, abs=0.6e-4)
        assert here.force / hertz.force(here.depth) == pytest.approx(excess, abs=0.6e-4)


def test_cone_has_the_values_of_the_literature() -> None:
    cone = ConeCurve(1e-3)
    curve = LayerCurve(cone, PointLayer(1.0, 0.5))
    for sharpness, excess in ((0.1483, 1.1223), (0.2803, 1.2643), (0.5059, 1.6113), (0.6996, 2.0508), (1.0478, 3.2389)):
        depth = sharpness * cone.steepness
        # the abscissa has four digits, and the slope over it is 3 at the last place
        assert curve.force(depth) / cone.force(depth) == pytest.approx(excess, abs=2.5e-4)


@pytest.mark.parametrize("layer", LAYERS, ids=name)
def test_first_order_in_the_thickness_is_one_constant_for_every_profile(layer: PointLayer) -> None:
    # phi = depth - g + k(0, 0) F/2 to first order: the half-space's curve, deeper by k(0, 0) F/(2 E*)
    nodes, weights = gauss(200)
    constant = 2.0 / np.pi * 25.0 * weights @ deficit(layer.nu, layer.base, 25.0 * nodes)
    for profile in PROFILES:
        a = 1e-5 * H
        depth = float(profile.depth(a))
        excess = float(LayerCurve(profile, layer).force(depth) / profile.force(depth)) - 1.0
        assert excess / 1e-5 == pytest.approx(constant, rel=1e-4)
    punch = LayerPunch(1e-5 * H, layer)
    assert (punch.stiffness / (2e-5 * H) - 1.0) / 1e-5 == pytest.approx(constant, rel=1e-4)
    if layer.nu == 0.5:
        # Garcia and Garcia 2018: 1.133 for the sphere, (2/pi) 1.133 = 0.721 for the cone, from a fit
        assert constant == pytest.approx(1.133, rel=6e-3)


@pytest.mark.parametrize("curve", CURVES, ids=name)
def test_contact_radius_and_depth_are_inverse(curve: LayerCurve) -> None:
    np.testing.assert_allclose(curve.depth(curve.contact_radius(DEPTHS)), DEPTHS, rtol=1e-12)
    assert float(curve.contact_radius(0.0)) == float(curve.force(-1.0)) == 0.0


@pytest.mark.parametrize("curve", CURVES, ids=name)
def test_stiffness_is_the_slope_of_the_force_and_that_of_a_punch(curve: LayerCurve) -> None:
    step = 1e-5 * DEPTHS
    slope = (curve.force(DEPTHS + step) - curve.force(DEPTHS - step)) / (2.0 * step)
    np.testing.assert_allclose(slope, curve.force_and_slope(DEPTHS)[1], rtol=1e-8)
    radius = float(curve.contact_radius(DEPTHS[-1]))
    assert curve.force_and_slope(DEPTHS[-1])[1] == pytest.approx(LayerPunch(radius, curve.layer).stiffness, rel=1e-10)
    a = curve.contact_radius(DEPTHS[1:])
    change = (curve.depth(a * (1 + 1e-5)) - curve.depth(a * (1 - 1e-5))) / (2e-5 * a)
    np.testing.assert_allclose(change, curve.depth_slope(a), rtol=1e-8)


@pytest.mark.parametrize("curve", CURVES, ids=name)
def test_force_is_the_slope_of_energy(curve: LayerCurve) -> None:
    step = 1e-4 * DEPTHS
    slope = (curve.energy(DEPTHS + step) - curve.energy(DEPTHS - step)) / (2.0 * step)
    np.testing.assert_allclose(slope, curve.force(DEPTHS), rtol=1e-7)


@pytest.mark.parametrize("curve", CURVES, ids=name)
def test_pressure_integrates_to_the_force(curve: LayerCurve) -> None:
    a = float(curve.contact_radius(0.31 * H))
    nodes, weights = gauss(300)
    angle = 0.5 * np.pi * nodes
    pressure = curve.pressure(a * np.cos(angle), a)
    force = np.pi**2 * a**2 * weights @ (pressure * np.sin(angle) * np.cos(angle))
    assert force == pytest.approx(float(curve.force(0.31 * H)), rel=1e-7)
    assert curve.pressure(np.array([a, 2.0 * a]), a) == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(
    "punch", [PunchCurve(1e-3), LayerPunch(1e-3, LAYERS[0]), LayerPunch(9e-3, LAYERS[1])], ids=name
)
def test_punch_is_linear_and_its_pressure_carries_the_force(punch: FixedArea) -> None:
    nodes, weights = gauss(300)
    angle = 0.5 * np.pi * nodes
    pressure = punch.pressure_at(punch.radius * np.sin(angle), 1e-5)
    force = np.pi**2 * punch.radius**2 * weights @ (pressure * np.sin(angle) * np.cos(angle))
    assert force == pytest.approx(float(punch.force(1e-5)), rel=1e-8)
    assert punch.energy(1e-5) == pytest.approx(0.5e-5 * float(punch.force(1e-5)), rel=1e-15)
    assert punch.force_and_slope(-1.0) == (0.0, 0.0)
    assert list(punch.depth([0.0, punch.radius, 1.0])) == [0.0, 0.0, np.inf]
    with pytest.raises(BadInput, match="pressure_at"):
        punch.pressure(0.0, punch.radius)


@pytest.mark.family
@pytest.mark.parametrize("profile", PROFILES, ids=name)
def test_bonded_layer_stiffens_with_nu_and_is_stiffer_than_a_sliding_one(profile: HalfSpaceCurve) -> None:
    bonded = [float(LayerCurve(profile, PointLayer(H, nu)).force(0.2 * H)) for nu in (0.0, 0.2, 0.4, 0.49, 0.4999, 0.5)]
    assert np.all(np.diff(bonded) > 0.0)
    sliding = [float(LayerCurve(profile, PointLayer(H, nu, "sliding")).force(0.2 * H)) for nu in (0.1, 0.5)]
    assert float(profile.force(0.2 * H)) < sliding[0] == sliding[1] < bonded[0]


def disc(r: np.ndarray, radius: float, layer: PointLayer) -> np.ndarray:
    """Surface displacement (E* = 1) at r under unit pressure on a disc: Love's on the half-space less the layer's."""
    inside, outside = np.minimum(r / radius, 1.0) ** 2, np.minimum(radius / r, 1.0) ** 2
    outer = r * (ellipe(outside) - (1.0 - outside) * ellipk(np.minimum(outside, 1.0 - 1e-15)))
    love = 4.0 / np.pi * np.where(r < radius, radius * ellipe(inside), outer)
    nodes, weights = gauss(160)
    u = 22.0 * nodes
    held = 22.0 * weights * deficit(layer.nu, layer.base, u) * radius * j1(u * radius / layer.thickness) / u
    return np.asarray(love - 2.0 * j0(np.outer(r, u) / layer.thickness) @ held)


@pytest.mark.parametrize(
    "layer", [PointLayer(1.0, 0.3), PointLayer(1.0, 0.5), PointLayer(1.0, 0.3, "sliding")], ids=name
)
def test_rings_of_pressure_in_equilibrium_with_the_profile_carry_the_same_force(layer: PointLayer) -> None:
    curve, a, errors = LayerCurve(Hertz(10.0), layer), 1.3, []
    for rings in (40, 80, 160):
        edges = a * np.arange(rings + 1) / rings
        middles = 0.5 * (edges[1:] + edges[:-1])
        discs = np.stack([np.zeros(rings), *(disc(middles, edge, layer) for edge in edges[1:])], axis=1)
        pressure = np.linalg.solve(np.diff(discs, axis=1), float(curve.depth(a)) - middles**2 / 20.0)
        errors.append(np.pi * pressure @ np.diff(edges**2) / float(curve.force_at(a)) - 1.0)
    errors = np.abs(errors)
    assert errors[-1] < 1e-3
    assert np.all(errors[:-1] / errors[1:] > 1.9)


@pytest.mark.parametrize("ratio", [0.5, 2.0, 8.0, 20.0])
def test_nystrom_converges_faster_than_any_power(ratio: float) -> None:
    def stiffness(refinement: float) -> float:
        equation = DualEquation(0.45, "bonded", ratio, refinement)
        return float(equation.weights @ equation.punch)

    exact = stiffness(2.0)
    errors = [abs(stiffness(refinement) / exact - 1.0) for refinement in (0.25, 0.5, 1.0)]
    assert errors[2] < 1e-11
    assert errors[1] < 1e-3 * errors[0] or errors[1] < 1e-11


def test_thin_compressible_layer_is_winklers() -> None:
    thin, curve = compressible(1e3, PointLayer(1.0, 0.3), plane=False), LayerCurve(Hertz(1e3), PointLayer(1.0, 0.3))
    gaps = [1.0 - float(curve.force_at(a) / thin.force(curve.depth(a))) for a in (5.0, 10.0, 20.0)]
    assert float(curve.force_at(8.0) / thin.force(curve.depth(8.0))) == pytest.approx(0.9969, abs=0.6e-4)
    assert np.all(np.array(gaps[:-1]) / gaps[1:] > 2.5)
    sliding = LayerCurve(Hertz(1e3), PointLayer(1.0, 0.3, "sliding"))
    winkler = compressible(1e3, PointLayer(1.0, 0.3, "sliding"), plane=False)
    excess = [float(sliding.force_at(a) / winkler.force(sliding.depth(a))) - 1.0 for a in (5.0, 10.0, 20.0)]
    assert np.log2(np.array(excess[:-1]) / excess[1:]) == pytest.approx([3.0, 3.0], abs=0.1)


def test_thin_incompressible_layer_is_squeezed_like_a_fluid() -> None:
    thin, curve = incompressible(1e3, PointLayer(1.0, 0.5), plane=False), LayerCurve(Hertz(1e3), PointLayer(1.0, 0.5))
    ratios = [float(curve.force_at(a) / thin.force(curve.depth(a))) for a in (2.0, 4.0, 8.0)]
    assert ratios == pytest.approx([2.93, 1.65, 1.21], abs=0.006)
    excess = [float(curve.force_at(a) / thin.force(curve.depth(a))) - 1.0 for a in (5.0, 10.0, 20.0)]
    assert np.all(np.log2(np.array(excess[:-1]) / excess[1:]) > 1.5)


@pytest.mark.parametrize("plane", [False, True], ids=["point", "line"])
def test_thin_limits_are_powers_whose_pressure_carries_the_force(plane: bool) -> None:
    thins = (
        compressible(0.01, PointLayer(1e-3, 0.3), plane=plane),
        incompressible(0.01, PointLayer(1e-3, 0.5), plane=plane),
    )
    assert [thin.exponent for thin in thins] == ([1.5, 2.5] if plane else [2.0, 3.0])
    nodes, weights = gauss(40)
    for thin in thins:
        depth = 2e-4
        a = float(thin.contact_radius(depth))
        measure = 2.0 * a * weights if plane else 2.0 * np.pi * a**2 * nodes * weights
        assert measure @ thin.pressure(a * nodes, a) == pytest.approx(float(thin.force(depth)), rel=1e-12)
        assert float(thin.energy(depth)) == pytest.approx(
            depth * float(thin.force(depth)) / (thin.exponent + 1.0), rel=1e-12
        )
        step = 1e-6 * depth
        slope = (thin.force(depth + step) - thin.force(depth - step)) / (2.0 * step)
        assert float(thin.force_and_slope(depth)[1]) == pytest.approx(float(slope), rel=1e-9)


def test_known_panels_are_not_solved_again(monkeypatch: pytest.MonkeyPatch) -> None:
    solved: list[float] = []
    answer = DualEquation.answer
    monkeypatch.setattr(DualEquation, "answer", lambda self, source: solved.append(self.ratio) or answer(self, source))
    layer = PointLayer(H, 0.2718)
    LayerCurve(Hertz(0.006), layer).force(1e-3 * H)
    first = len(solved)
    assert first <= 2 * 15
    LayerCurve(Hertz(0.006), layer).force(np.linspace(0.0, 1e-3 * H, 1000))
    LayerCurve(ConeCurve(30.0), layer).force(1e-3 * H)
    assert len(solved) == first


@pytest.mark.parametrize(
    ("thickness", "nu", "base", "key"),
    [
        (0.0, 0.3, "bonded", "thickness"),
        (1.0, 0.51, "bonded", "nu"),
        (1.0, -1.0, "bonded", "nu"),
        (1.0, 0.3, "slidng", "base"),
    ],
)
def test_impossible_layer_is_named(thickness: float, nu: float, base: str, key: str) -> None:
    with pytest.raises(BadInput) as caught:
        PointLayer(thickness, nu, base)
    assert [fault.key for fault in caught.value.faults] == [key]


def test_impossible_indenters_and_depths_are_named() -> None:
    for build in (lambda: ConeCurve(0.0), lambda: ConeCurve(90.0), lambda: Power(0.0, 2.0), lambda: Power(1.0, 0.9)):
        with pytest.raises(BadInput):
            build()
    with pytest.raises(BadInput, match="half_space"):
        LayerCurve(PunchCurve(0.001), LAYERS[0])
    with pytest.raises(BadInput, match="thickness"):
        LayerCurve(Hertz(0.006), LAYERS[0]).force(H)
    with pytest.raises(BadInput, match="radius"):
        LayerPunch(21.0 * H, LAYERS[0])
    with pytest.raises(NotReached, match="contact"):
        LayerCurve(Hertz(1e3), LAYERS[0]).force(0.9 * H)
    for layer in (PointLayer(H, 0.5), PointLayer(H, 0.3, "sliding")):
        with pytest.raises(BadInput) if layer.base == "bonded" else pytest.raises(BadInput, match="incompressible"):
            (compressible if layer.base == "bonded" else incompressible)(1.0, layer, plane=True)
