"""A half-space that yields and has inertia: against each of these alone, and what its flow is by itself."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import scipy.sparse as sparse

from fe_contact.assembly.forms import Matrix
from fe_contact.cli import main
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.dynamics import flow
from fe_contact.dynamics.flow import Flowed, flow_of_step
from fe_contact.dynamics.march import Motion, march
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.dynamics.stepping import Enforced, ExplicitStepper
from fe_contact.errors import FlowNotSettled
from fe_contact.plastic.core import YieldingCore
from fe_contact.plastic.ground import GUARD, WIDEST
from fe_contact.plastic.path import PlasticZoneWide
from fe_contact.progress import silent
from fe_contact.reference import fe
from fe_contact.settings import WaveNumerics
from fe_contact.studies.larger_models import sufficient
from fe_contact.waves.impact import choices_of, left, left_behind
from fe_contact.waves.moving import Moving
from fe_contact.waves.targets import half_space
from fe_contact.waves.targets.half_space import yielding_core
from lumped import BadInput, Result, Scene
from lumped.materials.radiation import radiation_coefficient
from lumped.numbers import Array
from lumped.shapes import Sphere

COARSE = {"elements_per_contact": 4.0, "steps": 80, "penalty": 240.0, "tolerance": 0.1}
FINE = {"elements_per_contact": 8.0, "steps": 128, "penalty": 480.0, "tolerance": 0.1}
PLACES = 2001
WHOLE = 12  # impacts of the random campaign
FINER = 1.7  # times as many elements, and twice as many steps, in the runs that judge
STRESSES = ("stress_rr", "stress_zz", "stress_hoop", "stress_rz")


def scene(**keys: Any) -> Scene:
    """The packaged steel ball on what yields, with inertia."""
    return Scene.load("steel-ball-plastic", {"model.inertia": True, "target.material.density": 7850.0, **keys})


def marched(struck: Scene, **given: Any) -> tuple[Moving, Motion]:
    """A body and one march of it."""
    numerics = half_space.plan(struck, {**COARSE, **given}).numerics
    assert isinstance(numerics, WaveNumerics)
    moving = half_space.moving(struck, numerics)
    choices = choices_of(struck, numerics)
    return moving, march(moving.body, moving.velocity, choices, struck.end_time, moving.watch, left)


@pytest.fixture(scope="module")
def impact() -> Result:
    return fe(scene(), {"tolerance": 0.03})


@pytest.fixture(scope="module")
def fine() -> Result:
    return fe(scene(), FINE)


def test_what_never_yields_moves_as_without_yield() -> None:
    """To the last digit: nothing flows, nothing is added."""
    size = {"contact_radius": 1.5e-4, "contact_time": 1.2e-5, "peak_share": 0.5, "far_radius": 100.0, "finer": 2.0}
    moving, found = marched(scene(**{"target.material.yield_strength": 1e12}), **size)
    _, alone = marched(scene(**{"model.plasticity": False}), **size)
    np.testing.assert_array_equal(found.force, alone.force)
    assert found.samples[-1].energies.plastic == 0.0
    assert all(sample.problems == 1 for sample in found.samples)
    assert found.final.flowed is not None
    assert left_behind(moving.body, found.final.flowed).energy == 0.0


@pytest.mark.tenth
def test_a_light_body_answers_as_one_without_inertia(uncovered: Callable[..., dict[str, float]]) -> None:
    """Two ways that share the material alone: one march in time on a mesh that stays, one by depths on one that grows.
    A thousandth of steel's density radiates a thousandth of what steel does at most.
    """
    light = fe(scene(**{"target.material.density": 7.85}), {"tolerance": 0.02})
    still = fe(Scene.load("steel-ball-plastic"), {"tolerance": 0.02})
    assert light.converged
    assert still.converged
    assert uncovered(light, still) == {}
    assert light.recovery is not None
    assert still.recovery is not None
    apart = abs(light.recovery.permanent - still.recovery.permanent)
    assert apart <= light.recovery.error[0] + still.recovery.error[0]
    assert apart < 0.01 * still.recovery.permanent


def test_an_impact_balances_its_energy_and_radiates_what_its_force_does(impact: Result) -> None:
    """What leaves is Lamb's integral of the force's rate, what the dent took a half; nothing is left over."""
    energy = impact.energy
    brought = 0.5 * impact.scene.mass * impact.scene.velocity**2
    assert impact.converged
    assert energy["in"] == pytest.approx(brought)
    assert abs(energy["residual"]) < 1e-5 * brought
    assert abs(energy["numerical"]) < 3e-3 * brought
    assert energy["out"] == pytest.approx((impact.quantities["restitution"].value or 0.0) ** 2 * brought, rel=1e-9)
    assert 0.5 * brought < energy["plastic"] < 0.65 * brought
    assert 0.0 < energy["stored"] < 0.12 * brought
    material = impact.scene.geometry.material
    density = material.density or 0.0
    speed = math.sqrt(material.shear.relaxed / density)
    time = np.linspace(0.0, impact.history.time[-1], PLACES)
    rate = np.gradient(np.interp(time, impact.history.time, impact.history.force), time)
    radiated = radiation_coefficient(material.nu) / (density * speed**3) * np.trapezoid(rate**2, time)
    assert energy["radiated"] == pytest.approx(radiated, rel=0.1)


def test_work_counts_every_solution_of_a_step(impact: Result) -> None:
    assert impact.work["contact_problems"] == impact.work["solves"]
    assert 3 * impact.work["steps"] < impact.work["contact_problems"] < 30 * impact.work["steps"]


def test_what_a_step_leaves_out_of_balance_moves_forces_by_less_and_no_more_is_left_in_the_end(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(flow, "FIRST", 200)  # a softer step leaves another share of the penalty's bias
    _, usual = marched(scene())
    allowed = flow.SETTLED
    monkeypatch.setattr(flow, "SETTLED", 1e-8)
    _, exact = marched(scene())
    assert usual.force.size == exact.force.size
    assert np.abs(usual.force - exact.force).max() < 0.5 * allowed * exact.force.max()
    speeds = [float(one.samples[-1].velocity[0]) for one in (usual, exact)]
    assert speeds[0] == pytest.approx(speeds[1], rel=0.01 * allowed)


@pytest.mark.parametrize("spread", [0.5, 0.99, 0.9999])
def test_flow_that_closes_in_slowly_is_found_in_as_many_guesses_as_it_has_directions(spread: float) -> None:
    """A linear answer, six directions of which keep up to so much of what a guess misses."""
    random = np.random.default_rng(3)
    turned = np.linalg.qr(random.normal(size=(40, 40)))[0]
    kept = np.zeros(40)
    kept[:6] = spread * np.linspace(0.5, 1.0, 6)
    answer, pull = turned * kept @ turned.T, random.normal(size=40)
    exact = np.linalg.solve(np.eye(40) - answer, pull)
    body = Answering(lambda held: answer @ held + pull)
    found, change = flow_of_step(lambda softening: lambda held: held, np.zeros(40), body, body.at_rest, 1.0)
    np.testing.assert_array_equal(found.forces, body.holds(change))
    assert np.linalg.norm(found.forces - exact) < 1e-3 * np.linalg.norm(exact)
    assert body.asked <= 10


def test_flow_that_no_guess_finds_has_a_name() -> None:
    random = np.random.default_rng(5)
    body = Answering(lambda held: random.normal(size=40))
    with pytest.raises(FlowNotSettled, match=r"plastic flow not found at t = 2 s; cure: raise numerics\.steps"):
        flow_of_step(lambda softening: lambda held: held, np.zeros(40), body, body.at_rest, 2.0)


class Answering:
    """A body that holds what it is told to by a guess."""

    def __init__(self, holds: Callable[[Array], Array]) -> None:
        self.holds, self.asked = holds, 0
        none = np.zeros(40)
        self.at_rest = Flowed(np.zeros((4, 1, 1)), np.zeros((1, 1)), forces=none, grew=none, stores=0.0, worked=0.0)

    def flowed(self, displacement: Array, before: Flowed) -> Flowed:
        self.asked += 1
        return before._replace(forces=self.holds(displacement))

    def softening(self, displacement: Array, before: Flowed) -> Matrix:
        return sparse.csc_matrix((40, 40))

    def check(self, flowed: Flowed, time: float) -> None:
        """Any flow is accepted."""


def core_of(struck: Scene) -> tuple[YieldingCore, WaveNumerics]:
    numerics = half_space.plan(struck, COARSE).numerics
    assert isinstance(numerics, WaveNumerics)
    return yielding_core(struck, numerics), numerics


def test_what_plastic_strain_holds_does_the_work_of_its_stress() -> None:
    """Of any displacement u, and any plastic strain: u . h is the integral of 2G e_p : e(u), and the energy that both
    store is that of the elastic strain alone.
    """
    core, _ = core_of(scene())
    random, rest = np.random.default_rng(11), core.at_rest
    size = core.bulk.size - 1
    pushed = core.flowed(1e-6 * random.normal(size=size), rest)
    assert np.any(pushed.amount > 0.0)
    u = 1e-6 * random.normal(size=size)
    gradient = core.bulk.gradient(np.append(u, 0.0))
    strain = np.stack([gradient[0], 0.5 * (gradient[1] + gradient[2]), gradient[3], gradient[4]])
    often, twice = np.array([1.0, 2.0, 1.0, 1.0]), 2.0 * core.yielding.shear
    work = np.einsum("c,ep,cep,cep->", often, core.bulk.weight, twice * pushed.strain, strain)
    assert u @ pushed.forces == pytest.approx(work, rel=1e-10)
    whole = np.vdot(core.bulk.weight, core.yielding.stored(gradient, pushed.strain))
    elastic = np.vdot(core.bulk.weight, core.yielding.stored(gradient, np.zeros_like(pushed.strain)))
    assert elastic + pushed.elastic(u) == pytest.approx(whole, rel=1e-10)


def test_softening_is_what_a_displacement_changes_of_the_forces_that_flow_holds() -> None:
    core, _ = core_of(scene())
    random = np.random.default_rng(13)
    size = core.bulk.size - 1
    before = core.flowed(1e-6 * random.normal(size=size), core.at_rest)
    u, change = 2e-6 * random.normal(size=size), 1e-12 * random.normal(size=size)
    later, earlier = (core.flowed(u + side * change, before).forces for side in (0.5, -0.5))
    told = core.softening(u, before) @ change
    assert np.linalg.norm(told) > 0.0
    assert np.linalg.norm(later - earlier - told) < 1e-4 * np.linalg.norm(told)


@pytest.mark.tenth
def test_a_body_that_flows_freely_in_long_steps_is_followed_too() -> None:
    """Under fifty times what it bears, a tenth of the depth a step: the account closes, and shorter steps agree."""
    soft = scene(**{"target.material.yield_strength": 4e7})
    coarse, fine = (marched(soft, elements_per_contact=6.0, steps=steps)[1] for steps in (36, 144))
    for one in (coarse, fine):
        last = one.samples[-1].energies
        assert abs(last.residual) < 1e-4 * last.work
        assert last.plastic > 0.9 * last.work
    assert max(sample.problems for sample in coarse.samples) > flow.FIRST
    assert coarse.force.max() == pytest.approx(fine.force.max(), rel=0.05)


def test_flow_at_the_end_of_what_may_yield_has_a_name() -> None:
    core, _ = core_of(scene())
    rest = core.at_rest
    middles = core.basis.mesh.p[:, core.basis.mesh.t].mean(axis=1)
    distance = np.hypot(*middles)[core.elements]
    near, far = (rest._replace(amount=1e-6 * chosen[:, None]) for chosen in (distance < 8.0, distance > GUARD * WIDEST))
    core.check(near, 1.0)
    with pytest.raises(PlasticZoneWide, match=r"at t = 1 s flow reaches 13 contact radii"):
        core.check(far, 1.0)


@pytest.mark.tenth
@pytest.mark.parametrize(
    ("cause", "setting", "value"),
    [("mesh", "elements_per_contact", 2.0), ("time_step", "steps", 32), ("penalty", "penalty", 120.0)],
)
def test_an_entry_grows_as_its_setting_is_four_times_as_coarse_and_the_bar_still_holds(
    cause: str, setting: str, value: float, fine: Result, uncovered: Callable[..., dict[str, float]]
) -> None:
    coarse = fe(scene(), {**FINE, setting: value})
    assert coarse.error_budget[cause] > 1.5 * fine.error_budget[cause]
    assert uncovered(coarse, fine) == {}


@pytest.mark.tenth
def test_bars_hold_against_finer_runs(
    uncovered: Callable[..., dict[str, float]], campaign_size: Callable[..., int]
) -> None:
    """Random bodies and strikers, to six times the pressure of first yield: all runs that are finer lie within the sum
    of both bars, and nineteen of twenty converge.
    """
    random, converged = np.random.default_rng(19), []
    for _ in range(campaign_size(WHOLE)):
        tolerance = float(random.choice([0.03, 0.02, 0.01]))
        one = drawn(random)
        found = fe(one, {"tolerance": tolerance})
        own = {key: FINER * found.numerics[key] for key in ("elements_per_contact", "penalty")}
        own |= {"steps": 2 * found.numerics["steps"], "far_radius": 1.3 * found.numerics["far_radius"]}
        assert uncovered(found, fe(one, {**own, "tolerance": 0.1})) == {}, (tolerance, one)
        converged.append(found.converged)
    assert np.mean(converged) >= 0.95


def drawn(random: np.random.Generator) -> Scene:
    """A sphere on a half-space that yields, hardening or not, up to a fiftieth of the speed of its waves."""
    young, nu, density, radius = 10 ** random.uniform(9, 11.3), random.uniform(0.1, 0.45), 3000.0, 0.01
    velocity = math.sqrt(young / (2 * (1 + nu) * density)) * 10 ** random.uniform(-4.5, -1.7)
    mass = 4 / 3 * np.pi * radius**3 * density * 10 ** random.uniform(-1, 1)
    modulus = young / (1 - nu**2)
    elastic = (15 * mass * velocity**2 * radius**2 / (16 * modulus)) ** 0.2  # Hertz' contact radius
    strength = 2 * modulus * elastic / (np.pi * radius) / 1.6 / 10 ** random.uniform(0.05, 0.8)
    material = {"law": "elastic", "E": young, "nu": nu, "density": density, "yield_strength": strength}
    material["hardening_modulus"] = float(random.choice([0.0, 0.05])) * young
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": velocity}
    target = {"shape": "half_space", "material": material}
    return Scene.from_dict({"striker": striker, "target": target, "model": {"plasticity": True, "inertia": True}})


@pytest.mark.tenth
def test_no_exact_law_enters_what_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Hertz' force chooses the mesh and the steps, and nothing more."""
    struck = scene()
    chosen = half_space.plan(struck, COARSE)
    way = half_space.MEMBER.way(struck, chosen, silent)
    honest = way.certified(chosen.numerics)
    monkeypatch.setattr(Sphere, "load_curve", property(lambda self: pytest.fail("an exact law was asked")))
    blind = half_space.MEMBER.way(struck, chosen, silent).certified(chosen.numerics)
    assert {name: (one.value, one.error) for name, one in blind.quantities.items()} == {
        name: (one.value, one.error) for name, one in honest.quantities.items()
    }


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"motion.impacts": 2}, "motion.impacts"),
        ({"target.material.density": None}, "target.material.density"),
        ({"striker.shape": "punch"}, "striker"),
        ({"target.shape": "layer", "target.thickness": 0.1, "target.base": "bonded"}, "target.shape"),
    ],
)
def test_what_does_not_yield_with_inertia_is_refused_with_its_key(changes: dict[str, Any], key: str) -> None:
    with pytest.raises(BadInput, match=key):
        fe(scene(**changes), {})


def test_an_explicit_scheme_is_refused_as_soon_as_it_is_planned() -> None:
    explicit = {"scheme": "central_difference", "mass": "lumped", "tolerance": 0.1}
    with pytest.raises(BadInput, match=r"numerics\.scheme.*accepted: an implicit one"):
        half_space.plan(scene(), explicit)
    elastic = scene(**{"model.plasticity": False})
    found = sufficient(elastic, {**explicit, "tolerance": 0.05})
    assert not found.scene.model.plasticity
    assert "cannot be taken in" in found.left["plasticity"]
    body = half_space.moving(scene(), core_of(scene())[1]).body
    scheme = WAVE_SCHEMES.get("central_difference").of(1.0)
    with pytest.raises(BadInput, match="nothing yields by it"):
        ExplicitStepper(body, scheme, Enforced(ENFORCEMENTS.get("penalty"), 1.0), 1.0)


@pytest.mark.tenth
def test_fields_show_where_it_flows_and_that_no_stress_is_beyond_yield(tmp_path: Path) -> None:
    numerics = {name: value for name, value in COARSE.items() if name != "tolerance"}
    told = [part for name, value in numerics.items() for part in ("--set", f"numerics.{name}={value}")]
    inertia = ["--set", "model.inertia=true", "--set", "target.material.density=7850", "--tolerance", "0.1"]
    words = ["run", "steel-ball-plastic", *inertia, *told, "--fields", "--plot", "--out", str(tmp_path), "--quiet"]
    assert main(words) == 0
    assert (tmp_path / "history.svg").is_file()
    mesh = meshio.read(tmp_path / "fields.vtu")
    r, z, _ = mesh.points.T
    amount, pressure = mesh.point_data["plastic_strain"], mesh.point_data["pressure"]
    radius = r[mesh.point_data["contact"] == 1].max()
    assert np.hypot(r, z)[amount > 1e-3 * amount.max()].max() < 3.0 * radius
    axis = np.flatnonzero(r == 0.0)
    assert 0.1 < -z[axis[amount[axis].argmax()]] / radius < 1.0
    rr, zz, hoop, rz = (mesh.point_data[name] for name in STRESSES)
    mises = np.sqrt(0.5 * ((rr - zz) ** 2 + (zz - hoop) ** 2 + (hoop - rr) ** 2) + 3.0 * rz**2)
    inside = -z > 0.2 * radius  # an edge is sharper than a mesh
    assert mises[inside].max() < 1.06 * 3e8
    assert mises[inside & (amount > 0.1 * amount.max())] == pytest.approx(3e8, rel=0.06)
    assert 2.0 * 3e8 < pressure.max() < 4.5 * 3e8
