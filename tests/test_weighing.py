"""Methods weighed: exact laws of the same model alone are taken, one path serves run and plan, and reasons are said."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from fe_contact import methods
from fe_contact.cli import main
from fe_contact.methods import exact_laws, lines_of, simulate, weigh, why_not
from fe_contact.reference import expected, fe
from lumped import laws
from lumped.scene.scene import Scene
from lumped.schema.files import SCENES

ELASTIC = {"law": "elastic", "E": 1e6, "nu": 0.45, "density": 1000.0}
TWICE = {"motion.impacts": 2, "model.gravity": 2.0}


@pytest.mark.family
@pytest.mark.parametrize(
    ("name", "overrides", "method"),
    [
        ("polymer-prism", TWICE, "correspondence"),  # the same area, whatever it remembers between two contacts
        ("polymer-sphere", {"model.gravity": 0.5}, "ting"),
        ("ball-bouncing", {"target.material": ELASTIC, "motion.impacts": 2}, "correspondence"),
        ("bar", {}, "bar_waves"),
        ("rod", {}, "rod_waves"),
        ("polymer-punch", {}, "correspondence"),
        ("polymer-sphere", {"target.material.constant": "bulk"}, "ting"),
    ],
)
def test_the_law_that_is_taken_answers_as_finite_elements_do(name: str, overrides: dict[str, Any], method: str) -> None:
    """Within both bars in every quantity, and contact by contact: another model would not."""
    scene = Scene.load(name, overrides)
    found = weigh(scene, {"tolerance": 1e-4})
    assert found.taken.method == method
    assert found.answer is not None
    reference = fe(scene, {"tolerance": 0.1})
    for key, quantity in found.answer.quantities.items():
        other = reference.quantities[key]
        if key not in ("peak_time", "history_l2"):  # a peak may be as high elsewhere
            assert quantity.value == pytest.approx(other.value, abs=(quantity.error or 0.0) + (other.error or 0.0)), key
    assert len(found.answer.contacts) == (scene.motion.impacts if scene.motion.impacts > 1 else 0)


@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("steel-ball-waves", {}),  # inertia
        ("ball-bouncing", {}),  # a surface that remembers the contact before
        ("polymer-layer", {"target.material.constant": "bulk"}),  # no load curve
        ("polymer-prism-waves", {}),  # waves that disperse
        ("polymer-plate", {}),  # free sides between held faces
    ],
)
def test_a_law_of_another_model_is_never_taken(name: str, overrides: dict[str, Any]) -> None:
    scene = Scene.load(name, overrides)
    assert exact_laws(scene) == ()
    found = weigh(scene, {})
    assert found.answer is None
    assert found.taken.method == "fe"
    assert (found.taken.bar, found.taken.cpu_s) == (expected(scene, {})[0], methods.LOADING + expected(scene, {})[1])
    assert {one.method for one in found.methods} == {"fe", *laws.available()}
    assert all(one.reason for one in found.methods)


def test_a_striker_that_gravity_holds_is_beyond_laws_of_one_approach() -> None:
    """They say so, and have no bar; finite elements follow it."""
    found = weigh(Scene.load("polymer-sphere", {"model.gravity": 9.81}), {"tolerance": 1e-2})
    assert found.taken.method == "fe"
    said = {one.method: one for one in found.methods}
    for name in ("ting", "mdr"):
        assert said[name].bar is None
        assert "approaches again" in said[name].reason
        assert "cure: --method fe" in said[name].reason


def test_a_law_with_choices_of_its_own_is_another_model() -> None:
    """Correspondence is exact for a punch, but not where its surface pulls."""
    own = {"name": "correspondence", "exit": "depth"}
    assert why_not(Scene.load("polymer-punch"), "correspondence") == ""
    assert "pulls" in why_not(Scene.load("polymer-punch", {"law": own}), "correspondence")


def test_the_next_law_is_asked_where_the_first_one_misses_the_tolerance(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fake Ting that never meets it: its bar is said, and the row of springs taken; two such, finite elements."""
    original, inexact = methods._lumped, ["ting"]

    def lumped(scene: Scene, name: str, given: dict[str, Any], progress: Any) -> Any:
        found = original(scene, name, given, progress)
        if name not in inexact:
            return found
        wide = {key: replace(one, error=0.5 * abs(one.value or 1.0)) for key, one in found.quantities.items()}
        return replace(found, converged=False, quantities=wide, message="too coarse")

    monkeypatch.setattr(methods, "_lumped", lumped)
    scene = Scene.load("polymer-sphere")
    found = weigh(scene, {"tolerance": 1e-3})
    assert [one.method for one in found.methods[:3]] == ["ting", "mdr", "fe"]
    assert found.methods[0].bar == 0.5
    assert "too coarse" in found.methods[0].reason
    assert found.taken.method == "mdr"
    inexact.append("mdr")
    assert weigh(scene, {"tolerance": 1e-3}).taken.method == "fe"


def test_run_and_plan_say_the_same_of_every_method(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", "polymer-sphere", "--json"]) == 0
    planned = json.loads(capsys.readouterr().out)
    assert main(["run", "polymer-sphere", "--method", "cheapest", "--out", str(tmp_path), "--quiet"]) == 0
    printed = capsys.readouterr().out
    content = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    assert content["weighed"] == planned["weighed"]
    assert content["method"] == planned["method"]["name"] == "ting"
    for line in lines_of(content["weighed"]):
        assert f"weighed: {line}" in printed
    assert main(["run", "polymer-sphere", "--method", "ting", "--out", str(tmp_path), "--quiet"]) == 0
    assert json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))["weighed"] == []


def test_where_no_law_is_exact_the_answer_is_that_of_finite_elements() -> None:
    scene = Scene.load("polymer-plate")
    found, reference = simulate(scene, "cheapest", {}), fe(scene, {})
    assert found.method == "fe"
    assert found.quantities == reference.quantities
    assert [one["method"] for one in found.weighed if one["taken"]] == ["fe"]


def test_every_packaged_scene_has_one_method_and_exact_laws_in_order_of_cost() -> None:
    for name in SCENES.names:
        scene = Scene.load(name)
        exact = exact_laws(scene)
        assert [laws.get(one).seconds for one in exact] == sorted(laws.get(one).seconds for one in exact)
        assert all(one.seconds < methods.LOADING for one in map(laws.get, exact))
        if scene.has_geometry and exact and scene.motion.impacts > 1:
            assert scene.contact_modulus.is_elastic
