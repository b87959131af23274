"""What finite elements say of targets without a half-space: laws beside them, charts, and fields refused by name."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from fe_contact.cli import main
from fe_contact.fields import check_fields
from fe_contact.reference import result_of, solve
from fe_contact.report.history import plot_history
from fe_contact.validation.verdict import WITHIN
from lumped import Scene
from lumped.errors import BadInput


def test_a_washer_is_compared_with_laws_on_its_own_slow_curve(tmp_path: Path) -> None:
    """No closed form is known: the laws follow the indentation, and its bar is theirs too."""
    assert main(["compare", "polymer-washer", "--out", str(tmp_path)]) == 0
    content = json.loads((tmp_path / "compare.json").read_text(encoding="utf-8"))
    assert any(line.startswith("correspondence, ting: ") and WITHIN in line for line in content["verdict"])
    assert set(content["refused"]) == {"hertz", "mdr"}
    assert (tmp_path / "compare.png").exists()


def test_the_chart_of_a_block_tells_sizes_as_they_are(tmp_path: Path) -> None:
    scene = Scene.load("polymer-prism")
    solved = solve(scene, {})
    svg, _ = plot_history(result_of(scene, solved), tmp_path, solved)
    assert svg.stat().st_size > 0


@pytest.mark.parametrize("name", ["polymer-punch", "polymer-prism", "polymer-o-ring", "two-spheres", "rod-in-ring"])
def test_fields_of_another_section_are_refused_by_name(name: str) -> None:
    with pytest.raises(BadInput, match="--fields: a round profile on half_space or layer"):
        check_fields(Scene.load(name))
