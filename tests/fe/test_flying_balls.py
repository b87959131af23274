"""Deformable balls with inertia: in free flight, on a rigid plane, on a half-space with waves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg
from scipy.linalg import block_diag

from fe_contact.assembly.forms import Array
from fe_contact.budget.curve import Curve
from fe_contact.cli import main
from fe_contact.dynamics.body import BodyState, Part, undeformed
from fe_contact.dynamics.march import Motion, march
from fe_contact.methods import simulate
from fe_contact.settings import RANGES, WaveNumerics
from fe_contact.steppers.steps import Strike
from fe_contact.waves.balls import Ball
from fe_contact.waves.impact import choices_of, energies, motion, record
from fe_contact.waves.moving import Flying, Moving, UnitBody, WaveSide, together
from fe_contact.waves.targets import half_space, plane, sphere
from fe_contact.waves.targets.base import too_fast
from lumped import BadInput, Result, Scene
from lumped.materials import Relaxation
from lumped.materials.radiation import radiation_coefficient

RADIUS, YOUNG, DENSITY = 2e-3, 2.06e11, 7850.0
MASS = DENSITY * 4.0 / 3.0 * math.pi * RADIUS**3
STEEL = {"law": "elastic", "E": YOUNG, "nu": 0.3, "density": DENSITY}
PLANE: dict[str, Any] = {"shape": "plane"}
HALF_SPACE: dict[str, Any] = {"shape": "half_space", "material": STEEL}
WHOLE = ("peak_force", "peak_depth", "duration", "impulse", "restitution")
MOVING: dict[str, tuple[ModuleType, Callable[..., Moving]]] = {
    "plane": (plane, plane.moving),
    "half_space": (half_space, half_space.under_ball),
    "sphere": (sphere, sphere.moving),
}
MODES = 40  # of the ball, from its lowest on


def ball(velocity: float, target: dict[str, Any] = PLANE, inertia: bool = True, **material: Any) -> Scene:
    striker = {"shape": "sphere", "radius": RADIUS, "velocity": velocity, "material": STEEL | material}
    mass = MASS * (STEEL | material)["density"] / DENSITY
    return Scene.from_dict({"striker": striker | {"mass": mass}, "target": target, "model": {"inertia": inertia}})


def pair(velocity: float, inertia: bool = True, **other: Any) -> Scene:
    """Two balls, of a relative velocity; of the struck one another radius and material."""
    struck = {"radius": RADIUS} | other
    material = STEEL | struck.pop("material", {})
    mass = material["density"] * 4.0 / 3.0 * math.pi * struck["radius"] ** 3
    target = {"shape": "sphere", "support": "free", "mass": mass, "material": material}
    return ball(velocity, target | struck, inertia)


def begun(scene: Scene, **given: Any) -> tuple[Moving, WaveNumerics]:
    """At first touch, by the settings of its plan."""
    target, moving = MOVING[scene.target.name]
    numerics = target.plan(scene, given).numerics
    assert isinstance(numerics, WaveNumerics)
    return moving(scene, numerics), numerics


def moved(scene: Scene, **given: Any) -> tuple[Moving, Motion]:
    """From first touch until some time after the contact."""
    moving, numerics = begun(scene, **given)
    until = 1.2 * numerics.contact_time
    return moving, march(moving.body, moving.velocity, choices_of(scene, numerics), until, moving.watch)


def curve_of(scene: Scene, **given: Any) -> Curve:
    moving, numerics = begun(scene, **given)
    return Curve.of(record(moving, motion(moving, scene, numerics), scene), Strike.of(scene))


def test_a_ball_that_touches_nothing_flies_without_strain() -> None:
    """Away from the plane, and pulled by gravity."""
    scene = Scene.from_dict(ball(1.0).to_dict() | {"model": {"inertia": True, "gravity": -9.81e4}})
    moving, numerics = begun(scene)
    time = numerics.contact_time
    found = march(moving.body, -moving.velocity, choices_of(scene, numerics), time, moving.watch)
    last = found.samples[-1]
    assert last.force == 0.0
    assert last.displacement[0] == pytest.approx(-last.time - 0.5 * 9.81e4 * last.time**2, rel=1e-9)
    assert last.energies.strain < 1e-10 * last.energies.work  # the rounding of every processor's sums: 1e-13 to 1e-12
    assert last.energies.deformable == pytest.approx(0.5 * MASS * (1.0 + 9.81e4 * last.time) ** 2, rel=1e-9)


@pytest.mark.parametrize(("elements", "finer"), [(8.0, 1.0), (8.0, 1.5), (16.0, 1.0)])
def test_a_ball_has_as_many_elements_along_its_contact_as_were_asked_for(elements: float, finer: float) -> None:
    """Times as much as its surface is finer than its bulk: the largest of them is no longer than that allows."""
    scene = ball(5.0)
    _, numerics = begun(scene, elements_per_contact=elements)
    end = math.asin(numerics.contact_radius / RADIUS)
    corners = Ball.striking(scene).unit(numerics.varied(finer=finer)).surface.corners(numerics.order, end)
    assert 0.75 < np.diff(corners[corners <= end]).max() / end * elements * finer <= 1.0


def test_at_touch_all_energy_is_the_strikers() -> None:
    """Of a ball on an endless body: what moves in that counts as radiated, what moves in the ball does not."""
    moving, _ = begun(ball(5.0, HALF_SPACE))
    swift, strained = moving.in_striker(undeformed(moving.body, moving.velocity))
    assert swift == pytest.approx(0.5 * MASS * 5.0**2, rel=1e-9)
    assert strained == 0.0


@pytest.mark.tenth
@pytest.mark.parametrize("target", [PLANE, HALF_SPACE])
def test_the_force_takes_the_momentum_and_no_energy_is_lost_sight_of(target: dict[str, Any]) -> None:
    scene = ball(5.0, target)
    moving, found = moved(scene)
    last = found.samples[-1]
    impulse = sum(sample.impulse for sample in found.samples)
    assert last.force == 0.0
    assert impulse == pytest.approx(MASS * (scene.velocity - last.velocity[0]), rel=1e-9)
    assert abs(last.energies.residual) < 1e-9 * last.energies.work
    assert abs(last.energies.numerical) < 1e-4 * last.energies.work
    terms = energies(moving, found, scene)
    assert 0.0 <= terms["stored"] < 0.01 * terms["in"], "the ball rings a little, and what flies is no strain"


@pytest.mark.tenth
def test_a_slow_ball_is_the_one_without_inertia(
    campaign_size: Callable[[int], int], uncovered: Callable[..., dict[str, float]]
) -> None:
    rng = np.random.default_rng(7)
    for _ in range(campaign_size(10)):
        nu, velocity = rng.uniform(-0.2, 0.48), 10 ** rng.uniform(-2.5, -1.0)
        still, waves = (simulate(ball(velocity, inertia=inertia, nu=nu), "fe", {}) for inertia in (False, True))
        assert waves.converged, waves.message
        assert not uncovered(still, waves), (nu, velocity)


def test_the_ledger_knows_how_much_a_ball_without_inertia_leaves_out() -> None:
    """In order of magnitude: where the vibrations stand when the force peaks, it does not know."""
    still, waves = simulate(ball(50.0, inertia=False), "fe", {}), curve_of(ball(50.0)).quantities["peak_force"]
    (entry,) = [entry for entry in still.model_ledger if entry.effect == "target inertia"]
    assert entry.estimate is not None
    assert waves is not None
    assert 0.3 < (1.0 - waves / (still.quantities["peak_force"].value or 0.0)) / entry.estimate < 3.0
    assert not still.model_sufficient


@pytest.mark.tenth
def test_two_slow_balls_are_those_without_inertia(uncovered: Callable[..., dict[str, float]]) -> None:
    """Unlike in size and material, either of them as the striker: action is reaction."""
    other = {"radius": 3.1e-3, "material": {"E": 7e10, "nu": 0.2, "density": 2500.0}}
    still, waves = (simulate(pair(0.02, inertia, **other), "fe", {}) for inertia in (False, True))
    table = waves.scene.to_dict()
    bodies = [{key: table[part][key] for key in ("radius", "mass", "material")} for part in ("target", "striker")]
    tables = {part: table[part] | body for part, body in zip(("striker", "target"), bodies, strict=True)}
    swapped = simulate(Scene.from_dict(table | tables), "fe", {})
    assert waves.converged, waves.message
    assert not uncovered(still, waves)
    assert not uncovered(swapped, waves)


@pytest.mark.tenth
def test_two_equal_balls_are_one_on_a_rigid_plane_with_half_the_approach() -> None:
    both, alone = curve_of(pair(10.0)), curve_of(ball(5.0))
    twice = {"peak_depth": 2.0, "peak_force": 1.0, "duration": 1.0, "impulse": 1.0, "restitution": 1.0}
    for name, factor in twice.items():
        known = alone.quantities[name]
        assert known is not None
        assert both.quantities[name] == pytest.approx(factor * known, rel=3e-4), name


@pytest.mark.tenth
def test_on_a_half_space_without_waves_two_compliances_add() -> None:
    """A finite ball is stiffer than Hertz's by a compliance that no contact changes: the same on either target.

    With depth = (F/k)^(2/3) - c F the peak force follows from the energy, 2/5 F (F/k)^(2/3) - c F^2/2.
    """
    still = simulate(ball(0.1, inertia=False), "fe", {"tolerance": 3e-4})
    force = still.quantities["peak_force"].value or 0.0
    energy, common = 0.5 * MASS * 0.1**2, 4.0 / 3.0 * math.sqrt(RADIUS)
    stiffness = common * still.scene.contact_modulus.relaxed
    stiffer = (0.4 * force * (force / stiffness) ** (2 / 3) - energy) / (0.5 * force**2)
    light = {"shape": "half_space", "material": STEEL | {"density": 1e-3}}
    scene = ball(0.1, light)
    softer = common * scene.contact_modulus.relaxed
    hertz = (energy / 0.4 * softer ** (2 / 3)) ** 0.6
    known = hertz
    for _ in range(20):
        known = ((energy + 0.5 * stiffer * known**2) / 0.4 * softer ** (2 / 3)) ** 0.6
    found = curve_of(scene, penalty=500.0, far_radius=50.0).quantities["peak_force"]
    assert known > 1.003 * hertz
    assert found == pytest.approx(known, rel=2e-4)


@pytest.mark.tenth
def test_what_is_left_in_the_ball_is_what_its_force_rings_in_its_modes() -> None:
    """Every mode for itself, by Duhamel's integral of the force at the pole: no march, no contact.

    Share of the energy about 2.5e-4 at 5 m/s.
    """
    scene = ball(5.0)
    moving, found = moved(scene, steps=960)
    body = moving.body
    stiffness = body.parts[0].relaxation.relaxed * body.parts[0].stiffness
    shift = (math.sqrt(YOUNG / DENSITY) / RADIUS) ** 2
    squares, shapes = linalg.eigsh(stiffness, MODES, body.mass, sigma=-0.1 * shift)
    pole = -np.asarray(body.pressing.push[:, [0]].todense()).ravel() @ shapes
    omega = np.sqrt(np.maximum(squares, 0.0))
    time, force = found.time, found.force
    spectrum = np.trapezoid(force * np.exp(1j * omega[:, None] * time), time, axis=1)
    rigid = omega < 1e-3 * omega.max()
    assert rigid.sum() == 1
    energies = 0.5 * (pole * np.abs(spectrum)) ** 2
    assert energies[rigid].sum() == pytest.approx(0.5 * MASS * (2.0 * 5.0) ** 2, rel=1e-3)
    rung = float(energies[~rigid].sum())
    last = found.samples[-1]
    held = last.energies.deformable + last.energies.strain - 0.5 * MASS * float(last.velocity[0]) ** 2
    assert held == pytest.approx(rung, rel=0.03)
    assert 1e-4 < held / last.energies.work < 5e-4


@pytest.fixture(scope="module")
def steel() -> Result:
    return simulate(Scene.load("steel-on-steel-waves"), "fe", {})


@pytest.mark.tenth
def test_steel_on_steel_loses_what_its_force_radiates(steel: Result) -> None:
    """Lamb's point force against momentum and mesh; the ball keeps next to nothing."""
    assert steel.converged, steel.message
    scene, history = steel.scene, steel.history
    material = scene.geometry.material
    speed = math.sqrt(material.shear.relaxed / DENSITY)
    time = np.linspace(0.0, history.time[-1], 201)
    rate = np.gradient(np.interp(time, history.time, history.force), time)
    radiated = radiation_coefficient(0.3) / (DENSITY * speed**3) * np.trapezoid(rate**2, time)
    share = radiated / (0.5 * scene.mass * scene.velocity**2)
    e = steel.quantities["restitution"].value or 0.0
    assert 1.0 - e**2 == pytest.approx(share, rel=0.03)
    assert steel.energy["radiated"] / steel.energy["in"] == pytest.approx(share, rel=0.03)
    assert 0.0 < steel.energy["stored"] < 0.01 * steel.energy["radiated"]
    (entry,) = [entry for entry in steel.model_ledger if entry.effect == "striker compliance"]
    assert entry.treated == "included"


@pytest.mark.tenth
def test_a_much_stiffer_ball_is_a_rigid_one() -> None:
    stiff = {"E": 1e4 * YOUNG, "density": DENSITY}
    soft = ball(1.0, HALF_SPACE, **stiff)
    rigid = replace(soft, striker_material=None)
    yielding = curve_of(soft)
    numerics = half_space.plan(rigid, {}).numerics
    moving = half_space.moving(rigid, numerics)
    known = Curve.of(record(moving, motion(moving, rigid, numerics), rigid), Strike.of(rigid))
    for name in WHOLE:
        assert yielding.quantities[name] == pytest.approx(known.quantities[name], rel=5e-4), name


def random_scene(rng: np.random.Generator, target: dict[str, Any]) -> Scene:
    """Steel to rubber, elastic or with memory, slow beside its waves."""
    young, nu, speed, density = 10 ** rng.uniform(6, 11), rng.uniform(0.0, 0.48), 10 ** rng.uniform(-2.5, -1.0), 2000.0
    velocity = speed * 0.06 * math.sqrt(young / density)
    memory = {"law": "prony", "E_inf": young, "E": [young * rng.uniform(0.1, 1.0)], "tau": [RADIUS / velocity]}
    law = ({"law": "elastic", "E": young}, memory)[rng.integers(2)] | {"nu": nu, "density": density}
    striker = {"shape": "sphere", "radius": RADIUS, "mass": MASS * density / DENSITY, "velocity": velocity}
    other = {"material": law | {"nu": rng.uniform(0.0, 0.48)}} if target is HALF_SPACE else {}
    tables = {"striker": striker | {"material": law}, "target": target | other, "model": {"inertia": True}}
    return Scene.from_dict(tables)


@pytest.mark.tenth
@pytest.mark.parametrize(("target", "many"), [(PLANE, 10), (HALF_SPACE, 10)])
def test_bars_hold_the_answer_of_settings_for_a_quarter_of_the_tolerance(
    target: dict[str, Any], many: int, campaign_size: Callable[[int], int]
) -> None:
    rng = np.random.default_rng(17)
    for number in range(campaign_size(many)):
        scene = random_scene(rng, target)
        result = simulate(scene, "fe", {"tolerance": (0.02, 0.003)[number % 2]})
        assert result.converged, result.message
        finer = curve_of(scene, tolerance=result.tolerance / 4).quantities
        for name in WHOLE:
            known = result.quantities[name]
            assert abs(known.value - finer[name]) <= known.error, (name, scene)


COARSE: list[dict[str, Any]] = [
    {"order": 1, "elements_per_contact": 4.0},
    {"order": 1, "elements_per_contact": 8.0, "penalty": 30.0},
    {"order": 2, "elements_per_contact": 1.0},
    {"order": 3, "elements_per_contact": 2.0},
    {"order": 2, "penalty": 1.0, "elements_per_contact": 4.0},
]
STEPS, FINER = 80, 4e-3


@pytest.mark.tenth
@pytest.mark.parametrize("target", [PLANE, HALF_SPACE])
def test_bars_hold_whatever_the_elements(target: dict[str, Any], campaign_size: Callable[[int], int]) -> None:
    """A ball in flight is stiff by its bulk too: against elements of the usual order, at a smaller tolerance."""
    rng = np.random.default_rng(23)
    for number in range(campaign_size(30)):
        scene, given = random_scene(rng, target), COARSE[number % len(COARSE)]
        found = simulate(scene, "fe", given | {"tolerance": 0.1, "steps": STEPS})
        finer = curve_of(scene, tolerance=FINER).quantities
        for name in WHOLE:
            known = found.quantities[name]
            assert abs(known.value - finer[name]) <= known.error, (name, scene, given)


@pytest.mark.parametrize("velocity", [1e-3, 1.0])
def test_the_far_end_of_a_ball_is_its_other_pole_and_of_two_that_of_the_larger(velocity: float) -> None:
    """The setting says how many contact radii away that is."""
    planned = {
        1.0: plane.plan(ball(velocity), {}).numerics,
        2.5: sphere.plan(pair(velocity, radius=2.5 * RADIUS), {}).numerics,
    }
    planned[1.0 + 1e-9] = sphere.plan(pair(velocity, radius=0.4 * RADIUS), {}).numerics
    for larger, numerics in planned.items():
        assert numerics.far_radius * numerics.contact_radius == pytest.approx(2.0 * larger * RADIUS)


@pytest.mark.tenth
@pytest.mark.parametrize("key", ["elements_per_contact", "penalty", "far_radius"])
def test_a_setting_at_the_end_of_its_range_is_varied_all_the_same(key: str) -> None:
    """A change from a setting to itself would be a bar of zero."""
    scene = ball(1.0, HALF_SPACE)
    cause = {"elements_per_contact": "mesh", "far_radius": "far_field"}.get(key, key)
    found = simulate(scene, "fe", {"steps": 40, "tolerance": 0.1, key: RANGES[key][0]})
    assert found.error_budget[cause] > 0.0


@pytest.mark.parametrize(
    ("name", "changes", "key"),
    [
        ("steel-ball-flight-waves", {"striker.mass": 2.7e-4}, r"striker\.mass.*0\.0002569"),
        ("steel-on-steel-waves", {"striker.mass": 2.4e-4}, r"striker\.mass"),
        ("steel-on-steel-waves", {"model.inertia": False}, r"striker\.material.*model\.inertia"),
        ("steel-on-steel-waves", {"striker.velocity": 1.2e3}, r"striker\.velocity"),
        ("steel-ball-flight-waves", {"motion.impacts": 2}, r"motion\.impacts"),
        ("steel-ball-flight-waves", {"striker.velocity": 1.2e3}, r"striker\.velocity.*shear waves"),
        ("steel-ball-flight-waves", {"target.material": STEEL}, r"target\.material"),
        ("two-finite-spheres-waves", {"target.mass": 4.0e-3}, r"target\.mass.*0\.00469"),
        ("two-finite-spheres-waves", {"target.support": "held"}, r"target\.support.*free"),
        ("two-finite-spheres", {"model.inertia": True}, r"target\.material\.density"),
    ],
)
def test_what_cannot_be_is_refused_with_its_key(name: str, changes: dict[str, Any], key: str) -> None:
    with pytest.raises(BadInput, match=key):
        simulate(Scene.load(name, changes), "fe", {})


def test_the_softer_of_two_balls_says_what_is_too_fast() -> None:
    """Its shear waves are the slower ones."""
    hard = {"striker.material.E": 1e10, "striker.velocity": 20.0}
    for changes in (hard, {"target.material.E": 1e10, "striker.velocity": 20.0}):
        assert too_fast(Scene.load("two-finite-spheres-waves", changes))
    both = hard | {"target.material.E": 1e10}
    assert not too_fast(Scene.load("two-finite-spheres-waves", both))


@pytest.mark.parametrize(("share", "fast"), [(0.1, False), (0.5, True)])
def test_what_strains_by_a_tenth_at_most_is_not_too_fast(share: float, fast: bool) -> None:
    """Velocity over that of shear waves: the strain behind a front."""
    speed = math.sqrt(STEEL["E"] / (2.0 * (1.0 + STEEL["nu"]) * STEEL["density"]))
    assert bool(too_fast(ball(share * speed))) is fast


@pytest.mark.parametrize("target", [PLANE, HALF_SPACE])
def test_a_ball_with_inertia_needs_its_density(target: dict[str, Any]) -> None:
    table = ball(1.0, target).to_dict()
    del table["striker"]["material"]["density"]
    with pytest.raises(BadInput, match=r"striker\.material\.density"):
        Scene.from_dict(table)


def test_a_cone_with_a_material_strikes_no_half_space() -> None:
    table = ball(1.0, HALF_SPACE).to_dict()
    cone = {"shape": "cone", "angle": 10.0, "mass": MASS, "velocity": 1.0, "material": STEEL}
    with pytest.raises(BadInput, match=r"striker\.material.*sphere"):
        Scene.from_dict(table | {"striker": cone})


def test_fields_of_two_bodies_are_refused_before_anything_is_computed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "steel-on-steel-waves", "--fields"]) == 2
    assert "rigid" in capsys.readouterr().err


@pytest.mark.tenth
def test_a_ball_that_rings_as_it_leaves_ends_its_contact_within_the_bar() -> None:
    """Its last forces fall faster than before, within the last step: steps of 1/64 and 1/32 err alike by chance."""
    material = {"law": "prony", "E_inf": 1.61e6, "E": [4.64e4], "tau": [4.53e-3], "nu": 0.447, "density": 368.7}
    striker = {"shape": "sphere", "radius": 0.02795, "mass": 0.03374, "velocity": 0.391, "material": material}
    scene = Scene.from_dict({"striker": striker, "target": PLANE, "model": {"inertia": True}})
    found = simulate(scene, "fe", {"tolerance": 0.1}).quantities["duration"]
    body, numerics = begun(scene, tolerance=0.1, steps=512, elements_per_contact=5.0)
    known = Curve.of(record(body, motion(body, scene, numerics), scene), Strike.of(scene)).duration
    assert found.value is not None
    assert found.error is not None
    assert 0.002 * known < abs(found.value - known) < found.error


def collision(masses: tuple[float, float], radius: float, velocity: float, material: dict[str, Any]) -> Scene:
    """A ball of 10 mm on another one of a radius, m, and the same material; masses in kg."""
    striker = {"shape": "sphere", "radius": 0.01, "mass": masses[0], "velocity": velocity, "material": material}
    target = {"shape": "sphere", "radius": radius, "support": "free", "mass": masses[1], "material": material}
    return Scene.from_dict({"striker": striker, "target": target, "model": {"inertia": True}})


@pytest.mark.tenth
def test_what_a_far_pole_sends_back_is_in_the_band_though_all_coarse_settings_miss_it() -> None:
    """A pulse at 0.72 of the contact, its force as spectral elements with explicit steps have it, on three meshes."""
    material = {"law": "sls", "E1": 380126.716, "E2": 283268.894, "C1": 2477.51608, "nu": 0.0, "density": 770.617267}
    scene = collision((3.22795407e-3, 2.61685776e-4), 4.32797015e-3, 0.632517358, material)
    history = simulate(scene, "fe", {"tolerance": 0.1}).history
    time, known = 2.138e-3, 0.11293
    missed = abs(float(np.interp(time, history.time, history.force)) - known)
    assert 0.01 * history.force.max() < missed < float(np.interp(time, history.time, history.force_error))


@pytest.mark.tenth
def test_steps_that_miss_the_same_share_of_the_last_one_do_not_agree_on_the_end_by_that() -> None:
    """Equal elastic balls part later than steps of 1/104 and 1/52 say, by spectral elements on three meshes."""
    material = {"law": "elastic", "E": 288595.117, "nu": 0.0, "density": 1465.906}
    scene = collision((6.14037271e-3, 6.14037271e-3), 0.01, 0.82464218, material)
    found = simulate(scene, "fe", {"tolerance": 0.01}).quantities["duration"]
    known, apart = 6.7407e-3, 0.0038e-3
    assert found.value is not None
    assert found.error is not None
    assert abs(found.value - known) + apart < found.error < 0.01 * known


def side(seed: int, size: int, damped: bool) -> WaveSide:
    """Any body of so many degrees of freedom, every other one along its axis; two surface nodes at three points."""
    rng = np.random.default_rng(seed)

    def matrix(rows: int, columns: int) -> sparse.csc_matrix:
        return sparse.csc_matrix(rng.uniform(1.0, 2.0, (rows, columns)))

    part = Part(matrix(size, size), Relaxation(float(seed)))
    dashpots = matrix(size, size) if damped else None
    trace = rng.uniform(0.0, 1.0, (3, 2))
    return WaveSide(matrix(size, size), (part,), dashpots, matrix(size, 2), trace, np.arange(size) % 2.0)


@pytest.mark.parametrize("damped", [(False, False, False), (False, True, False), (True, False, True)])
def test_bodies_together_are_each_as_alone_but_for_the_overlap_between_them(damped: tuple[bool, bool, bool]) -> None:
    """Which counts what the surface of each moves by; gravity pulls the first along its axis."""
    sides = [side(seed, size, one) for seed, size, one in zip((1, 2, 3), (4, 2, 3), damped, strict=True)]
    areas, clearance, carriers = np.array([1.0, 2.0, 3.0]), np.array([0.1, -0.2, 0.3]), np.ones((3, 1))
    body = together(sides, 9.81, areas, clearance, carriers)
    assert np.array_equal(body.mass.toarray(), block_diag(*(one.mass.toarray() for one in sides)))
    whole = [np.zeros((4, 4)), np.zeros((2, 2)), np.zeros((3, 3))]
    for place, (one, part) in enumerate(zip(sides, body.parts, strict=True)):
        alone = one.parts[0]
        blocks = [alone.stiffness.toarray() if k == place else none for k, none in enumerate(whole)]
        assert np.array_equal(part.stiffness.toarray(), block_diag(*blocks))
        assert part.relaxation is alone.relaxation
    dashpots = [
        none if one.dashpots is None else one.dashpots.toarray() for one, none in zip(sides, whole, strict=True)
    ]
    found = None if body.dashpots is None else body.dashpots.toarray()
    assert np.array_equal(found, block_diag(*dashpots)) if any(damped) else found is None
    assert body.gravity.tolist() == [0.0, 9.81, 0.0, 9.81, *np.zeros(5)]
    assert not body.rigid.any()
    displacement = np.random.default_rng(7).normal(size=9)
    moved = np.split(displacement, [4, 6])
    overlap = clearance - sum(one.trace @ (one.push.toarray().T @ of) for one, of in zip(sides, moved, strict=True))
    assert body.pressing.overlap(displacement) == pytest.approx(overlap)
    assert body.pressing.weights is areas
    assert body.pressing.carriers is carriers


def test_the_weights_of_a_centre_of_mass_are_shares_of_the_mass_that_moves_along_the_axis() -> None:
    """Of a lumped mass each its own; none of a body that does not fly."""
    lumped = replace(side(1, 4, False), mass=sparse.diags([1.0, 2.0, 3.0, 6.0]).tocsc())
    assert lumped.mean == pytest.approx([0.0, 0.25, 0.0, 0.75])
    assert not replace(lumped, axial=np.zeros(4)).mean.any()
    coupled = side(2, 4, False)
    carried = coupled.mass.toarray()[1::2, 1::2].sum(axis=1)
    assert coupled.mean[1::2] == pytest.approx(carried / carried.sum()), "what moves alike everywhere moves so"
    assert not coupled.mean[::2].any()


def moved_so(moving: Moving, displacement: Array, velocity: Array) -> BodyState:
    """Its state with elastic parts."""
    motions, parts = np.zeros((3, 3, displacement.size)), moving.body.parts
    motions[0, :2] = displacement, velocity
    pulls = tuple(np.array([part.stiffness @ displacement]) for part in parts)
    points = moving.body.pressing.weights.size
    return BodyState(0.0, motions, (np.zeros((0, displacement.size)),) * len(parts), pulls, -np.ones(points))


def test_a_rigid_striker_overlaps_by_its_depth_without_its_profile_and_what_the_body_gives_way() -> None:
    """Heights of a sphere, of which none counts as more than the highest; it alone has a velocity, and a weight."""
    scene = Scene.load("steel-ball-waves", {"model.gravity": 9.81})
    radius = scene.profile.tip_radius
    assert radius is not None
    below, places = side(1, 4, False), radius * np.array([0.0, 0.1, 0.3])
    heights = np.asarray(scene.profile.height(places))
    moving = Moving.under(scene, below, places, np.ones(3), highest=float(heights[1:].mean()))
    depth, into = 0.01, np.array([0.3, 0.1, -0.2, 0.4])
    overlap = depth - np.array([0.0, heights[1], heights[1:].mean()]) - below.trace @ (below.push.toarray().T @ into)
    assert moving.body.pressing.overlap(np.append(into, depth)) == pytest.approx(overlap)
    assert moving.velocity.tolist() == [0.0] * 4 + [scene.velocity]
    assert moving.body.gravity.tolist() == [0.0] * 4 + [9.81]
    assert moving.body.rigid.tolist() == [0.0] * 4 + [scene.reduced_mass]
    assert np.array_equal(moving.body.mass.toarray(), block_diag(below.mass.toarray(), [[0.0]]))
    assert (moving.watch @ np.append(into, depth)).tolist() == [depth]
    assert moving.in_striker(moved_so(moving, np.append(into, depth), np.append(into, 3.0))) == (
        pytest.approx(0.5 * scene.reduced_mass * 9.0),
        0.0,
    )


def test_a_flying_striker_has_the_motion_of_its_own_mass_and_its_own_springs() -> None:
    """Of all degrees of freedom the first ones, with what they have in common; the rest is the target's."""
    striker, struck = side(1, 4, False), side(2, 3, False)
    body = together([striker, struck], 0.0, np.ones(3), np.zeros(3), None)
    moving = Flying(body, 2.0, np.zeros(3), False, 4, np.arange(7.0), np.arange(7.0)[::-1])
    displacement, velocity = np.random.default_rng(3).normal(size=(2, 7))
    own = displacement[:4], velocity[:4]
    moves = 0.5 * own[1] @ (striker.mass @ own[1])
    stored = 0.5 * 1.0 * own[0] @ (striker.parts[0].stiffness @ own[0])
    found = moving.in_striker(moved_so(moving, displacement, velocity))
    assert found == (pytest.approx(moves), pytest.approx(stored))
    assert moving.velocity == pytest.approx(2.0 * np.arange(7.0))
    assert moving.watch @ displacement == pytest.approx([np.arange(7.0)[::-1] @ displacement])


def test_forces_into_a_body_are_put_on_its_surface_nodes_and_values_back_on_all_of_them() -> None:
    """Two degrees of freedom a node, along r and along the axis, of which some are held."""
    none: Any = None
    basis: Any = SimpleNamespace(N=5)
    surface: Any = SimpleNamespace(dofs=np.array([3, 1, 4]))
    unit = UnitBody(basis, surface, np.array([0, 2, 3]), "lumped", none, none)
    assert unit.free.tolist() == [1, 4, 5, 6, 7, 8, 9]
    assert unit.unknowns == 7
    assert unit.axial.tolist() == [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0]
    free: Array = np.zeros(10)
    free[[1, 4, 5, 6, 7, 8, 9]] = np.arange(1.0, 8.0)
    assert np.array_equal(unit.everywhere(np.arange(1.0, 9.0)), free), "what follows is another's"
    first = unit.everywhere(unit.pushed(1).toarray()[:, 0])
    assert first.tolist() == [0.0] * 7 + [-1.0, 0.0, 0.0]
