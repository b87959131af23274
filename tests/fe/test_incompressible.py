"""Finite elements name 0.4999 as the largest nu they take; laws, rods and bars, which know no volume, take 0.5."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fe_contact import run
from fe_contact.assembly.forms import LARGEST_NU
from fe_contact.cli import main
from lumped import Scene
from lumped.errors import BadInput

REFUSED = ["run", "compare", "tradeoff", "indent --depths=1e-5"]
MESHED = ["polymer-sphere", "polymer-punch", "polymer-half-plane", "polymer-layer", "two-spheres", "polymer-o-ring"]
WAVES = ["polymer-sphere-waves", "polymer-layer-waves", "steel-on-steel-waves", "two-finite-spheres-waves"]


def told(capsys: pytest.CaptureFixture[str], command: str, *arguments: str) -> tuple[int, str, str]:
    """Exit code, stdout and stderr."""
    code = main([*command.split()[:1], *arguments, *command.split()[1:]])
    return code, *capsys.readouterr()


@pytest.mark.parametrize(
    ("command", "name"),
    [(command, name) for name in MESHED for command in REFUSED]
    + [(command, name) for name in WAVES for command in ("run", "plan", "compare")]
    + [("plan", "polymer-o-ring"), ("plan", "two-finite-spheres")],
)
@pytest.mark.parametrize("nu", ["0.5", "0.49990001"])
def test_a_mesh_refuses_by_key_value_range_and_cure(
    command: str, name: str, nu: str, empty: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = told(capsys, command, name, "--set", f"target.material.nu={nu}")
    assert (code, out) == (2, "")
    assert err.startswith(f"--set: target.material.nu: {nu}: finite elements take it above -1 and up to 0.4999;")
    assert "--method ting" in err
    assert len(err.splitlines()) == 1
    assert not list(empty.iterdir())


@pytest.mark.parametrize("name", ["polymer-prism", "polymer-plate", "steel-ball-flight-waves"])
def test_the_strikers_key_is_named_where_it_is_meshed(name: str) -> None:
    with pytest.raises(BadInput, match=rf"^{name}\.toml: striker\.material\.nu: 0\.5: finite elements"):
        run(Scene.load(name, {"striker.material.nu": 0.5}))


def test_the_largest_nu_is_taken() -> None:
    found = run(Scene.load("polymer-sphere", {"target.material.nu": LARGEST_NU}), tolerance=1e-2)
    assert found.converged


def test_a_bulk_modulus_that_takes_all_digits_is_refused(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of a fluid whose shear is nothing beside it, pressed at once."""
    fluid = [f"target.material={{law='maxwell', E=1e3, eta=1e3, nu=0.4, constant='bulk', bulk_modulus={bulk}}}"
             for bulk in ("1e16", "1e8")]  # fmt: skip
    wanted = [(2, "--set: target.material.bulk_modulus: as stiff"), (0, "")]
    for material, (code, said) in zip(fluid, wanted, strict=True):
        command = "indent --depths=1e-5 --instant --quiet"
        found, _, err = told(capsys, command, "polymer-layer", "--set", material)
        assert found == code, err
        assert said in err


@pytest.mark.family
@pytest.mark.parametrize("name", ["rod", "concrete-pole", "bar-impact"])
def test_waves_along_one_line_know_no_nu(name: str) -> None:
    """Their mesh is a line; a rod's dent is the half-space's closed form, softer as E* falls."""
    part = "striker" if name == "bar-impact" else "target"
    peaks = []
    for nu in (0.5 - 1e-9, 0.5):
        found = run(Scene.load(name, {f"{part}.material.nu": nu}), tolerance=1e-2)
        assert found.converged
        peaks.append(found.quantities["peak_force"].value)
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)


def test_a_plan_has_its_ledger_and_says_who_refuses(capsys: pytest.CaptureFixture[str]) -> None:
    """The exact row of springs places mesh and steps, and the ledger is for laws too."""
    at_limit = ("polymer-sphere", "--set", "target.material.nu=0.5")
    code, out, err = told(capsys, "plan", *at_limit)
    assert code == 0
    assert "finite strain" in out
    assert err.startswith("fe-contact: polymer-sphere.toml: target.material.nu: 0.5: finite elements")
    _, out, _ = told(capsys, "plan --json", *at_limit)
    assert "finite elements" in json.loads(out)["refused"]
    _, out, err = told(capsys, "plan --json", "polymer-sphere")
    assert (json.loads(out)["refused"], err) == (None, "")


@pytest.mark.parametrize("method", ["ting", "mdr", "correspondence", "cheapest"])
def test_methods_that_know_the_answer_give_it(method: str, empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A step of 1e-6 below changes E* = E/(1 - nu^2), and so the peak, by less than that."""
    peaks = []
    for nu in ("0.5", "0.499999"):
        command = f"run --json --quiet --tolerance=1e-4 --method={method}"
        code, out, _ = told(capsys, command, "polymer-sphere", "--set", f"target.material.nu={nu}")
        assert code == 0
        peaks.append(json.loads(out)["quantities"]["peak_force"]["value"])
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-6)
    assert peaks[0] > peaks[1]
