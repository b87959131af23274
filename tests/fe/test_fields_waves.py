"""Fields of a body with inertia: they balance the striker, outrun no wave, and follow the material's memory."""

from __future__ import annotations

import math
from pathlib import Path

import meshio
import numpy as np
import pytest

from fe_contact.assembly.far_field import wave_speeds
from fe_contact.cli import main
from fe_contact.fields import STRESSES, Fields
from fe_contact.settings import WaveNumerics
from fe_contact.waves.targets import half_space
from fe_contact.waves.targets.half_space import fields_at
from lumped import Scene

QUICK = {"elements_per_contact": 6.0, "steps": 120}


def half_way(scene: Scene, share: float) -> tuple[Fields, np.ndarray, WaveNumerics]:
    """The fields at a share of the contact."""
    numerics = half_space.plan(scene, QUICK).numerics
    assert isinstance(numerics, WaveNumerics)
    fields, more = fields_at(scene, numerics, share * numerics.contact_time)
    velocity = more["velocity"]
    return fields, velocity, numerics


def test_nothing_moves_ahead_of_the_pressure_wave() -> None:
    fields, velocity, _ = half_way(Scene.load("steel-ball-waves"), 0.25)
    speed = wave_speeds(0.3)[0] * math.sqrt(2.06e11 / (1 - 0.3**2) / 7850.0)
    distance = np.hypot(*fields.points.T)
    ahead = distance > 1.1 * (speed * fields.time + fields.contact_radius)
    assert ahead.any()
    assert np.abs(velocity[ahead]).max() < 1e-4 * np.abs(velocity).max()
    assert np.abs(fields.displacement[ahead]).max() < 1e-5 * fields.depth


def test_at_the_turn_the_surface_is_where_the_ball_is_and_rests() -> None:
    scene = Scene.load("steel-ball-waves")
    fields, velocity, _ = half_way(scene, 0.5)
    axis = np.argmin(np.hypot(*fields.points.T))
    assert fields.displacement[axis, 1] == pytest.approx(-fields.depth, rel=0.01)
    assert abs(velocity[axis, 1]) < 0.05 * scene.velocity
    assert fields.stress[axis, STRESSES.index("stress_zz")] == pytest.approx(-fields.pressure[axis], rel=0.05)


@pytest.mark.tenth
def test_the_stress_of_a_body_with_memory_carries_the_pressure_on_it() -> None:
    """Standard linear solid and a dashpot in parallel, on the way in: without their memory the stress would be less."""
    slow = {"law": "kelvin_voigt", "E": 1.8e6, "eta": 1.8e4, "nu": 0.45, "density": 1000.0}
    for changes in ({}, {"target.material": slow}):
        fields, _, _ = half_way(Scene.load("polymer-sphere-waves", changes), 0.2)
        inside = (fields.points[:, 1] == 0.0) & (fields.points[:, 0] < 0.7 * fields.contact_radius)
        normal = fields.stress[inside, STRESSES.index("stress_zz")]
        np.testing.assert_allclose(normal, -fields.pressure[inside], atol=0.06 * fields.pressure.max())


@pytest.mark.tenth
def test_the_command_writes_the_velocity_too_and_rods_have_no_fields(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    coarse = ["--tolerance", "0.1", "--set", "numerics.steps=80", "--set", "numerics.elements_per_contact=3", "--quiet"]
    assert main(["run", "steel-ball-waves", "--fields", "--out", str(tmp_path / "a"), *coarse]) == 0
    mesh = meshio.read(tmp_path / "a" / "fields.vtu")
    assert {"velocity", "displacement", "stress_zz"} <= set(mesh.point_data)
    assert main(["run", "rod", "--fields", "--out", str(tmp_path / "b")]) == 2
    assert "target.shape" in capsys.readouterr().err
