"""What pounding frames did: rows, contacts, peaks of every storey, and where the energy went."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from lumped.numbers import Array
from lumped.pounding.frames import PoundingFrames
from lumped.schema import Table


@dataclass(frozen=True, eq=False)
class FramesMotion:
    """Rows of time, s, (k,): displacements and drifts, m, velocities, m/s, and total accelerations, m/s2, (k, n); the
    ground's, m/s2, (k,); forces of the gaps, N, (k, m).
    """

    time: Array
    displacement: Array
    drift: Array
    velocity: Array
    acceleration: Array
    ground: Array
    force: Array


@dataclass(frozen=True)
class FrameContact:
    """One contact: its gap; start and end, s; largest force, N, and when, s; impulse, N s.

    `closing`: the speed at touch, m/s; `restitution`: that at the end over it. `end` and `restitution` are None where
    it lasts to the end of the motion.
    """

    gap: str
    start: float
    end: float | None
    peak_force: float
    peak_time: float
    impulse: float
    closing: float
    restitution: float | None


@dataclass(frozen=True)
class StoreyPeaks:
    """The largest of each, in size: displacement and drift, m, total acceleration, m/s2; strain energy of the columns
    below and kinetic energy, J.
    """

    displacement: float
    drift: float
    acceleration: float
    strain: float
    kinetic: float


@dataclass(frozen=True)
class FramesEnergy:
    """Where the energy is at the end, J, relative to the ground; each term computed on its own.

    `initial` at t = 0, `input` what the ground did since; lost in the structures' dashpots and in contacts, and what
    contacts still hold.
    """

    initial: float
    input: float
    kinetic: float
    strain: float
    damping: float
    contact: float
    contact_stored: float

    @property
    def residual(self) -> float:
        """What is left of the balance, J."""
        spent = self.damping + self.contact
        return self.initial + self.input - spent - self.kinetic - self.strain - self.contact_stored

    @property
    def open_share(self) -> float:
        """The residual over all that came in and was there, or was lost since."""
        whole = self.initial + abs(self.input) + self.damping + abs(self.contact)
        return abs(self.residual) / whole if whole else 0.0

    def to_dict(self) -> dict[str, float]:
        """The terms and the residual, J."""
        return asdict(self) | {"residual": self.residual}


@dataclass(frozen=True, eq=False)
class FramesResult:
    """One motion of frames. `steps`: how many it took, `pressed_steps` those of them within contacts."""

    frames: PoundingFrames
    motion: FramesMotion
    contacts: tuple[FrameContact, ...]
    peaks: tuple[StoreyPeaks, ...]
    energy: FramesEnergy
    steps: int
    pressed_steps: int

    @property
    def peak_force(self) -> float:
        """Of all contacts, N."""
        return max((contact.peak_force for contact in self.contacts), default=0.0)

    @property
    def impulse(self) -> float:
        """Of all contacts together, N s."""
        return sum(contact.impulse for contact in self.contacts)

    def measures(self) -> Table:
        """The numbers that tell one motion from another, SI."""
        found: Table = {
            "peak_drift": max(one.drift for one in self.peaks),
            "peak_displacement": max(one.displacement for one in self.peaks),
            "peak_acceleration": max(one.acceleration for one in self.peaks),
            "peak_force": self.peak_force,
            "impulse": self.impulse,
            "contacts": len(self.contacts),
        }
        return found
