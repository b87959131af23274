"""The comparison: pressures that belong to their forces, verdicts that follow from the error bars, files."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

import fe_contact
from fe_contact.cli import main
from fe_contact.commands.compare import law_names
from fe_contact.reference import Solved, result_of, solve
from fe_contact.studies.compare import study
from fe_contact.studies.compare.chart import _time_axis, plot_comparison
from fe_contact.studies.compare.deviations import Told, rebound_steps
from fe_contact.studies.compare.law_pressure import LawPressure
from fe_contact.studies.compare.study import WITHIN, Comparison, Judgement, compare, verdicts
from lumped import laws, simulate
from lumped.errors import BadInput
from lumped.result.result import Result
from lumped.result.score import Curve as Measured
from lumped.scene.scene import Scene
from lumped.scene.tables import LawChoice
from lumped.schema.csv_file import write_columns

MATERIALS: dict[str, dict[str, Any]] = {
    "sls": {},
    "kelvin-voigt": {"target.material": {"law": "kelvin_voigt", "E": 1e6, "eta": 2e3, "nu": 0.4}},
}


OF_GEOMETRY = ("hertz", "correspondence", "ting", "mdr")  # laws that take all they need from shape and material


@pytest.fixture(scope="module")
def polymer() -> tuple[Solved, Result]:
    scene = Scene.load("polymer-sphere")
    solved = solve(scene, {})
    return solved, result_of(scene, solved)


@pytest.fixture(scope="module")
def compared(polymer: tuple[Solved, Result]) -> Comparison:
    return compare(*polymer, OF_GEOMETRY)


def judgement(comparison: Comparison, name: str) -> Judgement:
    return next(j for j in comparison.judgements if j.name == name)


@pytest.mark.family
@pytest.mark.parametrize("material", ["sls", pytest.param("kelvin-voigt", marks=pytest.mark.full)])
@pytest.mark.parametrize("name", OF_GEOMETRY)
def test_the_pressure_of_a_law_adds_up_to_its_force(name: str, material: str) -> None:
    scene = Scene.load("polymer-sphere", MATERIALS[material])
    result = simulate(laws.get(name).of(scene), scene)
    pressure, history = LawPressure.of(result), result.history
    assert pressure is not None
    for share in (0.1, 0.3, 0.6, 0.9):
        time = float(share * history.time[-1])
        edge = float(np.interp(time, history.time, history.contact_radius))
        force = integral(pressure, time, 0.0, edge) + integral(pressure, time, edge, history.contact_radius.max())
        assert force == pytest.approx(float(history.force_at(time)), abs=2e-3 * history.force.max())


def integral(pressure: LawPressure, time: float, inner: float, outer: float) -> float:
    """Over a ring of the surface, N; in s = sqrt(outer^2 - r^2) a singularity at its outer edge is none."""
    longest = np.sqrt(outer**2 - inner**2)
    s = longest * (np.arange(400) + 0.5) / 400
    return float(2 * np.pi * s @ pressure.at(time, np.sqrt(outer**2 - s**2)) * longest / 400)


@pytest.mark.family
@pytest.mark.parametrize("material", MATERIALS)
def test_the_clipped_law_pulls_in_the_rebound_and_the_exact_ones_never(material: str) -> None:
    scene = Scene.load("polymer-sphere", MATERIALS[material])
    lowest = {}
    for name in ("correspondence", "ting", "mdr"):
        result = simulate(laws.get(name).of(scene), scene)
        pressure = LawPressure.of(result)
        assert pressure is not None
        radii = np.linspace(0.0, result.history.contact_radius.max(), 200)
        values = pressure.at(0.85 * float(result.history.time[-1]), radii)
        lowest[name] = values.min() / values.max()
    assert lowest["correspondence"] < -0.1
    assert min(lowest["ting"], lowest["mdr"]) > -1e-3


def test_a_law_without_a_pressure_has_none(compared: Comparison) -> None:
    assert LawPressure.of(replace(compared.laws["hertz"], method="jankowski")) is None


def test_the_exact_laws_lie_within_the_reference_and_agree_in_radius_and_pressure(compared: Comparison) -> None:
    assert f"ting, mdr: {WITHIN}" in verdicts(compared)
    for name in ("ting", "mdr"):
        errors = judgement(compared, name).errors
        assert (errors["contact_radius_rebound"] or 0.0) < 5e-3
        assert (errors["pressure_rebound"] or 0.0) < 0.02


def test_correspondence_holds_until_maximum_depth_and_then_ends_too_early(compared: Comparison) -> None:
    """Lee and Radok's solution holds while the contact grows; later its negative pressure takes force away."""
    found = judgement(compared, "correspondence")
    assert not found.exceeds("held_until_max_depth")
    assert not found.exceeds("peak_force")
    assert (found.errors["duration"] or 0.0) < -0.01
    assert (found.errors["restitution"] or 0.0) < -0.001
    (line,) = (text for text in verdicts(compared) if text.startswith("correspondence"))
    assert "holds until maximum depth" in line
    assert "too early" in line
    assert "too low" in line


def test_an_elastic_paraboloid_leaves_no_law_outside_the_bar() -> None:
    scene = Scene.load("steel-ball", {"model.profile": "parabola"})
    solved = solve(scene, {})
    comparison = compare(solved, result_of(scene, solved), OF_GEOMETRY)
    laws, areas = verdicts(comparison)
    assert laws == f"{', '.join(OF_GEOMETRY)}: {WITHIN}"
    assert areas.startswith("areas of contact nest as Ting supposes")


def test_the_reference_measured_is_within_its_own_bar(polymer: tuple[Solved, Result]) -> None:
    history = polymer[1].history
    comparison = compare(*polymer, (), Measured(history.time, history.force))
    assert comparison.judgements[0].score_percent == pytest.approx(0.0, abs=1e-9)
    assert comparison.judgements[0].errors["restitution"] is None
    assert verdicts(comparison)[0] == "the reference agrees with the measured curve within its error bar"


@pytest.mark.family
@pytest.mark.parametrize("rows", [300, 3000])
@pytest.mark.parametrize("noise", [0.02, 0.002, 0.005, 0.05])
def test_noise_is_no_deviation(polymer: tuple[Solved, Result], noise: float, rows: int) -> None:
    """The reference with noise, and silence around it, short or long: of ten records no verdict finds anything."""
    history = polymer[1].history
    for seed in range(10):
        time = np.linspace(-0.5, 1.6 + 3.0 * (seed % 3), rows) * float(history.time[-1])
        shaken = noise * history.force.max() * np.random.default_rng(seed).normal(size=rows)
        comparison = compare(*polymer, (), Measured(time, history.force_at(time) + shaken))
        said = re.fullmatch(
            r"the reference agrees with the measured curve within its error bar and the noise, (\S+) % of the peak",
            verdicts(comparison)[0],
        )
        assert said is not None, (seed, verdicts(comparison)[0])
        assert float(said[1]) == pytest.approx(100.0 * noise, rel=0.3)


@pytest.mark.parametrize("rows", [8, 15, 40])
def test_few_rows_are_no_noise_and_hide_no_deviation(polymer: tuple[Solved, Result], rows: int) -> None:
    history = polymer[1].history
    time = np.linspace(0.0, 1.2, rows) * float(history.time[-1])
    (alike, *_), (higher, *_) = (
        verdicts(compare(*polymer, (), Measured(time, factor * history.force_at(time)))) for factor in (1.0, 1.08)
    )
    assert alike == "the reference agrees with the measured curve within its error bar"
    found = re.search(r"the measured peak is (\S+) % higher", higher)
    assert found is not None
    assert float(found[1]) == pytest.approx(8.0, abs=0.4)


def test_coloured_noise_and_a_record_that_ends_early_are_no_deviation(polymer: tuple[Solved, Result]) -> None:
    history = polymer[1].history
    time = np.linspace(-0.7, 1.9, 800) * float(history.time[-1])
    slow = np.convolve(np.random.default_rng(1).normal(size=time.size), np.ones(8), mode="same")
    shaken = history.force_at(time) + 0.02 * history.force.max() * slow / slow.std()
    early = time < 0.6 * float(history.time[-1])
    noise = 0.01 * history.force.max() * np.random.default_rng(2).normal(size=int(early.sum()))
    for record in (
        Measured(time, shaken),
        Measured(time[early], history.force_at(time[early])),
        Measured(time[early], history.force_at(time[early]) + noise),
    ):
        assert verdicts(compare(*polymer, (), record))[0].startswith("the reference agrees with the measured curve")


@pytest.mark.parametrize("force", [0.0, -1.0])
def test_a_curve_without_a_contact_is_judged(polymer: tuple[Solved, Result], force: float) -> None:
    time = np.linspace(0.0, float(polymer[1].history.time[-1]), 50)
    (said, *_) = verdicts(compare(*polymer, (), Measured(time, np.full(50, force))))
    assert re.search(r"the measured peak is \S+ % lower", said)


def test_a_record_that_begins_after_the_contact_does_not_agree(polymer: tuple[Solved, Result]) -> None:
    history = polymer[1].history
    late = Measured(history.time + 5.0 * float(history.time[-1]), history.force)
    assert "differs from the measured curve by up to 100 % of the peak" in verdicts(compare(*polymer, (), late))[0]


def test_a_curve_on_another_scale_is_judged(polymer: tuple[Solved, Result]) -> None:
    """Far higher than the reference, whose whole force lies below its tenth."""
    history = polymer[1].history
    time = np.linspace(-0.5, 1.6, 600) * float(history.time[-1])
    noise = 0.12 * history.force.max() * np.random.default_rng(2).normal(size=time.size)
    (said, *_) = verdicts(compare(*polymer, (), Measured(time, 12.0 * history.force_at(time) + noise)))
    found = re.search(r"the measured peak is (\S+) % higher, beyond the noise", said)
    assert found is not None
    assert float(found[1]) == pytest.approx(1100.0, rel=0.02)


@pytest.mark.parametrize(("stretch", "phrase"), [(1.15, "longer"), (0.85, "shorter")])
def test_a_deviation_is_found_beneath_the_noise(polymer: tuple[Solved, Result], stretch: float, phrase: str) -> None:
    history = polymer[1].history
    time = np.linspace(-0.5, 1.6, 600) * float(history.time[-1])
    shaken = 0.02 * history.force.max() * np.random.default_rng(1).normal(size=time.size)
    (said, *_) = verdicts(compare(*polymer, (), Measured(time, history.force_at(time / stretch) + shaken)))
    found = re.search(rf"the measured contact is (\S+) % {phrase}, beyond the noise, (?:1\.9|2\S*) % of the peak", said)
    assert found is not None
    assert float(found[1]) == pytest.approx(15.0, abs=3.0)


def test_a_law_that_ends_far_later_leaves_the_reference_readable(polymer: tuple[Solved, Result]) -> None:
    """A spring far too soft."""
    solved, result = polymer
    soft = LawChoice("kelvin", {"k": 1.0, "xi": 0.1})
    comparison = compare(solved, replace(result, scene=replace(result.scene, law=soft)), ("kelvin",))
    assert ", ends far later" in verdicts(comparison)[0]
    figure, axes = plt.subplots()
    _, span = _time_axis(axes, comparison)
    assert span == pytest.approx(3.0 * result.history.time[-1])
    assert "cut at 3 contact times" in axes.get_xlabel()
    plt.close(figure)


@pytest.mark.parametrize(
    ("factor", "phrase"), [(1.05, "the measured peak is 5 % higher"), (0.95, "the measured peak is 5 % lower")]
)
def test_a_scaled_measurement_is_called_so(polymer: tuple[Solved, Result], factor: float, phrase: str) -> None:
    history = polymer[1].history
    comparison = compare(*polymer, (), Measured(history.time, factor * history.force))
    assert comparison.judgements[0].score_percent == pytest.approx(5.0, rel=1e-6)
    assert verdicts(comparison)[0].startswith("the reference differs from the measured curve by up to 5 % of the peak")
    assert phrase in verdicts(comparison)[0]


def test_the_instants_of_the_rebound_lie_after_maximum_depth(polymer: tuple[Solved, Result]) -> None:
    solved, result = polymer
    times = [solved.certified.march.snapshots[step].time for step in rebound_steps(solved)]
    turn = Told.by(solved).deepest
    velocity = np.interp(turn, result.history.time, result.history.velocity)
    assert velocity == pytest.approx(0.0, abs=0.02 * result.scene.velocity)
    assert len(times) == 3
    assert np.all(np.diff([turn, *times]) > 0)
    assert result.history.force_at(times) / result.history.force_at(turn) == pytest.approx([0.75, 0.5, 0.25], abs=0.1)


def test_a_law_without_an_answer_is_told_and_the_others_go_on(tmp_path: Path) -> None:
    """A fluid has no relaxed modulus for Hertz."""
    maxwell = {"law": "maxwell", "E": 6e5, "eta": 6e3, "nu": 0.45}
    scene = Scene.load("polymer-sphere", {"target.material": maxwell})
    solved = solve(scene, {"tolerance": 0.01})
    comparison = compare(solved, result_of(scene, solved), OF_GEOMETRY)
    assert set(comparison.refused) == {"hertz"}
    assert set(comparison.laws) == set(OF_GEOMETRY) - {"hertz"}
    assert any(line.startswith("hertz: no answer: ") for line in verdicts(comparison))


@pytest.mark.tenth
def test_the_chart_is_reproducible(tmp_path: Path, compared: Comparison) -> None:
    first, again = (plot_comparison(compared, tmp_path / name) for name in ("first", "again"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]


@pytest.mark.tenth
def test_the_command_writes_what_it_prints(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    chosen = ["--laws", "ting,correspondence,ting", "--json", "--quiet", "--out", str(tmp_path)]
    assert main(["compare", "polymer-sphere", *chosen]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))
    with (tmp_path / "scores.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["law"] for row in rows] == ["ting", "correspondence"] == list(printed["candidates"])
    for row in rows:
        candidate = printed["candidates"][row["law"]]
        assert float(row["score_percent"]) == candidate["score_percent"]
        assert float(row["duration_error"]) == candidate["errors"]["duration"]
        assert row["nested_areas"] == str(printed["nested_areas"]["holds"])
    written = {path.name for path in tmp_path.iterdir()}
    assert {"history.csv", "result.json", "ting-history.csv", "compare.svg", "compare.png"} <= written


def test_larger_models_are_measured_beside_the_laws_where_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """As `plan` measures them; the record holds them."""
    chosen = ["polymer-sphere", "--tolerance", "0.03", "--measure"]
    assert main(["compare", *chosen, "--laws", "hertz", "--out", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert main(["plan", *chosen, "--json"]) == 0
    (planned,) = json.loads(capsys.readouterr().out)["measured"]
    assert "finite strain (model.kinematics=finite): estimate" in told
    assert "by what was measured, bars added, this model is good to" in told
    (found,) = json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))["larger_models"]
    assert found["effect"] == planned["effect"] == "finite strain"
    assert found["change"] == pytest.approx(planned["change"], abs=found["error"])


def test_every_unknown_law_is_named_with_the_nearest(refused: Callable[..., list[str]]) -> None:
    faults = refused("compare", "polymer-sphere", "--laws", "tong,hertz,corespondence")
    assert [fault.rpartition("did you mean ")[2] for fault in faults] == ["ting?", "correspondence?"]


@pytest.mark.parametrize(
    ("scene", "laws", "said"),
    [
        ("ball-bouncing", ["ting"], "motion.impacts: 4: compare follows one"),
        ("polymer-sphere", ["tong"], "'tong' is not"),
    ],
)
def test_python_refuses_what_the_command_does(
    scene: str, laws: list[str], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before the reference is solved, which takes a while."""
    monkeypatch.setattr(study, "answered", lambda *_: pytest.fail("solved all the same"))
    with pytest.raises(BadInput, match=said):
        fe_contact.compare(scene, laws)


def test_a_refusal_names_the_key() -> None:
    """The value alone would say nothing."""
    bar = Scene.load("bar-impact", {"striker.mass": 0.05})
    with pytest.raises(BadInput) as refused:
        simulate(laws.get("bar_waves").of(bar), bar)
    assert study._reason("bar_waves", refused.value).startswith("no answer: striker.mass: 0.05: ")


def test_no_law_named_is_a_fault() -> None:
    with pytest.raises(BadInput):
        law_names("")


def test_an_unreadable_measurement_writes_nothing(tmp_path: Path, refused: Callable[..., list[str]]) -> None:
    curve = tmp_path / "curve.csv"
    curve.write_text("time_s,push\n0,1\n1,2\n", encoding="utf-8")
    assert "force_N" in refused("compare", "polymer-sphere", "--measured", str(curve))[0]


@pytest.mark.tenth
def test_the_clock_of_a_measured_curve_is_told_by_its_touch(
    tmp_path: Path, empty: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A pre-trigger of a contact's length: refused, and with --touch judged as the same curve from touch on."""
    scene, wait = Scene.load("polymer-sphere"), 0.0625
    history = simulate(laws.get("ting").of(scene), scene).history
    time = np.linspace(-0.02, 1.3 * history.time[-1], 800)
    early, late = tmp_path / "early.csv", tmp_path / "late.csv"
    for path, start in ((early, 0.0), (late, wait)):
        write_columns(path, ("time_s", "force_N"), (time + start, history.force_at(time)))
    command = ["compare", "polymer-sphere", "--laws", "ting", "--tolerance", "1e-2", "--json", "--measured"]
    assert main([*command, str(late)]) == 2
    assert "compare --touch" in capsys.readouterr().err
    assert main([*command, str(early)]) == 0
    assert main([*command, str(late), "--touch", f"{wait}"]) == 0
    first, again = map(json.loads, capsys.readouterr().out.splitlines())
    assert first["verdict"] == again["verdict"]
    assert main(["compare", "polymer-sphere", "--touch", "0.1"]) == 2
    assert "--touch: '0.1': accepted a time on the clock of --measured" in capsys.readouterr().err
    assert main([*command, str(tmp_path / "late.csv"), "--touch", "100"]) == 2
    assert "--touch: 100 s is not in " in capsys.readouterr().err
