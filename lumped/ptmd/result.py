"""What a simulated pounding tuned mass damper did: rows, contacts, energies, measures."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from lumped.numbers import Array
from lumped.ptmd.system import PoundingDamper, Start

COLUMNS = {
    "time": "time_s",
    "x1": "x1_m",
    "v1": "v1_m_per_s",
    "a1": "a1_m_per_s2",
    "x2": "x2_m",
    "v2": "v2_m_per_s",
    "a2": "a2_m_per_s2",
    "force": "force_N",
    "depth": "depth_m",
}


@dataclass(frozen=True, eq=False)
class PtmdMotion:
    """Columns of one length, SI; 1 is the structure, 2 the damper (not a number without one).

    `force` is f of "(33)", with the sign of x2 - x1; `depth` the penetration of the undeformed ring, >= 0. Two
    rows stand at the instant of a switch of contact.
    """

    time: Array
    x1: Array
    v1: Array
    a1: Array
    x2: Array
    v2: Array
    a2: Array
    force: Array
    depth: Array


@dataclass(frozen=True)
class PtmdContact:
    """One contact: side of the ring (1 at x2 - x1 > 0, else -1), times, s, largest force, N, and penetration, m.

    `end` is None when it still lasts at the end of the motion.
    """

    side: int
    start: float
    end: float | None
    peak_force: float
    peak_depth: float


@dataclass(frozen=True)
class Energy:
    """Where the energy is at the end, J, each term computed on its own; `initial` holds that of a ring compressed
    at the start.

    `lost_ring` is spent in the lining (and forgotten by it, with that memory), `stored_ring` still locked in it.
    For an exponent other than 1 the law has no energy of its own: `stored_ring` is None and `lost_ring` all
    that the ring took and did not give back. `cut_tension` is the work which the tension cut off from a
    continuous memory does on the ring: nobody pays it.
    """

    initial: float
    kinetic: float
    potential: float
    lost_structure: float
    lost_damper: float
    lost_ring: float
    stored_ring: float | None
    cut_tension: float

    @property
    def residual(self) -> float:
        """What is left of the balance, J."""
        spent = self.lost_structure + self.lost_damper + self.lost_ring
        left = self.kinetic + self.potential + (self.stored_ring or 0.0)
        return self.initial + self.cut_tension - spent - left

    def to_dict(self) -> dict[str, float | None]:
        """The terms and the residual, J."""
        return asdict(self) | {"residual": self.residual}


@dataclass(frozen=True)
class Measures:
    """The numbers that tell one motion from another, SI; None where undefined.

    Root mean squares are taken over the first `window` seconds; `t50` and `t10` are the last times at which |x1|
    exceeds 50 and 10 % of its start. The first contact is the first that begins after t = 0.
    """

    window: float
    max_acceleration: float
    rms_acceleration: float
    rms_displacement: float
    t50: float | None
    t10: float | None
    contacts: int
    last_contact: float | None
    first_contact_duration: float | None
    peak_force: float
    peak_depth: float


@dataclass(frozen=True, eq=False)
class PtmdResult:
    """One free vibration of a system."""

    system: PoundingDamper
    start: Start
    motion: PtmdMotion
    contacts: tuple[PtmdContact, ...]
    energy: Energy
    measures: Measures
