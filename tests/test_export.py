"""`export`: what another program is given is whole and the scene's own; what other programs found, we find."""

from __future__ import annotations

import ast
import csv
import re
from collections import Counter
from collections.abc import Callable
from functools import cache
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import fe_contact
from fe_contact.cli import main
from lumped import Scene
from lumped.schema.csv_file import read_columns
from lumped.schema.files import data_folder

CROSSCHECK = data_folder() / "crosscheck"
PROGRAMS, SCENES = ("CalculiX", "NGSolve"), ("polymer-sphere", "polymer-layer")
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


@pytest.mark.family
@pytest.mark.parametrize("scene", ["polymer-cone", "polymer-layer"])
def test_a_deck_is_whole_and_its_striker_has_the_profile(scene: str, tmp_path: Path) -> None:
    deck = exported(tmp_path, scene, "--to", "calculix", "--depth", "1e-5")
    assert "Lengths in mm, forces in N, moduli in MPa" in deck
    cards = blocks(deck)
    ((young, nu),) = cards["*ELASTIC"][:1]
    material = Scene.load(scene).geometry.material
    assert (float(young), float(nu)) == (pytest.approx(1e-6 * material.young.relaxed), material.nu)
    nodes = {int(one): (1e-3 * float(r), 1e-3 * float(z)) for one, r, z, _ in cards["*NODE, NSET=ALL"]}
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
    text = exported(tmp_path, "polymer-sphere", "--to", "ngsolve")
    found = {}
    for node in ast.parse(text).body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            try:
                found[node.targets[0].id] = ast.literal_eval(node.value)
            except ValueError:
                continue
    scene = Scene.load("polymer-sphere")
    young = scene.geometry.material.young
    assert (found["MASS"], found["VELOCITY"], found["NU"]) == (scene.mass, scene.velocity, scene.geometry.material.nu)
    assert (found["EQUILIBRIUM"], found["MODULI"], found["TIMES"]) == (
        young.equilibrium,
        [*young.moduli],
        [*young.times],
    )
    assert (found["UP"][0], found["UP"][-1], found["ACROSS"][0]) == (-found["ACROSS"][-1], 0.0, 0.0)
    assert min(np.diff(found["UP"]).min(), np.diff(found["ACROSS"]).min()) > 0.0
    assert np.min(np.abs(np.subtract(found["ACROSS"], found["REACH"]))) < 1e-9 * found["REACH"], "a line of the mesh"
    places = np.linspace(0.0, found["REACH"], len(found["HEIGHTS"]))
    assert found["HEIGHTS"] == pytest.approx(scene.profile.height(places), rel=1e-9)
    assert re.search(r"peak_force 0\.16\d* \+- ", text), "our own answer stands in it"


@pytest.mark.parametrize(
    ("words", "key"),
    [
        (("rod-in-ring", "--to", "ngsolve"), "striker.shape"),
        (("polymer-punch", "--to", "ngsolve"), "striker.shape"),
        (("two-spheres", "--to", "ngsolve"), "striker.material, target.material"),
        (("polymer-prism", "--to", "ngsolve"), ": striker.material: "),
        (("steel-ball-waves", "--to", "ngsolve"), "inertia"),
        (("steel-ball-plastic", "--to", "ngsolve"), "model.plasticity"),
        (("polymer-sphere-finite", "--to", "calculix", "--depth", "1e-5"), "model.kinematics"),
        (("polymer-sphere", "--to", "calculix"), "--depth"),
        (("polymer-layer", "--to", "ngsolve", "--depth", "nan"), "--depth: nan: accepted a number"),
        (("polymer-layer", "--to", "ngsolve", "--depth", "1"), "--depth: 1: accepted below the "),
    ],
)
def test_what_another_program_is_not_told_is_refused(
    words: tuple[str, ...], key: str, refused: Callable[..., list[str]]
) -> None:
    assert key in refused("export", *words, *ROUGH)[0]


def test_the_finer_mesh_of_two_divides_the_coarser_one(tmp_path: Path) -> None:
    """So that the difference of their answers tells what either errs by."""
    words = ("polymer-sphere", "--to", "ngsolve", "--depth", "1e-5", "--refined")
    meshes = []
    for refined in ("1", "2"):
        text = exported(tmp_path / refined, *words, refined)
        meshes.append(
            [ast.literal_eval(line.partition(" = ")[2]) for line in re.findall("^(?:ACROSS|UP) = .*", text, re.M)]
        )
    for coarse, fine in zip(*meshes, strict=True):
        assert fine[::2] == pytest.approx(coarse, rel=1e-9)
        assert len(fine) == 2 * len(coarse) - 1


@pytest.mark.tenth
def test_other_programs_found_the_same() -> None:
    """Within our bars and what each errs by on its own account."""
    with (CROSSCHECK / "crosscheck.csv").open(encoding="utf-8", newline="") as file:
        rows = [*csv.DictReader(file)]
    assert {(row["program"], row["scene"]) for row in rows if row["depth_m"]} == {*product(PROGRAMS, SCENES)}
    for row in rows:
        value, error = float(row["value"]), float(row["error"])
        assert error < 1e-3 * value, "an answer that says something"
        ours, bar = static(row) if row["depth_m"] else struck(row)
        assert abs(ours - value) <= bar + error, row


def static(row: dict[str, str]) -> tuple[float, float]:
    found = fe_contact.indent(row["scene"], [float(row["depth_m"])], 1e-3)
    return float(found.force[0]), float(found.force_error[0])


def struck(row: dict[str, str]) -> tuple[float, float]:
    quantity = impact(row["scene"]).quantities[row["quantity"]]
    assert quantity.value is not None
    assert quantity.error is not None
    return quantity.value, quantity.error


@cache
def impact(name: str) -> fe_contact.Result:
    return fe_contact.run(Scene.load(name), tolerance=5e-4)


def test_the_impact_of_another_program_is_ours_at_every_time() -> None:
    theirs = read_columns(CROSSCHECK / "ngsolve-polymer-layer-impact.csv", ("time_s", "force_N", "force_error_N"))
    ours = impact("polymer-layer").history
    bars = np.interp(theirs["time_s"], ours.time, ours.force_error) + theirs["force_error_N"]
    assert np.all(np.abs(ours.force_at(theirs["time_s"]) - theirs["force_N"]) <= bars)
    assert bars.max() < 4e-3 * ours.force.max()
