"""Every network is a Prony series; relaxation and creep are inverse; E*(s) is exact."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumped import BadInput, Material, Relaxation, Scene, laws, simulate
from lumped.materials.networks import kelvin_voigt, maxwell, operators, prony, sls

FREQUENCIES = np.logspace(-6, 6, 61)
terms = st.lists(st.tuples(st.floats(0.01, 10.0), st.floats(1e-4, 1e4)), min_size=1, max_size=6)


def relaxations(fluid: bool = False) -> st.SearchStrategy[Relaxation]:
    def build(found: list[tuple[float, float]], equilibrium: float, viscosity: float) -> Relaxation:
        moduli, times = zip(*found, strict=True)
        return Relaxation(equilibrium, moduli, times, viscosity)

    equilibrium = st.just(0.0) if fluid else st.floats(0.01, 10.0)
    return st.builds(build, terms, equilibrium, st.one_of(st.just(0.0), st.floats(0.01, 10.0)))


@given(st.one_of(relaxations(), relaxations(fluid=True)))
def test_creep_is_the_inverse_of_relaxation(relaxation: Relaxation) -> None:
    creep = relaxation.creep()
    np.testing.assert_allclose(relaxation.operational(FREQUENCIES) * creep.operational(FREQUENCIES), 1.0, rtol=1e-13)
    again = creep.relaxation()
    # two times that nearly coincide are two rows that nearly repeat: the way back loses their distance's digits
    apart = np.diff(np.log(np.sort(relaxation.times))) if len(relaxation.times) > 1 else np.ones(1)
    distinct = apart[apart > 0]
    loss = 1.0 / min(1.0, distinct.min(initial=1.0))
    assert_same = np.testing.assert_allclose
    assert_same(again.operational(FREQUENCIES), relaxation.operational(FREQUENCIES), rtol=1e-13 * loss)
    assert min(creep.compliances + creep.times, default=1.0) > 0.0


def test_creep_of_simple_networks_is_that_of_the_textbook() -> None:
    voigt = Relaxation(2.0, viscosity=3.0).creep()
    assert (voigt.instantaneous, voigt.fluidity) == (0.0, 0.0)
    assert voigt.compliances == pytest.approx((0.5,), rel=1e-15)
    assert voigt.times == pytest.approx((1.5,), rel=1e-15)
    fluid = Relaxation(0.0, (4.0,), (0.5,)).creep()
    assert (fluid.instantaneous, fluid.compliances, fluid.fluidity) == (0.25, (), 0.5)


def test_times_decades_apart_lose_no_digit() -> None:
    relaxation = Relaxation(1.0, (1.0, 1e-3, 5.0, 1e-6), (1e-9, 1e-3, 1e3, 1e9))
    s = np.logspace(-12, 12, 49)
    np.testing.assert_allclose(relaxation.operational(s) * relaxation.creep().operational(s), 1.0, rtol=1e-13)


@given(relaxations(), st.floats(-0.9, 0.4999))
def test_contact_modulus_of_constant_bulk_is_exact(young: Relaxation, nu: float) -> None:
    material = Material(young, nu, constant="bulk")
    shear = material.shear.operational(FREQUENCIES)
    bulk = young.relaxed / (3.0 * (1.0 - 2.0 * nu))
    exact = 4.0 * shear * (3.0 * bulk + shear) / (3.0 * bulk + 4.0 * shear)
    np.testing.assert_allclose(material.contact_modulus().operational(FREQUENCIES), exact, rtol=1e-12)


def test_contact_modulus_of_constant_bulk_keeps_the_published_ratios() -> None:
    # audit of the paper, section 4c: relaxed nu, r = G_i/G_inf -> E*_i/E*_inf
    for nu, ratio, published in [(0.2, 1.5, 1.320), (0.3, 6.0, 3.443), (0.45, 2.0, 1.843), (0.499, 1.5, 1.4985)]:
        modulus = Material(Relaxation(1.0, (ratio - 1.0,), (1.0,)), nu, constant="bulk").contact_modulus()
        assert modulus.glassy / modulus.relaxed == pytest.approx(published, abs=6e-4)


def test_elastic_contact_modulus_does_not_know_what_is_constant() -> None:
    for nu in (-0.9, 0.0, 0.3, 0.4999):
        bulk = Material(Relaxation(2e6), nu, constant="bulk").contact_modulus()
        assert bulk.relaxed == pytest.approx(2e6 / (1.0 - nu**2), rel=1e-12)


def test_both_parameterisations_of_the_three_parameter_solid_agree() -> None:
    springs = sls.of_springs(E1=1.8e6, E2=0.9e6, C1=1.8e4)
    ratios = sls.of_ratios(E0=0.6e6, R1=0.5, R2=0.01)
    assert springs.relaxed == pytest.approx(ratios.relaxed, rel=1e-15)
    assert springs.moduli == pytest.approx(ratios.moduli, rel=1e-15)
    assert springs.times == pytest.approx(ratios.times, rel=1e-15)
    assert ratios.instantaneous == pytest.approx(0.9e6, rel=1e-15)


def test_operators_of_the_three_parameter_solid_are_the_solid() -> None:
    # "(12)" corrected: C1 dsigma + (E1+E2) sigma = E2 (E1 epsilon + C1 depsilon)
    first, second, dashpot = 1.8e6, 0.9e6, 1.8e4
    found = operators.of((first + second, dashpot), (first * second, second * dashpot))
    expected = sls.of_springs(E1=first, E2=second, C1=dashpot)
    np.testing.assert_allclose(found.operational(FREQUENCIES), expected.operational(FREQUENCIES), rtol=1e-13)


def test_operators_know_the_other_networks() -> None:
    assert operators.of((1.0,), (5.0, 2.0)) == kelvin_voigt.of(5.0, 2.0)
    fluid = operators.of((1.0, 0.5), (0.0, 2.0))
    assert fluid.relaxed == 0.0
    assert fluid.moduli + fluid.times == pytest.approx((*maxwell.of(4.0, 2.0).moduli, 0.5), rel=1e-14)
    assert operators.of((0.0, 1.0), (0.0, 3.0)) == Relaxation(3.0)


@pytest.mark.parametrize(
    ("p", "q"),
    [
        ((1.0,), (1.0, 1.0, 1.0)),  # deg q > deg p + 1
        ((1.0, 0.2, 1.0), (1.0, 1.0, 2.0)),  # complex roots
        ((1.0, 2.0, 1.0), (1.0, 1.0, 2.0)),  # a double root
        ((1.0, 1.0), (2.0, 1.0)),  # grows stiffer with time
        ((0.0, 1.0), (1.0, 1.0)),  # infinite at rest
        ((1.0, -1.0), (1.0, 1.0)),  # unstable
        ((0.0,), (1.0,)),
    ],
)
def test_operators_of_no_network_are_refused(p: tuple[float, ...], q: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match=r"."):
        operators.of(p, q)


def test_impossible_materials_are_refused() -> None:
    for arguments in [(-1.0,), (0.0,), (1.0, (1.0,), ()), (1.0, (1.0,), (0.0,)), (float("nan"),)]:
        with pytest.raises(BadInput):
            Relaxation(*arguments)
    with pytest.raises(ValueError, match="as many"):
        prony.of(1.0, (1.0, 2.0), (1.0,))
    fluid = Relaxation(0.0, (1.0,), (1.0,))
    with pytest.raises(BadInput, match="bulk_modulus"):
        Material(fluid, 0.3, constant="bulk")
    with pytest.raises(BadInput, match="bulk_modulus"):
        Material(Relaxation(1.0), 0.3, constant="bulk", bulk_modulus=2.0)
    assert Material(fluid, 0.3, constant="bulk", bulk_modulus=2.0).contact_modulus().relaxed == 0.0


SHIFTS: list[dict[str, Any]] = [{"wlf": [17.44, 51.6]}, {"activation_energy": 9e4}]


def warmed(temperature: float, shift: dict[str, Any], **others: float) -> Scene:
    own = {"temperature": temperature, "reference_temperature": 293.15, **shift}
    keys = {f"target.material.{key}": value for key, value in own.items()}
    return Scene.load("polymer-sphere", keys | {f"striker.{key}": value for key, value in others.items()})


@pytest.mark.parametrize("shift", SHIFTS)
@pytest.mark.parametrize("law", ["ting", "correspondence"])
def test_a_shift_in_temperature_is_a_change_of_the_clock(law: str, shift: dict[str, Any]) -> None:
    """All times a_T as long: at the reference the impact of the mass over a_T squared, a_T as fast, on its clock."""
    for temperature in (291.0, 296.0):
        scene = warmed(temperature, shift)
        if "wlf" in shift:
            factor = 10.0 ** (-17.44 * (temperature - 293.15) / (51.6 + temperature - 293.15))
        else:
            factor = np.exp(9e4 / 8.314462618 * (1.0 / temperature - 1.0 / 293.15))
        other = Scene.load(
            "polymer-sphere", {"striker.mass": scene.mass / factor**2, "striker.velocity": scene.velocity * factor}
        )
        ours, theirs = (simulate(laws.get(law).of(one), one, 1e-7).quantities for one in (scene, other))
        for name in ("peak_force", "peak_depth", "restitution"):
            assert ours[name].value == pytest.approx(theirs[name].value, rel=1e-9)
        assert ours["duration"].value == pytest.approx(factor * (theirs["duration"].value or 0.0), rel=1e-9)


def test_a_temperature_is_written_with_the_network_at_its_reference() -> None:
    scene = warmed(299.0, SHIFTS[0])
    table = scene.to_dict()
    plain = Scene.load("polymer-sphere").to_dict()["target"]["material"]
    assert table["target"]["material"]["tau"] == pytest.approx(plain["tau"], rel=1e-15)
    assert Scene.from_dict(table).geometry.material.young.times == pytest.approx(
        scene.geometry.material.young.times, rel=1e-15
    )
    assert warmed(293.15, SHIFTS[1]).geometry.material.young == Scene.load("polymer-sphere").geometry.material.young


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"temperature": 300.0}, "temperature given; accepted: temperature and reference_temperature with one of wlf"),
        ({"temperature": 300.0, "reference_temperature": 293.0, "wlf": [17.0]}, "wlf: 1 values; accepted: 2"),
        ({"temperature": 230.0, "reference_temperature": 293.0, "wlf": [17.0, 51.6]}, "230 K: shifts all times"),
        (
            {"temperature": 300.0, "reference_temperature": 293.0, "wlf": [17.0, 51.6], "activation_energy": 1e5},
            "accepted: temperature and",
        ),
    ],
)
def test_half_a_shift_is_refused(keys: dict[str, Any], message: str) -> None:
    with pytest.raises(BadInput, match=message):
        Scene.load("polymer-sphere", {f"target.material.{key}": value for key, value in keys.items()})


@pytest.mark.parametrize("power", [1.0, 1.5, 2.0, 2.2])
def test_the_modulus_that_a_growing_load_feels_is_its_convolution(power: float) -> None:
    """int E(t-s) d(s^p) / t^p by Gauss's rule over v = (s/t)^p; at last a branch is a dashpot, p E tau/t."""
    relaxation, times = Relaxation(1.0, (5.0, 2.0), (0.3, 40.0), 0.7), np.array([1e-3, 0.1, 1.0, 7.0])
    nodes, weights = np.polynomial.legendre.leggauss(400)
    shares = (0.5 * (nodes + 1.0)) ** 4  # crowded at touch, where s is a root of v
    rule = 0.5 * weights * 4.0 * (0.5 * (nodes + 1.0)) ** 3
    for found, p in zip(relaxation.felt(times, power), (power, power + 1.0), strict=True):
        expected = relaxation(times[:, None] * (1.0 - shares ** (1.0 / p))) @ rule + 0.7 * p / times
        np.testing.assert_allclose(found, expected, rtol=1e-9)
        late = Relaxation(0.0, (5.0,), (0.3,)).felt(1e5, p)
        assert float(late[0]) == pytest.approx(p * 5.0 * 0.3 / 1e5, rel=1e-5)


def test_a_spring_that_rounding_does_not_tell_from_none_is_none() -> None:
    """As a mutilated file may have it: its compliance would be no number."""
    assert prony.of(5e-324, (1e6, 1e-310), (0.1, 2.0)) == prony.of(0.0, (1e6, 0.0), (0.1, 2.0))
    with pytest.raises(ValueError, match="at least one above zero"):
        prony.of(5e-324, (1e-310,), (0.1,))
