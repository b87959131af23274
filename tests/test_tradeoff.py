"""The trade-off: a front that is one, operators that are built for every point, a verdict that follows."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_contact.cli import main
from fe_contact.studies.tradeoff import bodies, study
from fe_contact.studies.tradeoff.bodies import LAW_TOLERANCES, ROW_ELEMENTS, still_variations
from fe_contact.studies.tradeoff.chart import plot_tradeoff
from fe_contact.studies.tradeoff.point import Point
from fe_contact.studies.tradeoff.study import (
    MARKED,
    NEAR,
    defaults,
    excess,
    finite_elements,
    front,
    tradeoff,
    varied,
    verdict,
)
from fe_contact.targets import half_space
from lumped.scene.scene import Scene


def point(cpu: float, error: float, bar: float = 1e-9, default_for: float | None = None) -> Point:
    return Point("fe", {}, cpu, {"peak_force": error}, bar, default_for=default_for)


def nothing(*_: object) -> tuple[()]:
    return ()


NOTHING_VARIED = replace(bodies.STILL, variations=lambda base, quick: iter(()))
DEFAULTS_ALONE = replace(NOTHING_VARIED, lumped=nothing)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return Scene.load("polymer-sphere")


@pytest.fixture(scope="module")
def points(scene: Scene, tmp_path_factory: pytest.TempPathFactory) -> tuple[Point, ...]:
    """The defaults, the exact laws and the models."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bodies, "STILL", NOTHING_VARIED)
        return tradeoff(scene, {}, True, tmp_path_factory.mktemp("tradeoff"), lambda message: None)


@given(st.lists(st.tuples(st.floats(1e-3, 1e3), st.floats(1e-9, 1.0)), min_size=1, max_size=30))
def test_the_front_holds_the_points_that_nothing_beats(pairs: list[tuple[float, float]]) -> None:
    tried = [point(cpu, error) for cpu, error in pairs]
    best = front(tried, lambda p: p.cpu, lambda p: p.error)
    for one in tried:
        beaten = any(o.cpu <= one.cpu and o.error <= one.error and o != one for o in tried)
        assert one in best or beaten
    assert all(a.cpu < b.cpu and a.error > b.error for a, b in pairwise(best))


def test_excess_is_the_price_over_the_cheapest_equal() -> None:
    tried = [point(1.0, 1e-2), point(2.0, 1e-3), point(6.0, 1e-3)]
    assert excess(tried[2], tried, lambda p: p.error, 1e-3) == 3.0
    assert np.isnan(excess(tried[2], tried, lambda p: p.error, 1e-6))


@pytest.mark.parametrize(
    ("cpu", "bar", "phrase"),
    [
        (1.0, 5e-4, ": on the front"),
        (1.9, 5e-4, f"within a factor {NEAR:g} of the front"),
        (5.0, 5e-4, ": off the front"),
        (1.0, 2e-3, "misses the tolerance"),
    ],
)
def test_the_verdict_follows_from_the_points(cpu: float, bar: float, phrase: str) -> None:
    tried = [point(1.0, 1e-4, 9e-4), point(cpu, 1e-4, bar, default_for=1e-3)]
    assert phrase in verdict(tried)[0]


def test_the_verdict_counts_the_bars_that_cover() -> None:
    tried = [point(1.0, 1e-4, 2e-4), point(1.0, 1e-4, 5e-5), replace(point(1.0, 1.0), failure="no contact")]
    assert verdict(tried)[-1] == "the claimed bar covers the error in 1 of 2 settings"


@pytest.mark.parametrize("quick", [True, False])
def test_the_design_tries_each_setting_once_and_keeps_what_is_given(scene: Scene, quick: bool) -> None:
    given_settings = {"order": 3, "penalty": 500.0}
    planned = defaults(scene, given_settings)
    assert set(planned) == set(MARKED)
    chosen = varied(planned[1e-3], given_settings, still_variations(planned[1e-3], quick))
    assert len(set(chosen)) == len(chosen)
    assert {(n.order, n.penalty) for n in chosen} == {(3, 500.0)}
    assert {n.contact_time for n in chosen} == {planned[1e-3].contact_time}


def test_the_full_design_holds_the_quick_one_in_kind(scene: Scene) -> None:
    base = defaults(scene, {})[1e-3]
    quick, full = (varied(base, {}, still_variations(base, quick)) for quick in (True, False))
    assert 10 <= len(quick) <= 20 < 50 <= len(full) <= 70
    for key in ("order", "elements_per_contact", "steps", "enforcement", "penalty"):
        assert len({getattr(n, key) for n in quick}) > 1
    assert all(n.steps % 4 == 0 for n in full)


def test_every_default_keeps_its_promise(points: tuple[Point, ...]) -> None:
    marked = [p for p in points if p.default_for is not None]
    assert [p.default_for for p in marked] == list(MARKED)
    for one in marked:
        assert one.bar is not None
        assert one.error <= one.bar <= (one.default_for or 0.0)
        assert one.cpu > 0.0


def test_every_point_builds_its_operators_again(scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a user pays holds the factorizations, and no point lives on those of another."""
    built = []

    def counted(*arguments: object) -> object:
        built.append(arguments)
        return original(*arguments)

    original = half_space.surface_operator
    monkeypatch.setattr(half_space, "surface_operator", counted)
    monkeypatch.setattr(bodies, "STILL", DEFAULTS_ALONE)
    monkeypatch.setattr(study, "BRIEF", np.inf)
    found = finite_elements(tradeoff(scene, {}, True, tmp_path, lambda message: None))
    assert len(built) == study.REPEATS * sum(p.work["factorizations"] for p in found)


def test_the_row_of_springs_converges_with_order_two(points: tuple[Point, ...]) -> None:
    errors = [p.error for p in points if p.method == "mdr row"]
    rates = np.diff(np.log(errors)) / -np.diff(np.log(ROW_ELEMENTS))
    assert rates[1:].min() > 1.7


def test_exact_laws_keep_their_bars_and_models_do_not_converge(points: tuple[Point, ...]) -> None:
    for name in ("mdr", "ting"):
        own = [p for p in points if p.method == name]
        assert [p.settings["tolerance"] for p in own] == list(LAW_TOLERANCES[::2])
        assert all(p.error <= (p.bar or 0.0) + bodies.EXACT_TOLERANCE for p in own)
    models = {p.method: p.error for p in points if p.method in bodies.MODELS}
    assert models["hertz"] > models["correspondence"] > 0.01


@pytest.mark.tenth
def test_the_command_writes_table_and_chart(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bodies, "STILL", DEFAULTS_ALONE)
    assert main(["tradeoff", "polymer-sphere", "--quick", "--json", "--quiet", "--out", str(tmp_path)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((tmp_path / "tradeoff.json").read_text(encoding="utf-8"))
    with (tmp_path / "tradeoff.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(printed["points"])
    assert [float(row["error"]) for row in rows] == [p["error"] for p in printed["points"]]
    assert {"tradeoff.svg", "tradeoff.png"} <= {path.name for path in tmp_path.iterdir()}


def test_the_chart_is_reproducible(tmp_path: Path, scene: Scene, points: tuple[Point, ...]) -> None:
    first, again = (plot_tradeoff(scene, points, tmp_path / name) for name in ("first", "again"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]
