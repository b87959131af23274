"""``--kinematics finite`` of table1, ring and exponents: limits, slopes, exact blocks, refusals, files."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fe_contact.assembly.forms import Array
from fe_contact.cli import main
from fe_contact.studies import finite_exponents as study
from fe_contact.studies.exponents import layers
from fe_contact.studies.finite_exponents import Departures, ExponentsOf, departures, first_beyond, sentence
from fe_contact.studies.rings import finite_rows as rings
from fe_contact.studies.table1.study import FINITE_NU, finite_rows
from lumped.materials.energies.base import energy_of

ROWS = {row.indenter.shape.name: row for row in reversed(finite_rows())}
REFUSED = next(row for row in finite_rows() if "curvature surface to" in row.label)
UNLIKE = ("st_venant_kirchhoff",)  # the largest first order


@pytest.mark.tenth
def test_light_strains_leave_the_exponent_as_the_first_order_has_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """F = F_small (1 + c1 x), x = (depth/R)^(1/2), is an exponent 3/2 + c1 x/2; next to it comes x^2."""
    monkeypatch.setattr(study, "ENERGIES", UNLIKE)
    monkeypatch.setattr(study, "TOLERANCE", 3e-3)
    share = np.geomspace(3e-4, 1e-2, 8)
    row = ROWS["sphere"]
    found = departures(replace(row, depths=tuple((row.lengths["R"] * share).tolist())))
    assert found.small is not None
    strains = row.indenter.target.strains(row.indenter.shape, FINITE_NU, *(row.lengths["R"] * np.array([1e-6, 1e-3])))
    first = 1e3 * strains.change(energy_of(UNLIKE[0])) * np.sqrt(share) / 3.0
    departure, bar = found.departure(UNLIKE[0])
    assert np.all(np.abs(departure - first) <= bar + share)
    assert departure[-2] == pytest.approx(first[-2], rel=0.25)
    assert abs(departure[0]) < 0.3 * abs(departure[-2])
    assert found.small.exponent[0] == pytest.approx(row.alpha, abs=3e-3)


def confined(depth: Array, mu: float, lame: float) -> Array:
    """Force over area of neo-Hooke's plate whose sides are held, Pa; depth over its thickness."""
    stretch = 1.0 - depth
    return np.asarray(mu * (1.0 / stretch - stretch) - lame * np.log(stretch) / stretch)


def test_a_plate_departs_where_its_closed_form_does() -> None:
    row = ROWS["plate"]
    found, share = departures(row), np.array(row.depths) / row.lengths["h"]
    young = row.indenter.material.young.relaxed
    mu, nu = 0.5 * young / (1.0 + FINITE_NU), FINITE_NU
    exact, none = confined(share, mu, 2.0 * mu * nu / (1.0 - 2.0 * nu)), np.zeros_like(share)
    departure, bar = found.departure("neo_hooke")
    exponent = study.local_exponent(share, exact, none)[0]
    assert departure == pytest.approx(exponent - 1.0, abs=1e-8)
    assert np.all(bar < 1e-6)
    assert found.over_row("neo_hooke")[0] == pytest.approx(1.0, abs=0.01)
    end = found.end("neo_hooke", 0.05)
    assert end is not None
    width = np.log(share[1] / share[0])
    around = (end.value or 0.0) / row.lengths["h"] * np.exp([-width, width])
    chord = float(np.diff(np.log(confined(around, mu, 2.0 * mu * nu / (1.0 - 2.0 * nu))))[0] / (2.0 * width))
    assert chord == pytest.approx(1.05, abs=2e-3)


def made_up(first: Array, second: Array) -> Departures:
    """Exponents that depart so from one."""
    one, bar = np.ones_like(first), np.full_like(first, 1e-3)
    small, *large = (ExponentsOf(one, bar, one + change, bar) for change in (0.0 * one, first, second))
    row = replace(ROWS["sphere"], depths=tuple(np.geomspace(1e-3, 0.1, first.size).tolist()))
    return Departures(row, small, dict(zip(study.ENERGIES, large, strict=True)))


def test_what_both_energies_change_alike_is_geometry() -> None:
    found = made_up(np.array([0.01, -0.02, 0.03]), np.array([0.02, -0.05, -0.01]))
    assert found.geometry == pytest.approx([0.01, -0.02, 0.0])
    assert found.material == pytest.approx([0.01, 0.03, 0.04])
    assert "geometry +0 %, material 4 %" in sentence(found)


def test_a_power_of_the_depth_is_left_where_it_passes_the_limit() -> None:
    depth = np.geomspace(1e-3, 0.1, 9)
    found = first_beyond(depth, depth**0.7, np.full(9, 1e-6), 0.05)
    assert found is not None
    assert found.value == pytest.approx(0.05 ** (1.0 / 0.7), rel=1e-9)
    assert first_beyond(depth, depth, np.zeros(9), 0.2) is None
    at_once = first_beyond(depth, depth, np.zeros(9), 1e-4)
    assert at_once is not None
    assert (at_once.value, at_once.error) == (0.0, depth[0])


def test_rows_that_large_strains_do_not_answer_are_named() -> None:
    found = departures(REFUSED)
    assert "a sphere on a sphere" in found.refused
    assert sentence(found).startswith("not with large strains yet")
    assert {one["refused"] for one in study._ends_of(found)} == {found.refused}


def test_every_study_has_rows_of_its_own() -> None:
    assert len(finite_rows()) == 8
    assert {row.label.partition("-")[0] for row in rings()} == {"rod", "polymer", "paper"}
    assert len(layers.finite_rows(True)) < len(layers.finite_rows(False))
    for row in (*finite_rows(), *rings(), *layers.finite_rows(False)):
        assert not row.indenter.model.finite
        assert row.strained("yeoh").model.finite


@pytest.mark.tenth
def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    chosen = (ROWS["prism"], REFUSED)
    monkeypatch.setattr("fe_contact.studies.table1.study.finite_rows", lambda: chosen)
    out = tmp_path / "out"
    assert main(["table1", "--kinematics", "finite", "--out", str(out), "--json"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content == json.loads((out / "table1_finite.json").read_text(encoding="utf-8"))
    assert [row["refused"] is None for row in content["rows"]] == [True, False]
    with (out / "table1_finite.csv").open(encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    assert [line["energy"] for line in lines] == 2 * list(study.ENERGIES)
    assert [bool(line["depth_over_h_at_5_percent"]) for line in lines] == [True, True, False, False]
    assert not any(line["depth_over_R_at_5_percent"] for line in lines)
    with (out / "table1_finite_depths.csv").open(encoding="utf-8") as file:
        assert len(list(csv.DictReader(file))) == 2 * len(study.SHARES)
    assert {path.suffix for path in out.glob("table1_finite.*")} == {".csv", ".json", ".svg", ".png"}
