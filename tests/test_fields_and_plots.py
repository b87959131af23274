"""Fields against the surface they must fit and against closed forms; charts that come out the same every time."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from skfem import Basis

import meshes
from fe_contact.assembly.forms import isotropic
from fe_contact.assembly.operators import element
from fe_contact.cli import main
from fe_contact.fields import (
    STRESSES,
    check_fields,
    felt,
    fields_at_peak,
    nodal_stress,
    peak_step,
    subdivided,
    write_fields,
)
from fe_contact.reference import Solved, result_of, solve
from fe_contact.studies.history_chart import plot_history
from fe_contact.studies.style import prefixed, with_error
from lumped.errors import BadInput
from lumped.scene.scene import Scene

SCENES: dict[str, dict[str, Any]] = {
    "steel-ball": {},
    "polymer-sphere": {},
    "incompressible": {"target.material.nu": 0.4999, "striker.velocity": 0.2},
}
Case = tuple[Scene, Solved]


@pytest.fixture(scope="module", params=SCENES)
def case(request: pytest.FixtureRequest) -> Case:
    name = request.param if request.param != "incompressible" else "polymer-sphere"
    scene = Scene.load(name, SCENES[request.param])
    return scene, solve(scene, {})


@pytest.fixture(scope="module")
def steel() -> Case:
    scene = Scene.load("steel-ball")
    return scene, solve(scene, {})


def test_the_surface_has_the_shape_of_the_striker_where_they_touch(case: Case) -> None:
    scene, solved = case
    fields = fields_at_peak(scene, solved.certified)
    touching = fields.contact == 1
    overlap = fields.depth - scene.profile.height(fields.points[touching, 0])
    assert touching.sum() > 20
    assert np.abs(-fields.displacement[touching, 1] - overlap).max() <= 1e-3 * fields.depth


def test_outside_the_contact_the_surface_stays_below_the_striker(case: Case) -> None:
    scene, solved = case
    fields = fields_at_peak(scene, solved.certified)
    r, z = fields.points.T
    beside = (z == 0.0) & (r > 1.02 * fields.contact_radius) & (r < 0.9 * scene.shape.tip_radius)
    gap = scene.profile.height(r[beside]) - fields.depth - fields.displacement[beside, 1]
    assert gap.min() > 0.0


def test_the_surface_is_in_equilibrium_with_the_pressure(case: Case) -> None:
    scene, solved = case
    fields = fields_at_peak(scene, solved.certified)
    r, z = fields.points.T
    smooth = (z == 0.0) & (np.abs(r / fields.contact_radius - 1) > 0.05)
    largest = fields.pressure.max()
    assert np.abs(fields.stress[smooth, 1] + fields.pressure[smooth]).max() <= 0.02 * largest
    assert np.abs(fields.stress[smooth, 3]).max() <= 0.02 * largest


def test_stress_on_the_axis_is_hertz(steel: Case) -> None:
    """Johnson, Contact Mechanics (1985), (3.45); the sphere is so shallow that it is a parabola to 1e-3."""
    scene, solved = steel
    fields = fields_at_peak(scene, solved.certified)
    axis = fields.points[:, 0] == 0.0
    force, modulus = solved.certified.curve.quantities["peak_force"] or 0.0, scene.contact_modulus.relaxed
    radius = (0.75 * force * scene.shape.tip_radius / modulus) ** (1 / 3)
    depth, p0 = -fields.points[axis, 1] / radius, 1.5 * force / (np.pi * radius**2)
    along = -1 / (1 + depth**2)
    arctangent = np.arctan2(1.0, depth)
    across = -(1 + scene.material.nu) * (1 - depth * arctangent) + 0.5 / (1 + depth**2)
    rr, zz, hoop, _ = fields.stress[axis].T / p0
    for found, expected in ((zz, along), (rr, across), (hoop, across)):
        assert np.abs(found - expected).max() < 5e-3


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_nodal_stress_is_exact_for_uniform_strain(order: int) -> None:
    """Also on the axis, where the hoop strain is 0/0."""
    basis = Basis(meshes.half_space(1, 3), element(order))
    law, (radial, axial) = isotropic(2.0, 0.3), (0.3, -0.7)
    displacement = (basis.doflocs * np.array([[radial], [axial]])).T.ravel()
    expected = law @ np.array([radial, axial, radial, 0.0])
    assert np.abs(nodal_stress(basis, displacement, law) - expected).max() < 1e-11


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_the_triangles_cover_every_element_once(order: int) -> None:
    basis = Basis(meshes.half_space(1, 3), element(order))
    triangles = subdivided(basis)
    assert len(triangles) == order**2 * basis.mesh.nelements
    assert set(triangles.ravel()) == set(range(basis.N))
    areas = np.abs(areas_of(basis.doflocs[:, triangles]))
    whole = np.abs(areas_of(basis.mesh.p[:, basis.mesh.t.T]))
    assert np.allclose(np.sort(areas), np.sort(np.repeat(whole / order**2, order**2)), rtol=1e-9)


def areas_of(corners: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    first, second = corners[..., 1] - corners[..., 0], corners[..., 2] - corners[..., 0]
    return np.asarray(0.5 * (first[0] * second[1] - first[1] * second[0]))


def test_projection_keeps_the_moments_and_drops_what_the_elements_cannot_feel(steel: Case) -> None:
    operator = steel[1].certified.surface.operator
    rough = np.random.default_rng(8).uniform(0.0, 1.0, operator.weights.size)
    nodal = operator.projected(rough)
    assert operator.weights @ (operator.trace @ nodal) == pytest.approx(operator.weights @ rough, rel=1e-9)
    unfelt = rough - operator.trace @ nodal
    np.testing.assert_allclose(operator.projected(unfelt), 0.0, atol=1e-9)
    assert np.abs(unfelt).max() > 0.1


def test_the_pressure_at_the_peak_is_that_of_hertz(steel: Case) -> None:
    scene, solved = steel
    found = felt(solved.certified, peak_step(solved.certified))
    radii = np.linspace(0.0, 0.95 * found.contact_radius, 50)
    exact = scene.contact_modulus.relaxed * scene.profile.load_curve.pressure(radii, found.contact_radius)
    assert np.abs(found.at(radii) - exact).max() < 0.01 * exact[0]


def test_the_file_holds_every_field(tmp_path: Path, steel: Case) -> None:
    scene, solved = steel
    mesh = meshio.read(write_fields(scene, solved.certified, tmp_path))
    fields = fields_at_peak(scene, solved.certified)
    assert set(mesh.point_data) == {"displacement", *STRESSES, "pressure", "contact"}
    assert np.array_equal(mesh.points[:, :2], fields.points)
    assert np.array_equal(mesh.point_data["displacement"][:, :2], fields.displacement)
    assert np.array_equal(mesh.point_data["contact"], fields.contact)


def test_a_relaxing_body_of_constant_bulk_modulus_has_no_fields(tmp_path: Path) -> None:
    scene = Scene.load("polymer-sphere", {"target.material.constant": "bulk"})
    where = tmp_path / "fields"
    with pytest.raises(BadInput, match=r"target\.material\.constant"):
        write_fields(scene, solve(scene, {"tolerance": 0.01}).certified, where)
    assert not where.exists()
    check_fields(Scene.load("steel-ball", {"target.material.constant": "bulk"}))  # elastic: the two are one


@pytest.mark.family
def test_the_chart_of_an_impact_is_reproducible_and_well_formed(tmp_path: Path, case: Case) -> None:
    scene, solved = case
    result = result_of(scene, solved)
    first, again = (plot_history(result, tmp_path / name, solved) for name in ("first", "again"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]
    text = ElementTree.parse(first[0]).getroot().itertext()
    assert scene.name in {part.strip() for part in text}
    assert first[1].read_bytes().startswith(b"\x89PNG")


@given(st.floats(1e-11, 1e14))
def test_a_prefix_makes_values_readable(value: float) -> None:
    factor, unit = prefixed(value, "N")
    assert unit.endswith("N")
    assert 1.0 <= value * factor < 1000.0 or abs(np.log10(factor)) == 12


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.1613372, 3.64e-6, "161.337 ± 0.004 mN"),
        (66.2331, 0.0173, "66.23 ± 0.02 N"),
        (80.3000374, 2.4e-10, "80.3 N ± 3e-12 of it"),
    ],
)
def test_a_value_ends_where_its_error_begins(value: float, error: float, text: str) -> None:
    assert with_error(value, error, "N") == text


@pytest.mark.family
@pytest.mark.parametrize("scene", ["bar-impact", "pounding-steel-jankowski"])
def test_a_history_without_a_pressure_is_drawn_too(scene: str, tmp_path: Path) -> None:
    """Bodies with inertia and bare laws tell no pressure: the chart names the method and has two panels."""
    assert main(["run", scene, "--plot", "--quiet", "--out", str(tmp_path)]) == 0
    words = (tmp_path / "history.svg").read_text(encoding="utf-8")
    method = "finite elements" if scene == "bar-impact" else "jankowski"
    assert (tmp_path / "history.png").stat().st_size > 10_000
    assert all(word in words for word in (scene, method, "contact force", "depth"))
    assert "pressure" not in words
