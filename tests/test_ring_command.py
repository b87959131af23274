"""``fe-contact ring``: curves against the exact ring, verdicts that follow from them, files."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from fe_contact.studies.finite_exponents import local_exponent
from fe_contact.studies.rings import (
    JUDGED,
    RingCurve,
    RingStruck,
    _struck,
    cases,
    rings,
    verdict,
    write_rings,
)
from lumped import laws, simulate
from lumped.paper.given import Examples
from lumped.paper.ring_impacts import stiffness

CASES = {case.name: case for case in cases()}


@pytest.fixture(scope="module")
def curves(tmp_path_factory: pytest.TempPathFactory) -> dict[str, RingCurve]:
    chosen = [CASES[name] for name in ("rod-in-ring", "polymer-washer")]
    return {curve.case.name: curve for curve in rings(chosen, tmp_path_factory.mktemp("rings"))}


def test_a_rod_in_its_ring_follows_the_exact_annulus(curves: dict[str, RingCurve]) -> None:
    """By Fourier series, which share nothing with the mesh."""
    curve = curves["rod-in-ring"]
    indenter = curve.case.indenter
    exact = indenter.target.load_curve(indenter.profile, indenter.material.nu)
    factor = np.asarray(exact.force(curve.found.depth)) / (0.25 * math.pi * curve.found.depth)
    assert np.all(np.abs(curve.factor - factor) <= curve.factor_error)
    slope = local_exponent(curve.found.depth, factor * curve.found.depth, np.zeros_like(factor))[0]
    assert np.all(np.abs(curve.exponent - slope) <= curve.exponent_error)
    assert curve.exponent.min() > 1.1  # nowhere what the row says


def test_the_row_crosses_the_rod_once(curves: dict[str, RingCurve]) -> None:
    curve = curves["rod-in-ring"]
    indenter, judged = curve.case.indenter, verdict(curve)
    exact = indenter.target.load_curve(indenter.profile, indenter.material.nu)
    root = brentq(lambda d: float(exact.force(d)) - 0.25 * math.pi * d, 1e-6, 9e-4)
    assert judged.word == "holds at one depth"
    assert judged.crossing == pytest.approx(root, rel=5e-3)


def test_a_washer_is_a_spring_of_another_stiffness(curves: dict[str, RingCurve]) -> None:
    """Its area stays: the exponent of the row, but not its factor."""
    curve = curves["polymer-washer"]
    np.testing.assert_allclose(curve.exponent, 1.0, atol=1e-9)
    assert np.ptp(curve.factor) <= 1e-9
    assert abs(curve.factor[0] - 1.0) > 0.1 + curve.factor_error[0]
    assert verdict(curve).word == "wrong"


def test_the_row_is_the_papers() -> None:
    """ "(29)" with its own length, whatever the ring's thickness."""
    ring = Examples.load().ring
    for name in ("paper-ring-3mm", "paper-ring-10mm"):
        case = CASES[name]
        row = 0.25 * math.pi * case.indenter.modulus(False) * case.length
        assert row == pytest.approx(stiffness(ring, ring.nu).relaxed)


def test_the_files_say_what_was_found(curves: dict[str, RingCurve], tmp_path: Path) -> None:
    content = write_rings(tuple(curves.values()), tmp_path, ())
    with (tmp_path / "ring.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert content == json.loads((tmp_path / "ring.json").read_text(encoding="utf-8"))
    assert [one["verdict"]["word"] for one in content["rings"]] == ["holds at one depth", "wrong"]
    ledger = {one["effect"]: one for one in content["rings"][0]["model_ledger"]}
    low, high = ledger["finite strain"]["spread"]
    assert low < 0.0 < high < low + 1.0
    assert high - low > 0.3, "energies alike at small strains differ by as much as the strain"
    assert 0.0 < ledger["finite length"]["estimate"] < 1.0
    assert ledger["finite length"]["note"].startswith("softer: free ends have")
    for row in rows:
        assert (row["beyond_small_strain"] == "True") == (float(row["strain"]) > 0.05)
        assert float(row["row_deviation"]) == pytest.approx(float(row["row_force_N"]) / float(row["force_N"]) - 1.0)


@pytest.fixture(scope="module")
def impact(tmp_path_factory: pytest.TempPathFactory) -> RingStruck:
    return _struck(CASES["paper-ring-10mm"], 0.01, tmp_path_factory.mktemp("impact"))


@pytest.mark.tenth
def test_the_impacts_verdict_is_what_the_exact_ring_says(impact: RingStruck) -> None:
    """Ting on the annulus, without an element: how far (30)-(32) are off is the same within the bars."""
    scene = impact.found.scene
    exact = simulate(laws.ting.of(scene), scene, 1e-6).quantities
    for name in JUDGED:
        off, bar = impact.deviation(name)
        value, row = exact[name].value, impact.by_row(name)
        assert abs(off - (row - value if name == "restitution" else row / value - 1.0)) <= bar + 1e-5, name
    assert not impact.holds
    assert impact.deviation("duration")[0] < -0.1  # far too stiff for a touch that has just begun


@pytest.mark.tenth
def test_the_bulk_modulus_matters_more_than_the_bars_and_less_than_the_ledger_says(impact: RingStruck) -> None:
    (told,) = [one for one in impact.found.model_ledger if one.effect == "constant nu against constant bulk modulus"]
    change, bar = impact.of_bulk("peak_force")
    assert bar < abs(change) < 1.05 * (told.estimate or 0.0)


@pytest.mark.tenth
def test_an_impact_is_written(impact: RingStruck, curves: dict[str, RingCurve], tmp_path: Path) -> None:
    (one,) = write_rings(tuple(curves.values()), tmp_path, [impact])["impacts"]
    with (tmp_path / "ring_impacts.csv").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert float(row["duration"]) == one["duration"] == impact.found.quantities["duration"].value
    assert one["duration_row_deviation"] == pytest.approx(one["duration_by_row"] / one["duration"] - 1.0)
    assert one["verdict"].startswith("wrong")
