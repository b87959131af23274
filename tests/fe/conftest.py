"""What the tests of the finite-element floor share: settings, strikes and scenes built from few numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import lumped
from fe_contact.march import Strike
from fe_contact.numerics import Numerics
from lumped.load_curves.hertz import hertz_impact
from lumped.materials import Relaxation
from lumped.shapes import Parabola

SETTINGS: dict[str, Any] = {
    "tolerance": 1e-3,
    "elements_per_contact": 4.0,
    "order": 4,
    "penalty": 1000.0,
    "enforcement": "corrected",
    "scheme": "galerkin",
    "steps": 40,
    "far_radius": 20.0,
    "peak_share": 0.5,
}


@pytest.fixture(scope="session")
def hertz_strike() -> Callable[..., Strike]:
    """A paraboloid of radius 1 m, mass 1 kg, on E* = 1 Pa, at a velocity that makes the Hertz depth what is asked."""

    def build(relaxation: Relaxation | None = None, depth: float = 0.01, **changes: Any) -> Strike:
        velocity = (16 / 15 * depth**2.5) ** 0.5
        known: dict[str, Any] = {
            "height": Parabola(1.0).height,
            "mass": 1.0,
            "velocity": velocity,
            "gravity": 0.0,
            "relaxation": relaxation or Relaxation(1.0),
            "end_time": 1e4 * depth / velocity,
        }
        return Strike(**{**known, **changes})

    return build


@pytest.fixture(scope="session")
def settings_of() -> Callable[..., Numerics]:
    """Settings of a strike of ``hertz_strike``, placed by the Hertz impact with modulus 1."""

    def build(strike: Strike, **changes: Any) -> Numerics:
        scales = hertz_impact(1.0, 1.0, strike.mass, strike.velocity)
        placed = {"contact_radius": 1.1 * scales.contact_radius, "contact_time": scales.duration}
        return Numerics(**{**SETTINGS, **placed, **changes})

    return build


@pytest.fixture(scope="session")
def scene_of() -> Callable[..., lumped.Scene]:
    """A sphere on a half-space: material table, and whatever else of the scene file differs."""

    def build(material: dict[str, Any], **tables: Any) -> lumped.Scene:
        striker = {"shape": "sphere", "radius": 0.01, "mass": 0.02, "velocity": 0.5} | tables.pop("striker", {})
        target = {"shape": "half_space", "material": {"nu": 0.3} | material}
        return lumped.Scene.from_dict({"name": "test", "striker": striker, "target": target, **tables})

    return build
