"""`export`: what another program is given is whole and the scene's own; what other programs found, we find."""

from __future__ import annotations

import ast
import csv
import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import fe_contact
from fe_contact.cli import main
from lumped import Scene
from lumped.schema.files import data_folder

ROUGH = ("--tolerance", "0.05", "--quiet")


def exported(where: Path, *words: str) -> str:
    assert main(["export", *words, *ROUGH, "--out", str(where)]) == 0
    (file,) = (path for path in where.iterdir() if path.suffix != ".json")
    return file.read_text(encoding="utf-8")


def blocks(deck: str) -> dict[str, list[list[str]]]:
    """Lines of a CalculiX deck by the card above them."""
    found: dict[str, list[list[str]]] = {}
    for line in deck.splitlines():
        if line.startswith("*"):
            found.setdefault(line, rows := [])
        else:
            rows.append([word.strip() for word in line.split(",") if word.strip()])
    return found


@pytest.mark.parametrize("scene", ["polymer-layer", "polymer-cone"])
def test_a_deck_is_whole_and_its_striker_has_the_profile(scene: str, tmp_path: Path) -> None:
    cards = blocks(exported(tmp_path, scene, "--to", "calculix", "--depth", "1e-5", "--elements", "6"))
    nodes = {int(one): (float(r), float(z)) for one, r, z, _ in cards["*NODE, NSET=ALL"]}
    assert np.isfinite([*nodes.values()]).all()
    parts = {name: cards[f"*ELEMENT, TYPE=CAX8, ELSET={name}"] for name in ("BODY", "STRIKER")}
    used = Counter(int(node) for rows in parts.values() for row in rows for node in row[1:])
    assert used.keys() == nodes.keys(), "no node without an element, and none that is not there"
    for rows in parts.values():
        for _, *corners in rows:
            r, z = np.array([nodes[int(node)] for node in corners[:4]]).T
            assert 0.5 * np.sum(r * np.roll(z, -1) - z * np.roll(r, -1)) > 0.0, "counter-clockwise"
    face = {int(row[0]) for row in cards["*SURFACE, NAME=FACE"]}
    lowest = {int(node) for row in parts["STRIKER"] if int(row[0]) in face for node in (row[1], row[5], row[2])}
    for radius, height in (nodes[node] for node in lowest):
        assert height == pytest.approx(float(Scene.load(scene).profile.height(radius)), rel=1e-9, abs=1e-18)
    for name in ("AXIS", "BASE", "SIDE"):
        assert {int(node) for row in cards[f"*NSET, NSET={name}"] for node in row} <= nodes.keys()


def test_a_script_has_the_numbers_of_its_scene(tmp_path: Path) -> None:
    text = exported(tmp_path, "polymer-layer", "--to", "ngsolve")
    found = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            try:
                found[node.targets[0].id] = ast.literal_eval(node.value)
            except ValueError:
                continue
    scene = Scene.load("polymer-layer")
    young = scene.geometry.material.young
    assert (found["MASS"], found["VELOCITY"], found["NU"]) == (scene.mass, scene.velocity, scene.geometry.material.nu)
    assert (found["EQUILIBRIUM"], found["MODULI"], found["TIMES"]) == (
        young.equilibrium,
        [*young.moduli],
        [*young.times],
    )
    assert found["THICKNESS"] == 0.002
    places = np.linspace(0.0, found["REACH"] * found["EDGE"], len(found["HEIGHTS"]))
    assert found["HEIGHTS"] == pytest.approx(scene.profile.height(places), rel=1e-9)
    assert re.search(r"peak_force 0\.2\d+ \+- ", text), "our own answer stands in it"


@pytest.mark.parametrize(
    ("words", "key"),
    [
        (("rod-in-ring", "--to", "ngsolve"), "striker.shape"),
        (("polymer-punch", "--to", "ngsolve"), "striker.shape"),
        (("two-spheres", "--to", "ngsolve"), "target.material"),
        (("steel-ball-waves", "--to", "ngsolve"), "inertia"),
        (("steel-ball-plastic", "--to", "ngsolve"), "model.plasticity"),
        (("polymer-sphere-finite", "--to", "calculix", "--depth", "1e-5"), "model.kinematics"),
        (("polymer-layer", "--to", "calculix"), "--depth"),
        (("polymer-layer", "--to", "ngsolve", "--elements", "2.5"), "--elements"),
        (("polymer-layer", "--to", "ngsolve", "--elements", "nan"), "--elements"),
    ],
)
def test_what_another_program_is_not_told_is_refused(
    words: tuple[str, ...], key: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", *words, *ROUGH, "--out", str(tmp_path / "none")]) == 2
    assert key in capsys.readouterr().err
    assert not (tmp_path / "none").exists()


def test_other_programs_found_the_same() -> None:
    """Within our bars and what each errs by on its own account."""
    with (data_folder() / "crosscheck" / "crosscheck.csv").open(encoding="utf-8", newline="") as file:
        rows = [*csv.DictReader(file)]
    assert {row["program"] for row in rows} == {"CalculiX", "NGSolve"}
    for row in rows:
        value, error = float(row["value"]), float(row["error"])
        assert error < 3e-3 * value, "an answer that says something"
        if row["depth_m"]:
            found = fe_contact.indent(row["scene"], [float(row["depth_m"])], 1e-3)
            ours, bar = float(found.force[0]), float(found.force_error[0])
        else:
            quantity = impact(row["scene"]).quantities[row["quantity"]]
            ours, bar = quantity.value or 0.0, quantity.error or 0.0
        assert abs(ours - value) <= bar + error, row


def impact(name: str, known: dict[str, fe_contact.Result] = {}) -> fe_contact.Result:  # noqa: B006  one run a name
    if name not in known:
        known[name] = fe_contact.run(Scene.load(name), tolerance=1e-3)
    return known[name]
