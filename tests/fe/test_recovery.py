"""The indentation left on the axis: within its bars of Ting's path, and of the creep under the pressure on it.

The references take no modes: differential equations on the one path, creep inverted from 1/E(s) on the other.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline

import fe_contact
import lumped
from fe_contact.cli import main
from fe_contact.reference import _Axis, solve
from fe_contact.targets import half_space
from lumped.laws import ting
from lumped.materials import Relaxation
from lumped.materials.laplace import inverse

Scenes = Callable[..., lumped.Scene]
Impact = Callable[[np.random.Generator, int], lumped.Scene]

IMPACTS, SEED = 60, 83
PRONY = {"law": "prony", "E_inf": 1e6, "E": [2e6, 1e6], "tau": [0.3e-3, 4e-3]}


def crept(relaxation: Relaxation, time: np.ndarray, load: np.ndarray, later: np.ndarray) -> np.ndarray:
    """int J(t - s) dw(s) at ``later`` times for a load w over ascending times, straight between them."""
    middles, rises = 0.5 * (time[1:] + time[:-1]), np.diff(load)
    creep = inverse(lambda s: 1.0 / (relaxation.operational(s) * s), later[:, None] - middles).value
    return np.asarray(creep @ rises)


def tings(scene: lumped.Scene, later: np.ndarray) -> np.ndarray:
    """The axis at ascending times after separation, from Ting's path, by the equations of springs and dashpots."""
    history = lumped.simulate(ting.of(scene), scene, 1e-7).history
    path, end = CubicHermiteSpline(history.time, history.depth, history.velocity), float(history.time[-1])
    modulus = scene.contact_modulus
    moduli, taus = np.array(modulus.moduli), np.array(modulus.times)

    def strain(state: np.ndarray) -> float:
        return float(state[0] if modulus.viscosity else moduli @ state[1:] / modulus.glassy)

    def free(_: float, state: np.ndarray) -> np.ndarray:
        now, flowed = strain(state), state[1:]
        pull = modulus.equilibrium * now + moduli @ (now - flowed)
        return np.concatenate([[-pull / modulus.viscosity if modulus.viscosity else 0.0], (now - flowed) / taus])

    precise = {"method": "Radau", "rtol": 1e-9, "atol": 1e-12 * float(history.depth.max())}
    flowed = solve_ivp(lambda t, y: (path(t) - y) / taus, (0.0, end), np.zeros(taus.size), **precise).y[:, -1]
    start = np.concatenate([[path(end)], flowed])
    return np.array([strain(y) for y in solve_ivp(free, (0.0, later[-1]), start, t_eval=later, **precise).y.T])


@pytest.mark.tenth
def test_random_impacts_leave_what_tings_path_leaves(campaign_size: Callable[..., int], random_impact: Impact) -> None:
    rng, ratios = np.random.default_rng(SEED), []
    for number in range(campaign_size(IMPACTS, least=3)):
        scene = random_impact(rng, number)
        result = fe_contact.run(scene, tolerance=1e-3)
        left = result.recovery
        assert (left is None) == scene.contact_modulus.is_elastic
        if left is None:
            continue
        rows = np.r_[0:25:6]
        ratios.append(np.abs(left.depth[rows] - tings(scene, left.time[rows])) / left.error[rows])
        assert left.error[0] <= 1e-3 * (result.quantities["peak_depth"].value or 0.0)
    assert np.max(ratios) <= 1.0


@pytest.mark.family
@pytest.mark.parametrize(
    "profile",
    [
        {"shape": "cone", "angle": 4.0},
        {"shape": "power", "coefficient": 900.0, "exponent": 3.0},
        {"shape": "punch", "radius": 0.004},
    ],
)
def test_other_profiles_leave_what_tings_path_leaves(profile: dict[str, object]) -> None:
    striker = {"mass": 0.02, "velocity": 0.2} | profile
    target = {"shape": "half_space", "material": PRONY | {"nu": 0.3}}
    scene = lumped.Scene.from_dict({"name": "profile", "striker": striker, "target": target})
    left = fe_contact.run(scene, tolerance=1e-3).recovery
    assert left is not None
    assert np.all(np.abs(left.depth - tings(scene, left.time)) <= left.error)
    assert left.error[0] < 5e-3 * left.depth[0]


@pytest.mark.parametrize("law", ["prony", "maxwell"])
def test_the_creep_under_the_pressure_on_the_axis_ends_where_the_path_does(law: str, scene_of: Scenes) -> None:
    material = PRONY if law == "prony" else {"law": "maxwell", "E": 3e6, "eta": 6e3}
    scene = scene_of(material)
    solved = solve(scene, {"tolerance": 1e-3})
    weights = half_space.surface(scene.material.nu, solved.certified.numerics).operator.weights
    snapshots = solved.certified.march.snapshots
    # a pressure lifts the axis by 2/E* int p dr, Johnson (1985) Contact Mechanics (3.96a)
    lifts = [float((weights * s.contact_radius**2 * s.pressure) @ (1 / (np.pi * s.radii))) for s in snapshots]
    time = np.array([0.0, *(s.time for s in snapshots), solved.certified.curve.duration])
    later = solved.certified.curve.duration * np.array([0.01, 0.3, 2.0])
    by_pressure = crept(scene.contact_modulus, time, np.array([0.0, *lifts, 0.0]), time[-1] + later)
    axis = _Axis(solved.certified.curve)
    assert axis.after(axis.path)(later) == pytest.approx(by_pressure, rel=3e-3)


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


@pytest.mark.parametrize("tau", [1e-15, 1e-9, 1e5, 1e14])
def test_relaxation_of_any_speed_has_a_course(tau: float, scene_of: Scenes) -> None:
    material = {"law": "prony", "E_inf": 1e6, "E": [1e6, 1e-9, 1e3], "tau": [tau, 2 * tau, 3 * tau]}
    result = fe_contact.run(scene_of(material), tolerance=1e-3)
    left = result.recovery
    assert left is not None
    assert np.all(np.diff(left.time) > 0.0)
    assert left.time[-1] == pytest.approx(np.log(100.0) * 2.0 * tau, rel=0.01)  # of a branch as stiff as the rest
    if tau > 1.0:  # dashpots hardly notice: what they take over is the path's integral over tau
        taken = 0.5 * np.trapezoid(result.history.depth, result.history.time) / tau
        assert left.depth[0] == pytest.approx(taken, rel=2e-3)
        assert left.error[0] < 2e-3 * left.depth[0]


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
