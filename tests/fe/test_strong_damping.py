"""Kelvin-Voigt solids that creep back: eta/E of two to ten contact times, where the force fades in a long faint tail.

The striker leaves with some per cent of its speed, so that a change of the path is a large change of the duration;
all the same the bars must cover, and a refinement or two must do.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import fe_contact
import lumped
from fe_contact.budget.plan import plan
from lumped.laws import mdr
from lumped.result.result import RULED_RELATIVE

IMPACTS = 24
TOLERANCES = (1e-3, 1e-4)
RULED = (*RULED_RELATIVE, "restitution")
MARCHES = {1e-3: 6, 1e-4: 12}  # a certified impact is five
REFERENCE_TOLERANCE = 1e-7


def impact(number: int) -> lumped.Scene:
    """Size, stiffness and mass over decades, as in the large campaign."""
    rng = np.random.default_rng((20261121, number))
    nu, radius, young = float(rng.uniform(0, 0.4999)), 10 ** rng.uniform(-3, -1), 10 ** rng.uniform(5, 11)
    depth = radius * 10 ** (2 * rng.uniform(-2, np.log10(0.3)))
    mass = rng.uniform(0.5, 2) * rng.uniform(800, 8000) * 4 / 3 * np.pi * radius**3
    velocity = np.sqrt(16 / 15 * young / (1 - nu**2) * np.sqrt(radius) * depth**2.5 / mass)
    eta = young * 2.943275 * depth / velocity * rng.uniform(2, 10)
    material = {"law": "kelvin_voigt", "E": young, "eta": eta, "nu": nu}
    striker = {"shape": "sphere", "radius": radius, "mass": mass, "velocity": velocity}
    target = {"shape": "half_space", "material": material}
    return lumped.Scene.from_dict({"name": f"damped-{number}", "striker": striker, "target": target})


@pytest.fixture(scope="module")
def exact(campaign_size: Callable[[int], int]) -> list[lumped.Result]:
    scenes = [impact(number) for number in range(campaign_size(IMPACTS))]
    return [lumped.simulate(mdr.of(scene), scene, tolerance=REFERENCE_TOLERANCE) for scene in scenes]


@pytest.mark.tenth
@pytest.mark.parametrize("tolerance", TOLERANCES)
def test_the_bars_cover_and_few_marches_do(exact: list[lumped.Result], tolerance: float) -> None:
    for answer in exact:
        found = fe_contact.run(answer.scene, tolerance)
        assert found.converged
        assert found.work["marches"] <= MARCHES[tolerance], answer.scene.name
        for name in RULED:
            quantity, wanted = found.quantities[name], answer.quantities[name].value
            error = abs(quantity.value - wanted)
            assert error <= quantity.error, f"{answer.scene.name}: {name} is not covered"
            assert error <= tolerance * (1.0 if name == "restitution" else abs(wanted))


def roller(number: int) -> lumped.Scene:
    """A cylinder on a half-plane whose dashpot takes up to a third of its speed: at touch it pushes like the edge."""
    rng = np.random.default_rng((20261122, number))
    eta, datum = 1e6 * 6e-3 * 10 ** rng.uniform(-2.0, -1.0), 10 ** rng.uniform(-1.5, 0.5)
    striker = {"shape": "cylinder", "radius": 0.006, "length": 0.03, "mass": 0.05, "velocity": 0.02}
    material = {"law": "kelvin_voigt", "E": 1e6, "eta": eta, "nu": float(rng.uniform(0.0, 0.49))}
    target = {"shape": "half_space", "datum_depth": datum, "material": material}
    return lumped.Scene.from_dict({"name": f"roller-{number}", "striker": striker, "target": target})


@pytest.mark.tenth
def test_what_falls_with_the_steps_asks_for_no_finer_mesh(campaign_size: Callable[[int], int]) -> None:
    """A finer mesh would leave the touch of a dashpot as rough as it was, at a hundred times the cost."""
    for number in range(campaign_size(20)):
        scene = roller(number)
        found, exact = fe_contact.run(scene, 1e-3), lumped.simulate(lumped.laws.ting.of(scene), scene, 1e-7)
        assert found.converged
        assert found.numerics["elements_per_contact"] <= 2.0 * plan(scene, {}).numerics.elements_per_contact
        for name in RULED:
            quantity, wanted = found.quantities[name], exact.quantities[name].value
            assert abs(quantity.value - wanted) <= quantity.error, f"{scene.name}: {name} is not covered"
