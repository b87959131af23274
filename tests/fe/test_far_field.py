"""What stands for the infinite body: Boussinesq's field is elastic, in balance, and closes the mesh."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from skfem import Basis, ElementTriP1, ElementTriP4, FacetBasis, MeshTri

import meshes
from fe_contact.assembly.far_field import BEYOND, boussinesq, dashpots, flamant, plane_robin, robin
from fe_contact.assembly.forms import isotropic
from fe_contact.assembly.operators import basis_on, boundary
from fe_contact.budget.certify import certify
from fe_contact.budget.plan import plan
from fe_contact.budget.runs import Runs
from fe_contact.budget.variation import compliance_change
from fe_contact.contact.enforcement.base import ENFORCEMENTS
from fe_contact.contact.problem import ContactProblem
from fe_contact.settings import Numerics
from fe_contact.steppers.scaled_surface import ScaledSurface
from fe_contact.steppers.steps import Strike
from fe_contact.targets import half_space
from fe_contact.targets.layer import _mesh, matrix
from lumped import Relaxation, Scene
from lumped.load_curves import Hertz
from lumped.shapes import Parabola

corrected = ENFORCEMENTS.get("corrected")

RNG = np.random.default_rng(5)
POISSON = (0.0, 0.3, 0.4999, float(RNG.uniform(0, 0.5)))


@pytest.mark.parametrize("nu", POISSON)
def test_tractions_on_any_surface_around_the_load_carry_it(nu: float) -> None:
    """The unit force pushes along -z, so the traction on the body's outer side sums to +1 in z."""
    angle, weight = np.polynomial.legendre.leggauss(60)
    angle, weight = np.pi / 4 * (angle + 1), np.pi / 4 * weight
    for _ in range(5):
        bumps = RNG.uniform(-0.15, 0.15, 3)
        harmonics = 2 * np.arange(1, 4)[:, None] * angle
        size = 10 ** RNG.uniform(-2, 2)
        rho = size * (1 + bumps @ np.cos(harmonics))
        slope = -size * (bumps * 2 * np.arange(1, 4)) @ np.sin(harmonics)
        along = np.stack([np.sin(angle), -np.cos(angle)])
        turned = np.stack([np.cos(angle), np.sin(angle)])
        tangent = slope * along + rho * turned
        normal = np.stack([tangent[1], -tangent[0]])  # times the line element
        _, traction = boussinesq(rho * along, normal, nu)
        total = (2 * np.pi * rho * along[0] * weight) @ traction[1]
        assert total == pytest.approx(1.0, rel=1e-10)


@pytest.mark.parametrize("nu", POISSON)
def test_stress_follows_from_displacement_and_is_in_balance(nu: float) -> None:
    """Hooke's law and both equations of equilibrium by differences in space, at random points inside."""
    law = isotropic(1 - nu**2, nu)
    step = 2e-3

    def slope(values: Callable[[float], np.ndarray]) -> np.ndarray:
        """Derivative at 0 of order four."""
        return (8 * (values(step) - values(-step)) - values(2 * step) + values(-2 * step)) / (12 * step)

    def displacement(r: float, z: float) -> np.ndarray:
        return boussinesq(np.array([r, z]), np.array([1.0, 0.0]), nu)[0]

    def stress(r: float, z: float) -> np.ndarray:
        """rr, zz, hoop, rz; the hoop stress by Hooke's law, which the tractions do not show."""
        radial = boussinesq(np.array([r, z]), np.array([1.0, 0.0]), nu)[1]
        axial = boussinesq(np.array([r, z]), np.array([0.0, 1.0]), nu)[1]
        assert radial[1] == pytest.approx(axial[0], rel=1e-12), "the stress is symmetric"
        return np.array([radial[0], axial[1], (law @ strain(r, z))[2], radial[1]])

    def strain(r: float, z: float) -> np.ndarray:
        by_r, by_z = slope(lambda s: displacement(r + s, z)), slope(lambda s: displacement(r, z + s))
        return np.array([by_r[0], by_z[1], displacement(r, z)[0] / r, by_z[0] + by_r[1]])

    for _ in range(20):
        r, z = RNG.uniform(0.3, 2), -RNG.uniform(0.3, 2)
        here = stress(r, z)
        size = np.abs(here).max()
        np.testing.assert_allclose((law @ strain(r, z))[[0, 1, 3]], here[[0, 1, 3]], atol=1e-5 * size)
        by_r = slope(lambda s: stress(r + s, z))  # noqa: B023 - called at once
        by_z = slope(lambda s: stress(r, z + s))  # noqa: B023
        assert abs(by_r[0] + by_z[3] + (here[0] - here[2]) / r) < 1e-4 * size
        assert abs(by_r[3] + by_z[1] + here[3] / r) < 1e-6 * size


@pytest.mark.parametrize("nu", POISSON)
def test_the_surface_is_free_and_sinks_as_one_over_distance(nu: float) -> None:
    r = 10 ** RNG.uniform(-2, 2, 20)
    surface = np.stack([r, np.zeros_like(r)])
    displacement, traction = boussinesq(surface, np.stack([0 * r, 1 + 0 * r]), nu)
    assert not traction.any()
    np.testing.assert_allclose(displacement[1], -1 / (np.pi * r), rtol=1e-12)


@pytest.mark.parametrize("nu", POISSON)
def test_the_boundary_holds_the_point_force_exactly(nu: float) -> None:
    """The tensor answers Boussinesq's displacement with Boussinesq's traction: forces agree with its integral."""
    radius = float(10 ** RNG.uniform(0.7, 2))
    mesh = meshes.half_space(4.0, radius)
    element = ElementTriP4()
    basis = Basis(mesh, element)
    facets = FacetBasis(mesh, element, facets=mesh.boundaries["far"], intorder=12)
    matrix = robin(facets, nu).tocsr()
    assert np.abs(matrix - matrix.T).max() < 1e-14 * np.abs(matrix).max()
    nodes = np.unique(facets.get_dofs("far").flatten())
    motion = np.zeros(2 * basis.N)
    exact = boussinesq(basis.doflocs[:, nodes], np.stack([np.ones(len(nodes)), np.zeros(len(nodes))]), nu)[0]
    motion[2 * nodes], motion[2 * nodes + 1] = exact
    position = np.asarray(facets.global_coordinates())
    _, traction = boussinesq(position, np.asarray(facets.normals), nu)
    weight = 2 * np.pi * position[0] * facets.dx
    reaction = (matrix @ motion)[1::2].sum()
    assert reaction == pytest.approx(-(weight * traction[1]).sum(), rel=1e-4)
    displacement, _ = boussinesq(position, np.asarray(facets.normals), nu)
    work = -(weight * (displacement * traction).sum(axis=0)).sum()
    assert motion @ (matrix @ motion) == pytest.approx(work, rel=1e-4)
    assert work > 0


@pytest.mark.family
@pytest.mark.parametrize("nu", POISSON)
def test_the_force_error_falls_at_least_with_the_square_of_the_far_radius(
    nu: float, settings_of: Callable[..., Numerics], hertz_strike: Callable[..., Strike]
) -> None:
    """Hertz indentation, the contact edge anywhere in its window, against the force on a far larger mesh."""
    contact, profile = 0.2, Parabola(1.0)
    phase = float(RNG.uniform(0.98, 1.02))
    depth = float(Hertz(1.0).depth(contact))
    forces = []
    for far_radius in (2.5, 5.0, 10.0, 80.0):
        operator = half_space.surface(nu, settings_of(hertz_strike(), far_radius=far_radius))
        points = operator.operator.points
        problem = ContactProblem(operator.pressed, depth - profile.height(contact / phase * points), 1e3)
        solution = corrected.enforce(problem, points < phase)
        assert solution.converged
        forces.append(contact / phase * float(operator.operator.weights @ solution.pressure))
    errors = np.abs(np.divide(forces[:-1], forces[-1]) - 1)
    rates = np.log2(errors[:-1] / errors[1:])
    assert rates.min() > 2, errors
    assert errors[-1] < 5e-5


@pytest.mark.parametrize("nu", POISSON)
def test_a_line_force_is_carried_and_obeys_hooke(nu: float) -> None:
    """Flamant's tractions on a half circle sum to the force; its strains, by differences, give them in plane strain."""
    angle, weight = np.polynomial.legendre.leggauss(40)
    angle, weight = np.pi / 2 * angle, np.pi / 2 * weight
    normal = np.stack([np.sin(angle), -np.cos(angle)])
    _, traction = flamant(3.0 * normal, normal, nu, 7.0)
    np.testing.assert_allclose(3.0 * traction @ weight, [0.0, 1.0], atol=1e-12)
    law, step = isotropic(1 - nu**2, nu), 1e-4
    for x, z in RNG.uniform([0.1, -3.0], [3.0, -0.1], (5, 2)):
        place, ahead = np.array([x, z]), step * np.eye(2)
        moved = [[flamant(place + s * e, place, nu, 7.0)[0] for s in (1, -1)] for e in ahead]
        (xx, zx), (xz, zz) = [(up - down) / (2 * step) for up, down in moved]
        stress = law @ np.array([xx, zz, 0.0, zx + xz])
        for direction, wanted in (([1.0, 0.0], stress[[0, 3]]), ([0.0, 1.0], stress[[3, 1]])):
            np.testing.assert_allclose(flamant(place, np.array(direction), nu, 7.0)[1], wanted, rtol=1e-3, atol=2e-5)


@pytest.mark.parametrize("nu", POISSON)
def test_a_boundary_takes_waves_of_either_kind_by_their_own_speed(nu: float) -> None:
    """Of a cone around the axis, its slant sqrt(2) long: c_p of what moves along its normal, c_s of what moves along
    the slant, and of the power of neither anything by the other.
    """
    mesh = MeshTri(np.array([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]), np.array([[0], [1], [2]]))
    slant = mesh.facets_satisfying(lambda x: np.isclose(x[0] - x[1], 1.0))
    facets = FacetBasis(mesh, ElementTriP1(), facets=slant, intorder=4)
    found = dashpots(facets, nu).toarray()
    young = 1.0 - nu**2
    squares = np.array([young * (1.0 - nu) / (1.0 + nu) / (1.0 - 2.0 * nu), young / (2.0 * (1.0 + nu))])
    ways = np.tile(np.array([[1.0, -1.0], [1.0, 1.0]]) / np.sqrt(2.0), 3)
    assert ways @ found @ ways.T == pytest.approx(np.pi * np.sqrt(2.0) * np.diag(np.sqrt(squares)), rel=1e-12, abs=1e-9)
    assert found == pytest.approx(found.T, abs=1e-12)


@pytest.mark.family
@pytest.mark.parametrize("shape", ["polymer-sphere", "polymer-cone"])
@pytest.mark.parametrize("damping", [0.0, 0.3, 2.0])
def test_the_far_fields_share_of_a_bar_covers_what_a_larger_mesh_changes(shape: str, damping: float) -> None:
    """A dashpot remembers the surface beside a small contact, which a near far field lifts by more than its share."""
    scene = Scene.load(shape)
    material = replace(scene.geometry.material, young=Relaxation(1e6))
    contact = replace(scene, material=material).elastic_contact_time
    scene = replace(scene, material=replace(material, young=Relaxation(1e6, viscosity=1e6 * contact * damping)))
    planned = plan(scene, {"tolerance": 1e-3}).numerics.varied(steps=60, far_radius=10.0)
    near, far = (
        certify(Strike.of(scene), scene.geometry, planned.varied(far_radius=radius)) for radius in (10.0, 40.0)
    )
    for name in ("peak_force", "peak_depth", "duration"):
        change = abs((near.curve.quantities[name] or 0.0) - (far.curve.quantities[name] or 0.0))
        assert change <= near.error(name, "far_field"), name


def test_a_lift_of_the_whole_contact_changes_the_force_by_twice_its_share() -> None:
    """Pressed to a depth d, a sphere on a surface that lifts by c F sinks in by d - c F: force 3/2 of that share, and
    F0 = 4/3, d = 1 for contact radius and E* of one.
    """
    scene, lift = Scene.load("steel-ball"), 1e-4
    numerics = plan(scene, {"tolerance": 1e-3}).numerics
    surface = Runs(Strike.of(scene), scene.geometry, 1).surface(numerics)
    assert isinstance(surface, ScaledSurface)
    lifted = replace(surface, operator=replace(surface.operator, response=surface.operator.response + lift))
    assert compliance_change(surface, lifted) == pytest.approx(1.5 * lift * 4.0 / 3.0, rel=1e-3)


@pytest.mark.parametrize("nu", POISSON)
def test_the_boundary_of_a_plane_holds_the_line_force_exactly(nu: float) -> None:
    """As that of the point force: what sinks as Flamant's field is held as by his tractions, in all by the force."""
    facets = boundary(basis_on(meshes.half_space(4.0, 20.0), 4), ("far",))
    position = np.asarray(facets.global_coordinates())
    matrix = plane_robin(facets, nu).tocsr()
    assert abs(matrix - matrix.T).max() < 1e-14 * abs(matrix).max()
    origin = np.exp(BEYOND) * np.hypot(*position).min()
    nodes = np.unique(facets.get_dofs("far").flatten())
    places = facets.doflocs[:, nodes]
    motion = np.zeros(2 * facets.N)
    motion[2 * nodes], motion[2 * nodes + 1] = flamant(places, places, nu, origin)[0]
    assert (matrix @ motion)[1::2].sum() == pytest.approx(-1.0, rel=1e-4)
    displacement, traction = flamant(position, np.asarray(facets.normals), nu, origin)
    work = -2.0 * (np.asarray(facets.dx) * (displacement * traction).sum(axis=0)).sum()
    assert motion @ (matrix @ motion) == pytest.approx(work, rel=1e-4)


@pytest.mark.parametrize(("plane", "beyond"), [(False, 4.0), (True, 0.0)])
def test_only_a_layer_around_an_axis_is_held_from_beyond_its_sides(plane: bool, beyond: float) -> None:
    """An even growth along the layer stretches it alone, and the plate around by p = 2 G/r u (Lame)."""
    bulk, shear = 0.7, 0.4
    basis = basis_on(_mesh(4.0, 1.5, 6.0, (0.3, 0.0, 1.0)), 2)
    width, thickness = np.ptp(basis.doflocs, axis=1)
    growth = np.zeros(2 * basis.N)
    growth[::2] = basis.doflocs[0]
    within = 2.0 * width * (bulk + 4.0 / 3.0 * shear) if plane else np.pi * width**2 * (4.0 * bulk + 4.0 / 3.0 * shear)
    energy = growth @ (matrix(basis, plane, bulk, shear) @ growth)
    assert energy == pytest.approx(thickness * (within + beyond * np.pi * shear * width**2), rel=1e-9)
