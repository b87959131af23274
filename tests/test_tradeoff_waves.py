"""The trade-off with inertia: errors from exact waves or a finer reference, settings tried once, files and a chart."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_contact.cli import main
from fe_contact.methods import exact_laws, simulate
from fe_contact.settings import RANGES, WaveNumerics
from fe_contact.studies.tradeoff import study
from fe_contact.studies.tradeoff.chart import Signs, plot_tradeoff
from fe_contact.studies.tradeoff.point import REFERENCE
from fe_contact.studies.tradeoff.study import Tradeoff
from fe_contact.studies.tradeoff.tried import line_variations, variations
from fe_contact.studies.tradeoff.verdict import finite_elements, judged, known_to
from fe_contact.waves.targets.base import WAVES
from lumped.result.history import History
from lumped.result.score import distance
from lumped.scene.scene import Scene

SCENES = (
    "steel-ball-waves",
    "polymer-layer-waves",
    "bar-impact",
    "steel-ball-flight-waves",
    "two-finite-spheres-waves",
    "rod",
)


def planned(name: str, **given: Any) -> WaveNumerics:
    scene = Scene.load(name)
    found = WAVES.get(scene.target.name).plan(scene, given).numerics
    assert isinstance(found, WaveNumerics)
    return found


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the rows of `found` are kept."""
    return tmp_path_factory.mktemp("rod")


@pytest.fixture(scope="module")
def found(kept: Path) -> Tradeoff:
    return study.tradeoff(Scene.load("rod"), {}, True, kept, lambda message: None)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("quick", [True, False])
def test_every_target_tries_settings_that_a_run_accepts(name: str, quick: bool) -> None:
    base, scene = planned(name), Scene.load(name)
    chosen = study.varied(base, {}, variations(scene, base, quick))
    assert 5 <= len(chosen) == len(set(chosen))
    assert base not in chosen
    for numerics in chosen:
        assert numerics.contact_time == base.contact_time
        for key, value in numerics.as_dict().items():
            if key in RANGES:
                assert RANGES[key][0] <= value <= RANGES[key][1], key


def test_what_is_given_stays() -> None:
    given = {"scheme": "staged", "mass": "spread"}
    base = planned("bar-impact", **given)
    chosen = study.varied(base, given, line_variations(base, quick=False))
    assert {(n.scheme, n.as_dict()["mass"]) for n in chosen} == {("staged", "spread")}


def test_the_distance_is_exact_for_rows_that_jump() -> None:
    """A rectangle against one that ends a share later: the root of that share, to rounding."""
    end, share = 2 / 3, 0.01
    late = end * (1 + share)

    def rectangle(until: float) -> Callable[[np.ndarray], np.ndarray]:
        return lambda times: np.where(times < until, 300.0, 0.0)

    knots = np.array([0.0, end, end, late])
    assert distance(rectangle(end), rectangle(late), knots) == pytest.approx(np.sqrt(share), rel=1e-12)


@pytest.mark.tenth
def test_a_bouncing_bar_claims_its_history_whole() -> None:
    """Between its contacts the steps err by a time, so that the force errs by the root of it: also where it ends."""
    scene = Scene.load("bar")
    exact = simulate(scene, "bar_waves", {"tolerance": 1e-6}).history
    for steps in (100, 200, 800):
        found = simulate(scene, "fe", {"tolerance": 0.1, "steps": steps})
        rows = np.union1d(exact.time, found.history.time)
        apart = distance(straight(exact), straight(found.history), rows)
        assert apart <= (found.quantities["history_l2"].error or 0.0)


def straight(history: History) -> Callable[[np.ndarray], np.ndarray]:
    """Force between the rows of a history, zero outside."""
    return lambda times: np.interp(times, history.time, history.force, left=0.0, right=0.0)


def test_exact_waves_are_known_of_elastic_rods_and_bars_alone() -> None:
    """Never of what disperses, of a mass behind a bar, or of a body with inertia that a law without it answers."""
    lossy = {"law": "sls", "E0": 2e11, "R1": 0.5, "R2": 1e-4, "nu": 0.3, "density": 7850.0}
    for name, overrides, exact in (
        ("concrete-pole", {}, ("rod_waves",)),
        ("rod", {"target.material": lossy}, ()),
        ("bar", {}, ("bar_waves",)),
        ("bar", {"striker.mass": 5.0}, ()),
        ("polymer-prism-waves", {}, ()),
        ("steel-ball-waves", {}, ()),
        ("steel-ball-waves", {"model.inertia": False}, ("correspondence", "ting", "mdr")),
    ):
        assert exact_laws(Scene.load(name, overrides)) == exact, (name, overrides)


@pytest.mark.tenth
def test_the_default_keeps_its_promise_and_is_near_the_front(found: Tradeoff) -> None:
    (default,) = [point for point in found.points if point.default_for is not None]
    assert default.error <= (default.bar or 0.0) <= default.default_for == 1e-3
    assert re.search("on the front|within 1.5 of the front", found.verdict[1]), "processor time scatters by less"
    assert known_to(found.points) == study.TIGHTEST
    assert found.verdict[0].startswith("use rod_waves (")


@pytest.mark.tenth
def test_finer_steps_err_less_and_cost_more(found: Tradeoff) -> None:
    """Order two, which the exact waves show; work grows as the square of the steps."""
    tried = [p for p in finite_elements(found.points) if p.settings["scheme"] == "central_difference"]
    own = sorted((p for p in tried if not p.default_for), key=lambda p: p.settings["steps"])
    steps, errors = np.array([(p.settings["steps"], p.error) for p in own]).T
    work = np.array([p.work["operations"] for p in own])
    assert np.all(np.diff(np.log(errors)) < -1.5 * np.diff(np.log(steps)))
    np.testing.assert_allclose(np.diff(np.log(work)), 2.0 * np.diff(np.log(steps)), rtol=0.05)


@pytest.mark.tenth
def test_bars_that_claim_anything_cover(found: Tradeoff) -> None:
    claiming = [p for p in finite_elements(found.points) if (p.bar or np.inf) <= RANGES["tolerance"][1]]
    assert len(claiming) >= 4
    assert all(p.error <= (p.bar or 0.0) for p in claiming)
    assert f"in {len(claiming)} of {len(claiming)} settings" in found.verdict[-1]


def test_a_default_marches_each_choice_of_settings_once() -> None:
    """Of 400 and 800 steps, with half and a quarter of them: 100, 200, 400 and 800."""
    result = simulate(Scene.load("rod"), "fe", {})
    assert result.numerics["steps"] == 800
    assert result.work["marches"] == 4


@pytest.mark.tenth
def test_without_exact_waves_finer_elements_are_the_truth_and_no_law_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The half-space, coarse: no error within the truth's own bar can be held against a setting, and no law that is
    near by chance is advised.
    """
    monkeypatch.setattr(study, "variations", lambda *_: iter([{"steps": 40}]))
    pinned = {"steps": 80, "elements_per_contact": 4.0, "tolerance": 0.05}
    found = study.tradeoff(Scene.load("steel-ball-waves"), pinned, False, tmp_path, lambda message: None)
    (truth,) = [point for point in found.points if point.method == REFERENCE]
    assert known_to(found.points) == truth.bar
    assert (truth.settings["steps"], truth.settings["elements_per_contact"]) == (160, 5.0)
    for point in finite_elements(found.points):
        assert 0.0 < point.error <= (point.bar or 0.0) + (truth.bar or 0.0)
    without = {point.method: point.error for point in judged(found.points) if point.method in ("mdr", "hertz")}
    assert all(0.003 < error < 0.03 for error in without.values())  # half of what is radiated
    assert found.verdict[0].startswith("use finite elements: ")


@pytest.mark.tenth
def test_the_command_writes_table_and_chart(found: Tradeoff, kept: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of the rows that it finds; the chart is the same byte by byte."""
    assert main(["tradeoff", "rod", "--quick", "--json", "--quiet", "--out", str(kept)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((kept / "tradeoff.json").read_text(encoding="utf-8"))
    assert printed["verdict"] == list(found.verdict)
    assert {"tradeoff.svg", "tradeoff.png", "tradeoff.csv"} <= {path.name for path in kept.iterdir()}
    again = plot_tradeoff(found, kept / "again")
    assert [path.read_bytes() for path in again] == [(kept / path.name).read_bytes() for path in again]


@pytest.mark.tenth
def test_the_chart_tells_schemes_and_masses_apart(found: Tradeoff) -> None:
    signs = Signs.of(found.points)
    assert signs.key == "scheme"
    assert len(set(signs.colours.values())) == len(signs.colours) > 2
    assert len(set(signs.markers.values())) == len(signs.markers) > 1
