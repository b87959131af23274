"""Bodies without density have no waves: blocks and rods with inertia become those without; the ledger knows how far."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fe_contact.budget.curve import Curve
from fe_contact.methods import simulate
from fe_contact.steppers.steps import Strike
from fe_contact.waves.impact import motion, record
from fe_contact.waves.targets import half_space
from fe_contact.waves.targets.half_space import moving
from lumped import Result, Scene, laws

LIGHT = 1e-4  # mass of the body over that of the striker
DAMPED = {"scheme": "generalised_alpha", "rho": 0.0, "mass": "spread", "steps": 8, "tolerance": 0.1}
AREA, LENGTH, MASS, VELOCITY = 4e-4, 0.02, 0.05, 0.1
SLS = {"law": "sls", "E1": 1.8e6, "E2": 0.9e6, "C1": 1.8e4, "nu": 0.45}
ELASTIC = {"law": "elastic", "E": 1.8e6, "nu": 0.45}


def block(material: dict[str, Any], **model: bool) -> Scene:
    """A free block with a rigid mass on its far face."""
    shape = {"shape": "prism", "area": AREA, "height": LENGTH, "sides": "free", "faces": "sliding"}
    striker = shape | {"mass": MASS, "velocity": VELOCITY, "material": material}
    return Scene.from_dict({"striker": striker, "target": {"shape": "plane"}, "model": model})


def rod(material: dict[str, Any]) -> Scene:
    """The same as a rod which the mass strikes."""
    target = {"shape": "rod", "area": AREA, "length": LENGTH, "end": "fixed", "material": material}
    striker = {"shape": "punch", "radius": 0.01, "mass": MASS, "velocity": VELOCITY}
    return Scene.from_dict({"striker": striker, "target": target, "model": {"inertia": True}})


def compared(found: Result, still: Result, names: tuple[str, ...], share: float) -> None:
    for name in names:
        assert found.quantities[name].value == pytest.approx(still.quantities[name].value, rel=share), name


@pytest.mark.tenth
@pytest.mark.parametrize("material", [ELASTIC, SLS])
def test_a_block_and_a_rod_without_density_are_springs(material: dict[str, Any]) -> None:
    """Peak force too where the integrator damps the ripple of the waves, which fades as the root of the density."""
    still = simulate(block(material), "fe", {"tolerance": 2e-5})
    light = material | {"density": LIGHT * MASS / (AREA * LENGTH)}
    motions = ("duration", "impulse", "restitution", "peak_depth")
    compared(simulate(block(light, inertia=True), "fe", DAMPED), still, ("peak_force", *motions), 1e-4)
    coarse = DAMPED | {"steps": 6000}
    compared(simulate(rod(light), "fe", coarse), still, ("peak_force", *motions), 1e-4)


def struck(rng: np.random.Generator, number: int) -> Scene:
    """A ball that loses some per cent of its energy to waves, every other time on a body with memory."""
    share, young, nu = 10 ** rng.uniform(-2.3, -1.0), 10 ** rng.uniform(5, 11), rng.uniform(0.0, 0.48)
    density, radius = 10 ** rng.uniform(2.5, 4), 0.01
    velocity = share * math.sqrt(young / (2.0 * (1.0 + nu)) / density)
    mass = density * 4.0 / 3.0 * np.pi * radius**3 * 10 ** rng.uniform(-0.5, 0.5)
    time = 2.943275 * (15 / 16 * mass * velocity**2 * (1 - nu**2) / (young * radius**0.5)) ** 0.4 / velocity
    memory = {"law": "prony", "E_inf": young, "E": [0.5 * young], "tau": [time * 10 ** rng.uniform(-1, 1)]}
    material = (memory if number % 2 else {"law": "elastic", "E": young}) | {"nu": nu, "density": density}
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": velocity}
    target = {"shape": "half_space", "material": material}
    return Scene.from_dict({"striker": striker, "target": target, "model": {"profile": "parabola"}})


def test_what_the_ledger_says_of_inertia_is_what_waves_take(campaign_size: Callable[[int], int]) -> None:
    """Estimated before, from the scene without inertia; measured by finite elements with waves: within a factor two."""
    rng = np.random.default_rng(8)
    for number in range(campaign_size(40)):
        scene = struck(rng, number)
        still = laws.get("mdr").of(scene).simulate(scene, 1e-5)
        (estimate,) = [entry.estimate for entry in still.model_ledger if entry.effect == "target inertia"]
        moved = Scene.from_dict(scene.to_dict() | {"model": {"inertia": True, "profile": "parabola"}})
        coarse = {"elements_per_contact": 4.0, "steps": 120, "penalty": 60.0}
        numerics = half_space.plan(moved, coarse).numerics
        body = moving(moved, numerics)
        peak = Curve.of(record(body, motion(body, moved, numerics), moved), Strike.of(moved)).quantities["peak_force"]
        change = 1.0 - (peak or 0.0) / (still.quantities["peak_force"].value or 1.0)
        assert change > 0.01
        assert 0.5 < (estimate or 0.0) / change < 2.0, moved
