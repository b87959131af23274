"""What is published: histories that a run of today repeats within both bars, in a package that others can read."""

from __future__ import annotations

import csv
import json
import math
import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest

from fe_contact.cli import main
from fe_contact.studies import references
from fe_contact.studies.references import Reference, folder, moves, renewed
from lumped import Scene, laws, simulate
from lumped.result.history import COLUMNS, History
from lumped.result.result import Quantity, Result
from lumped.schema.files import SCENES

MOST_BYTES = 5_000_000
LONG = {name for name in SCENES.names if name.endswith(("-waves", "-plastic", "-finite"))}  # of a tenth of all tests
PUBLISHED = sorted(SCENES.names)


@pytest.fixture(scope="module")
def package() -> dict[str, object]:
    content: dict[str, object] = json.loads((folder() / "datapackage.json").read_text(encoding="utf-8"))
    return content


def test_every_scene_is_published_and_nothing_else(package: dict[str, object]) -> None:
    resources = package["resources"]
    assert isinstance(resources, list)
    assert [one["name"] for one in resources] == PUBLISHED
    assert package["licenses"]
    files = {path.name for path in folder().iterdir() if not path.name.startswith(".")}
    assert files == {"datapackage.json", "references.json"} | {
        f"{n}.{end}" for n in PUBLISHED for end in ("csv", "json")
    }
    assert sum(path.stat().st_size for path in folder().iterdir()) < MOST_BYTES


def test_the_package_describes_each_table_as_it_is(package: dict[str, object]) -> None:
    resources = package["resources"]
    assert isinstance(resources, list)
    for one in resources:
        with (folder() / one["path"]).open(encoding="utf-8", newline="") as file:
            rows = csv.reader(file)
            assert next(rows) == [field["name"] for field in one["schema"]["fields"]] == [*COLUMNS.values()]
            assert all(math.isfinite(float(cell)) for row in rows for cell in row)
        units = {field["name"]: field["unit"] for field in one["schema"]["fields"]}
        assert units["velocity_m_per_s"] == "m/s"
        assert units["force_error_N"] == units["force_N"] == "N"


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_published_history_tells_its_own_quantities(name: str) -> None:
    """Impulse and peak force again from the rows of the CSV, by a route that knows no result."""
    found = Reference.read(folder(), name)
    assert found is not None
    rows, said = found.history, found.quantities
    allowed = 2e-3 * rows.force.max()  # what straight lines between rows may miss
    assert rows.force.max() == pytest.approx(said["peak_force"].value, abs=allowed + (said["peak_force"].error or 0.0))
    contacts = Scene.load(name).motion.impacts
    first = rows.time <= (said["duration"].value or math.inf) if contacts > 1 else rows.time >= 0.0
    impulse = float(np.trapezoid(rows.force[first], rows.time[first]))
    assert impulse == pytest.approx(said["impulse"].value, rel=5e-3) or contacts > 1


@pytest.mark.tenth
def test_a_scene_is_answered_with_the_settings_of_its_file() -> None:
    """The jumps of a bar that bounces miss the default tolerance, as their norm falls with the root of the step."""
    (one,) = renewed(["bar"], folder())
    assert one.result is not None, one.reason
    assert one.result.tolerance == 0.1


def test_a_run_of_today_agrees_with_what_is_published(campaign_size: Callable[[int], int]) -> None:
    random = np.random.default_rng(20161015)
    names = [str(name) for name in random.permutation(sorted({*PUBLISHED} - LONG))][: campaign_size(len(PUBLISHED))]
    for one in renewed(names, folder()):
        assert one.result is not None, one.line
        assert one.agrees, one.line


@pytest.mark.parametrize("name", PUBLISHED)
def test_a_published_history_says_what_made_it(name: str) -> None:
    """Versions of all that computes, and the imprint of each mesh; laws, bars and rods have none."""
    found = Reference.read(folder(), name)
    assert found is not None
    made, scene = found.content["provenance"], found.content["scene"]
    assert all(made[package][0].isdigit() for package in ("fe-contact", "numpy", "scipy", "scikit-fem", "gmsh"))
    known = [mesh["sha256"] for mesh in made["meshes"]]
    assert len({*known}) == len(known)
    assert all(re.fullmatch("[0-9a-f]{64}", one) for one in known)
    if scene.get("target", {}).get("shape") != "plane":
        meshed = found.content["method"] == "fe" and scene["target"]["shape"] != "rod"
        assert bool(known) is meshed


def test_a_scene_is_meshed_alike_each_time_and_as_published_where_all_else_is_the_same() -> None:
    published = Reference.read(folder(), "steel-ball")
    assert published is not None
    first, again = renewed(["steel-ball", "steel-ball"], folder())
    assert first.result is not None
    assert first.meshes
    assert first.meshes == again.meshes
    known = published.content["provenance"]
    if first.result.provenance == {key: known[key] for key in first.result.provenance}:
        assert [vars(mesh) for mesh in first.meshes] == known["meshes"]


@pytest.fixture(scope="module")
def result() -> Result:
    scene = Scene.load("steel-ball")
    return simulate(laws.get("hertz").of(scene), scene, 1e-6)


def published_of(result: Result, **changed: Quantity) -> Reference:
    return Reference(result.history, {**result.quantities, **changed})


def test_what_moved_by_more_than_both_bars_is_found(result: Result) -> None:
    peak = result.quantities["peak_force"].value or 0.0
    for times, agrees in ((0.75, True), (1.25, False)):
        older = published_of(result, peak_force=Quantity(peak * (1.0 + 1e-3 * times), 1e-3 * peak, "N"))
        (move,) = [move for move in moves("steel-ball", older, result) if move.quantity == "peak_force"]
        assert move.moved == pytest.approx(times, rel=1e-3)
        assert move.agrees is agrees
    undefined = published_of(result, duration=Quantity(None, None, "s"))
    assert any(move.moved is None and not move.agrees for move in moves("steel-ball", undefined, result))
    exact = published_of(result, restitution=Quantity(0.5, 0.0, "1"))
    assert any(move.quantity == "restitution" and not move.agrees for move in moves("steel-ball", exact, result))


def test_a_history_that_moved_is_found_where_no_quantity_did(result: Result) -> None:
    bent = replace(result.history, force=result.history.force * (1.0 + 1e-3 * np.sin(300.0 * result.history.time)))
    older = Reference(bent, result.quantities)
    (move,) = [move for move in moves("steel-ball", older, result) if move.quantity == "history_l2"]
    assert not move.agrees


def test_check_names_what_differs_and_ends_with_3(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    older = copytree(folder(), tmp_path / "older")
    file = older / "paper-steel-kelvin.json"
    content = json.loads(file.read_text(encoding="utf-8"))
    content["quantities"]["duration"]["value"] *= 1.01
    file.write_text(json.dumps(content), encoding="utf-8")
    monkeypatch.setattr(references, "folder", lambda: older)
    asked = ["references", "--scenes", "paper-steel-kelvin,pounding-wall-kelvin", "--out", str(tmp_path / "out")]
    assert main([*asked, "--check"]) == 3
    out, err = capsys.readouterr()
    assert "paper-steel-kelvin: DIFFERS" in out
    assert "(duration)" in out
    assert "pounding-wall-kelvin: agrees" in out
    assert "paper-steel-kelvin" in err
    assert "pounding-wall-kelvin" not in err
    assert main(asked) == 0, "without --check it only tells"
    assert (tmp_path / "out" / "moves.csv").exists()


def test_unknown_scenes_are_bad_input(refused: Callable[..., list[str]]) -> None:
    assert "steel-ball" in refused("references", "--scenes", "steel-bal")[0]
    assert refused("references", "--update", "--scenes", "steel-ball", "--out", "out")


ASKED = ("steel-ball", "paper-steel-hertz", "ball-bouncing")


@pytest.fixture
def written(tmp_path: Path) -> Callable[..., Path]:
    """What users of other tools get of a few scenes, in a format."""

    def write(name: str, asked: Sequence[str] = ASKED) -> Path:
        where = tmp_path / name
        given = ["--export", str(where), "--format", name, "--scenes", ",".join(asked), "--quiet"]
        assert main(["references", *given]) == 0
        record = json.loads((where / "references.json").read_text(encoding="utf-8"))
        assert record["format"] == name
        assert {*record["files"]} == {path.name for path in where.iterdir()} - {"references.json"}
        return where

    return write


def test_every_format_tells_the_same_histories_and_quantities(written: Callable[..., Path]) -> None:
    """Read by what others read them with: csv, json, pyarrow."""
    from pyarrow import parquet

    as_csv, as_json, as_parquet = (written(name) for name in ("csv", "json", "parquet"))
    histories = parquet.read_table(as_parquet / "histories.parquet").to_pydict()
    told = parquet.read_table(as_parquet / "quantities.parquet").to_pylist()
    with (as_csv / "quantities.csv").open(encoding="utf-8", newline="") as file:
        lines = [*csv.DictReader(file)]
    assert len(lines) == len(told)
    for name in ASKED:
        one = Reference.read(folder(), name)
        assert one is not None
        content = json.loads((as_json / f"{name}.json").read_text(encoding="utf-8"))
        rows = [place for place, scene in enumerate(histories["scene"]) if scene == name]
        for field, column in COLUMNS.items():
            published = getattr(one.history, field)
            np.testing.assert_array_equal(content["history"][column], published)
            np.testing.assert_array_equal([histories[column][row] for row in rows], published)
            np.testing.assert_array_equal(getattr(History.read_csv(as_csv / f"{name}.csv"), field), published)
        (peak,) = [line for line in lines if (line["scene"], line["quantity"]) == (name, "peak_force")]
        assert (
            float(peak["value"]) == one.quantities["peak_force"].value == content["quantities"]["peak_force"]["value"]
        )
        assert {"scene": name, "quantity": "peak_force", **content["quantities"]["peak_force"]} in told


@pytest.mark.family
@pytest.mark.parametrize("name", ["paper-steel-hertz", "steel-ball"])
def test_opensees_gets_a_series_of_the_force_and_a_law_of_its_own(name: str, written: Callable[..., Path]) -> None:
    where, one = written("opensees", [name, "ball-bouncing"]), Reference.read(folder(), name)
    assert one is not None
    text = (where / f"{name}.tcl").read_text(encoding="utf-8")
    series, material = (line.split() for line in text.splitlines() if not line.startswith("#"))
    options = dict(zip(series[3::2], series[4::2], strict=True))
    time, force = (np.loadtxt(where / options[option]) for option in ("-fileTime", "-filePath"))
    assert series[:2] == ["timeSeries", "Path"]
    assert np.all(np.diff(time) > 0.0), "OpenSees wants times that rise"
    assert np.trapezoid(force, time) == pytest.approx(np.trapezoid(one.history.force, one.history.time), rel=1e-6)
    check_material(name, material, one)
    bounces = (where / "ball-bouncing.tcl").read_text(encoding="utf-8")
    assert "motion.impacts: 4: a fit follows one impact" in bounces


def check_material(name: str, line: list[str], one: Reference) -> None:
    """The elastic ball's is Hertz's by another name; its energy lifts the peak force to what is published."""
    values = [float(word) for word in line[3:]]
    at = {"JankowskiImpact": (0, 4), "Hertzdamp": (0, 3)}[line[1]]
    stiffness, exponent = (values[place] for place in at)
    scene = Scene.load(name)
    energy = 0.5 * scene.mass * scene.velocity**2
    depth = ((exponent + 1.0) * energy / stiffness) ** (1.0 / (exponent + 1.0))
    assert stiffness * depth**exponent == pytest.approx(one.quantities["peak_force"].value, rel=2e-3)


def test_what_cannot_be_written_for_others_is_bad_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    where = tmp_path / "out"
    asked = ["references", "--export", str(where)]
    assert main([*asked, "--format", "matlab"]) == 2
    assert "accepted csv, json, parquet, opensees" in capsys.readouterr().err
    assert main([*asked, "--update"]) == 2
    assert "--check" in capsys.readouterr().err
    for module in ("pyarrow", "pyarrow.parquet"):
        monkeypatch.setitem(sys.modules, module, None)
    assert main([*asked, "--format", "parquet"]) == 2
    assert "pip install 'fe-contact[parquet]'" in capsys.readouterr().err
    (empty := tmp_path / "none").mkdir()
    monkeypatch.setattr(references, "folder", lambda: empty)
    assert main([*asked, "--scenes", "steel-ball"]) == 2
    assert "steel-ball: no history of it is published" in capsys.readouterr().err
    assert not where.exists()
