"""A ball on a half-space with waves: what it loses is what is radiated, and without density nothing is."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from skfem import Basis, ElementTriP2

import meshes
from fe_contact.assembly import forms
from fe_contact.assembly.far_field import wave_speeds
from fe_contact.budget.curve import Curve
from fe_contact.cli import main
from fe_contact.methods import simulate
from fe_contact.steppers.steps import March, Strike
from fe_contact.waves.impact import motion, parting, record
from fe_contact.waves.targets import half_space
from fe_contact.waves.targets.half_space import moving
from lumped import BadInput, Result, Scene, laws
from lumped.materials.radiation import radiation_coefficient

PLACES = 2001
QUICK = {"elements_per_contact": 6.0, "steps": 200, "penalty": 60.0}  # errs by 3e-4 in what is radiated


def marched(scene: Scene, **given: Any) -> tuple[March, Curve]:
    numerics = half_space.plan(scene, given).numerics
    body = moving(scene, numerics)
    found = record(body, motion(body, scene, numerics), scene)
    return found, Curve.of(found, Strike.of(scene))


def predicted(scene: Scene, curve: Curve) -> float:
    """W = A(nu)/(density c_s^3) int (dF/dt)^2 dt over the energy of the ball."""
    material = scene.geometry.material
    speed = math.sqrt(material.shear.relaxed / (material.density or 0.0))
    time = np.linspace(0.0, curve.duration, PLACES)
    rate = np.gradient(curve.force(time), time)
    energy = radiation_coefficient(material.nu) / (material.density * speed**3) * np.trapezoid(rate**2, time)
    return float(energy / (0.5 * scene.mass * scene.velocity**2))


def test_a_body_weighs_what_its_volume_does_and_waves_have_their_speeds() -> None:
    mesh = meshes.half_space_for_waves(12.0, 0.1, 10.0)
    basis = Basis(mesh, ElementTriP2(), intorder=4)
    corners = mesh.p[:, mesh.t]
    (r, z) = corners[:, 1:] - corners[:, :1]
    volume = np.pi * np.sum(np.abs(r[0] * z[1] - r[1] * z[0]) * corners[0].mean(axis=0))  # Pappus
    assert forms.mass(basis)[:, 1::2, 1::2].sum() == pytest.approx(volume, rel=1e-12)
    assert volume == pytest.approx(2.0 / 3.0 * np.pi * 1e3, rel=0.05)  # a polygon inscribed in the quarter disc
    for poisson in (0.0, 0.3, 0.49):
        young = 1.0 - poisson**2  # E* = 1
        pressure, shear = wave_speeds(poisson)
        assert shear**2 == pytest.approx(young / (2.0 * (1.0 + poisson)))
        assert pressure**2 == pytest.approx(young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)))


@pytest.mark.parametrize("far_radius", [6.0, 12.0])
def test_of_what_waves_take_along_half_is_strain_wherever_the_mesh_ends(far_radius: float) -> None:
    """A material that relaxes long after the contact holds in its waves what the ball lost, half of it at rest."""
    material = {"law": "sls", "E1": 3e10, "E2": 3e9, "C1": 3e10, "nu": 0.3, "density": 3000.0}
    scene = Scene.load("steel-ball-waves", {"target.material": material, "striker.velocity": 5.0})
    energy = marched(scene, **QUICK, far_radius=far_radius)[0].energy
    lost = energy["in"] - energy["out"] - energy["numerical"]
    assert lost > 0.05 * energy["in"]
    assert energy["viscous"] < 1e-3 * lost
    assert energy["stored"] == pytest.approx(0.5 * lost, rel=0.1)
    assert energy["radiated"] == pytest.approx(0.5 * lost, rel=0.1)


@pytest.mark.family
@pytest.mark.parametrize(("poisson", "young"), [(0.0, 7e10), (0.45, 3e9)])
def test_the_ball_loses_what_its_force_radiates(poisson: float, young: float) -> None:
    """Lamb's point force, an integral, against the momentum of the ball and the energy left in the mesh."""
    material = {"law": "elastic", "E": young, "nu": poisson, "density": 3000.0}
    scene = Scene.load("steel-ball-waves", {"target.material": material, "striker.velocity": 0.3})
    march, curve = marched(scene, **QUICK)
    e = curve.quantities["restitution"]
    assert e is not None
    share = predicted(scene, curve)
    assert share < 0.06
    assert 1.0 - e**2 == pytest.approx(share, rel=0.03)
    assert march.energy["radiated"] / march.energy["in"] == pytest.approx(share, rel=0.03)
    assert abs(march.energy["residual"]) < 1e-9 * march.energy["in"]
    assert abs(march.energy["numerical"]) < 1e-3 * march.energy["radiated"]


@pytest.mark.tenth
def test_the_share_grows_as_the_speed_to_three_fifths() -> None:
    losses = []
    for velocity in (0.03, 0.3):
        scene = Scene.load("steel-ball-waves", {"striker.velocity": velocity, "model.profile": "parabola"})
        e = marched(scene, **QUICK)[1].quantities["restitution"]
        assert e is not None
        losses.append(1.0 - e**2)
    assert math.log10(losses[1] / losses[0]) == pytest.approx(0.6, abs=0.006)


@pytest.mark.tenth
def test_without_density_it_is_the_impact_without_inertia() -> None:
    scene = Scene.load("polymer-sphere-waves", {"target.material.density": 1e-3})
    quantities = marched(scene, elements_per_contact=8.0, penalty=1000.0)[1].quantities
    truth = laws.get("mdr").of(scene).simulate(scene, 1e-6).quantities
    for key in ("peak_force", "duration", "restitution", "peak_depth", "impulse"):
        assert quantities[key] == pytest.approx(truth[key].value, rel=1e-4), key


@pytest.mark.parametrize("exponent", [1.5, 2.0])
@pytest.mark.parametrize("fading", [0.0, 1.0, 12.0])
def test_the_end_of_contact_is_read_within_a_step_though_its_tail_is_faint(exponent: float, fading: float) -> None:
    """Forces known in closed form: symmetric ones, and those that all but vanish long before they end."""
    rng, off = np.random.default_rng(5), list[float]()
    for steps in rng.uniform(100.0, 700.0, 100):
        time = np.arange(math.ceil(steps) + 1) / steps
        left = np.maximum(1.0 - time, 0.0)
        read = parting(time, time * left**exponent * np.exp(-fading * time), exponent)
        assert read is not None
        off.append(steps * abs(read[0] - 1.0))
    assert max(off) < 0.06  # of a step, the twentieth within which no end follows a step


@pytest.mark.parametrize("fading", [0.0, 0.3, 1.0, 3.0, 12.0])
@pytest.mark.parametrize("chatter", [0.0, 0.01])
def test_how_well_an_end_is_read_covers_smooth_forces_and_is_about_what_chatter_leaves(
    fading: float, chatter: float
) -> None:
    """Of each smooth one; of chatter, whose last steps know nothing of the next, in the median."""
    rng, found = np.random.default_rng(6), list[tuple[float, float]]()
    for steps in rng.uniform(100.0, 700.0, 200):
        time = np.arange(math.ceil(steps) + 1) / steps
        force = time * np.maximum(1.0 - time, 0.0) ** 1.5 * np.exp(-fading * time)
        read = parting(time, force * (1.0 + chatter * rng.normal(size=time.size)), 1.5)
        assert read is not None
        found.append((abs(read[0] - 1.0), read[1]))
        assert read[1] <= (1.0 + 1e-12) / steps, "within a step, whatever chatters"
    off, spread = np.array(found).T
    if chatter:
        assert 0.3 * np.median(off) < np.median(spread) < 10.0 * np.median(off)
    else:
        assert np.all(off <= spread + 1e-12)


def test_a_last_step_that_chatters_leaves_no_spike_of_force_before_the_end() -> None:
    """Its impulse falls within what is left of the step: where that were nothing, the force would be its peak."""
    rng, strike = np.random.default_rng(7), Strike.of(Scene.load("polymer-sphere-waves"))
    for steps in rng.uniform(32.0, 128.0, 400):
        time = np.arange(math.ceil(steps) + 1) / steps
        force = time * np.maximum(1.0 - time, 0.0) ** 1.5 * rng.uniform(0.1, 1.9, time.size)
        read = parting(time, force, 1.5)
        assert read is not None
        impulse = np.append(0.0, np.cumsum(0.5 * (force[1:] + force[:-1]) / steps))
        rows, end = np.append(time[:-1], read[0]), read[0]
        mean = np.append(0.0, impulse[1:] / rows[1:])
        x, spread = np.sqrt(rows / end), np.array([0.0, 1.0])
        curve = Curve(strike, end, True, x, mean, rows * (end - rows), spread, spread, 0.0, {})
        assert np.abs(curve.resolved(np.linspace(x[-3], 1.0, 400))[1]).max() < 0.2 * force.max()


@pytest.mark.parametrize("soon", [0.003, 0.02, 0.3, 0.98])
def test_an_end_that_would_follow_a_step_at_once_is_read_a_twentieth_of_it_later_and_no_better(soon: float) -> None:
    """Of a force that falls along a line, in steps of a millisecond: else the next rows would lie on each other."""
    time = 1e-3 * np.arange(12.0)
    force = np.maximum(1e-3 * (10.0 + soon) - time, 0.0)
    force[:4] = time[:4]
    end, apart = parting(time, force, 1.0) or (0.0, 0.0)
    later = max(0.05 - soon, 0.0)
    assert end == pytest.approx(1e-3 * (10.0 + soon + later), rel=1e-9)
    assert apart == pytest.approx(1e-3 * later, abs=1e-11)


def test_too_few_steps_tell_no_end() -> None:
    time = np.arange(8.0)
    assert parting(time, np.array([0.0, 1.0, 2.0, 3.0, 2.0, 1.0, 0.5, 0.0]), 1.5) is None


@pytest.mark.parametrize("late", [[1.0, 1.2, 1.1, 1.0, 1.0], [3.0, 2.0, 1.2, 1.0, 1.2], [1.4, 1.3, 1.2, 1.1, 1.0]])
def test_a_tail_that_tells_no_end_is_read_a_step_wide(late: list[float]) -> None:
    """One that stands still, one that grows again, one that falls to zero in ten steps where the next has none."""
    end, apart = parting(np.arange(8.0), np.array([0.0, 5.0, *late, 0.0]), 1.0) or (0.0, 0.0)
    assert 6.0 < end <= 7.0
    assert apart == 1.0


@pytest.fixture(scope="module")
def steel() -> Result:
    """The ball of the facts on finite elements, 3: 206 GPa, nu = .3, 0.2553 g at 1 m/s."""
    return simulate(Scene.load("steel-ball-waves", {"striker.mass": 2.553e-4, "striker.velocity": 1.0}), "fe", {})


def test_waves_take_from_the_peak_what_was_measured_before(steel: Result) -> None:
    # e = .99234, peak -0.45 to -0.50 %
    result, scene = steel, steel.scene
    assert result.converged, result.message
    still = laws.get("mdr").of(scene).simulate(scene, 1e-6)
    peak, calm = result.quantities["peak_force"], still.quantities["peak_force"].value
    assert calm is not None
    assert -0.0050 <= peak.value / calm - 1.0 <= -0.0043
    assert result.quantities["restitution"].value == pytest.approx(0.99234, abs=5e-5)
    assert result.quantities["restitution"].error < 1e-3
    assert peak.error < 3e-3 * peak.value
    (inertia,) = [entry for entry in result.model_ledger if entry.effect == "target inertia"]
    assert inertia.treated == "included"
    (estimate,) = [entry.estimate for entry in still.model_ledger if entry.effect == "target inertia"]
    assert estimate == pytest.approx(1.0 - peak.value / calm, rel=0.1)


def random_scene(rng: np.random.Generator) -> Scene:
    """Elastic or with memory, a/R up to 0.3, slow beside its waves."""
    young, nu, speed = 10 ** rng.uniform(6, 11), rng.uniform(0.0, 0.48), 10 ** rng.uniform(-2.5, -0.5)
    elastic = {"law": "elastic", "E": young}
    memory = {"law": "prony", "E_inf": young, "E": [young * rng.uniform(0.1, 2.0)], "tau": [1e-3]}
    density = 2000.0
    velocity = speed * 0.06 * math.sqrt(young / density)
    mass = density * 4.0 / 3.0 * np.pi * 0.005**3 * 10 ** rng.uniform(-0.3, 0.7)
    return Scene.from_dict(
        {
            "striker": {"shape": "sphere", "radius": 0.005, "mass": mass, "velocity": velocity},
            "target": {
                "shape": "half_space",
                "material": (elastic if rng.integers(2) else memory) | {"nu": nu, "density": density},
            },
            "model": {"inertia": True},
        }
    )


@pytest.mark.tenth
def test_bars_hold_the_answer_of_finer_settings(steel: Result, campaign_size: Callable[[int], int]) -> None:
    """And of elements of another order; the steel ball first, then random scenes."""
    rng = np.random.default_rng(3)
    for number in range(campaign_size(10)):
        result = simulate(random_scene(rng), "fe", {}) if number else steel
        assert result.converged, result.message
        numerics, scene = result.numerics, result.scene
        finer = {"steps": 2 * numerics["steps"], "penalty": 2.0 * numerics["penalty"], "order": 4}
        quantities = marched(scene, elements_per_contact=numerics["elements_per_contact"], **finer)[1].quantities
        for name, value in quantities.items():
            known = result.quantities[name]
            assert abs(known.value - value) <= known.error, (name, scene)


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"striker": {"shape": "punch", "radius": 1e-3, "mass": 1e-3, "velocity": 1.0}}, "striker.shape"),
        ({"target.material.constant": "bulk"}, "target.material.constant"),
    ],
)
def test_what_has_no_waves_here_is_refused_with_its_key(changes: dict[str, Any], key: str) -> None:
    with pytest.raises(BadInput, match=key):
        half_space.check(Scene.load("polymer-sphere-waves", changes))


def test_settings_of_the_other_kind_are_refused() -> None:
    with pytest.raises(BadInput, match=r"numerics.scheme.*trapezoidal"):
        simulate(Scene.load("steel-ball-waves"), "fe", {"scheme": "galerkin"})
    with pytest.raises(BadInput, match=r"numerics.mass"):
        simulate(Scene.load("polymer-sphere"), "fe", {"mass": "lumped"})


def test_an_equivalent_modulus_is_no_wave_medium() -> None:
    with pytest.raises(BadInput, match="no wave medium"):
        Scene.load("steel-ball", {"model.inertia": True})


@pytest.mark.parametrize("name", ["polymer-washer", "rod-in-ring", "polymer-o-ring"])
def test_a_target_without_waves_names_those_that_have_them(name: str) -> None:
    with pytest.raises(BadInput, match=r"model\.inertia.*false, or target\.shape half_space, layer, plane, rod"):
        Scene.load(name, {"model.inertia": True})


@pytest.mark.tenth
def test_compared_with_laws_that_know_no_waves_the_ball_comes_back_slower(tmp_path: Path) -> None:
    """By the energy that is radiated, 1.5 per cent, half of which is the restitution's share."""
    coarse = ["--tolerance", "0.05", "--set", "numerics.steps=100", "--set", "numerics.elements_per_contact=4"]
    assert main(["compare", "steel-ball-waves", *coarse, "--laws", "mdr", "--out", str(tmp_path)]) == 0
    content = json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))
    (line,) = content["verdict"]
    assert "restitution" in line
    assert "too high" in line
    errors = content["candidates"]["mdr"]["errors"]
    assert errors["restitution"] == pytest.approx(1.0 - 0.9923, abs=3e-4)
    assert errors["pressure_rebound"] is None
    assert (tmp_path / "compare.png").exists()


def test_a_rigid_ball_may_bounce_and_one_that_rings_on_may_not() -> None:
    bouncing = Scene.load("ball-bouncing-waves")
    half_space.check(bouncing)
    mass = 4.0 / 3.0 * math.pi * bouncing.shape.tip_radius**3 * bouncing.material.density
    with pytest.raises(BadInput, match="rings on"):
        half_space.check(replace(bouncing, mass=mass, striker_material=bouncing.material))


@pytest.mark.tenth
@pytest.mark.parametrize(
    ("material", "known"),
    [
        ({"law": "sls", "E0": 1e6, "R1": 5.0, "R2": 6e-4, "density": 2e4}, True),
        ({"law": "sls", "E0": 1e6, "R1": 20.0, "R2": 1.2e-3, "density": 4e4}, False),
        ({"law": "kelvin_voigt", "E": 1e6, "eta": 1.8e3, "density": 2.5e4}, False),
        ({"law": "kelvin_voigt", "E": 1e6, "eta": 6e3, "density": 2e4}, False),
    ],
    ids=["sent off", "lost", "damped", "overdamped"],
)
def test_what_a_material_takes_of_a_wave_tells_how_well_the_ledger_knows_inertia(
    material: dict[str, Any], known: bool
) -> None:
    """A peak falls by what is radiated, to a half more or less; where most of that is lost it may rise as well."""
    striker = {"shape": "sphere", "radius": 0.01, "mass": 0.01, "velocity": 0.05}
    target = {"shape": "half_space", "material": {**material, "nu": 0.3}}
    scene = Scene.from_dict({"striker": striker, "target": target})
    still, moves = (simulate(one, "fe", {}, 1e-2) for one in (scene, scene.changed({"model.inertia": True})))
    (entry,) = [one for one in still.model_ledger if one.effect == "target inertia"]
    own, larger = (one.quantities["peak_force"] for one in (still, moves))
    change = (larger.value or 0.0) / (own.value or math.nan) - 1.0
    bar = ((larger.error or 0.0) + (own.error or 0.0)) / (own.value or math.nan)
    assert (entry.spread is None) is known
    if known:
        assert entry.estimate == pytest.approx(-change, rel=0.5)
    else:
        assert abs(change) - bar < entry.size < 1.0
        assert "its material takes most of that" in entry.note
