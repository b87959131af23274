"""What the tests of the finite-element floor share: settings, strikes and scenes built from few numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import lumped
from fe_contact.settings import Numerics
from fe_contact.steppers.steps import Strike
from lumped.load_curves.hertz import hertz_impact
from lumped.materials import Relaxation
from lumped.result.result import RULED_RELATIVE
from lumped.shapes import Parabola

LAWS = ("elastic", "prony of one term", "prony of three terms", "kelvin_voigt")
POISSON_OFTEN = (0.0, 0.3, 0.45, 0.49, 0.499, 0.4999)

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


def material(rng: np.random.Generator, law: str, young: float, contact_time: float) -> dict[str, Any]:
    """Instantaneous over relaxed modulus to 11; relaxation times from 0.01 to 10 contact times."""
    if law == "elastic":
        return {"law": "elastic", "E": young}
    taus = contact_time * 10 ** rng.uniform(-2, 1, 3)
    if law == "kelvin_voigt":
        return {"law": law, "E": young, "eta": young * taus[0]}
    terms = 1 if law == LAWS[1] else 3
    branches = rng.uniform(0.1, 10.0) * young * rng.dirichlet(np.ones(terms))
    return {"law": "prony", "E_inf": young, "E": branches.tolist(), "tau": taus[:terms].tolist()}


def impact(rng: np.random.Generator, number: int) -> lumped.Scene:
    """One impact: size, stiffness and mass over decades, contact radius up to 0.3 striker radii."""
    law = LAWS[number % len(LAWS)]
    nu = float(rng.choice(POISSON_OFTEN) if rng.random() < 0.5 else rng.uniform(0, 0.4999))
    radius, young = 10 ** rng.uniform(-3, -1), 10 ** rng.uniform(5, 11)
    depth = radius * 10 ** (2 * rng.uniform(-2, np.log10(0.3)))
    mass = rng.uniform(0.5, 2) * rng.uniform(800, 8000) * 4 / 3 * np.pi * radius**3
    velocity = np.sqrt(16 / 15 * young / (1 - nu**2) * np.sqrt(radius) * depth**2.5 / mass)
    table = material(rng, law, young, 2.943275 * depth / velocity) | {"nu": nu}
    if law != "elastic" and number % 12 < len(LAWS):  # a quarter of the impacts
        table["constant"] = "bulk"
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": velocity}
    target = {"shape": "half_space", "material": table}
    return lumped.Scene.from_dict({"name": f"impact-{number}", "striker": striker, "target": target})


@pytest.fixture(scope="session")
def random_impact() -> Callable[[np.random.Generator, int], lumped.Scene]:
    """A sphere on a half-space drawn from a generator, by the ``LAWS`` in turn."""
    return impact


@pytest.fixture(scope="session")
def agree() -> Callable[..., None]:
    """Asserts of an impact at 1e-3: converged, and every ruled quantity within the tolerance of the truth and its bars.

    ``curve``: what the truth's own load curve may err by.
    """

    def check(found: lumped.Result, truth: lumped.Result, curve: float = 0.0) -> None:
        assert found.converged, found.message
        for name in (*RULED_RELATIVE, "restitution"):
            value, true = found.quantities[name], truth.quantities[name]
            assert value.value is not None
            assert value.error is not None
            assert true.value is not None
            scale = 1.0 if name == "restitution" else abs(true.value)
            error = abs(value.value - true.value)
            assert error <= (SETTINGS["tolerance"] + curve) * scale, name
            assert error <= value.error + (true.error or 0.0) + curve * scale, name

    return check
