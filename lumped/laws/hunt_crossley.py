"""Hunt and Crossley's model: F = k depth^alpha (1 + chi rate), alpha free, damped in approach and rebound.

Doi 10.1115/1.3423596. Of e, chi is the exact one unless `damping` names a published formula. At a given chi the
restitution falls with the velocity: the damping is d = chi v_0, v_0 the velocity at touch.

Hertzdamp, F = k depth^n (1 + xi rate/v_0), is the same law with xi = d. The force is zero at depth zero and, unless
something else drives the bodies apart, nowhere else: both exits are one then. v dv/((1 + chi v) depth^n) is exact,
whence for every exponent n
    ln((1+d)/(1-e d)) = d (1+e).
With 2s for either side, 1+d = s exp(s)/sinh(s) and 1 - e d = s exp(-s)/sinh(s): in the Langevin function
L(s) = coth(s) - 1/s the law reads d = s (1 + L), e = (1 - L)/(1 + L), where no digit is lost at either end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from lumped.laws._damping import Family, check_damping, check_restitution, formulas, newton
from lumped.laws._parameters import Parameters, damped, damping_key
from lumped.laws._power_law import SpringDamped
from lumped.laws.base import LawKind
from lumped.scene.scene import Scene
from lumped.solvers.point.bodies import Stage

# Odd denominators of the continued fraction s/(3 + s^2/(5 + s^2/(7 + ...))); exact to rounding up to s = 1.
FRACTION = range(21, 1, -2)
FRACTION_BELOW = 1.0  # rounding: of s, above it the closed form loses no digits


@dataclass(frozen=True, kw_only=True)
class HuntCrossley(SpringDamped):
    """The law with k, N/m^alpha, and chi, s/m."""

    chi: float
    name: ClassVar[str] = "hunt_crossley"

    def factor(self, stage: Stage) -> float:
        """chi."""
        return self.chi


def of(scene: Scene) -> HuntCrossley:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, HuntCrossley.name)
    numbers = given.spring_damper(FAMILY, "chi", lambda d, k: d / scene.velocity)
    return HuntCrossley(**numbers, **given.common())


def restitution(damping: float, exit: str = "force") -> float:
    """e of d = chi v_0. Raises BadInput."""
    d = check_damping(damping, exit)
    if d == 0.0:
        return 1.0

    def value_and_slope(s: float) -> tuple[float, float]:
        rise, _ = langevin(s)
        return s * (1.0 + rise) - d, 1.0 + rise + s * langevin_slope(s)

    rise, rest = langevin(newton(value_and_slope, d * (3.0 + d) / (3.0 + 2.0 * d)))
    return rest / (1.0 + rise)


def damping(e: float, exit: str = "force") -> float:
    """The d = chi v_0 which meets e. Raises BadInput."""
    e = check_restitution(e, exit)
    return 2.0 * inverse_langevin((1.0 - e) / (1.0 + e), 2.0 * e / (1.0 + e)) / (1.0 + e)


def hunt_crossley(e: float) -> float:
    """3 (1-e)/2, doi 10.1115/1.3423596."""
    return 1.5 * (1.0 - e)


def lankarani_nikravesh(e: float) -> float:
    """3 (1-e^2)/4, doi 10.1115/1.2912617; Muthukumar and DesRoches for Hertzdamp, doi 10.1002/eqe.557."""
    return 0.75 * (1.0 - e) * (1.0 + e)


def herbert_mcwhannell(e: float) -> float:
    """6 (1-e)/((2e-1)^2 + 3), doi 10.1115/1.3439270."""
    return 6.0 * (1.0 - e) / ((2.0 * e - 1.0) ** 2 + 3.0)


def zhiying_qishao(e: float) -> float:
    """(3/4) (1-e^2) exp(2 (1-e)): Zhiying and Qishao 2006, J. Dyn. Control 4, 294-298."""
    return lankarani_nikravesh(e) * math.exp(2.0 * (1.0 - e))


def ye(e: float) -> float:
    """8 (1-e)/(5 e), doi 10.1002/eqe.883; Flores and others, doi 10.1007/s11044-010-9237-4."""
    return 1.6 * (1.0 - e) / e


def gonthier(e: float) -> float:
    """(1-e^2)/e, doi 10.1023/B:MUBO.0000029392.21648.bc: right for e to 0."""
    return (1.0 - e) * (1.0 + e) / e


def hu_guo(e: float) -> float:
    """3 (1-e)/(2 e), doi 10.1007/s11044-015-9453-z: right for e to 1."""
    return 1.5 * (1.0 - e) / e


def langevin(s: float) -> tuple[float, float]:
    """L(s) and 1 - L(s), s >= 0, neither from the difference of nearly equal numbers."""
    if s < FRACTION_BELOW:
        tail = 0.0
        for odd in FRACTION:
            tail = s * s / (odd + tail)
        rise = tail / s if s else 0.0
        return rise, 1.0 - rise
    fading = math.exp(-2.0 * s)
    rest = 1.0 / s - 2.0 * fading / (1.0 - fading)
    return 1.0 - rest, rest


def langevin_slope(s: float) -> float:
    """L'(s) = 1 - L^2 - 2 L/s, s > 0."""
    rise, rest = langevin(s)
    return rest * (1.0 + rise) - 2.0 * rise / s


def inverse_langevin(rise: float, rest: float) -> float:
    """s with L(s) = rise = 1 - rest, both given so that neither loses digits. Raises NotReached."""
    if rise == 0.0:
        return 0.0

    def value_and_slope(s: float) -> tuple[float, float]:
        found, left = langevin(s)
        return found - rise if s < FRACTION_BELOW else rest - left, langevin_slope(s)

    return newton(value_and_slope, rise * (3.0 - rise * rise) / (rest * (1.0 + rise)))


FAMILY = Family(
    restitution,
    damping,
    formulas(
        hunt_crossley=hunt_crossley,
        lankarani_nikravesh=lankarani_nikravesh,
        muthukumar=lankarani_nikravesh,
        herbert_mcwhannell=herbert_mcwhannell,
        zhiying_qishao=zhiying_qishao,
        ye=ye,
        flores=ye,
        gonthier=gonthier,
        hu_guo=hu_guo,
    ),
)
MEMBER = LawKind(of, __doc__, damped(FAMILY, damping_key("chi", "s/m")), FAMILY)
