"""``fe-contact fit``: files that say what is printed, OpenSees lines, exit codes, one line a fault."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from matplotlib.figure import Figure

from fe_contact.cli import main
from fe_contact.commands.fit import EVERY
from fe_contact.studies import style
from fe_contact.studies.fit_chart import plot_fit, plot_ranking
from fe_contact.studies.identify_chart import plot_identified
from lumped import History, Scene, fit, identify, laws, simulate
from lumped.fit import Estimate
from lumped.fit.ranking import RankedFit
from lumped.result.curve_file import read_curve
from lumped.result.score import Curve

BODY = "[striker]\nmass = 0.001\nvelocity = 1.0\n"
LAW = '[law]\nname = "jankowski"\nk = 1e7\nxi = 0.2\n'
TRUTH = {"k": 1e7, "xi": 0.2}


@pytest.fixture(scope="module")
def body(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scene without a law and without geometry."""
    path = tmp_path_factory.mktemp("body") / "body.toml"
    path.write_text(BODY, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def curve(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """401 rows of a known law."""
    where = tmp_path_factory.mktemp("curve")
    path = where / "truth.toml"
    path.write_text(BODY + LAW, encoding="utf-8")
    scene = Scene.load(path)
    history = simulate(laws.get("jankowski").of(scene), scene, 1e-8).history
    time = np.linspace(0.0, 1.1 * history.time[-1], 401)
    table = np.column_stack([time, history.force_at(time)])
    np.savetxt(where / "curve.csv", table, delimiter=",", header="time_s,force_N", comments="", fmt="%.17g")
    return where / "curve.csv"


def test_the_files_say_what_is_printed(
    body: Path, curve: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    where = tmp_path / "out"
    command = ["fit", str(curve), "--law", "jankowski", "--scene", str(body), "--out", str(where), "--json", "--quiet"]
    assert main(command) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((where / "fit.json").read_text(encoding="utf-8"))
    assert printed["level"] == 0.95
    assert {name: one["value"] for name, one in printed["parameters"].items()} == pytest.approx(TRUTH, rel=1e-5)
    with (where / "parameters.csv").open(encoding="utf-8", newline="") as file:
        rows = {row["parameter"]: row for row in csv.DictReader(file)}
    assert {name: float(row["value"]) for name, row in rows.items()} == pytest.approx(TRUTH, rel=1e-5)
    assert rows["k"]["unit"] == "N/m^alpha"
    measured, fitted = read_curve(curve), History.read_csv(where / "fit.csv")
    left = np.linalg.norm(fitted.force_at(measured.time) - measured.force) / np.linalg.norm(measured.force)
    assert printed["normalized_error"] == pytest.approx(left, rel=0.01)  # its first row stands for half a step
    assert {path.name for path in where.iterdir()} == {"fit.json", "fit.csv", "parameters.csv", "fit.svg", "fit.png"}
    assert Scene.from_dict(printed["scene"]).law is not None


def test_a_person_reads_intervals(body: Path, curve: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["fit", str(curve), "--law", "jankowski", "--scene", str(body), "--out", str(tmp_path / "out")]
    assert main([*command, "--free", "k,alpha", "--fix", "xi=0.2", "--bounds", "alpha=1:2"]) == 0
    said = capsys.readouterr()
    lines = [line.split() for line in said.out.splitlines()]
    assert [line[0] for line in lines[1:4]] == ["k", "alpha", "xi"]
    assert str(Estimate(1.5, 1.4, None, "N")) == "1.5 (1.4 to open, 95 %) N"
    assert float(lines[2][1]) == pytest.approx(1.5, rel=1e-5)
    assert lines[3][1:] == ["0.2", "held"]
    assert "correlated" in said.err


@pytest.mark.tenth
def test_opensees_lines_are_a_file_of_their_own(
    body: Path, curve: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nothing but comments and the command, so that it can be redirected into one."""
    command = ["fit", str(curve), "--law", "jankowski", "--scene", str(body), "--out", str(tmp_path / "out")]
    assert main([*command, "--opensees"]) == 0
    *said, last = capsys.readouterr().out.splitlines()
    assert all(line.startswith("#") for line in said)
    name, tag, *values = last.split()[1:]
    assert (name, tag) == ("JankowskiImpact", "1")
    assert [float(value) for value in values] == pytest.approx([1e7, 0.2, 0.001, -1e-12, 1.5], rel=1e-5)
    assert main([*command, "--opensees", "python", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["opensees"][-1].startswith('ops.uniaxialMaterial("JankowskiImpact", 1')


def test_the_peak_is_held(body: Path, curve: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["fit", str(curve), "--law", "kelvin", "--scene", str(body), "--out", str(tmp_path / "out"), "--json"]
    assert main([*command, "--peak"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed["quantities"]["peak_force"]["value"] == pytest.approx(read_curve(curve).force.max(), rel=1e-6)


def test_the_chart_is_reproducible(body: Path, curve: Path, tmp_path: Path) -> None:
    measured = read_curve(curve)
    found = fit(measured, "jankowski", Scene(None, mass=0.001, velocity=1.0))
    for name in ("first", "again"):
        plot_fit(measured, found, tmp_path / name)
    first, again = (sorted((tmp_path / name).iterdir()) for name in ("first", "again"))
    assert len(first) == 2
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]


def test_what_is_left_has_one_sign_in_every_chart(curve: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The curve less the law: of one law, of all, and of an identification; the axis says so."""
    figures = dict[str, Figure]()
    monkeypatch.setattr(style, "save", lambda figure, where, name: figures.setdefault(name, figure))
    measured, found = read_curve(curve), fit(read_curve(curve), "kelvin", Scene(None, mass=0.001, velocity=1.0))
    left = measured.force - found.history.force_at(measured.time)
    plot_fit(measured, found, tmp_path)
    plot_ranking([RankedFit("kelvin", found, 0.0)], measured, tmp_path)
    sphere = Scene.load("polymer-sphere", {"target.material.C1": 1e4})
    drop, time = simulate(laws.get("ting").of(sphere), sphere).history, np.linspace(-0.01, 0.03, 200)
    known = identify({"drop": Curve(time, drop.force_at(time))}, "polymer-sphere", ["E1"])
    plot_identified(known, tmp_path)
    drawn = {
        "fit": (figures["fit"].axes[1].lines[-1], left),
        "fits": (figures["fits"].axes[0].lines[1], left),
        "identified": (figures["identified"].axes[1].lines[-1], known.curves[0].force - known.curves[0].fitted),
    }
    for name, (line, expected) in drawn.items():
        assert np.corrcoef(np.asarray(line.get_ydata(), dtype=float), expected)[0, 1] == pytest.approx(1.0), name
    assert all(figures[name].axes[1].get_ylabel() == "curve − law, %" for name in ("fit", "identified"))
    assert any("the curve less the law" in text.get_text() for text in figures["fits"].texts)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--law", "jankowsky"], "did you mean jankowski?"),
        (["--law", "jankovski", "--opensees"], "--law: 'jankovski' is not known"),
        (["--law", "jankovski", "--opensees"], "did you mean jankowski?"),
        (["--law", "tsuji", "--opensees"], "tsuji has no OpenSees material"),
        (["--law", "jankowski", "--opensees", "apdl"], "--opensees: 'apdl': accepted tcl, python"),
        (["--law", "jankowski", "--free", "k,xo"], "xo: unknown parameter"),
        (["--law", "jankowski", "--fix", "xi"], "--fix: xi: accepted: name=value"),
        (["--law", "jankowski", "--fix", "xi=much"], "--fix: 'much': accepted a number"),
        (["--law", "jankowski", "--bounds", "xi=1"], "--bounds: xi: '1': accepted low:high"),
        (["--law", "ting"], "striker.shape: missing"),
    ],
)
def test_bad_options_write_nothing(
    options: list[str], message: str, body: Path, curve: Path, refused: Callable[..., list[str]]
) -> None:
    assert message in refused("fit", str(curve), "--scene", str(body), *options)[0]


def test_bad_scenes_and_curves_write_nothing(
    body: Path, curve: Path, tmp_path: Path, refused: Callable[..., list[str]]
) -> None:
    heavy = tmp_path / "heavy.toml"
    heavy.write_text("[striker]\nmass = -1.0\nvelocity = 1.0\n", encoding="utf-8")
    faults = refused("fit", str(curve), "--scene", str(heavy), "--law", "hertz")
    assert "striker.mass: -1.0 is not accepted" in faults[0]
    (fault,) = refused("fit", str(tmp_path / "no.csv"), "--scene", str(body), "--law", "hertz")
    assert "cannot be read" in fault


def test_a_file_that_is_not_there_leads_to_its_nearest(
    curve: Path, body: Path, refused: Callable[..., list[str]]
) -> None:
    (line,) = refused("fit", str(curve.with_stem("jurve")), "--scene", str(body), "--law", "hertz")
    assert f"No such file or directory; did you mean {curve}?; accepted: a CSV file" in line
    (line,) = refused("fit", str(curve.with_name("curve.**")), "--scene", str(body), "--law", "hertz")
    assert "No such file or directory; accepted: a CSV file" in line


def test_what_is_not_reached_is_written_as_such(
    curve: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Relaxed steel alone peaks above the curve, and no ratio makes it softer."""
    where = tmp_path / "out"
    bodies = ["--scene", "steel-ball", "--set", "striker.mass=0.001", "--set", "striker.velocity=1.0"]
    options = [*bodies, "--free", "R1", "--fix", "R2=0.02", "--peak", "--out", str(where)]
    assert main(["fit", str(curve), "--law", "correspondence", *options]) == 3
    assert "no R1 gives the measured peak" in capsys.readouterr().err
    written = json.loads((where / "fit.json").read_text(encoding="utf-8"))
    assert (written["converged"], written["parameters"]) == (False, None)


class Told(NamedTuple):
    """Where a command line wrote by default, and what it printed."""

    where: Path
    printed: str


@pytest.fixture(scope="module")
def told_thrice(curve: Path, body: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Told]:
    """By law, the later of two: one law, every law, and the one again, told in one empty folder."""
    told = dict[str, Told]()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("thrice"))
        for law in ("jankowski", EVERY, "jankowski"):
            with redirect_stdout(StringIO()) as printed:
                assert main(["fit", str(curve), "--law", law, "--scene", str(body), "--json", "--quiet"]) == 0
            (record,) = Path().resolve().glob(f"fe-contact-out/*/{'fits' if law == EVERY else 'fit'}.json")
            told[law] = Told(record.parent, printed.getvalue())
    return told


@pytest.mark.tenth
def test_all_laws_are_ranked_the_true_one_first(told_thrice: dict[str, Told]) -> None:
    """Of a curve of Jankowski's law that law leaves nothing; what has no fit says why."""
    where, printed = told_thrice[EVERY]
    first, *others = json.loads(printed)["laws"]
    assert (first["law"], first["criterion"]) == ("jankowski", 0.0)
    assert first["parameters"]["xi"]["value"] == pytest.approx(0.2, rel=1e-5)
    fitted = [one for one in others if "criterion" in one]
    assert {one["law"] for one in [first, *others]} == set(laws.available())
    assert all(one["criterion"] > 10.0 for one in fitted)
    assert not any(one["left"]["noise"] for one in fitted)
    assert all(one["reason"] for one in others if "criterion" not in one)
    header, *rows = (where / "fits.csv").read_text(encoding="utf-8").splitlines()
    assert header.startswith("rank,law,normalized_error")
    assert len(rows) == len(laws.available())
    names = {f"fits.{kind}" for kind in ("json", "csv", "svg", "png")} | {"forces.csv"}
    assert {path.name for path in where.iterdir()} == names


@pytest.mark.tenth
def test_one_law_and_the_ranking_leave_each_other_s_files(told_thrice: dict[str, Told]) -> None:
    """Told by default into two folders: a folder holds one run."""
    one, every = told_thrice["jankowski"].where, told_thrice[EVERY].where
    assert {path.name for path in one.glob("*.csv")} == {"fit.csv", "parameters.csv"}
    assert {path.name for path in every.glob("*.csv")} == {"fits.csv", "forces.csv"}


def test_all_laws_have_their_own_parameters(curve: Path, body: Path, refused: Callable[..., list[str]]) -> None:
    faults = refused("fit", str(curve), "--law", "all", "--scene", str(body), "--free", "k", "--peak")
    said = "--peak: with --law all each law has its own; accepted: --free touch, --fix; cure: choose one law for --peak"
    assert any(said in one for one in faults)


@pytest.mark.tenth
def test_what_is_held_without_being_asked_is_said(
    body: Path, curve: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """And the force that nothing free changes has no interval."""
    command = ["fit", str(curve), "--law", "jankowski", "--scene", str(body), "--out", str(tmp_path / "out")]
    own = ["--set", "law.name=jankowski", "--set", "law.k=1e7", "--set", "law.xi=0.2"]
    assert main([*command, *own, "--free", "touch"]) == 0
    said = capsys.readouterr()
    assert "k, xi held as the scene has them; to find them too: --free touch,k,xi" in said.err
    assert " to " not in said.out.partition("force at")[2].partition(" N")[0]
    assert main([*command, "--free", "touch,k", "--fix", "xi=0.2"]) == 0
    assert "held as the scene" not in capsys.readouterr().err


@pytest.mark.family
@pytest.mark.parametrize(
    "law", ["jankowski", "kelvin", "hunt_crossley", pytest.param("impact_bilinear", marks=pytest.mark.full)]
)
def test_the_gap_of_the_scene_stays_in_every_line(
    law: str, curve: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It belongs to the bodies, and not to the law that the scene happens to name."""
    body = tmp_path / "gap.toml"
    body.write_text(BODY + LAW + "gap = 0.004\n", encoding="utf-8")
    out = ["--out", str(tmp_path / law), "--opensees"]
    assert main(["fit", str(curve), "--law", law, "--scene", str(body), *out]) == 0
    said = capsys.readouterr().out.splitlines()
    names = [line for line in said if line.startswith(f"# {law}: ")][-1].split()[4:]
    values = dict(zip(names, said[-1].split()[3:], strict=True))
    assert float(values["gap"]) == -0.004
