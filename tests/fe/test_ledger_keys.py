"""The model ledger's keys work, and what it says of a block's inertia is what finite elements find."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from fe_contact import run
from fe_contact.reference import check, plan
from fe_contact.targets.base import TARGETS as MESHED
from lumped import FeContactError, Scene, laws, simulate
from lumped.result.model_ledger import Peak, model_ledger
from lumped.result.result import NO_KEY
from lumped.schema.files import SCENES
from lumped.targets import TARGETS

HEAVY = 1000.0  # kg/m3
PEAK = Peak(1.0, 1e-5, 1e-3, 1e-3)


def without_inertia(name: str) -> dict[str, object] | None:
    """The keys that give a packaged scene's bodies a density; None where it has inertia or no body."""
    scene = Scene.load(name)
    if scene.material is None or scene.model.inertia:
        return None
    alone = not scene.target.deformable
    parts = {"target": not alone, "striker": alone or scene.striker_material is not None}
    return {f"{part}.material.density": HEAVY for part, solid in parts.items() if solid}


@pytest.mark.parametrize("name", [name for name in SCENES.names if without_inertia(name) is not None])
def test_a_key_for_inertia_stands_where_it_works(name: str) -> None:
    heavy = without_inertia(name) or {}
    (entry,) = [one for one in model_ledger(Scene.load(name, heavy), PEAK) if one.effect == "target inertia"]
    assert entry.estimate is not None
    try:
        plan(Scene.load(name, heavy | {"model.inertia": True, "model.gravity": 0.0}), {})
        works = True
    except FeContactError:
        works = False
    assert bool(entry.key) is works


NEEDED = {"density": HEAVY, "yield_strength": 1e9, "work_of_adhesion": 0.05, "friction": 0.2}


@pytest.mark.parametrize("name", [name for name in SCENES.names if Scene.load(name).has_geometry])
def test_what_an_effect_needs_to_be_known_can_be_given(name: str) -> None:
    """And is enough: the ledger does not ask for it again."""
    asked = {one.effect: one.note for one in model_ledger(Scene.load(name), PEAK) if one.note.startswith("needs ")}
    for effect, note in asked.items():
        key = note.removeprefix("needs ")
        more = Scene.load(name, {key: NEEDED[key.rpartition(".")[2]]})
        (entry,) = [one for one in model_ledger(more, PEAK) if one.effect == effect]
        assert key not in entry.note


@pytest.mark.parametrize("mass", [4.0e-3, 4.1888e-3])
def test_a_ball_that_flies_has_the_mass_of_its_density_or_no_key(mass: float) -> None:
    """4/3 pi R^3 rho of a ball of 10 mm is 4.1888 g at 1000 kg/m3."""
    heavy = {f"{part}.material.density": HEAVY for part in ("target", "striker")} | {"striker.mass": mass}
    scene = Scene.load("two-finite-spheres", heavy | {"target.mass": mass})
    (entry,) = [one for one in model_ledger(scene, PEAK) if one.effect == "target inertia"]
    its_own = mass == pytest.approx(HEAVY * 4.0 / 3.0 * math.pi * scene.geometry.shape.radius**3, rel=1e-4)
    assert bool(entry.key) is its_own
    assert ("accepted: 0.00418879 kg" in entry.note) is not its_own


def test_no_more_is_radiated_than_there_is() -> None:
    """A grain of dust on rubber: the pulse would send off many times its energy, to first order."""
    scene = Scene.load("polymer-sphere", {"target.material.density": HEAVY, "striker.mass": 1e-7})
    (entry,) = [one for one in model_ledger(scene, Peak(10.0, 1e-6, 1e-4, 1e-6)) if one.effect == "target inertia"]
    assert entry.estimate == 1.0
    assert "radiates 1 of the kinetic energy" in entry.note


@pytest.mark.parametrize("name", [name for name in SCENES.names if Scene.load(name).has_geometry])
def test_a_key_for_large_strains_stands_where_they_are_built(name: str) -> None:
    """A dashpot, a constant bulk modulus that relaxes, flat ends, two bodies, waves: no larger model here."""
    scene = Scene.load(name)
    if scene.model.finite:
        return
    (entry,) = [one for one in model_ledger(scene, PEAK) if one.effect == "finite strain"]
    try:
        check(scene.changed({"model.kinematics": "finite"}), {})
        works = True
    except FeContactError:
        works = False
    assert (entry.key, entry.value) == (("model.kinematics", "finite") if works else ("", None))
    assert entry.cure.endswith("kinematics=finite" if works else NO_KEY)


@pytest.mark.parametrize(
    "changes",
    [
        {"target.material.constant": "bulk"},
        {"target.material": {"law": "kelvin_voigt", "E": 1e6, "eta": 1e3, "nu": 0.4}},
    ],
    ids=["bulk", "dashpot"],
)
def test_what_does_not_relax_with_large_strains_has_no_larger_model(changes: dict[str, object]) -> None:
    ledger = model_ledger(Scene.load("polymer-sphere", changes), PEAK)
    (entry,) = [one for one in ledger if one.effect == "finite strain"]
    assert entry.cure == NO_KEY
    assert "with large strains in this version" in entry.note


def test_no_key_for_inertia_under_a_rigid_ball_that_would_have_to_yield_too() -> None:
    """A free ball flies with waves only where what strikes it has a material and a density of its own."""
    ball: dict[str, object] = {"target.material.density": HEAVY, "target.mass": 4.1888e-3}
    table = Scene.load("two-finite-spheres", ball).to_dict()
    for material, said in (({}, "striker.material: missing"), (None, "striker.material.density: missing")):
        striker = {key: value for key, value in table["striker"].items() if key != "material" or material is None}
        scene = Scene.from_dict({**table, "striker": striker})
        (entry,) = [one for one in model_ledger(scene, PEAK) if one.effect == "target inertia"]
        assert (entry.key, said in entry.note) == ("", True)
        with pytest.raises(FeContactError, match=said):
            scene.changed({"model.inertia": True})


def test_a_force_that_peaks_at_the_touch_is_charged_by_its_whole_contact() -> None:
    """Under a flat end a strong dashpot presses most at first: no time until the peak tells what is radiated."""
    damped = {"law": "kelvin_voigt", "E": 1e6, "eta": 3e4, "nu": 0.1, "density": HEAVY}
    target = {"shape": "layer", "thickness": 2e-3, "base": "sliding", "material": damped}
    striker = {"shape": "punch", "radius": 0.03, "mass": 4.0, "velocity": 3e-3}
    scene = Scene.from_dict({"striker": striker, "target": target})
    exact, planned = simulate(laws.get("correspondence").of(scene), scene, 1e-4).model_ledger, plan(scene, {}).ledger
    for one, other in zip(planned, exact, strict=True):
        assert one.effect == other.effect
        assert one.estimate == (other.estimate and pytest.approx(other.estimate, rel=0.05))


INERTIA, BULK, WEIGHT = "target inertia", "constant nu against constant bulk modulus", "gravity"
RELAXING: dict[str, object] = {
    "target.material": {"law": "sls", "E0": 1e6, "R1": 0.5, "R2": 0.01, "nu": 0.4, "density": HEAVY}
}
DASHPOT: dict[str, object] = {
    "striker.material": {"law": "kelvin_voigt", "E": 1e6, "eta": 1e2, "nu": 0.4, "density": HEAVY}
}
THREE: dict[str, object] = {"motion.impacts": 3, "model.gravity": 9.81}
STRAINED: dict[str, object] = {"model.kinematics": "finite"}
ELASTIC: dict[str, object] = {
    "target.material": {"law": "elastic", "E": 1e6, "nu": 0.4, "density": HEAVY, "yield_strength": 1e4},
    "model.direction": "down",
}
SPLIT: dict[str, object] = {"target.material.hyperelastic": "neo_hooke_split"}


@pytest.mark.parametrize(
    ("name", "changes", "effect", "change", "works"),
    [
        ("polymer-sphere", {}, INERTIA, {"model.inertia": True}, True),
        ("polymer-sphere", {"target.material.constant": "bulk"}, INERTIA, {"model.inertia": True}, False),
        ("polymer-sphere", THREE, INERTIA, {"model.inertia": True}, True),
        ("polymer-layer", THREE, INERTIA, {"model.inertia": True}, False),
        ("polymer-prism", DASHPOT, INERTIA, {"model.inertia": True}, False),
        ("polymer-sphere-waves", {}, BULK, {"target.material.constant": "bulk"}, False),
        ("polymer-layer-waves", {}, BULK, {"target.material.constant": "bulk"}, True),
        ("polymer-sphere", THREE, BULK, {"target.material.constant": "bulk"}, True),
        ("polymer-layer", THREE, BULK, {"target.material.constant": "bulk"}, False),
        ("polymer-prism", THREE, BULK, {"striker.material.constant": "bulk"}, True),
        ("polymer-half-plane", RELAXING, BULK, {"target.material.constant": "bulk"}, False),
        ("polymer-sphere", STRAINED, BULK, {"target.material.constant": "bulk"}, False),
        ("polymer-layer", STRAINED, BULK, {"target.material.constant": "bulk"}, False),
        ("rod-in-ring", STRAINED, BULK, {"target.material.constant": "bulk"}, False),
        ("rod-in-ring", STRAINED | SPLIT, BULK, {"target.material.constant": "bulk"}, True),
        ("polymer-sphere", ELASTIC, WEIGHT, {"model.gravity": 9.81}, True),
        ("polymer-sphere", ELASTIC | {"model.plasticity": True}, WEIGHT, {"model.gravity": 9.81}, True),
        ("polymer-sphere", ELASTIC, "plasticity", {"model.plasticity": True}, True),
        ("polymer-sphere", ELASTIC | {"motion.impacts": 2}, "plasticity", {"model.plasticity": True}, False),
    ],
)
def test_a_key_stands_where_what_the_scene_asks_beside_it_is_built(
    name: str, changes: dict[str, object], effect: str, change: dict[str, object], works: bool
) -> None:
    scene = Scene.load(name, changes)
    check(scene, {})
    (entry,) = [one for one in model_ledger(scene, PEAK) if one.effect == effect]
    assert entry.estimate is not None
    ((key, value),) = change.items()
    assert (entry.key, entry.value) == ((key, value) if works else ("", None))
    if works:
        check(scene.changed(change), {})
        return
    assert entry.note.partition("; ")[2], "the reason stands behind what the estimate is of"
    with pytest.raises(FeContactError):
        check(scene.changed(change), {})


def test_targets_of_large_strains_are_those_that_have_a_mesh_for_them() -> None:
    meshed = {name for name, member in MESHED.members.items() if member.solid is not None}
    own = {name for name, part in TARGETS.members.items() if part.kind.large_strains}
    assert own == meshed


def test_a_blocks_own_waves_press_as_the_ledger_says(campaign_size: Callable[[int], int]) -> None:
    """Within a factor of two, as long as the block is the lighter."""
    rng = np.random.default_rng(9)
    for _ in range(campaign_size(12)):
        keys: dict[str, object] = {"striker.material.density": float(10.0 ** rng.uniform(1.5, 3.0))}
        still = run(Scene.load("polymer-prism", keys), tolerance=1e-3)
        moving = run(Scene.load("polymer-prism", keys | {"model.inertia": True}), tolerance=1e-2)
        (entry,) = [one for one in still.model_ledger if one.effect == "target inertia"]
        peaks = [one.quantities["peak_force"].value or math.nan for one in (moving, still)]
        assert 0.5 < (peaks[0] / peaks[1] - 1.0) / (entry.estimate or math.inf) < 2.0, keys


@pytest.mark.parametrize("target", ["layer", "washer"])
def test_a_flat_end_meets_a_wide_layer_as_a_block_meets_its_plane(target: str) -> None:
    """Nothing moves sideways at nu = 0: the same column, whose waves are followed as a block's. To a factor of 2."""
    for density in (10.0, 100.0, 1000.0):
        pressed = {"law": "elastic", "E": 1e6, "nu": 0.0, "density": density}
        blow = {"mass": 0.1, "velocity": 0.02}
        size = (
            {"thickness": 2e-3} if target == "layer" else {"height": 2e-3, "inner_radius": 1e-6, "outer_radius": 0.05}
        )
        struck = {"shape": target, "base": "bonded", "material": pressed, **size}
        flat = Scene.from_dict({"striker": {"shape": "punch", "radius": 0.05, **blow}, "target": struck})
        plate = {"shape": "plate", "area": math.pi * 0.05**2, "thickness": 2e-3, "material": pressed, **blow}
        still = Scene.from_dict({"striker": plate, "target": {"shape": "plane"}})
        peaks = [run(one, tolerance=1e-2).quantities["peak_force"].value for one in (still, waves_of(still))]
        (entry,) = [one for one in plan(flat, {}).ledger if one.effect == INERTIA]
        assert 0.5 < ((peaks[1] or math.nan) / (peaks[0] or math.nan) - 1.0) / (entry.estimate or math.inf) < 2.0


def waves_of(scene: Scene) -> Scene:
    """The same with inertia."""
    return scene.changed({"model.inertia": True})


def test_a_light_punch_meets_more_at_the_touch_than_it_ever_presses() -> None:
    """On a half-space it presses with v sqrt(2 E* a m) at most, at rest, and with density c v first of all."""
    radius, mass, velocity, density, nu = 0.01, 1e-4, 0.05, 1200.0, 0.2
    material = {"law": "elastic", "E": 2e6, "nu": nu, "density": density}
    striker = {"shape": "punch", "radius": radius, "mass": mass, "velocity": velocity}
    scene = Scene.from_dict({"striker": striker, "target": {"shape": "half_space", "material": material}})
    pressed = velocity * math.sqrt(2.0 * 2e6 / (1.0 - nu**2) * radius * mass)
    speed = math.sqrt(2e6 * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) / density)
    (entry,) = [one for one in plan(scene, {}).ledger if one.effect == INERTIA]
    assert entry.estimate == pytest.approx(density * speed * velocity * math.pi * radius**2 / pressed - 1.0, rel=1e-3)


def test_what_is_planned_says_what_the_exact_impact_does() -> None:
    """To a twentieth, of what waves and a held bulk modulus take."""
    scene = Scene.load("polymer-sphere")
    exact = {entry.effect: entry.estimate for entry in simulate(laws.ting.of(scene), scene, 1e-4).model_ledger}
    planned = {entry.effect: entry.estimate for entry in plan(scene, {}).ledger}
    for effect in ("target inertia", "constant nu against constant bulk modulus"):
        assert planned[effect] == pytest.approx(exact[effect], rel=0.05), effect


@pytest.mark.parametrize("end_time", [1e-3, None])
def test_a_contact_that_peaks_at_the_touch_lasts_while_it_is_followed(end_time: float | None) -> None:
    """A dashpot under a punch: law and plan say one thing, and waves have had that time."""
    material = {"law": "kelvin_voigt", "E": 1e6, "eta": 3e4, "nu": 0.1, "density": 1000.0}
    striker = {"shape": "punch", "radius": 0.03, "mass": 4.0, "velocity": 0.003}
    tables: dict[str, object] = {"striker": striker, "target": {"shape": "half_space", "material": material}}
    scene = Scene.from_dict(tables | ({} if end_time is None else {"motion": {"end_time": end_time}}))
    exact = simulate(laws.ting.of(scene), scene, 1e-3).model_ledger
    (first,), (second,) = ([one for one in told if one.effect == INERTIA] for told in (exact, plan(scene, {}).ledger))
    assert first.size == pytest.approx(second.size, rel=0.05)
    assert first.size > 0.05
