"""The command line in-process: exit codes, one line a fault, nothing written on bad input, honest files."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_contact.cli import main
from fe_contact.commands import COMMANDS
from fe_contact.commands.base import check_writable
from fe_contact.reference import check
from fe_contact.steppers import scaled_surface
from fe_contact.targets import half_space
from lumped import BadInput, Scene, laws
from lumped.schema.files import SCENES
from meshes import session
from meshes.errors import APT_LINE, GmshMissing

ROOT = Path(__file__).resolve().parents[2]
SCENE = """
name = "mine"
[striker]
shape = "sphere"
radius = 0.01
mass = 0.02
velocity = 0.5
[target]
shape = "half_space"
[target.material]
law = "sls"
E1 = 2e6
E2 = 1e6
C1 = 900.0
nu = 0.3
"""
HEADER = ["time_s", "depth_m", "velocity_m_per_s", "force_N", "contact_radius_m", "force_error_N"]
QUANTITIES = {"peak_force", "peak_time", "peak_depth", "duration", "restitution", "impulse", "history_l2"}
ENERGIES = {"in", "out", "stored", "viscous", "radiated", "contact", "numerical", "residual"}


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "mine.toml"
    path.write_text(SCENE)
    return path


def exit_code(*arguments: str) -> int:
    try:
        return main(list(arguments))
    except SystemExit as stop:  # argparse
        return int(stop.code or 0)


def is_empty(folder: Path) -> bool:
    return not list(folder.iterdir())


def contents(folder: Path) -> dict[str, Any]:
    def refuse(word: str) -> None:
        raise AssertionError(f"{word} in result.json")

    found: dict[str, Any] = json.loads((folder / "result.json").read_text(), parse_constant=refuse)
    return found


# bad input

BAD_VALUES = [
    (f"{key}={value}", key)
    for key in ("striker.radius", "striker.mass", "striker.velocity", "target.material.E1", "target.material.C1")
    for value in ("-1.0", "0.0", "nan", "inf", "-inf", '"heavy"', "true", "[1.0]", "1e300")
]
BAD_SCENES = [
    *BAD_VALUES,
    ("target.material.nu=0.5", "target.material.nu"),
    ("target.material.nu=-1.0", "target.material.nu"),
    ("target.material.nu=nan", "target.material.nu"),
    ("target.material.law=rubber", "target.material.law"),
    ("target.shape=moon", "target.shape"),
    ("striker.shape=spere", "sphere"),
    ("striker.raduis=0.1", "did you mean radius"),
    ("stricker.radius=0.1", "striker"),
    ("model.inertia=true", "model.inertia"),
    ("model.inertia=true", "target.material.density"),
    ("model.gravity=inf", "model.gravity"),
    ("model.profile=round", "model.profile"),
    ("motion.end_time=0.0", "motion.end_time"),
    ("motion.end_time=-1.0", "motion.end_time"),
    ("striker.velocity=1e4", "striker.velocity"),
    ("numerics.steps=0", "numerics.steps"),
    ("numerics.steps=40.5", "numerics.steps"),
    ("numerics.order=7", "numerics.order"),
    ("numerics.penalty=-5.0", "numerics.penalty"),
    ("numerics.far_radius=nan", "numerics.far_radius"),
    ("numerics.elements_per_contact=1e9", "numerics.elements_per_contact"),
    ("numerics.scheme=galrkin", "did you mean galerkin"),
    ("numerics.stpes=40", "did you mean steps"),
    ("numerics.tolerance=0.0", "numerics.tolerance"),
]


@pytest.mark.parametrize(("override", "named"), BAD_SCENES)
def test_bad_input_is_one_line_that_names_the_key(
    override: str, named: str, empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_code("run", str(scene), "--set", override) == 2
    out, err = capsys.readouterr()
    assert out == ""
    lines = err.strip().splitlines()
    assert 1 <= len(lines) <= 3
    assert any(named in line for line in lines), err
    assert "Traceback" not in err
    assert is_empty(empty)


@pytest.mark.parametrize("tolerance", ["0", "-1e-3", "nan", "inf", "tight", "1e-20"])
@pytest.mark.parametrize("command", ["run", "plan"])
def test_a_bad_tolerance_is_refused(
    command: str, tolerance: str, empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_code(command, str(scene), f"--tolerance={tolerance}") == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
    assert is_empty(empty)


def test_all_faults_are_told_at_once_physics_and_numerics_alike(
    empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = ["striker.mass=-1", "target.material.nu=0.7", "striker.colour=1", "numerics.steps=0"]
    arguments = [part for override in wrong for part in ("--set", override)]
    assert exit_code("run", str(scene), *arguments) == 2
    err = capsys.readouterr().err
    for key in ("striker.mass", "target.material.nu", "striker.colour", "numerics.steps"):
        assert sum(key in line for line in err.splitlines()) == 1, f"{key} in\n{err}"
    assert is_empty(empty)


def test_no_more_than_twenty_faults_are_told(empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [part for k in range(30) for part in ("--set", f"striker.unknown{k}=1")]
    assert exit_code("run", str(scene), *arguments) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 20
    assert is_empty(empty)


UNREADABLE = [b"\xff\xfe\x00broken", b"[striker\nradius = ", b"", b"[striker]\nmass = 1\nmass = 2\n"]


@pytest.mark.parametrize("content", UNREADABLE)
def test_an_unreadable_file_is_bad_input(content: bytes, empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = empty.parent / "broken.toml"
    path.write_bytes(content)
    assert exit_code("run", str(path)) == 2
    err = capsys.readouterr().err
    assert "broken.toml" in err
    assert "Traceback" not in err
    assert is_empty(empty)


@pytest.mark.parametrize("name", ["nowhere.toml", "polymer-spere", ".", "no/such/folder.toml"])
def test_a_scene_that_is_not_there_is_bad_input(name: str, empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code("run", name) == 2
    err = capsys.readouterr().err
    assert len(err.strip().splitlines()) == 1
    assert name != "polymer-spere" or "did you mean polymer-sphere" in err
    assert is_empty(empty)


@pytest.mark.parametrize("arguments", [["run"], ["fly", "steel-ball"], [], ["run", "steel-ball", "--frobnicate"]])
def test_a_wrong_command_line_is_bad_input(arguments: list[str], empty: Path) -> None:
    assert exit_code(*arguments) == 2
    assert is_empty(empty)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("rum polymer-sphere", "fe-contact: rum: no command; did you mean run?; see fe-contact --help"),
        (
            "run polymer-sphere --tolerence=1e-2",
            "fe-contact run: --tolerence=1e-2: no option of this command; did you mean --tolerance?; "
            "see fe-contact run --help",
        ),
        ("run a b", "fe-contact run: b: a word more than this command takes; see fe-contact run --help"),
    ],
)
def test_a_misspelt_word_leads_to_the_one_it_resembles(
    line: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_code(*line.split()) == 2
    assert capsys.readouterr().err == f"{said}\n"


def test_a_command_loads_no_other_one(tmp_path: Path) -> None:
    """Thirty of them, and all their words, would cost more than a law does."""
    code = (
        "import sys; from fe_contact.cli import main; main(sys.argv[1:]);"
        "print(*(name for name in sys.modules if name.startswith('fe_contact.commands.')))"
    )
    words = ["run", "steel-ball-sls", "--method", "hertz", "--out", str(tmp_path), "--quiet"]
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, check=True)
    assert set(done.stdout.splitlines()[-1].split()) == {"fe_contact.commands.base", "fe_contact.commands.run"}


def test_an_unknown_method_names_the_nearest(empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code("run", str(scene), "--method", "mrd") == 2
    assert "did you mean mdr" in capsys.readouterr().err
    assert is_empty(empty)


def test_an_output_that_cannot_be_written_is_bad_input(
    empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    occupied = empty.parent / "file"
    occupied.write_text("here already")
    assert exit_code("run", str(scene), "--method", "mdr", "--out", str(occupied)) == 2
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
    assert occupied.read_text() == "here already"


@pytest.mark.parametrize(
    ("where", "why"),
    [("file", "it is a file"), ("file/sub", "cannot be written: Not a directory"), ("a\nb", "no printable name"),
     ("n" * 300, "cannot be written: File name too long"), ("a\0b", "no name of a folder")],
)  # fmt: skip
def test_a_folder_that_cannot_be_written_says_why(where: str, why: str, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(BadInput, match=why):
        check_writable(tmp_path / where)


@pytest.mark.parametrize(
    ("failure", "cure"),
    [
        (GmshMissing("libGLU.so.1: cannot open shared object file: No such file or directory"), APT_LINE),
        (ModuleNotFoundError("No module named 'gmsh'", name="gmsh"), "gmsh is not installed; cure: pip install"),
    ],
)
def test_what_is_not_installed_is_named_with_its_cure(
    failure: Exception,
    cure: str,
    empty: Path,
    scene: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def missing() -> Any:
        raise failure

    monkeypatch.setattr(session, "_load", missing)
    half_space._surface.cache_clear()
    assert exit_code("run", str(scene)) == 2
    err = capsys.readouterr().err
    assert len(err.strip().splitlines()) == 1
    assert cure in err
    assert is_empty(empty)


# failures that are not the user's


def test_a_tolerance_that_cannot_be_reached_is_exit_three_with_what_was_reached(
    empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pins = ["numerics.steps=16", "numerics.elements_per_contact=1.0", "numerics.order=2", "numerics.penalty=30.0"]
    arguments = [part for pin in pins for part in ("--set", pin)]
    assert exit_code("run", str(scene), "--tolerance", "1e-4", *arguments, "--out", "found") == 3
    result = contents(empty / "found")
    assert result["converged"] is False
    assert result["quantities"]["peak_force"]["error"] > 1e-4 * result["quantities"]["peak_force"]["value"]
    assert (empty / "found" / "history.csv").exists()
    said = capsys.readouterr()
    assert len([line for line in said.err.splitlines() if "not reached" in line]) == 1
    assert "not reached" not in said.out, "said once"


def test_a_solve_that_does_not_converge_is_exit_three_without_a_traceback(
    empty: Path, scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(scaled_surface, "RESCALINGS", 0)
    assert exit_code("run", str(scene)) == 3
    err = capsys.readouterr().err
    assert len(err.strip().splitlines()) == 1
    assert "cure" in err


def test_a_defect_of_ours_is_one_line_and_a_file(
    empty: Path, scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def broken(*_: Any) -> Any:
        raise RuntimeError("a wire came loose")

    monkeypatch.setattr("fe_contact.reference.certify", broken)
    assert exit_code("run", str(scene), "--out", "found") == 1
    err = capsys.readouterr().err
    assert len(err.strip().splitlines()) == 1
    assert "a wire came loose" in err
    assert "Traceback" in (empty / "found" / "crash.txt").read_text()


def test_an_interrupt_is_exit_130(empty: Path, scene: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: Any) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr("fe_contact.reference.certify", interrupted)
    assert exit_code("run", str(scene)) == 130


# what is written


@pytest.mark.parametrize("method", ["fe", "cheapest", "mdr"])
def test_run_writes_what_the_interface_says(
    method: str, empty: Path, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_code("run", str(scene), "--method", method, "--json", "--quiet") == 0
    out, err = capsys.readouterr()
    folder = empty / "fe-contact-out" / "run-mine"
    result = contents(folder)
    assert json.loads(out) == result
    assert "Traceback" not in err
    assert result["schema"] == "fe-contact/result/1"
    assert set(result["quantities"]) == QUANTITIES
    assert set(result["energy"]) == ENERGIES
    assert result["converged"] is result["separated"] is True
    if method == "fe":
        assert set(result["error_budget"]) == {"mesh", "penalty", "time_step", "far_field"}
        assert all(sum(result["error_budget_by_quantity"][q].values()) > 0 for q in QUANTITIES)
    with (folder / "history.csv").open() as file:
        rows = list(csv.reader(file))
    assert rows[0][:6] == HEADER
    table = np.array(rows[1:], dtype=float)
    time, depth, velocity, force, radius, _ = table.T[:6]
    value = {name: q["value"] for name, q in result["quantities"].items()}
    assert len(table) >= 201
    assert np.all(np.diff(time) > 0)
    assert time[0] == depth[0] == 0
    assert velocity[0] == pytest.approx(0.5, rel=1e-9)
    assert time[-1] == pytest.approx(value["duration"], rel=1e-9)
    assert -velocity[-1] / 0.5 == pytest.approx(value["restitution"], rel=1e-6)
    assert force[-1] == pytest.approx(0, abs=1e-3 * force.max())
    assert np.all(radius >= 0)
    for rows_say, quantity in ((force.max(), "peak_force"), (depth.max(), "peak_depth")):
        assert rows_say == pytest.approx(value[quantity], rel=1e-3)
    assert np.trapezoid(force, time) == pytest.approx(value["impulse"], rel=1e-3)
    assert value["impulse"] == pytest.approx(0.02 * 0.5 * (1 + value["restitution"]), rel=1e-6)


def test_the_written_scene_gives_the_same_result_again(empty: Path, scene: Path) -> None:
    assert exit_code("run", str(scene), "--out", "first", "--quiet") == 0
    first = contents(empty / "first")
    from fe_contact import run
    from lumped import Scene

    again = run(Scene.from_dict(first["scene"]), first["tolerance"])
    for name, quantity in first["quantities"].items():
        assert again.quantities[name].value == pytest.approx(quantity["value"], rel=1e-9)


def test_settings_take_precedence_as_promised(empty: Path, scene: Path) -> None:
    """--set over --tolerance over the file's table over the plan."""
    scene.write_text(SCENE + "[numerics]\ntolerance = 0.05\norder = 3\n")

    def used(*arguments: str) -> dict[str, Any]:
        assert exit_code("run", str(scene), "--out", "found", "--quiet", *arguments) == 0
        numerics: dict[str, Any] = contents(empty / "found")["numerics"]
        return numerics

    assert used()["tolerance"] == 0.05
    assert used()["order"] == 3
    assert used("--tolerance", "0.02")["tolerance"] == 0.02
    assert used("--tolerance", "0.02", "--set", "numerics.tolerance=0.01")["tolerance"] == 0.01
    assert used("--set", "numerics.order=2")["order"] == 2


def test_fields_and_plot_write_files_that_can_be_read(empty: Path, scene: Path) -> None:
    import meshio

    assert exit_code("run", str(scene), "--fields", "--plot", "--out", "found", "--quiet") == 0
    fields = list((empty / "found").glob("*.vtu"))
    assert len(fields) == 1
    mesh = meshio.read(fields[0])
    assert len(mesh.points) > 100
    assert all(np.isfinite(values).all() for values in mesh.point_data.values())
    charts = {path.suffix for path in (empty / "found").iterdir()}
    assert {".svg", ".png"} <= charts


def test_plan_says_settings_and_ledger_and_solves_nothing(
    empty: Path, scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_: Any) -> Any:
        raise AssertionError("plan solved something")

    monkeypatch.setattr(half_space, "surface", refuse)
    assert exit_code("plan", str(scene), "--json", "--tolerance", "1e-4") == 0
    told = json.loads(capsys.readouterr().out)
    assert told["numerics"]["tolerance"] == 1e-4
    assert {"effect", "treated", "estimate", "note"} <= set(told["model_ledger"][0])
    assert exit_code("plan", str(scene)) == 0
    assert "elements_per_contact" in capsys.readouterr().out
    assert is_empty(empty)


def test_plan_names_the_key_of_a_mesh_that_waves_cannot_have(capsys: pytest.CaptureFixture[str]) -> None:
    """Laws can follow it all the same, so that there is a plan."""
    sets = ("--set", "model.profile=parabola", "--set", "motion.end_time=1e-15")
    assert exit_code("plan", "ball-bouncing-waves", *sets, "--tolerance", "1e-6") == 0
    out, err = capsys.readouterr()
    assert "left out" in out
    assert "numerics.tolerance, numerics.elements_per_contact: " in err


@pytest.mark.tenth
def test_plan_says_from_which_depth_a_material_softens(capsys: pytest.CaptureFixture[str]) -> None:
    """As a run would: there is a plan by laws all the same."""
    sets = ("--set", "target.material.hyperelastic=st_venant_kirchhoff", "--set", "striker.velocity=0.5")
    assert exit_code("plan", "rubber-layer-finite", *sets) == 3
    out, err = capsys.readouterr()
    assert "left out" in out
    assert "m on the material softens" in err


@pytest.mark.parametrize(
    ("name", "setting"),
    [
        ("two-finite-spheres", "motion.impacts=2"),
        ("polymer-o-ring", "motion.impacts=2"),
        ("rubber-layer-bulk", "motion.impacts=2"),
        ("polymer-plate", "striker.material={law='sls', E0=6e5, R1=0.5, R2=0.01, nu=0.45, constant='bulk'}"),
        ("steel-ball-flight-waves", "motion.impacts=2"),
        ("polymer-sphere-waves", "striker.velocity=8"),
        ("polymer-sphere-waves", "striker.shape=punch"),
        ("polymer-sphere-finite", "motion.impacts=2"),
        ("steel-ball-plastic", "numerics.enforcement=exact"),
    ],
)
def test_a_plan_says_why_a_run_is_refused(name: str, setting: str, capsys: pytest.CaptureFixture[str]) -> None:
    """The one line of the run, whether a law may follow the scene all the same or none can."""
    key, reasons = setting.partition("=")[0], []
    for command, codes in (("run", {2}), ("plan", {0, 2})):
        assert exit_code(command, name, "--set", setting) in codes
        reasons.append(capsys.readouterr().err.partition(f": {key}")[2])
    assert reasons[0] == reasons[1]
    assert reasons[0].count("\n") == 1


def test_contacts_follow_one_another_where_one_surface_remembers() -> None:
    """Under a flat end, and where two bodies are taken as half-spaces, one surface is all that there is."""
    for name in ("polymer-prism", "polymer-washer", "two-spheres", "rod-in-ring", "polymer-layer"):
        check(Scene.load(name, {"motion.impacts": 2}), {})


def test_plan_speaks_first_of_the_cheapest_method(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Of an exact law where one meets the tolerance, by its own bar; of finite elements where none knows the model."""
    for name, method in ((str(scene), "ting"), ("polymer-layer", "ting"), ("paper-steel-hertz", "hertz")):
        assert exit_code("plan", name, "--json") == 0
        told = json.loads(capsys.readouterr().out)["method"]
        assert told["name"] == method
        assert 0.0 < told["bar"] <= 1e-3
        assert exit_code("plan", name) == 0
        assert method in capsys.readouterr().out.splitlines()[0]
    assert exit_code("plan", "steel-ball-waves", "--json") == 0
    method = json.loads(capsys.readouterr().out)["method"]
    assert method["name"] == "fe"
    assert method["bar"] == 3e-3  # what is asked of waves
    assert method["cpu_s"] > 0.3


@pytest.mark.parametrize("name", COMMANDS.names)
def test_every_command_explains_itself(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code(name, "--help") == 0
    assert name in capsys.readouterr().out


@pytest.mark.parametrize("name", [c for c in COMMANDS.names if c not in ("laws", "scenes")])
def test_every_command_that_takes_a_scene_refuses_a_bad_one(
    name: str, empty: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_code(name, "nowhere.toml") == 2
    assert "Traceback" not in capsys.readouterr().err
    assert is_empty(empty)


def test_scenes_and_laws_list_one_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code("scenes") == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(SCENES.names)
    assert exit_code("laws") == 0
    assert {"mdr", "ting"} <= {line.split()[0] for line in capsys.readouterr().out.splitlines()}


def test_scenes_and_laws_are_machine_readable(capsys: pytest.CaptureFixture[str]) -> None:
    assert exit_code("scenes", "--json") == 0
    tables = json.loads(capsys.readouterr().out)
    assert {name: Scene.from_dict(table, name).to_dict() for name, table in tables.items()} == tables
    assert list(tables) == list(SCENES.names)
    assert exit_code("laws", "--json") == 0
    assert list(json.loads(capsys.readouterr().out)) == list(laws.available())


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--help"])
    assert ended.value.code == 0
    assert set(COMMANDS.names) - {"base"} <= set(capsys.readouterr().out.split())


def test_the_module_runs_as_a_process(empty: Path) -> None:
    """The one subprocess: exit code and streams as a shell sees them."""
    command = [sys.executable, "-m", "fe_contact", "run", "steel-ball", "--set", "striker.mass=-1"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "striker.mass" in done.stderr
    assert "Traceback" not in done.stderr
