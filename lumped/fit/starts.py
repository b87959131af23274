"""Where a search begins: Hertz scaling from the peak and the duration, restitution from the impulse."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from lumped import laws
from lumped.collide.bodies import Stage
from lumped.fit import network
from lumped.fit.measured import Measured
from lumped.fit.space import TOUCH, Space, damping_names, own_keys
from lumped.laws._force_law import bodies_of
from lumped.laws._power_law import spring_contact_time, spring_of_peak

# Of the damper's force to the spring's, at half depth and full speed, by 1 - e: that of Hunt-Crossley is 3/2, that of
# Kelvin 4/pi; and weaker and stronger ones, for an impulse that tells e badly.
DAMPING = (1.4, 0.2, 5.0)
LEAST_RESTITUTION, MOST_RESTITUTION = 0.05, 0.98
# Guesses of the ratio E2/E1 and of the relaxation time over the contact time.
RATIOS, TIMES = (0.3, 2.0), (0.1, 1.0, 10.0)

Values = dict[str, float]


def starts(space: Space, measured: Measured) -> list[Values]:
    """First guesses of the free parameters, the best founded one first."""
    pulse = Pulse(space, measured)
    own = set(own_keys(space.law)) | {TOUCH}
    names = [name for name in (*space.free, *space.held) if name in own]
    of_network = [name for name in (*space.free, *space.held) if name not in own]
    ours = list(pulse.law_guesses(names))
    theirs = list(pulse.network_guesses()) if of_network else [{}]
    return [{name: (law | solid)[name] for name in space.free} for law, solid in product(ours, theirs)]


@dataclass(frozen=True)
class Pulse:
    """The curve seen as an impact of the scene's bodies."""

    space: Space
    measured: Measured

    @property
    def restitution(self) -> float:
        """J/(m v) - 1."""
        scene = self.space.scene
        e = self.measured.impulse / (scene.reduced_mass * scene.velocity) - 1.0
        return min(max(e, LEAST_RESTITUTION), MOST_RESTITUTION)

    def law_guesses(self, names: list[str]) -> Iterator[Values]:
        """Of the law's own parameters: both springs, each with every damping."""
        bodies, held = bodies_of(self.space.scene), self.space.held
        depth = bodies.velocity * self.measured.duration / 3.0
        alpha = held.get("alpha", 1.0 if "alpha" not in own_keys(self.space.law) else 1.5)
        of_time = (spring_contact_time(1.0, alpha, bodies) / self.measured.duration) ** (alpha + 1.0)
        of_peak = spring_of_peak(self.measured.peak, alpha, bodies)
        stiffness = of_peak / depth ** (1.0 - alpha)
        known = {TOUCH: 0.0, "alpha": alpha, "e": self.restitution, "gap": 0.0}
        known |= {"k1": 2.0 * stiffness, "k2": 0.3 * stiffness, "yield_depth": 0.2 * depth}
        dampers = [name for name in names if name in damping_names(self.space.law) and name not in held]
        for k, factor in product((of_peak, of_time), DAMPING if dampers else (1.0,)):
            springs = {**known, "k": k, **held}
            damper = {name: factor * self._damping(name, springs, names, depth) for name in dampers}
            yield springs | damper

    def _damping(self, name: str, springs: Mapping[str, float], names: list[str], depth: float) -> float:
        """The damper's parameter whose force is 1 - e of the spring's at half depth and full speed."""
        chosen = {key: springs[key] for key in self.space.free if key in springs}
        velocity = self.space.scene.velocity
        forces = []
        for value in (0.0, 1.0):
            law = laws.get(self.space.law).of(self.space.scene_at(chosen | {name: value}))
            forces.append(float(law.force(0.5 * depth, velocity, Stage(True, 0.5 * depth, velocity))))
        return (1.0 - self.restitution) * forces[0] / (forces[1] - forces[0])

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
