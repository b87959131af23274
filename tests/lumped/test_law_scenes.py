"""Scene files with a law of their own: every key, every fault with its cure, and scenes with geometry beside it."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from lumped import BadInput, Motion, Result, Scene, laws, simulate
from lumped.laws import correspondence, mdr
from lumped.scene.tables import LawChoice, read

BARE: dict[str, Any] = {
    "striker": {"mass": 1.0, "velocity": 1.0},
    "law": {"name": "jankowski", "k": 1e6, "e": 0.6, "alpha": 1.4, "gap": 1e-12, "exit": "force"},
}
FORCE_LAWS = sorted(set(laws.available()) - {"correspondence", "ting", "mdr", "rod_waves", "bar_waves"})
DAMPED = [name for name in FORCE_LAWS if "e" in laws.get(name).keys]


def changed(**law: Any) -> dict[str, Any]:
    table = copy.deepcopy(BARE)
    table["law"] = {key: value for key, value in {**table["law"], **law}.items() if value is not None}
    return table


def of_law(name: str, **values: Any) -> dict[str, Any]:
    return {"striker": dict(BARE["striker"]), "law": {"name": name, **values}}


def faults(table: dict[str, Any]) -> str:
    with pytest.raises(BadInput) as caught:
        read(Scene, table, "scene.toml")
    return str(caught.value)


def test_a_law_alone_is_a_scene_and_comes_back_from_its_tables() -> None:
    scene, _ = read(Scene, {**BARE, "target": {"mass": 3.0}}, "scene.toml")
    assert scene.reduced_mass == pytest.approx(0.75, rel=1e-15)
    assert not scene.has_geometry
    again = Scene.from_dict(scene.to_dict())
    assert again.law == scene.law
    assert again.to_dict() == scene.to_dict()


@pytest.mark.parametrize("name", FORCE_LAWS)
def test_every_key_of_a_law_is_read(name: str) -> None:
    """Each value reaches the law, or something that it has computed from it."""
    keys, k = laws.get(name).keys, {"k": 1e6}
    bare = read(Scene, of_law(name, **k, **({"e": 0.5} if "e" in keys else {})), "scene.toml")[0]
    before = laws.get(name).of(bare).parameters
    values = {"k": 2e6, "alpha": 1.7, "gap": 1e-3, "exit": "depth", "e": 0.7}
    for key, value in values.items():
        if key in keys:
            table = of_law(name, **{**k, **({"e": 0.5} if "e" in keys else {}), key: value})
            assert laws.get(name).of(read(Scene, table, "scene.toml")[0]).parameters != before, key


@pytest.mark.parametrize("name", [name for name in FORCE_LAWS if "damping" in laws.get(name).keys])
def test_a_formula_is_for_e_and_no_other_damping(name: str) -> None:
    formula = laws.get(name).keys["damping"].kind.options[-1]
    read(Scene, of_law(name, k=1e6, e=0.9, damping=formula), "scene.toml")
    assert "law.damping" in faults(of_law(name, k=1e6, e=0.9, damping="guess"))
    own = set(laws.get(name).keys) & {"xi", "c", "chi", "A", "alpha_t"}
    for key in own:
        assert "accepted: e with it" in faults(of_law(name, k=1e6, damping=formula, **{key: 0.1}))


def test_two_dampings_are_one_too_many() -> None:
    assert "law.xi: e, xi are given; accepted: one of e or xi" in faults(changed(xi=0.3))


def test_a_damped_law_without_damping_says_what_it_takes() -> None:
    assert "law.xi: missing; accepted: the damping: one of e or xi" in faults(changed(e=None))


def test_a_law_without_stiffness_and_geometry_says_what_it_takes() -> None:
    said = faults(changed(k=None))
    assert "law.k: missing" in said
    assert "a scene with shape and material" in said


@pytest.mark.parametrize(
    ("key", "value"),
    [("k", -1.0), ("k", 0.0), ("k", math.nan), ("e", 0.0), ("e", 1.2), ("alpha", 0.7), ("alpha", 6.0), ("gap", -1e-3)],
)
def test_numbers_out_of_range_name_their_key(key: str, value: float) -> None:
    assert f"law.{key}: " in faults(changed(**{key: value}))


def test_an_unknown_key_names_the_nearest() -> None:
    assert "did you mean alpha?" in faults(changed(alfa=1.5))


def test_an_unknown_law_names_the_nearest() -> None:
    assert "did you mean jankowski?" in faults(changed(name="jankovski"))


def test_a_law_alone_has_no_inertia_of_bodies() -> None:
    assert "model.inertia" in faults({**BARE, "model": {"inertia": True}})


def test_a_law_alone_has_no_body_that_is_strained() -> None:
    found = faults({**BARE, "model": {"kinematics": "finite"}})
    assert (
        found == "scene.toml: model.kinematics: finite: a law of its own has no body that is strained; accepted: small"
    )


@pytest.mark.parametrize("name", ["ting", "mdr", "correspondence"])
def test_a_law_of_the_half_space_needs_one(name: str) -> None:
    assert "shape" in faults(of_law(name))


@pytest.mark.parametrize("name", ["ting", "mdr"])
def test_a_law_of_one_impact_follows_no_more(name: str, impact: Callable[..., Scene]) -> None:
    table = impact(0.5, (0.5,), (1.0,)).to_dict()
    table["motion"]["impacts"] = 2
    table["law"] = {"name": name}
    with pytest.raises(BadInput, match=r"motion\.impacts"):
        simulate(laws.get(name).of(read(Scene, table)[0]), read(Scene, table)[0], 1e-3)


def test_the_bilinear_loop_takes_its_three_numbers_together() -> None:
    loop = {"k1": 3e6, "k2": 1e6, "yield_depth": 1e-3}
    read(Scene, of_law("impact_bilinear", **loop), "scene.toml")
    assert "law.yield_depth: missing" in faults(of_law("impact_bilinear", k1=3e6, k2=1e6))
    assert "law.k2" in faults(of_law("impact_bilinear", **{**loop, "k2": 4e6}))
    assert "either, not both" in faults(of_law("impact_bilinear", **loop, e=0.5))


@pytest.mark.parametrize("name", FORCE_LAWS)
def test_a_law_takes_what_it_needs_from_geometry_and_material(name: str, impact: Callable[..., Scene]) -> None:
    """Its stiffness from Hertz' impact with the relaxed modulus, its restitution from the exact law."""
    scene = impact(0.5, (0.5,), (1.0,))
    exact = simulate(laws.get("mdr").of(scene), scene, 1e-4).quantities["restitution"].value
    found = simulate(laws.get(name).of(scene), scene, 1e-6)
    damped = "e" in laws.get(name).keys
    assert found.quantities["restitution"].value == pytest.approx(exact if damped else 1.0, abs=1e-6)
    assert found.history.contact_radius.max() > 0.0
    assert "Hertz" in found.message


@pytest.mark.parametrize("name", [name for name in FORCE_LAWS if name != "impact_bilinear"])
def test_undamped_and_of_geometry_every_law_peaks_as_hertz_does(name: str, impact: Callable[..., Scene]) -> None:
    scene = impact(1.0)
    hertz = scene.geometry.shape.hertz_impact(scene.contact_modulus.relaxed, scene.mass, scene.velocity)
    found = simulate(laws.get(name).of(scene), scene, 1e-6).quantities
    assert found["peak_force"].value == pytest.approx(hertz.force, rel=1e-9)
    assert found["restitution"].value == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("name", FORCE_LAWS)
def test_a_fixed_contact_area_has_a_restitution_to_take_too(name: str) -> None:
    material = {"law": "sls", "E1": 1.8e6, "E2": 0.9e6, "C1": 1.8e3, "nu": 0.45}
    striker = {"shape": "punch", "radius": 0.005, "mass": 0.01, "velocity": 0.1}
    scene, _ = read(Scene, {"striker": striker, "target": {"shape": "half_space", "material": material}})
    exact = simulate(laws.get("correspondence").of(scene), scene, 1e-6).quantities["restitution"].value
    found = simulate(laws.get(name).of(scene), scene, 1e-6).quantities["restitution"].value
    assert found == pytest.approx(exact if "e" in laws.get(name).keys else 1.0, abs=1e-6)


@pytest.mark.parametrize("name", DAMPED)
def test_several_impacts_on_a_material_take_the_restitution_of_one(name: str, impact: Callable[..., Scene]) -> None:
    once = impact(0.5, (0.5,), (1.0,))
    expected = laws.get(name).of(once).parameters
    assert laws.get(name).of(replace(once, motion=Motion(impacts=3))).parameters == expected


def test_the_bilinear_loop_of_a_cone_is_fitted_to_the_cone_s_exponent() -> None:
    """Given e, a scene's loop is the one of the same k and alpha given by themselves: 2 for a cone, Table 1."""
    cone = replace(Scene.load("polymer-cone"), law=LawChoice("impact_bilinear", {"e": 0.6}))
    k = laws.hertz.of(replace(cone, law=None)).k
    alone = Scene(None, cone.mass, cone.velocity, law=LawChoice("impact_bilinear", {"k": k, "alpha": 2.0, "e": 0.6}))
    loop, expected = (laws.impact_bilinear.of(scene) for scene in (cone, alone))
    for key in ("k1", "k2", "yield_depth"):
        assert getattr(loop, key) == pytest.approx(getattr(expected, key), rel=1e-12)


@pytest.mark.parametrize("velocity", [0.1, 5.0])
def test_impacts_asked_for_are_waited_for(velocity: float) -> None:
    """A flight of 2 v/g lasts hundreds of contacts of a stiff body."""
    table = {
        "striker": {"mass": 0.4, "velocity": velocity},
        "law": {"name": "jankowski", "k": 1e10, "e": 0.9},
        "model": {"gravity": 9.81},
        "motion": {"impacts": 4},
    }
    scene, _ = read(Scene, table)
    bouncing = laws.jankowski.of(scene).simulate(scene, 1e-6)
    assert len(bouncing.contacts) == 4
    assert not bouncing.message
    scene, _ = read(Scene, {**table, "model": {}})
    leaving = laws.jankowski.of(scene).simulate(scene, 1e-6)
    assert len(leaving.contacts) == 1
    assert leaving.message.startswith("1 of 4 impacts")


def test_laws_that_take_their_restitution_from_the_material_ask_the_exact_law_once(
    impact: Callable[..., Scene], monkeypatch: pytest.MonkeyPatch
) -> None:
    """However many of them are compared on a scene, whichever of them the scene names."""
    scene, asked = impact(0.31, (0.69,), (0.73,)), list[Scene]()

    def counted(law: mdr.SpringRow, scene: Scene, tolerance: float) -> Result:
        asked.append(scene)
        return original(law, scene, tolerance)

    original = mdr.SpringRow.simulate
    monkeypatch.setattr(mdr.SpringRow, "simulate", counted)
    made = [laws.get(name).of(one) for name in DAMPED for one in (scene, replace(scene, law=LawChoice(name, {})))]
    assert len(made) == 2 * len(DAMPED) > 10
    assert len(asked) == 1


def test_the_correspondence_law_leaves_out_what_a_scene_says_that_it_does() -> None:
    """That no surface pulls or recovers, where the scene's own law lets it; else that a contact shrinks otherwise."""
    name = "polymer-sphere"
    pulls, usual, other = (
        Scene.load(name, {"law": law})
        for law in ({"name": "correspondence", "exit": "depth"}, {"name": "correspondence"}, {"name": "ting"})
    )
    assert "pulls" in correspondence.leaves_out(pulls)
    assert "shrinks otherwise" in correspondence.leaves_out(usual)
    assert correspondence.leaves_out(usual) == correspondence.leaves_out(other)
