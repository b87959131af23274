"""Mass on a rod by finite elements against its exact waves: every bar true, forces away from fronts to 1e-3."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_contact.cli import main
from fe_contact.contact.problem import ContactProblem, PressedSurface
from fe_contact.methods import simulate
from fe_contact.reference import check
from fe_contact.studies.compare.study import WITHIN
from fe_contact.waves.line import _lost_in_rounding
from fe_contact.waves.line_reading import RodReading, _ended_by
from fe_contact.waves.targets import rod
from lumped import BadInput, Result, Scene, laws
from lumped.load_curves.hertz import Hertz
from lumped.result.result import RULED_ABSOLUTE, RULED_RELATIVE
from lumped.scene.indenter import Indenter
from lumped.schema import Table
from lumped.solvers.rod import Waves

CASES = 40
WIDE_CASES = 30
HAIR, LEAST_BAND = 1e-9, 1e-6  # of the contact, within which a force jumps; of the peak, between rows of the law
NEAR = 0.01  # share of the contact that counts as a front


def drawn(rng: np.random.Generator) -> Scene:
    """A rod of any end, its mass a tenth to five times that of the striker, struck flat or by a ball."""
    flat = bool(rng.integers(2))
    length, area, modulus = rng.uniform(0.2, 3.0), 10 ** rng.uniform(-4, -2), 10 ** rng.uniform(9, 11.3)
    mass = area * length * 2500.0 * 10 ** rng.uniform(-0.7, 1.0)
    end = ("fixed", "free", "absorbing")[rng.integers(3)]
    impedance = area * np.sqrt(modulus * 2500.0)
    striker = {"shape": "punch", "radius": 0.1} if flat else {"shape": "sphere", "radius": 10 ** rng.uniform(-2, 0)}
    motion = {"motion": {"end_time": 4.0 * mass / impedance}} if flat and end == "absorbing" else {}
    return Scene.from_dict(
        {
            "striker": {**striker, "mass": mass, "velocity": 10 ** rng.uniform(-1, 1)},
            "target": {
                "shape": "rod",
                "area": area,
                "length": length,
                "end": end,
                "material": {"law": "elastic", "E": modulus, "nu": rng.uniform(0.0, 0.45), "density": 2500.0},
            },
            "model": {"inertia": True, "profile": "parabola"},
            **motion,
        }
    )


def widely_drawn(rng: np.random.Generator) -> Scene:
    """A rod struck by any profile, 0.05 to 20 times as heavy, some under a weight, some left in mid contact."""
    radius, modulus, density = 10 ** rng.uniform(-3, -1), 10 ** rng.uniform(6, 11.3), 10 ** rng.uniform(2.5, 4)
    length, area, speed = radius * 10 ** rng.uniform(0.8, 2.3), np.pi * radius**2, np.sqrt(modulus / density)
    mass, velocity = area * length * density * 10 ** rng.uniform(-1.3, 1.3), speed * 10 ** rng.uniform(-5, -2.5)
    exponent = rng.uniform(1.2, 6.0)
    striker = (
        {"shape": "punch", "radius": radius},
        {"shape": "sphere", "radius": radius * 10 ** rng.uniform(-0.7, 2.0)},
        {"shape": "cone", "angle": rng.uniform(1.0, 20.0)},
        {"shape": "power", "coefficient": radius ** (1.0 - exponent) * 10 ** rng.uniform(-2.5, -0.5)}
        | {"exponent": exponent},
    )[rng.integers(4)]
    end = ("fixed", "free", "absorbing")[rng.integers(3)]
    braking = mass / (area * speed * density)  # s, by waves alone
    gravity = min(velocity / braking * 10 ** rng.uniform(-3, 0.3), 1e5) if rng.random() < 0.3 else 0.0
    stays = end == "absorbing" or gravity > 0.0 or rng.random() < 0.2
    return Scene.from_dict(
        {
            "striker": striker | {"mass": mass, "velocity": velocity},
            "target": {"shape": "rod", "area": area, "length": length, "end": end}
            | {"material": {"law": "elastic", "E": modulus, "nu": rng.uniform(-0.5, 0.4999), "density": density}},
            "model": {"inertia": True, "profile": "parabola", "gravity": gravity},
        }
        | ({"motion": {"end_time": braking * 10 ** rng.uniform(-0.5, 0.7)}} if stays else {})
    )


def exact(scene: Scene) -> Result:
    return laws.get("rod_waves").of(scene).simulate(scene, 1e-7)


def test_every_number_of_a_rod_lies_within_its_bar(campaign_size: Callable[[int], int]) -> None:
    rng = np.random.default_rng(5)
    for _ in range(campaign_size(CASES)):
        scene = drawn(rng)
        found, truth = simulate(scene, "fe", {}), exact(scene)
        assert found.converged, found.message
        assert found.separated == truth.separated
        for name, quantity in found.quantities.items():
            known = truth.quantities[name]
            if quantity.value is None or known.value is None:
                assert quantity.value is known.value
                continue
            assert abs(quantity.value - known.value) <= quantity.error + (known.error or 0.0), (name, scene)
            scale = abs(known.value) if name in RULED_RELATIVE else 1.0
            if name in (*RULED_RELATIVE, *RULED_ABSOLUTE):
                assert quantity.error <= 1e-3 * scale
        time, force = found.history.time, truth.history.force
        fronts = np.arange(400) * min(Waves.of(scene).delay, 1e9)
        away = np.abs(time[:, None] - fronts).min(axis=1) > NEAR * time[-1]
        known_force = np.interp(time, truth.history.time, force)
        assert np.abs(found.history.force - known_force)[away].max() < 1e-3 * force.max()


@pytest.mark.family
@pytest.mark.parametrize("tolerance", [0.1, 1e-2, 1e-3])
def test_no_bar_of_a_rod_is_too_small(
    tolerance: float, campaign_size: Callable[[int], int], uncovered: Callable[..., dict[str, float]]
) -> None:
    """Alone, and the force at every time but where it jumps, a hair to either side."""
    rng = np.random.default_rng([13, round(1 / tolerance)])
    converged = []
    for _ in range(campaign_size(WIDE_CASES)):
        scene = widely_drawn(rng)
        found, truth = simulate(scene, "fe", {"tolerance": tolerance}), exact(scene)
        assert not uncovered(found, truth), scene
        history, known = found.history, truth.history
        sides = HAIR * history.time[-1] * np.array([[-1.0], [0.0], [1.0]])
        missed = np.abs(history.force - known.force_at(history.time + sides)).min(axis=0)
        law = np.interp(history.time, known.time, known.force_error) + LEAST_BAND * history.force.max()
        assert (missed <= history.force_error + law).all(), scene
        converged.append(found.converged)
    assert np.mean(converged) >= 0.95


@pytest.mark.tenth
def test_steps_that_agree_by_chance_make_no_bar_too_small(uncovered: Callable[..., dict[str, float]]) -> None:
    """What a quantity does as steps double crosses zero somewhere: at some of these steps for some quantity."""
    striker = {"shape": "sphere", "radius": 0.13, "mass": 12.0, "velocity": 0.058}
    material = {"law": "elastic", "E": 2.6e8, "nu": -0.36, "density": 7400.0}
    target = {"shape": "rod", "area": 7.4e-4, "length": 2.2, "end": "fixed", "material": material}
    scene = Scene.from_dict({"striker": striker, "target": target, "model": {"inertia": True, "profile": "parabola"}})
    truth = exact(scene)
    for steps in range(500, 1000, 40):
        found = simulate(scene, "fe", {"steps": steps, "tolerance": 0.1})
        assert not uncovered(found, truth), steps


@pytest.mark.parametrize("late", [0, 1, 3])
@pytest.mark.parametrize("left", [0.2, 0.4, 0.6, 0.9])
def test_a_front_ends_a_contact_whose_force_would_have_gone_on(late: int, left: float) -> None:
    """Where it opens at once, and the force, which falls evenly, would have been more than half as large by then."""
    front = 10
    even = 1.0 - (1.0 - left) / (late + 1) * (np.arange(front + late + 1) - (front - 1))
    force = np.where(np.arange(even.size) < front, even, 0.0)
    assert _ended_by(force, front) == (left > 0.5)
    assert not _ended_by(np.append(force, np.zeros(4)), front), "it opened later"
    assert not _ended_by(force[front - 2 :], 2), "what so few steps tell"


@pytest.mark.parametrize("name", ["rod", "rod-free", "rod-absorbing"])
def test_a_rod_without_mass_at_its_struck_end_has_all_of_it_elsewhere(name: str) -> None:
    """Moved as a whole it resists with its mass, less what a held end bears; the striker keeps its own."""
    scene = Scene.load(name)
    body = rod.moving(scene, rod.plan(scene, {"mass": "redistributed"}).numerics).body
    assert body.massless.tolist() == [0]
    held = 0.5 * rod.rod_mass(scene) / (body.size - 1) if name == "rod" else 0.0
    assert body.inertia.sum() == pytest.approx(scene.reduced_mass + rod.rod_mass(scene) - held)


@pytest.mark.tenth
def test_a_weight_pulls_until_the_very_end() -> None:
    """Contact ends within a step: what left at that step's end had fallen on, and no change of steps told."""
    striker = {"shape": "sphere", "radius": 2.3e-3, "mass": 4.6e-4, "velocity": 6.7e-3}
    material = {"law": "elastic", "E": 3.9e6, "nu": 0.42, "density": 364.0}
    target = {"shape": "rod", "area": 1.9e-4, "length": 0.14, "end": "absorbing", "material": material}
    model = {"inertia": True, "profile": "parabola", "gravity": 3.6}
    scene = Scene.from_dict({"striker": striker, "target": target, "model": model})
    known = exact(scene).quantities["restitution"].value
    for steps in (300, 310, 320, 330):
        found = simulate(scene, "fe", {"steps": steps}).quantities["restitution"]
        assert found.value == pytest.approx(known, abs=found.error)
        assert found.error < 3e-4


def ball_on_rod(striker: Table, rod: Table, material: Table) -> Scene:
    """An elastic rod with waves, struck by a ball that is a parabola."""
    target = {"shape": "rod", **rod, "material": {"law": "elastic", **material}}
    model = {"inertia": True, "profile": "parabola"}
    return Scene.from_dict({"striker": {"shape": "sphere", **striker}, "target": target, "model": model})


@pytest.mark.tenth
def test_a_heavy_ball_meets_the_first_front_long_before_it_turns() -> None:
    """Its dent presses as hard as a front after a hundredth of the transit: elements at first are as short as that."""
    striker = {"radius": 6.7e-3, "mass": 0.05, "velocity": 0.22}
    material = {"E": 4e6, "nu": 0.42, "density": 2950.0}
    scene = ball_on_rod(striker, {"area": 5e-6, "length": 0.17, "end": "free"}, material)
    found, truth = simulate(scene, "fe", {}), exact(scene)
    assert found.converged, found.message
    for name in ("peak_force", "peak_depth", "duration", "restitution", "impulse"):
        value, known = found.quantities[name], truth.quantities[name]
        assert abs(value.value - known.value) <= value.error + known.error


def fading(slowness: float) -> RodReading:
    """Of depth one, its dent of a hundredth gone by half of the time but for a part that closes ``slowness`` times as
    slowly as the striker came.
    """
    time = np.linspace(0.0, 2.0, 2001)
    dent = 0.01 * np.clip(1.0 - time, 0.0, None) ** 4 + (2.0 - time) / slowness
    rows = np.array([time, np.clip(time, 0.0, 1.0), np.clip(1.0 - time, 0.0, None), dent**1.5, dent])
    return RodReading(rows, 1.0, True, {})


@pytest.mark.parametrize("slowness", [1e2, 1e5, 1e8, 1e11])
def test_a_dent_that_fades_ends_within_what_rounding_moves_its_paths(slowness: float) -> None:
    """By half of the last digit a step, of two paths as long as the striker's."""
    moved = np.finfo(float).eps * 2001 * slowness
    assert _lost_in_rounding(fading(slowness)) == pytest.approx(moved, rel=1e-3, abs=1e-12)


@pytest.mark.tenth
def test_a_striker_that_waves_have_all_but_stopped_leaves_when_rounding_lets_it() -> None:
    """With 5e-8 of its speed: two marches agreed by chance in when, and the bar was 1.7 times too small."""
    striker = {"radius": 6.75358e-3, "mass": 0.162837, "velocity": 0.03865}
    material = {"E": 1.28871e6, "nu": 0.267088, "density": 740.437}
    scene = ball_on_rod(striker, {"area": 2.55521e-5, "length": 0.05, "end": "absorbing"}, material)
    found = simulate(scene, "fe", {"tolerance": 0.1, "steps": 1600}).quantities["duration"]
    known = laws.get("rod_waves").of(scene).simulate(scene, 1e-9).quantities["duration"]
    assert abs(found.value - known.value) <= found.error + known.error


@pytest.mark.parametrize("overlap", [1e-3, 1e-9, 1e-15])
def test_a_dent_and_what_yields_share_the_overlap_however_small_it_is(overlap: float) -> None:
    """Dent + force / stiffness = overlap, in closed form where the two are alike."""
    stiffness, curve = 2e7, Hertz(0.1)
    modulus = stiffness * 0.5 * overlap / float(curve.force(0.5 * overlap))
    surface = PressedSurface(np.array([[stiffness]]), np.ones((1, 1)), np.ones(1))
    found = rod.Dent(modulus, curve).enforce(ContactProblem(surface, np.array([overlap]), 0.0))
    assert found.converged
    assert found.pressure[0] == pytest.approx(0.5 * overlap * stiffness, rel=1e-12)


def test_the_energy_account_closes_and_says_what_the_waves_took() -> None:
    for name in ("rod", "concrete-pole"):
        scene = Scene.load(name)
        found, truth = simulate(scene, "fe", {}), exact(scene)
        assert abs(found.energy["residual"]) < 1e-9 * found.energy["in"]
        for term in ("out", "stored", "radiated"):
            # a front carries its energy in one element of some hundred
            allowed = 0.03 if name == "rod" else 2e-3
            assert found.energy[term] == pytest.approx(truth.energy[term], abs=allowed * found.energy["in"])


def test_a_relaxation_that_takes_for_ever_is_elastic_and_a_quick_one_costs_energy() -> None:
    slow, lossy = ({"law": "prony", "E_inf": 1e11, "E": [5e10], "tau": [tau]} for tau in (1e3, 1e-4))
    common, loose = {"nu": 0.3, "density": 7850.0}, {"tolerance": 0.1}
    found = simulate(Scene.load("rod", {"target.material": slow | common}), "fe", loose)
    elastic = exact(Scene.load("rod", {"target.material": {"law": "elastic", "E": 1.5e11} | common}))
    for name in ("peak_force", "duration", "impulse"):
        assert found.quantities[name].value == pytest.approx(elastic.quantities[name].value, rel=1e-3)
    found = simulate(Scene.load("rod", {"target.material": lossy | common}), "fe", loose)
    assert found.energy["viscous"] > 0.01 * found.energy["in"]
    assert abs(found.energy["residual"]) < 1e-6 * found.energy["in"]


@pytest.mark.family
@pytest.mark.parametrize("name", ["rod", "rod-free"])
def test_the_exact_waves_lie_within_the_reference_of_a_comparison(name: str, tmp_path: Path) -> None:
    """Jumps at the same times, so that at no time between them the forces differ by more than the bar; the free rod's
    largest force is that at touch, t = 0.
    """
    assert main(["compare", name, "--out", str(tmp_path)]) == 0
    content = json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))
    assert content["verdict"][0] == f"rod_waves: {WITHIN}"
    assert set(content["candidates"]) == {"rod_waves"}, "no other law is for a rod"


def test_a_rod_has_no_slow_indentation() -> None:
    with pytest.raises(BadInput, match=r"target.shape"):
        Indenter.load("rod")


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"target.material": {"law": "kelvin_voigt", "E": 1e9, "eta": 1e3}}, "material.law"),
        ({"target.end": "absorbing", "target.material": {"law": "maxwell", "E": 1e9, "eta": 1e9}}, "material.law"),
        ({"motion.impacts": 3}, "motion.impacts"),
    ],
)
def test_rods_that_elements_do_not_carry_are_refused(changes: dict[str, Any], key: str) -> None:
    for path in ("target.material",):
        if path in changes:
            changes = changes | {path: changes[path] | {"nu": 0.3, "density": 1e3}}
    with pytest.raises(BadInput, match=key):
        check(Scene.load("rod", changes), {})


@pytest.mark.parametrize("name", ["rod", "rod-free"])
def test_a_front_s_force_on_a_light_striker_is_in_its_bar_or_refused(
    name: str, uncovered: Callable[..., dict[str, float]]
) -> None:
    """Steps that pass over it agreed on a quarter of the greatest force, which doubles as the echo meets the mass."""
    light = {"striker.mass": 1.5e-3 * 1.2330971, "motion.end_time": 2.2e-4}
    scene = Scene.load(name, light)
    assert not uncovered(simulate(scene, "fe", {"tolerance": 0.1}), exact(scene))
    with pytest.raises(BadInput, match=r"steps: 1000 .* from \d+, or none"):
        simulate(scene, "fe", {"steps": 1000})
    with pytest.raises(BadInput, match=r"striker\.mass: 0\.0001: .* from 0\.00148, or --method rod_waves"):
        simulate(Scene.load(name, light | {"striker.mass": 1e-4}), "fe", {})


@pytest.mark.parametrize("tau", [1e-8, 1e-6, 1e-4])
def test_a_flat_end_is_met_by_the_glassy_rod_however_soon_that_relaxes(tau: float) -> None:
    """F(0+) = Z v; read off the steps behind the front it jittered with a branch that relaxes within them."""
    material = {"law": "prony", "E_inf": 2e11, "E": [4e9], "tau": [tau], "nu": 0.3, "density": 7850.0}
    scene = Scene.load("rod-free", {"target.material": material, "striker.mass": 0.02})
    found = simulate(scene, "fe", {"tolerance": 0.01})
    known = 3.1415927e-4 * np.sqrt(2.04e11 * 7850.0)
    assert found.history.force[0] == pytest.approx(known, rel=1e-9)
    peak = found.quantities["peak_force"]
    assert abs(peak.value - known) <= peak.error
