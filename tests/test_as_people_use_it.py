"""In a shell and a notebook: what is printed is short and true, names are few, packaged names and files are taken."""

from __future__ import annotations

import argparse
import re
import sys
import types
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fe_contact
import lumped
from fe_contact.cli import parser
from fe_contact.commands import COMMANDS
from lumped import BadInput, Result, Scene
from lumped.errors import PackageMissing
from lumped.pounding.case_file import CASES as POUND
from lumped.ptmd.case_file import CASES as PTMD
from lumped.result.history import COLUMNS
from lumped.schema.files import SCENES
from lumped.schema.shown import curves, ticks


@pytest.fixture(scope="module")
def result() -> Result:
    scene = Scene.load("polymer-sphere")
    return lumped.simulate(lumped.laws.ting.of(scene), scene, 1e-4)


def test_what_is_printed_is_short_and_holds_the_numbers(result: Result) -> None:
    score = lumped.score(result.history, result.history)
    for thing in (result, result.history, result.scene, score, result.plot()):
        assert 1 <= len(repr(thing).splitlines()) <= 12
        assert "array(" not in repr(thing)
        assert max(map(len, repr(thing).splitlines())) < 240
    assert f"{result.quantities['peak_force'].value:.6g}" in result.summary()
    assert f"{len(result.history)} rows" in repr(result.history)


def test_every_packaged_scene_can_be_printed() -> None:
    for name in SCENES.names:
        scene = Scene.load(name)
        assert f"{scene.mass:.6g}" in repr(scene)
        assert scene._repr_html_().count("<tr>") == len(repr(scene).splitlines())


def test_a_notebook_shows_tables_and_the_curve(result: Result) -> None:
    text = result._repr_html_() + result.history._repr_html_()
    tree = ElementTree.fromstring(f"<div>{text}</div>")
    assert len(list(tree.iter("table"))) == 2
    assert all(name in text for name in result.quantities)


def test_a_curve_is_drawn_where_its_numbers_are() -> None:
    """Read back from the picture: the highest point is the largest value, between ticks that hold it."""
    x = np.linspace(0.0, 0.02, 301)
    y = 1.7e5 * np.sin(np.pi * x / 0.02)
    tree = ElementTree.fromstring(curves({"force": (x, y)}, "time, s", "force, N").svg)
    space = "{http://www.w3.org/2000/svg}"
    points = np.array([pair.split(",") for pair in tree.find(f"{space}polyline").get("points").split()], dtype=float)
    marks = {
        float(one.text): float(one.get("y")) - 4.0
        for one in tree.iter(f"{space}text")
        if one.get("text-anchor") == "end" and re.fullmatch(r"[\d.e+]+", one.text)
    }
    (zero, top) = marks[0.0], marks[max(marks)]
    assert (points[:, 1].min() - zero) / (top - zero) * max(marks) == pytest.approx(1.7e5, rel=0.01)
    assert points[np.argmin(points[:, 1]), 0] == pytest.approx(points[:, 0].mean(), abs=5.0)


@pytest.mark.parametrize(
    ("low", "high"), [(0.0, 0.16), (-3e-9, 1e-9), (0.0, 0.0), (5.0, 5.0), (-1e12, 3e12), (0.0, 1.0)]
)
def test_ticks_are_round_and_hold_what_they_are_for(low: float, high: float) -> None:
    found = ticks(low, high)
    assert found[0] <= low + 1e-9 * abs(low)
    assert found[-1] >= high - 1e-9 * abs(high)
    assert 2 <= len(found) <= 8
    assert {f"{step:.3e}"[0] for step in np.diff(found)} <= {"1", "2", "5"}


def test_a_history_becomes_a_table_of_pandas_or_says_what_is_missing(
    result: Result, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(PackageMissing, match="pip install pandas"):
        result.history.to_pandas()
    pandas: Any = types.ModuleType("pandas")
    pandas.DataFrame = dict
    monkeypatch.setitem(sys.modules, "pandas", pandas)
    table: Any = result.history.to_pandas()
    assert list(table) == list(COLUMNS.values())
    assert np.array_equal(table["force_N"], result.history.force)


@pytest.mark.parametrize("package", [fe_contact, lumped])
def test_names_that_are_shown_are_there_and_public(package: Any) -> None:
    assert {*package.__all__} <= {*dir(package)}
    assert all(getattr(package, name) is not None for name in dir(package))
    assert not {"annotations", "Any", "TYPE_CHECKING"} & {*dir(package)}


def test_names_of_packaged_scenes_and_settings_of_files_are_taken(tmp_path: Path) -> None:
    text = SCENES.path("polymer-sphere").read_text(encoding="utf-8")
    (tmp_path / "mine.toml").write_text(f"{text}\n[numerics]\ntolerance = 0.05\n", encoding="utf-8")
    assert fe_contact.run("polymer-sphere", method="ting").tolerance == 1e-3
    assert fe_contact.run(tmp_path / "mine.toml", method="ting").tolerance == 0.05
    assert fe_contact.run(tmp_path / "mine.toml", method="ting", numerics={"tolerance": 0.01}).tolerance == 0.01
    with pytest.raises(BadInput, match="did you mean polymer-sphere"):
        fe_contact.run("polymer-spere")


def test_a_folder_with_the_name_of_a_scene_does_not_hide_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Results may stand in one: `--out steel-ball`."""
    monkeypatch.chdir(tmp_path)
    for files, name in ((SCENES, "steel-ball"), (PTMD, "paper"), (POUND, "two-frames")):
        (tmp_path / name).mkdir()
        assert files.resolved(name).is_file()
    assert fe_contact.run("steel-ball", method="hertz").scene.name == "steel-ball"


def test_completions_are_told_of_every_command_and_help_lists_each_once() -> None:
    """What shtab and argcomplete read; a command without help would complete no option."""
    top = parser()
    (commands,) = (one for one in top._actions if isinstance(one, argparse._SubParsersAction))
    assert {one.dest for one in commands._get_subactions() if one.help} == set(COMMANDS.members)
    assert all(len(re.findall(rf"^  {name} ", top.format_help(), re.MULTILINE)) == 1 for name in COMMANDS.members)


def test_a_law_is_fitted_from_what_has_a_force(result: Result, tmp_path: Path) -> None:
    result.history.write_csv(tmp_path / "curve.csv")
    found = [fe_contact.fit(curve, "hertz", "polymer-sphere") for curve in (result.history, tmp_path / "curve.csv")]
    assert len(repr(found[0]).splitlines()) <= 4
    assert found[0].parameters["k"].value == pytest.approx(found[1].parameters["k"].value, rel=1e-4)
    shown = found[1]._repr_html_()
    assert f"{found[1].parameters['k'].value:.6g}" in shown
    assert shown.count("<polyline") == 2, "the curve and the law"
    ElementTree.fromstring(f"<div>{shown}</div>")


@pytest.mark.tenth
def test_an_indentation_is_that_of_the_command_whatever_it_is_asked_of() -> None:
    found = [
        fe_contact.indent(one, [1e-5, 2e-5, 4e-5], 0.05) for one in ("polymer-sphere", Scene.load("polymer-sphere"))
    ]
    assert np.array_equal(found[0].force, found[1].force)
    assert len(repr(found[0]).splitlines()) < 10
    assert found[0]._repr_html_().count("<polyline") == 1
    assert abs(found[0].quantities["alpha"].value - 1.5) <= found[0].quantities["alpha"].error + 1e-3


def test_what_is_found_is_written_where_a_text_says(result: Result, tmp_path: Path) -> None:
    """As a path of `pathlib` does, whatever was found."""
    points = {"scene": "polymer-sphere", "methods": ["ting"], "axes": {"striker.velocity": [0.02]}}
    found = {
        "result.json": result,
        "indentation.csv": fe_contact.indent("polymer-punch", [1e-5], 0.1),
        "fit.json": fe_contact.fit(result.history, "hertz", result.scene),
        "transfer.csv": fe_contact.transfer(result.scene, ["ting"], method="ting"),
    }
    for name, one in found.items():
        one.write(str(tmp_path / name[:3]))
        assert (tmp_path / name[:3] / name).is_file()
    fe_contact.sweep(points).write(str(tmp_path), 0.0)
    assert (tmp_path / "table.csv").is_file()


@pytest.mark.tenth
def test_what_is_found_is_drawn(result: Result, tmp_path: Path) -> None:
    compared = fe_contact.compare("polymer-sphere", ["hertz", "mdr"], tolerance=0.05)
    assert {*compared.laws} == {"hertz", "mdr"}
    assert "hertz: errs by" in repr(compared)
    for found in (result, compared):
        files = fe_contact.plot(found, tmp_path / type(found).__name__)
        assert {path.suffix for path in files} == {".svg", ".png"}
        assert all(path.stat().st_size > 10_000 for path in files)
    with pytest.raises(BadInput, match="accepted: Result"):
        fe_contact.plot(result.history, tmp_path)
