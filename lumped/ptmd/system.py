"""The pounding tuned mass damper of section 5: a structure, a damper on it, and a viscoelastic ring that stops it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated, ClassVar

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.materials import Relaxation
from lumped.schema.keys import Key, Number, Record
from lumped.shapes.base import SIZE

LENGTH = Key(SIZE, "length")
DISPLACEMENT, VELOCITY = Key(Number(-1e4, 1e4, "m"), "displacement"), Key(Number(-1e4, 1e4, "m/s"), "velocity")
MASS, STIFFNESS, DAMPING = Number(1e-9, 1e12, "kg"), Number(1e-9, 1e18, "N/m"), Number(0.0, 1e15, "N s/m")
LEAST = 1e-100  # rounding: m or m/s whose energy is still a number
SIDES = (1, -1)  # signs of the ring's two sides


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
