"""Where a search begins: Hertz scaling from the peak and the duration, restitution from the impulse."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product

from lumped import laws
from lumped.fit import network
from lumped.fit.measured import Measured
from lumped.fit.space import TOUCH, Space, damping_names, own_keys
from lumped.laws._impacts import bodies_of
from lumped.laws._power_law import spring_contact_time, spring_of_peak
from lumped.scene.tables import LawChoice
from lumped.solvers.point.bodies import Stage

# The damper's force over the spring's, at half depth and full speed, per 1 - e: Hunt-Crossley has 3/2, Kelvin 4/pi.
DAMPER = 1.4
# The loss 1 - e that the impulse tells, and less and more, for it may tell it badly.
LOSSES = (1.0, 0.15, 3.5)
LEAST_RESTITUTION, MOST_RESTITUTION = 0.05, 0.98
# Guesses of the ratio E2/E1 and of the relaxation time over the contact time.
RATIOS, TIMES = (0.3, 2.0), (0.1, 1.0, 10.0)

Values = dict[str, float]


def starts(space: Space, measured: Measured) -> list[Values]:
    """First guesses of the free parameters, the best founded one first."""
    pulse = CurvePulse(space, measured)
    own = set(own_keys(space.law)) | {TOUCH}
    names = [name for name in (*space.free, *space.held) if name in own]
    of_network = [name for name in (*space.free, *space.held) if name not in own]
    ours = list(pulse.law_guesses(names))
    theirs = list(pulse.network_guesses()) if of_network else [{}]
    return [{name: (law | solid)[name] for name in space.free} for law, solid in product(ours, theirs)]


@dataclass(frozen=True)
class CurvePulse:
    """The curve seen as an impact of the scene's bodies."""

    space: Space
    measured: Measured

    @property
    def loss(self) -> float:
        """1 - e, e = J/(m v) - 1 from the impulse."""
        scene = self.space.scene
        e = self.measured.impulse / (scene.reduced_mass * scene.velocity) - 1.0
        return 1.0 - min(max(e, LEAST_RESTITUTION), MOST_RESTITUTION)

    def law_guesses(self, names: list[str]) -> Iterator[Values]:
        """Of the law's own parameters: the springs of the peak and of the duration, each with every loss."""
        bodies, held, own = bodies_of(self.space.scene), self.space.held, own_keys(self.space.law)
        depth = bodies.velocity * self.measured.duration / 3.0
        alpha = held.get("alpha", 1.5 if "alpha" in own else 1.0)
        of_time = (spring_contact_time(1.0, alpha, bodies) / self.measured.duration) ** (alpha + 1.0)
        of_peak = spring_of_peak(self.measured.peak, alpha, bodies)
        dampers = [name for name in names if name in damping_names(self.space.law) and name not in held]
        for k, share in product((of_peak, of_time), LOSSES if "e" in own else (1.0,)):
            loss = min(share * self.loss, 1.0 - LEAST_RESTITUTION)
            loop = self._loop(k, 1.0 - loss) if "k1" in names else {}
            springs = {TOUCH: 0.0, "alpha": alpha, "e": 1.0 - loss, "k": k, **loop, **held}
            yield springs | {name: share * self._damping(name, springs, depth) for name in dampers}

    def _loop(self, k: float, e: float) -> Values:
        """The numbers of the bilinear law by its own recipe."""
        law = LawChoice(self.space.law, {"k": k, "e": e})
        parameters = laws.get(law.name).of(replace(self.space.scene, law=law)).parameters
        return {name: parameters[name] for name in ("k1", "k2", "yield_depth")}

    def _damping(self, name: str, springs: Mapping[str, float], depth: float) -> float:
        """The damper's parameter whose force to the spring's is as 1 - e asks."""
        chosen = {key: springs[key] for key in self.space.free if key in springs}
        velocity = self.space.scene.velocity
        half = Stage(True, 0.5 * depth, velocity)
        bare, damped = (
            laws.get(self.space.law).of(self.space.scene_at(chosen | {name: value})) for value in (0.0, 1.0)
        )
        spring, damper = bare.force(half.deepest, velocity, half), damped.lost(half.deepest, velocity, half)
        return float(DAMPER * self.loss * spring / damper)

    def network_guesses(self) -> Iterator[Values]:
        """Of the material: the modulus whose Hertz impact peaks alike, shared between what lasts and what relaxes."""
        scene, held, duration = self.space.scene, self.space.held, self.measured.duration
        solid, bodies = scene.geometry.material, bodies_of(scene)
        of_one = scene.profile.hertz_impact(1.0 / (1.0 - solid.nu**2), bodies.mass, bodies.velocity).force
        sudden = (self.measured.peak / of_one) ** 2.5
        lasting = {**network.own_values(solid.young), **held}.get("E0", sudden)
        for ratio, time in product(RATIOS, TIMES):
            shared = "E0" in self.space.free
            R1 = ratio if shared else max(sudden / lasting - 1.0, 0.1 * ratio)
            E0 = sudden / (1.0 + ratio) if shared else lasting
            guess = network.three_parameters(E0, R1, time * duration * (1.0 + R1))
            yield {**guess, "E": sudden, "eta": sudden * time * duration, **held}
