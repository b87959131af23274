"""Impacts over an area that no depth changes: Lee and Radok's answer is exact, whatever is pressed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.sparse.linalg as linalg

import fe_contact
from fe_contact.budget.budget import CAUSES, shares_of
from fe_contact.budget.certify import certify
from fe_contact.budget.plan import plan
from fe_contact.errors import ContactLost
from fe_contact.march.impact import marched
from fe_contact.march.impacts import SurfaceBouncer, follow
from fe_contact.reference import solve
from fe_contact.schemes.base import SCHEMES
from fe_contact.settings import Numerics
from fe_contact.steppers.flat_end import FlatEnd, FlatStepper
from fe_contact.steppers.steps import State, Step, Strike, Work
from lumped import BadInput, Material, Model, NotReached, Relaxation, Result, Scene, laws, simulate
from lumped.result.result import meets
from lumped.scene.scene import Motion
from lumped.shapes.plate import Plate
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace
from lumped.targets.layer import Layer
from lumped.targets.plane import Plane
from lumped.targets.washer import Washer

Strikes, Settings = Callable[..., Strike], Callable[..., Numerics]

TOLERANCE, MASS, YOUNG = 1e-3, 0.02, 1e6
IMPACTS = 30


def material(rng: np.random.Generator, period: float) -> Material:
    """Elastic, Prony terms or a dashpot in parallel, relaxing within 0.01 to 10 periods."""
    kind = rng.integers(4)
    nu = float(rng.uniform(0.0, 0.49))
    if kind == 3:
        return Material(Relaxation(YOUNG, viscosity=YOUNG * period * float(rng.uniform(0.02, 0.2))), nu)
    times = tuple(float(t) for t in period * 10.0 ** rng.uniform(-2.0, 1.0, kind))
    return Material(Relaxation(YOUNG, tuple(float(m) for m in YOUNG * rng.uniform(0.1, 2.0, kind)), times), nu)


def random_scene(seed: int) -> Scene:
    """A punch on the half-space or a layer, a prism or a plate on the plane, in turn."""
    rng = np.random.default_rng([20261123, seed])
    radius, length = 10.0 ** rng.uniform(-3.0, -1.0), 10.0 ** rng.uniform(-3.0, -1.0)
    stiffness = YOUNG * radius * max(2.0, radius / length)
    soft = material(rng, math.sqrt(MASS / stiffness))
    shape, target = (
        (Punch(radius), HalfSpace()),
        (Punch(radius), Layer(max(length, 0.3 * radius), str(rng.choice(["bonded", "sliding"])))),
        (Prism(math.pi * radius**2, length), Plane()),
        (Plate(math.pi * radius**2, length), Plane()),
    )[seed % 4]
    return Scene(shape, MASS, float(10.0 ** rng.uniform(-3.0, -2.0)), soft, target=target)


def exact(scene: Scene) -> Result:
    return simulate(laws.correspondence.of(scene), scene, 1e-7)


def test_lee_and_radok_are_within_bar_and_tolerance(
    campaign_size: Callable[[int], int], agree: Callable[..., None]
) -> None:
    for seed in range(4 * campaign_size(IMPACTS) // 3):  # each of the four at least once
        scene = random_scene(seed)
        found = fe_contact.run(scene, TOLERANCE)
        agree(found, exact(scene))
        assert abs(found.energy["residual"] or 0.0) <= 1e-9 * (found.energy["in"] or 0.0)
        assert found.history.contact_radius == pytest.approx(scene.geometry.shape.fixed_radius), "from touch to the end"


def test_the_dashpot_is_felt_at_first_touch(agree: Callable[..., None]) -> None:
    """F(0+) = 2 a eta v/(1 - nu^2) stands in the first row, and is the peak where the dashpot is strong."""
    sticky = Material(Relaxation(YOUNG, viscosity=2e3), 0.3)
    scene = Scene(Punch(0.01), MASS, 0.01, sticky)
    found = fe_contact.run(scene, TOLERANCE)
    first = 2.0 * 0.01 * 2e3 * 0.01 / (1.0 - 0.3**2)
    assert found.history.force[0] == pytest.approx(first, rel=1e-3)
    agree(found, exact(scene))


def test_a_covered_washer_on_a_sliding_base_is_a_prism(agree: Callable[..., None]) -> None:
    soft = Material(Relaxation(YOUNG, (YOUNG,), (2e-3,)), 0.4)
    washer = Scene(Punch(0.02), MASS, 0.05, soft, target=Washer(0.005, 0.01, 0.004, "sliding"))
    block = Prism(math.pi * (0.01**2 - 0.005**2), 0.004)
    agree(fe_contact.run(washer, TOLERANCE), exact(replace(washer, shape=block, target=Plane())))


@pytest.mark.tenth
@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_the_bars_of_a_washer_cover_what_finer_settings_find(base: str, agree: Callable[..., None]) -> None:
    soft = Material(Relaxation(YOUNG, (0.5 * YOUNG,), (2e-3,)), 0.45)
    scene = Scene(Punch(0.0083), MASS, 0.05, soft, target=Washer(0.005, 0.01, 0.004, base))
    finer = {"elements_per_contact": 9.0, "penalty": 1e6, "steps": 160}
    agree(fe_contact.run(scene, TOLERANCE), fe_contact.run(scene, TOLERANCE, numerics=finer))


def test_a_punch_on_an_elastic_body_swings_for_half_a_period() -> None:
    """Its force is 2 E* a times the depth: v sqrt(k m) at the peak, pi sqrt(m/k) long."""
    scene = Scene.load("polymer-punch", {"target.material": {"law": "elastic", "E": 2e6, "nu": 0.45}})
    stiffness, result = 2.0 * scene.contact_modulus.relaxed * 3e-3, fe_contact.run(scene, 1e-2, "fe")
    period, found = math.sqrt(scene.mass / stiffness), result.quantities
    for name, value in (("peak_force", scene.velocity * stiffness * period), ("duration", math.pi * period)):
        assert abs(found[name].value - value) <= found[name].error
    peak = found["peak_force"]
    assert sum(result.error_budget.values()) == pytest.approx(peak.error / peak.value), "shares of the peak by cause"


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_the_first_settings_under_a_rim_meet_the_tolerance(tolerance: float) -> None:
    """The pressure is infinite there: a penalty as soft as under a round end would err by four times the least."""
    scene = Scene.load("polymer-punch")
    found = certify(Strike.of(scene), scene.geometry, plan(scene, {"tolerance": tolerance}).numerics)
    assert max(shares_of(found, cause).max() for cause in CAUSES) < 1.0
    assert all(meets(part, tolerance) for part in found.parts)


def test_three_marches_tell_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """Mesh, penalty and far field change one stiffness: each is one more press, and no march; counted from outside."""
    loads, factorise = list[list[int]](), linalg.splu

    def counted(*args: Any, **options: Any) -> Any:
        factors, solved = factorise(*args, **options), list[int]()
        loads.append(solved)
        return SimpleNamespace(solve=lambda load: solved.append(load.shape[1]) or factors.solve(load))

    monkeypatch.setattr(linalg, "splu", counted)
    work = solve(random_scene(4 * IMPACTS), {"tolerance": TOLERANCE}).certified.work
    assert (work.factorizations, work.solves) == (len(loads), sum(map(sum, loads)))
    assert work.factorizations == 3, "another penalty takes none"
    assert work.marches == 3
    assert work.contact_problems == work.iterations == work.steps


def test_a_block_is_pressed_as_a_whole() -> None:
    """One back-substitution a mesh, of which there are two: a block has no far field."""
    work = solve(Scene.load("polymer-prism"), {"tolerance": 0.1}).certified.work
    assert work.solves == work.factorizations == 2


def test_a_confined_plate_of_constant_bulk_modulus_relaxes_by_its_shear_alone(agree: Callable[..., None]) -> None:
    """M(t) = K + 4/3 G(t) by hand: as a prism of nu = 0 whose Young's modulus relaxes so."""
    rng = np.random.default_rng(11)
    nu, share = float(rng.uniform(0.1, 0.4)), float(rng.uniform(0.5, 2.0))
    soft = Material(Relaxation(YOUNG, (share * YOUNG,), (2e-3,)), nu, constant="bulk")
    third = 4.0 / 3.0 * YOUNG / (2.0 * (1.0 + nu))
    by_hand = Material(Relaxation(YOUNG / (3.0 * (1.0 - 2.0 * nu)) + third, (share * third,), (2e-3,)), 0.0)
    scene = Scene(Plate(4e-4, 0.004, "confined", "sliding"), MASS, 0.01, soft, target=Plane())
    twin = replace(scene, shape=Prism(4e-4, 0.004), material=by_hand)
    agree(fe_contact.run(scene, tolerance=TOLERANCE), simulate(laws.correspondence.of(twin), twin, 1e-8))


def test_a_weight_that_swings_back_to_its_touch_is_named_where_steps_disagree_on_when_it_parts() -> None:
    """A graze of 2e-5 of the swing: some steps see the first, some a later one, which are no two values of one end."""
    scene = Scene(Punch(5.82e-5), 0.79, 1.53e-5, Material(Relaxation(1.394e6), 0.0), target=Layer(6.7e-4, "bonded"))
    with pytest.raises(BadInput, match="below the layer's thickness"):
        fe_contact.run(replace(scene, model=Model(gravity=9.81)), TOLERANCE)


@pytest.mark.parametrize("eta", [200.0, 500.0, 1000.0])
def test_a_punch_that_sinks_faster_and_faster_presses_at_most_with_its_weight(eta: float) -> None:
    """A fluid so thin that force never exceeds it: no hill, and nothing fitted to one."""
    striker = {"shape": "punch", "radius": 0.003, "mass": 0.05, "velocity": 0.02}
    target = {"shape": "half_space", "material": {"law": "maxwell", "E": 1e6, "eta": eta, "nu": 0.4}}
    table = {"name": "sinking", "striker": striker, "target": target, "model": {"gravity": 9.81}}
    found = fe_contact.run(Scene.from_dict(table), 1e-3)
    peak = found.quantities["peak_force"]
    assert found.converged
    assert abs(peak.value - 0.05 * 9.81) <= peak.error <= 1e-3 * peak.value


@pytest.mark.parametrize("end_time", [0.17, 0.3, 0.4])
def test_the_last_row_of_what_does_not_part_is_at_the_end_time(end_time: float) -> None:
    striker = {"shape": "punch", "radius": 0.003, "mass": 0.05, "velocity": 0.02}
    target = {"shape": "half_space", "material": {"law": "maxwell", "E": 1e6, "eta": 3000.0, "nu": 0.4}}
    motion = {"end_time": end_time}
    table = {"name": "sinking", "striker": striker, "target": target, "model": {"gravity": 9.81}, "motion": motion}
    assert fe_contact.run(Scene.from_dict(table), 1e-3).history.time[-1] == pytest.approx(end_time, rel=1e-12)


@pytest.mark.parametrize("impacts", [1, 3])
def test_a_block_that_flows_is_as_deep_as_the_rounding_of_its_stiffness_lets_it_be_known(impacts: int) -> None:
    """Depth z of the spring and the integral of z/tau of the dashpot, z'' + z'/tau + w^2 z = g: the steps err by less
    than a solve rounds, however many contacts are asked for.
    """
    young, tau, area, height, mass, velocity, gravity, end = 1e6, 1.3e-3, 2e-4, 0.02, 0.5, 1e-3, 1e-3, 1.1
    material = {"law": "maxwell", "E": young, "eta": young * tau, "nu": -0.25}
    striker = {"shape": "prism", "area": area, "height": height, "mass": mass, "velocity": velocity}
    tables = {"model": {"gravity": gravity}, "motion": {"impacts": impacts, "end_time": end}}
    scene = Scene.from_dict({"striker": striker | {"material": material}, "target": {"shape": "plane"}} | tables)
    square = young * area / height / mass
    settled = gravity / square  # the spring, e^(-square tau end) from it
    assert math.exp(-square * tau * end) < 1e-12
    known = settled + (gravity * end + velocity - settled / tau) / (square * tau)
    depth = fe_contact.run(scene, 1e-4).quantities["peak_depth"]
    assert depth.value is not None
    assert abs(depth.value - known) <= (depth.error or 0.0) + 1e-13 * known


@pytest.mark.parametrize("periods", [0.5, 6.0])
def test_a_punch_whose_dashpot_answers_most_at_the_touch_settles_on_its_weight(periods: float) -> None:
    """Mass, spring and dashpot in closed form: damped beyond oscillation, the force falls from the touch on."""
    mass, velocity, gravity, damping, pace = 4e-4, 1e-4, 0.08, 1.2, 1.3e3
    radius, eta = 0.5 * mass * pace**2 / YOUNG, 2.0 * damping * YOUNG / pace
    scene = Scene(Punch(radius), mass, velocity, Material(Relaxation(YOUNG, viscosity=eta), 0.0), target=HalfSpace())
    end = periods * 2.0 * math.pi / pace
    found = fe_contact.run(replace(scene, model=Model(gravity=gravity), motion=Motion(end_time=end)), TOLERANCE)
    rates = -pace * (damping + np.array([-1.0, 1.0]) * math.sqrt(damping**2 - 1.0))
    rest = gravity / pace**2
    fading = np.linalg.solve([[1.0, 1.0], rates], [-rest, velocity]) * np.exp(rates * end)
    exact = {
        "peak_force": 2.0 * radius * eta * velocity,
        "peak_depth": rest + fading.sum(),
        "impulse": mass * (velocity + gravity * end - rates @ fading),
    }
    assert found.converged
    assert found.numerics["steps"] <= 160, "a force that falls from the touch on has no rise to resolve"
    for name, value in exact.items():
        assert abs(found.quantities[name].value - value) <= found.quantities[name].error


@pytest.mark.parametrize("viscosity", [0.0, 3.0])
def test_the_force_at_a_touch_is_that_of_a_first_step_without_length(
    viscosity: float, hertz_strike: Strikes, settings_of: Settings
) -> None:
    """On a body that nothing has touched, and on one still pressed in, where springs and branches press at once."""
    strike = hertz_strike(Relaxation(0.4, (1.5, 0.7), (0.3, 5.0), viscosity))
    numerics, stiffness = settings_of(strike), 2.5
    first = FlatStepper(strike, stiffness, 1.0, numerics)
    pressed = first.step(first.touch(), [], 0.5)
    again = replace(strike, depth=pressed.state.depth, velocity=0.3, memory=pressed.state.memory)
    for stepper in (first, FlatStepper(again, stiffness, 1.0, numerics)):
        assert stepper.step(stepper.touch(), [], 1e-9).force == pytest.approx(stepper.first_force, abs=1e-7)
    assert FlatStepper(again, stiffness, 1.0, numerics).first_force > 0.0


def test_a_flat_end_that_bounces_comes_back_as_fast_as_it_came(settings_of: Settings) -> None:
    """On an elastic body: the second touch is a contact and a flight of 2 v/g later, where the first one was."""
    strike = Strike(np.zeros_like, 1.0, 0.3, 0.05, Relaxation(1.0), 40.0)
    numerics = settings_of(strike, steps=80).varied(contact_time=math.pi / math.sqrt(2.5))
    bouncer = SurfaceBouncer(FlatEnd(2.5, 1.0, 1, np.inf), lambda number, strike: numerics)
    first, second = follow(bouncer, strike, 2).contacts
    assert second.strike.velocity == pytest.approx(strike.velocity, rel=1e-5)
    assert second.strike.touched_at == pytest.approx(first.march.time[-1] + 2.0 * 0.3 / 0.05, rel=1e-5)
    assert second.strike.depth == pytest.approx(0.0, abs=1e-6)
    assert second.march.time[-1] == pytest.approx(first.march.time[-1], rel=1e-5)


class Blind(FlatStepper):
    """Sees no contact in a first step shorter than ``seen``, s."""

    seen = 0.0

    def step(self, state: State, steps: Sequence[Step], length: float) -> Step:
        if not steps and length < self.seen:
            raise ContactLost(state.time)
        return super().step(state, steps, length)


@pytest.mark.parametrize("share", [0.0, 3e-3, 1.1e-2, 3e-2])
def test_a_first_step_that_sees_nothing_is_doubled_up_to_a_mean_step(share: float, settings_of: Settings) -> None:
    """Of 80 in half a period of mass and spring, whose motion the march follows all the same."""
    strike = Strike(np.zeros_like, 1.0, 0.3, 0.0, Relaxation(1.0), 40.0)
    period = math.pi / math.sqrt(2.5)
    stepper = Blind(strike, 2.5, 1.0, settings_of(strike, steps=80).varied(contact_time=period))
    stepper.seen = share * period
    if share > 2.0 / 80.0:
        with pytest.raises(ContactLost):
            marched(stepper)
        return
    found = marched(stepper)
    assert found.separated
    assert stepper.seen <= found.time[1] < max(2.0 * stepper.seen, period / 80.0)
    assert found.time[-1] == pytest.approx(period, rel=1e-3)
    assert found.impulse[-1] == pytest.approx(0.6, rel=1e-3)
    inside = found.time[:-1]
    assert found.depth[:-1] == pytest.approx(0.3 / math.sqrt(2.5) * np.sin(math.sqrt(2.5) * inside), abs=2e-4)
    assert found.work.steps == len(inside) - 1


def test_a_fluid_stops_a_striker_when_it_has_taken_all_but_a_faint_share_of_its_momentum(settings_of: Settings) -> None:
    """Damped beyond oscillation, E tau times the area: it sinks by m v/(E tau area), and stays to the end."""
    mass, stiffness, tau = 0.8, 2.5, 0.1
    strike = Strike(np.zeros_like, mass, 0.3, 0.0, Relaxation(0.0, (1.0,), (tau,)), 200.0)
    found = marched(FlatStepper(strike, stiffness, 1.0, settings_of(strike, steps=160).varied(contact_time=60.0)))
    assert not found.separated
    assert found.time[-1] == pytest.approx(200.0)
    assert found.impulse[-1] == pytest.approx(mass * 0.3, rel=2e-4)
    assert found.depth[-1] == pytest.approx(mass * 0.3 / (stiffness * tau), rel=1e-3)
    resting = found.work.steps
    assert np.all(found.depth[resting:] == found.depth[-1])
    assert found.time[resting] < 0.7 * 200.0, "before the end"


@pytest.mark.parametrize("restitution", [5e-3, 5e-4, 5e-5])
def test_a_punch_that_a_fluid_throws_back_leaves_with_all_that_is_not_rest(
    restitution: float, settings_of: Settings
) -> None:
    """An oscillator whose spring creeps: e = exp(-pi z/(1 - z^2)^(1/2)), z the damping; rest is below 1e-4."""
    decay = -math.log(restitution) / math.pi
    damping = decay / math.hypot(1.0, decay)
    half = math.pi / math.sqrt(1.0 - damping**2)
    fluid = Relaxation(0.0, (1.0,), (0.5 / damping,))
    strike = Strike(np.zeros_like, 1.0, 1.0, 0.0, fluid, 4.0 * half)
    numerics = settings_of(strike, steps=400, contact_time=half, peak_share=0.1)
    found = marched(FlatStepper(strike, 1.0, 1.0, numerics))
    assert found.separated == (restitution > 1e-4)
    assert found.impulse[-1] - 1.0 == pytest.approx(restitution, rel=0.05)


def test_the_share_of_the_penalty_is_safety_times_what_half_of_it_changes() -> None:
    """Of a stiffness k a force goes with its root: the share counts all of dk/k, twice dF/F."""
    scene = Scene.load("polymer-punch")
    given = {"tolerance": 1e-2, "penalty": 400.0, "enforcement": "penalty"}
    whole, half = (solve(scene, given | {"penalty": penalty}).certified for penalty in (400.0, 200.0))
    forces = [one.curve.quantities["peak_force"] or 0.0 for one in (whole, half)]
    assert whole.error("peak_force", "penalty") == pytest.approx(2.5 * (forces[0] - forces[1]), rel=0.1)


def test_a_punch_that_a_dashpot_stops_within_few_steps_ends_by_name() -> None:
    """Damped eighty-eight times: the first contact has two steps, fewer than tell where a curve is crowded."""
    radius, nu = 2e-3, 0.3
    period = math.sqrt(0.05 * (1.0 - nu**2) / (2.0 * radius * YOUNG))
    solid = Material(Relaxation(YOUNG, viscosity=87.7 * YOUNG * period), nu)
    scene = Scene(Punch(radius), 0.05, 0.05, solid, model=Model(gravity=1.9))
    with pytest.raises(NotReached, match="steps reached only"):
        fe_contact.run(scene, 1e-2, numerics={"steps": 40})


@pytest.mark.parametrize("scheme", SCHEMES.names)
def test_a_step_stands_where_its_scheme_reads_it(scheme: str, hertz_strike: Strikes, settings_of: Settings) -> None:
    strike = hertz_strike()
    stepper = FlatStepper(strike, 2.0, 1.0, settings_of(strike, scheme=scheme))
    first = stepper.step(stepper.touch(), (), 0.01)
    second = stepper.step(first.state, (first,), 0.03)
    assert first.radius_time == pytest.approx(0.01 * SCHEMES.get(scheme).sample)
    assert second.radius_time == pytest.approx(0.01 + 0.03 * SCHEMES.get(scheme).sample)
    assert first.work == second.work == Work(steps=1, contact_problems=1, iterations=1)
