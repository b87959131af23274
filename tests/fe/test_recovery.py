"""The indentation left on the axis: within its bars of Ting's path, and of the creep under the pressure on it.

The references take no modes: relaxation and creep are inverted numerically from E(s) and 1/E(s).
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

import fe_contact
import lumped
from fe_contact.cli import main
from fe_contact.recovery import recovery_of
from fe_contact.reference import solve
from fe_contact.targets import half_space
from lumped import convolution
from lumped.laws import ting
from lumped.materials import Relaxation
from lumped.materials.laplace import inverse

Scenes = Callable[..., lumped.Scene]
Impact = Callable[[np.random.Generator, int], lumped.Scene]

IMPACTS, SEED = 60, 83
PATH, FINER = 500, 2  # samples of Ting's path
PRONY = {"law": "prony", "E_inf": 1e6, "E": [2e6, 1e6], "tau": [0.3e-3, 4e-3]}


def crept(relaxation: Relaxation, time: np.ndarray, load: np.ndarray, later: np.ndarray) -> np.ndarray:
    """int J(t - s) dw(s) at ``later`` times for a load w over ascending times, straight between them."""
    middles, rises = 0.5 * (time[1:] + time[:-1]), np.diff(load)
    creep = inverse(lambda s: 1.0 / (relaxation.operational(s) * s), later[:, None] - middles).value
    return np.asarray(creep @ rises)


def tings(scene: lumped.Scene, later: np.ndarray, samples: int) -> np.ndarray:
    """The axis at times after separation, from Ting's path: E*(t) on the way in, 1/E*(s) from then on."""
    history = lumped.simulate(ting.of(scene), scene, 1e-7).history
    time = np.linspace(0.0, history.time[-1], samples + 1)
    depth = CubicHermiteSpline(history.time, history.depth, history.velocity)(time)
    modulus = scene.contact_modulus
    if modulus.viscosity:
        return np.asarray(depth[-1] * np.exp(-modulus.equilibrium / modulus.viscosity * later))
    load = convolution.force(modulus.operational, float(time[1]), np.concatenate([[0.0], depth[1:]]))
    load[-1] = 0.0  # nothing presses any more, which the path tells to its own accuracy only
    return crept(modulus, time, load, time[-1] + later)


def test_random_impacts_leave_what_tings_path_leaves(campaign_size: Callable[[int], int], random_impact: Impact) -> None:
    rng, ratios = np.random.default_rng(SEED), []
    for number in range(campaign_size(IMPACTS)):
        scene = random_impact(rng, number)
        left = fe_contact.run(scene, tolerance=1e-3).recovery
        assert (left is None) == scene.contact_modulus.is_elastic
        if left is None:
            continue
        rows = np.r_[0:25:6]
        later = np.maximum(left.time[rows], 1e-6 * left.time[-1])
        exact = tings(scene, later, FINER * PATH)
        unsure = np.abs(exact - tings(scene, later, PATH))
        assert np.all(unsure <= 0.3 * left.error[rows])
        ratios.append(np.abs(left.depth[rows] - exact) / left.error[rows])
    print(np.round(ratios, 4))
    assert np.max(ratios) <= 1.0


@pytest.mark.parametrize("law", ["prony", "maxwell"])
def test_the_creep_under_the_pressure_on_the_axis_ends_where_the_path_does(law: str, scene_of: Scenes) -> None:
    material = PRONY if law == "prony" else {"law": "maxwell", "E": 3e6, "eta": 6e3}
    scene = scene_of(material)
    solved = solve(scene, {"tolerance": 1e-3})
    weights = half_space.surface(scene.material.nu, solved.numerics).operator.weights
    snapshots = solved.certified.march.snapshots
    # a pressure lifts the axis by 2/E* int p dr, Johnson (1985) Contact Mechanics (3.96a)
    lifts = [float((weights * s.contact_radius**2 * s.pressure) @ (1 / (np.pi * s.radii))) for s in snapshots]
    time = np.array([0.0, *(s.time for s in snapshots), solved.certified.curve.duration])
    later = solved.certified.curve.duration * np.array([0.01, 0.3, 2.0])
    by_pressure = crept(scene.contact_modulus, time, np.array([0.0, *lifts, 0.0]), time[-1] + later)
    print(by_pressure / recovery_of(solved.certified.curve)(later) - 1)
    assert recovery_of(solved.certified.curve)(later) == pytest.approx(by_pressure, rel=3e-3)


def test_at_separation_the_axis_is_where_the_striker_leaves_it(scene_of: Scenes) -> None:
    result = fe_contact.run(scene_of(PRONY), tolerance=1e-3)
    assert result.recovery is not None
    left = result.recovery
    assert left.depth[0] == pytest.approx(result.history.depth[-1], abs=left.error[0])
    assert left.error[0] < 0.01 * left.depth[0]
    assert np.all(np.diff(left.depth) < 0.0)
    assert left.depth[-1] == pytest.approx(0.01 * left.depth[0], rel=1e-6)


def test_a_solid_that_hardly_relaxes_leaves_in_proportion(scene_of: Scenes) -> None:
    residual = []
    for share in (1e-3, 1e-4):
        material = {"law": "prony", "E_inf": 1e6, "E": [share * 1e6], "tau": [1e-3]}
        left = fe_contact.run(scene_of(material), tolerance=1e-3).recovery
        assert left is not None
        residual.append(left.depth[0])
    assert residual[0] / residual[1] == pytest.approx(10.0, rel=5e-3)


def test_a_maxwell_fluid_keeps_its_dent(scene_of: Scenes) -> None:
    left = fe_contact.run(scene_of({"law": "maxwell", "E": 3e6, "eta": 6e3}), tolerance=1e-3).recovery
    assert left is not None
    assert left.time.tolist() == [0.0]
    assert left.permanent == pytest.approx(left.depth[0], rel=1e-12)


def test_run_writes_the_course_and_says_it_in_the_result(tmp_path: Path) -> None:
    assert main(["run", "polymer-sphere", "--out", str(tmp_path), "--quiet"]) == 0
    said = json.loads((tmp_path / "result.json").read_text())["recovery"]
    rows = np.genfromtxt(tmp_path / "recovery.csv", delimiter=",", names=True)
    assert rows["depth_m"].tolist() == said["depth"]
    assert rows["time_after_separation_s"][0] == 0.0
    assert rows["depth_m"][0] == said["residual_depth"]["value"]
    assert said["retardation_times"] == pytest.approx([0.01], rel=1e-9)  # R2 = C1/E1 of the scene


@pytest.mark.parametrize("method", ["fe", "ting"])
def test_what_has_no_course_writes_none(method: str, tmp_path: Path) -> None:
    scene = "steel-ball" if method == "fe" else "polymer-sphere"
    assert main(["run", scene, "--method", method, "--out", str(tmp_path), "--quiet"]) == 0
    assert not (tmp_path / "recovery.csv").exists()
    assert json.loads((tmp_path / "result.json").read_text())["recovery"] is None
