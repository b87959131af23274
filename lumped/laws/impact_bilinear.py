"""Muthukumar and DesRoches' bilinear impact material, OpenSees' ImpactMaterial: a hysteresis loop, no rate.

F = k2 depth + q: q follows the depth with the slope k1 - k2, but never leaves 0 to (k1 - k2) yield_depth. So loading
has the slope k1 up to the yield depth, then k2; unloading k1 until it meets the line k2 depth, then follows that; and
so on from wherever it turns. Doi 10.1002/eqe.557; Dryden 2008 for OpenSees.

Of an elastic stiffness and a restitution the published recipe asks for the loss
E = k d^(alpha + 1) (1 - e^2)/(alpha + 1) at the largest depth d, with the secant stiffness K = k d^(alpha - 1) there
and a yield depth a d:
    k1 = K + E/(a d^2),  k2 = K - E/((1 - a) d^2).
Muthukumar and DesRoches 2006, doi 10.1002/eqe.557; d is that of the elastic impact. But the loop stores other energy
than the elastic spring, so that neither d nor e come out. Exact, E = (1 - e^2) m v^2/2 and d is the depth reached,
    K d^2 = (1 + e^2) m v^2/2, as the work done up to d is (K d^2 + E)/2.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from lumped.errors import Fault
from lumped.laws._damping import EXACT
from lumped.laws._force_law import ForceLaw, bodies_of
from lumped.laws._parameters import COMMON, EXPONENT, RESTITUTION, STIFFNESS, Parameters
from lumped.laws.base import LawKind
from lumped.numbers import Real
from lumped.scene.scene import Scene
from lumped.schema.keys import Choice, Key, Number
from lumped.solvers.point.bodies import Bodies, Stage

FORMULAS = (EXACT, "muthukumar")
# A step that ends at a corner, to rounding, is still before it.
AT_CORNER = 1e-9
LOOP: Mapping[str, Key] = {
    "k1": Key(Number(1e-30, 1e30, "N/m"), "stiffness up to the yield depth", required=False),
    "k2": Key(Number(1e-30, 1e30, "N/m"), "stiffness beyond it", required=False),
    "yield_depth": Key(Number(1e-30, 1e6, "m"), "depth at which it yields", required=False),
}
YIELD_SHARE = 0.1  # physics: the loop's share a, but for low e, where e bounds it


@dataclass(frozen=True, kw_only=True)
class ImpactBilinear(ForceLaw):
    """The loop with k1 >= k2 > 0, N/m, and the yield depth, m."""

    k1: float
    k2: float
    yield_depth: float
    name: ClassVar[str] = "impact_bilinear"
    loss: ClassVar[str] = "contact"

    @property
    def slider(self) -> tuple[float, float]:
        """The slope of q, N/m, and its highest value, N."""
        return self.k1 - self.k2, (self.k1 - self.k2) * self.yield_depth

    def force(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """F, N."""
        return self.k2 * depth + self._held(depth, stage)

    def tangents(self, depth: Real, rate: Real, stage: Stage) -> tuple[Real, Real]:
        """k1 while q follows the depth, else k2; 0."""
        return np.where(self._sliding(depth, stage), self.k2, self.k1), 0.0 * rate

    def lost(self, depth: Real, rate: Real, stage: Stage) -> Real:
        """q where it stays at its highest, N: at zero it loses nothing."""
        return np.where(self._sliding(depth, stage), self._held(depth, stage), 0.0)

    def stored(self, depth: float, stage: Stage) -> float:
        """What unloading gives back, k2 depth^2/2 + q^2/(2 (k1 - k2)), J."""
        slope, _ = self.slider
        held = float(self._held(depth, stage))
        return 0.5 * self.k2 * depth**2 + (0.5 * held**2 / slope if held else 0.0)

    def kept(self, depth: float, stage: Stage) -> tuple[float, ...]:
        """q where the motion turns."""
        return (float(self._held(depth, stage)),)

    def corners(self, stage: Stage) -> tuple[float, ...]:
        """Where q stops following the depth."""
        slope, highest = self.slider
        left = self._begun(stage) - (highest if stage.approaching else 0.0)
        return (stage.turn - left / slope,) if left else ()

    def time_scale(self, bodies: Bodies) -> float:
        """pi sqrt(m depth/F) of the largest depth."""
        kinetic = 0.5 * bodies.mass * bodies.velocity**2
        slope, highest = self.slider
        depth = math.sqrt(2.0 * kinetic / self.k1)
        if depth > self.yield_depth:
            work = kinetic + 0.5 * highest * self.yield_depth
            depth = 2.0 * work / (highest + math.sqrt(highest**2 + 2.0 * self.k2 * work))
        return math.pi * math.sqrt(bodies.mass / (self.k2 + slope * min(1.0, self.yield_depth / depth)))

    def _begun(self, stage: Stage) -> float:
        """q at the beginning of a stage."""
        return stage.kept[0] if stage.kept else 0.0

    def _held(self, depth: Real, stage: Stage) -> Real:
        slope, highest = self.slider
        return np.clip(self._begun(stage) + slope * (depth - stage.turn), 0.0, highest)

    def _sliding(self, depth: Real, stage: Stage) -> Real:
        slope, highest = self.slider
        free, least = self._begun(stage) + slope * (depth - stage.turn), AT_CORNER * highest
        return (free > highest + least) if stage.approaching else (free < -least)


def of(scene: Scene) -> ImpactBilinear:
    """The law for a scene. Raises BadInput."""
    given = Parameters(scene, ImpactBilinear.name)
    numbers = _given(given) if any(key in given.values for key in LOOP) else _derived(given)
    return ImpactBilinear(**numbers._asdict(), **given.common())


def _given(given: Parameters) -> LoopNumbers:
    """k1, k2 and yield_depth of the scene file, all three."""
    for key, own in LOOP.items():
        if key not in given.values:
            given.missing(key, f"{own.kind.accepted}; k1, k2 and yield_depth come together")
    numbers = LoopNumbers(*(given.get(key, 1.0) for key in LOOP))
    others = sorted(set(given.values) & {"k", "alpha", "e", "damping"})
    if others:
        reason = f"{', '.join(others)} beside k1, k2 and yield_depth; accepted: either, not both"
        given.faults.append(Fault(given.scene.source, f"law.{others[0]}", reason))
    if numbers.k2 > numbers.k1:
        reason = f"{numbers.k2:g} is above k1 = {numbers.k1:g}; accepted: at most k1"
        given.faults.append(Fault(given.scene.source, "law.k2", reason))
    return numbers


def _derived(given: Parameters) -> LoopNumbers:
    """From the stiffness of an elastic law and e."""
    alpha = given.exponent()
    k, (_, e) = given.stiffness(alpha), given.damping(())
    recipe_of = exact if given.get("damping", EXACT) == EXACT else published
    return recipe_of(k, alpha, bodies_of(given.scene), e)


class LoopNumbers(NamedTuple):
    """k1 and k2, N/m, and the yield depth, m."""

    k1: float
    k2: float
    yield_depth: float


def exact(k: float, alpha: float, bodies: Bodies, e: float) -> LoopNumbers:
    """The loop that meets e and has the elastic law's force at its largest depth.

    k2 stays positive where a < 2 e^2/(1 + e^2): for e below 1/3 a is half of that.
    """
    kinetic = 0.5 * bodies.mass * bodies.velocity**2
    depth = ((1.0 + e**2) * kinetic / k) ** (1.0 / (alpha + 1.0))
    share = min(YIELD_SHARE, e**2 / (1.0 + e**2))
    return recipe(k * depth ** (alpha - 1.0), depth, (1.0 - e) * (1.0 + e) * kinetic, share)


def published(k: float, alpha: float, bodies: Bodies, e: float) -> LoopNumbers:
    """The recipe at the depth of the elastic impact."""
    kinetic = 0.5 * bodies.mass * bodies.velocity**2
    depth = ((alpha + 1.0) * kinetic / k) ** (1.0 / (alpha + 1.0))
    return recipe(k * depth ** (alpha - 1.0), depth, (1.0 - e) * (1.0 + e) * kinetic, YIELD_SHARE)


def recipe(stiffness: float, depth: float, loss: float, share: float) -> LoopNumbers:
    """From the secant stiffness, N/m, at a depth, m, the loss, J, and the yield depth's share of the depth."""
    k1, k2 = stiffness + loss / (share * depth**2), stiffness - loss / ((1.0 - share) * depth**2)
    return LoopNumbers(k1, k2, share * depth)


MEMBER = LawKind(
    of,
    __doc__,
    (
        LOOP,
        STIFFNESS,
        EXPONENT,
        RESTITUTION,
        {"damping": Key(Choice(FORMULAS), "formula by which e becomes the loop", required=False)},
        COMMON,
    ),
)
