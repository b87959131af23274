"""`fe-contact indent`: rows in the order asked, at rest or at once, exits, closed forms and elements alike."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_contact import indentation
from fe_contact.cli import main
from lumped.errors import BadInput, NotReached
from lumped.scene.indenter import Indenter
from lumped.schema.files import SCENES

HEADER = ["depth_m", "force_N", "contact_radius_m", "force_error_N"]
SCENE = """
name = "pressed"
[striker]
shape = "{shape}"
[target]
shape = "{target}"
[target.material]
nu = 0.3
{material}
"""
SLS = 'law = "sls"\nE0 = 2e6\nR1 = 0.5\nR2 = 0.01'
FLUID = 'law = "maxwell"\nE = 1e6\neta = 1e3'
DASHPOT = 'law = "kelvin_voigt"\nE = 1e6\neta = 1e3'
SPHERE = 'sphere"\nradius = 0.01\n# "'
LAYER = 'layer"\nthickness = 0.002\nbase = "bonded"\n# "'
ASKED = "5e-5,1e-5,2e-5"


@pytest.fixture
def write(tmp_path: Path) -> Any:
    """A scene file without mass and velocity."""

    def build(material: str = SLS, shape: str = SPHERE, target: str = "half_space") -> str:
        path = tmp_path / "pressed.toml"
        path.write_text(SCENE.format(shape=shape, target=target, material=material))
        return str(path)

    return build


def test_no_force_of_an_indentation_is_called_a_peak(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What yields, slowly: how good the model is, and what it leaves out, are of the force that was asked for."""
    yields = ["--set", "target.material.yield_strength=4e8", "--method", "hertz"]
    assert exit_code("steel-ball", "--depths", "1e-6,5e-6", *yields) == 0
    said = capsys.readouterr()
    assert " % of the force, for plasticity" in said.out
    assert "plasticity is left out; it may change the force by " in said.err


def exit_code(*arguments: str) -> int:
    try:
        return main(["indent", *arguments])
    except SystemExit as stop:  # argparse
        return int(stop.code or 0)


def rows(folder: Path) -> np.ndarray:
    """The table of indentation.csv, (n, 4); its header is what users rely on."""
    with (folder / "indentation.csv").open(newline="") as file:
        lines = list(csv.reader(file))
    assert lines[0] == HEADER
    return np.array(lines[1:], dtype=float)


def content(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    return found


@pytest.mark.parametrize("target", ["half_space", LAYER])
def test_one_row_per_depth_in_the_order_asked(target: str, write: Any, empty: Path) -> None:
    scene = write(target=target)
    assert exit_code(scene, "--depths", ASKED, "--out", "fe") == 0
    assert exit_code(scene, "--depths", ASKED, "--out", "exact", "--method", "cheapest") == 0
    elements, exact = rows(empty / "fe"), rows(empty / "exact")
    assert elements[:, 0].tolist() == exact[:, 0].tolist() == [5e-5, 1e-5, 2e-5]
    assert np.all(np.abs(elements[:, 1] - exact[:, 1]) <= elements[:, 3] + exact[:, 3])
    assert np.all(elements[:, 3] <= 1e-3 * elements[:, 1])
    assert np.abs(elements[:, 2] / exact[:, 2] - 1.0).max() <= 2e-3
    quantities = content(empty / "fe")["quantities"]
    assert set(quantities) == {"alpha", "D", "D_at_alpha"}
    for name, quantity in content(empty / "exact")["quantities"].items():
        assert abs(quantity["value"] - quantities[name]["value"]) <= quantity["error"] + quantities[name]["error"]


def test_at_once_a_constant_bulk_modulus_has_its_own_poisson(write: Any, empty: Path) -> None:
    """K = E_inf/(3 (1 - 2 nu)) stays, G is the glassy one: the elastic layer of these two, by its integral equation."""
    relaxing = SLS + '\nconstant = "bulk"'
    assert exit_code(write(relaxing, target=LAYER), "--depths", ASKED, "--out", "fe", "--instant") == 0
    assert exit_code(write(relaxing, target=LAYER), "--depths", ASKED, "--out", "exact", "--method", "ting") == 0
    for name, young in (("fe", 3e6), ("exact", 2e6)):  # E0 (1 + R1), and E0
        bulk, shear = 2e6 / (3.0 * (1.0 - 2.0 * 0.3)), young / (2.0 * (1.0 + 0.3))
        poisson = 0.5 * (3.0 * bulk - 2.0 * shear) / (3.0 * bulk + shear)
        elastic = f'law = "elastic"\nE = {2.0 * shear * (1.0 + poisson)}\n# '
        scene = Path(write(elastic, target=LAYER))
        scene.write_text(scene.read_text().replace("nu = 0.3", f"nu = {poisson}"))
        assert exit_code(str(scene), "--depths", ASKED, "--out", "elastic", "--method", "cheapest") == 0
        found, wanted = rows(empty / name), rows(empty / "elastic")
        assert np.all(np.abs(found[:, 1] - wanted[:, 1]) <= found[:, 3] + wanted[:, 3]), name


def test_at_once_is_stiffer_by_the_glassy_modulus(write: Any, empty: Path) -> None:
    for out, more in (("slow", ()), ("fast", ("--instant",))):
        assert exit_code(write(), "--depths", "1e-5", "--out", out, *more) == 0
    assert rows(empty / "fast")[0, 1] / rows(empty / "slow")[0, 1] == pytest.approx(1.5, rel=1e-12)
    assert content(empty / "slow")["quantities"] == {}, "one depth tells no power law"


@pytest.mark.parametrize(("material", "more"), [(FLUID, ()), (DASHPOT, ("--instant",))])
def test_what_has_no_modulus_is_refused(
    material: str, more: tuple[str, ...], write: Any, refused: Callable[..., list[str]]
) -> None:
    assert "target.material" in refused("indent", write(material), "--depths", "1e-5", *more)[0]


@pytest.mark.parametrize(("material", "more"), [(FLUID, ("--instant",)), (DASHPOT, ())])
def test_what_has_one_is_pressed(material: str, more: tuple[str, ...], write: Any, empty: Path) -> None:
    assert exit_code(write(material), "--depths", "1e-5", "--method", "cheapest", "--out", "out", *more) == 0
    assert content(empty / "out")["contact_modulus"] == pytest.approx(1e6 / (1 - 0.3**2))


@pytest.mark.parametrize("depths", ["", "1e-5,", "0", "-1e-5", "nan", "inf", "1e-5;2e-5", "0.01", "1e-5,2e-3"])
def test_bad_depths_write_nothing(depths: str, write: Any, refused: Callable[..., list[str]]) -> None:
    assert "--depths" in refused("indent", write(target=LAYER), f"--depths={depths}")[0]


def test_every_bad_depth_is_named(write: Any, refused: Callable[..., list[str]]) -> None:
    """What is no number hides neither another one nor a number that no depth can be."""
    told = refused("indent", write(target=LAYER), "--depths=abc,1e-5,nan,,1e-2")
    assert [line.split(":")[1].strip() for line in told] == ["'abc'", "''", "nan", "0.01"]
    assert all("accepted" in line for line in told)


@pytest.mark.parametrize("depths", ["1e-12,1e-4", "1e-15"])
def test_depths_that_no_mesh_serves_are_named_beside_the_thickness(
    depths: str, write: Any, refused: Callable[..., list[str]]
) -> None:
    """A cone's contacts are as unlike as its depths, or hardly there beside the layer: the user may change either."""
    (told,) = refused("indent", write(shape='cone"\nangle = 20.0\n# "', target=LAYER), f"--depths={depths}")
    assert told.startswith("pressed.toml: --depths, target.thickness: ")
    assert "accepted" in told


@pytest.mark.parametrize(
    ("method", "target", "reason"),
    [("hertzz", "half_space", "hertz"), ("hertz", LAYER, "half-space alone"), ("mdr", LAYER, "half-space alone")],
)
def test_a_method_that_does_not_know_the_body_is_refused(
    method: str, target: str, reason: str, write: Any, refused: Callable[..., list[str]]
) -> None:
    assert reason in refused("indent", write(target=target), "--depths", "1e-5", "--method", method)[0]


@pytest.mark.parametrize("name", ["steel-ball-plastic", "polymer-sphere-finite"])
def test_the_cheapest_is_no_law_that_leaves_out_what_is_asked(
    name: str, empty: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def pressed(*_: Any) -> Any:
        raise NotReached("by finite elements")

    monkeypatch.setattr(indentation, "indent", pressed)
    assert main(["indent", name, "--depths", "1e-6", "--method", "cheapest"]) == 3
    assert capsys.readouterr().err == "by finite elements\n"


def test_hertz_is_the_parabola(write: Any, empty: Path) -> None:
    assert exit_code(write(), "--depths", "1e-5,1e-3", "--method", "hertz", "--out", "out") == 0
    depth, force, radius, _ = rows(empty / "out").T
    np.testing.assert_allclose(force, 4.0 / 3.0 * 2e6 / 0.91 * np.sqrt(0.01 * depth**3), rtol=1e-12)
    np.testing.assert_allclose(radius, np.sqrt(0.01 * depth), rtol=1e-12)


def test_json_on_stdout_is_the_file(write: Any, empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(write(), "--depths", ASKED, "--method", "cheapest", "--json", "--out", "out") == 0
    assert json.loads(capsys.readouterr().out) == content(empty / "out")


def test_a_tolerance_out_of_reach_is_said(write: Any, empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    fixed = ("--set", "numerics.elements_per_contact=1", "--set", "numerics.penalty=50")
    assert exit_code(write(), "--depths", ASKED, "--tolerance", "1e-6", "--out", "out", *fixed) == 3
    assert "not reached" in capsys.readouterr().err
    assert not content(empty / "out")["converged"]
    assert len(rows(empty / "out")) == 3


# Bodies which no closed form is known for.
WITHOUT_CURVE = (
    "polymer-o-ring",
    "polymer-plate",
    "polymer-washer",
    "steel-ball-flight-waves",
    "two-cylinders",
    "two-finite-spheres",
    "two-finite-spheres-waves",
)


def linear(name: str) -> bool:
    """Whether it is pressed, and a linear body: others have no exact curve."""
    try:
        model = Indenter.load(name).model
        return not (model.finite or model.plasticity)
    except BadInput:  # a scene of a law without geometry
        return False


@pytest.mark.family
@pytest.mark.parametrize("name", [name for name in SCENES.names if linear(name)])
def test_packaged_scenes_are_pressed_within_their_bars(name: str, empty: Path) -> None:
    assert exit_code(name, "--depths", "2e-5", "--out", "fe") == 0
    code = exit_code(name, "--depths", "2e-5", "--out", "exact", "--method", "cheapest")
    if name in WITHOUT_CURVE:
        assert code == 2
        return
    assert code == 0
    elements, exact = rows(empty / "fe")[0], rows(empty / "exact")[0]
    assert abs(elements[1] - exact[1]) <= elements[3] + exact[3]


def test_a_contact_as_wide_as_the_datum_is_deep_is_refused(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Whether or not the depth is less than the roller's radius."""
    shallow = ("polymer-half-plane", "--set", "target.datum_depth=0.002", "--tolerance", "1e-2", "--depths")
    assert exit_code(*shallow, "1e-4,4e-4,1e-3", "--out", "none") == 2
    faults = capsys.readouterr().err.splitlines()
    assert [fault.split(":")[1].strip() for fault in faults] == ["0.0004", "0.001"]
    assert all("below the datum's depth 0.002 m" in fault for fault in faults)
    assert not (empty / "none").exists()
    assert exit_code(*shallow, "1e-4", "--out", "one") == 0


def test_strains_beyond_the_small_are_said(write: Any, empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """In the ledger of every method, and in one line that leaves the exit code alone."""
    for method in ("fe", "ting"):
        pressed = write(SLS + '\nhyperelastic = "st_venant_kirchhoff"', target=LAYER)
        assert exit_code(pressed, "--depths", "1e-6,1e-3", "--method", method, "--out", method) == 0
        result = json.loads((empty / method / "result.json").read_text())
        (strain,) = [e["estimate"] for e in result["model_ledger"] if e["effect"] == "finite strain"]
        assert 0.4 < strain < 0.8, "pressed by half of its thickness"
        assert result["model_sufficient"] is False
        (line,) = capsys.readouterr().err.splitlines()
        assert "finite strain" in line
