"""Where methods break: each failure as theory predicts it, the bar's default beside it holding; the command's files."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_contact.bodies.bar import TIP, falling, pitch
from fe_contact.cli import main
from fe_contact.dynamics.mass.base import MASSES
from fe_contact.dynamics.schemes.base import WAVE_SCHEMES
from fe_contact.errors import MotionUnbounded
from fe_contact.studies.stability import bars
from fe_contact.studies.stability.bars import BAR, DEFAULT, bounced, measured
from fe_contact.studies.stability.base import row, studies
from fe_contact.waves.targets import _block as falling_block
from lumped import Scene

USUAL = {**DEFAULT, "cfl": 1.0, "elements": 60, "periods": 1}


def found(**changes: Any) -> dict[str, Any]:
    return measured({**USUAL, **changes})


@pytest.fixture(scope="module")
def default() -> dict[str, Any]:
    return found()


@pytest.mark.tenth
@pytest.mark.parametrize("cfl", [1.0, pytest.param(2.0, marks=pytest.mark.full)])
def test_the_default_bounces_for_ten_periods(cfl: float) -> None:
    """A hundred elements: no energy, no beat and no ripple is lost, and the duration is known to a step."""
    kept = found(elements=100, periods=10, cfl=cfl)
    assert abs(kept["drift"]) < 1e-3
    assert kept["ripple"] < 0.02
    assert abs(kept["duration_steps"]) < 1.0
    assert abs(kept["start"]) < 0.01
    assert kept["stages"] == cfl
    assert 0.9 < kept["contacts"] <= 1.0
    assert kept["penetration"] < 1e-12
    assert kept["residual"] < 1e-6


def test_a_user_of_the_bar_gets_the_default() -> None:
    scene = Scene.load("bar")
    numerics = falling_block.plan(scene, {}).numerics.as_dict()
    assert {**numerics, "tip": falling_block.usual_tip(scene)}.items() >= DEFAULT.items()


@pytest.mark.tenth
def test_the_default_converges_with_order_one(campaign_size: Callable[[int], int]) -> None:
    """Random numbers of elements: energy, impulse and beat err in proportion to the step, the duration by its share."""
    rng = np.random.default_rng(2011)
    counts = [50, 200, *np.exp(rng.uniform(np.log(50), np.log(800), campaign_size(12))).astype(int)]
    every = [found(elements=int(n)) for n in counts]
    for name in ("drift", "restitution", "start"):
        errors = np.abs([one[name] for one in every])
        assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(1.0, abs=0.1), name
    assert np.ptp([one["duration_steps"] for one in every]) < 0.05


def test_a_short_first_element_answers_by_the_roots_that_theory_gives() -> None:
    """The force after a touch tends to the plateau by the roots' size a step; a half element never comes to rest."""
    for tip in (TIP, 0.6, 1.0):
        roots = np.roots([tip + 0.5, 1 / tip - 2 * tip, tip - 0.5])
        ringing = _ringing(tip)
        fading = (ringing[12:16].max() / ringing[4:8].max()) ** (1 / 8)
        assert fading == pytest.approx(np.abs(roots).max(), rel=0.15)
    np.testing.assert_allclose(_ringing(0.5)[1:60], 1.0, atol=1e-9)


def _ringing(tip: float) -> np.ndarray:
    """Departure of the force from density c v step after step, over it."""
    weightless = bounced({**USUAL, "tip": tip, "periods": 0.1}, gravity=0.0)
    return np.abs(weightless.force / 300.0 - 1.0)


def test_stages_keep_the_limit_that_one_step_breaks() -> None:
    """Twice the step that is stable: two stages of it are the same motion as two steps; a step is a named failure."""
    single, double = bounced({**USUAL, "cfl": 1.0}), bounced({**USUAL, "cfl": 2.0})
    np.testing.assert_allclose(double.force[:-1], single.force[::2][: len(double.force) - 1], atol=1e-9)
    assert (single.stages, double.stages) == (1, 2)


def test_an_exact_constraint_on_a_surface_with_mass_chatters_implicitly(default: dict[str, Any]) -> None:
    """The trapezoidal rule reverses the velocity of a node that it stops: contact every other step, never a plateau."""
    broken = found(scheme="trapezoidal", mass="consistent")
    assert broken["contacts"] > 10 * default["contacts"]
    assert broken["duration_steps"] < -0.9 * 120
    assert broken["ripple"] > 0.5
    assert default["ripple"] < 0.02


def test_a_surface_without_mass_stops_the_chatter() -> None:
    assert found(scheme="trapezoidal", mass="redistributed")["ripple"] < 0.01


def test_damping_the_chatter_costs_energy(default: dict[str, Any]) -> None:
    """The fully implicit scheme has no chatter either, and loses more than a fifth of the energy in a period."""
    damped = found(scheme="fully_implicit", mass="consistent", periods=2)
    assert damped["contacts"] < 3
    assert damped["drift"] < -0.2
    assert abs(default["drift"]) < 0.01


def test_a_penalty_lets_in_what_its_stiffness_says_and_the_default_nothing(default: dict[str, Any]) -> None:
    """Largest force over stiffness, 500 N on 900 N/m^2 x area / element: in units of v L/c."""
    soft = found(enforcement="penalty")
    size = pitch(BAR.length, USUAL["elements"], TIP)
    assert soft["penetration"] == pytest.approx(500.0 / (900.0 / size) / (10.0 / 3.0), rel=0.05)
    assert found(enforcement="corrected")["penetration"] < 0.7 * soft["penetration"]
    assert default["penetration"] < 1e-12


@pytest.mark.family
@pytest.mark.parametrize("mass", ["lumped", "redistributed"])
def test_two_over_omega_max_is_the_limit_of_a_linear_bar(mass: str) -> None:
    """A bar pressed on for good, its contact always closed, is stable below it and not beyond."""
    elements, penalty = 10, 10.0
    limit = bars.linear_limit(mass, penalty, elements)
    body = falling(BAR, elements, MASSES.get(mass), 0.0)
    case = {**DEFAULT, "scheme": "central_difference", "mass": mass, "tip": 1.0, "enforcement": "penalty"}
    case["penalty"] = penalty
    size = BAR.length / elements
    assert body.inertia.diagonal().sum() == pytest.approx(10.0)
    for share, stable in ((0.98, True), (1.05, False)):
        held = {**case, "cfl": share * limit * 30.0 / size, "elements": elements, "periods": 2}
        if stable and mass == "redistributed":
            assert max(sample.force for sample in bounced(held).samples) < 2000.0
        elif not stable:
            gained = row("explicit_limit", {**case, "share": share, "elements": elements, "periods": 2})
            assert gained["failure"] == MotionUnbounded.__name__ or gained["gain"] > 1.0


@pytest.mark.tenth
def test_the_linear_limit_is_not_safe_for_contact_that_opens_and_closes() -> None:
    """Central difference with a penalty on a surface with mass gains energy at 0.9 of it, and hardly any at 0.3."""
    shares = {share: bars.limit_measure(_limit("lumped", 10.0, share))["gain"] for share in (0.3, 0.9)}
    assert shares[0.9] > 0.5
    assert shares[0.3] < 0.05
    assert bars.limit_measure(_limit("redistributed", 10.0, 0.9))["gain"] < 0.05


def _limit(mass: str, penalty: float, share: float) -> dict[str, Any]:
    return {"mass": mass, "penalty": penalty, "share": share, "elements": 10, "periods": 1}


def test_a_step_beyond_the_limit_is_a_named_failure_and_no_number() -> None:
    broken = row("bouncing", {**USUAL, "scheme": "central_difference", "cfl": 2.0})
    assert broken["failure"] == "MotionUnbounded"
    assert "drift" not in broken


def test_every_study_names_its_settings_and_measures() -> None:
    for study in studies().values():
        quick, full = study.cases(True), study.cases(False)
        assert 0 < len(quick) < len(full)
        assert {*study.chart.rows, *study.chart.columns} <= set(quick[0])
        keys = [json.dumps(case, sort_keys=True) for case in full]
        assert len(set(keys)) == len(keys)


# the command


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Two small cases of the table alone: one that holds, one that fails."""
    small = {**USUAL, "elements": 10, "scheme": "central_difference"}
    cases = [small, {**small, "cfl": 2.0}]
    for name, study in studies().items():
        fewer = replace(study, cases=lambda quick, own=name == "table": cases if own else [])
        monkeypatch.setitem(studies(), name, fewer)
    monkeypatch.setattr("fe_contact.studies.stability._chart.plot_stability", lambda rows, where: None)
    return cases


def test_the_command_writes_rows_and_counts(few: list[dict[str, Any]], tmp_path: Path) -> None:
    assert main(["stability", "--quick", "--jobs", "1", "--out", str(tmp_path), "--quiet"]) == 0
    with (tmp_path / "table.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [r["failure"] for r in rows] == ["", "MotionUnbounded"]
    content = json.loads((tmp_path / "stability.json").read_text())
    assert content["cases"] == len(few)
    assert content["failures"] == {"MotionUnbounded": 1}
    assert content["steps"] == int(rows[0]["steps"])


@pytest.mark.tenth
def test_the_chart_shows_every_case(tmp_path: Path) -> None:
    from fe_contact.studies.stability._chart import plot_stability

    rows = [row("table", {**USUAL, "elements": 10, "cfl": cfl}) for cfl in (1.0, 2.0)]
    limits = [{"study": "explicit_limit", **_limit("lumped", 1.0, 0.5), "gain": 0.1, "failure": ""}]
    maps = [{**r, "study": "bouncing"} for r in rows]
    plot_stability([*rows, *limits, *maps], tmp_path)
    shown = ("table", "explicit_limit", "bouncing")
    assert {p.name for p in tmp_path.iterdir()} == {f"{study}.{kind}" for study in shown for kind in ("svg", "png")}
    assert "failure, or nothing to tell" in (tmp_path / "table.svg").read_text()


def test_the_table_has_the_default_and_its_rivals() -> None:
    assert tuple(DEFAULT[key] for key in bars.KEYS) in bars.ROWS
    assert {row[0] for row in bars.ROWS} == set(WAVE_SCHEMES.names)
