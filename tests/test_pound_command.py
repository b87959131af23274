"""`fe-contact pound` in-process: its file, its exit codes, what it writes and what it refuses."""

from __future__ import annotations

import csv
import json
import re
import tomllib
from collections.abc import Callable
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fe_contact
from fe_contact.cli import main
from fe_contact.commands.base import FILE_KEYS
from fe_contact.studies.pound.calibration import calibrated_study
from fe_contact.studies.pound.chart import plot_study
from lumped import Scene, laws, simulate
from lumped.errors import BadInput
from lumped.laws._power_law import PowerLaw
from lumped.materials.networks import NETWORKS
from lumped.pounding import march
from lumped.pounding import simulate as simulate_frames
from lumped.pounding import study as studies
from lumped.pounding.case_file import CASES, GRAVITY, GROUNDS, SCENE_KEY, PoundingReader, load, read
from lumped.pounding.ground import GroundRecord
from lumped.pounding.study import NO_CONTACT, study
from lumped.scene.tables import LAWS
from lumped.schema.csv_file import read_columns
from lumped.schema.keys import File
from lumped.shapes import SHAPES
from lumped.targets import TARGETS

SHORT = ["--set", "motion.end_time=2.0", "--quiet"]
CASE: dict[str, Any] = {
    "structure": {
        "left": {"mass": [2e4, 1e4], "stiffness": [1e7, 8e6], "damping_ratio": 0.05, "velocity": [0.3, 0.5]},
        "right": {"mass": [3e4], "stiffness": [4e6]},
    },
    "gap": {"floor": {"left": 1, "right": 1, "distance": 0.003}},
    "law": {"name": "kelvin", "k": 1e8, "e": 0.6, "velocity": 0.3},
    "motion": {"end_time": 1.0},
}

SLAB = {"structure": "left", "storey": 1, "length": 20.0, "modulus": 3e10, "density": 2500.0}
FLOORS = """
striker = {shape = "sphere", radius = 2.0, mass = 1.0, velocity = 1.0}
target = {shape = "half_space", material = {law = "sls", E0 = 3e10, R1 = 0.5, R2 = 0.005, nu = 0.2}}
"""


def changed(key: str, value: object) -> dict[str, Any]:
    """The case with a dotted key set, or taken out when the value is None."""
    table: dict[str, Any] = json.loads(json.dumps(CASE))
    *path, last = key.split(".")
    place = table
    for part in path:
        place = place.setdefault(part, {})
    if value is None:
        del place[last]
    else:
        place[last] = value
    return table


@pytest.mark.tenth
def test_what_is_written_belongs_together(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pound", "two-frames", "--laws", "hertz", "--json", *SHORT, "--out", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    written = json.loads((tmp_path / "pound.json").read_text(encoding="utf-8"))
    assert json.loads(out) == written
    assert {path.name for path in tmp_path.iterdir()} == {
        "response.csv", "response-hertz.csv", "contacts.csv", "pound.json", "pound.svg", "pound.png"
    }  # fmt: skip
    assert written["converged"]
    assert list(written["laws"]) == ["kelvin", "hertz"]
    with (tmp_path / "contacts.csv").open(encoding="utf-8", newline="") as file:
        contacts = list(csv.DictReader(file))
    for name, motion in written["laws"].items():
        own, measures, energy = [one for one in contacts if one["law"] == name], motion["measures"], motion["energy"]
        assert len(own) == measures["contacts"]["value"] == sum(gap["contacts"] for gap in motion["gaps"].values()) > 0
        assert max(float(one["peak_force_N"]) for one in own) == measures["peak_force"]["value"]
        assert measures["peak_drift"]["value"] == max(storey["drift"] for storey in motion["storeys"].values())
        assert 0.0 < measures["peak_force"]["error"] < 1e-6 * measures["peak_force"]["value"]
        assert abs(energy["residual"]) < 1e-8 * abs(energy["input"])
        spent = energy["damping"] + energy["contact"] + energy["contact_stored"] + energy["kinetic"] + energy["strain"]
        assert energy["initial"] + energy["input"] == pytest.approx(spent, rel=1e-8)
    names = ["time_s", "left_3_drift_m", "left_2_displacement_m", "left_3_displacement_m", "second_force_N"]
    rows = read_columns(tmp_path / "response.csv", tuple(names))
    assert rows["left_3_drift_m"] == pytest.approx(rows["left_3_displacement_m"] - rows["left_2_displacement_m"])
    peak = written["laws"]["kelvin"]["storeys"]["left_3"]["drift"]
    assert 0.98 * peak < np.abs(rows["left_3_drift_m"]).max() <= peak  # rows stand apart by a sixth of a period
    assert rows["time_s"][[0, -1]] == pytest.approx([0.0, 2.0])


def test_a_record_is_read_in_both_units_from_its_folder(tmp_path: Path) -> None:
    times, values = np.array([5.0, 5.1, 5.3]), np.array([0.0, 0.2, -0.1])
    for column, unit in (("acceleration_g", GRAVITY), ("acceleration_m_per_s2", 1.0)):
        lines = [f"{t},{a}" for t, a in zip(times, values, strict=True)]
        (tmp_path / "quake.csv").write_text("\n".join([f"time_s,{column}", *lines]), encoding="utf-8")
        case = read(CASE | {"ground": {"kind": "record", "file": "quake.csv", "scale": 2.0}}, folder=tmp_path)
        assert isinstance(case.ground, GroundRecord)
        assert case.ground.times == pytest.approx(times - 5.0)
        assert case.ground.values == pytest.approx(2.0 * unit * values)


def test_other_laws_push_as_hard_as_the_own_one_in_an_elastic_impact() -> None:
    case = read(CASE)
    assert case.law is not None
    (gap,) = case.frames.gaps.values()
    mass, speed = case.frames.reduced_mass(gap), 0.3
    for name in ("hertz", "jankowski", "tsuji", "linear_spring"):
        (law,) = case.laws(name)
        assert isinstance(law, PowerLaw)
        energy = 0.5 * mass * speed**2
        depth = ((law.alpha + 1.0) * energy / law.k) ** (1.0 / (law.alpha + 1.0))
        assert law.k * depth**law.alpha == pytest.approx(speed * np.sqrt(1e8 * mass), rel=1e-12)
    assert case.laws("kelvin") == case.laws()


def test_storeys_may_meet_with_the_shapes_and_materials_of_a_scene(tmp_path: Path) -> None:
    """The paper's law: its first contact is about the impact of the two storeys alone."""
    (tmp_path / "floors.toml").write_text(FLOORS, encoding="utf-8")
    law = {"name": "correspondence", "scene": "floors.toml"}
    found = study(read(changed("law", law), folder=tmp_path))
    assert found.message == ""
    own = found.main.contacts[0]
    frames = found.case.frames
    (gap,) = frames.gaps.values()
    left, right = frames.masses_at(gap)
    storeys = {"striker.mass": left, "target.mass": right, "striker.velocity": own.closing}
    alone = Scene.load(tmp_path / "floors.toml", storeys)
    impact = simulate(laws.correspondence.of(alone), alone, 1e-4)
    # the columns push a little in the 9 ms of a contact
    assert own.peak_force == pytest.approx(impact.quantities["peak_force"].value, rel=0.02)


@pytest.mark.family
@pytest.mark.parametrize("by", ["restitution", "least_squares"])
def test_a_law_calibrated_on_its_own_impact_moves_the_structures_as_it_does(by: str, tmp_path: Path) -> None:
    """Hunt and Crossley's of this material is the reference of both laws: the other one is what changes."""
    (tmp_path / "floors.toml").write_text(FLOORS, encoding="utf-8")
    law = {"name": "hunt_crossley", "scene": "floors.toml", "velocity": 0.3}
    case = read(changed("law", law) | {"motion": {"end_time": 0.4}}, folder=tmp_path)
    found = calibrated_study(case, ["hertz"], by, "hunt_crossley")
    ours = found.study.main.measures()
    assert ours == pytest.approx(simulate_frames(case.frames, case.laws(), case.ground, 0.4).measures(), rel=1e-6)
    assert ours["contacts"] > 0
    assert found.choice["hertz"]["impulse"] > 100.0 * found.bars["impulse"] > 0.0
    other = found.study.motions["hertz"].result.measures()
    assert found.choice["hertz"] == {name: other[name] - ours[name] for name in ours}


@pytest.mark.tenth
def test_finite_elements_stand_beside_the_laws_that_are_calibrated_on_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The law of the paper is exact but for the rebound, and known by its material: fitted, it is what it was."""
    (tmp_path / "floors.toml").write_text(FLOORS, encoding="utf-8")
    text = CASES.path("wall-pulse").read_text(encoding="utf-8")
    law = '[law]\nname = "correspondence"\nscene = "floors.toml"\nvelocity = 0.3\n'
    before, rest = text.partition("[law]")[0], text.partition("[ground]")[2]
    (tmp_path / "case.toml").write_text(f"{before}{law}[ground]{rest}", encoding="utf-8")
    command = ["pound", str(tmp_path / "case.toml"), "--set", "motion.end_time=1.0", "--quiet", "--json"]
    assert main([*command, "--calibrate", "least_squares", "--laws", "hertz", "--out", str(tmp_path / "out")]) == 0
    written = json.loads(capsys.readouterr().out)["calibration"]
    (reference,) = written["references"].values()
    assert reference["method"] == "fe"
    assert 0.0 < reference["peak_force"]["error"] < 2e-3 * reference["peak_force"]["value"]
    own = written["laws"]["correspondence"]["wall"]
    assert own["parameters"] == pytest.approx({"R1": 0.5, "R2": 0.005}, rel=0.2)
    assert own["normalized_error"] < 0.2 * written["laws"]["hertz"]["wall"]["normalized_error"]
    assert set(written["choice"]) == {"hertz"}


@pytest.mark.parametrize(
    ("law", "by", "message"),
    [
        ({"name": "hertz", "k": 1e9, "velocity": 0.3}, "least_squares", "law.scene: missing"),
        ({"name": "hertz", "scene": "floors.toml"}, "least_squares", "law.velocity: missing"),
        ({"name": "hertz", "scene": "floors.toml", "velocity": 0.3}, "peak", "--calibrate: 'peak': accepted least_sq"),
        ({"name": "ting", "scene": "floors.toml", "velocity": 0.3}, "least_squares", "ting is no force between"),
    ],
)
def test_what_cannot_be_calibrated_is_said_before_any_work(
    law: dict[str, Any], by: str, message: str, tmp_path: Path
) -> None:
    (tmp_path / "floors.toml").write_text(FLOORS, encoding="utf-8")
    reader = PoundingReader("case", changed("law", law), tmp_path)
    with pytest.raises(BadInput, match=message):
        calibrated_study(reader.case(), [], by, "no such method")


@pytest.mark.tenth
def test_an_odd_case_is_written_too(tmp_path: Path) -> None:
    """Without a gap, and without a contact."""
    found = study(read(changed("gap.floor.distance", 5.0)))
    assert found.main.contacts == ()
    assert found.main.measures() == pytest.approx(found.apart.measures(), rel=1e-12)
    assert study(read(changed("gap", None))).main.measures() == found.apart.measures()
    plot_study(found, tmp_path)


@pytest.mark.tenth
def test_the_chart_is_reproducible(tmp_path: Path) -> None:
    found = study(read(CASE), ["hertz"])
    for name in ("first", "again"):
        plot_study(found, tmp_path / name)
    first, again = (sorted((tmp_path / name).iterdir()) for name in ("first", "again"))
    assert len(first) == 2
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]


@pytest.mark.tenth
def test_a_motion_that_is_not_known_so_long_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
                                                    capsys: pytest.CaptureFixture[str]) -> None:  # fmt: skip
    monkeypatch.setattr(studies, "MOST_ERROR", 0.0)
    assert main(["pound", "two-frames", *SHORT, "--out", str(tmp_path)]) == 3
    assert "kelvin: the peak force changes" in capsys.readouterr().err
    assert not json.loads((tmp_path / "pound.json").read_text(encoding="utf-8"))["converged"]


def test_a_motion_that_cannot_be_followed_leaves_what_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(march, "MOST_STEPS", 3)
    assert main(["pound", "wall-pulse", *SHORT, "--out", str(tmp_path)]) == 3
    assert "motion.end_time" in capsys.readouterr().err
    known = json.loads((tmp_path / "pound.json").read_text(encoding="utf-8"))
    assert not known["converged"]
    assert known["case"]["gap"]["wall"]["distance"] == 0.01


# the file


@pytest.mark.parametrize("name", CASES.names)
def test_a_packaged_case_is_read_and_its_record_is_the_formula_in_its_file(name: str) -> None:
    case = load(name)
    assert case.name == name
    if isinstance(case.ground, GroundRecord):
        formula = re.search(r"a\(t\) = (.*)", CASES.path(name).read_text(encoding="utf-8"))
        assert formula is not None
        said = re.sub(r"(\d) (?=[a-z\d])", r"\1 * ", formula[1].replace("^", "**").replace(") sin", ") * sin"))
        value = eval(said.replace("pi t", "pi*t").replace("pi 1", "pi*1").replace("pi 3", "pi*3"),
                     {"exp": np.exp, "sin": np.sin, "pi": np.pi, "t": case.ground.times})  # fmt: skip
        assert case.ground.values == pytest.approx(value, abs=1e-6)


def test_the_file_of_the_manual_is_accepted() -> None:
    text = Path(fe_contact.__file__).with_name("manual").joinpath("pounding.md").read_text(encoding="utf-8")
    whole, slab, calibrated = (part.partition("```")[0] for part in text.split("```toml")[1:])
    case = read(tomllib.loads(whole + slab), folder=CASES.path("two-frames").parent)
    assert case.laws()
    assert case.to_dict()["slab"]["stiffer"]["modes"] == 4
    assert tomllib.loads(calibrated)


BAD: list[tuple[str, object, str]] = [
    ("structure", None, "structure: missing"),
    ("structure.left", None, "structure.left: missing"),
    ("structure.middle", {}, "structure.middle: unknown key"),
    ("structure.left.mass", [2e4, -1.0], "structure.left.mass"),
    ("structure.left.mass", 2e4, "structure.left.mass"),
    ("structure.left.stiffness", [1e7], "structure.left.stiffness: 1 values; accepted: 2"),
    ("structure.left.rayleigh", [0.1, 0.1], "structure.left.rayleigh: given beside damping_ratio"),
    ("structure.left.dampng_ratio", 0.1, "did you mean damping_ratio"),
    ("structure.left.displacement", [0.1, 0.0], "gap.floor.distance: closed by"),
    ("structure.right", [1], "structure.right"),
    ("gap.floor.left", 3, "gap.floor.left: 3; accepted: 1 to 2"),
    ("gap.floor.right", None, "gap.floor.right: missing; accepted: 1 to 1"),
    ("gap.floor.distance", -0.1, "gap.floor.distance"),
    ("gap.floor", 0.1, "gap.floor: not a table"),
    ("gap.$a$", {"left": 1, "right": 1}, r"gap.\$a\$: accepted: a name"),
    ("gap", [], "gap: not a table"),
    ("slab.floor", SLAB | {"storey": 2}, "slab.floor.storey: left_2; accepted: storeys of a gap, .*: left_1, right_1"),
    ("slab", {"one": SLAB, "other": SLAB}, "slab.other.storey: left_1; accepted"),
    ("slab", {"one": SLAB | {"modes": 150}, "b": SLAB | {"structure": "right", "modes": 51}}, "slab.modes: 201 of all"),
    ("slab.floor", SLAB | {"structure": "middle"}, "slab.floor.structure"),
    ("slab.floor", SLAB | {"length": 0.0}, "slab.floor.length"),
    ("slab.floor", SLAB | {"modes": 1}, "slab.floor.modes"),
    ("slab.floor", SLAB | {"speed": 3e3}, "slab.floor.speed: unknown key"),
    ("slab.floor.length", 10.0, "slab.floor.modulus: missing"),
    ("law", None, "law: missing"),
    ("law.name", "kelvn", "did you mean kelvin"),
    ("law", {"name": "correspondence", "scene": "polymer-sphere"}, "law.scene: two storeys meet there: .* sinks in"),
    ("law.scene", "no-scene", "law.scene: no such file, nor a packaged scene"),
    ("law", {"name": "ting"}, "law.name: ting follows from a shape"),
    ("law.k", None, "law.k: missing"),
    ("law.e", 1.5, "law.e"),
    ("law.gap", 0.1, "law.gap: unknown key"),
    ("law", {"name": "hunt_crossley", "k": 1e9, "e": 0.6}, "law.velocity: missing; hunt_crossley takes its numbers"),
    ("ground.kind", "quake", "ground.kind"),
    ("ground", {"kind": "harmonic", "amplitude": 1.0}, "ground.frequency: missing"),
    ("ground", {"kind": "pulse", "amplitude": 1.0, "cycles": 2.0}, "ground.cycles: unknown key"),
    ("ground", {"kind": "record", "file": "no.csv"}, "no.csv: cannot be read"),
    ("motion", None, "motion: missing"),
    ("motion.end_time", 0.0, "motion.end_time"),
    ("damping", 0.1, "unknown key"),
]


@pytest.mark.parametrize(("key", "value", "named"), BAD)
def test_bad_input_is_named(key: str, value: object, named: str) -> None:
    with pytest.raises(BadInput, match=named):
        read(changed(key, value))


@pytest.mark.parametrize(
    ("content", "named"),
    [
        ("time_s,acceleration_m_per_s2\n0,1\n0.1,x\n", "row 2 holds no number"),
        ("time_s,acceleration_m_per_s2\n0,1\n0.1,2\n0.1,3\n", "time_s: row 3 is not later"),
        ("time_s,accel\n0,1\n1,2\n", "acceleration_m_per_s2: missing column"),
        ("time_s,acceleration_g,acceleration_m_per_s2\n0,1,1\n1,2,2\n", "given beside"),
    ],
)
def test_a_faulty_record_is_named(content: str, named: str, tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(content, encoding="utf-8")
    with pytest.raises(BadInput, match=named):
        read(CASE | {"ground": {"kind": "record", "file": "a.csv"}}, folder=tmp_path)


def test_all_faults_are_told_at_once_and_nothing_is_written(refused: Callable[..., list[str]]) -> None:
    wrong = (
        "structure.left.mass=[-1]", "structure.right.colour=1", "gap.first.distance=nan", "law.e=3",
        "ground.kind=quake", "motion.end_time=-1",
    )  # fmt: skip
    faults = refused("pound", "two-frames", *(part for key in wrong for part in ("--set", key)))
    for fault in wrong:
        assert sum(fault.split("=")[0] in line for line in faults) == 1, faults


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["two-frame"], "did you mean two-frames"),
        (["no/such/file.toml"], "cannot be read"),
        (["two-frames", "--set", "motion.end_time=1e8"], "end_time"),
        (["two-frames", "--laws", "hertzz"], "did you mean hertz"),
        (["two-frames", "--laws", "ting"], "ting"),
        (["wall-pulse", "--set", "law={name='kelvin',k=1e8,xi=0.1}", "--laws", "mahmoud"], "law.e"),
        (["two-frames", "--out", "/dev/null/x"], "--out"),
    ],
)
def test_a_refused_command_writes_nothing(arguments: list[str], named: str, refused: Callable[..., list[str]]) -> None:
    (fault,) = refused("pound", *arguments)
    assert named in fault


@pytest.mark.tenth
def test_a_file_of_the_command_line_lies_where_the_user_stands(empty: Path) -> None:
    """And not beside the packaged case; of a key within a table too, and of the ground's record."""
    (empty / "floors.toml").write_text(FLOORS, encoding="utf-8")
    (empty / "quake.csv").write_text("time_s,acceleration_g\n0,0\n0.5,0.1\n1,0\n", encoding="utf-8")
    own = ["--set", "law={name='correspondence',velocity=0.3,scene='floors.toml'}"]
    shaken = ["--set", "ground={kind='record'}", "--set", "ground.file=quake.csv"]
    assert main(["pound", "two-frames", *own, *shaken, *SHORT]) == 0
    every = [one.sets for folder in (SHAPES, TARGETS, NETWORKS, LAWS) for one in folder.members.values()]
    keys = [*GROUNDS.values(), {"scene": SCENE_KEY}, *chain.from_iterable(every)]
    assert {*FILE_KEYS} == {name for one in keys for name, key in one.items() if isinstance(key.kind, File)}


def test_the_variant_without_contact_is_named() -> None:
    assert NO_CONTACT not in load("two-frames").frames.gaps
