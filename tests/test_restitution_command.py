"""`fe-contact restitution`: a line a formula and exit, files without NaN, a chart."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from fe_contact.cli import main
from fe_contact.studies.restitution import EXITS, RestitutionLine, formulas, table, write_restitution
from fe_contact.studies.restitution_chart import plot_restitution
from lumped import restitution

ASKED = (0.1, 0.5, 0.9)


@pytest.fixture(scope="module")
def lines() -> tuple[RestitutionLine, ...]:
    return table(ASKED)


def test_every_family_and_formula_has_a_line_at_either_exit(lines: tuple[RestitutionLine, ...]) -> None:
    present = {(line.law, line.damping) for line in lines}
    for name in restitution.available():
        assert {(name, formula) for formula in (restitution.EXACT, *restitution.get(name).published)} <= present
    assert [(line.law, line.damping, line.exit) for line in lines] == [
        (*formula, exit) for formula in formulas() for exit in EXITS
    ]


def test_exact_dampings_lie_on_the_diagonal_and_published_ones_where_their_families_say(
    lines: tuple[RestitutionLine, ...],
) -> None:
    for line in lines:
        if line.damping == restitution.EXACT:
            assert line.obtained == pytest.approx(ASKED, abs=1e-9)
        elif line.law in restitution.available():
            family = restitution.get(line.law)
            for e, got in zip(ASKED, line.obtained, strict=True):
                if got is not None:
                    expected = family.restitution(family.published[line.damping](e), line.exit)
                    assert got == pytest.approx(expected, abs=1e-8)


def test_a_formula_without_a_damping_for_e_leaves_a_gap(lines: tuple[RestitutionLine, ...]) -> None:
    series = next(line for line in lines if line.damping == "series")
    assert [got is None for got in series.obtained] == [True, True, False]


def test_files_hold_every_impact(tmp_path: Path, lines: tuple[RestitutionLine, ...]) -> None:
    content = write_restitution(lines, tmp_path)
    with (tmp_path / "restitution.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(lines) * len(ASKED)
    assert json.loads((tmp_path / "restitution.json").read_text(encoding="utf-8")) == content
    assert len(content["lines"]) == len(lines)


@pytest.mark.tenth
def test_the_chart_is_the_same_every_time(tmp_path: Path, lines: tuple[RestitutionLine, ...]) -> None:
    for name in ("one", "two"):
        plot_restitution(lines, tmp_path / name)
    one, two = (sorted((tmp_path / name).iterdir()) for name in ("one", "two"))
    assert len(one) == 2
    assert [path.read_bytes() for path in one] == [path.read_bytes() for path in two]


@pytest.mark.tenth
def test_the_command_says_a_line_each(
    tmp_path: Path,
    lines: tuple[RestitutionLine, ...],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr("fe_contact.studies.restitution.table", lambda: lines)
    assert main(["restitution", "--out", str(tmp_path / "out"), "--quiet"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert len(said) == len(lines) + 1
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        f"restitution.{kind}" for kind in ("csv", "json", "svg", "png")
    }
