"""Impacts on layers and inside rings against Ting with their own load curves."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import fe_contact
from fe_contact.budget import runs
from fe_contact.budget.certify import Certified, certify
from fe_contact.budget.plan import BAND, SPARE, plan, scales
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem
from fe_contact.march.impact import march
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.steppers.steps import Strike
from fe_contact.steppers.struck import WIDTH, FixedStepper
from fe_contact.targets.base import struck
from fe_contact.targets.layer import meshed
from lumped import BadInput, Material, Model, Relaxation, Result, Scene, Sphere, laws, simulate
from lumped.errors import NotReached
from lumped.result.score import normalized_error
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.targets.layer import Layer
from lumped.targets.ring import Ring

TOLERANCE, MASS = 1e-3, 0.02
RULED = ("peak_force", "peak_depth", "duration", "impulse", "restitution")
IMPACTS = 30
EDGE = 0.02  # of an element that stays: within so much of it the edge is found, wherever it lies in it


def random_scene(seed: int) -> Scene:
    """Elastic, one or two Prony terms; sphere, cone or cylinder; contact radius over thickness about 0.1 to 2."""
    rng = np.random.default_rng([20261121, seed])
    shape = (Sphere(0.01), Cone(float(rng.uniform(2.0, 8.0))), Cylinder(0.01, 0.02))[seed % 3]
    terms = seed % 4 % 3
    times = tuple(float(t) for t in 10.0 ** rng.uniform(-3.5, -1.0, terms))
    young = Relaxation(1e6, tuple(float(m) for m in 1e6 * rng.uniform(0.1, 1.5, terms)), times)
    material = Material(young, float(rng.uniform(0.0, 0.48)))
    velocity = float(10.0 ** rng.uniform(-2.3, -1.3))
    radius = shape.hertz_impact(1e6, MASS, velocity).contact_radius
    thickness = radius / float(10.0 ** rng.uniform(-1.0, 0.3))
    base = "bonded" if rng.random() < 0.7 else "sliding"
    return Scene(shape, MASS, velocity, material, target=Layer(thickness, base))


def exact(scene: Scene) -> Result:
    return simulate(laws.ting.of(scene), scene, 1e-6)


def test_impacts_whose_contacts_are_about_as_wide_share_their_meshes() -> None:
    """Speeds over a factor of four, on layers of any size, need no more meshes than there are widths between."""
    scene, bodies = Scene.load("polymer-layer"), []
    for number, speed in enumerate(np.geomspace(0.01, 0.04, 12).tolist()):
        size = 3.0 ** (number % 2)
        alike = {"shape": Sphere(0.006 * size), "target": Layer(0.002 * size, "bonded"), "mass": 0.05 * size**3}
        one = replace(scene, velocity=speed, **alike)
        numerics = plan(one, {}).numerics
        assert 1.0 / BAND < (numerics.contact_radius / (SPARE * scales(one, numerics).contact_radius)) ** 2 < BAND
        bodies.append(meshed(one.geometry, numerics))
    widths = [body.arguments[0][2] for body in bodies]
    assert len({*bodies}) == len({*widths}) <= 1 + round(math.log(max(widths) / min(widths), BAND)) < 8


@pytest.mark.tenth
def test_finite_elements_agree_with_ting_within_bar_and_tolerance(
    campaign_size: Callable[[int], int], agree: Callable[..., None]
) -> None:
    for seed in range(campaign_size(IMPACTS)):
        scene = random_scene(seed)
        found, truth = fe_contact.run(scene, TOLERANCE), exact(scene)
        agree(found, truth)
        check_histories(found, truth)


def random_ring(seed: int) -> Scene:
    """A rod of 12 mm in a ring, the paper's among them: clearance, thickness, nu and speed drawn."""
    rng = np.random.default_rng([20261122, seed])
    inner = 0.006 + float(10.0 ** rng.uniform(-3.3, -2.0))
    young = Relaxation(0.6e6, (0.3e6,), (float(10.0 ** rng.uniform(-3.0, -1.5)),))
    ring = Ring(inner, float(rng.uniform(0.002, 0.006)))
    material = Material(young, float(rng.uniform(0.2, 0.49)))
    return Scene(Cylinder(0.006, 0.03), 0.05, float(10.0 ** rng.uniform(-2.0, -1.0)), material, target=ring)


@pytest.mark.tenth
def test_a_rod_in_a_ring_agrees_with_ting(campaign_size: Callable[[int], int], agree: Callable[..., None]) -> None:
    for seed in range(campaign_size(IMPACTS) // 2 + 1):
        scene = random_ring(seed)
        found, truth = fe_contact.run(scene, TOLERANCE), exact(scene)
        agree(found, truth)
        check_histories(found, truth)


@pytest.mark.tenth
def test_a_deep_rebound_in_a_ring_tells_what_ting_leaves_out() -> None:
    """At half-angles near 0.9 the law ends a thousandth late, ten bars of the finite elements: its own bar says so."""
    young = Relaxation(6e5, (7.8e4, 1.7e6, 3.8e6), (273.0, 1.07e-4, 1.88e-4))
    ring = Ring(0.00677, 0.00492)
    scene = Scene(Cylinder(0.006, 0.03), 0.05, 1.4, Material(young, 0.242), target=ring)
    found, law = fe_contact.run(scene, TOLERANCE), simulate(laws.ting.of(scene), scene, 1e-2)
    for name in ("duration", "restitution", "impulse"):
        one, other = found.quantities[name], law.quantities[name]
        apart = abs((one.value or 0.0) - (other.value or 0.0))
        assert 5.0 * (one.error or 0.0) < apart < (other.error or 0.0) + (one.error or 0.0)
        assert (other.error or 0.0) < 3.0 * apart


def test_a_march_overlaps_a_rod_with_its_ring_as_circles_do() -> None:
    """From the ring's middle a ray at an angle leaves the rod, pushed out by clearance and depth, beyond the ring."""
    scene, rng = Scene.load("rod-in-ring"), np.random.default_rng(5)
    overlap, ring = Strike.of(scene).overlap, scene.target
    assert isinstance(ring, Ring)
    assert overlap is not None
    radius, inner = scene.geometry.shape.tip_radius, ring.inner_radius
    assert radius is not None
    for angle, depth in zip(rng.uniform(-0.5, 0.5, 20), inner * 10 ** rng.uniform(-4, -1, 20), strict=True):
        middle = inner - radius + depth
        leaves = middle * np.cos(angle) + np.sqrt(radius**2 - (middle * np.sin(angle)) ** 2)
        assert overlap(inner * angle, depth) == pytest.approx(leaves - inner, abs=1e-12 * inner)


def check_histories(found: Result, truth: Result) -> None:
    """Forces within the norm's bar, the energy closed, contact radii alike."""
    difference = normalized_error(truth.history, found.history)
    assert difference <= (found.quantities["history_l2"].error or 0.0) + 1e-4  # what linear interpolation leaves
    assert abs(found.energy["residual"] or 0.0) <= 5e-3 * (found.energy["in"] or 0.0)
    assert radius_deviation(found, truth) <= EDGE / found.numerics["elements_per_contact"]


def radius_deviation(found: Result, truth: Result) -> float:
    """Largest distance of the contact radius from Ting's nested areas before the last 5 %, over the largest radius."""
    time = np.linspace(0.02, 0.95, 400) * truth.history.time[-1]
    radius, nested = (np.interp(time, one.time, one.contact_radius) for one in (found.history, truth.history))
    return float(np.abs(radius - nested).max() / nested.max())


def test_a_thick_layer_is_the_half_space() -> None:
    scene = Scene.load("polymer-sphere")
    deep = replace(scene, target=Layer(1.0, "bonded"))
    one, other = fe_contact.run(scene, TOLERANCE), fe_contact.run(deep, TOLERANCE)
    # 0.4 mm of contact on a metre: the layer is stiffer by some a/h
    for name in RULED:
        value = one.quantities[name].value or 0.0
        assert other.quantities[name].value == pytest.approx(value, rel=2.5e-3)


def test_what_cannot_be_struck_says_so() -> None:
    material = Material(Relaxation(1e6), 0.3)
    with pytest.raises(BadInput, match="datum_depth"):
        Scene(Cylinder(0.01, 0.02), 0.1, 0.01, material, model=Model())
    with pytest.raises(BadInput, match="mdr is not for this layer, but for the half-space"):
        laws.mdr.of(random_scene(0))


@pytest.mark.tenth
def test_what_finer_settings_fail_to_better_stands_with_its_bars(monkeypatch: pytest.MonkeyPatch) -> None:
    """A cone on a thin layer: where no finer march ended, the coarse answer is told, and not converged."""
    asked = list[Numerics]()

    def certified(*given: Any) -> Certified:
        asked.append(given[2])
        if len(asked) > 1:
            raise NotReached("made up")
        return certify(*given)

    monkeypatch.setattr("fe_contact.reference.certify", certified)
    soft = Material(Relaxation(6.7e5, viscosity=9.8), 0.036)
    cone, layer = Cone(1.53), Layer(2.0e-4, "bonded")
    scene = Scene(cone, 1.22e-10, 0.303, soft, target=layer, model=Model(gravity=3.2e4))
    found, truth = fe_contact.run(scene, TOLERANCE), exact(scene)
    assert len(asked) == 2
    assert not found.converged
    for name in ("peak_force", "peak_depth"):
        value, true = found.quantities[name], truth.quantities[name]
        assert abs(value.value - true.value) <= value.error + true.error


def test_a_step_into_a_ring_ends_with_the_force_of_the_depth_it_ends_at() -> None:
    """Pressed to that depth without any motion: the overlaps of a hollow surface do not grow alike with the depth."""
    scene = replace(Scene.load("rod-in-ring"), velocity=0.3)
    numerics = plan(scene, {}).numerics
    stepper = struck(scene.geometry, numerics).stepper(Strike.of(scene), numerics, ())
    assert isinstance(stepper, FixedStepper)
    step = stepper.step(stepper.touch(), (), 0.25 * numerics.contact_time)
    offer = stepper.body.offer(stepper.touch().memory.body, step.length)
    target, angles = scene.geometry.target, stepper.places / scene.geometry.target.length_of_place
    overlap = np.maximum(target.overlap(scene.profile, angles, step.state.depth), -10.0 * step.radius)
    pressed = ContactProblem(offer.surface, offer.now * overlap + offer.past, numerics.penalty / WIDTH)
    still = ENFORCEMENTS.get(numerics.enforcement).enforce(pressed, step.solution.sets[0])
    force = stepper.surface.operator.force(stepper.scale, still.pressure)
    assert force == pytest.approx(step.force, rel=1e-9)
    assert step.work.steps == 1
    assert 2 < step.work.contact_problems < step.work.iterations, "more than one secant, each by two penalties"


@pytest.mark.parametrize("viscosity", [0.0, 200.0])
def test_the_force_at_the_touch_of_what_is_round_is_that_of_a_first_step_without_length(viscosity: float) -> None:
    """None, of a dashpot neither: nothing is touched yet."""
    scene = Scene.load("polymer-layer")
    scene = replace(scene, material=Material(Relaxation(1e6, viscosity=viscosity), scene.material.nu))
    numerics = plan(scene, {"steps": 48}).numerics
    stepper = struck(scene.geometry, numerics).stepper(Strike.of(scene), numerics, ())
    assert isinstance(stepper, FixedStepper)
    assert stepper.surface.operator.nodes[stepper.standing()] == 0.0, "on the axis"
    usual = scene.mass * scene.velocity / numerics.contact_time
    lengths = numerics.contact_time * np.geomspace(1e-4, 1e-8, 5)
    forces = np.array([stepper.step(stepper.touch(), (), length).force for length in lengths]) / usual
    assert 0.0 < forces[-1] < forces[0] < 0.1
    assert stepper.first_force / usual == pytest.approx(forces[-1], abs=1e-3)


def test_pressure_is_told_for_an_instant_within_its_step() -> None:
    scene = Scene.load("polymer-layer")
    numerics = plan(scene, {"steps": 48}).numerics
    found = march(Strike.of(scene), struck(scene.geometry, numerics), numerics)
    told = np.array([snapshot.time for snapshot in found.snapshots])
    assert (told >= found.time[: len(told)]).all()
    assert (told <= found.time[1 : len(told) + 1]).all()
    assert found.work.steps == len(told)
    assert found.work.contact_problems == 2 * len(told), "two penalties a step"
    surface = struck(scene.geometry, numerics)
    assert isinstance(surface, ScaledSurface)
    operator = surface.operator
    unit = found.snapshots[0].radii[0] / operator.points[0]
    for shot in found.snapshots:
        assert shot.radii == pytest.approx(unit * operator.points), "the mesh stays"
        assert shot.force == pytest.approx(unit**2 * float(operator.weights @ shot.pressure), rel=1e-9)


@pytest.mark.parametrize(
    ("name", "calmed"), [("polymer-layer", True), ("polymer-sphere", False), ("steel-ball", False)]
)
def test_only_a_viscous_force_on_a_mesh_that_stays_is_read_through_fewer_steps(
    name: str, calmed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = list[int]()
    monkeypatch.setattr(runs, "calmest", lambda curve: asked.append(len(curve.x)) or curve)
    fe_contact.run(Scene.load(name), 0.1)
    assert bool(asked) == calmed
