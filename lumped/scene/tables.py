"""The tables of a scene, and how they are read: from a TOML file, from a packaged one by its name, or from a mapping.

`[model]`, `[motion]` and `[law]` with the keys and ranges of the scene's own numbers come first. The tables of a file
are walked once, their values checked, a material's among them, and every fault is reported; raw `[numerics]` are
handed on.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, ClassVar, Protocol, TypeVar, cast

from lumped.errors import BadInput, Fault
from lumped.materials import Material
from lumped.materials.energies.base import energy_of
from lumped.materials.networks import NETWORKS
from lumped.schema import Table
from lumped.schema.files import SCENES, overridden, parsed
from lumped.schema.keys import (
    UNKNOWN_KEY,
    Choice,
    Count,
    Described,
    Flag,
    Key,
    Number,
    Part,
    Record,
    Text,
    keys_of,
    optional,
    placed,
    read_table,
    unknown_key,
)
from lumped.schema.members import Folder, Member, alternatives
from lumped.shapes import SHAPES, Shape
from lumped.targets import TARGETS, Target

LAWS = Folder[Described]("lumped.laws", source="law")  # they know scenes: here only the names of their keys are known
LEAST_MASS = 1e-21  # safety: kg, the lightest body that is accepted
END_IN_CONTACT_TIMES = 50.0  # work: default end of the motion for each contact, in elastic contact times
DIRECTIONS = ("unsaid", "down", "horizontal")
KINEMATICS = ("small", "finite")
MASS = Key(Number(0.0, 1e12, "kg"), "mass of the striker")
SPEED = Number(1e-9, 1e5, "m/s")
VELOCITY = Key(SPEED, "velocity of the striker at first touch")
SECOND_MASS = Key(Number(LEAST_MASS, 1e12, "kg"), "mass of a free second body", required=False)
NAME = Key(Text(), "name of the scene", required=False)
STRIKER_KEYS: Mapping[str, Key] = {"mass": MASS, "velocity": VELOCITY}
TARGET_KEYS: Mapping[str, Key] = {"mass": SECOND_MASS}
MISSING_TABLE = "missing; a scene needs this table"
NAME_KEYS: Mapping[str, Key] = {"name": NAME}


@dataclass(frozen=True)
class Model(Record):
    """The `[model]` table: inertia of deformable bodies, profile, gravity along the motion (m/s2), where that leads.

    No gravity is assumed; `direction` tells whether that leaves a weight out.
    """

    inertia: Annotated[bool, Key(Flag(), "whether deformable bodies have inertia")] = False
    profile: Annotated[str, Key(Choice(("exact", "parabola")), "the striker's profile")] = "exact"
    gravity: Annotated[float, Key(Number(-1e6, 1e6, "m/s2"), "gravity along the motion")] = 0.0
    direction: Annotated[str, Key(Choice(DIRECTIONS), "where the motion leads")] = DIRECTIONS[0]
    kinematics: Annotated[str, Key(Choice(KINEMATICS), "how large displacements and strains may be")] = KINEMATICS[0]
    plasticity: Annotated[bool, Key(Flag(), "whether the target yields, by von Mises")] = False
    name: ClassVar[str] = "model"

    @property
    def finite(self) -> bool:
        """Whether displacements and strains may be large."""
        return self.kinematics == "finite"

    def resolved(self, material: Material | None) -> Table:
        """What a record says of it: its keys, and the elastic energy of a material that is strained much."""
        energy = {"energy": energy_of(material.hyperelastic).formula} if self.finite and material is not None else {}
        return vars(self) | energy


@dataclass(frozen=True)
class Motion(Record):
    """The `[motion]` table: how many impacts are followed, and until when (s; None: 50 contact times)."""

    impacts: Annotated[int, Key(Count(1, 100), "how many impacts are followed")] = 1
    end_time: Annotated[float | None, Key(Number(1e-15, 1e12, "s"), "when to stop")] = None
    name: ClassVar[str] = "motion"

    def until(self, contact_time: float, flight: float) -> float:
        """When to stop, s: the end time, else time for every impact and for the flight, s, between two."""
        return self.end_time or END_IN_CONTACT_TIMES * contact_time * self.impacts + flight * (self.impacts - 1)


@dataclass(frozen=True)
class LawChoice:
    """The `[law]` table: a lumped law by its name, with parameters of its own."""

    name: str
    values: Table = field(default_factory=dict)

    def __post_init__(self) -> None:
        (keys,) = LAWS.get(self.name).sets
        _, faults = read_table("law", "", self.values, keys)
        if faults:
            raise BadInput(faults)


def inertia_faults(source: str, inertia: bool, density: float | None, target: Target | None) -> list[Fault]:
    """What is missing for `model.inertia = true`, or speaks against false; without geometry there is no target."""
    if not inertia:
        if target is not None and target.only_with_inertia:
            reason = f"missing or false: a {target.name} is made of waves; accepted: true"
            return [Fault(source, "model.inertia", reason)]
        return []
    faults = []
    if target is None or not target.has_inertia:
        where = "a law of its own" if target is None else target.name
        reason = f"true is not available for {where} in this version; accepted: false, or target.shape {_moving()}"
        faults.append(Fault(source, "model.inertia", reason))
    if target is not None and density is None:
        reason = "missing; model.inertia = true needs it, in kg/m3; the equivalent E* of two bodies is no wave medium"
        faults.append(Fault(source, f"{target.owner}.material.density", reason))
    return faults


def gravity_faults(source: str, model: Model) -> list[Fault]:
    """Gravity along a motion that is said to lead across it."""
    if not model.gravity or model.direction != "horizontal":
        return []
    reason = f"{model.gravity:g} m/s2 along a horizontal motion; accepted: 0, or model.direction = 'down'"
    return [Fault(source, "model.gravity", reason)]


def mass_faults(source: str, mass: float, swinging: float) -> list[Fault]:
    """Too little mass, kg: none at all is for a block whose own inertia swings."""
    if mass >= LEAST_MASS or (mass == 0.0 and swinging > 0.0):
        return []
    reason = f"{mass:g}: accepted {SECOND_MASS.kind.accepted}; 0 of a block with model.inertia"
    return [Fault(source, "striker.mass", reason)]


def _moving() -> str:
    """Names of the targets whose waves can be followed."""
    return ", ".join(name for name, target in TARGETS.members.items() if target.kind.has_inertia)


def load(
    kind: Callable[..., Impact],
    source: str | Path,
    overrides: Mapping[str, object] | None = None,
    law_known: bool = True,
) -> tuple[Impact, Table]:
    """The scene, made by its ``kind``, of a file or of a packaged name, and its raw `[numerics]` table.

    `overrides` maps dotted keys ("striker.velocity") to values that replace the file's. Where the law is yet to be
    found, not `law_known`, mass and velocity are enough. Raises BadInput with every fault found, at most 20.
    """
    return reader_of(source, overrides).scene(kind, law_known)


def load_indenter(
    kind: Callable[..., Pressed], source: str | Path, overrides: Mapping[str, object] | None = None
) -> tuple[Pressed, Table]:
    """What a slow indentation needs of a file, and its raw `[numerics]`. Raises BadInput with every fault."""
    return reader_of(source, overrides).indenter(kind)


def read(
    kind: Callable[..., Impact],
    table: Mapping[str, object],
    source: str = "scene",
    overrides: Mapping[str, object] | None = None,
) -> tuple[Impact, Table]:
    """The scene of a table as in a scene file, and its raw `[numerics]` table. Raises BadInput."""
    return SceneReader(source, overridden(table, overrides or {}, source)).scene(kind)


def reader_of(source: str | Path, overrides: Mapping[str, object] | None) -> SceneReader:
    """What reads the file of a path or a packaged name. Raises BadInput."""
    path = SCENES.resolved(source)
    return SceneReader(path.name, overridden(parsed(path), overrides or {}, path.name), path.parent)


class Lawful(Protocol):
    """What a scene file may describe: an impact, perhaps with a law of its own."""

    def check_law(self) -> None:
        """Raise BadInput for a law of its own that has no answer for it."""


Impact = TypeVar("Impact", bound=Lawful)


Pressed = TypeVar("Pressed")
B = TypeVar("B")
Made = TypeVar("Made")
R = TypeVar("R", bound=Record)
Known = dict[str, tuple[object, object]]  # by the path of a table: the last one without a fault, and what it gave


class TableReader:
    """Walks the tables of a file once and keeps every fault; `TABLES` are those it may hold.

    `source` is what faults call the file, `folder` where the files start that it names.
    """

    TABLES: ClassVar[tuple[str, ...]]
    HOMES: ClassVar[Mapping[str, Mapping[str, Key]]] = {}  # tables whose keys are often written into another one

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
                fault = self._led_home(replace(fault, message=unknown_key(fault.key, names)))
            elif fault.key not in top:
                fault = replace(fault, message=f"missing, and the file's own name will not do: {fault.message}")
            self.faults.append(fault)
        return str(values.get("name", ""))

    def checked(self, path: str, table: Table, keys: Mapping[str, Key], beside: tuple[str, ...] = ()) -> Table:
        """The accepted values of a table, that may hold others `beside` them; what is refused becomes a fault."""
        values, faults = read_table(self.source, path, table, keys, beside)
        self.faults += (self._led_home(fault) for fault in faults)
        return values

    def _led_home(self, fault: Fault) -> Fault:
        """The fault of a key that stands in the wrong table with the right one named."""
        name = fault.key.rpartition(".")[2]
        homes = [home for home, keys in self.HOMES.items() if name in keys and f"{home}.{name}" != fault.key]
        if not homes or not fault.message.startswith(UNKNOWN_KEY):
            return fault
        return replace(fault, message=f"{fault.message.partition('; did you')[0]}; {name} stands in [{homes[0]}]")

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
        return self.made(path, lambda **own: Material(young, **own).with_reference(young), common, "material")


class SceneReader(TableReader):
    """Makes a scene, or what a slow indentation needs of it, of the tables of a scene file."""

    TABLES = ("striker", "target", "model", "motion", "law", "numerics")
    HOMES: ClassVar[Mapping[str, Mapping[str, Key]]] = {
        "striker": STRIKER_KEYS,
        "model": keys_of(Model),
        "motion": keys_of(Motion),
    }

    def __init__(self, source: str, raw: Table, folder: Path = Path(), known: Known | None = None) -> None:
        """`known`: parts of other scenes of this folder, taken where the very same table describes them here."""
        super().__init__(source, raw, folder)
        self.known: Known = {} if known is None else known

    def scene(self, kind: Callable[..., Impact], law_known: bool = True) -> tuple[Impact, Table]:
        """The scene and the raw numerics; raises BadInput when anything is wrong.

        Without geometry a law has to be known, unless it is yet to be found.
        """
        name, law = self.name(), self.law()
        lawful = "law" in self.raw or not law_known
        alone = lawful and "shape" not in self.table("striker", required=False, quiet=True)
        bodies = self.masses_alone() if alone else self.bodies()
        model, motion = self.record(Model), self.record(Motion)
        numerics = self.table("numerics", required=False)
        if alone or bodies["target"] is not None:
            self.inertia(model, bodies.get("target"))
        self.faults += self.striker_faults(bodies)
        if self.faults:
            raise BadInput([*self.faults, *self.faults_together(bodies, model)])
        built = kind(**bodies, law=law, model=model, motion=motion, name=name, source=self.source)
        if law is not None and law_known:
            built.check_law()
        return built, numerics

    def indenter(self, kind: Callable[..., Pressed]) -> tuple[Pressed, Table]:
        """The scene without its motion; raises BadInput when anything is wrong."""
        name = self.name()
        bodies = self.bodies(optional(STRIKER_KEYS))
        model = self.record(Model)
        numerics = self.table("numerics", required=False)
        self.faults += self.striker_faults(bodies)
        if self.faults:
            raise BadInput(self.faults)
        own = {key: bodies[key] for key in ("shape", "material", "target", "striker_material")}
        return kind(**own, model=model, name=name, source=self.source), numerics

    def striker_faults(self, bodies: Table) -> Sequence[Fault]:
        """What is wrong with a striker that the target is not for, where both are known."""
        shape, target = bodies["shape"], bodies.get("target")
        if shape is None or target is None:
            return ()
        try:
            target.check_striker(self.source, shape)
        except BadInput as bad:
            return bad.faults
        return ()

    def faults_together(self, bodies: Table, model: Model) -> list[Fault]:
        """Values that are accepted each alone and not together, which a scene that is made finds by itself."""
        shape, mass = bodies["shape"], bodies.get("mass")
        may_swing = model.inertia and (shape is None or shape.own_mass(1.0) > 0.0)
        light = [] if mass is None else mass_faults(self.source, mass, float(may_swing))
        return light + gravity_faults(self.source, model)

    def record(self, kind: type[R]) -> R:
        """The record of the table with its name; what is missing, or has a fault, as by default."""
        return self.once(
            kind.name,
            self.raw.get(kind.name),
            lambda: kind(**self.checked(kind.name, self.table(kind.name, required=False), keys_of(kind))),
        )

    def bodies(self, striker_keys: Mapping[str, Key] = STRIKER_KEYS) -> Table:
        """Striker, target and material of a scene with geometry; None for what has a fault."""
        striker, shape = self.body("striker", SHAPES, striker_keys)
        held, target = self.body("target", TARGETS, TARGET_KEYS)
        own = {"shape": shape, "target": target, "target_mass": held.get("mass")}
        return {**striker, **own, **self.materials(target, shape)}

    def materials(self, target: Target | None, shape: Shape | None) -> dict[str, Material | None]:
        """The target's material, or the striker's where the target is rigid, and that of a striker that yields too."""
        if target is None or target.deformable:
            yields = self.striker_yields(target, shape)
            own = self.material("target")
            return {"material": own, "striker_material": self.material("striker") if yields else None}
        if "material" in self.table("target", required=False, quiet=True):
            self.faults.append(Fault(self.source, "target.material", f"a {target.name} is rigid; leave it out"))
        return {"material": self.material("striker"), "striker_material": None}

    def striker_yields(self, target: Target | None, shape: Shape | None) -> bool:
        """Whether a striker on a target that yields has a material too, and may."""
        given = "material" in self.table("striker", required=False, quiet=True)
        if not given or target is None or shape is None:
            return False
        inertia = bool(self.table("model", required=False, quiet=True).get("inertia"))
        refused = target.yielding_faults(self.source, shape, inertia)
        self.faults += refused
        return not refused

    def masses_alone(self) -> Table:
        """The masses of a scene that has a law of its own and no geometry."""
        striker = self.checked("striker", self.table("striker"), STRIKER_KEYS)
        held = self.checked("target", self.table("target", required=False), TARGET_KEYS)
        return {**striker, "shape": None, "target_mass": held.get("mass")}

    def law(self) -> LawChoice | None:
        """The law with its parameters; None without one, or with a fault noted."""
        table = self.table("law", required=False)
        if not table and not isinstance(self.raw.get("law"), Mapping):
            return None
        (own,) = alternatives(LAWS, table.get("name"))
        values = self.checked("law", table, {"name": Key(Member(LAWS.package)), **own})
        return LawChoice(values.pop("name"), values) if not self.faults else None

    def body(self, part: str, folder: Folder[Part[B]], common: Mapping[str, Key]) -> tuple[Table, B | None]:
        """A body's checked common values, and what the member of `folder` makes of its own keys."""
        return self.once(part, self.raw.get(part), lambda: self.read_body(part, folder, common))

    def once(self, part: str, table: object, read: Callable[[], Made]) -> Made:
        """What is read of a part's table, which may be known; with a fault it is read again, and the fault noted."""
        if part in self.known and self.known[part][0] is table:
            return cast(Made, self.known[part][1])
        faults, made = len(self.faults), read()
        if len(self.faults) == faults:
            self.known[part] = table, made
        return made

    def read_body(self, part: str, folder: Folder[Part[B]], common: Mapping[str, Key]) -> tuple[Table, B | None]:
        """The same, of its table."""
        table = self.table(part)
        rest = {key: value for key, value in table.items() if key != "material"}
        if part not in self.raw:
            return {}, None
        (own,) = alternatives(folder, table.get("shape"))
        values = self.checked(part, rest, {"shape": Key(Member(folder.package)), **common, **own}, ("material",))
        shape: str | None = values.pop("shape", None)
        shared = {key: values.pop(key) for key in common if key in values}
        if shape is None or not values.keys() >= {key for key in own if own[key].required}:
            return shared, None
        return shared, self.made(part, folder.get(shape).of, placed(values, self.folder), shape)

    def material(self, part: str) -> Material | None:
        """The material of a body, None with a fault noted."""
        body = self.table(part, required=False, quiet=True)
        if not body:
            return None
        path, table = f"{part}.material", self.table("material", inside=part)
        return self.once(path, body.get("material"), lambda: self.network(path, table)) if table else None

    def inertia(self, model: Model, target: Target | None) -> None:
        """Whether the target can have the inertia asked for, and a density for it."""
        material = self.table("target" if target is None else target.owner, required=False, quiet=True).get("material")
        density = material.get("density") if isinstance(material, Mapping) else None
        self.faults += inertia_faults(self.source, model.inertia, density, target)

    def table(self, key: str, inside: str = "", required: bool = True, quiet: bool = False) -> Table:
        """The table `key`, empty when it is missing or no table: a fault if required, unless `quiet`."""
        place = self.raw[inside] if inside else self.raw
        value = place.get(key, None if required else {})
        if isinstance(value, Mapping):
            return dict(value)
        if not quiet:
            path = f"{inside}.{key}".lstrip(".")
            message = f"not a table; accepted: its keys below [{path}]" if key in place else MISSING_TABLE
            self.faults.append(Fault(self.source, path, message))
        return {}
