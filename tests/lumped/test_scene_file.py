"""Scene files: the packaged ones, every fault at once, and nothing but BadInput for bad values."""

from __future__ import annotations

import copy
import json
import math
import re
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumped import BadInput, Scene
from lumped.scene.tables import load, read
from lumped.schema.files import SCENES, parse_assignment
from lumped.shapes.prism import Prism
from lumped.targets.plane import Plane

SOLID: dict[str, Any] = {
    "name": "try",
    "striker": {"shape": "sphere", "radius": 0.006, "mass": 0.05, "velocity": 0.02},
    "target": {
        "shape": "half_space",
        "material": {"law": "sls", "E0": 6e5, "R1": 0.5, "R2": 0.01, "nu": 0.45, "density": 1000.0},
    },
    "model": {"inertia": False, "profile": "exact", "gravity": 0.0},
    "motion": {"impacts": 1, "end_time": 0.5},
}
NUMBERS = [
    "striker.radius",
    "striker.mass",
    "striker.velocity",
    "target.material.E0",
    "target.material.R1",
    "target.material.R2",
    "target.material.nu",
    "target.material.density",
    "model.gravity",
    "motion.impacts",
    "motion.end_time",
]
WORDS = ["name", "striker.shape", "target.shape", "target.material.law", "model.profile"]
TABLES = ["striker", "target", "target.material", "model", "motion", "numerics"]
no_numbers = st.sampled_from(
    [math.nan, math.inf, -math.inf, True, "1", "", None, [], [1.0], {}, 1e300, -1e300, 10**400]
)


def changed(key: str, value: object) -> dict[str, Any]:
    table = copy.deepcopy(SOLID)
    *path, last = key.split(".")
    place = table
    for part in path:
        place = place[part]
    place[last] = value
    return table


def faults(table: dict[str, Any]) -> list[str]:
    with pytest.raises(BadInput) as caught:
        read(Scene, table, "scene.toml")
    assert caught.value.exit_code == 2
    return [str(fault) for fault in caught.value.faults]


def test_good_table_makes_the_scene() -> None:
    scene, numerics = read(Scene, {**SOLID, "numerics": {"tolerance": 1e-4}}, "scene.toml")
    assert (scene.name, scene.mass, scene.velocity, scene.material.nu) == ("try", 0.05, 0.02, 0.45)
    assert numerics == {"tolerance": 1e-4}
    assert Scene.from_dict(scene.to_dict()).to_dict() == scene.to_dict()


def test_packaged_scenes_hold_the_published_numbers() -> None:
    assert {"steel-ball", "steel-ball-sls", "polymer-sphere"} <= set(SCENES.names)
    ball, solid, polymer = (Scene.load(name) for name in ("steel-ball", "steel-ball-sls", "polymer-sphere"))
    assert ball.contact_modulus.relaxed == pytest.approx(1.05e11, rel=1e-6)
    assert (ball.mass, ball.velocity) == (2.569387e-4, 0.998347)
    assert solid.contact_modulus.glassy == pytest.approx(1.46 * 1.05e11, rel=1e-6)
    assert polymer.material.young.relaxed == pytest.approx(6e5, rel=1e-14)
    assert polymer.end_time == pytest.approx(50.0 * polymer.elastic_contact_time)
    assert {scene.profile.name for scene in (ball, solid, polymer)} == {"sphere"}


@pytest.mark.parametrize("name", SCENES.names)
def test_packaged_scene_round_trips_through_its_tables(name: str) -> None:
    scene = Scene.load(name)
    again = Scene.from_dict(scene.to_dict())
    assert again.has_geometry == scene.has_geometry
    assert not scene.has_geometry or again.contact_modulus == scene.contact_modulus
    assert again.to_dict() == scene.to_dict()


@given(st.sampled_from(NUMBERS), no_numbers)
def test_no_bad_number_passes(key: str, value: object) -> None:
    if key.endswith("velocity") and value == 1e300:
        value = -1.0
    assert any(f"scene.toml: {key}: " in fault for fault in faults(changed(key, value)))


@given(st.sampled_from([key for key in NUMBERS if key not in ("model.gravity", "target.material.nu")]))
def test_zero_and_negative_are_refused(key: str) -> None:
    for value in (0.0, -1.0, 0, -3):
        assert any(f"scene.toml: {key}: " in fault for fault in faults(changed(key, value)))


@pytest.mark.parametrize("kind", [np.float32, np.float64, np.int64])
def test_a_script_may_give_numbers_of_numpy(kind: type[np.number[Any]]) -> None:
    table = changed("striker.velocity", kind(2))
    table["motion"]["impacts"] = np.int64(1)
    scene, _ = read(Scene, table, "scene.toml")
    assert (scene.velocity, scene.motion.impacts) == (2.0, 1)
    assert json.loads(json.dumps(scene.to_dict()))["striker"]["velocity"] == 2.0
    (fault,) = faults(changed("striker.velocity", kind(-2)))
    assert fault.startswith(f"scene.toml: striker.velocity: {kind(-2).item()} is not accepted; accepted: ")


def test_a_date_is_told_back_as_it_was_written() -> None:
    (fault,) = faults(changed("striker.radius", date(1979, 5, 27)))
    assert fault.startswith("scene.toml: striker.radius: 1979-05-27 is not accepted; accepted: ")


@given(st.floats(min_value=0.5, exclude_min=True) | st.floats(max_value=-1.0))
def test_impossible_poisson_ratios_are_refused(nu: float) -> None:
    (fault,) = faults(changed("target.material.nu", nu))
    assert "target.material.nu" in fault
    assert "-1 to 0.5" in fault


@given(st.sampled_from(WORDS), st.one_of(no_numbers, st.sampled_from(["spere", "x" * 300])))
def test_no_bad_word_passes(key: str, value: object) -> None:
    if key == "name" and isinstance(value, str) and 0 < len(value) <= 200:
        return
    assert any(f"scene.toml: {key}: " in fault for fault in faults(changed(key, value)))


@given(st.sampled_from(TABLES), st.sampled_from([3, "text", [1], True]))
def test_no_value_passes_for_a_table(key: str, value: object) -> None:
    assert any(f"scene.toml: {key}: not a table" in fault for fault in faults(changed(key, value)))


@given(st.sampled_from(list(NUMBERS[:7]) + WORDS[1:4] + TABLES[:3]))
def test_missing_key_is_named(key: str) -> None:
    table = copy.deepcopy(SOLID)
    *path, last = key.split(".")
    place = table
    for part in path:
        place = place[part]
    del place[last]
    assert any(f"scene.toml: {key}: missing" in fault for fault in faults(table))


def test_unknown_key_names_the_accepted_and_the_nearest() -> None:
    table = changed("striker.radus", 0.01)
    assert faults(table) == [
        "scene.toml: striker.radus: unknown key; accepted: mass, radius, shape, velocity; did you mean radius?"
    ]


@pytest.mark.parametrize(
    ("key", "home"),
    [
        ("target.material.inertia", "model"),
        ("striker.gravity", "model"),
        ("model.impacts", "motion"),
        ("velocity", "striker"),
        ("target.velocity", "striker"),
    ],
)
def test_a_key_in_the_wrong_table_leads_to_the_right_one(key: str, home: str) -> None:
    with pytest.raises(BadInput, match=f"^{re.escape(f'polymer-sphere.toml: {key}: unknown key; ')}.*") as refused:
        Scene.load("polymer-sphere", {key: 1.0})
    assert str(refused.value).endswith(f"; {key.rpartition('.')[2]} stands in [{home}]")


def test_a_decimal_comma_and_a_unit_are_told_from_a_number(tmp_path: Path) -> None:
    for value in ("0,006", "2 cm/s"):
        with pytest.raises(BadInput, match=r"accepted: a number .* m/s; a number has a decimal point and no unit$"):
            Scene.load("polymer-sphere", {"striker.velocity": value})
    (tmp_path / "mine.toml").write_text("[striker]\nradius = 0,006\n", encoding="utf-8")
    with pytest.raises(BadInput, match=r"'radius = 0,006'; cure: a decimal point$"):
        Scene.load(tmp_path / "mine.toml")
    for key, value in (("model.kinematics", "2nd"), ("model.inertia", "1")):
        with pytest.raises(BadInput) as refused:
            Scene.load("polymer-sphere", {key: value})
        assert "decimal point" not in str(refused.value)


@pytest.mark.parametrize(
    ("key", "meant"),
    [
        ("striker.speed", "velocity"),
        ("striker.diameter", "radius"),
        ("striker.type", "shape"),
        ("target.material.Youngs_Modulus", "E0"),
        ("target.material.poisson", "nu"),
        ("target.material.rho", "density"),
        ("model.g", "gravity"),
    ],
)
def test_what_users_call_a_key_leads_to_it(key: str, meant: str) -> None:
    """Where letters alone lead elsewhere, as from speed to shape, or nowhere."""
    (fault,) = faults(changed(key, 1.0))
    assert fault.startswith(f"scene.toml: {key}: unknown key; ")
    assert fault.endswith(f"; did you mean {meant}?")


def test_all_faults_come_at_once_but_at_most_twenty() -> None:
    table = changed("striker.mass", -1.0)
    table["striker"]["radius"] = math.nan
    table["target"]["material"] |= {"nu": 0.6, "E0": "soft", "R3": 1.0}
    table |= {"modle": {}, "motion": {"impacts": 0}}
    keys = {fault.split(": ")[1] for fault in faults(table)}
    expected = {"striker.mass", "striker.radius", "target.material.nu", "target.material.E0", "target.material.R3"}
    assert keys == expected | {"modle", "motion.impacts"}
    table["striker"] |= {f"key{i}": i for i in range(40)}
    assert len(faults(table)) == 20


@pytest.mark.parametrize(
    ("second", "key"),
    [
        ({"striker.mass": 0.0}, "striker.mass"),
        ({"model.gravity": 9.81, "model.direction": "horizontal"}, "model.gravity"),
        ({"striker": {"shape": "punch", "radius": 1.0, "mass": 1.0, "velocity": 1.0}, "target.shape": "sphere",
          "target.radius": 1.0}, "striker.shape"),
    ],
)  # fmt: skip
def test_what_is_wrong_of_two_keys_is_told_beside_what_is_wrong_of_one(second: dict[str, object], key: str) -> None:
    """No light body, no weight across the motion, no striker that a target is not for waits for the next try."""
    with pytest.raises(BadInput) as caught:
        read(Scene, SOLID, "scene.toml", {**second, "motion.impacts": 0})
    assert {"motion.impacts", key} <= {fault.key for fault in caught.value.faults}


def test_a_block_that_swings_may_have_no_mass_whatever_else_is_wrong() -> None:
    with pytest.raises(BadInput) as caught:
        Scene.load("polymer-prism-waves", {"striker.mass": 0.0, "striker.velocity": 0.0})
    assert [fault.key for fault in caught.value.faults] == ["striker.velocity"]


def test_an_empty_law_misses_its_name() -> None:
    """Masses alone have no other way to answer; without a law at all it is the shape that is missing."""
    masses = {"name": "two", "striker": {"mass": 1.0, "velocity": 1.0}}
    assert ["law.name: missing" in fault for fault in faults(masses | {"law": {}})] == [True]
    assert faults(masses | {"law": 5.0}) == ["scene.toml: law: not a table; accepted: its keys below [law]"]
    assert any("striker.shape: missing" in fault for fault in faults(masses))


def test_a_misspelt_material_leads_to_its_table() -> None:
    table = copy.deepcopy(SOLID)
    table["target"]["materials"] = table["target"].pop("material")
    unknown, missing = faults(table)
    assert unknown.startswith("scene.toml: target.materials: unknown key; ")
    assert unknown.endswith("; did you mean material?")
    assert missing == "scene.toml: target.material: missing; a scene needs this table"


def test_what_is_not_built_yet_says_what_is() -> None:
    (fault,) = [f for f in faults(changed("striker.shape", "torus")) if "striker.shape" in f]
    assert "not known; accepted: cone, cylinder, plate, power, prism, profile, punch," in fault
    assert any("target.shape" in f and "half_space" in f for f in faults(changed("target.shape", "plank")))
    (fault,) = [f for f in faults(changed("striker.material", {"law": "elastic"})) if "striker.material" in f]
    assert "struck by a rigid body in this version" in fault


def test_an_unknown_network_may_mean_anything_by_a_key_that_is_several_things() -> None:
    (fault,) = faults(changed("target.material", {"law": "prosy", "E": 1e6, "E_inf": 1e6, "nu": 0.3}))
    assert "did you mean prony?" in fault


def test_inertia_names_the_missing_density_too() -> None:
    table = changed("model.inertia", True)
    table["striker"] |= {"shape": "punch", "radius": 0.03}
    table["target"] |= {"shape": "washer", "inner_radius": 0.01, "outer_radius": 0.02, "height": 0.01, "base": "bonded"}
    del table["target"]["material"]["density"]
    keys = [fault.split(": ")[1] for fault in faults(table)]
    assert keys == ["model.inertia", "target.material.density"]


def test_materials_that_cannot_be_are_refused_with_their_key() -> None:
    table = changed("target.material", {"law": "operators", "p": [1.0], "q": [1.0, 1.0, 1.0], "nu": 0.3})
    assert any("deg q" in fault for fault in faults(table))
    fluid = {"law": "maxwell", "E": 1e6, "eta": 1e4, "nu": 0.3, "constant": "bulk"}
    assert any("bulk_modulus" in fault for fault in faults(changed("target.material", fluid)))
    mixed = {"law": "sls", "E1": 1.0, "E2": 1.0, "R2": 1.0, "nu": 0.3}
    assert {"target.material.C1", "target.material.R2"} == {
        f.split(": ")[1] for f in faults(changed("target.material", mixed))
    }


def test_striker_deeper_than_its_radius_is_absurd() -> None:
    assert any("deeper than its radius" in fault for fault in faults(changed("striker.velocity", 1e4)))


def test_overrides_replace_and_are_checked() -> None:
    scene, _ = load(Scene, "polymer-sphere", {"striker.velocity": 0.03, "model.profile": "parabola"})
    assert scene.velocity == 0.03
    assert scene.profile.name == "parabola"
    with pytest.raises(BadInput, match=r"striker\.mass"):
        load(Scene, "polymer-sphere", {"striker.mass": 0.0})
    with pytest.raises(BadInput, match="not a table"):
        load(Scene, "polymer-sphere", {"name.first": 1.0})


@pytest.mark.parametrize(
    ("asked", "meant"),
    [
        ("folder/fuond.toml", "folder/found.toml"),
        ("folder/found", "folder/found.toml"),
        ("polymer-sphere.toml", "polymer-sphere"),
        ("nowhere/polymer-spher.toml", "polymer-sphere"),
        ("mnie", "mine.toml"),
    ],
)
def test_a_file_that_is_none_leads_to_the_nearest(
    asked: str, meant: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the files beside it and of the packaged names."""
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    for name in ("mine.toml", "folder/found.toml"):
        Path(name).touch()
    with pytest.raises(BadInput) as caught:
        Scene.load(asked)
    assert str(caught.value).startswith(f"{asked}: ")
    assert "no such file" in str(caught.value)
    assert f"; did you mean {meant}?" in str(caught.value)


def test_assignments_are_toml_or_text() -> None:
    assert parse_assignment("striker.radius = 0.01") == ("striker.radius", 0.01)
    assert parse_assignment("model.profile=parabola") == ("model.profile", "parabola")
    assert parse_assignment("target.material.E=[1.0, 2.0]") == ("target.material.E", [1.0, 2.0])
    for text in ("radius", "=1", "a..b=1"):
        with pytest.raises(BadInput):
            parse_assignment(text)


def test_unreadable_files_are_one_line_each(tmp_path: Path) -> None:
    binary, broken, deep = tmp_path / "binary.toml", tmp_path / "broken.toml", tmp_path / "deep.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    broken.write_text("striker = [")
    deep.write_text("x = " + "[" * 100_000)
    for path in (binary, broken, deep, tmp_path, tmp_path / "nowhere.toml"):
        with pytest.raises(BadInput) as caught:
            load(Scene, path)
        assert str(caught.value).count("\n") == 0
        assert path == broken or "accepted: " in str(caught.value)


def test_unknown_packaged_name_suggests_the_nearest() -> None:
    with pytest.raises(BadInput, match="did you mean polymer-sphere"):
        load(Scene, "polymer-spher")


RELAXING = {"law": "sls", "E1": 1e6, "E2": 1e6, "C1": 1e3, "nu": 0.3, "constant": "bulk"}


def test_what_the_material_of_a_block_lacks_is_said_of_the_striker_s() -> None:
    with pytest.raises(BadInput) as refused:
        Scene.load("polymer-prism", {"model.plasticity": True})
    keys = {fault.key for fault in refused.value.faults if "material" in fault.key}
    assert keys == {"striker.material.yield_strength", "striker.material.law"}
    with pytest.raises(BadInput, match=r"striker\.material: missing"):
        Scene(Prism(1e-4, 0.01), 0.05, 0.02, None, target=Plane())


@pytest.mark.parametrize(
    ("name", "keys", "changing"),
    [
        ("polymer-prism", {"striker.material": RELAXING, "striker.faces": "bonded"}, {"striker"}),
        ("two-finite-spheres", {"striker.material": RELAXING}, {"striker"}),
        ("two-finite-spheres", {"target.material": RELAXING}, {"target"}),
        ("two-finite-spheres", {"striker.material": RELAXING, "target.material": RELAXING}, {"striker", "target"}),
    ],
)
def test_a_load_curve_is_refused_for_the_material_whose_poisson_s_ratio_changes(
    name: str, keys: dict[str, object], changing: set[str]
) -> None:
    with pytest.raises(BadInput) as refused:
        Scene.load(name, keys).check_memory()
    assert {fault.key for fault in refused.value.faults} == {f"{part}.material.constant" for part in changing}
