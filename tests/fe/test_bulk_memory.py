"""Bodies whose bulk remembers: against direct solves, the Laplace domain, exact columns, and limits."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import scipy.sparse.linalg as linalg
from skfem import Basis

import fe_contact
import meshes
from fe_contact.assembly.cache import Recipe
from fe_contact.assembly.forms import elastic, stiffness
from fe_contact.assembly.operators import ElasticBody, element, moduli, operator_of
from fe_contact.assembly.surface import flat
from fe_contact.bodies.bulk_memory import BulkBody, BulkMemory, Moduli
from fe_contact.bodies.modes import Pencil, modes, poisson
from fe_contact.bodies.pressing import held
from fe_contact.budget.curve import Curve
from fe_contact.budget.plan import plan
from fe_contact.errors import RatioNotKnown
from fe_contact.march.impact import march, step_length
from fe_contact.schemes.base import SCHEMES, MemoryScheme
from fe_contact.steppers.bulk_surface import Pace
from fe_contact.steppers.steps import Strike
from fe_contact.targets import _round, layer, o_ring, ring, washer
from fe_contact.targets.base import TARGETS, struck
from lumped import BadInput, Material, Relaxation, Scene, laws, simulate
from lumped.materials.laplace import inverse
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.targets.layer import Layer
from lumped.targets.plane import Plane
from lumped.targets.washer import Washer

backward_euler, galerkin = SCHEMES.get("backward_euler"), SCHEMES.get("galerkin")

BULK = {"target.material.constant": "bulk"}
SIZES = (3.0, 1.0, 3.0, (0.3, 0.0, 1.0))  # a coarse layer as thick as its contact is wide
BODIES: dict[str, Recipe[ElasticBody]] = {
    "bonded": layer._body.recipe(SIZES, 3, True, False),
    "sliding": layer._body.recipe(SIZES, 3, False, False),
    "line": layer._body.recipe(SIZES, 3, True, True),
    "ring": ring._body.recipe(3.0, 3, 0.3, 1.0, 0.6),
    "washer": washer._body.recipe(1.0, 2, 1.0, 2.0, 1.7, True),
    "o-ring": o_ring._body.recipe(3.0, 3, 0.3, 0.5, 3.0),
    "free sphere": _round._meshed.recipe(3.0, 3, 0.3, 0.5, False, False),
    "held cylinder": _round._meshed.recipe(3.0, 3, 0.3, 0.5, True, True),
}
K, G = Relaxation(2.0), Relaxation(0.2, (0.5, 0.9), (0.07, 0.6), 0.02)


@pytest.mark.family
@pytest.mark.parametrize("name", BODIES)
def test_the_modes_have_the_compliance_at_every_ratio(name: str) -> None:
    body, rng = BODIES[name], np.random.default_rng(20261122)
    narrow, wide = modes(body, 0.02, 2.0), modes(body, 0.02, 1e4)
    for ratio in [0.02, 2.0, 30.0, 300.0, 1e4, *(10.0 ** rng.uniform(np.log10(0.02), np.log10(2.0), 4))]:
        found = narrow if ratio <= 2.0 else wide
        operator = operator_of(body, poisson(ratio))
        direct = operator.response[: len(operator.stiffness)]
        error = np.linalg.norm(found.compliance(*moduli(operator.poisson)) - direct, 2) / np.linalg.norm(direct, 2)
        assert error < 3e-7


@pytest.mark.parametrize("name", ["bonded", "ring"])
def test_a_ratio_far_outside_the_interval_is_refused(name: str) -> None:
    """Up to where it is not, the compliance is good to a few 1e-5."""
    body, low, high = BODIES[name], 0.1, 0.15
    found = modes(body, low, high)
    for ratio in (low / 1.5, low / 2.9, 1.5 * high, 2.9 * high):
        operator = operator_of(body, poisson(ratio))
        direct = operator.response[: len(operator.stiffness)]
        change = np.linalg.norm(np.linalg.inv(found.stiffness(ratio)) - direct, 2) / np.linalg.norm(direct, 2)
        assert change < 3e-5
    for ratio, cure in ((low / 3.1, "an earlier motion.end_time, or more"), (3.1 * high, "another .*, or fewer")):
        with pytest.raises(RatioNotKnown, match=rf"known from 0\.1 to 0\.15; cure: {cure} numerics\.steps"):
            found.stiffness(ratio)
    stiffer, stiff = (modes(body, 0.1, 2e3).stiffness(ratio) for ratio in (1e9, 1e6))  # volume bends no more there
    assert np.linalg.norm(stiffer - stiff) < 1e-4 * np.linalg.norm(stiff)


@pytest.mark.parametrize(("low", "high"), [(0.05, 0.5), (0.02, 20.0), (0.3, 0.31)])
def test_the_stiffness_between_the_tabulated_ratios_is_exact_to_1e_10_and_none_of_them_lies_elsewhere(
    low: float, high: float
) -> None:
    """Against the inverse of the compliance there. Ratios closer than a factor of 1.8 are tabulated over that."""
    found = modes(BODIES["bonded"], low, high)
    places, _ = found._table
    middle, half = 0.5 * np.log(high * low), max(0.5 * np.log(high / low), 0.3)
    assert places[[0, -1]] == pytest.approx([middle - half, middle + half], abs=1e-12)
    assert np.all(np.diff(places) > 0.0)
    for ratio in np.exp(np.random.default_rng(8).uniform(places[0], places[-1], 10)):
        direct = np.linalg.inv(found.compliance(*moduli(poisson(ratio))))
        assert np.linalg.norm(found.stiffness(ratio) - direct) < 1e-10 * np.linalg.norm(direct)


@pytest.mark.family
@pytest.mark.parametrize(("steps", "share"), [(40, 0.5), (1024, 0.5), (8192, 0.5), (1024, 0.1), (160, 0.01)])
def test_the_ratios_of_a_dashpot_are_known_from_the_first_step_on(steps: int, share: float) -> None:
    """Which is the shorter the more there are, and its ratio the larger: far beyond what the network itself has."""
    scene = Scene.load("polymer-layer")
    chosen = plan(scene, {"elements_per_contact": 2.0}).numerics
    slow = Relaxation(1e6, viscosity=1e6 * 1e-6 * chosen.contact_time)
    scene = replace(scene, material=Material(slow, 0.45, constant="bulk"))
    numerics = chosen.varied(steps=steps, peak_share=share)
    stepper = struck(scene.geometry, numerics).stepper(Strike.of(scene), numerics, ())
    first = step_length(0, steps, share)
    assert stepper.step(stepper.touch(), (), first * numerics.contact_time).force > 0.0
    assert min(1e-6, first / 30.0) <= Pace.of(numerics).shortest <= 1.2 * first, "and not from far before it on"


@pytest.mark.parametrize(("steps", "share"), [(40, 0.5), (1024, 0.5), (8192, 0.5), (4096, 0.2), (1024, 0.1)])
def test_the_shortest_step_is_a_decade_below_the_first_and_no_longer_than_a_millionth(steps: int, share: float) -> None:
    """Within one of it, so that the motions of a body are those of other runs too."""
    chosen = plan(Scene.load("polymer-layer"), {"elements_per_contact": 2.0}).numerics
    pace, first = Pace.of(chosen.varied(steps=steps, peak_share=share)), step_length(0, steps, share)
    assert (pace.scheme, pace.contact_time) == (chosen.scheme, chosen.contact_time)
    assert np.log10(pace.shortest) == pytest.approx(round(np.log10(pace.shortest)), abs=1e-9)
    assert min(1e-6, first / 15.0) <= pace.shortest <= min(1e-6 * (1.0 + 1e-9), 1.2 * first)


@pytest.mark.parametrize("steps", [20, 200])
def test_the_ratios_of_a_fluid_are_known_from_a_millionth_of_a_contact_to_fifty_of_them(steps: int) -> None:
    """It is the softer the longer a step is, as the last ones of a long motion in few steps are, and the first ones of
    many, or one that an end cuts. By hand: of a branch that strains evenly the mean of what is left of it.
    """
    numerics = plan(Scene.load("polymer-layer"), {"elements_per_contact": 2.0, "scheme": "backward_euler"}).numerics
    times = (2e-7 * numerics.contact_time, numerics.contact_time)
    shear = Relaxation(0.0, (4e5, 1e5), times)
    low, high = Pace.of(numerics.varied(steps=steps)).ratios(Moduli(Relaxation(1e9), shear))
    for length in (1e-6, 0.3, 50.0):
        over = length * numerics.contact_time / np.array(times)
        ratio = np.array([4e5, 1e5]) @ ((1.0 - np.exp(-over)) / over) / 1e9
        assert 0.999 * low <= ratio <= 1.001 * high


def test_more_ratios_make_the_modes_better_by_orders(monkeypatch: pytest.MonkeyPatch) -> None:
    body = BODIES["bonded"]
    operator = operator_of(body, poisson(0.2))
    direct = operator.response[: len(operator.stiffness)]
    errors = []
    for fewest in (1, 2, 3):
        monkeypatch.setattr("fe_contact.bodies.modes.FEWEST", fewest)
        monkeypatch.setattr("fe_contact.bodies.modes.PER_E_FOLD", 0.0)
        found = modes.__wrapped__(body, 0.05, 0.5).compliance(*moduli(operator.poisson))
        errors.append(np.linalg.norm(found - direct, 2))
    assert errors[0] > 30 * errors[1] > 900 * errors[2]


def ramped(body: BulkBody, steps: int, end: float, pressure: np.ndarray) -> tuple[np.ndarray, float, list[BulkMemory]]:
    """Amplitudes under a pressure that grows with time, steps growing too; work done on the unit mesh; memories."""
    ends = end * (np.arange(steps + 1) / steps) ** 1.5
    operator = body.modes.operator
    memories, work = [body.at_rest()], 0.0
    for before, after in pairwise(ends):
        now = 0.5 * (before + after) * pressure if body.scheme is galerkin else after * pressure
        offer = body.offer(memories[-1], after - before)
        memory, _ = body.after(memories[-1], offer, now)
        load = operator.trace.T @ (operator.weights * now)
        change = memory.shear.strain[0] - memories[-1].shear.strain[0]
        work += float(load @ (body.modes.shape @ change))
        memories.append(memory)
    return memories[-1].shear.strain[0], work, memories


@pytest.mark.parametrize("name", BODIES)
def test_the_march_converges_to_the_laplace_domain(name: str) -> None:
    """The whole mesh at complex moduli, without modes and time steps; order two, and one where that is asked."""
    body, end = BODIES[name].follow(), 0.5
    found = modes(BODIES[name], 0.05, 5.0)
    operator = found.operator
    pressure = np.where(operator.points < np.median(operator.points), 1.0, 0.0)
    load = operator.trace.T @ (operator.weights * pressure)
    loose = np.setdiff1d(np.arange(2 * body.basis.N), body.fixed)
    down = np.zeros(2 * body.basis.N)
    down[2 * body.surface.dofs[: load.size] + 1] = -load
    centred = np.zeros_like(down) if body.floating is None else body.floating.mass / body.floating.mass.sum()
    down = down if body.floating is None else body.floating.balanced(down)
    parts = [body.stiffness(*pair).tocsc()[loose][:, loose] for pair in ((1.0, 0.0), (0.0, 1.0))]
    watched = int(np.searchsorted(loose, 2 * body.surface.dofs[0] + 1))

    def sinking(s: complex) -> complex:
        matrix = complex(K.operational(s)) * parts[0] + complex(G.operational(s)) * parts[1]
        moved = linalg.spsolve(matrix, down[loose].astype(complex))
        return complex((centred[loose] @ moved - moved[watched]) / s**2)

    exact = inverse(np.vectorize(sinking), [end]).value[0]
    for scheme, order in ((galerkin, 2), (backward_euler, 1)):
        answers = [ramped(BulkBody(found, Moduli(K, G), scheme, 1.0), n, end, pressure)[0] for n in (24, 48)]
        errors = [abs(float(found.shape[0] @ answer) / exact - 1.0) for answer in answers]
        assert errors[1] < {2: 1e-4, 1: 2e-2}[order]
        assert errors[0] > 0.85 * 2**order * errors[1]


def column() -> ElasticBody:
    """A plate whose sides may not move: uniaxial strain."""
    basis = Basis(meshes.layer(3.0, 0.5, 0.7, 0.4), element(2), intorder=4)
    fixed = held(basis, along=("axis", "side"), across=("base",))
    whole = replace(flat(basis), zone=np.inf)
    return ElasticBody(basis, lambda bulk, shear: stiffness(basis, elastic(bulk, shear)), fixed, whole)


def test_a_confined_column_creeps_with_the_modulus_of_the_pressure_wave() -> None:
    end, height = 0.5, 0.7
    found = modes(Recipe(column, ()), 0.05, 5.0)
    pressed = np.ones_like(found.operator.points)
    wave = replace(G.scaled(4.0 / 3.0), equilibrium=4.0 / 3.0 * G.equilibrium + K.equilibrium)
    creep = wave.creep()
    times, weights = np.array(creep.times), np.array(creep.compliances)
    lag = times * np.expm1(-end / times)
    exact = height * (creep.instantaneous * end + float(weights @ (end + lag)))
    errors = []
    for steps in (24, 48):
        amplitude, _, _ = ramped(BulkBody(found, Moduli(K, G), galerkin, 1.0), steps, end, pressed)
        sunk = found.shape @ amplitude
        np.testing.assert_allclose(sunk, sunk[0], rtol=1e-7)
        errors.append(abs(float(sunk[0]) / exact - 1.0))
    assert errors[1] < 1e-4
    assert errors[0] > 3.4 * errors[1]


@pytest.mark.parametrize("scheme", [galerkin, backward_euler])
@pytest.mark.parametrize("name", BODIES)
def test_work_is_stored_or_heat_or_lost_by_the_scheme(name: str, scheme: MemoryScheme) -> None:
    """To rounding, whatever the step: displacement is linear and pressure constant over it."""
    found = modes(BODIES[name], 0.05, 5.0)
    body = BulkBody(found, Moduli(replace(K, moduli=(0.3,), times=(0.1,)), G), scheme, 1.0)
    points = found.operator.points
    _, work, memories = ramped(body, 7, 0.5, np.where(points < np.median(points), 1.0, 0.0))
    lengths = 0.5 * np.diff((np.arange(8) / 7) ** 1.5)
    steps = list(zip(pairwise(memories), lengths, strict=True))
    heat, lost = np.sum([body.heat_and_loss(*pair, dt) for pair, dt in steps], axis=0)
    assert body.stored(memories[-1]) > 0.0
    assert heat > 0.1 * work
    assert (lost > 1e-3 * work) == (scheme is backward_euler)
    assert body.stored(memories[-1]) + heat + lost == pytest.approx(work, rel=1e-9)


def alike(material: Material, length: float) -> Moduli:
    """Bulk and shear modulus on one network: the Poisson's ratio stays."""
    return Moduli(material.young.scaled(length / (3.0 * (1.0 - 2.0 * material.nu))), material.shear.scaled(length))


def of_bulk(material: Material | None) -> Material | None:
    return None if material is None else replace(material, constant="bulk")


SOLID = Relaxation(1.2e6, (0.6e6, 0.9e6), (1e-3, 2e-2))


@pytest.mark.family
@pytest.mark.parametrize("name", ["polymer-layer", "rod-in-ring", "polymer-o-ring", "two-cylinders"])
def test_where_both_moduli_relax_alike_the_surface_alone_remembers(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Constant Poisson's ratio, by the bulk and by the surface: the same history."""
    scene = Scene.load(name)
    if scene.striker_material is not None:  # two bodies that remember differently
        scene = replace(scene, striker_material=Material(SOLID, 0.3))
    numerics, geometry = plan(scene, {"elements_per_contact": 1.0}).numerics, scene.geometry
    monkeypatch.setattr(Moduli, "of", alike)
    materials = {"material": of_bulk(geometry.material), "striker_material": of_bulk(geometry.striker_material)}
    body = TARGETS.get(scene.target.name).relaxing(replace(geometry, **materials), numerics)
    _round._together.cache_clear()  # it knows the moduli of this test
    surface, bulk = (march(Strike.of(scene), b, numerics) for b in (struck(geometry, numerics), body))
    for field in ("time", "depth", "impulse", "radius"):
        one, other = getattr(surface, field), getattr(bulk, field)
        np.testing.assert_allclose(other, one, rtol=0.0, atol=1e-9 * np.abs(one).max())
    for term, value in surface.energy.items():
        assert bulk.energy[term] == pytest.approx(value, abs=1e-9 * surface.energy["in"])


def test_a_washer_that_slides_is_a_column_of_the_uniaxial_modulus() -> None:
    """9 K G/(3 K + G), exactly, for a whole impact: no element, no mode."""
    material = Material(Relaxation(1e6, (1e6,), (2e-3,)), 0.45, constant="bulk")
    ring, height = Washer(0.004, 0.01, 0.005, "sliding"), 0.005
    scene = Scene(Punch(0.012), 0.05, 0.02, material, target=ring)
    area = np.pi * (ring.outer_radius**2 - ring.inner_radius**2)
    column = Scene(Prism(area, height, "free", "sliding"), 0.05, 0.02, material, target=Plane())
    found, exact = fe_contact.run(scene, 1e-3), simulate(laws.correspondence.of(column), column, 1e-7)
    for key in ("peak_force", "peak_depth", "duration", "restitution", "impulse"):
        value, true = found.quantities[key], exact.quantities[key]
        assert abs(value.value - true.value) <= value.error + true.error, key
        assert value.error <= 1e-3 * max(true.value, 1.0 if key == "restitution" else 0.0), key


@pytest.mark.tenth
@pytest.mark.parametrize(
    ("name", "tau", "instant"),
    [
        ("polymer-layer", 1e3, True),
        ("polymer-layer", 1e-8, False),
        ("two-finite-spheres", 1e3, True),
        ("polymer-washer", 1e-8, False),
    ],
)
def test_at_once_and_in_the_end_the_body_is_elastic(name: str, tau: float, instant: bool) -> None:
    """With the Poisson's ratio of that time: relaxation much slower, or much faster, than the impact."""
    young = Relaxation(1.2e6, (0.6e6, 0.9e6), (tau, 2.0 * tau))
    scene = replace(Scene.load(name), material=Material(young, 0.45, constant="bulk"))
    still = replace(scene, material=scene.geometry.material.elastic(instant))
    numerics = plan(still, {}).numerics
    curves = [
        Curve.of(march(Strike.of(s), struck(s.geometry, numerics), numerics), Strike.of(s)).quantities
        for s in (scene, still)
    ]
    assert not scene.geometry.surface_remembers
    for key in ("peak_force", "peak_depth", "duration", "restitution", "impulse"):
        assert curves[0][key] == pytest.approx(curves[1][key], rel=5e-5), key


@pytest.mark.tenth
def test_a_thick_layer_is_the_half_space_of_the_same_bulk_modulus() -> None:
    """There the surface knows E*(t) alone, 4 G (3 K + G)/(3 K + 4 G): another memory, another far field."""
    scene = Scene.load("polymer-sphere", BULK)
    deep = replace(scene, target=Layer(4.0, "bonded"))
    surface, bulk = fe_contact.run(scene, 1e-3), fe_contact.run(deep, 1e-3)
    share = float(surface.history.contact_radius.max()) / 4.0  # what the base still holds back
    for key in ("peak_force", "peak_depth", "duration", "restitution", "impulse"):
        one, other = surface.quantities[key], bulk.quantities[key]
        assert abs(other.value - one.value) <= one.error + other.error + 1.2 * share * one.value, key


def counted(monkeypatch: pytest.MonkeyPatch) -> dict[str, int]:
    """Sparse factorisations and back-substitutions from now on."""
    counts, factorise = {"factorizations": 0, "solves": 0}, linalg.splu

    class Counted:
        def __init__(self, *args: Any, **options: Any) -> None:
            counts["factorizations"] += 1
            self.factor = factorise(*args, **options)

        def __getattr__(self, name: str) -> Any:
            return getattr(self.factor, name)

        def solve(self, load: np.ndarray) -> np.ndarray:
            counts["solves"] += 1 if load.ndim == 1 else load.shape[1]
            return np.asarray(self.factor.solve(load))

    monkeypatch.setattr(linalg, "splu", Counted)
    return counts


@pytest.mark.tenth
def test_factorisations_do_not_grow_with_the_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    counts = counted(monkeypatch)
    scene = Scene.load("polymer-layer", BULK | {"target.material.nu": 0.4321})
    numerics = plan(scene, {}).numerics
    for steps in (20, 40):
        body = struck(scene.geometry, numerics.varied(steps=steps))
        done = march(Strike.of(scene), body, numerics.varied(steps=steps))
        assert len(done.time) > steps
        assert counts == {"factorizations": body.factorizations, "solves": body.solves}
    assert body.factorizations <= 4


@pytest.mark.parametrize(("name", "solves"), [("bonded", 0), ("o-ring", 0), ("free sphere", 3)])
def test_no_node_of_the_surface_is_solved_for_through_the_whole_mesh(
    name: str, solves: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """But for one fall a ratio of a body that nothing holds; three ratios, and one matrix more that tells the order."""
    counts = counted(monkeypatch)
    found = modes.__wrapped__(BODIES[name], 0.05, 0.15)
    assert counts == {"factorizations": 4, "solves": solves} == {key: getattr(found, key) for key in counts}
    assert len(found.operator.stiffness) > 20


@pytest.mark.family
@pytest.mark.parametrize("name", BODIES)
def test_what_is_left_of_the_eliminated_mesh_is_what_all_of_it_answers(name: str) -> None:
    """Displacement of the surface, and the work of its volume and of its shape, down to nearly no change of volume."""
    body = BODIES[name].follow()
    pencil = Pencil.of(body)
    shape, volume = body.stiffness(0.0, 1.0), body.stiffness(1.0, 0.0)
    for ratio in (1e-3, 0.05, 1.0, 30.0):
        found, whole = pencil.at(ratio), body.condensed(poisson(ratio))
        motion = whole.solve(np.eye(len(whole.operator.stiffness)))
        pairs = (
            (found.response, whole.operator.response),
            (found.work, motion.T @ (shape @ motion)),
            ((found.compliance - found.shear * found.work) / found.bulk, motion.T @ (volume @ motion)),
        )
        for answer, direct in pairs:
            assert np.linalg.norm(answer - direct) < 1e-8 * np.linalg.norm(direct)


@pytest.mark.family
@pytest.mark.parametrize("name", ["polymer-o-ring", "two-cylinders", "polymer-washer"])
def test_like_marches_share_their_factorisations(name: str) -> None:
    """One body for every number of steps, as the counted work has it."""
    scene = Scene.load(name)
    scene = replace(scene, material=Material(SOLID, 0.45, constant="bulk"))
    numerics = plan(scene, {"elements_per_contact": 1.0}).numerics
    assert struck(scene.geometry, numerics) is struck(scene.geometry, numerics.varied(steps=2 * numerics.steps))


def test_what_bulk_memory_is_not_for_says_so() -> None:
    scene = Scene.load("polymer-layer", BULK)
    for law in (laws.ting, laws.correspondence):
        with pytest.raises(BadInput, match="no load curve follows"):
            law.of(scene).simulate(scene, 1e-3)
    half_plane = replace(Scene.load("polymer-half-plane"), material=Material(SOLID, 0.45, constant="bulk"))
    with pytest.raises(BadInput, match="no impact of cylinder on half_space with it in this version; "):
        fe_contact.run(half_plane)


def test_moduli_have_the_contact_modulus_one_where_a_dashpot_leaves_shear_alone_too() -> None:
    """E* = 4 G (3K + G)/(3K + 4G), down to a step so short that shape is infinitely stiffer than volume."""
    ratios = 10.0 ** np.random.default_rng(3).uniform(-3.0, 18.0, 50)
    for nu in (-1.0, 0.0, 0.4999, *(poisson(float(ratio)) for ratio in ratios)):
        bulk, shear = moduli(nu)
        assert 4 * shear * (3 * bulk + shear) / (3 * bulk + 4 * shear) == pytest.approx(1.0, rel=1e-9)
