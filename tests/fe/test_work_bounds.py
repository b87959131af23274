"""Every answer has a bound of counted work: what is refused is named before, what was found before stands."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fe_contact import cli, reference
from fe_contact.assembly import operators
from fe_contact.budget.budget import TotalWork
from fe_contact.budget.certify import certify
from fe_contact.budget.runs import operations
from fe_contact.dynamics import march
from fe_contact.errors import BodyTooFine, ContactTooBrief, TooManySteps, WavesTooDear
from fe_contact.march import impact
from fe_contact.march.impacts import Grounded
from fe_contact.methods import simulate
from fe_contact.settings import Numerics
from fe_contact.steppers.flat_end import FlatEnd
from fe_contact.steppers.steps import Strike
from fe_contact.steppers.struck import Deformable
from fe_contact.targets.base import struck
from fe_contact.waves import line, plan
from fe_contact.waves.certify import WaveRuns
from fe_contact.waves.moving import UnitBody
from fe_contact.waves.targets.base import WAVES
from lumped import Scene
from lumped.result.result import meets
from lumped.scene.tables import load

COARSE = {"tolerance": 3e-2, "elements_per_contact": 3.0, "steps": 64, "order": 2}
QUICK = [f"--set=numerics.{key}={value}" for key, value in COARSE.items() if key != "tolerance"]


def overridden(name: str, **changes: Any) -> Scene:
    return load(Scene, name, {key.replace("__", "."): value for key, value in changes.items()})[0]


@pytest.mark.parametrize("bound", ["fe_contact.assembly.operators.MOST_UNKNOWNS", "meshes.triangles.MOST_NODES"])
@pytest.mark.parametrize("name", ["steel-ball", "polymer-layer", "two-cylinders", "rod-in-ring", "polymer-layer-waves"])
def test_a_body_too_fine_is_refused_before_its_matrix(name: str, bound: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bound, 70)
    with pytest.raises(BodyTooFine, match=r" 70.*cure: .*numerics.elements_per_contact, numerics.order"):
        simulate(Scene.load(name), "fe", {"elements_per_contact": 7.7})


def test_a_contact_over_in_fewer_steps_than_show_it_has_a_name_and_a_cure() -> None:
    scene = Scene.load("polymer-washer")
    numerics = reference.plan(scene, COARSE).numerics
    late = numerics.varied(contact_time=1e4 * numerics.contact_time)
    with pytest.raises(ContactTooBrief, match=r"over after [1-3] steps, .* cure: --method ting.* more numerics\.steps"):
        certify(Strike.of(scene), scene.geometry, late)
    planned, cured = (
        certify(Strike.of(scene), scene.geometry, one).parts[0]["peak_force"]
        for one in (numerics, late.varied(steps=8 * late.steps))
    )
    assert cured.value == pytest.approx(planned.value, abs=(planned.error or 0.0) + (cured.error or 0.0))


@pytest.mark.tenth
def test_a_finer_body_that_is_refused_leaves_what_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, given = Scene.load("steel-ball"), {"tolerance": 1e-5, "steps": 16, "order": 2}
    monkeypatch.setattr(reference.Statics, "rounds", 0)
    first = simulate(scene, "fe", given)
    monkeypatch.setattr(reference.Statics, "rounds", 4)
    monkeypatch.setattr(operators, "MOST_UNKNOWNS", first.work["degrees_of_freedom"])
    found = simulate(scene, "fe", given)
    assert not found.converged
    assert found.work == first.work
    assert found.quantities == first.quantities


def test_rounds_end_where_the_next_one_takes_too_many_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, given = Scene.load("polymer-sphere"), {"tolerance": 1e-6, "elements_per_contact": 2.0}
    monkeypatch.setattr(reference, "MOST_STEPS", 100)
    found = simulate(scene, "fe", given)
    assert not found.converged
    assert found.quantities["peak_force"].error is not None
    assert found.numerics["elements_per_contact"] == 2.0


@pytest.mark.family
@pytest.mark.parametrize(("bound", "what"), [("MOST_STEPS", "steps"), ("MOST_OPERATIONS", "operations")])
def test_what_keeps_bars_from_the_tolerance_is_said_and_what_is_reached(
    bound: str, what: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reference, bound, 100)
    given = {"tolerance": 1e-6, "elements_per_contact": 2.0, "steps": 40, "order": 2}
    found = simulate(Scene.load("polymer-layer"), "fe", given)
    assert not found.converged
    refused = rf"not reached: .*; finer settings take about \S+ {what}: accepted up to .*; cure: "
    assert re.search(refused, found.message)
    met = re.search(r"a tolerance of (\S+) is met", found.message)
    assert met is not None
    assert meets(found.quantities, 1.01 * float(met[1]))
    assert not meets(found.quantities, 0.7 * float(met[1]))


def test_operations_are_those_of_nested_dissection_outside_and_of_elimination_in_the_zone() -> None:
    """Eight times as many for four times the unknowns; multiplications of a symmetric matrix, row by row; no zone under
    a flat end.
    """

    class Zone(Deformable):
        operator: Any = SimpleNamespace(trace=np.zeros((1, 80)))

    flat, nothing = FlatEnd(1.0, 1.0, 1, 2.0), TotalWork(1024, 0, 0, 1, 1, 1, 0)
    assert operations(nothing, Zone()) == operations(nothing, flat) == 0.0
    factorized, solved = replace(nothing, factorizations=3), replace(nothing, solves=5)
    assert operations(factorized, flat) == 3.0 * 32.0**3
    assert operations(replace(factorized, degrees_of_freedom=4096), flat) == 8.0 * operations(factorized, flat)
    assert operations(solved, flat) == 5.0 * 1024.0 * 10.0
    newton = replace(nothing, iterations=7)
    eliminated = 7.0 * sum(left**2 for left in range(80))
    assert operations(newton, Zone()) == pytest.approx(eliminated, rel=0.03)
    assert operations(newton, flat) == 0.0
    whole = replace(nothing, factorizations=3, solves=5, iterations=7)
    assert operations(whole, Zone()) == sum(operations(one, Zone()) for one in (factorized, solved, newton))


@pytest.mark.tenth
def test_finer_rounds_stay_within_the_work_that_was_predicted(monkeypatch: pytest.MonkeyPatch) -> None:
    """The operations counted of a round are those predicted from the one before, within a factor of two."""
    scene, rounds, most = Scene.load("polymer-layer"), list[tuple[Numerics, float]](), 4e10

    def certified(*given: Any) -> Any:
        found = certify(*given)
        rounds.append((found.numerics, operations(found.work, found.surface)))
        return found

    monkeypatch.setattr("fe_contact.reference.certify", certified)
    monkeypatch.setattr(reference, "MOST_OPERATIONS", most)
    found = simulate(scene, "fe", {"tolerance": 1e-4})
    predicted = re.search(r"about (\S+) operations: accepted up to", found.message)
    assert predicted is not None
    assert float(predicted[1]) > most
    assert len(rounds) > 1
    for (coarse, first), (fine, second) in pairwise(rounds):
        finer = fine.steps / coarse.steps * (fine.elements_per_contact / coarse.elements_per_contact) ** 3
        assert 0.5 < second / (finer * first) < 2.0


def test_a_word_is_said_before_and_while_bodies_are_meshed(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, told, built = Scene.load("polymer-layer"), list[str](), list[int]()

    def body(*given: Any) -> Any:
        built.append(len(told))
        return struck(*given)

    monkeypatch.setattr("fe_contact.budget.runs.struck", body)
    monkeypatch.setattr(reference.Statics, "rounds", 0)
    given = {"elements_per_contact": 2.0, "steps": 16, "order": 1}
    reference.solve(scene, given, lambda message, *_: told.append(message))
    assert built[0] >= 2  # what is expected, and the march that is begun
    assert np.all(np.diff(built) > 0)


def test_a_row_of_contacts_ends_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("fe_contact.march.impacts.MOST_STEPS", 60)
    found = simulate(overridden("ball-bouncing", motion__impacts=100), "fe", {"tolerance": 1e-2})
    assert Grounded.MANY.value in found.message
    assert not found.converged
    assert found.contacts


@pytest.mark.tenth
@pytest.mark.parametrize(
    "name",
    [
        "polymer-sphere-waves",
        pytest.param("ball-bouncing-waves", marks=pytest.mark.full),
        "polymer-layer-waves",
        "two-finite-spheres-waves",
    ],
)
def test_the_cost_of_waves_is_known_before(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Within a factor of two: what is counted is unknowns times steps."""
    spent = list[float]()
    follow = WaveRuns.follow

    def followed(runs: WaveRuns, settings: Any) -> Any:
        found = follow(runs, settings)
        spent.append(runs.spent)
        return found

    monkeypatch.setattr(WaveRuns, "follow", followed)
    monkeypatch.setattr("fe_contact.waves.certify.Waves.rounds", 0)
    scene = Scene.load(name)
    target = WAVES.get(scene.target.name)
    expected = target.cost(scene, target.plan(scene, COARSE).numerics)
    simulate(scene, "fe", COARSE)
    share = expected.work / (expected.unknowns + plan.STEP) * expected.unknowns / spent[-1]
    assert 0.5 < share < 2.0


def test_the_foretold_work_grows_with_unknowns_but_a_step_has_its_own() -> None:
    """And with every contact that is expected."""
    numerics = WAVES.get("rod").plan(Scene.load("rod"), {}).numerics
    few, twice = (plan.Cost.of(unknowns, numerics, 1) for unknowns in (200, 400))
    assert 0.0 < few.work < twice.work < 2.0 * few.work
    assert few.steps >= numerics.steps
    assert plan.Cost.of(200, numerics, 3).work > 3.0 * few.work
    assert plan.Cost.of(200, numerics, 1000).work == plan.Cost.of(200, numerics, 100).work
    judged = plan.Cost.of(200, numerics, 1, 300)
    assert (judged.unknowns, judged.work > few.work) == (300, True)
    assert plan.Cost.of(200, numerics.varied(peak_share=1e-3), 1).steps > numerics.steps


def test_a_body_with_waves_may_have_as_many_unknowns_as_one_without_and_not_many_more() -> None:
    """Whose factors take a gigabyte; what is kept of a march as much again."""
    plan.Cost(operators.MOST_UNKNOWNS, 100, 1.0).check()
    with pytest.raises(WavesTooDear, match=r"\d\.\d GB"):
        plan.Cost(2 * operators.MOST_UNKNOWNS, 100, 1.0).check()


@pytest.mark.parametrize("name", ["ball-bouncing-waves", "polymer-layer-waves", "two-finite-spheres-waves"])
def test_nothing_is_assembled_to_know_the_cost_of_waves(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """A body that is refused for its size takes no memory."""
    for part in ("mass", "stiffness", "dashpots"):
        monkeypatch.setattr(UnitBody, part, property(lambda unit: pytest.fail("assembled")))
    scene = Scene.load(name)
    target = WAVES.get(scene.target.name)
    assert target.cost(scene, target.plan(scene, COARSE).numerics).unknowns > 100


def test_waves_that_cost_too_much_are_refused_before_the_first_step(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "MOST_WORK", 1e3)
    monkeypatch.setattr(WaveRuns, "follow", lambda *_: pytest.fail("marched"))
    with pytest.raises(WavesTooDear, match=r"unknowns, \d+ steps: about .* s of one core .*cure: a larger tolerance"):
        simulate(Scene.load("polymer-sphere-waves"), "fe", COARSE)


def test_finer_waves_that_cost_too_much_leave_what_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, given = Scene.load("polymer-sphere-waves"), {"tolerance": 3e-3, "elements_per_contact": 2.0, "order": 1}
    target = WAVES.get(scene.target.name)
    first = target.cost(scene, target.plan(scene, given).numerics)
    monkeypatch.setattr(plan, "MOST_WORK", 1.01 * first.work)
    found = simulate(scene, "fe", given)
    assert not found.converged
    assert found.numerics["steps"] == first.steps
    assert np.isfinite(found.quantities["peak_force"].error or np.nan)


def test_a_first_contact_that_does_not_end_is_no_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(impact, "STEPS_ALLOWED", 0.5)
    scene = Scene.load("polymer-sphere", {"motion.impacts": 2, "model.gravity": 9.81})
    with pytest.raises(TooManySteps, match="cure: "):
        simulate(scene, "fe", {"steps": 40})


@pytest.mark.parametrize("steps", [20, 40])
def test_a_weight_that_creeps_for_long_is_followed_for_a_shorter_time_however_many_steps(steps: int) -> None:
    """It swings for so many contact times; finer steps may be more, and each is shorter."""
    fluid = {"law": "maxwell", "E": 1.8e6, "eta": 108.0, "nu": 0.3}
    long = Scene.load("polymer-cone", {"target.material": fluid, "model.gravity": 3.5e-3, "motion.end_time": 9.5})
    with pytest.raises(TooManySteps) as refused:
        simulate(long, "fe", {"tolerance": 3e-2, "steps": steps})
    assert refused.value.cure == "an earlier motion.end_time"
    assert simulate(long.changed({"motion.end_time": 3.0}), "fe", {"tolerance": 3e-2, "steps": steps}).converged


def test_a_march_ends_after_so_much_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(march, "MOST_WORK", 1e4)
    with pytest.raises(TooManySteps, match="cure: "):
        simulate(Scene.load("rod"), "fe", {})


def test_lines_are_doubled_as_far_as_their_work_is_bearable(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(line, "MOST_WORK", 1.0)
    found, free = simulate(Scene.load("bar"), "fe", {}), WAVES.get("plane").plan(Scene.load("bar"), {})
    assert not found.converged
    assert found.numerics["steps"] == free.numerics.steps


def test_plan_says_what_waves_take_and_what_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["plan", "polymer-sphere-waves", "--json", *QUICK]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["cost"]["unknowns"] > 100
    assert found["refused"] is None
    assert cli.main(["plan", "polymer-sphere-waves", "--json", *QUICK, "--set=numerics.steps=8192"]) == 0
    assert json.loads(capsys.readouterr().out)["cost"]["cpu_s"] > 50 * found["cost"]["cpu_s"]
    assert cli.main(["plan", "polymer-sphere-waves", "--tolerance", "1e-4"]) == 3
    told = capsys.readouterr()
    assert "elements_per_contact" in told.out
    assert "cure: " in told.err


@pytest.mark.family
@pytest.mark.parametrize(("name", "most"), [("polymer-o-ring", 3.5), ("two-finite-spheres", 2.0)])
def test_the_coming_contact_is_guessed_so_well_that_few_sets_are_tried(name: str, most: float) -> None:
    """Growing and receding, on one side of the axis and on both of a crown."""
    work = simulate(Scene.load(name), "fe", {"tolerance": 1e-2}).work
    assert work["iterations"] <= most * work["contact_problems"]


def test_how_often_was_refined_is_said_where_it_was_not_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(line.Doubling, "rounds", 1)
    material = {"law": "sls", "E1": 2.7e5, "E2": 1.2e5, "C1": 124.0, "nu": 0.3, "density": 110.0}
    rod = {"shape": "rod", "area": 4.7e-6, "length": 0.1, "end": "free", "material": material}
    striker = {"shape": "punch", "radius": 2.2e-3, "mass": 1.1e-3, "velocity": 0.1}
    scene = Scene.from_dict({"striker": striker, "target": rod, "model": {"inertia": True}})
    found = simulate(scene, "fe", {"tolerance": 1e-4})
    assert not found.converged
    assert "; refined 1 times, which was not enough; a tolerance of " in found.message


@pytest.mark.tenth
def test_steps_that_better_nothing_are_not_halved_for_ever() -> None:
    """Under a usual penalty the force of a bar's impact chatters, whatever the steps: two rounds show it."""
    given = {"scheme": "generalised_alpha", "mass": "redistributed", "enforcement": "penalty", "rho": 0.5}
    found = simulate(Scene.load("bar-impact"), "fe", {"tolerance": 0.01, **given})
    said = re.search(r"; (\d+) steps do no better than (\d+); ", found.message)
    assert not found.converged
    assert said
    assert int(said[1]) == 4 * int(said[2]) == found.numerics["steps"]
