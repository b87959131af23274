"""Reading the tables of a file: their accepted values, a material among them, and every fault on the way."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import ClassVar, TypeVar

from lumped.errors import BadInput, Fault
from lumped.materials import Material
from lumped.materials.networks import NETWORKS
from lumped.scene.tables import NAME_KEYS
from lumped.schema import Table
from lumped.schema.keys import Key
from lumped.schema.members import Member, alternatives
from lumped.schema.record import keys_of, placed, read_table, unknown_key

Made = TypeVar("Made")


class TableReader:
    """Walks the tables of a file once and keeps every fault; `TABLES` are those it may hold.

    `source` is what faults call the file, `folder` where the files start that it names.
    """

    TABLES: ClassVar[tuple[str, ...]]

    def __init__(self, source: str, raw: Table, folder: Path = Path()) -> None:
        self.source = source
        self.raw = raw
        self.folder = folder
        self.faults: list[Fault] = []

    def name(self) -> str:
        """The name given, by default the file's; checks the keys of the top level too."""
        top = {key: value for key, value in self.raw.items() if key not in self.TABLES}
        values, faults = read_table(self.source, "", {"name": Path(self.source).stem} | top, NAME_KEYS)
        names = [*NAME_KEYS, *self.TABLES]
        for fault in faults:
            if fault.key not in NAME_KEYS:
                fault = replace(fault, message=unknown_key(fault.key, names))
            elif fault.key not in top:
                fault = replace(fault, message=f"missing, and the file's own name will not do: {fault.message}")
            self.faults.append(fault)
        return str(values.get("name", ""))

    def checked(self, path: str, table: Table, keys: Mapping[str, Key]) -> Table:
        """The accepted values of a table; what is refused becomes a fault."""
        values, faults = read_table(self.source, path, table, keys)
        self.faults += faults
        return values

    def made(self, path: str, make: Callable[..., Made], values: Table, *parts: str) -> Made | None:
        """What is made of a table's checked values; None with a fault noted, which one of `parts` found at its key."""
        try:
            return make(**values)
        except ValueError as error:
            self.faults.append(Fault(self.source, path, str(error)))
        except BadInput as bad:
            self.faults += [fault.at(self.source, dict.fromkeys(parts, path)) for fault in bad.faults]
        return None

    def network(self, path: str, table: Table) -> Material | None:
        """The material of a table, None with a fault noted."""
        own = max(alternatives(NETWORKS, table.get("law")), key=lambda keys: len(keys.keys() & table.keys()))
        known = len(self.faults)
        shared = keys_of(Material)
        values = self.checked(path, table, {"law": Key(Member(NETWORKS.package)), **own, **shared})
        if len(self.faults) > known:
            return None
        common = {key: values.pop(key) for key in shared if key in values}
        law = NETWORKS.get(values.pop("law"))
        young = self.made(path, law.of, placed(values, self.folder), "material", "samples", "prony fit")
        if young is None:
            return None
        return self.made(path, partial(Material, young), common, "material")
