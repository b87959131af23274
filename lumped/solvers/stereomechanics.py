"""Stereomechanics: an impact whose contact takes no time, "(1)" and "(2)" corrected.

As printed, V_2' of "(2)" breaks the balance of momentum, and its loss is (1+e)/(1-e) times the true one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

from lumped.errors import BadInput, Fault
from lumped.schema.keys import Key, Number, Record

MASS, VELOCITY = Number(1e-21, 1e12, "kg"), Number(-1e9, 1e9, "m/s")


@dataclass(frozen=True)
class Collision(Record):
    """Body 1 runs into body 2: masses in kg, velocities before in m/s along one line, V_1 > V_2.

    `e` is the coefficient of restitution; without `mass_2` the second body is a wall, which may move.
    Raises BadInput for values out of range, and for bodies which do not approach each other.
    """

    mass_1: Annotated[float, Key(MASS, "mass of body 1")]
    velocity_1: Annotated[float, Key(VELOCITY, "its velocity before")]
    velocity_2: Annotated[float, Key(VELOCITY, "velocity of body 2 before")]
    e: Annotated[float, Key(Number(0.0, 1.0), "coefficient of restitution")]
    mass_2: Annotated[float, Key(Number(1e-21, math.inf, "kg"), "mass of body 2")] = math.inf
    name: ClassVar[str] = "collision"

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_approach(self.velocity_1, self.velocity_2)

    @property
    def reduced_mass(self) -> float:
        """m_1 m_2/(m_1+m_2), kg; that of a wall is m_1."""
        return self.mass_1 / (1.0 + self.mass_1 / self.mass_2)

    @property
    def velocities_after(self) -> tuple[float, float]:
        """V_1' = V_1 - J/m_1 and V_2' = V_2 + J/m_2, m/s, with the impulse J = (1+e) m_1 m_2/(m_1+m_2) (V_1-V_2)."""
        impulse = (1.0 + self.e) * self.reduced_mass * (self.velocity_1 - self.velocity_2)
        return self.velocity_1 - impulse / self.mass_1, self.velocity_2 + impulse / self.mass_2

    @property
    def energy_lost(self) -> float:
        """Delta E = (1-e^2) m_1 m_2/(m_1+m_2) (V_1-V_2)^2/2, J."""
        closing = self.velocity_1 - self.velocity_2
        return 0.5 * (1.0 - self.e) * (1.0 + self.e) * self.reduced_mass * closing**2


def restitution(velocity_1: float, velocity_2: float, after_1: float, after_2: float) -> float:
    """e = (V_2'-V_1')/(V_1-V_2), "(1)", of observed velocities, m/s.

    Raises BadInput for bodies which do not approach each other.
    """
    _check_approach(velocity_1, velocity_2)
    return (after_2 - after_1) / (velocity_1 - velocity_2)


def _check_approach(velocity_1: float, velocity_2: float) -> None:
    if not velocity_1 > velocity_2:
        message = f"{velocity_1!r} is not accepted; accepted: above velocity_2 = {velocity_2!r} m/s, towards body 2"
        raise BadInput(Fault("collision", "velocity_1", message))
