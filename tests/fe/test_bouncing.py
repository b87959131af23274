"""Several impacts in a row: alike on elastic bodies, like a first one on what has recovered; fewer have a reason."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import fe_contact
import lumped
from fe_contact import reference
from fe_contact.bodies.memory import SurfaceMemory, area_weights
from fe_contact.budget.plan import plan
from fe_contact.budget.runs import Runs
from fe_contact.cli import main
from fe_contact.march.impacts import FAINTEST, Grounded, Landing, Released, _fallen, follow, landing
from fe_contact.steppers.scaled_surface import MEMORY_POINTS, POINTS_A_STEP
from fe_contact.steppers.steps import Strike
from fe_contact.targets.base import struck
from lumped import laws
from lumped.laws import mdr
from lumped.materials import Relaxation
from lumped.scene.scene import Motion

Scenes = Callable[..., lumped.Scene]
ELASTIC = {"law": "elastic", "E": 1e6}
SLS = {"law": "prony", "E_inf": 1e6, "E": [1e6], "tau": [1.35e-2]}
SPRINGS = 2000
MODULI = {
    "solid": Relaxation(1.0, (2.0, 0.5, 1.0), (0.1, 1.0, 7.0)),
    "fluid": Relaxation(0.0, (2.0, 0.5), (0.1, 1.0)),
    "damped solid": Relaxation(1.0, (2.0,), (0.3,), 0.2),
    "damped fluid": Relaxation(0.0, (2.0,), (0.3,), 0.2),
    "kelvin_voigt": Relaxation(1.0, (), (), 0.4),
}


def thrown(scene_of: Scenes, material: Mapping[str, Any], impacts: int = 2, **tables: Any) -> lumped.Scene:
    """A ball of 20 g at 0.15 m/s: contacts of 6 to 8 ms, flights of about 30 ms."""
    motion = {"impacts": impacts, "end_time": tables.pop("end_time", 2.0)}
    striker = {"velocity": 0.15} | tables.pop("striker", {})
    gravity = tables.pop("gravity", 9.81)
    return scene_of(dict(material), striker=striker, model={"gravity": gravity}, motion=motion, **tables)


@pytest.fixture(scope="module")
def polymer(scene_of: Scenes) -> tuple[lumped.Scene, lumped.Result]:
    scene = thrown(scene_of, SLS, 3)
    return scene, fe_contact.run(scene, tolerance=1e-3)


@pytest.mark.parametrize(
    ("velocity", "why"), [(-0.1, Grounded.CAUGHT), (0.0, Grounded.CAUGHT), (0.5, Grounded.REST), (2.0, None)]
)
def test_what_touches_again_too_slowly_rests_and_what_is_overtaken_is_caught(velocity: float, why: Any) -> None:
    """Velocities in units of the faintest that counts."""
    strike = Strike(lambda r: r**2, 1.0, 0.3, 9.81, Relaxation(1.0), 10.0)
    bouncer: Any = SimpleNamespace(
        contact=lambda strike: SimpleNamespace(separated=True),
        touch=lambda strike, march: replace(strike, velocity=velocity * FAINTEST * 0.3),
    )
    found = follow(bouncer, strike, 2)
    assert found.grounded is why
    assert len(found.contacts) == (2 if why is None else 1)


# elastic


def test_every_bounce_of_an_elastic_body_is_the_same(scene_of: Scenes) -> None:
    """It comes back as fast as it came: after n contacts and flights of 2 v/g the next one begins at n (T + 2 v/g)."""
    scene = thrown(scene_of, ELASTIC, 3)
    exact = mdr.estimate(scene, SPRINGS)
    assert exact.duration is not None
    period = exact.duration + 2 * scene.velocity / scene.gravity
    contacts = fe_contact.run(scene, tolerance=1e-3).contacts
    values = {"velocity": scene.velocity, "duration": exact.duration, "restitution": 1.0}
    values |= {"peak_force": exact.peak_force, "peak_depth": exact.peak_depth}
    assert len(contacts) == 3
    for number, contact in enumerate(contacts):
        assert contact["start"] == pytest.approx(number * period, abs=contact["start_error"])
        assert contact["start_error"] < 1e-3 * period * (number + 1)
        for name, value in values.items():
            assert contact[name] == pytest.approx(value, abs=contact[f"{name}_error"] + 1e-6 * value), (number, name)


def test_bars_that_miss_the_tolerance_are_said_of_each_contact_and_what_all_meet(
    scene_of: Scenes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reference, "MOST_STEPS", 100)
    given = {"tolerance": 1e-6, "elements_per_contact": 2.0, "steps": 40, "order": 2}
    found = fe_contact.run(thrown(scene_of, SLS), numerics=given)
    missed = r"tolerance 1e-06 not reached: ([^;]+); "
    said = re.match(rf"contact 1: {missed}contact 2: {missed}.*a tolerance of (\S+) is met; ", found.message)
    assert said is not None
    bars = [float(word.rpartition(" to ")[2]) for part in said.groups()[:2] for word in part.split(", ")]
    assert len(bars) > 8
    assert 0.95 * max(bars) <= float(said[3]) < 1.3 * max(bars)


def test_a_later_contact_ends_where_the_motion_does(scene_of: Scenes) -> None:
    """A third of a contact after the second touch, as a third of the first."""
    exact = mdr.estimate(thrown(scene_of, ELASTIC), SPRINGS)
    assert exact.duration is not None
    third = exact.duration / 3.0
    end = exact.duration + 2 * 0.15 / 9.81 + third
    history = fe_contact.run(thrown(scene_of, ELASTIC, end_time=end), tolerance=1e-2).history
    assert history.time[-1] == pytest.approx(end, rel=1e-12)
    first = float(history.force_at(np.array([third]))[0])
    assert history.force[-1] == pytest.approx(first, abs=2.0 * history.force_error[-1] + 1e-2 * exact.peak_force)


def test_a_layer_gives_back_what_it_got_too(scene_of: Scenes) -> None:
    """On a mesh that stays, by the steps of the march alone, which lose a thousandth."""
    layer = {"shape": "layer", "thickness": 4e-3, "base": "bonded", "material": ELASTIC | {"nu": 0.3}}
    scene = thrown(scene_of, ELASTIC, target=layer)
    followed = Runs(Strike.of(scene), scene.geometry, 2).follow(plan(scene, {"tolerance": 3e-3}).numerics)
    first, second = followed.contacts
    assert second.strike.depth == pytest.approx(0.0, abs=1e-9 * first.march.depth.max())
    assert second.strike.velocity == pytest.approx(scene.velocity, rel=2e-3)
    flight = 2 * second.strike.velocity / scene.gravity
    assert second.strike.touched_at == pytest.approx(first.march.time[-1] + flight, rel=1e-4)
    assert second.march.time[-1] == pytest.approx(first.march.time[-1], rel=1e-3)
    assert second.march.depth.max() == pytest.approx(first.march.depth.max(), rel=2e-3)


# what remembers


@pytest.mark.parametrize("name", MODULI)
def test_a_surface_that_nothing_presses_obeys_its_springs_and_dashpots(name: str) -> None:
    """And what it loses of its energy is the heat of the dashpots."""
    modulus, rng = MODULI[name], np.random.default_rng(7)
    moduli, taus = np.array(modulus.moduli), np.array(modulus.times)
    radii = np.linspace(0.0, 1.0, 5)
    strain, dashpots = rng.uniform(0.2, 1.0, (2, 5)), rng.uniform(0.1, 0.9, (taus.size, 2, 5))
    if not modulus.viscosity:
        strain = np.tensordot(moduli, dashpots, 1) / modulus.glassy
    before = SurfaceMemory(area_weights(radii), strain, strain - dashpots)

    def creep(_: float, state: np.ndarray) -> np.ndarray:
        now, flowed = state[:10], state[10:].reshape(-1, 10)
        pull = modulus.equilibrium * now + moduli @ (now - flowed)
        springy = -(moduli * (1 / taus)) @ (now - flowed) / modulus.glassy if not modulus.viscosity else 0.0
        rate = -pull / modulus.viscosity if modulus.viscosity else -springy
        return np.concatenate([rate, ((now - flowed) / taus[:, None]).ravel()])

    later = solve_ivp(creep, (0.0, 0.7), np.r_[strain.ravel(), dashpots.ravel()], rtol=1e-10, atol=1e-12).y[:, -1]
    free = Released.of(modulus, before)
    after = free.after(0.7)
    assert after.strain.ravel() == pytest.approx(later[:10], rel=1e-7)
    assert (after.strain - after.branches).ravel() == pytest.approx(later[10:], rel=1e-7)
    assert free.displacement(2, 0.7) == pytest.approx(later[2], rel=1e-7)
    assert before.stored(modulus) - after.stored(modulus) == pytest.approx(free.dissipated(0.7), rel=1e-10)


def test_long_after_the_surface_is_as_new(scene_of: Scenes) -> None:
    """Flights of 4000 relaxation times: the second contact is a first one at its speed, by the row of springs."""
    scene = thrown(scene_of, SLS | {"tau": [2e-3]}, gravity=0.03, end_time=100.0)
    contact = fe_contact.run(scene, tolerance=1e-3).contacts[1]
    fresh = mdr.estimate(
        thrown(scene_of, SLS | {"tau": [2e-3]}, 1, gravity=0.03, striker={"velocity": contact["velocity"]}), SPRINGS
    )
    for name in ("duration", "restitution", "peak_force", "peak_depth"):
        value = getattr(fresh, name)
        # as slowly as it may have been thrown: the force goes with the velocity to the power 6/5
        slower = 1.2 * value * contact["velocity_error"] / contact["velocity"]
        assert contact[name] == pytest.approx(value, abs=contact[f"{name}_error"] + slower + 1e-6 * value), name


def test_a_finer_run_is_within_both_bars(polymer: tuple[lumped.Scene, lumped.Result]) -> None:
    scene, coarse = polymer
    fine = fe_contact.run(scene, tolerance=5e-5)
    for name, bar in coarse.energy_error.items():
        assert fine.energy[name] == pytest.approx(coarse.energy[name], abs=bar + fine.energy_error[name]), name
    assert fine.energy_error["viscous"] < 0.5 * coarse.energy_error["viscous"]
    for first, second in zip(coarse.contacts, fine.contacts, strict=True):
        for name in ("start", "velocity", "duration", "restitution", "peak_force", "peak_depth"):
            bars = first[f"{name}_error"] + second[f"{name}_error"]
            assert second[name] == pytest.approx(first[name], abs=bars), name
    assert fine.contacts[1]["restitution_error"] < 0.5 * coarse.contacts[1]["restitution_error"]


def test_one_impact_is_told_as_the_first_of_several_but_without_a_row_of_them(
    scene_of: Scenes, polymer: tuple[lumped.Scene, lumped.Result]
) -> None:
    one, first = fe_contact.run(thrown(scene_of, SLS, 1), tolerance=1e-3), polymer[1].contacts[0]
    assert one.contacts == ()
    for name in ("duration", "restitution", "peak_force", "peak_depth"):
        quantity = one.quantities[name]
        assert quantity.value == pytest.approx(first[name], abs=quantity.error + first[f"{name}_error"])


def test_the_history_of_several_contacts_is_no_distance_from_itself(
    polymer: tuple[lumped.Scene, lumped.Result],
) -> None:
    _, found = polymer
    assert found.quantities["history_l2"].value == 0.0
    assert found.quantities["history_l2"].error
    for name in ("duration", "restitution", "peak_force", "peak_depth", "peak_time"):
        assert found.quantities[name].error == found.contacts[0][f"{name}_error"], "of the first and hardest contact"
    assert found.contacts[0]["velocity_error"] == 0.0, "it is what the scene says"
    assert all(contact["velocity_error"] for contact in found.contacts[1:])


def test_a_later_contact_is_placed_by_few_steps_whatever_many_the_one_before_took(
    polymer: tuple[lumped.Scene, lumped.Result],
) -> None:
    """More steps remember at more radii: the march that only places steps has to read them all."""
    scene, _ = polymer
    numerics = plan(scene, {"tolerance": 1e-3}).numerics
    steps = 2 * MEMORY_POINTS // POINTS_A_STEP
    found = [
        Runs(Strike.of(scene), scene.geometry, 2).follow(numerics.varied(steps=n)).contacts[1].march
        for n in (steps, steps // 2)
    ]
    assert found[0].time[-1] == pytest.approx(found[1].time[-1], rel=1e-3)
    assert found[0].depth.max() == pytest.approx(found[1].depth.max(), rel=1e-3)


def test_later_contacts_keep_the_schemes_order(polymer: tuple[lumped.Scene, lumped.Result]) -> None:
    scene, _ = polymer
    numerics = plan(scene, {"tolerance": 1e-3}).numerics
    runs = Runs(Strike.of(scene), scene.geometry, 3)
    found = []
    for steps in (80, 40, 20):
        settings = numerics.varied(steps=steps)
        runs.follow(settings)
        curves = [runs.curve(number, settings) for number in (1, 2)]
        found.append([(c.strike.touched_at, c.duration, c.leaving_speed) for c in curves if c is not None])
    fine, coarse = np.abs(np.diff(np.array(found), axis=0))
    assert np.all(np.log2(coarse / fine) > 1.8)


def test_energy_is_accounted_for_over_contacts_and_flights(polymer: tuple[lumped.Scene, lumped.Result]) -> None:
    scene, result = polymer
    energy, last = result.energy, result.history
    given = 0.5 * scene.mass * scene.velocity**2 + scene.mass * scene.gravity * last.depth[-1]
    assert energy["in"] == pytest.approx(given, abs=result.energy_error["in"])
    assert energy["out"] == pytest.approx(0.5 * scene.mass * last.velocity[-1] ** 2, rel=1e-9)
    assert abs(energy["residual"]) < 1e-4 * energy["in"]
    spent = energy["stored"] + energy["viscous"]
    assert spent == pytest.approx(given - energy["out"], abs=sum(result.energy_error[n] for n in ("out", "viscous")))
    followed = Runs(Strike.of(scene), scene.geometry, 3).follow(plan(scene, {"tolerance": 1e-3}).numerics)
    first, second, third = (contact.march.energy for contact in followed.contacts)
    assert 0.0 < first["viscous"] < second["viscous"] < third["viscous"]
    for terms in (first, second, third):
        assert abs(terms["residual"]) < 1e-7 * terms["in"], "what the surface loses in the flights is heat too"


# what is told


def test_the_history_runs_through_the_flights(polymer: tuple[lumped.Scene, lumped.Result]) -> None:
    scene, result = polymer
    history, (first, second, _) = result.history, result.contacts
    flying = (history.time > first["duration"]) & (history.time < second["start"])
    assert np.count_nonzero(flying) > 20
    assert np.all(history.force[flying] == 0.0)
    assert np.all(history.contact_radius[flying] == 0.0)
    assert np.all(np.diff(history.time) >= 0.0)
    flight = np.polyfit(history.time[flying] - first["duration"], history.depth[flying], 2)
    assert 2 * flight[0] == pytest.approx(scene.gravity, rel=1e-6)
    assert flight[1] == pytest.approx(-first["restitution"] * scene.velocity, rel=1e-4)
    impulse = np.trapezoid(history.force, history.time)
    assert impulse == pytest.approx(result.quantities["impulse"].value, rel=1e-4)
    peak = history.force_error[np.argmin(np.abs(history.time - second["start"] - 0.2 * second["duration"]))]
    assert peak > first["restitution_error"] * second["peak_force"], "a contact that may come later may press later"


@pytest.mark.parametrize(
    ("changes", "count", "said"),
    [
        ({"gravity": 0.0}, 1, "without model.gravity"),
        ({"end_time": 0.02}, 1, "motion.end_time comes before the next touch"),
        ({"end_time": 0.036}, 2, ""),
    ],
)
def test_fewer_contacts_than_asked_for_have_a_reason(
    changes: Mapping[str, Any], count: int, said: str, scene_of: Scenes
) -> None:
    result = fe_contact.run(thrown(scene_of, SLS, **changes), tolerance=3e-3)
    assert len(result.contacts) == count
    assert said in result.message
    assert result.separated == (said != "")
    assert result.contacts[-1]["duration"] is None or result.contacts[-1]["restitution"] is not None


def test_a_striker_that_gravity_holds_comes_to_rest_under_its_weight(scene_of: Scenes) -> None:
    material = {"law": "prony", "E_inf": 1e6, "E": [2e6, 1e6], "tau": [3e-4, 4e-3]}
    result = fe_contact.run(thrown(scene_of, material, gravity=100.0, end_time=0.05), tolerance=1e-2)
    depth = (0.02 * 100.0 / (4 / 3 * 1e6 / 0.91 * 0.1)) ** (2 / 3)
    assert [contact["duration"] for contact in result.contacts] == [None]
    assert not result.separated
    assert result.history.force[-1] == pytest.approx(2.0, rel=1e-2)
    assert result.history.depth[-1] == pytest.approx(depth, rel=1e-2)


@pytest.mark.parametrize("branch", [1e3, 1e4])
def test_what_swings_on_its_weight_is_followed_within_the_tolerance(branch: float, scene_of: Scenes) -> None:
    """A swing that fades over many turns: no step grows past what the tolerance still asks for, and none is wasted."""
    material = {"law": "sls", "E1": 1e6, "E2": branch * 1e6, "C1": 1.2e3}
    striker = {"radius": 3e-3, "mass": 4e-4, "velocity": 1e-4}
    result = fe_contact.run(thrown(scene_of, material, 1, gravity=0.05, end_time=0.1, striker=striker), 1e-3)
    assert result.converged, result.message
    assert not result.separated
    assert result.numerics["steps"] == 40
    assert result.history.force[-1] == pytest.approx(4e-4 * 0.05, rel=1e-3)


def test_a_bulk_that_remembers_is_refused_by_name(scene_of: Scenes) -> None:
    layer = {"shape": "layer", "thickness": 4e-3, "base": "bonded", "material": SLS | {"nu": 0.3, "constant": "bulk"}}
    with pytest.raises(lumped.BadInput, match=r"motion\.impacts"):
        fe_contact.run(thrown(scene_of, SLS, target=layer), tolerance=3e-3)


def test_the_packaged_ball_bounces_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", "ball-bouncing", "--tolerance", "1e-2", "--out", str(tmp_path)]) == 0
    content = json.loads((tmp_path / "result.json").read_text())
    assert [contact["restitution"] is not None for contact in content["contacts"]] == [True] * 4
    assert "contact 4 at " in capsys.readouterr().out
    assert not (tmp_path / "recovery.csv").exists(), "that is told of a surface which is left alone"


@pytest.mark.parametrize("height", [1e-9, 1.0, 1e3])
@pytest.mark.parametrize("close", [1.5, 2.0, 9.0])
def test_a_flight_ends_where_the_gap_closes_after_its_top(height: float, close: float) -> None:
    """Also long after twice the time of the top, where the surface goes on to recover."""
    assert _fallen(lambda time: height * time * (close - time), 1.0) == pytest.approx(close, rel=1e-12)
    assert _fallen(lambda time: -height, 1.0) is None


@pytest.mark.parametrize(("share", "off"), [(5e-4, True), (1e-5, False)])
def test_a_touch_beside_the_centre_counts_where_it_would_press_by_a_share_that_counts(share: float, off: bool) -> None:
    """Of the largest force, by Hertz' power of the overlap: half of the usual tolerance, or a hundredth of it."""
    strike = Strike(lambda r: r**2, 1.0, 0.3, 9.81, Relaxation(1.0), 10.0)
    march: Any = SimpleNamespace(
        time=np.array([0.0, 0.1]),
        depth=np.array([2e-3, 0.0]),
        impulse=np.array([0.0, 0.6 + 0.981]),
        memory=SurfaceMemory(area_weights(np.arange(2.0)), np.zeros((2, 2)), np.zeros((0, 2, 2))),
        memory_time=0.1,
    )
    stepper: Any = SimpleNamespace(
        strike=strike,
        remembered=lambda memory: memory,
        standing=lambda: 0,
        clearance=lambda surface, depth: np.array([0.0, -2e-3 * share ** (2 / 3)]),
    )
    found = landing(stepper, march)
    assert found is Grounded.OFF_CENTRE if off else isinstance(found, Landing)
    if isinstance(found, Landing):
        assert found.velocity == pytest.approx(0.3)
        assert found.time == pytest.approx(0.1 + 2.0 * 0.3 / 9.81)


@pytest.mark.parametrize("name", ["two-finite-spheres", "polymer-o-ring"])
def test_what_remembers_by_two_surfaces_is_struck_once(name: str) -> None:
    values = {"motion.impacts": 2, "motion.end_time": 1.0, "model.gravity": 9.81}
    with pytest.raises(lumped.errors.BadInput, match=r"motion\.impacts: 2: fe, .* follows one impact; accepted: 1"):
        fe_contact.run(lumped.Scene.load(name, values), tolerance=1e-2)


def test_a_round_striker_lands_where_nothing_lies_below_it() -> None:
    """On the axis alone, where it meets a surface at rest as it sets down."""
    scene = lumped.Scene.load("polymer-sphere")
    numerics = plan(scene, {"tolerance": 0.1}).numerics
    stepper = struck(scene.geometry, numerics).stepper(Strike.of(scene), numerics, ())
    gaps = stepper.clearance(stepper.remembered(stepper.touch().memory), 0.0)
    assert np.flatnonzero(gaps == 0.0) == [stepper.standing()]


@pytest.mark.parametrize("flights", [20.0, 1e5, 1e6])
def test_a_touch_known_no_better_than_a_contact_lasts_leaves_the_later_force_in_its_band(flights: float) -> None:
    """A block that has forgotten the first contact is struck anew, by what left it: two exact impacts, a flight apart.

    Of a long flight the restitution's bar moves the touch by more than the contact lasts.
    """
    scene = lumped.Scene.load("polymer-prism")
    first = laws.correspondence.of(scene).simulate(scene, 1e-9)
    lasted = first.quantities["duration"].value
    assert lasted is not None
    scene = replace(scene, model=replace(scene.model, gravity=2.0 * scene.velocity / (flights * lasted)))
    scene = replace(scene, motion=Motion(impacts=2))
    first = one_impact(scene, scene.velocity)
    last = first.time[-1], first.depth[-1], first.velocity[-1]
    velocity = float(np.sqrt(last[2] ** 2 - 2.0 * scene.gravity * last[1]))
    touch = float(last[0] + (velocity - last[2]) / scene.gravity)
    second = one_impact(scene, velocity)
    found = fe_contact.run(scene, tolerance=0.1)
    history, start = found.history, found.contacts[1]["start_error"]
    assert (start > lasted) == (flights > 1e3), "only a long flight leaves the touch so uncertain"
    exact = first.force_at(history.time) + np.interp(history.time - touch, second.time, second.force, 0.0, 0.0)
    missed = np.abs(history.force - exact)
    assert (missed <= history.force_error + 1e-6 * history.force.max()).all()


def one_impact(scene: lumped.Scene, velocity: float) -> lumped.History:
    """Of a block at rest, exact."""
    alone = replace(scene, velocity=velocity, motion=Motion())
    return laws.correspondence.of(alone).simulate(alone, 1e-9).history
