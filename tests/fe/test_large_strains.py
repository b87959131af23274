"""Large strains: patch and equilibrium of the bulk, the limit of small ones, bars of indentations and impacts."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from on_undeformed import OnUndeformed
from scipy.optimize import brentq, minimize_scalar
from skfem import Basis, ElementTriP2, MeshTri

from fe_contact import large_strains, run
from fe_contact.assembly.forms import Array
from fe_contact.assembly.operators import basis_on
from fe_contact.indentation import expected, indent, settings
from fe_contact.indentation import press as press_any
from fe_contact.progress import silent
from fe_contact.settings import Given
from fe_contact.solids import newton, pressing
from fe_contact.solids.base import PointAnswer, State, elliptic
from fe_contact.solids.bulk import Bulk, Pattern, Rolled
from fe_contact.solids.contact import Obstacle, OnDeformed, OnRound, OnTop, Skin, flat_places
from fe_contact.solids.finite import Hyperelastic
from fe_contact.solids.newton import (
    BeyondRange,
    Encounter,
    Equilibrium,
    EquilibriumLost,
    _descended,
    _descending,
    balanced,
)
from fe_contact.solids.pressing import Reached, Solid, _core, _pressed_evenly, _together, advanced, press
from lumped import BadInput, Scene, laws
from lumped.errors import NotReached
from lumped.indentation import Indentation
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import ENERGIES, energy_of, strained
from lumped.result.result import Quantity, largest_bar
from lumped.scene.indenter import Indenter
from lumped.scene.tables import LawChoice, Model
from lumped.shapes import Sphere
from lumped.shapes.cone import Cone
from lumped.shapes.cylinder import Cylinder
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.targets.layer import Layer
from lumped.targets.o_ring import ORing
from lumped.targets.plane import Plane
from lumped.targets.washer import Washer

COARSE = {"elements_per_contact": 2.0, "order": 3}


def sphere(nu: float, energy: str = "neo_hooke") -> Indenter:
    """On the half-space, E* = 1; the radius is 1."""
    material = Material(Relaxation(1.0 - nu**2), nu, hyperelastic=energy)
    return Indenter(Sphere(1.0), material, model=Model(kinematics="finite"))


@dataclass(frozen=True)
class Linear:
    """Small strains."""

    tangent: Array

    def respond(self, gradient: Array, state: State) -> PointAnswer:
        stress = np.einsum("ij,j...->i...", self.tangent, gradient)
        tangent = np.broadcast_to(self.tangent[:, :, None, None], (5, *gradient.shape))
        return PointAnswer(stress, tangent, 0.5 * np.sum(stress * gradient, axis=0))


def solid(indenter: Indenter, deepest: float, linear: bool = False) -> Solid:
    """Under contacts up to that of a depth; ``linear``: in its place the body and the gap of small displacements."""
    numerics = settings(COARSE, indenter.shape)
    found = Solid.of(indenter, np.array([0.7, 1.0]) * np.sqrt(deepest), numerics)
    if not linear:
        return found
    encounter = found.encounter
    response = encounter.body.response
    assert isinstance(response, Hyperelastic)
    at_rest = strained(response.energy, np.zeros((5, 1)), response.shear, response.lame).tangent[..., 0]
    body = replace(encounter.body, response=Linear(at_rest))
    return replace(found, encounter=replace(encounter, body=body, obstacle=OnUndeformed(indenter.shape, found.unit)))


def reached(body: Solid, depth: float) -> Equilibrium:
    return advanced(body.encounter, None, depth / body.unit, 500.0)


@pytest.mark.parametrize("plane", [False, True])
@pytest.mark.parametrize("name", ENERGIES.names)
def test_a_patch_strained_alike_balances_and_its_tangent_is_a_slope(name: str, plane: bool) -> None:
    """Alike are any affine motion in plane strain, stretches along and across the axis in a body of revolution."""
    mesh = MeshTri.init_tensor(np.linspace(0.3, 1.0, 3), np.linspace(-0.5, 0.0, 3))
    basis, response = basis_on(mesh, 3), Hyperelastic(energy_of(name), 1.0, 2.0)
    core = Bulk.of(basis, plane, np.arange(mesh.nelements))
    motion = np.array([[0.1, 0.08 * plane], [0.05 * plane, -0.2]])
    displacement = (motion @ basis.doflocs).T.ravel()
    loaded = core.answered(displacement, response)
    inner = np.setdiff1d(np.arange(basis.N), basis.get_dofs(mesh.boundary_facets()).flatten())
    scale = np.abs(loaded.forces).max()
    assert loaded.forces.reshape(-1, 2)[inner] == pytest.approx(0.0, abs=1e-12 * scale)
    tangent = Pattern.of([core.dofs], np.arange(core.size), core.size).matrix([loaded.matrices()])
    way = np.random.default_rng(1).normal(size=core.size)
    above, below = (core.answered(displacement + sign * 1e-6 * way, response) for sign in (1.0, -1.0))
    change = tangent @ way
    assert (above.forces - below.forces) / 2e-6 == pytest.approx(change, abs=1e-6 * np.abs(change).max())
    assert (above.energy - below.energy) / 2e-6 == pytest.approx(float(loaded.forces @ way), abs=1e-7 * scale)


@given(st.integers(0, 2**32 - 1))
def test_blocks_are_summed_where_they_stand_and_a_definite_matrix_has_their_places(seed: int) -> None:
    """Against the dense sum, held degrees of freedom left out; rows of many entries stay definite."""
    random = np.random.default_rng(seed)
    size = int(random.integers(4, 30))
    free = np.sort(random.permutation(size)[: int(random.integers(1, size + 1))])
    places = [random.integers(0, size, (int(random.integers(1, 12)), width)) for width in (2, 4)]
    blocks = [random.normal(size=(*dofs.shape, dofs.shape[1])) for dofs in places]
    dense, met = np.zeros((size, size)), np.zeros((size, size), dtype=bool)
    for dofs, block in zip(places, blocks, strict=True):
        for rows, values in zip(dofs, block, strict=True):
            np.add.at(dense, np.ix_(rows, rows), values)
            met[np.ix_(rows, rows)] = True
    pattern = Pattern.of(places, free, size)
    assert pattern.matrix(blocks).toarray() == pytest.approx(dense[np.ix_(free, free)], abs=1e-12)
    definite = pattern.definite.toarray()
    np.testing.assert_array_equal(definite != 0.0, met[np.ix_(free, free)] | np.eye(free.size, dtype=bool))
    assert np.linalg.eigvalsh(definite).min() > 0.0


@pytest.mark.parametrize("reached", [1.0, 0.7, 0.3, 1.0 / 16.0, 0.03])
def test_a_body_is_begun_by_the_most_of_a_depth_halved_again_that_is_reached_at_once(
    reached: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Down to a sixteenth: where that is out of reach it is lost by name."""
    depth, lost = 2e-3, EquilibriumLost("it folds")

    def first(_: object, tried: float, *rest: object) -> float:
        if tried > reached * depth:
            raise lost
        return tried / depth

    monkeypatch.setattr(pressing, "pressed_first", first)
    encounter: Any = SimpleNamespace(skin=SimpleNamespace(size=2))
    if reached < 1.0 / 16.0:
        with pytest.raises(EquilibriumLost, match="folds"):
            pressing._begun(encounter, depth, 500.0, ())
    else:
        begun: Any = pressing._begun(encounter, depth, 500.0, ())
        assert 0.5 * reached < begun <= reached
        assert math.log2(begun).is_integer()


def test_overlap_with_a_circle_has_the_slopes_that_differences_tell() -> None:
    random, circle, step = np.random.default_rng(8), OnRound(1.7), 1e-5
    place, moved = random.uniform(-0.8, 0.8, (2, 6, 5)), random.uniform(-0.1, 0.1, (2, 6, 5))
    place[1] = -np.abs(place[1])
    found = circle.overlap(place, moved, 0.2)
    x, z = place + moved
    assert found.depth == pytest.approx(1.7 - np.hypot(x, z + 0.2 - 1.7))
    for along in range(2):
        shift = np.zeros((2, 1, 1))
        shift[along] = step
        after, before = (circle.overlap(place, moved + sign * shift, 0.2) for sign in (1.0, -1.0))
        assert found.normal[along] == pytest.approx((after.depth - before.depth) / (2.0 * step), abs=1e-8)
        assert found.bend[along] == pytest.approx((after.normal - before.normal) / (2.0 * step), abs=1e-8)


def test_overlap_with_a_profile_has_the_slopes_that_differences_tell_and_arcs_are_angles() -> None:
    random, step = np.random.default_rng(8), 1e-5
    place, moved = random.uniform(0.1, 0.8, (2, 6, 5)), random.uniform(-0.05, 0.05, (2, 6, 5))
    for obstacle in (OnDeformed(Sphere(1.7), 1.0), OnDeformed(Sphere(3.4), 2.0)):
        found = obstacle.overlap(place, moved, 0.2)
        x, z = place + moved
        assert found.depth == pytest.approx(0.2 + z - 1.7 + np.sqrt(1.7**2 - x**2))
        shift = step * np.eye(2)[0][:, None, None]
        after, before = (obstacle.overlap(place, moved + sign * shift, 0.2) for sign in (1.0, -1.0))
        assert found.normal[0] == pytest.approx((after.depth - before.depth) / (2.0 * step), abs=1e-8)
        assert found.bend[0] == pytest.approx((after.normal - before.normal) / (2.0 * step), abs=1e-5)
    angle = np.linspace(-1.5, 1.5, 7)
    assert OnRound(1.7).along(1.7 * np.array([np.sin(angle), np.cos(angle)])) == pytest.approx(1.7 * angle)
    beyond = np.array([[-2.0, 2.0], [0.0, 0.0]])
    assert OnRound(1.7).along(beyond) == pytest.approx(1.7 * np.array([-0.5, 0.5]) * np.pi), "as far as the circle goes"


def test_slopes_on_a_ring_laid_flat_turn_with_it() -> None:
    """Of x and z of the plane, told on the mesh: one along itself, zero along the other."""
    random, rolled, step = np.random.default_rng(9), Rolled(2.0), 1e-5
    flat = random.uniform(-1.0, 1.0, (2, 20))
    shifts = step * np.eye(2)[:, :, None]
    gradient = np.array([rolled.place(flat + one) - rolled.place(flat - one) for one in shifts]) / (2.0 * step)
    found = rolled.slopes(np.moveaxis(gradient, 1, 2), flat)
    assert found == pytest.approx(np.broadcast_to(np.eye(2)[:, None], found.shape), abs=1e-8)


def test_a_ring_laid_flat_has_the_area_and_the_stretch_of_the_ring() -> None:
    """Both halves of a sixth of it, from radius 2 to 3; it is wider by a hundredth all round."""
    arc = 2.0 * np.pi / 6.0
    mesh = MeshTri.init_tensor(np.linspace(0.0, arc, 11), np.linspace(-1.0, 0.0, 9))
    basis, rolled = Basis(mesh, ElementTriP2(), intorder=8), Rolled(2.0)
    bulk = Bulk.of(basis, True, np.arange(mesh.nelements), rolled)
    assert bulk.weight.sum() == pytest.approx(2.0 * np.pi * (3.0**2 - 2.0**2) / 6.0 / 2.0, rel=1e-12)
    moved = 0.01 * rolled.place(basis.doflocs)
    found = bulk.gradient(moved.T.ravel())
    assert found[[0, 3]] == pytest.approx(np.full((2, *bulk.weight.shape), 0.01), abs=1e-5)
    assert found[[1, 2]] == pytest.approx(np.zeros((2, *bulk.weight.shape)), abs=1e-5)


@pytest.mark.parametrize("sides", ["free", "confined"])
def test_a_block_pressed_by_little_is_a_spring(sides: str) -> None:
    """Its modulus over its thickness, and beyond that its strain."""
    block = Prism(4.0, 0.5, sides)
    depth = np.array([1e-4, 2e-4]) * 0.5
    for nu in (0.1, 0.45):
        indenter = Indenter(block, Material(Relaxation(1.0), nu, hyperelastic="neo_hooke"), Plane())
        change = _pressed_evenly(indenter, block, depth).force / (4.0 * depth / 0.5) - 1.0
        assert abs(2.0 * change[0] - change[1]) < 1e-6


@pytest.mark.parametrize("sides", ["free", "confined"])
@pytest.mark.parametrize("name", ["neo_hooke", "yeoh"])
def test_a_block_pressed_deep_presses_by_the_slope_of_its_least_energy(name: str, sides: str) -> None:
    """By scipy, over the stretch across where sides are free: to 40 % of its thickness."""
    block, material = Prism(4.0, 0.5, sides), Material(Relaxation(3.0), 0.3, hyperelastic=name)
    shear, depth, small = 3.0 / 2.6, np.array([0.01, 0.1, 0.2]), 1e-5
    lame = 2.0 * shear * 0.3 / 0.4

    def energy(along: float, across: float) -> float:
        gradient = np.array([across - 1.0, 0.0, 0.0, along - 1.0, across - 1.0])[:, None]
        return float(strained(energy_of(name), gradient, shear, lame).energy[0])

    def least(along: float) -> tuple[float, float]:
        """And where."""
        if sides == "confined":
            return energy(along, 1.0), 1.0
        found = minimize_scalar(
            lambda across: energy(along, across), bounds=(0.9, 1.5), method="bounded", options={"xatol": 1e-9}
        )
        return float(found.fun), float(found.x)

    found = _pressed_evenly(Indenter(block, material, Plane()), block, depth)
    modulus = 3.0 if sides == "free" else lame + 2.0 * shear
    for deep, force, radius in zip(depth, found.force, found.contact_radius, strict=True):
        along = 1.0 - deep / 0.5
        slope = (least(along + small)[0] - least(along - small)[0]) / (2.0 * small)
        assert force * modulus == pytest.approx(-4.0 * slope, rel=1e-6)
        assert radius == pytest.approx(math.sqrt(4.0 / math.pi) * least(along)[1], rel=1e-6)
    beside = _pressed_evenly(Indenter(block, material, Plane()), block, np.array([1e-9, 0.2]))
    assert beside.force[1] == pytest.approx(found.force[2], rel=1e-12), "whatever depths are pressed beside it"


def test_a_block_that_softens_is_pressed_to_where_its_waves_end_and_the_least_depth_beyond_is_told() -> None:
    """St Venant and Kirchhoff's, confined, nu = 0: down to a stretch of 1/sqrt(3); just before, it shears away."""
    block, material = Prism(1.0, 2.0, "confined"), Material(Relaxation(1.0), 0.0, hyperelastic="st_venant_kirchhoff")
    indenter, last = Indenter(block, material, Plane()), 2.0 * (1.0 - 1.0 / np.sqrt(3.0))
    stretch = 1.0 - 0.94 * last / 2.0
    found = _pressed_evenly(indenter, block, np.array([0.94 * last]))
    assert found.force == pytest.approx([0.5 * (stretch - stretch**3)], rel=1e-9)
    with pytest.raises(BeyondRange) as ended:
        _pressed_evenly(indenter, block, np.array([1.2, 0.5, 1.01, 1.1]) * last)
    assert ended.value.depth == pytest.approx(1.01 * last)


def test_the_force_is_the_slope_of_the_energy() -> None:
    """With the penalty as it is, of any mesh; and the energy is what the striker has brought."""
    body = solid(sphere(0.4), 0.1)
    below, middle, above = (reached(body, 0.1 * share) for share in (0.9999, 1.0, 1.0001))
    slope = (above.balance.energy - below.balance.energy) / (above.balance.depth - below.balance.depth)
    assert slope == pytest.approx(middle.balance.force, rel=1e-6)
    assert middle.error < 1e-6


@pytest.mark.parametrize(("farther", "settled"), [(1.05, 1e-2), (1.05, 1e-4), (1.1, 1e-3), (1.1, 1e-4)])
def test_an_iteration_that_ends_early_knows_what_the_next_would_change(farther: float, settled: float) -> None:
    """Of the force, from the residual alone."""
    first = reached(solid(sphere(0.3), 0.1), 0.05)
    body, depth = first.balance.encounter, farther * first.balance.depth
    early = balanced(body, first.predicted(depth), depth, 500.0, settled=settled)
    late = balanced(body, early.balance.displacement, depth, 500.0, settled=1e-16)
    assert 1e-9 < early.error < 1e-5
    assert abs(early.balance.force / late.balance.force - 1.0) == pytest.approx(early.error, rel=0.1)


def test_a_contact_guessed_wider_than_the_striker_is_named() -> None:
    """A course that is planned deep guesses so, and then takes a shorter step."""
    encounter = solid(sphere(0.4), 0.1).encounter
    small = replace(encounter, obstacle=OnDeformed(Sphere(0.5), float(encounter.skin.place[0].max())))
    everywhere = np.ones(small.skin.weights.shape, bool)
    with pytest.raises(EquilibriumLost, match="as wide as the striker"):
        balanced(small, np.zeros(small.body.core.size), 0.01, 500.0, touching=everywhere)


@pytest.mark.tenth
def test_a_material_that_softens_ends_where_its_waves_do() -> None:
    """St Venant and Kirchhoff's energy, confined, has no slope of the stress at the stretch 1/sqrt(3).

    Just before, it shears away. Nearly so confined are the columns of a thin layer that does not swell sideways.
    """
    material = Material(Relaxation(1.0), 0.0, hyperelastic="st_venant_kirchhoff")
    model, last = Model(kinematics="finite"), 1.0 - 1.0 / np.sqrt(3.0)
    block = Indenter(Prism(1.0, 1.0, "confined", "sliding"), material, Plane(), model=model)
    layer = Indenter(Cylinder(1.0, 1.0), material, Layer(0.1, "bonded"), model=model)
    assert indent(block, (0.94 * last,), {}).converged
    with pytest.raises(BeyondRange, match="softens"):
        indent(block, (1.01 * last,), {})
    with pytest.raises(BeyondRange) as ended:
        Solid.of(layer, np.array([0.3]), settings(COARSE, layer.shape)).advanced(None, 0.05, 500.0)
    assert 0.08 * last < ended.value.depth < 0.1 * last


@pytest.mark.parametrize("faces", ["sliding", "bonded"])
def test_the_end_of_a_block_is_said_of_the_striker_s_material(faces: str) -> None:
    """On a rigid plane it alone has one; a layer's stands in the target's table."""
    material, model = Material(Relaxation(1.0), 0.0, hyperelastic="st_venant_kirchhoff"), Model(kinematics="finite")
    block = Indenter(Prism(1.0, 1.0, "confined", faces), material, Plane(), model=model)
    with pytest.raises(BeyondRange, match=r"another striker\.material\.hyperelastic") as ended:
        press(block, np.array([0.5]), np.array([block.shape.fixed_radius]), settings(COARSE, block.shape))
    assert 0.0 < ended.value.depth <= 0.5
    layer = Indenter(Cylinder(1.0, 1.0), material, Layer(0.1, "bonded"), model=model)
    with pytest.raises(EquilibriumLost, match=r"another target\.material\.hyperelastic"):
        press(layer, np.array([0.05]), np.array([0.3]), settings(COARSE, layer.shape))


@pytest.mark.parametrize("law", ["elastic", "sls"])
def test_the_end_of_a_struck_block_is_said_of_the_striker_s_material(law: str) -> None:
    """Whether it relaxes or not."""
    moduli = {"elastic": {"E": 5e5}, "sls": {"E1": 1.8e6, "E2": 9e5, "C1": 1.8e4}}[law]
    soft = {"law": law, **moduli, "nu": 0.45, "hyperelastic": "st_venant_kirchhoff"}
    keys = {"striker.material": soft, "model.kinematics": "finite", "striker.velocity": 3.0, "striker.faces": "bonded"}
    with pytest.raises(EquilibriumLost, match=r"another striker\.material\.hyperelastic"):
        run(Scene.load("polymer-prism", keys), tolerance=1e-2)


def o_ring(kinematics: str) -> Indenter:
    """E* = 1, the section's radius is a fifth."""
    material = Material(Relaxation(1.0 - 0.45**2), 0.45)
    return Indenter(Punch(2.0), material, ORing(1.0, 0.2), model=Model(kinematics=kinematics))


@pytest.mark.tenth
def test_an_o_ring_lightly_pressed_is_that_of_small_strains_and_stiffer_deep() -> None:
    """Force and half-width by the condensed section; deep, the force is the slope of the energy of both halves."""
    numerics, depth = settings(COARSE, Punch(2.0)), np.array([2e-4, 0.08])
    small, large = o_ring("small"), o_ring("finite")
    radii = expected(small, depth, numerics)
    found, known = (press_any(one, depth, radii, numerics) for one in (large, small))
    assert found.force[0] == pytest.approx(known.force[0], rel=3e-3)
    assert found.contact_radius[0] == pytest.approx(known.contact_radius[0], rel=0.03)
    assert found.force[1] > 1.1 * known.force[1]
    assert known.contact_radius[1] < found.contact_radius[1] < 0.2
    body = Solid.of(large, radii, numerics)
    below, middle, above = (advanced(body.encounter, None, share * 0.2, 500.0) for share in (0.9999, 1.0, 1.0001))
    slope = (above.balance.energy - below.balance.energy) / (above.balance.depth - below.balance.depth)
    assert slope == pytest.approx(middle.balance.force, rel=1e-6)


def test_a_washer_that_slides_between_two_planes_is_a_block() -> None:
    """Strained alike everywhere: uniaxial stress, whose stretches are a closed form."""
    material, model = Material(Relaxation(1.0), 0.45), Model(kinematics="finite")
    depths = (0.01, 0.2)
    washer = indent(Indenter(Punch(3.0), material, Washer(1.0, 2.0, 1.0, "sliding"), model=model), depths, {})
    block = indent(Indenter(Prism(3.0 * np.pi, 1.0, "free", "sliding"), material, Plane(), model=model), depths, {})
    assert washer.force == pytest.approx(block.force, rel=1e-6)
    assert np.all(np.abs(washer.force - block.force) <= washer.force_error)
    assert washer.contact_radius == pytest.approx(2.0 * block.contact_radius / np.sqrt(3.0), rel=5e-3)
    bonded = Indenter(Punch(3.0), material, Washer(1.0, 2.0, 1.0, "bonded"), model=model)
    found = press_any(bonded, np.array([0.2]), np.array([2.0]), settings(COARSE, Punch(3.0)))
    assert float(found.force[0]) * bonded.modulus(False) > 1.1 * washer.force[1]
    assert 2.0 < found.contact_radius[0] < washer.contact_radius[1]


def test_a_bonded_block_is_that_of_small_strains_where_it_is_lightly_pressed() -> None:
    """Deep, the force is the slope of the energy of both halves."""
    material, block = Material(Relaxation(1.0), 0.45), Prism(np.pi, 0.8, "free", "bonded")
    depth = np.array([4e-4, 0.16])
    large = Indenter(block, material, Plane(), model=Model(kinematics="finite"))
    numerics, radii = settings(COARSE, block), np.array([1.0, 1.0])
    found, known = (press_any(one, depth, radii, numerics) for one in (large, replace(large, model=Model())))
    assert found.force[0] == pytest.approx(known.force[0], rel=5e-3)
    assert found.force[1] > 1.1 * known.force[1]
    assert found.contact_radius == pytest.approx(1.0, rel=5e-3)
    body = Solid.of(large, radii, numerics)
    below, middle, above = (advanced(body.encounter, None, share * 0.08, 500.0) for share in (0.9999, 1.0, 1.0001))
    slope = (above.balance.energy - below.balance.energy) / (above.balance.depth - below.balance.depth)
    assert slope == pytest.approx(middle.balance.force, rel=1e-6)


@pytest.mark.parametrize("target", ["plane", "washer"])
def test_bars_cover_what_corners_of_infinite_stress_leave(target: str) -> None:
    """Of a bonded block and a bonded washer, deep, against three times as many elements."""
    material, model = Material(Relaxation(1.0), 0.3, hyperelastic="hencky"), Model(kinematics="finite")
    bodies = {
        "plane": Indenter(Prism(np.pi, 2.0, "free", "bonded"), material, Plane(), model=model),
        "washer": Indenter(Punch(3.0), material, Washer(1.0, 2.0, 1.0, "bonded"), model=model),
    }
    body, depth = bodies[target], 0.4 if target == "plane" else 0.2
    found = indent(body, (depth,), {"tolerance": 3e-2})
    fine = settings({"tolerance": 3e-2, "elements_per_contact": 6.0}, body.shape)
    way = depth * np.array([0.5, 1.0])
    exact = press_any(body, way, np.array([2.0, 2.0]), fine).force[1] * body.modulus(False)
    assert abs(found.force[0] - exact) < found.force_error[0]


@pytest.mark.parametrize("unit", [1.0, 1e-3])
def test_under_a_tip_a_mesh_serves_depths_up_to_twice_its_shallowest_and_under_a_sphere_all(unit: float) -> None:
    """In any order that they are asked in, and in any unit."""
    depth = unit * np.array([3.2, 1.0, 1.5, 9.0, 2.1, 2.0, 4.1, 4.3])
    assert pressing._together(Cone(18.0), depth) == [[1, 2, 5], [4, 0, 6], [7], [3]]
    assert pressing._together(Sphere(1.0), depth) == [[1, 2, 5, 4, 0, 6, 7, 3]]


@pytest.mark.parametrize("power", [0.3, 0.5, 1.0])
def test_contacts_are_foreseen_as_wide_as_a_power_of_the_depth(power: float) -> None:
    """That of the extreme depths, whatever lies between; of a lone one that of a sphere."""
    depth = np.array([3e-4, 1e-4, 9e-4])
    radii = 0.02 * depth**power * np.array([5.0, 1.0, 1.0])
    assert pressing._widening(depth, radii) == pytest.approx(power)
    assert pressing._widening(depth[:1], radii[:1]) == 0.5
    along = np.linspace(-4.0, 4.0, 161)
    touching = (along > -0.51) & (along < 1.01)  # as a pair of which one side is rounder
    skin = SimpleNamespace(place=None)
    encounter = SimpleNamespace(obstacle=SimpleNamespace(along=lambda place: along))
    touch = SimpleNamespace(skin=skin, touching=touching)
    before: Any = SimpleNamespace(balance=SimpleNamespace(depth=2.0, encounter=encounter, touch=touch))
    for depth_then in (2.0, 4.0, 1.0):
        wider = (depth_then / 2.0) ** power
        found = along[pressing._touching(before, depth_then, power)]
        assert found[0] + 0.5 * wider == pytest.approx(0.025, abs=0.0251)
        assert wider - found[-1] == pytest.approx(0.025, abs=0.0251)
    assert pressing._apart(4.0, before) == pytest.approx(np.log(2.0)) == pressing._apart(1.0, before)


def test_what_was_found_at_depths_is_told_in_the_order_in_which_they_were_asked_for() -> None:
    """The work of all of them, and the worst that another iteration would change."""
    solid: Any = SimpleNamespace(unknowns=70, ends=True, mesh_order=1.5)
    found = {2: Reached(3.0, 0.3, 1e-9, 5), 0: Reached(1.0, 0.1, 4e-9, 6), 1: Reached(2.0, 0.2, 2e-9, 7)}
    told = pressing._told(solid, found)
    assert told.force.tolist() == [1.0, 2.0, 3.0]
    assert told.contact_radius.tolist() == [0.1, 0.2, 0.3]
    assert told.work == {"degrees_of_freedom": 70, "contact_problems": 3, "iterations": 18}
    assert (told.newton, told.ends, told.mesh_order) == (4e-9, True, 1.5)


def test_strains_may_be_large_up_to_the_middle_between_the_contact_and_the_end_of_the_mesh() -> None:
    """By the middles of the elements."""
    corners = np.array([[0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0], [0.0, 0.1, 0.0, 0.1, 0.0, 0.1, 0.0]])
    elements = np.array([[0, 1, 2, 3, 4], [1, 2, 3, 4, 5], [2, 3, 4, 5, 6]])
    body: Any = SimpleNamespace(
        basis=SimpleNamespace(mesh=SimpleNamespace(p=corners, t=elements)), surface=SimpleNamespace(zone=2.2)
    )
    assert pressing._core(body).tolist() == [0, 1, 2, 3], "their middles at 1, 7/3, 4 and 6, not that at 8"


def test_under_a_steep_cone_every_depth_answers_alike() -> None:
    """F ~ depth^2 at any strain, since nothing but the depth has a length: shallow and deep, not lost at the tip."""
    pressed = replace(sphere(0.3), shape=Cone(18.0))
    depth = np.array([0.002, 0.03, 0.1])
    numerics = settings(COARSE, pressed.shape, True)
    found = press(pressed, depth, expected(pressed, depth, numerics), numerics)
    assert found.force / depth**2 == pytest.approx(found.force[-1] / depth[-1] ** 2, rel=2e-3)


def test_a_nearly_incompressible_body_is_pressed_deep_in_few_iterations() -> None:
    """Whole steps, by the stress that each foresaw: a line search on the energy alone takes ten times as many."""
    body = solid(sphere(0.4999), 0.2)
    first = advanced(body.encounter, None, 0.02 / body.unit, 500.0)
    found = advanced(body.encounter, first, 0.2 / body.unit, 500.0)
    assert found.iterations < 60
    assert found.error < 1e-6
    assert advanced(body.encounter, first, first.balance.depth, 500.0).iterations == 1, "where it is already"


@pytest.mark.parametrize("most", [0.55, 0.1, 0.0])
def test_a_body_that_can_be_pressed_by_little_at_once_reaches_any_depth_by_way_of_it(
    most: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As nearly incompressible ones: from rest by half as much until it goes; where nothing goes that is named."""
    body, at_once = solid(sphere(0.3), 0.2), pressing.pressed_first
    without = reached(body, 0.2).balance.force

    def pressed(encounter: Encounter, depth: float, *more: Any) -> Equilibrium:
        if depth > most * 0.2 / body.unit:
            raise EquilibriumLost("for this test")
        return at_once(encounter, depth, *more)

    monkeypatch.setattr(pressing, "pressed_first", pressed)
    if most:
        assert reached(body, 0.2).balance.force == pytest.approx(without, rel=1e-7)
    else:
        with pytest.raises(EquilibriumLost, match="for this test"):
            reached(body, 0.2)


def test_iterations_from_rest_to_a_depth_are_those_of_all_its_equilibria(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three penalties at first, then so many steps to where it goes; counted from outside."""
    body, counted = solid(sphere(0.3), 0.2), list[int]()

    def counting(*given: Any, **named: Any) -> Equilibrium:
        found = balanced(*given, **named)
        counted.append(found.iterations)
        return found

    monkeypatch.setattr(pressing, "balanced", counting)
    first = advanced(body.encounter, None, 0.02 / body.unit, 500.0)
    assert len(counted) == len(pressing.RAMP)
    assert first.iterations == sum(counted) > len(counted)
    counted.clear()
    assert advanced(body.encounter, first, 0.2 / body.unit, 500.0).iterations == sum(counted) > len(counted) > 1


def test_one_mesh_serves_depths_of_about_one_size_under_a_tip_and_all_of_them_elsewhere() -> None:
    """Up to twice the smallest of each mesh, whatever the order they are asked for in."""
    depth = np.array([4.1, 1.0, 2.0, 2.1, 1.7, 4.2, 8.5])
    assert _together(Cone(20.0), depth) == [[1, 4, 2], [3, 0, 5], [6]]
    assert _together(Sphere(1.0), depth) == [[1, 4, 2, 3, 0, 5, 6]]


def test_strains_may_be_large_halfway_from_the_contact_to_the_end() -> None:
    """Of small triangles in a row those whose middles are no farther."""
    corners = np.arange(11.0)
    points = np.array([np.repeat(corners, 2), np.tile([0.0, -1e-3], 11)])
    triangles = np.array([[2 * i, 2 * i + 1, 2 * i + 2] for i in range(10)]).T
    mesh, surface = SimpleNamespace(p=points, t=triangles), SimpleNamespace(zone=2.0)
    body: Any = SimpleNamespace(basis=SimpleNamespace(mesh=mesh), surface=surface)
    assert _core(body).tolist() == [0, 1, 2, 3, 4, 5], "up to 6 of 10: the middles are a third of a side on"


@pytest.mark.parametrize(
    "obstacle", [OnRound(1.5), OnDeformed(Sphere(2.0), 0.5), OnTop(0.2), OnUndeformed(Sphere(2.0), 0.5)]
)
def test_forces_of_a_touch_and_their_tangents_are_slopes_of_its_energy(obstacle: Obstacle) -> None:
    """Of one facet on both sides of the axis, by its displacement and by the depth; convex are its springs."""
    gauss, weights = np.polynomial.legendre.leggauss(3)
    share = 0.5 * (gauss + 1.0)
    place, trace = flat_places(np.array([-0.3 + 0.8 * share])), np.stack([1.0 - share, share], axis=1)
    skin, random = Skin(place, np.array([0.4 * weights]), trace, np.arange(4)[None], 4), np.random.default_rng(2)
    whole, deep, small = 0.05 * random.normal(size=4), 0.4, 1e-5

    def touched(moved: Array, depth: float = deep) -> Any:
        return skin.pressed(moved, obstacle, depth, 7.0, np.ones((1, 3), dtype=bool))

    def slopes(of: Callable[[Any], Any]) -> Array:
        steps = small * np.eye(4)
        return np.array([(of(touched(whole + s)) - of(touched(whole - s))) / (2.0 * small) for s in steps])

    here, ends = touched(whole), (touched(whole, deep + small), touched(whole, deep - small))
    assert here.energy == pytest.approx(3.5 * float(np.vdot(skin.weights, here.overlap.depth**2)), rel=1e-12)
    assert here.forces == pytest.approx(slopes(lambda touch: touch.energy), rel=1e-5, abs=1e-7)
    assert here.force == pytest.approx((ends[0].energy - ends[1].energy) / (2.0 * small), rel=1e-6)
    assert here.stiffening == pytest.approx((ends[0].forces - ends[1].forces) / (2.0 * small), rel=1e-5, abs=1e-6)
    assert here.matrices()[0] == pytest.approx(slopes(lambda touch: touch.forces), rel=1e-4, abs=1e-5)
    functions = np.stack([here.overlap.normal[c, 0, :, None] * trace for c in (0, 1)], axis=2).reshape(3, 4)
    springs = 7.0 * functions.T @ (skin.weights[0][:, None] * functions)
    assert here.matrices(convex=True)[0] == pytest.approx(springs, rel=1e-12, abs=1e-12)


def test_a_plane_upon_a_ring_meets_its_top_and_places_are_told_from_the_axis() -> None:
    ring, where = OnTop(3.0), np.array([[3.0, 2.5, -1.0], [0.0, -0.2, 0.1]])
    assert ring.place(np.array([0.0, 0.5 * np.pi, -0.5 * np.pi])) == pytest.approx(np.array([[3, 4, 2], [0, -1, -1]]))
    assert ring.overlap(where, 0.5 * where, 0.25).depth == pytest.approx([0.25, -0.05, 0.4])
    assert ring.along(where) == pytest.approx([0.0, -0.5, -4.0])
    for profiled in (OnDeformed(Sphere(2.0), 0.5), OnUndeformed(Sphere(2.0), 0.5)):
        assert profiled.along(where) == pytest.approx([3.0, 2.5, -1.0])


@dataclass(frozen=True)
class Way:
    """An equilibrium at a ``depth``, of a row of points touched up to 1, or from there to ``first``."""

    depth: float
    iterations: int = 1
    ends: bool = False
    first: float = -1.0

    @property
    def balance(self) -> Any:
        along = np.linspace(-4.0, 4.0, 33)
        touching = (along >= self.first) & (along <= 1.0)
        touch = SimpleNamespace(skin=SimpleNamespace(place=along), touching=touching)
        encounter = SimpleNamespace(obstacle=SimpleNamespace(along=lambda place: place))
        return SimpleNamespace(depth=self.depth, touch=touch, encounter=encounter)

    def predicted(self, depth: float) -> float:
        return depth

    def foreseen(self, depth: float) -> float:
        return 10.0 * depth

    def elliptic(self, depth: float) -> bool:
        return not self.ends


def gone(
    monkeypatch: pytest.MonkeyPatch, start: Way, depth: float, longest: float = 2.0
) -> tuple[Way, list[tuple[float, bool]]]:
    """How a way to a ``depth`` ends, and at which depths, hastily or not, it was tried, of which none may be further
    than ``longest`` from the one before.
    """
    here, tried = [start], list[tuple[float, bool]]()

    def balance(
        encounter: object, displacement: float, deep: float, stiffness: float, state: object, **named: Any
    ) -> Way:
        assert (displacement, named["foreseen"], stiffness, state) == (deep, 10.0 * deep, 7.0, ("what is remembered",))
        assert np.array_equal(named["touching"], pressing._touching(here[-1], deep, 0.5))  # type: ignore[arg-type]  # stands for one
        tried.append((deep, named["hasty"]))
        if max(deep / here[-1].depth, here[-1].depth / deep) > longest * (1.0 + 1e-9):
            raise EquilibriumLost("too far")
        here.append(replace(here[-1], depth=deep, iterations=3))
        return here[-1]

    monkeypatch.setattr(pressing, "balanced", balance)
    encounter, state = object(), ("what is remembered",)
    found: Any = advanced(encounter, start, depth, 7.0, 0.5, state)  # type: ignore[arg-type]  # stands for one
    return found, tried


@pytest.mark.parametrize(
    ("start", "depth", "ways"),
    [(1.0, 8.0, [2.0, 4.0, 8.0]), (1.0, 1.5, [1.5]), (8.0, 1.0, [4.0, 2.0, 1.0]),
     (1.0, 81.0, 81.0 ** (np.arange(1, 8) / 7))],
)  # fmt: skip
def test_a_way_is_made_in_even_parts_of_twice_the_depth_at_most(
    start: float, depth: float, ways: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    found, tried = gone(monkeypatch, Way(start), depth)
    assert [deep for deep, _ in tried] == pytest.approx(list(ways), rel=1e-12)
    assert found.depth == pytest.approx(depth, rel=1e-12)
    assert found.iterations == 3 * len(ways)
    assert all(hasty for _, hasty in tried)


def test_a_part_of_a_way_that_is_lost_is_made_in_halves_until_it_is_as_good_as_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In logarithms of the depth; where it ends though it is 2 % long, waves of the material say why."""
    found, tried = gone(monkeypatch, Way(2.0), 3.8, longest=1.5)
    assert [deep for deep, _ in tried] == pytest.approx([3.8, 7.6**0.5, 3.8], rel=1e-12)
    assert found.depth == 3.8
    for start, error in ((Way(1.0), "too far"), (Way(1.0, ends=True), "strains gather in bands")):
        with pytest.raises(EquilibriumLost, match=error) as lost:
            gone(monkeypatch, start, 1.9, longest=1.0)
        assert isinstance(lost.value, BeyondRange) is start.ends


def test_points_that_will_touch_are_those_of_a_contact_so_much_wider() -> None:
    """As a power of the depth, on both sides of where it begins or on one."""
    along = np.linspace(-4.0, 4.0, 33)
    for first, low, high in ((-1.0, -3.0, 3.0), (-0.5, -1.5, 3.0), (0.5, 0.0, 3.0)):
        touching = pressing._touching(Way(1.0, first=first), 9.0, 0.5)  # type: ignore[arg-type]  # stands for one
        assert np.array_equal(touching, (along >= low) & (along <= high))
    fewer = pressing._touching(Way(9.0), 1.0, 1.0)  # type: ignore[arg-type]  # stands for one
    assert np.array_equal(fewer, np.abs(along) <= 1.0 / 9.0)


def test_the_power_by_which_contacts_widen_is_that_of_the_smallest_and_the_largest() -> None:
    depth = np.array([3.0, 1.0, 8.0])
    assert pressing._widening(depth, 5.0 * depth**0.7) == pytest.approx(0.7, rel=1e-12)
    assert pressing._widening(np.array([1.0, 1.05]), np.array([1.0, 1.05**0.7])) == pytest.approx(0.7, rel=1e-9)
    assert pressing._widening(depth[:1], depth[:1]) == 0.5, "of a sphere, where one alone tells nothing"


@dataclass
class Sprung:
    """A spring at a displacement, with a ``base`` of energy; ``gains``: over Newton's step that by a model of the body,
    convex or at rest, which is noted as ``asked`` with how many points are to touch.
    """

    place: float
    gains: dict[tuple[bool, bool], float]
    asked: list[tuple[bool, bool, int]]
    base: float = 1.0
    ends: float = np.inf

    def __post_init__(self) -> None:
        self.displacement = self.residual = np.array([self.place])
        self.energy = self.base + 0.5 * self.place**2 if self.place <= self.ends else np.inf
        touching, one = abs(self.place) > 1e-3 * np.arange(3), np.ones(1)
        self.touch: Any = SimpleNamespace(touching=touching, stiffening=one, forces=one)
        self.encounter: Any = SimpleNamespace(body=SimpleNamespace(free=np.array([0])))

    def factors(self, convex: bool, unstrained: bool, meets: Array) -> Callable[[Array], Array]:
        self.asked.append((convex, unstrained, int(np.count_nonzero(meets))))
        return lambda load: self.gains[convex, unstrained] * load

    def descending(self, settled: float) -> Equilibrium:
        here: Any = self
        at: Any = lambda place: replace(self, place=float(place[0]))  # noqa: E731  # where else it may be
        return _descending(here, at, settled)


def test_after_two_blunt_steps_a_body_is_taken_as_at_rest_and_what_they_meet_as_touching() -> None:
    """Steps a thousand times too long lessen the energy where they are cut: they say that the tangent is no guide."""
    asked = list[tuple[bool, bool, int]]()
    found = Sprung(0.7, {(False, False): 1e3, (True, True): 1.0}, asked).descending(1e-9)
    assert found.balance.displacement == pytest.approx([0.0], abs=1e-12)
    assert asked == [(False, False, 0), (False, False, 3), (True, True, 3), (False, False, 0)]
    assert found.iterations == 4


@pytest.mark.parametrize("base", [1e-3, 1.0, 1e6])
def test_descent_ends_where_a_step_changes_a_share_of_the_energy_and_takes_that_step_too(base: float) -> None:
    """Each of half the way to where it rests: the slope promises half the square of what is left."""
    asked, left, steps = list[tuple[bool, bool, int]](), 0.7, 1
    while 0.5 * left**2 > 1e-6 * (base + 0.5 * left**2):
        left, steps = 0.5 * left, steps + 1
    found = Sprung(0.7, {(False, False): 0.5}, asked, base).descending(1e-6)
    assert found.balance.displacement == pytest.approx([0.5 * left], rel=1e-12)
    assert found.iterations == len(asked) == steps
    assert found.rate == pytest.approx([-0.5]), "by the last tangent"


def test_a_body_whose_energy_has_no_descent_is_lost_once_it_is_taken_as_at_rest() -> None:
    """Towards a wall: by no step however short, at what it meets there neither."""
    asked = list[tuple[bool, bool, int]]()
    body = Sprung(-0.7, {(False, False): 1.0, (True, True): 1.0}, asked, ends=-0.7)
    with pytest.raises(EquilibriumLost, match="no descent"):
        body.descending(1e-9)
    assert asked == [(False, False, 0), (False, False, 3), (True, True, 3)]


@pytest.mark.parametrize("hasty", [True, False])
def test_who_is_in_haste_gives_up_where_no_whole_steps_lead_to_an_equilibrium(
    hasty: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Half the way is the better one then; else it is looked for by what lessens the energy, from where it began."""
    start, at_last = np.array([0.3]), object()
    placed = {"at": lambda place, *given: SimpleNamespace(displacement=place, energy=1.0), "follows": False}
    encounter: Any = SimpleNamespace(**placed)
    monkeypatch.setattr(newton, "_hastened", lambda *given: None)
    monkeypatch.setattr(newton, "_descending", lambda here, *given: at_last if here.displacement is start else None)
    if hasty:
        with pytest.raises(EquilibriumLost, match="whole steps"):
            balanced(encounter, start, 0.1, 500.0, hasty=True)
        return
    assert balanced(encounter, start, 0.1, 500.0) is at_last


@pytest.mark.parametrize(("shrinks", "steps", "found"), [(0.5, 8, False), (2.0, 3, False), (1e-3, 4, True)])
def test_whole_steps_are_given_up_after_eight_or_once_two_in_a_row_promise_more(
    shrinks: float, steps: int, found: bool
) -> None:
    """Else the one that promises next to nothing is the last, and all are counted. By what each leaves of a promise."""
    tried, free = list[Array](), SimpleNamespace(body=SimpleNamespace(free=np.array([0])))

    def balance() -> Any:
        touch = SimpleNamespace(touching=np.ones((1, 1), bool), stiffening=np.ones(1), forces=np.ones(1))
        residual = np.array([-(shrinks ** (0.5 * len(tried)))])
        loaded = SimpleNamespace(foreseen=lambda change: None)
        solved: Any = SimpleNamespace(residual=residual, energy=1.0, displacement=np.zeros(1), touch=touch)
        vars(solved).update(encounter=free, loaded=loaded, factors=lambda pulls: lambda given: given)
        return solved

    def at(place: Array) -> Any:
        tried.append(place)
        return balance()

    answer = newton._hastened(balance(), at, 2e-9, None)
    assert len(tried) == steps
    assert (answer is not None) == found
    assert answer is None or answer.iterations == steps


def descended(energy: Callable[[float], float], slope: float, way: float = 0.3) -> float:
    """Where the line search leaves a body of one displacement, from 0.7 on, of the ``way`` that Newton's step goes."""
    free: Any = SimpleNamespace(body=SimpleNamespace(free=np.array([1])))

    def at(place: Array) -> Any:
        assert place[0] == 0.1, "what is held stays"
        moved = float(place[1] - 0.7) / way
        touch = SimpleNamespace(touching=None)
        return SimpleNamespace(encounter=free, displacement=place, energy=energy(moved), moved=moved, touch=touch)

    found: Any = _descended(at(np.array([0.1, 0.7])), np.array([way]), slope, at)
    assert found.share == pytest.approx(found.balance.moved)
    return float(found.share)


@pytest.mark.parametrize("way", [0.3, -20.0])
@pytest.mark.parametrize("bend", [0.5, 1.9, 2.1, 7.0, 60.0, 9000.0])
def test_a_step_that_lessens_the_energy_is_taken_whole_and_else_at_least_half_of_what_does(
    bend: float, way: float
) -> None:
    """A parabola that is back at its height after 2/bend of a step: shorter ones cost iterations, longer ones climb."""
    back = 2.0 / bend
    share = descended(lambda moved: 5.0 - moved + 0.5 * bend * moved**2, -1.0, way)
    assert min(1.0, 0.499 * back) <= share <= min(1.0, back) + 1e-12


def test_a_step_that_hardly_lessens_the_energy_is_no_descent() -> None:
    """Down and up again steeply: by less than a share of what its slope promises, and not at rest either."""
    assert descended(lambda moved: 5.0 + 4.0 * max(moved - 0.25, -moved) - 3e-5 * moved, -4.0) == pytest.approx(0.125)


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_an_energy_that_stands_still_but_for_rounding_is_the_end_and_one_that_climbs_is_named(unit: float) -> None:
    """In any unit."""
    assert descended(lambda moved: unit * (5.0 + 1e-15 * moved), -1e-15 * unit) == pytest.approx(1.0)
    for climbs in (lambda moved: unit * (5.0 + 1e-9 * moved), lambda moved: np.inf * moved if moved else 5.0 * unit):
        assert descended(climbs, -1e-12 * unit) == 0.0


@pytest.mark.family
@pytest.mark.parametrize(("name", "nu"), [(name, (0.3, 0.45)[i % 2]) for i, name in enumerate(ENERGIES.names)])
def test_small_depths_leave_small_strains_as_the_ledger_has_it(name: str, nu: float) -> None:
    """F/F_small = 1 + c1 depth/a + ..., both on one mesh, so that what it errs by cancels."""
    change = []
    for depth in (0.0025, 0.01):
        forces = [reached(solid(sphere(nu, name), depth, linear), depth).rigid_force for linear in (False, True)]
        change.append((forces[0] / forces[1] - 1.0) / np.sqrt(depth))
    first = 2.0 * change[0] - change[1]  # without what is of the next order, in depth
    pressed = sphere(nu)
    told = pressed.target.strains(pressed.shape, nu, 1e-6, 1e-3).change(energy_of(name))
    assert first == pytest.approx(1e3 * told, abs=0.02)


@pytest.mark.parametrize("stretch", [0.57, 0.59, 0.9])
def test_st_venants_material_bears_waves_along_the_stress_down_to_a_stretch(stretch: float) -> None:
    """Uniaxial strain, nu = 0: the stress mu (s^3 - s) has its minimum where 3 s^2 = 1, s = 0.577."""
    gradient = np.array([0.0, 0.0, 0.0, stretch - 1.0, 0.0])[:, None]
    tangent = Hyperelastic(energy_of("st_venant_kirchhoff"), 1.0, 0.0).respond(gradient, ()).tangent
    assert elliptic(tangent) == (3.0 * stretch**2 > 1.0)


@pytest.mark.parametrize(("onwards", "borne"), [(0.62, True), (0.55, False), (-0.1, True)])
def test_a_body_bears_waves_where_it_is_and_where_it_goes_on_to_unless_it_cannot_be_there(
    onwards: float, borne: bool
) -> None:
    """St. Venant's, one point by its stretch 1 - depth, at depth 0.1 of itself; turned inside out it has no energy."""
    response = Hyperelastic(energy_of("st_venant_kirchhoff"), 1.0, 0.0)

    def answered(displacement: Array, law: Hyperelastic, state: State) -> Any:
        gradient = np.array([0.0, 0.0, 0.0, displacement[0], 0.0])[:, None]
        answer = law.respond(gradient, state)
        return SimpleNamespace(answer=answer, energy=float(answer.energy[0]))

    body = SimpleNamespace(core=SimpleNamespace(answered=answered), response=response)

    def equilibrium(depth: float) -> Equilibrium:
        encounter, displacement = SimpleNamespace(body=body), np.array([-depth])
        loaded = answered(displacement, response, ())
        balance: Any = SimpleNamespace(
            encounter=encounter, displacement=displacement, depth=depth, state=(), loaded=loaded
        )
        return Equilibrium(balance, np.array([-1.0]), np.zeros(1), 1)

    assert equilibrium(0.1).elliptic(1.0 - onwards) == borne
    assert not equilibrium(0.45).elliptic(0.1), "here it does not"


def test_waves_are_borne_where_the_acoustic_tensor_of_every_direction_is_definite() -> None:
    """Q_ik = C_ijkl N_j N_l of random tangents, a quarter of a degree apart; near to none it is left open."""
    rng, angle = np.random.default_rng(5), np.linspace(0.0, np.pi, 720, endpoint=False)
    direction = np.stack([np.cos(angle), np.sin(angle)])
    found = list[bool]()
    for _ in range(200):
        half = rng.normal(size=(5, 5))
        tangent = half + half.T + rng.uniform(0.0, 6.0) * np.eye(5)
        acoustic = np.einsum("ijkl,jn,ln->nik", tangent[:4, :4].reshape(2, 2, 2, 2), direction, direction)
        least = float(np.linalg.eigvalsh(acoustic).min())
        if abs(least) > 0.3:
            found.append(least > 0.0)
            assert elliptic(tangent[:, :, None]) == found[-1]
            sound = np.tile(2.0 * np.eye(5)[:, :, None, None], (1, 1, 3, 2))
            assert elliptic(sound)
            sound[:, :, 2, 1] = tangent
            assert elliptic(sound) == found[-1], "one point is enough"
    assert 30 < sum(found) < len(found) - 30


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_whether_waves_are_borne_is_no_question_of_units(unit: float) -> None:
    for stretch in (0.57, 0.9):
        gradient = np.array([0.0, 0.0, 0.0, stretch - 1.0, 0.0])[:, None]
        tangent = Hyperelastic(energy_of("st_venant_kirchhoff"), unit, 0.0).respond(gradient, ()).tangent
        assert elliptic(tangent) == (3.0 * stretch**2 > 1.0)


@pytest.mark.tenth
def test_a_finer_run_lies_within_both_bars() -> None:
    """Of a deep indentation, where strains are large."""
    pressed = sphere(0.45, "yeoh")
    depths = (0.05, 0.2)
    loose, tight = (indent(pressed, depths, {"tolerance": one}) for one in (4e-3, 1e-3))
    assert loose.converged
    assert tight.converged
    assert np.all(np.abs(loose.force - tight.force) <= loose.force_error + tight.force_error)
    assert loose.model_sufficient
    assert np.all(loose.contact_radius < np.sqrt(np.array(depths) * 2.0))


@pytest.mark.tenth
def test_an_elastic_impact_gives_back_all_of_it() -> None:
    scene = Scene.load("polymer-sphere-finite")
    found = run(scene, tolerance=4e-3)
    quantities = found.quantities
    assert quantities["restitution"].value == pytest.approx(1.0, abs=1e-6)
    assert quantities["impulse"].value == pytest.approx(2.0 * scene.mass * scene.velocity, rel=1e-6)
    assert found.converged
    assert found.model_sufficient
    assert "ln J" in str(found.to_json()["model"]["energy"])
    peak, depth = (quantities[name].value or 0.0 for name in ("peak_force", "peak_depth"))
    assert large_strains.depth_reached(scene) == pytest.approx(depth, rel=5e-3)
    pressed = press_once(scene, depth)
    assert abs(pressed - peak) < 2.0 * (quantities["peak_force"].error or 0.0)


@pytest.mark.parametrize("gravity", [0.0, 0.01])
def test_the_deepest_depth_is_where_a_body_has_taken_up_what_the_striker_brings(
    gravity: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of an energy c d^2.5, in units of its own: its power leads there at once, or nearly where gravity adds to it."""
    scene = Scene.load("polymer-sphere-finite", {"model.gravity": gravity, "model.direction": "down"})
    unit, lead, tried = 0.01, 0.7, list[float]()
    stiffness = scene.contact_modulus.relaxed * scene.geometry.shape.total * unit**3 / lead
    c = 0.4 * 0.5 * scene.mass * scene.velocity**2 / (stiffness * 1e-3**2.5)

    def advanced(before: object, depth: float, stiffness: float) -> Any:
        tried.append(depth)
        inner = depth / unit
        return SimpleNamespace(
            balance=SimpleNamespace(depth=inner, force=2.5 * c * unit**2.5 * inner**1.5, taken=c * depth**2.5)
        )

    solid = SimpleNamespace(unit=unit, lead=lead, dimension=2, advanced=advanced)
    monkeypatch.setattr(large_strains.Solid, "of", lambda *given: solid)
    exact = brentq(
        lambda d: stiffness * c * d**2.5 - scene.mass * (0.5 * scene.velocity**2 + gravity * d), 1e-4, 1.0, xtol=1e-12
    )
    assert large_strains.depth_reached(scene) == pytest.approx(exact, rel=1e-3)
    assert len(tried) <= (6 if gravity else 2)


@pytest.mark.parametrize("error", [4e-3, -4e-3])
@pytest.mark.parametrize("tilted", [False, True])
def test_a_curve_that_errs_by_its_bars_leaves_the_impact_within_its_own(
    error: float, tilted: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a spring k depth^1.5 in place of finite elements, too stiff everywhere or where it is deep."""
    scene = Scene.load("polymer-sphere-finite")
    k = 4.0 / 3.0 * scene.contact_modulus.relaxed * np.sqrt(scene.profile.tip_radius)

    def indented(indenter: Indenter, depths: tuple[float, ...], given: object, progress: object) -> Indentation:
        place = 1.0 - np.log(np.array(depths) / depths[-1]) / np.log(depths[0] / depths[-1])
        off = error * (np.cos(np.pi * place) if tilted else np.ones(len(depths)))
        depth, bar = np.array(depths), np.full(len(depths), abs(error))
        force, radius = k * depth**1.5 * (1.0 + off), np.sqrt(depth * scene.profile.tip_radius)
        budget = {"mesh": 0.75 * bar, "penalty": 0.25 * bar}
        return Indentation(indenter, "fe", k, 1e-2, depth, force, radius, bar * force, budget)

    spring = Scene(None, scene.mass, scene.velocity, law=LawChoice("hertz", {"k": k, "alpha": 1.5}))
    exact = laws.hertz.of(spring).simulate(spring, 1e-6)
    monkeypatch.setattr(large_strains, "indent", indented)
    monkeypatch.setattr(large_strains, "depth_reached", lambda scene: exact.quantities["peak_depth"].value)
    found = run(scene, tolerance=1e-2)
    assert found.converged
    for name in ("peak_force", "peak_time", "peak_depth", "duration"):
        one, other = found.quantities[name], exact.quantities[name].value
        assert one.error / 4.0 < abs(one.value - other) < one.error, name
    off = np.abs(found.history.force - exact.history.force_at(found.history.time))
    assert np.all(off <= found.history.force_error + 1e-6 * found.history.force.max())
    assert np.median(found.history.force_error) < 5.0 * np.median(off)


@pytest.mark.parametrize("energy", ["neo_hooke_split", "yeoh"])
def test_the_force_of_a_slight_contact_is_in_its_band(energy: str) -> None:
    """Of a plate far below the least depth that was pressed, where a straight line stands for what a point answers."""
    material = {"law": "elastic", "E": 1e6, "nu": 0.3, "hyperelastic": energy}
    keys = {"striker.material": material, "striker.sides": "confined", "striker.velocity": 5.0}
    found = run(Scene.load("polymer-prism", {**keys, "model.kinematics": "finite"}), tolerance=1e-2)
    block, history = found.scene.geometry.shape, found.history
    assert isinstance(block, Prism)
    slight = (history.depth > 0.0) & (history.depth < 0.02 * history.depth.max())
    assert np.sum(slight) > 3
    along, none = -history.depth[slight] / block.thickness, np.zeros(int(np.sum(slight)))
    solid = found.scene.geometry.material
    shear, lame = solid.shear.relaxed, 2.0 * solid.shear.relaxed * solid.nu / (1.0 - 2.0 * solid.nu)
    exact = -block.area * strained(energy_of(energy), np.stack([none, none, none, along, none]), shear, lame).stress[3]
    assert np.all(np.abs(history.force[slight] - exact) < history.force_error[slight])


@pytest.mark.parametrize(("lessened", "converged"), [(True, True), (False, False)])
def test_depths_are_pressed_finer_until_the_impact_meets_its_tolerance(
    lessened: bool, converged: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a spring whose depths err by as much as they may, or by some more whatever is asked of them."""
    scene, asked = Scene.load("polymer-sphere-finite"), list[float]()
    k = 4.0 / 3.0 * scene.contact_modulus.relaxed * np.sqrt(scene.profile.tip_radius)

    def indented(indenter: Indenter, depths: tuple[float, ...], given: Given, progress: object) -> Indentation:
        asked.append(float(given["tolerance"]))
        depth = np.array(depths)
        assert np.all(np.diff(depth) > 0.0), "each of them tells something"
        assert depth[-1] == pytest.approx(1.02 * 0.4 * scene.profile.tip_radius), "a little deeper than it goes"
        force, radius = k * depth**1.5, np.sqrt(depth * scene.profile.tip_radius)
        bar = np.full(len(depths), asked[-1] if lessened else 1.1e-2)
        return Indentation(indenter, "fe", k, 1e-2, depth, force, radius, bar * force, {"mesh": bar})

    monkeypatch.setattr(large_strains, "indent", indented)
    monkeypatch.setattr(large_strains, "depth_reached", lambda scene: 0.4 * scene.profile.tip_radius)
    assert run(scene, tolerance=1e-2).converged == converged
    assert len(asked) == (2 if lessened else 1)


def test_a_curve_errs_by_the_worst_of_its_depths_and_by_what_a_polynomial_less_changes_between_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of d^1.5, which ripples by Chebyshev's polynomial of the seventh degree in the logarithm of the depth."""
    scene, ripple = Scene.load("polymer-sphere-finite"), 1e-3

    def indented(indenter: Indenter, depths: tuple[float, ...], given: Given, progress: object) -> Indentation:
        depth, bar = np.array(depths), np.linspace(1e-3, 4e-3, len(depths))
        place = 1.0 - np.log(depth / depth[-1]) / np.log(depth[0] / depth[-1])
        force = depth**1.5 * np.exp(ripple * np.cos(7.0 * np.arccos(np.clip(2.0 * place - 1.0, -1.0, 1.0))))
        budget = {"mesh": bar, "penalty": 0.5 * bar[::-1]}
        return Indentation(indenter, "fe", 1.0, 1e-2, depth, force, np.sqrt(depth), 1.5 * bar * force, budget)

    monkeypatch.setattr(large_strains, "indent", indented)
    known = large_strains._known(scene, 1e-3, {}, silent)
    assert known.errors["mesh"] == pytest.approx(4e-3)
    assert known.errors["penalty"] == pytest.approx(2e-3)
    assert known.errors["curve"] == pytest.approx(ripple, rel=0.2), "the sixth degree has nothing of it"
    assert known.relative == pytest.approx(6e-3)


def test_an_impact_on_a_known_curve_is_followed_to_a_hundredth_of_the_tolerance(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Of k d^1.5 (1 + d/D), which stiffens, by energy and momentum."""
    scene, stiff = Scene.load("polymer-sphere-finite"), 2e-3
    k, energy = 4.0 / 3.0 * scene.contact_modulus.relaxed, 0.5 * scene.mass * scene.velocity**2

    def indented(indenter: Indenter, depths: tuple[float, ...], given: Given, progress: object) -> Indentation:
        depth = np.array(depths)
        force = k * depth**1.5 * (1.0 + depth / stiff)
        return Indentation(indenter, "fe", k, 1e-2, depth, force, np.sqrt(depth), np.zeros_like(depth))

    monkeypatch.setattr(large_strains, "indent", indented)
    deep = brentq(lambda d: k * d**2.5 * (0.4 + d / (3.5 * stiff)) - energy, 1e-6, 1.0, xtol=1e-15)
    found = large_strains._known(scene, 1.02 * deep, {}, silent).impact(scene, 1e-6)
    assert largest_bar(found.quantities) <= 1e-8
    force, impulse = k * deep**1.5 * (1.0 + deep / stiff), 2.0 * scene.mass * scene.velocity
    for name, value in (("peak_depth", deep), ("peak_force", force), ("impulse", impulse)):
        assert found.quantities[name].value == pytest.approx(value, rel=1e-6), name


def test_a_striker_that_goes_deeper_than_every_curve_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """And what it takes to go less deep."""
    scene, deepest = Scene.load("polymer-sphere-finite"), list[float]()

    def curve(scene: Scene, deep: float, given: Given, progress: object) -> Any:
        deepest.append(deep)
        beyond: Any = SimpleNamespace(quantities={"peak_depth": Quantity(1.01 * deep, 0.0, "m")})
        return SimpleNamespace(impact=lambda scene, tolerance: beyond)

    monkeypatch.setattr(large_strains, "_known", curve)
    monkeypatch.setattr(large_strains, "depth_reached", lambda scene: 1e-4)
    with pytest.raises(NotReached, match=r"deeper than .* m; cure: a lower striker\.velocity or \.mass"):
        run(scene, tolerance=1e-2)
    assert np.all(np.diff(deepest) > 0.0)


def press_once(scene: Scene, depth: float) -> float:
    """N, at one depth, with settings of its own."""
    geometry = scene.geometry
    pressed = Indenter(geometry.shape, geometry.material, geometry.target, model=scene.model)
    radii = np.array([np.sqrt(depth * scene.profile.tip_radius)])
    found = press(pressed, np.array([depth]), radii, settings({"elements_per_contact": 3.0}, geometry.shape))
    return float(scene.contact_modulus.relaxed * found.force[0])


REFUSED = {
    "striker.shape": ("polymer-punch", {"target.shape": "layer", "target.thickness": 1e-4, "target.base": "bonded"}),
    "target.shape": ("two-spheres", {}),
    "numerics.enforcement": ("polymer-sphere", {}),
}


@pytest.mark.parametrize("key", REFUSED)
def test_what_is_not_built_is_refused_by_its_key(key: str) -> None:
    name, changes = REFUSED[key]
    pressed = Indenter.load(name, {**changes, "model.kinematics": "finite"})
    with pytest.raises(BadInput, match=key):
        indent(pressed, (1e-5,), {"enforcement": "exact"} if "enforcement" in key else {})


@pytest.mark.parametrize("name", ["polymer-sphere-waves", "two-spheres", "rod"])
def test_impacts_that_are_not_built_are_refused(name: str) -> None:
    scene = Scene.load(name, {"model.kinematics": "finite"})
    with pytest.raises(BadInput, match="kinematics"):
        run(scene)


def struck(force: Callable[[Array], Array], bar: float = 0.0) -> Any:
    """An impact of a second by its force alone."""
    time = np.linspace(0.0, 1.0, 401)
    history = SimpleNamespace(time=time, force=force(time), force_error=np.full(401, bar), force_at=force)
    return SimpleNamespace(history=history)


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e6])
def test_the_band_of_an_impact_holds_what_its_curve_errs_by_and_how_far_others_are_apart(unit: float) -> None:
    """In any unit of force, and no more than their sum, but at the end, which comes later of a softer curve."""
    relative, later = 0.02, 0.05

    def force(time: Array) -> Array:
        return unit * np.maximum(1.0 - (2.0 * time - 1.0) ** 2, 0.0)

    found, other = struck(force, 0.01 * unit), struck(lambda time: 0.97 * force(time))
    time = found.history.time
    alone = large_strains._band(found, (), relative, 0.0)
    np.testing.assert_allclose(alone, 0.01 * unit + relative * force(time))
    both = large_strains._band(found, (other,), relative, later)
    np.testing.assert_allclose(both[:200], 0.01 * unit + 0.05 * force(time[:200]))
    assert np.all(both[300:] >= 0.01 * unit + 0.05 * force(np.maximum(time[300:] - later, 0.0)) - 1e-3 * unit)


def test_impacts_are_apart_by_what_both_tell() -> None:
    """By nothing in what one of them, which does not part, has not."""
    one, other = struck(lambda time: time), struck(lambda time: 1.1 * time)
    one.quantities = {"duration": Quantity(None, None, "s"), "peak_force": Quantity(1.0, 0.0, "N")}
    other.quantities = {"duration": Quantity(1.0, 0.0, "s"), "peak_force": Quantity(1.1, 0.0, "N")}
    assert large_strains._distance(one, other, "duration") == 0.0
    assert large_strains._distance(one, other, "peak_force") == pytest.approx(0.1)
    assert large_strains._distance(one, other, "history_l2") == pytest.approx(0.1)
