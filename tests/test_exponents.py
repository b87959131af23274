"""`fe-contact exponents`: limits at either end, spots by finite elements, files without NaN, the chart."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis.strategies import floats
from limits import compressible, incompressible

from fe_contact.cli import main
from fe_contact.studies.exponents import impacts as reading
from fe_contact.studies.exponents import readers
from fe_contact.studies.exponents.impacts import Impact, ImpactExponents, impact_exponents, impacts
from fe_contact.studies.exponents.layers import (
    PROFILES,
    TOLERANCE,
    Check,
    ExponentCurve,
    Profile,
    check,
    curve,
    curves,
)
from fe_contact.studies.exponents.readers import Reader, Samples
from fe_contact.studies.exponents.study import SHARES, Exponents, Pair, pairs
from lumped import Scene, simulate
from lumped.laws import ting
from lumped.load_curves.layer import PointLayer
from lumped.materials import Relaxation
from lumped.result.history import History

CONE, SPHERE, PUNCH, CYLINDER = (
    next(profile for profile in PROFILES if profile.name == name) for name in ("cone", "sphere", "punch", "cylinder")
)
ENDS = np.array([1e-4, 18.0])


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> tuple[ExponentCurve, ...]:
    return curves(True, tmp_path_factory.mktemp("exponents"))


@pytest.fixture(scope="module")
def checked() -> tuple[Check, ...]:
    places = ((CONE, "bonded", 0.3, 1.0), (SPHERE, "bonded", 0.49, 1.0), (SPHERE, "sliding", None, 1.0),
              (CYLINDER, "bonded", 0.3, 1.0))  # fmt: skip
    return tuple(check(*place) for place in places)


@pytest.fixture(scope="module")
def struck(tmp_path_factory: pytest.TempPathFactory) -> tuple[ImpactExponents, ...]:
    return impacts(True, tmp_path_factory.mktemp("impacts"))


@pytest.fixture(scope="module")
def spheres(tmp_path_factory: pytest.TempPathFactory) -> tuple[Pair, ...]:
    return pairs(True, tmp_path_factory.mktemp("spheres"))


def test_limits_of_the_thin_layer() -> None:
    """3/2 and 5/2 for the cylinder, 2 and 3 for the sphere (Johnson 1985, 5.8), 3 and 5 for the cone, always 1 flat."""
    limits = {profile.name: [profile.thin("bonded", nu) for nu in (0.3, 0.5)] for profile in PROFILES}
    assert limits["cylinder"] == [1.5, 2.5]
    assert limits["sphere"] == [2.0, 3.0]
    assert limits["cone"] == [3.0, 5.0]
    assert limits["punch"] == [1.0, 1.0]
    assert [profile.thin("sliding", None) for profile in (CYLINDER, SPHERE, CONE)] == [1.5, 2.0, 3.0]


@pytest.mark.parametrize("plane", [False, True], ids=["sphere", "cylinder"])
def test_the_limits_are_the_thin_layers_own(plane: bool) -> None:
    profile = CYLINDER if plane else SPHERE
    assert profile.thin("bonded", 0.3) == compressible(1.0, PointLayer(0.1, 0.3), plane=plane).exponent
    assert profile.thin("bonded", 0.5) == incompressible(1.0, PointLayer(0.1, 0.5), plane=plane).exponent


@pytest.mark.parametrize("profile", [one for one in PROFILES if not one.plane], ids=lambda one: one.label)
def test_small_contacts_are_the_half_spaces(profile: Profile) -> None:
    small = curve(profile, "bonded", 0.3, ENDS)
    assert small.exponent[0] == pytest.approx(profile.row, abs=2e-4)
    assert small.factor[0] == pytest.approx(1.0, abs=2e-4)


def test_a_cylinder_has_no_half_space_to_start_from() -> None:
    """Its exponent falls to 1 only as a logarithm does: alpha - 1 = 1/(2 ln(h/a) + ...)."""
    near, far = (curve(CYLINDER, "bonded", 0.3, np.array([ratio])) for ratio in (1e-3, 1e-6))
    assert 1.0 < far.exponent[0] < near.exponent[0] < 1.1
    gained = 1.0 / (far.exponent[0] - 1.0) - 1.0 / (near.exponent[0] - 1.0)
    assert gained == pytest.approx(2.0 * np.log(1e3), rel=1e-3)


@pytest.mark.family
@pytest.mark.parametrize("profile", PROFILES, ids=lambda one: one.label)
def test_thin_layers_come_near_their_limit(profile: Profile) -> None:
    thin = curve(profile, "sliding", None, ENDS)
    assert thin.exponent[-1] == pytest.approx(profile.thin("sliding", None), abs=1e-3)
    soft = curve(profile, "bonded", 0.5, ENDS)
    assert soft.exponent[-1] == pytest.approx(profile.thin("bonded", 0.5), rel=0.03)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49, 0.5])
def test_the_exponent_is_the_slope_of_the_force(nu: float) -> None:
    for profile in (CONE, SPHERE, CYLINDER):
        here = curve(profile, "bonded", nu, np.geomspace(0.05, 5.0, 401))
        slope = np.gradient(np.log(here.force), np.log(here.depth), edge_order=2)
        assert here.exponent[1:-1] == pytest.approx(slope[1:-1], abs=2e-4)


def test_depth_and_force_agree_with_the_table_of_line_contact() -> None:
    """R depth/h^2 and R F/(E* h^2 l) at a/h = 1: nu = 0.3: 0.65382, 1.2213; 0.45: 0.53284, 1.3813,
    from few Chebyshev terms.
    """
    for nu, number, force in ((0.3, 0.65382, 1.2213), (0.45, 0.53284, 1.3813)):
        here = curve(CYLINDER, "bonded", nu, np.array([1.0]))
        assert 0.5 * here.depth[0] == pytest.approx(number, rel=5e-4)
        assert 0.5 * here.force[0] == pytest.approx(force, rel=5e-4)


def test_the_punch_is_hayes() -> None:
    """kappa at a/h = 1: 2.4835 for nu = 0.3, 3.6187 for 0.5."""
    for nu, kappa in ((0.3, 2.4835), (0.5, 3.6187)):
        assert curve(PUNCH, "bonded", nu, np.array([1.0])).factor[0] == pytest.approx(kappa, abs=1e-4)


def test_every_profile_has_every_layer(found: tuple[ExponentCurve, ...]) -> None:
    layers = [("bonded", 0.3), ("bonded", 0.5), ("sliding", None)]
    assert [(one.profile, one.base, one.nu) for one in found] == [(p, *layer) for p in PROFILES for layer in layers]


def test_finite_elements_cover_the_exact_curves(checked: tuple[Check, ...]) -> None:
    for one in checked:
        assert one.covered
        assert one.converged
        assert one.factor.error is not None
        assert one.factor.error <= 2.0 * TOLERANCE * one.exact_factor
        assert one.exponent.value == pytest.approx(one.exact_exponent, abs=5e-4)


def test_a_check_off_its_bar_is_told(checked: tuple[Check, ...]) -> None:
    assert not replace(checked[0], exact_factor=1.01 * checked[0].exact_factor).covered
    assert not replace(checked[0], exact_exponent=1.01 * checked[0].exact_exponent).covered


def test_files(
    tmp_path: Path,
    found: tuple[ExponentCurve, ...],
    checked: tuple[Check, ...],
    spheres: tuple[Pair, ...],
    struck: tuple[ImpactExponents, ...],
) -> None:
    content = Exponents(found, checked, spheres, struck).write(tmp_path)
    with (tmp_path / "exponents.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[:6] == ["shape", "profile_exponent", "base", "nu", "a_over_h", "method"]
    assert list(rows[0])[-2:] == ["row_exponent", "thin_exponent"]
    assert len(rows) == sum(one.ratio.size for one in found) + len(checked)
    assert {row["method"] for row in rows} == {"exact", "fe"}
    assert all(row["nu"] == "" for row in rows if row["base"] == "sliding")
    assert all(row["profile_exponent"] == "" for row in rows if row["shape"] == "punch")
    assert json.loads((tmp_path / "exponents.json").read_text(encoding="utf-8")) == content
    assert len(content["curves"]) == len(found)
    assert content["all_covered"]
    with (tmp_path / "finite_spheres.csv").open(newline="", encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    assert len(lines) == len(spheres) * SHARES.size
    for line, share in zip(lines, np.tile(SHARES, len(spheres)), strict=True):
        assert float(line["a_over_R"]) == pytest.approx(share, rel=0.01), "the exact sphere's, not the parabola's"
    with (tmp_path / "exponents_from_impacts.csv").open(newline="", encoding="utf-8") as file:
        read = list(csv.DictReader(file))
    assert len(read) == len(struck) * len(reading.READERS)
    for line in read:
        assert float(line["bias"]) == pytest.approx(float(line["exponent"]) - float(line["row_exponent"]), abs=1e-12)
        assert float(line["error"]) > 0.0
        assert line["a_over_h"] == ""


def test_free_spheres_leave_hertz_by_the_share_of_their_radius(spheres: tuple[Pair, ...]) -> None:
    """Their slope is flat but for a logarithm; a body held from its middle plane on differs in c, not in the log."""
    free, held = (one.size for one in spheres)
    for size in (free, held):
        terms = {name: term.value or 0.0 for name, term in size.terms.items()}
        fitted = size.share * (terms["c"] + terms["k"] * np.log(size.share) + terms["d"] * size.share)
        assert np.all(np.abs(fitted - size.deviation) <= size.error + 1e-5)
    logs = [size.terms["k"] for size in (free, held)]
    assert abs((logs[0].value or 0.0) - (logs[1].value or 0.0)) <= sum(one.error or 0.0 for one in logs)
    assert free.slope.value != pytest.approx(held.slope.value, rel=0.02)


@pytest.mark.tenth
def test_the_command(
    tmp_path: Path,
    found: tuple[ExponentCurve, ...],
    checked: tuple[Check, ...],
    spheres: tuple[Pair, ...],
    struck: tuple[ImpactExponents, ...],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The charts of a tolerance reached and of one missed are the same, byte by byte."""
    charts = []
    for converged, code in ((True, 0), (False, 3)):
        spots, where = (*checked[:-1], replace(checked[-1], converged=converged)), tmp_path / str(code)
        for name, rows in {"checks": spots, "pairs": spheres, "impacts": struck}.items():
            monkeypatch.setattr(f"fe_contact.studies.exponents.study.{name}", lambda *_, rows=rows: rows)
        assert main(["exponents", "--quick", "--out", str(where), "--quiet"]) == code
        said = capsys.readouterr()
        assert len(said.out.splitlines()) == len(found) + len(spots) + len(spheres) + len(reading.sentences(struck)) + 1
        assert (f"tolerance not reached at 1 of {6 + len(struck)}" in said.err) == (code == 3)
        assert {path.name for path in where.iterdir()} == {
            "finite_spheres.csv",
            *(f"exponents.{kind}" for kind in ("csv", "json", "jsonl", "svg", "png")),
            *(f"exponents_from_impacts.{kind}" for kind in ("csv", "svg", "png")),
        }
        charts.append({path.name: path.read_bytes() for path in where.iterdir() if path.suffix in (".svg", ".png")})
    assert charts[0] == charts[1]


# What is read from impacts.

EVERY: dict[str, Reader] = {**reading.READERS, "ting": readers.ting}
SHAPES = (reading.CONE, reading.SPHERE, reading.POWER)


def sampled(scene: Scene, factor: Callable[[np.ndarray], np.ndarray] = np.ones_like) -> Samples:
    """Ting's exact history of a scene."""
    return Samples.of(simulate(ting.of(scene), scene, 1e-7).history, 1e-7, scene.mass, factor)


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("profile", SHAPES, ids=lambda one: one.label)
def test_every_reader_is_right_on_an_elastic_body(profile: Profile, name: str) -> None:
    found = EVERY[name](sampled(Impact(profile, 1.0, 1.0, None, reading.EXACT).scene))
    assert found.exponent == pytest.approx(profile.row, abs=1e-6)
    assert found.error < 1e-5


@seed(1)
@settings(max_examples=20, deadline=None)
@given(alpha=floats(1.1, 3.0), damping=floats(0.0, 2.0))
def test_hunt_crossleys_own_history_has_its_exponent(alpha: float, damping: float) -> None:
    """Made of their formula, not of a motion: depth over a half wave, the force from it."""
    time = np.linspace(0.0, 1.0, 801)
    depth, rate = np.sin(np.pi * time), np.pi * np.cos(np.pi * time)
    force = depth**alpha * (1.0 + damping * rate / np.pi / 2.0)
    nothing = np.zeros_like(time)
    history = History(time, depth, rate, force, nothing, nothing)
    samples = Samples.of(history, 0.0, 1.0, np.ones_like)
    assert readers.hunt_crossley(samples).exponent == pytest.approx(alpha, abs=1e-5)


@pytest.mark.parametrize("ratio", [1.5, 10.0])
def test_logarithms_on_a_cone_are_right_at_both_ends(ratio: float) -> None:
    """A slow solid's bias is known in closed form: F = E_i (y - rate int y dt), with the rate of E(t) at t = 0.

    So it falls as T/tau, and that of a fast one, whose force is E_inf y + eta y', with tau/T.
    """

    def bias(relaxation: float) -> float:
        scene = Impact(reading.CONE, ratio, relaxation, None, reading.EXACT).scene
        return readers.log_log(sampled(scene)).exponent - 2.0

    slow = Impact(reading.CONE, ratio, 1e4, None, reading.EXACT).scene
    stiff = replace(slow, material=replace(slow.material, young=Relaxation(ratio)))
    history = simulate(ting.of(stiff), stiff, 1e-7).history
    samples = Samples.of(history, 1e-7, stiff.mass, np.ones_like)
    load = samples.depth**2
    worn = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(samples.time) * (load[1:] + load[:-1]))])
    rate = (1.0 - 1.0 / ratio) * float(history.time[-1]) / slow.material.young.times[0]
    near = np.flatnonzero((samples.depth >= readers.FIRST) & (np.arange(load.size) <= samples.turn))
    slope = np.polyfit(np.log(samples.depth[near]), -rate * worn[near] / load[near], 1)[0]
    assert bias(1e4) == pytest.approx(slope, rel=2e-3)
    assert bias(1e-5) / bias(2e-5) == pytest.approx(0.5, rel=0.05)
    assert abs(bias(1e-5)) < 2e-3


@pytest.mark.tenth
def test_tings_law_returns_the_rows_exponent(campaign_size: Callable[..., int]) -> None:
    """On random solids, whose moduli and time it is not told, within its bar."""
    random = np.random.default_rng(5)
    for _ in range(campaign_size(200, 6, most=10)):
        profile, ratio = SHAPES[random.integers(3)], 10.0 ** random.uniform(0.05, 1.1)
        scene = Impact(profile, ratio, 10.0 ** random.uniform(-2.5, 2.0), None, reading.EXACT).scene
        found = readers.ting(sampled(scene))
        assert abs(found.exponent - profile.row) <= found.error, scene
        assert found.error < 0.03, "far below what the other readers are off by, even where samples miss the relaxation"


def test_a_known_thickness_is_taken_away_too() -> None:
    found = impact_exponents(reading.SPHERE, 3.0, 0.3, 1.0, reading.EXACT)
    assert found.left <= found.corrected.error < 1e-2
    assert abs(found.bias("log_log")) > 0.03


@pytest.mark.parametrize(
    "profile", [reading.CONE, pytest.param(reading.POWER, marks=pytest.mark.tenth)], ids=lambda one: one.label
)
def test_finite_elements_and_exact_histories_give_one_exponent(profile: Profile) -> None:
    both = [impact_exponents(profile, 3.0, 0.3, None, method) for method in (reading.EXACT, reading.FE)]
    ((fe, alike),) = reading.agreeing(both)
    assert fe.converged
    assert alike
    assert all(fe.read[name].error < 0.1 * abs(fe.bias(name)) for name in reading.READERS), fe.read


@pytest.mark.parametrize("name", EVERY)
def test_a_bar_holds_a_force_that_is_off(name: str) -> None:
    """A force that is off by as much as its bar, and the depth that follows from it."""
    scene = Impact(reading.SPHERE, 3.0, 0.3, None, reading.EXACT).scene
    history = simulate(ting.of(scene), scene, 1e-7).history
    extra = 1e-3 * history.force.max() * np.sin(np.pi * history.time / history.time[-1]) ** 2
    speed = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(history.time) * (extra[1:] + extra[:-1]))]) / scene.mass
    way = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(history.time) * (speed[1:] + speed[:-1]))])
    other = replace(history, force=history.force + extra, velocity=history.velocity - speed, depth=history.depth - way)
    history = replace(history, force_error=extra)
    off = float(np.sqrt(np.trapezoid(extra**2, history.time) / np.trapezoid(history.force**2, history.time)))
    before, after = (EVERY[name](Samples.of(one, off, scene.mass, np.ones_like)) for one in (history, other))
    assert abs(after.exponent - before.exponent) <= before.error
    assert before.error < 0.1


def test_what_is_off_the_bars_does_not_agree(struck: tuple[ImpactExponents, ...]) -> None:
    fe = struck[-1]
    off = {**fe.read, "log_log": replace(fe.read["log_log"], exponent=fe.read["log_log"].exponent + 0.1)}
    assert [alike for _, alike in reading.agreeing([*struck[:-1], replace(fe, read=off)])] == [False]
