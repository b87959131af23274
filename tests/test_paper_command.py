"""`fe-contact paper`: a line a claim, files without NaN, figures, inputs that can be changed."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_contact.cli import main
from fe_contact.studies.validate.paper import FIGURES as FIGURES_OF_REPORT
from fe_contact.studies.validate.paper import LISTINGS
from lumped.materials.plasticity import first_yield
from lumped.paper import Examples, claims, recompute
from lumped.paper.claims import AGREES, DIFFERS, UNDECIDED, UNKNOWN, VERDICTS
from lumped.targets import base as yielding

TABLES = {"paper", "assumptions", "misprints", "grid"}
R2_OF_FIG7 = ("200 µs", "20 µs", "2 µs", "200 ns")
FIGURES = {f"fig{number}.{kind}" for number in (6, 7, 8, 9, 10, 15) for kind in ("svg", "png", "csv")}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The folder of one run, and what it printed."""
    where = tmp_path_factory.mktemp("paper") / "out"
    with pytest.MonkeyPatch.context() as patch:
        printed: list[str] = []
        patch.setattr("builtins.print", lambda *words, **_: printed.append(" ".join(map(str, words))))
        assert main(["paper", "--out", str(where)]) == 0
    return where, "\n".join(printed)


def content(where: Path) -> dict[str, Any]:
    def refuse(word: str) -> None:
        raise ValueError(word)

    found: dict[str, Any] = json.loads((where / "paper.json").read_text(encoding="utf-8"), parse_constant=refuse)
    return found


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_a_run_writes_tables_and_figures(written: tuple[Path, str]) -> None:
    names = {path.name for path in written[0].iterdir()}
    assert names == {f"{name}.csv" for name in TABLES} | {"paper.json"} | FIGURES


def test_every_claim_has_its_line_and_its_row(written: tuple[Path, str]) -> None:
    where, text = written
    lines = {line.split()[0]: line for line in text.splitlines() if line.strip()}
    table = {row["id"]: row for row in rows(where / "paper.csv")}
    for claim in claims.load():
        assert claim.quantity in lines[claim.id]
        assert table[claim.id]["verdict"] in lines[claim.id]
        assert claim.printed in lines[claim.id]
    assert list(table) == [claim.id for claim in claims.load()]
    assert len(rows(where / "assumptions.csv")) == len(claims.assumptions())
    assert len(rows(where / "misprints.csv")) == len(claims.misprints())


def test_the_counts_are_those_of_the_rows(written: tuple[Path, str]) -> None:
    where, text = written
    verdicts = [row["verdict"] for row in rows(where / "paper.csv")]
    known = content(where)["counts"]
    assert {verdict: verdicts.count(verdict) for verdict in VERDICTS}.items() <= known.items()
    assert sum(verdicts.count(verdict) for verdict in VERDICTS) == len(verdicts)
    judged = f"{known[AGREES]} agree, {known[DIFFERS]} differ, {known[UNDECIDED]} {UNDECIDED}"
    assert f"{judged}, {known[UNKNOWN]} {UNKNOWN}" in text


def test_a_row_says_printed_recomputed_and_deviation(written: tuple[Path, str]) -> None:
    row = next(row for row in rows(written[0] / "paper.csv") if row["id"] == "D10")
    assert (row["printed"], row["unit"], row["rule"], row["verdict"]) == ("80.3", "N", "digits", DIFFERS)
    assert float(row["recomputed"]) == pytest.approx(77.068, abs=5e-4)
    assert float(row["deviation"]) == pytest.approx(float(row["recomputed"]) / 80.3 - 1.0, rel=1e-12)
    assert 0.0 < float(row["error"]) < 1e-4


def test_the_grid_holds_both_laws(written: tuple[Path, str]) -> None:
    found = rows(written[0] / "grid.csv")
    assert [(row["figure"], row["panel"]) for row in found].count(("7", "a")) == 5
    assert len(found) == 40
    worst = next(row for row in found if (row["figure"], row["R1"], row["R2_s"]) == ("8", "5.0", "5e-06"))
    assert float(worst["correspondence_duration_s"]) == pytest.approx(9.917e-6, abs=5e-10)
    assert float(worst["ting_duration_s"]) == pytest.approx(11.459e-6, abs=5e-10)
    for row in found:
        assert float(row["ting_peak_force_N"]) == pytest.approx(float(row["correspondence_peak_force_N"]), rel=1e-5)
        assert float(row["ting_duration_s"]) > float(row["correspondence_duration_s"])


def test_the_curves_of_a_figure_stand_beside_it(written: tuple[Path, str]) -> None:
    """Kelvin's take the momentum m v (1 + e) from the ball, with the e that (7) gives where nothing pulls."""
    steel = Examples.load({}).steel
    found = rows(written[0] / "fig6.csv")
    assert {(row["panel"], row["x_is"], row["y_is"]) for row in found} == {("a", "time, µs", "force, N")}
    for e in steel.restitutions:
        kelvin, jankowski = (curve_of(found, f"{law}, e = {e:g}") for law in ("Kelvin", "Jankowski"))
        assert max(kelvin[1]) == pytest.approx(steel.measured_peak, rel=1e-4)
        assert max(jankowski[1]) == pytest.approx(steel.measured_peak, rel=1e-4)
        xi = -math.log(e) / math.hypot(math.pi, math.log(e))
        obtained = math.exp(-2.0 * xi * math.acos(xi) / math.sqrt(1.0 - xi**2))
        momentum = steel.mass * steel.velocity * (1.0 + obtained)
        assert 1e-6 * np.trapezoid(kelvin[1], kelvin[0]) == pytest.approx(momentum, rel=1e-4)
    shared = {(row["panel"], row["x_is"]) for row in rows(written[0] / "fig7.csv")}
    assert shared == {(f"{letter} R2 = {R2}", "time, µs") for letter, R2 in zip("abcd", R2_OF_FIG7, strict=True)}


def test_what_the_report_shows_is_there(written: tuple[Path, str]) -> None:
    names = {path.name for path in written[0].iterdir()}
    for figure in FIGURES_OF_REPORT:
        assert {f"{figure.name}.svg", *figure.tables} <= names
    for listing in LISTINGS:
        assert {column.key for column in listing.columns} <= rows(written[0] / listing.table)[0].keys()


def curve_of(found: list[dict[str, str]], name: str) -> tuple[list[float], list[float]]:
    """Its x and y."""
    mine = [row for row in found if row["curve"] == name]
    return [float(row["x"]) for row in mine], [float(row["y"]) for row in mine]


@pytest.mark.tenth
def test_a_changed_input_changes_what_depends_on_it(
    written: tuple[Path, str], tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out"
    monkeypatch.setattr("fe_contact.studies.paper_chart.plot_paper", lambda *_: ())  # figures follow from the claims
    assert main(["paper", "--set", "steel.density=8000", "--json", "--out", str(out)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == content(out)
    before, after = ({row["id"]: row for row in one["claims"]} for one in (content(written[0]), printed))
    moved = {name for name in before if before[name]["recomputed"] != after[name]["recomputed"]}
    assert {"D1", "D7", "D10", "E4"} <= moved
    assert moved.isdisjoint({"D5", "D9", "G1", "H4", "H12"})
    assert after["D10"]["recomputed"][0] == pytest.approx(77.068 * (8000 / 7850) ** 0.6, rel=1e-4)


@pytest.mark.parametrize("change", ["steel.density=heavy", "steel.weight=3", "density"])
def test_a_bad_change_is_refused_and_nothing_is_written(
    change: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(["paper", "--set", change, "--out", str(out)]) == 2
    assert "accepted" in capsys.readouterr().err
    assert not out.exists()


def test_a_fit_that_has_no_answer_is_a_named_failure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["paper", "--set", "steel.measured_peak=50", "--out", str(out)]) == 3
    assert "above the elastic peak" in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize(
    ("assumption", "scene", "method", "effect", "key"),
    [
        ("steel.strain", "steel-ball-sls", "correspondence", "finite strain", {}),
        ("steel.yield", "steel-ball", "hertz", "plasticity", {"target.material.yield_strength": "3e8"}),
        ("steel.inertia", "steel-ball", "hertz", "target inertia", {"target.material.density": "7850"}),
    ],
)
def test_run_and_paper_judge_one_sphere_by_one_ruler(
    assumption: str, scene: str, method: str, effect: str, key: dict[str, str], tmp_path: Path
) -> None:
    """The packaged ball is the paper's; waves are of one body where steel is as stiff as the equivalent one."""
    given = [f"--set={name}={value}" for name, value in {"model.profile": "parabola", **key}.items()]
    options = ["--quiet", f"--method={method}", "--tolerance=1e-6", f"--out={tmp_path}"]
    assert main(["run", scene, *options, *given]) in (0, 3)
    ledger = json.loads((tmp_path / "result.json").read_text(encoding="utf-8"))["model_ledger"]
    (entry,) = [one for one in ledger if one["effect"] == effect]
    (judged,) = [one for one in claims.assumptions() if one.id == assumption]
    same = Examples.load({"steel.young": 9.94455e10})
    values = [value.value for value in claims.judge_assumption(judged, same).values]
    if entry["spread"]:
        assert values == pytest.approx([0.0, max(map(abs, entry["spread"]))], rel=1e-5)
    else:
        assert values[0] == pytest.approx(entry["estimate"], rel=1e-5)
    allowed = judged.holds_below
    assert allowed == judged.fails_above, "no dead band, as for a tolerance"


def test_one_constant_says_when_steel_yields(monkeypatch: pytest.MonkeyPatch) -> None:
    """Doubled in the model ledger, it is doubled in the paper too."""

    def judged(strengths: list[float]) -> list[float]:
        values = recompute.get("assumptions.steel_yield")(Examples.load({"steel.yield_strength": strengths}))
        return [value.value for value in values]

    before = judged([3e8, 2e9])
    monkeypatch.setattr(yielding, "first_yield", lambda nu, plane=False: 2.0 * first_yield(nu, plane))
    assert judged([1.5e8, 1e9]) == pytest.approx(before, rel=1e-12)
    assert judged([3e8, 2e9]) != pytest.approx(before, rel=1e-3)
