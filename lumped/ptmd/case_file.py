"""A pounding tuned mass damper, how it starts and how long it is followed; its file, every fault reported at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from lumped.errors import BadInput, Fault
from lumped.materials import Material
from lumped.ptmd.free_vibration import TIME_KEYS
from lumped.ptmd.system import (
    DISPLACEMENT,
    LENGTH,
    Memory,
    Oscillator,
    PoundingDamper,
    PtmdRing,
    Start,
)
from lumped.scene.tables import TableReader
from lumped.schema import Table
from lumped.schema.files import Packaged, overridden, parsed
from lumped.schema.keys import Choice, Key, keys_of

CASES, DEFAULT = Packaged("ptmd", "case"), "paper"
RING_KEYS, START_KEYS = keys_of(PtmdRing), keys_of(Start)
SIZE_KEYS: Mapping[str, Key] = {
    "gap": RING_KEYS["gap"],
    "memory": Key(Choice(tuple(memory.value for memory in Memory)), "the surface between contacts", required=False),
    "thickness": replace(LENGTH, required=False),
    "rod_radius": replace(LENGTH, required=False),
}
# A rod's length along the ring, "(27)", or any law: force = coefficient E* depth^exponent.
LAW_KEYS: tuple[Mapping[str, Key], ...] = (
    {"length": LENGTH},
    {"coefficient": RING_KEYS["coefficient"], "exponent": RING_KEYS["exponent"]},
)
RELEASE_KEYS: Mapping[str, Key] = {
    "start": Key(Choice(("both", "structure")), "what is released", required=False),
    "displacement": DISPLACEMENT,
}


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


def load(source: str | Path = DEFAULT, overrides: Mapping[str, object] | None = None) -> Case:
    """The case of a file or of a packaged name; `overrides` maps dotted keys to values that replace the file's.

    Raises BadInput with every fault found, at most 20.
    """
    path = CASES.resolved(source)
    return _Reader(path.name, overridden(parsed(path), overrides or {}, path.name), path.parent).case()


def read(table: Mapping[str, object], source: str = "ptmd", overrides: Mapping[str, object] | None = None) -> Case:
    """The case of a table as in a file. Raises BadInput."""
    return _Reader(source, overridden(table, overrides or {}, source)).case()


class _Reader(TableReader):
    """Makes a case of the tables of its file."""

    TABLES = ("structure", "damper", "ring", "motion")

    def case(self) -> Case:
        """The case; raises BadInput when anything is wrong."""
        name = self.name()
        structure, damper = self.oscillator("structure"), self.oscillator("damper", required=False)
        sizes, ring = self.ring()
        if ring is not None and "damper" not in self.raw:
            self.faults.append(Fault(self.source, "damper", "missing; accepted: a ring only with a damper"))
        start, times = self.motion()
        if self.faults or structure is None or start is None:
            raise BadInput(self.faults)
        return Case(name, self.source, PoundingDamper(structure, damper, ring), start, **times, **sizes)

    def oscillator(self, part: str, required: bool = True) -> Oscillator | None:
        """Structure or damper; None when it is absent or has a fault."""
        table = self.table(part, required)
        values = {} if table is None else self.checked(part, table, keys_of(Oscillator))
        return Oscillator(**values) if values.keys() == keys_of(Oscillator).keys() else None

    def ring(self) -> tuple[Table, PtmdRing | None]:
        """Lengths for the ledger, and the ring; None when it is absent or has a fault."""
        table = self.table("ring", required=False)
        if table is None:
            return {}, None
        material = self.material(table.pop("material", None))
        law = max(LAW_KEYS, key=lambda keys: len(keys.keys() & table.keys()))
        known = len(self.faults)
        values = self.checked("ring", table, {**SIZE_KEYS, **law})
        sizes: Table = {key: values.pop(key) for key in ("thickness", "rod_radius") if key in values}
        if material is None or len(self.faults) > known:
            return {}, None
        memory, modulus = Memory(values.pop("memory", Memory.RECOVERING.value)), material.contact_modulus()
        make = PtmdRing.struck_by_rod if "length" in values else PtmdRing
        return sizes, make(**values, modulus=modulus, memory=memory)

    def material(self, table: object) -> Material | None:
        """The lining's material, None with a fault noted."""
        path = "ring.material"
        if not isinstance(table, Mapping):
            self.faults.append(Fault(self.source, path, "missing; a ring needs this table"))
            return None
        return self.network(path, dict(table))

    def motion(self) -> tuple[Start | None, Table]:
        """How it starts, None with a fault noted, and the times given."""
        table = self.table("motion") or {}
        released = not table.keys() & START_KEYS.keys()
        own = RELEASE_KEYS if released else START_KEYS
        known = len(self.faults)
        values = self.checked("motion", table, {**own, **TIME_KEYS}) if "motion" in self.raw else {}
        spans = {key: values.pop(key) for key in TIME_KEYS if key in values}
        if len(self.faults) > known or not values:
            return None, spans
        try:
            if not released:
                return Start(**values), spans
            release = Start.both if values.get("start", "both") == "both" else Start.structure
            return release(values["displacement"]), spans
        except BadInput as bad:
            key = "displacement" if released else "x1"
            self.faults += [replace(fault, source=self.source, key=f"motion.{key}") for fault in bad.faults]
            return None, spans

    def table(self, key: str, required: bool = True) -> Table | None:
        """The table `key`, None when it is missing or no table: a fault where it is required or no table."""
        value = self.raw.get(key)
        if isinstance(value, Mapping):
            return dict(value)
        if key in self.raw:
            self.faults.append(Fault(self.source, key, "not a table"))
        elif required:
            self.faults.append(Fault(self.source, key, "missing; a pounding damper's file needs this table"))
        return None
