"""The file of a pounding tuned mass damper: TOML -> Case, every fault reported at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from lumped import data
from lumped.alternatives import alternatives
from lumped.errors import BadInput, Fault, nearest
from lumped.key_table import placed, read_table, unknown_key
from lumped.keys import Choice, Key, Number, Text
from lumped.materials import Material
from lumped.materials.material import KEYS as MATERIAL_KEYS
from lumped.members import Member
from lumped.pounding_tmd.case import Case
from lumped.pounding_tmd.free_vibration import TIME_KEYS
from lumped.pounding_tmd.system import (
    DISPLACEMENT,
    LENGTH,
    OSCILLATOR_KEYS,
    RING_KEYS,
    START_KEYS,
    Memory,
    Oscillator,
    PoundingDamper,
    Ring,
    Start,
)
from lumped.scene_reader import NETWORKS
from lumped.toml_file import overridden, parsed

FOLDER, DEFAULT = "ptmd", "paper"
TABLES = ("structure", "damper", "ring", "motion")
NAME_KEYS: Mapping[str, Key] = {"name": Text(required=False)}
SIZE_KEYS: Mapping[str, Key] = {
    "gap": RING_KEYS["gap"],
    "memory": Choice(tuple(memory.value for memory in Memory), required=False),
    "thickness": replace(LENGTH, required=False),
    "rod_radius": replace(LENGTH, required=False),
}
# A rod's length along the ring, "(27)", or any law: force = coefficient E* depth^exponent.
LAW_KEYS: tuple[Mapping[str, Key], ...] = (
    {"length": LENGTH},
    {"coefficient": RING_KEYS["coefficient"], "exponent": RING_KEYS["exponent"]},
)
RELEASE_KEYS: Mapping[str, Key] = {
    "start": Choice(("both", "structure"), required=False),
    "displacement": replace(DISPLACEMENT, required=True),
}
Table = dict[str, Any]


def names() -> tuple[str, ...]:
    """Names of the packaged cases, sorted."""
    return tuple(sorted(path.stem for path in (data.directory() / FOLDER).glob("*.toml")))


def load(source: str | Path = DEFAULT, overrides: Mapping[str, object] | None = None) -> Case:
    """The case of a file or of a packaged name; `overrides` maps dotted keys to values that replace the file's.

    Raises BadInput with every fault found, at most 20.
    """
    path = Path(source)
    if not path.exists() and path.suffix != ".toml" and path.name == str(source):
        if path.name not in names():
            known = f"neither a file nor a packaged case; packaged: {', '.join(names())}{nearest(path.name, names())}"
            raise BadInput(Fault(path.name, "", known))
        path = data.directory() / FOLDER / f"{path.name}.toml"
    return _Reader(path.name, overridden(parsed(path), overrides or {}, path.name), path.parent).case()


def read(table: Mapping[str, object], source: str = "ptmd", overrides: Mapping[str, object] | None = None) -> Case:
    """The case of a table as in a file. Raises BadInput."""
    return _Reader(source, overridden(table, overrides or {}, source)).case()


class _Reader:
    """Walks the tables once and keeps every fault on the way; files are named from `folder` on."""

    def __init__(self, source: str, raw: Table, folder: Path = Path()) -> None:
        self.source = source
        self.raw = raw
        self.folder = folder
        self.faults: list[Fault] = []

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

    def name(self) -> str:
        """The case's name, by default the file's; checks the keys of the top level too."""
        top = {key: value for key, value in self.raw.items() if key not in TABLES}
        strange = [key for key in top if key not in NAME_KEYS]
        self.faults += [Fault(self.source, key, unknown_key(key, [*NAME_KEYS, *TABLES])) for key in strange]
        known = {key: value for key, value in top.items() if key in NAME_KEYS}
        return str(self.checked("", known, NAME_KEYS).get("name", Path(self.source).stem))

    def oscillator(self, part: str, required: bool = True) -> Oscillator | None:
        """Structure or damper; None when it is absent or has a fault."""
        table = self.table(part, required)
        values = {} if table is None else self.checked(part, table, OSCILLATOR_KEYS)
        return Oscillator(**values) if values.keys() == OSCILLATOR_KEYS.keys() else None

    def ring(self) -> tuple[Table, Ring | None]:
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
        make = Ring.struck_by_rod if "length" in values else Ring
        return sizes, make(**values, modulus=modulus, memory=memory)

    def material(self, table: object) -> Material | None:
        """The lining's material, None with a fault noted."""
        path = "ring.material"
        if not isinstance(table, Mapping):
            self.faults.append(Fault(self.source, path, "missing; a ring needs this table"))
            return None
        own = max(alternatives(NETWORKS, table.get("law")), key=lambda keys: len(keys.keys() & table.keys()))
        known = len(self.faults)
        values = self.checked(path, dict(table), {"law": Member(NETWORKS), **own, **MATERIAL_KEYS})
        if len(self.faults) > known:
            return None
        common = {key: values.pop(key) for key in MATERIAL_KEYS if key in values}
        try:
            return Material(values.pop("law").of(**placed(values, self.folder)), **common)
        except ValueError as error:
            self.faults.append(Fault(self.source, path, str(error)))
        except BadInput as bad:
            self.faults += [replace(fault, source=self.source, key=f"{path}.{fault.key}") for fault in bad.faults]
        return None

    def motion(self) -> tuple[Start | None, Table]:
        """How it starts, None with a fault noted, and the times given."""
        table = self.table("motion") or {}
        times: Mapping[str, Number] = {key: replace(kind, required=False) for key, kind in TIME_KEYS.items()}
        released = not table.keys() & START_KEYS.keys()
        own = RELEASE_KEYS if released else {**START_KEYS, "x1": replace(DISPLACEMENT, required=True)}
        known = len(self.faults)
        values = self.checked("motion", table, {**own, **times}) if "motion" in self.raw else {}
        spans = {key: values.pop(key) for key in times if key in values}
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

    def checked(self, path: str, table: Table, keys: Mapping[str, Key]) -> Table:
        """The accepted values of a table; what is refused becomes a fault."""
        values, faults = read_table(self.source, path, table, keys)
        self.faults += faults
        return values
