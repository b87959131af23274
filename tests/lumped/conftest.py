"""A soft sphere impact to vary: E* = 1 MPa as instantaneous or relaxed modulus, contact time T = 13.3 ms."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from lumped import Material, Model, Motion, Relaxation, Scene, Sphere
from lumped.shapes import Shape

RADIUS, MASS, VELOCITY, MODULUS = 0.006, 0.05, 0.02, 1e6

Build = Callable[..., Scene]


@pytest.fixture(scope="session")
def unit_time() -> float:
    """Contact time T of the elastic impact with E* = MODULUS, s."""
    return Sphere(RADIUS).hertz_impact(MODULUS, MASS, VELOCITY).duration


@pytest.fixture(scope="session")
def impact(unit_time: float) -> Build:
    """Builds a scene whose moduli count in MODULUS (as E* at constant nu) and whose times in T; a sphere by default."""

    def build(
        relaxed: float = 1.0,
        moduli: tuple[float, ...] = (),
        times: tuple[float, ...] = (),
        viscosity: float = 0.0,
        *,
        nu: float = 0.3,
        constant: str = "poisson",
        profile: str = "exact",
        gravity: float = 0.0,
        velocity: float = VELOCITY,
        end_time: float | None = None,
        shape: Shape | None = None,
    ) -> Scene:
        contact = Relaxation(relaxed, moduli, tuple(t * unit_time for t in times), viscosity * unit_time)
        young = contact.scaled(MODULUS * (1.0 - nu**2))
        end = None if end_time is None else end_time * unit_time
        return Scene(
            shape or Sphere(RADIUS),
            MASS,
            velocity,
            Material(young, nu, constant=constant),
            model=Model(profile=profile, gravity=gravity),
            motion=Motion(end_time=end),
        )

    return build
