"""The pounding tuned mass damper of section 5: a structure, a damper on it, and a viscoelastic ring that stops it.

As data of a file, and as masses in a row with the force of a side of the ring.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated, ClassVar

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.laws.correspondence import HereditaryForce
from lumped.materials import Relaxation
from lumped.numbers import Array
from lumped.pounding.flow import LinearBodies
from lumped.schema.keys import Key, Number, Record
from lumped.shapes.base import SIZE
from lumped.solvers.point.memory import HereditaryLoad

LENGTH = Key(SIZE, "length")
DISPLACEMENT, VELOCITY = Key(Number(-1e4, 1e4, "m"), "displacement"), Key(Number(-1e4, 1e4, "m/s"), "velocity")
MASS, STIFFNESS, DAMPING = Number(1e-9, 1e12, "kg"), Number(1e-9, 1e18, "N/m"), Number(0.0, 1e15, "N s/m")
LEAST = 1e-100  # rounding: m or m/s whose energy is still a number
SIDES = (1, -1)  # signs of the ring's two sides
# Beyond this ratio of the shortest period to a relaxation time the digits that are promised are lost.
STIFFEST = 6e6


class Memory(Enum):
    """What the ring's surface does between two contacts (the paper's Fig. 15)."""

    RECOVERING = "recovering"  # it creeps back under no force; the next contact begins where the surface is by then
    RESET = "reset"  # the same until the damper has left the undeformed ring, when all is forgotten
    CONTINUOUS = "continuous"  # the transfer function "(32)" runs on: it follows max(depth, 0), its tension cut off


@dataclass(frozen=True)
class Oscillator(Record):
    """Mass, kg, on a spring, N/m, and a dashpot, N s/m. Raises BadInput."""

    mass: Annotated[float, Key(MASS, "mass")]
    stiffness: Annotated[float, Key(STIFFNESS, "stiffness of its spring")]
    damping: Annotated[float, Key(DAMPING, "that of its dashpot")]
    name: ClassVar[str] = "oscillator"


@dataclass(frozen=True)
class PtmdRing(Record):
    """The lining of both stops, `gap` metres from the damper at rest.

    Force F = coefficient * int E*(t-s) d(depth^exponent), the correspondence law "(29)" to "(32)" read as a
    convolution, without tension; `modulus` is E*(t) in Pa. Raises BadInput.
    """

    gap: Annotated[float, Key(Number(0.0, 1e4, "m"), "distance between damper and ring at rest")]
    modulus: Relaxation
    coefficient: Annotated[float, Key(Number(1e-12, 1e12, "m^(2-exponent)"), "force per E* and depth^exponent")]
    exponent: Annotated[float, Key(Number(1.0, 3.0), "exponent of the depth")] = 1.0
    memory: Memory = Memory.RECOVERING
    name: ClassVar[str] = "ring"

    @classmethod
    def struck_by_rod(
        cls, gap: float, modulus: Relaxation, length: float, memory: Memory = Memory.RECOVERING
    ) -> PtmdRing:
        """The paper's ring, F = (pi/4) l E* depth, "(27)"; length l along the rod, m."""
        return cls(gap, modulus, 0.25 * np.pi * length, 1.0, memory)

    @property
    def stiffness(self) -> Relaxation:
        """The relaxation of the force, N/m^exponent, after a sudden unit of depth^exponent."""
        return self.modulus.scaled(self.coefficient)


@dataclass(frozen=True)
class PoundingDamper:
    """Structure, damper on it and ring around the damper; without `ring` a plain tuned mass damper.

    Without `damper` the structure alone. Raises BadInput for a ring without a damper.
    """

    structure: Oscillator
    damper: Oscillator | None = None
    ring: PtmdRing | None = None

    def __post_init__(self) -> None:
        if self.ring is not None and self.damper is None:
            raise BadInput(Fault("pounding damper", "ring", "nothing strikes it; accepted: only with a damper"))


@dataclass(frozen=True)
class Start(Record):
    """Displacements, m, and velocities, m/s, at t = 0. Raises BadInput when all are zero, or as good as that.

    Where the damper starts inside the ring it has been held there until the ring relaxed.
    """

    x1: Annotated[float, DISPLACEMENT]
    x2: Annotated[float, DISPLACEMENT] = 0.0
    v1: Annotated[float, VELOCITY] = 0.0
    v2: Annotated[float, VELOCITY] = 0.0
    name: ClassVar[str] = "start"

    def __post_init__(self) -> None:
        super().__post_init__()
        if max(map(abs, (self.x1, self.x2, self.v1, self.v2))) < LEAST:
            raise BadInput(Fault("start", "x1", "nothing moves; accepted: one value that is not zero"))

    @classmethod
    def both(cls, displacement: float) -> Start:
        """Both masses released from the same displacement, m: the damper rests in the middle of its ring."""
        return cls(displacement, displacement)

    @classmethod
    def structure(cls, displacement: float) -> Start:
        """The structure alone displaced, m."""
        return cls(displacement)


def bodies_of(system: PoundingDamper, start: Start) -> LinearBodies:
    """Structure and damper as masses in a row; the ring's two gaps, depth x2 - x1 - gap and x1 - x2 - gap."""
    one, two, ring = system.structure, system.damper, system.ring
    if two is None:
        own = (np.array([[one.stiffness]]), np.array([[one.damping]]))
        return LinearBodies(np.array([one.mass]), *own, np.zeros((0, 1)), np.zeros(0), np.array([start.x1, start.v1]))
    link = np.array([[1.0, -1.0], [-1.0, 1.0]])
    stiffness, damping = two.stiffness * link, two.damping * link
    stiffness[0, 0] += one.stiffness
    damping[0, 0] += one.damping
    sides = np.outer(SIDES, [-1.0, 1.0]) if ring else np.zeros((0, 2))
    distances = np.full(len(sides), ring.gap if ring else 0.0)
    placed = np.array([start.x1, start.x2, start.v1, start.v2])
    return LinearBodies(np.array([one.mass, two.mass]), stiffness, damping, sides, distances, placed)


@dataclass(frozen=True)
class PowerLoad:
    """The load curve depth^exponent, in m^exponent; as everywhere its slope counts as twice a contact radius."""

    exponent: float

    def force(self, depth: Array) -> Array:
        """The load."""
        return np.asarray(depth) ** self.exponent

    def force_and_slope(self, depth: Array) -> tuple[Array, Array]:
        """The load and its slope."""
        return self.force(depth), np.asarray(self.exponent * np.asarray(depth) ** (self.exponent - 1.0))

    def contact_radius(self, depth: Array) -> Array:
        """Half the slope."""
        return 0.5 * self.force_and_slope(depth)[1]

    def depth_slope(self, contact_radius: Array) -> Array:
        """d depth over d radius; infinite where the slope stays."""
        if self.exponent == 1.0:
            return np.full_like(contact_radius, np.inf)
        power = self.exponent - 1.0
        depth = (2.0 * np.asarray(contact_radius) / self.exponent) ** (1.0 / power)
        return np.asarray(2.0 * depth ** (1.0 - power) / (self.exponent * power))


def law_of(ring: PtmdRing, bodies: LinearBodies) -> HereditaryForce:
    """The force of a side over its depth. Raises BadInput where it relaxes far too fast for the vibration."""
    stiffness, mass = ring.stiffness, float(bodies.reduced_masses[0])
    steepest = float(bodies.stiffness.max()) + _steepest(ring, bodies)
    shortest = 2.0 * np.pi * np.sqrt(mass / steepest) / STIFFEST
    creep = [stiffness.viscosity / stiffness.glassy] if stiffness.viscosity and stiffness.glassy else []
    if min([*stiffness.times, *creep], default=shortest) < shortest:
        message = f"relaxes in less than {shortest:.2g} s, too fast beside the vibration; cure: leave that term out"
        raise BadInput(Fault("ring", "material", message))
    ends = "depth" if stiffness.is_elastic else "force"
    scale = float(np.pi * np.sqrt(mass / steepest))
    return HereditaryForce(
        load=HereditaryLoad(PowerLoad(ring.exponent), stiffness), rule=ring.memory.value, scale=scale, exit=ends
    )


def _steepest(ring: PtmdRing, bodies: LinearBodies) -> float:
    """Largest slope of the ring's force over the depth, N/m, with all the energy of the start in it."""
    glassy, power = ring.stiffness.glassy, ring.exponent
    if glassy == 0.0:
        return 0.0
    deepest = ((power + 1.0) * sum(bodies.energies(bodies.start)) / glassy) ** (1.0 / (power + 1.0))
    return float(power * glassy * deepest ** (power - 1.0))
