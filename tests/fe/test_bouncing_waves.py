"""Several impacts with inertia: as without it on light bodies, as a first one after long flights, within their bars."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fe_contact
from fe_contact.budget.curve import Curve
from fe_contact.cli import main
from fe_contact.march.impacts import Grounded, follow
from fe_contact.methods import simulate
from fe_contact.steppers.steps import Strike
from fe_contact.waves.certify import WaveRun
from fe_contact.waves.impact import WaveBouncer, motion, record
from fe_contact.waves.targets import half_space
from fe_contact.waves.targets.half_space import moving
from lumped import BadInput, Scene
from lumped.load_curves.hertz import hertz_impact

QUICK = {"elements_per_contact": 5.0, "steps": 160, "penalty": 60.0, "tolerance": 0.03}
ELASTIC = {"law": "elastic", "E": 1e6, "nu": 0.3, "density": 1000.0}
TOLD = ("velocity", "duration", "restitution", "peak_force", "peak_depth")


def thrown(material: Mapping[str, Any] | None = None, **changes: Any) -> Scene:
    """The packaged ball, twice, with some keys changed."""
    given = {} if material is None else {"target.material": dict(material)}
    return Scene.load("ball-bouncing-waves", {"motion.impacts": 2, **given, **changes})


def followed(scene: Scene, **given: Any) -> WaveRun:
    numerics = half_space.plan(scene, QUICK | given).numerics
    body = moving(scene, numerics)
    bouncer = WaveBouncer(body, scene, numerics)
    found = follow(bouncer, Strike.of(scene), scene.motion.impacts)
    return WaveRun(found, body.body.size, bouncer.flights.steps, bouncer.steppers.made)


def quantities(bounces: WaveRun, number: int) -> dict[str, float]:
    contact = bounces.followed.contacts[number]
    found = Curve.of(contact.march, contact.strike).quantities
    known = {name: value for name, value in found.items() if value is not None}
    return known | {"start": contact.strike.touched_at, "velocity": contact.strike.velocity}


@pytest.mark.full
def test_four_contacts_meet_the_tolerance_of_the_packaged_scene() -> None:
    """The fourth begins on what three have left on its way: a bulk too coarse for that shows there first."""
    found = fe_contact.run("ball-bouncing-waves")
    assert found.converged, found.message
    assert len(found.contacts) == 4
    assert abs(found.energy["residual"] or 0.0) < 1e-6 * (found.energy["in"] or 0.0)


@pytest.mark.tenth
def test_a_light_elastic_body_gives_back_what_it_got() -> None:
    """Hertz's contact, a flight of 2 v/g, and the same again."""
    scene = thrown(
        ELASTIC | {"density": 1e-3}, **{"model.profile": "parabola", "model.gravity": 0.01, "motion.end_time": 100.0}
    )
    modulus = ELASTIC["E"] / (1.0 - ELASTIC["nu"] ** 2)
    exact = hertz_impact(0.01, modulus, scene.mass, scene.velocity)
    result = simulate(scene, "fe", QUICK)
    assert result.converged, result.message
    values = {"velocity": scene.velocity, "duration": exact.duration, "restitution": 1.0}
    values |= {"peak_force": exact.force, "peak_depth": exact.depth}
    weight = scene.mass * scene.gravity / exact.force  # which Hertz leaves out
    for number, contact in enumerate(result.contacts):
        start = number * (exact.duration + 2.0 * scene.velocity / scene.gravity)
        assert contact["start"] == pytest.approx(start, abs=contact["start_error"])
        for name, value in values.items():
            assert contact[name] == pytest.approx(value, abs=contact[f"{name}_error"] + 2.0 * weight * value), (
                number,
                name,
            )


@pytest.mark.tenth
def test_without_density_a_memory_recovers_as_it_does_without_inertia() -> None:
    """Two routes: the bulk in motion, and a surface that remembers."""
    scene = thrown(**{"target.material.density": 1e-3})
    light = simulate(scene, "fe", QUICK)
    still = fe_contact.run(thrown(**{"model.inertia": False}), tolerance=1e-3)
    fresh = fe_contact.run(thrown(**{"model.inertia": False, "motion.impacts": 1}), tolerance=1e-3)
    first, second = still.contacts
    assert abs(
        second["peak_force"] / second["velocity"] ** 1.2 / (first["peak_force"] / first["velocity"] ** 1.2) - 1
    ) > (3.0 * light.contacts[1]["peak_force_error"] / first["peak_force"]), "what is remembered is to be seen"
    assert fresh.quantities["peak_force"].value == pytest.approx(first["peak_force"], rel=1e-3)
    for number, (one, other) in enumerate(zip(light.contacts, still.contacts, strict=True)):
        for name in ("start", *TOLD):
            bars = one.get(f"{name}_error", 0.0) + other.get(f"{name}_error", 0.0)
            assert one[name] == pytest.approx(other[name], abs=bars), (number, name)


@pytest.fixture(scope="module")
def steel() -> tuple[Scene, WaveRun]:
    """A flight of 20 000 contact times, after which all is at rest."""
    scene = Scene.load("steel-ball-waves", {"motion": {"impacts": 2, "end_time": 1.0}, "model.gravity": 9.81})
    return scene, followed(scene)


@pytest.mark.tenth
def test_after_a_long_flight_a_contact_is_a_first_one_at_its_speed(steel: tuple[Scene, WaveRun]) -> None:
    scene, bounces = steel
    first, second = (contact.strike for contact in bounces.followed.contacts)
    assert second.depth == pytest.approx(0.0, abs=1e-6 * quantities(bounces, 0)["peak_depth"])
    assert bounces.flown < 600
    later = Scene.load(
        "steel-ball-waves",
        {"striker.velocity": second.velocity, "motion": {"impacts": 2, "end_time": 1.0}, "model.gravity": 9.81},
    )  # of two, on the same mesh
    numerics = half_space.plan(scene, QUICK).numerics
    body = moving(later, numerics)
    curve = Curve.of(record(body, motion(body, later, numerics), later), Strike.of(later))
    for name, value in quantities(bounces, 1).items():
        if name in curve.quantities:
            assert curve.quantities[name] == pytest.approx(value, rel=1e-6), name
    flown = second.touched_at - quantities(bounces, 0)["duration"]
    assert flown == pytest.approx(2.0 * second.velocity / scene.gravity, rel=1e-6)
    assert second.velocity < first.velocity


@pytest.mark.tenth
def test_the_share_that_goes_down_in_waves_falls_with_the_speed_to_three_fifths(steel: tuple[Scene, WaveRun]) -> None:
    _, bounces = steel
    losses = [1.0 - quantities(bounces, number)["restitution"] ** 2 for number in (0, 1)]
    speeds = [contact.strike.velocity for contact in bounces.followed.contacts]
    assert math.log(losses[1] / losses[0]) / math.log(speeds[1] / speeds[0]) == pytest.approx(0.6, abs=0.1)


@pytest.mark.tenth
def test_one_ledger_runs_through_contacts_and_flights() -> None:
    """What radiated and what the ball has left is what it had; of a memory the heat too."""
    for material in (None, ELASTIC):
        scene = thrown(material, **{"motion.impacts": 3})
        bounces = followed(scene)
        last = bounces.followed.contacts[-1].march
        energy = last.energy
        given = 0.5 * scene.mass * scene.velocity**2 + scene.mass * scene.gravity * last.depth[-1]
        assert len(bounces.followed.contacts) == 3
        assert abs(energy["residual"]) < 1e-9 * energy["in"]
        assert energy["in"] == pytest.approx(given, rel=1e-6), "counted to the end, within a step"
        assert abs(energy["numerical"]) < 1e-2 * energy["radiated"]
        if material is not None:
            assert energy["out"] + energy["radiated"] == pytest.approx(energy["in"], rel=1e-3)
        else:
            assert energy["viscous"] > 0.2 * energy["in"]


@pytest.mark.tenth
def test_a_second_contact_is_as_deep_as_on_a_body_that_goes_on_for_ever() -> None:
    """By spectral elements with explicit steps, on three meshes: far springs near by gave back more of the first."""
    material = {
        "law": "prony",
        "E_inf": 5017333.663,
        "E": [454871.2572, 1641838.723],
        "tau": [8.907928e-6, 2.7665828e-4],
    }
    changes = {"striker.mass": 1.13766132e-3, "striker.velocity": 1.97255119, "model.gravity": 1238.965575}
    found = thrown(material | {"nu": 0.3, "density": 1000.0}, **changes, **{"motion.end_time": 0.01})
    second = fe_contact.run(found, tolerance=0.1).contacts[1]
    assert abs(second["peak_depth"] - 4.0587e-4) + 0.0006e-4 < second["peak_depth_error"] < 4e-6


def random_scene(rng: np.random.Generator) -> Scene:
    """Elastic or with a memory of a tenth to thirty contact times, in flights of two to a hundred of them."""
    young, nu, density = 10 ** rng.uniform(5, 7), rng.uniform(0.0, 0.48), 2000.0
    velocity = 0.06 * 10 ** rng.uniform(-2.5, -0.5) * math.sqrt(young / density)
    mass = density * 4.0 / 3.0 * np.pi * 0.005**3 * 10 ** rng.uniform(-0.3, 0.7)
    time = hertz_impact(0.005, young / (1.0 - nu**2), mass, velocity).duration
    memory = {
        "law": "prony",
        "E_inf": young,
        "E": [young * rng.uniform(0.1, 2.0)],
        "tau": [time * 10 ** rng.uniform(-1, 1.5)],
    }
    material = memory if rng.integers(4) else {"law": "elastic", "E": young}
    gravity = 2.0 * velocity / (time * 10 ** rng.uniform(0.3, 2.0))
    return Scene.from_dict(
        {
            "striker": {"shape": "sphere", "radius": 0.005, "mass": mass, "velocity": velocity},
            "target": {"shape": "half_space", "material": material | {"nu": nu, "density": density}},
            "model": {"inertia": True, "gravity": gravity},
            "motion": {"impacts": 2, "end_time": 1e6 * time},
        }
    )


@pytest.mark.tenth
def test_bars_hold_the_answer_of_finer_settings(campaign_size: Callable[[int], int]) -> None:
    """And of elements of another order, and a far field further out."""
    rng = np.random.default_rng(4)
    for _ in range(campaign_size(10)):
        scene = random_scene(rng)
        result = simulate(scene, "fe", {"tolerance": 0.03})
        numerics = result.numerics
        finer = {"steps": 5 * numerics["steps"] // 4, "penalty": 2.0 * numerics["penalty"], "order": 4}
        finer |= {"elements_per_contact": numerics["elements_per_contact"]}
        found = followed(scene, far_radius=1.5 * numerics["far_radius"], **finer)
        for number, contact in enumerate(result.contacts):
            truth = quantities(found, number)
            for name in ("start", *TOLD):
                assert contact[name] == pytest.approx(truth[name], abs=contact[f"{name}_error"]), (name, number, scene)


@pytest.mark.family
@pytest.mark.parametrize(
    ("changes", "count", "grounded"),
    [
        ({"model.gravity": 60.0, "motion.impacts": 20, "motion.end_time": 3.0}, None, Grounded.SWINGS),
        ({"model.gravity": 0.0}, 1, Grounded.NO_GRAVITY),
        ({"motion.end_time": 0.02}, 1, Grounded.LATE),
        ({"motion.end_time": 0.036}, 2, None),
    ],
)
def test_fewer_contacts_than_asked_for_have_a_reason(
    changes: Mapping[str, Any], count: int | None, grounded: Grounded | None
) -> None:
    scene = thrown(**changes)
    bounces = followed(scene, steps=40, elements_per_contact=2.0)
    assert bounces.followed.grounded is grounded
    assert len(bounces.followed.contacts) == count or count is None
    assert bounces.followed.contacts[-1].march.separated == (grounded is not None)


def test_rods_follow_one_impact() -> None:
    with pytest.raises(BadInput, match=r"motion\.impacts.*rings on"):
        simulate(Scene.load("rod", {"motion.impacts": 2, "model.gravity": 9.81}), "fe", {})


@pytest.mark.tenth
def test_the_packaged_ball_bounces_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    coarse = ["--tolerance", "0.05", "--set", "numerics.steps=60", "--set", "numerics.elements_per_contact=3"]
    assert main(["run", "ball-bouncing-waves", *coarse, "--out", str(tmp_path)]) == 0
    content = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))
    speeds = [contact["velocity"] for contact in content["contacts"]]
    assert len(speeds) == 4
    assert np.all(np.diff(speeds) < 0.0)
    assert all(contact["start_error"] < 0.05 * contact["start"] for contact in content["contacts"][1:])
    assert abs(content["energy"]["residual"]) < 1e-6 * content["energy"]["in"]
    assert "contact 4 at " in capsys.readouterr().out
