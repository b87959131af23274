"""`fe-contact ptmd` in-process: its file, its exit codes, what it writes and what it refuses."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_contact.cli import main
from fe_contact.studies.ptmd_chart import plot_study
from lumped.errors import BadInput
from lumped.pounding import march
from lumped.ptmd import Memory
from lumped.ptmd import study as studies
from lumped.ptmd.case_file import CASES, load, read
from lumped.ptmd.result import COLUMNS
from lumped.ptmd.study import BARE, FULL, PLAIN, study
from lumped.schema.csv_file import read_columns

SHORT = ["--set", "motion.end_time=1.0", "--quiet"]
CASE: dict[str, Any] = {
    "structure": {"mass": 20.0, "stiffness": 7248.9, "damping": 7.615},
    "damper": {"mass": 1.67, "stiffness": 592.9, "damping": 0.6312},
    "ring": {"gap": 0.02, "length": 0.003, "material": {"law": "elastic", "E": 6e5, "nu": 0.45}},
    "motion": {"displacement": 0.05, "end_time": 0.5},
}


def changed(key: str, value: object) -> dict[str, Any]:
    """The case with a dotted key set, or taken out when the value is None."""
    table: dict[str, Any] = json.loads(json.dumps(CASE))
    *path, last = key.split(".")
    place = table
    for part in path:
        place = place[part]
    if value is None:
        del place[last]
    else:
        place[last] = value
    return table


def test_the_paper_case_is_written_as_it_is_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["ptmd", "--json", "--quiet", "--out", str(tmp_path)]) == 0
    out, err = capsys.readouterr()
    written = json.loads((tmp_path / "ptmd.json").read_text(encoding="utf-8"))
    assert json.loads(out) == written
    assert {path.name for path in tmp_path.iterdir()} == {
        "ptmd.csv", "contacts.csv", "ptmd.json", "ptmd.svg", "ptmd.png"
    }  # fmt: skip
    assert list(written["variants"]) == [FULL, PLAIN, BARE]
    assert written["converged"]
    assert written["convergence"]["contacts"] == [54, 54]
    assert abs(written["energy"]["residual"]) < 1e-8 * written["energy"]["initial"]
    # Section 3's first assumption: 36 mm into a ring struck by a rod of 6 mm.
    assert not written["model_sufficient"]
    assert "small deformation" in err
    assert written["model_ledger"][0]["estimate"] == pytest.approx(written["measures"]["peak_depth"] / 0.006)


@pytest.mark.tenth
def test_rows_and_contacts_belong_to_the_measures(tmp_path: Path) -> None:
    assert main(["ptmd", "paper", *SHORT, "--out", str(tmp_path)]) == 0
    written = json.loads((tmp_path / "ptmd.json").read_text(encoding="utf-8"))
    rows = read_columns(tmp_path / "ptmd.csv", tuple(COLUMNS.values()))
    with (tmp_path / "contacts.csv").open(encoding="utf-8", newline="") as file:
        contacts = list(csv.DictReader(file))
    measures = written["measures"]
    assert len(contacts) == measures["contacts"]
    assert max(float(contact["peak_force_N"]) for contact in contacts) == measures["peak_force"]
    assert np.abs(rows["force_N"]).max() == pytest.approx(measures["peak_force"], rel=2e-3)
    assert rows["depth_m"].max() == pytest.approx(measures["peak_depth"], rel=2e-3)
    assert rows["time_s"][[0, -1]] == pytest.approx([0.0, 1.0])


@pytest.mark.tenth
def test_the_default_folder_carries_the_name_and_what_was_changed(empty: Path) -> None:
    assert main(["ptmd", *SHORT, "--set", "name=mine"]) == 0
    assert [path.name for path in (empty / "fe-contact-out").iterdir()] == ["ptmd-mine-motion.end_time=1.0"]


@pytest.mark.tenth
def test_the_summary_tells_every_variant(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["ptmd", *SHORT, "--set", "motion.start=structure", "--out", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in (FULL, PLAIN, BARE))
    ledger = json.loads((tmp_path / "ptmd.json").read_text(encoding="utf-8"))["model_ledger"]
    assert [entry["treated"] for entry in ledger] == ["small strain", "relaxed"]


@pytest.mark.tenth
def test_what_does_not_converge_is_written_and_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(studies, "MOST_RESIDUAL", -1.0)
    assert main(["ptmd", *SHORT, "--out", str(tmp_path)]) == 3
    assert "energy balance" in capsys.readouterr().err
    assert not json.loads((tmp_path / "ptmd.json").read_text(encoding="utf-8"))["converged"]


def test_a_motion_that_cannot_be_followed_leaves_what_is_known(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(march, "MOST_STEPS", 2)
    assert main(["ptmd", *SHORT, "--out", str(tmp_path)]) == 3
    assert "steps between" in capsys.readouterr().err
    known = json.loads((tmp_path / "ptmd.json").read_text(encoding="utf-8"))
    assert not known["converged"]
    assert known["case"]["ring"]["gap"] == 0.02


@pytest.mark.tenth
def test_the_chart_is_reproducible(tmp_path: Path) -> None:
    found = study(read(CASE))
    for name in ("first", "again"):
        plot_study(found, tmp_path / name)
    first, again = (sorted((tmp_path / name).iterdir()) for name in ("first", "again"))
    assert len(first) == 2
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]


@pytest.mark.family
@pytest.mark.parametrize("missing", [["ring"], ["ring", "damper"]])
def test_a_plain_damper_and_a_bare_structure_are_cases_too(missing: list[str], tmp_path: Path) -> None:
    found = study(read({key: table for key, table in CASE.items() if key not in missing}))
    assert list(found.results) == [FULL, PLAIN, BARE][len(missing) :]
    assert found.ledger == ()
    assert found.model_sufficient
    plot_study(found, tmp_path)


# the file


def test_the_packaged_case_is_the_paper() -> None:
    assert CASES.names == ("paper",)
    case = load()
    assert case.system.ring is not None
    assert case.system.ring.stiffness.relaxed == pytest.approx(1772.7, abs=0.05)
    assert case.system.ring.memory is Memory.RECOVERING
    assert (case.start.x1, case.start.x2, case.end_time, case.window) == (0.05, 0.05, 20.0, 5.0)


def test_a_start_by_displacements_and_velocities() -> None:
    start = read(changed("motion", {"x1": 0.01, "x2": -0.02, "v2": 0.3})).start
    assert (start.x1, start.x2, start.v1, start.v2) == (0.01, -0.02, 0.0, 0.3)
    start = read(changed("motion.start", "structure")).start
    assert (start.x1, start.x2) == (0.05, 0.0)


def test_any_force_law_by_its_coefficient() -> None:
    ring = read(changed("ring", {"gap": 0.01, "coefficient": 0.5, "exponent": 1.5, "memory": "reset",
                                 "material": CASE["ring"]["material"]})).system.ring  # fmt: skip
    assert ring is not None
    assert (ring.gap, ring.coefficient, ring.exponent, ring.memory) == (0.01, 0.5, 1.5, Memory.RESET)


BAD: list[tuple[str, object, str]] = [
    ("structure", None, "structure: missing"),
    ("damper", None, "damper: missing"),
    ("motion", None, "motion: missing"),
    ("ring.material", None, "ring.material: missing"),
    ("ring.length", None, "ring.length: missing"),
    ("ring", 3, "not a table"),
    ("structure.mass", -1.0, "structure.mass"),
    ("structure.stiffness", "stiff", "structure.stiffness"),
    ("damper.damping", -0.1, "damper.damping"),
    ("damper.mas", 1.0, "did you mean mass"),
    ("dampr", {}, "did you mean damper"),
    ("ring.gap", -0.02, "ring.gap"),
    ("ring.memory", "short", "ring.memory"),
    ("ring.exponent", 1.5, "ring.exponent"),
    ("ring.material.law", "rubber", "ring.material.law"),
    ("ring.material.nu", 0.51, "ring.material.nu"),
    ("ring.material.bulk_modulus", 1e9, "ring.material.bulk_modulus"),
    ("motion.displacement", 0.0, "motion.displacement"),
    ("motion.displacement", None, "motion.displacement"),
    ("motion.start", "damper", "motion.start"),
    ("motion.x1", 0.1, "motion.displacement"),
    ("motion.end_time", 0.0, "motion.end_time"),
    ("motion.window", True, "motion.window"),
]


@pytest.mark.parametrize(("key", "value", "named"), BAD)
def test_bad_input_is_named(key: str, value: object, named: str) -> None:
    with pytest.raises(BadInput, match=named):
        read(changed(key, value))


def test_all_faults_are_told_at_once_and_nothing_is_written(refused: Callable[..., list[str]]) -> None:
    wrong = ("structure.mass=-1", "damper.colour=1", "ring.gap=nan", "ring.material.E0=0", "motion.end_time=-1")
    faults = refused("ptmd", *(part for key in wrong for part in ("--set", key)))
    for fault in wrong:
        assert sum(fault.split("=")[0] in line for line in faults) == 1, faults


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["papr"], "did you mean paper"),
        (["no/such/file.toml"], "cannot be read"),
        (["--set", "motion.end_time=1e8"], "end_time"),
        (["--set", "ring.material.R2=1e-12"], "leave that term out"),
        (["--set", "structure"], "key=value"),
        (["--out", "/dev/null/x"], "--out"),
    ],
)
def test_a_refused_command_writes_nothing(arguments: list[str], named: str, refused: Callable[..., list[str]]) -> None:
    (fault,) = refused("ptmd", *arguments)
    assert named in fault
