"""Large strains of what relaxes: points against their ordinary differential equation, impacts against small strains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import beta

from fe_contact import reference, relaxing_impact, run
from fe_contact.assembly.forms import Array
from fe_contact.budget.curve import Curve, extrapolated
from fe_contact.budget.solved import ImpactModel
from fe_contact.errors import ContactLost
from fe_contact.large_strains import ELASTIC
from fe_contact.march.impact import step_length
from fe_contact.plastic.impact import YIELDING
from fe_contact.relaxing_impact import RELAXING, Instant, Marcher, plan
from fe_contact.settings import Numerics, WaveNumerics
from fe_contact.solids import relaxing
from fe_contact.solids.finite import Hyperelastic
from fe_contact.solids.relaxing import Fading, FadingLaw, Relaxing, doubled, green, second
from fe_contact.steppers.steps import Strike
from lumped import BadInput, Scene
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import ENERGIES, energy_of, strained
from lumped.scene.tables import Model, Motion
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.prism import Prism
from lumped.targets import HalfSpace

NETWORK = Relaxation(1.0, (0.7, 1.3), (0.2, 3.0))
YEOH = energy_of("yeoh")
SHEAR = np.array([0.0, 0.6, 0.0, 0.0, 0.0])
STRETCH = np.array([0.1, 0.0, 0.0, -0.3, 0.1])
SWELLING = np.array([0.2, 0.1, 0.0, 0.3, -0.1])


def answered(way: Array, steps: int) -> Array:
    """First Piola-Kirchhoff stress (5,) at time 1 of a gradient that grew as sin t, by so many steps."""
    material = Relaxing(Hyperelastic(YEOH, 1.0, 2.0), Fading.over(NETWORK, 1.0 / steps))
    state, found = material.fading.at_rest(4, 1), None
    for number in range(1, steps + 1):
        found = material.respond(way[:, None] * np.sin(number / steps), state)
        state = found.state
    assert found is not None
    return np.asarray(found.stress[:, 0])


def by_differential_equation(way: Array) -> Array:
    """The same of h' + h/tau = g S0'."""
    shares, rates = np.array(NETWORK.moduli) / NETWORK.glassy, 1.0 / np.array(NETWORK.times)

    def at_once(time: float) -> Array:
        gradient = way[:, None] * np.sin(time)
        return second(strained(YEOH, gradient, 1.0, 2.0).stress, gradient)[:, 0]

    def fades(time: float, dashpots: Array) -> Array:  # of g S0 - h, whose rate is h/tau
        flowed = dashpots.reshape(2, 4)
        return np.asarray((rates[:, None] * (shares[:, None] * at_once(time) - flowed)).ravel())

    flowed = solve_ivp(fades, (0.0, 1.0), np.zeros(8), rtol=1e-9, atol=1e-10).y[:, -1].reshape(2, 4)
    stress = at_once(1.0) - flowed.sum(axis=0)
    gradient = way * np.sin(1.0)
    motion = np.array([[1.0 + gradient[0], gradient[1]], [gradient[2], 1.0 + gradient[3]]])
    turned = motion @ np.array([[stress[0], stress[3]], [stress[3], stress[1]]])
    return np.array([*turned.ravel(), (1.0 + gradient[4]) * stress[2]])


@pytest.mark.family
@pytest.mark.parametrize("way", [SHEAR, STRETCH, SWELLING], ids=["shear", "stretch", "both"])
def test_a_point_follows_its_differential_equation(way: Array) -> None:
    """By 80 steps and their extrapolation, to 1e-6; the steps alone err by their square."""
    exact = by_differential_equation(way)
    coarse, fine = (answered(way, steps) for steps in (40, 80))
    scale = np.abs(exact).max()
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, abs=1e-6 * scale)
    assert np.abs(coarse - exact).max() > 3.0 * np.abs(fine - exact).max()


@pytest.mark.family
@pytest.mark.parametrize("steady", [True, False])
@pytest.mark.parametrize("name", ENERGIES.names)
def test_a_point_s_stress_and_tangent_are_slopes(name: str, steady: bool) -> None:
    """Of its energy in the step, after any history."""
    random, fading = np.random.default_rng(3), Fading.over(NETWORK, 0.3)
    material = FadingLaw(Hyperelastic(energy_of(name), 1.0, 2.0), NETWORK, steady).over(fading)
    start, way = (0.1 * random.normal(size=(5, 6)) for _ in range(2))
    state = material.respond(0.1 * random.normal(size=(5, 6)), fading.at_rest(4, 6)).state
    here, above, below = (material.respond(start + share * way, state) for share in (0.0, 1e-6, -1e-6))
    slope = np.sum(here.stress * way, axis=0)
    assert (above.energy - below.energy) / 2e-6 == pytest.approx(slope, abs=1e-7)
    bent = np.einsum("ij...,j...->i...", here.tangent, way)
    assert (above.stress - below.stress) / 2e-6 == pytest.approx(bent, abs=1e-6)


@pytest.mark.parametrize("name", [name for name in ENERGIES.names if energy_of(name).splits])
def test_a_volume_that_stands_apart_does_not_relax(name: str) -> None:
    """A cube that swells alike keeps its stress, and a stretch comes down to what lasts of the shape."""
    law = FadingLaw(Hyperelastic(energy_of(name), 1.0, 2.0), NETWORK, True)
    fading = Fading.over(NETWORK, 1e7)
    swelling, stretch = (np.array(way)[:, None] for way in ([0.1, 0.0, 0.0, 0.1, 0.1], [0.1, 0.05, 0.0, -0.2, 0.1]))
    held = law.over(fading).respond(swelling, fading.at_rest(4, 1))
    assert held.stress == pytest.approx(law.sudden.respond(swelling, ()).stress)
    left, lasting = law.over(fading).respond(stretch, fading.at_rest(4, 1)), law.lasting.respond(stretch, ())
    assert left.stress == pytest.approx(lasting.stress, rel=1e-5)
    assert abs(lasting.stress[3]) < 0.5 * abs(law.sudden.respond(stretch, ()).stress[3])


@pytest.mark.parametrize("name", [name for name in ENERGIES.names if energy_of(name).splits])
def test_a_sudden_strain_is_answered_by_shape_and_volume_as_by_both_in_one(name: str) -> None:
    """Nothing has relaxed yet: of stress, energy and tangent, and of what bends that and how it drifts."""
    law, fading = FadingLaw(Hyperelastic(energy_of(name), 1.0, 2.0), NETWORK, True), Fading.over(NETWORK, 1e-9)
    gradient = np.random.default_rng(4).uniform(-0.2, 0.2, (5, 6))
    apart, whole = law.over(fading).respond(gradient, fading.at_rest(4, 6)), law.sudden.respond(gradient, ())
    for part in ("stress", "energy", "tangent", "pulls", "drifts"):
        assert getattr(apart, part) == pytest.approx(getattr(whole, part), rel=1e-7, abs=1e-7), part


@pytest.mark.parametrize("lame", [0.5, 2.0, 40.0])
def test_where_all_relaxes_alike_what_lasts_is_a_share_of_all_and_what_fades_has_the_ratio_of_the_body(
    lame: float,
) -> None:
    """Poisson's ratio lame/(2 (lame + shear)); of what keeps its volume a half."""
    law = FadingLaw(Hyperelastic(YEOH, 1.0, lame), NETWORK, False)
    fading, share = Fading.over(NETWORK, 1e7), NETWORK.relaxed / NETWORK.glassy
    for way in (STRETCH, SHEAR, SWELLING):
        at_once, lasting = (one.respond(way[:, None], ()) for one in (law.sudden, law.lasting))
        assert lasting.stress == pytest.approx(share * at_once.stress, rel=1e-12)
        assert lasting.energy == pytest.approx(share * at_once.energy, rel=1e-12)
        long_after = law.over(fading).respond(way[:, None], fading.at_rest(4, 1))
        assert long_after.stress == pytest.approx(lasting.stress, rel=1e-5, abs=1e-6 * np.abs(lasting.stress).max())
    assert law.branches_nu == pytest.approx(lame / (2.0 * (lame + 1.0)))
    assert replace(law, steady=True).branches_nu == 0.5


def test_what_bends_the_tangent_of_a_body_that_relaxes_drifts_with_its_gradient_as_it_says() -> None:
    """By central differences; without that Newton's steps would foresee nothing, and be many."""
    material = Relaxing(Hyperelastic(YEOH, 1.0, 2.0), Fading.over(NETWORK, 0.3))
    state = material.respond(STRETCH[:, None], material.fading.at_rest(4, 1)).state
    place, small = (STRETCH + 0.1 * SHEAR)[:, None], 1e-5
    found = material.respond(place, state)
    assert found.pulls is not None
    assert found.drifts is not None
    for row, way in enumerate(np.eye(5)):
        above, below = (material.respond(place + sign * small * way[:, None], state).pulls for sign in (1.0, -1.0))
        assert found.drifts[:, row] == pytest.approx((above - below) / (2.0 * small), rel=1e-7, abs=1e-7)


def test_stresses_and_strains_are_those_of_the_motion_as_a_whole() -> None:
    """In three dimensions: P = F S and E = (F^T F - 1)/2, of the hoop too."""
    rng = np.random.default_rng(6)
    gradient, stress = rng.uniform(-0.3, 0.3, 5), rng.normal(size=4)
    motion, pressed = np.eye(3), np.zeros((3, 3))
    motion[:2, :2] += gradient[:4].reshape(2, 2)
    motion[2, 2] += gradient[4]
    rr, zz, tt, rz = stress
    pressed[:2, :2], pressed[2, 2] = [[rr, rz], [rz, zz]], tt
    first, strain = motion @ pressed, 0.5 * (motion.T @ motion - np.eye(3))
    asked = np.array([*first[:2, :2].ravel(), first[2, 2]])
    assert relaxing._first(stress, gradient) == pytest.approx(asked)
    assert second(asked, gradient) == pytest.approx(stress)
    assert green(gradient) == pytest.approx([strain[0, 0], strain[1, 1], strain[2, 2], strain[0, 1]])
    assert doubled(stress, green(gradient)) == pytest.approx(np.sum(pressed * strain))


def test_a_turn_does_not_relax() -> None:
    """S is that of the strain alone: a body that turns after it was strained bears F S, turned."""
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    motion = np.eye(2) + np.array([[0.1, 0.2], [0.0, -0.2]])
    turned = turn @ motion - np.eye(2)
    material = Relaxing(Hyperelastic(YEOH, 1.0, 2.0), Fading.over(NETWORK, 0.3))
    ends = [np.array([*block.ravel(), 0.1])[:, None] for block in (motion - np.eye(2), turned)]
    assert green(ends[0]) == pytest.approx(green(ends[1]))
    state = material.respond(ends[0], material.fading.at_rest(4, 1)).state
    still, moved = (material.respond(end, state) for end in ends)
    assert moved.stress[:4, 0].reshape(2, 2) == pytest.approx(turn @ still.stress[:4, 0].reshape(2, 2))
    assert doubled(moved.state[0], green(ends[1])) == pytest.approx(doubled(still.state[0], green(ends[0])))


def is_that_of_small_strains(scene: Scene, coarse: Numerics, tolerance: float, close: float, residual: float) -> None:
    """As a run to the tolerance, quantities as ``close`` and the energy balanced to a ``residual``, both relative."""
    few, many = (Marcher.of(scene, coarse.varied(steps=steps)).march() for steps in (12, 24))
    found = extrapolated(Curve.of(many, Strike.of(scene)), Curve.of(few, Strike.of(scene)), 2)
    small = run(scene, tolerance=tolerance)
    for name in ("restitution", "peak_depth", "peak_force", "duration"):
        assert found.quantities[name] == pytest.approx(small.quantities[name].value, rel=close)
    assert abs(found.energy["residual"]) < residual * found.energy["in"]
    assert found.energy["viscous"] == pytest.approx(small.energy["viscous"], rel=0.02)


@pytest.mark.tenth
def test_a_light_impact_is_that_of_small_strains() -> None:
    """At a thousandth of the speed, the material as much faster as the contact is shorter; the energy balances."""
    scene = Scene.load("polymer-sphere", {"striker.velocity": 2e-5, "target.material.C1": 7.2e4})
    coarse = plan(scene, {"elements_per_contact": 1.5, "order": 3, "penalty": 300.0, "far_radius": 10.0}).numerics
    is_that_of_small_strains(scene, coarse, tolerance=1e-3, close=4e-3, residual=1e-3)


@pytest.mark.tenth
def test_a_light_impact_below_a_datum_is_that_of_small_strains() -> None:
    """Along the depth: of what the body takes up and keeps, what moves the datum is none."""
    network = Relaxation(4e6, (6e6,), (2e-4,))
    scene = Scene(Cylinder(0.01, 1.0), 0.1, 0.01, Material(network, 0.45), target=HalfSpace(0.03))
    coarse = plan(scene, {"elements_per_contact": 2.0, "order": 3, "penalty": 300.0, "far_radius": 10.0}).numerics
    is_that_of_small_strains(
        replace(scene, model=Model(kinematics="finite")), coarse, tolerance=1e-3, close=4e-3, residual=1e-3
    )


def test_what_hardly_relaxes_loses_nothing_below_a_near_datum_either() -> None:
    """Amid contact, whose half-width is half of the datum's depth."""
    material, motion = Material(Relaxation(1e7, (10.0,), (1.0,)), 0.4), Motion(end_time=4.7e-4)
    model = Model(kinematics="finite")
    scene = Scene(Cylinder(0.01, 1.0), 1.0, 1.0, material, target=HalfSpace(0.004), model=model, motion=motion)
    coarse = {"elements_per_contact": 2.0, "order": 3, "penalty": 300.0, "steps": 24}
    energy = Marcher.of(scene, plan(scene, coarse).numerics).march().energy
    assert energy["stored"] > 0.3 * energy["in"]
    assert energy["viscous"] == pytest.approx(0.0, abs=0.01 * energy["in"])


def block_impact(scene: Scene) -> tuple[float, float]:
    """Peak force, N, and restitution of neo-Hooke's block, its sides free, by its ordinary differential equation."""
    material, block = scene.geometry.material, scene.geometry.shape
    assert isinstance(block, Prism)
    shear = material.shear.glassy
    lame = 2.0 * shear * material.nu / (1.0 - 2.0 * material.nu)
    shares, rates = np.array(material.young.moduli) / material.young.glassy, 1.0 / np.array(material.young.times)

    def at_once(along: float) -> float:
        """Second Piola-Kirchhoff stress, Pa, where nothing pushes sideways."""
        across = brentq(lambda t: shear * (t**2 - 1.0) + lame * np.log(along * t**2), 0.5, 2.0, xtol=1e-14)
        return float((shear * (along**2 - 1.0) + lame * np.log(along * across**2)) / along**2)

    def force(state: Array) -> float:
        along = 1.0 - state[0] / block.thickness
        return float(-block.area * along * (at_once(along) - state[2:].sum()))

    def moves(time: float, state: Array) -> Array:
        dashpots = rates * (shares * at_once(1.0 - state[0] / block.thickness) - state[2:])
        return np.array([state[1], -force(state) / scene.mass, *dashpots])

    def parted(time: float, state: Array) -> float:
        return force(state) if time > 0.0 else 1.0

    parted.terminal, parted.direction = True, -1.0  # type: ignore[attr-defined]
    start = [0.0, scene.velocity, *np.zeros(len(rates))]
    found = solve_ivp(moves, (0.0, 10.0), start, rtol=1e-9, atol=1e-11, events=parted, dense_output=True)
    rows = found.sol(np.linspace(0.0, found.t[-1], 2000)).T
    return max(force(row) for row in rows), float(-found.y[1, -1] / scene.velocity)


def test_a_block_that_relaxes_follows_its_differential_equation() -> None:
    """Pressed by a quarter of its height; strained alike, it needs no fine mesh."""
    scene = Scene.load("polymer-prism", {"model.kinematics": "finite", "striker.velocity": 3.0})
    coarse = plan(scene, {"elements_per_contact": 2.0, "order": 2}).numerics
    few, many = (Marcher.of(scene, coarse.varied(steps=steps)).march() for steps in (12, 24))
    found = extrapolated(Curve.of(many, Strike.of(scene)), Curve.of(few, Strike.of(scene)), 2)
    peak, restitution = block_impact(scene)
    assert found.quantities["peak_force"] == pytest.approx(peak, rel=2e-3)
    assert found.quantities["restitution"] == pytest.approx(restitution, abs=2e-3)
    assert found.quantities["peak_depth"] > 0.2 * 0.02
    assert abs(found.energy["residual"]) < 5e-3 * found.energy["in"]


def test_a_penalty_is_not_remembered() -> None:
    """By a block that relaxes: what it errs by falls as the penalty's square, so that half of it tells of no less.

    Stress that points remember of a body pressed softly is less than that under a rigid contact, at first order.
    """
    scene = Scene.load("polymer-prism", {"model.kinematics": "finite", "striker.velocity": 3.0})
    coarse = plan(scene, {"elements_per_contact": 2.0, "order": 2, "steps": 24}).numerics
    marches = [Marcher.of(scene, coarse.varied(penalty=stiffness)).march() for stiffness in (100.0, 200.0, 1e5)]
    soft, stiff, rigid = (Curve.of(march, Strike.of(scene)).quantities for march in marches)
    for name in ("peak_force", "peak_depth", "duration"):
        found, other, exact = stiff[name], soft[name], rigid[name]
        assert found is not None
        assert other is not None
        assert abs(found - exact) < 0.3 * abs(other - exact), name
    assert stiff["restitution"] == pytest.approx(rigid["restitution"], abs=1e-5)
    leftover = [march.energy["residual"] / march.energy["in"] for march in marches]
    assert leftover[0] == pytest.approx(leftover[2], abs=1e-5), "of steps alone"


def test_a_light_block_of_constant_bulk_modulus_is_that_of_small_strains() -> None:
    """Whose sides move the less the more it has relaxed; what it stores and loses too."""
    scene = Scene.load(
        "polymer-prism",
        {"striker.velocity": 1e-3, "striker.material.constant": "bulk", "striker.material.nu": 0.3,
         "striker.material.hyperelastic": "yeoh"},
    )  # fmt: skip
    coarse = plan(scene, {"elements_per_contact": 2.0, "order": 2}).numerics
    is_that_of_small_strains(scene, coarse, tolerance=1e-4, close=2e-3, residual=5e-3)


@dataclass(frozen=True, eq=False)
class OnSpring(Marcher):
    """The force (depth - late)^(3/2) in place of a body."""

    late: float = 0.0

    def _touch(self) -> Instant:
        none, still = Fading.over(self.law.network, 1.0), np.zeros(1)
        rest = none.at_rest(1)
        velocity = self.strike.velocity / self.solid.unit
        return Instant(0.0, 0.0, velocity, 0.0, 0.0, 0.0, None, still, still, rest, rest, none.at_rest())

    def _equilibrium(self, here: Instant, depth: float, fading: Fading) -> Any:
        rigid = np.zeros(1), SimpleNamespace(answer=SimpleNamespace(state=here.memory))
        encounter = SimpleNamespace(body=SimpleNamespace(forces=lambda loaded, displacement: displacement))
        balance = SimpleNamespace(encounter=encounter, touch=SimpleNamespace(energy=0.0))
        force = np.maximum(depth - self.late, 0.0) ** 1.5
        known = {"rigid_force": force, "stiffness": 1.5 * force ** (1.0 / 3.0)}
        return SimpleNamespace(**known, rigid=rigid, iterations=1, balance=balance)

    def _stored(self, last: Instant) -> float:
        return 0.0


def on_spring(strike: Strike, numerics: Numerics, unit: float, scale: float, late: float = 0.0) -> OnSpring:
    """A striker on k d^(3/2), of its units of length, m, and force, N, that begins ``late`` by a depth in them."""
    body = SimpleNamespace(rim=np.zeros(1, dtype=int), datum=np.zeros(1))
    encounter = SimpleNamespace(body=body, follows=False)
    solid: Any = SimpleNamespace(unit=unit, lead=1.0, encounter=encounter)
    law = FadingLaw(Hyperelastic(YEOH, 1.0, 2.0), strike.relaxation, False)
    return OnSpring(strike, solid, law, numerics, scale, 1.5, late)


@pytest.mark.parametrize("gravity", [0.5, 20.0])
def test_steps_on_a_spring_under_gravity_err_as_their_square(
    gravity: float, settings_of: Callable[..., Numerics], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Against m d'' = m g - k d^(3/2) by scipy's DOP853; a second march, cut off in contact, ends where it is told."""
    monkeypatch.setattr(relaxing_impact, "contact_radius", lambda balance: 1.0)
    unit, scale, mass, velocity = 0.02, 3.0, 0.4, 0.7
    k = scale / unit**1.5

    def moves(time: float, state: Array) -> list[float]:
        force = k * max(state[0], 0.0) ** 1.5
        return [state[1], gravity - force / mass, force]

    def parts(time: float, state: Array) -> float:
        return float(state[0]) if state[1] < 0.0 else 1.0

    parts.terminal = True  # type: ignore[attr-defined]
    exact = solve_ivp(moves, (0.0, 10.0), [0.0, velocity, 0.0], "DOP853", events=parts, rtol=1e-11, atol=1e-13)
    duration, (_, leaving, impulse) = exact.t[-1], exact.y[:, -1]
    errors = []
    for steps in (60, 120):
        strike = Strike(lambda r: r**2, mass, velocity, gravity, Relaxation(1.0), 10.0)
        numerics = settings_of(strike, steps=steps).varied(contact_time=duration, peak_share=0.5)
        march = on_spring(strike, numerics, unit, scale).march()
        found, given = Curve.of(march, strike).quantities, gravity * march.time[-1] - march.impulse[-1] / mass
        assert march.energy["out"] == pytest.approx(0.5 * mass * (velocity + given) ** 2, rel=1e-11), (
            "as the impulse leaves it"
        )
        cut = on_spring(replace(strike, end_time=0.6 * duration), numerics, unit, scale).march()
        depth, _, passed = solve_ivp(
            moves, (0.0, 0.6 * duration), [0.0, velocity, 0.0], "DOP853", rtol=1e-11, atol=1e-13
        ).y[:, -1]
        assert cut.time[-1] == pytest.approx(0.6 * duration, rel=1e-12)
        held = 0.4 * k * cut.depth[-1] ** 2.5  # which this spring does not tell
        assert cut.energy["residual"] == pytest.approx(held, abs=1e-3 * cut.energy["in"])
        told = {"duration": duration, "impulse": impulse, "restitution": -leaving / velocity}
        off = [found[name] / value - 1.0 for name, value in told.items()]
        errors.append([*off, cut.depth[-1] / depth - 1.0, cut.impulse[-1] / passed - 1.0])
    few, many = np.abs(errors)
    assert few.max() < 3e-3
    assert np.all(many < np.maximum(0.3 * few, 1e-6))


@pytest.mark.parametrize(("expected", "late"), [(0.7, 0.0), (1.0, 0.0), (1.4, 0.0), (1.0, 0.02)])
def test_steps_on_a_spring_err_as_their_square_whatever_time_was_expected(
    expected: float, late: float, settings_of: Callable[..., Numerics], monkeypatch: pytest.MonkeyPatch
) -> None:
    """k d^(3/2), lengths and forces in units of their own: the duration by the beta function, the rest by energy.

    A spring that begins ``late`` by a share of the depth, as one between a mesh's points does, is no separation.
    """
    monkeypatch.setattr(relaxing_impact, "contact_radius", lambda balance: 1.0)
    unit, scale, mass, velocity = 0.02, 3.0, 0.4, 0.7
    strike = Strike(lambda r: r**2, mass, velocity, 0.0, Relaxation(1.0), 10.0)
    k, energy = scale / unit**1.5, 0.5 * mass * velocity**2
    depth = (2.5 * energy / k) ** 0.4
    true = {
        "peak_depth": (1.0 + late) * depth,
        "peak_force": k * depth**1.5,
        "duration": 2.0 * depth / velocity * beta(0.4, 0.5) / 2.5 + late * depth / velocity,
        "impulse": 2.0 * mass * velocity,
    }
    errors, times = [], []
    for steps in (60, 120):
        numerics = settings_of(strike, steps=steps).varied(contact_time=expected * true["duration"], peak_share=0.5)
        march = on_spring(strike, numerics, unit, scale, late * depth / unit).march()
        found = Curve.of(march, strike).quantities
        assert march.radius == pytest.approx(np.where(march.depth[1:-1] > late * depth, unit, 0.0))
        assert march.work == (len(march.radius), len(march.radius), len(march.radius))
        times.append(march.time)
        errors.append([found[name] / value - 1.0 for name, value in true.items()])
        assert abs(march.energy["residual"]) < 1e-3 * energy
        slower, last = velocity - march.impulse[-2:] / mass, march.time[-1] - march.time[-2]
        assert slower[1] < (march.depth[-1] - march.depth[-2]) / last < slower[0], "what is left goes by its speeds"
    assert times[1][:60:2] == pytest.approx(times[0][:30], rel=1e-12), "extrapolation wants halves of the same steps"
    few, many = np.abs(errors)
    assert few.max() < 1e-3
    assert np.all(many < np.maximum(0.3 * few, 1e-7))


@pytest.mark.parametrize("gravity", [0.0, 3.0])
def test_a_striker_that_leaves_within_a_step_is_slowed_by_half_of_the_force_that_pressed_before(
    gravity: float, settings_of: Callable[..., Numerics]
) -> None:
    """Nothing presses at the step's end: the mean of both, in units of length and force of their own."""
    unit, scale, mass = 0.02, 3.0, 0.4
    strike = Strike(lambda r: r**2, mass, 0.7, gravity, Relaxation(1.0), 10.0)
    numerics = settings_of(strike, steps=60).varied(contact_time=0.1, peak_share=0.5)
    marcher = on_spring(strike, numerics, unit, scale)
    here = replace(marcher._touch(), time=0.09, depth=1e-4, velocity=-0.6 / unit, impulse=5.0, force=0.2)
    there = marcher._next([here] * 30, None)
    length = 0.1 * step_length(29, 60, 0.5)
    assert there.time == pytest.approx(0.09 + length)
    assert unit * there.depth == pytest.approx(
        unit * 1e-4 - 0.6 * length + 0.5 * length**2 * (gravity - scale * 0.2 / mass)
    )
    assert there.depth < 0.0
    assert unit * there.velocity == pytest.approx(-0.6 + length * (gravity - 0.5 * scale * 0.2 / mass))
    assert (there.force, there.impulse) == (0.0, 5.0)


def test_a_striker_that_its_weight_holds_down_swings_on_as_it_began(
    settings_of: Callable[..., Numerics], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Long after the contact time that was expected: steps of a contact that ends would have grown past its swing."""
    monkeypatch.setattr(relaxing_impact, "contact_radius", lambda balance: 1.0)
    unit, scale, mass = 0.02, 3.0, 0.4
    strike = Strike(lambda r: r**2, mass, 0.05, 9.81, Relaxation(1.0), 1e3)
    spring = on_spring(strike, settings_of(strike, steps=60).varied(contact_time=0.13, peak_share=0.5), unit, scale)
    rest = (mass * 9.81 / scale) ** (2.0 / 3.0)
    found = spring._equilibrium(spring._touch(), 0.9 * rest, Fading.over(spring.law.network, 1.0))
    here = replace(spring._touch(), depth=0.9 * rest, velocity=0.0, force=found.rigid_force, found=found)
    instants, depths = [here] * 300, list[float]()
    for _ in range(300):
        instants = [*instants, spring._next(instants, None)]
        depths.append(instants[-1].depth / rest)
    assert 1.09 < max(depths) < 1.11
    assert 0.89 < min(depths) < 0.91


@dataclass(frozen=True, eq=False)
class Trending(OnSpring):
    """Its contact ends as the trend says: after ``left``, s."""

    left: float = 0.0

    def _time_left(self, instants: list[Instant]) -> float | None:
        return self.left


@pytest.mark.parametrize("gravity", [0.0, 3.0])
def test_a_contact_ends_as_a_force_that_falls_by_the_power_of_its_curve_moves_the_striker(
    gravity: float, settings_of: Callable[..., Numerics]
) -> None:
    """F (1 - t/left)^(3/2) integrated twice by hand, in units of length and force of their own."""
    unit, scale, mass, left = 0.02, 3.0, 0.4, 0.05
    strike = Strike(lambda r: r**2, mass, 0.7, gravity, Relaxation(1.0), 10.0)
    spring = on_spring(strike, settings_of(strike, steps=60), unit, scale)
    found: Any = SimpleNamespace(balance=SimpleNamespace(displacement=np.zeros(1), touch=SimpleNamespace(energy=0.0)))
    last = replace(spring._touch(), time=0.3, depth=1.5, velocity=-30.0, impulse=0.16, force=0.2, found=found)
    march = Trending(**vars(spring), left=left)._record([spring._touch(), last], separated=True)
    given, speed, force = scale * 0.16, -30.0 * unit, scale * 0.2
    assert march.time == pytest.approx([0.0, 0.3, 0.35])
    assert march.impulse == pytest.approx([0.0, given, given + force * left / 2.5])
    end = 1.5 * unit + speed * left + 0.5 * gravity * left**2 - force / mass * left**2 / 3.5
    assert march.depth == pytest.approx([0.0, 1.5 * unit, end], rel=1e-12)
    out = 0.5 * mass * (speed + gravity * left - force / mass * left / 2.5) ** 2
    assert march.energy["out"] == pytest.approx(out, rel=1e-12)


@pytest.mark.parametrize("late", [0.06, 0.2])
def test_a_contact_whose_force_jitters_before_it_is_over_ends_by_the_trend_before(
    late: float, settings_of: Callable[..., Numerics]
) -> None:
    """Forces (1 - t)^(3/2), and a last one that is more than that before it: at 1 s, or there if that is later."""
    strike = Strike(lambda r: r**2, 0.4, 0.7, 0.0, Relaxation(1.0), 10.0)
    spring = on_spring(strike, settings_of(strike, steps=60), 0.02, 3.0)
    found: Any = SimpleNamespace(balance=SimpleNamespace(displacement=np.zeros(1), touch=SimpleNamespace(energy=0.0)))
    times = [0.0, 0.6, 0.7, 0.8, 0.9, 0.9 + late]
    forces = [0.0, *((1.0 - time) ** 1.5 for time in times[1:5]), 0.04]
    rest = replace(spring._touch(), depth=1.0, velocity=-30.0, found=found)
    instants = [replace(rest, time=time, force=force) for time, force in zip(times, forces, strict=True)]
    march = spring._record(instants, separated=True)
    assert march.time[-1] == pytest.approx(max(1.0, 0.9 + late))
    assert np.all(np.diff(march.time) > 0.0)


def test_an_end_is_told_from_the_fourth_step_on_while_the_striker_leaves(
    settings_of: Callable[..., Numerics],
) -> None:
    """By the power 3/2 of the time that is left; the fewest steps that a user may choose leave few to tell it."""
    strike = Strike(lambda r: r**2, 0.4, 0.7, 0.0, Relaxation(1.0), 10.0)
    spring = on_spring(strike, settings_of(strike, steps=8), 0.02, 3.0)
    touch, times = spring._touch(), (0.0, 0.03, 0.05, 0.06, 0.065)
    falling = [replace(touch, time=time, velocity=-1.0, force=(0.08 - time) ** 1.5) for time in times]
    assert spring._time_left(falling) == pytest.approx(0.015, rel=1e-9)
    assert spring._time_left(falling[:4]) is None
    assert spring._time_left([*falling[:4], replace(falling[4], velocity=0.1)]) is None


REFUSED = {
    "target.material.law": {"target.material": {"law": "kelvin_voigt", "E": 1e6, "eta": 1e3, "nu": 0.4}},
    "target.material.constant": {"target.material.constant": "bulk", "target.material.hyperelastic": "yeoh"},
    "target.material.hyperelastic": {"target.material.constant": "bulk"},
    "motion.impacts": {"motion.impacts": 2},
}


@pytest.mark.parametrize("key", REFUSED)
def test_what_does_not_relax_so_is_refused_by_its_key(key: str) -> None:
    scene = Scene.load("polymer-sphere", {**REFUSED[key], "model.kinematics": "finite"})
    with pytest.raises(BadInput, match=key):
        run(scene)


@pytest.mark.parametrize(
    ("name", "changes", "way"),
    [
        ("polymer-sphere", {}, reference.STATICS),
        ("polymer-sphere", {"model.kinematics": "finite"}, RELAXING),
        ("polymer-sphere-finite", {}, ELASTIC),
        ("steel-ball-plastic", {}, YIELDING),
    ],
)
def test_a_body_is_answered_as_its_model_and_material_ask(name: str, changes: dict[str, Any], way: ImpactModel) -> None:
    """What is elastic by its load curve, a fifth of the work of a march; waves by settings of their own."""
    assert reference.model_of(Scene.load(name, changes)) is way
    assert isinstance(reference.plan(Scene.load("rod"), {}).numerics, WaveNumerics)


def test_a_setting_of_waves_is_refused_by_its_key() -> None:
    scene = Scene.load("polymer-sphere", {"model.kinematics": "finite"})
    with pytest.raises(BadInput, match=r"numerics\.mass: no such setting"):
        reference.plan(scene, {"mass": "lumped"})


def test_a_body_is_meshed_by_the_contact_that_is_expected_of_any_size() -> None:
    """Under a sphere a thousand times as large as under a small one."""
    scenes = [Scene.load("polymer-sphere-finite", {"striker.radius": radius}) for radius in (0.01, 10.0)]
    wide, meshes = [], []
    for scene in scenes:
        numerics = plan(scene, {"elements_per_contact": 2.0, "order": 2}).numerics
        solid = Marcher.of(scene, numerics).solid
        wide.append(solid.unit / numerics.contact_radius)
        meshes.append(solid.encounter.body.core.dofs.shape)
    assert wide[0] == pytest.approx(wide[1])
    assert 1.0 < wide[0] < 2.0
    assert meshes[0] == meshes[1]


@pytest.mark.family
@pytest.mark.parametrize("steps", [8, 16])
def test_steps_too_long_for_the_rebound_are_named(steps: int) -> None:
    """A step that leads the striker farther back than the first touch, or from the turn to separation at once."""
    coarse = {"steps": steps, "elements_per_contact": 1.0}
    with pytest.raises(ContactLost, match=r"no contact after t = 0\.0\S* s; cure: raise numerics\.steps"):
        run("paper-ring-finite", tolerance=0.1, numerics=coarse)
