"""Fields of large strains: force and pressure, surface and striker, the limit of small strains, Cauchy's stress."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from fe_contact import run
from fe_contact.cli import main
from fe_contact.fields import Fields, cauchy, fields_at_peak, strained_fields
from fe_contact.reference import solve, strained_at_peak
from lumped import Result, Scene
from lumped.materials import Material, Relaxation
from lumped.materials.energies.base import energy_of, strained
from lumped.scene.tables import Model
from lumped.shapes import Sphere
from lumped.targets import HalfSpace, Target
from lumped.targets.layer import Layer

LARGE = Model(kinematics="finite")
RELAXING = Relaxation(1e6, (1e6,), (0.004,))


def scene(young: Relaxation, velocity: float, target: Target) -> Scene:
    """A ball of 10 mm, 20 g."""
    return Scene(Sphere(0.01), 0.02, velocity, Material(young, 0.4), target=target, model=LARGE)


def with_fields(one: Scene) -> tuple[Result, Fields]:
    found = run(one, tolerance=1e-2)
    return found, strained_fields(found, *strained_at_peak(found))


@pytest.mark.parametrize(
    ("young", "velocity", "target"),
    [
        (Relaxation(1e6), 1.0, HalfSpace()),
        (Relaxation(1e6), 0.6, Layer(0.005, "bonded")),
        pytest.param(RELAXING, 1.0, HalfSpace(), marks=pytest.mark.tenth),
    ],
)
def test_pressure_adds_up_to_the_force_and_the_surface_fits_the_striker(
    young: Relaxation, velocity: float, target: Target
) -> None:
    one = scene(young, velocity, target)
    found, fields = with_fields(one)
    assert fields.depth > 9e-4, "strains are large"
    surface = np.flatnonzero(fields.points[:, 1] == 0.0)
    surface = surface[np.argsort(fields.points[surface, 0])]
    radius, height = (fields.points + fields.displacement)[surface].T
    force = np.trapezoid(2.0 * np.pi * radius * fields.pressure[surface], radius)
    assert force == pytest.approx(found.quantities["peak_force"].value, rel=0.02)
    inside = fields.contact[surface] == 1
    assert height[inside] == pytest.approx(one.profile.height(radius[inside]) - fields.depth, abs=3e-3 * fields.depth)
    assert radius[inside].max() == pytest.approx(fields.contact_radius, rel=0.1)
    axis = surface[0]
    assert fields.stress[axis, 1] == pytest.approx(-fields.pressure[axis], rel=0.05)
    assert abs(fields.stress[axis, 3]) < 0.05 * fields.pressure[axis]


def test_slight_strains_have_the_fields_of_small_ones() -> None:
    """On the axis, where the striker presses and below, by another mesh and another method."""
    one = scene(Relaxation(1e6), 1e-3, HalfSpace())
    _, large = with_fields(one)
    small = replace(one, model=Model())
    known = fields_at_peak(small, solve(small, {"tolerance": 1e-2}).certified)
    assert large.contact_radius == pytest.approx(known.contact_radius, rel=0.02)
    below = np.array([0.0, 0.3, 0.6, 1.0, 1.5]) * known.contact_radius
    first, second = (_down(fields, below) for fields in (large, known))
    np.testing.assert_allclose(first, second, atol=0.03 * np.abs(second).max())


def _down(fields: Fields, depths: np.ndarray) -> np.ndarray:
    """rr, zz and hoop stress at depths of the axis, Pa."""
    axis = np.flatnonzero(fields.points[:, 0] == 0.0)
    axis = axis[np.argsort(-fields.points[axis, 1])]
    return np.stack([np.interp(depths, -fields.points[axis, 1], fields.stress[axis, k]) for k in range(3)])


def test_cauchys_stress_is_that_of_the_tensors() -> None:
    random = np.random.default_rng(5)
    gradient = random.uniform(-0.3, 0.3, (5, 7))
    stress = strained(energy_of("ogden"), gradient, 1.0, 2.0).stress
    found = cauchy(stress, gradient)
    for one, piola, told in zip(gradient.T, stress.T, found.T, strict=True):
        deformed, first = np.eye(3), np.zeros((3, 3))
        for k, place in enumerate([(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)]):
            deformed[place] += one[k]
            first[place] = piola[k]
        true = first @ deformed.T / np.linalg.det(deformed)
        assert true == pytest.approx(true.T, abs=1e-12)  # a body without moments
        assert told == pytest.approx([true[0, 0], true[1, 1], true[2, 2], true[0, 1]], abs=1e-12)


def test_the_command_writes_the_deformed_body(tmp_path: Path) -> None:
    assert main(["run", "polymer-sphere-finite", "--fields", "--tolerance", "0.05", "--out", str(tmp_path)]) == 0
    mesh = meshio.read(tmp_path / "fields.vtu")
    assert {"displacement", "stress_zz", "pressure", "contact"} <= set(mesh.point_data)
    assert mesh.point_data["contact"].max() == 1
    areas = [_areas(mesh, share) for share in (0.0, 1.0)]
    assert np.all(areas[0] * areas[1] > 0.0), "no cell is turned inside out"


def _areas(mesh: meshio.Mesh, share: float) -> np.ndarray:
    """Twice that of every cell, by its sense of turning, m^2, displaced by a share of the displacement."""
    corners = (mesh.points + share * mesh.point_data["displacement"])[mesh.cells_dict["triangle"]]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.asarray(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
