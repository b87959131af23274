"""The trade-off: a front that is one, operators that are built for every point, a verdict that follows."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_contact.cli import main
from fe_contact.methods import exact_laws
from fe_contact.reference import plan
from fe_contact.settings import Numerics
from fe_contact.studies.tradeoff import study
from fe_contact.studies.tradeoff.chart import plot_tradeoff
from fe_contact.studies.tradeoff.point import MEASURED, REFERENCE, Answer, Point, Truth
from fe_contact.studies.tradeoff.study import Tradeoff, tradeoff, varied
from fe_contact.studies.tradeoff.tried import LAW_TOLERANCES, ROW, ROW_ELEMENTS, asked_laws, variations
from fe_contact.studies.tradeoff.verdict import (
    NEAR,
    advice,
    brief,
    finite_elements,
    front,
    judged,
    known_to,
    serves,
    verdict,
)
from fe_contact.targets import half_space
from lumped.scene.scene import Scene
from lumped.schema.files import SCENES

SETTINGS = {"order": 4, "elements_per_contact": 3.2, "steps": 40, "enforcement": "corrected", "penalty": 1e3}
TRUTH = Point(REFERENCE, {"from": "ting"}, 0.1, bar=1e-8)


def point(cpu: float, error: float, bar: float = 1e-9, method: str = "fe", **more: Any) -> Point:
    settings = SETTINGS | more.pop("settings", {})
    return Point(method, settings, cpu, {"peak_force": error}, bar, **more)


def silent(message: str) -> None:
    pass


def numerics(scene: Scene, **given: object) -> Numerics:
    return plan(scene, given).numerics


@pytest.fixture(scope="module")
def scene() -> Scene:
    return Scene.load("polymer-sphere")


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the rows of `found` are kept."""
    return tmp_path_factory.mktemp("tradeoff")


@pytest.fixture(scope="module")
def found(scene: Scene, kept: Path) -> Tradeoff:
    """The default, the exact laws and all others."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "variations", lambda *_: iter(()))
        return tradeoff(scene, {}, True, kept, silent)


@given(st.lists(st.tuples(st.floats(1e-3, 1e3), st.floats(1e-9, 1.0)), min_size=1, max_size=30))
def test_the_front_holds_the_points_that_nothing_beats(pairs: list[tuple[float, float]]) -> None:
    """By comparing every point with every other: those that no other one beats in one sense and equals in the other."""
    tried = [point(cpu, error) for cpu, error in pairs]
    best = front(tried, lambda p: p.cpu, lambda p: p.error)
    unbeaten = {
        (cpu, error)
        for cpu, error in pairs
        if not any(c <= cpu and e <= error and (c, e) != (cpu, error) for c, e in pairs)
    }
    assert {(p.cpu, p.error) for p in best} == unbeaten
    assert all(a.cpu < b.cpu and a.error > b.error for a, b in pairwise(best))


@pytest.mark.parametrize(
    ("cpu", "bar", "phrase"),
    [
        (1.0, 5e-4, "on the front"),
        (1.4, 5e-4, f"within {NEAR:g} of the front"),
        (5.0, 5e-4, "5.00 times the cheapest whose bar meets the tolerance: off the front"),
        (1.0, 2e-3, "misses the tolerance"),
    ],
)
def test_the_distance_of_a_default_follows_from_the_points(cpu: float, bar: float, phrase: str) -> None:
    tried = [TRUTH, point(1.0, 1e-4, 9e-4), point(cpu, 1e-4, bar, default_for=1e-3)]
    assert phrase in verdict(tried, 1e-3)[1]


def test_what_claims_too_much_is_no_front_for_a_default() -> None:
    """A setting whose bar is untrue serves nobody, however cheap; nor does one that fails."""
    untrue = point(0.1, 5e-3, 1e-5)
    failed = replace(point(0.1, 1e-9), failure="no contact")
    tried = [TRUTH, untrue, failed, point(1.0, 1e-4, 5e-4, default_for=1e-3)]
    assert not serves(untrue, tried, 1e-3)
    assert "on the front" in verdict(tried, 1e-3)[1]
    assert verdict(tried, 1e-3)[-1].endswith("covers the error in 1 of 2 settings of finite elements")


def test_advice_names_the_cheapest_that_serves_and_the_cheapest_finite_elements() -> None:
    """Fake laws: one slow, one fast and inexact, one of another model, one that claims nothing.

    The default's settings are said shortly, another enforcement is named.
    """
    elements = point(0.09, 1e-5, 2e-4)
    slow, inexact = point(0.5, 1e-9, method="slow"), point(1e-4, 0.1, method="inexact")
    another = point(1e-4, 1e-9, method="another model", leaves_out="waves")  # near by chance
    silent_one = Point("estimate", {}, 1e-4, {"peak_force": 1e-9})
    exact = point(8e-3, 1e-7, 1e-6, method="ting")
    said = "order 4, 3.2 elements, 40 steps, 90 ms, bar 2e-4"
    others = [TRUTH, slow, inexact, another, silent_one, elements]
    assert advice([*others, exact], 1e-3) == f"use ting (8 ms, 1e-6); if finite elements: {said}"
    assert advice(others, 1e-3) == f"use finite elements: {said}"
    assert advice([TRUTH, exact], 1e-3) == "use ting (8 ms, 1e-6); finite elements need a geometry"
    assert advice([TRUTH, exact, elements], 1e-5) == "use ting (8 ms, 1e-6); no finite elements tried meet 1e-05"
    assert advice([TRUTH, inexact], 1e-3) == "nothing that was tried meets 0.001"
    cheaper = point(0.05, 1e-5, 2e-4, settings={"enforcement": "penalty", "penalty": 1e4})
    default = replace(elements, default_for=1e-3)
    assert "40 steps, enforcement penalty, penalty 1e+04, 50 ms" in advice([TRUTH, default, cheaper], 1e-3)


@given(st.floats(1e-12, 0.1))
def test_a_bar_is_said_by_one_digit(bar: float) -> None:
    assert float(brief(bar)) == pytest.approx(bar, rel=0.5)
    assert re.fullmatch(r"\de-\d+", brief(bar))


def test_a_force_that_is_cut_off_errs_by_nothing_for_a_digit_of_its_end() -> None:
    """Two answers to one end time, which differ by rounding."""
    time = np.linspace(0.0, 0.3, 20)
    later = np.append(time[:-1], np.nextafter(0.3, 1.0))
    values = dict.fromkeys(MEASURED)
    one, other = (Answer({}, values, None, {}, rows, 1.0 + time) for rows in (time, later))
    assert Truth.of(one).errors(other, smooth=True)["history"] < 1e-12
    assert Truth.of(one).errors(other, smooth=False)["history"] < 1e-12
    assert one.force_at(np.array([0.3001])) == 0.0


def test_a_point_within_the_bar_of_the_truth_is_not_held_against_a_setting() -> None:
    wide = replace(TRUTH, bar=1e-3)
    tried = [wide, point(1.0, 9e-4, 1e-5)]
    assert known_to(tried) == 1e-3
    assert serves(tried[1], tried, 1e-4)
    assert not serves(tried[1], [TRUTH, *tried[1:]], 1e-4)


@pytest.mark.parametrize("quick", [True, False])
def test_the_design_tries_each_setting_once_and_keeps_what_is_given(scene: Scene, quick: bool) -> None:
    given_settings = {"order": 3, "penalty": 500.0}
    base = numerics(scene, **given_settings)
    chosen = varied(base, given_settings, variations(scene, base, quick))
    assert len(set(chosen)) == len(chosen)
    assert {(n.order, n.penalty) for n in chosen} == {(3, 500.0)}
    assert {n.contact_time for n in chosen} == {base.contact_time}


def test_the_full_design_holds_the_quick_one(scene: Scene) -> None:
    base = numerics(scene)
    quick, full = (varied(base, {}, variations(scene, base, quick)) for quick in (True, False))
    assert 8 <= len(quick) <= 20 < 50 <= len(full) <= 75
    assert set(quick) < set(full)
    for key in ("order", "elements_per_contact", "steps", "enforcement", "penalty"):
        assert len({getattr(n, key) for n in quick}) > 1
    assert all(n.steps % 4 == 0 for n in full)


def test_every_packaged_scene_has_something_to_try() -> None:
    """Laws or finite elements that have an answer, whatever the kind; a law's own scene is asked of that law alone."""
    for name in SCENES.names:
        one = Scene.load(name)
        asked = {method for method, _ in asked_laws(one, True)}
        assert asked >= set(exact_laws(one))
        if not one.has_geometry:
            assert one.law is not None
            assert asked == {one.law.name}


def test_the_default_keeps_its_promise(found: Tradeoff) -> None:
    (default,) = [p for p in found.points if p.default_for is not None]
    assert default.default_for == found.tolerance == 1e-3
    assert default.bar is not None
    assert default.error <= default.bar <= found.tolerance
    assert default.cpu > 0.0


@pytest.mark.tenth
def test_every_point_builds_its_operators_again(scene: Scene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a user pays holds the factorizations, and no point lives on those of another."""
    built = []

    def counted(*arguments: object) -> object:
        built.append(arguments)
        return original(*arguments)

    original = half_space._whole
    monkeypatch.setattr(half_space, "_whole", counted)
    monkeypatch.setattr(study, "variations", lambda *_: iter([{"steps": 24}]))
    monkeypatch.setattr(study, "asked_laws", lambda *_: ())
    monkeypatch.setattr(study, "BRIEF", np.inf)
    points = finite_elements(tradeoff(scene, {"tolerance": 1e-2}, True, tmp_path, silent).points)
    assert len(points) == 2
    assert len(built) == study.REPEATS * sum(p.work["factorizations"] for p in points)


def test_the_row_of_springs_converges_with_order_two(found: Tradeoff) -> None:
    errors = [p.error for p in found.points if p.method == ROW]
    rates = np.diff(np.log(errors)) / -np.diff(np.log(ROW_ELEMENTS))
    assert rates[1:].min() > 1.7


def test_exact_laws_keep_their_bars_and_models_do_not_converge(found: Tradeoff) -> None:
    """Each exact law judged by the other one."""
    for name in ("mdr", "ting"):
        own = [p for p in found.points if p.method == name]
        assert [p.settings["tolerance"] for p in own] == list(LAW_TOLERANCES[::2])
        assert all(0.0 < p.error <= (p.bar or 0.0) + known_to(found.points) for p in own)
    models = {p.method: p.error for p in judged(found.points) if p.method not in ("fe", "mdr", "ting", ROW)}
    assert {"hertz", "correspondence", "jankowski"} <= set(models)
    assert min(models.values()) > 0.01
    assert found.verdict[0].startswith("use ting (")


@pytest.mark.tenth
def test_several_impacts_are_judged_by_their_first_contact(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Finer elements are the truth, as no law is exact; what later contacts lag is no error of the force."""
    monkeypatch.setattr(study, "variations", lambda *_: iter(()))
    monkeypatch.setattr(study, "asked_laws", lambda *_: ())
    found = tradeoff(Scene.load("ball-bouncing", {"motion.impacts": 2}), {}, True, tmp_path, silent)
    (default,) = finite_elements(found.points)
    (truth,) = [p for p in found.points if p.method == REFERENCE]
    assert truth.settings["steps"] == 2 * default.settings["steps"]
    assert truth.settings["elements_per_contact"] > default.settings["elements_per_contact"]
    assert 0.0 < default.error <= (default.bar or 0.0) + (truth.bar or 0.0) <= found.tolerance


def test_a_law_s_own_scene_has_no_finite_elements(tmp_path: Path) -> None:
    found = tradeoff(Scene.load("pounding-bridge-hertzdamp"), {}, True, tmp_path, silent)
    assert {p.method for p in found.points} == {REFERENCE, "hertzdamp"}
    assert re.fullmatch(r"use hertzdamp \(\d+ ms, \de-\d+\); finite elements need a geometry", found.verdict[0])
    plot_tradeoff(found, tmp_path)
    assert (tmp_path / "tradeoff.png").is_file()


@pytest.mark.tenth
def test_the_command_writes_table_and_chart(
    found: Tradeoff, kept: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of the rows that it finds; the chart is the same byte by byte."""
    monkeypatch.setattr(study, "variations", lambda *_: iter(()))
    assert main(["tradeoff", "polymer-sphere", "--quick", "--json", "--quiet", "--out", str(kept)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((kept / "tradeoff.json").read_text(encoding="utf-8"))
    assert printed["verdict"] == list(found.verdict)
    assert printed["verdict"][0].startswith("use ting (")
    with (kept / "tradeoff.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(printed["points"])
    errors = [p["error"] for p in printed["points"]]
    assert [float(row["error"]) if row["error"] else None for row in rows] == errors
    again = plot_tradeoff(found, kept / "again")
    assert {path.name for path in again} == {"tradeoff.svg", "tradeoff.png"}
    assert [path.read_bytes() for path in again] == [(kept / path.name).read_bytes() for path in again]


@pytest.mark.family
@pytest.mark.parametrize("decades", [0.05, 0.3, 0.9, 1.4, 1.6, 4.0, 9.0])
@pytest.mark.parametrize("low", [1.3e-9, 0.07, 0.95])
def test_tick_labels_do_not_collide(low: float, decades: float) -> None:
    """Whatever an axis spans: the boxes of its labels, as drawn, stay apart, and there is one at least."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from fe_contact.studies.tradeoff.chart import ticks

    figure, high = Figure(figsize=(3.4, 3.0)), low * 10.0**decades
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set(xscale="log", yscale="log", xlim=(low, high), ylim=(low, high))
    ticks(axes)
    canvas.draw()
    for axis in (axes.xaxis, axes.yaxis):
        minor, major = axis.get_ticklabels(minor=True), axis.get_ticklabels()
        boxes = [one.get_window_extent() for one in (*minor, *major) if one.get_text() and one.get_visible()]
        assert boxes
        assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[i + 1 :])
