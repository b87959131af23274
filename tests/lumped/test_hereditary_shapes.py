"""Laws with memory under blunt and flat strikers, whose force may rise steeply at touch, or jump."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

from lumped import Result, Scene, laws, simulate
from lumped.shapes import Shape
from lumped.shapes.plate import Plate
from lumped.shapes.power import PowerProfile
from lumped.shapes.prism import Prism
from lumped.shapes.punch import Punch
from lumped.targets.plane import Plane

Build = Callable[..., Scene]
FLAT: list[Shape] = [
    Punch(0.003),
    Prism(1e-4, 0.02, "free", "sliding"),
    Prism(1e-4, 0.02, "confined", "sliding"),
    Plate(1e-4, 0.002, "confined", "sliding"),
]


def said(law: str, scene: Scene, tolerance: float = 1e-7) -> Result:
    result = simulate(laws.get(law).of(scene), scene, tolerance)
    assert result.converged
    return result


def linear(scene: Scene) -> tuple[Callable[[float], float], Callable[[float], float], float]:
    """Velocity and force of the linear oscillator at a time, and the force at touch."""
    modulus, stiffness = scene.contact_modulus, float(scene.load_curve.force(1.0))
    terms = len(modulus.moduli)
    row = stiffness * np.array([modulus.equilibrium, modulus.viscosity, *modulus.moduli])
    rates = np.zeros((2 + terms, 2 + terms))
    rates[0, 1], rates[1] = 1.0, -row / scene.mass
    rates[2:, 1], rates[2:, 2:] = 1.0, -np.diag(1.0 / np.array(modulus.times))
    touch = np.zeros(2 + terms)
    touch[1] = scene.velocity

    def velocity(time: float) -> float:
        return float((expm(rates * time) @ touch)[1])

    def force(time: float) -> float:
        return float(row @ expm(rates * time) @ touch)

    return velocity, force, modulus.viscosity * stiffness * scene.velocity


@pytest.mark.parametrize("law", ["ting", "correspondence"])
@pytest.mark.parametrize("shape", FLAT, ids=lambda shape: f"{shape.name}-{getattr(shape, 'sides', '')}")
def test_a_fixed_area_is_a_linear_oscillator(
    law: str, shape: Shape, impact: Build, campaign_size: Callable[[int], int]
) -> None:
    random = np.random.default_rng(1885)
    for _ in range(campaign_size(40)):
        terms = int(random.integers(0, 3))
        moduli, times = 10.0 ** random.uniform(-1.0, 1.0, terms), 10.0 ** random.uniform(-2.0, 1.0, terms)
        viscosity = float(10.0 ** random.uniform(-3.0, -0.5))
        sphere = impact(1.0, tuple(moduli), tuple(times), viscosity)
        scene = replace(sphere, shape=shape, target=sphere.target if isinstance(shape, Punch) else Plane())
        found = said(law, scene)
        velocity, force, jump = linear(scene)
        assert found.history.force[0] == pytest.approx(jump, rel=1e-9), "F(0+) = D eta v"
        duration = found.quantities["duration"].value or 0.0
        end = brentq(force, 0.9 * duration, 1.1 * duration, xtol=1e-15, rtol=1e-14)
        assert duration == pytest.approx(end, rel=1e-7)
        assert found.quantities["restitution"].value == pytest.approx(-velocity(end) / scene.velocity, rel=1e-7)
        rows = found.history
        some = rows.time[:: max(1, len(rows) // 20)]
        apart = rows.force_at(some) - np.array([force(time) for time in some])
        assert np.abs(apart).max() <= 1e-6 * rows.force.max()


@pytest.mark.tenth
def test_ting_and_the_springs_agree_under_blunt_profiles_on_a_dashpot(
    impact: Build, campaign_size: Callable[[int], int]
) -> None:
    # At touch F ~ t^(1/n): infinitely steep, and for n = 12 a twelfth of the peak within 1e-12 of the contact time.
    random = np.random.default_rng(1953)
    for exponent in (3.0, 4.0, 12.0, 20.0, *random.uniform(1.0, 12.0, campaign_size(20)).tolist()):
        shape = PowerProfile(float(10.0 ** random.uniform(-1.0, 1.0)) * 0.006 ** (1.0 - exponent), exponent)
        viscosity = float(10.0 ** random.uniform(-2.0, 0.5))
        scene = impact(1.0, viscosity=viscosity, shape=shape)
        exact, row, clipped = (said(law, scene, 1e-6) for law in ("ting", "mdr", "correspondence"))
        for name in ("peak_force", "peak_depth", "duration", "restitution"):
            assert exact.quantities[name].value == pytest.approx(row.quantities[name].value, rel=1e-6), exponent
        assert clipped.quantities["peak_force"].value == pytest.approx(exact.quantities["peak_force"].value, rel=1e-6)
        early = 1e-9 * (exact.quantities["duration"].value or 0.0)
        slope = float(scene.load_curve.force_and_slope(scene.velocity * early)[1])
        rise = scene.contact_modulus.viscosity * scene.velocity * slope
        assert float(exact.history.force_at(early)) == pytest.approx(rise, rel=1e-3)
