"""A pounding tuned mass damper, how it starts and how long it is followed."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from lumped.ptmd.system import PoundingDamper, Start
from lumped.schema import Table


@dataclass(frozen=True)
class Case:
    """A system, how it starts, and how long it is followed, s; lengths of the ring, m, for the ledger alone."""

    name: str
    source: str
    system: PoundingDamper
    start: Start
    end_time: float = 20.0
    window: float = 5.0
    thickness: float | None = None
    rod_radius: float | None = None

    def to_dict(self) -> Table:
        """What was resolved from the file: oscillators, force relaxation of the ring, start and times, SI."""
        system = asdict(self.system)
        if self.system.ring is not None:
            stiffness = self.system.ring.stiffness
            force = {"relaxed": stiffness.relaxed, "moduli": stiffness.moduli, "times": stiffness.times}
            system["ring"] = {
                "gap": self.system.ring.gap,
                "exponent": self.system.ring.exponent,
                "memory": self.system.ring.memory.value,
                "force_relaxation": force | {"viscosity": stiffness.viscosity},
                "thickness": self.thickness,
                "rod_radius": self.rod_radius,
            }
        return {**system, "start": asdict(self.start), "end_time": self.end_time, "window": self.window}
