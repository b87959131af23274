"""Impacts of two deformable bodies, of O-rings and on the half-plane, each against a route of its own.

Two half-spaces and the half-plane: Ting on their exact curves. Bodies of true size, whose surfaces remember alike:
Ting on the curve of a slow indentation, which shares no time step with the march. Different memories: equal bodies of
one nu move alike whatever they are made of, so that Ting with the compliances added is exact there too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

import fe_contact
from fe_contact.budget.certify import MESH_ORDER_ANYWHERE, other_mesh
from fe_contact.budget.plan import plan
from fe_contact.contact.enforcement import exact
from fe_contact.contact.problem import ContactProblem
from fe_contact.fields import felt, peak_step
from fe_contact.reference import solve
from fe_contact.schemes.base import SCHEMES
from fe_contact.steppers.stacked import BodySide, Stacked, stacked
from fe_contact.steppers.steps import Strike
from fe_contact.steppers.struck import Deformable
from fe_contact.studies.compare.study import known
from fe_contact.targets import half_space
from fe_contact.targets.base import struck
from lumped import Material, Relaxation, Result, Scene, Sphere, laws, simulate
from lumped.shapes.cylinder import Cylinder as Roller
from lumped.shapes.punch import Punch
from lumped.targets import HalfSpace
from lumped.targets.cylinder import CylinderTarget
from lumped.targets.o_ring import ORing
from lumped.targets.sphere import SphereTarget as Ball

TOLERANCE, YOUNG = 1e-3, 1e6
IMPACTS = 30


def solid(rng: np.random.Generator, period: float, nu: float | None = None) -> Material:
    """Elastic, or one or two Prony terms that relax within 0.03 to 3 periods."""
    terms = int(rng.integers(3))
    times = tuple(float(t) for t in period * 10.0 ** rng.uniform(-1.5, 0.5, terms))
    young = YOUNG * float(10.0 ** rng.uniform(-0.5, 0.5))
    network = Relaxation(young, tuple(float(m) for m in young * rng.uniform(0.1, 1.5, terms)), times)
    return Material(network, float(rng.uniform(0.0, 0.48)) if nu is None else nu)


def ting(scene: Scene) -> Result:
    return simulate(laws.ting.of(scene), scene, 1e-6)


def random_spheres(seed: int) -> Scene:
    """Two half-spaces under the gap of two spheres, each of a material of its own; every fourth striker is rigid."""
    rng = np.random.default_rng([20261124, seed])
    mass, velocity = 0.005, float(10.0 ** rng.uniform(-2.0, -1.0))
    striker = None if seed % 4 == 3 else solid(rng, 5e-3)
    target = Ball(float(10.0 ** rng.uniform(-2.3, -1.0)), None)
    return Scene(Sphere(0.01), mass, velocity, solid(rng, 5e-3), target=target, striker_material=striker)


def random_half_plane(seed: int) -> Scene:
    """The datum 10 to 300 radii below the first touch."""
    rng = np.random.default_rng([20261125, seed])
    velocity, datum = float(10.0 ** rng.uniform(-2.3, -1.3)), 0.01 * float(10.0 ** rng.uniform(1.0, 2.5))
    return Scene(Roller(0.01, 0.02), 0.02, velocity, solid(rng, 5e-3), target=HalfSpace(datum))


@pytest.mark.parametrize("random_scene", [random_spheres, random_half_plane])
def test_ting_is_within_bar_and_tolerance(
    random_scene: Callable[[int], Scene], campaign_size: Callable[[int], int], agree: Callable[..., None]
) -> None:
    for seed in range(campaign_size(IMPACTS) // 2):
        scene = random_scene(seed)
        agree(fe_contact.run(scene, TOLERANCE), ting(scene))


def random_true_size(seed: int) -> Scene:
    """A rigid striker on a sphere, a cylinder or an O-ring, or equal bodies of two materials of one nu."""
    rng = np.random.default_rng([20261126, seed])
    velocity, radius, nu = float(10.0 ** rng.uniform(-2.0, -1.2)), float(rng.uniform(0.008, 0.03)), 0.4
    support = str(rng.choice(["free", "held"]))
    scenes = (
        (Punch(0.05), 0.05, ORing(radius, 0.003), None),
        (Sphere(0.01), 0.005, Ball(0.01, "free"), solid(rng, 5e-3, nu)),
        (Roller(0.01, 0.02), 0.02, CylinderTarget(0.01, "free"), solid(rng, 5e-3, nu)),
        (Sphere(0.01), 0.005, Ball(radius, support), None),
        (Roller(0.01, 0.02), 0.02, CylinderTarget(radius, support), None),
    )
    shape, mass, target, striker = scenes[seed % len(scenes)]
    return Scene(shape, mass, velocity, solid(rng, 5e-3, nu), target=target, striker_material=striker)


@pytest.mark.tenth
def test_bodies_of_true_size_follow_ting_on_their_own_curve(
    campaign_size: Callable[[int], int], agree: Callable[..., None]
) -> None:
    for seed in range(2 * campaign_size(IMPACTS) // 3):
        scene = random_true_size(seed)
        found = fe_contact.run(scene, TOLERANCE)
        answered, error = known(scene, found.quantities["peak_depth"].value or 0.0)
        agree(found, ting(answered), error)
        assert abs(found.energy["residual"] or 0.0) <= 5e-3 * (found.energy["in"] or 0.0)


FLUID = Material(Relaxation(0.0, (0.9 * YOUNG,), (5e-3,)), 0.4)
LASTING = Material(Relaxation(YOUNG, (0.5 * YOUNG,), (2e-3,)), 0.4)
CREEPING = Material(Relaxation(0.0, (0.9 * YOUNG,), (5e-3,), 200.0), 0.4)


@pytest.mark.parametrize("solid", [False, True])
def test_fluids_that_have_no_time_to_flow_are_planned_as_springs(solid: bool) -> None:
    """Two, or one beside a solid; a slow load would find no force at all."""
    slow = Material(Relaxation(0.0, (YOUNG,), (1e6,)), 0.3)
    spring = Material(Relaxation(YOUNG), 0.3)
    scene = Scene(
        Sphere(0.01), 0.005, 0.05, slow, target=Ball(0.02, "free"), striker_material=spring if solid else slow
    )
    found, elastic = (
        plan(one, {}).numerics for one in (scene, replace(scene, material=spring, striker_material=spring))
    )
    assert found.contact_time == pytest.approx(elastic.contact_time, rel=1e-6)
    assert found.contact_radius == elastic.contact_radius


@pytest.mark.tenth
@pytest.mark.parametrize(
    "scene",
    [
        Scene(Sphere(0.01), 0.005, 0.05, FLUID, target=Ball(0.01, "free"), striker_material=LASTING),
        Scene(Roller(0.01, 0.02), 0.02, 0.05, FLUID, target=CylinderTarget(0.01, "free"), striker_material=FLUID),
        Scene(Sphere(0.01), 0.005, 0.05, CREEPING, target=Ball(0.02, "held")),
    ],
    ids=["a fluid and a solid", "two fluids", "a fluid with a dashpot"],
)
def test_fluids_of_true_size_follow_ting_on_the_curve_of_springs(scene: Scene, agree: Callable[..., None]) -> None:
    found = fe_contact.run(scene, TOLERANCE)
    answered, error = known(scene, found.quantities["peak_depth"].value or 0.0)
    agree(found, ting(answered), error)


@pytest.mark.tenth
def test_two_materials_of_different_nu_agree_with_finer_settings(
    campaign_size: Callable[[int], int], agree: Callable[..., None]
) -> None:
    """No law knows bodies of two shapes that remember differently: the bars must cover what finer settings find."""
    for seed in range(campaign_size(IMPACTS) // 3):
        rng = np.random.default_rng([20261127, seed])
        round_ones = ((Ball(0.017, "held"), Sphere(0.01)), (CylinderTarget(0.017, "held"), Roller(0.01, 0.02)))
        target, shape = round_ones[seed % 2]
        scene = Scene(shape, 0.01, 0.05, solid(rng, 5e-3), target=target, striker_material=solid(rng, 5e-3))
        finer = {"elements_per_contact": 3.3, "penalty": 4e3, "steps": 80, "tolerance": 0.1}
        agree(fe_contact.run(scene, TOLERANCE), fe_contact.run(scene, numerics=finer))


def test_the_datum_lies_in_the_mesh_however_near_that_ends(uncovered: Callable[..., dict[str, float]]) -> None:
    scene = Scene.load("polymer-half-plane")
    found = fe_contact.run(scene, numerics={"far_radius": 2.0})
    assert not uncovered(found, simulate(laws.ting.of(scene), scene, 1e-6))


@pytest.mark.family
@pytest.mark.parametrize("order", [3, 4])
@pytest.mark.parametrize("shape", [Roller(0.01, 0.02), Sphere(0.01)])
def test_half_as_many_elements_tell_what_the_rim_of_a_support_adds(shape: Roller | Sphere, order: int) -> None:
    """There stresses have no bound, least of all those of a nearly incompressible body. A fiftieth of the tolerance
    is left to the other bars.
    """
    target = Ball(0.015, "held") if isinstance(shape, Sphere) else CylinderTarget(0.015, "held")
    scene = Scene(shape, 0.02, 0.05, Material(Relaxation(YOUNG), 0.49), target=target)
    numerics = plan(scene, {"order": order, "elements_per_contact": 2.0, "tolerance": TOLERANCE}).numerics
    half, trusted = other_mesh(numerics, MESH_ORDER_ANYWHERE)
    found = []
    for settings in (half, numerics, numerics.varied(order=4, elements_per_contact=4.0)):
        surface = struck(scene.geometry, settings)
        assert isinstance(surface, Deformable)
        found.append(work(surface, 0.25 * numerics.contact_radius / target.radius))
    coarse, own, fine = found
    assert abs(own - fine) <= trusted * abs(own - coarse) + TOLERANCE / 50 * fine


def work(surface: Deformable, width: float) -> float:
    """Of a smooth pressure over about such an angle, on the displacement that it causes, over its force squared."""
    operator = surface.operator
    pressure = operator.weights * np.exp(-((operator.points / width) ** 2))
    load = operator.trace.T @ pressure
    return float(load @ operator.response[: load.size] @ load) / float(pressure.sum()) ** 2


@pytest.mark.tenth
def test_action_is_reaction(uncovered: Callable[..., dict[str, float]]) -> None:
    """The smaller body struck by the larger one, both free: only the names change."""
    soft, stiff = Material(Relaxation(YOUNG, (YOUNG,), (3e-3,)), 0.3), Material(Relaxation(3.0 * YOUNG), 0.45)
    there = Scene(Sphere(0.01), 0.005, 0.05, soft, target=Ball(0.02, "free"), striker_material=stiff)
    back = replace(there, shape=Sphere(0.02), material=stiff, target=Ball(0.01, "free"), striker_material=soft)
    settings = {"tolerance": 3.0 * TOLERANCE, "steps": 40}
    first, second = (fe_contact.run(scene, numerics=settings) for scene in (there, back))
    assert not uncovered(first, second)
    assert first.work["factorizations"] == 4, "two bodies on two meshes each, whatever the steps"


@pytest.mark.tenth
def test_the_pressure_between_meshes_that_do_not_match_is_smooth() -> None:
    """Nylon and rubber: Hertz's half ellipse of the same force and width, to two per cent of its peak but at its edge.

    Points that two meshes share pin a facet more often than either can follow: between them the pressure jumps by a
    tenth, and only its moments against hats are known.
    """
    scene = Scene.load("two-cylinders")
    certified = solve(scene, {"tolerance": 5e-3}).certified
    pressure, snapshot = felt(certified, peak_step(certified)), certified.march.snapshots[peak_step(certified)]
    half_width = pressure.contact_radius
    inside = pressure.radii < 0.85 * half_width
    length = 0.05
    ellipse = np.sqrt(1.0 - (pressure.radii[inside] / half_width) ** 2)
    peak = 2.0 * snapshot.force / (np.pi * half_width * length)
    assert np.abs(pressure.values[inside] / peak - ellipse).max() < 0.02


@pytest.mark.family
@pytest.mark.parametrize("name", ["two-finite-spheres", "two-cylinders"])
def test_bodies_kept_apart_exactly_press_alike(name: str) -> None:
    """Where moduli differ fivefold, what is solved at the nodes of both is what springs at the points find.

    So it is of one body under a rigid one, whose pressure is made of all its shape functions. Of a sphere two meshes
    agree there by chance in the duration.
    """
    two = Scene.load(name, {"striker.material.E": 5e6})
    under_rigid = replace(two, striker_material=None)
    for scene in (two, under_rigid) if name == "two-cylinders" else (under_rigid,):
        one, other = (fe_contact.run(scene, 1e-2, numerics={"enforcement": kind}) for kind in ("corrected", "exact"))
        for quantity in ("peak_force", "peak_depth", "duration"):
            first, second = one.quantities[quantity], other.quantities[quantity]
            assert first.value == pytest.approx(second.value, abs=(first.error or 0.0) + (second.error or 0.0))


@pytest.mark.tenth
@pytest.mark.parametrize(
    "pace", [pytest.param(1e-6, id="relaxed"), pytest.param(1e6, id="instantaneous", marks=pytest.mark.full)]
)
def test_two_bodies_of_constant_bulk_modulus_tend_to_elastic_ones(pace: float, agree: Callable[..., None]) -> None:
    """Relaxation far faster or far slower than the contact: elastic bodies of the moduli at that end."""
    contact_time = 0.02
    soft = Material(Relaxation(YOUNG, (YOUNG,), (pace * contact_time,)), 0.3, constant="bulk")
    target, settings = CylinderTarget(0.015, "held"), {"tolerance": 0.1, "steps": 20}
    found = [
        fe_contact.run(
            Scene(Roller(0.01, 0.02), 0.02, 0.05, material, target=target, striker_material=material), numerics=settings
        )
        for material in (soft, soft.elastic(instant=pace > 1.0))
    ]
    agree(*found)


@pytest.mark.parametrize("sides", [1, 2])
def test_what_two_bodies_feel_is_read_where_they_can_follow_it(sides: int) -> None:
    """A pressure that runs evenly over the angles: at the nodes of one mesh, at the corners where two have to agree."""
    operator = half_space._whole(0.3, 4.0, 4, 20.0).operator
    body, anything = 0.05, cast("Any", None)
    places, pressure = Stacked(operator, (anything,) * sides, body).felt(
        cast("Any", SimpleNamespace(pressure=2.0 - operator.points))
    )
    angles = operator.corners if sides == 2 else operator.nodes[: operator.trace.shape[1]]
    np.testing.assert_allclose(places, body * np.sin(angles), rtol=1e-12)
    np.testing.assert_allclose(pressure, 2.0 - angles, rtol=1e-8)


def test_what_presses_one_body_is_found_again_at_every_node_of_it() -> None:
    """From the overlap that it causes, kept out exactly: a pressure as rough as the body's own shape functions."""
    operator = half_space._whole(0.3, 4.0, 4, 20.0).operator
    surface = stacked(operator, (BodySide(operator, Relaxation(1.0), operator.trace),), (1.0,))
    nodal = 1.5 + np.random.default_rng(13).uniform(-1.0, 1.0, operator.trace.shape[1])
    pressure = operator.trace @ nodal
    moved = operator.trace @ np.linalg.solve(surface.stiffness, operator.trace.T @ (operator.weights * pressure))
    found = exact.enforce(ContactProblem(surface, moved, np.inf, 0.0), np.ones(pressure.size, dtype=bool))
    assert pressure.min() > 0.0
    np.testing.assert_allclose(found.pressure, pressure, rtol=1e-6)


def test_a_lone_body_yields_as_it_was_meshed() -> None:
    """A half-space of E* = 1 under Hertz's pressure sinks in by pi/4 (2 - r^2), but for its coarse mesh."""
    operator = half_space._whole(0.3, 2.0, 3, 5.0).operator
    surface = stacked(operator, (BodySide(operator, Relaxation(1.0), operator.trace),), (1.0,))
    inside = operator.points < 1.0
    moved = surface.displaced(operator.weights * np.sqrt(np.maximum(1.0 - operator.points**2, 0.0)))
    np.testing.assert_allclose(moved[inside], 0.25 * np.pi * (2.0 - operator.points[inside] ** 2), rtol=2e-3)


def test_what_presses_two_bodies_moves_each_by_its_own_modulus() -> None:
    """Of one shape they yield as one body whose compliance is the sum; kept out exactly, the pressure returns."""
    operator = half_space._whole(0.3, 4.0, 4, 20.0).operator
    side = BodySide(operator, Relaxation(1.0), operator.trace)
    one, two = stacked(operator, (side,), (1.0,)), stacked(operator, (side, side), (1.25, 5.0))
    assert two.carriers is not None
    pressure = two.carriers @ (1.5 + np.random.default_rng(13).uniform(-1.0, 1.0, two.carriers.shape[1]))
    moved = two.displaced(operator.weights * pressure)
    np.testing.assert_allclose(moved, one.displaced(operator.weights * pressure), rtol=1e-9)
    found = exact.enforce(ContactProblem(two, moved, np.inf, 0.0), np.ones(pressure.size, dtype=bool))
    np.testing.assert_allclose(found.pressure, pressure, rtol=1e-6)


def test_two_bodies_together_sink_in_by_what_each_does() -> None:
    """Of moduli 5/4 and 5, in series 1, in one step by the pressure at its end: as one body of that modulus."""
    operator = half_space._whole(0.3, 4.0, 4, 20.0).operator
    sides = tuple(BodySide(operator, Relaxation(young), operator.trace) for young in (1.25, 5.0))
    body = Stacked(operator, sides, 0.05).body(Relaxation(1.0), SCHEMES.get("backward_euler"), 1.0)
    pressure = 2.0 - operator.points
    offer = body.offer(body.at_rest(), 1e-3)
    found, _ = body.after(body.at_rest(), offer, pressure)
    alone = stacked(operator, (BodySide(operator, Relaxation(1.0), operator.trace),), (1.0,))
    met, known = offer.surface.displaced(operator.weights), alone.displaced(operator.weights)
    np.testing.assert_allclose(met, known, rtol=1e-9)
    np.testing.assert_allclose(body.displacement(found), alone.displaced(operator.weights * pressure), rtol=1e-9)


@pytest.mark.parametrize(("length", "instant"), [(1e-7, True), (1.0, False)])
def test_a_body_of_constant_bulk_modulus_meets_a_step_with_the_stiffness_of_its_length(
    length: float, instant: bool
) -> None:
    """Far shorter or longer than it relaxes: that of an elastic body of the moduli at that end, of another nu each."""
    soft = Material(Relaxation(YOUNG, (YOUNG,), (1e-3,)), 0.3, constant="bulk")
    compliances = []
    for material in (soft, soft.elastic(instant=instant)):
        scene = Scene(Roller(0.01, 0.02), 0.02, 0.05, material, target=CylinderTarget(0.015, "held"))
        numerics = replace(plan(scene, {"elements_per_contact": 2.0}).numerics, contact_time=1e-2, contact_radius=2e-3)
        body = cast("Deformable", struck(scene.geometry, numerics)).body(
            scene.contact_modulus, SCHEMES.get("backward_euler"), 0.015
        )
        offer = body.offer(body.at_rest(), length)
        compliances.append(offer.surface.displaced(np.ones_like(offer.past)) / offer.now)
    np.testing.assert_allclose(compliances[0], compliances[1], rtol=2e-3)


def bends(*radii: float) -> float:
    return sum(1.0 / radius for radius in radii)


@pytest.mark.parametrize(
    ("name", "bend"),
    [
        ("steel-ball", lambda scene: bends(scene.shape.radius)),
        ("two-spheres", lambda scene: bends(scene.shape.radius, scene.target.radius)),
        ("polymer-half-plane", lambda scene: bends(scene.shape.radius)),
        ("polymer-o-ring", lambda scene: 2.0 * bends(scene.target.section_radius)),  # pressed on both sides
        ("rod-in-ring", lambda scene: bends(scene.shape.radius, -scene.target.inner_radius)),
    ],
)
def test_surfaces_part_from_the_first_touch_on_by_how_they_bend(name: str, bend: Callable[[Any], float]) -> None:
    """By half the square of the way along them, in any depth; on a flat surface one depth moves every place alike."""
    scene = Scene.load(name)
    strike, curvature = Strike.of(scene), bend(scene)
    arc = np.array([1e-4, 1e-3]) / curvature
    np.testing.assert_allclose(strike.height(arc), 0.5 * curvature * arc**2, rtol=1e-3)
    assert (strike.overlap is None) == (name != "rod-in-ring")
    if strike.overlap is not None:
        depth = 1e-7 / curvature
        np.testing.assert_allclose(strike.overlap(arc, depth), depth - strike.height(arc), rtol=1e-3)


@pytest.mark.parametrize("name", ["steel-ball", "polymer-cone", "polymer-power", "polymer-half-plane", "polymer-punch"])
def test_an_elastic_force_begins_with_the_power_that_its_exact_curve_has(name: str) -> None:
    """In plane strain but for a logarithm."""
    scene = Scene.load(name)
    depth = scene.shape.tip_radius or 1e-2
    first, second = scene.geometry.target.load_curve(scene.profile, 0.3).force(1e-9 * depth * np.array([1.0, 2.0]))
    assert Strike.of(scene).power == pytest.approx(np.log2(second / first), abs=0.06)
