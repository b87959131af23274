"""Blocks with inertia on a rigid plane: FE against the exact waves, within its own bars; limits; the files of `run`."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import fe_contact
from fe_contact.cli import main
from fe_contact.waves.targets._block import PAUSE, cost, plan, run
from lumped import Scene
from lumped.errors import BadInput
from lumped.result.result import Result
from lumped.scene.tables import Motion
from lumped.schema import Table
from lumped.solvers.bar import Bounces, StraightBar, bounces

BAR = StraightBar(length=10.0, speed=30.0, impedance=30.0)
ECHO = 2 / 3
CASES = 40
PLACES = 100_001  # at which two histories are compared


@pytest.fixture(scope="module")
def impact() -> Result:
    return fe_contact.run(Scene.load("bar-impact"), tolerance=3e-3)


@pytest.fixture(scope="module")
def bouncing() -> Result:
    return fe_contact.run(Scene.load("bar"), tolerance=0.1)


def covers(result: Result, name: str, exact: float) -> bool:
    found = result.quantities[name]
    assert found.value is not None
    assert found.error is not None
    return abs(found.value - exact) <= found.error + 1e-12 * abs(exact)


def test_the_impact_of_a_bar_is_a_rectangle(impact: Result) -> None:
    """density c v for one echo, to the step and to rounding; every bar holds."""
    assert impact.converged
    exact = {"peak_force": 300.0, "peak_time": 0.0, "duration": ECHO, "restitution": 1.0, "impulse": 200.0}
    assert all(covers(impact, name, value) for name, value in {**exact, "peak_depth": 5 / 3}.items())
    assert (impact.quantities["peak_time"].error or 0.0) >= (1.0 - 1e-6) * ECHO, "it is as high all the time"
    assert impact.quantities["peak_force"].value == pytest.approx(300.0, rel=1e-9)
    assert impact.quantities["duration"].value == pytest.approx(ECHO, rel=1e-9)
    history = impact.history
    np.testing.assert_allclose(history.force[history.time < 0.999 * ECHO], 300.0, rtol=1e-9)
    assert history.time[0] == 0.0
    assert history.force[-1] == 0.0


def test_the_cost_of_a_bar_counts_the_nodes_of_its_march() -> None:
    scene = Scene.load("bar-impact")
    numerics = plan(scene, {}).numerics
    assert abs(cost(scene, numerics).unknowns - run(scene, numerics).unknowns) <= 2


def test_the_bouncing_bar_follows_the_exact_one(bouncing: Result) -> None:
    """Two contacts of a period, force and motion: what the first leaves in the bar, the second takes out."""
    exact = bounces(BAR, 10.0, 10.0, 0.0, 10.5 / 3)
    wanted = {"peak_force": 500.0, "duration": ECHO, "restitution": 1.0, "impulse": 1600 / 3}
    for name, value in wanted.items():
        assert covers(bouncing, name, value), name
    history = bouncing.history
    rows = np.linspace(0.0, history.time[-1], 4001)[1:-1]
    force = exact.force(rows)
    change = np.sqrt(np.mean((history.force_at(rows) - force) ** 2) / np.mean(force**2))
    assert change <= (bouncing.quantities["history_l2"].error or 0.0)
    starts = [contact["start"] for contact in bouncing.contacts]
    np.testing.assert_allclose(starts, [start for start, _ in exact.contacts], atol=0.01)
    assert bouncing.contacts[1]["restitution"] == pytest.approx(1.0, abs=0.02)


class Bouncing(NamedTuple):
    """A bar under gravity, its exact motion, and touch and separation of its contacts, s."""

    scene: Scene
    exact: Bounces
    contacts: list[tuple[float, float]]

    @property
    def known(self) -> dict[str, float]:
        """Impulse of all contacts, N s; duration, s, restitution and peak force, N, of the first, by the waves."""
        exact, (begin, end) = self.exact, self.contacts[0]
        echo, mass = exact.bar.echo, exact.bar.mass
        starts = np.array([piece.start for piece in exact.pieces])
        jumps = np.concatenate([starts, starts + echo, [end]])
        sides = np.concatenate([jumps - 1e-9 * echo, jumps + 1e-9 * echo])
        left, last = (self.given(time) for time in (end, self.contacts[-1][1]))
        came = exact.velocity
        return {
            "impulse": last,
            "duration": end - begin,
            "restitution": left / (mass * came) - 1.0 - exact.gravity * end / came,
            "peak_force": float(exact.force(sides[(sides > begin) & (sides < end)]).max()),
        }

    def told(self, number: int) -> dict[str, float]:
        """Start and duration, s, of one of its contacts, velocity there, m/s, restitution, largest force, N."""
        exact, (begin, end) = self.exact, self.contacts[number]
        came, left = (-exact.momentum(time * (1.0 - 1e-13)) / exact.bar.mass for time in (begin, end))
        starts = np.array([piece.start for piece in exact.pieces])
        jumps = np.concatenate([starts, starts + exact.bar.echo, [end]])
        sides = np.concatenate([jumps - 1e-9 * exact.bar.echo, jumps + 1e-9 * exact.bar.echo])
        highest = float(exact.force(sides[(sides > begin) & (sides < end)]).max())
        found = {"start": begin, "duration": end - begin, "velocity": came, "restitution": -left / came}
        return found | {"peak_force": highest}

    def given(self, time: float) -> float:
        """Momentum that the plane gave the bar until then, N s."""
        exact = self.exact
        return exact.momentum(time * (1.0 - 1e-13)) + exact.bar.mass * (exact.velocity + exact.gravity * time)


def bouncing_bar(rng: np.random.Generator) -> Bouncing | None:
    """Two or three contacts; None where it is a matter of a moment how many they are, or one of them only grazes."""
    length, speed, density, area = 10 ** rng.uniform([-1.0, 1.5, 0.0, -4.0], [1.5, 3.7, 4.0, 0.0])
    bar, velocity, wanted = StraightBar(length, speed, density * area * speed), 1e-2 * speed, int(rng.integers(2, 4))
    gravity = velocity / bar.echo * 10 ** rng.uniform(-0.6, 0.3)
    exact = bounces(bar, velocity, gravity, 0.0, (wanted + 2.0) * (2.0 * velocity / gravity + 3.0 * bar.echo))
    found = list(exact.contacts[: wanted + 1])
    if len(found) <= wanted or np.diff(np.ravel(found)).min() < 2.0 * PAUSE * bar.echo:
        return None
    material = {"law": "elastic", "E": density * speed**2, "nu": 0.0, "density": density}
    keys: dict[str, object] = {"striker.height": length, "striker.area": area, "striker.material": material}
    keys |= {"striker.velocity": velocity, "model.gravity": gravity, "motion.impacts": wanted}
    return Bouncing(Scene.load("bar", keys), exact, found[:wanted])


def test_bars_of_several_contacts_hold_what_gravity_and_touches_within_a_step_do(
    campaign_size: Callable[[int], int],
) -> None:
    """Momentum and weight, by chance, cancel with half the steps and not with all; bars true, and no wider than ten."""
    rng, over = np.random.default_rng(17), dict[str, list[float]]()
    for _ in range(campaign_size(CASES)):
        case = None
        while case is None:
            case = bouncing_bar(rng)
        result = fe_contact.run(case.scene, tolerance=0.1, numerics={"steps": int(rng.integers(25, 60)) * 4})
        assert len(result.contacts) == len(case.contacts)
        for name, known in case.known.items():
            found = result.quantities[name]
            assert found.value is not None
            assert abs(found.value - known) <= (found.error or 0.0) + 1e-9 * abs(known), (name, case)
            over.setdefault(name, []).append((found.error or 0.0) / (abs(found.value - known) + 1e-12 * abs(known)))
        history, echo = result.history, case.exact.bar.echo
        sides = 1e-9 * echo * np.array([[-1.0], [0.0], [1.0]])
        times = np.linspace(0.0, history.time[-1], PLACES)
        force = case.exact.force(times)
        norm = np.sqrt(np.mean((history.force_at(times) - force) ** 2) / np.mean(force**2))
        assert norm <= (result.quantities["history_l2"].error or 0.0), case
        missed = np.abs(history.force - case.exact.force(history.time + sides)).min(axis=0)
        assert (missed <= history.force_error + 1e-6 * history.force.max()).all(), case
        for number, contact in enumerate(result.contacts):
            for name, known in case.told(number).items():
                bar = contact[f"{name}_error"]
                assert bar is not None, (number, name, case)
                assert abs((contact[name] or 0.0) - known) <= bar + 1e-9 * abs(known), (number, name, case)
    assert max(np.median(ratios) for ratios in over.values()) <= 10.0


def test_a_front_that_leaves_hardly_any_force_may_end_a_first_contact_later_than_it_seems() -> None:
    """Weight x echo is hardly more than the momentum: the first element's ringing opens what presses on so faintly."""
    gravity, steps = 1.0055959495804103 * 10.0 / ECHO, 208
    exact = bounces(BAR, 10.0, gravity, 0.0, 4.0 * ECHO)
    scene = Scene.load("bar", {"model.gravity": gravity, "motion.impacts": 2, "motion.end_time": 20.0 * ECHO})
    found = fe_contact.run(scene, tolerance=0.1, numerics={"steps": steps})
    end = exact.contacts[0][1]
    assert covers(found, "duration", end)
    assert covers(found, "restitution", exact.momentum(end * (1.0 - 1e-13)) / (BAR.mass * 10.0))


def test_what_fronts_ring_in_a_later_contact_is_within_its_bars() -> None:
    """A mass twice as heavy as the bar: eight times as many steps tell what lies within the bars of both."""
    scene = Scene.load("bar", {"striker.mass": 22.0})
    few, many = (fe_contact.run(scene, tolerance=0.1, numerics={"steps": steps}) for steps in (100, 800))
    assert len(few.contacts) == len(many.contacts) == 2
    coarse, fine = few.contacts[1], many.contacts[1]
    for name in ("start", "duration", "velocity", "restitution", "peak_force", "peak_time", "peak_depth"):
        bars = (coarse[f"{name}_error"] or 0.0) + (fine[f"{name}_error"] or 0.0)
        assert 0.0 < abs((coarse[name] or 0.0) - (fine[name] or 0.0)) <= bars, name


def test_energy_is_accounted_for(impact: Result, bouncing: Result) -> None:
    for result in (impact, bouncing):
        energy = {name: value or 0.0 for name, value in result.energy.items()}
        assert abs(energy["residual"]) < 1e-6 * energy["in"]
        assert energy["out"] == pytest.approx(energy["in"], rel=0.02)
        assert abs(energy["numerical"]) < 0.01 * energy["in"]


def test_the_account_of_several_contacts_ends_with_the_last_of_them(bouncing: Result) -> None:
    """As the restitution does: the march goes on until the contact is known to be over, and the bar falls meanwhile."""
    last = bouncing.contacts[-1]
    parted = (last["velocity"] or 0.0) * (last["restitution"] or 0.0)
    assert bouncing.energy["out"] == pytest.approx(0.5 * BAR.mass * parted**2, rel=5e-3)


@pytest.mark.tenth
def test_with_a_heavy_mass_behind_it_the_bar_is_a_spring() -> None:
    """Ten tonnes for every kilogram of the bar: the half sine of mass and spring, to a thousandth."""
    heavy = Scene.load("bar-impact", {"striker.mass": 1e5})
    choices = {"scheme": "generalised_alpha", "rho": 0.5, "mass": "spread", "steps": 8}
    result = fe_contact.run(heavy, tolerance=0.05, numerics=choices)
    pace = math.sqrt(900.0 / 10.0 / 1e5)
    assert result.quantities["duration"].value == pytest.approx(math.pi / pace, rel=1e-3)
    assert result.quantities["peak_force"].value == pytest.approx(1e5 * 10.0 * pace, rel=2e-2)
    assert result.quantities["restitution"].value == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize("mass", [3.0, 10.0])
def test_the_first_echo_of_a_rigid_mass_trebles_the_force(mass: float) -> None:
    """St Venant: the mass stops for nobody at once, so that the wave comes back doubled: a light one's peak."""
    scene = Scene.load("bar-impact", {"striker.mass": mass})
    result = fe_contact.run(scene, tolerance=0.1, numerics={"steps": 400})
    force = result.history.force_at(np.array([0.3, 0.6]))
    np.testing.assert_allclose(force, 300.0, rtol=1e-6)
    sides = result.history.force_at(ECHO * np.array([1.0 - 1e-9, 1.0 + 1e-9]))
    np.testing.assert_allclose(sides, [300.0, 900.0], rtol=1e-3, err_msg="before and behind the front")
    assert covers(result, "peak_force", 900.0)
    assert result.quantities["peak_force"].value == pytest.approx(900.0, rel=0.03)
    assert result.quantities["peak_time"].value == pytest.approx(ECHO, rel=0.01)


@pytest.mark.parametrize(("mass", "known"), [(3.0, 0.3), (10.0, 0.04)])
def test_of_several_contacts_too_the_first_echo_of_a_mass_is_as_high_as_its_wave(mass: float, known: float) -> None:
    """density c (3 v + 2 g L/c): the first element rang on it, a fifth too high however short the steps."""
    exact = 30.0 * (3.0 * 10.0 + 10.0 * ECHO)
    found = fe_contact.run(Scene.load("bar", {"striker.mass": mass}), tolerance=0.1, numerics={"steps": 400})
    assert len(found.contacts) == 2
    assert covers(found, "peak_force", exact)
    assert covers(found, "peak_time", ECHO)
    assert (found.quantities["peak_force"].error or np.inf) < known * exact
    sides = found.history.force_at(ECHO * np.array([1.0 - 1e-9, 1.0 + 1e-9]))
    np.testing.assert_allclose(sides, [30.0 * (10.0 + 10.0 * ECHO), exact], rtol=known, err_msg="before and behind it")


@pytest.mark.parametrize(("share", "tolerance"), [(1.2e-3, 0.1), (4e-3, 0.03), (0.02, 0.01)])
def test_a_mass_that_leaves_the_echo_hardly_any_time_trebles_the_force_all_the_same(
    share: float, tolerance: float
) -> None:
    """F = Z v (4 exp(-Z t/m) - 1) behind the echo, down to zero: steps that passed over it told of no such peak."""
    mass = 10.0 * share
    result = fe_contact.run(Scene.load("bar-impact", {"striker.mass": mass}), tolerance=tolerance)
    slowed = mass / 30.0
    impulse = 300.0 * ECHO + 300.0 * slowed * (3.0 - math.log(4.0))
    known = {"peak_force": 900.0, "peak_time": ECHO, "duration": ECHO + slowed * math.log(4.0), "impulse": impulse}
    for name, value in (known | {"restitution": impulse / (10.0 + mass) / 10.0 - 1.0}).items():
        assert covers(result, name, value), name


@pytest.mark.parametrize(
    ("mass", "numerics", "key"),
    [(5e-3, {}, r"striker\.mass: 0\.005: .* 0, or from 0\.00937"), (0.1, {"steps": 400}, r"steps: 400 .* from 600")],
)
def test_steps_that_pass_over_the_echo_of_a_mass_are_refused(mass: float, numerics: Table, key: str) -> None:
    with pytest.raises(BadInput, match=key):
        fe_contact.run(Scene.load("bar-impact", {"striker.mass": mass}), numerics=numerics)


@pytest.mark.parametrize("weight", [1.002, 1.0045])
def test_what_a_front_leaves_of_the_force_may_end_the_contact_within_a_step_after_it(weight: float) -> None:
    """Behind the echo Z (g T - v) is left, for T - v/g: less than a step, in which the march lets go with the front."""
    gravity = weight * 10.0 / ECHO
    scene = Scene.load("bar-impact", {"model.gravity": gravity})
    result = fe_contact.run(scene, tolerance=0.1)
    assert covers(result, "duration", 2.0 * ECHO - 10.0 / gravity)


def test_of_several_contacts_too_a_force_that_relaxes_within_some_steps_is_in_its_band() -> None:
    """It begins with the glassy density c v, and until the echo it is the force of a single contact: what relaxed while
    the first element rang was lost in a line.
    """
    material = {"law": "sls", "E0": 900.0, "R1": 0.5, "R2": 5e-3, "nu": 0.0, "density": 1.0}
    scene = Scene.load("bar", {"striker.material": material, "model.gravity": 20.0})
    alone = replace(scene, motion=Motion(end_time=0.5))
    found = fe_contact.run(scene, tolerance=0.1, numerics={"steps": 200})
    single = fe_contact.run(alone, tolerance=0.1, numerics={"steps": 1600})
    assert len(found.contacts) == 2
    history, known = found.history, single.history
    assert history.force[0] == pytest.approx(10.0 * math.sqrt(900.0 * 1.5), rel=1e-9)
    early = history.time < 0.4
    missed = np.abs(history.force - known.force_at(history.time))
    bars = history.force_error + np.interp(history.time, known.time, known.force_error)
    assert (missed <= bars)[early].all()
    late = (history.time > 0.1) & early
    assert history.force_error[late].max() < 0.05 * history.force.max(), "wide only where it is a line"


def test_a_smooth_peak_lies_anywhere_between_the_rows_beside_it() -> None:
    """What relaxes behind the echo of a light mass rounds the peak off: the highest row of steps that double is one and
    the same, which told of a billionth of its time.
    """
    material = {"law": "prony", "E_inf": 900.0, "E": [25.0], "tau": [3.8e-3], "nu": 0.0, "density": 1.0}
    scene = Scene.load("bar-impact", {"striker.material": material, "striker.mass": 0.58})
    result = fe_contact.run(scene, tolerance=0.1, numerics={"steps": 6000})
    apart = np.diff(result.history.time)
    assert (result.quantities["peak_time"].error or 0.0) >= np.median(apart[apart > 0.0])


def test_memory_costs_a_bar_its_restitution() -> None:
    """A standard linear solid: the front carries the glassy density c v, heat leaves, the ledger closes."""
    changes = {"law": "sls", "E0": 900.0, "R1": 0.5, "R2": 0.2, "nu": 0.0, "density": 1.0}
    scene = Scene.load("bar-impact", {"striker.material": changes})
    result = fe_contact.run(scene, tolerance=0.05)
    glassy = 900.0 * 1.5
    assert result.history.force[0] == pytest.approx(10.0 * math.sqrt(glassy), rel=0.02)
    energy = {name: value or 0.0 for name, value in result.energy.items()}
    assert energy["viscous"] > 0.01 * energy["in"]
    assert abs(energy["residual"]) < 1e-9 * energy["in"]
    restitution = result.quantities["restitution"].value
    assert restitution is not None
    assert 0.5 < restitution < 0.999


def test_other_choices_agree_within_their_bars() -> None:
    """An implicit scheme and a penalty on the same bar: what they err by lies in their own budget."""
    scene = Scene.load("bar-impact")
    choices = {"scheme": "generalised_alpha", "rho": 0.8, "mass": "spread", "enforcement": "penalty", "steps": 200}
    result = fe_contact.run(scene, tolerance=0.1, numerics=choices)
    for name, exact in {"duration": ECHO, "impulse": 200.0, "restitution": 1.0}.items():
        assert covers(result, name, exact), name
    assert result.error_budget_by_quantity["duration"]["penalty"] > 0.0


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"striker.faces": "bonded"}, "striker.faces"),
        ({"striker.material.density": None}, "striker.material.density"),
        ({"model.inertia": False}, "striker.mass"),
        (
            {"striker.material": {"law": "kelvin_voigt", "E": 1.0, "eta": 1.0, "nu": 0.0, "density": 1.0}},
            "material.law",
        ),
    ],
)
def test_what_has_no_waves_is_refused_by_its_key(changes: dict[str, object], key: str) -> None:
    table = Scene.load("bar-impact").to_dict()
    for path, value in changes.items():
        *parents, last = path.split(".")
        place = table
        for parent in parents:
            place = place[parent]
        if value is None:
            del place[last]
        else:
            place[last] = value
    with pytest.raises(BadInput, match=key):
        fe_contact.run(Scene.from_dict(table))


def test_a_lumped_mass_of_zero_is_none() -> None:
    scene = Scene.load("steel-ball")
    with pytest.raises(BadInput, match=r"striker\.mass"):
        replace(scene, mass=0.0)


@pytest.mark.parametrize("method", ["ting", "correspondence"])
def test_a_law_without_waves_asks_for_a_mass(method: str) -> None:
    with pytest.raises(BadInput, match=r"striker\.mass"):
        fe_contact.run(Scene.load("bar-impact"), method=method)


def test_the_command_writes_contacts(tmp_path: Path) -> None:
    code = main(["run", "bar", "--out", str(tmp_path), "--quiet", "--set", "numerics.steps=100"])
    content = json.loads((tmp_path / "result.json").read_text())
    assert code in (0, 3)
    assert code == (0 if content["converged"] else 3)
    assert len(content["contacts"]) == 2
    assert content["numerics"]["mass"] == "redistributed"
    with (tmp_path / "history.csv").open() as file:
        assert len(list(csv.reader(file))) > 201


def test_the_ledger_has_the_lateral_inertia_of_rayleigh_s_bar() -> None:
    """(nu radius/length)^2 of a bar of one square metre, ten metres long."""
    scene = Scene.load("bar-impact", {"striker.material.nu": 0.3, "striker.faces": "sliding"})
    entry = next(one for one in plan(scene, {}).ledger if one.effect == "lateral inertia")
    assert entry.estimate == pytest.approx((0.3 / 10.0) ** 2 / math.pi)


def test_the_ledger_has_the_strain_behind_the_front_of_a_wave() -> None:
    """v/c: 10 m/s over the 15 m/s of 900 Pa and 4 kg/m3."""
    scene = Scene.load("bar-impact", {"striker.material.density": 4.0})
    entry = next(one for one in plan(scene, {}).ledger if one.effect == "finite strain")
    assert entry.spread == pytest.approx((-10.0 / 15.0, 10.0 / 15.0))


def test_an_end_before_the_separation_is_no_separation() -> None:
    scene = replace(Scene.load("bar-impact"), motion=Motion(end_time=0.3))
    result = fe_contact.run(scene, numerics={"steps": 100})
    assert not result.separated
    assert result.quantities["duration"].value is None
    assert result.history.time[-1] == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("pace", [1.0, 10.0])
def test_contacts_a_short_flight_apart_are_two(pace: float) -> None:
    """Less than an echo apart, the second where the exact waves have it, also of a bar with a faster clock."""
    faster = {"striker.material.E": 900.0 * pace**2, "striker.velocity": 10.0 * pace, "model.gravity": 25.0 * pace**2}
    scene, echo = Scene.load("bar", faster), ECHO / pace
    found = run(scene, plan(scene, {}).numerics)
    exact = bounces(StraightBar(10.0, 30.0 * pace, 30.0 * pace), 10.0 * pace, 25.0 * pace**2, 0.0, 3.0 * echo)
    touches = [piece.start for before, piece in pairwise(exact.pieces) if piece.closed and not before.closed]
    assert [one["start"] for one in found.contacts] == pytest.approx([0.0, *touches], abs=0.02 * echo)
    first = found.contacts[0]["duration"] or 0.0
    assert 0.5 * echo < touches[0] - first < 0.9 * echo


def test_a_march_of_one_contact_ends_with_it() -> None:
    scene = Scene.load("bar-impact")
    numerics = plan(scene, {}).numerics
    found = run(scene, numerics)
    duration = found.reading.quantities["duration"] or 0.0
    assert found.steps <= 1.02 * numerics.steps * duration / ECHO


@pytest.mark.parametrize("end", [0.1, 0.25])
def test_a_march_that_is_cut_off_takes_the_steps_that_there_are_until_then(end: float) -> None:
    """A hundred in an echo."""
    scene = replace(Scene.load("bar-impact"), motion=Motion(end_time=end))
    assert run(scene, plan(scene, {"steps": 100}).numerics).steps == math.ceil(100 * end / ECHO)


def test_a_block_four_times_as_wide_and_heavy_leaves_out_as_much() -> None:
    """All that its ledger estimates goes with the force, and that with the area."""

    def estimates(times: float) -> list[float | None]:
        keys = {"striker.area": 1.5e-4 * times, "striker.mass": 0.02 * times, "model.direction": "down"}
        scene = Scene.load("polymer-prism-waves", {**keys, "striker.sides": "confined"})
        return [entry.estimate for entry in plan(scene, {}).ledger]

    one, four = estimates(1.0), estimates(4.0)
    assert sum(bool(estimate) for estimate in one) >= 1
    assert four == [None if estimate is None else pytest.approx(estimate) for estimate in one]
