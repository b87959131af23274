"""A file of pounding frames: structures, gaps, the law between them, the ground; every fault reported at once."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from lumped.errors import BadInput, Fault
from lumped.laws._force_law import ForceLaw
from lumped.pounding.frames import Gap, PoundingFrames, ShearFrame, Slab
from lumped.pounding.gap_laws import GapLaw
from lumped.pounding.ground import STILL, GroundMotion, GroundRecord, Sine
from lumped.scene.tables import LAWS, TableReader
from lumped.schema import Table
from lumped.schema.csv_file import read_columns, read_header
from lumped.schema.files import SCENES, Packaged, overridden, parsed
from lumped.schema.keys import Choice, File, Key, Number, keys_of, written
from lumped.schema.members import Anything, Member, alternatives

CASES = Packaged("pound", "case")
GRAVITY = 9.80665  # physics: m/s2, what an acceleration_g counts in
COLUMNS = {"acceleration_m_per_s2": 1.0, "acceleration_g": GRAVITY}  # by the header of a record: in m/s2
MOST_GAPS = 50  # work: of one file; and so many slabs
GAP_NAME = re.compile(r"[\w -]{1,40}")  # it heads a column and a panel of the chart
TIME, ACCELERATION = Number(1e-9, 1e9, "s"), Key(Number(-1e6, 1e6, "m/s2"), "of the first half sine")
GROUNDS: Mapping[str, Mapping[str, Key]] = {
    "record": {
        "file": Key(File(), "CSV with time_s and acceleration_m_per_s2 or acceleration_g"),
        "scale": Key(Number(-1e6, 1e6), "factor of its accelerations", required=False),
    },
    "harmonic": {
        "amplitude": ACCELERATION,
        "frequency": Key(Number(1e-6, 1e6, "Hz"), "of the sine"),
        "cycles": Key(Number(0.0, 1e9), "how many, then still", required=False),
    },
    "pulse": {"amplitude": ACCELERATION, "duration": Key(TIME, "of half a sine")},
}
SCENE_KEY = Key(File(), "scene file, or packaged scene: shapes and materials where storeys meet", required=False)
MOTION_KEYS: Mapping[str, Key] = {"end_time": Key(TIME, "when to stop")}


Named = TypeVar("Named", Gap, Slab)


@dataclass(frozen=True)
class PoundingCase:
    """Frames, the law in their gaps, the ground, and how long they are followed, s."""

    name: str
    source: str
    frames: PoundingFrames
    law: GapLaw | None
    ground: GroundMotion
    end_time: float
    shaking: Table

    def laws(self, name: str | None = None) -> tuple[ForceLaw, ...]:
        """One for each gap: the file's, or the one called so that is given by the same keys. Raises BadInput."""
        found, faults = list[ForceLaw](), dict[Fault, None]()
        for gap in self.frames.gaps.values():
            try:
                if self.law is not None:
                    law = self.law if name is None else self.law.like(name, self.frames, gap)
                    found.append(law.at(self.frames, gap))
            except BadInput as bad:
                faults |= dict.fromkeys(bad.faults)
        if faults:
            raise BadInput(faults)
        return tuple(found)

    @property
    def own_law(self) -> str | None:
        """The name of the file's law, where it has gaps for it to act in."""
        return self.law.name if self.law and self.frames.gaps else None

    def check_laws(self, names: Sequence[str]) -> None:
        """Raise BadInput, with all faults, for other laws that cannot be given by the same keys."""
        faults = list[Fault]()
        for name in names:
            try:
                self.laws(name)
            except BadInput as bad:
                faults += bad.faults
        if self.law is None and names:
            faults.append(Fault("--laws", "", f"{self.name} has no law to compare with; accepted: a file with [law]"))
        if faults:
            raise BadInput(dict.fromkeys(faults))

    def to_dict(self) -> Table:
        """What was resolved from the file, SI."""
        return {
            "structure": {name: written(frame) for name, frame in self.frames.frames.items()},
            "gap": {name: written(gap) for name, gap in self.frames.gaps.items()},
            "slab": {name: written(slab) for name, slab in self.frames.slabs.items()},
            "law": None
            if self.law is None
            else {"name": self.law.name, "velocity": self.law.velocity, **self.law.values},
            "ground": self.shaking,
            "motion": {"end_time": self.end_time},
        }


def load(source: str | Path, overrides: Mapping[str, object] | None = None, calibrated: bool = False) -> PoundingCase:
    """The case of a file or of a packaged name; `overrides` maps dotted keys to values that replace the file's.

    `calibrated`: the numbers of its law are yet to come. Raises BadInput with every fault found, at most 20.
    """
    path = CASES.resolved(source)
    table = overridden(parsed(path), overrides or {}, path.name)
    case = PoundingReader(path.name, table, path.parent).case()
    if not calibrated:
        case.laws()
    return case


def read(table: Mapping[str, object], source: str = "pound", folder: Path = Path()) -> PoundingCase:
    """The case of a table as in a file, whose record lies in the folder. Raises BadInput."""
    case = PoundingReader(source, dict(table), folder).case()
    case.laws()
    return case


class PoundingReader(TableReader):
    """Makes a case of the tables of its file."""

    TABLES = ("structure", "gap", "slab", "law", "ground", "motion")

    def case(self) -> PoundingCase:
        """The case; raises BadInput when anything is wrong."""
        name, frames = self.name(), self.frames()
        gaps, slabs, law = self.named(Gap), self.named(Slab), self.law()
        shaking, ground = self.ground()
        motion = self.checked("motion", self.table("motion") or {}, MOTION_KEYS) if "motion" in self.raw else {}
        if "motion" not in self.raw:
            self.faults.append(Fault(self.source, "motion", "missing; accepted: a table with end_time, s"))
        pounding = (
            None
            if frames is None
            else self.made("gap", lambda: PoundingFrames(*frames, gaps, slabs), {}, "gap", "slab")
        )
        if gaps and law is None and "law" not in self.raw:
            self.faults.append(
                Fault(self.source, "law", "missing; accepted: a table with the law that acts in the gaps")
            )
        if pounding is None or self.faults:
            raise BadInput(self.faults)
        return PoundingCase(name, self.source, pounding, law, ground, motion["end_time"], shaking)

    def frames(self) -> tuple[ShearFrame, ShearFrame | None] | None:
        """Left and right; None with a fault noted."""
        tables = self.table("structure")
        if tables is None:
            return None
        known = len(self.faults)
        for key in sorted(tables.keys() - {"left", "right"}):
            self.faults.append(Fault(self.source, f"structure.{key}", "unknown key; accepted: left, right"))
        left = self.frame(tables, "left")
        right = self.frame(tables, "right") if "right" in tables else None
        return None if left is None or len(self.faults) > known else (left, right)

    def frame(self, tables: Table, side: str) -> ShearFrame | None:
        """One structure; None with a fault noted."""
        path, table = f"structure.{side}", tables.get(side)
        if not isinstance(table, Mapping):
            self.faults.append(
                Fault(self.source, path, "missing; accepted: a table with mass and stiffness of its storeys")
            )
            return None
        known = len(self.faults)
        values = self.checked(path, dict(table), keys_of(ShearFrame))
        return None if len(self.faults) > known else self.made(path, ShearFrame, values, "structure")

    def named(self, kind: type[Named]) -> dict[str, Named]:
        """All gaps, or slabs, that are accepted, by their names."""
        what = kind.name
        if what not in self.raw:
            return {}
        tables, found = self.table(what) or {}, dict[str, Named]()
        if len(tables) > MOST_GAPS:
            self.faults.append(Fault(self.source, what, f"{len(tables)} of them; accepted: at most {MOST_GAPS}"))
            return {}
        for name, table in tables.items():
            known, path = len(self.faults), f"{what}.{name}"
            if not GAP_NAME.fullmatch(name):
                reason = "accepted: a name of 1 to 40 letters, digits, spaces, - and _"
                self.faults.append(Fault(self.source, path, reason))
            elif isinstance(table, Mapping):
                values = self.checked(path, dict(table), keys_of(kind))
            else:
                self.faults.append(Fault(self.source, path, f"not a table; accepted: {', '.join(keys_of(kind))}"))
            if len(self.faults) == known:
                found[name] = kind(**values)
        return found

    def law(self) -> GapLaw | None:
        """The law; None without one, or with a fault noted."""
        if "law" not in self.raw:
            return None
        table = self.table("law") or {}
        known = len(self.faults)
        (own,) = alternatives(LAWS, table.get("name"))
        keys = {"name": Key(Member(LAWS.package)), **own, "velocity": keys_of(GapLaw)["velocity"], "scene": SCENE_KEY}
        values = self.checked("law", table, {key: one for key, one in keys.items() if key != "gap"})
        if len(self.faults) > known:
            return None
        name, velocity, scene = values.pop("name"), values.pop("velocity", None), values.pop("scene", None)
        return GapLaw(name, values, velocity, {} if scene is None else self.scene(scene), self.source)

    def scene(self, path: Path) -> Table:
        """The tables of a scene, of a file beside this one or of a packaged name; none with a fault noted."""
        try:
            return parsed(SCENES.path(path.name) if SCENES.is_name(str(path)) else SCENES.resolved(self.folder / path))
        except BadInput as bad:
            self.faults += [replace(fault, source=self.source, key="law.scene") for fault in bad.faults]
            return {}

    def ground(self) -> tuple[Table, GroundMotion]:
        """What the file says of the ground's motion, and the motion; at rest without a table or with a fault noted."""
        if "ground" not in self.raw:
            return {"kind": "still"}, STILL
        table, known = self.table("ground") or {}, len(self.faults)
        kind = table.get("kind")
        own = (
            GROUNDS[kind]
            if isinstance(kind, str) and kind in GROUNDS
            else {key: Key(Anything(), required=False) for key in table}
        )
        values = self.checked("ground", table, {**own, "kind": Key(Choice(tuple(GROUNDS)), "what moves it")})
        if len(self.faults) > known:
            return {}, STILL
        said = {key: str(value) if isinstance(value, Path) else value for key, value in values.items()}
        if kind == "record":
            return said, self.record(self.folder / values["file"], values.get("scale", 1.0)) or STILL
        if kind == "harmonic":
            return said, Sine(values["amplitude"], values["frequency"], values.get("cycles", np.inf))
        return said, Sine(values["amplitude"], 0.5 / values["duration"], 0.5)

    def record(self, path: Path, scale: float) -> GroundRecord | None:
        """The record of a CSV file, its times from the first on; None with a fault noted."""
        try:
            given = [name for name in COLUMNS if name in read_header(path)]
            column = given[0] if given else next(iter(COLUMNS))
            columns = read_columns(path, ("time_s", column))
        except BadInput as bad:
            self.faults += bad.faults
            return None
        time = columns["time_s"]
        back = np.flatnonzero(np.diff(time) <= 0.0)
        if len(given) > 1:
            self.faults.append(Fault(str(path), given[1], f"given beside {given[0]}; accepted: one of them"))
        if back.size:
            reason = f"row {back[0] + 2} is not later than the row before; accepted: ascending times"
            self.faults.append(Fault(str(path), "time_s", reason))
            return None
        return GroundRecord(time - time[0], scale * COLUMNS[column] * columns[column])

    def table(self, key: str) -> Table | None:
        """The table `key`; None with a fault noted."""
        value = self.raw.get(key)
        if isinstance(value, Mapping):
            return dict(value)
        reason = "missing; pounding structures need this table" if value is None else "not a table"
        self.faults.append(Fault(self.source, key, reason))
        return None
