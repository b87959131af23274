"""`fe-contact run` on scenes with a law of their own: files, exits, several impacts."""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import fe_contact
from fe_contact.cli import main
from lumped import BadInput, Scene
from lumped.errors import NotReached
from lumped.result.history import History
from lumped.schema.files import SCENES

POUNDING = [name for name in SCENES.names if name.startswith("pounding-")]


def ran(where: Path, *arguments: str) -> dict[str, Any]:
    assert main(["run", *arguments, "--out", str(where), "--quiet"]) == 0
    content: dict[str, Any] = json.loads((where / "result.json").read_text(encoding="utf-8"))
    return content


@pytest.mark.parametrize("name", POUNDING)
def test_every_packaged_pounding_runs_by_its_own_law(name: str, tmp_path: Path) -> None:
    content = ran(tmp_path, name)
    assert content["method"] == content["scene"]["law"]["name"]
    assert content["converged"]
    history = History.read_csv(tmp_path / "history.csv")
    assert len(history) >= 201
    assert history.force.max() == pytest.approx(content["quantities"]["peak_force"]["value"], rel=1e-3)
    assert abs(content["energy"]["residual"]) <= 1e-8 * content["energy"]["in"]


def test_two_free_bodies_lose_what_their_restitution_says(tmp_path: Path) -> None:
    content = ran(tmp_path, "pounding-steel-jankowski", "--tolerance", "1e-6")
    mass = 25e3 * 60e3 / 85e3
    assert content["quantities"]["restitution"]["value"] == pytest.approx(0.6, abs=1e-8)
    assert content["energy"]["viscous"] == pytest.approx(0.5 * mass * 0.3**2 * (1.0 - 0.6**2), rel=1e-8)


def test_the_exit_decides_duration_and_restitution(tmp_path: Path) -> None:
    """Kelvin at xi = 0.3, from the literature's table: e = 0.45098 at zero force, 0.37233 at zero depth."""
    scene = tmp_path / "kelvin.toml"
    scene.write_text(
        '[striker]\nmass = 1.0\nvelocity = 1.0\n[law]\nname = "kelvin"\nk = 1.0e6\nxi = 0.3\n', encoding="utf-8"
    )
    found = {exit: ran(tmp_path / exit, str(scene), "--set", f"law.exit={exit}") for exit in ("force", "depth")}
    e = {exit: content["quantities"]["restitution"]["value"] for exit, content in found.items()}
    assert e == pytest.approx({"force": 0.45098, "depth": 0.37233}, abs=6e-6)
    assert History.read_csv(tmp_path / "force" / "history.csv").force.min() == 0.0
    assert History.read_csv(tmp_path / "depth" / "history.csv").force.min() < 0.0


def test_several_impacts_are_listed_each(tmp_path: Path) -> None:
    content = ran(tmp_path, "pounding-wall-kelvin", "--set", "motion.impacts=3", "--tolerance", "1e-6")
    contacts = content["contacts"]
    assert len(contacts) == 3
    assert contacts[0]["velocity"] == 2.0
    for one, following in pairwise(contacts):
        left = one["velocity"] * one["restitution"]
        assert following["velocity"] == pytest.approx(left, rel=1e-8)  # at exit "depth" flight begins at the surface
        assert following["start"] - one["start"] - one["duration"] == pytest.approx(2.0 * left / 9.81, rel=1e-8)
    history = History.read_csv(tmp_path / "history.csv")
    assert np.all(history.force[history.depth < -1e-6] == 0.0)
    assert content["quantities"]["duration"]["value"] == contacts[0]["duration"]


def test_finite_elements_have_nothing_to_run_without_geometry(refused: Callable[..., list[str]]) -> None:
    assert "striker.shape" in refused("run", "pounding-steel-jankowski", "--method", "fe")[0]


@pytest.mark.parametrize(
    ("name", "velocity", "method", "body"),
    [
        ("polymer-prism", 50.0, "fe", "block's 0.02 m"),
        ("polymer-prism", 50.0, "correspondence", "block's 0.02 m"),
        ("polymer-washer", 20.0, "fe", "washer's height 0.004 m"),
        ("polymer-profile", 0.5, "correspondence", "profile's table ends at 0.004 m"),
    ],
)
def test_an_impact_through_the_body_is_refused(name: str, velocity: float, method: str, body: str) -> None:
    with pytest.raises(BadInput, match=f"striker.velocity: the striker sinks in.*{body}"):
        fe_contact.run(Scene.load(name, {"striker.velocity": velocity}), method=method)


@pytest.mark.tenth
def test_an_impact_too_hard_for_an_o_ring_names_a_cure_that_helps() -> None:
    """The contact leaves the section's top however wide it is planned: more steps would not hold it."""
    with pytest.raises(NotReached, match=r"cure: a lower striker\.velocity") as refused:
        fe_contact.run(Scene.load("polymer-o-ring", {"striker.velocity": 8.0}), tolerance=5e-2)
    assert float(str(refused.value).split()[2]) <= 0.0025  # m, that of the section
