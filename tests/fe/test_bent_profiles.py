"""Strikers whose face bends, by finite elements: against Ting's exact answer on their closed load curves, and on
layers, whose curve is an integral equation's, also against a finer run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import fe_contact
from fe_contact import reference
from fe_contact.indentation import indent
from lumped import Scene, laws, simulate
from lumped.materials import Material, Relaxation
from lumped.scene.indenter import Indenter
from lumped.scene.tables import Model
from lumped.shapes import Shape, Sphere
from lumped.shapes.profile import Profile
from lumped.shapes.rounded_punch import RoundedPunch
from lumped.shapes.sphere_cone import SphereCone
from lumped.targets import HalfSpace
from lumped.targets.layer import Layer

RULED = ("peak_force", "peak_depth", "duration", "impulse", "restitution")


def sphere_cone(random: np.random.Generator, width: float) -> Shape:
    """The sphere's circle within the contact or beside it, width in m."""
    angle = float(random.uniform(3.0, 35.0))
    return SphereCone(width * float(10.0 ** random.uniform(-1.0, 0.3)) / np.sin(np.radians(angle)), angle)


def rounded_punch(random: np.random.Generator, width: float) -> Shape:
    """A flat from a tenth of the contact to nearly all of it."""
    return RoundedPunch(width * float(random.uniform(0.1, 1.5)), width * float(10.0 ** random.uniform(-0.5, 1.5)))


def narrow_edge(random: np.random.Generator, width: float) -> Shape:
    """All depths end their contacts close beside one radius, under a pressure that is nearly infinite there."""
    return RoundedPunch(width, width * float(10.0 ** random.uniform(-2.0, -0.5)))


def profile(random: np.random.Generator, width: float) -> Shape:
    """Random bends at random radii, the last of them far beyond the contact."""
    r = np.append(0.0, np.cumsum(random.uniform(0.1, 0.4, 24))) * width
    bends = random.uniform(0.2, 1.0, 24)
    height = np.append(0.0, np.cumsum(0.02 * np.cumsum(bends) * np.diff(r)))
    return Profile(tuple(r.tolist()), tuple(height.tolist()))


@pytest.mark.family
@pytest.mark.parametrize("make", [rounded_punch, sphere_cone, profile])
def test_impacts_lie_within_their_bars(
    make: Callable[[np.random.Generator, float], Shape], campaign_size: Callable[[int], int]
) -> None:
    random, base = np.random.default_rng(1999), Scene.load("polymer-sphere")
    width = base.profile.hertz_impact(base.contact_modulus.glassy, base.mass, base.velocity).contact_radius
    assert isinstance(base.profile, Sphere)
    for _ in range(campaign_size(30)):
        scene = replace(base, shape=make(random, width), velocity=0.02 * float(10.0 ** random.uniform(-0.5, 0.3)))
        tolerance = float(random.choice([1e-2, 1e-3]))
        found, exact = fe_contact.run(scene, tolerance=tolerance), simulate(laws.get("ting").of(scene), scene, 1e-6)
        assert found.converged, scene
        for name in RULED:
            bar, truth = found.quantities[name], exact.quantities[name]
            assert abs((bar.value or 0.0) - (truth.value or 0.0)) <= (bar.error or 0.0) + (truth.error or 0.0), (
                name,
                scene,
            )


@pytest.mark.family
@pytest.mark.parametrize(
    "make", [sphere_cone, *(pytest.param(one, marks=pytest.mark.full) for one in (rounded_punch, profile))]
)
def test_impacts_on_a_layer_lie_within_their_bars(
    make: Callable[[np.random.Generator, float], Shape],
    campaign_size: Callable[[int], int],
    uncovered: Callable[..., dict[str, float]],
) -> None:
    """Layers from one to ten contacts thick; the exact law shares no mesh, and a finer run no mesh and no time step."""
    random, base = np.random.default_rng(1959), Scene.load("polymer-layer")
    width = base.profile.hertz_impact(base.contact_modulus.glassy, base.mass, base.velocity).contact_radius
    for _ in range(campaign_size(10)):
        target = Layer(width * float(10.0 ** random.uniform(0.0, 1.0)), str(random.choice(["bonded", "sliding"])))
        speed = 0.02 * float(10.0 ** random.uniform(-0.5, 0.0))
        scene = replace(base, shape=make(random, 0.7 * width), target=target, velocity=speed)
        tolerance = float(random.choice([1e-2, 3e-3]))
        found, finer = (fe_contact.run(scene, tolerance=share * tolerance) for share in (1.0, 0.25))
        exact = simulate(laws.get("ting").of(scene), scene, 1e-6)
        assert found.converged, scene
        assert finer.converged, scene
        for other in (exact, finer):
            assert not uncovered(found, other, RULED), scene


@pytest.mark.parametrize("kinematics", ["small", "finite"])
@pytest.mark.parametrize("target", [HalfSpace(), Layer(2.0, "bonded"), Layer(0.7, "sliding")])
def test_a_flat_end_with_a_narrow_edge_is_pressed_within_its_bars(
    target: HalfSpace | Layer, kinematics: str, campaign_size: Callable[[int], int]
) -> None:
    """Against the closed curve and the integral equation's, from which large strains depart by the depth at most."""
    random, depths = np.random.default_rng(1999), (3e-4, 1e-3)
    for _ in range(campaign_size(4)):
        material = Material(Relaxation(1e6), float(random.uniform(0.2, 0.49)))
        pressed = Indenter(narrow_edge(random, 1.0), material, target, model=Model(kinematics=kinematics))
        tolerance = float(random.choice([3e-2, 1e-2, 3e-3]))
        found = indent(pressed, depths, {"tolerance": tolerance})
        curve = target.load_curve(pressed.profile, material.nu)
        known = pressed.modulus(False) * curve.force(np.array(depths))
        departs = known * np.array(depths) if kinematics == "finite" else 0.0
        assert found.converged, pressed
        assert np.all(np.abs(found.force - known) <= found.force_error + departs), (pressed, tolerance)


@pytest.mark.parametrize(
    ("edge", "nu", "given"),
    [
        (1e-5, -0.9, {"tolerance": 1e-3, "enforcement": "augmented"}),
        (3e-3, -0.9, {"tolerance": 0.1, "elements_per_contact": 6.0, "penalty": 1e5}),
        (3e-3, 0.45, {"tolerance": 0.1, "elements_per_contact": 6.0, "penalty": 1e5}),
    ],
)
def test_an_edge_too_narrow_to_be_resolved_has_the_bar_of_a_rim(
    edge: float, nu: float, given: dict[str, float | str]
) -> None:
    """Where contact ends beside a flat end the pressure grows nearly without end: meshes err by their size there."""
    depth = 1e-4 if edge == 1e-5 else 1e-2
    indenter = Indenter(RoundedPunch(1.0, edge), Material(Relaxation(1.0), nu))
    pressed = indent(indenter, (depth,), given)
    curve = indenter.target.load_curve(indenter.profile, nu)
    exact = indenter.modulus(False) * float(curve.force(depth))
    assert abs(pressed.force[0] - exact) <= pressed.force_error[0]


def strained_much(edge: float, target: HalfSpace | Layer) -> Scene:
    """Something that relaxes struck by a flat end of radius 2 mm with this edge, m."""
    base = Scene.load("polymer-sphere")
    return replace(base, shape=RoundedPunch(2e-3, edge), target=target, model=replace(base.model, kinematics="finite"))


@pytest.mark.tenth
@pytest.mark.parametrize("target", [HalfSpace(), Layer(0.01, "bonded")])
def test_a_relaxing_impact_by_a_narrow_edge_takes_few_iterations_a_step(target: HalfSpace | Layer) -> None:
    """Its contact hardly widens, and is begun so: on the whole body every iteration is dear."""
    found = fe_contact.run(strained_much(3e-4, target), tolerance=3e-2)
    assert found.converged
    assert found.work["iterations"] <= 4 * found.work["contact_problems"]


@pytest.mark.parametrize("base", ["bonded", "sliding"])
@pytest.mark.parametrize("thickness", [1.4e-4, 2e-4, 4e-4, 2e-3])
def test_under_a_rounded_end_a_mesh_is_made_for_no_wider_a_contact_than_is_expected(
    thickness: float, base: str
) -> None:
    """On thin layers too; it ends between those of elastic layers, as stiff as at once and as in the end."""
    scene = strained_much(2e-5, Layer(thickness, base))
    curve = scene.geometry.target.load_curve(scene.shape, scene.geometry.material.nu)
    depths, brought = np.linspace(0.0, 0.2 * thickness, 400), 0.5 * scene.reduced_mass * scene.velocity**2
    sudden, slow = scene.contact_modulus.glassy, scene.contact_modulus.relaxed
    deepest = [np.interp(brought / modulus, curve.energy(depths), depths) for modulus in (sudden, slow)]
    planned = reference.plan(scene, {}).numerics.contact_radius
    least, most = curve.contact_radius(deepest) - 2e-3
    assert least < planned - 2e-3 < most


@pytest.mark.tenth
def test_a_relaxing_layer_under_a_narrow_edge_has_true_bars(uncovered: Callable[..., dict[str, float]]) -> None:
    """On meshes made for much wider contacts, all that tell the bar err alike beside the rim."""
    scene = strained_much(1e-5, Layer(0.01, "bonded"))
    loose = fe_contact.run(scene, tolerance=1e-2)
    tight = fe_contact.run(scene, tolerance=3e-3, numerics={"elements_per_contact": 4.0, "penalty": 4000.0})
    assert loose.converged
    assert tight.converged
    assert not uncovered(loose, tight)
