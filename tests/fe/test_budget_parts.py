"""Parts of the error budget alone: what is refined, the rows of a curve with waves, the touches of several impacts."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fe_contact import reference, relaxing_impact
from fe_contact.budget import several, solved
from fe_contact.budget.budget import CAUSES, TotalWork, shares_of
from fe_contact.budget.certify import (
    DAMPED_ANYWHERE,
    KEPT,
    LEAST_ORDER,
    MESH_ORDER,
    MESH_ORDER_ANYWHERE,
    NODEWISE_ANYWHERE,
    _judging,
    other_mesh,
)
from fe_contact.budget.plan import ELEMENTS, Plan
from fe_contact.budget.refine import AIM, FACTOR, Growth, factors, missing
from fe_contact.budget.runs import AnyRuns, Runs
from fe_contact.budget.several import Row
from fe_contact.budget.solved import SolvedBy
from fe_contact.budget.variation import SAFETY, UNORDERED, factor
from fe_contact.march.impacts import Followed
from fe_contact.plastic import course
from fe_contact.plastic import indent as plastic_indent
from fe_contact.plastic.indent import YieldingWay, _found
from fe_contact.plastic.path import PlasticFlowLost
from fe_contact.settings import WaveNumerics
from fe_contact.steppers.steps import Strike, Work
from fe_contact.waves import certify
from fe_contact.waves.certify import Waves
from fe_contact.waves.plan import DEFAULTS, FEWEST, Cost
from fe_contact.waves.plan import ELEMENTS as ELEMENTS_OF_WAVES
from lumped import Scene
from lumped.errors import NotReached
from lumped.materials import Relaxation
from lumped.result.result import RULED_ABSOLUTE, RULED_RELATIVE, UNITS, Quantity

SETTINGS: dict[str, Any] = {"tolerance": 3e-3, "steps": 200, "contact_radius": 1e-3, "contact_time": 1e-3}


@pytest.fixture
def numerics() -> WaveNumerics:
    given = {"elements_per_contact": 4.0, "penalty": 100.0, "far_radius": 20.0, "peak_share": 0.5}
    return WaveNumerics(**DEFAULTS | given | SETTINGS)


@pytest.mark.parametrize(("order", "step"), [(1.0, 2.0), (2.0, 2.0), (1.0, 2**0.25)])
def test_what_a_step_is_worth_is_what_it_takes_from_the_bar(order: float, step: float) -> None:
    """A share of an error that falls as the setting to minus ``order``, over what the march then costs more."""
    left = 0.3 * step**-order
    assert Growth(order, step, most=4.0, work=0.5).worth(0.3) == pytest.approx((0.3 - left) / (0.5 * math.log(step)))


GROWTHS = {
    "mesh": Growth(order=2.0, step=1.25, most=8.0, work=2.0),
    "penalty": Growth(order=1.0, step=2.0, most=8.0, work=0.5),
    "time_step": Growth(order=1.0, step=1.5, most=8.0, work=1.0),
}


def test_a_round_of_all_that_stands_out_takes_an_error_to_a_half_or_less_and_is_not_dearer_than_that() -> None:
    """By the orders that bars trust, of the usual elements and of steps extrapolated."""
    orders = {"mesh": MESH_ORDER[4], "time_step": 2, **LEAST_ORDER}
    assert set(FACTOR) == set(orders)
    for cause, raised in FACTOR.items():
        assert 2.0 <= raised ** orders[cause] <= 4.0


def test_what_deserves_less_trust_is_trusted_no_more_than_another_run_and_no_less_than_a_tenth_of_that() -> None:
    """Weights make a bar of a mesh that stays as wide as what it changes at least; what branches as fast as a step
    leave is what the finest run errs by without extrapolation, at least, and at most where no order shows.
    """
    once = factor(MESH_ORDER_ANYWHERE, False)
    for weight in (*DAMPED_ANYWHERE.values(), *NODEWISE_ANYWHERE.values()):
        assert 1.0 <= weight * once <= 10.0
    for share in KEPT.values():
        assert 1.0 / (2**2 - 1) <= share <= UNORDERED


@pytest.mark.parametrize("growths", [certify.GROWTH, course.GROWTH])
def test_no_cause_alone_makes_a_round_more_than_four_times_as_dear(growths: dict[str, Growth]) -> None:
    """Nor more than twice where its bar misses by little; and a step is one: it raises, and may be taken.

    Unknowns of a mesh in the plane go as the square of its elements, and no setting comes for nothing.
    """
    assert set(growths) == set(CAUSES)
    assert growths["mesh"].work >= 2.0
    assert min(growth.work for growth in growths.values()) >= 0.1
    for growth in growths.values():
        assert 1.0 < growth.step <= growth.most
        assert growth.step**growth.work <= 2.0
        assert growth.most**growth.work <= 4.0


@pytest.mark.parametrize("seed", range(5))
def test_settings_are_raised_until_bars_are_predicted_to_meet_the_tolerance_and_no_further(seed: int) -> None:
    """Of two quantities: some last step is needed, and no cause alone would do it for less work."""
    rng = np.random.default_rng(seed)
    shares = {cause: rng.uniform(0.0, 2.0, 2) for cause in GROWTHS}

    def bar(chosen: dict[str, float]) -> float:
        left = [share / chosen[cause] ** GROWTHS[cause].order for cause, share in shares.items()]
        return float(np.max(sum(left)))

    chosen = factors(shares, GROWTHS, dict.fromkeys(GROWTHS, 1e3))
    assert bar(chosen) <= AIM
    raised = [cause for cause, factor in chosen.items() if factor > 1.0]
    assert any(bar(chosen | {cause: chosen[cause] / GROWTHS[cause].step}) > AIM for cause in raised)
    cost = math.prod(chosen[cause] ** GROWTHS[cause].work for cause in GROWTHS)
    for cause, growth in GROWTHS.items():
        alone = dict.fromkeys(GROWTHS, 1.0)
        while bar(alone) > AIM and alone[cause] < 1e3:
            alone[cause] *= growth.step
        assert bar(alone) > AIM or cost <= 1.01 * growth.step**growth.work * alone[cause] ** growth.work


def test_a_setting_is_raised_within_its_room_and_one_that_errs_by_nothing_stays() -> None:
    shares = {"mesh": np.array([4.0]), "penalty": np.array([0.0]), "time_step": np.array([4.0])}
    room = {"mesh": 1.25**2, "penalty": 8.0, "time_step": 1.0}
    assert factors(shares, GROWTHS, room) == {"mesh": 1.25**2, "penalty": 1.0, "time_step": 1.0}
    calm = {cause: 0.2 * share for cause, share in shares.items() if cause != "mesh"}
    equal = {cause: np.array([0.5]) for cause in ("mesh", "penalty")}
    assert factors(equal, GROWTHS, room) == {"mesh": 1.0, "penalty": 2.0}, "which is cheaper"
    assert factors(calm, GROWTHS, room) == {"penalty": 1.0, "time_step": 1.0}, "bars meet the tolerance"


def test_steps_are_raised_to_a_whole_number_and_all_else_as_far_as_predicted(numerics: WaveNumerics) -> None:
    shares = {cause: np.array([2.0]) for cause in CAUSES}
    finer = missing(shares, certify.GROWTH, numerics, ("far_radius",))
    room = {cause: growth.most for cause, growth in certify.GROWTH.items()} | {"far_field": 1.0}
    raised = factors(shares, certify.GROWTH, room)
    assert raised["mesh"] > 1.0
    assert finer.elements_per_contact == raised["mesh"] * numerics.elements_per_contact
    assert (finer.steps, type(finer.steps)) == (raised["time_step"] * numerics.steps, int)
    assert finer.far_radius == numerics.far_radius


@pytest.mark.parametrize("missed", [0.5, 0.99, 1.01, 2.0])
def test_what_yields_is_pressed_again_with_finer_settings_where_bars_miss_the_tolerance(
    missed: float, numerics: WaveNumerics
) -> None:
    """By the sum of all causes at the worst depth."""
    nothing: Any = None
    share = missed * numerics.tolerance
    found: Any = SimpleNamespace(
        budget={"mesh": share * np.array([0.6, 0.1]), "time_step": share * np.array([0.4, 0.8])}, numerics=numerics
    )
    way = YieldingWay(nothing, nothing, frozenset(), nothing)
    assert (way.finer(found).settings is None) == (missed < 1.0)
    kept = YieldingWay(nothing, nothing, frozenset({"elements_per_contact", "steps"}), nothing)
    assert kept.finer(found).settings is None


@pytest.mark.parametrize(("pinned", "holds"), [((), 80), ((), 400), (("steps",), 80)])
def test_flow_that_is_lost_is_followed_by_twice_the_steps_where_they_are_open(
    pinned: tuple[str, ...], holds: int, numerics: WaveNumerics, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As often as there is work for; its name says else what helps."""
    nothing: Any = None
    tried = list[int]()

    def refined(way: object, chosen: WaveNumerics) -> tuple[str, str]:
        tried.append(chosen.steps)
        if chosen.steps < holds:
            raise PlasticFlowLost(1e-5)
        return "found", ""

    monkeypatch.setattr(plastic_indent, "refine", refined)
    way = YieldingWay(nothing, nothing, frozenset(pinned), nothing)
    if holds > course.MOST_STEPS or pinned:
        with pytest.raises(PlasticFlowLost, match=r"numerics\.steps"):
            _found(way, numerics.varied(steps=20))
    else:
        assert _found(way, numerics.varied(steps=20)) == "found"
    assert tried == [20, 40, 80, 160, 320][: 1 if pinned else 3 if holds == 80 else 5]


def waves(numerics: WaveNumerics, pinned: tuple[str, ...] = ()) -> Waves:
    nothing: Any = None
    chosen: Any = SimpleNamespace(pinned=pinned, numerics=numerics)
    return Waves(nothing, chosen, nothing, nothing, nothing)


def judged(numerics: WaveNumerics, share: float, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A contact each of whose causes takes such a ``share`` of the tolerance of every quantity."""
    monkeypatch.setattr(certify, "shares_of", lambda one, cause: np.full(6, share))
    monkeypatch.setattr(certify, "meets", lambda part, tolerance: 4 * share <= 1.0)
    return SimpleNamespace(numerics=numerics, row=[None], parts=[None])


def test_waves_are_refined_until_their_bars_meet_the_tolerance(
    numerics: WaveNumerics, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert waves(numerics).finer(judged(numerics, 0.4, monkeypatch)).settings not in (None, numerics)
    assert waves(numerics).finer(judged(numerics, 0.1, monkeypatch)).settings is None


def test_where_all_settings_are_kept_nothing_is_refined(
    numerics: WaveNumerics, monkeypatch: pytest.MonkeyPatch
) -> None:
    pinned = ("elements_per_contact", "penalty", "steps", "far_radius")
    assert waves(numerics, pinned).finer(judged(numerics, 0.4, monkeypatch)).settings is None


def test_the_contact_whose_bars_miss_most_says_what_is_refined(
    numerics: WaveNumerics, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of several in a row, whichever that is."""
    shares = {"calm": dict.fromkeys(CAUSES, 0.01), "wild": dict.fromkeys(CAUSES, 3.0)}
    monkeypatch.setattr(reference, "meets", lambda part, tolerance: False)
    monkeypatch.setattr(reference, "shares_of", lambda one, cause: np.array([0.0, shares[one][cause]]))
    monkeypatch.setattr(reference, "_too_dear", lambda found, finer: "")
    monkeypatch.setattr(reference, "dominant", lambda excess, *_, least: excess)
    chosen: Any = SimpleNamespace(pinned=())
    for row in (["calm", "wild"], ["wild", "calm"]):
        found: Any = SimpleNamespace(numerics=numerics, row=row, parts=row)
        assert reference.Statics(chosen, chosen, chosen).finer(found).settings == shares["wild"]


def test_what_relaxes_strained_much_is_refined_by_what_misses_most(monkeypatch: pytest.MonkeyPatch) -> None:
    """And not at all where the bars meet the tolerance."""
    monkeypatch.setattr(relaxing_impact, "shares_of", lambda one, cause: np.array([0.1, 3.0]))
    monkeypatch.setattr(relaxing_impact, "dominant", lambda excess, _, pinned, least: (excess, pinned, least))
    chosen: Any = SimpleNamespace(pinned=frozenset())
    found: Any = SimpleNamespace(numerics=SimpleNamespace(tolerance=1e-3, elements_per_contact=3.0), quantities=None)
    for met, order, kept in ((True, 1.5, set()), (False, 1.5, set()), (False, 0.4, {"elements_per_contact"})):
        body = SimpleNamespace(solid=SimpleNamespace(mesh_order=order))
        monkeypatch.setattr(relaxing_impact, "Marcher", SimpleNamespace(of=lambda scene, given, body=body: body))
        monkeypatch.setattr(relaxing_impact, "meets", lambda quantities, tolerance, met=met: met)
        settings = relaxing_impact.RelaxingStrikes(chosen, chosen, chosen).finer(found).settings
        assert settings == (None if met else (dict.fromkeys(CAUSES, 3.0), kept, 1.0))


@pytest.mark.parametrize("nodes", [None, 24.0])
@pytest.mark.parametrize("elements", [1.0, 3.0, 5.0, 12.0])
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_another_mesh_tells_of_the_error_of_one_that_converges(
    order: int, elements: float, nodes: float | None, numerics: WaveNumerics
) -> None:
    """Half as fine, or at least twice, where half would be too coarse; one that may lock, by twice its order."""
    given = numerics.varied(order=order, elements_per_contact=elements)
    mesh, trusted = other_mesh(given, nodes=nodes)
    nodes_of = mesh.order * mesh.elements_per_contact
    if order < 3:
        assert mesh.order == 2 * order
        assert mesh.elements_per_contact >= elements
        assert nodes_of >= (4.0 * mesh.order if nodes is None else nodes)
        enough = ELEMENTS if nodes is None else nodes / mesh.order
        assert mesh.elements_per_contact <= max(elements, enough), "no finer than what is usual: it costs as much"
        assert trusted > 2.0, "no order shows: the finer one errs by less than the coarser"
        return
    power = {3: 1, 4: 2}[order]
    finer = mesh.elements_per_contact > elements
    assert finer == (elements < 2.0 if nodes is None else order * elements < nodes)
    ratio = mesh.elements_per_contact / elements
    assert ratio >= 2.0 if finer else ratio == 0.5
    error, other = elements**-power, mesh.elements_per_contact**-power
    assert error <= trusted * abs(error - other) <= 1.2500001 * (error if ratio <= 2.0 else 2.0 * error)


def test_the_usual_mesh_of_waves_is_halved_and_the_coarsest_doubled(numerics: WaveNumerics) -> None:
    """Half as fine a one costs a quarter, but what half of few nodes change may vanish by chance."""
    for elements, finer in ((ELEMENTS_OF_WAVES, False), (FEWEST["elements"], True)):
        given = numerics.varied(order=DEFAULTS["order"], elements_per_contact=elements)
        mesh, _ = certify.tells_of_mesh(given)
        assert (mesh.elements_per_contact > elements) == finer
        assert mesh.order == given.order


def test_shares_of_the_tolerance_are_relative_or_absolute_and_of_what_is_known() -> None:
    """Peaks, duration and impulse by their size, restitution and the history's distance as they are."""
    values = dict.fromkeys(UNITS, 4.0) | {"restitution": 0.5, "history_l2": 0.0, "duration": None, "impulse": -2.0}
    one: Any = SimpleNamespace(
        numerics=SimpleNamespace(tolerance=1e-2),
        quantities={name: Quantity(value, 0.0, "") for name, value in values.items()},
        error=lambda name, cause: 0.08,
    )
    expected = [0.08 / abs(values[name] or 1.0) for name in RULED_RELATIVE if values[name] is not None]
    expected += [0.08 for name in RULED_ABSOLUTE]
    assert sorted(shares_of(one, "mesh")) == pytest.approx(sorted(np.array(expected) / 1e-2))


def test_the_work_of_all_marches_is_added_up() -> None:
    assert Work() == (0, 0, 0)
    found = TotalWork.of([Work(3, 4, 5), Work(30, 40, 50)], 7, 2, 9, flown=100)
    assert found == TotalWork(7, 2, 9, marches=2, steps=133, contact_problems=44, iterations=55)


def test_the_work_of_waves_is_that_of_all_runs_their_contacts_and_flights(numerics: WaveNumerics) -> None:
    """A back-substitution a contact problem and a step of a flight, on the unknowns of the run's own body."""

    def run(size: int, flown: int, made: int, *steps: int) -> Any:
        contacts = [SimpleNamespace(march=SimpleNamespace(work=Work(count, 2 * count, 3 * count))) for count in steps]
        return certify.WaveRun(Followed(contacts, None), size, flown, made)

    nothing: Any = None
    runs = certify.WaveRuns(nothing, nothing, nothing, 1)
    runs._runs = {numerics: run(10, 7, 1, 100, 50), numerics.varied(steps=3): run(40, 0, 2, 30)}
    assert runs.spent == 10 * 157 + 40 * 30
    assert runs.work() == TotalWork(40, 3, 7 + 360, marches=3, steps=187, contact_problems=360, iterations=540)
    told = list[float]()
    runs.counted = told.append
    for unknowns in (10, 40, 20):
        runs._count(unknowns, 2.0)
    assert told == [2.0, 2.0, 1.0], "steps of the largest body so far"


def test_a_round_is_refused_by_the_work_it_takes(numerics: WaveNumerics, monkeypatch: pytest.MonkeyPatch) -> None:
    """Three times the steps on a mesh twice as fine: three times as many, and 24 times the operations."""
    finer = replace(numerics, steps=3 * numerics.steps, elements_per_contact=2.0 * numerics.elements_per_contact)
    found: Any = SimpleNamespace(numerics=numerics, work=SimpleNamespace(steps=1000), surface=None)
    monkeypatch.setattr(reference, "operations", lambda work, surface: 1e9)
    for bound, taken, told in (
        ("MOST_STEPS", 3000, "about 3000 steps"),
        ("MOST_OPERATIONS", 2.4e10, r"about 2.4e\+10"),
    ):
        monkeypatch.setattr(reference, bound, 1.01 * taken)
        assert reference._too_dear(found, finer) == ""
        monkeypatch.setattr(reference, bound, 0.99 * taken)
        assert re.search(told, reference._too_dear(found, finer))
        monkeypatch.setattr(reference, bound, 1e99)


def test_the_budget_of_a_result_is_that_of_its_peak_force_relative_to_it() -> None:
    """Shares of a force of 4 N, by cause; and the errors themselves, quantity by quantity."""
    share = dict(zip(CAUSES, (1e-2, 2e-3, 3e-4, 0.0), strict=True))
    values = dict.fromkeys(UNITS, 7.0) | {"peak_force": 4.0}
    found: Any = SimpleNamespace(
        causes=CAUSES,
        numerics=SimpleNamespace(tolerance=1.0, as_dict=dict),
        quantities={name: Quantity(value, 1e-2, "") for name, value in values.items()},
        error=lambda name, cause: values[name] * share[cause],
        grounded=None,
        parts=(),
        history=list,
        **dict.fromkeys(("separated", "energy", "energy_errors", "counted", "contacts")),
    )
    scene: Any = SimpleNamespace(motion=SimpleNamespace(impacts=1), model=None)
    result = solved.record(scene, SolvedBy(Plan(found.numerics, frozenset(), ()), found, {}, ""))
    assert result.error_budget == pytest.approx(share)
    for name, value in values.items():
        assert result.error_budget_by_quantity[name] == {cause: value * part for cause, part in share.items()}


def limits(refused: str = "", pinned: tuple[str, ...] = ()) -> Any:
    """Of a solved impact, what keeps it from its tolerance."""
    return SimpleNamespace(refused=refused, plan=SimpleNamespace(pinned=pinned))


def unreached(*parts: dict[str, Quantity], tolerance: float = 1e-3, cause: str = "mesh", separated: bool = True) -> Any:
    """A contact, or several, of which one cause alone errs; the first one's quantities are those of all."""
    return SimpleNamespace(
        causes=CAUSES,
        numerics=SimpleNamespace(tolerance=tolerance),
        parts=parts,
        quantities=parts[0],
        separated=separated,
        error=lambda name, by: parts[0][name].error if by == cause else 0.0,
    )


def lasting(error: float) -> dict[str, Quantity]:
    """Quantities of which the duration's bar is so wide."""
    return {name: Quantity(1.0, error if name == "duration" else 1e-4, "") for name in UNITS}


def test_what_one_contact_misses_is_said_without_its_number() -> None:
    for impacts, said in ((1, "tolerance"), (2, "contact 1: tolerance")):
        scene: Any = SimpleNamespace(motion=SimpleNamespace(impacts=impacts))
        first, *_ = solved._missed(scene, limits(), unreached(lasting(1e-2)))
        assert first == f"{said} 0.001 not reached: duration to 0.01"


@pytest.mark.parametrize(("error", "met"), [(1.1e-2, "0.013"), (2.3, ""), (np.inf, "")])
def test_the_tolerance_that_is_met_is_said_where_it_is_known(error: float, met: str) -> None:
    """Rounded up to a tenth of a decade."""
    scene: Any = SimpleNamespace(motion=SimpleNamespace(impacts=1))
    said = "; ".join(solved._missed(scene, limits(), unreached(lasting(error))))
    assert ("a tolerance of " in said) == bool(met)
    assert ("no tolerance that is accepted is met" in said) == (error == 2.3)
    assert not met or f"a tolerance of {met} is met" in said


@pytest.mark.parametrize("separated", [True, False])
@pytest.mark.parametrize(
    ("cause", "key"),
    [("mesh", "order"), ("mesh", "elements_per_contact"), ("time_step", "steps"), ("penalty", "penalty")],
)
def test_the_cure_is_that_of_the_largest_cause(cause: str, key: str, separated: bool) -> None:
    """A setting of one's own is named where it holds that cause; an earlier end where the contact has none."""
    scene: Any = SimpleNamespace(motion=SimpleNamespace(impacts=1))
    wide, near = (unreached(lasting(error), cause=cause, separated=separated) for error in (2.3, 1e-2))
    everything = ("order", "elements_per_contact", "steps", "penalty")
    of_others = tuple(set(everything) - set(solved.HELD[cause]))
    for found in (wide, near):
        assert f"the largest cause is the {cause.replace('_', ' ')}" in solved._missed(scene, limits(), found)
        last = solved._missed(scene, limits(pinned=(key,)), found)[-1]
        assert f"a higher numerics.{key}" in last
        assert "numerics" not in solved._missed(scene, limits(pinned=of_others), found)[-1]
        assert ("motion.end_time" in last) == (found is wide and not separated)
    assert "a larger tolerance" not in solved._missed(scene, limits(pinned=(key,)), wide)[-1]
    assert "a larger tolerance" in solved._missed(scene, limits(pinned=(key,)), near)[-1]


def test_where_no_key_helps_no_cure_is_named() -> None:
    scene: Any = SimpleNamespace(motion=SimpleNamespace(impacts=1))
    last = solved._missed(scene, limits(), unreached(lasting(2.3), tolerance=0.1))[-1]
    assert "cure" not in last
    assert "no setting is known to help" in last


@pytest.mark.parametrize("worst", [0, 1])
def test_of_several_contacts_the_tolerance_is_met_that_all_of_them_meet(worst: int) -> None:
    """Each that misses is named by its number, and no other."""
    parts = [
        {name: Quantity(1.0, {"duration": error}.get(name, 1e-4), "") for name in UNITS}
        for error in (*np.roll([3.9e-2, 1.1e-2], worst).tolist(), 5e-4)
    ]
    found = unreached(*parts)
    scene: Any = SimpleNamespace(motion=SimpleNamespace(impacts=3))
    said = "; ".join(solved._missed(scene, limits("so dear"), found))
    assert "a tolerance of 0.04 is met" in said
    assert "so dear" in said
    errors = ["0.039", "0.011"]
    for number in (1, 2):
        assert f"contact {number}: tolerance 0.001 not reached: duration to {errors[number - 1 - worst]}" in said
    assert "contact 3" not in said
    found.parts = (parts[2], parts[2])
    assert solved._missed(scene, limits("so dear"), found) == []


@pytest.mark.parametrize("few", [True, False])
def test_a_mesh_is_varied_with_no_fewer_steps_where_few_would_hide_what_it_changes(
    few: bool, numerics: WaveNumerics
) -> None:
    """One that stays in its place, or is coarse."""
    cheap, settings = (numerics.varied(steps=steps) for steps in ((400, 160) if few else (160, 400)))
    assert _judging(settings, cheap, "mesh", True).steps == 400
    assert _judging(settings.varied(elements_per_contact=1.0), cheap, "mesh").steps == 400
    assert _judging(settings.varied(elements_per_contact=40.0), cheap, "mesh") == cheap


def test_rows_of_a_curve_with_waves_follow_the_tolerance(numerics: WaveNumerics) -> None:
    """A polynomial of degree five between them: twice as many err by 2^-5. Fewer steps leave no fewer rows.

    A contact that lasts twice as long as planned has twice as many.
    """
    many = replace(numerics, steps=20_000)
    tight = replace(many, tolerance=many.tolerance / 2**5)
    rows, more, of_half = (len(certify._rows(*one, 1.0)) for one in ((20_000, many), (20_000, tight), (10_000, many)))
    assert more - 1 == pytest.approx(2 * (rows - 1), abs=1)
    assert of_half == rows
    assert len(certify._rows(40_000, many, 1.0)) - 1 == pytest.approx(2 * (rows - 1), abs=1)


@pytest.mark.parametrize("coarse", [False, True])
def test_every_setting_of_waves_is_told_by_the_cheapest_runs_that_know_it(
    monkeypatch: pytest.MonkeyPatch, numerics: WaveNumerics, coarse: bool
) -> None:
    """Steps by half of them, all else with few; the far field on the coarser mesh. A coarse mesh, a soft penalty and a
    near far field are told by finer ones.
    """
    elements, penalty, far = (2.0, 150.0, 4.0) if coarse else (12.0, 600.0, 20.0)
    given = numerics.varied(order=3, elements_per_contact=elements, penalty=penalty, far_radius=far)
    contact, asked = SimpleNamespace(march="march", strike="strike"), list[tuple[int, WaveNumerics]]()
    monkeypatch.setattr(certify, "curve_of", lambda *of: of)
    monkeypatch.setattr(certify, "reading", lambda *of: of)
    runs: Any = SimpleNamespace(
        cheap=72,
        rings=False,
        follow=lambda one: SimpleNamespace(contacts=[None, contact]),
        curve=lambda number, one: asked.append((number, one)) or one,
    )
    value, changes = certify._judged(runs, 1, given)
    assert value == ("march", "strike", given)
    assert {number for number, _ in asked} == {1}
    cheap = given.varied(steps=72)
    mesh = cheap.varied(elements_per_contact=24.0 / 3.0 if coarse else 6.0)
    on = cheap if coarse else mesh
    expected = {
        "mesh": (cheap, mesh, 1.25 * (2.0 if coarse else 1.0)),
        "penalty": (cheap, cheap.varied(penalty=300.0), 1.25 * (2.0 if coarse else 1.0)),
        "time_step": (given, given.varied(steps=given.steps // 2), 1.25),
        "far_field": (on, on.varied(far_radius=8.0 if coarse else 10.0), 1.25 / 3.0 * (4.0 if coarse else 1.0)),
    }
    assert set(changes) == set(expected) == set(CAUSES)
    for cause, (first, second, trusted) in expected.items():
        change = changes[cause][0]
        assert isinstance(change, certify.Moved)
        assert (change.first, change.second) == (first, second), cause
        assert change.factor == pytest.approx(trusted), cause
        assert isinstance(change, certify.EndMoved) == (cause == "time_step")
    assert changes["mesh"][1:] == (("march", "strike", given),), "and what the rows leave"
    swung = changes["time_step"][1]
    assert isinstance(swung, certify.Swung)
    assert swung.share == pytest.approx(1.25 * given.swing), "and what echoes do that steps pass over"
    assert [len(one) for one in changes.values()] == [2, 1, 2, 1]


def test_what_rows_of_a_curve_with_waves_leave_is_told_by_half_of_them(numerics: WaveNumerics) -> None:
    """A force t (1 - t) whose mean jitters from step to step, of which a local cubic leaves little in any row.

    Order two is trusted of the rows: a third of the change, and the quarter more that is safe.
    """
    time = np.linspace(0.0, 1.0, 801)
    jitter = 1e-3 * np.where(time > 0.0, (-1.0) ** np.arange(801), 0.0)
    march: Any = SimpleNamespace(
        time=time, depth=time, impulse=time**2 * (0.5 - time / 3.0) + time * jitter, first_force=0.0,
        radius_time=time[1:], radius=time[1:], separated=True, end_spread=0.0, energy={}, dent=None,
    )  # fmt: skip
    strike = Strike(lambda r: r**2, 1.0, 0.1, 0.0, Relaxation(1.0), 10.0)
    given = numerics.varied(steps=800, tolerance=3e-3)
    whole, found = certify.curve_of(march, strike, given), certify.reading(march, strike, given)
    rows = whole.x**2
    mean = rows * (0.5 - rows / 3.0)
    assert np.abs(whole.mean_force - mean)[1:-1].max() < 0.5e-3, "half of it at the ends, and less between"
    assert whole.depth == pytest.approx(rows)
    assert np.array_equal(found.first.x, whole.x)
    assert np.array_equal(found.first.mean_force, whole.mean_force)
    assert len(found.second.x) - 1 == pytest.approx(0.5 * (len(whole.x) - 1), abs=1)
    assert found.second.x[[0, -1]].tolist() == [0.0, 1.0]
    assert found.factor == pytest.approx(SAFETY / (2**2 - 1))


def test_the_deepest_of_several_contacts_is_what_may_be_too_deep(
    numerics: WaveNumerics, monkeypatch: pytest.MonkeyPatch
) -> None:
    row = [SimpleNamespace(curve=SimpleNamespace(quantities={"peak_depth": depth})) for depth in (1.0, 2.0, None)]
    cost = SimpleNamespace(check=lambda spent: None, unknowns=1, all_steps=1)
    monkeypatch.setattr(certify, "certify", lambda runs, chosen: SimpleNamespace(row=row))
    sunk = list[float]()
    made_up: Any = SimpleNamespace(check_sunk=sunk.append, spent=0.0)
    Waves(made_up, made_up, lambda *of: cost, str, made_up).certified(numerics)
    assert sunk == [2.0]


def test_the_deepest_and_the_widest_that_a_contact_became_are_what_may_be_too_much(
    numerics: WaveNumerics, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of every contact in a row, without waves: a contact opens and closes, so its widest lies between."""
    curves = [
        SimpleNamespace(quantities={"peak_depth": depth}, radius_squared=np.array([0.0, width**2, 0.0]))
        for depth, width in ((1.0, 3.0), (2.0, 4.0), (None, 5.0))
    ]
    row = [SimpleNamespace(curve=curve) for curve in curves]
    monkeypatch.setattr(reference, "certify", lambda *of: SimpleNamespace(row=row))
    monkeypatch.setattr(reference, "Strike", SimpleNamespace(of=lambda scene: None))
    sunk = list[tuple[float, float]]()
    made_up: Any = SimpleNamespace(
        check_sunk=lambda *of: sunk.append(of), geometry=None, motion=SimpleNamespace(impacts=3), pinned=()
    )
    reference.Statics(made_up, made_up, made_up).certified(numerics)
    assert sunk == [(1.0, 3.0), (2.0, 4.0), (0.0, 5.0)]


def test_a_run_that_fails_tells_nothing_of_any_contact_and_is_not_run_again(numerics: WaveNumerics) -> None:
    class Failing(AnyRuns[WaveNumerics]):
        tried = 0

        def follow(self, settings: WaveNumerics) -> Followed:
            self.tried += 1
            raise NotReached("made up")

    runs = Failing()
    assert runs.curve(0, numerics) is None
    assert runs.curve(1, numerics) is None
    assert runs.tried == 1
    alike: Any = runs
    assert Runs.curve_at_corners(alike, 0, numerics) is None


def test_all_steps_of_a_budget_with_waves_are_those_of_its_marches_in_units_of_the_finest() -> None:
    """As many as progress is told of: in proportion to the steps, and more than those of the finest alone."""
    one, twice = (Cost(70, steps, 1.0).all_steps for steps in (200, 400))
    assert twice == 2.0 * one
    assert 200 < one < 6 * 200, "six runs, of which four take half of the steps or less"


@pytest.mark.parametrize(("name", "behind"), [("polymer-layer", True), ("polymer-sphere-waves", False)])
def test_the_march_behind_an_answer_is_handed_out_where_statics_are_all(
    monkeypatch: pytest.MonkeyPatch, name: str, behind: bool
) -> None:
    march: Any = object()
    monkeypatch.setattr(reference, "solve", lambda *of: march)
    monkeypatch.setattr(reference, "result_of", lambda scene, found: ("of", found))
    monkeypatch.setattr(reference, "fe", lambda *of: "by its model")
    expected = (("of", march), march) if behind else ("by its model", None)
    assert reference.answered(Scene.load(name), {}) == expected


def test_a_touch_is_as_uncertain_as_contact_and_flight_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """A flight lasts 2 v/g times the restitution."""
    monkeypatch.setattr(several, "_moved", lambda budget, read: dict.fromkeys(CAUSES, 0.0))
    errors = {"duration": 1e-5, "restitution": 1e-4}
    strike = SimpleNamespace(velocity=3.0, gravity=9.81)
    one = SimpleNamespace(curve=SimpleNamespace(strike=strike), error=lambda name, cause: errors[name])
    row: Any = SimpleNamespace(budgets=[one, one, one])
    starts = Row.starts.func(row)
    for number, start in enumerate(starts):
        assert start == pytest.approx(dict.fromkeys(CAUSES, number * (1e-5 + 2.0 * 3.0 / 9.81 * 1e-4)))


def contact(number: int) -> Any:
    """One of a row, values and errors made up, each of another size: the second the hardest, the third the deepest."""
    values = {"peak_force": (5.0, 9.0, 7.0)[number], "peak_depth": (1e-3, 2e-3, 3e-3)[number], "impulse": 0.2 + number}
    values |= {"duration": 0.05 + 0.01 * number, "restitution": 0.9 - 0.1 * number, "peak_time": 0.02 + 3e-3 * number}
    errors = {name: 1e-3 * (number + 1) * value for name, value in values.items()}
    errors["history_l2"] = (2e-3, 3e-3, 1e-3)[number]
    strike = SimpleNamespace(velocity=3.0 - number, gravity=9.81, touched_at=0.7 * number)
    return SimpleNamespace(
        curve=SimpleNamespace(strike=strike, quantities=values),
        quantities={name: Quantity(value, len(CAUSES) * errors[name], "") for name, value in values.items()},
        error=lambda name, cause: errors[name],
    )


@pytest.fixture
def row(monkeypatch: pytest.MonkeyPatch) -> Row:
    """Three contacts; no setting moves a touch by itself."""
    monkeypatch.setattr(several, "_moved", lambda budget, read: dict.fromkeys(CAUSES, 0.0))
    found: Any = SimpleNamespace(row=[contact(number) for number in range(3)])
    return Row(found)


def test_every_contact_is_told_by_its_own_touch_which_errs_more_from_one_to_the_next(row: Row) -> None:
    causes, late = len(CAUSES), 0.0
    for number, (told, one) in enumerate(zip(row.contacts, row.budgets, strict=True)):
        if number:
            before = row.budgets[number - 1]
            by_flight = 2.0 * before.curve.strike.velocity / 9.81 * before.error("restitution", "")
            late += causes * (before.error("duration", "") + by_flight)
            wrong = causes * before.curve.strike.velocity * before.error("restitution", "")
            assert told["velocity_error"] == pytest.approx(wrong)
        assert told["start"] == pytest.approx(0.7 * number)
        assert told["start_error"] == pytest.approx(late)
        assert told["velocity"] == 3.0 - number
        before = row.budgets[max(number - 1, 0)]
        slower = causes * before.curve.strike.velocity * before.error("restitution", "") if number else 0.0
        assert told["velocity_error"] == pytest.approx(slower)
        assert told["peak_time"] == pytest.approx(0.7 * number + one.curve.quantities["peak_time"])
        assert told["peak_time_error"] == pytest.approx(late + causes * one.error("peak_time", ""))
        for name in ("duration", "restitution", "peak_force", "peak_depth"):
            assert told[name] == one.curve.quantities[name]
            assert told[f"{name}_error"] == pytest.approx(causes * one.error(name, ""))


def test_a_quantity_of_all_contacts_is_told_by_one_of_them_or_by_their_sum(row: Row) -> None:
    causes, all_of = len(CAUSES), row.quantities
    first, second, third = row.budgets
    tellers = {"peak_force": second, "peak_depth": third, "duration": first, "restitution": first}
    for name, one in tellers.items():
        assert all_of[name].value == one.curve.quantities[name]
        assert all_of[name].error == pytest.approx(causes * one.error(name, ""))
    assert all_of["peak_time"].value == pytest.approx(0.7 + second.curve.quantities["peak_time"])
    assert all_of["peak_time"].error == pytest.approx(row.late(1) + causes * second.error("peak_time", ""))
    assert all_of["impulse"].value == pytest.approx(0.2 + 1.2 + 2.2)
    assert all_of["impulse"].error == pytest.approx(causes * sum(one.error("impulse", "") for one in row.budgets))
    assert all_of["history_l2"].value == 0.0
    assert all_of["history_l2"].error == pytest.approx(causes * 3e-3), "that of the worst"
    for name, quantity in all_of.items():
        assert sum(row.error(name, cause) for cause in CAUSES) == pytest.approx(quantity.error), "its causes"


def test_what_still_presses_gives_nothing_back_and_has_no_bar_of_that(row: Row) -> None:
    row.budgets[0].curve.quantities["restitution"] = None
    assert row.quantities["restitution"] == Quantity(None, None, "1")


def test_rows_of_a_curve_with_waves_are_smoothed_alike_from_either_end() -> None:
    """A cubic stays as it is, both ends too, what jitters about it is evened out, and no way of time is preferred."""
    rng = np.random.default_rng(12)
    places, rows = np.sort(np.append(rng.uniform(0.0, 1.0, 199), [0.0, 1.0])), np.arange(0, 201, 8)
    cubic = 2.0 - places + 3.0 * places**2 - 4.0 * places**3
    np.testing.assert_allclose(certify._smoothed(places, cubic, rows), cubic[rows], rtol=1e-12)
    noise = rng.normal(size=201)
    found = certify._smoothed(places, noise, rows)
    back = certify._smoothed(1.0 - places[::-1], noise[::-1], 200 - rows[::-1])
    np.testing.assert_allclose(back[::-1], found, rtol=1e-9)
    assert np.array_equal(found[[0, -1]], noise[[0, -1]]), "nothing lies beyond"
    assert found[1:-1].std() < 0.6 * noise[rows][1:-1].std()
    few = np.array([0, 1, 2, 3])
    assert np.array_equal(certify._smoothed(places[:4], noise[:4], few), noise[:4]), (
        "a cubic through all is no smoothing"
    )
