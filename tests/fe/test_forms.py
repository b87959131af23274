"""Axisymmetric elasticity: energies of exact states, equilibrium, definiteness, and a second assembly."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from skfem import Basis, BilinearForm, ElementTriP1, FacetBasis, LinearForm, MeshTri

import meshes
from fe_contact.assembly.forms import isotropic, stiffness
from fe_contact.assembly.operators import element, system_matrix
from fe_contact.targets import half_space

RNG = np.random.default_rng(11)
RADIUS, HEIGHT, YOUNG = 1.7, 0.9, 3.0
POISSON = (0.0, 0.3, 0.49, 0.4999)
ORDERS = range(1, 5)  # of elements, which settings accept
BODY_FORMS = [(order, nu) for order in ORDERS for nu in POISSON]


def cylinder(order: int) -> Basis:
    """Solid cylinder 0 <= r <= RADIUS, 0 <= z <= HEIGHT on a skew mesh."""
    mesh = MeshTri.init_tensor(np.linspace(0, RADIUS, 4), np.linspace(0, HEIGHT, 3)).refined(1)
    inner = np.setdiff1d(np.arange(mesh.nvertices), mesh.boundary_nodes())
    points = mesh.p.copy()
    points[:, inner] += RNG.uniform(-0.03, 0.03, (2, len(inner)))
    return Basis(MeshTri(points, mesh.t), element(order), intorder=2 * order)


def field(basis: Basis, radial: Any, axial: Any) -> np.ndarray:
    """Nodal values of a displacement field, numbered as the stiffness is."""
    values = np.zeros(2 * basis.N)
    values[0::2] = radial(*basis.doflocs)
    values[1::2] = axial(*basis.doflocs)
    return values


@pytest.mark.parametrize("nu", [*POISSON, -0.5])
def test_hookes_law_by_its_simple_states(nu: float) -> None:
    law = isotropic(YOUNG, nu)
    np.testing.assert_allclose(law @ [-nu, 1, -nu, 0], [0, YOUNG, 0, 0], atol=1e-11 * np.abs(law).max())
    bulk = YOUNG / (3 * (1 - 2 * nu))
    np.testing.assert_allclose(law @ [1, 1, 1, 0], [3 * bulk] * 3 + [0], rtol=1e-12)
    np.testing.assert_allclose(law @ [0, 0, 0, 1], [0, 0, 0, YOUNG / (2 * (1 + nu))], rtol=1e-15)


@pytest.mark.parametrize(("order", "nu"), BODY_FORMS)
def test_a_rigid_motion_along_the_axis_costs_nothing(order: int, nu: float) -> None:
    basis = cylinder(order)
    matrix = stiffness(basis, isotropic(YOUNG, nu)).tocsr()
    force = matrix @ field(basis, lambda r, z: 0 * r, lambda r, z: 1 + 0 * r)
    assert np.abs(force).max() < 1e-11 * np.abs(matrix).max()


@pytest.mark.parametrize(("order", "nu"), BODY_FORMS)
def test_the_energy_of_a_uniform_strain_is_exact(order: int, nu: float) -> None:
    basis = cylinder(order)
    law = isotropic(YOUNG, nu)
    a, b = RNG.normal(size=2)
    motion = field(basis, lambda r, z: a * r, lambda r, z: b * z)
    energy = 0.5 * motion @ (stiffness(basis, law) @ motion)
    strain = np.array([a, b, a, 0])
    assert energy == pytest.approx(0.5 * strain @ law @ strain * np.pi * RADIUS**2 * HEIGHT, rel=1e-10)


@pytest.mark.parametrize("order", [k for k in ORDERS if k > 1])
def test_the_energy_of_a_torsion_free_bending_is_exact(order: int) -> None:
    """u = (r z, r^2): every entry of the strain varies in space, the hoop strain and the shear among them."""
    nu, basis = 0.3, cylinder(order)
    motion = field(basis, lambda r, z: r * z, lambda r, z: r**2)
    energy = 0.5 * motion @ (stiffness(basis, isotropic(YOUNG, nu)) @ motion)
    shear = YOUNG / (2 * (1 + nu))
    lame = YOUNG * nu / ((1 + nu) * (1 - 2 * nu))
    normal = (2 * lame + 2 * shear) * HEIGHT**3 / 3 * RADIUS**2 / 2  # (2 z)^2 lame/2 + 2 z^2 shear over the section
    sheared = 0.5 * shear * 9 * RADIUS**4 / 4 * HEIGHT  # (3 r)^2
    assert energy == pytest.approx(2 * np.pi * (normal + sheared), rel=1e-10)


@pytest.mark.parametrize(("order", "nu"), BODY_FORMS)
def test_uniaxial_stress_needs_forces_on_the_end_faces_only(order: int, nu: float) -> None:
    basis = cylinder(order)
    motion = field(basis, lambda r, z: -nu * r, lambda r, z: z)
    matrix = stiffness(basis, isotropic(YOUNG, nu)).tocsr()
    force = matrix @ motion
    free = (basis.doflocs[1] > 1e-9) & (basis.doflocs[1] < HEIGHT - 1e-9)
    rounding = 1e-11 * np.abs(matrix).max()
    assert np.abs(force[0::2]).max() < rounding, "no radial force, on the lateral face either"
    assert np.abs(force[1::2][free]).max() < rounding
    top = force[1::2][basis.doflocs[1] > HEIGHT - 1e-9].sum()
    assert top == pytest.approx(YOUNG * np.pi * RADIUS**2, rel=1e-9)


@pytest.mark.parametrize(("order", "nu"), BODY_FORMS)
def test_the_batched_stiffness_equals_scikit_fems_own_forms(order: int, nu: float) -> None:
    """Block by block, each written out in the components of the displacement."""
    basis = cylinder(order)
    law = isotropic(YOUNG, nu)
    lame, shear = law[0, 1], law[3, 3]

    @BilinearForm
    def radial(u: Any, v: Any, w: Any) -> Any:
        r = w.x[0]
        trace_u, trace_v = u.grad[0] + u / r, v.grad[0] + v / r
        own = 2 * (u.grad[0] * v.grad[0] + u * v / r**2) + u.grad[1] * v.grad[1]
        return 2 * np.pi * r * (lame * trace_u * trace_v + shear * own)

    @BilinearForm
    def axial(u: Any, v: Any, w: Any) -> Any:
        own = 2 * u.grad[1] * v.grad[1] + u.grad[0] * v.grad[0]
        return 2 * np.pi * w.x[0] * (lame * u.grad[1] * v.grad[1] + shear * own)

    @BilinearForm
    def coupling(axial_u: Any, v: Any, w: Any) -> Any:
        r = w.x[0]
        return 2 * np.pi * r * (lame * axial_u.grad[1] * (v.grad[0] + v / r) + shear * axial_u.grad[0] * v.grad[1])

    whole = stiffness(basis, law).tocsr()
    tolerance = 1e-12 * np.abs(whole).max()
    assert np.abs(whole[0::2, 0::2] - radial.assemble(basis)).max() < tolerance
    assert np.abs(whole[1::2, 1::2] - axial.assemble(basis)).max() < tolerance
    assert np.abs(whole[0::2, 1::2] - coupling.assemble(basis)).max() < tolerance


def test_a_thick_tube_under_pressure_converges_to_lame() -> None:
    """u = A r + B/r between sliding end faces: the hoop strain away from the axis, a field no element holds."""
    inner, outer, nu, pressure = 0.5, 1.3, 0.3, 0.01
    modulus = YOUNG / (1 + nu)
    share = pressure * inner**2 / (outer**2 - inner**2)
    exact = share * ((1 - 2 * nu) * inner + outer**2 / inner) / modulus
    errors = []
    for refinement in (1, 2, 3):
        mesh = MeshTri.init_tensor(np.linspace(inner, outer, 3), np.linspace(0, 0.4, 2)).refined(refinement)
        basis = Basis(mesh, element(2), intorder=6)
        facets = FacetBasis(mesh, basis.elem, facets=mesh.facets_satisfying(lambda x: np.isclose(x[0], inner)))
        load = np.zeros(2 * basis.N)
        load[0::2] = LinearForm(lambda v, w: 2 * np.pi * w.x[0] * pressure * v).assemble(facets)
        faces = np.isclose(basis.doflocs[1], 0) | np.isclose(basis.doflocs[1], 0.4)
        free = np.setdiff1d(np.arange(2 * basis.N), 2 * np.flatnonzero(faces) + 1)
        matrix = stiffness(basis, isotropic(YOUNG, nu)).toarray()[np.ix_(free, free)]
        motion = np.zeros(2 * basis.N)
        motion[free] = np.linalg.solve(matrix, load[free])
        found = motion[0::2][np.isclose(basis.doflocs[0], inner)]
        errors.append(np.abs(found / exact - 1).max())
    rates = np.log2(np.divide(errors[:-1], errors[1:]))
    assert rates.min() > 2.5, errors


@pytest.mark.parametrize("nu", [*POISSON, 0.499, float(RNG.uniform(0, 0.5))])
@pytest.mark.parametrize("order", ORDERS)
def test_body_and_far_field_together_are_positive_definite(order: int, nu: float) -> None:
    """The far tensor alone is indefinite at some points; a negative mode would make contact explode."""
    for far_radius in (2.0, float(RNG.uniform(2, 50)), 1000.0):
        mesh = meshes.half_space(0.5, far_radius)
        basis = Basis(mesh, element(order), intorder=2 * order)
        matrix = system_matrix(basis, nu).toarray()
        assert np.abs(matrix - matrix.T).max() < 1e-12 * np.abs(matrix).max()
        free = np.setdiff1d(np.arange(len(matrix)), 2 * basis.get_dofs("axis").flatten())
        scale = 1 / np.sqrt(np.diag(matrix)[free])
        scaled = scale[:, None] * matrix[np.ix_(free, free)] * scale
        np.linalg.cholesky(scaled - 1e-10 * np.eye(len(free)))  # raises if an eigenvalue is smaller


@pytest.mark.parametrize("nu", POISSON)
def test_the_condensed_surface_is_symmetric_and_moves_towards_its_load(nu: float) -> None:
    """Maxwell's reciprocity of the compliance before anything symmetrises it; a positive definite stiffness."""
    operator = half_space._whole(nu, 2.0, 3, 20.0).operator
    compliance = operator.response[: len(operator.stiffness)]
    assert np.abs(compliance - compliance.T).max() < 1e-9 * np.abs(compliance).max()
    assert np.linalg.eigvalsh(operator.stiffness)[0] > 0
    product = operator.stiffness @ compliance
    np.testing.assert_allclose(product, np.eye(len(product)), atol=1e-8)


def test_the_quadrature_of_the_zone_integrates_polynomials_exactly() -> None:
    operator = half_space._whole(0.3, 1.0, 3, 5.0).operator
    order = operator.order
    nodes = operator.nodes[: operator.trace.shape[1]]
    end = nodes[-1]
    for power in range(order + 1):
        assert operator.weights @ (operator.trace @ nodes**power) == pytest.approx(
            2 * np.pi * end ** (power + 2) / (power + 2), rel=1e-12
        )


def test_p1_is_what_it_says() -> None:
    assert isinstance(element(1), ElementTriP1)
    assert all(element(k).maxdeg == k for k in ORDERS)
