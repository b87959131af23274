"""``fe-contact identify``: files that say what is printed, a scene that runs, exit codes, one line a fault."""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fe_contact import run
from fe_contact.cli import main
from fe_contact.commands.identify import shown as on_terminal
from fe_contact.studies.identify_chart import told as in_chart
from lumped import Scene, identify, laws, simulate
from lumped.identify import Interval
from lumped.result.history import History
from lumped.result.score import Curve

FREE = "target.material.E1,target.material.E2,target.material.C1"
TRUTH = {"E1": 1.8e6, "E2": 0.9e6, "C1": 1.8e4}
FAST = 0.1


@pytest.fixture(scope="module")
def curves(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Two impacts on polymer-sphere by the row of springs, as a logger writes them; the second one faster."""
    where, rng, paths = tmp_path_factory.mktemp("curves"), np.random.default_rng(1), []
    for velocity in (0.02, FAST):
        scene = Scene.load("polymer-sphere", {"striker.velocity": velocity})
        history = simulate(laws.get("mdr").of(scene), scene, 1e-4).history
        time = np.linspace(-0.5, 1.5, 300) * history.time[-1]
        force = history.force_at(time) + 0.005 * history.force.max() * rng.normal(size=time.size)
        paths.append(where / f"v{velocity:g}.csv")
        rows = [f"{1e3 * t + 3.0:.9g};{f:.9g}".replace(".", ",") for t, f in zip(time, force, strict=True)]
        paths[-1].write_text("t [ms];F [N]\n" + "\n".join(rows), encoding="utf-8")
    return paths[0], paths[1]


@pytest.mark.tenth
@pytest.mark.parametrize("keys", [("E1", "C1"), pytest.param(tuple(TRUTH), marks=pytest.mark.full)])
def test_two_curves_tell_the_polymer(
    keys: Sequence[str], curves: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    slow, fast = curves
    free = ",".join(f"target.material.{key}" for key in keys)
    where, scene = tmp_path / "out", tmp_path / "found.toml"
    line = ["identify", str(slow), f"{fast}:striker.velocity={FAST}", "--scene", "polymer-sphere", "--free", free]
    assert main([*line, "--each", "--json", "--out", str(where), "--write", str(scene)]) == 0
    said = capsys.readouterr()
    printed = json.loads(said.out)
    assert printed == json.loads((where / "identified.json").read_text(encoding="utf-8"))
    for key in keys:
        one = printed["parameters"][f"target.material.{key}"]
        assert one["low"] < one["value"] < one["high"]
        assert abs(one["value"] / TRUTH[key] - 1.0) < 0.1
        assert (one["level"], one["unit"]) == (0.9, "Pa s" if key == "C1" else "Pa")
    assert printed["model"]["adequate"]
    assert printed["onset_s"] == pytest.approx([0.003, 0.003], abs=2e-4)
    assert [one["share_of_peak"] for one in printed["noise"]] == pytest.approx([0.005] * 2, rel=0.2)
    assert set(printed["each"]) == {str(slow), str(fast)}
    *read, left_out = said.err.splitlines()
    assert len(read) == 2, "how each file was read, in one line"
    assert left_out.startswith("fe-contact: left out, up to so much of the peak force: finite strain (")
    with (where / "identified.csv").open(encoding="utf-8", newline="") as file:
        assert sum(1 for _ in csv.DictReader(file)) == 600
    found = Scene.load(scene)
    assert found.name == "found", "called as its file is: its results go beside those of the first guess"
    assert main(["run", str(scene), "--method", "ting", "--out", str(tmp_path / "run"), "--quiet"]) == 0
    assert {path.name for path in where.iterdir()} == {f"identified.{kind}" for kind in ("json", "csv", "svg", "png")}


@pytest.mark.parametrize("half", [3e-7, 2e-4, 0.1])
def test_the_ends_of_an_interval_are_told_from_the_value(half: float) -> None:
    """However narrow it is, on the terminal and in the chart."""
    one = Interval(1.2345678e6, 1.2345678e6 * (1.0 - half), 1.2345678e6 * (1.0 + half), 0.9, "Pa")
    for said in (on_terminal(one), in_chart(one, False)):
        value, low, high = (float(number) for number in re.findall(r"\d+\.?\d*(?:e[+-]\d+)?(?! %)\b", said)[:3])
        assert low < value < high, said


def test_a_person_reads_intervals(
    curves: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The relaxation held at another time than the truth's: what is left says so, first of all in the scene written."""
    written = tmp_path / "found.toml"
    line = ["identify", str(curves[0]), "--scene", "polymer-sphere", "--set", "target.material.C1=1e6"]
    assert (
        main([*line, "--free", "target.material.E1,touch", "--out", str(tmp_path / "out"), "--write", str(written)])
        == 0
    )
    said = capsys.readouterr()
    assert "with these values, which are not to be trusted: " in said.out
    first = written.read_text(encoding="utf-8").partition("\n")[0]
    assert first.startswith("# not to be trusted: the law does not explain the curves (Ljung-Box, p = ")
    assert "target.material.E1 " in said.out
    assert "90 %" in said.out
    assert "the law does not explain the curves" in said.out
    assert "not to be trusted" in said.err


@pytest.mark.tenth
def test_finite_elements_correct_the_law(
    curves: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """On the half-space Ting's law is exact: elements move nothing by more than their own bars could."""
    where = tmp_path / "out"
    line = ["identify", str(curves[0]), "--scene", "polymer-sphere", "--free", "E1"]
    assert main([*line, "--method", "fe", "--out", str(where)]) == 0
    said, content = capsys.readouterr(), json.loads((where / "identified.json").read_text(encoding="utf-8"))
    (one,) = content["by_reference"]["parameters"].values()
    assert content["by_reference"]["runs"] == 2
    assert content["by_reference"]["error"] < 1e-3
    assert 0.0 < abs(one["value"] - one["by_law"]) < one["bar"]
    assert "E1: " in said.out
    assert "moved by" in said.out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--free", "target.material.E3"], "--free: target.material.E3: no number of polymer-sphere.toml; accepted: "),
        (["--free", FREE, "--write", "found.json"], "--write: found.json: accepted: a file that ends with .toml"),
        (["--free", FREE, "--sample", "7"], "--sample: 7: accepted a whole number from 100 to 1000000"),
        (["--free", FREE, "--method", "feme"], "--method: feme: accepted ting, fe"),
        (["--free", f"{FREE},nu"], "--free: the force of this scene tells only a combination of target.material."),
        (["--free", FREE, "--tolerance", "5"], "--tolerance: 5.0: accepted a number from 1e-06 to 0.1"),
        (["--free", FREE, "--corner", "-3"], "--corner: -3: accepted a frequency above zero, Hz"),
        (["--free", FREE, "--set", "striker.mass=0.5"], "< 0; cure: check mass"),
        (["--free", FREE, "--set", "striker.mas=50.0"], "striker.mas: unknown key"),
    ],
)
def test_bad_options_write_nothing(
    options: list[str], message: str, curves: tuple[Path, Path], refused: Callable[..., list[str]]
) -> None:
    (fault,) = refused("identify", str(curves[0]), "--scene", "polymer-sphere", *options)
    assert message in fault


@pytest.mark.parametrize("own", ["foo=1", "striker.foo=1"])
def test_a_key_of_one_curve_that_is_none_is_named(
    own: str, curves: tuple[Path, Path], refused: Callable[..., list[str]]
) -> None:
    (fault,) = refused("identify", f"{curves[0]}:{own}", "--scene", "polymer-sphere", "--free", FREE)
    assert f"{own.partition('=')[0]}: unknown key" in fault


def test_every_bad_curve_is_told(tmp_path: Path, refused: Callable[..., list[str]]) -> None:
    bad = [tmp_path / "silent.csv", tmp_path / "short.csv"]
    bad[0].write_text("time_s,force_N\n" + "".join(f"{0.001 * row},0.0\n" for row in range(20)), "utf-8")
    bad[1].write_text("time_s,force_N\n0.0,1.0\n", "utf-8")
    faults = refused("identify", *map(str, bad), "--scene", "polymer-sphere", "--free", FREE)
    assert [next(path.name for path in bad if path.name in fault) for fault in faults] == ["silent.csv", "short.csv"]


@pytest.mark.tenth
def test_a_curve_s_path_may_look_like_keys_of_its_own(curves: tuple[Path, Path], empty: Path) -> None:
    named = empty / "drop:mass=0.05.csv"
    named.write_bytes(curves[0].read_bytes())
    assert main(["identify", named.name, "--scene", "polymer-sphere", "--free", "target.material.E1"]) == 0


@cache
def reference(name: str) -> History:
    """The impact of a packaged scene by finite elements."""
    return run(Scene.load(name), tolerance=1e-3).history


@pytest.mark.tenth
@pytest.mark.parametrize(
    ("name", "free"),
    [
        ("polymer-layer", ("E1", "C1")),
        ("rod-in-ring", ("E2", "C1")),
        pytest.param("polymer-layer", tuple(TRUTH), marks=pytest.mark.full),
        pytest.param("rod-in-ring", tuple(TRUTH), marks=pytest.mark.full),
    ],
)
def test_a_finite_element_impact_tells_its_material(name: str, free: Sequence[str]) -> None:
    """A mesh and steps of time on one side, the layer's or ring's own load curve and Ting's law on the other.

    Without noise what is left is the reference's own error, well inside its bar; the glassy spring is told best.
    """
    history = reference(name)
    time = np.linspace(-0.3, 1.5, 500) * history.time[-1]
    curve = Curve(time + 7.0, history.force_at(time))
    found = identify({"reference": curve}, name, [f"target.material.{key}" for key in free])
    for key in free:
        assert abs(found.parameters[f"target.material.{key}"].value / TRUTH[key] - 1.0) < 3e-3
    assert found.curves[0].error < 1e-3
    assert found.curves[0].touch == pytest.approx(7.0, abs=1e-3 * history.time[-1])


@pytest.mark.tenth
@pytest.mark.parametrize("others", [("E1",), pytest.param(tuple(TRUTH), marks=pytest.mark.full)])
def test_a_layer_tells_poisson_s_ratio(others: Sequence[str]) -> None:
    """Bonded to its base it cannot give way sideways, which a half-space can: there E and nu are one number."""
    history = reference("polymer-layer")
    time = np.linspace(-0.3, 1.5, 500) * history.time[-1]
    noise = 0.01 * history.force.max() * np.random.default_rng(2).normal(size=time.size)
    free = [f"target.material.{key}" for key in (*others, "nu")]
    found = identify({"reference": Curve(time, history.force_at(time) + noise)}, "polymer-layer", free)
    one = found.parameters["target.material.nu"]
    assert one.low is not None
    assert one.high is not None
    assert one.low < 0.45 < one.high
    assert one.high - one.low < 0.1
