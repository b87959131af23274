"""Transfer: a law on itself holds everywhere, a wrong one errs by what an independent integration says."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import fe_contact
from fe_contact.cli import main
from fe_contact.studies import style
from fe_contact.studies.transfer.chart import LINE, plot_transfer, spread, with_unit
from fe_contact.studies.transfer.study import TransferStudy
from fe_contact.studies.transfer.verdict import QUANTITIES, TransferRow, TransferVerdict, holds, row_of
from lumped import BadInput, Scene, laws
from lumped.result.result import Quantity
from lumped.scene.tables import LawChoice
from lumped.schema.files import data_folder

VELOCITY = "striker.velocity"
DAMPED = ("kelvin", "mahmoud", "jankowski", "hunt_crossley", "hertzdamp", "khatiwada", "kuwabara_kono", "tsuji")
SPRINGS = ("linear_spring", "hertz")


def body(law: str, mass: float = 0.001, velocity: float = 1.0, **values: float) -> Scene:
    return Scene(None, mass=mass, velocity=velocity, law=LawChoice(law, values))


def of(study: TransferStudy, law: str, quantity: str) -> dict[float, TransferRow]:
    return {row.value: row for row in study.rows if (row.law, row.quantity) == (law, quantity)}


@pytest.mark.parametrize("calibrate", ["least_squares", "restitution"])
def test_a_law_calibrated_on_itself_holds_everywhere(calibrate: str, campaign_size: Callable[..., int]) -> None:
    """Random bodies, stiffnesses and dampings; the law is its own reference, with bars of 1e-9 and less."""
    generator = np.random.default_rng(16)
    for case in range(campaign_size(100, 3)):
        law = (*DAMPED, *SPRINGS)[case % 10]
        mass, velocity, duration = 10.0 ** generator.uniform((-5.0, -2.0, -5.0), (4.0, 1.5, 0.0))
        alpha = 1.0 if law in ("kelvin", "mahmoud", "linear_spring") else 1.5
        k = mass * velocity**2 / (0.3 * velocity * duration) ** (alpha + 1.0)
        damping = {} if law in SPRINGS else {"e": float(generator.uniform(0.3, 0.95))}
        states = tuple(float(one) for one in velocity * generator.uniform(0.3, 3.0, 2))
        heavier = {"striker.mass": (mass * float(generator.uniform(0.3, 3.0)),)}
        # the reference carries numbers too: of e it would be another law at every state
        given = own_numbers(body(law, mass, velocity, k=k, **damping))
        study = fe_contact.transfer(given, (law,), over={VELOCITY: states, **heavier}, calibrate=calibrate)
        assert {row.verdict for row in study.rows} == {TransferVerdict.INSIDE}, (case, law)
        assert "within the error bars" in study.sentences[0]


def test_a_law_of_modulus_and_restitution_holds_over_lengths_and_velocities() -> None:
    """Its stiffness is that of E* and the geometry, its damping that of e, at every state."""
    scene = Scene.load("steel-ball", {"law.name": "hunt_crossley", "law.e": 0.6})
    over = {VELOCITY: (0.3, 3.0), "striker.radius": (0.001, 0.004)}
    study = fe_contact.transfer(scene, ("hunt_crossley", "hertz"), over=over, calibrate="modulus")
    ours = [row for row in study.rows if row.law == "hunt_crossley"]
    assert {row.verdict for row in ours} == {TransferVerdict.INSIDE}
    assert len(ours) > 20
    assert any(row.verdict == TransferVerdict.OUTSIDE for row in study.rows if row.law == "hertz")


def own_numbers(scene: Scene) -> Scene:
    """The scene with the damping's own number in the place of e, by the law's formula for its force."""
    assert scene.law is not None
    if "e" not in scene.law.values:
        return scene
    name, m = scene.law.name, scene.mass
    law = vars(laws.get(name).of(scene))
    k = law["k"]
    own = {
        "kelvin": lambda: {"xi": law["c"] / (2.0 * np.sqrt(k * m))},
        "mahmoud": lambda: {"xi": law["c"] / (2.0 * np.sqrt(k * m))},
        "jankowski": lambda: {"xi": law["c"] / (2.0 * np.sqrt(k * m))},
        "hunt_crossley": lambda: {"chi": law["chi"]},
        "hertzdamp": lambda: {"xi": law["xi"]},
        "khatiwada": lambda: {"c": law["c"]},
        "kuwabara_kono": lambda: {"A": law["A"]},
        "tsuji": lambda: {"alpha_t": law["c"] / np.sqrt(k * m)},
    }[name]()
    return replace(scene, law=LawChoice(name, {"k": k, **{key: float(value) for key, value in own.items()}}))


def test_a_law_of_the_material_is_carried_over_temperatures_and_a_spring_is_not() -> None:
    """R1 and R2, fitted warm, belong to the reference temperature; k and chi know none."""
    shift = {"temperature": 296.0, "reference_temperature": 293.15, "wlf": [17.44, 51.6]}
    scene = Scene.load("polymer-sphere", {f"target.material.{key}": value for key, value in shift.items()})
    key = "target.material.temperature"
    study = fe_contact.transfer(scene, ("ting", "hunt_crossley"), over={key: (290.0, 299.0)}, method="ting")
    assert study.start == {key: 296.0}
    assert {row.verdict for row in study.rows if row.law == "ting"} == {TransferVerdict.INSIDE}
    wrong = of(study, "hunt_crossley", "restitution")
    assert wrong[290.0].predicted == wrong[299.0].predicted
    assert wrong[290.0].reference != pytest.approx(wrong[299.0].reference, rel=0.01)


@pytest.mark.family
@pytest.mark.parametrize(
    "law", ["kelvin", "hunt_crossley", "tsuji", pytest.param("impact_bilinear", marks=pytest.mark.full)]
)
def test_restitution_and_peak_are_met_where_they_were_measured(law: str) -> None:
    """And the whole history is met no better than by least squares."""
    scene = Scene.load("polymer-sphere")
    field, least = (
        fe_contact.transfer(scene, (law,), over={VELOCITY: ()}, calibrate=how, method="ting")
        for how in ("restitution", "least_squares")
    )
    for name in ("peak_force", "restitution"):
        assert of(field, law, name)[0.02].verdict is TransferVerdict.INSIDE
    assert (field.calibrations[law].error or 0.0) > (least.calibrations[law].error or 0.0)


def test_what_python_asks_is_checked_before_any_work() -> None:
    scene = Scene.load("polymer-sphere")
    for wrong in ({"laws": ("tong",)}, {"calibrate": "peak"}, {"within": 2.0}, {"over": {"striker.speed": (1.0,)}}):
        with pytest.raises(BadInput):
            fe_contact.transfer(scene, **wrong)  # type: ignore[arg-type]


def test_a_loop_is_carried_by_its_springs() -> None:
    given = body("impact_bilinear", k1=2e5, k2=5e4, yield_depth=2e-5)
    for calibrate in ("least_squares", "restitution"):
        study = fe_contact.transfer(given, ("impact_bilinear",), calibrate=calibrate)
        assert set(study.calibrations["impact_bilinear"].values) == {"k1", "k2", "yield_depth"}
        if calibrate == "least_squares":
            assert {row.verdict for row in study.rows} == {TransferVerdict.INSIDE}


def test_a_wrong_law_deviates_as_an_independent_integration_says() -> None:
    """Kelvin calibrated on Hunt and Crossley's impact: both integrated once more, by scipy, at every state."""
    given = body("hunt_crossley", k=1e7, chi=0.4)
    study = fe_contact.transfer(given, ("kelvin",), over={VELOCITY: (0.4, 2.0)})
    numbers = study.calibrations["kelvin"].values
    c = 2.0 * numbers["xi"] * np.sqrt(numbers["k"] * given.mass)
    for velocity in (0.4, 1.0, 2.0):
        truth = integrated(lambda d, v: 1e7 * d * np.sqrt(abs(d)) * (1.0 + 0.4 * v), given.mass, velocity)
        wrong = integrated(lambda d, v: numbers["k"] * d + c * v, given.mass, velocity)
        for name in QUANTITIES:
            absolute = name == "restitution"
            expected = wrong[name] - truth[name] if absolute else wrong[name] / truth[name] - 1.0
            assert of(study, "kelvin", name)[velocity].deviation == pytest.approx(expected, abs=1e-6), name
    assert of(study, "kelvin", "peak_force")[2.0].verdict is TransferVerdict.OUTSIDE


def integrated(force: Callable[[float, float], float], mass: float, velocity: float) -> dict[str, float]:
    """An impact by Runge-Kutta of order 8 until the force returns to zero, its peak by a fine grid of the answer."""

    def ends(t: float, y: Any) -> float:
        return force(y[0], y[1]) if y[1] < 0.0 else 1.0

    ends.terminal, ends.direction = True, -1.0  # type: ignore[attr-defined]

    def rate(t: float, y: Any) -> tuple[float, float]:
        return y[1], -force(y[0], y[1]) / mass

    found = solve_ivp(
        rate, (0.0, 1.0), (0.0, velocity), "DOP853", events=ends, dense_output=True, rtol=1e-12, atol=1e-18
    )
    end = float(found.t_events[0][0])
    depth, speed = found.sol(np.linspace(0.0, end, 20_001))
    last = float(found.y_events[0][0][1])
    forces = [force(d, v) for d, v in zip(depth, speed, strict=True)]
    restitution = -last / velocity
    return {"peak_force": max(forces), "peak_depth": float(depth.max()), "duration": end, "restitution": restitution,
            "impulse": mass * velocity * (1.0 + restitution)}  # fmt: skip


def test_hertzdamp_keeps_the_restitution_that_hunt_crossley_loses() -> None:
    """At a given chi the damping is chi v: twice the velocity is twice the damping."""
    given = body("hertzdamp", k=1e7, xi=0.3)
    study = fe_contact.transfer(given, ("hertzdamp", "hunt_crossley"), over={VELOCITY: (0.5, 2.0)})
    assert all(row.verdict is TransferVerdict.INSIDE for row in of(study, "hertzdamp", "restitution").values())
    chi = study.calibrations["hunt_crossley"].values["chi"]
    for velocity, row in of(study, "hunt_crossley", "restitution").items():
        own = laws.get("hunt_crossley").family
        assert own is not None
        assert row.predicted == pytest.approx(own.restitution(chi * velocity), abs=1e-9)
    assert holds([r for r in study.rows if r.law == "hunt_crossley"], 1.0)["restitution"]["1 %"] == (1.0, 1.0)


BAR = Quantity(1.0, 0.01, "N")


@pytest.mark.parametrize(
    ("ours", "theirs", "verdict"),
    [
        (Quantity(1.0099, 0.0, "N"), BAR, TransferVerdict.INSIDE),
        (Quantity(1.0149, 0.005, "N"), BAR, TransferVerdict.INSIDE),
        (Quantity(1.0151, 0.005, "N"), BAR, TransferVerdict.WITHIN),
        (Quantity(0.94, 0.005, "N"), BAR, TransferVerdict.OUTSIDE),
        (Quantity(None, None, "N"), BAR, TransferVerdict.OUTSIDE),
        (Quantity(None, None, "N"), Quantity(None, None, "N"), TransferVerdict.INSIDE),
        (None, BAR, TransferVerdict.REFUSED),
        (BAR, None, TransferVerdict.REFUSED),
    ],
)
def test_a_verdict_allows_for_both_bars(
    ours: Quantity | None, theirs: Quantity | None, verdict: TransferVerdict
) -> None:
    row = row_of("kelvin", VELOCITY, 1.0, "peak_force", ours, theirs, 0.05)
    assert row.verdict is verdict
    assert row.reference_error == (theirs.error if theirs else None)


def test_a_range_has_no_gap() -> None:
    """Good again beyond a bad state is no range that anybody may rely on."""
    deviations = {0.5: 0.005, 1.0: 0.0, 2.0: 0.03, 4.0: 0.2, 8.0: 0.001}
    rows = [
        row_of("k", VELOCITY, v, "peak_force", Quantity(1.0 + d, 0.0, "N"), Quantity(1.0, 0.0, "N"), 0.05)
        for v, d in deviations.items()
    ]
    assert holds(rows, 1.0)["all"] == {"1 %": (0.5, 1.0), "5 %": (0.5, 2.0), "10 %": (0.5, 2.0)}
    assert holds(rows, 4.0)["all"] == {"1 %": None, "5 %": None, "10 %": None}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A table judged by finite elements."""
    where = tmp_path_factory.mktemp("transfer")
    options = ["--laws", "hunt_crossley,ting,rod_waves", "--over", "striker.velocity=0.01..0.04:2", "--quiet"]
    assert main(["transfer", "polymer-sphere", "--out", str(where), *options]) == 0
    return where


def test_finite_elements_judge_and_the_files_say_the_same(written: Path) -> None:
    content = json.loads((written / "transfer.json").read_text(encoding="utf-8"))
    with (written / "transfer.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    header = "law,key,value,quantity,predicted,reference,reference_error,deviation,verdict"
    assert ",".join(rows[0]) == header
    assert len(rows) == len(content["rows"]) == 3 * 3 * len(QUANTITIES)
    for row, told in zip(rows, content["rows"], strict=True):
        assert (row["law"], row["verdict"]) == (told["law"], told["verdict"])
        assert row["predicted"] == ("" if told["predicted"] is None else repr(told["predicted"]))
        assert bool(told["reason"]) == (told["verdict"] == "refused") == (told["law"] == "rod_waves")
        assert 0.0 < told["reference_error"] < 2e-3 * max(told["reference"], 1.0)
    assert {row["verdict"] for row in rows if row["law"] == "ting"} == {"inside"}
    assert content["laws"]["rod_waves"]["refused"].endswith("but for a rod; accepted: rod, or another method")
    slow = next(
        r for r in content["rows"] if (r["law"], r["quantity"], r["value"]) == ("hunt_crossley", "restitution", 0.01)
    )
    assert slow["deviation"] > 0.1, "a damping in proportion to the velocity loses too little where that is small"
    assert {path.name for path in written.iterdir()} == {
        "transfer.csv", "transfer.json", "transfer.svg", "transfer.png",
    }  # fmt: skip


@pytest.mark.tenth
def test_the_waves_of_a_rod_transfer_and_a_spring_does_not() -> None:
    """What a rod radiates is lost: no spring bounces back as slowly."""
    study = fe_contact.transfer(Scene.load("concrete-pole"), ("rod_waves", "hertz"), over={VELOCITY: (3.0,)})
    assert {row.verdict for row in study.rows if row.law == "rod_waves"} == {TransferVerdict.INSIDE}
    assert of(study, "hertz", "restitution")[3.0].verdict is TransferVerdict.OUTSIDE


def test_a_state_without_a_reference_is_told_and_the_others_go_on() -> None:
    """The heavy ball would sink in deeper than the layer is thick."""
    scene, heavy = Scene.load("polymer-layer"), 200.0
    study = fe_contact.transfer(scene, ("ting",), over={"striker.mass": (heavy,)}, method="ting")
    last = of(study, "ting", "peak_force")[heavy]
    assert (last.verdict, of(study, "ting", "peak_force")[0.05].verdict) == (
        TransferVerdict.REFUSED,
        TransferVerdict.INSIDE,
    )
    assert "the layer's thickness" in last.reason
    assert "striker.mass = 200" in study.missed


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--over", "striker.velocity=0.1..0.01:3"], "low..high:n"),
        (["--over", "striker.velocity=0.01..0.1"], "low..high:n"),
        (["--over", "striker.velocity"], "--over: striker.velocity: accepted: KEY=low..high:n"),
        (["--over", "striker.speed=0.01..0.1:3"], "striker.speed: unknown key"),
        (["--over", "target.material.C1=1e3..1e4:2"], "--from with it"),
        (["--from", "striker.speed=0.1"], "striker.speed"),
        (["--from", "striker.velocity=fast"], "--from: 'fast': accepted a number"),
        (["--laws", "tong"], "did you mean ting?"),
        (["--calibrate", "peak"], "--calibrate: 'peak': accepted least_squares, restitution"),
        (["--method", "few"], "--method"),
        (["--within", "2"], "--within: 2: accepted a number from 0 to 1"),
    ],
)
def test_bad_options_write_nothing(options: list[str], message: str, refused: Callable[..., list[str]]) -> None:
    (fault,) = refused("transfer", "polymer-sphere", *options)
    assert message in fault


def test_bad_options_are_told_together(refused: Callable[..., list[str]]) -> None:
    said = refused("transfer", "polymer-sphere", "--calibrate", "peak", "--within", "2")
    assert [line.partition(":")[0] for line in said] == ["--calibrate", "--within"]


def test_no_two_laws_share_a_colour() -> None:
    """One that nobody gave a colour is black."""
    named = [style.LAWS[name] for name in laws.available() if name in style.LAWS]
    assert len(named) >= 15
    assert len({*named, style.BLACK}) == len(named) + 1


def test_names_beside_a_panel_do_not_cover_each_other() -> None:
    generator = np.random.default_rng(3)
    for count in range(1, 14):
        wanted = np.sort(generator.uniform(0.0, 1.0, count) ** 3)
        sizes = LINE * generator.choice([1.0, 2.0] if count < 7 else [1.0], count)  # of 14 laws at most
        places = spread(wanted, sizes)
        assert np.all(np.diff(places) > 0.5 * (sizes[1:] + sizes[:-1]) - 1e-12)
        assert places[0] >= 0.0
        assert places[-1] <= 1.0


@pytest.mark.parametrize(
    ("key", "said"),
    [
        ("striker.velocity", "striker.velocity, m/s"),
        ("striker.radius", "striker.radius, m"),
        ("target.thickness", "target.thickness, m"),
        ("target.material.E1", "target.material.E1, Pa"),
        ("target.material.nu", "target.material.nu"),
        ("model.gravity", "model.gravity, m/s2"),
    ],
)
def test_the_axis_of_the_states_has_its_unit(key: str, said: str) -> None:
    assert with_unit(key) == said


@pytest.mark.tenth
def test_the_chart_is_reproducible_and_says_where_its_axes_are_linear_and_what_its_shades_mean(tmp_path: Path) -> None:
    study = fe_contact.transfer(body("jankowski", k=1e7, xi=0.2), ("jankowski", "kelvin"), over={VELOCITY: (2.0,)})
    first, again = (plot_transfer(study, tmp_path / name) for name in ("first", "again"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]
    text = first[0].read_text(encoding="utf-8")
    assert text.count("(linear to 1)") == len(QUANTITIES)
    assert [text.count(f">{level} %<") for level in (10, 5, 1)] == [1, 1, 1]


# what is published


PUBLISHED = ("concrete-pole", "polymer-layer", "polymer-sphere", "rod-in-ring", "steel-ball-sls")


def published(name: str) -> tuple[dict[str, Any], list[dict[str, str]]]:
    """The packaged table of a scene: its record, and the rows of its CSV."""
    folder = data_folder() / "transfer" / name
    with (folder / "transfer.csv").open(encoding="utf-8", newline="") as file:
        return json.loads((folder / "transfer.json").read_text(encoding="utf-8")), list(csv.DictReader(file))


def test_published_tables_are_those_that_finite_elements_judged() -> None:
    """Every verdict follows from the numbers beside it, and from no others."""
    assert {path.name for path in (data_folder() / "transfer").iterdir()} == {*PUBLISHED, "datapackage.json"}
    for name in PUBLISHED:
        record, rows = published(name)
        assert (record["scene"], record["reference"]) == (name, "fe")
        assert all(state["converged"] for state in record["references"])
        assert {row["law"] for row in rows} == set(record["laws"]) == set(laws.available())
        assert len(rows) == len(record["laws"]) * len(record["references"]) * len(QUANTITIES)
        known = [row for row in rows if row["verdict"] != "refused" and row["predicted"] and row["reference"]]
        assert len({row["law"] for row in known}) > 10
        for row in known:
            predicted, reference, bar = (float(row[key]) for key in ("predicted", "reference", "reference_error"))
            off = predicted - reference
            assert bar < 2e-3 * max(abs(reference), 1.0 if row["quantity"] == "restitution" else 0.0)
            share = off if row["quantity"] == "restitution" else off / reference
            assert float(row["deviation"]) == pytest.approx(share, abs=1e-12)
            if row["verdict"] == "inside":
                assert abs(off) <= 1.01 * bar + 1e-5 * abs(reference)
            else:
                assert (abs(share) <= record["within"]) == (row["verdict"] == "within")


def test_the_package_describes_each_published_table_as_it_is() -> None:
    package = json.loads((data_folder() / "transfer" / "datapackage.json").read_text(encoding="utf-8"))
    assert package["licenses"]
    assert [one["path"] for one in package["resources"]] == [f"{name}/transfer.csv" for name in PUBLISHED]
    for one in package["resources"]:
        fields = {field["name"]: field["type"] for field in one["schema"]["fields"]}
        _, rows = published(one["name"])
        assert [*rows[0]] == [*fields]
        numbers = [name for name, kind in fields.items() if kind == "number"]
        assert all(np.isfinite(float(row[name])) for row in rows for name in numbers if row[name])


@pytest.mark.tenth
def test_a_published_row_is_found_again(campaign_size: Callable[..., int]) -> None:
    """A law and a state drawn by a seed: finite elements and the fit, anew."""
    generator = np.random.default_rng(1966)
    for name in generator.permutation(PUBLISHED)[: campaign_size(len(PUBLISHED), 1)].tolist():
        rows = [row for row in published(name)[1] if row["verdict"] != "refused"]
        drawn = rows[int(generator.integers(len(rows)))]
        again = fe_contact.transfer(Scene.load(name), (drawn["law"],), over={drawn["key"]: (float(drawn["value"]),)})
        found = of(again, drawn["law"], drawn["quantity"])[float(drawn["value"])]
        assert found.verdict.value == drawn["verdict"]
        bar = found.reference_error or 0.0
        assert found.reference == pytest.approx(float(drawn["reference"]), abs=bar)
        assert found.predicted == pytest.approx(float(drawn["predicted"]), abs=bar + 1e-4 * abs(found.predicted or 0.0))
