"""The larger models of a ledger: measured as exact laws find them, and chosen no larger than a scene needs."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import pytest

from fe_contact.cli import main
from fe_contact.reference import plan
from fe_contact.studies.larger_models import MeasuredEffect, measure, sufficient
from lumped import Scene, laws, simulate

BULK = {"target.material.constant": "bulk"}


def test_what_is_measured_is_what_an_exact_law_finds() -> None:
    """A half-space knows its material by E*(t) alone, so that Ting's law follows either constant."""
    scene = Scene.load("steel-ball-sls", {"target.material.R2": 1e-4})
    answers = [simulate(laws.get("ting").of(one), one, 1e-5) for one in (scene, scene.changed(BULK))]
    peaks = [answer.quantities["peak_force"].value or math.nan for answer in answers]
    (found,) = measure(scene, {"tolerance": 1e-2})
    assert found.setting == "target.material.constant=bulk"
    assert found.change is not None
    assert found.error is not None
    assert abs(found.change - (peaks[1] / peaks[0] - 1.0)) <= found.error < 0.05 * abs(found.change)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-2, 1e-1])
def test_the_sufficient_model_takes_what_exceeds_the_tolerance_and_nothing_else(tolerance: float) -> None:
    given = {"tolerance": tolerance}
    relaxes: dict[str, object] = {"E2": 2e6, "C1": 1e6, "density": 2000.0}
    keys = {f"target.material.{key}": value for key, value in relaxes.items()}
    scene = Scene.load("polymer-cone", {**keys, "model.profile": "parabola"})
    found = sufficient(scene, given)
    before = {entry.effect for entry in plan(scene, given).ledger if entry.exceeds(tolerance)}
    after = {entry.effect for entry in plan(found.scene, given).ledger if entry.exceeds(tolerance)}
    assert after == set(found.left)
    assert {entry.effect for entry in found.taken} <= before
    assert ("no far field follows" in found.left.get("target inertia", "")) is (tolerance == 1e-3)
    assert (found.scene.geometry.material.constant == "bulk") is (tolerance < 1e-1)


def test_large_strains_in_which_a_material_softens_are_not_taken_in() -> None:
    """Neo-Hooke, where nu is negative, gathers strains in bands: a run could not follow the cone to its depth."""
    material = {"law": "elastic", "E": 4.4e9, "nu": -0.88}
    striker = {"shape": "cone", "angle": 14.0, "mass": 0.45, "velocity": 0.27}
    scene = Scene.from_dict({"striker": striker, "target": {"shape": "half_space", "material": material}})
    found = sufficient(scene, {"tolerance": 1e-2})
    assert found.scene is scene
    assert "cannot be taken in: from a depth of" in found.left["finite strain"]


def test_a_scene_that_needs_nothing_stays_as_it_is() -> None:
    scene = Scene.load("steel-ball")
    found = sufficient(scene, {})
    assert found.scene is scene
    assert str(found).startswith("the model is the scene's own; finite strain is open: St Venant-Kirchhoff to Hencky")
    decided = scene.changed({"target.material.hyperelastic": "neo_hooke"})
    assert str(sufficient(decided, {"tolerance": 1e-2})) == "the model is the scene's own"


def test_an_effect_without_a_model_is_named() -> None:
    found = sufficient(Scene.load("polymer-punch"), {"tolerance": 0.03})
    said = "about 3.9 % of the peak force, no larger model here: radiates 0.13 of the kinetic energy"
    assert found.left == {"target inertia": said}


@pytest.mark.parametrize("name", ["steel-ball", "polymer-layer"])
def test_a_body_that_yields_is_taken_in_where_that_is_built(name: str) -> None:
    own = Scene.load(name)
    strength = 1e9 if name == "steel-ball" else 1e4
    found = sufficient(own.changed({"target.material.yield_strength": strength}), {"tolerance": 0.02})
    assert found.scene.model.plasticity is (name == "steel-ball")
    for entry in found.taken:
        said = str(found).partition(f"{entry.effect} ({entry.setting}), estimated ")[2]
        assert entry.line(0.02).partition("): ")[2].startswith(f"{said.partition(' %')[0]} %, above the tolerance")
    if not found.scene.model.plasticity:
        assert "no viscosity with model.plasticity in this version; accepted: elastic" in found.left["plasticity"]


def test_run_says_which_effects_it_takes_in(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["run", "polymer-sphere", "--method", "ting", "--tolerance", "1e-2", "--quiet"]
    words += ["--set", "target.material.C1=1e6"]
    assert main([*words, "--out", str(tmp_path / "given")]) == 0
    assert "takes in" not in capsys.readouterr().out
    assert main([*words, "--out", str(tmp_path / "larger"), "--model", "sufficient"]) == 0
    assert (
        "takes in constant nu against constant bulk modulus (target.material.constant=bulk)" in capsys.readouterr().out
    )
    results = [json.loads((tmp_path / name / "result.json").read_text()) for name in ("given", "larger")]
    assert [result["model_sufficient"] for result in results] == [False, True]


def test_a_law_that_leaves_out_what_is_taken_in_is_refused(refused: Callable[..., list[str]]) -> None:
    yields = ["--set", "target.material.yield_strength=1e9", "--tolerance", "0.02", "--model", "sufficient"]
    (line,) = refused("run", "steel-ball", "--method", "hertz", *yields)
    assert "--model" in line
    assert "model.plasticity, which hertz leaves out; accepted: --method fe" in line


def test_a_law_alone_has_no_larger_model(refused: Callable[..., list[str]]) -> None:
    (line,) = refused("run", "paper-steel-hertz", "--model", "sufficient")
    assert line.endswith(
        "--model: sufficient: there are larger models of a shape and a material, and the scene has a "
        "law alone; accepted: given"
    )


def test_what_is_measured_is_said_in_the_unit_of_the_ledger() -> None:
    yields = MeasuredEffect("plasticity", "model.plasticity=true", 0.28, -0.24, 0.02)
    assert str(yields) == "plasticity (model.plasticity=true): estimate 28 % | measured -24 % +- 2 %"
    strained = MeasuredEffect("finite strain", "", None, 0.01, 0.004, spread=(-0.035, 0.0038))
    assert str(strained).startswith("finite strain: estimate -3.5 % to +0.38 % | measured +1 % +- 0.4 %, by ")


@pytest.mark.tenth
def test_plan_measures_where_asked(capsys: pytest.CaptureFixture[str]) -> None:
    slow = ["--set", "target.material.C1=1e6"]
    assert main(["plan", "polymer-sphere", "--tolerance", "1e-2", "--measure", "--json", *slow]) == 0
    content = json.loads(capsys.readouterr().out)
    finite, found = content["measured"]
    assert finite["setting"] == "model.kinematics=finite"
    (entry,) = (one for one in content["model_ledger"] if one["effect"] == "finite strain")
    low, high = entry["spread"]
    assert low - finite["error"] <= finite["change"] <= high + finite["error"]
    assert found["setting"] == "target.material.constant=bulk"
    assert found["change"] == pytest.approx(-found["estimate"], rel=0.2)


STEEP = """
name = "steep"
striker = { shape = "cone", angle = 38.0, mass = 0.05, velocity = 0.03 }
target.shape = "layer"
target.thickness = 3e-3
target.base = "bonded"
target.material = { law = "elastic", E = 6e5, nu = 0.3, hyperelastic = "neo_hooke" }
"""


def test_large_strains_without_an_equilibrium_are_left_out_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Under a steep tip the surface folds, however shallow the contact: the scene's own model answers."""
    (tmp_path / "steep.toml").write_text(STEEP, encoding="utf-8")
    words = ["run", str(tmp_path / "steep.toml"), "--model", "sufficient", "--tolerance", "1e-2", "--quiet"]
    assert main([*words, "--out", str(tmp_path / "it")]) == 0
    (line,) = [one for one in capsys.readouterr().out.splitlines() if "finite strain is left out" in one]
    assert "the model is the scene's own" in line
    assert "of the peak force, and cannot be taken in: no equilibrium" in line
    assert line.endswith("cure: a blunter striker, or another target.material.hyperelastic")
    found = json.loads((tmp_path / "it" / "result.json").read_text())
    assert found["converged"]
    assert not found["model_sufficient"]
    assert found["model"]["kinematics"] == "small"
