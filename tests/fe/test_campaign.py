"""Random impacts through the front door against the exact answer: errors, bars, convergence.

The reference is the row of springs at a tolerance far below the one asked: no finite element and no time
step of the suite's march enters it. The contact edge falls anywhere in an element, because nothing here
chooses where it falls.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

import fe_contact
import lumped
from lumped.laws import mdr
from lumped.result.result import RULED_RELATIVE, Quantity

IMPACTS = 48
TOLERANCES = (1e-3, 1e-4)
REFERENCE_TOLERANCE = 1e-7
RULED = (*RULED_RELATIVE, "restitution", "history_l2")
CONTACT_RADIUS = 5e-3
OVERESTIMATE = 10.0


@dataclass(frozen=True)
class Outcome:
    """True errors and claimed ones, relative (restitution and history_l2 absolute), of one impact."""

    name: str
    converged: bool
    error: dict[str, float]
    bar: dict[str, float]
    force_misses: float  # how far the force leaves its band, in units of the tolerance x peak force
    between_rows: float  # largest error of the linearly interpolated force over the peak force
    radius: float


def relative(quantity: str, value: float, exact: float) -> float:
    return value if quantity == "restitution" else value / abs(exact)


def judged(result: lumped.Result, exact: lumped.Result) -> Outcome:
    error, bar = {}, {}
    for name, reference in exact.quantities.items():
        found: Quantity = result.quantities[name]
        if name == "history_l2":
            error[name], bar[name] = history_l2(result.history, exact.history), found.error
            continue
        assert found.value is not None, f"{name} is undefined"
        error[name] = relative(name, abs(found.value - reference.value), reference.value)
        bar[name] = relative(name, found.error, reference.value)
    history = result.history
    miss = np.abs(history.force - exact.history.force_at(history.time)) - history.force_error
    peak = exact.quantities["peak_force"].value
    apart = result.history.force_at(exact.history.time) - exact.history.force
    return Outcome(
        name=result.scene.name,
        converged=result.converged,
        error=error,
        bar=bar,
        force_misses=float(miss.max()) / (result.tolerance * peak),
        between_rows=float(np.abs(apart).max()) / peak,
        radius=radius_error(history, exact.history),
    )


def history_l2(found: lumped.History, exact: lumped.History) -> float:
    """Error of the rows themselves: what lies between them is the promise of another test."""
    exact_force = exact.force_at(found.time)
    change = found.force - exact_force
    return float(np.sqrt(np.trapezoid(change**2, found.time) / np.trapezoid(exact_force**2, found.time)))


def radius_error(found: lumped.History, exact: lumped.History) -> float:
    """Largest difference over the largest radius, compared at equal shares of the contact: radius ends like a root."""
    share = np.linspace(0.0, 1.0, 400)
    ours = np.interp(share * found.time[-1], found.time, found.contact_radius)
    theirs = np.interp(share * exact.time[-1], exact.time, exact.contact_radius)
    return float(np.abs(ours - theirs).max() / theirs.max())


@pytest.fixture(scope="module")
def impacts(random_impact: Callable[[np.random.Generator, int], lumped.Scene]) -> list[lumped.Scene]:
    rng = np.random.default_rng(20261121)
    return [random_impact(rng, number) for number in range(IMPACTS)]


@pytest.fixture(scope="module")
def exact_answers(campaign_size: Callable[[int], int], impacts: list[lumped.Scene]) -> list[lumped.Result]:
    scenes = impacts[: campaign_size(IMPACTS)]
    answers = [lumped.simulate(mdr.of(scene), scene, tolerance=REFERENCE_TOLERANCE) for scene in scenes]
    assert all(answer.converged and answer.separated for answer in answers), "the reference itself failed"
    return answers


@pytest.fixture(scope="module", params=TOLERANCES)
def campaign(request: pytest.FixtureRequest, exact_answers: list[lumped.Result]) -> tuple[float, list[Outcome]]:
    tolerance: float = request.param
    return tolerance, [judged(fe_contact.run(exact.scene, tolerance), exact) for exact in exact_answers]


def test_the_impacts_are_those_of_the_claim(impacts: list[lumped.Scene]) -> None:
    moduli = [scene.contact_modulus for scene in impacts]
    assert len(impacts) == IMPACTS
    assert sum(scene.material.constant == "bulk" for scene in impacts) >= 12
    assert {scene.material.nu for scene in impacts} >= {0.0, 0.4999}
    assert sum(modulus.is_elastic for modulus in moduli) == IMPACTS / 4
    assert sum(modulus.viscosity > 0 for modulus in moduli) == IMPACTS / 4
    steepness = [m.glassy / m.relaxed for m in moduli]
    assert max(steepness) > 9


@pytest.mark.parametrize("quantity", RULED)
def test_the_worst_error_is_within_the_tolerance(campaign: tuple[float, list[Outcome]], quantity: str) -> None:
    tolerance, outcomes = campaign
    too_large = {o.name: o.error[quantity] for o in outcomes if not o.error[quantity] <= tolerance}
    assert not too_large


@pytest.mark.parametrize("quantity", [*RULED, "peak_time"])
def test_the_bar_covers_the_error_of_every_impact(campaign: tuple[float, list[Outcome]], quantity: str) -> None:
    _, outcomes = campaign
    pairs = {o.name: (o.error[quantity], o.bar[quantity]) for o in outcomes}
    missed = {name: (error, bar) for name, (error, bar) in pairs.items() if not error <= bar}
    assert not missed


def test_the_bars_are_no_more_than_ten_times_the_errors_in_the_median(campaign: tuple[float, list[Outcome]]) -> None:
    """Of every quantity by itself; of all together where there are too few impacts for a median of each."""
    _, outcomes = campaign
    ratios = {name: [o.bar[name] / o.error[name] for o in outcomes] for name in RULED}
    if len(outcomes) < IMPACTS:
        ratios = {"all": [ratio for found in ratios.values() for ratio in found]}
    too_wide = {name: np.median(found) for name, found in ratios.items() if np.median(found) > OVERESTIMATE}
    assert not too_wide


def test_the_force_stays_inside_its_band(campaign: tuple[float, list[Outcome]]) -> None:
    """At every row, to a hundredth of what the tolerance allows at the peak."""
    _, outcomes = campaign
    missed = {o.name: o.force_misses for o in outcomes if o.force_misses > 0.01}
    assert not missed


def test_straight_lines_between_the_rows_are_good_enough(campaign: tuple[float, list[Outcome]]) -> None:
    tolerance, outcomes = campaign
    assert max(o.between_rows for o in outcomes) <= 2 * tolerance, "tolerance of the rows, and as much between them"


def test_the_contact_radius_is_known_to_half_a_percent(campaign: tuple[float, list[Outcome]]) -> None:
    _, outcomes = campaign
    assert max(o.radius for o in outcomes) <= CONTACT_RADIUS


def test_nearly_all_impacts_converge(campaign: tuple[float, list[Outcome]]) -> None:
    tolerance, outcomes = campaign
    share = np.mean([o.converged for o in outcomes])
    assert share >= 0.95, [o.name for o in outcomes if not o.converged]
    honest = all((max(o.bar[name] for name in RULED) <= tolerance * (1 + 1e-12)) == o.converged for o in outcomes)
    assert honest, "converged must say that every ruled bar is within the tolerance"


def test_rows_of_a_fine_history_lie_as_close_as_straight_lines_ask() -> None:
    """Between exact forces at its rows: a tenth of the tolerance."""
    scene, tolerance = lumped.Scene.load("polymer-sphere"), 3e-5
    time = fe_contact.run(scene, tolerance).history.time
    exact = lumped.simulate(lumped.laws.ting.of(scene), scene, 1e-9).history
    middle = 0.5 * (exact.force_at(time[1:]) + exact.force_at(time[:-1]))
    missed = np.abs(middle - exact.force_at(0.5 * (time[1:] + time[:-1])))
    assert missed.max() < 0.11 * tolerance * exact.force.max()
