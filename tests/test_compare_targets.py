"""What finite elements say of targets without a half-space: laws beside them, charts, and fields refused by name."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fe_contact
from fe_contact.cli import main
from fe_contact.fields import check_fields, felt
from fe_contact.reference import result_of, solve
from fe_contact.studies.compare import study
from fe_contact.studies.compare.deviations import pressure_error, rebound_steps, surface_radii
from fe_contact.studies.compare.study import WITHIN
from fe_contact.studies.history_chart import plot_history
from lumped import Scene, laws, simulate
from lumped.errors import BadInput
from lumped.numbers import Array


@pytest.mark.tenth
def test_a_washer_is_compared_with_laws_on_its_own_slow_curve(tmp_path: Path) -> None:
    """No closed form is known: the laws follow the indentation, and its bar is theirs too."""
    assert main(["compare", "polymer-washer", "--out", str(tmp_path)]) == 0
    content = json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))
    assert any(line.startswith("correspondence, ting: ") and WITHIN in line for line in content["verdict"])
    assert set(content["refused"]) == {*laws.available()} - {"correspondence", "ting"}
    assert (tmp_path / "compare.png").exists()


@pytest.mark.tenth
def test_a_law_of_small_strains_is_judged_by_large_ones() -> None:
    """A thin ring that stiffens: the law's force is too low by more than the bars, at small strains it is not."""
    large = fe_contact.compare("rod-in-ring-finite", ["ting"], tolerance=2e-2)
    small = fe_contact.compare(large.reference.scene.changed({"model.kinematics": "small"}), ["ting"], tolerance=2e-2)
    (strained,), (faint,) = large.judgements, small.judgements
    assert strained.exceeds("peak_force")
    assert (strained.errors["peak_force"] or 0.0) < 0.0
    assert not faint.exceeds("peak_force")


def test_the_bar_of_a_slow_curve_holds_what_lies_between_its_depths(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where every depth is exact: a curve that stiffens as an O-ring's does."""

    def force(depth: Array) -> Array:
        return np.asarray(depth**1.2 * (1.0 + (2e3 * depth) ** 2))

    def exact(_: object, depths: tuple[float, ...], __: object) -> SimpleNamespace:
        depth = np.array(depths)
        told = {"force": force(depth), "force_error": 0.0, "contact_radius": depth**0.5}
        return SimpleNamespace(**told, modulus=1.0 / scene.geometry.shape.total)

    scene = Scene.load("polymer-o-ring")
    monkeypatch.setattr(study, "indent", exact)
    answered, bar = study.known(scene, 2e-4)
    between = np.geomspace(2e-6, 2e-4, 200)
    worst = np.abs(answered.load_curve.force(between) / force(between) - 1.0).max()
    assert 0.1 * bar < worst < bar


def test_the_chart_of_a_block_tells_sizes_as_they_are(tmp_path: Path) -> None:
    scene = Scene.load("polymer-prism")
    solved = solve(scene, {})
    svg, _ = plot_history(result_of(scene, solved), tmp_path, solved)
    assert svg.stat().st_size > 0


@pytest.mark.tenth
def test_the_pressure_under_a_cylinder_carries_the_force_and_is_that_of_ting(recwarn: pytest.WarningsRecorder) -> None:
    """In Pa, whatever the length of the cylinder; strips of the surface weigh alike, where rings would not."""
    scene = Scene.load("polymer-layer-line", {"striker.length": 0.03 * np.random.default_rng(4).uniform(2.0, 5.0)})
    solved = solve(scene, {"tolerance": 1e-2})
    radii = surface_radii(solved)
    for step in rebound_steps(solved):
        force = 2.0 * radii[0] * 2.0 * felt(solved.certified, step).at(radii).sum() * scene.geometry.shape.total
        assert force == pytest.approx(solved.certified.march.snapshots[step].force, rel=1e-2)
    ting, correspondence = (simulate(law.of(scene), scene, 1e-6) for law in (laws.ting, laws.correspondence))
    assert (pressure_error(solved, ting) or 0.0) < 0.02
    assert (pressure_error(solved, correspondence) or 0.0) > 3.0 * (pressure_error(solved, ting) or 0.0)
    assert not recwarn.list


@pytest.mark.parametrize("name", ["polymer-punch", "polymer-prism", "polymer-o-ring", "two-spheres", "rod-in-ring"])
def test_fields_of_another_section_are_refused_by_name(name: str) -> None:
    with pytest.raises(BadInput, match="--fields: a round profile on half_space or layer"):
        check_fields(Scene.load(name))
